/* volume/create.c - makes volumes of voxels in memory, counts their users, and returns the values of their
 * voxels.
 *
 * In: a description from the caller, or decoded voxels from the readers of files. Out: an hl_volume with its
 * statistics. A finished volume never changes, and counts its users. */
#include "volume/volume.h"

#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/exact.h"
#include "volume/in_bricks.h"
#include "volume/scraps.h"
#include "volume/statistics.h"
#include "volume/store/glimpse.h"
#include "volume/store/pages.h"

const char *hl_component_name(int component) {
  switch (component) {
    case HL_COMPONENT_MAGNITUDE: return "magnitude";
    case HL_COMPONENT_COLOR: return "color";
    case HL_COMPONENT_LUMINANCE: return "luminance";
    default: return NULL;
  }
}

int hl_component_of_name(const char *name) {
  for (int component = HL_COMPONENT_MAGNITUDE; name != NULL && hl_component_name(component) != NULL;
       component--)
    if (strcmp(name, hl_component_name(component)) == 0) return component;
  return HL_COMPONENT_DEFAULT;
}

const char *hl_space_name(hl_space space) {
  return space == HL_SPACE_RAS ? "RAS" : space == HL_SPACE_LPS ? "LPS" : space == HL_SPACE_LAS ? "LAS" : NULL;
}

void hl_volume_description_defaults(hl_volume_description *description) {
  if (description == NULL) return;
  memset(description, 0, sizeof *description);
  description->struct_size = sizeof *description;
  description->type = HL_VOXEL_U8;
  description->value_scale = 1;
  for (int axis = 0; axis < 3; axis++) description->axis[axis][axis] = 1;
}

static affine3 index_to_world(const hl_volume_description *description) {
  return (affine3){mat3_from_columns(vec3_of(description->axis[0]), vec3_of(description->axis[1]),
                                     vec3_of(description->axis[2])),
                   vec3_of(description->origin)};
}

/* Checks that computations with a volume's size do not overflow. The bytes of all voxels must fit into a
 * size_t, both as the caller gives the voxels and as the library stores them. A file with voxels of the
 * largest type must have a number of bytes that fits into 64 bits. */
static hl_status check_size(const hl_volume_description *description, const char *subject, hl_error *error) {
  const size_t *dimension = description->dimensions, given = hl_voxel_type_bytes(description->type),
               stored = hl_storage_bytes(hl_voxel_type_storage(description->type));
  const uint64_t most_voxels = (SIZE_MAX / 2) / (given > stored ? given : stored), largest_type = 8;
  uint64_t voxels = 1;
  bool fits = true;
  for (int axis = 0; axis < 3; axis++) {
    if (dimension[axis] < 1)
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s: the size %zu x %zu x %zu has a zero: each must be at least 1", subject,
                     dimension[0], dimension[1], dimension[2]);
    fits = fits && dimension[axis] <= INT32_MAX && !__builtin_mul_overflow(voxels, dimension[axis], &voxels);
  }
  if (!fits || voxels > most_voxels || voxels > INT64_MAX / largest_type)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: the size %zu x %zu x %zu needs more memory than this program can address", subject,
                   dimension[0], dimension[1], dimension[2]);
  return HL_OK;
}

/* The greatest magnitude of a vector's coordinates. Checks of lengths use the greatest magnitude, which
 * unlike a length cannot overflow. */
static double greatest_part(const double v[3]) { return fmax(fmax(fabs(v[0]), fabs(v[1])), fabs(v[2])); }

/* The least and the greatest allowed length of a step. Squares and cubes of lengths between SHORTEST_STEP and
 * LONGEST_STEP stay in the range of doubles. */
static const double SHORTEST_STEP = 1e-100, LONGEST_STEP = 1e100;

static hl_status check_step(const double axis[3], int number, const char *subject, hl_error *error) {
  double greatest = greatest_part(axis);
  bool finite = isfinite(axis[0]) && isfinite(axis[1]) && isfinite(axis[2]);
  if (finite && greatest >= SHORTEST_STEP && greatest <= LONGEST_STEP) return HL_OK;
  if (!finite || !(greatest > 0))
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: the spacing along axis %d is %g: give a finite number above 0, or a direction that is not zero",
        subject, number, finite ? greatest : vec3_length(vec3_of(axis)));
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: the spacing along axis %d is %g, and can be from %g to %g: use another unit of length",
                 subject, number, greatest, SHORTEST_STEP, LONGEST_STEP);
}

