/* shadow_cascade/cascade_passes.c - computes sums, blurs and merges of a cascade's fields. */
#include "shadow_cascade/cascade_passes.h"

#include <string.h>

void hl_cascade_clear_pixels(const cascade_level *level, const cascade_field *field, int x, int y) {
  field_pixel *pixels = field->pixels + (size_t)y * TILE * level->stride + (size_t)x * TILE;
  for (size_t row = 0; row < TILE; row++) memset(pixels + row * level->stride, 0, TILE * sizeof(field_pixel));
}

/* From this number of tiles on, memchr() finds tiles that are not zeros faster than a loop. */
enum { MANY_TILES = 4 };

bool hl_cascade_all_zeros(const cascade_level *level, const cascade_field *field, int x0, int x1, int y0,
                          int y1) {
  if (x0 < 0) x0 = 0;
  if (x1 >= level->tiles_x) x1 = level->tiles_x - 1;
  for (int y = y0 < 0 ? 0 : y0; y <= y1 && y < level->tiles_y && x0 <= x1; y++) {
    const unsigned char *zeros = field->zeros + y * level->tiles_x;
    if (x1 - x0 >= MANY_TILES) {
      if (memchr(zeros + x0, 0, (size_t)(x1 - x0 + 1)) != NULL) return false;
      continue;
    }
    for (int x = x0; x <= x1; x++)
      if (!zeros[x]) return false;
  }
  return true;
}

int hl_cascade_doubling_reach(int from, int to) {
  int reach = 0;
  for (; from > to; from /= 2) reach += 2 * from;
  return reach;
}

/* Marks whether a tile is all zeros, after some of its rows were computed. No code reads the tile's other
 * rows. So if the computed rows are zeros, the whole tile is cleared. */
static void note_zeros(const cascade_level *level, const cascade_field *field, int x, int y, tile_rows rows,
                       int above_zero) {
  unsigned char *zeros = &field->zeros[y * level->tiles_x + x];
  bool whole = rows.end - rows.first == TILE;
  if (above_zero || whole) *zeros = !above_zero;
  else hl_cascade_clear_tile(level, field, x, y);
}

typedef struct add_task {
  const cascade_reads *reads;
  cascade_sum sum;
  field_job job;
  field_tile_function *function;
  bool doubled; /* whether b is coarser than the output; in this case an `a` of zeros may be left out */
} add_task;

/* Returns whether a sum is all zeros in the tiles from x0 to x1, both included, of a row of tiles. */
static bool sum_is_zeros(const add_task *task, int x0, int x1, int y) {
  const cascade_sum *sum = &task->sum;
  const cascade_level *levels[2] = {sum->level_a, sum->level_b};
  const cascade_field *fields[2] = {sum->a, sum->b};
  for (int i = 0; i < 2; i++) {
    if (fields[i] == NULL) continue;
    int scale = levels[i]->scale, own = sum->level->scale, first = x0, last = x1, top = y, bottom = y;
    if (scale == own && x0 == x1) { /* the usual case of a single tile on the output's level, tested without
                                     * calling another function */
      if (!fields[i]->zeros[y * sum->level->tiles_x + x0]) return false;
      continue;
    }
    if (scale < own) first = 2 * x0, last = 2 * x1 + 1, top = 2 * y, bottom = 2 * y + 1;
    if (scale > own) first = (x0 - 1) / 2, last = (x1 + 1) / 2, top = (y - 1) / 2, bottom = (y + 1) / 2;
    if (!hl_cascade_all_zeros(levels[i], fields[i], first, last, top, bottom)) return false;
  }
  return true;
}

static bool row_is_zeros(const cascade_level *level, const cascade_field *field, row_piece piece) {
  return hl_cascade_all_zeros(level, field, piece.first, piece.end - 1, piece.y, piece.y);
}

/* Computes a sum in a piece of a row of tiles. In most rows, the inputs are all zeros, and the output was all
 * zeros before; the function returns at once for these rows. */
static void add_tiles(const add_task *task, row_piece piece) {
  const cascade_level *level = task->sum.level;
  const cascade_field *a = task->sum.a, *to = task->sum.to;
  if (row_is_zeros(level, to, piece) && sum_is_zeros(task, piece.first, piece.end - 1, piece.y)) return;
  const read_row read = hl_cascade_read_row(task->reads, level->scale, piece.y, task->sum.reach);
  if (!read.any) return;
  for (int x = piece.first; x < piece.end; x++) {
    if (!hl_cascade_is_read(&read, &read.all, x)) continue;
    if (sum_is_zeros(task, x, x, piece.y)) {
      hl_cascade_clear_tile(level, to, x, piece.y);
      continue;
    }
    field_job job = task->job;
    job.rows = hl_cascade_rows_read(&read, x);
    if (task->doubled && a != NULL && a->zeros[piece.y * level->tiles_x + x]) job.a = job.thin = NULL;
    note_zeros(level, to, x, piece.y, job.rows, task->function(&job, x, piece.y));
  }
}

