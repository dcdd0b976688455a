/* shadow_paper/paper.c - implements the paper's soft shadows (sections 5.1 and 5.2), unchanged, as the
 * baseline.
 *
 * One shadow buffer goes from sheet to sheet, and is convolved again and again with a box, or with the
 * light's emission image. Eq. (5) of the paper gives the width of the box or image for the step from the last
 * convolved sheet to the next one. Convolution adds variances and not widths, so the widths of penumbrae grow
 * with the square root of the distance. The other methods avoid this error.
 *
 * In a shared picture, each part computes the pixels of the buffer that its own picture reads, and also the
 * pixels from which convolutions make these pixels. */
#include "shadow_paper/paper.h"

#include <string.h>

#include "core/memory.h"
#include "light/light_extent.h"
#include "shadow/blur.h"

typedef struct soft_paper {
  const light_emission *emission; /* the light's emission image; null if convolutions use a box */
  bool parallel;
  double size;         /* the width L of the virtual light (see_light()); for parallel light, L / Z */
  double light_height; /* height of a near light, measured along the sheets' normal */
  double pixel;        /* edge of a buffer's pixel in frame units; for a near light, the edge at distance 1 */
  double last;         /* height of the sheet for which the last convolution was made */
  double remainder;    /* the width, in pixels, by which the penumbrae have grown since the last
                        * convolution */
  int reach;           /* number of pixels beyond a tile that convolutions may read; the buffer's margin has
                        * the same width */
  /* [slabs]; for each slab, the sum of the reaches of all convolutions before the slab, in pixels; scratch
   * memory of widen_needs() */
  int32_t *reached;
  int32_t *far; /* [tiles of the buffer]; scratch memory of widen_needs() */
} soft_paper;

/* Sets the virtual light of section 5.2, (1) and (3). The virtual light is the orthogonal projection of the
 * real light onto a plane parallel to the sheets, and has the average size of this projection. A disk of
 * diameter L that is tilted by the angle t becomes an ellipse with the axes L and L cos t. The distance Z
 * from the light is measured along the sheets' normal. Derived: for parallel light, L / Z is (L / D) / cos t,
 * where L / D = 2 tan(angle / 2) is measured along the ray. */
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

/* The width dx, in pixels, by which a penumbra grows from one sheet to another: eq. (5) of the paper, dx = L
 * dZ / Z, where L is the light's width, Z the distance of the first sheet from the light, and dZ the distance
 * between the sheets. Projected to the distance 1 from the light's centre, the width is dx / (Z + dZ) = L
 * (1/Z - 1/(Z + dZ)). */
static double width_between(const soft_paper *soft, double from, double to) {
  if (soft->parallel) return soft->size * (to - from) / soft->pixel;
  double near = from - soft->light_height, far = to - soft->light_height;
  if (near <= 0 || far <= near) return 0;
  return soft->size * (1 / near - 1 / far) / soft->pixel;
}

/* An upper bound of the reach, in pixels, of the convolutions in a sweep. The first convolution covers the
 * distance of two sheets. */
static int widest_reach(const soft_paper *soft, const sheet_stack *sheets) {
  double first = sheets->first, spacing = sheets->spacing;
  double widest = width_between(soft, first, first + 2 * spacing);
  for (int k = 1; k < sheets->count; k++)
    widest = fmax(widest, width_between(soft, first + k * spacing, first + (k + 1) * spacing));
  return (int)fmin(soft->emission != NULL ? soft->emission->reach * (widest + 2) + 3 : widest / 2 + 3, 1024);
}

/* One convolution, from the buffer to its second planes and back. The convolution works tile by tile, on all
 * channels of a tile at once. */
typedef struct convolution {
  shadow_buffer *buffer;
  const int32_t *needed_until; /* borrowed from the light_shadow */
  int sheet, reach;            /* reach: the number of pixels around a tile on which the convolved tile
                                * depends */
  unsigned char *wanted;       /* [tiles]; 1 for tiles that the convolution can change */
  shadow_plane kind;           /* the kind of planes that is convolved now */
  bool last;                   /* whether this kind of planes is the last kind that is convolved at this
                                * sheet */
  const blur_functions *blur;
  blur_box box;
  /* the next members are used in place of `box` if the light has an emission image: */
  int count;
  const ptrdiff_t *offset; /* [count]; the offset of each tap, in floats */
  const emission_taps *taps;
} convolution;

/* Returns the planes of one kind, one for each channel: the transmittance, or the light at the outside of
 * surfaces. */
static float *const *planes_of(const shadow_buffer *buffer, shadow_plane kind) {
  return kind == SHADOW_OUTSIDE ? buffer->outside : buffer->transmittance;
}

