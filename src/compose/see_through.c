/* compose/see_through.c - makes channels of a file translucent that hide other channels of the file, and
 * makes translucent matter thin that hides label maps.
 *
 * A volume is judged at places of its matter that the camera would see if the volume were alone. If almost no
 * light of most of these places passes other matter, the volume is hidden. The matter that hides the volume
 * is made so thin that most of the light passes: its transfer function gets a longer unit distance. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/looks.h"
#include "compose/screens.h"
#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/sample.h"
#include "text/stem.h"

/* A volume is hidden if a smaller fraction of its places than this is seen. */
#define ENOUGH 0.25
/* The fraction of light below which matter counts as hiding the matter behind it. A volume's own matter hides
 * places that are not at the volume's front; another volume's matter hides the whole volume. */
#define HIDES 0.3
/* The fraction of the light that matter lets pass after it has become translucent. */
#define THROUGH 0.65
/* The least fraction of light that counts as different from no light. */
#define LEAST 1e-30

enum { PLACES = 256, TRIED = 16384, NAME_BYTES = 61 };

/* The volumes of a scene that are judged, and the places at which one of them is judged. */
typedef struct channel_views {
  const hl_scene_description *scene;
  hl_screen *screens; /* owned; [count] */
  size_t count;
  vec3 forward;        /* the camera's direction */
  double *thin;        /* owned; [count]; the factor for each volume's extinction */
  size_t *hidden;      /* owned; [count]; the index of a volume that this volume hides */
  vec3 places[PLACES]; /* [place_count]; the places of one volume, in the world */
  size_t place_count;
} channel_views;

static vec3 towards_eye(const channel_views *views, vec3 point) {
  const hl_camera *camera = &views->scene->camera;
  return camera->type == HL_CAMERA_PERSPECTIVE
             ? vec3_normalise(vec3_subtract(vec3_of(camera->position), point))
             : vec3_scale(views->forward, -1);
}

/* Finds the point of an examined voxel in the world. Returns false if the voxel has no matter that is at
 * least half as opaque as the volume's most opaque matter. */
static bool find_matter(const hl_screen *screen, uint64_t voxel, double most, vec3 *point) {
  const hl_volume *volume = screen->volume->volume;
  const size_t *size = volume->dimension;
  const size_t i = (size_t)(voxel % size[0]), j = (size_t)(voxel / size[0] % size[1]),
               k = (size_t)(voxel / size[0] / size[1]);
  const vec3 at = {(double)i, (double)j, (double)k};
  if (!(2 * hl_screen_opacity(screen, hl_volume_value_within(volume, i, j, k)) > most) ||
      !hl_screen_leaves(screen, at))
    return false;
  *point = affine3_apply(hl_scene_volume_index_to_world(screen->volume), at);
  return true;
}

/* The state of a search that finds places one after the other and keeps evenly distributed ones. */
typedef struct kept_places {
  uint64_t met, every; /* the number of places so far; one of `every` places is kept */
} kept_places;

static void keep_place(channel_views *views, kept_places *kept, vec3 point) {
  if (kept->met++ % kept->every != 0) return;
  if (views->place_count == PLACES) {
    for (size_t p = 0; p < PLACES / 2; p++) views->places[p] = views->places[2 * p];
    views->place_count = PLACES / 2;
    kept->every *= 2;
  }
  views->places[views->place_count++] = point;
}

/* Finds places of the surfaces of a map's labels that face the camera. Labels that a legend does not list,
 * which only show where other labels lie, do not count. */
static void find_label_places(channel_views *views, const hl_screen *screen) {
  const hl_scene_volume *map = screen->volume;
  const size_t *size = map->volume->dimension;
  const uint64_t all = (uint64_t)size[0] * size[1] * size[2], looks = hl_examined_voxels(all);
  const affine3 to_world = hl_scene_volume_index_to_world(map);
  kept_places kept = {.every = 1};
  views->place_count = 0;
  for (uint64_t n = 0; n < looks; n++) {
    const uint64_t voxel = hl_examined_voxel(n, all);
    const size_t i = (size_t)(voxel % size[0]), j = (size_t)(voxel / size[0] % size[1]),
                 k = (size_t)(voxel / size[0] / size[1]);
    const vec3 at = {(double)i, (double)j, (double)k}, point = affine3_apply(to_world, at);
    const size_t label = hl_screen_label(map, hl_volume_value_within(map->volume, i, j, k));
    if (label < map->label_count && !map->labels[label].unlisted && hl_screen_leaves(screen, at) &&
        hl_screen_label_faces(screen, at, towards_eye(views, point)))
      keep_place(views, &kept, point);
  }
}

