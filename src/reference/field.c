/* reference/field.c - reconstructs one volume's field at one point of the volume's index space, and finds the
 * bricks in which the volume is transparent.
 *
 * The field f at a point p is the sum over the 4 x 4 x 4 voxels around p, weighted by a tensor-product
 * kernel. Beyond the grid, the voxels at its borders are repeated. Every sample of a march (march.c) is a sum
 * of this kind. This file defines the three kernels again on purpose, because the reference shares no code
 * with the renderer. */
#include <string.h>

#include "bricks/bricks.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "reference/reference.h"
#include "scene/label/draw_labels.h"
#include "volume/store/gathered.h"

/* The positions and weights of the four voxels (taps) along each axis that a point's value depends on. */
typedef struct taps {
  size_t voxel[3][4];
  double weight[3][4];
  double slope[3][4]; /* derivatives of the weights with respect to the point's coordinate */
} taps;

static inline double stored_at(const reference_volume *volume, hl_storage storage, const void *row,
                               size_t i) {
  if (storage == HL_STORAGE_U8) return ((const uint8_t *)row)[i];
  if (storage == HL_STORAGE_U16) return ((const uint16_t *)row)[i];
  float value = ((const float *)row)[i];
  return isfinite(value) ? (double)value : volume->empty_stored;
}

static const double *coefficient_row(const reference_volume *volume, size_t j, size_t k) {
  return volume->coefficients + (k * volume->grid->dimension[1] + j) * volume->grid->dimension[0];
}

double hl_reference_stored_value(const reference_volume *volume, const size_t voxel[3]) {
  if (volume->coefficients != NULL) return coefficient_row(volume, voxel[1], voxel[2])[voxel[0]];
  const void *row = hl_volume_row(volume->grid, voxel[1], voxel[2]);
  return stored_at(volume, volume->grid->storage, row, voxel[0]);
}

/* The weights of the cubic B-spline at the distances 1+t, t, 1-t and 2-t, and their derivatives with respect
 * to t. */
static void bspline(double t, double weight[4]) {
  double u = 1 - t;
  weight[0] = u * u * u * (1.0 / 6);
  weight[1] = t * t * (0.5 * t - 1) + 2.0 / 3;
  weight[2] = u * u * (0.5 * u - 1) + 2.0 / 3;
  weight[3] = t * t * t * (1.0 / 6);
}
static void bspline_slope(double t, double slope[4]) {
  double u = 1 - t;
  slope[0] = -u * u / 2;
  slope[1] = (1.5 * t - 2) * t;
  slope[2] = -(1.5 * u - 2) * u;
  slope[3] = t * t / 2;
}

/* The weights of the Gaussian exp(-2 d^2), cut off at |d| = 2, for the four taps. The weights are divided by
 * their sum, so that a constant field stays constant. */
static void gaussian(double t, double weight[4]) {
  double sum = 0;
  for (int tap = 0; tap < 4; tap++) {
    double d = t + 1 - tap;
    weight[tap] = fabs(d) < 2 ? hl_exp(-2 * d * d) : 0;
    sum += weight[tap];
  }
  for (int tap = 0; tap < 4; tap++) weight[tap] /= sum;
}
/* The derivatives of the Gaussian's weights. Derived: a weight is w = g/S, where g = exp(-2 d^2) and S is the
 * sum of g over the four taps. With g' = -4 d g the derivative is w' = (g' - w S') / S. */
static void gaussian_slope(double t, const double weight[4], double slope[4]) {
  double sum = 0;
  for (int tap = 0; tap < 4; tap++) sum += slope[tap] = -4 * (t + 1 - tap) * weight[tap];
  for (int tap = 0; tap < 4; tap++) slope[tap] -= weight[tap] * sum;
}

static void linear(double t, double weight[4]) {
  weight[0] = weight[3] = 0;
  weight[1] = 1 - t;
  weight[2] = t;
}
static void linear_slope(double slope[4]) {
  slope[0] = slope[3] = 0;
  slope[1] = -1;
  slope[2] = 1;
}

void hl_reference_weights(hl_kernel kernel, double t, double weight[4], double slope[4]) {
  switch (kernel) {
    case HL_KERNEL_GAUSSIAN:
      gaussian(t, weight);
      if (slope != NULL) gaussian_slope(t, weight, slope);
      break;
    case HL_KERNEL_LINEAR:
      linear(t, weight);
      if (slope != NULL) linear_slope(slope);
      break;
    default:
      bspline(t, weight);
      if (slope != NULL) bspline_slope(t, slope);
      break;
  }
}

