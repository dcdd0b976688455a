/* volume/formats/amr/amrex.c - reads plotfiles of AMReX (Castro, Nyx, PeleLM, WarpX, ...). A plotfile is a
 * folder with a text "Header" and a folder Level_N for each level, in which Cell_H lists the patches and says
 * where their values are.
 *
 * Source: AMReX's documentation, "AMReX Plotfile", and its source (VisMF and FAB). Before a patch's values
 * stands a line "FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))((0,0,0) (7,7,7) (0,0,0)) 2". The
 * line states the layout of a real number, the order of its bytes, the box of cells and the number of
 * components. The components follow one after the other, each as [z][y][x]. Each component is an array that
 * can be loaded as a volume. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/amr/amr.h"
#include "volume/formats/format.h"
#include "volume/io/numbers.h"
#include "volume/io/text.h"

enum { NAME_BYTES = 128, FILE_NAME_BYTES = 256, TEXT_BYTES_MOST = 1 << 28, FAB_LINE_BYTES = 512 };

/* The position at which a text of the plotfile is read. */
typedef struct text_cursor {
  const char *at, *end;
  const char *name; /* the file's name, for error lines */
  int line;
} text_cursor;

typedef struct plotfile {
  const hl_bundle *bundle;
  hl_load_request *request;
  hl_amr_shape shape;
  hl_amr amr;
  size_t components;
} plotfile;

static hl_status fail_text(const plotfile *file, const text_cursor *text, const char *what, hl_error *error) {
  return hl_fail_at(error, HL_ERROR_INPUT, text->line, 0, "%s/%s, line %d: expected %s", file->bundle->path,
                    text->name, text->line, what);
}

/* ---- texts ---- */

/* Reads a whole text file. *bytes is owned by the caller. */
static hl_status read_text(const plotfile *file, const char *name, unsigned char **bytes, text_cursor *text,
                           hl_error *error) {
  hl_source *source = NULL;
  size_t length = 0;
  hl_status status = hl_bundle_find(file->bundle, name, false, &source, error);
  if (status == HL_OK && source == NULL)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the plotfile has no file \"%s\"", file->bundle->path, name);
  if (status == HL_OK) status = hl_source_read_whole(source, name, TEXT_BYTES_MOST, bytes, &length, error);
  hl_source_close(source);
  if (status == HL_OK) *text = (text_cursor){(const char *)*bytes, (const char *)*bytes + length, name, 1};
  return status;
}

/* Copies the rest of the line, and goes to the next line. Returns false at the end of the text, or if the
 * line is too long. */
static bool take_line(text_cursor *text, char *line, size_t capacity) {
  const char *end = memchr(text->at, '\n', (size_t)(text->end - text->at));
  if (end == NULL) end = text->end;
  size_t length = (size_t)(end - text->at);
  bool fits = text->at < text->end && length < capacity && memchr(text->at, 0, length) == NULL;
  if (fits) memcpy(line, text->at, length), line[length] = 0;
  text->at = end < text->end ? end + 1 : end;
  text->line++;
  return fits;
}

static bool is_between(char c) { return hl_is_space(c) || c == ',' || c == '(' || c == ')'; }

/* Reads the next number; commas and brackets count as spaces. */
static bool take_number(text_cursor *text, double *value) {
  while (text->at < text->end && is_between(*text->at)) text->line += *text->at++ == '\n';
  const char *begin = text->at;
  while (text->at < text->end && !is_between(*text->at)) text->at++;
  return text->at > begin && hl_text_number(begin, (size_t)(text->at - begin), value);
}

static bool take_integer(text_cursor *text, ptrdiff_t *value) {
  double number;
  if (!take_number(text, &number) || number != floor(number) || fabs(number) > 1 << 30) return false;
  *value = (ptrdiff_t)number;
  return true;
}

/* Reads a box "((0,0,0) (63,63,63) (0,0,0))" of cells. */
static bool take_box(text_cursor *text, ptrdiff_t first[3], size_t count[3]) {
  ptrdiff_t last[3], centring[3];
  for (int axis = 0; axis < 3; axis++)
    if (!take_integer(text, &first[axis])) return false;
  for (int axis = 0; axis < 3; axis++)
    if (!take_integer(text, &last[axis]) || last[axis] < first[axis]) return false;
  for (int axis = 0; axis < 3; axis++) {
    if (!take_integer(text, &centring[axis]) || centring[axis] != 0) return false;
    count[axis] = (size_t)(last[axis] - first[axis]) + 1;
  }
  return true;
}

