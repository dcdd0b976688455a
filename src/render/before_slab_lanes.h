/* render/before_slab_lanes.h - finds the length of the light's way within a volume's box before the light
 * reaches a slab, for samples near a face of the box. The length is found at a sample and at the shadow
 * buffer's pixels around the sample.
 *
 * On one side of a face, a shadow buffer's pixel holds light that the box's matter has partly absorbed; on
 * the other side it holds light that has passed beside the box. Interpolating between the two would be wrong.
 * The lengths of the ways through the box serve to correct the interpolation. */
#ifndef HL_RENDER_BEFORE_SLAB_LANES_H
#define HL_RENDER_BEFORE_SLAB_LANES_H

#include "core/sheet_constants.h"
#include "render/cut_lanes.h"
#include "render/pack_lanes.h"
#include "shadow/shadow_lookup_lanes.h"

/* The four pixels of a shadow buffer around a sample, and the steps to them. Sub-lights have many buffers.
 * For them, four pixels stand for the pixels of all buffers: their distance from the sample is the mean
 * distance of the buffers' pixels. */
typedef struct near_pixels {
  /* The distances, along u and along v, from the sample to each near pixel; in pixels. */
  lanes u[NEAR_PIXELS], v[NEAR_PIXELS];
  lanes3 along_u, along_v; /* along_u: the step on the sheet by which u grows by one pixel and v does not
                            * change; along_v: the step by which v grows by one pixel and u does not change;
                            * frame space */
} near_pixels;

/* The facts about a light that a slab's samples need. */
typedef struct seen_light {
  lanes3 towards;          /* unit direction to the light */
  lanes path;              /* length of the light's way through the slab */
  const near_pixels *near; /* the four pixels of the light's buffer around the sample; null if no face of a
                            * box is near, or look-ups read only the nearest pixel */
} seen_light;

