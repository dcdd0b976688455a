/* image/exr.c - reads and writes pictures as OpenEXR scanlines, through OpenEXRCore.
 *
 * In: the bytes of a file, which may be anything. Out: a picture of the first part's data window: channels R,
 * G, B (or Y for grey) and A (1 where it is missing), from half, float or integer samples. Out to a file:
 * named channels (exr.h), or a picture with its layers, as 32-bit floats compressed by ZIP, whose bits are
 * the bits of the values. OpenEXRCore writes through on_write, so that errors of writing such as a full disk
 * are detected, and so that the bytes go to the caller's temporary file.
 *
 * Against hostile files: OpenEXRCore reads through on_read, bounded by the file's bytes; kinds of files and
 * compressions that are not needed are refused; sizes are limited before allocation and compared with the
 * greatest size that the file's bytes can expand to. */
#define _GNU_SOURCE
#include "image/exr.h"

#include <errno.h>
#include <inttypes.h>
#include <openexr.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/format.h"

/* ---- reading ---- */

/* The greatest factor by which compressed bytes can expand: of all accepted compressions, deflate has the
 * greatest factor, 1032. */
enum { EXPANSION_MAX = 1032 };
static const uint64_t chunk_bytes_max = (uint64_t)1 << 28;

typedef struct exr_reading {
  hl_context *context;
  const char *name;
  const unsigned char *bytes; /* borrowed; [length]; the bytes of the file */
  size_t length;
  hl_error *error;
  exr_context_t file;
  unsigned present;        /* bit i is set if the file has channel number i (channel_index) */
  uint64_t pixel_bytes;    /* bytes of all channels of one pixel */
  exr_attr_box2i_t window; /* the data window of the file's first part */
  hl_image *image;
  char message[200]; /* the first message of OpenEXRCore about a fault */
} exr_reading;

static int64_t on_size(exr_const_context_t file, void *user_data) {
  (void)file;
  return (int64_t)((exr_reading *)user_data)->length;
}

static int64_t on_read(exr_const_context_t file, void *user_data, void *to, uint64_t length, uint64_t offset,
                       exr_stream_error_func_ptr_t report) {
  (void)file;
  (void)report;
  const exr_reading *reading = user_data;
  if (offset > reading->length) return -1;
  uint64_t left = reading->length - offset, taken = length < left ? length : left;
  memcpy(to, reading->bytes + offset, (size_t)taken);
  return (int64_t)taken;
}

static void on_read_error(exr_const_context_t file, exr_result_t code, const char *message) {
  void *user_data = NULL;
  (void)code;
  if (file == NULL || exr_get_user_data(file, &user_data) != EXR_ERR_SUCCESS || user_data == NULL) return;
  exr_reading *reading = user_data;
  if (reading->message[0] == 0) snprintf(reading->message, sizeof reading->message, "%s", message);
}

static hl_status fail_exr(exr_reading *reading, exr_result_t result) {
  if (result == EXR_ERR_OUT_OF_MEMORY) return hl_fail_memory(reading->error, reading->length, reading->name);
  return hl_fail(reading->error, HL_ERROR_INPUT, "%s: damaged OpenEXR file: %s", reading->name,
                 reading->message[0] != 0 ? reading->message : exr_get_default_error_message(result));
}

static bool is_accepted(exr_compression_t compression) {
  return compression == EXR_COMPRESSION_NONE || compression == EXR_COMPRESSION_RLE ||
         compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP ||
         compression == EXR_COMPRESSION_PIZ;
}

