/* render/surface_lanes.h - lights sixteen samples of surfaces (steps 14 and 15). */
#ifndef HL_RENDER_SURFACE_LANES_H
#define HL_RENDER_SURFACE_LANES_H

#include "render/shade_lanes.h"
#include "render/surface_samples.h"
#include "surface/late/lateness.h"

LANES_INLINE lanes3 load3(const float v[3][SURFACE_SAMPLES]) {
  return (lanes3){lanes_load(v[0]), lanes_load(v[1]), lanes_load(v[2])};
}

/* A sample of a surface, and the direction of the light that arrives there. */
typedef struct lit_sample {
  lanes3 position, normal; /* unit normal, on the side that is lit */
  lanes3 towards;          /* unit direction to the light */
  lanes facing; /* the cosine of the angle between the normal and the direction to the light; only lanes in
                 * which it is above 0 need the light */
} lit_sample;

/* The direction in which a look-up moves away from a surface; its length is at most 1. The look-up moves
 * along the normal n, but not to places where the buffer meets the surface earlier than at the sample,
 * because the buffer may hold the surface at such places already. Derived: let t be the direction to the
 * light, and h the direction in which the heights of sheets grow. A vector e at a right angle to t moves the
 * look-up in the light's view. The ray of this view meets the surface's plane e + t (n.e) / (n.t) farther on,
 * so that the height there grows by e.g, where g = h - a n and a = (h.t) / (n.t); g is at a right angle to t.
 * For e = n - (n.t) t, the growth e.g is h.n - a. If this growth is less than 0, the part of e along g is
 * left out. */
LANES_INLINE lanes3 way_from_surface(const float h[3], const lit_sample *sample) {
  lanes3 sheets = {lanes_set(h[0]), lanes_set(h[1]), lanes_set(h[2])};
  lanes along = dot3(sheets, sample->normal),
        a = dot3(sheets, sample->towards) / lanes_max(sample->facing, lanes_set(1e-6f)),
        falls = lanes_keep(sample->facing > 0.0f,
                           lanes_min(along - a, lanes_set(0))); /* lines have no normal */
  lanes3 g = add_scaled3(sheets, sample->normal, lanes_set(0) - a);
  return add_scaled3(sample->normal, g, lanes_set(0) - falls / lanes_max(dot3(g, g), lanes_set(1e-12f)));
}

/* The position at which a sample's light is looked up, moved away from the surface. Derived: in the buffer,
 * the column of a point p is (r1.p) / (r0.p), where r0 and r1 are rows of the buffer's map. A step of length
 * d at a right angle to the light moves the column by about |r1| d / (r0.p). */
