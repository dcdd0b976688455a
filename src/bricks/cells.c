/* bricks/cells.c - samples a mesh of cells to bricks (cells.h).
 *
 * Each cell has a level, which depends on the length of its edge. A brick is split where it may meet a cell
 * of a finer level. A lattice point's coefficient is the value of the cell around it; a tree finds the cells
 * near a brick. */
#include "bricks/cells.h"

#include <math.h>
#include <string.h>

#include "bricks/cell_bound.h"
#include "bricks/cell_tree.h"
#include "core/context.h"
#include "core/memory.h"

enum { SHIFT = 4, SIDE = 1 << SHIFT, STORED = SIDE + BRICK_MARGIN, LEVELS_MOST = 9 };

/* The wanted number of lattice points along a cell's edge. */
static const double POINTS_OF_AN_EDGE = 2;
/* The finest spacing is chosen so that this fraction of the cells has edges too short for it. */
static const double FINEST_PART = 0.01;
/* The greatest number of bytes that bricks take if there is no memory limit. */
static const double BYTES_MOST = 1073741824.0;
/* Cells with a corner at this distance from the origin, or farther, are left out. */
static const double FARTHEST = 1e30;

typedef struct cell_field {
  hl_context *context;
  const hl_cells *cells;
  const char *subject;
  hl_cells_place *place;
  unsigned char *levels; /* owned; [cell_count] */
  float *edges;          /* owned; [cell_count]; for each cell, the edge of a tetrahedron or cube with the
                          * same volume, in the world; 0 if the cell is left out */
  hl_cell_tree tree;
  hl_bricks_source source;
} cell_field;

/* ---- cells ---- */

/* The edge of a regular tetrahedron or of a cube with the cell's volume. */
static double edge_of(const hl_cell_shape *shape) {
  double volume = hl_cell_volume(shape);
  return cbrt(shape->is_tetrahedron ? 6 * sqrt(2) * volume : volume);
}

/* Returns whether all corners are nearer than FARTHEST; false for NaN. */
static bool is_near(const hl_cell_shape *shape) {
  bool near = true;
  for (int c = 0; c < (shape->is_tetrahedron ? 4 : 8); c++)
    for (int axis = 0; axis < 3; axis++) near = near && fabs(shape->corner[c][axis]) < FARTHEST;
  return near;
}

static void measure_cells(cell_field *field, double low[3], double high[3], size_t *used) {
  *used = 0;
  for (int axis = 0; axis < 3; axis++) low[axis] = INFINITY, high[axis] = -INFINITY;
  for (size_t n = 0; n < field->cells->cell_count; n++) {
    hl_cell_shape shape;
    field->edges[n] = 0;
    if (!hl_cells_shape_in_world(field->cells, n, &shape)) continue;
    double edge = edge_of(&shape);
    if (!(edge > 1e-30 && is_near(&shape))) continue;
    field->edges[n] = (float)edge;
    (*used)++;
    for (int c = 0; c < (shape.is_tetrahedron ? 4 : 8); c++)
      for (int axis = 0; axis < 3; axis++) {
        low[axis] = fmin(low[axis], shape.corner[c][axis]);
        high[axis] = fmax(high[axis], shape.corner[c][axis]);
      }
  }
}

/* ---- the lattice ---- */

enum { BINS = 512 };

