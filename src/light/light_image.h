/* light/light_image.h - the image on a light's own surface as the kernel of its penumbrae.
 *
 * The light is cut into cells of equal area, each with its mean colour. Seen from a receiver through an
 * occluder the cells are a grid of taps: the penumbra is the sum of as many sharp shadows, shifted as the
 * cells are, each with its weight of red, green and blue (derived: T(x) = mean over the light's points y of
 * colour(y) t(x, y)). */
#ifndef HL_LIGHT_LIGHT_IMAGE_H
#define HL_LIGHT_LIGHT_IMAGE_H

#include "light/light_extent.h"
#include "view/view.h"

enum {
  IMAGE_SIDE = 12,
  IMAGE_CELLS = IMAGE_SIDE * IMAGE_SIDE,
  IMAGE_TAPS = (IMAGE_SIDE + 3) * (IMAGE_SIDE + 3),
  IMAGE_GREATEST_STEP = 88 /* pixels from tap to tap: as far as boxes blur (cascade_image.c) */
};

/* Where a cell's light comes from on the plane that shadows are seen on, in units of the light's width there;
 * z: of the same unit, along the sheets' normal. */
typedef struct image_cell {
  double u, v, z;
  float weight[HL_CHANNELS]; /* of all cells together 1 */
} image_cell;

typedef struct light_image {
  double mean[HL_CHANNELS]; /* of the image over the light */
  bool even;                /* of a single colour: penumbrae are those of a light without an image */
  int count;                /* cells that are not dark */
  image_cell cells[IMAGE_CELLS];
  bool tilted;     /* receivers at different slopes see it differently */
  double reach;    /* of the cells from the middle, for any receiver */
  double range[2]; /* of the cells along u and v, for any receiver */
} light_image;

/* Mean colours of side x side cells of the unit square (hl_light_point), in units of their own mean, which is
 * returned too; a colour that is nowhere in the image has ones. weights: [side * side], cell (i, j) at i *
 * side + j. */
void hl_light_image_weights(const light_source *source, int side, float (*weights)[HL_CHANNELS],
                            double mean[HL_CHANNELS]);

/* Of a light with an image; the cells have no places yet. Free with hl_release(). */
hl_status hl_light_image_create(hl_context *context, const light_source *source, light_image **image,
                                hl_error *error);
/* Its cells, as hl_light_on_sheets sees the light; offsets are parts of the greater of its widths. */
void hl_light_image_see(const light_source *source, const sheet_light *seen, vec3 normal, light_image *image);
/* Its cells on the orthogonal projection of the light, along the buffer's axes; offsets are parts of
 * `size`. */
void hl_light_image_project(const light_source *source, const view *view, double size, light_image *image);

/* Whether a light's penumbrae are coloured, whatever the light's own colour. */
bool hl_light_image_colored(const hl_light *light);

/* The kernel of one penumbra as taps `step` pixels apart: what is looked up must be a mean over step
 * pixels. */
typedef struct image_taps {
  int count;
  int32_t x[IMAGE_TAPS], y[IMAGE_TAPS]; /* pixels */
  float weight[HL_CHANNELS][IMAGE_TAPS];
} image_taps;

/* width: of the light's penumbra, pixels. */
void hl_light_image_steps(const light_image *image, double width, int step[2]);
/* slope: of the receivers, seen from the light, along u and v: a light that is tilted shows itself otherwise
 * to each. */
void hl_light_image_taps(const light_image *image, double width, const int step[2], const double slope[2],
                         image_taps *taps);

#endif
