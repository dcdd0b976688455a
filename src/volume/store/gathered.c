/* volume/store/gathered.c - see gathered.h. */
#include "volume/store/gathered.h"

#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/exact.h"
#include "volume/store/pages.h"

/* The state of making a copy of a label map over ranks in one array. */
typedef struct gathering {
  const hl_volume *map;
  const hl_own_voxels *own;
  hl_ranks *ranks;
  bool exact;           /* whether ranks send the file's own numbers instead of stored values */
  size_t sent_bytes;    /* size in bytes of a number that ranks send */
  unsigned char *slice; /* owned; one slice of a block, in the form in which ranks send it */
  unsigned char *sent; /* owned; [k][j][i]; the numbers that all ranks have sent: stored values, or the file's
                        * own numbers if `exact` */
} gathering;

/* Returns whether this rank has the file's own numbers of its block: either beside the stored values, or as
 * the caller's voxels. */
static bool has_numbers(const hl_own_voxels *own) { return own->exact != NULL || own->type != own->stored; }

static void pack_numbers(const gathering *g, const hl_box *slice, unsigned char *to) {
  const hl_own_voxels *own = g->own;
  const size_t width = slice->count[0], rows = slice->count[1], k = slice->begin[2] - own->box.begin[2];
  for (size_t j = 0; j < rows; j++, to += width * g->sent_bytes) {
    const size_t first = (k * rows + j) * width;
    if (own->exact != NULL)
      memcpy(to, (const unsigned char *)own->exact + first * g->sent_bytes, width * g->sent_bytes);
    else
      hl_voxels_gather(own->first + (ptrdiff_t)j * own->stride[1] + (ptrdiff_t)k * own->stride[2],
                       own->stride[0], g->sent_bytes, width, to);
  }
}

/* Packs a slice of this rank's block for the other ranks. If `exact`, all ranks send the file's own numbers.
 * A rank whose floats round none of its numbers has not kept the file's own numbers, and converts its floats
 * to the file's type. */
static void pack(const gathering *g, const hl_box *slice) {
  const size_t count = slice->count[0] * slice->count[1];
  if (g->exact && has_numbers(g->own)) {
    pack_numbers(g, slice, g->slice);
  } else if (g->exact) {
    const float *stored = (const float *)(const void *)g->own->slices;
    memset(g->slice, 0, count * g->sent_bytes);
    hl_exact_fill(g->map->type, stored + (slice->begin[2] - g->own->box.begin[2]) * count, count, g->slice);
  } else {
    hl_own_voxels_copy(g->own, slice, g->slice);
  }
}

static void unpack(const gathering *g, const hl_box *slice) {
  const size_t *n = g->map->dimension, row = slice->count[0] * g->sent_bytes;
  for (size_t j = 0; j < slice->count[1]; j++) {
    const size_t first = (slice->begin[2] * n[1] + slice->begin[1] + j) * n[0] + slice->begin[0];
    memcpy(g->sent + first * g->sent_bytes, g->slice + j * row, row);
  }
}

static void send_blocks(const gathering *g) {
  for (int rank = 0; rank < g->ranks->size; rank++) {
    hl_box box = g->own->box;
    hl_ranks_tell(g->ranks, &box, sizeof box, rank);
    for (uint64_t k = 0; k < box.count[2]; k++) {
      const hl_box slice = {{box.begin[0], box.begin[1], box.begin[2] + k}, {box.count[0], box.count[1], 1}};
      if (rank == g->ranks->rank) pack(g, &slice);
      hl_ranks_tell(g->ranks, g->slice, slice.count[0] * slice.count[1] * g->sent_bytes, rank);
      unpack(g, &slice);
    }
  }
}

static hl_status adopt(const hl_volume *map, void *voxels, void *numbers, hl_volume **whole,
                       hl_error *error) {
  hl_volume_description grid = hl_volume_own_grid(map);
  grid.type = map->type;
  grid.value_scale = map->value_scale;
  grid.value_offset = map->value_offset + map->value_scale * hl_voxel_type_bias(map->type);
  hl_status status = hl_volume_adopt_exact(map->context, &grid, "a label map", voxels, numbers, whole, error);
  if (status == HL_OK) (*whole)->index_to_world = map->index_to_world;
  return status;
}

