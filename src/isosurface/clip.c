/* isosurface/clip.c - see clip.h. */
#include "isosurface/clip.h"

#include <string.h>

#include "core/memory.h"

/* The state of one cut at one face. The kept side is the half space of the points p with normal . p + offset
 * >= 0, or the inside of a sphere, |q|^2 <= 1 in the sphere's own coordinates q. Each triangle gets vertices
 * of its own on the edges that are cut, because the mesh is open along the cut anyway. */
typedef struct cutting {
  hl_context *context;
  iso_triangles *made;
  double normal[3], offset;
  const affine3 *sphere; /* maps index space to the coordinates q of a sphere; if null, the kept side is a
                          * half space */
  bool both;             /* whether the triangles on both sides of the face are kept, cut apart from each
                          * other */
} cutting;

static vec3 position_of(const cutting *cut, uint32_t vertex) {
  const float *p = cut->made->positions[vertex];
  return (vec3){p[0], p[1], p[2]};
}

static double height(const cutting *cut, uint32_t vertex) {
  vec3 p = position_of(cut, vertex);
  if (cut->sphere == NULL) return vec3_dot(vec3_of(cut->normal), p) + cut->offset;
  vec3 q = affine3_apply(*cut->sphere, p);
  return 1 - vec3_dot(q, q);
}

/* The place at which the edge from vertex a to vertex b crosses a sphere, as a fraction of the edge. It is
 * the root t between 0 and 1 of |q + t d|^2 = 1, where q is the edge's beginning and d its direction in the
 * sphere's coordinates. */
static double crossing_of_sphere(const cutting *cut, uint32_t a, uint32_t b) {
  vec3 q = affine3_apply(*cut->sphere, position_of(cut, a));
  vec3 d = vec3_subtract(affine3_apply(*cut->sphere, position_of(cut, b)), q);
  double squared = vec3_dot(d, d), along = vec3_dot(q, d), rest = vec3_dot(q, q) - 1;
  double root = sqrt(fmax(along * along - squared * rest, 0));
  double t = (rest > 0 ? -along - root : root - along) / squared;
  return fmin(fmax(t, 0), 1);
}

/* Adds the vertex where the edge from vertex a to vertex b crosses the face. The two triangles that share the
 * edge add vertices at the same position. */
static uint32_t cross_edge(cutting *cut, uint32_t a, uint32_t b) {
  if (a > b) {
    uint32_t kept = a;
    a = b, b = kept;
  }
  iso_triangles *made = cut->made;
  double from = height(cut, a), t = from / (from - height(cut, b));
  if (cut->sphere != NULL) t = crossing_of_sphere(cut, a, b);
  uint32_t vertex = (uint32_t)made->vertex_count++;
  for (int axis = 0; axis < 3; axis++) {
    const double p = made->positions[a][axis], n = made->normals[a][axis];
    made->positions[vertex][axis] = (float)(p + t * (made->positions[b][axis] - p));
    made->normals[vertex][axis] = (float)(n + t * (made->normals[b][axis] - n));
  }
  return vertex;
}

/* Cuts a triangle, and writes its parts on one side to *to. */
static void cut_triangle(cutting *cut, const uint32_t corner[3], bool above, uint32_t (*triangles)[3],
                         size_t *to) {
  uint32_t kept[4];
  int count = 0;
  for (int i = 0; i < 3; i++) {
    uint32_t a = corner[i], b = corner[(i + 1) % 3];
    bool here = (height(cut, a) >= 0) == above, next = (height(cut, b) >= 0) == above;
    if (here) kept[count++] = a;
    if (here != next) kept[count++] = cross_edge(cut, a, b);
  }
  for (int i = 1; i + 1 < count; i++, ++*to) {
    triangles[*to][0] = kept[0], triangles[*to][1] = kept[i], triangles[*to][2] = kept[i + 1];
  }
}

static int corners_above(const cutting *cut, const uint32_t corner[3]) {
  return (height(cut, corner[0]) >= 0) + (height(cut, corner[1]) >= 0) + (height(cut, corner[2]) >= 0);
}

static size_t count_cut(const cutting *cut) {
  size_t count = 0;
  for (size_t t = 0; t < cut->made->triangle_count; t++) {
    int above = corners_above(cut, cut->made->triangles[t]);
    count += above > 0 && above < 3;
  }
  return count;
}

/* Makes room for the results of a cut. Each triangle that is cut adds at most one triangle and two vertices.
 * If both sides are kept, it adds at most two triangles and four vertices. */