static inline size_t clamp_voxel(int64_t voxel, int64_t last) {
  return (size_t)(voxel < 0 ? 0 : voxel > last ? last : voxel);
}

/* Finds the taps of a point. slopes: whether the weights' derivatives are found, too. */
static inline void find_taps(const reference_volume *volume, vec3 point, bool slopes, taps *found) {
  const double p[3] = {point.x, point.y, point.z};
  for (int axis = 0; axis < 3; axis++) {
    int64_t last = (int64_t)volume->grid->dimension[axis] - 1;
    double inside = p[axis] > -0.5 ? p[axis] : -0.5;
    if (inside > (double)last + 0.5) inside = (double)last + 0.5;
    int64_t base = (int64_t)(inside + 1) - 1; /* the conversion rounds down, because inside + 1 is positive */
    double t = inside - (double)base, *weight = found->weight[axis], *slope = found->slope[axis];
    for (int tap = 0; tap < 4; tap++) found->voxel[axis][tap] = clamp_voxel(base - 1 + tap, last);
    hl_reference_weights(volume->kernel, t, weight, slopes ? slope : NULL);
  }
}

/* The weighted sum of the 64 voxels around a point. A voxel's weight is the product of its three taps'
 * weights. storage: the type of the stored voxels. Each caller passes a constant, so that the compiler makes
 * a separate loop for each type. */
static inline double weigh_stored(const reference_volume *volume, hl_storage storage,
                                  const size_t voxel[3][4], const double *x, const double *y,
                                  const double *z) {
  double sum = 0;
  for (int k = 0; k < 4; k++) {
    double slice = 0;
    for (int j = 0; j < 4; j++) {
      const void *row = hl_volume_row(volume->grid, voxel[1][j], voxel[2][k]);
      double line = 0;
      for (int i = 0; i < 4; i++) line += x[i] * stored_at(volume, storage, row, voxel[0][i]);
      slice += y[j] * line;
    }
    sum += z[k] * slice;
  }
  return sum;
}

static double weigh_coefficients(const reference_volume *volume, const size_t voxel[3][4], const double *x,
                                 const double *y, const double *z) {
  double sum = 0;
  for (int k = 0; k < 4; k++)
    for (int j = 0; j < 4; j++) {
      const double *row = coefficient_row(volume, voxel[1][j], voxel[2][k]);
      for (int i = 0; i < 4; i++) sum += z[k] * y[j] * x[i] * row[voxel[0][i]];
    }
  return sum;
}

static double weigh(const reference_volume *volume, const taps *at, const double *x, const double *y,
                    const double *z) {
  if (volume->coefficients != NULL) return weigh_coefficients(volume, at->voxel, x, y, z);
  switch (volume->grid->storage) {
    case HL_STORAGE_U8: return weigh_stored(volume, HL_STORAGE_U8, at->voxel, x, y, z);
    case HL_STORAGE_U16: return weigh_stored(volume, HL_STORAGE_U16, at->voxel, x, y, z);
    default: return weigh_stored(volume, HL_STORAGE_F32, at->voxel, x, y, z);
  }
}

/* Limits a value to the volume's range, because sums of the interpolating kernel can lie beyond the range of
 * the voxels. */
static double in_range(const reference_volume *volume, double value) {
  return volume->coefficients == NULL ? value : fmin(fmax(value, volume->least), volume->greatest);
}

double hl_reference_value(const reference_volume *volume, vec3 point) {
  taps at;
  if (volume->grid->bricks != NULL) return hl_reference_bricks_value(volume, point);
  find_taps(volume, point, false, &at);
  double stored = weigh(volume, &at, at.weight[0], at.weight[1], at.weight[2]);
  return in_range(volume, volume->grid->value_scale * stored + volume->grid->value_offset);
}

vec3 hl_reference_gradient(const reference_volume *volume, vec3 point) {
  taps at;
  if (volume->grid->bricks != NULL)
    return mat3_apply(volume->gradient_to_world, hl_reference_bricks_slope(volume, point));
  find_taps(volume, point, true, &at);
  vec3 stored = {weigh(volume, &at, at.slope[0], at.weight[1], at.weight[2]),
                 weigh(volume, &at, at.weight[0], at.slope[1], at.weight[2]),
                 weigh(volume, &at, at.weight[0], at.weight[1], at.slope[2])};
  /* Derived by the chain rule: df/dworld = (dindex/dworld)^T df/dindex. */
  return vec3_scale(mat3_apply(volume->gradient_to_world, stored), volume->grid->value_scale);
}

