/* guess/boundary.c - finds whether the surface of scanned objects was cut out voxel by voxel, is sharp, or is
 * grainy by noise.
 *
 * A brain without its skull was cut out: around the brain all voxels have exactly one value, and the first
 * voxel inside is almost as bright as the matter within. A scanned object with a natural rim has voxels with
 * values between background and matter. The rim is sharp if most of the way from background to matter lies
 * between two neighbouring voxels. At a sharp rim, voxels stand too far apart to show how values rise. Noise
 * moves the place at which the values pass a threshold. */
#include <math.h>

#include "guess/analysis.h"

/* The least fraction of voxels with exactly the background's value, in data in which cliffs are looked
 * for. */
#define LEAST_ZEROED 0.2
/* A cliff is a step higher than this part of the way from the background to matter. */
#define CLIFF 0.5

typedef struct step_count {
  size_t steps, cliffs;
} step_count;

/* Counts the steps from the background to a place along an axis, from both sides. A step counts as a cliff
 * only if the next voxel is matter, too, because smoothing would remove matter that is one voxel thick. */
static void count_steps(const hl_volume *volume, const size_t at[3], int axis, const hl_data_analysis *a,
                        double background, double high, step_count *count) {
  const double here = hl_volume_value_within(volume, at[0], at[1], at[2]);
  if (!isfinite(here) || here == background) return;
  for (int side = -1; side <= 1; side += 2) {
    size_t before[3] = {at[0], at[1], at[2]}, behind[3] = {at[0], at[1], at[2]};
    before[axis] = (size_t)((ptrdiff_t)at[axis] - side);
    behind[axis] = (size_t)((ptrdiff_t)at[axis] + side);
    if (hl_volume_value_within(volume, before[0], before[1], before[2]) != background) continue;
    count->steps++;
    count->cliffs += a->direction * (here - background) > high &&
                     hl_volume_value_within(volume, behind[0], behind[1], behind[2]) != background;
  }
}

static double share_of_cliffs(const hl_volume *volume, const hl_sample *sample, const hl_data_analysis *a) {
  if (a->zeroed < LEAST_ZEROED) return 0;
  const size_t *n = volume->dimension;
  const double background = sample->low + sample->range * a->background,
               high = CLIFF * a->solid * sample->range;
  step_count count = {0, 0};
  for (size_t k = 1; k + 1 < n[2]; k += sample->step)
    for (size_t j = 1; j + 1 < n[1]; j += sample->step)
      for (size_t i = 1; i + 1 < n[0]; i += sample->step)
        for (int axis = 0; axis < 3; axis++)
          count_steps(volume, (size_t[3]){i, j, k}, axis, a, background, high, &count);
  return count.steps > 0 ? (double)count.cliffs / (double)count.steps : 0;
}

/* The sum of the shares of steps between neighbouring voxels (add_share()), and the number of steps. */
typedef struct step_shares {
  double sum;
  size_t count;
} step_shares;

/* The value of the voxel that lies `steps` voxels along one axis and `aside` voxels along another axis from a
 * voxel. */
static double value_beside(const hl_volume *volume, const size_t at[3], int axis, int steps, int other,
                           int aside) {
  size_t place[3] = {at[0], at[1], at[2]};
  place[axis] = (size_t)((ptrdiff_t)place[axis] + steps);
  place[other] = (size_t)((ptrdiff_t)place[other] + aside);
  return hl_volume_value_within(volume, place[0], place[1], place[2]);
}

/* Returns whether the values between a voxel and the next one along an axis change faster along this axis
 * than along the other two: the surface there faces the axis. change: the difference of the two voxels. */
static bool faces_axis(const hl_volume *volume, const size_t at[3], int axis, double change) {
  for (int other = 0; other < 3; other++) {
    if (other == axis) continue;
    double across = 0; /* four times the slope: the sum of two differences, each over two voxels */
    for (int steps = 0; steps < 2; steps++)
      across += value_beside(volume, at, axis, steps, other, 1) -
                value_beside(volume, at, axis, steps, other, -1);
    if (!(fabs(across) < 4 * fabs(change))) return false;
  }
  return true;
}

