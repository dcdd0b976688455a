/* volume/io/unpack.c - unpacks one block of packed data into memory of the caller. */
#include "volume/io/unpack.h"

#include <zlib.h>
#ifdef HL_HAS_BLOSC
#include <blosc.h>
#endif

#ifdef HL_HAS_LZ4
#include <lz4.h>
#endif
#ifdef HL_HAS_BZIP2
#include <bzlib.h>
#endif
#ifdef HL_HAS_LZMA
#include <lzma.h>
#endif
#include <limits.h>

#include "core/memory.h"

/* ---- deflate ---- */

bool hl_deflate_can_hold(size_t length, size_t count) {
  enum { GREATEST_RATIO = 1032 }; /* two bits stand for at most 258 bytes */
  return count / GREATEST_RATIO <= length;
}

static voidpf zlib_allocate(voidpf context, uInt count, uInt size) {
  return hl_allocate(context, count, size);
}
static void zlib_release(voidpf context, voidpf memory) { hl_release(context, memory); }

/* The number of the next bytes that one call of zlib processes, at most `left`. zlib counts bytes in 32
 * bits. */
static uInt at_most(size_t left) { return left < (1u << 30) ? (uInt)left : 1u << 30; }

hl_status hl_unpack_deflate(hl_context *context, const unsigned char *packed, size_t length, void *bytes,
                            size_t count, bool *sound, hl_error *error) {
  enum {
    EITHER_HEADER = 15 + 32
  }; /* in zlib.h: the header is a header of zlib or of gzip, which zlib finds out from the first bytes */
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
    answer = inflate(&zlib, Z_NO_FLUSH); /* Z_BUF_ERROR means that inflate() needs more input or more room */
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
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: packed by Blosc, and this program was built without c-blosc: install libblosc-dev and build anew",
      path);
#endif
}

/* ---- LZ4, bzip2, xz ---- */

#if !defined(HL_HAS_LZ4) || !defined(HL_HAS_BZIP2) || !defined(HL_HAS_LZMA)
static hl_status fail_absent(const char *path, const char *name, bool *sound, hl_error *error) {
  *sound = false;
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: packed by %s, and this program was built without its library: install it and build anew", path,
      name);
}
#endif

hl_status hl_unpack_lz4(const char *path, const unsigned char *packed, size_t length, void *bytes,
                        size_t count, bool *sound, hl_error *error) {
#ifdef HL_HAS_LZ4
  (void)path, (void)error;
  *sound = length <= INT_MAX && count <= INT_MAX &&
           LZ4_decompress_safe((const char *)packed, bytes, (int)length, (int)count) == (int)count;
  return HL_OK;
#else
  (void)packed, (void)length, (void)bytes, (void)count;
  return fail_absent(path, "LZ4", sound, error);
#endif
}

hl_status hl_unpack_bzip2(const char *path, const unsigned char *packed, size_t length, void *bytes,
                          size_t count, bool *sound, hl_error *error) {
#ifdef HL_HAS_BZIP2
  (void)path, (void)error;
  unsigned made = count < UINT_MAX ? (unsigned)count : 0;
  *sound = made == count && length < UINT_MAX &&
           BZ2_bzBuffToBuffDecompress(bytes, &made, (char *)packed, (unsigned)length, 0, 0) == BZ_OK &&
           made == count;
  return HL_OK;
#else
  (void)packed, (void)length, (void)bytes, (void)count;
  return fail_absent(path, "bzip2", sound, error);
#endif
}

hl_status hl_unpack_xz(const char *path, const unsigned char *packed, size_t length, void *bytes,
                       size_t count, bool *sound, hl_error *error) {
#ifdef HL_HAS_LZMA
  (void)path, (void)error;
  uint64_t memory = (uint64_t)256 << 20;
  size_t taken = 0, made = 0;
  lzma_ret answer = lzma_stream_buffer_decode(&memory, 0, NULL, packed, &taken, length, bytes, &made, count);
  *sound = answer == LZMA_OK && made == count;
  return HL_OK;
#else
  (void)packed, (void)length, (void)bytes, (void)count;
  return fail_absent(path, "xz", sound, error);
#endif
}
