/* volume/formats/tiff/tiff_load.c - makes a volume of the pages of a TIFF file.
 *
 * libtiff decodes the pages (tiff_file.h), and tiff_plan.h finds their order. Slices are decoded in parallel.
 * Each thread opens a tiff_file of its own. */
#include "volume/formats/tiff/tiff.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/pool.h"
#include "volume/formats/tiff/tiff_file.h"
#include "volume/formats/tiff/tiff_imagej.h"
#include "volume/formats/tiff/tiff_plan.h"
#include "volume/io/destination.h"
#include "volume/io/parallel.h"

enum {
  PARALLEL_BYTES = 1 << 20, /* smaller volumes are read by one thread, because starting more threads would
                             * take longer */
};

/* A file, and the offsets of its directories. */
typedef struct stack_file {
  char *path;                  /* owned */
  const unsigned char *memory; /* [memory_size]; the file's content; null if the file is read */
  unsigned char *unpacked;     /* owned; equal to `memory` if the content was read into memory from a pipe or
                                * an archive; else null */
  size_t memory_size;
  uint64_t *offsets; /* owned; [count] */
  size_t count;
} stack_file;

typedef struct stack_reading {
  hl_context *context;
  hl_load_request *request;
  const hl_bundle *archive; /* the archive that contains the files; null if the files are in a folder */
  tiff_plan plan;
  stack_file *files; /* owned; [plan.file_count] */
  int level;
  uint64_t plain, plain_bytes; /* if all slices are uncompressed and follow each other: position of the first
                                * slice's pixels, and bytes of a slice. plain and plain_bytes are 0 if libtiff
                                * is to decode each slice from a page */
  tiff_shape shape;            /* shape of each slice at the chosen level */
  uint32_t width, height;      /* size at level 0 */
  int component;
  hl_destination to;
  struct {
    hl_pool *pool;
    tiff_file *open;  /* owned; [threads]; the file that each thread has open */
    uint32_t *opened; /* owned; [threads]; the index of the file that each thread has open; UINT32_MAX if the
                       * thread has no open file */
  } threads;
} stack_reading;

/* ---- the first file: its pages, and what its first page says ---- */

static void read_resolution(tiff_file *file, double resolution[2]) {
  float x = 0, y = 0;
  TIFFGetField(file->tiff, TIFFTAG_XRESOLUTION, &x);
  TIFFGetField(file->tiff, TIFFTAG_YRESOLUTION, &y);
  resolution[0] = isfinite((double)x) && x > 0 ? (double)x : 0;
  resolution[1] = isfinite((double)y) && y > 0 ? (double)y : 0;
}

/* Removes from the list pages whose shape differs from the first page's shape, and pages that are reduced
 * copies of other pages. */
