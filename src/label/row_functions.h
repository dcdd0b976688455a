/* label/row_functions.h - declares functions on rows and voxels of a field, which take most of the time when
 * labels are smoothed. The functions are compiled once for each instruction set (row_sets.c), and give the
 * same bytes with every set. */
#ifndef HL_LABEL_ROW_FUNCTIONS_H
#define HL_LABEL_ROW_FUNCTIONS_H

#include <stddef.h>
#include <stdint.h>

#include <halflight/context.h>

/* The longest filter reads HL_FILTER_REACH rows on either side of the middle row. */
enum { HL_FILTER_REACH = 7, HL_FILTER_ROWS = 2 * HL_FILTER_REACH + 1 };

/* A voxel that the surface may cross is measured in HL_VOXEL_PARTS parts along each axis. The fraction of a
 * part that is enclosed is computed as if the surface within the part were a plane. The parts are small
 * enough for this, even if the surface is a ball of three voxels. The parts of a voxel depend on
 * HL_VOXEL_TAPS coefficients along an axis. */
enum { HL_VOXEL_PARTS = 4, HL_VOXEL_TAPS = 5 };

/* Sums over voxels. VOLUME: the enclosed volume, in voxels. FALL: the rate at which this volume falls as the
 * level rises. SLOPES: the lengths of the gradients in the parts of voxels at the surface. SURFACE_PARTS: the
 * number of these parts. */
enum {
  HL_ENCLOSED_VOLUME,
  HL_ENCLOSED_FALL,
  HL_ENCLOSED_SLOPES,
  HL_ENCLOSED_SURFACE_PARTS,
  HL_ENCLOSED_MEASURES
};

/* A row of a field and its neighbours, each [count]. At the field's ends the row itself takes the place of a
 * missing neighbour. */
typedef struct row_neighbours {
  /* rows shifted by one voxel along x: the row a voxel earlier, the row itself, and the row a voxel later */
  const float *x[3];
  const float *y[2], *z[2];
} row_neighbours;

typedef struct label_row_functions {
  /* Sets out[i] to taps[0] middle[i] + the sum over t from 1 to reach, in this order, of taps[t] (before[i] +
   * after[i]). Here `middle` is rows[HL_FILTER_REACH], and `before` and `after` are the rows t places before
   * and after it. reach: 2, 4 or HL_FILTER_REACH. out, [count], overlaps no row. */
  void (*weigh)(const float *taps, int reach, const float *const rows[HL_FILTER_ROWS], size_t count,
                float *out);
  /* Sets the elements of `crossed` to 1 for voxels that the surface at `level` may cross, and to 0 for other
   * voxels. Returns how many of the other voxels are above the level. crossed: [count]; overlaps nothing. */
  int32_t (*find_crossed)(const row_neighbours *rows, size_t count, float level, float *crossed);
  /* Measures a voxel that the surface at `level` may cross, and adds the results to measures,
   * [HL_ENCLOSED_MEASURES]. weights: the weights of the coefficients at the middles of the voxel's parts.
   * window: the coefficients around the voxel, [z][y][x]. */
  void (*measure_voxel)(const float weights[HL_VOXEL_PARTS][HL_VOXEL_TAPS],
                        const float window[HL_VOXEL_TAPS][HL_VOXEL_TAPS][HL_VOXEL_TAPS], float level,
                        double *measures);
} label_row_functions;

const label_row_functions *hl_label_row_functions(hl_instruction_set set);

#endif
