/* volume/formats/zarr/array_codecs.h - finds types, fill values and codecs of an array by their names. Each
 * function sets a part of the array's description. */
#ifndef HL_VOLUME_ZARR_ARRAY_CODECS_H
#define HL_VOLUME_ZARR_ARRAY_CODECS_H

#include "volume/formats/zarr/array.h"

/* An array whose metadata are being read. */
typedef struct hl_zarr_reading {
  const hl_bundle *bundle;
  hl_zarr_array *array;
  hl_error *error;
} hl_zarr_reading;

#define hl_zarr_reading_fail(r, code, ...) \
  hl_zarr_fail((r)->bundle, (r)->array->folder, (r)->error, code, __VA_ARGS__)

/* Reads a type of Zarr version 2, such as "<u2", which also states the byte order. */
hl_status hl_zarr_type_2(const hl_zarr_reading *r, const char *name);
/* Reads a type of Zarr version 3, such as "uint16". */
hl_status hl_zarr_type_3(const hl_zarr_reading *r, const char *name);
/* Reads the filters of Zarr version 2, in the order in which they were applied. Chunks are decoded in the
 * opposite order. */
hl_status hl_zarr_filters_2(const hl_zarr_reading *r, const json_t *list);
hl_status hl_zarr_compressor_2(const hl_zarr_reading *r, const json_t *compressor);
hl_status hl_zarr_codecs_3(const hl_zarr_reading *r, const json_t *list, hl_zarr_codecs *codecs);
/* Reads the fill value. The JSON value null stands for the fill value 0. */
hl_status hl_zarr_fill_value(const hl_zarr_reading *r, const json_t *value);

#endif
