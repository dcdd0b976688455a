/* shadow_cascade/cascade_lanes.h - computes the operations on one tile of a cascade's fields. */
#ifndef HL_SHADOW_CASCADE_CASCADE_LANES_H
#define HL_SHADOW_CASCADE_CASCADE_LANES_H

#include "core/sheet_constants.h"
#include "shadow/blur_lanes.h"
#include "shadow_cascade/cascade_field.h"

/* Prefetches the rows of a field's tile; each row is a cache line of its own. If `field` is null, the
 * function does nothing. */
LANES_INLINE void fetch_rows(const field_pixel *field, size_t stride, int tile_x, int tile_y, tile_rows rows,
                             const int to_write) {
  if (field == NULL) return;
  const field_pixel *row = field + (size_t)(tile_y * TILE + rows.first) * stride + (size_t)tile_x * TILE;
  for (int i = rows.first; i < rows.end; i++, row += stride) {
    if (to_write) __builtin_prefetch(row, 1);
    else __builtin_prefetch(row, 0);
  }
}

/* Prefetches the rows of a tile of floats. */
LANES_INLINE void fetch_float_tile(const float *field, size_t stride, int tile_x, int tile_y) {
  const float *row = field + (size_t)tile_y * TILE * stride + (size_t)tile_x * TILE;
  for (int i = 0; i < TILE; i++, row += stride) __builtin_prefetch(row, 0);
}

/* Stores sixteen pixels after rounding them. *greatest: each lane is raised to the stored pixel if the lane
 * is less. */
LANES_INLINE void store_pixels(field_pixel *p, lanes pixels, lanes *greatest) {
  lanes_store_short(p, pixels);
  *greatest = lanes_max(*greatest, pixels);
}
LANES_INLINE int is_above_zero(lanes greatest) { return lanes_bits(greatest + 0.5f >= 1.0f) != 0; }

/* The transmittance 1 - thin of thin matter. */
LANES_INLINE lanes transmittance_of(const field_pixel *thin) {
  return lanes_line(lanes_load_short(thin), -1.0f / FIELD_ONE, 1.0f);
}

/* The transmittance 1 - absorbed, corrected where it is small: values below UMBRA become 0, and between UMBRA
 * and twice UMBRA the result rises from 0 to twice UMBRA. Greater values are unchanged. */
LANES_INLINE lanes transmittance_outside_umbra(const field_pixel *absorbed) {
  lanes left = transmittance_of(absorbed);
  return lanes_clamp(lanes_min(left, 2.0f * (left - UMBRA)), 0, 1.0f);
}

/* Blurs sixteen pixels along a row of a field as blur_sixteen() does, but sums pixels as integers. */
LANES_INLINE lanes blur_field_row(const field_pixel *from, const blur_box *box) {
  lanes_int ends = lanes_load_short_int(from - (box->reach + 1)) +
                   lanes_load_short_int(from + (box->reach + 1));
  lanes_int sum = lanes_load_short_int(from);
  for (int i = 1; i <= box->reach; i++)
    sum = sum + (lanes_load_short_int(from - i) + lanes_load_short_int(from + i));
  return lanes_add_scaled(lanes_from_int(sum), lanes_from_int(ends), box->edge) * box->scale;
}

/* Computes the sum a + (1 - thin) b for a row of a tile, where a is absorbed light and thin the fraction that
 * thin matter absorbs of b. a and thin may be null, which stands for zeros. */
LANES_INLINE lanes left_and_a(lanes b, const field_pixel *thin, const field_pixel *a, size_t at) {
  if (a == NULL) return thin == NULL ? b : b * transmittance_of(thin + at);
  lanes more = lanes_load_short(a + at);
  return thin == NULL ? b + more : lanes_fma(b, transmittance_of(thin + at), more);
}

