/* label/row_functions.h - what smoothing labels spends most of its time on, for rows of a field. Compiled
 * once for each instruction set (row_sets.c); all give the same bytes. */
#ifndef HL_LABEL_ROW_FUNCTIONS_H
#define HL_LABEL_ROW_FUNCTIONS_H

#include <stddef.h>
#include <stdint.h>

#include <halflight/context.h>

/* How many rows on either side of the middle one the longest filter takes. */
enum { HL_FILTER_REACH = 7, HL_FILTER_ROWS = 2 * HL_FILTER_REACH + 1 };

/* A row of a field and its neighbours, [count]; at the field's ends the row itself. */
typedef struct row_neighbours {
  const float *x[3]; /* the row a voxel earlier, itself, and a voxel later */
  const float *y[2], *z[2];
} row_neighbours;

typedef struct label_row_functions {
  /* out[i] = taps[0] middle[i] + the sum over t from 1 to reach, in this order, of taps[t] (before[i] +
   * after[i]), where middle is rows[HL_FILTER_REACH], before and after the rows t before and after it. reach:
   * 2, 4 or HL_FILTER_REACH. out, [count], overlaps no row. */
  void (*weigh)(const float *taps, int reach, const float *const rows[HL_FILTER_ROWS], size_t count,
                float *out);
  /* Marks, with 1 for 0 in crossed, the voxels that the surface at `level` may cross. Returns how many of the
   * others are above the level. crossed: [count]; overlaps nothing. */
  int32_t (*find_crossed)(const row_neighbours *rows, size_t count, float level, float *crossed);
} label_row_functions;

const label_row_functions *hl_label_row_functions(hl_instruction_set set);

#endif
