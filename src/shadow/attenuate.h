/* shadow/attenuate.h - step 17: composites a slab's extinction, seen from the light, into the shadow buffer.
 */
#ifndef HL_SHADOW_ATTENUATE_H
#define HL_SHADOW_ATTENUATE_H

#include "fill/fill.h"
#include "grid/classifier.h"
#include "light/light_source.h"

/* One volume's densities in a tile, on cache lines of its own: each thread writes its own beside another's.
 */
typedef struct attenuate_volume {
  _Alignas(64) const classifier *classifier;
  const float *density;       /* [256], block-major; on this sheet */
  const float *before;        /* [256], block-major; on the sheet before */
  const float *enter, *leave; /* [256], block-major; null: the box does not cut anything visible */
  uint32_t blocks;            /* blocks with density on either sheet */
  float weight[HL_CHANNELS];  /* relative extinction of R, G, B */
  int uncut;                  /* the box does not cut the slab here */
  const grid *grid;           /* of gradient opacity: the gradient's */
  const kernel *kernel;
  const float (*to_index)[4]; /* frame space to index space */
} attenuate_volume;

typedef struct attenuate_job {
  sheet_rays rays; /* light pixels -> frame space */
  float path; /* parallel light: sheet spacing / |l.h|; point light: the sheet spacing, which pixels divide by
                 their own |l.h| */
  float through[3];      /* parallel: from one sheet to the next along the light's rays; frame units */
  float height, spacing; /* of the sheet above the first, and to the one before; frame units */
  int sheet;             /* k: the slab lies between sheets k-1 and k */
  const attenuate_volume *volumes;
  int volume_count;
  int channels;                      /* 1: attenuation is grey; 3 */
  float *transmittance[HL_CHANNELS]; /* the tile's first pixel; rows stride apart */
  float *older[HL_CHANNELS];         /* as transmittance, multiplied alike; null: none */
  size_t stride;
  float *moment[HL_CHANNELS]; /* the tile's first pixel; rows moment_stride apart; null: none. Raised by the
                                 light that the slab absorbs, times `position` */
  size_t moment_stride;
  float position;
  bool marks; /* surfaces mark pixels that are dark, or that they make so; see below */
} attenuate_job;

/* A surface in the dark takes no light, but a method that blurs what was taken before needs to know that it
 * is there: light from beside the shadow ends at it, too. Where less than DARK_AT_START is left, the pixel
 * becomes -DARK_MARK times what the chunk's surfaces let pass, at most -LEAST_MARK. Where a surface takes all
 * light, the pixel becomes -LEAST_MARK. Readers take marks as 0. */
#define DARK_AT_START (1.0f / 256)
#define DARK_MARK     0x1p-64f
#define LEAST_MARK    0x1p-88f

/* Blocks of a tile, one bit each. */
typedef struct attenuated_blocks {
  uint32_t lit;   /* of the blocks with density: those that light still reaches */
  uint32_t taken; /* blocks in which some light was absorbed */
} attenuated_blocks;

/* Multiplies the tile's transmittance by exp(-sum of extinction * path) where volumes have density. */
typedef attenuated_blocks attenuate_tile_function(const attenuate_job *job, int tile_x, int tile_y);

/* The blocks of a tile that light reaches. transmittance: the tile's first pixel of each channel. */
typedef uint32_t lit_blocks_function(const float *const transmittance[HL_CHANNELS], int channels,
                                     size_t stride);

#endif
