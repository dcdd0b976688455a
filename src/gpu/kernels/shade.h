/* gpu/kernels/shade.h - does steps 12 to 16 for one pixel: finds the place where a slab is seen, its gradient
 * and its colour, and the light that it sends to the eye. The functions compute the same numbers as
 * render/slab_lanes.h and render/shade_lanes.h, but for one pixel and one volume. */
#ifndef HL_GPU_SHADE_H
#define HL_GPU_SHADE_H

#include "core/sheet_constants.h"
#include "gpu/kernels/phase.h"
#include "gpu/kernels/sky.h"
#include "gpu/kernels/surface.h"
#include "gpu/kernels/texture.h"

/* ---- where the slab is seen ---- */

/* rays: the rays of the slab's middle. */
DEVICE void find_geometry(GLOBAL const device_sweep *plan, GLOBAL const plan_rays *rays, float u, float v,
                          slab_sample *s) {
  s->position = position_on(rays, EYE_PERSPECTIVE, u, v);
#if EYE_PERSPECTIVE
  vector w = direction_of(rays, u, v);
  float climb = climb_of(rays, u, v), inverse = divided(1.0f, climb), length = root(dot3(w, w));
  s->path = is_ahead(rays, climb, plan->spacing * 0.5f) ? length * magnitude(inverse) * plan->path : 0.0f;
  s->step_sheet = scaled(w, inverse * plan->spacing);
  s->towards_eye = scaled(w, divided(-1.0f, length));
#else
  s->path = plan->path;
  s->step_sheet = vector_at(plan->through);
  s->towards_eye = vector_at(plan->towards_eye);
#endif
}

/* The fraction of a slab's optical depth e that lies, on average, before the place where the slab is seen.
 * left: exp(-e). */
DEVICE float seen_part(float e, float left) {
  if (e < 0.05f) return fused(e, -1.0f / 12, 0.5f);
  float lost = 1.0f - left;
  return divided(fused(-lesser(e, 100.0f), left, lost), greater(e, 0.05f) * lost);
}

/* The fraction of the way through a slab after which the fraction u of its optical depth is reached. from_a,
 * from_b: the matter's mean distances from the two ends of the way. */
DEVICE float way_of_depth(float from_a, float from_b, float u) {
  int rising = from_a >= from_b;
  float t = power_of_part(rising ? u : 1.0f - u, divided(lesser(from_a, from_b), greater(from_a, from_b)));
  return rising ? t : 1.0f - t;
}

DEVICE void place_slab(GLOBAL const device_sweep *plan, GLOBAL const plan_rays *rays, float u, float v,
                       slab_sample *s) {
  find_geometry(plan, rays, u, v, s);
  s->depth = s->extinction * s->path;
  s->left = exp_negative(s->depth);
  s->opacity = 1.0f - s->left;
  float part = seen_part(s->depth, s->left);
  if (BACK_TO_FRONT) part = 1.0f - part;
  s->evenly = part;
  way_means means = means_of_way(s->before, s->after, &s->sums);
  s->seen = way_of_depth(means.from_a, means.from_b, part);
  s->place = fused(s->part.length, s->seen, s->part.begin);
  s->start = add_scaled(s->position, s->step_sheet, -0.5f);
  s->position = add_scaled(s->start, s->step_sheet, s->place);
}

/* Applies factors on extinction (matter_factor) after place_slab(), as weigh_slab() in render/slab_lanes.h.
 * Finds the factor at the place where the matter would be seen without this factor, multiplies the extinction
 * by this factor, and places the slab again. */
DEVICE void weigh_slab(GLOBAL const device_sweep *plan, GLOBAL const plan_rays *rays, float u, float v,
                       const volume_data *volume, slab_sample *s) {
  const matter_factor found = factor_of_matter(volume, s->position, s->before, s->after, s->sums.extinction);
  s->slope = found.slope;
  s->row = found.row;
  s->factor = found.factor;
  if (s->factor == 1.0f) return;
  s->extinction = s->extinction * s->factor;
  s->sums.extinction = s->sums.extinction * s->factor;
  s->sums.integral = s->sums.integral * s->factor;
  s->sums.moment = s->sums.moment * s->factor;
  place_slab(plan, rays, u, v, s);
}

