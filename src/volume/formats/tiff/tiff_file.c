/* volume/formats/tiff/tiff_file.c - wraps libtiff with this library's errors, limits and voxel types. */
#define _GNU_SOURCE
#include "volume/formats/tiff/tiff_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "text/plain.h"
#include "volume/colors.h"
#include "volume/convert.h"
#include "volume/io/unpack.h"

static const bool native_is_big_endian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

enum { LARGEST_ALLOCATION = 1 << 30, WARNINGS_TOLD = 4, PAGES_MOST = 1 << 22 };

/* ---- reading for libtiff ---- */

static tmsize_t read_bytes(thandle_t handle, void *bytes, tmsize_t wanted) {
  tiff_file *file = handle;
  uint64_t left = file->at < file->size ? file->size - file->at : 0;
  size_t count = wanted < 0 ? 0 : (uint64_t)wanted < left ? (size_t)wanted : (size_t)left, done = 0;
  if (file->memory != NULL) {
    memcpy(bytes, file->memory + file->at, count);
    done = count;
  }
  while (done < count) {
    ssize_t got = pread(file->descriptor, (char *)bytes + done, count - done, (off_t)(file->at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += (size_t)got;
  }
  file->at += done;
  return (tmsize_t)done;
}

static tmsize_t write_nothing(thandle_t handle, void *bytes, tmsize_t count) {
  (void)handle, (void)bytes, (void)count;
  return 0;
}

static toff_t seek(thandle_t handle, toff_t offset, int whence) {
  tiff_file *file = handle;
  file->at = whence == SEEK_SET ? offset : whence == SEEK_CUR ? file->at + offset : file->size + offset;
  return file->at;
}

static int close_nothing(thandle_t handle) {
  (void)handle;
  return 0;
}

static toff_t size_of(thandle_t handle) { return ((tiff_file *)handle)->size; }

static int on_error(TIFF *tiff, void *data, const char *module, const char *format, va_list arguments) {
  (void)tiff, (void)module;
  tiff_file *file = data;
  if (file->message[0] == 0) {
    hl_plain_vprint(file->message, sizeof file->message, format, arguments);
    hl_make_printable(file->message);
  }
  return 1;
}

/* Logs libtiff's first few warnings. Warnings about tags that libtiff does not know are not logged. */
static int on_warning(TIFF *tiff, void *data, const char *module, const char *format, va_list arguments) {
  (void)tiff, (void)module;
  tiff_file *file = data;
  char text[300];
  hl_plain_vprint(text, sizeof text, format, arguments);
  hl_make_printable(text);
  if (strncmp(text, "Unknown field", 13) != 0 && file->warnings++ < WARNINGS_TOLD)
    hl_log(file->context, HL_LOG_WARNING, "%.300s: %s", file->path, text);
  return 1;
}

static hl_status open_descriptor(tiff_file *file, bool quiet, hl_error *error) {
  struct stat about;
  hl_status status = HL_OK;
  if (quiet) status = hl_file_open_again(file->context, file->path, &file->descriptor, error);
  else status = hl_file_open(file->context, file->path, &file->descriptor, error);
  if (status != HL_OK) return status;
  if (fstat(file->descriptor, &about) != 0)
    return hl_fail(error, HL_ERROR_IO, "%s: cannot open: %s", file->path, strerror(errno));
  if (!S_ISREG(about.st_mode))
    return hl_fail(error, HL_ERROR_IO, "%s: is not a regular file, and TIFF is read from several places",
                   file->path);
  file->size = about.st_size > 0 ? (uint64_t)about.st_size : 0;
  return HL_OK;
}

hl_status tiff_file_open(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                         bool quiet, tiff_file *file, hl_error *error) {
  *file = (tiff_file){
      .context = context, .memory = bytes, .size = byte_count, .descriptor = -1, .warnings = file->warnings};
  file->path = hl_copy_text(context, path);
  if (file->path == NULL) return hl_fail_memory(error, strlen(path) + 1, path);
  hl_status status = bytes == NULL ? open_descriptor(file, quiet, error) : HL_OK;
  if (status != HL_OK) return status;
  TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
  if (options == NULL) return hl_fail_memory(error, 100, path);
  uint64_t limit = context->options.memory_limit;
  TIFFOpenOptionsSetMaxSingleMemAlloc(
      options, limit > 0 && limit < LARGEST_ALLOCATION ? (tmsize_t)limit : LARGEST_ALLOCATION);
  TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, file);
  TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, file);
  /* flags of TIFFClientOpenExt(): "r" opens the file for reading; "m" does not map the file into memory; "c"
   * does not divide strips; "O" reads the positions of strips only when they are needed */
  file->tiff = TIFFClientOpenExt(path, "rmcO", file, read_bytes, write_nothing, seek, close_nothing, size_of,
                                 NULL, NULL, options);
  TIFFOpenOptionsFree(options);
  return file->tiff != NULL ? HL_OK : tiff_file_fail(file, "not a TIFF file that can be read", error);
}