static int field_blur_tile(const field_blur_job *job, int tile_x, int tile_y) {
  _Alignas(64) float rows[(TILE + 2 * BLUR_GREATEST_REACH) * TILE];
  int apron = job->v.reach + 1, top = tile_y * TILE + job->rows.first,
      count = job->rows.end - job->rows.first;
  fetch_rows(job->a, job->stride, tile_x, tile_y, job->rows, 0);
  fetch_rows(job->thin, job->stride, tile_x, tile_y, job->rows, 0);
  fetch_rows(job->to, job->stride, tile_x, tile_y, job->rows, 1);
  const field_pixel *from = job->from + (ptrdiff_t)(top - apron) * (ptrdiff_t)job->stride + tile_x * TILE;
  for (int row = 0; row < count + 2 * apron; row++, from += job->stride)
    lanes_store(rows + row * TILE, blur_field_row(from, &job->u));
  size_t at = (size_t)top * job->stride + (size_t)tile_x * TILE;
  lanes greatest = lanes_set(0);
  for (int row = 0; row < count; row++, at += job->stride) {
    lanes blurred = blur_sixteen(rows + (row + apron) * TILE, TILE, &job->v);
    store_pixels(job->to + at, left_and_a(blurred, job->thin, job->a, at), &greatest);
  }
  return is_above_zero(greatest);
}

/* Computes the sum a + (1 - thin) b for sixteen pixels, where a is absorbed light and thin the fraction that
 * thin matter absorbs of b. b and thin may be null, which stands for zeros. */
LANES_INLINE lanes a_and_b(const field_job *job, size_t at) {
  if (job->b == NULL) return lanes_load_short(job->a + at);
  return left_and_a(lanes_load_short(job->b + at), job->thin, job->a, at);
}

static int add_tile(const field_job *job, int tile_x, int tile_y) {
  fetch_rows(job->b, job->stride, tile_x, tile_y, job->rows, 0);
  fetch_rows(job->thin, job->stride, tile_x, tile_y, job->rows, 0);
  fetch_rows(job->to, job->stride, tile_x, tile_y, job->rows, 1);
  size_t at = (size_t)(tile_y * TILE + job->rows.first) * job->stride + (size_t)tile_x * TILE;
  lanes greatest = lanes_set(0);
  for (int row = job->rows.first; row < job->rows.end; row++, at += job->stride)
    store_pixels(job->to + at, a_and_b(job, at), &greatest);
  return is_above_zero(greatest);
}

