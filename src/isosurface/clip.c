/* isosurface/clip.c - see clip.h. */
#include "isosurface/clip.h"

#include <string.h>

#include "core/memory.h"

/* One cut: the half space normal . p + offset >= 0 is kept. Vertices on cut edges are made anew for each
 * triangle: the mesh is open there anyway. */
typedef struct cutting {
  hl_context *context;
  iso_triangles *made;
  double normal[3], offset;
} cutting;

static double height(const cutting *cut, uint32_t vertex) {
  const float *p = cut->made->positions[vertex];
  return cut->normal[0] * p[0] + cut->normal[1] * p[1] + cut->normal[2] * p[2] + cut->offset;
}

/* The vertex where the edge from a to b crosses the plane; the same for both triangles beside the edge. */
static uint32_t cross_edge(cutting *cut, uint32_t a, uint32_t b) {
  if (a > b) {
    uint32_t kept = a;
    a = b, b = kept;
  }
  iso_triangles *made = cut->made;
  double from = height(cut, a), t = from / (from - height(cut, b));
  uint32_t vertex = (uint32_t)made->vertex_count++;
  for (int axis = 0; axis < 3; axis++) {
    const double p = made->positions[a][axis], n = made->normals[a][axis];
    made->positions[vertex][axis] = (float)(p + t * (made->positions[b][axis] - p));
    made->normals[vertex][axis] = (float)(n + t * (made->normals[b][axis] - n));
  }
  return vertex;
}

/* Cuts a triangle, and writes its parts at *to. */
static void cut_triangle(cutting *cut, const uint32_t corner[3], uint32_t (*triangles)[3], size_t *to) {
  uint32_t kept[4];
  int count = 0;
  for (int i = 0; i < 3; i++) {
    uint32_t a = corner[i], b = corner[(i + 1) % 3];
    bool here = height(cut, a) >= 0, next = height(cut, b) >= 0;
    if (here) kept[count++] = a;
    if (here != next) kept[count++] = cross_edge(cut, a, b);
  }
  for (int i = 1; i + 1 < count; i++, ++*to) {
    triangles[*to][0] = kept[0], triangles[*to][1] = kept[i], triangles[*to][2] = kept[i + 1];
  }
}

static size_t count_cut(const cutting *cut) {
  size_t count = 0;
  for (size_t t = 0; t < cut->made->triangle_count; t++) {
    const uint32_t *corner = cut->made->triangles[t];
    int kept = 0;
    for (int i = 0; i < 3; i++) kept += height(cut, corner[i]) >= 0;
    count += kept > 0 && kept < 3;
  }
  return count;
}

static bool is_kept_whole(const cutting *cut, const uint32_t corner[3]) {
  return height(cut, corner[0]) >= 0 && height(cut, corner[1]) >= 0 && height(cut, corner[2]) >= 0;
}

/* Each triangle that is cut adds one triangle and two vertices at most. */
static hl_status keep_half(cutting *cut, hl_error *error) {
  iso_triangles *made = cut->made;
  size_t more = count_cut(cut), count = 0;
  void *positions = hl_reallocate(cut->context, made->positions, made->vertex_count + 2 * more,
                                  sizeof *made->positions);
  if (positions != NULL) made->positions = positions;
  void *normals = hl_reallocate(cut->context, made->normals, made->vertex_count + 2 * more,
                                sizeof *made->normals);
  if (normals != NULL) made->normals = normals;
  uint32_t(*triangles)[3] = hl_allocate(cut->context, made->triangle_count + more, sizeof *triangles);
  if (positions == NULL || normals == NULL || triangles == NULL) {
    hl_release(cut->context, triangles);
    return hl_fail_memory(error, (made->triangle_count + more) * sizeof *triangles, "an isosurface");
  }
  for (size_t t = 0; t < made->triangle_count; t++) {
    if (is_kept_whole(cut, made->triangles[t]))
      memcpy(triangles[count++], made->triangles[t], sizeof *triangles);
    else cut_triangle(cut, made->triangles[t], triangles, &count);
  }
  hl_release(cut->context, made->triangles);
  made->triangles = triangles;
  made->triangle_count = count;
  return HL_OK;
}

/* Whether some vertex lies on the other side. */
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
    if (cuts(&cut)) status = keep_half(&cut, error);
  }
  return status;
}
