/* shape/hypertexture.c - computes hypertexture, which is noise that moves the surface of a shape and makes it
 * soft.
 *
 * Derived from Perlin and Hoffert's (1989) D(x (1 + hl_turbulence(x))): the distance from the surface grows
 * by amplitude times the pattern's value, and the density then falls from 1 to 0 over the length `soft` about
 * the new surface. A density is expressed by the distance at which the edge of a solid has this density.
 *
 * Noise, turbulence, bias and gain use only arithmetic that gives the same bits on every machine
 * (elementary/elementary.h). */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "elementary/elementary.h"
#include "shape/shape.h"

/* ---- noise ---- */

/* The next random number, by SplitMix64 (Steele, Lea and Flood 2014). */
static uint64_t next_number(uint64_t *state) {
  uint64_t z = *state += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

void hl_noise_begin(hl_noise *noise, uint64_t seed) {
  uint8_t *p = noise->permutation;
  for (int n = 0; n < 256; n++) p[n] = (uint8_t)n;
  for (int n = 255; n > 0; n--) { /* shuffles the numbers by the method of Fisher and Yates */
    int other = (int)(next_number(&seed) % (uint64_t)(n + 1));
    uint8_t swap = p[n];
    p[n] = p[other];
    p[other] = swap;
  }
  memcpy(p + 256, p, 256);
}

static double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
static double mix(double t, double a, double b) { return a + t * (b - a); }

/* The dot product of an offset and the gradient that the hash chooses. The gradients point to the twelve
 * edges of a cube, so four of the sixteen codes repeat an edge. */
static double slope(int hash, double x, double y, double z) {
  static const double gradient[16][3] = {
      {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
      {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};
  const double *g = gradient[hash & 15];
  return g[0] * x + g[1] * y + g[2] * z;
}

static int64_t cell(double x) {
  int64_t whole = (int64_t)x;
  return whole - (x < (double)whole);
}

double hl_noise_at(const hl_noise *noise, vec3 p) {
  /* doubles as great as this are whole numbers, at which noise is 0 */
  if (!(fabs(p.x) + fabs(p.y) + fabs(p.z) < 0x1p50)) return 0;
  int64_t cx = cell(p.x), cy = cell(p.y), cz = cell(p.z);
  double x = p.x - (double)cx, y = p.y - (double)cy, z = p.z - (double)cz;
  double u = fade(x), v = fade(y), w = fade(z);
  const uint8_t *t = noise->permutation;
  int i = (int)(cx & 255), j = (int)(cy & 255), k = (int)(cz & 255);
  int a = t[i] + j, b = t[i + 1] + j;
  int aa = t[a] + k, ab = t[a + 1] + k, ba = t[b] + k, bb = t[b + 1] + k;
  double near = mix(v, mix(u, slope(t[aa], x, y, z), slope(t[ba], x - 1, y, z)),
                    mix(u, slope(t[ab], x, y - 1, z), slope(t[bb], x - 1, y - 1, z)));
  double far = mix(v, mix(u, slope(t[aa + 1], x, y, z - 1), slope(t[ba + 1], x - 1, y, z - 1)),
                   mix(u, slope(t[ab + 1], x, y - 1, z - 1), slope(t[bb + 1], x - 1, y - 1, z - 1)));
  return mix(w, near, far);
}

double hl_noise_sum(const hl_noise *noise, vec3 p, int octaves) {
  double sum = 0, weight = 1;
  for (int i = 0; i < octaves; i++, weight /= 2, p = vec3_scale(p, 2)) sum += weight * hl_noise_at(noise, p);
  return sum;
}

double hl_turbulence(const hl_noise *noise, vec3 p, int octaves) {
  double sum = 0, weight = 1;
  for (int i = 0; i < octaves; i++, weight /= 2, p = vec3_scale(p, 2))
    sum += weight * fabs(hl_noise_at(noise, p));
  return sum;
}

double hl_bias(double bias, double t) {
  if (bias == 0.5 || t <= 0 || t >= 1) return t;
  return hl_exp(hl_ln(t) * hl_ln(bias) / -HL_LN2);
}

double hl_gain(double gain, double t) {
  if (gain == 0.5) return t;
  return t < 0.5 ? hl_bias(1 - gain, 2 * t) / 2 : 1 - hl_bias(1 - gain, 2 - 2 * t) / 2;
}

/* ---- how noise changes a surface ---- */

static double softness(const hl_shape *shape) {
  return shape->texture.soft > 0 ? shape->texture.soft : shape->edge;
}

/* Converts a distance in a soft shape to the distance from a solid's surface at which the solid has the same
 * density. */
static double as_edge(const hl_shape *shape, double distance) {
  double at = distance / softness(shape);
  return shape->edge * (at < -0.5 ? -0.5 : at > 0.5 ? 0.5 : at);
}

static double pattern_at(const hl_hypertexture *texture, vec3 p) {
  vec3 q = vec3_scale(p, texture->frequency);
  double value;
  if (texture->pattern == HL_PATTERN_TURBULENCE) {
    value = hl_turbulence(&texture->noise, q, texture->octaves);
  } else { /* the weights of the octaves sum to 2 - 2^(1 - octaves) */
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
