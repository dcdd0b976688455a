/* shape/texture.c - hypertexture: noise that eats into the soft region of a shape.
 *
 * Derived from Perlin and Hoffert's (1989) D(x (1 + turbulence(x))): the distance of the surface grows by
 * amplitude times the pattern's value, and the density then falls from 1 to 0 over the length `soft` about
 * the new surface. The density goes on as the distance that the edge of a solid of the same density would
 * have.
 */
#include "shape/shape.h"

static double softness(const hl_shape *shape) {
  return shape->texture.soft > 0 ? shape->texture.soft : shape->edge;
}

/* The distance at which a solid's edge has the density of a soft one at this distance. */
static double as_edge(const hl_shape *shape, double distance) {
  double at = distance / softness(shape);
  return shape->edge * (at < -0.5 ? -0.5 : at > 0.5 ? 0.5 : at);
}

static double pattern_at(const hl_hypertexture *texture, vec3 p) {
  vec3 q = vec3_scale(p, texture->frequency);
  double value;
  if (texture->pattern == HL_PATTERN_TURBULENCE) {
    value = hl_turbulence(&texture->noise, q, texture->octaves);
  } else { /* the weights sum to 2 - 2^(1 - octaves) */
    double sum = hl_noise_sum(&texture->noise, q, texture->octaves);
    value = 0.5 + 0.5 * sum / (2 - 2.0 / (double)(1u << texture->octaves));
  }
  value = value < 0 ? 0 : value > 1 ? 1 : value;
  return hl_gain(texture->gain, hl_bias(texture->bias, value));
}

bool hl_hypertexture_matters(const hl_shape *shape, double distance) {
  double a = shape->texture.amplitude, half = softness(shape) / 2;
  return distance + (a < 0 ? a : 0) < half && distance + (a > 0 ? a : 0) > -half;
}

double hl_hypertexture_distance(const hl_shape *shape, double distance, vec3 p, vec3 foot) {
  const hl_hypertexture *texture = &shape->texture;
  if (hl_hypertexture_matters(shape, distance))
    distance += texture->amplitude * pattern_at(texture, texture->strands ? foot : p);
  return as_edge(shape, distance);
}

hl_interval hl_hypertexture_bounds(const hl_shape *shape, hl_interval distance) {
  double a = shape->texture.amplitude;
  return (hl_interval){as_edge(shape, distance.low + (a < 0 ? a : 0)),
                       as_edge(shape, distance.high + (a > 0 ? a : 0))};
}
