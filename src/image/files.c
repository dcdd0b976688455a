/* image/files.c - finds the format of a picture's file, and reads and writes pictures in all formats.
 *
 * The name's extension decides the format of a written file; the first bytes decide the format of a read
 * file, so that a wrongly named picture is still read. */
#include "image/format.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/endings.h"
#include "core/memory.h"
#include "text/plain.h"

/* The list of all picture formats. */
static const hl_image_format *const formats[] = {&hl_png_format, &hl_exr_format, &hl_npy_format,
                                                 &hl_hdr_format, &hl_tif_format, &hl_tiff_format};

enum { FORMAT_COUNT = sizeof formats / sizeof formats[0] };

/* The number of the first format, from number n on, whose title differs from the title of the preceding
 * format. For the user, formats with the same title are one format. */
static size_t next_title(size_t n) {
  while (n > 0 && n < FORMAT_COUNT && strcmp(formats[n]->title, formats[n - 1]->title) == 0) n++;
  return n;
}

hl_status hl_image_get_format(size_t index, hl_file_format *format) {
  if (format == NULL || format->struct_size != sizeof *format) return HL_ERROR_ARGUMENT;
  size_t first = 0;
  for (size_t n = 0; n < index && first < FORMAT_COUNT; n++) first = next_title(first + 1);
  if (first >= FORMAT_COUNT) return HL_ERROR_ARGUMENT;
  const hl_image_format *f = formats[first];
  bool available = f->missing == NULL;
  *format = (hl_file_format){.struct_size = sizeof *format,
                             .name = f->title,
                             .reads = available && f->decode != NULL,
                             .writes = available && f->encode != NULL,
                             .missing = f->missing};
  for (size_t n = first; n < next_title(first + 1); n++) {
    if (f->decode != NULL) hl_endings_add(format->read_endings, formats[n]->extension);
    if (f->encode != NULL) hl_endings_add(format->written_endings, formats[n]->extension);
  }
  return HL_OK;
}

/* Limits in bytes. extra_bytes_max limits the data in a file beside its pixels: texts, profiles, thumbnails.
 * header_bytes_max limits a file's header. */
static const size_t extra_bytes_max = (size_t)64 << 20, header_bytes_max = (size_t)16 << 20;

static const hl_image_format *format_by_name(const char *path) {
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot != NULL && i < FORMAT_COUNT; i++)
    if (hl_plain_equal(dot, formats[i]->extension)) return formats[i];
  return NULL;
}

static const hl_image_format *written_format(const char *path) {
  const hl_image_format *format = format_by_name(path);
  return format != NULL && format->encode != NULL ? format : NULL;
}

static const hl_image_format *format_by_content(const unsigned char *bytes, size_t length) {
  for (size_t i = 0; i < FORMAT_COUNT; i++)
    if (formats[i]->decode != NULL && length >= formats[i]->mark_length &&
        memcmp(bytes, formats[i]->mark, formats[i]->mark_length) == 0)
      return formats[i];
  return NULL;
}

/* Makes "folder/picture-layer.npy" from "folder/picture.npy". The result is owned by the caller; null if
 * memory is short. */
static char *layer_path(hl_context *context, const char *path, const char *layer) {
  const char *dot = strrchr(path, '.');
  size_t stem = (size_t)(dot - path), length = strlen(path) + strlen(layer) + 2;
  char *made = hl_allocate(context, length, 1);
  if (made != NULL) snprintf(made, length, "%.*s-%s%s", (int)stem, path, layer, dot);
  return made;
}

static hl_status write_layer_file(const hl_image_format *format, hl_context *context, const hl_image *image,
                                  const hl_image_layer *layer, const char *path, hl_error *error) {
  char *name = layer_path(context, path, layer->name);
  if (name == NULL) return hl_fail_memory(error, strlen(path), path);
  hl_output output;
  hl_status status = hl_output_begin(context, name, &output, error);
  if (status == HL_OK) {
    status = format->encode_layer(image, layer, &output, error);
    if (status == HL_OK) status = hl_output_commit(&output, error);
    hl_output_abort(&output);
  }
  hl_release(context, name);
  return status;
}

/* If the format cannot hold layers in the picture's file, writes each layer as a file of its own. */
static hl_status write_layers(const hl_image_format *format, hl_context *context, const hl_image *image,
                              const char *path, hl_error *error) {
  if (image->layer_count == 0 || format->holds_layers) return HL_OK;
  if (format->encode_layer == NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %s cannot hold layers: write .exr or .npy", path,
                   format->title);
  hl_status status = HL_OK;
  for (size_t i = 0; i < image->layer_count && status == HL_OK; i++)
    status = write_layer_file(format, context, image, &image->layers[i], path, error);
  return status;
}

