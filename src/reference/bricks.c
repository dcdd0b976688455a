/* reference/bricks.c - evaluates a field in bricks (bricks/bricks.h) at a point. A field in bricks is stored
 * as B-spline coefficients. The field's value at a point is a weighted sum of the 64 coefficients around the
 * point, at the level of the brick that contains the point. */
#include "bricks/bricks.h"

#include "core/memory.h"
#include "reference/reference.h"

/* The brick that holds a point, the weights of the four coefficients around the point along each axis, and
 * the derivatives (slopes) of these weights. */
typedef struct brick_place {
  const hl_brick_entry *entry;
  const float *first; /* the first of the 4 x 4 x 4 coefficients around the point */
  size_t row, slice;  /* number of floats from one row to the next, and from one slice to the next */
  double weight[3][4], slope[3][4];
} brick_place;

/* Finds the brick that holds a point, and the weights of the coefficients around the point. point: in the
 * index space of the volume that stands for the field. */
static void find_place(const reference_volume *volume, vec3 point, brick_place *found) {
  const hl_bricks *bricks = volume->grid->bricks;
  const size_t side = (size_t)1 << bricks->shift;
  const double lattice[3] = {point.x + bricks->origin[0], point.y + bricks->origin[1],
                             point.z + bricks->origin[2]};
  size_t block[3];
  double x[3];
  for (int axis = 0; axis < 3; axis++) {
    double end = (double)(bricks->directory_size[axis] * side);
    x[axis] = fmin(fmax(lattice[axis], 0), end);
    block[axis] = (size_t)fmin(floor(x[axis] / (double)side), (double)bricks->directory_size[axis] - 1);
  }
  found->entry = bricks->directory +
                 (block[2] * bricks->directory_size[1] + block[1]) * bricks->directory_size[0] + block[0];
  if (found->entry->slot < 0) return;
  const double spacing = ldexp(1, found->entry->level);
  found->row = side + BRICK_MARGIN;
  found->slice = found->row * found->row;
  found->first = bricks->pool + (size_t)found->entry->slot * found->slice * found->row;
  const size_t stride[3] = {1, found->row, found->slice};
  for (int axis = 0; axis < 3; axis++) {
    /* A brick begins at a multiple of its length. The brick's first coefficient lies one spacing of
     * coefficients before the brick's beginning. */
    double begin = floor((double)block[axis] / spacing) * (double)side;
    double at = x[axis] / spacing - begin, cell = fmin(floor(at), (double)side - 1);
    found->first += (size_t)cell * stride[axis];
    hl_reference_weights(volume->kernel, at - cell, found->weight[axis], found->slope[axis]);
    for (int tap = 0; tap < 4; tap++) found->slope[axis][tap] /= spacing;
  }
}

static double weigh(const brick_place *place, double empty, const double x[4], const double y[4],
                    const double z[4]) {
  double sum = 0;
  for (int k = 0; k < 4; k++)
    for (int j = 0; j < 4; j++)
      for (int i = 0; i < 4; i++) {
        float stored = place->first[(size_t)k * place->slice + (size_t)j * place->row + (size_t)i];
        sum += z[k] * y[j] * x[i] * (isfinite(stored) ? (double)stored : empty);
      }
  return sum;
}

double hl_reference_bricks_value(const reference_volume *volume, vec3 point) {
  const double empty = volume->empty_stored;
  brick_place place;
  find_place(volume, point, &place);
  if (place.entry->slot < 0) return isfinite(place.entry->constant) ? (double)place.entry->constant : empty;
  return weigh(&place, empty, place.weight[0], place.weight[1], place.weight[2]);
}

vec3 hl_reference_bricks_slope(const reference_volume *volume, vec3 point) {
  const double empty = volume->empty_stored;
  brick_place place;
  find_place(volume, point, &place);
  if (place.entry->slot < 0) return (vec3){0, 0, 0};
  return (vec3){weigh(&place, empty, place.slope[0], place.weight[1], place.weight[2]),
                weigh(&place, empty, place.weight[0], place.slope[1], place.weight[2]),
                weigh(&place, empty, place.weight[0], place.weight[1], place.slope[2])};
}

bool hl_reference_bricks_ranges(hl_context *context, const hl_bricks *bricks, double empty,
                                double (**ranges)[2]) {
  size_t side = ((size_t)1 << bricks->shift) + BRICK_MARGIN, count = side * side * side;
  *ranges = hl_allocate(context, bricks->slots, sizeof **ranges);
  for (size_t slot = 0; *ranges != NULL && slot < bricks->slots; slot++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t n = 0; n < count; n++) {
      float stored = bricks->pool[slot * count + n];
      double value = isfinite(stored) ? (double)stored : empty;
      low = fmin(low, value);
      high = fmax(high, value);
    }
    (*ranges)[slot][0] = low;
    (*ranges)[slot][1] = high;
  }
  return *ranges != NULL;
}

void hl_reference_bricks_range(const hl_bricks *bricks, double empty, double (*ranges)[2],
                               const double low[3], const double high[3], double range[2]) {
  const double side = ldexp(1, bricks->shift);
  size_t from[3], to[3], block[3];
  for (int axis = 0; axis < 3; axis++) {
    double last = (double)bricks->directory_size[axis] - 1;
    from[axis] = (size_t)fmin(fmax(floor((low[axis] + bricks->origin[axis]) / side), 0), last);
    to[axis] = (size_t)fmin(fmax(floor((high[axis] + bricks->origin[axis]) / side), 0), last);
  }
  range[0] = INFINITY, range[1] = -INFINITY;
  for (block[2] = from[2]; block[2] <= to[2]; block[2]++)
    for (block[1] = from[1]; block[1] <= to[1]; block[1]++)
      for (block[0] = from[0]; block[0] <= to[0]; block[0]++) {
        const hl_brick_entry *entry = bricks->directory +
                                      (block[2] * bricks->directory_size[1] + block[1]) *
                                          bricks->directory_size[0] +
                                      block[0];
        double constant = isfinite(entry->constant) ? (double)entry->constant : empty;
        range[0] = fmin(range[0], entry->slot < 0 ? constant : ranges[entry->slot][0]);
        range[1] = fmax(range[1], entry->slot < 0 ? constant : ranges[entry->slot][1]);
      }
}
