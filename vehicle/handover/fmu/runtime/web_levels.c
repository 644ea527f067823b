/* Periodic states of a car over frequency and level, for the script of a page: the iteration of
 * vehicle/engines/steady/splitting.py for cars on standing tyres whose only nonlinear laws are friction lines and curves
 * of dampers, p = phi(v). Transforms are sums over the samples of a period, X[k] = n/2 times the amplitude. */
#include <stdlib.h>
#include <string.h>

#include "spectra.h"

#undef EXPORT /* of the core */
#define EXPORT __attribute__((visibility("default")))

enum { N = 128, LINES = N / 2, MOST = 4, KNOTS = 64, PAST = 8, EVERY = 5, LIMIT = 250, SCALINGS = 5 };
static const double RELAXED = 1.6, GROWN = 100.0, LOST = 0.1, SMALLEST = 1e-12, REGULAR = 1e-10, PI = 3.141592653589793;
static const double LADDER[SCALINGS] = {1.0, 0.3, 3.0, 10.0, 0.1}; /* factors of lambda */

typedef struct { double re, im; } Number;
static Number times(Number a, Number b) { return (Number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
static Number less(Number a, Number b) { return (Number){a.re - b.re, a.im - b.im}; }
static Number divided(Number a, Number b) {
  double square = b.re * b.re + b.im * b.im;
  return (Number){(a.re * b.re + a.im * b.im) / square, (a.im * b.re - a.re * b.im) / square};
}
static double size_of(Number a) { return root(a.re * a.re + a.im * a.im); }

/* phi of a damper beyond the slope in the poles: breakpoints w, phi and the slopes of the segments around them. */
typedef struct {
  int32_t knots;
  double w[KNOTS], phi[KNOTS], slope[KNOTS + 1], full;
} Law;

/* Rows are velocities of the dampers, then the displacement of the channel; columns forces of the dampers, then height and
 * velocity of the plates. residue: rows, then columns over the poles; direct: height and velocity of the plates on rows. */
typedef struct {
  int32_t poles, pairs, dampers;
  const Number *pole, *residue;
  const double *direct;
  Transform *transform;
  Law law[MOST];
  double factor, lambda[MOST]; /* of the scaling; lambda */
  Number effect[MOST + 1][MOST][LINES], drive[MOST + 1][LINES], inverse[LINES][MOST][MOST];
  double state[MOST * N], force[MOST * N], motion[MOST * N], history[(MOST + 1) * N], step[MOST * N];
  double last_state[MOST * N], last_step[MOST * N], states[PAST][MOST * N], steps[PAST][MOST * N], products[PAST][PAST];
} Levels;

/* numbers: poles, pairs, dampers, then pole, residue and direct; see level_numbers.py. */
EXPORT Levels *open_levels(const double *numbers, Transform *transform) {
  Levels *l = malloc(sizeof(Levels));
  l->poles = (int32_t)numbers[0], l->pairs = (int32_t)numbers[1], l->dampers = (int32_t)numbers[2];
  l->pole = (const Number *)(numbers + 3), l->residue = l->pole + l->poles;
  l->direct = (const double *)(l->residue + (2 * l->dampers + 3) * l->poles);
  l->transform = transform;
  return l;
}

static double phi_at(const Law *law, double w) {
  int32_t j = 0;
  while (j < law->knots && w > law->w[j]) j++;
  int32_t near = j ? j - 1 : 0;
  return law->knots ? law->phi[near] + law->slope[j] * (w - law->w[near]) : law->slope[0] * w;
}

/* Law of damper i: curve of `knots` breakpoints with a factor, less the viscous damping in the poles, and friction with a
 * limit [N], whose line ends at the velocity `full`. curve: breakpoints, then slopes of the segments. */
EXPORT void set_law(Levels *l, int32_t i, const double *curve, int32_t knots, double scale, double viscous, double limit, double full) {
  Law *law = l->law + i;
  double line[2] = {-full, full};
  int32_t count = 0, a = 0, b = limit > 0.0 ? 0 : 2;
  for (; a < knots || b < 2;) {
    double w = b == 2 || (a < knots && curve[a] <= line[b]) ? curve[a++] : line[b++];
    if (!count || w > law->w[count - 1]) law->w[count++] = w;
  }
  law->knots = count, law->full = limit > 0.0 ? full : 0.0;
  for (int32_t j = 0; j <= count; j++) {
    double w = !count ? 0.0 : j == 0 ? law->w[0] - 1.0 : j == count ? law->w[j - 1] + 1.0 : 0.5 * (law->w[j - 1] + law->w[j]);
    int32_t k = 0;
    while (k < knots && w > curve[k]) k++;
    law->slope[j] = scale * curve[knots + k] - viscous + (limit > 0.0 && absolute(w) < full ? limit / full : 0.0);
  }
  /* phi(0) = 0: first from the lowest breakpoint, then less its value at zero. */
  for (int32_t j = 0; j < count; j++) law->phi[j] = j ? law->phi[j - 1] + law->slope[j] * (law->w[j] - law->w[j - 1]) : 0.0;
  double zero = count ? phi_at(law, 0.0) : 0.0;
  for (int32_t j = 0; j < count; j++) law->phi[j] -= zero;
}

/* p of p = phi(w), p + lambda w = u: over u a polygon too, at the sums phi(w) + lambda w of the breakpoints. */
static double resolved(const Law *law, double lambda, double u) {
  int32_t j = 0;
  while (j < law->knots && u > law->phi[j] + lambda * law->w[j]) j++;
  double slope = law->slope[j] / (law->slope[j] + lambda);
  int32_t near = j ? j - 1 : 0;
  return law->knots ? law->phi[near] + slope * (u - law->phi[near] - lambda * law->w[near]) : slope * u;
}

/* Solve a x = b for `columns` right sides, in place; both matrices have rows of MOST numbers. */
static void solve(int32_t n, Number a[MOST][MOST], Number b[MOST][MOST], int32_t columns) {
  for (int32_t i = 0; i < n; i++)
    for (int32_t r = 0; r < n; r++) {
      Number factor = divided(a[r][i], a[i][i]);
      if (r == i) continue;
      for (int32_t c = i; c < n; c++) a[r][c] = less(a[r][c], times(factor, a[i][c]));
      for (int32_t c = 0; c < columns; c++) b[r][c] = less(b[r][c], times(factor, b[i][c]));
    }
  for (int32_t r = 0; r < n; r++)
    for (int32_t c = 0; c < columns; c++) b[r][c] = divided(b[r][c], a[r][r]);
}

/* Responses of the rows at the harmonics of a frequency [rad/s]; a pair of poles s, s* with the product a of its residues
 * has (jw Re a - Re(a s*))/((jw)^2 - 2 jw Re s + |s|^2). */
static void respond(Levels *l, double frequency) {
  int32_t d = l->dampers, rows = d + 1, columns = d + 2;
  for (int32_t k = 1; k < LINES; k++) {
    double w = k * frequency;
    for (int32_t r = 0; r < rows; r++) {
      Number sum[MOST + 2] = {{0.0, 0.0}};
      for (int32_t p = 0; p < l->poles; p++) {
        Number s = l->pole[p], row = l->residue[r * l->poles + p];
        double re = s.re * s.re + s.im * s.im - w * w, im = -2.0 * w * s.re;
        if (p >= l->pairs) re = -s.re, im = w;
        Number factor = divided((Number){1.0, 0.0}, (Number){re, im});
        for (int32_t c = 0; c < columns; c++) {
          Number a = times(row, l->residue[(rows + c) * l->poles + p]);
          Number over = p < l->pairs ? (Number){-(a.re * s.re + a.im * s.im), w * a.re} : (Number){a.re, 0.0};
          Number part = times(over, factor);
          sum[c].re += part.re, sum[c].im += part.im;
        }
      }
      double second = r == d ? -w * w : 1.0; /* the channel is an acceleration */
      for (int32_t c = 0; c < d; c++) l->effect[r][c][k] = (Number){second * sum[c].re, second * sum[c].im};
      Number height = sum[d], speed = sum[d + 1];
      height.re += l->direct[r], speed.re += l->direct[rows + r];
      l->drive[r][k] = (Number){second * (height.re - w * speed.im), second * (height.im + w * speed.re)};
    }
  }
}

/* Choose lambda, and invert 1 + lambda G at each harmonic; a constant force moves no damper. */
static void scale(Levels *l, double factor) {
  int32_t d = l->dampers;
  if (l->factor == factor) return;
  l->factor = factor;
  for (int32_t i = 0; i < d; i++) {
    double fall = 0.0;
    for (int32_t j = 0; j <= l->law[i].knots; j++) fall = larger(fall, -l->law[i].slope[j]);
    l->lambda[i] = larger(factor / larger(size_of(l->effect[i][i][1]), 1e-30), 1.5 * fall);
  }
  for (int32_t k = 0; k < LINES; k++) {
    Number a[MOST][MOST];
    memset(l->inverse[k], 0, sizeof(l->inverse[k]));
    for (int32_t i = 0; i < d; i++) {
      l->inverse[k][i][i].re = 1.0;
      for (int32_t j = 0; j < d; j++) {
        Number g = k ? l->effect[i][j][k] : (Number){0.0, 0.0};
        a[i][j] = (Number){l->lambda[i] * g.re + (i == j), l->lambda[i] * g.im};
      }
    }
    solve(d, a, l->inverse[k], d);
  }
}

/* Lines 0 ... LINES - 1 of a periodic history of each damper; two are transformed as one complex record. */
static void lines_of(Levels *l, const double *history, Number lines[MOST][LINES]) {
  for (int32_t i = 0; i < l->dampers; i += 2) {
    double x[N], y[N];
    int both = i + 1 < l->dampers;
    memcpy(x, history + i * N, sizeof(x));
    if (both) memcpy(y, history + (i + 1) * N, sizeof(y));
    else memset(y, 0, sizeof(y));
    core_transform(l->transform, x, y);
    for (int32_t k = 0; k < LINES; k++) {
      int32_t back = (N - k) % N;
      lines[i][k] = (Number){0.5 * (x[k] + x[back]), 0.5 * (y[k] - y[back])};
      if (both) lines[i + 1][k] = (Number){0.5 * (y[k] + y[back]), 0.5 * (x[back] - x[k])};
    }
  }
}

/* Histories of `count` rows of lines: the transform of the conjugate. */
static void histories_of(Levels *l, int32_t count, Number lines[][LINES], double *history) {
  for (int32_t i = 0; i < count; i += 2) {
    double x[N] = {0.0}, y[N] = {0.0};
    for (int32_t k = 0; k < LINES; k++) {
      Number a = lines[i][k], b = i + 1 < count ? lines[i + 1][k] : (Number){0.0, 0.0};
      /* a + i b at k, and a* + i b* at -k; conjugated. */
      x[k] += a.re - b.im, y[k] -= a.im + b.re;
      if (k) x[N - k] += a.re + b.im, y[N - k] -= b.re - a.im;
    }
    core_transform(l->transform, x, y);
    for (int32_t t = 0; t < N; t++) {
      history[i * N + t] = x[t] / N;
      if (i + 1 < count) history[(i + 1) * N + t] = -y[t] / N;
    }
  }
}

static double product(int32_t n, const double *a, const double *b) {
  double sum = 0.0;
  for (int32_t t = 0; t < n; t++) sum += a[t] * b[t];
  return sum;
}

/* Anderson's combination of the last steps; `best` is the smallest square of a step. */
static void accelerate(Levels *l, int32_t iteration, double *best) {
  int32_t n = l->dampers * N, slot = iteration % PAST;
  double size = product(n, l->step, l->step), trace = 0.0, weight[PAST], matrix[PAST][PAST];
  *best = smaller(*best, size);
  if (iteration > 1) {
    for (int32_t t = 0; t < n; t++) {
      l->states[slot][t] = l->state[t] - l->last_state[t];
      l->steps[slot][t] = l->step[t] - l->last_step[t];
    }
    for (int32_t j = 0; j < PAST; j++) l->products[slot][j] = l->products[j][slot] = product(n, l->steps[j], l->steps[slot]);
    if (!(size <= GROWN * *best)) {
      memset(l->states, 0, sizeof(l->states)), memset(l->steps, 0, sizeof(l->steps)), memset(l->products, 0, sizeof(l->products));
      *best = size;
    }
  }
  memcpy(l->last_state, l->state, sizeof(l->state)), memcpy(l->last_step, l->step, sizeof(l->step));
  for (int32_t j = 0; j < PAST; j++) trace += l->products[j][j];
  trace = trace > 0.0 ? trace : 1.0;
  for (int32_t i = 0; i < PAST; i++) {
    weight[i] = product(n, l->steps[i], l->step) / trace;
    for (int32_t j = 0; j < PAST; j++) matrix[i][j] = l->products[i][j] / trace + (i == j ? REGULAR : 0.0);
  }
  for (int32_t i = 0; i < PAST; i++) /* the matrix is positive */
    for (int32_t r = i + 1; r < PAST; r++) {
      double factor = matrix[r][i] / matrix[i][i];
      for (int32_t c = i; c < PAST; c++) matrix[r][c] -= factor * matrix[i][c];
      weight[r] -= factor * weight[i];
    }
  for (int32_t i = PAST - 1; i >= 0; i--) {
    for (int32_t c = i + 1; c < PAST; c++) weight[i] -= matrix[i][c] * weight[c];
    weight[i] /= matrix[i][i];
  }
  for (int32_t t = 0; t < n; t++) {
    double change = 0.0;
    for (int32_t j = 0; j < PAST; j++) change += weight[j] * (l->states[j][t] + l->steps[j][t]);
    l->state[t] += l->step[t] - change;
  }
}

/* Iterate from `state`; return 1 if the forces have converged. */
static int iterate(Levels *l, double level, double tolerance) {
  int32_t d = l->dampers, n = d * N;
  double best = 1e300;
  memset(l->states, 0, sizeof(l->states)), memset(l->steps, 0, sizeof(l->steps)), memset(l->products, 0, sizeof(l->products));
  for (int32_t iteration = 1; iteration <= LIMIT; iteration++) {
    Number lines[MOST][LINES], x[MOST][LINES];
    lines_of(l, l->state, lines);
    for (int32_t i = 0; i < d; i++)
      lines[i][1].re += l->lambda[i] * 0.5 * N * level * l->drive[i][1].re, lines[i][1].im += l->lambda[i] * 0.5 * N * level * l->drive[i][1].im;
    for (int32_t k = 0; k < LINES; k++)
      for (int32_t i = 0; i < d; i++) {
        x[i][k] = (Number){0.0, 0.0};
        for (int32_t j = 0; j < d; j++) {
          Number part = times(l->inverse[k][i][j], lines[j][k]);
          x[i][k].re += part.re, x[i][k].im += part.im;
        }
      }
    histories_of(l, d, x, l->history);
    double gap = 0.0, largest = 0.0;
    for (int32_t t = 0; t < n; t++) {
      double u = 2.0 * l->history[t] - l->state[t], p = resolved(l->law + t / N, l->lambda[t / N], u);
      l->motion[t] = (u - p) / l->lambda[t / N], l->force[t] = p, l->step[t] = RELAXED * (p - l->history[t]);
      gap = larger(gap, absolute(p - l->history[t])), largest = larger(largest, absolute(p));
    }
    int final = iteration == LIMIT;
    if (iteration % EVERY == 0 || final) {
      if (gap <= tolerance * largest + SMALLEST) return 1;
      if (!(gap <= (final ? LOST : 1.0 / (LOST * LOST)) * largest + SMALLEST)) {
        memset(l->force, 0, sizeof(l->force)), memset(l->motion, 0, sizeof(l->motion));
        return 0;
      }
      if (final) return 0;
    }
    accelerate(l, iteration, &best);
  }
  return 0;
}

/* Return the points without a result. value: amplitude of the first harmonic of the channel over the level and share of
 * the period in which each damper slips, (levels, 1 + dampers), -1 without a result; then the level at which each damper
 * lets go while all others stick, w = (1 + G C)^-1 W with the slopes C at rest, (dampers). */
EXPORT int32_t level_line(Levels *l, double frequency, const double *level, int32_t levels, double tolerance, double *value) {
  int32_t d = l->dampers, left = 0;
  Number a[MOST][MOST], w[MOST][MOST], lines[MOST][LINES];
  respond(l, 2.0 * PI * frequency);
  l->factor = 0.0;
  for (int32_t m = 0; m < levels; m++, value += 1 + d) {
    int ended = 0;
    memset(l->force, 0, sizeof(l->force)), memset(l->motion, 0, sizeof(l->motion));
    for (int32_t s = 0; s < SCALINGS && !ended; s++) {
      scale(l, LADDER[s]);
      for (int32_t t = 0; t < d * N; t++) l->state[t] = l->force[t] - l->lambda[t / N] * l->motion[t];
      ended = iterate(l, level[m], tolerance);
    }
    if (!ended) left++;
    lines_of(l, l->force, lines);
    Number sum = {level[m] * l->drive[d][1].re, level[m] * l->drive[d][1].im};
    for (int32_t i = 0; i < d; i++) {
      sum = less(sum, times(l->effect[d][i][1], (Number){lines[i][1].re / (0.5 * N), lines[i][1].im / (0.5 * N)}));
      int32_t slips = 0;
      for (int32_t t = i * N; t < (i + 1) * N; t++) slips += absolute(l->motion[t]) > l->law[i].full;
      value[1 + i] = ended ? (double)slips / N : -1.0;
    }
    value[0] = ended ? size_of(sum) / level[m] : -1.0;
  }
  for (int32_t i = 0; i < d; i++) {
    w[i][0] = l->drive[i][1];
    for (int32_t j = 0; j < d; j++) {
      const Law *law = l->law + j;
      int32_t k = 0;
      while (k < law->knots && 0.0 > law->w[k]) k++;
      double slope = law->knots && k < law->knots && law->w[k] == 0.0 ? larger(law->slope[k], law->slope[k + 1]) : law->slope[k];
      Number g = l->effect[i][j][1];
      a[i][j] = (Number){slope * g.re + (i == j), slope * g.im};
    }
  }
  solve(d, a, w, 1);
  for (int32_t i = 0; i < d; i++) value[i] = l->law[i].full / size_of(w[i][0]);
  return left;
}
