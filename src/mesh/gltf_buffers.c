/* mesh/gltf_buffers.c - see gltf.h. */
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "mesh/gltf.h"

/* glTF 2.0, section 3.6.2.2: the types of an accessor's numbers. */
enum { TYPE_I8 = 5120, TYPE_U8, TYPE_I16, TYPE_U16, TYPE_U32 = 5125, TYPE_F32 };

static hl_status refuse(const gltf_file *file, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: %s", file->path, what);
}

bool hl_gltf_index(const json_t *object, const char *key, size_t *index) {
  const json_t *value = json_object_get(object, key);
  if (!json_is_integer(value) || json_integer_value(value) < 0) return false;
  *index = (size_t)json_integer_value(value);
  return true;
}

/* ---- buffers ---- */

static int base64_value(char c) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const char *at = c != 0 ? strchr(digits, c) : NULL;
  return at != NULL ? (int)(at - digits) : -1;
}

static hl_status decode_base64(const gltf_file *file, const char *text, gltf_buffer *buffer,
                               hl_error *error) {
  size_t length = strlen(text), count = 0;
  unsigned char *bytes = hl_allocate(file->context, length / 4 * 3 + 3, 1);
  if (bytes == NULL) return hl_fail_memory(error, length, "a buffer");
  *buffer = (gltf_buffer){bytes, 0, true};
  uint32_t bits = 0;
  for (size_t n = 0; n < length && text[n] != '='; n++) {
    int value = base64_value(text[n]);
    if (value < 0) return refuse(file, "a buffer's base64 text has another character", error);
    bits = bits << 6 | (uint32_t)value;
    if (n % 4 != 0) bytes[count++] = (unsigned char)(bits >> (6 - 2 * (n % 4)));
  }
  buffer->length = count;
  return HL_OK;
}

hl_status hl_gltf_read_beside(const gltf_file *file, const char *name, gltf_buffer *buffer, hl_error *error) {
  char path[2000];
  const char *slash = strrchr(file->path, '/');
  size_t folder = slash != NULL ? (size_t)(slash + 1 - file->path) : 0;
  if (name[0] == 0 || name[0] == '/' || strstr(name, "..") != NULL || strstr(name, "://") != NULL ||
      folder + strlen(name) >= sizeof path)
    return refuse(file, "a buffer's uri is no file beside it: save it as .glb", error);
  memcpy(path, file->path, folder);
  strcpy(path + folder, name);
  unsigned char *bytes = NULL;
  hl_status status = hl_file_read(file->context, path, SIZE_MAX - 1, &bytes, &buffer->length, error);
  if (status != HL_OK) return status;
  buffer->bytes = bytes;
  buffer->owned = true;
  return HL_OK;
}

