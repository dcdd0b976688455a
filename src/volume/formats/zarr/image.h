/* volume/formats/zarr/image.h - reads OME-Zarr's metadata of an image: axes, units, and the levels of its
 * resolution pyramid.
 *
 * Source: the OME-NGFF specification, versions 0.4 (in `.zattrs`) and 0.5 (in `zarr.json` under "ome"):
 * "multiscales", "axes" and "coordinateTransformations"; images of 0.1 to 0.3 have no transformations. */
#ifndef HL_VOLUME_ZARR_IMAGE_H
#define HL_VOLUME_ZARR_IMAGE_H

#include "volume/formats/zarr/array.h"
#include "volume/io/text.h"

enum { HL_ZARR_LEVELS_MOST = 32 };

/* The meaning of an axis of an array. */
typedef enum hl_zarr_axis {
  HL_ZARR_X = 0,
  HL_ZARR_Y = 1,
  HL_ZARR_Z = 2,
  HL_ZARR_TIME,
  HL_ZARR_CHANNEL,
  HL_ZARR_OTHER
} hl_zarr_axis;

typedef struct hl_zarr_level {
  hl_zarr_array array;
  /* scale and translation along the array's axes, in micrometres if the file states units */
  double scale[HL_ZARR_AXES_MOST], translation[HL_ZARR_AXES_MOST];
} hl_zarr_level;

typedef struct hl_zarr_image {
  hl_context *context;
  hl_zarr_axis axis[HL_ZARR_AXES_MOST]; /* the kinds of axes, the same for the arrays of all levels */
  hl_zarr_level *levels;                /* owned; [level_count]; the levels, the finest level first */
  int level_count;
  bool has_unit; /* whether lengths are micrometres */
  char name[HL_PRINTABLE_BYTES];
} hl_zarr_image;

/* Reads the metadata of an image. ome: the attributes of the group in `folder`, which include "multiscales".
 * The caller must release *image also after a failure. */
hl_status hl_zarr_image_read(const hl_bundle *bundle, const char *folder, const json_t *ome,
                             hl_zarr_image *image, hl_error *error);

/* Describes an array that has no metadata of OME-Zarr. The kind of each axis follows from its name. If the
 * names are not known, the last three axes are z, y, x. */
hl_status hl_zarr_image_of_array(const hl_bundle *bundle, const hl_zarr_array *array, hl_zarr_image *image,
                                 hl_error *error);
void hl_zarr_image_release(hl_zarr_image *image);

#endif
