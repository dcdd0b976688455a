/* volume/formats/dicom/directory.c - lists the files that a DICOMDIR names. Names that lead out of the folder
 * of the DICOMDIR are ignored. */
#define _GNU_SOURCE
#include "volume/formats/dicom/directory.h"

#include <limits.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "volume/formats/dicom/header.h"

enum { REFERENCED_FILE = 0x00041500, NAME_BYTES = 512 };

/* Sets *there to whether the bundle's folder has a file of this name. */
static hl_status look_for(const hl_bundle *bundle, const char *name, bool *there, hl_error *error) {
  char *path = hl_path_join(bundle->context, bundle->path, name);
  if (path == NULL) return hl_fail_memory(error, strlen(name), bundle->path);
  *there = hl_file_kind(bundle->context, path) != 0;
  hl_release(bundle->context, path);
  return HL_OK;
}

/* Adds a file to the bundle's entries. The name DICOM\IM0001 becomes DICOM/IM0001, or dicom/im0001 if the
 * disc was copied with names in lower case. */
static hl_status add_file(hl_bundle *bundle, char *name, hl_error *error) {
  for (char *c = name; *c != 0; c++)
    if (*c == '\\') *c = '/';
  bool inside = name[0] != '/' && strstr(name, "..") == NULL, there = false;
  hl_status status = HL_OK;
  if (name[0] == 0) return HL_OK;
  if (inside) status = look_for(bundle, name, &there, error);
  if (status == HL_OK && inside && !there) {
    for (char *c = name; *c != 0; c++)
      if (*c >= 'A' && *c <= 'Z') *c = (char)(*c - 'A' + 'a');
    status = look_for(bundle, name, &there, error);
  }
  if (status != HL_OK) return status;
  bundle->links_passed += !there;
  if (!there) return HL_OK;
  return hl_bundle_add(bundle, (hl_bundle_entry){.name = name}, error);
}

hl_status hl_dicom_directory_read(hl_source **source, hl_bundle *bundle, hl_error *error) {
  hl_dicom_header header = {.syntax = ""};
  hl_dicom_reader reader;
  hl_dicom_element element;
  hl_status status = hl_dicom_begin(source, &header, &reader, error);
  for (bool found = true; status == HL_OK && found;) {
    char name[NAME_BYTES];
    status = hl_dicom_next(&reader, &element, &found, error);
    if (status != HL_OK || !found || element.tag != REFERENCED_FILE) continue;
    status = hl_dicom_text(&reader, &element, name, sizeof name, error);
    if (status == HL_OK) status = add_file(bundle, name, error);
  }
  hl_bundle_sort(bundle);
  return status;
}
