/* gpu/kernels/mask.h - evaluates a volume's mask at a point: finds the factor of extinction, its slope, and
 * the colour to which the mask moves the matter's colour. The functions compute for one pixel the same
 * numbers as fill/mask_lanes.h and tint_matter() in render/voxel_color_lanes.h for sixteen. */
#ifndef HL_GPU_MASK_H
#define HL_GPU_MASK_H

#include "gpu/kernels/colors.h"

/* A mask on the device. data: its parts, one after the other (plan_mask). */
typedef struct mask_data {
  GLOBAL const plan_mask *plan;
  GLOBAL const byte *data;
} mask_data;

DEVICE GLOBAL const byte *part_of_mask(const mask_data *mask, int part) {
  return mask->data + (wide)mask->plan->begin[part] * 16;
}

/* The cell of the mask's lattice in which a point lies, and the point's place within the cell. Points outside
 * the lattice are moved to its border. */
typedef struct mask_place {
  int cell[3], outside;
  float part[3];
} mask_place;

DEVICE mask_place place_in_mask(const mask_data *mask, vector point) {
  mask_place place;
  place.outside = 0;
  for (int a = 0; a < 3; a++) {
    const float last = (float)mask->plan->last[a];
    float at = row_of_point(mask->plan->to_index[a], point);
    place.outside = place.outside || at < -0.5f || at > last + 0.5f;
    at = limited(at, 0.0f, last);
    place.cell[a] = (int)at;
    place.part[a] = at - (float)place.cell[a];
  }
  return place;
}

/* The number of a lattice's point at a corner of the cell: bits 0, 1 and 2 of `corner` tell whether it lies
 * on the far side along x, y and z. */
DEVICE wide corner_of_mask(const mask_data *mask, const mask_place *place, int corner) {
  GLOBAL const int *last = mask->plan->last;
  wide number = 0;
  for (int a = 2; a >= 0; a--) {
    const int next = place->cell[a] + (corner >> a & 1);
    number = number * (unsigned)(last[a] + 1) + (unsigned)(next > last[a] ? last[a] : next);
  }
  return number;
}

/* The two words of the brick in which a point lies. */
DEVICE GLOBAL const unsigned *brick_of_mask(const mask_data *mask, const mask_place *place) {
  wide number = 0;
  for (int a = 2; a >= 0; a--)
    number = number * (unsigned)((mask->plan->last[a] >> MASK_BRICK_SHIFT) + 1) +
             (unsigned)(place->cell[a] >> MASK_BRICK_SHIFT);
  return (GLOBAL const unsigned *)part_of_mask(mask, MASK_BRICKS) + number * 2;
}

/* The factor of extinction in a place of the lattice, before it is held between 0 and 1. */
DEVICE float factor_in_place(const mask_data *mask, const mask_place *place) {
  const unsigned word = brick_of_mask(mask, place)[0];
  GLOBAL const word16 *factors = (GLOBAL const word16 *)part_of_mask(mask, MASK_FACTORS);
  float steps = (float)(int)(word & 0xffffu), plane[2];
  if ((word & MASK_EVEN) == 0) {
    for (int k = 0; k < 2; k++) {
      float line[2];
      for (int j = 0; j < 2; j++) {
        const int corner = 2 * j + 4 * k, a = factors[corner_of_mask(mask, place, corner)],
                  b = factors[corner_of_mask(mask, place, corner + 1)];
        line[j] = fused((float)(b - a), place->part[0], (float)a);
      }
      plane[k] = fused(line[1] - line[0], place->part[1], line[0]);
    }
    steps = fused(plane[1] - plane[0], place->part[2], plane[0]);
  }
  return fused(steps, mask->plan->scale, mask->plan->offset);
}

/* The factor of extinction at a point of frame space. */
DEVICE float mask_factor(const mask_data *mask, vector point) {
  const mask_place place = place_in_mask(mask, point);
  if (place.outside) return mask->plan->rest;
  return limited(factor_in_place(mask, &place), 0.0f, 1.0f);
}

/* How far a point of frame space lies behind the walls of a mesh of cells, as depth_behind_walls() in
 * fill/mask_lanes.h. */
DEVICE float depth_behind_walls(const mask_data *mask, vector point) {
  const mask_place place = place_in_mask(mask, point);
  return place.outside ? -0.5f : factor_in_place(mask, &place) - 0.5f;
}

/* The factor's slope at a point of frame space, per frame unit. */
DEVICE vector mask_slope(const mask_data *mask, vector point) {
  const mask_place place = place_in_mask(mask, point);
  GLOBAL const byte *slopes = part_of_mask(mask, MASK_SLOPES);
  vector slope = vector_of(0.0f, 0.0f, 0.0f);
  float sum[3] = {0.0f, 0.0f, 0.0f};
  if (place.outside || (brick_of_mask(mask, &place)[0] & MASK_EVEN) != 0) return slope;
  for (int corner = 0; corner < 8; corner++) {
    GLOBAL const byte *own = slopes + corner_of_mask(mask, &place, corner) * 4;
    float share = 1.0f;
    for (int a = 0; a < 3; a++) share = share * (corner >> a & 1 ? place.part[a] : 1.0f - place.part[a]);
    for (int a = 0; a < 3; a++) sum[a] = fused(share, (float)(own[a] < 128 ? own[a] : own[a] - 256), sum[a]);
  }
  for (int a = 0; a < 3; a++)
    slope = add_scaled(slope, vector_at(mask->plan->to_index[a]), sum[a] * mask->plan->slope_scale);
  return slope;
}

/* Matter's colour, moved towards the mask's colour at a position of frame space by the mask's weight. */
DEVICE vector tinted_by_mask(const mask_data *mask, vector position, vector color) {
  const mask_place place = place_in_mask(mask, position);
  GLOBAL const unsigned *brick = brick_of_mask(mask, &place);
  const unsigned code = brick[1];
  float own[3], tint = (float)(int)(code >> 24);
  for (int c = 0; c < 3; c++) own[c] = mask->plan->decode[code >> (8 * c) & 255u];
  if ((brick[0] & MASK_EVEN_COLOR) == 0)
    tint = color_between_voxels(part_of_mask(mask, MASK_COLORS), mask->plan->decode, mask->plan->last,
                                mask->plan->to_index, position, own);
  tint = tint * (1.0f / 255);
  return vector_of(fused(own[0] - color.x, tint, color.x), fused(own[1] - color.y, tint, color.y),
                   fused(own[2] - color.z, tint, color.z));
}

#endif
