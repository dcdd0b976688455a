/* render/reaching_lanes.h - the light that reaches a slab: shadow buffers read where samples are (step
 * 14). */
#ifndef HL_RENDER_REACHING_LANES_H
#define HL_RENDER_REACHING_LANES_H

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

LANES_INLINE color_lanes mean_of_sublights(const shade_light *light, lanes3 position, uint32_t active) {
  color_lanes sum = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  for (int i = 0; i < light->sublight_count; i++) {
    const sublight_lookup *sublight = &light->sublights[i];
    shadow_taps taps = taps_of_position(light, &sublight->map, position);
    for (int c = 0; c < light->channels; c++)
      sum.c[c] = lanes_add_scaled(sum.c[c],
                                  look_up_sublight(&sublight->map, &taps, sublight->transmittance[c], active),
                                  sublight->weight[c]);
  }
  for (int c = 0; c < light->channels; c++)
    sum.c[c] = sum.c[c] / ((float)SUBLIGHT_ONE * (float)light->sublight_count);
  return sum;
}

/* Interpolates between the buffers of the previous chunk (older) and of this one (younger). */
LANES_INLINE lanes between_chunks(const shadow_lookup *lookup, lanes older, lanes younger) {
  return lanes_add_scaled(older, younger - older, lookup->young);
}

/* A channel of the buffer, interpolated. */
LANES_INLINE lanes interpolated(const shadow_lookup *lookup, const shadow_taps *taps, int cubic,
                                int channel) {
  const float *younger = lookup->transmittance[channel], *older = lookup->older[channel];
  if (cubic) {
    lanes light = look_up_cubic(&lookup->map, taps, younger);
    return older == NULL ? light : between_chunks(lookup, look_up_cubic(&lookup->map, taps, older), light);
  }
  lanes light = look_up(&lookup->map, taps, younger);
  return older == NULL ? light : between_chunks(lookup, look_up(&lookup->map, taps, older), light);
}

LANES_INLINE void near_light(const shadow_lookup *lookup, const shadow_taps *taps, const float *buffer,
                             lanes light[NEAR_PIXELS]) {
  lanes_int at = taps->first.row * (int32_t)lookup->map.stride + taps->first.column;
  lanes_gather_pairs(buffer, at, &light[0], &light[1]);
  lanes_gather_pairs(buffer + lookup->map.stride, at, &light[2], &light[3]);
}

/* Near a box's face, the light's transmittance from the face to the slab, from the lengths of its ways.
 * found: the transmittance that the buffer holds; own: the transmittance if the box's matter were even and
 * nothing else in the way. A greater `found` means thinner matter: the depths are then scaled by the ratio of
 * the two optical depths. */
LANES_INLINE void pass_face(light_depths *depths, int channel, lanes found, lanes own) {
  lanes_int some = own < 0.999f;
  lanes ratio = lanes_log2(lanes_clamp(found, 1e-6f, 1)) / lanes_log2(lanes_clamp(own, 1e-36f, 0.999f));
  ratio = lanes_keep(depths->face, lanes_select(some, lanes_min(ratio, lanes_set(1.0f)), lanes_set(1.0f)));
  depths->enter[channel] = lanes_fma(ratio, depths->before_enter[channel], depths->enter[channel]);
  depths->more[channel] = lanes_fma(ratio, depths->before_more[channel], depths->more[channel]);
}

/* The light that reaches the slab where a plane's own matter makes the buffer vary from pixel to pixel.
 * Derived: at each pixel T = O E, where E = exp(-depth) is the transmittance of the plane's matter and O the
 * transmittance of everything else; where O is the same at all pixels, the weighted mean of T is O times the
 * weighted mean of E. The result is at most the brightest pixel's. */