void tiff_file_close(tiff_file *file) {
  if (file->tiff != NULL) TIFFClose(file->tiff);
  if (file->descriptor >= 0) close(file->descriptor);
  hl_release(file->context, file->path);
  *file = (tiff_file){.descriptor = -1};
}

hl_status tiff_file_fail(const tiff_file *file, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: %s%s%s", file->path, what, file->message[0] != 0 ? ": " : "",
                 file->message);
}

/* Finds the number of bytes of a directory, which follows from its number of entries. A directory with more
 * entries than any program writes is refused, because libtiff's time grows with the square of the number of
 * entries. */
static hl_status measure_directory(tiff_file *file, uint64_t offset, uint64_t *bytes, hl_error *error) {
  enum { ENTRIES_MOST = 512 };
  unsigned char head[8] = {0};
  bool big = TIFFIsBigTIFF(file->tiff) != 0, high_first = TIFFIsBigEndian(file->tiff) != 0;
  size_t count_bytes = big ? 8 : 2;
  uint64_t entries = 0, before = file->at;
  file->at = offset;
  read_bytes(file, head, (tmsize_t)count_bytes);
  file->at = before;
  for (size_t n = 0; n < count_bytes; n++)
    entries = entries << 8 | head[high_first ? n : count_bytes - 1 - n];
  if (entries > ENTRIES_MOST)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a page of %llu tags: at most %d are read: save it without them", file->path,
                   (unsigned long long)entries, ENTRIES_MOST);
  *bytes = big ? 8 + 20 * entries + 8 : 2 + 12 * entries + 4;
  return HL_OK;
}

hl_status tiff_file_go(tiff_file *file, uint64_t offset, int level, hl_error *error) {
  uint64_t bytes;
  file->message[0] = 0;
  if (TIFFCurrentDirOffset(file->tiff) != offset && !TIFFSetSubDirectory(file->tiff, offset))
    return tiff_file_fail(file, "a damaged page", error);
  if (level == 0) return HL_OK;
  uint16_t count = 0;
  uint64_t *offsets = NULL;
  if (!TIFFGetField(file->tiff, TIFFTAG_SUBIFD, &count, &offsets) || level > count)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a page has %d resolutions, the first page %d or more",
                   file->path, (int)count + 1, level + 1);
  hl_status status = measure_directory(file, offsets[level - 1], &bytes, error);
  if (status != HL_OK) return status;
  return TIFFSetSubDirectory(file->tiff, offsets[level - 1])
             ? HL_OK
             : tiff_file_fail(file, "a damaged page of a lower resolution", error);
}

/* ---- pages ---- */

/* The voxel type to which samples of this format and number of bits are unpacked; 0 if samples of this kind
 * cannot be read. */
static hl_voxel_type type_of(unsigned format, unsigned bits) {
  bool is_signed = format == SAMPLEFORMAT_INT;
  if (format == SAMPLEFORMAT_IEEEFP)
    return bits == 16 ? HL_VOXEL_F16 : bits == 32 ? HL_VOXEL_F32 : bits == 64 ? HL_VOXEL_F64 : 0;
  if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_VOID && !is_signed) return 0;
  if (bits >= 1 && bits <= 8) return is_signed ? HL_VOXEL_I8 : HL_VOXEL_U8;
  if (bits >= 9 && bits <= 16) return is_signed ? HL_VOXEL_I16 : HL_VOXEL_U16;
  if (bits >= 17 && bits <= 32) return is_signed ? HL_VOXEL_I32 : HL_VOXEL_U32;
  return bits == 64 ? (is_signed ? HL_VOXEL_I64 : HL_VOXEL_U64) : 0;
}

