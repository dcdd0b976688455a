/* volume/coarser.c - see coarser.h. Each row or brick of the finer volume is read only once. */
#include "volume/coarser.h"

#include <math.h>
#include <string.h>

#include "bricks/coarser.h"
#include "core/context.h"
#include "core/memory.h"
#include "volume/in_bricks.h"

static const double ALIKE = 1.5; /* an axis is halved only if its step is shorter than this number times the
                                  * shortest step */

enum {
  MOST_ROWS = 4,
  MOST_VALUES = 2 * MOST_ROWS
}; /* MOST_ROWS: the greatest number of rows that are merged in one row. MOST_VALUES: the greatest number of
    * values that are merged in one value */

typedef struct coarsening {
  const hl_volume *volume;
  hl_coarser_kind kind;
  bool is_continued;     /* whether the volume is a field that is continued beyond walls */
  size_t factor[3];      /* number of voxels merged along each axis: 1 or 2 */
  size_t dimension[3];   /* the dimensions of the coarser volume */
  unsigned char *voxels; /* [dimension[2]][dimension[1]][dimension[0]]; stored values of the coarser volume */
  unsigned char *stored; /* owned; [threads][bytes of a row]; scratch memory for reading rows of a volume with
                          * pages */
  float *numbers;        /* owned; [threads][MOST_ROWS][dimension[0] of the volume]; rows that are merged */
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

/* Reads a row of stored values, and converts them to floats without rounding. stored: scratch memory for a
 * row of a volume with pages. */
static void read_row(const hl_volume *volume, size_t j, size_t k, void *stored, float *numbers) {
  const void *row = hl_volume_row_in(volume, j, k, stored);
  const size_t count = volume->dimension[0];
  switch (volume->storage) {
    case HL_STORAGE_U8:
      for (size_t i = 0; i < count; i++) numbers[i] = ((const uint8_t *)row)[i];
      break;
    case HL_STORAGE_U16:
      for (size_t i = 0; i < count; i++) numbers[i] = ((const uint16_t *)row)[i];
      break;
    case HL_STORAGE_F32: memcpy(numbers, row, count * sizeof *numbers); break;
  }
}

/* The mean of the values that are merged in one voxel, or NAN without values. */
static double mean_of(const float *values, size_t count) {
  double sum = 0;
  for (size_t n = 0; n < count; n++) sum += (double)values[n];
  return count > 0 ? sum / (double)count : (double)NAN;
}

/* The most frequent of the values that are merged in one voxel. If several values are equally frequent, the
 * result is the first of them; without values it is NAN. */
static double commonest_of(const float *values, size_t count) {
  size_t best = 0, most = 0;
  for (size_t n = 0; n + most < count; n++) {
    size_t equal = 0;
    for (size_t m = n; m < count; m++) equal += values[m] == values[n];
    if (equal > most) best = n;
    if (equal > most) most = equal;
  }
  return count > 0 ? (double)values[best] : (double)NAN;
}

/* Collects the finite values among the voxels that are merged in voxel i of the coarser row. Returns their
 * number. */
static size_t collect(const coarsening *c, const float *rows, size_t row_count, size_t i,
                      float values[MOST_VALUES]) {
  const size_t width = c->volume->dimension[0], first = i * c->factor[0];
  size_t count = 0;
  for (size_t r = 0; r < row_count; r++)
    for (size_t at = first; at < first + c->factor[0] && at < width; at++)
      if (isfinite(rows[r * width + at])) values[count++] = rows[r * width + at];
  return count;
}

/* Computes and stores row (j, k) of the coarser volume. */
static void make_row(const coarsening *c, size_t j, size_t k, int worker) {
  const hl_volume *volume = c->volume;
  const size_t width = volume->dimension[0], bytes = hl_storage_bytes(volume->storage);
  float *rows = c->numbers + (size_t)worker * MOST_ROWS * width;
  size_t row_count = 0;
  for (size_t z = k * c->factor[2]; z < (k + 1) * c->factor[2] && z < volume->dimension[2]; z++)
    for (size_t y = j * c->factor[1]; y < (j + 1) * c->factor[1] && y < volume->dimension[1]; y++)
      read_row(volume, y, z, c->stored + (size_t)worker * width * bytes, rows + row_count++ * width);
  unsigned char *to = c->voxels + (k * c->dimension[1] + j) * c->dimension[0] * bytes;
  for (size_t i = 0; i < c->dimension[0]; i++) {
    float values[MOST_VALUES];
    const size_t count = collect(c, rows, row_count, i, values);
    const double merged = c->kind == HL_COARSER_LABELS ? commonest_of(values, count) : mean_of(values, count);
    switch (volume->storage) {
      case HL_STORAGE_U8: to[i] = (uint8_t)(merged + 0.5); break;
      case HL_STORAGE_U16: ((uint16_t *)to)[i] = (uint16_t)(merged + 0.5); break;
      case HL_STORAGE_F32: ((float *)to)[i] = (float)merged; break;
    }
  }
}

static void make_slice(void *data, size_t k, int worker) {
  const coarsening *c = data;
  for (size_t j = 0; j < c->dimension[1]; j++) make_row(c, j, k, worker);
}

/* Sets the origin and the axes of the coarser grid. Each voxel of the coarser grid lies in the middle of the
 * voxels that are merged in it. At the volume's end some of the merged voxels may be missing; the merged
 * voxel is placed as if no voxel were missing. */
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

/* Copies to the coarser volume the properties that do not depend on its resolution: the value around the
 * content, the window, and the file's statements about units, space, labels and fog. */
static void inherit(const hl_volume *volume, hl_volume *made) {
  made->unit = volume->unit;
  made->absence = volume->absence;
  made->is_anatomical = volume->is_anatomical;
  made->says_labels = volume->says_labels;
  made->says_fog = volume->says_fog;
  made->has_surroundings = volume->has_surroundings;
  made->surroundings = volume->surroundings;
  memcpy(made->window, volume->window, sizeof made->window);
}

/* Makes the coarser volume of a field in bricks by leaving out the field's finest level
 * (bricks/coarser.h). */
static hl_status coarsen_bricks(const coarsening *c, hl_pool *pool, hl_volume **coarser, hl_error *error) {
  hl_context *context = c->volume->context;
  hl_volume_description description;
  hl_bricks bricks = {.shift = 0};
  place(c, &description);
  hl_status status = hl_bricks_make_coarser(context, pool, c->volume->bricks, c->is_continued,
                                            "a coarser volume", &bricks, error);
  return status == HL_OK
             ? hl_volume_take_bricks(context, &bricks, &description, "a coarser volume", coarser, error)
             : status;
}

static hl_status coarsen_voxels(coarsening *c, hl_pool *pool, hl_volume **coarser, hl_error *error) {
  const hl_volume *volume = c->volume;
  hl_context *context = volume->context;
  const size_t bytes = hl_storage_bytes(volume->storage), threads = (size_t)hl_pool_threads(pool);
  const size_t count = c->dimension[0] * c->dimension[1] * c->dimension[2];
  c->voxels = hl_allocate(context, count, bytes);
  c->stored = hl_allocate(context, threads * volume->dimension[0], bytes);
  c->numbers = hl_allocate(context, threads * MOST_ROWS * volume->dimension[0], sizeof *c->numbers);
  const bool whole = c->voxels != NULL && c->stored != NULL && c->numbers != NULL;
  hl_status status = whole ? HL_OK : hl_fail_memory(error, count * bytes, "a coarser volume");
  if (status == HL_OK) hl_pool_run(pool, c->dimension[2], make_slice, c);
  if (status == HL_OK) status = hl_pool_check(pool, "making a coarser volume", error);
  hl_release(context, c->stored);
  hl_release(context, c->numbers);
  if (status != HL_OK) {
    hl_release(context, c->voxels);
    return status;
  }
  hl_volume_description description;
  place(c, &description);
  return hl_volume_adopt(context, &description, "a coarser volume", c->voxels, coarser, error);
}

static hl_status make_coarser(const hl_volume *volume, hl_coarser_kind kind, bool is_continued,
                              hl_volume **coarser, hl_error *error) {
  coarsening c = {.volume = volume, .kind = kind, .is_continued = is_continued};
  hl_pool *pool = NULL;
  *coarser = NULL;
  choose_factors(&c);
  hl_status status = hl_pool_create(volume->context, 0, &pool, error);
  if (status == HL_OK)
    status = volume->bricks != NULL ? coarsen_bricks(&c, pool, coarser, error)
                                    : coarsen_voxels(&c, pool, coarser, error);
  hl_pool_destroy(pool);
  if (status == HL_OK) inherit(volume, *coarser);
  return status;
}

/* Makes the walls of a coarser mesh of cells. Matter rises across a wall over the distance of one voxel. If
 * the stored depths reach far enough, matter of the coarser mesh rises over two voxels of the finer mesh. */
static hl_status coarsen_wall(const hl_volume *volume, hl_volume *made, hl_error *error) {
  const hl_volume *wall = volume->wall;
  if (wall == NULL) return HL_OK;
  hl_status status = make_coarser(volume->continued, HL_COARSER_MEANS, true, &made->continued, error);
  if (status == HL_OK) status = make_coarser(wall, HL_COARSER_MEANS, false, &made->wall, error);
  if (status != HL_OK) return status;
  const double deepest = wall->value_scale * UINT16_MAX + wall->value_offset - 0.5,
               rise = deepest / 2 >= 0.5 ? 0.5 : 1;
  made->wall->value_scale = rise * wall->value_scale;
  made->wall->value_offset = 0.5 + rise * (wall->value_offset - 0.5);
  made->wall->slope_scale = 2 * rise * wall->slope_scale;
  return HL_OK;
}

hl_status hl_volume_make_coarser(const hl_volume *volume, hl_coarser_kind kind, hl_volume **coarser,
                                 hl_error *error) {
  hl_status status = make_coarser(volume, kind, false, coarser, error);
  if (status == HL_OK) status = coarsen_wall(volume, *coarser, error);
  if (status == HL_OK) return HL_OK;
  hl_volume_release(*coarser);
  *coarser = NULL;
  return status;
}
