/* volume/coarser.c - see coarser.h. One pass over the rows of the volume, or over its bricks. */
#include "volume/coarser.h"

#include <math.h>
#include <string.h>

#include "bricks/coarser.h"
#include "core/context.h"
#include "core/memory.h"
#include "volume/in_bricks.h"

static const double ALIKE =
    1.5; /* axes with steps up to this factor beyond the shortest are halved together */

typedef struct coarsening {
  const hl_volume *volume;
  size_t factor[3];    /* 1 or 2 */
  size_t dimension[3]; /* of the coarser volume */
  void *row;           /* owned; a row of stored values of a volume with pages */
  double *sums;        /* owned; [dimension[0]]; sums of stored values */
  uint32_t *counts;    /* owned; [dimension[0]]; number of finite values in each sum */
} coarsening;

static double step_length(const hl_volume *volume, int axis) {
  return vec3_length(mat3_column(volume->index_to_world.linear, axis));
}

static void choose_factors(coarsening *c) {
  double shortest = INFINITY;
  for (int axis = 0; axis < 3; axis++) shortest = fmin(shortest, step_length(c->volume, axis));
  for (int axis = 0; axis < 3; axis++) {
    c->factor[axis] = c->volume->bricks != NULL || step_length(c->volume, axis) < ALIKE * shortest ? 2 : 1;
    c->dimension[axis] = (c->volume->dimension[axis] + c->factor[axis] - 1) / c->factor[axis];
  }
}

static void add_row(coarsening *c, size_t j, size_t k) {
  const hl_volume *volume = c->volume;
  const void *row = hl_volume_row_in(volume, j, k, c->row);
  for (size_t i = 0; i < volume->dimension[0]; i++) {
    double value = hl_stored_number(volume->storage, row, i);
    if (!isfinite(value)) continue;
    c->sums[i / c->factor[0]] += value;
    c->counts[i / c->factor[0]]++;
  }
}

/* Row (j, k) of the coarser volume. */
static void make_row(coarsening *c, size_t j, size_t k, void *to) {
  size_t count = c->dimension[0];
  memset(c->sums, 0, count * sizeof *c->sums);
  memset(c->counts, 0, count * sizeof *c->counts);
  for (size_t z = k * c->factor[2]; z < (k + 1) * c->factor[2] && z < c->volume->dimension[2]; z++)
    for (size_t y = j * c->factor[1]; y < (j + 1) * c->factor[1] && y < c->volume->dimension[1]; y++)
      add_row(c, y, z);
  for (size_t i = 0; i < count; i++) {
    double mean = c->counts[i] > 0 ? c->sums[i] / c->counts[i] : NAN;
    switch (c->volume->storage) {
      case HL_STORAGE_U8: ((uint8_t *)to)[i] = (uint8_t)(mean + 0.5); break;
      case HL_STORAGE_U16: ((uint16_t *)to)[i] = (uint16_t)(mean + 0.5); break;
      case HL_STORAGE_F32: ((float *)to)[i] = (float)mean; break;
    }
  }
}

/* The coarser grid: a voxel lies in the middle of the voxels whose mean it is. Where the volume ends before
 * that, the voxel lies as if all voxels were there. */
static void place(const coarsening *c, hl_volume_description *d) {
  static const hl_voxel_type types[] = {
      [HL_STORAGE_U8] = HL_VOXEL_U8, [HL_STORAGE_U16] = HL_VOXEL_U16, [HL_STORAGE_F32] = HL_VOXEL_F32};
  const hl_volume *volume = c->volume;
  vec3 origin = volume->index_to_world.offset;
  hl_volume_description_defaults(d);
  for (int axis = 0; axis < 3; axis++) {
    vec3 step = mat3_column(volume->index_to_world.linear, axis);
    origin = vec3_add(origin, vec3_scale(step, ((double)c->factor[axis] - 1) / 2));
    step = vec3_scale(step, (double)c->factor[axis]);
    memcpy(d->axis[axis], (const double[3]){step.x, step.y, step.z}, sizeof d->axis[axis]);
    d->dimensions[axis] = c->dimension[axis];
  }
  memcpy(d->origin, (const double[3]){origin.x, origin.y, origin.z}, sizeof d->origin);
  d->type = types[volume->storage];
  d->value_scale = volume->value_scale;
  d->value_offset = volume->value_offset;
  d->space = volume->space;
}

