/* Spectra of records for a page: Fourier transform, weighting, density, spline.
 *
 * A complex record is an array of real parts and an array of imaginary parts. Two real records are transformed as the two
 * parts of one complex record. */
#include <stddef.h>

#include "spectra.h"

EXPORT void core_circle(const Transform *t) {
  for (int64_t k = 0; k < t->n; k++) circle((double)k / (double)t->n, t->circle + k, t->circle + t->n + k);
}

/* One pass of the self-sorting transform of Stockham from a, b to e, f: p parts, m = n/(p s) groups.
 *
 *     y[k + s (p j + r)] = w^(j r s) sum over q of exp(-2 pi i q r/p) x[k + s (j + m q)],    w = exp(-2 pi i/n). */
static inline __attribute__((always_inline)) void pass(int p, int64_t n, int64_t s, const double *circle, const double *a,
                                                       const double *b, double *restrict e, double *restrict f) {
  int64_t far = n / p;
  double c[5], d[5], wc[5], ws[5];
#pragma GCC unroll 5
  for (int r = 0; r < p; r++) c[r] = circle[r * far], d[r] = circle[n + r * far];
  for (int64_t j = 0; j < far; j += s, a += s, b += s, e += s * p, f += s * p) {
#pragma GCC unroll 5
    for (int r = 0; r < p; r++) wc[r] = circle[j * r], ws[r] = circle[n + j * r];
    for (int64_t k = 0; k < s; k++) {
      /* Sums and differences of x[q] and x[p - q]: cosines act on those, sines on these. */
      double sum_x[2], sum_y[2], turn_x[2], turn_y[2];
#pragma GCC unroll 5
      for (int q = 1; 2 * q < p; q++) {
        double u = a[k + far * q], v = b[k + far * q], g = a[k + far * (p - q)], h = b[k + far * (p - q)];
        sum_x[q - 1] = u + g, sum_y[q - 1] = v + h, turn_x[q - 1] = u - g, turn_y[q - 1] = v - h;
      }
#pragma GCC unroll 5
      for (int r = 0; r < p; r++) {
        double u = a[k], v = b[k], sign = r % 2 ? -1.0 : 1.0;
        if (p % 2 == 0) u += sign * a[k + far * (p / 2)], v += sign * b[k + far * (p / 2)];
#pragma GCC unroll 5
        for (int q = 1; 2 * q < p; q++) {
          u += c[q * r % p] * sum_x[q - 1] + d[q * r % p] * turn_y[q - 1];
          v += c[q * r % p] * sum_y[q - 1] - d[q * r % p] * turn_x[q - 1];
        }
        e[k + s * r] = wc[r] * u + ws[r] * v, f[k + s * r] = wc[r] * v - ws[r] * u;
      }
    }
  }
}

/* Transform x + i y in place: X[k] = sum of x[j] exp(-2 pi i j k/n). */
EXPORT void core_transform(const Transform *t, double *x, double *y) {
  int64_t n = t->n, p;
  double *a = x, *b = y, *e = t->work + 2 * n, *f = e + n;
  for (int64_t s = 1; s < n; s *= p) {
    int64_t rest = n / s;
    p = rest % 4 == 0 ? 4 : rest % 5 == 0 ? 5 : rest % 3 == 0 ? 3 : 2;
    if (p == 4) pass(4, n, s, t->circle, a, b, e, f);
    else if (p == 5) pass(5, n, s, t->circle, a, b, e, f);
    else if (p == 3) pass(3, n, s, t->circle, a, b, e, f);
    else pass(2, n, s, t->circle, a, b, e, f);
    double *swap = a;
    a = e, e = swap, swap = b, b = f, f = swap;
  }
  for (int64_t k = 0; a != x && k < n; k++) x[k] = a[k], y[k] = b[k];
}

/* Filter two records x, y of n samples, of which those after the record are zero, in place by a weighting. sections:
 * `Weighting.sections` of vehicle/signals/analysis/weighting.py; (count, 6). */
