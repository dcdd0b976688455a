/* shadow_cascade/cascade_levels.c - plans a cascade's buffer, chunks and levels, and lays out their memory.
 */
#include <string.h>

#include "elementary/elementary.h"
#include "shadow_cascade/cascade_passes.h"

/* Limits of a sweep's chunks. The thickness of chunks is measured in omega, in pixels. Chunks are so thick
 * that a sweep has at most ENOUGH_CHUNKS chunks, but not thicker than THICK_CHUNK. If a sweep would then have
 * more than NEAR_CHUNKS chunks, or FAR_CHUNKS for a parallel light, chunks become thicker, up to
 * THICKEST_CHUNK. Thicker chunks are not allowed, because the chunks next to a receiver cast shadows without
 * penumbrae, which is visible where objects touch. With 64 chunks, balls under parallel lights 60 to 90
 * degrees wide showed rings. With some greater numbers of chunks below 200, balls under lights 90 to 120
 * degrees wide showed rings. */
static const double ENOUGH_CHUNKS = 32, NEAR_CHUNKS = 64, FAR_CHUNKS = 88, GREATEST_CHUNKS = 200;
static const double LEAST_CHUNK = 0.15, THICK_CHUNK = 1.3, THICKEST_CHUNK = 2;

/* Divides omega from start to end into chunks of one length. The magnitude of a near light's omega grows
 * without bound towards the light, so chunks of one length may be more than allowed. In that case the length
 * of a chunk is a fixed fraction of -omega at the chunk's start. Derived: at a distance z from the light, a
 * penumbra whose width in omega is w has the width w z in space, and -omega is L / z. So the penumbrae of all
 * chunks have the same width in space. For a lamp within the content, the last chunks would be a small
 * fraction of a pixel long; so all chunks are made at least `thick` long. Returns the number of chunks. */
static double divide(soft_cascade *cascade, double start, double end, bool within) {
  double length = end - start, few = cascade->parallel ? FAR_CHUNKS : NEAR_CHUNKS;
  double thick = fmin(fmax(length / ENOUGH_CHUNKS, LEAST_CHUNK), THICK_CHUNK);
  double most = fmin(fmax(few, length / THICKEST_CHUNK), GREATEST_CHUNKS);
  cascade->chunk_start = start;
  cascade->chunk = cascade->shortest_chunk = fmax(thick, length / most);
  cascade->shrink = 0;
  /* If a light has an emission image, all chunks have the same length, because the errors of shadows behind
   * an edge are then 0.024 instead of 0.026. */
  bool even = cascade->emission == NULL;
  if (cascade->parallel || !even || cascade->chunk <= thick) return length / cascade->chunk;
  cascade->shrink = 1 - hl_pow(end / start, 1 / most);
  cascade->chunk = cascade->shrink * -start;
  cascade->shortest_chunk = cascade->shrink * -end;
  if (!within || cascade->shortest_chunk >= thick) return most;
  cascade->shortest_chunk = thick;
  cascade->evened = -thick / cascade->shrink;
  return hl_ln(cascade->evened / start) / hl_ln(1 - cascade->shrink) + (end - cascade->evened) / thick;
}

/* The least number of chunks between a receiver and a level's groups. The number follows from the numbers of
 * groups that the levels keep: three on level 0, two on level 1, five on every other level. */
static double chunks_before(int level) { return level < 2 ? 3 * level : 4 * (hl_pow(2, level - 1) - 1); }

/* The scale of a level: the edge of its pixels, in pixels of the buffer. The scale is chosen so that the
 * narrowest penumbra on the level is at least one and a half of the level's pixels wide. Resampling blurs,
 * too, and the blur by resampling is subtracted from the penumbra's own blur (resampled_by()). With an
 * emission image, the blur by resampling cannot be subtracted; so the narrowest penumbra is then at least
 * four of the level's pixels wide. */
