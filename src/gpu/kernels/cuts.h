/* gpu/kernels/cuts.h - the cuts of a volume: the part of a ray that cuts leave, and where rays cross the
 * cuts' faces. The functions compute for one pixel the same numbers as render/view_sheets.c,
 * render/cut_lanes.h and fill/face_skin_lanes.h for many pixels. */
#ifndef HL_GPU_CUTS_H
#define HL_GPU_CUTS_H

#include "core/sheet_constants.h"
#include "gpu/kernels/rays.h"

/* ---- the part of a pixel's ray that is left ---- */

/* The heights between which a pixel's ray runs in the box, and inside all cuts that keep their inside.
 * cuts: [count]; the cuts of the pixel's view. */
DEVICE heights_in_box heights_left(GLOBAL const plan_box *box, GLOBAL const plan_cut *cuts, int count,
                                   float u, float v) {
  heights_in_box left = heights_of(box, u, v);
  for (int i = 0; i < count; i++) {
    if (!cuts[i].keep_inside) continue;
    const heights_in_box inside = heights_of(&cuts[i].rays, u, v);
    left.enter = greater(inside.enter, left.enter);
    left.leave = lesser(inside.leave, left.leave);
  }
  return left;
}

/* Shortens a ray's section in a slab by the removed section from `from` to `to`, as remove_section() in
 * render/view_sheets.c. */
DEVICE void remove_section(float from, float to, heights_in_box *left) {
  if (!(from < to) || to <= left->enter || from >= left->leave) return;
  if (from > left->enter && to < left->leave) left->leave = left->leave - (to - from);
  else if (from > left->enter) left->leave = from;
  else if (to < left->leave) left->enter = to;
  else left->leave = left->enter;
}

/* The heights between which a pixel's ray runs through a slab outside of all cuts that keep their outside. A
 * ray that goes on leaves just beyond the slab's end; see BEYOND_SLAB. left: the result of heights_left(). */
DEVICE heights_in_box heights_in_slab(heights_in_box left, GLOBAL const plan_cut *cuts, int count, float u,
                                      float v, float height, float spacing) {
  left.enter = greater(left.enter, height - spacing);
  left.leave = lesser(left.leave, height * BEYOND_SLAB);
  for (int i = 0; i < count && left.enter < left.leave; i++) {
    if (cuts[i].keep_inside) continue;
    const heights_in_box removed = heights_of(&cuts[i].rays, u, v);
    remove_section(removed.enter, removed.leave, &left);
  }
  return left;
}

/* ---- where rays cross faces ---- */

