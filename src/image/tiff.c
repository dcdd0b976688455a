/* image/tiff.c - reads and writes TIFF files with 8 or 16 bits, through libtiff.
 *
 * Reading. In: the bytes of a file, which may be damaged or hostile. Out: the picture of the first page,
 * which must have sRGB codes of grey or RGB, with or without alpha, in strips.
 *
 * Writing. In: a picture. Out: one page of sRGB codes, RGB over the background or, with
 * background_transparent, unassociated RGBA (codes.c), packed by deflate, with the resolution in pixels per
 * inch if the caller gives a resolution. */
#define _GNU_SOURCE
#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <tiffio.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/codes.h"
#include "image/format.h"
#include "image/srgb.h"

/* ---- writing ---- */

static tmsize_t on_read(thandle_t file, void *bytes, tmsize_t length) {
  return (tmsize_t)fread(bytes, 1, (size_t)length, file);
}

static tmsize_t on_write(thandle_t file, void *bytes, tmsize_t length) {
  return (tmsize_t)fwrite(bytes, 1, (size_t)length, file);
}

static toff_t on_seek(thandle_t file, toff_t offset, int whence) {
  return fseeko(file, (off_t)offset, whence) == 0 ? (toff_t)ftello(file) : (toff_t)-1;
}

static int on_close(thandle_t file) { return fflush(file); }

static toff_t on_size(thandle_t file) {
  off_t here = ftello(file);
  if (here < 0 || fseeko(file, 0, SEEK_END) != 0) return 0;
  off_t size = ftello(file);
  return fseeko(file, here, SEEK_SET) == 0 ? (toff_t)size : 0;
}

/* Ignores libtiff's messages. The caller reports failures of writing in the same way for all formats. */
static int on_message(TIFF *tiff, void *data, const char *module, const char *format, va_list arguments) {
  (void)tiff, (void)data, (void)module, (void)format, (void)arguments;
  return 1;
}

static TIFF *open_tiff(hl_output *output) {
  TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
  if (options == NULL) return NULL;
  TIFFOpenOptionsSetErrorHandlerExtR(options, on_message, NULL);
  TIFFOpenOptionsSetWarningHandlerExtR(options, on_message, NULL);
  TIFF *tiff = TIFFClientOpenExt(output->path, "w", output->file, on_read, on_write, on_seek, on_close,
                                 on_size, NULL, NULL, options);
  TIFFOpenOptionsFree(options);
  return tiff;
}

static void set_fields(TIFF *tiff, const hl_image *image, const hl_image_write_options *options) {
  const uint16_t unassociated = EXTRASAMPLE_UNASSALPHA;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, (uint32_t)image->width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, (uint32_t)image->height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, options->png_depth);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, options->background_transparent ? 4 : 3);
  if (options->background_transparent) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &unassociated);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
  if (options->pixels_per_inch <= 0) return;
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, options->pixels_per_inch);
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, options->pixels_per_inch);
}

/* Swaps the bytes of a row's 16-bit codes if needed. In the codes the more significant byte comes first, but
 * the samples in the TIFF file have the machine's byte order. */
static void order_bytes(unsigned char *row, size_t samples) {
  for (size_t i = 0; i < samples; i++) {
    uint16_t code = (uint16_t)(row[2 * i] << 8 | row[2 * i + 1]);
    memcpy(row + 2 * i, &code, sizeof code);
  }
}

static hl_status write_rows(TIFF *tiff, const hl_image *image, const hl_image_write_options *options,
                            const hl_codes *codes, unsigned char *row, hl_output *output, hl_error *error) {
  size_t samples = (size_t)image->width * (options->background_transparent ? 4 : 3);
  for (int y = 0; y < image->height; y++) {
    hl_status status = hl_encode_step(output->context, y, image->height, error);
    if (status != HL_OK) return status;
    hl_codes_of_row(codes, image->pixels + (size_t)y * (size_t)image->width * 4, image->width, y, row);
    if (options->png_depth == 16) order_bytes(row, samples);
    errno = 0;
    if (TIFFWriteScanline(tiff, row, (uint32_t)y, 0) < 0) return hl_fail_write(error, output, errno);
  }
  errno = 0;
  return TIFFWriteDirectory(tiff) == 1 ? HL_OK : hl_fail_write(error, output, errno);
}

