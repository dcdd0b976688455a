/* shadow_cascade/cascade_passes.h - declares passes over whole fields of a cascade. A task of a pass works on
 * a piece of a row of tiles, and skips tiles that are all zeros. */
#ifndef HL_SHADOW_CASCADE_CASCADE_PASSES_H
#define HL_SHADOW_CASCADE_CASCADE_PASSES_H

#include "shadow_cascade/cascade.h"

/* The number of pieces into which rows of tiles are divided, so that threads finish at about the same
 * time. */
enum { ROW_PIECES = 2 };
typedef struct row_piece {
  int y, first, end;
  /* y: the row of tiles; first, end: the piece's columns of tiles, from `first` to `end` - 1 */
} row_piece;

static inline size_t hl_cascade_row_pieces(const cascade_level *level) {
  return (size_t)level->tiles_y * ROW_PIECES;
}
static inline row_piece hl_cascade_row_piece(const cascade_level *level, size_t index) {
  int piece = (int)(index % ROW_PIECES);
  return (row_piece){(int)(index / ROW_PIECES), level->tiles_x * piece / ROW_PIECES,
                     level->tiles_x * (piece + 1) / ROW_PIECES};
}

/* The blur of a pass over a field. */
typedef struct cascade_blur {
  double variance;     /* the variance of the blur where the light is widest, in squared pixels of the level;
                        * columns and rows of tiles have fractions of this variance */
  double resampled[2]; /* the variance, along rows and along columns, by which resampling blurs; this variance
                        * is subtracted from `variance` */
} cascade_blur;

/* A sum of fields: to = a + (1 - thin) b. In one kind of sum, a and b are on the level of `to`, or on a level
 * twice as fine. In the other kind, a is on the level of `to`, and b is on a level twice as coarse. */
typedef struct cascade_sum {
  const cascade_level *level_a;  /* the level of the fields a and thin */
  const cascade_field *a, *thin; /* a may be null, which stands for zeros, only if b is coarser than `to`.
                                  * thin may be null, which stands for zeros */
  const cascade_level *level_b;  /* the level of the field b; null if b is null */
  const cascade_field *b;        /* may be null, which stands for zeros, only if a is not coarser than `to` */
  const cascade_level *level;    /* the level of the field `to` */
  const cascade_field *to;
  int reach; /* `to` is computed in the tiles that are read, and within this many pixels of the buffer around
              * these tiles. READ_EVERYWHERE: `to` is computed in all tiles */
} cascade_sum;
void hl_cascade_add(const cascade_crew *crew, const cascade_sum *sum);

/* A sum with a blur: to = a + (1 - thin) * (from, blurred). All fields are on one level. */
typedef struct cascade_blurred_sum {
  const cascade_level *level;
  const cascade_field *from, *a, *thin, *to; /* a and thin may be null, which stands for zeros */
  cascade_blur blur;
  /* `to` is computed in the tiles that are read, and within this number of pixels of the buffer around these
   * tiles */
  int reach;
} cascade_blurred_sum;
void hl_cascade_blur_add(const cascade_crew *crew, const cascade_blurred_sum *sum);

/* The fields of one colour channel of a group. */
typedef struct cascade_matter {
  const cascade_field *absorbed, *thin;
} cascade_matter;

/* Moves the matter of two groups, a and b, to the next level, which may be twice as coarse. On the next
 * level, the fraction `late` of b's matter becomes the group `second`; the rest of b's matter and the matter
 * of a are added to the group `first`. */
typedef struct cascade_merger {
  const cascade_level *level;
  cascade_matter a, b;  /* fields of the level `level`; the fields of b are overwritten */
  cascade_matter spare; /* fields of the level `level` for intermediate results */
  double late;          /* the fraction of b's matter that goes to `second` */
  const cascade_level *next;
  cascade_matter first, second; /* fields of the level `next` */
} cascade_merger;
/* The number of sums that a merge takes after the groups are split. */
enum { MERGE_SUMS = 6 };
void hl_cascade_find_merge_sums(const cascade_merger *merger, cascade_sum sums[MERGE_SUMS]);
/* Merges two groups. Each row of tiles goes through all steps before the next row begins. */
void hl_cascade_merge(const cascade_crew *crew, const cascade_merger *merger);

/* The task of adding the light that a chunk's slabs absorbed to the groups at the chunk's two ends. */
typedef struct cascade_absorption {
  const soft_cascade *cascade;
  const shadow_buffer *buffer; /* null if the buffer is in the memory of a device */
  cascade_group *start, *end;
  double length; /* length of the chunk, measured in omega */
  int edge;      /* the width in pixels of a strip along the edges of opaque surfaces, as in absorbed_job */
  bool any;      /* whether any pixel of cascade->absorbed is not zero */
} cascade_absorption;

/* The task of refilling the shadow buffer from cascade->absorbed. */
typedef struct cascade_refilling {
  soft_cascade *cascade;
  shadow_buffer *buffer; /* null if the buffer is in the memory of a device */
  int sheet;
  bool any; /* whether any pixel of cascade->absorbed is not zero */
} cascade_refilling;

/* Bits of cascade->refilled for a tile of the shadow buffer, which is filled anew from the blurred light at
 * each chunk of sheets' end. REFILLED_BEFORE: the tile was filled anew at the start of the current chunk.
 * REFILLED_NOW: the tile was filled anew at the end of the current chunk. */
enum { REFILLED_BEFORE = 1, REFILLED_NOW = 2 };

/* The functions that make the passes over a cascade's fields: on the processors, or on a device. */
typedef struct cascade_works {
  void (*add)(const cascade_crew *crew, const cascade_sum *sum);
  void (*blur_add)(const cascade_crew *crew, const cascade_blurred_sum *sum);
  void (*merge)(const cascade_crew *crew, const cascade_merger *merger);
  /* Adds the light that a chunk's slabs absorbed to the groups. Returns whether the slabs absorbed any
   * light. */
  bool (*absorb)(const cascade_crew *crew, const cascade_absorption *absorption);
  void (*refill)(const cascade_crew *crew, const cascade_refilling *refilling);
} cascade_works;

/* Finds the boxes of a blur for each column and row of tiles, and stores them in level->boxes. */
void hl_cascade_find_boxes(const cascade_level *level, const cascade_blur *blur, int *reach_x, int *reach_y);

/* The number of pixels beyond its output that repeated doubling reads, from the scale `from` down to the
 * scale `to`; in pixels of the buffer. */
int hl_cascade_doubling_reach(int from, int to);

/* Returns whether all tiles of a rectangle are zeros. Tiles outside the level count as zeros. */
bool hl_cascade_all_zeros(const cascade_level *level, const cascade_field *field, int x0, int x1, int y0,
                          int y1);

/* Sets all pixels of a tile to zero. */
void hl_cascade_clear_pixels(const cascade_level *level, const cascade_field *field, int x, int y);

/* Sets all pixels of a tile to zero and marks the tile as zeros, unless it is marked already. */
static inline void hl_cascade_clear_tile(const cascade_level *level, const cascade_field *field, int x,
                                         int y) {
  unsigned char *zeros = &field->zeros[y * level->tiles_x + x];
  if (!*zeros) hl_cascade_clear_pixels(level, field, x, y);
  *zeros = 1;
}

#endif
