/* text/number_word.h - reads and uses the word in a text or in a file's name that stands for a number: "%d",
 * "%4d" or "%04d". */
#ifndef HL_TEXT_NUMBER_WORD_H
#define HL_TEXT_NUMBER_WORD_H

#include <stdbool.h>
#include <stddef.h>

/* The greatest number of bytes of a written number. */
enum { HL_NUMBER_BYTES = 24 };

typedef struct hl_number_word {
  size_t length; /* the number of bytes of the word */
  int width;     /* the least number of characters of the number */
  bool zeros;    /* whether a shorter number is padded with zeros instead of blanks */
} hl_number_word;

/* Reads the word for a number with which a text begins. letters: the letters that may end the word, such as
 * "d". Returns false if the text does not begin with a word for a number, or if the word asks for a width of
 * more than 20 characters. */
bool hl_number_word_read(const char *text, const char *letters, hl_number_word *word);

/* Writes a number in the form that the word describes. Returns the length of the written text. */
size_t hl_number_word_write(const hl_number_word *word, long number, char to[HL_NUMBER_BYTES]);

#endif
