/* field/sky_field.h - the sky's light in the cells of a lattice, kept from frame to frame. */
#ifndef HL_FIELD_SKY_FIELD_H
#define HL_FIELD_SKY_FIELD_H

#include "core/key.h"
#include "core/memory.h"
#include "core/pool.h"
#include "field/opacity.h"
#include "scene/scene.h"

/* Numbers of 16 bits lie between minus and plus this one. */
enum { SKY_MOST = 32767 };

/* A cell is SKY_CELL numbers of 16 bits. lanes_unpack_shorts() brings those of two cells together; this one
 * stands where a harmonic then is number `harmonic` of the sums. At SKY_PASSING, where no harmonic is, stand
 * the cell's transmittance and that of the next cell along x; 1 is SKY_MOST. */
enum { SKY_CELL = 32, SKY_PASSING = 28 };
/* Where no harmonic is either: the parts of the way to the next cell along x, y and z at which surfaces cut
 * it; 0: none does. */
static const int SKY_CUTS[3] = {23, 30, 31};
static inline int hl_sky_place(int harmonic) {
  int low = harmonic < 16, i = low ? harmonic : harmonic - 16;
  return i / 4 * 8 + i % 4 + (low ? 0 : 4);
}

/* What samples look up. */
typedef struct sky_light {
  const int16_t *cells; /* [z][y][x][SKY_CELL], rows row_numbers apart: harmonics, FIELD_HARMONICS x channels
                           of them, the channels of each beside each other, at hl_sky_place(); zero where
                           nothing is near; null: no sky */
  size_t row_numbers;   /* numbers from row to row */
  int32_t count[3];
  float low[3], inverse_cell, cell; /* of the lattice */
  float lift; /* by which look-ups are moved off a surface, along its normal; frame units */
  int channels;
  int cut;                        /* surfaces may cut the ways between cells (SKY_CUTS) */
  float stored_unit[3];           /* [channels]; the light that the number 1 stands for */
  float color[3];                 /* a factor on the field's light */
  float open[3][FIELD_HARMONICS]; /* [channels]; light that nothing hides, without the factor */
} sky_light;

typedef struct sky_field {
  void *memory; /* owned; the cells */
  size_t bytes;
  sky_light light;
  hl_key key; /* of what the field was made of */
} sky_field;

/* What a field is made of. Matter's casts are 1 or 0; colors: relative extinctions, [matter][3]. */
typedef struct sky_content {
  const hl_sky *sky;
  field_content content;
  const double (*colors)[3]; /* attenuation colours */
  field_lattice lattice;
  int channels; /* 3 where light of the channels comes from other directions or is attenuated differently */
  const light_exchange
      *exchange; /* with processes that find a part of the field each; null: there are none */
} sky_content;

/* Counts what hl_sky_make() takes besides what the field holds from the frame before. */
void hl_sky_count(const sky_content *content, const sky_field *held, hl_layout *layout);

/* Makes the field anew. */
hl_status hl_sky_make(hl_context *context, hl_pool *pool, const sky_content *content,
                      const field_functions *functions, sky_field *made, hl_error *error);
void hl_sky_release(hl_context *context, sky_field *field);

#endif
