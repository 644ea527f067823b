/* Vector of 32 bytes: eight cars in float, or one car in four parts in double, by REAL.
 *
 * a < b ? a : b is one instruction, but neither GCC nor clang finds it in masks of integers or in loops over the
 * numbers: minimum, maximum and choice are written with the instructions of AVX, SSE2 and WebAssembly. All give the
 * bits of a < b ? a : b. A file is compiled once for each number type and processor; NAME adds the variant. */
#ifndef CORE_VECTOR_H
#define CORE_VECTOR_H
#include <stdint.h>

#ifndef REAL
#define REAL double
#endif
#ifndef VARIANT
#define VARIANT d1
#endif
#ifndef AT_ONCE
#define AT_ONCE 8 /* vectors in registers at once: 8 with 16 registers of 32 bytes, 4 with 16 of 16 bytes */
#endif
#define JOINED_(name, variant) name##_##variant
#define JOINED(name, variant) JOINED_(name, variant)
#define NAME(name) JOINED(name, VARIANT)
#define INLINE static inline __attribute__((always_inline))

typedef REAL V __attribute__((vector_size(32), may_alias));
typedef __typeof__((V){0} < (V){0}) Mask;
enum { LANES = 32 / sizeof(REAL), SINGLE = sizeof(REAL) == 4 };

INLINE V all(REAL x) { return x - (V){0}; }

#if defined(__AVX__)
#include <immintrin.h>
#define BY_TYPE(single, both) (SINGLE ? (V)(single) : (V)(both))
INLINE V pick(Mask m, V a, V b) {
  return BY_TYPE(_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m), _mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)m));
}
INLINE V vmin(V a, V b) { return BY_TYPE(_mm256_min_ps((__m256)a, (__m256)b), _mm256_min_pd((__m256d)a, (__m256d)b)); }
INLINE V vmax(V a, V b) { return BY_TYPE(_mm256_max_ps((__m256)a, (__m256)b), _mm256_max_pd((__m256d)a, (__m256d)b)); }
#elif defined(__SSE2__)
#include <emmintrin.h>
typedef union { V v; __m128 s[2]; __m128d d[2]; } Halves;
#define OF_HALVES(name, single, both) \
  INLINE V name(V a, V b) { \
    Halves x = {a}, y = {b}; \
    for (int i = 0; i < 2; i++) \
      if (SINGLE) x.s[i] = single(x.s[i], y.s[i]); \
      else x.d[i] = both(x.d[i], y.d[i]); \
    return x.v; \
  }
OF_HALVES(vmin, _mm_min_ps, _mm_min_pd)
OF_HALVES(vmax, _mm_max_ps, _mm_max_pd)
INLINE V pick(Mask m, V a, V b) { return (V)((m & (Mask)a) | (~m & (Mask)b)); }
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
typedef union { V v; v128_t h[2]; } Halves;
INLINE V vmin(V a, V b) { /* pmin(b, a) is a < b ? a : b */
  Halves x = {a}, y = {b};
  for (int i = 0; i < 2; i++) x.h[i] = SINGLE ? wasm_f32x4_pmin(y.h[i], x.h[i]) : wasm_f64x2_pmin(y.h[i], x.h[i]);
  return x.v;
}
INLINE V vmax(V a, V b) {
  Halves x = {a}, y = {b};
  for (int i = 0; i < 2; i++) x.h[i] = SINGLE ? wasm_f32x4_pmax(y.h[i], x.h[i]) : wasm_f64x2_pmax(y.h[i], x.h[i]);
  return x.v;
}
INLINE V pick(Mask m, V a, V b) {
  Halves x = {a}, y = {b}, z = {(V)m};
  for (int i = 0; i < 2; i++) x.h[i] = wasm_v128_bitselect(x.h[i], y.h[i], z.h[i]);
  return x.v;
}
#else
INLINE V pick(Mask m, V a, V b) { return (V)((m & (Mask)a) | (~m & (Mask)b)); }
INLINE V vmin(V a, V b) { return pick(a < b, a, b); }
INLINE V vmax(V a, V b) { return pick(a > b, a, b); }
#endif

/* a within -limit ... limit. */
INLINE V vclamp(V a, V limit) { return vmin(vmax(a, -limit), limit); }

/* Sum over the four parts of a car, in each part; eight cars have one part each. */
INLINE V of_cars(V x) {
  if (SINGLE) return x;
  return all((x[0] + x[2 % LANES]) + (x[1] + x[3 % LANES]));
}

/* Sum of the parts before each part; zero for eight cars. */
INLINE V before(V x) {
  V sum = {0};
  if (SINGLE) return sum;
  sum[1] = x[0], sum[2 % LANES] = x[0] + x[1], sum[3 % LANES] = (x[1] + x[2 % LANES]) + x[0];
  return sum;
}
#endif
