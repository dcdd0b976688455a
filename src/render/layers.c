/* render/layers.c - keeps the pixels of the layers, and writes them to the caller's buffers (layers.h). */
#include "render/layers.h"

#include <math.h>

#include "core/memory.h"

hl_light_layers hl_layers_of_light(const hl_layers *wanted, const light_source *light) {
  if (light->of_sky > 0) return (hl_light_layers){wanted->sky, wanted->sky_shadow};
  return wanted->light_count > 0 ? wanted->lights[light->light_index] : (hl_light_layers){NULL, NULL};
}

/* ---- pixels ---- */

static float *take_pixels(hl_layout *layout, bool wanted, size_t tiles, size_t floats) {
  return wanted ? hl_layout_take(layout, tiles * TILE_PIXELS, floats * sizeof(float)) : NULL;
}

static void lay_out_light(const hl_layers *wanted, const light_source *source, size_t tiles,
                          light_pixels *light, hl_layout *layout) {
  const hl_light_layers asked = hl_layers_of_light(wanted, source);
  const bool of_sky = source->of_sky > 0, shadow = asked.shadow != NULL;
  *light = (light_pixels){.light_index = (size_t)source->light_index, .of_sky = of_sky};
  light->picture = take_pixels(layout, asked.picture != NULL, tiles, COLORS);
  light->shadow = take_pixels(layout, shadow && !of_sky, tiles, COLORS);
  light->reaching = take_pixels(layout, shadow && of_sky, tiles, COLORS);
  light->open = take_pixels(layout, shadow && of_sky, tiles, COLORS);
}

/* Lays out the arrays of pixels of the wanted layers. The array of lights is null if an estimate only counts
 * bytes. */
static void lay_out(const frame *frame, size_t tiles, layer_pixels *pixels, hl_layout *layout) {
  const hl_layers *wanted = pixels->wanted;
  pixels->ambient = take_pixels(layout, wanted->ambient != NULL, tiles, COLORS);
  pixels->emission = take_pixels(layout, wanted->emission != NULL, tiles, COLORS);
  pixels->sky = take_pixels(layout, wanted->sky != NULL, tiles, COLORS);
  pixels->sky_reaching = take_pixels(layout, wanted->sky_shadow != NULL, tiles, COLORS);
  pixels->sky_open = take_pixels(layout, wanted->sky_shadow != NULL, tiles, COLORS);
  pixels->measures = take_pixels(layout, hl_layers_measure(wanted), tiles, MEASURES);
  for (size_t i = 0; i < pixels->light_count; i++) {
    light_pixels counted;
    lay_out_light(wanted, &frame->lights[i], tiles, pixels->lights != NULL ? &pixels->lights[i] : &counted,
                  layout);
  }
}

void hl_layer_pixels_count(const hl_layers *wanted, const frame *frame, size_t tiles, hl_layout *layout) {
  layer_pixels pixels = {.wanted = wanted, .light_count = (size_t)frame->light_count};
  if (wanted == NULL) return;
  hl_layout_take(layout, pixels.light_count, sizeof *pixels.lights);
  lay_out(frame, tiles, &pixels, layout);
}

hl_status hl_layer_pixels_create(hl_context *context, hl_pool *pool, const hl_layers *wanted,
                                 const frame *frame, size_t tiles, layer_pixels *pixels, hl_error *error) {
  *pixels = (layer_pixels){.wanted = wanted, .light_count = (size_t)frame->light_count};
  if (wanted == NULL) return HL_OK;
  hl_layout layout = {0};
  pixels->lights = hl_allocate_zeroed(context, pixels->light_count, sizeof *pixels->lights);
  if (pixels->lights == NULL)
    return hl_fail_memory(error, pixels->light_count * sizeof *pixels->lights, "the lights' layers");
  while (hl_layout_pass(&layout, context)) lay_out(frame, tiles, pixels, &layout);
  pixels->memory = layout.base;
  if (pixels->memory == NULL) return hl_fail_memory(error, layout.bytes, "the layers");
  hl_pool_clear(pool, pixels->memory, layout.bytes);
  return HL_OK;
}

