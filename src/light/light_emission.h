/* light/light_emission.h - describes the emission image on a light's surface, as the kernel of its penumbrae.
 *
 * The light is cut into cells of equal area. Each cell has the image's mean colour in it. A penumbra is a sum
 * of sharp shadows, one for each cell. The shadow of a cell is shifted in proportion to the cell's offset
 * from the light's middle, and weighted by the cell's red, green and blue. The shifts and weights of all
 * cells are the penumbra's taps. Derived: the light at x is T(x) = mean over the light's points y of
 * colour(y) t(x, y), where t(x, y) is the transmittance from y to x. */
#ifndef HL_LIGHT_LIGHT_EMISSION_H
#define HL_LIGHT_LIGHT_EMISSION_H

#include "light/light_extent.h"
#include "view/view.h"

enum {
  EMISSION_SIDE = 12,
  EMISSION_CELLS = EMISSION_SIDE * EMISSION_SIDE,
  EMISSION_TAPS = (EMISSION_SIDE + 3) * (EMISSION_SIDE + 3),
  /* the greatest distance between neighbouring taps, in pixels. This distance is the greatest width of the
     box blur in cascade_emission.c */
  EMISSION_GREATEST_STEP = 88
};

/* A cell of an emission image. u, v: the cell's position on the plane on which shadows are measured, in units
 * of the light's width on this plane. z: the cell's position along the sheets' normal, in the same unit. */
typedef struct emission_cell {
  double u, v, z;
  /* the fractions of the light's red, green and blue that the cell sends; the sum of each over all cells is
   * 1 */
  float weight[HL_CHANNELS];
} emission_cell;

typedef struct light_emission {
  double mean[HL_CHANNELS]; /* mean red, green and blue of the image over the light's surface */
  bool even; /* whether the whole image has one colour, so that penumbrae are the same as without an image */
  int count; /* number of cells that are not dark */
  emission_cell cells[EMISSION_CELLS];
  bool tilted;     /* whether the cells' z differ, so that the taps depend on the slope of the rays to the
                    * receiver */
  double reach;    /* the greatest distance of a cell from the light's middle, as seen from any receiver */
  double range[2]; /* the extent of the cells along u and v, as seen from any receiver */
} light_emission;

/* Finds the mean colours of side x side cells of an emission image (cells of the unit square of
 * hl_light_point). The cells' colours are divided by `mean`, the mean colour of the whole image. In a channel
 * that is dark everywhere, the results are 1. weights: [side * side]; cell (i, j) has the index i * side + j.
 */
void hl_light_emission_weights(const light_source *source, int side, float (*weights)[HL_CHANNELS],
                               double mean[HL_CHANNELS]);

/* Makes the cells of a light's emission image, without positions; null for a light without such an image. The
 * caller frees the result with hl_release(). */
hl_status hl_light_emission_create(hl_context *context, const light_source *source, light_emission **emission,
                                   hl_error *error);
/* Sets the positions of the cells on the plane of hl_light_on_sheets(), in units of the greater of the
 * light's two widths on this plane. */
void hl_light_emission_see(const light_source *source, const sheet_light *seen, vec3 normal,
                           light_emission *emission);
/* Sets the cells' positions in the orthogonal projection of the light, along the buffer's axes, in units of
 * `size`, the width of the light. */
void hl_light_emission_project(const light_source *source, const view *view, double size,
                               light_emission *emission);

/* Returns whether a light's penumbrae are coloured, because its emission image has several colours. */
bool hl_light_emission_colored(const hl_light *light);

/* The kernel of one penumbra: taps at distances of step[0] pixels along u and step[1] pixels along v. Pixels
 * must be averaged over these distances before the taps weigh them. */
typedef struct emission_taps {
  int count;
  int32_t x[EMISSION_TAPS], y[EMISSION_TAPS]; /* the positions of the taps, in pixels from the receiver's
                                               * pixel */
  float weight[HL_CHANNELS][EMISSION_TAPS];
} emission_taps;

/* Chooses the distances between a penumbra's taps along u and v. width: the width of the penumbra, in
 * pixels. */
void hl_light_emission_steps(const light_emission *emission, double width, int step[2]);
/* Finds the taps of a penumbra. slope: the slope, along u and v, at which rays come to the receivers. The
 * taps depend on the slope if the light is tilted against the sheets. */
void hl_light_emission_taps(const light_emission *emission, double width, const int step[2],
                            const double slope[2], emission_taps *taps);

#endif
