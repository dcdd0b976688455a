/* field/opacity_lanes.h - finds how much light sixteen cells absorb along the axes.
 *
 * A cell is sampled on a small lattice within the cell. The cell's transmittance along an axis is the mean of
 * the transmittances of its rows of samples, so that a cell that is half filled with dense matter lets half
 * of the light through (derived). */
#ifndef HL_FIELD_OPACITY_LANES_H
#define HL_FIELD_OPACITY_LANES_H

#include "field/field.h"
#include "grid/field.h"
#include "simd/lanes.h"

/* A volume's extinction at a density, per frame unit: a linear look-up in the classifier's table. */
LANES_INLINE float field_extinction(const classifier *classifier, float density) {
  float at = density * classifier->scale + classifier->offset;
  at = at > 0 ? at < CLASSIFIER_ENTRIES ? at : CLASSIFIER_ENTRIES : 0;
  int32_t entry = (int32_t)at;
  float from = classifier->sums[entry][0];
  return from + (classifier->sums[entry + 1][0] - from) * (at - (float)entry);
}

LANES_INLINE float stored_number(const unsigned char *row, hl_storage storage, int32_t x) {
  if (storage == HL_STORAGE_U8) return row[x];
  if (storage == HL_STORAGE_U16) return ((const uint16_t *)(const void *)row)[x];
  return ((const float *)(const void *)row)[x];
}

/* A box of voxels that a cell's samples share. */
enum { WINDOW_VOXELS = 512 };
typedef struct voxel_window {
  /* corner and size of the box, in voxels; a size of 0: the samples look up their voxels one by one */
  int32_t first[3], size[3];
  double voxels[WINDOW_VOXELS]; /* [size[2]][size[1]][size[0]]; the values of the box's voxels */
} voxel_window;

/* Fills the window with the voxels on which the values in a box depend. low, high: the box's corners; index
 * space. before: along each axis, a value depends on the voxel at or below its position, on `before` voxels
 * below this voxel, and on before + 1 voxels above it. The window stays empty where the voxels do not fit
 * into it, or where the samples together read no more voxels without a window. */
LANES_INLINE void fill_window(const grid *grid, const float low[3], const float high[3], int32_t before,
                              int samples, voxel_window *window) {
  const int64_t side = 2 * before + 2;
  int64_t count = 1;
  for (int a = 0; a < 3; a++) {
    window->first[a] = (int32_t)__builtin_floorf(low[a]) - before;
    window->size[a] = (int32_t)__builtin_floorf(high[a]) + before + 2 - window->first[a];
    count *= window->size[a];
  }
  if (count <= WINDOW_VOXELS && count < samples * side * side * side)
    hl_field_window(grid, window->first, window->size, window->voxels);
  else window->size[0] = 0;
}

/* Copies a cube of voxels, `side` long. */
LANES_INLINE void copy_voxels(const field_matter *matter, const voxel_window *window, const int32_t first[3],
                              int32_t side, float *voxels) {
  double own[FIELD_TAPS * FIELD_TAPS * FIELD_TAPS];
  int32_t at[3], row = side, slice = side * side;
  int within = 1;
  for (int a = 0; a < 3; a++) {
    at[a] = first[a] - window->first[a];
    within = within && window->size[0] > 0 && at[a] >= 0 && at[a] + side <= window->size[a];
  }
  const double *from = own;
  if (within) {
    row = window->size[0], slice = window->size[0] * window->size[1];
    from = window->voxels + at[2] * slice + at[1] * row + at[0];
  } else {
    hl_field_window(matter->grid, first, (const int32_t[3]){side, side, side}, own);
  }
  for (int z = 0; z < side; z++)
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++) *voxels++ = (float)from[z * slice + y * row + x];
}

/* The value of a volume at a position of index space, interpolated linearly between the voxels around the
 * position. Beyond the grid's faces the values at the border continue. */
