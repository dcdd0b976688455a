/* light/soft_cascade.c - the groups of a cascade, and the light that passes them. */
#include "light/soft_cascade.h"

#include <string.h>

#include "core/memory.h"

/* A uniform disk of diameter D has the variance D^2 / 16 along an axis, a box of width L has L^2 / 12: the box that
 * stands for the disk has L = D sqrt(12 / 16) (derived). */
static const double BOX_OF_DISK = 0.86602540378443865;

/* Chunks that a sweep is cut into at most, and the least omega of one, pixels. */
static const double GREATEST_CHUNKS = 160, LEAST_CHUNK = 1;

static double omega_at(const soft_cascade *cascade, double height) {
  if (cascade->parallel) return cascade->rate * height;
  double distance = height - cascade->light_height;
  return distance > 0 ? -cascade->rate / distance : -INFINITY;
}

/* Levels keep four pixels of their own to the penumbra that their nearest group gives. */
static int level_scale(const soft_cascade *cascade, int level) {
  double penumbra = cascade->chunk * pow(2, level);
  int scale = 1;
  while (scale * 8 <= penumbra && scale < 1 << level) scale *= 2;
  return scale;
}

static void set_ones(float *values, size_t count) {
  for (size_t i = 0; i < count; i++) values[i] = 1;
}

static hl_status open_level(hl_context *context, soft_cascade *cascade, int index, const shadow_buffer *buffer,
                            hl_error *error) {
  cascade_level *level = &cascade->level[index];
  size_t channels = (size_t)cascade->channels;
  level->scale = level_scale(cascade, index);
  if (index > 0 && level->scale > 2 * cascade->level[index - 1].scale) level->scale = 2 * cascade->level[index - 1].scale;
  level->tiles_x = (buffer->tiles_x + level->scale - 1) / level->scale;
  level->tiles_y = (buffer->tiles_y + level->scale - 1) / level->scale;
  level->stride = (size_t)level->tiles_x * TILE + 2 * CASCADE_MARGIN;
  level->plane = ((size_t)level->tiles_y * TILE + 2 * CASCADE_MARGIN) * level->stride;
  level->origin = CASCADE_MARGIN * level->stride + CASCADE_MARGIN;
  size_t planes = channels * CASCADE_GROUPS * 2 + 2 + (index == 0 ? channels : 0);
  level->memory = hl_allocate(context, planes * level->plane, sizeof(float));
  if (level->memory == NULL) return hl_fail_memory(error, planes * level->plane * sizeof(float), "a cascade of shadows");
  set_ones(level->memory, planes * level->plane);
  float *next = level->memory + level->origin;
  for (int g = 0; g < CASCADE_GROUPS; g++)
    for (size_t c = 0; c < channels; c++) {
      level->group[g].transmittance[c] = next;
      level->group[g].passed[c] = next + level->plane;
      next += 2 * level->plane;
    }
  for (int i = 0; i < 2; i++, next += level->plane) level->scratch[i] = next;
  for (size_t c = 0; c < channels && index == 0; c++, next += level->plane) cascade->current[c] = next;
  cascade->level_count = index + 1;
  return HL_OK;
}

hl_status hl_soft_cascade_begin(hl_context *context, soft_cascade *cascade, const light_source *source, vec3 normal,
                                double first, double last, double pixel, shadow_buffer *buffer, hl_error *error) {
  double tilt = fmax(vec3_dot(source->direction, normal), 0.1);
  *cascade = (soft_cascade){.parallel = source->parallel, .channels = buffer->channels, .stretch = 1 / tilt};
  cascade->rate = BOX_OF_DISK * source->size / pixel / (source->parallel ? tilt : 1);
  cascade->light_height = vec3_dot(source->position, normal);
  double start = omega_at(cascade, first), end = omega_at(cascade, last);
  if (!isfinite(start)) start = end - 1e4; /* the light lies within the sheets: its nearest ones have no end of width */
  cascade->chunk = fmax(LEAST_CHUNK, (end - start) / GREATEST_CHUNKS);
  cascade->chunk_start = start;
  /* level j is first used after 2^(j+1) - 1 chunks (derived: a level passes two of its three groups on) */
  int levels = 1 + (int)floor(log2((end - start) / cascade->chunk + 3));
  hl_status status = HL_OK;
  for (int i = 0; i < levels && i < CASCADE_LEVELS && status == HL_OK; i++)
    status = open_level(context, cascade, i, buffer, error);
  return status;
}

