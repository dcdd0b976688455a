/* halflight/mesh.h - triangles, spheres and tubes that share a scene with volumes.
 *
 * Meshes are immutable and reference-counted: hl_mesh_retain() and hl_mesh_release(). A triangle shows its
 * front where its vertices are counter-clockwise. */
#ifndef HALFLIGHT_MESH_H
#define HALFLIGHT_MESH_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_mesh hl_mesh;

/* The arrays of a mesh. hl_mesh_create() copies them. */
typedef struct hl_mesh_description {
  size_t struct_size;          /* set by hl_mesh_description_defaults() */
  const float (*positions)[3]; /* [vertex_count]; world units */
  const float (*normals)[3];   /* [vertex_count]; of any length; null: none */
  const float (*colors)[4];    /* [vertex_count]; linear RGB and opacity, 0 to 1; null: none */
  size_t vertex_count;
  const uint32_t (*triangles)[3]; /* [triangle_count]; indices of vertices */
  size_t triangle_count;
  const float (*face_colors)[4];   /* [triangle_count]; linear RGB and opacity of triangles, in place of
                                    * `colors`; null: none */
  const float (*spheres)[4];       /* [sphere_count]; centre and radius; world units */
  const float (*sphere_colors)[4]; /* [sphere_count]; as colors; null: white */
  size_t sphere_count;
  /* Lines, which are drawn as tubes. line_points has all points of the first line, then those of the next,
   * and so on. */
  const float (*line_points)[4]; /* [line_point_count]; a point, and the tube's radius there; world units */
  const float (*line_colors)[4]; /* [line_point_count]; as colors; null: white */
  size_t line_point_count;
  const uint32_t *line_lengths; /* [line_count]; number of points of each line; the sum of all is
                                 * line_point_count */
  size_t line_count;
} hl_mesh_description;

HL_API void hl_mesh_description_defaults(hl_mesh_description *description);

/* Copies the arrays. A mesh has triangles, spheres or lines, or all of these. Triangles without an area are
 * left out, and so are spheres and points of lines without a radius, and whatever has a coordinate that is
 * not a number. Spheres are exact; lines become closed tubes of twelve sides, whose triangles follow the
 * given ones. An index out of range is HL_ERROR_INPUT. *mesh is owned by the caller (release it). */
HL_API HL_WARN_UNUSED hl_status hl_mesh_create(hl_context *context, const hl_mesh_description *description,
                                               hl_mesh **mesh, hl_error *error);

/* Reads PLY (ASCII and binary), STL (ASCII and binary), OBJ with the colours of its materials, glTF 2.0 files
 * (.gltf, .glb: the scene's triangles with base colours; textures are left out), VTK's PolyData (.vtp, legacy
 * .vtk) and the surfaces of VTK's unstructured grids (.vtu). Faces of more than three corners become
 * triangles that cover them, concave faces, too. Colours of 8 bits are taken as sRGB, as other programs do.
 *
 * PolyData: vertices become spheres, and lines become tubes. Their radii come from the point array "radius";
 * without this array, the radius is a 400th of the diagonal of the box around all points. Colours come from
 * the active scalars, or else from the first array of 8-bit RGB or RGBA; arrays of points come before arrays
 * of cells. Other scalars go through the colormap viridis over their whole range. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_load(hl_context *context, const char *path, hl_mesh **mesh,
                                             hl_error *error);

/* Whether hl_mesh_load() reads files with this name, by the name's ending. A .vtk file may also hold a
 * volume; for such a name, the first kilobyte of the file decides, if the context may open it. 0 for null. */
HL_API int hl_mesh_reads_name(hl_context *context, const char *path);

/* The mesh's arrays, which include the triangles of its tubes; valid as long as the mesh. Null for null. */
HL_API const hl_mesh_description *hl_mesh_describe(const hl_mesh *mesh);

/* The least and greatest coordinates of the vertices; world units. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_get_box(const hl_mesh *mesh, double low[3], double high[3]);

HL_API void hl_mesh_retain(hl_mesh *mesh);
HL_API void hl_mesh_release(hl_mesh *mesh); /* null is allowed */

#ifdef __cplusplus
}
#endif
#endif