static int level_scale(const soft_cascade *cascade, int level) {
  double penumbra = cascade->shortest_chunk * chunks_before(level) * cascade->least_fraction,
         own = cascade->emission == NULL ? 1.5 : 4;
  int scale = 1, greatest = level < 2 ? 1 << level : 1 << (level - 1); /* coarser pixels were less exact, and
                                                                        * hardly took less time */
  while (2 * scale * own <= penumbra && scale < greatest) scale *= 2;
  return scale;
}

static cascade_field field_of_plane(const cascade_level *level, size_t plane) {
  size_t tiles = (size_t)level->tiles_x * (size_t)level->tiles_y;
  size_t at = plane * level->plane + level->origin;
  return (cascade_field){.pixels = level->memory == NULL ? NULL : level->memory + at,
                         .zeros = level->flags + plane * tiles,
                         .place = level->first + at};
}

/* Hands out the next plane of a level's memory as a field. *used: the number of planes that were handed out
 * before. */
static cascade_field next_field(const cascade_level *level, size_t *used) {
  return field_of_plane(level, (*used)++);
}

/* Sets the fraction of variance for each column and row of tiles: the square of the light's width as seen
 * from this column or row, divided by the square of the light's greater width. */
static void set_parts(const soft_cascade *cascade, const sheet_light *light, int axis, int count, int scale,
                      cascade_box *boxes) {
  for (int tile = 0; tile < count; tile++) {
    double slope = cascade->slope_start[axis] + cascade->slope_step[axis] * (tile + 0.5) * TILE * scale;
    boxes[tile].fraction = hl_sheet_light_squared_width(light, axis, slope) /
                           (cascade->widest * cascade->widest);
  }
}

/* The number of planes of field_pixel that take as much memory as one plane of floats. */
enum { MOMENT_PLANES = sizeof(float) / sizeof(field_pixel) };

static void plan_level(soft_cascade *cascade, int index, int tiles_x, int tiles_y) {
  cascade_level *level = &cascade->level[index];
  size_t channels = (size_t)cascade->channels;
  level->scale = level_scale(cascade, index);
  if (index > 0 && level->scale > 2 * cascade->level[index - 1].scale)
    level->scale = 2 * cascade->level[index - 1].scale;
  level->tiles_x = (tiles_x + level->scale - 1) / level->scale;
  level->tiles_y = (tiles_y + level->scale - 1) / level->scale;
  level->stride = (size_t)level->tiles_x * TILE + CASCADE_MARGIN;
  level->plane = ((size_t)level->tiles_y * TILE + CASCADE_MARGIN) * level->stride;
  level->origin = CASCADE_MARGIN * level->stride + CASCADE_MARGIN;
  level->capacity = index < 2 ? CASCADE_FEW_GROUPS : CASCADE_GROUPS;
  level->planes = channels * (2 * (size_t)level->capacity + 2) +
                  (index == 0 ? 2 * channels * MOMENT_PLANES : 1);
  if (cascade->emission != NULL) level->planes += 2 * channels;
  level->pixels = level->planes * level->plane + (CASCADE_MARGIN + 1) * level->stride;
  level->first = index == 0 ? 0 : level[-1].first + level[-1].pixels;
}

static void sum_up_parts(cascade_level *level) {
  const int count[2] = {level->tiles_x, level->tiles_y};
  const cascade_box *box = level->boxes;
  level->greatest_fraction = 0;
  for (int axis = 0; axis < 2; axis++) {
    level->fraction[axis] = 0;
    for (int i = 0; i < count[axis]; i++, box++) {
      level->fraction[axis] += box->fraction / count[axis];
      level->greatest_fraction = fmax(level->greatest_fraction, box->fraction);
    }
  }
}

