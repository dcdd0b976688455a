/* label/row_functions.h - the functions on rows of a field that take most of the time of smoothing labels.
 * They are compiled once for each instruction set (row_sets.c), and all versions give the same bytes. */
#ifndef HL_LABEL_ROW_FUNCTIONS_H
#define HL_LABEL_ROW_FUNCTIONS_H

#include <stddef.h>
#include <stdint.h>

#include <halflight/context.h>

/* HL_FILTER_REACH rows on either side of the middle one enter the longest filter. */
enum { HL_FILTER_REACH = 7, HL_FILTER_ROWS = 2 * HL_FILTER_REACH + 1 };

/* A row of a field and its neighbours, [count]. At the field's ends the row itself takes the place of a
 * neighbour that is missing. */
typedef struct row_neighbours {
  const float *x[3]; /* the row a voxel earlier, the row itself, and the row a voxel later */
  const float *y[2], *z[2];
} row_neighbours;

typedef struct label_row_functions {
  /* Sets out[i] to taps[0] middle[i] + the sum over t from 1 to reach, in this order, of taps[t] (before[i] +
   * after[i]). middle is rows[HL_FILTER_REACH]; before and after are the rows t before and t after it. reach:
   * 2, 4 or HL_FILTER_REACH. out, [count], overlaps no row. */
  void (*weigh)(const float *taps, int reach, const float *const rows[HL_FILTER_ROWS], size_t count,
                float *out);
  /* Sets the elements of `crossed` to 1 for voxels that the surface at `level` may cross, and to 0 for the
   * others. Returns how many of the others are above the level. crossed: [count]; overlaps nothing. */
  int32_t (*find_crossed)(const row_neighbours *rows, size_t count, float level, float *crossed);
} label_row_functions;

const label_row_functions *hl_label_row_functions(hl_instruction_set set);

#endif
