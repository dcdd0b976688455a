/* surface/small_triangles_lanes.h - finds the samples that sixteen small triangles cover, one triangle in
 * each lane (small_triangles.h).
 *
 * Coordinates of corners and samples are whole numbers below 1024, counted from a triangle's first pixel. So
 * the edge functions of coverage.c are exact in floats. */
#ifndef HL_SURFACE_SMALL_TRIANGLES_LANES_H
#define HL_SURFACE_SMALL_TRIANGLES_LANES_H

#include "simd/gathers.h"
#include "simd/lanes.h"
#include "surface/fragment.h"
#include "surface/sample_rows.h"
#include "surface/small_triangles.h"

/* SMALL_STEP: the distance, in 1/256 pixels, between neighbouring columns, or rows, of samples. */
enum { SMALL_SUBPIXELS = 256, SMALL_STEP = SMALL_SUBPIXELS / 16, SMALL_TILE = 16 };
/* The least distance from the eye at which points are seen; it is the number NEAREST of seen.c. The unit is
 * the distance at which rays have the length 1. */
static const double SMALL_NEAREST = 1e-4;
/* The greatest difference of heights within a small triangle, in distances of sheets. */
static const float SMALL_RISE = 4;

/* A triangle's corners, in 1/256 pixels from its first pixel, and its edges. For each edge, `value` + x *
 * `down` - y * `across` is above 0 inside the triangle. */
typedef struct small_shape {
  lanes x[3], y[3];
  lanes across[3], down[3], value[3];
  lanes area; /* twice the area, with its sign */
} small_shape;

/* The height as a function of the position in a triangle: the height at the first corner, and its change per
 * 1/256 pixels. */
typedef struct small_heights {
  lanes corner, by_x, by_y, lowest, highest;
} small_heights;

LANES_INLINE lanes_int load_ints(const int32_t *p) {
  lanes_int v;
  memcpy(&v, p, sizeof v);
  return v;
}
LANES_INLINE void store_ints(int32_t *p, lanes_int v) { memcpy(p, &v, sizeof v); }

/* Finds, along one axis, the first pixel that a triangle's box touches. *more: receives the number of further
 * pixels that the box touches. Returns whether this number is below SMALL_SIDE. */
LANES_INLINE lanes_int find_first_pixel(const int32_t at[3][SMALL_TRIANGLES], lanes_int *first,
                                        lanes_int *more) {
  lanes_int a = load_ints(at[0]), b = load_ints(at[1]), c = load_ints(at[2]);
  lanes_int least = lanes_select_int(a < b, a, b), greatest = lanes_select_int(a > b, a, b);
  least = lanes_select_int(least < c, least, c);
  greatest = lanes_select_int(greatest > c, greatest, c);
  *first = least >> 8;
  *more = (greatest >> 8) - *first;
  return *more < SMALL_SIDE;
}

/* Sets the edges as in coverage.c. A sample on an edge belongs to the triangle on one side of this edge. So a
 * half is added to the edge function on one side, and subtracted on the other. The function is then never 0
 * at a sample. */
LANES_INLINE void set_shape(const small_triangles *t, lanes_int column, lanes_int row, small_shape *shape) {
  for (int i = 0; i < 3; i++) {
    shape->x[i] = lanes_from_int(load_ints(t->x[i]) - (column << 8));
    shape->y[i] = lanes_from_int(load_ints(t->y[i]) - (row << 8));
  }
  const lanes *x = shape->x, *y = shape->y;
  shape->area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  lanes side = lanes_select(shape->area < 0.0f, lanes_set(1.0f), lanes_set(-1.0f));
  for (int i = 0; i < 3; i++) {
    int to = (i + 1) % 3;
    lanes across = (x[to] - x[i]) * side, down = (y[to] - y[i]) * side;
    lanes_int owns = (down > 0.0f) | ((down == 0.0f) & (across < 0.0f));
    shape->across[i] = across;
    shape->down[i] = down;
    shape->value[i] = y[i] * across - x[i] * down + lanes_select(owns, lanes_set(0.5f), lanes_set(-0.5f));
  }
}

LANES_INLINE lanes product3(const float a[3], const lanes b[3]) {
  return b[0] * a[0] + b[1] * a[1] + b[2] * a[2];
}

