/* label/solids.c - see solids.h. */
#include "label/solids.h"

#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/pool.h"
#include "image/srgb.h"
#include "label/occupancy_line.h"
#include "label/shelf.h"
#include "volume/colors.h"

typedef struct solids_job {
  hl_volume *map;
  const hl_label *labels; /* [count]; the labels that are solid together */
  size_t count;
  /* [count]; the occupancy of each label; an element is null if no voxel has the label. The array is null if
   * no colours are made */
  hl_volume **occupancies;
  hl_label_part part; /* the common part of the map's grid that holds all labels */
  hl_srgb_encoder encoder;
  unsigned char *colors; /* [size z][y][x][HL_COLOR_BYTES]; the colours of the volume's voxels */
  float *sums;           /* [threads][slice floats]; the sums of each thread over the labels */
  size_t slice_floats;
} solids_job;

/* Sums over all labels, one for each voxel of a slice, each [y][x]: the weights, and the weights times each
 * channel of the colour. Space for a line of occupancy follows. */
enum { SUM_WEIGHT, SUM_COLOR, SUM_LINE = SUM_COLOR + 3, SUMS };

/* A label's weight in the mean of colours: its occupancy to the fourth power. Derived: two labels that touch
 * have occupancies a and 1 - a. The share of the first is a^4 / (a^4 + (1 - a)^4), whose slope at a = 1/2 is
 * 4. Occupancies rise by a quarter a voxel, so that the share rises from 0 to 1 over about a voxel. */
static float weight_of(float occupancy) {
  const float square = occupancy > 0 ? occupancy * occupancy : 0;
  return square * square;
}

/* Adds a label's occupancy to the sums of a slice of the part. */
static void add_label(const solids_job *job, const hl_label *label, const hl_volume *o, size_t z,
                      float *const sums[SUMS]) {
  size_t first[3];
  hl_occupancy_first(job->map, o, first);
  for (int a = 0; a < 3; a++) first[a] -= job->part.first[a];
  if (z < first[2] || z >= first[2] + o->dimension[2]) return;
  for (size_t j = 0; j < o->dimension[1]; j++) {
    const size_t at = (first[1] + j) * job->part.size[0] + first[0];
    hl_occupancy_line(o, j, z - first[2], sums[SUM_LINE]);
    for (size_t i = 0; i < o->dimension[0]; i++) {
      const float weight = weight_of(sums[SUM_LINE][i]);
      sums[SUM_WEIGHT][at + i] += weight;
      for (int c = 0; c < 3; c++) sums[SUM_COLOR + c][at + i] += weight * (float)label->color[c];
    }
  }
}

static void color_slice(void *data, size_t z, int worker) {
  const solids_job *job = data;
  const size_t count = job->part.size[0] * job->part.size[1];
  float *sums[SUMS], *own = job->sums + (size_t)worker * job->slice_floats;
  for (int s = 0; s < SUMS; s++) sums[s] = own + (size_t)s * count;
  memset(own, 0, SUM_LINE * count * sizeof *own);
  for (size_t n = 0; n < job->count; n++)
    if (job->occupancies[n] != NULL) add_label(job, &job->labels[n], job->occupancies[n], z, sums);
  unsigned char *color = job->colors + z * count * HL_COLOR_BYTES;
  for (size_t at = 0; at < count; at++, color += HL_COLOR_BYTES) {
    const float weight = sums[SUM_WEIGHT][at];
    color[3] = weight > 0 ? 255 : 0;
    for (int c = 0; c < 3; c++)
      color[c] = weight > 0 ? (unsigned char)hl_srgb_encode(&job->encoder, sums[SUM_COLOR + c][at] / weight)
                            : 0;
  }
}

static bool one_color(const hl_label *labels, size_t count) {
  for (size_t n = 1; n < count; n++)
    if (memcmp(labels[n].color, labels[0].color, sizeof labels[n].color) != 0) return false;
  return true;
}

