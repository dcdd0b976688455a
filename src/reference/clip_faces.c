/* reference/clip_faces.c - the faces of a volume's box, at the grid's border or at a clip, which cut its
 * matter. */
#include <math.h>

#include "reference/reference.h"

static const double TOUCHING = 1e-3; /* voxels */

/* Points as far behind a face as these are lit as usual. */
static const double FACE_VOXELS = 2;

/* The bounds of another volume's box in this one's index space. */
static void bounds_of(const hl_scene_volume *other, affine3 world_to_index, double low[3], double high[3]) {
  affine3 placement = affine3_multiply(world_to_index, hl_scene_volume_index_to_world(other));
  double box[2][3];
  hl_scene_volume_box(other, box[0], box[1]);
  for (int a = 0; a < 3; a++) low[a] = INFINITY, high[a] = -INFINITY;
  for (int c = 0; c < 8; c++) {
    vec3 p = affine3_apply(placement, (vec3){box[c & 1][0], box[c >> 1 & 1][1], box[c >> 2][2]});
    const double corner[3] = {p.x, p.y, p.z};
    for (int a = 0; a < 3; a++) low[a] = fmin(low[a], corner[a]), high[a] = fmax(high[a], corner[a]);
  }
}

/* Leaves out the faces that touch the other volume, which goes on there. */
static void join(const hl_scene_volume *other, reference_volume *volume) {
  double low[3], high[3];
  bounds_of(other, volume->world_to_index, low, high);
  for (int a = 0; a < 3; a++) {
    bool beside = false;
    for (int n = 1; n < 3; n++) {
      int b = (a + n) % 3;
      beside = beside || low[b] > volume->high[b] - TOUCHING || high[b] < volume->low[b] + TOUCHING;
    }
    if (!beside && fabs(high[a] - volume->low[a]) < TOUCHING) volume->clip_low[a] = -INFINITY;
    if (!beside && fabs(low[a] - volume->high[a]) < TOUCHING) volume->clip_high[a] = INFINITY;
  }
}

void hl_reference_find_clip_faces(const hl_scene_description *scene, reference_volume *volume) {
  for (int a = 0; a < 3; a++) {
    bool faces = volume->described->cut_shading != HL_CUT_SHADING_GRADIENT;
    volume->clip_low[a] = faces ? volume->low[a] : -INFINITY;
    volume->clip_high[a] = faces ? volume->high[a] : INFINITY;
  }
  for (size_t i = 0; i < scene->volume_count; i++)
    if (&scene->volumes[i] != volume->described && scene->volumes[i].casts_shadow)
      join(&scene->volumes[i], volume);
}

/* Whether a point is seen through matter that a face cuts: what ends by itself close to the face is not.
 * to_eye: by index coordinates. */
static bool seen_through_face(const reference_volume *volume, vec3 point, vec3 to_eye, int axis,
                              double face) {
  const double p[3] = {point.x, point.y, point.z}, along[3] = {to_eye.x, to_eye.y, to_eye.z};
  const double way = (face - p[axis]) / along[axis];
  if (!(way >= 0)) return false;
  const vec3 at = vec3_add(point, vec3_scale(to_eye, way));
  const double crossed[3] = {at.x, at.y, at.z};
  for (int a = 0; a < 3; a++)
    if (a != axis && (crossed[a] < volume->low[a] || crossed[a] > volume->high[a])) return false;
  return hl_reference_extinction(volume, hl_reference_value(volume, at), at) > 0;
}

double hl_reference_nearest_clip(const reference_volume *volume, vec3 point, vec3 to_eye, vec3 *outward) {
  const vec3 along = mat3_apply(volume->world_to_index.linear, to_eye);
  const double p[3] = {point.x, point.y, point.z};
  double least = INFINITY;
  for (int a = 0; a < 3; a++) {
    vec3 rise = mat3_apply(volume->gradient_to_world, (vec3){a == 0, a == 1, a == 2});
    const double edge = 1 / vec3_length(rise), faces[2] = {volume->clip_low[a], volume->clip_high[a]};
    for (int high = 0; high < 2; high++) {
      const double depth = fmax(high ? faces[1] - p[a] : p[a] - faces[0], 0) * edge;
      if (!(depth < least) || depth >= FACE_VOXELS * volume->smallest_edge) continue;
      if (!seen_through_face(volume, point, along, a, faces[high])) continue;
      least = depth;
      *outward = vec3_scale(rise, high ? edge : -edge);
    }
  }
  return least;
}