LANES_INLINE void find_heights(const small_triangles *t, const small_shape *shape, small_heights *heights) {
  const lanes *x = shape->x, *y = shape->y;
  lanes height[3];
  for (int i = 0; i < 3; i++) height[i] = lanes_load(t->height[i]);
  lanes a = height[1] - height[0], b = height[2] - height[0];
  lanes scale = 1.0f / lanes_select(shape->area == 0.0f, lanes_set(1.0f), shape->area);
  heights->corner = height[0];
  heights->by_x = (a * (y[2] - y[0]) - b * (y[1] - y[0])) * scale;
  heights->by_y = (b * (x[1] - x[0]) - a * (x[2] - x[0])) * scale;
  heights->lowest = lanes_min(lanes_min(height[0], height[1]), height[2]);
  heights->highest = lanes_max(lanes_max(height[0], height[1]), height[2]);
}

/* Finds the change of the height of a triangle's plane from one pixel to the next. *leaving: receives whether
 * the rays leave the mesh at the triangle. Derived: let the ray A + s B meet the plane with the normal n. The
 * vector of the next pixel's ray differs from B by D. This ray meets the plane s D - B s (n.D) / (n.B) away.
 * The height there differs by s (h.D - (h.B) (n.D) / (n.B)), where h is the sheets' normal. */
LANES_INLINE lanes find_slope(const small_view *view, const small_triangles *t, lanes_int *leaving) {
  lanes normal[3], way[3], depth = lanes_set(1.0f);
  for (int axis = 0; axis < 3; axis++) {
    normal[axis] = lanes_load(t->normal[axis]);
    way[axis] = view->perspective ? lanes_load(t->corner[axis]) - view->from[axis]
                                  : lanes_set(view->from[axis]);
  }
  if (view->perspective) depth = product3(view->depth, way);
  lanes facing = normal[0] * way[0] + normal[1] * way[1] + normal[2] * way[2],
        ratio = product3(view->normal, way) / facing;
  lanes slope = lanes_set(0);
  const float *steps[2] = {view->du, view->dv};
  for (int i = 0; i < 2; i++) {
    const float *d = steps[i];
    float rise = d[0] * view->normal[0] + d[1] * view->normal[1] + d[2] * view->normal[2];
    slope = slope + lanes_abs((rise - product3(d, normal) * ratio) * depth);
  }
  *leaving = facing > 0.0f;
  return lanes_min(slope, lanes_set(STEEPEST_SLOPE)); /* a slope that is NaN counts as the steepest slope */
}

/* Finds the slab whose end is the first sheet at or above a height. */
LANES_INLINE lanes_int slab_at(const small_view *view, lanes height) {
  lanes sheet = lanes_clamp(height / lanes_set(view->spacing), 1.0f, view->last_slab);
  return lanes_floor(sheet * -1.0f) * -1;
}

/* The covered samples of a pixel that begins at (x, y): one bit for each sample, the number of samples, and
 * the sums of their columns and of their rows. */
typedef struct small_samples {
  lanes_int bits, count, columns, rows;
} small_samples;

LANES_INLINE void cover_samples(const small_shape *shape, int x, int y, small_samples *samples) {
  lanes at[3], down[3], across[3];
  const float half = SMALL_STEP / 2;
  for (int i = 0; i < 3; i++) {
    at[i] = shape->value[i] + shape->down[i] * ((float)x + half) - shape->across[i] * ((float)y + half);
    down[i] = shape->down[i] * (float)SMALL_STEP;
    across[i] = shape->across[i] * (float)SMALL_STEP;
  }
  *samples = (small_samples){lanes_set_int(0), lanes_set_int(0), lanes_set_int(0), lanes_set_int(0)};
  for (int s = 0; s < 16; s++) {
    const float row = SAMPLE_ROWS[s];
    lanes_int outside = (lanes_int)(at[0] - across[0] * row) | (lanes_int)(at[1] - across[1] * row) |
                        (lanes_int)(at[2] - across[2] * row);
    lanes_int inside = ~(outside >> 31);
    samples->bits |= inside & (1 << s);
    samples->count -= inside;
    samples->columns += inside & s;
    samples->rows += inside & (int32_t)SAMPLE_ROWS[s];
    for (int i = 0; i < 3; i++) at[i] = at[i] + down[i];
  }
}

/* Finds the number of samples in each lane's bits, and the sums of their columns and rows. Derived: fields of
 * neighbouring samples are joined in pairs, until one field is left. For each field two numbers are kept: the
 * number of its samples, and the sum of their columns, counted from the field's first column. The sample in
 * column c has the row (3 + 7 c) modulo 16, which is 3 - c, plus 8 if c is odd, plus 16 if c is in
 * SECOND_TURN. */
