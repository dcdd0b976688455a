/* gpu/kernels/sample.h - finds the density at a point and its gradient, and whether the point's cell may show
 * anything. The functions compute for one pixel the same numbers as fill/gather_lanes.h,
 * fill/gradient_lanes.h and fill/block_lanes.h for sixteen. */
#ifndef HL_GPU_SAMPLE_H
#define HL_GPU_SAMPLE_H

#include "core/sheet_constants.h"
#include "gpu/kernels/cuts.h"
#include "gpu/kernels/taps.h"

/* Whether a volume has a property that some volume of the variant has. A single volume has all properties of
 * its variant. */
#if VOLUMES > 1
#define HAS(volume, property) ((volume)->property)
#else
#define HAS(volume, property) 1
#endif

/* The greatest number of `distances` below. */
#define FARTHEST_BRICK 9

/* A volume on the device. */
typedef struct volume_data {
  GLOBAL const plan_volume *plan;
  GLOBAL const byte *voxels;          /* the volume's voxels, or the coefficients of bricks, one brick after
                                       * the other */
  GLOBAL const plan_brick *directory; /* [z][y][x] blocks of cells; read only if the volume is in bricks */
  GLOBAL const byte *distances;       /* [bricks z][y][x]; distance, in bricks, to the nearest brick that may
                                       * show anything: the greatest of the distances along the three axes,
                                       * and at most FARTHEST_BRICK */
  GLOBAL const wide *cell_bits;       /* [bricks z][y][x]; read only where plan->has_cell_bits */
  GLOBAL const float *tables;
  GLOBAL const byte *colors; /* [z][y][x][4]; read only if the voxels have colours */
  GLOBAL const byte *mask;   /* the mask's parts (kernels/mask.h); read only if there is a mask */
  GLOBAL const float
      *phases; /* the table of the phase function (kernels/phase.h); read only if there is one */
  GLOBAL const plan_cut *cuts;      /* the volume's cuts in the eye's view; the cuts in a light's view come
                                     * plan_light.first_cut cuts later */
  GLOBAL const plan_bounds *bounds; /* the volume's bounds in the eye's view */
} volume_data;

/* A volume's bounds in the view of a light. */
DEVICE GLOBAL const plan_bounds *bounds_in_light(const volume_data *volume, GLOBAL const plan_light *light) {
  return volume->bounds + (1 + light->number) * VOLUMES;
}

/* The position of a point in the grid; index space, clamped to [-1, n). */
typedef struct grid_point {
  float at[3];
  int inside; /* whether the point lies in the grid or at most GRID_MARGIN outside */
} grid_point;

DEVICE grid_point point_in_grid(GLOBAL const plan_volume *volume, vector p) {
  grid_point point;
  point.inside = 1;
  point.at[0] = p.x;
  point.at[1] = p.y;
  point.at[2] = p.z;
  for (int a = 0; a < 3; a++) {
    float count = (float)volume->dimension[a];
    point.inside = point.inside && point.at[a] > -0.5f - GRID_MARGIN &&
                   point.at[a] < count - 0.5f + GRID_MARGIN;
    point.at[a] = limited(point.at[a], -1.0f, count * (1 - 1e-6f));
  }
  return point;
}

/* Returns whether the point's cell may show something (grid/relevant.h). *voxels: a distance, in voxels along
 * each axis, within which no cell shows anything; 0 if the point's own brick may show something. */
DEVICE int cell_may_show(const volume_data *volume, const grid_point *point, float *voxels) {
  GLOBAL const plan_volume *plan = volume->plan;
  *voxels = 0.0f;
  if (!point->inside) return 0;
  int x = whole_below(point->at[0]) + 1, y = whole_below(point->at[1]) + 1, z = whole_below(point->at[2]) + 1;
  unsigned brick_row = (unsigned)(z >> 2) * (unsigned)plan->brick_count[1] + (unsigned)(y >> 2);
  wide brick = (wide)brick_row * (unsigned)plan->brick_count[0] + (unsigned)(x >> 2);
  int bricks = volume->distances[brick];
  if (bricks > 0) {
    *voxels = (float)(bricks - 1) * 4.0f;
    return 0;
  }
  if (!plan->has_cell_bits) return 1;
  return (int)(volume->cell_bits[brick] >> ((x & 3) | (y & 3) << 2 | (z & 3) << 4) & 1);
}