void hl_layer_pixels_release(hl_context *context, layer_pixels *pixels) {
  hl_release(context, pixels->lights);
  hl_release(context, pixels->memory);
}

/* ---- the caller's buffers ---- */

/* The address of one value of one of the frame's pixels. */
static const float *value_at(const layer_grid *grid, const float *pixels, int floats, int column, int row,
                             int value) {
  return pixels + hl_place_in_tiles(grid->tiles_x, floats, column, row) + (size_t)value * BLOCK_PIXELS;
}

/* The sum of one value over the pixels of the frame that make up one pixel of the picture. */
static float sum_of(const layer_grid *grid, const float *pixels, int floats, int column, int row, int value) {
  int side = grid->oversampling;
  float sum = 0;
  for (int y = row * side; y < (row + 1) * side; y++)
    for (int x = column * side; x < (column + 1) * side; x++)
      sum += *value_at(grid, pixels, floats, x, y, value);
  return sum;
}

/* Writes three channels of a row. divide: whether the colours are divided by alpha, with 0 in place of the
 * quotient if alpha is 0; otherwise they stay premultiplied. add: whether the colours are added to the
 * numbers in `to`. */
static void write_colors(const layer_grid *grid, int row, const float *pixels, bool divide, bool add,
                         float *to) {
  float area = (float)(grid->oversampling * grid->oversampling);
  to += 3 * (size_t)row * (size_t)grid->width;
  for (int column = 0; column < grid->width; column++) {
    float alpha = divide ? sum_of(grid, pixels, COLORS, column, row, 3) : area;
    for (int c = 0; c < 3; c++, to++) {
      *to = (add ? *to : 0) + (alpha > 0 ? sum_of(grid, pixels, COLORS, column, row, c) / alpha : 0);
      /* Each sector of a light is divided by the alpha of its own sweep. So the sum over sectors may exceed
       * 1. */
      if (divide && *to > 1) *to = 1;
    }
  }
}

/* Writes three channels of a row: the sky's light that arrives, divided by the light of an unhidden sky. The
 * field has few directions, so that the light that arrives may exceed the light of an unhidden sky by
 * rounding. */
static void write_sky_shadow(const layer_grid *grid, int row, const layer_pixels *pixels, float *to) {
  to += 3 * (size_t)row * (size_t)grid->width;
  for (int column = 0; column < grid->width; column++)
    for (int c = 0; c < 3; c++, to++) {
      float open = sum_of(grid, pixels->sky_open, COLORS, column, row, c),
            reaching = sum_of(grid, pixels->sky_reaching, COLORS, column, row, c);
      for (size_t i = 0; i < pixels->light_count; i++) {
        if (!pixels->lights[i].of_sky) continue;
        open += sum_of(grid, pixels->lights[i].open, COLORS, column, row, c);
        reaching += sum_of(grid, pixels->lights[i].reaching, COLORS, column, row, c);
      }
      *to = open > 0 ? reaching < open ? reaching / open : 1 : 0;
    }
}

/* Whether the alpha of one of the frame's pixels reaches FIRST_OPACITY. If not, its first depth and its
 * object belong to a faint mesh, and do not count. */
static bool is_seen(const layer_grid *grid, const float *pixels, int column, int row) {
  return *value_at(grid, pixels, MEASURES, column, row, MEASURE_ALPHA) >= FIRST_OPACITY;
}

static float object_at(const layer_grid *grid, const float *pixels, int column, int row) {
  return is_seen(grid, pixels, column, row) ? *value_at(grid, pixels, MEASURES, column, row, MEASURE_OBJECT)
                                            : 0;
}

/* The object that most pixels of the frame within one pixel of the picture show. Pixels without an object do
 * not count. If several objects show in equally many pixels, the object with the least number is chosen. */
