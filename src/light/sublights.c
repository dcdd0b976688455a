/* light/sublights.c - the parts of a light: their buffers, and the slabs composited into them. */
#include "light/sublights.h"

#include <string.h>

#include "core/memory.h"
#include "light/light_image.h"

/* More than this is refused beforehand. */
static const double GREATEST_BYTES = 4294967296.0;

/* How far apart the parts' steps are at worst, as a part of the light: an M-th of it, as a box that a blur closes. */
static const double CLOSED_PART = 0.4;
enum { GREATEST_BLURS = 12 };

/* What part i of side x side sees; the greatest numbers of tiles. */
static void place_part(const light_source *source, int side, int i, vec3 normal, const shadow_extent *extent, view *view,
                       int *tiles_x, int *tiles_y) {
  double square[2];
  light_source part = *source;
  hl_light_part(side, i / side, i % side, square);
  vec3 offset = hl_light_point(source, square[0], square[1]);
  if (source->parallel) part.direction = vec3_normalise(vec3_add(source->direction, offset));
  else part.position = vec3_add(source->position, offset);
  hl_shadow_view(&part, normal, extent, view);
  if (hl_tiles(view->width) > *tiles_x) *tiles_x = hl_tiles(view->width);
  if (hl_tiles(view->height) > *tiles_y) *tiles_y = hl_tiles(view->height);
}

static void place_parts(sublights *sublights, const light_source *source, int side, vec3 normal,
                        const shadow_extent *extent) {
  for (int i = 0; i < sublights->count; i++) {
    sublight *part = &sublights->parts[i];
    place_part(source, side, i, normal, extent, &part->view, &sublights->tiles_x, &sublights->tiles_y);
    part->pixel = vec3_length(part->view.du);
  }
}

/* omega of a unit wide light (soft_cascade.h). */
static double omega_at(const sublights *sublights, double height) {
  if (sublights->parallel) return height;
  double distance = height - sublights->light_height;
  return distance > 0 ? -1 / distance : -INFINITY;
}

/* The blurs' variances add up to that of a box over CLOSED_PART of the steps between M parts, for the sweep's widest
 * penumbra; it grows evenly on the way there, and blurs come when one has a pixel's variance or so. */
static void plan_blurs(sublights *sublights, int side, double first, double last) {
  double start = omega_at(sublights, first), end = omega_at(sublights, last), pixel = sublights->parts[0].pixel;
  double widest = fmax(sublights->width_u, sublights->width_v) / pixel;
  if (!(end - start < 2 * TILE * fmax(sublights->tiles_x, sublights->tiles_y) / widest))
    start = end - 2 * TILE * fmax(sublights->tiles_x, sublights->tiles_y) / widest;
  double gap = (end - start) * CLOSED_PART / side, variance = gap * gap / 12;
  double blurs = fmin(ceil(variance * widest * widest), GREATEST_BLURS);
  sublights->step = blurs > 0 ? (end - start) / blurs : INFINITY;
  sublights->variance = blurs > 0 ? variance / blurs : 0;
  sublights->next = start + sublights->step;
}

static void lay_out_planes(sublights *sublights) {
  sublights->stride = (size_t)sublights->tiles_x * TILE + 2 * SUBLIGHT_MARGIN;
  sublights->plane = ((size_t)sublights->tiles_y * TILE + 2 * SUBLIGHT_MARGIN) * sublights->stride;
}

uint64_t hl_sublights_bytes(const light_source *source, int side, vec3 normal, const shadow_extent *extent, int channels) {
  sublights planned = {.channels = channels};
  uint64_t count = (uint64_t)side * (uint64_t)side;
  view view;
  for (int i = 0; i < side * side; i++)
    place_part(source, side, i, normal, extent, &view, &planned.tiles_x, &planned.tiles_y);
  lay_out_planes(&planned);
  uint64_t tiles = (uint64_t)planned.tiles_x * (uint64_t)planned.tiles_y;
  return (count + 1) * (uint64_t)channels * planned.plane * sizeof(float) + (2 * count + 1) * tiles +
         count * (sizeof *planned.parts + sizeof *planned.lookups);
}

