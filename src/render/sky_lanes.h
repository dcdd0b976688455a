/* render/sky_lanes.h - finds the sky's light that a slab's samples send on.
 *
 * A surface is lit by the light that arrives at its outside. A sample belongs to the matter below its
 * surface. So the field is read outside of the matter, at a distance along the normal. Over this distance the
 * matter's values fall until nothing is visible. A few cells of the field are added to the distance, because
 * a cell that holds a surface is dark, and is thicker than the surface. */
#ifndef HL_RENDER_SKY_LANES_H
#define HL_RENDER_SKY_LANES_H

#include "render/light_depth_lanes.h"
#include "render/sky_phase_lanes.h"

/* The length of the way along the normal from a volume's samples to the outside of their surface; frame
 * units. Derived: along this way the values fall by the gradient's length per unit. Behind the face of a cut
 * the way ends at the face, because there the gradient leads through matter that is cut away. */
LANES_INLINE lanes way_to_outside(const block_density *d) {
  const shade_volume *volume = d->patch->volume;
  const classifier *classifier = volume->classifier;
  lanes3 slope = scale3(d->slope, lanes_set(fabsf(classifier->scale)));
  lanes steepness = lanes_max(lanes_sqrt(dot3(slope, slope)), lanes_set(1e-6f)),
        seen = lanes_clamp(coordinate_seen(d), 0, CLASSIFIER_ENTRIES),
        outside = lanes_gather(classifier->outside, lanes_truncate(seen));
  lanes way = lanes_min(lanes_abs(seen - outside) / steepness, lanes_set(MOST_TO_OUTSIDE * volume->voxel)),
        skin = skin_of_face(d->behind);
  return lanes_fma(way, 1.0f - skin, d->behind * skin * volume->voxel);
}

/* The sky's light at a sample, in each channel: the light that a medium receives, the light that a surface
 * receives, and the mean over all directions. */
typedef struct sky_parts {
  lanes medium[3], surface[3], mean[3];
} sky_parts;

/* The fraction of the sky's light that a volume sends on, without its colour. For a medium it is the albedo.
 * If the medium scatters light more than once, the grid of scattered light holds the fraction w of this light
 * (scatter/parts.h); w is the albedo times the colour. A surface is lit by another law; for it the grid holds
 * the fraction w of the sky's mean light. */
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

/* Finds the positions at which the sky's light is looked up for a slab's samples. A surface's samples are
 * looked up outside of the surface. */
LANES_INLINE void place_sky(const shade_job *job, const block_slab *slab, block_density *densities,
                            int count) {
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there) continue; /* a volume without density in the tile has no patch, so it is not in the list */
    const shade_volume *volume = d->patch->volume;
    if (!volume->visible || !volume->lit || !volume->receives_shadow) continue;
    d->outside = slab->geometry.position;
    if (lanes_bits(slab->seen & (d->surface > 0.0f)) != 0)
      d->outside = add_scaled3(d->outside, d->normal, (way_to_outside(d) + job->sky->lift) * d->surface);
    fetch_sky(job->sky, d->outside, lanes_bits(slab->seen));
  }
}

/* Finds the sky's light that arrives at a volume's samples. */
LANES_INLINE void find_arriving_sky(const shade_job *job, const block_slab *slab, const block_density *d,
                                    sky_parts *parts) {
  const sky_light *sky = job->sky;
  const shade_volume *volume = d->patch->volume;
  const bool surfaces = lanes_bits(slab->seen & (d->surface > 0.0f)) != 0,
             media = lanes_bits(slab->seen & (d->surface < 1.0f)) != 0 || volume->multiple;
  sky_rows rows;
  for (int c = 0; c < 3; c++) parts->surface[c] = parts->medium[c] = parts->mean[c] = lanes_set(0);
  if (volume->receives_shadow)
    look_up_sky(sky, d->outside, d->surface, lanes_bits(slab->seen), surfaces || volume->anisotropy != 0,
                &rows);
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

/* The light of the sky that a volume's samples send to the eye, as a factor for each channel of the volume's
 * colour. */
LANES_INLINE color_lanes sky_of_volume(const shade_job *job, const block_slab *slab, const block_density *d,
                                       const color_lanes *color) {
  const sky_light *sky = job->sky;
  const shade_volume *volume = d->patch->volume;
  lanes haze = lanes_set(1.0f), in_cell = d->sums.extinction * (HALF_CELL * sky->cell) * (1.0f - d->surface);
  sky_parts parts;
  find_arriving_sky(job, slab, d, &parts);
  for (int c = 0; c < sky->channels; c++) {
    float cast = volume->cast[c];
    if (volume->receives_shadow && (c == 0 || cast != volume->cast[c - 1]))
      haze = exp_of_depth(in_cell * cast);
    parts.surface[c] = parts.surface[c] * (volume->diffuse * d->surface);
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
