/* render/shade_lanes.h - lights and composites one slab's pixels (steps 14 to 16). */
#ifndef HL_RENDER_SHADE_LANES_H
#define HL_RENDER_SHADE_LANES_H

#include "core/sheet_constants.h"
#include "light/light_texture_lanes.h"
#include "render/phase_lanes.h"
#include "render/reaching_lanes.h"
#include "render/sky_lanes.h"
#include "render/slab_color_lanes.h"
#include "render/voxel_color_lanes.h"
#include "scatter/scatter_lanes.h"

/* The light that arrives from one light source, and its direction (step 14 and the first half of step 15;
 * eqs. 1 and 2). */
typedef struct arriving_light {
  int dark;               /* lanes in which no light arrives, or the light that arrives lights nothing; the
                           * other members are not set */
  lanes3 towards;         /* unit */
  color_lanes full;       /* the light without attenuation */
  color_lanes shadowed;   /* the light with attenuation, as media receive it */
  color_lanes on_surface; /* the light with attenuation, as surfaces of volumes receive it */
} arriving_light;

/* The brightness of a spot light: a smooth step over the edge of its cone. */
LANES_INLINE lanes within_cone(const light_cone *cone, lanes3 towards) {
  lanes x = lanes_clamp((-dot3(towards, set3(cone->axis)) - cone->outer) * cone->scale, 0, 1);
  return x * x * lanes_line(x, -2.0f, 3.0f);
}

/* The fraction of a light's rays at a position that belongs to one sector of the light (light_source.h). The
 * other sectors have the rest. */
LANES_INLINE lanes fraction_of_sector(const sector_fraction *sector, lanes3 towards) {
  lanes own = lanes_set(0), sum = lanes_set(1e-30f);
  for (int i = 0; i < sector->count; i++) {
    lanes above = lanes_max(-dot3(towards, set3(sector->axis[i])) - sector->least, lanes_set(0));
    sum = lanes_fma(above, above, sum);
    if (i == sector->sector) own = above * above;
  }
  return own / sum;
}

LANES_INLINE int is_dark(const color_lanes *light) {
  return lanes_bits((light->c[0] > 0.0f) | (light->c[1] > 0.0f) | (light->c[2] > 0.0f)) == 0;
}

/* Returns whether light from the direction `towards` can light anything that is visible in the lanes `seen`:
 * a medium, a surface that faces the light, or a surface that sends on light from any angle (even). */
LANES_INLINE int is_faced(const block_density *densities, int count, lanes_int seen, lanes3 towards) {
  lanes_int faced = lanes_set_int(0);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (d->there && d->patch->volume->visible && d->patch->volume->lit)
      faced |= (d->surface < 1.0f) | (dot3(d->normal, towards) > 0.0f) |
               lanes_set_int(-d->patch->volume->even);
  }
  return lanes_bits(faced & seen) != 0;
}

/* Finds the direction from which a light's rays come at a position. Stores the light's strength at the
 * position, without colour, in arriving->full. Returns the length of the light's way through the slab. */
LANES_INLINE lanes find_direction(const shade_job *job, const shade_light *light, lanes3 position,
                                  arriving_light *arriving) {
  lanes path = lanes_set(light->path), strength = lanes_set(1.0f);
  if (light->parallel) {
    arriving->towards = set3(light->towards);
  } else {
    lanes3 way = {light->position[0] - position.x, light->position[1] - position.y,
                  light->position[2] - position.z};
    lanes least = lanes_set(LEAST_LIGHT_DISTANCE * LEAST_LIGHT_DISTANCE);
    lanes squared = lanes_max(dot3(way, way), least), distance = lanes_sqrt(squared);
    arriving->towards = scale3(way, 1.0f / distance);
    lanes climb = lanes_abs(dot3(arriving->towards, set3(job->normal)));
    path = lanes_min(light->path / lanes_max(climb, lanes_set(1e-3f)), distance);
    if (light->inverse_square) strength = 1.0f / squared;
    if (light->sector.count > 0) strength = strength * fraction_of_sector(&light->sector, arriving->towards);
    if (light->cone.scale > 0) strength = strength * within_cone(&light->cone, arriving->towards);
  }
  for (int c = 0; c < 3; c++) arriving->full.c[c] = strength;
  return path;
}