/* The sixteen sums of two neighbouring pixels each, from 32 pixels in a row. */
LANES_INLINE lanes sums_of_pairs(lanes first, lanes second) {
  return __builtin_shufflevector(first, second, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30) +
         __builtin_shufflevector(first, second, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
}

static int add_half_tile(const field_job *job, int tile_x, int tile_y) {
  size_t from = (size_t)(tile_y * TILE + job->rows.first) * 2 * job->stride_in + (size_t)tile_x * TILE * 2;
  field_pixel *to = job->to + (size_t)(tile_y * TILE + job->rows.first) * job->stride + (size_t)tile_x * TILE;
  lanes greatest = lanes_set(0);
  for (int half = 0; half < 2; half++) {
    fetch_rows(job->b, job->stride_in, 2 * tile_x, 2 * tile_y + half, ALL_ROWS, 0);
    fetch_rows(job->thin, job->stride_in, 2 * tile_x, 2 * tile_y + half, ALL_ROWS, 0);
  }
  fetch_rows(job->to, job->stride, tile_x, tile_y, job->rows, 1);
  for (int row = job->rows.first; row < job->rows.end; row++, from += 2 * job->stride_in, to += job->stride) {
    size_t below = from + job->stride_in;
    lanes upper = sums_of_pairs(a_and_b(job, from), a_and_b(job, from + TILE));
    lanes lower = sums_of_pairs(a_and_b(job, below), a_and_b(job, below + TILE));
    store_pixels(to, 0.25f * (upper + lower), &greatest);
  }
  return is_above_zero(greatest);
}

/* Interpolates a row of a tile from a field of half the resolution. The centre of pixel 2 i lies a quarter of
 * a coarse pixel before the centre of coarse pixel i, and the centre of pixel 2 i + 1 lies a quarter of a
 * coarse pixel after this centre. */
LANES_INLINE lanes double_row(const field_pixel *from, size_t stride, int tile_x, int y) {
  const field_pixel *near = from + (ptrdiff_t)(y / 2) * (ptrdiff_t)stride + tile_x * TILE / 2 - 1;
  const field_pixel *far = y & 1 ? near + stride : near - stride;
  lanes coarse = lanes_add_scaled(0.25f * lanes_load_short(far), lanes_load_short(near),
                                  0.75f); /* sixteen coarse pixels; the first one lies before the tile */
  lanes own = __builtin_shufflevector(coarse, coarse, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8);
  lanes other = __builtin_shufflevector(coarse, coarse, 0, 2, 1, 3, 2, 4, 3, 5, 4, 6, 5, 7, 6, 8, 7, 9);
  return lanes_add_scaled(0.25f * other, own, 0.75f);
}

static int add_double_tile(const field_job *job, int tile_x, int tile_y) {
  fetch_rows(job->a, job->stride, tile_x, tile_y, job->rows, 0);
  fetch_rows(job->thin, job->stride, tile_x, tile_y, job->rows, 0);
  fetch_rows(job->to, job->stride, tile_x, tile_y, job->rows, 1);
  lanes greatest = lanes_set(0);
  for (int y = tile_y * TILE + job->rows.first; y < tile_y * TILE + job->rows.end; y++) {
    size_t at = (size_t)y * job->stride + (size_t)tile_x * TILE;
    store_pixels(job->to + at,
                 left_and_a(double_row(job->b, job->stride_in, tile_x, y), job->thin, job->a, at), &greatest);
  }
  return is_above_zero(greatest);
}

static int double_tile(const field_job *job, int tile_x, int tile_y) {
  lanes greatest = lanes_set(0);
  for (int y = tile_y * TILE + job->rows.first; y < tile_y * TILE + job->rows.end; y++)
    store_pixels(job->to + (size_t)y * job->stride + (size_t)tile_x * TILE,
                 double_row(job->a, job->stride_in, tile_x, y), &greatest);
  return is_above_zero(greatest);
}

enum { EMISSION_ROWS = 4 };

/* Weighs several neighbouring rows of sixteen pixels at once: while one row waits for memory, the processor
 * works on the other rows. */
LANES_INLINE void weigh_rows(const emission_job *job, const float *from, lanes sum[EMISSION_ROWS]) {
  for (int row = 0; row < EMISSION_ROWS; row++) sum[row] = lanes_set(0);
  for (int tap = 0; tap < job->count; tap++) {
    const float *at = from + job->offset[tap];
    for (int row = 0; row < EMISSION_ROWS; row++)
      sum[row] = lanes_add_scaled(sum[row], lanes_load(at + (size_t)row * job->stride), job->weight[tap]);
  }
}

LANES_INLINE void weigh_field_rows(const field_emission_job *job, const field_pixel *from,
                                   lanes sum[EMISSION_ROWS]) {
  for (int row = 0; row < EMISSION_ROWS; row++) sum[row] = lanes_set(0);
  for (int tap = 0; tap < job->count; tap++) {
    const field_pixel *at = from + job->offset[tap];
    for (int row = 0; row < EMISSION_ROWS; row++)
      sum[row] = lanes_add_scaled(sum[row], lanes_load_short(at + (size_t)row * job->stride),
                                  job->weight[tap]);
  }
}

static int field_emission_tile(const field_emission_job *job, int tile_x, int tile_y) {
  lanes greatest = lanes_set(0);
  for (int row = 0; row < TILE; row += EMISSION_ROWS) {
    size_t at = (size_t)(tile_y * TILE + row) * job->stride + (size_t)tile_x * TILE;
    lanes sum[EMISSION_ROWS], thin[EMISSION_ROWS];
    weigh_field_rows(job, job->from + at, sum);
    weigh_field_rows(job, job->thin + at, thin);
    for (int i = 0; i < EMISSION_ROWS; i++) {
      field_pixel *to = job->to + at + (size_t)i * job->stride;
      lanes left = lanes_max(lanes_line(thin[i], -1.0f / FIELD_ONE, 1.0f), lanes_set(0));
      store_pixels(to, lanes_fma(lanes_load_short(to), left, sum[i]), &greatest);
    }
  }
  return is_above_zero(greatest);
}

static void emission_tile(const emission_job *job, int tile_x, int tile_y) {
  for (int row = 0; row < TILE; row += EMISSION_ROWS) {
    size_t at = (size_t)(tile_y * TILE + row) * job->stride + (size_t)tile_x * TILE;
    lanes sum[EMISSION_ROWS];
    weigh_rows(job, job->from + at, sum);
    for (int i = 0; i < EMISSION_ROWS; i++) lanes_store(job->to + at + (size_t)i * job->stride, sum[i]);
  }
}

/* The fraction of light that surfaces let pass in pixels where the chunk began in the dark. The fraction is 1
 * in pixels without a mark (DARK_MARK of shadow/attenuate.h). */
LANES_INLINE lanes passing_in_dark(lanes end) {
  return lanes_select(end < 0.0f, end * (-1.0f / DARK_MARK), lanes_set(1.0f));
}

/* The transmittance of the slabs of one chunk. Where hardly any light was left at the chunk's start, the
 * result is the transmittance of surfaces alone, because volumes are not composited in such dark blocks. */
LANES_INLINE lanes chunk_transmittance(lanes end, lanes start) {
  lanes least = lanes_set(DARK_AT_START);
  return lanes_select(start < least, passing_in_dark(end),
                      lanes_min(lanes_max(end, lanes_set(0)) / lanes_max(start, least), lanes_set(1.0f)));
}

static void refill_tile(const refill_job *job, int tile_x, int tile_y) {
  for (int row = tile_y * TILE; row < (tile_y + 1) * TILE; row++) {
    size_t at = (size_t)row * job->stride + (size_t)tile_x * TILE,
           at_to = (size_t)row * job->stride_to + (size_t)tile_x * TILE;
    lanes before = lanes_load(job->to + at_to), left = transmittance_outside_umbra(job->absorbed + at);
    if (job->kept) left = left * chunk_transmittance(before, 1.0f - lanes_load(job->absorbed_at_start + at));
    lanes_store(job->older + at_to, job->again ? lanes_max(before, lanes_set(0)) : left);
    lanes_store(job->to + at_to, left);
    if (job->outside != NULL) {
      lanes taken = lanes_load(job->outside + at_to) - lanes_max(before, lanes_set(0));
      lanes_store(job->outside + at_to, lanes_min(left + lanes_max(taken, lanes_set(0)), lanes_set(1.0f)));
    }
    lanes_store(job->absorbed_at_start + at, 1.0f - left);
  }
}

/* Splits matter into two parts, one behind the other. The second part gets the fraction `late` of the matter.
 * Derived: the transmittance 1 - F of thin matter is the product of the transmittances of the parts, (1 -
 * F)^(1 - late) and (1 - F)^late. The light A2 + (1 - F2) A1 that the two parts absorb, one after the other,
 * equals the light A that the whole matter absorbs. */
typedef struct matter_pair {
  lanes absorbed[2], thin[2];
} matter_pair;

LANES_INLINE matter_pair split_matter(lanes absorbed, lanes thin, lanes late) {
  matter_pair to = {.thin = {lanes_set(0), lanes_set(0)}};
  if (lanes_bits(thin > 0.0f) != 0) {
    lanes depth = lanes_log2(lanes_max(1.0f - thin, lanes_set(1e-6f)));
    to.thin[0] = 1.0f - lanes_exp2(depth * (1.0f - late));
    to.thin[1] = 1.0f - lanes_exp2(depth * late);
  }
  lanes solid = (absorbed - thin) /
                lanes_max(lanes_fma(1.0f - to.thin[1], 1.0f - late, late), lanes_set(1e-3f));
  to.absorbed[0] = lanes_fma(solid, 1.0f - late, to.thin[0]);
  to.absorbed[1] = lanes_fma(solid, late, to.thin[1]);
  return to;
}

LANES_INLINE lanes load_fraction(const field_pixel *p) { return lanes_load_short(p) * (1.0f / FIELD_ONE); }
LANES_INLINE void store_fraction(field_pixel *p, lanes fraction, lanes *greatest) {
  store_pixels(p, fraction * (float)FIELD_ONE, greatest);
}

static uint32_t split_tile(const split_job *job, int tile_x, int tile_y) {
  lanes absorbed[2] = {lanes_set(0), lanes_set(0)}, thin[2] = {lanes_set(0), lanes_set(0)};
  for (int row = tile_y * TILE; row < (tile_y + 1) * TILE; row++) {
    size_t at = (size_t)row * job->stride + (size_t)tile_x * TILE;
    matter_pair to = split_matter(load_fraction(job->absorbed + at), load_fraction(job->thin + at),
                                  lanes_set(job->late));
    for (int i = 0; i < 2; i++) {
      store_fraction(job->to_absorbed[i] + at, to.absorbed[i], &absorbed[i]);
      store_fraction(job->to_thin[i] + at, to.thin[i], &thin[i]);
    }
  }
  uint32_t above_zero = 0;
  for (int i = 0; i < 2; i++)
    above_zero |= (uint32_t)(is_above_zero(absorbed[i]) | is_above_zero(thin[i]) << 1) << 2 * i;
  return above_zero;
}

/* The light that surfaces absorb in pixels where the chunk began in the dark. job->before must not be
 * null. */
LANES_INLINE lanes taken_in_dark(const absorbed_job *job, size_t at, lanes start, lanes end) {
  lanes reaching = transmittance_outside_umbra(job->before + at);
  return lanes_keep(start < DARK_AT_START, reaching * (1.0f - passing_in_dark(end)));
}

/* Pixels whose transmittance is at most this number count as opaque. Each slab of an opaque surface absorbs
 * all light. */
static const float OPAQUE_PASSING = 0x1p-20f;

/* Finds which of sixteen pixels in a row lie on surfaces of the chunk that absorb all light. */
LANES_INLINE lanes_int is_opaque(const float *now) {
  lanes end = lanes_load(now);
  return (end < 0.0f) & (passing_in_dark(end) < OPAQUE_PASSING);
}

/* Finds which pixels are hidden: surfaces of the chunk absorb all of their light, or the chunk began in the
 * dark. */
LANES_INLINE lanes_int is_hidden(const float *now, const float *absorbed_at_start) {
  return is_opaque(now) | (lanes_load(absorbed_at_start) > 1.0f - DARK_AT_START);
}

/* Opaque surfaces are made to hide the matter before them only in pixels where at most this fraction of the
 * light was left at the chunk's start. Where more light is left, the sums are right without hiding. */
static const float HARDLY_HIDDEN = 0.9f;

/* Finds which of sixteen pixels lie inside an opaque surface. Such a pixel is opaque, had at most
 * HARDLY_HIDDEN of the light at the chunk's start, and is not near the surface's edge: in four directions,
 * the pixels that are 1, 2, 4 ... and job->edge pixels away are hidden. at: offset of the first pixel in
 * absorbed_at_start. */
LANES_INLINE lanes_int is_inside_surface(const absorbed_job *job, const float *now, size_t at) {
  const float *start = job->absorbed_at_start + at;
  lanes_int inside = is_opaque(now) & (lanes_load(start) > 1.0f - HARDLY_HIDDEN);
  for (int way = 1, before = 0; before < job->edge && lanes_bits(inside) != 0; before = way, way *= 2) {
    if (way > job->edge) way = job->edge;
    ptrdiff_t down = way * (ptrdiff_t)job->stride_now, down_at_start = way * (ptrdiff_t)job->stride;
    inside &= is_hidden(now - way, start - way) & is_hidden(now + way, start + way) &
              is_hidden(now - down, start - down_at_start) & is_hidden(now + down, start + down_at_start);
  }
  return inside;
}

/* Makes the group at a chunk's end hide everything that lies before the group, where surfaces let no light
 * pass. Derived: a surface at o absorbs the light T(o), and 1 - T(o) is the sum up to o, blurred for a
 * receiver at o. For a receiver r far behind o, this sum is blurred more, so that a little light would be
 * left beside the umbra of matter before o. But rays that meet an opaque surface end at this surface,
 * whatever they have met before. So the sum must become 1 = F + (1 - F) s with F = 1. */
LANES_INLINE void hide_behind(lanes_int inside, matter_pair *to) {
  to->thin[1] = lanes_select(inside, lanes_set(1.0f), to->thin[1]);
  to->absorbed[1] = lanes_select(inside, lanes_set(1.0f), to->absorbed[1]);
}

static uint32_t absorbed_tile(const absorbed_job *job, int tile_x, int tile_y) {
  lanes start[2] = {lanes_set(0), lanes_set(0)}, end[2] = {lanes_set(0), lanes_set(0)};
  const field_pixel *first[] = {job->start_absorbed, job->start_thin, job->end_absorbed, job->end_thin};
  fetch_float_tile(job->now, job->stride_now, tile_x, tile_y);
  for (size_t i = 0; i < sizeof first / sizeof first[0]; i++)
    fetch_rows(first[i], job->stride, tile_x, tile_y, ALL_ROWS, 1);
  fetch_float_tile(job->moment, job->stride, tile_x, tile_y);
  for (int row = tile_y * TILE; row < (tile_y + 1) * TILE; row++) {
    size_t at = (size_t)row * job->stride + (size_t)tile_x * TILE;
    lanes before = 1.0f - lanes_load(job->absorbed_at_start + at);
    const float *now_at = job->now + (size_t)row * job->stride_now + (size_t)tile_x * TILE;
    lanes now = lanes_load(now_at);
    lanes taken = lanes_max(before - lanes_max(now, lanes_set(0)), lanes_set(0));
    int marked = lanes_bits(now < 0.0f) != 0;
    lanes in_dark = marked && job->before != NULL ? taken_in_dark(job, at, before, now) : lanes_set(0);
    if (!marked && lanes_bits(taken > 0.0f) == 0) { /* no matter is added, because the moment is zero, too */
      lanes_store_short(job->end_absorbed + at, lanes_set(0));
      lanes_store_short(job->end_thin + at, lanes_set(0));
      continue;
    }
    lanes fraction = taken / lanes_max(before, lanes_set(1e-3f));
    lanes position = lanes_clamp(
        lanes_load(job->moment + at) / lanes_max(taken * job->length, lanes_set(1e-6f)), 0, 1.0f);
    lanes solid = lanes_clamp((fraction - THIN_MATTER) * (1.0f / (SOLID_MATTER - THIN_MATTER)), 0, 1.0f);
    lanes thin = fraction * (1.0f - solid);
    position = lanes_select(in_dark > 0.0f, lanes_set(0.5f), position);
    matter_pair to = split_matter(lanes_fma(taken, solid, thin) + in_dark, thin, position);
    if (marked) hide_behind(is_inside_surface(job, now_at, at), &to);
    lanes_store(job->moment + at, lanes_set(0));
    store_fraction(job->end_absorbed + at, to.absorbed[1], &end[0]);
    store_fraction(job->end_thin + at, to.thin[1], &end[1]);
    lanes left = 1.0f - to.thin[0];
    store_fraction(job->start_absorbed + at,
                   lanes_fma(load_fraction(job->start_absorbed + at), left, to.absorbed[0]), &start[0]);
    store_fraction(job->start_thin + at, lanes_fma(load_fraction(job->start_thin + at), left, to.thin[0]),
                   &start[1]);
  }
  uint32_t to_start = (uint32_t)is_above_zero(start[0]) | (uint32_t)is_above_zero(start[1]) << 1;
  return to_start | (uint32_t)is_above_zero(end[0]) << 2 | (uint32_t)is_above_zero(end[1]) << 3;
}

#endif