DEVICE float row_size(GLOBAL const float *row) {
  return root(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
}

/* Returns the speed, or 1e-12 if the speed's magnitude is less. */
DEVICE float some_speed(float speed) { return magnitude(speed) < 1e-12f ? 1e-12f : speed; }

DEVICE vector point_in_shape(GLOBAL const float rows[3][4], vector p) {
  return vector_of(row_of_point(rows[0], p), row_of_point(rows[1], p), row_of_point(rows[2], p));
}

/* Finds the section of a ray within a cut's shape, as two distances along the ray. The first distance is
 * greater than the last one if the ray misses the shape. */
DEVICE ray_section cross_cut(GLOBAL const plan_cut *cut, vector from, vector along) {
  const vector at = point_in_shape(cut->rows, from);
  const vector speed = vector_of(row_of_vector(cut->rows[0], along), row_of_vector(cut->rows[1], along),
                                 row_of_vector(cut->rows[2], along));
  if (cut->shape == CUT_SPHERE) return roots_of_sphere(at, speed);
  ray_section way;
  way.first = -1e30f;
  way.last = 1e30f;
  if (cut->shape == CUT_PLANE) {
    const float crossing = divided(-at.x, some_speed(speed.x));
    if (speed.x >= 0.0f) way.first = crossing;
    else way.last = crossing;
    return way;
  }
  const float starts[3] = {at.x, at.y, at.z}, speeds[3] = {speed.x, speed.y, speed.z};
  for (int a = 0; a < 3; a++) {
    const float slowness = divided(1.0f, some_speed(speeds[a]));
    const float low = (-1.0f - starts[a]) * slowness, high = (1.0f - starts[a]) * slowness;
    way.first = greater(way.first, lesser(low, high));
    way.last = lesser(way.last, greater(low, high));
  }
  return way;
}

/* The gradient of the height of points over a shape, per frame unit. */
DEVICE vector gradient_over_cut(GLOBAL const plan_cut *cut, vector point) {
  const vector q = point_in_shape(cut->rows, point);
  if (cut->shape == CUT_PLANE) return scaled(vector_at(cut->rows[0]), -1.0f);
  if (cut->shape == CUT_SPHERE) {
    const float length = greater(root(dot3(q, q)), 1e-6f);
    const vector unit = scaled(q, divided(1.0f, length));
    return add_scaled(add_scaled(scaled(vector_at(cut->rows[0]), unit.x), vector_at(cut->rows[1]), unit.y),
                      vector_at(cut->rows[2]), unit.z);
  }
  const float at[3] = {q.x, q.y, q.z};
  vector gradient = vector_of(0.0f, 0.0f, 0.0f);
  float most = -1e30f;
  for (int a = 0; a < 3; a++) {
    const float distance = divided(magnitude(at[a]) - 1.0f, row_size(cut->rows[a]));
    if (!(distance > most)) continue;
    most = distance;
    gradient = scaled(vector_at(cut->rows[a]), at[a] < 0.0f ? -1.0f : 1.0f);
  }
  return gradient;
}

/* ---- the light's ways ---- */

/* The part of a way towards a light in which the box and the cuts leave matter: the beginning and the end of
 * the part, as lengths along the way. */
typedef struct way_left {
  float enter, leave;
} way_left;

/* Shortens a way from a point towards the light: it ends where it first enters a part that a cut has
 * removed. */
DEVICE void shorten_way(GLOBAL const plan_cut *cuts, int count, vector from, vector towards, way_left *left) {
  for (int i = 0; i < count; i++) {
    const ray_section way = cross_cut(&cuts[i], from, towards);
    if (cuts[i].keep_inside) {
      left->enter = greater(left->enter, way.first);
      left->leave = lesser(left->leave, way.last);
    } else if (way.first < way.last && way.last > left->enter) {
      left->leave = lesser(left->leave, greater(way.first, left->enter));
    }
  }
}

/* The length of the parts of a way from a point towards the light that no cut removes. left: the part of the
 * way that counts. */
DEVICE float length_left(GLOBAL const plan_cut *cuts, int count, vector from, vector towards, way_left left) {
  float removed = 0.0f;
  for (int i = 0; i < count; i++) {
    if (!cuts[i].keep_inside) continue;
    const ray_section way = cross_cut(&cuts[i], from, towards);
    left.enter = greater(left.enter, way.first);
    left.leave = lesser(left.leave, way.last);
  }
  for (int i = 0; i < count; i++) {
    if (cuts[i].keep_inside) continue;
    const ray_section way = cross_cut(&cuts[i], from, towards);
    removed = removed + greater(lesser(left.leave, way.last) - greater(left.enter, way.first), 0.0f);
  }
  return greater(left.leave - left.enter - removed, 0.0f);
}

/* Returns whether a sample is so far from the faces of all cuts that no face changes the light's ways to it
 * and to the pixels around it. Only planes, and boxes whose inside is left, are tested, because behind them
 * the nearest face is also the first face on the light's way. If there is any other cut, the result is 0.
 * step: the step along the eye's ray through the slab. */
DEVICE int is_far_from_cuts(GLOBAL const plan_cut *cuts, int count, vector position, vector step) {
  int far = 1;
  for (int i = 0; i < count && far; i++) {
    GLOBAL const plan_cut *cut = &cuts[i];
    if (cut->shape == CUT_SPHERE || (cut->shape == CUT_BOX && !cut->keep_inside)) return 0;
    for (int a = 0; a < (cut->shape == CUT_PLANE ? 1 : 3); a++) {
      const float reach = cut->margin[a] + magnitude(row_of_vector(cut->rows[a], step)),
                  at = magnitude(row_of_point(cut->rows[a], position));
      far = far && (cut->shape == CUT_PLANE ? at > reach : at < 1.0f - reach);
    }
  }
  return far;
}

/* ---- the skin of faces ---- */

/* The skin of one face: the fraction of the matter behind the face that belongs to the face. before, depth:
 * the depths of a ray behind the face on a slab's first and last sheet; in voxels. */
DEVICE float skin_of_depth(float before, float depth) {
  const float middle = (greater(before, 0.0f) + depth) * 0.5f;
  return depth > before ? limited(FACE_VOXELS - middle, 0.0f, 1.0f) : 0.0f;
}

/* The skin of two opposite faces, which lie at the places low and high of an axis. scale: voxels per unit of
 * the axis. */
DEVICE float skin_of_axis(float from, float to, float low, float high, float scale) {
  return greater(skin_of_depth((from - low) * scale, (to - low) * scale),
                 skin_of_depth((high - from) * scale, (high - to) * scale));
}

/* The distances of a point from the three pairs of faces of a cut's box, in voxels; below 0 between the
 * faces. */
DEVICE vector distances_to_box(GLOBAL const plan_cut *cut, vector at) {
  return vector_of((magnitude(at.x) - 1.0f) * cut->scale[0], (magnitude(at.y) - 1.0f) * cut->scale[1],
                   (magnitude(at.z) - 1.0f) * cut->scale[2]);
}

/* The distance of a point from a cut's shape, in voxels; below 0 inside the shape. */
DEVICE float distance_to_shape(GLOBAL const plan_cut *cut, vector at) {
  if (cut->shape == CUT_PLANE) return at.x * -cut->scale[0];
  if (cut->shape == CUT_SPHERE) return (root(dot3(at, at)) - 1.0f) * cut->scale[0];
  const vector from_faces = distances_to_box(cut, at);
  return greater(greater(from_faces.x, from_faces.y), from_faces.z);
}

/* The skin of all faces of a cut. from, to: where a light's ray meets the slab's sheets; index space. */
DEVICE float skin_of_cut(GLOBAL const plan_cut *cut, vector from, vector to) {
  const vector a = point_in_shape(cut->in_index, from), b = point_in_shape(cut->in_index, to);
  if (cut->shape == CUT_BOX && cut->keep_inside)
    return greater(greater(skin_of_axis(a.x, b.x, -1.0f, 1.0f, cut->scale[0]),
                           skin_of_axis(a.y, b.y, -1.0f, 1.0f, cut->scale[1])),
                   skin_of_axis(a.z, b.z, -1.0f, 1.0f, cut->scale[2]));
  const float before = distance_to_shape(cut, a), depth = distance_to_shape(cut, b);
  return cut->keep_inside ? skin_of_depth(-before, -depth) : skin_of_depth(before, depth);
}

/* Returns whether a light's ray comes near to an edge of a box whose outside is left, on the way to the box.
 * from, to: as for skin_of_cut(). The result is the same as that of nears_edge() in fill/face_skin_lanes.h.
 */
DEVICE int nears_edge(GLOBAL const plan_cut *cut, vector from, vector to) {
  const vector before = distances_to_box(cut, point_in_shape(cut->in_index, from)),
               after = distances_to_box(cut, point_in_shape(cut->in_index, to));
  const float farthest = greater(greater(after.x, after.y), after.z);
  const float second = greater(lesser(after.x, after.y), lesser(greater(after.x, after.y), after.z));
  return greater(greater(before.x, before.y), before.z) > farthest && farthest < FACE_VOXELS &&
         second > -FACE_VOXELS;
}

#endif
