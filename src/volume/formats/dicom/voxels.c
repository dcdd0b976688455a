/* volume/formats/dicom/voxels.c - decodes slices on several threads, rescales their values, fills gaps.
 *
 * If all slices have the same slope and intercept, voxels stay integers, and slope and intercept become the
 * volume's value_scale and value_offset. If slopes or intercepts differ, as in PET, values are computed and
 * kept as floats. Voxels that have the padding value become NAN. If any slice has voxels with the padding
 * value, all integers are converted to floats at the end. */
#include "volume/formats/dicom/voxels.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/pool.h"
#include "ranks/ranks.h"
#include "volume/convert.h"
#include "volume/formats/dicom/frame.h"
#include "volume/formats/dicom/segmentation.h"
#include "volume/io/destination.h"
#include "volume/io/parallel.h"

typedef struct reading {
  const hl_dicom_set *set;
  const hl_dicom_stack *stack;
  size_t time;   /* index of the frame that is read among the frames at each position */
  int component; /* the sample to take, or HL_COMPONENT_MAGNITUDE */
  hl_voxel_type type;
  bool as_floats; /* whether values are computed as floats; otherwise the file's integers are stored */
  bool as_colors; /* whether values are colours (colors.h) */
  bool is_plain;  /* whether the stored values are the files' own numbers, of `type`, in all slices */
  /* The padding range is the same for all slices. Slope and intercept are set only if as_floats is false. */
  struct {
    double slope, intercept, padding[2];
  } scale;
  size_t slice_voxels, voxel_bytes;
  hl_destination to; /* receives the voxels, [slices][slice_voxels], each of voxel_bytes */
  struct {
    hl_pool *pool;
    hl_dicom_workspace *spaces; /* owned; one workspace for each worker */
    unsigned char **others;     /* owned; for each worker, a slice that is needed when a gap is filled;
                                 * allocated when first needed */
  } workers;
  atomic_bool padded; /* whether any slice has a voxel with the padding value */
} reading;

/* ---- which type ---- */

static const hl_dicom_frame *frame_at(const reading *r, size_t place) {
  return r->stack->frames[place * r->stack->times + r->time];
}