double hl_reference_extinction(const reference_volume *volume, double value, vec3 point) {
  const hl_transfer_function *function = &volume->described->transfer_function;
  if (value < volume->transparent_below) return 0;
  double opacity = hl_transfer_function_opacity(function, value);
  if (!(opacity > 0)) return 0;
  double extinction = hl_has_plane(function) ? hl_reference_plane_sum(volume, value, point).extinction
                                             : -hl_log1p(-fmin(opacity, 0.9999)) / function->unit_distance;
  extinction *= hl_reference_mask_factor(volume, point);
  if (function->gradient_opacity_count == 0) return extinction;
  return extinction *
         hl_transfer_function_gradient_opacity(function, vec3_length(hl_reference_gradient(volume, point)));
}

/* ---- where the volume is transparent ----
 *
 * Index space is cut into bricks of 4 cells a side. Cell c of an axis holds the points p with floor(p) = c
 * - 1. So the first brick of an axis starts at p = -1, and covers the half cell before the first voxel. A
 * weighted mean with positive weights lies within the range of the weighted voxels. So every sample in a
 * brick is transparent if the transfer function is transparent over the range of all voxels that the brick's
 * samples depend on. */

enum { BRICK_CELLS = 4, FARTHEST = 255 };

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Finds the voxels, along an axis of n voxels, on which the samples in brick number `brick` depend. In the
 * brick, floor(p) goes from 4 brick - 1 to 4 brick + 2, and the taps of p go from one voxel before floor(p)
 * to two voxels after floor(p). */
static void brick_voxels(size_t brick, size_t n, size_t *first, size_t *last) {
  size_t corner = BRICK_CELLS * brick;
  *first = least(corner < 2 ? 0 : corner - 2, n - 1);
  *last = least(corner + BRICK_CELLS, n - 1);
}

/* Returns whether one of the volume's isosurfaces has a value from low to high. */
static bool holds_iso(const hl_scene_volume *volume, double low, double high) {
  for (size_t i = 0; i < volume->iso_count; i++)
    if (volume->iso[i].value >= low && volume->iso[i].value <= high) return true;
  return false;
}

/* Finds the range of the stored values on which the samples in a brick depend. */
static void range_of_brick(const reference_volume *volume, const size_t brick[3], double range[2]) {
  size_t first[3], last[3], voxel[3];
  if (volume->ranges != NULL) {
    double begin[3], end[3];
    for (int axis = 0; axis < 3; axis++) {
      begin[axis] = BRICK_CELLS * (double)brick[axis] - 1;
      end[axis] = begin[axis] + BRICK_CELLS;
    }
    hl_reference_bricks_range(volume->grid->bricks, volume->empty_stored, volume->ranges, begin, end, range);
    return;
  }
  for (int axis = 0; axis < 3; axis++)
    brick_voxels(brick[axis], volume->grid->dimension[axis], &first[axis], &last[axis]);
  double low = INFINITY, high = -INFINITY;
  for (voxel[2] = first[2]; voxel[2] <= last[2]; voxel[2]++)
    for (voxel[1] = first[1]; voxel[1] <= last[1]; voxel[1]++)
      for (voxel[0] = first[0]; voxel[0] <= last[0]; voxel[0]++) {
        double stored = hl_reference_stored_value(volume, voxel);
        low = fmin(low, stored);
        high = fmax(high, stored);
      }
  range[0] = low;
  range[1] = high;
}

static bool brick_visible(const reference_volume *volume, size_t i, size_t j, size_t k) {
  double range[2];
  range_of_brick(volume, (const size_t[3]){i, j, k}, range);
  double a = volume->grid->value_scale * range[0] + volume->grid->value_offset;
  double b = volume->grid->value_scale * range[1] + volume->grid->value_offset;
  a = in_range(volume, a);
  b = in_range(volume, b);
  return hl_transfer_function_visible(&volume->described->transfer_function, fmin(a, b), fmax(a, b)) ||
         holds_iso(volume->described, fmin(a, b), fmax(a, b));
}