static hl_status allocate(hl_context *context, hl_pool *pool, sublights *sublights, hl_error *error) {
  size_t count = (size_t)sublights->count, channels = (size_t)sublights->channels;
  size_t tiles = (size_t)sublights->tiles_x * (size_t)sublights->tiles_y;
  lay_out_planes(sublights);
  size_t floats = (count + 1) * channels * sublights->plane;
  if ((double)floats * sizeof(float) > GREATEST_BYTES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "/render/light_samples: %zu parts of a light need %.1f GB of shadow buffers, more than 4.3: use fewer, or a "
                   "lower shadow_resolution", count, (double)floats * sizeof(float) / 1e9);
  sublights->memory = hl_allocate(context, floats, sizeof(float));
  sublights->flags = hl_allocate_zeroed(context, 2 * count + 1, tiles);
  sublights->lookups = hl_allocate(context, count, sizeof *sublights->lookups);
  if (sublights->memory == NULL || sublights->flags == NULL || sublights->lookups == NULL)
    return hl_fail_memory(error, floats * sizeof(float), "the parts of a light");
  hl_pool_fill(pool, sublights->memory, floats, 1);
  size_t origin = SUBLIGHT_MARGIN * sublights->stride + SUBLIGHT_MARGIN;
  for (size_t i = 0; i < count; i++) {
    sublight *part = &sublights->parts[i];
    part->pixels = sublights->memory + i * channels * sublights->plane + origin;
    part->touched = sublights->flags + 2 * i * tiles;
    part->dark = part->touched + tiles;
  }
  sublights->spare = sublights->memory + count * channels * sublights->plane + origin;
  sublights->spare_touched = sublights->flags + 2 * count * tiles;
  return HL_OK;
}

/* The parts of a light with an image send its colours. */
static hl_status weigh_parts(hl_context *context, sublights *sublights, const light_source *source, int side, hl_error *error) {
  size_t count = (size_t)sublights->count;
  double mean[HL_CHANNELS];
  float(*weights)[HL_CHANNELS] = hl_allocate(context, count, sizeof *weights);
  if (weights == NULL) return hl_fail_memory(error, count * sizeof *weights, "the parts of a light");
  hl_light_image_weights(source, side, weights, mean);
  for (size_t i = 0; i < count; i++) memcpy(sublights->lookups[i].weight, weights[i], sizeof *weights);
  hl_release(context, weights);
  return HL_OK;
}

/* Where samples find each part's light. */
static void point_lookups(sublights *sublights) {
  for (int i = 0; i < sublights->count; i++)
    for (int c = 0; c < sublights->channels; c++)
      sublights->lookups[i].transmittance[c] = sublights->parts[i].pixels + (size_t)c * sublights->plane;
}

hl_status hl_sublights_begin(hl_context *context, hl_pool *pool, sublights *sublights, const light_source *source,
                             int side, const sheet_light *seen, vec3 normal, const shadow_extent *extent, int channels,
                             double first, double last, hl_error *error) {
  size_t count = (size_t)side * (size_t)side;
  sublights->parts = hl_allocate_zeroed(context, count, sizeof *sublights->parts);
  if (sublights->parts == NULL) return hl_fail_memory(error, count * sizeof *sublights->parts, "the parts of a light");
  sublights->count = (int)count;
  sublights->channels = channels;
  sublights->parallel = source->parallel;
  sublights->light_height = vec3_dot(source->position, normal);
  sublights->width_u = seen->width_u;
  sublights->width_v = seen->width_v;
  place_parts(sublights, source, side, normal, extent);
  plan_blurs(sublights, side, first, last);
  hl_status status = allocate(context, pool, sublights, error);
  if (status != HL_OK) return status;
  for (size_t i = 0; i < count; i++) {
    sublights->lookups[i] = hl_lookup_of_view(&sublights->parts[i].view);
    sublights->lookups[i].stride = sublights->stride;
  }
  point_lookups(sublights);
  return source->light->emission.pixels != NULL ? weigh_parts(context, sublights, source, side, error) : HL_OK;
}

void hl_sublights_release(hl_context *context, sublights *sublights) {
  void *owned[] = {sublights->parts, sublights->lookups, sublights->memory, sublights->flags};
  for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++) hl_release(context, owned[i]);
  memset(sublights, 0, sizeof *sublights);
}

/* ---- compositing ---- */

/* Where the ray of a part's pixel coordinates meets the sheet, in the slab's; false behind either. */
static bool slab_place(const sublight *part, const view *slab, vec3 normal, double height, double at, double uv[2]) {
  vec3 start, way;
  hl_view_ray(&part->view, at, at, &start, &way);
  double climb = vec3_dot(way, normal), distance = (height - vec3_dot(start, normal)) / climb;
  if (part->view.perspective && !(distance > 0)) return false;
  return hl_view_project(slab, vec3_add(start, vec3_scale(way, distance)), uv);
}

