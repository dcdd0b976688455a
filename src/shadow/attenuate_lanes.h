/* shadow/attenuate_lanes.h - classifies and composites sixteen pixels of a light's view at a time (step 17 of
 * the algorithm). */
#ifndef HL_SHADOW_ATTENUATE_LANES_H
#define HL_SHADOW_ATTENUATE_LANES_H

#include "core/sheet_constants.h"
#include "fill/face_skin_lanes.h"
#include "fill/steepness_lanes.h"
#include "grid/classifier_lanes.h"
#include "shadow/attenuate.h"
#include "view/rays_lanes.h"

/* Finds the lanes whose pixels' rays meet the sheet ahead of the view's origin, or behind the origin by at
 * most the height `reach`. */
LANES_INLINE lanes_int is_ahead(const sheet_rays *rays, lanes climb, float reach) {
  return lanes_add_scaled(climb * rays->step, lanes_abs(climb), reach) > 0.0f;
}

/* The length of the rays' way through one slab: spacing * |W| / |h.W|, where W is a ray's vector and h the
 * sheets' normal. The algorithm's formula is dt = ds / |w.h|, with a unit vector w. The length is 0 for rays
 * that meet the sheet behind the view's origin. */
LANES_INLINE lanes path_through_sheet(const sheet_rays *rays, float path, lanes u, lanes v) {
  if (!rays->perspective) return lanes_set(path);
  lanes3 w = rays_directions(rays, u, v);
  lanes climb = rays_climb(rays, u, v);
  lanes length = lanes_sqrt(dot3(w, w)) / lanes_abs(climb) * path;
  return lanes_keep(is_ahead(rays, climb, 0), length);
}

/* Finds the part of a slab that lies in the volume's box, as a span of heights for each ray of one block.
 * uncut: whether the whole slab lies in the box. */
LANES_INLINE covered_span covered_block(const float *enter, const float *leave, int uncut, int block,
                                        float height, float spacing) {
  if (enter == NULL) return (covered_span){lanes_set(0), lanes_set(1.0f)};
  if (uncut) return covered(lanes_set(-1e30f), lanes_set(1e30f), height, spacing);
  return covered(lanes_load(enter + block * BLOCK_PIXELS), lanes_load(leave + block * BLOCK_PIXELS), height,
                 spacing);
}

/* Finds the blocks of a tile that have a pixel with some light. */
static __attribute__((unused)) uint32_t lit_blocks_tile(const float *const transmittance[HL_CHANNELS],
                                                        int channels, size_t stride) {
  uint32_t lit = 0;
  for (int block = 0; block < TILE_BLOCKS; block++) {
    lanes greatest = lanes_set(0);
    for (int c = 0; c < channels; c++)
      greatest = lanes_max(
          greatest, lanes_load_block(
                        transmittance[c] + (size_t)(block / 4 * BLOCK) * stride + block % 4 * BLOCK, stride));
    lit |= (uint32_t)(lanes_bits(greatest >= DARK) != 0) << block;
  }
  return lit;
}

/* The densities a and b on the slab's two sheets become the densities at the ends of the slab's covered part.
 * Between the sheets, density is linear. */
LANES_INLINE void cut_way(covered_span span, table_coordinate *a, table_coordinate *b) {
  lanes from = a->x, way = b->x - a->x;
  *a = split_coordinate(lanes_fma(way, span.begin, from));
  *b = split_coordinate(lanes_fma(way, lanes_min(span.begin + span.length, lanes_set(1.0f)), from));
}

/* The points on the rays of a block at a fraction of the way through the slab; frame space. Derived: a ray is
 * E + s W. With the sheets' normal h and the distance of sheets ds, moving by one sheet adds W ds / (h.W). */
