/* gpu/kernels/pass_place.h - finds the pixels on which the members of a pass work. */
#ifndef HL_GPU_PASS_PLACE_H
#define HL_GPU_PASS_PLACE_H

#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

/* The index of a pixel in a field, counted from the field's pixel (0, 0). */
DEVICE wide place_in_field(unsigned field, int stride, int x, int y) {
  return (wide)field + (wide)(unsigned)(y * stride + x);
}

/* A pixel of a light's buffer. The members of a tile take its pixels row by row, so that block_any() votes
 * on the sixteen pixels of a row, as the processors do. */
typedef struct light_place {
  int tile, member; /* tile: the tile's number among the tiles of all lights; member: the pixel's number in
                     * the tile, block by block */
  int x, y;
  wide at; /* in a field of level 0 */
} light_place;

DEVICE light_place place_of_member(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                                   int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const int own_tile = number / 256, column = number & 15, row = number >> 4 & 15;
  light_place place;
  place.tile = light->first_tile + own_tile;
  place.member = ((row >> 2) * 4 + (column >> 2)) * 16 + (row & 3) * 4 + (column & 3);
  place.x = own_tile % light->tiles_x * 16 + column;
  place.y = own_tile / light->tiles_x * 16 + row;
  place.at = place_in_field(0u, pass->stride, place.x, place.y);
  return place;
}

/* A pixel's first number in one of the planes of a sheet. plane: the plane's index among the planes of the
 * sheet. */
DEVICE GLOBAL float *pixel_in_plane(GLOBAL const device_sweep *plan, GLOBAL const plan_light *light,
                                    GLOBAL float *planes, int sheet, int plane, int x, int y) {
  return planes + (wide)light->planes * 16 + light->origin + (wide)y * (wide)light->stride + x +
         ((wide)(sheet % plan->ring) * PLANES_OF_SHEET + plane) * (wide)light->plane;
}

#endif