static void read_colors(TIFF *tiff, uint16_t photometric, tiff_shape *shape) {
  uint16_t extra = 0, *kinds = NULL;
  shape->colors = (photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_YCBCR) &&
                  shape->bits % 8 == 0 && hl_can_be_colors(shape->type, shape->components);
  if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds) && extra > 0)
    shape->premultiplied = kinds[0] == EXTRASAMPLE_ASSOCALPHA;
}

hl_status tiff_file_shape(tiff_file *file, tiff_shape *shape, hl_error *error) {
  TIFF *tiff = file->tiff;
  uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG, compression = 1,
           photometric = PHOTOMETRIC_MINISBLACK, across = 1, down = 1;
  uint32_t depth = 1;
  *shape = (tiff_shape){.width = 0};
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &shape->width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &shape->height);
  TIFFGetField(tiff, TIFFTAG_IMAGEDEPTH, &depth);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planar);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  shape->bits = bits;
  shape->depth = depth > 1 ? depth : 1;
  shape->components = samples;
  shape->planar = planar == PLANARCONFIG_SEPARATE && samples > 1;
  shape->type = type_of(format, bits);
  read_colors(tiff, photometric, shape);
  if (shape->width < 1 || shape->height < 1 || samples < 1 || shape->width > INT32_MAX ||
      shape->height > INT32_MAX)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a page of %u x %u pixels with %u samples", file->path,
                   shape->width, shape->height, samples);
  if (shape->type == 0)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: samples of %u bits and TIFF's format %u are not read: save it as whole numbers or floats",
        file->path, bits, format);
  if (depth > INT16_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a page of %u slices (ImageDepth): at most %d are read: save a page for each slice",
                   file->path, depth, INT16_MAX);
  if (!TIFFIsCODECConfigured(compression))
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: TIFF's compression %u is not read: save it with another",
                   file->path, compression);
  if (photometric != PHOTOMETRIC_YCBCR) return HL_OK;
  if (compression == COMPRESSION_JPEG) {
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    return HL_OK;
  }
  TIFFGetFieldDefaulted(tiff, TIFFTAG_YCBCRSUBSAMPLING, &across, &down);
  if (across == 1 && down == 1) return HL_OK;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: colours of fewer pixels than brightness are not read: save it as RGB", file->path);
}

bool tiff_shapes_equal(const tiff_shape *a, const tiff_shape *b) {
  return a->width == b->width && a->height == b->height && a->depth == b->depth && a->type == b->type &&
         a->bits == b->bits && a->components == b->components && a->planar == b->planar;
}

hl_status tiff_file_pages(tiff_file *file, uint64_t **offsets, size_t *count, hl_error *error) {
  size_t capacity = 0;
  uint64_t bytes, all_bytes = 0;
  *offsets = NULL;
  *count = 0;
  file->message[0] = 0;
  do {
    if (*count == capacity) {
      size_t wanted = capacity == 0 ? 64 : 2 * capacity;
      uint64_t *larger = hl_reallocate(file->context, *offsets, wanted, sizeof *larger);
      if (larger == NULL) return hl_fail_memory(error, wanted * sizeof *larger, file->path);
      *offsets = larger;
      capacity = wanted;
    }
    (*offsets)[(*count)++] = TIFFCurrentDirOffset(file->tiff);
    hl_status status = measure_directory(file, (*offsets)[*count - 1], &bytes, error);
    if (status != HL_OK) return status;
    all_bytes += bytes;
    if (all_bytes > file->size)
      return hl_fail(error, HL_ERROR_INPUT, "%s: damaged pages: their tags lie over each other", file->path);
    if (*count > PAGES_MOST)
      return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than %d pages: save it as several files",
                     file->path, (int)PAGES_MOST);
    if (*count % 64 == 0 && hl_cancelled(file->context))
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", file->path);
  } while (TIFFReadDirectory(file->tiff));
  return file->message[0] == 0 ? HL_OK : tiff_file_fail(file, "a damaged page", error);
}

uint64_t tiff_file_plain(tiff_file *file, const tiff_shape *shape, uint64_t *bytes) {
  uint16_t compression = COMPRESSION_NONE;
  TIFFGetFieldDefaulted(file->tiff, TIFFTAG_COMPRESSION, &compression);
  *bytes = (uint64_t)shape->width * shape->height * shape->components * (shape->bits / 8);
  if (compression != COMPRESSION_NONE || TIFFIsTiled(file->tiff) || shape->planar ||
      shape->bits != 8 * hl_voxel_type_bytes(shape->type) || shape->components > UINT16_MAX)
    return 0;
  return TIFFGetStrileOffset(file->tiff, 0);
}

