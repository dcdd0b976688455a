/* reference/shade.c - the colour that a lit sample sends to the eye; eqs. (3) and (4).
 *
 *     surface   C = c ka Ia + c kd I max(N.L, 0) + ks I max(E.R, 0)^n     (specular only where N.L > 0)
 *     medium    C = c (ka Ia + I)
 *
 * A sample of a volume shaded "phong" goes from medium to surface as its gradient grows from nothing.
 */
#include "reference/reference.h"

/* What reaches a point is found when first asked for: it is by far the dearest part of a sample. */
static const double *light_reach(const reference *all, const reference_volume *volume, size_t light,
                                 vec3 point, reference_worker *worker) {
  arrival *arrived = &worker->arrivals[light];
  bool attenuated = volume->described->receives_shadow, *known = &arrived->pattern_known;
  double *reach = arrived->pattern;
  if (attenuated) known = &arrived->shadowed_known, reach = arrived->shadowed;
  if (!*known) hl_reference_light_reach(all, &all->lights[light], point, attenuated, worker->shadow, reach);
  *known = true;
  return reach;
}

/* Outward normal, and how much of the sample is a surface. Outward is from the values that are there
 * towards the empty value, so that lobes of either sign are lit from outside. */
static vec3 find_normal(const reference_volume *volume, vec3 index_point, double value, double *surface) {
  *surface = 0;
  if (volume->described->shading == HL_SHADING_NONE) return (vec3){0, 0, 0};
  vec3 gradient = hl_reference_gradient(volume, index_point);
  double size = vec3_length(gradient);
  if (!(size > 0)) return (vec3){0, 0, 0};
  *surface = fmin(size / volume->surface_gradient, 1);
  return vec3_scale(gradient, (value > volume->empty_value ? -1 : 1) / size);
}

void hl_reference_shade(const reference *all, const reference_volume *volume, vec3 point, vec3 index_point,
                        double value, vec3 to_eye, reference_worker *worker, double color[3]) {
  const hl_material *material = &volume->described->material;
  double own[3], surface;
  hl_transfer_function_color(&volume->described->transfer_function, value, own);
  vec3 normal = find_normal(volume, index_point, value, &surface);
  for (int c = 0; c < 3; c++) color[c] = own[c] * material->ambient * all->scene->ambient[c];
  for (size_t l = 0; l < all->scene->light_count; l++) {
    const arrival *arrived = &worker->arrivals[l];
    double cosine = vec3_dot(normal, arrived->towards), gloss = 0;
    if (cosine > 0) {
      /* R = 2 (N.L) N - L */
      vec3 reflected = vec3_subtract(vec3_scale(normal, 2 * cosine), arrived->towards);
      gloss = material->specular * pow(fmax(vec3_dot(to_eye, reflected), 0), material->shininess);
    }
    double matt = surface * material->diffuse * fmax(cosine, 0) + (1 - surface);
    if (matt <= 0 && gloss <= 0) continue;
    const double *reach = light_reach(all, volume, l, point, worker);
    for (int c = 0; c < 3; c++)
      color[c] += (own[c] * matt + surface * gloss) * arrived->incoming[c] * reach[c];
  }
}
