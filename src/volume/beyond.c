/* volume/beyond.c - see beyond.h. */
#include "volume/beyond.h"

#include <math.h>
#include <string.h>

#include "volume/convert.h"

/* Finds where the grid's indices lie in the coarser volume. Returns false if the axes of the two grids are
 * not parallel. */
static bool find_places(const hl_volume_description *grid, hl_beyond *beyond) {
  affine3 inverse;
  if (!affine3_invert(beyond->coarse->index_to_world, &inverse)) return false;
  const vec3 first = affine3_apply(inverse, vec3_of(grid->origin));
  for (int a = 0; a < 3; a++) {
    const vec3 step = mat3_apply(inverse.linear, vec3_of(grid->axis[a]));
    beyond->first[a] = vec3_component(first, a);
    beyond->step[a] = vec3_component(step, a);
    const double aside = fabs(vec3_component(step, (a + 1) % 3)) + fabs(vec3_component(step, (a + 2) % 3));
    if (!(beyond->step[a] > 0) || !(aside < 1e-9 * beyond->step[a]) || !isfinite(beyond->first[a]))
      return false;
  }
  return true;
}

void hl_beyond_prepare(const hl_volume *coarse, const double (*seen)[4][4], size_t count,
                       const hl_volume_description *grid, hl_beyond *beyond) {
  *beyond = (hl_beyond){.coarse = coarse, .type = grid->type, .seen = seen, .seen_count = count};
  if (coarse == NULL) return;
  if (coarse->says_labels || coarse->segment_count > 0 || coarse->colors != NULL ||
      !find_places(grid, beyond)) {
    beyond->coarse = NULL;
    return;
  }
  beyond->grid.linear = mat3_from_columns(vec3_of(grid->axis[0]), vec3_of(grid->axis[1]),
                                          vec3_of(grid->axis[2]));
  beyond->grid.offset = vec3_of(grid->origin);
}

/* Returns whether a box touches a part that pictures see. A box does not touch the part if all corners of the
 * box lie outside of one of the part's planes. */
static bool touches(const double planes[4][4], const vec3 corners[8]) {
  for (int n = 0; n < 4; n++) {
    const vec3 normal = vec3_of(planes[n]);
    double most = -INFINITY;
    for (int c = 0; c < 8; c++) most = fmax(most, vec3_dot(normal, corners[c]));
    if (most + planes[n][3] < 0) return false;
  }
  return true;
}

bool hl_beyond_is_seen(const hl_beyond *beyond, const uint64_t begin[3], const uint64_t count[3]) {
  vec3 corners[8];
  if (beyond->coarse == NULL) return true;
  for (int c = 0; c < 8; c++) {
    double index[3];
    for (int a = 0; a < 3; a++)
      index[a] = (c >> a & 1) == 0 ? (double)begin[a] - HL_BEYOND_REACH
                                   : (double)(begin[a] + count[a]) - 1 + HL_BEYOND_REACH;
    corners[c] = affine3_apply(beyond->grid, vec3_of(index));
  }
  for (size_t n = 0; n < beyond->seen_count; n++)
    if (touches(beyond->seen[n], corners)) return true;
  return false;
}

/* The scratch memory of hl_beyond_row() holds two rows of the coarser volume: a row of stored values, and a
 * row of data values. */
size_t hl_beyond_room(const hl_beyond *beyond) {
  return beyond->coarse != NULL ? 2 * beyond->coarse->dimension[0] : 0;
}

/* A position between two neighbouring voxels of the coarser volume, along one axis. */
typedef struct between {
  size_t low, high;
  double part; /* fraction of the distance from voxel `low` to voxel `high` */
} between;

static between place(const hl_beyond *beyond, int axis, uint64_t index) {
  const size_t last = beyond->coarse->dimension[axis] - 1;
  const double at = fmin(fmax(beyond->first[axis] + beyond->step[axis] * (double)index, 0), (double)last);
  const size_t low = (size_t)at;
  return (between){low, low < last ? low + 1 : last, at - (double)low};
}

/* Adds the weighted data values of voxels `low` to `high` of row (j, k) to sums. */
static void add_row(const hl_volume *volume, size_t j, size_t k, double weight, size_t low, size_t high,
                    void *buffer, float *sums) {
  if (weight == 0) return;
  const void *row = hl_volume_row_in(volume, j, k, buffer);
  for (size_t i = low; i <= high; i++)
    sums[i] += (float)(weight * (volume->value_scale * hl_stored_number(volume->storage, row, i) +
                                 volume->value_offset));
}

static double held(double value, double least, double greatest) {
  return fmin(fmax(floor(value + 0.5), least), greatest);
}

/* Converts a data value to a stored value, and writes it at index n of a row. */
static void store(hl_voxel_type type, double value, void *row, size_t n) {
  const double bias = hl_voxel_type_bias(type);
  switch (hl_voxel_type_storage(type)) {
    case HL_STORAGE_U8: ((uint8_t *)row)[n] = (uint8_t)held(value + bias, 0, UINT8_MAX); break;
    case HL_STORAGE_U16: ((uint16_t *)row)[n] = (uint16_t)held(value + bias, 0, UINT16_MAX); break;
    case HL_STORAGE_F32: ((float *)row)[n] = (float)value; break;
  }
}

void hl_beyond_row(const hl_beyond *beyond, uint64_t i, uint64_t j, uint64_t k, uint64_t count,
                   float *scratch, void *row) {
  const hl_volume *coarse = beyond->coarse;
  const between y = place(beyond, 1, j), z = place(beyond, 2, k);
  const size_t low = place(beyond, 0, i).low, high = place(beyond, 0, i + count - 1).high;
  float *sums = scratch + coarse->dimension[0];
  memset(sums + low, 0, (high - low + 1) * sizeof *sums);
  add_row(coarse, y.low, z.low, (1 - y.part) * (1 - z.part), low, high, scratch, sums);
  add_row(coarse, y.high, z.low, y.part * (1 - z.part), low, high, scratch, sums);
  add_row(coarse, y.low, z.high, (1 - y.part) * z.part, low, high, scratch, sums);
  add_row(coarse, y.high, z.high, y.part * z.part, low, high, scratch, sums);
  for (uint64_t n = 0; n < count; n++) {
    const between x = place(beyond, 0, i + n);
    const double value = x.part > 0 ? (double)sums[x.low] * (1 - x.part) + (double)sums[x.high] * x.part
                                    : (double)sums[x.low];
    store(beyond->type, value, row, n);
  }
}