LANES_INLINE lanes3 cross3(lanes3 a, lanes3 b) {
  return (lanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Finds the steps of one pixel along u and v on a sheet. Derived: u = (row 1 . x) / (row 0 . x) has the
 * gradient (row 1 - u row 0) / (row 0 . x), and v has the gradient (row 2 - v row 0) / (row 0 . x). The step
 * on the sheet that raises u by one and does not change v is (grad v x h) / (grad u . (grad v x h)). For the
 * step that raises v, exchange u and v. */
LANES_INLINE void find_steps(const shadow_map *map, int parallel, lanes3 normal, lanes3 position,
                             near_pixels *near) {
  lanes3 gradient_u = set3(map->rows[1]), gradient_v = set3(map->rows[2]);
  if (!parallel) {
    lanes ahead = row_of_point(map->rows[0], position),
          inverse = 1.0f / lanes_select(ahead > 0.0f, ahead, lanes_set(1.0f));
    lanes u = row_of_point(map->rows[1], position) * inverse,
          v = row_of_point(map->rows[2], position) * inverse;
    gradient_u = scale3(add_scaled3(gradient_u, set3(map->rows[0]), -u), inverse);
    gradient_v = scale3(add_scaled3(gradient_v, set3(map->rows[0]), -v), inverse);
  }
  lanes3 along_u = cross3(gradient_v, normal), along_v = cross3(normal, gradient_u);
  lanes rise = dot3(gradient_u, along_u);
  lanes inverse = 1.0f / lanes_select(rise == 0.0f, lanes_set(1.0f), rise);
  near->along_u = scale3(along_u, inverse);
  near->along_v = scale3(along_v, inverse);
}

LANES_INLINE near_pixels pixels_around(const shadow_taps *taps) {
  near_pixels near;
  for (int i = 0; i < NEAR_PIXELS; i++) {
    near.u[i] = lanes_set((float)(i % 2)) - taps->fx;
    near.v[i] = lanes_set((float)(i / 2)) - taps->fy;
  }
  return near;
}

LANES_INLINE near_pixels pixels_of_sublights(void) {
  near_pixels near;
  for (int i = 0; i < NEAR_PIXELS; i++) {
    near.u[i] = lanes_set(i % 2 ? SUBLIGHT_SPREAD : -SUBLIGHT_SPREAD);
    near.v[i] = lanes_set(i / 2 ? SUBLIGHT_SPREAD : -SUBLIGHT_SPREAD);
  }
  return near;
}

/* Shortens a way from a point towards the light to the first part that no cut removes. enter, leave:
 * distances from the point to the two ends of the way. */
LANES_INLINE void shorten_way(const shade_volume *volume, lanes3 from, lanes3 towards, lanes *enter,
                              lanes *leave) {
  for (int i = 0; i < volume->light_cut_count; i++) {
    const shade_cut *cut = &volume->cuts[i];
    ray_section way = cross_cut(cut, from, towards);
    if (cut->keep_inside) {
      *enter = lanes_max(*enter, way.first);
      *leave = lanes_min(*leave, way.last);
    } else {
      lanes_int ahead = (way.first < way.last) & (way.last > *enter);
      *leave = lanes_select(ahead, lanes_min(*leave, lanes_max(way.first, *enter)), *leave);
    }
  }
}

/* The length of the parts of a way from a point towards the light that no cut removes. */
LANES_INLINE lanes way_left(const shade_volume *volume, lanes3 from, lanes3 towards, lanes enter,
                            lanes leave) {
  lanes removed = lanes_set(0);
  for (int i = 0; i < volume->light_cut_count; i++)
    if (volume->cuts[i].keep_inside) {
      ray_section way = cross_cut(&volume->cuts[i], from, towards);
      enter = lanes_max(enter, way.first);
      leave = lanes_min(leave, way.last);
    }
  for (int i = 0; i < volume->light_cut_count; i++)
    if (!volume->cuts[i].keep_inside) {
      ray_section way = cross_cut(&volume->cuts[i], from, towards);
      removed = removed + lanes_max(lanes_min(leave, way.last) - lanes_max(enter, way.first), lanes_set(0));
    }
  return lanes_max(leave - enter - removed, lanes_set(0));
}

/* The lengths of the light's ways within a volume's box before the slab's first sheet. These are the ways to
 * the points where the eye's ray enters and leaves the slab's part in the box, and the ways to the near
 * pixels. */
typedef struct ways_before {
  lanes first, last, near[NEAR_PIXELS];
} ways_before;

/* The two faces of a box across one axis. ahead, behind: the distances, towards the light, from the lit
 * position to the face on the light's side and to the opposite face. u, v: the decrease of both distances
 * with a step of one pixel along u or v. along: the decrease of both distances when the lit position moves
 * through the whole slab along the eye's ray. */
typedef struct faces_of_axis {
  lanes ahead, behind, u, v, along;
} faces_of_axis;

/* Finds the distances of a cut's face from the lit position, as find_faces() does for a box, and returns the
 * same kind of number. The face ahead counts as flat: it is replaced by the plane that touches the cut's
 * shape where the light's ray meets it. */
LANES_INLINE lanes face_of_cut(const shade_cut *cut, lanes3 position, lanes3 towards, const near_pixels *near,
                               lanes through) {
  ray_section way = cross_cut(cut, position, towards);
  lanes ahead = cut->keep_inside ? way.last : way.first;
  lanes_int met = (way.first < way.last) & (way.last > 0.0f) & (ahead < 1e20f);
  if (lanes_bits(met) == 0) return lanes_set(0);
  ahead = lanes_max(lanes_keep(met, ahead), lanes_set(0));
  cut_height height = height_over_cut(cut, add_scaled3(position, towards, ahead));
  lanes slowness = 1.0f / some_speed(dot3(height.gradient, towards));
  lanes reach = (lanes_abs(dot3(height.gradient, near->along_u)) +
                 lanes_abs(dot3(height.gradient, near->along_v))) *
                lanes_abs(slowness);
  lanes close = lanes_clamp(2.0f - ahead / lanes_max(reach, lanes_set(1e-30f)), 0, 1);
  return lanes_keep(met, close * lanes_clamp(2.0f - reach / through, 0, 1));
}

/* Finds the distances of a box's faces from the lit position. Derived (slab method): if a point moves
 * sideways by s, its distance to the face along the light's way changes by -row.s / row.l, where l is the
 * light's direction. Returns the weight of the correction for the face, from 0 to 1. It is 1 near a face
 * through which the light comes, because light to some near pixel then passes beside the face. It falls to 0
 * at twice the distance of the near pixels. */
LANES_INLINE lanes find_faces(const shade_volume *volume, const block_geometry *g, lanes3 towards,
                              const near_pixels *near, faces_of_axis faces[3]) {
  lanes close[3], reach[3], longest = lanes_set(1e30f), likely = lanes_set(0);
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    const grid *grid = volume->grid;
    lanes speed = row_of_vector(row, towards);
    speed = lanes_select(lanes_abs(speed) < 1e-12f, lanes_set(1e-12f), speed);
    lanes slowness = 1.0f / speed, at = row_of_point(row, g->position);
    lanes_int rising = speed > 0.0f;
    lanes low = lanes_set(grid->face_low[axis]), high = lanes_set(grid->face_high[axis]);
    faces[axis] = (faces_of_axis){.ahead = (lanes_select(rising, high, low) - at) * slowness,
                                  .behind = (lanes_select(rising, low, high) - at) * slowness,
                                  .u = row_of_vector(row, near->along_u) * slowness,
                                  .v = row_of_vector(row, near->along_v) * slowness,
                                  .along = row_of_vector(row, g->step_sheet) * slowness};
    reach[axis] = lanes_abs(faces[axis].u) + lanes_abs(faces[axis].v);
    close[axis] = lanes_clamp(2.0f - faces[axis].ahead / lanes_max(reach[axis], lanes_set(1e-30f)), 0, 1);
    likely = lanes_max(likely, close[axis]);
    longest = lanes_min(longest, (volume->high[axis] - volume->low[axis]) * lanes_abs(slowness));
  }
  lanes through = longest * ALONG_FACE;
  if (lanes_bits(likely > 0.0f) != 0) {
    likely = lanes_set(0);
    for (int axis = 0; axis < 3; axis++)
      likely = lanes_max(likely, close[axis] * lanes_clamp(2.0f - reach[axis] / through, 0, 1));
  }
  for (int i = 0; i < volume->light_cut_count; i++)
    likely = lanes_max(likely, face_of_cut(&volume->cuts[i], g->position, towards, near, through));
  return likely;
}

/* A point near a sample. u, v: the steps along u and v, in pixels, from the sample to the point. along: the
 * way from the sample to the point along the eye's ray, as a fraction of the slab. within: the length of the
 * light's way from the slab's first sheet to the point. */
typedef struct point_beside {
  lanes u, v, along, within;
} point_beside;

/* The length of the light's way to a point, within the volume's box, before the slab. */
LANES_INLINE lanes way_before(const shade_volume *volume, const faces_of_axis faces[3],
                              const block_geometry *g, const seen_light *light, point_beside point) {
  lanes leave = lanes_set(1e30f), enter = point.within;
  for (int axis = 0; axis < 3; axis++) {
    const faces_of_axis *f = &faces[axis];
    lanes less = lanes_fma(f->u, point.u, lanes_fma(f->v, point.v, f->along * point.along));
    leave = lanes_min(leave, f->ahead - less);
    enter = lanes_max(enter, f->behind - less);
  }
  if (volume->light_cut_count > 0) {
    lanes3 at = add_scaled3(g->position, light->near->along_u, point.u);
    at = add_scaled3(add_scaled3(at, light->near->along_v, point.v), g->step_sheet, point.along);
    shorten_way(volume, at, light->towards, &enter, &leave);
  }
  return lanes_max(leave - enter, lanes_set(0));
}

LANES_INLINE ways_before find_ways_before(const shade_volume *volume, const faces_of_axis faces[3],
                                          const block_slab *slab, const seen_light *light) {
  const block_geometry *g = &slab->geometry;
  const near_pixels *near = light->near;
  lanes none = lanes_set(0), begin = slab->part.begin, end = begin + slab->part.length, path = light->path;
  ways_before ways;
  ways.first = way_before(volume, faces, g, light,
                          (point_beside){none, none, begin - slab->place, begin * path});
  ways.last = way_before(volume, faces, g, light, (point_beside){none, none, end - slab->place, end * path});
  for (int i = 0; i < NEAR_PIXELS; i++)
    ways.near[i] = way_before(volume, faces, g, light,
                              (point_beside){near->u[i], near->v[i], none, slab->place * path});
  return ways;
}

#endif
