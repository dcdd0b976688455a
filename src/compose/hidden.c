/* compose/hidden.c - logs that label maps are not seen, because matter of other volumes hides them. */
#include <math.h>
#include <string.h>

#include "compose/composer.h"
#include "core/context.h"
#include "core/memory.h"
#include "core/vector.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/cut.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "text/stem.h"
#include "volume/volume.h"

/* SEEN: a place counts as seen if this fraction of its light reaches the eye. */
#define SEEN 0.05

enum { TABLE = 1024, EXAMINED = 400000, PLACES = 256 };

/* A volume whose matter may hide labels. */
typedef struct screen {
  const hl_scene_volume *volume;
  cut_shape *cuts; /* owned */
  size_t cut_count;
  double low[3], high[3]; /* the volume's box in index space */
  affine3 to_index;
  double step;           /* world units */
  double opacity[TABLE]; /* of a step; entries over the volume's range */
} screen;

/* Makes the shapes of a volume's own cuts and of its scene's cuts. *shapes is owned by the caller. */
static hl_status find_cuts(const hl_composer *composer, const hl_scene_description *scene,
                           const hl_scene_volume *volume, cut_shape **shapes, size_t *count) {
  hl_scene_volume both = *volume;
  *shapes = NULL;
  *count = volume->cut_count + scene->cut_count;
  if (*count == 0) return HL_OK;
  hl_cut *cuts = hl_allocate(composer->context, *count, sizeof *cuts);
  if (cuts == NULL) return hl_fail_memory(composer->error, *count * sizeof *cuts, "cuts");
  hl_add_scene_cuts(scene, &both, cuts);
  hl_status status = hl_cut_shapes(composer->context, &both, shapes, composer->error);
  hl_release(composer->context, cuts);
  return status;
}

/* Whether all voxels of a volume are in memory. Voxels here and there of a scratch file, or of other
 * processes, would take too long. */
static bool is_at_hand(const hl_volume *volume) { return volume->pages == NULL && volume->bricks == NULL; }

/* Whether a volume can hide labels as far as can be told here: it shows values by their opacity alone. */
static bool hides(const hl_scene_volume *volume) {
  const hl_transfer_function *function = &volume->transfer_function;
  return volume->visible && volume->label_count == 0 && volume->mask.volume == NULL &&
         is_at_hand(volume->volume) && function->plane.second == HL_SECOND_NONE &&
         function->gradient_opacity_count == 0 && volume->volume->maximum > volume->volume->minimum;
}

static bool prepare(const hl_scene_volume *volume, screen *s) {
  const affine3 to_world = hl_scene_volume_index_to_world(volume);
  const hl_transfer_function *function = &volume->transfer_function;
  const double least = volume->volume->minimum, range = volume->volume->maximum - least;
  *s = (screen){.volume = volume, .step = mat3_shortest_column(to_world.linear)};
  if (!affine3_invert(to_world, &s->to_index)) return false;
  hl_scene_volume_box(volume, s->low, s->high);
  for (int n = 0; n < TABLE; n++) {
    const double opacity = hl_transfer_function_opacity(function, least + range * n / (TABLE - 1));
    s->opacity[n] = 1 - pow(1 - opacity, s->step / function->unit_distance);
  }
  return true;
}

/* The fraction of the light that passes a volume on its way from a point of the world. towards: a unit
 * vector. */
static double passing(const screen *s, vec3 point, vec3 towards) {
  const hl_volume *volume = s->volume->volume;
  const double scale = (TABLE - 1) / (volume->maximum - volume->minimum);
  const vec3 step = mat3_apply(s->to_index.linear, vec3_scale(towards, s->step));
  vec3 at = affine3_apply(s->to_index, point);
  double left = 1;
  const long most = 4L * (long)(volume->dimension[0] + volume->dimension[1] + volume->dimension[2]);
  for (long n = 0; n < most && left >= SEEN; n++) {
    at = vec3_add(at, step);
    const double place[3] = {at.x, at.y, at.z};
    bool within = true;
    for (int a = 0; a < 3; a++) within &= place[a] > s->low[a] && place[a] < s->high[a];
    if (!within) continue;
    const double value = hl_volume_value_within(volume, (size_t)lround(at.x), (size_t)lround(at.y),
                                                (size_t)lround(at.z));
    const double entry = (value - volume->minimum) * scale + 0.5;
    if (!(entry >= 0 && entry < TABLE) || !hl_cuts_leave(s->cuts, s->cut_count, at)) continue;
    left *= 1 - s->opacity[(int)entry];
  }
  return left;
}

static bool is_shown(const hl_scene_volume *map, double value) {
  size_t low = 0, high = map->label_count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if ((double)map->labels[middle].value < value) low = middle + 1;
    else high = middle;
  }
  return low < map->label_count && (double)map->labels[low].value == value && map->labels[low].visible &&
         map->labels[low].opacity > 0;
}

