/* render/shade_lanes.h - one slab's pixels lit and composited, a 4x4 block at a time (steps 12 to 16). */
#ifndef HL_RENDER_SHADE_LANES_H
#define HL_RENDER_SHADE_LANES_H

#include "light/attenuate_lanes.h"
#include "light/light_screen_lanes.h"
#include "render/shade.h"
#include "splat/slope_lanes.h"

/* A pixel counts as opaque from here on: what is behind adds less than half a step of 10 bits. */
static const float OPAQUE = 1.0f - 1.0f / 2048;

static const float LEAST_LIGHT_DISTANCE = (float)HL_LEAST_LIGHT_DISTANCE;

typedef struct color_lanes { lanes c[3]; } color_lanes;

LANES_INLINE lanes dot3(lanes3 a, lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LANES_INLINE lanes3 scale3(lanes3 a, lanes s) { return (lanes3){a.x * s, a.y * s, a.z * s}; }
LANES_INLINE lanes3 add3(lanes3 a, lanes3 b) { return (lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
LANES_INLINE lanes3 set3(const float v[3]) { return (lanes3){lanes_set(v[0]), lanes_set(v[1]), lanes_set(v[2])}; }

/* What the volumes of a block share: where its pixels are and how they look. */
typedef struct block_geometry {
  lanes3 position;       /* frame space, in the slab: where it is lit */
  lanes3 start;          /* where the ray enters the slab */
  lanes3 step_sheet;     /* to the next sheet along the ray */
  lanes3 towards_eye;    /* unit */
  lanes path;            /* of the eye's ray through the sheet; 0 behind the eye */
} block_geometry;

/* Derived: on the ray E + s W with s = step / H, H = h.W, moving one sheet gives W ds / H. */
LANES_INLINE block_geometry geometry_of_block(const shade_job *job, lanes u, lanes v) {
  const sheet_rays *rays = &job->rays;
  block_geometry g;
  g.position = rays_positions(rays, u, v);
  g.path = path_through_sheet(rays, job->path, job->spacing * 0.5f, u, v); /* the rays end in the slab's middle */
  if (!rays->perspective) {
    g.step_sheet = set3(job->through);
    g.towards_eye = set3(job->towards_eye);
    return g;
  }
  lanes3 w = rays_directions(rays, u, v);
  lanes inverse = 1.0f / (u * rays->hu + (v * rays->hv + rays->h0));
  g.step_sheet = scale3(w, inverse * job->spacing);
  g.towards_eye = scale3(w, -1.0f / lanes_sqrt(dot3(w, w)));
  return g;
}

/* Step 12. df/dframe = (dindex/dframe)^T df/dindex, at a point of frame space; stored units. */
LANES_INLINE lanes3 gradient(const shade_volume *volume, lanes3 point, uint32_t active) {
  lanes at[3];
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    at[axis] = point.x * row[0] + point.y * row[1] + (point.z * row[2] + row[3]);
  }
  lanes3 slope = slopes_at(volume->grid, volume->kernel, (lanes3){at[0], at[1], at[2]}, active);
  const float(*m)[4] = volume->to_index;
  return (lanes3){slope.x * m[0][0] + slope.y * m[1][0] + slope.z * m[2][0],
                  slope.x * m[0][1] + slope.y * m[1][1] + slope.z * m[2][1],
                  slope.x * m[0][2] + slope.y * m[1][2] + slope.z * m[2][2]};
}

/* phi(x) = (1 - exp(-x)) / x, the mean of exp(-x s) over s in [0,1]. */
LANES_INLINE lanes mean_transmittance(lanes x) {
  lanes near = 1.0f - x * (0.5f - x * (1.0f / 6));
  lanes safe = lanes_max(x, lanes_set(0.01f));
  return lanes_select(x < 0.01f, near, (1.0f - lanes_exp_negative(safe)) / safe);
}

/* Light left within the slab, averaged as the eye sees it: with e and l the slab's optical depths for the eye and for
 * the light (derived; exact for any extinction that varies along the normal only). Entering on the same side:
 *     int e exp(-e s) exp(-l s) ds / (1 - exp(-e)) = phi(e + l) / phi(e);
 * entering on opposite sides, exp(-l (1 - s)) in place of exp(-l s):
 *     (exp(-l) - exp(-e)) / (e - l) / phi(e) = exp(-min) phi(|e - l|) / phi(e). */
LANES_INLINE lanes own_transmittance(int back_to_front, lanes e, lanes l) {
  lanes seen = back_to_front ? lanes_exp_negative(lanes_min(e, l)) * mean_transmittance(lanes_abs(e - l))
                             : mean_transmittance(e + l);
  return lanes_min(seen / mean_transmittance(e), lanes_set(1.0f));
}

/* One channel of a shadow buffer at continuous pixel coordinates, 1 outside it. */
LANES_INLINE lanes look_up(const shadow_lookup *lookup, int nearest, const float *buffer, lanes u, lanes v) {
  lanes_int inside = (u > 0.0f) & (v > 0.0f) & (u < (float)lookup->width) & (v < (float)lookup->height);
  lanes x = lanes_clamp(u - 0.5f, 0, (float)(lookup->width - 1)), y = lanes_clamp(v - 0.5f, 0, (float)(lookup->height - 1));
  if (nearest) {
    x = lanes_from_int(lanes_truncate(x + 0.5f));
    y = lanes_from_int(lanes_truncate(y + 0.5f));
  }
  lanes_int column = lanes_truncate(x), row = lanes_truncate(y);
  lanes fx = x - lanes_from_int(column), fy = y - lanes_from_int(row);
  lanes_int at = row * (int32_t)lookup->stride + column;
  lanes a, b, c, d;
  lanes_gather_pairs(buffer, at, &a, &b);
  lanes_gather_pairs(buffer + lookup->stride, at, &c, &d);
  lanes top = a + (b - a) * fx, bottom = c + (d - c) * fx;
  return lanes_select(inside, top + (bottom - top) * fy, lanes_set(1.0f));
}

/* Light reaching the slab: the shadow buffers' transmittance at its first sheet. */
LANES_INLINE color_lanes reaching(const shade_light *light, lanes3 position) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  for (int i = 0; i < light->lookup_count; i++) {
    const shadow_lookup *lookup = &light->lookups[i];
    lanes place[3];
    for (int row = 0; row < 3; row++)
      place[row] = position.x * lookup->map[row][0] + position.y * lookup->map[row][1] +
                   (position.z * lookup->map[row][2] + lookup->map[row][3]);
    lanes_int ahead = place[0] > 0.0f;
    lanes safe = lanes_select(ahead, place[0], lanes_set(1.0f)), outside = lanes_set(-1.0f);
    lanes u = lanes_select(ahead, place[1] / safe, outside), v = lanes_select(ahead, place[2] / safe, outside);
    for (int c = 0; c < light->channels; c++)
      sum.c[c] = sum.c[c] + look_up(lookup, light->nearest, lookup->transmittance[c], u, v) * lookup->weight[c];
  }
  for (int c = 0; c < light->channels && light->lookup_count > 1; c++) sum.c[c] = sum.c[c] / (float)light->lookup_count;
  return sum;
}

/* One volume's way through the slab: where its covered part starts and ends in the tables, and its mean extinction, the
 * part outside the box counting as none. */
typedef struct block_density {
  const shade_patch *patch;
  lanes middle; /* density */
  table_place before, after;
  lanes extinction, undivided; /* averaged over the slab; over its covered part */
  way_sums sums; /* between the two */
  covered_part part;
  lanes seen; /* the part of the way from before to after at which its matter is seen */
  lanes evenly; /* the part at which it would be seen if its extinction were even */
  int sloped; /* whether the gradient is known, where the matter is seen */
  lanes3 slope;
} block_density;

/* In thinner slabs the gradient makes no difference to the light lost within. */
static const float THIN_DEPTH = 1.0f / 64;

_Static_assert(sizeof(block_density) <= SHADE_SCRATCH_BYTES, "a volume's scratch holds its block");

/* Steps 14 and 15's first half: what arrives of one light (eqs. 1 and 2), and from where. */
typedef struct arriving_light {
  lanes3 towards; /* unit */
  color_lanes full, shadowed; /* without and with attenuation */
} arriving_light;

/* How far light has come within the box of a volume when it reaches the ends of a way: back to the box's face. */
typedef struct ways_in_box { lanes first, last; } ways_in_box;

LANES_INLINE ways_in_box ways_of_light(const shade_volume *volume, lanes3 start, lanes3 way, lanes3 towards) {
  ways_in_box ways = {lanes_set(1e30f), lanes_set(1e30f)};
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    lanes at = start.x * row[0] + start.y * row[1] + (start.z * row[2] + row[3]);
    lanes step = way.x * row[0] + way.y * row[1] + way.z * row[2];
    lanes speed = towards.x * row[0] + towards.y * row[1] + towards.z * row[2];
    speed = lanes_select(lanes_abs(speed) < 1e-12f, lanes_set(1e-12f), speed);
    lanes slowness = 1.0f / speed;
    lanes first = (lanes_select(speed > 0.0f, lanes_set(volume->high[axis]), lanes_set(volume->low[axis])) - at) * slowness;
    ways.first = lanes_min(ways.first, lanes_max(first, lanes_set(0)));
    ways.last = lanes_min(ways.last, lanes_max(first - step * slowness, lanes_set(0)));
  }
  return ways;
}

