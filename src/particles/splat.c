/* particles/splat.c - adds the particles of one level to its field.
 *
 * In: particles, their weights and levels. Out: coefficients, added to the level's blocks. A particle's
 * kernel is narrowed before it is sampled, because the B-splines of the coefficients widen it again. At the
 * spacing s, the kernel has the variance 3/10 h^2, and the B-spline s^2 / 3. A kernel of the length h' with
 * h'^2 = h^2 - 10/9 s^2, convolved with the B-spline, has the variance of the original kernel (derived). The
 * samples are divided by their sum, so that the particle's weight is kept exactly.
 *
 * A kernel reaches to less than eight points from its particle. Particles are sorted into tiles, whose sides
 * have at least sixteen points. The particles of a tile are summed up in a box of points, which is then added
 * to the blocks. Tiles that are not neighbours touch different points. Tiles get eight colours in a 2x2x2
 * pattern, and tiles of one colour are filled in parallel. No addition needs a lock, and each point's sums
 * are added in the same order in every run. */
#include "particles/levels.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "particles/kernel.h"

enum {
  ROW = HL_PARTICLE_ROW,
  GROUP = HL_SPH_KERNELS, /* number of points along x that are sampled together; ROW is a multiple */
  LEAST_TILE = 16,
  BOX = 2 * LEAST_TILE + ROW /* the greatest number of points of a tile's box along an axis */
};

typedef struct splatting {
  const hl_particle_set *set;
  const float *weights;
  hl_particle_field *field;
  int level;
  hl_particle_level grid;
  hl_pool *pool;
  size_t tiles[3];         /* number of tiles along each axis: 1 or an even number */
  hl_block_table occupied; /* tiles that have particles */
  uint32_t *begin;         /* owned; [occupied tiles + 1]; for each tile, the index in `listed` of its first
                            * particle */
  uint32_t *listed;        /* owned; indices of particles, tile by tile, in the set's order within a tile */
  uint32_t *of_color;      /* owned; [occupied tiles]; the tiles of the colour that is being filled */
  float *boxes;            /* owned; [threads][BOX^3] */
} splatting;

typedef hl_sph_group group;

/* The samples of one particle's kernel, as rows along x. */
typedef struct samples {
  float row[ROW * ROW][ROW];
  int first[3], count[3]; /* the first point and the number of points along each axis; along periodic axes
                           * some may lie outside of the field */
  int groups;             /* number of groups of a row that have points which the kernel reaches */
  float squared[3][ROW];  /* along each axis: the squared distances from the particle to the points, in units
                           * of h'^2; points where their sum is 4 or more are out of reach */
  float sums[ROW];        /* sums[n] is the sum of row[..][n] over all rows; 0 beyond the groups */
} samples;

/* ---- tiles ---- */

static void find_tile(const splatting *s, size_t n, int32_t tile[3]) {
  for (int a = 0; a < 3; a++) {
    size_t at = (size_t)(hl_particle_coordinate(s->set, &s->grid, n, a) * (double)s->tiles[a] /
                         (double)s->grid.points[a]);
    tile[a] = (int32_t)(at < s->tiles[a] ? at : s->tiles[a] - 1);
  }
}

