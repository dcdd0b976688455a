/* shadow_cascade/cascade.c - the groups of a cascade, and the light that they leave. */
#include "shadow_cascade/cascade.h"

#include <string.h>

#include "core/memory.h"
#include "shadow_cascade/cascade_passes.h"

/* Chunks that a sweep is cut into at most; where they need not be thin, pixels of omega; the least of one,
 * pixels. */
static const double GREATEST_CHUNKS = 64, ENOUGH_CHUNKS = 32, THICK_CHUNK = 1.3, LEAST_CHUNK = 0.15;

static double omega_at(const soft_cascade *cascade, double height) {
  if (cascade->parallel) return cascade->rate * height;
  double distance = height - cascade->light_height;
  return distance > 0 ? -cascade->rate / distance : -INFINITY;
}

/* Chunks between a receiver and a level's groups at least: level 0 keeps three groups, level 1 two, every
 * other five. */
static double chunks_before(int level) { return level < 2 ? 3 * level : 4 * (pow(2, level - 1) - 1); }

/* Chunks after which a level's sums are found anew. */
static uint64_t period_of(int level) { return level < 2 ? 1 : (uint64_t)1 << (level - 2); }

/* Levels keep at least one and a half pixels of their own to the narrowest penumbra that they give. What
 * resampling blurs is taken off the penumbra (resampled_by), but for an image, which keeps four. */
static int level_scale(const soft_cascade *cascade, int level) {
  double penumbra = cascade->chunk * chunks_before(level) * cascade->least_part,
         own = cascade->image == NULL ? 1.5 : 4;
  int scale = 1, greatest = level < 2
                                ? 1 << level
                                : 1 << (level - 1); /* coarser ones were less exact, and hardly cheaper */
  while (2 * scale * own <= penumbra && scale < greatest) scale *= 2;
  return scale;
}

static cascade_field field_of_plane(const cascade_level *level, size_t plane) {
  size_t tiles = (size_t)level->tiles_x * (size_t)level->tiles_y;
  return (cascade_field){level->memory + plane * level->plane + level->origin, level->flags + plane * tiles};
}

/* Hands out the next plane of a level's memory. */
static cascade_field next_field(const cascade_level *level, size_t *used) {
  return field_of_plane(level, (*used)++);
}

/* How wide each column or row of tiles sees the light. */
static void set_parts(const soft_cascade *cascade, const sheet_light *light, int axis, int count, int scale,
                      cascade_box *boxes) {
  for (int tile = 0; tile < count; tile++) {
    double slope = cascade->slope_start[axis] + cascade->slope_step[axis] * (tile + 0.5) * TILE * scale;
    boxes[tile].part = hl_sheet_light_squared_width(light, axis, slope) / (cascade->widest * cascade->widest);
  }
}

/* A plane of floats. */
enum { MOMENT_PLANES = sizeof(float) / sizeof(field_pixel) };

static void lay_out_level(soft_cascade *cascade, int index, const shadow_buffer *buffer) {
  cascade_level *level = &cascade->level[index];
  size_t channels = (size_t)cascade->channels;
  level->scale = level_scale(cascade, index);
  if (index > 0 && level->scale > 2 * cascade->level[index - 1].scale)
    level->scale = 2 * cascade->level[index - 1].scale;
  level->tiles_x = (buffer->tiles_x + level->scale - 1) / level->scale;
  level->tiles_y = (buffer->tiles_y + level->scale - 1) / level->scale;
  level->stride = (size_t)level->tiles_x * TILE + CASCADE_MARGIN;
  level->plane = ((size_t)level->tiles_y * TILE + CASCADE_MARGIN) * level->stride;
  level->origin = CASCADE_MARGIN * level->stride + CASCADE_MARGIN;
  level->capacity = index < 2 ? CASCADE_FEW_GROUPS : CASCADE_GROUPS;
  level->planes = channels * (2 * (size_t)level->capacity + 2) +
                  (index == 0 ? 2 * channels * MOMENT_PLANES : 1);
  if (cascade->image != NULL) level->planes += 2 * channels;
  level->pixels = level->planes * level->plane + (CASCADE_MARGIN + 1) * level->stride;
}

