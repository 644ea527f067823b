/* Poles of a car over a step, and the sums over them.
 *
 * A pole is integrated as the difference y from its static value on the plates (`vehicle.engines.reduced.step_factors`):
 * y+ = y + (E - 1) y + factors times inputs; a damper velocity, a displacement or a sensor is a sum of weights times
 * states. The states are packed in blocks of eight: real and imaginary parts of four pairs, or real poles
 * (`vehicle.engines.reduced.car_table`): the real parts of E - 1 and, for pairs, the imaginary ones; the factors of each
 * input; the weights of each sum. A block keeps its states in registers; each input
 * is loaded once for eight products, and a sum gets its eight products in two short chains. The order of all sums is
 * that of this source, on every processor. */
#include "march.h"

enum { BLOCK = 8 };
#ifdef EMBEDDED
enum { KEEPS = 0 }; /* an instance reads its outputs from the states alone */
#else
enum { KEEPS = 1 };
#endif

/* Advance a block. c: its factors; u: n inputs; sums: w sums; x, to: states before and after; last, now: changes of the
 * states since the last sample, before and after, if `kept`; paired: four pairs, or else eight real poles. */
INLINE void block(const V *c, int64_t n, int64_t w, const V *u, V *sums, const V *x, V *to, const V *last, V *now,
                  int paired, int kept) {
  V a[BLOCK];
  for (int part = 0; part < BLOCK; part += AT_ONCE) {
    V e[AT_ONCE];
    const V *own = c + part, *in = c + BLOCK + part;
#pragma GCC unroll 8
    for (int i = 0; i < AT_ONCE; i += 2) {
      V even = x[part + i], odd = x[part + i + 1];
      /* (E - 1) x, of a pair as a complex product. */
      e[i] = paired ? own[i] * even - own[i + 1] * odd : own[i] * even;
      e[i + 1] = paired ? own[i] * odd + own[i + 1] * even : own[i + 1] * odd;
    }
    for (int64_t k = 0; k < n; k++, in += BLOCK) {
      V input = u[k];
#pragma GCC unroll 8
      for (int i = 0; i < AT_ONCE; i++) e[i] += in[i] * input;
    }
#pragma GCC unroll 8
    for (int i = 0; i < AT_ONCE; i++) {
      a[part + i] = x[part + i] + e[i];
      if (kept) now[part + i] = last[part + i] + e[i];
    }
  }
  /* Stored after all reads: `to` may be x. */
#pragma GCC unroll 8
  for (int i = 0; i < BLOCK; i++) to[i] = a[i];
  const V *q = c + BLOCK + BLOCK * n;
  for (int64_t i = 0; i < w; i++, q += BLOCK) {
    V even = q[0] * a[0], odd = q[1] * a[1];
#pragma GCC unroll 3
    for (int p = 2; p < BLOCK; p += 2) even += q[p] * a[p], odd += q[p + 1] * a[p + 1];
    sums[i] += even + odd;
  }
}

/* Advance all poles by a step and add their sums to the work space. The last block may reach up to seven rows beyond
 * the poles of a sample: its factors there are zero, and what it copies is written later; x and changes end with eight
 * more rows. */
void NAME(advance_poles)(const March *job, const V *x, V *to, const V *last, V *now) {
  V *table = table_of(job), *sums = table + job->rows.work;
  const V *u = table + job->rows.inputs, *c = job->poles.at;
  int64_t n = job->inputs, w = job->sums, pairs = job->rows.pairs, states = job->rows.states, s = 0;
  int64_t size = BLOCK * (1 + n + w);
  if (KEEPS && job->changes.n[0]) {
    for (; s < pairs; s += BLOCK, c += size) block(c, n, w, u, sums, x + s, to + s, last + s, now + s, 1, 1);
    for (; s < states; s += BLOCK, c += size) block(c, n, w, u, sums, x + s, to + s, last + s, now + s, 0, 1);
  } else {
    for (; s < pairs; s += BLOCK, c += size) block(c, n, w, u, sums, x + s, to + s, x, to, 1, 0);
    for (; s < states; s += BLOCK, c += size) block(c, n, w, u, sums, x + s, to + s, x, to, 0, 0);
  }
}
