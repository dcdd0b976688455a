/* volume/formats/zarr/voxels.c - reads chunks on all threads, and stores their voxels in the volume.
 *
 * The work is divided into parts. A part of the work is one chunk, whose file may be a shard with several
 * chunks. The parts of a shard have consecutive numbers. A missing chunk holds the fill value. */
#define _GNU_SOURCE
#include "volume/formats/zarr/voxels.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/zarr/chunk.h"
#include "volume/formats/zarr/shard.h"
#include "volume/io/parallel.h"

enum {
  PARALLEL_VOXELS = 1 << 20, /* smaller volumes are read by one thread, because starting more threads would
                              * take longer */
  PARTS_MOST = 1 << 26,
  KEY_BYTES = HL_ZARR_PATH_BYTES + HL_ZARR_AXES_MOST * 21 + 8
};

static const bool native_is_big_endian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

/* The memory and the open file of one thread. The open file, which may be a shard, is the file that the
 * thread has read last. */
typedef struct worker {
  hl_zarr_unpacker unpacker;
  char key[KEY_BYTES];  /* name of the open file; "" if no file is open */
  hl_source *source;    /* owned; the open file's source; null if the file does not exist */
  unsigned char *index; /* owned; the shard's index: [16 * chunks_in_shard], followed by a checksum */
  void *row; /* owned; memory for a row of a chunk in stored form, or for a whole chunk if pages are sparse;
              * null if all voxels are in one array in memory from the beginning */
  float *coarse; /* owned; memory for hl_beyond_row(); null if all voxels are seen */
} worker;

typedef struct reading {
  const hl_bundle *bundle;
  const hl_zarr_array *array;
  const hl_zarr_choice *choice;
  hl_destination *to;               /* borrowed */
  size_t stored_bytes;              /* bytes of a voxel */
  uint64_t size[3];                 /* size of the volume */
  uint64_t files[3], inner[3];      /* along i, j, k: number of files, and number of chunks in each file */
  uint64_t parts;                   /* number of parts in all files */
  uint64_t first;                   /* number of the first part in the files that are being read */
  size_t stride[HL_ZARR_AXES_MOST]; /* number of bytes between neighbouring voxels of a chunk, along each of
                                     * the array's axes */
  unsigned char fill[4];            /* the fill value in stored form */
  bool is_filled;                   /* whether voxels that are not stored have the fill value */
  pthread_rwlock_t lock;            /* held for writing while sparse voxels are moved into one array, and for
                                     * reading while voxels are stored */
  worker *workers;                  /* owned; [threads] */
  atomic_size_t found;              /* number of chunks that exist */
  atomic_size_t absent;             /* number of chunks whose files do not exist */
  atomic_size_t beyond;             /* number of chunks out of sight, which are not read */
} reading;

/* The position of a part of the work: the chunk in the array, and the voxels in the volume. */
typedef struct part {
  uint64_t file[HL_ZARR_AXES_MOST];  /* coordinates of the part's file */
  uint64_t inner[HL_ZARR_AXES_MOST]; /* index of the chunk within its file */
  uint64_t begin[3], count[3];       /* the part's voxels in the volume */
  bool is_seen;                      /* whether the chunk is read */
} part;

/* ---- which part is where ---- */

static uint64_t ceiling(uint64_t value, uint64_t divisor) { return value / divisor + (value % divisor != 0); }

static hl_status count_parts(reading *r, hl_error *error) {
  const hl_zarr_array *array = r->array;
  r->parts = 1;
  for (int a = 0; a < 3; a++) {
    int axis = r->choice->axis[a];
    r->size[a] = axis < 0 ? 1 : array->shape[axis];
    r->inner[a] = axis < 0 ? 1 : array->shards.size[axis];
    r->files[a] = axis < 0 ? 1 : ceiling(ceiling(r->size[a], array->chunk[axis]), array->shards.size[axis]);
    if (__builtin_mul_overflow(r->parts, r->files[a], &r->parts) ||
        __builtin_mul_overflow(r->parts, r->inner[a], &r->parts) || r->parts > PARTS_MOST)
      return hl_zarr_fail(r->bundle, array->folder, error, HL_ERROR_UNSUPPORTED,
                          "more than %d chunks in a volume: write it with larger ones", PARTS_MOST);
  }
  return HL_OK;
}

