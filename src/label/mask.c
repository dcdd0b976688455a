/* label/mask.c - see mask.h. */
#include "label/mask.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/pool.h"
#include "label/occupancy_line.h"
#include "label/shelf.h"
#include "volume/colors.h"

/* The fraction of the matter at a place that belongs to all labels together (the common share) rises from 0
 * to 1 while the sum of their occupancies rises from SHARE_FROM to SHARE_TO. The other matter belongs to the
 * rest. The common share is divided among the labels in proportion to the squares of their occupancies.
 * Derived: between two labels with the occupancies a and 1 - a, the first label's fraction a^2 / (a^2 + (1 -
 * a)^2) rises from 0 to 1 with the slope 2 in the middle, like the common share. If three labels meet, their
 * fractions still add up to 1. */
static const float SHARE_FROM = 0.25f, SHARE_TO = 0.75f;
/* In the weights of colours, the occupancy of all labels times this factor is added to the labels' common
 * share. So the labels' colours continue to places where the share is 0. */
static const float FAINT = 1e-3f;
/* Occupancies up to this number are ignored, because they come from the tails of the smoothing and from
 * rounding to bytes. */
static const float LEAST = 1.0f / 16;

/* Slopes fade to 0 where a mask's numbers go from the factor 1 to this distance beyond it. */
static const double FADING = 0.5;

typedef struct mask_job {
  const hl_mask *mask;
  hl_volume *const *occupancies;    /* [label_count]; an element is null if no voxel has the label */
  uint16_t *factors;                /* [k][j][i]; the factor of extinction at each point of the lattice */
  unsigned char *colors;            /* [k][j][i][HL_COLOR_BYTES]; the colour at each point of the lattice;
                                     * null if no label tints */
  signed char *slopes;              /* [k][j][i][4]; the slopes of the factor, as in mask.h */
  double slope_scale;               /* the slope for which a stored slope of 1 stands, per voxel */
  uint32_t (*bricks)[2];            /* [bk][bj][bi][2]; the bricks of the lattice, as in mask.h */
  double value_scale, value_offset; /* the factor at a point = value_scale * its number + value_offset */
  float *sums;                      /* [threads][slice floats]; the sums of each thread over the labels */
  size_t slice_floats;
} mask_job;

/* Sums over all labels, one for each voxel of a slice, each [j][i]: of the occupancies (SUM_OCCUPANCY); of
 * their squares (SUM_SQUARES); of the squares times the label's opacity (SUM_FACTOR); of the squares times
 * opacity and tint (SUM_TINT); and of the squares times opacity, tint and each channel of the label's colour.
 * Space for a line of occupancy follows (SUM_LINE). */
enum { SUM_OCCUPANCY, SUM_SQUARES, SUM_FACTOR, SUM_TINT, SUM_RED, SUM_GREEN, SUM_BLUE, SUM_LINE, SUMS };

static void add_voxel(float *const sums[SUMS], size_t at, const hl_label *label, float occupancy) {
  if (!(occupancy > LEAST)) return;
  float square = (occupancy - LEAST) * (occupancy - LEAST),
        visible = label->visible ? square * (float)label->opacity : 0;
  float tint = visible * (float)label->tint;
  sums[SUM_OCCUPANCY][at] += occupancy;
  sums[SUM_SQUARES][at] += square;
  sums[SUM_FACTOR][at] += visible;
  sums[SUM_TINT][at] += tint;
  for (int c = 0; c < 3; c++) sums[SUM_RED + c][at] += tint * (float)label->color[c];
}

/* Adds a label's occupancy to the sums of slice k of the map. */
static void add_label(const mask_job *job, const hl_label *label, const hl_volume *o, size_t k,
                      float *const sums[SUMS]) {
  size_t first[3];
  const size_t width = job->mask->volume->dimension[0];
  hl_occupancy_first(job->mask->volume, o, first);
  if (k < first[2] || k >= first[2] + o->dimension[2]) return;
  for (size_t j = 0; j < o->dimension[1]; j++) {
    float *line = sums[SUM_LINE];
    hl_occupancy_line(o, j, k - first[2], line);
    for (size_t i = 0; i < o->dimension[0]; i++)
      add_voxel(sums, (first[1] + j) * width + first[0] + i, label, line[i]);
  }
}

static unsigned char code_of(float value) {
  return (unsigned char)(value <= 0 ? 0 : value >= 1 ? 255 : value * 255 + 0.5f);
}

