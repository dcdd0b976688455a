/* field/sky_lanes.h - moves the sky's light from slice to slice of a lattice (derived).
 *
 * The light of one direction that reaches a cell's middle is interpolated between four cells of the slice
 * before. The cell's own matter attenuates only the light that goes on to the next slice. Surfaces absorb a
 * part of the light on its way from each of the four cells. Beyond the lattice nothing hides the light.
 * Behind and within matter, most blocks of cells are dark for most directions; a block leaves out the
 * directions for which it is dark. */
#ifndef HL_FIELD_SKY_LANES_H
#define HL_FIELD_SKY_LANES_H

#include "field/field.h"
#include "simd/lanes.h"

/* If the light of a direction is below this fraction of its unhidden light in all sixteen cells of a block,
 * the light counts as 0. Samples look up sums over the directions, whose steps are 1 / SKY_MOST (sky_field.h)
 * of the unhidden light or more. */
static const float SKY_FAINT = 1.0f / 65536;

/* The light of the directions that reach sixteen cells. */
typedef struct sky_reaching {
  lanes light[FIELD_DIRECTIONS]; /* [count]; the light of each direction in sixteen cells */
  const float *basis[FIELD_DIRECTIONS];
  int count;
} sky_reaching;

/* Adds each direction's light to the harmonics of sixteen cells, multiplied by the direction's integrals. One
 * loop over the directions computes three sums, which stay in registers; FIELD_HARMONICS is a multiple of
 * three. */
LANES_INLINE void add_harmonics(const sky_slice *slice, const sky_reaching *reaching, int32_t column,
                                float *cells, int count) {
  float sums[3 * FIELD_HARMONICS][FIELD_LANES];
  for (int k = 0; k < count; k += 3) {
    lanes first = lanes_set(0), second = lanes_set(0), third = lanes_set(0);
    for (int i = 0; i < reaching->count; i++) {
      const float *basis = reaching->basis[i] + k;
      first = lanes_fma(reaching->light[i], lanes_set(basis[0]), first);
      second = lanes_fma(reaching->light[i], lanes_set(basis[1]), second);
      third = lanes_fma(reaching->light[i], lanes_set(basis[2]), third);
    }
    lanes_store(sums[k], first);
    lanes_store(sums[k + 1], second);
    lanes_store(sums[k + 2], third);
  }
  int32_t valid = slice->columns - column;
  for (int32_t lane = 0; lane < FIELD_LANES && lane < valid; lane++)
    for (int k = 0; k < count; k++) cells[(size_t)lane * slice->across + (size_t)k] += sums[k][lane];
}

/* Adds, for each of sixteen cells, a third of the cell's transmittance along the slices' axis to the mean of
 * its transmittances along three axes, which is one of the cell's numbers (slice->passing). */
LANES_INLINE void add_passing(const sky_slice *slice, lanes depth, int32_t column, float *cells) {
  float passing[FIELD_LANES];
  lanes_store(passing, lanes_exp2(lanes_max(-depth, lanes_set(-100.0f))) * (1.0f / 3));
  for (int32_t lane = 0; lane < FIELD_LANES && lane < slice->columns - column; lane++)
    cells[(size_t)lane * slice->across + (size_t)slice->passing] += passing[lane];
}

/* The transmittance of cells for light that moves by u across and v down while it crosses a slice: its depth
 * is sqrt(d^2 + u^2 a^2 + v^2 b^2), where d, a and b are the depths along the axis, across and down. Derived:
 * even matter has one depth d along all axes, and light passes sqrt(1 + u^2 + v^2) cells of it. A sheet of
 * matter at a right angle to `down` has only the depth b. Light stays in the sheet's cells for 1 / v slices,
 * and is attenuated by the depth v b in each of these slices. */
LANES_INLINE lanes passing_cells(const lanes squared[3], const sky_direction *direction) {
  lanes depth = lanes_add_scaled(lanes_add_scaled(squared[0], squared[1], direction->across), squared[2],
                                 direction->down);
  return lanes_exp2(lanes_max(-lanes_sqrt(depth), lanes_set(-100.0f)));
}

/* Finds the fraction of light that passes each link of sixteen cells. at: the first cell's index in a
 * plane. */
LANES_INLINE void find_open_links(const sky_slice *slice, size_t at, lanes open[FIELD_LINKS]) {
  for (int k = 0; k < FIELD_LINKS; k++) {
    float passing[FIELD_LANES];
    const unsigned char *taken = slice->taken[k] + at;
    for (int lane = 0; lane < FIELD_LANES; lane++) passing[lane] = (float)(255 - taken[lane]) * (1.0f / 255);
    open[k] = lanes_load(passing);
  }
}

/* The light of a direction that reaches sixteen neighbouring cells. Each of them gets light from four cells
 * of the slice before. from: points to the light of this direction in the first of the four cells that belong
 * to the first of the sixteen. */
LANES_INLINE lanes light_from(const float *from, int32_t stride, const sky_direction *direction) {
  lanes light = lanes_load(from) * direction->weight[0];
  light = lanes_add_scaled(light, lanes_load(from + 1), direction->weight[1]);
  light = lanes_add_scaled(light, lanes_load(from + stride), direction->weight[2]);
  return lanes_add_scaled(light, lanes_load(from + stride + 1), direction->weight[3]);
}