/* Finds the chunk and the voxels of a part. Returns false if the part lies beyond the array's end. */
static bool place_part(const reading *r, uint64_t number, part *p) {
  const hl_zarr_array *array = r->array;
  uint64_t inner[3], file[3];
  for (int a = 0; a < 3; a++) {
    inner[a] = number % r->inner[a];
    number /= r->inner[a];
  }
  for (int a = 0; a < 3; a++) {
    file[a] = number % r->files[a];
    number /= r->files[a];
  }
  for (int axis = 0; axis < array->rank; axis++) {
    uint64_t chunk = r->choice->index[axis] / array->chunk[axis];
    p->file[axis] = chunk / array->shards.size[axis];
    p->inner[axis] = chunk % array->shards.size[axis];
  }
  for (int a = 0; a < 3; a++) {
    int axis = r->choice->axis[a];
    p->begin[a] = 0;
    p->count[a] = 1;
    if (axis < 0) continue;
    p->file[axis] = file[a];
    p->inner[axis] = inner[a];
    p->begin[a] = (file[a] * array->shards.size[axis] + inner[a]) * array->chunk[axis];
    if (p->begin[a] >= r->size[a]) return false;
    uint64_t left = r->size[a] - p->begin[a];
    p->count[a] = left < array->chunk[axis] ? left : array->chunk[axis];
  }
  p->is_seen = hl_beyond_is_seen(&r->choice->beyond, p->begin, p->count);
  return true;
}

static void name_file(const hl_zarr_array *array, const part *p, char separator, char key[KEY_BYTES]) {
  int used = snprintf(key, KEY_BYTES, "%s%s", array->folder, array->has_prefix ? "c" : "");
  for (int axis = 0; axis < array->rank; axis++) {
    if (axis > 0 || array->has_prefix) key[used++] = separator;
    used += snprintf(key + used, KEY_BYTES - (size_t)used, "%llu", (unsigned long long)p->file[axis]);
  }
}

/* ---- a chunk's voxels into the volume ---- */

static void fill_row(const reading *r, void *row, size_t first, size_t count) {
  float wide;
  uint16_t word;
  memcpy(&wide, r->fill, sizeof wide);
  memcpy(&word, r->fill, sizeof word);
  if (r->stored_bytes == 1) memset(row, r->fill[0], count);
  for (size_t n = 0; r->stored_bytes == 2 && n < count; n++) ((uint16_t *)row)[n] = word;
  for (size_t n = 0; r->stored_bytes == 4 && n < count; n++) {
    ((float *)row)[n] = wide;
    hl_destination_note(r->to, false, r->array->fill, first + n, 1);
  }
}

/* Stores `count` voxels of a chunk, which lie `step` bytes apart, from voxel number `first` of the volume on.
 * Voxels that are not adjacent are copied through a small buffer. */
static void store_row(const reading *r, const unsigned char *from, size_t step, size_t first, size_t count,
                      unsigned char *row) {
  enum { STAGED = 512 };
  hl_voxel_type type = r->array->type;
  bool swap = r->array->codecs.big_endian != native_is_big_endian;
  size_t bytes = hl_voxel_type_bytes(type);
  if (step == bytes) {
    hl_destination_note(r->to, swap, from, first, count);
    hl_voxels_store(type, swap, from, count, row);
    return;
  }
  unsigned char stage[STAGED * 8];
  for (size_t done = 0; done < count; done += STAGED) {
    size_t some = count - done < STAGED ? count - done : STAGED;
    for (size_t n = 0; n < some; n++) memcpy(stage + n * bytes, from + (done + n) * step, bytes);
    hl_destination_note(r->to, swap, stage, first + done, some);
    hl_voxels_store(type, swap, stage, some, row + done * r->stored_bytes);
  }
}

/* Stores the voxels of a part, row by row. chunk: the voxels of the part's chunk; null if the voxels get the
 * fill value, or, for a part out of sight, values of the coarser volume. box: whether the rows are stored as
 * one box in the worker's memory instead of the volume. */