/* Stores the values of a mask's lattice at a voxel. The matter of the voxel is a mixture of the labels and
 * the rest, each with a factor of its own. A label's colour has the weight of its visible part. */
static void store_voxel(const mask_job *job, float *const sums[SUMS], size_t at, size_t voxel) {
  const float occupancy = sums[SUM_OCCUPANCY][at], tint = sums[SUM_TINT][at];
  float share = (occupancy - SHARE_FROM) / (SHARE_TO - SHARE_FROM);
  share = share < 0 ? 0 : share > 1 ? 1 : share;
  const float each = occupancy > 0 ? 1 / sums[SUM_SQUARES][at] : 0;
  const float labels = sums[SUM_FACTOR][at] * each, rest = (1 - share) * (float)job->mask->rest;
  job->factors[voxel] = (uint16_t)((share * labels + rest) * (float)HL_MASK_STEPS + 0.5f);
  if (job->colors == NULL) return;
  unsigned char *color = job->colors + HL_COLOR_BYTES * voxel;
  const float faint = share + FAINT * occupancy, visible = faint * labels + rest;
  for (int c = 0; c < 3; c++) color[c] = tint > 0 ? code_of(sqrtf(sums[SUM_RED + c][at] / tint)) : 0;
  color[3] = visible > 0 ? code_of(faint * tint * each / visible) : 0;
}

static void fill_slice(void *data, size_t k, int worker) {
  const mask_job *job = data;
  const hl_volume *map = job->mask->volume;
  const size_t count = map->dimension[0] * map->dimension[1];
  float *sums[SUMS], *own = job->sums + (size_t)worker * job->slice_floats;
  for (int s = 0; s < SUMS; s++) sums[s] = own + (size_t)s * count;
  memset(own, 0, SUM_LINE * count * sizeof *own);
  for (size_t n = 0; n < job->mask->label_count; n++)
    if (job->occupancies[n] != NULL) add_label(job, &job->mask->labels[n], job->occupancies[n], k, sums);
  for (size_t at = 0; at < count; at++) store_voxel(job, sums, at, k * count + at);
}

/* The slope along an axis, at the voxel `at`: the central difference. Beyond the lattice's ends the numbers
 * at the border repeat. Where numbers go beyond the factor 1, as behind the wall of a mesh, the factor
 * stays 1. The slope is 0 where the numbers are far beyond 1, and fades before, so that the slope's direction
 * does not depend on the lattice. */
static signed char slope_at(const mask_job *job, size_t at, size_t place, size_t count, size_t step) {
  const uint16_t *factors = job->factors;
  int before = factors[place > 0 ? at - step : at], after = factors[place + 1 < count ? at + step : at];
  double slope = (after - before) / 2.0 * (job->value_scale / job->slope_scale),
         factor = job->value_scale * factors[at] + job->value_offset;
  if (factor > 1) slope *= fmax(1 - (factor - 1) / FADING, 0);
  return (signed char)lround(fmin(fmax(slope, -INT8_MAX), INT8_MAX));
}

static void fill_slopes(void *data, size_t k, int worker) {
  const mask_job *job = data;
  const size_t *n = job->mask->volume->dimension, row = n[0], slice = n[0] * n[1];
  (void)worker;
  for (size_t j = 0; j < n[1]; j++)
    for (size_t i = 0; i < n[0]; i++) {
      size_t at = k * slice + j * row + i;
      signed char *slope = job->slopes + 4 * at;
      slope[0] = slope_at(job, at, i, n[0], 1);
      slope[1] = slope_at(job, at, j, n[1], row);
      slope[2] = slope_at(job, at, k, n[2], slice);
      slope[3] = 0;
    }
}

/* ---- bricks ---- */

/* A box of the lattice's points: first to last, both included, along each axis. */
typedef struct point_box {
  size_t first[3], last[3];
} point_box;

static point_box box_of_brick(const size_t dimension[3], const size_t brick[3]) {
  point_box box;
  for (int a = 0; a < 3; a++) {
    box.first[a] = HL_MASK_BRICK * brick[a];
    box.last[a] = box.first[a] + HL_MASK_BRICK < dimension[a] ? box.first[a] + HL_MASK_BRICK
                                                              : dimension[a] - 1;
  }
  return box;
}

