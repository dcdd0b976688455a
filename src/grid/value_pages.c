/* grid/value_pages.c - see value_pages.h.
 *
 * Slices are loaded, and filtered along x and y, some slices at a time. Along z the filter runs forward over
 * all slices, and then back. Between the two runs, the slices lie in a second scratch file, or in memory if
 * several ranks share the volume. */
#define _GNU_SOURCE
#include "grid/value_pages.h"

#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"
#include "grid/prefilter.h"
#include "volume/store/glimpse.h"
#include "volume/store/scratch_file.h"

static const char subject[] = "values of a volume larger than memory";

typedef struct value_job {
  const hl_volume *volume;
  hl_pool *pool;
  float empty, greatest; /* the parameters `empty` and `greatest` of hl_grid_value() */
  bool filters;
  size_t width, height, slice; /* width: voxels of a row; height: rows of a slice; slice: voxels of a slice */
  size_t first;                /* number of the slice that slices[0] holds */
  float *slices;               /* [slices loaded at once][slice]; the loaded slices */
  float *beside;               /* [slice]; in the forward run, the slice before the loaded slices; in the run
                                * back, the slice after them */
  bool any_beside;             /* whether `beside` holds a slice */
  unsigned char *rows;         /* [threads][row_bytes]; a row of stored values for each thread */
  size_t row_bytes;
} value_job;

/* Loads a slice of voxels. If the values are coefficients, filters the slice along x and y. */
static void load_slice(void *data, size_t index, int worker) {
  const value_job *job = data;
  float *slice = job->slices + index * job->slice, *to = slice;
  void *buffer = job->rows + (size_t)worker * job->row_bytes;
  for (size_t y = 0; y < job->height; y++) {
    const void *row = hl_volume_row_in(job->volume, y, job->first + index, buffer);
    for (size_t x = 0; x < job->width; x++)
      *to++ = hl_grid_value((float)hl_stored_number(job->volume->storage, row, x), job->greatest, job->empty);
  }
  if (job->filters) hl_prefilter_slice(slice, job->width, job->height);
}

/* ---- along z: `count` slices from the first one on; each task a row ---- */

typedef struct z_job {
  const value_job *values;
  size_t count;
} z_job;

static void filter_forward(void *data, size_t index, int worker) {
  (void)worker;
  const z_job *job = data;
  const value_job *v = job->values;
  const float *before = v->any_beside ? v->beside + index * v->width : NULL;
  for (size_t k = 0; k < job->count; k++) {
    float *here = v->slices + k * v->slice + index * v->width;
    hl_prefilter_forward(here, before, v->width, v->first + k, v->volume->dimension[2]);
    before = here;
  }
}

static void filter_back(void *data, size_t index, int worker) {
  (void)worker;
  const z_job *job = data;
  const value_job *v = job->values;
  const float *after = v->any_beside ? v->beside + index * v->width : NULL;
  for (size_t k = job->count; k-- > 0;) {
    float *here = v->slices + k * v->slice + index * v->width;
    if (after != NULL) hl_prefilter_back(here, after, v->width, v->first + k, v->volume->dimension[2]);
    after = here;
  }
}

static void run_along_z(value_job *job, size_t count, bool forward) {
  z_job rows = {job, count};
  hl_pool_run(job->pool, job->height, forward ? filter_forward : filter_back, &rows);
  memcpy(job->beside, job->slices + (forward ? count - 1 : 0) * job->slice, job->slice * sizeof *job->beside);
  job->any_beside = true;
}

/* ---- a scratch file ---- */

/* Writes slices to a file after the forward run, or reads them before the run back. at: offset of the first
 * slice in the file, in bytes. */
static bool move_slices(int file, bool write, float *slices, size_t bytes, uint64_t at) {
  unsigned char *place = (unsigned char *)slices;
  while (bytes > 0) {
    ssize_t done = write ? pwrite(file, place, bytes, (off_t)at) : pread(file, place, bytes, (off_t)at);
    if (done <= 0) return false;
    place += done, at += (uint64_t)done, bytes -= (size_t)done;
  }
  return true;
}

static hl_status fail_cancelled(const value_job *job, hl_error *error) {
  return hl_cancelled(job->volume->context) || hl_pool_cancelled(job->pool)
             ? hl_fail(error, HL_ERROR_CANCELLED, "cancelled while a volume was made ready")
             : HL_OK;
}

