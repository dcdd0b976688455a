/* reference/cuts.c - finds whether a point of a volume or a mesh remains after the cuts. A cut is given in
 * the world of the volume's file, or in the scene's world. The point is converted to the same world before it
 * is tested.
 *
 * The height of a point over a cut's face is positive outside the cut's shape, and negative inside the shape.
 * Heights have the length unit of the cut's world. */
#include "reference/reference.h"

typedef struct height {
  double over; /* height over the face */
  vec3 rise;   /* the height's gradient, a unit vector in the cut's world */
} height;

/* The map from a volume's index space to the world in whose coordinates a cut of the volume is given. */
static affine3 world_of(const reference_volume *volume, const hl_cut *cut) {
  return cut->world ? volume->index_to_world : volume->grid->index_to_world;
}

static height height_over(const hl_cut *cut, vec3 p) {
  if (cut->type == HL_CUT_PLANE) {
    vec3 normal = vec3_normalise(vec3_of(cut->normal));
    return (height){vec3_dot(normal, vec3_subtract(vec3_of(cut->point), p)), vec3_scale(normal, -1)};
  }
  if (cut->type == HL_CUT_SPHERE) {
    vec3 way = vec3_subtract(p, vec3_of(cut->center));
    double length = vec3_length(way);
    return (height){length - cut->radius, vec3_scale(way, 1 / fmax(length, 1e-300))};
  }
  height highest = {-INFINITY, {0, 0, 0}};
  for (int a = 0; a < 3; a++)
    for (int side = -1; side <= 1; side += 2) {
      double over = side < 0 ? cut->min[a] - vec3_component(p, a) : vec3_component(p, a) - cut->max[a];
      vec3 rise = {a == 0 ? side : 0, a == 1 ? side : 0, a == 2 ? side : 0};
      if (over > highest.over) highest = (height){over, rise};
    }
  return highest;
}

bool hl_reference_left(const reference_volume *volume, vec3 point) {
  const hl_scene_volume *described = volume->described;
  for (size_t i = 0; i < described->cut_count; i++) {
    vec3 p = affine3_apply(world_of(volume, &described->cuts[i]), point);
    bool inside = height_over(&described->cuts[i], p).over < 0;
    if (inside != (described->cuts[i].keep == HL_CUT_KEEP_INSIDE)) return false;
  }
  return true;
}

bool hl_reference_mesh_left(const hl_scene_description *scene, const hl_scene_mesh *mesh, vec3 point) {
  for (size_t i = 0; mesh->cut && i < scene->cut_count; i++) {
    bool inside = height_over(&scene->cuts[i], point).over < 0;
    if (inside != (scene->cuts[i].keep == HL_CUT_KEEP_INSIDE)) return false;
  }
  return true;
}

/* Returns the distance `crossing` if it lies between the distances `after` and `next`; otherwise returns
 * `next`. */
static double sooner(double crossing, double after, double next) {
  return crossing > after && crossing < next ? crossing : next;
}

static double next_of_cut(const hl_cut *cut, vec3 o, vec3 d, double after) {
  double next = INFINITY;
  if (cut->type == HL_CUT_PLANE) {
    vec3 normal = vec3_of(cut->normal);
    double speed = vec3_dot(normal, d);
    return speed == 0 ? next
                      : sooner(vec3_dot(normal, vec3_subtract(vec3_of(cut->point), o)) / speed, after, next);
  }
  if (cut->type == HL_CUT_SPHERE) { /* the ray's parameter t at the sphere is a root of a t^2 + 2 b t + c */
    vec3 from = vec3_subtract(o, vec3_of(cut->center));
    double a = vec3_dot(d, d), b = vec3_dot(from, d), c = vec3_dot(from, from) - cut->radius * cut->radius;
    if (!(b * b > a * c)) return next;
    double root = sqrt(b * b - a * c);
    return sooner((-b - root) / a, after, sooner((root - b) / a, after, next));
  }
  for (int a = 0; a < 3; a++)
    for (int side = 0; side < 2 && vec3_component(d, a) != 0; side++)
      next = sooner(((side ? cut->max[a] : cut->min[a]) - vec3_component(o, a)) / vec3_component(d, a), after,
                    next);
  return next;
}

double hl_reference_next_face(const reference_volume *volume, vec3 origin, vec3 direction, double after) {
  const hl_scene_volume *described = volume->described;
  double next = INFINITY;
  for (size_t i = 0; i < described->cut_count; i++) {
    affine3 world = world_of(volume, &described->cuts[i]);
    vec3 o = affine3_apply(world, origin), d = mat3_apply(world.linear, direction);
    next = fmin(next, next_of_cut(&described->cuts[i], o, d, after));
  }
  return next;
}