/* The number of an examined voxel among `all` voxels. Steps of about the golden section reach evenly
 * distributed voxels. */
static uint64_t examined(uint64_t n, uint64_t all) {
  return all <= EXAMINED ? n : (uint64_t)(fmod((double)n * 0.6180339887498949, 1) * (double)all);
}

/* Returns whether any of a label map's visible labels is seen through the screens. *any: set to whether these
 * labels have any voxels. */
static bool is_seen(const hl_scene_description *scene, const hl_scene_volume *map, const screen *own,
                    const screen *screens, size_t count, bool *any) {
  const size_t *size = map->volume->dimension;
  const uint64_t all = (uint64_t)size[0] * size[1] * size[2], looks = all < EXAMINED ? all : EXAMINED;
  const affine3 to_world = hl_scene_volume_index_to_world(map);
  vec3 right, up, forward;
  if (!hl_camera_basis(&scene->camera, &right, &up, &forward)) return true;
  uint64_t shown = 0;
  for (uint64_t pass = 0, every = 1, met = 0; pass < 2; pass++, every = shown / PLACES + 1) {
    for (uint64_t n = 0; n < looks; n++) {
      const uint64_t voxel = examined(n, all);
      const size_t i = (size_t)(voxel % size[0]), j = (size_t)(voxel / size[0] % size[1]),
                   k = (size_t)(voxel / size[0] / size[1]);
      if (!is_shown(map, hl_volume_value_within(map->volume, i, j, k))) continue;
      const vec3 at = {(double)i, (double)j, (double)k};
      if (!hl_cuts_leave(own->cuts, own->cut_count, at)) continue;
      if (pass == 0) shown++;
      if (pass == 0 || met++ % every != 0) continue;
      const vec3 point = affine3_apply(to_world, at);
      const vec3 towards = scene->camera.type == HL_CAMERA_PERSPECTIVE
                               ? vec3_normalise(vec3_subtract(vec3_of(scene->camera.position), point))
                               : vec3_scale(forward, -1);
      double left = 1;
      for (size_t s = 0; s < count && left >= SEEN; s++) left *= passing(&screens[s], point, towards);
      if (left >= SEEN) return true;
    }
  }
  *any = shown > 0;
  return false;
}

static void tell(const hl_composer *composer, const hl_scene_volume *map, const hl_scene_volume *screen) {
  size_t lengths[2] = {0};
  const hl_scene_volume *parts[2] = {map, screen};
  const char *names[2];
  for (int n = 0; n < 2; n++) {
    names[n] = parts[n]->name != NULL ? parts[n]->name : parts[n]->file != NULL ? parts[n]->file : "volume";
    names[n] = hl_stem(names[n], &lengths[n]);
  }
  hl_log(composer->context, HL_LOG_INFO,
         "the labels of %.*s are hidden in %.*s: --iso %.*s=VALUE:COLOR:0.2 shows it as glass, --cut-box "
         "%.*s=... opens it",
         (int)lengths[0], names[0], (int)lengths[1], names[1], (int)lengths[1], names[1], (int)lengths[1],
         names[1]);
}

hl_status hl_tell_of_hidden_labels(const hl_composer *composer, const hl_scene_description *scene) {
  hl_context *context = composer->context;
  size_t count = 0;
  hl_status status = HL_OK;
  if (!composer->asked[HL_ASK_LABELS].given || scene->render.compositing == HL_COMPOSITING_MAXIMUM)
    return HL_OK;
  screen *screens = hl_allocate_zeroed(context, scene->volume_count + 1, sizeof *screens);
  if (screens == NULL) return hl_fail_memory(composer->error, sizeof *screens, "labels that are seen");
  for (size_t v = 0; v < scene->volume_count && status == HL_OK; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    screen *s = &screens[count];
    if (!hides(volume) || !prepare(volume, s)) continue;
    status = find_cuts(composer, scene, volume, &s->cuts, &s->cut_count);
    count++;
  }
  for (size_t v = 0; v < scene->volume_count && status == HL_OK && count > 0; v++) {
    const hl_scene_volume *map = &scene->volumes[v];
    screen own = {.volume = map};
    bool any = false;
    if (!map->visible || map->label_count == 0 || !is_at_hand(map->volume)) continue;
    status = find_cuts(composer, scene, map, &own.cuts, &own.cut_count);
    if (status == HL_OK && !is_seen(scene, map, &own, screens, count, &any) && any)
      tell(composer, map, screens[0].volume);
    hl_release(context, own.cuts);
  }
  for (size_t s = 0; s < count; s++) hl_release(context, screens[s].cuts);
  hl_release(context, screens);
  return status;
}
