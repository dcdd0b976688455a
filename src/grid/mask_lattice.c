/* grid/mask_lattice.c - see mask_lattice.h. */
#include "grid/mask_lattice.h"

#include <math.h>

#include "scene/geometry/placement.h"

void hl_mask_lattice_set_up(mask_lattice *lattice, const hl_scene_volume *volume) {
  const hl_volume *mask = volume->mask.volume;
  affine3 to_index;
  *lattice = (mask_lattice){0};
  if (mask == NULL || !affine3_invert(hl_scene_mask_index_to_world(volume), &to_index)) return;
  lattice->factors = mask->voxels;
  lattice->colors = mask->colors;
  lattice->slopes = mask->slopes;
  lattice->slope_scale = (float)mask->slope_scale;
  lattice->bricks = (const uint32_t(*)[2])mask->mask_bricks;
  lattice->scale = (float)mask->value_scale;
  lattice->offset = (float)mask->value_offset;
  lattice->rest = (float)volume->mask.rest;
  int32_t step = 1, brick_step = 1;
  affine3_store(lattice->to_index, &to_index);
  for (int axis = 0; axis < 3; axis++) {
    lattice->last[axis] = (int32_t)mask->dimension[axis] - 1;
    lattice->step[axis] = step;
    lattice->brick_step[axis] = brick_step;
    if (axis == 2) break;
    step *= (int32_t)mask->dimension[axis];
    brick_step *= (lattice->last[axis] >> HL_MASK_BRICK_SHIFT) + 1;
  }
}

/* Finds the points of the lattice, along an axis, on which the mask's factor between two positions depends.
 * Returns false if some of these positions lie outside the lattice, and the factor outside the lattice is not
 * 0. */
static bool points_between(const mask_lattice *lattice, int axis, double low, double high, int32_t ends[2]) {
  const double last = lattice->last[axis];
  if (lattice->rest > 0 && (low < -0.5 || high > last + 0.5)) return false;
  ends[0] = (int32_t)fmin(fmax(floor(low), 0), last);
  ends[1] = (int32_t)fmin(fmax(floor(high) + 1, 0), last);
  return true;
}

bool hl_mask_hides_box(const mask_lattice *lattice, vec3 middle, const vec3 half[3]) {
  int32_t ends[3][2];
  for (int a = 0; a < 3; a++) {
    const float *row = lattice->to_index[a];
    const vec3 along = {(double)row[0], (double)row[1], (double)row[2]};
    double at = vec3_dot(along, middle) + (double)row[3], reach = 0;
    for (int h = 0; h < 3; h++) reach += fabs(vec3_dot(along, half[h]));
    if (!points_between(lattice, a, at - reach, at + reach, ends[a])) return false;
  }
  for (int32_t k = ends[2][0]; k <= ends[2][1]; k++)
    for (int32_t j = ends[1][0]; j <= ends[1][1]; j++) {
      const uint16_t *row = lattice->factors + (size_t)k * (size_t)lattice->step[2] +
                            (size_t)j * (size_t)lattice->step[1];
      for (int32_t i = ends[0][0]; i <= ends[0][1]; i++)
        if (lattice->scale * (float)row[i] + lattice->offset > 0) return false;
    }
  return true;
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
