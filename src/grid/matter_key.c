/* grid/matter_key.c - see matter_key.h. */
#include "grid/matter_key.h"

static void add_points(hl_key *key, const hl_opacity_point *points, size_t count) {
  hl_key_add_whole(key, (int64_t)count);
  for (size_t p = 0; p < count; p++)
    hl_key_add_numbers(key, (double[2]){points[p].value, points[p].opacity}, 2);
}

/* Adds a function of two numbers to the key, and the volume whose values are the second number. */
static void add_plane(hl_key *key, uint64_t mark, const plane_table *table) {
  hl_key_add_whole(key, (int64_t)mark);
  hl_key_add_whole(key, (int64_t)(uintptr_t)table->second_volume);
  if (table->second != NULL) hl_key_add_affine(key, &table->second->index_to_frame);
}

void hl_matter_key_add(hl_key *key, const hl_scene_volume *volume, uint64_t plane_mark, const grid *grid,
                       const classifier *classifier) {
  const hl_transfer_function *function = &volume->transfer_function;
  hl_key_add_whole(key, (int64_t)(uintptr_t)volume->volume);
  hl_key_add_affine(key, &grid->index_to_frame);
  hl_key_add_numbers(key, grid->box_low, 3); /* the box that remains after clipping */
  hl_key_add_numbers(key, grid->box_high, 3);
  hl_key_add_whole(key, 2 * (int64_t)grid->cut_count + grid->cut_casts_shadow);
  hl_cuts_key_add(key, grid->cuts, grid->cut_count);
  hl_key_add_numbers(key, &function->unit_distance, 1);
  add_points(key, function->opacity, function->opacity_count);
  add_points(key, function->gradient_opacity, function->gradient_opacity_count);
  add_plane(key, plane_mark, &classifier->plane);
  hl_key_add_numbers(key, volume->attenuation_color, 3);
  hl_key_add_whole(key, (int64_t)(uintptr_t)volume->mask.volume);
  if (volume->mask.volume != NULL) hl_key_add_numbers(key, &volume->mask.rest, 1);
  hl_key_add_whole(key, volume->casts_shadow != 0);
}
