/* light/light_emission.h - the image on a light's own surface as the kernel of its penumbrae.
 *
 * The light is cut into cells of equal area, each with its mean colour. Seen from a receiver through an
 * occluder the cells are a grid of taps: the penumbra is the sum of as many sharp shadows, shifted as the
 * cells are, each with its weight of red, green and blue (derived: T(x) = mean over the light's points y of
 * colour(y) t(x, y)). */
#ifndef HL_LIGHT_LIGHT_EMISSION_H
#define HL_LIGHT_LIGHT_EMISSION_H

#include "light/light_extent.h"
#include "view/view.h"

enum {
  EMISSION_SIDE = 12,
  EMISSION_CELLS = EMISSION_SIDE * EMISSION_SIDE,
  EMISSION_TAPS = (EMISSION_SIDE + 3) * (EMISSION_SIDE + 3),
  EMISSION_GREATEST_STEP = 88 /* pixels from tap to tap: as far as boxes blur (cascade_emission.c) */
};

/* Where a cell's light comes from on the plane that shadows are seen on, in units of the light's width there;
 * z: of the same unit, along the sheets' normal. */
typedef struct emission_cell {
  double u, v, z;
  float weight[HL_CHANNELS]; /* of all cells together 1 */
} emission_cell;

typedef struct light_emission {
  double mean[HL_CHANNELS]; /* of the image over the light */
  bool even;                /* of a single colour: penumbrae are those of a light without an image */
  int count;                /* cells that are not dark */
  emission_cell cells[EMISSION_CELLS];
  bool tilted;     /* receivers at different slopes see it differently */
  double reach;    /* of the cells from the middle, for any receiver */
  double range[2]; /* of the cells along u and v, for any receiver */
} light_emission;

/* Mean colours of side x side cells of the unit square (hl_light_point), in units of their own mean, which is
 * returned too; a colour that is nowhere in the image has ones. weights: [side * side], cell (i, j) at i *
 * side + j. */
void hl_light_emission_weights(const light_source *source, int side, float (*weights)[HL_CHANNELS],
                               double mean[HL_CHANNELS]);

/* Of a light with an image; the cells have no places yet. Free with hl_release(). */
hl_status hl_light_emission_create(hl_context *context, const light_source *source, light_emission **emission,
                                   hl_error *error);
/* Its cells, as hl_light_on_sheets sees the light; offsets are parts of the greater of its widths. */
void hl_light_emission_see(const light_source *source, const sheet_light *seen, vec3 normal,
                           light_emission *emission);
/* Its cells on the orthogonal projection of the light, along the buffer's axes; offsets are parts of
 * `size`. */
void hl_light_emission_project(const light_source *source, const view *view, double size,
                               light_emission *emission);

/* Whether a light's penumbrae are coloured, whatever the light's own colour. */
bool hl_light_emission_colored(const hl_light *light);

/* The kernel of one penumbra as taps `step` pixels apart: what is looked up must be a mean over step
 * pixels. */
typedef struct emission_taps {
  int count;
  int32_t x[EMISSION_TAPS], y[EMISSION_TAPS]; /* pixels */
  float weight[HL_CHANNELS][EMISSION_TAPS];
} emission_taps;

/* width: of the light's penumbra, pixels. */
void hl_light_emission_steps(const light_emission *emission, double width, int step[2]);
/* slope: of the receivers, seen from the light, along u and v: a light that is tilted shows itself otherwise
 * to each. */
void hl_light_emission_taps(const light_emission *emission, double width, const int step[2],
                            const double slope[2], emission_taps *taps);

#endif