static hl_status check_kind(exr_reading *reading) {
  exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
  exr_compression_t compression = EXR_COMPRESSION_LAST_TYPE;
  exr_result_t result = exr_get_storage(reading->file, 0, &storage);
  if (result == EXR_ERR_SUCCESS) result = exr_get_compression(reading->file, 0, &compression);
  if (result != EXR_ERR_SUCCESS) return fail_exr(reading, result);
  if (storage != EXR_STORAGE_SCANLINE)
    return hl_fail(reading->error, HL_ERROR_UNSUPPORTED,
                   "%s: a tiled or deep OpenEXR file; save it as flat scanlines", reading->name);
  if (!is_accepted(compression))
    return hl_fail(reading->error, HL_ERROR_UNSUPPORTED,
                   "%s: OpenEXR compression number %d; save it with none, RLE, ZIPS, ZIP or PIZ",
                   reading->name, (int)compression);
  return HL_OK;
}

enum { CHANNEL_Y = 4, COLOURS = 7, GREY = 1 << CHANNEL_Y };

/* The index of a channel: 0..3 for R, G, B and A, CHANNEL_Y for Y, and -1 for any other name. */
static int channel_index(const char *name) {
  static const char names[] = "RGBAY";
  const char *found = name[0] != 0 && name[1] == 0 ? strchr(names, name[0]) : NULL;
  return found == NULL ? -1 : (int)(found - names);
}

static hl_status check_channels(exr_reading *reading) {
  const exr_attr_chlist_t *list = NULL;
  exr_result_t result = exr_get_channels(reading->file, 0, &list);
  if (result != EXR_ERR_SUCCESS) return fail_exr(reading, result);
  for (int i = 0; i < list->num_channels; i++) {
    const exr_attr_chlist_entry_t *entry = &list->entries[i];
    if (entry->x_sampling != 1 || entry->y_sampling != 1)
      return hl_fail(reading->error, HL_ERROR_UNSUPPORTED,
                     "%s: channel %.40s is subsampled; save all channels at full size", reading->name,
                     entry->name.str);
    int index = channel_index(entry->name.str);
    if (index >= 0) reading->present |= 1u << index;
    reading->pixel_bytes += entry->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
  }
  if ((reading->present & COLOURS) != COLOURS && (reading->present & (COLOURS | GREY)) != GREY)
    return hl_fail(reading->error, HL_ERROR_UNSUPPORTED,
                   "%s: expected channels R, G and B, or Y alone, among its %d", reading->name,
                   list->num_channels);
  return HL_OK;
}

/* Makes the picture, unless the file is too short for the size that its header claims. */
static hl_status make_image(exr_reading *reading) {
  exr_result_t result = exr_get_data_window(reading->file, 0, &reading->window);
  uint64_t chunk_bytes = 0;
  if (result == EXR_ERR_SUCCESS) result = exr_get_chunk_unpacked_size(reading->file, 0, &chunk_bytes);
  if (result != EXR_ERR_SUCCESS) return fail_exr(reading, result);
  int64_t width = (int64_t)reading->window.max.x - reading->window.min.x + 1;
  int64_t height = (int64_t)reading->window.max.y - reading->window.min.y + 1;
  if (width < 1 || height < 1) width = height = 0; /* make_image() refuses a width or height of 0 later */
  if (width <= HL_IMAGE_SIDE_MAX && height <= HL_IMAGE_SIDE_MAX &&
      ((uint64_t)(width * height) * reading->pixel_bytes / EXPANSION_MAX > reading->length ||
       chunk_bytes > chunk_bytes_max))
    return hl_fail(reading->error, HL_ERROR_INPUT,
                   "%s: damaged OpenEXR file: claims %" PRId64 " x %" PRId64 " pixels of %" PRIu64
                   " bytes, more than %zu bytes of file can hold",
                   reading->name, width, height, reading->pixel_bytes, reading->length);
  return hl_image_create_for_file(reading->context, reading->name, (uint64_t)width, (uint64_t)height,
                                  &reading->image, reading->error);
}