static void put_rows(const reading *r, const worker *w, const part *p, const unsigned char *chunk, bool box) {
  const bool apart = hl_destination_is_apart(r->to);
  unsigned char *row = w->row;
  size_t step[3];
  for (int a = 0; a < 3; a++) step[a] = r->choice->axis[a] < 0 ? 0 : r->stride[r->choice->axis[a]];
  for (int axis = 0; axis < r->array->rank && chunk != NULL; axis++)
    chunk += r->choice->index[axis] % r->array->chunk[axis] * r->stride[axis];
  for (uint64_t k = 0; k < p->count[2]; k++)
    for (uint64_t j = 0; j < p->count[1]; j++) {
      uint64_t first = ((p->begin[2] + k) * r->size[1] + p->begin[1] + j) * r->size[0] + p->begin[0];
      if (!apart) row = r->to->voxels + first * r->stored_bytes;
      if (!p->is_seen)
        hl_beyond_row(&r->choice->beyond, p->begin[0], p->begin[1] + j, p->begin[2] + k, p->count[0],
                      w->coarse, row);
      else if (chunk == NULL) fill_row(r, row, first, p->count[0]);
      else store_row(r, chunk + k * step[2] + j * step[1], step[0], first, p->count[0], row);
      if (box) row += p->count[0] * r->stored_bytes;
      else if (apart) hl_destination_store(r->to, first, p->count[0], row);
    }
}

/* Returns whether all voxels of a box have the fill value. */
static bool is_all_fill(const reading *r, const part *p, const unsigned char *box) {
  const size_t bytes = p->count[0] * p->count[1] * p->count[2] * r->stored_bytes;
  return memcmp(box, r->fill, r->stored_bytes) == 0 &&
         memcmp(box, box + r->stored_bytes, bytes - r->stored_bytes) == 0;
}

/* Stores the voxels of a part whose chunk exists or is out of sight, in a volume whose other voxels have the
 * fill value already. */
static hl_status put_filled(reading *r, const worker *w, const part *p, const unsigned char *chunk,
                            hl_error *error) {
  const size_t begin[3] = {p->begin[0], p->begin[1], p->begin[2]},
               count[3] = {p->count[0], p->count[1], p->count[2]};
  hl_status status = HL_OK;
  pthread_rwlock_rdlock(&r->lock);
  const bool sparse = hl_destination_is_sparse(r->to);
  put_rows(r, w, p, chunk, sparse);
  if (sparse && (p->is_seen || !is_all_fill(r, p, w->row)))
    hl_pages_store_box(r->to->pages, begin, count, w->row);
  const bool crowded = hl_destination_is_crowded(r->to);
  pthread_rwlock_unlock(&r->lock);
  if (!crowded) return HL_OK;
  pthread_rwlock_wrlock(&r->lock);
  if (hl_destination_is_sparse(r->to)) status = hl_destination_spread(r->to, error);
  pthread_rwlock_unlock(&r->lock);
  return status;
}

static hl_status put(reading *r, const worker *w, const part *p, const unsigned char *chunk,
                     hl_error *error) {
  if (r->is_filled) return chunk != NULL || !p->is_seen ? put_filled(r, w, p, chunk, error) : HL_OK;
  put_rows(r, w, p, chunk, false);
  return HL_OK;
}

/* ---- files and shards ---- */

static hl_status read_index(const reading *r, worker *w, hl_error *error) {
  const hl_zarr_array *array = r->array;
  size_t bytes = hl_zarr_index_bytes(array), got = 0;
  uint64_t size = hl_source_size(w->source);
  if (size < bytes)
    return hl_zarr_fail(r->bundle, w->key, error, HL_ERROR_INPUT,
                        "a shard of %llu bytes, its index alone has %zu: it is cut short",
                        (unsigned long long)size, bytes);
  if (w->index == NULL) w->index = hl_allocate(r->bundle->context, bytes, 1);
  if (w->index == NULL) return hl_fail_memory(error, bytes, "the index of a shard");
  hl_status status = hl_source_read(w->source, array->shards.index_at_start ? 0 : size - bytes, w->index,
                                    bytes, &got, error);
  bool sound = got == bytes && (array->shards.index_checks == 0 || hl_zarr_check_sum(w->index, bytes));
  return status == HL_OK && !sound
             ? hl_zarr_fail(r->bundle, w->key, error, HL_ERROR_INPUT, "the index of a shard is damaged")
             : status;
}

