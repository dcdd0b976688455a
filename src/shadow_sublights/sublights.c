/* shadow_sublights/sublights.c - manages the buffers of a light's sub-lights, and attenuates these buffers by
 * each slab. */
#include "shadow_sublights/sublights.h"

#include <string.h>

#include "core/memory.h"
#include "light/light_extent.h"
#include "shadow/shadow_method.h"

/* The greatest number of bytes of the sub-lights' buffers. A frame that needs more bytes is refused. */
static const double GREATEST_BYTES = 4294967296.0;

enum { MOVED_COPIES = SLAB_COPIES - 1 };

void hl_sublight_view(const light_shadow *shadow, int i, view *view) {
  const shadow_setup *setup = &shadow->setup;
  const light_source *source = setup->source;
  int side = setup->settings->light_samples;
  double square[2];
  light_source at_point = *source;
  if (setup->emission == NULL) hl_sublight_point(source, side, i / side, i % side, square);
  else hl_sublight_grid_point(side, i / side, i % side, square);
  vec3 offset = hl_light_point(source, square[0], square[1]);
  if (source->parallel) at_point.direction = vec3_normalise(vec3_add(source->direction, offset));
  else at_point.position = vec3_add(source->position, offset);
  hl_shadow_view(&at_point, setup->sheets->normal, &shadow->plan.extent, view);
}

/* Finds the numbers of tiles into which the buffer of any sub-light fits. */
static void find_tiles(const light_shadow *shadow, sublights *all) {
  view view;
  for (int i = 0; i < all->count; i++) {
    hl_sublight_view(shadow, i, &view);
    if (hl_tiles(view.width) > all->tiles_x) all->tiles_x = hl_tiles(view.width);
    if (hl_tiles(view.height) > all->tiles_y) all->tiles_y = hl_tiles(view.height);
  }
}

/* Buffers have a margin of a tile on the left and on the right, because the slab's tiles reach across their
 * edges. The last row of a buffer is followed by ROWS_BEYOND further rows, which look-ups may read. */
enum { ROWS_BEYOND = 7 };
static void lay_out_planes(sublights *sublights) {
  /* a row of pixels fills whole lines of the cache */
  sublights->stride = (size_t)(sublights->tiles_x + 3) / 2 * 2 * TILE;
  sublights->plane = ((size_t)sublights->tiles_y * TILE + ROWS_BEYOND) * sublights->stride;
}

/* The number of planes of one sub-light: the product of the numbers of channels and of kinds of planes. */
static size_t planes_of_sublight(const sublights *all) { return (size_t)all->channels * (size_t)all->kinds; }

static void lay_out_sublights(light_shadow *shadow, shadow_layouts *layouts) {
  sublights *all = shadow->state;
  hl_layout *layout = &layouts->passing;
  size_t count = (size_t)all->count, planes = planes_of_sublight(all);
  size_t tiles = (size_t)all->tiles_x * (size_t)all->tiles_y;
  const view *slab = &shadow->plan.view;
  size_t slab_tiles = hl_view_tiles(slab);
  all->memory = hl_layout_take(layout, count * planes, all->plane * sizeof *all->memory);
  all->moved_floats = MOVED_COPIES * planes * hl_shadow_plane(slab, shadow->plan.reach);
  all->moved = hl_layout_take(layout, all->moved_floats, sizeof *all->moved);
  all->sublight = hl_layout_take(layout, count, sizeof *all->sublight);
  all->lookups = hl_layout_take(layout, count, sizeof *all->lookups);
  all->flags = hl_layout_take(layout, count * tiles, sizeof *all->flags);
  all->marks = hl_layout_take(layout, count * tiles, sizeof *all->marks);
  all->rows = hl_layout_take(layout, slab_tiles, sizeof *all->rows);
  all->found = hl_layout_take(layout, slab_tiles, sizeof *all->found);
}

