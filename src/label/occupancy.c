/* label/occupancy.c - see occupancy.h. */
#include "label/occupancy.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "label/filter.h"

/* Voxels around the labels, as far as their occupancy differs from 0. */
enum { MARGIN = 8 };

/* Smooths along an axis. Derived: a Gaussian of standard deviation 2 voxels, cut
 * at 6, less half of its variance times its second difference. The variances cancel: flat and gently curved
 * surfaces stay where they are (to the fourth power of the scale), and stairs are damped. */
static const label_filter SMOOTHING = {7,
                                       {0.292382144f, 0.238724523f, 0.123441568f, 0.028311217f, -0.011604395f,
                                        -0.014332039f, -0.006349609f, -0.004382337f}};
/* Likewise with a standard deviation of 1 voxel, cut at 3: what mending leaves rough. */
static const label_filter FINISHING = {
    4, {0.555422454f, 0.257481129f, -0.014940464f, -0.018044430f, -0.002207463f}};
/* From values at the voxels' centres to the B-spline's coefficients. Derived: the spline's values 1/6, 2/3,
 * 1/6 are 1 + d/6, d the second difference; its inverse is 1 - d/6 + d d/36 - ... */
static const label_filter TO_COEFFICIENTS = {2, {1.5f, -10.0f / 36, 1.0f / 36}};

/* Smoothing and mending take turns. Mending moves voxels' centres that are on the wrong side of the surface:
 * by PUSH times as much as they are further than TOLERATED beyond 1/2. So thin things stay, and what
 * smoothing moves by a fraction of a voxel stays smooth. */
enum { ROUNDS = 3 };
static const float TOLERATED = 0.12f, PUSH = 2.5f;

/* Occupancy from -1/2 to 1.49 as a byte: stored = 64 + 128 * occupancy. */
static const float STEPS = 128, ZERO = 64;

/* Of a slice: its volume, in voxels; how fast that falls as the level rises; the sum of gradients at the
 * surface. */
enum { VOLUME, FALL, SLOPES, SURFACE_VOXELS, MEASURES };

typedef struct occupancy_job {
  const hl_volume *map;
  double stored; /* the label, as a number of the map's rows */
  hl_label_part part;
  unsigned char *inside;        /* [size z][y][x]: 1 where the voxel has the label; finally the result */
  size_t *inside_counts;        /* [slices]: voxels that have the label */
  label_field smooth;           /* of the part's size */
  float level;                  /* of the field: where the surface is */
  double (*measures)[MEASURES]; /* [slices] */
  double slope;                 /* mean length of the gradient at the surface, per voxel */
} occupancy_job;

/* ---- the parts of the grid ---- */

/* The least and the greatest coordinates of a label's voxels, both included. */
typedef struct label_bounds {
  int64_t low[3], high[3];
} label_bounds;

typedef struct parts_job {
  const hl_volume *map;
  const double *stored; /* [count]; rising: the labels, as numbers of the map's rows */
  size_t count;
  label_bounds *bounds; /* [threads][count] */
} parts_job;

/* The label's place in the list; count where it is not listed. */
static size_t place_of(const parts_job *job, double stored) {
  size_t low = 0, high = job->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (job->stored[middle] < stored) low = middle + 1;
    else high = middle;
  }
  return low < job->count && job->stored[low] == stored ? low : job->count;
}

static void widen(label_bounds *bounds, const int64_t low[3], const int64_t high[3]) {
  for (int a = 0; a < 3; a++) {
    if (low[a] < bounds->low[a]) bounds->low[a] = low[a];
    if (high[a] > bounds->high[a]) bounds->high[a] = high[a];
  }
}