/* Finds the gradient where it is needed, as find_slopes() in render/slab_lanes.h. If the factor on extinction
 * depends on the gradient, the gradient is known already. */
DEVICE void find_slope(const volume_data *volume, slab_sample *s) {
  const int phong = PHONG && HAS(volume->plan, phong), lit = LIT && HAS(volume->plan, lit);
  s->sloped = s->sums.extinction > 0.0f;
  if (knows_gradient(volume)) return;
  s->slope = vector_of(0.0f, 0.0f, 0.0f);
  if (!phong) s->sloped = s->sloped && s->sums.extinction * s->part.length * s->path > THIN_DEPTH;
  if (!((phong || (lit && SHADOWED)) && HAS(volume->plan, visible))) s->sloped = 0;
  if (s->sloped) s->slope = gradient_at(*volume, s->position);
}

DEVICE void find_normal(const volume_data *volume, float density, slab_sample *s) {
  find_slope(volume, s);
  s->normal = vector_of(0.0f, 0.0f, 0.0f);
  s->surface = 0.0f;
  s->behind = FACE_VOXELS;
#if PHONG
  if (!(HAS(volume->plan, phong) && HAS(volume->plan, visible))) return;
  vector slope = scaled(s->slope, magnitude(volume->plan->scale));
  const float outward = density < 0.0f ? 1.0f : -1.0f;
#if MASKED
  if (volume->plan->mask.faces) {
    const mask_data mask = mask_of_volume(volume);
    slope = add_scaled(slope, mask_slope(&mask, s->position),
                       -outward * magnitude(density) * (magnitude(volume->plan->scale) * 0.5f));
  }
#endif
  const float steepness = root(dot3(slope, slope));
  s->surface = lesser(steepness * divided(1.0f, volume->plan->normal_edge), 1.0f);
  s->normal = scaled(slope, divided(outward, greater(steepness, 1e-18f)));
  if (volume->plan->any_face) find_cut_face(volume, s);
#else
  (void)density;
#endif
}

/* ---- colour ---- */

DEVICE void shown_below(GLOBAL const float *tables, float x, float sums[4]) {
  table_values(shown_table(tables), split_coordinate(x), 4, sums);
}

/* Finds the visible part of a way's optical depth, as coordinates in the tables. Returns the coordinate of
 * its end. *from: receives the coordinate of its beginning. */
DEVICE float end_of_shown(const slab_sample *s, float *from) {
  way_means means = means_of_way(s->before, s->after, &s->sums);
  int front = s->evenly <= 0.5f;
  float part = limited(fused(s->evenly, 2.0f, front ? 0.0f : -1.0f), 0.0f, 1.0f);
  *from = front ? s->before : s->after;
  return fused(s->after - s->before, way_of_depth(means.from_a, means.from_b, part), s->before);
}

/* The mean colour of the visible part of the matter. */
DEVICE vector color_of_way(const volume_data *volume, const slab_sample *s) {
  GLOBAL const float *tables = volume->tables;
  float values[4];
  table_values(color_table(tables), split_coordinate(coordinate_seen(s)), 3, values);
  vector color = vector_of(values[0], values[1], values[2]);
  if (!volume->plan->bends) return color;
  float bent = bent_table(tables)[(int)s->after] - bent_table(tables)[(int)s->before];
  if (!(magnitude(bent * (s->after - s->before)) > CLASSIFIER_LEAST_BENDING)) return color;
  float from, to = end_of_shown(s, &from);
  float at_from[4], at_to[4];
  shown_below(tables, from, at_from);
  shown_below(tables, to, at_to);
  float shown = at_to[3] - at_from[3];
  if (!(magnitude(shown) > at_to[3] * LEAST_PART_OF_SHOWN)) return color;
  float inverse = divided(1.0f, shown);
  return vector_of(greater((at_to[0] - at_from[0]) * inverse, 0.0f),
                   greater((at_to[1] - at_from[1]) * inverse, 0.0f),
                   greater((at_to[2] - at_from[2]) * inverse, 0.0f));
}