static hl_status drop_other_pages(tiff_file *file, const tiff_shape *first, stack_file *stack,
                                  hl_error *error) {
  size_t kept = 0, others = 0;
  hl_status status = HL_OK;
  for (size_t n = 0; n < stack->count && status == HL_OK; n++) {
    uint32_t kind = 0;
    tiff_shape shape;
    status = tiff_file_go(file, stack->offsets[n], 0, error);
    if (status != HL_OK) return status;
    TIFFGetField(file->tiff, TIFFTAG_SUBFILETYPE, &kind);
    bool same = tiff_file_shape(file, &shape, NULL) == HL_OK && tiff_shapes_equal(&shape, first);
    bool reduced = (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
    others += !same && !reduced;
    if (same && !reduced) stack->offsets[kept++] = stack->offsets[n];
  }
  if (kept == 0) stack->offsets[kept++] = stack->offsets[0];
  if (others > 0)
    hl_log(file->context, HL_LOG_WARNING,
           "%.300s: %zu of %zu pages have another size or type than the first: they are left out", file->path,
           others, stack->count);
  stack->count = kept;
  return status;
}

/* The number of resolutions of the current page: the page itself and its reduced pictures. */
static size_t count_levels(tiff_file *file) {
  uint16_t count = 0;
  uint64_t *offsets = NULL;
  return TIFFGetField(file->tiff, TIFFTAG_SUBIFD, &count, &offsets) ? (size_t)count + 1 : 1;
}

/* Chooses the level, and sets the shape that pages have at this level. */
static hl_status choose_level(stack_reading *r, tiff_file *file, uint64_t offset, size_t count,
                              hl_error *error) {
  hl_level_size *sizes = hl_allocate_zeroed(r->context, count, sizeof *sizes);
  if (sizes == NULL) return hl_fail_memory(error, count * sizeof *sizes, file->path);
  hl_status status = HL_OK;
  for (size_t level = 0; level < count && status == HL_OK; level++) {
    tiff_shape shape;
    status = tiff_file_go(file, offset, (int)level, error);
    if (status == HL_OK) status = tiff_file_shape(file, &shape, error);
    if (status == HL_OK)
      sizes[level] = (hl_level_size){{shape.width, shape.height, r->plan.slice_count}, shape.type};
  }
  if (status == HL_OK) status = hl_level_choose(r->request, file->path, sizes, count, error);
  r->level = r->request->selection.level;
  hl_release(r->context, sizes);
  if (status == HL_OK) status = tiff_file_go(file, offset, r->level, error);
  return status == HL_OK ? tiff_file_shape(file, &r->shape, error) : status;
}

static hl_status check_size(const stack_reading *r, tiff_file *file, hl_error *error) {
  if (tiff_file_can_hold(file, &r->shape)) return HL_OK;
  return hl_fail(
      error, HL_ERROR_INPUT,
      "%s: a page promises %u x %u pixels of %u samples of %u bits, more than the file's %llu bytes can "
      "hold",
      file->path, r->shape.width, r->shape.height, r->shape.components, r->shape.bits,
      (unsigned long long)file->size);
}

/* Finds out whether the pixels of all slices follow the first page's pixels, although the file has a
 * directory for the first page only. ImageJ writes files of more than 4 GB with a directory for the first
 * page only, and tifffile can do so, too. The slices of a page with several slices also follow each other,
 * unless the page is tiled. *pages: set to the number of all slices. */
static hl_status find_plain(stack_reading *r, tiff_file *file, const tiff_shape *shape,
                            const char *description, const stack_file *stack, size_t *pages,
                            hl_error *error) {
  size_t told = tiff_plan_pages(description, shape->components);
  bool deep = shape->depth > 1 && !TIFFIsTiled(file->tiff);
  if (stack->count != 1 || (told <= *pages && !deep)) return HL_OK;
  hl_status status = tiff_file_go(file, stack->offsets[0], 0, error);
  if (status != HL_OK) return status;
  uint64_t bytes, first = tiff_file_plain(file, shape, &bytes), wanted;
  size_t count = told > *pages ? told : *pages;
  bool fits = first > 0 && first <= file->size && !__builtin_mul_overflow(bytes, (uint64_t)count, &wanted) &&
              wanted <= file->size - first;
  if (!fits && deep)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: a page of %u slices (ImageDepth) in compressed strips: save it in tiles, or uncompressed",
        file->path, shape->depth);
  if (!fits) {
    hl_log(r->context, HL_LOG_WARNING,
           "%.300s: its description promises %zu pictures, and the file has one page: that one is taken",
           file->path, told);
    return HL_OK;
  }
  r->plain = first;
  r->plain_bytes = bytes;
  *pages = count;
  return HL_OK;
}

/* Copies the colours and windows of channels from ImageJ's tag, if the tag has colours and windows for all
 * channels. */
static hl_status take_imagej(stack_reading *r, const hl_channel *channels, size_t count, hl_error *error) {
  if (count == 0 || count != r->request->selection.channels) return HL_OK;
  hl_status status = hl_channels_make(r->request, error);
  if (status == HL_OK) memcpy(r->request->channels, channels, count * sizeof *channels);
  return status;
}

