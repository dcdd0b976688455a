/* light/sublight_field.h - compositing a slab, seen from the light's centre, into the buffer of one part of the light. */
#ifndef HL_LIGHT_SUBLIGHT_FIELD_H
#define HL_LIGHT_SUBLIGHT_FIELD_H

#include "light/attenuate.h"

/* A slab and its images half a pixel further along u, along v, and along both: bit 0 and bit 1 of their index. Pixel
 * (0,0); rows slab_stride apart; ones around. */
enum { SLAB_IMAGES = 4 };

typedef struct half_pixel_job {
  const float *slab;
  float *moved[SLAB_IMAGES]; /* written but for the first, which is not read */
  size_t slab_stride;
} half_pixel_job;

/* A tile's pixels of all that are moved. Returns where they or the slab's are below 1: bit i for row i of the slab or of the
 * first moved one, bit 16 + i for that of the other two. */
typedef uint32_t half_pixel_tile_function(const half_pixel_job *job, int tile_x, int tile_y);

typedef struct sublight_job {
  const float *slab[HL_CHANNELS][SLAB_IMAGES];
  size_t slab_stride;
  const uint32_t *rows;              /* [slab_tiles_y][slab_tiles_x]; as half_pixel_tile_function tells */
  int slab_tiles_x, slab_tiles_y;
  float slab_width, slab_height;     /* with ones further out, up to 32 pixels */
  float scale[2], shift[2];          /* continuous pixel coordinates u and v of the slab: scale * the part's + shift */
  float *transmittance[HL_CHANNELS]; /* pixel (0,0) of the part's buffer; rows stride apart */
  size_t stride;
  int channels;
} sublight_job;

/* Multiplies a tile by the slab; returns whether light may be left in it. */
typedef int sublight_tile_function(const sublight_job *job, int tile_x, int tile_y);

#endif
