/* volume/numbers.h - numbers from a stream: written as text, or binary of any type. */
#ifndef HL_VOLUME_NUMBERS_H
#define HL_VOLUME_NUMBERS_H

#include "volume/stream.h"
#include "volume/text.h"
#include "volume/volume.h"

/* What stands between numbers of a text. */
static inline bool hl_is_separator(unsigned char c) { return hl_is_space((char)c) || c == ','; }

/* Reads the next number of a text; *found is false at the end. */
hl_status hl_next_number(hl_stream *stream, double *value, bool *found, hl_error *error);

/* How numbers are written. */
typedef struct hl_number_code {
  hl_voxel_type type;
  bool text, big_endian; /* text: decimal, of any type */
} hl_number_code;

/* The number of the type's bytes. */
double hl_binary_number(const unsigned char *bytes, hl_voxel_type type, bool big_endian);

/* Reads `count` numbers. *numbers: owned by the caller (hl_release), [count]; integers are exact up to 2^53.
 * Fails, before memory is taken, where the stream cannot hold so many. */
hl_status hl_read_numbers(hl_stream *stream, const hl_number_code *code, uint64_t count, double **numbers,
                          hl_error *error);

#endif
