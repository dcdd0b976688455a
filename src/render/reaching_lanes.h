/* render/reaching_lanes.h - finds the light that reaches a slab by looking up shadow buffers at samples (step
 * 14). */
#ifndef HL_RENDER_REACHING_LANES_H
#define HL_RENDER_REACHING_LANES_H

#include "core/sheet_constants.h"
#include "render/light_depth_lanes.h"
#include "simd/gathers.h"

LANES_INLINE shadow_taps taps_of_position(const shade_light *light, const shadow_map *map, lanes3 position) {
  lanes place[3];
  for (int row = 0; row < 3; row++) place[row] = row_of_point(map->rows[row], position);
  if (light->parallel)
    return taps_at_position(map, light->nearest, place[1], place[2]); /* place[0] is 1 everywhere */
  lanes_int ahead = place[0] > 0.0f;
  lanes safe = lanes_select(ahead, place[0], lanes_set(1.0f)), outside = lanes_set(-1.0f);
  return taps_at_position(map, light->nearest, lanes_select(ahead, place[1] / safe, outside),
                          lanes_select(ahead, place[2] / safe, outside));
}

/* The mean over all sub-lights of a light. It is the mean of the transmittance from the sub-light, or if
 * `outside` is 1, of the sub-light's light at the outside of surfaces. */
LANES_INLINE color_lanes mean_of_sublights(const shade_light *light, lanes3 position, uint32_t active,
                                           int outside) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  for (int i = 0; i < light->sublight_count; i++) {
    const sublight_lookup *sublight = &light->sublights[i];
    const sublight_pixel *const *planes = outside ? sublight->outside : sublight->transmittance;
    shadow_taps taps = taps_of_position(light, &sublight->map, position);
    for (int c = 0; c < light->channels; c++)
      sum.c[c] = lanes_add_scaled(sum.c[c], look_up_sublight(&sublight->map, &taps, planes[c], active),
                                  sublight->weight[c]);
  }
  for (int c = 0; c < light->channels; c++)
    sum.c[c] = sum.c[c] / ((float)SUBLIGHT_ONE * (float)light->sublight_count);
  return sum;
}

/* Interpolates between the light in the buffer of the previous chunk (older) and the light in the buffer of
 * this chunk (younger). */
LANES_INLINE lanes between_chunks(const shadow_lookup *lookup, lanes older, lanes younger) {
  return lanes_add_scaled(older, younger - older, lookup->young);
}

LANES_INLINE lanes look_up_plane(const shadow_lookup *lookup, const shadow_taps *taps, int cubic,
                                 const float *plane) {
  return cubic ? look_up_cubic(&lookup->map, taps, plane) : look_up(&lookup->map, taps, plane);
}

/* The interpolated transmittance of one channel of the buffer. */
LANES_INLINE lanes interpolated(const shadow_lookup *lookup, const shadow_taps *taps, int cubic,
                                int channel) {
  lanes light = look_up_plane(lookup, taps, cubic, lookup->transmittance[channel]);
  if (lookup->older[channel] == NULL) return light;
  return between_chunks(lookup, look_up_plane(lookup, taps, cubic, lookup->older[channel]), light);
}

LANES_INLINE void near_light(const shadow_lookup *lookup, const shadow_taps *taps, const float *buffer,
                             lanes light[NEAR_PIXELS]) {
  lanes_int at = taps->first.row * (int32_t)lookup->map.stride + taps->first.column;
  lanes_gather_pairs(buffer, at, &light[0], &light[1]);
  lanes_gather_pairs(buffer + lookup->map.stride, at, &light[2], &light[3]);
}

/* Near a box's face: finds the optical depths from the face to the slab, from the lengths of the light's
 * ways. found: the transmittance that the buffer holds. own: the transmittance that the matter of the box
 * would have if it were even and nothing else were in the way. If `found` is greater than `own`, the matter
 * near the face is thinner, and the depths are scaled by the ratio of the two optical depths. */
