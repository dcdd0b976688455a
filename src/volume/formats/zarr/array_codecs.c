/* volume/formats/zarr/array_codecs.c - finds types, fill values and codecs of Zarr arrays by their names. */
#include "volume/formats/zarr/array_codecs.h"

#include <math.h>
#include <string.h>

#include "volume/convert.h"
#include "volume/io/text.h"

/* ---- types ---- */

static hl_status find_type(const hl_zarr_reading *r, const hl_named_type *types, size_t count,
                           const char *name, const char *whole) {
  char shown[HL_PRINTABLE_BYTES];
  if (name != NULL && hl_find_type(types, count, name, &r->array->type)) return HL_OK;
  return hl_zarr_reading_fail(r, HL_ERROR_UNSUPPORTED,
                              "voxels of type %s: integers of 8 to 64 bits and floats of 16 to 64 are read: "
                              "write the array in one of them",
                              hl_text_printable(shown, whole != NULL ? whole : "that is not told"));
}

hl_status hl_zarr_type_2(const hl_zarr_reading *r, const char *name) {
  static const hl_named_type types[] = {{"b1|u1", HL_VOXEL_U8}, {"i1", HL_VOXEL_I8},  {"u2", HL_VOXEL_U16},
                                        {"i2", HL_VOXEL_I16},   {"u4", HL_VOXEL_U32}, {"i4", HL_VOXEL_I32},
                                        {"u8", HL_VOXEL_U64},   {"i8", HL_VOXEL_I64}, {"f2", HL_VOXEL_F16},
                                        {"f4", HL_VOXEL_F32},   {"f8", HL_VOXEL_F64}};
  bool ordered = name != NULL && name[0] != 0 && strchr("<>|=", name[0]) != NULL;
  r->array->codecs.big_endian = ordered && name[0] == '>';
  return find_type(r, types, sizeof types / sizeof *types, ordered ? name + 1 : NULL, name);
}

hl_status hl_zarr_type_3(const hl_zarr_reading *r, const char *name) {
  static const hl_named_type types[] = {
      {"bool|uint8", HL_VOXEL_U8}, {"int8", HL_VOXEL_I8},    {"uint16", HL_VOXEL_U16},
      {"int16", HL_VOXEL_I16},     {"uint32", HL_VOXEL_U32}, {"int32", HL_VOXEL_I32},
      {"uint64", HL_VOXEL_U64},    {"int64", HL_VOXEL_I64},  {"float16", HL_VOXEL_F16},
      {"float32", HL_VOXEL_F32},   {"float64", HL_VOXEL_F64}};
  return find_type(r, types, sizeof types / sizeof *types, name, name);
}

/* ---- fill values ---- */

static void store_integer(hl_voxel_type type, int64_t value, unsigned char fill[8]) {
  /* for signed and unsigned types, the stored number is the low bytes of the number in two's complement */
  uint8_t byte = (uint8_t)value;
  uint16_t word = (uint16_t)value;
  uint32_t wide = (uint32_t)value;
  switch (hl_voxel_type_bytes(type)) {
    case 1: memcpy(fill, &byte, 1); break;
    case 2: memcpy(fill, &word, 2); break;
    case 4: memcpy(fill, &wide, 4); break;
    default: memcpy(fill, &value, 8); break;
  }
}

/* Converts a double to binary16. Bits of the fraction beyond binary16 are cut off; fill values of arrays of
 * binary16 have no such bits. */
static uint16_t half_of(double value) {
  int exponent;
  uint16_t sign = signbit(value) ? 0x8000 : 0;
  if (isnan(value)) return 0x7e00;
  double mantissa = frexp(fabs(value), &exponent); /* the mantissa is in [1/2, 1) */
  if (value == 0) return sign;
  if (isinf(value) || exponent > 16) return sign | 0x7c00;
  if (exponent < -13) return sign | (uint16_t)ldexp(fabs(value), 24);
  return sign | (uint16_t)((exponent + 14) << 10) | (uint16_t)((mantissa * 2 - 1) * 1024);
}

static void store_real(hl_voxel_type type, double value, unsigned char fill[8]) {
  uint16_t half = half_of(value);
  float single = (float)value;
  if (type == HL_VOXEL_F16) memcpy(fill, &half, sizeof half);
  else if (type == HL_VOXEL_F32) memcpy(fill, &single, sizeof single);
  else memcpy(fill, &value, sizeof value);
}

/* Stores a fill value that is written as a text: a decimal number, "NaN", "Infinity", "-Infinity", or the
 * bits of the number, such as "0x7fc00000". */
