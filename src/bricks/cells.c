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
#include "bricks/cell_walls.h"
#include "bricks/evaluate.h"
#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"

enum { SHIFT = 4, SIDE = 1 << SHIFT, STORED = SIDE + BRICK_MARGIN, LEVELS_MOST = 9 };

/* The wanted number of lattice points along a cell's edge. */
static const double POINTS_OF_AN_EDGE = 2;
/* The finest spacing is chosen so that this fraction of the cells has edges too short for it. */
static const double FINEST_PART = 0.01;
/* The greatest number of bytes that the field takes if there is no memory limit, and that the walls take. */
static const double BYTES_MOST = 1073741824.0;
/* Under a memory limit, the field takes at most this part of the limit, and so do the walls. A frame makes a
 * copy of the field that it shows. */
static const double SHARE_OF_FIELD = 4, SHARE_OF_WALLS = 8;
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
  const hl_bricks *bricks; /* the field, once its bricks are made */
  hl_cell_walls walls;
  hl_bricks_source source;
} cell_field;

/* ---- cells ---- */

/* The edge of a regular tetrahedron or of a cube with the cell's volume. */
static double edge_of(const hl_cell_shape *shape) {
  double volume = hl_cell_volume(shape);
  return hl_cbrt(shape->is_tetrahedron ? 6 * sqrt(2) * volume : volume);
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
  int bin = (int)floor(hl_log2(edge) * 8) + BINS / 2;
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
    if ((double)sum > FINEST_PART * (double)used) return hl_exp2((bin - BINS / 2 + 0.5) / 8);
  }
  return 1;
}

