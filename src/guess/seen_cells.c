/* guess/seen_cells.c - finds the voxels of a volume that count when a picture is framed, by optical depths of
 * cells and columns, without specks. */
#include "guess/seen_cells.h"

#include <stdbool.h>
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/looks.h"
#include "guess/sample.h"
#include "scene/geometry/placement.h"
#include "scene/label/label_table.h"
#include "volume/store/pages.h"

/* a voxel beside seen cells does not count if its opacity is below this fraction of the greatest opacity */
#define FAINT  0.02
#define LOST   0.04   /* least optical depth of a column whose cells count as seen */
#define OPAQUE 0.9999 /* limit of opacities; an opacity of 1 would have an infinite optical depth */
/* The greatest fraction of the seen cells that may be specks. If small bodies have a greater fraction of the
 * cells, the small bodies count as matter. */
#define SPECKS_AT_MOST 0.03
#define FAINT_RATIO    200 /* a body is a speck if another body has this many times its optical depth */

#define TISSUE        (-300) /* a limit in Hounsfield units: tissue is denser, foam and clothes are not \ */
#define BODY_AT_LEAST 0.8    /* least fraction of the dense cells that a patient's body has */
/* The least and the greatest number of a holder's cells, as a fraction of the body's cells. */
#define HOLDER_AT_LEAST (1.0 / 500)
#define HOLDER_AT_MOST  (1.0 / 30)

enum { BINS = 4096, SPECK = 3, SPECK_RATIO = 50, SMALL_RATIO = 5000 };

static double depth_of(const hl_transfer_function *function, double value) {
  double opacity = fmin(hl_transfer_function_opacity(function, value), OPAQUE);
  return -hl_log1p(-opacity) / function->unit_distance;
}

static double greatest_opacity(const hl_transfer_function *function, double low, double high) {
  double greatest = fmax(hl_transfer_function_opacity(function, low),
                         hl_transfer_function_opacity(function, high));
  for (size_t p = 0; p < function->opacity_count; p++)
    if (function->opacity[p].value >= low && function->opacity[p].value <= high)
      greatest = fmax(greatest, function->opacity[p].opacity);
  return greatest;
}

/* ---- depths of voxels ---- */

static hl_status make_table(hl_seen *seen, hl_error *error) {
  const hl_volume *volume = seen->volume;
  const bool whole = volume->storage != HL_STORAGE_F32;
  size_t count = volume->storage == HL_STORAGE_U8 ? 256 : whole ? 65536 : BINS + 1;
  seen->depth = hl_allocate(volume->context, count, sizeof *seen->depth);
  seen->bins.bends = hl_allocate_zeroed(volume->context, BINS, 1);
  if (seen->depth == NULL || seen->bins.bends == NULL)
    return hl_fail_memory(error, count * sizeof *seen->depth, "a table of opacities");
  double range = volume->maximum - volume->minimum;
  seen->bins.low = volume->minimum;
  seen->bins.scale = range > 0 ? BINS / range : 0;
  for (size_t n = 0; n < count; n++) {
    double value = whole ? volume->value_scale * (double)n + volume->value_offset
                         : volume->minimum + range * (double)n / BINS;
    seen->depth[n] = (float)depth_of(seen->bins.function, value);
  }
  for (size_t p = 0; p < seen->bins.function->opacity_count; p++) {
    double bin = (seen->bins.function->opacity[p].value - seen->bins.low) * seen->bins.scale;
    /* the function bends in both bins beside a point on their border */
    for (int side = -1; side <= 1; side++)
      if (bin + side * 1e-6 >= 0 && bin + side * 1e-6 < BINS) seen->bins.bends[(int)(bin + side * 1e-6)] = 1;
  }
  return HL_OK;
}

static float depth_of_float(const hl_seen *seen, float stored) {
  if (!isfinite(stored)) return 0;
  double value = seen->volume->value_scale * (double)stored + seen->volume->value_offset,
         at = (value - seen->bins.low) * seen->bins.scale;
  int bin = at < 0 ? 0 : at >= BINS ? BINS - 1 : (int)at;
  if (seen->bins.bends[bin]) return (float)depth_of(seen->bins.function, value);
  return seen->depth[bin] + (float)(at - bin) * (seen->depth[bin + 1] - seen->depth[bin]);
}

