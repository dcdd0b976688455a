/* gpu/kernels/paper.h - convolves the buffers of lights by the paper's method (shadow_paper/paper.c). The
 * functions compute for one pixel the same numbers as shadow/blur_lanes.h for sixteen pixels.
 *
 * A convolution takes four kinds of passes. The first pass finds the tiles that have pixels below 1 near
 * them. The second pass finds the tiles that the convolution can change. The third pass convolves along rows,
 * from the planes to planes of its own, which hold ones in all other tiles. The fourth pass convolves along
 * columns. */
#ifndef HL_GPU_PAPER_H
#define HL_GPU_PAPER_H

#include "gpu/kernels/pass_place.h"

#if PAPER

/* The numbers of the tiles of all lights, in three arrays that follow each other: [light tiles]. */
#define TILE_TOUCHED 0 /* 1 for tiles in which some pixel may be below 1 */
#define TILE_BELOW   1 /* the last sheet at which a pixel near the tile was below 1 */
#define TILE_WANTED  2 /* the last sheet at which a convolution changed the tile */

DEVICE GLOBAL int *number_of_tile(GLOBAL const device_sweep *plan, GLOBAL int *touched, int kind, int tile) {
  return touched + kind * plan->light_tiles + tile;
}

/* A tile's index along an axis. reach: the distance, in pixels, of the tile from a given pixel. */
DEVICE int tile_below(int pixel, int reach) { return pixel < reach ? 0 : (pixel - reach) / 16; }
DEVICE int tile_above(int pixel, int reach, int tiles) {
  return (pixel + reach) / 16 < tiles ? (pixel + reach) / 16 : tiles - 1;
}

/* Marks the tiles around a pixel that is below 1. */
DEVICE void find_below(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                       GLOBAL const float *light_state, GLOBAL int *touched, int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const light_place place = place_of_member(plan, pass, number);
  int below = 0;
  for (int c = 0; c < CHANNELS; c++)
    below = below ||
            light_state[((wide)place.tile * PLANES_OF_SHEET + (wide)c) * 256 + (wide)place.member] < 1.0f;
  if (!below) return;
  const int last_x = tile_above(place.x, pass->reach, light->tiles_x),
            last_y = tile_above(place.y, pass->reach, light->tiles / light->tiles_x);
  for (int y = tile_below(place.y, pass->reach); y <= last_y; y++)
    for (int x = tile_below(place.x, pass->reach); x <= last_x; x++)
      *number_of_tile(plan, touched, TILE_BELOW, light->first_tile + y * light->tiles_x + x) = pass->sheet;
}

/* Finds whether a convolution can change a tile of the light. */
DEVICE void find_wanted(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass, GLOBAL int *touched,
                        int own_tile) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  if (own_tile >= light->tiles) return;
  const int around = (pass->reach + 15) / 16, tiles_y = light->tiles / light->tiles_x,
            x0 = own_tile % light->tiles_x - around, y0 = own_tile / light->tiles_x - around,
            tile = light->first_tile + own_tile;
  int wanted = *number_of_tile(plan, touched, TILE_TOUCHED, tile);
  if (!wanted && *number_of_tile(plan, touched, TILE_BELOW, tile) == pass->sheet)
    for (int y = y0 < 0 ? 0 : y0; y <= y0 + 2 * around && y < tiles_y; y++)
      for (int x = x0 < 0 ? 0 : x0; x <= x0 + 2 * around && x < light->tiles_x; x++)
        wanted = wanted ||
                 *number_of_tile(plan, touched, TILE_TOUCHED, light->first_tile + y * light->tiles_x + x);
  if (wanted) *number_of_tile(plan, touched, TILE_WANTED, tile) = pass->sheet;
}

/* Convolves along one direction. step: the number of floats from a pixel to the next pixel in this
 * direction. */
DEVICE float convolved(GLOBAL const float *from, int step, plan_blur box) {
  const float ends = from[-(box.reach + 1) * step] + from[(box.reach + 1) * step];
  float sum = fused(ends, box.edge, from[0]);
  for (int i = 1; i <= box.reach; i++) sum = sum + (from[-i * step] + from[i * step]);
  return sum * box.scale;
}

/* A pixel in the planes that hold the light between the two directions of a convolution. */
DEVICE GLOBAL float *pixel_between(GLOBAL const plan_light *light, GLOBAL float *rows, int channel, int x,
                                   int y) {
  return rows + (wide)light->rows * 16 + (wide)channel * (wide)light->plane + light->origin +
         (wide)y * (wide)light->stride + x;
}

DEVICE void convolve_row(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                         GLOBAL const plan_blur *boxes, GLOBAL float *rows, GLOBAL float *planes,
                         GLOBAL int *touched, int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const light_place place = place_of_member(plan, pass, number);
  if (*number_of_tile(plan, touched, TILE_WANTED, place.tile) != pass->sheet) return;
  for (int c = 0; c < CHANNELS; c++)
    *pixel_between(light, rows, c, place.x, place.y) = convolved(
        pixel_in_plane(plan, light, planes, pass->sheet, pass->channel + c, place.x, place.y), 1,
        boxes[pass->boxes]);
}

DEVICE void convolve_column(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                            GLOBAL const plan_blur *boxes, GLOBAL float *rows, GLOBAL float *planes,
                            GLOBAL float *light_state, GLOBAL int *touched, GLOBAL int *changed, int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const light_place place = place_of_member(plan, pass, number);
  if (*number_of_tile(plan, touched, TILE_WANTED, place.tile) != pass->sheet) return;
  for (int c = 0; c < CHANNELS; c++) {
    const float found = convolved(pixel_between(light, rows, c, place.x, place.y), light->stride,
                                  boxes[pass->boxes]);
    *pixel_in_plane(plan, light, planes, pass->sheet, pass->channel + c, place.x, place.y) = found;
    light_state[((wide)place.tile * PLANES_OF_SHEET + (wide)(pass->channel + c)) * 256 + (wide)place.member] =
        found;
  }
  changed[(wide)place.tile * 256 + (wide)place.member] = pass->sheet;
  *number_of_tile(plan, touched, TILE_TOUCHED, place.tile) = 1;
}

#endif

#endif
