/* volume/formats/amr/amr.c - makes volumes of adaptive grids, as amr.h describes. A grid of one level has no
 * refined cells, and becomes an ordinary volume of dense voxels. */
#include "volume/formats/amr/amr.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/in_bricks.h"

/* The number of times that a cell is halved to refine it by a ratio. Returns -1 unless the ratio is a power
 * of two from 2 to 2^10. */
static int halvings(int ratio) {
  for (int steps = 1; steps <= 10; steps++)
    if (ratio == 1 << steps) return steps;
  return -1;
}

static hl_status check_shape(const hl_amr_shape *shape, const char *subject, hl_error *error) {
  bool sound = shape->levels >= 1 && shape->levels <= HL_AMR_LEVELS_MOST;
  for (int axis = 0; axis < 3 && sound; axis++)
    sound = shape->count[axis] > 0 && shape->count[axis] < 1u << 30 && isfinite(shape->origin[axis]) &&
            isfinite(shape->spacing[axis]) && shape->spacing[axis] > 0 && shape->first[axis] > -(1 << 30) &&
            shape->first[axis] < 1 << 30;
  if (!sound)
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: an adaptive grid of %d levels and %zu x %zu x %zu coarsest cells is impossible: there may "
        "be %d levels, and a cell must have a finite size",
        subject, shape->levels, shape->count[0], shape->count[1], shape->count[2], HL_AMR_LEVELS_MOST);
  for (int level = 0; level + 1 < shape->levels; level++)
    if (halvings(shape->ratio[level]) < 0)
      return hl_fail(
          error, HL_ERROR_UNSUPPORTED,
          "%s: level %d is refined by %d, which is no power of two: resample it to refinement by 2 or 4",
          subject, level, shape->ratio[level]);
  return HL_OK;
}

hl_status hl_amr_begin(hl_context *context, const hl_amr_shape *shape, const char *subject, hl_amr *amr,
                       hl_error *error) {
  size_t domain[3];
  int steps = 0;
  *amr = (hl_amr){.context = context, .shape = *shape, .subject = subject};
  hl_status status = check_shape(shape, subject, error);
  if (status != HL_OK) return status;
  for (int level = shape->levels - 1; level >= 0; level--) {
    amr->lattice_level[level] = steps;
    if (level > 0) steps += halvings(shape->ratio[level - 1]);
  }
  bool fits = steps < BRICK_LEVELS_LIMIT;
  for (int axis = 0; axis < 3; axis++) {
    fits = fits && shape->count[axis] <= (size_t)INT32_MAX >> steps;
    domain[axis] = fits ? shape->count[axis] << steps : 0;
  }
  if (!fits)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: the finest cells are 2^%d times as fine as the coarsest, or number more than 2^31 along an "
        "axis: save it without the finest levels",
        subject, steps);
  return hl_patches_create(context, steps + 1, domain, &amr->patches, error);
}

/* The number of cells of a level along the edge of a cell of level 0. */
static ptrdiff_t refinement(const hl_amr *amr, int level) {
  return (ptrdiff_t)1 << (amr->lattice_level[0] - amr->lattice_level[level]);
}

hl_status hl_amr_add(hl_amr *amr, int level, const ptrdiff_t first[3], const size_t count[3],
                     const float *values, hl_error *error) {
  size_t begin[3] = {0, 0, 0};
  if (level < 0 || level >= amr->shape.levels)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a patch of level %d: there are levels 0 to %d", amr->subject,
                   level, amr->shape.levels - 1);
  for (int axis = 0; axis < 3; axis++) {
    ptrdiff_t domain = amr->shape.first[axis] * refinement(amr, level);
    if (first[axis] < domain)
      return hl_fail(error, HL_ERROR_INPUT, "%s: a patch of level %d begins before the domain", amr->subject,
                     level);
    begin[axis] = (size_t)(first[axis] - domain);
  }
  return hl_patches_add(amr->patches, amr->lattice_level[level], begin, count, values, amr->subject, error);
}

void hl_amr_set_spacing(hl_amr *amr, const double spacing[3]) {
  for (int axis = 0; axis < 3 && spacing[0] > 0; axis++)
    amr->shape.spacing[axis] = spacing[axis] * (double)refinement(amr, amr->shape.levels - 1);
}

/* Describes the volume's grid, whose voxels have the size of the finest level's cells. */
static hl_volume_description grid_of(const hl_amr *amr) {
  hl_volume_description grid;
  double cells = (double)((size_t)1 << amr->lattice_level[0]); /* number of cells of the finest level along a
                                                                * cell of level 0 */
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_F32;
  for (int axis = 0; axis < 3; axis++) {
    double step = amr->shape.spacing[axis] / cells;
    grid.dimensions[axis] = amr->shape.count[axis] << amr->lattice_level[0];
    grid.axis[axis][axis] = step;
    grid.origin[axis] = amr->shape.origin[axis] + step / 2;
  }
  return grid;
}

static hl_status make_dense(const hl_amr *amr, const hl_volume_description *grid, hl_volume **volume,
                            hl_error *error) {
  const size_t *n = grid->dimensions;
  size_t count = n[0];
  if (!hl_multiply(count, n[1], &count) || !hl_multiply(count, n[2], &count))
    return hl_fail_memory(error, SIZE_MAX, amr->subject);
  float *voxels = hl_allocate(amr->context, count, sizeof *voxels);
  if (voxels == NULL) return hl_fail_memory(error, count * sizeof *voxels, amr->subject);
  hl_patches_copy(amr->patches, voxels);
  return hl_volume_adopt(amr->context, grid, amr->subject, voxels, volume, error);
}

hl_status hl_amr_finish(hl_amr *amr, hl_volume **volume, hl_error *error) {
  hl_volume_description grid = grid_of(amr);
  hl_pool *pool = NULL;
  hl_bricks bricks = {.shift = 0};
  double difference = NAN;
  hl_status status = hl_volume_check_grid(&grid, amr->subject, error);
  if (status != HL_OK) return status;
  if (amr->lattice_level[0] == 0) return make_dense(amr, &grid, volume, error);
  status = hl_pool_create(amr->context, 0, &pool, error);
  if (status == HL_OK)
    status = hl_patches_build(amr->patches, pool, amr->subject, &bricks, &difference, error);
  hl_patches_destroy(amr->patches);
  amr->patches = NULL;
  hl_pool_destroy(pool);
  if (status == HL_OK)
    status = hl_volume_take_bricks(amr->context, &bricks, &grid, amr->subject, volume, error);
  if (status == HL_OK) hl_volume_set_field_error(*volume, difference, "exact", "the means over the cells");
  return status;
}

void hl_amr_close(hl_amr *amr) {
  hl_patches_destroy(amr->patches);
  amr->patches = NULL;
}