/* Fills the buffers of all sub-lights with full light. */
static void fill_sublights(const light_shadow *shadow, sublights *all) {
  hl_pool *pool = shadow->means.pool;
  size_t count = (size_t)all->count, pixels = count * planes_of_sublight(all) * all->plane;
  size_t tiles = (size_t)all->tiles_x * (size_t)all->tiles_y;
  size_t slab_tiles = (size_t)shadow->buffer->tiles_x * (size_t)shadow->buffer->tiles_y;
  hl_pool_set(pool, all->memory, pixels * sizeof(sublight_pixel), 0xff); /* all bits set: SUBLIGHT_ONE */
  hl_pool_fill(pool, all->moved, all->moved_floats, 1);
  for (size_t i = 0; i < count * tiles; i++) all->flags[i] = ALL_BLOCKS;
  memset(all->marks, 0, count * tiles * sizeof *all->marks);
  memset(all->rows, 0, slab_tiles * sizeof *all->rows);
  memset(all->found, 0, slab_tiles * sizeof *all->found);
}

/* Sets the sub-lights' weights from the light's emission image. */
static hl_status weigh_sublights(hl_context *context, sublights *sublights, const light_source *source,
                                 int side, hl_error *error) {
  size_t count = (size_t)sublights->count;
  double mean[HL_CHANNELS];
  float(*weights)[HL_CHANNELS] = hl_allocate(context, count, sizeof *weights);
  if (weights == NULL) return hl_fail_memory(error, count * sizeof *weights, "sub-lights");
  hl_light_emission_weights(source, side, weights, mean);
  for (size_t i = 0; i < count; i++) memcpy(sublights->lookups[i].weight, weights[i], sizeof *weights);
  hl_release(context, weights);
  return HL_OK;
}

/* Returns a pointer to pixel (0,0) of one channel of a sub-light. kind: the transmittance, or the light at
 * the outside of surfaces. */
static sublight_pixel *sublight_plane(const sublights *all, const sublight *one, shadow_plane kind,
                                      int channel) {
  size_t number = (size_t)(kind == SHADOW_OUTSIDE ? all->channels : 0) + (size_t)channel;
  return one->pixels + number * all->plane;
}

static void begin_sublight(const light_shadow *shadow, sublights *all, int i) {
  sublight *one = &all->sublight[i];
  size_t tiles = (size_t)all->tiles_x * (size_t)all->tiles_y, first = (size_t)i * tiles;
  *one = (sublight){.pixels = all->memory + (size_t)i * planes_of_sublight(all) * all->plane + TILE,
                    .lit = all->flags + first,
                    .touched = all->marks + first};
  hl_sublight_view(shadow, i, &one->view);
  all->lookups[i] = (sublight_lookup){.map = hl_map_of_view(&one->view), .weight = {1, 1, 1}};
  all->lookups[i].map.stride = all->stride;
  for (int c = 0; c < all->channels; c++) {
    all->lookups[i].transmittance[c] = sublight_plane(all, one, SHADOW_TRANSMITTANCE, c);
    if (all->kinds > 1) all->lookups[i].outside[c] = sublight_plane(all, one, SHADOW_OUTSIDE, c);
  }
}

static hl_status begin_sublights(light_shadow *shadow, hl_error *error) {
  const shadow_setup *setup = &shadow->setup;
  sublights *all = shadow->state;
  fill_sublights(shadow, all);
  for (int i = 0; i < all->count; i++) begin_sublight(shadow, all, i);
  shadow->sublights = all->lookups;
  if (setup->emission == NULL) return HL_OK;
  return weigh_sublights(setup->context, all, setup->source, setup->settings->light_samples, error);
}

/* ---- compositing ---- */

/* A pointer to pixel (0,0) of a copy of the slab; copy 0 is the slab itself. */
static float *slab_copy(const sublights *sublights, const shadow_buffer *slab, shadow_plane kind, int channel,
                        int copy) {
  size_t number = (size_t)(kind == SHADOW_OUTSIDE ? sublights->channels : 0) + (size_t)channel;
  if (copy == 0) return (kind == SHADOW_OUTSIDE ? slab->outside : slab->transmittance)[channel];
  return sublights->moved + (number * MOVED_COPIES + (size_t)copy - 1) * slab->plane + slab->origin;
}

