/* shadow_cascade/cascade_method.c - keeps the groups of a cascade, blurs and sums them, and fills the shadow
 * buffer from the sum. */
#include <string.h>

#include "shadow_cascade/cascade_passes.h"

/* The number of chunks after which the sum of a level's groups is made anew. */
static uint64_t period_of(int level) { return level < 2 ? 1 : (uint64_t)1 << (level - 2); }

/* The difference of the variances of two boxes of different widths, in squared pixels of the buffer. wide,
 * narrow: the boxes' widths where the light is widest. */
static double variance_between(double wide, double narrow) {
  return fmax(wide * wide - narrow * narrow, 0) / 12;
}

/* The variance, in squared pixels of the buffer, by which a level's coarser pixels blur its sums on the way
 * to the buffer. Derived: halving takes the mean of two pixels, whose weights have the variance 1/4. Doubling
 * weighs pixels by 3/4 and 1/4, which adds the variance 3/4. So going from the scale s to 2 s and back adds
 * the variance s^2. The sum over all scales is a geometric series. */
static double resampled_by(const cascade_level *level) {
  return ((double)level->scale * level->scale - 1) / 3;
}

/* The blur that brings a level's sum from its own omega to a given `omega`, on the way to a level that is as
 * fine or finer. If resampling alone blurs by a greater variance, the excess is stored in `owed` and
 * subtracted from the next blur. */
static cascade_blur blur_towards(const cascade_level *from, double receiver, double omega,
                                 cascade_level *to) {
  double variance = variance_between(receiver - from->sum_omega, receiver - omega),
         pixel = (double)from->scale * from->scale;
  cascade_blur blur = {.variance = variance / pixel};
  for (int axis = 0; axis < 2; axis++) {
    double resampled = resampled_by(from) - resampled_by(to) + from->owed[axis];
    to->owed[axis] = fmax(resampled - variance * from->fraction[axis], 0);
    blur.resampled[axis] = resampled / pixel;
  }
  return blur;
}

/* Removes the oldest groups of a level. gone: the number of groups that are removed. The next groups use the
 * fields of the removed groups. */
static void forget_oldest(cascade_level *level, int gone) {
  cascade_group free[2] = {level->group[0], level->group[1]};
  for (int g = gone; g < level->capacity; g++) level->group[g - gone] = level->group[g];
  for (int g = 0; g < gone; g++) level->group[level->capacity - gone + g] = free[g];
  level->count -= gone;
  level->renewed = true;
}

/* Copies a field to the pixels of another level. */
static void copy_field(const cascade_crew *crew, const cascade_level *level, const cascade_field *from,
                       const cascade_level *to_level, const cascade_field *to) {
  const cascade_sum sum = {
      .level_a = level, .a = from, .level = to_level, .to = to, .reach = READ_EVERYWHERE};
  crew->works->add(crew, &sum);
}

/* Moves the oldest group of level 0 to level 1, and converts the group to the pixels of level 1. */
static void hand_over(soft_cascade *cascade, const cascade_crew *crew) {
  cascade_level *level = &cascade->level[0], *next = &cascade->level[1];
  const cascade_group *from = &level->group[0];
  cascade_group *to = &next->group[next->count++];
  for (int c = 0; c < cascade->channels; c++) {
    copy_field(crew, level, &from->absorbed[c], next, &to->absorbed[c]);
    copy_field(crew, level, &from->thin[c], next, &to->thin[c]);
  }
  to->omega = from->omega;
  to->filled = from->filled;
  next->renewed = true;
  forget_oldest(level, 1);
}

/* Moves the two oldest groups of a level, a and b, to the next level. The next level already has a group at
 * a's omega, to which a is added. The next level also gets a new group at the omega of this level's third
 * group. b lies between these two groups of the next level, and b's matter is split between them by b's
 * distances from them (derived: kernels are then linear between groups, which keeps a penumbra's middle). */
