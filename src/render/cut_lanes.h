/* render/cut_lanes.h - tests the cuts of a volume at samples: finds where rays cross the cuts' shapes, and
 * how deep a sample lies behind their faces. */
#ifndef HL_RENDER_CUT_LANES_H
#define HL_RENDER_CUT_LANES_H

#include "render/cut.h"
#include "scene/geometry/cut.h"
#include "view/rays_lanes.h"

LANES_INLINE lanes3 point_in_cut(const shade_cut *cut, lanes3 p) {
  return (lanes3){row_of_point(cut->rows[0], p), row_of_point(cut->rows[1], p),
                  row_of_point(cut->rows[2], p)};
}

/* The speed at which a ray moves across a face, but a tiny number in place of 0. So a ray that is parallel to
 * a face meets the face far away, on the right side. */
LANES_INLINE lanes some_speed(lanes speed) {
  return lanes_select(lanes_abs(speed) < 1e-12f, lanes_set(1e-12f), speed);
}

/* Finds the section of a ray within a cut's shape, as two distances along the ray. The first distance is
 * greater than the last one if the ray misses the shape. */
LANES_INLINE ray_section cross_cut(const shade_cut *cut, lanes3 from, lanes3 along) {
  lanes3 at = point_in_cut(cut, from);
  lanes3 speed = {row_of_vector(cut->rows[0], along), row_of_vector(cut->rows[1], along),
                  row_of_vector(cut->rows[2], along)};
  ray_section way = {lanes_set(-1e30f), lanes_set(1e30f)};
  if (cut->type == HL_CUT_SPHERE) return roots_of_sphere(at, speed);
  if (cut->type == HL_CUT_PLANE) {
    lanes crossing = -at.x / some_speed(speed.x);
    lanes_int entering = speed.x >= 0.0f;
    return (ray_section){lanes_select(entering, crossing, way.first),
                         lanes_select(entering, way.last, crossing)};
  }
  const lanes starts[3] = {at.x, at.y, at.z}, speeds[3] = {speed.x, speed.y, speed.z};
  for (int a = 0; a < 3; a++) {
    lanes slowness = 1.0f / some_speed(speeds[a]);
    lanes low = (-1.0f - starts[a]) * slowness, high = (1.0f - starts[a]) * slowness;
    way.first = lanes_max(way.first, lanes_min(low, high));
    way.last = lanes_min(way.last, lanes_max(low, high));
  }
  return way;
}

/* The height of a point over a shape, above 0 outside the shape, in units of the shape's own space; and the
 * gradient of the height per frame unit. */
typedef struct cut_height {
  lanes height;
  lanes3 gradient;
} cut_height;

LANES_INLINE lanes row_size(const float row[4]) {
  return lanes_sqrt(lanes_set(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]));
}

/* The height over a plane is -x, over a sphere |q| - 1, and over a box the height over the face that is the
 * highest. */
LANES_INLINE cut_height height_over_cut(const shade_cut *cut, lanes3 point) {
  lanes3 q = point_in_cut(cut, point);
  if (cut->type == HL_CUT_PLANE) return (cut_height){-q.x, scale3(set3(cut->rows[0]), lanes_set(-1.0f))};
  if (cut->type == HL_CUT_SPHERE) {
    lanes length = lanes_max(lanes_sqrt(dot3(q, q)), lanes_set(1e-6f));
    lanes3 unit = scale3(q, 1.0f / length);
    return (cut_height){length - 1.0f, add_scaled3(add_scaled3(scale3(set3(cut->rows[0]), unit.x),
                                                               set3(cut->rows[1]), unit.y),
                                                   set3(cut->rows[2]), unit.z)};
  }
  const lanes at[3] = {q.x, q.y, q.z};
  cut_height highest = {.height = lanes_set(-1e30f)};
  lanes most = lanes_set(-1e30f);
  for (int a = 0; a < 3; a++) {
    lanes height = lanes_abs(at[a]) - 1.0f, distance = height / row_size(cut->rows[a]);
    lanes_int higher = distance > most;
    lanes sign = lanes_select(at[a] < 0.0f, lanes_set(-1.0f), lanes_set(1.0f));
    lanes3 gradient = scale3(set3(cut->rows[a]), sign);
    most = lanes_select(higher, distance, most);
    highest.height = lanes_select(higher, height, highest.height);
    highest.gradient = (lanes3){lanes_select(higher, gradient.x, highest.gradient.x),
                                lanes_select(higher, gradient.y, highest.gradient.y),
                                lanes_select(higher, gradient.z, highest.gradient.z)};
  }
  return highest;
}

#endif
