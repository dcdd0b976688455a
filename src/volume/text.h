/* volume/text.h - words and numbers of text headers, the same in every locale. */
#ifndef HL_VOLUME_TEXT_H
#define HL_VOLUME_TEXT_H

#include <stdbool.h>
#include <stddef.h>

enum { HL_NUMBER_CHARACTERS = 128, HL_PRINTABLE_BYTES = 64 };

/* Space, tab, CR, LF, FF, VT. */
static inline bool hl_is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/* The whole of [text, text + length) as a number, correctly rounded; nan, inf and infinity in any case too.
 * False if it is anything else or HL_NUMBER_CHARACTERS or longer. */
bool hl_text_number(const char *text, size_t length, double *value);

/* Numbers separated by white space; their count, or -1 if something else is there or there are more than
 * capacity. */
int hl_text_numbers(const char *text, double *values, int capacity);

/* The same for whole numbers from 0 to SIZE_MAX. */
int hl_text_sizes(const char *text, size_t *values, int capacity);

/* Letters of ASCII compare without case. */
bool hl_text_equal(const char *a, const char *b);
bool hl_text_starts(const char *text, const char *prefix);
bool hl_text_ends(const char *text, const char *suffix);

/* Whether text equals one of the alternatives, which '|' separates: "data file|datafile". */
bool hl_text_is_one_of(const char *text, const char *alternatives);

/* Cuts white space from both ends, in place; returns the new start. */
char *hl_text_trim(char *text);

/* The next word (up to white space) at *cursor, which moves past it; false if there is none or it is too
 * long. */
bool hl_text_word(const char **cursor, char *word, size_t capacity);

/* A short form of foreign text fit for an error line: unprintable bytes become '?'. Returns buffer. */
const char *hl_text_printable(char buffer[HL_PRINTABLE_BYTES], const char *text);

#endif
