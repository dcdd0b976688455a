/* render/sweep_loop.c - runs the loop over the sheets: it goes through stretches of slabs, whose tiles are
 * divided among the threads.
 *
 * Light never depends on the picture. So the lights' stretch r + 1 and the picture's stretch r are one set of
 * tasks. At the end of the set all threads wait for each other. With K slabs in a stretch, the picture's
 * stretch r reads the planes of the K sheets before its slabs. Meanwhile the lights write K more planes, and
 * start from the plane before these. So the buffers keep the planes of 2 K + 1 sheets. A task takes one tile
 * through all slabs of a stretch, in the order of the sheets: bytes depend neither on K nor on threads. With
 * some methods (cascade), a light's buffer changes as a whole after a stretch, in many short sets of tasks.
 * Threads that have no work in these sets work on the picture.
 *
 * If the method of some light cannot be run in stretches, the work on picture and lights alternates, slab by
 * slab. */
#include "core/context.h"
#include "platform/clock.h"
#include "render/sweep.h"

/* ---- tasks ---- */

/* The number of tiles in a task when a stretch is a single slab. A tile in a single slab is little work, so a
 * task has two tiles then. */
static int tiles_a_task(const sweep *sweep) { return sweep->content.stretch == 1 ? 2 : 1; }

/* The tiles that the sheets of a stretch may touch: one bit for each of the 64 tiles in word number
 * `word`. */
static uint64_t touched_tiles(const occupancy *occupancy, slab_stretch stretch, size_t word) {
  uint64_t bits = 0;
  for (int sheet = stretch.first - 1; sheet < stretch.end; sheet++)
    bits |= occupancy->by_sheet[(size_t)sheet * (size_t)occupancy->tile_words + word];
  return bits;
}

/* The tiles of a light's buffer that must be copied on to the sheets of a stretch: one bit for each of the 64
 * tiles in word number `word`. */
static uint64_t carried_tiles(const shadow_buffer *buffer, slab_stretch stretch, size_t word) {
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y, end = word * 64 + 64;
  uint64_t bits = 0;
  for (size_t tile = word * 64; tile < end && tile < tiles && buffer->ring > 1; tile++)
    bits |= (uint64_t)hl_shadow_is_carried(buffer, tile, stretch.first) << tile % 64;
  return bits;
}

/* Lists the tiles of a view that a stretch needs. light: the light to which the view belongs; if null, the
 * view is the picture's. */
static int list_tiles(const occupancy *occupancy, const sweep_light *light, slab_stretch stretch,
                      uint32_t *list) {
  int count = 0;
  const int32_t *until = light == NULL ? NULL : light->needed_until;
  if (stretch.first == stretch.end) return 0;
  for (size_t word = 0; word < (size_t)occupancy->tile_words; word++) {
    uint64_t bits = touched_tiles(occupancy, stretch, word);
    if (light != NULL) bits |= carried_tiles(light->shadow.buffer, stretch, word);
    for (; bits != 0; bits &= bits - 1) {
      uint32_t tile = (uint32_t)word * 64 + (uint32_t)__builtin_ctzll(bits);
      if (until == NULL || until[tile] >= stretch.first) list[count++] = tile;
    }
  }
  return count;
}

static void shade_stretch(sweep *sweep, size_t tile, int worker) {
  const slab_stretch stretch = sweep->loop.picture_stretch;
  for (int sheet = stretch.first; sheet < stretch.end; sheet++)
    if (hl_occupancy_touches(&sweep->image.occupancy, tile, sheet))
      hl_sweep_shade(sweep, &sweep->arrays.slab_shades[sheet - stretch.first], tile, worker);
}

static void attenuate_stretch(sweep *sweep, int index, size_t tile, int worker) {
  const slab_stretch stretch = sweep->loop.light_stretch;
  const sweep_light *light = &sweep->lights[index];
  const attenuate_job *jobs = sweep->arrays.slab_attenuates + (size_t)index * (size_t)sweep->content.stretch;
  for (int sheet = stretch.first; sheet < stretch.end && hl_light_needs(light, tile, sheet); sheet++) {
    hl_shadow_buffer_carry(light->shadow.buffer, tile, sheet);
    if (hl_is_reached(&sweep->geometry->sheets, &light->shadow, sheet) &&
        hl_occupancy_touches(&light->sheets.occupancy, tile, sheet))
      hl_sweep_attenuate(sweep, index, &jobs[sheet - stretch.first], tile, worker);
  }
}