/* Finds the light without attenuation. Call it after find_direction(). */
LANES_INLINE void find_full_light(const shade_light *light, lanes3 position, arriving_light *arriving) {
  for (int c = 0; c < 3; c++) arriving->full.c[c] = arriving->full.c[c] * light->color[c];
  if (light->texture.pixels == NULL) return;
  lanes pattern[3];
  texture_pattern(&light->texture, position, pattern);
  for (int c = 0; c < 3; c++) arriving->full.c[c] = arriving->full.c[c] * pattern[c];
}

/* Multiplies the light that arrives by the fraction that passes the surfaces close before a slab's samples.
 */
LANES_INLINE void pass_near_surfaces(const shade_job *job, const shade_light *light, const block_slab *slab,
                                     color_lanes *passing) {
  lanes_int column = lanes_truncate(lanes_clamp(slab->u - job->near_u, 0, TILE - 1)),
            row = lanes_truncate(lanes_clamp(slab->v - job->near_v, 0, TILE - 1));
  for (int c = 0; c < light->channels; c++)
    passing->c[c] = passing->c[c] *
                    lanes_gather(job->near_passing[light->number * job->channels + c], row * TILE + column);
}

/* Multiplies the light that arrives by the fraction that passes everything before a slab's samples. */
LANES_INLINE void attenuate_light(const shade_job *job, const shade_light *light, const block_slab *slab,
                                  color_lanes *passing, color_lanes *arriving) {
  lanes transmittance = lanes_set(1.0f);
  if (job->near_passing != NULL) pass_near_surfaces(job, light, slab, passing);
  for (int c = 0; c < 3; c++) {
    if (c < light->channels) transmittance = passing->c[c];
    arriving->c[c] = arriving->c[c] * transmittance;
  }
}

/* Facts about the visible volumes of a slab: whether some lane has a medium, and whether some lane has a
 * surface. */
typedef struct receivers {
  int media, surfaces;
} receivers;

LANES_INLINE receivers receivers_in_slab(const block_density *densities, int count, lanes_int seen) {
  lanes_int media = lanes_set_int(0), surfaces = lanes_set_int(0);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    const shade_volume *volume = d->there ? d->patch->volume : NULL;
    if (volume == NULL || !volume->visible || !volume->receives_shadow) continue;
    media |= d->surface < (volume->even ? 2.0f : 1.0f);
    surfaces |= d->surface > 0.0f;
  }
  return (receivers){lanes_bits(media & seen) != 0, lanes_bits(surfaces & seen) != 0};
}

LANES_INLINE light_place place_of_slab(const shade_job *job, const shade_light *light,
                                       const block_slab *slab) {
  const shadow_lookup *lookup = &light->lookups[job->plane];
  const shadow_map *map = light->sublight_count > 0 ? &light->sublights[0].map : &lookup->map;
  return (light_place){light, lookup, slab->geometry.position,
                       taps_of_position(light, map, slab->geometry.position), lanes_bits(slab->seen)};
}

LANES_INLINE arriving_light light_at(const shade_job *job, const shade_light *light, const block_slab *slab,
                                     block_density *densities, int count) {
  const block_geometry *g = &slab->geometry;
  arriving_light arriving;
  lanes path = find_direction(job, light, g->position, &arriving);
  arriving.dark = !is_faced(densities, count, slab->seen, arriving.towards);
  if (arriving.dark) return arriving;
  find_full_light(light, g->position, &arriving);
  arriving.shadowed = arriving.on_surface = arriving.full;
  if (!light->shadowed || is_dark(&arriving.full)) return arriving;
  receivers on = receivers_in_slab(densities, count, slab->seen);
  light_place place = place_of_slab(job, light, slab);
  if (on.media) {
    color_lanes passing = passing_to_media(job, &place, slab, densities, count, arriving.towards, path);
    attenuate_light(job, light, slab, &passing, &arriving.shadowed);
  }
  if (on.surfaces) {
    color_lanes passing = passing_to_surfaces(&place, densities, count, arriving.towards, slab->place * path);
    attenuate_light(job, light, slab, &passing, &arriving.on_surface);
  }
  return arriving;
}