LANES_INLINE void pass_face(light_depths *depths, int channel, lanes found, lanes own) {
  lanes_int some = own < 0.999f;
  lanes ratio = lanes_log2(lanes_clamp(found, 1e-6f, 1)) / lanes_log2(lanes_clamp(own, 1e-36f, 0.999f));
  ratio = lanes_keep(depths->face, lanes_select(some, lanes_min(ratio, lanes_set(1.0f)), lanes_set(1.0f)));
  depths->enter[channel] = lanes_fma(ratio, depths->before_enter[channel], depths->enter[channel]);
  depths->more[channel] = lanes_fma(ratio, depths->before_more[channel], depths->more[channel]);
}

/* The light that reaches the slab near a box's face. Derived: at each pixel the transmittance is T = O E,
 * where E = exp(-depth) is the transmittance of the box's matter and O the transmittance of everything else.
 * If O is the same at all pixels, the weighted mean of T is O times the weighted mean of E. */
LANES_INLINE lanes reaching_face(const shadow_lookup *lookup, const shadow_taps *taps, light_depths *depths,
                                 int channel) {
  lanes light[NEAR_PIXELS], own[NEAR_PIXELS];
  near_light(lookup, taps, lookup->transmittance[channel], light);
  if (lookup->older[channel] != NULL) {
    lanes older[NEAR_PIXELS];
    near_light(lookup, taps, lookup->older[channel], older);
    for (int i = 0; i < NEAR_PIXELS; i++) light[i] = between_chunks(lookup, older[i], light[i]);
  }
  for (int i = 0; i < NEAR_PIXELS; i++) own[i] = exp_of_depth(depths->near[channel][i]);
  lanes sum = between_taps(taps, light[0], light[1], light[2], light[3], 1);
  lanes of_own = between_taps(taps, own[0], own[1], own[2], own[3], 1);
  pass_face(depths, channel, sum, of_own);
  lanes reached = lanes_min(sum / lanes_max(of_own, lanes_set(DARK)), lanes_set(1.0f));
  return lanes_select(taps->inside, reached, lanes_set(1.0f));
}

/* Corrects the light near a box's face for sub-lights, as reaching_face() does for one buffer. The buffers of
 * different sub-lights have their pixels at different positions around the sample. So one correction serves
 * all sub-lights: the mean of the corrections over the near pixels. */
LANES_INLINE void correct_faces(light_depths *depths, int channels, color_lanes *reached) {
  for (int c = 0; c < channels; c++) {
    lanes own = lanes_set(0);
    for (int i = 0; i < NEAR_PIXELS; i++) own = own + exp_of_depth(depths->near[c][i]);
    pass_face(depths, c, reached->c[c], own * (1.0f / NEAR_PIXELS));
    reached->c[c] = lanes_min(reached->c[c] / lanes_max(own * (1.0f / NEAR_PIXELS), lanes_set(1e-6f)),
                              lanes_set(1.0f));
  }
}

/* The position at which a slab's samples look up a light in the shadow buffer; it lies on the slab's first
 * sheet. */
typedef struct light_place {
  const shade_light *light;
  const shadow_lookup *lookup; /* the position of the look-up on this sheet */
  lanes3 position;             /* position of the samples */
  shadow_taps taps;
  uint32_t active; /* the lanes with samples */
} light_place;

