/* shadow/shadow_buffer.h - describes the shadow buffer, an image that holds the transmittance from a light to
 * each of the last sheets.
 *
 * For hard shadows the buffer is perpendicular to the light's direction, for soft shadows parallel to the
 * sheets (fig. 17). At the volume, the buffer's pixels are hardly larger than the picture's pixels. Around
 * the buffer lies a margin of ones (unattenuated light), which blurs read.
 *
 * The buffer advances from sheet to sheet ahead of the picture, and the picture reads the buffer's planes
 * (images) for earlier sheets. So the buffer keeps the planes of the last sheets in a ring: sheet k has the
 * planes number k % ring. A tile that has changed is copied from sheet to sheet until all planes of the ring
 * hold its last content. A tile that never changes costs nothing.
 *
 * Surfaces of volumes are lit by the light that arrives at their outside. If a scene has such surfaces, a
 * pixel also holds the light at the outside of the surface in which the pixel's ray is: the transmittance
 * plus the light that this surface has absorbed (attenuate.h). */
#ifndef HL_SHADOW_SHADOW_BUFFER_H
#define HL_SHADOW_SHADOW_BUFFER_H

#include "core/memory.h"
#include "core/pool.h"
#include "light/light_source.h"
#include "shadow/attenuate.h"
#include "view/occupancy.h"

/* The kinds of planes that a shadow buffer may have for one sheet. */
typedef enum shadow_plane {
  SHADOW_TRANSMITTANCE,
  SHADOW_OUTSIDE, /* the light that arrives at the outside of the surface in which a pixel's ray is; at least
                   * the transmittance */
  SHADOW_SECOND   /* planes that a shadow method uses for itself: `paper` keeps half-blurred light in them,
                   * `cascade` keeps the older light from which samples fade to the transmittance */
} shadow_plane;

typedef struct shadow_buffer {
  view view;
  int channels; /* 1: grey attenuation; 3: R, G, B */
  int tiles_x, tiles_y;
  size_t stride;                     /* number of floats from one row of a plane to the next */
  size_t plane;                      /* number of floats of one channel's plane, margins included */
  size_t origin;                     /* offset of pixel (0,0) in a plane */
  int ring;                          /* number of sheets whose planes are kept */
  bool has_outside, has_second;      /* whether each sheet has planes of these two kinds in addition to the
                                      * transmittance */
  float *transmittance[HL_CHANNELS]; /* pixel (0,0) of each channel's transmittance, in the planes of sheet
                                      * `sheet`; a part of `memory` */
  /* pixel (0,0) of each channel of the planes `outside` and of the planes `second`, for sheet `sheet`; all
   * channels of a kind are null if the buffer has no planes of this kind */
  float *outside[HL_CHANNELS], *second[HL_CHANNELS];
  int sheet;                   /* the sheet for which hl_shadow_buffer_reach() was
                                * called last */
  float *planes;               /* a part of `memory`; [ring][kinds of
                                * planes][channels][plane] */
  int32_t *changed;            /* a part of `memory`; [tiles]; the last sheet at which the tile's planes
                                * changed */
  uint16_t *tile_lit;          /* a part of `memory`; [tiles]; for each tile, the blocks that light still
                                * reaches, one bit each */
  unsigned char *tile_touched; /* a part of `memory`; [tiles]; 1 for tiles in which some transmittance is
                                * below 1. A second array of [tiles] follows, for the shadow method */
  void *memory;    /* owned; the memory of all arrays, which is kept from frame to frame if it is large
                    * enough */
  size_t capacity; /* bytes of `memory` */
} shadow_buffer;

/* The facts that decide the position and size of a shadow buffer. */
typedef struct shadow_extent {
  const vec3 *points; /* corners of the region to cover; frame space */
  int point_count;
  double pixel;           /* wanted edge of a buffer's pixel where the volume is, frame units */
  int resolution;         /* number of pixels along the longer side; 0 if `pixel` decides */
  size_t greatest_pixels; /* the greatest allowed number of pixels, width * height */
  double margin;          /* the margin for penumbrae around the points: its width in frame units; for a near
                           * light, its width at distance 1 */
  const vec3 *content;    /* corners of all content, beyond which no margin is needed; frame space */
  int content_count;
  vec3 u; /* unit vector along the buffer's rows; zero if the direction of the rows follows from the light's
           * tilt */
} shadow_extent;

/* Makes the view of a shadow buffer. plane_normal: the normal of the buffer's plane; for hard shadows the
 * light's direction, for soft shadows the sheets' normal. */
void hl_shadow_view(const light_source *source, vec3 plane_normal, const shadow_extent *extent, view *view);

