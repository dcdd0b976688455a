/* reference/tint.c - finds the colour of a volume's own voxels at a point. The colour is the trilinear mean
 * of the voxels' linear colours times their weights, divided by the trilinear mean of the weights. The mask's
 * colour is mixed in afterwards. */
#include "elementary/elementary.h"
#include "reference/reference.h"

/* The linear value, from 0 to 1, of an 8-bit sRGB code (IEC 61966-2-1). */
static double linear_of(unsigned char code) {
  double encoded = code / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : hl_pow((encoded + 0.055) / 1.055, 2.4);
}

/* Adds the colour of one voxel to a weighted sum. color: four bytes; the last byte is the voxel's weight. */
static void add_voxel(const unsigned char *color, double share, double sum[3], double *weights) {
  double weight = share * color[3];
  *weights += weight;
  for (int c = 0; c < 3; c++) sum[c] += weight * linear_of(color[c]);
}

/* Multiplies a colour by the colour of the volume's voxels at a point. */
static void multiply_by_voxels(const reference_volume *volume, vec3 point, double color[3]) {
  const hl_volume *grid = volume->grid;
  const double p[3] = {point.x, point.y, point.z};
  size_t first[3], next[3];
  double part[3], sum[3] = {0, 0, 0}, weights = 0;
  for (int axis = 0; axis < 3; axis++) {
    double last = (double)grid->dimension[axis] - 1, at = fmin(fmax(p[axis], 0), last);
    first[axis] = (size_t)at;
    next[axis] = (size_t)fmin((double)first[axis] + 1, last);
    part[axis] = at - (double)first[axis];
  }
  for (int corner = 0; corner < 8; corner++) {
    size_t voxel[3];
    double share = 1;
    for (int axis = 0; axis < 3; axis++) {
      bool is_next = (corner >> axis & 1) != 0;
      voxel[axis] = is_next ? next[axis] : first[axis];
      share *= is_next ? part[axis] : 1 - part[axis];
    }
    size_t index = (voxel[2] * grid->dimension[1] + voxel[1]) * grid->dimension[0] + voxel[0];
    add_voxel(grid->colors + 4 * index, share, sum, &weights);
  }
  for (int c = 0; c < 3; c++) color[c] *= sum[c] / weights;
}

void hl_reference_tint(const reference_volume *volume, vec3 point, double color[3]) {
  double tint[3];
  if (volume->grid->colors != NULL) multiply_by_voxels(volume, point, color);
  double part = hl_reference_mask_color(volume, point, tint);
  for (int c = 0; c < 3 && part > 0; c++) color[c] += part * (tint[c] - color[c]);
}
