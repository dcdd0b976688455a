/* bricks/coarser.c - makes a coarser field (coarser.h). The builder of bricks makes it, so that the borders
 * between its bricks are smooth, too. */
#include "bricks/coarser.h"

#include <math.h>

#include "bricks/evaluate.h"
#include "core/memory.h"

typedef struct coarsening {
  const hl_bricks *fine;
  bool is_continued; /* as for hl_bricks_make_coarser() */
  hl_bricks_source source;
} coarsening;

/* A continued field is known up to this number of points beyond the last known coefficient of the old field.
 * A B-spline of the new field reaches four points of the old one. The outermost bricks of the old field hold
 * at least two points more than the matter. */
enum { BEYOND = 3, AROUND = 2 * BEYOND + 1 };

/* The coefficient at a point of a level of the new field. It is the coefficient of the old brick if this
 * brick has the same spacing, else the old field's value. */
static float number_at(const hl_bricks *fine, int level, const ptrdiff_t point[3]) {
  int64_t block[3];
  double at[3];
  size_t place = 0, width = hl_brick_width(fine);
  for (int a = 0; a < 3; a++) {
    const int64_t last = hl_bricks_cells(fine, a) - 1, step = (int64_t)1 << (level + 1);
    const int64_t x = (int64_t)point[a] * step;
    at[a] = (double)x;
    block[a] = (x < 0 ? 0 : x > last ? last : x) >> fine->shift;
  }
  const hl_brick_entry *entry = hl_bricks_entry(fine, block);
  if (entry->slot < 0) return entry->constant;
  if (entry->level != level + 1) return (float)hl_bricks_value(fine, at);
  for (int a = 2; a >= 0; a--) {
    const int64_t within = point[a] - (block[a] >> entry->level << fine->shift) + 1;
    if (within < 0 || within >= (int64_t)width) return (float)hl_bricks_value(fine, at);
    place = place * width + (size_t)within;
  }
  return hl_brick_pool(fine, entry->slot)[place];
}

/* The mean of the old field's known coefficients around a point; near ones count most. NAN if there are none.
 */
static float known_around(const hl_bricks *fine, int level, const ptrdiff_t point[3]) {
  static const int64_t count[3] = {AROUND, AROUND, AROUND};
  int64_t first[3];
  double values[AROUND * AROUND * AROUND], sum = 0, weights = 0;
  for (int a = 0; a < 3; a++) first[a] = (int64_t)point[a] * ((int64_t)1 << (level + 1)) - BEYOND;
  hl_bricks_window(fine, first, count, values);
  for (int n = 0; n < AROUND * AROUND * AROUND; n++) {
    const int x = n % AROUND - BEYOND, y = n / AROUND % AROUND - BEYOND, z = n / AROUND / AROUND - BEYOND;
    const int squared = x * x + y * y + z * z;
    if (!isfinite(values[n]) || squared == 0) continue;
    sum += values[n] / squared / squared;
    weights += 1.0 / squared / squared;
  }
  return weights > 0 ? (float)(sum / weights) : NAN;
}

static void fill(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out) {
  const coarsening *c = data;
  for (ptrdiff_t k = 0; k < (ptrdiff_t)count[2]; k++)
    for (ptrdiff_t j = 0; j < (ptrdiff_t)count[1]; j++)
      for (ptrdiff_t i = 0; i < (ptrdiff_t)count[0]; i++, out++) {
        const ptrdiff_t point[3] = {first[0] + i, first[1] + j, first[2] + k};
        *out = number_at(c->fine, level, point);
        if (c->is_continued && !isfinite(*out)) *out = known_around(c->fine, level, point);
      }
}

static bool is_outside(const coarsening *c, const hl_brick_entry *entry) {
  const float outside = c->source.outside;
  return entry->slot < 0 && (entry->constant == outside || (isnan(entry->constant) && isnan(outside)));
}

/* Splits a brick where the old field has a finer brick. Leaves a brick out where the old field has, in all of
 * it, the value that it has outside of its bricks. */
static hl_bricks_choice choose(void *data, int level, const size_t brick[3]) {
  const coarsening *c = data;
  const size_t blocks = (size_t)2 << level, *size = c->fine->directory_size;
  bool outside = true, finer = false;
  size_t at[3];
  for (at[2] = brick[2] * blocks; at[2] < (brick[2] + 1) * blocks && at[2] < size[2]; at[2]++)
    for (at[1] = brick[1] * blocks; at[1] < (brick[1] + 1) * blocks && at[1] < size[1]; at[1]++)
      for (at[0] = brick[0] * blocks; at[0] < (brick[0] + 1) * blocks && at[0] < size[0]; at[0]++) {
        const int64_t block[3] = {(int64_t)at[0], (int64_t)at[1], (int64_t)at[2]};
        const hl_brick_entry *entry = hl_bricks_entry(c->fine, block);
        outside = outside && is_outside(c, entry);
        finer = finer || entry->level <= level;
      }
  return outside ? HL_BRICKS_NOTHING : finer ? HL_BRICKS_SPLIT : HL_BRICKS_LEAF;
}

/* The field's value outside of its bricks: the constant of the first entry of the directory that has no
 * brick; 0 if all entries have bricks. */
static float number_outside(const hl_bricks *bricks) {
  const size_t *n = bricks->directory_size;
  for (size_t at = 0; at < n[0] * n[1] * n[2]; at++)
    if (bricks->directory[at].slot < 0) return bricks->directory[at].constant;
  return 0;
}

hl_status hl_bricks_make_coarser(hl_context *context, hl_pool *pool, const hl_bricks *bricks,
                                 bool is_continued, const char *subject, hl_bricks *coarser,
                                 hl_error *error) {
  coarsening c = {.fine = bricks, .is_continued = is_continued};
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  *coarser = (hl_bricks){.shift = 0};
  c.source = (hl_bricks_source){.shift = bricks->shift,
                                .levels = bricks->levels > 1 ? bricks->levels - 1 : 1,
                                .outside = number_outside(bricks),
                                .fill = fill,
                                .data = &c};
  for (int a = 0; a < 3; a++) c.source.dimension[a] = bricks->dimension[a] / 2 + 1;
  hl_status status = hl_bricks_choose(context, &c.source, choose, &c, subject, &leaves, &count, error);
  if (status == HL_OK)
    status = hl_bricks_build(context, pool, &c.source, leaves, count, subject, coarser, error);
  hl_release(context, leaves);
  for (int a = 0; a < 3 && status == HL_OK; a++) coarser->origin[a] = (bricks->origin[a] + 0.5) / 2;
  return status;
}