/* Points the decoder's R, G, B, A and Y channels at row y of the picture. */
static void place_channels(const exr_reading *reading, exr_decode_pipeline_t *pipeline, int y) {
  bool has_colours = (reading->present & COLOURS) != 0;
  float *row = reading->image->pixels + (size_t)y * (size_t)reading->image->width * 4;
  for (int i = 0; i < pipeline->channel_count; i++) {
    exr_coding_channel_info_t *channel = &pipeline->channels[i];
    int index = channel_index(channel->channel_name);
    if (index == CHANNEL_Y) index = has_colours ? -1 : 0;
    channel->user_data_type = EXR_PIXEL_FLOAT;
    channel->user_bytes_per_element = sizeof(float);
    channel->user_pixel_stride = 4 * sizeof(float);
    channel->user_line_stride = (int32_t)((size_t)reading->image->width * 4 * sizeof(float));
    channel->decode_to_ptr = index < 0 ? NULL : (uint8_t *)(row + index);
  }
}

static exr_result_t read_chunk(exr_reading *reading, exr_decode_pipeline_t *pipeline, int y, int *lines) {
  exr_chunk_info_t chunk;
  bool first = y == 0;
  exr_result_t result = exr_read_scanline_chunk_info(reading->file, 0, reading->window.min.y + y, &chunk);
  if (result != EXR_ERR_SUCCESS) return result;
  if (chunk.start_y != reading->window.min.y + y || chunk.height < 1 ||
      chunk.height > reading->image->height - y || chunk.width != reading->image->width ||
      chunk.unpacked_size > chunk_bytes_max || chunk.packed_size > reading->length)
    return EXR_ERR_CORRUPT_CHUNK;
  *lines = chunk.height;
  result = first ? exr_decoding_initialize(reading->file, 0, &chunk, pipeline)
                 : exr_decoding_update(reading->file, 0, &chunk, pipeline);
  if (result != EXR_ERR_SUCCESS) return result;
  place_channels(reading, pipeline, y);
  if (first) result = exr_decoding_choose_default_routines(reading->file, 0, pipeline);
  return result == EXR_ERR_SUCCESS ? exr_decoding_run(reading->file, 0, pipeline) : result;
}

static hl_status read_chunks(exr_reading *reading) {
  exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
  exr_result_t result = EXR_ERR_SUCCESS;
  int lines = 1;
  bool cancelled = false;
  for (int y = 0; y < reading->image->height && result == EXR_ERR_SUCCESS && !cancelled; y += lines) {
    result = read_chunk(reading, &pipeline, y, &lines);
    cancelled = hl_cancelled(reading->context);
  }
  exr_decoding_destroy(reading->file, &pipeline);
  if (cancelled) return hl_fail(reading->error, HL_ERROR_CANCELLED, "%s: cancelled", reading->name);
  return result == EXR_ERR_SUCCESS ? HL_OK : fail_exr(reading, result);
}

/* Copies grey to red, green and blue if the file has no colours, and sets alpha to 1 if the file has no
 * alpha. */
static void fill_missing(const exr_reading *reading) {
  bool grey = (reading->present & COLOURS) == 0, opaque = (reading->present >> 3 & 1) == 0;
  size_t count = (size_t)reading->image->width * (size_t)reading->image->height;
  for (size_t i = 0; i < count; i++) {
    float *pixel = reading->image->pixels + 4 * i;
    if (grey) pixel[1] = pixel[2] = pixel[0];
    if (opaque) pixel[3] = 1;
  }
}

static exr_result_t start_read(exr_reading *reading) {
  exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
  options.error_handler_fn = on_read_error;
  options.user_data = reading;
  options.read_fn = on_read;
  options.size_fn = on_size;
  options.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  return exr_start_read(&reading->file, reading->name, &options);
}

/* Adds the name of a channel's layer to a list, unless the layer's name is already the last name of the list.
 * The channels of a layer are neighbours, because OpenEXR sorts channels by their names. */