EXPORT void core_weigh(const Transform *t, double *x, double *y, double interval, const double *sections, int64_t count) {
  int64_t n = t->n;
  core_transform(t, x, y);
  for (int64_t k = 0; k <= n / 2; k++) {
    double f = (double)k / ((double)n * interval), re = 1.0 / (double)n, im = 0.0, c = 1.0, d = 0.0, was;
    for (int64_t i = 0; i < count; i++) {
      const double *b = sections + 6 * i, *a = b + 3;
      double u = b[0] - b[2] * f * f, v = b[1] * f, g = a[0] - a[2] * f * f, h = a[1] * f;
      was = re, re = re * u - im * v, im = was * v + im * u;
      was = c, c = c * g - d * h, d = was * h + d * g;
    }
    double square = c * c + d * d, g = (re * c + im * d) / square;
    double h = 2 * k == n ? 0.0 : (im * c - re * d) / square; /* the line at half the sampling rate is real */
    /* H(-f) is the conjugate of H(f): lines k and n - k have both records' content, so that one complex transform
     * filters two real records. */
    int64_t other = (n - k) % n;
    double u = x[k], v = y[k], past_u = x[other], past_v = y[other];
    /* The conjugate, so that the second transform is the inverse. */
    x[k] = u * g - v * h, y[k] = -(u * h + v * g);
    if (other != k) x[other] = past_u * g + past_v * h, y[other] = past_u * h - past_v * g;
  }
  core_transform(t, x, y);
  for (int64_t k = 0; k < n; k++) y[k] = -y[k];
}

/* Copy n numbers at a distance without their mean, by the window of Hann; zeros for NULL. */
static void window(const Transform *t, const double *from, int64_t distance, double *to) {
  double mean = 0.0;
  for (int64_t k = 0; from && k < t->n; k++) mean += from[k * distance] / (double)t->n;
  for (int64_t k = 0; k < t->n; k++) to[k] = from ? (from[k * distance] - mean) * (0.5 - 0.5 * t->circle[k]) : 0.0;
}

/* One-sided density by Welch, windows of n samples with half overlap, two in one transform. values: `samples` numbers at a
 * distance; density: n/2 + 1 numbers. */
EXPORT void core_density(const Transform *t, const double *values, int64_t samples, int64_t distance, double interval,
                         double *density) {
  int64_t n = t->n, half = n / 2, pieces = samples < n ? 0 : (samples - n) / half + 1;
  double *x = t->work, *y = x + n, power = 0.375 * (double)n; /* mean square of the window: 3/8 */
  for (int64_t k = 0; k <= half; k++) density[k] = 0.0;
  for (int64_t i = 0; i < pieces; i += 2) {
    const double *first = values + i * half * distance;
    window(t, first, distance, x);
    window(t, i + 1 < pieces ? first + half * distance : NULL, distance, y);
    core_transform(t, x, y);
    for (int64_t k = 0; k <= half; k++) {
      double a = x[k], b = y[k], c = x[(n - k) % n], d = y[(n - k) % n];
      /* |X|^2 + |Y|^2 = (|Z_k|^2 + |Z_(n-k)|^2)/2 for Z of x + i y. */
      density[k] += 0.5 * (a * a + b * b + c * c + d * d);
    }
  }
  for (int64_t k = 0; k <= half; k++)
    density[k] *= (k == 0 || k == half ? 1.0 : 2.0) * interval / (power * (double)pieces);
}

/* Derivatives d of the cubic spline through n >= 4 equally spaced samples, not-a-knot at both ends: a tridiagonal system.
 * upper: n numbers of work space. */
EXPORT void core_spline(int64_t n, const double *z, double interval, double *d, double *upper) {
#define RISE(i) ((z[(i) + 1] - z[i]) / interval)
  int64_t last = n - 1;
  upper[0] = 2.0, d[0] = (5.0 * RISE(0) + RISE(1)) / 2.0;
  for (int64_t i = 1; i < last; i++) {
    upper[i] = 1.0 / (4.0 - upper[i - 1]);
    d[i] = (3.0 * (RISE(i - 1) + RISE(i)) - d[i - 1]) * upper[i];
  }
  d[last] = ((5.0 * RISE(last - 1) + RISE(last - 2)) / 2.0 - 2.0 * d[last - 1]) / (1.0 - 2.0 * upper[last - 1]);
  for (int64_t i = last - 1; i >= 0; i--) d[i] -= upper[i] * d[i + 1];
}