/* Zeros for all levels, handed out to them. */
static hl_status open_memory(hl_context *context, hl_pool *pool, shadow_memory *memory, soft_cascade *cascade,
                             hl_error *error) {
  size_t bytes = 0;
  for (int i = 0; i < cascade->level_count; i++) bytes += cascade->level[i].pixels * sizeof(field_pixel);
  if (memory->capacity < bytes) {
    hl_release(context, memory->planes);
    memory->planes = hl_allocate(context, bytes, 1);
    memory->capacity = memory->planes == NULL ? 0 : bytes;
    memory->zeros = false;
    if (memory->planes == NULL) return hl_fail_memory(error, bytes, "a cascade of shadows");
  }
  if (!memory->zeros) hl_pool_clear(pool, memory->planes, memory->capacity);
  memory->zeros = false;
  field_pixel *next = memory->planes;
  for (int i = 0; i < cascade->level_count; next += cascade->level[i].pixels, i++)
    cascade->level[i].memory = next;
  return HL_OK;
}

static void sum_up_parts(cascade_level *level) {
  const int count[2] = {level->tiles_x, level->tiles_y};
  const cascade_box *box = level->boxes;
  level->greatest_part = 0;
  for (int axis = 0; axis < 2; axis++) {
    level->part[axis] = 0;
    for (int i = 0; i < count[axis]; i++, box++) {
      level->part[axis] += box->part / count[axis];
      level->greatest_part = fmax(level->greatest_part, box->part);
    }
  }
}

static hl_status open_level(hl_context *context, soft_cascade *cascade, int index, const sheet_light *light,
                            hl_error *error) {
  cascade_level *level = &cascade->level[index];
  size_t channels = (size_t)cascade->channels, used = 0,
         tiles = (size_t)level->tiles_x * (size_t)level->tiles_y;
  level->flags = hl_allocate(context, level->planes, tiles);
  level->boxes = hl_allocate(context, (size_t)(level->tiles_x + level->tiles_y), sizeof *level->boxes);
  if (level->flags == NULL || level->boxes == NULL)
    return hl_fail_memory(error, level->planes * tiles, "a cascade of shadows");
  memset(level->flags, 1, level->planes * tiles);
  set_parts(cascade, light, 0, level->tiles_x, level->scale, level->boxes);
  set_parts(cascade, light, 1, level->tiles_y, level->scale, level->boxes + level->tiles_x);
  sum_up_parts(level);
  for (size_t c = 0; c < channels; c++) {
    for (int g = 0; g < level->capacity; g++) {
      level->group[g].absorbed[c] = next_field(level, &used);
      level->group[g].thin[c] = next_field(level, &used);
    }
    for (int i = 0; i < 2; i++) level->sum[i][c] = next_field(level, &used);
  }
  if (index > 0) level->scratch = next_field(level, &used);
  for (size_t c = 0; c < 2 * channels && cascade->image != NULL; c++)
    level->mean[c % 2][c / 2] = next_field(level, &used);
  for (size_t c = 0; c < channels && index == 0; c++) {
    cascade->shade[c] = level->sum[0][c];
    cascade->moment[c] = (float *)(void *)(level->memory + used * level->plane) + level->origin;
    used += MOMENT_PLANES;
    cascade->lacked[c] = (float *)(void *)(level->memory + used * level->plane) + level->origin;
    used += MOMENT_PLANES;
  }
  return HL_OK;
}