/* Finds the point, in the slab's pixels, at which a ray of the sub-light reaches a height. The ray goes
 * through the sub-light's pixel (at, at). Returns false if this point lies behind the sub-light or behind the
 * light's centre. */
static bool slab_position(const view *sublight, const view *slab, vec3 normal, double height, double at,
                          double uv[2]) {
  vec3 start, way;
  hl_view_ray(sublight, at, at, &start, &way);
  double climb = vec3_dot(way, normal), distance = (height - vec3_dot(start, normal)) / climb;
  if (sublight->perspective && !(distance > 0)) return false;
  return hl_view_project(slab, vec3_add(start, vec3_scale(way, distance)), uv);
}

float hl_sublight_carry(int slabs, int i, int count) {
  double turn = slabs * 0.6180339887498949 + (double)i / count;
  /* The carry keeps a distance from 0 and 1, so that a whole number plus the carry is always truncated to
   * this whole number. */
  return (float)(1.0 / 128 + (turn - floor(turn)) * 63 / 64);
}

/* The greatest shift of the slab, in pixels, for which sublight_row(), which only shifts the slab, is used.
 * Grazing light may shift the slab farther; the general function, which clamps positions, is then used. */
static const double FARTHEST_SHIFT = 1 << 20;

bool hl_sublight_place(const view *sublight, const view *slab, vec3 normal, double height,
                       sublight_place *place) {
  const double far = 1024;
  double zero[2], other[2];
  *place = (sublight_place){0};
  if (!slab_position(sublight, slab, normal, height, 0, zero) ||
      !slab_position(sublight, slab, normal, height, far, other))
    return false;
  for (int axis = 0; axis < 2; axis++) {
    double scale = (other[axis] - zero[axis]) / far;
    if (fabs(scale - 1) < 1e-6) scale = 1;
    place->scale[axis] = (float)scale;
    place->shift[axis] = (float)zero[axis];
  }
  place->shifted = place->scale[0] == 1 && place->scale[1] == 1 &&
                   fmax(fabs(zero[0]), fabs(zero[1])) < FARTHEST_SHIFT;
  for (int axis = 0; axis < 2 && place->shifted; axis++) place->half[axis] = (int)floor(2 * zero[axis] + 0.5);
  return true;
}

/* Prepares a sub-light's job for a slab. */
static void map_sublight(const sublights *sublights, sublight *sublight, const shadow_buffer *slab,
                         vec3 normal, double height) {
  sublight->reaches = hl_sublight_place(&sublight->view, &slab->view, normal, height, &sublight->place);
  sublight->job = (sublight_job){
      .slab_stride = slab->stride,
      .rows = sublights->rows,
      .slab_tiles_x = slab->tiles_x,
      .slab_tiles_y = slab->tiles_y,
      .place = sublight->place,
      .stride = sublights->stride,
      .tiles_x = sublights->tiles_x,
      .carry = hl_sublight_carry(sublights->slabs, (int)(sublight - sublights->sublight), sublights->count),
      .channels = sublights->channels};
  for (int c = 0; c < sublights->channels; c++) {
    for (int i = 0; i < SLAB_COPIES; i++)
      sublight->job.slab[c][i] = slab_copy(sublights, slab, SHADOW_TRANSMITTANCE, c, i);
    sublight->job.transmittance[c] = sublight_plane(sublights, sublight, SHADOW_TRANSMITTANCE, c);
    if (sublights->kinds == 1) continue;
    for (int i = 0; i < SLAB_COPIES; i++)
      sublight->job.slab_outside[c][i] = slab_copy(sublights, slab, SHADOW_OUTSIDE, c, i);
    sublight->job.outside[c] = sublight_plane(sublights, sublight, SHADOW_OUTSIDE, c);
  }
}

typedef struct sublight_task {
  sublights *sublights;
  shadow_buffer *slab;
  const sublight_functions *functions;
  int x0, x1, y0, y1;          /* the first and the last column, and the first and the last row, of the slab's
                                * tiles in which some pixel is below 1 */
  bool ends_run;               /* whether the slab is the last slab of its run, after which the lit blocks are
                                * found */
  const int32_t *needed_until; /* borrowed: sublights_until of the light_shadow */
  int slab_after;              /* the number of the next slab, counted as in needed_until */
} sublight_task;

