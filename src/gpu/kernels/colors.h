/* gpu/kernels/colors.h - finds the colour of voxels that have colours of their own, at a position. The
 * function computes for one pixel the same numbers as voxel_color_at() in render/voxel_color_lanes.h for
 * sixteen. */
#ifndef HL_GPU_COLORS_H
#define HL_GPU_COLORS_H

#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

/* Finds the mean colour of the eight voxels around a position of frame space. codes: [z][y][x][4]. decode:
 * the linear values of the codes. last: the greatest index along x, y, z. to_index: maps frame space to index
 * space. Returns the mean weight, 0 to 255; if it is 0, the colour is black. */
DEVICE float color_between_voxels(GLOBAL const byte *codes, GLOBAL const float *decode,
                                  GLOBAL const int *last, GLOBAL const float (*to_index)[4], vector position,
                                  float color[3]) {
  int first[3], next[3];
  float part[3], sum[3] = {0.0f, 0.0f, 0.0f}, all = 0.0f;
  for (int a = 0; a < 3; a++) {
    const float at = limited(row_of_point(to_index[a], position), 0.0f, (float)last[a]);
    first[a] = (int)at;
    next[a] = first[a] + 1 > last[a] ? last[a] : first[a] + 1;
    part[a] = at - (float)first[a];
  }
  for (int corner = 0; corner < 8; corner++) {
    int at[3];
    float share = 1.0f;
    for (int a = 0; a < 3; a++) {
      const int is_far = corner >> a & 1;
      at[a] = is_far ? next[a] : first[a];
      share = share * (is_far ? part[a] : 1.0f - part[a]);
    }
    const wide row = (wide)(unsigned)at[2] * (unsigned)(last[1] + 1) + (unsigned)at[1];
    GLOBAL const byte *own = codes + (row * (unsigned)(last[0] + 1) + (unsigned)at[0]) * 4;
    const float weight = share * (float)own[3];
    all = all + weight;
    for (int c = 0; c < 3; c++) sum[c] = fused(weight, decode[own[c]], sum[c]);
  }
  for (int c = 0; c < 3; c++) color[c] = divided(sum[c], greater(all, 1e-6f));
  return all;
}

#endif
