/* render/shade_lanes.h - one slab's pixels lit and composited (steps 14 to 16). */
#ifndef HL_RENDER_SHADE_LANES_H
#define HL_RENDER_SHADE_LANES_H

#include "light/light_screen_lanes.h"
#include "light/shadow_lookup_lanes.h"
#include "render/pack_lanes.h"

static const float LEAST_LIGHT_DISTANCE = (float)HL_LEAST_LIGHT_DISTANCE;

typedef struct color_lanes { lanes c[3]; } color_lanes;

/* phi(x) = (1 - exp(-x)) / x, the mean of exp(-x s) over s in [0,1], as what is to be divided by what. left: exp(-x). */
typedef struct mean_transmittance { lanes over, under; } mean_transmittance;

LANES_INLINE mean_transmittance transmittance_within(lanes x, lanes left) {
  lanes near = lanes_fma(-x, lanes_line(x, -1.0f / 6, 0.5f), lanes_set(1.0f));
  lanes_int thin = x < 0.01f;
  return (mean_transmittance){lanes_select(thin, near, 1.0f - left), lanes_select(thin, lanes_set(1.0f), x)};
}

/* Light left within the slab, averaged as the eye sees it: with e and l the slab's optical depths for the eye and for
 * the light (derived; exact for any extinction that varies along the normal only). Both rising along the eye's ray:
 *     int e exp(-e s) exp(-l s) ds / (1 - exp(-e)) = phi(e + l) / phi(e);
 * opposite, the light's falling, exp(-l (1 - s)) in place of exp(-l s):
 *     (exp(-l) - exp(-e)) / (e - l) / phi(e) = exp(-min) phi(|e - l|) / phi(e). left: exp(-e). */
LANES_INLINE lanes own_transmittance(lanes_int opposite, lanes e, lanes left, lanes l) {
  lanes both = lanes_select(opposite, lanes_abs(e - l), e + l);
  mean_transmittance of_both = transmittance_within(both, lanes_exp_negative(both)), of_eye = transmittance_within(e, left);
  lanes seen = of_both.over * of_eye.under / (of_both.under * of_eye.over);
  if (lanes_bits(opposite) != 0) seen = lanes_select(opposite, lanes_exp_negative(lanes_min(e, l)) * seen, seen);
  return lanes_min(seen, lanes_set(1.0f));
}

LANES_INLINE shadow_taps taps_of_position(const shade_light *light, const shadow_map *map, lanes3 position) {
  lanes place[3];
  for (int row = 0; row < 3; row++) place[row] = row_of_point(map->rows[row], position);
  if (light->parallel) return taps_of_place(map, light->nearest, place[1], place[2]); /* place[0] is 1 everywhere */
  lanes_int ahead = place[0] > 0.0f;
  lanes safe = lanes_select(ahead, place[0], lanes_set(1.0f)), outside = lanes_set(-1.0f);
  return taps_of_place(map, light->nearest, lanes_select(ahead, place[1] / safe, outside), lanes_select(ahead, place[2] / safe, outside));
}

LANES_INLINE color_lanes mean_of_parts(const shade_light *light, lanes3 position, uint32_t active) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  for (int i = 0; i < light->part_count; i++) {
    const part_lookup *part = &light->parts[i];
    shadow_taps taps = taps_of_position(light, &part->map, position);
    for (int c = 0; c < light->channels; c++)
      sum.c[c] = lanes_add_scaled(sum.c[c], look_up_part(&part->map, &taps, part->left[c], active), part->weight[c]);
  }
  for (int c = 0; c < light->channels; c++) sum.c[c] = sum.c[c] / ((float)PART_ONE * (float)light->part_count);
  return sum;
}

