/* field/sky_lanes.h - the sky's light moved from slice to slice (derived).
 *
 * Light of one direction that reaches a cell's middle left four cells of the slice before: it is
 * interpolated between them. What the cell itself absorbs is subtracted from the light that goes to the
 * next slice. Surfaces take their part of the light from each of the four cells. Beyond the lattice nothing
 * hides the light. */
#ifndef HL_FIELD_SKY_LANES_H
#define HL_FIELD_SKY_LANES_H

#include "field/field.h"
#include "simd/lanes.h"

/* Adds each direction's light to the harmonics of sixteen cells, multiplied by the direction's integrals.
 * Three sums at a time stay in registers while the directions go by; FIELD_HARMONICS is a multiple of
 * three. */
LANES_INLINE void add_harmonics(const sky_slice *slice, const lanes *reaching, int32_t column, float *cells,
                                int count) {
  float sums[3 * FIELD_HARMONICS][FIELD_LANES];
  for (int k = 0; k < count; k += 3) {
    lanes first = lanes_set(0), second = lanes_set(0), third = lanes_set(0);
    for (int d = 0; d < slice->direction_count; d++) {
      const float *basis = slice->directions[d].basis + k;
      first = lanes_fma(reaching[d], lanes_set(basis[0]), first);
      second = lanes_fma(reaching[d], lanes_set(basis[1]), second);
      third = lanes_fma(reaching[d], lanes_set(basis[2]), third);
    }
    lanes_store(sums[k], first);
    lanes_store(sums[k + 1], second);
    lanes_store(sums[k + 2], third);
  }
  int32_t valid = slice->columns - column;
  for (int32_t lane = 0; lane < FIELD_LANES && lane < valid; lane++)
    for (int k = 0; k < count; k++) cells[(size_t)lane * slice->across + (size_t)k] += sums[k][lane];
}

/* Adds a third of sixteen cells' transmittance along the axis. */
LANES_INLINE void add_passing(const sky_slice *slice, lanes depth, int32_t column, float *cells) {
  float passing[FIELD_LANES];
  lanes_store(passing, lanes_exp2(lanes_max(-depth, lanes_set(-100.0f))) * (1.0f / 3));
  for (int32_t lane = 0; lane < FIELD_LANES && lane < slice->columns - column; lane++)
    cells[(size_t)lane * slice->across + (size_t)slice->passing] += passing[lane];
}

/* The transmittance of cells for light that moves by u across and v down while it crosses a slice: its depth
 * is sqrt(d^2 + u^2 a^2 + v^2 b^2), where d, a and b are the depths along the axis, across and down. Derived:
 * even matter has one depth d along all axes, and light passes sqrt(1 + u^2 + v^2) cells of it. A surface at
 * a right angle to `down` has only the depth b. Light stays in its cells for 1 / v slices, and passes the
 * depth v b in each of them. */
LANES_INLINE lanes passing_cells(const lanes squared[3], const sky_direction *direction) {
  lanes depth = lanes_add_scaled(lanes_add_scaled(squared[0], squared[1], direction->across), squared[2],
                                 direction->down);
  return lanes_exp2(lanes_max(-lanes_sqrt(depth), lanes_set(-100.0f)));
}

/* The fractions of light that pass the links of sixteen cells; at: the first cell's place in a plane. */
LANES_INLINE void find_open_links(const sky_slice *slice, size_t at, lanes open[FIELD_LINKS]) {
  for (int k = 0; k < FIELD_LINKS; k++) {
    float passing[FIELD_LANES];
    const unsigned char *taken = slice->taken[k] + at;
    for (int lane = 0; lane < FIELD_LANES; lane++) passing[lane] = (float)(255 - taken[lane]) * (1.0f / 255);
    open[k] = lanes_load(passing);
  }
}

/* The light of a direction that comes to sixteen cells. from: the cells of the slice before, where the
 * light comes from. */
LANES_INLINE lanes light_from(const float *from, int32_t stride, const sky_direction *direction) {
  lanes light = lanes_load(from) * direction->weight[0];
  light = lanes_add_scaled(light, lanes_load(from + 1), direction->weight[1]);
  light = lanes_add_scaled(light, lanes_load(from + stride), direction->weight[2]);
  return lanes_add_scaled(light, lanes_load(from + stride + 1), direction->weight[3]);
}

/* The same light where surfaces cut links. */
LANES_INLINE lanes light_past_surfaces(const float *from, int32_t stride, const sky_direction *direction,
                                       const lanes open[FIELD_LINKS]) {
  const lanes *link = open + direction->link;
  lanes light = lanes_load(from) * link[0] * direction->weight[0];
  light = lanes_add_scaled(light, lanes_load(from + 1) * link[1], direction->weight[1]);
  light = lanes_add_scaled(light, lanes_load(from + stride) * link[3], direction->weight[2]);
  return lanes_add_scaled(light, lanes_load(from + stride + 1) * link[4], direction->weight[3]);
}

/* Moves the light of all directions to sixteen cells. at: the cells' place in a plane. squared: null where no
 * matter lies in the cells. open: null where no surface cuts their links. */
LANES_INLINE void move_light(const sky_slice *slice, size_t at, const lanes *squared, const lanes *open,
                             lanes reaching[FIELD_DIRECTIONS]) {
  lanes passing[FIELD_DIRECTIONS];
  for (int d = 0; d < slice->direction_count; d++) {
    const sky_direction *direction = &slice->directions[d];
    const float *from = slice->old + (size_t)d * slice->plane + at + direction->offset;
    lanes light = open == NULL ? light_from(from, slice->plane_stride, direction)
                               : light_past_surfaces(from, slice->plane_stride, direction, open);
    reaching[d] = light;
    if (squared != NULL) {
      if (direction->slope == d) passing[d] = passing_cells(squared, direction);
      light = light * passing[direction->slope];
    }
    lanes_store(slice->left + (size_t)d * slice->plane + at, light);
  }
}

static void sky_row(const sky_slice *slice, int32_t row) {
  const int32_t stride = slice->plane_stride;
  const size_t at_row = (size_t)(row + 1) * (size_t)stride + FIELD_LANES;
  for (int32_t column = 0; column < slice->columns; column += FIELD_LANES) {
    size_t at = at_row + (size_t)column;
    const size_t block = ((size_t)row * (size_t)slice->stride + (size_t)column) / FIELD_LANES;
    unsigned char flags = slice->flags[block];
    const float *depth = slice->depth + (size_t)row * 3 * (size_t)slice->stride + (size_t)column;
    lanes reaching[FIELD_DIRECTIONS], squared[3], open[FIELD_LINKS];
    for (int a = 0; a < 3; a++) {
      lanes along = lanes_load(depth + a * slice->stride);
      squared[a] = along * along;
    }
    const lanes *matter = flags & FIELD_MATTER ? squared : NULL;
    if (slice->cut != NULL && (slice->cut[block] & slice->cut_here)) {
      find_open_links(slice, at, open);
      move_light(slice, at, matter, open, reaching);
    } else {
      move_light(slice, at, matter, NULL, reaching);
    }
    if (!(flags & FIELD_RECEIVES)) continue;
    float *cells = slice->field + (size_t)row * slice->down + (size_t)column * slice->across;
    if (slice->passing > 0) add_passing(slice, lanes_load(depth), column, cells);
    if (slice->channels == 1) add_harmonics(slice, reaching, column, cells, FIELD_HARMONICS);
    else add_harmonics(slice, reaching, column, cells, 3 * FIELD_HARMONICS);
  }
}

#endif
