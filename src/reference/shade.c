/* reference/shade.c - computes the colour that a lit sample sends to the eye; eqs. (3) and (4).
 *
 *     surface   C = c ka Ia + c kd I max(N.L, 0) + ks I max(E.R, 0)^n     (specular only where N.L > 0)
 *     medium    C = c (ka Ia + p I)
 *     flat      C = c, for any light
 *
 * c is the volume's colour at the sample, Ia is ambient light, and I is the light of one source. N is the
 * normal. L and E point to the light and to the eye, and R is L mirrored by N. ka, kd, ks, ke and n are the
 * material's ambient, diffuse, specular and emission factors and its shininess. p is the mean over the light
 * of Henyey and Greenstein's phase function times 4 pi. Emission adds c ke to a surface and to a medium. In a
 * volume shaded "phong", a sample without a gradient is a medium; as the gradient grows, the sample becomes
 * more and more a surface. */
#include <string.h>

#include "elementary/elementary.h"
#include "reference/reference.h"

/* Finds the fraction of a light that reaches a sample. Finding this fraction takes by far the greatest part
 * of the time for a sample. So the fraction is computed only when it is first needed, and is then kept in
 * worker->arrivals. */
static const double *light_reach(const reference *all, const reference_sample *at, size_t light, bool surface,
                                 reference_worker *worker) {
  arrival *arrived = &worker->arrivals[light];
  bool attenuated = at->volume->described->receives_shadow, *known = &arrived->pattern_known;
  double *reach = arrived->pattern;
  reference_receiver receiver = {.point = at->point};
  if (attenuated) known = &arrived->shadowed_known, reach = arrived->shadowed;
  if (attenuated && surface) {
    receiver.surface_of = at->volume;
    receiver.value = at->value;
    known = &arrived->outside_known;
    reach = arrived->outside;
  }
  if (!*known) hl_reference_light_reach(all, &all->lights[light], &receiver, attenuated, worker, reach);
  *known = true;
  return reach;
}

/* Finds a sample's outward normal, and the fraction of the sample that is surface. Outward means towards the
 * empty value. So regions with values above the empty value are lit from outside, and so are regions with
 * values below the empty value. */
static vec3 find_normal(const reference_volume *volume, vec3 index_point, double value, double *surface) {
  *surface = 0;
  if (volume->described->shading != HL_SHADING_PHONG) return (vec3){0, 0, 0};
  double outward = value > volume->empty_value ? -1 : 1;
  vec3 slope = vec3_scale(hl_reference_gradient(volume, index_point), outward);
  vec3 mask = vec3_scale(hl_reference_mask_slope(volume, index_point), -fabs(value - volume->empty_value));
  slope = vec3_add(slope, mask);
  double size = vec3_length(slope);
  if (!(size > 0)) return (vec3){0, 0, 0};
  *surface = fmin(size / volume->surface_gradient, 1);
  return vec3_scale(slope, 1 / size);
}

void hl_reference_light_shadow(const reference *all, const reference_light *light,
                               const reference_receiver *at, bool attenuated, const double reach[3],
                               reference_worker *worker, double shadow[3]) {
  reference_light plain = *light;
  if (plain.emission != NULL) {
    double full[3];
    hl_reference_light_reach(all, &plain, at, false, worker, full);
    for (int c = 0; c < 3; c++) shadow[c] = full[c] > 0 ? reach[c] / full[c] : 1;
    return;
  }
  if (plain.texture == NULL) {
    memcpy(shadow, reach, 3 * sizeof *shadow);
    return;
  }
  plain.texture = NULL;
  hl_reference_light_reach(all, &plain, at, attenuated, worker, shadow);
}

/* The properties of a sample that are the same for every light. */
typedef struct surface {
  double own[3]; /* the volume's own colour at the sample */
  vec3 normal;   /* unit length, outward; 0 in a medium */
  double amount; /* 0 for a medium, 1 for a surface */
  vec3 outside;  /* world; for surfaces: the place along the normal where the matter of the surface begins */
} surface;

/* The phase function p = (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2). cos = -E.L is the cosine of the angle by
 * which light is turned. For g = 0, p is 1 in all directions. */
double hl_reference_phase(double g, vec3 to_eye, vec3 towards) {
  return (1 - g * g) / hl_pow(1 + g * g + 2 * g * vec3_dot(to_eye, towards), 1.5);
}

/* Adds the fraction of a light that reaches a sample to the light's shadow layer. If the sample is on a
 * surface that faces the light, the fraction is for the light that reaches the surface's outside. */
static void add_shadow(const reference *all, const reference_sample *at, const surface *here, size_t light,
                       reference_worker *worker, double shadow[3]) {
  bool faces = vec3_dot(here->normal, worker->arrivals[light].towards) > 0;
  for (int surface = 0; surface < 2; surface++) {
    double lit = faces ? here->amount : 0, weight = surface ? lit : 1 - lit, part[3];
    if (!(weight > 0)) continue;
    const reference_receiver receiver = {at->point, surface ? at->volume : NULL, at->value};
    hl_reference_light_shadow(all, &all->lights[light], &receiver, at->volume->described->receives_shadow,
                              light_reach(all, at, light, surface, worker), worker, part);
    for (int c = 0; c < 3; c++) shadow[c] += weight * part[c];
  }
}

