/* splat/relevant_lanes.h - which blocks of a tile can hold anything between two sheets: one look at the box
 * around each one's rays, all sixteen at a time. A few slabs in a row at once: they share boxes and what they
 * read of the cells. */
#ifndef HL_SPLAT_RELEVANT_LANES_H
#define HL_SPLAT_RELEVANT_LANES_H

#include "splat/fill.h"
#include "splat/rays_lanes.h"

typedef struct lanes_box {
  lanes low[3], high[3];
} lanes_box; /* index space */

/* Derived: on the sheet at base + P / H, a pixel further is (Pu - (Hu / H) P) / H further along it;
 * from a block's middle to its pixels' centres it is at most 3/2 pixels either way (a little more is allowed
 * for: H changes within the block). */
LANES_INLINE lanes_box box_on_sheet(const sheet_rays *rays, lanes u, lanes v) {
  const float reach = 1.5f * 1.02f;
  lanes3 p = rays_linear(rays->p0, rays->pu, rays->pv, u, v);
  lanes linear[3] = {p.x, p.y, p.z}, inverse = lanes_set(1.0f);
  if (rays->perspective) inverse = 1.0f / rays_climb(rays, u, v);
  lanes_box box;
  for (int a = 0; a < 3; a++) {
    lanes at = rays->perspective ? lanes_fma(linear[a], inverse, lanes_set(rays->base[a])) : linear[a];
    lanes along_u = lanes_fma(linear[a], inverse * -rays->hu, lanes_set(rays->pu[a])) * inverse;
    lanes along_v = lanes_fma(linear[a], inverse * -rays->hv, lanes_set(rays->pv[a])) * inverse;
    lanes length = lanes_abs(along_u) + lanes_abs(along_v);
    box.low[a] = lanes_add_scaled(at, length, -reach);
    box.high[a] = lanes_add_scaled(at, length, reach);
  }
  return box;
}

/* Whether a box that spans no more cells of a level than one look takes in holds something; *wide: the
 * others. */
LANES_INLINE lanes_int box_shows(const cell_level *level, int shift, const lanes_int low[3],
                                 const lanes_int high[3], lanes_int inside, lanes_int *wide) {
  lanes_int first = lanes_set_int(0), bit = first, fits = lanes_set_int(-1);
  for (int a = 2; a >= 0; a--) {
    lanes_int from = low[a] >> shift, beyond = (high[a] >> shift) - from;
    fits &= beyond < CELL_REACH;
    bit = bit * 2 - (beyond == CELL_REACH - 1);
    first = first * level->count[a] + from;
  }
  lanes_int found = lanes_gather_bytes(level->near, first & inside);
  *wide = ~fits;
  return fits & (((found >> (bit & 7)) & 1) != 0);
}

/* The box around a block's part of a slab, from those on its sheets. */
LANES_INLINE lanes_box box_of_slab(const lanes_box *a, const lanes_box *b) {
  lanes_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.low[axis] = lanes_min(a->low[axis], b->low[axis]);
    box.high[axis] = lanes_max(a->high[axis], b->high[axis]);
  }
  return box;
}

/* The blocks whose boxes hold something. */
LANES_INLINE uint32_t showing_blocks(const grid *grid, const lanes_box *box) {
  lanes_int inside = lanes_set_int(-1), first[3], last[3];
  for (int axis = 0; axis < 3; axis++) {
    float count = (float)grid->dimension[axis];
    inside &= (box->high[axis] > -0.5f - GRID_MARGIN) & (box->low[axis] < count - 0.5f + GRID_MARGIN);
    first[axis] = lanes_floor(lanes_clamp(box->low[axis], -1.0f, count * (1 - 1e-6f))) + 1;
    last[axis] = lanes_floor(lanes_clamp(box->high[axis], -1.0f, count * (1 - 1e-6f))) + 1;
  }
  if (lanes_bits(inside) == 0 || grid->level[0].near == NULL) return lanes_bits(inside);
  lanes_int wide, shows = box_shows(&grid->level[0], 1, first, last, inside, &wide);
  if (lanes_bits(wide & inside) == 0) return lanes_bits(shows & inside);
  lanes_int too_wide, shows_far = box_shows(&grid->level[1], 2, first, last, inside, &too_wide);
  /* a block too wide for either may hold something anywhere */
  return lanes_bits(inside & (shows | (wide & (shows_far | too_wide))));
}

/* The blocks whose boxes lie in the run's. */
LANES_INLINE uint32_t whole_blocks(const slab_run *run, const lanes_box *box) {
  lanes_int whole = lanes_set_int(-1);
  for (int axis = 0; axis < 3; axis++)
    whole &= (box->low[axis] >= run->low[axis]) & (box->high[axis] <= run->high[axis]);
  return lanes_bits(whole);
}

static void relevant_blocks_tile(const slab_run *run, int tile_x, int tile_y, uint32_t slabs, uint32_t need,
                                 relevant_blocks *found) {
  lanes u = lanes_load(block_column) * (float)BLOCK + ((float)(tile_x * TILE) + 1.5f);
  lanes v = lanes_load(block_row) * (float)BLOCK + ((float)(tile_y * TILE) + 1.5f);
  lanes_box on_sheet[RUN_SLABS + 1];
  for (int slab = 0; slab < RUN_SLABS; slab++) {
    const sheet_rays *rays = &run->rays[slab];
    if ((slabs >> slab & 1) == 0) continue;
    if (slab == 0 || (slabs >> (slab - 1) & 1) == 0) on_sheet[slab] = box_on_sheet(rays, u, v);
    on_sheet[slab + 1] = box_on_sheet(rays + 1, u, v);
    lanes_box box = box_of_slab(&on_sheet[slab], &on_sheet[slab + 1]);
    uint32_t showing = showing_blocks(run->grid, &box);
    /* where the eye is in the slab, rays begin there */
    int whole = rays[0].step * rays[1].step > 0 && (showing & ~whole_blocks(run, &box)) == 0;
    found->whole = (uint16_t)((found->whole & ~(1u << slab)) | (uint32_t)whole << slab);
    found->blocks[slab] = (uint16_t)(showing & need);
  }
}

#endif
