/* Scalar mathematics of the core's own: equal bits with every compiler, library and processor, if products and sums are
 * rounded one by one. Without branches: a compiler computes them for several numbers at once.
 *
 * exp(x) = 2^k exp(r), |r| <= ln(2)/2, exp(r) = 1 + 2 r / (2 - c(r)) with Remez's rational form of FreeBSD's e_exp.c;
 * ln(x) = k ln(2) + ln(m), x = 2^k m, with the polynomials of s = (m - 1)/(m + 1) of its e_log.c. Both have errors below
 * one unit in the last place; x^y = exp(y ln x) has a relative error of about 1e-16 (1 + |y ln x|). */
#ifndef CORE_MATHEMATICS_H
#define CORE_MATHEMATICS_H
#include <stdint.h>

static inline double absolute(double x) { return __builtin_fabs(x); }
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double root(double x) { return __builtin_sqrt(x); }

typedef union { double x; uint64_t bits; } Bits;
static const double LN2 = 6.93147180369123816490e-01, LN2_REST = 1.90821492927058770002e-10; /* 32 bits, and the rest */
static const double TO_WHOLE = 6755399441055744.0; /* 1.5 2^52: x + this has the nearest integer in its last bits */

/* exp(x); x beyond -708 ... 708 counts as its end there. */
static inline double exponential(double x) {
  x = smaller(larger(x, -708.0), 708.0);
  Bits shifted = {x * 1.4426950408889634 + TO_WHOLE}, power;
  double k = shifted.x - TO_WHOLE, high = x - k * LN2, low = k * LN2_REST, r = high - low, z = r * r;
  double c = r - z * (1.66666666666666019037e-01 + z * (-2.77777777770155933842e-03 + z * (6.61375632143793436117e-05 +
             z * (-1.65339022054652515390e-06 + z * 4.13813679705723846039e-08))));
  power.bits = (shifted.bits + 1023) << 52;
  return (1.0 - ((low - (r * c) / (2.0 - c)) - high)) * power.x;
}

/* ln(x) for a normal x > 0. */
static inline double logarithm(double x) {
  Bits m = {x}, exponent;
  uint64_t above = m.bits - 0x3fe6a09e00000000; /* distance from sqrt(1/2): m is in [sqrt(1/2), sqrt(2)) */
  exponent.bits = (above >> 52) ^ 0x800; /* exponent + 2048, because the upper 12 bits are its two's complement */
  exponent.bits |= 0x4330000000000000; /* 2^52 + it */
  double k = exponent.x - 4503599627372544.0;
  m.bits -= above & 0xfff0000000000000;
  double f = m.x - 1.0, s = f / (2.0 + f), z = s * s, w = z * z, half = 0.5 * f * f;
  double r = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01)) +
             z * (6.666666666666735130e-01 + w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 +
                  w * 1.479819860511658591e-01)));
  return k * LN2 - ((half - (s * (half + r) + k * LN2_REST)) - f);
}

/* x^y for x >= 0 and y > 0; a power below 1e-307 counts as that. */
static inline double power(double x, double y) { return exponential(y * logarithm(larger(x, 1e-300))); }

/* cos(2 pi x) and sin(2 pi x), with the polynomials of FreeBSD's k_cos.c and k_sin.c on -1/8 ... 1/8; |x| < 1e9. */
static inline void circle(double x, double *cosine, double *sine) {
  Bits quarters = {4.0 * x + TO_WHOLE};
  double a = (x - 0.25 * (quarters.x - TO_WHOLE)) * 6.283185307179586, z = a * a, half = 0.5 * z, w = 1.0 - half;
  double c = w + (((1.0 - w) - half) + z * z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z *
             (2.48015872894767294178e-05 + z * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 +
             z * -1.13596475577881948265e-11))))));
  double s = a + a * z * (-1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 +
             z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
  int turned = quarters.bits & 1, back = quarters.bits >> 1 & 1;
  *cosine = (turned ^ back ? -1.0 : 1.0) * (turned ? s : c);
  *sine = (back ? -1.0 : 1.0) * (turned ? c : s);
}
#endif