static hl_status encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  hl_codes codes;
  hl_status status = hl_codes_begin(output->context, options, options->png_depth, &codes, error);
  if (status != HL_OK) return status;
  size_t row_bytes = (size_t)image->width * 4 * (size_t)(options->png_depth / 8);
  unsigned char *row = hl_allocate(output->context, row_bytes, 1);
  TIFF *tiff = row != NULL ? open_tiff(output) : NULL;
  if (tiff == NULL) status = hl_fail_memory(error, row_bytes, output->path);
  if (status == HL_OK) {
    set_fields(tiff, image, options);
    status = write_rows(tiff, image, options, &codes, row, output, error);
  }
  if (tiff != NULL) TIFFClose(tiff);
  hl_release(output->context, row);
  hl_codes_end(&codes);
  return status;
}
/* ---- reading ---- */

/* The greatest factor by which compressed bytes can expand. The factor of deflate is 1032, and the factor of
 * LZW is below 4096. */
enum { EXPANSION_MAX = 4096 };

/* The bytes of a file, as libtiff reads them. */
typedef struct tiff_bytes {
  const unsigned char *bytes; /* borrowed; [length] */
  size_t length, at;
} tiff_bytes;

static tmsize_t read_bytes(thandle_t data, void *to, tmsize_t length) {
  tiff_bytes *from = data;
  const size_t left = from->at < from->length ? from->length - from->at : 0,
               taken = (size_t)length < left ? (size_t)length : left;
  memcpy(to, from->bytes + from->at, taken);
  from->at += taken;
  return (tmsize_t)taken;
}

static tmsize_t write_nothing(thandle_t data, void *bytes, tmsize_t length) {
  (void)data, (void)bytes, (void)length;
  return -1;
}

static toff_t seek_bytes(thandle_t data, toff_t offset, int whence) {
  tiff_bytes *from = data;
  const uint64_t base = whence == SEEK_CUR ? from->at : whence == SEEK_END ? from->length : 0;
  if (offset > SIZE_MAX - base) return (toff_t)-1;
  from->at = (size_t)(base + offset);
  return from->at;
}

static int close_nothing(thandle_t data) {
  (void)data;
  return 0;
}

static toff_t size_of_bytes(thandle_t data) { return ((tiff_bytes *)data)->length; }

/* The position of the first page's header, which often lies at the end of the file. */
static uint64_t place_of_page(const unsigned char *bytes) {
  uint64_t place = 0;
  const bool little = bytes[0] == 'I';
  for (int n = 0; n < 4; n++) place |= (uint64_t)bytes[little ? 4 + n : 7 - n] << (8 * n);
  return place;
}

/* Returns whether the first page's header has a credible number of tags. A header with a great number of tags
 * is refused, because libtiff's time grows with the square of the number of tags. */
static bool has_few_tags(const unsigned char *bytes, size_t length) {
  enum { MOST_TAGS = 512 };
  if (length < 8 || place_of_page(bytes) + 2 > length) return false;
  const unsigned char *count = bytes + place_of_page(bytes);
  return (bytes[0] == 'I' ? count[0] + 256 * count[1] : count[1] + 256 * count[0]) <= MOST_TAGS;
}

