/* field/lookup_lanes.h - finds the sky's light at samples, interpolated between the cells of the sky's field.
 *
 * A cell's harmonics are numbers of 16 bits, and fill one cache line (sky_field.h). Two neighbouring cells
 * along x are multiplied by their weights and added at once. The sums of four such pairs are the harmonics at
 * a sample. All sums are of whole numbers, and so are the same on every processor. */
#ifndef HL_FIELD_LOOKUP_LANES_H
#define HL_FIELD_LOOKUP_LANES_H

#include "field/harmonics.h"
#include "field/sky_field.h"
#include "simd/lanes.h"

/* The light that reaches sixteen samples, as sums of harmonics over the cells around each sample, in the
 * field's units. The caller divides each sum by the sum of the cells' weights. */
typedef struct sky_rows {
  float of[LANES][2 * LANES]; /* [lane][FIELD_HARMONICS][channels]; the sums of each lane; set only for the
                               * active lanes */
  lanes unit;                 /* 1 over the sum of the weights of a lane's cells */
  uint32_t active;
} sky_rows;

/* Finds between which two cells a position lies along one axis. Returns the number of the first of these
 * cells. *fraction: receives the fraction of the way to the second cell. */
LANES_INLINE lanes place_between_cells(const sky_light *sky, int axis, lanes position, lanes *fraction) {
  lanes at = lanes_line(position - sky->low[axis], sky->inverse_cell, -0.5f);
  at = lanes_clamp(at, 0, (float)sky->count[axis] - 1.001f);
  lanes whole = lanes_from_int(lanes_truncate(at));
  *fraction = at - whole;
  return whole;
}

/* The weight of a cell among the cells around a position. In media and on meshes (`surface` is 0) it is the
 * trilinear weight times the cell's transmittance. On a volume's surface (`surface` is 1) it is the trilinear
 * weight times the sixth power of the transmittance, so that cells half filled with matter do not darken the
 * outside of the surface. */
LANES_INLINE lanes weight_of_cell(lanes trilinear, lanes_int stored, lanes surface) {
  lanes passing = lanes_from_int(stored) * (1.0f / SKY_MOST), squared = passing * passing,
        counted = passing * lanes_fma(surface, squared * squared * passing - 1.0f, lanes_set(1.0f));
  return trilinear * lanes_max(counted, lanes_set(LEAST_COUNTED));
}

/* For each of sixteen positions, the first of the eight cells around it. */
typedef struct sky_cells {
  int32_t rows[LANES], columns[LANES]; /* the first cell's row, counted through all slices, and its column */
  lanes fraction[3];                   /* fraction of the way to the next cell along each axis */
} sky_cells;

/* The distances, in numbers of 16 bits, from the first of a lane's eight cells to the first cell of each of
 * the four pairs: the pair in the same row, in the next row, in the next slice, and in the next row of the
 * next slice. */
typedef struct sky_steps {
  size_t to_pair[4];
} sky_steps;

LANES_INLINE sky_steps steps_of_sky(const sky_light *sky) {
  const size_t row = sky->row_numbers, slice = row * (size_t)sky->count[1];
  return (sky_steps){{0, row, slice, row + slice}};
}

LANES_INLINE const int16_t *cell_of_lane(const sky_light *sky, const sky_cells *cells, int lane) {
  return sky->cells + (size_t)cells->rows[lane] * sky->row_numbers + (size_t)cells->columns[lane] * SKY_CELL;
}

/* The distance, in numbers of 16 bits, from the first of a lane's eight cells to cell number `cell` of
 * them. */
LANES_INLINE size_t step_to_cell(const sky_steps *steps, int corner) {
  return steps->to_pair[corner >> 1] + (corner & 1 ? SKY_CELL : 0);
}

/* Finds a cell, among the eight around a position, that no surface separates from the position. Derived:
 * three ways go from a cell to its neighbours along the axes, and a flat surface cuts them at the fractions
 * d[i] of their lengths. A position at the fractions e[i] lies on the cell's side of the surface if the sum
 * of e[i] / d[i] is below 1. */
