/* volume/formats/dicom/dicom.c - reads DICOM: folders, archives and discs of slices, single files, and series
 * of frames.
 *
 * The steps are in dicom/: elements.c and header.c read a file's header, set.c finds the series among all
 * files, stack.c orders the frames of one series, frame.c decodes a frame, voxels.c makes the volume. */
#define _GNU_SOURCE
#include <string.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "volume/formats/dicom/directory.h"
#include "volume/formats/dicom/voxels.h"
#include "volume/formats/format.h"
#include "volume/io/text.h"

static bool has_content(const unsigned char *bytes, size_t length) {
  return hl_dicom_has_mark(bytes, length);
}

/* Claims files by the extensions of their names, because old DICOM files lack the mark "DICM". */
static hl_status claim_name(hl_stream **stream, bool *claimed, hl_error *error) {
  const unsigned char *bytes;
  size_t length;
  if (!hl_dicom_is_named((*stream)->path)) return HL_OK;
  hl_status status = hl_stream_peek(*stream, HL_FORMAT_SNIFFED_BYTES, &bytes, &length, error);
  *claimed = status == HL_OK && hl_dicom_may_begin(bytes, length);
  return status;
}

static void tell_damage(const hl_dicom_set *set) {
  const char *path = set->bundle->path;
  if (set->damaged + set->remnants > 0)
    hl_log(set->context, HL_LOG_WARNING, "%s: %zu DICOM files cannot be read and are left out; the first: %s",
           path, set->damaged + set->remnants, set->first_damage);
  if (set->bundle->links_passed > 0)
    hl_log(set->context, HL_LOG_WARNING,
           "%s: %zu links or names that lead elsewhere, or to nothing, are left out", path,
           set->bundle->links_passed);
}

/* Makes the list of all series in the input for the request. */
static hl_status list_series(const hl_dicom_set *set, size_t chosen, hl_load_request *request,
                             hl_error *error) {
  size_t count = set->series_count;
  hl_series_entry *list = hl_allocate_zeroed(set->context, count, sizeof *list);
  if (list == NULL) return hl_fail_memory(error, count * sizeof *list, "a list of series");
  for (size_t n = 0; n < count; n++) {
    const hl_dicom_series *series = &set->series[n];
    list[n].number = series->number;
    list[n].dimensions[0] = series->columns;
    list[n].dimensions[1] = series->rows;
    list[n].dimensions[2] = series->frames;
    hl_text_printable(list[n].uid, series->uid);
    hl_text_printable(list[n].modality, series->modality);
    hl_text_printable(list[n].description, series->description);
  }
  request->series_list = list;
  request->series_count = count;
  request->chosen_series = chosen;
  return HL_OK;
}

static hl_status load_series(hl_dicom_set *set, hl_load_request *request, hl_volume **volume,
                             hl_error *error) {
  size_t series;
  hl_dicom_stack stack;
  hl_status status = hl_dicom_series_choose(set, request->series, &series, error);
  if (status == HL_OK) status = list_series(set, series, request, error);
  if (status != HL_OK) return status;
  status = hl_dicom_stack_make(set, series, &stack, error);
  if (status == HL_OK) status = hl_dicom_voxels_read(set, &stack, request, volume, error);
  hl_dicom_stack_release(&stack);
  return status;
}

/* Loads a volume from the files of a bundle. strict: whether the bundle is a single file, in which any error
 * is reported. */
static hl_status load_files(hl_bundle *bundle, bool strict, hl_load_request *request, bool *claimed,
                            hl_volume **volume, hl_error *error) {
  hl_dicom_set set;
  hl_status status = hl_dicom_set_read(request->context, bundle, strict, &set, error);
  *claimed = status != HL_OK || set.file_count > 0;
  if (status == HL_OK && set.file_count > 0) {
    tell_damage(&set);
    status = load_series(&set, request, volume, error);
  } else if (status == HL_OK && set.damaged > 0) {
    *claimed = true;
    status = hl_fail(error, HL_ERROR_INPUT, "%s: none of its %zu DICOM files can be read; the first: %s",
                     bundle->path, set.damaged, set.first_damage);
  }
  hl_dicom_set_release(&set);
  return status;
}

static hl_status load_bundle(hl_bundle *bundle, hl_load_request *request, bool *claimed, hl_volume **volume,
                             hl_error *error) {
  hl_status status = hl_bundle_list(bundle, error);
  return status == HL_OK ? load_files(bundle, false, request, claimed, volume, error) : status;
}

/* Loads a file without pixels of its own, which may be a DICOMDIR. */
static hl_status load_directory(hl_bundle *one, hl_load_request *request, hl_volume **volume,
                                hl_error *error) {
  hl_bundle listed = {.context = request->context};
  hl_source *source = NULL;
  bool claimed;
  hl_status status = hl_bundle_entry_open(one, &one->entries[0], true, &source, error);
  if (status == HL_OK) {
    listed.path = hl_path_folder(request->context, one->path);
    if (listed.path == NULL) status = hl_fail_memory(error, strlen(one->path), one->path);
  }
  if (status == HL_OK) status = hl_dicom_directory_read(&source, &listed, error);
  if (status == HL_OK && (listed.count > 0 || listed.links_passed > 0)) {
    if (listed.path[0] == 0) { /* the file lies in the current folder */
      hl_release(request->context, listed.path);
      listed.path = hl_copy_text(request->context, ".");
    }
    status = listed.path == NULL ? hl_fail_memory(error, 2, one->path)
                                 : load_files(&listed, false, request, &claimed, volume, error);
    if (status == HL_OK && *volume == NULL)
      status = hl_fail(error, HL_ERROR_INPUT,
                       "%s: none of the files that it lists is a picture that is there", one->path);
  } else if (status == HL_OK) {
    status = hl_fail(error, HL_ERROR_INPUT, "%s: a DICOM file without a picture in it", one->path);
  }
  hl_source_close(source);
  hl_bundle_close(&listed);
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_context *context = request->context;
  unsigned char *whole = NULL;
  hl_bundle one = {.context = context};
  hl_status status = hl_bundle_of_file(context, (*stream)->path, &one, error);
  if (status == HL_OK && !hl_stream_is_plain_file(*stream)) {
    status = hl_stream_read_rest(*stream, &whole, &one.memory_size, error);
    one.memory = whole;
  }
  bool claimed = false;
  if (status == HL_OK) status = load_files(&one, true, request, &claimed, volume, error);
  if (status == HL_OK && !claimed) status = load_directory(&one, request, volume, error);
  hl_bundle_close(&one);
  hl_release(context, whole);
  return status;
}

const hl_format hl_format_dicom = {
    .name = "DICOM",
    .endings = {".dcm", ".dicom", ".ima"},
    .beginning = "128 bytes and \"DICM\"",
    .has_content = has_content,
    .claim_name = claim_name,
    .load = load,
    .load_bundle = load_bundle,
};