/* Lists the level's particles, tile by tile. */
static hl_status deal(hl_context *context, splatting *s, const char *subject, hl_error *error) {
  const uint8_t *level_of = s->field->plan->level_of;
  size_t count = 0, number;
  int32_t tile[3];
  for (size_t n = 0; n < s->set->count; n++) count += level_of[n] == s->level;
  uint32_t *tile_of = hl_allocate(context, count, sizeof *tile_of), *next = tile_of;
  s->listed = hl_allocate(context, count, sizeof *s->listed);
  hl_status status = tile_of != NULL && s->listed != NULL
                         ? HL_OK
                         : hl_fail_memory(error, count * sizeof *s->listed, subject);
  for (size_t n = 0; status == HL_OK && n < s->set->count; n++) {
    if (level_of[n] != s->level) continue;
    find_tile(s, n, tile);
    status = hl_block_add(context, &s->occupied, tile, subject, &number, error);
    *next++ = (uint32_t)number;
  }
  s->begin = hl_allocate_zeroed(context, s->occupied.count + 2, sizeof *s->begin);
  s->of_color = hl_allocate(context, s->occupied.count, sizeof *s->of_color);
  if (status == HL_OK && (s->begin == NULL || s->of_color == NULL))
    status = hl_fail_memory(error, (s->occupied.count + 2) * sizeof *s->begin, subject);
  if (status == HL_OK) {
    for (size_t n = 0; n < count; n++) s->begin[tile_of[n] + 2]++;
    for (size_t t = 1; t < s->occupied.count + 2; t++) s->begin[t] += s->begin[t - 1];
    next = tile_of;
    for (size_t n = 0; n < s->set->count; n++)
      if (level_of[n] == s->level) s->listed[s->begin[*next++ + 1]++] = (uint32_t)n;
  }
  hl_release(context, tile_of);
  return status;
}

/* ---- samples ---- */

static float row_across(const samples *p, int j, int k) { return p->squared[1][j] + p->squared[2][k]; }

static group roots(group squares) {
  float root[GROUP];
  memcpy(root, &squares, sizeof root);
  for (int i = 0; i < GROUP; i++)
    root[i] = sqrtf(root[i]); /* the compiler makes one instruction of the loop */
  memcpy(&squares, root, sizeof root);
  return squares;
}

static void sample_group(const float along[GROUP], float across, float row[GROUP], float sums[GROUP]) {
  group squares, sum;
  memcpy(&squares, along, sizeof squares);
  memcpy(&sum, sums, sizeof sum);
  const group value = hl_sph_kernels(roots(squares + across));
  sum += value;
  memcpy(row, &value, sizeof value);
  memcpy(sums, &sum, sizeof sum);
}

/* Samples the row (j, k). Many kernels are as narrow as the lattice can show and reach one group, so that
 * whole rows would cost several times as much. */
static void sample_row(samples *p, int j, int k) {
  const float across = row_across(p, j, k);
  float *row = p->row[k * ROW + j];
  for (int i = 0; i < GROUP * p->groups; i += GROUP)
    sample_group(p->squared[0] + i, across, row + i, p->sums + i);
}

/* Finds the points along an axis that the kernel reaches, and their distances. */
static void measure_axis(const hl_particle_level *grid, int axis, double at, double narrowed, samples *p) {
  int range[2];
  hl_particle_range(grid, axis, at, narrowed, range);
  p->first[axis] = range[0];
  p->count[axis] = range[1] - range[0] + 1;
  for (int i = 0; i < p->count[axis]; i++) {
    float away = (float)((range[0] + i - at) * grid->spacing[axis] / narrowed);
    p->squared[axis][i] = away * away;
  }
}

/* Samples a particle's kernel; returns the sum of the samples. */
static float sample(const splatting *s, size_t n, samples *p) {
  const double narrowed = hl_particle_narrowed(s->set, &s->grid, n);
  for (int a = 0; a < 3; a++)
    measure_axis(&s->grid, a, hl_particle_coordinate(s->set, &s->grid, n, a), narrowed, p);
  p->groups = (p->count[0] + GROUP - 1) / GROUP;
  for (int i = p->count[0]; i < GROUP * p->groups; i++) p->squared[0][i] = 4;
  memset(p->sums, 0, sizeof p->sums);
  for (int k = 0; k < p->count[2]; k++)
    for (int j = 0; j < p->count[1]; j++)
      if (row_across(p, j, k) < 4) sample_row(p, j, k);
  float sum = 0;
  for (int i = 0; i < ROW; i++) sum += p->sums[i];
  return sum;
}

/* ---- the box of a tile ---- */

typedef struct point_box {
  ptrdiff_t first[3];
  size_t count[3];
  float *points; /* [z][y][x] */
} point_box;

