/* guess/cut_view.c - see cut_view.h. */
#include "guess/cut_view.h"

#include "core/vector.h"
#include "guess/for_volume.h"
#include "scene/geometry/camera.h"
#include "scene/geometry/cut.h"
#include "scene/geometry/placement.h"

/* The elevation from which the three faces at a corner of a cube look alike. */
static const double ISOMETRIC = 35.26438968275465;

/* If the sum of the faces' normals rises by more than SOME_RISE, the faces as a whole look up. */
static const double SOME_RISE = 0.5;

/* The normals of faces, away from the matter that remains. */
typedef struct face_normals {
  affine3 world_to_index;
  double low[3], high[3]; /* the volume's grid; index space */
  vec3 *normals;          /* [MOST_FACES]; unit vectors; world */
  int count;
} face_normals;

enum { MOST_FACES = 64 };

/* Adds a face. outward: a gradient in index space that points away from the matter. */
static void add_face(face_normals *faces, vec3 outward) {
  if (faces->count == MOST_FACES) return;
  faces->normals[faces->count++] = vec3_normalise(
      mat3_apply(mat3_transpose(faces->world_to_index.linear), outward));
}

/* Returns whether the plane on which a coordinate of a shape's own space has a value crosses the grid. */
static bool crosses_grid(const face_normals *faces, const affine3 *to_shape, int axis, double value) {
  bool below = false, above = false;
  for (int corner = 0; corner < 8; corner++) {
    const vec3 at = {corner & 1 ? faces->high[0] : faces->low[0], corner & 2 ? faces->high[1] : faces->low[1],
                     corner & 4 ? faces->high[2] : faces->low[2]};
    const vec3 q = affine3_apply(*to_shape, at);
    const double place = vec3_component(q, axis);
    below |= place < value;
    above |= place > value;
  }
  return below && above;
}

/* Adds the faces of a plane or of a box that cross the grid. A sphere has a face on every side. */
static void add_cut(face_normals *faces, const cut_shape *cut) {
  const mat3 *rows = &cut->to_shape.linear;
  const double kept = cut->keep_inside ? -1 : 1;
  if (cut->type == HL_CUT_PLANE && crosses_grid(faces, &cut->to_shape, 0, 0))
    add_face(faces, vec3_scale(rows->row[0], kept));
  for (int axis = 0; axis < 3 && cut->type == HL_CUT_BOX; axis++)
    for (int side = -1; side <= 1; side += 2)
      if (crosses_grid(faces, &cut->to_shape, axis, side))
        add_face(faces, vec3_scale(rows->row[axis], -kept * side));
}

/* Adds the faces of the clip box that lie more than half a voxel within the grid. */
static void add_clip(face_normals *faces, const hl_scene_volume *volume) {
  double low[3], high[3];
  hl_scene_volume_box(volume, low, high);
  for (int a = 0; a < 3; a++) {
    const vec3 along = {a == 0, a == 1, a == 2};
    if (low[a] > faces->low[a] + 0.5) add_face(faces, vec3_scale(along, -1));
    if (high[a] < faces->high[a] - 0.5) add_face(faces, along);
  }
}

/* The sum, over the faces that an eye sees from their front, of the cosines at which the eye and a key light
 * see each face. The key light turns with the eye. */
static double shown(const face_normals *faces, const hl_light *light, const hl_view *view) {
  vec3 right, up, forward;
  hl_view_axes(view, &right, &up, &forward);
  const vec3 to_eye = vec3_scale(forward, -1), from_light = vec3_of(light->direction),
             aside = vec3_add(vec3_scale(right, from_light.x), vec3_scale(up, from_light.y)),
             to_light = vec3_scale(vec3_add(aside, vec3_scale(to_eye, from_light.z)), -1);
  double sum = 0;
  for (int f = 0; f < faces->count; f++) {
    const double seen = vec3_dot(faces->normals[f], to_eye);
    if (seen > 0) sum += seen + fmax(vec3_dot(faces->normals[f], to_light), 0);
  }
  return sum;
}

void hl_view_turn_to_cuts(const hl_scene_volume *volume, size_t count, hl_view *view) {
  vec3 normals[MOST_FACES];
  face_normals faces = {.normals = normals};
  hl_light light;
  hl_scene_key_light(&light);
  if (!affine3_invert(hl_scene_volume_index_to_world(volume), &faces.world_to_index)) return;
  hl_scene_volume whole = *volume;
  whole.clipped = 0;
  hl_scene_volume_box(&whole, faces.low, faces.high);
  add_clip(&faces, volume);
  for (size_t i = volume->cut_count - count; i < volume->cut_count; i++) {
    const cut_shape cut = hl_cut_shape(volume, i);
    add_cut(&faces, &cut);
  }
  double rise = 0; /* how far the faces look up */
  for (int f = 0; f < faces.count; f++) rise += vec3_dot(faces.normals[f], vec3_of(view->up));
  if (rise > SOME_RISE) view->elevation_deg = fmax(view->elevation_deg, ISOMETRIC);
  if (rise < -SOME_RISE) view->elevation_deg = fmin(view->elevation_deg, -ISOMETRIC);
  const double azimuth = view->azimuth_deg;
  double most = shown(&faces, &light, view) + 1e-6;
  for (int n = 1; n < 8; n++) {
    hl_view other = *view;
    other.azimuth_deg = 90 * (n / 2) + (n % 2 ? -azimuth : azimuth);
    const double sum = shown(&faces, &light, &other);
    if (sum > most) *view = other, most = sum + 1e-6;
  }
}
