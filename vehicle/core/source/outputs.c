/* Outputs of the cars from the states at samples: channels and peaks.
 *
 * An output is a sum over all states, and its weights do not fit in the L1 cache. Therefore a tile of three outputs is
 * computed at four samples together: each weight is loaded once for all of them, and the sums fill the registers.
 * Accelerations are second differences of positions over the differences between samples: `weights`. */
#include "march.h"

enum { TOGETHER = 4 };
typedef struct { V s[TOGETHER][TILE]; } Sums;

/* Add the contribution of a state to a tile at each of the samples. */
INLINE void accumulate(Sums *sums, const V *weight, V a, V b, V c, V d) {
#pragma GCC unroll 3
  for (int i = 0; i < TILE; i++) {
    V w = weight[i];
    sums->s[0][i] += w * a, sums->s[1][i] += w * b, sums->s[2][i] += w * c, sums->s[3][i] += w * d;
  }
}

/* A tile of outputs at four samples, or of their differences from the samples before. kept: number of first states
 * whose differences are in `changes`; z: plate displacements of the samples, or their differences. */
INLINE Sums read_tile(const March *job, const V *weight, int64_t kept, const int64_t *sample, const REAL *z,
                      int differences) {
  Sums sums = {0};
  int64_t states = state_count(job), k = 0, m = job->plates;
  const V *x = job->x.at, *a = x + (sample[0] + 1) * states, *b = x + (sample[1] + 1) * states;
  const V *c = x + (sample[2] + 1) * states, *d = x + (sample[3] + 1) * states;
  if (kept) {
    const V *p = job->changes.at, *e = p + (sample[0] + 1) * kept, *f = p + (sample[1] + 1) * kept;
    const V *g = p + (sample[2] + 1) * kept, *h = p + (sample[3] + 1) * kept;
    for (; k < kept; k++, weight += TILE) accumulate(&sums, weight, e[k], f[k], g[k], h[k]);
  }
  if (differences)
    for (; k < states; k++, weight += TILE)
      accumulate(&sums, weight, a[k] - a[k - states], b[k] - b[k - states], c[k] - c[k - states], d[k] - d[k - states]);
  for (; k < states; k++, weight += TILE) accumulate(&sums, weight, a[k], b[k], c[k], d[k]);
  for (k = 0; k < m; k++, weight += TILE)
    accumulate(&sums, weight, all(z[sample[0] * 2 * m + k]), all(z[sample[1] * 2 * m + k]), all(z[sample[2] * 2 * m + k]),
               all(z[sample[3] * 2 * m + k]));
  return sums;
}

/* Four samples from `first` on; the first one replaces samples after the end. */
INLINE void group_of_samples(int64_t *sample, int64_t first, int64_t stride, int64_t size) {
  for (int i = 0; i < TOGETHER; i++) sample[i] = first + i * stride < size ? first + i * stride : first;
}

/* Compute tiles of outputs into the rows from `first` on of each sample. */
INLINE void fill(const March *job, const Lanes *tiles, int64_t kept, const REAL *z, int differences, int64_t begin,
                 int64_t stride, int64_t size, int64_t width, int64_t first) {
  int64_t sample[TOGETHER], weights = (state_count(job) + job->plates) * TILE;
  V *y = (V *)job->y.at + PAST * width + first;
  for (int64_t n = begin; n < size; n += TOGETHER * stride) {
    group_of_samples(sample, n, stride, size);
    for (int64_t tile = 0; tile < tiles->n[0] / weights; tile++) {
      Sums sums = read_tile(job, (const V *)tiles->at + tile * weights, kept, sample, z, differences);
      for (int i = 0; i < TOGETHER; i++)
        for (int k = 0; k < TILE; k++) y[sample[i] * width + tile * TILE + k] = of_cars(sums.s[i][k]);
    }
  }
}

static __attribute__((noinline)) void fill_positions(const March *job, const REAL *z, int64_t size, int64_t width) {
  if (job->changes.n[0]) fill(job, &job->positions, job->rows.states, z, 1, 0, 1, size, width, 0);
  else fill(job, &job->positions, 0, z, 1, 0, 1, size, width, 0);
}

static __attribute__((noinline)) void fill_levels(const March *job, const REAL *z, int64_t begin, int64_t stride,
                                                  int64_t size, SampleRows s) {
  fill(job, &job->levels, 0, z, 0, begin, stride, size, s.width, s.levels);
}

