/* text/json_value.h - writes numbers and texts in the form of JSON. */
#ifndef HL_TEXT_JSON_VALUE_H
#define HL_TEXT_JSON_VALUE_H

#include <stddef.h>

enum { HL_JSON_NUMBER_BYTES = 64, HL_JSON_PIECE_BYTES = 8 };

/* Writes a finite number with 15, 16 or 17 digits. The number of digits is the least number from which a
 * reader gets the same number. The decimal point is "." in every locale. */
void hl_json_number_text(double number, char text[HL_JSON_NUMBER_BYTES]);

/* The length in bytes of the well-formed UTF-8 sequence that begins at c; 0 if no such sequence begins there
 * (RFC 3629). */
size_t hl_utf8_length(const unsigned char *c);

/* Writes the character at *text in the form in which a string of JSON contains the character (with an escape
 * if needed), and moves *text behind the character. Returns the number of bytes that were written; 0 at the
 * text's end. Bytes that are not UTF-8, which occur in names of files, become U+FFFD. */
size_t hl_json_piece(const char **text, char piece[HL_JSON_PIECE_BYTES]);

#endif
