/* shadow/shadow_buffer.h - the 2D shadow buffer: transmittance from the light to the current sheet.
 *
 * It is perpendicular to the light's direction for hard shadows, parallel to the sheets for soft ones (fig.
 * 17). At the volume its pixels are little larger than the picture's. Around it is a margin of ones,
 * unattenuated light, which blurs read. */
#ifndef HL_SHADOW_SHADOW_BUFFER_H
#define HL_SHADOW_SHADOW_BUFFER_H

#include "core/pool.h"
#include "light/light_source.h"
#include "shadow/attenuate.h"
#include "view/occupancy.h"

typedef struct shadow_buffer {
  view view;
  int channels; /* 1: grey attenuation; 3: R, G, B */
  int tiles_x, tiles_y;
  size_t stride;                     /* floats from row to row */
  size_t plane;                      /* floats of one channel, margins included */
  size_t origin;                     /* offset of pixel (0,0) in a plane */
  float *transmittance[HL_CHANNELS]; /* pixel (0,0); in memory */
  float *second[HL_CHANNELS];  /* pixel (0,0); in memory; null: none. The method's second planes: for `paper`
                                  the  result of half a blur, for `cascade` the light that samples fade from */
  float *planes;               /* in memory; [1 or 2][channels][plane] */
  uint16_t *tile_lit;          /* in memory; [tiles]; blocks that light still reaches */
  unsigned char *tile_touched; /* in memory; [2][tiles]; 1 where some transmittance is below 1 */
  void *memory;                /* owned; kept from frame to frame while it is large enough */
  size_t capacity;             /* bytes of memory */
} shadow_buffer;

/* The input that decides a buffer's position and size. */
typedef struct shadow_extent {
  const vec3 *points; /* corners of the region to cover; frame space */
  int point_count;
  double pixel;           /* wanted edge of a pixel at the volume, frame units */
  int resolution;         /* pixels along the longer side; 0: by pixel */
  size_t greatest_pixels; /* limit of width * height */
  double margin;          /* around the points, for penumbrae: frame units; at distance 1 for a near light */
  const vec3 *content;    /* corners of all content, beyond which no margin is needed; frame space */
  int content_count;
  vec3 u; /* unit; the direction of the buffer's rows; zero: the light's tilt */
} shadow_extent;

/* Lays out the view: plane_normal is the light's direction (hard) or the sheets' normal (soft). */
void hl_shadow_view(const light_source *source, vec3 plane_normal, const shadow_extent *extent, view *view);

/* What a buffer has room for. */
typedef struct shadow_buffer_size {
  const view *view;
  int channels; /* 1 or 3 */
  bool second;  /* a second set of planes, too */
  int reach;    /* pixels that blurs read beyond a tile */
} shadow_buffer_size;

/* (Re)allocates and sets all transmittances to 1. */
hl_status hl_shadow_buffer_reset(hl_context *context, hl_pool *pool, shadow_buffer *buffer,
                                 const shadow_buffer_size *size, hl_error *error);
/* Floats of one channel of a buffer for a view, its margins included. */
size_t hl_shadow_plane(const view *view, int reach);
/* The bytes that hl_shadow_buffer_reset() needs. */
uint64_t hl_shadow_buffer_bytes(const shadow_buffer_size *size);
/* Finds a tile's tile_lit again after a blur. both: a block is lit where the second planes have light, too.
 */
void hl_shadow_buffer_find_lit(shadow_buffer *buffer, int x, int y, bool both,
                               lit_blocks_function *lit_blocks);
void hl_shadow_buffer_release(hl_context *context, shadow_buffer *buffer);

/* ---- Looking up shadow buffers at samples: the map to their pixels, and the transmittance ---- */

/* The map from frame space to a buffer's pixels. */
typedef struct shadow_map {
  float rows[3][4]; /* frame space -> (w, w u, w v) of the buffer */
  size_t stride;    /* of its pixels' rows */
  int width, height;
} shadow_map;

typedef struct shadow_lookup {
  shadow_map map;
  const float *transmittance[HL_CHANNELS]; /* pixel (0,0) */
  const float
      *older[HL_CHANNELS]; /* pixel (0,0); null: none. The earlier transmittance, from which samples fade */
  float young;             /* how far samples have faded to `transmittance`, 0 to 1 */
} shadow_lookup;

/* Transmittance in units of 1 / SUBLIGHT_ONE, to halve the memory traffic of floats. */
typedef uint16_t sublight_pixel;
enum { SUBLIGHT_ONE = 65535 };

/* The buffer of one sub-light. */
typedef struct sublight_lookup {
  shadow_map map;
  const sublight_pixel *transmittance[HL_CHANNELS]; /* pixel (0,0) */
  float weight[HL_CHANNELS]; /* in the mean over all sub-lights; 1 for lights without an emission image */
} sublight_lookup;

/* The map of a view's pixels; the caller sets its stride. */
shadow_map hl_map_of_view(const view *view);

#endif