/* The taps around a point. cell: tap 0 is at cell - 1. part: the point's position in this cell. step: the
 * edge of a voxel, in cells of the taps. even: the field has one value, `value`, everywhere around the
 * point. */
typedef struct tap_place {
  int cell[3];
  float part[3], step, value;
  int even;
} tap_place;

/* Finds the taps around a point of index space. For a field in bricks, it finds them as lanes_in_brick() in
 * fill/gather_lanes.h does; the third coordinate of the cell counts the slices of the coefficients of all
 * bricks. */
DEVICE tap_place place_of_taps(const volume_data *volume, const float at[3]) {
  tap_place place;
  place.even = 0;
  place.step = 1.0f;
  place.value = 0.0f;
  for (int a = 0; a < 3; a++) {
    place.cell[a] = whole_below(at[a]);
    place.part[a] = at[a] - (float)place.cell[a];
  }
#if BRICKS
  GLOBAL const plan_volume *plan = volume->plan;
  if (!HAS(plan, bricks)) return place;
  wide block = 0;
  for (int a = 2; a >= 0; a--) {
    const int last = plan->directory_size[a] - 1, own = (place.cell[a] + 1) >> plan->brick_shift;
    block = block * (unsigned)(last + 1) + (unsigned)(own < 0 ? 0 : own > last ? last : own);
  }
  const plan_brick brick = volume->directory[block];
  const int level = brick.level, shift = plan->brick_shift + level, below = (1 << level) - 1;
  place.even = brick.slot < 0;
  place.value = brick.value;
  place.step = divided(1.0f, (float)(1 << level));
  for (int a = 0; a < 3; a++) {
    const int cell = place.cell[a] + 1;
    place.cell[a] = ((cell & ((1 << shift) - 1)) >> level) + 1;
    place.part[a] = ((float)(cell & below) + place.part[a]) * place.step;
  }
  place.cell[2] += brick.slot * (int)plan->slice_rows;
#else
  (void)volume;
#endif
  return place;
}

/* Returns whether any tap around a cell lies outside the grid along an axis. In a field in bricks no tap
 * does, because bricks hold all taps of their cells. */
DEVICE int taps_leave(GLOBAL const plan_volume *volume, int cell, int axis) {
  return !(BRICKS && HAS(volume, bricks)) && !taps_inside(cell, volume->dimension[axis]);
}

DEVICE GLOBAL const byte *first_row(const volume_data *volume, const int cell[3]) {
  GLOBAL const plan_volume *plan = volume->plan;
  wide row = (wide)(unsigned)(cell[2] - 1) * plan->slice_rows + (unsigned)(cell[1] - 1);
  const int voxel_bytes = STORAGE == STORED_U8 ? 1 : STORAGE == STORED_U16 ? 2 : 4;
  return volume->voxels + row * plan->row_bytes + (unsigned)((cell[0] - 1) * voxel_bytes);
}

/* The weighted sum of a row of four taps. */
#if STORAGE == STORED_F32
#define row_sum(row, shift, w) sum_row(row, &(w))
#else
#define row_sum(row, shift, w) ((float)weigh(load_row(row, shift), w))
#endif

/* The weighted sum of the 4x4x4 voxels around a point, less the empty value. The point must lie inside. Sums
 * of pairs along x come first, then sums along y, then along z. */