/* ---- lights ---- */

DEVICE float within_cone(GLOBAL const plan_light *light, vector towards) {
  float x = limited((-dot3(towards, vector_at(light->cone_axis)) - light->cone_outer) * light->cone_scale,
                    0.0f, 1.0f);
  return x * x * fused(x, -2.0f, 3.0f);
}

DEVICE float fraction_of_sector(GLOBAL const plan_light *light, vector towards) {
  float own = 0.0f, sum = 1e-30f;
  for (int i = 0; i < light->sector_count; i++) {
    float above = greater(-dot3(towards, vector_at(light->sector_axis[i])) - light->sector_least, 0.0f);
    sum = fused(above, above, sum);
    if (i == light->sector) own = above * above;
  }
  return divided(own, sum);
}

#if PHASES
DEVICE phase_data phases_of_volume(GLOBAL const device_sweep *plan, const volume_data *volume) {
  phase_data phases;
  phases.table = volume->phases;
  phases.lights = plan->light_count;
  phases.rows_per_log2 = volume->plan->phase_rows;
  return phases;
}
#endif

/* Finds the direction from which a light comes at a position. Returns the length of its way through the
 * slab. */
DEVICE float find_direction(GLOBAL const device_sweep *plan, GLOBAL const plan_light *light, vector position,
                            vector *towards, float *strength) {
  *strength = 1.0f;
  if (light->parallel) {
    *towards = vector_at(light->towards);
    return light->path;
  }
  vector way = vector_of(light->position[0] - position.x, light->position[1] - position.y,
                         light->position[2] - position.z);
  float squared = greater(dot3(way, way), LEAST_LIGHT_DISTANCE * LEAST_LIGHT_DISTANCE),
        distance_to = root(squared);
  *towards = scaled(way, divided(1.0f, distance_to));
  float climb = magnitude(dot3(*towards, vector_at(plan->normal)));
  float path = lesser(divided(light->path, greater(climb, 1e-3f)), distance_to);
  if (light->inverse_square) *strength = divided(1.0f, squared);
  if (light->sector_count > 0) *strength = *strength * fraction_of_sector(light, *towards);
  if (light->cone_scale > 0) *strength = *strength * within_cone(light, *towards);
  return path;
}

/* The light that arrives at a sample's medium, and the light that arrives at the outside of its surface. */
typedef struct arriving_light {
  float on_medium[3], on_surface[3];
} arriving_light;

/* Multiplies a light's `arriving` light by the transmittance of the matter on the light's way to a sample.
 */
DEVICE void shadow_sample(GLOBAL const device_sweep *plan, const volume_data *volume,
                          GLOBAL const plan_light *light, const light_buffers *buffers, const slab_sample *s,
                          vector towards, float path, arriving_light *arriving) {
  float passing[CHANNELS], transmittance = 1.0f;
  if (s->surface < 1.0f) {
    passing_light(volume, vector_at(plan->normal), light, s, towards, path, buffers, passing);
    for (int c = 0; c < 3; c++) {
      if (c < CHANNELS) transmittance = passing[c];
      arriving->on_medium[c] = arriving->on_medium[c] * transmittance;
    }
  }
#if OUTSIDE
  if (!(s->surface > 0.0f)) return;
  passing_to_surface(volume, light, s, towards, s->place * path, buffers, passing);
  for (int c = 0; c < 3; c++) {
    if (c < CHANNELS) transmittance = passing[c];
    arriving->on_surface[c] = arriving->on_surface[c] * transmittance;
  }
#endif
}

/* A light at a sample, before anything attenuates it. */
typedef struct full_light {
  vector towards;
  float path; /* the length of the light's way through the slab */
  arriving_light arriving;
} full_light;