/* Loads all slices, at most `most` at a time. If `file` is below 0, stores the slices in pages. Otherwise
 * filters them forward along z and stores them in the file. */
static hl_status run_forward(value_job *job, size_t most, int file, hl_pages *pages, hl_error *error) {
  const size_t depth = job->volume->dimension[2];
  hl_status status = HL_OK;
  for (job->first = 0; job->first < depth && status == HL_OK; job->first += most) {
    size_t count = depth - job->first < most ? depth - job->first : most, bytes = count * job->slice * 4;
    hl_pool_run(job->pool, count, load_slice, job);
    status = fail_cancelled(job, error);
    if (file < 0) {
      hl_pages_store(pages, job->first * job->slice, count * job->slice, job->slices);
      continue;
    }
    run_along_z(job, count, true);
    if (status == HL_OK &&
        !move_slices(file, true, job->slices, bytes, (uint64_t)job->first * job->slice * 4))
      status = hl_fail(error, HL_ERROR_IO, "%s: the scratch file cannot be written", subject);
  }
  return status;
}

static hl_status run_back(value_job *job, size_t most, int file, hl_pages *pages, hl_error *error) {
  const size_t depth = job->volume->dimension[2];
  hl_status status = HL_OK;
  job->any_beside = false;
  for (size_t end = depth; end > 0 && status == HL_OK; end = job->first) {
    size_t count = (end - 1) % most + 1, bytes = count * job->slice * 4;
    job->first = end - count;
    if (!move_slices(file, false, job->slices, bytes, (uint64_t)job->first * job->slice * 4))
      return hl_fail(error, HL_ERROR_IO, "%s: the scratch file cannot be read", subject);
    run_along_z(job, count, false);
    hl_pages_store(pages, job->first * job->slice, count * job->slice, job->slices);
    status = fail_cancelled(job, error);
  }
  return status;
}

static hl_volume_description describe(const hl_volume *volume) {
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  memcpy(grid.dimensions, volume->dimension, sizeof grid.dimensions);
  grid.type = HL_VOXEL_F32;
  return grid;
}

/* The number of slices that are loaded at a time: the number of slices that a page takes in one piece, or a
 * smaller number if these slices would take more than an eighth of the memory limit. */
static size_t slices_at_once(const value_job *job) {
  uint64_t limit = job->volume->context->options.memory_limit, bytes = job->slice * sizeof(float);
  size_t most = 8;
  while (most > 1 && limit > 0 && most * bytes > limit / 8) most /= 2;
  return most;
}

static hl_status make_file(value_job *job, hl_pages **made, hl_error *error) {
  const hl_volume *volume = job->volume;
  hl_context *context = volume->context;
  const char *folder = context->options.scratch_folder;
  const size_t most = slices_at_once(job);
  const uint64_t bytes = (uint64_t)hl_volume_voxel_count(volume) * sizeof(float);
  const hl_volume_description grid = describe(volume);
  int file = -1;
  if (folder == NULL)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: they need a scratch folder, or a higher memory limit",
                   subject);
  job->slices = hl_allocate(context, most * job->slice, sizeof(float));
  hl_status status = job->slices != NULL
                         ? hl_pages_create(context, folder, &grid, volume->pages->shift, made, error)
                         : hl_fail_memory(error, most * job->slice * sizeof(float), subject);
  if (status == HL_OK) {
    hl_glimpse_release((*made)->glimpse); /* these pages need no glimpse (voxels kept for automatic choices),
                                           * because automatic choices use the volume's own glimpse */
    (*made)->glimpse = NULL;
  }
  bool along_z = job->filters && volume->dimension[2] > 1;
  if (status == HL_OK && along_z) status = hl_scratch_open(context, folder, bytes, &file, error);
  if (status == HL_OK) status = run_forward(job, most, file, *made, error);
  if (status == HL_OK && along_z) status = run_back(job, most, file, *made, error);
  if (file >= 0) close(file);
  return status;
}

/* ---- over ranks ---- */

