/* shadow_sublights/sublights.h - makes soft shadows as the mean of many sharp shadows (beyond the paper).
 *
 * M x M sub-lights stand for the light. Each sub-light is a point, or a direction, and has a shadow buffer of
 * its own, parallel to the sheets. A slab is classified once, in the view of the light's centre. Seen from a
 * sub-light, the slab has the image that the light's centre sees, only scaled and shifted. So the slab is not
 * classified again for each sub-light: the sub-light's buffer is multiplied by the slab's transmittance at
 * the nearest half pixel. A buffer's pixels have 16 bits. Each buffer is looked up at a sample through a map
 * of its own. A sample takes the mean over all buffers. */
#ifndef HL_SHADOW_SUBLIGHTS_SUBLIGHTS_H
#define HL_SHADOW_SUBLIGHTS_SUBLIGHTS_H

#include "shadow/shadow_method.h"
#include "shadow_sublights/sublight_field.h"

enum { SUBLIGHT_REACH = 31 /* number of pixels beyond a tile of the slab's buffer that may be read */ };

/* Maps positions on the slab, in pixels along u and v, to positions in a sub-light's buffer: scale *
 * (position - shift). The numbers are floats, so that every device finds the blocks that the processors find.
 */
typedef struct sublight_map {
  float scale[2], shift[2];
} sublight_map;

/* The maps of a sub-light for a run of slabs. */
typedef struct sublight_maps {
  sublight_map near, far; /* near: the map for the first slab of the run; far: the map for the last slab */
  bool reaches; /* whether the sub-light's rays reach the first slab of the run, so that the maps are
                 * set */
  bool comes;   /* whether the sub-light lies within the run: its rays reach the last slab of the run, but not
                 * the first slab */
} sublight_maps;

/* One sub-light with its buffer. */
typedef struct sublight {
  view view;
  sublight_pixel *pixels; /* pixel (0,0) of the first channel of the transmittance; a part of `memory`. The
                           * other channels follow, each a plane apart, and then the channels of the light at
                           * the outside of surfaces */
  /* [tiles]; the blocks that had light at the end of the last run of slabs, one bit each; a part of
   * `flags` */
  uint16_t *lit;
  unsigned char *touched; /* [tiles]; 1 for tiles in which slabs have absorbed light since the lit blocks were
                           * found last; a part of `marks` */
  sublight_job job;       /* the job that attenuates the sub-light's buffer by the current slab */
  bool reaches;           /* whether the slab lies beyond the sub-light, so that the sub-light's rays reach
                           * the slab */
  sublight_place place;   /* the place of the current slab in the sub-light's view */
  sublight_maps maps;     /* the maps for the next run of slabs */
} sublight;

typedef struct sublights {
  int count, channels, tiles_x, tiles_y;
  int kinds; /* number of kinds of planes: 1, or 2 if buffers also keep the light at the outside of
              * surfaces */
  size_t stride, plane;
  int slabs; /* number of slabs that have been composited so far */
  /* the arrays below lie in one block of memory, which lay_out_sublights() lays out */
  sublight *sublight;       /* [count]; the sub-lights */
  sublight_lookup *lookups; /* [count]; how samples look up each sub-light's buffer */
  sublight_pixel *memory;   /* [count][kinds][channels] planes; the buffers of all sub-lights */
  uint16_t *flags;          /* [count][tiles]; the array `lit` of each sub-light */
  unsigned char *marks;     /* [count][tiles]; the array `touched` of each sub-light */
  float *moved; /* [kinds][channels][SLAB_COPIES - 1] planes: the slab's copies shifted by half a pixel */
  size_t moved_floats;
  slab_rows *rows; /* [tiles of the slab]; the rows in which some pixel is below 1 */
  uint32_t *found; /* [tiles of the slab]; for each tile, the run of slabs for which the tile's lit blocks
                    * were found last; 0 if they were never found */
} sublights;

/* ---- for a device ---- */

/* Lit blocks are found once for a run of slabs. The first slab is a run of its own; each later run has
 * LIT_SLABS slabs. slab: a slab's number among the slabs that the light reaches, from 0. */
enum { LIT_SLABS = 4 };
static inline int hl_sublight_run(int slab) { return (slab + LIT_SLABS - 1) / LIT_SLABS + 1; }

/* Makes the view of sub-light i of a planned shadow. */
void hl_sublight_view(const light_shadow *shadow, int i, view *view);

/* Finds the place of a slab in a sub-light's view. The views of the slab and of the sub-light are parallel to
 * the sheets and have the same axes, so the slab's pixels are only scaled and shifted. slab: the view of the
 * light's centre. height: the height of the slab's middle. Returns false if the slab lies behind the
 * sub-light or behind the light's centre. */
bool hl_sublight_place(const view *sublight, const view *slab, vec3 normal, double height,
                       sublight_place *place);

/* Finds the number that is added before values are truncated in a slab (`carry` of sublight_field.h): the
 * fractional part of a multiple of the golden ratio. The numbers of successive slabs are therefore spread
 * evenly between 0 and 1. slabs: the number of slabs before the slab. i: the sub-light's number among
 * `count`. */
float hl_sublight_carry(int slabs, int i, int count);

/* Finds a sub-light's maps for the run of slabs that begins at a height. */
sublight_maps hl_sublight_maps(const view *sublight, const view *slab, vec3 normal, double height,
                               double spacing);

/* The sub-light's blocks that lie under a tile of the slab: for each of the tile's four rows (or columns) of
 * blocks, the first and the last row (or column) of the sub-light's blocks. */
typedef struct blocks_under {
  int32_t first[TILE / BLOCK], last[TILE / BLOCK];
} blocks_under;
/* tiles: the number of the sub-light's tiles along the axis. */
blocks_under hl_sublight_blocks(const sublight_maps *maps, int axis, int tile, int tiles);

/* Sets slab->tile_lit of a tile: the blocks of the next slab that light of some sub-light still reaches. Only
 * one task may work on a tile at a time. */
void hl_sublights_find_lit(const sublights *sublights, shadow_buffer *slab, size_t tile);

#endif
