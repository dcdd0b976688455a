/* mesh/polydata.c - converts VTK's PolyData to the parts of a mesh.
 *
 * The colours of points are taken if there are any, else the colours of cells. Arrays of bytes with three or
 * four components are taken as sRGB, as VTK's mappers do. Other scalars are coloured by the colormap viridis,
 * from their least to their greatest value. Radii of spheres and tubes come from the point array "radius", or
 * else are a fraction of the size of the box around all points. If cells have normals, triangles show their
 * own normals, so that the mesh looks as flat as its cells. */
#include "mesh/polydata.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "image/colormaps.h"
#include "image/srgb.h"
#include "volume/io/text.h"

static bool is_color(const cell_values *shape) {
  return shape->type == HL_VOXEL_U8 && (shape->components == 3 || shape->components == 4);
}

cell_values *hl_polydata_claim(polydata *data, const char *name, const cell_values *shape, value_place place,
                               bool active) {
  cell_values *taken = NULL;
  if (place == AT_POINTS && shape->components == 1 && hl_text_is_one_of(name, "radius|radii|tuberadius"))
    taken = &data->radii;
  else if (place == AT_POINTS && shape->components == 3 && hl_text_equal(name, "normals"))
    taken = &data->normals;
  else if (shape->components == 3 && hl_text_equal(name, "normals")) data->flat = true;
  else if (active || is_color(shape)) taken = &data->colors[place];
  if (taken == NULL || (taken->values != NULL && !active)) return NULL;
  return taken;
}

void hl_polydata_release(polydata *data) {
  void *const arrays[] = {data->points, data->colors[AT_POINTS].values, data->colors[AT_CELLS].values,
                          data->normals.values, data->radii.values};
  for (size_t n = 0; n < sizeof arrays / sizeof *arrays; n++) hl_release(data->context, arrays[n]);
  for (int kind = 0; kind < CELL_KINDS; kind++) {
    hl_release(data->context, data->cells[kind].ends);
    hl_release(data->context, data->cells[kind].points);
  }
  *data = (polydata){.context = data->context, .path = data->path};
}

/* ---- checks ---- */

static hl_status check_cells(const polydata *data, const cells *cells, hl_error *error) {
  double before = 0;
  for (size_t n = 0; n < cells->count; n++) {
    if (!(cells->ends[n] >= before && cells->ends[n] <= (double)cells->point_count) ||
        cells->ends[n] != floor(cells->ends[n]))
      return hl_fail(error, HL_ERROR_INPUT, "%s: cell %zu ends at point %.9g of %zu", data->path, n,
                     cells->ends[n], cells->point_count);
    before = cells->ends[n];
  }
  for (size_t n = 0; n < cells->point_count; n++)
    if (!(cells->points[n] >= 0 && cells->points[n] < (double)data->point_count) ||
        cells->points[n] != floor(cells->points[n]))
      return hl_fail(error, HL_ERROR_INPUT, "%s: a cell names point %.9g: there are %zu, counted from 0",
                     data->path, cells->points[n], data->point_count);
  return HL_OK;
}

size_t hl_polydata_tuples(const polydata *data, value_place place) {
  size_t count = 0;
  if (place == AT_POINTS) return data->point_count;
  for (int kind = 0; kind < CELL_KINDS; kind++) count += data->cells[kind].count;
  return count;
}

static hl_status check_values(const polydata *data, const cell_values *values, size_t tuples,
                              hl_error *error) {
  if (values->values == NULL || values->tuples == tuples) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s: an array has %zu values, and there are %zu points or cells",
                 data->path, values->tuples, tuples);
}

