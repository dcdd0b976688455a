/* shadow_paper/paper.c - the paper's soft shadows (sections 5.1 and 5.2), unchanged, as the baseline.
 *
 * One buffer is convolved again and again with a box, or with the light's emission image, of the width that
 * eq. (5) gives for the step from the last convolved sheet to the next one. Convolution adds variances, not
 * widths, so penumbrae grow with the square root of the distance: this is the error that the other methods
 * avoid. */
#include <string.h>

#include "light/light_extent.h"
#include "shadow/blur.h"
#include "shadow/shadow_method.h"

typedef struct soft_paper {
  const light_emission *emission; /* null: boxes */
  bool parallel;
  double size;         /* L of the virtual light; parallel: L / Z */
  double light_height; /* of the light along the sheets' normal (not parallel) */
  double pixel;        /* buffer pixel: frame units; not parallel: at distance 1 */
  double last;         /* height of the last convolved sheet */
  double remainder;    /* accumulated width not yet convolved, pixels */
  int reach;           /* pixels beyond a tile that blurs may read: the buffer's margin is as wide */
} soft_paper;

/* The virtual light is the orthogonal projection of the real one onto a plane parallel to the sheets
 * (section 5.2, (1)), of average size (section 5.2, (3)): a disk of diameter L tilted by t becomes an ellipse
 * with axes L and L cos t. Z is measured along the sheets' normal; for parallel light L / Z then is (L / D) /
 * cos t with L / D = 2 tan(angle / 2) along the ray (derived). */
static void see_light(soft_paper *soft, const shadow_setup *setup, const view *view) {
  const light_source *source = setup->source;
  vec3 normal = setup->sheets->normal;
  double tilt = fmax(vec3_dot(source->direction, normal), 1e-3);
  soft->parallel = source->parallel;
  soft->size = hl_light_average_size(source, normal);
  if (setup->emission != NULL) hl_light_emission_project(source, view, soft->size, setup->emission);
  soft->emission = setup->emission;
  if (source->parallel) soft->size /= tilt;
  soft->light_height = vec3_dot(source->position, normal);
  soft->pixel = vec3_length(view->du);
  soft->last = setup->sheets->first;
  soft->remainder = 0;
}

/* eq. (5): dx = L dZ / Z; seen from the light's centre at distance 1, dx / (Z + dZ) = L (1/Z - 1/(Z +
 * dZ)). */
static double width_between(const soft_paper *soft, double from, double to) {
  if (soft->parallel) return soft->size * (to - from) / soft->pixel;
  double near = from - soft->light_height, far = to - soft->light_height;
  if (near <= 0 || far <= near) return 0;
  return soft->size * (1 / near - 1 / far) / soft->pixel;
}

/* The widest box that the sheets of a sweep can need, pixels. The first convolution comes after two sheets.
 */
static int widest_reach(const soft_paper *soft, const sheet_stack *sheets) {
  double first = sheets->first, spacing = sheets->spacing;
  double widest = width_between(soft, first, first + 2 * spacing);
  for (int k = 1; k < sheets->count; k++)
    widest = fmax(widest, width_between(soft, first + k * spacing, first + (k + 1) * spacing));
  return (int)fmin(soft->emission != NULL ? soft->emission->reach * (widest + 2) + 3 : widest / 2 + 3, 1024);
}

/* One convolution: from the buffer to its second planes and back, tile by tile, all channels of a tile at
 * once. */
typedef struct convolution {
  shadow_buffer *buffer;
  const unsigned char *wanted; /* [tiles] */
  const blur_functions *blur;
  blur_box box;
  /* with an emission image, instead of the box: */
  int count;
  const ptrdiff_t *offset; /* [count] */
  const emission_taps *taps;
} convolution;

static void blur_rows(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < buffer->tiles_x; x++)
    for (int c = 0; c < buffer->channels && task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]; c++) {
      const blur_job job = {buffer->transmittance[c], buffer->second[c], buffer->stride, buffer->stride,
                            task->box};
      task->blur->rows(&job, x, (int)index);
    }
}

static void blur_columns(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < buffer->tiles_x; x++) {
    if (!task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]) continue;
    for (int c = 0; c < buffer->channels; c++) {
      const blur_job job = {buffer->second[c], buffer->transmittance[c], buffer->stride, buffer->stride,
                            task->box};
      task->blur->columns(&job, x, (int)index);
    }
    hl_shadow_buffer_find_lit(buffer, x, (int)index, false, task->blur->lit_blocks);
  }
}

static void weigh_emission(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < buffer->tiles_x; x++)
    for (int c = 0; c < buffer->channels && task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]; c++) {
      const emission_job job = {.from = buffer->transmittance[c],
                                .to = buffer->second[c],
                                .stride = buffer->stride,
                                .count = task->count,
                                .offset = task->offset,
                                .weight = task->taps->weight[c]};
      task->blur->emission(&job, x, (int)index);
    }
}