/* Makes the volume of the numbers that all ranks have sent. */
static hl_status finish(gathering *g, hl_volume **whole, hl_error *error) {
  const size_t count = hl_volume_voxel_count(g->map);
  void *sent = g->sent;
  g->sent = NULL;
  if (!g->exact) return adopt(g->map, sent, NULL, whole, error);
  float *voxels = hl_allocate(g->map->context, count, sizeof *voxels);
  if (voxels != NULL) {
    hl_voxels_store(g->map->type, false, sent, count, voxels);
    return adopt(g->map, voxels, sent, whole, error);
  }
  hl_release(g->map->context, sent);
  return hl_fail_memory(error, count * sizeof *voxels, "a label map, which each process holds whole");
}

/* Returns whether `own` is true on at least one rank. All ranks must call any_rank(). */
static bool any_rank(hl_ranks *ranks, bool own) {
  uint64_t count = own;
  hl_ranks_sum_counts(ranks, &count, 1);
  return count > 0;
}

static hl_status gather(const hl_volume *map, hl_volume **whole, hl_error *error) {
  hl_context *context = map->context;
  gathering g = {.map = map, .own = map->pages->own, .ranks = hl_blocks_ranks(map->pages->blocks)};
  const size_t *n = map->dimension, count = hl_volume_voxel_count(map);
  hl_status status = hl_ranks_begin_step(g.ranks, RANKS_COPY_LABELS, n, error);
  if (status != HL_OK) return status;
  g.exact = any_rank(g.ranks, map->storage == HL_STORAGE_F32 && has_numbers(g.own));
  g.sent_bytes = g.exact ? hl_voxel_type_bytes(map->type) : hl_storage_bytes(map->storage);
  g.slice = hl_allocate(context, n[0] * n[1], g.sent_bytes);
  g.sent = hl_allocate(context, count, g.sent_bytes);
  if (any_rank(g.ranks, g.slice == NULL || g.sent == NULL))
    status = hl_fail_memory(error, (count + n[0] * n[1]) * g.sent_bytes,
                            "a label map, which each process holds whole");
  if (status == HL_OK) send_blocks(&g);
  if (status == HL_OK) status = finish(&g, whole, error);
  hl_release(context, g.slice);
  hl_release(context, g.sent);
  return status;
}

/* ---- sparse pages ---- */

/* Makes a copy, in one array, of a map in sparse pages. Stored values in sparse pages never round the file's
 * numbers. */
static hl_status spread(const hl_volume *map, hl_volume **whole, hl_error *error) {
  const size_t *n = map->dimension, rows = n[1] * n[2];
  unsigned char *voxels = hl_allocate(map->context, rows, map->row_bytes);
  if (voxels == NULL) return hl_fail_memory(error, rows * map->row_bytes, "a volume in one array");
  for (size_t r = 0; r < rows; r++)
    hl_pages_load_row(map->pages, r % n[1], r / n[1], voxels + r * map->row_bytes);
  return adopt(map, voxels, NULL, whole, error);
}

/* Makes the copy of a map in sparse pages, unless the copy exists. Several threads that draw labels of one
 * map may call this function. */
static hl_status spread_once(hl_volume *map, hl_error *error) {
  pthread_mutex_lock(&map->pages->lock);
  hl_status status = map->gathered != NULL ? HL_OK : spread(map, &map->gathered, error);
  pthread_mutex_unlock(&map->pages->lock);
  return status;
}

/* ---- all steps together ---- */

bool hl_volume_is_in_memory(const hl_volume *volume) {
  return volume->voxels != NULL || (volume->pages != NULL && hl_pages_are_sparse(volume->pages));
}

hl_status hl_volume_in_memory(const hl_volume *map, hl_volume **whole, hl_error *error) {
  hl_volume *own = (hl_volume *)map;
  *whole = own;
  if (map->bricks != NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "labels of a field in bricks, whose numbers are no names: give a label map of voxels");
  if (map->pages == NULL) return HL_OK;
  if (map->pages->blocks == NULL && !hl_pages_are_sparse(map->pages))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "labels of a volume that is larger than memory: raise the memory limit");
  hl_status status = hl_pages_are_sparse(map->pages) ? spread_once(own, error)
                     : own->gathered != NULL         ? HL_OK
                                                     : gather(map, &own->gathered, error);
  *whole = own->gathered;
  return status;
}
