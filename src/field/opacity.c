/* field/opacity.c - samples volumes into the cells of a lattice. */
#include "field/opacity.h"

#include <string.h>

#include "elementary/elementary.h"
#include "field/surface_links.h"

/* NEAR_CELLS: cells within this distance, in cells, from something visible receive light. A look-up is moved
 * off a surface by up to FIELD_LIFT cells, and then reads the eight cells around its position. */
enum { NEAR_CELLS = 3, MOST_CELLS_ALONG = 512, MOST_MATTER = 256 };

field_lattice hl_field_lattice(const vec3 *points, int count, double voxel, double most_cells) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int i = 0; i < count; i++) {
    const double at[3] = {points[i].x, points[i].y, points[i].z};
    for (int a = 0; a < 3; a++) low[a] = fmin(low[a], at[a]), high[a] = fmax(high[a], at[a]);
  }
  double size[3], cell = voxel;
  for (int a = 0; a < 3; a++) {
    size[a] = fmax(high[a] - low[a], voxel);
    cell = fmax(cell, size[a] / (MOST_CELLS_ALONG - 2 * FIELD_MARGIN - 1));
  }
  for (;;) { /* the edge of the cells grows until there are few enough cells */
    double cells = 1;
    for (int a = 0; a < 3; a++) cells *= ceil(size[a] / cell) + 2 * FIELD_MARGIN;
    if (cells <= most_cells) break;
    cell *= fmax(hl_cbrt(cells / most_cells), 1.005);
  }
  field_lattice lattice = {.cell = cell};
  double corner[3];
  for (int a = 0; a < 3; a++) {
    lattice.count[a] = (int32_t)ceil(size[a] / cell) + 2 * FIELD_MARGIN;
    corner[a] = (low[a] + high[a]) / 2 - cell * lattice.count[a] / 2;
  }
  lattice.low = vec3_of(corner);
  return lattice;
}

void hl_opacity_lay_out(opacity_field *field, opacity_scratch *scratch, hl_layout *layout) {
  *scratch = (opacity_scratch){.seen = hl_layout_take(layout, hl_field_cells(&field->lattice), 1)};
  for (int a = 0; a < 3; a++) {
    field_slices s = hl_field_slices(&field->lattice, a);
    size_t row = (size_t)s.slices * (size_t)s.rows;
    field->depth[a] = hl_layout_take(layout, 3 * row * (size_t)s.stride, sizeof *field->depth[a]);
    field->flags[a] = hl_layout_take(layout, row * (size_t)(s.stride / FIELD_LANES), 1);
  }
  field->seen = hl_layout_take(layout, hl_field_cells(&field->lattice), 1);
}

typedef struct opacity_job {
  opacity_field *field;
  const field_content *content;
  const field_functions *functions;
  int samples, every_other; /* these members have the same meaning as in field_block */
  const float (*reach)[3];  /* [count]; for each volume, half the extent of the box around a cell along each
                             * axis of the volume's index space */
  field_share *share;
  int32_t first, end; /* the range of z for which this process samples cells */
} opacity_job;

/* Returns whether a relevant brick of the grid holds points around `at` (index space). */
static bool reaches_matter(const grid *grid, const float at[3], const float reach[3]) {
  int32_t first[3], last[3];
  for (int a = 0; a < 3; a++) {
    float low = (floorf(at[a] - reach[a]) + 1) / HL_BRICK_CELLS,
          high = (floorf(at[a] + reach[a]) + 1) / HL_BRICK_CELLS;
    if (!(high >= 0 && low < (float)grid->brick_count[a])) return false;
    first[a] = low < 0 ? 0 : (int32_t)low;
    last[a] = high >= (float)grid->brick_count[a] ? grid->brick_count[a] - 1 : (int32_t)high;
  }
  return hl_any_brick_relevant(grid, first, last);
}

/* Returns whether a volume reaches a box around `middle` (frame space), which is `side` cells long and wide
 * and one cell high. */
