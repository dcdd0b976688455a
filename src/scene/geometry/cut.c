/* scene/geometry/cut.c - see cut.h. */
#include "scene/geometry/cut.h"

#include "core/memory.h"
#include "scene/geometry/placement.h"
#include "volume/volume.h"

static affine3 plane_space(const hl_cut *cut) {
  vec3 normal = vec3_normalise(vec3_of(cut->normal));
  return (affine3){.linear = {.row = {normal}}, .offset = {-vec3_dot(normal, vec3_of(cut->point)), 0, 0}};
}

/* Makes the map from a space to another space, in which the box with the given middle and half size goes from
 * -1 to 1 along each axis. */
static affine3 box_space(vec3 middle, vec3 half) {
  vec3 s = {1 / half.x, 1 / half.y, 1 / half.z};
  return (affine3){.linear = {.row = {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}},
                   .offset = {-middle.x * s.x, -middle.y * s.y, -middle.z * s.z}};
}

cut_shape hl_cut_shape_in_world(const hl_cut *of) {
  vec3 low = vec3_of(of->min), high = vec3_of(of->max), radii = {of->radius, of->radius, of->radius};
  affine3 space = of->type == HL_CUT_PLANE ? plane_space(of)
                  : of->type == HL_CUT_BOX ? box_space(vec3_scale(vec3_add(low, high), 0.5),
                                                       vec3_scale(vec3_subtract(high, low), 0.5))
                                           : box_space(vec3_of(of->center), radii);
  return (cut_shape){.type = of->type, .keep_inside = of->keep == HL_CUT_KEEP_INSIDE, .to_shape = space};
}

cut_shape hl_cut_shape(const hl_scene_volume *volume, size_t cut) {
  const hl_cut *of = &volume->cuts[cut];
  cut_shape shape = hl_cut_shape_in_world(of);
  shape.to_shape = affine3_multiply(
      shape.to_shape, of->world ? hl_scene_volume_index_to_world(volume) : volume->volume->index_to_world);
  return shape;
}

hl_status hl_cut_shapes(hl_context *context, const hl_scene_volume *volume, cut_shape **shapes,
                        hl_error *error) {
  *shapes = NULL;
  if (volume->cut_count == 0) return HL_OK;
  *shapes = hl_allocate(context, volume->cut_count, sizeof **shapes);
  if (*shapes == NULL) return hl_fail_memory(error, volume->cut_count * sizeof **shapes, "cuts");
  for (size_t i = 0; i < volume->cut_count; i++) (*shapes)[i] = hl_cut_shape(volume, i);
  return HL_OK;
}

