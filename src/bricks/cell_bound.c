/* bricks/cell_bound.c - bounds the difference between a field and its mesh of cells (cell_bound.h).
 *
 * Derived: let L be an affine function that is near the mesh's values in one of its cells. A spline whose
 * coefficients are the values of L is L itself. Therefore field - L is the spline of the differences c_i -
 * L(x_i). In one lattice cell this spline is a polynomial, which lies between the least and the greatest of
 * its Bezier coefficients. In a tetrahedron the mesh's values equal L. In a hexahedron, positions and values
 * are means over the corners, with the same weights. So values - L is such a mean, too, and lies between the
 * differences at the corners. The intervals of field - L and values - L together bound field - values.
 *
 * If the bound of a lattice cell is greater than the greatest bound so far, the lattice cell is halved along
 * each axis, up to HALVINGS times. Halves that lie beyond the mesh's cell are left out, which makes the bound
 * tighter. */
#include "bricks/cell_bound.h"

#include <math.h>
#include <string.h>

#include "bricks/evaluate.h"
#include "core/context.h"
#include "core/memory.h"

enum {
  TAPS = 4,
  COEFFICIENTS = TAPS * TAPS * TAPS,
  HALVINGS = 2, /* number of times that a lattice cell is halved along each axis */
  FUNCTIONS = 7 /* number of affine functions that bound a cell: the three coordinates, the cell's three unit
                 * coordinates and, in a tetrahedron, the sum of the unit coordinates */
};

typedef struct range {
  double low, high;
} range;

typedef struct bound_job {
  const hl_cell_mesh_field *field;
  double *bounds; /* owned; [leaf_count]; NaN: the leaf has no place where all coefficients are numbers */
} bound_job;

/* The search in one leaf, for one cell of the mesh at a time. */
typedef struct cell_search {
  const hl_cell_mesh_field *field;
  const hl_bricks_leaf *leaf;
  hl_cell_affine affine;
  range departure; /* range of the difference between the cell's values and the affine function near them; 0
                    * in a tetrahedron */
  double slopes[FUNCTIONS][3];
  range extents[FUNCTIONS]; /* of the functions in the cell */
  int functions;
  double greatest; /* the greatest bound found so far; NaN before the first one */
} cell_search;

static range range_of(const double *values, int count) {
  range found = {values[0], values[0]};
  for (int n = 1; n < count; n++) {
    found.low = values[n] < found.low ? values[n] : found.low;
    found.high = values[n] > found.high ? values[n] : found.high;
  }
  return found;
}

static double affine_at(const double slope[3], const double middle[3], const double place[3]) {
  return slope[0] * (place[0] - middle[0]) + slope[1] * (place[1] - middle[1]) +
         slope[2] * (place[2] - middle[2]);
}

/* ---- a mesh's cell ---- */

static void set_functions(cell_search *search, const hl_cell_shape *shape) {
  const hl_cell_affine *affine = &search->affine;
  search->functions = shape->is_tetrahedron ? FUNCTIONS : FUNCTIONS - 1;
  memset(search->slopes, 0, sizeof search->slopes);
  for (int n = 0; n < 3; n++) {
    search->slopes[n][n] = 1;
    for (int axis = 0; axis < 3; axis++) {
      search->slopes[3 + n][axis] = affine->place[n][axis];
      search->slopes[FUNCTIONS - 1][axis] += affine->place[n][axis]; /* a tetrahedron's fourth face */
    }
  }
  for (int n = 0; n < search->functions; n++) {
    double values[8];
    int corners = shape->is_tetrahedron ? 4 : 8;
    for (int c = 0; c < corners; c++)
      values[c] = affine_at(search->slopes[n], affine->middle, shape->corner[c]);
    search->extents[n] = range_of(values, corners);
  }
}

static void set_cell(cell_search *search, const hl_cell *cell, const hl_cell_shape *shape) {
  const int corners = shape->is_tetrahedron ? 4 : 8;
  double values[8] = {0}, departures[8];
  for (int c = 0; c < corners; c++) values[c] = (double)search->field->cells->values[cell->corner[c]];
  hl_cell_affine_of(shape, values, &search->affine);
  for (int c = 0; c < corners; c++)
    departures[c] = values[c] - search->affine.value -
                    affine_at(search->affine.slope, search->affine.middle, shape->corner[c]);
  search->departure = shape->is_tetrahedron ? (range){0, 0} : range_of(departures, corners);
  set_functions(search, shape);
}