/* Opens the file of a part, unless the file is open already. */
static hl_status open_file(const reading *r, worker *w, const part *p, hl_error *error) {
  char key[KEY_BYTES];
  name_file(r->array, p, r->array->separator, key);
  if (strcmp(key, w->key) == 0) return HL_OK;
  hl_source_close(w->source);
  strcpy(w->key, key);
  hl_status status = hl_bundle_find(r->bundle, key, true, &w->source, error);
  if (status == HL_OK && w->source == NULL && r->array->separator_untold && r->array->rank > 1) {
    name_file(r->array, p, '/', key);
    status = hl_bundle_find(r->bundle, key, true, &w->source, error);
  }
  if (status == HL_OK && w->source != NULL && r->array->shards.are_used) status = read_index(r, w, error);
  if (status != HL_OK) w->key[0] = 0;
  return status;
}

/* Finds a chunk in its file. *length is 0 if the chunk is missing. */
static hl_status find_chunk(const reading *r, const worker *w, const part *p, uint64_t *offset,
                            uint64_t *length, hl_error *error) {
  uint64_t size = w->source != NULL ? hl_source_size(w->source) : 0;
  *offset = 0;
  *length = size;
  if (w->source == NULL) return HL_OK;
  if (size == 0)
    return hl_zarr_fail(r->bundle, w->key, error, HL_ERROR_INPUT,
                        "a chunk of no bytes: it is cut short, as a chunk that is left out has no file");
  if (!r->array->shards.are_used) return HL_OK;
  return hl_zarr_index_find(r->array, w->index, p->inner, size, offset, length)
             ? HL_OK
             : hl_zarr_fail(r->bundle, w->key, error, HL_ERROR_INPUT, "a chunk lies outside of its shard");
}

/* Returns whether this process keeps any voxel of a part. */
static bool keeps_part(const reading *r, const part *p) {
  uint64_t slice = r->size[0] * r->size[1];
  return hl_destination_wants(r->to, p->begin[2] * slice, p->count[2] * slice);
}

/* Returns whether a part's chunk is read. */
static bool wants_part(const reading *r, const part *p) { return p->is_seen && keeps_part(r, p); }

static hl_status read_part(void *data, size_t number, int index, hl_error *error) {
  reading *r = data;
  worker *w = &r->workers[index];
  part p;
  uint64_t offset, length = 0;
  const unsigned char *chunk = NULL;
  if (!place_part(r, r->first + number, &p)) return HL_OK;
  if (!wants_part(r, &p)) {
    /* a chunk that this process does not read counts as found, because only reading shows whether the chunk
     * exists */
    atomic_fetch_add_explicit(&r->found, 1, memory_order_relaxed);
    if (p.is_seen || !keeps_part(r, &p)) return HL_OK;
    atomic_fetch_add_explicit(&r->beyond, 1, memory_order_relaxed);
    return put(r, w, &p, NULL, error);
  }
  hl_status status = open_file(r, w, &p, error);
  if (status == HL_OK) status = find_chunk(r, w, &p, &offset, &length, error);
  if (status == HL_OK && w->source != NULL && length > 0) {
    status = hl_zarr_chunk_read(&w->unpacker, w->source, offset, length, &chunk, error);
    atomic_fetch_add_explicit(&r->found, 1, memory_order_relaxed);
  }
  if (status == HL_OK && w->source == NULL) atomic_fetch_add_explicit(&r->absent, 1, memory_order_relaxed);
  return status == HL_OK ? put(r, w, &p, chunk, error) : status;
}

/* ---- files on a server ---- */

enum { FILES_AT_A_TIME = 64 };

static uint64_t parts_of_file(const reading *r) { return r->inner[0] * r->inner[1] * r->inner[2]; }

/* Returns whether shards have chunks that are not read, because the chunks belong to other times or channels,
 * or to other ranks, or lie out of sight. */
static bool reads_parts_of_shards(const reading *r) {
  return r->array->shards.are_used && (parts_of_file(r) < r->array->shards.chunks || r->to->own != NULL ||
                                       r->choice->beyond.coarse != NULL);
}

/* The number of files that are read at a time. Each file, and each part of a shard, takes a file descriptor,
 * and the usual limit is 1024 descriptors for a process. */
static uint64_t files_at_a_time(const reading *r) {
  uint64_t parts = parts_of_file(r), files = parts < HL_ZARR_SPANS_MOST ? HL_ZARR_SPANS_MOST / parts : 1;
  return reads_parts_of_shards(r) && files < FILES_AT_A_TIME ? files : FILES_AT_A_TIME;
}

/* The greatest length of a file of the array, in bytes. Longer files are not fetched. */
static uint64_t longest_file(const hl_zarr_array *array) {
  uint64_t chunk = hl_zarr_chunk_most(array) + 16, length;
  return __builtin_mul_overflow(chunk, array->shards.chunks, &length) ? UINT64_MAX : length + 64;
}

