/* mesh/mesh.h - the inside of hl_mesh, and what its readers share. */
#ifndef HL_MESH_MESH_H
#define HL_MESH_MESH_H

#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/mesh.h>

#include "core/error.h"

enum { HL_LIMIT_TRIANGLES = 1 << 28 };

struct hl_mesh {
  hl_context *context;
  atomic_int references;
  hl_mesh_description description; /* its arrays are owned */
  double low[3], high[3];          /* bounds of the vertices; world units */
  bool closed; /* each edge has a triangle on either side: the mesh has an inside, and its fronts face
                  outwards */
};

/* A mesh that is being read: growing arrays. */
typedef struct mesh_parts {
  hl_context *context;
  const char *path;         /* what errors call the file */
  float (*positions)[3];    /* owned; [vertex_count] */
  float (*normals)[3];      /* owned; [vertex_count]; null: none */
  float (*colors)[4];       /* owned; [vertex_count]; null: none */
  uint32_t (*triangles)[3]; /* owned; [triangle_count] */
  size_t vertex_count, vertex_room, triangle_count, triangle_room;
} mesh_parts;

/* Makes room for so many vertices, or triangles, in all. with_normals, with_colors: arrays that vertices
 * have. */
hl_status hl_mesh_reserve_vertices(mesh_parts *parts, size_t count, bool with_normals, bool with_colors,
                                   hl_error *error);
hl_status hl_mesh_reserve_triangles(mesh_parts *parts, size_t count, hl_error *error);

/* Adds a triangle. Room for it is made as needed. */
hl_status hl_mesh_add_triangle(mesh_parts *parts, uint32_t a, uint32_t b, uint32_t c, hl_error *error);

/* Checks the parts and moves them into a mesh, which is owned by the caller. */
hl_status hl_mesh_of_parts(mesh_parts *parts, hl_mesh **mesh, hl_error *error);

void hl_mesh_parts_release(mesh_parts *parts);

/* A file's content in memory, followed by one zero byte. */
typedef struct mesh_text {
  const unsigned char *bytes; /* [length] */
  size_t length;
} mesh_text;

/* Readers of formats: fill empty parts. */
typedef hl_status mesh_reader(mesh_text text, mesh_parts *parts, hl_error *error);
mesh_reader hl_mesh_read_ply, hl_mesh_read_stl, hl_mesh_read_obj;

#endif