static hl_status check_place(const hl_volume_description *description, const char *subject, hl_error *error) {
  affine3 place = index_to_world(description), inverse;
  for (int axis = 0; axis < 3; axis++) {
    hl_status status = check_step(description->axis[axis], axis, subject, error);
    if (status != HL_OK) return status;
  }
  const double *origin = description->origin;
  if (!isfinite(origin[0]) || !isfinite(origin[1]) || !isfinite(origin[2]))
    return hl_fail(error, HL_ERROR_INPUT, "%s: the origin has coordinates that are not finite: correct it",
                   subject);
  if (greatest_part(origin) > LONGEST_STEP)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: the origin is %g away, and can be as far as %g: use another unit of length", subject,
                   greatest_part(origin), LONGEST_STEP);
  bool possible = affine3_invert(place, &inverse) && isfinite(vec3_length(inverse.offset));
  for (int axis = 0; axis < 3; axis++) possible = possible && isfinite(vec3_length(inverse.linear.row[axis]));
  if (!possible)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the three axes lie in one plane: correct its directions",
                   subject);
  return HL_OK;
}

hl_status hl_volume_check_grid(const hl_volume_description *description, const char *subject,
                               hl_error *error) {
  if (hl_voxel_type_bytes(description->type) == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: there is no voxel type %d", subject, (int)description->type);
  if (description->space != HL_SPACE_UNKNOWN && hl_space_name(description->space) == NULL)
    return hl_fail(error, HL_ERROR_INPUT, "%s: there is no space %d", subject, (int)description->space);
  hl_status status = check_size(description, subject, error);
  if (status != HL_OK) return status;
  if (!isfinite(description->value_scale) || !isfinite(description->value_offset) ||
      description->value_scale == 0)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: value scale %g and offset %g: both must be finite, the scale not 0", subject,
                   description->value_scale, description->value_offset);
  return check_place(description, subject, error);
}

/* Makes a volume of the description's grid, without voxels. */
static hl_volume *make_volume(hl_context *context, const hl_volume_description *description) {
  hl_volume *volume = hl_allocate_zeroed(context, 1, sizeof *volume);
  if (volume == NULL) return NULL;
  volume->context = context;
  atomic_init(&volume->references, 1);
  memcpy(volume->dimension, description->dimensions, sizeof volume->dimension);
  volume->type = description->type;
  volume->space = description->space;
  volume->selection = (hl_selection){1, 1, 1, 0, 0, 0, 0};
  volume->window[0] = volume->window[1] = NAN;
  volume->storage = hl_voxel_type_storage(description->type);
  volume->row_bytes = volume->dimension[0] * hl_storage_bytes(volume->storage);
  volume->slice_bytes = volume->row_bytes * volume->dimension[1];
  volume->value_scale = description->value_scale;
  volume->value_offset = description->value_offset -
                         description->value_scale * hl_voxel_type_bias(description->type);
  volume->index_to_world = index_to_world(description);
  return volume;
}

static hl_status finish_volume(hl_volume *made, const char *subject, hl_volume **volume, hl_error *error) {
  hl_status status = made->bricks != NULL ? hl_volume_measure_bricks(made, subject, error)
                                          : hl_volume_measure(made, subject, error);
  if (status == HL_OK) *volume = made;
  else hl_volume_release(made);
  return status;
}

hl_status hl_volume_adopt(hl_context *context, const hl_volume_description *description, const char *subject,
                          void *voxels, hl_volume **volume, hl_error *error) {
  return hl_volume_adopt_exact(context, description, subject, voxels, NULL, volume, error);
}

