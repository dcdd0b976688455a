/* scene/labels.c - tells label maps from amounts: few whole numbers, each in blocks.
 *
 * In: a volume and its background. Out: the labels. Edges of smooth shapes and noise have numbers too, but no
 * two voxels side by side share them.
 */
#include "scene/labels.h"

#include <math.h>

#include "core/memory.h"
#include "scene/sample.h"

#define PLACES    5e5   /* looked at, about */
#define IN_BLOCKS 0.5   /* least part of a label's neighbours that share it */
#define WIDEST    65535 /* between the least label and the greatest */

typedef struct tally {
  unsigned int seen, shared; /* neighbours looked at of voxels with this value; those that have it too */
} tally;

/* False at a value that is no whole number. tallies: one for each whole number from least on. */
static bool count_neighbours(const hl_volume *volume, double least, tally *tallies) {
  const size_t *n = volume->dimension;
  size_t step = hl_lattice_step(n, PLACES);
  for (size_t k = step / 2; k < n[2]; k += step)
    for (size_t j = step / 2; j < n[1]; j += step)
      for (size_t i = step / 2; i < n[0]; i += step) {
        double value = hl_volume_value(volume, i, j, k);
        if (!isfinite(value)) continue;
        if (value != floor(value)) return false;
        const double next[3] = {hl_volume_value(volume, i + 1, j, k), hl_volume_value(volume, i, j + 1, k),
                                hl_volume_value(volume, i, j, k + 1)}; /* NaN outside */
        tally *own = &tallies[(size_t)(value - least)];
        for (int a = 0; a < 3; a++) {
          own->seen += isfinite(next[a]);
          own->shared += next[a] == value;
        }
      }
  return true;
}

/* More than half of the values, the background apart, lie in blocks. 0 is no label. */
static bool list(const tally *tallies, size_t count, double least, hl_data_analysis *a) {
  size_t found = 0, in_blocks = 0;
  double background = least <= 0 ? 0 : a->background;
  for (size_t t = 0; t < count; t++) {
    if (tallies[t].seen == 0 || least + (double)t == background) continue;
    if (found == HL_MOST_LABELS) return false;
    a->labels[found++] = least + (double)t;
    in_blocks += (double)tallies[t].shared > IN_BLOCKS * (double)tallies[t].seen;
  }
  a->label_count = found;
  return found > 1 && 2 * in_blocks > found;
}

hl_status hl_data_find_labels(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error) {
  double least = volume->minimum, range = volume->maximum - volume->minimum;
  if (analysis->kind == HL_DATA_CONSTANT || least != floor(least) || !(range <= WIDEST)) return HL_OK;
  size_t count = (size_t)range + 1;
  tally *tallies = hl_allocate_zeroed(volume->context, count, sizeof *tallies);
  if (tallies == NULL) return hl_fail_memory(error, count * sizeof *tallies, "a count of labels");
  if (count_neighbours(volume, least, tallies) && list(tallies, count, least, analysis))
    analysis->kind = HL_DATA_LABELS;
  else analysis->label_count = 0;
  hl_release(volume->context, tallies);
  return HL_OK;
}
