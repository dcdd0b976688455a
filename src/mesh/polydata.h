/* mesh/polydata.h - VTK's PolyData as its files hold them, and the mesh that they make. */
#ifndef HL_MESH_POLYDATA_H
#define HL_MESH_POLYDATA_H

#include "mesh/mesh.h"
#include "volume/volume.h"

/* The kinds of cells, in the order in which arrays of cells list their values. */
typedef enum cell_kind { CELLS_VERTICES, CELLS_LINES, CELLS_POLYGONS, CELLS_STRIPS, CELL_KINDS } cell_kind;

typedef struct cells {
  double *ends;   /* owned; [count]; where each cell's points end in `points`: rising */
  double *points; /* owned; [point_count]; indices of points */
  size_t count, point_count;
} cells;

/* An array of values at points or at cells. */
typedef struct cell_values {
  double *values; /* owned; [tuples][components]; null: none */
  size_t tuples, components;
  hl_voxel_type type;
} cell_values;

/* Where values are. */
typedef enum value_place { AT_POINTS, AT_CELLS, VALUE_PLACES } value_place;

typedef struct polydata {
  hl_context *context;
  const char *path; /* what errors call the file */
  double *points;   /* owned; [point_count][3]; world units */
  size_t point_count;
  cells cells[CELL_KINDS];
  cell_values colors[VALUE_PLACES]; /* RGB, RGBA, or scalars */
  cell_values normals, radii;       /* at points */
  bool flat;                        /* cells have normals: where points have none, triangles show their own */
} polydata;

/* What an array's name and shape make of it: the place in the data where it belongs; null: its values are of
 * no use, or its place is taken. active: the file calls the array its scalars, which displace colours found
 * before. */
cell_values *hl_polydata_claim(polydata *data, const char *name, const cell_values *shape, value_place place,
                               bool active);

/* The number of points, or of cells. */
size_t hl_polydata_tuples(const polydata *data, value_place place);

/* Checks that cells name points that there are, and that arrays have a value for each. */
hl_status hl_polydata_check(const polydata *data, hl_error *error);

/* Joins pieces into one empty whole, points after points and cells after cells of the same kind, and empties
 * them. Pieces must have the same arrays of values. */
hl_status hl_polydata_join(polydata *const *pieces, size_t count, polydata *whole, hl_error *error);

/* Checks cells and arrays, and fills the empty parts: polygons and strips become triangles, vertices spheres,
 * and lines stay lines, which become tubes. */
hl_status hl_polydata_to_parts(const polydata *data, mesh_parts *parts, hl_error *error);

void hl_polydata_release(polydata *data);

#endif
