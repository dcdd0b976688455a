/* light/soft_cascade.c - the groups of a cascade, and the light that passes them. */
#include "light/soft_cascade.h"

#include <string.h>

#include "core/memory.h"

/* A uniform disk of diameter D has the variance D^2 / 16 along an axis, a box of width L has L^2 / 12: the box that
 * stands for the disk has L = D sqrt(12 / 16) (derived). */
static const double BOX_OF_DISK = 0.86602540378443865;

/* Chunks that a sweep is cut into at most, and the least omega of one, pixels. */
static const double GREATEST_CHUNKS = 96, LEAST_CHUNK = 2;

static double omega_at(const soft_cascade *cascade, double height) {
  if (cascade->parallel) return cascade->rate * height;
  double distance = height - cascade->light_height;
  return distance > 0 ? -cascade->rate / distance : -INFINITY;
}

/* Levels keep at least four pixels of their own to the narrowest penumbra that they give: level j starts at least
 * 5 (2^j - 1) chunks behind the receiver, since every level before it keeps five groups. */
static int level_scale(const soft_cascade *cascade, int level) {
  double penumbra = cascade->chunk * 5 * (pow(2, level) - 1);
  int scale = 1;
  while (scale * 8 <= penumbra && scale < 1 << level) scale *= 2;
  return scale;
}

static void set_ones(float *values, size_t count) {
  for (size_t i = 0; i < count; i++) values[i] = 1;
}

/* Hands out the next plane of a level's memory. */
static cascade_field next_field(cascade_level *level, size_t *used) {
  size_t tiles = (size_t)level->tiles_x * (size_t)level->tiles_y, index = (*used)++;
  return (cascade_field){level->memory + index * level->plane + level->origin, level->flags + index * tiles};
}

static hl_status open_level(hl_context *context, soft_cascade *cascade, int index, const shadow_buffer *buffer,
                            hl_error *error) {
  cascade_level *level = &cascade->level[index];
  level->scale = level_scale(cascade, index);
  if (index > 0 && level->scale > 2 * cascade->level[index - 1].scale) level->scale = 2 * cascade->level[index - 1].scale;
  level->tiles_x = (buffer->tiles_x + level->scale - 1) / level->scale;
  level->tiles_y = (buffer->tiles_y + level->scale - 1) / level->scale;
  level->stride = (size_t)level->tiles_x * TILE + 2 * CASCADE_MARGIN;
  level->plane = ((size_t)level->tiles_y * TILE + 2 * CASCADE_MARGIN) * level->stride;
  level->origin = CASCADE_MARGIN * level->stride + CASCADE_MARGIN;
  size_t channels = (size_t)cascade->channels, used = 0, tiles = (size_t)level->tiles_x * (size_t)level->tiles_y;
  size_t planes = channels * (CASCADE_GROUPS + 2) + 1 + (index == 0 ? channels : 0);
  level->memory = hl_allocate(context, planes * level->plane, sizeof(float));
  level->flags = hl_allocate(context, planes, tiles);
  if (level->memory == NULL || level->flags == NULL)
    return hl_fail_memory(error, planes * level->plane * sizeof(float), "a cascade of shadows");
  set_ones(level->memory, planes * level->plane);
  memset(level->flags, 1, planes * tiles);
  for (size_t c = 0; c < channels; c++) {
    for (int g = 0; g < CASCADE_GROUPS; g++) level->group[g].transmittance[c] = next_field(level, &used);
    for (int i = 0; i < 2; i++) level->passed[i][c] = next_field(level, &used);
  }
  level->scratch = next_field(level, &used);
  for (size_t c = 0; c < channels && index == 0; c++) cascade->current[c] = next_field(level, &used);
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
  /* level j is first used after 6 * 2^j - 5 chunks (derived: a level keeps five of its seven groups) */
  int levels = 1 + (int)floor(log2(fmax((end - start) / cascade->chunk + 7, 6) / 6));
  hl_status status = HL_OK;
  for (int i = 0; i < levels && i < CASCADE_LEVELS && status == HL_OK; i++)
    status = open_level(context, cascade, i, buffer, error);
  return status;
}