/* Sets the clearance of the bricks in layer k to 0 for bricks that may be visible, and to FARTHEST for other
 * bricks. */
static void mark_visible(void *data, size_t k, int worker) {
  (void)worker;
  const reference_volume *volume = data;
  unsigned char *out = volume->clearance + k * volume->bricks[1] * volume->bricks[0];
  for (size_t j = 0; j < volume->bricks[1]; j++)
    for (size_t i = 0; i < volume->bricks[0]; i++) *out++ = brick_visible(volume, i, j, k) ? 0 : FARTHEST;
}

/* Lowers the distance of brick (i, j, k) to one more than the least distance of its neighbours on one side.
 * side: -1 for the neighbours that come before the brick in memory, +1 for the neighbours that come after the
 * brick. Two sweeps over all bricks, one in each direction, give the exact chessboard distance (Rosenfeld and
 * Pfaltz, "Distance functions on digital pictures", 1968). */
static void relax_brick(const reference_volume *volume, ptrdiff_t i, ptrdiff_t j, ptrdiff_t k, int side) {
  const ptrdiff_t n[3] = {(ptrdiff_t)volume->bricks[0], (ptrdiff_t)volume->bricks[1],
                          (ptrdiff_t)volume->bricks[2]};
  unsigned char *here = &volume->clearance[(k * n[1] + j) * n[0] + i];
  for (ptrdiff_t dk = -1; dk <= 1; dk++)
    for (ptrdiff_t dj = -1; dj <= 1; dj++)
      for (ptrdiff_t di = -1; di <= 1; di++) {
        if ((dk * 9 + dj * 3 + di) * side <= 0) continue;
        ptrdiff_t x = i + di, y = j + dj, z = k + dk;
        if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) continue;
        int through = volume->clearance[(z * n[1] + y) * n[0] + x] + 1;
        if (through < *here) *here = (unsigned char)through;
      }
}

static void measure_clearance(const reference_volume *volume, hl_pool *pool) {
  const ptrdiff_t n[3] = {(ptrdiff_t)volume->bricks[0], (ptrdiff_t)volume->bricks[1],
                          (ptrdiff_t)volume->bricks[2]};
  for (ptrdiff_t k = 0; k < n[2] && !hl_pool_stops(pool, 0); k++)
    for (ptrdiff_t j = 0; j < n[1]; j++)
      for (ptrdiff_t i = 0; i < n[0]; i++) relax_brick(volume, i, j, k, -1);
  for (ptrdiff_t k = n[2]; k-- > 0 && !hl_pool_stops(pool, 0);)
    for (ptrdiff_t j = n[1]; j-- > 0;)
      for (ptrdiff_t i = n[0]; i-- > 0;) relax_brick(volume, i, j, k, 1);
}

static hl_status create_bricks(hl_context *context, reference_volume *volume, hl_pool *pool,
                               hl_error *error) {
  size_t count = 1;
  for (int axis = 0; axis < 3; axis++) {
    /* The bricks' cells 0 .. n along an axis of n voxels are the points p with floor(p) from -1 to n - 1. */
    volume->bricks[axis] = volume->grid->dimension[axis] / BRICK_CELLS + 1;
    count *= volume->bricks[axis];
  }
  volume->clearance = hl_allocate(context, count, 1);
  if (volume->clearance == NULL) return hl_fail_memory(error, count, "the bricks of a volume");
  hl_pool_run(pool, volume->bricks[2], mark_visible, volume);
  measure_clearance(volume, pool);
  return hl_pool_check(pool, "preparing", error);
}

double hl_reference_clearance(const reference_volume *volume, vec3 point, vec3 direction) {
  const double p[3] = {point.x, point.y, point.z}, d[3] = {direction.x, direction.y, direction.z};
  size_t brick[3];
  for (int axis = 0; axis < 3; axis++) {
    double coordinate = fmax(floor((p[axis] + 1) / BRICK_CELLS), 0);
    brick[axis] = least((size_t)coordinate, volume->bricks[axis] - 1);
  }
  size_t offset = (brick[2] * volume->bricks[1] + brick[1]) * volume->bricks[0] + brick[0];
  int clear = volume->clearance[offset];
  if (clear == 0) return 0;
  double distance = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    double low = BRICK_CELLS * ((double)brick[axis] - clear + 1) - 1;
    double high = BRICK_CELLS * ((double)brick[axis] + clear) - 1;
    if (d[axis] != 0) distance = fmin(distance, ((d[axis] > 0 ? high : low) - p[axis]) / d[axis]);
  }
  return fmax(distance, 0);
}