static int cell_on_side(const int16_t *cell, const sky_steps *steps, const float fraction[3]) {
  int corner = (fraction[0] >= 0.5f) + 2 * (fraction[1] >= 0.5f) + 4 * (fraction[2] >= 0.5f);
  for (int step = 0; step < 3; step++) {
    float sum = 0, most = 0;
    int across = 0;
    for (int axis = 0; axis < 3; axis++) {
      const int16_t cut = cell[step_to_cell(steps, corner & ~(1 << axis)) + SKY_CUT(axis)];
      if (cut == 0) continue;
      const float place = (float)cut * (1.0f / SKY_MOST), far = corner >> axis & 1 ? 1 - place : place,
                  way = corner >> axis & 1 ? 1 - fraction[axis] : fraction[axis];
      const float part = way / (far > 1e-3f ? far : 1e-3f);
      sum += part;
      if (part > most) most = part, across = axis;
    }
    if (sum <= 1) return corner;
    corner ^= 1 << across;
  }
  return corner;
}

/* Finds which of eight cells can be reached from cell number `corner` by ways that no surface cuts; one bit
 * for each cell. open: for each axis, the ways along it that no surface cuts; the bit of a way is the bit of
 * its first cell. */
static uint32_t cells_from(int corner, const uint32_t open[3]) {
  uint32_t reached = 1u << corner, before = 0;
  while (reached != before) {
    before = reached;
    for (int axis = 0; axis < 3; axis++)
      reached |= (reached & open[axis]) << (1 << axis) | (reached >> (1 << axis) & open[axis]);
  }
  return reached;
}

/* Finds which of a lane's eight cells surfaces separate from the position, and sets the weights of these
 * cells to 0. weight: the weights of the eight cells, LANES floats apart. */
static void weigh_parted_cells(const sky_light *sky, const int16_t *cell, const float fraction[3],
                               float *weight) {
  static const uint32_t first[3] = {0x55, 0x33, 0x0f};
  const sky_steps steps = steps_of_sky(sky);
  uint32_t open[3] = {first[0], first[1], first[2]}, all = 0;
  for (int corner = 0; corner < 8; corner++)
    for (int axis = 0; axis < 3; axis++)
      if ((first[axis] >> corner & 1) && cell[step_to_cell(&steps, corner) + SKY_CUT(axis)] != 0)
        open[axis] &= ~(1u << corner), all = 1;
  if (all == 0) return;
  const int own = cell_on_side(cell, &steps, fraction);
  const uint32_t reached = cells_from(own, open);
  for (int corner = 0; corner < 8; corner++)
    if (!(reached >> corner & 1)) weight[corner * LANES] = 0;
  if (weight[own * LANES] < LEAST_COUNTED) weight[own * LANES] = LEAST_COUNTED;
}

/* Finds the trilinear weights of the eight cells around positions. Two weights that follow each other belong
 * to two neighbouring cells along x. */
LANES_INLINE void weigh_evenly(const lanes fraction[3], lanes weight[8]) {
  for (int pair = 0; pair < 4; pair++) {
    lanes across = (pair & 1 ? fraction[1] : 1.0f - fraction[1]) *
                   (pair & 2 ? fraction[2] : 1.0f - fraction[2]),
          second = across * fraction[0];
    weight[2 * pair] = across - second;
    weight[2 * pair + 1] = second;
  }
}

/* Sets the weights of cells that surfaces separate from the active lanes' positions to 0. */
LANES_INLINE void weigh_on_one_side(const sky_light *sky, const sky_cells *cells, uint32_t active,
                                    lanes weight[8]) {
  float of[8][LANES], fraction[3][LANES];
  memcpy(of, weight, sizeof of);
  memcpy(fraction, cells->fraction, sizeof fraction);
  for (uint32_t left = active; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    const float own[3] = {fraction[0][lane], fraction[1][lane], fraction[2][lane]};
    weigh_parted_cells(sky, cell_of_lane(sky, cells, lane), own, &of[0][lane]);
  }
  memcpy(weight, of, sizeof of);
}

/* Turns the transmittances of eight cells, in pairs along x, into the cells' weights, in the same pairs. The
 * weights are whole numbers; their sum is about SKY_MOST. Returns 1 over their sum. weight: trilinear
 * weights. */
LANES_INLINE lanes weigh_cells(lanes weight[8], lanes surface, lanes_int pairs[4]) {
  lanes sum = lanes_set(0);
  for (int pair = 0; pair < 4; pair++) {
    weight[2 * pair] = weight_of_cell(weight[2 * pair], pairs[pair] & 0xffff, surface);
    weight[2 * pair + 1] = weight_of_cell(weight[2 * pair + 1], pairs[pair] >> 16, surface);
    sum = sum + (weight[2 * pair] + weight[2 * pair + 1]);
  }
  lanes scale = (float)SKY_MOST / sum;
  lanes_int total = lanes_set_int(0);
  for (int pair = 0; pair < 4; pair++) {
    lanes_int first = lanes_truncate(lanes_fma(weight[2 * pair], scale, lanes_set(0.5f))),
              second = lanes_truncate(lanes_fma(weight[2 * pair + 1], scale, lanes_set(0.5f)));
    pairs[pair] = first | second << 16;
    total = total + (first + second);
  }
  return 1.0f / lanes_from_int(total);
}