hl_status hl_volume_adopt_exact(hl_context *context, const hl_volume_description *description,
                                const char *subject, void *voxels, void *exact, hl_volume **volume,
                                hl_error *error) {
  *volume = NULL;
  hl_status status = hl_volume_check_grid(description, subject, error);
  hl_volume *made = status == HL_OK ? make_volume(context, description) : NULL;
  if (made == NULL) {
    hl_release(context, voxels);
    hl_release(context, exact);
    return status != HL_OK ? status : hl_fail_memory(error, sizeof *made, subject);
  }
  made->voxels = made->owned_voxels = voxels;
  made->exact = exact;
  return finish_volume(made, subject, volume, error);
}

hl_status hl_volume_adopt_pages(hl_context *context, const hl_volume_description *description,
                                const char *subject, struct hl_pages *pages, hl_volume **volume,
                                hl_error *error) {
  *volume = NULL;
  hl_status status = hl_volume_check_grid(description, subject, error);
  hl_volume *made = status == HL_OK ? make_volume(context, description) : NULL;
  if (made == NULL) {
    hl_pages_release(pages);
    return status != HL_OK ? status : hl_fail_memory(error, sizeof *made, subject);
  }
  made->pages = pages;
  hl_pages_finish(pages);
  status = finish_volume(made, subject, volume, error);
  if (status == HL_OK) pages->in_use = true;
  return status;
}

hl_status hl_volume_take_bricks(hl_context *context, hl_bricks *bricks, const hl_volume_description *grid,
                                const char *subject, hl_volume **volume, hl_error *error) {
  *volume = NULL;
  hl_status status = hl_volume_check_grid(grid, subject, error);
  if (status == HL_OK) status = hl_volume_check_bricks(bricks, grid, subject, error);
  hl_volume *made = status == HL_OK ? make_volume(context, grid) : NULL;
  if (made != NULL) made->bricks = hl_allocate(context, 1, sizeof *made->bricks);
  if (made == NULL || made->bricks == NULL) {
    hl_volume_release(made);
    hl_bricks_release(context, bricks);
    return status != HL_OK ? status : hl_fail_memory(error, sizeof *made + sizeof *bricks, subject);
  }
  *made->bricks = *bricks;
  *bricks = (hl_bricks){0};
  return finish_volume(made, subject, volume, error);
}

const void *hl_volume_row_in(const hl_volume *volume, size_t j, size_t k, void *buffer) {
  if (volume->voxels != NULL) return hl_volume_row(volume, j, k);
  if (volume->bricks != NULL) hl_volume_row_of_bricks(volume, j, k, buffer);
  else hl_pages_load_row(volume->pages, j, k, buffer);
  return buffer;
}

bool hl_volume_is_exact(const hl_volume *volume) {
  return volume->exact != NULL || (volume->pages != NULL && volume->pages->exact_file >= 0);
}

/* The voxel type of each hl_storage, in the order of the enumeration. */
static const hl_voxel_type stored_types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};

size_t hl_volume_row_room(const hl_volume *volume) {
  size_t stored = hl_storage_bytes(volume->storage), width = volume->dimension[0];
  bool in_file = volume->exact == NULL && hl_volume_is_exact(volume);
  return width * (in_file ? hl_voxel_type_bytes(volume->type) + stored : stored);
}

/* Reads a row of the file's own numbers of a volume with pages. The file's own numbers lie in a second
 * scratch file. Returns null if that file cannot be read. */
static const void *numbers_in(const hl_volume *volume, size_t j, size_t k, unsigned char *buffer) {
  size_t width = volume->dimension[0], first = (k * volume->dimension[1] + j) * width;
  float *stored = (float *)(void *)(buffer + width * hl_voxel_type_bytes(volume->type));
  hl_pages_load_row(volume->pages, j, k, stored);
  return hl_exact_read(volume->pages->exact_file, volume->type, first, width, stored, buffer) ? buffer : NULL;
}

hl_number_row hl_volume_numbers(const hl_volume *volume, size_t j, size_t k, void *buffer) {
  const void *numbers = volume->exact == NULL && hl_volume_is_exact(volume) ? numbers_in(volume, j, k, buffer)
                                                                            : NULL;
  if (numbers != NULL) return (hl_number_row){volume->type, numbers};
  if (volume->exact == NULL)
    return (hl_number_row){stored_types[volume->storage], hl_volume_row_in(volume, j, k, buffer)};
  size_t row = (k * volume->dimension[1] + j) * volume->dimension[0];
  return (hl_number_row){volume->type,
                         (const unsigned char *)volume->exact + row * hl_voxel_type_bytes(volume->type)};
}

