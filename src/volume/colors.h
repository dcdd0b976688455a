/* volume/colors.h - makes volumes whose voxels have colours of their own, from the data that readers collect.
 *
 * A volume keeps two arrays, [k][j][i]. The first holds the densities from which opacity is computed. The
 * second holds colours of 4 bytes: red, green and blue as sRGB codes, and the colour's weight for
 * interpolation between voxels. */
#ifndef HL_VOLUME_COLORS_H
#define HL_VOLUME_COLORS_H

#include "volume/volume.h"

enum { HL_COLOR_BYTES = 4 };

/* Returns whether voxels of this type and number of components can be colours: 3 or 4 unsigned components of
 * 8 or 16 bits. */
bool hl_can_be_colors(hl_voxel_type type, size_t components);

/* Returns whether a chosen component stands for colours of all components: HL_COMPONENT_COLOR or
 * HL_COMPONENT_LUMINANCE. */
bool hl_component_is_colors(int component);

/* Stores component 0 to 3 of the colours of `count` voxels. stored: values of type u8 or u16; every `step`-th
 * value is taken. colors: points to the first voxel's colour. Values of 16 bits are rounded to 8. */
void hl_colors_store(hl_voxel_type type, const void *stored, size_t step, size_t count, size_t component,
                     unsigned char *colors);

/* The colours that a reader has collected. If alpha is the same for all voxels, opacity is computed from
 * luminance instead. */
typedef struct hl_color_source {
  const hl_volume_description *grid; /* the file's grid; its `type` is the type of one component */
  const char *path;
  size_t components;  /* 3 or 4 */
  int component;      /* the wanted component. HL_COMPONENT_COLOR: opacity is computed from alpha if the file
                       * has alpha. HL_COMPONENT_LUMINANCE: opacity is computed from luminance */
  bool premultiplied; /* whether alpha is multiplied into the colours */
} hl_color_source;

/* Makes a volume of colours. The member `component` of the made volume tells whether opacity is computed from
 * alpha or from luminance. colors: [voxels][HL_COLOR_BYTES], in a block of hl_allocate() that the volume
 * takes over, also on failure. */
hl_status hl_volume_adopt_colors(hl_context *context, const hl_color_source *source, unsigned char *colors,
                                 hl_volume **volume, hl_error *error);

/* The linear RGB colour of voxel (i, j, k); white if the volume has no colours. */
void hl_volume_color(const hl_volume *volume, size_t i, size_t j, size_t k, double color[3]);

#endif
