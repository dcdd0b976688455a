/* volume/reslice.c - computes planes of samples of a volume: rows of samples, in one or more layers.
 *
 * In: a volume, and a grid of samples in the volume's indices. Out: a data value for each sample. Rows of a
 * large number of samples are divided among threads. */
#include <halflight/reslice.h>
#include <math.h>

#include "core/door.h"
#include "core/error.h"
#include "core/pool.h"
#include "volume/volume.h"

/* The number of samples from which on several threads compute the samples. */
static const double MANY_SAMPLES = 1 << 20;
static const double MOST_VOXELS = 1e9; /* The greatest magnitude of a number that describes a plane */

void hl_reslice_options_defaults(hl_reslice_options *options) {
  if (options == NULL) return;
  *options = (hl_reslice_options){.struct_size = sizeof *options,
                                  .width = 1,
                                  .height = 1,
                                  .depth = 1,
                                  .across = {1, 0, 0},
                                  .down = {0, 1, 0},
                                  .through = {0, 0, 1},
                                  .blend = HL_BLEND_MAXIMUM};
}

static bool is_bounded(const double numbers[3]) {
  for (int axis = 0; axis < 3; axis++)
    if (!(fabs(numbers[axis]) <= MOST_VOXELS)) return false;
  return true;
}

static hl_status check(const hl_volume *volume, const hl_reslice_options *options, const double *values,
                       hl_error *error) {
  if (volume == NULL || options == NULL || values == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_reslice: null volume, options or values");
  if (options->struct_size != sizeof *options)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_volume_reslice: struct_size is wrong: call hl_reslice_options_defaults()");
  if (options->width < 1 || options->height < 1 || options->depth < 1)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_reslice: width, height and depth must be at least 1");
  if (options->blend < HL_BLEND_MAXIMUM || options->blend > HL_BLEND_MEAN)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_reslice: blend is unknown: give an HL_BLEND_ value");
  if (!is_bounded(options->origin) || !is_bounded(options->across) || !is_bounded(options->down) ||
      !is_bounded(options->through))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_volume_reslice: origin and steps must be numbers of up to 1e9 voxels");
  return HL_OK;
}

/* Returns whether a position in voxel indices lies in a voxel of the grid. A voxel extends half a voxel
 * around its centre. */
static bool is_within(const hl_volume *volume, const double at[3]) {
  for (int axis = 0; axis < 3; axis++)
    if (!(at[axis] >= -0.5 && at[axis] < (double)volume->dimension[axis] - 0.5)) return false;
  return true;
}

static double nearest(const hl_volume *volume, const double at[3]) {
  return hl_volume_value_within(volume, (size_t)floor(at[0] + 0.5), (size_t)floor(at[1] + 0.5),
                                (size_t)floor(at[2] + 0.5));
}

typedef struct reslicing {
  const hl_volume *volume;
  const hl_reslice_options *options;
  double *values; /* [height][width] */
} reslicing;

static double blend_layers(const reslicing *of, size_t column, size_t row) {
  const hl_reslice_options *o = of->options;
  double found = NAN, sum = 0;
  size_t count = 0;
  for (size_t layer = 0; layer < o->depth; layer++) {
    double at[3];
    for (int axis = 0; axis < 3; axis++)
      at[axis] = o->origin[axis] + (double)column * o->across[axis] + (double)row * o->down[axis] +
                 (double)layer * o->through[axis];
    if (!is_within(of->volume, at)) continue;
    double value = o->interpolate ? hl_volume_value_between(of->volume, at) : nearest(of->volume, at);
    if (!isfinite(value)) continue;
    sum += value;
    if (count++ == 0 || (o->blend == HL_BLEND_MAXIMUM ? value > found : value < found)) found = value;
  }
  return o->blend == HL_BLEND_MEAN && count > 0 ? sum / (double)count : found;
}

static void make_row(void *data, size_t row, int worker) {
  (void)worker;
  const reslicing *of = data;
  for (size_t column = 0; column < of->options->width; column++)
    of->values[row * of->options->width + column] = blend_layers(of, column, row);
}

hl_status hl_volume_reslice(const hl_volume *volume, const hl_reslice_options *options, double *values,
                            hl_error *error) {
  HL_DOOR;
  hl_pool *pool = NULL;
  hl_status status = check(volume, options, values, error);
  if (status != HL_OK) return status;
  bool many = (double)options->width * (double)options->height * (double)options->depth >= MANY_SAMPLES;
  status = hl_pool_create(volume->context, many ? 0 : 1, &pool, error);
  if (status != HL_OK) return status;
  reslicing of = {volume, options, values};
  hl_pool_run(pool, options->height, make_row, &of);
  if (hl_pool_cancelled(pool)) status = hl_fail(error, HL_ERROR_CANCELLED, "a plane of voxels: cancelled");
  hl_pool_destroy(pool);
  return status;
}