static float depth_at(const hl_seen *seen, const void *row, ptrdiff_t i) {
  switch (seen->volume->storage) {
    case HL_STORAGE_U8: return seen->depth[((const uint8_t *)row)[i]];
    case HL_STORAGE_U16: return seen->depth[((const uint16_t *)row)[i]];
    case HL_STORAGE_F32: break;
  }
  return depth_of_float(seen, ((const float *)row)[i]);
}

static double mask_factor(const hl_seen *seen, ptrdiff_t i, ptrdiff_t j, ptrdiff_t k) {
  return hl_mask_factor(seen->mask,
                        affine3_apply(seen->index_to_mask, (vec3){(double)i, (double)j, (double)k}));
}

/* A row of voxels. */
typedef struct voxel_row {
  const void *voxels;
  ptrdiff_t j, k;
  size_t cells; /* the row's first cell */
} voxel_row;

/* The optical depth per length of a voxel, after the transfer function and the mask. */
static float seen_depth(const hl_seen *seen, const voxel_row *row, ptrdiff_t i) {
  const float depth = depth_at(seen, row->voxels, i);
  return seen->mask == NULL || !(depth > 0) ? depth
                                            : (float)((double)depth * mask_factor(seen, i, row->j, row->k));
}

/* ---- cells and columns ---- */

static size_t cell_of(const hl_seen *seen, ptrdiff_t i, ptrdiff_t j, ptrdiff_t k) {
  size_t step = seen->step;
  return ((size_t)k / step * (size_t)seen->size[1] + (size_t)j / step) * (size_t)seen->size[0] +
         (size_t)i / step;
}

static voxel_row row_at(const hl_seen *seen, ptrdiff_t j, ptrdiff_t k) {
  return (voxel_row){hl_volume_row_in(seen->volume, (size_t)j, (size_t)k, seen->row), j, k,
                     cell_of(seen, 0, j, k)};
}

static void add_row(hl_seen *seen, ptrdiff_t j, ptrdiff_t k) {
  const voxel_row row = row_at(seen, j, k);
  float *mean = &seen->mean[row.cells];
  ptrdiff_t step = (ptrdiff_t)seen->step;
  for (ptrdiff_t i = seen->first[0]; i < seen->end[0];) {
    ptrdiff_t cell = i / step, end = (cell + 1) * step < seen->end[0] ? (cell + 1) * step : seen->end[0];
    float sum = 0;
    for (; i < end; i++) sum += seen_depth(seen, &row, i);
    mean[cell] += sum;
  }
}

/* The number of voxels of a cell that are examined along an axis; at least 1. */
static double looked_at(const hl_seen *seen, int axis, int cell) {
  ptrdiff_t step = (ptrdiff_t)seen->step, stride = axis == 0 ? 1 : (ptrdiff_t)seen->stride,
            begin = seen->first[axis];
  ptrdiff_t low = cell * step > begin ? cell * step : begin,
            high = low < (cell + 1) * step ? (cell + 1) * step : low;
  if (high > seen->end[axis]) high = seen->end[axis];
  ptrdiff_t count = (high - begin + stride - 1) / stride - (low - begin + stride - 1) / stride;
  return count > 0 ? (double)count : 1;
}

/* Marks the cells that the volume's cuts remove as not seen. */
static void forget_cut_cells(hl_seen *seen) {
  const int *n = seen->size;
  const double step = (double)seen->step;
  if (seen->cut_count == 0) return;
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++) {
        double low[3] = {i * step - 0.5, j * step - 0.5, k * step - 0.5};
        double high[3] = {low[0] + step, low[1] + step, low[2] + step};
        if (hl_cuts_remove_box(seen->cuts, seen->cut_count, low, high))
          seen->mean[((size_t)k * (size_t)n[1] + (size_t)j) * (size_t)n[0] + (size_t)i] = 0;
      }
}

