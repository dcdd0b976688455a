/* json/color_space.c - mixes two sRGB colours in RGB, HSV, CIELAB and Msh. */
#include "json/color_space.h"

#include <math.h>
#include <string.h>

#include "core/vector.h"
#include "elementary/elementary.h"
#include "scene/function/transfer_function.h"

static double linear_to_srgb(double linear) { /* the curve of IEC 61966-2-1 */
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * hl_pow(linear, 1 / 2.4) - 0.055;
}

static double lab_function(double t) { return t > 0.008856 ? hl_cbrt(t) : 7.787 * t + 16.0 / 116; }
static double lab_inverse(double f) { return f * f * f > 0.008856 ? f * f * f : (f - 16.0 / 116) / 7.787; }

static const double white[3] = {0.9505, 1, 1.089}; /* the white point D65 */

/* Converts sRGB to CIELAB (CIE 1976) by the matrices of IEC 61966-2-1. */
static void srgb_to_lab(const double srgb[3], double lab[3]) {
  double r = hl_srgb_decode(srgb[0]), g = hl_srgb_decode(srgb[1]), b = hl_srgb_decode(srgb[2]);
  double x = lab_function((0.4124 * r + 0.3576 * g + 0.1805 * b) / white[0]);
  double y = lab_function((0.2126 * r + 0.7152 * g + 0.0722 * b) / white[1]);
  double z = lab_function((0.0193 * r + 0.1192 * g + 0.9505 * b) / white[2]);
  lab[0] = 116 * y - 16;
  lab[1] = 500 * (x - y);
  lab[2] = 200 * (y - z);
}

static void lab_to_srgb(const double lab[3], double srgb[3]) {
  double fy = (lab[0] + 16) / 116;
  double x = white[0] * lab_inverse(lab[1] / 500 + fy), y = white[1] * lab_inverse(fy),
         z = white[2] * lab_inverse(fy - lab[2] / 200);
  double linear[3] = {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
                      0.0557 * x - 0.2040 * y + 1.0570 * z};
  for (int c = 0; c < 3; c++) srgb[c] = fmin(fmax(linear_to_srgb(fmax(linear[c], 0)), 0), 1);
}

static void mix(const double a[3], const double b[3], double t, double mixed[3]) {
  for (int c = 0; c < 3; c++) mixed[c] = a[c] + t * (b[c] - a[c]);
}

static void rgb_to_hsv(const double rgb[3], double hsv[3]) {
  double high = fmax(fmax(rgb[0], rgb[1]), rgb[2]), low = fmin(fmin(rgb[0], rgb[1]), rgb[2]),
         span = high - low;
  hsv[0] = 0;
  hsv[1] = high > 0 ? span / high : 0;
  hsv[2] = high;
  if (span <= 0) return;
  if (high == rgb[0]) hsv[0] = (rgb[1] - rgb[2]) / span / 6;
  else if (high == rgb[1]) hsv[0] = (2 + (rgb[2] - rgb[0]) / span) / 6;
  else hsv[0] = (4 + (rgb[0] - rgb[1]) / span) / 6;
  if (hsv[0] < 0) hsv[0] += 1;
}

static void hsv_to_rgb(const double hsv[3], double rgb[3]) {
  for (int c = 0; c < 3; c++) { /* each of the channels R, G and B is a trapezium over the hue */
    double hue = 6 * (hsv[0] + (c == 0 ? 0 : c == 1 ? 2.0 / 3 : 1.0 / 3));
    hue -= 6 * floor(hue / 6);
    rgb[c] = hsv[2] * (1 - hsv[1] + hsv[1] * fmin(fmax(fabs(hue - 3) - 1, 0), 1));
  }
}

static void mix_hsv(const double a[3], const double b[3], double t, bool by_arc, double mixed[3]) {
  double from[3], to[3], between[3];
  rgb_to_hsv(a, from);
  rgb_to_hsv(b, to);
  if (by_arc && to[0] - from[0] > 0.5) from[0] += 1;
  else if (by_arc && from[0] - to[0] > 0.5) to[0] += 1;
  mix(from, to, t, between);
  hsv_to_rgb(between, mixed);
}

/* A colour in the space Msh: magnitude m, saturation angle s and hue h of a CIELAB colour (Moreland 2009,
 * "Diverging color maps for scientific visualization"). The constants in the functions below are from this
 * paper. */
typedef struct msh {
  double m, s, h;
} msh;

static msh msh_of(const double srgb[3]) {
  double lab[3];
  srgb_to_lab(srgb, lab);
  double m = vec3_length(vec3_of(lab));
  double s = m > 0.001 ? hl_acos(fmin(fmax(lab[0] / m, -1), 1)) : 0;
  return (msh){m, s, s > 0.001 ? hl_atan2(lab[2], lab[1]) : 0};
}

/* The hue that an unsaturated colour of magnitude m gets when it is mixed with a saturated colour. With this
 * hue, colours change evenly from one to the other. */
static double spun_hue(msh saturated, double m) {
  if (saturated.m >= m - 0.1) return saturated.h;
  double spin = saturated.s * sqrt(m * m - saturated.m * saturated.m) / (saturated.m * hl_sin(saturated.s));
  return saturated.h > -0.3 * HL_PI ? saturated.h + spin : saturated.h - spin;
}

static void mix_diverging(const double a[3], const double b[3], double t, double mixed[3]) {
  msh from = msh_of(a), to = msh_of(b);
  double turn = fabs(from.h - to.h);
  if (turn > HL_PI) turn = 2 * HL_PI - turn;
  if (from.s > 0.05 && to.s > 0.05 && turn > 0.33 * HL_PI) {
    msh middle = {fmax(fmax(from.m, to.m), 88), 0, 0};
    if (t < 0.5) to = middle, t = 2 * t;
    else from = middle, t = 2 * t - 1;
  }
  if (from.s < 0.05 && to.s > 0.05) from.h = spun_hue(to, from.m);
  else if (from.s > 0.05 && to.s < 0.05) to.h = spun_hue(from, to.m);
  double m = from.m + t * (to.m - from.m), s = from.s + t * (to.s - from.s), h = from.h + t * (to.h - from.h);
  double lab[3] = {m * hl_cos(s), m * hl_sin(s) * hl_cos(h), m * hl_sin(s) * hl_sin(h)};
  lab_to_srgb(lab, mixed);
}

void hl_color_mix(hl_color_space space, const double a[3], const double b[3], double t, double mixed[3]) {
  double from[3], to[3], between[3];
  switch (space) {
    case HL_SPACE_HSV:
    case HL_SPACE_HSV_ARC: mix_hsv(a, b, t, space == HL_SPACE_HSV_ARC, mixed); return;
    case HL_SPACE_DIVERGING: mix_diverging(a, b, t, mixed); return;
    case HL_SPACE_STEP: memcpy(mixed, t > 0 ? b : a, 3 * sizeof *mixed); return;
    case HL_SPACE_LAB:
      srgb_to_lab(a, from);
      srgb_to_lab(b, to);
      mix(from, to, t, between);
      lab_to_srgb(between, mixed);
      return;
    case HL_SPACE_RGB: break;
  }
  mix(a, b, t, mixed);
}