static hl_status make_room(cutting *cut, size_t more, uint32_t (**triangles)[3], hl_error *error) {
  iso_triangles *made = cut->made;
  void *positions = hl_reallocate(cut->context, made->positions, made->vertex_count + 4 * more,
                                  sizeof *made->positions);
  if (positions != NULL) made->positions = positions;
  void *normals = hl_reallocate(cut->context, made->normals, made->vertex_count + 4 * more,
                                sizeof *made->normals);
  if (normals != NULL) made->normals = normals;
  *triangles = hl_allocate(cut->context, made->triangle_count + 2 * more, sizeof **triangles);
  if (positions != NULL && normals != NULL && *triangles != NULL) return HL_OK;
  hl_release(cut->context, *triangles);
  return hl_fail_memory(error, (made->triangle_count + 2 * more) * sizeof **triangles, "an isosurface");
}

static hl_status cut_all(cutting *cut, hl_error *error) {
  iso_triangles *made = cut->made;
  uint32_t(*triangles)[3];
  size_t count = 0;
  hl_status status = make_room(cut, count_cut(cut), &triangles, error);
  if (status != HL_OK) return status;
  for (size_t t = 0; t < made->triangle_count; t++) {
    int above = corners_above(cut, made->triangles[t]);
    if (above == 3 || (above == 0 && cut->both)) {
      memcpy(triangles[count++], made->triangles[t], sizeof *triangles);
      continue;
    }
    cut_triangle(cut, made->triangles[t], true, triangles, &count);
    if (cut->both && above > 0) cut_triangle(cut, made->triangles[t], false, triangles, &count);
  }
  hl_release(cut->context, made->triangles);
  made->triangles = triangles;
  made->triangle_count = count;
  return HL_OK;
}

/* Returns whether some vertex lies on the side of a face that is not kept. */
static bool cuts(const cutting *cut) {
  for (size_t v = 0; v < cut->made->vertex_count; v++)
    if (height(cut, (uint32_t)v) < 0) return true;
  return false;
}

hl_status hl_iso_clip_box(hl_context *context, iso_triangles *triangles, const double low[3],
                          const double high[3], hl_error *error) {
  hl_status status = HL_OK;
  for (int face = 0; face < 6 && status == HL_OK; face++) {
    int axis = face / 2;
    cutting cut = {.context = context, .made = triangles};
    cut.normal[axis] = face % 2 ? -1 : 1;
    cut.offset = face % 2 ? high[axis] : -low[axis];
    if (cuts(&cut)) status = cut_all(&cut, error);
  }
  return status;
}

/* ---- cuts: the triangles are cut apart at all faces of a shape, and those on its wrong side removed ---- */

static int faces_of(const cut_shape *shape) { return shape->type == HL_CUT_BOX ? 6 : 1; }

/* The cut at one face of a shape. The face of a plane is where x is 0; the faces of a box are where x, y or z
 * is -1 or 1. */
static cutting face_of(const cut_shape *shape, int face) {
  double sign = face % 2 ? -1 : 1, edge = shape->type == HL_CUT_BOX ? 1 : 0;
  const double *offset = &shape->to_shape.offset.x;
  vec3 row = shape->to_shape.linear.row[face / 2];
  cutting cut = {.offset = sign * offset[face / 2] + edge, .both = true};
  cut.normal[0] = sign * row.x, cut.normal[1] = sign * row.y, cut.normal[2] = sign * row.z;
  if (shape->type == HL_CUT_SPHERE) cut.sphere = &shape->to_shape;
  return cut;
}

static vec3 middle_of(const iso_triangles *made, const uint32_t corner[3]) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    const float *p = made->positions[corner[i]];
    sum = vec3_add(sum, (vec3){p[0], p[1], p[2]});
  }
  return vec3_scale(sum, 1.0 / 3);
}

static void remove_triangles(iso_triangles *made, const cut_shape *shape) {
  size_t count = 0;
  for (size_t t = 0; t < made->triangle_count; t++)
    if (hl_cuts_leave(shape, 1, middle_of(made, made->triangles[t])))
      memmove(made->triangles[count++], made->triangles[t], sizeof *made->triangles);
  made->triangle_count = count;
}

hl_status hl_iso_cut(hl_context *context, iso_triangles *triangles, const cut_shape *shapes, size_t count,
                     hl_error *error) {
  hl_status status = HL_OK;
  for (size_t i = 0; i < count && status == HL_OK; i++) {
    for (int face = 0; face < faces_of(&shapes[i]) && status == HL_OK; face++) {
      cutting cut = face_of(&shapes[i], face);
      cut.context = context;
      cut.made = triangles;
      status = cut_all(&cut, error);
    }
    remove_triangles(triangles, &shapes[i]);
  }
  return status;
}