/* Finds, along one axis, the first and the last tile of the slab that lie under the pixels x to x + TILE of a
 * sub-light, after scaling and shifting. One more pixel of the slab on either side counts, too. */
static void tiles_under(double x, double scale, double shift, int tiles, int *first, int *last) {
  double low = (scale * x + shift - 1) / TILE, high = (scale * (x + TILE) + shift + 1) / TILE;
  *first = low < 0 ? 0 : low > tiles ? tiles : (int)low;
  *last = high < 0 ? -1 : high >= tiles ? tiles - 1 : (int)high;
}

static bool any_touched(const shadow_buffer *slab, int x0, int x1, int y0, int y1) {
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++)
      if (slab->tile_touched[(size_t)y * (size_t)slab->tiles_x + (size_t)x] != 0) return true;
  return false;
}

/* Returns whether the slab has a pixel below 1 in some tile of a rectangle of tiles. */
static bool any_present(const sublight_job *job, int x0, int x1, int y0, int y1) {
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++)
      if (job->rows[(size_t)y * (size_t)job->slab_tiles_x + (size_t)x] != 0) return true;
  return false;
}

/* Finds the rectangle around the slab's tiles in which some pixel is below 1. If no tile has such a pixel, x1
 * becomes less than 0. */
static void bound_present(sublight_task *task) {
  const shadow_buffer *slab = task->slab;
  task->x0 = slab->tiles_x;
  task->y0 = slab->tiles_y;
  task->x1 = task->y1 = -1;
  for (int y = 0; y < slab->tiles_y; y++) {
    const slab_rows *row = task->sublights->rows + (size_t)y * (size_t)slab->tiles_x;
    for (int x = 0; x < slab->tiles_x; x++) {
      if (row[x] == 0) continue;
      if (x < task->x0) task->x0 = x;
      if (x > task->x1) task->x1 = x;
      if (y < task->y0) task->y0 = y;
      task->y1 = y;
    }
  }
}

/* Finds, along one axis, the first and the last tile of a sub-light that lie under tiles `low` to `high` of
 * the slab. */
static void sublight_tiles(const sublight *sublight, int axis, int low, int high, int tiles, int *first,
                           int *last) {
  double scale = 1 / (double)sublight->place.scale[axis],
         shift = -(double)sublight->place.shift[axis] * scale;
  int unused;
  tiles_under((double)low * TILE, scale, shift, tiles, first, &unused);
  tiles_under((double)high * TILE, scale, shift, tiles, &unused, last);
}

/* Limits a range of the slab's tiles to the tiles that lie over lit tiles of a sub-light. y: the sub-light's
 * row of tiles. */
static void lit_range(const sublight_task *task, const sublight *sublight, int y, int *x0, int *x1) {
  const int tiles = task->sublights->tiles_x;
  const uint16_t *lit = sublight->lit + (size_t)y * (size_t)tiles;
  int first = 0, last = tiles - 1, low, high, unused;
  while (first <= last && lit[first] == 0) first++;
  while (last > first && lit[last] == 0) last--;
  const double scale = (double)sublight->place.scale[0], shift = (double)sublight->place.shift[0];
  tiles_under((double)first * TILE, scale, shift, task->slab->tiles_x, &low, &unused);
  tiles_under((double)last * TILE, scale, shift, task->slab->tiles_x, &unused, &high);
  if (*x0 < low) *x0 = low;
  if (*x1 > high) *x1 = high;
  if (first > last) *x1 = *x0 - 1;
}