/* Light reaching the slab in the active lanes: the shadow buffers' transmittance at its first sheet. */
LANES_INLINE color_lanes reaching(const shade_light *light, lanes3 position, uint32_t active) {
  if (light->part_count > 0) return mean_of_parts(light, position, active);
  color_lanes reached = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  const shadow_map *map = &light->lookup->map;
  shadow_taps taps = taps_of_position(light, map, position);
  for (int c = 0; c < light->channels; c++) {
    const float *buffer = light->lookup->transmittance[c];
    reached.c[c] = light->cubic ? look_up_cubic(map, &taps, buffer) : look_up(map, &taps, buffer);
  }
  return reached;
}

/* Steps 14 and 15's first half: what arrives of one light (eqs. 1 and 2), and from where. */
typedef struct arriving_light {
  int dark;       /* it lights nothing; the rest is not filled */
  lanes3 towards; /* unit */
  color_lanes full, shadowed; /* without and with attenuation */
} arriving_light;

/* How far light has come within the box of a volume when it reaches the ends of a way, of the given lengths of its way. */
typedef struct ways_in_box { lanes first, last; } ways_in_box;

LANES_INLINE ways_in_box ways_of_light(const shade_volume *volume, lanes3 start, lanes3 way, lanes3 towards, ways_in_box path) {
  ways_in_box leave = {lanes_set(1e30f), lanes_set(1e30f)}, enter = {lanes_set(0), lanes_set(0)};
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    lanes at = row_of_point(row, start), step = row_of_vector(row, way), speed = row_of_vector(row, towards);
    speed = lanes_select(lanes_abs(speed) < 1e-12f, lanes_set(1e-12f), speed);
    lanes slowness = 1.0f / speed, low = lanes_set(volume->low[axis]), high = lanes_set(volume->high[axis]);
    lanes_int rising = speed > 0.0f;
    lanes far = (lanes_select(rising, high, low) - at) * slowness, near = (lanes_select(rising, low, high) - at) * slowness;
    leave.first = lanes_min(leave.first, lanes_max(far, lanes_set(0)));
    leave.last = lanes_min(leave.last, lanes_max(lanes_fma(-step, slowness, far), lanes_set(0)));
    enter.first = lanes_max(enter.first, near);
    enter.last = lanes_max(enter.last, lanes_fma(-step, slowness, near));
  }
  return (ways_in_box){lanes_max(lanes_min(path.first, leave.first) - enter.first, lanes_set(0)),
                       lanes_max(lanes_min(path.last, leave.last) - enter.last, lanes_set(0))};
}

/* Optical depths of the slab for one light: to where the slab's covered part starts and to where it ends. Light through a face of a
 * box may meet its end first. */
typedef struct light_depths { lanes first[HL_CHANNELS], last[HL_CHANNELS]; } light_depths;

/* Where in the table a volume is seen. */
LANES_INLINE lanes coordinate_seen(const block_density *d) { return lanes_fma(d->after - d->before, d->seen, d->before); }

/* Even extinction of the light's way through the slab that has the right optical depth down to what is seen of a volume
 * (derived). The eye's ray may run along a surface that the light's crosses: a way s before the point seen, the
 * density is f - s g.l to first order, g the gradient, which gives the mean extinction up to there; and where
 * extinction were even, the eye would see another place of the slab: the depths there must agree. */
LANES_INLINE lanes extinction_towards(const block_density *d, lanes3 towards, lanes way) {
  const classifier *classifier = d->patch->volume->classifier;
  if (lanes_bits(d->sloped) == 0) return d->sums.extinction;
  lanes late = lanes_min(d->seen / lanes_max(d->evenly, lanes_set(1e-3f)), lanes_set(4.0f));
  lanes seen = coordinate_seen(d);
  lanes start = lanes_fma(dot3(d->slope, towards), way * classifier->scale, seen);
  way_sums sums = sums_of_way(classifier, place_of_coordinate(lanes_clamp(start, 0, CLASSIFIER_ENTRIES)),
                              place_of_coordinate(seen));
  return lanes_select(d->sloped, late * sums.extinction, d->sums.extinction);
}

