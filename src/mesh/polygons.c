/* mesh/polygons.c - makes triangles that cover exactly a polygon of more than three corners.
 *
 * Readers add a polygon as a fan of triangles around its first corner, and note which triangles these are. If
 * the polygon is not convex, the fan may reach beyond it. Once all vertices are known, such a fan is replaced
 * by the same number of triangles, which ear clipping makes (G. H. Meisters, Polygons Have Ears, American
 * Mathematical Monthly 82, 1975). */
#include <math.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/vector.h"
#include "mesh/mesh.h"

/* The greatest number of corners of a polygon from which ears are clipped. A polygon with more corners stays
 * a fan of triangles, because the time for clipping grows with the square of the number of corners. */
enum { CORNERS_MOST = 1 << 14 };

hl_status hl_mesh_note_polygon(mesh_parts *parts, size_t first, hl_error *error) {
  if (parts->triangle_count < first + 2) return HL_OK;
  if (parts->polygon_count == parts->polygon_room) {
    size_t room = 2 * parts->polygon_room + 256;
    void *grown = hl_reallocate(parts->context, parts->polygons, room, sizeof *parts->polygons);
    if (grown == NULL) return hl_fail_memory(error, room * sizeof *parts->polygons, "a mesh's polygons");
    parts->polygons = grown;
    parts->polygon_room = room;
  }
  parts->polygons[parts->polygon_count++] = (mesh_polygon){first, parts->triangle_count - first};
  return HL_OK;
}

/* The corners of a polygon, projected onto a plane. */
typedef struct outline {
  uint32_t *vertex;        /* owned; [room]; index of the corner's vertex in the mesh */
  double (*at)[2];         /* owned; [room]; the place of each corner in the plane */
  uint32_t *next, *before; /* owned; [room]; indices of the next and the previous corner among the corners
                            * that are left */
  size_t count, room;
} outline;

static void release_outline(hl_context *context, outline *o) {
  hl_release(context, o->vertex);
  hl_release(context, o->at);
  hl_release(context, o->next);
  hl_release(context, o->before);
}

static hl_status make_room(hl_context *context, outline *o, size_t count, hl_error *error) {
  if (count <= o->room) return HL_OK;
  release_outline(context, o);
  o->room = 2 * count;
  o->vertex = hl_allocate(context, o->room, sizeof *o->vertex);
  o->at = hl_allocate(context, o->room, sizeof *o->at);
  o->next = hl_allocate(context, o->room, sizeof *o->next);
  o->before = hl_allocate(context, o->room, sizeof *o->before);
  if (o->vertex != NULL && o->at != NULL && o->next != NULL && o->before != NULL) return HL_OK;
  return hl_fail_memory(error, o->room * 32, "a polygon");
}

/* Twice the area of a triangle. The area is positive if the corners run counter-clockwise. */
static double area(const double a[2], const double b[2], const double c[2]) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static vec3 corner_at(const mesh_parts *parts, const outline *o, size_t n) {
  const float *at = parts->positions[o->vertex[n]];
  return (vec3){(double)at[0], (double)at[1], (double)at[2]};
}

/* Twice the area vector of a polygon (M. E. Newell's method). */
static vec3 normal_of(const mesh_parts *parts, const outline *o) {
  vec3 sum = {0, 0, 0}, origin = corner_at(parts, o, 0);
  for (size_t n = 1; n + 1 < o->count; n++) {
    vec3 a = vec3_subtract(corner_at(parts, o, n), origin);
    vec3 b = vec3_subtract(corner_at(parts, o, n + 1), origin);
    sum = vec3_add(sum, vec3_cross(a, b));
  }
  return sum;
}

/* Projects the corners onto the coordinate plane in which the polygon has the greatest area, so that they run
 * counter-clockwise. Returns false if the polygon has no area. */
static bool flatten(const mesh_parts *parts, outline *o) {
  vec3 normal = normal_of(parts, o);
  const double size[3] = {normal.x, normal.y, normal.z};
  int axis = fabs(size[0]) > fabs(size[1]) ? 0 : 1;
  if (fabs(size[2]) >= fabs(size[axis])) axis = 2;
  if (!(fabs(size[axis]) > 0) || !isfinite(size[axis])) return false;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  for (size_t n = 0; n < o->count; n++) {
    const float *from = parts->positions[o->vertex[n]];
    o->at[n][0] = (double)from[size[axis] > 0 ? u : v];
    o->at[n][1] = (double)from[size[axis] > 0 ? v : u];
  }
  return true;
}