/* The normal, in the world, of a cut's face. Among several cuts, the cut whose face is nearest to the point
 * counts. Derived: if M maps index space to the world, a height h rises by |(M^-1)^T grad h| per world unit.
 */
vec3 hl_reference_cut_normal(const reference_volume *volume, vec3 point) {
  const hl_scene_volume *described = volume->described;
  vec3 face = {0, 0, 0};
  double least = INFINITY;
  for (size_t i = 0; i < described->cut_count; i++) {
    affine3 world = world_of(volume, &described->cuts[i]);
    height here = height_over(&described->cuts[i], affine3_apply(world, point));
    vec3 rise = mat3_apply(volume->gradient_to_world, mat3_apply(mat3_transpose(world.linear), here.rise));
    const double outwards = described->cuts[i].keep == HL_CUT_KEEP_INSIDE ? 1 : -1;
    const double distance = fabs(here.over) / vec3_length(rise);
    if (distance < least) least = distance, face = vec3_scale(vec3_normalise(rise), outwards);
  }
  return face;
}

/* Finds the distance along a ray from a point that no cut removes to the place where matter removed by a cut
 * begins. The function tests the point behind each face that hl_reference_next_face() finds, because
 * hl_reference_next_face() treats the faces of a box as endless planes, behind which matter may go on.
 * direction: in index coordinates, but of unit length in the world. */
static double way_to_removed(const reference_volume *volume, vec3 point, vec3 direction) {
  const double beyond = 1e-4 * volume->smallest_edge;
  double way = 0;
  do way = hl_reference_next_face(volume, point, direction, way);
  while (isfinite(way) && hl_reference_left(volume, vec3_add(point, vec3_scale(direction, way + beyond))));
  return way;
}

/* The face of a cut or of the box through which a ray leaves a volume's matter. */
typedef struct left_face {
  vec3 outward;  /* outward normal of the face; a unit vector of the world */
  vec3 crossing; /* the point where the ray crosses the face; index space */
  double skin;   /* the fraction of the matter at the ray's beginning that belongs to the face: 1 up to one
                  * voxel behind the face, falling to 0 at two voxels behind the face */
} left_face;

static left_face find_left_face(const reference_volume *volume, vec3 point, vec3 direction, bool uncut) {
  static const double FACE_VOXELS = 2; /* matter deeper than this behind a face, in voxels, is lit as if the
                                        * face did not exist */
  const vec3 along = mat3_apply(volume->world_to_index.linear, direction);
  left_face face = {.skin = 0};
  double way = hl_reference_leaves_box(volume, point, along, &face.outward);
  const double cut = uncut ? INFINITY : way_to_removed(volume, point, along);
  if (cut < fabs(way)) {
    way = cut;
    face.outward = hl_reference_cut_normal(volume, vec3_add(point, vec3_scale(along, way)));
  }
  const double depth = way * vec3_dot(face.outward, direction) / volume->smallest_edge;
  if (!(way >= 0) || !(depth < FACE_VOXELS)) return face;
  face.crossing = vec3_add(point, vec3_scale(along, way));
  face.skin = fmin(FACE_VOXELS - depth, 1);
  return face;
}

double hl_reference_lit_face(const reference_volume *volume, vec3 point, vec3 to_light, bool uncut) {
  if (volume->described->cut_shading != HL_CUT_SHADING_FACE) return 0;
  return find_left_face(volume, point, to_light, uncut).skin;
}

/* A point is seen through the face that the ray from the point to the eye crosses first. The face counts only
 * if matter is visible at the place where the ray crosses the face. */
double hl_reference_cut_face(const reference_volume *volume, vec3 point, vec3 to_eye, vec3 *normal,
                             double *surface) {
  const hl_scene_volume *described = volume->described;
  if (described->cut_shading == HL_CUT_SHADING_GRADIENT) return 0;
  const left_face left = find_left_face(volume, point, to_eye, false);
  const vec3 face = left.outward, crossing = left.crossing;
  const double skin = left.skin;
  if (!(skin > 0)) return 0;
  if (!(hl_reference_extinction(volume, hl_reference_value(volume, crossing), crossing) > 0)) return 0;
  if (described->cut_shading == HL_CUT_SHADING_FACE) {
    vec3 sum = vec3_add(vec3_scale(face, skin), vec3_scale(*normal, *surface * (1 - skin)));
    *normal = vec3_length(sum) > 0 ? vec3_normalise(sum) : sum;
    *surface += skin * (1 - *surface);
  } else {
    *surface *= 1 - skin;
  }
  return skin;
}