static void copy_back(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < buffer->tiles_x; x++) {
    if (!task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]) continue;
    for (int c = 0; c < buffer->channels; c++)
      for (size_t row = 0; row < TILE; row++) {
        size_t at = (index * TILE + row) * buffer->stride + (size_t)x * TILE;
        memcpy(buffer->transmittance[c] + at, buffer->second[c] + at, TILE * sizeof(float));
      }
    hl_shadow_buffer_find_lit(buffer, x, (int)index, false, task->blur->lit_blocks);
  }
}

static void convolve_with_emission(const soft_paper *soft, convolution *task, int width, hl_pool *pool) {
  emission_taps taps;
  ptrdiff_t offset[EMISSION_TAPS];
  const int step[2] = {1, 1};
  hl_light_emission_taps(soft->emission, width, step, (const double[2]){0, 0}, &taps);
  for (int i = 0; i < taps.count; i++)
    offset[i] = (ptrdiff_t)taps.y[i] * (ptrdiff_t)task->buffer->stride + taps.x[i];
  task->count = taps.count;
  task->offset = offset;
  task->taps = &taps;
  hl_pool_run(pool, (size_t)task->buffer->tiles_y, weigh_emission, task);
  hl_pool_run(pool, (size_t)task->buffer->tiles_y, copy_back, task);
}

/* Marks the tiles within reach of a touched one. */
static void spread_touched(const shadow_buffer *buffer, int reach_tiles, const unsigned char *from,
                           unsigned char *to) {
  for (int y = 0; y < buffer->tiles_y; y++)
    for (int x = 0; x < buffer->tiles_x; x++) {
      unsigned char found = 0;
      for (int j = y - reach_tiles; j <= y + reach_tiles && !found; j++)
        for (int i = x - reach_tiles; i <= x + reach_tiles && !found; i++)
          if (i >= 0 && j >= 0 && i < buffer->tiles_x && j < buffer->tiles_y)
            found = from[(size_t)j * (size_t)buffer->tiles_x + (size_t)i];
      to[(size_t)y * (size_t)buffer->tiles_x + (size_t)x] = found;
    }
}

/* Convolves the tiles that can change. All others hold 1 in the buffer and in its second planes. */
static void convolve(const soft_paper *soft, shadow_buffer *buffer, int width, hl_pool *pool,
                     const blur_functions *blur) {
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  unsigned char *touched = buffer->tile_touched, *spread = touched + tiles;
  blur_box box = hl_blur_box((float)width);
  int reach = soft->emission == NULL ? box.reach : (int)(soft->emission->reach * width) + 2;
  spread_touched(buffer, (reach + TILE) / TILE, touched, spread);
  convolution task = {.buffer = buffer, .wanted = spread, .blur = blur, .box = box};
  if (soft->emission != NULL) {
    convolve_with_emission(soft, &task, width, pool);
  } else {
    hl_pool_run(pool, (size_t)buffer->tiles_y, blur_rows, &task);
    hl_pool_run(pool, (size_t)buffer->tiles_y, blur_columns, &task);
  }
  memcpy(touched, spread, tiles);
}

/* Section 5.2, (2): accumulates dx until it exceeds two pixels, convolves by its integer part and carries the
 * rest. An emission image has one tap per pixel and no more taps than cells: wider steps take several
 * convolutions. */
static void advance_paper(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  (void)occupancy;
  soft_paper *soft = shadow->state;
  double next = hl_sheet_height(shadow->setup.sheets, sheet + 1);
  double width = soft->remainder + width_between(soft, soft->last, next);
  double most = soft->emission == NULL ? 2 * soft->reach
                                       : EMISSION_SIDE; /* no box reads beyond the buffer's margin */
  if (width <= 2) return;
  do {
    double whole = fmin(floor(width), most);
    convolve(soft, shadow->buffer, (int)whole, shadow->setup.pool, &shadow->setup.functions->blur);
    width -= whole;
  } while (width > 2 && soft->emission != NULL);
  soft->remainder = width;
  soft->last = next;
}

static void plan_paper(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  const sheet_stack *sheets = setup->sheets;
  shadow_plan *plan = &shadow->plan;
  soft_paper *soft = shadow->state;
  plan->cubic = setup->settings->shadow_lookup == HL_LOOKUP_CUBIC;
  plan->second = true; /* between two blurs */
  hl_plan_soft(shadow, hl_blurred_pixel(setup, plan->cubic));
  hl_shadow_view(setup->source, sheets->normal, &plan->extent, &plan->view);
  see_light(soft, setup, &plan->view);
  plan->reach = soft->reach = widest_reach(soft, sheets);
}

const shadow_method hl_shadow_paper = {.name = "paper",
                                       .state_bytes = sizeof(soft_paper),
                                       .first_slab = 1,
                                       .plan = plan_paper,
                                       .advance = advance_paper};
