/* isosurface/caps.c - makes the caps of an isosurface (caps.h). Each face is covered with triangles that are
 * a voxel wide. The triangles are then cut along the line on which the field has the surface's value, and
 * afterwards at the other faces and at the box. */
#include "isosurface/caps.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "grid/relevant.h"
#include "isosurface/clip.h"

/* The distance, in voxels, by which caps extend beyond the inside of the surface. The surface and the cap are
 * made of different triangles. Their edges lie apart by less than this distance, so no gap shows between
 * them. */
static const double OVERLAP = 0.03;

/* A face of the box or of a cut, described in a space of its own with coordinates q. On the face q[axis] is
 * `height`, and the other two coordinates run from -1 to 1. For a sphere this is a face of a cube, whose
 * points are then scaled to the length 1. */
typedef struct cap_face {
  affine3 to_index, from_index;
  int axis;
  double height;
  double outward; /* 1: the face's normal points to greater q[axis], or for a sphere away from its centre; -1:
                   * the normal points the other way */
  bool sphere;
  size_t cut; /* index of the cut in grid->cuts; cut_count stands for a face of the box */
} cap_face;

typedef struct capping {
  hl_context *context;
  const lattice *lattice;
  const cap_face *face;
  iso_triangles patch;
  double *inside;   /* owned; [vertices]; for each vertex, the difference of the field and the surface's
                     * value, with the sign that makes it positive inside; stored units */
  size_t across[2]; /* number of cells of triangles along the face's two coordinates */
} capping;

/* ---- a face's triangles ---- */

static vec3 unit_of_axis(int axis, double length) {
  return (vec3){axis == 0 ? length : 0, axis == 1 ? length : 0, axis == 2 ? length : 0};
}

static vec3 point_on_face(const cap_face *face, double s, double t) {
  vec3 q = vec3_add(unit_of_axis(face->axis, face->height),
                    vec3_add(unit_of_axis((face->axis + 1) % 3, s), unit_of_axis((face->axis + 2) % 3, t)));
  if (face->sphere) q = vec3_normalise(q);
  return affine3_apply(face->to_index, q);
}

/* The outward unit normal of a face in index coordinates. With q = from_index(point), the normal has the
 * direction of the gradient of q[axis], or, for a sphere, of |q|. */
static vec3 normal_of_face(const cap_face *face, vec3 point) {
  const vec3 q = face->sphere ? affine3_apply(face->from_index, point) : unit_of_axis(face->axis, 1);
  return vec3_scale(vec3_normalise(mat3_apply(mat3_transpose(face->from_index.linear), q)), face->outward);
}

static double inside_at(const lattice *lattice, vec3 point) {
  vec3 slope;
  return (hl_field_value_and_slope(lattice->grid, lattice->kernel, point, &slope) - lattice->value) *
         lattice->sign;
}

static void set_vertex(iso_triangles *patch, const cap_face *face, size_t vertex, vec3 point) {
  vec3_store(patch->positions[vertex], point);
  vec3_store(patch->normals[vertex], normal_of_face(face, point));
}

static bool near_box(const grid *grid, vec3 point) {
  const double at[3] = {point.x, point.y, point.z};
  for (int a = 0; a < 3; a++)
    if (at[a] < grid->box_low[a] - 2 || at[a] > grid->box_high[a] + 2) return false;
  return true;
}

/* Places a row of the vertices of the triangles that cover a face. Vertices far from the box count as
 * outside. */
static void place_row(void *data, size_t row, int worker) {
  (void)worker;
  capping *cap = data;
  const size_t *across = cap->across;
  for (size_t n = 0; n <= across[0]; n++) {
    const size_t vertex = row * (across[0] + 1) + n;
    const double s = 2 * (double)n / (double)across[0] - 1, t = 2 * (double)row / (double)across[1] - 1;
    const vec3 point = point_on_face(cap->face, s, t);
    set_vertex(&cap->patch, cap->face, vertex, point);
    cap->inside[vertex] = near_box(cap->lattice->grid, point) ? inside_at(cap->lattice, point) : -1;
  }
}

/* ---- cut by the field ---- */

/* Adds a vertex between a vertex inside and a vertex outside: OVERLAP beyond the place where the field has
 * the surface's value. The place where the field has the surface's value is found by bisection. */
