/* label/filter.h - filters a field of floats along its three axes, in place. */
#ifndef HL_LABEL_FILTER_H
#define HL_LABEL_FILTER_H

#include "core/pool.h"
#include "label/row_functions.h"

typedef struct label_field {
  float *values;  /* [size z][y][x]; the values of the field */
  size_t size[3]; /* number of values along x, y and z */
  const label_row_functions *functions;
  float *lines; /* [threads][line_floats]; working space of the filters */
  size_t line_floats;
} label_field;

/* One half of a symmetric filter: the weight of the middle value first, and then the weights of values at
 * distances from 1 to `reach`. */
typedef struct label_filter {
  int reach; /* the greatest distance of a value that the filter reads: 2, 4 or HL_FILTER_REACH */
  float taps[HL_FILTER_REACH + 1];
} label_filter;

/* The number of floats that the filters need as working space for each thread. */
size_t hl_label_line_floats(const size_t size[3]);

/* Filters a field along x, y and z. Beyond the field's ends, the values at the border repeat. */
void hl_label_filter(hl_pool *pool, const label_field *field, const label_filter *filter);

#endif