static void merge_up(soft_cascade *cascade, int index, const cascade_crew *crew) {
  cascade_level *level = &cascade->level[index], *next = &cascade->level[index + 1];
  cascade_group a = level->group[0], b = level->group[1];
  double late = (b.omega - a.omega) / (level->group[2].omega - a.omega);
  if (next->count == 0) next->group[next->count++].omega = a.omega;
  cascade_group *first = &next->group[next->count - 1], *second = &next->group[next->count++];
  for (int c = 0; c < cascade->channels; c++) {
    const cascade_merger merger = {.level = level,
                                   .a = {&a.absorbed[c], &a.thin[c]},
                                   .b = {&b.absorbed[c], &b.thin[c]},
                                   .spare = {&level->scratch, &level->sum[!level->newest][c]},
                                   .late = late,
                                   .next = next,
                                   .first = {&first->absorbed[c], &first->thin[c]},
                                   .second = {&second->absorbed[c], &second->thin[c]}};
    crew->works->merge(crew, &merger);
  }
  first->filled = first->filled || a.filled || b.filled;
  second->filled = b.filled;
  second->omega = level->group[2].omega;
  next->renewed = true;
  forget_oldest(level, 2);
}

typedef struct absorb_task {
  const cascade_absorption *of;
  absorbed_tile_function *absorbed;
} absorb_task;

