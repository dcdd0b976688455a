/* text/json_value.c - writes numbers and texts in the form of JSON (RFC 8259). */
#include "text/json_value.h"
#include "text/plain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void hl_json_number_text(double number, char text[HL_JSON_NUMBER_BYTES]) {
  for (int digits = 15; digits <= 17; digits++) {
    hl_plain_print(text, HL_JSON_NUMBER_BYTES, "%.*g", digits, number);
    if (hl_plain_number(text, NULL) == number) break;
  }
  if (signbit(number) && number == 0) strcpy(text, "-0.0");
}

size_t hl_utf8_length(const unsigned char *c) {
  static const unsigned char least_second[4] = {0x80, 0x80, 0xa0,
                                                0x90}; /* the least second byte of a sequence that begins
                                                        * with 0xe0 or 0xf0: it refuses overlong sequences */
  size_t length = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : c[0] < 0xf5 ? 4 : 0;
  for (size_t i = 1; i < length; i++)
    if ((c[i] & 0xc0) != 0x80) return 0;
  if ((c[0] == 0xe0 || c[0] == 0xf0) && c[1] < least_second[length - 1]) return 0;
  if ((c[0] == 0xed && c[1] > 0x9f) || (c[0] == 0xf4 && c[1] > 0x8f))
    return 0; /* a greater second byte would make a surrogate (after 0xed) or a code beyond Unicode (after
               * 0xf4) */
  return length;
}

size_t hl_json_piece(const char **text, char piece[HL_JSON_PIECE_BYTES]) {
  const unsigned char *c = (const unsigned char *)*text;
  size_t length = hl_utf8_length(c);
  if (*c == 0) return 0;
  *text += length > 0 ? length : 1;
  if (*c == '"' || *c == '\\') return (size_t)snprintf(piece, HL_JSON_PIECE_BYTES, "\\%c", *c);
  if (*c < 0x20) return (size_t)snprintf(piece, HL_JSON_PIECE_BYTES, "\\u%04x", (unsigned)*c);
  if (length == 0) return (size_t)snprintf(piece, HL_JSON_PIECE_BYTES, "\\ufffd");
  memcpy(piece, c, length);
  return length;
}
