/* volume/save.c - writes a volume to a file: NRRD with gzip, or bare voxels whose file name states size and
 * type.
 *
 * Data values are kept: integers of 8 and 16 bits without a scale are written unchanged, everything else as
 * float. The file appears complete or not at all, and the same volume gives the same bytes. */
#define _GNU_SOURCE
#include <string.h>
#include <strings.h>
#include <zlib.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/raw.h"
#include "volume/volume.h"

enum { PIECE = 1 << 16, OUT_BYTES = 1 << 18, GZIP_WINDOW = 15 + 16 /* zlib.h: largest window, gzip */ };

/* How the voxels are written. */
typedef struct saving {
  const hl_volume *volume;
  hl_volume_description grid; /* type is the file's */
  hl_output output;
  bool compress;
  unsigned char *piece;  /* owned; PIECE voxels in the file's type, native byte order */
  unsigned char *stored; /* owned; PIECE stored voxels of a volume whose rows do not adjoin, else null */
  unsigned char *packed; /* owned; [OUT_BYTES] */
  z_stream stream;
} saving;

/* The file's voxel type: the stored type where stored values equal data values, else float. */
static hl_voxel_type file_type(const hl_volume *volume) {
  double bias = hl_voxel_type_bias(volume->type);
  bool whole = volume->value_scale == 1 && volume->value_offset == -bias;
  switch (volume->type) {
    case HL_VOXEL_U8:
    case HL_VOXEL_I8:
    case HL_VOXEL_U16:
    case HL_VOXEL_I16: return whole ? volume->type : HL_VOXEL_F32;
    default: return HL_VOXEL_F32;
  }
}

static void describe(const hl_volume *volume, hl_volume_description *grid) {
  hl_volume_description_defaults(grid);
  memcpy(grid->dimensions, volume->dimension, sizeof grid->dimensions);
  grid->type = file_type(volume);
  for (int axis = 0; axis < 3; axis++) {
    vec3 step = mat3_column(volume->index_to_world.linear, axis);
    grid->axis[axis][0] = step.x, grid->axis[axis][1] = step.y, grid->axis[axis][2] = step.z;
  }
  grid->origin[0] = volume->index_to_world.offset.x;
  grid->origin[1] = volume->index_to_world.offset.y;
  grid->origin[2] = volume->index_to_world.offset.z;
}

static void convert_integers(const hl_volume *volume, const void *voxels, size_t count,
                             unsigned char *piece) {
  size_t bytes = hl_storage_bytes(volume->storage);
  const unsigned char *from = voxels;
  unsigned flip = (unsigned)hl_voxel_type_bias(volume->type); /* the sign bit of signed types */
  for (size_t n = 0; n < count; n++) {
    uint16_t wide = from[n];
    if (bytes == 2) memcpy(&wide, from + 2 * n, 2);
    wide = (uint16_t)(wide ^ flip);
    if (bytes == 2) memcpy(piece + 2 * n, &wide, 2);
    else piece[n] = (unsigned char)wide;
  }
}

static void convert_values(const hl_volume *volume, const void *voxels, size_t count, unsigned char *piece) {
  for (size_t n = 0; n < count; n++) {
    double stored = 0;
    switch (volume->storage) {
      case HL_STORAGE_U8: stored = ((const uint8_t *)voxels)[n]; break;
      case HL_STORAGE_U16: stored = ((const uint16_t *)voxels)[n]; break;
      case HL_STORAGE_F32: stored = (double)((const float *)voxels)[n]; break;
    }
    float value = (float)(volume->value_scale * stored + volume->value_offset);
    memcpy(piece + 4 * n, &value, 4);
  }
}

static void write_header(saving *s) {
  const hl_volume_description *grid = &s->grid;
  const uint16_t one = 1;
  bool little = *(const unsigned char *)&one == 1;
  fprintf(s->output.file, "NRRD0004\ntype: %s\ndimension: 3\nspace dimension: 3\nsizes: %zu %zu %zu\n",
          grid->type == HL_VOXEL_F32 ? "float" : hl_voxel_type_name(grid->type), grid->dimensions[0],
          grid->dimensions[1], grid->dimensions[2]);
  fprintf(s->output.file, "space directions:");
  for (int axis = 0; axis < 3; axis++)
    fprintf(s->output.file, " (%.17g,%.17g,%.17g)", grid->axis[axis][0], grid->axis[axis][1],
            grid->axis[axis][2]);
  fprintf(s->output.file, "\nspace origin: (%.17g,%.17g,%.17g)\n", grid->origin[0], grid->origin[1],
          grid->origin[2]);
  if (hl_voxel_type_bytes(grid->type) > 1) fprintf(s->output.file, "endian: %s\n", little ? "little" : "big");
  fprintf(s->output.file, "encoding: gzip\n\n");
}