static void add_layer(const char *channel, char layers[HL_IMAGE_LAYERS_TEXT]) {
  const char *point = strrchr(channel, '.');
  const size_t length = point != NULL ? (size_t)(point - channel) : strlen(channel), used = strlen(layers);
  const char *last = strrchr(layers, ' ');
  last = last != NULL ? last + 1 : layers;
  if (channel_index(channel) >= 0 || length == 0 || strcmp(last, "...") == 0 ||
      (strlen(last) == length && strncmp(last, channel, length) == 0))
    return;
  const char *separator = used > 0 ? ", " : "";
  if (used + length + sizeof ", , ..." > HL_IMAGE_LAYERS_TEXT)
    snprintf(layers + used, HL_IMAGE_LAYERS_TEXT - used, "%s...", separator);
  else snprintf(layers + used, HL_IMAGE_LAYERS_TEXT - used, "%s%.*s", separator, (int)length, channel);
}

/* The width, the height and the number of uncompressed bytes of one part of a file. The number of bytes is 0
 * if the part's header does not state it. */
static hl_image_claim claim_of_part(exr_const_context_t file, int part) {
  const exr_attr_chlist_t *list = NULL;
  exr_attr_box2i_t window;
  hl_image_claim claim = {0};
  if (exr_get_data_window(file, part, &window) != EXR_ERR_SUCCESS ||
      exr_get_channels(file, part, &list) != EXR_ERR_SUCCESS || window.max.x < window.min.x ||
      window.max.y < window.min.y)
    return claim;
  claim.width = (uint64_t)((int64_t)window.max.x - window.min.x + 1);
  claim.height = (uint64_t)((int64_t)window.max.y - window.min.y + 1);
  claim.channels = list->num_channels;
  for (int n = 0; n < list->num_channels; n++) {
    const int bits = list->entries[n].pixel_type == EXR_PIXEL_HALF ? 16 : 32;
    claim.bits = claim.bits > bits ? claim.bits : bits;
    add_layer(list->entries[n].name.str, claim.layers);
  }
  if (claim.width <= HL_IMAGE_SIDE_MAX && claim.height <= HL_IMAGE_SIDE_MAX)
    claim.bytes = claim.width * claim.height * 4 *
                  (uint64_t)(list->num_channels > 0 ? list->num_channels : 0);
  return claim;
}

/* The size in pixels of a file's first part, and the number of uncompressed bytes of all parts. */
static hl_image_claim claim(const unsigned char *bytes, size_t length) {
  exr_reading reading = {.name = "a picture", .bytes = bytes, .length = length};
  hl_image_claim claimed = {0};
  int parts = 0;
  if (start_read(&reading) == EXR_ERR_SUCCESS && exr_get_count(reading.file, &parts) == EXR_ERR_SUCCESS &&
      parts > 0) {
    claimed = claim_of_part(reading.file, 0);
    claimed.known = claimed.width > 0;
    for (int part = 1; part < parts; part++) claimed.bytes += claim_of_part(reading.file, part).bytes;
  }
  if (reading.file != NULL) exr_finish(&reading.file);
  return claimed;
}

static hl_status decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  exr_reading reading = {.context = context, .name = name, .bytes = bytes, .length = length, .error = error};
  exr_result_t result = start_read(&reading);
  hl_status status = result == EXR_ERR_SUCCESS ? check_kind(&reading) : fail_exr(&reading, result);
  if (status == HL_OK) status = check_channels(&reading);
  if (status == HL_OK) status = make_image(&reading);
  if (status == HL_OK) status = read_chunks(&reading);
  if (reading.file != NULL) exr_finish(&reading.file);
  if (status != HL_OK) {
    hl_image_destroy(reading.image);
    return status;
  }
  fill_missing(&reading);
  *image = reading.image;
  return HL_OK;
}

/* ---- writing ---- */

typedef struct exr_writing {
  int width, height;
  const hl_exr_channel *channels; /* borrowed; [channel_count]; the channels that are written */
  size_t channel_count;
  hl_output *output;
  uint64_t at;      /* write position in bytes */
  int system_error; /* errno of the first failed write */
  bool write_failed;
  char message[200]; /* the first message of OpenEXRCore about a fault */
} exr_writing;