/* Both views lie parallel to the sheets with the same axes: from one to the other pixels are scaled and shifted. */
static void map_part(const sublights *sublights, sublight *part, const shadow_buffer *slab, vec3 normal, double height) {
  const double far = 1024;
  double zero[2], other[2];
  part->reaches = slab_place(part, &slab->view, normal, height, 0, zero) &&
                  slab_place(part, &slab->view, normal, height, far, other);
  part->job = (sublight_job){.slab_stride = slab->stride, .slab_width = (float)slab->view.width,
                             .slab_height = (float)slab->view.height, .stride = sublights->stride,
                             .channels = sublights->channels};
  for (int axis = 0; axis < 2 && part->reaches; axis++) {
    double scale = (other[axis] - zero[axis]) / far;
    if (fabs(scale - 1) < 1e-6) scale = 1;
    part->job.scale[axis] = (float)scale;
    part->job.shift[axis] = (float)zero[axis];
  }
  for (int c = 0; c < sublights->channels; c++) {
    part->job.slab[c] = slab->transmittance[c];
    part->job.transmittance[c] = part->pixels + (size_t)c * sublights->plane;
  }
}

typedef struct sublight_task {
  sublights *sublights;
  shadow_buffer *slab;
  sublight *part;
  const sublight_functions *functions;
  int x0, x1, y0, y1; /* tiles of the slab that were touched lie between these */
  blur_add_job blur;
  int reach_x, reach_y;
} sublight_task;

/* First and last tile of `to` under pixels from x to x + TILE of one axis, scaled and shifted; a pixel to spare. */
static void tiles_under(double x, double scale, double shift, int tiles, int *first, int *last) {
  double low = (scale * x + shift - 1) / TILE, high = (scale * (x + TILE) + shift + 1) / TILE;
  *first = low < 0 ? 0 : low > tiles ? tiles : (int)low;
  *last = high < 0 ? -1 : high >= tiles ? tiles - 1 : (int)high;
}

static bool any_marked(const unsigned char *marks, int tiles_x, int x0, int x1, int y0, int y1, unsigned char mark) {
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++)
      if (marks[(size_t)y * (size_t)tiles_x + (size_t)x] == mark) return true;
  return false;
}

/* What was touched of the slab; false: nothing. */
static bool bound_touched(const shadow_buffer *slab, sublight_task *task) {
  task->x0 = slab->tiles_x;
  task->y0 = slab->tiles_y;
  task->x1 = task->y1 = -1;
  for (int y = 0; y < slab->tiles_y; y++) {
    const unsigned char *row = slab->tile_touched + (size_t)y * (size_t)slab->tiles_x;
    for (int x = 0; x < slab->tiles_x; x++) {
      if (!row[x]) continue;
      if (x < task->x0) task->x0 = x;
      if (x > task->x1) task->x1 = x;
      if (y < task->y0) task->y0 = y;
      task->y1 = y;
    }
  }
  return task->x1 >= 0;
}

/* The tiles of a part under these of the slab, along an axis. */
static void part_tiles(const sublight *part, int axis, int low, int high, int tiles, int *first, int *last) {
  double scale = 1 / (double)part->job.scale[axis], shift = -(double)part->job.shift[axis] * scale;
  int unused;
  tiles_under((double)low * TILE, scale, shift, tiles, first, &unused);
  tiles_under((double)high * TILE, scale, shift, tiles, &unused, last);
}

/* A row of tiles of one part. */
static void composite_row(void *data, size_t index, int worker) {
  (void)worker;
  const sublight_task *task = data;
  const sublights *all = task->sublights;
  const shadow_buffer *slab = task->slab;
  sublight *part = &all->parts[index / (size_t)all->tiles_y];
  int y = (int)(index % (size_t)all->tiles_y), y0, y1, first, last;
  if (!part->reaches) return;
  part_tiles(part, 1, task->y0, task->y1, all->tiles_y, &first, &last);
  if (y < first || y > last) return;
  part_tiles(part, 0, task->x0, task->x1, all->tiles_x, &first, &last);
  tiles_under((double)y * TILE, (double)part->job.scale[1], (double)part->job.shift[1], slab->tiles_y, &y0, &y1);
  for (int x = first; x <= last; x++) {
    size_t tile = (size_t)y * (size_t)all->tiles_x + (size_t)x;
    int x0, x1;
    if (part->dark[tile]) continue;
    tiles_under((double)x * TILE, (double)part->job.scale[0], (double)part->job.shift[0], slab->tiles_x, &x0, &x1);
    if (!any_marked(slab->tile_touched, slab->tiles_x, x0, x1, y0, y1, 1)) continue;
    part->dark[tile] = !task->functions->composite(&part->job, x, y);
    part->touched[tile] = 1;
  }
}

/* ---- blurring ---- */

static bool any_touched_near(const sublights *all, const sublight *part, int x, int y, int reach_x, int reach_y) {
  int x0 = x < reach_x ? 0 : x - reach_x, y0 = y < reach_y ? 0 : y - reach_y;
  int x1 = x + reach_x < all->tiles_x ? x + reach_x : all->tiles_x - 1;
  int y1 = y + reach_y < all->tiles_y ? y + reach_y : all->tiles_y - 1;
  return any_marked(part->touched, all->tiles_x, x0, x1, y0, y1, 1);
}