/* ---- the header ---- */

static bool is_plotfile(const char *line) {
  return strncmp(line, "HyperCLaw-V1.", 13) == 0 || strncmp(line, "NavierStokes-V1.", 16) == 0;
}

static hl_status list_components(plotfile *file, text_cursor *text, hl_error *error) {
  char line[NAME_BYTES];
  ptrdiff_t components;
  hl_status status = HL_OK;
  if (!take_integer(text, &components) || components < 1 || components > 100000)
    return fail_text(file, text, "the number of components", error);
  take_line(text, line, sizeof line); /* skips the rest of the number's line */
  file->components = (size_t)components;
  for (ptrdiff_t n = 0; n < components && status == HL_OK; n++) {
    if (!take_line(text, line, sizeof line)) return fail_text(file, text, "the name of a component", error);
    status = hl_arrays_add(file->request, hl_text_trim(line), 1, HL_VOXEL_F64, true, error);
  }
  return status;
}

static hl_status read_shape(plotfile *file, text_cursor *text, hl_error *error) {
  hl_amr_shape *shape = &file->shape;
  double low[3], high[3], time;
  ptrdiff_t dimensions, finest, ratio;
  if (!take_integer(text, &dimensions)) return fail_text(file, text, "the number of dimensions", error);
  if (dimensions != 3)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a plotfile of %td dimensions: give one of three dimensions", file->bundle->path,
                   dimensions);
  if (!take_number(text, &time) || !take_integer(text, &finest) || finest < 0 || finest >= HL_AMR_LEVELS_MOST)
    return fail_text(file, text, "the time and the number of the finest level", error);
  shape->levels = (int)finest + 1;
  for (int n = 0; n < 6; n++)
    if (!take_number(text, n < 3 ? &low[n] : &high[n - 3]))
      return fail_text(file, text, "the corners of the domain", error);
  for (int level = 0; level < finest; level++) {
    if (!take_integer(text, &ratio)) return fail_text(file, text, "a ratio of refinement", error);
    shape->ratio[level] = (int)ratio;
  }
  if (!take_box(text, shape->first, shape->count))
    return fail_text(file, text, "the box of cells of level 0", error);
  for (int axis = 0; axis < 3; axis++) {
    shape->origin[axis] = low[axis];
    shape->spacing[axis] = (high[axis] - low[axis]) / (double)shape->count[axis];
  }
  return HL_OK;
}

/* Warns if the plotfile's header states coordinates that are not Cartesian. */
static void tell_coordinates(const plotfile *file, text_cursor *text) {
  ptrdiff_t first[3], system;
  size_t count[3];
  double number;
  for (int level = 1; level < file->shape.levels; level++)
    if (!take_box(text, first, count)) return;
  for (int n = 0; n < 4 * file->shape.levels; n++) /* skips the steps and the sizes of cells */
    if (!take_number(text, &number)) return;
  if (take_integer(text, &system) && system != 0)
    hl_log(file->request->context, HL_LOG_WARNING,
           "%s: its coordinates are %s: they are shown as if they were Cartesian", file->bundle->path,
           system == 1 ? "cylindrical" : "spherical");
}

static hl_status read_header(plotfile *file, hl_error *error) {
  unsigned char *bytes = NULL;
  text_cursor text = {NULL, NULL, "Header", 1};
  char line[NAME_BYTES];
  hl_status status = read_text(file, "Header", &bytes, &text, error);
  if (status == HL_OK && !take_line(&text, line, sizeof line))
    status = fail_text(file, &text, "a version", error);
  if (status == HL_OK) status = list_components(file, &text, error);
  if (status == HL_OK) status = read_shape(file, &text, error);
  if (status == HL_OK) tell_coordinates(file, &text);
  hl_release(file->request->context, bytes);
  return status;
}

/* ---- the values of a patch ---- */

/* The layout of a patch's real numbers. */
typedef struct fab_layout {
  hl_voxel_type type;
  bool big_endian;
} fab_layout;

