/* volume/formats/slices/slices.c - reads folders and zip archives of numbered files. Each file is a slice: a
 * picture or bare voxels. The numbers in the names give the order.
 *
 * The names of a series differ only in their last number, as in "scan_007.tif". If a folder has several
 * series, the longest series is read. TIFF files that are volumes of their own (several pages, OME-TIFF) are
 * time steps instead of slices. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/pool.h"
#include "volume/convert.h"
#include "volume/formats/format.h"
#include "volume/formats/raw.h"
#include "volume/formats/slices/slice_picture.h"
#include "volume/formats/tiff/tiff.h"
#include "volume/io/destination.h"
#include "volume/io/parallel.h"
#include "volume/io/text.h"

enum {
  PARALLEL_BYTES = 1 << 20, /* smaller volumes are read by one thread, because starting more threads would
                             * take longer */
  FILE_BYTES_MOST = 1 << 30 /* greatest length of a picture's file */
};

/* A picture's name, and the position of the last number in the name. */
typedef struct numbered_name {
  const hl_bundle_entry *entry;
  size_t number_at, number_end;
  uint64_t number;
} numbered_name;

typedef struct slices_reading {
  hl_load_request *request;
  const hl_bundle *bundle;
  numbered_name *names; /* owned; [count]; the names of all series */
  size_t first, count;  /* index of the first name of the chosen series; number of the series' names */
  hl_slice_shape shape;
  int component;
  hl_destination to;
} slices_reading;

/* ---- names ---- */

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Finds the last number in a file's own name. Returns false if the name has no number, or if the file cannot
 * be a slice. */
static bool cut_name(const hl_bundle_entry *entry, numbered_name *name) {
  const char *slash = strrchr(entry->name, '/'), *base = slash == NULL ? entry->name : slash + 1;
  const char *dot = strrchr(base, '.'), *end = dot == NULL ? base + strlen(base) : dot;
  hl_raw_slice raw; /* the size and the type of bare voxels, if the name states them; the numbers in this part
                     * of the name are not the slice's number */
  hl_payload whole;
  if (hl_slice_is_raw(base) && hl_raw_name(base, &whole) && whole.grid.dimensions[2] != 1) return false;
  if (hl_slice_is_raw(base) && hl_raw_slice_name(base, strlen(base), &raw)) {
    const char *after = base + raw.end;
    if (strcspn(after, "0123456789") >= (size_t)(end - after)) end = base + raw.begin;
  }
  while (end > base && !is_digit(end[-1])) end--;
  const char *begin = end;
  while (begin > base && is_digit(begin[-1])) begin--;
  if (begin == end || end - begin > 18) return false;
  *name = (numbered_name){entry, (size_t)(begin - entry->name), (size_t)(end - entry->name), 0};
  for (const char *c = begin; c < end; c++) name->number = 10 * name->number + (uint64_t)(*c - '0');
  return true;
}

/* Compares names by the texts around their numbers, which are equal within a series. */
static int compare_series(const numbered_name *a, const numbered_name *b) {
  size_t shorter = a->number_at < b->number_at ? a->number_at : b->number_at;
  int order = strncmp(a->entry->name, b->entry->name, shorter);
  if (order == 0) order = (a->number_at > b->number_at) - (a->number_at < b->number_at);
  return order != 0 ? order : strcmp(a->entry->name + a->number_end, b->entry->name + b->number_end);
}

static int by_series_and_number(const void *x, const void *y) {
  const numbered_name *a = x, *b = y;
  int order = compare_series(a, b);
  if (order == 0) order = (a->number > b->number) - (a->number < b->number);
  return order != 0 ? order : strcmp(a->entry->name, b->entry->name);
}

