/* text/units.h - finds units of length by their names, converts lengths, and chooses units for lengths. */
#ifndef HL_TEXT_UNITS_H
#define HL_TEXT_UNITS_H

#include <stddef.h>

typedef struct hl_unit {
  const char *symbol;   /* the unit's symbol in figures */
  const char *names[3]; /* the unit's names in files and in options; null after the last name */
  double metres;
  int chosen; /* whether hl_unit_for() may choose this unit */
} hl_unit;

/* The unit of length that has a given name; null if no known unit has this name. */
const hl_unit *hl_unit_find(const char *name);

/* The ratio metres / other_metres of two lengths above 0. A ratio that is a whole number, or 1 over a whole
 * number, is exact. */
double hl_length_ratio(double metres, double other_metres);

/* The factor by which lengths in one unit are multiplied to get lengths in another unit. The factor is 1 if
 * one of the names is null or not the name of a known unit. */
double hl_unit_ratio(const char *from, const char *to);

/* Chooses the unit for a length: the unit in which the length is a number from 1 to 1000. If no unit gives
 * such a number, the result is the unit whose number is nearest to the range from 1 to 1000. */
const hl_unit *hl_unit_for(double metres);

/* The greatest number of the form 1, 2 or 5 times a power of ten that is at most `most`. */
double hl_round_length(double most);

#endif
