/* volume/formats/zarr/metadata.h - reads the JSON files of a Zarr hierarchy. */
#ifndef HL_VOLUME_ZARR_METADATA_H
#define HL_VOLUME_ZARR_METADATA_H

#include <jansson.h>

#include "volume/formats/format.h"

enum { HL_ZARR_PATH_BYTES = 512, HL_ZARR_METADATA_BYTES_MOST = 4 << 20 };

/* Fetches the metadata files of the groups or arrays in `count` folders, in one request, if the bundle is a
 * store on a server. The function does nothing if the bundle is a folder or an archive. */
hl_status hl_zarr_metadata_bring(const hl_bundle *bundle, const char (*folders)[HL_ZARR_PATH_BYTES],
                                 size_t count, hl_error *error);

/* Reads the JSON object in the file folder + name. *object is null if the file does not exist; otherwise the
 * caller owns *object (json_decref). */
hl_status hl_zarr_metadata_read(const hl_bundle *bundle, const char *folder, const char *name,
                                json_t **object, hl_error *error);

/* Reads the attributes of the group or array in `folder`, from `zarr.json` or `.zattrs`. *attributes is null
 * if the group or array has no attributes. */
hl_status hl_zarr_attributes_read(const hl_bundle *bundle, const char *folder, json_t **attributes,
                                  hl_error *error);

/* The attributes that belong to OME-Zarr, borrowed. In OME-Zarr 0.5 these attributes are the member "ome"; in
 * version 0.4 all attributes are returned. */
const json_t *hl_zarr_ome(const json_t *attributes);

/* Fails with an error that begins with the path of the bundle and the folder: "PATH/FOLDER...: WHAT". */
__attribute__((format(printf, 5, 6))) hl_status hl_zarr_fail(const hl_bundle *bundle, const char *folder,
                                                             hl_error *error, hl_status code,
                                                             const char *format, ...);

/* Writes folder + name + '/' into `joined`. Returns false if the result is too long, or if the name leads out
 * of the folder ("..", "/"). The names "." and "" stand for the folder itself. */
bool hl_zarr_join(char joined[HL_ZARR_PATH_BYTES], const char *folder, const char *name);

#endif
