/* render/sky_lanes.h - the sky's light that a slab's samples send on.
 *
 * A cell of the sky's field is larger than what a surface hides of itself. So the field is read a little
 * outside of a surface, and what the surface's own matter takes in between is found from the sample's density
 * and gradient: along the normal it has the optical depth t, along a direction at the cosine mu to it t / mu.
 * The mean over directions, 2 int mu exp(-t / mu) dmu for a surface and int exp(-t / mu) dmu for a medium, is
 * a sum of two exponentials by Gauss's rule (derived). */
#ifndef HL_RENDER_SKY_LANES_H
#define HL_RENDER_SKY_LANES_H

#include "render/light_depth_lanes.h"
#include "render/sky_phase_lanes.h"

/* The two nodes of Gauss's rule for the weight mu: 1 / mu and the weight. */
static const float COSINE_RATE[2] = {2.8165f, 1.18350f}, COSINE_WEIGHT[2] = {0.363917f, 0.636083f};

/* Light reaches a cell without what the cell itself takes, of which it crosses half on its way to a medium's
 * sample: of its directions in a slice (field/sky_lanes.h) half of sqrt(1 + u^2 + v^2) edges. The mean over
 * all directions is 3 / (4 pi) times the integral of 1 / (1 + u^2 + v^2) over -1 < u, v < 1 (derived). */
static const float HALF_CELL = 0.6107f;

/* Optical depths along the normal, of the matter within `lift` of where the eye's ray enters the slab's
 * matter, and what they gain until it leaves it. */
typedef struct own_depths {
  lanes enter, more;
} own_depths;

LANES_INLINE lanes depth_outwards(const classifier *classifier, lanes at, lanes outwards, lanes inverse) {
  table_origin from = origin_at(classifier, at + outwards), to = origin_at(classifier, at);
  return lanes_abs(integral_between(&from, &to)) * inverse;
}

LANES_INLINE own_depths depths_outwards(const shade_job *job, const block_density *d, lanes lift) {
  const classifier *classifier = d->patch->volume->classifier;
  lanes3 slope = scale3(d->slope, lanes_set(fabsf(classifier->scale)));
  lanes steepness = lanes_max(lanes_sqrt(dot3(slope, slope)), lanes_set(1e-6f));
  lanes_int above = coordinate_seen(d) > classifier->offset;
  lanes outwards = lanes_select(above, -steepness, steepness) * lift, inverse = 1.0f / steepness;
  lanes empty = lanes_set(classifier->offset);
  lanes end[2] = {job->back_to_front ? d->after : d->before, job->back_to_front ? d->before : d->after},
        depth[2];
  for (int i = 0; i < 2; i++) {
    lanes to_empty = empty - end[i]; /* beyond the empty value there is nothing */
    lanes step = lanes_select(above, lanes_max(outwards, lanes_min(to_empty, lanes_set(0))),
                              lanes_min(outwards, lanes_max(to_empty, lanes_set(0))));
    depth[i] = depth_outwards(classifier, end[i], step, inverse);
  }
  return (own_depths){depth[0], depth[1] - depth[0]};
}

/* cast: the volume's relative extinction. */
LANES_INLINE lanes own_of_surface(const block_slab *slab, own_depths own, float cast) {
  lanes sum = lanes_set(0);
  for (int i = 0; i < 2; i++)
    sum = lanes_add_scaled(sum,
                           own_transmittance(slab->depth, slab->left, own.enter * (COSINE_RATE[i] * cast),
                                             own.more * (COSINE_RATE[i] * cast)),
                           COSINE_WEIGHT[i]);
  return lanes_min(sum, lanes_set(1.0f));
}

/* The sky's light at a sample, in each channel: on a medium, on a surface, and its mean over all directions.
 */
typedef struct sky_parts {
  lanes medium[3], surface[3], mean[3];
} sky_parts;

/* What a volume sends on of the sky's light, without its colour: a medium its albedo. Where it scatters light
 * more than once, the fraction w of a medium's light is in the grid of scattered light (scatter/parts.h), w
 * the albedo with the colour; of a surface, which the sky lights by its own law, w of the mean. */
