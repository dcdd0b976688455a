/* plan/shown_values.h - makes a table of the values that a volume's transfer function shows, for maximum
 * projections.
 *
 * In:  a transfer function, and the volume's classifier, whose tables give values their coordinates. Out: for
 * each entry of these tables, the range of the values between this entry and the next one that have an
 * opacity above 0. In the made table, a maximum projection looks up the greatest value that is shown in a
 * range of values. */
#ifndef HL_PLAN_SHOWN_VALUES_H
#define HL_PLAN_SHOWN_VALUES_H

#include "plan/frame_objects.h"

enum { SHOWN_ENTRIES = CLASSIFIER_ENTRIES + 2 };

/* The first three numbers of an entry's row in the table of shown values. The three numbers are table
 * coordinates. Between the entry and the next one, the function shows values above SHOWN_FROM and up to
 * SHOWN_TO. SHOWN_BELOW is the greatest shown value below the entry; -1 if no value below the entry is shown.
 */
enum { SHOWN_FROM, SHOWN_TO, SHOWN_BELOW };

/* Fills the table of a volume. function: the volume's transfer function, in frame space. rows:
 * [SHOWN_ENTRIES]; receives the rows of the table; the fourth number of each row is 0. */
void hl_shown_values_fill(const hl_transfer_function *function, const frame_volume *volume, const grid *grid,
                          float (*rows)[4]);

#endif
