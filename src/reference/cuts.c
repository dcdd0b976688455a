/* reference/cuts.c - what cuts leave of a volume or a mesh, asked in the world that the cut is given in: that
 * of the volume's file, or the scene's.
 *
 * Each cut has a height over its face, in that world's units: above 0 outside of its shape. */
#include "reference/reference.h"

typedef struct height {
  double over; /* the face */
  vec3 rise;   /* its gradient, a unit vector of the file's world */
} height;

/* Index space to the world that a cut is given in. */
static affine3 world_of(const reference_volume *volume, const hl_cut *cut) {
  return cut->world ? volume->index_to_world : volume->grid->index_to_world;
}

static double part_of(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

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
      double over = side < 0 ? cut->min[a] - part_of(p, a) : part_of(p, a) - cut->max[a];
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

/* The lesser of `next` and a crossing, where that comes after `after`. */
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
  if (cut->type == HL_CUT_SPHERE) { /* the roots of a t^2 + 2 b t + c */
    vec3 from = vec3_subtract(o, vec3_of(cut->center));
    double a = vec3_dot(d, d), b = vec3_dot(from, d), c = vec3_dot(from, from) - cut->radius * cut->radius;
    if (!(b * b > a * c)) return next;
    double root = sqrt(b * b - a * c);
    return sooner((-b - root) / a, after, sooner((root - b) / a, after, next));
  }
  for (int a = 0; a < 3; a++)
    for (int side = 0; side < 2 && part_of(d, a) != 0; side++)
      next = sooner(((side ? cut->max[a] : cut->min[a]) - part_of(o, a)) / part_of(d, a), after, next);
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

/* Distances and directions in the world: heights h rise there by |(M^-1)^T grad h|, M the placement. */
double hl_reference_cut_face(const reference_volume *volume, vec3 point, vec3 to_eye, vec3 *normal,
                             double *surface) {
  const hl_scene_volume *described = volume->described;
  vec3 face = {0, 0, 0};
  double least = hl_reference_nearest_clip(volume, point, to_eye, &face);
  if (described->cut_shading == HL_CUT_SHADING_GRADIENT) return 0;
  for (size_t i = 0; i < described->cut_count; i++) {
    affine3 world = world_of(volume, &described->cuts[i]);
    height here = height_over(&described->cuts[i], affine3_apply(world, point));
    vec3 rise = mat3_apply(volume->gradient_to_world, mat3_apply(mat3_transpose(world.linear), here.rise));
    double inwards = described->cuts[i].keep == HL_CUT_KEEP_INSIDE ? -1 : 1;
    double depth = fmax(inwards * here.over / vec3_length(rise), 0);
    if (depth < least) least = depth, face = vec3_scale(vec3_normalise(rise), -inwards);
  }
  double skin = fmin(fmax(2 - least / volume->smallest_edge, 0), 1);
  if (described->cut_shading == HL_CUT_SHADING_FACE) skin *= fmin(fmax(10 * vec3_dot(face, to_eye), 0), 1);
  if (skin == 0) return 0;
  if (described->cut_shading == HL_CUT_SHADING_FACE) {
    vec3 sum = vec3_add(vec3_scale(face, skin), vec3_scale(*normal, *surface * (1 - skin)));
    *normal = vec3_length(sum) > 0 ? vec3_normalise(sum) : sum;
    *surface += skin * (1 - *surface);
  } else {
    *surface *= 1 - skin;
  }
  return skin;
}
