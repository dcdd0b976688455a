/* render/maximum.c - see maximum.h: finds which values a transfer function shows, and colours the greatest.
 */
#include "render/maximum.h"

#include <float.h>
#include <math.h>

#include "core/memory.h"
#include "scene/scene.h"

/* Table coordinates of values come from rounded sums of floats. So the ends of the shown ranges are moved
 * by ROUNDINGS roundings of the greatest voxel, and at least by LEAST_END entries. A value at an end is
 * then shown exactly where the transfer function shows it. */
static const double LEAST_END = 1e-3, ROUNDINGS = 8;

enum { BISECTIONS = 30 };

static size_t visible_count(const plan_volumes *volumes) {
  size_t count = 0;
  for (int i = 0; i < volumes->count; i++) count += volumes->list[i].visible;
  return count;
}

static size_t floats_of_tile(const maximum_values *maximum) {
  return maximum->volume_count * MAXIMUM_ROWS * TILE_PIXELS;
}

enum { SHOWN_ENTRIES = CLASSIFIER_ENTRIES + 2 };

static maximum_values plan_values(const frame_plan *plan) {
  return (maximum_values){.volume_count = visible_count(&plan->volumes), .tiles = plan->picture.tiles};
}

static void lay_out(maximum_values *maximum, hl_layout *layout) {
  maximum->values = hl_layout_take(layout, maximum->tiles, floats_of_tile(maximum) * sizeof *maximum->values);
  maximum->shown = hl_layout_take(layout, maximum->volume_count, SHOWN_ENTRIES * sizeof *maximum->shown);
}

void hl_maximum_count(const frame_plan *plan, hl_layout *layout) {
  maximum_values maximum = plan_values(plan);
  if (hl_is_maximum(&plan->settings)) lay_out(&maximum, layout);
}

/* A volume's transfer function, as a function of the coordinates of the classifier's table. */
typedef struct shown_values {
  const hl_transfer_function *function;
  double low, step; /* data values: the value of coordinate 0, and the step from one coordinate to the next */
  double nothing;   /* data value below which there is no matter */
  double end;       /* number of entries by which ends are moved */
} shown_values;

static bool shows(const shown_values *values, double from, double to) {
  double low = fmax(values->low + from * values->step, values->nothing),
         high = values->low + to * values->step;
  return low <= high && hl_transfer_function_visible(values->function, low, high);
}

/* The greatest, or the least, value that is shown between entry and entry + 1. */
static double end_of_step(const shown_values *values, int entry, bool greatest) {
  double inside = entry, outside = entry + 1;
  /* In the search for the greatest value, something is always shown between `inside` and the step's end. */
  for (int i = 0; i < BISECTIONS; i++) {
    double middle = (inside + outside) / 2;
    bool some = greatest ? shows(values, middle, entry + 1) : shows(values, entry, middle);
    if (some == greatest) inside = middle;
    else outside = middle;
  }
  return (inside + outside) / 2;
}

/* True where opacity rises from 0 without a jump, so that the end itself is not shown. False where opacity
 * jumps. */
static bool rises_from(const shown_values *values, double from) {
  double near = values->low + (from + values->end) * values->step,
         far = values->low + (from + 2 * values->end) * values->step;
  return hl_transfer_function_opacity(values->function, near) <
         0.75 * hl_transfer_function_opacity(values->function, far);
}

static void fill_step(const shown_values *values, int entry, double below, float row[4]) {
  bool any = shows(values, entry, entry + 1);
  double from = 2 * CLASSIFIER_ENTRIES, to = below;
  if (any) {
    from = shows(values, entry, entry) ? entry : end_of_step(values, entry, false);
    to = shows(values, entry + 1, entry + 1) ? entry + 1 : end_of_step(values, entry, true);
    from += rises_from(values, from) ? values->end : -values->end;
  }
  row[SHOWN_FROM] = (float)from;
  row[SHOWN_TO] = (float)to;
  row[SHOWN_BELOW] = (float)below;
  row[3] = 0;
}

static double end_of(const frame_volume *of, double step) {
  const hl_volume *volume = of->volume;
  double greatest = fmax(fmax(fabs(volume->minimum), fabs(volume->maximum)), fabs(of->empty));
  return fmax(LEAST_END, ROUNDINGS * FLT_EPSILON * greatest / step);
}

