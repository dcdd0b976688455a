/* light/phase_table.h - makes tables of the means of Henyey and Greenstein's phase function over wide lights
 * and parts of a sky.
 *
 * A table for each anisotropy holds the mean of p over round caps of directions, divided by p in the
 * direction of the cap's middle. The table has a row for each size of a cap, and a column for each angle to
 * the cap's middle. Angles, and the angles up to which caps reach, are measured by
 *
 *     s(angle) = sqrt(1 + g^2 - 2 g cos(angle)),      p = (1 - g^2) / s^3,
 *
 * g > 0, which runs from 1 - g to 1 + g: columns are even steps of s, rows even steps of its logarithm. For g
 * < 0 the table for -g is used, with angles to the opposite of the light. Each wide parallel light has a row
 * of its own, exactly for its size. */
#ifndef HL_LIGHT_PHASE_TABLE_H
#define HL_LIGHT_PHASE_TABLE_H

#include <halflight/scene.h>

#include "core/key.h"
#include "core/memory.h"
#include "core/pool.h"

enum { PHASE_COLUMNS = 512, PHASE_CAPS = 64 };

typedef struct phase_table {
  double g;            /* the anisotropy of the table, 0 < g < 1 */
  float rows_per_log2; /* number of rows of caps for each doubling of s^2 (see the head of the
                        * file) */
  /* [PHASE_CAPS]; for each size of a cap and each angle, two numbers: [0] is the mean of this row, [1] the
   * mean of the next row. Set only if the scene has a sky, or a light that is wide and not parallel */
  float (*caps)[PHASE_COLUMNS][2];
  /* [lights]; a row for each light; only the rows of wide parallel lights are set */
  float (*parallel)[PHASE_COLUMNS];
} phase_table;

/* The tables of a scene. The tables are kept between frames as long as anisotropies and lights do not change.
 */
typedef struct phase_tables {
  void *memory;        /* owned; the memory of `tables` and `numbers` */
  size_t bytes;        /* bytes of `memory` */
  phase_table *tables; /* [count]; in `memory` */
  size_t count;        /* number of tables; 0 if no medium of the scene needs a table */
  float *numbers;      /* the numbers of all tables, one table after the other; in `memory` */
  hl_key key;
} phase_tables;

/* Counts the memory that hl_phase_update() takes. */
void hl_phase_count(const hl_scene_description *scene, hl_layout *layout);

hl_status hl_phase_update(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                          phase_tables *tables, hl_error *error);
void hl_phase_release(hl_context *context, phase_tables *tables);

/* Returns the table for an anisotropy or for its opposite; null if the scene has no such table. */
const phase_table *hl_phase_table(const phase_tables *tables, double anisotropy);

#endif
