/* shadow_cascade/cascade_field.h - tile operations on the fields of a cascade: sums, halving, doubling. */
#ifndef HL_SHADOW_CASCADE_CASCADE_FIELD_H
#define HL_SHADOW_CASCADE_CASCADE_FIELD_H

#include <stdint.h>

#include "shadow/blur.h"

/* Light that is lacking, in FIELD_ONEths: of groups and sums up to all of it, of sums of several groups'
 * penumbrae somewhat more. Half as much memory to go through as floats. */
typedef uint16_t field_pixel;
enum { FIELD_ONE = 32768 };

/* Of a tile, those that a pass is to find. */
typedef struct tile_rows {
  int first, end;
} tile_rows;
static const tile_rows ALL_ROWS = {0, TILE};

/* A field's pixels: pixel (0,0); rows stride apart; zeros all around it. */
typedef struct field_job {
  const field_pixel *a, *b; /* inputs; b may be coarser or finer, as the function says; null for zeros where
                               it is not coarser; so may a where b is */
  field_pixel *to;
  size_t stride_in, stride; /* of b and of the rest where they differ */
  const field_pixel *thin;  /* beside a: the part of b that a's matter takes; null: none */
  tile_rows rows;
} field_job;

/* Returns whether any pixel of the tile's rows is more than zero. */
typedef int field_tile_function(const field_job *job, int tile_x, int tile_y);

/* to = a + (1 - thin) (from blurred along rows, then along columns), in one pass over memory; a and thin
 * null: 0. */
typedef struct field_blur_job {
  const field_pixel *from, *a; /* pixel (0,0); rows stride apart */
  const field_pixel *thin;
  field_pixel *to;
  size_t stride;
  blur_box u, v; /* reach below BLUR_GREATEST_REACH */
  tile_rows rows;
} field_blur_job;
/* Returns as field_tile_function does. */
typedef int field_blur_tile_function(const field_blur_job *job, int tile_x, int tile_y);

/* A chunk's end: the light that is left, 1 - lacking, from 0 to 1, times what the slabs of the chunk left of
 * what it began with. */
typedef struct refill_job {
  const field_pixel *absorbed; /* rows stride apart */
  float
      *absorbed_at_start; /* rows stride apart; 1 - the light at the chunk's start; becomes that at its end */
  float *to;              /* rows stride_to apart; the light that was left; becomes what is left now */
  float *older; /* rows stride_to apart; becomes what `to` was, or is now if it was not found at the chunk's
                   start */
  size_t stride, stride_to;
  int kept;  /* the chunk's slabs took some of `to` */
  int again; /* `to` was found at the chunk's start as well */
} refill_job;
typedef void refill_tile_function(const refill_job *job, int tile_x, int tile_y);

/* Weighted sums of a field's pixels around each pixel: to = sum of from + (1 - sum of thin) to. */
typedef struct field_emission_job {
  const field_pixel *from, *thin; /* pixel (0,0); rows stride apart */
  field_pixel *to;
  size_t stride;
  int count;
  const ptrdiff_t *offset; /* [count]; from a pixel to the one that is weighed */
  const float *weight;     /* [count] */
} field_emission_job;
/* Returns as field_tile_function does. */
typedef int field_emission_tile_function(const field_emission_job *job, int tile_x, int tile_y);

/* What a chunk's slabs took of the light before it: (1 - lacked) - now, and the part of it that thin matter
 * took. Of either the part moment / (length taken) goes to the group at the chunk's end, the rest to the one
 * at its start. */
typedef struct absorbed_job {
  const float *absorbed_at_start; /* rows stride apart */
  const float *now;               /* rows stride_now apart */
  float *moment; /* sum over the slabs of what each took, times its place in the chunk; is cleared */
  float length;  /* of the chunk */
  field_pixel *start_absorbed, *start_thin, *end_absorbed, *end_thin; /* rows stride apart; raised; written */
  size_t stride, stride_now;
} absorbed_job;
/* Returns which of the four were given more than zero: a bit each, in their order. */
typedef uint32_t absorbed_tile_function(const absorbed_job *job, int tile_x, int tile_y);

/* Matter parted in two; the first may take its place. */
typedef struct split_job {
  const field_pixel *absorbed, *thin; /* pixel (0,0); rows stride apart */
  field_pixel *to_absorbed[2], *to_thin[2];
  size_t stride;
  float late; /* the part of it that is the second's */
} split_job;
/* Returns which of the four have any pixel of more than zero: absorbed and thin of the first, then of the
 * second, a bit each. */
typedef uint32_t split_tile_function(const split_job *job, int tile_x, int tile_y);

typedef struct cascade_functions {
  lit_blocks_function *lit_blocks;
  field_blur_tile_function *blur_add;
  field_tile_function *add;        /* to = a + (1 - thin) b */
  field_tile_function *add_half;   /* to (stride) = mean over 2x2 pixels of a + (1 - thin) b (stride_in) */
  field_tile_function *add_double; /* to = a + (1 - thin) (b of half the resolution, stride_in, bilinear) */
  refill_tile_function *refill;
  absorbed_tile_function *absorbed;
  split_tile_function *split;
  field_tile_function *double_tile; /* to = a of half the resolution (stride_in), bilinear */
  field_emission_tile_function *emission_add;
} cascade_functions;

#endif