/* Where light enters what is cut by faces: its way from there, and where it is looked up instead. Pixels of a shadow buffer beside a
 * face mix light that passes outside with what the box took: so near to a face, the box's part is known without them. */
typedef struct lit_face {
  lanes_int near;  /* the buffer's pixels there reach across the face */
  lanes way;       /* of the light, from the face to what is seen */
  lanes longest;   /* the same to anything in the slab, at most; 0 where not near */
  lanes3 position; /* what is seen, moved out of the box until they do not; elsewhere where it is */
} lit_face;

/* Light that leaves one box, seen towards it, where another begins, goes on in that: so far apart they touch, in units of a voxel. */
static const float TOUCHING = 1e-3f;

/* The light's way from what is seen to the face of a box, and the outward normal there; way, normal: of the boxes before. */
LANES_INLINE void extend_to_face(const shade_volume *volume, lanes3 position, lanes3 towards, lanes *way, lanes3 *normal) {
  lanes enter = lanes_set(-1e30f), leave = lanes_set(1e30f);
  lanes3 out = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    float length = 1.0f / sqrtf(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
    lanes at = row_of_point(row, position), speed = row_of_vector(row, towards);
    speed = lanes_select(lanes_abs(speed) < 1e-12f, lanes_set(1e-12f), speed);
    lanes_int rising = speed > 0.0f;
    lanes slowness = 1.0f / speed, low = lanes_set(volume->low[axis]), high = lanes_set(volume->high[axis]);
    lanes far = (lanes_select(rising, high, low) - at) * slowness, sign = lanes_select(rising, lanes_set(length), lanes_set(-length));
    enter = lanes_max(enter, (lanes_select(rising, low, high) - at) * slowness);
    lanes_int first = far < leave;
    leave = lanes_min(leave, far);
    out.x = lanes_select(first, sign * row[0], out.x);
    out.y = lanes_select(first, sign * row[1], out.y);
    out.z = lanes_select(first, sign * row[2], out.z);
  }
  lanes_int on = (enter <= *way + TOUCHING) & (leave > *way);
  *way = lanes_select(on, leave, *way);
  normal->x = lanes_select(on, out.x, normal->x);
  normal->y = lanes_select(on, out.y, normal->y);
  normal->z = lanes_select(on, out.z, normal->z);
}

/* Light that climbs less over a face grazes it; a pixel beside the face then mixes much more than this of optical depth in dense matter.
 * Elsewhere light is looked up where it is: moved, others' shadows on the face would move too. */
static const float GRAZING = 0.5f, LEAST_MIXED = 0.5f;

/* Light crosses three shared faces at most where eight boxes meet. reach: of a look-up around its place, in frame units. */
LANES_INLINE lit_face find_face(const block_slab *slab, const block_density *densities, int count, lanes3 towards, lanes reach) {
  const block_geometry *g = &slab->geometry;
  lit_face face = {lanes_set_int(0), lanes_set(0), lanes_set(0), g->position};
  lanes3 normal = {lanes_set(0), lanes_set(0), lanes_set(0)};
  int cut = 0;
  for (int pass = 0; pass < (count == 1 ? 1 : 4); pass++)
    for (int i = 0; i < count; i++) {
      const block_density *d = &densities[i];
      if (!d->there || d->patch->enter == NULL || d->patch->whole) continue;
      extend_to_face(d->patch->volume, g->position, towards, &face.way, &normal);
      cut = 1;
    }
  if (!cut) return face;
  lanes climb = lanes_max(dot3(normal, towards), lanes_set(1e-3f)), depth = face.way * climb;
  lanes dense = slab->total / lanes_max(slab->part.length, lanes_set(1e-6f));
  face.near = (face.way > 0.0f) & (depth < reach) & (climb < GRAZING) & (dense * reach > LEAST_MIXED * climb);
  if (lanes_bits(face.near) == 0) return face;
  face.longest = lanes_keep(face.near, face.way + lanes_abs(dot3(normal, g->step_sheet)) / climb);
  face.position = add_scaled3(g->position, normal, lanes_keep(face.near, depth + reach));
  return face;
}

