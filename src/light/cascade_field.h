/* light/cascade_field.h - tile operations on the fields of a cascade: products, halving, doubling. */
#ifndef HL_LIGHT_CASCADE_FIELD_H
#define HL_LIGHT_CASCADE_FIELD_H

#include "light/blur.h"

/* A field's pixels: pixel (0,0); rows stride apart; ones all around it. */
typedef struct field_job {
  const float *a, *b; /* inputs; b may be coarser or finer, as the function says */
  float *to;
  size_t stride_in, stride; /* of b and of the rest where they differ */
} field_job;

/* to = a * b, all of one resolution (stride). */
typedef void field_tile_function(const field_job *job, int tile_x, int tile_y);

/* to = a * (from blurred along rows, then along columns), in one pass over memory; a null: 1. */
typedef struct blur_multiply_job {
  const float *from, *a; /* pixel (0,0); rows stride apart */
  float *to;             /* rows stride_to apart */
  size_t stride, stride_to;
  blur_box u, v;         /* reach below BLUR_GREATEST_REACH */
} blur_multiply_job;
enum { BLUR_GREATEST_REACH = 46 };
typedef void blur_multiply_tile_function(const blur_multiply_job *job, int tile_x, int tile_y);

typedef struct cascade_functions {
  lit_blocks_function *lit_blocks;
  blur_multiply_tile_function *blur_multiply;
  field_tile_function *multiply;       /* to = a * b */
  field_tile_function *multiply_half;  /* to (stride) = mean over 2x2 pixels of a * b (stride_in) */
  field_tile_function *multiply_double; /* to = a * (b of half the resolution, stride_in, bilinear) */
} cascade_functions;

#endif