double hl_row_number(hl_number_row row, size_t i) {
  switch (row.type) {
    case HL_VOXEL_U8: return ((const uint8_t *)row.numbers)[i];
    case HL_VOXEL_U16: return ((const uint16_t *)row.numbers)[i];
    case HL_VOXEL_F32: return (double)((const float *)row.numbers)[i];
    default: return hl_exact_number(row.type, row.numbers, i);
  }
}

/* The least positive number that int64_t cannot hold: 2^63. */
static const double TOO_GREAT = 0x1p63;

bool hl_row_whole(const hl_volume *volume, hl_number_row row, size_t i, int64_t *whole) {
  bool is_64 = row.type == HL_VOXEL_I64 || row.type == HL_VOXEL_U64;
  if (is_64 && volume->value_scale == 1 && volume->value_offset == 0) {
    memcpy(whole, (const int64_t *)row.numbers + i, sizeof *whole);
    return row.type == HL_VOXEL_I64 || *whole >= 0; /* an unsigned number beyond the range of int64_t has
                                                     * become negative */
  }
  double value = volume->value_scale * hl_row_number(row, i) + volume->value_offset;
  if (!(value >= -TOO_GREAT && value < TOO_GREAT && value == floor(value))) return false;
  *whole = (int64_t)value;
  return true;
}

/* Copies strided voxels into stored form. row: scratch memory for one row of voxels of the caller's type. */
static void copy_voxels(const hl_volume_description *description, const ptrdiff_t stride[3],
                        unsigned char *row, unsigned char *destination, hl_exact *exact) {
  const size_t *dimension = description->dimensions;
  size_t voxel_bytes = hl_voxel_type_bytes(description->type);
  size_t row_bytes = dimension[0] * hl_storage_bytes(hl_voxel_type_storage(description->type));
  for (size_t k = 0; k < dimension[2]; k++)
    for (size_t j = 0; j < dimension[1]; j++) {
      const unsigned char *source = (const unsigned char *)description->voxels + (ptrdiff_t)j * stride[1] +
                                    (ptrdiff_t)k * stride[2];
      if (stride[0] != (ptrdiff_t)voxel_bytes) {
        hl_voxels_gather(source, stride[0], voxel_bytes, dimension[0], row);
        source = row;
      }
      hl_exact_note(exact, false, source, (k * dimension[1] + j) * dimension[0], dimension[0]);
      hl_voxels_store(description->type, false, source, dimension[0], destination);
      destination += row_bytes;
    }
}

static void choose_strides(const hl_volume_description *description, ptrdiff_t stride[3]) {
  const ptrdiff_t *given = description->stride_bytes;
  ptrdiff_t packed[3] = {(ptrdiff_t)hl_voxel_type_bytes(description->type), 0, 0};
  packed[1] = packed[0] * (ptrdiff_t)description->dimensions[0];
  packed[2] = packed[1] * (ptrdiff_t)description->dimensions[1];
  bool is_packed = given[0] == 0 && given[1] == 0 && given[2] == 0;
  memcpy(stride, is_packed ? packed : given, sizeof packed);
}

/* The greatest number of bytes from one slice to the next of borrowed voxels. Samplers hold distances of a
 * few slices in 32 bits. */
#define LARGEST_GAP ((ptrdiff_t)1 << 26)

/* Returns whether the caller's voxels can be borrowed without a copy. Borrowed voxels must have a storage
 * type and be aligned for vector loads. The voxels of a row must be adjacent, and neither rows nor slices may
 * overlap. */
