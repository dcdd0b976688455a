/* mesh/tubes.c - makes tubes of lines: closed meshes of twelve sides.
 *
 * Two pieces of a tube meet in the plane that halves their angle. In this plane the two pieces have the same
 * outline, because one piece is the mirror image of the other. So bends have no gaps. */
#include <math.h>

#include "core/memory.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "mesh/mesh.h"

enum { SIDES = 12 };

/* The least cosine of half the angle by which a tube turns at a bend. At a bend of more than 120 degrees the
 * cosine is smaller, and the bend is cut short, because its outer edge would reach far out. */
static const double SHARP = 0.5;

/* The axes of a piece of a tube, which goes from one of its line's points to the next: the direction along
 * the piece, and two directions across it. The three directions form a right-handed system. */
typedef struct piece {
  vec3 along, u, v;
} piece;

typedef struct tube {
  mesh_parts *parts;
  float color[4]; /* the colour of the vertices that are added next */
} tube;

static void add_vertex(tube *tube, vec3 at, vec3 normal) {
  mesh_parts *parts = tube->parts;
  size_t n = parts->vertex_count++;
  vec3_store(parts->positions[n], at);
  if (parts->normals != NULL) vec3_store(parts->normals[n], normal);
  for (int c = 0; c < 4 && parts->colors != NULL; c++) parts->colors[n][c] = tube->color[c];
}

/* Adds a ring of vertices around a centre. middle: the normal of the ring's plane. */
static void add_ring(tube *tube, vec3 centre, const piece *piece, vec3 middle, double radius) {
  double across = vec3_dot(piece->along, middle);
  for (int k = 0; k < SIDES; k++) {
    double angle = 2 * HL_PI * k / SIDES;
    vec3 out = vec3_add(vec3_scale(piece->u, hl_cos(angle)), vec3_scale(piece->v, hl_sin(angle)));
    double shift = across > SHARP ? -vec3_dot(out, middle) / across : 0;
    vec3 at = vec3_add(out, vec3_scale(piece->along, shift));
    add_vertex(tube, vec3_add(centre, vec3_scale(at, radius)), out);
  }
}

static void add_face(tube *tube, size_t a, size_t b, size_t c) {
  mesh_parts *parts = tube->parts;
  uint32_t *triangle = parts->triangles[parts->triangle_count];
  triangle[0] = (uint32_t)a, triangle[1] = (uint32_t)b, triangle[2] = (uint32_t)c;
  for (int k = 0; k < 4 && parts->face_colors != NULL; k++)
    parts->face_colors[parts->triangle_count][k] = tube->color[k];
  parts->triangle_count++;
}

/* Adds the faces between two rings of vertices; ring `to` lies ahead of ring `from`. */
static void add_band(tube *tube, size_t from, size_t to) {
  for (size_t k = 0; k < SIDES; k++) {
    size_t next = (k + 1) % SIDES;
    add_face(tube, from + k, from + next, to + next);
    add_face(tube, from + k, to + next, to + k);
  }
}

/* Adds a round end to a tube, beyond the ring `last`. way: 1 at the tube's end, -1 at its beginning. */
static void add_end(tube *tube, vec3 centre, const piece *piece, double radius, int way, size_t last) {
  double half = sqrt(0.5) * radius;
  vec3 out = vec3_scale(piece->along, way);
  size_t ring = tube->parts->vertex_count, pole = ring + SIDES;
  add_ring(tube, vec3_add(centre, vec3_scale(out, half)), piece, piece->along, half);
  add_vertex(tube, vec3_add(centre, vec3_scale(out, radius)), out);
  if (way > 0) add_band(tube, last, ring);
  else add_band(tube, ring, last);
  for (size_t k = 0; k < SIDES; k++) {
    size_t next = (k + 1) % SIDES;
    if (way > 0) add_face(tube, ring + k, ring + next, pole);
    else add_face(tube, ring + next, ring + k, pole);
  }
}

static vec3 point_of(const float point[4]) { return (vec3){point[0], point[1], point[2]}; }

/* Makes the piece of a tube that follows the piece `before` and runs in the direction `along`. before: null
 * for a tube's first piece. middle: the normal of the plane in which the two pieces meet. Derived: mirroring
 * in this plane turns the directions across the first piece into the directions across the second piece. */
static piece follow(const piece *before, vec3 along, vec3 middle) {
  piece made = {.along = along};
  if (before != NULL) made.u = vec3_subtract(before->u, vec3_scale(middle, 2 * vec3_dot(before->u, middle)));
  made.u = vec3_subtract(made.u, vec3_scale(along, vec3_dot(made.u, along)));
  made.u = vec3_length(made.u) > 0.1 ? vec3_normalise(made.u) : vec3_normalise(vec3_perpendicular(along));
  made.v = vec3_cross(along, made.u);
  return made;
}

