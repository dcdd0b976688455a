/* light/sublights.h - soft shadows as the mean of many sharp ones (beyond the paper).
 *
 * The light is cut into M x M parts; each part is a point (or a direction) with a buffer of its own, seen from it on a plane
 * parallel to the sheets. A slab is classified once, in the view of the light's centre; seen from a part its image is only
 * scaled and shifted, so for the parts the composite alone repeats: each reads the slab's transmittance at the nearest half
 * pixel, and what a buffer has gathered, in 16 bits, is never resampled. A sample takes the mean over all buffers, each through its own
 * map. The parts are a turned grid: along either side of the light they are M^2 even steps. */
#ifndef HL_LIGHT_SUBLIGHTS_H
#define HL_LIGHT_SUBLIGHTS_H

#include "core/pool.h"
#include "core/reserve.h"
#include "light/light_extent.h"
#include "light/light_image.h"
#include "light/shadow_lookup.h"
#include "light/sublight_field.h"

enum { SUBLIGHT_REACH = 31 /* of the slab's buffer, beyond a tile */ };

/* One part's buffer. */
typedef struct sublight {
  view view;
  part_pixel *pixels;     /* pixel (0,0) of the first channel; the others a plane apart; in memory */
  unsigned char *dark;    /* [tiles]; 1 where no light is left; in flags */
  sublight_job job;       /* of the slab now composited */
  bool reaches;           /* the part lies before the slab */
  bool shifted;           /* the job's scale is 1 */
} sublight;

typedef struct sublights {
  int count, channels, tiles_x, tiles_y;
  size_t stride, plane;
  int slabs;              /* composited so far */
  sublight *parts;        /* owned; [count] */
  part_lookup *lookups;   /* owned; [count] */
  part_pixel *memory;     /* lent; [count][channels] planes */
  unsigned char *flags;   /* owned; [count][tiles] */
  float *moved;           /* lent; [channels][SLAB_IMAGES - 1] planes of the slab, half a pixel further along u, v and both */
  slab_rows *rows;        /* owned; [tiles of the slab] */
} sublights;

typedef struct sublight_functions {
  sublight_tile_function *composite;
  sublight_row_function *composite_row; /* where pixels are only shifted */
  half_pixel_tile_function *half_pixel;
} sublight_functions;

/* image: the light's, null where it is even. side: M. slab: the buffer of one slab at a time. */
hl_status hl_sublights_begin(hl_reserve *reserve, hl_pool *pool, sublights *sublights, const light_source *source,
                             const light_image *image, int side, vec3 normal, const shadow_extent *extent,
                             const shadow_buffer *slab, hl_error *error);
/* The bytes that they then hold. slab, reach: of that buffer. */
uint64_t hl_sublights_bytes(const light_source *source, const light_image *image, int side, vec3 normal,
                            const shadow_extent *extent, int channels, const view *slab, int reach);
void hl_sublights_release(hl_reserve *reserve, sublights *sublights);

/* After the slab between these heights was composited into slab, a buffer that held ones: composites it into all parts,
 * and makes slab ones again; its lit tiles are those that some part's light still reaches. */
void hl_sublights_advance(sublights *sublights, shadow_buffer *slab, vec3 normal, double from, double to, hl_pool *pool,
                          const sublight_functions *functions);

#endif
