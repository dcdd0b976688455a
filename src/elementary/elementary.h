/* elementary/elementary.h - computes exponentials, logarithms, powers, roots and angles by plain arithmetic.
 *
 * The functions of C libraries differ between systems, and between processors of one system, in their last
 * bits. A picture changes if the last bit of a number of its camera, lights or tables changes. The functions
 * of elementary.h use additions, multiplications, divisions and square roots alone, which every machine
 * rounds alike, so that pictures have the same bytes everywhere. The table in tests/unit/elementary.c has the
 * greatest errors of the functions, one to four units in the last place. Results for special values follow
 * the C standard (annex F), but floating-point exceptions do not. Of the C library, the functions use only
 * functions whose results are exact or correctly rounded, such as floor() and sqrt(). */
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
/* The logarithm to the base 10, which is exact for powers of ten from 1e-22 to 1e22. */
double hl_log10(double x);

/* Computes x^y. The result is exact for whole y from 0 to 32 if x^y has at most 53 bits. */
double hl_pow(double x, double y);
double hl_cbrt(double x);
/* Computes sqrt(x^2 + y^2) without overflow of intermediate results. */
double hl_hypot(double x, double y);

/* The sine, cosine and tangent of an angle in radians. Results are less accurate for angles of a magnitude
 * above 1e6. */
double hl_sin(double x);
double hl_cos(double x);
double hl_tan(double x);
double hl_asin(double x);
double hl_acos(double x);
double hl_atan(double x);
double hl_atan2(double y, double x);

/* Computes the sine and the cosine of an angle in degrees. The sine and the cosine are exact at multiples of
 * 90 degrees. angle_deg: its magnitude is at most 1e6. */
void hl_sine_cosine(double angle_deg, double *sine, double *cosine);

/* The error function, 2 / sqrt(pi) times the integral of exp(-t^2) from 0 to x. */
double hl_erf(double x);

#endif
