/* volume/colors.c - computes the colours of voxels: their codes, their weights, and the densities from which
 * opacity is computed. */
#include "volume/colors.h"

#include <math.h>

#include "core/error.h"
#include "core/memory.h"
#include "elementary/elementary.h"

/* VOXELS_MOST: the greatest number of voxels of a volume with colours; an index of 32 bits then reaches each
 * byte of the colours. */
enum { ALPHA = 3, VOXELS_MOST = 1 << 29 };

bool hl_can_be_colors(hl_voxel_type type, size_t components) {
  return (components == 3 || components == 4) && (type == HL_VOXEL_U8 || type == HL_VOXEL_U16);
}

bool hl_component_is_colors(int component) {
  return component == HL_COMPONENT_COLOR || component == HL_COMPONENT_LUMINANCE;
}

void hl_colors_store(hl_voxel_type type, const void *stored, size_t step, size_t count, size_t component,
                     unsigned char *colors) {
  const uint8_t *narrow = stored;
  const uint16_t *wide = stored;
  for (size_t n = 0; n < count; n++, colors += HL_COLOR_BYTES)
    colors[component] = type == HL_VOXEL_U8 ? narrow[n * step]
                                            : (unsigned char)((wide[n * step] * 255U + 32767U) / 65535U);
}

/* The luma of a colour's three sRGB codes. The weights, in units of 1/256, are the weights of ITU-R BT.709:
 * .2126, .7152 and .0722. */
static unsigned char luminance_of(const unsigned char *color) {
  return (unsigned char)((54U * color[0] + 183U * color[1] + 19U * color[2] + 128U) >> 8);
}

static bool alpha_tells(const unsigned char *colors, size_t count) {
  for (size_t n = 1; n < count; n++)
    if (colors[n * HL_COLOR_BYTES + ALPHA] != colors[ALPHA]) return true;
  return false;
}

static void divide_by_alpha(unsigned char *color) {
  for (int c = 0; c < 3 && color[ALPHA] > 0; c++) {
    unsigned straight = (color[c] * 255U + color[ALPHA] / 2U) / color[ALPHA];
    color[c] = (unsigned char)(straight < 255 ? straight : 255);
  }
}

/* Splits each colour into the density from which opacity is computed, and the colour with a weight. The
 * weight of a colour is its voxel's density, so that the colours of transparent voxels do not tint edges.
 * Each weight is at least 1, so that a mean of weights is never 0. */
static void split(const hl_color_source *source, bool use_alpha, size_t count, unsigned char *colors,
                  unsigned char *densities) {
  for (size_t n = 0; n < count; n++) {
    unsigned char *color = colors + n * HL_COLOR_BYTES;
    if (source->components > ALPHA && source->premultiplied) divide_by_alpha(color);
    densities[n] = use_alpha ? color[ALPHA] : luminance_of(color);
    color[ALPHA] = densities[n] > 0 ? densities[n] : 1;
  }
}

hl_status hl_volume_adopt_colors(hl_context *context, const hl_color_source *source, unsigned char *colors,
                                 hl_volume **volume, hl_error *error) {
  hl_volume_description grid = *source->grid;
  size_t count = grid.dimensions[0] * grid.dimensions[1] * grid.dimensions[2];
  unsigned char *densities = count <= VOXELS_MOST ? hl_allocate(context, count, 1) : NULL;
  *volume = NULL;
  if (densities == NULL) {
    hl_release(context, colors);
    return count > VOXELS_MOST
               ? hl_fail(
                     error, HL_ERROR_UNSUPPORTED,
                     "%s: %zu voxels with colours: at most %d are shown: take one component, or shrink it",
                     source->path, count, (int)VOXELS_MOST)
               : hl_fail_memory(error, count, source->path);
  }
  bool use_alpha = source->components > ALPHA && source->component == HL_COMPONENT_COLOR &&
                   alpha_tells(colors, count);
  split(source, use_alpha, count, colors, densities);
  if (grid.type == HL_VOXEL_U16) grid.value_scale *= 257; /* 257 = 65535 / 255 */
  grid.type = HL_VOXEL_U8;
  hl_status status = hl_volume_adopt(context, &grid, source->path, densities, volume, error);
  if (status != HL_OK) {
    hl_release(context, colors);
    return status;
  }
  (*volume)->colors = colors;
  (*volume)->component = use_alpha ? HL_COMPONENT_COLOR : HL_COMPONENT_LUMINANCE;
  return HL_OK;
}

/* Converts an sRGB code from 0 to 1 to linear light (IEC 61966-2-1). */
static double decode(double code) {
  return code <= 0.04045 ? code / 12.92 : hl_pow((code + 0.055) / 1.055, 2.4);
}

void hl_volume_color(const hl_volume *volume, size_t i, size_t j, size_t k, double color[3]) {
  const size_t *dimension = volume->dimension;
  const unsigned char *at = volume->colors;
  if (at != NULL) at += ((k * dimension[1] + j) * dimension[0] + i) * HL_COLOR_BYTES;
  for (int c = 0; c < 3; c++) color[c] = at != NULL ? decode(at[c] / 255.0) : 1;
}