static hl_status list_names(slices_reading *r, size_t *count, hl_error *error) {
  const hl_bundle *bundle = r->bundle;
  r->names = hl_allocate(r->request->context, bundle->count + 1, sizeof *r->names);
  if (r->names == NULL) return hl_fail_memory(error, bundle->count * sizeof *r->names, bundle->path);
  *count = 0;
  for (size_t n = 0; n < bundle->count; n++)
    if (hl_slice_is_named(bundle->entries[n].name) && cut_name(&bundle->entries[n], &r->names[*count]))
      ++*count;
  qsort(r->names, *count, sizeof *r->names, by_series_and_number);
  return HL_OK;
}

/* Chooses the series with the most files. */
static void choose_series(slices_reading *r, size_t count) {
  size_t series = 0;
  for (size_t begin = 0, end; begin < count; begin = end, series++) {
    for (end = begin + 1; end < count && compare_series(&r->names[begin], &r->names[end]) == 0;) end++;
    if (end - begin > r->count) r->first = begin, r->count = end - begin;
  }
  if (series > 1)
    hl_log(
        r->request->context, HL_LOG_WARNING,
        "%s: of %zu series of numbered pictures, the longest is taken, %zu from %s on: give a folder of one",
        r->bundle->path, series, r->count, r->names[r->first].entry->name);
}

static const numbered_name *name_of(const slices_reading *r, size_t slice) {
  return &r->names[r->first + slice];
}

static void tell_gaps(const slices_reading *r) {
  uint64_t span = name_of(r, r->count - 1)->number - name_of(r, 0)->number, step = span;
  for (size_t n = 1; n < r->count; n++) {
    uint64_t here = name_of(r, n)->number - name_of(r, n - 1)->number;
    if (here < step) step = here;
  }
  if (step == 0 || span == step * (r->count - 1)) return;
  hl_log(r->request->context, HL_LOG_WARNING,
         "%s: %llu numbers are missing between the pictures %llu and %llu: those that are there lie side by "
         "side",
         r->bundle->path, (unsigned long long)(span / step + 1 - r->count),
         (unsigned long long)name_of(r, 0)->number, (unsigned long long)name_of(r, r->count - 1)->number);
}

/* ---- files ---- */

/* Reads a picture's file into memory. file->bytes is owned by the caller, also after a failure. path: [size];
 * memory for the file's name. */
static hl_status read_file(const slices_reading *r, size_t slice, bool quiet, char *path, size_t size,
                           hl_slice_file *file, hl_error *error) {
  const hl_bundle_entry *entry = name_of(r, slice)->entry;
  hl_source *source = NULL;
  snprintf(path, size, "%s/%s", r->bundle->path, entry->name);
  *file = (hl_slice_file){.context = r->request->context, .path = path};
  hl_status status = hl_bundle_entry_open(r->bundle, entry, quiet, &source, error);
  if (status != HL_OK) return status;
  unsigned char *bytes = NULL;
  status = hl_source_read_whole(source, path, FILE_BYTES_MOST, &bytes, &file->length, error);
  file->bytes = bytes;
  hl_source_close(source);
  return status;
}

enum { PATH_BYTES = 4096 };

static hl_status read_slice(void *data, size_t slice, int worker, hl_error *error) {
  slices_reading *r = data;
  hl_slice_file file;
  char path[PATH_BYTES];
  size_t count = r->shape.width * r->shape.height;
  void *voxels;
  (void)worker;
  if (!hl_destination_wants(&r->to, slice * count, count)) return HL_OK;
  hl_status status = read_file(r, slice, slice > 0, path, sizeof path, &file, error);
  if (status == HL_OK) status = hl_destination_take(&r->to, slice * count, count, &voxels, error);
  if (status == HL_OK) {
    file.exact = &r->to.exact;
    file.first = slice * count;
    status = hl_slice_decode(&file, &r->shape, r->component, voxels, error);
    hl_destination_put(&r->to, slice * count, count, voxels);
  }
  hl_release(file.context, (void *)file.bytes);
  return status;
}

/* Checks, before the volume's memory is allocated, that each picture's file is long enough for the size that
 * its header promises. */