/* The size of a buffer for which memory is counted or allocated. */
typedef struct shadow_buffer_size {
  const view *view;
  int channels;         /* 1: grey attenuation; 3: R, G, B */
  bool outside, second; /* whether each sheet also has planes SHADOW_OUTSIDE and SHADOW_SECOND */
  int reach;            /* number of pixels beyond a tile that blurs read */
  int ring;             /* number of sheets whose planes are kept; at least 1 */
} shadow_buffer_size;

/* Allocates a buffer's memory, or keeps memory that is large enough. Sets all transmittances to 1. */
hl_status hl_shadow_buffer_reset(hl_context *context, hl_pool *pool, shadow_buffer *buffer,
                                 const shadow_buffer_size *size, hl_error *error);
/* Sets a buffer's view, tiles, stride, plane and origin. reach: the number of pixels beyond a tile that blurs
 * read. */
void hl_shadow_buffer_measure(const view *view, int reach, shadow_buffer *buffer);
/* The number of floats of one channel of a buffer for a view, its margins included. */
size_t hl_shadow_plane(const view *view, int reach);
/* Counts the memory that hl_shadow_buffer_reset() takes. */
void hl_shadow_buffer_count(const shadow_buffer_size *size, hl_layout *layout);
/* The number of bytes of one sheet's planes. */
uint64_t hl_shadow_sheet_bytes(const shadow_buffer_size *size);

/* Pixel (0,0) of a channel, in a sheet's planes of one kind. The buffer must have planes of this kind. */
float *hl_shadow_plane_at(const shadow_buffer *buffer, int sheet, shadow_plane kind, int channel);
/* Sets the buffer's pointers `transmittance`, `outside` and `second` to the planes of the given sheet. */
void hl_shadow_buffer_reach(shadow_buffer *buffer, int sheet);
/* Returns whether a tile's planes of this sheet, or of a sheet after it, still lack the tile's last content,
 * which must then be copied. */
static inline bool hl_shadow_is_carried(const shadow_buffer *buffer, size_t tile, int sheet) {
  return buffer->changed[tile] > 0 && buffer->changed[tile] > sheet - buffer->ring;
}
/* Copies a tile from the planes of the previous sheet to the planes of `sheet`, unless the planes of `sheet`
 * hold the same numbers already. If hl_shadow_is_carried() is true for a tile, call this function for each
 * sheet in turn, before the tile changes at the sheet. */
void hl_shadow_buffer_carry(shadow_buffer *buffer, size_t tile, int sheet);
/* Finds the lit blocks of a tile (tile_lit) again after a blur. both: whether blocks also count as lit if
 * only the planes SHADOW_SECOND have light in them. */
void hl_shadow_buffer_find_lit(shadow_buffer *buffer, int x, int y, bool both,
                               lit_blocks_function *lit_blocks);
void hl_shadow_buffer_release(hl_context *context, shadow_buffer *buffer);

/* ---- Looking up shadow buffers at samples: the map to their pixels, and the transmittance ---- */

/* The map from frame space to a buffer's pixels. */
typedef struct shadow_map {
  float rows[3][4]; /* maps frame space to (w, w u, w v), where w is a divisor and (u, v) is the position in
                     * the buffer in pixels */
  size_t stride;    /* number of floats from one row of the buffer's pixels to the next */
  int width, height;
} shadow_map;

typedef struct shadow_lookup {
  shadow_map map;
  const float *transmittance[HL_CHANNELS]; /* pixel (0,0) of the planes that are looked up */
  const float *outside[HL_CHANNELS];       /* planes of the light at the outside of surfaces, laid out as
                                            * `transmittance`; null if the buffer has no such planes */
  const float *older[HL_CHANNELS]; /* pixel (0,0) of the planes of the older light, one for each channel.
                                    * Samples fade from the older light to `transmittance`. Null if samples do
                                    * not fade */
  float young;                     /* the weight of `transmittance` while samples fade from `older` to
                                    * `transmittance`, from 0 (beginning) to 1 (end) */
} shadow_lookup;

/* The transmittance in the buffer of a sub-light (one of the points that stand for a light), in units of 1 /
 * SUBLIGHT_ONE. A number of 16 bits takes half of the memory traffic of a float. */
typedef uint16_t sublight_pixel;

/* The data by which samples look up the buffer of one sub-light. */
typedef struct sublight_lookup {
  shadow_map map;
  const sublight_pixel *transmittance[HL_CHANNELS]; /* pixel (0,0) of each channel of the sub-light's
                                                     * transmittance */
  const sublight_pixel *outside[HL_CHANNELS];       /* the light at the outside of surfaces, laid out as
                                                     * `transmittance`; null if the buffer does not keep this
                                                     * light */
  float weight[HL_CHANNELS]; /* the sub-light's weight in the mean over all sub-lights; 1 for lights
                              * without an emission image */
} sublight_lookup;

/* The map of a view's pixels. The caller sets the map's stride. */
shadow_map hl_map_of_view(const view *view);

#endif