static bool store_text(hl_voxel_type type, const char *text, unsigned char fill[8]) {
  double value;
  if (hl_text_number(text, strlen(text), &value)) {
    store_real(type, value, fill);
    return true;
  }
  uint64_t bits = 0;
  size_t digits = 2 * hl_voxel_type_bytes(type);
  if (text[0] != '0' || text[1] != 'x' || strlen(text) != digits + 2) return false;
  for (const char *digit = text + 2; *digit != 0; digit++) {
    const char *found = strchr("0123456789abcdef", *digit >= 'A' && *digit <= 'F' ? *digit + 32 : *digit);
    if (found == NULL) return false;
    bits = bits << 4 | (uint64_t)(found - "0123456789abcdef");
  }
  store_integer(type, (int64_t)bits, fill);
  return true;
}

hl_status hl_zarr_fill_value(const hl_zarr_reading *r, const json_t *value) {
  hl_zarr_array *array = r->array;
  bool is_real = array->type == HL_VOXEL_F16 || array->type == HL_VOXEL_F32 || array->type == HL_VOXEL_F64;
  bool known = true;
  memset(array->fill, 0, sizeof array->fill);
  if (value == NULL || json_is_null(value)) return HL_OK;
  if (json_is_boolean(value)) array->fill[0] = json_is_true(value);
  else if (is_real && json_is_number(value)) store_real(array->type, json_number_value(value), array->fill);
  else if (is_real && json_is_string(value))
    known = store_text(array->type, json_string_value(value), array->fill);
  else if (json_is_integer(value)) store_integer(array->type, json_integer_value(value), array->fill);
  else if (json_is_real(value) && fabs(json_real_value(value)) < 0x1p63)
    store_integer(array->type, (int64_t)json_real_value(value), array->fill);
  else known = false;
  return known ? HL_OK
               : hl_zarr_reading_fail(r, HL_ERROR_INPUT, "a \"fill_value\" that does not fit the type");
}

/* ---- codecs ---- */

static bool find_compressor(const char *name, hl_zarr_compressor *compressor) {
  static const struct {
    const char *names;
    hl_zarr_compressor compressor;
  } known[] = {{"zlib|gzip|numcodecs.zlib|numcodecs.gzip", HL_ZARR_DEFLATE},
               {"zstd|numcodecs.zstd", HL_ZARR_ZSTD},
               {"blosc|numcodecs.blosc", HL_ZARR_BLOSC},
               {"lz4|numcodecs.lz4", HL_ZARR_LZ4},
               {"bz2|numcodecs.bz2", HL_ZARR_BZIP2},
               {"lzma|numcodecs.lzma", HL_ZARR_XZ}};
  for (size_t n = 0; name != NULL && n < sizeof known / sizeof *known; n++)
    if (hl_text_is_one_of(name, known[n].names)) {
      *compressor = known[n].compressor;
      return true;
    }
  return false;
}

static hl_status fail_codec(const hl_zarr_reading *r, const char *name) {
  char shown[HL_PRINTABLE_BYTES];
  return hl_zarr_reading_fail(r, HL_ERROR_UNSUPPORTED,
                              "chunks packed by \"%s\", or by several codecs: raw, zlib, gzip, zstd, blosc, "
                              "lz4, bz2 and lzma are read: write the array again by one of them",
                              hl_text_printable(shown, name != NULL ? name : "?"));
}

hl_status hl_zarr_compressor_2(const hl_zarr_reading *r, const json_t *compressor) {
  const char *name = json_string_value(json_object_get(compressor, "id"));
  if (compressor == NULL || json_is_null(compressor)) return HL_OK;
  return find_compressor(name, &r->array->codecs.compressor) ? HL_OK : fail_codec(r, name);
}

/* ---- filters of version 2 ---- */

static hl_status fail_filter(const hl_zarr_reading *r, const char *name) {
  char shown[HL_PRINTABLE_BYTES];
  return hl_zarr_reading_fail(
      r, HL_ERROR_UNSUPPORTED,
      "the filter \"%s\" is not read: shuffle, delta, fixedscaleoffset, quantize and bitround "
      "are: write the array again without it",
      hl_text_printable(shown, name != NULL ? name : "?"));
}

/* Finds the type that a filter states for `key`, or `other` if the filter states no type. The type must be
 * little-endian or have a single byte. */
static bool filter_type(const json_t *filter, const char *key, hl_voxel_type other, hl_voxel_type *type) {
  hl_zarr_array array = {.rank = 0};
  hl_error unused = {0};
  const hl_zarr_reading reading = {.array = &array, .error = &unused};
  const json_t *name = json_object_get(filter, key);
  *type = other;
  if (name == NULL || json_is_null(name)) return true;
  if (hl_zarr_type_2(&reading, json_string_value(name)) != HL_OK || array.codecs.big_endian) return false;
  *type = array.type;
  return true;
}