LANES_INLINE lanes3 position_in_slab(const attenuate_job *job, lanes u, lanes v, lanes fraction) {
  const sheet_rays *rays = &job->rays;
  lanes3 step = set3(job->through), end = rays_positions(rays, u, v);
  if (rays->perspective) step = scale3(rays_directions(rays, u, v), job->spacing / rays_climb(rays, u, v));
  return add_scaled3(end, step, fraction - 1.0f);
}

/* The factor by which the volume's extinction in a block is multiplied. The factor is the product of gradient
 * opacity, the mask's factor and the function of two numbers, at the centre of gravity of the slab's matter.
 * corner: the block's first pixel. */
LANES_INLINE lanes factor_in_block(const attenuate_job *job, const attenuate_volume *volume,
                                   const int corner[2], const way_sums *sums, lanes a, lanes b,
                                   covered_span span) {
  way_means means = means_of_way(a, b, sums);
  lanes centre = lanes_fma(span.length, means.from_a / (means.from_a + means.from_b), span.begin);
  uint32_t active = lanes_bits(sums->extinction * span.length > 0.0f);
  if (active == 0) return lanes_set(0);
  lanes3 point = position_in_slab(job, block_u(corner[0]), block_v(corner[1]), centre);
  return factor_of_matter(&(matter_way){.grid = volume->grid,
                                        .kernel = volume->kernel,
                                        .classifier = volume->classifier,
                                        .to_index = volume->to_index,
                                        .point = point,
                                        .from = a,
                                        .to = b,
                                        .extinction = sums->extinction,
                                        .active = active,
                                        .starts = 1})
      .factor;
}

/* The fractions k and k' of attenuate.h: of the light that a surface has absorbed, the fractions that still
 * light the surface after the slab. k is for light absorbed before the slab, k' for light absorbed within the
 * slab. */
typedef struct kept_light {
  lanes before, within;
} kept_light;

/* Computes min(1, h2 / h1)^OUTWARDS_POWER, the fraction k of attenuate.h within one surface. h1 and h2 are
 * the depths in the surface at the two ends of the way: integrals of extinction from the value at which the
 * surface begins. */
LANES_INLINE lanes power_of_depth(lanes h1, lanes h2) {
  lanes left = lanes_min(lanes_abs(h2) / lanes_max(lanes_abs(h1), lanes_set(1e-30f)), lanes_set(1.0f));
  for (int power = 1; power < OUTWARDS_POWER; power *= 2) left = left * left;
  return left;
}

/* The fraction k of attenuate.h near a face that cuts matter: `kept` to the power 1 - skin. The product of
 * such powers over several slabs does not depend on the thickness of the slabs. */
LANES_INLINE lanes kept_in_skin(lanes kept, lanes skin) {
  return lanes_select(skin > 0.0f, lanes_power_of_part(kept, 1.0f - skin), kept);
}

/* Finds the fractions k and k' of attenuate.h near a face that cuts matter. The slab's matter belongs to the
 * face's surface if the matter is visible where the light leaves the slab. b: the table coordinate of the
 * value where the light leaves the slab. corner: the block's first pixel. */
LANES_INLINE kept_light kept_by_face(const attenuate_volume *volume, kept_light kept, table_coordinate b,
                                     const int corner[2]) {
  lanes skin = skin_of_faces(volume->faces, volume->slab, block_u(corner[0]), block_v(corner[1]));
  /* most blocks lie deeper behind the face than the face's skin reaches */
  if (lanes_bits(skin > 0.0f) == 0) return kept;
  lanes values[3];
  table_values(volume->classifier->sums, b, values);
  skin = lanes_keep(values[0] > 0.0f, skin);
  return (kept_light){kept_in_skin(kept.before, skin), kept_in_skin(kept.within, skin)};
}

/* Finds the fractions k and k' of attenuate.h near an inner corner of a cut. Light that goes through matter
 * to one of the corner's faces counts as having left the surface through which the light came in, once the
 * matter has absorbed nearly all of the light. Such light does not light the corner's other face as light at
 * an outside: k = k' = 0. corner: the block's first pixel. at: the offset of this pixel. */