/* Chunks and levels for a buffer whose view, tiles and channels are known. */
static void plan(soft_cascade *cascade, const light_shadow *shadow, const shadow_buffer *buffer) {
  const sheet_light *light = &shadow->plan.seen;
  const sheet_stack *sheets = shadow->setup.sheets;
  vec3 normal = sheets->normal;
  double first = sheets->first, last = hl_last_height(sheets), pixel = vec3_length(buffer->view.du);
  double widest = fmax(light->width_u, light->width_v);
  *cascade = (soft_cascade){.parallel = light->parallel,
                            .channels = buffer->channels,
                            .rate = widest / pixel,
                            .widest = widest,
                            .least_part = fmin(light->width_u, light->width_v) / widest,
                            .light_height = vec3_dot(light->middle, normal),
                            .image = shadow->setup.image};
  const vec3 along[2] = {light->u, light->v};
  for (int axis = 0; axis < 2; axis++) {
    cascade->slope_start[axis] = vec3_dot(buffer->view.corner, along[axis]);
    cascade->slope_step[axis] = vec3_dot(axis == 0 ? buffer->view.du : buffer->view.dv, along[axis]);
  }
  double start = omega_at(cascade, first), end = omega_at(cascade, last);
  /* a light close to the sheets: penumbrae twice as wide as the buffer are as good as wider ones */
  start = fmax(start, end - 2 * TILE * fmax(buffer->tiles_x, buffer->tiles_y));
  double thick = fmin(fmax((end - start) / ENOUGH_CHUNKS, LEAST_CHUNK), THICK_CHUNK);
  cascade->chunk_start = start;
  cascade->chunk = fmax(thick, (end - start) / GREATEST_CHUNKS);
  /* level j > 1 is first used after 5 * 2^(j-1) - 4 chunks (derived: five groups are kept, here or in levels
   * 0 and 1) */
  int levels = 2 + (int)floor(log2(fmax((end - start) / cascade->chunk + 7, 5) / 5));
  cascade->level_count = levels < CASCADE_LEVELS ? levels : CASCADE_LEVELS;
  for (int i = 0; i < cascade->level_count; i++) lay_out_level(cascade, i, buffer);
}

shadow_bytes hl_soft_cascade_bytes(const light_shadow *shadow) {
  const view *view = &shadow->plan.view;
  soft_cascade cascade;
  shadow_buffer buffer = {.view = *view,
                          .channels = shadow->setup.channels,
                          .tiles_x = hl_tiles(view->width),
                          .tiles_y = hl_tiles(view->height)};
  plan(&cascade, shadow, &buffer);
  shadow_bytes bytes = {.passing = (uint64_t)buffer.tiles_x * (uint64_t)buffer.tiles_y * 2 +
                                   ((uint64_t)buffer.tiles_x + 1) * ((uint64_t)buffer.tiles_y + 1) * 4};
  for (int i = 0; i < cascade.level_count; i++) {
    const cascade_level *level = &cascade.level[i];
    uint64_t tiles_x = (uint64_t)level->tiles_x, tiles_y = (uint64_t)level->tiles_y;
    bytes.kept += level->pixels * sizeof(field_pixel);
    bytes.passing += level->planes * tiles_x * tiles_y + (tiles_x + tiles_y) * sizeof *level->boxes;
  }
  return bytes;
}

/* A bilinear look-up weighs two pixels by their distances p and 1 - p: a variance of p (1 - p), 1/6 on
 * average. Cubic convolution has none. */
static double lookup_variance(bool cubic) { return cubic ? 0 : 1.0 / 6; }

hl_status hl_soft_cascade_begin(light_shadow *shadow, shadow_memory *memory, hl_error *error) {
  hl_context *context = shadow->setup.context;
  soft_cascade *cascade = shadow->state;
  const shadow_buffer *buffer = shadow->buffer;
  plan(cascade, shadow, buffer);
  cascade->lookup_variance = lookup_variance(shadow->plan.cubic);
  for (int c = 0; c < buffer->channels; c++) shadow->lookup.older[c] = buffer->second[c];
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  cascade->touched = hl_allocate_zeroed(context, tiles, 1);
  cascade->refilled = hl_allocate_zeroed(context, tiles, 1);
  cascade->reads = (cascade_reads){buffer->tiles_x, buffer->tiles_y, NULL};
  cascade->reads.before = hl_allocate(context, (size_t)(buffer->tiles_x + 1) * (size_t)(buffer->tiles_y + 1),
                                      sizeof(uint32_t));
  if (cascade->touched == NULL || cascade->refilled == NULL || cascade->reads.before == NULL)
    return hl_fail_memory(error, 5 * tiles, "a cascade of shadows");
  hl_status status = open_memory(context, shadow->setup.pool, memory, cascade, error);
  for (int i = 0; i < cascade->level_count && status == HL_OK; i++)
    status = open_level(context, cascade, i, &shadow->plan.seen, error);
  if (status == HL_OK) cascade->memory = memory;
  cascade->level[0].count = 1; /* at the first chunk's start */
  cascade->level[0].group[0].omega = cascade->chunk_start;
  return status;
}