/* Multiplies a row of tiles of one sub-light by the slab's transmittance. */
static void composite_row(const sublight_task *task, sublight *sublight, int y) {
  const sublights *all = task->sublights;
  const shadow_buffer *slab = task->slab;
  int y0, y1, first, last;
  sublight_tiles(sublight, 1, task->y0, task->y1, all->tiles_y, &first, &last);
  if (y < first || y > last) return;
  if (sublight->place.shifted) {
    size_t row = (size_t)y * (size_t)all->tiles_x;
    first = task->x0, last = task->x1;
    lit_range(task, sublight, y, &first, &last);
    task->functions->composite_row(&sublight->job, y, first, last, sublight->lit + row,
                                   sublight->touched + row);
    return;
  }
  sublight_tiles(sublight, 0, task->x0, task->x1, all->tiles_x, &first, &last);
  tiles_under((double)y * TILE, (double)sublight->place.scale[1], (double)sublight->place.shift[1],
              slab->tiles_y, &y0, &y1);
  for (int x = first; x <= last; x++) {
    size_t tile = (size_t)y * (size_t)all->tiles_x + (size_t)x;
    int x0, x1;
    if (sublight->lit[tile] == 0) continue;
    tiles_under((double)x * TILE, (double)sublight->place.scale[0], (double)sublight->place.shift[0],
                slab->tiles_x, &x0, &x1);
    if (any_present(&sublight->job, x0, x1, y0, y1) && task->functions->composite(&sublight->job, x, y))
      sublight->touched[tile] = 1;
  }
}

/* Marks tiles as dark if this part of a shared picture does not need them any more. Dark tiles are skipped,
 * and so are blocks of the slab that only dark tiles of sub-lights would read. */
static void forget_tiles(const sublight_task *task, sublight *sublight, int y) {
  const sublights *all = task->sublights;
  const size_t tiles_x = (size_t)all->tiles_x, row = (size_t)y * tiles_x;
  const int32_t *until = task->needed_until +
                         (size_t)(sublight - all->sublight) * tiles_x * (size_t)all->tiles_y + row;
  for (size_t x = 0; x < tiles_x; x++)
    if (until[x] < task->slab_after) sublight->lit[row + x] = 0;
}

/* Finds the lit blocks of a sub-light again, in the tiles of a row in which light was absorbed. */
static void find_sublight_lit(const sublight_task *task, sublight *sublight, int y) {
  int tiles_x = task->sublights->tiles_x;
  size_t row = (size_t)y * (size_t)tiles_x;
  for (int x = 0; x < tiles_x; x++) {
    if (!sublight->touched[row + (size_t)x]) continue;
    sublight->touched[row + (size_t)x] = 0;
    sublight->lit[row + (size_t)x] = (uint16_t)task->functions->lit(&sublight->job, x, y,
                                                                    sublight->lit[row + (size_t)x]);
  }
}

static void advance_row(void *data, size_t index, int worker) {
  (void)worker;
  const sublight_task *task = data;
  const sublights *all = task->sublights;
  sublight *sublight =
      &all->sublight[index % (size_t)all->count]; /* consecutive tasks handle all sub-lights for one row of
                                                   * tiles, then all sub-lights for the next row, so that the
                                                   * slab's pixels for a row stay in the cache */
  int y = (int)(index / (size_t)all->count);
  if (task->ends_run && task->needed_until != NULL) forget_tiles(task, sublight, y);
  if (!sublight->reaches) return;
  if (task->x1 >= 0) composite_row(task, sublight, y);
  if (task->ends_run) find_sublight_lit(task, sublight, y);
}

/* ---- the slab ---- */

/* Fills rows of a tile with ones. of_copies: its lowest sixteen bits stand for the tile's rows; rows whose
 * bit is 1 are filled. */
static void fill_ones(float *pixels, size_t stride, slab_rows of_copies) {
  for (uint32_t rows = of_copies & ((1u << TILE) - 1); rows != 0; rows &= rows - 1)
    for (size_t i = 0, row = (size_t)__builtin_ctz(rows); i < TILE; i++) pixels[row * stride + i] = 1;
}

/* Fills one row of tiles of the shifted copies of the slab. A tile of a copy also depends on pixels of the
 * neighbouring tiles. */