bool tiff_file_can_hold(tiff_file *file, const tiff_shape *shape) {
  uint16_t compression = COMPRESSION_NONE;
  TIFFGetFieldDefaulted(file->tiff, TIFFTAG_COMPRESSION, &compression);
  /* the greatest number of bytes to which one compressed byte can unpack. Deflate: 1032 (zlib's
   * documentation). LZW: a code of 12 bits, which are 1.5 bytes, stands for at most 4096 bytes */
  double most = compression == COMPRESSION_NONE                                                  ? 1
                : compression == COMPRESSION_PACKBITS                                            ? 64
                : compression == COMPRESSION_LZW                                                 ? 4096 / 1.5
                : compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE ? 1032
                                                                                                 : 65536;
  double pixels = (double)shape->width * shape->height * shape->depth;
  double bytes = pixels * shape->components * shape->bits / 8;
  if (bytes <= (double)file->size * most) return true;
  /* If the first chunk has 0 bytes, it is absent: the file is sparse. */
  return TIFFGetStrileByteCount(file->tiff, 0) == 0 && bytes <= (double)file->size * 65536;
}

/* ---- voxels ---- */

/* Unpacks `count` samples to samples of the voxel type. The samples are stored without gaps between their
 * bits, the highest bit first. */
static void unpack_bits(const unsigned char *source, size_t count, const tiff_shape *shape,
                        unsigned char *samples) {
  size_t bytes = hl_voxel_type_bytes(shape->type), place = 0;
  bool is_signed = shape->type == HL_VOXEL_I8 || shape->type == HL_VOXEL_I16 || shape->type == HL_VOXEL_I32;
  for (size_t n = 0; n < count; n++) {
    uint64_t value = 0;
    for (unsigned left = shape->bits; left > 0;) {
      unsigned skip = (unsigned)(place % 8), take = 8 - skip < left ? 8 - skip : left;
      unsigned part = (unsigned)(source[place / 8] >> (8 - skip - take)) & ((1U << take) - 1);
      value = value << take | part;
      place += take;
      left -= take;
    }
    if (is_signed && value >> (shape->bits - 1) != 0) value |= ~(uint64_t)0 << shape->bits;
    uint8_t narrow = (uint8_t)value;
    uint16_t wide = (uint16_t)value;
    uint32_t widest = (uint32_t)value;
    memcpy(samples + n * bytes,
           bytes == 1   ? (void *)&narrow
           : bytes == 2 ? (void *)&wide
                        : (void *)&widest,
           bytes);
  }
}

/* Unpacks samples of 24 bits, which libtiff gives in native byte order. */
static void unpack_24(const unsigned char *source, size_t count, bool is_signed, unsigned char *samples) {
  const uint16_t one = 1;
  bool little = *(const unsigned char *)&one == 1;
  for (size_t n = 0; n < count; n++) {
    const unsigned char *s = source + 3 * n;
    uint32_t value = little ? (uint32_t)s[0] | (uint32_t)s[1] << 8 | (uint32_t)s[2] << 16
                            : (uint32_t)s[2] | (uint32_t)s[1] << 8 | (uint32_t)s[0] << 16;
    if (is_signed && value >> 23 != 0) value |= 0xff000000U;
    memcpy(samples + 4 * n, &value, 4);
  }
}

/* The state of decoding a page, chunk by chunk. */
typedef struct page_reading {
  tiff_file *file;
  const tiff_shape *shape;
  int component; /* index of the wanted component, or an HL_COMPONENT_ value */
  uint32_t chunk_width, chunk_height, chunk_depth;
  bool tiled;
  size_t row_bytes, chunk_bytes; /* bytes of a row of a chunk; bytes of all rows of a chunk that lie in the
                                  * page */
  unsigned char *chunk;          /* owned; [chunk_bytes] */
  unsigned char *samples;        /* owned; a row of samples of the voxel type */
  unsigned char *picked;         /* owned; a row of values of the wanted component */
  unsigned char *voxels;
  const tiff_target *target;
} page_reading;

static double sample_value(hl_voxel_type type, const void *stored) {
  float real;
  uint16_t wide;
  switch (hl_voxel_type_storage(type)) {
    case HL_STORAGE_U8: return *(const unsigned char *)stored - hl_voxel_type_bias(type);
    case HL_STORAGE_U16: memcpy(&wide, stored, 2); return wide - hl_voxel_type_bias(type);
    default: memcpy(&real, stored, 4); return (double)real;
  }
}

