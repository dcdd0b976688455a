/* grid/matter_key.c - see matter_key.h. */
#include "grid/matter_key.h"

static void add_points(hl_key *key, const hl_opacity_point *points, size_t count) {
  hl_key_add_whole(key, (int64_t)count);
  for (size_t p = 0; p < count; p++)
    hl_key_add_numbers(key, (double[2]){points[p].value, points[p].opacity}, 2);
}

void hl_matter_key_add(hl_key *key, const hl_scene_volume *volume, const grid *grid) {
  const hl_transfer_function *function = &volume->transfer_function;
  hl_key_add_whole(key, (int64_t)(uintptr_t)volume->volume);
  for (int row = 0; row < 3; row++) hl_key_add_numbers(key, &grid->index_to_frame.linear.row[row].x, 3);
  hl_key_add_numbers(key, &grid->index_to_frame.offset.x, 3);
  hl_key_add_numbers(key, grid->box_low, 3); /* the box that clipping leaves */
  hl_key_add_numbers(key, grid->box_high, 3);
  hl_key_add_whole(key, 2 * (int64_t)grid->cut_count + grid->cut_casts_shadow);
  for (size_t i = 0; i < grid->cut_count; i++) {
    const cut_shape *cut = &grid->cuts[i];
    hl_key_add_whole(key, 2 * (int64_t)cut->type + cut->keep_inside);
    for (int row = 0; row < 3; row++) hl_key_add_numbers(key, &cut->to_shape.linear.row[row].x, 3);
    hl_key_add_numbers(key, &cut->to_shape.offset.x, 3);
  }
  hl_key_add_numbers(key, &function->unit_distance, 1);
  add_points(key, function->opacity, function->opacity_count);
  add_points(key, function->gradient_opacity, function->gradient_opacity_count);
  hl_key_add_numbers(key, volume->attenuation_color, 3);
  hl_key_add_whole(key, (int64_t)(uintptr_t)volume->mask.volume);
  if (volume->mask.volume != NULL) hl_key_add_numbers(key, &volume->mask.rest, 1);
  hl_key_add_whole(key, volume->casts_shadow != 0);
}
