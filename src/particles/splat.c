/* particles/splat.c - spreads the particles of one level over its lattice.
 *
 * In: particles, their weights and levels. Out: coefficients, added to the level's field. A particle's kernel
 * is narrowed, because the B-spline of a coefficient widens it again. Kernel and spline have the variances
 * 3/10 h^2 and s^2 / 3. So with h'^2 = h^2 - 10/9 s^2 the narrowed kernel and the spline together have the
 * variance of the kernel (derived). The kernel is sampled at the points and divided by the sum of its
 * samples, so the weight is kept whatever the samples are.
 *
 * A kernel reaches to less than eight points from its particle. Particles are dealt to tiles of at least
 * sixteen points a side. Tiles that are not neighbours touch different points, so the tiles of one colour of
 * a 2x2x2 pattern are filled in parallel: each point gets its sums in one order, and no addition needs a
 * lock. */
#include "particles/particles.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "particles/kernel.h"

enum {
  ROW = 16, /* the most points that a kernel reaches along an axis */
  LEAST_TILE = 16
};
#define NARROWING 1.11 /* a little less than 10/9 */
/* The least h', in spacings, for kernels that the level does not resolve. With it, some point always lies
 * nearer than 2 h'. */
#define LEAST_LENGTH 0.7
/* The greatest h in least spacings. The level above takes wider kernels; where there is none, they are
 * narrowed. */
#define MOST_LENGTH 3.99

typedef struct splatting {
  const hl_particle_set *set;
  const float *weights;
  const hl_particle_level *grid;
  hl_pool *pool;
  size_t tiles[3];
  uint32_t *begin;            /* owned; [tiles + 1]; the index in `listed` where a tile's particles begin */
  uint32_t *listed;           /* owned; particles by tile, in the set's order */
  double scale[3], offset[3]; /* lattice coordinate = scale * place + offset */
  double mean_square;         /* the mean of the squared spacings */
  double least_spacing;
  int color;
} splatting;

/* A particle's samples: rows along x. */
typedef struct samples {
  float row[ROW * ROW][ROW];
  int first[3], count[3]; /* points along each axis; along periodic axes some may lie outside of the field */
  float squared[3][ROW];  /* squared distances from the points of each axis, in units of h'; 4 or more is out
                           * of reach */
  float sums[ROW];        /* the n-th sum is over the n-th samples of all rows */
} samples;

static double coordinate(const splatting *s, size_t n, int axis) {
  double at = s->scale[axis] * s->set->place[n][axis] + s->offset[axis];
  double last = (double)s->grid->points[axis] - (s->grid->periodic[axis] ? 0 : 1);
  return at < 0 ? 0 : at > last ? last : at;
}

static size_t tile_of(const splatting *s, size_t n) {
  size_t tile[3];
  for (int a = 0; a < 3; a++) {
    tile[a] = (size_t)coordinate(s, n, a) * s->tiles[a] / s->grid->points[a];
    if (tile[a] >= s->tiles[a]) tile[a] = s->tiles[a] - 1;
  }
  return (tile[2] * s->tiles[1] + tile[1]) * s->tiles[0] + tile[0];
}

/* Lists the level's particles, tile by tile. */
static hl_status deal(hl_context *context, splatting *s, const uint8_t *level_of, int level,
                      const char *subject, hl_error *error) {
  size_t tiles = s->tiles[0] * s->tiles[1] * s->tiles[2], count = 0;
  for (size_t n = 0; n < s->set->count; n++) count += level_of[n] == level;
  s->begin = hl_allocate_zeroed(context, tiles + 2, sizeof *s->begin);
  s->listed = hl_allocate(context, count, sizeof *s->listed);
  if (s->begin == NULL || s->listed == NULL) return hl_fail_memory(error, count * sizeof *s->listed, subject);
  for (size_t n = 0; n < s->set->count; n++)
    if (level_of[n] == level) s->begin[tile_of(s, n) + 2]++;
  for (size_t t = 1; t < tiles + 2; t++) s->begin[t] += s->begin[t - 1];
  for (size_t n = 0; n < s->set->count; n++)
    if (level_of[n] == level) s->listed[s->begin[tile_of(s, n) + 1]++] = (uint32_t)n;
  return HL_OK;
}

static float row_across(const samples *p, int j, int k) { return p->squared[1][j] + p->squared[2][k]; }

static void sample_row(const float along[ROW], float across, float row[ROW], float sums[ROW]) {
  for (int i = 0; i < ROW; i++) row[i] = hl_sph_kernel(sqrtf(along[i] + across));
  for (int i = 0; i < ROW; i++) sums[i] += row[i];
}