/* One plane of a level; those of the moments have no flags of their own. */
static void clear_plane(void *data, size_t index, int worker) {
  (void)worker;
  const cascade_level *level = data;
  const cascade_field field = field_of_plane(level, index);
  for (int y = 0; y < level->tiles_y; y++)
    for (int x = 0; x < level->tiles_x; x++) hl_cascade_clear_tile(level, &field, x, y);
}

/* What the last, unfinished chunk's slabs took, and what light they found. */
static void clear_moments(const soft_cascade *cascade) {
  const cascade_level *level = &cascade->level[0];
  for (size_t tile = 0; tile < (size_t)level->tiles_x * (size_t)level->tiles_y; tile++) {
    size_t at = tile / (size_t)level->tiles_x * TILE * level->stride + tile % (size_t)level->tiles_x * TILE;
    for (int c = 0; c < cascade->channels && cascade->touched[tile]; c++)
      for (size_t row = 0; row < TILE; row++)
        memset(cascade->moment[c] + at + row * level->stride, 0, TILE * sizeof(float));
  }
  for (int c = 0; c < cascade->channels; c++)
    memset(cascade->lacked[c], 0, (size_t)level->tiles_y * TILE * level->stride * sizeof(float));
}

static void give_back_memory(hl_pool *pool, soft_cascade *cascade) {
  for (int i = 0; i < cascade->level_count; i++)
    hl_pool_run(pool, cascade->level[i].planes, clear_plane, &cascade->level[i]);
  clear_moments(cascade);
  cascade->memory->zeros = !hl_pool_cancelled(pool);
}

void hl_soft_cascade_release(hl_context *context, hl_pool *pool, soft_cascade *cascade) {
  if (cascade->memory != NULL) give_back_memory(pool, cascade);
  for (int i = 0; i < CASCADE_LEVELS; i++) {
    hl_release(context, cascade->level[i].flags);
    hl_release(context, cascade->level[i].boxes);
  }
  hl_release(context, cascade->touched);
  hl_release(context, cascade->refilled);
  hl_release(context, cascade->reads.before);
  *cascade = (soft_cascade){0};
}

/* Of boxes, in pixels of the buffer, where the light is widest. */
static double variance_between(double wide, double narrow) {
  return fmax(wide * wide - narrow * narrow, 0) / 12;
}

/* What a level's sums are blurred by its pixels on the way to the buffer (derived: halving takes the mean of
 * two pixels, of variance 1/4, and the bilinear way back weighs 3/4 and 1/4, of variance 3/4; s^2 in all from
 * s to 2 s, a geometric sum). */
static double resampled_by(const cascade_level *level) {
  return ((double)level->scale * level->scale - 1) / 3;
}

/* From a level's sum to a place in a level as fine or finer. What resampling blurs too much for this way is
 * owed by the next. */
static cascade_blur blur_towards(const cascade_level *from, double receiver, double omega,
                                 cascade_level *to) {
  double variance = variance_between(receiver - from->sum_omega, receiver - omega),
         pixel = (double)from->scale * from->scale;
  cascade_blur blur = {.variance = variance / pixel};
  for (int axis = 0; axis < 2; axis++) {
    double resampled = resampled_by(from) - resampled_by(to) + from->owed[axis];
    to->owed[axis] = fmax(resampled - variance * from->part[axis], 0);
    blur.resampled[axis] = resampled / pixel;
  }
  return blur;
}

/* Moves a level's groups forward by the first `gone`, whose fields the places left free take over. */
static void forget_oldest(cascade_level *level, int gone) {
  cascade_group free[2] = {level->group[0], level->group[1]};
  for (int g = gone; g < level->capacity; g++) level->group[g - gone] = level->group[g];
  for (int g = 0; g < gone; g++) level->group[level->capacity - gone + g] = free[g];
  level->count -= gone;
  level->renewed = true;
}