hl_status hl_image_write(hl_context *context, const hl_image *image, const char *path,
                         const hl_image_write_options *options, hl_error *error) {
  HL_DOOR;
  if (context == NULL || image == NULL || path == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_write: context, image and path must not be null");
  hl_image_write_options chosen;
  hl_image_write_options_defaults(&chosen);
  if (options == NULL) options = &chosen;
  hl_status status = hl_image_check_options(options, "hl_image_write", error);
  if (status != HL_OK) return status;
  const hl_image_format *format = written_format(path);
  if (format == NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: unknown picture format: end the name in .png, .tif, .exr or .npy", path);
  status = write_layers(format, context, image, path, error);
  if (status != HL_OK) return status;
  hl_output output;
  status = hl_output_begin(context, path, &output, error);
  if (status != HL_OK) return status;
  status = format->encode(image, options, &output, error);
  if (status == HL_OK) status = hl_output_commit(&output, error);
  hl_output_abort(&output);
  if (status == HL_OK) hl_progress(context, "write", 1);
  return status;
}

hl_status hl_image_encode(hl_context *context, const hl_image *image, const char *format_name,
                          const hl_image_write_options *options, unsigned char **bytes, size_t *length,
                          hl_error *error) {
  HL_DOOR;
  if (context == NULL || image == NULL || format_name == NULL || bytes == NULL || length == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_encode: context, image, format, bytes and length must not be null");
  *bytes = NULL;
  *length = 0;
  hl_image_write_options chosen;
  hl_image_write_options_defaults(&chosen);
  if (options == NULL) options = &chosen;
  hl_status status = hl_image_check_options(options, "hl_image_encode", error);
  if (status != HL_OK) return status;
  char extension[8];
  snprintf(extension, sizeof extension, ".%.6s", format_name);
  const hl_image_format *format = written_format(extension);
  if (format == NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "hl_image_encode: unknown picture format \"%.20s\": give png, tif, exr or npy",
                   format_name);
  if (image->layer_count > 0 && !format->holds_layers)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "hl_image_encode: %s cannot hold layers in one stream: give exr", format->title);
  hl_output_memory memory;
  status = hl_output_memory_begin(context, "a picture in memory", &memory, error);
  if (status != HL_OK) return status;
  status = format->encode(image, options, &memory.output, error);
  if (memory.full) status = hl_fail_memory(error, memory.capacity, "a picture in memory");
  if (status == HL_OK) status = hl_output_memory_commit(&memory, bytes, length, error);
  else hl_output_memory_abort(&memory);
  if (status == HL_OK) hl_progress(context, "write", 1);
  return status;
}

void hl_bytes_release(hl_context *context, unsigned char *bytes) { hl_release(context, bytes); }

static hl_status fail_unknown(const char *path, hl_error *error) {
  const hl_image_format *named = format_by_name(path);
  if (named != NULL && named->decode != NULL)
    return hl_fail_offset(error, HL_ERROR_INPUT, 0,
                          "%s: byte 0: not a %s file: its first bytes are not the mark of one", path,
                          named->title);
  return hl_fail_offset(
      error, HL_ERROR_UNSUPPORTED, 0,
      "%s: byte 0: unknown picture format: expected a PNG, OpenEXR, Radiance HDR, NPY or TIFF file", path);
}

/* Limits the length of a file by the size in its header. The limit allows for compressed pixels one and a
 * half times the bytes of plain pixels, because compressed pixels never take more bytes. */
static hl_status judge(const char *path, const unsigned char *bytes, size_t length, size_t *limit,
                       hl_error *error) {
  const hl_image_format *format = format_by_content(bytes, length);
  if (format == NULL) return fail_unknown(path, error);
  hl_image_claim claim = format->claim(bytes, length);
  if (!claim.known && length > header_bytes_max)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: no header of a picture within its first %zu bytes: damaged %s file", path,
                   header_bytes_max, format->title);
  if (!claim.known) return HL_OK;
  hl_status status = hl_image_check_size(path, claim.width, claim.height, error);
  if (status == HL_OK) *limit = (size_t)claim.bytes + (size_t)claim.bytes / 2 + extra_bytes_max;
  if (status == HL_OK && length > *limit)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: more than %zu bytes, too many for a picture of %" PRIu64 " x %" PRIu64 " pixels",
                   path, *limit, claim.width, claim.height);
  return status;
}

hl_status hl_image_get_about(const char *name, const void *bytes, size_t byte_count, hl_image_about *about,
                             hl_error *error) {
  HL_DOOR;
  if (name == NULL || bytes == NULL || about == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_get_about: name, bytes and about must not be null");
  if (about->struct_size != sizeof *about)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_get_about: struct_size is %zu, expected %zu",
                   about->struct_size, sizeof *about);
  const hl_image_format *format = format_by_content(bytes, byte_count);
  if (format == NULL) return fail_unknown(name, error);
  if (format->missing != NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: this build does not read %s: it lacks %s", name,
                   format->title, format->missing);
  const hl_image_claim claim = format->claim(bytes, byte_count);
  if (!claim.known)
    return hl_fail(error, HL_ERROR_INPUT, "%s: damaged %s file: it has no header of a picture", name,
                   format->title);
  *about = (hl_image_about){.struct_size = sizeof *about,
                            .format = format->title,
                            .width = claim.width,
                            .height = claim.height,
                            .channels = claim.channels,
                            .bits = claim.bits,
                            .has_scene = hl_png_has_scene(bytes, byte_count)};
  memcpy(about->layers, claim.layers, sizeof about->layers);
  return HL_OK;
}

hl_status hl_image_read(hl_context *context, const char *path, hl_image **image, hl_error *error) {
  HL_DOOR;
  if (image != NULL) *image = NULL;
  if (context == NULL || path == NULL || image == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_read: context, path and image must not be null");
  unsigned char *bytes = NULL;
  size_t length = 0;
  hl_status status = hl_file_read_judged(context, path, judge, &bytes, &length, error);
  if (status != HL_OK) return status;
  const hl_image_format *format = format_by_content(bytes, length);
  status = format != NULL ? format->decode(context, path, bytes, length, image, error)
                          : fail_unknown(path, error);
  hl_release(context, bytes);
  return status;
}
