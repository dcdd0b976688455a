/* surface/small_spheres_lanes.h - finds the fragments of small opaque spheres that are seen from outside,
 * eight at a time. All numbers are doubles. The operations are the same as in seen.c, sphere_coverage.c,
 * surface_plane.c and tile_fragments.c, and have the same order, so that all results have the same bytes. */
#ifndef HL_SURFACE_SMALL_SPHERES_LANES_H
#define HL_SURFACE_SMALL_SPHERES_LANES_H

#include "surface/small_triangles_lanes.h"

typedef struct doubles3 {
  eight_doubles x, y, z;
} doubles3;

LANES_INLINE eight_doubles dots(doubles3 a, doubles3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LANES_INLINE eight_doubles dots_of(vec3 a, doubles3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LANES_INLINE doubles3 scaled(doubles3 a, eight_doubles s) { return (doubles3){a.x * s, a.y * s, a.z * s}; }
LANES_INLINE doubles3 sums(doubles3 a, doubles3 b) { return (doubles3){a.x + b.x, a.y + b.y, a.z + b.z}; }
LANES_INLINE doubles3 eight_of(vec3 a) {
  const eight_doubles zero = {0};
  return (doubles3){zero + a.x, zero + a.y, zero + a.z};
}
LANES_INLINE doubles3 less(doubles3 a, doubles3 b) { return (doubles3){a.x - b.x, a.y - b.y, a.z - b.z}; }

LANES_INLINE eight_doubles choose(eight_longs mask, eight_doubles a, eight_doubles b) {
  return (eight_doubles)(((eight_longs)a & mask) | ((eight_longs)b & ~mask));
}
/* Return the greater and the lesser of two numbers, as fmax() and fmin() do: if one argument is NaN, the
 * result is the other argument. */
LANES_INLINE eight_doubles at_least(eight_doubles a, double least) {
  return choose(a > least, a, (eight_doubles){0} + least);
}
LANES_INLINE eight_doubles less_of(eight_doubles a, eight_doubles b) { return choose(a < b, a, b); }

LANES_INLINE eight_doubles roots(eight_doubles x) {
#if defined(__AVX512F__)
  return (eight_doubles)_mm512_sqrt_pd((__m512d)x);
#elif defined(__AVX2__)
  __m256d half[2];
  memcpy(half, &x, sizeof half);
  for (int i = 0; i < 2; i++) half[i] = _mm256_sqrt_pd(half[i]);
  memcpy(&x, half, sizeof half);
  return x;
#else
  for (int i = 0; i < 8; i++) x[i] = __builtin_sqrt(x[i]);
  return x;
#endif
}

LANES_INLINE uint32_t bits_of(eight_longs mask) {
  eight_ints each = __builtin_convertvector(mask, eight_ints);
  uint32_t bits = 0;
  for (int i = 0; i < 8; i++) bits |= (uint32_t)(each[i] < 0) << i;
  return bits;
}

/* Rounds numbers down to whole numbers. The results must fit into 32 bits. */
LANES_INLINE eight_doubles floors(eight_doubles x) {
  eight_doubles whole = __builtin_convertvector(__builtin_convertvector(x, eight_ints), eight_doubles);
  return choose(whole > x, whole - 1.0, whole);
}

/* The rays of eight spheres' pixels, as in sphere_coverage.h. */
typedef struct eight_rays {
  doubles3 start, way;
  vec3 start_u, start_v, way_u, way_v;
  eight_doubles radius;
} eight_rays;

LANES_INLINE doubles3 at_pixels(doubles3 at, vec3 by_u, vec3 by_v, eight_doubles u, eight_doubles v) {
  return (doubles3){at.x + (by_u.x * u + by_v.x * v), at.y + (by_u.y * u + by_v.y * v),
                    at.z + (by_u.z * u + by_v.z * v)};
}

LANES_INLINE void set_rays(const view *view, doubles3 centre, eight_doubles radius, eight_rays *rays) {
  const vec3 zero = {0, 0, 0};
  bool eye = view->perspective;
  rays->start = less(eight_of(eye ? view->origin : view->corner), centre);
  rays->start_u = eye ? zero : view->du, rays->start_v = eye ? zero : view->dv;
  rays->way = eight_of(eye ? view->corner : view->direction);
  rays->way_u = eye ? view->du : zero, rays->way_v = eye ? view->dv : zero;
  rays->radius = radius;
}

LANES_INLINE eight_doubles discriminants(const eight_rays *rays, eight_doubles u, eight_doubles v) {
  doubles3 a = at_pixels(rays->start, rays->start_u, rays->start_v, u, v),
           b = at_pixels(rays->way, rays->way_u, rays->way_v, u, v);
  eight_doubles along = dots(a, b);
  return along * along - dots(b, b) * (dots(a, a) - rays->radius * rays->radius);
}

/* The pixels of the tile that each sphere touches. `small` and `seen` tell which spheres are small and
 * which spheres are seen from outside. */
typedef struct eight_boxes {
  eight_doubles x0, y0, x1, y1;
  eight_longs small, seen;
} eight_boxes;

LANES_INLINE void find_extents(eight_doubles a, eight_doubles w, vec3 ga, vec3 gw, eight_doubles radius,
                               eight_doubles *low, eight_doubles *high) {
  eight_doubles rr = radius * radius, p = w * w - rr * vec3_dot(gw, gw), q = a * w - rr * vec3_dot(ga, gw),
                s = a * a - rr * vec3_dot(ga, ga), root = roots(at_least(q * q - p * s, 0));
  *low = (q - root) / p;
  *high = (q + root) / p;
}

LANES_INLINE eight_doubles tile_pixels(eight_doubles at) {
  return floors(choose(at > SMALL_TILE - 1, (eight_doubles){0} + (SMALL_TILE - 1), at_least(at, 0)));
}

LANES_INLINE void find_boxes(const small_view *small, const eight_rays *rays, doubles3 centre,
                             eight_boxes *boxes) {
  const view *view = small->view;
  const vec3 zero = {0, 0, 0}, nearer = view->perspective ? view->inverse.row[0] : zero;
  doubles3 p = less(centre, eight_of(view->perspective ? view->origin : view->corner));
  eight_doubles w = view->perspective ? dots_of(view->inverse.row[0], p) : (eight_doubles){0} + 1.0;
  eight_doubles u0, u1, v0, v1, left = (eight_doubles){0} + small->left / SMALL_SUBPIXELS,
                                top = (eight_doubles){0} + small->top / SMALL_SUBPIXELS;
  find_extents(dots_of(view->inverse.row[1], p), w, view->inverse.row[1], nearer, rays->radius, &u0, &u1);
  find_extents(dots_of(view->inverse.row[2], p), w, view->inverse.row[2], nearer, rays->radius, &v0, &v1);
  boxes->seen = (u1 >= left) & (v1 >= top) & (u0 < left + SMALL_TILE) & (v0 < top + SMALL_TILE);
  boxes->x0 = tile_pixels(u0 - left), boxes->x1 = tile_pixels(u1 - left);
  boxes->y0 = tile_pixels(v0 - top), boxes->y1 = tile_pixels(v1 - top);
  boxes->small = (boxes->x1 - boxes->x0 < SMALL_SIDE) & (boxes->y1 - boxes->y0 < SMALL_SIDE);
  if (view->perspective)
    boxes->small &= (w - rays->radius * vec3_length(nearer) > SMALL_NEAREST) &
                    (dots(rays->start, rays->start) > rays->radius * rays->radius * 1.05);
}

/* Finds the coefficients c of the quadratic functions of sphere_coverage.c, as functions of the offset from
 * the position (u, v). */
LANES_INLINE void find_quadratics(const eight_rays *rays, eight_doubles u, eight_doubles v,
                                  eight_doubles c[6]) {
  eight_doubles m = discriminants(rays, u, v), e = discriminants(rays, u + 1.0, v),
                w = discriminants(rays, u - 1.0, v), s = discriminants(rays, u, v + 1.0),
                n = discriminants(rays, u, v - 1.0), se = discriminants(rays, u + 1.0, v + 1.0);
  c[0] = m, c[1] = (e - w) / 2.0, c[2] = (s - n) / 2.0, c[3] = (e + w) / 2.0 - m;
  c[4] = se - e - s + m, c[5] = (s + n) / 2.0 - m;
}

LANES_INLINE eight_longs cover_pixels(const eight_doubles c[6], eight_doubles u, eight_doubles v) {
  eight_longs bits = {0};
  for (int s = 0; s < 16; s++) {
    eight_doubles x = u + (s + 0.5) / 16, y = v + (SAMPLE_ROWS[s] + 0.5) / 16;
    eight_doubles value = c[0] + x * (c[1] + x * c[3] + y * c[4]) + y * (c[2] + y * c[5]);
    bits |= (value >= 0.0) & ((int64_t)1 << s);
  }
  return bits;
}

/* Planes that touch the spheres at the points where rays enter them. Members that depend on the pixel are
 * linear functions of it. */
typedef struct eight_planes {
  eight_doubles rise[3], way[3];
  vec3 above, climb; /* vectors that are the same for all eight spheres */
} eight_planes;

LANES_INLINE void set_planes(const small_view *small, doubles3 normal, doubles3 point, eight_planes *planes) {
  const view *view = small->view;
  const vec3 zero = {0, 0, 0}, h = small->sheets->normal;
  bool eye = view->perspective;
  vec3 a = eye ? view->origin : view->corner, b = eye ? view->corner : view->direction,
       au = eye ? zero : view->du, av = eye ? zero : view->dv, bu = eye ? view->du : zero,
       bv = eye ? view->dv : zero;
  doubles3 back = scaled(normal, (eight_doubles){0} - 1.0);
  planes->rise[0] = dots(back, less(eight_of(a), point));
  planes->rise[1] = dots(back, eight_of(au)), planes->rise[2] = dots(back, eight_of(av));
  planes->way[0] = dots(normal, eight_of(b));
  planes->way[1] = dots(normal, eight_of(bu)), planes->way[2] = dots(normal, eight_of(bv));
  planes->above = (vec3){vec3_dot(h, a) - small->sheets->first, vec3_dot(h, au), vec3_dot(h, av)};
  planes->climb = (vec3){vec3_dot(h, b), vec3_dot(h, bu), vec3_dot(h, bv)};
}

LANES_INLINE eight_doubles plane_heights(const eight_planes *p, eight_doubles u, eight_doubles v) {
  eight_doubles above = p->above.x + p->above.y * u + p->above.z * v,
                rise = p->rise[0] + p->rise[1] * u + p->rise[2] * v,
                way = p->way[0] + p->way[1] * u + p->way[2] * v,
                climb = p->climb.x + p->climb.y * u + p->climb.z * v;
  return above + rise / way * climb;
}

LANES_INLINE eight_doubles absolutes(eight_doubles x) { return (eight_doubles)((eight_longs)x & INT64_MAX); }

LANES_INLINE eight_ints slabs_of(const small_view *small, eight_doubles height) {
  double last = small->sheets->count - 1;
  eight_doubles sheet = height / small->sheets->spacing;
  sheet = at_least(sheet, 1);
  sheet = choose(sheet < last, sheet, (eight_doubles){0} + last);
  return __builtin_convertvector(floors(sheet * -1.0) * -1.0, eight_ints);
}

LANES_INLINE void store_eight_floats(float *to, eight_doubles x) {
  eight_floats v = __builtin_convertvector(x, eight_floats);
  memcpy(to, &v, sizeof v);
}
LANES_INLINE void store_eight(int32_t *to, eight_ints v) { memcpy(to, &v, sizeof v); }

/* Finds the heights, delays and slabs of the fragments at pixel number k of each sphere, where some of the
 * pixel's samples are covered. */
LANES_INLINE eight_longs place_fragments(const small_view *small, const eight_rays *rays, doubles3 centre,
                                         eight_doubles u, eight_doubles v, int at, int k,
                                         small_cover *cover) {
  const sheet_stack *sheets = small->sheets;
  doubles3 a = at_pixels(rays->start, rays->start_u, rays->start_v, u, v),
           b = at_pixels(rays->way, rays->way_u, rays->way_v, u, v);
  eight_doubles along = dots(a, b), bb = dots(b, b);
  eight_doubles root = roots(at_least(along * along - bb * (dots(a, a) - rays->radius * rays->radius), 0));
  eight_doubles s = ((eight_doubles){0} - along - root) / bb;
  doubles3 point = sums(centre, sums(a, scaled(b, s))), normal = less(point, centre);
  eight_doubles length = roots(dots(normal, normal));
  normal = scaled(normal, choose(length > 0.0, 1.0 / length, (eight_doubles){0} + 1.0));
  eight_planes planes;
  set_planes(small, normal, point, &planes);
  eight_doubles height = plane_heights(&planes, u, v),
                middle = dots_of(sheets->normal, centre) - sheets->first, lowest = middle - rays->radius,
                highest = middle + rays->radius;
  eight_doubles slope = absolutes(plane_heights(&planes, u + 1.0, v) - height) +
                        absolutes(plane_heights(&planes, u, v + 1.0) - height);
  slope = choose(slope < (double)STEEPEST_SLOPE, slope, (eight_doubles){0} + (double)STEEPEST_SLOPE);
  height = choose(height > lowest, height, lowest);
  height = less_of(height, highest);
  store_eight_floats(cover->height[k] + at, height);
  store_eight(cover->slab[k] + at, slabs_of(small, height));
  if (small->of_light) {
    eight_doubles start = __builtin_convertvector(__builtin_convertvector(height, eight_floats),
                                                  eight_doubles) +
                          (slope * small->delay + LEAST_DELAY * sheets->spacing);
    store_eight_floats(cover->start[k] + at, start);
    store_eight(cover->first_slab[k] + at, slabs_of(small, start));
    store_eight(cover->last_slab[k] + at, slabs_of(small, start));
  } else {
    eight_doubles range = highest - lowest;
    eight_doubles reach = choose((slope < (double)STEEPEST_SLOPE) & (slope < range), slope, range);
    eight_doubles parts = reach / sheets->spacing * (double)REACH_PARTS;
    parts = choose(parts < (double)(FARTHEST - 1), parts + 1.0, (eight_doubles){0} + (double)FARTHEST);
    store_eight(cover->reach[k] + at, __builtin_convertvector(parts, eight_ints));
  }
  return small->view->perspective ? s > 0.0 : bb == bb;
}

LANES_INLINE uint32_t cover_eight_spheres(const small_view *small, const small_spheres *spheres, int at,
                                          small_cover *cover) {
  doubles3 centre = {load_doubles(spheres->centre[0] + at), load_doubles(spheres->centre[1] + at),
                     load_doubles(spheres->centre[2] + at)};
  eight_rays rays;
  eight_boxes boxes;
  eight_doubles c[6], left = (eight_doubles){0} + small->left / SMALL_SUBPIXELS,
                      top = (eight_doubles){0} + small->top / SMALL_SUBPIXELS;
  set_rays(small->view, centre, load_doubles(spheres->radius + at), &rays);
  find_boxes(small, &rays, centre, &boxes);
  eight_doubles u = left + (boxes.x0 + boxes.x1 + 1.0) / 2.0, v = top + (boxes.y0 + boxes.y1 + 1.0) / 2.0;
  find_quadratics(&rays, u, v, c);
  for (int k = 0; k < SMALL_PIXELS; k++) {
    eight_doubles column = boxes.x0 + (double)(k % SMALL_SIDE), row = boxes.y0 + (double)(k / SMALL_SIDE);
    eight_longs needed = boxes.small & boxes.seen & (column <= boxes.x1) & (row <= boxes.y1) &
                         (column < (double)small->columns) & (row < (double)small->rows);
    if (bits_of(needed) == 0) continue;
    eight_longs bits = cover_pixels(c, left + column - u, top + row - v);
    needed &= bits != 0;
    if (bits_of(needed) == 0) continue;
    eight_ints half = __builtin_convertvector(bits, eight_ints), x, y, count;
    int32_t words[SMALL_TRIANGLES] = {0};
    lanes_int all;
    small_samples samples;
    store_eight(words, half);
    memcpy(&all, words, sizeof all);
    count_samples(all, &samples);
    memcpy(&x, &samples.columns, sizeof x), memcpy(&y, &samples.rows, sizeof y);
    memcpy(&count, &samples.count, sizeof count);
    eight_doubles number = __builtin_convertvector(count, eight_doubles);
    eight_doubles pu = (__builtin_convertvector(x, eight_doubles) / number + 0.5) / 16.0 + (left + column),
                  pv = (__builtin_convertvector(y, eight_doubles) / number + 0.5) / 16.0 + (top + row);
    needed &= place_fragments(small, &rays, centre, pu, pv, at, k, cover);
    cover->covered[k] |= bits_of(needed) << at;
    eight_ints whole_column = __builtin_convertvector(column, eight_ints),
               whole_row = __builtin_convertvector(row, eight_ints);
    store_eight(cover->pixel[k] + at, ((whole_row & 12) << 4) | ((whole_column & 12) << 2) |
                                          ((whole_row & 3) << 2) | (whole_column & 3));
    for (int i = 0; i < 8; i++) cover->samples[k][at + i] = (uint16_t)words[i];
  }
  cover->large |= bits_of(~boxes.small) << at;
  return bits_of(boxes.small) << at;
}

static uint32_t cover_spheres(const small_view *view, const small_spheres *spheres, small_cover *cover) {
  memset(cover->covered, 0, sizeof cover->covered);
  cover->large = 0;
  return cover_eight_spheres(view, spheres, 0, cover) | cover_eight_spheres(view, spheres, 8, cover);
}

#endif
