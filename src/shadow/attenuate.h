/* shadow/attenuate.h - attenuates a light's shadow buffer by the matter of one slab, as seen from the light.
 * Attenuating the buffer is step 17 of the paper's algorithm. */
#ifndef HL_SHADOW_ATTENUATE_H
#define HL_SHADOW_ATTENUATE_H

#include "fill/fill.h"
#include "grid/classifier.h"
#include "light/light_source.h"

/* The densities of one volume in a tile of the light's view. The struct is aligned to whole lines of the
 * cache, because each thread writes a struct of its own. */
typedef struct attenuate_volume {
  _Alignas(64) const classifier *classifier;
  const float *density;       /* [256], block-major; the volume's densities on the current sheet */
  const float *before;        /* [256], block-major; the volume's densities on the sheet before */
  const float *enter, *leave; /* [256], block-major: the heights at which rays enter and leave the volume's
                               * box; null if the box does not cut anything visible */
  uint32_t blocks;            /* the blocks of the tile in which the volume has density on the current sheet
                               * or on the sheet before; one bit each */
  int surface;                /* whether the volume has surfaces; a volume without surfaces is a medium */
  float voxel;                /* the smallest edge of the volume's voxels; frame units */
  float weight[HL_CHANNELS];  /* the relative extinction of red, green and blue light */
  int uncut;                  /* whether the volume's box does not cut the slab in this tile */
  /* set if a face that cuts matter is near and is lit as a surface: the run of slabs (a few successive slabs)
   * that holds the slab; else null */
  const slab_run *faces;
  int slab;         /* the slab's number in the run `faces` */
  const grid *grid; /* the grid from whose gradient the factor of gradient opacity follows */
  const kernel *kernel;
  const float (*to_index)[4]; /* maps frame space to the volume's index space */
} attenuate_volume;

typedef struct attenuate_job {
  sheet_rays rays; /* the rays of the pixels of the light's view; frame space */
  /* the length of the rays' way through the slab, frame units. For parallel light, the length is the distance
   * of sheets divided by |l.h|, where l is the light's direction and h the sheets' normal. For a near light,
   * `path` is the distance of sheets alone, and each pixel divides `path` by |l.h| for its own ray */
  float path;
  float through[3]; /* for parallel light: the step along a ray of the light from one sheet to the next;
                     * frame units */
  /* height: the height of the current sheet above the first sheet; spacing: the current sheet's distance from
   * the sheet before; frame units */
  float height, spacing;
  int sheet; /* the number k of the sheet: the slab lies between sheets k-1 and k */
  const attenuate_volume *volumes;
  int volume_count;
  int channels;                      /* 1: attenuation is grey; 3: red, green and blue are attenuated
                                      * differently */
  float *transmittance[HL_CHANNELS]; /* the tile's first pixel of each channel; rows are `stride` floats
                                      * apart */
  float *older[HL_CHANNELS];         /* a second transmittance, laid out as `transmittance` and multiplied by
                                      * the same factors; null if the buffer has only one */
  const float *left; /* laid out as `transmittance`: for the first channel, the fraction that is left of all
                      * light that the lamp sends; equal to `transmittance`, or to `older` if `transmittance`
                      * holds only the slab's own transmittance */
  /* the light at the outside of surfaces, laid out as `transmittance`; null if the buffer does not keep this
   * light */
  float *outside[HL_CHANNELS];
  size_t stride;
  /* the tile's first pixel of each channel; rows are moment_stride floats apart. The light that the slab
   * absorbs, times `position`, is added to these pixels. Null if nothing is to be added */
  float *moment[HL_CHANNELS];
  size_t moment_stride;
  float position;
  bool marks; /* whether surfaces write marks into pixels that are dark, or that the surfaces make dark; see
               * DARK_AT_START */
} attenuate_job;