/* Returns whether the fan covers the polygon: whether no triangle of the fan is turned over. */
static bool fan_fits(const outline *o) {
  for (size_t n = 1; n + 1 < o->count; n++)
    if (area(o->at[0], o->at[n], o->at[n + 1]) < 0) return false;
  return true;
}

static bool same_place(const double a[2], const double b[2]) { return a[0] == b[0] && a[1] == b[1]; }

/* Returns whether a corner is an ear: it is convex, and no other corner lies in its triangle. */
static bool is_ear(const outline *o, uint32_t corner) {
  const double *a = o->at[o->before[corner]], *b = o->at[corner], *c = o->at[o->next[corner]];
  if (!(area(a, b, c) > 0)) return false;
  for (uint32_t n = o->next[o->next[corner]]; n != o->before[corner]; n = o->next[n]) {
    const double *p = o->at[n];
    if (same_place(p, a) || same_place(p, b) || same_place(p, c)) continue;
    if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
  }
  return true;
}

/* Finds the first ear from a corner on. An outline that crosses itself may have no ear; then returns the
 * first corner that is not reflex, or, if all are reflex, the given corner. */
static uint32_t find_ear(const outline *o, uint32_t from, size_t left) {
  uint32_t corner = from;
  for (size_t n = 0; n < left; n++, corner = o->next[corner])
    if (is_ear(o, corner)) return corner;
  for (size_t n = 0; n < left; n++, corner = o->next[corner])
    if (area(o->at[o->before[corner]], o->at[corner], o->at[o->next[corner]]) >= 0) return corner;
  return from;
}

static void clip(outline *o, uint32_t (*triangles)[3]) {
  for (uint32_t n = 0; n < o->count; n++) {
    o->next[n] = n + 1 < o->count ? n + 1 : 0;
    o->before[n] = n > 0 ? n - 1 : (uint32_t)o->count - 1;
  }
  uint32_t corner = 0;
  for (size_t left = o->count, t = 0; left >= 3; left--, t++) {
    corner = find_ear(o, corner, left);
    uint32_t before = o->before[corner], next = o->next[corner];
    triangles[t][0] = o->vertex[before], triangles[t][1] = o->vertex[corner],
    triangles[t][2] = o->vertex[next];
    o->next[before] = next;
    o->before[next] = before;
    corner = next;
  }
}

/* Reads the corners of a fan of triangles. Returns false if a corner names no vertex, which the mesh's check
 * reports later. */
static bool take_corners(const mesh_parts *parts, const mesh_polygon *polygon, outline *o) {
  uint32_t(*fan)[3] = parts->triangles + polygon->first;
  o->count = polygon->count + 2;
  o->vertex[0] = fan[0][0];
  o->vertex[1] = fan[0][1];
  for (size_t n = 0; n < polygon->count; n++) o->vertex[n + 2] = fan[n][2];
  for (size_t n = 0; n < o->count; n++)
    if (o->vertex[n] >= parts->vertex_count) return false;
  return true;
}

hl_status hl_mesh_clip_polygons(mesh_parts *parts, hl_error *error) {
  outline o = {.count = 0};
  size_t large = 0;
  hl_status status = HL_OK;
  for (size_t n = 0; n < parts->polygon_count && status == HL_OK; n++) {
    const mesh_polygon *polygon = &parts->polygons[n];
    status = make_room(parts->context, &o, polygon->count + 2, error);
    if (status != HL_OK || !take_corners(parts, polygon, &o) || !flatten(parts, &o) || fan_fits(&o)) continue;
    large += o.count > CORNERS_MOST;
    if (o.count <= CORNERS_MOST) clip(&o, parts->triangles + polygon->first);
    if (hl_cancelled(parts->context))
      status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", parts->path);
  }
  if (large > 0)
    hl_log(parts->context, HL_LOG_WARNING,
           "%s: %zu polygons of more than %d corners are not convex: they are shown as fans, which may reach "
           "beyond "
           "them",
           parts->path, large, CORNERS_MOST);
  release_outline(parts->context, &o);
  return status;
}
