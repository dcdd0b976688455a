/* field/sky_field.h - makes the field of the sky's light in the cells of a lattice. The field is kept from
 * frame to frame. */
#ifndef HL_FIELD_SKY_FIELD_H
#define HL_FIELD_SKY_FIELD_H

#include "core/key.h"
#include "core/memory.h"
#include "core/pool.h"
#include "core/sheet_constants.h"
#include "field/opacity.h"
#include "scene/scene.h"

/* The sky's light that samples look up. */
typedef struct sky_light {
  /* [z][y][x][SKY_CELL]; a row has row_numbers numbers. A cell has FIELD_HARMONICS x channels harmonics at
   * the indices of SKY_PLACE(), the channels of a harmonic beside each other. It is zero where nothing
   * visible is near. Null if there is no sky. */
  const int16_t *cells;
  uint64_t version;   /* the version of `cells`; a number that rises each time the field is made */
  size_t row_numbers; /* number of 16-bit numbers from one row of cells to the next */
  int32_t count[3];
  /* low: the lattice's low corner, frame space; cell: the edge of a cell, frame units; inverse_cell: 1 /
   * cell */
  float low[3], inverse_cell, cell;
  float lift; /* distance by which look-ups are moved off a surface, along its normal; frame units */
  int channels;
  int cut;                        /* whether surfaces may cut the ways between cells (SKY_CUT) */
  float stored_unit[3];           /* [channels]; the amount of light for which the number 1 in a cell
                                   * stands */
  float color[3];                 /* a factor on the field's light */
  float open[3][FIELD_HARMONICS]; /* [channels]; harmonics of the light that arrives if nothing hides the sky;
                                   * they are not in units of stored_unit */
} sky_light;

typedef struct sky_field {
  void *memory; /* owned; the memory of light.cells */
  size_t bytes;
  sky_light light;
  hl_key key; /* the key of the field's content */
} sky_field;

/* The content from which a sky's field is made. The member `cast` of each matter must be 1 or 0. */
typedef struct sky_content {
  const hl_sky *sky;
  field_content content;
  /* [number of matters]; for each volume, the relative extinction of red, green and blue light */
  const double (*colors)[3];
  field_lattice lattice;
  bool media;   /* whether a visible volume is a medium without surfaces */
  int channels; /* number of channels: 3 if the light of the channels comes from different directions, or if
                 * matter attenuates the channels differently; else 1 */
  const light_exchange
      *exchange; /* exchange with processes that each find a part of the field; null if there are none */
} sky_content;

/* Counts the memory that hl_sky_make() takes in addition to the memory of `held`, the field of the frame
 * before. */
void hl_sky_count(const sky_content *content, const sky_field *held, hl_layout *layout);

/* Makes the sky's field from its content. */
hl_status hl_sky_make(hl_context *context, hl_pool *pool, const sky_content *content,
                      const field_functions *functions, sky_field *made, hl_error *error);
void hl_sky_release(hl_context *context, sky_field *field);

#endif
