/* label/parts.c - finds the parts of a label map's grid that hold labels (occupancy.h). */
#include "core/context.h"
#include "core/memory.h"
#include "label/occupancy.h"

/* Width of the margin around the labels, in voxels, beyond which the labels' occupancy is 0. */
enum { MARGIN = 8 };

/* The least and the greatest coordinates of a label's voxels, both included. */
typedef struct label_bounds {
  int64_t low[3], high[3];
} label_bounds;

typedef struct parts_job {
  const hl_volume *map;
  const int64_t *labels; /* [count], rising; the labels whose parts are found */
  size_t count;
  label_bounds *bounds; /* [threads][count]; the bounds of each label's voxels that each thread has found */
} parts_job;

size_t hl_label_place(const int64_t *labels, size_t count, const hl_volume *map, hl_number_row row,
                      size_t i) {
  size_t low = 0, high = count;
  int64_t value;
  if (!hl_row_whole(map, row, i, &value)) return count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (labels[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low < count && labels[low] == value ? low : count;
}

static void widen(label_bounds *bounds, const int64_t low[3], const int64_t high[3]) {
  for (int a = 0; a < 3; a++) {
    if (low[a] < bounds->low[a]) bounds->low[a] = low[a];
    if (high[a] > bounds->high[a]) bounds->high[a] = high[a];
  }
}

/* Bounds the labels of a slice. Labels come in runs, and each run is looked up once. */
static void bound_slice(void *data, size_t z, int worker) {
  const parts_job *job = data;
  label_bounds *bounds = job->bounds + (size_t)worker * job->count;
  const size_t width = job->map->dimension[0];
  for (size_t y = 0; y < job->map->dimension[1]; y++) {
    const hl_number_row row = hl_volume_numbers(job->map, y, z, NULL);
    for (size_t x = 0; x < width;) {
      size_t from = x++;
      while (x < width && hl_row_repeats(row, x, from)) x++;
      size_t place = hl_label_place(job->labels, job->count, job->map, row, from);
      if (place == job->count) continue;
      widen(&bounds[place], (int64_t[3]){(int64_t)from, (int64_t)y, (int64_t)z},
            (int64_t[3]){(int64_t)x - 1, (int64_t)y, (int64_t)z});
    }
  }
}

/* The part of a map's grid between the given bounds, with a margin. The part's size is 0 if the bounds hold
 * no voxels. */
static hl_label_part part_of(const hl_volume *map, const label_bounds *bounds) {
  hl_label_part part = {{0}, {0}};
  for (int axis = 0; axis < 3 && bounds->high[axis] >= 0; axis++) {
    int64_t last = (int64_t)map->dimension[axis] - 1;
    int64_t begin = bounds->low[axis] - MARGIN < 0 ? 0 : bounds->low[axis] - MARGIN;
    int64_t end = bounds->high[axis] + MARGIN > last ? last : bounds->high[axis] + MARGIN;
    part.first[axis] = (size_t)begin;
    part.size[axis] = (size_t)(end - begin + 1);
  }
  return part;
}

hl_status hl_label_parts(hl_context *context, hl_pool *pool, const hl_volume *map, const int64_t *labels,
                         size_t count, hl_label_part *parts, hl_error *error) {
  const size_t threads = (size_t)hl_pool_threads(pool);
  parts_job job = {map, labels, count, hl_allocate(context, threads * count, sizeof *job.bounds)};
  hl_status status = HL_OK;
  if (job.bounds == NULL) status = hl_fail_memory(error, threads * count * sizeof *job.bounds, "labels");
  for (size_t n = 0; status == HL_OK && n < threads * count; n++)
    job.bounds[n] = (label_bounds){{INT64_MAX, INT64_MAX, INT64_MAX}, {-1, -1, -1}};
  if (status == HL_OK) {
    hl_pool_run(pool, map->dimension[2], bound_slice, &job);
    status = hl_pool_check(pool, "reading labels", error);
  }
  for (size_t n = 0; status == HL_OK && n < count; n++) {
    for (size_t t = 1; t < threads; t++)
      widen(&job.bounds[n], job.bounds[t * count + n].low, job.bounds[t * count + n].high);
    parts[n] = part_of(map, &job.bounds[n]);
  }
  hl_release(context, job.bounds);
  return status;
}

hl_label_part hl_label_part_of_all(const hl_label_part *parts, size_t count) {
  hl_label_part all = {{0}, {0}};
  for (size_t n = 0; n < count; n++) {
    if (parts[n].size[0] == 0) continue;
    for (int a = 0; a < 3; a++) {
      size_t first = parts[n].first[a], end = first + parts[n].size[a], all_end = all.first[a] + all.size[a];
      if (all_end == 0) all.first[a] = first, all_end = end; /* this is the first part that has voxels */
      if (first < all.first[a]) all.first[a] = first;
      all.size[a] = (end > all_end ? end : all_end) - all.first[a];
    }
  }
  return all;
}
