/* text/number_word.c - see number_word.h. */
#include "text/number_word.h"

#include <stdio.h>
#include <string.h>

enum { WIDEST = 20 };

bool hl_number_word_read(const char *text, const char *letters, hl_number_word *word) {
  if (text[0] != '%') return false;
  const char *at = text + 1;
  *word = (hl_number_word){.zeros = *at == '0'};
  for (; *at >= '0' && *at <= '9' && word->width <= WIDEST; at++)
    word->width = 10 * word->width + (*at - '0');
  word->length = (size_t)(at + 1 - text);
  return *at != '\0' && strchr(letters, *at) != NULL && word->width <= WIDEST;
}

size_t hl_number_word_write(const hl_number_word *word, long number, char to[HL_NUMBER_BYTES]) {
  return (size_t)snprintf(to, HL_NUMBER_BYTES, word->zeros ? "%0*ld" : "%*ld", word->width, number);
}