/* Replaces non-finite values in this rank's block, which need not be whole slices. */
static void replace_own(const value_job *job, const hl_own_voxels *own, hl_own_voxels *made) {
  size_t count = hl_own_voxels_count(own);
  float *values = (float *)(void *)made->slices;
  hl_own_voxels_run(own, 0, count, made->slices);
  for (size_t n = 0; n < count; n++) values[n] = hl_grid_value(values[n], job->greatest, job->empty);
}

/* Turns this rank's slices into coefficients. Along z the ranks filter one after the other. In the run
 * forwards each rank sends its last slice to the next rank; in the run back each rank sends its first slice
 * to the rank before. */
static void filter_own(value_job *job, hl_ranks *ranks, hl_own_voxels *made) {
  const size_t count = made->box.count[2], bytes = job->slice * sizeof(float);
  job->slices = (float *)(void *)made->slices;
  job->first = made->box.begin[2];
  hl_pool_run(job->pool, count, load_slice, job);
  for (int way = 0; way < 2 && job->volume->dimension[2] > 1; way++) {
    job->any_beside = false;
    for (int turn = 0; turn < ranks->size; turn++) {
      int rank = way == 0 ? turn : ranks->size - 1 - turn;
      bool any = hl_ranks_part(ranks, job->volume->dimension[2], rank) <
                 hl_ranks_part(ranks, job->volume->dimension[2], rank + 1);
      if (!any) continue;
      if (rank == ranks->rank) run_along_z(job, count, way == 0);
      hl_ranks_tell(ranks, job->beside, bytes, rank);
      job->any_beside = true;
    }
  }
  job->slices = NULL;
}

static bool holds_its_part(const hl_ranks *ranks, const hl_volume *volume, const hl_own_voxels *own) {
  const size_t *n = volume->dimension;
  return own->box.count[0] == n[0] && own->box.count[1] == n[1] &&
         own->box.begin[2] == hl_ranks_part(ranks, n[2], ranks->rank) &&
         own->box.begin[2] + own->box.count[2] == hl_ranks_part(ranks, n[2], ranks->rank + 1);
}

static hl_status make_over_ranks(value_job *job, hl_pages **made, hl_error *error) {
  const hl_volume *volume = job->volume;
  const hl_own_voxels *own = volume->pages->own;
  hl_ranks *ranks = hl_blocks_ranks(volume->pages->blocks);
  const hl_volume_description grid = describe(volume);
  uint64_t others = job->filters && !holds_its_part(ranks, volume, own);
  hl_own_voxels *values = NULL;
  hl_ranks_sum_counts(ranks, &others, 1);
  if (others > 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "the interpolating kernel needs, of a volume over ranks, whole slices in the order of the "
                   "ranks: take another kernel");
  hl_status status = hl_own_voxels_like(ranks, own, &values, error);
  if (status != HL_OK) return status;
  if (job->filters) filter_own(job, ranks, values);
  else replace_own(job, own, values);
  status = hl_pages_create_over_ranks(ranks, values, &grid, volume->pages->shift, made, error);
  if (status == HL_OK) (*made)->in_use = true;
  return status;
}

hl_status hl_value_pages_create(hl_pool *pool, const hl_volume *volume, const kernel *kernel, float empty,
                                hl_pages **pages, hl_error *error) {
  hl_context *context = volume->context;
  value_job job = {.volume = volume, .pool = pool, .empty = empty, .filters = kernel->interpolates};
  job.greatest = hl_greatest_value(kernel);
  job.width = volume->dimension[0], job.height = volume->dimension[1];
  job.slice = job.width * job.height;
  job.row_bytes = job.width * hl_storage_bytes(volume->storage);
  job.rows = hl_allocate(context, (size_t)hl_pool_threads(pool), job.row_bytes);
  job.beside = hl_allocate(context, job.filters ? job.slice : 1, sizeof *job.beside);
  *pages = NULL;
  hl_status status = job.rows == NULL || job.beside == NULL
                         ? hl_fail_memory(error, job.slice * sizeof *job.beside, subject)
                     : volume->pages->blocks != NULL ? make_over_ranks(&job, pages, error)
                                                     : make_file(&job, pages, error);
  hl_release(context, job.rows);
  hl_release(context, job.beside);
  hl_release(context, job.slices);
  if (status == HL_OK) {
    hl_pages_finish(*pages);
    hl_pages_forget(volume->pages);
    return HL_OK;
  }
  hl_pages_release(*pages);
  *pages = NULL;
  return status;
}
