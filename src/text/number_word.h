/* text/number_word.h - the word in a text, or in the name of a file, that stands for a number: "%d", "%4d" or
 * "%04d". */
#ifndef HL_TEXT_NUMBER_WORD_H
#define HL_TEXT_NUMBER_WORD_H

#include <stdbool.h>
#include <stddef.h>

/* The greatest number of bytes of a written number. */
enum { HL_NUMBER_BYTES = 24 };

typedef struct hl_number_word {
  size_t length; /* the number of bytes of the word */
  int width;     /* the least number of characters of the number */
  bool zeros;    /* whether zeros stand before a shorter number, and not blanks */
} hl_number_word;

/* Reads the word with which a text begins. letters: the letters that may end it, as "d". Returns false if the
 * text begins with no such word, or if its numbers would be wider than 20 characters. */
bool hl_number_word_read(const char *text, const char *letters, hl_number_word *word);

/* Writes a number in the form of the word. Returns its length. */
size_t hl_number_word_write(const hl_number_word *word, long number, char to[HL_NUMBER_BYTES]);

#endif
