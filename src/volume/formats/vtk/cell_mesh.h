/* volume/formats/vtk/cell_mesh.h - collects a mesh of cells in VTK's terms, piece by piece, and makes a
 * volume of it. */
#ifndef HL_VOLUME_CELL_MESH_H
#define HL_VOLUME_CELL_MESH_H

#include "bricks/cells.h"
#include "volume/formats/format.h"
#include "volume/volume.h"

typedef struct hl_cell_mesh {
  hl_context *context;
  const char *subject; /* borrowed; starts error lines */
  double *points;      /* owned; [point_count][3] */
  float *values;       /* owned; [point_count]; NaN until they are set */
  hl_cell *cells;      /* owned; [cell_count]; those with a volume */
  size_t *sources;     /* owned; [cell_count]; for each cell, the number of the piece's cell from which it
                        * was made */
  size_t point_count, cell_count, cell_room;
  size_t first_point, first_cell;    /* numbers of the first point and the first cell of the piece that was
                                      * begun last */
  size_t left_out, flat, simplified; /* numbers of cells that were left out because of their kind, cells
                                      * that enclose no volume, and cells whose edges were curved */
} hl_cell_mesh;

/* Chooses the array and the component of a grid of cells, whose arrays are listed. active: the array that the
 * file calls active; -1: none. path: starts error lines. */
hl_status hl_cell_mesh_choose(hl_load_request *request, const char *path, int active, hl_error *error);

/* Begins a piece with `count` points, whose coordinates are copied. points: [count][3]. */
hl_status hl_cell_mesh_begin_piece(hl_cell_mesh *mesh, const double *points, size_t count, hl_error *error);

/* Adds the piece's cells. types: VTK's numbers, [count]; ends: the end of each cell's corners, [count];
 * corners: numbers of the piece's points, counted from 0, [corner_count]. */
hl_status hl_cell_mesh_add_cells(hl_cell_mesh *mesh, const double *types, const double *ends, size_t count,
                                 const double *corners, size_t corner_count, hl_error *error);

/* Adds the hexahedra of a piece whose points are a curvilinear grid, [size[2]][size[1]][size[0]]. */
hl_status hl_cell_mesh_add_grid(hl_cell_mesh *mesh, const size_t size[3], hl_error *error);

/* Sets the piece's values. values: [count][components]; component: an index, or HL_COMPONENT_MAGNITUDE.
 * of_cells: there is one value for each of the piece's cells, and a point gets the mean of the cells around
 * it. */
hl_status hl_cell_mesh_set_values(hl_cell_mesh *mesh, const double *values, size_t count, size_t components,
                                  int component, bool of_cells, hl_error *error);

/* Makes the volume, and tells in warnings what was left out. */
hl_status hl_cell_mesh_finish(hl_cell_mesh *mesh, hl_volume **volume, hl_error *error);
void hl_cell_mesh_release(hl_cell_mesh *mesh);

/* Whether a number of VTK's stands for a kind of cell that encloses a volume and can be read. */
bool hl_cell_kind_is_read(double type);

#endif
