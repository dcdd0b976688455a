/* volume/unpack.c - one block of deflate or Blosc data into memory of the caller's. */
#include "volume/unpack.h"

#include <zlib.h>
#ifdef HL_HAS_BLOSC
#include <blosc.h>
#endif

#include "core/memory.h"

/* ---- deflate ---- */

bool hl_deflate_can_hold(size_t length, size_t count) {
  enum { GREATEST_RATIO = 1032 }; /* 258 bytes in two bits */
  return count / GREATEST_RATIO <= length;
}

static voidpf zlib_allocate(voidpf context, uInt count, uInt size) {
  return hl_allocate(context, count, size);
}
static void zlib_release(voidpf context, voidpf memory) { hl_release(context, memory); }

/* zlib counts in 32 bits. */
static uInt at_most(size_t left) { return left < (1u << 30) ? (uInt)left : 1u << 30; }

hl_status hl_unpack_deflate(hl_context *context, const unsigned char *packed, size_t length, void *bytes,
                            size_t count, bool *sound, hl_error *error) {
  enum { EITHER_HEADER = 15 + 32 }; /* zlib.h: zlib or gzip, by its first bytes */
  z_stream zlib = {.zalloc = zlib_allocate,
                   .zfree = zlib_release,
                   .opaque = context,
                   .next_in = (Bytef *)packed,
                   .next_out = bytes};
  if (inflateInit2(&zlib, EITHER_HEADER) != Z_OK) return hl_fail_memory(error, 50000, "decompression");
  int answer = Z_OK;
  while (answer == Z_OK) {
    size_t taken = (size_t)(zlib.next_in - packed), made = (size_t)(zlib.next_out - (Bytef *)bytes);
    zlib.avail_in = at_most(length - taken);
    zlib.avail_out = at_most(count - made);
    answer = inflate(&zlib, Z_NO_FLUSH); /* Z_BUF_ERROR: no progress without more of either */
  }
  *sound = answer == Z_STREAM_END && (size_t)(zlib.next_out - (Bytef *)bytes) == count;
  inflateEnd(&zlib);
  return answer == Z_MEM_ERROR ? hl_fail_memory(error, 50000, "decompression") : HL_OK;
}

/* ---- Blosc ---- */

bool hl_blosc_can_hold(const unsigned char *packed, size_t length, size_t count) {
#ifdef HL_HAS_BLOSC
  size_t promised;
  return blosc_cbuffer_validate(packed, length, &promised) == 0 && promised == count;
#else
  (void)packed, (void)length, (void)count;
  return true;
#endif
}

hl_status hl_unpack_blosc(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error) {
#ifdef HL_HAS_BLOSC
  (void)path, (void)error, (void)length;
  int made = blosc_decompress_ctx(packed, bytes, count, 1);
  *sound = made >= 0 && (size_t)made == count;
  return HL_OK;
#else
  (void)packed, (void)length, (void)bytes, (void)count;
  *sound = false;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: packed by Blosc, and this program was built without c-blosc", path);
#endif
}