static uint32_t cross_field(capping *cap, uint32_t in, uint32_t out) {
  enum { STEPS = 14 };
  const float *a = cap->patch.positions[in], *b = cap->patch.positions[out];
  const vec3 from = {a[0], a[1], a[2]}, way = vec3_subtract((vec3){b[0], b[1], b[2]}, from);
  double low = 0, high = 1;
  for (int step = 0; step < STEPS; step++) {
    const double middle = (low + high) / 2;
    if (inside_at(cap->lattice, vec3_add(from, vec3_scale(way, middle))) > 0) low = middle;
    else high = middle;
  }
  const double part = fmin(high + OVERLAP / vec3_length(way), 1);
  const uint32_t vertex = (uint32_t)cap->patch.vertex_count++;
  set_vertex(&cap->patch, cap->face, vertex, vec3_add(from, vec3_scale(way, part)));
  return vertex;
}

static vec3 position_of(const iso_triangles *made, uint32_t vertex) {
  const float *p = made->positions[vertex];
  return (vec3){p[0], p[1], p[2]};
}

/* Adds a triangle, counter-clockwise as seen from outside. */
static void add_triangle(iso_triangles *patch, uint32_t a, uint32_t b, uint32_t c) {
  const vec3 p = position_of(patch, a),
             normal = vec3_of((const double[3]){(double)patch->normals[a][0], (double)patch->normals[a][1],
                                                (double)patch->normals[a][2]});
  const vec3 own = vec3_cross(vec3_subtract(position_of(patch, b), p),
                              vec3_subtract(position_of(patch, c), p));
  uint32_t *corner = patch->triangles[patch->triangle_count++];
  const bool turned = vec3_dot(own, normal) < 0;
  corner[0] = a, corner[1] = turned ? c : b, corner[2] = turned ? b : c;
}

static void add_inside(capping *cap, const uint32_t corner[3]) {
  uint32_t kept[4];
  int count = 0;
  for (int i = 0; i < 3; i++) {
    const uint32_t a = corner[i], b = corner[(i + 1) % 3];
    const bool here = cap->inside[a] > 0, next = cap->inside[b] > 0;
    if (here) kept[count++] = a;
    if (here && !next) kept[count++] = cross_field(cap, a, b);
    if (!here && next) kept[count++] = cross_field(cap, b, a);
  }
  for (int i = 1; i + 1 < count; i++) add_triangle(&cap->patch, kept[0], kept[i], kept[i + 1]);
}

/* Visits the two triangles of every cell of a face. If `add` is set, adds the parts of triangles that lie
 * inside the surface. Returns the number of triangles that the surface cuts. */
static size_t visit_cells(capping *cap, bool add) {
  size_t crossed = 0;
  const size_t row = cap->across[0] + 1;
  for (size_t j = 0; j < cap->across[1]; j++)
    for (size_t i = 0; i < cap->across[0]; i++) {
      const uint32_t at = (uint32_t)(j * row + i), right = at + 1, below = (uint32_t)(at + row);
      const uint32_t corners[2][3] = {{at, right, below}, {right, below + 1, below}};
      for (int t = 0; t < 2; t++) {
        int count = 0;
        for (int c = 0; c < 3; c++) count += cap->inside[corners[t][c]] > 0;
        if (count == 0) continue;
        crossed += count < 3;
        if (add) add_inside(cap, corners[t]);
      }
    }
  return crossed;
}

static hl_status fail_cap(size_t vertices, hl_error *error) {
  return hl_fail_memory(error, vertices * 2 * sizeof(float[3]), "the faces of an isosurface");
}

/* Covers a face with triangles, and cuts them where the field has the surface's value. */
static hl_status make_patch(hl_pool *pool, capping *cap, hl_error *error) {
  iso_triangles *patch = &cap->patch;
  const size_t cells = cap->across[0] * cap->across[1];
  size_t vertices = (cap->across[0] + 1) * (cap->across[1] + 1);
  patch->positions = hl_allocate(cap->context, vertices, sizeof *patch->positions);
  patch->normals = hl_allocate(cap->context, vertices, sizeof *patch->normals);
  cap->inside = hl_allocate(cap->context, vertices, sizeof *cap->inside);
  if (patch->positions == NULL || patch->normals == NULL || cap->inside == NULL)
    return fail_cap(vertices, error);
  patch->vertex_count = vertices;
  hl_status status = hl_lattice_run(pool, cap->across[1] + 1, place_row, cap, error);
  if (status != HL_OK) return status;
  /* each of these triangles may add two vertices and a triangle */
  const size_t crossed = visit_cells(cap, false);
  vertices += 2 * crossed;
  void *positions = hl_reallocate(cap->context, patch->positions, vertices, sizeof *patch->positions);
  if (positions != NULL) patch->positions = positions;
  void *normals = hl_reallocate(cap->context, patch->normals, vertices, sizeof *patch->normals);
  if (normals != NULL) patch->normals = normals;
  patch->triangles = hl_allocate(cap->context, 2 * cells + crossed, sizeof *patch->triangles);
  if (positions == NULL || normals == NULL || patch->triangles == NULL) return fail_cap(vertices, error);
  (void)visit_cells(cap, true);
  return HL_OK;
}