static void stretch_task(void *data, size_t index, int worker) {
  sweep *sweep = data;
  int each = tiles_a_task(sweep), last = sweep->loop.task_start[sweep->geometry->light_count + 1];
  int first = (int)index * each, end = first + each < last ? first + each : last;
  for (int task = first, light = -1; task < end; task++) {
    while (task >= sweep->loop.task_start[light + 2]) light++;
    if (light < 0) shade_stretch(sweep, sweep->arrays.tasks[task], worker);
    else attenuate_stretch(sweep, light, sweep->arrays.tasks[task], worker);
  }
}

/* Task number `index` of the lights; each tile is a task of its own. */
static void light_task(void *data, size_t index, int worker) {
  const sweep *sweep = data;
  stretch_task(data, (size_t)sweep->loop.task_start[1] + index, worker);
}

/* ---- work that all tiles of a slab share ---- */

static void reach_picture(sweep *sweep) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  const slab_stretch stretch = sweep->loop.picture_stretch;
  for (int sheet = stretch.first; sheet < stretch.end; sheet++) {
    shade_job *job = &sweep->arrays.slab_shades[sheet - stretch.first];
    *job = sweep->constants.shade;
    hl_view_sheets_reach(&sweep->image, sheet);
    hl_view_sheet_rays(&sweep->frame->eye, sheets->normal,
                       hl_sheet_height(sheets, sheet) - 0.5 * sheets->spacing, affine3_identity(),
                       &job->rays);
    job->height = (float)(sheet * sheets->spacing);
    job->sheet = sheet;
    job->plane = (sheet - 1) % sweep->loop.ring;
  }
}

static void reach_light_slab(sweep *sweep, int index, int sheet, attenuate_job *job) {
  sweep_light *light = &sweep->lights[index];
  const sheet_stack *sheets = &sweep->geometry->sheets;
  light_shadow *shadow = &light->shadow;
  *job = sweep->constants.attenuate[index];
  hl_view_sheets_reach(&light->sheets, sheet);
  hl_view_sheet_rays(&shadow->buffer->view, sheets->normal, hl_sheet_height(sheets, sheet),
                     affine3_identity(), &job->rays);
  job->height = (float)(sheet * sheets->spacing);
  job->sheet = sheet;
  if (shadow->method->before_slab != NULL) shadow->method->before_slab(shadow, sheet, job);
}

static void reach_light(sweep *sweep, int index) {
  const slab_stretch stretch = sweep->loop.light_stretch;
  attenuate_job *jobs = sweep->arrays.slab_attenuates + (size_t)index * (size_t)sweep->content.stretch;
  for (int sheet = stretch.first; sheet < stretch.end; sheet++)
    reach_light_slab(sweep, index, sheet, &jobs[sheet - stretch.first]);
}

/* Sets how the picture's slabs of a stretch look up light. Call it when the lights' buffers hold the light
 * that reaches the stretch's first slab. */
static void prepare_lookups(sweep *sweep, slab_stretch stretch) {
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    light_shadow *shadow = &sweep->lights[i].shadow;
    if (shadow->method == NULL || shadow->method->before_shading == NULL) continue;
    for (int sheet = stretch.first; sheet < stretch.end; sheet++)
      shadow->method->before_shading(shadow, sheet, &shadow->lookups[(sheet - 1) % sweep->loop.ring]);
  }
}

/* ---- stretches ---- */

/* Takes the picture through one stretch and the lights through another; either stretch may be empty. offers:
 * if set, the picture's tasks are only offered until finish_picture() is called: threads work on them when
 * they would otherwise wait for other threads. It is set only if stretches have several slabs. */
static void run_stretches(sweep *sweep, slab_stretch picture, slab_stretch light, bool offers) {
  hl_pool *pool = sweep->content.pool;
  double start = hl_clock_seconds();
  sweep->loop.picture_stretch = picture;
  sweep->loop.light_stretch = light;
  reach_picture(sweep);
  int count = list_tiles(&sweep->image.occupancy, NULL, picture, sweep->arrays.tasks);
  sweep->loop.task_start[1] = count;
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    const sweep_light *of = &sweep->lights[i];
    if (of->shadow.method != NULL) {
      reach_light(sweep, i);
      count += list_tiles(&of->sheets.occupancy, of, light, sweep->arrays.tasks + count);
    }
    sweep->loop.task_start[i + 2] = count;
  }
  size_t each = (size_t)tiles_a_task(sweep), picture_tiles = (size_t)sweep->loop.task_start[1];
  if (offers) {
    hl_pool_offer(pool, picture_tiles, stretch_task, sweep);
    hl_pool_run(pool, (size_t)count - picture_tiles, light_task, sweep);
  } else {
    hl_pool_run(pool, ((size_t)count + each - 1) / each, stretch_task, sweep);
  }
  sweep->loop.times.seconds_tiles += hl_clock_seconds() - start;
}

static void finish_picture(sweep *sweep) {
  double start = hl_clock_seconds();
  hl_pool_finish_offer(sweep->content.pool);
  sweep->loop.times.seconds_tiles += hl_clock_seconds() - start;
}