LANES_INLINE float linear_value(const field_matter *matter, hl_storage storage, const voxel_window *window,
                                const float at[3]) {
  const grid *grid = matter->grid;
  int32_t first[3], next[3];
  float fraction[3];
  for (int a = 0; a < 3; a++) {
    float last = (float)(grid->dimension[a] - 1), within = at[a] > 0 ? at[a] < last ? at[a] : last : 0;
    first[a] = (int32_t)within;
    next[a] = first[a] + 1 < grid->dimension[a] ? first[a] + 1 : first[a];
    fraction[a] = within - (float)first[a];
  }
  float corner[2][2][2]; /* [z][y][x]; the values of the eight voxels around the position */
  if (grid->voxels != NULL) {
    for (int n = 0; n < 4; n++) {
      const unsigned char *row = hl_grid_row(grid, n & 1 ? next[1] : first[1], n >> 1 ? next[2] : first[2]);
      corner[n >> 1][n & 1][0] = stored_number(row, storage, first[0]);
      corner[n >> 1][n & 1][1] = stored_number(row, storage, next[0]);
    }
  } else {
    copy_voxels(matter, window, first, 2, &corner[0][0][0]);
  }
  float along[2];
  for (int z = 0; z < 2; z++) {
    float value[2];
    for (int y = 0; y < 2; y++)
      value[y] = corner[z][y][0] + (corner[z][y][1] - corner[z][y][0]) * fraction[0];
    along[z] = value[0] + (value[1] - value[0]) * fraction[1];
  }
  return along[0] + (along[1] - along[0]) * fraction[2];
}

/* The value, at a position of index space, of a cubic B-spline over coefficients. */
LANES_INLINE float smooth_value(const field_matter *matter, const voxel_window *window, const float at[3]) {
  float weight[3][FIELD_TAPS], voxels[FIELD_TAPS * FIELD_TAPS * FIELD_TAPS], sum = 0;
  int32_t first[3];
  for (int a = 0; a < 3; a++) {
    float base = __builtin_floorf(at[a]), t = at[a] - base, s = 1 - t;
    first[a] = (int32_t)base - 1;
    weight[a][0] = s * s * s / 6;
    weight[a][1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
    weight[a][2] = (4 - 6 * s * s + 3 * s * s * s) / 6;
    weight[a][3] = t * t * t / 6;
  }
  copy_voxels(matter, window, first, FIELD_TAPS, voxels);
  for (int n = 0; n < FIELD_TAPS * FIELD_TAPS * FIELD_TAPS; n++)
    sum += weight[0][n % FIELD_TAPS] * weight[1][n / FIELD_TAPS % FIELD_TAPS] *
           weight[2][n / (FIELD_TAPS * FIELD_TAPS)] * voxels[n];
  return sum;
}

LANES_INLINE float value_at(const field_matter *matter, hl_storage storage, const voxel_window *window,
                            const float at[3]) {
  return matter->smooth ? smooth_value(matter, window, at) : linear_value(matter, storage, window, at);
}

/* The gradient's length at a position of index space, in stored units per frame unit. Differences are taken
 * over the distance of a voxel. */
LANES_INLINE float gradient_at_position(const field_matter *matter, hl_storage storage,
                                        const voxel_window *window, const float at[3]) {
  float gradient[3] = {0, 0, 0};
  for (int a = 0; a < 3; a++) {
    float before[3] = {at[0], at[1], at[2]}, after[3] = {at[0], at[1], at[2]};
    before[a] -= 0.5f;
    after[a] += 0.5f;
    float slope = value_at(matter, storage, window, after) - value_at(matter, storage, window, before);
    for (int b = 0; b < 3; b++) gradient[b] += matter->to_index[a][b] * slope;
  }
  return __builtin_sqrtf(gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2]);
}

