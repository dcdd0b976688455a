/* grid/mask_lattice.c - see mask_lattice.h. */
#include "grid/mask_lattice.h"

#include "scene/placement.h"

void hl_mask_lattice_set_up(mask_lattice *lattice, const hl_scene_volume *volume) {
  const hl_volume *mask = volume->mask.volume;
  affine3 to_index;
  *lattice = (mask_lattice){0};
  if (mask == NULL || !affine3_invert(hl_scene_mask_index_to_world(volume), &to_index)) return;
  lattice->factors = mask->voxels;
  lattice->colors = mask->colors;
  lattice->rest = (float)volume->mask.rest;
  const double offset[3] = {to_index.offset.x, to_index.offset.y, to_index.offset.z};
  int32_t step = 1;
  for (int axis = 0; axis < 3; axis++) {
    lattice->last[axis] = (int32_t)mask->dimension[axis] - 1;
    lattice->step[axis] = step;
    if (axis < 2) step *= (int32_t)mask->dimension[axis];
    vec3_store(lattice->to_index[axis], to_index.linear.row[axis]);
    lattice->to_index[axis][3] = (float)offset[axis];
  }
}

void hl_mask_tint(const mask_lattice *lattice, const float point[3], float color[3]) {
  mask_cell cell;
  float sum[3] = {0, 0, 0}, weights = 0, share;
  if (lattice->colors == NULL || !hl_mask_cell_at(lattice, point, &cell)) return;
  for (int corner = 0; corner < 8; corner++) {
    const unsigned char *code = lattice->colors + 4 * hl_mask_corner(&cell, corner, &share);
    float weight = share * (float)code[3];
    weights += weight;
    for (int c = 0; c < 3; c++) sum[c] += weight * (float)(code[c] * code[c]) * (1.0f / (255 * 255));
  }
  for (int c = 0; c < 3; c++)
    if (weights > 0) color[c] += (sum[c] / weights - color[c]) * (weights * (1.0f / 255));
}
