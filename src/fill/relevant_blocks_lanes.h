/* fill/relevant_blocks_lanes.h - finds which blocks of a tile may show something between two sheets. The box
 * around each block's rays is looked up in the table of visible cells, sixteen blocks at a time. Several
 * consecutive slabs are examined together, because neighbouring slabs share the boxes on their common sheet,
 * and mostly read the same cells. */
#ifndef HL_FILL_RELEVANT_BLOCKS_LANES_H
#define HL_FILL_RELEVANT_BLOCKS_LANES_H

#include "core/sheet_constants.h"
#include "fill/fill.h"
#include "simd/gathers.h"
#include "view/rays_lanes.h"

typedef struct lanes_box {
  lanes low[3], high[3];
} lanes_box; /* sixteen boxes, one box in each lane; index space */

/* The box around a block's points on a sheet. Derived: a pixel's point is base + P / H (sheet_rays). P and H
 * are linear functions of the pixel, and change by Pu and Hu from one pixel to the next. So the distance to
 * the next pixel's point is (Pu - (Hu / H) P) / H. The pixels' centres are at most 3/2 pixels from the
 * block's middle in either direction. The box is a little larger than these 3/2 pixels, because H changes
 * within the block. */
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

/* Finds the lanes whose box of cells may show something, with one look-up for each lane. *wide: receives the
 * lanes whose box spans more units of cells than a look-up covers; the result leaves these lanes out. shift:
 * converts cells to units. low, high: the first and the last cells of the boxes. */
LANES_INLINE lanes_int box_visible(const cell_lookup *lookup, int shift, const lanes_int low[3],
                                   const lanes_int high[3], lanes_int inside, lanes_int *wide) {
  lanes_int first = lanes_set_int(0), bit = first, fits = lanes_set_int(-1);
  for (int a = 2; a >= 0; a--) {
    lanes_int from = low[a] >> shift, beyond = (high[a] >> shift) - from;
    fits &= beyond < LOOKUP_REACH;
    bit = bit * 2 - (beyond == LOOKUP_REACH - 1);
    first = first * lookup->count[a] + from;
  }
  lanes_int found = lanes_gather_bytes(lookup->visible, first & inside);
  *wide = ~fits;
  return fits & (((found >> (bit & 7)) & 1) != 0);
}

/* The box around a block's rays in a slab, from the boxes on its two sheets. */
LANES_INLINE lanes_box box_of_slab(const lanes_box *a, const lanes_box *b) {
  lanes_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.low[axis] = lanes_min(a->low[axis], b->low[axis]);
    box.high[axis] = lanes_max(a->high[axis], b->high[axis]);
  }
  return box;
}

/* The blocks whose boxes show something, one bit each. */
LANES_INLINE uint32_t visible_boxes(const grid *grid, const lanes_box *box) {
  lanes_int inside = lanes_set_int(-1), first[3], last[3];
  for (int axis = 0; axis < 3; axis++) {
    float count = (float)grid->dimension[axis];
    inside &= (box->high[axis] > -0.5f - GRID_MARGIN) & (box->low[axis] < count - 0.5f + GRID_MARGIN);
    first[axis] = lanes_floor(lanes_clamp(box->low[axis], -1.0f, count * (1 - 1e-6f))) + 1;
    last[axis] = lanes_floor(lanes_clamp(box->high[axis], -1.0f, count * (1 - 1e-6f))) + 1;
  }
  if (lanes_bits(inside) == 0 || grid->lookup[0].visible == NULL) return lanes_bits(inside);
  lanes_int wide, visible = box_visible(&grid->lookup[0], 1, first, last, inside, &wide);
  if (lanes_bits(wide & inside) == 0) return lanes_bits(visible & inside);
  lanes_int too_wide, visible_coarsely = box_visible(&grid->lookup[1], 2, first, last, inside, &too_wide);
  /* a box that is too wide for both look-ups counts as visible */
  return lanes_bits(inside & (visible | (wide & (visible_coarsely | too_wide))));
}

/* The blocks whose boxes lie within a cut's shape, and the blocks whose boxes lie outside the shape. */
typedef struct sides_of_cut {
  lanes_int within, outside;
} sides_of_cut;

/* Finds on which side of a cut each box lies. A box, given by its middle and half its extent along each axis,
 * is converted to the shape's own space, in which planes, boxes and spheres are simple. beside:
 * slab_run.beside. */
LANES_INLINE sides_of_cut sides_of_boxes(const run_cut *cut, const lanes_box *box, float beside) {
  lanes middle[3], half[3], farthest = lanes_set(0), nearest = lanes_set(0), far = farthest, near = nearest;
  for (int a = 0; a < 3; a++) {
    middle[a] = (box->low[a] + box->high[a]) * 0.5f;
    half[a] = (box->high[a] - box->low[a]) * 0.5f;
  }
  for (int r = 0; r < (cut->shape->type == HL_CUT_PLANE ? 1 : 3); r++) {
    const float *row = cut->rows[r];
    lanes at = row_of_point(row, (lanes3){middle[0], middle[1], middle[2]});
    lanes reach = half[0] * fabsf(row[0]) + half[1] * fabsf(row[1]) + half[2] * fabsf(row[2]) +
                  beside * cut->size[r];
    if (cut->shape->type == HL_CUT_PLANE) return (sides_of_cut){at - reach > 0.0f, at + reach < 0.0f};
    lanes most = lanes_abs(at) + reach, least = lanes_max(lanes_abs(at) - reach, lanes_set(0));
    farthest = lanes_max(farthest, most);
    nearest = lanes_max(nearest, least);
    far = lanes_fma(most, most, far);
    near = lanes_fma(least, least, near);
  }
  if (cut->shape->type == HL_CUT_BOX) return (sides_of_cut){farthest<1.0f, nearest> 1.0f};
  return (sides_of_cut){far<1.0f, near> 1.0f};
}

/* Clears in `visible` the blocks that cuts remove, and in `uncut` the blocks near a cut's face. The loop ends
 * when no block is visible any more. */
LANES_INLINE void apply_cuts(const slab_run *run, const lanes_box *box, uint32_t *visible, uint32_t *uncut) {
  for (int i = 0; i < run->cut_count && *visible != 0; i++) {
    sides_of_cut sides = sides_of_boxes(&run->cuts[i], box, run->beside);
    bool inside = run->cuts[i].shape->keep_inside;
    *visible &= ~lanes_bits(inside ? sides.outside : sides.within);
    *uncut &= lanes_bits(inside ? sides.within : sides.outside);
  }
}

/* The blocks whose boxes lie inside a region in which the volume's box does not cut anything. */
LANES_INLINE uint32_t uncut_blocks(const slab_run *run, const lanes_box *box) {
  lanes_int uncut = lanes_set_int(-1);
  for (int axis = 0; axis < 3; axis++)
    uncut &= (box->low[axis] >= run->low[axis]) & (box->high[axis] <= run->high[axis]);
  return lanes_bits(uncut);
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
    uint32_t visible = visible_boxes(run->grid, &box), whole = uncut_blocks(run, &box);
    apply_cuts(run, &box, &visible, &whole);
    /* if the eye lies in the slab, blocks count as cut, too, because their rays begin within the slab */
    int uncut = rays[0].step * rays[1].step > 0 && (visible & ~whole) == 0;
    found->uncut = (uint16_t)((found->uncut & ~(1u << slab)) | (uint32_t)uncut << slab);
    found->blocks[slab] = (uint16_t)(visible & need);
  }
}

#endif
