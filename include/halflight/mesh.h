/* halflight/mesh.h - makes meshes: triangles, spheres and tubes that share a scene with volumes.
 *
 * Meshes never change, and are reference-counted: hl_mesh_retain() and hl_mesh_release(). A triangle shows
 * its front where its vertices are counter-clockwise. */
#ifndef HALFLIGHT_MESH_H
#define HALFLIGHT_MESH_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_mesh hl_mesh;

/* The arrays of a mesh's triangles, spheres and lines. hl_mesh_create() copies them. */
typedef struct hl_mesh_description {
  size_t struct_size;          /* set by hl_mesh_description_defaults() */
  const float (*positions)[3]; /* [vertex_count]; world units */
  const float (*normals)[3];   /* [vertex_count]; normals of any length; null if the mesh has none */
  const float (*colors)[4];    /* [vertex_count]; linear RGB and opacity, 0 to 1; null if the vertices have no
                                * colours */
  size_t vertex_count;
  const uint32_t (*triangles)[3]; /* [triangle_count]; the indices of each triangle's three vertices */
  size_t triangle_count;
  const float (*face_colors)[4];   /* [triangle_count]; linear RGB and opacity of the triangles, which replace
                                    * `colors`; null if the triangles have no colours */
  const float (*spheres)[4];       /* [sphere_count]; x, y, z of the centre, and the radius; world units */
  const float (*sphere_colors)[4]; /* [sphere_count]; linear RGB and opacity, 0 to 1; null stands for white
                                    * everywhere */
  size_t sphere_count;
  /* Lines are drawn as tubes. line_points has all points of the first line, then all points of the second
   * line, and so on. */
  const float (*line_points)[4]; /* [line_point_count]; x, y, z of the point, and the tube's radius at the
                                  * point; world units */
  const float (*line_colors)[4]; /* [line_point_count]; linear RGB and opacity, 0 to 1; null stands for white
                                  * everywhere */
  size_t line_point_count;
  const uint32_t *line_lengths; /* [line_count]; the number of points of each line; the sum of these numbers
                                 * is line_point_count */
  size_t line_count;
} hl_mesh_description;

HL_API void hl_mesh_description_defaults(hl_mesh_description *description);

/* Makes a mesh of copies of the arrays. A mesh may have triangles, spheres and lines together. Left out are
 * triangles without an area, spheres without a radius, points of lines without a radius, and everything with
 * a coordinate that is not a number. Spheres are exact. Lines become closed tubes of twelve sides; the tubes'
 * triangles are appended to the given triangles. HL_ERROR_INPUT: an index is out of range. *mesh is owned by
 * the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_create(hl_context *context, const hl_mesh_description *description,
                                               hl_mesh **mesh, hl_error *error);

/* Reads PLY (ASCII and binary), STL (ASCII and binary), OBJ with the colours of its materials, glTF 2.0 files
 * (.gltf, .glb: the scene's triangles with base colours; textures are left out), VTK's PolyData (.vtp, legacy
 * .vtk) and the surfaces of VTK's unstructured grids (.vtu). Faces of more than three corners, also concave
 * faces, are divided into triangles. Colours of 8 bits are taken as sRGB, as other programs do. The points of
 * a PLY file without faces become spheres, as the vertices of PolyData do.
 *
 * PolyData: vertices become spheres, and lines become tubes. The radii of both come from the point array
 * "radius"; without this array, each radius is a 400th of the diagonal of the box around all points. Colours
 * come from the active scalars, or else from the first array of 8-bit RGB or RGBA; arrays of points come
 * before arrays of cells. Scalars that are not 8-bit RGB or RGBA are shown in the colormap viridis, over
 * their whole range. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_load(hl_context *context, const char *path, hl_mesh **mesh,
                                             hl_error *error);

/* Makes a mesh of the surface on which a volume has a value, as an isosurface of a scene shows it with the
 * kernel HL_KERNEL_BSPLINE. Triangles show their fronts to the lesser values. The surface is closed. Where
 * the volume's box cuts through the greater values, it gets faces; these share no vertices with the surface,
 * and overlap it by 0.03 voxels. Positions are in the world of the volume's file, and the surface's place is
 * exact to 0.02 of the smallest edge of a voxel. HL_ERROR_INPUT: nowhere does the volume have this value.
 * *mesh is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_of_isosurface(hl_context *context, hl_volume *volume, double value,
                                                      hl_mesh **mesh, hl_error *error);

/* Writes the triangles of a mesh by the path's ending: .ply (binary, with normals and colours), .stl (binary)
 * or .obj (with normals). Tubes are written as triangles; spheres are left out, and colours where the format
 * has none, with a warning. The file appears whole or not at all. HL_ERROR_UNSUPPORTED: another ending, or
 * a mesh without triangles. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_save(hl_context *context, const hl_mesh *mesh, const char *path,
                                             hl_error *error);

/* Returns 1 if hl_mesh_load() reads files with this name, and else 0. The name's ending decides. A .vtk file
 * may also hold a volume; for such a name, the first kilobyte of the file decides, if the context may open
 * it. Returns 0 for null. */
HL_API int hl_mesh_reads_name(hl_context *context, const char *path);

/* Returns the mesh's arrays. They include the triangles of the mesh's tubes, and belong to the mesh. Returns
 * null if the mesh is null. */
HL_API const hl_mesh_description *hl_mesh_describe(const hl_mesh *mesh);

/* Finds the least and the greatest coordinates of the mesh, in world units. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_get_box(const hl_mesh *mesh, double low[3], double high[3]);

/* Measures the triangles of a mesh. *area receives the sum of their areas, in world units squared. *volume
 * receives the volume that they enclose, in world units cubed; NaN if the triangles are not closed: then an
 * edge has no triangle on its other side that turns the same way. Spheres are left out; lines count as the
 * tubes that they became. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_measure(hl_context *context, const hl_mesh *mesh, double *area,
                                                double *volume, hl_error *error);

HL_API void hl_mesh_retain(hl_mesh *mesh);
HL_API void hl_mesh_release(hl_mesh *mesh); /* null is allowed */

#ifdef __cplusplus
}
#endif
#endif
