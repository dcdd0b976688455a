/* field/field_planes.h - describes planes: arrays with one number for each cell of a slice, and a border
 * around the cells. */
#ifndef HL_FIELD_FIELD_PLANES_H
#define HL_FIELD_FIELD_PLANES_H

#include "field/field.h"

typedef struct field_planes {
  int32_t stride; /* the distance, in numbers, from one row of a plane to the next */
  size_t plane;   /* number of numbers in a plane */
} field_planes;

static inline field_planes hl_field_planes(const field_slices *s) {
  field_planes planes = {.stride = s->stride + 2 * FIELD_LANES};
  planes.plane = (size_t)planes.stride * (size_t)(s->rows + 2);
  return planes;
}

/* The index of a cell's number in a plane. */
static inline size_t hl_plane_place(const field_planes *planes, int32_t row, int32_t column) {
  return (size_t)(row + 1) * (size_t)planes->stride + FIELD_LANES + (size_t)column;
}

#endif
