/* volume/formats/dicom/frame.c - converts the bytes of a file to the values of a frame.
 *
 * Encapsulated (compressed) pixel data are a list of items (PS3.5, annex A.4): a table of the frames'
 * offsets, which may be empty, then fragments of frames. In a file of one frame, all fragments belong to this
 * frame. */
#include "volume/formats/dicom/frame.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "volume/formats/dicom/codecs.h"

static const bool native_is_big_endian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

enum { FRAGMENT_HEADER = 8, FRAGMENT = 0xfffee000, FRAGMENTS_END = 0xfffee0dd };

void hl_dicom_workspace_release(hl_dicom_workspace *space) {
  hl_release(space->context, space->packed);
  hl_release(space->context, space->values);
}

static hl_status make_room(hl_context *context, unsigned char **block, size_t *capacity, size_t wanted,
                           hl_error *error) {
  if (wanted <= *capacity) return HL_OK;
  hl_release(context, *block);
  *capacity = 0;
  *block = hl_allocate(context, wanted, 1);
  if (*block == NULL) return hl_fail_memory(error, wanted, "a frame");
  *capacity = wanted;
  return HL_OK;
}

static hl_status fail_short(const hl_source *source, uint64_t at, hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)at, "%s, byte %llu: the pixels are cut short",
                        hl_source_path(source), (unsigned long long)at);
}

/* ---- fragments ---- */

/* Reads a fragment's header. *length: the fragment's length in bytes, or UINT64_MAX if no fragment is
 * left. */
static hl_status peek_fragment(hl_source *source, const hl_dicom_pixels *p, uint64_t at, uint64_t *length,
                               hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  *length = UINT64_MAX;
  hl_status status = hl_source_peek(source, at, FRAGMENT_HEADER, &bytes, &available, error);
  if (status != HL_OK || available < FRAGMENT_HEADER) return status;
  uint32_t tag = hl_dicom_u16(bytes, p->big_endian) << 16 | hl_dicom_u16(bytes + 2, p->big_endian);
  uint32_t size = hl_dicom_u32(bytes + 4, p->big_endian);
  if (tag == FRAGMENTS_END) return HL_OK;
  if (tag != FRAGMENT || size == HL_DICOM_UNDEFINED)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)at,
                          "%s, byte %llu: expected a fragment of a picture", hl_source_path(source),
                          (unsigned long long)at);
  if (size > hl_source_size(source) || at + FRAGMENT_HEADER > hl_source_size(source) - size)
    return fail_short(source, at, error);
  *length = size;
  return HL_OK;
}

static hl_status first_fragment(hl_source *source, const hl_dicom_pixels *p, uint64_t *at, hl_error *error) {
  uint64_t length;
  hl_status status = peek_fragment(source, p, p->offset, &length, error);
  if (status == HL_OK && length == UINT64_MAX) status = fail_short(source, p->offset, error);
  *at = status == HL_OK ? p->offset + FRAGMENT_HEADER + length : 0;
  return status;
}

static hl_status count_fragments(hl_source *source, const hl_dicom_pixels *p, uint64_t begin, size_t *count,
                                 uint64_t *end, hl_error *error) {
  uint64_t length = 0;
  *count = 0;
  for (*end = begin;; *end += FRAGMENT_HEADER + length, ++*count) {
    hl_status status = peek_fragment(source, p, *end, &length, error);
    if (status != HL_OK || length == UINT64_MAX) return status;
  }
}

/* Returns whether a fragment begins a new frame. A fragment of RLE always begins a frame; another fragment
 * begins a frame if its first bytes are the first marker of JPEG or JPEG 2000. */
static hl_status begins_picture(hl_source *source, const hl_dicom_pixels *p, uint64_t at, bool *begins,
                                hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_source_peek(source, at + FRAGMENT_HEADER, 4, &bytes, &available, error);
  *begins = status == HL_OK && available == 4 && bytes[0] == 0xff &&
            (bytes[1] == 0xd8 || (bytes[1] == 0x4f && bytes[2] == 0xff && bytes[3] == 0x51));
  if (p->codec == HL_DICOM_RLE) *begins = true;
  return status;
}

/* Finds where each frame begins. The file's table of offsets is not used, because the table may be wrong. If
 * the number of fragments equals the number of frames, each fragment is a frame. If the numbers differ, a
 * frame begins at each fragment for which begins_picture() is true. */