static bool volume_reaches(const opacity_job *job, int volume, const float middle[3], float side) {
  const field_matter *matter = &job->content->matter[volume];
  float at[3], reach[3];
  if (matter->grid->relevant_count == 0) return false;
  for (int a = 0; a < 3; a++) {
    const float *row = matter->to_index[a];
    at[a] = row[0] * middle[0] + row[1] * middle[1] + row[2] * middle[2] + row[3];
    reach[a] = job->reach[volume][a] * side;
  }
  return reaches_matter(matter->grid, at, reach);
}

/* The cells of a block of sixteen cells that a volume reaches, one bit each. */
static uint32_t cells_of(const opacity_job *job, int volume, const float corner[3], int32_t valid) {
  const float half = (float)job->field->lattice.cell / 2;
  uint32_t bits = 0;
  for (int32_t lane = 0; lane < FIELD_LANES && lane < valid; lane++) {
    const float middle[3] = {corner[0] + half * (float)(2 * lane + 1), corner[1] + half, corner[2] + half};
    if (volume_reaches(job, volume, middle, 1)) bits |= 1u << lane;
  }
  return bits;
}

/* Adds optical depths to cells of the field. axes: the number of the field's arrays `depth` to which the
 * depths are added. */
static void add_depths(opacity_field *field, int axes, const int32_t cell[3], int32_t valid,
                       float depth[3][FIELD_LANES]) {
  for (int a = 0; a < axes; a++) {
    field_slices s = hl_field_slices(&field->lattice, a);
    const int along[3] = {s.axis, s.across, s.down};
    for (int32_t lane = 0; lane < FIELD_LANES && lane < valid; lane++) {
      const int32_t at[3] = {cell[0] + lane, cell[1], cell[2]};
      float *to = field->depth[a] +
                  ((size_t)at[a] * (size_t)s.rows + (size_t)at[s.down]) * 3 * (size_t)s.stride +
                  (size_t)at[s.across];
      for (int k = 0; k < 3; k++) to[k * s.stride] += depth[along[k]][lane];
    }
  }
}

static void find_slab(void *data, size_t index, int worker) {
  const opacity_job *job = data;
  opacity_field *field = job->field;
  const field_lattice *lattice = &field->lattice;
  const field_content *content = job->content;
  index += (size_t)job->first;
  float cell = (float)lattice->cell, low[3];
  (void)worker;
  vec3_store(low, lattice->low);
  for (int32_t y = 0; y < lattice->count[1]; y++)
    for (int32_t x = 0; x < lattice->count[0]; x += FIELD_LANES) {
      uint32_t cells[MOST_MATTER], any = 0, seen = 0;
      const int32_t at[3] = {x, y, (int32_t)index}, valid = lattice->count[0] - x;
      field_block block = {.matter = content->matter,
                           .count = content->count,
                           .cell = cell,
                           .samples = job->samples,
                           .every_other = job->every_other,
                           .cells = cells};
      for (int a = 0; a < 3; a++) block.corner[a] = low[a] + cell * (float)at[a];
      for (int v = 0; v < content->count; v++) {
        cells[v] = cells_of(job, v, block.corner, valid);
        any |= cells[v];
        if (content->matter[v].visible) seen |= cells[v];
      }
      unsigned char *to = field->seen +
                          ((size_t)index * (size_t)lattice->count[1] + (size_t)y) *
                              (size_t)lattice->count[0] +
                          (size_t)x;
      for (int32_t lane = 0; lane < FIELD_LANES && lane < valid; lane++) to[lane] = seen >> lane & 1;
      if (any == 0) continue;
      float depth[3][FIELD_LANES];
      job->functions->opacity(&block, depth);
      add_depths(field, 3, at, valid, depth);
    }
}

/* ---- processes that share a picture ---- */

/* Estimates the time that a slab, all cells of one z, takes. A box of 4 x 4 cells counts 1. Each volume that
 * reaches the box adds SAMPLED, because the box's cells are then sampled. */