void hl_soft_cascade_release(hl_context *context, soft_cascade *cascade) {
  for (int i = 0; i < CASCADE_LEVELS; i++) {
    hl_release(context, cascade->level[i].memory);
    hl_release(context, cascade->level[i].flags);
  }
  *cascade = (soft_cascade){0};
}

/* ---- whole-field operations, a row of tiles a task; tiles of ones are skipped ---- */

static void store_ones(float *pixels, size_t stride, size_t tile_x, size_t tile_y) {
  for (size_t row = 0; row < TILE; row++) set_ones(pixels + (tile_y * TILE + row) * stride + tile_x * TILE, TILE);
}

/* True if all tiles of the level's rectangle are ones; what lies outside is. */
static bool all_ones(const cascade_level *level, const cascade_field *field, int x0, int x1, int y0, int y1) {
  for (int y = y0 < 0 ? 0 : y0; y <= y1 && y < level->tiles_y; y++)
    for (int x = x0 < 0 ? 0 : x0; x <= x1 && x < level->tiles_x; x++)
      if (!field->ones[y * level->tiles_x + x]) return false;
  return true;
}

typedef struct multiply_task {
  const cascade_level *level, *level_a, *level_b; /* of to, a and b */
  const cascade_field *a, *b, *to;
  field_job job;
  field_tile_function *function;
} multiply_task;

static bool product_is_ones(const multiply_task *task, int x, int y) {
  const cascade_level *levels[2] = {task->level_a, task->level_b};
  const cascade_field *fields[2] = {task->a, task->b};
  for (int i = 0; i < 2; i++) {
    int coarse = levels[i]->scale, own = task->level->scale, x0 = x, y0 = y, x1 = x, y1 = y;
    if (coarse < own) x0 = 2 * x, x1 = 2 * x + 1, y0 = 2 * y, y1 = 2 * y + 1;
    if (coarse > own) x0 = (x - 1) / 2, x1 = (x + 1) / 2, y0 = (y - 1) / 2, y1 = (y + 1) / 2;
    if (!all_ones(levels[i], fields[i], x0, x1, y0, y1)) return false;
  }
  return true;
}

static void multiply_row(void *data, size_t index, int worker) {
  (void)worker;
  const multiply_task *task = data;
  for (int x = 0; x < task->level->tiles_x; x++) {
    unsigned char *ones = &task->to->ones[index * (size_t)task->level->tiles_x + (size_t)x];
    bool skip = product_is_ones(task, x, (int)index);
    if (!skip) task->function(&task->job, x, (int)index);
    else if (!*ones) store_ones(task->to->pixels, task->level->stride, (size_t)x, index);
    *ones = skip;
  }
}

/* to = a * b, each on its level, which may be twice as fine (both) or, for b, twice as coarse. */
static void multiply(hl_pool *pool, const cascade_functions *functions, const cascade_level *level_a,
                     const cascade_field *a, const cascade_level *level_b, const cascade_field *b,
                     const cascade_level *level, const cascade_field *to) {
  field_tile_function *function = level_a->scale < level->scale   ? functions->multiply_half
                                  : level_b->scale > level->scale ? functions->multiply_double
                                                                  : functions->multiply;
  multiply_task task = {level, level_a, level_b, a, b, to, {a->pixels, b->pixels, to->pixels, level_b->stride, level->stride},
                        function};
  hl_pool_run(pool, (size_t)level->tiles_y, multiply_row, &task);
}

typedef struct blur_task {
  const cascade_level *level;
  const cascade_field *from, *a, *to; /* a may be null */
  blur_multiply_job job;
  blur_multiply_tile_function *function;
  int reach_x, reach_y; /* tiles */
} blur_task;