hl_status hl_zarr_filters_2(const hl_zarr_reading *r, const json_t *list) {
  hl_zarr_codecs *codecs = &r->array->codecs;
  for (size_t n = 0; n < json_array_size(list); n++) {
    const json_t *entry = json_array_get(list, n);
    const char *name = json_string_value(json_object_get(entry, "id"));
    hl_zarr_filter filter = {.scale = 1};
    hl_voxel_type own = r->array->type;
    if (name != NULL && hl_text_is_one_of(name, "quantize|bitround")) {
      if (!filter_type(entry, "astype", own, &filter.to) || filter.to != own) return fail_filter(r, name);
      continue; /* this filter rounded values before they were stored, which cannot and need not be undone */
    }
    if (name == NULL || codecs->filter_count == HL_ZARR_FILTERS_MOST || codecs->big_endian)
      return fail_filter(r, name);
    if (strcmp(name, "shuffle") == 0) {
      json_int_t size = json_integer_value(json_object_get(entry, "elementsize"));
      filter.kind = HL_ZARR_SHUFFLE;
      filter.element = size >= 1 && size <= 64 ? (size_t)size : 4;
    } else if (strcmp(name, "delta") == 0 || strcmp(name, "fixedscaleoffset") == 0) {
      bool delta = strcmp(name, "delta") == 0;
      filter.kind = delta ? HL_ZARR_DELTA : HL_ZARR_OFFSET;
      bool sound = filter_type(entry, "dtype", own, &filter.to) &&
                   filter_type(entry, "astype", filter.to, &filter.from);
      filter.scale = delta ? 1 : json_number_value(json_object_get(entry, "scale"));
      filter.offset = json_number_value(json_object_get(entry, "offset"));
      if (!sound || filter.to != own || filter.scale == 0 || !isfinite(filter.scale) ||
          !isfinite(filter.offset))
        return fail_filter(r, name);
    } else {
      return fail_filter(r, name);
    }
    codecs->filters[codecs->filter_count++] = filter;
  }
  return HL_OK;
}

/* Reads the codec "transpose". Its "order" is a permutation: stored axis n is axis order[n] of the array. */
static hl_status take_transpose(const hl_zarr_reading *r, const json_t *configuration,
                                hl_zarr_codecs *codecs) {
  const json_t *order = json_object_get(configuration, "order");
  int rank = r->array->rank;
  unsigned seen = 0;
  for (int n = 0; n < rank && json_array_size(order) == (size_t)rank; n++) {
    const json_t *axis = json_array_get(order, (size_t)n);
    json_int_t value = json_is_integer(axis) ? json_integer_value(axis) : -1;
    if (value < 0 || value >= rank) break;
    codecs->order[n] = (int)value;
    seen |= 1u << value;
  }
  if (seen == (1u << rank) - 1) return HL_OK;
  return hl_zarr_reading_fail(r, HL_ERROR_INPUT, "the codec \"transpose\" needs an \"order\" of all axes");
}

hl_status hl_zarr_codecs_3(const hl_zarr_reading *r, const json_t *list, hl_zarr_codecs *codecs) {
  bool has_bytes = false, is_turned = false;
  hl_status status = HL_OK;
  for (int n = 0; n < HL_ZARR_AXES_MOST; n++) codecs->order[n] = n;
  for (size_t n = 0; n < json_array_size(list) && status == HL_OK; n++) {
    const json_t *codec = json_array_get(list, n), *configuration = json_object_get(codec, "configuration");
    const char *name = json_string_value(json_object_get(codec, "name"));
    hl_zarr_compressor compressor;
    if (name == NULL) return fail_codec(r, name);
    if (!has_bytes && !is_turned && strcmp(name, "transpose") == 0) {
      status = take_transpose(r, configuration, codecs);
      is_turned = true;
    } else if (!has_bytes && strcmp(name, "bytes") == 0) {
      const char *order = json_string_value(json_object_get(configuration, "endian"));
      codecs->big_endian = order != NULL && strcmp(order, "big") == 0;
      has_bytes = true;
    } else if (has_bytes && strcmp(name, "crc32c") == 0) {
      int *checks = codecs->compressor == HL_ZARR_RAW ? &codecs->inner_checks : &codecs->outer_checks;
      if (++*checks > 1) return fail_codec(r, name);
    } else if (has_bytes && codecs->compressor == HL_ZARR_RAW && find_compressor(name, &compressor)) {
      codecs->compressor = compressor;
    } else return fail_codec(r, name);
  }
  return status == HL_OK && !has_bytes
             ? hl_zarr_reading_fail(r, HL_ERROR_INPUT, "\"codecs\" must hold the codec \"bytes\"")
             : status;
}
