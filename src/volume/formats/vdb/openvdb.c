/* volume/formats/vdb/openvdb.c - reads OpenVDB files (.vdb). The context's `convert` callback lets another
 * program convert the files to NanoVDB. */
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "volume/formats/vdb/nanovdb.h"

static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= 4 && memcmp(bytes, " BDV", 4) == 0;
}

static hl_status fail_unconverted(const char *path, hl_error *error) {
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: an OpenVDB file: convert it by `nanovdb_convert NAME.vdb NAME.nvdb` (libnanovdb-tools)",
                 path);
}

/* Fails because the program that uses the library has set no `convert` callback. */
static hl_status fail_without_callback(const char *path, hl_error *error) {
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: an OpenVDB file: convert it by `halflight convert NAME.vdb NAME.nrrd` or `nanovdb_convert "
      "NAME.vdb NAME.nvdb` (libnanovdb-tools), or set hl_context_options.convert",
      path);
}

/* Lets the callback convert the file, and reads the result under the original file's name. */
static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  const hl_context_options *options = &request->context->options;
  const char *path = (*stream)->path;
  /* a path to the open file through its descriptor. If the context is confined, `path` itself may lead the
   * other program to a different file or to no file */
  char opened[40];
  const void *bytes = NULL;
  size_t byte_count = 0;
  hl_stream *converted = NULL;
  hl_error reason = {0};
  if (options->convert == NULL) return fail_without_callback(path, error);
  if (!hl_stream_is_plain_file(*stream)) return fail_unconverted(path, error);
  snprintf(opened, sizeof opened, "/proc/self/fd/%d", hl_stream_descriptor(*stream));
  hl_status status = options->convert(options->user_data, "OpenVDB",
                                      hl_is_confined(request->context) ? opened : path, &bytes, &byte_count,
                                      &reason);
  if (status == HL_ERROR_UNSUPPORTED) return fail_unconverted(path, error);
  if (status != HL_OK) return hl_fail(error, status, "%s: %.800s", path, reason.message);
  status = hl_stream_open_memory(request->context, path, bytes, byte_count, &converted, error);
  if (status == HL_OK) status = hl_nanovdb_load(&converted, request, volume, error);
  hl_stream_close(converted);
  if (options->converted != NULL) options->converted(options->user_data, bytes, byte_count);
  return status;
}

const hl_format hl_format_openvdb = {.name = "OpenVDB",
                                     .missing = hl_nanovdb_missing,
                                     .endings = {".vdb"},
                                     .beginning = "\" BDV\"",
                                     .has_content = has_content,
                                     .load = load};