/* Stores component `index` of a row of samples: as stored values, as part of a colour, or as part of a
 * magnitude. */
static void take_component(page_reading *r, const unsigned char *samples, unsigned step, unsigned index,
                           size_t count, size_t first) {
  hl_voxel_type type = r->shape->type;
  size_t bytes = hl_voxel_type_bytes(type), stored = hl_storage_bytes(hl_voxel_type_storage(type));
  const unsigned char *row = samples;
  if (hl_component_is_colors(r->component)) {
    hl_colors_store(type, samples, step, count, index, r->voxels + first * HL_COLOR_BYTES);
    return;
  }
  if (step > 1) {
    for (size_t n = 0; n < count; n++) memcpy(r->picked + n * bytes, samples + n * step * bytes, bytes);
    row = r->picked;
  }
  if (r->component != HL_COMPONENT_MAGNITUDE) {
    hl_exact_note(r->target->exact, false, row, r->target->first + first, count);
    hl_voxels_store(type, false, row, count, r->voxels + first * stored);
    return;
  }
  float *magnitude = (float *)r->voxels + first;
  for (size_t n = 0; n < count; n++) {
    unsigned char one[8];
    hl_voxels_store(type, false, row + n * bytes, 1, one);
    double value = sample_value(type, one), before = index > 0 ? (double)magnitude[n] : 0;
    magnitude[n] = (float)(index > 0 ? sqrt(before * before + value * value) : fabs(value));
  }
}

/* Unpacks a row of a decoded chunk, and stores the row's wanted component or components. plane: the component
 * of the chunk, if the chunk holds only one component. */
static void take_row(page_reading *r, const unsigned char *row, unsigned plane, size_t count, size_t first) {
  const tiff_shape *shape = r->shape;
  unsigned each = shape->planar ? 1 : shape->components;
  const unsigned char *samples = row;
  if (shape->bits == 24) {
    unpack_24(row, count * each, shape->type == HL_VOXEL_I32, r->samples);
    samples = r->samples;
  } else if (shape->bits != 8 * hl_voxel_type_bytes(shape->type)) {
    unpack_bits(row, count * each, shape, r->samples);
    samples = r->samples;
  }
  size_t bytes = hl_voxel_type_bytes(shape->type);
  if (shape->planar) {
    take_component(r, samples, 1, plane, count, first);
  } else if (r->component < 0) {
    for (unsigned c = 0; c < each; c++) take_component(r, samples + c * bytes, each, c, count, first);
  } else {
    take_component(r, samples + (size_t)r->component * bytes, each, 0, count, first);
  }
}

/* Decodes a tile that has several slices. The tile must be uncompressed or deflated. libtiff cannot decode a
 * tile with several slices, because libtiff treats each tile as one slice. */
static hl_status decode_deep_tile(page_reading *r, uint32_t index, uint64_t stored, hl_error *error) {
  tiff_file *file = r->file;
  hl_context *context = file->context;
  uint16_t compression = COMPRESSION_NONE, predictor = 1;
  TIFFGetFieldDefaulted(file->tiff, TIFFTAG_COMPRESSION, &compression);
  TIFFGetField(file->tiff, TIFFTAG_PREDICTOR, &predictor);
  bool deflated = compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE,
       sound = false;
  if ((!deflated && compression != COMPRESSION_NONE) || predictor > 1 ||
      (r->shape->bits > 8 && (TIFFIsBigEndian(file->tiff) != 0) != native_is_big_endian))
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: tiles of several slices with compression %u, a predictor or in the other byte order: save it "
        "with plain deflate, or uncompressed",
        file->path, compression);
  if (stored > file->size) return tiff_file_fail(file, "a tile is cut short", error);
  unsigned char *packed = hl_allocate(context, (size_t)stored + 1, 1);
  if (packed == NULL) return hl_fail_memory(error, (size_t)stored, file->path);
  tmsize_t got = TIFFReadRawTile(file->tiff, index, packed, (tmsize_t)stored);
  size_t length = got < 0 ? 0 : (size_t)got;
  hl_status status = HL_OK;
  if (deflated && hl_deflate_can_hold(length, r->chunk_bytes))
    status = hl_unpack_deflate(context, packed, length, r->chunk, r->chunk_bytes, &sound, error);
  else if (!deflated && (sound = length >= r->chunk_bytes)) memcpy(r->chunk, packed, r->chunk_bytes);
  hl_release(context, packed);
  return status == HL_OK && !sound ? tiff_file_fail(file, "a damaged tile", error) : status;
}

