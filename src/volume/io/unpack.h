/* volume/io/unpack.h - unpacks a block whose size is known: deflate, Blosc, LZ4, bzip2 and xz. */
#ifndef HL_VOLUME_UNPACK_H
#define HL_VOLUME_UNPACK_H

#include <stdbool.h>
#include <stddef.h>

#include "core/error.h"

/* Returns whether packed data of `length` bytes can unpack to `count` bytes. Callers call
 * hl_deflate_can_hold() or hl_blosc_can_hold() before they allocate memory. For deflate data, the greatest
 * possible ratio decides. For Blosc data, the size in the block's header decides. */
bool hl_deflate_can_hold(size_t length, size_t count);
bool hl_blosc_can_hold(const unsigned char *packed, size_t length, size_t count);

/* Unpacks data, which must unpack to exactly `count` bytes. *sound: set to false if the data are damaged, or
 * unpack to more or fewer bytes. Deflate data may have the header of zlib or of gzip. hl_unpack_blosc() fails
 * in builds without Blosc. */
hl_status hl_unpack_deflate(hl_context *context, const unsigned char *packed, size_t length, void *bytes,
                            size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_blosc(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error);

/* Unpack a block of LZ4 (without a header), a stream of bzip2, or a stream of xz. In builds without the
 * library of a packing, its function fails. The functions first check whether the data can unpack to `count`
 * bytes. */
hl_status hl_unpack_lz4(const char *path, const unsigned char *packed, size_t length, void *bytes,
                        size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_bzip2(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error);
hl_status hl_unpack_xz(const char *path, const unsigned char *packed, size_t length, void *bytes,
                       size_t count, bool *sound, hl_error *error);

/* Returns whether `length` packed bytes can unpack to `count` bytes. ratio: the greatest number of bytes to
 * which one packed byte can unpack. */
static inline bool hl_packed_can_hold(size_t length, size_t count, size_t ratio) {
  return count / ratio <= length;
}
enum { HL_LZ4_RATIO = 255, HL_BZIP2_RATIO = 25000, HL_XZ_RATIO = 8192 };

#endif
