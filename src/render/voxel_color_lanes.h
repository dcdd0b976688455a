/* render/voxel_color_lanes.h - finds the colours of a volume's own voxels, and of its mask, at sixteen
 * samples. */
#ifndef HL_RENDER_VOXEL_COLOR_LANES_H
#define HL_RENDER_VOXEL_COLOR_LANES_H

#include "fill/mask_lanes.h"
#include "render/slab.h"
#include "simd/gathers.h"
#include "view/rays_lanes.h"

/* Sums of colours and weights over the corners of the cells around sixteen positions. */
typedef struct color_sums {
  lanes color[3], weight;
} color_sums;

/* Adds the colour of one of the eight voxels around a position. offset: bytes from the first voxel of the
 * volume to this voxel. share: the trilinear weight of this voxel. */
LANES_INLINE void add_corner(const voxel_colors *colors, lanes_int offset, lanes share, color_sums *sums) {
  lanes_int packed = lanes_gather_bytes(colors->voxels, offset);
  lanes weight = share * lanes_from_int((packed >> 24) & 255);
  sums->weight = sums->weight + weight;
  for (int c = 0; c < 3; c++) {
    lanes linear = lanes_gather(colors->decode, (packed >> (8 * c)) & 255);
    sums->color[c] = lanes_fma(weight, linear, sums->color[c]);
  }
}

/* The mean of the eight voxels' linear colours, each weighted trilinearly and by its own weight (colors.h).
 * This is the interpolated colour times opacity, divided by the interpolated opacity (Porter and Duff,
 * "Compositing digital images", 1984). Beyond the outermost voxels, the colours of these voxels continue.
 * Returns the mean weight, 0 to 255; if it is 0, the colour is black. */
LANES_INLINE lanes voxel_color_at(const voxel_colors *colors, const float to_index[3][4], lanes3 position,
                                  lanes color[3]) {
  lanes_int near[3], far[3]; /* bytes along each axis */
  lanes part[3];
  color_sums sums = {{lanes_set(0), lanes_set(0), lanes_set(0)}, lanes_set(0)};
  for (int a = 0; a < 3; a++) {
    lanes at = lanes_clamp(row_of_point(to_index[a], position), 0, (float)colors->last[a]);
    lanes_int first = lanes_truncate(at), next = first + 1, last = lanes_set_int(colors->last[a]);
    part[a] = at - lanes_from_int(first);
    near[a] = first * colors->step_bytes[a];
    far[a] = lanes_select_int(next > last, last, next) * colors->step_bytes[a];
  }
  for (int corner = 0; corner < 8; corner++) {
    lanes_int offset = lanes_set_int(0);
    lanes share = lanes_set(1.0f);
    for (int a = 0; a < 3; a++) {
      int is_far = corner >> a & 1;
      offset += is_far ? far[a] : near[a];
      share = share * (is_far ? part[a] : 1.0f - part[a]);
    }
    add_corner(colors, offset, share, &sums);
  }
  lanes weight = lanes_max(sums.weight, lanes_set(1e-6f));
  for (int c = 0; c < 3; c++) color[c] = sums.color[c] / weight;
  return sums.weight;
}

/* Mixes matter's colours with a mask's colours, by the mask's weights. position: frame space. If a brick of
 * the mask has a single colour, all positions in the brick have this colour. The result is set in the active
 * lanes. */
LANES_INLINE void tint_matter(const voxel_colors *tints, const mask_lattice *mask, lanes3 position,
                              uint32_t active, lanes color[3]) {
  mask_places p = places_in_mask(mask, position);
  lanes_int bricks = bricks_of_places(mask, &p),
            even = (words_of_bricks(mask, bricks, 0) & HL_MASK_EVEN_COLOR) != 0,
            code = words_of_bricks(mask, bricks, 1);
  lanes own[3], tint = lanes_from_int((code >> 24) & 255);
  uint32_t uneven = lanes_bits(even == 0) & active;
  if (uneven == 0 && (lanes_bits(tint > 0.0f) & active) == 0) return;
  for (int c = 0; c < 3; c++) own[c] = lanes_gather(tints->decode, (code >> (8 * c)) & 255);
  if (uneven != 0) {
    lanes between[3], weight = voxel_color_at(tints, mask->to_index, position, between);
    tint = lanes_select(even, tint, weight);
    for (int c = 0; c < 3; c++) own[c] = lanes_select(even, own[c], between[c]);
  }
  for (int c = 0; c < 3; c++) color[c] = lanes_fma(own[c] - color[c], tint * (1.0f / 255), color[c]);
}

#endif
