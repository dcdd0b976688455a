/* shadow_cascade/cascade_emission.c - sums the groups of a cascade for lights with an emission image. Each
 * group is blurred by a kernel of its own.
 *
 * For a light without an image, groups are blurred by boxes step by step, because only the variance of a blur
 * matters. An emission image, however, must appear complete in every penumbra. So the absorbed light of group
 * o is blurred in one step by the image's taps (light_emission.h), scaled to the width w of the group's
 * penumbra on the receiver. Far groups come first. With a group's kernel K, the sum s becomes K(G + F) + (1 -
 * K(F)) s (derived as in cascade.h). Without thin matter, s becomes the sum over groups of K(G), which is the
 * mean of the shadows of the light's cells. Sums are made anew for each receiver, which is not too slow,
 * because far groups have coarse pixels. */
#include "shadow_cascade/cascade_passes.h"

#include <string.h>

_Static_assert(EMISSION_GREATEST_STEP == 2 * BLUR_GREATEST_REACH - 4, "a box can blur by a step");

typedef struct emission_pass {
  const soft_cascade *cascade;
  cascade_level *level;
  const cascade_group *group;
  double width; /* width of the group's penumbra on the receiver, in pixels of the level */
  int step[2];
  bool averaged; /* whether the level's field `mean` holds the group's means over `step` pixels */
  int reach;     /* the number of tiles around a tile that the taps and the means read */
  const cascade_functions *functions;
} emission_pass;

/* The field in which a level's sum of groups is made. */
static const cascade_field *sum_of(const soft_cascade *cascade, const cascade_level *level, int channel) {
  return level == &cascade->level[0] ? &cascade->absorbed[channel] : &level->sum[0][channel];
}

/* Finds the tiles of a row that the next slabs read, or that the next finer level reads when it interpolates
 * between pixels. */
static read_row row_read(const soft_cascade *cascade, const cascade_level *level, size_t y) {
  return hl_cascade_read_row(&cascade->reads, level->scale, (int)y,
                             hl_cascade_doubling_reach(level->scale, 1));
}

/* ---- the sum of the farther levels ---- */

static bool any_near(const cascade_level *level, const cascade_field *field, int x, int y, int reach) {
  return !hl_cascade_all_zeros(level, field, x - reach, x + reach, y - reach, y + reach);
}

typedef struct start_task {
  const soft_cascade *cascade;
  /* level: the level whose sum is started; farther: the nearest of the farther levels that have a sum; null
   * if no farther level has a sum */
  const cascade_level *level, *farther;
  const cascade_functions *functions;
} start_task;

static void start_tile(const start_task *task, const cascade_field *from, const cascade_field *to, int x,
                       int y) {
  const cascade_level *level = task->level, *farther = task->farther;
  int ratio = farther == NULL ? 1 : farther->scale / level->scale;
  if (farther == NULL || !any_near(farther, from, x / ratio, y / ratio, ratio - 1)) {
    hl_cascade_clear_tile(level, to, x, y);
    return;
  }
  field_job job = {.a = from->pixels,
                   .to = to->pixels,
                   .stride_in = farther->stride,
                   .stride = level->stride,
                   .rows = ALL_ROWS};
  size_t at = (size_t)y * TILE * level->stride + (size_t)x * TILE;
  int above_zero = ratio == 1 || task->functions->double_tile(&job, x, y);
  for (size_t row = 0; row < TILE && ratio == 1; row++)
    memcpy(to->pixels + at + row * level->stride, from->pixels + at + row * level->stride,
           TILE * sizeof(field_pixel));
  to->zeros[y * level->tiles_x + x] = !above_zero;
}

static void start_row(void *data, size_t index, int worker) {
  (void)worker;
  const start_task *task = data;
  const cascade_level *level = task->level;
  const read_row read = row_read(task->cascade, level, index);
  for (int x = 0; x < level->tiles_x; x++) {
    if (!hl_cascade_is_read(&read, &read.all, x)) continue;
    for (int c = 0; c < task->cascade->channels; c++)
      start_tile(task, task->farther == NULL ? NULL : sum_of(task->cascade, task->farther, c),
                 sum_of(task->cascade, level, c), x, (int)index);
  }
}

/* ---- a group ---- */

/* Averages a group's absorbed light, and its thin matter, over `step` pixels. */
static void average_row(void *data, size_t index, int worker) {
  (void)worker;
  const emission_pass *pass = data;
  const cascade_level *level = pass->level;
  for (int c = 0; c < pass->cascade->channels; c++) {
    const cascade_field *from[2] = {&pass->group->absorbed[c], &pass->group->thin[c]};
    for (int i = 0; i < 2; i++) {
      const cascade_field *to = &level->mean[i][c];
      field_blur_job job = {.from = from[i]->pixels,
                            .to = to->pixels,
                            .stride = level->stride,
                            .u = hl_blur_box((float)pass->step[0]),
                            .v = hl_blur_box((float)pass->step[1]),
                            .rows = ALL_ROWS};
      const int tiles = ((job.u.reach > job.v.reach ? job.u.reach : job.v.reach) + TILE) / TILE;
      for (int x = 0; x < level->tiles_x; x++) {
        if (!any_near(level, from[i], x, (int)index, tiles)) {
          hl_cascade_clear_tile(level, to, x, (int)index);
          continue;
        }
        to->zeros[index * (size_t)level->tiles_x + (size_t)x] = !pass->functions->blur_add(&job, x,
                                                                                           (int)index);
      }
    }
  }
}

