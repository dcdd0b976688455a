/* fill/windows_lanes.h - holds the voxels around a block of pixels in registers, or close together in memory,
 * while the voxels are summed.
 *
 * Sixteen neighbouring pixels of a sheet depend on few voxels. Most often these voxels fit in a window of 8x8
 * voxels and up to eight slices. With AVX-512, a slice of a window fills one to four registers, from which
 * permutations take four neighbouring taps of every lane. u8 voxels come from the grid's columns, other
 * voxels from the volume's rows. A lane whose taps do not reach a slice gives the slice the weight zero,
 * which changes no bit of the lane's sum. With AVX2 alone, slices of u8 voxels are copied, so that one load
 * takes many taps. u16 voxels are read from the volume, a row of four taps in each load. All sums equal the
 * sums of gather_lanes.h and gradient_lanes.h, because voxels are added in the same order. This header
 * defines HL_WINDOWS if the instruction set has windows, and HL_SHORT_ROWS if u16 voxels are read by rows of
 * four. A file for one instruction set has the name of this set in its own name. */
#ifndef HL_FILL_WINDOWS_LANES_H
#define HL_FILL_WINDOWS_LANES_H

#include "simd/lanes.h"

#if defined(__AVX512BW__)
#define HL_WINDOWS 1
#include "fill/windows_avx512_lanes.h"
#elif defined(__AVX2__)
#define HL_WINDOWS    1
#define HL_SHORT_ROWS 1
#include "fill/windows_avx2_lanes.h"
#endif

#ifdef HL_WINDOWS
/* The weighted sums of a block's active lanes. The sums are taken from one window, or from one window for
 * each half of the block. lowest: the least of the lanes' cells along each axis, up to rounding, if every
 * lane is active; else null. Returns false if the taps lie too far apart. */
LANES_INLINE int sum_of_windows(const grid *grid, const lanes_int cell[3], const int32_t *lowest,
                                uint32_t active, const lanes weight[3][4], lanes *sum) {
  hl_storage storage = grid->storage;
  voxel_window window, below;
  const uint32_t upper = 0x00ff; /* the lanes of one half of the block */
  if (!has_windows(grid)) return 0;
  if ((lowest != NULL && open_window_at(grid, cell, lowest, active, &window)) ||
      open_window(grid, cell, active, &window)) {
    *sum = sum_of_window(storage, &window, weight);
    return 1;
  }
  if (!open_window(grid, cell, active & upper, &window) || !open_window(grid, cell, active & ~upper, &below))
    return 0;
  *sum = lanes_select(lanes_from_bits(upper), sum_of_window(storage, &window, weight),
                      sum_of_window(storage, &below, weight));
  return 1;
}
#endif

#endif
