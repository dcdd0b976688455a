/* surface/small_triangles_lanes.h - sixteen small triangles, one in each lane (small_triangles.h).
 *
 * Coordinates of corners and samples are whole numbers below 1024, counted from a triangle's first pixel: the
 * edge functions of coverage.c are exact in floats. */
#ifndef HL_SURFACE_SMALL_TRIANGLES_LANES_H
#define HL_SURFACE_SMALL_TRIANGLES_LANES_H

#include "simd/lanes.h"
#include "surface/fragment.h"
#include "surface/sample_rows.h"
#include "surface/small_triangles.h"

/* 1/256 pixels from one sample to the next column or row. */
enum { SMALL_SUBPIXELS = 256, SMALL_STEP = SMALL_SUBPIXELS / 16 };
/* Distances of sheets by which a small triangle's height changes at most. */
static const float SMALL_RISE = 4;

/* Corners from the first pixel, 1/256 pixels. Edges: value + x down - y across is above 0 inside. */
typedef struct small_shape {
  lanes x[3], y[3];
  lanes across[3], down[3], value[3];
  lanes area; /* twice, with its sign */
} small_shape;

/* Heights of points of a triangle: at its first corner, and by 1/256 pixels. */
typedef struct small_heights {
  lanes corner, by_x, by_y, lowest, highest;
} small_heights;

LANES_INLINE lanes_int load_ints(const int32_t *p) {
  lanes_int v;
  memcpy(&v, p, sizeof v);
  return v;
}
LANES_INLINE void store_ints(int32_t *p, lanes_int v) { memcpy(p, &v, sizeof v); }

/* Corners in pixels: the first pixel, the number of those after it, and whether these are few. */
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

/* Edges as in coverage.c: samples on an edge belong to the triangle on one side of it. The half that tells
 * which keeps values away from 0. */
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

LANES_INLINE void load_corner(const small_triangles *t, int corner, lanes at[3]) {
  for (int axis = 0; axis < 3; axis++) at[axis] = lanes_load(t->position[corner][axis]);
}

LANES_INLINE void find_heights(const small_view *view, const small_triangles *t, const small_shape *shape,
                               small_heights *heights) {
  const lanes *x = shape->x, *y = shape->y;
  lanes height[3], at[3];
  for (int i = 0; i < 3; i++) {
    load_corner(t, i, at);
    height[i] = product3(view->normal, at) - view->first;
  }
  lanes a = height[1] - height[0], b = height[2] - height[0];
  lanes scale = 1.0f / lanes_select(shape->area == 0.0f, lanes_set(1.0f), shape->area);
  heights->corner = height[0];
  heights->by_x = (a * (y[2] - y[0]) - b * (y[1] - y[0])) * scale;
  heights->by_y = (b * (x[1] - x[0]) - a * (x[2] - x[0])) * scale;
  heights->lowest = lanes_min(lanes_min(height[0], height[1]), height[2]);
  heights->highest = lanes_max(lanes_max(height[0], height[1]), height[2]);
}

/* How much the height of the triangle's plane changes from pixel to pixel; *leaving: where the rays leave by
 * its front. Derived: along the ray A + s B a step D aside in the picture moves the point of the plane with
 * normal n by s D - B s (n.D) / (n.B), and its height by s (h.D - (h.B) (n.D) / (n.B)). */