LANES_INLINE void count_samples(lanes_int bits, small_samples *samples) {
  enum { PAIRS = 0x5555, FOURS = 0x3333, EIGHTS = 0x0f0f, SECOND_TURN = 0xf550 };
  lanes_int odd = (bits >> 1) & PAIRS, turn = bits & SECOND_TURN;
  lanes_int count = (bits & PAIRS) + odd, sum = odd, above = (count >> 2) & FOURS;
  turn = (turn & PAIRS) + ((turn >> 1) & PAIRS);
  lanes_int rows = (odd & FOURS) + ((odd >> 2) & FOURS) + 2 * ((turn & FOURS) + ((turn >> 2) & FOURS));
  count = (count & FOURS) + above;
  sum = (sum & FOURS) + ((sum >> 2) & FOURS) + 2 * above;
  above = (count >> 4) & EIGHTS;
  count = (count & EIGHTS) + above;
  sum = (sum & EIGHTS) + ((sum >> 4) & EIGHTS) + 4 * above;
  rows = (rows & EIGHTS) + ((rows >> 4) & EIGHTS);
  above = count >> 8;
  sum = ((sum + (sum >> 8)) & 255) + 8 * above;
  count = (count & 255) + above;
  *samples = (small_samples){bits, count, sum, 3 * count - sum + 8 * ((rows + (rows >> 8)) & 255)};
}

/* Finds the columns of samples between three coordinates; the function serves rows in the same way. The
 * result is the first column whose middle does not lie before the least coordinate. *count: receives the
 * number of columns from there up to the greatest coordinate. Coordinates are in 1/256 pixels. */
LANES_INLINE lanes_int sample_range(const lanes at[3], lanes_int *count) {
  lanes least = lanes_min(lanes_min(at[0], at[1]), at[2]),
        greatest = lanes_max(lanes_max(at[0], at[1]), at[2]);
  lanes_int first = (lanes_truncate(least) + (SMALL_STEP / 2 - 1)) >> 4;
  *count = ((lanes_truncate(greatest) + SMALL_STEP / 2) >> 4) - first;
  return first;
}

LANES_INLINE int greatest_of(lanes_int x, lanes_int of) {
  int32_t each[SMALL_TRIANGLES], most = 0;
  store_ints(each, x & of);
  for (int lane = 0; lane < SMALL_TRIANGLES; lane++) most = each[lane] > most ? each[lane] : most;
  return most;
}

typedef uint32_t small_words __attribute__((vector_size(64)));

/* Finds the samples that very small triangles cover: triangles that are at most a pixel high and two pixels
 * wide. In each column of samples, only one sample can lie within the rows of such a triangle, and only this
 * sample is tested. of: the lanes that are looked at. bits: for each of two rows of pixels, the samples of
 * two pixels, 16 bits each. Returns whether all triangles in `of` are very small. */
LANES_INLINE int cover_columns(const small_shape *shape, lanes_int of, lanes_int bits[2]) {
  lanes_int columns, rows, column = sample_range(shape->x, &columns), row = sample_range(shape->y, &rows);
  if (lanes_bits(of & ((rows > 16) | (column + columns > 32) | (row + rows > 32))) != 0) return 0;
  const float half = SMALL_STEP / 2;
  lanes x = lanes_from_int(column) * (float)SMALL_STEP + half, at[3], step[3];
  for (int i = 0; i < 3; i++) {
    at[i] = shape->value[i] + shape->down[i] * x;
    step[i] = shape->down[i] * (float)SMALL_STEP;
  }
  lanes_int ahead = column * 7 + 3 - row; /* the row of the column's only possible sample, counted from the
                                           * triangle's first row, modulo 16 */
  small_words bit = (small_words)(1 << (column & 31)); /* 0 for columns after the last one */
  bits[0] = bits[1] = lanes_set_int(0);
  for (int n = greatest_of(columns, of); n > 0; n--) {
    lanes_int own = row + (ahead & 15);
    lanes y = lanes_from_int(own) * (float)SMALL_STEP + half;
    lanes_int outside = (lanes_int)(at[0] - shape->across[0] * y) |
                        (lanes_int)(at[1] - shape->across[1] * y) | (lanes_int)(at[2] - shape->across[2] * y);
    lanes_int covered = (lanes_int)bit & ~(outside >> 31), upper = own < 16;
    bits[0] |= covered & upper;
    bits[1] |= covered & ~upper;
    ahead += 7;
    bit += bit;
    for (int i = 0; i < 3; i++) at[i] = at[i] + step[i];
  }
  return 1;
}

