/* volume/save.c - writes a volume, or a box of it, to a file. Rows of data values are converted to a type,
 * packed, and written in a format (writer.h).
 *
 * After a failure no incomplete file is left. The bytes of the file depend only on the volume and the
 * options. Only one row of voxels is in memory at a time. */
#define _GNU_SOURCE
#include <errno.h>
#include <math.h>
#include <string.h>
#include <zlib.h>

#include "core/context.h"
#include "core/door.h"
#include "core/file.h"
#include "core/memory.h"
#include "text/units.h"
#include "volume/convert.h"
#include "volume/formats/raw.h"
#include "volume/io/writer.h"
#include "volume/volume.h"

/* ZLIB_WINDOW is zlib's largest window; GZIP is added to ZLIB_WINDOW to write gzip (zlib.h). */
enum { OUT_BYTES = 1 << 18, ZLIB_WINDOW = 15, GZIP = 16 };
enum {
  MOST_SHRUNK_LABELS = 64
}; /* greatest `shrink` of label maps. The labels of all voxels that are merged in one voxel are in memory, up
    * to two megabytes for each voxel of a row */

/* The state of writing voxels. */
typedef struct saving {
  hl_context *context;
  const hl_volume *volume;
  const hl_writer *writer;
  size_t begin[3], end[3], shrink; /* the box in voxels; each written voxel is made of shrink^3 voxels */
  bool labels;                /* whether a merged voxel gets the most frequent of its values, instead of their
                               * mean */
  hl_volume_description grid; /* the grid that is written */
  const char *unit;           /* unit of the grid's lengths, static; null if unknown */
  bool unit_asked;            /* whether the unit comes from the options */
  hl_output output;
  bool packs; /* whether the bytes that are written next are packed */
  struct {
    double *sums;          /* [grid.dimensions[0]]; sums of the data values that are merged */
    uint32_t *counts;      /* [grid.dimensions[0]]; number of finite voxels in each sum */
    uint64_t *boxes;       /* [grid.dimensions[0]][shrink^3]; for label maps that are shrunk: the bits of the
                            * finite values, or of the file's own numbers (keeps_numbers()); else null */
    unsigned char *row;    /* [grid.dimensions[0]] voxels of the written type */
    void *source_row;      /* a row of the volume's stored values, for volumes with pages */
    unsigned char *packed; /* [OUT_BYTES] */
  } memory;                /* all arrays are owned */
  uint64_t clamped, holes; /* number of voxels clamped to the type's range; number of voxels that were not
                            * finite and became 0 */
  z_stream stream;
} saving;

/* ---- the type ---- */

/* The range of whole numbers that a type holds. Returns false for floats. */
static bool whole_range(hl_voxel_type type, double *low, double *high) {
  bool is_signed = type == HL_VOXEL_I8 || type == HL_VOXEL_I16 || type == HL_VOXEL_I32 ||
                   type == HL_VOXEL_I64;
  if (type == HL_VOXEL_F16 || type == HL_VOXEL_F32 || type == HL_VOXEL_F64) return false;
  double span = ldexp(1, 8 * (int)hl_voxel_type_bytes(type));
  *low = is_signed ? -span / 2 : 0;
  *high = *low + span - 1;
  /* For types of 64 bits, *high is the greatest double in the type's range. */
  if (*high == *low + span) *high = nextafter(*high, 0);
  return true;
}

static bool holds(hl_voxel_type type, double least, double greatest) {
  double low, high;
  return whole_range(type, &low, &high) && least >= low && greatest <= high;
}

/* Returns whether all data values are finite whole numbers, because the file's numbers are integers, and
 * scale and offset are whole numbers. */
static bool is_whole(const hl_volume *volume) {
  double low, high;
  return whole_range(volume->type, &low, &high) && volume->value_scale == floor(volume->value_scale) &&
         volume->value_offset == floor(volume->value_offset);
}

/* Chooses the type to write: the first type that the format can hold and that holds all data values. The
 * candidates are the volume's own type, larger integers, floats, and doubles if floats round the values. */