LANES_INLINE kept_light kept_by_inner_corner(const attenuate_job *job, const attenuate_volume *volume,
                                             kept_light kept, const int corner[2], size_t at) {
  lanes_int dark = lanes_load_block(job->left + at, job->stride) < DARK;
  if (lanes_bits(dark) == 0) return kept;
  lanes_int ends = dark &
                   nears_inner_corner(volume->faces, volume->slab, block_u(corner[0]), block_v(corner[1]));
  return (kept_light){lanes_keep(~ends, kept.before), lanes_keep(~ends, kept.within)};
}

/* Finds the fractions k and k' of attenuate.h in a slab that a face divides. If the matter ends within the
 * slab, or at the slab's end, light leaves the surface, and k = k' = 0. If the matter begins within the slab,
 * no surface lies before the matter, so k would have no effect. But blurs may have spread the shadow of the
 * face's own matter across the face, together with the light that this matter has absorbed. This light still
 * lights the face, so the function does not change k. height: the height of the slab's end. */
LANES_INLINE kept_light kept_in_span(const attenuate_volume *volume, kept_light kept, int block,
                                     float height) {
  if (volume->enter == NULL || volume->uncut) return kept;
  lanes_int goes_on = lanes_load(volume->leave + block * BLOCK_PIXELS) > height;
  return (kept_light){lanes_keep(goes_on, kept.before), lanes_keep(goes_on, kept.within)};
}

/* Finds the fractions k and k' of attenuate.h from the values of one volume. a, b: the table coordinates of
 * the values at the two ends of the part of the slab that is in the box. to: the integrals of extinction up
 * to these two values. path: length of the light's ray through the slab. extinction: the volume's extinction
 * in the slab. at: offset of the block's first pixel. */
LANES_INLINE kept_light kept_by_values(const attenuate_job *job, const attenuate_volume *volume,
                                       table_coordinate a, table_coordinate b, const way_ends *to,
                                       covered_span span, lanes path, lanes extinction, size_t at) {
  const lanes all = lanes_set(1.0f);
  lanes way = path * span.length;
  lanes even = way - lanes_abs(b.x - a.x) * (1.0f / volume->classifier->normal_edge);
  const int some_even = lanes_bits(even > 0.0f) != 0;
  if (some_even)
    even = lanes_exp_negative(lanes_max(even, lanes_set(0)) * (1.0f / (EVEN_VOXELS * volume->voxel)));
  if (!volume->classifier->several_surfaces) {
    const float beginning = volume->classifier->only_beginning;
    lanes left = power_of_depth(to->to_a - beginning, to->to_b - beginning);
    if (some_even) left = left * even;
    return (kept_light){left, left};
  }
  lanes foot_a = lanes_gather(volume->classifier->outside, a.entry),
        foot_b = lanes_gather(volume->classifier->outside, b.entry), deep = b.x - foot_b,
        depth = extinction * path;
  const float *beginnings = &volume->classifier->sums[0][3];
  lanes left = power_of_depth(to->to_a - lanes_gather(beginnings, a.entry * 4),
                              to->to_b - lanes_gather(beginnings, b.entry * 4));
  lanes_int same = foot_a == foot_b, enters = (b.x - a.x) * deep > 0.0f;
  if (some_even) left = left * even;
  kept_light kept = {lanes_keep(same, left), lanes_select(same, left, lanes_keep(enters, all))};
  lanes_int second = enters & ~same & (foot_a != lanes_from_int(a.entry));
  if (lanes_bits(second) != 0) {
    lanes rise = lanes_abs(b.x - a.x) / lanes_max(way, lanes_set(1e-9f));
    second_surface other = kept_at_foot(volume->classifier, foot_a, a.x, foot_b, rise,
                                        lanes_load_block(job->transmittance[0] + at, job->stride),
                                        lanes_load_block(job->outside[0] + at, job->stride));
    lanes of_first = (1.0f - lanes_exp_negative(lanes_min(other.ahead, depth))) /
                     lanes_max(1.0f - lanes_exp_negative(depth), lanes_set(1e-6f));
    kept.before = lanes_select(second, other.kept, kept.before);
    kept.within = lanes_select(second, lanes_fma(of_first, other.kept - 1.0f, all), kept.within);
  }
  return kept;
}