/* Finds the light of one source that the sample sends to the eye. */
static void shade_light(const reference *all, const reference_sample *at, const surface *here, size_t light,
                        reference_worker *worker, light_part *part) {
  const hl_material *material = &at->volume->described->material;
  const arrival *arrived = &worker->arrivals[light];
  double cosine = vec3_dot(here->normal, arrived->towards), gloss = 0;
  *part = (light_part){{0, 0, 0}, {0, 0, 0}};
  if (all->all_shadows) add_shadow(all, at, here, light, worker, part->shadow);
  if (cosine > 0) {
    /* the direction of mirror reflection: R = 2 (N.L) N - L */
    vec3 reflected = vec3_subtract(vec3_scale(here->normal, 2 * cosine), arrived->towards);
    gloss = material->specular * hl_pow(fmax(vec3_dot(at->to_eye, reflected), 0), material->shininess);
  }
  double surface = here->amount * material->diffuse * fmax(cosine, 0);
  double medium = (1 - here->amount) * hl_reference_light_phase(&all->lights[light],
                                                                at->volume->described->anisotropy, at->to_eye,
                                                                at->point);
  if (surface + medium <= 0 && gloss <= 0) return;
  static const double dark[3] = {0, 0, 0};
  const double *on_surface = surface > 0 || gloss > 0 ? light_reach(all, at, light, true, worker) : dark,
               *on_medium = medium > 0 ? light_reach(all, at, light, false, worker) : dark;
  const double *albedo = at->volume->described->albedo;
  for (int c = 0; c < 3; c++)
    part->picture[c] = ((here->own[c] * surface + here->amount * gloss) * on_surface[c] +
                        here->own[c] * medium * albedo[c] * on_medium[c]) *
                       arrived->incoming[c];
}

/* Finds the place on a surface sample's normal where the matter of the surface begins. The function assumes
 * that values along the normal change at a constant rate, the gradient's length, until the transfer function
 * shows nothing. The place is at most 8 voxels away. Just behind the face of a cut, the result is the
 * sample's own place. */
static vec3 outside_of_surface(const reference_sample *at, const surface *here, double behind_face) {
  const reference_volume *volume = at->volume;
  double empty = volume->empty_value, outside = empty,
         steepness = vec3_length(hl_reference_gradient(volume, at->index_point));
  if (!(here->amount > 0) || !(steepness > 0)) return at->point;
  (void)hl_transfer_function_transparent(&volume->described->transfer_function, fmin(empty, at->value),
                                         fmax(empty, at->value), at->value, &outside);
  double way = fmin(fabs(at->value - outside) / steepness, 8 * volume->smallest_edge);
  return vec3_add(at->point, vec3_scale(here->normal, way * here->amount * (1 - behind_face)));
}

/* Adds the sky's light that a sample sends to the eye. A surface is lit by the light that arrives at its
 * outside. */
static void shade_sky(const reference *all, const reference_sample *at, const surface *here,
                      reference_worker *worker, reference_parts *sample) {
  const hl_scene_volume *described = at->volume->described;
  reference_sky_light light;
  hl_reference_sky_arrive(all,
                          &(reference_sky_receiver){.point = here->outside,
                                                    .normal = here->normal,
                                                    .to_eye = at->to_eye,
                                                    .surface = here->amount,
                                                    .anisotropy = described->anisotropy,
                                                    .receives_shadow = described->receives_shadow,
                                                    .diffuse = described->material.diffuse,
                                                    .albedo = described->albedo},
                          worker, &light);
  for (int c = 0; c < 3; c++) {
    sample->sky[c] += at->weight * here->own[c] * light.sent[c];
    sample->sky_reaching[c] += at->weight * light.reaching[c];
    sample->sky_open[c] += at->weight * light.open[c];
  }
}

/* Adds full light to the shadow layers for a sample of a volume with flat shading, because flat colours
 * receive no shadow. */
static void add_no_light(const reference *all, double weight, reference_parts *sample) {
  for (size_t l = 0; l < all->scene->light_count && all->all_shadows; l++)
    for (int c = 0; c < 3; c++) sample->lights[l].shadow[c] += weight;
}

void hl_reference_shade(const reference *all, const reference_sample *at, reference_worker *worker) {
  reference_parts *sample = &worker->sample;
  const hl_scene_volume *described = at->volume->described;
  double weight = at->weight;
  surface here;
  hl_reference_color(at->volume, at->value, at->index_point, here.own);
  hl_reference_tint(at->volume, at->index_point, here.own);
  here.normal = find_normal(at->volume, at->index_point, at->value, &here.amount);
  double behind_face = 0;
  if (described->shading == HL_SHADING_PHONG)
    behind_face = hl_reference_cut_face(at->volume, at->index_point, at->to_eye, &here.normal, &here.amount);
  here.outside = outside_of_surface(at, &here, behind_face);
  if (sample->object == 0 || weight > sample->greatest) {
    sample->object = (int)(at->volume - all->volumes) + 1;
    sample->greatest = weight;
  }
  sample->weight += weight;
  sample->normal = vec3_add(sample->normal, vec3_scale(here.normal, weight * here.amount));
  const hl_material *material = &described->material;
  bool flat = described->shading == HL_SHADING_FLAT;
  for (int c = 0; c < 3; c++) {
    sample->emission[c] += weight * here.own[c] * (flat ? 1 : material->emission);
    if (!flat) sample->ambient[c] += weight * here.own[c] * material->ambient * all->scene->ambient[c];
  }
  if (!flat) shade_sky(all, at, &here, worker, sample);
  if (flat) add_no_light(all, weight, sample);
  for (size_t l = 0; l < all->scene->light_count && !flat; l++) {
    light_part part;
    shade_light(all, at, &here, l, worker, &part);
    for (int c = 0; c < 3; c++) {
      sample->lights[l].picture[c] += weight * part.picture[c];
      sample->lights[l].shadow[c] += weight * part.shadow[c];
    }
  }
}
