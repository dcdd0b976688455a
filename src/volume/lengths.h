/* volume/lengths.h - units of length as microscopes' files name them. */
#ifndef HL_VOLUME_LENGTHS_H
#define HL_VOLUME_LENGTHS_H

/* The micrometres of a unit by its symbol or name; 0: it is no length that is known. Symbols are told apart
 * by the case of their letters: "mm" and "Mm". */
double hl_micrometres(const char *unit);

#endif