/* The light's ways through all volumes to where the slab's covered part starts and ends: of several that share a slab, each takes
 * light on what of its way lies in the slab and in its own box, on whichever side of them the eye's ray passes; near a face that it
 * enters through, also on what lies in the box before the slab. */
LANES_INLINE ways_in_box find_ways(const block_slab *slab, block_density *densities, int count, lanes3 towards, lanes path,
                                   const lit_face *face) {
  const block_geometry *g = &slab->geometry;
  ways_in_box all = {slab->part.begin * path, (slab->part.begin + slab->part.length) * path}, sum = {lanes_set(0), lanes_set(0)};
  lanes3 start = add_scaled3(g->start, g->step_sheet, slab->part.begin), way = scale3(g->step_sheet, slab->part.length);
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there) continue;
    int cut = d->patch->enter != NULL && !d->patch->whole;
    ways_in_box longest = {lanes_max(all.first, face->longest), lanes_max(all.last, face->longest)};
    ways_in_box own = cut ? ways_of_light(d->patch->volume, start, way, towards, longest) : all;
    d->light_first = own.first;
    d->light_last = own.last;
    if (count == 1) return (ways_in_box){lanes_min(own.first, all.first), lanes_min(own.last, all.last)};
    sum = (ways_in_box){sum.first + own.first, sum.last + own.last};
  }
  return (ways_in_box){lanes_min(sum.first, all.first), lanes_min(sum.last, all.last)};
}

LANES_INLINE light_depths depths_of_light(const shade_job *job, const block_slab *slab, block_density *densities, int count,
                                          lanes3 towards, lanes path, const lit_face *face) {
  light_depths depths;
  for (int c = 0; c < HL_CHANNELS; c++) depths.first[c] = depths.last[c] = lanes_set(0);
  ways_in_box ways = find_ways(slab, densities, count, towards, path, face);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there) continue;
    lanes extinction = extinction_towards(d, towards, lanes_fma(lanes_max(ways.last, ways.first) - ways.first, d->seen, ways.first));
    for (int c = 0; c < job->channels; c++) {
      lanes cast = extinction * d->patch->volume->cast[c];
      depths.first[c] = lanes_fma(cast, d->light_first, depths.first[c]);
      depths.last[c] = lanes_fma(cast, d->light_last, depths.last[c]);
    }
  }
  /* away from faces, what light loses before the slab is in the buffer, and in the slab its way grows */
  for (int c = 0; c < job->channels; c++)
    depths.last[c] = lanes_select(face->near, depths.last[c], lanes_max(depths.last[c], depths.first[c]));
  return depths;
}

/* Light left within the slab, as the eye sees it: of what has come least far, and on the way from there. */
LANES_INLINE lanes left_within(const shade_job *job, const block_slab *slab, const light_depths *depths, int channel) {
  lanes first = depths->first[channel], last = depths->last[channel];
  lanes_int opposite = job->back_to_front ? first < last : first > last;
  return lanes_exp_negative(lanes_min(first, last)) * own_transmittance(opposite, slab->depth, slab->left, lanes_abs(last - first));
}

/* Brightness of a spot light: a smooth step over its cone's edge. */
LANES_INLINE lanes within_cone(const light_cone *cone, lanes3 towards) {
  lanes x = lanes_clamp((-dot3(towards, set3(cone->axis)) - cone->outer) * cone->scale, 0, 1);
  return x * x * lanes_line(x, -2.0f, 3.0f);
}

/* The share of a light's sector (light_sector.h). */
LANES_INLINE lanes share_of_sector(const light_share *share, lanes3 towards) {
  lanes own = lanes_set(0), sum = lanes_set(1e-30f);
  for (int i = 0; i < share->count; i++) {
    lanes above = lanes_max(-dot3(towards, set3(share->axis[i])) - share->least, lanes_set(0));
    sum = lanes_fma(above, above, sum);
    if (i == share->sector) own = above * above;
  }
  return own / sum;
}

