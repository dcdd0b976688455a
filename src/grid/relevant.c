/* grid/relevant.c - see relevant.h. */
#include "grid/relevant.h"

#include <math.h>
#include <string.h>

#include "grid/bounds.h"

/* ---- bricks ---- */

void hl_brick_bounds(const grid *grid, const int32_t b[3], double margin, double centre[3], double half[3]) {
  for (int axis = 0; axis < 3; axis++) {
    double low = (double)b[axis] * HL_BRICK_CELLS - 1, high = low + HL_BRICK_CELLS;
    if (b[axis] == 0) low -= margin;
    if (high >= grid->dimension[axis] - 1) high = grid->dimension[axis] - 0.5 + margin;
    centre[axis] = (low + high) / 2;
    half[axis] = (high - low) / 2;
  }
}

/* Finds the box, in index space, around the bricks from `first` to `last`. */
static void box_of_bricks(const grid *grid, const int32_t first[3], const int32_t last[3], double margin,
                          double low[3], double high[3]) {
  double centre[3], half[3];
  hl_brick_bounds(grid, first, margin, centre, half);
  for (int axis = 0; axis < 3; axis++) low[axis] = centre[axis] - half[axis];
  hl_brick_bounds(grid, last, margin, centre, half);
  for (int axis = 0; axis < 3; axis++) high[axis] = centre[axis] + half[axis];
}

bool hl_relevant_bounds(const grid *grid, double margin, double low[3], double high[3]) {
  if (grid->relevant_count == 0) return false;
  box_of_bricks(grid, grid->relevant_low, grid->relevant_high, margin, low, high);
  return true;
}

void hl_content_bounds(const grid *grid, double margin, double low[3], double high[3]) {
  box_of_bricks(grid, grid->content_low, grid->content_high, margin, low, high);
}

/* The value in `relevant` that marks a brick that only a mask hides, and that would be relevant without the
 * mask. */
enum { HIDDEN = 2 };

typedef struct brick_job {
  grid *grid;
  const classifier *classifier;
} brick_job;

/* Returns whether the cells of brick b overlap the box to which the volume is clipped, or come closer to the
 * box than a voxel. */
static bool overlaps_box(const grid *grid, const int32_t b[3]) {
  for (int axis = 0; axis < 3; axis++) {
    double low = (double)b[axis] * HL_BRICK_CELLS - 1, high = low + HL_BRICK_CELLS;
    if (high + 1 < grid->box_low[axis] || low - 1 > grid->box_high[axis]) return false;
  }
  return true;
}

/* The distance around a brick, in voxels, within which matter depends on the brick's voxels: the kernel's
 * radius plus one cell. If cuts or a mask leave any matter within this distance, the brick is needed. */
enum { BESIDE_CUT = 3 };

/* Returns whether cuts remove brick b and its surroundings, both for the eye and for lights. */
static bool is_cut_away(const grid *grid, const int32_t b[3]) {
  double low[3], high[3];
  if (grid->cut_count == 0 || grid->cut_casts_shadow) return false;
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = (double)b[axis] * HL_BRICK_CELLS - 1 - BESIDE_CUT;
    high[axis] = low[axis] + HL_BRICK_CELLS + 2 * BESIDE_CUT;
  }
  return hl_cuts_remove_box(grid->cuts, grid->cut_count, low, high);
}

/* Returns whether a mask hides brick b and its surroundings. */
static bool is_hidden(const brick_job *job, const int32_t b[3]) {
  const mask_lattice *mask = &job->classifier->mask;
  const affine3 *place = &job->grid->index_to_frame;
  vec3 half[3];
  double middle[3];
  if (mask->factors == NULL) return false;
  for (int axis = 0; axis < 3; axis++) {
    middle[axis] = ((double)b[axis] + 0.5) * HL_BRICK_CELLS - 1;
    half[axis] = vec3_scale(mat3_column(place->linear, axis), 0.5 * HL_BRICK_CELLS + BESIDE_CUT);
  }
  return hl_mask_hides_box(mask, affine3_apply(*place, vec3_of(middle)), half);
}

