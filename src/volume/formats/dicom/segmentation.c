/* volume/formats/dicom/segmentation.c - makes a volume of a segmentation whose frames are masks or fractions
 * of segments.
 *
 * All masks are read twice: the first time to find which segments overlap, the second time to make the label
 * map. */
#include "volume/formats/dicom/segmentation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/pool.h"
#include "volume/convert.h"
#include "volume/formats/dicom/frame.h"
#include "volume/io/destination.h"
#include "volume/io/parallel.h"

/* The greatest number of components of a label map. A file whose segments need more components is refused. */
enum { LAYERS_MOST = 64 };

typedef struct segment_reading {
  const hl_dicom_set *set;
  const hl_dicom_stack *stack;
  int *layers;             /* owned; [segments]; the component to which each segment belongs */
  unsigned char *overlaps; /* owned; [segments][segments]: 1 for two segments that share a voxel */
  size_t layer_count;
  size_t chosen; /* for a file of fractions, the index of the segment that is read; for a file of masks, the
                  * index of the component that is read */
  bool fractions;
  hl_voxel_type type;
  size_t slice_voxels;
  hl_destination to;
  hl_pool *pool;
  hl_dicom_workspace *spaces; /* owned; one workspace for each worker */
} segment_reading;

static const hl_dicom_frame *frame_at(const segment_reading *r, size_t place, size_t segment) {
  return r->stack->frames[place * r->stack->times + segment];
}

/* ---- which segments overlap ---- */

/* Packs a slice's mask into bits: bit n is 1 if voxel n is not 0. */
static void pack(const unsigned char *values, size_t count, uint64_t *bits) {
  memset(bits, 0, (count + 63) / 64 * sizeof *bits);
  for (size_t n = 0; n < count; n++) bits[n / 64] |= (uint64_t)(values[n] != 0) << (n % 64);
}

static bool share_a_bit(const uint64_t *a, const uint64_t *b, size_t words) {
  for (size_t n = 0; n < words; n++)
    if ((a[n] & b[n]) != 0) return true;
  return false;
}

/* Reads the masks of all segments at the position `place`, and stores which segments overlap. masks: scratch
 * memory for the masks of all segments. */
static hl_status compare_place(segment_reading *r, size_t place, uint64_t *masks, size_t *shown,
                               hl_error *error) {
  size_t words = (r->slice_voxels + 63) / 64, count = 0, segments = r->stack->times;
  for (size_t s = 0; s < segments; s++) {
    const hl_dicom_frame *frame = frame_at(r, place, s);
    if (frame == NULL) continue;
    hl_status status = hl_dicom_read_frame(r->set, frame, &r->spaces[0], error);
    if (status != HL_OK) return status;
    uint64_t *mask = masks + count * words;
    pack(r->spaces[0].values, r->slice_voxels, mask);
    for (size_t other = 0; other < count; other++)
      if (!r->overlaps[s * segments + shown[other]] && share_a_bit(mask, masks + other * words, words))
        r->overlaps[s * segments + shown[other]] = 1;
    shown[count++] = s;
  }
  return HL_OK;
}

/* Finds the first component none of whose segments overlaps the given segment. */
static int layer_for(const segment_reading *r, size_t segment) {
  bool taken[LAYERS_MOST] = {false};
  int layer = 0;
  for (size_t other = 0; other < segment; other++)
    if (r->overlaps[segment * r->stack->times + other]) taken[r->layers[other]] = true;
  while (layer < LAYERS_MOST && taken[layer]) layer++;
  return layer;
}

static hl_status find_layers(segment_reading *r, hl_error *error) {
  hl_context *context = r->set->context;
  size_t segments = r->stack->times, words = (r->slice_voxels + 63) / 64, most = 0;
  for (size_t place = 0; place < r->stack->place_count; place++) {
    size_t here = 0;
    for (size_t s = 0; s < segments; s++) here += frame_at(r, place, s) != NULL;
    if (here > most) most = here;
  }
  uint64_t *masks = hl_allocate(context, most * words, sizeof *masks);
  size_t *shown = hl_allocate(context, most + 1, sizeof *shown);
  hl_status status = masks == NULL || shown == NULL
                         ? hl_fail_memory(error, most * words * sizeof *masks, "masks of segments")
                         : HL_OK;
  for (size_t place = 0; place < r->stack->place_count && status == HL_OK && segments > 1; place++) {
    status = compare_place(r, place, masks, shown, error);
    if (status == HL_OK && hl_cancelled(context))
      status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", r->set->bundle->path);
  }
  for (size_t s = 0; s < segments && status == HL_OK; s++) {
    r->layers[s] = layer_for(r, s);
    if (r->layers[s] == LAYERS_MOST)
      status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                       "%s: more than %d segments share a voxel: export some of them alone",
                       r->set->bundle->path, LAYERS_MOST);
    else if ((size_t)r->layers[s] >= r->layer_count) r->layer_count = (size_t)r->layers[s] + 1;
  }
  hl_release(context, masks);
  hl_release(context, shown);
  return status;
}