/* The oldest group of level 0 goes to level 1 as it is, on that level's pixels. */
static void hand_over(soft_cascade *cascade, const cascade_crew *crew) {
  cascade_level *level = &cascade->level[0], *next = &cascade->level[1];
  const cascade_group *from = &level->group[0];
  cascade_group *to = &next->group[next->count++];
  for (int c = 0; c < cascade->channels; c++) {
    hl_cascade_add(crew, level, &from->absorbed[c], NULL, NULL, NULL, next, &to->absorbed[c],
                   READ_EVERYWHERE);
    hl_cascade_add(crew, level, &from->thin[c], NULL, NULL, NULL, next, &to->thin[c], READ_EVERYWHERE);
  }
  to->omega = from->omega;
  to->filled = from->filled;
  next->renewed = true;
  forget_oldest(level, 1);
}

/* The two oldest groups of a level go to the next, where the first has a group at its own place already and
 * the second lies between that and a new one at the third's place: what it took is shared between them by its
 * distances (derived: kernels are then linear between groups, so that what a penumbra's middle should be is
 * kept). */
static void merge_up(soft_cascade *cascade, int index, const cascade_crew *crew) {
  cascade_level *level = &cascade->level[index], *next = &cascade->level[index + 1];
  cascade_group a = level->group[0], b = level->group[1];
  double late = (b.omega - a.omega) / (level->group[2].omega - a.omega);
  if (next->count == 0) next->group[next->count++].omega = a.omega;
  cascade_group *first = &next->group[next->count - 1], *second = &next->group[next->count++];
  for (int c = 0; c < cascade->channels; c++) {
    const cascade_matter spare = {&level->scratch, &level->sum[!level->newest][c]};
    hl_cascade_merge(crew, level, &(cascade_matter){&a.absorbed[c], &a.thin[c]},
                     &(cascade_matter){&b.absorbed[c], &b.thin[c]}, late, &spare, next,
                     &(cascade_matter){&first->absorbed[c], &first->thin[c]},
                     &(cascade_matter){&second->absorbed[c], &second->thin[c]});
  }
  first->filled = first->filled || a.filled || b.filled;
  second->filled = b.filled;
  second->omega = level->group[2].omega;
  next->renewed = true;
  forget_oldest(level, 2);
}

typedef struct absorb_task {
  const soft_cascade *cascade;
  const shadow_buffer *buffer;
  cascade_group *start, *end;
  double length;
  absorbed_tile_function *absorbed;
} absorb_task;

static void absorb_tile(const absorb_task *task, size_t tile_x, size_t tile_y, int channel) {
  const cascade_level *level = &task->cascade->level[0];
  const cascade_field *start[2] = {&task->start->absorbed[channel], &task->start->thin[channel]};
  const cascade_field *end[2] = {&task->end->absorbed[channel], &task->end->thin[channel]};
  size_t tile = tile_y * (size_t)level->tiles_x + tile_x;
  bool touched = task->cascade->touched[tile];
  absorbed_job job = {task->cascade->lacked[channel],
                      task->buffer->transmittance[channel],
                      task->cascade->moment[channel],
                      (float)task->length,
                      start[0]->pixels,
                      start[1]->pixels,
                      end[0]->pixels,
                      end[1]->pixels,
                      level->stride,
                      task->buffer->stride};
  if (!touched) {
    for (int i = 0; i < 2; i++) hl_cascade_clear_tile(level, end[i], (int)tile_x, (int)tile_y);
    return;
  }
  uint32_t above_zero = task->absorbed(&job, (int)tile_x, (int)tile_y);
  for (int i = 0; i < 2; i++) {
    if (above_zero >> i & 1) start[i]->zeros[tile] = 0;
    end[i]->zeros[tile] = (above_zero >> (2 + i) & 1) == 0;
  }
}

/* What the chunk's slabs took of the light that reached the chunk goes to the groups at its two ends. Tiles
 * stay marked until the buffer is refilled. */
static void absorb_part(void *data, size_t index, int worker) {
  (void)worker;
  const absorb_task *task = data;
  const cascade_level *level = &task->cascade->level[0];
  const row_part part = hl_cascade_row_part(level, index);
  for (int x = part.first; x < part.end; x++) {
    for (int c = 0; c < task->cascade->channels; c++) absorb_tile(task, (size_t)x, (size_t)part.y, c);
  }
}