LANES_INLINE lanes find_slope(const small_view *view, const small_triangles *t, lanes_int *leaving) {
  lanes corner[3][3], a[3], b[3], normal[3], way[3], depth = lanes_set(1.0f);
  for (int i = 0; i < 3; i++) load_corner(t, i, corner[i]);
  for (int axis = 0; axis < 3; axis++) {
    a[axis] = corner[1][axis] - corner[0][axis];
    b[axis] = corner[2][axis] - corner[0][axis];
    way[axis] = view->perspective ? corner[0][axis] - view->from[axis] : lanes_set(view->from[axis]);
  }
  for (int axis = 0; axis < 3; axis++) {
    int next = (axis + 1) % 3, last = (axis + 2) % 3;
    normal[axis] = a[next] * b[last] - a[last] * b[next];
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
  return lanes_min(slope, lanes_set(STEEPEST_SLOPE)); /* not a number: the steepest */
}

/* The slab that ends at or above a height. */
LANES_INLINE lanes_int slab_at(const small_view *view, lanes height) {
  lanes sheet = lanes_clamp(height / lanes_set(view->spacing), 1.0f, view->last_slab);
  return lanes_floor(sheet * -1.0f) * -1;
}

/* The covered samples of a pixel that begins at (x, y): their bits, number, and sums of columns and rows. */
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

/* As hl_told_reach(). */
LANES_INLINE void store_reach(const small_view *view, const small_heights *heights, small_cover *cover) {
  lanes rise = (lanes_abs(heights->by_x) + lanes_abs(heights->by_y)) * (float)SMALL_SUBPIXELS;
  lanes parts = lanes_min(rise, heights->highest - heights->lowest) * (REACH_PARTS / view->spacing);
  store_ints(cover->reach, lanes_floor(lanes_min(parts, lanes_set(FARTHEST - 1))) + 1);
}

LANES_INLINE lanes_int within(lanes_int at, int32_t count) { return (at >= 0) & (at < count); }

/* Of a pixel of a tile of 16x16, block of 4x4 after block. */
LANES_INLINE lanes_int number_in_tile(lanes_int column, lanes_int row) {
  return ((row & 12) << 4) | ((column & 12) << 2) | ((row & 3) << 2) | (column & 3);
}

static uint32_t cover_small(const small_view *view, const small_triangles *t, small_cover *cover) {
  small_shape shape;
  small_heights heights;
  lanes_int column, row, more_columns, more_rows, leaving;
  lanes_int small = find_first_pixel(t->x, &column, &more_columns);
  small &= find_first_pixel(t->y, &row, &more_rows);
  if (lanes_bits(small) == 0) return 0;
  set_shape(t, column, row, &shape);
  find_heights(view, t, &shape, &heights);
  small &= heights.highest - heights.lowest <= SMALL_RISE * view->spacing;
  lanes_int any = small & ((shape.area < 0.0f) | (shape.area > 0.0f));
  lanes slope = lanes_set(0), delay = slope;
  if (!view->of_light) store_reach(view, &heights, cover);
  if (view->of_light) {
    slope = find_slope(view, t, &leaving);
    delay = slope * view->delay + (float)LEAST_DELAY * view->spacing;
    if (view->dark_backs) delay = lanes_select(leaving, lanes_set(0), delay);
  }
  for (int k = 0; k < SMALL_PIXELS; k++) {
    int x = k % SMALL_SIDE * SMALL_SUBPIXELS, y = k / SMALL_SIDE * SMALL_SUBPIXELS;
    lanes_int at_column = column + k % SMALL_SIDE, at_row = row + k / SMALL_SIDE;
    lanes_int needed = any & (more_columns >= k % SMALL_SIDE) & (more_rows >= k / SMALL_SIDE) &
                       within(at_column, view->columns) & within(at_row, view->rows);
    cover->covered[k] = 0;
    if (lanes_bits(needed) == 0) continue;
    small_samples samples;
    cover_samples(&shape, x, y, &samples);
    cover->covered[k] = lanes_bits(needed & (samples.bits != 0));
    if (cover->covered[k] == 0) continue;
    lanes_store_short_int(cover->samples[k], samples.bits);
    store_ints(cover->pixel[k], number_in_tile(at_column, at_row));
    lanes height = find_height(&shape, &heights, &samples, x, y);
    lanes_store(cover->height[k], height);
    store_ints(cover->slab[k], slab_at(view, height));
    if (!view->of_light) continue;
    lanes start = height + delay, highest = heights.highest + (float)SEAM * view->spacing,
          end = lanes_min(height + slope * view->rise, highest) + delay;
    lanes_store(cover->start[k], start);
    store_ints(cover->first_slab[k], slab_at(view, start));
    store_ints(cover->last_slab[k], slab_at(view, end));
  }
  return lanes_bits(small);
}

#endif