static bool same_vector(vec3 a, vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

bool hl_cut_same(const cut_shape *a, const cut_shape *b) {
  for (int r = 0; r < 3; r++)
    if (!same_vector(a->to_shape.linear.row[r], b->to_shape.linear.row[r])) return false;
  return a->type == b->type && a->keep_inside == b->keep_inside &&
         same_vector(a->to_shape.offset, b->to_shape.offset);
}

void hl_cuts_key_add(hl_key *key, const cut_shape *cuts, size_t count) {
  for (size_t i = 0; i < count; i++) {
    hl_key_add_whole(key, 2 * (int64_t)cuts[i].type + cuts[i].keep_inside);
    hl_key_add_affine(key, &cuts[i].to_shape);
  }
}

static bool is_inside(const cut_shape *cut, vec3 point) {
  vec3 q = affine3_apply(cut->to_shape, point);
  if (cut->type == HL_CUT_PLANE) return q.x > 0;
  if (cut->type == HL_CUT_SPHERE) return vec3_dot(q, q) < 1;
  return fabs(q.x) < 1 && fabs(q.y) < 1 && fabs(q.z) < 1;
}

bool hl_cuts_leave(const cut_shape *cuts, size_t count, vec3 point) {
  for (size_t i = 0; i < count; i++)
    if (is_inside(&cuts[i], point) != cuts[i].keep_inside) return false;
  return true;
}

/* A region, as a box in a shape's own space, that is tested against the shape: its middle, and half of its
 * length along each axis. */
typedef struct extent {
  double middle[3], half[3];
} extent;

static extent extent_in_shape(const cut_shape *cut, const double low[3], const double high[3]) {
  vec3 middle = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
  vec3 half = {(high[0] - low[0]) / 2, (high[1] - low[1]) / 2, (high[2] - low[2]) / 2};
  vec3 q = affine3_apply(cut->to_shape, middle);
  extent e = {.middle = {q.x, q.y, q.z}};
  for (int r = 0; r < 3; r++) {
    vec3 row = cut->to_shape.linear.row[r];
    e.half[r] = fabs(row.x) * half.x + fabs(row.y) * half.y + fabs(row.z) * half.z;
  }
  return e;
}

static bool is_all_inside(const cut_shape *cut, const extent *e) {
  if (cut->type == HL_CUT_PLANE) return e->middle[0] - e->half[0] > 0;
  double farthest = 0, squared = 0;
  for (int r = 0; r < 3; r++) {
    double far = fabs(e->middle[r]) + e->half[r];
    farthest = fmax(farthest, far);
    squared += far * far;
  }
  return (cut->type == HL_CUT_BOX ? farthest : squared) < 1;
}

static bool is_all_outside(const cut_shape *cut, const extent *e) {
  if (cut->type == HL_CUT_PLANE) return e->middle[0] + e->half[0] < 0;
  double farthest = 0, squared = 0;
  for (int r = 0; r < 3; r++) {
    double near = fmax(fabs(e->middle[r]) - e->half[r], 0);
    farthest = fmax(farthest, near);
    squared += near * near;
  }
  return (cut->type == HL_CUT_BOX ? farthest : squared) > 1;
}

bool hl_cuts_remove_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]) {
  for (size_t i = 0; i < count; i++) {
    extent e = extent_in_shape(&cuts[i], low, high);
    if (cuts[i].keep_inside ? is_all_outside(&cuts[i], &e) : is_all_inside(&cuts[i], &e)) return true;
  }
  return false;
}

bool hl_cuts_leave_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]) {
  for (size_t i = 0; i < count; i++) {
    extent e = extent_in_shape(&cuts[i], low, high);
    if (cuts[i].keep_inside ? !is_all_inside(&cuts[i], &e) : !is_all_outside(&cuts[i], &e)) return false;
  }
  return true;
}

void hl_add_scene_cuts(const hl_scene_description *scene, hl_scene_volume *volume, hl_cut *cuts) {
  for (size_t i = 0; i < volume->cut_count; i++) cuts[i] = volume->cuts[i];
  for (size_t i = 0; i < scene->cut_count; i++) {
    cuts[volume->cut_count + i] = scene->cuts[i];
    cuts[volume->cut_count + i].world = 1;
  }
  volume->cuts = cuts;
  volume->cut_count += scene->cut_count;
}

hl_status hl_cuts_place(hl_context *context, hl_scene_description *placed, placed_cuts *made,
                        hl_error *error) {
  size_t count = 0;
  if (placed->cut_count == 0 || placed->volume_count == 0) return HL_OK;
  for (size_t v = 0; v < placed->volume_count; v++) count += placed->volumes[v].cut_count + placed->cut_count;
  made->volumes = hl_allocate(context, placed->volume_count, sizeof *made->volumes);
  made->cuts = hl_allocate(context, count, sizeof *made->cuts);
  if (made->volumes == NULL || made->cuts == NULL)
    return hl_fail_memory(error, count * sizeof(hl_cut), "cuts");
  hl_cut *next = made->cuts;
  for (size_t v = 0; v < placed->volume_count; v++) {
    made->volumes[v] = placed->volumes[v];
    hl_add_scene_cuts(placed, &made->volumes[v], next);
    next += made->volumes[v].cut_count;
  }
  placed->volumes = made->volumes;
  return HL_OK;
}

void hl_placed_cuts_release(hl_context *context, placed_cuts *made) {
  hl_release(context, made->volumes);
  hl_release(context, made->cuts);
}