static void push_chunk(soft_cascade *cascade, const shadow_buffer *buffer, double omega,
                       const cascade_crew *crew) {
  cascade_level *level = &cascade->level[0];
  cascade_group *start = &level->group[level->count - 1], *end = &level->group[level->count++];
  end->filled = memchr(cascade->touched, 1, (size_t)level->tiles_x * (size_t)level->tiles_y) != NULL;
  start->filled = start->filled || end->filled;
  end->omega = omega;
  absorb_task task = {cascade, buffer, start, end, omega - start->omega, crew->functions->absorbed};
  hl_pool_run(crew->pool, hl_cascade_row_parts(level), absorb_part, &task);
  level->renewed = true;
  cascade->chunks++;
  if (level->count == level->capacity) hand_over(cascade, crew);
  for (int i = 1; i + 1 < cascade->level_count && cascade->level[i].count == cascade->level[i].capacity; i++)
    merge_up(cascade, i, crew);
}

/* In the middle of the slab before the sheet. */
static double slab_omega(const soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  return omega_at(cascade, (hl_sheet_height(sheets, sheet - 1) + hl_sheet_height(sheets, sheet)) / 2);
}

void hl_soft_cascade_reach(soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  double middle = slab_omega(cascade, sheets, sheet);
  cascade->slab = isfinite(middle) ? middle - cascade->chunk_start : 0;
}

float hl_soft_cascade_age(const soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  double middle = slab_omega(cascade, sheets, sheet);
  return isfinite(middle) ? (float)fmin(fmax((middle - cascade->chunk_start) / cascade->chunk, 0), 1) : 0;
}

void hl_soft_cascade_count(const soft_cascade *cascade, size_t tile, attenuate_job *job) {
  const cascade_level *level = &cascade->level[0];
  size_t tile_x = tile % (size_t)level->tiles_x, tile_y = tile / (size_t)level->tiles_x;
  for (int c = 0; c < cascade->channels; c++)
    job->moment[c] = cascade->moment[c] + tile_y * TILE * level->stride + tile_x * TILE;
  job->moment_stride = level->stride;
  job->place = (float)cascade->slab;
}

/* Reaches add up, but for what is read everywhere. */
static int reach_beyond(int reach, int more) { return reach == READ_EVERYWHERE ? reach : reach + more; }

/* One channel of what the groups up to a level absorbed, blurred, brought to a nearer level, thinned by own's
 * thin matter and added to own there (null: zeros), as far as it is read. Blurs are done at the farther
 * level, where they are cheap. */
static void bring(cascade_level *from, const cascade_field *sum, cascade_blur blur, cascade_level *to_level,
                  const cascade_field *own, const cascade_field *thin, const cascade_field *to, int reach,
                  const cascade_crew *crew) {
  if (from->scale == to_level->scale) {
    hl_cascade_blur_add(crew, from, sum, own, thin, to, blur, reach);
    return;
  }
  if (blur.variance * from->greatest_part > fmin(blur.resampled[0], blur.resampled[1])) {
    hl_cascade_blur_add(crew, from, sum, NULL, NULL, &from->scratch, blur,
                        reach_beyond(reach, hl_cascade_doubling_reach(from->scale, to_level->scale)));
    sum = &from->scratch;
  }
  while (from->scale > 2 * to_level->scale) {
    cascade_level *next = from - 1;
    if (next->scale < from->scale) {
      hl_cascade_add(crew, next, NULL, NULL, from, sum, next, &next->scratch,
                     reach_beyond(reach, hl_cascade_doubling_reach(next->scale, to_level->scale)));
      sum = &next->scratch;
    }
    from = next;
  }
  hl_cascade_add(crew, to_level, own, thin, from, sum, to_level, to, reach);
}

/* What the groups before absorbed, blurred for this group, and what this group did. */
static void pass_group(int channels, cascade_level *from, cascade_level *level, const cascade_group *group,
                       double receiver, int reach, const cascade_crew *crew) {
  cascade_blur blur = blur_towards(from, receiver, group->omega, level);
  const cascade_field *sum = from->sum[from->newest];
  level->newest = !level->newest;
  for (int c = 0; c < channels; c++)
    bring(from, &sum[c], blur, level, &group->absorbed[c], &group->thin[c], &level->sum[level->newest][c],
          reach, crew);
}