static void weigh_slab(void *data, size_t index, int worker) {
  enum { BOX = 4, SAMPLED = 20 };
  const opacity_job *job = data;
  const field_lattice *lattice = &job->field->lattice;
  const float cell = (float)lattice->cell;
  uint64_t weight = 0;
  float low[3];
  (void)worker;
  vec3_store(low, lattice->low);
  for (int32_t y = 0; y < lattice->count[1]; y += BOX)
    for (int32_t x = 0; x < lattice->count[0]; x += BOX) {
      const float middle[3] = {low[0] + cell * ((float)x + BOX / 2), low[1] + cell * ((float)y + BOX / 2),
                               low[2] + cell * ((float)index + 0.5f)};
      weight++;
      for (int v = 0; v < job->content->count; v++)
        if (volume_reaches(job, v, middle, BOX)) weight += SAMPLED;
    }
  job->share->weights[index] = weight;
}

/* Copies the optical depths of a slab (all cells of one z) that another process has sampled, from the third
 * of the field's arrays to the other two. */
static void spread_depths(void *data, size_t index, int worker) {
  const opacity_job *job = data;
  opacity_field *field = job->field;
  const field_slices s = hl_field_slices(&field->lattice, 2);
  const int along[3] = {s.axis, s.across, s.down};
  (void)worker;
  if ((int32_t)index >= job->first && (int32_t)index < job->end) return;
  for (int32_t y = 0; y < s.rows; y++)
    for (int32_t x = 0; x < s.columns; x += FIELD_LANES) {
      const float *from = field->depth[2] + (index * (size_t)s.rows + (size_t)y) * 3 * (size_t)s.stride +
                          (size_t)x;
      float depth[3][FIELD_LANES];
      for (int k = 0; k < 3; k++) memcpy(depth[along[k]], from + k * s.stride, sizeof depth[k]);
      add_depths(field, 2, (const int32_t[3]){x, y, (int32_t)index}, s.columns - x, depth);
    }
}

/* Samples the volumes in all slabs of cells. If processes share a picture, each process samples the volumes
 * only in its own slabs, and the processes then exchange their slabs. */
static void find_slabs(opacity_job *job, hl_pool *pool) {
  opacity_field *field = job->field;
  field_share *share = job->share;
  const int32_t slabs = field->lattice.count[2];
  const field_slices s = hl_field_slices(&field->lattice, 2);
  job->end = slabs;
  if (share->with != NULL) {
    hl_pool_run(pool, (size_t)slabs, weigh_slab, job);
    hl_field_share_ranges(share, slabs);
    job->first = share->first[share->with->part];
    job->end = share->first[share->with->part + 1];
  }
  hl_pool_run(pool, (size_t)(job->end - job->first), find_slab, job);
  if (share->with == NULL) return;
  hl_field_share_complete(share, true, field->depth[2], slabs,
                          3 * (size_t)s.rows * (size_t)s.stride * sizeof *field->depth[2]);
  hl_field_share_complete(share, true, field->seen, slabs, (size_t)s.rows * (size_t)s.columns);
  hl_pool_run(pool, (size_t)slabs, spread_depths, job);
}

/* ---- which cells receive light: those near something visible ---- */

typedef struct spread_job {
  const unsigned char *from;
  unsigned char *to;
  const field_lattice *lattice;
  int axis;
} spread_job;

static void spread_slab(void *data, size_t index, int worker) {
  const spread_job *job = data;
  const int32_t *count = job->lattice->count;
  const ptrdiff_t step[3] = {1, count[0], (ptrdiff_t)count[0] * count[1]};
  (void)worker;
  for (int32_t y = 0; y < count[1]; y++) {
    const ptrdiff_t row = y * step[1] + (ptrdiff_t)index * step[2];
    const int32_t at[3] = {0, y, (int32_t)index};
    unsigned char *to = job->to + row;
    memset(to, 0, (size_t)count[0]);
    for (int32_t i = -NEAR_CELLS; i <= NEAR_CELLS; i++) {
      int32_t first = 0, end = count[0];
      if (job->axis == 0) first = i < 0 ? -i : 0, end = count[0] - (i > 0 ? i : 0);
      else if (at[job->axis] + i < 0 || at[job->axis] + i >= count[job->axis]) continue;
      const unsigned char *from = job->from + row + i * step[job->axis];
      for (int32_t x = first; x < end; x++) to[x] |= from[x];
    }
  }
}

