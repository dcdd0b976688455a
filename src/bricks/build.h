/* bricks/build.h - makes a field at levels from a source that knows coefficients of its own at each level.
 *
 * In:  which bricks there are, each at the level of its own, and a function that gives coefficients.
 * Out: hl_bricks whose field has continuous second derivatives, whatever the arrangement of levels is.
 *
 * The coefficient i of level l is active if the cells i - 2 .. i + 1 of that level, along all axes, lie in
 * bricks of level l or finer, or where there is no brick. An active coefficient is the source's own. Any
 * other is the subdivided coefficients of level l + 1 (truncated hierarchical B-splines, see bricks.h). The
 * field is then the coarser level's field plus a sum of B-splines of level l, each of which is zero where a
 * coarser brick lies: so no border shows. */
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
  float outside; /* the value where there is no leaf. Leaves beside such blocks are not changed there, so
                  * the source's own coefficients must be `outside` at their borders, unless the field is to
                  * end there in a step */
  /* Gives the source's own coefficients of the points first .. first + count - 1 of a level: out is
   * [count[2]][count[1]][count[0]], x fastest. first may be below 0, and points may lie beyond the dimension.
   * Bricks ask for coefficients of their own level, and, beside coarser bricks, for those of coarser levels
   * around their borders. Called from all threads: must give the same number for a point in every call. */
  void (*fill)(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out);
  /* May be null. Narrows the places where a level has coefficients of its own, for sources whose data do not
   * end at the borders of bricks: sets covered[n], [count[2]][count[1]][count[0]], to 1 for each cell first
   * .. first
   * + count - 1 of a level for which there are data of this level or a finer one, else to 0. A coefficient is
   * then active only if its cells i - 2 .. i + 1 are all covered. The coarsest level is not asked. Called
   * from all threads. */
  void (*cover)(void *data, int level, const ptrdiff_t first[3], const size_t count[3],
                unsigned char *covered);
  void *data; /* for fill and cover */
} hl_bricks_source;

/* Tells for a brick of a level, in hl_bricks_choose(), what becomes of it. */
typedef enum hl_bricks_choice { HL_BRICKS_NOTHING, HL_BRICKS_LEAF, HL_BRICKS_SPLIT } hl_bricks_choice;

/* Lists leaves by descending from the bricks of the coarsest level: `choose` is called for a brick and says
 * whether it is a leaf, is split into the eight bricks of the next finer level, or is left out. A brick of
 * level 0 that is to be split is a leaf. source: fill may be null. *leaves is owned by the caller
 * (hl_release); in the order of the descent. */
hl_status hl_bricks_choose(hl_context *context, const hl_bricks_source *source,
                           hl_bricks_choice (*choose)(void *data, int level, const size_t brick[3]),
                           void *data, hl_bricks_leaf **leaves, size_t *count, hl_error *error);

/* Makes the bricks of the leaves. Leaves may lie partly beyond the dimension. Two leaves that cover the same
 * place are refused. A brick whose coefficients are all the same number becomes a constant of the directory.
 * The bytes are the same for any number of threads. subject: starts error lines. *bricks is empty on failure.
 * Memory: the directory, and (side + 3)^3 floats for each leaf until constants are known. */
hl_status hl_bricks_build(hl_context *context, hl_pool *pool, const hl_bricks_source *source,
                          const hl_bricks_leaf *leaves, size_t count, const char *subject, hl_bricks *bricks,
                          hl_error *error);

void hl_bricks_release(hl_context *context, hl_bricks *bricks);

#endif
