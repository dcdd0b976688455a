/* core/key.h - makes and compares the keys of results that are kept for later use. A key consists of the
 * bytes of all data on which its result depends. */
#ifndef HL_CORE_KEY_H
#define HL_CORE_KEY_H

#include <stdbool.h>
#include <stdint.h>

#include "core/error.h"
#include "core/vector.h"

typedef struct hl_key {
  unsigned char *bytes; /* owned; the bytes of the key; if null, the bytes are only counted */
  size_t count;
} hl_key;

void hl_key_add(hl_key *key, const void *bytes, size_t count);

/* Adds numbers to a key in such a form that memcmp() sorts keys as the numbers are sorted: -2, -1, 0, 1, 2.
 * Multiplying all numbers by one positive factor does not change the order of keys. */
void hl_key_add_numbers(hl_key *key, const double *numbers, size_t count);

static inline void hl_key_add_whole(hl_key *key, int64_t number) { hl_key_add(key, &number, sizeof number); }

static inline void hl_key_add_affine(hl_key *key, const affine3 *map) {
  for (int row = 0; row < 3; row++) hl_key_add_numbers(key, &map->linear.row[row].x, 3);
  hl_key_add_numbers(key, &map->offset.x, 3);
}

/* Returns a hash that stands for a block of bytes in keys. The chance that different bytes have the same hash
 * is one in 2^64. */
uint64_t hl_key_mark(const void *bytes, size_t count);

/* The type of a function that adds to a key all data on which a result depends. A function of this type must
 * add the same bytes in each call for the same data. */
typedef void hl_key_write(const void *data, hl_key *key);

/* Finds out whether the kept key equals the key of the data, so that the kept result is still valid. If the
 * keys differ, the data's key becomes the kept key. After a failure the kept key is unchanged. */
hl_status hl_key_renew(hl_context *context, hl_key_write *write, const void *data, hl_key *kept, bool *same,
                       hl_error *error);

void hl_key_release(hl_context *context, hl_key *key);

#endif