/* Nothing lies before the farthest group, whose penumbra pays for the look-up. */
static void pass_first(const soft_cascade *cascade, cascade_level *level, const cascade_group *group,
                       const cascade_crew *crew) {
  level->owed[0] = level->owed[1] = cascade->lookup_variance;
  for (int c = 0; c < cascade->channels; c++)
    hl_cascade_add(crew, level, &group->absorbed[c], NULL, NULL, NULL, level, &level->sum[level->newest][c],
                   READ_EVERYWHERE);
}

/* ---- where the next slabs read ---- */

/* In the tiles that sheets up to the next chunk's end can touch. */
static void find_reads(soft_cascade *cascade, const occupancy *occupancy, const sheet_stack *sheets,
                       int sheet) {
  int last = sheet;
  while (last < sheets->count - 1 &&
         omega_at(cascade, hl_sheet_height(sheets, last)) - cascade->chunk_start < cascade->chunk)
    last++;
  hl_cascade_reads_find(&cascade->reads, occupancy, sheet, last);
}

/* How far what is on the way from one group, or the sum behind it, to the next is blurred and resampled,
 * pixels of the buffer. */
static int reach_of(const cascade_level *level, double variance, const cascade_level *next) {
  double own = variance * level->greatest_part / ((double)level->scale * level->scale);
  return (hl_blur_box_of_variance(own).reach + 1) * level->scale +
         hl_cascade_doubling_reach(level->scale, next->scale);
}

/* How far what passed group g of a level is still blurred on its way to the buffer, pixels of that. */
static int reach_behind(const soft_cascade *cascade, int index, int g, double receiver) {
  const cascade_level *from = &cascade->level[index];
  double omega = from->group[g].omega;
  int reach = 0, later = g + 1;
  for (int i = index; i >= 0; i--, later = 0) {
    const cascade_level *level = &cascade->level[i];
    for (; later < level->count; later++) {
      if (!level->group[later].filled) continue;
      reach += reach_of(from, variance_between(receiver - omega, receiver - level->group[later].omega),
                        level);
      from = level;
      omega = level->group[later].omega;
    }
  }
  return reach + reach_of(from, variance_between(receiver - omega, 0), &cascade->level[0]);
}

/* From the farthest group to the nearest; levels are renewed in turn, the thicker the more rarely. Empty
 * groups are left out, which keeps blurs few and kernels boxes. Returns the nearest level with anything in
 * sum; null if nothing is in the way. */
static cascade_level *pass_all(soft_cascade *cascade, double receiver, const cascade_crew *crew) {
  cascade_level *sum = NULL;
  bool due = false;
  for (int i = cascade->level_count - 1; i >= 0; i--) {
    cascade_level *level = &cascade->level[i];
    uint64_t period = period_of(i);
    due = due || level->renewed || cascade->chunks % period == 0;
    if (due) level->filled = false;
    /* until it is due again receivers go on by a period less one chunk: their mean is served */
    double served = receiver + cascade->chunk * (double)(period - 1) / 2;
    for (int g = 0; g < level->count && due; g++) {
      const cascade_group *group = &level->group[g];
      if (!group->filled) continue;
      if (sum == NULL) pass_first(cascade, level, group, crew);
      else {
        int reach = period > 1 ? READ_EVERYWHERE : reach_behind(cascade, i, g, receiver);
        pass_group(cascade->channels, sum, level, group, served, reach, crew);
      }
      level->filled = true;
      level->sum_omega = group->omega;
      sum = level;
    }
    if (level->filled) sum = level;
    level->renewed = false;
  }
  return sum;
}

/* Of a tile: whether it was refilled at the last chunk's end, and at this one's. */
enum { REFILLED_BEFORE = 1, REFILLED_NOW = 2 };

typedef struct light_task {
  soft_cascade *cascade;
  shadow_buffer *buffer;
  const cascade_functions *functions;
  bool any; /* shade is not all zeros */
} light_task;