static hl_voxel_type choose_type(const hl_volume *volume, const hl_writer *writer) {
  const hl_voxel_type candidates[] = {volume->type, HL_VOXEL_I16, HL_VOXEL_U16, HL_VOXEL_I32, HL_VOXEL_U32};
  if (hl_volume_is_exact(volume) && volume->value_scale == 1 && volume->value_offset == 0 &&
      (writer->types & 1u << volume->type) != 0)
    return volume->type;
  for (size_t n = 0; is_whole(volume) && n < sizeof candidates / sizeof *candidates; n++)
    if ((writer->types & 1u << candidates[n]) != 0 && holds(candidates[n], volume->minimum, volume->maximum))
      return candidates[n];
  return hl_volume_is_exact(volume) && (writer->types & 1u << HL_VOXEL_F64) != 0 ? HL_VOXEL_F64
                                                                                 : HL_VOXEL_F32;
}

static hl_status set_type(saving *s, hl_voxel_type wanted, const char *path, hl_error *error) {
  s->grid.type = wanted != 0 ? wanted : choose_type(s->volume, s->writer);
  if (hl_voxel_type_bytes(s->grid.type) == 0)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: there is no voxel type %d", path, (int)wanted);
  if ((s->writer->types & 1u << s->grid.type) != 0) return HL_OK;
  char list[200] = "";
  size_t used = 0;
  for (int type = HL_VOXEL_U8; type <= HL_VOXEL_F16; type++)
    if ((s->writer->types & 1u << type) != 0)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used > 0 ? ", " : "",
                               hl_voxel_type_name((hl_voxel_type)type));
  return hl_fail(error, HL_ERROR_ARGUMENT, "%s: %s files hold no %s: choose one of %s", path,
                 s->writer->ending, hl_voxel_type_name(s->grid.type), list);
}

/* ---- the box ---- */

static hl_status set_box(saving *s, const hl_volume_save_options *options, const char *path,
                         hl_error *error) {
  const size_t *size = s->volume->dimension;
  s->shrink = options->shrink > 0 ? options->shrink : 1;
  s->labels = options->labels != 0 && s->shrink > 1;
  if (s->labels && s->shrink > MOST_SHRUNK_LABELS)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: labels are shrunk by %d at most, not by %zu: shrink them in steps", path,
                   MOST_SHRUNK_LABELS, s->shrink);
  for (int axis = 0; axis < 3; axis++) {
    s->begin[axis] = options->begin[axis];
    s->end[axis] = options->end[axis] > 0 ? options->end[axis] : size[axis];
    if (s->begin[axis] >= s->end[axis] || s->end[axis] > size[axis])
      return hl_fail(error, HL_ERROR_ARGUMENT, "%s: voxels %zu to %zu along axis %c: there are %zu, from 0",
                     path, s->begin[axis], s->end[axis], "ijk"[axis], size[axis]);
    size_t voxels = s->end[axis] - s->begin[axis];
    s->grid.dimensions[axis] = voxels / s->shrink + (voxels % s->shrink != 0);
  }
  return HL_OK;
}

/* Finds the unit of the volume's lengths: the unit that the volume's file states, or else the unit in the
 * options. */
static hl_status find_unit(saving *s, const char *asked, const char *path, hl_error *error) {
  static const char *const names[] = {"metre",      "centimetre", "millimetre",
                                      "micrometre", "nanometre",  "angstrom"};
  const hl_unit *unit = asked != NULL ? hl_unit_find(asked) : NULL;
  s->unit = s->volume->unit;
  s->unit_asked = asked != NULL && s->unit == NULL;
  if (!s->unit_asked) return HL_OK;
  for (size_t n = 0; n < sizeof names / sizeof *names && unit != NULL; n++)
    if (hl_unit_find(names[n])->metres == unit->metres) s->unit = names[n];
  return s->unit != NULL ? HL_OK
                         : hl_fail(error, HL_ERROR_ARGUMENT,
                                   "%s: unit: '%.40s' is none that is written: give m, cm, mm, um, nm or "
                                   "angstrom",
                                   path, asked);
}

/* Sets the origin and the axes of the grid that is written. A written voxel lies in the middle of the voxels
 * that are merged in it. At the box's end some of the merged voxels may be missing; the written voxel is
 * placed as if no voxel were missing. */