DEVICE float density_at(const volume_data volume, float x, float y, float z) {
  GLOBAL const plan_volume *plan = volume.plan;
  const float at[3] = {x, y, z};
  tap_place place = place_of_taps(&volume, at);
  float weight[3][4];
  int outside = 0;
  if (place.even) return place.value - plan->empty;
  for (int a = 0; a < 3; a++) {
    tap_weights(plan, place.part[a], weight[a]);
    outside = outside || taps_leave(plan, place.cell[a], a);
  }
  if (outside) {
#if STORAGE != STORED_F32
    int rounded[4];
    round_weights(weight[0], WEIGHT_UNITS, 1, rounded);
    for (int tap = 0; tap < 4; tap++) weight[0][tap] = (float)rounded[tap] * (1.0f / WEIGHT_UNITS);
#endif
    for (int a = 0; a < 3; a++) place.cell[a] = fold_border(place.cell[a], plan->dimension[a], weight[a]);
  }
  row_weights along = weights_of_row(weight[0]);
  GLOBAL const byte *slice = first_row(&volume, place.cell);
  const unsigned shift = shift_of_row(slice);
  slice -= shift >> 3; /* all rows have the same alignment */
  const wide row_bytes = plan->row_bytes, slice_bytes = plan->slice_rows * row_bytes;
  float sum = 0.0f;
  UNROLLED for (int k = 0; k < 4; k++, slice += slice_bytes) {
    GLOBAL const byte *row = slice;
    float plane = 0.0f;
    UNROLLED for (int j = 0; j < 4; j++, row += row_bytes)
        plane = fused(row_sum(row, shift, along), weight[1][j], plane);
    sum = fused(plane, weight[2][k], sum);
  }
  return from_units(sum) - plan->empty;
}

/* The gradient at a point of frame space; stored units per frame unit. */
DEVICE_CALL vector gradient_at(const volume_data volume, vector point) {
  GLOBAL const plan_volume *plan = volume.plan;
  float weight[3][4], slope[3][4], at[3];
  int outside = 0;
  for (int a = 0; a < 3; a++)
    at[a] = limited(row_of_point(plan->to_index[a], point), -1.0f, (float)plan->dimension[a] * (1 - 1e-6f));
  tap_place place = place_of_taps(&volume, at);
  if (place.even) return vector_of(0.0f, 0.0f, 0.0f);
  for (int a = 0; a < 3; a++) {
    tap_weights(plan, place.part[a], weight[a]);
    tap_slopes(plan, place.part[a], slope[a]);
    if (BRICKS)
      for (int tap = 0; tap < 4; tap++) slope[a][tap] = slope[a][tap] * place.step;
    outside = outside || taps_leave(plan, place.cell[a], a);
  }
  if (outside)
    for (int a = 0; a < 3; a++) {
      fold_border(place.cell[a], plan->dimension[a], slope[a]);
      place.cell[a] = fold_border(place.cell[a], plan->dimension[a], weight[a]);
    }
  row_weights weights = weights_of_row(weight[0]), slopes = slopes_of_row(slope[0]);
  GLOBAL const byte *slice = first_row(&volume, place.cell);
  const unsigned shift = shift_of_row(slice);
  slice -= shift >> 3; /* all rows have the same alignment */
  const wide row_bytes = plan->row_bytes, slice_bytes = plan->slice_rows * row_bytes;
  float sum_x = 0.0f, sum_y = 0.0f, sum_z = 0.0f;
  UNROLLED for (int k = 0; k < 4; k++, slice += slice_bytes) {
    GLOBAL const byte *row = slice;
    float value = 0.0f, along_x = 0.0f, along_y = 0.0f;
    UNROLLED for (int j = 0; j < 4; j++, row += row_bytes) {
#if STORAGE == STORED_F32
      float plain = sum_row(row, &weights), rising = slope_row(row, &slopes);
#else
      row_voxels voxels = load_row(row, shift);
      float plain = (float)weigh(voxels, weights), rising = (float)weigh_signed(voxels, slopes);
#endif
      along_x = fused(rising, weight[1][j], along_x);
      along_y = fused(plain, slope[1][j], along_y);
      value = fused(plain, weight[1][j], value);
    }
    sum_x = fused(along_x, weight[2][k], sum_x);
    sum_y = fused(along_y, weight[2][k], sum_y);
    sum_z = fused(value, slope[2][k], sum_z);
  }
  vector found = scaled(vector_at(plan->to_index[2]), from_units(sum_z));
  found = add_scaled(found, vector_at(plan->to_index[1]), from_units(sum_y));
  return add_scaled(found, vector_at(plan->to_index[0]), from_slope_units(sum_x));
}

#endif
