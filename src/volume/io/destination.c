/* volume/io/destination.c - stores the voxels that a reader gives, as destination.h describes. */
#include "volume/io/destination.h"

#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "platform/memory.h"
#include "volume/brick_bounds.h"
#include "volume/convert.h"

/* The least size in bytes of a volume that is spread over ranks. Smaller volumes, such as most label maps,
 * are stored as a whole in the memory of every rank. */
enum { LEAST_OVER_RANKS = 1 << 20 };

/* Warns, before a file is read, if the volume will be too large for renderers. A renderer takes memory for
 * each brick: its bounds, a flag and a number of 32 bits (grid/bounds.h). */
static void warn_of_pictures(hl_context *context, const hl_volume_description *grid, const char *path) {
  double bricks = 1, limit = (double)context->options.memory_limit;
  for (int axis = 0; axis < 3; axis++) bricks *= (double)(grid->dimensions[axis] / BRICK_SIDE + 1);
  double bytes = bricks *
                 (double)(2 * hl_storage_bytes(hl_voxel_type_storage(grid->type)) + 1 + sizeof(uint32_t));
  if (bricks > (double)UINT32_MAX)
    hl_log(context, HL_LOG_WARNING,
           "%.300s: a picture of it will be refused: it has %.3g bricks of 4 x 4 x 4 voxels, and %u can be "
           "numbered",
           path, bricks, UINT32_MAX);
  else if (bytes > limit)
    hl_log(context, HL_LOG_WARNING,
           "%.300s: a picture of it will need more than %.0f MiB for the bounds of its bricks, and the "
           "memory limit "
           "is %.0f MiB",
           path, bytes / (1 << 20), limit / (1 << 20));
}

/* Finds the numbers of this rank's first voxel and of the voxel after its last one. A rank's voxels have
 * consecutive numbers, because they form whole slices. */
static void own_range(const hl_own_voxels *own, size_t *begin, size_t *end) {
  size_t slice = own->box.count[0] * own->box.count[1];
  *begin = own->box.begin[2] * slice;
  *end = *begin + own->box.count[2] * slice;
}

hl_status hl_destination_open(hl_context *context, const hl_volume_description *grid,
                              hl_destination_kind kind, const char *path, hl_destination *destination,
                              hl_error *error) {
  size_t count = grid->dimensions[0] * grid->dimensions[1] * grid->dimensions[2];
  size_t bytes = kind == HL_DESTINATION_COLORS ? HL_COLOR_BYTES
                                               : hl_storage_bytes(hl_voxel_type_storage(grid->type));
  *destination = (hl_destination){.context = context, .path = path, .voxel_bytes = bytes};
  hl_exact_begin(context, kind == HL_DESTINATION_COLORS ? HL_VOXEL_U8 : grid->type, count, HL_EXACT_IN_MEMORY,
                 &destination->exact);
  if (kind == HL_DESTINATION_PIECES && context->ranks != NULL && count >= LEAST_OVER_RANKS / bytes) {
    hl_status status = hl_own_voxels_allocate(context->ranks, grid, &destination->own, error);
    if (status != HL_OK) return status;
    own_range(destination->own, &destination->exact.first, &count);
    destination->exact.count = count - destination->exact.first;
    return HL_OK;
  }
  if (kind == HL_DESTINATION_PIECES && hl_pages_wanted(context, grid)) {
    warn_of_pictures(context, grid, path);
    destination->exact.place = HL_EXACT_IN_FILE;
    return hl_pages_create(context, context->options.scratch_folder, grid, PAGE_SHIFT, &destination->pages,
                           error);
  }
  destination->voxels = hl_allocate(context, count, bytes);
  return destination->voxels != NULL ? HL_OK : hl_fail_memory(error, count * bytes, path);
}

/* ---- sparse pages ---- */

/* CROWDED: the greatest fraction of a volume's pages that sparse pages hold. If more pages are stored, the
 * voxels are moved into one array, because pages are slower to sample. Moving a quarter of the voxels takes
 * little time compared with reading all voxels. LEAST_SPARSE: the least size in bytes of a volume in sparse
 * pages. For smaller volumes, sparse pages would save too little memory. */
#define CROWDED 0.25
enum { LEAST_SPARSE = 4 << 20 };

/* Returns whether floats may round numbers of the type, so that the numbers may be kept in an array beside
 * the voxels (exact.h). */
static bool may_be_rounded(hl_voxel_type type) {
  return hl_voxel_type_storage(type) == HL_STORAGE_F32 && type != HL_VOXEL_F16 && type != HL_VOXEL_F32;
}

/* Returns whether memory has room for one array beside the sparse pages that are moved into it. If the caller
 * sets no memory limit, the limit is the machine's memory, because a file's header may promise a volume that
 * is larger than any memory. */
static bool has_room_to_spread(const hl_context *context, double bytes) {
  const double limit = (double)context->options.memory_limit,
               taken = (double)atomic_load(&context->whole->held) +
                       (double)atomic_load(&context->whole->paged),
               machine = (double)hl_machine_memory();
  return taken + bytes * (1 + 2 * CROWDED) <= (limit > 0 ? limit : machine);
}

/* Returns whether a volume may be stored in sparse pages. A machine with addresses of 32 bits does not have
 * enough addresses for pages that stay empty. */