static void mark_bricks(void *data, size_t index, int worker) {
  (void)worker;
  brick_job *job = data;
  grid *grid = job->grid;
  int32_t b[3] = {0, 0, (int32_t)index};
  size_t at = index * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[0];
  for (b[1] = 0; b[1] < grid->brick_count[1]; b[1]++)
    for (b[0] = 0; b[0] < grid->brick_count[0]; b[0]++, at++) {
      float bounds[2];
      hl_bounds_of_brick(grid, at, bounds);
      bool shows = overlaps_box(grid, b) && !is_cut_away(grid, b) &&
                   hl_classifier_range_visible(job->classifier, grid, bounds[0], bounds[1]);
      grid->relevant[at] = !shows ? 0 : is_hidden(job, b) ? HIDDEN : 1;
    }
}

/* Widens a range of bricks, from low to high, so that it includes brick b. */
static void widen_to_brick(const int32_t b[3], bool first, int32_t low[3], int32_t high[3]) {
  for (int axis = 0; axis < 3; axis++) {
    if (first || b[axis] < low[axis]) low[axis] = b[axis];
    if (first || b[axis] > high[axis]) high[axis] = b[axis];
  }
}

/* Finds the bounds of the content. Afterwards, bricks that only a mask hides count as not relevant. */
static void find_content(grid *grid) {
  bool first = true;
  for (size_t at = 0; at < hl_grid_bricks(grid); at++) {
    if (grid->relevant[at] == 0) continue;
    int32_t b[3];
    hl_brick_coordinates(grid, (uint32_t)at, b);
    widen_to_brick(b, first, grid->content_low, grid->content_high);
    first = false;
    if (grid->relevant[at] == HIDDEN) grid->relevant[at] = 0;
  }
}

/* The number of voxels that brick b owns along one axis. Every voxel has one owner. */
static int voxels_along(int32_t b, int32_t count) {
  int32_t first = b * HL_BRICK_CELLS, last = first + HL_BRICK_CELLS;
  if (last > count) last = count;
  return last > first ? last - first : 0;
}

/* Returns whether a brick has a visible cell. Call this function after mark_cells() and before
 * fill_lookups(). */
static bool has_visible_cell(const grid *grid, size_t brick) {
  return grid->lookup[1].visible == NULL || grid->lookup[1].visible[brick];
}

/* ---- which cells show something ---- */

typedef struct cell_job {
  grid *grid;
  uint16_t least_high[256]; /* for each lower bound, the least upper bound that makes some value between the
                             * two bounds visible; 256 if no upper bound does */
} cell_job;

static void find_least_high(const classifier *classifier, const grid *grid, uint16_t least_high[256]) {
  for (int low = 255; low >= 0; low--) {
    int high = low;
    while (high < 256 &&
           !hl_classifier_span_visible(classifier, grid, grid->cell_base + (float)low * grid->cell_step,
                                       grid->cell_base + (float)high * grid->cell_step))
      high++;
    least_high[low] = (uint16_t)high;
  }
}

/* The number of bytes of the packed bounds of a row of bricks. */
static size_t packed_row_bytes(const grid *grid, const unsigned char *even) {
  size_t count = (size_t)grid->brick_count[0], alike = 0;
  for (size_t i = 0; i < hl_even_row_bytes(grid); i++) alike += (size_t)__builtin_popcount(even[i]);
  return alike * EVEN_BYTES + (count - alike) * UNEVEN_BYTES;
}

/* Writes 1 for each of a brick's groups of 2x2x2 cells that shows something. Returns whether any group shows
 * something. */