/* The factor by which gradient opacity multiplies extinction. */
LANES_INLINE float factor_of_length(const classifier *classifier, float length) {
  float entry = length * classifier->steepness_scale;
  entry = entry < STEEPNESS_ENTRIES ? entry : STEEPNESS_ENTRIES;
  const float *factors = classifier->steepness + (int32_t)entry;
  return factors[0] + (factors[1] - factors[0]) * (entry - (float)(int32_t)entry);
}

/* Returns whether the transfer function may show something in the grid's cell around a position. The values
 * here are interpolated linearly between voxels, and may show noise that the kernel smooths. The bits follow
 * from the kernel, so that such noise absorbs no light where nothing is drawn. */
LANES_INLINE int cell_shows(const grid *grid, const float at[3]) {
  int32_t cell[3], brick[3];
  if (grid->cell_bits == NULL) return 1;
  for (int a = 0; a < 3; a++) {
    int32_t last = grid->dimension[a];
    cell[a] = at[a] > -1 ? (int32_t)(at[a] + 1) : 0;
    if (cell[a] > last) cell[a] = last;
    brick[a] = cell[a] / HL_BRICK_CELLS;
  }
  int bit = cell[0] % HL_BRICK_CELLS + 4 * (cell[1] % HL_BRICK_CELLS) + 16 * (cell[2] % HL_BRICK_CELLS);
  return (int)(grid->cell_bits[hl_brick_index(grid, brick)] >> bit & 1);
}

/* Returns whether matter at a position absorbs light: either the cuts leave the matter there, or cut matter
 * still casts shadows. */
LANES_INLINE int cuts_leave_position(const grid *grid, const float at[3]) {
  return grid->cut_count == 0 || grid->cut_casts_shadow ||
         hl_cuts_leave(grid->cuts, grid->cut_count, (vec3){at[0], at[1], at[2]});
}

/* The extinction of a volume at a position `at` of its index space, which is `point` in frame space. Samples
 * on the low faces of a volume's box lie in the box, and samples on its high faces lie outside of it. So a
 * box keeps its thickness even if samples lie on both of its faces. */
LANES_INLINE float extinction_at_position(const field_matter *matter, hl_storage storage,
                                          const voxel_window *window, const float at[3],
                                          const float point[3]) {
  for (int a = 0; a < 3; a++)
    if (!(at[a] >= matter->low[a] && at[a] < matter->high[a])) return 0;
  if (!cell_shows(matter->grid, at) || !cuts_leave_position(matter->grid, at)) return 0;
  float value = value_at(matter, storage, window, at);
  const classifier *classifier = matter->classifier;
  float density = value - matter->grid->empty, extinction = field_extinction(classifier, density), length = 0;
  if (!(extinction > 0)) return 0;
  if (hl_classifier_needs_gradient(classifier)) length = gradient_at_position(matter, storage, window, at);
  if (classifier->plane.sums != NULL) {
    float second = classifier->plane.second != NULL ? hl_plane_second_at(&classifier->plane, point) : length;
    extinction = hl_plane_table_at(&classifier->plane, density * classifier->scale + classifier->offset,
                                   second)
                     .extinction;
  }
  extinction = matter->cast * extinction;
  if (classifier->steepness != NULL) extinction *= factor_of_length(classifier, length);
  if (classifier->mask.factors != NULL) extinction *= hl_mask_factor(&classifier->mask, point);
  return extinction;
}

