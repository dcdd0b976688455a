/* render/layers.h - layers of a picture. For each layer, a sweep shades each tile once more.
 *
 * A light's picture is shaded with this light alone, without ambient light and emission. A light's shadow is
 * the picture of white matter, lit by this light in white; the matter sends on light from any angle. The
 * sky's shadow is the quotient of two pictures of white matter: one picture is lit by the sky, the other by a
 * sky that nothing hides. The function that shades the picture makes all of these from the same densities,
 * for each tile after the picture's own tile. Depth, objects and normals are measured in a sweep that goes
 * from front to back for the eye. Without layers, none of this is done. */
#ifndef HL_RENDER_LAYERS_H
#define HL_RENDER_LAYERS_H

#include <halflight/layers.h>

#include "core/memory.h"
#include "core/pool.h"
#include "plan/frame_plan.h"
#include "render/hot.h"

/* The pixels of a light's layers, in the picture's order: [tiles][16][floats per pixel][16]. An array is null
 * if its layer is not wanted. */
typedef struct light_pixels {
  float *picture, *shadow; /* R G B A */
  size_t light_index;      /* the light's index in the scene; a light in sectors has an entry for each
                            * sector */
  bool of_sky; /* whether the light is a sun of the sky. Its picture is then a part of the sky's picture. A
                * sun has no shadow layer; it has the next two arrays instead */
  float *reaching, *open; /* R G B A; the sun's share of two pictures of white matter. `reaching` is lit by
                           * the light that arrives, `open` by the light that would arrive if nothing were in
                           * the way */
} light_pixels;

enum { COLORS = 4 }; /* R G B A */

typedef struct layer_pixels {
  const hl_layers *wanted;         /* the caller's; null if there is none */
  float *ambient, *emission, *sky; /* R G B A */
  float *sky_reaching, *sky_open;  /* R G B A; two pictures of white volumes: lit by the sky, and lit by a sky
                                    * that  nothing hides */
  float *measures;                 /* [MEASURES] floats per pixel */
  light_pixels *lights;            /* owned; [light_count] */
  size_t light_count;              /* number of lights of the frame */
  void *memory;                    /* owned; holds all pixels */
} layer_pixels;

/* Allocates the wanted layers of a frame. tiles: the number of the frame's tiles. */
hl_status hl_layer_pixels_create(hl_context *context, hl_pool *pool, const hl_layers *wanted,
                                 const frame *frame, size_t tiles, layer_pixels *pixels, hl_error *error);
/* Counts the memory that hl_layer_pixels_create() takes. */
void hl_layer_pixels_count(const hl_layers *wanted, const frame *frame, size_t tiles, hl_layout *layout);
void hl_layer_pixels_release(hl_context *context, layer_pixels *pixels);

/* Returns the layers, among the wanted ones, to which a light of the frame adds. */
hl_light_layers hl_layers_of_light(const hl_layers *wanted, const light_source *light);

/* The map from the frame's pixels to the picture's pixels: the mean of oversampling x oversampling of the
 * frame's pixels is a pixel of the picture. */
typedef struct layer_grid {
  int width, height; /* size of the picture */
  int oversampling;
  size_t tiles_x;
  float unit; /* the length in the world of one unit of frame space */
} layer_grid;

/* Fills the caller's buffers. */
void hl_layer_pixels_write(const layer_pixels *pixels, const layer_grid *grid, hl_pool *pool);

#endif