static unsigned char mark_cells_of_brick(const cell_job *job, const int32_t brick[3],
                                         const unsigned char *bounds, bool even) {
  const cell_lookup *lookup = &job->grid->lookup[0];
  unsigned char any = 0;
  if (even && bounds[1] < job->least_high[bounds[0]]) return 0;
  for (int32_t cell = 0; cell < BRICK_CELLS; cell++) {
    int32_t x = 2 * brick[0] + cell % 2, y = 2 * brick[1] + cell / 2 % 2, z = 2 * brick[2] + cell / 4;
    bool shows = even || bounds[BRICK_CELLS + cell] >= job->least_high[bounds[cell]];
    if (!shows || x >= lookup->count[0] || y >= lookup->count[1] || z >= lookup->count[2]) continue;
    lookup->visible[((size_t)z * (size_t)lookup->count[1] + (size_t)y) * (size_t)lookup->count[0] +
                    (size_t)x] = any = 1;
  }
  return any;
}

static void mark_cell_layer(void *data, size_t layer, int worker) {
  (void)worker;
  const cell_job *job = data;
  const grid *grid = job->grid;
  const cell_lookup *fine = &grid->lookup[0], *coarse = &grid->lookup[1];
  size_t plane = (size_t)fine->count[0] * (size_t)fine->count[1], width = (size_t)grid->brick_count[0];
  int32_t slices = fine->count[2] - 2 * (int32_t)layer < 2 ? 1 : 2;
  memset(fine->visible + 2 * layer * plane, 0, (size_t)slices * plane);
  memset(coarse->visible + layer * width * (size_t)grid->brick_count[1], 0,
         width * (size_t)grid->brick_count[1]);
  const unsigned char *even = grid->cell_bounds[layer];
  const unsigned char *bounds = even + hl_even_row_bytes(grid) * (size_t)grid->brick_count[1];
  for (int32_t y = 0; y < grid->brick_count[1]; y++, even += hl_even_row_bytes(grid)) {
    size_t row = (layer * (size_t)grid->brick_count[1] + (size_t)y) * width;
    if (memchr(grid->relevant + row, 1, width) == NULL) {
      bounds += packed_row_bytes(grid, even);
      continue;
    }
    for (int32_t x = 0; x < grid->brick_count[0]; x++) {
      bool same = hl_brick_is_even(even, x);
      if (grid->relevant[row + (size_t)x])
        coarse->visible[row + (size_t)x] = mark_cells_of_brick(job, (int32_t[3]){x, y, (int32_t)layer},
                                                               bounds, same);
      bounds += same ? EVEN_BYTES : UNEVEN_BYTES;
    }
  }
}

static void mark_cells(grid *grid, const classifier *classifier, hl_pool *pool) {
  if (grid->lookup[0].visible == NULL) return;
  cell_job job = {.grid = grid};
  find_least_high(classifier, grid, job.least_high);
  hl_pool_run(pool, (size_t)grid->brick_count[2], mark_cell_layer, &job);
}

/* ---- look-ups of boxes of cells ---- */

/* Masks for a byte of `visible` (cell_lookup): the bits of the boxes that are three units long along x, y or
 * z. */
enum { THREE_ALONG_X = 0xaa, THREE_ALONG_Y = 0xcc, THREE_ALONG_Z = 0xf0 };

/* Converts the marks of a row of units (1: the unit is visible) into the bytes of look-ups (grid.h). The
 * boxes of these look-ups are two or three units long along x. */
static void look_up_row(unsigned char *cells, size_t width) {
  for (size_t x = 0; x + 2 < width; x++)
    cells[x] = (unsigned char)(-(cells[x] | cells[x + 1]) | (-cells[x + 2] & THREE_ALONG_X));
  for (size_t x = width < 2 ? 0 : width - 2; x < width; x++)
    cells[x] = (unsigned char)-(cells[x] | cells[width - 1]);
}

/* Combines look-ups, in place, so that their boxes become two or three units long along y or z, for `width`
 * neighbouring units along x. cells: the first unit's byte. step: distance from a unit to the next along y or
 * z. three: the bits of boxes that are three units long along this axis. */