static void light_part(void *data, size_t index, int worker) {
  (void)worker;
  const light_task *task = data;
  const cascade_level *level = &task->cascade->level[0];
  shadow_buffer *buffer = task->buffer;
  const row_part part = hl_cascade_row_part(level, index);
  const read_row read = hl_cascade_read_row(&task->cascade->reads, 1, part.y, 0);
  if (!read.any) return;
  for (int tile_x = part.first; tile_x < part.end; tile_x++) {
    size_t tile = (size_t)part.y * (size_t)level->tiles_x + (size_t)tile_x;
    if (!hl_cascade_is_read(&read, &read.all, tile_x)) continue;
    bool shaded = false;
    for (int c = 0; c < buffer->channels && task->any; c++)
      shaded = shaded || !task->cascade->shade[c].zeros[tile];
    bool kept = task->cascade->touched[tile], again = task->cascade->refilled[tile] & REFILLED_BEFORE;
    for (int c = 0; c < buffer->channels && (shaded || buffer->tile_touched[tile]); c++) {
      left_job job = {.lacking = task->cascade->shade[c].pixels,
                      .stride = level->stride,
                      .lacked = task->cascade->lacked[c],
                      .to = buffer->transmittance[c],
                      .older = buffer->second[c],
                      .stride_to = buffer->stride,
                      .kept = kept,
                      .again = again};
      task->functions->left(&job, tile_x, part.y);
    }
    buffer->tile_touched[tile] = shaded || kept;
    task->cascade->refilled[tile] |= REFILLED_NOW;
    hl_shadow_buffer_find_lit(buffer, tile_x, part.y, true, task->functions->lit_blocks);
  }
}

/* Less than this, pixels squared, is not worth a blur: a third of what a bilinear look-up has. */
static const double LEAST_VARIANCE = 0.05;

/* What receivers around omega = receiver lack, where it is read; false if nothing is in the way. */
static bool find_shade(soft_cascade *cascade, double receiver, const cascade_crew *crew) {
  if (cascade->image != NULL) return hl_soft_cascade_pass_image(cascade, receiver, crew);
  cascade_level *level = pass_all(cascade, receiver, crew);
  if (level == NULL) return false;
  cascade_level *finest = &cascade->level[0];
  cascade_blur blur = blur_towards(level, receiver, receiver, finest);
  bool sharp = level == finest && blur.variance < LEAST_VARIANCE;
  memcpy(cascade->shade, finest->sum[sharp ? finest->newest : !finest->newest], sizeof cascade->shade);
  for (int c = 0; c < cascade->channels && !sharp; c++)
    bring(level, &level->sum[level->newest][c], blur, finest, NULL, NULL, &cascade->shade[c], 0, crew);
  return true;
}

/* The buffer that sheets look up. any: whether find_shade found any. */
static void refill_buffer(soft_cascade *cascade, shadow_buffer *buffer, bool any, const cascade_crew *crew) {
  light_task task = {cascade, buffer, crew->functions, any};
  hl_pool_run(crew->pool, hl_cascade_row_parts(&cascade->level[0]), light_part, &task);
}

static void begin_chunk(soft_cascade *cascade) {
  size_t tiles = (size_t)cascade->level[0].tiles_x * (size_t)cascade->level[0].tiles_y;
  memset(cascade->touched, 0, tiles);
  for (size_t tile = 0; tile < tiles; tile++)
    cascade->refilled[tile] = cascade->refilled[tile] & REFILLED_NOW ? REFILLED_BEFORE : 0;
}

void hl_soft_cascade_advance(soft_cascade *cascade, shadow_buffer *buffer, const occupancy *occupancy,
                             const sheet_stack *sheets, int sheet, hl_pool *pool,
                             const cascade_functions *functions) {
  double omega = omega_at(cascade, hl_sheet_height(sheets, sheet));
  if (!isfinite(omega) || omega - cascade->chunk_start < cascade->chunk) return;
  const cascade_crew crew = {pool, functions, &cascade->reads};
  cascade->chunk_start = omega;
  find_reads(cascade, occupancy, sheets, sheet);
  bool any = find_shade(cascade, omega + cascade->chunk, &crew); /* of the chunks before the one that ends */
  push_chunk(cascade, buffer, omega, &crew);
  refill_buffer(cascade, buffer, any, &crew);
  begin_chunk(cascade);
}