static void add_piece(void *data, size_t index, int worker) {
  (void)worker;
  const add_task *task = data;
  add_tiles(task, hl_cascade_row_piece(task->sum.level, index));
}

static const field_pixel *pixels_of(const cascade_field *field) {
  return field == NULL ? NULL : field->pixels;
}

static add_task task_of_add(const cascade_crew *crew, const cascade_sum *sum) {
  const cascade_functions *functions = crew->functions;
  int scale = sum->level->scale;
  field_tile_function *function = sum->level_a->scale < scale                     ? functions->add_half
                                  : sum->b != NULL && sum->level_b->scale > scale ? functions->add_double
                                                                                  : functions->add;
  return (add_task){
      .reads = crew->reads,
      .sum = *sum,
      .job = {.a = pixels_of(sum->a),
              .b = pixels_of(sum->b),
              .to = sum->to->pixels,
              .stride_in = sum->b == NULL ? sum->level_a->stride : sum->level_b->stride,
              .stride = sum->level->stride,
              .thin = pixels_of(sum->thin)},
      .function = function,
      .doubled = function == functions->add_double,
  };
}

void hl_cascade_add(const cascade_crew *crew, const cascade_sum *sum) {
  add_task task = task_of_add(crew, sum);
  hl_pool_run(crew->pool, hl_cascade_row_pieces(sum->level), add_piece, &task);
}

typedef struct blur_task {
  const cascade_reads *reads;
  cascade_blurred_sum sum;
  field_blur_job job;
  field_blur_tile_function *function;
  int reach_x, reach_y; /* the numbers of tiles that the blur reads to each side of a tile */
} blur_task;

static void blur_piece(void *data, size_t index, int worker) {
  (void)worker;
  const blur_task *task = data;
  const cascade_blurred_sum *sum = &task->sum;
  const cascade_level *level = sum->level;
  const row_piece piece = hl_cascade_row_piece(level, index);
  int y = piece.y, around = task->reach_x;
  if (row_is_zeros(level, sum->to, piece) && (sum->a == NULL || row_is_zeros(level, sum->a, piece)) &&
      hl_cascade_all_zeros(level, sum->from, piece.first - around, piece.end - 1 + around, y - task->reach_y,
                           y + task->reach_y))
    return;
  const read_row read = hl_cascade_read_row(task->reads, level->scale, y, sum->reach);
  if (!read.any) return;
  for (int x = piece.first; x < piece.end; x++) {
    size_t tile = (size_t)y * (size_t)level->tiles_x + (size_t)x;
    if (!hl_cascade_is_read(&read, &read.all, x)) continue;
    bool skip = (sum->a == NULL || sum->a->zeros[tile]) &&
                hl_cascade_all_zeros(level, sum->from, x - task->reach_x, x + task->reach_x,
                                     y - task->reach_y, y + task->reach_y);
    if (skip) {
      hl_cascade_clear_tile(level, sum->to, x, y);
      continue;
    }
    field_blur_job job = task->job;
    job.rows = hl_cascade_rows_read(&read, x);
    job.u = level->boxes[x].box;
    job.v = level->boxes[level->tiles_x + y].box;
    if (sum->a != NULL && sum->a->zeros[tile])
      job.a = job.thin = NULL; /* a group has thin matter only where it has absorbed light */
    if (sum->thin != NULL && sum->thin->zeros[tile]) job.thin = NULL;
    note_zeros(level, sum->to, x, y, job.rows, task->function(&job, x, y));
  }
}

/* Finds the width of the blur's box for each column or row of tiles. Returns the number of tiles by which the
 * widest box reaches to one side. */
static int fill_boxes(cascade_box *boxes, int count, double variance, double resampled) {
  int reach = 0;
  for (int i = 0; i < count; i++) {
    boxes[i].box = hl_blur_box_of_variance(fmax(variance * boxes[i].fraction - resampled, 0));
    if (boxes[i].box.reach > reach) reach = boxes[i].box.reach;
  }
  return (reach + TILE) / TILE;
}

void hl_cascade_find_boxes(const cascade_level *level, const cascade_blur *blur, int *reach_x, int *reach_y) {
  *reach_x = fill_boxes(level->boxes, level->tiles_x, blur->variance, blur->resampled[0]);
  *reach_y = fill_boxes(level->boxes + level->tiles_x, level->tiles_y, blur->variance, blur->resampled[1]);
}