static hl_status measure(slices_reading *r, hl_slice_stack *stack, hl_error *error) {
  hl_slice_file file;
  char path[PATH_BYTES];
  hl_status status = read_file(r, 0, false, path, sizeof path, &file, error);
  if (status == HL_OK) status = hl_slice_find_stack(&file, stack, error);
  if (status == HL_OK && *stack == HL_SLICE_ALONE) status = hl_slice_measure(&file, &r->shape, error);
  hl_release(file.context, (void *)file.bytes);
  for (size_t n = 1; n < r->count && status == HL_OK && *stack == HL_SLICE_ALONE; n++) {
    hl_slice_shape shape;
    if (hl_cancelled(file.context))
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", r->bundle->path);
    uint64_t size = name_of(r, n)->entry->size, least = name_of(r, 0)->entry->size;
    if (size >= least / 64)
      continue; /* a file that is not much shorter than the first picture's file needs no check */
    status = read_file(r, n, true, path, sizeof path, &file, error);
    if (status == HL_OK) status = hl_slice_measure(&file, &shape, error);
    hl_release(file.context, (void *)file.bytes);
  }
  return status;
}

/* ---- the volume ---- */

/* Finds whether the pictures are grey although they are stored in colours: whether red, green and blue are
 * equal in each pixel of the middle slice. */
static hl_status find_grey(slices_reading *r, bool *is_grey, hl_error *error) {
  hl_context *context = r->request->context;
  size_t bytes = r->shape.width * r->shape.height * hl_storage_bytes(hl_voxel_type_storage(r->shape.type));
  hl_slice_file file = {.context = context};
  char path[PATH_BYTES];
  *is_grey = false;
  if (r->shape.samples != 3 || r->request->component != HL_COMPONENT_DEFAULT) return HL_OK;
  unsigned char *colors = hl_allocate(context, bytes, 3);
  if (colors == NULL) return hl_fail_memory(error, 3 * bytes, r->bundle->path);
  hl_status status = read_file(r, r->count / 2, true, path, sizeof path, &file, error);
  for (int n = 0; n < 3 && status == HL_OK; n++)
    status = hl_slice_decode(&file, &r->shape, n, colors + (size_t)n * bytes, error);
  *is_grey = status == HL_OK && memcmp(colors, colors + bytes, bytes) == 0 &&
             memcmp(colors, colors + 2 * bytes, bytes) == 0;
  hl_release(context, (void *)file.bytes);
  hl_release(context, colors);
  return status;
}

static hl_status read_voxels(slices_reading *r, hl_error *error) {
  hl_context *context = r->request->context;
  hl_pool *pool = NULL;
  bool parallel = r->shape.width * r->shape.height * r->to.voxel_bytes * r->count >= PARALLEL_BYTES;
  hl_status status = hl_pool_create(context, parallel ? 0 : 1, &pool, error);
  if (status == HL_OK)
    status = hl_parallel_read(context, pool, r->bundle->path, r->count, read_slice, r, error);
  hl_pool_destroy(pool);
  return status;
}

static hl_status load_slices(slices_reading *r, hl_volume **volume, hl_error *error) {
  const char *path = r->bundle->path;
  hl_payload payload;
  bool is_grey = false;
  hl_payload_defaults(&payload);
  payload.grid.dimensions[0] = r->shape.width;
  payload.grid.dimensions[1] = r->shape.height;
  payload.grid.dimensions[2] = r->count;
  payload.grid.type = r->shape.type;
  payload.block = 1;
  tell_gaps(r);
  hl_status status = hl_volume_check_grid(&payload.grid, path, error);
  if (status == HL_OK) status = find_grey(r, &is_grey, error);
  payload.components = is_grey ? 1 : r->shape.samples;
  if (r->shape.colors) payload.colors = HL_COLORS_MEANT;
  if (status == HL_OK) status = hl_component_only(r->request, path, false, &payload, error);
  if (status != HL_OK) return status;
  r->component = payload.component;
  hl_volume_description grid = hl_payload_grid(&payload, r->request->spacing);
  bool colors = hl_component_is_colors(r->component);
  status = hl_destination_open(r->request->context, &grid,
                               colors ? HL_DESTINATION_COLORS : HL_DESTINATION_PIECES, path, &r->to, error);
  if (status == HL_OK) status = read_voxels(r, error);
  if (status != HL_OK) return status;
  const hl_color_source source = {&grid, path, r->shape.samples, r->component, r->shape.premultiplied};
  return colors ? hl_destination_adopt_colors(&r->to, &source, volume, error)
                : hl_destination_adopt(&r->to, &grid, volume, error);
}

