/* reference/mask.c - finds the factor and the colour of a volume's mask at a point of the volume's index
 * space. The mask is stored at the voxels of a lattice (label/mask.h), and is interpolated linearly between
 * them. The lattice stores square roots of colours. Outside the lattice, the factor is hl_mask's `rest`. */
#include "reference/reference.h"

/* The eight voxels of the mask's lattice around a point, and their weights. */
typedef struct mask_voxels {
  size_t voxel[8];
  double share[8];
} mask_voxels;

/* Finds the voxels around p, a point of the lattice's index space. If p lies outside the lattice, finds the
 * voxels around the nearest point of the lattice's border, and returns false. */
static bool find_voxels_at(const hl_volume *mask, const double p[3], mask_voxels *found) {
  bool inside = true;
  for (int corner = 0; corner < 8; corner++) {
    found->voxel[corner] = 0;
    found->share[corner] = 1;
  }
  for (int axis = 2; axis >= 0; axis--) {
    double last = (double)mask->dimension[axis] - 1;
    if (p[axis] < -0.5 || p[axis] > last + 0.5) inside = false;
    double at = fmin(fmax(p[axis], 0), last), first = floor(at);
    for (int corner = 0; corner < 8; corner++) {
      bool next = (corner >> axis & 1) != 0;
      size_t index = (size_t)(next ? fmin(first + 1, last) : first);
      found->voxel[corner] = found->voxel[corner] * mask->dimension[axis] + index;
      found->share[corner] *= next ? at - first : 1 - (at - first);
    }
  }
  return inside;
}

static bool find_voxels(const reference_volume *volume, vec3 point, mask_voxels *found) {
  vec3 p = affine3_apply(volume->index_to_mask, point);
  return find_voxels_at(volume->described->mask.volume, (const double[3]){p.x, p.y, p.z}, found);
}

/* The factor is the lattice's value between the voxels, held between 0 and 1. */
static double factor_of(const hl_volume *mask, const mask_voxels *found) {
  double sum = 0;
  for (int corner = 0; corner < 8; corner++)
    sum += found->share[corner] * ((const uint16_t *)mask->voxels)[found->voxel[corner]];
  return fmin(fmax(sum * mask->value_scale + mask->value_offset, 0), 1);
}

double hl_reference_mask_factor(const reference_volume *volume, vec3 point) {
  const hl_mask *mask = &volume->described->mask;
  mask_voxels found;
  if (mask->volume == NULL) return 1;
  if (!find_voxels(volume, point, &found)) return mask->rest;
  return factor_of(mask->volume, &found);
}

/* The gradient of the mask's factor, interpolated linearly between the slopes that are stored at the
 * lattice's points. */
vec3 hl_reference_mask_slope(const reference_volume *volume, vec3 point) {
  const hl_volume *mask = volume->described->mask.volume;
  double slope[3] = {0, 0, 0};
  mask_voxels found;
  if (mask == NULL || volume->described->cut_shading != HL_CUT_SHADING_FACE ||
      !find_voxels(volume, point, &found))
    return (vec3){0, 0, 0};
  for (int corner = 0; corner < 8; corner++)
    for (int axis = 0; axis < 3; axis++)
      slope[axis] += found.share[corner] * mask->slopes[4 * found.voxel[corner] + (size_t)axis] *
                     mask->slope_scale;
  return mat3_apply(volume->gradient_to_world,
                    mat3_apply(mat3_transpose(volume->index_to_mask.linear), vec3_of(slope)));
}

double hl_reference_mask_color(const reference_volume *volume, vec3 point, double color[3]) {
  const hl_volume *mask = volume->described->mask.volume;
  mask_voxels found;
  double weights = 0;
  if (mask == NULL || mask->colors == NULL || !find_voxels(volume, point, &found)) return 0;
  color[0] = color[1] = color[2] = 0;
  for (int corner = 0; corner < 8; corner++) {
    const unsigned char *code = mask->colors + 4 * found.voxel[corner];
    double weight = found.share[corner] * code[3] / 255;
    weights += weight;
    for (int c = 0; c < 3; c++) color[c] += weight * (code[c] / 255.0) * (code[c] / 255.0);
  }
  for (int c = 0; c < 3 && weights > 0; c++) color[c] /= weights;
  return weights;
}