/* Finds the points along an axis that the kernel reaches, and their distances. */
static void measure_axis(const hl_particle_level *grid, int axis, double at, double length, samples *p) {
  double reach = 2 * length / grid->spacing[axis];
  int first = (int)ceil(at - reach), last = (int)floor(at + reach), end = (int)grid->points[axis] - 1;
  if (!grid->periodic[axis]) {
    first = first < 0 ? 0 : first;
    last = last > end ? end : last;
  }
  p->first[axis] = first;
  p->count[axis] = last - first + 1 < ROW ? last - first + 1 : ROW;
  for (int i = 0; i < ROW; i++) {
    float away = i < p->count[axis] ? (float)((first + i - at) * grid->spacing[axis] / length) : 2;
    p->squared[axis][i] = away * away;
  }
}

/* Samples a particle's kernel; returns the sum of the samples. */
static float sample(const splatting *s, size_t n, samples *p) {
  double length = fmin((double)s->set->length[n], MOST_LENGTH * s->least_spacing),
         square = length * length - NARROWING * s->mean_square,
         narrowed = sqrt(fmax(square, LEAST_LENGTH * LEAST_LENGTH * s->mean_square));
  for (int a = 0; a < 3; a++) measure_axis(s->grid, a, coordinate(s, n, a), narrowed, p);
  memset(p->sums, 0, sizeof p->sums);
  for (int k = 0; k < p->count[2]; k++)
    for (int j = 0; j < p->count[1]; j++)
      if (row_across(p, j, k) < 4)
        sample_row(p->squared[0], row_across(p, j, k), p->row[k * ROW + j], p->sums);
  float sum = 0;
  for (int i = 0; i < ROW; i++) sum += p->sums[i];
  return sum;
}

static size_t wrapped(int index, size_t points) {
  int count = (int)points;
  return (size_t)((index % count + count) % count);
}

static void add_row(const hl_particle_level *grid, float *line, const samples *p, const float *row,
                    float scale) {
  int first = p->first[0], count = p->count[0];
  if (first >= 0 && first + count <= (int)grid->points[0])
    for (int i = 0; i < count; i++) line[first + i] += scale * row[i];
  else
    for (int i = 0; i < count; i++) line[wrapped(first + i, grid->points[0])] += scale * row[i];
}

static void splat_particle(const splatting *s, size_t n, samples *p) {
  const hl_particle_level *grid = s->grid;
  double cell = grid->spacing[0] * grid->spacing[1] * grid->spacing[2];
  double weight = s->weights != NULL ? (double)s->weights[n] : 1;
  float scale = (float)(weight / (cell * (double)sample(s, n, p)));
  for (int k = 0; k < p->count[2]; k++)
    for (int j = 0; j < p->count[1]; j++) {
      if (!(row_across(p, j, k) < 4)) continue;
      size_t y = wrapped(p->first[1] + j, grid->points[1]), z = wrapped(p->first[2] + k, grid->points[2]);
      add_row(grid, grid->field + (z * grid->points[1] + y) * grid->points[0], p, p->row[k * ROW + j], scale);
    }
}

/* The number of tiles of the colour along an axis. */
static size_t colored(const splatting *s, int axis) {
  size_t odd = (size_t)(s->color >> axis & 1);
  return (s->tiles[axis] + 1 - odd) / 2;
}

static void splat_tile(void *data, size_t index, int worker) {
  const splatting *s = data;
  size_t nx = colored(s, 0), ny = colored(s, 1);
  size_t x = 2 * (index % nx) + (size_t)(s->color & 1),
         y = 2 * (index / nx % ny) + (size_t)(s->color >> 1 & 1),
         z = 2 * (index / nx / ny) + (size_t)(s->color >> 2 & 1);
  size_t tile = (z * s->tiles[1] + y) * s->tiles[0] + x;
  samples p;
  for (size_t n = s->begin[tile]; n < s->begin[tile + 1]; n++) {
    if (n % 1024 == 0 && hl_pool_stops(s->pool, worker)) return;
    splat_particle(s, s->listed[n], &p);
  }
}

hl_status hl_particles_splat(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                             const float *weights, const uint8_t *level_of, int level,
                             const hl_particle_level *grid, const char *subject, hl_error *error) {
  splatting s = {.set = set, .weights = weights, .grid = grid, .pool = pool};
  s.least_spacing = fmin(fmin(grid->spacing[0], grid->spacing[1]), grid->spacing[2]);
  for (int a = 0; a < 3; a++) {
    s.tiles[a] = grid->points[a] / (2 * LEAST_TILE) *
                 2; /* an even number, so that the two ends of a period have two colours */
    if (s.tiles[a] == 0) s.tiles[a] = 1;
    s.scale[a] = set->unit[a] / grid->spacing[a];
    s.offset[a] = (set->low[a] - grid->low[a]) / grid->spacing[a];
    s.mean_square += grid->spacing[a] * grid->spacing[a] / 3;
  }
  hl_status status = deal(context, &s, level_of, level, subject, error);
  for (s.color = 0; status == HL_OK && s.color < 8; s.color++)
    hl_pool_run(pool, colored(&s, 0) * colored(&s, 1) * colored(&s, 2), splat_tile, &s);
  hl_release(context, s.begin);
  hl_release(context, s.listed);
  if (status == HL_OK && hl_pool_cancelled(pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject);
  return status;
}
