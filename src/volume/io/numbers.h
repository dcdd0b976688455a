/* volume/io/numbers.h - reads numbers from a stream, written as text or as binary numbers of any type. */
#ifndef HL_VOLUME_NUMBERS_H
#define HL_VOLUME_NUMBERS_H

#include "volume/io/stream.h"
#include "volume/io/text.h"
#include "volume/volume.h"

/* Returns whether a character may stand between numbers of a text. */
static inline bool hl_is_separator(unsigned char c) { return hl_is_space((char)c) || c == ','; }

/* Reads the next number of a text. *found: set to false at the end of the text. */
hl_status hl_next_number(hl_stream *stream, double *value, bool *found, hl_error *error);

/* The type and the coding of numbers in a stream. */
typedef struct hl_number_code {
  hl_voxel_type type;
  bool text, big_endian; /* text: whether the numbers are decimal numbers in a text, which may have any
                          * type */
} hl_number_code;

/* Converts the bytes of a number of the given type to a double. */
double hl_binary_number(const unsigned char *bytes, hl_voxel_type type, bool big_endian);

/* Reads `count` numbers. *numbers: [count], owned by the caller (hl_release). Integers are exact up to 2^53.
 * If the stream is too short for `count` numbers, fails before memory is allocated. */
hl_status hl_read_numbers(hl_stream *stream, const hl_number_code *code, uint64_t count, double **numbers,
                          hl_error *error);

#endif
