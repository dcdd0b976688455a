/* guess/cut_face.c - see cut_face.h. */
#include "guess/cut_face.h"

#include "scene/geometry/placement.h"

/* The direction away from the inside of a shape, at a point near its face. For a box, the direction lies
 * along the axis along which the point lies farthest outwards. */
static vec3 out_of_shape(const cut_shape *cut, vec3 point) {
  const mat3 *to_shape = &cut->to_shape.linear;
  vec3 q = affine3_apply(cut->to_shape, point);
  int axis = 0;
  if (cut->type == HL_CUT_PLANE) return vec3_scale(to_shape->row[0], -1);
  if (cut->type == HL_CUT_SPHERE) return mat3_apply(mat3_transpose(*to_shape), q);
  for (int a = 1; a < 3; a++)
    if (fabs(vec3_component(q, a)) > fabs(vec3_component(q, axis))) axis = a;
  return vec3_scale(to_shape->row[axis], vec3_component(q, axis) < 0 ? -1 : 1);
}

bool hl_cut_face_between(const hl_scene_volume *volume, const cut_shape *cuts, vec3 before, vec3 here,
                         vec3 *outward) {
  double low[3], high[3];
  for (size_t i = 0; i < volume->cut_count; i++) {
    if (hl_cuts_leave(&cuts[i], 1, before)) continue;
    *outward = vec3_scale(out_of_shape(&cuts[i], here), cuts[i].keep_inside ? 1 : -1);
    return true;
  }
  hl_scene_volume_box(volume, low, high);
  for (int a = 0; a < 3; a++) {
    const bool under = vec3_component(before, a)<low[a], over = vec3_component(before, a)> high[a];
    if (!under && !over) continue;
    *outward = (vec3){a == 0, a == 1, a == 2};
    if (under) *outward = vec3_scale(*outward, -1);
    return true;
  }
  return false;
}