LANES_INLINE lanes reaching_plane(const shadow_lookup *lookup, const shadow_taps *taps, light_depths *depths,
                                  int channel) {
  lanes light[NEAR_PIXELS], own[NEAR_PIXELS], greatest = lanes_set(0);
  near_light(lookup, taps, lookup->transmittance[channel], light);
  if (lookup->older[channel] != NULL) {
    lanes older[NEAR_PIXELS];
    near_light(lookup, taps, lookup->older[channel], older);
    for (int i = 0; i < NEAR_PIXELS; i++) light[i] = between_chunks(lookup, older[i], light[i]);
  }
  for (int i = 0; i < NEAR_PIXELS; i++) {
    own[i] = exp_of_depth(depths->near[channel][i]);
    greatest = lanes_max(greatest, light[i]);
  }
  lanes sum = between_taps(taps, light[0], light[1], light[2], light[3], 1);
  lanes of_own = between_taps(taps, own[0], own[1], own[2], own[3], 1);
  if (lanes_bits(depths->face) != 0) {
    pass_face(depths, channel, sum, of_own);
    of_own = lanes_select(depths->face, lanes_max(of_own, lanes_set(DARK)), of_own);
    greatest = lanes_select(depths->face, lanes_set(1.0f), greatest);
  }
  lanes reached = lanes_min(sum / lanes_max(of_own, lanes_set(1e-6f)), greatest);
  return lanes_select(taps->inside, reached, lanes_set(1.0f));
}

/* The same for sub-lights: their pixels lie in all positions around the sample, so the mean over the near
 * pixels stands for them. */
LANES_INLINE void correct_parts(light_depths *depths, int channels, color_lanes *reached) {
  for (int c = 0; c < channels; c++) {
    lanes own = lanes_set(0);
    for (int i = 0; i < NEAR_PIXELS; i++) own = own + exp_of_depth(depths->near[c][i]);
    if (lanes_bits(depths->face) != 0) pass_face(depths, c, reached->c[c], own * (1.0f / NEAR_PIXELS));
    reached->c[c] = lanes_min(reached->c[c] / lanes_max(own * (1.0f / NEAR_PIXELS), lanes_set(1e-6f)),
                              lanes_set(1.0f));
  }
}

/* The light that reaches the slab's first sheet below a position, in the active lanes. lookup: of that sheet.
 */
LANES_INLINE color_lanes reaching(const shade_light *light, const shadow_lookup *lookup,
                                  const shadow_taps *taps, lanes3 position, light_depths *depths,
                                  uint32_t active) {
  uint32_t planes = lanes_bits(depths->plane | depths->face) & active;
  color_lanes reached = {{lanes_set(0), lanes_set(0), lanes_set(0)}};
  if (light->sublight_count > 0) {
    reached = mean_of_sublights(light, position, active);
    if (planes != 0) correct_parts(depths, light->channels, &reached);
    return reached;
  }
  lanes_int faint = depths->face & ~depths->plane & (depths->beside < 1.0f);
  int fades = light->cubic && (lanes_bits(faint) & active) != 0;
  for (int c = 0; c < light->channels; c++) {
    if (planes != active || fades) reached.c[c] = interpolated(lookup, taps, light->cubic, c);
    if (planes == 0) continue;
    lanes of_plane = reaching_plane(lookup, taps, depths, c);
    if (fades) { /* adds the cubic look-up minus the bilinear one, less of it the more the face counts */
      lanes differ = reached.c[c] - interpolated(lookup, taps, 0, c);
      of_plane = lanes_max(of_plane + lanes_keep(faint, differ * (1.0f - depths->beside)), lanes_set(0));
    }
    reached.c[c] = lanes_select(depths->plane | depths->face, of_plane, reached.c[c]);
  }
  return reached;
}

/* The transmittance of one light to a slab's samples, through everything before the slab and through the
 * slab's own matter, averaged as the eye sees it. path: length of the light's way through the slab. */
LANES_INLINE color_lanes passing_light(const shade_job *job, const shade_light *light, const block_slab *slab,
                                       block_density *densities, int count, lanes3 towards, lanes path) {
  lanes3 position = slab->geometry.position;
  const shadow_lookup *lookup = &light->lookups[job->plane];
  const shadow_map *map = light->sublight_count > 0 ? &light->sublights[0].map : &lookup->map;
  shadow_taps taps = taps_of_position(light, map, position);
  near_pixels near = light->sublight_count > 0 ? pixels_of_sublights(light->shifts) : pixels_around(&taps);
  find_steps(map, light->parallel, set3(job->normal), position, &near);
  const seen_light seen = {towards, path, light->nearest ? NULL : &near};
  light_depths depths = depths_of_light(job, slab, densities, count, &seen);
  color_lanes passing = reaching(light, lookup, &taps, position, &depths, lanes_bits(slab->seen));
  for (int c = 0; c < light->channels; c++) {
    lanes own = own_transmittance(slab->depth, slab->left, depths.enter[c], depths.more[c]);
    passing.c[c] = lanes_min(passing.c[c] * own, lanes_set(1.0f));
  }
  return passing;
}

#endif