/* Returns whether any chunk of a file is read by this process. number: the number of the file's first part.
 * place: set to a part of the file. */
static bool wants_file(const reading *r, uint64_t number, part *place) {
  for (uint64_t n = 0; n < parts_of_file(r); n++)
    if (place_part(r, number + n, place) && wants_part(r, place)) return true;
  return false;
}

/* Fetches the files of the `count` parts from r->first on, or the indices of shards. separator: the separator
 * in the files' names. again: whether to fetch only the files that the server lacks under their names with
 * the array's separator. */
static hl_status bring_files(const reading *r, uint64_t count, char separator, bool again, hl_error *error) {
  const char *names[FILES_AT_A_TIME];
  hl_fetch_range ranges[FILES_AT_A_TIME];
  size_t wanted = 0;
  char(*keys)[KEY_BYTES] = hl_allocate(r->bundle->context, FILES_AT_A_TIME, sizeof *keys);
  hl_status status = keys != NULL ? HL_OK : hl_fail_memory(error, FILES_AT_A_TIME * sizeof *keys, "names");
  for (uint64_t n = 0; n < count && status == HL_OK; n += parts_of_file(r)) {
    part place;
    hl_source *known = NULL;
    if (!wants_file(r, r->first + n, &place)) continue;
    name_file(r->array, &place, r->array->separator, keys[wanted]);
    if (again) status = hl_bundle_find(r->bundle, keys[wanted], true, &known, error);
    hl_source_close(known);
    if (known != NULL) continue;
    name_file(r->array, &place, separator, keys[wanted]);
    names[wanted] = keys[wanted];
    ranges[wanted] = hl_zarr_index_range(r->array);
    wanted++;
  }
  uint64_t most = longest_file(r->array);
  if (status == HL_OK && reads_parts_of_shards(r))
    status = hl_bundle_bring_parts(r->bundle, names, ranges, wanted, most, error);
  else if (status == HL_OK) status = hl_bundle_bring(r->bundle, names, wanted, most, error);
  hl_release(r->bundle->context, keys);
  return status;
}

/* A list of the parts of shards that are to be fetched. */
typedef struct span_list {
  char (*keys)[KEY_BYTES]; /* owned; [FILES_AT_A_TIME]; names of the shards */
  size_t shards, count;
  const char *names[HL_ZARR_SPANS_MOST];     /* [count]; borrowed from `keys` */
  hl_fetch_range ranges[HL_ZARR_SPANS_MOST]; /* [count] */
} span_list;

/* Lists the ranges of a shard's chunks that are read. number: the number of the shard's first part. chunks:
 * [parts of a file]. */
static hl_status list_chunks(const reading *r, const worker *w, uint64_t number, hl_fetch_range *chunks,
                             size_t *count, hl_error *error) {
  hl_status status = HL_OK;
  *count = 0;
  for (uint64_t n = 0; n < parts_of_file(r) && status == HL_OK; n++) {
    part p;
    if (!place_part(r, number + n, &p) || !wants_part(r, &p)) continue;
    hl_fetch_range *chunk = &chunks[*count];
    status = find_chunk(r, w, &p, &chunk->begin, &chunk->count, error);
    *count += status == HL_OK && chunk->count > 0;
  }
  return status;
}

/* Adds to the list the parts of one shard that must be fetched. The shard's index has been fetched already. A
 * shard that does not exist, or that the server has sent as a whole, adds no parts. */
static hl_status list_spans(const reading *r, uint64_t number, span_list *list, hl_error *error) {
  part place;
  worker *w = &r->workers[0];
  size_t count;
  if (!wants_file(r, number, &place)) return HL_OK;
  hl_status status = open_file(r, w, &place, error);
  if (status != HL_OK || w->source == NULL || !hl_bundle_has_parts(r->bundle, w->key)) return status;
  hl_fetch_range *chunks = hl_allocate(r->bundle->context, parts_of_file(r), sizeof *chunks);
  if (chunks == NULL) return hl_fail_memory(error, parts_of_file(r) * sizeof *chunks, "a list of chunks");
  status = list_chunks(r, w, number, chunks, &count, error);
  if (status == HL_OK) {
    char *key = strcpy(list->keys[list->shards++], w->key);
    count = hl_zarr_spans_join(chunks, count);
    for (size_t n = 0; n < count; n++) {
      list->names[list->count] = key;
      list->ranges[list->count++] = chunks[n];
    }
  }
  hl_release(r->bundle->context, chunks);
  return status;
}