/* Assigns a level's planes to its fields, in the order of the level's memory. */
static void place_fields(soft_cascade *cascade, int index) {
  cascade_level *level = &cascade->level[index];
  size_t channels = (size_t)cascade->channels, used = 0;
  for (size_t c = 0; c < channels; c++) {
    for (int g = 0; g < level->capacity; g++) {
      level->group[g].absorbed[c] = next_field(level, &used);
      level->group[g].thin[c] = next_field(level, &used);
    }
    for (int i = 0; i < 2; i++) level->sum[i][c] = next_field(level, &used);
  }
  if (index > 0) level->scratch = next_field(level, &used);
  for (size_t c = 0; c < 2 * channels && cascade->emission != NULL; c++)
    level->mean[c % 2][c / 2] = next_field(level, &used);
  for (size_t c = 0; c < channels && index == 0; c++) {
    cascade->absorbed[c] = level->sum[0][c];
    if (level->memory == NULL) continue;
    cascade->moment[c] = (float *)(void *)(level->memory + used * level->plane) + level->origin;
    used += MOMENT_PLANES;
    cascade->absorbed_at_start[c] = (float *)(void *)(level->memory + used * level->plane) + level->origin;
    used += MOMENT_PLANES;
  }
}

static void begin_level(soft_cascade *cascade, int index, const sheet_light *light) {
  cascade_level *level = &cascade->level[index];
  memset(level->flags, 1, level->planes * (size_t)level->tiles_x * (size_t)level->tiles_y);
  set_parts(cascade, light, 0, level->tiles_x, level->scale, level->boxes);
  set_parts(cascade, light, 1, level->tiles_y, level->scale, level->boxes + level->tiles_x);
  sum_up_parts(level);
  place_fields(cascade, index);
}

/* The variance of the blur by look-ups, in squared pixels. A bilinear look-up weighs two pixels by p and 1 -
 * p, according to their distances. The variance of these weights is p (1 - p), which is 1/6 on average. Cubic
 * convolution has no variance. */
static double lookup_variance(bool cubic) { return cubic ? 0 : 1.0 / 6; }

/* Plans the chunks and levels of a buffer whose view is planned. */
static void plan_levels(soft_cascade *cascade, const light_shadow *shadow) {
  const sheet_light *light = &shadow->plan.seen;
  const view *view = &shadow->plan.view;
  int tiles_x = hl_tiles(view->width), tiles_y = hl_tiles(view->height);
  const sheet_stack *sheets = shadow->setup.sheets;
  vec3 normal = sheets->normal;
  double first = sheets->first, last = hl_last_height(sheets), pixel = vec3_length(view->du);
  double widest = fmax(light->width_u, light->width_v);
  *cascade = (soft_cascade){.parallel = light->parallel,
                            .channels = shadow->setup.channels,
                            .lookup_variance = lookup_variance(shadow->plan.cubic),
                            .rate = widest / pixel,
                            .widest = widest,
                            .least_fraction = fmin(light->width_u, light->width_v) / widest,
                            .light_height = vec3_dot(light->middle, normal),
                            .emission = shadow->setup.emission};
  const vec3 along[2] = {light->u, light->v};
  for (int axis = 0; axis < 2; axis++) {
    cascade->slope_start[axis] = vec3_dot(view->corner, along[axis]);
    cascade->slope_step[axis] = vec3_dot(axis == 0 ? view->du : view->dv, along[axis]);
  }
  double start = hl_cascade_omega(cascade, first), end = hl_cascade_omega(cascade, last);
  /* towards a near light, -omega grows without bound. But penumbrae that are wider than twice the buffer need
   * no further chunks. For parallel light, `start` is not limited, because even the first slabs may be
   * receivers, which would get shadows without penumbrae */
  if (!cascade->parallel) start = fmax(start, end - 2 * TILE * fmax(tiles_x, tiles_y));
  double chunks = divide(cascade, start, end, shadow->setup.source->sectors != NULL);
  /* derived: level j > 1 is first used after 5 * 2^(j-1) - 4 chunks, because each level keeps five groups;
   * levels 0 and 1 together keep five groups, too */
  int levels = 2 + (int)floor(hl_log2(fmax(chunks + 7, 5) / 5));
  cascade->level_count = levels < CASCADE_LEVELS ? levels : CASCADE_LEVELS;
  for (int i = 0; i < cascade->level_count; i++) plan_level(cascade, i, tiles_x, tiles_y);
  cascade->reads = (cascade_reads){.tiles_x = tiles_x, .tiles_y = tiles_y};
}