/* Optical depths of the slab for one light: before the eye's rays enter the matter, and from there to where they leave
 * it. At a face of a volume's box the two rays may enter through different faces: each volume's part of the light's
 * way is what lies both in the slab and in the box. */
typedef struct light_depths { lanes before[HL_CHANNELS], within[HL_CHANNELS]; } light_depths;

/* Even extinction of the light's way through the slab that has the right optical depth down to what is seen of a volume
 * (derived). The eye's ray may run along a surface that the light's crosses: a way s before the point seen, the
 * density is f - s g.l to first order, g the gradient, which gives the mean extinction up to there; and where
 * extinction were even, the eye would see another place of the slab: the depths there must agree. */
LANES_INLINE lanes extinction_towards(const block_density *d, lanes3 towards, lanes way) {
  const classifier *classifier = d->patch->volume->classifier;
  if (!d->sloped) return d->undivided;
  lanes late = lanes_min(d->seen / lanes_max(d->evenly, lanes_set(1e-3f)), lanes_set(4.0f));
  lanes seen = d->before.x + (d->after.x - d->before.x) * d->seen;
  lanes start = seen + dot3(d->slope, towards) * (way * classifier->scale);
  way_sums sums = sums_of_way(classifier, place_of_coordinate(lanes_clamp(start, 0, CLASSIFIER_ENTRIES)),
                              place_of_coordinate(seen));
  return late * sums.extinction;
}