static void make_means(hl_seen *seen) {
  ptrdiff_t stride = (ptrdiff_t)seen->stride;
  for (ptrdiff_t k = seen->first[2]; k < seen->end[2]; k += stride)
    for (ptrdiff_t j = seen->first[1]; j < seen->end[1]; j += stride) add_row(seen, j, k);
  float *mean = seen->mean;
  for (int k = 0; k < seen->size[2]; k++) {
    double along_z = looked_at(seen, 2, k);
    for (int j = 0; j < seen->size[1]; j++) {
      double along_yz = along_z * looked_at(seen, 1, j);
      for (int i = 0; i < seen->size[0]; i++, mean++)
        if (*mean > 0) *mean = (float)((double)*mean / along_yz / looked_at(seen, 0, i));
    }
  }
}

/* The optical depths of the columns along each axis: [j][k], [k][i], [i][j] for x, y, z; the second index
 * runs fastest. */
static void sum_columns(const hl_seen *seen, const double edge[3], float *column[3]) {
  const float *mean = seen->mean;
  const int *n = seen->size;
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++, mean++) {
        column[0][j * n[2] + k] += *mean * (float)edge[0];
        column[1][k * n[0] + i] += *mean * (float)edge[1];
        column[2][i * n[1] + j] += *mean * (float)edge[2];
      }
}

static float middle_of(float a, float b, float c) { return fmaxf(fminf(a, b), fminf(fmaxf(a, b), c)); }

static void mark_seen(hl_seen *seen, float *const column[3]) {
  const int *n = seen->size;
  size_t cell = 0;
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++, cell++) {
        float depth = middle_of(column[0][j * n[2] + k], column[1][k * n[0] + i], column[2][i * n[1] + j]);
        seen->kind[cell] = seen->mean[cell] > 0 && depth >= (float)LOST ? HL_SEEN : HL_SEEN_NOTHING;
      }
}

static hl_status find_seen_cells(hl_seen *seen, affine3 placement, hl_error *error) {
  hl_context *context = seen->volume->context;
  const int *n = seen->size;
  double edge[3];
  for (int a = 0; a < 3; a++) edge[a] = (double)seen->step * vec3_length(mat3_column(placement.linear, a));
  size_t faces[3] = {(size_t)n[1] * (size_t)n[2], (size_t)n[2] * (size_t)n[0], (size_t)n[0] * (size_t)n[1]};
  float *all = hl_allocate_zeroed(context, faces[0] + faces[1] + faces[2], sizeof *all);
  if (all == NULL)
    return hl_fail_memory(error, (faces[0] + faces[1] + faces[2]) * sizeof *all, "a volume's columns");
  float *column[3] = {all, all + faces[0], all + faces[0] + faces[1]};
  sum_columns(seen, edge, column);
  mark_seen(seen, column);
  hl_release(context, all);
  return HL_OK;
}

/* ---- specks ---- */

static bool is_speck(const hl_bodies *bodies, const double *depth, double most_depth, uint32_t body) {
  uint64_t places = bodies->places[body], most = bodies->places[bodies->largest];
  return (places <= SPECK && SPECK_RATIO * places <= most) || SMALL_RATIO * places <= most ||
         FAINT_RATIO * depth[body] <= most_depth;
}

/* Sums each body's optical depths: [bodies->count + 1]. Returns the greatest sum. */
static double sum_depths(const hl_seen *seen, const hl_bodies *bodies, size_t cells, double *depth) {
  double most = 0;
  for (size_t c = 0; c < cells; c++)
    if (bodies->body[c] != 0) depth[bodies->body[c]] += (double)seen->mean[c];
  for (uint32_t b = 1; b <= bodies->count; b++) most = fmax(most, depth[b]);
  return most;
}