static void set_color(tube *tube, size_t point) {
  const float(*colors)[4] = (const float(*)[4])tube->parts->line_colors;
  for (int c = 0; c < 4; c++) tube->color[c] = colors != NULL ? colors[point][c] : 1;
}

/* Adds the tube of a line with the points first .. first + count - 1. There must be at least two points, and
 * no two neighbours may be at one place. */
static void add_tube(tube *tube, size_t first, size_t count) {
  const float(*points)[4] = (const float(*)[4])tube->parts->line_points + first;
  piece now = {0};
  vec3 along = {0, 0, 0};
  size_t last = 0;
  for (size_t n = 0; n < count; n++) {
    vec3 at = point_of(points[n]), before = along, middle;
    double radius = points[n][3];
    if (n + 1 < count) along = vec3_normalise(vec3_subtract(point_of(points[n + 1]), at));
    middle = n > 0 ? vec3_normalise(vec3_add(before, along)) : along;
    if (!(vec3_length(middle) > 0.5)) middle = along; /* the line turns back on itself */
    if (n == 0) now = follow(NULL, along, middle);
    set_color(tube, first + n);
    size_t ring = tube->parts->vertex_count;
    add_ring(tube, at, &now, middle, radius);
    if (n > 0) add_band(tube, last, ring);
    last = ring;
    if (n == 0) add_end(tube, at, &now, radius, -1, ring);
    if (n + 1 == count) add_end(tube, at, &now, radius, 1, ring);
    if (n > 0 && n + 1 < count) now = follow(&now, along, middle);
  }
}

/* Returns whether a point can be drawn. before: the previous point of its line; null if there is none. */
static bool is_drawn(const float point[4], const float *before) {
  for (int c = 0; c < 4; c++)
    if (!isfinite(point[c])) return false;
  if (!(point[3] > 0)) return false;
  return before == NULL || point[0] != before[0] || point[1] != before[1] || point[2] != before[2];
}

/* Keeps the points that can be drawn, and the lines with at least two of them. */
static void keep_lines(mesh_parts *parts) {
  size_t from = 0, to = 0, lines = 0;
  for (size_t line = 0; line < parts->line_count; line++) {
    size_t start = to, end = from + parts->line_lengths[line];
    for (; from < end; from++) {
      if (!is_drawn(parts->line_points[from], to > start ? parts->line_points[to - 1] : NULL)) continue;
      for (int c = 0; c < 4; c++) {
        parts->line_points[to][c] = parts->line_points[from][c];
        if (parts->line_colors != NULL) parts->line_colors[to][c] = parts->line_colors[from][c];
      }
      to++;
    }
    if (to - start >= 2) parts->line_lengths[lines++] = (uint32_t)(to - start);
    else to = start;
  }
  parts->line_point_count = to;
  parts->line_count = lines;
}

/* Makes room in the arrays of a mesh for its tubes. Gives colours to all vertices if any line has colours. */
static bool make_room(mesh_parts *parts) {
  size_t rings = parts->line_point_count, ends = 2 * parts->line_count;
  size_t vertices = parts->vertex_count + rings * SIDES + ends * (SIDES + 1),
         triangles = parts->triangle_count + (rings + ends / 2) * 2 * SIDES + ends * SIDES;
  hl_error ignored;
  bool colored = parts->colors != NULL || parts->line_colors != NULL, fresh = parts->colors == NULL;
  if (colored && fresh) parts->vertex_room = 0; /* all arrays then get the same capacity */
  if (vertices > UINT32_MAX || triangles > HL_LIMIT_TRIANGLES ||
      hl_mesh_reserve_vertices(parts, vertices, parts->normals != NULL, colored, &ignored) != HL_OK ||
      hl_mesh_reserve_triangles(parts, triangles, &ignored) != HL_OK)
    return false;
  for (size_t n = 0; colored && fresh && n < parts->vertex_count; n++)
    for (int c = 0; c < 4; c++) parts->colors[n][c] = 1;
  if (parts->face_colors == NULL) return true;
  float(*grown)[4] = hl_reallocate(parts->context, parts->face_colors, triangles, sizeof *grown);
  if (grown != NULL) parts->face_colors = grown;
  return grown != NULL;
}

hl_status hl_mesh_add_tubes(mesh_parts *parts, hl_error *error) {
  if (parts->line_count == 0) return HL_OK;
  keep_lines(parts);
  if (!make_room(parts))
    return hl_fail_memory(error, parts->line_point_count * SIDES * sizeof *parts->positions,
                          "a mesh's tubes");
  tube tube = {.parts = parts};
  for (size_t line = 0, at = 0; line < parts->line_count; at += parts->line_lengths[line++])
    add_tube(&tube, at, parts->line_lengths[line]);
  return HL_OK;
}
