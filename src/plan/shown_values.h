/* plan/shown_values.h - the values that a volume's transfer function shows, as a table, for maximum
 * projections.
 *
 * In:  a transfer function, and the volume's classifier, whose tables give values their coordinates. Out: for
 * each entry of these tables, which values from there to the next entry have an opacity above 0. A maximum
 * projection looks up in it the greatest value that is shown in a range of values. */
#ifndef HL_PLAN_SHOWN_VALUES_H
#define HL_PLAN_SHOWN_VALUES_H

#include "plan/frame_objects.h"

enum { SHOWN_ENTRIES = CLASSIFIER_ENTRIES + 2 };

/* The numbers of an entry's row, all coordinates: between the entry and the next one the function shows
 * values above SHOWN_FROM up to SHOWN_TO; SHOWN_BELOW is the greatest value below the entry that it shows, -1
 * if there is none. */
enum { SHOWN_FROM, SHOWN_TO, SHOWN_BELOW };

/* Fills the table of a volume. function: the volume's transfer function, in frame space. rows:
 * [SHOWN_ENTRIES]; the fourth number of a row is 0. */
void hl_shown_values_fill(const hl_transfer_function *function, const frame_volume *volume, const grid *grid,
                          float (*rows)[4]);

#endif