static hl_status forget_specks(hl_seen *seen, hl_error *error) {
  hl_context *context = seen->volume->context;
  const size_t cells = (size_t)seen->size[0] * (size_t)seen->size[1] * (size_t)seen->size[2];
  hl_bodies bodies;
  double *depth = NULL, all = 0, specks = 0;
  hl_status status = hl_bodies_find(context, seen->kind, seen->size, &bodies, error);
  if (status == HL_OK) {
    depth = hl_allocate_zeroed(context, (size_t)bodies.count + 1, sizeof *depth);
    if (depth == NULL)
      status = hl_fail_memory(error, (size_t)bodies.count * sizeof *depth, "a volume's bodies");
  }
  if (status == HL_OK) {
    const double most = sum_depths(seen, &bodies, cells, depth);
    for (uint32_t b = 1; b <= bodies.count; b++) {
      all += bodies.places[b];
      specks += is_speck(&bodies, depth, most, b) ? bodies.places[b] : 0;
    }
    if (specks > 0 && specks <= SPECKS_AT_MOST * all)
      for (size_t c = 0; c < cells; c++)
        if (bodies.body[c] != 0 && is_speck(&bodies, depth, most, bodies.body[c]))
          seen->kind[c] = HL_SEEN_NOTHING;
  }
  hl_release(context, depth);
  hl_bodies_release(context, &bodies);
  return status;
}

/* ---- things that hold a patient ---- */

/* Returns whether there is one body of a patient, and all other bodies are head rests, straps or a table. */
static bool has_holder(const hl_bodies *bodies) {
  double most = bodies->places[bodies->largest], all = 0;
  bool any = false;
  for (uint32_t b = 1; b <= bodies->count; b++) {
    double places = bodies->places[b];
    all += places;
    any = any || (places >= HOLDER_AT_LEAST * most && places <= HOLDER_AT_MOST * most);
  }
  return any && most >= BODY_AT_LEAST * all;
}

/* In CT scans whose transfer function shows tissue, marks the holders of the patient as not seen. Only dense
 * cells are looked at, because air or foam separates the dense cells of a holder from the dense cells of the
 * body. */
static hl_status forget_holders(hl_seen *seen, hl_error *error) {
  hl_context *context = seen->volume->context;
  size_t cells = (size_t)seen->size[0] * (size_t)seen->size[1] * (size_t)seen->size[2];
  float least = (float)depth_of(seen->bins.function, TISSUE);
  if (!hl_is_hounsfield(seen->volume) || !(least > 0)) return HL_OK;
  unsigned char *dense = hl_allocate(context, cells, 1);
  if (dense == NULL) return hl_fail_memory(error, cells, "a volume's dense cells");
  for (size_t c = 0; c < cells; c++) dense[c] = seen->kind[c] == HL_SEEN && seen->mean[c] >= least;
  hl_bodies bodies;
  hl_status status = hl_bodies_find(context, dense, seen->size, &bodies, error);
  if (status == HL_OK && has_holder(&bodies))
    for (size_t c = 0; c < cells; c++)
      if (bodies.places[bodies.body[c]] <= HOLDER_AT_MOST * bodies.places[bodies.largest])
        seen->kind[c] = HL_SEEN_NOTHING;
  hl_bodies_release(context, &bodies);
  hl_release(context, dense);
  return status;
}

/* Marks the cells beside a seen cell, which may contain the rim of its matter. */
static void mark_neighbours(hl_seen *seen, int i, int j, int k) {
  const int *n = seen->size;
  for (int z = k > 0 ? k - 1 : 0; z <= k + 1 && z < n[2]; z++)
    for (int y = j > 0 ? j - 1 : 0; y <= j + 1 && y < n[1]; y++)
      for (int x = i > 0 ? i - 1 : 0; x <= i + 1 && x < n[0]; x++) {
        unsigned char *kind = &seen->kind[((size_t)z * (size_t)n[1] + (size_t)y) * (size_t)n[0] + (size_t)x];
        if (*kind == HL_SEEN_NOTHING) *kind = HL_SEEN_BESIDE;
      }
}

static void mark_beside(hl_seen *seen) {
  const int *n = seen->size;
  size_t cell = 0;
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++, cell++)
        if (seen->kind[cell] == HL_SEEN) mark_neighbours(seen, i, j, k);
}

/* ---- all steps together ---- */

/* Finds the voxels whose centres lie inside the volume's box. */
static bool find_range(const hl_scene_volume *volume, hl_seen *seen) {
  double low[3], high[3];
  bool any = true;
  hl_scene_volume_box(volume, low, high);
  for (int a = 0; a < 3; a++) {
    seen->first[a] = (ptrdiff_t)ceil(fmax(low[a], 0));
    seen->end[a] = (ptrdiff_t)floor(fmin(high[a], (double)volume->volume->dimension[a] - 1)) + 1;
    any = any && seen->first[a] < seen->end[a];
  }
  return any;
}