/* The light that reaches the slab's first sheet, as media receive it. */
LANES_INLINE color_lanes reaching(const light_place *place, light_depths *depths) {
  const shade_light *light = place->light;
  uint32_t faces = lanes_bits(depths->face) & place->active;
  color_lanes reached = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  if (light->sublight_count > 0) {
    reached = mean_of_sublights(light, place->position, place->active, 0);
    if (faces != 0) correct_faces(depths, light->channels, &reached);
    return reached;
  }
  lanes_int faint = depths->face & (depths->beside < 1.0f);
  int fades = light->cubic && (lanes_bits(faint) & place->active) != 0;
  for (int c = 0; c < light->channels; c++) {
    if (faces != place->active || fades)
      reached.c[c] = interpolated(place->lookup, &place->taps, light->cubic, c);
    if (faces == 0) continue;
    lanes at_face = reaching_face(place->lookup, &place->taps, depths, c);
    /* Adds the difference between the cubic look-up and the bilinear one. The more a face of a box counts,
     * the less the difference counts. */
    if (fades) {
      lanes differ = reached.c[c] - interpolated(place->lookup, &place->taps, 0, c);
      at_face = lanes_max(at_face + lanes_keep(faint, differ * (1.0f - depths->beside)), lanes_set(0));
    }
    reached.c[c] = lanes_select(depths->face, at_face, reached.c[c]);
  }
  return reached;
}

/* The transmittance from one light to the media of a slab. It is the product of two transmittances: of
 * everything before the slab, and of the slab's own matter. The second one is averaged with the weights with
 * which the eye sees the matter. path: length of the light's way through the slab. */
LANES_INLINE color_lanes passing_to_media(const shade_job *job, const light_place *place,
                                          const block_slab *slab, block_density *densities, int count,
                                          lanes3 towards, lanes path) {
  const shade_light *light = place->light;
  const shadow_map *map = light->sublight_count > 0 ? &light->sublights[0].map : &place->lookup->map;
  int faces = 0;
  for (int i = 0; i < count; i++) faces |= densities[i].there && densities[i].patch->enter != NULL;
  near_pixels near;
  faces = faces && !light->nearest;
  if (faces) {
    near = light->sublight_count > 0 ? pixels_of_sublights() : pixels_around(&place->taps);
    find_steps(map, light->parallel, set3(job->normal), place->position, &near);
  }
  const seen_light seen = {towards, path, faces ? &near : NULL};
  light_depths depths = depths_of_light(job, slab, densities, count, &seen);
  color_lanes passing = reaching(place, &depths);
  for (int c = 0; c < light->channels; c++) {
    lanes own = own_transmittance(slab->depth, slab->left, depths.enter[c], depths.more[c]);
    passing.c[c] = lanes_min(passing.c[c] * own, lanes_set(1.0f));
  }
  return passing;
}

/* The point on the slab's first sheet at which the light's way to a volume's sample begins. Values are
 * coordinates of the classifier's tables. */
typedef struct way_begin {
  lanes start, change; /* start: the value at the beginning of the way; change: the change of the value per
                        * unit of the way */
  lanes first, foot;   /* first: the value at which the surface of `start` begins; foot: the value at
                        * which the sample's own surface begins */
  lanes_int there;     /* the lanes in which some of the volume's matter may be visible at the beginning of
                        * the way */
} way_begin;

/* Finds the value at the beginning of the light's way. If values rise only a little from this value on, they
 * cannot have risen from lower values within the slab. The value then belongs to a layer below the sample's
 * surface. way: the length of the light's way within the slab. */
LANES_INLINE way_begin find_begin(const block_density *d, lanes3 towards, lanes way) {
  const classifier *classifier = d->patch->volume->classifier;
  lanes seen = lanes_clamp(coordinate_seen(d), 0, CLASSIFIER_ENTRIES),
        change = lanes_keep(d->sloped, dot3(d->slope, towards) * classifier->scale);
  lanes start = lanes_clamp(lanes_fma(change, way, seen), 0, CLASSIFIER_ENTRIES);
  lanes foot = lanes_gather(classifier->outside, lanes_truncate(seen));
  lanes side = lanes_select(seen >= foot, lanes_set(1.0f), lanes_set(-1.0f));
  lanes below = lanes_gather(classifier->outside,
                             lanes_truncate(lanes_clamp(foot - side * 0.5f, 0, CLASSIFIER_ENTRIES)));
  /* matter with values just below the foot is visible, so it is a layer of its own */
  lanes_int layer = lanes_abs(below - foot) > 1.0f;
  lanes_int beyond = layer & ((start - below) * side < 0.0f);
  start = lanes_select(beyond, below, start);
  lanes_int entry = lanes_truncate(start);
  lanes first = lanes_select(beyond, below, lanes_gather(classifier->outside, entry));
  return (way_begin){start, change, first, foot, (first != lanes_from_int(entry)) | beyond};
}