static hl_status average(coarsening *c, unsigned char *voxels, hl_error *error) {
  size_t row_bytes = c->dimension[0] * hl_storage_bytes(c->volume->storage);
  for (size_t k = 0; k < c->dimension[2]; k++) {
    if (hl_cancelled(c->volume->context))
      return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while a coarser volume was made");
    for (size_t j = 0; j < c->dimension[1]; j++)
      make_row(c, j, k, voxels + (k * c->dimension[1] + j) * row_bytes);
  }
  return HL_OK;
}

/* What surrounds the content, and what the file tells of its world, stay. */
static void inherit(const hl_volume *volume, hl_volume *made) {
  made->unit = volume->unit;
  made->is_anatomical = volume->is_anatomical;
  made->has_surroundings = volume->has_surroundings;
  made->surroundings = volume->surroundings;
  memcpy(made->window, volume->window, sizeof made->window);
}

/* The coarser field has no finest level (bricks/coarser.h). */
static hl_status coarsen_bricks(const coarsening *c, hl_volume **coarser, hl_error *error) {
  hl_context *context = c->volume->context;
  hl_volume_description description;
  hl_bricks bricks = {.shift = 0};
  hl_pool *pool = NULL;
  place(c, &description);
  hl_status status = hl_pool_create(context, 0, &pool, error);
  if (status == HL_OK)
    status = hl_bricks_make_coarser(context, pool, c->volume->bricks, "a coarser volume", &bricks, error);
  hl_pool_destroy(pool);
  return status == HL_OK
             ? hl_volume_take_bricks(context, &bricks, &description, "a coarser volume", coarser, error)
             : status;
}

static hl_status coarsen_voxels(coarsening *c, hl_volume **coarser, hl_error *error) {
  const hl_volume *volume = c->volume;
  hl_context *context = volume->context;
  size_t bytes = hl_storage_bytes(volume->storage), rows = c->dimension[1] * c->dimension[2];
  unsigned char *voxels = hl_allocate(context, c->dimension[0] * rows, bytes);
  c->row = volume->pages != NULL ? hl_allocate(context, volume->dimension[0], bytes) : NULL;
  c->sums = hl_allocate(context, c->dimension[0], sizeof *c->sums);
  c->counts = hl_allocate(context, c->dimension[0], sizeof *c->counts);
  bool whole = voxels != NULL && (volume->pages == NULL || c->row != NULL) && c->sums != NULL &&
               c->counts != NULL;
  hl_status status = whole ? average(c, voxels, error)
                           : hl_fail_memory(error, c->dimension[0] * rows * bytes, "a coarser volume");
  hl_release(context, c->row);
  hl_release(context, c->sums);
  hl_release(context, c->counts);
  if (status != HL_OK) {
    hl_release(context, voxels);
    return status;
  }
  hl_volume_description description;
  place(c, &description);
  return hl_volume_adopt(context, &description, "a coarser volume", voxels, coarser, error);
}

hl_status hl_volume_make_coarser(const hl_volume *volume, hl_volume **coarser, hl_error *error) {
  coarsening c = {.volume = volume};
  *coarser = NULL;
  choose_factors(&c);
  hl_status status = volume->bricks != NULL ? coarsen_bricks(&c, coarser, error)
                                            : coarsen_voxels(&c, coarser, error);
  if (status == HL_OK) inherit(volume, *coarser);
  return status;
}