static void close_files(const reading *r, int workers) {
  for (int n = 0; n < workers; n++) {
    hl_source_close(r->workers[n].source);
    r->workers[n].source = NULL;
    r->workers[n].key[0] = 0;
  }
}

/* Fetches the wanted chunks of the shards that hold the `count` parts from r->first on. */
static hl_status bring_chunks(const reading *r, uint64_t count, int workers, hl_error *error) {
  hl_context *context = r->bundle->context;
  span_list *list = hl_allocate_zeroed(context, 1, sizeof *list);
  if (list == NULL) return hl_fail_memory(error, sizeof *list, "a list of chunks");
  list->keys = hl_allocate(context, FILES_AT_A_TIME, sizeof *list->keys);
  hl_status status = list->keys != NULL
                         ? HL_OK
                         : hl_fail_memory(error, FILES_AT_A_TIME * sizeof *list->keys, "names");
  for (uint64_t n = 0; n < count && status == HL_OK; n += parts_of_file(r))
    status = list_spans(r, r->first + n, list, error);
  close_files(r, workers); /* the open sources hold only the shards' indices */
  if (status == HL_OK)
    status = hl_bundle_bring_parts(r->bundle, list->names, list->ranges, list->count, longest_file(r->array),
                                   error);
  hl_release(context, list->keys);
  hl_release(context, list);
  return status;
}

/* Fetches a number of files at a time from the server, and reads the parts of these files. */
static hl_status read_from_server(reading *r, hl_pool *pool, hl_error *error) {
  const hl_zarr_array *array = r->array;
  bool by_parts = reads_parts_of_shards(r);
  uint64_t step = files_at_a_time(r) * parts_of_file(r);
  size_t known = hl_bundle_brought_count(r->bundle);
  hl_status status = HL_OK;
  for (; r->first < r->parts && status == HL_OK; r->first += step) {
    uint64_t count = r->parts - r->first < step ? r->parts - r->first : step;
    status = bring_files(r, count, array->separator, false, error);
    if (status == HL_OK && array->separator_untold && array->rank > 1)
      status = bring_files(r, count, '/', true, error);
    if (status == HL_OK && by_parts) status = bring_chunks(r, count, hl_pool_threads(pool), error);
    if (status == HL_OK)
      status = hl_parallel_read(r->bundle->context, pool, r->bundle->path, (size_t)count, read_part, r,
                                error);
    close_files(r, hl_pool_threads(pool));
    hl_bundle_forget(r->bundle, known);
  }
  return status;
}

/* ---- all steps together ---- */

static void prepare(reading *r) {
  const hl_zarr_array *array = r->array;
  size_t step = hl_voxel_type_bytes(array->type);
  r->stored_bytes = hl_storage_bytes(hl_voxel_type_storage(array->type));
  for (int n = array->rank - 1; n >= 0; n--) {
    int axis = array->codecs.order[n];
    r->stride[axis] = step;
    step *= (size_t)array->chunk[axis];
  }
  hl_voxels_store(array->type, false, array->fill, 1, r->fill);
}

/* The greatest number of voxels that a chunk can have in the volume along an axis. */
static size_t longest(const reading *r, int a) {
  int axis = r->choice->axis[a];
  uint64_t chunk = axis < 0 ? 1 : r->array->chunk[axis];
  return (size_t)(chunk < r->size[a] ? chunk : r->size[a]);
}

/* The number of bytes of a worker's memory for a row or for a box. */
static size_t row_bytes_of(const reading *r) {
  return longest(r, 0) * (r->is_filled ? longest(r, 1) * longest(r, 2) : 1) * r->stored_bytes;
}