static hl_status place_frames(hl_source *source, hl_dicom_file *file, uint64_t begin, size_t fragments,
                              uint64_t end, hl_error *error) {
  size_t found = 0;
  uint64_t at = begin, length = 0;
  for (size_t n = 0; n < fragments; n++, at += FRAGMENT_HEADER + length) {
    bool begins = fragments == file->frames.count;
    hl_status status = peek_fragment(source, &file->pixels, at, &length, error);
    if (status == HL_OK && !begins) status = begins_picture(source, &file->pixels, at, &begins, error);
    if (status != HL_OK) return status;
    if (begins && found < file->frames.count) file->frames.begins[found++] = at;
  }
  if (found < file->frames.count)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: %zu frames are promised, but only %zu begin in its %zu fragments",
                   hl_source_path(source), file->frames.count, found, fragments);
  file->frames.begins[found] = end;
  return HL_OK;
}

hl_status hl_dicom_find_frames(const hl_dicom_set *set, hl_dicom_file *file, hl_error *error) {
  if (!file->pixels.encapsulated || file->frames.count == 1 || file->frames.begins != NULL) return HL_OK;
  hl_source *source;
  hl_status status = hl_dicom_file_open(set, file, &source, error);
  if (status != HL_OK) return status;
  uint64_t begin, end;
  size_t fragments;
  status = first_fragment(source, &file->pixels, &begin, error);
  if (status == HL_OK) status = count_fragments(source, &file->pixels, begin, &fragments, &end, error);
  if (status == HL_OK) {
    file->frames.begins = hl_allocate(set->context, file->frames.count + 1, sizeof *file->frames.begins);
    status = file->frames.begins == NULL
                 ? hl_fail_memory(error, file->frames.count * sizeof *file->frames.begins, "a list of frames")
                 : place_frames(source, file, begin, fragments, end, error);
  }
  hl_source_close(source);
  return status;
}

/* Reads the fragments of a frame, and joins them in the workspace. */
static hl_status read_fragments(hl_source *source, const hl_dicom_file *file, uint32_t index,
                                hl_dicom_workspace *space, size_t *total, hl_error *error) {
  const hl_dicom_pixels *p = &file->pixels;
  uint64_t begin = 0, end = UINT64_MAX, length = 0, bytes = 0;
  hl_status status = HL_OK;
  if (file->frames.begins == NULL) status = first_fragment(source, p, &begin, error);
  else begin = file->frames.begins[index], end = file->frames.begins[index + 1];
  for (uint64_t at = begin; status == HL_OK && at < end; at += FRAGMENT_HEADER + length) {
    status = peek_fragment(source, p, at, &length, error);
    if (status != HL_OK || length == UINT64_MAX) break;
    bytes += length;
  }
  if (status == HL_OK && bytes > hl_source_size(source)) status = fail_short(source, begin, error);
  enum { SPARE = 16 }; /* decoders may read this many bytes beyond the frame's end */
  if (status == HL_OK)
    status = make_room(space->context, &space->packed, &space->packed_capacity, (size_t)bytes + SPARE, error);
  *total = 0;
  for (uint64_t at = begin; status == HL_OK && at < end && *total < bytes; at += FRAGMENT_HEADER + length) {
    size_t got = 0;
    status = peek_fragment(source, p, at, &length, error);
    if (status != HL_OK || length == UINT64_MAX) break;
    status = hl_source_read(source, at + FRAGMENT_HEADER, space->packed + *total, (size_t)length, &got,
                            error);
    *total += got;
    if (status == HL_OK && got < length) status = fail_short(source, at, error);
  }
  if (status == HL_OK) memset(space->packed + *total, 0, SPARE);
  return status;
}

/* ---- pixels as they are ---- */

static void swap_pairs(unsigned char *bytes, size_t count) {
  for (size_t n = 0; n + 1 < count; n += 2) {
    unsigned char first = bytes[n];
    bytes[n] = bytes[n + 1];
    bytes[n + 1] = first;
  }
}

static void reverse_each(unsigned char *bytes, size_t count, size_t size) {
  for (size_t n = 0; n < count; n++, bytes += size)
    for (size_t k = 0; k < size / 2; k++) {
      unsigned char first = bytes[k];
      bytes[k] = bytes[size - 1 - k];
      bytes[size - 1 - k] = first;
    }
}

static void unpack_bits(const unsigned char *packed, size_t first_bit, size_t count, unsigned char *values) {
  for (size_t n = 0; n < count; n++) {
    size_t bit = first_bit + n; /* PS3.5, 8.1.1: the lowest bit of a byte is the first pixel */
    values[n] = packed[bit / 8] >> (bit % 8) & 1;
  }
}