static void place_box(saving *s) {
  const hl_volume *volume = s->volume;
  vec3 origin = volume->index_to_world.offset;
  for (int axis = 0; axis < 3; axis++) {
    vec3 step = mat3_column(volume->index_to_world.linear, axis);
    double before = (double)s->begin[axis] + ((double)s->shrink - 1) / 2;
    origin = vec3_add(origin, vec3_scale(step, before));
    step = vec3_scale(step, (double)s->shrink);
    memcpy(s->grid.axis[axis], (const double[3]){step.x, step.y, step.z}, sizeof s->grid.axis[axis]);
  }
  double factor;
  s->unit = hl_written_unit(s->writer, s->unit, &factor);
  for (int axis = 0; axis < 3; axis++)
    for (int row = 0; row < 3; row++) s->grid.axis[axis][row] *= factor;
  origin = vec3_scale(origin, factor);
  memcpy(s->grid.origin, (const double[3]){origin.x, origin.y, origin.z}, sizeof s->grid.origin);
  s->grid.space = volume->space;
}

/* ---- rows ---- */

/* Returns whether the file's own numbers are written unchanged. Converting the file's own numbers of 64 bits
 * to doubles would round them. */
static bool keeps_numbers(const saving *s) {
  const hl_volume *volume = s->volume;
  return hl_volume_is_exact(volume) && (s->shrink == 1 || s->labels) && s->grid.type == volume->type &&
         volume->value_scale == 1 && volume->value_offset == 0;
}

/* The bits that identify a label. A label is identified by the bits of the file's own number if
 * keeps_numbers() is true, else by the bits of the data value. Equal labels have equal bits. */
static uint64_t bits_of(const saving *s, hl_number_row row, size_t i, double value) {
  uint64_t bits = 0;
  const size_t bytes = hl_voxel_type_bytes(row.type);
  value += 0.0; /* -0 becomes 0 */
  if (keeps_numbers(s)) memcpy(&bits, (const unsigned char *)row.numbers + i * bytes, bytes);
  else memcpy(&bits, &value, sizeof bits);
  return bits;
}

/* Adds row (j, k) of the volume to the sums and to the lists of labels. */
static void add_row(saving *s, size_t j, size_t k) {
  const hl_volume *volume = s->volume;
  const hl_number_row row = hl_volume_numbers(volume, j, k, s->memory.source_row);
  for (size_t i = s->begin[0], n = 0; i < s->end[0]; n++)
    for (size_t last = i + s->shrink; i < last && i < s->end[0]; i++) {
      double value = volume->value_scale * hl_row_number(row, i) + volume->value_offset;
      if (s->shrink > 1 && !isfinite(value)) continue;
      if (s->labels)
        s->memory.boxes[n * s->shrink * s->shrink * s->shrink + s->memory.counts[n]] = bits_of(s, row, i,
                                                                                               value);
      s->memory.sums[n] += value;
      s->memory.counts[n]++;
    }
}

/* The most frequent label of a box; of several equally frequent labels, the first one. The occurrences of a
 * label are counted at its first position in the list. Counting is fast, because a box has few different
 * labels. */
static uint64_t commonest(const uint64_t *values, size_t count) {
  uint64_t best = values[0];
  size_t most = 0;
  for (size_t n = 0; n < count && count - n > most; n++) {
    bool seen = false;
    for (size_t m = 0; m < n && !seen; m++) seen = values[m] == values[n];
    if (seen) continue;
    size_t equal = 0;
    for (size_t m = n; m < count; m++) equal += values[m] == values[n];
    if (equal > most) best = values[n];
    if (equal > most) most = equal;
  }
  return best;
}

/* Stores a label that bits_of() has made bits of. If keeps_numbers() is true, the label is stored in the row
 * that is written, else in `sums` as a data value. */
static void put_label(saving *s, size_t n, uint64_t bits) {
  const size_t bytes = hl_voxel_type_bytes(s->grid.type);
  if (keeps_numbers(s)) memcpy(s->memory.row + n * bytes, &bits, bytes);
  else memcpy(&s->memory.sums[n], &bits, sizeof bits);
}

/* Computes the data values of row (j, k) of the written grid in `sums`: the mean of the finite voxels or the
 * most common label, NAN if no voxel is finite. If keeps_numbers() is true, labels are stored in `row`
 * instead. */