LANES_INLINE void find_cells(const sky_light *sky, lanes3 position, sky_cells *cells) {
  const lanes at[3] = {position.x, position.y, position.z};
  lanes first[3];
  for (int axis = 0; axis < 3; axis++)
    first[axis] = place_between_cells(sky, axis, at[axis], &cells->fraction[axis]);
  /* row numbers are whole numbers below 2^24, which floats hold exactly */
  lanes_int row = lanes_truncate(lanes_add_scaled(first[1], first[2], (float)sky->count[1])),
            column = lanes_truncate(first[0]);
  memcpy(cells->rows, &row, sizeof cells->rows);
  memcpy(cells->columns, &column, sizeof cells->columns);
}

/* Prefetches the cells of the sky's field around positions. Without this, samples would mostly wait for
 * memory. */
LANES_INLINE void fetch_sky(const sky_light *sky, lanes3 position, uint32_t active) {
  const sky_steps steps = steps_of_sky(sky);
  sky_cells cells;
  find_cells(sky, position, &cells);
  const int16_t *last = NULL;
  for (uint32_t left = active; left != 0; left &= left - 1) {
    const int16_t *cell = cell_of_lane(sky, &cells, __builtin_ctz(left));
    if (cell == last) continue;
    last = cell;
    for (int pair = 0; pair < 4; pair++) {
      __builtin_prefetch(cell + steps.to_pair[pair]);
      __builtin_prefetch(cell + steps.to_pair[pair] + SKY_CELL);
    }
  }
}

/* Adds up the eight cells around each active lane's position. pairs: the cells' weights. halves: the number
 * of halves of a cell's numbers that are read, 1 or 2; the mean of the light is in the first half. */
LANES_INLINE void add_cells(const sky_light *sky, const sky_cells *cells, const int32_t pairs[4][LANES],
                            int halves, sky_rows *found) {
  const sky_steps steps = steps_of_sky(sky);
  for (uint32_t left = found->active; left != 0; left &= left - 1) {
    int lane = __builtin_ctz(left);
    const int16_t *cell = cell_of_lane(sky, cells, lane);
    lanes_int sum[2] = {lanes_set_int(0), lanes_set_int(0)};
    for (int pair = 0; pair < 4; pair++) {
      lanes_int weights = lanes_set_int(pairs[pair][lane]), two[2], both[2];
      memcpy(two, cell + steps.to_pair[pair], sizeof two);
      lanes_unpack_shorts(two, both);
      for (int half = 0; half < halves; half++)
        sum[half] = sum[half] + lanes_multiply_shorts(both[half], weights);
    }
    for (int half = 0; half < halves; half++)
      lanes_store(found->of[lane] + half * LANES, lanes_from_int(sum[half]));
  }
}

/* Looks up the light between the eight cells around the position of each active lane. surface: 1 on surfaces
 * of a volume's matter, 0 in media and on meshes. whole: Returns false if only the mean over all directions
 * is needed. */
LANES_INLINE void look_up_sky(const sky_light *sky, lanes3 position, lanes surface, uint32_t active,
                              bool whole, sky_rows *found) {
  const sky_steps steps = steps_of_sky(sky);
  int32_t pairs[4][LANES];
  lanes_int of_lanes[4];
  sky_cells cells;
  find_cells(sky, position, &cells);
  memset(pairs, 0, sizeof pairs);
  for (uint32_t left = active; left != 0; left &= left - 1) {
    int lane = __builtin_ctz(left);
    const int16_t *passing = cell_of_lane(sky, &cells, lane) + SKY_PASSING;
    for (int pair = 0; pair < 4; pair++)
      memcpy(&pairs[pair][lane], passing + steps.to_pair[pair], sizeof pairs[pair][lane]);
  }
  memcpy(of_lanes, pairs, sizeof of_lanes);
  lanes weight[8];
  weigh_evenly(cells.fraction, weight);
  if (sky->cut) weigh_on_one_side(sky, &cells, active, weight);
  found->unit = weigh_cells(weight, surface, of_lanes);
  found->active = active;
  memcpy(pairs, of_lanes, sizeof pairs);
  if (whole) add_cells(sky, &cells, pairs, 2, found);
  else add_cells(sky, &cells, pairs, 1, found);
}