static hl_status make_cells(hl_seen *seen, hl_error *error) {
  const hl_volume *volume = seen->volume;
  size_t cells = 1;
  seen->step = hl_lattice_step(volume->dimension, HL_CELL_PLACES);
  seen->stride = hl_row_step(volume->dimension);
  for (int a = 0; a < 3; a++) {
    seen->size[a] = (int)((volume->dimension[a] + seen->step - 1) / seen->step);
    cells *= (size_t)seen->size[a];
  }
  seen->kind = hl_allocate_zeroed(volume->context, cells, 1);
  seen->mean = hl_allocate_zeroed(volume->context, cells, sizeof *seen->mean);
  if (volume->voxels == NULL)
    seen->row = hl_allocate(volume->context, volume->dimension[0], hl_storage_bytes(volume->storage));
  return seen->kind != NULL && seen->mean != NULL && (volume->voxels != NULL || seen->row != NULL)
             ? HL_OK
             : hl_fail_memory(error, cells * sizeof *seen->mean, "a volume's cells");
}

static void set_mask(const hl_scene_volume *volume, hl_seen *seen) {
  affine3 world_to_mask;
  if (volume->mask.volume == NULL || !affine3_invert(hl_scene_mask_index_to_world(volume), &world_to_mask))
    return;
  seen->mask = &volume->mask;
  seen->index_to_mask = affine3_multiply(world_to_mask, hl_scene_volume_index_to_world(volume));
}

hl_status hl_seen_find(const hl_scene_volume *volume, hl_seen *seen, bool *any, hl_error *error) {
  const hl_transfer_function *function = &volume->transfer_function;
  double greatest = greatest_opacity(function, volume->volume->minimum, volume->volume->maximum);
  *seen = (hl_seen){.volume = volume->volume, .cut_count = volume->cut_count, .bins.function = function};
  *any = volume->visible && greatest > 0 && find_range(volume, seen);
  if (!*any) return HL_OK;
  set_mask(volume, seen);
  seen->faint = (float)(-hl_log1p(-FAINT * fmin(greatest, OPAQUE)) / function->unit_distance * (1 - 1e-6));
  hl_status status = make_table(seen, error);
  if (status == HL_OK) status = make_cells(seen, error);
  if (status == HL_OK) status = hl_cut_shapes(volume->volume->context, volume, &seen->cuts, error);
  if (status != HL_OK) return status;
  make_means(seen);
  forget_cut_cells(seen);
  status = find_seen_cells(seen, hl_scene_volume_index_to_world(volume), error);
  if (status == HL_OK) status = forget_specks(seen, error);
  if (status == HL_OK) status = forget_holders(seen, error);
  if (status == HL_OK) mark_beside(seen);
  return status;
}

void hl_seen_release(hl_seen *seen) {
  hl_context *context = seen->volume->context;
  if (seen->volume->pages != NULL) hl_pages_forget(seen->volume->pages);
  if (seen->mask != NULL && seen->mask->volume->pages != NULL) hl_pages_forget(seen->mask->volume->pages);
  hl_release(context, seen->depth);
  hl_release(context, seen->bins.bends);
  hl_release(context, seen->kind);
  hl_release(context, seen->mean);
  hl_release(context, seen->row);
  hl_release(context, seen->cuts);
}

/* The least optical depth per length of the voxels that count in a cell. In a seen cell, half of the cell's
 * mean is enough. */
static float least_depth(const hl_seen *seen, size_t cell) {
  return seen->kind[cell] == HL_SEEN ? fminf(seen->faint, seen->mean[cell] / 2) : seen->faint;
}

/* The index of the first voxel in a row that counts, searched from index `from` to `to`; `to + way` if none
 * counts. way: 1 or -1. */
