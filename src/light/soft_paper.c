/* light/soft_paper.c - the convolution of the accumulated shadow buffer. */
#include "light/soft_paper.h"

#include "light/light_extent.h"

#include <string.h>

/* The virtual light is the orthogonal projection of the real one onto a plane parallel to the sheets (section 5.2,
 * (1)), of average size (section 5.2, (3)): a disk of diameter L tilted by t becomes an ellipse with axes L and L cos t.
 * Z is measured along the sheets' normal; for parallel light L / Z then is (L / D) / cos t with L / D = 2 tan(angle / 2)
 * along the ray (derived). */
void hl_soft_paper_begin(soft_paper *soft, const light_source *source, vec3 normal, double first, const view *view,
                         light_image *image) {
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

/* eq. (5): dx = L dZ / Z; seen from the light's centre at distance 1, dx / (Z + dZ) = L (1/Z - 1/(Z + dZ)). */
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

typedef struct convolve_job {
  shadow_buffer *buffer;
  blur_job blur;
  blur_tile_function *blur_tile;
  const unsigned char *wanted; /* [tiles] */
} convolve_job;

static void convolve_tile(void *data, size_t index, int worker) {
  (void)worker;
  const convolve_job *job = data;
  for (int x = 0; x < job->buffer->tiles_x; x++)
    if (job->wanted[index * (size_t)job->buffer->tiles_x + (size_t)x]) job->blur_tile(&job->blur, x, (int)index);
}

/* The taps of the image in place of a box's rows and columns, from the buffer to the scratch. */
typedef struct image_convolution {
  const shadow_buffer *buffer;
  const unsigned char *wanted; /* [tiles] */
  image_job job;
  image_tile_function *image_tile;
} image_convolution;

static void convolve_image_tile(void *data, size_t index, int worker) {
  (void)worker;
  const image_convolution *task = data;
  for (int x = 0; x < task->buffer->tiles_x; x++)
    if (task->wanted[index * (size_t)task->buffer->tiles_x + (size_t)x]) task->image_tile(&task->job, x, (int)index);
}

static void copy_back_tile(void *data, size_t index, int worker) {
  (void)worker;
  const image_convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  float *to = (float *)task->job.from;
  for (int x = 0; x < buffer->tiles_x; x++)
    for (size_t row = 0; row < TILE && task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]; row++) {
      size_t at = (index * TILE + row) * buffer->stride + (size_t)x * TILE;
      memcpy(to + at, task->job.to + at, TILE * sizeof(float));
    }
}

static void convolve_with_image(const soft_paper *soft, shadow_buffer *buffer, int width, const unsigned char *wanted,
                                hl_pool *pool, image_tile_function *image_tile) {
  image_taps taps;
  ptrdiff_t offset[IMAGE_TAPS];
  const int step[2] = {1, 1};
  hl_light_image_taps(soft->image, width, step, (const double[2]){0, 0}, &taps);
  for (int i = 0; i < taps.count; i++) offset[i] = (ptrdiff_t)taps.y[i] * (ptrdiff_t)buffer->stride + taps.x[i];
  for (int c = 0; c < buffer->channels; c++) {
    image_convolution task = {buffer, wanted, {.from = buffer->transmittance[c], .to = buffer->scratch[c],
                              .stride = buffer->stride, .count = taps.count, .offset = offset, .weight = taps.weight[c]},
                              image_tile};
    hl_pool_run(pool, (size_t)buffer->tiles_y, convolve_image_tile, &task);
    hl_pool_run(pool, (size_t)buffer->tiles_y, copy_back_tile, &task);
  }
}

/* Tiles within reach of one that light was taken from. */
static void spread_touched(const shadow_buffer *buffer, int reach_tiles, const unsigned char *from, unsigned char *to) {
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

/* Rows go from the buffer to the scratch, columns back. */
static void convolve_with_box(shadow_buffer *buffer, blur_box box, const unsigned char *wanted, hl_pool *pool,
                              const blur_functions *blur) {
  convolve_job job = {buffer, {NULL, NULL, buffer->stride, buffer->stride, box}, blur->rows, wanted};
  for (int c = 0; c < buffer->channels; c++) {
    job.blur.from = buffer->transmittance[c];
    job.blur.to = buffer->scratch[c];
    job.blur_tile = blur->rows;
    hl_pool_run(pool, (size_t)buffer->tiles_y, convolve_tile, &job);
    job.blur.from = buffer->scratch[c];
    job.blur.to = buffer->transmittance[c];
    job.blur_tile = blur->columns;
    hl_pool_run(pool, (size_t)buffer->tiles_y, convolve_tile, &job);
  }
}

/* Only the tiles that can change. Tiles outside hold 1 in the buffer and in the scratch. */
static void convolve(const soft_paper *soft, shadow_buffer *buffer, int width, hl_pool *pool, const blur_functions *blur) {
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  unsigned char *touched = buffer->tile_touched, *spread = touched + tiles;
  blur_box box = hl_blur_box((float)width);
  int reach = soft->image == NULL ? box.reach : (int)(soft->image->reach * width) + 2;
  spread_touched(buffer, (reach + TILE) / TILE, touched, spread);
  if (soft->image == NULL) convolve_with_box(buffer, box, spread, pool, blur);
  else convolve_with_image(soft, buffer, width, spread, pool, blur->image);
  memcpy(touched, spread, tiles);
  hl_shadow_buffer_find_lit(buffer, spread, pool, blur->lit_blocks);
}

/* Section 5.2, (2): accumulate dx until it exceeds two pixels, convolve by its integer part, carry the rest. An image has
 * one tap a pixel and no more of them than cells: wider steps are several. */
void hl_soft_paper_convolve(soft_paper *soft, shadow_buffer *buffer, double next, hl_pool *pool,
                            const blur_functions *blur) {
  double width = soft->remainder + hl_soft_paper_width(soft, soft->last, next);
  double most = soft->image == NULL ? 2 * soft->reach : IMAGE_SIDE; /* no box reads beyond the buffer's margin */
  if (width <= 2) return;
  do {
    double whole = fmin(floor(width), most);
    convolve(soft, buffer, (int)whole, pool, blur);
    width -= whole;
  } while (width > 2 && soft->image != NULL);
  soft->remainder = width;
  soft->last = next;
}
