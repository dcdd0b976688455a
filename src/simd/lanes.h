/* simd/lanes.h - defines operations on sixteen floats at a time, in one source for every instruction set.
 *
 * The compiler's vector extensions translate each operation to one 512-bit, two 256-bit or four 128-bit
 * instructions. The instructions always do the same IEEE operations in the same order, so the bytes of a
 * picture do not depend on the processor. Intrinsics are used only for operations that the extensions lack
 * (minimum, gather, fused multiply-add). A product and a sum are fused only by lanes_fma()
 * (-ffp-contract=off). */
#ifndef HL_SIMD_LANES_H
#define HL_SIMD_LANES_H

#include <stdint.h>
#include <string.h>

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#elif defined(__wasm_relaxed_simd__)
#include <wasm_simd128.h>
#endif

enum { LANES = 16 };

typedef float lanes __attribute__((vector_size(64)));
typedef int32_t lanes_int __attribute__((vector_size(64)));

#define LANES_INLINE static inline __attribute__((always_inline, unused))

/* LANES_CALL marks functions that take few instructions with AVX2 and many without it. Without AVX2 these
 * functions are not inlined, so that the baseline's code stays small, and compiles quickly under
 * sanitizers. */
#if defined(__AVX2__)
#define LANES_CALL LANES_INLINE
#else
#define LANES_CALL static __attribute__((noinline, unused))
#endif

LANES_INLINE lanes lanes_set(float x) { return (lanes){x, x, x, x, x, x, x, x, x, x, x, x, x, x, x, x}; }
LANES_INLINE lanes_int lanes_set_int(int32_t x) {
  return (lanes_int){x, x, x, x, x, x, x, x, x, x, x, x, x, x, x, x};
}
LANES_INLINE lanes lanes_load(const float *p) {
  lanes v;
  memcpy(&v, p, sizeof v);
  return v;
}
LANES_INLINE void lanes_store(float *p, lanes v) { memcpy(p, &v, sizeof v); }

/* sixteen 16-bit numbers */
typedef uint16_t lanes_short __attribute__((vector_size(32)));
LANES_INLINE lanes_int lanes_load_short_int(const uint16_t *p) {
  lanes_short v;
  memcpy(&v, p, sizeof v);
  return __builtin_convertvector(v, lanes_int);
}
LANES_INLINE lanes lanes_load_short(const uint16_t *p) {
  return __builtin_convertvector(lanes_load_short_int(p), lanes);
}

/* Loads a 4x4 block of pixels: pixel (row, column) goes to lane 4*row + column. Rows are `stride` floats
 * apart. */
LANES_INLINE lanes lanes_load_block(const float *p, size_t stride) {
  lanes v;
  memcpy((char *)&v, p, 16);
  memcpy((char *)&v + 16, p + stride, 16);
  memcpy((char *)&v + 32, p + 2 * stride, 16);
  memcpy((char *)&v + 48, p + 3 * stride, 16);
  return v;
}
LANES_INLINE void lanes_store_block(float *p, size_t stride, lanes v) {
  memcpy(p, (char *)&v, 16);
  memcpy(p + stride, (char *)&v + 16, 16);
  memcpy(p + 2 * stride, (char *)&v + 32, 16);
  memcpy(p + 3 * stride, (char *)&v + 48, 16);
}

/* Chooses a or b in each lane. mask: the result of a comparison: all bits of a lane are set (choose a), or
 * all bits are clear (choose b). */
LANES_INLINE lanes lanes_select(lanes_int mask, lanes a, lanes b) {
  return (lanes)(((lanes_int)a & mask) | ((lanes_int)b & ~mask));
}
LANES_INLINE lanes lanes_keep(lanes_int mask, lanes a) { return (lanes)((lanes_int)a & mask); }
LANES_INLINE lanes_int lanes_select_int(lanes_int mask, lanes_int a, lanes_int b) {
  return (a & mask) | (b & ~mask);
}