LANES_INLINE light_depths depths_of_light(const shade_job *job, const block_geometry *g, const block_density *densities,
                                          int count, lanes3 towards, lanes path) {
  light_depths depths;
  for (int c = 0; c < HL_CHANNELS; c++) depths.before[c] = depths.within[c] = lanes_set(0);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    const shade_volume *volume = d->patch->volume;
    lanes first = d->part.begin * path, last = (d->part.begin + d->part.length) * path;
    if (d->patch->enter != NULL) {
      ways_in_box ways = ways_of_light(volume, add3(g->start, scale3(g->step_sheet, d->part.begin)),
                                       scale3(g->step_sheet, d->part.length), towards);
      first = lanes_min(first, ways.first);
      last = lanes_max(lanes_min(last, ways.last), first);
    }
    lanes extinction = extinction_towards(d, towards, first + (last - first) * d->seen);
    for (int c = 0; c < job->channels; c++) {
      depths.before[c] = depths.before[c] + extinction * volume->cast[c] * first;
      depths.within[c] = depths.within[c] + extinction * volume->cast[c] * (last - first);
    }
  }
  return depths;
}

/* Brightness of a spot light: a smooth step over its cone's edge. */
LANES_INLINE lanes within_cone(const light_cone *cone, lanes3 towards) {
  lanes x = lanes_clamp((-dot3(towards, set3(cone->axis)) - cone->outer) * cone->scale, 0, 1);
  return x * x * (3.0f - 2.0f * x);
}