/* The light of a direction that reaches sixteen cells if surfaces cut links to these cells. from: as in
 * light_from(). open: the fraction of light that passes each link. */
LANES_INLINE lanes light_past_surfaces(const float *from, int32_t stride, const sky_direction *direction,
                                       const lanes open[FIELD_LINKS]) {
  const lanes *link = open + direction->link;
  lanes light = lanes_load(from) * link[0] * direction->weight[0];
  light = lanes_add_scaled(light, lanes_load(from + 1) * link[1], direction->weight[1]);
  light = lanes_add_scaled(light, lanes_load(from + stride) * link[3], direction->weight[2]);
  return lanes_add_scaled(light, lanes_load(from + stride + 1) * link[4], direction->weight[3]);
}

LANES_INLINE bool is_lit(lanes light) { return lanes_bits(light >= SKY_FAINT) != 0; }

/* The directions that have light in a block or in one of the blocks around it, from which its light comes. */
LANES_INLINE uint64_t lit_around(const sky_slice *slice, size_t block) {
  const size_t row = (size_t)(slice->light_stride / FIELD_LANES);
  uint64_t lit = 0;
  for (size_t r = 0; r < 3; r++) {
    const uint64_t *at = slice->old_lit + block + r * row - row;
    lit |= at[-1] | at[0] | at[1];
  }
  return lit;
}

/* Makes a block dark for some directions. at: the index of the first direction's light in the block. */
LANES_INLINE void darken(const sky_slice *slice, size_t at, uint64_t directions) {
  for (; directions != 0; directions &= directions - 1)
    lanes_store(slice->left + at + (size_t)(__builtin_ctzll(directions) * slice->light_stride), lanes_set(0));
}

/* Moves the light of all directions to sixteen cells. block: the number of the cells' block. at: the index of
 * the first direction's light in the block. squared: null if no matter lies in the cells. open: null if no
 * surface cuts their links. */
LANES_INLINE void move_light(const sky_slice *slice, size_t block, size_t at, const lanes *squared,
                             const lanes *open, sky_reaching *reaching) {
  const int32_t row = FIELD_DIRECTIONS * slice->light_stride;
  lanes passing[FIELD_DIRECTIONS];
  uint64_t known = 0, leaving = 0; /* known: one bit for each slope (sky_direction) whose transmittance has
                                    * been found */
  reaching->count = 0;
  for (uint64_t left = lit_around(slice, block); left != 0; left &= left - 1) {
    const int d = __builtin_ctzll(left);
    const sky_direction *direction = &slice->directions[d];
    const size_t here = at + (size_t)(d * slice->light_stride);
    const float *from = slice->old + here + direction->offset;
    /* prefetches the light that the next row reads; after the last row, the light is not read */
    __builtin_prefetch(slice->old + here + 2 * row);
    lanes light = open == NULL ? light_from(from, row, direction)
                               : light_past_surfaces(from, row, direction, open);
    if (!is_lit(light)) continue;
    reaching->light[reaching->count] = light;
    reaching->basis[reaching->count++] = direction->basis;
    if (squared != NULL) {
      const int slope = direction->slope;
      if (!(known >> slope & 1)) passing[slope] = passing_cells(squared, direction), known |= 1ull << slope;
      light = light * passing[slope];
      if (!is_lit(light)) continue;
    }
    lanes_store(slice->left + here, light);
    leaving |= 1ull << d;
  }
  darken(slice, at, slice->left_lit[block] & ~leaving);
  slice->left_lit[block] = leaving;
}

static void sky_row(const sky_slice *slice, int32_t row) {
  const size_t at_row = (size_t)(row + 1) * (size_t)slice->light_stride + FIELD_LANES;
  for (int32_t column = 0; column < slice->columns; column += FIELD_LANES) {
    const size_t link = at_row + (size_t)column, lit = link / FIELD_LANES;
    const size_t at = link + (size_t)((row + 1) * (FIELD_DIRECTIONS - 1) * slice->light_stride);
    const size_t block = ((size_t)row * (size_t)slice->stride + (size_t)column) / FIELD_LANES;
    unsigned char flags = slice->flags[block];
    const float *depth = slice->depth + (size_t)row * 3 * (size_t)slice->stride + (size_t)column;
    lanes squared[3], open[FIELD_LINKS];
    sky_reaching reaching;
    for (int a = 0; a < 3; a++) {
      lanes along = lanes_load(depth + a * slice->stride);
      squared[a] = along * along;
    }
    const lanes *matter = flags & FIELD_MATTER ? squared : NULL;
    if (slice->cut != NULL && (slice->cut[block] & slice->cut_here)) {
      find_open_links(slice, link, open);
      move_light(slice, lit, at, matter, open, &reaching);
    } else {
      move_light(slice, lit, at, matter, NULL, &reaching);
    }
    if (!(flags & FIELD_RECEIVES)) continue;
    float *cells = slice->field + (size_t)row * slice->down + (size_t)column * slice->across;
    if (slice->passing > 0) add_passing(slice, lanes_load(depth), column, cells);
    if (reaching.count == 0) continue;
    if (slice->channels == 1) add_harmonics(slice, &reaching, column, cells, FIELD_HARMONICS);
    else add_harmonics(slice, &reaching, column, cells, 3 * FIELD_HARMONICS);
  }
}

#endif