static void move_row(void *data, size_t index, int worker) {
  (void)worker;
  const sublight_task *task = data;
  const sublights *all = task->sublights;
  const shadow_buffer *slab = task->slab;
  int y = (int)index, y1 = y + 1 < slab->tiles_y ? y + 1 : y;
  for (int x = 0; x < slab->tiles_x; x++) {
    int x1 = x + 1 < slab->tiles_x ? x + 1 : x;
    if (!any_touched(slab, x, x1, y, y1)) continue;
    for (int k = 0; k < all->kinds; k++)
      for (int c = 0; c < all->channels; c++) {
        const shadow_plane kind = k == 0 ? SHADOW_TRANSMITTANCE : SHADOW_OUTSIDE;
        half_pixel_job job = {.slab = slab_copy(all, slab, kind, c, 0), .slab_stride = slab->stride};
        for (int i = 1; i < SLAB_COPIES; i++) job.moved[i] = slab_copy(all, slab, kind, c, i);
        all->rows[index * (size_t)slab->tiles_x + (size_t)x] |= task->functions->half_pixel(&job, x, y);
      }
  }
}

/* Fills a row of the slab's tiles with ones again, so that the next slab can be written into these tiles. */
static void clear_row(void *data, size_t index, int worker) {
  (void)worker;
  const sublight_task *task = data;
  const sublights *all = task->sublights;
  shadow_buffer *slab = task->slab;
  for (int x = 0; x < slab->tiles_x; x++) {
    size_t tile = index * (size_t)slab->tiles_x + (size_t)x,
           at = index * TILE * slab->stride + (size_t)x * TILE;
    for (int c = 0; c < slab->channels; c++)
      for (int i = 0; i < SLAB_COPIES; i++) {
        const slab_rows rows = all->rows[tile] >> TILE * i;
        fill_ones(slab_copy(all, slab, SHADOW_TRANSMITTANCE, c, i) + at, slab->stride, rows);
        if (all->kinds > 1) fill_ones(slab_copy(all, slab, SHADOW_OUTSIDE, c, i) + at, slab->stride, rows);
      }
    all->rows[tile] = 0;
    slab->tile_touched[tile] = 0;
  }
}

static sublight_map map_of_place(const sublight_place *place) {
  return (sublight_map){{1 / place->scale[0], 1 / place->scale[1]}, {place->shift[0], place->shift[1]}};
}

sublight_maps hl_sublight_maps(const view *sublight, const view *slab, vec3 normal, double height,
                               double spacing) {
  sublight_maps maps = {0};
  sublight_place place;
  const bool far = hl_sublight_place(sublight, slab, normal, height + (LIT_SLABS - 0.5) * spacing, &place);
  if (far) maps.far = map_of_place(&place);
  maps.reaches = hl_sublight_place(sublight, slab, normal, height + 0.5 * spacing, &place);
  if (maps.reaches) maps.near = map_of_place(&place);
  maps.comes = far && !maps.reaches;
  return maps;
}

/* Sets the sub-lights' maps for the first and the last slab of the next run. height: the height at which the
 * run begins. */
static void map_run(sublights *sublights, const shadow_buffer *slab, vec3 normal, double height,
                    double spacing) {
  for (int i = 0; i < sublights->count; i++) {
    sublight *sublight = &sublights->sublight[i];
    sublight->maps = hl_sublight_maps(&sublight->view, &slab->view, normal, height, spacing);
  }
}

static void advance_sublights(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  (void)occupancy;
  const sheet_stack *sheets = shadow->setup.sheets;
  double from = hl_sheet_height(sheets, sheet - 1), to = hl_sheet_height(sheets, sheet);
  sublights *sublights = shadow->state;
  shadow_buffer *slab = shadow->buffer;
  hl_pool *pool = shadow->means.pool;
  for (int i = 0; i < sublights->count; i++)
    map_sublight(sublights, &sublights->sublight[i], slab, sheets->normal, (from + to) / 2);
  sublight_task task = {.sublights = sublights,
                        .slab = slab,
                        .functions = shadow->means.functions->sublights,
                        .needed_until = shadow->sublights_until,
                        .slab_after = sheet + 1};
  hl_pool_run(pool, (size_t)slab->tiles_y, move_row, &task);
  int run = hl_sublight_run(sublights->slabs++);
  task.ends_run = hl_sublight_run(sublights->slabs) != run;
  bound_present(&task);
  if (task.x1 >= 0 || task.ends_run)
    hl_pool_run(pool, (size_t)sublights->count * (size_t)sublights->tiles_y, advance_row, &task);
  hl_pool_run(pool, (size_t)slab->tiles_y, clear_row, &task);
  if (task.ends_run) map_run(sublights, slab, sheets->normal, to, to - from);
}

