/* bricks/build.h - makes a field at levels from a source that knows coefficients of its own at each level.
 *
 * In:  the list of bricks, each with its level, and a function that gives coefficients. Out: hl_bricks whose
 * field has continuous second derivatives, whatever the arrangement of levels is.
 *
 * Coefficient i of level l depends on the cells i - 2 .. i + 1 of its level, along all axes. It is active if
 * none of these cells lies in a brick of a coarser level. The source gives the active coefficients. Any other
 * coefficient is subdivided from the coefficients of level l + 1 (truncated hierarchical B-splines, see
 * bricks.h). The field is then the coarser level's field plus a sum of B-splines of level l, each of which is
 * zero in all coarser bricks. Therefore the borders between levels cannot be seen. */
#ifndef HL_BRICKS_BUILD_H
#define HL_BRICKS_BUILD_H

#include "bricks/bricks.h"
#include "core/error.h"
#include "core/pool.h"

/* A brick that is to be made: the cells brick[a] side .. brick[a] side + side - 1 of its level. */
typedef struct hl_bricks_leaf {
  int level;
  size_t brick[3]; /* x, y, z */
} hl_bricks_leaf;

typedef struct hl_bricks_source {
  int shift;           /* side = 2^shift cells; 2 to 8 */
  int levels;          /* 1 .. BRICK_LEVELS_LIMIT */
  size_t dimension[3]; /* lattice points of level 0 along x, y, z */
  /* The field's value where there is no leaf. At the border of a leaf the field jumps to this value, unless
   * the source's own coefficients at the border equal `outside`. The builder does not change these
   * coefficients. */
  float outside;
  /* Gives the source's own coefficients of the points first .. first + count - 1 of a level: out is
   * [count[2]][count[1]][count[0]], x fastest. first may be below 0, and points may lie beyond the dimension.
   * A brick asks for coefficients of its own level and, beside a coarser brick, for coefficients of coarser
   * levels around its border. The function is called from all threads, and must give the same number for a
   * point in every call. */
  void (*fill)(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out);
  /* Tells which cells have data, for sources whose data do not end at the borders of bricks. May be null. For
   * each of the cells first .. first + count - 1 of a level, the function sets an element of covered,
   * [count[2]][count[1]][count[0]]: to 1 where there are data of this level or of a finer level, else to 0. A
   * coefficient is then active only if its cells i - 2 .. i + 1 are all covered. The function is called from
   * all threads, and never for the coarsest level. */
  void (*cover)(void *data, int level, const ptrdiff_t first[3], const size_t count[3],
                unsigned char *covered);
  void *data; /* for fill and cover */
} hl_bricks_source;

/* The number of coefficients of a brick. */
static inline size_t brick_points(int shift) {
  const size_t side = ((size_t)1 << shift) + BRICK_MARGIN;
  return side * side * side;
}

/* Tells hl_bricks_choose() whether a brick of a level is left out, becomes a leaf, or is split into eight
 * finer bricks. */
typedef enum hl_bricks_choice { HL_BRICKS_NOTHING, HL_BRICKS_LEAF, HL_BRICKS_SPLIT } hl_bricks_choice;

/* Lists leaves by descending from the bricks of the coarsest level: `choose` is called for a brick and tells
 * whether it is a leaf, is split into the eight bricks of the next finer level, or is left out. A brick of
 * level 0 that `choose` would split is a leaf. source: its `fill` may be null. *leaves is in the order of the
 * descent, and is owned by the caller (hl_release). subject: starts error lines. Fails for lack of memory,
 * also where the memory limit has no room for the field's directory or for the leaves' coefficients, and when
 * cancelled. */
hl_status hl_bricks_choose(hl_context *context, const hl_bricks_source *source,
                           hl_bricks_choice (*choose)(void *data, int level, const size_t brick[3]),
                           void *data, const char *subject, hl_bricks_leaf **leaves, size_t *count,
                           hl_error *error);

/* Makes the bricks of the leaves. A leaf may lie partly beyond the source's dimension. Two leaves that cover
 * the same place are refused. A brick whose coefficients are all the same number becomes a constant of the
 * directory. The bytes are the same for any number of threads. subject: starts error lines. *bricks is empty
 * on failure. Memory: the directory, and (side + 3)^3 floats for each leaf; floats of constant bricks are
 * freed at the end. */
hl_status hl_bricks_build(hl_context *context, hl_pool *pool, const hl_bricks_source *source,
                          const hl_bricks_leaf *leaves, size_t count, const char *subject, hl_bricks *bricks,
                          hl_error *error);

void hl_bricks_release(hl_context *context, hl_bricks *bricks);

#endif