/* Returns whether the buffer of some light changes as a whole at a sheet. */
static bool any_advances(const sweep *sweep, int sheet) {
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    const light_shadow *shadow = &sweep->lights[i].shadow;
    const shadow_method *method = shadow->method;
    if (method == NULL || method->advance == NULL ||
        !hl_is_beyond(&sweep->geometry->sheets, shadow->setup.source, sheet))
      continue;
    if (method->advances == NULL || method->advances(shadow, sheet)) return true;
  }
  return false;
}

/* The stretch that begins at a sheet. It is as long as possible, but ends where a light's buffer changes as a
 * whole. */
static slab_stretch stretch_from(const sweep *sweep, int first) {
  int longest = sweep->geometry->sheets.count - first, end = first;
  if (longest > sweep->content.stretch) longest = sweep->content.stretch;
  while (end - first < longest && (end == first || !any_advances(sweep, end - 1))) end++;
  return (slab_stretch){first, end};
}

/* Changes the lights' buffers as a whole at the end of a stretch, if the lights' methods do so (section 5 of
 * the paper). */
static void advance_lights(sweep *sweep, slab_stretch stretch) {
  double start = hl_clock_seconds();
  int sheet = stretch.end - 1;
  for (int i = 0; i < sweep->geometry->light_count && stretch.first < stretch.end; i++) {
    sweep_light *light = &sweep->lights[i];
    light_shadow *shadow = &light->shadow;
    if (shadow->method == NULL || shadow->method->advance == NULL ||
        !hl_is_beyond(&sweep->geometry->sheets, light->source, sheet))
      continue;
    hl_shadow_buffer_reach(shadow->buffer, sheet);
    shadow->method->advance(shadow, &light->sheets.occupancy, sheet);
  }
  sweep->loop.times.seconds_soften += hl_clock_seconds() - start;
}

/* Reports the part of the frame that is finished after a number of this sweep's sheets. Each of the frame's
 * sweeps has an equal share, so that the part rises over all of them. */
static void report_progress(const sweep *sweep, int sheets) {
  const plan_sweeps *all = &sweep->frame_plan->sweeps;
  const double finished = (double)(sweep->plan - all->list) + (double)sheets / sweep->geometry->sheets.count;
  hl_progress(sweep->content.context, "render", finished / all->count);
}

/* The paper's loop over the sheets (section 3.1, eighteen steps).
 *
 *    1. transform voxels to the half-way vector's frame      hl_sweep_begin
 *    2. bucket sort them by height                           hl_sweep_begin
 *    3. opacity map = 0                                      hl_sweep_begin
 *    4. shadow buffer = full light                           hl_sweep_begin
 *    5. for each sheet
 *    6, 7.   image and shadow sheets = 0                     hl_sweep_shade, hl_sweep_attenuate
 *    8 - 11. add every footprint to both                     hl_sweep_shade, hl_sweep_attenuate
 *   12 - 15. gradient, classification, shadow, illumination  hl_sweep_shade
 *   16.      composite to the frame buffer                   hl_sweep_shade
 *   17.      classify and composite the shadow sheet         hl_sweep_attenuate
 *            (soft: convolve for the next sheet)             advance_lights
 *   18. end
 *
 * This loop differs from the paper's in one point: it classifies, lights and composites the slab between two
 * sheets, and not the sheet. So no matter that a sharp transfer function shows is lost between sheets. A slab
 * is lit by the light that has passed the slabs before it. The first and the last sheet lie outside the
 * content. */
hl_status hl_sweep_run(sweep *sweep, hl_error *error) {
  const int sheets = sweep->geometry->sheets.count;
  const bool ahead = sweep->loop.ring > 1;
  uint64_t waits = hl_pool_waits(sweep->content.pool);
  slab_stretch picture = {1, 1}, light = {1, 1};
  while (picture.end < sheets) {
    picture = light;
    light = stretch_from(sweep, light.end);
    prepare_lookups(sweep, light);
    if (ahead) {
      run_stretches(sweep, picture, light, light.first < light.end && any_advances(sweep, light.end - 1));
    } else {
      picture = light;
      run_stretches(sweep, picture, (slab_stretch){1, 1}, false);
      run_stretches(sweep, (slab_stretch){1, 1}, light, false);
    }
    advance_lights(sweep, light);
    finish_picture(sweep);
    if (sweep->act.purpose == SWEEP_PICTURE) report_progress(sweep, picture.end - 1);
    if (hl_pool_cancelled(sweep->content.pool))
      return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while rendering");
  }
  sweep->loop.times.waits += hl_pool_waits(sweep->content.pool) - waits;
  return HL_OK;
}
