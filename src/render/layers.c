/* render/layers.c - see layers.h: the layers' pixels, their passes in a sweep, and the caller's buffers. */
#include "render/layers.h"

#include <math.h>

#include "core/memory.h"
#include "render/sweep.h"

enum { COLORS = 4 }; /* R G B A */

bool hl_layers_measure(const hl_layers *wanted) {
  return wanted != NULL &&
         (wanted->depth_first != NULL || wanted->depth_mean != NULL || wanted->normal != NULL);
}

/* ---- pixels ---- */

typedef struct pixel_room {
  hl_context *context;
  hl_pool *pool;
  size_t tiles;
} pixel_room;

static float *allocate_pixels(const pixel_room *room, size_t floats, hl_status *status, hl_error *error) {
  if (*status != HL_OK) return NULL;
  float *pixels = hl_allocate(room->context, room->tiles * TILE_PIXELS, floats * sizeof *pixels);
  if (pixels == NULL)
    *status = hl_fail_memory(error, room->tiles * TILE_PIXELS * floats * sizeof *pixels, "a layer");
  else hl_pool_clear(room->pool, pixels, room->tiles * TILE_PIXELS * floats * sizeof *pixels);
  return pixels;
}

/* Sets the first depth of all pixels to infinity: no ray has met anything yet. */
static void clear_first_depth(float *measures, size_t tiles) {
  for (size_t block = 0; block < tiles * TILE_BLOCKS; block++)
    for (int lane = 0; lane < BLOCK_PIXELS; lane++)
      measures[(block * MEASURES + MEASURE_DEPTH_FIRST) * BLOCK_PIXELS + (size_t)lane] = INFINITY;
}

hl_status hl_layer_pixels_create(hl_context *context, hl_pool *pool, const hl_layers *wanted,
                                 const frame *frame, size_t tiles, layer_pixels *pixels, hl_error *error) {
  *pixels = (layer_pixels){.wanted = wanted, .light_count = (size_t)frame->light_count};
  if (wanted == NULL) return HL_OK;
  hl_status status = HL_OK;
  const pixel_room room = {context, pool, tiles};
  pixels->lights = hl_allocate_zeroed(context, pixels->light_count, sizeof *pixels->lights);
  if (pixels->lights == NULL)
    return hl_fail_memory(error, pixels->light_count * sizeof *pixels->lights, "the lights' layers");
  if (wanted->ambient != NULL) pixels->ambient = allocate_pixels(&room, COLORS, &status, error);
  if (wanted->emission != NULL) pixels->emission = allocate_pixels(&room, COLORS, &status, error);
  if (hl_layers_measure(wanted)) pixels->measures = allocate_pixels(&room, MEASURES, &status, error);
  for (size_t i = 0; i < pixels->light_count && wanted->light_count > 0; i++) {
    const hl_light_layers *asked = &wanted->lights[frame->lights[i].light_index];
    pixels->lights[i].light_index = (size_t)frame->lights[i].light_index;
    if (asked->picture != NULL) pixels->lights[i].picture = allocate_pixels(&room, COLORS, &status, error);
    if (asked->shadow != NULL) pixels->lights[i].shadow = allocate_pixels(&room, COLORS, &status, error);
  }
  if (pixels->measures != NULL) clear_first_depth(pixels->measures, tiles);
  return status;
}

void hl_layer_pixels_release(hl_context *context, layer_pixels *pixels) {
  for (size_t i = 0; pixels->lights != NULL && i < pixels->light_count; i++) {
    hl_release(context, pixels->lights[i].picture);
    hl_release(context, pixels->lights[i].shadow);
  }
  hl_release(context, pixels->lights);
  hl_release(context, pixels->ambient);
  hl_release(context, pixels->emission);
  hl_release(context, pixels->measures);
}

/* ---- passes ---- */

/* Sets up copies of the volumes that are white media: their samples pass on all the light that arrives. */
static void set_up_white_volumes(sweep *sweep) {
  sweep_layers *layers = &sweep->layers;
  for (size_t i = 0; i < CLASSIFIER_ENTRIES + 2; i++)
    layers->ones[i][0] = layers->ones[i][1] = layers->ones[i][2] = 1;
  for (int g = 0; g < sweep->content.volume_count; g++) {
    layers->white[g] = sweep->content.volumes[g].classifier;
    layers->white[g].color = layers->ones;
    layers->white_volumes[g] = sweep->shade_volumes[g];
    layers->white_volumes[g].classifier = &layers->white[g];
    layers->white_volumes[g].phong = 0;
    layers->white_volumes[g].lit = 1;
  }
}