LANES_INLINE lanes power(lanes base, lanes exponent) {
  lanes safe = lanes_max(base, lanes_set(1e-12f));
  return lanes_keep(base > 1e-12f, lanes_exp2(lanes_max(lanes_log2(safe) * exponent, lanes_set(-100.0f))));
}

/* Adds light that was scattered more than once. The grid holds a medium that scatters evenly (scatter.h).
 * This medium lets T^(1 - w g) of a light through where the real medium lets T through. The difference
 * belongs to the fraction g of the light that was scattered once; this light goes on in the same direction.
 * The rest, the fraction 1 - g, is in the grid. Light scattered twice follows the phase function p of g^2
 * (derived: the moments of Henyey and Greenstein's function are powers of g, and the moments of two turns
 * multiply). So the light that goes on is scattered towards the eye by the function (p - (1 - g)) / g.
 * Together with the even part in the grid, this makes p. */
LANES_INLINE void add_scattered(const shade_job *job, const block_density *d, const block_geometry *g,
                                const arriving_light *lights, const color_lanes *color, color_lanes *lit) {
  const shade_volume *volume = d->patch->volume;
  const lanes position[3] = {g->position.x, g->position.y, g->position.z};
  const lanes towards_eye[3] = {g->towards_eye.x, g->towards_eye.y, g->towards_eye.z};
  lanes light[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
  if (job->scattered != NULL)
    scattered_light(job->scattered, position, towards_eye, volume->anisotropy, light);
  for (int i = 0; i < job->light_count && volume->anisotropy > 0; i++) {
    if (lights[i].dark || !job->lights[i].shadowed) continue;
    float even = 1 - volume->anisotropy;
    lanes twice = phase_of_light(volume->phase_twice, volume->anisotropy * volume->anisotropy,
                                 &job->lights[i], lights[i].towards, g);
    lanes turned = (twice - even) * (1.0f / volume->anisotropy) * (1.0f - d->surface);
    if (job->lights[i].of_sky > 0) turned = turned * job->lights[i].of_sky;
    for (int c = 0; c < 3; c++) {
      lanes full = lights[i].full.c[c],
            passing = lights[i].shadowed.c[c] / lanes_max(full, lanes_set(1e-30f));
      lanes exponent = 1.0f - color->c[c] * (volume->albedo[c] * volume->anisotropy);
      lanes onwards = lanes_max(power(passing, exponent) - passing, lanes_set(0));
      light[c] = lanes_fma(full * onwards, turned, light[c]);
    }
  }
  for (int c = 0; c < 3; c++) lit->c[c] = lanes_fma(light[c], color->c[c] * volume->albedo[c], lit->c[c]);
}

/* Adds the light that white surfaces send on. On the side that faces the light, this is the light that
 * arrives at their outside; on the other side, it is the light that passes their matter. */
LANES_INLINE void add_even(const arriving_light *light, int receives_shadow, lanes_int faces, lanes surface,
                           color_lanes *lit) {
  for (int c = 0; c < 3; c++) {
    lanes arriving = receives_shadow ? lanes_select(faces, light->on_surface.c[c], light->shadowed.c[c])
                                     : light->full.c[c];
    lit->c[c] = lanes_fma(arriving, surface, lit->c[c]);
  }
}

/* Finds the light that a volume's matter sends to the eye (step 15): it follows eqs. (3) and (4), with the
 * direction to the light's centre. A medium scatters by the mean of its phase function over the light.
 * Emission is added; a volume that is shaded flat has only emission. */
LANES_INLINE color_lanes illuminate(const shade_job *job, const block_density *d, const block_geometry *g,
                                    const arriving_light *lights, color_lanes color) {
  const shade_volume *volume = d->patch->volume;
  color_lanes lit;
  float own = volume->emission * job->emission;
  for (int c = 0; c < 3; c++) lit.c[c] = color.c[c] * (volume->ambient * job->ambient[c] + own);
  for (int i = 0; i < job->light_count && volume->lit; i++) {
    if (lights[i].dark) continue;
    const color_lanes *on_medium = volume->receives_shadow ? &lights[i].shadowed : &lights[i].full,
                      *on_surface = volume->receives_shadow ? &lights[i].on_surface : &lights[i].full;
    lanes facing = dot3(d->normal, lights[i].towards), medium = 1.0f - d->surface;
    if (volume->anisotropy != 0)
      medium = medium *
               phase_of_light(volume->phase_once, volume->anisotropy, &job->lights[i], lights[i].towards, g);
    const bool of_sky = job->lights[i].of_sky > 0;
    if (of_sky) medium = medium * job->lights[i].of_sky;
    for (int c = 0; c < 3; c++) {
      lanes even = volume->absorbs ? lanes_fma(medium, lanes_set(volume->albedo[c] - 1), medium) : medium;
      lit.c[c] = lanes_fma(on_medium->c[c], color.c[c] * even, lit.c[c]);
    }
    if (!volume->phong) continue;
    if (volume->even) {
      add_even(&lights[i], volume->receives_shadow, facing > 0.0f, d->surface, &lit);
      continue;
    }
    lanes diffuse = lanes_max(facing, lanes_set(0)) * volume->diffuse * d->surface;
    lanes3 mirrored = add_scaled3(scale3(lights[i].towards, lanes_set(-1.0f)), d->normal, facing * 2.0f);
    lanes glint = power(dot3(g->towards_eye, mirrored), lanes_set(volume->shininess)) * volume->specular *
                  d->surface;
    glint = of_sky ? lanes_set(0) : lanes_keep(facing > 0.0f, glint);
    for (int c = 0; c < 3; c++)
      lit.c[c] = lanes_fma(on_surface->c[c], lanes_fma(color.c[c], diffuse, glint), lit.c[c]);
  }
  if (volume->multiple && volume->lit) add_scattered(job, d, g, lights, &color, &lit);
  return lit;
}

/* Composites a colour into a pixel (step 16). Front to back: C += (1-A) a c; back to front: C = a c + (1-a)
 * C. */
LANES_INLINE lanes composite(int back_to_front, lanes opacity, color_lanes lit, float *pixels) {
  lanes alpha = lanes_load(pixels + 3 * BLOCK_PIXELS);
  lanes weight = back_to_front ? opacity : opacity * (1.0f - alpha);
  lanes keep = back_to_front ? 1.0f - opacity : lanes_set(1.0f);
  for (int c = 0; c < 3; c++) {
    float *at = pixels + c * BLOCK_PIXELS;
    lanes_store(at, lanes_fma(lit.c[c], weight, lanes_load(at) * keep));
  }
  alpha = lanes_fma(alpha, keep, weight);
  lanes_store(pixels + 3 * BLOCK_PIXELS, alpha);
  return alpha;
}

/* The colour of a volume's matter at the place where it is seen; set in the active lanes. */
LANES_INLINE color_lanes color_of_matter(const block_density *d, lanes3 position, uint32_t active) {
  const shade_volume *volume = d->patch->volume;
  color_lanes color, own;
  const classifier *classifier = volume->classifier;
  if (classifier->plane.color == NULL) {
    color_of_way(classifier, d, active, color.c);
  } else {
    lanes from, to = end_of_shown(d, &from);
    color_in_row(&classifier->plane, d->row, (lanes[2]){from, to}, (lanes[2]){d->before, d->after}, active,
                 color.c);
  }
  if (volume->colors.voxels != NULL) {
    (void)voxel_color_at(&volume->colors, volume->to_index, position, own.c);
    for (int c = 0; c < 3; c++) color.c[c] = color.c[c] * own.c[c];
  }
  if (volume->tints.voxels != NULL)
    tint_matter(&volume->tints, &volume->classifier->mask, position, active, color.c);
  return color;
}

/* The lit colour of a block: the mean of the volumes' lit colours, weighted by their extinctions. */
LANES_INLINE color_lanes color_of_block(const shade_job *job, const block_slab *slab,
                                        const arriving_light *lights, const block_density *densities,
                                        int count, lanes total) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  lanes inverse = 1.0f / lanes_max(total, lanes_set(1e-30f));
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there || !d->patch->volume->visible) continue;
    color_lanes color = color_of_matter(d, slab->geometry.position, lanes_bits(slab->seen));
    color_lanes lit = illuminate(job, d, &slab->geometry, lights, color);
    if (job->sky != NULL && d->patch->volume->lit) {
      color_lanes sky = sky_of_volume(job, slab, d, &color);
      for (int c = 0; c < 3; c++) lit.c[c] = lanes_fma(sky.c[c], color.c[c], lit.c[c]);
    }
    if (count == 1) return lit; /* a single volume has the whole extinction of the slab */
    lanes weight = lanes_select(d->extinction == total, lanes_set(1.0f), d->extinction * inverse);
    for (int c = 0; c < 3; c++) sum.c[c] = lanes_fma(lit.c[c], weight, sum.c[c]);
  }
  return sum;
}

