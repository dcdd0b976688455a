/* light/sublights.h - soft shadows as the mean of many sharp ones (beyond the paper).
 *
 * The light is cut into M x M parts; each part is a point (or a direction) with a buffer of its own, seen from it on a plane
 * parallel to the sheets. A slab is classified once, in the view of the light's centre; seen from a part its image is only
 * scaled and shifted, so for the parts the composite alone repeats: each reads the slab's transmittance bilinearly, and what
 * a buffer has gathered is never resampled. A sample takes the mean over all buffers, each through its own map. The parts
 * are a turned grid: along either side of the light they are M^2 even steps, and a small blur of each buffer, growing with
 * distance, closes what is left between steps. */
#ifndef HL_LIGHT_SUBLIGHTS_H
#define HL_LIGHT_SUBLIGHTS_H

#include "core/pool.h"
#include "light/cascade_field.h"
#include "light/light_extent.h"
#include "light/shadow_lookup.h"
#include "light/sublight_field.h"

enum { SUBLIGHT_MARGIN = 48 };

/* One part's buffer. */
typedef struct sublight {
  view view;
  double pixel;           /* frame units; not parallel: at distance 1 */
  float *pixels;          /* pixel (0,0) of the first channel; the others a plane apart; in memory */
  unsigned char *touched; /* [tiles]; 1 where some light is missing; in flags */
  unsigned char *dark;    /* [tiles]; 1 where no light is left; in flags */
  sublight_job job;       /* of the slab now composited */
  bool reaches;           /* the part lies before the slab */
} sublight;

typedef struct sublights {
  int count, channels, tiles_x, tiles_y;
  size_t stride, plane;
  sublight *parts;        /* owned; [count] */
  shadow_lookup *lookups; /* owned; [count] */
  float *memory;          /* owned; [count + 1][channels] planes, the last one spare */
  unsigned char *flags;   /* owned; [2 count + 1][tiles] */
  float *spare;           /* pixel (0,0); what the next blur writes */
  unsigned char *spare_touched;
  /* blurs */
  bool parallel;
  double light_height;
  double width_u, width_v; /* of the whole light as the sheets see it */
  double step, next;      /* of omega of a unit wide light: from blur to blur; where the next one is due */
  double variance;        /* of one blur, for a unit wide light */
} sublights;

typedef struct sublight_functions {
  sublight_tile_function *composite;
  blur_add_tile_function *blur;
  lit_blocks_function *lit_blocks;
} sublight_functions;

/* side: M. first, last: heights of the sweep's sheets. */
hl_status hl_sublights_begin(hl_context *context, hl_pool *pool, sublights *sublights, const light_source *source,
                             int side, const sheet_light *seen, vec3 normal, const shadow_extent *extent, int channels,
                             double first, double last, hl_error *error);
/* The bytes that they then hold. */
uint64_t hl_sublights_bytes(const light_source *source, int side, vec3 normal, const shadow_extent *extent, int channels);
void hl_sublights_release(hl_context *context, sublights *sublights);

/* After the slab between these heights was composited into slab, a buffer that held ones: composites it into all parts,
 * and makes slab ones again; its lit tiles are those that some part's light still reaches. */
void hl_sublights_advance(sublights *sublights, shadow_buffer *slab, vec3 normal, double from, double to, hl_pool *pool,
                          const sublight_functions *functions);

#endif