static void blur_row(void *data, size_t index, int worker) {
  (void)worker;
  const blur_task *task = data;
  int y = (int)index;
  for (int x = 0; x < task->level->tiles_x; x++) {
    size_t tile = index * (size_t)task->level->tiles_x + (size_t)x;
    bool skip = (task->a == NULL || task->a->ones[tile]) &&
                all_ones(task->level, task->from, x - task->reach_x, x + task->reach_x, y - task->reach_y, y + task->reach_y);
    if (!skip) task->function(&task->job, x, y);
    else if (!task->to->ones[tile]) store_ones(task->to->pixels, task->job.stride_to, (size_t)x, index);
    task->to->ones[tile] = skip;
  }
}

/* Variances along u and v, in pixels of the level. */
typedef struct variances { double u, v; } variances;

/* a discrete box of odd width w has the variance (w^2 - 1) / 12 */
static blur_box box_of_variance(double variance) {
  return hl_blur_box((float)fmin(sqrt(12 * variance + 1), 2 * BLUR_GREATEST_REACH - 3));
}

/* to = a * blurred from, all on one level but for to's stride. */
static void blur_multiply(hl_pool *pool, const cascade_functions *functions, const cascade_level *level,
                          const cascade_field *from, const cascade_field *a, const cascade_field *to, size_t stride_to,
                          variances variance) {
  blur_box u = box_of_variance(variance.u), v = box_of_variance(variance.v);
  blur_task task = {level, from, a, to, {from->pixels, a == NULL ? NULL : a->pixels, to->pixels, level->stride, stride_to, u, v},
                    functions->blur_multiply, (u.reach + TILE) / TILE, (v.reach + TILE) / TILE};
  hl_pool_run(pool, (size_t)level->tiles_y, blur_row, &task);
}

/* ---- the cascade ---- */

static variances variance_between(const soft_cascade *cascade, double wide, double narrow, int scale) {
  double v = fmax(wide * wide - narrow * narrow, 0) / 12 / ((double)scale * scale);
  return (variances){v * cascade->stretch * cascade->stretch, v};
}

/* The two oldest groups of a level become one of the next. */
static void merge_up(soft_cascade *cascade, int index, hl_pool *pool, const cascade_functions *functions) {
  cascade_level *level = &cascade->level[index], *next = &cascade->level[index + 1];
  cascade_group a = level->group[0], b = level->group[1], *to = &next->group[next->count++];
  for (int c = 0; c < cascade->channels; c++)
    multiply(pool, functions, level, &a.transmittance[c], level, &b.transmittance[c], next, &to->transmittance[c]);
  to->weight = a.weight + b.weight;
  to->omega = (a.omega * a.weight + b.omega * b.weight) / to->weight;
  next->renewed = level->renewed = true;
  for (int g = 2; g < CASCADE_GROUPS; g++) level->group[g - 2] = level->group[g];
  level->group[CASCADE_GROUPS - 2] = a;
  level->group[CASCADE_GROUPS - 1] = b;
  level->count -= 2;
}

static void push_chunk(soft_cascade *cascade, hl_pool *pool, const cascade_functions *functions) {
  cascade_level *level = &cascade->level[0];
  cascade_group *to = &level->group[level->count++];
  size_t tiles = (size_t)level->tiles_x * (size_t)level->tiles_y;
  for (int c = 0; c < cascade->channels; c++) {
    cascade_field fresh = to->transmittance[c];
    to->transmittance[c] = cascade->current[c];
    cascade->current[c] = fresh;
    for (size_t tile = 0; tile < tiles; tile++) {
      if (!fresh.ones[tile])
        store_ones(fresh.pixels, level->stride, tile % (size_t)level->tiles_x, tile / (size_t)level->tiles_x);
      fresh.ones[tile] = 1;
    }
  }
  to->weight = cascade->chunk_weight;
  to->omega = cascade->chunk_sum / cascade->chunk_weight;
  level->renewed = true;
  cascade->chunk_weight = cascade->chunk_sum = 0;
  cascade->chunks++;
  for (int i = 0; i + 1 < cascade->level_count && cascade->level[i].count == CASCADE_GROUPS; i++)
    merge_up(cascade, i, pool, functions);
}