/* Reads the first file's pages, and plans the volume. stack: the first file, which becomes r->files[0]. */
static hl_status read_first(stack_reading *r, tiff_file *file, stack_file *stack, hl_error *error) {
  tiff_shape first;
  char *description = NULL, *copy = NULL;
  double resolution[2];
  hl_status status = tiff_file_shape(file, &first, error);
  uint64_t start = TIFFCurrentDirOffset(file->tiff);
  read_resolution(file, resolution);
  size_t levels = count_levels(file);
  hl_channel channels[TIFF_IMAGEJ_CHANNELS_MOST];
  size_t channel_count = tiff_imagej_channels(file, channels);
  if (status == HL_OK && TIFFGetField(file->tiff, TIFFTAG_IMAGEDESCRIPTION, &description)) {
    copy = hl_copy_text(r->context, description);
    if (copy == NULL) status = hl_fail_memory(error, strlen(description) + 1, file->path);
  }
  if (status == HL_OK) status = tiff_file_pages(file, &stack->offsets, &stack->count, error);
  bool ome = copy != NULL && strstr(copy, "<OME") != NULL;
  if (status == HL_OK && !ome) status = drop_other_pages(file, &first, stack, error);
  size_t pages = stack->count * first.depth;
  if (status == HL_OK) status = find_plain(r, file, &first, copy, stack, &pages, error);
  if (status == HL_OK)
    status = tiff_plan_make(r->request, file->path, copy, pages, first.components, first.depth, resolution,
                            &r->plan, error);
  if (status == HL_OK && !ome) status = take_imagej(r, channels, channel_count, error);
  if (status == HL_OK) {
    r->width = first.width, r->height = first.height;
    r->files = hl_allocate_zeroed(r->context, r->plan.file_count, sizeof *r->files);
    if (r->files == NULL) status = hl_fail_memory(error, r->plan.file_count * sizeof *r->files, file->path);
  }
  if (status == HL_OK) {
    r->files[0] = *stack;
    *stack = (stack_file){.path = NULL};
  }
  if (status == HL_OK) status = choose_level(r, file, start, levels, error);
  if (status == HL_OK) status = check_size(r, file, error);
  hl_release(r->context, copy);
  return status;
}

/* ---- the other files ---- */

/* Unpacks a file of the archive into memory. The first file is already in memory. */
static hl_status unpack(stack_reading *r, stack_file *stack, hl_error *error) {
  const char *name = stack->path + strlen(r->archive->path) + 1;
  hl_source *source = NULL;
  hl_status status = hl_bundle_find(r->archive, name, true, &source, error);
  if (status == HL_OK && source == NULL)
    return hl_fail(error, HL_ERROR_IO, "%s: cannot open: the archive has no such file", stack->path);
  if (status == HL_OK)
    status = hl_source_read_whole(source, stack->path, SIZE_MAX, &stack->unpacked, &stack->memory_size,
                                  error);
  stack->memory = stack->unpacked;
  hl_source_close(source);
  return status;
}

static hl_status find_pages(stack_reading *r, size_t index, hl_error *error) {
  stack_file *stack = &r->files[index];
  tiff_file file = {.descriptor = -1};
  char *folder = hl_path_folder(r->context, r->files[0].path);
  stack->path = folder == NULL ? NULL : hl_path_join(r->context, folder, r->plan.files[index]);
  hl_release(r->context, folder);
  if (stack->path == NULL) return hl_fail_memory(error, 100, r->plan.files[index]);
  hl_status status = r->archive != NULL ? unpack(r, stack, error) : HL_OK;
  if (status == HL_OK)
    status = tiff_file_open(r->context, stack->path, stack->memory, stack->memory_size, false, &file, error);
  if (status == HL_OK) status = tiff_file_pages(&file, &stack->offsets, &stack->count, error);
  tiff_file_close(&file);
  return status;
}

/* Checks that the page of each slice exists in the slice's file. */
static hl_status check_slices(const stack_reading *r, hl_error *error) {
  for (size_t z = 0; z < r->plan.slice_count; z++) {
    const tiff_slice *slice = &r->plan.slices[z];
    const stack_file *file = &r->files[slice->file];
    if (slice->is_there && r->plain == 0 && slice->page / r->shape.depth >= file->count)
      return hl_fail(error, HL_ERROR_INPUT, "%s: slice %zu is page %u, the file has %zu: is it cut short?",
                     file->path, z, slice->page + 1, file->count);
  }
  return HL_OK;
}

/* ---- slices ---- */

static size_t slice_voxels(const stack_reading *r) { return (size_t)r->shape.width * r->shape.height; }

