/* volume/formats/vtk/cell_mesh.c - collects a mesh of cells, as cell_mesh.h describes. Source of the cell
 * types and of the order of their points: VTK's file formats, "Linear cell types", and VTK's list of cell
 * types. */
#include "volume/formats/vtk/cell_mesh.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/in_bricks.h"

/* ---- kinds of cells ---- */

enum { TYPES = 82 };

/* A kind of cell. corner: the indices of the cell's points that become corners of a hexahedron or a
 * tetrahedron. */
typedef struct cell_kind {
  signed char points;                  /* least number of points of a cell of this type; 0 if the type is not
                                        * read */
  bool is_curved, is_flat;             /* is_flat: whether the cell is a vertex, a line or a face */
  signed char corner[HL_CELL_CORNERS]; /* -1 for the corners that a tetrahedron does not have */
} cell_kind;

#define TETRA \
  { 0, 1, 2, 3, -1, -1, -1, -1 }
#define HEXA \
  { 0, 1, 2, 3, 4, 5, 6, 7 }
#define VOXEL \
  { 0, 1, 3, 2, 4, 5, 7, 6 }
#define WEDGE \
  { 0, 1, 2, 2, 3, 4, 5, 5 }
#define PYRAMID \
  { 0, 1, 2, 3, 4, 4, 4, 4 }

static const cell_kind *kind_of(double type) {
  static const cell_kind none = {0};
  static const cell_kind flat = {.is_flat = true};
  static const cell_kind kinds[TYPES] = {
      [10] = {4, false, false, TETRA}, [11] = {8, false, false, VOXEL},   [12] = {8, false, false, HEXA},
      [13] = {6, false, false, WEDGE}, [14] = {5, false, false, PYRAMID}, [24] = {10, true, false, TETRA},
      [25] = {20, true, false, HEXA},  [26] = {15, true, false, WEDGE},   [27] = {13, true, false, PYRAMID},
      [29] = {27, true, false, HEXA},  [31] = {12, true, false, WEDGE},   [32] = {18, true, false, WEDGE},
      [33] = {24, true, false, HEXA},  [71] = {4, true, false, TETRA},    [72] = {8, true, false, HEXA},
      [73] = {6, true, false, WEDGE},  [74] = {5, true, false, PYRAMID},  [78] = {4, true, false, TETRA},
      [79] = {8, true, false, HEXA},   [80] = {6, true, false, WEDGE},    [81] = {5, true, false, PYRAMID},
  };
  if (!(type >= 0 && type < TYPES) || type != floor(type)) return &none;
  int number = (int)type;
  bool is_flat = number <= 9 || (number >= 21 && number <= 23) || number == 28 || number == 30 ||
                 (number >= 34 && number <= 36) || (number >= 68 && number <= 70) ||
                 (number >= 75 && number <= 77);
  return is_flat ? &flat : &kinds[number];
}

bool hl_cell_kind_is_read(double type) { return kind_of(type)->points > 0; }

/* ---- pieces ---- */

hl_status hl_cell_mesh_begin_piece(hl_cell_mesh *mesh, const double *points, size_t count, hl_error *error) {
  size_t total, numbers;
  if (__builtin_add_overflow(mesh->point_count, count, &total) || total >= UINT32_MAX ||
      !hl_multiply(total, 3, &numbers))
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than 2^32 points: extract a part of them",
                   mesh->subject);
  double *grown = hl_reallocate(mesh->context, mesh->points, numbers, sizeof *grown);
  if (grown != NULL) mesh->points = grown;
  float *values = hl_reallocate(mesh->context, mesh->values, total, sizeof *values);
  if (values != NULL) mesh->values = values;
  if (grown == NULL || values == NULL) return hl_fail_memory(error, numbers * sizeof *grown, mesh->subject);
  memcpy(mesh->points + 3 * mesh->point_count, points, 3 * count * sizeof *points);
  for (size_t n = mesh->point_count; n < total; n++) mesh->values[n] = NAN;
  mesh->first_point = mesh->point_count;
  mesh->first_cell = mesh->cell_count;
  mesh->point_count = total;
  return HL_OK;
}

static hl_status add_cell(hl_cell_mesh *mesh, const hl_cell *cell, size_t source, hl_error *error) {
  if (mesh->cell_count == mesh->cell_room) {
    size_t room = 2 * mesh->cell_room + 1024;
    hl_cell *cells = hl_reallocate(mesh->context, mesh->cells, room, sizeof *cells);
    if (cells != NULL) mesh->cells = cells;
    size_t *sources = hl_reallocate(mesh->context, mesh->sources, room, sizeof *sources);
    if (sources != NULL) mesh->sources = sources;
    if (cells == NULL || sources == NULL) return hl_fail_memory(error, room * sizeof *cells, mesh->subject);
    mesh->cell_room = room;
  }
  mesh->cells[mesh->cell_count] = *cell;
  mesh->sources[mesh->cell_count++] = source;
  return HL_OK;
}