/* Gives the volume of several labels its colours. */
static hl_status add_colors(hl_context *context, hl_pool *pool, solids_job *job, hl_volume *made,
                            hl_error *error) {
  const size_t slice = job->part.size[0] * job->part.size[1], count = slice * job->part.size[2];
  job->slice_floats = SUMS * slice;
  job->sums = hl_allocate(context, (size_t)hl_pool_threads(pool) * job->slice_floats, sizeof *job->sums);
  job->colors = hl_allocate(made->context, count, HL_COLOR_BYTES);
  hl_status status = HL_OK;
  if (job->sums == NULL || job->colors == NULL)
    status = hl_fail_memory(error, count * HL_COLOR_BYTES, "the colours of labels");
  if (status == HL_OK) status = hl_srgb_encoder_create(context, 255, &job->encoder, error);
  if (status == HL_OK) {
    hl_pool_run(pool, job->part.size[2], color_slice, job);
    hl_srgb_encoder_destroy(&job->encoder);
    status = hl_pool_check(pool, "colouring labels", error);
  }
  hl_release(context, job->sums);
  if (status == HL_OK) made->colors = job->colors;
  else hl_release(made->context, job->colors);
  return status;
}

/* Makes the volume of several labels. values: [count], the values of the labels; parts: [count], scratch
 * memory. */
static hl_status make(hl_context *context, hl_pool *pool, int threads, solids_job *job, const int64_t *values,
                      hl_label_part *parts, hl_volume **made, hl_error *error) {
  hl_status status = hl_label_parts(context, pool, job->map, values, job->count, parts, error);
  if (status != HL_OK) return status;
  job->part = hl_label_part_of_all(parts, job->count);
  hl_label_work work = {.context = context, .whole = (double)hl_label_part_voxels(&job->part)};
  for (size_t n = 0; n < job->count && job->occupancies != NULL; n++)
    work.whole += (double)hl_label_part_voxels(&parts[n]);
  if (job->occupancies != NULL)
    status = hl_label_occupancies(context, threads, job->map, values, job->count, &work, job->occupancies,
                                  error);
  if (status == HL_OK)
    status = hl_label_occupancy(job->map->context, pool, job->map, values, job->count, &job->part, &work,
                                made, error);
  if (status == HL_OK && *made != NULL && job->occupancies != NULL)
    status = add_colors(context, pool, job, *made, error);
  if (status != HL_OK) {
    hl_volume_release(*made);
    *made = NULL;
  }
  return status;
}

hl_status hl_label_solids(hl_context *context, int threads, hl_volume *map, const hl_label *labels,
                          size_t count, hl_volume **made, hl_error *error) {
  *made = hl_solids_from_shelf(map, labels, count);
  if (*made != NULL) return HL_OK;
  const bool colored = !one_color(labels, count);
  int64_t *values = hl_allocate(context, count, sizeof *values);
  hl_label_part *parts = hl_allocate(context, count, sizeof *parts);
  hl_volume **occupancies = hl_allocate_zeroed(context, count, sizeof(hl_volume *));
  hl_pool *pool = NULL;
  hl_status status = HL_OK;
  if (values == NULL || parts == NULL || occupancies == NULL)
    status = hl_fail_memory(error, count * sizeof *parts, "labels");
  for (size_t n = 0; status == HL_OK && n < count; n++) values[n] = labels[n].value;
  if (status == HL_OK) status = hl_pool_create(context, threads, &pool, error);
  if (status == HL_OK) {
    solids_job job = {
        .map = map, .labels = labels, .count = count, .occupancies = colored ? occupancies : NULL};
    status = make(context, pool, threads, &job, values, parts, made, error);
    hl_pool_destroy(pool);
  }
  if (status == HL_OK && *made != NULL) hl_solids_to_shelf(map, labels, count, *made);
  for (size_t n = 0; occupancies != NULL && n < count; n++) hl_volume_release(occupancies[n]);
  hl_release(context, occupancies);
  hl_release(context, parts);
  hl_release(context, values);
  return status;
}