/* The fractions of the light at the slab's first sheet that light a sample's surface. There is one fraction
 * for light that was absorbed before the slab, and one for light that was not. */
typedef struct own_surface {
  lanes kept;    /* the fraction of the light absorbed before the slab that still lights the sample's
                  * surface */
  lanes passing; /* the fraction of the light not absorbed before the slab that reaches the surface within the
                  * slab */
} own_surface;

/* Finds which fractions of the light light a sample's own surface (own_surface). If the light's way leaves
 * another surface of the volume within the slab, that surface has absorbed the light that is missing before
 * the slab. A sample near a face that cuts matter belongs to the face's surface. light, outside: the
 * transmittance and the light at the outside, at the slab's first sheet. */
LANES_INLINE own_surface find_own_surface(const block_density *d, const way_begin *begin, lanes light,
                                          lanes outside) {
  const classifier *classifier = d->patch->volume->classifier;
  own_surface own = {lanes_set(1.0f), lanes_set(1.0f)};
  lanes_int second = begin->there & (begin->first != begin->foot);
  if (lanes_bits(second) == 0) return own;
  second_surface other = kept_at_foot(classifier, begin->first, begin->start, begin->foot,
                                      lanes_abs(begin->change), light, outside);
  lanes passing = exp_of_depth(lanes_min(other.ahead, lanes_set(DEEPEST)));
  own.kept = lanes_select(second, lanes_max(other.kept, skin_of_face(d->behind)), own.kept);
  own.passing = lanes_select(second, lanes_max(passing, skin_of_face(d->behind)), own.passing);
  return own;
}

/* The extinction of the volumes in a slab whose surfaces may be seen. */
LANES_INLINE lanes extinction_of_surfaces(const block_density *densities, int count) {
  lanes sum = lanes_set(0);
  for (int i = 0; i < count; i++)
    if (densities[i].there && densities[i].patch->volume->visible && densities[i].patch->volume->phong)
      sum = sum + densities[i].extinction;
  return sum;
}

/* The light of the first channel at the slab's first sheet: the transmittance where the light's way enters
 * the slab, the light at the outside of surfaces, and the greatest transmittance of the pixels around this
 * place. */
typedef struct surface_light {
  lanes passing, outside, beside;
} surface_light;

/* The fraction of the light absorbed before the slab that still lights a sample's surface, if several volumes
 * share the slab. any, more: the lanes in which one volume at least, and two at least, have matter where the
 * light's way begins. If another volume has matter there, the sample's surface counts at most as much of this
 * light as its own matter before the slab can have absorbed (part_of_matter()), but for the skin of a face.
 */
LANES_INLINE lanes kept_among_several(const block_density *d, const way_begin *begin, lanes kept,
                                      lanes_int any, lanes_int more, const surface_light *light) {
  const classifier *classifier = d->patch->volume->classifier;
  lanes integral = lanes_abs(integral_to(classifier, begin->start) - integral_to(classifier, begin->first));
  lanes depth = greatest_depth_of_surface(integral * d->patch->volume->cast[0], lanes_abs(begin->change));
  lanes part = part_of_matter(lanes_keep(begin->there, depth), light->passing, light->outside, light->beside);
  part = lanes_max(part, skin_of_face(d->behind));
  return lanes_select(more | (any & ~begin->there), lanes_min(kept, part), kept);
}