DEVICE full_light light_at_sample(GLOBAL const device_sweep *plan, GLOBAL const plan_light *light,
                                  const light_buffers *buffers, const slab_sample *s) {
  full_light full;
  float strength;
  full.path = find_direction(plan, light, s->position, &full.towards, &strength);
  for (int c = 0; c < 3; c++) full.arriving.on_medium[c] = strength * light->color[c];
#if TEXTURES
  float pattern[3];
  if (pattern_of_texture(buffers->textures, plan->light_count, light->number, s->position, pattern))
    for (int c = 0; c < 3; c++) full.arriving.on_medium[c] = full.arriving.on_medium[c] * pattern[c];
#else
  (void)buffers;
#endif
  for (int c = 0; c < 3; c++) full.arriving.on_surface[c] = full.arriving.on_medium[c];
  return full;
}

DEVICE int is_bright(const arriving_light *light) {
  return light->on_medium[0] > 0.0f || light->on_medium[1] > 0.0f || light->on_medium[2] > 0.0f;
}

/* Adds the light that a sample sends on to the eye from the light that arrives. */
DEVICE void add_arriving(GLOBAL const device_sweep *plan, const volume_data *volume,
                         GLOBAL const plan_light *light, const arriving_light *arriving, const slab_sample *s,
                         vector towards, vector color, vector *lit) {
  GLOBAL const plan_volume *matter = volume->plan;
  float facing = dot3(s->normal, towards), medium = 1.0f - s->surface;
#if PHASES
  if (VOLUMES == 1 || matter->anisotropy != 0) {
    const phase_data phases = phases_of_volume(plan, volume);
    medium = medium * phase_of_light(&phases, matter->anisotropy, light, light->number, towards, s->position,
                                     s->towards_eye);
  }
#else
  (void)plan;
  if (matter->anisotropy != 0) medium = medium * phase_of(matter->anisotropy, dot3(s->towards_eye, towards));
#endif
  if (light->of_sky > 0) medium = medium * light->of_sky;
#if PHONG
  float diffuse = greater(facing, 0.0f) * matter->diffuse * s->surface, glint = 0.0f;
  if (facing > 0.0f && !(light->of_sky > 0)) {
    vector mirrored = add_scaled(scaled(towards, -1.0f), s->normal, facing * 2.0f);
    glint = power_of(dot3(s->towards_eye, mirrored), matter->shininess) * matter->specular * s->surface;
  }
#else
  (void)facing;
#endif
  float of_color[3], sum[3];
  of_color[0] = color.x;
  of_color[1] = color.y;
  of_color[2] = color.z;
  sum[0] = lit->x;
  sum[1] = lit->y;
  sum[2] = lit->z;
  for (int c = 0; c < 3; c++) {
    float even = matter->absorbs ? fused(medium, matter->albedo[c] - 1, medium) : medium;
    sum[c] = fused(arriving->on_medium[c], of_color[c] * even, sum[c]);
#if PHONG
    if (HAS(matter, phong))
      sum[c] = fused(arriving->on_surface[c], fused(of_color[c], diffuse, glint), sum[c]);
#endif
  }
  *lit = vector_of(sum[0], sum[1], sum[2]);
}

/* Adds the light that a sample sends on from one light to the eye. */
DEVICE void add_light(GLOBAL const device_sweep *plan, const volume_data *volume,
                      GLOBAL const plan_light *light, const light_buffers *buffers, const slab_sample *s,
                      vector color, vector *lit) {
  full_light full = light_at_sample(plan, light, buffers, s);
  if (!(s->surface < 1.0f || dot3(s->normal, full.towards) > 0.0f)) return;
#if SHADOWED
  if (light->shadowed && volume->plan->receives_shadow && is_bright(&full.arriving))
    shadow_sample(plan, volume, light, buffers, s, full.towards, full.path, &full.arriving);
#endif
  add_arriving(plan, volume, light, &full.arriving, s, full.towards, color, lit);
}