void hl_soft_cascade_release(hl_context *context, soft_cascade *cascade) {
  for (int i = 0; i < CASCADE_LEVELS; i++) hl_release(context, cascade->level[i].memory);
  *cascade = (soft_cascade){0};
}

/* ---- whole-field operations, a row of tiles a task ---- */

typedef struct field_task {
  int tiles_x;
  field_job field;
  field_tile_function *field_function;
  blur_job blur;
  blur_tile_function *blur_function;
  shadow_buffer *buffer;
  lit_blocks_function *lit_blocks;
} field_task;

static void run_field_row(void *data, size_t index, int worker) {
  (void)worker;
  const field_task *task = data;
  for (int x = 0; x < task->tiles_x; x++) {
    if (task->field_function != NULL) task->field_function(&task->field, x, (int)index);
    if (task->blur_function != NULL) task->blur_function(&task->blur, x, (int)index);
  }
}

static void run_field(hl_pool *pool, const cascade_level *level, field_tile_function *function, field_job job) {
  field_task task = {.tiles_x = level->tiles_x, .field = job, .field_function = function};
  hl_pool_run(pool, (size_t)level->tiles_y, run_field_row, &task);
}

static void run_blur(hl_pool *pool, const cascade_level *level, blur_tile_function *function, const float *from, float *to,
                     size_t stride_to, double variance) {
  /* a discrete box of odd width w has the variance (w^2 - 1) / 12 */
  double width = fmin(sqrt(12 * variance + 1), 2 * CASCADE_MARGIN - 5);
  field_task task = {.tiles_x = level->tiles_x, .blur = {from, to, level->stride, stride_to, hl_blur_box((float)width)},
                     .blur_function = function};
  hl_pool_run(pool, (size_t)level->tiles_y, run_field_row, &task);
}

/* ---- the cascade ---- */

/* Variances along u and v between two widths, in pixels of the level. */
typedef struct variances { double u, v; } variances;

static variances variance_between(const soft_cascade *cascade, double wide, double narrow, int scale) {
  double v = fmax(wide * wide - narrow * narrow, 0) / 12 / ((double)scale * scale);
  return (variances){v * cascade->stretch * cascade->stretch, v};
}

static void copy_rows(const cascade_level *level, const float *from, float *to) {
  memcpy(to - level->origin, from - level->origin, level->plane * sizeof(float));
}

/* The two oldest groups of a level become one of the next. */
static void merge_up(soft_cascade *cascade, int index, hl_pool *pool, const cascade_functions *functions) {
  cascade_level *level = &cascade->level[index], *next = &cascade->level[index + 1];
  cascade_group *a = &level->group[0], *b = &level->group[1], *to = &next->group[next->count++];
  bool halve = next->scale > level->scale;
  for (int c = 0; c < cascade->channels; c++)
    run_field(pool, next, halve ? functions->multiply_half : functions->multiply,
              (field_job){a->transmittance[c], b->transmittance[c], to->transmittance[c], level->stride, next->stride});
  to->weight = a->weight + b->weight;
  to->omega = (a->omega * a->weight + b->omega * b->weight) / to->weight;
  to->renewed = true;
  cascade_group oldest = *a, newest = level->group[2];
  level->group[2] = level->group[1];
  level->group[1] = oldest;
  level->group[0] = newest;
  level->group[0].renewed = true;
  level->count = 1;
}

static void push_chunk(soft_cascade *cascade, hl_pool *pool, const cascade_functions *functions) {
  cascade_level *level = &cascade->level[0];
  cascade_group *to = &level->group[level->count++];
  for (int c = 0; c < cascade->channels; c++) {
    float *fresh = to->transmittance[c];
    to->transmittance[c] = cascade->current[c];
    cascade->current[c] = fresh;
    set_ones(fresh - level->origin, level->plane);
  }
  to->weight = cascade->chunk_weight;
  to->omega = cascade->chunk_sum / cascade->chunk_weight;
  to->renewed = true;
  cascade->chunk_weight = cascade->chunk_sum = 0;
  cascade->chunks++;
  for (int i = 0; i + 1 < cascade->level_count && cascade->level[i].count == CASCADE_GROUPS; i++)
    merge_up(cascade, i, pool, functions);
}