/* Unpacks pixels whose colour differences are halved along rows. Each group of four bytes, Y1 Y2 Cb Cr,
 * stands for two pixels (PS3.3, C.7.6.3.1.2). */
static void unpack_halved(const unsigned char *packed, size_t pixels, unsigned char *values) {
  for (size_t n = 0; n + 1 < pixels; n += 2, packed += 4, values += 6) {
    const unsigned char two[6] = {packed[0], packed[2], packed[3], packed[1], packed[2], packed[3]};
    memcpy(values, two, sizeof two);
  }
}

/* Converts a frame whose samples are stored as planes, one for each sample, so that the samples of a pixel
 * lie side by side. size: bytes of a sample. */
static void interleave(const unsigned char *planes, size_t pixels, size_t samples, size_t size,
                       unsigned char *values) {
  for (size_t n = 0; n < pixels; n++)
    for (size_t s = 0; s < samples; s++)
      memcpy(values + (n * samples + s) * size, planes + (s * pixels + n) * size, size);
}

static hl_status read_native(hl_source *source, const hl_dicom_file *file, uint32_t index,
                             hl_dicom_workspace *space, size_t pixels, hl_error *error) {
  const hl_dicom_pixels *p = &file->pixels;
  size_t count = pixels * p->samples, size = space->value_bytes, skipped_bits = 0, got;
  uint64_t bytes = (uint64_t)count * size, at = p->offset;
  bool halved = p->is_halved && p->samples == 3 && size == 1;
  if (halved) bytes = 2 * (uint64_t)pixels;
  if (p->encapsulated) { /* pixels that are not compressed may also be stored in fragments */
    hl_status status = read_fragments(source, file, index, space, &got, error);
    if (status == HL_OK && got < bytes) status = fail_short(source, at, error);
    if (status != HL_OK) return status;
  } else {
    if (p->allocated == 1) {
      skipped_bits = (size_t)((uint64_t)index * count % 8);
      at += (uint64_t)index * count / 8;
      bytes = (skipped_bits + count + 7) / 8;
    } else at += index * bytes;
    hl_status status = make_room(space->context, &space->packed, &space->packed_capacity, (size_t)bytes + 2,
                                 error);
    bool odd = p->big_endian && p->words && size == 1; /* 8-bit pixels are stored in 16-bit words whose bytes
                                                        * are swapped, so that an even number of bytes must be
                                                        * read */
    if (status == HL_OK) status = hl_source_read(source, at, space->packed, (size_t)bytes + odd, &got, error);
    if (status == HL_OK && got < bytes) status = fail_short(source, at, error);
    if (status != HL_OK) return status;
    if (odd) swap_pairs(space->packed, got);
  }
  if (p->allocated == 1) unpack_bits(space->packed, skipped_bits, count, space->values);
  else if (halved) unpack_halved(space->packed, pixels, space->values);
  else if (p->planar && p->samples > 1) interleave(space->packed, pixels, p->samples, size, space->values);
  else memcpy(space->values, space->packed, (size_t)bytes);
  if (size > 1 && p->big_endian != native_is_big_endian) reverse_each(space->values, count, size);
  return HL_OK;
}

/* ---- stored bits, signs, colours ---- */

/* Shifts the stored bits of each value down to bit 0, inverts the value if needed, and extends the sign of
 * signed values. */
static void place_bits(const hl_dicom_pixels *p, size_t count, hl_dicom_workspace *space) {
  int shift = p->high + 1 - p->stored, bits = (int)space->value_bytes * 8;
  int spare = bits - p->stored;
  if (space->is_float || p->allocated == 1 || (spare == 0 && !p->inverted)) return;
  uint32_t mask = p->stored == 32 ? UINT32_MAX : (1u << p->stored) - 1;
  uint32_t sign = p->is_signed ? 1u << (p->stored - 1) : 0, flip = p->inverted ? mask : 0;
  for (size_t n = 0; n < count; n++) {
    uint32_t value = 0;
    if (space->value_bytes == 1) value = space->values[n];
    if (space->value_bytes == 2) value = ((const uint16_t *)(const void *)space->values)[n];
    if (space->value_bytes == 4) value = ((const uint32_t *)(const void *)space->values)[n];
    value = (value >> shift & mask) ^ flip;
    value = (value ^ sign) - sign; /* copies the sign bit to all higher bits */
    if (space->value_bytes == 1) space->values[n] = (unsigned char)value;
    if (space->value_bytes == 2) ((uint16_t *)(void *)space->values)[n] = (uint16_t)value;
    if (space->value_bytes == 4) ((uint32_t *)(void *)space->values)[n] = value;
  }
}