static void join_axis(unsigned char *cells, size_t step, int32_t count, size_t width, unsigned char three) {
  for (int32_t i = 0; i + 2 < count; i++) {
    unsigned char *cell = cells + (size_t)i * step;
    for (size_t x = 0; x < width; x++)
      cell[x] |= (unsigned char)(cell[x + step] | (cell[x + 2 * step] & three));
  }
  if (count < 2) return;
  unsigned char *cell = cells + (size_t)(count - 2) * step;
  for (size_t x = 0; x < width; x++) cell[x] |= cell[x + step];
}

/* Makes the look-ups of a slice: boxes along x and y. */
static void look_up_slice(void *data, size_t index, int worker) {
  (void)worker;
  const cell_lookup *lookup = data;
  size_t width = (size_t)lookup->count[0];
  unsigned char *visible = lookup->visible + index * width * (size_t)lookup->count[1];
  for (int32_t y = 0; y < lookup->count[1]; y++) look_up_row(visible + (size_t)y * width, width);
  join_axis(visible, width, lookup->count[1], width, THREE_ALONG_Y);
}

/* Extends the look-ups of a row along z, in all slices. */
static void look_up_across(void *data, size_t index, int worker) {
  (void)worker;
  const cell_lookup *lookup = data;
  size_t width = (size_t)lookup->count[0];
  join_axis(lookup->visible + index * width, width * (size_t)lookup->count[1], lookup->count[2], width,
            THREE_ALONG_Z);
}

static void fill_lookups(grid *grid, hl_pool *pool) {
  if (grid->lookup[0].visible == NULL) return;
  for (int i = 0; i < LOOKUP_SIZES; i++) {
    hl_pool_run(pool, (size_t)grid->lookup[i].count[2], look_up_slice, &grid->lookup[i]);
    hl_pool_run(pool, (size_t)grid->lookup[i].count[1], look_up_across, &grid->lookup[i]);
  }
}

/* ---- a bit for each cell ---- */

/* The greatest number of bytes that the bits of cells (grid->cell_bits) may take; volumes that would need
 * more bytes have no bits. The bits take an eighth of a byte per voxel, which would be a great part of the
 * memory of a large volume. */
static const uint64_t GREATEST_BYTES = 8 << 20;
/* The bits of cells are read only if at least this fraction of the cells in visible bricks shows nothing. */
static const double LEAST_LEFT_OUT = 1.0 / 8;

void hl_cell_bits_lay_out(grid *grid, hl_layout *layout) {
  size_t bricks = hl_grid_bricks(grid);
  if (bricks * sizeof *grid->cell_bits <= GREATEST_BYTES)
    grid->cell_bits = hl_layout_take(layout, bricks, sizeof *grid->cell_bits);
}

typedef struct bits_job {
  grid *grid;
  brick_bits_function *brick_bits;
  float sign, threshold; /* a value is visible where sign * stored value > threshold */
  size_t first;          /* see hl_bricks_run() */
  /* number of visible bricks, and number of the cells of these bricks that may show something; changed
   * atomically */
  uint64_t bricks, set_bits;
} bits_job;

/* Finds the comparison that tells whether a voxel is visible: whether its value, times a sign, lies above a
 * threshold. Sums of floats and the rounded weights of u8 voxels may have errors of 6e-6 of the greatest
 * number and of 1e-3 of a table's entry. The function lowers the threshold by more than these errors. Returns
 * false if floats are too coarse to tell values apart at the threshold. */