/* Adds the share of the step between a voxel and the next one along an axis, if the values pass the level
 * between the two voxels. The share is the step's fraction of the longer step over three voxel edges, which
 * begins one voxel earlier and ends one voxel later. Noise can make the share greater than 1. If the values
 * return within the three edges, matter is one voxel thin. The share is then 0, because smoothing would
 * remove such matter. */
static void add_share(const hl_volume *volume, const size_t at[3], int axis, double level,
                      step_shares *made) {
  const int other = (axis + 1) % 3;
  const double here = value_beside(volume, at, axis, 0, other, 0),
               next = value_beside(volume, at, axis, 1, other, 0);
  if (!isfinite(here) || !isfinite(next) || (here > level) == (next > level)) return;
  const double whole = value_beside(volume, at, axis, 2, other, 0) -
                       value_beside(volume, at, axis, -1, other, 0);
  if (!faces_axis(volume, at, axis, next - here)) return;
  if (whole * (next - here) > 0) made->sum += fmin((next - here) / whole, 2);
  made->count++;
}

/* The mean share of the steps at which the values pass a level; 0 if the values pass the level nowhere. */
static double share_of_steps(const hl_volume *volume, const hl_sample *sample, double level) {
  const size_t *n = volume->dimension;
  step_shares made = {0, 0};
  for (size_t k = 1; k + 2 < n[2]; k += sample->step)
    for (size_t j = 1; j + 2 < n[1]; j += sample->step)
      for (size_t i = 1; i + 2 < n[0]; i += sample->step)
        for (int axis = 0; axis < 3; axis++) add_share(volume, (size_t[3]){i, j, k}, axis, level, &made);
  return made.count > 0 ? made.sum / (double)made.count : 0;
}

/* The mean slope, per voxel edge, of the values at the places where the values pass a level; 0 if the values
 * pass the level nowhere. Derived: a slope g in any direction is a difference g cos(t) along an axis, and a
 * pair of neighbours lies on both sides of the level with a probability in proportion to |cos(t)|. So the
 * mean difference of such pairs is g <cos^2> / <|cos|> = g (1/3) / (1/2) over all directions. */
static double slope_at(const hl_volume *volume, const hl_sample *sample, double level) {
  const size_t *n = volume->dimension;
  double sum = 0, pairs = 0;
  for (size_t k = 0; k + 1 < n[2]; k += sample->step)
    for (size_t j = 0; j + 1 < n[1]; j += sample->step)
      for (size_t i = 0; i + 1 < n[0]; i += sample->step) {
        const double here = hl_volume_value_within(volume, i, j, k);
        for (int axis = 0; axis < 3; axis++) {
          const double next = hl_volume_value_within(volume, i + (axis == 0), j + (axis == 1),
                                                     k + (axis == 2));
          if (!isfinite(here) || !isfinite(next) || (here > level) == (next > level)) continue;
          sum += fabs(next - here);
          pairs++;
        }
      }
  return pairs > 0 ? 1.5 * sum / pairs : 0;
}

hl_status hl_data_find_boundary(const hl_volume *volume, const hl_sample *sample, hl_data_analysis *a,
                                hl_error *error) {
  const double relative = a->background + a->direction * a->solid,
               level = sample->low + sample->range * relative,
               slope = slope_at(volume, sample, level) / sample->range;
  double noise = 0;
  a->cliffs = share_of_cliffs(volume, sample, a);
  a->sharpness = share_of_steps(volume, sample, level);
  hl_status status = hl_noise(volume, sample, relative, a->direction, &noise, error);
  a->grain = slope > 0 && isfinite(noise) ? noise / slope : 0;
  return status;
}