/* Finds the offsets of the taps for a tile. The function leaves out taps that lie outside the level for all
 * pixels of the tile, because pixels outside the level are zeros. Returns the number of taps that are left.
 */
static int offsets_of(const cascade_level *level, const emission_taps *taps, int x, int y, ptrdiff_t *offset,
                      int *kept) {
  int count = 0;
  for (int i = 0; i < taps->count; i++) {
    int left = x * TILE + taps->x[i], top = y * TILE + taps->y[i];
    if (left <= -TILE || top <= -TILE || left >= level->tiles_x * TILE || top >= level->tiles_y * TILE)
      continue;
    offset[count] = (ptrdiff_t)taps->y[i] * (ptrdiff_t)level->stride + taps->x[i];
    kept[count++] = i;
  }
  return count;
}

static void add_tile(const emission_pass *pass, const emission_taps *taps, int x, int y) {
  const cascade_level *level = pass->level;
  ptrdiff_t offset[EMISSION_TAPS];
  int kept[EMISSION_TAPS], count = offsets_of(level, taps, x, y, offset, kept);
  for (int c = 0; c < pass->cascade->channels; c++) {
    const cascade_field *to = sum_of(pass->cascade, level, c);
    const cascade_field *from = pass->averaged ? &level->mean[0][c] : &pass->group->absorbed[c];
    const cascade_field *thin = pass->averaged ? &level->mean[1][c] : &pass->group->thin[c];
    if (!any_near(level, from, x, y, pass->reach)) continue;
    float weight[EMISSION_TAPS];
    for (int i = 0; i < count; i++) weight[i] = taps->weight[c][kept[i]];
    field_emission_job job = {.from = from->pixels,
                              .thin = thin->pixels,
                              .to = to->pixels,
                              .stride = level->stride,
                              .count = count,
                              .offset = offset,
                              .weight = weight};
    to->zeros[y * level->tiles_x + x] = !pass->functions->emission_add(&job, x, y);
  }
}

static void add_row(void *data, size_t index, int worker) {
  (void)worker;
  const emission_pass *pass = data;
  const soft_cascade *cascade = pass->cascade;
  const cascade_level *level = pass->level;
  emission_taps taps;
  bool known = false;
  const read_row read = row_read(cascade, level, index);
  for (int x = 0; x < level->tiles_x; x++) {
    if (!hl_cascade_is_read(&read, &read.all, x)) continue;
    const double slope[2] = {
        cascade->slope_start[0] + cascade->slope_step[0] * (x + 0.5) * TILE * level->scale,
        cascade->slope_start[1] + cascade->slope_step[1] * ((double)index + 0.5) * TILE * level->scale};
    if (!known || cascade->emission->tilted)
      hl_light_emission_taps(cascade->emission, pass->width, pass->step, slope, &taps);
    known = true;
    add_tile(pass, &taps, x, (int)index);
  }
}

static void add_group(const soft_cascade *cascade, cascade_level *level, const cascade_group *group,
                      double receiver, const cascade_crew *crew) {
  emission_pass pass = {.cascade = cascade,
                        .level = level,
                        .group = group,
                        .functions = crew->functions,
                        .width = fmax(receiver - group->omega, 0) / level->scale};
  hl_light_emission_steps(cascade->emission, pass.width, pass.step);
  pass.averaged = pass.step[0] > 1 || pass.step[1] > 1;
  double reach = cascade->emission->reach * pass.width + fmax(pass.step[0], pass.step[1]) + 2;
  pass.reach = (int)fmin(ceil(reach / TILE), fmax(level->tiles_x, level->tiles_y));
  if (pass.averaged) hl_pool_run(crew->pool, (size_t)level->tiles_y, average_row, &pass);
  hl_pool_run(crew->pool, (size_t)level->tiles_y, add_row, &pass);
}

bool hl_cascade_pass_emission(soft_cascade *cascade, double receiver, const cascade_crew *crew) {
  cascade_level *farther = NULL;
  for (int i = cascade->level_count - 1; i >= 0; i--) {
    cascade_level *level = &cascade->level[i];
    start_task task = {cascade, level, farther, crew->functions};
    bool any = farther != NULL;
    for (int g = 0; g < level->count; g++) any = any || level->group[g].filled;
    if (!any) continue;
    hl_pool_run(crew->pool, (size_t)level->tiles_y, start_row, &task);
    for (int g = 0; g < level->count; g++)
      if (level->group[g].filled) add_group(cascade, level, &level->group[g], receiver, crew);
    farther = level;
  }
  return farther != NULL;
}
