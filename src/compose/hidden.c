/* compose/hidden.c - logs which labels are not seen, because matter of other volumes hides them. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/screens.h"
#include "core/context.h"
#include "core/memory.h"
#include "core/vector.h"
#include "scene/geometry/cut.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "text/stem.h"
#include "volume/volume.h"

/* A label counts as seen if this fraction of its places is seen. */
#define SEEN 0.05
/* Transmittances of screens below this are not told apart: of several such screens, the first one counts as
 * hiding a place. */
#define LEAST 1e-6

enum { PLACES = 256, FEWEST_PLACES = 16, ALL_PLACES = 32768 };

/* The counts for one label, as seen from one side. */
typedef struct label_sight {
  uint64_t voxels, facing; /* voxels: the examined voxels of the label; facing: the examined voxels that have
                            * no label in front of them */
  uint64_t met, tried, seen; /* the numbers of chosen voxels that were met, that were tried, and that are
                              * seen */
  bool present, hidden; /* present: whether the label has voxels; hidden: whether hardly any of its voxels are
                         * seen from the sides that were tried */
} label_sight;

/* The sides from which labels are looked at: the eye's side, and the sides along the camera's axes. A label
 * that is hidden from all sides is enclosed in other matter. */
enum { FROM_EYE, FROM_BEHIND, FROM_LEFT, FROM_RIGHT, FROM_ABOVE, FROM_BELOW, SIDES };

/* A label map whose labels are looked for. */
typedef struct sought_map {
  const hl_scene_description *scene;
  const hl_screen *own; /* the map with its cuts */
  const hl_screen *screens;
  uint64_t *hides; /* owned; [screen_count]; for each screen, the number of hidden places that this screen
                    * hides more than any other screen does */
  size_t screen_count;
  affine3 to_world;
  uint64_t places;     /* the number of voxels of a label that are tried */
  vec3 ways[SIDES];    /* unit vectors to the sides */
  int side;            /* the side from which the labels are looked at now */
  label_sight *sights; /* owned; [label_count] */
} sought_map;

/* A voxel of a visible label. */
typedef struct sought_voxel {
  size_t label;
  bool facing;
  vec3 point, towards; /* the voxel's place in the world, and the unit vector to the side */
} sought_voxel;

/* Finds a voxel, if it belongs to a label that is looked for. */
static bool find_voxel(const sought_map *sought, uint64_t voxel, sought_voxel *found) {
  const hl_scene_volume *map = sought->own->volume;
  const hl_camera *camera = &sought->scene->camera;
  const size_t *size = map->volume->dimension;
  const size_t at[3] = {(size_t)(voxel % size[0]), (size_t)(voxel / size[0] % size[1]),
                        (size_t)(voxel / size[0] / size[1])};
  const vec3 place = {(double)at[0], (double)at[1], (double)at[2]};
  found->label = hl_screen_label(map, hl_volume_value_within(map->volume, at[0], at[1], at[2]));
  if (found->label == map->label_count || (sought->side > FROM_EYE && !sought->sights[found->label].hidden) ||
      !hl_screen_leaves(sought->own, place))
    return false;
  found->point = affine3_apply(sought->to_world, place);
  found->towards = sought->side == FROM_EYE && camera->type == HL_CAMERA_PERSPECTIVE
                       ? vec3_normalise(vec3_subtract(vec3_of(camera->position), found->point))
                       : sought->ways[sought->side];
  found->facing = hl_screen_label_faces(sought->own, place, found->towards);
  return true;
}

/* Looks from one voxel of a label to the side. A label is judged by its voxels that face the side. A label
 * that lies within other labels is judged by all of its voxels. At most about `places` voxels of a label are
 * tried. */
static void try_voxel(const sought_map *sought, const sought_voxel *voxel) {
  label_sight *sight = &sought->sights[voxel->label];
  const uint64_t all = sight->facing > 0 ? sight->facing : sight->voxels, every = all / sought->places + 1;
  if ((sight->facing > 0 && !voxel->facing) || sight->met++ % every != 0) return;
  double left = 1, least = 1;
  size_t most = 0;
  for (size_t s = 0; s < sought->screen_count; s++) {
    const double passing = hl_screen_passing(&sought->screens[s], voxel->point, voxel->towards, LEAST);
    left *= passing;
    if (passing < least) least = passing, most = s;
  }
  sight->tried++;
  sight->seen += left >= HL_SCREEN_SEEN;
  sought->hides[most] += left < HL_SCREEN_SEEN;
}