void hl_cascade_blur_add(const cascade_crew *crew, const cascade_blurred_sum *sum) {
  const cascade_level *level = sum->level;
  blur_task task = {.reads = crew->reads, .sum = *sum, .function = crew->functions->blur_add};
  task.job = (field_blur_job){.from = sum->from->pixels,
                              .a = pixels_of(sum->a),
                              .to = sum->to->pixels,
                              .thin = pixels_of(sum->thin),
                              .stride = level->stride};
  hl_cascade_find_boxes(level, &sum->blur, &task.reach_x, &task.reach_y);
  hl_pool_run(crew->pool, hl_cascade_row_pieces(level), blur_piece, &task);
}

typedef struct split_task {
  const cascade_level *level;
  const cascade_field *fields[4]; /* four fields: `absorbed` and `thin` of the first output, then of the
                                   * second output */
  split_job job;
  split_tile_function *function;
} split_task;

static void split_row(void *data, size_t index, int worker) {
  (void)worker;
  const split_task *task = data;
  for (int x = 0; x < task->level->tiles_x; x++) {
    size_t tile = index * (size_t)task->level->tiles_x + (size_t)x;
    if (task->fields[0]->zeros[tile] && task->fields[1]->zeros[tile]) {
      for (int i = 2; i < 4; i++) hl_cascade_clear_tile(task->level, task->fields[i], x, (int)index);
      continue;
    }
    uint32_t above_zero = task->function(&task->job, x, (int)index);
    for (int i = 0; i < 4; i++) task->fields[i]->zeros[tile] = (above_zero >> i & 1) == 0;
  }
}

typedef struct merge_task {
  const cascade_level *level;
  int ratio; /* the scale of the farther level divided by the scale of the nearer level */
  split_task split;
  add_task sums[MERGE_SUMS];
} merge_task;

/* Merges one row of tiles of the farther level, and the rows of the nearer level that this row covers. */
static void merge_row(void *data, size_t index, int worker) {
  merge_task *task = data;
  size_t first = index * (size_t)task->ratio, end = first + (size_t)task->ratio;
  for (size_t row = first; row < end && row < (size_t)task->level->tiles_y; row++)
    split_row(&task->split, row, worker);
  for (int i = 0; i < MERGE_SUMS; i++)
    add_tiles(&task->sums[i], (row_piece){(int)index, 0, task->sums[i].sum.level->tiles_x});
}

void hl_cascade_find_merge_sums(const cascade_merger *merger, cascade_sum sums[MERGE_SUMS]) {
  const cascade_level *level = merger->level, *next = merger->next;
  const cascade_matter *a = &merger->a, *b = &merger->b, *spare = &merger->spare, *first = &merger->first,
                       *second = &merger->second;
  const cascade_field *of_a[2] = {a->absorbed, a->thin}, *of_b[2] = {b->absorbed, b->thin},
                      *of_spare[2] = {spare->absorbed, spare->thin};
  const cascade_field *to[2] = {second->absorbed, second->thin}, *old[2] = {first->absorbed, first->thin};
  for (int i = 0; i < 2; i++) {
    /* the fields of the group `second` hold, for a while, the matter that goes to `first`; they get their own
     * matter last */
    const cascade_sum of_kind[3] = {
        {level, of_b[i], of_b[1], level, of_a[i], next, to[i], READ_EVERYWHERE},
        {next, to[i], to[1], next, old[i], next, old[i], READ_EVERYWHERE},
        {level, of_spare[i], NULL, NULL, NULL, next, to[i], READ_EVERYWHERE},
    };
    for (int s = 0; s < 3; s++) sums[2 * s + i] = of_kind[s];
  }
}

void hl_cascade_merge(const cascade_crew *crew, const cascade_merger *merger) {
  const cascade_level *level = merger->level, *next = merger->next;
  const cascade_matter *b = &merger->b, *spare = &merger->spare;
  merge_task task = {.level = level, .ratio = next->scale / level->scale};
  task.split = (split_task){level,
                            {b->absorbed, b->thin, spare->absorbed, spare->thin},
                            {b->absorbed->pixels,
                             b->thin->pixels,
                             {b->absorbed->pixels, spare->absorbed->pixels},
                             {b->thin->pixels, spare->thin->pixels},
                             level->stride,
                             (float)merger->late},
                            crew->functions->split};
  cascade_sum sums[MERGE_SUMS];
  hl_cascade_find_merge_sums(merger, sums);
  for (int i = 0; i < MERGE_SUMS; i++) task.sums[i] = task_of_add(crew, &sums[i]);
  hl_pool_run(crew->pool, (size_t)next->tiles_y, merge_row, &task);
}