hl_status hl_polydata_check(const polydata *data, hl_error *error) {
  hl_status status = HL_OK;
  if (data->point_count > UINT32_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: has %zu points: at most %u are read: reduce them",
                   data->path, data->point_count, UINT32_MAX);
  for (int kind = 0; status == HL_OK && kind < CELL_KINDS; kind++)
    status = check_cells(data, &data->cells[kind], error);
  const cell_values *at_points[] = {&data->colors[AT_POINTS], &data->normals, &data->radii};
  for (int n = 0; status == HL_OK && n < 3; n++)
    status = check_values(data, at_points[n], data->point_count, error);
  return status == HL_OK
             ? check_values(data, &data->colors[AT_CELLS], hl_polydata_tuples(data, AT_CELLS), error)
             : status;
}

/* ---- colours ---- */

static void color_of_scalars(const cell_values *values, float (*colors)[4]) {
  double low = INFINITY, high = -INFINITY;
  for (size_t n = 0; n < values->tuples; n++) {
    double value = values->values[n * values->components];
    if (isfinite(value)) low = fmin(low, value), high = fmax(high, value);
  }
  for (size_t n = 0; n < values->tuples; n++) {
    double value = values->values[n * values->components], linear[3];
    double t = high > low && isfinite(value) ? (value - low) / (high - low) : 0;
    hl_colormap_evaluate("viridis", t, linear);
    for (int c = 0; c < 3; c++) colors[n][c] = (float)linear[c];
    colors[n][3] = 1;
  }
}

static void color_of_bytes(const cell_values *values, float (*colors)[4]) {
  for (size_t n = 0; n < values->tuples; n++) {
    const double *value = values->values + n * values->components;
    for (int c = 0; c < 3; c++) colors[n][c] = (float)hl_srgb_decode(value[c] / 255);
    colors[n][3] = values->components == 4 ? (float)(value[3] / 255) : 1;
  }
}

/* Makes the colours of all points or cells. *colors is owned by the caller; it is null if the file has no
 * colours. */
static hl_status make_colors(const polydata *data, const cell_values *values, float (**colors)[4],
                             hl_error *error) {
  *colors = NULL;
  if (values->values == NULL || values->tuples == 0) return HL_OK;
  *colors = hl_allocate(data->context, values->tuples, sizeof **colors);
  if (*colors == NULL) return hl_fail_memory(error, values->tuples * sizeof **colors, data->path);
  if (is_color(values)) color_of_bytes(values, *colors);
  else color_of_scalars(values, *colors);
  return HL_OK;
}

/* ---- parts ---- */

/* The state of the conversion of PolyData to the parts of a mesh. */
typedef struct conversion {
  const polydata *data;
  mesh_parts *parts;
  float (*colors)[4]; /* the colours of the points or, if points have no colours, of the cells; null if cells
                         have no colours either */
  bool of_points;
  size_t first_cell[CELL_KINDS]; /* for each kind of cells, its first cell's index among the cells of all
                                  * kinds */
  double radius;                 /* the radius of spheres and tubes if the file gives no radius */
  hl_error *error;
} conversion;

static size_t begin_of(const cells *cells, size_t n) { return n > 0 ? (size_t)cells->ends[n - 1] : 0; }

/* The colour of a point, or of the cell that uses the point; null if there are no colours. */
static const float *color_of(const conversion *c, size_t point, size_t cell) {
  if (c->colors == NULL) return NULL;
  return c->colors[c->of_points ? point : cell];
}

/* Writes a point and its radius as four numbers. */
static void round_point(const conversion *c, size_t point, float to[4]) {
  for (int i = 0; i < 3; i++) to[i] = (float)c->data->points[3 * point + (size_t)i];
  to[3] = (float)(c->data->radii.values != NULL ? c->data->radii.values[point] : c->radius);
}

/* Allocates arrays for points with radii, and for their colours if there are any. */
static bool make_round(const conversion *c, size_t count, float (**points)[4], float (**colors)[4]) {
  if (count == 0) return true;
  *points = hl_allocate(c->data->context, count, sizeof **points);
  if (c->colors != NULL) *colors = hl_allocate(c->data->context, count, sizeof **colors);
  return *points != NULL && (c->colors == NULL || *colors != NULL);
}