/* Decodes the first `rows` rows of chunk `index`. The samples of a chunk that the file does not contain are
 * 0. */
static hl_status decode(page_reading *r, uint32_t index, uint32_t rows, hl_error *error) {
  tiff_file *file = r->file;
  file->message[0] = 0;
  int failed = 0;
  uint64_t stored = TIFFGetStrileByteCountWithErr(file->tiff, index, &failed);
  size_t wanted = r->chunk_depth > 1 ? r->chunk_bytes : r->row_bytes * rows;
  if (stored == 0 && !failed) {
    memset(r->chunk, 0, wanted);
    return HL_OK;
  }
  if (!failed && r->chunk_depth > 1) return decode_deep_tile(r, index, stored, error);
  tmsize_t got = failed     ? -1
                 : r->tiled ? TIFFReadEncodedTile(file->tiff, index, r->chunk, (tmsize_t)wanted)
                            : TIFFReadEncodedStrip(file->tiff, index, r->chunk, (tmsize_t)wanted);
  return got >= 0 && (size_t)got >= wanted ? HL_OK : tiff_file_fail(file, "a damaged page", error);
}

static hl_status read_chunk(page_reading *r, unsigned plane, uint32_t x, uint32_t y, hl_error *error) {
  const tiff_shape *shape = r->shape;
  TIFF *tiff = r->file->tiff;
  uint32_t columns = shape->width - x < r->chunk_width ? shape->width - x : r->chunk_width;
  uint32_t rows = shape->height - y < r->chunk_height ? shape->height - y : r->chunk_height;
  uint16_t sample = (uint16_t)(shape->planar ? plane : 0);
  uint32_t slice = r->target->slice;
  uint32_t index = r->tiled ? TIFFComputeTile(tiff, x, y, slice, sample) : TIFFComputeStrip(tiff, y, sample);
  hl_status status = decode(r, index, rows, error);
  /* number of bytes of the slices before this one in the tile */
  size_t before = (size_t)(slice % r->chunk_depth) * r->chunk_height * r->row_bytes;
  for (uint32_t row = 0; status == HL_OK && row < rows; row++)
    take_row(r, r->chunk + before + row * r->row_bytes, plane, columns, (size_t)(y + row) * shape->width + x);
  return status;
}

static hl_status read_chunks(page_reading *r, hl_error *error) {
  const tiff_shape *shape = r->shape;
  hl_status status = HL_OK;
  unsigned begin = 0, end = 1;
  if (shape->planar && r->component >= 0) begin = (unsigned)r->component, end = begin + 1;
  if (shape->planar && r->component < 0) end = shape->components;
  for (unsigned plane = begin; plane < end; plane++)
    for (uint64_t y = 0; y < shape->height && status == HL_OK; y += r->chunk_height) {
      for (uint64_t x = 0; x < shape->width && status == HL_OK; x += r->chunk_width)
        status = read_chunk(r, plane, (uint32_t)x, (uint32_t)y, error);
      if (status == HL_OK && hl_cancelled(r->file->context))
        status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", r->file->path);
    }
  return status;
}

/* A tile may be larger than its page, but a tile is refused if it is more than TILE_IN_PAGES times as wide as
 * the page and larger than a megabyte. Without the limit TILE_IN_PAGES, a small file could have hundreds of
 * tiny pages, whose tiles would take seconds to decode. */
enum { TILE_IN_PAGES = 1024, SMALL_TILE_BYTES = 1 << 20 };

/* Finds the sizes of the page's chunks. If a chunk reaches beyond the page, only the chunk's rows within the
 * page are counted. Fails if libtiff computes another length for a chunk's rows. */
