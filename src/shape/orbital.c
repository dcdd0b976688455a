/* shape/orbital.c - computes the real wave functions of an electron about a nucleus.
 *
 * psi_nlm = e^(-rho / 2) rho^l L_(n-l-1)^(2l+1)(rho) Y_lm, rho = 2 r / (n a): hydrogen's bound states with
 * the real spherical harmonics, cosines for m >= 0 and sines for m < 0. The Bohr radius is a = radius / (n (2
 * n + 4)), so that outside the radius the magnitude is at most about a hundredth of its maximum. */
#include "elementary/elementary.h"
#include "shape/shape.h"

/* The associated Laguerre polynomial L_k^alpha(x) of the order k. It is computed by the recurrence k L_k = (2
 * k - 1 + alpha - x) L_(k-1) - (k - 1 + alpha) L_(k-2). */
static double laguerre(int order, int alpha, double x) {
  double before = 0, value = 1;
  for (int k = 1; k <= order; k++) {
    double next = ((2 * k - 1 + alpha - x) * value - (k - 1 + alpha) * before) / k;
    before = value;
    value = next;
  }
  return value;
}

/* The associated Legendre function P_l^m(c) / s^m, where c is the cosine and s the sine of an angle. It is
 * computed by the recurrence (l - m) P_l = (2 l - 1) c P_(l-1) - (l + m - 1) P_(l-2), without the sign
 * (-1)^m. */
static double legendre_over_sine(int l, int m, double c) {
  double before = 0, value = 1;
  for (int k = 1; k <= m; k++) value *= 2 * k - 1;
  for (int k = m + 1; k <= l; k++) {
    double next = ((2 * k - 1) * c * value - (k + m - 1) * before) / (k - m);
    before = value;
    value = next;
  }
  return value;
}

/* The real part of (x + i y)^abs(m) if m >= 0, else the imaginary part. */
static double around_axis(int m, double x, double y) {
  double real = 1, imaginary = 0;
  for (int k = 0; k < (m < 0 ? -m : m); k++) {
    double next = real * x - imaginary * y;
    imaginary = real * y + imaginary * x;
    real = next;
  }
  return m < 0 ? imaginary : real;
}

double hl_orbital_at(const hl_shape *shape, vec3 p) {
  int n = shape->quantum[0], l = shape->quantum[1], m = shape->quantum[2];
  double r = vec3_length(p);
  if (r >= shape->radius) return 0;
  double rho = 2 * r * (2 * n + 4) / shape->radius, power = 1;
  vec3 direction = r > 0 ? vec3_scale(p, 1 / r) : (vec3){0, 0, 1};
  for (int k = 0; k < l; k++) power *= rho;
  return hl_exp(-rho / 2) * power * laguerre(n - l - 1, 2 * l + 1, rho) *
         legendre_over_sine(l, m < 0 ? -m : m, direction.z) * around_axis(m, direction.x, direction.y);
}
