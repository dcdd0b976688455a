/* volume/format.h - the file formats behind hl_volume_load, one function each.
 *
 * Each reads *stream from its current place, may replace or push on it, and leaves closing to the caller. It
 * lists in *request what arrays there are, and reads the one that is wanted.
 */
#ifndef HL_VOLUME_FORMAT_H
#define HL_VOLUME_FORMAT_H

#include "volume/arrays.h"

hl_status hl_load_nrrd(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);
hl_status hl_load_metaimage(hl_stream **stream, hl_load_request *request, hl_volume **volume,
                            hl_error *error);
hl_status hl_load_nifti(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);
hl_status hl_load_npy(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);
hl_status hl_load_vti(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);
hl_status hl_load_legacy_vtk(hl_stream **stream, hl_load_request *request, hl_volume **volume,
                             hl_error *error);
hl_status hl_load_raw_descriptor(hl_stream **stream, hl_load_request *request, hl_volume **volume,
                                 hl_error *error);
hl_status hl_load_raw(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);

/* Whether a file that starts with these bytes (at least as many as there are up to 1024) is of the format. */
bool hl_is_metaimage(const unsigned char *bytes, size_t length);
bool hl_is_nifti(const unsigned char *bytes, size_t length);
bool hl_is_npy(const unsigned char *bytes, size_t length);
bool hl_is_vti(const unsigned char *bytes, size_t length);
bool hl_is_raw_descriptor(const unsigned char *bytes, size_t length);

/* The size and type, unchecked, that a raw file's name states; false if it states none. */
bool hl_raw_name(const char *path, hl_payload *payload);

/* Pushes a decompressor if the next bytes are gzip's mark. */
hl_status hl_stream_inflate_if_gzip(hl_stream **stream, hl_error *error);

/* What a format calls a voxel type; name may list alternatives, as for hl_text_is_one_of. */
typedef struct hl_named_type {
  const char *name;
  hl_voxel_type type;
} hl_named_type;

/* Finds the type of that name; false if there is none. */
bool hl_find_type(const hl_named_type *types, size_t count, const char *name, hl_voxel_type *type);

/* For text headers: "PATH, line N: ..." */
#define HL_FAIL_LINE(error, code, stream, line, format, ...) \
  hl_fail_at(error, code, line, 0, "%s, line %d: " format, (stream)->path, line, __VA_ARGS__)

#endif
