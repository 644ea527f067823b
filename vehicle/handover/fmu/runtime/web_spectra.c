/* Functions of the WebAssembly module around the runs of a page: heights of plates, accelerations, comfort, FRF. */
#include <stdlib.h>
#include <string.h>

#include "spectra.h"

#undef EXPORT /* of the core */
#define EXPORT __attribute__((visibility("default")))

enum { AHEAD = 5, DERIVATIVE = 2 * AHEAD + 1 }; /* as in recorded_acceleration.py */

/* Transform of the smallest length that is a product of powers of 2, 3 and 5 and at least `least`; see fast_length.py. */
EXPORT Transform *open_transform(int32_t least) {
  Transform *t = malloc(sizeof(Transform));
  for (int32_t n = least, rest = 0; rest != 1; t->n = n++)
    for (rest = n; rest % 2 == 0 || rest % 3 == 0 || rest % 5 == 0;) rest /= rest % 2 == 0 ? 2 : rest % 3 == 0 ? 3 : 5;
  t->circle = malloc((size_t)(6 * t->n) * sizeof(double));
  t->work = t->circle + 2 * t->n;
  core_circle(t);
  return t;
}

/* Heights of a track; work: 3 numbers for each sample. */
typedef struct {
  int32_t samples;
  double *z, *work;
} Track;

/* Track of differences of heights of an order modulo 2^16, low bytes first; see packed_numbers.py. */
EXPORT Track *open_track(const uint8_t *bytes, int32_t samples, int32_t order, double step) {
  uint16_t sums[8] = {0};
  Track *track = malloc(sizeof(Track));
  track->samples = samples, track->z = malloc((size_t)(4 * samples) * sizeof(double)), track->work = track->z + samples;
  for (int32_t i = 0; i < samples; i++) {
    uint16_t value = (uint16_t)(bytes[i] | bytes[samples + i] << 8);
    for (int32_t k = 0; k < order; k++) value = sums[k] = (uint16_t)(sums[k] + value);
    track->z[i] = step * (int16_t)value;
  }
  return track;
}

/* Heights of a track at the places ratio k - behind [samples], 0 before its beginning; see page_input.py. */
static void interpolate(const Track *track, double ratio, double behind, int32_t samples, double *z, double *d) {
  int32_t n = track->samples;
  core_spline(n, track->z, 1.0, d, d + n);
  for (int32_t k = 0; k < samples; k++) {
    double at = larger(ratio * k - behind, 0.0);
    int32_t i = at < n - 2 ? (int32_t)at : n - 2;
    double t = at - i, r = 1.0 - t, *h = track->z + i, *s = d + i;
    z[k] = 0.0;
    if (at > 0.0) z[k] = r * r * (1.0 + 2.0 * t) * h[0] + t * t * (1.0 + 2.0 * r) * h[1] + t * r * (r * s[0] - t * s[1]);
  }
}

/* Write z, z' of a plate on a track, and of AHEAD samples more with constant acceleration. plate: first of `samples` +
 * AHEAD pairs at a distance [numbers]. */
EXPORT void fill_plate(const Track *track, double ratio, double behind, int32_t samples, double interval, double *plate,
                       int32_t distance) {
  double *z = track->work, *d = z + track->samples;
  int32_t last = samples - 1;
  if (ratio == 1.0 && behind == 0.0) memcpy(z, track->z, (size_t)samples * sizeof(double));
  else interpolate(track, ratio, behind, samples, z, d);
  core_spline(samples, z, interval, d, d + track->samples);
  double a = (2.0 * d[last - 1] + 4.0 * d[last] - 6.0 * (z[last] - z[last - 1]) / interval) / interval;
  for (int32_t i = 0; i < samples + AHEAD; i++, plate += distance) {
    int32_t k = i < samples ? i : last;
    double t = (i - k) * interval;
    plate[0] = z[k] + d[k] * t + 0.5 * a * t * t, plate[1] = d[k] + a * t;
  }
}

/* Second derivative of a position by the filter of the records, before which the car is at rest; the last AHEAD samples
 * are lost. weights: DERIVATIVE numbers for an interval of 1. */
EXPORT void differentiate(const double *position, int32_t samples, double interval, const double *weights, double *result) {
  for (int32_t i = 0; i < samples - AHEAD; i++) {
    double sum = 0.0;
    for (int32_t k = i < AHEAD ? AHEAD - i : 0; k < DERIVATIVE; k++) sum += weights[k] * (position[i + k - AHEAD] - position[0]);
    result[i] = sum / (interval * interval);
  }
}

/* RMS from the sample `first` on of one record or two, weighted, without the last sample, which closes the span; record:
 * (records, samples). */
EXPORT void weighted_rms(const Transform *t, const double *record, int32_t records, int32_t samples, int32_t first,
                         double interval, const double *sections, int32_t count, double *rms) {
  double *x = t->work, *y = x + t->n;
  int32_t end = samples - 1;
  memset(x, 0, (size_t)(2 * t->n) * sizeof(double));
  for (int32_t i = 0; i < records; i++) memcpy(i ? y : x, record + i * samples, (size_t)end * sizeof(double));
  core_weigh(t, x, y, interval, sections, count);
  for (int32_t i = 0; i < records; i++) {
    double sum = 0.0, *values = i ? y : x;
    for (int32_t k = first; k < end; k++) sum += values[k] * values[k];
    rms[i] = root(sum / (end - first));
  }
}

