/* shadow_cascade/cascade_field.h - declares tile operations on the fields of a cascade: sums, halving,
 * doubling. */
#ifndef HL_SHADOW_CASCADE_CASCADE_FIELD_H
#define HL_SHADOW_CASCADE_CASCADE_FIELD_H

#include <stdint.h>

#include "shadow/blur.h"

/* The type of the pixels of a cascade's fields: absorbed light in units of 1 / FIELD_ONE. A number of 16 bits
 * takes half of the memory traffic of a float. A pixel is at most FIELD_ONE, but may be a little greater in
 * sums of several groups' penumbrae. */
typedef uint16_t field_pixel;
enum { FIELD_ONE = 32768 };

/* The rows of a tile that a pass over a field must compute. */
typedef struct tile_rows {
  int first, end;
} tile_rows;
static const tile_rows ALL_ROWS = {0, TILE};

/* An operation on fields, for the functions of cascade_functions. A field is given by its pixel (0,0). The
 * field's rows are `stride` apart, and zeros surround its pixels. */
typedef struct field_job {
  const field_pixel *a, *b; /* inputs; cascade_functions tells their resolutions. Null stands for a field of
                             * zeros. `b` may be null if it is not coarser than the output. `a` may be null
                             * only if `b` is coarser than the output */
  field_pixel *to;
  size_t stride_in, stride; /* stride: the number of pixels from row to row of the output; stride_in: the
                             * number of pixels from row to row of inputs that have another resolution */
  const field_pixel *thin;  /* the fraction of b that the thin matter of a absorbs; null if a has no thin
                             * matter */
  tile_rows rows;
} field_job;

/* The type of an operation on one tile of fields. The operation returns whether any pixel of the tile's
 * computed rows is above zero. */
typedef int field_tile_function(const field_job *job, int tile_x, int tile_y);

/* A sum with a blur: to = a + (1 - thin) * (from, blurred along rows and columns), in one pass over memory. a
 * and thin may be null, which stands for zeros. */
typedef struct field_blur_job {
  const field_pixel *from, *a; /* pixel (0,0) of the fields; rows are `stride` apart */
  const field_pixel *thin;
  field_pixel *to;
  size_t stride;
  /* the boxes of the blur along rows (u) and along columns (v); their reach is below BLUR_GREATEST_REACH */
  blur_box u, v;
  tile_rows rows;
} field_blur_job;
/* The type of the function that makes a blurred sum of one tile. The function returns whether any pixel of
 * the tile is above zero. */
typedef int field_blur_tile_function(const field_blur_job *job, int tile_x, int tile_y);

/* The work of refilling the buffer at a chunk's end. A pixel becomes the transmittance of the slabs of the
 * chunk that ends, times 1 - absorbed, which is limited to 0 to 1. */
typedef struct refill_job {
  const field_pixel *absorbed; /* the light that all groups absorb; rows are `stride` apart */
  /* 1 minus the light at the start of a chunk: before the refill, at the start of the old chunk; after the
   * refill, 1 minus the new value of `to`. Rows are `stride` apart */
  float *absorbed_at_start;
  float *to; /* the pixels of the shadow buffer; rows are stride_to apart */
  /* the buffer's planes SHADOW_SECOND, which receive the old value of `to` if `again` is set, else the new
   * value; rows are stride_to apart */
  float *older;
  float *outside; /* the light at the outside of surfaces, whose difference from `to` the refill does not
                   * change; rows are stride_to apart; null if the buffer does not keep this light */
  size_t stride, stride_to;
  int kept;  /* whether the chunk's slabs absorbed some light */
  int again; /* whether `to` was also refilled at the start of the chunk that ends */
} refill_job;
typedef void refill_tile_function(const refill_job *job, int tile_x, int tile_y);

/* Weighted sums of a field's pixels at the taps around each pixel: to = sum of from + (1 - sum of thin)
 * to. */
