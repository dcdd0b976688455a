/* volume/colors.h - voxels with colours of their own: what readers collect, and the volume made of it.
 *
 * A volume keeps, beside the densities that opacity comes from, [k][j][i] colours of 4 bytes: red, green and
 * blue as sRGB's codes, and the weight of the colour between voxels. */
#ifndef HL_VOLUME_COLORS_H
#define HL_VOLUME_COLORS_H

#include "volume/volume.h"

enum { HL_COLOR_BYTES = 4 };

/* Whether components 3 or 4 a voxel, unsigned of 8 or 16 bits, can be colours. */
bool hl_can_be_colors(hl_voxel_type type, size_t components);

/* Whether a component that was chosen stands for all of them: HL_COMPONENT_COLOR, HL_COMPONENT_LUMINANCE. */
bool hl_component_is_colors(int component);

/* Stores one component (0 to 3) of `count` voxels; stored: every `step`-th of these values, u8 or u16;
 * colors: those of the first voxel. 16 bits are rounded to 8. */
void hl_colors_store(hl_voxel_type type, const void *stored, size_t step, size_t count, size_t component,
                     unsigned char *colors);

/* What the readers collected; an alpha that is the same everywhere tells nothing, and the luminance serves.
 */
typedef struct hl_color_source {
  const hl_volume_description *grid; /* of the file: its type is that of a component */
  const char *path;
  size_t components;  /* 3 or 4 */
  int component;      /* HL_COMPONENT_COLOR: opacity from alpha, if there is one; or HL_COMPONENT_LUMINANCE */
  bool premultiplied; /* alpha is multiplied into the colours */
} hl_color_source;

/* Makes the volume, whose component says what opacity comes from. colors: [voxels][HL_COLOR_BYTES], in a
 * block of hl_allocate that the volume takes over, also on failure. */
hl_status hl_volume_adopt_colors(hl_context *context, const hl_color_source *source, unsigned char *colors,
                                 hl_volume **volume, hl_error *error);

/* The linear colour of a voxel, whose coordinates lie in the grid; white where the volume has no colours. */
void hl_volume_color(const hl_volume *volume, size_t i, size_t j, size_t k, double color[3]);

#endif
