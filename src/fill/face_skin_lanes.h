/* fill/face_skin_lanes.h - finds how much of the matter that a light's rays reach belongs to a face that cuts
 * the matter. Faces are faces of the volume's box and of cuts. In: a run's rays, box and cuts (fill.h). Out:
 * a number from 0 to 1, the skin. The skin is 1 up to a voxel behind a face, and 0 from FACE_VOXELS behind
 * the face on. Only faces through which light comes in count. */
#ifndef HL_FILL_FACE_SKIN_LANES_H
#define HL_FILL_FACE_SKIN_LANES_H

#include "core/sheet_constants.h"
#include "fill/fill.h"
#include "grid/faces.h"
#include "view/rays_lanes.h"

/* The skin of one face: the fraction of a ray's matter in a slab that belongs to the face. The skin is found
 * in the middle of the ray's part that lies behind the face. before, depth: the ray's distances behind the
 * face, in voxels, on the slab's first and last sheet. */
LANES_INLINE lanes skin_of_depth(lanes before, lanes depth) {
  lanes middle = (lanes_max(before, lanes_set(0)) + depth) * 0.5f;
  return lanes_keep(depth > before, lanes_clamp(FACE_VOXELS - middle, 0, 1));
}

/* The greater of the skins of two opposite faces. The faces lie at the coordinates low and high of an axis.
 * from, to: the coordinates of the rays on the slab's first and last sheet. scale: voxels per unit of the
 * axis. */
LANES_INLINE lanes skin_of_axis(lanes from, lanes to, lanes low, lanes high, lanes scale) {
  return lanes_max(skin_of_depth((from - low) * scale, (to - low) * scale),
                   skin_of_depth((high - from) * scale, (high - to) * scale));
}

LANES_INLINE lanes3 point_in_shape(const run_cut *cut, lanes3 point) {
  return (lanes3){row_of_point(cut->rows[0], point), row_of_point(cut->rows[1], point),
                  row_of_point(cut->rows[2], point)};
}

/* The distances of a point, given in a cut's own space, from the three pairs of faces of a box; in voxels.
 * The distances are negative between the faces. scale: voxels per unit of each axis of the cut's space. */
LANES_INLINE lanes3 distances_to_box(lanes3 at, const float scale[3]) {
  return (lanes3){(lanes_abs(at.x) - 1.0f) * scale[0], (lanes_abs(at.y) - 1.0f) * scale[1],
                  (lanes_abs(at.z) - 1.0f) * scale[2]};
}

/* The distance of a point from the shape of a cut, in voxels: positive outside the shape, negative inside the
 * shape. The point is given in the cut's own space. scale: voxels per unit of each axis of the cut's space.
 */
LANES_INLINE lanes distance_to_shape(const run_cut *cut, lanes3 at, const float scale[3]) {
  if (cut->shape->type == HL_CUT_PLANE) return at.x * -scale[0];
  if (cut->shape->type == HL_CUT_SPHERE) return (lanes_sqrt(dot3(at, at)) - 1.0f) * scale[0];
  lanes3 from_faces = distances_to_box(at, scale);
  return lanes_max(lanes_max(from_faces.x, from_faces.y), from_faces.z);
}

/* The skin of a cut: the fraction of the matter that belongs to one of the cut's faces. Into a box whose
 * inside is left, light may come through one face close to another face. So the function tests all faces of
 * such a box, and not only the nearest face. */
LANES_INLINE lanes skin_of_cut(const run_cut *cut, lanes3 from, lanes3 to, float voxel) {
  const float scale[3] = {1.0f / (cut->size[0] * voxel), 1.0f / (cut->size[1] * voxel),
                          1.0f / (cut->size[2] * voxel)};
  const lanes low = lanes_set(-1.0f), high = lanes_set(1.0f);
  lanes3 a = point_in_shape(cut, from), b = point_in_shape(cut, to);
  if (cut->shape->type == HL_CUT_BOX && cut->shape->keep_inside)
    return lanes_max(lanes_max(skin_of_axis(a.x, b.x, low, high, lanes_set(scale[0])),
                               skin_of_axis(a.y, b.y, low, high, lanes_set(scale[1]))),
                     skin_of_axis(a.z, b.z, low, high, lanes_set(scale[2])));
  lanes before = distance_to_shape(cut, a, scale), depth = distance_to_shape(cut, b, scale);
  return cut->shape->keep_inside ? skin_of_depth(-before, -depth) : skin_of_depth(before, depth);
}

/* The skin of all faces on the rays of a block, in slab number `slab` of a run. */
LANES_INLINE lanes skin_of_faces(const slab_run *run, int slab, lanes u, lanes v) {
  const grid *grid = run->grid;
  lanes3 from = rays_positions(&run->rays[slab], u, v), to = rays_positions(&run->rays[slab + 1], u, v);
  const lanes a[3] = {from.x, from.y, from.z}, b[3] = {to.x, to.y, to.z};
  lanes skin = lanes_set(0);
  for (int axis = 0; axis < 3; axis++)
    skin = lanes_max(skin, skin_of_axis(a[axis], b[axis], lanes_set(grid->face_low[axis]),
                                        lanes_set(grid->face_high[axis]), lanes_set(run->steps[axis])));
  for (int i = 0; i < run->cut_count; i++)
    skin = lanes_max(skin, skin_of_cut(&run->cuts[i], from, to, run->voxel));
  return skin;
}

/* The rays that come nearer than FACE_VOXELS to an edge of a box whose outside is left, on the way to the
 * box. At such an edge two faces meet in an inner corner of the matter. */
LANES_INLINE lanes_int nears_edge(const run_cut *cut, lanes3 from, lanes3 to, float voxel) {
  const float scale[3] = {1.0f / (cut->size[0] * voxel), 1.0f / (cut->size[1] * voxel),
                          1.0f / (cut->size[2] * voxel)};
  lanes3 before = distances_to_box(point_in_shape(cut, from), scale),
         after = distances_to_box(point_in_shape(cut, to), scale);
  lanes farthest = lanes_max(lanes_max(after.x, after.y), after.z);
  lanes second = lanes_max(lanes_min(after.x, after.y), lanes_min(lanes_max(after.x, after.y), after.z));
  return (lanes_max(lanes_max(before.x, before.y), before.z) > farthest) & (farthest < FACE_VOXELS) &
         (second > -FACE_VOXELS);
}

/* Returns whether a cut's box leaves inner corners in the matter. */
LANES_INLINE int has_inner_corners(const slab_run *run) {
  int has = 0;
  for (int i = 0; i < run->cut_count; i++) has |= hl_cut_hollows_out(run->cuts[i].shape);
  return has;
}

/* The rays of a block that come near to an inner corner of matter, in slab number `slab` of a run. The
 * function is not inlined, so that it does not slow down the many runs without such corners. */
static __attribute__((noinline, unused)) lanes_int nears_inner_corner(const slab_run *run, int slab, lanes u,
                                                                      lanes v) {
  lanes_int near = lanes_set_int(0);
  for (int i = 0; i < run->cut_count; i++)
    if (hl_cut_hollows_out(run->cuts[i].shape))
      near |= nears_edge(&run->cuts[i], rays_positions(&run->rays[slab], u, v),
                         rays_positions(&run->rays[slab + 1], u, v), run->voxel);
  return near;
}

#endif