static bool is_read_cubic(const shadow_setup *setup) {
  hl_shadow_lookup lookup = setup->settings->shadow_lookup;
  return lookup == HL_LOOKUP_AUTO ? setup->emission == NULL : lookup == HL_LOOKUP_CUBIC;
}

/* The greatest tangent of the angle between a view's rays and the sheets' normal. The tangent is infinite if
 * some rays run along the sheets. The function looks only at the rays at the corners: the rays of a rectangle
 * of pixels meet a sheet in a quadrangle, and the corners of the quadrangle are farthest away. */
static double steepest_tangent(const view *view, vec3 normal) {
  double greatest = 0, first = 0;
  for (int corner = 0; corner < 4; corner++) {
    vec3 start, way;
    hl_view_ray(view, corner % 2 * view->width, corner / 2 * view->height, &start, &way);
    double climb = vec3_dot(way, normal);
    if (corner == 0) first = climb;
    if (!(climb * first > 0)) return INFINITY;
    greatest = fmax(greatest, vec3_length(vec3_subtract(way, vec3_scale(normal, climb))) / fabs(climb));
  }
  return greatest;
}

/* The width, in pixels, of a margin around the bricks' projections; the cascade keeps its buffer up to date
 * within this margin. For a sample of a brick, the buffer may be looked up in the middle of the slab, half a
 * slab away from the brick along the eye's ray. In a buffer parallel to the sheets, this distance moves the
 * look-up by at most half the sheets' distance times the sum of the tangents of the eye's ray and the light's
 * ray (derived). For lights within the content, the margin is limited to a tile. */
static double look_up_spare(const shadow_setup *setup, const shadow_plan *plan) {
  const sheet_stack *sheets = setup->sheets;
  const view *view = &plan->view;
  double nearest = 1, pixel = fmin(vec3_length(view->du), vec3_length(view->dv));
  if (view->perspective) nearest = fmax(sheets->first - vec3_dot(view->origin, sheets->normal), 1e-9 * pixel);
  double tangents = steepest_tangent(setup->eye, sheets->normal) + steepest_tangent(view, sheets->normal);
  int taps = plan->cubic ? 2 * PIXEL_TO_SPARE : PIXEL_TO_SPARE;
  return taps + fmin(0.5 * sheets->spacing * tangents / (pixel * nearest), TILE);
}

void hl_cascade_plan(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  shadow_plan *plan = &shadow->plan;
  light_source middle = *setup->source;
  plan->cubic = is_read_cubic(setup);
  plan->second = true; /* the planes SHADOW_SECOND hold the older light from which samples fade to the
                        * transmittance */
  hl_plan_soft(shadow, hl_blurred_pixel(setup, plan->cubic));
  plan->extent.u = plan->seen.u;
  if (middle.parallel) middle.direction = vec3_normalise(plan->seen.middle);
  else middle.position = plan->seen.middle;
  hl_shadow_view(&middle, setup->sheets->normal, &plan->extent, &plan->view);
  plan->spare = look_up_spare(setup, plan);
  if (setup->emission != NULL)
    hl_light_emission_see(setup->source, &plan->seen, setup->sheets->normal, setup->emission);
  plan_levels(shadow->state, shadow);
}