/* Returns whether all points of a box have the value of the box's first point. values: [k][j][i][bytes]. */
static bool is_even(const size_t dimension[3], const void *values, size_t bytes, const point_box *box) {
  const unsigned char *from = values, *one = NULL;
  for (size_t k = box->first[2]; k <= box->last[2]; k++)
    for (size_t j = box->first[1]; j <= box->last[1]; j++)
      for (size_t i = box->first[0]; i <= box->last[0]; i++) {
        const unsigned char *at = from + ((k * dimension[1] + j) * dimension[0] + i) * bytes;
        if (one == NULL) one = at;
        else if (memcmp(one, at, bytes) != 0) return false;
      }
  return true;
}

/* Reads a word whose lowest byte comes first in memory. */
static uint32_t word_of(const unsigned char *bytes) {
  return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void bound_brick(const mask_job *job, const size_t brick[3], uint32_t words[2]) {
  const size_t *n = job->mask->volume->dimension;
  const point_box box = box_of_brick(n, brick);
  const size_t first = (box.first[2] * n[1] + box.first[1]) * n[0] + box.first[0];
  words[0] = job->factors[first];
  words[1] = job->colors != NULL ? word_of(job->colors + HL_COLOR_BYTES * first) : 0;
  if (word_of((const unsigned char *)job->slopes + 4 * first) == 0 &&
      is_even(n, job->factors, sizeof *job->factors, &box) && is_even(n, job->slopes, 4, &box))
    words[0] |= HL_MASK_EVEN;
  if (job->colors == NULL || is_even(n, job->colors, HL_COLOR_BYTES, &box)) words[0] |= HL_MASK_EVEN_COLOR;
}

static void bricks_along(const size_t dimension[3], size_t count[3]) {
  for (int a = 0; a < 3; a++) count[a] = (dimension[a] + HL_MASK_BRICK - 1) / HL_MASK_BRICK;
}

static void fill_bricks(void *data, size_t k, int worker) {
  const mask_job *job = data;
  size_t count[3];
  (void)worker;
  bricks_along(job->mask->volume->dimension, count);
  for (size_t j = 0; j < count[1]; j++)
    for (size_t i = 0; i < count[0]; i++)
      bound_brick(job, (size_t[3]){i, j, k}, job->bricks[(k * count[1] + j) * count[0] + i]);
}

static hl_status adopt(hl_context *context, mask_job *job, hl_volume **made, hl_error *error) {
  const hl_volume *map = job->mask->volume;
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  const affine3 placed = map->index_to_world;
  grid.origin[0] = placed.offset.x, grid.origin[1] = placed.offset.y, grid.origin[2] = placed.offset.z;
  for (int a = 0; a < 3; a++) {
    vec3 axis = mat3_column(placed.linear, a);
    grid.axis[a][0] = axis.x, grid.axis[a][1] = axis.y, grid.axis[a][2] = axis.z;
    grid.dimensions[a] = map->dimension[a];
  }
  grid.type = HL_VOXEL_U16;
  grid.value_scale = job->value_scale;
  grid.value_offset = job->value_offset;
  grid.space = map->space;
  hl_status status = hl_volume_adopt(context, &grid, "a mask", job->factors, made, error);
  job->factors = NULL;
  if (status != HL_OK) return status;
  (*made)->unit = map->unit;
  (*made)->colors = job->colors;
  (*made)->slopes = job->slopes;
  (*made)->slope_scale = job->slope_scale;
  (*made)->mask_bricks = job->bricks;
  job->colors = NULL;
  job->slopes = NULL;
  job->bricks = NULL;
  return HL_OK;
}

static bool any_tint(const hl_mask *mask) {
  for (size_t n = 0; n < mask->label_count; n++)
    if (mask->labels[n].tint > 0 && mask->labels[n].visible) return true;
  return false;
}

/* Fills the lattice from the labels' occupancies. */
static hl_status fill(hl_context *context, int threads, mask_job *job, hl_volume **made, hl_error *error) {
  hl_pool *pool = NULL;
  hl_status status = hl_pool_create(context, threads, &pool, error);
  if (status != HL_OK) return status;
  const hl_volume *map = job->mask->volume;
  const size_t count = hl_volume_voxel_count(map);
  job->slice_floats = SUMS * map->dimension[0] * map->dimension[1];
  job->sums = hl_allocate(context, (size_t)hl_pool_threads(pool) * job->slice_floats, sizeof *job->sums);
  job->factors = hl_allocate_zeroed(context, count + 1, sizeof *job->factors);
  job->slopes = hl_allocate(context, count, 4);
  size_t bricks[3];
  bricks_along(map->dimension, bricks);
  job->bricks = hl_allocate(context, bricks[0] * bricks[1] * bricks[2], sizeof *job->bricks);
  bool colored = any_tint(job->mask);
  if (colored) job->colors = hl_allocate(context, count, HL_COLOR_BYTES);
  if (job->sums == NULL || job->factors == NULL || job->slopes == NULL || job->bricks == NULL ||
      (colored && job->colors == NULL))
    status = hl_fail_memory(error, count * HL_COLOR_BYTES, "a mask");
  if (status == HL_OK) {
    hl_pool_run(pool, map->dimension[2], fill_slice, job);
    hl_pool_run(pool, map->dimension[2], fill_slopes, job);
    hl_pool_run(pool, bricks[2], fill_bricks, job);
    status = hl_pool_check(pool, "making a mask", error);
    if (status == HL_OK) status = adopt(context, job, made, error);
  }
  hl_pool_destroy(pool);
  hl_release(context, job->sums);
  hl_release(context, job->factors);
  hl_release(context, job->colors);
  hl_release(context, job->slopes);
  hl_release(context, job->bricks);
  return status;
}

hl_status hl_label_mask(hl_context *context, int threads, const hl_mask *mask, hl_volume **made,
                        hl_error *error) {
  *made = hl_mask_from_shelf(mask);
  if (*made != NULL) return HL_OK;
  int64_t *values = hl_allocate(context, mask->label_count + 1, sizeof *values);
  hl_volume **occupancies = hl_allocate_zeroed(context, mask->label_count + 1, sizeof(hl_volume *));
  hl_status status = HL_OK;
  if (values == NULL || occupancies == NULL)
    status = hl_fail_memory(error, mask->label_count * sizeof *values, "labels");
  for (size_t n = 0; status == HL_OK && n < mask->label_count; n++) values[n] = mask->labels[n].value;
  if (status == HL_OK)
    status = hl_label_occupancies(context, threads, mask->volume, values, mask->label_count, NULL,
                                  occupancies, error);
  mask_job job = {.mask = mask,
                  .occupancies = occupancies,
                  .slope_scale = 1 / HL_MASK_SLOPE_STEPS,
                  .value_scale = 1 / HL_MASK_STEPS};
  if (status == HL_OK) status = fill(context, threads, &job, made, error);
  if (status == HL_OK && context->whole == mask->volume->context->whole) hl_mask_to_shelf(mask, *made);
  for (size_t n = 0; occupancies != NULL && n < mask->label_count; n++) hl_volume_release(occupancies[n]);
  hl_release(context, occupancies);
  hl_release(context, values);
  return status;
}

hl_status hl_wall_mask(hl_context *context, int threads, hl_volume *wall, hl_volume **made, hl_error *error) {
  hl_pool *pool = NULL;
  const hl_mask mask = {.volume = wall};
  const size_t count = hl_volume_voxel_count(wall);
  size_t bricks[3];
  mask_job job = {.mask = &mask,
                  .value_scale = wall->value_scale,
                  .value_offset = wall->value_offset,
                  .slope_scale = wall->slope_scale};
  *made = hl_mask_from_shelf(&mask);
  if (*made != NULL) return HL_OK;
  bricks_along(wall->dimension, bricks);
  job.factors = hl_allocate(context, count + 1, sizeof *job.factors);
  job.slopes = hl_allocate(context, count, 4);
  job.bricks = hl_allocate(context, bricks[0] * bricks[1] * bricks[2], sizeof *job.bricks);
  hl_status status = job.factors == NULL || job.slopes == NULL || job.bricks == NULL
                         ? hl_fail_memory(error, count * 6, "a mask")
                         : hl_pool_create(context, threads, &pool, error);
  if (status == HL_OK) {
    memcpy(job.factors, wall->voxels, count * sizeof *job.factors);
    job.factors[count] = 0;
    hl_pool_run(pool, wall->dimension[2], fill_slopes, &job);
    hl_pool_run(pool, bricks[2], fill_bricks, &job);
    status = hl_pool_check(pool, "making a mask", error);
    if (status == HL_OK) status = adopt(context, &job, made, error);
  }
  if (status == HL_OK && context->whole == wall->context->whole) hl_mask_to_shelf(&mask, *made);
  hl_pool_destroy(pool);
  hl_release(context, job.factors);
  hl_release(context, job.slopes);
  hl_release(context, job.bricks);
  return status;
}