typedef struct field_emission_job {
  const field_pixel *from, *thin; /* pixel (0,0) of the fields; rows are `stride` apart */
  field_pixel *to;
  size_t stride;
  int count;
  const ptrdiff_t *offset; /* [count]; offsets from a pixel to each of its taps, in pixels */
  const float *weight;     /* [count]; the weight of each tap */
} field_emission_job;
/* The type of the function that makes a weighted sum of one tile. The function returns whether any pixel of
 * the tile is above zero. */
typedef int field_emission_tile_function(const field_emission_job *job, int tile_x, int tile_y);

enum { GREATEST_EDGE = 16 };

/* Adds matter to two groups. The matter is the light that a chunk's slabs have absorbed, (1 -
 * absorbed_at_start) - now, and the fraction of this light that thin matter absorbed. The fraction moment /
 * (length * absorbed light) of the matter goes to the group at the chunk's end, and the rest goes to the
 * group at the chunk's start. Where the chunk began in the dark, surfaces that left marks
 * (shadow/attenuate.h) absorb the light that passes the groups before the chunk. Each of the two groups gets
 * one half of this light. Within opaque surfaces, the group at the chunk's end hides all matter before it. */
typedef struct absorbed_job {
  const float *absorbed_at_start; /* 1 minus the light at the chunk's start; rows are `stride` apart */
  /* the transmittance at the chunk's end, or marks of surfaces in the dark; rows are stride_now apart;
   * readable up to `edge` pixels beside a tile */
  const float *now;
  float *moment; /* sum, over the chunk's slabs, of the light that a slab absorbed times the slab's
                  * position in the chunk; the function clears it */
  float length;  /* the length of the chunk, measured in omega */
  const field_pixel *before; /* rows are `stride` apart; the light that the groups before the chunk absorbed;
                              * null if this light is not known */
  field_pixel *start_absorbed, *start_thin; /* the group at the chunk's start, to which matter is added;
                                             * rows are `stride` apart */
  field_pixel *end_absorbed, *end_thin;     /* the group at the chunk's end, to which matter is written;
                                             * rows are `stride` apart */
  size_t stride, stride_now;
  int edge; /* the width in pixels of a strip along the edges of opaque surfaces; in this strip, surfaces do
             * not hide the matter before them. At most GREATEST_EDGE */
} absorbed_job;
/* The type of a function that adds matter in one tile. The function returns which of the four fields of the
 * two groups have pixels above zero, one bit each in the order of the fields. */
typedef uint32_t absorbed_tile_function(const absorbed_job *job, int tile_x, int tile_y);

/* Splits the matter of one group between two groups. The first output may be the input. */
typedef struct split_job {
  const field_pixel *absorbed, *thin; /* pixel (0,0) of the group that is split; rows are `stride` apart */
  field_pixel *to_absorbed[2], *to_thin[2];
  size_t stride;
  float late; /* the fraction of the matter that becomes the second group */
} split_job;
/* The type of a function that splits one tile. The function returns which of the four outputs have a pixel
 * above zero, one bit each: absorbed and thin of the first group, then of the second group. */
typedef uint32_t split_tile_function(const split_job *job, int tile_x, int tile_y);

typedef struct cascade_functions {
  lit_blocks_function *lit_blocks;
  field_blur_tile_function *blur_add;
  field_tile_function *add;        /* to = a + (1 - thin) b */
  field_tile_function *add_half;   /* to = the mean over 2x2 pixels of a + (1 - thin) b; the rows of `to` are
                                    * `stride` apart, the rows of the inputs stride_in */
  field_tile_function *add_double; /* to = a + (1 - thin) b; b has half the resolution (rows stride_in apart),
                                    * and is interpolated bilinearly */
  refill_tile_function *refill;
  absorbed_tile_function *absorbed;
  split_tile_function *split;
  field_tile_function *double_tile; /* to = a, where a has half the resolution (rows stride_in apart), and is
                                     * interpolated bilinearly */
  field_emission_tile_function *emission_add;
} cascade_functions;

#endif