/* ---- joined to the surface ---- */

/* Appends a patch to the surface: its triangles, and the vertices that they use. Each vertex is appended
 * once. */
static hl_status append(hl_context *context, const iso_triangles *patch, iso_triangles *made,
                        hl_error *error) {
  if (patch->triangle_count == 0) return HL_OK;
  uint32_t *number = hl_allocate(context, patch->vertex_count, sizeof *number);
  if (number == NULL) return fail_cap(patch->vertex_count, error);
  memset(number, 0xff, patch->vertex_count * sizeof *number);
  size_t used = 0;
  for (size_t t = 0; t < patch->triangle_count; t++)
    for (int c = 0; c < 3; c++)
      if (number[patch->triangles[t][c]] == UINT32_MAX)
        number[patch->triangles[t][c]] = (uint32_t)(made->vertex_count + used++);
  const size_t vertices = made->vertex_count + used, triangles = made->triangle_count + patch->triangle_count;
  void *positions = hl_reallocate(context, made->positions, vertices, sizeof *made->positions);
  if (positions != NULL) made->positions = positions;
  void *normals = hl_reallocate(context, made->normals, vertices, sizeof *made->normals);
  if (normals != NULL) made->normals = normals;
  void *corners = hl_reallocate(context, made->triangles, triangles, sizeof *made->triangles);
  if (corners != NULL) made->triangles = corners;
  hl_status status = HL_OK;
  if (positions == NULL || normals == NULL || corners == NULL) status = fail_cap(vertices, error);
  for (size_t v = 0; status == HL_OK && v < patch->vertex_count; v++) {
    if (number[v] == UINT32_MAX) continue;
    memcpy(made->positions[number[v]], patch->positions[v], sizeof *made->positions);
    memcpy(made->normals[number[v]], patch->normals[v], sizeof *made->normals);
  }
  for (size_t t = 0; status == HL_OK && t < patch->triangle_count; t++)
    for (int c = 0; c < 3; c++) made->triangles[made->triangle_count + t][c] = number[patch->triangles[t][c]];
  if (status == HL_OK) made->vertex_count = vertices, made->triangle_count = triangles;
  hl_release(context, number);
  return status;
}

/* Cuts a patch at the box and by all cuts, except by the cut to which the patch belongs. */
static hl_status trim(hl_context *context, const grid *grid, size_t cut, iso_triangles *patch,
                      hl_error *error) {
  hl_status status = HL_OK;
  if (cut < grid->cut_count) status = hl_iso_clip_box(context, patch, grid->box_low, grid->box_high, error);
  for (size_t i = 0; i < grid->cut_count && status == HL_OK; i++)
    if (i != cut) status = hl_iso_cut(context, patch, &grid->cuts[i], 1, error);
  return status;
}

/* The number of cells of triangles along a face. half: half of the face's length, in voxels. A cell is at
 * most a voxel wide. On a sphere of radius r, cells of width h have diagonals of length sqrt(2) h, whose
 * middles lie up to h^2 / (4 r) below the sphere (derived, as in refine.c). On spheres, cells are so small
 * that this depth is at most MOST_DEPTH. */
static size_t cells_along(const cap_face *face, double half) {
  enum { MOST_CELLS = 8192 };
  static const double MOST_DEPTH = 0.015;
  double cells = ceil(2 * half);
  if (face->sphere) cells = fmax(cells, ceil(sqrt(half / MOST_DEPTH)));
  return (size_t)fmin(fmax(cells, 1), MOST_CELLS);
}

static hl_status cap_face_of(hl_pool *pool, const lattice *lattice, const cap_face *face, iso_triangles *made,
                             hl_error *error) {
  capping cap = {.context = lattice->context, .lattice = lattice, .face = face};
  for (int n = 0; n < 2; n++)
    cap.across[n] = cells_along(face,
                                vec3_length(mat3_column(face->to_index.linear, (face->axis + 1 + n) % 3)));
  hl_status status = make_patch(pool, &cap, error);
  if (status == HL_OK) status = trim(cap.context, lattice->grid, face->cut, &cap.patch, error);
  if (status == HL_OK) status = append(cap.context, &cap.patch, made, error);
  hl_release(cap.context, cap.inside);
  hl_iso_triangles_release(cap.context, &cap.patch);
  return status;
}

