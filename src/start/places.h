/* start/places.h - answers to the viewer's page about places: planes of voxels for its slices, and the depth
 * of the place that a pixel shows. The viewer's server and the page without a server send the same bytes. */
#ifndef HL_START_PLACES_H
#define HL_START_PLACES_H

#include <stdbool.h>

#include <halflight/halflight.h>

enum {
  MOST_SLICE_SIDE = 8192,           /* samples of a plane along a row, rows, and layers */
  MOST_SLICE_SAMPLES = 16 << 20,    /* the most samples of all rows of a slice */
  MOST_LAYERED_SAMPLES = 512 << 20, /* the most samples of all layers of a slice */
  MOST_DEPTH_SIDE = 64              /* pixels of a picture whose depth is asked for */
};

/* The volume out of which a plane is cut: a volume of the scene, or the label map that masks this volume;
 * null: the scene has no volume of this number. */
const hl_volume *sliced_volume(const hl_scene *scene, long long number, bool of_mask);

/* The values of a plane, row after row in the machine's byte order. Each value has four bytes where floats
 * hold all values exactly, or where values are interpolated or means; otherwise it has eight bytes. The
 * number of bytes tells which. NaN: no voxel is there. The bytes are the caller's, from malloc. */
hl_status slice_values(const hl_volume *volume, const hl_reslice_options *plane, unsigned char **bytes,
                       size_t *count, hl_error *error);

/* Writes the depth of the place that the picture's middle pixel shows (hl_layers.depth_first), its opacity,
 * and its object: {"depth": a number or null, "opacity", "object"}. The text is the caller's, from malloc. */
hl_status middle_depth(hl_renderer *renderer, const hl_scene *scene, char **text, hl_error *error);

#endif