/* The mean of find_own_surface() over a slab's volumes, weighted by extinction. */
LANES_INLINE own_surface find_own_surfaces(const block_density *densities, int count, lanes3 towards,
                                           lanes way, const surface_light *light) {
  own_surface sum = {lanes_set(0), lanes_set(0)};
  lanes_int any = lanes_set_int(0), more = any;
  if (count == 1) {
    const way_begin begin = find_begin(densities, towards, way);
    return find_own_surface(densities, &begin, light->passing, light->outside);
  }
  const lanes total = extinction_of_surfaces(densities, count),
              inverse = 1.0f / lanes_max(total, lanes_set(1e-30f));
  for (int i = 0; i < count; i++) {
    if (!densities[i].there) continue;
    const lanes_int there = densities[i].here & find_begin(&densities[i], towards, way).there;
    more |= any & there;
    any |= there;
  }
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there || !d->patch->volume->visible || !d->patch->volume->phong) continue;
    const way_begin begin = find_begin(d, towards, way);
    own_surface own = find_own_surface(d, &begin, light->passing, light->outside);
    lanes weight = lanes_select(d->extinction == total, lanes_set(1.0f), d->extinction * inverse);
    sum.kept = lanes_fma(kept_among_several(d, &begin, own.kept, any, more, light), weight, sum.kept);
    sum.passing = lanes_fma(own.passing, weight, sum.passing);
  }
  return sum;
}

/* Finds surface_light.beside for a slab of `count` volumes: `passing` for a single volume and under
 * sub-lights. */
LANES_INLINE lanes light_beside(const light_place *place, lanes passing, int count) {
  const shadow_lookup *lookup = place->lookup;
  if (count == 1 || place->light->sublight_count > 0) return passing;
  lanes younger = greatest_tap(&lookup->map, &place->taps, lookup->transmittance[0]);
  if (lookup->older[0] == NULL) return younger;
  return between_chunks(lookup, greatest_tap(&lookup->map, &place->taps, lookup->older[0]), younger);
}

/* The light at the outside of the surfaces in a slab (shadow/attenuate.h). way: the light's way from the
 * slab's first sheet to the samples. */
LANES_INLINE color_lanes passing_to_surfaces(const light_place *place, const block_density *densities,
                                             int count, lanes3 towards, lanes way) {
  const shade_light *light = place->light;
  const shadow_lookup *lookup = place->lookup;
  const int several = count > 1 || densities->patch->volume->classifier->several_surfaces;
  color_lanes passing, outside;
  own_surface own;
  if (light->sublight_count > 0) {
    outside = mean_of_sublights(light, place->position, place->active, 1);
    if (several) passing = mean_of_sublights(light, place->position, place->active, 0);
  }
  for (int c = 0; c < light->channels; c++) {
    if (light->sublight_count == 0) {
      outside.c[c] = look_up_plane(lookup, &place->taps, light->cubic, lookup->outside[c]);
      if (several || lookup->older[c] != NULL)
        passing.c[c] = look_up_plane(lookup, &place->taps, light->cubic, lookup->transmittance[c]);
      if (lookup->older[c] != NULL) {
        lanes taken = outside.c[c] - passing.c[c],
              older = look_up_plane(lookup, &place->taps, light->cubic, lookup->older[c]);
        passing.c[c] = between_chunks(lookup, older, passing.c[c]);
        outside.c[c] = passing.c[c] + lanes_max(taken, lanes_set(0));
      }
    }
    if (several && c == 0) {
      const surface_light first = {passing.c[0], outside.c[0], light_beside(place, passing.c[0], count)};
      own = find_own_surfaces(densities, count, towards, way, &first);
    }
    if (several) {
      lanes passed = passing.c[c] * own.passing;
      lanes_int whole = (own.kept == 1.0f) & (own.passing == 1.0f);
      outside.c[c] = lanes_select(whole, outside.c[c], lanes_fma(outside.c[c] - passed, own.kept, passed));
    }
    outside.c[c] = lanes_min(outside.c[c], lanes_set(1.0f));
  }
  return outside;
}

#endif