static int hex_value(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/* Decodes the name that a URI stands for: "%20" is a space (RFC 3986, section 2.1). name: has room for the
 * number of bytes of the URI. */
static void decode_uri(const char *uri, char *name) {
  for (; *uri != 0; uri++) {
    int high = *uri == '%' ? hex_value(uri[1]) : -1, low = high >= 0 ? hex_value(uri[2]) : -1;
    bool coded = low >= 0 && (high > 0 || low > 0); /* a byte that is coded as %00 is not decoded */
    *name++ = coded ? (char)(16 * high + low) : *uri;
    if (coded) uri += 2;
  }
  *name = 0;
}

/* Reads the file that a URI names. If there is no file with the decoded name, the URI's text itself is tried
 * as the name. */
static hl_status read_uri(const gltf_file *file, const char *uri, gltf_buffer *buffer, hl_error *error) {
  char *name = hl_allocate(file->context, strlen(uri) + 1, 1);
  if (name == NULL) return hl_fail_memory(error, strlen(uri), "a uri");
  decode_uri(uri, name);
  hl_status status = hl_gltf_read_beside(file, name, buffer, error);
  hl_error ignored;
  if (status == HL_ERROR_IO && strcmp(name, uri) != 0 &&
      hl_gltf_read_beside(file, uri, buffer, &ignored) == HL_OK)
    status = HL_OK;
  hl_release(file->context, name);
  return status;
}

static hl_status read_buffer(gltf_file *file, const json_t *described, gltf_buffer *buffer, hl_error *error) {
  static const char data[] = "data:";
  const char *uri = json_string_value(json_object_get(described, "uri"));
  if (uri == NULL) {
    *buffer = file->chunk;
    return HL_OK;
  }
  const char *comma = strchr(uri, ',');
  if (strncmp(uri, data, sizeof data - 1) != 0) return read_uri(file, uri, buffer, error);
  if (comma == NULL) return refuse(file, "a buffer's data have no comma", error);
  return decode_base64(file, comma + 1, buffer, error);
}

hl_status hl_gltf_read_buffers(gltf_file *file, hl_error *error) {
  enum { MOST_BUFFERS = 1000 };
  const json_t *list = json_object_get(file->root, "buffers");
  size_t count = json_array_size(list);
  if (count > MOST_BUFFERS) return refuse(file, "has more than 1000 buffers", error);
  file->buffers = hl_allocate_zeroed(file->context, count, sizeof *file->buffers);
  if (file->buffers == NULL) return hl_fail_memory(error, count * sizeof *file->buffers, "buffers");
  file->buffer_count = count;
  hl_status status = HL_OK;
  for (size_t n = 0; n < count && status == HL_OK; n++)
    status = read_buffer(file, json_array_get(list, n), &file->buffers[n], error);
  return status;
}

void hl_gltf_release_buffers(gltf_file *file) {
  for (size_t n = 0; n < file->buffer_count; n++)
    if (file->buffers[n].owned) hl_release(file->context, (void *)file->buffers[n].bytes);
  hl_release(file->context, file->buffers);
  for (size_t n = 0; n < file->kept_count; n++) hl_release(file->context, file->kept[n]);
  hl_release(file->context, file->kept);
}

/* ---- accessors ---- */

static size_t bytes_of_type(int type) {
  switch (type) {
    case TYPE_I8:
    case TYPE_U8: return 1;
    case TYPE_I16:
    case TYPE_U16: return 2;
    case TYPE_U32:
    case TYPE_F32: return 4;
    default: return 0;
  }
}

static int components_of(const char *name) {
  static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  for (int n = 0; n < 4; n++)
    if (name != NULL && strcmp(name, names[n]) == 0) return n + 1;
  return 0;
}

/* Finds the bytes of a buffer view, from an offset within the view on. */
static bool find_view(const gltf_file *file, size_t index, size_t offset, gltf_buffer *bytes,
                      size_t *stride) {
  const json_t *view = json_array_get(json_object_get(file->root, "bufferViews"), index);
  size_t buffer, start = 0, length;
  *stride = 0;
  (void)hl_gltf_index(view, "byteOffset", &start);
  (void)hl_gltf_index(view, "byteStride", stride);
  if (!hl_gltf_index(view, "buffer", &buffer) || !hl_gltf_index(view, "byteLength", &length) ||
      buffer >= file->buffer_count || *stride > 65536)
    return false;
  const gltf_buffer *all = &file->buffers[buffer];
  if (start > all->length || length > all->length - start || offset >= length) return false;
  *bytes = (gltf_buffer){all->bytes + start + offset, length - offset, false};
  return true;
}

/* Sets an accessor's bytes and stride from its buffer view. Returns false if the view does not hold all
 * numbers of the accessor. */
static bool place_accessor(const gltf_file *file, const json_t *described, size_t count,
                           gltf_accessor *accessor) {
  size_t view, offset = 0, element = bytes_of_type(accessor->type) * (size_t)accessor->components;
  gltf_buffer bytes;
  (void)hl_gltf_index(described, "byteOffset", &offset);
  if (!hl_gltf_index(described, "bufferView", &view) ||
      !find_view(file, view, offset, &bytes, &accessor->stride))
    return false;
  accessor->bytes = bytes.bytes;
  if (accessor->stride == 0) accessor->stride = element;
  return element > 0 && count > 0 && element <= bytes.length &&
         (bytes.length - element) / accessor->stride >= count - 1;
}

static hl_status fail_accessor(const gltf_file *file, size_t index, size_t count, hl_error *error) {
  return hl_fail(
      error, HL_ERROR_INPUT,
      "%s: accessor %zu leads outside of the file's buffers, has an unknown type, or its buffer is too "
      "short for its %zu elements",
      file->path, index, count);
}

/* Allocates a block of `count` numbers, all 0, which the file keeps until it is released. */
static hl_status keep_numbers(gltf_file *file, size_t count, double **numbers, hl_error *error) {
  double **list = hl_reallocate(file->context, file->kept, file->kept_count + 1, sizeof *list);
  if (list == NULL) return hl_fail_memory(error, sizeof *list, "numbers of an accessor");
  file->kept = list;
  *numbers = hl_allocate_zeroed(file->context, count, sizeof **numbers);
  if (*numbers == NULL) return hl_fail_memory(error, count * sizeof **numbers, "numbers of an accessor");
  list[file->kept_count++] = *numbers;
  return HL_OK;
}

/* Replaces the elements of a sparse accessor that the file lists (glTF 2.0, section 3.6.2.3). */
static hl_status put_sparse(const gltf_file *file, const json_t *sparse, size_t index,
                            gltf_accessor *accessor, double *numbers, hl_error *error) {
  size_t count = 0, type = 0, components = (size_t)accessor->components;
  const json_t *of_indices = json_object_get(sparse, "indices"),
               *of_values = json_object_get(sparse, "values");
  gltf_accessor indices = {.components = 1}, values = *accessor;
  (void)hl_gltf_index(sparse, "count", &count);
  (void)hl_gltf_index(of_indices, "componentType", &type);
  indices.type = type == TYPE_U8 || type == TYPE_U16 || type == TYPE_U32 ? (int)type : 0;
  values.numbers = NULL;
  values.stride = indices.stride = 0;
  if (count > accessor->count || !place_accessor(file, of_indices, count, &indices) ||
      !place_accessor(file, of_values, count, &values))
    return fail_accessor(file, index, accessor->count, error);
  for (size_t n = 0; n < count; n++) {
    size_t at = (size_t)hl_gltf_number(&indices, n, 0);
    if (at >= accessor->count) return fail_accessor(file, index, accessor->count, error);
    for (size_t c = 0; c < components; c++) numbers[at * components + c] = hl_gltf_number(&values, n, (int)c);
  }
  return HL_OK;
}

hl_status hl_gltf_find_accessor(gltf_file *file, size_t index, gltf_accessor *accessor, hl_error *error) {
  const json_t *described = json_array_get(json_object_get(file->root, "accessors"), index);
  const json_t *sparse = json_object_get(described, "sparse");
  size_t type = 0, count = 0, view;
  (void)hl_gltf_index(described, "componentType", &type);
  (void)hl_gltf_index(described, "count", &count);
  *accessor = (gltf_accessor){
      .type = type <= TYPE_F32 ? (int)type : 0,
      .components = components_of(json_string_value(json_object_get(described, "type"))),
      .count = count,
      .normalized = json_is_true(json_object_get(described, "normalized"))};
  bool has_view = hl_gltf_index(described, "bufferView", &view);
  if (has_view || sparse == NULL)
    if (!place_accessor(file, described, count, accessor)) return fail_accessor(file, index, count, error);
  if (sparse == NULL) return HL_OK;
  size_t components = (size_t)accessor->components, numbers_count;
  if (components == 0 || count == 0 || count > UINT32_MAX ||
      __builtin_mul_overflow(count, components, &numbers_count))
    return fail_accessor(file, index, count, error);
  double *numbers = NULL;
  hl_status status = keep_numbers(file, numbers_count, &numbers, error);
  for (size_t n = 0; status == HL_OK && has_view && n < count; n++)
    for (size_t c = 0; c < components; c++) numbers[n * components + c] = hl_gltf_number(accessor, n, (int)c);
  if (status == HL_OK) status = put_sparse(file, sparse, index, accessor, numbers, error);
  accessor->numbers = numbers;
  return status;
}

double hl_gltf_number(const gltf_accessor *accessor, size_t element, int component) {
  if (accessor->numbers != NULL)
    return accessor->numbers[element * (size_t)accessor->components + (size_t)component];
  size_t bytes = bytes_of_type(accessor->type);
  const unsigned char *at = accessor->bytes + element * accessor->stride + (size_t)component * bytes;
  uint32_t bits = 0;
  for (size_t n = bytes; n > 0; n--) bits = bits << 8 | at[n - 1];
  float number;
  switch (accessor->type) {
    case TYPE_I8: return (int8_t)bits;
    case TYPE_I16: return (int16_t)bits;
    case TYPE_F32: memcpy(&number, &bits, sizeof number); return (double)number;
    default: return bits;
  }
}

double hl_gltf_whole(const gltf_accessor *accessor) {
  switch (accessor->type) {
    case TYPE_U8: return 255;
    case TYPE_U16: return 65535;
    default: return 1;
  }
}
