/* volume/unpack.h - unpacks a block whose size is known: deflate and Blosc. */
#ifndef HL_VOLUME_UNPACK_H
#define HL_VOLUME_UNPACK_H

#include <stdbool.h>
#include <stddef.h>

#include "core/error.h"

/* Whether packed data can hold `count` bytes; asked before memory is taken for them. Deflate: by the best
 * that it can do. Blosc: by what the block's own header says. */
bool hl_deflate_can_hold(size_t length, size_t count);
bool hl_blosc_can_hold(const unsigned char *packed, size_t length, size_t count);

/* Fills bytes [0, count). *sound: false where the data hold another number of bytes or are damaged. Deflate:
 * with zlib's header or gzip's. Without its library hl_unpack_blosc fails. */
hl_status hl_unpack_deflate(hl_context *context, const unsigned char *packed, size_t length, void *bytes,
                            size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_blosc(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error);

#endif
