/* volume/formats/particles/difference.c - compares a volume of particles with exact values.
 *
 * In: a volume and the exact values at a few positions. Out: the greatest difference, which the volume
 * stores. */
#include "volume/formats/particles/difference.h"

#include <math.h>

#include "bricks/evaluate.h"
#include "core/memory.h"
#include "volume/in_bricks.h"

void hl_particle_truth_release(hl_context *context, hl_particle_truth *truth) {
  hl_particle_probes_release(context, &truth->probes);
  hl_release(context, truth->values);
  *truth = (hl_particle_truth){.values = NULL};
}

/* Finds the four coefficients along an axis on which the cubic B-spline at a position depends, and their
 * weights. Coefficients beyond the grid equal the outermost coefficient. */
static void find_taps(double place, size_t points, size_t tap[4], double weight[4]) {
  const double before = fmin(floor(place), (double)points - 1);
  hl_bspline_weights(place - before, weight);
  for (int n = 0; n < 4; n++) tap[n] = (size_t)fmin(fmax(before + n - 1, 0), (double)points - 1);
}

static double value_of_voxels(const hl_volume *volume, const double point[3]) {
  size_t tap[3][4];
  double weight[3][4], sum = 0;
  for (int a = 0; a < 3; a++) find_taps(point[a], volume->dimension[a], tap[a], weight[a]);
  for (int k = 0; k < 4; k++)
    for (int j = 0; j < 4; j++)
      for (int i = 0; i < 4; i++)
        sum += weight[2][k] * weight[1][j] * weight[0][i] *
               hl_volume_value_within(volume, tap[0][i], tap[1][j], tap[2][k]);
  return sum;
}

void hl_particle_truth_compare(const hl_particle_truth *truth, hl_volume *volume) {
  double most = 0;
  for (size_t q = 0; q < truth->probes.count; q++) {
    const double *point = truth->probes.point[q];
    const double value = volume->bricks != NULL ? hl_bricks_value(volume->bricks, point)
                                                : value_of_voxels(volume, point);
    if (isfinite(value)) most = fmax(most, fabs(value - truth->values[q]));
  }
  hl_volume_set_field_error(volume, most, "sampled", "the exact sum of the kernels at places of particles");
}