static hl_status decode_slice(stack_reading *r, size_t z, int worker, void *voxels, hl_error *error) {
  const tiff_slice *slice = &r->plan.slices[z];
  if (!slice->is_there) {
    memset(voxels, 0, slice_voxels(r) * r->to.voxel_bytes);
    return HL_OK;
  }
  tiff_file *file = &r->threads.open[worker];
  stack_file *stack = &r->files[slice->file];
  hl_status status = HL_OK;
  if (r->threads.opened[worker] != slice->file) {
    tiff_file_close(file);
    r->threads.opened[worker] = slice->file;
    file->warnings = TIFF_NO_WARNINGS; /* libtiff's warnings were logged when the file was opened for the
                                        * first time */
    status = tiff_file_open(r->context, stack->path, stack->memory, stack->memory_size, true, file, error);
    if (status != HL_OK) r->threads.opened[worker] = UINT32_MAX;
  }
  tiff_shape shape;
  size_t page = r->plain > 0 ? 0 : slice->page / r->shape.depth;
  if (status == HL_OK) status = tiff_file_go(file, stack->offsets[page], r->level, error);
  if (status == HL_OK) status = tiff_file_shape(file, &shape, error);
  if (status == HL_OK && !tiff_shapes_equal(&shape, &r->shape))
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: slice %zu has %u x %u pixels of %u samples of %u bits, the first %u x %u, %u, %u",
                   stack->path, z, shape.width, shape.height, shape.components, shape.bits, r->shape.width,
                   r->shape.height, r->shape.components, r->shape.bits);
  const tiff_target target = {voxels, &r->to.exact, z * slice_voxels(r), slice->page % r->shape.depth,
                              r->plain > 0 ? r->plain + slice->page * r->plain_bytes : 0};
  return status == HL_OK ? tiff_file_read(file, &shape, r->component, &target, error) : status;
}

static hl_status read_slice(void *data, size_t z, int worker, hl_error *error) {
  stack_reading *r = data;
  size_t count = slice_voxels(r);
  void *voxels;
  if (!hl_destination_wants(&r->to, z * count, count)) return HL_OK;
  hl_status status = hl_destination_take(&r->to, z * count, count, &voxels, error);
  if (status != HL_OK) return status;
  status = decode_slice(r, z, worker, voxels, error);
  hl_destination_put(&r->to, z * count, count, voxels);
  return status;
}

static hl_status make_threads(stack_reading *r, int *threads, hl_error *error) {
  bool parallel = r->plan.slice_count > 1 &&
                  slice_voxels(r) * r->to.voxel_bytes * r->plan.slice_count >= PARALLEL_BYTES;
  hl_status status = hl_pool_create(r->context, parallel ? 0 : 1, &r->threads.pool, error);
  if (status != HL_OK) return status;
  size_t count = (size_t)(*threads = hl_pool_threads(r->threads.pool));
  r->threads.open = hl_allocate_zeroed(r->context, count, sizeof *r->threads.open);
  r->threads.opened = hl_allocate(r->context, count, sizeof *r->threads.opened);
  if (r->threads.open == NULL || r->threads.opened == NULL)
    return hl_fail_memory(error, count * sizeof *r->threads.open, r->files[0].path);
  for (size_t n = 0; n < count; n++) {
    r->threads.open[n].descriptor = -1;
    r->threads.opened[n] = UINT32_MAX;
  }
  return HL_OK;
}

static hl_status read_slices(stack_reading *r, hl_error *error) {
  int threads = 0;
  hl_status status = make_threads(r, &threads, error);
  if (status == HL_OK)
    status = hl_parallel_read(r->context, r->threads.pool, r->files[0].path, r->plan.slice_count, read_slice,
                              r, error);
  for (int n = 0; n < threads && r->threads.open != NULL && r->threads.opened != NULL; n++)
    tiff_file_close(&r->threads.open[n]);
  hl_pool_destroy(r->threads.pool);
  hl_release(r->context, r->threads.open);
  hl_release(r->context, r->threads.opened);
  return status;
}

/* ---- the volume ---- */

/* Describes the volume's grid. An axis without a stated spacing gets the spacing of the first axis that has a
 * stated spacing. */