/* Gives each active lane one harmonic of the light in one channel, divided by the sum of the weights.
 * Inactive lanes get 0. */
LANES_INLINE lanes harmonic_of_rows(const sky_light *sky, const sky_rows *rows, int channel, int k) {
  float column[LANES] = {0};
  for (uint32_t left = rows->active; left != 0; left &= left - 1) {
    int lane = __builtin_ctz(left);
    column[lane] = rows->of[lane][k * sky->channels + channel];
  }
  return lanes_load(column) * (rows->unit * sky->stored_unit[channel]);
}

/* The terms of the second degree in the sum over harmonics of light times the harmonic's value in the
 * direction d. */
LANES_INLINE lanes second_degree(const lanes *light, lanes3 d) {
  return (light[4] * d.x * d.y + light[5] * d.y * d.z + light[6] * d.z * d.x) * (float)HARMONIC_2 +
         light[7] * lanes_line(d.z * d.z, 3.0f, -1.0f) * (float)HARMONIC_20 +
         light[8] * (d.x * d.x - d.y * d.y) * (float)HARMONIC_22;
}

/* Finds the factor with which each harmonic adds to 1 / pi times the integral of light and cosine. The
 * cosine's factors are 1, 2/3 and 1/4 (Ramamoorthi and Hanrahan 2001, divided by pi). */
LANES_INLINE void factors_of_surface(lanes3 normal, lanes factors[FIELD_HARMONICS]) {
  const float first = (float)HARMONIC_1 * (2.0f / 3), second = (float)HARMONIC_2 * 0.25f;
  factors[0] = lanes_set((float)HARMONIC_0);
  factors[1] = normal.x * first;
  factors[2] = normal.y * first;
  factors[3] = normal.z * first;
  factors[4] = normal.x * normal.y * second;
  factors[5] = normal.y * normal.z * second;
  factors[6] = normal.z * normal.x * second;
  factors[7] = lanes_line(normal.z * normal.z, 3.0f, -1.0f) * ((float)HARMONIC_20 * 0.25f);
  factors[8] = (normal.x * normal.x - normal.y * normal.y) * ((float)HARMONIC_22 * 0.25f);
}

/* The light that a surface receives from the sky: 1 / pi times the integral of light and cosine, in each
 * channel of the field. Inactive lanes get 0. */
LANES_INLINE void light_of_surface(const sky_light *sky, const sky_rows *rows, lanes3 normal,
                                   lanes light[3]) {
  typedef float quad __attribute__((vector_size(16)));
  lanes factors[FIELD_HARMONICS];
  float of[FIELD_HARMONICS][LANES], sums[3][LANES] = {{0}};
  factors_of_surface(normal, factors);
  memcpy(of, factors, sizeof of);
  if (sky->channels == 1) {
    for (uint32_t left = rows->active; left != 0; left &= left - 1) {
      int lane = __builtin_ctz(left);
      float sum = 0;
      for (int k = 0; k < FIELD_HARMONICS; k++) sum = sum + rows->of[lane][k] * of[k][lane];
      sums[0][lane] = sum;
    }
  } else {
    for (uint32_t left = rows->active; left != 0; left &= left - 1) {
      int lane = __builtin_ctz(left);
      quad sum = {0, 0, 0, 0};
      for (int k = 0; k < FIELD_HARMONICS; k++) {
        quad colors;
        memcpy(&colors, rows->of[lane] + 3 * k, sizeof colors);
        sum = sum + colors * of[k][lane];
      }
      for (int c = 0; c < 3; c++) sums[c][lane] = sum[c];
    }
  }
  for (int c = 0; c < sky->channels; c++)
    light[c] = lanes_max(lanes_load(sums[c]) * (rows->unit * sky->stored_unit[c]), lanes_set(0));
}

/* The light that a surface receives from the sky if nothing hides the sky: 1 / pi times the integral of light
 * and cosine, in each channel of the field. */
LANES_INLINE void open_light_of_surface(const sky_light *sky, lanes3 normal, lanes light[3]) {
  lanes factors[FIELD_HARMONICS];
  factors_of_surface(normal, factors);
  for (int c = 0; c < sky->channels; c++) {
    lanes sum = lanes_set(0);
    for (int k = 0; k < FIELD_HARMONICS; k++) sum = lanes_add_scaled(sum, factors[k], sky->open[c][k]);
    light[c] = lanes_max(sum, lanes_set(0));
  }
}

#endif