static unsigned char to_byte(double value) {
  return (unsigned char)(value < 0 ? 0 : value > 255 ? 255 : value + 0.5);
}

/* Converts pixels from YBR_FULL to RGB (PS3.3, C.7.6.3.1.2). */
static void to_rgb(size_t pixels, unsigned char *values) {
  for (size_t n = 0; n < pixels; n++, values += 3) {
    double y = values[0], b = values[1] - 128.0, r = values[2] - 128.0;
    values[0] = to_byte(y + 1.402 * r);
    values[1] = to_byte(y - 0.344136 * b - 0.714136 * r);
    values[2] = to_byte(y + 1.772 * b);
  }
}

static hl_status decode(const hl_dicom_pixels *p, const hl_dicom_packed *packed, void *values,
                        hl_error *error) {
  switch (p->codec) {
    case HL_DICOM_RLE: return hl_dicom_decode_rle(packed, values, error);
    case HL_DICOM_JPEG: return hl_dicom_decode_jpeg(packed, values, error);
    case HL_DICOM_JPEG_LS: return hl_dicom_decode_jpeg_ls(packed, values, error);
    case HL_DICOM_JPEG_2000: return hl_dicom_decode_jpeg_2000(packed, values, error);
    default:
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: its transfer syntax is not read: decompress it with dcmdjpeg or gdcmconv --raw",
                     packed->path);
  }
}

/* ---- tiles and palettes ---- */

/* Moves one tile of a mosaic to the front of the values. size: bytes of a pixel. */
static void cut_tile(const hl_dicom_pixels *p, size_t tile, size_t size, unsigned char *values) {
  size_t rows = hl_dicom_slice_rows(p), columns = hl_dicom_slice_columns(p);
  size_t x = tile % p->tiles * columns, y = tile / p->tiles * rows;
  for (size_t row = 0; row < rows; row++)
    memmove(values + row * columns * size, values + ((y + row) * p->columns + x) * size, columns * size);
}

/* Replaces pixel values by their colours, in place. The loop runs from the last pixel to the first, because a
 * colour takes more bytes than a value. */
static void apply_palette(const hl_dicom_pixels *p, const hl_dicom_palette *palette, size_t count,
                          hl_dicom_workspace *space) {
  for (size_t n = count; n-- > 0;) {
    double value = space->values[n];
    if (space->value_bytes == 2) value = ((const uint16_t *)(const void *)space->values)[n];
    if (p->is_signed && space->value_bytes == 1) value = (int8_t)space->values[n];
    if (p->is_signed && space->value_bytes == 2) value = ((const int16_t *)(const void *)space->values)[n];
    hl_dicom_palette_color(palette, value, space->values + 3 * n);
  }
  space->value_bytes = 1;
}

hl_status hl_dicom_read_frame(const hl_dicom_set *set, const hl_dicom_frame *frame, hl_dicom_workspace *space,
                              hl_error *error) {
  const hl_dicom_file *file = &set->files[frame->file];
  const hl_dicom_pixels *p = &file->pixels;
  size_t pixels = p->rows * p->columns, length = 0;
  bool is_rgb = !p->is_ybr;
  hl_source *source;
  space->value_bytes = p->allocated <= 8 ? 1 : (size_t)p->allocated / 8;
  space->is_float = p->is_float;
  hl_status status = hl_dicom_file_open(set, file, &source, error);
  if (status != HL_OK) return status;
  status = make_room(space->context, &space->values, &space->values_capacity,
                     pixels * hl_dicom_read_samples(p) * space->value_bytes, error);
  if (status == HL_OK && p->codec == HL_DICOM_NATIVE) {
    status = read_native(source, file, frame->index, space, pixels, error);
  } else if (status == HL_OK) {
    status = read_fragments(source, file, frame->index, space, &length, error);
    hl_dicom_packed packed = {space->context, hl_source_path(source), p, space->packed, length, &is_rgb};
    if (status == HL_OK) status = decode(p, &packed, space->values, error);
  }
  hl_source_close(source);
  if (status != HL_OK) return status;
  place_bits(p, pixels * p->samples, space);
  if (!is_rgb && p->samples == 3 && space->value_bytes == 1) to_rgb(pixels, space->values);
  if (p->tiles > 1) cut_tile(p, frame->tile, p->samples * space->value_bytes, space->values);
  if (p->has_palette) apply_palette(p, &file->palette, pixels / (p->tiles * p->tiles), space);
  return HL_OK;
}
