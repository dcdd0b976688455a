/* volume/formats/nrrd.c - reads NRRD files, versions 1 to 5, attached and detached: chooses the grid's axes,
 * and reads the voxels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/formats/nrrd_header.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

/* ---- which axes belong to the grid, which hold components, and where the grid lies ---- */

/* Returns whether the samples along an axis are components instead of voxels. */
static bool is_component_axis(const nrrd_header *header, const nrrd_axis *axis) {
  if (header->space.has_directions) return !axis->has_direction;
  int space = 0;
  for (int n = 0; n < header->dimension; n++)
    space += hl_text_is_one_of(header->axis[n].kind, "domain|space");
  if (hl_text_equal(axis->kind, "time")) return space >= 3;
  return axis->kind[0] != 0 && !hl_text_is_one_of(axis->kind, "domain|space|none|???");
}

/* Returns whether the samples along the first axis are assumed to be components, although the file does not
 * say so. The first axis is assumed to hold components if it has at most four samples, the file states
 * neither directions nor kinds of axes, and at least four axes have several samples. */
static bool is_first_of_components(const nrrd_header *header) {
  bool unsaid = header->axis[0].size <= 4 && !header->space.has_directions;
  int thick = 0;
  for (int n = 0; n < header->dimension; n++) {
    unsaid = unsaid && header->axis[n].kind[0] == 0;
    thick += header->axis[n].size > 1;
  }
  return unsaid && thick > 3;
}

/* Reduces the axes of voxels to at most three. Axes of one sample are dropped first, beginning with the last
 * such axis. If more than three axes are left, all axes after the third are dropped, and become a series. */
static int drop_thin_axes(int axes[NRRD_MOST_AXES], const nrrd_header *header, int count) {
  for (int n = count - 1; n >= 0 && count > 3; n--)
    if (header->axis[axes[n]].size == 1) {
      memmove(&axes[n], &axes[n + 1], (size_t)(count - 1 - n) * sizeof *axes);
      count--;
    }
  return count > 3 ? 3 : count;
}

/* Chooses the axes of the grid, fastest first. */
static int choose_axes(const nrrd_header *header, int chosen[NRRD_MOST_AXES]) {
  int count = 0;
  for (int n = 0; n < header->dimension; n++)
    if (!is_component_axis(header, &header->axis[n]) && !(n == 0 && is_first_of_components(header)))
      chosen[count++] = n;
  return drop_thin_axes(chosen, header, count);
}

/* Finds the components, which are the samples along all axes that do not belong to the grid. The axes of
 * components must be neighbours. Axes of the grid may come before and after the axes of components. */
static hl_status find_components(const nrrd_header *header, const int chosen[NRRD_MOST_AXES], int count,
                                 bool *is_series, hl_payload *payload, hl_error *error) {
  size_t before = 1, since = 1; /* before: the product of the sizes of the grid's axes before the axes of
                                 * components; since: the product of the sizes of the grid's axes after
                                 * them */
  int grid_axis = 0;
  *is_series = false;
  for (int n = 0; n < header->dimension; n++) {
    const nrrd_axis *axis = &header->axis[n];
    if (grid_axis < count && chosen[grid_axis] == n) {
      size_t *product = payload->components == 1 ? &before : &since;
      if (!hl_multiply(*product, axis->size, product)) *product = SIZE_MAX;
      grid_axis++;
      continue;
    }
    if (axis->size == 0)
      return hl_fail(error, HL_ERROR_INPUT, "%s: axis %d has 0 samples", header->stream->path, n + 1);
    if (axis->size == 1) continue;
    if (payload->components > 1 && since > 1)
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: components along axes that do not follow each other: take one out with unu slice",
                     header->stream->path);
    if (!hl_multiply(payload->components, axis->size, &payload->components)) payload->components = SIZE_MAX;
    bool colors = hl_text_is_one_of(axis->kind, "RGB-color|RGBA-color|3-color|4-color");
    if (colors) payload->colors = HL_COLORS_MEANT;
    *is_series = *is_series || hl_text_is_one_of(axis->kind, "list|time|domain|space") ||
                 (grid_axis >= 3 && !colors);
  }
  payload->block = before;
  return HL_OK;
}

/* Finds the step along an axis and the position of its first sample, for files without directions. The rules
 * for spacing, axis mins, axis maxs and centering are Teem's. */