static void set_up_white_light(const shade_light *from, shade_light *white) {
  *white = *from;
  white->inverse_square = 0;
  white->texture = (light_texture){0};
  white->cone = (light_cone){.scale = 0};
  for (int c = 0; c < 3; c++) white->color[c] = 1;
}

static hl_status allocate_passes(sweep *sweep, hl_error *error) {
  hl_context *context = sweep->content.context;
  sweep_layers *layers = &sweep->layers;
  size_t lights = (size_t)sweep->geometry->light_count, volumes = (size_t)sweep->content.volume_count;
  layers->passes = hl_allocate_zeroed(context, 2 * lights + 3, sizeof *layers->passes);
  layers->white_lights = hl_allocate_zeroed(context, lights, sizeof *layers->white_lights);
  layers->white_volumes = hl_allocate_zeroed(context, volumes, sizeof *layers->white_volumes);
  layers->white_patches = hl_allocate(context, volumes * (size_t)hl_pool_threads(sweep->content.pool),
                                      sizeof *layers->white_patches);
  layers->white = hl_allocate_zeroed(context, volumes, sizeof *layers->white);
  layers->ones = hl_allocate(context, CLASSIFIER_ENTRIES + 2, sizeof *layers->ones);
  if (layers->passes == NULL || layers->white_lights == NULL || layers->white_volumes == NULL ||
      layers->white_patches == NULL || layers->white == NULL || layers->ones == NULL)
    return hl_fail_memory(error, (CLASSIFIER_ENTRIES + 2) * sizeof *layers->ones, "the layers");
  return HL_OK;
}

/* Adds a pass that shades the given lights, without ambient light and emission. Returns null where the layer
 * is not wanted. */
static layer_pass *add_pass(sweep *sweep, float *pixels, const shade_light *lights, int light_count) {
  if (pixels == NULL) return NULL;
  layer_pass *pass = &sweep->layers.passes[sweep->layers.pass_count++];
  *pass = (layer_pass){sweep->content.hot->render.shade, sweep->shade, false, pixels, COLORS * TILE_PIXELS};
  pass->job.lights = lights;
  pass->job.light_count = light_count;
  for (int c = 0; c < 3; c++) pass->job.ambient[c] = 0;
  pass->job.emission = 0;
  return pass;
}

hl_status hl_sweep_layers_begin(sweep *sweep, hl_error *error) {
  const layer_pixels *pixels = sweep->layer_pixels;
  if (pixels == NULL || pixels->wanted == NULL) return HL_OK;
  hl_status status = allocate_passes(sweep, error);
  if (status != HL_OK) return status;
  set_up_white_volumes(sweep);
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    const light_pixels *to = &pixels->lights[sweep->geometry->light[i]];
    shade_light *white = &sweep->layers.white_lights[i];
    (void)add_pass(sweep, to->picture, &sweep->shade_lights[i], 1);
    set_up_white_light(&sweep->shade_lights[i], white);
    layer_pass *shadow = add_pass(sweep, to->shadow, white, 1);
    if (shadow != NULL) shadow->white = true;
  }
  layer_pass *ambient = sweep->first ? add_pass(sweep, pixels->ambient, NULL, 0) : NULL;
  for (int c = 0; c < 3 && ambient != NULL; c++) ambient->job.ambient[c] = sweep->shade.ambient[c];
  layer_pass *emission = sweep->first ? add_pass(sweep, pixels->emission, NULL, 0) : NULL;
  if (emission != NULL) emission->job.emission = sweep->shade.emission;
  layer_pass *measures = sweep->measures ? add_pass(sweep, pixels->measures, NULL, 0) : NULL;
  if (measures != NULL) {
    measures->shade = sweep->content.hot->render.measure;
    measures->tile_floats = MEASURES * TILE_PIXELS;
  }
  return HL_OK;
}

void hl_sweep_layers_end(sweep *sweep) {
  sweep_layers *layers = &sweep->layers;
  void *owned[] = {layers->passes,        layers->white_lights, layers->white_volumes,
                   layers->white_patches, layers->white,        layers->ones};
  for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++) hl_release(sweep->content.context, owned[i]);
}

void hl_sweep_layers_sheet(sweep *sweep) {
  sweep_layers *layers = &sweep->layers;
  for (int i = 0; i < layers->pass_count; i++) {
    layers->passes[i].job.rays = sweep->shade.rays;
    layers->passes[i].job.height = sweep->shade.height;
  }
}