/* The bin of a histogram of edges. Eight bins double the edge. */
static int bin_of(double edge) {
  int bin = (int)floor(log2(edge) * 8) + BINS / 2;
  return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/* The edge from which the finest spacing is chosen. A fraction FINEST_PART of the used cells have shorter
 * edges. */
static double finest_edge(const cell_field *field, size_t used) {
  size_t counts[BINS] = {0}, sum = 0;
  for (size_t n = 0; n < field->cells->cell_count; n++)
    if (field->edges[n] > 0) counts[bin_of((double)field->edges[n])]++;
  for (int bin = 0; bin < BINS; bin++) {
    sum += counts[bin];
    if ((double)sum > FINEST_PART * (double)used) return exp2((bin - BINS / 2 + 0.5) / 8);
  }
  return 1;
}

static int level_of(double edge, double spacing) {
  /* The finest edge is known only to within its bin, an eighth of an octave. The summand 0.25 is greater than
   * this error. */
  double level = floor(log2(edge / POINTS_OF_AN_EDGE / spacing) + 0.25);
  return level < 0 ? 0 : level > LEVELS_MOST - 1 ? LEVELS_MOST - 1 : (int)level;
}

/* Estimates the number of bytes that the bricks need: the bytes of the directory, and the bytes of the
 * coefficients. The number of coefficients follows from the cells' volumes; a factor accounts for borders and
 * partly filled bricks. size: the size of the mesh's box. */
static double bytes_of(const cell_field *field, double spacing, const double size[3]) {
  double points = 0, blocks = 1;
  for (int axis = 0; axis < 3; axis++) blocks *= ceil(size[axis] / spacing / SIDE) + 1;
  for (size_t n = 0; n < field->cells->cell_count; n++) {
    double edge = (double)field->edges[n];
    if (!(edge > 0)) continue;
    double step = spacing * (double)(1 << level_of(edge, spacing)), across = edge / step;
    points += (hl_cell_corner_count(&field->cells->cells[n]) == 4 ? 0.118 : 1) * across * across * across;
  }
  return points * 2.5 * sizeof(float) + blocks * sizeof(hl_brick_entry);
}

static double choose_spacing(const cell_field *field, size_t used, const double size[3]) {
  const double wanted = finest_edge(field, used) / POINTS_OF_AN_EDGE;
  double spacing = wanted, most = BYTES_MOST;
  uint64_t limit = field->context->options.memory_limit;
  if (limit > 0 && (double)limit / 4 < most) most = (double)limit / 4;
  for (int axis = 0; axis < 3; axis++) /* the directory alone must not need more */
    spacing = fmax(spacing, size[axis] / SIDE * sizeof(hl_brick_entry) / most);
  while (bytes_of(field, spacing, size) > most && spacing < FARTHEST) spacing *= sqrt(2);
  if (spacing > wanted)
    hl_log(field->context, HL_LOG_WARNING,
           "%s: its cells are resampled %.3g times as coarse as half of a small cell's edge, as far as "
           "memory has "
           "room for",
           field->subject, spacing / wanted);
  return spacing;
}

/* Chooses the lattice. Its outermost points lie half a spacing inside the mesh's box. */
static hl_status choose_lattice(cell_field *field, hl_error *error) {
  double low[3], high[3];
  size_t used;
  measure_cells(field, low, high, &used);
  if (used == 0)
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: no cell has a volume and finite values: a mesh of surfaces is given to `halflight render` "
        "beside a volume, or alone",
        field->subject);
  const double size[3] = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  double spacing = choose_spacing(field, used, size);
  for (int axis = 0; axis < 3; axis++) {
    double points = fmax(1, ceil((high[axis] - low[axis]) / spacing - 1e-6));
    field->source.dimension[axis] = (size_t)points;
    field->place->spacing[axis] = (high[axis] - low[axis]) / points;
    if (!(field->place->spacing[axis] > 0)) field->place->spacing[axis] = spacing;
    field->place->origin[axis] = low[axis] + field->place->spacing[axis] / 2;
  }
  field->source.levels = 1;
  for (size_t n = 0; n < field->cells->cell_count; n++) {
    if (!(field->edges[n] > 0)) continue;
    field->levels[n] = (unsigned char)level_of((double)field->edges[n], spacing);
    if (field->levels[n] >= field->source.levels) field->source.levels = field->levels[n] + 1;
  }
  return HL_OK;
}

static hl_status make_tree(cell_field *field, hl_error *error) {
  size_t count = field->cells->cell_count;
  hl_cell_box *boxes = hl_allocate(field->context, count, sizeof *boxes);
  if (boxes == NULL) return hl_fail_memory(error, count * sizeof *boxes, field->subject);
  for (size_t n = 0; n < count; n++) {
    hl_cell_shape shape;
    hl_cell_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    bool sound = field->edges[n] > 0 && hl_cells_shape(field->cells, field->place, n, &shape);
    for (int c = 0; sound && c < (shape.is_tetrahedron ? 4 : 8); c++)
      for (int axis = 0; axis < 3; axis++) {
        double at = shape.corner[c][axis], margin = 1e-6 * (1 + fabs(at));
        box.low[axis] = fminf(box.low[axis], (float)(at - margin));
        box.high[axis] = fmaxf(box.high[axis], (float)(at + margin));
      }
    if (!sound) /* a cell that is left out gets a box far away from all others, so that no brick meets it */
      box = (hl_cell_box){{-3e30f, -3e30f, -3e30f}, {-3e30f, -3e30f, -3e30f}};
    boxes[n] = box;
  }
  return hl_cell_tree_make(field->context, boxes, count, field->subject, &field->tree, error);
}

/* ---- the source ---- */

/* A box of lattice points that is being filled. */
typedef struct fill_job {
  const cell_field *field;
  int level;
  const ptrdiff_t *first;
  const size_t *count;
  float *out;
} fill_job;

/* Sets the points of the box that lie in a cell of the mesh. It is called for all cells that may hold such
 * points. If several cells hold a point, the last of these cells in the tree's order sets it. */