/* Looks for labels from one side. Afterwards `hidden` is set for the labels that are hardly seen. */
static void look_from(sought_map *sought, int side) {
  const hl_scene_volume *map = sought->own->volume;
  const size_t *size = map->volume->dimension;
  const uint64_t all = (uint64_t)size[0] * size[1] * size[2], looks = hl_examined_voxels(all);
  sought->side = side;
  for (size_t l = 0; l < map->label_count; l++) {
    label_sight *sight = &sought->sights[l];
    *sight = (label_sight){.present = sight->present, .hidden = sight->hidden};
  }
  for (int pass = 0; pass < 2; pass++)
    for (uint64_t n = 0; n < looks; n++) {
      sought_voxel voxel;
      if (!find_voxel(sought, hl_examined_voxel(n, all), &voxel)) continue;
      if (pass == 1) try_voxel(sought, &voxel);
      else sought->sights[voxel.label].voxels++, sought->sights[voxel.label].facing += voxel.facing;
    }
  for (size_t l = 0; l < map->label_count; l++) {
    label_sight *sight = &sought->sights[l];
    if (side == FROM_EYE) sight->present = sight->hidden = sight->voxels > 0;
    sight->hidden = sight->hidden && (double)sight->seen < SEEN * (double)sight->tried;
  }
}

static size_t count_hidden(const sought_map *sought, size_t *present) {
  size_t hidden = 0;
  *present = 0;
  for (size_t l = 0; l < sought->own->volume->label_count; l++) {
    hidden += sought->sights[l].hidden;
    *present += sought->sights[l].present;
  }
  return hidden;
}

/* Writes the names of the hidden labels: "liver, 7 and 3 more". The most opaque labels come first. */
static void name_hidden(const hl_scene_volume *map, const label_sight *sights, size_t hidden, char *text,
                        size_t size) {
  enum { NAMED = 4 };
  size_t used = 0, named = 0;
  double most = 0;
  text[0] = '\0';
  for (size_t l = 0; l < map->label_count; l++)
    if (sights[l].hidden) most = fmax(most, map->labels[l].opacity);
  for (size_t n = 0; n < 2 * map->label_count && named < NAMED; n++) {
    const size_t l = n % map->label_count;
    const hl_label *label = &map->labels[l];
    if (!sights[l].hidden || (label->opacity < most) == (n < map->label_count)) continue;
    const char *separator = named++ > 0 ? ", " : "";
    used += (size_t)(label->name != NULL && label->name[0] != '\0'
                         ? snprintf(text + used, size - used, "%s%.40s", separator, label->name)
                         : snprintf(text + used, size - used, "%s%" PRId64, separator, label->value));
  }
  if (hidden > named) snprintf(text + used, size - used, " and %zu more", hidden - named);
}

/* Logs that labels of a map are not seen. some: the names of these labels; null: all labels of the map. */
static void tell(const hl_composer *composer, const hl_scene_volume *map, const char *some, size_t count,
                 const hl_scene_volume *screen) {
  size_t lengths[2] = {0};
  const hl_scene_volume *parts[2] = {map, screen};
  const char *names[2];
  for (int n = 0; n < 2; n++) {
    names[n] = parts[n]->name != NULL ? parts[n]->name : parts[n]->file != NULL ? parts[n]->file : "volume";
    names[n] = hl_stem(names[n], &lengths[n]);
  }
  const bool one = some != NULL && count == 1;
  hl_log(composer->context, HL_LOG_INFO,
         "the label%s%s%s of %.*s %s hidden in %.*s: --iso %.*s=VALUE:COLOR:0.2 shows it as glass, --cut-box "
         "%.*s=... opens it",
         one ? "" : "s", some != NULL ? " " : "", some != NULL ? some : "", (int)lengths[0], names[0],
         one ? "is" : "are", (int)lengths[1], names[1], (int)lengths[1], names[1], (int)lengths[1], names[1]);
}

