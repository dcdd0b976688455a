/* shadow_paper/paper.c - the convolution of the accumulated shadow buffer. */
#include "shadow_paper/paper.h"

#include "light/light_extent.h"

#include <string.h>

/* The virtual light is the orthogonal projection of the real one onto a plane parallel to the sheets
 * (section 5.2, (1)), of average size (section 5.2, (3)): a disk of diameter L tilted by t becomes an ellipse
 * with axes L and L cos t. Z is measured along the sheets' normal; for parallel light L / Z then is (L / D) /
 * cos t with L / D = 2 tan(angle / 2) along the ray (derived). */
void hl_soft_paper_begin(soft_paper *soft, const light_source *source, vec3 normal, double first,
                         const view *view, light_image *image) {
  double tilt = fmax(vec3_dot(source->direction, normal), 1e-3);
  soft->parallel = source->parallel;
  soft->size = hl_light_average_size(source, normal);
  if (image != NULL) hl_light_image_project(source, view, soft->size, image);
  soft->image = image;
  if (source->parallel) soft->size /= tilt;
  soft->light_height = vec3_dot(source->position, normal);
  soft->pixel = vec3_length(view->du);
  soft->last = first;
  soft->remainder = 0;
}

/* eq. (5): dx = L dZ / Z; seen from the light's centre at distance 1, dx / (Z + dZ) = L (1/Z - 1/(Z +
 * dZ)). */
double hl_soft_paper_width(const soft_paper *soft, double from, double to) {
  if (soft->parallel) return soft->size * (to - from) / soft->pixel;
  double near = from - soft->light_height, far = to - soft->light_height;
  if (near <= 0 || far <= near) return 0;
  return soft->size * (1 / near - 1 / far) / soft->pixel;
}

/* The first convolution comes after two sheets. */
int hl_soft_paper_reach(soft_paper *soft, double first, double spacing, int sheets) {
  double widest = hl_soft_paper_width(soft, first, first + 2 * spacing);
  for (int k = 1; k < sheets; k++)
    widest = fmax(widest, hl_soft_paper_width(soft, first + k * spacing, first + (k + 1) * spacing));
  soft->reach = (int)fmin(soft->image != NULL ? soft->image->reach * (widest + 2) + 3 : widest / 2 + 3, 1024);
  return soft->reach;
}

/* One convolution: from the buffer to the scratch and back, tile by tile, all channels of a tile in one
 * go. */
typedef struct convolution {
  shadow_buffer *buffer;
  const unsigned char *wanted; /* [tiles] */
  const blur_functions *blur;
  blur_box box;
  /* the taps of an image in place of a box's rows and columns */
  int count;
  const ptrdiff_t *offset; /* [count] */
  const image_taps *taps;
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

static void weigh_image(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < buffer->tiles_x; x++)
    for (int c = 0; c < buffer->channels && task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]; c++) {
      const image_job job = {.from = buffer->transmittance[c],
                             .to = buffer->second[c],
                             .stride = buffer->stride,
                             .count = task->count,
                             .offset = task->offset,
                             .weight = task->taps->weight[c]};
      task->blur->image(&job, x, (int)index);
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

static void convolve_with_image(const soft_paper *soft, convolution *task, int width, hl_pool *pool) {
  image_taps taps;
  ptrdiff_t offset[IMAGE_TAPS];
  const int step[2] = {1, 1};
  hl_light_image_taps(soft->image, width, step, (const double[2]){0, 0}, &taps);
  for (int i = 0; i < taps.count; i++)
    offset[i] = (ptrdiff_t)taps.y[i] * (ptrdiff_t)task->buffer->stride + taps.x[i];
  task->count = taps.count;
  task->offset = offset;
  task->taps = &taps;
  hl_pool_run(pool, (size_t)task->buffer->tiles_y, weigh_image, task);
  hl_pool_run(pool, (size_t)task->buffer->tiles_y, copy_back, task);
}

/* Tiles within reach of one that light was taken from. */
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

/* Only the tiles that can change. Tiles outside hold 1 in the buffer and in the scratch. */
static void convolve(const soft_paper *soft, shadow_buffer *buffer, int width, hl_pool *pool,
                     const blur_functions *blur) {
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  unsigned char *touched = buffer->tile_touched, *spread = touched + tiles;
  blur_box box = hl_blur_box((float)width);
  int reach = soft->image == NULL ? box.reach : (int)(soft->image->reach * width) + 2;
  spread_touched(buffer, (reach + TILE) / TILE, touched, spread);
  convolution task = {.buffer = buffer, .wanted = spread, .blur = blur, .box = box};
  if (soft->image != NULL) {
    convolve_with_image(soft, &task, width, pool);
  } else {
    hl_pool_run(pool, (size_t)buffer->tiles_y, blur_rows, &task);
    hl_pool_run(pool, (size_t)buffer->tiles_y, blur_columns, &task);
  }
  memcpy(touched, spread, tiles);
}

/* Section 5.2, (2): accumulate dx until it exceeds two pixels, convolve by its integer part, carry the rest.
 * An image has one tap a pixel and no more of them than cells: wider steps are several. */
void hl_soft_paper_convolve(soft_paper *soft, shadow_buffer *buffer, double next, hl_pool *pool,
                            const blur_functions *blur) {
  double width = soft->remainder + hl_soft_paper_width(soft, soft->last, next);
  double most = soft->image == NULL ? 2 * soft->reach
                                    : IMAGE_SIDE; /* no box reads beyond the buffer's margin */
  if (width <= 2) return;
  do {
    double whole = fmin(floor(width), most);
    convolve(soft, buffer, (int)whole, pool, blur);
    width -= whole;
  } while (width > 2 && soft->image != NULL);
  soft->remainder = width;
  soft->last = next;
}
