/* volume/formats/zarr/metadata.c - reads Zarr's JSON files. */
#include "volume/formats/zarr/metadata.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "text/plain.h"
#include "text/plain_json.h"
#include "volume/io/text.h"

hl_status hl_zarr_fail(const hl_bundle *bundle, const char *folder, hl_error *error, hl_status code,
                       const char *format, ...) {
  char text[500], shown[HL_PRINTABLE_BYTES];
  va_list arguments;
  va_start(arguments, format);
  hl_plain_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  hl_text_printable(shown, folder);
  return hl_fail(error, code, "%s%s%s: %s", bundle->path, shown[0] != 0 ? ", " : "", shown, text);
}

/* Returns whether a name cannot lead out of its folder: no part of it is empty or "..". */
static bool stays_inside(const char *name) {
  for (const char *part = name; part != NULL; part = strchr(part, '/')) {
    part += part != name;
    size_t length = strcspn(part, "/");
    if (length == 0 || (length == 2 && part[0] == '.' && part[1] == '.')) return false;
  }
  return true;
}

bool hl_zarr_join(char joined[HL_ZARR_PATH_BYTES], const char *folder, const char *name) {
  size_t folder_length = strlen(folder), length = strlen(name);
  while (length > 0 && name[length - 1] == '/') length--;
  if (folder_length + length + 2 > HL_ZARR_PATH_BYTES) return false;
  memmove(joined, folder, folder_length);
  joined[folder_length] = 0;
  if (length == 0 || (length == 1 && name[0] == '.')) return true;
  memcpy(joined + folder_length, name, length);
  joined[folder_length + length] = 0;
  if (!stays_inside(joined + folder_length)) return false;
  strcpy(joined + folder_length + length, "/");
  return true;
}

/* ---- files of metadata ---- */

enum { METADATA_NAMES = 4, METADATA_PATH_BYTES = HL_ZARR_PATH_BYTES + 32 };

hl_status hl_zarr_metadata_bring(const hl_bundle *bundle, const char (*folders)[HL_ZARR_PATH_BYTES],
                                 size_t count, hl_error *error) {
  static const char *const names[METADATA_NAMES] = {"zarr.json", ".zgroup", ".zarray", ".zattrs"};
  if (!hl_bundle_is_on_server(bundle)) return HL_OK;
  size_t files = count * METADATA_NAMES;
  char(*paths)[METADATA_PATH_BYTES] = hl_allocate(bundle->context, files, sizeof *paths);
  const char **list = hl_allocate(bundle->context, files, sizeof *list);
  hl_status status = paths != NULL && list != NULL ? HL_OK
                                                   : hl_fail_memory(error, files * sizeof *paths, "paths");
  for (size_t n = 0; n < files && status == HL_OK; n++) {
    snprintf(paths[n], sizeof *paths, "%s%s", folders[n / METADATA_NAMES], names[n % METADATA_NAMES]);
    list[n] = paths[n];
  }
  if (status == HL_OK) status = hl_bundle_bring(bundle, list, files, HL_ZARR_METADATA_BYTES_MOST, error);
  hl_release(bundle->context, list);
  hl_release(bundle->context, paths);
  return status;
}

static hl_status read_text(const hl_bundle *bundle, const char *folder, const char *name, char **text,
                           size_t *length, hl_error *error) {
  char path[METADATA_PATH_BYTES], place[1][HL_ZARR_PATH_BYTES];
  hl_source *source = NULL;
  snprintf(path, sizeof path, "%s%s", folder, name);
  snprintf(place[0], sizeof place[0], "%s", folder);
  *text = NULL;
  hl_status status = hl_zarr_metadata_bring(bundle, place, 1, error);
  if (status == HL_OK) status = hl_bundle_find(bundle, path, false, &source, error);
  if (status != HL_OK || source == NULL) return status;
  uint64_t size = hl_source_size(source);
  if (size > HL_ZARR_METADATA_BYTES_MOST) {
    status = hl_zarr_fail(bundle, path, error, HL_ERROR_INPUT, "%llu bytes of metadata, at most %d are read",
                          (unsigned long long)size, HL_ZARR_METADATA_BYTES_MOST);
  } else {
    *text = hl_allocate(bundle->context, (size_t)size, 1);
    status = *text == NULL ? hl_fail_memory(error, (size_t)size, path)
                           : hl_source_read(source, 0, *text, (size_t)size, length, error);
  }
  hl_source_close(source);
  return status;
}

hl_status hl_zarr_metadata_read(const hl_bundle *bundle, const char *folder, const char *name,
                                json_t **object, hl_error *error) {
  char *text;
  size_t length = 0;
  json_error_t fault;
  *object = NULL;
  hl_status status = read_text(bundle, folder, name, &text, &length, error);
  if (status == HL_OK && text != NULL) {
    *object = hl_plain_json_load(text, length, 0, &fault);
    if (*object == NULL && fault.line < 1) /* jansson could not allocate its first buffer */
      status = hl_fail_memory(error, length, folder);
    else if (*object == NULL)
      status = hl_zarr_fail(bundle, folder, error, HL_ERROR_INPUT, "%s, line %d: %s", name, fault.line,
                            fault.text);
    else if (!json_is_object(*object)) {
      json_decref(*object);
      *object = NULL;
      status = hl_zarr_fail(bundle, folder, error, HL_ERROR_INPUT, "%s: must hold a JSON object", name);
    }
  }
  if (text != NULL) hl_release(bundle->context, text);
  return status;
}

hl_status hl_zarr_attributes_read(const hl_bundle *bundle, const char *folder, json_t **attributes,
                                  hl_error *error) {
  json_t *node;
  *attributes = NULL;
  hl_status status = hl_zarr_metadata_read(bundle, folder, "zarr.json", &node, error);
  if (status != HL_OK || node == NULL)
    return status == HL_OK ? hl_zarr_metadata_read(bundle, folder, ".zattrs", attributes, error) : status;
  json_t *inside = json_object_get(node, "attributes");
  if (json_is_object(inside)) *attributes = json_incref(inside);
  json_decref(node);
  return HL_OK;
}

const json_t *hl_zarr_ome(const json_t *attributes) {
  const json_t *ome = json_object_get(attributes, "ome");
  return json_is_object(ome) ? ome : attributes;
}