/* Short writes are found by hl_output_commit(). */
static void put(saving *s, size_t bytes, bool last) {
  if (!s->compress) {
    fwrite(s->piece, 1, bytes, s->output.file);
    return;
  }
  s->stream.next_in = s->piece;
  s->stream.avail_in = (uInt)bytes;
  do {
    s->stream.next_out = s->packed;
    s->stream.avail_out = OUT_BYTES;
    deflate(&s->stream, last ? Z_FINISH : Z_NO_FLUSH);
    fwrite(s->packed, 1, OUT_BYTES - s->stream.avail_out, s->output.file);
  } while (s->stream.avail_out == 0);
}

static hl_status write_voxels(saving *s, hl_error *error) {
  const hl_volume *volume = s->volume;
  size_t total = hl_volume_voxel_count(volume);
  for (size_t first = 0; first < total; first += PIECE) {
    size_t count = total - first < PIECE ? total - first : PIECE;
    const void *voxels = hl_volume_piece(volume, first, count, s->stored);
    if (s->grid.type == HL_VOXEL_F32) convert_values(volume, voxels, count, s->piece);
    else convert_integers(volume, voxels, count, s->piece);
    put(s, count * hl_voxel_type_bytes(s->grid.type), first + count == total);
    hl_progress(volume->context, "write", (double)(first + count) / (double)total);
    if (hl_cancelled(volume->context))
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", s->output.path);
  }
  return HL_OK;
}

/* Only the file's name states the size and type of bare voxels. */
static hl_status check_raw_name(const saving *s, const char *path, hl_error *error) {
  hl_payload payload;
  const size_t *n = s->grid.dimensions;
  bool named = hl_raw_name(path, &payload);
  if (named && payload.grid.type == s->grid.type && !payload.big_endian &&
      memcmp(payload.grid.dimensions, n, sizeof payload.grid.dimensions) == 0)
    return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "%s: bare voxels are read by their name: put _%zux%zux%zu_%s before .raw, or write .nrrd",
                 path, n[0], n[1], n[2], hl_voxel_type_name(s->grid.type));
}

static bool ends_in(const char *path, const char *extension) {
  size_t length = strlen(path), tail = strlen(extension);
  return length > tail && strcasecmp(path + length - tail, extension) == 0;
}

static hl_status save(hl_context *context, saving *s, const char *path, bool nrrd, hl_error *error) {
  size_t piece_bytes = PIECE * hl_voxel_type_bytes(s->grid.type);
  s->piece = hl_allocate(context, piece_bytes, 1);
  s->packed = hl_allocate(context, OUT_BYTES, 1);
  if (!hl_volume_is_packed(s->volume))
    s->stored = hl_allocate(context, PIECE, hl_storage_bytes(s->volume->storage));
  if (s->piece == NULL || s->packed == NULL || (s->stored == NULL && !hl_volume_is_packed(s->volume)))
    return hl_fail_memory(error, piece_bytes + OUT_BYTES, path);
  if (s->compress &&
      deflateInit2(&s->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, GZIP_WINDOW, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    return hl_fail_memory(error, 300000, "compression");
  hl_status status = hl_output_begin(context, path, &s->output, error);
  if (status == HL_OK) {
    if (nrrd) write_header(s);
    status = write_voxels(s, error);
    if (status == HL_OK) status = hl_output_commit(&s->output, error);
    else hl_output_abort(&s->output);
  }
  if (s->compress) deflateEnd(&s->stream);
  return status;
}

hl_status hl_volume_save(hl_context *context, const hl_volume *volume, const char *path, hl_error *error) {
  if (context == NULL || volume == NULL || path == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_save: null context, volume or path");
  bool nrrd = ends_in(path, ".nrrd"), packed = ends_in(path, ".raw.gz"),
       raw = packed || ends_in(path, ".raw");
  if (!nrrd && !raw)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: volumes are written as .nrrd, .raw or .raw.gz: end the name so", path);
  saving s = {.volume = volume, .compress = nrrd || packed};
  describe(volume, &s.grid);
  hl_status status = raw ? check_raw_name(&s, path, error) : HL_OK;
  if (status == HL_OK) status = save(context, &s, path, nrrd, error);
  hl_release(context, s.piece);
  hl_release(context, s.stored);
  hl_release(context, s.packed);
  return status;
}