static bool find_threshold(const grid *grid, const classifier *classifier, bits_job *job) {
  double high = (double)grid->cell_base + 255.0 * (double)grid->cell_step;
  double greatest = fmax(fmax(fabs((double)grid->cell_base), fabs(high)), fabs((double)grid->empty));
  double scale = (double)classifier->scale;
  if (scale == 0 || !isfinite(scale) || !(greatest > 1e-30) || !(greatest < 1e30)) return false;
  double value = ((double)classifier->first_visible - (double)classifier->offset) / scale +
                 (double)grid->empty;
  job->sign = scale > 0 ? 1 : -1;
  job->threshold = (float)(value * (double)job->sign - 8e-6 * greatest - 2e-3 / fabs(scale));
  /* a sum of zeros is exactly zero, so the threshold is not lowered below zero */
  float at_zero = -grid->empty * classifier->scale + classifier->offset;
  if (scale > 0 && grid->cell_base >= 0 && at_zero <= classifier->first_visible)
    job->threshold = fmaxf(job->threshold, 0);
  return isfinite(job->threshold);
}

/* Finds the bits of a brick's cells. A brick that is not relevant needs bits, too, because a ray may go from
 * a value in this brick on one sheet to a visible value on the next sheet. */
static uint64_t find_bits(const bits_job *job, size_t at, const int32_t brick[3]) {
  const grid *grid = job->grid;
  float bounds[2];
  hl_bounds_of_brick(grid, at, bounds);
  float low = job->sign > 0 ? bounds[0] : -bounds[1], high = job->sign > 0 ? bounds[1] : -bounds[0];
  if (high <= job->threshold) return 0;
  return low > job->threshold ? UINT64_MAX : job->brick_bits(grid, brick, job->sign, job->threshold);
}

static void find_layer_bits(void *data, size_t index, int worker) {
  (void)worker;
  const bits_job *job = data;
  const grid *grid = job->grid;
  const size_t layer = job->first + index;
  size_t at = layer * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[0];
  for (int32_t y = 0; y < grid->brick_count[1]; y++)
    for (int32_t x = 0; x < grid->brick_count[0]; x++, at++)
      grid->cell_bits[at] = find_bits(job, at, (const int32_t[3]){x, y, (int32_t)layer});
}

static void count_layer_bits(void *data, size_t layer, int worker) {
  (void)worker;
  bits_job *job = data;
  const grid *grid = job->grid;
  const size_t bricks_of_layer = (size_t)grid->brick_count[1] * (size_t)grid->brick_count[0],
               end = (layer + 1) * bricks_of_layer;
  uint64_t bricks = 0, set_bits = 0;
  for (size_t at = layer * bricks_of_layer; at < end; at++) {
    if (!grid->relevant[at] || !has_visible_cell(grid, at)) continue;
    bricks++;
    set_bits += (uint64_t)__builtin_popcountll(grid->cell_bits[at]);
  }
  __atomic_fetch_add(&job->bricks, bricks, __ATOMIC_RELAXED);
  __atomic_fetch_add(&job->set_bits, set_bits, __ATOMIC_RELAXED);
}

static void find_cell_bits(grid *grid, const classifier *classifier, brick_bits_function *brick_bits,
                           hl_pool *pool) {
  bits_job job = {.grid = grid, .brick_bits = brick_bits};
  const size_t layers = (size_t)grid->brick_count[2], bytes = hl_grid_bricks(grid) * sizeof *grid->cell_bits;
  grid->cell_bits_tell = grid->cell_bits != NULL && find_threshold(grid, classifier, &job);
  if (!grid->cell_bits_tell) {
    if (grid->cell_bits != NULL) memset(grid->cell_bits, 0xff, bytes); /* every cell may show something */
    return;
  }
  hl_bricks_run(pool, grid, find_layer_bits, &job, &job.first, grid->cell_bits, bytes / layers);
  if (grid->pages != NULL) hl_pages_forget(grid->pages);
  hl_pool_run(pool, layers, count_layer_bits, &job);
  double cells = 64 * (double)job.bricks;
  grid->cell_bits_tell = cells - (double)job.set_bits >= LEAST_LEFT_OUT * cells;
}

/* ---- all steps together ---- */