LANES_INLINE lanes sent_on(const shade_volume *volume, const sky_parts *parts, lanes surface, int c,
                           lanes color) {
  lanes medium = parts->medium[c], on_surface = parts->surface[c];
  float albedo = volume->albedo[c];
  if (volume->multiple) {
    lanes left = color * albedo;
    medium = medium * (1.0f - left);
    on_surface = on_surface - parts->mean[c] * left * surface * albedo;
  }
  if (volume->absorbs) medium = medium * albedo;
  return lanes_fma(medium, 1.0f - surface, on_surface);
}

/* Finds the light that arrives at a volume's samples, before its own matter hides any: the samples lie `lift` off
 * a surface. */
LANES_INLINE void find_arriving_sky(const shade_job *job, const block_slab *slab, const block_density *d,
                                    lanes lift, sky_parts *parts) {
  const sky_light *sky = job->sky;
  const shade_volume *volume = d->patch->volume;
  const uint32_t active = lanes_bits(slab->seen);
  const bool surfaces = lanes_bits(slab->seen & (d->surface > 0.0f)) != 0,
             media = lanes_bits(slab->seen & (d->surface < 1.0f)) != 0 || volume->multiple;
  const lanes none = lanes_set(0);
  sky_rows rows;
  for (int c = 0; c < 3; c++) parts->surface[c] = parts->medium[c] = parts->mean[c] = none;
  if (volume->receives_shadow)
    look_up_sky(sky, add_scaled3(slab->geometry.position, d->normal, lift), d->surface, active, &rows);
  if (surfaces && volume->receives_shadow) light_of_surface(sky, &rows, d->normal, parts->surface);
  else if (surfaces) open_light_of_surface(sky, d->normal, parts->surface);
  if (!media) return;
  for (int c = 0; c < sky->channels; c++) {
    lanes of[FIELD_HARMONICS];
    for (int k = 0; k < FIELD_HARMONICS; k++) {
      if (!volume->receives_shadow) of[k] = lanes_set(sky->open[c][k]);
      else if (k == 0 || volume->anisotropy != 0) of[k] = harmonic_of_rows(sky, &rows, c, k);
    }
    parts->medium[c] = light_of_medium(volume->phase_once, volume->anisotropy, of,
                                       scale3(slab->geometry.towards_eye, lanes_set(-1.0f)));
    parts->mean[c] = of[0] * (float)HARMONIC_0;
  }
}

/* What a volume's samples make of the sky: factors for its colour. */
LANES_INLINE color_lanes sky_of_volume(const shade_job *job, const block_slab *slab, const block_density *d,
                                       const color_lanes *color) {
  const sky_light *sky = job->sky;
  const shade_volume *volume = d->patch->volume;
  lanes medium = 1.0f - d->surface, own = lanes_set(1.0f), haze = lanes_set(1.0f);
  lanes lift = d->surface * sky->lift, in_cell = d->sums.extinction * (HALF_CELL * sky->cell) * medium;
  sky_parts parts;
  own_depths depths;
  find_arriving_sky(job, slab, d, lift, &parts);
  if (volume->receives_shadow) {
    depths = depths_outwards(job, d, lift);
    /* what the gradient tells of matter outside of a cut's face is not there */
    depths.enter = depths.enter * (1.0f - d->skin);
    depths.more = depths.more * (1.0f - d->skin);
  }
  for (int c = 0; c < sky->channels; c++) {
    float cast = volume->cast[c];
    if (volume->receives_shadow && (c == 0 || cast != volume->cast[c - 1])) {
      own = own_of_surface(slab, depths, cast);
      haze = exp_of_depth(in_cell * cast);
    }
    parts.surface[c] = parts.surface[c] * own * (volume->diffuse * d->surface);
    parts.medium[c] = parts.medium[c] * haze;
    parts.mean[c] = parts.mean[c] * haze;
  }
  color_lanes sent;
  for (int c = 0; c < 3; c++) {
    if (c >= sky->channels)
      parts.surface[c] = parts.surface[0], parts.medium[c] = parts.medium[0], parts.mean[c] = parts.mean[0];
    sent.c[c] = sent_on(volume, &parts, d->surface, c, color->c[c]) * sky->color[c];
  }
  return sent;
}

#endif