/* The tile's patches, of the white volumes. */
static const shade_patch *white_patches(const sweep *sweep, const tile_slab *slab) {
  shade_patch *white = sweep->layers.white_patches +
                       (size_t)slab->worker * (size_t)sweep->content.volume_count;
  for (int i = 0; i < slab->patch_count; i++) {
    white[i] = slab->patches[i];
    white[i].volume = &sweep->layers.white_volumes[slab->patches[i].volume - sweep->shade_volumes];
  }
  return white;
}

void hl_sweep_layers_tile(const sweep *sweep, const tile_slab *slab) {
  if (sweep->layers.pass_count == 0) return;
  tile_slab white = *slab;
  white.patches = white_patches(sweep, slab);
  for (int i = 0; i < sweep->layers.pass_count; i++) {
    const layer_pass *pass = &sweep->layers.passes[i];
    uint64_t samples = 0; /* statistics count the picture's own samples alone */
    (void)pass->shade(&pass->job, pass->white ? &white : slab, pass->pixels + slab->tile * pass->tile_floats,
                      &samples);
  }
}

/* ---- the caller's buffers ---- */

/* The address of one value of a pixel of the frame. */
static const float *value_at(const layer_grid *grid, const float *pixels, int floats, int column, int row,
                             int value) {
  size_t tile = (size_t)(row / TILE) * grid->tiles_x + (size_t)(column / TILE);
  size_t block = (size_t)(row % TILE / BLOCK * 4 + column % TILE / BLOCK);
  size_t lane = (size_t)(row % BLOCK * 4 + column % BLOCK);
  return pixels + ((tile * TILE_BLOCKS + block) * (size_t)floats + (size_t)value) * BLOCK_PIXELS + lane;
}

/* The sum of a value over the frame's pixels in one pixel of the picture; infinite values are left out.
 * count: is raised by the number of values added; may be null. */
static float sum_of(const layer_grid *grid, const float *pixels, int floats, int column, int row, int value,
                    int *count) {
  int side = grid->oversampling;
  float sum = 0;
  for (int y = row * side; y < (row + 1) * side; y++)
    for (int x = column * side; x < (column + 1) * side; x++) {
      float one = *value_at(grid, pixels, floats, x, y, value);
      if (!(one < INFINITY)) continue;
      sum += one;
      if (count != NULL) ++*count;
    }
  return sum;
}

/* Writes three channels of a row. divide: by alpha (0 where alpha is 0); otherwise they stay premultiplied.
 * add: to the numbers in `to`. */
static void write_colors(const layer_grid *grid, int row, const float *pixels, bool divide, bool add,
                         float *to) {
  float area = (float)(grid->oversampling * grid->oversampling);
  to += 3 * (size_t)row * (size_t)grid->width;
  for (int column = 0; column < grid->width; column++) {
    float alpha = divide ? sum_of(grid, pixels, COLORS, column, row, 3, NULL) : area;
    for (int c = 0; c < 3; c++, to++) {
      *to = (add ? *to : 0) + (alpha > 0 ? sum_of(grid, pixels, COLORS, column, row, c, NULL) / alpha : 0);
      /* each sector of a light is divided by its own sweep's alpha: their sum may exceed 1 */
      if (divide && *to > 1) *to = 1;
    }
  }
}

static void write_measures(const layer_grid *grid, int row, const float *pixels, const hl_layers *to) {
  for (int column = 0; column < grid->width; column++) {
    size_t at = (size_t)row * (size_t)grid->width + (size_t)column;
    int hits = 0;
    float first = sum_of(grid, pixels, MEASURES, column, row, MEASURE_DEPTH_FIRST, &hits);
    float alpha = sum_of(grid, pixels, MEASURES, column, row, MEASURE_ALPHA, NULL);
    float depth = sum_of(grid, pixels, MEASURES, column, row, MEASURE_DEPTH, NULL);
    if (to->depth_first != NULL) to->depth_first[at] = hits > 0 ? first / (float)hits * grid->unit : INFINITY;
    if (to->depth_mean != NULL) to->depth_mean[at] = alpha > 0 ? depth / alpha * grid->unit : INFINITY;
    for (int c = 0; c < 3 && to->normal != NULL; c++) {
      float normal = sum_of(grid, pixels, MEASURES, column, row, MEASURE_NORMAL + c, NULL);
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
  if (hl_layers_measure(to)) write_measures(job->grid, row, pixels->measures, to);
  for (size_t i = 0; i < pixels->light_count && to->light_count > 0; i++) {
    const light_pixels *from = &pixels->lights[i];
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