static float object_of(const layer_grid *grid, const float *pixels, int column, int row) {
  int side = grid->oversampling, most = 0;
  float object = 0;
  for (int i = 0; i < side * side; i++) {
    float one = object_at(grid, pixels, column * side + i % side, row * side + i / side);
    int count = 0;
    for (int k = 0; k < side * side; k++)
      count += object_at(grid, pixels, column * side + k % side, row * side + k / side) == one;
    if (one == 0 || count < most || (count == most && one > object)) continue;
    most = count;
    object = one;
  }
  return object;
}

/* The mean first depth of the frame's pixels within one pixel of the picture; infinite if none is seen. */
static float first_of(const layer_grid *grid, const float *pixels, int column, int row) {
  int side = grid->oversampling, count = 0;
  float sum = 0;
  for (int y = row * side; y < (row + 1) * side; y++)
    for (int x = column * side; x < (column + 1) * side; x++) {
      if (!is_seen(grid, pixels, x, y)) continue;
      sum += *value_at(grid, pixels, MEASURES, x, y, MEASURE_DEPTH_FIRST);
      count++;
    }
  return count > 0 ? sum / (float)count * grid->unit : INFINITY;
}

static void write_measures(const layer_grid *grid, int row, const float *pixels, const hl_layers *to) {
  for (int column = 0; column < grid->width; column++) {
    size_t at = (size_t)row * (size_t)grid->width + (size_t)column;
    float alpha = sum_of(grid, pixels, MEASURES, column, row, MEASURE_ALPHA);
    float depth = sum_of(grid, pixels, MEASURES, column, row, MEASURE_DEPTH);
    if (to->depth_first != NULL) to->depth_first[at] = first_of(grid, pixels, column, row);
    if (to->depth_mean != NULL) to->depth_mean[at] = alpha > 0 ? depth / alpha * grid->unit : INFINITY;
    if (to->object != NULL) to->object[at] = object_of(grid, pixels, column, row);
    for (int c = 0; c < 3 && to->normal != NULL; c++) {
      float normal = sum_of(grid, pixels, MEASURES, column, row, MEASURE_NORMAL + c);
      to->normal[3 * at + (size_t)c] = alpha > 0 ? normal / alpha : 0;
    }
  }
}

typedef struct write_job {
  const layer_pixels *pixels;
  const layer_grid *grid;
} write_job;

static void write_row(void *data, size_t index, int worker) {
  (void)worker;
  const write_job *job = data;
  const layer_pixels *pixels = job->pixels;
  const hl_layers *to = pixels->wanted;
  int row = (int)index;
  if (to->ambient != NULL) write_colors(job->grid, row, pixels->ambient, false, false, to->ambient);
  if (to->emission != NULL) write_colors(job->grid, row, pixels->emission, false, false, to->emission);
  if (to->sky != NULL) write_colors(job->grid, row, pixels->sky, false, false, to->sky);
  if (to->sky_shadow != NULL) write_sky_shadow(job->grid, row, pixels, to->sky_shadow);
  if (hl_layers_measure(to)) write_measures(job->grid, row, pixels->measures, to);
  for (size_t i = 0; i < pixels->light_count; i++) {
    const light_pixels *from = &pixels->lights[i];
    if (from->of_sky && to->sky != NULL) write_colors(job->grid, row, from->picture, false, true, to->sky);
    if (from->of_sky || to->light_count == 0) continue;
    const hl_light_layers *asked = &to->lights[from->light_index];
    bool add = i > 0 && from[-1].light_index == from->light_index; /* sectors of a light follow each other */
    if (asked->picture != NULL) write_colors(job->grid, row, from->picture, false, add, asked->picture);
    if (asked->shadow != NULL) write_colors(job->grid, row, from->shadow, true, add, asked->shadow);
  }
}

void hl_layer_pixels_write(const layer_pixels *pixels, const layer_grid *grid, hl_pool *pool) {
  write_job job = {pixels, grid};
  if (pixels->wanted != NULL) hl_pool_run(pool, (size_t)grid->height, write_row, &job);
}
