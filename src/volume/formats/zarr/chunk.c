/* volume/formats/zarr/chunk.c - converts a chunk's bytes in a file to its voxels: checksums, codecs, filters.
 *
 * The size of an unpacked chunk is known from the metadata, and data that unpack to another size are refused.
 * If packed data state their unpacked size, the size is checked before memory is allocated. */
#include "volume/formats/zarr/chunk.h"

#include <math.h>
#include <string.h>
#ifdef HL_HAS_ZSTD
#include <zstd.h>
#endif

#include "core/memory.h"
#include "volume/convert.h"
#include "volume/io/numbers.h"
#include "volume/io/unpack.h"

void hl_zarr_unpacker_release(hl_zarr_unpacker *unpacker) {
  hl_release(unpacker->context, unpacker->packed);
  hl_release(unpacker->context, unpacker->voxels);
  hl_release(unpacker->context, unpacker->filtered);
#ifdef HL_HAS_ZSTD
  ZSTD_freeDCtx(unpacker->zstd);
#endif
}

/* ---- check sums ---- */

uint32_t hl_zarr_crc32c(const unsigned char *bytes, size_t length) {
  enum { REFLECTED = 0x82f63b78 }; /* the polynomial 0x1EDC6F41 with its bits in reverse order */
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
  size_t unpacked; /* number of bytes that the data must have after they are unpacked */
} packed_bytes;

static hl_status fail_damaged(const hl_zarr_unpacker *u, const char *codec, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: a chunk does not unpack (%s) to its %zu bytes: it is damaged",
                 u->path, codec, u->array->chunk_bytes);
}

static hl_status make_room(hl_zarr_unpacker *u, hl_error *error) {
  size_t bytes = (u->unpacked > u->array->chunk_bytes ? u->unpacked : u->array->chunk_bytes) + 4;
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

/* Unpacks LZ4, bzip2 or xz. In front of a block of LZ4 stands the block's unpacked size, in four bytes. */
static hl_status unpack_other(hl_zarr_unpacker *u, packed_bytes packed, hl_error *error) {
  hl_zarr_compressor kind = u->array->codecs.compressor;
  bool lz4 = kind == HL_ZARR_LZ4, sound = !lz4 || packed.length >= 4;
  size_t head = lz4 ? 4 : 0, ratio = lz4                     ? HL_LZ4_RATIO
                                     : kind == HL_ZARR_BZIP2 ? HL_BZIP2_RATIO
                                                             : HL_XZ_RATIO;
  const unsigned char *bytes = packed.bytes + head;
  sound = sound && hl_packed_can_hold(packed.length - head, packed.unpacked, ratio);
  hl_status status = sound ? make_room(u, error) : HL_OK;
  if (!sound || status != HL_OK) return status != HL_OK ? status : fail_damaged(u, "lz4, bz2 or lzma", error);
  size_t length = packed.length - head;
  status = lz4 ? hl_unpack_lz4(u->path, bytes, length, u->voxels, packed.unpacked, &sound, error)
           : kind == HL_ZARR_BZIP2
               ? hl_unpack_bzip2(u->path, bytes, length, u->voxels, packed.unpacked, &sound, error)
               : hl_unpack_xz(u->path, bytes, length, u->voxels, packed.unpacked, &sound, error);
  return status == HL_OK && !sound ? fail_damaged(u, "lz4, bz2 or lzma", error) : status;
}

static hl_status unpack(hl_zarr_unpacker *u, packed_bytes packed, hl_error *error) {
  switch (u->array->codecs.compressor) {
    case HL_ZARR_DEFLATE: return unpack_deflate(u, packed, error);
    case HL_ZARR_BLOSC: return unpack_blosc(u, packed, error);
    case HL_ZARR_ZSTD:
#ifdef HL_HAS_ZSTD
      return unpack_zstd(u, packed, error);
#else
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: chunks packed by zstd, and this program was built without libzstd: install "
                     "libzstd-dev and build anew",
                     u->path);
#endif
    case HL_ZARR_LZ4:
    case HL_ZARR_BZIP2:
    case HL_ZARR_XZ: return unpack_other(u, packed, error);
    default: return HL_OK;
  }
}

/* ---- filters ---- */

static double number_of(hl_voxel_type type, const unsigned char *bytes) {
  return hl_binary_number(bytes, type, false);
}

#define PUT(type)                          \
  do {                                     \
    type number = (type)value;             \
    memcpy(bytes, &number, sizeof number); \
  } while (0)

/* Stores a number as bytes of a type, the least significant byte first. Whole numbers wrap around at the ends
 * of the type's range, like the sums of differences. */
static void put_number(hl_voxel_type type, double value, unsigned char *bytes) {
  bool whole = type != HL_VOXEL_F32 && type != HL_VOXEL_F64;
  if (whole && !(fabs(value) < 0x1p62)) value = 0;
  if (whole) value = floor(value + 0.5);
  switch (type) {
    case HL_VOXEL_F32: PUT(float); break;
    case HL_VOXEL_F64: PUT(double); break;
    default: {
      uint64_t bits = (uint64_t)(int64_t)value;
      for (size_t n = 0; n < hl_voxel_type_bytes(type); n++) bytes[n] = (unsigned char)(bits >> 8 * n);
    }
  }
}