hl_status hl_cell_mesh_add_cells(hl_cell_mesh *mesh, const double *types, const double *ends, size_t count,
                                 const double *corners, size_t corner_count, hl_error *error) {
  double points = (double)(mesh->point_count - mesh->first_point), begin = 0;
  hl_status status = HL_OK;
  for (size_t n = 0; n < count && status == HL_OK; n++) {
    const cell_kind *kind = kind_of(types[n]);
    hl_cell cell;
    if (!(ends[n] >= begin && ends[n] <= (double)corner_count) || ends[n] != floor(ends[n]) ||
        ends[n] - begin < kind->points)
      return hl_fail(error, HL_ERROR_INPUT, "%s: cell %zu ends at point %.9g of %zu, or has too few points",
                     mesh->subject, n, ends[n], corner_count);
    for (int c = 0; c < HL_CELL_CORNERS && kind->points > 0; c++) {
      double corner = kind->corner[c] < 0 ? UINT32_MAX : corners[(size_t)begin + (size_t)kind->corner[c]];
      if (kind->corner[c] >= 0 && !(corner >= 0 && corner < points))
        return hl_fail(error, HL_ERROR_INPUT, "%s: a cell names point %.9g: there are %.0f, counted from 0",
                       mesh->subject, corner, points);
      cell.corner[c] = kind->corner[c] < 0 ? UINT32_MAX : (uint32_t)(mesh->first_point + (size_t)corner);
    }
    begin = ends[n];
    mesh->simplified += kind->points > 0 && kind->is_curved;
    mesh->flat += kind->is_flat;
    mesh->left_out += kind->points == 0 && !kind->is_flat;
    if (kind->points > 0) status = add_cell(mesh, &cell, n, error);
  }
  return status;
}

hl_status hl_cell_mesh_add_grid(hl_cell_mesh *mesh, const size_t size[3], hl_error *error) {
  static const size_t place[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  hl_status status = HL_OK;
  size_t number = 0;
  for (size_t k = 0; k + 1 < size[2] && status == HL_OK; k++)
    for (size_t j = 0; j + 1 < size[1] && status == HL_OK; j++)
      for (size_t i = 0; i + 1 < size[0] && status == HL_OK; i++) {
        hl_cell cell;
        for (int c = 0; c < 8; c++)
          cell.corner[c] = (uint32_t)(mesh->first_point +
                                      ((k + place[c][2]) * size[1] + j + place[c][1]) * size[0] + i +
                                      place[c][0]);
        status = add_cell(mesh, &cell, number++, error);
      }
  return status;
}

/* ---- arrays ---- */

hl_status hl_cell_mesh_choose(hl_load_request *request, const char *path, int active, hl_error *error) {
  hl_payload payload;
  if (request->array_count == 0)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: the grid has no values: neither its points nor its cells have an array", path);
  if (request->spacing[0] > 0)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: a grid of cells has places of its own: leave \"spacing\" (--spacing) out", path);
  hl_status status = hl_arrays_choose(request, path, active, error);
  if (status != HL_OK) return status;
  hl_payload_defaults(&payload);
  payload.components = request->arrays[request->chosen].components;
  payload.colors = HL_COLORS_UNREAD;
  payload.grid.type = request->arrays[request->chosen].type;
  return hl_component_choose(request, path, false, &payload, error);
}

/* ---- values ---- */

static double component_of(const double *values, size_t components, int component) {
  double sum = 0;
  if (component != HL_COMPONENT_MAGNITUDE) return values[component];
  for (size_t n = 0; n < components; n++) sum += values[n] * values[n];
  return sqrt(sum);
}

/* Sets the value of each of the piece's points to the mean value of the cells around the point. */
static hl_status spread(hl_cell_mesh *mesh, const double *values, size_t count, size_t components,
                        int component, hl_error *error) {
  size_t points = mesh->point_count - mesh->first_point;
  double *sums = hl_allocate_zeroed(mesh->context, points, sizeof *sums);
  uint32_t *counts = hl_allocate_zeroed(mesh->context, points, sizeof *counts);
  hl_status status = sums != NULL && counts != NULL
                         ? HL_OK
                         : hl_fail_memory(error, points * sizeof *sums, mesh->subject);
  for (size_t n = mesh->first_cell; n < mesh->cell_count && status == HL_OK; n++) {
    const hl_cell *cell = &mesh->cells[n];
    if (mesh->sources[n] >= count) continue;
    double value = component_of(values + mesh->sources[n] * components, components, component);
    for (int c = 0; c < HL_CELL_CORNERS; c++) {
      if (cell->corner[c] == UINT32_MAX || (c > 0 && cell->corner[c] == cell->corner[c - 1])) continue;
      sums[cell->corner[c] - mesh->first_point] += value;
      counts[cell->corner[c] - mesh->first_point]++;
    }
  }
  for (size_t n = 0; n < points && status == HL_OK; n++)
    mesh->values[mesh->first_point + n] = counts[n] > 0 ? (float)(sums[n] / counts[n]) : NAN;
  hl_release(mesh->context, sums);
  hl_release(mesh->context, counts);
  return status;
}