/* Subtract the forces g of the laws of tyres from their linear loads. */
static void subtract_excess(const March *job, int64_t begin, int64_t stride, int64_t size, SampleRows s) {
  for (int64_t i = 0; i < job->rows.curves; i++)
    for (int64_t n = begin; job->tyre_of.at[i] >= 0 && n < size; n += stride) {
      V *row = (V *)job->y.at + (PAST + n) * s.width;
      row[s.levels + job->tyre_of.at[i]] -= row[s.curves + i];
    }
}

/* Update the extremes of the run: squares of the rotations of each body at the checks; levels, of which the tyre loads
 * come first and are checked with the rotations. */
static __attribute__((noinline)) void update_peaks(const March *job, const REAL *z, int64_t check, int64_t size,
                                                   SampleRows s) {
  int64_t sample[TOGETHER], weights = (state_count(job) + job->plates) * TILE, bodies = job->rotations.n[0] / weights;
  V *peaks = job->peaks.at;
  for (int64_t n = check; n < size; n += TOGETHER * job->check_every) {
    group_of_samples(sample, n, job->check_every, size);
    for (int64_t body = 0; body < bodies; body++) {
      Sums sums = read_tile(job, (const V *)job->rotations.at + body * weights, 0, sample, z, 0);
      for (int i = 0; i < TOGETHER; i++) {
        V a = of_cars(sums.s[i][0]), b = of_cars(sums.s[i][1]), c = of_cars(sums.s[i][2]);
        peaks[body] = vmax(a * a + b * b + c * c, peaks[body]);
      }
    }
  }
  for (int64_t n = job->always ? 0 : check; n < size; n += job->always ? 1 : job->check_every)
    for (int64_t k = (n - check) % job->check_every ? job->loads : 0; k < job->watched; k++) {
      V value = ((V *)job->y.at)[(PAST + n) * s.width + s.levels + k], *low = peaks + bodies + 2 * k;
      low[0] = vmin(value, low[0]), low[1] = vmax(value, low[1]);
    }
}

/* Write the channels of complete samples, which are AHEAD samples older than the newest: samples early ... late of the
 * block, from index `begin` of `out` on. */
static void write_channels(const March *job, SampleRows s, int64_t early, int64_t late, int64_t begin) {
  const V *y = (const V *)job->y.at + (PAST - AHEAD + early) * s.width;
  const REAL *weight = job->weights.at;
  for (int64_t channel = 0; channel < job->wanted.n[0]; channel++) {
    int64_t row = job->wanted.at[channel];
    double *out = job->out.at + channel * job->out.n[1] * job->out.n[2] + begin;
    for (int64_t n = 0; row >= 0 && n < late - early; n++) {
      const V *middle = y + n * s.width + row;
      V value = *middle;
      /* Second difference: weights over ten first differences, `weights` of group_run.py. */
      if (row < s.levels) {
        value = all(weight[0]) * middle[(1 - AHEAD) * s.width];
        for (int64_t k = 1; k < PAST; k++) value += all(weight[k]) * middle[(1 - AHEAD + k) * s.width];
      }
      for (int64_t lane = 0; lane < job->cars.n[0]; lane++)
        out[job->cars.at[lane] * job->out.n[2] + n] = job->offset.at[channel * LANES + lane] + (double)value[lane];
    }
  }
}

/* Outputs of the samples done ... done + size - 1 of the block from their states. */
void NAME(write_outputs)(const March *job, int64_t done, int64_t size) {
  const SampleRows s = sample_rows(job);
  const REAL *z = job->plate_z.at + done * 2 * job->plates;
  /* First sample of this block whose distance from sample 1 of the run is a multiple of check_every. */
  int64_t check = (1 - job->first - done) % job->check_every;
  if (check < 0) check += job->check_every;
  int64_t begin = job->always ? 0 : check, stride = job->always ? 1 : job->check_every;
  fill_positions(job, z + job->plates, size, s.width);
  fill_levels(job, z, begin, stride, size, s);
  subtract_excess(job, begin, stride, size, s);
  update_peaks(job, z, check, size, s);
  int64_t newest = job->first + done - AHEAD, early = newest < 0 ? -newest : 0;
  int64_t late = size < job->out.n[2] - newest ? size : job->out.n[2] - newest;
  if (late > early) write_channels(job, s, early, late, newest + early);
}
