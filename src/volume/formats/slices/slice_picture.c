/* volume/formats/slices/slice_picture.c - reads a picture file as a slice of voxels: finds the file's kind,
 * and takes one of its components. */
#include "volume/formats/slices/slice_picture.h"

#include <math.h>
#include <string.h>

#include "core/error.h"
#include "core/memory.h"
#include "volume/colors.h"
#include "volume/convert.h"
#include "volume/io/text.h"

typedef enum picture_kind { KIND_PNG, KIND_JPEG, KIND_TIFF, KIND_RAW, KIND_OTHER } picture_kind;

bool hl_slice_is_named(const char *name) {
  static const char *const endings[] = {".tif", ".tiff", ".png", ".jpg", ".jpeg"};
  for (size_t n = 0; n < sizeof endings / sizeof *endings; n++)
    if (hl_text_ends(name, endings[n])) return true;
  return hl_slice_is_raw(name);
}

static picture_kind kind_of(const hl_slice_file *file) {
  const unsigned char *bytes = file->bytes;
  if (hl_slice_is_raw(file->path)) return KIND_RAW;
  if (file->length < 8) return KIND_OTHER;
  if (memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0) return KIND_PNG;
  if (bytes[0] == 0xff && bytes[1] == 0xd8) return KIND_JPEG;
  if (memcmp(bytes, "II", 2) == 0 || memcmp(bytes, "MM", 2) == 0) return KIND_TIFF;
  return KIND_OTHER;
}

static hl_status fail_unknown(const hl_slice_file *file, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: neither a TIFF, PNG nor JPEG picture", file->path);
}

/* Reads a PNG or JPEG file. If samples is null, reads only the shape of the picture. */
static hl_status read(const hl_slice_file *file, hl_slice_shape *shape, unsigned char **samples,
                      hl_error *error) {
  hl_status status;
  switch (kind_of(file)) {
    case KIND_PNG: status = hl_slice_read_png(file, shape, samples, error); break;
    case KIND_JPEG: status = hl_slice_read_jpeg(file, shape, samples, error); break;
    default: return fail_unknown(file, error);
  }
  shape->colors = status == HL_OK && hl_can_be_colors(shape->type, shape->samples);
  return status;
}

hl_status hl_slice_measure(const hl_slice_file *file, hl_slice_shape *shape, hl_error *error) {
  if (kind_of(file) == KIND_TIFF) return hl_slice_read_tiff(file, shape, 0, NULL, error);
  if (kind_of(file) == KIND_RAW) return hl_slice_read_raw(file, shape, NULL, error);
  return read(file, shape, NULL, error);
}

static double sample_at(const hl_slice_shape *shape, const unsigned char *samples, size_t index) {
  uint16_t wide;
  if (shape->type == HL_VOXEL_U8) return samples[index];
  memcpy(&wide, samples + 2 * index, sizeof wide);
  return wide;
}

/* Stores one component of a picture, the magnitude of its components, or its colours, as `component` says.
 * voxels: memory for the result. If `component` is an index, the result is stored values of the shape's
 * unsigned type; otherwise it is floats (magnitude) or colours. */
static void take_component(const hl_slice_shape *shape, const unsigned char *samples, int component,
                           void *voxels) {
  size_t count = shape->width * shape->height, step = shape->samples,
         bytes = hl_voxel_type_bytes(shape->type);
  if (hl_component_is_colors(component)) {
    for (size_t c = 0; c < step; c++)
      hl_colors_store(shape->type, samples + c * bytes, step, count, c, voxels);
    return;
  }
  if (component != HL_COMPONENT_MAGNITUDE) {
    for (size_t n = 0; n < count; n++)
      memcpy((unsigned char *)voxels + n * bytes, samples + (n * step + (size_t)component) * bytes, bytes);
    return;
  }
  for (size_t n = 0; n < count; n++) {
    double sum = 0;
    for (size_t s = 0; s < step; s++) {
      double sample = sample_at(shape, samples, n * step + s);
      sum += sample * sample;
    }
    ((float *)voxels)[n] = (float)sqrt(sum);
  }
}

static bool same_shape(const hl_slice_shape *a, const hl_slice_shape *b) {
  return a->width == b->width && a->height == b->height && a->samples == b->samples && a->type == b->type;
}

hl_status hl_slice_decode(const hl_slice_file *file, const hl_slice_shape *shape, int component, void *voxels,
                          hl_error *error) {
  hl_slice_shape found;
  unsigned char *samples = NULL;
  hl_status status = hl_slice_measure(file, &found, error);
  if (status == HL_OK && !same_shape(&found, shape))
    status = hl_fail(
        error, HL_ERROR_INPUT,
        "%s: a slice of %zu x %zu pixels of %zu %s, where others have %zu x %zu of %zu %s: take it "
        "out of the folder",
        file->path, found.width, found.height, found.samples, hl_voxel_type_name(found.type), shape->width,
        shape->height, shape->samples, hl_voxel_type_name(shape->type));
  if (status != HL_OK) return status;
  if (kind_of(file) == KIND_TIFF) return hl_slice_read_tiff(file, &found, component, voxels, error);
  if (kind_of(file) == KIND_RAW) return hl_slice_read_raw(file, &found, voxels, error);
  status = read(file, &found, &samples, error);
  if (status == HL_OK) take_component(shape, samples, component, voxels);
  hl_release(file->context, samples);
  return status;
}
