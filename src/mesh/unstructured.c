/* mesh/unstructured.c - converts the cells of unstructured grids (unstructured.h). Sources of the types of
 * cells and of the order of their points: VTK's file formats, "Linear cell types", and its list of cell
 * types. */
#include "mesh/unstructured.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

enum { FACES_MOST = 6, FACE_CORNERS = 4, TYPES = 43 };

/* The properties of a type of cell of an unstructured grid. faces: the faces of a cell with a volume,
 * counter-clockwise as seen from outside; -1 stands for no corner. */
typedef struct cell_type {
  signed char kind;    /* a kind of PolyData's cells; VOLUME: the type encloses a volume; NONE: the type is
                        * not shown */
  signed char corners; /* number of corners; if 0, the number differs between cells of the type */
  signed char faces[FACES_MOST][FACE_CORNERS];
} cell_type;

enum { NONE = -1, VOLUME = CELL_KINDS };

#define TETRAHEDRON                                                          \
  {                                                                          \
    {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}, {0, 2, 1, -1}, {-1}, { -1 } \
  }
#define VOXEL                                                                            \
  {                                                                                      \
    {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, { 4, 5, 7, 6 } \
  }
#define HEXAHEDRON                                                                       \
  {                                                                                      \
    {0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, { 4, 5, 6, 7 } \
  }
#define WEDGE                                                                      \
  {                                                                                \
    {0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}, { -1 } \
  }
#define PYRAMID                                                                      \
  {                                                                                  \
    {0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}, { -1 } \
  }
#define FLAT                             \
  {                                      \
    {-1}, {-1}, {-1}, {-1}, {-1}, { -1 } \
  }

static const cell_type *type_of(double number) {
  static const cell_type none = {NONE, 0, FLAT};
  static const cell_type types[TYPES] = {
      [0] = {NONE, 0, FLAT},
      [1] = {CELLS_VERTICES, 1, FLAT},
      [2] = {CELLS_VERTICES, 0, FLAT},
      [3] = {CELLS_LINES, 2, FLAT},
      [4] = {CELLS_LINES, 0, FLAT},
      [5] = {CELLS_POLYGONS, 3, FLAT},
      [6] = {CELLS_STRIPS, 0, FLAT},
      [7] = {CELLS_POLYGONS, 0, FLAT},
      [8] = {CELLS_POLYGONS, 4, FLAT}, /* VTK's pixel, a rectangle whose last two corners must be swapped */
      [9] = {CELLS_POLYGONS, 4, FLAT},
      [10] = {VOLUME, 4, TETRAHEDRON},
      [11] = {VOLUME, 8, VOXEL},
      [12] = {VOLUME, 8, HEXAHEDRON},
      [13] = {VOLUME, 6, WEDGE},
      [14] = {VOLUME, 5, PYRAMID},
      [21] = {CELLS_LINES, 2, FLAT},
      [22] = {CELLS_POLYGONS, 3, FLAT},
      [23] = {CELLS_POLYGONS, 4, FLAT},
      [24] = {VOLUME, 4, TETRAHEDRON},
      [25] = {VOLUME, 8, HEXAHEDRON},
      [26] = {VOLUME, 6, WEDGE},
      [27] = {VOLUME, 5, PYRAMID},
      [28] = {CELLS_POLYGONS, 4, FLAT},
      [29] = {VOLUME, 8, HEXAHEDRON},
      [34] = {CELLS_POLYGONS, 3, FLAT},
  };
  bool known = number >= 0 && number < TYPES && number == floor(number);
  if (!known) return &none;
  bool listed = number >= 1 &&
                /* members left out of the table are zero */
                (types[(int)number].kind != CELLS_VERTICES || number <= 2);
  return listed ? &types[(int)number] : &none;
}

/* ---- faces that one cell alone has ---- */

/* A face of a cell that encloses a volume. */
typedef struct grid_face {
  double corner[FACE_CORNERS]; /* the corners of the face, sorted; -1 stands for no corner */
  uint32_t cell;
  uint32_t seen; /* number of cells that have the face; 0 marks a free place of the table */
} grid_face;

typedef struct face_table {
  grid_face *faces; /* owned; [size]; the places of the hash table */
  size_t size;      /* number of places, a power of two */
} face_table;

/* Copies the corners of a face in rising order. */
static void sort_corners(const double from[FACE_CORNERS], double to[FACE_CORNERS]) {
  memcpy(to, from, FACE_CORNERS * sizeof *to);
  for (int n = 1; n < FACE_CORNERS; n++)
    for (int i = n; i > 0 && to[i - 1] > to[i]; i--) {
      double other = to[i];
      to[i] = to[i - 1];
      to[i - 1] = other;
    }
}

static void count_face(face_table *table, const double corner[FACE_CORNERS], uint32_t cell) {
  double sorted[FACE_CORNERS], others[FACE_CORNERS];
  uint64_t hash = 0;
  sort_corners(corner, sorted);
  for (int n = 0; n < FACE_CORNERS; n++) {
    hash = (hash ^ (uint64_t)(sorted[n] + 2)) * 0xbf58476d1ce4e5b9u;
    hash ^= hash >> 29;
  }
  for (size_t slot = hash & (table->size - 1);; slot = (slot + 1) & (table->size - 1)) {
    grid_face *face = &table->faces[slot];
    if (face->seen == 0) {
      memcpy(face->corner, corner, sizeof face->corner);
      face->cell = cell;
      face->seen = 1;
      return;
    }
    sort_corners(face->corner, others);
    if (memcmp(others, sorted, sizeof sorted) != 0) continue;
    face->seen++;
    return;
  }
}

static size_t begin_of(const unstructured_cells *grid, size_t n) {
  return n > 0 ? (size_t)grid->ends[n - 1] : 0;
}

/* Counts, for each face of the cells that enclose a volume, the cells that have it. */
static hl_status count_faces(hl_context *context, const unstructured_cells *grid, face_table *table,
                             hl_error *error) {
  size_t faces = 0;
  for (size_t n = 0; n < grid->count; n++) faces += type_of(grid->types[n])->kind == VOLUME ? FACES_MOST : 0;
  if (faces == 0) return HL_OK;
  for (table->size = 64; table->size < 2 * faces;) table->size *= 2;
  table->faces = hl_allocate_zeroed(context, table->size, sizeof *table->faces);
  if (table->faces == NULL)
    return hl_fail_memory(error, table->size * sizeof *table->faces, "faces of cells");
  for (size_t n = 0; n < grid->count; n++) {
    const cell_type *type = type_of(grid->types[n]);
    for (int f = 0; type->kind == VOLUME && f < FACES_MOST && type->faces[f][0] >= 0; f++) {
      double corner[FACE_CORNERS];
      for (int c = 0; c < FACE_CORNERS; c++)
        corner[c] = type->faces[f][c] < 0 ? -1 : grid->points[begin_of(grid, n) + (size_t)type->faces[f][c]];
      count_face(table, corner, (uint32_t)n);
    }
  }
  return HL_OK;
}

/* ---- cells of PolyData ---- */

/* The cells of one kind while they are filled. If the arrays are null, cells are only counted. */
typedef struct cell_writer {
  cells *cells;
  size_t *sources; /* for each of these cells, the index of the grid's cell from which it was made */
} cell_writer;

static void add_point(cell_writer *writer, double point) {
  if (writer->cells->points != NULL) writer->cells->points[writer->cells->point_count] = point;
  writer->cells->point_count++;
}

static void end_cell(cell_writer *writer, size_t source) {
  if (writer->cells->ends != NULL) {
    writer->cells->ends[writer->cells->count] = (double)writer->cells->point_count;
    writer->sources[writer->cells->count] = source;
  }
  writer->cells->count++;
}

static void add_cell(const unstructured_cells *grid, size_t n, cell_writer *writer) {
  enum { PIXEL = 8 };
  size_t begin = begin_of(grid, n), count = (size_t)grid->ends[n] - begin;
  size_t corners = (size_t)type_of(grid->types[n])->corners;
  if (corners > 0 && corners < count) count = corners;
  for (size_t c = 0; c < count; c++) {
    size_t place = grid->types[n] == PIXEL && c >= 2 ? 5 - c : c;
    add_point(writer, grid->points[begin + place]);
  }
  end_cell(writer, n);
}

/* Adds all cells of one kind; the outer faces of cells with a volume are added to the polygons. */
static void add_kind(const unstructured_cells *grid, const face_table *table, int kind, cell_writer *writer) {
  writer->cells->count = writer->cells->point_count = 0;
  for (size_t n = 0; n < grid->count; n++)
    if (type_of(grid->types[n])->kind == kind) add_cell(grid, n, writer);
  for (size_t slot = 0; kind == CELLS_POLYGONS && slot < table->size; slot++) {
    const grid_face *face = &table->faces[slot];
    if (face->seen != 1) continue;
    for (int c = 0; c < FACE_CORNERS && face->corner[c] >= 0; c++) add_point(writer, face->corner[c]);
    end_cell(writer, face->cell);
  }
}

/* Checks that the ends of the cells' points are possible, and that cells have the number of corners that
 * their types need. */
static hl_status check(const unstructured_cells *grid, const polydata *data, hl_error *error) {
  double before = 0;
  size_t passed = 0;
  if (grid->count > UINT32_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than 2^32 cells: extract a part of them",
                   data->path);
  for (size_t n = 0; n < grid->count; n++) {
    const cell_type *type = type_of(grid->types[n]);
    double length = grid->ends[n] - before;
    if (!(length >= type->corners && grid->ends[n] <= (double)grid->point_count) ||
        grid->ends[n] != floor(grid->ends[n]) || length < 0)
      return hl_fail(error, HL_ERROR_INPUT, "%s: cell %zu ends at point %.9g of %zu, or has too few points",
                     data->path, n, grid->ends[n], grid->point_count);
    before = grid->ends[n];
    passed += type->kind == NONE;
  }
  for (size_t n = 0; n < grid->point_count; n++)
    if (!(grid->points[n] >= 0 && grid->points[n] < (double)data->point_count))
      return hl_fail(error, HL_ERROR_INPUT, "%s: a cell names point %.9g: there are %zu, counted from 0",
                     data->path, grid->points[n], data->point_count);
  if (passed > 0)
    hl_log(data->context, HL_LOG_WARNING,
           "%s: %zu cells of kinds that are not read (polyhedra and others) are left out", data->path,
           passed);
  return HL_OK;
}

hl_status hl_unstructured_convert(const unstructured_cells *grid, polydata *data, size_t **sources,
                                  hl_error *error) {
  hl_context *context = data->context;
  face_table table = {NULL, 0};
  size_t total = 0;
  *sources = NULL;
  hl_status status = check(grid, data, error);
  if (status == HL_OK) status = count_faces(context, grid, &table, error);
  for (int kind = 0; status == HL_OK && kind < CELL_KINDS; kind++) {
    cell_writer writer = {&data->cells[kind], NULL};
    add_kind(grid, &table, kind, &writer);
    total += writer.cells->count;
  }
  if (status == HL_OK && (*sources = hl_allocate(context, total + 1, sizeof **sources)) == NULL)
    status = hl_fail_memory(error, total * sizeof **sources, data->path);
  for (size_t kind = 0, first = 0; status == HL_OK && kind < CELL_KINDS; kind++) {
    cells *cells = &data->cells[kind];
    if (cells->count == 0) continue;
    cells->ends = hl_allocate(context, cells->count, sizeof *cells->ends);
    cells->points = hl_allocate(context, cells->point_count, sizeof *cells->points);
    if (cells->ends == NULL || cells->points == NULL) {
      status = hl_fail_memory(error, cells->point_count * sizeof *cells->points, data->path);
      break;
    }
    cell_writer writer = {cells, *sources + first};
    add_kind(grid, &table, (int)kind, &writer);
    first += cells->count;
  }
  hl_release(context, table.faces);
  return status;
}

void hl_unstructured_release(hl_context *context, unstructured_cells *grid) {
  hl_release(context, grid->ends);
  hl_release(context, grid->types);
  hl_release(context, grid->points);
  *grid = (unstructured_cells){NULL, NULL, NULL, 0, 0};
}
