/* volume/zarr/chunk.c - from a chunk's bytes in a file to its voxels: check sums, zlib, zstd, blosc.
 *
 * The size of an unpacked chunk is known from the metadata: data that unpack to another size are refused.
 * Where packed data state their unpacked size, it is compared before any memory is taken. */
#include "volume/zarr/chunk.h"

#include <string.h>
#ifdef HL_HAS_ZSTD
#include <zstd.h>
#endif

#include "core/memory.h"
#include "volume/unpack.h"

void hl_zarr_unpacker_release(hl_zarr_unpacker *unpacker) {
  hl_release(unpacker->context, unpacker->packed);
  hl_release(unpacker->context, unpacker->voxels);
#ifdef HL_HAS_ZSTD
  ZSTD_freeDCtx(unpacker->zstd);
#endif
}

/* ---- check sums ---- */

uint32_t hl_zarr_crc32c(const unsigned char *bytes, size_t length) {
  enum { REFLECTED = 0x82f63b78 }; /* the polynomial 0x1EDC6F41, lowest bit first */
  uint32_t table[256], sum = 0xffffffff;
  for (uint32_t n = 0; n < 256; n++) {
    table[n] = n;
    for (int bit = 0; bit < 8; bit++)
      table[n] = (table[n] & 1) != 0 ? table[n] >> 1 ^ (uint32_t)REFLECTED : table[n] >> 1;
  }
  for (size_t n = 0; n < length; n++) sum = sum >> 8 ^ table[(sum ^ bytes[n]) & 255];
  return ~sum;
}

bool hl_zarr_check_sum(const unsigned char *bytes, size_t length) {
  if (length < 4) return false;
  const unsigned char *end = bytes + length - 4;
  uint32_t told = end[0] | (uint32_t)end[1] << 8 | (uint32_t)end[2] << 16 | (uint32_t)end[3] << 24;
  return told == hl_zarr_crc32c(bytes, length - 4);
}

/* ---- codecs ---- */

typedef struct packed_bytes {
  const unsigned char *bytes;
  size_t length;
  size_t unpacked; /* bytes that unpacking must give */
} packed_bytes;

static hl_status fail_damaged(const hl_zarr_unpacker *u, const char *codec, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: a chunk does not unpack (%s) to its %zu bytes: it is damaged",
                 u->path, codec, u->array->chunk_bytes);
}

static hl_status make_room(hl_zarr_unpacker *u, hl_error *error) {
  size_t bytes = u->array->chunk_bytes + 4;
  if (u->voxels == NULL) u->voxels = hl_allocate(u->context, bytes, 1);
  return u->voxels != NULL ? HL_OK : hl_fail_memory(error, bytes, "a chunk");
}

static hl_status unpack_deflate(hl_zarr_unpacker *u, packed_bytes packed, hl_error *error) {
  bool sound = hl_deflate_can_hold(packed.length, packed.unpacked);
  hl_status status = sound ? make_room(u, error) : HL_OK;
  if (sound && status == HL_OK)
    status = hl_unpack_deflate(u->context, packed.bytes, packed.length, u->voxels, packed.unpacked, &sound,
                               error);
  return sound || status != HL_OK ? status : fail_damaged(u, "deflate", error);
}

static hl_status unpack_blosc(hl_zarr_unpacker *u, packed_bytes packed, hl_error *error) {
  bool sound = hl_blosc_can_hold(packed.bytes, packed.length, packed.unpacked);
  hl_status status = sound ? make_room(u, error) : HL_OK;
  if (sound && status == HL_OK)
    status = hl_unpack_blosc(u->path, packed.bytes, packed.length, u->voxels, packed.unpacked, &sound, error);
  return sound || status != HL_OK ? status : fail_damaged(u, "blosc", error);
}

#ifdef HL_HAS_ZSTD
static hl_status unpack_zstd(hl_zarr_unpacker *u, packed_bytes packed, hl_error *error) {
  unsigned long long promised = ZSTD_getFrameContentSize(packed.bytes, packed.length);
  if (promised == ZSTD_CONTENTSIZE_ERROR ||
      (promised != ZSTD_CONTENTSIZE_UNKNOWN && promised > packed.unpacked))
    return fail_damaged(u, "zstd", error);
  if (u->zstd == NULL) u->zstd = ZSTD_createDCtx();
  if (u->zstd == NULL) return hl_fail_memory(error, 200000, "decompression");
  hl_status status = make_room(u, error);
  if (status != HL_OK) return status;
  size_t made = ZSTD_decompressDCtx(u->zstd, u->voxels, packed.unpacked, packed.bytes, packed.length);
  return made == packed.unpacked ? HL_OK : fail_damaged(u, "zstd", error);
}
#endif

static hl_status unpack(hl_zarr_unpacker *u, packed_bytes packed, hl_error *error) {
  switch (u->array->codecs.compressor) {
    case HL_ZARR_DEFLATE: return unpack_deflate(u, packed, error);
    case HL_ZARR_BLOSC: return unpack_blosc(u, packed, error);
    case HL_ZARR_ZSTD:
#ifdef HL_HAS_ZSTD
      return unpack_zstd(u, packed, error);
#else
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: chunks packed by zstd, and this program was built without libzstd", u->path);
#endif
    default: return HL_OK;
  }
}

/* ---- the whole ---- */

static hl_status read_packed(hl_zarr_unpacker *u, hl_source *source, uint64_t offset, size_t length,
                             hl_error *error) {
  if (length > u->capacity) {
    hl_release(u->context, u->packed);
    u->capacity = 0;
    u->packed = hl_allocate(u->context, length, 1);
    if (u->packed == NULL) return hl_fail_memory(error, length, "a chunk");
    u->capacity = length;
  }
  size_t got = 0;
  hl_status status = hl_source_read(source, offset, u->packed, length, &got, error);
  return status == HL_OK && got < length
             ? hl_fail(error, HL_ERROR_INPUT, "%s: a chunk is cut short", hl_source_path(source))
             : status;
}

hl_status hl_zarr_chunk_read(hl_zarr_unpacker *u, hl_source *source, uint64_t offset, uint64_t length,
                             const unsigned char **voxels, hl_error *error) {
  enum { SLACK = 1 << 20 }; /* packing makes no data larger than by this */
  const hl_zarr_codecs *codecs = &u->array->codecs;
  bool is_raw = codecs->compressor == HL_ZARR_RAW;
  packed_bytes packed = {.unpacked = u->array->chunk_bytes + 4 * (size_t)codecs->inner_checks};
  if (is_raw ? length != packed.unpacked : length > 2 * (uint64_t)packed.unpacked + SLACK)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a chunk of %llu bytes, its voxels have %zu: it is damaged",
                   hl_source_path(source), (unsigned long long)length, packed.unpacked);
  hl_status status = read_packed(u, source, offset, (size_t)length, error);
  if (status != HL_OK) return status;
  packed.bytes = u->packed;
  packed.length = (size_t)length;
  bool sound = codecs->outer_checks == 0 || hl_zarr_check_sum(packed.bytes, packed.length);
  if (sound) {
    packed.length -= 4 * (size_t)codecs->outer_checks;
    status = unpack(u, packed, error);
    *voxels = is_raw ? u->packed : u->voxels;
  }
  if (sound && status == HL_OK && codecs->inner_checks > 0)
    sound = hl_zarr_check_sum(*voxels, packed.unpacked);
  return sound ? status
               : hl_fail(error, HL_ERROR_INPUT, "%s: a chunk's check sum is wrong: it is damaged",
                         hl_source_path(source));
}