/* The volume that hides the greatest number of places from the eye and from the other sides. */
static const hl_scene_volume *find_hiding(const sought_map *sought) {
  size_t most = 0;
  for (size_t s = 1; s < sought->screen_count; s++)
    if (sought->hides[s] > sought->hides[most]) most = s;
  return sought->screens[most].volume;
}

/* Logs that the whole map is hidden from the eye, or else which labels of the map are hidden from all sides.
 * A label that is hidden only at the far side of matter is not logged if other labels are seen. */
static void tell_of_map(const hl_composer *composer, sought_map *sought) {
  const hl_scene_volume *map = sought->own->volume;
  char names[300];
  size_t present = 0;
  look_from(sought, FROM_EYE);
  size_t hidden = count_hidden(sought, &present);
  if (hidden > 0 && hidden == present) {
    tell(composer, map, NULL, hidden, find_hiding(sought));
    return;
  }
  for (int side = FROM_EYE + 1; side < SIDES && hidden > 0; side++) {
    look_from(sought, side);
    hidden = count_hidden(sought, &present);
  }
  if (hidden == 0) return;
  name_hidden(map, sought->sights, hidden, names, sizeof names);
  tell(composer, map, names, hidden, find_hiding(sought));
}

static hl_status look_at_map(const hl_composer *composer, sought_map *sought) {
  const hl_scene_volume *map = sought->own->volume;
  vec3 *ways = sought->ways, right, up, forward;
  if (!hl_camera_basis(&sought->scene->camera, &right, &up, &forward)) return HL_OK;
  ways[FROM_EYE] = vec3_scale(forward, -1), ways[FROM_BEHIND] = forward;
  ways[FROM_LEFT] = vec3_scale(right, -1), ways[FROM_RIGHT] = right;
  ways[FROM_ABOVE] = up, ways[FROM_BELOW] = vec3_scale(up, -1);
  sought->to_world = hl_scene_volume_index_to_world(map);
  sought->places = ALL_PLACES / (map->label_count + 1) + FEWEST_PLACES;
  if (sought->places > PLACES) sought->places = PLACES;
  sought->sights = hl_allocate_zeroed(composer->context, map->label_count, sizeof *sought->sights);
  sought->hides = hl_allocate_zeroed(composer->context, sought->screen_count, sizeof *sought->hides);
  const bool whole = sought->sights != NULL && sought->hides != NULL;
  if (whole) tell_of_map(composer, sought);
  hl_release(composer->context, sought->sights);
  hl_release(composer->context, sought->hides);
  return whole ? HL_OK
               : hl_fail_memory(composer->error, map->label_count * sizeof *sought->sights,
                                "labels that are seen");
}

hl_status hl_tell_of_hidden_labels(const hl_composer *composer, const hl_scene_description *scene) {
  hl_context *context = composer->context;
  size_t count = 0;
  hl_status status = HL_OK;
  if (!composer->asked[HL_ASK_LABELS].given || composer->asked[HL_ASK_SLICE].given ||
      scene->render.compositing == HL_COMPOSITING_MAXIMUM)
    return HL_OK;
  hl_screen *screens = hl_allocate_zeroed(context, scene->volume_count + 1, sizeof *screens);
  if (screens == NULL) return hl_fail_memory(composer->error, sizeof *screens, "labels that are seen");
  for (size_t v = 0; v < scene->volume_count && status == HL_OK; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    if (!hl_screen_can_hide(volume)) continue;
    status = hl_screen_begin(context, scene, volume, &screens[count++], composer->error);
  }
  for (size_t v = 0; v < scene->volume_count && status == HL_OK && count > 0; v++) {
    const hl_scene_volume *map = &scene->volumes[v];
    if (!map->visible || map->label_count == 0 || !hl_is_at_hand(map->volume)) continue;
    hl_screen own;
    status = hl_screen_begin(context, scene, map, &own, composer->error);
    sought_map sought = {.scene = scene, .own = &own, .screens = screens, .screen_count = count};
    if (status == HL_OK) status = look_at_map(composer, &sought);
    hl_screen_release(context, &own);
  }
  for (size_t s = 0; s < count; s++) hl_screen_release(context, &screens[s]);
  hl_release(context, screens);
  return status;
}
