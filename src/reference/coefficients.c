/* reference/coefficients.c - computes the B-spline coefficients that the interpolating kernel sums in place
 * of voxels. The coefficients are computed by Unser's two recursive filters along each axis, in double
 * precision. The renderer solves the same equations by another method, elimination. */
#include "core/memory.h"
#include "reference/reference.h"

enum {
  TERMS = 40 /* number of terms of the sum over z^k s. Each term is at most 0.268 times the term before, so
              * that the terms beyond this number add up to about 1e-22 */
};

/* Filters a line of voxels. Unser, Aldroubi and Eden 1993: with the pole z = sqrt(3) - 2, the forward filter
 * is p[k] = s[k] + z p[k-1], the backward filter q[k] = z (q[k+1] - p[k]), and the gain is 6. Beyond each
 * end, the line of voxels is continued by its mirror image, in which the voxel at the end occurs a second
 * time. Derived: the sequence p begins with the sum of z^k s over the mirrored line, and q with z / (z - 1)
 * p. */
static void filter_line(double *line, size_t count, size_t stride) {
  const double z = sqrt(3) - 2;
  if (count < 2) return;
  double sum = line[0], power = 1;
  for (size_t k = 0; k < TERMS; k++) {
    size_t folded = k % (2 * count);
    if (folded >= count) folded = 2 * count - 1 - folded;
    sum += (power *= z) * line[folded * stride];
  }
  line[0] = sum;
  for (size_t k = 1; k < count; k++) line[k * stride] += z * line[(k - 1) * stride];
  line[(count - 1) * stride] *= z / (z - 1);
  for (size_t k = count - 1; k-- > 0;) line[k * stride] = z * (line[(k + 1) * stride] - line[k * stride]);
  for (size_t k = 0; k < count; k++) line[k * stride] *= 6;
}

hl_status hl_reference_coefficients_create(hl_context *context, reference_volume *volume, hl_error *error) {
  const size_t *n = volume->grid->dimension;
  size_t count = n[0] * n[1] * n[2], voxel[3];
  double *made = hl_allocate(context, count, sizeof *made), *at = made;
  if (made == NULL) return hl_fail_memory(error, count * sizeof *made, "the coefficients of a volume");
  for (voxel[2] = 0; voxel[2] < n[2]; voxel[2]++)
    for (voxel[1] = 0; voxel[1] < n[1]; voxel[1]++)
      for (voxel[0] = 0; voxel[0] < n[0]; voxel[0]++) *at++ = hl_reference_stored_value(volume, voxel);
  for (size_t row = 0; row < n[1] * n[2]; row++) filter_line(made + row * n[0], n[0], 1);
  for (size_t k = 0; k < n[2]; k++)
    for (size_t i = 0; i < n[0]; i++) filter_line(made + k * n[1] * n[0] + i, n[1], n[0]);
  for (size_t at_slice = 0; at_slice < n[0] * n[1]; at_slice++)
    filter_line(made + at_slice, n[2], n[0] * n[1]);
  volume->coefficients = made;
  return HL_OK;
}