hl_status hl_cell_mesh_set_values(hl_cell_mesh *mesh, const double *values, size_t count, size_t components,
                                  int component, bool of_cells, hl_error *error) {
  if (of_cells) return spread(mesh, values, count, components, component, error);
  for (size_t n = 0; n < count && mesh->first_point + n < mesh->point_count; n++)
    mesh->values[mesh->first_point + n] = (float)component_of(values + n * components, components, component);
  return HL_OK;
}

/* ---- all steps together ---- */

/* The distance in voxels, across a wall, over which the fraction of matter rises from 0 to 1. */
static const double WALL_WIDTH = 1;

static void tell(const hl_cell_mesh *mesh) {
  if (mesh->simplified > 0)
    hl_log(mesh->context, HL_LOG_WARNING, "%s: %zu cells with curved edges are read by their corners alone",
           mesh->subject, mesh->simplified);
  if (mesh->left_out > 0)
    hl_log(mesh->context, HL_LOG_WARNING,
           "%s: %zu cells of kinds that are not read (polyhedra and others) are left out", mesh->subject,
           mesh->left_out);
  if (mesh->flat > 0)
    hl_log(mesh->context, HL_LOG_WARNING, "%s: %zu cells without a volume (faces, lines) are left out",
           mesh->subject, mesh->flat);
}

static void tell_difference(const hl_cell_mesh *mesh, double bound) {
  if (isnan(bound))
    hl_log(mesh->context, HL_LOG_WARNING,
           "%s: %zu cells are sampled, at about half of an edge: the mesh is so thin that the volume's "
           "difference "
           "from the values between their corners is unknown",
           mesh->subject, mesh->cell_count);
  else
    hl_log(mesh->context, HL_LOG_WARNING,
           "%s: %zu cells are sampled, at about half of an edge: the volume differs from the values between "
           "their corners by %.2g at most",
           mesh->subject, mesh->cell_count, bound);
}

/* Stores in the volume the field that is continued beyond the walls, and the depths behind the walls. grid:
 * the volume's grid. */
static hl_status keep_wall(const hl_cell_mesh *mesh, hl_cells_wall *wall, const hl_volume_description *grid,
                           hl_volume *volume, hl_error *error) {
  hl_volume_description wide = *grid;
  if (wall->depth == NULL) return HL_OK;
  for (int axis = 0; axis < 3; axis++) {
    wide.dimensions[axis] += 2 * HL_CELLS_MARGIN;
    wide.origin[axis] -= HL_CELLS_MARGIN * wide.axis[axis][axis];
  }
  hl_status status = hl_volume_take_bricks(mesh->context, &wall->bricks, &wide, mesh->subject,
                                           &volume->continued, error);
  if (status != HL_OK) return status;
  wide.type = HL_VOXEL_U16;
  wide.value_scale = (HL_WALL_OUTSIDE + HL_WALL_INSIDE) / WALL_WIDTH / UINT16_MAX;
  wide.value_offset = 0.5 - HL_WALL_OUTSIDE / WALL_WIDTH;
  uint16_t *depth = wall->depth;
  wall->depth = NULL;
  status = hl_volume_adopt(mesh->context, &wide, mesh->subject, depth, &volume->wall, error);
  if (status == HL_OK) volume->wall->slope_scale = 1 / WALL_WIDTH / INT8_MAX;
  return status;
}

hl_status hl_cell_mesh_finish(hl_cell_mesh *mesh, hl_volume **volume, hl_error *error) {
  const hl_cells cells = {mesh->points, mesh->values, mesh->point_count, mesh->cells, mesh->cell_count};
  hl_bricks bricks = {.shift = 0};
  hl_cells_wall wall;
  hl_cells_place place;
  hl_volume_description grid;
  hl_pool *pool = NULL;
  tell(mesh);
  hl_status status = hl_pool_create(mesh->context, 0, &pool, error);
  if (status == HL_OK)
    status = hl_cells_build(mesh->context, pool, &cells, mesh->subject, &bricks, &wall, &place, error);
  hl_pool_destroy(pool);
  if (status != HL_OK) return status;
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_F32;
  for (int axis = 0; axis < 3; axis++) {
    grid.dimensions[axis] = bricks.dimension[axis] - 2 * HL_CELLS_MARGIN;
    grid.origin[axis] = place.origin[axis] + HL_CELLS_MARGIN * place.spacing[axis];
    grid.axis[axis][axis] = place.spacing[axis];
  }
  tell_difference(mesh, place.error);
  status = hl_volume_take_bricks(mesh->context, &bricks, &grid, mesh->subject, volume, error);
  if (status == HL_OK) status = keep_wall(mesh, &wall, &grid, *volume, error);
  hl_cells_wall_release(mesh->context, &wall);
  if (status != HL_OK) {
    hl_volume_release(*volume);
    *volume = NULL;
    return status;
  }
  hl_volume_set_field_error(*volume, place.error, "bound", "the values between the corners of the cells");
  return HL_OK;
}

void hl_cell_mesh_release(hl_cell_mesh *mesh) {
  hl_release(mesh->context, mesh->points);
  hl_release(mesh->context, mesh->values);
  hl_release(mesh->context, mesh->cells);
  hl_release(mesh->context, mesh->sources);
  *mesh = (hl_cell_mesh){.context = mesh->context};
}
