/* exr_write.c - pictures as OpenEXR through OpenEXRCore: scanlines, ZIP, 32-bit float, linear.
 *
 * In: named float channels (exr.h), or a picture with its layers. Out: bytes in output->file; values are
 * stored bit by bit. OpenEXRCore writes through on_write, so that a full disk is noticed here and the file is
 * the caller's temporary one.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <openexr.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "image/exr.h"
#include "image/format.h"
#include "image/image.h"

typedef struct exr_writing {
  int width, height;
  const hl_exr_channel *channels; /* borrowed; [channel_count] */
  size_t channel_count;
  hl_output *output;
  uint64_t at;      /* where the file stands */
  int system_error; /* errno of the first failed write */
  bool write_failed;
  char message[200]; /* OpenEXRCore's first complaint */
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

static void on_error(exr_const_context_t file, exr_result_t code, const char *message) {
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

/* Points the pipeline's channels (which are sorted by name) at row y of ours. */
static void place_channels(const exr_writing *writing, exr_encode_pipeline_t *pipeline, int y) {
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

/* One chunk of lines from row y on; the pipeline keeps its buffers between chunks. */
static exr_result_t write_chunk(const exr_writing *writing, exr_context_t file,
                                exr_encode_pipeline_t *pipeline, int y) {
  exr_chunk_info_t chunk;
  exr_result_t result = exr_write_scanline_chunk_info(file, 0, y, &chunk);
  if (result != EXR_ERR_SUCCESS) return result;
  result = y == 0 ? exr_encoding_initialize(file, 0, &chunk, pipeline)
                  : exr_encoding_update(file, 0, &chunk, pipeline);
  if (result != EXR_ERR_SUCCESS) return result;
  place_channels(writing, pipeline, y);
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
  options.error_handler_fn = on_error;
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
} layer_channel_name; /* "layer.C" */

/* R, G, B, A, and the layers' channels. names: room for all of the latter. */
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

hl_status hl_exr_encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  (void)options; /* depth and background are PNG's */
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
