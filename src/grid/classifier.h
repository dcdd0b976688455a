/* grid/classifier.h - a transfer function as tables: it classifies densities after interpolation.
 *
 * The tables map density on a sheet (stored units, relative to the grid's empty value) to extinction and
 * colour, linear between CLASSIFIER_ENTRIES equal steps over all values that the volume can take. Along a ray
 * from one sheet to the next, density changes from a to b. The mean extinction between them is the integral
 * of the table from a to b, divided by (b - a). The classifier therefore keeps the table's integral too, and
 * no narrow peak of a transfer function is lost between two sheets. */
#ifndef HL_GRID_CLASSIFIER_H
#define HL_GRID_CLASSIFIER_H

#include "core/memory.h"
#include "grid/grid.h"
#include "grid/mask_lattice.h"
#include "grid/plane_table.h"

enum { CLASSIFIER_ENTRIES = 4096, STEEPNESS_ENTRIES = 4096 };

/* The least bending that is worth a mean of colours. A way's bending is the change of a colour's slope on the
 * way through the table, times the way's entries. The mean of a line with one bend of slope s over a way w
 * differs from the line's value at the mean by at most s w / 4 (derived: half the weight at either end, the
 * bend in the middle): by 1/1024. */
#define CLASSIFIER_LEAST_BENDING (1.0f / 256)

typedef struct classifier {
  float scale, offset; /* table coordinate = density * scale + offset, clamped to [0, CLASSIFIER_ENTRIES] */
  /* Tables of CLASSIFIER_ENTRIES + 2 entries in one block, which sums owns. */
  float (*sums)[4];  /* extinction per world unit; its integral over entries, from entry 0; the integral of
                      * extinction times the entry's number; the first integral up to the coordinate at
                      * which the surface begins to which values from this entry to the next belong (see
                      * outside) */
  float (*color)[4]; /* linear RGB; 0 */
  float (*shown)[4]; /* integrals over entries, from entry 0: of extinction times linear RGB, and of
                      * extinction */
  /* For each entry, the sum of the changes of the colour's slope at visible entries up to this one; a change
   * is the greatest channel's change per entry. Null if the slope changes little everywhere. */
  float *bent;
  int32_t *next_visible; /* for each entry, the first entry from there on with extinction > 0 */
  /* [entries]; for values from an entry to the next, the table coordinate at which their surface begins: on
   * the way from these values to the empty value, the nearest value without extinction, or with the least
   * extinction before a second rise; the empty value's coordinate if there is no such value */
  float *outside;
  bool several_surfaces; /* whether the surfaces of visible values begin at more than one coordinate */
  float only_beginning;  /* where several_surfaces is false: the integral of extinction up to the
                          * coordinate at which all surfaces begin */
  float first_visible, last_visible; /* table coordinates outside of which nothing has extinction */
  /* Gradient opacity: the factor of extinction by the gradient's length, [STEEPNESS_ENTRIES + 2], in the same
   * block. Null if the factor is 1 everywhere. Table coordinate = length * steepness_scale, clamped to [0,
   * STEEPNESS_ENTRIES]; the length is in stored units per frame unit. */
  float *steepness;
  float steepness_scale;
  mask_lattice mask; /* the mask of the frame's scene */
  plane_table plane; /* a function of two numbers; the other tables then hold bounds over all second
                      * numbers */
  float normal_edge; /* the least gradient (table entries per frame unit) that counts as a surface */
} classifier;

/* Whether extinction depends on more than the value, so that a factor multiplies it. */
static inline bool hl_classifier_is_weighed(const classifier *classifier) {
  return classifier->steepness != NULL || classifier->mask.factors != NULL || classifier->plane.sums != NULL;
}

/* Whether the factor depends on the gradient. */
static inline bool hl_classifier_needs_gradient(const classifier *classifier) {
  return classifier->steepness != NULL ||
         (classifier->plane.sums != NULL && classifier->plane.axis == HL_SECOND_GRADIENT);
}

/* Makes the tables of a volume's transfer function. second: the other volume of a function of two numbers,
 * else null. */
hl_status hl_classifier_create(hl_context *context, const hl_scene_volume *volume,
                               const hl_scene_volume *second, const grid *grid, classifier *classifier,
                               hl_error *error);
/* Takes the arrays of a classifier; the first of them begins its block. */
void hl_classifier_lay_out(const hl_transfer_function *function, classifier *classifier, hl_layout *layout);
void hl_classifier_release(hl_context *context, classifier *classifier);

/* Data values below the result are transparent, whatever the transfer function says. If the transfer function
 * shows even the empty value, and the empty value lies below all values, the result is the middle between the
 * empty and the least value; else -infinity. */
double hl_transparent_below(const hl_volume *volume, const hl_transfer_function *function, double empty);

/* True if some stored value in [low, high] is visible. */
bool hl_classifier_span_visible(const classifier *classifier, const grid *grid, float low, float high);
/* True if some stored value in [low, high], or between them and empty, is visible. */
bool hl_classifier_range_visible(const classifier *classifier, const grid *grid, float low, float high);

#endif