static void blur_rows(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  float *const *planes = planes_of(buffer, task->kind);
  for (int x = 0; x < buffer->tiles_x; x++)
    for (int c = 0; c < buffer->channels && task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]; c++) {
      const blur_job job = {planes[c], buffer->second[c], buffer->stride, buffer->stride, task->box};
      task->blur->rows(&job, x, (int)index);
    }
}

static void blur_columns(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  shadow_buffer *buffer = task->buffer;
  float *const *planes = planes_of(buffer, task->kind);
  for (int x = 0; x < buffer->tiles_x; x++) {
    if (!task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]) continue;
    for (int c = 0; c < buffer->channels; c++) {
      const blur_job job = {buffer->second[c], planes[c], buffer->stride, buffer->stride, task->box};
      task->blur->columns(&job, x, (int)index);
    }
    if (task->last) hl_shadow_buffer_find_lit(buffer, x, (int)index, false, task->blur->lit_blocks);
  }
}

static void weigh_emission(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  float *const *planes = planes_of(buffer, task->kind);
  for (int x = 0; x < buffer->tiles_x; x++)
    for (int c = 0; c < buffer->channels && task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]; c++) {
      const emission_job job = {.from = planes[c],
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
  float *const *planes = planes_of(buffer, task->kind);
  for (int x = 0; x < buffer->tiles_x; x++) {
    if (!task->wanted[index * (size_t)buffer->tiles_x + (size_t)x]) continue;
    for (int c = 0; c < buffer->channels; c++)
      for (size_t row = 0; row < TILE; row++) {
        size_t at = (index * TILE + row) * buffer->stride + (size_t)x * TILE;
        memcpy(planes[c] + at, buffer->second[c] + at, TILE * sizeof(float));
      }
    if (task->last) hl_shadow_buffer_find_lit(buffer, x, (int)index, false, task->blur->lit_blocks);
  }
}

/* Convolves the planes of one kind, and no planes of other kinds. last: whether the sheet has no further
 * planes to convolve; the lit blocks of the tiles are then found again. */
static void convolve_planes(const soft_paper *soft, convolution *task, shadow_plane kind, bool last,
                            hl_pool *pool) {
  size_t rows = (size_t)task->buffer->tiles_y;
  task->kind = kind;
  task->last = last;
  hl_pool_run(pool, rows, soft->emission != NULL ? weigh_emission : blur_rows, task);
  hl_pool_run(pool, rows, soft->emission != NULL ? copy_back : blur_columns, task);
}

/* Convolves all planes that the picture reads. */
static void convolve_all(const soft_paper *soft, convolution *task, hl_pool *pool) {
  bool outside = task->buffer->has_outside;
  convolve_planes(soft, task, SHADOW_TRANSMITTANCE, !outside, pool);
  if (outside) convolve_planes(soft, task, SHADOW_OUTSIDE, true, pool);
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
  convolve_all(soft, task, pool);
}

/* ---- which tiles ---- */

/* Returns whether light was absorbed in the tile (x, y), or in a tile that is at most `around` tiles away. */
static bool any_touched(const shadow_buffer *buffer, int x, int y, int around) {
  int x0 = x < around ? 0 : x - around, y0 = y < around ? 0 : y - around;
  for (int j = y0; j <= y + around && j < buffer->tiles_y; j++)
    for (int i = x0; i <= x + around && i < buffer->tiles_x; i++)
      if (buffer->tile_touched[(size_t)j * (size_t)buffer->tiles_x + (size_t)i]) return true;
  return false;
}

/* Returns whether any pixel in a tile, or within `reach` pixels around the tile, is below 1. */
static bool any_below_one(const shadow_buffer *buffer, int x, int y, int reach) {
  const ptrdiff_t stride = (ptrdiff_t)buffer->stride;
  for (int c = 0; c < buffer->channels; c++) {
    const float *row = buffer->transmittance[c] + ((ptrdiff_t)y * TILE - reach) * stride +
                       ((ptrdiff_t)x * TILE - reach);
    for (int j = 0; j < TILE + 2 * reach; j++, row += stride) {
      int below = 0;
      for (int i = 0; i < TILE + 2 * reach; i++) below |= row[i] < 1;
      if (below) return true;
    }
  }
  return false;
}

/* Marks the tiles of a row that a convolution can change. The marks depend only on pixels within reach,
 * because the parts of a shared picture know only these pixels. So all parts set the same marks. With
 * different marks, the parts' pictures would have different bytes, because the sum of an emission image's
 * weights is not exactly 1. */
static void find_wanted(void *data, size_t index, int worker) {
  (void)worker;
  const convolution *task = data;
  const shadow_buffer *buffer = task->buffer;
  for (int x = 0; x < buffer->tiles_x; x++) {
    size_t tile = index * (size_t)buffer->tiles_x + (size_t)x;
    bool needed = task->needed_until == NULL || task->needed_until[tile] >= task->sheet;
    task->wanted[tile] = needed && (buffer->tile_touched[tile] ||
                                    (any_touched(buffer, x, (int)index, (task->reach + TILE - 1) / TILE) &&
                                     any_below_one(buffer, x, (int)index, task->reach)));
  }
}

int hl_paper_reach(int width) {
  const blur_box box = hl_blur_box((float)width);
  return box.reach + (box.edge > 0);
}

/* The number of pixels to each side of a pixel that a convolution reads. width: the width of the box or of
 * the emission image, in pixels. */
static int reach_of(const soft_paper *soft, int width) {
  return soft->emission != NULL ? (int)(soft->emission->reach * width) + 2 : hl_paper_reach(width);
}

/* Convolves the tiles that can change. Each other tile holds 1 in the buffer and in its second planes, or is
 * not needed. */
static void convolve(const soft_paper *soft, const light_shadow *shadow, int sheet, int width) {
  shadow_buffer *buffer = shadow->buffer;
  hl_pool *pool = shadow->means.pool;
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  convolution task = {.buffer = buffer,
                      .needed_until = shadow->needed_until,
                      .sheet = sheet,
                      .reach = reach_of(soft, width),
                      .wanted = buffer->tile_touched + tiles,
                      .blur = &shadow->means.functions->blur,
                      .box = hl_blur_box((float)width)};
  hl_pool_run(pool, (size_t)buffer->tiles_y, find_wanted, &task);
  if (soft->emission != NULL) {
    convolve_with_emission(soft, &task, width, pool);
  } else {
    convolve_all(soft, &task, pool);
  }
  for (size_t tile = 0; tile < tiles; tile++) buffer->tile_touched[tile] |= task.wanted[tile];
}

/* The sum of the widths dx, in pixels, that have not been convolved before a sheet. */
static double owed_width(const soft_paper *soft, const sheet_stack *sheets, int sheet) {
  return soft->remainder + width_between(soft, soft->last, hl_sheet_height(sheets, sheet + 1));
}

/* The width of the next convolution, in pixels. owed: the width that has not been convolved. A convolution
 * with a box reads no pixel beyond the buffer's margin. */
static int next_width(const soft_paper *soft, double owed) {
  return (int)fmin(floor(owed), soft->emission == NULL ? 2 * soft->reach : EMISSION_SIDE);
}

/* Convolves at a sheet, as section 5.2, (2) of the paper says: the widths dx are added up until the sum
 * exceeds two pixels. The buffer is then convolved by the integer part of the sum, and the rest is kept for a
 * later sheet. An emission image has one tap per pixel, and along an axis the number of taps is at most the
 * number of cells. So a greater width takes several convolutions. shadow: null if nothing is to be convolved
 * and only the reach is wanted. Returns the sum of the reaches of the convolutions at this sheet, in pixels.
 */
static int pass_sheet(soft_paper *soft, const sheet_stack *sheets, int sheet, const light_shadow *shadow) {
  double width = owed_width(soft, sheets, sheet);
  int reach = 0;
  if (width <= 2) return 0;
  do {
    int whole = next_width(soft, width);
    if (shadow != NULL) convolve(soft, shadow, sheet, whole);
    reach += reach_of(soft, whole);
    width -= whole;
  } while (width > 2 && soft->emission != NULL);
  soft->remainder = width;
  soft->last = hl_sheet_height(sheets, sheet + 1);
  return reach;
}

void hl_paper_find_widths(const light_shadow *planned, int first, int32_t *widths) {
  const sheet_stack *sheets = planned->setup.sheets;
  soft_paper soft = *(const soft_paper *)planned->state;
  memset(widths, 0, (size_t)sheets->count * sizeof *widths);
  for (int sheet = first; sheet < sheets->count; sheet++) {
    const double owed = owed_width(&soft, sheets, sheet);
    if (owed > 2) widths[sheet] = next_width(&soft, owed);
    (void)pass_sheet(&soft, sheets, sheet, NULL);
  }
}

static void advance_paper(light_shadow *shadow, const occupancy *occupancy, int sheet) {
  (void)occupancy;
  (void)pass_sheet(shadow->state, shadow->setup.sheets, sheet, shadow);
}

/* ---- the pixels that a part of the picture needs ---- */

/* Raises a tile's value to the greatest value of four neighbouring tiles minus the edge of a tile. sign: 1
 * for the neighbours before the tile in the order of rows, -1 for the neighbours after the tile. */
static void raise_tile(const shadow_buffer *buffer, int32_t *far, int x, int y, int sign) {
  static const int beside[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  int32_t *tile = &far[(ptrdiff_t)y * buffer->tiles_x + x];
  for (int i = 0; i < 4; i++) {
    int u = x + sign * beside[i][0], v = y + sign * beside[i][1];
    if (u < 0 || v < 0 || u >= buffer->tiles_x || v >= buffer->tiles_y) continue;
    int32_t from = far[(ptrdiff_t)v * buffer->tiles_x + u] - TILE;
    if (*tile < from) *tile = from;
  }
}

/* The greatest value among a tile's eight neighbours. */
static int32_t greatest_beside(const shadow_buffer *buffer, const int32_t *far, int x, int y) {
  int32_t greatest = -TILE;
  for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < buffer->tiles_y; v++)
    for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < buffer->tiles_x; u++) {
      int32_t value = far[(ptrdiff_t)v * buffer->tiles_x + u];
      if ((u != x || v != y) && greatest < value) greatest = value;
    }
  return greatest;
}