static void make_row(saving *s, size_t j, size_t k) {
  const size_t count = s->grid.dimensions[0], box = s->shrink * s->shrink * s->shrink;
  memset(s->memory.sums, 0, count * sizeof *s->memory.sums);
  memset(s->memory.counts, 0, count * sizeof *s->memory.counts);
  size_t j0 = s->begin[1] + j * s->shrink, k0 = s->begin[2] + k * s->shrink;
  for (size_t z = k0; z < k0 + s->shrink && z < s->end[2]; z++)
    for (size_t y = j0; y < j0 + s->shrink && y < s->end[1]; y++) add_row(s, y, z);
  for (size_t n = 0; n < count; n++) {
    if (s->memory.counts[n] == 0) s->memory.sums[n] = NAN;
    if (s->memory.counts[n] == 0 && keeps_numbers(s))
      memcpy(s->memory.row + n * sizeof(double), &s->memory.sums[n], sizeof(double));
    if (s->memory.counts[n] == 0)
      continue; /* no merged voxel is finite; among the file's own numbers, only doubles can be non-finite */
    if (s->labels) put_label(s, n, commonest(s->memory.boxes + n * box, s->memory.counts[n]));
    else if (s->memory.counts[n] > 1) s->memory.sums[n] /= s->memory.counts[n];
  }
}

/* Rounds to the nearest IEEE 754 binary16, ties to even. The type _Float16 is not used, because not every
 * compiler has it. */
static uint16_t half_of(double value) {
  uint16_t sign = signbit(value) ? 0x8000 : 0;
  double size = fabs(value);
  if (isnan(value)) return 0x7e00;
  if (size >= 65520) return (uint16_t)(sign | 0x7c00);
  int exponent;
  frexp(size, &exponent); /* frexp() splits size into f 2^exponent, with f from 0.5 to 1. The lowest of the 11
                           * bits of a half is therefore worth 2^(exponent - 11) */
  int last = exponent - 11 > -24 ? exponent - 11 : -24;
  double units = nearbyint(ldexp(size, -last)); /* from 1024 to 2048, or less for subnormal halves */
  /* The exponent field of the half, less 1. The exponent field is used only if `units` is at least 1024, so
   * that the half is not subnormal. */
  int biased = last + 24;
  return (uint16_t)(sign | (units < 1024 ? (unsigned)units
                                         : ((unsigned)(biased + 1) << 10) + (unsigned)(units - 1024)));
}

/* Converts a value to a type of whole numbers: to the nearest number within the type's range; a value that is
 * not finite becomes 0. */
static double whole_value(saving *s, double value, double low, double high) {
  if (!isfinite(value)) s->holes++;
  if (!isfinite(value)) return 0;
  value = floor(value + 0.5);
  if (value >= low && value <= high) return value;
  s->clamped++;
  return value < low ? low : high;
}

#define STORE(type)                                         \
  do {                                                      \
    type stored = (type)value;                              \
    memcpy(to + n * sizeof stored, &stored, sizeof stored); \
  } while (0)

static void copy_row(saving *s, size_t j, size_t k) {
  size_t bytes = hl_voxel_type_bytes(s->grid.type);
  const unsigned char *row =
      hl_volume_numbers(s->volume, s->begin[1] + j, s->begin[2] + k, s->memory.source_row).numbers;
  memcpy(s->memory.row, row + s->begin[0] * bytes, s->grid.dimensions[0] * bytes);
}

static void convert_row(saving *s) {
  unsigned char *to = s->memory.row;
  double low = 0, high = 0;
  bool whole = whole_range(s->grid.type, &low, &high);
  for (size_t n = 0; n < s->grid.dimensions[0]; n++) {
    double value = whole ? whole_value(s, s->memory.sums[n], low, high) : s->memory.sums[n];
    switch (s->grid.type) {
      case HL_VOXEL_U8: STORE(uint8_t); break;
      case HL_VOXEL_I8: STORE(int8_t); break;
      case HL_VOXEL_U16: STORE(uint16_t); break;
      case HL_VOXEL_I16: STORE(int16_t); break;
      case HL_VOXEL_U32: STORE(uint32_t); break;
      case HL_VOXEL_I32: STORE(int32_t); break;
      case HL_VOXEL_U64: STORE(uint64_t); break;
      case HL_VOXEL_I64: STORE(int64_t); break;
      case HL_VOXEL_F32: STORE(float); break;
      case HL_VOXEL_F64: STORE(double); break;
      case HL_VOXEL_F16: {
        uint16_t half = half_of(value);
        memcpy(to + 2 * n, &half, sizeof half);
        break;
      }
    }
  }
}

