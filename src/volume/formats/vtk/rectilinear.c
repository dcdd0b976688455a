/* volume/formats/vtk/rectilinear.c - makes volumes whose voxels lie on lines that are not evenly spaced. */
#include "volume/formats/vtk/rectilinear.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

/* EVEN: points count as evenly spaced if each deviates by no more than this fraction of a step. TIMES_MOST:
 * the greatest factor by which resampling may increase the number of voxels along an axis. */
static const double EVEN = 1e-3;
enum { TIMES_MOST = 4 };

/* An axis of the new grid, and the positions of its voxels among the voxels of the old grid. */
typedef struct axis_map {
  size_t count;       /* number of voxels of the new grid */
  double first, step; /* coordinate of the first voxel, and step between voxels, in the world */
  bool even;
  size_t *below;  /* owned; [count]; for each new voxel, the old voxel at the same position, or else the last
                   * old voxel before this position */
  double *weight; /* owned; [count]; the weight of the old voxel after `below` */
} axis_map;

static bool is_monotonic(const double *c, size_t count) {
  for (size_t n = 1; n < count; n++)
    if (!isfinite(c[n]) || !isfinite(c[n - 1]) || (c[n] > c[n - 1]) != (c[1] > c[0]) || c[n] == c[n - 1])
      return false;
  return true;
}

static bool is_even(const double *c, size_t count) {
  double step = (c[count - 1] - c[0]) / (double)(count - 1);
  for (size_t n = 0; n < count; n++)
    if (fabs(c[n] - (c[0] + (double)n * step)) > EVEN * fabs(step)) return false;
  return true;
}

/* Finds the old voxels around each new voxel, and their weights. of_cells: whether c holds the edges of the
 * old cells, [voxels + 1]; otherwise it holds the old points, [voxels]. */
static void fill_map(const double *c, size_t voxels, bool of_cells, axis_map *map) {
  double way = map->step > 0 ? 1 : -1;
  for (size_t n = 0, at = 0; n < map->count; n++) {
    double place = map->first + (double)n * map->step;
    size_t last = of_cells ? voxels - 1 : voxels > 1 ? voxels - 2 : 0;
    while (at < last && way * (place - c[at + 1]) >= 0) at++;
    double part = !of_cells && voxels > 1 ? (place - c[at]) / (c[at + 1] - c[at]) : 0;
    map->below[n] = at;
    map->weight[n] = fmin(fmax(part, 0), 1);
  }
}

static hl_status make_map(hl_context *context, const double *c, size_t points, size_t voxels, bool of_cells,
                          axis_map *map, hl_error *error) {
  size_t steps = points - 1;
  double span = points > 1 ? c[points - 1] - c[0] : 0, least = INFINITY;
  *map = (axis_map){.count = voxels, .first = c[0], .step = 1, .even = true};
  if (points > 1) {
    map->even = is_even(c, points);
    for (size_t n = 0; n < steps; n++) least = fmin(least, fabs(c[n + 1] - c[n]));
    double wanted = map->even ? (double)steps
                              : fmin(ceil(fabs(span) / least), (double)TIMES_MOST * (double)steps);
    map->step = span / wanted;
    map->count = (size_t)wanted + !of_cells;
    if (of_cells) map->first += map->step / 2;
  }
  map->below = hl_allocate(context, map->count, sizeof *map->below);
  map->weight = hl_allocate(context, map->count, sizeof *map->weight);
  if (map->below == NULL || map->weight == NULL)
    return hl_fail_memory(error, map->count * sizeof *map->weight, "a grid's coordinates");
  fill_map(c, voxels, of_cells, map);
  return HL_OK;
}

static double number_at(const hl_volume *v, size_t i, size_t j, size_t k) {
  return hl_row_number(hl_volume_numbers(v, j, k, NULL), i) * v->value_scale + v->value_offset;
}

/* The weighted mean of the old voxels around a new voxel. Along an even axis, and for cells, a single old
 * voxel has the whole weight. */