/* Adds a volume's extinction to the samples of a cell. Returns whether any extinction was added. */
LANES_INLINE int sample_cell(const field_block *block, const field_matter *matter, hl_storage storage,
                             int lane, float (*samples)[FIELD_LANES]) {
  int n = block->samples, any = 0;
  float step = block->cell / (float)n;
  const float corner[3] = {block->corner[0] + block->cell * (float)lane + step * 0.5f,
                           block->corner[1] + step * 0.5f, block->corner[2] + step * 0.5f};
  float start[3], least[3], greatest[3];
  for (int a = 0; a < 3; a++) {
    const float *row = matter->to_index[a];
    start[a] = row[0] * corner[0] + row[1] * corner[1] + row[2] * corner[2] + row[3];
    least[a] = greatest[a] = start[a];
    for (int b = 0; b < 3; b++) {
      float reach = step * (float)(n - 1) * row[b];
      if (reach < 0) least[a] += reach;
      else greatest[a] += reach;
    }
  }
  voxel_window window;
  window.size[0] = 0;
  if (matter->grid->voxels == NULL || matter->smooth)
    fill_window(matter->grid, least, greatest, matter->smooth ? 1 : 0, n * n * n, &window);
  for (int k = 0; k < n; k++)
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) {
        if (block->every_other && (i + j + k) % 2 != 0) continue;
        float at[3];
        for (int a = 0; a < 3; a++) {
          const float *row = matter->to_index[a];
          at[a] = start[a] + step * ((float)i * row[0] + (float)j * row[1] + (float)k * row[2]);
        }
        const float point[3] = {corner[0] + step * (float)i, corner[1] + step * (float)j,
                                corner[2] + step * (float)k};
        float extinction = extinction_at_position(matter, storage, &window, at, point);
        samples[(k * n + j) * n + i][lane] += block->every_other ? 2 * extinction : extinction;
        any |= extinction > 0;
      }
  return any;
}

LANES_INLINE int sample_cells(const field_block *block, int volume, float (*samples)[FIELD_LANES]) {
  const field_matter *matter = &block->matter[volume];
  int any = 0;
  for (uint32_t left = block->cells[volume]; left != 0; left &= left - 1) {
    int lane = __builtin_ctz(left);
    switch (matter->grid->storage) {
      case HL_STORAGE_U8: any |= sample_cell(block, matter, HL_STORAGE_U8, lane, samples); break;
      case HL_STORAGE_U16: any |= sample_cell(block, matter, HL_STORAGE_U16, lane, samples); break;
      case HL_STORAGE_F32: any |= sample_cell(block, matter, HL_STORAGE_F32, lane, samples); break;
    }
  }
  return any;
}

/* The optical depth of cells along one axis, as a power of 1/2: -log2 of the mean of 2^-depth over n x n
 * rows of samples. along: distance in memory between a row's samples. first, second: distances between
 * rows. */
LANES_INLINE lanes depth_along(const float (*samples)[FIELD_LANES], int n, int along, int first, int second,
                               float scale) {
  lanes sum = lanes_set(0);
  for (int b = 0; b < n; b++)
    for (int a = 0; a < n; a++) {
      lanes depth = lanes_set(0);
      for (int i = 0; i < n; i++) depth = depth + lanes_load(samples[b * second + a * first + i * along]);
      sum = sum + lanes_exp2(lanes_max(depth * scale, lanes_set(-100.0f)));
    }
  return lanes_max(-lanes_log2(sum * (1.0f / (float)(n * n))), lanes_set(0));
}

static void field_opacity(const field_block *block, float depth[3][FIELD_LANES]) {
  float samples[FIELD_SAMPLES * FIELD_SAMPLES * FIELD_SAMPLES][FIELD_LANES];
  int n = block->samples, any = 0;
  for (int i = 0; i < n * n * n; i++) lanes_store(samples[i], lanes_set(0));
  for (int v = 0; v < block->count; v++) {
    if (block->matter[v].cast > 0) any |= sample_cells(block, v, samples);
  }
  if (!any) {
    for (int a = 0; a < 3; a++) lanes_store(depth[a], lanes_set(0));
    return;
  }
  const float scale = -1.44269504089f * block->cell / (float)n;
  lanes_store(depth[0], depth_along(samples, n, 1, n, n * n, scale));
  lanes_store(depth[1], depth_along(samples, n, n, 1, n * n, scale));
  lanes_store(depth[2], depth_along(samples, n, n * n, 1, n, scale));
}

#endif