static hl_status read_parts(reading *r, hl_pool *pool, hl_error *error) {
  hl_context *context = r->bundle->context;
  size_t threads = (size_t)hl_pool_threads(pool), row_bytes = row_bytes_of(r);
  hl_status status = HL_OK;
  r->workers = hl_allocate_zeroed(context, threads, sizeof *r->workers);
  if (r->workers == NULL) return hl_fail_memory(error, threads * sizeof *r->workers, "threads");
  for (size_t n = 0; n < threads; n++) {
    worker *w = &r->workers[n];
    w->unpacker = (hl_zarr_unpacker){.context = context, .path = r->bundle->path, .array = r->array};
    if (hl_destination_is_apart(r->to) && (w->row = hl_allocate(context, row_bytes, 1)) == NULL)
      status = hl_fail_memory(error, row_bytes, r->bundle->path);
    const size_t floats = hl_beyond_room(&r->choice->beyond);
    if (floats > 0 && (w->coarse = hl_allocate(context, floats, sizeof *w->coarse)) == NULL)
      status = hl_fail_memory(error, floats * sizeof *w->coarse, r->bundle->path);
  }
  if (status == HL_OK)
    status = hl_bundle_is_on_server(r->bundle)
                 ? read_from_server(r, pool, error)
                 : hl_parallel_read(context, pool, r->bundle->path, (size_t)r->parts, read_part, r, error);
  for (size_t n = 0; n < threads; n++) {
    hl_zarr_unpacker_release(&r->workers[n].unpacker);
    hl_source_close(r->workers[n].source);
    hl_release(context, r->workers[n].index);
    hl_release(context, r->workers[n].row);
    hl_release(context, r->workers[n].coarse);
  }
  hl_release(context, r->workers);
  return status;
}

/* Tells the user the number of chunks that a server lacks. A store may lack chunks on purpose, but chunks are
 * missing also after a fault of the server. For a folder no message is needed, because the user can list its
 * files. */
static void tell_absent(const reading *r, hl_absence *absence) {
  if (!hl_bundle_is_on_server(r->bundle)) return;
  const size_t absent = atomic_load(&r->absent), all = absent + atomic_load(&r->found);
  *absence = (hl_absence){absent, all};
  if (absent > 0)
    hl_log(
        r->bundle->context, HL_LOG_INFO,
        "%.300s: the server has no file for %zu of %zu chunks (array \"%.200s\"): their voxels have the fill "
        "value",
        r->bundle->path, absent, all, r->array->folder);
}

static void tell_beyond(const reading *r) {
  const size_t beyond = atomic_load(&r->beyond);
  if (beyond > 0)
    hl_log(
        r->bundle->context, HL_LOG_INFO,
        "%.300s: %zu of %llu chunks (array \"%.200s\") lie out of sight, and are taken from a coarser level",
        r->bundle->path, beyond, (unsigned long long)r->parts, r->array->folder);
}

static hl_status read_all(reading *r, hl_absence *absence, hl_error *error) {
  hl_pool *pool = NULL;
  bool parallel = r->parts > 1 && r->size[0] * r->size[1] * r->size[2] >= PARALLEL_VOXELS;
  hl_status status = hl_pool_create(r->bundle->context, parallel ? 0 : 1, &pool, error);
  if (status == HL_OK) status = read_parts(r, pool, error);
  hl_pool_destroy(pool);
  if (status == HL_OK && atomic_load(&r->found) > 0) tell_absent(r, absence);
  if (status == HL_OK) tell_beyond(r);
  if (status == HL_OK && atomic_load(&r->found) == 0)
    return hl_zarr_fail(r->bundle, r->array->folder, error, HL_ERROR_INPUT,
                        "not one of its %llu chunks is there: is the copy whole?",
                        (unsigned long long)r->parts);
  return status;
}

hl_status hl_zarr_voxels_read(const hl_bundle *bundle, const hl_zarr_array *array,
                              const hl_zarr_choice *choice, const hl_volume_description *grid,
                              hl_destination *to, hl_absence *absence, bool *is_part, hl_error *error) {
  reading r = {.bundle = bundle, .array = array, .choice = choice, .to = to};
  atomic_init(&r.found, 0);
  atomic_init(&r.absent, 0);
  atomic_init(&r.beyond, 0);
  prepare(&r);
  hl_status status = count_parts(&r, error);
  if (status == HL_OK)
    status = hl_destination_open_sparse(bundle->context, grid, r.fill, bundle->path, to, error);
  if (status != HL_OK) return status;
  r.is_filled = hl_destination_is_sparse(to);
  pthread_rwlock_init(&r.lock, NULL); /* this call cannot fail, because the lock has no attributes */
  status = read_all(&r, absence, error);
  *is_part = atomic_load(&r.beyond) > 0;
  pthread_rwlock_destroy(&r.lock);
  return status;
}
