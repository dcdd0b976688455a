/* volume/io/text.h - reads words and numbers of text headers. The results are the same in every locale. */
#ifndef HL_VOLUME_TEXT_H
#define HL_VOLUME_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { HL_NUMBER_CHARACTERS = 128, HL_PRINTABLE_BYTES = 64 };

/* Returns whether a character is a space, tab, CR, LF, FF or VT. */
static inline bool hl_is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/* Converts all of [text, text + length) to a number, correctly rounded. Also accepts nan, inf and infinity in
 * upper or lower case. Returns false if the text is no number or has HL_NUMBER_CHARACTERS or more
 * characters. */
bool hl_text_number(const char *text, size_t length, double *value);

/* Converts a whole text to a whole number. The text may also have the form 13.0 or 1e3. Returns false if the
 * text is not a whole number that int64_t holds. */
bool hl_text_whole(const char *text, int64_t *whole);

/* Reads numbers separated by white space. Returns the number of numbers, or -1 if the text contains anything
 * else or more than `capacity` numbers. */
int hl_text_numbers(const char *text, double *values, int capacity);

/* Reads integers from 0 to SIZE_MAX, like hl_text_numbers(). */
int hl_text_sizes(const char *text, size_t *values, int capacity);

/* Return whether two texts are equal, or whether a text starts with a prefix. The case of ASCII letters is
 * ignored. */
bool hl_text_equal(const char *a, const char *b);
bool hl_text_starts(const char *text, const char *prefix);
bool hl_text_ends(const char *text, const char *suffix);

/* Returns whether text equals one of the alternatives, which '|' separates: "data file|datafile". */
bool hl_text_is_one_of(const char *text, const char *alternatives);

/* Removes white space from both ends of a text, in place; returns the new start of the text. */
char *hl_text_trim(char *text);

/* Takes the next word (up to white space) at *cursor, and moves *cursor past the word. Returns false if no
 * word follows, or if the word is too long. */
bool hl_text_word(const char **cursor, char *word, size_t capacity);

/* Copies a text from a file or a caller for use in an error line. The copy is cut to the buffer's size, and
 * unprintable bytes become '?'. Returns buffer. */
const char *hl_text_printable(char buffer[HL_PRINTABLE_BYTES], const char *text);

#endif