/* The offset of a tile's first pixel in a plane of the slab. */
static size_t first_pixel_of_tile(const shadow_buffer *slab, size_t tile) {
  const size_t tiles_x = (size_t)slab->tiles_x;
  return tile / tiles_x * TILE * slab->stride + tile % tiles_x * TILE;
}

/* Prepares a tile so that the next slab also attenuates the planes SHADOW_SECOND. The slab's transmittance
 * begins at 1 in each slab; the planes SHADOW_SECOND keep the fraction of light that is left on the way from
 * the light's centre. */
static void before_tile(const light_shadow *shadow, size_t tile, attenuate_job *job) {
  const shadow_buffer *slab = shadow->buffer;
  if (!slab->has_second) return;
  const size_t at = first_pixel_of_tile(slab, tile);
  for (int c = 0; c < job->channels; c++) job->older[c] = slab->second[c] + at;
  job->left = job->older[0];
}

/* ---- the method ---- */

static const double SUBLIGHT_PIXEL_PER_IMAGE_PIXEL = 1.5;

static void plan_sublights(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  shadow_plan *plan = &shadow->plan;
  hl_plan_soft(shadow, fmin(SUBLIGHT_PIXEL_PER_IMAGE_PIXEL * setup->middle_pixel,
                            hl_shadow_pixel(setup, plan->cubic)));
  plan->extent.u = plan->seen.u;
  plan->reach = SUBLIGHT_REACH;
  plan->second = plan->outside && setup->inner_corners;
  hl_shadow_view(setup->source, setup->sheets->normal, &plan->extent, &plan->view);
  sublights *all = shadow->state;
  int side = setup->settings->light_samples;
  all->count = side * side;
  all->channels = setup->channels;
  all->kinds = plan->outside ? 2 : 1;
  find_tiles(shadow, all);
  shadow->sublight_count = all->count;
  shadow->sublight_tiles_x = all->tiles_x;
  shadow->sublight_tiles_y = all->tiles_y;
  lay_out_planes(all);
}

static hl_status check_sublights(const light_shadow *shadow, hl_error *error) {
  const sublights *all = shadow->state;
  double bytes = (double)all->count * (double)planes_of_sublight(all) * (double)all->plane *
                 sizeof(sublight_pixel);
  if (bytes <= GREATEST_BYTES) return HL_OK;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "/render/light_samples: %d sub-lights need %.1f GB of shadow buffers, more than "
                 "4.3: use fewer, or a lower shadow_resolution",
                 all->count, bytes / 1e9);
}

/* Blocks in which some light from the light's centre is left count as lit, too, so that every part of a
 * shared picture knows this light, whatever sub-lights the part needs. */
static void find_lit(light_shadow *shadow, size_t tile) {
  shadow_buffer *slab = shadow->buffer;
  hl_sublights_find_lit(shadow->state, slab, tile);
  if (!slab->has_second) return;
  const size_t at = first_pixel_of_tile(slab, tile);
  const float *left[HL_CHANNELS] = {NULL};
  for (int c = 0; c < slab->channels; c++) left[c] = slab->second[c] + at;
  slab->tile_lit[tile] |= (uint16_t)shadow->means.functions->lit_blocks(left, slab->channels, slab->stride);
}

const shadow_method hl_shadow_sublights = {.name = "sublights",
                                           .state_bytes = sizeof(sublights),
                                           .surface_delay = 1.75,
                                           .surface_rise = 1.25,
                                           .first_slab = 1,
                                           .divides = true,
                                           .plan = plan_sublights,
                                           .check = check_sublights,
                                           .lay_out = lay_out_sublights,
                                           .begin = begin_sublights,
                                           .find_lit = find_lit,
                                           .before_tile = before_tile,
                                           .advance = advance_sublights};