/* ---- bytes ---- */

/* Writes bytes to the file, packed if `packs` is set. Errors of writing are detected later by
 * hl_output_commit(). */
static void put(saving *s, const void *bytes, size_t count, bool last) {
  if (!s->packs) {
    fwrite(bytes, 1, count, s->output.file);
    return;
  }
  s->stream.next_in = (unsigned char *)bytes;
  s->stream.avail_in = (uInt)count;
  do {
    s->stream.next_out = s->memory.packed;
    s->stream.avail_out = OUT_BYTES;
    deflate(&s->stream, last ? Z_FINISH : Z_NO_FLUSH);
    fwrite(s->memory.packed, 1, OUT_BYTES - s->stream.avail_out, s->output.file);
  } while (s->stream.avail_out == 0);
}

static hl_status write_rows(saving *s, hl_error *error) {
  const size_t *n = s->grid.dimensions;
  size_t bytes = n[0] * hl_voxel_type_bytes(s->grid.type);
  for (size_t k = 0; k < n[2]; k++) {
    for (size_t j = 0; j < n[1]; j++) {
      if (keeps_numbers(s) && s->shrink == 1) copy_row(s, j, k);
      else make_row(s, j, k);
      if (!keeps_numbers(s)) convert_row(s);
      put(s, s->memory.row, bytes, k + 1 == n[2] && j + 1 == n[1]);
    }
    hl_progress(s->context, "write", (double)(k + 1) / (double)n[2]);
    if (hl_cancelled(s->context)) return hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", s->output.path);
  }
  return HL_OK;
}

static hl_status state_size(saving *s, size_t at, hl_error *error) {
  if (fseeko(s->output.file, (off_t)at, SEEK_SET) != 0)
    return hl_fail(error, HL_ERROR_IO, "%s: cannot be written: %s", s->output.path, strerror(errno));
  fprintf(s->output.file, "%-*llu", HL_WRITER_SIZE_CHARACTERS, (unsigned long long)s->stream.total_out);
  return HL_OK;
}

/* Writes the bytes after the voxels that a format makes piece by piece. */
static void write_pieces(saving *s, const hl_written_header *header) {
  unsigned char piece[HL_WRITER_HEADER_BYTES];
  size_t length;
  for (size_t n = 0; (length = s->writer->make_piece(&s->grid, header, n, piece)) > 0; n++)
    fwrite(piece, 1, length, s->output.file);
}

static hl_status write_file(saving *s, const char *path, hl_error *error) {
  hl_written_header header = {.unit = s->unit};
  hl_status status = s->writer->make_header(path, &s->grid, &header, error);
  if (status == HL_OK) status = hl_output_begin(s->context, path, &s->output, error);
  if (status != HL_OK) return status;
  s->packs = s->writer->packing == HL_PACKING_GZIP_ALL;
  put(s, header.bytes, header.length, false);
  s->packs = s->writer->packing != HL_PACKING_NONE;
  status = write_rows(s, error);
  if (status == HL_OK && header.end != NULL) fputs(header.end, s->output.file);
  if (status == HL_OK && s->writer->make_piece != NULL) write_pieces(s, &header);
  if (status == HL_OK && header.size_at > 0) status = state_size(s, header.size_at, error);
  if (status == HL_OK) return hl_output_commit(&s->output, error);
  hl_output_abort(&s->output);
  return status;
}

static hl_status begin_packing(saving *s, hl_error *error) {
  int window = ZLIB_WINDOW + (s->writer->packing == HL_PACKING_ZLIB_VOXELS ? 0 : GZIP);
  if (s->writer->packing == HL_PACKING_NONE ||
      deflateInit2(&s->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY) == Z_OK)
    return HL_OK;
  return hl_fail_memory(error, 300000, "compression");
}

