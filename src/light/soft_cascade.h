/* light/soft_cascade.h - soft shadows whose penumbrae have the right width (beyond the paper).
 *
 * Seen from the light's centre on a plane parallel to the sheets, an occluder at o and a receiver at r blur each other
 * by a width that is a difference, w = omega(r) - omega(o): these widths add from sheet to sheet, but under
 * convolution variances do. So the occluding slabs are kept in groups of doubling thickness, the nearest thin, the
 * farthest thick. The light that passes is found from the farthest group on: multiply, blur by the variance
 * (w(o -> r)^2 - w(o' -> r)^2) / 12 on the way to the next group o', and so on; the variances telescope, and every
 * group ends with the variance of its own penumbra. Far groups are kept coarser (what passed them is blurred wide) and
 * renewed more rarely (their widths change slowly).
 *
 * omega: parallel light  (L / D) z / cos(t), the disk of directions on the sheets' plane; point light -L / Z.
 * Along the light's tilt t the disk is 1 / cos(t) longer. */
#ifndef HL_LIGHT_SOFT_CASCADE_H
#define HL_LIGHT_SOFT_CASCADE_H

#include "core/pool.h"
#include "light/cascade_field.h"
#include "light/shadow_buffer.h"

enum { CASCADE_LEVELS = 16, CASCADE_GROUPS = 7, CASCADE_MARGIN = 48 };

/* Transmittance over the pixels of a level, ones around them. */
typedef struct cascade_field {
  float *pixels;       /* pixel (0,0); in the level's memory */
  unsigned char *ones; /* [tiles]; 1 where the tile is all ones: work skips it; in the level's flags */
} cascade_field;

/* The product of some neighbouring slabs. */
typedef struct cascade_group {
  cascade_field transmittance[HL_CHANNELS];
  double omega;                      /* mean over its slabs, pixels of the buffer */
  double weight;                     /* slabs */
} cascade_group;

typedef struct cascade_level {
  int scale;                         /* buffer pixels a pixel of this level */
  int tiles_x, tiles_y;
  size_t stride, plane, origin;
  cascade_group group[CASCADE_GROUPS]; /* oldest first */
  int count;
  cascade_field passed[2][HL_CHANNELS]; /* what passed all groups up to one of this level, for a recent receiver */
  int newest;                        /* which of passed is the newest group's */
  bool renewed;                      /* passed is to be found anew */
  cascade_field scratch;
  float *memory;                     /* owned */
  unsigned char *flags;              /* owned */
} cascade_level;

typedef struct soft_cascade {
  bool parallel;
  double rate;          /* parallel: omega per height; else L in units of a pixel at distance 1 */
  double light_height;
  double stretch;       /* of the penumbra along the buffer's u axis */
  double chunk;         /* omega of a chunk of slabs, pixels */
  double chunk_start;   /* omega */
  double chunk_weight, chunk_sum; /* slabs in it; sum of their omega */
  uint64_t chunks;      /* finished */
  int channels;
  int level_count;      /* levels with memory */
  cascade_level level[CASCADE_LEVELS];
  cascade_field current[HL_CHANNELS]; /* the chunk's transmittance, on level 0; who multiplies a tile clears its ones */
} soft_cascade;

/* pixel: buffer pixel (parallel: frame units; else at distance 1). first, last: heights of the sweep's sheets. */
hl_status hl_soft_cascade_begin(hl_context *context, soft_cascade *cascade, const light_source *source, vec3 normal,
                                double first, double last, double pixel, shadow_buffer *buffer, hl_error *error);
void hl_soft_cascade_release(hl_context *context, soft_cascade *cascade);

/* After the slab between these heights was composited into the buffer and into current. */
void hl_soft_cascade_advance(soft_cascade *cascade, shadow_buffer *buffer, double from, double to, hl_pool *pool,
                             const cascade_functions *functions);

#endif