/* The height in the middle of a pixel's covered samples. */
LANES_INLINE lanes find_height(const small_shape *shape, const small_heights *heights,
                               const small_samples *samples, int x, int y) {
  lanes_int none = samples->count == 0;
  lanes each = (float)SMALL_STEP / lanes_from_int(samples->count - none);
  const float half = SMALL_STEP / 2;
  lanes u = lanes_from_int(samples->columns) * each + ((float)x + half) - shape->x[0],
        v = lanes_from_int(samples->rows) * each + ((float)y + half) - shape->y[0];
  lanes height = heights->corner + heights->by_x * u + heights->by_y * v;
  return lanes_min(lanes_max(height, heights->lowest), heights->highest);
}

/* The stored number for the reach of each lane's fragment, as hl_told_reach() finds it. */
LANES_INLINE lanes_int find_reach(const small_view *view, const small_heights *heights) {
  lanes rise = (lanes_abs(heights->by_x) + lanes_abs(heights->by_y)) * (float)SMALL_SUBPIXELS;
  lanes parts = lanes_min(rise, heights->highest - heights->lowest) * (REACH_PARTS / view->spacing);
  return lanes_floor(lanes_min(parts, lanes_set(FARTHEST - 1))) + 1;
}

LANES_INLINE lanes_int within(lanes_int at, int32_t count) { return (at >= 0) & (at < count); }

/* The number of a pixel in a tile of 16x16 pixels, counted by blocks of 4x4. */
LANES_INLINE lanes_int number_in_tile(lanes_int column, lanes_int row) {
  return ((row & 12) << 4) | ((column & 12) << 2) | ((row & 3) << 2) | (column & 3);
}

/* Finds the samples that the triangles of the lanes in `wanted` cover. */
LANES_INLINE uint32_t cover_wanted(const small_view *view, const small_triangles *t, lanes_int wanted,
                                   small_cover *cover) {
  small_shape shape;
  small_heights heights;
  lanes_int column, row, more_columns, more_rows, leaving;
  lanes_int small = find_first_pixel(t->x, &column, &more_columns);
  small &= find_first_pixel(t->y, &row, &more_rows);
  wanted &= (column < SMALL_TILE) & (column + more_columns >= 0) & (row < SMALL_TILE) &
            (row + more_rows >= 0);
  cover->large = lanes_bits(wanted & ~small);
  small &= wanted;
  if (lanes_bits(small) == 0) return 0;
  set_shape(t, column, row, &shape);
  find_heights(t, &shape, &heights);
  lanes_int flat = heights.highest - heights.lowest <= SMALL_RISE * view->spacing;
  cover->large |= lanes_bits(small & ~flat);
  small &= flat;
  lanes_int any = small & ((shape.area < 0.0f) | ((shape.area > 0.0f) & (view->fronts ? 0 : -1)));
  lanes slope = lanes_set(0), delay = slope;
  lanes_int reach = view->of_light ? lanes_set_int(0) : find_reach(view, &heights);
  if (view->of_light) {
    slope = find_slope(view, t, &leaving);
    delay = slope * view->delay + (float)LEAST_DELAY * view->spacing;
    if (view->dark_backs) delay = lanes_select(leaving, lanes_set(0), delay);
  }
  lanes_int by_rows[2];
  int tiny = cover_columns(&shape, any, by_rows);
  for (int k = 0; k < SMALL_PIXELS; k++) {
    int x = k % SMALL_SIDE * SMALL_SUBPIXELS, y = k / SMALL_SIDE * SMALL_SUBPIXELS;
    lanes_int at_column = column + k % SMALL_SIDE, at_row = row + k / SMALL_SIDE;
    lanes_int needed = any & (more_columns >= k % SMALL_SIDE) & (more_rows >= k / SMALL_SIDE) &
                       within(at_column, view->columns) & within(at_row, view->rows);
    cover->covered[k] = 0;
    if (lanes_bits(needed) == 0) continue;
    small_samples samples;
    if (tiny && (k % SMALL_SIDE > 1 || k / SMALL_SIDE > 1)) continue;
    if (tiny) samples.bits = (by_rows[k / SMALL_SIDE] >> 16 * (k % SMALL_SIDE)) & 0xffff;
    else cover_samples(&shape, x, y, &samples);
    cover->covered[k] = lanes_bits(needed & (samples.bits != 0));
    if (cover->covered[k] == 0) continue;
    if (tiny) count_samples(samples.bits, &samples);
    lanes_store_short_int(cover->samples[k], samples.bits);
    store_ints(cover->pixel[k], number_in_tile(at_column, at_row));
    lanes height = find_height(&shape, &heights, &samples, x, y);
    lanes_store(cover->height[k], height);
    store_ints(cover->slab[k], slab_at(view, height));
    if (!view->of_light) {
      store_ints(cover->reach[k], reach);
      continue;
    }
    lanes start = height + delay, highest = heights.highest + (float)SEAM * view->spacing,
          end = lanes_min(height + slope * view->rise, highest) + delay;
    lanes_store(cover->start[k], start);
    store_ints(cover->first_slab[k], slab_at(view, start));
    store_ints(cover->last_slab[k], slab_at(view, end));
  }
  return lanes_bits(small);
}

