/* label/occupancy.c - see occupancy.h. */
#include "label/occupancy.h"

#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "label/enclosed.h"
#include "label/levels.h"

/* The filter that smooths along an axis. Derived: the filter is G - sigma^2 / 2 * (second difference of G),
 * where G is a Gaussian of standard deviation sigma = 2 voxels, cut at 6. The filter's variance is therefore
 * 0. So smoothing removes the steps between voxels, but leaves flat and gently curved surfaces in their
 * places, up to terms of the fourth power of the scale. */
static const label_filter SMOOTHING = {7,
                                       {0.292382144f, 0.238724523f, 0.123441568f, 0.028311217f, -0.011604395f,
                                        -0.014332039f, -0.006349609f, -0.004382337f}};
/* A filter like SMOOTHING, with a standard deviation of 1 voxel, cut at 3. This filter smooths the roughness
 * that mending leaves. */
static const label_filter FINISHING = {
    4, {0.555422454f, 0.257481129f, -0.014940464f, -0.018044430f, -0.002207463f}};
/* The filter that turns values at the voxels' centres into the B-spline's coefficients. Derived: the spline
 * weighs coefficients by 1/6, 2/3, 1/6, which is 1 + d/6 where d is the second difference. Its inverse is 1 -
 * d/6 + d d/36 - ... */
static const label_filter TO_COEFFICIENTS = {2, {1.5f, -10.0f / 36, 1.0f / 36}};

/* Smoothing and mending alternate, ROUNDS times each. Mending corrects voxels whose centres are on the wrong
 * side of the surface and whose values differ from 1/2 by more than TOLERATED: mending changes the value by
 * PUSH times the excess over TOLERATED, so that thin things do not vanish. Surfaces that smoothing has moved
 * by less than a voxel are not corrected, and stay smooth. */
enum { ROUNDS = 2 };
static const float TOLERATED = 0.12f, PUSH = 2.5f;

/* Occupancies from -1/2 to 1.49 are stored as bytes: stored = 64 + 128 * occupancy. */
static const float STEPS = 128, ZERO = 64;

typedef struct occupancy_job {
  const hl_volume *map;
  const int64_t *labels; /* [count], rising; the labels whose common occupancy is made */
  size_t count;
  hl_label_part part;
  unsigned char *inside; /* [size z][y][x]; first: 1 if the voxel has one of the labels, else 0; at the end:
                          * the occupancy as bytes */
  size_t *inside_counts; /* [size z]; the number of voxels that have one of the labels */
  label_field smooth;    /* the smoothed field, of the size of `part` */
  label_levels levels;
  label_enclosed enclosed;
  hl_label_work *work;
} occupancy_job;

/* ---- steps ---- */

size_t hl_label_part_voxels(const hl_label_part *part) {
  return part->size[0] * part->size[1] * part->size[2];
}

void hl_label_worked(hl_label_work *work, size_t voxels, int steps) {
  work->done += (double)voxels * steps;
  hl_progress(work->context, "prepare", work->done / (HL_LABEL_STEPS * work->whole));
}

/* Marks the voxels of a slice that have one of the labels. Labels come in runs, and each run is looked up
 * once. */