LANES_INLINE int is_dark(const color_lanes *light) {
  return lanes_bits((light->c[0] > 0.0f) | (light->c[1] > 0.0f) | (light->c[2] > 0.0f)) == 0;
}

/* Whether light from there can light anything seen: a medium, or a surface that faces it. */
LANES_INLINE int is_faced(const block_density *densities, int count, lanes_int seen, lanes3 towards) {
  lanes_int faced = lanes_set_int(0);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (d->there && d->patch->volume->visible && d->patch->volume->lit)
      faced |= (d->surface < 1.0f) | (dot3(d->normal, towards) > 0.0f);
  }
  return lanes_bits(faced & seen) != 0;
}

LANES_INLINE arriving_light light_at(const shade_job *job, const shade_light *light, const block_slab *slab,
                                     block_density *densities, int count) {
  const block_geometry *g = &slab->geometry;
  arriving_light arriving;
  lanes path = lanes_set(light->path), strength = lanes_set(1.0f), distance = strength;
  if (light->parallel) {
    arriving.towards = set3(light->towards);
  } else {
    lanes3 way = {light->position[0] - g->position.x, light->position[1] - g->position.y,
                  light->position[2] - g->position.z};
    lanes least = lanes_set(LEAST_LIGHT_DISTANCE * LEAST_LIGHT_DISTANCE);
    lanes squared = lanes_max(dot3(way, way), least);
    distance = lanes_sqrt(squared);
    arriving.towards = scale3(way, 1.0f / distance);
    lanes climb = lanes_abs(dot3(arriving.towards, set3(job->normal)));
    path = lanes_min(light->path / lanes_max(climb, lanes_set(1e-3f)), distance);
    if (light->inverse_square) strength = 1.0f / squared;
    if (light->share.count > 0) strength = strength * share_of_sector(&light->share, arriving.towards);
    if (light->cone.scale > 0) strength = strength * within_cone(&light->cone, arriving.towards);
  }
  arriving.dark = !is_faced(densities, count, slab->seen, arriving.towards);
  if (arriving.dark) return arriving;
  for (int c = 0; c < 3; c++) arriving.full.c[c] = strength * light->color[c];
  if (light->screen.pixels != NULL) {
    lanes pattern[3];
    screen_pattern(&light->screen, g->position, pattern);
    for (int c = 0; c < 3; c++) arriving.full.c[c] = arriving.full.c[c] * pattern[c];
  }
  arriving.shadowed = arriving.full;
  if (!light->shadowed || is_dark(&arriving.full)) return arriving;
  lanes pixel = lanes_set(light->reach);
  if (!light->parallel) pixel = pixel * distance;
  lit_face face = find_face(slab, densities, count, arriving.towards, pixel);
  light_depths depths = depths_of_light(job, slab, densities, count, arriving.towards, path, &face);
  color_lanes reached = reaching(light, face.position, lanes_bits(slab->seen));
  lanes transmittance = lanes_set(1.0f);
  for (int c = 0; c < 3; c++) {
    if (c < light->channels)
      transmittance = reached.c[c] * left_within(job, slab, &depths, c);
    arriving.shadowed.c[c] = arriving.shadowed.c[c] * transmittance;
  }
  return arriving;
}

LANES_INLINE lanes power(lanes base, float exponent) {
  lanes safe = lanes_max(base, lanes_set(1e-12f));
  return lanes_keep(base > 1e-12f, lanes_exp2(lanes_max(lanes_log2(safe) * exponent, lanes_set(-100.0f))));
}

/* Step 15: eqs. (3) and (4) at the light's centre; a medium where there is no surface (algorithm, optical model). What
 * shines by itself is added; flat colours are nothing else. */