/* Labels come in runs: each run is looked up once. */
static void bound_slice(void *data, size_t z, int worker) {
  const parts_job *job = data;
  label_bounds *bounds = job->bounds + (size_t)worker * job->count;
  const size_t width = job->map->dimension[0];
  for (size_t y = 0; y < job->map->dimension[1]; y++) {
    const hl_number_row row = hl_volume_numbers(job->map, y, z, NULL);
    for (size_t x = 0; x < width;) {
      double stored = hl_row_number(row, x);
      size_t from = x++;
      while (x < width && hl_row_number(row, x) == stored) x++;
      size_t place = place_of(job, stored);
      if (place == job->count) continue;
      widen(&bounds[place], (int64_t[3]){(int64_t)from, (int64_t)y, (int64_t)z},
            (int64_t[3]){(int64_t)x - 1, (int64_t)y, (int64_t)z});
    }
  }
}

/* The part with its margin; of the size 0 where there are no voxels. */
static hl_label_part part_of(const hl_volume *map, const label_bounds *bounds) {
  hl_label_part part = {{0}, {0}};
  for (int axis = 0; axis < 3 && bounds->high[axis] >= 0; axis++) {
    int64_t last = (int64_t)map->dimension[axis] - 1;
    int64_t begin = bounds->low[axis] - MARGIN < 0 ? 0 : bounds->low[axis] - MARGIN;
    int64_t end = bounds->high[axis] + MARGIN > last ? last : bounds->high[axis] + MARGIN;
    part.first[axis] = (size_t)begin;
    part.size[axis] = (size_t)(end - begin + 1);
  }
  return part;
}

static double stored_of(const hl_volume *map, double value) {
  return (value - map->value_offset) / map->value_scale;
}

hl_status hl_label_parts(hl_context *context, hl_pool *pool, const hl_volume *map, const double *labels,
                         size_t count, hl_label_part *parts, hl_error *error) {
  const size_t threads = (size_t)hl_pool_threads(pool);
  double *stored = hl_allocate(context, count, sizeof *stored);
  parts_job job = {map, stored, count, hl_allocate(context, threads * count, sizeof *job.bounds)};
  hl_status status = HL_OK;
  if (stored == NULL || job.bounds == NULL)
    status = hl_fail_memory(error, threads * count * sizeof *job.bounds, "labels");
  for (size_t n = 0; status == HL_OK && n < threads * count; n++)
    job.bounds[n] = (label_bounds){{INT64_MAX, INT64_MAX, INT64_MAX}, {-1, -1, -1}};
  if (status == HL_OK) {
    for (size_t n = 0; n < count; n++) stored[n] = stored_of(map, labels[n]);
    hl_pool_run(pool, map->dimension[2], bound_slice, &job);
    if (hl_pool_cancelled(pool))
      status = hl_fail(error, HL_ERROR_CANCELLED, "cancelled while reading labels");
  }
  for (size_t n = 0; status == HL_OK && n < count; n++) {
    for (size_t t = 1; t < threads; t++)
      widen(&job.bounds[n], job.bounds[t * count + n].low, job.bounds[t * count + n].high);
    parts[n] = part_of(map, &job.bounds[n]);
  }
  hl_release(context, job.bounds);
  hl_release(context, stored);
  return status;
}

/* ---- steps ---- */

static void mark_slice(void *data, size_t z, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  const size_t *first = job->part.first, nx = job->part.size[0];
  size_t at = z * nx * job->part.size[1], count = 0;
  for (size_t y = 0; y < job->part.size[1]; y++, at += nx) {
    const hl_number_row row = hl_volume_numbers(job->map, first[1] + y, first[2] + z, NULL);
    for (size_t i = 0; i < nx; i++) {
      job->inside[at + i] = hl_row_number(row, first[0] + i) == job->stored;
      job->smooth.values[at + i] = job->inside[at + i];
      count += job->inside[at + i];
    }
  }
  job->inside_counts[z] = count;
}

static void mend_slice(void *data, size_t z, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  size_t count = job->part.size[0] * job->part.size[1], at = z * count;
  for (size_t i = at; i < at + count; i++) {
    float beyond = job->inside[i] ? 0.5f - job->smooth.values[i] : job->smooth.values[i] - 0.5f;
    if (!(beyond > TOLERATED)) continue;
    float moved = PUSH * (beyond - TOLERATED);
    job->smooth.values[i] += job->inside[i] ? moved : -moved;
  }
}