/* Returns the number of the last slab whose entry in `reached` is at most `far`. reached: [slabs]; the
 * entries are in rising order. */
static int32_t last_slab(const int32_t *reached, int slabs, int32_t far) {
  int32_t low = 0, high = slabs;
  while (high - low > 1) {
    int32_t middle = (low + high) / 2;
    if (reached[middle] <= far) low = middle;
    else high = middle;
  }
  return low;
}

/* Raises needed_until in tiles whose pixels affect, by convolutions, pixels that the picture reads. Derived:
 * let reached(k) be the sum of the reaches of all convolutions before slab k. A pixel of slab k affects a
 * pixel that is d pixels away and is read in slab s, if d <= reached(s) - reached(k). So the affecting
 * pixel's tile is needed until the last k with reached(k) <= reached(s) - d. For a tile that is n tiles away,
 * d is at least 16 (n - 1) + 1. The greatest value of reached(s) - 16 n is found in two passes over the
 * tiles. Each pass hands values on from neighbour to neighbour. */
static void widen_needs(light_shadow *shadow, int32_t *needed_until) {
  const shadow_buffer *buffer = shadow->buffer;
  const sheet_stack *sheets = shadow->setup.sheets;
  soft_paper soft = *(const soft_paper *)shadow->state;
  size_t tiles = (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
  int32_t *reached = soft.reached, *far = soft.far;
  reached[0] = 0;
  for (int slab = 1; slab < sheets->count; slab++)
    reached[slab] = reached[slab - 1] + (slab > 1 ? pass_sheet(&soft, sheets, slab - 1, NULL) : 0);
  for (size_t tile = 0; tile < tiles; tile++)
    far[tile] = needed_until[tile] > 0 ? reached[needed_until[tile]] : -TILE;
  for (int y = 0; y < buffer->tiles_y; y++)
    for (int x = 0; x < buffer->tiles_x; x++) raise_tile(buffer, far, x, y, 1);
  for (int y = buffer->tiles_y - 1; y >= 0; y--)
    for (int x = buffer->tiles_x - 1; x >= 0; x--) raise_tile(buffer, far, x, y, -1);
  for (int y = 0; y < buffer->tiles_y; y++)
    for (int x = 0; x < buffer->tiles_x; x++) {
      int32_t *until = &needed_until[(ptrdiff_t)y * buffer->tiles_x + x];
      int32_t beside = greatest_beside(buffer, far, x, y) - 1;
      if (beside >= 0 && *until < last_slab(reached, sheets->count, beside))
        *until = last_slab(reached, sheets->count, beside);
    }
}

static void lay_out(light_shadow *shadow, shadow_layouts *layouts) {
  soft_paper *soft = shadow->state;
  const size_t slabs = (size_t)shadow->setup.sheets->count, tiles = hl_view_tiles(&shadow->plan.view);
  soft->reached = hl_layout_take(&layouts->passing, slabs, sizeof *soft->reached);
  soft->far = hl_layout_take(&layouts->passing, tiles, sizeof *soft->far);
}

static void plan_paper(light_shadow *shadow) {
  const shadow_setup *setup = &shadow->setup;
  const sheet_stack *sheets = setup->sheets;
  shadow_plan *plan = &shadow->plan;
  soft_paper *soft = shadow->state;
  plan->cubic = setup->settings->shadow_lookup == HL_LOOKUP_CUBIC;
  /* the planes SHADOW_SECOND hold the buffer between the convolution along rows and the convolution along
   * columns */
  plan->second = true;
  hl_plan_soft(shadow, hl_blurred_pixel(setup, plan->cubic));
  hl_shadow_view(setup->source, sheets->normal, &plan->extent, &plan->view);
  see_light(soft, setup, &plan->view);
  plan->reach = soft->reach = widest_reach(soft, sheets);
}

const shadow_method hl_shadow_paper = {.name = "paper",
                                       .state_bytes = sizeof(soft_paper),
                                       .surface_delay = 2,
                                       .surface_rise = 1.25,
                                       .first_slab = 1,
                                       .divides = true,
                                       .widen_needs = widen_needs,
                                       .plan = plan_paper,
                                       .lay_out = lay_out,
                                       .advance = advance_paper};