static ptrdiff_t first_that_counts(const hl_seen *seen, const voxel_row *row, ptrdiff_t from, ptrdiff_t to,
                                   int way) {
  const ptrdiff_t step = (ptrdiff_t)seen->step;
  const size_t cells = row->cells;
  for (ptrdiff_t i = from; way * (to - i) >= 0;) {
    ptrdiff_t cell = i / step, next = way > 0 ? (cell + 1) * step : cell * step - 1;
    if (way * (next - to) > 0) next = to + way;
    if (seen->kind[cells + (size_t)cell] == HL_SEEN_NOTHING) {
      i = next;
      continue;
    }
    float least = least_depth(seen, cells + (size_t)cell);
    for (; i != next; i += way)
      if (seen_depth(seen, row, i) >= least &&
          hl_cuts_leave(seen->cuts, seen->cut_count, (vec3){(double)i, (double)row->j, (double)row->k}))
        return i;
  }
  return to + way;
}

bool hl_seen_row(const hl_seen *seen, ptrdiff_t j, ptrdiff_t k, ptrdiff_t *first, ptrdiff_t *last) {
  const voxel_row row = row_at(seen, j, k);
  ptrdiff_t end = seen->end[0] - 1;
  *first = first_that_counts(seen, &row, seen->first[0], end, 1);
  if (*first > end) return false;
  *last = first_that_counts(seen, &row, end, *first, -1);
  return true;
}

/* ---- bodies: a flood from each marked place that none has reached yet ---- */

typedef struct flood {
  const unsigned char *marked;
  const int *size;
  uint32_t *body;
  uint32_t *waiting; /* [places]; each place waits at most once */
} flood;

static void reach(flood *f, size_t place, uint32_t body, size_t *end) {
  if (!f->marked[place] || f->body[place] != 0) return;
  f->body[place] = body;
  f->waiting[(*end)++] = (uint32_t)place;
}

static void flood_from(flood *f, size_t start, uint32_t body) {
  const size_t nx = (size_t)f->size[0], ny = (size_t)f->size[1], nz = (size_t)f->size[2];
  size_t end = 0;
  reach(f, start, body, &end);
  for (size_t next = 0; next < end; next++) {
    size_t p = f->waiting[next], x = p % nx, y = p / nx % ny, z = p / nx / ny;
    if (x > 0) reach(f, p - 1, body, &end);
    if (x + 1 < nx) reach(f, p + 1, body, &end);
    if (y > 0) reach(f, p - nx, body, &end);
    if (y + 1 < ny) reach(f, p + nx, body, &end);
    if (z > 0) reach(f, p - nx * ny, body, &end);
    if (z + 1 < nz) reach(f, p + nx * ny, body, &end);
  }
}

static hl_status count_places(hl_context *context, size_t places, hl_bodies *bodies, hl_error *error) {
  bodies->places = hl_allocate_zeroed(context, (size_t)bodies->count + 1, sizeof *bodies->places);
  if (bodies->places == NULL)
    return hl_fail_memory(error, ((size_t)bodies->count + 1) * sizeof *bodies->places, "a volume's bodies");
  for (size_t p = 0; p < places; p++) bodies->places[bodies->body[p]]++;
  bodies->places[0] = 0;
  for (uint32_t b = 1; b <= bodies->count; b++)
    if (bodies->places[b] > bodies->places[bodies->largest]) bodies->largest = b;
  return HL_OK;
}

hl_status hl_bodies_find(hl_context *context, const unsigned char *marked, const int size[3],
                         hl_bodies *bodies, hl_error *error) {
  const size_t places = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
  *bodies = (hl_bodies){.body = hl_allocate_zeroed(context, places, sizeof *bodies->body)};
  flood f = {marked, size, bodies->body, hl_allocate(context, places, sizeof *f.waiting)};
  hl_status status = HL_OK;
  if (bodies->body == NULL || f.waiting == NULL) {
    status = hl_fail_memory(error, 2 * places * sizeof *f.waiting, "a volume's bodies");
  } else {
    for (size_t p = 0; p < places; p++)
      if (marked[p] && bodies->body[p] == 0) flood_from(&f, p, ++bodies->count);
    status = count_places(context, places, bodies, error);
  }
  hl_release(context, f.waiting);
  return status;
}

void hl_bodies_release(hl_context *context, hl_bodies *bodies) {
  hl_release(context, bodies->body);
  hl_release(context, bodies->places);
  *bodies = (hl_bodies){0};
}
