/* volume/zarr/array_codecs.h - types, fill values and codecs of an array by their names. Each function fills
 * its part of the array. */
#ifndef HL_VOLUME_ZARR_ARRAY_CODECS_H
#define HL_VOLUME_ZARR_ARRAY_CODECS_H

#include "volume/zarr/array.h"

/* An array whose metadata are being read. */
typedef struct hl_zarr_reading {
  const hl_bundle *bundle;
  hl_zarr_array *array;
  hl_error *error;
} hl_zarr_reading;

#define hl_zarr_reading_fail(r, code, ...) \
  hl_zarr_fail((r)->bundle, (r)->array->folder, (r)->error, code, __VA_ARGS__)

/* Version 2: "<u2"; also sets the byte order. */
hl_status hl_zarr_type_2(const hl_zarr_reading *r, const char *name);
/* Version 3: "uint16". */
hl_status hl_zarr_type_3(const hl_zarr_reading *r, const char *name);
/* The filters of version 2, of which the ones that were applied last are undone first. */
hl_status hl_zarr_filters_2(const hl_zarr_reading *r, const json_t *list);
hl_status hl_zarr_compressor_2(const hl_zarr_reading *r, const json_t *compressor);
hl_status hl_zarr_codecs_3(const hl_zarr_reading *r, const json_t *list, hl_zarr_codecs *codecs);
/* null is 0. */
hl_status hl_zarr_fill_value(const hl_zarr_reading *r, const json_t *value);

#endif