/* Turns a mask into one bit for each lane; lane 0 has the lowest bit. */
LANES_CALL uint32_t lanes_bits(lanes_int mask) {
#if defined(__AVX512F__)
  return (uint32_t)_mm512_movepi32_mask((__m512i)mask);
#elif defined(__AVX2__)
  __m256 half[2];
  memcpy(half, &mask, sizeof half);
  return (uint32_t)_mm256_movemask_ps(half[0]) | (uint32_t)_mm256_movemask_ps(half[1]) << 8;
#else
  uint32_t bits = 0;
  for (int lane = 0; lane < LANES; lane++) bits |= (uint32_t)(mask[lane] < 0) << lane;
  return bits;
#endif
}
LANES_CALL lanes_int lanes_from_bits(uint32_t bits) {
  const lanes_int one_bit = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  return (lanes_set_int((int32_t)bits) & one_bit) != 0;
}

/* lanes_min() gives the lesser number, a < b ? a : b, and lanes_max() the greater number, a > b ? a : b. If a
 * or b is NaN, the result is b, as with the processor's instructions. */
LANES_CALL lanes lanes_min(lanes a, lanes b) {
#if defined(__AVX512F__)
  return (lanes)_mm512_min_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
  __m256 x[2], y[2];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  x[0] = _mm256_min_ps(x[0], y[0]);
  x[1] = _mm256_min_ps(x[1], y[1]);
  memcpy(&a, x, sizeof a);
  return a;
#else
  return lanes_select(a < b, a, b);
#endif
}
LANES_CALL lanes lanes_max(lanes a, lanes b) {
#if defined(__AVX512F__)
  return (lanes)_mm512_max_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
  __m256 x[2], y[2];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  x[0] = _mm256_max_ps(x[0], y[0]);
  x[1] = _mm256_max_ps(x[1], y[1]);
  memcpy(&a, x, sizeof a);
  return a;
#else
  return lanes_select(a > b, a, b);
#endif
}

/* gcc says by __FP_FAST_FMAF that the C library's fmaf() is one instruction. clang has no such macro on x86.
 */
#if defined(__FP_FAST_FMAF) || defined(__FMA__)
#define LANES_FMA_IS_FAST
#endif
#if !defined(__AVX2__) && !defined(__ARM_NEON) && !defined(LANES_FMA_IS_FAST) && \
    !defined(__wasm_relaxed_simd__)
typedef double lanes_double __attribute__((vector_size(128)));
typedef int64_t lanes_long __attribute__((vector_size(128)));
typedef uint32_t lanes_unsigned __attribute__((vector_size(64)));
typedef int32_t lanes_words __attribute__((vector_size(128)));

LANES_INLINE int any_lane(lanes_int mask) {
  uint64_t of[LANES / 2], any = 0;
  memcpy(of, &mask, sizeof of);
  for (int i = 0; i < LANES / 2; i++) any |= of[i];
  return any != 0;
}

