/* volume/io/lengths.h - finds the length of a unit that a microscope's file names. */
#ifndef HL_VOLUME_LENGTHS_H
#define HL_VOLUME_LENGTHS_H

/* The length of a unit in micrometres, by the unit's symbol or name; 0 if the unit is not a known unit of
 * length. The case of a symbol's letters matters: "mm" is a millimetre, and "Mm" a megametre. */
double hl_micrometres(const char *unit);

#endif