/* Finds which faces of the box can cut something visible: the faces that the box around all relevant bricks
 * touches or comes closer to than a voxel. */
static void find_faces(grid *grid, bool any_relevant) {
  grid->cut = any_relevant && grid->cut_count > 0;
  for (int axis = 0; axis < 3; axis++) {
    double low = (double)grid->relevant_low[axis] * HL_BRICK_CELLS - 1,
           high = (double)(grid->relevant_high[axis] + 1) * HL_BRICK_CELLS - 1;
    bool cut_low = any_relevant && low - 1 < grid->box_low[axis],
         cut_high = any_relevant && high + 1 > grid->box_high[axis];
    grid->face_low[axis] = cut_low ? (float)grid->box_low[axis] : -FACE_FAR_OUT;
    grid->face_high[axis] = cut_high ? (float)grid->box_high[axis] : FACE_FAR_OUT;
    grid->cut = grid->cut || cut_low || cut_high;
  }
}

/* Lists the relevant bricks that have a visible cell. For all relevant bricks together, finds the least and
 * greatest coordinates, the number of voxels, and the faces of the box that the bricks reach. */
static void list_relevant(grid *grid) {
  grid->kept_voxels = 0;
  grid->relevant_count = 0;
  bool first = true;
  for (size_t at = 0; at < hl_grid_bricks(grid); at++) {
    if (!grid->relevant[at]) continue;
    int32_t b[3];
    hl_brick_coordinates(grid, (uint32_t)at, b);
    widen_to_brick(b, first, grid->relevant_low, grid->relevant_high);
    first = false;
    if (has_visible_cell(grid, at)) grid->relevant_list[grid->relevant_count++] = (uint32_t)at;
    grid->kept_voxels += (uint64_t)voxels_along(b[0], grid->dimension[0]) *
                         (uint64_t)voxels_along(b[1], grid->dimension[1]) *
                         (uint64_t)voxels_along(b[2], grid->dimension[2]);
  }
  find_faces(grid, !first);
}

void hl_grid_mark_relevant(grid *grid, const grid_functions *functions, const classifier *classifier,
                           hl_pool *pool) {
  brick_job job = {grid, classifier};
  hl_pool_run(pool, (size_t)grid->brick_count[2], mark_bricks, &job);
  find_content(grid);
  mark_cells(grid, classifier, pool);
  list_relevant(grid);
  find_cell_bits(grid, classifier, functions->brick_bits, pool);
  fill_lookups(grid, pool);
}

void hl_open_faces(grid *grid, const struct grid *other) {
  static const double TOUCHING = 1e-3;
  const affine3 placed = affine3_multiply(grid->frame_to_index, other->index_to_frame);
  const vec3 low_corner = vec3_of(other->box_low), high_corner = vec3_of(other->box_high);
  const vec3 half = vec3_scale(vec3_subtract(high_corner, low_corner), 0.5);
  const vec3 at = affine3_apply(placed, vec3_add(low_corner, half));
  const double middle[3] = {at.x, at.y, at.z};
  double low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    const vec3 *row = &placed.linear.row[axis];
    double reach = fabs(row->x) * half.x + fabs(row->y) * half.y + fabs(row->z) * half.z;
    low[axis] = middle[axis] - reach;
    high[axis] = middle[axis] + reach;
  }
  for (int axis = 0; axis < 3; axis++) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (low[u] > grid->box_high[u] - TOUCHING || high[u] < grid->box_low[u] + TOUCHING ||
        low[v] > grid->box_high[v] - TOUCHING || high[v] < grid->box_low[v] + TOUCHING)
      continue;
    if (fabs(high[axis] - grid->box_low[axis]) < TOUCHING) grid->face_low[axis] = -FACE_FAR_OUT;
    if (fabs(low[axis] - grid->box_high[axis]) < TOUCHING) grid->face_high[axis] = FACE_FAR_OUT;
  }
}
