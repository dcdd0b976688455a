/* shadow_sublights/sublight_field.h - declares functions that attenuate the buffer of one sub-light by a
 * slab, which was classified as seen from the light's centre. */
#ifndef HL_SHADOW_SUBLIGHTS_SUBLIGHT_FIELD_H
#define HL_SHADOW_SUBLIGHTS_SUBLIGHT_FIELD_H

#include "shadow/shadow_buffer.h"

/* The number of copies of a slab's transmittance. Copy 0 is not shifted. A copy whose index has bit 0 set is
 * shifted by half a pixel along u; a copy whose index has bit 1 set is shifted by half a pixel along v. A
 * copy is given by the address of its pixel (0,0). Rows of a copy are slab_stride apart, and the margin
 * around the copy's pixels holds ones. */
enum { SLAB_COPIES = 4 };

typedef struct half_pixel_job {
  const float *slab;
  float *moved[SLAB_COPIES]; /* the copies that are filled; moved[0] is not used, because copy 0 is the
                              * slab itself */
  size_t slab_stride;
} half_pixel_job;

/* The rows of a tile of the slab in which some pixel is below 1, in the slab or in one of its shifted copies.
 * Row `row` of copy `copy` has the bit TILE * copy + row. */
typedef uint64_t slab_rows;

/* The type of the function that fills one tile of the shifted copies. The function fills the rows in which
 * some pixel is below 1. All other rows hold ones already. */
typedef slab_rows half_pixel_tile_function(const half_pixel_job *job, int tile_x, int tile_y);

/* The place of a slab in a sub-light's view. scale, shift: map a position in the sub-light's buffer, in
 * pixels (u, v), to a position in the slab: scale * position + shift. */
typedef struct sublight_place {
  int shifted; /* whether the scale is 1, so that the slab's image is only shifted */
  float scale[2], shift[2];
  int half[2]; /* set if `shifted`: `shift` in half pixels, rounded to whole numbers */
} sublight_place;

typedef struct sublight_job {
  const float *slab[HL_CHANNELS][SLAB_COPIES];
  /* the light at the outside of surfaces behind the slab, in the case that full light comes to the slab */
  const float *slab_outside[HL_CHANNELS][SLAB_COPIES];
  size_t slab_stride;
  /* [slab_tiles_y][slab_tiles_x]; for each tile of the slab, the rows in which some pixel is below 1 */
  const slab_rows *rows;
  int slab_tiles_x, slab_tiles_y;
  sublight_place place; /* the slab's place; the slab's tiles are surrounded by 32 pixels of ones */
  sublight_pixel *transmittance[HL_CHANNELS]; /* pixel (0,0) of the sub-light's buffer; rows are `stride`
                                               * apart */
  sublight_pixel *outside[HL_CHANNELS];       /* pixel (0,0) of the light at the outside of surfaces, laid out
                                               * as the transmittance; null if the buffer does not keep this
                                               * light */
  size_t stride;                              /* number of pixels from row to row; a row has a margin of
                                               * one tile on either side */
  int tiles_x;
  /* a number between 0 and 1 that is added to a pixel's new value, before the value is truncated to a whole
   * number. The number changes from slab to slab, so that haze attenuates light by the right amount on
   * average, even if each single slab absorbs less than 1 / SUBLIGHT_ONE of the light */
  float carry;
  int channels;
} sublight_job;

/* The type of the function that multiplies one tile of a sub-light's buffer by the slab's transmittance. The
 * function returns whether the slab absorbed any light. */
typedef int sublight_tile_function(const sublight_job *job, int tile_x, int tile_y);

/* The type of the function that multiplies a row of a sub-light's tiles by the transmittance of the slab's
 * tiles from `first` to `last`. The job's scale must be 1. lit: [tiles_x]; for each tile, the blocks with
 * light, one bit each. Tiles in which no block has light are skipped. touched: [tiles_x]; becomes 1 for tiles
 * in which light may have been absorbed. */
typedef void sublight_row_function(const sublight_job *job, int tile_y, int first, int last,
                                   const uint16_t *lit, unsigned char *touched);

/* The type of the function that finds the blocks of a tile that still have light. lit: the blocks that had
 * light before. Blocks have one bit each. */
typedef uint32_t sublight_lit_function(const sublight_job *job, int tile_x, int tile_y, uint32_t lit);

/* The functions of shadow_sublights of which each instruction set has a compiled version. */
typedef struct sublight_functions {
  sublight_tile_function *composite;
  sublight_row_function *composite_row; /* the function that is used if the slab's pixels are only shifted,
                                         * and not scaled */
  sublight_lit_function *lit;
  half_pixel_tile_function *half_pixel;
} sublight_functions;

#endif
