/* gpu/kernels/taps.h - finds the kernel's weights, and the weighted sum of four neighbouring voxels along x.
 * The functions compute for one pixel the same numbers as grid/kernel_lanes.h and fill/row_lanes.h for
 * sixteen. STORAGE and BSPLINE come from the variant (gpu/device_sweep.h). */
#ifndef HL_GPU_TAPS_H
#define HL_GPU_TAPS_H

#include "core/sheet_constants.h"
#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

#define STORED_U8  0
#define STORED_U16 1
#define STORED_F32 2

/* ---- the kernel ---- */

DEVICE float kernel_piece(GLOBAL const float *piece, float a) {
  float sum = piece[5];
  for (int power = 4; power >= 0; power--) sum = fused(sum, a, piece[power]);
  return sum;
}
DEVICE float kernel_piece_slope(GLOBAL const float *piece, float a) {
  float sum = piece[5] * 5.0f;
  for (int power = 4; power >= 1; power--) sum = fused(sum, a, piece[power] * (float)power);
  return sum;
}
DEVICE float bspline_inner(float distance) {
  return fused(distance * distance, fused(distance, 0.5f, -1.0f), 2.0f / 3);
}
DEVICE float bspline_outer(float rest) { return rest * rest * (rest * (1.0f / 6)); }

/* Finds the kernel's weights for four taps of voxels, at floor-1 .. floor+2, for a point with the fraction
 * t. */
DEVICE void tap_weights(GLOBAL const plan_volume *volume, float t, float weight[4]) {
  float s = 1.0f - t;
#if BSPLINE
  (void)volume;
  weight[0] = bspline_outer(s);
  weight[1] = bspline_inner(t);
  weight[3] = bspline_outer(t);
#else
  weight[0] = kernel_piece(volume->outer, t);
  weight[1] = kernel_piece(volume->inner, t);
  weight[3] = kernel_piece(volume->outer, s);
#endif
  weight[2] = 1.0f - (weight[0] + weight[1] + weight[3]);
}

/* Derivatives of the weights by t. */
DEVICE void tap_slopes(GLOBAL const plan_volume *volume, float t, float slope[4]) {
  float s = 1.0f - t;
#if BSPLINE
  (void)volume;
  slope[0] = s * (s * -0.5f);
  slope[1] = t * fused(t, 1.5f, -2.0f);
  slope[3] = t * (t * 0.5f);
#else
  slope[0] = kernel_piece_slope(volume->outer, t);
  slope[1] = kernel_piece_slope(volume->inner, t);
  slope[3] = -kernel_piece_slope(volume->outer, s);
#endif
  slope[2] = -(slope[0] + slope[1] + slope[3]);
}

/* Continues the values at the border beyond the grid: adds the weights of outside taps to the border voxel's
 * weight, and moves the four taps inside. Returns the moved cell. */
DEVICE int fold_border(int cell, int count, float weight[4]) {
  int first = cell == -1, second = cell == 0, last_but_one = cell == count - 2, last = cell == count - 1;
  float w0 = weight[0], w1 = weight[1], w2 = weight[2], w3 = weight[3];
  weight[0] = first ? w0 + w1 + w2 : second ? w0 + w1 : last || last_but_one ? 0.0f : w0;
  weight[1] = first ? w3 : second ? w2 : last ? 0.0f : last_but_one ? w0 : w1;
  weight[2] = first ? 0.0f : second ? w3 : last ? w0 : last_but_one ? w1 : w2;
  weight[3] = first || second ? 0.0f : last ? w1 + w2 + w3 : last_but_one ? w2 + w3 : w3;
  int inside = cell < 1 ? 1 : cell;
  return inside > count - 3 ? count - 3 : inside;
}
DEVICE int taps_inside(int cell, int count) { return cell >= 1 && cell < count - 2; }

/* ---- integer weights ---- */

DEVICE int round_to_units(float x, int units) {
  return bits_of(fused(x, (float)units, 12582912.0f)) - bits_of(12582912.0f); /* 3 * 2^22 */
}
/* Rounds weights to whole units, as round_weights() in fill/row_lanes.h: the running sums of the weights are
 * rounded, and not each weight. total: the sum of all four weights. */
DEVICE void round_weights(const float weight[4], int units, int total, int rounded[4]) {
  int first = round_to_units(weight[0], units), two = round_to_units(weight[0] + weight[1], units);
  int last = round_to_units(weight[3], units);
  rounded[0] = first;
  rounded[1] = two - first;
  rounded[2] = total * units - last - two;
  rounded[3] = last;
}

/* ---- rows of four voxels ---- */

#if STORAGE == STORED_F32