static bool can_borrow(const hl_volume_description *description, const ptrdiff_t stride[3]) {
  hl_voxel_type type = description->type;
  ptrdiff_t bytes = (ptrdiff_t)hl_voxel_type_bytes(type);
  ptrdiff_t row = bytes * (ptrdiff_t)description->dimensions[0];
  if (type != HL_VOXEL_U8 && type != HL_VOXEL_U16 && type != HL_VOXEL_F32) return false;
  if ((uintptr_t)description->voxels % (size_t)bytes != 0 || stride[0] != bytes) return false;
  ptrdiff_t rows = (ptrdiff_t)description->dimensions[1];
  if (stride[1] == row && stride[2] == row * rows) return true;
  return stride[1] >= row && stride[1] % bytes == 0 && stride[2] <= LARGEST_GAP &&
         stride[1] <= stride[2] / rows && stride[2] % bytes == 0;
}

hl_status hl_volume_create(hl_context *context, const hl_volume_description *description, hl_volume **volume,
                           hl_error *error) {
  HL_DOOR;
  static const char subject[] = "hl_volume_create";
  if (volume != NULL) *volume = NULL;
  if (context == NULL || description == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: context, description and volume must not be null", subject);
  if (description->struct_size != sizeof *description)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_volume_description_defaults first", subject,
                   description->struct_size, sizeof *description);
  if (description->voxels == NULL) return hl_fail(error, HL_ERROR_ARGUMENT, "%s: voxels is null", subject);
  hl_status status = hl_volume_check_grid(description, subject, error);
  if (status != HL_OK) {
    if (error != NULL)
      error->code = HL_ERROR_ARGUMENT; /* the error is HL_ERROR_ARGUMENT, because the grid comes from the
                                        * caller and not from a file */
    return HL_ERROR_ARGUMENT;
  }
  ptrdiff_t stride[3];
  choose_strides(description, stride);
  hl_volume *made = make_volume(context, description);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a volume");
  if (description->borrow && can_borrow(description, stride)) {
    made->voxels = description->voxels;
    made->row_bytes = (size_t)stride[1];
    made->slice_bytes = (size_t)stride[2];
    hl_status measured = finish_volume(made, subject, volume, error);
    if (measured != HL_OK) return measured;
    (*volume)->release = description->release;
    (*volume)->release_data = description->release_data;
    return HL_OK;
  }
  size_t count = hl_volume_voxel_count(made), voxel_bytes = hl_storage_bytes(made->storage);
  unsigned char *row = hl_allocate(context, description->dimensions[0],
                                   hl_voxel_type_bytes(description->type));
  made->voxels = made->owned_voxels = hl_allocate(context, count, voxel_bytes);
  if (row == NULL || made->voxels == NULL) {
    hl_release(context, row);
    hl_volume_release(made);
    return hl_fail_memory(error, count * voxel_bytes, "a volume");
  }
  hl_exact exact;
  hl_exact_begin(context, description->type, count, HL_EXACT_IN_MEMORY, &exact);
  copy_voxels(description, stride, row, made->owned_voxels, &exact);
  hl_release(context, row);
  status = hl_exact_take(&exact, made->voxels, &made->exact, error);
  if (status != HL_OK) {
    hl_volume_release(made);
    return status;
  }
  hl_status measured = finish_volume(made, subject, volume, error);
  if (measured == HL_OK && description->release != NULL)
    description->release(description->release_data, description->voxels);
  return measured;
}

void hl_volume_retain(hl_volume *volume) {
  if (volume != NULL) atomic_fetch_add(&volume->references, 1);
}

void hl_arrays_release(hl_context *context, hl_array_entry *arrays, size_t count) {
  for (size_t n = 0; n < count; n++) hl_release(context, arrays[n].name);
  hl_release(context, arrays);
}

void hl_volume_release(hl_volume *volume) {
  if (volume == NULL || atomic_fetch_sub(&volume->references, 1) != 1) return;
  hl_arrays_release(volume->context, volume->arrays, volume->array_count);
  hl_release(volume->context, volume->segments);
  hl_release(volume->context, volume->channels);
  hl_release(volume->context, volume->label_maps);
  hl_scraps_release_kept(volume);
  if (volume->shelf != NULL) volume->release_shelf(volume->context, volume->shelf);
  hl_release(volume->context, volume->series);
  hl_release(volume->context, atomic_load(&volume->analysis));
  hl_release(volume->context, volume->owned_voxels);
  hl_release(volume->context, volume->exact);
  hl_volume_release(volume->gathered);
  hl_volume_release(volume->unsmoothed);
  hl_volume_release(volume->continued);
  hl_volume_release(volume->wall);
  hl_pages_release(volume->pages);
  if (volume->bricks != NULL) hl_bricks_release(volume->context, volume->bricks);
  hl_release(volume->context, volume->bricks);
  hl_release(volume->context, volume->colors);
  hl_release(volume->context, volume->slopes);
  hl_release(volume->context, volume->mask_bricks);
  if (volume->release != NULL) volume->release(volume->release_data, volume->voxels);
  hl_release(volume->context, volume);
}