/* The share of a light's sector (light_sector.h). */
LANES_INLINE lanes share_of_sector(const light_share *share, lanes3 towards) {
  lanes own = lanes_set(0), sum = lanes_set(1e-30f);
  for (int i = 0; i < share->count; i++) {
    lanes above = lanes_max(-dot3(towards, set3(share->axis[i])) - share->least, lanes_set(0));
    sum = sum + above * above;
    if (i == share->sector) own = above * above;
  }
  return own / sum;
}

LANES_INLINE int is_dark(const color_lanes *light) {
  return lanes_bits((light->c[0] > 0.0f) | (light->c[1] > 0.0f) | (light->c[2] > 0.0f)) == 0;
}

LANES_INLINE arriving_light light_at(const shade_job *job, const shade_light *light, const block_geometry *g,
                                     lanes depth, const block_density *densities, int count) {
  arriving_light arriving;
  lanes path = lanes_set(light->path), strength = lanes_set(1.0f);
  if (light->parallel) {
    arriving.towards = set3(light->towards);
  } else {
    lanes3 way = {light->position[0] - g->position.x, light->position[1] - g->position.y,
                  light->position[2] - g->position.z};
    lanes least = lanes_set(LEAST_LIGHT_DISTANCE * LEAST_LIGHT_DISTANCE);
    lanes squared = lanes_max(dot3(way, way), least), distance = lanes_sqrt(squared);
    arriving.towards = scale3(way, 1.0f / distance);
    lanes climb = lanes_abs(dot3(arriving.towards, set3(job->normal)));
    path = lanes_min(light->path / lanes_max(climb, lanes_set(1e-3f)), distance);
    if (light->inverse_square) strength = 1.0f / squared;
    if (light->share.count > 0) strength = strength * share_of_sector(&light->share, arriving.towards);
    if (light->cone.scale > 0) strength = strength * within_cone(&light->cone, arriving.towards);
  }
  for (int c = 0; c < 3; c++) arriving.full.c[c] = strength * light->color[c];
  if (light->screen.pixels != NULL) {
    lanes pattern[3];
    screen_pattern(&light->screen, g->position, pattern);
    for (int c = 0; c < 3; c++) arriving.full.c[c] = arriving.full.c[c] * pattern[c];
  }
  arriving.shadowed = arriving.full;
  if (!light->shadowed || is_dark(&arriving.full)) return arriving;
  light_depths depths = depths_of_light(job, g, densities, count, arriving.towards, path);
  color_lanes reached = reaching(light, g->position);
  lanes transmittance = lanes_set(1.0f);
  for (int c = 0; c < 3; c++) {
    if (c < light->channels)
      transmittance = reached.c[c] * lanes_exp_negative(depths.before[c]) *
                      own_transmittance(job->back_to_front, depth, depths.within[c]);
    arriving.shadowed.c[c] = arriving.shadowed.c[c] * transmittance;
  }
  return arriving;
}

LANES_INLINE lanes power(lanes base, float exponent) {
  lanes safe = lanes_max(base, lanes_set(1e-12f));
  return lanes_keep(base > 1e-12f, lanes_exp2(lanes_max(lanes_log2(safe) * exponent, lanes_set(-100.0f))));
}