typedef struct row_weights {
  float tap[4];
} row_weights;
DEVICE row_weights weights_of_row(const float weight[4]) {
  row_weights w;
  for (int tap = 0; tap < 4; tap++) w.tap[tap] = weight[tap];
  return w;
}
DEVICE row_weights slopes_of_row(const float slope[4]) { return weights_of_row(slope); }
DEVICE unsigned shift_of_row(GLOBAL const byte *row) {
  (void)row;
  return 0;
}
DEVICE float sum_row(GLOBAL const byte *row, const row_weights *w) {
  GLOBAL const float *voxel = (GLOBAL const float *)row;
  return fused(voxel[0], w->tap[0], voxel[1] * w->tap[1]) + fused(voxel[2], w->tap[2], voxel[3] * w->tap[3]);
}
DEVICE float slope_row(GLOBAL const byte *row, const row_weights *w) { return sum_row(row, w); }
#define from_units(sum)       (sum)
#define from_slope_units(sum) (sum)

#else

#define from_units(sum)       ((sum) * (1.0f / WEIGHT_UNITS))
#define from_slope_units(sum) ((sum) * (1.0f / SLOPE_UNITS))

#if defined(__CUDACC_RTC__) || defined(__CUDACC__)
#define DOTS 1
/* The sum of c and of four products, each of a byte of `a` and the same byte of `b`. Bytes of `a` are
 * unsigned; bytes of `b` are signed in the second function. */
DEVICE int dot_bytes(unsigned a, unsigned b, int c) {
  asm("dp4a.u32.u32 %0, %1, %2, %0;" : "+r"(c) : "r"(a), "r"(b));
  return c;
}
DEVICE int dot_signed_bytes(unsigned a, unsigned b, int c) {
  asm("dp4a.u32.s32 %0, %1, %2, %0;" : "+r"(c) : "r"(a), "r"(b));
  return c;
}
/* The sum of c and of two products. Each product multiplies one of the two 16-bit numbers in `a` by a byte of
 * `b`. dot_low() uses the two lower bytes of `b`, dot_high() the two higher bytes. */
DEVICE int dot_low(unsigned a, unsigned b, int c) {
  asm("dp2a.lo.u32.u32 %0, %1, %2, %0;" : "+r"(c) : "r"(a), "r"(b));
  return c;
}
DEVICE int dot_high(unsigned a, unsigned b, int c) {
  asm("dp2a.hi.u32.u32 %0, %1, %2, %0;" : "+r"(c) : "r"(a), "r"(b));
  return c;
}
DEVICE int dot_signed_low(unsigned a, unsigned b, int c) {
  asm("dp2a.lo.u32.s32 %0, %1, %2, %0;" : "+r"(c) : "r"(a), "r"(b));
  return c;
}
DEVICE int dot_signed_high(unsigned a, unsigned b, int c) {
  asm("dp2a.hi.u32.s32 %0, %1, %2, %0;" : "+r"(c) : "r"(a), "r"(b));
  return c;
}
/* The 32 bits of two words, low and high, that begin at bit `shift` of the lower word. */
DEVICE unsigned word_between(unsigned low, unsigned high, unsigned shift) {
  return __funnelshift_r(low, high, shift);
}
/* Two functions that join bytes of four numbers in one word: first_bytes() the lowest bytes, second_bytes()
 * the next higher bytes. */
DEVICE unsigned first_bytes(const int x[4]) {
  return __byte_perm(__byte_perm(x[0], x[1], 0x0040), __byte_perm(x[2], x[3], 0x0040), 0x5410);
}
DEVICE unsigned second_bytes(const int x[4]) {
  return __byte_perm(__byte_perm(x[0], x[1], 0x0051), __byte_perm(x[2], x[3], 0x0051), 0x5410);
}
#elif !defined(__OPENCL_VERSION__)
#define DOTS 1
DEVICE int dot_bytes(unsigned a, unsigned b, int c) {
  for (int i = 0; i < 32; i += 8) c += (int)((a >> i & 255) * (b >> i & 255));
  return c;
}
DEVICE int dot_signed_bytes(unsigned a, unsigned b, int c) {
  for (int i = 0; i < 32; i += 8) c += (int)(a >> i & 255) * (int)(signed char)(b >> i & 255);
  return c;
}
DEVICE int dot_low(unsigned a, unsigned b, int c) {
  return (int)((unsigned)c + (a & 65535) * (b & 255) + (a >> 16) * (b >> 8 & 255));
}
DEVICE int dot_high(unsigned a, unsigned b, int c) { return dot_low(a, b >> 16, c); }
DEVICE int dot_signed_low(unsigned a, unsigned b, int c) {
  return (int)((unsigned)c + (a & 65535) * (unsigned)(signed char)(b & 255) +
               (a >> 16) * (unsigned)(signed char)(b >> 8 & 255));
}
DEVICE int dot_signed_high(unsigned a, unsigned b, int c) { return dot_signed_low(a, b >> 16, c); }
DEVICE unsigned word_between(unsigned low, unsigned high, unsigned shift) {
  return (unsigned)(((uint64_t)high << 32 | low) >> shift);
}
DEVICE unsigned first_bytes(const int x[4]) {
  unsigned bytes = 0;
  for (int i = 0; i < 4; i++) bytes |= ((unsigned)x[i] & 255u) << (8 * i);
  return bytes;
}
DEVICE unsigned second_bytes(const int x[4]) {
  unsigned bytes = 0;
  for (int i = 0; i < 4; i++) bytes |= ((unsigned)x[i] >> 8 & 255u) << (8 * i);
  return bytes;
}
#endif

