/* shadow_sublights/sublights.h - soft shadows as the mean of many sharp ones (beyond the paper).
 *
 * The light is cut into M x M sub-lights; each sub-light is a point (or a direction) with a buffer of its
 * own, seen from it on a plane parallel to the sheets. A slab is classified once, in the view of the light's
 * centre; seen from a sub-light its picture is only scaled and shifted, so for the sub-lights the composite
 * alone repeats: each reads the slab's transmittance at the nearest half pixel, and what a buffer has
 * gathered, in 16 bits, is never resampled. A sample takes the mean over all buffers, each through its own
 * map. The sub-lights are a turned grid: along either side of the light they are M^2 even steps. */
#ifndef HL_SHADOW_SUBLIGHTS_SUBLIGHTS_H
#define HL_SHADOW_SUBLIGHTS_SUBLIGHTS_H

#include "shadow/shadow_lookup.h"
#include "shadow_sublights/sublight_field.h"

enum { SUBLIGHT_REACH = 31 /* of the slab's buffer, beyond a tile */ };

/* From pixels of the slab to those of a sub-light, along u and v: scale * (pixel - shift). */
typedef struct sublight_map {
  double scale[2], shift[2];
} sublight_map;

/* One sub-light's buffer. */
typedef struct sublight {
  view view;
  sublight_pixel *pixels; /* pixel (0,0) of the first channel; the others a plane apart; in memory */
  uint16_t *lit; /* [tiles]; blocks in which light is left, or was before the last few slabs; in flags */
  unsigned char *touched; /* [tiles]; 1 where those took some; in marks */
  sublight_job job;       /* of the slab now composited */
  bool reaches;           /* the sub-light lies before the slab */
  bool shifted;           /* the job's scale is 1 */
  sublight_map near, far; /* of the next slab, and of the last one that shares its lit blocks */
  bool comes;             /* the sub-light does not reach the next one, but the last */
} sublight;

typedef struct sublights {
  int count, channels, tiles_x, tiles_y;
  size_t stride, plane;
  int slabs; /* composited so far */
  /* in one block, see lay_out_sublights() */
  sublight *sublight;       /* [count] */
  sublight_lookup *lookups; /* [count] */
  sublight_pixel *memory;   /* [count][channels] planes */
  uint16_t *flags;          /* [count][tiles] */
  unsigned char *marks;     /* [count][tiles] */
  float *moved; /* [channels][SLAB_COPIES - 1] planes of the slab, half a pixel further along u, v and both */
  size_t moved_floats;
  slab_rows *rows; /* [tiles of the slab] */
  uint32_t *found; /* [tiles of the slab]; the run of slabs for which its lit blocks were found; 0: none */
} sublights;

/* Finds the blocks of a tile of the next slab that some sub-light's light still reaches: slab's tile_lit. One
 * task has a tile. */
void hl_sublights_find_lit(const sublights *sublights, shadow_buffer *slab, size_t tile);

#endif
