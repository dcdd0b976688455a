/* view/rays_lanes.h - finds the points at which the rays of a 4x4 block of pixels meet a sheet, and at which
 * they enter and leave a volume's box. */
#ifndef HL_VIEW_RAYS_LANES_H
#define HL_VIEW_RAYS_LANES_H

#include "simd/lanes.h"
#include "view/view.h"

typedef struct lanes3 {
  lanes x, y, z;
} lanes3;

LANES_INLINE lanes dot3(lanes3 a, lanes3 b) { return lanes_fma(a.x, b.x, lanes_fma(a.y, b.y, a.z * b.z)); }
LANES_INLINE lanes3 scale3(lanes3 a, lanes s) { return (lanes3){a.x * s, a.y * s, a.z * s}; }
LANES_INLINE lanes3 add3(lanes3 a, lanes3 b) { return (lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
LANES_INLINE lanes3 set3(const float v[3]) {
  return (lanes3){lanes_set(v[0]), lanes_set(v[1]), lanes_set(v[2])};
}
/* Returns the vector a + b s. */
LANES_INLINE lanes3 add_scaled3(lanes3 a, lanes3 b, lanes s) {
  return (lanes3){lanes_fma(b.x, s, a.x), lanes_fma(b.y, s, a.y), lanes_fma(b.z, s, a.z)};
}

/* Two functions that apply a row of an affine map: row_of_vector() applies it to vectors, row_of_point() to
 * points. */
LANES_INLINE lanes row_of_vector(const float row[4], lanes3 v) {
  return lanes_add_scaled(lanes_add_scaled(v.z * row[2], v.y, row[1]), v.x, row[0]);
}
LANES_INLINE lanes row_of_point(const float row[4], lanes3 p) {
  return lanes_add_scaled(lanes_add_scaled(lanes_line(p.z, row[2], row[3]), p.y, row[1]), p.x, row[0]);
}

static const float block_column[LANES]
    __attribute__((unused)) = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
static const float block_row[LANES]
    __attribute__((unused)) = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/* The pixel coordinates of the sixteen pixels of the block whose first pixel is (x, y). */
LANES_INLINE lanes block_u(int x) { return lanes_load(block_column) + (float)x; }
LANES_INLINE lanes block_v(int y) { return lanes_load(block_row) + (float)y; }

/* Evaluates a function that is linear in pixel coordinates, at sixteen pixels. */
LANES_INLINE lanes linear_in_view(float at, float by_u, float by_v, lanes u, lanes v) {
  return lanes_add_scaled(lanes_line(v, by_v, at), u, by_u);
}
LANES_INLINE lanes3 rays_linear(const float at[3], const float by_u[3], const float by_v[3], lanes u,
                                lanes v) {
  return (lanes3){linear_in_view(at[0], by_u[0], by_v[0], u, v),
                  linear_in_view(at[1], by_u[1], by_v[1], u, v),
                  linear_in_view(at[2], by_u[2], by_v[2], u, v)};
}

/* The climb H = h.W: the height along the sheets' normal h by which a perspective view's ray rises over its
 * direction vector W. */
LANES_INLINE lanes rays_climb(const sheet_rays *rays, lanes u, lanes v) {
  return linear_in_view(rays->h0, rays->hu, rays->hv, u, v);
}

/* The vectors W: the directions of a perspective view's rays, which are not normalised. */
LANES_INLINE lanes3 rays_directions(const sheet_rays *rays, lanes u, lanes v) {
  return rays_linear(rays->w0, rays->wu, rays->wv, u, v);
}

LANES_INLINE lanes3 rays_positions(const sheet_rays *rays, lanes u, lanes v) {
  lanes3 p = rays_linear(rays->p0, rays->pu, rays->pv, u, v);
  if (!rays->perspective) return p;
  lanes s = 1.0f / rays_climb(rays, u, v);
  return (lanes3){lanes_fma(p.x, s, lanes_set(rays->base[0])), lanes_fma(p.y, s, lanes_set(rays->base[1])),
                  lanes_fma(p.z, s, lanes_set(rays->base[2]))};
}

/* ---- where rays enter and leave a box or a sphere ---- */

/* Sections of sixteen rays, from `first` to `last`. The unit is the length of each ray's own direction
 * vector. */
typedef struct ray_section {
  lanes first, last;
} ray_section;

/* Finds, by the slab method, the sections of rays within a box. */
LANES_INLINE ray_section section_in_box(const box_rays *rays, lanes u, lanes v) {
  ray_section section = {lanes_set(rays->least), lanes_set(1e30f)};
  for (int axis = 0; axis < 3; axis++) {
    lanes start = linear_in_view(rays->start[axis], rays->start_u[axis], rays->start_v[axis], u, v);
    lanes direction = linear_in_view(rays->direction[axis], rays->direction_u[axis], rays->direction_v[axis],
                                     u, v);
    /* a ray that is parallel to two faces gets a tiny direction across them, so that its crossings lie far
     * away, on the right sides */
    direction = lanes_select(lanes_abs(direction) < 1e-12f, lanes_set(1e-12f), direction);
    lanes a = (rays->low[axis] - start) / direction, b = (rays->high[axis] - start) / direction;
    section.first = lanes_max(section.first, lanes_min(a, b));
    section.last = lanes_min(section.last, lanes_max(a, b));
  }
  return section;
}

/* The sections of rays within the unit sphere: the roots s of |start + s direction| = 1. With q = start and d
 * = direction, such roots exist where (q.d)^2 >= d.d (q.q - 1). */
LANES_INLINE ray_section roots_of_sphere(lanes3 start, lanes3 direction) {
  lanes squared = dot3(direction, direction), along = dot3(start, direction);
  lanes rest = lanes_fma(along, along, squared * (1.0f - dot3(start, start)));
  lanes root = lanes_sqrt(lanes_max(rest, lanes_set(0)));
  lanes_int met = rest > 0.0f;
  return (ray_section){lanes_select(met, (-along - root) / squared, lanes_set(1e30f)),
                       lanes_select(met, (root - along) / squared, lanes_set(-1e30f))};
}

LANES_INLINE ray_section section_in_sphere(const box_rays *rays, lanes u, lanes v) {
  ray_section section = roots_of_sphere(
      rays_linear(rays->start, rays->start_u, rays->start_v, u, v),
      rays_linear(rays->direction, rays->direction_u, rays->direction_v, u, v));
  section.first = lanes_max(section.first, lanes_set(rays->least));
  return section;
}

static __attribute__((unused)) void coverage_tile(const box_rays *rays, int tile_x, int tile_y, float *enter,
                                                  float *leave) {
  for (int block = 0; block < TILE_BLOCKS; block++) {
    lanes u = block_u(tile_x * TILE + block % 4 * BLOCK), v = block_v(tile_y * TILE + block / 4 * BLOCK);
    ray_section section = rays->sphere ? section_in_sphere(rays, u, v) : section_in_box(rays, u, v);
    lanes first = section.first, last = section.last;
    lanes base = linear_in_view(rays->start_height, rays->start_height_u, rays->start_height_v, u, v);
    lanes climb = linear_in_view(rays->climb, rays->climb_u, rays->climb_v, u, v);
    lanes a = lanes_fma(first, climb, base), b = lanes_fma(last, climb, base);
    lanes_int missed = first > last;
    lanes_store(enter + block * BLOCK_PIXELS, lanes_select(missed, lanes_set(1e30f), lanes_min(a, b)));
    lanes_store(leave + block * BLOCK_PIXELS, lanes_select(missed, lanes_set(-1e30f), lanes_max(a, b)));
  }
}

/* The section of the slab [height - spacing, height] that lies in the box: its beginning and its length, as
 * fractions of the slab. */
typedef struct covered_span {
  lanes begin, length;
} covered_span;

LANES_INLINE covered_span covered(lanes enter, lanes leave, float height, float spacing) {
  lanes top = lanes_min(leave, lanes_set(height));
  lanes bottom = lanes_max(enter, lanes_set(height - spacing));
  return (covered_span){lanes_min((bottom - (height - spacing)) * (1.0f / spacing), lanes_set(1.0f)),
                        lanes_max((top - bottom) * (1.0f / spacing), lanes_set(0))};
}

#endif