static TIFF *open_bytes(tiff_bytes *from) {
  enum { MOST_AT_ONCE = 1 << 28 };
  TIFFOpenOptions *options = has_few_tags(from->bytes, from->length) ? TIFFOpenOptionsAlloc() : NULL;
  if (options == NULL) return NULL;
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, MOST_AT_ONCE);
  TIFFOpenOptionsSetErrorHandlerExtR(options, on_message, NULL);
  TIFFOpenOptionsSetWarningHandlerExtR(options, on_message, NULL);
  TIFF *tiff = TIFFClientOpenExt("a picture", "r", from, read_bytes, write_nothing, seek_bytes, close_nothing,
                                 size_of_bytes, NULL, NULL, options);
  TIFFOpenOptionsFree(options);
  return tiff;
}

/* The size and the format of the samples of a file's first page. */
typedef struct tiff_page {
  uint32_t width, height;
  uint16_t samples, bits, format, photometric, planar;
  bool alpha, multiplied; /* whether the last sample of a pixel is alpha, and whether colours are multiplied
                           * by alpha */
} tiff_page;

static tiff_page page_of(TIFF *tiff) {
  tiff_page page = {.samples = 1, .bits = 1, .format = SAMPLEFORMAT_UINT, .planar = PLANARCONFIG_CONTIG};
  uint16_t extra = 0, *kinds = NULL;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &page.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &page.format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &page.planar);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &page.photometric);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
  page.alpha = page.samples == 2 || page.samples == 4;
  page.multiplied = page.alpha && extra > 0 && kinds[0] == EXTRASAMPLE_ASSOCALPHA;
  return page;
}

static hl_status check_page(TIFF *tiff, const tiff_page *page, const char *name, hl_error *error) {
  const bool grey = page->photometric == PHOTOMETRIC_MINISBLACK && page->samples <= 2,
             colored = page->photometric == PHOTOMETRIC_RGB && (page->samples == 3 || page->samples == 4);
  const uint64_t row = (uint64_t)page->width * page->samples * (page->bits / 8);
  if ((!grey && !colored) || page->samples < 1 || (page->bits != 8 && page->bits != 16) ||
      page->format != SAMPLEFORMAT_UINT || page->planar != PLANARCONFIG_CONTIG || TIFFIsTiled(tiff) ||
      TIFFScanlineSize64(tiff) != row)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: a TIFF of another kind than grey or RGB with 8 or 16 bits in strips: save it as such, or "
        "as PNG",
        name);
  return HL_OK;
}

/* Decodes a row of codes into premultiplied linear light. linear: [1 << bits]; the light of each code. */
static void decode_row(const tiff_page *page, const unsigned char *row, const float *linear, float *pixels) {
  const size_t samples = page->samples, colors = samples - page->alpha;
  const float most = (float)((1 << page->bits) - 1);
  for (size_t x = 0; x < page->width; x++, pixels += 4) {
    uint32_t codes[4];
    for (size_t s = 0; s < samples; s++) {
      uint16_t code;
      memcpy(&code, row + 2 * (samples * x + s) * (page->bits == 16), sizeof code);
      codes[s] = page->bits == 16 ? code : row[samples * x + s];
    }
    pixels[3] = page->alpha ? (float)codes[colors] / most : 1;
    for (size_t c = 0; c < 3; c++) {
      uint32_t code = codes[colors == 3 ? c : 0];
      if (page->multiplied && codes[colors] > 0) {
        code = (uint32_t)((double)code * most / codes[colors] + 0.5);
        code = code < (uint32_t)most ? code : (uint32_t)most;
      }
      pixels[c] = linear[code] * pixels[3];
    }
  }
}