/* What passed the group before (from, on its level), blurred for this group, times this group. */
static void pass_group(const soft_cascade *cascade, const cascade_level *from_level, const cascade_group *from,
                       const cascade_level *level, cascade_group *group, double receiver, hl_pool *pool,
                       const cascade_functions *functions) {
  variances variance = variance_between(cascade, receiver - from->omega, receiver - group->omega, from_level->scale);
  for (int c = 0; c < cascade->channels; c++) {
    run_blur(pool, from_level, functions->blur.rows, from->passed[c], from_level->scratch[0], from_level->stride, variance.u);
    run_blur(pool, from_level, functions->blur.columns, from_level->scratch[0], from_level->scratch[1], from_level->stride,
             variance.v);
    bool finer = level->scale < from_level->scale;
    run_field(pool, level, finer ? functions->multiply_double : functions->multiply,
              (field_job){group->transmittance[c], from_level->scratch[1], group->passed[c], from_level->stride,
                          level->stride});
  }
}

/* From the farthest group to the nearest; levels are renewed in turn, the thicker the more rarely. */
static const cascade_group *pass_all(soft_cascade *cascade, double receiver, hl_pool *pool,
                                     const cascade_functions *functions) {
  cascade_group *before = NULL;
  const cascade_level *before_level = NULL;
  bool due = false;
  for (int i = cascade->level_count - 1; i >= 0; i--) {
    cascade_level *level = &cascade->level[i];
    uint64_t period = i < 2 ? 1 : (uint64_t)1 << (i - 1);
    due = due || cascade->chunks % period == 0;
    for (int g = 0; g < level->count; g++) {
      cascade_group *group = &level->group[g];
      due = due || group->renewed;
      if (due && before == NULL)
        for (int c = 0; c < cascade->channels; c++) copy_rows(level, group->transmittance[c], group->passed[c]);
      else if (due)
        pass_group(cascade, before_level, before, level, group, receiver, pool, functions);
      group->renewed = false;
      before = group;
      before_level = level;
    }
  }
  return before;
}

static void find_lit(void *data, size_t index, int worker) {
  (void)worker;
  const field_task *task = data;
  shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < task->tiles_x; x++) {
    const float *transmittance[HL_CHANNELS] = {NULL, NULL, NULL};
    for (int c = 0; c < buffer->channels; c++)
      transmittance[c] = buffer->transmittance[c] + index * TILE * buffer->stride + (size_t)x * TILE;
    buffer->tile_lit[index * (size_t)buffer->tiles_x + (size_t)x] =
        (uint16_t)task->lit_blocks(transmittance, buffer->channels, buffer->stride);
  }
}

/* The buffer that sheets look up, for receivers around omega = receiver. */
static void refill_buffer(soft_cascade *cascade, shadow_buffer *buffer, double receiver, hl_pool *pool,
                          const cascade_functions *functions) {
  const cascade_group *nearest = pass_all(cascade, receiver, pool, functions);
  const cascade_level *level = &cascade->level[0];
  variances variance = variance_between(cascade, receiver - nearest->omega, 0, 1);
  for (int c = 0; c < cascade->channels; c++) {
    run_blur(pool, level, functions->blur.rows, nearest->passed[c], level->scratch[0], level->stride, variance.u);
    run_blur(pool, level, functions->blur.columns, level->scratch[0], buffer->transmittance[c], buffer->stride, variance.v);
  }
  field_task task = {.tiles_x = buffer->tiles_x, .buffer = buffer, .lit_blocks = functions->blur.lit_blocks};
  hl_pool_run(pool, (size_t)buffer->tiles_y, find_lit, &task);
}

void hl_soft_cascade_advance(soft_cascade *cascade, shadow_buffer *buffer, double from, double to, hl_pool *pool,
                             const cascade_functions *functions) {
  double omega = omega_at(cascade, to), middle = omega_at(cascade, (from + to) / 2);
  if (!isfinite(middle)) return;
  cascade->chunk_weight += 1;
  cascade->chunk_sum += middle;
  if (omega - cascade->chunk_start < cascade->chunk) return;
  push_chunk(cascade, pool, functions);
  cascade->chunk_start = omega;
  refill_buffer(cascade, buffer, omega + cascade->chunk / 2, pool, functions);
}