/* Applies the factors on extinction to the slabs whose numbers are in `seen`, and drops the slabs in which
 * nothing is visible afterwards. Returns the number of slabs that stay. */
LANES_INLINE int weigh_slabs(const shade_job *job, packed_tile *tile, block_density *const *of,
                             int patch_count, int *seen, int count, color_lanes *lit) {
  int left = 0;
  for (int k = 0; k < count; k++) {
    int s = seen[k];
    weigh_slab(job, of[s], patch_count, &tile->slabs[s]);
    if (lanes_bits(tile->slabs[s].seen) != 0) seen[left++] = s;
    else lit[s] = (color_lanes){{lanes_set(0), lanes_set(0), lanes_set(0)}};
  }
  return left;
}

/* Lights a tile's slabs. Each step is done for all slabs before the next step. A slab's sums are long chains
 * of dependent operations, and with this order the processor can work on one slab while it waits for results
 * of another. lit: 0 if nothing is seen. */
LANES_INLINE void light_slabs(const shade_job *job, packed_tile *tile, block_density *densities,
                              int patch_count, int weighed, color_lanes *lit, uint64_t *samples) {
  arriving_light lights[TILE_BLOCKS][MAXIMUM_SWEEP_LIGHTS];
  block_density *of[TILE_BLOCKS];
  int seen[TILE_BLOCKS], count = 0;
  for (int s = 0; s < tile->slab_count; s++) {
    of[s] = densities + (size_t)s * (size_t)patch_count;
    classify_slab(of[s], patch_count, &tile->slabs[s]);
    uint32_t bits = lanes_bits(tile->slabs[s].seen);
    *samples += (uint64_t)__builtin_popcount(bits);
    if (bits != 0) seen[count++] = s;
    else lit[s] = (color_lanes){{lanes_set(0), lanes_set(0), lanes_set(0)}};
  }
  for (int k = 0; k < count; k++) place_slab(job, of[seen[k]], patch_count, &tile->slabs[seen[k]]);
  if (weighed) count = weigh_slabs(job, tile, of, patch_count, seen, count, lit);
  for (int k = 0; k < count; k++) {
    block_slab *slab = &tile->slabs[seen[k]];
    find_slopes(job, slab, of[seen[k]], patch_count);
    find_normals(slab, of[seen[k]], patch_count);
    if (job->sky != NULL) place_sky(job, slab, of[seen[k]], patch_count);
  }
  for (int k = 0; k < count; k++)
    for (int i = 0; i < job->light_count; i++)
      lights[k][i] = light_at(job, &job->lights[i], &tile->slabs[seen[k]], of[seen[k]], patch_count);
  for (int k = 0; k < count; k++) {
    const block_slab *slab = &tile->slabs[seen[k]];
    color_lanes color = color_of_block(job, slab, lights[k], of[seen[k]], patch_count, slab->total);
    for (int c = 0; c < 3; c++) lit[seen[k]].c[c] = lanes_keep(slab->seen, color.c[c]);
  }
}

