/* shape/place.c - places shapes: finds their frames, the box around them, and the grid that holds them. */
#include <math.h>

#include "elementary/elementary.h"
#include "shape/shape.h"

void hl_shape_defaults(hl_shape *shape) {
  *shape = (hl_shape){.rotate_axis = {0, 0, 1},
                      .scale = 1,
                      .size = {1, 1, 1},
                      .to = {0, 0, 1},
                      .radius = 1,
                      .tube_radius = 0.25,
                      .quantum = {2, 1, 0},
                      .texture = {.frequency = 1, .octaves = 1, .bias = 0.5, .gain = 0.5, .amplitude = 1}};
}

/* The rotation of a shape's frame. It is the rotation of mat3_rotation(), but with a sine and a cosine that
 * are the same on every machine. */
static mat3 rotation(const hl_shape *shape) {
  vec3 a = vec3_normalise(vec3_of(shape->rotate_axis));
  double s, c;
  hl_sine_cosine(shape->rotate_angle_deg, &s, &c);
  double t = 1 - c;
  return (mat3){{{t * a.x * a.x + c, t * a.x * a.y - s * a.z, t * a.x * a.z + s * a.y},
                 {t * a.x * a.y + s * a.z, t * a.y * a.y + c, t * a.y * a.z - s * a.x},
                 {t * a.x * a.z - s * a.y, t * a.y * a.z + s * a.x, t * a.z * a.z + c}}};
}

static mat3 transpose(mat3 m) { return mat3_from_columns(m.row[0], m.row[1], m.row[2]); }

/* Finds the frames of the shapes with the numbers in [first, end). parent_scale: the length of a unit of the
 * parent's frame, in units of the volume. */
static void place(hl_shape_list *list, size_t first, size_t end, double parent_scale, double voxel_size) {
  for (size_t index = first; index < end; index = list->shapes[index].end) {
    hl_shape *shape = &list->shapes[index];
    double scale = parent_scale * shape->scale;
    mat3 back = transpose(rotation(shape));
    for (int row = 0; row < 3; row++) back.row[row] = vec3_scale(back.row[row], 1 / shape->scale);
    shape->to_local = (affine3){back, vec3_scale(mat3_apply(back, vec3_of(shape->position)), -1)};
    shape->edge = HL_SHAPE_EDGE * voxel_size / scale;
    if (shape->type == HL_SHAPE_GROUP) place(list, index + 1, shape->end, scale, voxel_size);
  }
}

void hl_shapes_place(hl_shape_list *list, double voxel_size) { place(list, 0, list->count, 1, voxel_size); }

/* The distance from a disk's middle to the disk's farthest point in the direction u. The disk has a given
 * radius, and is perpendicular to the unit vector `axis`. */
static double disk_reach(double radius, vec3 axis, vec3 u) {
  double along = vec3_dot(axis, u), square = vec3_dot(u, u) - along * along;
  return radius * sqrt(square > 0 ? square : 0);
}

static double solid_reach(const hl_shape *shape, vec3 u) {
  const double *size = shape->size;
  vec3 from = vec3_of(shape->from), to = vec3_of(shape->to), axis = vec3_normalise(vec3_subtract(to, from));
  double box = fabs(u.x) * size[0] / 2 + fabs(u.y) * size[1] / 2 + fabs(u.z) * size[2] / 2,
         length = vec3_length(u);
  switch (shape->type) {
    case HL_SHAPE_BOX: return box;
    case HL_SHAPE_PLANE: return box - u.z * size[2] / 2;
    case HL_SHAPE_SPHERE:
    case HL_SHAPE_ORBITAL: return shape->radius * length;
    case HL_SHAPE_CYLINDER:
      return fmax(vec3_dot(from, u), vec3_dot(to, u)) + disk_reach(shape->radius, axis, u);
    case HL_SHAPE_CAPSULE: return fmax(vec3_dot(from, u), vec3_dot(to, u)) + shape->radius * length;
    case HL_SHAPE_CONE:
      return fmax(vec3_dot(from, u) + disk_reach(shape->radius, axis, u),
                  vec3_dot(to, u) + disk_reach(shape->end_radius, axis, u));
    case HL_SHAPE_TORUS: return disk_reach(shape->radius, (vec3){0, 0, 1}, u) + shape->tube_radius * length;
    case HL_SHAPE_GROUP: break;
  }
  return -INFINITY;
}

/* The support function of the shapes with the numbers in [first, end): the greatest u.x over all their points
 * x. u: a direction in the list's frame. */
static double reach(const hl_shape_list *list, size_t first, size_t end, vec3 u) {
  double farthest = -INFINITY;
  for (size_t index = first; index < end; index = list->shapes[index].end) {
    const hl_shape *shape = &list->shapes[index];
    if (shape->operation == HL_SHAPE_SUBTRACT) continue;
    /* the greatest u.x over the points x of the shape: u.(scale R x + position) = (scale R^T u).x +
     * u.position, and to_local holds R^T / scale */
    vec3 local = vec3_scale(mat3_apply(shape->to_local.linear, u), shape->scale * shape->scale);
    double own = shape->type == HL_SHAPE_GROUP ? reach(list, index + 1, shape->end, local)
                                               : solid_reach(shape, local);
    double growth = shape->blend / (4 * shape->scale); /* a rounded joint and a texture may extend the shape
                                                        * by this length */
    if (shape->texture.pattern != HL_PATTERN_NONE)
      growth += shape->texture.soft / 2 + fmax(-shape->texture.amplitude, 0);
    own += growth * vec3_length(local) + vec3_dot(u, vec3_of(shape->position));
    farthest = shape->operation == HL_SHAPE_INTERSECT ? fmin(farthest, own) : fmax(farthest, own);
  }
  return farthest;
}

/* The box around all shapes of a list: box[axis] = {low, high}. */
static void bounding_box(const hl_shape_list *list, double box[3][2]) {
  for (int axis = 0; axis < 3; axis++) {
    vec3 u = {axis == 0, axis == 1, axis == 2};
    box[axis][1] = reach(list, 0, list->count, u);
    box[axis][0] = -reach(list, 0, list->count, vec3_scale(u, -1));
  }
}

double hl_shapes_extent(const hl_shape_list *list) {
  double box[3][2], longest = 0;
  bounding_box(list, box);
  for (int axis = 0; axis < 3; axis++) {
    if (!(box[axis][1] > box[axis][0])) return 0;
    longest = fmax(longest, box[axis][1] - box[axis][0]);
  }
  return longest;
}

bool hl_shapes_grid(const hl_shape_list *list, double voxel_size, hl_shape_grid *grid) {
  double box[3][2], margin = HL_SHAPE_EDGE / 2 + HL_SHAPE_MARGIN, total = 1;
  bounding_box(list, box);
  grid->voxel_size = voxel_size;
  for (int axis = 0; axis < 3; axis++) {
    double low = floor(box[axis][0] / voxel_size - margin), high = ceil(box[axis][1] / voxel_size + margin);
    double count = high >= low ? high - low + 1 : 1;
    total *= count;
    if (!(fabs(low) < 1e12 && total <= (double)HL_SHAPE_VOXELS)) return false;
    grid->first[axis] = (int64_t)low;
    grid->dimension[axis] = (size_t)count;
  }
  return true;
}
