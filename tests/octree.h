/* octree.h - random fields at levels (bricks/build.h) for tests. Bricks are split at random, and a formula
 * gives the coefficients. */
#ifndef HL_TESTS_OCTREE_H
#define HL_TESTS_OCTREE_H

#include "bricks/build.h"
#include "core/memory.h"

/* The coefficient of a point of a level. */
typedef double octree_value(uint64_t seed, int level, const ptrdiff_t point[3]);

typedef struct octree {
  uint64_t seed;
  octree_value *value;
} octree;

/* A number from 0 to 1 that follows from two numbers. */
static inline double octree_random(uint64_t seed, uint64_t number) {
  uint64_t key = (seed + 1) * 0x9e3779b97f4a7c15u + number;
  key = (key ^ (key >> 31)) * 0x7fb5d329728ea185u;
  key = (key ^ (key >> 27)) * 0x81dadef4bc2dd44du;
  key ^= key >> 33;
  return (double)(key >> 11) / 9007199254740992.0;
}

static inline double octree_random_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  uint64_t key = (uint64_t)level;
  for (int axis = 0; axis < 3; axis++) key = key * 1000003 + (uint64_t)(point[axis] + 4096);
  return octree_random(seed, key);
}

static inline double octree_constant_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed, (void)level, (void)point;
  return 0.75;
}

static inline double octree_linear_at(const double point[3]) {
  return 3 + 0.5 * point[0] - 0.25 * point[1] + 2 * point[2];
}
static inline double octree_linear_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed;
  double scale = (double)(1 << level);
  return octree_linear_at(
      (const double[3]){scale * (double)point[0], scale * (double)point[1], scale * (double)point[2]});
}

static inline void octree_fill(void *data, int level, const ptrdiff_t first[3], const size_t count[3],
                               float *out) {
  const octree *source = data;
  size_t n = 0;
  for (ptrdiff_t k = 0; k < (ptrdiff_t)count[2]; k++)
    for (ptrdiff_t j = 0; j < (ptrdiff_t)count[1]; j++)
      for (ptrdiff_t i = 0; i < (ptrdiff_t)count[0]; i++)
        out[n++] = (float)source->value(source->seed, level,
                                        (const ptrdiff_t[3]){first[0] + i, first[1] + j, first[2] + k});
}

static inline hl_bricks_choice octree_choose(void *data, int level, const size_t brick[3]) {
  const octree *source = data;
  const ptrdiff_t at[3] = {(ptrdiff_t)brick[0], (ptrdiff_t)brick[1], (ptrdiff_t)brick[2]};
  return octree_random_value(source->seed + 17, level, at) < 0.6 ? HL_BRICKS_SPLIT : HL_BRICKS_LEAF;
}

/* Makes a field that covers the points. threads: of the pool that builds it. */
static inline void octree_build(hl_context *context, int threads, octree *data, const size_t dimension[3],
                                int shift, int levels, hl_bricks *bricks) {
  hl_bricks_source source = {.shift = shift, .levels = levels, .fill = octree_fill, .data = data};
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  hl_pool *pool = NULL;
  for (int axis = 0; axis < 3; axis++) source.dimension[axis] = dimension[axis];
  assert_int_equal(hl_pool_create(context, threads, &pool, NULL), HL_OK);
  assert_int_equal(hl_bricks_choose(context, &source, octree_choose, data, "a field", &leaves, &count, NULL),
                   HL_OK);
  assert_int_equal(hl_bricks_build(context, pool, &source, leaves, count, "octree", bricks, NULL), HL_OK);
  hl_release(context, leaves);
  hl_pool_destroy(pool);
}

#endif
