/* volume/io/unpack.h - unpacks a block whose size is known: deflate, Blosc, LZ4, bzip2 and xz. */
#ifndef HL_VOLUME_UNPACK_H
#define HL_VOLUME_UNPACK_H

#include <stdbool.h>
#include <stddef.h>

#include "core/error.h"

/* Whether packed data of `length` bytes can hold `count` bytes. Callers ask this before they take memory.
 * Deflate's greatest ratio decides for deflate data, and the block's header for Blosc data. */
bool hl_deflate_can_hold(size_t length, size_t count);
bool hl_blosc_can_hold(const unsigned char *packed, size_t length, size_t count);

/* Unpacks data to bytes[0 .. count). *sound: false if the data are damaged, or hold more or fewer bytes.
 * Deflate data may have zlib's header or gzip's. hl_unpack_blosc() fails in builds without Blosc. */
hl_status hl_unpack_deflate(hl_context *context, const unsigned char *packed, size_t length, void *bytes,
                            size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_blosc(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error);

/* Unpack a block of LZ4 (without a header), or a stream of bzip2 or xz. They fail in builds without their
 * libraries. They check whether the data can hold `count` bytes before anything is unpacked. */
hl_status hl_unpack_lz4(const char *path, const unsigned char *packed, size_t length, void *bytes,
                        size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_bzip2(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_xz(const char *path, const unsigned char *packed, size_t length, void *bytes,
                       size_t count, bool *sound, hl_error *error);

/* Whether `length` packed bytes can hold `count` bytes. ratio: the greatest number of bytes to which the
 * codec can unpack one byte. */
static inline bool hl_packed_can_hold(size_t length, size_t count, size_t ratio) {
  return count / ratio <= length;
}
enum { HL_LZ4_RATIO = 255, HL_BZIP2_RATIO = 25000, HL_XZ_RATIO = 8192 };

#endif
