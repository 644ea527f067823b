/* Scalar mathematics of the core's own: equal bits with every compiler, library and processor.
 *
 * exp(x) = 2^k exp(r), |r| <= ln(2)/2, exp(r) = 1 + 2 r / (2 - c(r)) with Remez's rational form of FreeBSD's e_exp.c.
 * pow(x, y) = exp(y ln x) with y ln x in two numbers: ln m = 2 (s + s^3/3 + ...), s = (m - 1)/(m + 1), x = 2^k m; its
 * leading terms are carried with their rounding errors (Dekker 1971), so the relative error of the power is about 1e-16
 * times its own logarithm at most. Needs no fused products, and must not be compiled with them. */
#ifndef CORE_MATHEMATICS_H
#define CORE_MATHEMATICS_H
#include <stdint.h>

static inline double absolute(double x) { return __builtin_fabs(x); }
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double root(double x) { return __builtin_sqrt(x); }

/* 2^k for -1022 <= k <= 1023. */
static inline double power_of_two(int64_t k) {
  union { uint64_t bits; double x; } value = {(uint64_t)(k + 1023) << 52};
  return value.x;
}

/* exp(high + low), |low| small against |high|. */
static inline double exponential(double high, double low) {
  if (!(high > -745.0)) return high != high ? high : 0.0;
  if (high > 709.7) return high > 709.9 ? 1.0 / 0.0 : exponential(high - 1.0, low) * 2.718281828459045;
  double k = (double)(int64_t)(high * 1.4426950408889634 + (high < 0 ? -0.5 : 0.5));
  double first = high - k * 6.93147180369123816490e-01, second = k * 1.90821492927058770002e-10 - low;
  double r = first - second, square = r * r;
  double c = r - square * (1.66666666666666019037e-01 + square * (-2.77777777770155933842e-03 +
             square * (6.61375632143793436117e-05 + square * (-1.65339022054652515390e-06 +
             square * 4.13813679705723846039e-08))));
  double value = 1.0 - ((second - (r * c) / (2.0 - c)) - first);
  int64_t exponent = (int64_t)k;
  if (exponent < -1000) return value * power_of_two(exponent + 1000) * power_of_two(-1000);
  return exponent > 1000 ? value * power_of_two(exponent - 1) * 2.0 : value * power_of_two(exponent);
}

/* Product of two numbers and its rounding error. */
static inline double exact_product(double a, double b, double *error) {
  double p = a * b, split = 134217729.0, x = split * a, y = split * b;
  double a1 = x - (x - a), a2 = a - a1, b1 = y - (y - b), b2 = b - b1;
  *error = ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
  return p;
}

/* x^y for x >= 0 and y > 0, both finite and far from overflow of their splitting (below 1e280). */
static inline double power(double x, double y) {
  if (x == 0.0) return 0.0;
  int64_t k = 0;
  if (x < 1e-290) x *= 1.8446744073709552e19, k = -64;
  union { double x; uint64_t bits; } m = {x};
  k += (int64_t)(m.bits >> 52) - 1023;
  m.bits = (m.bits & 0x000fffffffffffff) | 0x3ff0000000000000;
  if (m.x > 1.4142135623730951) m.x *= 0.5, k++;
  /* s = (m - 1)/(m + 1) and its error: m - 1 is exact, m + 1 is rounded. */
  double top = m.x - 1.0, bottom = m.x + 1.0, lost = (1.0 - bottom) + m.x, error, more;
  double s = top / bottom, p = exact_product(s, bottom, &error);
  double s_low = (((top - p) - error) - s * lost) / bottom, z = s * s;
  /* 2 (s^3/3 + s^5/5 + ...) up to |s| = 0.172: the terms after s^21 are below 1e-17 of the sum. */
  double series = z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z * (1.0 / 13 +
                  z * (1.0 / 15 + z * (1.0 / 17 + z * (1.0 / 19 + z / 21)))))))));
  double tail = 2.0 * (s * series + s_low), ln2 = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  /* ln x = k ln 2 + 2 s + tail in two numbers; k times the 32 bits of the first part of ln 2 is exact. */
  double a = (double)k * ln2, b = 2.0 * s, sum = a + b, rest = sum - a;
  double low = ((a - (sum - rest)) + (b - rest)) + (tail + (double)k * ln2_low), high = sum + low;
  low = (sum - high) + low;
  double exponent = exact_product(high, y, &more);
  return exponential(exponent, more + low * y);
}
#endif