/* Returns whether a cube may meet the cell. low: the cube's corner with the least coordinates. size: the
 * cube's edge. */
static bool meets(const cell_search *search, const double low[3], double size) {
  const double middle[3] = {low[0] + size / 2, low[1] + size / 2, low[2] + size / 2};
  for (int n = 0; n < search->functions; n++) {
    const double *slope = search->slopes[n];
    double value = affine_at(slope, search->affine.middle, middle);
    double reach = (fabs(slope[0]) + fabs(slope[1]) + fabs(slope[2])) * size / 2;
    double margin = 1e-9 * (reach + fabs(value));
    if (value + reach + margin < search->extents[n].low || value - reach - margin > search->extents[n].high)
      return false;
  }
  return true;
}

/* ---- polynomials ---- */

static void to_bezier(double *c, size_t step) {
  const double a = c[0], b = c[step], d = c[2 * step], e = c[3 * step];
  c[0] = (a + 4 * b + d) / 6;
  c[step] = (4 * b + 2 * d) / 6;
  c[2 * step] = (2 * b + 4 * d) / 6;
  c[3 * step] = (b + 4 * d + e) / 6;
}

static void first_half(double *c, size_t step) {
  const double a = c[0], b = c[step], d = c[2 * step], e = c[3 * step];
  c[step] = (a + b) / 2;
  c[2 * step] = (a + 2 * b + d) / 4;
  c[3 * step] = (a + 3 * b + 3 * d + e) / 8;
}

static void second_half(double *c, size_t step) {
  const double a = c[0], b = c[step], d = c[2 * step], e = c[3 * step];
  c[0] = (a + 3 * b + 3 * d + e) / 8;
  c[step] = (b + 2 * d + e) / 4;
  c[2 * step] = (d + e) / 2;
}

/* Calls a function for each of the 16 lines along an axis in the cube of 4^3 coefficients. */
static void along(double c[COEFFICIENTS], int axis, void (*change)(double *line, size_t step)) {
  static const size_t steps[3] = {1, TAPS, TAPS * TAPS};
  size_t one = steps[(axis + 1) % 3], other = steps[(axis + 2) % 3];
  for (size_t n = 0; n < TAPS; n++)
    for (size_t m = 0; m < TAPS; m++) change(c + n * one + m * other, steps[axis]);
}

/* ---- the bound ---- */

/* Returns whether the coefficients of field - L allow a greater difference than the greatest one found so
 * far. */
static bool may_be_greater(const cell_search *search, const double c[COEFFICIENTS], double *bound) {
  range found = range_of(c, COEFFICIENTS);
  *bound = fmax(found.high - search->departure.low, search->departure.high - found.low);
  return !(*bound <= search->greatest);
}

/* Bounds the difference in that part of a cube which lies in the mesh's cell. c: Bezier coefficients of the
 * cube. */
static void bound_cube(cell_search *search, const double c[COEFFICIENTS], const double low[3], double size,
                       int halvings) {
  double bound;
  if (!meets(search, low, size) || !may_be_greater(search, c, &bound)) return;
  if (halvings == 0) {
    search->greatest = bound;
    return;
  }
  for (int octant = 0; octant < 8; octant++) {
    double half[COEFFICIENTS], corner[3];
    memcpy(half, c, sizeof half);
    for (int axis = 0; axis < 3; axis++) {
      bool second = (octant >> axis & 1) != 0;
      along(half, axis, second ? second_half : first_half);
      corner[axis] = low[axis] + (second ? size / 2 : 0);
    }
    bound_cube(search, half, corner, size / 2, halvings - 1);
  }
}

/* The coefficients of field - L of a lattice cell of the leaf's level. Returns false if one is not a
 * number. */