static void place_axis(const nrrd_axis *axis, double *spacing, double *first) {
  double width = axis->maximum - axis->minimum;
  double intervals = axis->is_node ? (double)axis->size - 1 : (double)axis->size;
  *spacing = isfinite(axis->spacing)            ? axis->spacing
             : isfinite(width) && intervals > 0 ? width / intervals
                                                : 1;
  *first = isfinite(axis->minimum) ? axis->minimum + (axis->is_node ? 0 : *spacing / 2) : 0;
}

/* Gives a unit step to each of the grid's axes that the file does not have, perpendicular to the other
 * axes. */
static void complete_axes(hl_volume_description *grid, int count) {
  if (count == 1) {
    vec3 across = vec3_perpendicular(vec3_normalise(vec3_of(grid->axis[0])));
    memcpy(grid->axis[1], &across, sizeof across);
  }
  if (count < 3) {
    vec3 across = vec3_normalise(vec3_cross(vec3_of(grid->axis[0]), vec3_of(grid->axis[1])));
    memcpy(grid->axis[2], &across, sizeof across);
  }
}

static void make_grid(const nrrd_header *header, const int chosen[NRRD_MOST_AXES], int count,
                      hl_volume_description *grid) {
  for (int n = 0; n < count; n++) {
    const nrrd_axis *axis = &header->axis[chosen[n]];
    grid->dimensions[n] = axis->size;
    if (header->space.has_directions) memcpy(grid->axis[n], axis->direction, sizeof grid->axis[n]);
    else place_axis(axis, &grid->axis[n][n], &grid->origin[n]);
  }
  if (header->space.has_directions) complete_axes(grid, count);
  if (header->space.has_origin) memcpy(grid->origin, header->space.origin, sizeof grid->origin);
  grid->type = header->type;
  grid->space = header->space.kind;
}

/* Fills the payload's grid, components and block. *is_series: set to whether components are the volumes of a
 * series. */
static hl_status place_grid(const nrrd_header *header, hl_payload *payload, bool *is_series,
                            hl_error *error) {
  int chosen[NRRD_MOST_AXES], count = choose_axes(header, chosen);
  make_grid(header, chosen, count, &payload->grid);
  hl_status status = hl_volume_check_grid(&payload->grid, header->stream->path, error);
  return status == HL_OK ? find_components(header, chosen, count, is_series, payload, error) : status;
}

/* ---- the voxels ---- */

/* Moves the stream to the last `bytes` bytes of packed data. The function unpacks all data once to find the
 * position of these bytes, and then unpacks the data a second time up to this position. */
static hl_status skip_to_last_unpacked(hl_stream **stream, const nrrd_header *header, uint64_t bytes,
                                       hl_error *error) {
  unsigned char piece[8192];
  uint64_t total = 0, begin = (*stream)->below->offset;
  size_t got = sizeof piece;
  if (!hl_stream_can_restart(*stream))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: byte skip -1 with packed voxels in a pipe: give it as a file", (*stream)->path);
  hl_status status = HL_OK;
  for (; status == HL_OK && got == sizeof piece; total += got) {
    status = hl_stream_read(*stream, piece, sizeof piece, &got, error);
    if (status == HL_OK && hl_cancelled((*stream)->context))
      status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", (*stream)->path);
  }
  bool nested = (*stream)->below->below != NULL; /* whether the whole file is packed as well as its data */
  if (status == HL_OK) status = hl_stream_restart(stream, error);
  if (status == HL_OK && nested) status = hl_stream_unpack(stream, error);
  if (status == HL_OK) status = hl_stream_skip(*stream, begin, error);
  if (status == HL_OK)
    status = header->encoding == NRRD_GZIP ? hl_stream_push_inflate(stream, error)
                                           : hl_stream_push_bzip2(stream, error);
  return status == HL_OK ? hl_stream_skip(*stream, total > bytes ? total - bytes : 0, error) : status;
}