/* ---- one slice ---- */

static void put_mask(const segment_reading *r, const unsigned char *values, double number, void *slice) {
  for (size_t n = 0; n < r->slice_voxels; n++) {
    if (values[n] == 0) continue;
    if (r->type == HL_VOXEL_U8) ((uint8_t *)slice)[n] = (uint8_t)number;
    else ((uint16_t *)slice)[n] = (uint16_t)number;
  }
}

static hl_status fill_slice(const segment_reading *r, size_t place, hl_dicom_workspace *space, void *slice,
                            hl_error *error) {
  hl_status status = HL_OK;
  for (size_t s = 0; s < r->stack->times && status == HL_OK; s++) {
    const hl_dicom_frame *frame = frame_at(r, place, s);
    if (frame == NULL || (r->fractions ? s : (size_t)r->layers[s]) != r->chosen) continue;
    status = hl_dicom_read_frame(r->set, frame, space, error);
    if (status != HL_OK) return status;
    if (r->fractions) hl_voxels_store(r->type, false, space->values, r->slice_voxels, slice);
    else put_mask(r, space->values, (double)r->stack->segments->list[s].value, slice);
  }
  return status;
}

static hl_status read_one(void *data, size_t index, int worker, hl_error *error) {
  segment_reading *r = data;
  const hl_dicom_slice *slice = &r->stack->slices[index];
  size_t first = index * r->slice_voxels;
  void *voxels;
  if (!hl_destination_wants(&r->to, first, r->slice_voxels)) return HL_OK;
  hl_status status = hl_destination_take(&r->to, first, r->slice_voxels, &voxels, error);
  if (status != HL_OK) return status;
  memset(voxels, 0, r->slice_voxels * r->to.voxel_bytes);
  if (!slice->empty) status = fill_slice(r, slice->place, &r->spaces[worker], voxels, error);
  hl_destination_put(&r->to, first, r->slice_voxels, voxels);
  return status;
}

/* ---- all steps together ---- */

hl_status hl_dicom_name_segments(const hl_dicom_segments *segments, const int *layers, hl_volume *volume,
                                 hl_error *error) {
  if (segments->count == 0) return HL_OK;
  hl_segment *list = hl_allocate(volume->context, segments->count, sizeof *list);
  if (list == NULL) return hl_fail_memory(error, segments->count * sizeof *list, "the names of segments");
  memcpy(list, segments->list, segments->count * sizeof *list);
  for (size_t n = 0; n < segments->count && layers != NULL; n++) list[n].layer = layers[n];
  volume->segments = list;
  volume->segment_count = segments->count;
  return HL_OK;
}

/* Lists the segments of fractions as arrays, by their names or as "segment N", and chooses the array to
 * read. */
static hl_status choose_fraction(segment_reading *r, hl_load_request *request, hl_error *error) {
  const hl_dicom_segments *segments = r->stack->segments;
  const hl_dicom_pixels *p = &r->set->files[0].pixels;
  r->type = p->allocated <= 8 ? HL_VOXEL_U8 : HL_VOXEL_U16;
  hl_status status = HL_OK;
  for (size_t n = 0; n < segments->count && status == HL_OK; n++) {
    char name[HL_SEGMENT_NAME_BYTES];
    snprintf(name, sizeof name, "%s", segments->list[n].name);
    if (name[0] == 0) snprintf(name, sizeof name, "segment %lld", (long long)segments->list[n].value);
    status = hl_arrays_add(request, name, 1, r->type, false, error);
  }
  if (status == HL_OK) status = hl_arrays_choose(request, r->set->bundle->path, -1, error);
  r->chosen = request->chosen;
  return status;
}

/* Warns if the file has segments that do not belong to the chosen component. */
static void tell_layers(const segment_reading *r, hl_load_request *request) {
  request->component_told[0] = 0;
  if (r->layer_count < 2 || request->component != HL_COMPONENT_DEFAULT) return;
  size_t elsewhere = 0;
  for (size_t n = 0; n < r->stack->times; n++) elsewhere += (size_t)r->layers[n] != r->chosen;
  snprintf(request->component_told, sizeof request->component_told,
           "%.200s: its segments overlap, and are kept apart in %zu components: component %zu is taken, %zu "
           "segments "
           "are in others (--component; --labels shows all)",
           r->set->bundle->path, r->layer_count, r->chosen, elsewhere);
}