/* A volume's surface is lit by the light that arrives at the surface's outside. While light goes deeper into
 * one surface, the matter that the light crosses shades everything behind this matter except the surface
 * itself. So a pixel keeps two numbers: its transmittance T, and the light Y at the outside. Y - T is the
 * light that the surface has absorbed so far. A slab with the transmittance t, in which values go from x1 to
 * x2, changes Y and T as follows (derived):
 *
 *     Y <- T t + k (Y - T) + k' T (1 - t)      T <- T t
 *
 * The depth h of a value is the integral of extinction over values, from the value at which the surface
 * begins (classifier.outside) to this value. In an edge whose values rise evenly, the optical depth up to a
 * value is proportional to h. While light goes on within one surface, which begins at one value, k = k' =
 * min(1, h2 / h1)^OUTWARDS_POWER. Here h1 and h2 are the depths of x1 and x2. So k is 1 while light goes
 * deeper, and falls to 0 where the surface ends. Where light enters another surface within the slab, k = 0
 * and k' = 1. Where light leaves a surface, or a cut's face, k = k' = 0. Pixels in which a slab has no matter
 * keep Y. Where a mask or gradient opacity hides a slab's matter, k = 0. The product of k over slabs depends
 * only on h at the two ends of the light's way, and not on how the way is cut into slabs. Where values hardly
 * change, matter is no surface (classifier.normal_edge): EVEN_VOXELS of such matter on the light's way divide
 * k and k' by e. In a medium k = k' = 0. Where several volumes share a slab, k and k' are means over the
 * volumes, weighted by optical depth.
 *
 * Y does not tell which volume has absorbed Y - T. If several volumes have matter where the light enters a
 * slab, k of each volume is at most the fraction of Y - T that the volume's own matter before the slab can
 * have absorbed: T (e^d - 1) / (Y - T), where d is a bound of this matter's optical depth (derived;
 * part_of_matter() and greatest_depth_of_surface() in grid/classifier_lanes.h). So k = 0 for a surface that
 * begins within the slab, in the midst of another volume's matter: the other volume shades the surface.
 *
 * A face that cuts matter is a surface, too. The outside of this surface is the face itself, and light goes
 * deeper into the surface whatever the values behind the face are: k = k' = 1 for visible matter up to a
 * voxel behind a face through which the light comes in. Deeper than a voxel, the k that follows from the
 * values is raised to the power 1 - skin. The skin is 1 up to a voxel behind the face, and falls to 0 at
 * FACE_VOXELS behind the face. Over this distance behind the face, the eye sees less and less of the face,
 * too (render/slab_lanes.h).
 *
 * Where two faces of a cut meet in an inner corner, light that comes through matter to the corner lights
 * neither face as light at an outside: k = k' = 0 on the way to the corner, within FACE_VOXELS of it, where T
 * < DARK. Otherwise pixels whose light passes below the corner would keep Y, and samples on the face in shade
 * would read these pixels, too. */

/* Marks of surfaces in the dark. A surface in the dark absorbs no light. But a shadow method that blurs
 * absorbed light needs to know where the surface is, because blurs move light from beside the shadow to the
 * surface, where this light ends, too. Where less than DARK_AT_START of the light is left, the pixel becomes
 * -DARK_MARK times the transmittance of the chunk's surfaces, but not more than -LEAST_MARK. Where a surface
 * absorbs all light, the pixel becomes -LEAST_MARK. A reader of the light must take marks as 0. */
#define DARK_MARK  0x1p-64f
#define LEAST_MARK 0x1p-88f

/* Three sets of blocks of a tile, with one bit for each block. */
typedef struct attenuated_blocks {
  uint32_t lit;     /* the blocks with density that some light still reaches, or in which the outside of a
                     * surface is lit */
  uint32_t taken;   /* the blocks in which the slab absorbed some light */
  uint32_t changed; /* the blocks in `taken`, and the blocks in which the slab absorbed nothing, but hidden
                     * matter ended surfaces */
} attenuated_blocks;

/* The type of the function that attenuates a tile. The function multiplies the tile's transmittance by the
 * transmittance of the slab, exp(-sum of extinction * path), wherever volumes have density. */
typedef attenuated_blocks attenuate_tile_function(const attenuate_job *job, int tile_x, int tile_y);

/* Returns the blocks of a tile that light reaches, one bit each. transmittance: for each channel, the tile's
 * first pixel. */
typedef uint32_t lit_blocks_function(const float *const transmittance[HL_CHANNELS], int channels,
                                     size_t stride);

#endif
