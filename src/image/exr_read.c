/* exr_read.c - OpenEXR scanline files to linear premultiplied floats, through OpenEXRCore.
 *
 * In: the bytes of a file, which may be anything. Out: a picture of the first part's data window: channels R,
 * G, B (or Y for grey) and A (1 where missing), from half, float or integer samples.
 *
 * Against hostile files: OpenEXRCore reads through on_read, bounded by the file's bytes; kinds of file and of
 * compression that are not needed are refused; sizes are limited before allocation and held against the most
 * that the file's bytes can hold.
 */
#include <inttypes.h>
#include <openexr.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/format.h"

/* The most that any accepted compression expands one byte to; deflate's 1032 is the greatest. */
enum { EXPANSION_MAX = 1032 };
static const uint64_t chunk_bytes_max = (uint64_t)1 << 28;

typedef struct exr_reading {
  hl_context *context;
  const char *name;
  const unsigned char *bytes; /* borrowed; [length] */
  size_t length;
  hl_error *error;
  exr_context_t file;
  unsigned present;        /* bit i: the file has the channel of that channel_index */
  uint64_t pixel_bytes;    /* of all channels */
  exr_attr_box2i_t window; /* the data window */
  hl_image *image;
  char message[200]; /* OpenEXRCore's first complaint */
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

static void on_error(exr_const_context_t file, exr_result_t code, const char *message) {
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

/* 0..3 for R, G, B, A; CHANNEL_Y for Y; -1 for any other. */
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

/* Makes the picture, if its claimed size can be true. */
static hl_status make_image(exr_reading *reading) {
  exr_result_t result = exr_get_data_window(reading->file, 0, &reading->window);
  uint64_t chunk_bytes = 0;
  if (result == EXR_ERR_SUCCESS) result = exr_get_chunk_unpacked_size(reading->file, 0, &chunk_bytes);
  if (result != EXR_ERR_SUCCESS) return fail_exr(reading, result);
  int64_t width = (int64_t)reading->window.max.x - reading->window.min.x + 1;
  int64_t height = (int64_t)reading->window.max.y - reading->window.min.y + 1;
  if (width < 1 || height < 1) width = height = 0; /* refused below */
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

/* Points the channels that the picture wants at row y of it. */
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

/* Grey to all three colours, and alpha 1 where the file has none. */
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
  options.error_handler_fn = on_error;
  options.user_data = reading;
  options.read_fn = on_read;
  options.size_fn = on_size;
  options.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  return exr_start_read(&reading->file, reading->name, &options);
}

/* Width, height and bytes without compression of one part; 0 bytes where its header does not tell. */
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
  if (claim.width <= HL_IMAGE_SIDE_MAX && claim.height <= HL_IMAGE_SIDE_MAX)
    claim.bytes = claim.width * claim.height * 4 *
                  (uint64_t)(list->num_channels > 0 ? list->num_channels : 0);
  return claim;
}

/* The size of the first part, and the bytes of all. */
hl_image_claim hl_exr_claim(const unsigned char *bytes, size_t length) {
  exr_reading reading = {.name = "a picture", .bytes = bytes, .length = length};
  hl_image_claim claim = {0};
  int parts = 0;
  if (start_read(&reading) == EXR_ERR_SUCCESS && exr_get_count(reading.file, &parts) == EXR_ERR_SUCCESS &&
      parts > 0) {
    claim = claim_of_part(reading.file, 0);
    claim.known = claim.width > 0;
    for (int part = 1; part < parts; part++) claim.bytes += claim_of_part(reading.file, part).bytes;
  }
  if (reading.file != NULL) exr_finish(&reading.file);
  return claim;
}

hl_status hl_exr_decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
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
