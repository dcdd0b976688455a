/* splat/relevant_lanes.h - which blocks of a tile can hold anything on a sheet: one look at their middles, all sixteen at
 * a time. */
#ifndef HL_SPLAT_RELEVANT_LANES_H
#define HL_SPLAT_RELEVANT_LANES_H

#include "splat/fill.h"
#include "splat/rays_lanes.h"

/* Derived: on the sheet at base + P / H, a pixel further is (Pu - (Hu / H) P) / H further along it;
 * from a block's middle to its pixels' centres it is at most 3/2 pixels either way (a little more is allowed for: H
 * changes within the block). */
static uint32_t relevant_blocks_tile(const fill_source *source, int tile_x, int tile_y) {
  const grid *grid = source->grid;
  const sheet_rays *rays = &source->rays;
  const float reach = 1.5f * 1.02f;
  lanes u = lanes_load(block_column) * (float)BLOCK + ((float)(tile_x * TILE) + 1.5f);
  lanes v = lanes_load(block_row) * (float)BLOCK + ((float)(tile_y * TILE) + 1.5f);
  lanes3 p = rays_linear(rays->p0, rays->pu, rays->pv, u, v);
  lanes linear[3] = {p.x, p.y, p.z}, inverse = lanes_set(1.0f);
  if (rays->perspective) inverse = 1.0f / (u * rays->hu + (v * rays->hv + rays->h0));
  lanes_int inside = lanes_set_int(-1), close = inside, near = inside, cell = lanes_set_int(0);
  for (int a = 2; a >= 0; a--) {
    lanes at = rays->perspective ? linear[a] * inverse + rays->base[a] : linear[a];
    lanes along_u = (rays->pu[a] - linear[a] * (inverse * rays->hu)) * inverse;
    lanes along_v = (rays->pv[a] - linear[a] * (inverse * rays->hv)) * inverse;
    lanes half = (lanes_abs(along_u) + lanes_abs(along_v)) * reach;
    float count = (float)grid->dimension[a];
    inside &= (at + half > -0.5f - GRID_MARGIN) & (at - half < count - 0.5f + GRID_MARGIN);
    close &= half < (float)HL_NEAR_CELLS;
    near &= half < (float)(2 * HL_NEAR_CELLS);
    at = lanes_clamp(at, -1.0f, count * (1 - 1e-6f));
    cell = cell * grid->near_count[a] + ((lanes_floor(at) + 1) >> 1);
  }
  if (lanes_bits(inside) == 0 || grid->near == NULL) return lanes_bits(inside);
  /* a block too wide for either distance may hold something anywhere */
  lanes_int found = lanes_gather_bytes(grid->near, cell & inside);
  lanes_int bit = lanes_select_int(close, lanes_set_int(NEAR_CLOSE), lanes_set_int(NEAR_FAR));
  return lanes_bits(inside & (((found & bit) != 0) | ~near));
}

#endif