static bool may_be_sparse(const hl_context *context, const hl_volume_description *grid) {
  const double bytes = (double)grid->dimensions[0] * (double)grid->dimensions[1] *
                       (double)grid->dimensions[2] *
                       (double)hl_storage_bytes(hl_voxel_type_storage(grid->type));
  return sizeof(void *) > 4 && context->ranks == NULL && !hl_pages_wanted(context, grid) &&
         !may_be_rounded(grid->type) && bytes >= LEAST_SPARSE && has_room_to_spread(context, bytes);
}

hl_status hl_destination_open_sparse(hl_context *context, const hl_volume_description *grid,
                                     const void *value, const char *path, hl_destination *destination,
                                     hl_error *error) {
  if (!may_be_sparse(context, grid))
    return hl_destination_open(context, grid, HL_DESTINATION_PIECES, path, destination, error);
  const size_t bytes = hl_storage_bytes(hl_voxel_type_storage(grid->type));
  *destination = (hl_destination){.context = context, .path = path, .voxel_bytes = bytes};
  hl_exact_begin(context, grid->type, 0, HL_EXACT_IN_MEMORY, &destination->exact);
  return hl_pages_create_sparse(context, grid, PAGE_SHIFT, value, &destination->pages, error);
}

bool hl_destination_is_crowded(const hl_destination *destination) {
  return hl_destination_is_sparse(destination) && hl_pages_share(destination->pages) > CROWDED;
}

hl_status hl_destination_spread(hl_destination *destination, hl_error *error) {
  const hl_pages *pages = destination->pages;
  const size_t *n = pages->dimension, row = n[0] * destination->voxel_bytes, rows = n[1] * n[2];
  unsigned char *voxels = hl_allocate(destination->context, rows, row);
  if (voxels == NULL) return hl_fail_memory(error, rows * row, destination->path);
  hl_pages_spread(destination->pages, voxels);
  hl_pages_release(destination->pages);
  destination->pages = NULL;
  destination->voxels = voxels;
  return HL_OK;
}

hl_status hl_destination_take(hl_destination *destination, size_t first, size_t count, void **place,
                              hl_error *error) {
  size_t bytes = destination->voxel_bytes;
  *place = hl_destination_is_apart(destination) ? hl_allocate(destination->context, count, bytes)
                                                : destination->voxels + first * bytes;
  return *place != NULL ? HL_OK : hl_fail_memory(error, count * bytes, destination->path);
}

bool hl_destination_wants(const hl_destination *destination, size_t first, size_t count) {
  size_t begin, end;
  if (destination->own == NULL) return true;
  own_range(destination->own, &begin, &end);
  return first < end && first + count > begin;
}

void hl_destination_store(hl_destination *destination, size_t first, size_t count, const void *values) {
  size_t begin, end, bytes = destination->voxel_bytes;
  if (destination->pages != NULL) hl_pages_store(destination->pages, first, count, values);
  if (destination->own == NULL || !hl_destination_wants(destination, first, count)) return;
  own_range(destination->own, &begin, &end);
  size_t from = first > begin ? first : begin, to = first + count < end ? first + count : end;
  memcpy(destination->own->slices + (from - begin) * bytes,
         (const unsigned char *)values + (from - first) * bytes, (to - from) * bytes);
}

void hl_destination_put(hl_destination *destination, size_t first, size_t count, void *place) {
  if (!hl_destination_is_apart(destination) || place == NULL) return;
  hl_destination_store(destination, first, count, place);
  hl_release(destination->context, place);
}

hl_status hl_destination_adopt(hl_destination *destination, const hl_volume_description *grid,
                               hl_volume **volume, hl_error *error) {
  const hl_destination given = *destination;
  const unsigned char *voxels = given.own != NULL ? given.own->slices : given.voxels;
  void *exact = NULL;
  if (given.own != NULL && given.exact.rounds)
    hl_log(given.context, HL_LOG_WARNING,
           "%s: values above 2^24 are rounded to 24 bits, as the volume is spread over processes: read it by "
           "one "
           "for exact ones (its labels are exact)",
           given.path);
  hl_status status = hl_destination_is_sparse(destination) ? HL_OK
                     : given.pages != NULL
                         ? hl_exact_take_file(&destination->exact, &given.pages->exact_file, error)
                         : hl_exact_take(&destination->exact, (const float *)(const void *)voxels, &exact,
                                         error);
  if (status != HL_OK) return status;
  destination->voxels = NULL;
  destination->pages = NULL;
  destination->own = NULL;
  if (given.own != NULL) given.own->exact = exact;
  if (given.own != NULL)
    return hl_volume_over_ranks(given.context->ranks, grid, given.own, PAGE_SHIFT, given.path, volume, error);
  return given.pages != NULL
             ? hl_volume_adopt_pages(given.context, grid, given.path, given.pages, volume, error)
             : hl_volume_adopt_exact(given.context, grid, given.path, given.voxels, exact, volume, error);
}

hl_status hl_destination_adopt_colors(hl_destination *destination, const hl_color_source *source,
                                      hl_volume **volume, hl_error *error) {
  unsigned char *colors = destination->voxels;
  destination->voxels = NULL;
  return hl_volume_adopt_colors(destination->context, source, colors, volume, error);
}

void hl_destination_close(hl_destination *destination) {
  hl_release(destination->context, destination->voxels);
  if (destination->context != NULL) hl_exact_release(&destination->exact);
  hl_pages_release(destination->pages);
  hl_own_voxels_release(destination->own);
  *destination = (hl_destination){.context = NULL};
}