static void mark_slice(void *data, size_t z, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  const size_t *first = job->part.first, nx = job->part.size[0];
  size_t at = z * nx * job->part.size[1], count = 0;
  for (size_t y = 0; y < job->part.size[1]; y++, at += nx) {
    const hl_number_row row = hl_volume_numbers(job->map, first[1] + y, first[2] + z, NULL);
    for (size_t i = 0; i < nx;) {
      const size_t run = first[0] + i;
      const bool is = hl_label_place(job->labels, job->count, job->map, row, run) < job->count;
      do {
        job->inside[at + i] = is;
        job->smooth.values[at + i] = is;
        count += is;
      } while (++i < nx && hl_row_repeats(row, first[0] + i, run));
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

static void store_slice(void *data, size_t z, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  size_t count = job->part.size[0] * job->part.size[1], at = z * count;
  for (size_t i = at; i < at + count; i++) {
    float stored = ZERO + STEPS * (job->smooth.values[i] + 0.5f - job->enclosed.level) + 0.5f;
    job->inside[i] = (unsigned char)(stored < 0 ? 0 : stored > 255 ? 255 : stored);
  }
}

/* Reports that the part's voxels have taken one more of the HL_LABEL_STEPS steps. */
static void step_done(const occupancy_job *job) {
  hl_label_worked(job->work, hl_label_part_voxels(&job->part), 1);
}

static void smooth(hl_pool *pool, occupancy_job *job) {
  hl_pool_run(pool, job->part.size[2], mark_slice, job);
  for (int turn = 0; turn < ROUNDS; turn++) {
    hl_label_filter(pool, &job->smooth, &SMOOTHING);
    hl_pool_run(pool, job->part.size[2], mend_slice, job);
    step_done(job);
  }
  hl_label_filter(pool, &job->smooth, &FINISHING);
  step_done(job);
  hl_label_level(pool, job->inside, &job->smooth, &job->levels);
  step_done(job);
  hl_label_filter(pool, &job->smooth, &TO_COEFFICIENTS);
  for (size_t z = 0; z < job->part.size[2]; z++) job->enclosed.wanted += (double)job->inside_counts[z];
  hl_label_enclose(pool, &job->enclosed);
  step_done(job);
  hl_pool_run(pool, job->part.size[2], store_slice, job);
  step_done(job);
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
  if (status == HL_OK) (*made)->has_surroundings = true; /* beyond the volume, values count as 0 */
  if (status == HL_OK) (*made)->surface_slope = job->enclosed.slope;
  return status;
}

/* Allocates the memory for all steps of making an occupancy; the result is allocated elsewhere. */
static bool make_room(hl_context *context, int threads, occupancy_job *job) {
  const size_t count = hl_label_part_voxels(&job->part);
  label_field *field = &job->smooth;
  memcpy(field->size, job->part.size, sizeof field->size);
  field->functions = hl_label_row_functions(context->options.instruction_set);
  field->line_floats = hl_label_line_floats(field->size);
  field->lines = hl_allocate(context, (size_t)threads * field->line_floats, sizeof *field->lines);
  field->values = hl_allocate(context, count, sizeof *field->values);
  hl_label_levels_size(field->size, job->levels.size);
  const size_t *cells = job->levels.size;
  job->levels.values = hl_allocate(context, HL_LEVEL_PLANES * cells[0] * cells[1] * cells[2],
                                   sizeof *job->levels.values);
  job->inside_counts = hl_allocate(context, job->part.size[2], sizeof *job->inside_counts);
  job->enclosed.field = field;
  job->enclosed.measures = hl_allocate(context, job->part.size[2], sizeof *job->enclosed.measures);
  return field->lines != NULL && field->values != NULL && job->levels.values != NULL &&
         job->inside_counts != NULL && job->enclosed.measures != NULL;
}

static hl_status fill(hl_context *context, hl_pool *pool, occupancy_job *job, hl_volume **made,
                      hl_error *error) {
  const size_t count = hl_label_part_voxels(&job->part);
  job->inside = hl_allocate(context, count, 1);
  if (!make_room(context, hl_pool_threads(pool), job) || job->inside == NULL) {
    const size_t *cells = job->levels.size;
    size_t level_floats = HL_LEVEL_PLANES * cells[0] * cells[1] * cells[2];
    hl_release(context, job->inside);
    return hl_fail_memory(error, count * (1 + sizeof(float)) + level_floats * sizeof(float), "smooth labels");
  }
  smooth(pool, job);
  if (hl_pool_cancelled(pool)) {
    hl_release(context, job->inside);
    return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while smoothing labels");
  }
  return adopt(context, job, job->inside, made, error);
}

hl_status hl_label_occupancy(hl_context *context, hl_pool *pool, const hl_volume *map, const int64_t *labels,
                             size_t count, const hl_label_part *part, hl_label_work *work, hl_volume **made,
                             hl_error *error) {
  *made = NULL;
  if (part->size[0] == 0) return HL_OK;
  occupancy_job job = {.map = map, .labels = labels, .count = count, .part = *part, .work = work};
  hl_status status = fill(context, pool, &job, made, error);
  hl_release(context, job.smooth.values);
  hl_release(context, job.smooth.lines);
  hl_release(context, job.levels.values);
  hl_release(context, job.inside_counts);
  hl_release(context, job.enclosed.measures);
  return status;
}