static void fill_ones(const sublights *all, float *pixels, int x, int y) {
  for (size_t row = 0; row < TILE; row++)
    for (size_t i = 0; i < TILE; i++) pixels[((size_t)y * TILE + row) * all->stride + (size_t)x * TILE + i] = 1;
}

/* A row of tiles from the part's planes to the spare ones. */
static void blur_row(void *data, size_t index, int worker) {
  (void)worker;
  const sublight_task *task = data;
  const sublights *all = task->sublights;
  const sublight *part = task->part;
  int y = (int)index;
  for (int x = 0; x < all->tiles_x; x++) {
    size_t tile = index * (size_t)all->tiles_x + (size_t)x, at = index * TILE * all->stride + (size_t)x * TILE;
    bool touched = any_touched_near(all, part, x, y, task->reach_x, task->reach_y);
    const float *left[HL_CHANNELS] = {NULL, NULL, NULL};
    for (int c = 0; c < all->channels; c++) {
      size_t plane = (size_t)c * all->plane;
      blur_add_job job = task->blur;
      job.from = part->pixels + plane;
      job.to = all->spare + plane;
      left[c] = job.to + at;
      if (touched) task->functions->blur(&job, x, y);
      else if (all->spare_touched[tile]) fill_ones(all, job.to, x, y);
    }
    all->spare_touched[tile] = touched;
    part->dark[tile] = touched && task->functions->lit_blocks(left, all->channels, all->stride) == 0;
  }
}

static void blur_parts(sublights *all, hl_pool *pool, const sublight_functions *functions) {
  for (int i = 0; i < all->count; i++) {
    sublight *part = &all->parts[i];
    double u = all->width_u / part->pixel, v = all->width_v / part->pixel;
    sublight_task task = {.sublights = all, .part = part, .functions = functions, .blur = {.stride = all->stride}};
    task.blur.u = hl_blur_box_of_variance(all->variance * u * u);
    task.blur.v = hl_blur_box_of_variance(all->variance * v * v);
    task.reach_x = (task.blur.u.reach + TILE) / TILE;
    task.reach_y = (task.blur.v.reach + TILE) / TILE;
    hl_pool_run(pool, (size_t)all->tiles_y, blur_row, &task);
    float *pixels = part->pixels;
    unsigned char *touched = part->touched;
    part->pixels = all->spare;
    part->touched = all->spare_touched;
    all->spare = pixels;
    all->spare_touched = touched;
  }
  point_lookups(all);
}

/* ---- the slab ---- */

/* Tiles of the slab become ones again; those that no part's light reaches need not be filled. */
static void clear_row(void *data, size_t index, int worker) {
  (void)worker;
  const sublight_task *task = data;
  const sublights *all = task->sublights;
  shadow_buffer *slab = task->slab;
  for (int x = 0; x < slab->tiles_x; x++) {
    size_t tile = index * (size_t)slab->tiles_x + (size_t)x;
    for (int c = 0; c < slab->channels && slab->tile_touched[tile]; c++)
      for (size_t row = 0; row < TILE; row++)
        for (size_t i = 0; i < TILE; i++)
          slab->transmittance[c][(index * TILE + row) * slab->stride + (size_t)x * TILE + i] = 1;
    slab->tile_touched[tile] = 0;
    bool lit = false;
    for (int i = 0; i < all->count && !lit; i++) {
      const sublight *part = &all->parts[i];
      int x0, x1, y0, y1;
      if (!part->reaches) continue;
      part_tiles(part, 0, x, x, all->tiles_x, &x0, &x1);
      part_tiles(part, 1, (int)index, (int)index, all->tiles_y, &y0, &y1);
      lit = any_marked(part->dark, all->tiles_x, x0, x1, y0, y1, 0);
    }
    slab->tile_lit[tile] = lit ? ALL_BLOCKS : 0;
  }
}

void hl_sublights_advance(sublights *sublights, shadow_buffer *slab, vec3 normal, double from, double to, hl_pool *pool,
                          const sublight_functions *functions) {
  for (int i = 0; i < sublights->count; i++) map_part(sublights, &sublights->parts[i], slab, normal, (from + to) / 2);
  sublight_task task = {.sublights = sublights, .slab = slab, .functions = functions};
  if (bound_touched(slab, &task))
    hl_pool_run(pool, (size_t)sublights->count * (size_t)sublights->tiles_y, composite_row, &task);
  double omega = omega_at(sublights, to);
  if (omega >= sublights->next) {
    blur_parts(sublights, pool, functions);
    sublights->next = omega + sublights->step;
  }
  hl_pool_run(pool, (size_t)slab->tiles_y, clear_row, &task);
}