static hl_status read_rows(hl_context *context, TIFF *tiff, const tiff_page *page, const char *name,
                           hl_image *image, hl_error *error) {
  const size_t codes = (size_t)1 << page->bits, row_bytes = (size_t)TIFFScanlineSize(tiff);
  float *linear = hl_allocate(context, codes, sizeof *linear);
  unsigned char *row = hl_allocate(context, row_bytes + 1, 1);
  hl_status status = linear != NULL && row != NULL ? HL_OK : hl_fail_memory(error, row_bytes, name);
  for (size_t n = 0; n < codes && status == HL_OK; n++)
    linear[n] = (float)hl_srgb_decode((double)n / (double)(codes - 1));
  for (uint32_t y = 0; y < page->height && status == HL_OK; y++) {
    if (hl_cancelled(context)) status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", name);
    else if (TIFFReadScanline(tiff, row, y, 0) < 0)
      status = hl_fail(error, HL_ERROR_INPUT, "%s: damaged TIFF file: row %" PRIu32 " cannot be read", name,
                       y);
    else decode_row(page, row, linear, image->pixels + 4 * (size_t)page->width * y);
  }
  hl_release(context, row);
  hl_release(context, linear);
  return status;
}

static hl_status read_page(hl_context *context, TIFF *tiff, const char *name, size_t length, hl_image **image,
                           hl_error *error) {
  const tiff_page page = page_of(tiff);
  hl_status status = check_page(tiff, &page, name, error);
  const uint64_t bytes = (uint64_t)page.width * page.height * page.samples * (page.bits / 8);
  if (status == HL_OK && bytes / EXPANSION_MAX > length)
    status = hl_fail(error, HL_ERROR_INPUT,
                     "%s: damaged TIFF file: claims %" PRIu32 " x %" PRIu32
                     " pixels, more than %zu bytes of file can hold",
                     name, page.width, page.height, length);
  if (status == HL_OK)
    status = hl_image_create_for_file(context, name, page.width, page.height, image, error);
  if (status == HL_OK) status = read_rows(context, tiff, &page, name, *image, error);
  if (status == HL_OK) return HL_OK;
  hl_image_destroy(*image);
  *image = NULL;
  return status;
}

static hl_status decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  tiff_bytes from = {.bytes = bytes, .length = length};
  TIFF *tiff = open_bytes(&from);
  if (tiff == NULL) return hl_fail(error, HL_ERROR_INPUT, "%s: damaged TIFF file: no page can be read", name);
  hl_status status = read_page(context, tiff, name, length, image, error);
  TIFFClose(tiff);
  return status;
}

/* Reads the size from the first page's header. If the bytes do not include the page's header yet, the claim
 * is the number of bytes up to the header. */
static hl_image_claim claim(const unsigned char *bytes, size_t length) {
  hl_image_claim claimed = {0};
  if (length < 8) return claimed;
  const uint64_t place = place_of_page(bytes);
  tiff_bytes from = {.bytes = bytes, .length = length};
  TIFF *tiff = place < length ? open_bytes(&from) : NULL;
  if (tiff == NULL)
    return place < length ? claimed
                          : (hl_image_claim){.known = true, .width = 1, .height = 1, .bytes = place};
  const tiff_page page = page_of(tiff);
  claimed = (hl_image_claim){.known = page.width > 0 && page.height > 0,
                             .width = page.width,
                             .height = page.height,
                             .channels = page.samples,
                             .bits = page.bits};
  if (page.width <= HL_IMAGE_SIDE_MAX && page.height <= HL_IMAGE_SIDE_MAX)
    claimed.bytes = (uint64_t)page.width * page.height * page.samples * ((page.bits + 7U) / 8);
  TIFFClose(tiff);
  return claimed;
}

/* The first bytes of a TIFF file, "II" or "MM", state the byte order of its numbers. */
const hl_image_format hl_tif_format = {.extension = ".tif",
                                       .title = "TIFF",
                                       .mark = "II*",
                                       .mark_length = 4,
                                       .encode = encode,
                                       .decode = decode,
                                       .claim = claim};
const hl_image_format hl_tiff_format = {.extension = ".tiff",
                                        .title = "TIFF",
                                        .mark = {'M', 'M', 0, '*'},
                                        .mark_length = 4,
                                        .encode = encode,
                                        .decode = decode,
                                        .claim = claim};
