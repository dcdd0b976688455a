/* volume/formats/zarr/array_read.c - reads and checks the metadata of a Zarr array (for types, fill values
 * and codecs see array_codecs.c). */
#include "volume/formats/zarr/array_read.h"

#include <string.h>

#include "volume/convert.h"
#include "volume/formats/zarr/array_codecs.h"

/* ---- shapes ---- */

static hl_status read_sizes(const hl_zarr_reading *r, const json_t *list, const char *key, uint64_t *sizes,
                            int *count) {
  size_t length = json_array_size(list);
  if (length < 1 || length > HL_ZARR_AXES_MOST)
    return hl_zarr_reading_fail(r, HL_ERROR_UNSUPPORTED,
                                "\"%s\" must be a list of 1 to %d numbers: write an array of fewer axes", key,
                                HL_ZARR_AXES_MOST);
  *count = (int)length;
  for (size_t n = 0; n < length; n++) {
    json_int_t size = json_integer_value(json_array_get(list, n));
    if (size < 1)
      return hl_zarr_reading_fail(r, HL_ERROR_INPUT, "\"%s\"[%zu] must be a whole number above 0", key, n);
    sizes[n] = (uint64_t)size;
  }
  return HL_OK;
}

static hl_status read_chunk_shape(const hl_zarr_reading *r, const json_t *list, const char *key,
                                  uint64_t *sizes) {
  int count;
  hl_status status = read_sizes(r, list, key, sizes, &count);
  if (status == HL_OK && count != r->array->rank)
    return hl_zarr_reading_fail(r, HL_ERROR_INPUT, "\"%s\" has %d numbers, \"shape\" has %d", key, count,
                                r->array->rank);
  return status;
}

static hl_status check_chunk_bytes(const hl_zarr_reading *r) {
  hl_zarr_array *array = r->array;
  uint64_t bytes = hl_voxel_type_bytes(array->type);
  for (int axis = 0; axis < array->rank; axis++)
    if (__builtin_mul_overflow(bytes, array->chunk[axis], &bytes) || bytes > HL_ZARR_CHUNK_BYTES_MOST)
      return hl_zarr_reading_fail(r, HL_ERROR_UNSUPPORTED,
                                  "a chunk of more than 2 GiB: write the array with smaller ones");
  array->chunk_bytes = (size_t)bytes;
  return HL_OK;
}

static void read_axis_names(hl_zarr_array *array, const json_t *names) {
  for (int axis = 0; axis < array->rank && json_array_size(names) == (size_t)array->rank; axis++) {
    const char *name = json_string_value(json_array_get(names, (size_t)axis));
    if (name != NULL && strlen(name) < HL_ZARR_NAME_BYTES) strcpy(array->axis_name[axis], name);
  }
}

/* ---- version 2 ---- */

static hl_status read_separator(const hl_zarr_reading *r, const json_t *value, char without) {
  const char *text = json_string_value(value);
  r->array->separator = value == NULL ? without : text != NULL ? text[0] : 0;
  if (r->array->separator != '.' && r->array->separator != '/')
    return hl_zarr_reading_fail(r, HL_ERROR_INPUT, "the separator of chunk names must be \".\" or \"/\"");
  return HL_OK;
}

static hl_status read_version_2(const hl_zarr_reading *r, const json_t *node) {
  hl_zarr_array *array = r->array;
  const char *order = json_string_value(json_object_get(node, "order"));
  const json_t *filters = json_object_get(node, "filters");
  for (int axis = 0; axis < HL_ZARR_AXES_MOST; axis++) array->shards.size[axis] = 1;
  hl_status status = read_sizes(r, json_object_get(node, "shape"), "shape", array->shape, &array->rank);
  if (status == HL_OK) status = read_chunk_shape(r, json_object_get(node, "chunks"), "chunks", array->chunk);
  if (status == HL_OK) status = hl_zarr_type_2(r, json_string_value(json_object_get(node, "dtype")));
  if (status == HL_OK) status = hl_zarr_filters_2(r, filters);
  if (status == HL_OK) status = hl_zarr_compressor_2(r, json_object_get(node, "compressor"));
  if (status == HL_OK) status = read_separator(r, json_object_get(node, "dimension_separator"), '.');
  array->separator_untold = json_object_get(node, "dimension_separator") == NULL;
  bool reversed = order != NULL && strcmp(order, "F") == 0;
  for (int n = 0; n < array->rank; n++) array->codecs.order[n] = reversed ? array->rank - 1 - n : n;
  return status == HL_OK ? hl_zarr_fill_value(r, json_object_get(node, "fill_value")) : status;
}

/* ---- version 3 ---- */

/* Returns the member `key` of the "configuration" of an extension, such as a codec. */
static json_t *configured(const json_t *extension, const char *key) {
  return json_object_get(json_object_get(extension, "configuration"), key);
}

static hl_status read_chunk_names(const hl_zarr_reading *r, const json_t *encoding) {
  const char *name = json_string_value(json_object_get(encoding, "name"));
  bool plain = name == NULL || strcmp(name, "default") == 0;
  if (!plain && strcmp(name, "v2") != 0)
    return hl_zarr_reading_fail(
        r, HL_ERROR_UNSUPPORTED,
        "a \"chunk_key_encoding\" other than default and v2: write the array with one of them");
  r->array->has_prefix = plain;
  return read_separator(r, configured(encoding, "separator"), plain ? '/' : '.');
}

/* Reads the codec of a sharded array. In a sharded array, each chunk of the chunk grid is a shard: a file
 * with several inner chunks. */
