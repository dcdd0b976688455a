/* mesh/polydata.h - reads the content of VTK's PolyData files, and converts it to a mesh. */
#ifndef HL_MESH_POLYDATA_H
#define HL_MESH_POLYDATA_H

#include "mesh/mesh.h"
#include "volume/volume.h"

/* The kinds of cells, in the order in which arrays of cells list their values. */
typedef enum cell_kind { CELLS_VERTICES, CELLS_LINES, CELLS_POLYGONS, CELLS_STRIPS, CELL_KINDS } cell_kind;

typedef struct cells {
  /* owned; [count], rising; for each cell, the end of its points: the index in `points` after its last
   * point */
  double *ends;
  double *points; /* owned; [point_count]; the points of all cells, as indices, one cell after the other */
  size_t count, point_count;
} cells;

/* An array of values at points or at cells. */
typedef struct cell_values {
  double *values; /* owned; [tuples][components]; null if there are no values */
  size_t tuples, components;
  hl_voxel_type type;
} cell_values;

/* Whether values belong to points or to cells. */
typedef enum value_place { AT_POINTS, AT_CELLS, VALUE_PLACES } value_place;

typedef struct polydata {
  hl_context *context;
  const char *path; /* the file's name in errors */
  double *points;   /* owned; [point_count][3]; positions of the points; world units */
  size_t point_count;
  cells cells[CELL_KINDS];
  cell_values colors[VALUE_PLACES]; /* the colours at points and at cells: RGB, RGBA, or scalars */
  cell_values normals, radii;       /* normals and radii at points */
  bool flat;                        /* whether cells have normals; if so, and if points have none, triangles
                                     * show their own normals */
} polydata;

/* Finds the place in `data` for an array's values, by the array's name and shape. Returns null if the mesh
 * does not use the array, or has such an array already. active: whether the array is the file's active
 * scalars, which replace colours that were found before. */
cell_values *hl_polydata_claim(polydata *data, const char *name, const cell_values *shape, value_place place,
                               bool active);

/* The number of points (AT_POINTS) or of cells (AT_CELLS). */
size_t hl_polydata_tuples(const polydata *data, value_place place);

/* Checks that cells name existing points, and that arrays have a value for each point or cell. */
hl_status hl_polydata_check(const polydata *data, hl_error *error);

/* Joins pieces into one whole, which must be empty, and empties the pieces. Points follow points, and cells
 * follow cells of the same kind. Pieces must have the same arrays of values. */
hl_status hl_polydata_join(polydata *const *pieces, size_t count, polydata *whole, hl_error *error);

/* Converts PolyData to the parts of a mesh, which are empty before. Checks cells and arrays first. Polygons
 * and strips become triangles, and vertices become spheres. Lines stay lines, which become tubes later. */
hl_status hl_polydata_to_parts(const polydata *data, mesh_parts *parts, hl_error *error);

void hl_polydata_release(polydata *data);

#endif