/* What had passed the groups before, the last of them at omega before, blurred for this group, times this group. */
static void pass_group(const soft_cascade *cascade, cascade_level *from_level, double before,
                       cascade_level *level, const cascade_group *group, double receiver, hl_pool *pool,
                       const cascade_functions *functions) {
  variances variance = variance_between(cascade, receiver - before, receiver - group->omega, from_level->scale);
  const cascade_field *from = from_level->passed[from_level->newest];
  level->newest = !level->newest;
  for (int c = 0; c < cascade->channels; c++) {
    const cascade_field *to = &level->passed[level->newest][c], *own = &group->transmittance[c];
    if (level->scale == from_level->scale) {
      blur_multiply(pool, functions, from_level, &from[c], own, to, level->stride, variance);
      continue;
    }
    blur_multiply(pool, functions, from_level, &from[c], NULL, &from_level->scratch, from_level->stride, variance);
    multiply(pool, functions, level, own, from_level, &from_level->scratch, level, to);
  }
}

/* Nothing lies before the farthest group: what passes it is its own transmittance. */
static void pass_first(const soft_cascade *cascade, cascade_level *level, const cascade_group *group) {
  for (int c = 0; c < cascade->channels; c++) {
    const cascade_field *from = &group->transmittance[c], *to = &level->passed[level->newest][c];
    memcpy(to->pixels - level->origin, from->pixels - level->origin, level->plane * sizeof(float));
    memcpy(to->ones, from->ones, (size_t)level->tiles_x * (size_t)level->tiles_y);
  }
}

/* From the farthest group to the nearest; levels are renewed in turn, the thicker the more rarely. Returns the nearest
 * group's omega; what passed it is level 0's newest. */
static double pass_all(soft_cascade *cascade, double receiver, hl_pool *pool, const cascade_functions *functions) {
  cascade_level *before_level = NULL;
  double before = 0;
  bool due = false;
  for (int i = cascade->level_count - 1; i >= 0; i--) {
    cascade_level *level = &cascade->level[i];
    if (level->count == 0) continue;
    uint64_t period = (uint64_t)1 << i;
    due = due || level->renewed || cascade->chunks % period == 0;
    for (int g = 0; g < level->count && due; g++) {
      const cascade_group *group = &level->group[g];
      if (before_level == NULL)
        pass_first(cascade, level, group);
      else
        pass_group(cascade, before_level, before, level, group, receiver, pool, functions);
      before_level = level;
      before = group->omega;
    }
    level->renewed = false;
    before_level = level;
    before = level->group[level->count - 1].omega;
  }
  return before;
}

/* The buffer that sheets look up, for receivers around omega = receiver. */
static void refill_buffer(soft_cascade *cascade, shadow_buffer *buffer, double receiver, hl_pool *pool,
                          const cascade_functions *functions) {
  double nearest = pass_all(cascade, receiver, pool, functions);
  cascade_level *level = &cascade->level[0];
  variances variance = variance_between(cascade, receiver - nearest, 0, 1);
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  for (int c = 0; c < cascade->channels; c++) {
    /* the buffer's tiles that the last slabs touched are no longer ones: the second half of its flags says so */
    cascade_field to = {buffer->transmittance[c], buffer->tile_touched + tiles};
    for (size_t tile = 0; tile < tiles; tile++) to.ones[tile] = !buffer->tile_touched[tile];
    blur_multiply(pool, functions, level, &level->passed[level->newest][c], NULL, &to, buffer->stride, variance);
  }
  for (size_t tile = 0; tile < tiles; tile++) buffer->tile_touched[tile] = !buffer->tile_touched[tiles + tile];
  hl_shadow_buffer_find_lit(buffer, NULL, pool, functions->lit_blocks);
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
