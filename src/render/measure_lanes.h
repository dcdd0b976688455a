/* render/measure_lanes.h - measures depth, normal and object for the layers, for a 4x4 block of pixels at a
 * time. */
#ifndef HL_RENDER_MEASURE_LANES_H
#define HL_RENDER_MEASURE_LANES_H

#include "core/sheet_constants.h"
#include "render/shade_lanes.h"
#include "render/slab_lanes.h"

/* The mean of the volumes' normals in a slab. The weight of a normal is the volume's extinction times the
 * fraction of its matter that counts as a surface. */
LANES_INLINE lanes3 normal_of_block(const block_slab *slab, const block_density *densities, int count) {
  lanes inverse = 1.0f / lanes_max(slab->total, lanes_set(1e-30f));
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there || !d->patch->volume->visible || !d->patch->volume->phong) continue;
    sum = add_scaled3(sum, d->normal, d->extinction * inverse * d->surface);
  }
  return sum;
}

/* The distance of the slab along the eye's rays. */
LANES_INLINE lanes depth_of(const shade_job *job, const block_slab *slab, lanes3 position) {
  lanes3 way = add_scaled3(position, set3(job->eye), lanes_set(-1.0f));
  return -dot3(way, slab->geometry.towards_eye);
}

/* The number of the object that absorbs most of the slab's light. */
LANES_INLINE lanes object_of_block(const block_density *densities, int count) {
  lanes most = lanes_set(0), object = lanes_set(0);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there || !d->patch->volume->visible) continue;
    object = lanes_select(d->extinction > most, lanes_set((float)d->patch->volume->object), object);
    most = lanes_max(most, d->extinction);
  }
  return object;
}

/* Stores the depth at which alpha reaches FIRST_OPACITY, and the object there, in the lanes where this
 * happens in this slab. Derived: let A be the alpha before the slab and e the slab's optical depth. A ray
 * reaches this alpha after the fraction u of e, for which (1 - A) exp(-u e) = 1 - FIRST_OPACITY. */
LANES_INLINE void mark_first(const shade_job *job, const block_slab *slab, block_density *densities,
                             int count, lanes before, lanes after, float *pixels) {
  lanes_int crossed = (before < FIRST_OPACITY) & (after >= FIRST_OPACITY);
  if (lanes_bits(crossed) == 0) return;
  lanes missing = lanes_log2((1.0f - before) * (1.0f / (1.0f - FIRST_OPACITY))) * 0.69314718056f;
  lanes u = lanes_clamp(missing / lanes_max(slab->depth, lanes_set(1e-30f)), 0, 1);
  lanes place = place_of_part(densities, count, slab, u);
  lanes3 position = add_scaled3(slab->geometry.start, slab->geometry.step_sheet, place);
  float *first = pixels + MEASURE_DEPTH_FIRST * BLOCK_PIXELS,
        *object = pixels + MEASURE_OBJECT * BLOCK_PIXELS;
  lanes_store(first, lanes_select(crossed, depth_of(job, slab, position), lanes_load(first)));
  lanes_store(object, lanes_select(crossed, object_of_block(densities, count), lanes_load(object)));
}

static void measure_block(const shade_job *job, const tile_slab *tile, int block, float *pixels) {
  const int patch_count = tile->patch_count;
  block_density *densities = tile->scratch;
  block_slab slab;
  float *alpha = pixels + MEASURE_ALPHA * BLOCK_PIXELS;
  uint32_t bits = visible_in_block(job, tile->patches, patch_count, block, alpha);
  if (bits == 0) return;
  slab_of_block(job, tile, patch_count, block, bits, densities, &slab);
  if (find_slab(job, tile, densities, &slab) == 0) return;
  lanes before = lanes_load(alpha), weight = slab.opacity * (1.0f - before), after = before + weight;
  lanes3 normal = normal_of_block(&slab, densities, patch_count);
  const lanes sums[4] = {depth_of(job, &slab, slab.geometry.position), normal.x, normal.y, normal.z};
  for (int i = 0; i < 4; i++) {
    float *sum = pixels + (MEASURE_DEPTH + i) * BLOCK_PIXELS;
    lanes_store(sum, lanes_load(sum) + lanes_keep(slab.seen, sums[i] * weight));
  }
  lanes_store(alpha, after);
  mark_first(job, &slab, densities, patch_count, before, after, pixels);
}

static uint32_t measure_tile(const shade_job *job, const tile_slab *tile, float *pixels, uint64_t *samples) {
  (void)samples;
  for (uint32_t left = tile->blocks; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    measure_block(job, tile, block, pixels + block * MEASURES * BLOCK_PIXELS);
  }
  return tile->blocks;
}

/* ---- the opacity that the eye sees, without light, to find what is hidden ---- */

/* Returns whether some pixel of the block is not opaque. bits: the pixels in which something may be seen. */
LANES_INLINE int cover_block(const shade_job *job, const tile_slab *tile, int block, uint32_t bits,
                             float *alpha) {
  block_density *densities = tile->scratch;
  block_slab slab;
  slab_of_block(job, tile, tile->patch_count, block, bits, densities, &slab);
  classify_slab(densities, tile->patch_count, &slab);
  if (is_weighed(tile)) {
    place_slab(job, densities, tile->patch_count, &slab);
    weigh_slab(job, densities, tile->patch_count, &slab);
  }
  lanes before = lanes_load(alpha), path = geometry_of_block(job, slab.u, slab.v).path;
  lanes opacity = lanes_keep(slab.seen, 1.0f - lanes_exp_negative(lanes_keep(slab.seen, slab.total * path)));
  lanes after = lanes_fma(opacity, 1.0f - before, before);
  lanes_store(alpha, after);
  return lanes_bits(after < PIXEL_OPAQUE) != 0;
}

static uint32_t cover_tile(const shade_job *job, const tile_slab *tile, float *pixels, uint64_t *samples) {
  uint32_t open = tile->blocks;
  (void)samples;
  for (uint32_t left = tile->blocks; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    float *alpha = pixels + (block * 4 + 3) * BLOCK_PIXELS;
    uint32_t bits = visible_in_block(job, tile->patches, tile->patch_count, block, alpha);
    if (bits != 0 && !cover_block(job, tile, block, bits, alpha)) open &= ~(1u << block);
  }
  return open;
}

#endif