static void describe(const stack_reading *r, hl_payload *payload) {
  hl_volume_description *grid = &payload->grid;
  double known = 1;
  for (int axis = 2; axis >= 0; axis--)
    if (r->plan.spacing[axis] > 0) known = r->plan.spacing[axis];
  grid->dimensions[0] = r->shape.width;
  grid->dimensions[1] = r->shape.height;
  grid->dimensions[2] = r->plan.slice_count;
  grid->type = r->shape.type;
  const double coarser[3] = {(double)r->width / r->shape.width, (double)r->height / r->shape.height, 1};
  for (int axis = 0; axis < 3; axis++) {
    double step = (r->plan.spacing[axis] > 0 ? r->plan.spacing[axis] : known) * coarser[axis];
    grid->axis[axis][axis] = step;
    /* voxels of a coarser level are larger, but the grid begins at the same corner as at level 0 */
    grid->origin[axis] = (step - step / coarser[axis]) / 2;
  }
  payload->components = r->shape.components;
  if (r->shape.colors) payload->colors = HL_COLORS_MEANT;
  payload->block = 1;
}

static hl_status make_volume(stack_reading *r, hl_volume **volume, hl_error *error) {
  hl_payload payload;
  hl_payload_defaults(&payload);
  describe(r, &payload);
  const char *path = r->files[0].path;
  hl_status status = hl_volume_check_grid(&payload.grid, path, error);
  if (status == HL_OK) status = hl_component_only(r->request, path, false, &payload, error);
  if (status != HL_OK) return status;
  r->component = payload.component;
  hl_volume_description grid = hl_payload_grid(&payload, r->request->spacing);
  bool colors = hl_component_is_colors(r->component);
  status = hl_destination_open(r->context, &grid, colors ? HL_DESTINATION_COLORS : HL_DESTINATION_PIECES,
                               path, &r->to, error);
  if (status == HL_OK) status = read_slices(r, error);
  if (status != HL_OK) return status;
  const hl_color_source source = {&grid, path, r->shape.components, r->component, r->shape.premultiplied};
  return colors ? hl_destination_adopt_colors(&r->to, &source, volume, error)
                : hl_destination_adopt(&r->to, &grid, volume, error);
}

static void release_file(hl_context *context, stack_file *file) {
  hl_release(context, file->path);
  hl_release(context, file->unpacked);
  hl_release(context, file->offsets);
}

static void release(stack_reading *r) {
  for (size_t n = 0; r->files != NULL && n < r->plan.file_count; n++) release_file(r->context, &r->files[n]);
  hl_release(r->context, r->files);
  hl_destination_close(&r->to);
  tiff_plan_release(&r->plan);
}

/* Reads the first file's content into memory, unless the stream is a plain file or memory already. */
static hl_status take_first(hl_stream *stream, stack_file *first, hl_error *error) {
  first->path = hl_copy_text(stream->context, stream->path);
  if (first->path == NULL) return hl_fail_memory(error, strlen(stream->path), stream->path);
  if (hl_stream_memory(stream, &first->memory, &first->memory_size) || hl_stream_is_plain_file(stream))
    return HL_OK;
  hl_status status = hl_stream_read_rest(stream, &first->unpacked, &first->memory_size, error);
  first->memory = first->unpacked;
  return status;
}

hl_status hl_tiff_load(hl_stream **stream, const hl_bundle *archive, hl_load_request *request,
                       hl_volume **volume, hl_error *error) {
  stack_reading r = {.context = request->context, .request = request, .archive = archive};
  tiff_file file = {.descriptor = -1};
  stack_file first = {.path = NULL};
  hl_status status = take_first(*stream, &first, error);
  if (status == HL_OK)
    status = tiff_file_open(request->context, first.path, first.memory, first.memory_size, true, &file,
                            error);
  if (status == HL_OK) status = read_first(&r, &file, &first, error);
  tiff_file_close(&file);
  for (size_t n = 1; status == HL_OK && n < r.plan.file_count; n++) status = find_pages(&r, n, error);
  if (status == HL_OK) status = check_slices(&r, error);
  if (status == HL_OK) status = make_volume(&r, volume, error);
  release(&r);
  release_file(request->context, &first);
  return status;
}

const char *hl_tiff_missing(void) { return NULL; }