/* Unit normal away from the matter; *surface: 1 for a surface, falling to 0 for a medium, which has no normal. The slope is
 * taken in steps of the transfer function's table: squares of data in units of 1e-27 or 1e30 are no floats. Where
 * even those vanish, components are below 1e-19: the normal stays short. */
LANES_INLINE lanes3 normal_of(const shade_volume *volume, lanes3 slope, lanes density, lanes *surface) {
  slope = scale3(slope, lanes_set(fabsf(volume->classifier->scale)));
  lanes steepness = lanes_sqrt(dot3(slope, slope));
  *surface = volume->phong ? lanes_min(steepness / volume->classifier->normal_edge, lanes_set(1.0f)) : lanes_set(0);
  lanes outward = lanes_select(density < 0.0f, lanes_set(1.0f), lanes_set(-1.0f)) / lanes_max(steepness, lanes_set(1e-18f));
  return scale3(slope, outward);
}

/* Step 15: eqs. (3) and (4) at the light's centre; a medium where there is no surface (algorithm, optical model). */
LANES_INLINE color_lanes illuminate(const shade_job *job, const shade_volume *volume, const block_geometry *g,
                                    const arriving_light *lights, color_lanes color, lanes3 slope, lanes density) {
  lanes surface;
  lanes3 normal = normal_of(volume, slope, density, &surface);
  color_lanes lit;
  for (int c = 0; c < 3; c++) lit.c[c] = color.c[c] * (volume->ambient * job->ambient[c]);
  for (int i = 0; i < job->light_count; i++) {
    const color_lanes *intensity = volume->receives_shadow ? &lights[i].shadowed : &lights[i].full;
    lanes facing = dot3(normal, lights[i].towards);
    lanes diffuse = lanes_max(facing, lanes_set(0)) * volume->diffuse * surface + (1.0f - surface);
    lanes3 mirrored = add3(scale3(normal, facing * 2.0f), scale3(lights[i].towards, lanes_set(-1.0f)));
    lanes glint = power(dot3(g->towards_eye, mirrored), volume->shininess) * volume->specular * surface;
    glint = lanes_keep(facing > 0.0f, glint);
    for (int c = 0; c < 3; c++) lit.c[c] = lit.c[c] + intensity->c[c] * (color.c[c] * diffuse + glint);
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
    lanes_store(at, lanes_load(at) * keep + lit.c[c] * weight);
  }
  alpha = alpha * keep + weight;
  lanes_store(pixels + 3 * BLOCK_PIXELS, alpha);
  return alpha;
}

/* Step 13 for one volume; false where none of it is there. */
LANES_INLINE int classify_block(const shade_job *job, const shade_patch *patch, int block, block_density *d) {
  const shade_volume *volume = patch->volume;
  lanes before = lanes_load(patch->before + block * BLOCK_PIXELS);
  lanes after = lanes_load(patch->current + block * BLOCK_PIXELS);
  d->patch = patch;
  d->middle = (before + after) * 0.5f;
  d->before = classify_place(volume->classifier, before);
  d->after = classify_place(volume->classifier, after);
  if (lanes_bits(may_be_visible(volume->classifier, d->before, d->after)) == 0) return 0;
  d->part = covered_block(patch->enter, patch->leave, block, job->height, job->spacing);
  if (patch->enter != NULL) cut_way(d->part, &d->before, &d->after);
  d->sums = sums_of_way(volume->classifier, d->before, d->after);
  d->undivided = d->sums.extinction;
  d->extinction = d->undivided * d->part.length;
  return lanes_bits(d->extinction > 0.0f) != 0;
}

/* base^exponent for base in [0, 1] and exponent >= 0. */
LANES_INLINE lanes power_of_part(lanes base, lanes exponent) {
  return lanes_exp2(lanes_max(lanes_log2(lanes_max(base, lanes_set(1e-6f))) * exponent, lanes_set(-100.0f)));
}