/* A volume's matter where the light enters a slab. */
typedef struct matter_at_entry {
  lanes_int there; /* whether there is any */
  lanes depth; /* a bound of the optical depth of the volume's surface from its beginning up to this place */
} matter_at_entry;

/* a, b: the table coordinates of the values at the two ends of the part of the slab that is in the box. to:
 * the integrals of extinction up to these two values. way: the length of the light's way through this part.
 */
LANES_INLINE matter_at_entry find_matter_at_entry(const attenuate_volume *volume, table_coordinate a,
                                                  table_coordinate b, const way_ends *to, lanes way) {
  const classifier *classifier = volume->classifier;
  lanes values[3], rise = lanes_abs(b.x - a.x) / lanes_max(way, lanes_set(1e-9f));
  table_values(classifier->sums, a, values);
  lanes beginning = classifier->several_surfaces ? lanes_gather(&classifier->sums[0][3], a.entry * 4)
                                                 : lanes_set(classifier->only_beginning);
  return (matter_at_entry){
      values[0] > 0.0f, greatest_depth_of_surface(lanes_abs(to->to_a - beginning) * volume->weight[0], rise)};
}

/* The means over several volumes of the fractions k and k' of attenuate.h, weighted by the volumes'
 * extinctions. The light at the outside does not tell which volume has absorbed the light that is missing
 * before the slab. If another volume has matter where the light enters the slab, a surface counts at most as
 * much of this light as its own matter before the slab can have absorbed (part_of_matter()), so that a
 * surface that begins within the slab counts none. */
typedef struct kept_mean {
  lanes all;           /* the sum of k times extinction */
  lanes there;         /* the sum of k times extinction over the volumes that have matter where the light
                        * enters the slab */
  lanes shared;        /* the same sum as `there`, with k limited by part_of_matter() */
  lanes_int any, more; /* the lanes in which one volume at least, and two at least, have matter there */
  lanes within;        /* the sum of k' times extinction */
  lanes total;         /* the sum of all extinctions */
  kept_light newest;   /* in each lane, the fractions of the last volume with any extinction there */
  lanes extinction;    /* the extinction of this volume */
} kept_mean;

/* Adds a volume. light, outside: the transmittance before the slab, and the light at the outside there. */
LANES_INLINE void add_kept(kept_mean *mean, kept_light kept, lanes extinction, const matter_at_entry *entry,
                           lanes light, lanes outside) {
  const lanes_int some = extinction > 0.0f, there = some & entry->there;
  mean->all = lanes_fma(kept.before, extinction, mean->all);
  mean->there = lanes_fma(lanes_keep(there, kept.before), extinction, mean->there);
  mean->shared = lanes_fma(
      lanes_keep(there, lanes_min(kept.before, part_of_matter(entry->depth, light, outside, light))),
      extinction, mean->shared);
  mean->more |= mean->any & there;
  mean->any |= there;
  mean->within = lanes_fma(kept.within, extinction, mean->within);
  mean->total = mean->total + extinction;
  mean->newest.before = lanes_select(some, kept.before, mean->newest.before);
  mean->newest.within = lanes_select(some, kept.within, mean->newest.within);
  mean->extinction = lanes_select(some, extinction, mean->extinction);
}

/* The means of all volumes. A volume that has the whole extinction gives its own fractions exactly. */
LANES_INLINE kept_light mean_of_kept(const kept_mean *mean) {
  const lanes inverse = 1.0f / lanes_max(mean->total, lanes_set(1e-30f));
  const lanes_int alone = mean->extinction == mean->total;
  const lanes before = lanes_select(mean->more, mean->shared,
                                    lanes_select(mean->any, mean->there, mean->all));
  return (kept_light){lanes_select(alone, mean->newest.before, before * inverse),
                      lanes_select(alone, mean->newest.within, mean->within * inverse)};
}