static hl_status save(saving *s, const char *path, hl_error *error) {
  hl_context *context = s->context;
  size_t count = s->grid.dimensions[0], bytes = sizeof *s->memory.sums + sizeof *s->memory.counts + 8;
  s->memory.sums = hl_allocate(context, count, sizeof *s->memory.sums);
  s->memory.counts = hl_allocate(context, count, sizeof *s->memory.counts);
  size_t box_bytes = s->labels ? s->shrink * s->shrink * s->shrink * sizeof *s->memory.boxes : 0;
  if (s->labels) s->memory.boxes = hl_allocate(context, count, box_bytes);
  s->memory.row = hl_allocate(context, count, hl_voxel_type_bytes(s->grid.type));
  s->memory.packed = hl_allocate(context, OUT_BYTES, 1);
  size_t source_bytes = hl_volume_row_room(s->volume);
  s->memory.source_row = hl_allocate(context, source_bytes, 1);
  if (s->memory.sums == NULL || s->memory.counts == NULL || (s->labels && s->memory.boxes == NULL) ||
      s->memory.row == NULL || s->memory.packed == NULL || s->memory.source_row == NULL)
    return hl_fail_memory(error, count * (bytes + box_bytes) + OUT_BYTES + source_bytes, path);
  hl_status status = begin_packing(s, error);
  if (status != HL_OK) return status;
  status = write_file(s, path, error);
  if (s->writer->packing != HL_PACKING_NONE) deflateEnd(&s->stream);
  return status;
}

/* ---- all steps together ---- */

/* Checks the name of a file of bare voxels. The name must state the size and the type of the voxels, because
 * the file itself does not. */
static hl_status check_raw_name(const saving *s, const char *path, hl_error *error) {
  hl_payload payload;
  const size_t *n = s->grid.dimensions;
  bool named = hl_raw_name(path, &payload);
  if (strncmp(s->writer->ending, ".raw", 4) != 0 ||
      (named && payload.grid.type == s->grid.type && !payload.big_endian &&
       memcmp(payload.grid.dimensions, n, sizeof payload.grid.dimensions) == 0))
    return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "%s: bare voxels are read by their name: put _%zux%zux%zu_%s before .raw, or write .nrrd",
                 path, n[0], n[1], n[2], hl_voxel_type_name(s->grid.type));
}

/* Returns whether a grid has an origin or directions that differ from the defaults. If `spacing` is true,
 * steps of other lengths than 1 count as different, too. If `spacing` is false, a stated anatomical space
 * counts as different, too. */
static bool has_place(const hl_volume_description *grid, bool spacing) {
  hl_volume_description plain;
  hl_volume_description_defaults(&plain);
  if (!spacing && grid->space != HL_SPACE_UNKNOWN) return true;
  for (int axis = 0; axis < 3 && !spacing; axis++) plain.axis[axis][axis] = fabs(grid->axis[axis][axis]);
  return memcmp(grid->axis, plain.axis, sizeof plain.axis) != 0 ||
         memcmp(grid->origin, plain.origin, sizeof plain.origin) != 0;
}

/* Warns that the file gets more voxels than the field has coefficients. The warning is written before the
 * field is evaluated, because the evaluation takes long. */
static void tell_evaluation(const saving *s, const char *path) {
  const size_t *n = s->grid.dimensions, size = hl_voxel_type_bytes(s->grid.type);
  if (s->volume->bricks == NULL) return;
  hl_log(s->context, HL_LOG_WARNING,
         "%s: the field has detail in some places alone: it is evaluated at all %zu x %zu x %zu voxels, %.1f "
         "MiB",
         path, n[0], n[1], n[2], (double)n[0] * (double)n[1] * (double)n[2] * (double)size / (1 << 20));
}