/* The colour of a volume's matter at a sample. */
DEVICE vector color_of_matter(const volume_data *volume, const slab_sample *s) {
  vector color;
#if PLANE
  if (HAS(volume->plan, plane)) {
    const plane_data plane = plane_of_volume(volume);
    float from, to = end_of_shown(s, &from);
    color = color_in_row(&plane, s->row, from, to, s->before, s->after);
  } else
#endif
    color = color_of_way(volume, s);
#if COLORED
  GLOBAL const plan_volume *matter = volume->plan;
  if (HAS(matter, colored)) {
    float of_voxels[3];
    color_between_voxels(volume->colors, matter->color_decode, matter->color_last, matter->to_index,
                         s->position, of_voxels);
    color = vector_of(color.x * of_voxels[0], color.y * of_voxels[1], color.z * of_voxels[2]);
  }
#endif
#if MASKED
  if (volume->plan->mask.tints) {
    const mask_data mask = mask_of_volume(volume);
    color = tinted_by_mask(&mask, s->position, color);
  }
#endif
  return color;
}

/* The light that a volume sends to the eye without any light source: ambient light, and its emission. */
DEVICE vector even_light(GLOBAL const device_sweep *plan, const volume_data *volume, vector color) {
  GLOBAL const plan_volume *matter = volume->plan;
  float own = matter->emission * plan->emission;
  return vector_of(color.x * (matter->ambient * plan->ambient[0] + own),
                   color.y * (matter->ambient * plan->ambient[1] + own),
                   color.z * (matter->ambient * plan->ambient[2] + own));
}

/* The buffers of one light. buffers: the first of the buffers of all lights. slot: the slot, in the buffers'
 * rings, of the sheet before the slab. young: as in plan_rays. */
DEVICE light_buffers buffers_of_light(GLOBAL const plan_light *light, const light_buffers *buffers, int slot,
                                      float young) {
  light_buffers own;
  own.planes = buffers->planes + (wide)light->planes * 16 +
               (wide)slot * (wide)(light->plane * PLANES_OF_SHEET);
  own.young = young;
#if TEXTURES
  own.textures = buffers->textures;
#endif
#if SUBLIGHTS
  own.sublights = buffers->sublights + light->first_sublight;
  own.of_sublights = buffers->of_sublights + (wide)light->sublight_planes * 16 +
                     (wide)slot * (wide)light->sublights * (PLANES_OF_SHEET * (wide)light->sublight_plane);
#endif
  return own;
}

#if SKY

/* Adds the light of the sky that a sample sends on. sky: the cells of the sky's field. */
DEVICE vector with_sky(GLOBAL const device_sweep *plan, const volume_data *volume, GLOBAL const short *sky,
                       const slab_sample *s, vector color, vector lit) {
  const sky_data field = {&plan->sky, sky};
#if PHASES
  const phase_data phases = phases_of_volume(plan, volume);
  const vector of_sky = sky_of_sample(&field, volume, &phases, s);
#else
  const vector of_sky = sky_of_sample(&field, volume, s);
#endif
  return vector_of(fused(of_sky.x, color.x, lit.x), fused(of_sky.y, color.y, lit.y),
                   fused(of_sky.z, color.z, lit.z));
}

#endif

/* The light that a sample sends to the eye. sky: the cells of the sky's field. buffers: the first of the
 * buffers of all lights. slot: the slot, in the buffers' rings, of the sheet before the slab. rays: the eye's
 * rays in index space at the slab's second sheet. */
DEVICE vector color_of_slab(GLOBAL const device_sweep *plan, const volume_data *volume,
                            GLOBAL const short *sky, const light_buffers *buffers,
                            GLOBAL const plan_rays *rays, int slot, const slab_sample *s) {
  const vector color = color_of_matter(volume, s);
  vector lit = even_light(plan, volume, color);
#if LIT
  for (int i = 0; i < plan->light_count; i++) {
    GLOBAL const plan_light *light = &plan->lights[i];
    const light_buffers own = buffers_of_light(light, buffers, slot,
                                               SOFT ? rays[(3 + 2 * i) * plan->sheets].young : 0.0f);
    add_light(plan, volume, light, &own, s, color, &lit);
  }
#else
  (void)buffers;
  (void)slot;
#endif
#if SKY
  lit = with_sky(plan, volume, sky, s, color, lit);
#else
  (void)sky;
#endif
  (void)rays;
  return lit;
}

#endif