/* Composites the lit colours of a packed slab into a block. Returns whether some pixel of the block is not
 * opaque. */
LANES_INLINE int composite_packed(const shade_job *job, const packed_block *block, const block_slab *slab,
                                  const color_lanes *lit, float *pixels) {
  color_lanes color = *lit;
  lanes opacity = slab->opacity;
  if (!block->whole) {
    for (int c = 0; c < 3; c++) color.c[c] = lanes_unpack(&block->packing, lit->c[c]);
    opacity = lanes_unpack(&block->packing, opacity);
  }
  lanes alpha = composite(job->back_to_front, opacity, color, pixels);
  return job->back_to_front || lanes_bits(alpha < PIXEL_OPAQUE) != 0;
}

/* The order in which a tile's blocks are packed. Neighbouring blocks follow each other, so that the gradients
 * of a packed slab share voxels. */
static const unsigned char NEAR_EACH_OTHER[TILE_BLOCKS] = {0,  1,  4,  5,  2, 3, 6,  7,
                                                           10, 11, 14, 15, 8, 9, 12, 13};
/* The inverse of NEAR_EACH_OTHER: the position of each block in this order. */
static const unsigned char RANK_OF_BLOCK[TILE_BLOCKS] = {0,  1,  4, 5, 2,  3,  6,  7,
                                                         12, 13, 8, 9, 14, 15, 10, 11};