static hl_status skip_to_voxels(hl_stream **stream, const nrrd_header *header, const hl_payload *payload,
                                hl_error *error) {
  char line[HL_LINE_BYTES];
  hl_status status = HL_OK;
  bool ended = false;
  for (size_t n = 0; status == HL_OK && n < header->data.line_skip && !ended; n++)
    status = hl_stream_line(*stream, line, &ended, error);
  if (status != HL_OK) return status;
  if (header->encoding == NRRD_GZIP) status = hl_stream_push_inflate(stream, error);
  if (header->encoding == NRRD_HEX) status = hl_stream_push_hex(stream, error);
  if (header->encoding == NRRD_BZIP2) status = hl_stream_push_bzip2(stream, error);
  uint64_t skip = header->data.byte_skip, most = hl_stream_at_most(*stream),
           bytes = hl_payload_bytes(payload);
  if (status != HL_OK) return status;
  if (header->data.skip_to_last) {
    bool packed = header->encoding == NRRD_GZIP || header->encoding == NRRD_BZIP2;
    if (!packed && (header->encoding != NRRD_RAW || most == UINT64_MAX))
      return hl_fail(error, HL_ERROR_INPUT, "%s: byte skip -1 needs binary voxels in an ordinary file",
                     (*stream)->path);
    if (packed) return skip_to_last_unpacked(stream, header, bytes, error);
    skip = most > bytes ? most - bytes : 0;
  }
  return status == HL_OK ? hl_stream_skip(*stream, skip, error) : status;
}

/* Opens several data files as one stream, in which they follow each other. */
static hl_status open_files(hl_stream **stream, nrrd_header *header, const hl_payload *payload,
                            hl_error *error) {
  hl_file_list *files = &header->data.files;
  if (header->encoding == NRRD_TEXT || header->encoding == NRRD_HEX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: text in several data files: join them with unu join",
                   (*stream)->path);
  files->line_skip = header->data.line_skip;
  files->byte_skip = header->data.byte_skip;
  files->skip_to_last = header->data.skip_to_last;
  files->packing = header->encoding == NRRD_GZIP    ? HL_FILE_ZLIB
                   : header->encoding == NRRD_BZIP2 ? HL_FILE_BZIP2
                                                    : HL_FILE_RAW;
  return hl_stream_push_files(stream, files, hl_payload_bytes(payload), error);
}

static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= 4 && memcmp(bytes, "NRRD", 4) == 0;
}

static hl_status load_with(nrrd_header *read, hl_stream **stream, hl_load_request *request,
                           hl_volume **volume, hl_error *error) {
  hl_payload payload;
  hl_payload_defaults(&payload);
  hl_status status = hl_nrrd_read_header(*stream, read, error);
  if (status != HL_OK) return status;
  const nrrd_header header = *read;
  bool is_series = false;
  status = place_grid(&header, &payload, &is_series, error);
  /* in a segmentation, the components are not times but layers of segments; one layer becomes the volume */
  if (is_series && header.segment_count > 0) {
    is_series = false;
    if (request->component == HL_COMPONENT_DEFAULT) request->component = 0;
  }
  if (status == HL_OK) status = hl_component_only(request, (*stream)->path, is_series, &payload, error);
  if (status != HL_OK) return status;
  request->unit = header.space.unit;
  payload.big_endian = header.big_endian;
  payload.text = header.encoding == NRRD_TEXT;
  if (!header.has_endian && !payload.text && hl_voxel_type_bytes(header.type) > 1)
    hl_log((*stream)->context, HL_LOG_WARNING, "%s: no field \"endian\": little-endian is assumed",
           (*stream)->path);
  if (read->data.files.count > 0) {
    status = open_files(stream, read, &payload, error);
    return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
  }
  if (header.data.file[0] != 0) status = hl_stream_switch(stream, header.data.file, error);
  if (status == HL_OK) status = skip_to_voxels(stream, &header, &payload, error);
  return status == HL_OK ? hl_payload_read(*stream, &payload, request->spacing, volume, error) : status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_context *context = (*stream)->context;
  nrrd_header header = {.dimension = 0, .data.files.context = context};
  hl_status status = load_with(&header, stream, request, volume, error);
  if (status == HL_OK) {
    (*volume)->segments = header.segments;
    (*volume)->segment_count = header.segment_count;
  } else {
    hl_release(context, header.segments);
  }
  hl_file_list_release(&header.data.files);
  return status;
}

const hl_format hl_format_nrrd = {
    .name = "NRRD",
    .endings = {".nrrd", ".nhdr"},
    .beginning = "\"NRRD000\"",
    .has_content = has_content,
    .load = load,
};
