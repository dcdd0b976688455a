/* light/light_emission.h - the emission image on a light's surface, as the kernel of its penumbrae.
 *
 * The light is cut into cells of equal area, each with its mean colour. A penumbra is a sum of sharp shadows,
 * one for each cell. A cell's shadow is shifted as the cell is shifted from the light's middle, and weighted
 * by the cell's red, green and blue (derived: T(x) = mean over the light's points y of colour(y) t(x, y)).
 * These shifts and weights are the penumbra's taps. */
#ifndef HL_LIGHT_LIGHT_EMISSION_H
#define HL_LIGHT_LIGHT_EMISSION_H

#include "light/light_extent.h"
#include "view/view.h"

enum {
  EMISSION_SIDE = 12,
  EMISSION_CELLS = EMISSION_SIDE * EMISSION_SIDE,
  EMISSION_TAPS = (EMISSION_SIDE + 3) * (EMISSION_SIDE + 3),
  /* The greatest distance from tap to tap, in pixels; a box blur of this width is possible
   * (cascade_emission.c). */
  EMISSION_GREATEST_STEP = 88
};

/* A cell's position on the plane that shadows are measured on, in units of the light's width there; z: along
 * the sheets' normal, in the same unit. */
typedef struct emission_cell {
  double u, v, z;
  float weight[HL_CHANNELS]; /* its sum over all cells is 1 */
} emission_cell;

typedef struct light_emission {
  double mean[HL_CHANNELS]; /* the image's mean over the light */
  bool even; /* the image has one colour, so that penumbrae are the same as for a light without an image */
  int count; /* number of cells that are not dark */
  emission_cell cells[EMISSION_CELLS];
  bool tilted;     /* cells differ in z, so the taps depend on the slope of the rays to the receiver */
  double reach;    /* the cells' greatest distance from the middle, for any receiver */
  double range[2]; /* the cells' extent along u and v, for any receiver */
} light_emission;

/* The mean colours of side x side cells of the unit square (hl_light_point), divided by the image's mean
 * colour, `mean`. A channel that is dark everywhere gets ones. weights: [side * side], cell (i, j) at i *
 * side + j. */
void hl_light_emission_weights(const light_source *source, int side, float (*weights)[HL_CHANNELS],
                               double mean[HL_CHANNELS]);

/* Makes the cells of a light's emission image, without positions; null for a light without such an image.
 * Free the result with hl_release(). */
hl_status hl_light_emission_create(hl_context *context, const light_source *source, light_emission **emission,
                                   hl_error *error);
/* Sets the cells' positions as hl_light_on_sheets() sees the light, in units of the greater of its widths. */
void hl_light_emission_see(const light_source *source, const sheet_light *seen, vec3 normal,
                           light_emission *emission);
/* Sets the cells' positions in the orthogonal projection of the light, along the buffer's axes, in units of
 * `size`. */
void hl_light_emission_project(const light_source *source, const view *view, double size,
                               light_emission *emission);

/* Whether a light's penumbrae are coloured, apart from the light's own colour. */
bool hl_light_emission_colored(const hl_light *light);

/* The kernel of one penumbra: taps that are `step` pixels apart along u and v. Pixels must be averaged over
 * `step` pixels before the taps weigh them. */
typedef struct emission_taps {
  int count;
  int32_t x[EMISSION_TAPS], y[EMISSION_TAPS]; /* pixels */
  float weight[HL_CHANNELS][EMISSION_TAPS];
} emission_taps;

/* Chooses the distances of taps along u and v. width: the penumbra's width, pixels. */
void hl_light_emission_steps(const light_emission *emission, double width, int step[2]);
/* Finds the taps. slope: slope of the rays to the receivers, along u and v; where the light is tilted, the
 * taps depend on it. */
void hl_light_emission_taps(const light_emission *emission, double width, const int step[2],
                            const double slope[2], emission_taps *taps);

#endif
