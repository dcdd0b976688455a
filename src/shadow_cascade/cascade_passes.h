/* shadow_cascade/cascade_passes.h - passes over whole fields of a cascade: a row of tiles a task; tiles of
 * zeros are skipped. */
#ifndef HL_SHADOW_CASCADE_CASCADE_PASSES_H
#define HL_SHADOW_CASCADE_CASCADE_PASSES_H

#include "shadow_cascade/cascade.h"

/* Rows of tiles are worked on in parts, so that threads end at the same time. */
enum { ROW_PIECES = 2 };
typedef struct row_piece {
  int y, first, end;
} row_piece; /* tiles */

static inline size_t hl_cascade_row_pieces(const cascade_level *level) {
  return (size_t)level->tiles_y * ROW_PIECES;
}
static inline row_piece hl_cascade_row_piece(const cascade_level *level, size_t index) {
  int piece = (int)(index % ROW_PIECES);
  return (row_piece){(int)(index / ROW_PIECES), level->tiles_x * piece / ROW_PIECES,
                     level->tiles_x * (piece + 1) / ROW_PIECES};
}

/* How much a pass blurs. */
typedef struct cascade_blur {
  double
      variance; /* where the light is widest, pixels of the level; columns and rows have their parts of it */
  double resampled[2]; /* along rows and columns: what resampling blurs by itself, and is taken off */
} cascade_blur;

/* to = a + (1 - thin) b, each on its level, which may be twice as fine (both) or, for b, twice as coarse;
 * thin, on a's level, may be null; so may b where a is not coarser, and a where b is. Found where it lies
 * within `reach` pixels of the buffer of what is read; READ_EVERYWHERE: in all tiles. */
void hl_cascade_add(const cascade_crew *crew, const cascade_level *level_a, const cascade_field *a,
                    const cascade_field *thin, const cascade_level *level_b, const cascade_field *b,
                    const cascade_level *level, const cascade_field *to, int reach);

/* to = a + (1 - thin) blurred from, all on one level; a and thin may be null. reach: as above. */
void hl_cascade_blur_add(const cascade_crew *crew, const cascade_level *level, const cascade_field *from,
                         const cascade_field *a, const cascade_field *thin, const cascade_field *to,
                         cascade_blur blur, int reach);

/* One channel of what a group holds. */
typedef struct cascade_matter {
  const cascade_field *absorbed, *thin;
} cascade_matter;

/* Two groups' matter to the next level, which may be twice as coarse: a's and b's, but for the part `late` of
 * b's, are added to the first there, that part becomes the second; b is changed, spare fields of its level
 * are used. One row of tiles after the other goes all the way. */
void hl_cascade_merge(const cascade_crew *crew, const cascade_level *level, const cascade_matter *a,
                      const cascade_matter *b, double late, const cascade_matter *spare,
                      const cascade_level *next, const cascade_matter *first, const cascade_matter *second);

/* Pixels of the buffer that doubling reads beyond those that it finds, from pixels of one scale down to
 * another's. */
int hl_cascade_doubling_reach(int from, int to);

/* True if all tiles of the level's rectangle are zeros; what lies outside is. */
bool hl_cascade_all_zeros(const cascade_level *level, const cascade_field *field, int x0, int x1, int y0,
                          int y1);

/* Makes a tile's pixels zeros. */
void hl_cascade_clear_pixels(const cascade_level *level, const cascade_field *field, int x, int y);

/* Makes a tile zeros, and says so; most are already. */
static inline void hl_cascade_clear_tile(const cascade_level *level, const cascade_field *field, int x,
                                         int y) {
  unsigned char *zeros = &field->zeros[y * level->tiles_x + x];
  if (!*zeros) hl_cascade_clear_pixels(level, field, x, y);
  *zeros = 1;
}

#endif
