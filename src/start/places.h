/* start/places.h - answers the viewer's page about places in a scene. The page asks for the voxels of a
 * plane, which it shows as a slice, and for the depth of the surface that a pixel shows. The viewer's server
 * and the page without a server send the same bytes. */
#ifndef HL_START_PLACES_H
#define HL_START_PLACES_H

#include <stdbool.h>

#include <halflight/halflight.h>

enum {
  MOST_SLICE_SIDE = 8192,           /* greatest number of samples in a row, of rows, and of layers of a
                                     * slice */
  MOST_SLICE_SAMPLES = 16 << 20,    /* greatest number of samples of all rows of a slice */
  MOST_LAYERED_SAMPLES = 512 << 20, /* greatest number of samples of all layers of a slice */
  MOST_DEPTH_SIDE = 64              /* greatest side, in pixels, of a picture from which a depth is read */
};

/* The values of a scene's volume from which a slice is cut. */
typedef enum slice_source {
  SLICE_OF_VOXELS = 0, /* the values of the file; for a smoothed volume, the values before smoothing, if the
                        * context keeps them */
  SLICE_OF_MASK = 1,   /* the label map that masks the volume */
  SLICE_OF_PICTURE = 2 /* the values that the picture shows; for a smoothed volume, the smoothed values */
} slice_source;

/* Finds the volume from which a slice is cut. number: the number of the scene's volume. Returns null if the
 * scene has no such volume. */
const hl_volume *sliced_volume(const hl_scene *scene, long long number, slice_source source);

/* Makes the values of a plane, row by row, in the machine's byte order. A value has four bytes if floats hold
 * all values exactly, or if values are interpolated or averaged; otherwise eight. The caller finds the size
 * of a value from the total number of bytes. A value is NaN at a place without a voxel. The bytes are the
 * caller's, from malloc. */
hl_status slice_values(const hl_volume *volume, const hl_reslice_options *plane, unsigned char **bytes,
                       size_t *count, hl_error *error);

/* Writes the depth (hl_layers.depth_first), the opacity and the object of the picture's middle pixel as a
 * JSON text: {"depth": a number or null, "opacity", "object"}. The text is the caller's, from malloc. */
hl_status middle_depth(hl_renderer *renderer, const hl_scene *scene, char **text, hl_error *error);

#endif