static void find_box(const splatting *s, size_t tile, point_box *box) {
  int low[3] = {INT32_MAX, INT32_MAX, INT32_MAX}, high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
  for (size_t at = s->begin[tile]; at < s->begin[tile + 1]; at++) {
    const size_t n = s->listed[at];
    const double narrowed = hl_particle_narrowed(s->set, &s->grid, n);
    for (int a = 0; a < 3; a++) {
      int range[2];
      hl_particle_range(&s->grid, a, hl_particle_coordinate(s->set, &s->grid, n, a), narrowed, range);
      low[a] = range[0] < low[a] ? range[0] : low[a];
      high[a] = range[1] > high[a] ? range[1] : high[a];
    }
  }
  for (int a = 0; a < 3; a++) box->first[a] = low[a], box->count[a] = (size_t)(high[a] - low[a] + 1);
  memset(box->points, 0, box->count[0] * box->count[1] * box->count[2] * sizeof *box->points);
}

static void splat_particle(const splatting *s, size_t n, const point_box *box, samples *p) {
  const hl_particle_level *grid = &s->grid;
  double cell = grid->spacing[0] * grid->spacing[1] * grid->spacing[2];
  double weight = s->weights != NULL ? (double)s->weights[n] : 1;
  float scale = (float)(weight / (cell * (double)sample(s, n, p)));
  for (int k = 0; k < p->count[2]; k++)
    for (int j = 0; j < p->count[1]; j++) {
      if (!(row_across(p, j, k) < 4)) continue;
      size_t y = (size_t)(p->first[1] + j - box->first[1]), z = (size_t)(p->first[2] + k - box->first[2]);
      float *line = box->points + (z * box->count[1] + y) * box->count[0] + (p->first[0] - box->first[0]);
      for (int i = 0; i < p->count[0]; i++) line[i] += scale * p->row[k * ROW + j][i];
    }
}

static void splat_tile(void *data, size_t index, int worker) {
  const splatting *s = data;
  size_t tile = s->of_color[index];
  point_box box = {.points = s->boxes + (size_t)worker * BOX * BOX * BOX};
  samples p;
  find_box(s, tile, &box);
  for (size_t at = s->begin[tile]; at < s->begin[tile + 1]; at++) {
    if (at % 1024 == 0 && hl_pool_stops(s->pool, worker)) return;
    splat_particle(s, s->listed[at], &box, &p);
  }
  hl_particle_field_add(s->field, s->level, box.first, box.count, box.points);
}

static void splat_color(splatting *s, int color) {
  size_t count = 0;
  for (size_t t = 0; t < s->occupied.count; t++) {
    const int32_t *at = s->occupied.place[t];
    if (((at[0] & 1) | (at[1] & 1) << 1 | (at[2] & 1) << 2) == color) s->of_color[count++] = (uint32_t)t;
  }
  hl_pool_run(s->pool, count, splat_tile, s);
}

hl_status hl_particles_splat(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                             const float *weights, hl_particle_field *field, int level, const char *subject,
                             hl_error *error) {
  splatting s = {.set = set, .weights = weights, .field = field, .level = level, .pool = pool};
  size_t floats = (size_t)hl_pool_threads(pool) * BOX * BOX * BOX;
  s.grid = hl_particle_level_of(set, &field->plan->lattice, level);
  for (int a = 0; a < 3; a++) {
    s.tiles[a] = s.grid.points[a] / (2 * LEAST_TILE) *
                 2; /* The number is even, so that two tiles that meet at the border of a period have
                     * different colours. */
    if (s.tiles[a] == 0) s.tiles[a] = 1;
  }
  s.boxes = hl_allocate(context, floats, sizeof *s.boxes);
  hl_status status = s.boxes != NULL ? deal(context, &s, subject, error)
                                     : hl_fail_memory(error, floats * sizeof *s.boxes, subject);
  for (int color = 0; status == HL_OK && color < 8; color++) splat_color(&s, color);
  hl_block_table_release(context, &s.occupied);
  hl_release(context, s.begin);
  hl_release(context, s.listed);
  hl_release(context, s.of_color);
  hl_release(context, s.boxes);
  if (status == HL_OK && hl_pool_cancelled(pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject);
  return status;
}