static bool differences(const cell_search *search, const ptrdiff_t cell[3], double c[COEFFICIENTS]) {
  const hl_bricks *bricks = search->field->bricks;
  const hl_bricks_leaf *leaf = search->leaf;
  const double scale = (double)(1 << leaf->level);
  const size_t width = hl_brick_width(bricks);
  int64_t block[3];
  size_t at[3];
  bool finite = true;
  for (int axis = 0; axis < 3; axis++) {
    block[axis] = (int64_t)leaf->brick[axis] << leaf->level;
    at[axis] = (size_t)(cell[axis] - ((ptrdiff_t)leaf->brick[axis] << bricks->shift));
  }
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  const float *pool = entry->slot < 0 ? NULL : hl_brick_pool(bricks, entry->slot);
  for (size_t n = 0; n < COEFFICIENTS; n++) {
    const size_t tap[3] = {n % TAPS, n / TAPS % TAPS, n / TAPS / TAPS};
    float value = pool == NULL ? entry->constant
                               : pool[((at[2] + tap[2]) * width + at[1] + tap[1]) * width + at[0] + tap[0]];
    double place[3];
    for (int axis = 0; axis < 3; axis++) place[axis] = scale * ((double)cell[axis] + (double)tap[axis] - 1);
    c[n] = (double)value - search->affine.value -
           affine_at(search->affine.slope, search->affine.middle, place);
    finite = finite && isfinite(value);
  }
  return finite;
}

static void bound_lattice_cell(cell_search *search, const ptrdiff_t cell[3]) {
  const double scale = (double)(1 << search->leaf->level);
  const double low[3] = {(double)cell[0] * scale, (double)cell[1] * scale, (double)cell[2] * scale};
  double c[COEFFICIENTS], bound;
  if (!meets(search, low, scale) || !differences(search, cell, c)) return;
  if (!may_be_greater(search, c, &bound)) return; /* the coefficients bound the spline, too */
  if (isnan(search->greatest)) search->greatest = 0;
  for (int axis = 0; axis < 3; axis++) along(c, axis, to_bezier);
  bound_cube(search, c, low, scale, HALVINGS);
}

/* Bounds the difference in all lattice cells of the leaf that meet a cell of the mesh. */
static bool bound_cell(void *data, uint32_t n) {
  cell_search *search = data;
  const hl_cell_mesh_field *field = search->field;
  const hl_cell_box *box = &field->tree->boxes[n];
  const double scale = (double)(1 << search->leaf->level);
  const ptrdiff_t side = (ptrdiff_t)1 << field->bricks->shift;
  hl_cell_shape shape;
  ptrdiff_t low[3], high[3], at[3];
  if (!hl_cells_shape(field->cells, field->place, n, &shape)) return true;
  set_cell(search, &field->cells->cells[n], &shape);
  for (int axis = 0; axis < 3; axis++) {
    ptrdiff_t first = (ptrdiff_t)search->leaf->brick[axis] * side;
    low[axis] = (ptrdiff_t)fmax(floor((double)box->low[axis] / scale), (double)first);
    high[axis] = (ptrdiff_t)fmin(floor((double)box->high[axis] / scale), (double)(first + side - 1));
  }
  for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
    for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
      for (at[0] = low[0]; at[0] <= high[0]; at[0]++) bound_lattice_cell(search, at);
  return true;
}

static void bound_leaf(void *data, size_t index, int worker) {
  (void)worker;
  bound_job *job = data;
  const hl_bricks_leaf *leaf = &job->field->leaves[index];
  cell_search search = {.field = job->field, .leaf = leaf, .greatest = NAN};
  const double side = (double)((size_t)1 << (job->field->bricks->shift + leaf->level));
  double low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (double)leaf->brick[axis] * side;
    high[axis] = low[axis] + side;
  }
  hl_cell_tree_visit(job->field->tree, low, high, bound_cell, &search);
  job->bounds[index] = search.greatest;
}

hl_status hl_cell_mesh_bound(hl_context *context, hl_pool *pool, const hl_cell_mesh_field *field,
                             const char *subject, double *bound, hl_error *error) {
  bound_job job = {field, hl_allocate(context, field->leaf_count, sizeof *job.bounds)};
  hl_status status = HL_OK;
  *bound = NAN;
  if (job.bounds == NULL) return hl_fail_memory(error, field->leaf_count * sizeof *job.bounds, subject);
  hl_pool_run(pool, field->leaf_count, bound_leaf, &job);
  if (hl_pool_cancelled(pool)) status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", subject);
  for (size_t n = 0; n < field->leaf_count && status == HL_OK; n++)
    *bound = fmax(*bound, job.bounds[n]); /* a NaN counts as absent */
  hl_release(context, job.bounds);
  return status;
}
