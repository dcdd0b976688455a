/* volume/unpack.h - unpacks a block whose size is known: deflate, Blosc, LZ4, bzip2 and xz. */
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

/* The same for a block of LZ4 (without a header), and a stream of bzip2 or xz. Without its library each
 * fails. Whether the data can hold `count` bytes is asked here before anything is unpacked. */
hl_status hl_unpack_lz4(const char *path, const unsigned char *packed, size_t length, void *bytes,
                        size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_bzip2(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_xz(const char *path, const unsigned char *packed, size_t length, void *bytes,
                       size_t count, bool *sound, hl_error *error);

/* Whether `length` bytes of a codec with this greatest ratio can hold `count`. */
static inline bool hl_packed_can_hold(size_t length, size_t count, size_t ratio) {
  return count / ratio <= length;
}
enum { HL_LZ4_RATIO = 255, HL_BZIP2_RATIO = 25000, HL_XZ_RATIO = 8192 };

#endif