/* Where in its optical depth a slab is seen on average, 0 (first) to 1: int e s exp(-e s) ds / (1 - exp(-e)) =
 * 1 / e - exp(-e) / (1 - exp(-e)) (derived); 1/2 - e / 12 for small e. */
LANES_INLINE lanes seen_part(lanes e) {
  lanes safe = lanes_max(e, lanes_set(0.05f)), left = lanes_exp_negative(safe);
  return lanes_select(e < 0.05f, 0.5f - e * (1.0f / 12), 1.0f / safe - left / (1.0f - left));
}

/* A dense slab is seen at its front, and its matter may lie at one end. Extinction is taken to rise as t^q along the way
 * with the mean m = (q + 1) / (q + 2) that the tables give, so that a part u of the depth is reached at
 * t = u^((1 - m) / m) (derived; mirrored where it falls). Returns where that is: the volumes' mean, in slabs. */
LANES_INLINE lanes place_of_part(block_density *densities, int count, lanes total, lanes u) {
  lanes sum = lanes_set(0);
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    const shade_volume *volume = d->patch->volume;
    d->seen = lanes_set(0.5f);
    d->evenly = u;
    if (!volume->visible) continue;
    lanes m = part_of_way(d->before, d->after, mean_place(d->before, d->after, &d->sums));
    lanes_int rising = m >= 0.5f;
    lanes side = lanes_max(lanes_select(rising, m, 1.0f - m), lanes_set(0.5f));
    lanes t = power_of_part(lanes_select(rising, u, 1.0f - u), (1.0f - side) / side);
    d->seen = lanes_select(rising, t, 1.0f - t);
    sum = sum + d->extinction * (d->part.begin + d->part.length * d->seen);
  }
  return sum / lanes_max(total, lanes_set(1e-30f));
}

/* A volume's gradient where its matter is seen; 0 for a medium. */
LANES_INLINE lanes3 slope_of_block(const block_density *d) {
  if (d->patch->volume->phong && d->sloped) return d->slope;
  return (lanes3){lanes_set(0), lanes_set(0), lanes_set(0)};
}

/* Step 12 where shading asks for it: surfaces, and dense slabs whose light must be told from the eye's way. */
LANES_INLINE void find_slopes(const shade_job *job, const block_geometry *g, block_density *densities, int count,
                              uint32_t seen) {
  int shadowed = 0;
  for (int i = 0; i < job->light_count; i++) shadowed |= job->lights[i].shadowed;
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    const shade_volume *volume = d->patch->volume;
    uint32_t active = volume->visible ? seen & lanes_bits(d->extinction > 0.0f) : 0;
    uint32_t dense = shadowed ? active & lanes_bits(d->extinction * g->path > THIN_DEPTH) : 0;
    d->sloped = (volume->phong ? active : dense) != 0;
    if (d->sloped)
      d->slope = gradient(volume, add3(g->start, scale3(g->step_sheet, d->part.begin + d->part.length * d->seen)), active);
  }
}

/* Colours of the volumes, lit and averaged weighted by extinction. */
static color_lanes color_of_block(const shade_job *job, const block_geometry *g, const arriving_light *lights,
                                  const block_density *densities, int count, lanes total) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  lanes inverse = 1.0f / lanes_max(total, lanes_set(1e-30f));
  for (int i = 0; i < count; i++) {
    block_density d = densities[i];
    const shade_volume *volume = d.patch->volume;
    if (!volume->visible) continue;
    table_place place = place_of_coordinate(d.before.x + (d.after.x - d.before.x) * d.seen);
    color_lanes color;
    table_values(volume->classifier->color, place, color.c);
    color_lanes lit = illuminate(job, volume, g, lights, color, slope_of_block(&d), d.middle);
    lanes weight = count == 1 ? lanes_set(1.0f) : d.extinction * inverse;
    for (int c = 0; c < 3; c++) sum.c[c] = sum.c[c] + lit.c[c] * weight;
  }
  return sum;
}