/* Converts the points of all cells of a kind to spheres or lines, one cell after the other. */
static hl_status convert_round(const conversion *c, cell_kind kind, size_t most, float (**points)[4],
                               float (**colors)[4]) {
  const cells *cells = &c->data->cells[kind];
  size_t count = cells->count > 0 ? (size_t)cells->ends[cells->count - 1] : 0;
  if (count > most)
    return hl_fail(c->error, HL_ERROR_UNSUPPORTED,
                   "%s: has %zu points of lines or vertices: at most %zu are read: reduce them",
                   c->data->path, count, most);
  if (!make_round(c, count, points, colors))
    return hl_fail_memory(c->error, count * sizeof **points, c->data->path);
  for (size_t n = 0; n < cells->count; n++)
    for (size_t i = begin_of(cells, n); i < (size_t)cells->ends[n]; i++) {
      size_t point = (size_t)cells->points[i];
      round_point(c, point, (*points)[i]);
      if (c->colors != NULL)
        memcpy((*colors)[i], color_of(c, point, c->first_cell[kind] + n), sizeof **colors);
    }
  return HL_OK;
}

static hl_status convert_vertices(const conversion *c) {
  const cells *cells = &c->data->cells[CELLS_VERTICES];
  hl_status status = convert_round(c, CELLS_VERTICES, HL_LIMIT_SPHERES, &c->parts->spheres,
                                   &c->parts->sphere_colors);
  if (status == HL_OK && cells->count > 0) c->parts->sphere_count = (size_t)cells->ends[cells->count - 1];
  return status;
}

static hl_status convert_lines(const conversion *c) {
  const cells *cells = &c->data->cells[CELLS_LINES];
  mesh_parts *parts = c->parts;
  hl_status status = convert_round(c, CELLS_LINES, HL_LIMIT_LINE_POINTS, &parts->line_points,
                                   &parts->line_colors);
  if (status != HL_OK || cells->count == 0) return status;
  parts->line_lengths = hl_allocate(parts->context, cells->count, sizeof *parts->line_lengths);
  if (parts->line_lengths == NULL)
    return hl_fail_memory(c->error, cells->count * sizeof *parts->line_lengths, c->data->path);
  for (size_t n = 0; n < cells->count; n++)
    parts->line_lengths[n] = (uint32_t)((size_t)cells->ends[n] - begin_of(cells, n));
  parts->line_count = cells->count;
  parts->line_point_count = (size_t)cells->ends[cells->count - 1];
  return HL_OK;
}

/* Adds the triangles of cell n: a fan, or a strip whose every second triangle is turned over. */
static hl_status add_cell(const conversion *c, const cells *cells, size_t n, bool strip) {
  hl_status status = HL_OK;
  size_t begin = begin_of(cells, n), end = (size_t)cells->ends[n];
  for (size_t last = begin + 2; status == HL_OK && last < end; last++) {
    size_t a = strip ? last - 2 : begin, b = last - 1;
    bool turned = strip && (last - begin) % 2 == 1;
    status = hl_mesh_add_triangle(c->parts, (uint32_t)cells->points[turned ? b : a],
                                  (uint32_t)cells->points[turned ? a : b], (uint32_t)cells->points[last],
                                  c->error);
  }
  return status;
}

/* Gives the colour of a cell to the triangles from number `before` on. */
static void color_faces(const conversion *c, size_t before, size_t cell) {
  for (size_t t = before; t < c->parts->triangle_count; t++)
    memcpy(c->parts->face_colors[t], c->colors[cell], sizeof *c->parts->face_colors);
}

static hl_status convert_faces(const conversion *c, cell_kind kind) {
  const cells *cells = &c->data->cells[kind];
  hl_status status = HL_OK;
  for (size_t n = 0; status == HL_OK && n < cells->count; n++) {
    size_t before = c->parts->triangle_count;
    status = add_cell(c, cells, n, kind == CELLS_STRIPS);
    if (status == HL_OK && kind == CELLS_POLYGONS) status = hl_mesh_note_polygon(c->parts, before, c->error);
    if (c->parts->face_colors != NULL) color_faces(c, before, c->first_cell[kind] + n);
  }
  return status;
}