/* Reads the line in front of a patch's values. length: the line's length without its end. */
static bool read_fab_line(const char *line, size_t length, fab_layout *layout, ptrdiff_t first[3],
                          size_t count[3], ptrdiff_t *components) {
  text_cursor text = {line, line + length, "", 1};
  ptrdiff_t formats, bits, unused, bytes, order;
  if (length < 4 || memcmp(line, "FAB ", 4) != 0) return false;
  text.at += 4;
  if (!take_integer(&text, &formats) || formats != 8 || !take_integer(&text, &bits)) return false;
  for (int n = 1; n < 8; n++)
    if (!take_integer(&text, &unused)) return false;
  if (!take_integer(&text, &bytes) || bytes * 8 != bits || (bytes != 4 && bytes != 8)) return false;
  for (ptrdiff_t n = 0; n < bytes; n++) {
    if (!take_integer(&text, &order)) return false;
    if (n == 0) layout->big_endian = order == 1;
    if (order != (layout->big_endian ? n + 1 : bytes - n)) return false;
  }
  layout->type = bytes == 4 ? HL_VOXEL_F32 : HL_VOXEL_F64;
  return take_box(&text, first, count) && take_integer(&text, components);
}

/* Reads one component of a patch as floats; *values is owned by the caller. place: the position of the
 * component's first byte in the file. */
static hl_status read_values(const plotfile *file, hl_source *source, uint64_t place,
                             const fab_layout *layout, size_t cells, float **values, hl_error *error) {
  enum { STAGE = 4096 };
  unsigned char stage[STAGE * 8];
  size_t size = hl_voxel_type_bytes(layout->type), got;
  uint64_t end;
  *values = NULL;
  if (__builtin_mul_overflow((uint64_t)cells, size, &end) || __builtin_add_overflow(end, place, &end) ||
      end > hl_source_size(source))
    return hl_fail(error, HL_ERROR_INPUT, "%s: the file ends before the %zu values of a patch",
                   hl_source_path(source), cells);
  *values = hl_allocate(file->request->context, cells, sizeof **values);
  if (*values == NULL) return hl_fail_memory(error, cells * sizeof **values, file->bundle->path);
  for (size_t done = 0; done < cells;) {
    size_t wanted = cells - done < STAGE ? cells - done : STAGE;
    hl_status status = hl_source_read(source, place + done * size, stage, wanted * size, &got, error);
    if (status != HL_OK) return status;
    if (got < wanted * size)
      return hl_fail(error, HL_ERROR_INPUT, "%s: the file ends within a patch", hl_source_path(source));
    for (size_t n = 0; n < wanted; n++)
      (*values)[done + n] = (float)hl_binary_number(stage + n * size, layout->type, layout->big_endian);
    done += wanted;
  }
  return HL_OK;
}

static hl_status fail_patch(const hl_source *source, uint64_t place, hl_error *error) {
  return hl_fail_offset(
      error, HL_ERROR_INPUT, (int64_t)place,
      "%s, byte %llu: expected \"FAB\" and the layout, the box and the components of a patch of "
      "cells",
      hl_source_path(source), (unsigned long long)place);
}

/* Copies the cells of a patch without the ghost cells around them. */
static void cut_patch(const float *values, const ptrdiff_t from[3], const size_t size[3],
                      const ptrdiff_t first[3], const size_t count[3], float *cut) {
  for (size_t k = 0; k < count[2]; k++)
    for (size_t j = 0; j < count[1]; j++) {
      size_t z = (size_t)(first[2] - from[2]) + k, y = (size_t)(first[1] - from[1]) + j;
      memmove(cut + (k * count[1] + j) * count[0],
              values + (z * size[1] + y) * size[0] + (size_t)(first[0] - from[0]), count[0] * sizeof *cut);
    }
}

/* Reads the patch that begins at position `place` of a file. first, count: the patch's cells, as Cell_H lists
 * them. */
