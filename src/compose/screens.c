/* compose/screens.c - see screens.h. */
#include "compose/screens.h"

#include <math.h>

#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "scene/function/transfer_function.h"
#include "scene/label/label_table.h"
#include "volume/volume.h"

enum { EXAMINED = 400000 };

/* Makes the shapes of a volume's own cuts and of its scene's cuts. *shapes is owned by the caller. */
static hl_status find_cuts(hl_context *context, const hl_scene_description *scene,
                           const hl_scene_volume *volume, cut_shape **shapes, size_t *count,
                           hl_error *error) {
  hl_scene_volume both = *volume;
  *count = volume->cut_count + scene->cut_count;
  if (*count == 0) return HL_OK;
  hl_cut *cuts = hl_allocate(context, *count, sizeof *cuts);
  if (cuts == NULL) return hl_fail_memory(error, *count * sizeof *cuts, "cuts");
  hl_add_scene_cuts(scene, &both, cuts);
  hl_status status = hl_cut_shapes(context, &both, shapes, error);
  hl_release(context, cuts);
  return status;
}

bool hl_is_at_hand(const hl_volume *volume) { return volume->pages == NULL && volume->bricks == NULL; }

bool hl_screen_can_hide(const hl_scene_volume *volume) {
  const hl_transfer_function *function = &volume->transfer_function;
  affine3 to_index;
  return volume->visible && volume->label_count == 0 &&
         (volume->mask.volume == NULL || hl_is_at_hand(volume->mask.volume)) &&
         hl_is_at_hand(volume->volume) && function->plane.second == HL_SECOND_NONE &&
         function->gradient_opacity_count == 0 && volume->volume->maximum > volume->volume->minimum &&
         affine3_invert(hl_scene_volume_index_to_world(volume), &to_index);
}

hl_status hl_screen_begin(hl_context *context, const hl_scene_description *scene,
                          const hl_scene_volume *volume, hl_screen *screen, hl_error *error) {
  const affine3 to_world = hl_scene_volume_index_to_world(volume);
  const hl_transfer_function *function = &volume->transfer_function;
  const double least = volume->volume->minimum, range = volume->volume->maximum - least;
  *screen = (hl_screen){.volume = volume, .step = mat3_shortest_column(to_world.linear)};
  hl_scene_volume_box(volume, screen->low, screen->high);
  if (affine3_invert(to_world, &screen->to_index) && volume->label_count == 0) {
    for (int n = 0; n < HL_SCREEN_TABLE; n++) {
      const double opacity = hl_transfer_function_opacity(function,
                                                          least + range * n / (HL_SCREEN_TABLE - 1));
      screen->opacity[n] = 1 - hl_pow(1 - opacity, screen->step / function->unit_distance);
    }
  }
  affine3 world_to_mask;
  if (volume->mask.volume != NULL && affine3_invert(hl_scene_mask_index_to_world(volume), &world_to_mask))
    screen->to_mask = affine3_multiply(world_to_mask, to_world);
  return find_cuts(context, scene, volume, &screen->cuts, &screen->cut_count, error);
}

void hl_screen_release(hl_context *context, hl_screen *screen) { hl_release(context, screen->cuts); }

static bool is_in_box(const hl_screen *screen, vec3 place) {
  const double at[3] = {place.x, place.y, place.z};
  bool within = true;
  for (int a = 0; a < 3; a++) within &= at[a] > screen->low[a] && at[a] < screen->high[a];
  return within;
}

/* Returns whether a volume's mask leaves the volume's matter at a place in the volume's index space. */
static bool is_in_mask(const hl_screen *screen, vec3 place) {
  const hl_mask *mask = &screen->volume->mask;
  return mask->volume == NULL || hl_mask_factor(mask, affine3_apply(screen->to_mask, place)) > 0;
}

bool hl_screen_leaves(const hl_screen *screen, vec3 place) {
  return is_in_box(screen, place) && hl_cuts_leave(screen->cuts, screen->cut_count, place) &&
         is_in_mask(screen, place);
}

size_t hl_screen_label(const hl_scene_volume *map, double value) {
  const hl_label *label = hl_label_of_value(map->labels, map->label_count, value);
  const bool found = label != NULL && label->visible && label->opacity > 0;
  return found ? (size_t)(label - map->labels) : map->label_count;
}

bool hl_screen_label_faces(const hl_screen *screen, vec3 place, vec3 towards) {
  const hl_scene_volume *map = screen->volume;
  const vec3 before = vec3_add(place, mat3_apply(screen->to_index.linear, vec3_scale(towards, screen->step)));
  const long next[3] = {lround(before.x), lround(before.y), lround(before.z)};
  return !hl_screen_leaves(screen, before) ||
         hl_screen_label(map, hl_volume_value_within(map->volume, (size_t)next[0], (size_t)next[1],
                                                     (size_t)next[2])) == map->label_count;
}

double hl_screen_opacity(const hl_screen *screen, double value) {
  const hl_volume *volume = screen->volume->volume;
  const double scale = (HL_SCREEN_TABLE - 1) / (volume->maximum - volume->minimum);
  const double entry = (value - volume->minimum) * scale + 0.5;
  return entry >= 0 && entry < HL_SCREEN_TABLE ? screen->opacity[(int)entry] : 0;
}

double hl_screen_passing(const hl_screen *screen, vec3 point, vec3 towards, double least) {
  const hl_volume *volume = screen->volume->volume;
  const vec3 step = mat3_apply(screen->to_index.linear, vec3_scale(towards, screen->step));
  vec3 at = affine3_apply(screen->to_index, point);
  double left = 1;
  const long most = 4L * (long)(volume->dimension[0] + volume->dimension[1] + volume->dimension[2]);
  for (long n = 0; n < most && left >= least; n++) {
    at = vec3_add(at, step);
    if (!is_in_box(screen, at)) continue;
    const double opacity = hl_screen_opacity(
        screen,
        hl_volume_value_within(volume, (size_t)lround(at.x), (size_t)lround(at.y), (size_t)lround(at.z)));
    if (opacity > 0 && hl_screen_leaves(screen, at)) left *= 1 - opacity;
  }
  return left;
}

uint64_t hl_examined_voxels(uint64_t all) { return all < EXAMINED ? all : EXAMINED; }

uint64_t hl_examined_voxel(uint64_t n, uint64_t all) {
  return all <= EXAMINED ? n : (uint64_t)(fmod((double)n * 0.6180339887498949, 1) * (double)all);
}