/* Reads a TIFF file of an archive as a volume, after unpacking it into memory. */
static hl_status load_packed(slices_reading *r, size_t slice, hl_volume **volume, hl_error *error) {
  hl_stream *stream = NULL;
  hl_slice_file file;
  char path[PATH_BYTES];
  hl_status status = read_file(r, slice, true, path, sizeof path, &file, error);
  if (status == HL_OK)
    status = hl_stream_open_memory(file.context, path, file.bytes, file.length, &stream, error);
  if (status == HL_OK) status = hl_tiff_load(&stream, r->bundle, r->request, volume, error);
  hl_stream_close(stream);
  hl_release(file.context, (void *)file.bytes);
  return status;
}

/* Reads the TIFF file of a time step as a volume. */
static hl_status load_file(slices_reading *r, size_t slice, hl_volume **volume, hl_error *error) {
  hl_stream *stream = NULL;
  if (r->bundle->is_archive) return load_packed(r, slice, volume, error);
  char *path = hl_path_join(r->request->context, r->bundle->path, name_of(r, slice)->entry->name);
  if (path == NULL) return hl_fail_memory(error, PATH_BYTES, r->bundle->path);
  hl_status status = hl_stream_open(r->request->context, path, true, &stream, error);
  if (status == HL_OK) status = hl_tiff_load(&stream, NULL, r->request, volume, error);
  hl_stream_close(stream);
  hl_release(r->request->context, path);
  return status;
}

/* Loads one of the TIFF files that are volumes of their own, as time steps. Each file of an OME-TIFF data set
 * names all other files of the set. */
static hl_status load_stack(slices_reading *r, hl_slice_stack stack, hl_volume **volume, hl_error *error) {
  hl_load_request *request = r->request;
  if (stack == HL_SLICE_OF_OME) return load_file(r, 0, volume, error);
  hl_status status = hl_steps_choose(request, r->bundle->path, r->count, 1, error);
  if (status != HL_OK) return status;
  hl_selection selection = request->selection;
  char told[sizeof request->selection_told];
  memcpy(told, request->selection_told, sizeof told);
  request->time = HL_INDEX_DEFAULT;
  status = load_file(r, (size_t)selection.time, volume, error);
  request->selection = selection;
  memcpy(request->selection_told, told, sizeof told);
  return status;
}

static hl_status load_bundle(hl_bundle *bundle, hl_load_request *request, bool *claimed, hl_volume **volume,
                             hl_error *error) {
  slices_reading r = {.request = request, .bundle = bundle};
  size_t count = 0;
  hl_slice_stack stack = HL_SLICE_ALONE;
  hl_status status = hl_bundle_list(bundle, error);
  if (status == HL_OK) status = list_names(&r, &count, error);
  if (status == HL_OK) choose_series(&r, count);
  *claimed = status != HL_OK || r.count > 1;
  if (status == HL_OK && *claimed) status = measure(&r, &stack, error);
  if (status == HL_OK && *claimed)
    status = stack == HL_SLICE_ALONE ? load_slices(&r, volume, error) : load_stack(&r, stack, volume, error);
  hl_release(request->context, r.names);
  hl_destination_close(&r.to);
  return status;
}

const hl_format hl_format_slices = {.title = "folders of slices", .load_bundle = load_bundle};
