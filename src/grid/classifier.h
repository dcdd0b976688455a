/* grid/classifier.h - describes a transfer function as tables, by which densities are classified after
 * interpolation.
 *
 * The tables map density on a sheet (stored units, relative to the grid's empty value) to extinction and
 * colour, linear between CLASSIFIER_ENTRIES equal steps over all values that the volume can take. Along a ray
 * from one sheet to the next, density changes from a to b. The mean extinction between the sheets is the
 * integral of the table from a to b, divided by (b - a). The classifier therefore keeps the table's integral,
 * too, so that no narrow peak of a transfer function is lost between two sheets. */
#ifndef HL_GRID_CLASSIFIER_H
#define HL_GRID_CLASSIFIER_H

#include "core/memory.h"
#include "grid/grid.h"
#include "grid/mask_lattice.h"
#include "grid/plane_table.h"

enum { CLASSIFIER_ENTRIES = 4096, STEEPNESS_ENTRIES = 4096 };

typedef struct classifier {
  float scale, offset; /* table coordinate = density * scale + offset, clamped to [0, CLASSIFIER_ENTRIES] */
  /* The tables have CLASSIFIER_ENTRIES + 2 entries each. The tables lie in one block of memory, and `sums`
   * owns the block. */
  float (*sums)[4];  /* [0]: extinction per world unit. [1]: the integral of extinction over entries, from
                      * entry 0. [2]: the integral of extinction times the entry's number. [3]: the integral
                      * [1] up to the table coordinate that `outside` gives for this entry */
  float (*color)[4]; /* linear RGB of each entry; the fourth number is 0 */
  float (*shown)[4]; /* integrals over entries, from entry 0: [0] to [2] integrate extinction times linear
                      * RGB, [3] extinction alone */
  /* Sums, from entry 0 to each entry, of the changes of the colour's slope. A slope is the difference of a
   * channel between neighbouring entries. At each entry, the channel whose slope changes most counts. Entries
   * that are neither visible nor beside visible entries do not count. Null if the slope changes little
   * everywhere. */
  float *bent;
  int32_t *next_visible; /* for each entry, the first entry with extinction > 0 that is not before it */
  /* For the values from each entry to the next, the table coordinate at which the surface of matter with
   * these values begins. The surface begins at the nearest value, on the way to the empty value, that has no
   * extinction, or that has the least extinction before a second rise. Without such a value, the surface
   * begins at the empty value. */
  float *outside;
  bool several_surfaces; /* whether the surfaces of visible values begin at more than one coordinate */
  float only_beginning;  /* if several_surfaces is false, the integral of extinction up to the single
                          * coordinate at which all surfaces begin */
  float first_visible, last_visible; /* table coordinates; no value below first_visible or above last_visible
                                      * has extinction */
  /* [STEEPNESS_ENTRIES + 2], in the block of `sums`; gradient opacity: for each length of the gradient, the
   * factor that multiplies extinction. Null if the factor is 1 everywhere. Table coordinate = length *
   * steepness_scale, clamped to [0, STEEPNESS_ENTRIES]; the length is in stored units per frame unit. */
  float *steepness;
  float steepness_scale;
  mask_lattice mask; /* the volume's mask in the frame's scene */
  plane_table plane; /* the tables of a function of two numbers; the classifier's other tables then hold
                      * bounds over all second numbers */
  float normal_edge; /* the least gradient (table entries per frame unit) that counts as a surface */
} classifier;

/* Returns whether extinction depends on more than the value, so that a factor multiplies it. */
static inline bool hl_classifier_is_weighed(const classifier *classifier) {
  return classifier->steepness != NULL || classifier->mask.factors != NULL || classifier->plane.sums != NULL;
}

/* Returns whether the factor that multiplies extinction depends on the gradient of the volume. */
static inline bool hl_classifier_needs_gradient(const classifier *classifier) {
  return classifier->steepness != NULL ||
         (classifier->plane.sums != NULL && classifier->plane.axis == HL_SECOND_GRADIENT);
}

/* Makes the tables of a volume's transfer function. second: the other volume of a function of two numbers;
 * null for other functions. */
hl_status hl_classifier_create(hl_context *context, const hl_scene_volume *volume,
                               const hl_scene_volume *second, const grid *grid, classifier *classifier,
                               hl_error *error);
/* Lays out the arrays of a classifier in one block of memory. `sums` is the first array of the block. */
void hl_classifier_lay_out(const hl_transfer_function *function, classifier *classifier, hl_layout *layout);
void hl_classifier_release(hl_context *context, classifier *classifier);

/* The data value below which everything is transparent, whatever the transfer function says. If the transfer
 * function shows even the empty value, and the empty value lies below all values, the result is the middle
 * between the empty value and the least value; otherwise the result is -infinity. */
double hl_transparent_below(const hl_volume *volume, const hl_transfer_function *function, double empty);

/* Returns whether some stored value from `low` to `high` is visible. */
bool hl_classifier_span_visible(const classifier *classifier, const grid *grid, float low, float high);
/* Returns whether some stored value in the range from `low` to `high`, widened to include the empty value, is
 * visible. */
bool hl_classifier_range_visible(const classifier *classifier, const grid *grid, float low, float high);

#endif