LANES_INLINE color_lanes illuminate(const shade_job *job, const block_density *d, const block_geometry *g,
                                    const arriving_light *lights, color_lanes color) {
  const shade_volume *volume = d->patch->volume;
  color_lanes lit;
  float own = volume->emission * job->emission;
  for (int c = 0; c < 3; c++) lit.c[c] = color.c[c] * (volume->ambient * job->ambient[c] + own);
  for (int i = 0; i < job->light_count && volume->lit; i++) {
    if (lights[i].dark) continue;
    const color_lanes *intensity = volume->receives_shadow ? &lights[i].shadowed : &lights[i].full;
    lanes facing = dot3(d->normal, lights[i].towards);
    lanes diffuse = lanes_fma(lanes_max(facing, lanes_set(0)) * volume->diffuse, d->surface, 1.0f - d->surface);
    lanes3 mirrored = add_scaled3(scale3(lights[i].towards, lanes_set(-1.0f)), d->normal, facing * 2.0f);
    lanes glint = power(dot3(g->towards_eye, mirrored), volume->shininess) * volume->specular * d->surface;
    glint = lanes_keep(facing > 0.0f, glint);
    for (int c = 0; c < 3; c++) lit.c[c] = lanes_fma(intensity->c[c], lanes_fma(color.c[c], diffuse, glint), lit.c[c]);
  }
  return lit;
}

/* Step 16. Front to back: C += (1-A) a c; back to front: C = a c + (1-a) C. */
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

/* Colours of the volumes, lit and averaged weighted by extinction. */
LANES_INLINE color_lanes color_of_block(const shade_job *job, const block_geometry *g, const arriving_light *lights,
                                  const block_density *densities, int count, lanes total) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  lanes inverse = 1.0f / lanes_max(total, lanes_set(1e-30f));
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there || !d->patch->volume->visible) continue;
    table_place place = place_of_coordinate(coordinate_seen(d));
    color_lanes color;
    table_values(d->patch->volume->classifier->color, place, color.c);
    color_lanes lit = illuminate(job, d, g, lights, color);
    if (count == 1) return lit; /* its extinction is the total */
    lanes weight = lanes_select(d->extinction == total, lanes_set(1.0f), d->extinction * inverse);
    for (int c = 0; c < 3; c++) sum.c[c] = lanes_fma(lit.c[c], weight, sum.c[c]);
  }
  return sum;
}

/* A tile's slabs, one step for all of them at a time: their sums are long chains of few numbers each, and the processor
 * works on one slab's while another's wait. lit: 0 where nothing is seen. */
LANES_INLINE void light_slabs(const shade_job *job, packed_tile *tile, block_density *densities, int patch_count,
                              color_lanes *lit, uint64_t *samples) {
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
  for (int k = 0; k < count; k++) {
    block_slab *slab = &tile->slabs[seen[k]];
    find_slopes(job, slab, of[seen[k]], patch_count);
    find_normals(of[seen[k]], patch_count);
  }
  for (int k = 0; k < count; k++)
    for (int i = 0; i < job->light_count; i++)
      lights[k][i] = light_at(job, &job->lights[i], &tile->slabs[seen[k]], of[seen[k]], patch_count);
  for (int k = 0; k < count; k++) {
    const block_slab *slab = &tile->slabs[seen[k]];
    color_lanes color = color_of_block(job, &slab->geometry, lights[k], of[seen[k]], patch_count, slab->total);
    for (int c = 0; c < 3; c++) lit[seen[k]].c[c] = lanes_keep(slab->seen, color.c[c]);
  }
}

/* Returns true while some pixel of the block is not opaque. */
LANES_INLINE int composite_packed(const shade_job *job, const packed_block *block, const block_slab *slab,
                                  const color_lanes *lit, float *pixels) {
  color_lanes color = *lit;
  lanes opacity = slab->opacity;
  if (!block->whole) {
    for (int c = 0; c < 3; c++) color.c[c] = lanes_unpack(&block->packing, lit->c[c]);
    opacity = lanes_unpack(&block->packing, opacity);
  }
  lanes alpha = composite(job->back_to_front, opacity, color, pixels);
  return job->back_to_front || lanes_bits(alpha < OPAQUE) != 0;
}

