/* mesh/polydata_join.c - joins the pieces of a file.
 *
 * In: pieces with arrays of their own. Out: one polydata. Its points are the points of the first piece, then
 * the points of the second piece, and so on. Cells are ordered by kind, and cells of one kind by piece. So
 * values at cells are joined kind by kind. */
#include <string.h>

#include "core/memory.h"
#include "mesh/polydata.h"

/* The state of joining the pieces of a file. */
typedef struct joining {
  polydata *const *pieces; /* [count]; the pieces */
  size_t count;
  polydata *whole;
  hl_error *error;
} joining;

/* Allocates `count` numbers. Returns null if `count` is 0, or if memory is short; in the second case *status
 * says so. */
static double *make_numbers(const joining *join, size_t count, hl_status *status) {
  if (count == 0) return NULL;
  double *made = hl_allocate(join->whole->context, count, sizeof *made);
  if (made == NULL) *status = hl_fail_memory(join->error, count * sizeof *made, join->whole->path);
  return made;
}

static hl_status join_points(const joining *join) {
  hl_status status = HL_OK;
  size_t count = 0;
  for (size_t n = 0; n < join->count; n++) count += join->pieces[n]->point_count;
  double *to = join->whole->points = make_numbers(join, 3 * count, &status);
  if (to == NULL) return status;
  join->whole->point_count = count;
  for (size_t n = 0; n < join->count; n++) {
    polydata *piece = join->pieces[n];
    memcpy(to, piece->points, 3 * piece->point_count * sizeof *to);
    to += 3 * piece->point_count;
    hl_release(piece->context, piece->points);
    piece->points = NULL;
  }
  return HL_OK;
}

/* Joins the cells of a kind. Their indices of points are raised by the number of points in earlier pieces. */
static hl_status join_cells(const joining *join, int kind) {
  hl_status status = HL_OK;
  cells *whole = &join->whole->cells[kind];
  size_t count = 0, point_count = 0, first_point = 0;
  for (size_t n = 0; n < join->count; n++) {
    count += join->pieces[n]->cells[kind].count;
    point_count += join->pieces[n]->cells[kind].point_count;
  }
  whole->ends = make_numbers(join, count, &status);
  if (status == HL_OK) whole->points = make_numbers(join, point_count, &status);
  if (status != HL_OK) return status;
  for (size_t n = 0; n < join->count; first_point += join->pieces[n++]->point_count) {
    const cells *piece = &join->pieces[n]->cells[kind];
    for (size_t i = 0; i < piece->count; i++)
      whole->ends[whole->count + i] = piece->ends[i] + (double)whole->point_count;
    for (size_t i = 0; i < piece->point_count; i++)
      whole->points[whole->point_count + i] = piece->points[i] + (double)first_point;
    whole->count += piece->count;
    whole->point_count += piece->point_count;
  }
  return HL_OK;
}

/* The type of a function that finds one of the arrays of values in a polydata. */
typedef cell_values *find_values(polydata *data);
static cell_values *point_colors(polydata *data) { return &data->colors[AT_POINTS]; }
static cell_values *cell_colors(polydata *data) { return &data->colors[AT_CELLS]; }
static cell_values *normals(polydata *data) { return &data->normals; }
static cell_values *radii(polydata *data) { return &data->radii; }

/* Finds the shape of an array in the pieces that have points or cells for it. Either none of these pieces has
 * the array, or it has the same shape in all of them. */
static hl_status find_shape(const joining *join, find_values *find, value_place place, cell_values *shape) {
  bool first = true, same = true;
  *shape = (cell_values){.type = HL_VOXEL_U8};
  for (size_t n = 0; same && n < join->count; n++) {
    const cell_values *own = find(join->pieces[n]);
    size_t tuples = hl_polydata_tuples(join->pieces[n], place);
    if (tuples == 0) continue;
    size_t components = own->values != NULL ? own->components : 0;
    if (first) shape->components = components, shape->type = own->type;
    same = components == shape->components && (components == 0 || own->type == shape->type);
    shape->tuples += tuples;
    first = false;
  }
  if (same) return HL_OK;
  return hl_fail(join->error, HL_ERROR_INPUT,
                 "%s: its pieces differ in their arrays of colours, normals or radii", join->whole->path);
}

/* Copies the values of some cells, or points, of a piece. */
static void copy_values(const cell_values *piece, size_t first, size_t count, cell_values *whole) {
  size_t width = whole->components;
  if (count > 0)
    memcpy(whole->values + whole->tuples * width, piece->values + first * width,
           count * width * sizeof *whole->values);
  whole->tuples += count;
}

static hl_status join_values(const joining *join, find_values *find, value_place place) {
  hl_status status = HL_OK;
  cell_values *whole = find(join->whole), shape;
  status = find_shape(join, find, place, &shape);
  if (status != HL_OK || shape.components == 0) return status;
  shape.values = make_numbers(join, shape.tuples * shape.components, &status);
  if (status != HL_OK) return status;
  shape.tuples = 0;
  *whole = shape;
  for (int kind = 0; kind < (place == AT_POINTS ? 1 : CELL_KINDS); kind++)
    for (size_t n = 0; n < join->count; n++) {
      const polydata *piece = join->pieces[n];
      size_t first = 0, count = place == AT_POINTS ? piece->point_count : piece->cells[kind].count;
      for (int before = 0; place == AT_CELLS && before < kind; before++) first += piece->cells[before].count;
      copy_values(find(join->pieces[n]), first, count, whole);
    }
  return HL_OK;
}

hl_status hl_polydata_join(polydata *const *pieces, size_t count, polydata *whole, hl_error *error) {
  const joining join = {pieces, count, whole, error};
  hl_status status = HL_OK;
  if (count == 1) {
    *whole = *pieces[0];
    *pieces[0] = (polydata){.context = whole->context, .path = whole->path};
    return HL_OK;
  }
  for (size_t n = 0; status == HL_OK && n < count; n++) {
    status = hl_polydata_check(pieces[n], error);
    whole->flat = whole->flat || pieces[n]->flat;
  }
  if (status == HL_OK) status = join_values(&join, point_colors, AT_POINTS);
  if (status == HL_OK) status = join_values(&join, cell_colors, AT_CELLS);
  if (status == HL_OK) status = join_values(&join, normals, AT_POINTS);
  if (status == HL_OK) status = join_values(&join, radii, AT_POINTS);
  for (int kind = 0; status == HL_OK && kind < CELL_KINDS; kind++) status = join_cells(&join, kind);
  return status == HL_OK ? join_points(&join) : status;
}