/* The lower 32 bits of each double. */
LANES_INLINE lanes_int lower_words(lanes_double x) {
  lanes_words words = (lanes_words)x;
  return __builtin_shufflevector(words, words, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
}

/* Computes a b + c in doubles, so that the result is rounded only once. In doubles, the product of two floats
 * is exact, but the sum may be rounded. Rounding the sum to a float is wrong only where the sum is not exact
 * and lies in the middle between two floats; among subnormal floats it may be wrong wherever the sum is not
 * exact. In these cases the sum is first rounded to odd: of the two doubles around the exact sum, the double
 * with an odd last bit is taken, which then rounds to the right float (Boldo and Melquiond, "Emulation of a
 * FMA and correctly rounded sums", 2008). */
LANES_CALL lanes fma_in_doubles(lanes a, lanes b, lanes c) {
  lanes_double product = __builtin_convertvector(a, lanes_double) * __builtin_convertvector(b, lanes_double);
  lanes_double addend = __builtin_convertvector(c, lanes_double), sum = product + addend;
  lanes rounded = __builtin_convertvector(sum, lanes);
  lanes_int subnormal = ((lanes_unsigned)rounded & 0x7fffffffu) - 1u < 0x00800000u;
  lanes_int middle = (lower_words(sum) & 0x1fffffff) == 0x10000000;
  if (!any_lane(middle | subnormal)) return rounded;
  lanes_double back = sum - product, lost = (product - (sum - back)) + (addend - back);
  lanes_long even = ((lanes_long)sum & 1) - 1, inexact = (lost < 0.0) | (lost > 0.0);
  lanes_long outwards = (lost > 0.0) ^ (sum < 0.0); /* a mask: each element has all bits set, or no bit */
  return __builtin_convertvector((lanes_double)((lanes_long)sum + (inexact & even & (-2 * outwards - 1))),
                                 lanes);
}
#endif

/* Computes a b + c, rounded only once, like the C library's fmaf(). */
LANES_INLINE lanes lanes_fma(lanes a, lanes b, lanes c) {
#if defined(__AVX512F__)
  return (lanes)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif defined(__AVX2__)
  __m256 x[2], y[2], z[2];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  memcpy(z, &c, sizeof z);
  for (int i = 0; i < 2; i++) z[i] = _mm256_fmadd_ps(x[i], y[i], z[i]);
  memcpy(&c, z, sizeof c);
  return c;
#elif defined(__ARM_NEON)
  float32x4_t x[4], y[4], z[4];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  memcpy(z, &c, sizeof z);
  for (int i = 0; i < 4; i++) z[i] = vfmaq_f32(z[i], x[i], y[i]);
  memcpy(&c, z, sizeof c);
  return c;
#elif defined(__wasm_relaxed_simd__)
  v128_t x[4], y[4], z[4];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  memcpy(z, &c, sizeof z);
  /* the result is rounded only once (relaxed_fma.wat) */
  for (int i = 0; i < 4; i++) z[i] = wasm_f32x4_relaxed_madd(x[i], y[i], z[i]);
  memcpy(&c, z, sizeof c);
  return c;
#elif defined(LANES_FMA_IS_FAST)
  for (int lane = 0; lane < LANES; lane++) c[lane] = __builtin_fmaf(a[lane], b[lane], c[lane]);
  return c;
#else
  return fma_in_doubles(a, b, c);
#endif
}
/* Computes x slope + offset, rounded only once. */
LANES_INLINE lanes lanes_line(lanes x, float slope, float offset) {
  return lanes_fma(x, lanes_set(slope), lanes_set(offset));
}
/* Computes sum + x factor, rounded only once. */
LANES_INLINE lanes lanes_add_scaled(lanes sum, lanes x, float factor) {
  return lanes_fma(x, lanes_set(factor), sum);
}

LANES_INLINE lanes lanes_clamp(lanes x, float low, float high) {
  return lanes_min(lanes_max(x, lanes_set(low)), lanes_set(high));
}
LANES_INLINE lanes lanes_abs(lanes x) { return (lanes)((lanes_int)x & lanes_set_int(0x7fffffff)); }

/* Multiplies two vectors of 16-bit numbers. A lane holds two signed 16-bit numbers. A lane of the result is
 * the sum of the lane's two products. */
LANES_INLINE lanes_int lanes_multiply_shorts(lanes_int a, lanes_int b) {
#if defined(__AVX512BW__)
  return (lanes_int)_mm512_madd_epi16((__m512i)a, (__m512i)b);
#elif defined(__AVX2__)
  __m256i x[2], y[2];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  x[0] = _mm256_madd_epi16(x[0], y[0]);
  x[1] = _mm256_madd_epi16(x[1], y[1]);
  memcpy(&a, x, sizeof a);
  return a;
#elif defined(__SSE2__)
  __m128i x[4], y[4];
  memcpy(x, &a, sizeof x);
  memcpy(y, &b, sizeof y);
  for (int i = 0; i < 4; i++) x[i] = _mm_madd_epi16(x[i], y[i]);
  memcpy(&a, x, sizeof a);
  return a;
#else
  return (a << 16 >> 16) * (b << 16 >> 16) + (a >> 16) * (b >> 16);
#endif
}

/* Joins the 16-bit numbers of two vectors to pairs. A pair is a number from of[0] and the number at the same
 * place in of[1]. Of every eight pairs, the first four go to pairs[0] and the last four to pairs[1]. */
LANES_INLINE void lanes_unpack_shorts(const lanes_int of[2], lanes_int pairs[2]) {
#if defined(__AVX512BW__)
  pairs[0] = (lanes_int)_mm512_unpacklo_epi16((__m512i)of[0], (__m512i)of[1]);
  pairs[1] = (lanes_int)_mm512_unpackhi_epi16((__m512i)of[0], (__m512i)of[1]);
#elif defined(__AVX2__)
  __m256i x[2], y[2], low[2], high[2];
  memcpy(x, &of[0], sizeof x);
  memcpy(y, &of[1], sizeof y);
  for (int i = 0; i < 2; i++) {
    low[i] = _mm256_unpacklo_epi16(x[i], y[i]);
    high[i] = _mm256_unpackhi_epi16(x[i], y[i]);
  }
  memcpy(&pairs[0], low, sizeof low);
  memcpy(&pairs[1], high, sizeof high);
#elif defined(__SSE2__)
  __m128i x[4], y[4], low[4], high[4];
  memcpy(x, &of[0], sizeof x);
  memcpy(y, &of[1], sizeof y);
  for (int i = 0; i < 4; i++) {
    low[i] = _mm_unpacklo_epi16(x[i], y[i]);
    high[i] = _mm_unpackhi_epi16(x[i], y[i]);
  }
  memcpy(&pairs[0], low, sizeof low);
  memcpy(&pairs[1], high, sizeof high);
#else
  uint16_t x[2 * LANES], y[2 * LANES], both[2][2 * LANES];
  memcpy(x, &of[0], sizeof x);
  memcpy(y, &of[1], sizeof y);
  for (int i = 0; i < 2 * LANES; i++) {
    uint16_t *at = both[i % 8 / 4] + 2 * (i / 8 * 4 + i % 4);
    at[0] = x[i];
    at[1] = y[i];
  }
  memcpy(pairs, both, sizeof both);
#endif
}

LANES_CALL lanes lanes_sqrt(lanes x) {
#if defined(__AVX512F__)
  return (lanes)_mm512_sqrt_ps((__m512)x);
#elif defined(__AVX2__)
  __m256 half[2];
  memcpy(half, &x, sizeof half);
  half[0] = _mm256_sqrt_ps(half[0]);
  half[1] = _mm256_sqrt_ps(half[1]);
  memcpy(&x, half, sizeof x);
  return x;
#else
  for (int lane = 0; lane < LANES; lane++) x[lane] = __builtin_sqrtf(x[lane]);
  return x;
#endif
}

LANES_INLINE lanes lanes_from_int(lanes_int x) { return __builtin_convertvector(x, lanes); }
LANES_INLINE lanes_int lanes_truncate(lanes x) { return __builtin_convertvector(x, lanes_int); }
/* Stores whole numbers from 0 to 65535 as numbers of 16 bits. */
LANES_INLINE void lanes_store_short_int(uint16_t *p, lanes_int v) {
  lanes_short narrow = __builtin_convertvector(v, lanes_short);
  memcpy(p, &narrow, sizeof narrow);
}
/* Stores floats as whole numbers of 16 bits, rounded and at most 65535. v: not negative. */
LANES_INLINE void lanes_store_short(uint16_t *p, lanes v) {
  lanes_store_short_int(p, lanes_truncate(lanes_min(v, lanes_set(65535.0f)) + 0.5f));
}
/* The greatest whole number that is not above x, in each lane. The magnitude of x must be below 2^31. */
LANES_CALL lanes_int lanes_floor(lanes x) {
#if defined(__AVX512F__)
  return (lanes_int)_mm512_cvt_roundps_epi32((__m512)x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
#elif defined(__AVX2__)
  __m256 half[2];
  memcpy(half, &x, sizeof half);
  for (int i = 0; i < 2; i++) half[i] = _mm256_floor_ps(half[i]);
  memcpy(&x, half, sizeof x);
  return lanes_truncate(x);
#else
  lanes_int i = lanes_truncate(x);
  return i + (lanes_from_int(i) > x);
#endif
}

/* Computes 2^x for |x| < 126, with a relative error below 2e-7. x is divided into n + f, with f in [-1/2,
 * 1/2]. 2^n is made by the exponent bits. 2^f is a polynomial of degree 5 with the value 1 at 0; among these
 * polynomials, it has the smallest maximum of the relative error (derived: 9.2e-8 by Remez' exchange, 1.7e-7
 * in floats). */
LANES_CALL lanes lanes_exp2(lanes x) {
  lanes_int n = lanes_floor(x + 0.5f);
  lanes f = x - lanes_from_int(n);
  lanes p = lanes_line(f, 0.00132647273f, 0.00967151279f);
  p = lanes_fma(p, f, lanes_set(0.0555073374f));
  p = lanes_fma(p, f, lanes_set(0.240222421f));
  p = lanes_fma(p, f, lanes_set(0.693146978f));
  p = lanes_fma(p, f, lanes_set(1.0f));
  return p * (lanes)((n + 127) << 23);
}
/* Computes exp(-x) for x >= 0. The result is at least 1e-37. */
LANES_CALL lanes lanes_exp_negative(lanes x) {
  return lanes_exp2(lanes_max(x * -1.44269504089f, lanes_set(-123.0f)));
}
/* Computes log2(x) for normal numbers x > 0, with an absolute error below 1e-6. x is 2^n m, with m in
 * [sqrt(1/2), sqrt(2)). ln m = 2 atanh((m-1)/(m+1)) is computed by its odd series to degree 9 (derived). */
LANES_CALL lanes lanes_log2(lanes x) {
  lanes_int bits = (lanes_int)x - 0x3f3504f3;
  lanes_int n = bits >> 23;
  lanes m = (lanes)((bits & 0x007fffff) + 0x3f3504f3);
  lanes t = (m - 1.0f) / (m + 1.0f), t2 = t * t;
  lanes series = lanes_line(t2, 1.0f / 9, 1.0f / 7);
  series = lanes_fma(series, t2, lanes_set(1.0f / 5));
  series = lanes_fma(series, t2, lanes_set(1.0f / 3));
  series = lanes_fma(series, t2, lanes_set(1.0f));
  return lanes_add_scaled(lanes_from_int(n), t * series, 2.88539008178f);
}
/* Computes base^exponent for a base in [0, 1] and an exponent >= 0. A base below 1e-6 counts as 1e-6. */
LANES_CALL lanes lanes_power_of_part(lanes base, lanes exponent) {
  return lanes_exp2(lanes_max(lanes_log2(lanes_max(base, lanes_set(1e-6f))) * exponent, lanes_set(-100.0f)));
}

#if defined(__AVX2__) && !defined(__AVX512F__)
/* Finds the least of the sixteen lanes of each of four vectors. */
LANES_INLINE __m128i lanes_least_of_each(const lanes_int x[4]) {
  __m128i of_four[4];
  for (int i = 0; i < 4; i++) {
    __m256i half[2];
    memcpy(half, &x[i], sizeof half);
    half[0] = _mm256_min_epi32(half[0], half[1]);
    of_four[i] = _mm_min_epi32(_mm256_castsi256_si128(half[0]), _mm256_extracti128_si256(half[0], 1));
  }
  __m128i first = _mm_min_epi32(_mm_unpacklo_epi32(of_four[0], of_four[1]),
                                _mm_unpackhi_epi32(of_four[0], of_four[1]));
  __m128i last = _mm_min_epi32(_mm_unpacklo_epi32(of_four[2], of_four[3]),
                               _mm_unpackhi_epi32(of_four[2], of_four[3]));
  return _mm_min_epi32(_mm_unpacklo_epi64(first, last), _mm_unpackhi_epi64(first, last));
}
#endif

LANES_INLINE float lanes_greatest(lanes x) {
  float greatest = x[0];
  for (int lane = 1; lane < LANES; lane++) greatest = x[lane] > greatest ? x[lane] : greatest;
  return greatest;
}
LANES_INLINE float lanes_least(lanes x) {
  float least = x[0];
  for (int lane = 1; lane < LANES; lane++) least = x[lane] < least ? x[lane] : least;
  return least;
}

#endif
