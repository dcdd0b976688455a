/* elementary/elementary.h - computes exponentials, logarithms, powers, roots and angles by plain arithmetic.
 *
 * The functions of C libraries differ between systems, and between processors of one system, in their last
 * bits. A camera, a light or a table that differs in its last bit makes another picture. The functions here
 * use additions, multiplications, divisions and square roots alone, which every machine rounds alike, so that
 * pictures have the same bytes everywhere. Their greatest errors are those of the table in
 * tests/unit/elementary.c, one to four units in the last place. Special values follow the C standard (annex
 * F), but without exceptions of the floating-point environment. The file calls nothing else. */
#ifndef HL_ELEMENTARY_H
#define HL_ELEMENTARY_H

#define HL_PI  3.14159265358979323846
#define HL_LN2 0.69314718055994530942

double hl_exp(double x);
double hl_exp2(double x);
/* Computes e^x - 1, accurately for small x. */
double hl_expm1(double x);

/* The natural logarithm. */
double hl_ln(double x);
/* Computes ln(1 + x), accurately for small x. */
double hl_log1p(double x);
double hl_log2(double x);
/* Exact for powers of ten from 1e-22 to 1e22. */
double hl_log10(double x);

/* Computes x^y. Exact for whole y from 0 to 32 if x^y has at most 53 bits. */
double hl_pow(double x, double y);
double hl_cbrt(double x);
/* Computes sqrt(x^2 + y^2) without overflow between the steps. */
double hl_hypot(double x, double y);

/* Angles in radians, with a magnitude of at most 1e6: greater ones give less accurate results. */
double hl_sin(double x);
double hl_cos(double x);
double hl_tan(double x);
double hl_asin(double x);
double hl_acos(double x);
double hl_atan(double x);
double hl_atan2(double y, double x);

/* Computes the sine and the cosine of an angle in degrees. They are exact at multiples of 90.
 * angle_deg: its magnitude is at most 1e6. */
void hl_sine_cosine(double angle_deg, double *sine, double *cosine);

/* The error function, 2 / sqrt(pi) times the integral of exp(-t^2) from 0 to x. */
double hl_erf(double x);

#endif