/* ---- all faces ---- */

/* Returns whether the volume ends at face n of the box, because no other volume continues it. Faces 2 a and 2
 * a + 1 are the lower and the upper face of axis a. */
static bool ends_volume(const grid *grid, int n) {
  return fabsf(n % 2 ? grid->face_high[n / 2] : grid->face_low[n / 2]) < FACE_FAR_OUT;
}

static hl_status cap_box(hl_pool *pool, const lattice *lattice, iso_triangles *made, hl_error *error) {
  const grid *grid = lattice->grid;
  cap_face face = {.cut = grid->cut_count};
  face.to_index.offset = vec3_scale(vec3_add(vec3_of(grid->box_low), vec3_of(grid->box_high)), 0.5);
  const vec3 half = vec3_scale(vec3_subtract(vec3_of(grid->box_high), vec3_of(grid->box_low)), 0.5);
  const double halves[3] = {half.x, half.y, half.z};
  for (int a = 0; a < 3; a++) face.to_index.linear.row[a] = unit_of_axis(a, halves[a]);
  hl_status status = HL_OK;
  if (!affine3_invert(face.to_index, &face.from_index)) return HL_OK; /* the box is empty */
  for (int n = 0; n < 6 && status == HL_OK; n++) {
    face.axis = n / 2;
    face.height = face.outward = n % 2 ? 1 : -1;
    if (ends_volume(grid, n)) status = cap_face_of(pool, lattice, &face, made, error);
  }
  return status;
}

/* Places the face of a plane. In the plane's own space, x runs at a right angle to the plane. The face is
 * large enough along y and z to cover the box. */
static bool place_plane(const grid *grid, const cut_shape *shape, cap_face *face) {
  const vec3 row = shape->to_shape.linear.row[0];
  const double length = vec3_length(row),
               reach = vec3_length(vec3_subtract(vec3_of(grid->box_high), vec3_of(grid->box_low))) / 2;
  if (!(length > 0)) return false;
  const vec3 normal = vec3_scale(row, 1 / length),
             middle = vec3_scale(vec3_add(vec3_of(grid->box_low), vec3_of(grid->box_high)), 0.5);
  const double over = (vec3_dot(row, middle) + shape->to_shape.offset.x) / length;
  const vec3 aside = fabs(normal.x) < 0.6 ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
  const vec3 u = vec3_normalise(vec3_cross(normal, aside)), v = vec3_cross(normal, u);
  const mat3 columns = {{normal, vec3_scale(u, reach), vec3_scale(v, reach)}};
  face->to_index = (affine3){mat3_transpose(columns), vec3_subtract(middle, vec3_scale(normal, over))};
  return fabs(over) < reach && affine3_invert(face->to_index, &face->from_index);
}

static hl_status cap_cut(hl_pool *pool, const lattice *lattice, size_t cut, iso_triangles *made,
                         hl_error *error) {
  const cut_shape *shape = &lattice->grid->cuts[cut];
  const double away = shape->keep_inside ? 1 : -1; /* 1: the outward side of the face points away from the
                                                    * middle of the shape; -1: it points towards the middle */
  cap_face face = {.cut = cut, .from_index = shape->to_shape, .sphere = shape->type == HL_CUT_SPHERE};
  hl_status status = HL_OK;
  if (shape->type == HL_CUT_PLANE) {
    face.outward = -away; /* the inside of a plane lies above the plane */
    return place_plane(lattice->grid, shape, &face) ? cap_face_of(pool, lattice, &face, made, error) : HL_OK;
  }
  if (!affine3_invert(shape->to_shape, &face.to_index)) return HL_OK;
  for (int n = 0; n < 6 && status == HL_OK; n++) {
    face.axis = n / 2;
    face.height = n % 2 ? 1 : -1;
    face.outward = face.sphere ? away : away * face.height;
    status = cap_face_of(pool, lattice, &face, made, error);
  }
  return status;
}

hl_status hl_iso_cap(hl_pool *pool, const lattice *lattice, iso_triangles *made, hl_error *error) {
  hl_status status = cap_box(pool, lattice, made, error);
  for (size_t i = 0; i < lattice->grid->cut_count && status == HL_OK; i++)
    status = cap_cut(pool, lattice, i, made, error);
  return status;
}

uint8_t hl_iso_capped_faces(const grid *grid) {
  uint8_t faces = 0;
  for (int n = 0; n < 6; n++)
    if (ends_volume(grid, n)) faces |= (uint8_t)(1 << n);
  return faces;
}