/* ---- the volume ---- */

static double smallest_edge(const hl_scene_volume *volume) {
  affine3 to_world = hl_scene_volume_index_to_world(volume);
  double least = INFINITY;
  for (int axis = 0; axis < 3; axis++) least = fmin(least, vec3_length(mat3_column(to_world.linear, axis)));
  return least;
}

/* The least gradient at which matter counts fully as a surface: a thousandth, per voxel edge, of the range of
 * values over which the transfer function changes. */
static double surface_gradient(const hl_transfer_function *function, double edge) {
  double span = 0;
  if (function->opacity_count > 0)
    span = function->opacity[function->opacity_count - 1].value - function->opacity[0].value;
  return 1e-3 * (span > 0 ? span : 1) / edge;
}

hl_status hl_reference_volume_create(const reference *all, const hl_scene_volume *described, hl_pool *pool,
                                     reference_volume *made, hl_error *error) {
  affine3 to_world = hl_scene_volume_index_to_world(described);
  const hl_volume *grid = described->volume;
  *made = (reference_volume){.described = described,
                             .grid = grid,
                             .kernel = hl_kernel_of_volume(described, all->scene->render.kernel),
                             .index_to_world = to_world};
  if (grid->pages != NULL && !hl_volume_is_in_memory(grid))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "the reference needs a volume's voxels in memory: raise the memory limit");
  if (grid->pages != NULL) {
    hl_volume *whole;
    hl_status status = hl_volume_in_memory(grid, &whole, error);
    if (status != HL_OK) return status;
    made->grid = grid = whole;
  }
  if (!affine3_invert(to_world, &made->world_to_index))
    return hl_fail(error, HL_ERROR_INPUT, "volume %s: its axes lie in a plane: give three independent ones",
                   described->name != NULL ? described->name : "without a name");
  affine3 world_to_mask;
  if (described->mask.volume != NULL) {
    if (!affine3_invert(hl_scene_mask_index_to_world(described), &world_to_mask))
      return hl_fail(error, HL_ERROR_INPUT, "a mask's axes lie in a plane: give three independent ones");
    made->index_to_mask = affine3_multiply(world_to_mask, to_world);
  }
  mat3 inverse = made->world_to_index.linear;
  made->gradient_to_world = mat3_from_columns(inverse.row[0], inverse.row[1], inverse.row[2]);
  hl_scene_volume_box(described, made->low, made->high);
  hl_reference_find_clip_faces(all->scene, made);
  made->smallest_edge = smallest_edge(described);
  made->surface_gradient = surface_gradient(&described->transfer_function, made->smallest_edge);
  made->empty_value = hl_scene_volume_empty_value(described);
  made->empty_stored = grid->value_scale != 0 ? (made->empty_value - grid->value_offset) / grid->value_scale
                                              : 0;
  if (grid->bricks != NULL &&
      !hl_reference_bricks_ranges(all->context, grid->bricks, made->empty_stored, &made->ranges))
    return hl_fail_memory(error, grid->bricks->slots * sizeof *made->ranges,
                          "the ranges of a volume's bricks");
  /* If the transfer function makes no value of the volume transparent, the empty value lies below all values
   * of the volume, and stands for space without matter. */
  bool opaque_everywhere = hl_transfer_function_opacity(&described->transfer_function, made->empty_value) > 0;
  made->transparent_below = opaque_everywhere ? (made->empty_value + grid->minimum) / 2 : -INFINITY;
  if (made->kernel == HL_KERNEL_INTERPOLATING) {
    made->least = fmin(grid->minimum, made->empty_value);
    made->greatest = fmax(grid->maximum, made->empty_value);
    hl_status status = hl_reference_coefficients_create(all->context, made, error);
    if (status != HL_OK) return status;
  }
  hl_status feet = hl_reference_feet_create(all->context, made, error);
  if (feet != HL_OK) return feet;
  return create_bricks(all->context, made, pool, error);
}

void hl_reference_volume_release(hl_context *context, reference_volume *volume) {
  hl_release(context, volume->clearance);
  hl_release(context, volume->coefficients);
  hl_release(context, volume->ranges);
  hl_release(context, volume->feet);
  hl_release(context, volume->depths);
}