static int level_of(double edge, double spacing) {
  /* The finest edge is known only to within its bin, an eighth of an octave. The summand 0.25 is greater than
   * this error. */
  double level = floor(hl_log2(edge / POINTS_OF_AN_EDGE / spacing) + 0.25);
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

/* The number of bytes that may be taken: a fraction 1 / share of the memory limit, but at most BYTES_MOST. */
static double most_bytes(const cell_field *field, double share) {
  double limit = (double)field->context->options.memory_limit;
  return limit > 0 && limit / share < BYTES_MOST ? limit / share : BYTES_MOST;
}

static double choose_spacing(const cell_field *field, size_t used, const double size[3]) {
  const double wanted = finest_edge(field, used) / POINTS_OF_AN_EDGE;
  const double most = most_bytes(field, SHARE_OF_FIELD);
  double spacing = wanted;
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

/* Chooses the lattice. The outermost voxels lie half a spacing inside the mesh's box. */
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
    field->source.dimension[axis] = (size_t)points + 2 * HL_CELLS_MARGIN;
    field->place->spacing[axis] = (high[axis] - low[axis]) / points;
    if (!(field->place->spacing[axis] > 0)) field->place->spacing[axis] = spacing;
    field->place->origin[axis] = low[axis] - (HL_CELLS_MARGIN - 0.5) * field->place->spacing[axis];
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

/* ---- walls ---- */

/* The continued field is wanted up to this distance from the mesh; spacings of level 0. */
static const double RAMP = 1.5;
/* Coefficients of the continued field are known up to this distance from a wall; spacings of their level. */
static const double CONTINUED = 4;
/* A continued value leaves the range of its cell's corners by this many ranges at most. */
static const double CONTINUED_RANGES = 2;

/* The value at a point in front of a cell's wall, by the affine function near the cell's values. In
 * front of a cell that is much thinner than the spacing this function may be steep, so the value is held near
 * the range of the corners. */
static float continued_value(const cell_field *field, uint32_t n, const double point[3]) {
  const hl_cell *cell = &field->cells->cells[n];
  hl_cell_shape shape;
  hl_cell_affine affine;
  double values[8] = {0}, low = INFINITY, high = -INFINITY, value;
  if (!hl_cells_shape(field->cells, field->place, n, &shape)) return NAN;
  for (int c = 0; c < hl_cell_corner_count(cell); c++) {
    values[c] = (double)field->cells->values[cell->corner[c]];
    low = fmin(low, values[c]), high = fmax(high, values[c]);
  }
  hl_cell_affine_of(&shape, values, &affine);
  value = affine.value;
  for (int axis = 0; axis < 3; axis++) value += affine.slope[axis] * (point[axis] - affine.middle[axis]);
  const double range = CONTINUED_RANGES * (high - low);
  return (float)fmin(fmax(value, low - range), high + range);
}

/* Continues the field outwards in a slice of a box. */
static void continue_slice(const cell_field *field, int level, const ptrdiff_t first[3],
                           const size_t count[3], float *out) {
  enum { SIDE_MOST = STORED + 3 };
  hl_wall_near near[SIDE_MOST * SIDE_MOST];
  const double scale = (double)(1 << level);
  const double reach = CONTINUED * scale;
  bool whole = true;
  for (size_t n = 0; n < count[0] * count[1]; n++) {
    whole = whole && isfinite(out[n]);
    near[n] = (hl_wall_near){UINT32_MAX, isfinite(out[n]) ? -1 : reach * reach, 0};
  }
  if (whole) return;
  hl_cell_walls_near(&field->walls, level, first, count, reach, near);
  for (size_t n = 0; n < count[0] * count[1]; n++) {
    if (isfinite(out[n]) || near[n].wall == UINT32_MAX) continue;
    const double point[3] = {((double)first[0] + (double)(n % count[0])) * scale,
                             ((double)first[1] + (double)(n / count[0])) * scale, (double)first[2] * scale};
    out[n] = continued_value(field, field->walls.walls[near[n].wall].cell, point);
  }
}

/* Copies a box that is a brick of the field. Its active coefficients are the source's own; the builder
 * replaces the others anyway. Returns false if the box is no brick. */
static bool copy_brick(const hl_bricks *bricks, int level, const ptrdiff_t first[3], const size_t count[3],
                       float *out) {
  int64_t block[3];
  for (int axis = 0; axis < 3; axis++) {
    block[axis] = (int64_t)((first[axis] + 1) >> SHIFT) << level;
    if (first[axis] < -1 || ((first[axis] + 1) & (SIDE - 1)) != 0 || count[axis] != STORED) return false;
    if ((size_t)block[axis] >= bricks->directory_size[axis]) return false;
  }
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  if (entry->level != level) return false;
  if (entry->slot >= 0) memcpy(out, hl_brick_pool(bricks, entry->slot), brick_points(SHIFT) * sizeof *out);
  for (size_t n = 0; n < brick_points(SHIFT) && entry->slot < 0; n++) out[n] = entry->constant;
  return true;
}

static void fill_continued(void *data, int level, const ptrdiff_t first[3], const size_t count[3],
                           float *out) {
  const cell_field *field = data;
  if (!copy_brick(field->bricks, level, first, count, out)) fill(data, level, first, count, out);
  for (size_t k = 0; k < count[2]; k++)
    continue_slice(data, level, (const ptrdiff_t[3]){first[0], first[1], first[2] + (ptrdiff_t)k},
                   (const size_t[3]){count[0], count[1], 1}, out + k * count[0] * count[1]);
}

/* Bytes for each point of the walls' lattice: the depth, and a mask's factor and slopes made of it. */
static const double BYTES_OF_DEPTH = 8;

typedef struct depth_job {
  const cell_field *field;
  hl_wall_near *near; /* owned; [threads][y][x] */
  uint16_t *depth;
} depth_job;

static uint16_t code_of(double depth) {
  double part = (depth + HL_WALL_OUTSIDE) / (HL_WALL_OUTSIDE + HL_WALL_INSIDE);
  return (uint16_t)(fmin(fmax(part, 0), 1) * 65535 + 0.5);
}

/* Finds the depths of a row of points. Between points near walls, all points are inside, or all are
 * outside. */
static void fill_row(const depth_job *job, const hl_wall_near *near, ptrdiff_t j, ptrdiff_t k,
                     uint16_t *out) {
  const cell_field *field = job->field;
  for (size_t i = 0; i < field->source.dimension[0]; i++) {
    const double point[3] = {(double)i, (double)j, (double)k};
    if (near[i].wall != UINT32_MAX)
      out[i] = code_of(near[i].above > 0 ? -sqrt(near[i].squared) : sqrt(near[i].squared));
    else if (i > 0 && near[i - 1].wall == UINT32_MAX) out[i] = out[i - 1];
    else out[i] = hl_cells_hold(field->cells, &field->tree, field->place, point, UINT32_MAX) ? UINT16_MAX : 0;
  }
}

static void fill_depths(void *data, size_t k, int worker) {
  const depth_job *job = data;
  const size_t *n = job->field->source.dimension;
  hl_wall_near *near = job->near + (size_t)worker * n[0] * n[1];
  for (size_t m = 0; m < n[0] * n[1]; m++)
    near[m] = (hl_wall_near){UINT32_MAX, HL_WALL_OUTSIDE * HL_WALL_OUTSIDE, 0};
  hl_cell_walls_near(&job->field->walls, 0, (const ptrdiff_t[3]){0, 0, (ptrdiff_t)k},
                     (const size_t[3]){n[0], n[1], 1}, HL_WALL_OUTSIDE, near);
  for (size_t j = 0; j < n[1]; j++)
    fill_row(job, near + j * n[0], (ptrdiff_t)j, (ptrdiff_t)k, job->depth + (k * n[1] + j) * n[0]);
}

static hl_status find_depths(cell_field *field, hl_pool *pool, hl_cells_wall *wall, hl_error *error) {
  const size_t *n = field->source.dimension, points = n[0] * n[1] * n[2];
  depth_job job = {.field = field};
  job.near = hl_allocate(field->context, (size_t)hl_pool_threads(pool) * n[0] * n[1], sizeof *job.near);
  wall->depth = job.depth = hl_allocate(field->context, points, sizeof *job.depth);
  hl_status status = HL_OK;
  if (job.near == NULL || job.depth == NULL)
    status = hl_fail_memory(error, points * sizeof *job.depth, field->subject);
  else hl_pool_run(pool, n[2], fill_depths, &job);
  hl_release(field->context, job.near);
  return status == HL_OK ? hl_pool_check(pool, field->subject, error) : status;
}

/* The bytes that the continued field, and the mask that is made of the depths, take at most. */
static double bytes_of_wall(const cell_field *field, size_t leaves) {
  const size_t *n = field->source.dimension;
  return (double)(leaves * brick_points(SHIFT)) * sizeof(float) +
         BYTES_OF_DEPTH * (double)n[0] * (double)n[1] * (double)n[2];
}

/* Makes the walls. If memory has no room for them, the field has none. */
static hl_status build_wall(cell_field *field, hl_pool *pool, const hl_bricks_leaf *leaves, size_t count,
                            const hl_bricks *bricks, hl_cells_wall *wall, hl_error *error) {
  hl_bricks_source source = field->source;
  hl_status status = HL_ERROR_MEMORY;
  source.fill = fill_continued;
  field->bricks = bricks;
  if (bytes_of_wall(field, count) <= most_bytes(field, SHARE_OF_WALLS))
    status = hl_cell_walls_find(field->context, field->cells, &field->tree, field->place, field->subject,
                                &field->walls, error);
  if (status == HL_OK)
    status = hl_bricks_build(field->context, pool, &source, leaves, count, field->subject, &wall->bricks,
                             error);
  if (status == HL_OK) status = find_depths(field, pool, wall, error);
  if (status != HL_ERROR_MEMORY) return status;
  hl_cells_wall_release(field->context, wall);
  hl_log(field->context, HL_LOG_WARNING,
         "%s: its outer walls are steps of the lattice of samples, as memory has no room for smooth walls",
         field->subject);
  return HL_OK;
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
  for (int axis = 0; axis < 3; axis++) low[axis] -= RAMP, high[axis] += RAMP;
  hl_cell_tree_visit(&search.field->tree, low, high, note_level, &search);
  return search.least == LEVELS_MOST ? HL_BRICKS_NOTHING
         : search.least < level      ? HL_BRICKS_SPLIT
                                     : HL_BRICKS_LEAF;
}

/* ---- all steps together ---- */

static hl_status build(cell_field *field, hl_pool *pool, hl_bricks *bricks, hl_cells_wall *wall,
                       hl_error *error) {
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  hl_status status = choose_lattice(field, error);
  if (status == HL_OK) status = make_tree(field, error);
  if (status == HL_OK)
    status = hl_bricks_choose(field->context, &field->source, choose, field, field->subject, &leaves, &count,
                              error);
  if (status == HL_OK)
    status = hl_bricks_build(field->context, pool, &field->source, leaves, count, field->subject, bricks,
                             error);
  if (status == HL_OK) {
    const hl_cell_mesh_field made = {field->cells, &field->tree, field->place, leaves, count, bricks};
    status = hl_cell_mesh_bound(field->context, pool, &made, field->subject, &field->place->error, error);
  }
  if (status == HL_OK) status = build_wall(field, pool, leaves, count, bricks, wall, error);
  if (status != HL_OK) hl_bricks_release(field->context, bricks);
  if (status != HL_OK) hl_cells_wall_release(field->context, wall);
  for (int axis = 0; axis < 3; axis++) bricks->origin[axis] = HL_CELLS_MARGIN;
  hl_release(field->context, leaves);
  return status;
}

hl_status hl_cells_build(hl_context *context, hl_pool *pool, const hl_cells *cells, const char *subject,
                         hl_bricks *bricks, hl_cells_wall *wall, hl_cells_place *place, hl_error *error) {
  cell_field field = {.context = context, .cells = cells, .subject = subject, .place = place};
  field.source = (hl_bricks_source){.shift = SHIFT, .outside = NAN, .fill = fill, .data = &field};
  *bricks = (hl_bricks){.shift = 0};
  *wall = (hl_cells_wall){.depth = NULL};
  *place = (hl_cells_place){.error = 0};
  if (cells->cell_count >= UINT32_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than 2^32 cells: extract a part of them", subject);
  field.levels = hl_allocate_zeroed(context, cells->cell_count, sizeof *field.levels);
  field.edges = hl_allocate(context, cells->cell_count, sizeof *field.edges);
  hl_status status = field.levels != NULL && field.edges != NULL
                         ? build(&field, pool, bricks, wall, error)
                         : hl_fail_memory(error, cells->cell_count * sizeof *field.edges, subject);
  hl_release(context, field.levels);
  hl_release(context, field.edges);
  hl_cell_tree_release(context, &field.tree);
  hl_cell_walls_release(context, &field.walls);
  return status;
}

void hl_cells_wall_release(hl_context *context, hl_cells_wall *wall) {
  hl_bricks_release(context, &wall->bricks);
  hl_release(context, wall->depth);
  wall->depth = NULL;
}