static int64_t on_write(exr_const_context_t file, void *user_data, const void *bytes, uint64_t length,
                        uint64_t offset, exr_stream_error_func_ptr_t report) {
  (void)file;
  (void)report;
  exr_writing *writing = user_data;
  errno = 0;
  bool placed = offset == writing->at || fseeko(writing->output->file, (off_t)offset, SEEK_SET) == 0;
  if (placed && fwrite(bytes, 1, length, writing->output->file) == length) {
    writing->at = offset + length;
    return (int64_t)length;
  }
  if (!writing->write_failed) writing->system_error = errno;
  writing->write_failed = true;
  return -1;
}

static void on_write_error(exr_const_context_t file, exr_result_t code, const char *message) {
  void *user_data = NULL;
  (void)code;
  if (file == NULL || exr_get_user_data(file, &user_data) != EXR_ERR_SUCCESS || user_data == NULL) return;
  exr_writing *writing = user_data;
  if (writing->message[0] == 0) snprintf(writing->message, sizeof writing->message, "%s", message);
}

static exr_result_t write_header(exr_writing *writing, exr_context_t file) {
  int part = 0;
  exr_result_t result = exr_add_part(file, "halflight", EXR_STORAGE_SCANLINE, &part);
  if (result == EXR_ERR_SUCCESS)
    result = exr_initialize_required_attr_simple(file, part, writing->width, writing->height,
                                                 EXR_COMPRESSION_ZIP);
  for (size_t i = 0; i < writing->channel_count && result == EXR_ERR_SUCCESS; i++)
    result = exr_add_channel(file, part, writing->channels[i].name, EXR_PIXEL_FLOAT,
                             EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  return result == EXR_ERR_SUCCESS ? exr_write_header(file) : result;
}

/* Points the pipeline's channels (which are sorted by name) at row y of the given channels. */
static void point_at_values(const exr_writing *writing, exr_encode_pipeline_t *pipeline, int y) {
  for (int i = 0; i < pipeline->channel_count; i++) {
    exr_coding_channel_info_t *to = &pipeline->channels[i];
    for (size_t c = 0; c < writing->channel_count; c++) {
      const hl_exr_channel *from = &writing->channels[c];
      if (strcmp(from->name, to->channel_name) != 0) continue;
      to->user_data_type = EXR_PIXEL_FLOAT;
      to->user_bytes_per_element = sizeof(float);
      to->user_pixel_stride = (int32_t)(from->pixel_stride * sizeof(float));
      to->user_line_stride = (int32_t)(from->pixel_stride * sizeof(float) * (size_t)writing->width);
      to->encode_from_ptr = (const uint8_t *)(from->values +
                                              (size_t)y * (size_t)writing->width * from->pixel_stride);
    }
  }
}

/* Writes one chunk of lines from row y on. The pipeline keeps its buffers between chunks. */
static exr_result_t write_chunk(const exr_writing *writing, exr_context_t file,
                                exr_encode_pipeline_t *pipeline, int y) {
  exr_chunk_info_t chunk;
  exr_result_t result = exr_write_scanline_chunk_info(file, 0, y, &chunk);
  if (result != EXR_ERR_SUCCESS) return result;
  result = y == 0 ? exr_encoding_initialize(file, 0, &chunk, pipeline)
                  : exr_encoding_update(file, 0, &chunk, pipeline);
  if (result != EXR_ERR_SUCCESS) return result;
  point_at_values(writing, pipeline, y);
  if (y == 0) result = exr_encoding_choose_default_routines(file, 0, pipeline);
  return result == EXR_ERR_SUCCESS ? exr_encoding_run(file, 0, pipeline) : result;
}

static exr_result_t write_chunks(exr_writing *writing, exr_context_t file, hl_status *status,
                                 hl_error *error) {
  exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
  int32_t lines = 1;
  exr_result_t result = exr_get_scanlines_per_chunk(file, 0, &lines);
  for (int y = 0; y < writing->height && result == EXR_ERR_SUCCESS && *status == HL_OK; y += lines) {
    *status = hl_encode_step(writing->output->context, y, writing->height, error);
    if (*status == HL_OK) result = write_chunk(writing, file, &pipeline, y);
  }
  exr_encoding_destroy(file, &pipeline);
  return result;
}

hl_status hl_exr_encode_channels(int width, int height, const hl_exr_channel *channels, size_t channel_count,
                                 hl_output *output, hl_error *error) {
  exr_writing writing = {.width = width,
                         .height = height,
                         .channels = channels,
                         .channel_count = channel_count,
                         .output = output};
  exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
  options.error_handler_fn = on_write_error;
  options.user_data = &writing;
  options.write_fn = on_write;
  exr_context_t file = NULL;
  hl_status status = HL_OK;
  exr_result_t result = exr_start_write(&file, output->path, EXR_WRITE_FILE_DIRECTLY, &options);
  if (result == EXR_ERR_SUCCESS) result = write_header(&writing, file);
  if (result == EXR_ERR_SUCCESS) result = write_chunks(&writing, file, &status, error);
  if (file != NULL) {
    exr_result_t finished = exr_finish(&file);
    if (result == EXR_ERR_SUCCESS) result = finished;
  }
  if (status != HL_OK) return status;
  if (writing.write_failed) return hl_fail_write(error, output, writing.system_error);
  if (result == EXR_ERR_OUT_OF_MEMORY)
    return hl_fail_memory(error, (size_t)width * 64 * channel_count, output->path);
  if (result != EXR_ERR_SUCCESS)
    return hl_fail(error, HL_ERROR_INTERNAL, "%s: cannot write: OpenEXR says: %s", output->path,
                   writing.message[0] != 0 ? writing.message : exr_get_default_error_message(result));
  return HL_OK;
}

typedef struct layer_channel_name {
  char text[HL_IMAGE_LAYER_NAME + 3];
} layer_channel_name; /* the name of a layer's channel in a file: "layer.C" */

/* Lists R, G, B, A and the layers' channels. names: memory for the names of the layers' channels. */
static void list_channels(const hl_image *image, layer_channel_name *names, hl_exr_channel *channels) {
  static const char *const own[4] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; c++) *channels++ = (hl_exr_channel){own[c], image->pixels + c, 4};
  for (size_t i = 0; i < image->layer_count; i++) {
    const hl_image_layer *layer = &image->layers[i];
    size_t count = strlen(layer->channels);
    for (size_t c = 0; c < count; c++, names++) {
      snprintf(names->text, sizeof names->text, "%s.%c", layer->name, layer->channels[c]);
      *channels++ = (hl_exr_channel){names->text, layer->values + c, count};
    }
  }
}

static hl_status encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  (void)options; /* depth and background have no effect on OpenEXR files */
  size_t count = 4;
  for (size_t i = 0; i < image->layer_count; i++) count += strlen(image->layers[i].channels);
  layer_channel_name *names = hl_allocate(output->context, count, sizeof *names);
  hl_exr_channel *channels = hl_allocate(output->context, count, sizeof *channels);
  hl_status status = HL_OK;
  if (names == NULL || channels == NULL)
    status = hl_fail_memory(error, count * sizeof *channels, output->path);
  else list_channels(image, names, channels);
  if (status == HL_OK)
    status = hl_exr_encode_channels(image->width, image->height, channels, count, output, error);
  hl_release(output->context, names);
  hl_release(output->context, channels);
  return status;
}

const hl_image_format hl_exr_format = {
    .extension = ".exr",
    .title = "OpenEXR",
    .mark = {0x76, 0x2f, 0x31, 0x01},
    .mark_length = 4,
    .encode = encode,
    .decode = decode,
    .claim = claim,
    .holds_layers = true,
};