static hl_status choose_layer(segment_reading *r, hl_load_request *request, hl_error *error) {
  double most = 0;
  hl_payload payload;
  hl_payload_defaults(&payload);
  for (size_t n = 0; n < r->stack->segments->count; n++)
    most = fmax(most, (double)r->stack->segments->list[n].value);
  hl_status status = find_layers(r, error);
  if (status != HL_OK) return status;
  payload.grid.type = r->type = most > 255 ? HL_VOXEL_U16 : HL_VOXEL_U8;
  payload.components = r->layer_count;
  payload.colors = HL_COLORS_UNREAD;
  bool chosen = request->component != HL_COMPONENT_DEFAULT;
  if (!chosen) request->component = 0; /* the default is not the magnitude: labels are only names */
  status = hl_component_only(request, r->set->bundle->path, false, &payload, error);
  if (!chosen) request->component = HL_COMPONENT_DEFAULT;
  if (status == HL_OK && payload.component < 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: its components are segments' numbers: give one by its index",
                   r->set->bundle->path);
  r->chosen = (size_t)payload.component;
  tell_layers(r, request);
  return status;
}

static hl_status make_volume(segment_reading *r, hl_load_request *request, hl_volume **volume,
                             hl_error *error) {
  hl_volume_description grid = r->stack->grid;
  double most = r->stack->segments->fraction_most;
  grid.type = r->type;
  if (r->fractions && most > 0) grid.value_scale = 1 / most;
  for (int axis = 0; axis < 3 && request->spacing[0] > 0; axis++) {
    double length = vec3_length(vec3_of(grid.axis[axis]));
    for (int row = 0; row < 3; row++) grid.axis[axis][row] *= request->spacing[axis] / length;
  }
  request->unit = "millimetre";
  request->is_anatomical = grid.space != HL_SPACE_UNKNOWN;
  hl_status status = hl_volume_check_grid(&grid, r->set->bundle->path, error);
  if (status == HL_OK)
    status = hl_destination_open(r->set->context, &grid, HL_DESTINATION_PIECES, r->set->bundle->path, &r->to,
                                 error);
  if (status == HL_OK)
    status = hl_parallel_read(r->set->context, r->pool, r->set->bundle->path, grid.dimensions[2], read_one, r,
                              error);
  if (status == HL_OK) status = hl_destination_adopt(&r->to, &grid, volume, error);
  if (status == HL_OK && !r->fractions) {
    status = hl_dicom_name_segments(r->stack->segments, r->layers, *volume, error);
    if (status != HL_OK) hl_volume_release(*volume), *volume = NULL;
  }
  return status;
}

static hl_status allocate(segment_reading *r, hl_error *error) {
  hl_context *context = r->set->context;
  size_t segments = r->stack->times;
  hl_status status = hl_pool_create(context, 0, &r->pool, error);
  if (status != HL_OK) return status;
  size_t threads = (size_t)hl_pool_threads(r->pool);
  r->spaces = hl_allocate_zeroed(context, threads, sizeof *r->spaces);
  r->layers = hl_allocate_zeroed(context, segments, sizeof *r->layers);
  r->overlaps = hl_allocate_zeroed(context, segments, segments);
  if (r->spaces == NULL || r->layers == NULL || r->overlaps == NULL)
    return hl_fail_memory(error, segments * segments, "a list of segments");
  for (size_t n = 0; n < threads; n++) r->spaces[n].context = context;
  return HL_OK;
}

hl_status hl_dicom_segmentation_read(hl_dicom_set *set, hl_dicom_stack *stack, hl_load_request *request,
                                     hl_volume **volume, hl_error *error) {
  segment_reading r = {.set = set, .stack = stack, .layer_count = 1};
  hl_context *context = set->context;
  r.slice_voxels = stack->grid.dimensions[0] * stack->grid.dimensions[1];
  r.fractions = stack->segments->kind == HL_DICOM_FRACTIONAL;
  hl_status status = allocate(&r, error);
  for (size_t n = 0; n < stack->place_count * stack->times && status == HL_OK; n++)
    if (stack->frames[n] != NULL) {
      hl_dicom_file *file = &set->files[stack->frames[n]->file];
      status = hl_dicom_find_frames(set, file, error);
      if (status == HL_OK && (file->pixels.allocated > 16 || hl_dicom_read_samples(&file->pixels) != 1))
        status = hl_fail(error, HL_ERROR_INPUT, "%s: segments of pixels that are no masks",
                         set->bundle->path);
    }
  if (status == HL_OK)
    status = r.fractions ? choose_fraction(&r, request, error) : choose_layer(&r, request, error);
  if (status == HL_OK) status = make_volume(&r, request, volume, error);
  for (int w = 0; r.pool != NULL && r.spaces != NULL && w < hl_pool_threads(r.pool); w++)
    hl_dicom_workspace_release(&r.spaces[w]);
  hl_release(context, r.spaces);
  hl_release(context, r.layers);
  hl_release(context, r.overlaps);
  hl_pool_destroy(r.pool);
  hl_destination_close(&r.to);
  return status;
}