void hl_cascade_lay_out(light_shadow *shadow, shadow_layouts *layouts) {
  soft_cascade *cascade = shadow->state;
  cascade_reads *reads = &cascade->reads;
  size_t tiles = (size_t)reads->tiles_x * (size_t)reads->tiles_y;
  cascade->touched = hl_layout_take(&layouts->passing, tiles, 1);
  cascade->refilled = hl_layout_take(&layouts->passing, tiles, 1);
  reads->before = hl_layout_take(
      &layouts->passing, (size_t)(reads->tiles_x + 1) * (size_t)(reads->tiles_y + 1), sizeof *reads->before);
  hl_cascade_exchange_lay_out(cascade, shadow->setup.exchange, layouts);
  for (int i = 0; i < cascade->level_count; i++) {
    cascade_level *level = &cascade->level[i];
    size_t tiles_x = (size_t)level->tiles_x, tiles_y = (size_t)level->tiles_y;
    level->memory = hl_layout_take(&layouts->kept, level->pixels, sizeof *level->memory);
    level->flags = hl_layout_take(&layouts->passing, level->planes, tiles_x * tiles_y);
    level->boxes = hl_layout_take(&layouts->passing, tiles_x + tiles_y, sizeof *level->boxes);
  }
}

void hl_cascade_begin_elsewhere(light_shadow *shadow) {
  soft_cascade *cascade = shadow->state;
  size_t tiles = (size_t)cascade->reads.tiles_x * (size_t)cascade->reads.tiles_y;
  memset(cascade->touched, 0, tiles);
  memset(cascade->refilled, 0, tiles);
  for (int i = 0; i < cascade->level_count; i++) begin_level(cascade, i, &shadow->plan.seen);
  cascade->level[0].count = 1; /* the first group lies at the start of the first chunk */
  cascade->level[0].group[0].omega = cascade->chunk_start;
}

hl_status hl_cascade_begin(light_shadow *shadow, hl_error *error) {
  (void)error;
  soft_cascade *cascade = shadow->state;
  shadow_memory *memory = shadow->kept;
  if (!memory->zeros) hl_pool_clear(shadow->means.pool, memory->planes, memory->capacity);
  memory->zeros = false;
  hl_cascade_begin_elsewhere(shadow);
  cascade->begun = true;
  for (int sheet = 0; sheet < shadow->buffer->ring; sheet++)
    for (int c = 0; c < shadow->setup.channels; c++)
      shadow->lookups[sheet].older[c] = hl_shadow_plane_at(shadow->buffer, sheet, SHADOW_SECOND, c);
  return HL_OK;
}

/* Clears one plane of a level, and the plane's flags if it has any. The planes of moments have no flags. */
static void clear_plane(void *data, size_t index, int worker) {
  (void)worker;
  const cascade_level *level = data;
  const cascade_field field = field_of_plane(level, index);
  for (int y = 0; y < level->tiles_y; y++)
    for (int x = 0; x < level->tiles_x; x++) hl_cascade_clear_tile(level, &field, x, y);
}

/* Clears the moments (sums of absorbed light times its place) of the last chunk of sheets, which is
 * unfinished, and the absorbed light of this chunk's start. All tiles are cleared, even
 * the tiles that the chunk has not touched, because rounding, and matter behind surfaces' marks, leave
 * moments in dark pixels that the end of a chunk does not clear. */
static void clear_moments(const soft_cascade *cascade, hl_pool *pool) {
  const cascade_level *level = &cascade->level[0];
  size_t bytes = (size_t)level->tiles_y * TILE * level->stride * sizeof(float);
  for (int c = 0; c < cascade->channels; c++) {
    hl_pool_clear(pool, cascade->moment[c], bytes);
    hl_pool_clear(pool, cascade->absorbed_at_start[c], bytes);
  }
}

/* Ends a cascade's shadow: fills the memory that the cascade keeps from frame to frame with zeros, because
 * the next frame expects zeros. */
void hl_cascade_end(light_shadow *shadow) {
  soft_cascade *cascade = shadow->state;
  hl_pool *pool = shadow->means.pool;
  if (!cascade->begun) return;
  hl_cascade_exchange_receive(cascade);
  for (int i = 0; i < cascade->level_count; i++)
    hl_pool_run(pool, cascade->level[i].planes, clear_plane, (void *)&cascade->level[i]);
  clear_moments(cascade, pool);
  shadow->kept->zeros = !hl_pool_cancelled(pool);
}
