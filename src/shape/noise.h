/* shape/noise.h - computes Perlin's gradient noise, and the functions of noise that hypertexture needs. */
#ifndef HL_SHAPE_NOISE_H
#define HL_SHAPE_NOISE_H

#include <stdint.h>

#include "core/vector.h"

/* The table of gradient noise: a permutation of the numbers 0 to 255, stored twice in succession. */
typedef struct hl_noise {
  uint8_t permutation[512];
} hl_noise;

/* Fills the table of noise by a seed. The same seed gives the same noise on every machine. */
void hl_noise_begin(hl_noise *noise, uint64_t seed);

/* Gradient noise at a point, by Perlin (2002): gradients towards the twelve edges of a cube, quintic fade. It
 * is zero at points with whole coordinates, about -1 to 1 between these points, and has the period 256. */
double hl_noise_at(const hl_noise *noise, vec3 p);

/* The sum over octaves i of noise(2^i p) / 2^i. */
double hl_noise_sum(const hl_noise *noise, vec3 p, int octaves);

/* Turbulence by Perlin and Hoffert (1989): the sum over octaves i of abs(noise(2^i p)) / 2^i. */
double hl_turbulence(const hl_noise *noise, vec3 p, int octaves);

/* Two functions of t by Perlin and Hoffert (1989). bias_b(t) = t^(ln b / ln 0.5) maps 0.5 to b. gain_g moves
 * t, from 0 to 1, towards 0.5 (g < 0.5) or away from it. Both leave 0 and 1 unchanged, and change nothing if
 * b or g is 0.5. */
double hl_bias(double bias, double t);
double hl_gain(double gain, double t);

#endif
