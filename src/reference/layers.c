/* reference/layers.c - handles contributions to samples and rays: the light of each source, depth and
 * normals.
 *
 * A pixel of the picture is the sum of all light contributions. A layer is a single contribution, or a mean
 * of depths, normals or shadows weighted by opacity. */
#include "reference/reference.h"

void hl_reference_parts_clear(reference_parts *parts, size_t light_count) {
  light_part *lights = parts->lights;
  *parts = (reference_parts){.lights = lights};
  for (size_t l = 0; l < light_count; l++) lights[l] = (light_part){{0, 0, 0}, {0, 0, 0}};
}

void hl_reference_parts_add(reference_parts *parts, const reference_parts *other, double scale,
                            size_t light_count) {
  parts->weight += scale * other->weight;
  parts->depth += scale * other->depth;
  parts->normal = vec3_add(parts->normal, vec3_scale(other->normal, scale));
  for (int c = 0; c < 3; c++) {
    parts->ambient[c] += scale * other->ambient[c];
    parts->emission[c] += scale * other->emission[c];
    parts->sky[c] += scale * other->sky[c];
    parts->sky_reaching[c] += scale * other->sky_reaching[c];
    parts->sky_open[c] += scale * other->sky_open[c];
  }
  for (size_t l = 0; l < light_count; l++)
    for (int c = 0; c < 3; c++) {
      parts->lights[l].picture[c] += scale * other->lights[l].picture[c];
      parts->lights[l].shadow[c] += scale * other->lights[l].shadow[c];
    }
}

static void write_light(const light_part *light, double alpha, const hl_light_layers *to, size_t pixel) {
  for (size_t c = 0; c < 3; c++) {
    if (to->picture != NULL) to->picture[3 * pixel + c] = (float)light->picture[c];
    if (to->shadow != NULL) to->shadow[3 * pixel + c] = alpha > 0 ? (float)(light->shadow[c] / alpha) : 0;
  }
}

void hl_reference_parts_write(const reference_parts *parts, double depth_first, const hl_layers *layers,
                              size_t pixel) {
  double alpha = parts->weight;
  const double normal[3] = {parts->normal.x, parts->normal.y, parts->normal.z};
  if (layers->depth_first != NULL) layers->depth_first[pixel] = (float)depth_first;
  if (layers->object != NULL) layers->object[pixel] = (float)parts->object;
  if (layers->depth_mean != NULL)
    layers->depth_mean[pixel] = alpha > 0 ? (float)(parts->depth / alpha) : INFINITY;
  for (size_t c = 0; c < 3; c++) {
    if (layers->ambient != NULL) layers->ambient[3 * pixel + c] = (float)parts->ambient[c];
    if (layers->emission != NULL) layers->emission[3 * pixel + c] = (float)parts->emission[c];
    if (layers->sky != NULL) layers->sky[3 * pixel + c] = (float)parts->sky[c];
    if (layers->sky_shadow != NULL)
      layers->sky_shadow[3 * pixel + c] = parts->sky_open[c] > 0
                                              ? (float)(parts->sky_reaching[c] / parts->sky_open[c])
                                              : 0;
    if (layers->normal != NULL) layers->normal[3 * pixel + c] = alpha > 0 ? (float)(normal[c] / alpha) : 0;
  }
  for (size_t l = 0; l < layers->light_count; l++)
    write_light(&parts->lights[l], alpha, &layers->lights[l], pixel);
}