static void spread(opacity_field *field, unsigned char *scratch, hl_pool *pool) {
  size_t slabs = (size_t)field->lattice.count[2];
  unsigned char *from = field->seen, *to = scratch;
  for (int axis = 0; axis < 3; axis++) {
    hl_pool_run(pool, slabs, spread_slab, &(spread_job){from, to, &field->lattice, axis});
    unsigned char *swap = from;
    from = to;
    to = swap;
  }
  memcpy(field->seen, scratch, hl_field_cells(&field->lattice));
}

typedef struct flags_job {
  opacity_field *field;
  const field_share *share;
  int axis;
} flags_job;

static void find_flags(void *data, size_t slice, int worker) {
  const flags_job *job = data;
  opacity_field *field = job->field;
  field_slices s = hl_field_slices(&field->lattice, job->axis);
  const size_t step[3] = {1, (size_t)field->lattice.count[0],
                          (size_t)field->lattice.count[0] * (size_t)field->lattice.count[1]};
  (void)worker;
  for (int32_t row = 0; row < s.rows; row++) {
    size_t at = (slice * (size_t)s.rows + (size_t)row) * (size_t)s.stride;
    const unsigned char *seen = field->seen + slice * step[s.axis] + (size_t)row * step[s.down];
    const bool own = hl_field_share_turn(job->share, s.axis == 2 ? (int32_t)slice : row);
    for (int32_t column = 0; column < s.columns; column += FIELD_LANES) {
      const float *depth = field->depth[job->axis] + 3 * at + (size_t)column;
      bool matter = false;
      for (int k = 0; k < 3; k++)
        for (int32_t lane = 0; lane < FIELD_LANES; lane++) matter |= depth[k * s.stride + lane] > 0;
      unsigned char flags = matter ? FIELD_MATTER : 0;
      for (int32_t lane = 0; lane < FIELD_LANES && column + lane < s.columns; lane++)
        if (own && seen[(size_t)(column + lane) * step[s.across]]) flags |= FIELD_RECEIVES;
      field->flags[job->axis][(at + (size_t)column) / FIELD_LANES] = flags;
    }
  }
}

/* The number of samples along a cell's edge for which samples are no farther apart than voxels, but at most
 * FIELD_SAMPLES. */
static int samples_of(double cell, double voxel) {
  double samples = ceil(cell / voxel - 0.25);
  return samples < 1 ? 1 : samples > FIELD_SAMPLES ? FIELD_SAMPLES : (int)samples;
}

static size_t floats_along(const field_lattice *lattice, int axis) {
  field_slices s = hl_field_slices(lattice, axis);
  return 3 * (size_t)s.slices * (size_t)s.rows * (size_t)s.stride;
}

void hl_opacity_find(const field_content *content, const field_functions *functions,
                     const opacity_scratch *scratch, field_share *share, opacity_field *field,
                     hl_pool *pool) {
  float reach[MOST_MATTER][3];
  for (int v = 0; v < content->count; v++)
    for (int a = 0; a < 3; a++) {
      const float *row = content->matter[v].to_index[a];
      reach[v][a] = (fabsf(row[0]) + fabsf(row[1]) + fabsf(row[2])) * (float)(field->lattice.cell / 2);
    }
  for (int a = 0; a < 3; a++)
    hl_pool_clear(pool, field->depth[a], floats_along(&field->lattice, a) * sizeof *field->depth[a]);
  opacity_job job = {.field = field,
                     .content = content,
                     .functions = functions,
                     .samples = samples_of(field->lattice.cell, content->voxel),
                     .reach = (const float(*)[3])reach,
                     .share = share};
  /* A single sample in the middle of a cell would miss the edge of matter that begins beside the middle, and
   * light would pass through the cell as if it were empty. */
  if (job.samples == 1) job.samples = 2, job.every_other = 1;
  find_slabs(&job, pool);
  if (content->surfaces != NULL) hl_surface_mark_seen(content->surfaces, field);
  spread(field, scratch->seen, pool);
  for (int a = 0; a < 3; a++)
    hl_pool_run(pool, (size_t)field->lattice.count[a], find_flags, &(flags_job){field, share, a});
}