/* A tile's blocks, so that those that share a slab lie side by side: gradients then share voxels. */
static const unsigned char NEAR_EACH_OTHER[TILE_BLOCKS] = {0, 1, 4, 5, 2, 3, 6, 7, 10, 11, 14, 15, 8, 9, 12, 13};
/* The place of each block in that order. */
static const unsigned char PLACE_OF_BLOCK[TILE_BLOCKS] = {0, 1, 4, 5, 2, 3, 6, 7, 12, 13, 8, 9, 14, 15, 10, 11};

/* Of the given blocks, those in which something may be seen, one bit each at their places in that order; bits: in which
 * of their pixels. All blocks are asked before the first is gone into: half of them hold nothing, which no processor
 * foresees, and loads would wait for one another's answers. */
LANES_INLINE uint32_t visible_blocks(const shade_job *job, const shade_patch *patches, int patch_count, uint32_t blocks,
                                     const float *pixels, uint16_t bits[TILE_BLOCKS]) {
  uint32_t places = 0;
  for (; blocks != 0; blocks &= blocks - 1) {
    int block = __builtin_ctz(blocks);
    uint32_t visible = visible_in_block(job, patches, patch_count, block, pixels + (block * 4 + 3) * BLOCK_PIXELS);
    bits[block] = (uint16_t)visible;
    places |= (uint32_t)(visible != 0) << PLACE_OF_BLOCK[block];
  }
  return places;
}

LANES_INLINE uint32_t shade_patches(const shade_job *job, const shade_patch *patches, int patch_count, int tile_x, int tile_y,
                                    uint32_t blocks, void *scratch, float *pixels, uint64_t *samples) {
  block_density *ways = scratch, *densities = ways + patch_count;
  packed_tile tile;
  color_lanes lit[TILE_BLOCKS];
  uint16_t bits[TILE_BLOCKS];
  uint32_t seen = 0;
  tile.slab_count = 0;
  for (uint32_t left = visible_blocks(job, patches, patch_count, blocks, pixels, bits); left != 0; left &= left - 1) {
    int block = NEAR_EACH_OTHER[__builtin_ctz(left)];
    block_slab slab;
    slab_of_block(job, patches, patch_count, tile_x, tile_y, block, bits[block], ways, &slab);
    seen |= 1u << block;
    for (int c = 0; c < 3; c++) __builtin_prefetch(pixels + (block * 4 + c) * BLOCK_PIXELS, 1); /* needed once it is lit */
    if (bits[block] == 0xffff) keep_block(&tile, &slab, ways, patch_count, densities, &tile.blocks[block]);
    else pack_block(&tile, &slab, ways, patch_count, bits[block], densities, &tile.blocks[block]);
  }
  light_slabs(job, &tile, densities, patch_count, lit, samples);
  uint32_t open = blocks & ~seen;
  for (; seen != 0; seen &= seen - 1) {
    int block = __builtin_ctz(seen);
    const packed_block *packed = &tile.blocks[block];
    if (composite_packed(job, packed, &tile.slabs[packed->slab], &lit[packed->slab], pixels + block * 4 * BLOCK_PIXELS))
      open |= 1u << block;
  }
  return open;
}

/* Most often there is one volume, which needs no loops over volumes. */
static uint32_t shade_tile(const shade_job *job, const shade_patch *patches, int patch_count, int tile_x, int tile_y,
                           uint32_t blocks, void *scratch, float *pixels, uint64_t *samples) {
  if (patch_count == 1) return shade_patches(job, patches, 1, tile_x, tile_y, blocks, scratch, pixels, samples);
  return shade_patches(job, patches, patch_count, tile_x, tile_y, blocks, scratch, pixels, samples);
}

#endif