static double sample(const hl_volume *v, const axis_map map[3], size_t i, size_t j, size_t k) {
  double sum = 0;
  const size_t at[3] = {i, j, k};
  for (int corner = 0; corner < 8; corner++) {
    size_t place[3];
    double weight = 1;
    for (int axis = 0; axis < 3; axis++) {
      double part = map[axis].weight[at[axis]];
      place[axis] = map[axis].below[at[axis]] + (corner >> axis & 1);
      weight *= corner >> axis & 1 ? part : 1 - part;
    }
    if (weight > 0) sum += weight * number_at(v, place[0], place[1], place[2]);
  }
  return sum;
}

static hl_status resample(const hl_volume *v, const axis_map map[3], const char *path, hl_volume **made,
                          hl_error *error) {
  hl_volume_description grid;
  size_t count;
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_F32;
  for (int axis = 0; axis < 3; axis++) grid.dimensions[axis] = map[axis].count;
  const size_t *n = grid.dimensions;
  if (__builtin_mul_overflow(n[0], n[1], &count) || __builtin_mul_overflow(count, n[2], &count))
    return hl_fail_memory(error, SIZE_MAX, path);
  float *voxels = hl_allocate(v->context, count, sizeof *voxels), *at = voxels;
  if (voxels == NULL) return hl_fail_memory(error, count * sizeof *voxels, path);
  for (size_t k = 0; k < n[2]; k++) {
    for (size_t j = 0; j < n[1]; j++)
      for (size_t i = 0; i < n[0]; i++) *at++ = (float)sample(v, map, i, j, k);
    if (hl_cancelled(v->context)) {
      hl_release(v->context, voxels);
      return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", path);
    }
  }
  hl_log(v->context, HL_LOG_WARNING,
         "%s: its points are not evenly spaced: %zu x %zu x %zu voxels are resampled to %zu x %zu x %zu even "
         "ones",
         path, v->dimension[0], v->dimension[1], v->dimension[2], n[0], n[1], n[2]);
  return hl_volume_adopt(v->context, &grid, path, voxels, made, error);
}

static void place(const axis_map map[3], hl_volume *volume) {
  const double origin[3] = {map[0].first, map[1].first, map[2].first};
  volume->index_to_world = (affine3){{{{map[0].step, 0, 0}, {0, map[1].step, 0}, {0, 0, map[2].step}}},
                                     vec3_of(origin)};
}

hl_status hl_rectilinear_place(hl_volume **volume, double *const coordinates[3], const size_t counts[3],
                               bool of_cells, const char *path, hl_error *error) {
  hl_volume *read = *volume;
  hl_context *context = read->context;
  axis_map map[3] = {{.count = 0}};
  hl_status status = HL_OK;
  bool even = true;
  for (int axis = 0; axis < 3 && status == HL_OK; axis++) {
    size_t voxels = read->dimension[axis], points = counts[axis];
    bool cells = of_cells && points > 1;
    if (points != voxels + cells || !is_monotonic(coordinates[axis], points) ||
        !isfinite(coordinates[axis][0]))
      status = hl_fail(error, HL_ERROR_INPUT,
                       "%s: %zu coordinates along %c for %zu voxels, or some that do not rise", path, points,
                       "xyz"[axis], voxels);
    else status = make_map(context, coordinates[axis], points, voxels, cells, &map[axis], error);
    even = even && map[axis].even;
  }
  if (status == HL_OK && !even && (read->pages != NULL || read->colors != NULL))
    status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: points that are not evenly spaced, with colours or more voxels "
                     "than memory has room for: resample it in the program that wrote it",
                     path);
  if (status == HL_OK && !even) {
    hl_volume *made = NULL;
    status = resample(read, map, path, &made, error);
    hl_volume_release(read);
    *volume = made;
  } else if (status != HL_OK) {
    hl_volume_release(read);
    *volume = NULL;
  }
  if (status == HL_OK) place(map, *volume);
  for (int axis = 0; axis < 3; axis++) {
    hl_release(context, map[axis].below);
    hl_release(context, map[axis].weight);
  }
  return status;
}