static void absorb_tile(const absorb_task *task, size_t tile_x, size_t tile_y, bool read, int channel) {
  const cascade_absorption *of = task->of;
  const cascade_level *level = &of->cascade->level[0];
  const cascade_field *start[2] = {&of->start->absorbed[channel], &of->start->thin[channel]};
  const cascade_field *end[2] = {&of->end->absorbed[channel], &of->end->thin[channel]};
  size_t tile = tile_y * (size_t)level->tiles_x + tile_x;
  bool touched = of->cascade->touched[tile];
  absorbed_job job = {of->cascade->absorbed_at_start[channel],
                      of->buffer->transmittance[channel],
                      of->cascade->moment[channel],
                      (float)of->length,
                      of->any && read ? of->cascade->absorbed[channel].pixels : NULL,
                      start[0]->pixels,
                      start[1]->pixels,
                      end[0]->pixels,
                      end[1]->pixels,
                      level->stride,
                      of->buffer->stride,
                      of->edge};
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

/* Adds the light that the chunk's slabs have absorbed to the two groups at the chunk's ends. The marks in the
 * array `touched` are kept until the buffer is refilled. */
static void absorb_piece(void *data, size_t index, int worker) {
  (void)worker;
  const absorb_task *task = data;
  const soft_cascade *cascade = task->of->cascade;
  const row_piece piece = hl_cascade_row_piece(&cascade->level[0], index);
  const read_row row = hl_cascade_read_row(&cascade->reads, 1, piece.y, 0);
  for (int x = piece.first; x < piece.end; x++) {
    bool read = row.any && hl_cascade_is_read(&row, &row.all, x);
    for (int c = 0; c < cascade->channels; c++) absorb_tile(task, (size_t)x, (size_t)piece.y, read, c);
  }
}

static bool absorb_chunk(const cascade_crew *crew, const cascade_absorption *absorption) {
  const soft_cascade *cascade = absorption->cascade;
  const cascade_level *level = &cascade->level[0];
  absorb_task task = {absorption, crew->functions->absorbed};
  hl_pool_run(crew->pool, hl_cascade_row_pieces(level), absorb_piece, &task);
  return memchr(cascade->touched, 1, (size_t)level->tiles_x * (size_t)level->tiles_y) != NULL;
}

/* The width, in pixels, of the strip along the edges of opaque surfaces that does not hide the matter before
 * the surfaces. Derived: at the rim of a ball, two edges lie one behind the other, a chunk apart. At the rim,
 * the sum of the light that the two edges absorb is about right. For a receiver that lies w behind the second
 * edge, the sum before this edge has a penumbra of the width sqrt((c + w)^2 - w^2), where c is the chunk's
 * length. In the penumbra's dark half, the second edge must not hide the light that is left. A strip along
 * the second edge that is half as wide as the dark half lets this light pass. A wider strip would leave light
 * where two pieces of one surface meet that lie in different chunks. */
static int edge_of(double length, double behind) {
  return (int)fmin(round(sqrt(length * (length + 2 * behind)) / 4), GREATEST_EDGE);
}

static void push_chunk(soft_cascade *cascade, const light_shadow *shadow, double omega, bool any,
                       const cascade_crew *crew) {
  cascade_level *level = &cascade->level[0];
  cascade_group *start = &level->group[level->count - 1], *end = &level->group[level->count++];
  end->omega = omega;
  const sheet_stack *sheets = shadow->setup.sheets;
  double length = omega - start->omega, last = hl_cascade_omega(cascade, hl_last_height(sheets));
  const cascade_absorption absorption = {
      cascade, shadow->buffer, start, end, length, edge_of(length, fmax(last - omega, 0)), any};
  bool touched = crew->works->absorb(crew, &absorption);
  if (shadow->owned != NULL) {
    hl_cascade_exchange_send(cascade, shadow->owned);
  } else {
    end->filled = touched;
    start->filled = start->filled || end->filled;
  }
  level->renewed = true;
  cascade->chunks++;
  if (level->count == level->capacity) hand_over(cascade, crew);
  for (int i = 1; i + 1 < cascade->level_count && cascade->level[i].count == cascade->level[i].capacity; i++)
    merge_up(cascade, i, crew);
}

/* The omega of the middle of the slab that ends at a sheet. */
static double slab_omega(const soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  return hl_cascade_omega(cascade, (hl_sheet_height(sheets, sheet - 1) + hl_sheet_height(sheets, sheet)) / 2);
}

/* The reach of a pass in pixels of the buffer: the pass must compute the pixels within this reach around the
 * tiles that are read. The pass's result has the scale `scale`, and is doubled afterwards until it has the
 * scale of the sum. */
static int reach_at(const cascade_sum *sum, int scale) {
  int doubling = hl_cascade_doubling_reach(scale, sum->level->scale);
  return sum->reach == READ_EVERYWHERE ? sum->reach : sum->reach + doubling;
}

/* Adds two sums: a, and b after a blur. b is one channel of the light that the groups up to a level have
 * absorbed. If b lies on a farther level than a, the function blurs b on the farther level, where blurs are
 * cheap, and afterwards doubles b level by level until b is as fine as a. */
static void bring(cascade_sum sum, cascade_blur blur, const cascade_crew *crew) {
  const cascade_level *from = sum.level_b;
  if (from->scale == sum.level->scale) {
    const cascade_blurred_sum blurred = {from, sum.b, sum.a, sum.thin, sum.to, blur, sum.reach};
    crew->works->blur_add(crew, &blurred);
    return;
  }
  if (blur.variance * from->greatest_fraction > fmin(blur.resampled[0], blur.resampled[1])) {
    const cascade_blurred_sum blurred = {.level = from,
                                         .from = sum.b,
                                         .to = &from->scratch,
                                         .blur = blur,
                                         .reach = reach_at(&sum, from->scale)};
    crew->works->blur_add(crew, &blurred);
    sum.b = &from->scratch;
  }
  while (from->scale > 2 * sum.level->scale) {
    const cascade_level *next = from - 1;
    if (next->scale < from->scale) {
      const cascade_sum doubled = {.level_a = next,
                                   .level_b = from,
                                   .b = sum.b,
                                   .level = next,
                                   .to = &next->scratch,
                                   .reach = reach_at(&sum, next->scale)};
      crew->works->add(crew, &doubled);
      sum.b = &next->scratch;
    }
    from = next;
  }
  sum.level_b = from;
  crew->works->add(crew, &sum);
}

/* Blurs the sum of the groups behind a group, from the omega of the last added group to the omega of the new
 * group, and then adds the new group to the sum. */
static void pass_group(int channels, cascade_level *from, cascade_level *level, const cascade_group *group,
                       double receiver, int reach, const cascade_crew *crew) {
  cascade_blur blur = blur_towards(from, receiver, group->omega, level);
  const cascade_field *sum = from->sum[from->newest];
  level->newest = !level->newest;
  for (int c = 0; c < channels; c++)
    bring((cascade_sum){level, &group->absorbed[c], &group->thin[c], from, &sum[c], level,
                        &level->sum[level->newest][c], reach},
          blur, crew);
}

/* Starts the sum of all groups with the farthest group. The group is blurred less than its penumbra requires,
 * because look-ups of the buffer also blur. */
static void pass_first(const soft_cascade *cascade, cascade_level *level, const cascade_group *group,
                       const cascade_crew *crew) {
  level->owed[0] = level->owed[1] = cascade->lookup_variance;
  for (int c = 0; c < cascade->channels; c++)
    copy_field(crew, level, &group->absorbed[c], level, &level->sum[level->newest][c]);
}

/* ---- where the next slabs read ---- */

/* Finds the tiles of the buffer that the light's sheets up to the end of the next chunk can touch. */
static void find_reads(soft_cascade *cascade, const occupancy *occupancy, const light_shadow *shadow,
                       int sheet) {
  const sheet_stack *sheets = shadow->setup.sheets;
  int last = sheet;
  while (last < sheets->count - 1 &&
         hl_cascade_omega(cascade, hl_sheet_height(sheets, last)) - cascade->chunk_start < cascade->chunk)
    last++;
  hl_cascade_reads_find(&cascade->reads, occupancy, shadow->needed_until, sheet, last);
}

/* The reach, in pixels of the buffer, of the blur and the resampling that bring one group's sum to the level
 * of the next group. */
static int reach_of(const cascade_level *level, double variance, const cascade_level *next) {
  double own = variance * level->greatest_fraction / ((double)level->scale * level->scale);
  return (hl_blur_box_of_variance(own).reach + 1) * level->scale +
         hl_cascade_doubling_reach(level->scale, next->scale);
}

/* The reach, in pixels of the buffer, of all blurs together on the way from group g of a level to the
 * buffer. */
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

/* Sums the groups from the farthest to the nearest. Levels with thicker groups are summed less often. Empty
 * groups are left out, which saves blurs and keeps kernels close to boxes. Returns the nearest level whose
 * sum is not empty; null if no matter is in the light's way. */
static cascade_level *pass_all(soft_cascade *cascade, double receiver, const cascade_crew *crew) {
  cascade_level *sum = NULL;
  bool due = false;
  for (int i = cascade->level_count - 1; i >= 0; i--) {
    cascade_level *level = &cascade->level[i];
    uint64_t period = period_of(i);
    due = due || level->renewed || cascade->chunks % period == 0;
    if (due) level->filled = false;
    /* the sum of this level is used for `period` - 1 further chunks; so the sum is made for a receiver in the
     * middle of these chunks */
    double served = hl_cascade_chunks_on(cascade, receiver, (double)(period - 1) / 2);
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

/* The values of buffer->tile_touched in a cascade's buffer, from which follows whether a tile must be
 * refilled. TILE_FULL: all planes of the tile hold full light. TILE_FADING: only the planes SHADOW_SECOND may
 * hold less, since samples still fade from the older light. TILE_SHADED: any plane may hold less. Slabs that
 * absorb light set the value 1, and mark the tile as touched, too. */
enum { TILE_FULL, TILE_FADING, TILE_SHADED };

typedef struct refill_task {
  soft_cascade *cascade;
  shadow_buffer *buffer;
  const cascade_functions *functions;
  bool any; /* whether any pixel of cascade->absorbed is not zero */
} refill_task;

static void refill_piece(void *data, size_t index, int worker) {
  (void)worker;
  const refill_task *task = data;
  const cascade_level *level = &task->cascade->level[0];
  shadow_buffer *buffer = task->buffer;
  const row_piece piece = hl_cascade_row_piece(level, index);
  const read_row read = hl_cascade_read_row(&task->cascade->reads, 1, piece.y, 0);
  if (!read.any) return;
  for (int tile_x = piece.first; tile_x < piece.end; tile_x++) {
    size_t tile = (size_t)piece.y * (size_t)level->tiles_x + (size_t)tile_x;
    if (!hl_cascade_is_read(&read, &read.all, tile_x)) continue;
    bool shaded = false;
    for (int c = 0; c < buffer->channels && task->any; c++)
      shaded = shaded || !task->cascade->absorbed[c].zeros[tile];
    bool kept = task->cascade->touched[tile], again = task->cascade->refilled[tile] & REFILLED_BEFORE;
    const unsigned char held = buffer->tile_touched[tile];
    for (int c = 0; c < buffer->channels && (shaded || held != TILE_FULL); c++) {
      refill_job job = {.absorbed = task->cascade->absorbed[c].pixels,
                        .stride = level->stride,
                        .absorbed_at_start = task->cascade->absorbed_at_start[c],
                        .to = buffer->transmittance[c],
                        .older = buffer->second[c],
                        .outside = buffer->outside[c],
                        .stride_to = buffer->stride,
                        .kept = kept,
                        .again = again};
      task->functions->refill(&job, tile_x, piece.y);
    }
    if (shaded || held != TILE_FULL) buffer->changed[tile] = buffer->sheet;
    buffer->tile_touched[tile] = shaded || kept ? TILE_SHADED : held == TILE_SHADED ? TILE_FADING : TILE_FULL;
    task->cascade->refilled[tile] |= REFILLED_NOW;
    hl_shadow_buffer_find_lit(buffer, tile_x, piece.y, true, task->functions->lit_blocks);
  }
}

/* The least variance of a blur that is carried out, in squared pixels. This least variance is a third of the
 * variance of a bilinear look-up. Weaker blurs are left out. */
static const double LEAST_VARIANCE = 0.05;

/* Finds the light that all groups absorb on the way to receivers around omega = receiver, and stores it in
 * cascade->absorbed, in the tiles that are read. Returns false if no matter is in the light's way. */
static bool find_shade(soft_cascade *cascade, double receiver, const cascade_crew *crew) {
  if (cascade->emission != NULL) return hl_cascade_pass_emission(cascade, receiver, crew);
  cascade_level *level = pass_all(cascade, receiver, crew);
  if (level == NULL) return false;
  cascade_level *finest = &cascade->level[0];
  cascade_blur blur = blur_towards(level, receiver, receiver, finest);
  bool sharp = level == finest && blur.variance < LEAST_VARIANCE;
  memcpy(cascade->absorbed, finest->sum[sharp ? finest->newest : !finest->newest], sizeof cascade->absorbed);
  for (int c = 0; c < cascade->channels && !sharp; c++)
    bring((cascade_sum){.level_a = finest,
                        .level_b = level,
                        .b = &level->sum[level->newest][c],
                        .level = finest,
                        .to = &cascade->absorbed[c]},
          blur, crew);
  return true;
}

/* Refills the shadow buffer, which the picture looks up, from the absorbed light of all groups. */
static void refill_buffer(const cascade_crew *crew, const cascade_refilling *of) {
  refill_task task = {of->cascade, of->buffer, crew->functions, of->any};
  hl_pool_run(crew->pool, hl_cascade_row_pieces(&of->cascade->level[0]), refill_piece, &task);
}

static const cascade_works processors = {.add = hl_cascade_add,
                                         .blur_add = hl_cascade_blur_add,
                                         .merge = hl_cascade_merge,
                                         .absorb = absorb_chunk,
                                         .refill = refill_buffer};

static void begin_chunk(soft_cascade *cascade) {
  size_t tiles = (size_t)cascade->level[0].tiles_x * (size_t)cascade->level[0].tiles_y;
  memset(cascade->touched, 0, tiles);
  for (size_t tile = 0; tile < tiles; tile++)
    cascade->refilled[tile] = cascade->refilled[tile] & REFILLED_NOW ? REFILLED_BEFORE : 0;
}

/* Returns whether the current chunk of slabs ends at the given sheet. */
static bool ends_chunk(const light_shadow *shadow, int sheet) {
  const soft_cascade *cascade = shadow->state;
  double omega = hl_cascade_omega(cascade, hl_sheet_height(shadow->setup.sheets, sheet));
  return isfinite(omega) && omega - cascade->chunk_start >= cascade->chunk;
}

/* Begins the next chunk at a sheet where a chunk ends. Returns the omega at which the new chunk ends. */
static double start_next(soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  double omega = hl_cascade_omega(cascade, hl_sheet_height(sheets, sheet));
  double end = hl_cascade_chunks_on(cascade, omega, 1);
  if (cascade->shrink > 0) cascade->chunk = end - omega;
  cascade->chunk_start = omega;
  return end;
}

void hl_cascade_end_chunk(light_shadow *shadow, const occupancy *occupancy, int sheet,
                          const cascade_crew *crew) {
  soft_cascade *cascade = shadow->state;
  double end = start_next(cascade, shadow->setup.sheets, sheet);
  find_reads(cascade, occupancy, shadow, sheet);
  /* cascade->absorbed is made from all chunks before the chunk that ends at this sheet */
  bool any = find_shade(cascade, end, crew);
  push_chunk(cascade, shadow, cascade->chunk_start, any, crew);
  const cascade_refilling refilling = {cascade, shadow->buffer, sheet, any};
  crew->works->refill(crew, &refilling);
  begin_chunk(cascade);
}

static void advance_cascade(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  soft_cascade *cascade = shadow->state;
  if (!ends_chunk(shadow, sheet)) {
    hl_cascade_exchange_look(cascade);
    return;
  }
  hl_cascade_exchange_receive(cascade);
  const cascade_crew crew = {&processors, shadow->means.pool, shadow->means.functions->cascade,
                             &cascade->reads, NULL};
  hl_cascade_end_chunk(shadow, occupancy, sheet, &crew);
}

/* ---- the method ---- */

static float position_of(const soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  double middle = slab_omega(cascade, sheets, sheet);
  return (float)(isfinite(middle) ? middle - cascade->chunk_start : 0);
}

static float young_of(const soft_cascade *cascade, const sheet_stack *sheets, int sheet) {
  double middle = slab_omega(cascade, sheets, sheet);
  double age = isfinite(middle) ? (middle - cascade->chunk_start) / cascade->chunk : 0;
  return (float)fmin(fmax(age, 0), 1);
}

void hl_cascade_find_chunks(const light_shadow *planned, int first, cascade_slab *slabs) {
  soft_cascade cascade = *(const soft_cascade *)planned->state;
  light_shadow shadow = *planned;
  const sheet_stack *sheets = planned->setup.sheets;
  shadow.state = &cascade;
  slabs[0] = (cascade_slab){.chunk = 1};
  for (int sheet = 1, chunk = 1; sheet < sheets->count; sheet++) {
    slabs[sheet] = (cascade_slab){position_of(&cascade, sheets, sheet), young_of(&cascade, sheets, sheet),
                                  chunk, sheet >= first && ends_chunk(&shadow, sheet)};
    if (!slabs[sheet].ends) continue;
    (void)start_next(&cascade, sheets, sheet);
    chunk++;
  }
}

/* Sets the fraction of a slab's light that samples read from the buffer. Samples read the rest from the
 * buffer's second planes. The fraction is 0 at the beginning of a chunk, and 1 once the chunk has its whole
 * length. */
static void before_shading(light_shadow *shadow, int sheet, shadow_lookup *lookup) {
  lookup->young = young_of(shadow->state, shadow->setup.sheets, sheet);
}

/* Sets the slab's position in its chunk, and lets surfaces leave marks in the dark. */
static void before_slab(light_shadow *shadow, int sheet, attenuate_job *job) {
  job->position = position_of(shadow->state, shadow->setup.sheets, sheet);
  job->marks = true;
}

/* Prepares a tile so that the next slab also attenuates the buffer's planes SHADOW_SECOND, and is added to
 * the moments. */
static void before_tile(const light_shadow *shadow, size_t tile, attenuate_job *job) {
  const soft_cascade *cascade = shadow->state;
  const shadow_buffer *buffer = shadow->buffer;
  size_t x = tile % (size_t)buffer->tiles_x * TILE, y = tile / (size_t)buffer->tiles_x * TILE;
  job->moment_stride = cascade->level[0].stride;
  for (int c = 0; c < job->channels; c++) {
    job->older[c] = hl_shadow_plane_at(buffer, job->sheet, SHADOW_SECOND, c) + y * buffer->stride + x;
    job->moment[c] = cascade->moment[c] + y * job->moment_stride + x;
  }
}

static void after_tile(light_shadow *shadow, size_t tile) {
  soft_cascade *cascade = shadow->state;
  cascade->touched[tile] = 1;
}

const shadow_method hl_shadow_cascade = {.name = "cascade",
                                         .state_bytes = sizeof(soft_cascade),
                                         .surface_delay = 2,
                                         .surface_rise = 1.25,
                                         .first_slab = 1,
                                         .plan = hl_cascade_plan,
                                         .lay_out = hl_cascade_lay_out,
                                         .begin = hl_cascade_begin,
                                         .before_shading = before_shading,
                                         .before_slab = before_slab,
                                         .before_tile = before_tile,
                                         .after_tile = after_tile,
                                         .advance = advance_cascade,
                                         .exchanges = true,
                                         .advances = ends_chunk,
                                         .end = hl_cascade_end};