/* Finds places at the front of a volume. */
static void find_places(channel_views *views, const hl_screen *screen) {
  const size_t *size = screen->volume->volume->dimension;
  const uint64_t all = (uint64_t)size[0] * size[1] * size[2], looks = hl_examined_voxels(all);
  double most = 0;
  uint64_t matter = 0, met = 0;
  kept_places kept = {.every = 1};
  vec3 point;
  for (int n = 0; n < HL_SCREEN_TABLE; n++) most = fmax(most, screen->opacity[n]);
  views->place_count = 0;
  for (uint64_t n = 0; n < looks; n++) matter += find_matter(screen, hl_examined_voxel(n, all), most, &point);
  for (uint64_t n = 0; n < looks; n++) {
    if (!find_matter(screen, hl_examined_voxel(n, all), most, &point) || met++ % (matter / TRIED + 1) != 0)
      continue;
    if (hl_screen_passing(screen, point, towards_eye(views, point), HIDES) >= HIDES)
      keep_place(views, &kept, point);
  }
}

static bool is_map(const channel_views *views, size_t volume) {
  return views->scene->volumes[volume].label_count > 0;
}

/* The median, over all places, of the fraction of light that a volume lets pass. */
static hl_status find_middle(hl_context *context, const channel_views *views, const hl_screen *screen,
                             double *middle, hl_error *error) {
  float passing[PLACES];
  for (size_t p = 0; p < views->place_count; p++)
    passing[p] = (float)hl_screen_passing(screen, views->places[p], towards_eye(views, views->places[p]),
                                          LEAST);
  if (!hl_sort(context, passing, views->place_count))
    return hl_fail_memory(error, sizeof passing, "channels that are seen");
  *middle = fmax(hl_quantile(passing, views->place_count, 0.5), LEAST);
  return HL_OK;
}

/* The fraction of a volume's places from which enough light passes all other volumes together. */
static double seen_part(const channel_views *views, size_t of) {
  size_t seen = 0;
  for (size_t p = 0; p < views->place_count; p++) {
    double left = 1;
    for (size_t v = 0; v < views->count && left >= HL_SCREEN_SEEN; v++)
      if (v != of)
        left *= hl_screen_passing(&views->screens[v], views->places[p], towards_eye(views, views->places[p]),
                                  HL_SCREEN_SEEN);
    seen += left >= HL_SCREEN_SEEN;
  }
  return views->place_count > 0 ? (double)seen / (double)views->place_count : 1;
}

/* If a volume is hidden, makes the volumes thin that hide it. The places of a label map are not tested for
 * being hidden, because labels lie in matter that is meant to be seen through: every volume that takes most
 * of their light is made thin. Derived: the transmittances of all hiding volumes are multiplied, and a factor
 * f for the extinction makes a transmittance t the transmittance t^f. */
static hl_status thin_before(hl_context *context, channel_views *views, size_t of, hl_error *error) {
  double middle[HL_CHANNELS_MOST];
  size_t hiding = 0;
  hl_status status = HL_OK;
  if (is_map(views, of)) find_label_places(views, &views->screens[of]);
  else find_places(views, &views->screens[of]);
  if (views->place_count == 0 || (!is_map(views, of) && seen_part(views, of) >= ENOUGH)) return HL_OK;
  for (size_t v = 0; v < views->count && status == HL_OK; v++) {
    middle[v] = 1;
    if (v != of && !is_map(views, v))
      status = find_middle(context, views, &views->screens[v], &middle[v], error);
    hiding += middle[v] < HIDES;
  }
  for (size_t v = 0; v < views->count && status == HL_OK; v++) {
    const double factor = hl_ln(THROUGH) / ((double)hiding * hl_ln(middle[v]));
    if (!(middle[v] < HIDES) || factor >= views->thin[v]) continue;
    views->thin[v] = factor;
    views->hidden[v] = of;
  }
  return status;
}

/* The volume's name, or the name of its file without folder and extension. */
static const char *name_of(const hl_scene_volume *volume, char name[NAME_BYTES]) {
  const char *text = volume->name != NULL ? volume->name : volume->file != NULL ? volume->file : "a volume";
  size_t length = strlen(text);
  if (volume->name == NULL && volume->file != NULL) text = hl_stem(text, &length);
  snprintf(name, NAME_BYTES, "%.*s", (int)fmin((double)length, NAME_BYTES - 1), text);
  return name;
}

/* Makes volumes that hide others thinner. The factor in `thin` was found for matter with the option "density"
 * applied, so the option's number multiplies the thinned extinction once more: otherwise the option would
 * have no effect. */
static void make_thin(const hl_composer *composer, const channel_views *views, hl_scene_volume *volumes) {
  const hl_asked *density = &composer->asked[HL_ASK_DENSITY];
  for (size_t v = 0; v < views->count; v++) {
    if (!(views->thin[v] < 1)) continue;
    const bool of_map = is_map(views, views->hidden[v]);
    char names[2][NAME_BYTES];
    volumes[v].transfer_function.unit_distance /= views->thin[v] * (density->given ? density->number[0] : 1);
    hl_log(composer->context, HL_LOG_INFO,
           of_map ? "%s would hide %s, and is shown thinner: --density 3 shows more of it"
                  : "%s would hide %s, and is shown translucent: --look surface keeps it opaque",
           name_of(&volumes[v], names[0]), name_of(&volumes[views->hidden[v]], names[1]));
  }
}