static hl_status read_patch(plotfile *file, int level, hl_source *source, uint64_t place,
                            const ptrdiff_t first[3], const size_t count[3], hl_error *error) {
  const unsigned char *bytes;
  size_t available, size[3], cells = 1;
  ptrdiff_t from[3], components;
  fab_layout layout = {0};
  float *values = NULL;
  hl_status status = hl_source_peek(source, place, FAB_LINE_BYTES, &bytes, &available, error);
  if (status != HL_OK) return status;
  const unsigned char *end = memchr(bytes, '\n', available);
  if (end == NULL ||
      !read_fab_line((const char *)bytes, (size_t)(end - bytes), &layout, from, size, &components))
    return fail_patch(source, place, error);
  for (int axis = 0; axis < 3; axis++)
    if (from[axis] > first[axis] ||
        first[axis] + (ptrdiff_t)count[axis] > from[axis] + (ptrdiff_t)size[axis] ||
        !hl_multiply(cells, size[axis], &cells))
      return fail_patch(source, place, error);
  if (components < 0 || file->request->chosen >= (size_t)components ||
      cells > SIZE_MAX / 8 / file->components)
    return fail_patch(source, place, error);
  uint64_t begin = place + (uint64_t)(end - bytes) + 1 +
                   (uint64_t)file->request->chosen * cells * hl_voxel_type_bytes(layout.type);
  status = read_values(file, source, begin, &layout, cells, &values, error);
  if (status == HL_OK) {
    cut_patch(values, from, size, first, count, values);
    status = hl_amr_add(&file->amr, level, first, count, values, error);
  }
  hl_release(file->request->context, values);
  return status;
}

/* ---- levels ---- */

/* The box of a patch, as Cell_H lists it. */
typedef struct patch_box {
  ptrdiff_t first[3];
  size_t count[3];
} patch_box;

/* Reads the list of a level's patches, which are boxes of cells; *boxes is owned by the caller. */
static hl_status read_boxes(const plotfile *file, text_cursor *text, patch_box **boxes, size_t *count,
                            hl_error *error) {
  ptrdiff_t version, how, components, number, unused;
  if (!take_integer(text, &version) || !take_integer(text, &how) || !take_integer(text, &components))
    return fail_text(file, text, "the version of the list of patches", error);
  if (version != 1)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s/%s: version %td of the list of patches is not read: write the plotfile with "
                   "vismf.headerversion=1",
                   file->bundle->path, text->name, version);
  /* the loops skip the number of ghost cells, which is one number or three numbers in brackets, up to
   * "(patches 0" */
  while (text->at < text->end && hl_is_space(*text->at)) text->line += *text->at++ == '\n';
  int ghosts = text->at < text->end && *text->at == '(' ? 3 : 1;
  for (int n = 0; n < ghosts; n++)
    if (!take_integer(text, &unused)) return fail_text(file, text, "the number of ghost cells", error);
  if (!take_integer(text, &number) || number < 0 || !take_integer(text, &unused))
    return fail_text(file, text, "the number of patches", error);
  if ((size_t)number > (size_t)(text->end - text->at) / 12) /* each box takes more than 12 characters */
    return fail_text(file, text, "as many boxes as it promises", error);
  *boxes = hl_allocate(file->request->context, (size_t)number, sizeof **boxes);
  if (*boxes == NULL) return hl_fail_memory(error, (size_t)number * sizeof **boxes, file->bundle->path);
  *count = (size_t)number;
  for (size_t n = 0; n < *count; n++)
    if (!take_box(text, (*boxes)[n].first, (*boxes)[n].count))
      return fail_text(file, text, "the box of a patch, of cells", error);
  return HL_OK;
}

/* Reads the line "FabOnDisk: Cell_D_00000 0", and opens the file if it is not open yet. */
static hl_status open_patch(const plotfile *file, int level, text_cursor *text, char open[FILE_NAME_BYTES],
                            hl_source **source, uint64_t *place, hl_error *error) {
  char line[FILE_NAME_BYTES], name[FILE_NAME_BYTES + 32], word[FILE_NAME_BYTES];
  const char *cursor = line;
  size_t at;
  do {
    if (!take_line(text, line, sizeof line)) return fail_text(file, text, "\"FabOnDisk:\" and a file", error);
  } while (line[0] == 0 || line[0] == ')');
  if (!hl_text_word(&cursor, word, sizeof word) || strcmp(word, "FabOnDisk:") != 0 ||
      !hl_text_word(&cursor, word, sizeof word) || hl_text_sizes(cursor, &at, 1) != 1)
    return fail_text(file, text, "\"FabOnDisk:\", a file and a place in it", error);
  *place = at;
  if (strcmp(word, open) == 0) return HL_OK;
  hl_source_close(*source);
  *source = NULL;
  open[0] = 0;
  snprintf(name, sizeof name, "Level_%d/%s", level, word);
  hl_status status = hl_bundle_find(file->bundle, name, false, source, error);
  if (status == HL_OK && *source == NULL)
    status = hl_fail(error, HL_ERROR_INPUT, "%s: the plotfile has no file \"%s\"", file->bundle->path, name);
  if (status == HL_OK) strcpy(open, word);
  return status;
}