/* Reads a whole number from bytes of a type. If the type is signed, the sign is extended. */
static int64_t whole_of(hl_voxel_type type, const unsigned char *bytes) {
  uint64_t bits = 0;
  size_t count = hl_voxel_type_bytes(type);
  for (size_t n = count; n > 0; n--) bits = bits << 8 | bytes[n - 1];
  bool is_signed = type == HL_VOXEL_I8 || type == HL_VOXEL_I16 || type == HL_VOXEL_I32;
  if (is_signed && bits >> (8 * count - 1) != 0) bits |= ~(uint64_t)0 << 8 * count;
  return (int64_t)bits;
}

/* Replaces stored differences of neighbours by the values, which are the sums of the differences. For whole
 * numbers the sums are exact, modulo the type's range. */
static void undo_delta(const hl_zarr_filter *filter, const unsigned char *from, size_t count,
                       unsigned char *to) {
  size_t step = hl_voxel_type_bytes(filter->from), wide = hl_voxel_type_bytes(filter->to);
  bool real = filter->to == HL_VOXEL_F32 || filter->to == HL_VOXEL_F64;
  uint64_t sum = 0;
  double real_sum = 0;
  for (size_t n = 0; n < count; n++, to += wide) {
    if (real) {
      real_sum += number_of(filter->from, from + n * step);
      put_number(filter->to, real_sum, to);
      continue;
    }
    sum += (uint64_t)whole_of(filter->from, from + n * step);
    for (size_t b = 0; b < wide; b++) to[b] = (unsigned char)(sum >> 8 * b);
  }
}

static void undo(const hl_zarr_filter *filter, const unsigned char *from, size_t bytes, size_t count,
                 unsigned char *to) {
  size_t step = hl_voxel_type_bytes(filter->from), wide = hl_voxel_type_bytes(filter->to);
  if (filter->kind == HL_ZARR_SHUFFLE) {
    size_t elements = bytes / filter->element, whole = elements * filter->element;
    for (size_t n = 0; n < elements; n++)
      for (size_t b = 0; b < filter->element; b++) to[n * filter->element + b] = from[b * elements + n];
    memcpy(to + whole, from + whole, bytes - whole);
  } else if (filter->kind == HL_ZARR_DELTA) {
    undo_delta(filter, from, count, to);
  } else {
    for (size_t n = 0; n < count; n++)
      put_number(filter->to, number_of(filter->from, from + n * step) / filter->scale + filter->offset,
                 to + n * wide);
  }
}

/* The number of bytes of a chunk before its filters are undone. */
static size_t filtered_bytes(const hl_zarr_array *array) {
  size_t bytes = array->chunk_bytes, count = bytes / hl_voxel_type_bytes(array->type);
  for (int n = 0; n < array->codecs.filter_count; n++)
    if (array->codecs.filters[n].kind != HL_ZARR_SHUFFLE)
      bytes = count * hl_voxel_type_bytes(array->codecs.filters[n].from);
  return bytes;
}

/* Undoes the filters, beginning with the filter that was applied last. *voxels is set to the unpacker's own
 * memory. */
static hl_status undo_filters(hl_zarr_unpacker *u, const unsigned char **voxels, hl_error *error) {
  const hl_zarr_array *array = u->array;
  const hl_zarr_codecs *codecs = &array->codecs;
  size_t count = array->chunk_bytes / hl_voxel_type_bytes(array->type), bytes = filtered_bytes(array);
  size_t room = 8 * count + 64;
  if (codecs->filter_count == 0) return HL_OK;
  if (u->filtered == NULL) u->filtered = hl_allocate(u->context, 2 * room, 1);
  if (u->filtered == NULL) return hl_fail_memory(error, 2 * room, "a chunk");
  const unsigned char *from = *voxels;
  for (int n = codecs->filter_count - 1; n >= 0; n--) {
    unsigned char *to = u->filtered + (size_t)(n % 2) * room;
    const hl_zarr_filter *filter = &codecs->filters[n];
    undo(filter, from, bytes, count, to);
    if (filter->kind != HL_ZARR_SHUFFLE) bytes = count * hl_voxel_type_bytes(filter->to);
    from = to;
  }
  *voxels = from;
  return HL_OK;
}

/* ---- all steps together ---- */

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

/* The number of bytes of a chunk before the chunk was packed, with its inner checksums. */
static size_t unpacked_bytes(const hl_zarr_array *array) {
  return filtered_bytes(array) + 4 * (size_t)array->codecs.inner_checks;
}

uint64_t hl_zarr_chunk_most(const hl_zarr_array *array) {
  enum { SLACK = 1 << 20 }; /* no codec makes incompressible data larger by more than this number of bytes */
  uint64_t unpacked = unpacked_bytes(array);
  return array->codecs.compressor == HL_ZARR_RAW ? unpacked : 2 * unpacked + SLACK;
}

hl_status hl_zarr_chunk_read(hl_zarr_unpacker *u, hl_source *source, uint64_t offset, uint64_t length,
                             const unsigned char **voxels, hl_error *error) {
  const hl_zarr_codecs *codecs = &u->array->codecs;
  bool is_raw = codecs->compressor == HL_ZARR_RAW;
  packed_bytes packed = {.unpacked = unpacked_bytes(u->array)};
  u->unpacked = packed.unpacked;
  if (is_raw ? length != packed.unpacked : length > hl_zarr_chunk_most(u->array))
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
  if (sound && status == HL_OK) status = undo_filters(u, voxels, error);
  return sound ? status
               : hl_fail(error, HL_ERROR_INPUT, "%s: a chunk's check sum is wrong: it is damaged",
                         hl_source_path(source));
}