static bool fill_from_cell(void *data, uint32_t n) {
  const fill_job *job = data;
  const hl_cell *cell = &job->field->cells->cells[n];
  const hl_cell_box *box = &job->field->tree.boxes[n];
  double scale = (double)(1 << job->level);
  hl_cell_shape shape;
  ptrdiff_t low[3], high[3], at[3];
  if (!hl_cells_shape(job->field->cells, job->field->place, n, &shape)) return true;
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (ptrdiff_t)fmax(ceil((double)box->low[axis] / scale), (double)job->first[axis]);
    high[axis] = (ptrdiff_t)fmin(floor((double)box->high[axis] / scale),
                                 (double)job->first[axis] + (double)job->count[axis] - 1);
  }
  for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
    for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
      for (at[0] = low[0]; at[0] <= high[0]; at[0]++) {
        const double point[3] = {(double)at[0] * scale, (double)at[1] * scale, (double)at[2] * scale};
        double weights[8], sum = 0;
        if (!hl_cell_weights(&shape, point, weights)) continue;
        double base = (double)job->field->cells->values[cell->corner[0]]; /* a constant stays exact */
        for (int c = 0; c < hl_cell_corner_count(cell); c++)
          sum += weights[c] * ((double)job->field->cells->values[cell->corner[c]] - base);
        job->out[((size_t)(at[2] - job->first[2]) * job->count[1] + (size_t)(at[1] - job->first[1])) *
                     job->count[0] +
                 (size_t)(at[0] - job->first[0])] = (float)(base + sum);
      }
  return true;
}

/* The bounds, in lattice coordinates of level 0, of a box of lattice points of any level. */
static void bounds_of(int level, const ptrdiff_t first[3], const size_t count[3], double low[3],
                      double high[3]) {
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (double)first[axis] * (double)(1 << level);
    high[axis] = ((double)first[axis] + (double)count[axis] - 1) * (double)(1 << level);
  }
}

static void fill(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out) {
  fill_job job = {data, level, first, count, out};
  double low[3], high[3];
  for (size_t n = 0; n < count[0] * count[1] * count[2]; n++) out[n] = NAN;
  bounds_of(level, first, count, low, high);
  hl_cell_tree_visit(&job.field->tree, low, high, fill_from_cell, &job);
}

/* The finest level of the cells that a brick may meet. */
typedef struct level_search {
  const cell_field *field;
  int wanted, least;
} level_search;

static bool note_level(void *data, uint32_t cell) {
  level_search *search = data;
  if (search->field->levels[cell] < search->least) search->least = search->field->levels[cell];
  return search->least >= search->wanted; /* one finer cell decides */
}

static hl_bricks_choice choose(void *data, int level, const size_t brick[3]) {
  level_search search = {data, level, LEVELS_MOST};
  ptrdiff_t first[3];
  const size_t count[3] = {SIDE + 1, SIDE + 1, SIDE + 1};
  double low[3], high[3];
  for (int axis = 0; axis < 3; axis++) first[axis] = (ptrdiff_t)brick[axis] << SHIFT;
  bounds_of(level, first, count, low, high);
  hl_cell_tree_visit(&search.field->tree, low, high, note_level, &search);
  return search.least == LEVELS_MOST ? HL_BRICKS_NOTHING
         : search.least < level      ? HL_BRICKS_SPLIT
                                     : HL_BRICKS_LEAF;
}

/* ---- the whole ---- */

static hl_status build(cell_field *field, hl_pool *pool, hl_bricks *bricks, hl_error *error) {
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  hl_status status = choose_lattice(field, error);
  if (status == HL_OK) status = make_tree(field, error);
  if (status == HL_OK)
    status = hl_bricks_choose(field->context, &field->source, choose, field, &leaves, &count, error);
  if (status == HL_OK)
    status = hl_bricks_build(field->context, pool, &field->source, leaves, count, field->subject, bricks,
                             error);
  if (status == HL_OK) {
    const hl_cell_mesh_field made = {field->cells, &field->tree, field->place, leaves, count, bricks};
    status = hl_cell_mesh_bound(field->context, pool, &made, field->subject, &field->place->error, error);
    if (status != HL_OK) hl_bricks_release(field->context, bricks);
  }
  hl_release(field->context, leaves);
  return status;
}

hl_status hl_cells_build(hl_context *context, hl_pool *pool, const hl_cells *cells, const char *subject,
                         hl_bricks *bricks, hl_cells_place *place, hl_error *error) {
  cell_field field = {.context = context, .cells = cells, .subject = subject, .place = place};
  field.source = (hl_bricks_source){.shift = SHIFT, .outside = NAN, .fill = fill, .data = &field};
  *bricks = (hl_bricks){.shift = 0};
  *place = (hl_cells_place){.error = 0};
  if (cells->cell_count >= UINT32_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than 2^32 cells: extract a part of them", subject);
  field.levels = hl_allocate_zeroed(context, cells->cell_count, sizeof *field.levels);
  field.edges = hl_allocate(context, cells->cell_count, sizeof *field.edges);
  hl_status status = field.levels != NULL && field.edges != NULL
                         ? build(&field, pool, bricks, error)
                         : hl_fail_memory(error, cells->cell_count * sizeof *field.edges, subject);
  hl_release(context, field.levels);
  hl_release(context, field.edges);
  hl_cell_tree_release(context, &field.tree);
  return status;
}