/* ---- volumes are kept ---- */

/* Marks the voxels of a row that the surface may cross. room: for a row and two values. Returns how many of
 * the others are above the level. */
static int32_t find_crossed(const occupancy_job *job, size_t y, size_t z, float *room, float *squares,
                            float *crossed) {
  const size_t nx = job->part.size[0], ny = job->part.size[1], nz = job->part.size[2], slice = nx * ny;
  const float *row = job->smooth.values + z * slice + y * nx;
  memcpy(room + 1, row, nx * sizeof *row);
  room[0] = row[0], room[nx + 1] = row[nx - 1];
  const row_neighbours rows = {{room, room + 1, room + 2},
                               {y > 0 ? row - nx : row, y + 1 < ny ? row + nx : row},
                               {z > 0 ? row - slice : row, z + 1 < nz ? row + slice : row}};
  return job->smooth.functions->find_crossed(&rows, nx, job->level, squares, crossed);
}

/* Adds up a row's volume, in voxels, and how fast it falls as the level rises. Derived: near a plane with
 * the gradient g the part of a voxel above the level t is (f - t) / g + 1/2, clamped to [0, 1]. lines: room.
 */
static void measure_row(const occupancy_job *job, size_t y, size_t z, float *lines, double *measures) {
  const size_t nx = job->part.size[0];
  const float *row = job->smooth.values + (z * job->part.size[1] + y) * nx;
  float *squares = lines + nx + 2, *crossed = squares + nx;
  measures[VOLUME] += find_crossed(job, y, z, lines, squares, crossed);
  for (size_t x = 0; x < nx; x++) {
    if (crossed[x] == 0) continue;
    float gradient = 0.5f * sqrtf(squares[x]);
    if (gradient < HL_LEAST_LABEL_GRADIENT) gradient = HL_LEAST_LABEL_GRADIENT;
    float part = (row[x] - job->level) / gradient + 0.5f;
    measures[VOLUME] += part <= 0 ? 0 : part >= 1 ? 1 : (double)part;
    if (!(part > 0 && part < 1)) continue;
    measures[FALL] += 1 / (double)gradient;
    measures[SLOPES] += (double)gradient;
    measures[SURFACE_VOXELS]++;
  }
}

static void measure_slice(void *data, size_t z, int worker) {
  const occupancy_job *job = data;
  float *lines = job->smooth.lines + (size_t)worker * job->smooth.line_floats;
  memset(job->measures[z], 0, sizeof job->measures[z]);
  for (size_t y = 0; y < job->part.size[1]; y++) measure_row(job, y, z, lines, job->measures[z]);
}

/* The level at which the field encloses as much as the labels' voxels are, by Newton's method; near 1/2. */
static void find_level(hl_pool *pool, occupancy_job *job) {
  enum { STEPS_OF_NEWTON = 3 };
  static const double FARTHEST = 0.25;
  double wanted = 0;
  for (size_t z = 0; z < job->part.size[2]; z++) wanted += (double)job->inside_counts[z];
  job->level = 0.5f;
  job->slope = 0.25;
  for (int step = 0; step < STEPS_OF_NEWTON; step++) {
    double sum[MEASURES] = {0};
    hl_pool_run(pool, job->part.size[2], measure_slice, job);
    for (size_t z = 0; z < job->part.size[2]; z++)
      for (int m = 0; m < MEASURES; m++) sum[m] += job->measures[z][m];
    if (!(sum[FALL] > 0)) return;
    job->slope = sum[SLOPES] / sum[SURFACE_VOXELS];
    double level = (double)job->level + (sum[VOLUME] - wanted) / sum[FALL];
    job->level = (float)fmin(fmax(level, 0.5 - FARTHEST), 0.5 + FARTHEST);
  }
}