static hl_status read_patches(plotfile *file, int level, text_cursor *text, const patch_box *boxes,
                              size_t count, hl_error *error) {
  char open[FILE_NAME_BYTES] = "", line[FILE_NAME_BYTES];
  hl_source *source = NULL;
  ptrdiff_t promised;
  uint64_t place = 0;
  hl_status status = HL_OK;
  if (!take_integer(text, &promised) || promised < 0 || (size_t)promised != count)
    return fail_text(file, text, "the number of patches once more", error);
  take_line(text, line, sizeof line);
  for (size_t n = 0; n < count && status == HL_OK; n++) {
    status = open_patch(file, level, text, open, &source, &place, error);
    if (status == HL_OK)
      status = read_patch(file, level, source, place, boxes[n].first, boxes[n].count, error);
    hl_progress(file->request->context, "load",
                ((double)level + (double)n / (double)count) / file->shape.levels);
    if (status == HL_OK && hl_cancelled(file->request->context))
      status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", file->bundle->path);
  }
  hl_source_close(source);
  return status;
}

static hl_status read_level(plotfile *file, int level, hl_error *error) {
  char name[FILE_NAME_BYTES];
  unsigned char *bytes = NULL;
  text_cursor text = {NULL, NULL, name, 1};
  patch_box *boxes = NULL;
  size_t count = 0;
  snprintf(name, sizeof name, "Level_%d/Cell_H", level);
  hl_status status = read_text(file, name, &bytes, &text, error);
  if (status == HL_OK) status = read_boxes(file, &text, &boxes, &count, error);
  if (status == HL_OK) status = read_patches(file, level, &text, boxes, count, error);
  hl_release(file->request->context, boxes);
  hl_release(file->request->context, bytes);
  return status;
}

/* ---- all steps together ---- */

/* Finds out whether the folder has the file "Header" of a plotfile. */
static hl_status recognise(hl_bundle *bundle, bool *claimed, hl_error *error) {
  hl_source *source = NULL;
  const unsigned char *bytes;
  size_t available = 0;
  char line[32] = "";
  hl_status status = hl_bundle_find_ready(bundle, error);
  *claimed = false;
  if (status == HL_OK) status = hl_bundle_find(bundle, "Header", true, &source, error);
  if (status != HL_OK || source == NULL) return status;
  status = hl_source_peek(source, 0, sizeof line - 1, &bytes, &available, error);
  if (status == HL_OK) memcpy(line, bytes, available < sizeof line ? available : sizeof line - 1);
  *claimed = status == HL_OK && is_plotfile(line);
  hl_source_close(source);
  return status;
}

static hl_status load_bundle(hl_bundle *bundle, hl_load_request *request, bool *claimed, hl_volume **volume,
                             hl_error *error) {
  plotfile file = {.bundle = bundle, .request = request};
  hl_payload payload;
  hl_status status = recognise(bundle, claimed, error);
  if (status != HL_OK || !*claimed) return status;
  status = read_header(&file, error);
  if (status == HL_OK) status = hl_arrays_choose(request, bundle->path, -1, error);
  hl_payload_defaults(&payload);
  payload.components = 1;
  if (status == HL_OK) status = hl_component_choose(request, bundle->path, false, &payload, error);
  if (status == HL_OK) status = hl_amr_begin(request->context, &file.shape, bundle->path, &file.amr, error);
  if (status == HL_OK) hl_amr_set_spacing(&file.amr, request->spacing);
  for (int level = 0; level < file.shape.levels && status == HL_OK; level++)
    status = read_level(&file, level, error);
  if (status == HL_OK) status = hl_amr_finish(&file.amr, volume, error);
  hl_amr_close(&file.amr);
  return status;
}

const hl_format hl_format_amrex = {.name = "AMReX plotfile", .load_bundle = load_bundle};