static bool same_number(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

static hl_voxel_type type_of(const hl_dicom_pixels *p) {
  if (p->has_palette) return HL_VOXEL_U8;
  if (p->is_float) return p->allocated == 32 ? HL_VOXEL_F32 : HL_VOXEL_F64;
  if (p->allocated <= 8) return p->is_signed && p->allocated == 8 ? HL_VOXEL_I8 : HL_VOXEL_U8;
  if (p->allocated == 16) return p->is_signed ? HL_VOXEL_I16 : HL_VOXEL_U16;
  return p->is_signed ? HL_VOXEL_I32 : HL_VOXEL_U32;
}

static void choose_type(reading *r) {
  const hl_dicom_frame *first = frame_at(r, 0);
  const hl_dicom_file *file = &r->set->files[first->file];
  r->type = type_of(&file->pixels);
  r->scale.slope = first->slope;
  r->scale.intercept = first->intercept;
  memcpy(r->scale.padding, file->padding, sizeof r->scale.padding);
  r->as_floats = hl_voxel_type_storage(r->type) == HL_STORAGE_F32;
  for (size_t n = 1; n < r->stack->place_count && !r->as_floats; n++) {
    const hl_dicom_frame *frame = frame_at(r, n);
    const hl_dicom_file *other = &r->set->files[frame->file];
    r->as_floats = frame->slope != r->scale.slope || frame->intercept != r->scale.intercept ||
                   type_of(&other->pixels) != r->type ||
                   !same_number(other->padding[0], r->scale.padding[0]) ||
                   !same_number(other->padding[1], r->scale.padding[1]);
  }
  r->is_plain = r->component != HL_COMPONENT_MAGNITUDE;
  for (size_t n = 0; n < r->stack->place_count; n++) {
    const hl_dicom_frame *frame = frame_at(r, n);
    r->is_plain = r->is_plain && frame->slope == 1 && frame->intercept == 0 &&
                  type_of(&r->set->files[frame->file].pixels) == r->type;
  }
  if (r->component == HL_COMPONENT_MAGNITUDE || r->stack->empty_count > 0) r->as_floats = true;
  r->as_colors = hl_component_is_colors(r->component);
  if (r->as_colors) r->as_floats = false;
  r->voxel_bytes = r->as_colors ? HL_COLOR_BYTES : r->voxel_bytes;
  if (!r->as_colors)
    r->voxel_bytes = r->as_floats ? sizeof(float) : hl_storage_bytes(hl_voxel_type_storage(r->type));
}

/* ---- one slice ---- */

static double value_at(const hl_dicom_workspace *space, hl_voxel_type type, size_t index) {
  const void *values = space->values;
  switch (type) {
    case HL_VOXEL_U8: return ((const uint8_t *)values)[index];
    case HL_VOXEL_I8: return ((const int8_t *)values)[index];
    case HL_VOXEL_U16: return ((const uint16_t *)values)[index];
    case HL_VOXEL_I16: return ((const int16_t *)values)[index];
    case HL_VOXEL_U32: return ((const uint32_t *)values)[index];
    case HL_VOXEL_I32: return ((const int32_t *)values)[index];
    case HL_VOXEL_F32: return (double)((const float *)values)[index];
    default: return ((const double *)values)[index];
  }
}

/* Stores a slice as floats. first: the number of the slice's first voxel in the volume. */
static void store_floats(reading *r, const hl_dicom_frame *frame, const hl_dicom_workspace *space,
                         size_t first, float *slice) {
  const hl_dicom_file *file = &r->set->files[frame->file];
  size_t samples = hl_dicom_read_samples(&file->pixels);
  hl_voxel_type type = type_of(&file->pixels);
  for (size_t n = 0; n < r->slice_voxels; n++) {
    size_t at = n * samples;
    double value = 0;
    if (r->component == HL_COMPONENT_MAGNITUDE) {
      for (size_t s = 0; s < samples; s++) {
        double sample = value_at(space, type, at + s);
        value += sample * sample;
      }
      slice[n] = (float)sqrt(value);
      continue;
    }
    value = value_at(space, type, at + (samples > 1 ? (size_t)r->component : 0));
    bool padded = value >= file->padding[0] && value <= file->padding[1];
    slice[n] = padded ? NAN : (float)(frame->slope * value + frame->intercept);
    if (r->is_plain && !padded)
      hl_destination_note(
          &r->to, false, space->values + (at + (samples > 1 ? (size_t)r->component : 0)) * space->value_bytes,
          first + n, 1);
  }
}

static void store_integers(reading *r, hl_dicom_workspace *space, size_t samples, unsigned char *slice) {
  size_t bytes = r->voxel_bytes;
  if (samples > 1)
    for (size_t n = 0; n < r->slice_voxels; n++)
      memmove(space->values + n * bytes, space->values + (n * samples + (size_t)r->component) * bytes, bytes);
  if (!isnan(r->scale.padding[0]) && !r->padded)
    for (size_t n = 0; n < r->slice_voxels; n++) {
      double value = value_at(space, r->type, n);
      if (value < r->scale.padding[0] || value > r->scale.padding[1]) continue;
      r->padded = true;
      break;
    }
  hl_voxels_store(r->type, false, space->values, r->slice_voxels, slice);
}

/* Reads a slice. first: the number of the slice's first voxel in the volume. */
static hl_status read_slice(reading *r, size_t place, int worker, size_t first, unsigned char *slice,
                            hl_error *error) {
  hl_dicom_workspace *space = &r->workers.spaces[worker];
  const hl_dicom_frame *frame = frame_at(r, place);
  space->context = r->set->context;
  hl_status status = hl_dicom_read_frame(r->set, frame, space, error);
  if (status != HL_OK) return status;
  size_t samples = hl_dicom_read_samples(&r->set->files[frame->file].pixels);
  if (r->as_floats) store_floats(r, frame, space, first, (float *)(void *)slice);
  else if (!r->as_colors) store_integers(r, space, samples, slice);
  for (size_t s = 0; s < samples && r->as_colors; s++)
    hl_colors_store(r->type, space->values + s * space->value_bytes, samples, r->slice_voxels, s, slice);
  return HL_OK;
}

/* ---- missing slices: interpolated linearly from the slices beside them ---- */

static void blend(const reading *r, double weight, unsigned char *slice, const unsigned char *other) {
  float *floats = (float *)(void *)slice;
  uint16_t *words = (uint16_t *)(void *)slice;
  size_t count = r->as_colors ? HL_COLOR_BYTES * r->slice_voxels : r->slice_voxels;
  for (size_t n = 0; n < count; n++) {
    if (r->as_floats) {
      float after = ((const float *)(const void *)other)[n];
      if (isnan(floats[n])) floats[n] = after;
      else if (!isnan(after)) floats[n] = (float)((1 - weight) * (double)floats[n] + weight * (double)after);
    } else if (!r->as_colors && r->voxel_bytes == 2) {
      double after = ((const uint16_t *)(const void *)other)[n];
      words[n] = (uint16_t)floor((1 - weight) * words[n] + weight * after + 0.5);
    } else slice[n] = (unsigned char)floor((1 - weight) * slice[n] + weight * other[n] + 0.5);
  }
}

static hl_status fill_gap(reading *r, const hl_dicom_slice *slice, int worker, size_t first,
                          unsigned char *voxels, hl_error *error) {
  size_t bytes = r->slice_voxels * r->voxel_bytes;
  if (r->workers.others[worker] == NULL) r->workers.others[worker] = hl_allocate(r->set->context, bytes, 1);
  if (r->workers.others[worker] == NULL) return hl_fail_memory(error, bytes, "a slice");
  hl_status status = read_slice(r, slice->place + 1, worker, first, r->workers.others[worker], error);
  if (status == HL_OK) blend(r, slice->weight, voxels, r->workers.others[worker]);
  return status;
}

/* Fills an empty slice with NAN, or with black if voxels are not floats. */
static void leave_empty(const reading *r, void *slice) {
  if (!r->as_floats) memset(slice, 0, r->slice_voxels * r->voxel_bytes);
  for (size_t n = 0; n < r->slice_voxels && r->as_floats; n++) ((float *)slice)[n] = NAN;
}

/* ---- all slices ---- */

static hl_status read_one(void *data, size_t index, int worker, hl_error *error) {
  reading *r = data;
  const hl_dicom_slice *slice = &r->stack->slices[index];
  void *voxels;
  size_t first = index * r->slice_voxels;
  if (!hl_destination_wants(&r->to, first, r->slice_voxels)) return HL_OK;
  hl_status status = hl_destination_take(&r->to, first, r->slice_voxels, &voxels, error);
  if (status != HL_OK) return status;
  if (slice->empty) leave_empty(r, voxels);
  else status = read_slice(r, slice->place, worker, first, voxels, error);
  if (status == HL_OK && slice->weight > 0) status = fill_gap(r, slice, worker, first, voxels, error);
  hl_destination_put(&r->to, first, r->slice_voxels, voxels);
  return status;
}

/* Converts integers to floats in the same memory, from the last voxel to the first. Padding values become
 * NAN. */
static void widen(const reading *r, size_t count, void *voxels) {
  double bias = hl_voxel_type_bias(r->type);
  float *floats = voxels;
  for (size_t n = count; n > 0; n--) {
    double stored = r->voxel_bytes == 1 ? ((const uint8_t *)voxels)[n - 1]
                                        : ((const uint16_t *)voxels)[n - 1];
    double value = stored - bias;
    bool padded = value >= r->scale.padding[0] && value <= r->scale.padding[1];
    float wide = padded ? NAN : (float)(r->scale.slope * value + r->scale.intercept);
    memcpy(floats + n - 1, &wide, sizeof wide);
  }
}

static hl_status widen_padded(reading *r, size_t count, hl_error *error) {
  if (!r->padded || r->as_floats) return HL_OK;
  void *larger = hl_reallocate(r->set->context, r->to.voxels, count, sizeof(float));
  if (larger == NULL) return hl_fail_memory(error, count * sizeof(float), r->set->bundle->path);
  r->to.voxels = larger;
  widen(r, count, larger);
  r->as_floats = true;
  return HL_OK;
}

static hl_status make_threads(reading *r, size_t voxels, hl_error *error) {
  enum { WORTH_THREADS = 1 << 20 }; /* voxels */
  hl_status status = hl_pool_create(r->set->context, voxels < WORTH_THREADS ? 1 : 0, &r->workers.pool, error);
  if (status != HL_OK) return status;
  size_t threads = (size_t)hl_pool_threads(r->workers.pool);
  r->workers.spaces = hl_allocate_zeroed(r->set->context, threads, sizeof *r->workers.spaces);
  r->workers.others = hl_allocate_zeroed(r->set->context, threads, sizeof *r->workers.others);
  return r->workers.spaces != NULL && r->workers.others != NULL ? HL_OK
                                                                : hl_fail_memory(error, 1000, "threads");
}

/* Looks for padding in the middle slice. If the slice has padding, the volume is read as floats from the
 * start. Finding padding later would mean to convert all integers to floats, which needs memory for integers
 * and floats at the same time. */
static hl_status find_padding(reading *r, hl_error *error) {
  if (r->as_floats || r->as_colors || isnan(r->scale.padding[0])) return HL_OK;
  size_t middle = r->stack->place_count / 2, bytes = r->slice_voxels * r->voxel_bytes;
  unsigned char *slice = hl_allocate(r->set->context, bytes, 1);
  hl_status status = slice == NULL ? hl_fail_memory(error, bytes, "a slice")
                                   : read_slice(r, middle, 0, 0, slice, error);
  hl_release(r->set->context, slice);
  if (status != HL_OK || !r->padded) return status;
  r->padded = false;
  r->as_floats = true;
  r->voxel_bytes = sizeof(float);
  return HL_OK;
}

/* The voxel type of the values that the destination stores. */
static hl_voxel_type kept_type(const reading *r) {
  return r->as_floats && hl_voxel_type_storage(r->type) != HL_STORAGE_F32 ? HL_VOXEL_F32 : r->type;
}

static hl_status read_slices(reading *r, hl_error *error) {
  hl_volume_description grid = r->stack->grid;
  grid.type = kept_type(r);
  hl_status status = hl_destination_open(r->set->context, &grid,
                                         r->as_colors ? HL_DESTINATION_COLORS : HL_DESTINATION_PIECES,
                                         r->set->bundle->path, &r->to, error);
  if (status != HL_OK) return status;
  return hl_parallel_read(r->set->context, r->workers.pool, r->set->bundle->path,
                          r->stack->grid.dimensions[2], read_one, r, error);
}

/* Returns whether any slice has padding. If the work is divided among ranks, the result is whether any rank
 * has a slice with padding. */
static bool any_padded(const reading *r) {
  uint64_t padded = r->padded;
  if (r->to.own != NULL) hl_ranks_sum_counts(r->set->context->ranks, &padded, 1);
  return padded > 0;
}

/* Reads all slices. If integers include padding values, all voxels must become floats. For this purpose
 * widen_padded() later converts voxels in memory; voxels that are not in memory are read a second time. */
static hl_status read_all(reading *r, hl_error *error) {
  hl_status status = find_padding(r, error);
  if (status == HL_OK) status = read_slices(r, error);
  if (status != HL_OK || r->as_floats || !hl_destination_is_apart(&r->to) || !any_padded(r)) return status;
  hl_destination_close(&r->to);
  for (int w = 0; w < hl_pool_threads(r->workers.pool); w++) {
    hl_release(r->set->context, r->workers.others[w]); /* floats need larger memory for the slices from which
                                                        * gaps are filled */
    r->workers.others[w] = NULL;
  }
  r->as_floats = true;
  r->voxel_bytes = sizeof(float);
  return read_slices(r, error);
}

/* Takes the window that the middle slice states (PS3.3, C.11.2.1.2, by which the middle of the window is its
 * stated centre less one half). */
static void take_window(const reading *r, double window[2]) {
  const hl_dicom_frame *frame = frame_at(r, r->stack->place_count / 2);
  const double *told = r->set->files[frame->file].window; /* centre and width */
  if (!isfinite(told[0]) || !isfinite(told[1]) || told[1] < 1) return;
  window[0] = told[0] - 0.5 - (told[1] - 1) / 2;
  window[1] = told[0] - 0.5 + (told[1] - 1) / 2;
}

static hl_status make_volume(reading *r, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_volume_description grid = r->stack->grid;
  grid.type = kept_type(r);
  if (!r->as_floats && !r->as_colors) {
    grid.value_scale = r->scale.slope;
    grid.value_offset = r->scale.intercept;
  }
  for (int axis = 0; axis < 3 && request->spacing[0] > 0; axis++) {
    double length = vec3_length(vec3_of(grid.axis[axis]));
    for (int row = 0; row < 3; row++) grid.axis[axis][row] *= request->spacing[axis] / length;
  }
  take_window(r, request->window);
  request->unit = "millimetre";
  request->is_anatomical = grid.space != HL_SPACE_UNKNOWN;
  const hl_color_source source = {&grid, r->set->bundle->path, 3, r->component, false};
  return r->as_colors ? hl_destination_adopt_colors(&r->to, &source, volume, error)
                      : hl_destination_adopt(&r->to, &grid, volume, error);
}

static hl_status read_volume(reading *r, hl_load_request *request, hl_volume **volume, hl_error *error) {
  const size_t *n = r->stack->grid.dimensions;
  size_t count = n[0] * n[1] * n[2];
  r->slice_voxels = n[0] * n[1];
  hl_status status = make_threads(r, count, error);
  if (status == HL_OK) status = read_all(r, error);
  for (int w = 0; r->workers.pool != NULL && w < hl_pool_threads(r->workers.pool); w++) {
    if (r->workers.spaces != NULL) hl_dicom_workspace_release(&r->workers.spaces[w]);
    if (r->workers.others != NULL) hl_release(r->set->context, r->workers.others[w]);
  }
  hl_release(r->set->context, r->workers.spaces);
  hl_release(r->set->context, r->workers.others);
  hl_pool_destroy(r->workers.pool);
  if (status == HL_OK) status = widen_padded(r, count, error);
  if (status == HL_OK) status = make_volume(r, request, volume, error);
  hl_destination_close(&r->to);
  return status;
}

static hl_status choose(reading *r, hl_load_request *request, hl_error *error) {
  const hl_dicom_pixels *p = &r->set->files[r->stack->frames[0]->file].pixels;
  const char *path = r->set->bundle->path;
  hl_payload payload;
  hl_payload_defaults(&payload);
  payload.grid.type = type_of(p);
  payload.components = hl_dicom_read_samples(p);
  if (hl_can_be_colors(payload.grid.type, payload.components)) payload.colors = HL_COLORS_MEANT;
  hl_status status = hl_steps_choose(request, path, r->stack->times, 1, error);
  if (status == HL_OK) status = hl_component_only(request, path, false, &payload, error);
  r->time = (size_t)request->selection.time;
  r->component = payload.component;
  return status;
}

hl_status hl_dicom_voxels_read(hl_dicom_set *set, hl_dicom_stack *stack, hl_load_request *request,
                               hl_volume **volume, hl_error *error) {
  if (stack->segments != NULL) return hl_dicom_segmentation_read(set, stack, request, volume, error);
  reading *r = hl_allocate_zeroed(set->context, 1, sizeof *r);
  if (r == NULL) return hl_fail_memory(error, sizeof *r, set->bundle->path);
  r->set = set;
  r->stack = stack;
  hl_status status = choose(r, request, error);
  if (status == HL_OK) {
    choose_type(r);
    stack->grid.type = r->type;
    status = hl_volume_check_grid(&stack->grid, set->bundle->path, error);
  }
  for (size_t n = 0; n < stack->place_count && status == HL_OK; n++)
    status = hl_dicom_find_frames(set, &set->files[frame_at(r, n)->file], error);
  const hl_dicom_segments *segments = &set->files[frame_at(r, 0)->file].segments;
  if (status == HL_OK) status = read_volume(r, request, volume, error);
  if (status == HL_OK && segments->kind == HL_DICOM_LABEL_MAP) {
    status = hl_dicom_name_segments(segments, NULL, *volume, error);
    if (status != HL_OK) hl_volume_release(*volume), *volume = NULL;
  }
  hl_release(set->context, r);
  return status;
}
