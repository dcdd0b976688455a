/* volume/nrrd_axes.c - which axes of a NRRD file are those of the grid, which hold components, and where the
 * grid lies. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/nrrd.h"
#include "volume/text.h"

/* Whether the samples along an axis are several values of one voxel. */
static bool is_component_axis(const nrrd_header *header, const nrrd_axis *axis) {
  if (header->has_directions) return !axis->has_direction;
  int space = 0;
  for (int n = 0; n < header->dimension; n++)
    space += hl_text_is_one_of(header->axis[n].kind, "domain|space");
  if (hl_text_equal(axis->kind, "time")) return space >= 3;
  return axis->kind[0] != 0 && !hl_text_is_one_of(axis->kind, "domain|space|none|???");
}

/* Of four axes and more that nothing is said of, a first one of at most four samples holds the components of
 * voxels. */
static bool is_first_of_components(const nrrd_header *header) {
  bool unsaid = header->axis[0].size <= 4 && !header->has_directions;
  int thick = 0;
  for (int n = 0; n < header->dimension; n++) {
    unsaid = unsaid && header->axis[n].kind[0] == 0;
    thick += header->axis[n].size > 1;
  }
  return unsaid && thick > 3;
}

/* Of the axes that are not components, at most three: while there are more, the last of one sample goes, and
 * then the last of all, a series. */
static int drop_thin_axes(int axes[NRRD_MOST_AXES], const nrrd_header *header, int count) {
  for (int n = count - 1; n >= 0 && count > 3; n--)
    if (header->axis[axes[n]].size == 1) {
      memmove(&axes[n], &axes[n + 1], (size_t)(count - 1 - n) * sizeof *axes);
      count--;
    }
  return count > 3 ? 3 : count;
}

/* The axes of the grid, fastest first. */
static int choose_axes(const nrrd_header *header, int chosen[NRRD_MOST_AXES]) {
  int count = 0;
  for (int n = 0; n < header->dimension; n++)
    if (!is_component_axis(header, &header->axis[n]) && !(n == 0 && is_first_of_components(header)))
      chosen[count++] = n;
  return drop_thin_axes(chosen, header, count);
}

/* The other axes hold components, which must follow each other: the grid's axes come before and after
 * them. */
static hl_status find_components(const nrrd_header *header, const int chosen[NRRD_MOST_AXES], int count,
                                 bool *is_series, hl_payload *payload, hl_error *error) {
  size_t before = 1, since = 1; /* voxels of the axes before the components, and since the last of them */
  int grid_axis = 0;
  *is_series = false;
  for (int n = 0; n < header->dimension; n++) {
    const nrrd_axis *axis = &header->axis[n];
    if (grid_axis < count && chosen[grid_axis] == n) {
      size_t *product = payload->components == 1 ? &before : &since;
      if (!hl_multiply(*product, axis->size, product)) *product = SIZE_MAX;
      grid_axis++;
      continue;
    }
    if (axis->size == 0)
      return hl_fail(error, HL_ERROR_INPUT, "%s: axis %d has 0 samples", header->stream->path, n + 1);
    if (axis->size == 1) continue;
    if (payload->components > 1 && since > 1)
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: components along axes that do not follow each other: take one out with unu slice",
                     header->stream->path);
    if (!hl_multiply(payload->components, axis->size, &payload->components)) payload->components = SIZE_MAX;
    *is_series = *is_series || hl_text_is_one_of(axis->kind, "list|time|domain|space") || grid_axis >= 3;
  }
  payload->block = before;
  return HL_OK;
}

/* The step of an axis without direction, and the place of its first sample; Teem's rules for spacing, axis
 * mins and maxs, and centering. */
static void place_axis(const nrrd_axis *axis, double *spacing, double *first) {
  double width = axis->maximum - axis->minimum;
  double intervals = axis->is_node ? (double)axis->size - 1 : (double)axis->size;
  *spacing = isfinite(axis->spacing)            ? axis->spacing
             : isfinite(width) && intervals > 0 ? width / intervals
                                                : 1;
  *first = isfinite(axis->minimum) ? axis->minimum + (axis->is_node ? 0 : *spacing / 2) : 0;
}

/* Axes that the file does not have get a unit step across the others. */
static void complete_axes(hl_volume_description *grid, int count) {
  if (count == 1) {
    vec3 across = vec3_perpendicular(vec3_normalise(vec3_of(grid->axis[0])));
    memcpy(grid->axis[1], &across, sizeof across);
  }
  if (count < 3) {
    vec3 across = vec3_normalise(vec3_cross(vec3_of(grid->axis[0]), vec3_of(grid->axis[1])));
    memcpy(grid->axis[2], &across, sizeof across);
  }
}

static void make_grid(const nrrd_header *header, const int chosen[NRRD_MOST_AXES], int count,
                      hl_volume_description *grid) {
  for (int n = 0; n < count; n++) {
    const nrrd_axis *axis = &header->axis[chosen[n]];
    grid->dimensions[n] = axis->size;
    if (header->has_directions) memcpy(grid->axis[n], axis->direction, sizeof grid->axis[n]);
    else place_axis(axis, &grid->axis[n][n], &grid->origin[n]);
  }
  if (header->has_directions) complete_axes(grid, count);
  if (header->has_space_origin) memcpy(grid->origin, header->space_origin, sizeof grid->origin);
  grid->type = header->type;
  grid->space = header->space;
}

hl_status hl_nrrd_place(const nrrd_header *header, hl_payload *payload, bool *is_series, hl_error *error) {
  int chosen[NRRD_MOST_AXES], count = choose_axes(header, chosen);
  make_grid(header, chosen, count, &payload->grid);
  hl_status status = hl_volume_check_grid(&payload->grid, header->stream->path, error);
  return status == HL_OK ? find_components(header, chosen, count, is_series, payload, error) : status;
}