#ifdef DOTS

/* Four weights of two bytes each: a word of the four higher bytes, which are signed in slopes, and a word of
 * the four lower bytes. */
typedef struct row_weights {
  unsigned high, low;
} row_weights;

DEVICE row_weights split_weights(const int tap[4]) {
  row_weights w;
  w.high = second_bytes(tap);
  w.low = first_bytes(tap);
  return w;
}

typedef struct row_voxels {
  unsigned word[2]; /* u8 uses only the first word */
} row_voxels;

/* Only aligned words are loaded. Rows of voxels begin at multiples of four bytes, and up to eight bytes
 * behind a row may be read. shift_of_row(): the number of bits from the aligned word at or below `row` to
 * `row`, the first of the four voxels. */
DEVICE unsigned shift_of_row(GLOBAL const byte *row) { return ((unsigned)(size_t)row & 3u) * 8u; }
DEVICE row_voxels load_row(GLOBAL const byte *row, unsigned shift) {
  row_voxels voxels;
  GLOBAL const unsigned *words = (GLOBAL const unsigned *)row;
#if STORAGE == STORED_U8
  voxels.word[0] = word_between(words[0], words[1], shift);
  voxels.word[1] = 0;
#else
  unsigned middle = words[1];
  voxels.word[0] = word_between(words[0], middle, shift);
  voxels.word[1] = word_between(middle, words[2], shift);
#endif
  return voxels;
}

#if STORAGE == STORED_U8
DEVICE int weigh(row_voxels voxels, row_weights w) {
  return dot_bytes(voxels.word[0], w.low, dot_bytes(voxels.word[0], w.high, 0) * 256);
}
DEVICE int weigh_signed(row_voxels voxels, row_weights w) {
  return dot_bytes(voxels.word[0], w.low, dot_signed_bytes(voxels.word[0], w.high, 0) * 256);
}
#else
/* Partial sums of products with slopes may exceed 32 bits, but complete sums never do. So sums are computed
 * modulo 2^32. */
DEVICE int weigh(row_voxels voxels, row_weights w) {
  int sum = dot_high(voxels.word[1], w.high, dot_low(voxels.word[0], w.high, 0));
  return dot_high(voxels.word[1], w.low, dot_low(voxels.word[0], w.low, (int)((unsigned)sum << 8)));
}
DEVICE int weigh_signed(row_voxels voxels, row_weights w) {
  int sum = dot_signed_high(voxels.word[1], w.high, dot_signed_low(voxels.word[0], w.high, 0));
  return dot_high(voxels.word[1], w.low, dot_low(voxels.word[0], w.low, (int)((unsigned)sum << 8)));
}
#endif

#else

typedef struct row_weights {
  int tap[4];
} row_weights;
DEVICE row_weights split_weights(const int tap[4]) {
  row_weights w;
  for (int i = 0; i < 4; i++) w.tap[i] = tap[i];
  return w;
}
typedef struct row_voxels {
  int voxel[4];
} row_voxels;
DEVICE unsigned shift_of_row(GLOBAL const byte *row) {
  (void)row;
  return 0;
}
DEVICE row_voxels load_row(GLOBAL const byte *row, unsigned shift) {
  row_voxels voxels;
  (void)shift;
#if STORAGE == STORED_U8
  for (int i = 0; i < 4; i++) voxels.voxel[i] = row[i];
#else
  for (int i = 0; i < 4; i++) voxels.voxel[i] = ((GLOBAL const word16 *)row)[i];
#endif
  return voxels;
}
DEVICE int weigh(row_voxels v, row_weights w) {
  return v.voxel[0] * w.tap[0] + v.voxel[1] * w.tap[1] + (v.voxel[2] * w.tap[2] + v.voxel[3] * w.tap[3]);
}
/* The voxels are reduced by 32768, so that all sums fit 32 bits. This changes no result, because the four
 * slopes add up to 0. */
DEVICE int weigh_signed(row_voxels v, row_weights w) {
  for (int i = 0; i < 4; i++) v.voxel[i] -= STORAGE == STORED_U16 ? 32768 : 0;
  return weigh(v, w);
}

#endif

DEVICE row_weights weights_of_row(const float weight[4]) {
  int rounded[4];
  round_weights(weight, WEIGHT_UNITS, 1, rounded);
  return split_weights(rounded);
}
DEVICE row_weights slopes_of_row(const float slope[4]) {
  int rounded[4];
  round_weights(slope, SLOPE_UNITS, 0, rounded);
  return split_weights(rounded);
}

#endif

#endif
