/* image/tiff.c - writes TIFF files with 8 or 16 bits, through libtiff.
 *
 * In: a picture. Out: one page of sRGB codes, RGB over the background or, with background_transparent,
 * unassociated RGBA (codes.c), packed by deflate; the resolution in pixels per inch if one is given. */
#define _GNU_SOURCE
#include <errno.h>
#include <string.h>
#include <tiffio.h>

#include "core/memory.h"
#include "image/codes.h"
#include "image/format.h"

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

/* Ignores libtiff's messages. The caller reports the failure, in the same words as for all outputs. */
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

/* Swaps the bytes of a row's 16-bit codes if needed. The codes have the greater byte first, but the samples
 * in the TIFF file have the machine's byte order. */
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
const hl_image_format hl_tif_format = {.extension = ".tif", .title = "TIFF", .encode = encode};
const hl_image_format hl_tiff_format = {.extension = ".tiff", .title = "TIFF", .encode = encode};