LANES_INLINE lanes3 moved_away(const shade_job *job, const shade_light *light, const shadow_map *map,
                               const lit_sample *sample) {
  const float *row = map->rows[1];
  float scale = LOOKUP_OFFSET / sqrtf(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
  lanes away = light->parallel
                   ? lanes_set(scale)
                   : lanes_max(row_of_point(map->rows[0], sample->position), lanes_set(0)) * scale;
  return add_scaled3(sample->position, way_from_surface(job->normal, sample), away);
}

/* The fraction of the light that everything before the slab lets pass. */
LANES_INLINE color_lanes light_before_slab(const shade_job *job, const shade_light *light,
                                           const lit_sample *sample) {
  const shadow_lookup *lookup = &light->lookups[job->plane];
  const shadow_map *map = light->sublight_count > 0 ? &light->sublights[0].map : &lookup->map;
  lanes3 position = moved_away(job, light, map, sample);
  if (light->sublight_count > 0) return mean_of_sublights(light, position, 0xffff, 0);
  color_lanes passing = {{lanes_set(1.0f), lanes_set(1.0f), lanes_set(1.0f)}};
  shadow_taps taps = taps_of_position(light, map, position);
  for (int c = 0; c < light->channels; c++) passing.c[c] = interpolated(lookup, &taps, light->cubic, c);
  return passing;
}

/* The light on the side that the eye sees. Light from behind passes through the surface itself; it counts
 * only where the material sends on light from any angle. */
LANES_INLINE color_lanes light_of_sample(const shade_job *job, const shade_light *light,
                                         const surface_samples *samples, const lit_sample *seen) {
  if (samples->even == 0) return light_before_slab(job, light, seen);
  lanes_int before = seen->facing > 0.0f;
  lanes side = lanes_select(before, lanes_set(1.0f), lanes_set(-1.0f));
  lit_sample lit = {seen->position, scale3(seen->normal, side), seen->towards, seen->facing * side};
  color_lanes passing = light_before_slab(job, light, &lit);
  for (int c = 0; c < light->channels; c++)
    passing.c[c] = lanes_select(before, passing.c[c], passing.c[c] * samples->behind[c]);
  return passing;
}

/* The fraction of light that the surfaces close before the samples let pass. The light's buffer may hold the
 * same surfaces. So the caller takes the lesser of this fraction and the buffer's fraction. */
LANES_INLINE lanes contact_of(const shade_job *job, const shade_light *light, const surface_samples *samples,
                              int channel) {
  if (samples->contact == NULL) return lanes_set(1.0f);
  return lanes_load(samples->contact[light->number * job->channels + channel]);
}

/* Adds the light that a surface sends to the eye from one light, eqs. (3) and (4). */
LANES_INLINE void add_light(const shade_job *job, const shade_light *light, const surface_samples *samples,
                            color_lanes *lit) {
  lanes3 position = load3(samples->position), normal = load3(samples->normal);
  arriving_light arriving;
  (void)find_direction(job, light, position, &arriving);
  lanes facing = dot3(normal, arriving.towards);
  if (samples->even == 0 && lanes_bits(facing > 0.0f) == 0) return;
  find_full_light(light, position, &arriving);
  if (is_dark(&arriving.full)) return;
  lanes3 mirrored = add_scaled3(scale3(arriving.towards, lanes_set(-1.0f)), normal, facing * 2.0f);
  lanes glint = power(dot3(load3(samples->towards_eye), mirrored), lanes_set(samples->shininess)) *
                samples->specular;
  lanes diffuse = lanes_max(facing, lanes_set(0)) * samples->diffuse + samples->even,
        transmittance = lanes_set(1.0f);
  glint = light->of_sky > 0 ? lanes_set(0) : lanes_keep(facing > 0.0f, glint);
  bool shadowed = light->shadowed && samples->receives_shadow;
  color_lanes passing;
  if (shadowed) {
    lit_sample seen = {position, normal, arriving.towards, facing};
    passing = light_of_sample(job, light, samples, &seen);
  }
  for (int c = 0; c < 3; c++) {
    if (shadowed && c < light->channels)
      transmittance = lanes_min(lanes_max(passing.c[c], lanes_set(0)), contact_of(job, light, samples, c));
    lit->c[c] = lanes_fma(arriving.full.c[c] * transmittance,
                          lanes_fma(lanes_load(samples->color[c]), diffuse, glint), lit->c[c]);
  }
}

/* The number of cells by which look-ups of the sky's light are moved off a mesh. */
static const float MESH_LIFT = 1;

/* Adds the sky's light. It is looked up a little outside of the surface, because the surface's own matter
 * hides the sky behind it. */
LANES_INLINE void add_sky(const sky_light *sky, const surface_samples *samples, color_lanes *lit) {
  lanes3 normal = load3(samples->normal);
  lanes_int lit_side = dot3(normal, normal) > 0.0f;
  lanes light[3];
  if (samples->receives_shadow) {
    sky_rows rows;
    look_up_sky(sky, add_scaled3(load3(samples->position), normal, lanes_set(MESH_LIFT * sky->cell)),
                lanes_set(0), 0xffff, true, &rows);
    light_of_surface(sky, &rows, normal, light);
  } else {
    open_light_of_surface(sky, normal, light);
  }
  for (int c = 0; c < 3; c++) {
    lanes light_here = lanes_keep(lit_side, light[sky->channels == 1 ? 0 : c]);
    lit->c[c] = lanes_fma(light_here * (samples->diffuse * sky->color[c]), lanes_load(samples->color[c]),
                          lit->c[c]);
  }
}

static void shade_surface(const shade_job *job, surface_samples *samples) {
  color_lanes lit;
  for (int c = 0; c < 3; c++)
    lit.c[c] = lanes_load(samples->color[c]) *
               (samples->ambient * job->ambient[c] + samples->emission * job->emission);
  if (job->sky != NULL) add_sky(job->sky, samples, &lit);
  for (int i = 0; i < job->light_count; i++) add_light(job, &job->lights[i], samples, &lit);
  for (int c = 0; c < 3; c++) lanes_store(samples->lit[c], lit.c[c]);
}

#endif