/* The blocks among `blocks` in which something may be seen, as bits at the blocks' ranks in the packing
 * order. bits: for each block, the pixels in which something may be seen. All blocks are tested before the
 * first block is shaded. About half of the blocks show nothing, and the processor cannot predict which blocks
 * these are. So it would have to wait if blocks were tested while others are shaded. */
LANES_INLINE uint32_t visible_blocks(const shade_job *job, const shade_patch *patches, int patch_count,
                                     uint32_t blocks, const float *pixels, uint16_t bits[TILE_BLOCKS]) {
  uint32_t ranks = 0;
  for (; blocks != 0; blocks &= blocks - 1) {
    int block = __builtin_ctz(blocks);
    uint32_t visible = visible_in_block(job, patches, patch_count, block,
                                        pixels + (block * 4 + 3) * BLOCK_PIXELS);
    bits[block] = (uint16_t)visible;
    ranks |= (uint32_t)(visible != 0) << RANK_OF_BLOCK[block];
  }
  return ranks;
}

LANES_INLINE uint32_t shade_patches(const shade_job *job, const tile_slab *tile, int patch_count,
                                    float *pixels, uint64_t *samples) {
  block_density *ways = tile->scratch, *densities = ways + patch_count;
  const uint32_t blocks = tile->blocks;
  packed_tile packed;
  color_lanes lit[TILE_BLOCKS];
  uint16_t bits[TILE_BLOCKS];
  uint32_t seen = 0;
  packed.slab_count = 0;
  for (uint32_t left = visible_blocks(job, tile->patches, patch_count, blocks, pixels, bits); left != 0;
       left &= left - 1) {
    int block = NEAR_EACH_OTHER[__builtin_ctz(left)];
    block_slab slab;
    slab_of_block(job, tile, patch_count, block, bits[block], ways, &slab);
    seen |= 1u << block;
    for (int c = 0; c < 3; c++) /* prefetches the pixels, which are needed when the tile has been lit */
      __builtin_prefetch(pixels + (block * 4 + c) * BLOCK_PIXELS, 1);
    if (bits[block] == 0xffff)
      keep_block(&packed, &slab, ways, patch_count, densities, &packed.blocks[block]);
    else pack_block(&packed, &slab, ways, patch_count, bits[block], densities, &packed.blocks[block]);
  }
  light_slabs(job, &packed, densities, patch_count, is_weighed(tile), lit, samples);
  uint32_t open = blocks & ~seen;
  for (; seen != 0; seen &= seen - 1) {
    int block = __builtin_ctz(seen);
    const packed_block *of_block = &packed.blocks[block];
    if (composite_packed(job, of_block, &packed.slabs[of_block->slab], &lit[of_block->slab],
                         pixels + block * 4 * BLOCK_PIXELS))
      open |= 1u << block;
  }
  return open;
}

/* Shades a tile. The code for one volume, the usual case, is compiled separately, because it needs no loops
 * over volumes. */
static uint32_t shade_tile(const shade_job *job, const tile_slab *tile, float *pixels, uint64_t *samples) {
  if (tile->patch_count == 1) return shade_patches(job, tile, 1, pixels, samples);
  return shade_patches(job, tile, tile->patch_count, pixels, samples);
}

#endif