/* Fills the columns SHOWN_FROM, SHOWN_TO and SHOWN_BELOW of a volume's table. rows: [SHOWN_ENTRIES]. */
static void fill_shown(const frame_volume *volume, const grid *grid, float (*rows)[4]) {
  const classifier *classifier = volume->classifier;
  double empty = volume->empty, step = grid->value_scale / (double)classifier->scale;
  const shown_values values = {volume->function, empty - (double)classifier->offset * step, step,
                               hl_transparent_below(volume->volume, volume->function, empty),
                               end_of(volume, fabs(step))};
  double below = -1;
  for (int entry = 0; entry < SHOWN_ENTRIES; entry++) {
    fill_step(&values, entry < CLASSIFIER_ENTRIES ? entry : CLASSIFIER_ENTRIES, below, rows[entry]);
    if (rows[entry][SHOWN_FROM] <= entry + 1) below = (double)rows[entry][SHOWN_TO];
  }
}

static void clear_tile(void *data, size_t tile, int worker) {
  (void)worker;
  const maximum_values *maximum = data;
  float *values = maximum->values + tile * floats_of_tile(maximum);
  for (size_t i = 0; i < floats_of_tile(maximum); i++) values[i] = -1;
}

hl_status hl_maximum_create(hl_context *context, hl_pool *pool, const frame_plan *of, maximum_values *maximum,
                            hl_error *error) {
  *maximum = plan_values(of);
  if (!hl_is_maximum(&of->settings)) return HL_OK;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out(maximum, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a maximum projection");
  hl_pool_run(pool, of->picture.tiles, clear_tile, maximum);
  size_t rank = 0;
  for (int i = 0; i < of->volumes.count; i++)
    if (of->volumes.list[i].visible)
      fill_shown(&of->volumes.list[i], &of->volumes.grids[i], maximum->shown + SHOWN_ENTRIES * rank++);
  return HL_OK;
}

void hl_maximum_release(hl_context *context, maximum_values *maximum) {
  hl_release(context, maximum->values);
}

/* ---- colours ---- */

typedef struct color_job {
  const maximum_values *maximum;
  const plan_volumes *volumes;
  float *pixels;
} color_job;

/* Looks up the colours of sixteen pixels of one volume. */
static void color_block(float (*table)[4], const float *greatest, float *pixels) {
  for (int lane = 0; lane < BLOCK_PIXELS; lane++) {
    if (!(greatest[lane] >= 0)) continue;
    int entry = (int)greatest[lane];
    float fraction = greatest[lane] - (float)entry;
    for (int c = 0; c < 3; c++) {
      float color = table[entry][c] + (table[entry + 1][c] - table[entry][c]) * fraction;
      float *at = &pixels[c * BLOCK_PIXELS + lane];
      if (color > *at) *at = color;
    }
    pixels[3 * BLOCK_PIXELS + lane] = 1;
  }
}

static void color_tile(void *data, size_t tile, int worker) {
  (void)worker;
  const color_job *job = data;
  const float *values = job->maximum->values + tile * floats_of_tile(job->maximum);
  for (int i = 0; i < job->volumes->count; i++) {
    if (!job->volumes->list[i].visible) continue;
    for (int block = 0; block < TILE_BLOCKS; block++)
      color_block(job->volumes->list[i].classifier->color, values + block * BLOCK_PIXELS,
                  job->pixels + (tile * TILE_BLOCKS + (size_t)block) * 4 * BLOCK_PIXELS);
    values += MAXIMUM_ROWS * TILE_PIXELS;
  }
}

void hl_maximum_color(const maximum_values *maximum, const frame_plan *of, hl_pool *pool, float *pixels) {
  color_job job = {maximum, &of->volumes, pixels};
  hl_pool_run(pool, maximum->tiles, color_tile, &job);
}

uint32_t hl_maximum_tile(const sweep *sweep, const tile_slab *slab) {
  const maximum_values *maximum = sweep->target.maximum;
  float *values = maximum->values + slab->tile * maximum->volume_count * MAXIMUM_ROWS * TILE_PIXELS;
  return sweep->content.hot->render->maximum(slab->job, slab, values,
                                             &sweep->arrays.counts[slab->worker].samples);
}