static uint32_t cover_small(const small_view *view, const small_triangles *t, small_cover *cover) {
  return cover_wanted(view, t, lanes_set_int(-1), cover);
}

/* ---- clusters ---- */

typedef double eight_doubles __attribute__((vector_size(64)));
typedef int64_t eight_longs __attribute__((vector_size(64)));
typedef float eight_floats __attribute__((vector_size(32)));
typedef int32_t eight_ints __attribute__((vector_size(32)));

LANES_INLINE eight_doubles load_doubles(const float *p) {
  eight_floats v;
  memcpy(&v, p, sizeof v);
  return __builtin_convertvector(v, eight_doubles);
}

/* Stores the nearest whole numbers of 1/256 pixels; halves go up. They must fit into 32 bits. */
LANES_INLINE void store_subpixels(int32_t *to, eight_doubles pixels) {
  eight_doubles at = pixels * (double)SMALL_SUBPIXELS + 0.5;
  eight_ints whole = __builtin_convertvector(at, eight_ints);
  eight_longs above = __builtin_convertvector(whole, eight_doubles) > at;
  whole += __builtin_convertvector(above, eight_ints);
  memcpy(to, &whole, sizeof whole);
}

/* Projects eight vertices of a cluster, `at` to at + 7, into the view. Sums have the same order as in
 * seen.c. */
LANES_INLINE void see_eight(const small_view *view, const cluster_shape *shape, size_t at,
                            seen_cluster *seen) {
  eight_doubles p[3], c[3];
  for (int axis = 0; axis < 3; axis++)
    p[axis] = load_doubles(shape->positions + (size_t)axis * shape->vertices + at) - view->origin[axis];
  for (int i = 0; i < 3; i++)
    c[i] = view->inverse[i][0] * p[0] + view->inverse[i][1] * p[1] + view->inverse[i][2] * p[2];
  if (view->perspective) c[1] = c[1] / c[0], c[2] = c[2] / c[0];
  store_subpixels(seen->x + at, c[1]);
  store_subpixels(seen->y + at, c[2]);
}

static void see_cluster(const small_view *view, const cluster_shape *shape, seen_cluster *seen) {
  for (size_t at = 0; at < shape->vertices; at += SMALL_TRIANGLES) {
    lanes p[3];
    for (int axis = 0; axis < 3; axis++)
      p[axis] = lanes_load(shape->positions + (size_t)axis * shape->vertices + at);
    lanes_store(seen->height + at, product3(view->normal, p) - view->first);
    see_eight(view, shape, at, seen);
    see_eight(view, shape, at + SMALL_TRIANGLES / 2, seen);
  }
}

LANES_INLINE lanes_int load_words(const void *table, const lanes_offsets *offsets) {
  return lanes_load_words((const unsigned char *)table, offsets);
}

LANES_INLINE void gather_triangles(const small_view *view, const cluster_shape *shape,
                                   const seen_cluster *seen, int first, small_triangles *t) {
  for (int i = 0; i < 3; i++) {
    lanes_offsets offsets;
    for (int lane = 0; lane < SMALL_TRIANGLES; lane++)
      offsets.at[lane] = shape->corners[i][first + lane] * (int32_t)sizeof(float);
    store_ints(t->x[i], load_words(seen->x, &offsets) - view->left);
    store_ints(t->y[i], load_words(seen->y, &offsets) - view->top);
    store_ints((int32_t *)t->height[i], load_words(seen->height, &offsets));
    if (view->of_light) memcpy(t->normal[i], shape->normals[i] + first, sizeof t->normal[i]);
    if (i > 0 || !view->of_light || !view->perspective) continue;
    for (int axis = 0; axis < 3; axis++)
      store_ints((int32_t *)t->corner[axis],
                 load_words(shape->positions + (size_t)axis * shape->vertices, &offsets));
  }
}

static uint32_t cover_cluster(const small_view *view, const cluster_shape *shape, const seen_cluster *seen,
                              int first, uint32_t wanted, small_cover *cover) {
  small_triangles t;
  gather_triangles(view, shape, seen, first, &t);
  return cover_wanted(view, &t, lanes_from_bits(wanted), cover);
}

#endif
