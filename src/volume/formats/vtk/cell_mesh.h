/* volume/formats/vtk/cell_mesh.h - collects a mesh of VTK's cells, piece by piece, and makes a volume of the
 * mesh. */
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
  hl_cell *cells;      /* owned; [cell_count]; the cells that enclose a volume */
  size_t *sources;     /* owned; [cell_count]; for each cell, the index in the piece of the file's cell from
                        * which it was made */
  size_t point_count, cell_count, cell_room;
  size_t first_point, first_cell;    /* indices of the first point and the first cell of the current piece */
  size_t left_out, flat, simplified; /* left_out: number of cells of kinds that are not read; flat: number of
                                      * cells without a volume; simplified: number of cells whose curved edges
                                      * became straight */
} hl_cell_mesh;

/* Chooses the array and the component to read, for a grid of cells whose arrays are listed in the request.
 * active: index of the array that the file marks as active; -1 if the file marks none. path: starts error
 * lines. */
hl_status hl_cell_mesh_choose(hl_load_request *request, const char *path, int active, hl_error *error);

/* Begins a piece with `count` points, whose coordinates are copied. points: [count][3]. */
hl_status hl_cell_mesh_begin_piece(hl_cell_mesh *mesh, const double *points, size_t count, hl_error *error);

/* Adds the piece's cells. types: [count]; VTK's numbers of the cells' types. corners: [corner_count]; indices
 * of the piece's points, from 0, cell after cell. ends: [count]; for each cell, the index in `corners` after
 * the cell's last corner. */
hl_status hl_cell_mesh_add_cells(hl_cell_mesh *mesh, const double *types, const double *ends, size_t count,
                                 const double *corners, size_t corner_count, hl_error *error);

/* Adds the hexahedra of a piece whose points are a curvilinear grid, [size[2]][size[1]][size[0]]. */
hl_status hl_cell_mesh_add_grid(hl_cell_mesh *mesh, const size_t size[3], hl_error *error);

/* Sets the values of the current piece's points. values: [count][components]; component: an index, or
 * HL_COMPONENT_MAGNITUDE. of_cells: whether values belong to the piece's cells instead of its points; then
 * the value of a point is the mean value of the cells around the point. */
hl_status hl_cell_mesh_set_values(hl_cell_mesh *mesh, const double *values, size_t count, size_t components,
                                  int component, bool of_cells, hl_error *error);

/* Makes the volume, and warns about cells that were left out or simplified. */
hl_status hl_cell_mesh_finish(hl_cell_mesh *mesh, hl_volume **volume, hl_error *error);
void hl_cell_mesh_release(hl_cell_mesh *mesh);

/* Returns whether VTK's number of a cell type stands for cells that enclose a volume and can be read. */
bool hl_cell_kind_is_read(double type);

#endif