double hl_volume_value(const hl_volume *volume, size_t i, size_t j, size_t k) {
  HL_DOOR;
  return hl_volume_value_within(volume, i, j, k);
}

/* The file's own number of voxel (i, j, k), as a row of length 1. own: memory for the number, which is used
 * if the number is not in memory elsewhere. */
static hl_number_row number_of(const hl_volume *volume, size_t i, size_t j, size_t k, uint64_t *own) {
  const hl_pages *pages = volume->pages;
  if (volume->bricks != NULL) {
    float value = hl_volume_value_of_bricks(volume, (const size_t[3]){i, j, k});
    memcpy(own, &value, sizeof value);
    return (hl_number_row){HL_VOXEL_F32, own};
  }
  if (pages == NULL) {
    hl_number_row row = hl_volume_numbers(volume, j, k, NULL);
    row.numbers = (const unsigned char *)row.numbers + i * hl_voxel_type_bytes(row.type);
    return row;
  }
  const void *kept = pages->glimpse != NULL ? hl_glimpse_voxel(pages->glimpse, i, j, k) : NULL;
  if (kept != NULL && pages->exact_file < 0) return (hl_number_row){stored_types[volume->storage], kept};
  float stored = (float)hl_page_number(pages, i, j, k);
  size_t at = (k * volume->dimension[1] + j) * volume->dimension[0] + i;
  if (pages->exact_file >= 0 && hl_exact_read(pages->exact_file, volume->type, at, 1, &stored, own))
    return (hl_number_row){volume->type, own};
  memcpy(own, &stored, sizeof stored);
  return (hl_number_row){HL_VOXEL_F32, own};
}

static bool is_outside(const hl_volume *volume, size_t i, size_t j, size_t k) {
  return i >= volume->dimension[0] || j >= volume->dimension[1] || k >= volume->dimension[2];
}

double hl_volume_value_within(const hl_volume *volume, size_t i, size_t j, size_t k) {
  if (volume == NULL || is_outside(volume, i, j, k)) return NAN;
  uint64_t own;
  double number = hl_row_number(number_of(volume, i, j, k, &own), 0);
  /* a number beyond the range of floats counts as not finite, as its stored value is infinite and
   * transparent */
  return isfinite((float)number) ? volume->value_scale * number + volume->value_offset : NAN;
}

double hl_volume_value_between(const hl_volume *volume, const double at[3]) {
  size_t low[3];
  double part[3], sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    double inside = fmin(fmax(at[axis], 0), (double)(volume->dimension[axis] - 1));
    low[axis] = (size_t)inside;
    part[axis] = inside - (double)low[axis];
  }
  for (int corner = 0; corner < 8; corner++) {
    double weight = 1;
    size_t voxel[3];
    for (int axis = 0; axis < 3; axis++) {
      int upper = corner >> axis & 1;
      voxel[axis] = low[axis] + (size_t)upper;
      weight *= upper ? part[axis] : 1 - part[axis];
    }
    if (weight > 0) sum += weight * hl_volume_value_within(volume, voxel[0], voxel[1], voxel[2]);
  }
  return sum;
}

hl_whole hl_volume_whole(const hl_volume *volume, size_t i, size_t j, size_t k, int64_t *whole) {
  if (is_outside(volume, i, j, k)) return HL_WHOLE_ABSENT;
  uint64_t own;
  const hl_number_row row = number_of(volume, i, j, k, &own);
  if (hl_row_whole(volume, row, 0, whole)) return HL_WHOLE_FOUND;
  return isfinite((float)hl_row_number(row, 0)) ? HL_WHOLE_FRACTION : HL_WHOLE_ABSENT;
}
