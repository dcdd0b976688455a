/* start/places.h - what lies where, as the viewer's page is told it: planes of voxels for its slices, and how
 * deep what a pixel shows lies. The viewer's server and the page without a server send the same bytes. */
#ifndef HL_START_PLACES_H
#define HL_START_PLACES_H

#include <stdbool.h>

#include <halflight/halflight.h>

enum {
  MOST_SLICE_SIDE = 8192,           /* samples of a plane along a row, rows, and layers */
  MOST_SLICE_SAMPLES = 16 << 20,    /* of all its rows */
  MOST_LAYERED_SAMPLES = 512 << 20, /* of all its layers */
  MOST_DEPTH_SIDE = 64              /* pixels of a picture whose depth is asked for */
};

/* What a plane is cut out of: a volume of the scene, or the label map that masks it; null: the scene has none
 * of this number. */
const hl_volume *sliced_volume(const hl_scene *scene, long long number, bool of_mask);

/* The values of a plane, row after row in the machine's byte order: in four bytes each where floats hold all
 * of them exactly, or they are interpolated or means, else in eight. Their number of bytes tells which. NaN:
 * no voxel is there. The bytes are the caller's, from malloc. */
hl_status slice_values(const hl_volume *volume, const hl_reslice_options *plane, unsigned char **bytes,
                       size_t *count, hl_error *error);

/* Tells how deep lies what the picture's middle pixel shows (hl_layers.depth_first), its opacity, and which
 * object it is: {"depth": a number or null, "opacity", "object"}. The text is the caller's, from malloc. */
hl_status middle_depth(hl_renderer *renderer, const hl_scene *scene, char **text, hl_error *error);

#endif
