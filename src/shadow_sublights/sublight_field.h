/* shadow_sublights/sublight_field.h - composites a slab, as seen from the light's centre, into the buffer of
 * one sub-light. */
#ifndef HL_SHADOW_SUBLIGHTS_SUBLIGHT_FIELD_H
#define HL_SHADOW_SUBLIGHTS_SUBLIGHT_FIELD_H

#include "shadow/shadow_buffer.h"

/* The number of copies of a slab's transmittance. Copy 0 is not shifted. A copy whose index has bit 0 set is
 * shifted by half a pixel along u; a copy whose index has bit 1 set is shifted by half a pixel along v. A
 * copy is given by its pixel (0,0). Its rows are slab_stride apart, and the margin around its pixels holds
 * ones. */
enum { SLAB_COPIES = 4 };

typedef struct half_pixel_job {
  const float *slab;
  float *moved[SLAB_COPIES]; /* outputs; the first is not used */
  size_t slab_stride;
} half_pixel_job;

/* Rows of a tile in which some pixel is below 1, in the slab or in one of its shifted copies: bit TILE * copy
 * + row. */
typedef uint64_t slab_rows;

/* Fills a tile of the shifted copies, in those rows in which some pixel is below 1. Other rows hold ones
 * already. */
typedef slab_rows half_pixel_tile_function(const half_pixel_job *job, int tile_x, int tile_y);

typedef struct sublight_job {
  const float *slab[HL_CHANNELS][SLAB_COPIES];
  /* the light at the outside of surfaces that is left after the slab, where full light comes to the slab */
  const float *slab_outside[HL_CHANNELS][SLAB_COPIES];
  size_t slab_stride;
  const slab_rows *rows; /* [slab_tiles_y][slab_tiles_x] */
  int slab_tiles_x, slab_tiles_y;
  float slab_width, slab_height; /* pixels; around them are up to 32 pixels of ones */
  float scale[2], shift[2];      /* maps a pixel (u, v) of the sub-light to the slab, as scale * pixel +
                                  * shift in continuous coordinates */
  int half[2];                   /* shift in half pixels, rounded */
  sublight_pixel *transmittance[HL_CHANNELS]; /* pixel (0,0) of the sub-light's buffer; rows are `stride`
                                               * apart */
  sublight_pixel *outside[HL_CHANNELS];       /* pixel (0,0) of the light at the outside of surfaces, laid out
                                               * as the transmittance; null: there is none */
  size_t stride;                              /* a tile's margin on either side */
  int tiles_x;
  float carry; /* a number between 0 and 1 that is added to a pixel's new value before the value is truncated
                * to a whole number. It varies from slab to slab. So haze attenuates light by the right amount
                * on average, even if each slab of it absorbs less than 1 / SUBLIGHT_ONE */
  int channels;
} sublight_job;

/* Multiplies a tile of the sub-light by the slab. Returns whether the slab absorbed any light. */
typedef int sublight_tile_function(const sublight_job *job, int tile_x, int tile_y);

/* Multiplies a row of the sub-light's tiles by the slab's tiles from `first` to `last`. The job's scale must
 * be 1. lit: [tiles_x]; for each tile, the blocks with light, one bit each. Tiles in which no block has light
 * are skipped. touched: [tiles_x]; becomes 1 for tiles in which light may have been absorbed. */
typedef void sublight_row_function(const sublight_job *job, int tile_y, int first, int last,
                                   const uint16_t *lit, unsigned char *touched);

/* Those of the blocks `lit` that still have light. */
typedef uint32_t sublight_lit_function(const sublight_job *job, int tile_x, int tile_y, uint32_t lit);

/* The functions of this room that are compiled for each instruction set. */
typedef struct sublight_functions {
  sublight_tile_function *composite;
  sublight_row_function *composite_row; /* where pixels are only shifted */
  sublight_lit_function *lit;
  half_pixel_tile_function *half_pixel;
} sublight_functions;

#endif
