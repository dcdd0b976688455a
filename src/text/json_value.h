/* text/json_value.h - numbers and texts as JSON writes them. */
#ifndef HL_TEXT_JSON_VALUE_H
#define HL_TEXT_JSON_VALUE_H

#include <stddef.h>

enum { HL_JSON_NUMBER_BYTES = 64, HL_JSON_PIECE_BYTES = 8 };

/* The shortest of 15, 16 or 17 digits that reads back as the same finite number, with a "." in every locale.
 */
void hl_json_number_text(double number, char text[HL_JSON_NUMBER_BYTES]);

/* The length in bytes of the well-formed UTF-8 sequence at c; 0 if there is none (RFC 3629). */
size_t hl_utf8_length(const unsigned char *c);

/* Writes the character at *text, escaped for use between quotes, moves *text past it, and returns the piece's
 * length; 0 at the end. Bytes that are not UTF-8, as file names may hold, become U+FFFD. */
size_t hl_json_piece(const char **text, char piece[HL_JSON_PIECE_BYTES]);

#endif
