/* light/light_emission.h - the emission image on a light's surface, as the kernel of its penumbrae.
 *
 * The light is cut into cells of equal area, each with its mean colour. A penumbra is a sum of sharp shadows,
 * one for each cell. The shadow of a cell is shifted in proportion to the cell's offset from the light's
 * middle, and weighted by the cell's red, green and blue (derived: T(x) = mean over the light's points y of
 * colour(y) t(x, y)). These shifts and weights are the penumbra's taps. */
#ifndef HL_LIGHT_LIGHT_EMISSION_H
#define HL_LIGHT_LIGHT_EMISSION_H

#include "light/light_extent.h"
#include "view/view.h"

enum {
  EMISSION_SIDE = 12,
  EMISSION_CELLS = EMISSION_SIDE * EMISSION_SIDE,
  EMISSION_TAPS = (EMISSION_SIDE + 3) * (EMISSION_SIDE + 3),
  /* The greatest distance from tap to tap, in pixels: the greatest width of the box blur in
   * cascade_emission.c. */
  EMISSION_GREATEST_STEP = 88
};

/* A cell of an emission image: its position (u, v) on the plane on which shadows are measured, in units of
 * the light's width on this plane. z: the cell's position along the sheets' normal, in the same unit. */
typedef struct emission_cell {
  double u, v, z;
  /* the fractions of the light's red, green and blue that the cell sends; the sum of each over all cells is
   * 1 */
  float weight[HL_CHANNELS];
} emission_cell;

typedef struct light_emission {
  double mean[HL_CHANNELS]; /* mean red, green and blue of the image over the light's surface */
  bool even; /* the whole image has one colour, so that the light's penumbrae are the same as without an
              * image */
  int count; /* number of cells that are not dark */
  emission_cell cells[EMISSION_CELLS];
  bool tilted;     /* whether cells differ in z, so that the taps depend on the slope of the rays to the
                    * receiver */
  double reach;    /* the cells' greatest distance from the middle, for any receiver */
  double range[2]; /* the cells' extent along u and v, for any receiver */
} light_emission;

/* The mean colours of side x side cells of the unit square (hl_light_point), divided by the mean colour of
 * the image, `mean`. In a channel that is dark everywhere, the results are 1. weights: [side * side]; cell
 * (i, j) has the index i * side + j. */
void hl_light_emission_weights(const light_source *source, int side, float (*weights)[HL_CHANNELS],
                               double mean[HL_CHANNELS]);

/* Makes the cells of a light's emission image, without positions; null for a light without such an image. The
 * caller frees the result with hl_release(). */
hl_status hl_light_emission_create(hl_context *context, const light_source *source, light_emission **emission,
                                   hl_error *error);
/* Sets the positions of the cells on the plane of hl_light_on_sheets(), in units of the greater of the
 * light's two widths there. */
void hl_light_emission_see(const light_source *source, const sheet_light *seen, vec3 normal,
                           light_emission *emission);
/* Sets the cells' positions in the orthogonal projection of the light, along the buffer's axes, in units of
 * `size`, the width of the light. */
void hl_light_emission_project(const light_source *source, const view *view, double size,
                               light_emission *emission);

/* Whether a light's penumbrae have several colours because of its emission image. */
bool hl_light_emission_colored(const hl_light *light);

/* The kernel of one penumbra: taps at distances of step[0] pixels along u and step[1] pixels along v. Before
 * the taps weigh pixels, the pixels must be averaged over these distances. */
typedef struct emission_taps {
  int count;
  int32_t x[EMISSION_TAPS], y[EMISSION_TAPS]; /* places of the taps, in pixels from the receiver's pixel */
  float weight[HL_CHANNELS][EMISSION_TAPS];
} emission_taps;

/* Chooses the distances of taps along u and v. width: the width of the penumbra, in pixels. */
void hl_light_emission_steps(const light_emission *emission, double width, int step[2]);
/* Finds the taps of a penumbra. slope: the slope of the rays to the receivers, along u and v; the taps of a
 * tilted light depend on it. */
void hl_light_emission_taps(const light_emission *emission, double width, const int step[2],
                            const double slope[2], emission_taps *taps);

#endif