/* Warns about properties that the file cannot hold. */
static void tell_losses(const saving *s, const char *path) {
  hl_context *context = s->context;
  const char *loses = s->writer->loses, *type = hl_voxel_type_name(s->grid.type);
  if (loses != NULL && strcmp(loses, "place") == 0 && has_place(&s->grid, true))
    hl_log(context, HL_LOG_WARNING,
           "%s: %s files hold no spacing, origin and directions: give them where the file is read", path,
           s->writer->ending);
  else if (loses != NULL && strcmp(loses, "origin") == 0 && has_place(&s->grid, false))
    hl_log(context, HL_LOG_WARNING,
           "%s: %s files hold the lengths of voxels, but neither origin nor directions: .nrrd does", path,
           s->writer->ending);
  else if (loses != NULL && strcmp(loses, "space") == 0 && s->grid.space != HL_SPACE_UNKNOWN)
    hl_log(context, HL_LOG_WARNING, "%s: %s files do not tell that their world is %s: remember it", path,
           s->writer->ending, hl_space_name(s->grid.space));
  if (s->writer->claims != NULL && s->grid.space == HL_SPACE_UNKNOWN)
    hl_log(
        context, HL_LOG_WARNING,
        "%s: %s files state that x, y and z point to the body's right, front and head (%s), and the source "
        "tells no directions of a body: check left and right, or write .nrrd",
        path, s->writer->ending, s->writer->claims);
  if (s->unit_asked && s->writer->units == NULL)
    hl_log(context, HL_LOG_WARNING, "%s: %s files do not tell a unit of lengths: .nrrd and .nii do", path,
           s->writer->ending);
  if (s->volume->colors != NULL)
    hl_log(context, HL_LOG_WARNING,
           "%s: the voxels' colours are lost: the file gets the densities from which opacity comes", path);
  if (hl_volume_is_exact(s->volume) && (s->grid.type == HL_VOXEL_F32 || s->grid.type == HL_VOXEL_F16))
    hl_log(
        context, HL_LOG_WARNING,
        "%s: numbers above 2^24 are rounded, as %s keeps 24 bits of a number: choose another --type or .nrrd",
        path, type);
  if (s->clamped > 0)
    hl_log(context, HL_LOG_WARNING,
           "%s: %llu values are beyond the range of %s, and are written as its least or greatest", path,
           (unsigned long long)s->clamped, type);
  if (s->holes > 0)
    hl_log(context, HL_LOG_WARNING,
           "%s: %llu values are not finite, and are written as 0: %s has no such numbers", path,
           (unsigned long long)s->holes, type);
}

void hl_volume_save_options_defaults(hl_volume_save_options *options) {
  if (options != NULL) *options = (hl_volume_save_options){.struct_size = sizeof *options, .shrink = 1};
}

hl_status hl_volume_save_with(hl_context *context, const hl_volume *volume, const char *path,
                              const hl_volume_save_options *options, hl_error *error) {
  HL_DOOR;
  if (context == NULL || volume == NULL || path == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_save: null context, volume or path");
  hl_volume_save_options chosen;
  hl_volume_save_options_defaults(&chosen);
  if (options == NULL) options = &chosen;
  if (options->struct_size != sizeof *options)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: the options are not filled: call hl_volume_save_options_defaults() first", path);
  saving s = {.context = context, .volume = volume, .writer = hl_writer_for(path)};
  if (s.writer == NULL)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "%s: volumes are written as .nrrd, .nii, .nii.gz, .mha, .vti, .mrc, .mrc.gz, .tif, .npy, .raw or "
        ".raw.gz: end the name in one of these",
        path);
  hl_volume_description_defaults(&s.grid);
  hl_status status = set_box(&s, options, path, error);
  if (status == HL_OK) status = set_type(&s, options->type, path, error);
  if (status == HL_OK) status = find_unit(&s, options->unit, path, error);
  if (status == HL_OK) place_box(&s);
  if (status == HL_OK) status = check_raw_name(&s, path, error);
  if (status == HL_OK) tell_evaluation(&s, path);
  if (status == HL_OK) status = save(&s, path, error);
  if (status == HL_OK) tell_losses(&s, path);
  hl_release(context, s.memory.sums);
  hl_release(context, s.memory.counts);
  hl_release(context, s.memory.boxes);
  hl_release(context, s.memory.row);
  hl_release(context, s.memory.packed);
  hl_release(context, s.memory.source_row);
  return status;
}

hl_status hl_volume_save(hl_context *context, const hl_volume *volume, const char *path, hl_error *error) {
  HL_DOOR;
  return hl_volume_save_with(context, volume, path, NULL, error);
}