/* The number of triangles that polygons or strips make. */
static size_t triangle_count(const cells *cells) {
  size_t count = 0;
  for (size_t n = 0; n < cells->count; n++) {
    size_t points = (size_t)cells->ends[n] - begin_of(cells, n);
    count += points > 2 ? points - 2 : 0;
  }
  return count;
}

/* Makes the vertices of a mesh's triangles from the points of PolyData. */
static hl_status convert_points(const conversion *c) {
  const polydata *data = c->data;
  mesh_parts *parts = c->parts;
  bool normals = data->normals.values != NULL, flat = data->flat && !normals,
       colors = c->colors != NULL && c->of_points;
  hl_status status = hl_mesh_reserve_vertices(parts, data->point_count, normals || flat, colors, c->error);
  if (status != HL_OK) return status;
  for (size_t p = 0; p < data->point_count; p++)
    for (size_t i = 0; i < 3; i++) {
      parts->positions[p][i] = (float)data->points[3 * p + i];
      if (normals) parts->normals[p][i] = (float)data->normals.values[3 * p + i];
    }
  /* a zero normal means that triangles show their own normals */
  if (flat) memset(parts->normals, 0, data->point_count * sizeof *parts->normals);
  if (colors) memcpy(parts->colors, c->colors, data->point_count * sizeof *parts->colors);
  parts->vertex_count = data->point_count;
  return HL_OK;
}

static hl_status convert_surface(const conversion *c) {
  const cells *polygons = &c->data->cells[CELLS_POLYGONS], *strips = &c->data->cells[CELLS_STRIPS];
  size_t count = triangle_count(polygons) + triangle_count(strips);
  if (count == 0) return HL_OK;
  hl_status status = convert_points(c);
  if (status == HL_OK && c->colors != NULL && !c->of_points) {
    c->parts->face_colors = hl_allocate(c->data->context, count, sizeof *c->parts->face_colors);
    if (c->parts->face_colors == NULL)
      status = hl_fail_memory(c->error, count * sizeof *c->parts->face_colors, c->data->path);
  }
  if (status == HL_OK) status = hl_mesh_reserve_triangles(c->parts, count, c->error);
  if (status == HL_OK) status = convert_faces(c, CELLS_POLYGONS);
  return status == HL_OK ? convert_faces(c, CELLS_STRIPS) : status;
}

/* The radius of spheres and tubes for files that give none; world units. */
static double usual_radius(const polydata *data) {
  double low[3], high[3];
  for (size_t axis = 0; axis < 3; axis++) {
    low[axis] = INFINITY, high[axis] = -INFINITY;
    for (size_t p = 0; p < data->point_count; p++) {
      double at = data->points[3 * p + axis];
      if (isfinite(at)) low[axis] = fmin(low[axis], at), high[axis] = fmax(high[axis], at);
    }
  }
  return hl_mesh_usual_radius(low, high);
}

hl_status hl_polydata_to_parts(const polydata *data, mesh_parts *parts, hl_error *error) {
  conversion c = {.data = data, .parts = parts, .radius = usual_radius(data), .error = error};
  c.of_points = data->colors[AT_POINTS].values != NULL;
  for (int kind = 1; kind < CELL_KINDS; kind++)
    c.first_cell[kind] = c.first_cell[kind - 1] + data->cells[kind - 1].count;
  hl_status status = hl_polydata_check(data, error);
  if (status == HL_OK)
    status = make_colors(data, &data->colors[c.of_points ? AT_POINTS : AT_CELLS], &c.colors, error);
  if (status == HL_OK) status = convert_surface(&c);
  if (status == HL_OK) status = convert_vertices(&c);
  if (status == HL_OK) status = convert_lines(&c);
  hl_release(data->context, c.colors);
  return status;
}