static void store_slice(void *data, size_t z, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  size_t count = job->part.size[0] * job->part.size[1], at = z * count;
  for (size_t i = at; i < at + count; i++) {
    float stored = ZERO + STEPS * (job->smooth.values[i] + 0.5f - job->level) + 0.5f;
    job->inside[i] = (unsigned char)(stored < 0 ? 0 : stored > 255 ? 255 : stored);
  }
}

static void smooth(hl_pool *pool, occupancy_job *job) {
  hl_pool_run(pool, job->part.size[2], mark_slice, job);
  for (int turn = 0; turn < ROUNDS; turn++) {
    hl_label_filter(pool, &job->smooth, &SMOOTHING);
    hl_pool_run(pool, job->part.size[2], mend_slice, job);
  }
  hl_label_filter(pool, &job->smooth, &FINISHING);
  find_level(pool, job);
  hl_label_filter(pool, &job->smooth, &TO_COEFFICIENTS);
  hl_pool_run(pool, job->part.size[2], store_slice, job);
}

/* ---- the volume ---- */

static hl_status adopt(hl_context *context, const occupancy_job *job, unsigned char *voxels, hl_volume **made,
                       hl_error *error) {
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  const affine3 placed = job->map->index_to_world;
  vec3 origin = affine3_apply(
      placed, (vec3){(double)job->part.first[0], (double)job->part.first[1], (double)job->part.first[2]});
  grid.origin[0] = origin.x, grid.origin[1] = origin.y, grid.origin[2] = origin.z;
  for (int a = 0; a < 3; a++) {
    vec3 axis = mat3_column(placed.linear, a);
    grid.axis[a][0] = axis.x, grid.axis[a][1] = axis.y, grid.axis[a][2] = axis.z;
    grid.dimensions[a] = job->part.size[a];
  }
  grid.type = HL_VOXEL_U8;
  grid.value_scale = 1 / (double)STEPS;
  grid.value_offset = -(double)(ZERO / STEPS);
  grid.space = job->map->space;
  hl_status status = hl_volume_adopt(context, &grid, "labels", voxels, made, error);
  if (status == HL_OK) (*made)->has_surroundings = true; /* 0 */
  if (status == HL_OK) (*made)->surface_slope = job->slope;
  return status;
}

static hl_status fill(hl_context *context, hl_pool *pool, occupancy_job *job, hl_volume **made,
                      hl_error *error) {
  size_t count = job->part.size[0] * job->part.size[1] * job->part.size[2];
  label_field *field = &job->smooth;
  memcpy(field->size, job->part.size, sizeof field->size);
  field->functions = hl_label_row_functions(context->options.instruction_set);
  field->line_floats = hl_label_line_floats(field->size);
  field->lines = hl_allocate(context, (size_t)hl_pool_threads(pool) * field->line_floats,
                             sizeof *field->lines);
  field->values = hl_allocate(context, count, sizeof *field->values);
  job->inside = hl_allocate(context, count, 1);
  job->inside_counts = hl_allocate(context, job->part.size[2], sizeof *job->inside_counts);
  job->measures = hl_allocate(context, job->part.size[2], sizeof *job->measures);
  if (field->lines == NULL || field->values == NULL || job->inside == NULL || job->inside_counts == NULL ||
      job->measures == NULL) {
    hl_release(context, job->inside);
    return hl_fail_memory(error, 5 * count, "smooth labels");
  }
  smooth(pool, job);
  if (hl_pool_cancelled(pool)) {
    hl_release(context, job->inside);
    return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while smoothing labels");
  }
  return adopt(context, job, job->inside, made, error);
}

hl_status hl_label_occupancy(hl_context *context, hl_pool *pool, const hl_volume *map, double label,
                             const hl_label_part *part, hl_volume **made, hl_error *error) {
  *made = NULL;
  if (part->size[0] == 0) return HL_OK;
  occupancy_job job = {.map = map, .stored = stored_of(map, label), .part = *part};
  hl_status status = fill(context, pool, &job, made, error);
  hl_release(context, job.smooth.values);
  hl_release(context, job.smooth.lines);
  hl_release(context, job.inside_counts);
  hl_release(context, job.measures);
  return status;
}