static hl_status read_shards(const hl_zarr_reading *r, const json_t *codec) {
  hl_zarr_array *array = r->array;
  uint64_t outer[HL_ZARR_AXES_MOST];
  memcpy(outer, array->chunk, sizeof outer);
  hl_status status = read_chunk_shape(r, configured(codec, "chunk_shape"), "chunk_shape", array->chunk);
  array->shards.are_used = true;
  for (int axis = 0; axis < array->rank && status == HL_OK; axis++) {
    array->shards.size[axis] = outer[axis] / array->chunk[axis];
    if (outer[axis] % array->chunk[axis] != 0)
      status = hl_zarr_reading_fail(r, HL_ERROR_INPUT, "shards must hold whole chunks along every axis");
    else if (__builtin_mul_overflow(array->shards.chunks, array->shards.size[axis], &array->shards.chunks) ||
             array->shards.chunks > HL_ZARR_CHUNK_BYTES_MOST / 16)
      status = hl_zarr_reading_fail(r, HL_ERROR_UNSUPPORTED,
                                    "a shard of too many chunks: write the array with smaller shards");
  }
  if (status == HL_OK) status = hl_zarr_codecs_3(r, configured(codec, "codecs"), &array->codecs);
  hl_zarr_codecs index = {.compressor = HL_ZARR_RAW};
  if (status == HL_OK) status = hl_zarr_codecs_3(r, configured(codec, "index_codecs"), &index);
  if (status == HL_OK && (index.compressor != HL_ZARR_RAW || index.big_endian))
    status = hl_zarr_reading_fail(r, HL_ERROR_UNSUPPORTED,
                                  "a packed or big-endian index of shards: write the array with codecs "
                                  "\"bytes\" (little) and \"crc32c\" for it");
  array->shards.index_checks = index.inner_checks;
  const char *place = json_string_value(configured(codec, "index_location"));
  array->shards.index_at_start = place != NULL && strcmp(place, "start") == 0;
  return status;
}

static hl_status read_codecs(const hl_zarr_reading *r, const json_t *codecs) {
  const json_t *first = json_array_get(codecs, 0);
  const char *name = json_string_value(json_object_get(first, "name"));
  if (name == NULL || strcmp(name, "sharding_indexed") != 0)
    return hl_zarr_codecs_3(r, codecs, &r->array->codecs);
  if (json_array_size(codecs) != 1)
    return hl_zarr_reading_fail(
        r, HL_ERROR_UNSUPPORTED,
        "codecs beside \"sharding_indexed\": write the array with those within the shards alone");
  return read_shards(r, first);
}

static hl_status read_version_3(const hl_zarr_reading *r, const json_t *node) {
  hl_zarr_array *array = r->array;
  const json_t *grid = json_object_get(node, "chunk_grid");
  const char *grid_name = json_string_value(json_object_get(grid, "name"));
  for (int axis = 0; axis < HL_ZARR_AXES_MOST; axis++) array->shards.size[axis] = 1;
  if (json_array_size(json_object_get(node, "storage_transformers")) > 0 ||
      (grid_name != NULL && strcmp(grid_name, "regular") != 0))
    return hl_zarr_reading_fail(
        r, HL_ERROR_UNSUPPORTED,
        "a chunk grid that is not regular, or storage transformers: write the array without");
  hl_status status = read_sizes(r, json_object_get(node, "shape"), "shape", array->shape, &array->rank);
  if (status == HL_OK)
    status = read_chunk_shape(r, configured(grid, "chunk_shape"), "chunk_shape", array->chunk);
  if (status == HL_OK) status = hl_zarr_type_3(r, json_string_value(json_object_get(node, "data_type")));
  if (status == HL_OK) status = read_chunk_names(r, json_object_get(node, "chunk_key_encoding"));
  if (status == HL_OK) status = read_codecs(r, json_object_get(node, "codecs"));
  if (status == HL_OK) status = hl_zarr_fill_value(r, json_object_get(node, "fill_value"));
  read_axis_names(array, json_object_get(node, "dimension_names"));
  return status;
}

/* ---- all steps together ---- */

/* Reads the names of the axes from the attribute into which xarray writes them in version 2. */
static hl_status read_attributed_names(const hl_zarr_reading *r) {
  json_t *attributes;
  hl_status status = hl_zarr_metadata_read(r->bundle, r->array->folder, ".zattrs", &attributes, r->error);
  if (status == HL_OK && attributes != NULL)
    read_axis_names(r->array, json_object_get(attributes, "_ARRAY_DIMENSIONS"));
  json_decref(attributes);
  return status;
}

hl_status hl_zarr_array_read(const hl_bundle *bundle, const char *folder, hl_zarr_array *array, bool *found,
                             hl_error *error) {
  hl_zarr_reading r = {.bundle = bundle, .array = array, .error = error};
  json_t *node;
  *array = (hl_zarr_array){.shards.chunks = 1};
  strcpy(array->folder, folder);
  *found = false;
  hl_status status = hl_zarr_metadata_read(bundle, folder, "zarr.json", &node, error);
  array->version = 3;
  if (status == HL_OK && node == NULL) {
    array->version = 2;
    status = hl_zarr_metadata_read(bundle, folder, ".zarray", &node, error);
  }
  if (status != HL_OK || node == NULL) return status;
  const char *kind = json_string_value(json_object_get(node, "node_type"));
  *found = array->version == 2 || (kind != NULL && strcmp(kind, "array") == 0);
  if (*found) status = array->version == 2 ? read_version_2(&r, node) : read_version_3(&r, node);
  json_decref(node);
  if (*found && status == HL_OK) status = check_chunk_bytes(&r);
  return *found && status == HL_OK && array->version == 2 ? read_attributed_names(&r) : status;
}