EXPORT void density_of(const Transform *t, const double *values, int32_t samples, double interval, double *density) {
  core_density(t, values, samples, 1, interval, density);
}

EXPORT double largest_magnitude(const double *values, int32_t count) {
  double most = 0.0;
  for (int32_t k = 0; k < count; k++) most = larger(most, absolute(values[k]));
  return most;
}

EXPORT double share_above(const double *values, int32_t count, double limit) {
  int32_t above = 0;
  for (int32_t k = 0; k < count; k++) above += absolute(values[k]) > limit;
  return (double)above / count;
}

/* Multisine over the lines k = 1 ... `last` of a period with the density of a record, and its FRF:
 *
 *     z = sum over k of 2 size cos(2 pi (f t + phase)),    2 size^2 = density / (n h),    f = k/(n h).
 *
 * density, phase [turns], size: of each line; sum: real and imaginary parts of the FRF, and its squares, of the
 * realisations up to now. */
typedef struct {
  const Transform *t;
  int32_t last, realisations;
  double interval, *density, *phase, *size, *sum;
} Sine;

EXPORT Sine *open_sine(const Transform *t, int32_t last, double interval) {
  double *numbers = malloc((size_t)(t->n / 2 + 1 + 5 * last) * sizeof(double));
  Sine *e = malloc(sizeof(Sine));
  *e = (Sine){.t = t, .last = last, .interval = interval, .sum = numbers, .phase = numbers + 3 * last};
  e->size = e->phase + last, e->density = e->size + last;
  return e;
}

/* Begin an FRF: the density of `samples` heights at a distance, times the square of a level. */
EXPORT void begin_response(Sine *e, const double *z, int32_t samples, int32_t distance, double level) {
  double resolution = 1.0 / ((double)e->t->n * e->interval);
  core_density(e->t, z, samples, distance, e->interval, e->density);
  for (int32_t k = 0; k < e->last; k++) e->size[k] = level * root(0.5 * resolution * e->density[k + 1]);
  for (int32_t k = 0; k < 3 * e->last; k++) e->sum[k] = 0.0;
  e->realisations = 0;
}

/* Draw the phases of a realisation from a seed, with the generator of Numerical Recipes; return the next seed. */
EXPORT uint32_t draw_phases(const Sine *e, uint32_t seed) {
  for (int32_t k = 0; k < e->last; k++) e->phase[k] = (seed = seed * 1664525u + 1013904223u) / 4294967296.0;
  return seed;
}

/* Write z, z' of a plate that the multisine reaches after a delay [s]; plate: first of `samples` pairs at a distance. With
 * the lines A of z, those of z' are -i omega A, and those of z + i z' are (1 + omega) A: one transform. */
EXPORT void excite(const Sine *e, double delay, double *plate, int32_t samples, int32_t distance) {
  int32_t n = (int32_t)e->t->n;
  double *x = e->t->work, *y = x + n, c, s;
  memset(x, 0, (size_t)(2 * n) * sizeof(double));
  for (int32_t k = 1; k <= e->last; k++) {
    double f = k / (n * e->interval), omega = 6.283185307179586 * f, size = e->size[k - 1];
    circle(e->phase[k - 1] - f * delay, &c, &s);
    x[k] = (1.0 + omega) * size * c, y[k] = -(1.0 + omega) * size * s;
    x[n - k] = (1.0 - omega) * size * c, y[n - k] = (1.0 - omega) * size * s;
  }
  core_transform(e->t, x, y);
  for (int32_t i = 0; i < samples; i++, plate += distance) plate[0] = x[i % n], plate[1] = y[i % n];
}

/* Add the FRF of a period of a response to the multisine, whose lines are n size exp(2 pi i phase). */
EXPORT void add_response(Sine *e, const double *response) {
  int32_t n = (int32_t)e->t->n, last = e->last;
  double *x = e->t->work, *y = x + n, c, s;
  memcpy(x, response, (size_t)n * sizeof(double));
  memset(y, 0, (size_t)n * sizeof(double));
  core_transform(e->t, x, y);
  for (int32_t k = 1; k <= last; k++) {
    double size = n * e->size[k - 1], *sum = e->sum + k - 1;
    circle(e->phase[k - 1], &c, &s);
    double a = (x[k] * c + y[k] * s) / size, b = (y[k] * c - x[k] * s) / size;
    sum[0] += a, sum[last] += b, sum[2 * last] += a * a + b * b;
  }
  e->realisations++;
}

/* Mean FRF over the realisations: real parts, imaginary parts, magnitudes, and standard errors of these; (4, last). */
EXPORT void mean_response(const Sine *e, double *result) {
  int32_t last = e->last, count = e->realisations;
  for (int32_t k = 0; k < last; k++, result++) {
    double a = e->sum[k] / count, b = e->sum[last + k] / count, square = a * a + b * b;
    result[0] = a, result[last] = b, result[2 * last] = root(square);
    result[3 * last] = root(larger(e->sum[2 * last + k] / count - square, 0.0) / (count - 1));
  }
}