static hl_status measure_chunks(page_reading *r, hl_error *error) {
  const tiff_shape *shape = r->shape;
  TIFF *tiff = r->file->tiff;
  r->tiled = TIFFIsTiled(tiff);
  r->chunk_width = shape->width;
  r->chunk_height = shape->height;
  r->chunk_depth = 1;
  if (r->tiled && shape->depth > 1) TIFFGetField(tiff, TIFFTAG_TILEDEPTH, &r->chunk_depth);
  if (r->tiled) {
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &r->chunk_width);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &r->chunk_height);
  } else {
    uint32_t rows = shape->height;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows);
    if (rows < r->chunk_height) r->chunk_height = rows;
  }
  if (r->chunk_width < 1 || r->chunk_height < 1 || r->chunk_depth < 1 || r->chunk_depth > INT16_MAX)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a page in chunks of %u x %u pixels", r->file->path,
                   r->chunk_width, r->chunk_height);
  uint64_t height = r->chunk_height < shape->height ? r->chunk_height : shape->height;
  /* The rows of a tile with several slices are the rows of all its slices. */
  if (r->chunk_depth > 1) height = (uint64_t)r->chunk_height * r->chunk_depth;
  uint64_t samples = (uint64_t)r->chunk_width * (shape->planar ? 1 : shape->components), bits, bytes;
  uint64_t told = r->tiled ? TIFFTileRowSize64(tiff) : TIFFScanlineSize64(tiff);
  if (__builtin_mul_overflow(samples, shape->bits, &bits) || (bits + 7) / 8 != told ||
      __builtin_mul_overflow(told, height, &bytes) || bytes > PTRDIFF_MAX)
    return tiff_file_fail(r->file, "a page whose rows have another length than its pixels", error);
  if ((double)bytes > 65536.0 * (double)r->file->size)
    return tiff_file_fail(r->file, "a page whose chunks are larger than the file can fill", error);
  if (bytes > SMALL_TILE_BYTES && r->chunk_width / TILE_IN_PAGES > shape->width)
    return hl_fail(error, HL_ERROR_INPUT, "%s: tiles of %u x %u pixels in a page of %u x %u", r->file->path,
                   r->chunk_width, r->chunk_height, shape->width, shape->height);
  r->row_bytes = (size_t)told;
  r->chunk_bytes = (size_t)bytes;
  return HL_OK;
}

/* Reads the pixels of a page whose rows follow each other in the file, without libtiff. */
static hl_status read_plain(page_reading *r, hl_error *error) {
  const tiff_shape *shape = r->shape;
  size_t size = hl_voxel_type_bytes(shape->type), samples = (size_t)shape->width * shape->components;
  bool swap = size > 1 && (TIFFIsBigEndian(r->file->tiff) != 0) != native_is_big_endian;
  uint64_t before = r->file->at;
  hl_status status = HL_OK;
  r->file->at = r->target->plain;
  for (uint32_t y = 0; y < shape->height && status == HL_OK; y++) {
    tmsize_t got = read_bytes(r->file, r->chunk, (tmsize_t)(samples * size));
    if (got < 0 || (size_t)got < samples * size)
      status = tiff_file_fail(r->file, "a page is cut short", error);
    for (size_t n = 0; swap && n < samples * size; n += size)
      for (size_t b = 0; b < size / 2; b++) {
        unsigned char first = r->chunk[n + b];
        r->chunk[n + b] = r->chunk[n + size - 1 - b];
        r->chunk[n + size - 1 - b] = first;
      }
    if (status == HL_OK) take_row(r, r->chunk, 0, shape->width, (size_t)y * shape->width);
  }
  r->file->at = before;
  return status;
}

hl_status tiff_file_read(tiff_file *file, const tiff_shape *shape, int component, const tiff_target *target,
                         hl_error *error) {
  page_reading r = {
      .file = file, .shape = shape, .component = component, .voxels = target->voxels, .target = target};
  file->message[0] = 0;
  hl_status status = HL_OK;
  if (target->plain > 0) {
    r.chunk_width = shape->width;
    r.chunk_bytes = (size_t)shape->width * shape->components * hl_voxel_type_bytes(shape->type);
  } else {
    status = measure_chunks(&r, error);
  }
  if (status != HL_OK) return status;
  size_t samples = (size_t)r.chunk_width * (shape->planar ? 1 : shape->components);
  r.chunk = hl_allocate(file->context, r.chunk_bytes, 1);
  r.samples = hl_allocate(file->context, samples, 8);
  r.picked = hl_allocate(file->context, r.chunk_width, 8);
  if (r.chunk == NULL || r.samples == NULL || r.picked == NULL)
    status = hl_fail_memory(error, r.chunk_bytes + 16 * samples, file->path);
  else status = target->plain > 0 ? read_plain(&r, error) : read_chunks(&r, error);
  hl_release(file->context, r.chunk);
  hl_release(file->context, r.samples);
  hl_release(file->context, r.picked);
  return status;
}
