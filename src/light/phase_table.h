/* light/phase_table.h - Henyey and Greenstein's phase function, its mean over wide lights and parts of a
 * sky.
 *
 * A table for each anisotropy holds the mean of p over round caps of directions, over p in the direction of
 * the cap's middle: a row for each size of a cap, a column for each angle to its middle. Angles and sizes are
 * told by
 *
 *     s(angle) = sqrt(1 + g^2 - 2 g cos(angle)),      p = (1 - g^2) / s^3,
 *
 * g > 0, which runs from 1 - g to 1 + g: columns are even steps of s, rows even steps of its logarithm. For g
 * < 0 the table is that of -g, and angles are those to the opposite of the light. A row of its own, exactly
 * at its size, serves each wide parallel light. */
#ifndef HL_LIGHT_PHASE_TABLE_H
#define HL_LIGHT_PHASE_TABLE_H

#include <halflight/scene.h>

#include "core/key.h"
#include "core/memory.h"
#include "core/pool.h"

enum { PHASE_COLUMNS = 512, PHASE_CAPS = 64 };

typedef struct phase_table {
  double g;                         /* 0 < g < 1 */
  float rows_per_log2;              /* of caps, by the binary logarithm of s^2 */
  float (*caps)[PHASE_COLUMNS][2];  /* [PHASE_CAPS]; [0] of a row, [1] of the next one; only where there
                                       is a sky, or some light is wide and not parallel */
  float (*parallel)[PHASE_COLUMNS]; /* [lights]; rows of lights that are not wide and parallel are not set */
} phase_table;

/* The tables of a scene; kept between frames while anisotropies and lights stay the same. */
typedef struct phase_tables {
  void *memory;        /* owned; holds tables and numbers */
  size_t bytes;        /* of memory */
  phase_table *tables; /* [count] */
  size_t count;        /* 0: no medium needs any */
  float *numbers;      /* of all tables */
  hl_key key;
} phase_tables;

/* Counts what hl_phase_update() takes. */
void hl_phase_count(const hl_scene_description *scene, hl_layout *layout);

hl_status hl_phase_update(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                          phase_tables *tables, hl_error *error);
void hl_phase_release(hl_context *context, phase_tables *tables);

/* The table of an anisotropy or its opposite; null: there is none. */
const phase_table *hl_phase_table(const phase_tables *tables, double anisotropy);

#endif