typedef struct attenuated_block {
  int taken, changed, lit;
} attenuated_block;

/* Attenuates one channel of the light at the outside of surfaces by a slab. before, after: the transmittance
 * before and after the slab. affected: the pixels in which the slab has matter; other pixels keep their
 * light. Returns the new light at the outside. */
LANES_INLINE lanes pass_outside(float *at, size_t stride, lanes before, lanes after, kept_light kept,
                                lanes_int affected) {
  lanes light = lanes_max(before, lanes_set(0)), left = lanes_max(after, lanes_set(0));
  lanes old = lanes_load_block(at, stride), taken = lanes_max(old - light, lanes_set(0));
  lanes outside = lanes_fma(taken, kept.before, lanes_fma(light - left, kept.within, left));
  outside = lanes_select(affected, outside, old);
  lanes_store_block(at, stride, outside);
  return outside;
}

/* Attenuates one block by the slab. Returns whether the slab absorbed any light in the block (taken), whether
 * the block's pixels may have changed (changed), and whether enough light is left after the slab, or at the
 * outside of surfaces (lit). */
LANES_INLINE attenuated_block attenuate_block(const attenuate_job *job, int volume_count, int channels,
                                              int tile_x, int tile_y, int block) {
  const int x = block % 4 * BLOCK, y = block / 4 * BLOCK, corner[2] = {tile_x * TILE + x, tile_y * TILE + y};
  lanes depth[HL_CHANNELS] = {lanes_set(0), lanes_set(0), lanes_set(0)};
  kept_light kept = {lanes_set(0), lanes_set(0)};
  kept_mean mean = {.all = lanes_set(0),
                    .there = lanes_set(0),
                    .shared = lanes_set(0),
                    .any = lanes_set_int(0),
                    .more = lanes_set_int(0),
                    .within = lanes_set(0),
                    .total = lanes_set(0),
                    .newest = kept,
                    .extinction = lanes_set(0)};
  lanes path = path_through_sheet(&job->rays, job->path, block_u(corner[0]), block_v(corner[1]));
  /* the pixels in which a factor hides a volume's matter. Surfaces end in these pixels, although the values
   * are not low */
  lanes_int hidden = lanes_set_int(0);
  for (int i = 0; i < volume_count; i++) {
    const attenuate_volume *volume = &job->volumes[i];
    if (volume_count > 1 && (volume->blocks >> block & 1) == 0) continue;
    table_coordinate a = coordinate_of_density(volume->classifier,
                                               lanes_load(volume->before + block * BLOCK_PIXELS));
    table_coordinate b = coordinate_of_density(volume->classifier,
                                               lanes_load(volume->density + block * BLOCK_PIXELS));
    if (lanes_bits(may_be_visible(volume->classifier, a, b)) == 0) continue;
    covered_span span = covered_block(volume->enter, volume->leave, volume->uncut, block, job->height,
                                      job->spacing);
    if (volume->enter != NULL) cut_way(span, &a, &b);
    way_ends to;
    way_sums sums = sums_and_ends_of_way(volume->classifier, a, b, &to);
    lanes extinction = sums.extinction * span.length;
    if (hl_classifier_is_weighed(volume->classifier)) {
      lanes_int matter = extinction > 0.0f;
      extinction = extinction * factor_in_block(job, volume, corner, &sums, a.x, b.x, span);
      if (job->outside[0] != NULL) hidden |= matter & ~(extinction > 0.0f);
    }
    for (int c = 0; c < channels; c++) depth[c] = lanes_add_scaled(depth[c], extinction, volume->weight[c]);
    if (job->outside[0] == NULL) continue;
    kept_light own = {lanes_set(0), lanes_set(0)};
    if (volume->surface) {
      own = kept_by_values(job, volume, a, b, &to, span, path, extinction, (size_t)y * job->stride + x);
      if (volume->faces != NULL) own = kept_by_face(volume, own, b, corner);
      if (volume->faces != NULL && has_inner_corners(volume->faces))
        own = kept_by_inner_corner(job, volume, own, corner, (size_t)y * job->stride + x);
      own = kept_in_span(volume, own, block, job->height);
    }
    own.before = lanes_keep(extinction > 0.0f, own.before);
    if (volume_count == 1) {
      kept = own;
      continue;
    }
    const size_t at = (size_t)y * job->stride + x;
    matter_at_entry entry = find_matter_at_entry(volume, a, b, &to, path * span.length);
    add_kept(&mean, own, extinction, &entry, lanes_load_block(job->transmittance[0] + at, job->stride),
             lanes_load_block(job->outside[0] + at, job->stride));
  }
  lanes any = channels == 1 ? depth[0] : depth[0] + depth[1] + depth[2];
  const lanes_int affected = (any > 0.0f) | hidden;
  const int taken = lanes_bits(any > 0.0f) != 0;
  if (lanes_bits(affected) == 0) return (attenuated_block){0, 0, 1};
  if (volume_count > 1 && job->outside[0] != NULL) kept = mean_of_kept(&mean);
  lanes greatest = lanes_set(0);
  for (int c = 0; c < channels; c++) {
    float *at = job->transmittance[c] + (size_t)y * job->stride + x;
    lanes passing = lanes_exp_negative(depth[c] * path);
    lanes before = lanes_load_block(at, job->stride), after = before * passing;
    lanes_store_block(at, job->stride, after);
    greatest = lanes_max(greatest, after);
    if (job->outside[c] != NULL)
      greatest = lanes_max(greatest, pass_outside(job->outside[c] + (size_t)y * job->stride + x, job->stride,
                                                  before, after, kept, affected));
    if (job->older[c] != NULL) {
      float *older = job->older[c] + (size_t)y * job->stride + x;
      lanes older_after = lanes_load_block(older, job->stride) * passing;
      lanes_store_block(older, job->stride, older_after);
      greatest = lanes_max(greatest, older_after);
    }
    if (job->moment[c] == NULL) continue;
    float *moment = job->moment[c] + (size_t)y * job->moment_stride + x;
    lanes_store_block(
        moment, job->moment_stride,
        lanes_add_scaled(lanes_load_block(moment, job->moment_stride), before - after, job->position));
  }
  return (attenuated_block){taken, 1, lanes_bits(greatest >= DARK) != 0};
}

LANES_INLINE attenuated_blocks attenuate_volumes(const attenuate_job *job, int volume_count, int channels,
                                                 int tile_x, int tile_y) {
  uint32_t left = 0;
  attenuated_blocks blocks = {0, 0, 0};
  for (int i = 0; i < volume_count; i++) left |= job->volumes[i].blocks;
  for (; left != 0; left &= left - 1) {
    int at = __builtin_ctz(left);
    attenuated_block block = attenuate_block(job, volume_count, channels, tile_x, tile_y, at);
    blocks.taken |= (uint32_t)block.taken << at;
    blocks.changed |= (uint32_t)block.changed << at;
    blocks.lit |= (uint32_t)block.lit << at;
  }
  return blocks;
}

/* Attenuates a tile. For the usual case of one volume and grey shadows, the function uses a copy of the code
 * without loops over volumes and channels. */
static __attribute__((unused)) attenuated_blocks attenuate_tile(const attenuate_job *job, int tile_x,
                                                                int tile_y) {
  if (job->volume_count == 1 && job->channels == 1) return attenuate_volumes(job, 1, 1, tile_x, tile_y);
  return attenuate_volumes(job, job->volume_count, job->channels, tile_x, tile_y);
}

#endif