/* A block's way through the slab: geometry, and how much is seen of it where. */
typedef struct block_slab {
  block_geometry geometry; /* its position: where the slab is seen on average, and lit */
  lanes total, depth;      /* extinction averaged over the slab; optical depth */
  lanes opacity;           /* 0 where nothing is seen */
  lanes_int seen;
  int count;               /* of volumes that are there */
} block_slab;

/* Returns the pixels in which something is seen, one bit each; the slab is filled if there are any. alpha: of the
 * pixels so far. */
LANES_INLINE uint32_t slab_of_block(const shade_job *job, const shade_patch *patches, int patch_count, int tile_x,
                                    int tile_y, int block, const float *alpha, block_density *densities,
                                    block_slab *slab) {
  int x = tile_x * TILE + block % 4 * BLOCK, y = tile_y * TILE + block / 4 * BLOCK, count = 0;
  lanes total = lanes_set(0);
  for (int i = 0; i < patch_count; i++) {
    if (!(patches[i].blocks >> block & 1) || !classify_block(job, &patches[i], block, &densities[count])) continue;
    if (patches[i].volume->visible) total = total + densities[count].extinction;
    count++;
  }
  slab->seen = total > 0.0f;
  if (!job->back_to_front) slab->seen &= lanes_load(alpha) < OPAQUE;
  uint32_t bits = lanes_bits(slab->seen);
  if (bits == 0) return 0;
  block_geometry *g = &slab->geometry;
  *g = geometry_of_block(job, block_u(x), block_v(y));
  slab->count = count;
  slab->total = total;
  slab->depth = total * g->path;
  slab->opacity = lanes_keep(slab->seen, 1.0f - lanes_exp_negative(slab->depth));
  lanes u = seen_part(slab->depth);
  if (job->back_to_front) u = 1.0f - u;
  lanes seen_at = place_of_part(densities, count, total, u);
  g->start = add3(g->position, scale3(g->step_sheet, lanes_set(-0.5f)));
  g->position = add3(g->start, scale3(g->step_sheet, seen_at));
  find_slopes(job, g, densities, count, bits);
  return bits;
}

/* Returns true while some pixel of the block is not opaque. */
static int shade_block(const shade_job *job, const shade_patch *patches, int patch_count, int tile_x, int tile_y, int block,
                       block_density *densities, float *pixels, uint64_t *samples) {
  block_slab slab;
  uint32_t bits = slab_of_block(job, patches, patch_count, tile_x, tile_y, block, pixels + 3 * BLOCK_PIXELS, densities,
                                &slab);
  if (bits == 0) return 1;
  arriving_light lights[MAXIMUM_SWEEP_LIGHTS];
  for (int i = 0; i < job->light_count; i++)
    lights[i] = light_at(job, &job->lights[i], &slab.geometry, slab.depth, densities, slab.count);
  color_lanes lit = color_of_block(job, &slab.geometry, lights, densities, slab.count, slab.total);
  for (int c = 0; c < 3; c++) lit.c[c] = lanes_keep(slab.seen, lit.c[c]);
  lanes alpha = composite(job->back_to_front, slab.opacity, lit, pixels);
  *samples += (uint64_t)__builtin_popcount(bits);
  return job->back_to_front || lanes_bits(alpha < OPAQUE) != 0;
}

static uint32_t shade_tile(const shade_job *job, const shade_patch *patches, int patch_count, int tile_x, int tile_y,
                           uint32_t blocks, void *scratch, float *pixels, uint64_t *samples) {
  block_density *densities = scratch;
  uint32_t open = 0;
  for (; blocks != 0; blocks &= blocks - 1) {
    int block = __builtin_ctz(blocks);
    if (shade_block(job, patches, patch_count, tile_x, tile_y, block, densities, pixels + block * 4 * BLOCK_PIXELS, samples))
      open |= 1u << block;
  }
  return open;
}

#endif
