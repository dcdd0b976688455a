/* mesh/mesh.h - defines the members of hl_mesh, and functions that its readers share. */
#ifndef HL_MESH_MESH_H
#define HL_MESH_MESH_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include <halflight/mesh.h>

#include "core/error.h"

enum { HL_LIMIT_TRIANGLES = 1 << 28, HL_LIMIT_SPHERES = 1 << 26, HL_LIMIT_LINE_POINTS = 1 << 23 };

/* The cosine of 40 degrees. If no triangle's normal differs from a vertex's normal by more than this angle,
 * the surface counts as rounded at the vertex; otherwise it has a crease there. */
#define HL_MESH_ROUNDED 0.766

/* In hl_mesh.edges: the index of a corner that has no normal of its own. */
#define HL_NO_EDGE UINT32_MAX

struct hl_mesh {
  hl_context *context;
  atomic_int references;
  hl_mesh_description description; /* the mesh's arrays and their sizes; the arrays are owned */
  /* numbers of the vertices and triangles that do not belong to tubes; the vertices and triangles of tubes
   * follow them */
  size_t given_vertices, given_triangles;
  /* owned; [triangle_count]; for each corner, the index of its normal in edge_normals; HL_NO_EDGE: the corner
   * has its vertex's normal. Null if all corners have their vertices' normals */
  uint32_t (*edges)[3];
  float (*edge_normals)[3]; /* owned; [edge_normal_count]; unit normals of corners at creases */
  size_t edge_normal_count;
  double low[3], high[3]; /* bounds of the visible elements; world units */
  bool closed;            /* whether the mesh encloses an inside and its fronts face outwards: each edge has
                           * triangles on both sides, or several parts enclose an inside together */
  int8_t *insides; /* owned; [triangle_count]; the side of a triangle on which the inside of its closed part
                    * lies: -1 is the triangle's back, 1 its front; if 0, the part is open */
  bool opaque;     /* whether no triangle's colour lets light through */
  bool is_cut;     /* whether the scene's cuts were applied already when the mesh was made, as for an
                    * isosurface */
  uint64_t mark; /* a hash of everything that hides light: triangles, spheres and their colours; for the keys
                  * of kept results */
};

/* A hash of an edge in one direction, from one vertex to another. The hashes of an edge's two directions add
 * up to 0. Two different edges have the same hash with a probability of one in 2^64. */
uint64_t hl_hash_of_way(uint32_t from, uint32_t to);

/* A polygon that a reader added as a fan of triangles. `first` is the number of the fan's first triangle. */
typedef struct mesh_polygon {
  size_t first, count;
} mesh_polygon;

/* A mesh that is being read, as growing arrays. */
typedef struct mesh_parts {
  hl_context *context;
  const char *path;      /* the file's name in errors */
  float (*positions)[3]; /* owned; [vertex_count]; positions of vertices */
  /* owned; [vertex_count]; unit normals of vertices; null if vertices have no normals */
  float (*normals)[3];
  /* owned; [vertex_count]; colours of vertices, linear RGB and opacity; null if vertices have no colours */
  float (*colors)[4];
  uint32_t (*triangles)[3]; /* owned; [triangle_count]; the three vertices of each triangle */
  /* owned; [triangle_count]; colours of triangles; null if triangles have no colours */
  float (*face_colors)[4];
  size_t vertex_count, vertex_room, triangle_count, triangle_room;
  float (*spheres)[4];       /* owned; [sphere_count]; centre and radius of each sphere */
  float (*sphere_colors)[4]; /* owned; [sphere_count]; colours of spheres; null if spheres have no colours */
  size_t sphere_count;
  float (*line_points)[4]; /* owned; [line_point_count]; position and radius of each point of a line */
  /* owned; [line_point_count]; colours of the points of lines; null if lines have no colours */
  float (*line_colors)[4];
  uint32_t *line_lengths; /* owned; [line_count]; the number of points of each line */
  size_t line_point_count, line_count;
  mesh_polygon *polygons; /* owned; [polygon_count]; polygons of more than three corners */
  size_t polygon_count, polygon_room;
} mesh_parts;

/* Two functions that make room for vertices or triangles. count: the number of all vertices or triangles for
 * which there must be room, including the existing ones. with_normals, with_colors: whether the vertices have
 * normals and colours. */
hl_status hl_mesh_reserve_vertices(mesh_parts *parts, size_t count, bool with_normals, bool with_colors,
                                   hl_error *error);
hl_status hl_mesh_reserve_triangles(mesh_parts *parts, size_t count, hl_error *error);

/* Adds a triangle. Makes room for the triangle in the array `triangles`, but not in `face_colors`. */
hl_status hl_mesh_add_triangle(mesh_parts *parts, uint32_t a, uint32_t b, uint32_t c, hl_error *error);

/* Notes that the triangles from `first` to the last triangle are a polygon: a fan around the polygon's first
 * corner. */
hl_status hl_mesh_note_polygon(mesh_parts *parts, size_t first, hl_error *error);

/* Replaces the fans of noted polygons that are not convex by triangles that cover exactly the polygon. All
 * vertices must have been added. */
hl_status hl_mesh_clip_polygons(mesh_parts *parts, hl_error *error);

/* The radius of spheres and tubes for files that give none, in a box around all points; world units. */
double hl_mesh_usual_radius(const double low[3], const double high[3]);

/* Makes spheres of the vertices if there are no triangles. */
hl_status hl_mesh_show_points(mesh_parts *parts, hl_error *error);

/* Adds the triangles of the tubes around the lines. */
hl_status hl_mesh_add_tubes(mesh_parts *parts, hl_error *error);

/* Checks the arrays, makes tubes of the lines, and moves everything into a mesh, which is owned by the
 * caller. */
hl_status hl_mesh_of_parts(mesh_parts *parts, hl_mesh **mesh, hl_error *error);

/* Finds the creases of a mesh without normals, and the normals of the corners there. This function is called
 * once, when the mesh is made. */
hl_status hl_mesh_find_edges(hl_mesh *mesh, hl_error *error);

/* Finds the closed parts of a mesh: sets insides and closed. */
hl_status hl_mesh_find_insides(hl_mesh *mesh, hl_error *error);

/* Marks a mesh as closed, although its parts share no edges where they meet. The function is called for
 * meshes of several parts that enclose an inside together. The fronts must face outwards. */
void hl_mesh_take_as_closed(hl_mesh *mesh);

/* Returns whether hl_mesh_save() writes files with this ending. */
bool hl_mesh_is_written(const char *ending);

/* Describes the mesh that would be made of the parts now. The description borrows its arrays from the
 * parts. */
hl_mesh_description hl_mesh_parts_describe(const mesh_parts *parts);

void hl_mesh_parts_release(mesh_parts *parts);

/* A file's content in memory, followed by one zero byte. */
typedef struct mesh_text {
  const unsigned char *bytes; /* [length]; the bytes of the file */
  size_t length;
} mesh_text;

/* The type of the readers of mesh formats. A reader fills `parts`, which are empty before. */
typedef hl_status mesh_reader(mesh_text text, mesh_parts *parts, hl_error *error);
mesh_reader hl_mesh_read_ply, hl_mesh_read_stl, hl_mesh_read_obj, hl_mesh_read_gltf, hl_mesh_read_vtp,
    hl_mesh_read_legacy_vtk;

#endif
