/* fill/splat_lanes.h - splatting: adds the cross-section of each voxel's kernel with the sheet to a tile
 * (steps 8 to 11 of the paper).
 *
 * The kernel is evaluated at each pixel's point on the sheet, and not looked up in a table of footprints. So
 * splatting is exact for any orientation, perspective and spacing of sheets. */
#ifndef HL_FILL_SPLAT_LANES_H
#define HL_FILL_SPLAT_LANES_H

#include "fill/gather_lanes.h"
#include "simd/gathers.h"

/* A tile's points in index space, and the bounds of each block's points (lane = block). Weights along x of u8
 * and u16 voxels are rounded as gathering rounds them (row_lanes.h). */
typedef struct tile_points {
  block_points block[TILE_BLOCKS];
  lanes along_x[TILE_BLOCKS][4];
  lanes3 low, high;
} tile_points;

/* Clears the member `inside` of points that lie outside relevant bricks, because the lists of voxels leave
 * out the voxels of other bricks. */
LANES_INLINE void keep_relevant(const grid *grid, block_points *points) {
  if (lanes_bits(points->inside) == 0) return;
  lanes_int brick = (points->cell[2] + 1) >> 2;
  brick = brick * grid->brick_count[1] + ((points->cell[1] + 1) >> 2);
  brick = brick * grid->brick_count[0] + ((points->cell[0] + 1) >> 2);
  points->inside &= (lanes_gather_bytes(grid->relevant, brick & points->inside) & 255) != 0;
}

LANES_INLINE void weigh_along_x(const kernel *kernel, const block_points *points, lanes along_x[4]) {
  tap_weights(kernel, kernel->degree, points->position.x - lanes_from_int(points->cell[0]), along_x);
  round_to_weights(along_x);
}

static void find_tile_points(const fill_source *source, int tile_x, int tile_y, tile_points *tile) {
  for (int block = 0; block < TILE_BLOCKS; block++) {
    tile->block[block] = find_points(source, tile_x * TILE + block % 4 * BLOCK,
                                     tile_y * TILE + block / 4 * BLOCK);
    if (has_integer_weights(source->grid->storage))
      weigh_along_x(source->kernel, &tile->block[block], tile->along_x[block]);
    keep_relevant(source->grid, &tile->block[block]);
    const lanes3 *p = &tile->block[block].position;
    tile->low.x[block] = lanes_least(p->x);
    tile->low.y[block] = lanes_least(p->y);
    tile->low.z[block] = lanes_least(p->z);
    tile->high.x[block] = lanes_greatest(p->x);
    tile->high.y[block] = lanes_greatest(p->y);
    tile->high.z[block] = lanes_greatest(p->z);
  }
}

/* Finds the blocks of a tile that have points within the distance `reach`, along each axis, of a voxel at (x,
 * y, z); one bit each. */
LANES_INLINE uint32_t blocks_in_reach(const tile_points *tile, float x, float y, float z, float reach) {
  lanes_int mask = (tile->low.x < x + reach) & (tile->high.x > x - reach) & (tile->low.y < y + reach) &
                   (tile->high.y > y - reach) & (tile->low.z < z + reach) & (tile->high.z > z - reach);
  return lanes_bits(mask);
}

/* The weights along x that voxels with the coordinate x have at a block's pixels. */
LANES_INLINE lanes weight_along_x(const fill_source *source, const tile_points *tile, int block, int degree,
                                  int32_t x) {
  const block_points *points = &tile->block[block];
  if (!has_integer_weights(source->grid->storage))
    return kernel_at(source->kernel, degree, points->position.x - (float)x);
  lanes weight = lanes_set(0);
  for (int tap = 0; tap < 4; tap++)
    weight = lanes_select(points->cell[0] == x + 1 - tap, tile->along_x[block][tap], weight);
  return weight;
}

LANES_INLINE void splat_voxel(const fill_source *source, const tile_points *tile, uint32_t need,
                              uint32_t voxel, int degree, float *density) {
  const grid *grid = source->grid;
  uint32_t padded_x = (uint32_t)grid->dimension[0] + 4, padded_y = (uint32_t)grid->dimension[1] + 4;
  int32_t x = (int32_t)(voxel % padded_x) - 2, y = (int32_t)(voxel / padded_x % padded_y) - 2;
  int32_t z = (int32_t)(voxel / padded_x / padded_y) - 2;
  uint32_t blocks = need & blocks_in_reach(tile, (float)x, (float)y, (float)z, source->kernel->support);
  if (blocks == 0) return;
  float value = hl_stored_value(grid, x, y, z) - grid->empty;
  for (; blocks != 0; blocks &= blocks - 1) {
    int block = __builtin_ctz(blocks);
    const lanes3 *p = &tile->block[block].position;
    lanes weight = weight_along_x(source, tile, block, degree, x) *
                   kernel_at(source->kernel, degree, p->y - (float)y) *
                   kernel_at(source->kernel, degree, p->z - (float)z);
    float *to = density + block * BLOCK_PIXELS;
    lanes_store(to, lanes_add_scaled(lanes_load(to), weight, value));
  }
}

static filled_blocks splat_tile(const fill_source *source, int tile_x, int tile_y, uint32_t need,
                                uint32_t others, float *density) {
  const voxel_lists *lists = source->lists;
  tile_points tile;
  find_tile_points(source, tile_x, tile_y, &tile);
  for (uint32_t left = others; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    block_points *points = &tile.block[block];
    lowest_of_block(points->cell, points->low);
    if (!source->grid->cell_bits_tell || cells_visible(source->grid, points->cell, points->low))
      need |= 1u << block;
  }
  for (uint32_t left = need; left != 0; left &= left - 1)
    lanes_store(density + __builtin_ctz(left) * BLOCK_PIXELS, lanes_set(0));
  const uint32_t *start = lists->start +
                          ((size_t)tile_y * (size_t)lists->tiles_x + (size_t)tile_x) *
                              (size_t)lists->bucket_count +
                          (size_t)source->sheet;
  for (uint32_t at = start[0]; at < start[lists->span]; at++) {
    if (source->kernel->degree == HL_BSPLINE_DEGREE)
      splat_voxel(source, &tile, need, lists->voxel[at], HL_BSPLINE_DEGREE, density);
    else splat_voxel(source, &tile, need, lists->voxel[at], HL_KERNEL_DEGREE, density);
  }
  filled_blocks blocks = {need, 0};
  for (uint32_t left = need; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    float *to = density + block * BLOCK_PIXELS;
    lanes_int inside = tile.block[block].inside;
    lanes kept = lanes_keep(inside, lanes_load(to));
    lanes_store(to, kept);
    if (lanes_bits(inside & may_show(source, kept)) != 0) blocks.showing |= 1u << block;
  }
  return blocks;
}

#endif
