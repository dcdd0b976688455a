/* render/maximum_lanes.h - finds the greatest value of each volume along each ray (maximum projection), for a
 * 4x4 block of pixels at a time. */
#ifndef HL_RENDER_MAXIMUM_LANES_H
#define HL_RENDER_MAXIMUM_LANES_H

#include "plan/shown_values.h"
#include "render/slab_lanes.h"
#include "simd/gathers.h"

/* The greatest value between low and high that the transfer function shows. All values are coordinates in the
 * volume's table. A result below 0 means that no value is shown. */
LANES_INLINE lanes greatest_shown(const float (*shown)[4], lanes low, lanes high) {
  lanes of_entry[3], of_next[3];
  lanes_gather_row_pairs(&shown[0][0], split_coordinate(high).entry, of_entry, of_next);
  lanes within = lanes_min(high, of_entry[SHOWN_TO]);
  lanes value = lanes_select(high > of_entry[SHOWN_FROM], within, of_entry[SHOWN_BELOW]);
  return lanes_select(value >= low, value, lanes_set(-1.0f));
}

/* The peak of the parabola through the values p, a, b on three successive sheets, if a is the greatest of the
 * three; otherwise a. Derived: with t in sheets, the parabola is a + (b - p) / 2 t + (p + b - 2 a) / 2 t^2.
 * Its peak is a + (b - p)^2 / (8 (2 a - p - b)). */
LANES_INLINE lanes peak_of_three(lanes p, lanes a, lanes b) {
  lanes bend = lanes_fma(a, lanes_set(2.0f), -(p + b)), slope = b - p;
  lanes rise = slope * slope / lanes_max(bend * 8.0f, lanes_set(1e-20f));
  lanes_int peaks = (a >= p) & (a >= b) & (bend > 1e-6f);
  return lanes_clamp(a + lanes_keep(peaks, rise), 0, CLASSIFIER_ENTRIES);
}

/* The part of the way through a slab, at the pixels (u, v) of a block, that lies behind the walls of a mesh
 * of cells. The depth behind the wall is taken to change linearly between the slab's ends. */
static __attribute__((noinline)) covered_span within_walls(const shade_job *job, const mask_lattice *walls,
                                                           lanes u, lanes v, covered_span part) {
  const block_geometry g = geometry_of_block(job, u, v);
  lanes first = depth_behind_walls(walls, add_scaled3(g.position, g.step_sheet, lanes_set(-0.5f))),
        last = depth_behind_walls(walls, add_scaled3(g.position, g.step_sheet, lanes_set(0.5f)));
  lanes_int enters = (first < 0.0f) & (last >= 0.0f), leaves = (first >= 0.0f) & (last < 0.0f),
            without = (first < 0.0f) & (last < 0.0f);
  lanes wall = first / lanes_select(enters | leaves, first - last, lanes_set(1.0f));
  lanes begin = lanes_select(enters, lanes_max(part.begin, wall), part.begin), end = part.begin + part.length;
  end = lanes_select(leaves, lanes_min(end, wall), end);
  return (covered_span){begin, lanes_select(without, lanes_set(0), lanes_max(end - begin, lanes_set(0)))};
}

/* Takes a volume's values in a slab into account, in the pixels of a block in which the volume may be visible
 * (`visible`). In other pixels no value counts, so that no pixel depends on the pixels beside it.
 * Returns the pixels in which the slab shows a value, one bit each. */
LANES_INLINE uint32_t maximum_block(const shade_job *job, const shade_patch *patch, int block, lanes u,
                                    lanes v, lanes path, lanes_int visible, float *values) {
  const shade_volume *volume = patch->volume;
  const mask_lattice *walls = &volume->classifier->mask;
  block_way way = way_of_block(job, patch, block);
  if (walls->factors != NULL) way.part = within_walls(job, walls, u, v, way.part);
  table_coordinate a = coordinate_of_density(volume->classifier, way.first),
                   b = coordinate_of_density(volume->classifier, way.last);
  if (patch->enter != NULL || walls->factors != NULL) cut_way(way.part, &a, &b);
  float *greatest = values + block * BLOCK_PIXELS, *before = greatest + MAXIMUM_BEFORE * TILE_PIXELS;
  float *sheet = greatest + MAXIMUM_SHEET * TILE_PIXELS;
  lanes_int there = visible & (way.part.length > 0.0f) & (path > 0.0f),
            whole = there & (way.part.length > 0.999f);
  lanes_int follows = whole & (lanes_load(sheet) == (float)(job->sheet - 1));
  lanes high = lanes_max(a.x, b.x), low = lanes_min(a.x, b.x);
  high = lanes_max(high, lanes_select(follows, peak_of_three(lanes_load(before), a.x, b.x), high));
  lanes value = lanes_select(there, greatest_shown(volume->shown, low, high), lanes_set(-1.0f));
  lanes_store(greatest, lanes_max(lanes_load(greatest), value));
  lanes_store(before, a.x);
  lanes_store(sheet, lanes_select(whole, lanes_set((float)job->sheet), lanes_set(-1.0f)));
  return lanes_bits(value >= 0.0f);
}

/* In a maximum projection nothing hides anything, so all blocks stay open. */
static uint32_t maximum_tile(const shade_job *job, const tile_slab *tile, float *values, uint64_t *samples) {
  for (uint32_t left = tile->blocks; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    lanes u = block_u(tile->x * TILE + block % 4 * BLOCK), v = block_v(tile->y * TILE + block / 4 * BLOCK);
    lanes path = geometry_of_block(job, u, v).path;
    for (int i = 0; i < tile->patch_count; i++) {
      const shade_patch *patch = &tile->patches[i];
      if ((patch->blocks >> block & 1) == 0 || !patch->volume->visible) continue;
      lanes_int visible = visible_in_patch(patch, block);
      if (lanes_bits(visible) == 0) continue;
      float *of_volume = values + (size_t)patch->volume->rank * MAXIMUM_ROWS * TILE_PIXELS;
      *samples += (uint64_t)__builtin_popcount(
          maximum_block(job, patch, block, u, v, path, visible, of_volume));
    }
  }
  return tile->blocks;
}

#endif