/* Makes all hiding volumes thin. of_maps: whether label maps must be seen; if not, volumes of values must not
 * hide each other. */
static hl_status thin_all(const hl_composer *composer, bool of_maps, channel_views *views,
                          hl_scene_volume *volumes) {
  hl_context *context = composer->context;
  hl_status status = HL_OK;
  for (size_t v = 0; v < views->count && status == HL_OK; v++) {
    status = hl_screen_begin(context, views->scene, &volumes[v], &views->screens[v], composer->error);
    views->thin[v] = 1;
  }
  for (size_t v = 0; v < views->count && status == HL_OK; v++)
    if (is_map(views, v) == of_maps) status = thin_before(context, views, v, composer->error);
  if (status == HL_OK) make_thin(composer, views, volumes);
  for (size_t v = 0; v < views->count; v++) hl_screen_release(context, &views->screens[v]);
  return status;
}

/* Returns whether a bare scene's opacities were chosen automatically. */
static bool has_chosen_opacities(const hl_composer *composer, const hl_scene_description *scene) {
  const hl_asked *asked = composer->asked;
  return composer->bare && (composer->flags & HL_COMPOSE_FUNCTIONS) == 0 && scene->volume_count >= 2 &&
         scene->volume_count <= HL_CHANNELS_MOST && !hl_is_maximum(composer, scene) &&
         !asked[HL_ASK_SLICE].given && !asked[HL_ASK_TF].given && !asked[HL_ASK_THRESHOLD].given &&
         !asked[HL_ASK_ISO].given;
}

/* Returns whether the scene's volumes of values are channels of one file, without a look that an option
 * chooses. */
static bool has_channels(const hl_composer *composer, const hl_scene_description *scene) {
  const hl_asked *look = &composer->asked[HL_ASK_LOOK];
  const hl_scene_volume *first = scene->volumes;
  size_t channels = 0;
  if (look->given && look->choice != HL_LOOK_AUTO) return false;
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    if (volume->label_count > 0) continue;
    if (!hl_screen_can_hide(volume) || first->file == NULL || volume->file == NULL ||
        strcmp(volume->file, first->file) != 0 || (v > 0 && volume->channel == first->channel))
      return false;
    channels++;
  }
  return channels >= 2;
}

/* Returns whether the scene consists of label maps and of volumes of values, and the option "look" makes
 * matter translucent.
 */
static bool has_labels_in_glass(const hl_composer *composer, const hl_scene_description *scene) {
  const hl_asked *look = &composer->asked[HL_ASK_LOOK];
  size_t maps = 0;
  if (!look->given ||
      (look->choice != HL_LOOK_TRANSLUCENT && look->choice != HL_LOOK_XRAY && look->choice != HL_LOOK_SMOKE))
    return false;
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    if (volume->label_count == 0 && !hl_screen_can_hide(volume)) return false;
    if (volume->label_count > 0 && !hl_is_at_hand(volume->volume)) return false;
    maps += volume->label_count > 0;
  }
  return maps > 0 && maps < scene->volume_count;
}

hl_status hl_see_through(const hl_composer *composer, hl_scene_description *scene,
                         hl_scene_volume **changed) {
  hl_context *context = composer->context;
  const size_t count = scene->volume_count;
  vec3 right, up;
  channel_views views = {.scene = scene, .count = count};
  const bool of_maps = has_labels_in_glass(composer, scene);
  if (!has_chosen_opacities(composer, scene) || (!of_maps && !has_channels(composer, scene)) ||
      !hl_camera_basis(&scene->camera, &right, &up, &views.forward))
    return HL_OK;
  *changed = hl_allocate(context, count, sizeof **changed);
  views.screens = hl_allocate_zeroed(context, count, sizeof *views.screens);
  views.thin = hl_allocate_zeroed(context, count, sizeof *views.thin);
  views.hidden = hl_allocate_zeroed(context, count, sizeof *views.hidden);
  hl_status status = *changed != NULL && views.screens != NULL && views.thin != NULL && views.hidden != NULL
                         ? HL_OK
                         : hl_fail_memory(composer->error, count * sizeof *views.screens,
                                          "channels that are seen");
  if (status == HL_OK) {
    memcpy(*changed, scene->volumes, count * sizeof **changed);
    status = thin_all(composer, of_maps, &views, *changed);
    scene->volumes = *changed;
  }
  hl_release(context, views.screens);
  hl_release(context, views.thin);
  hl_release(context, views.hidden);
  return status;
}
