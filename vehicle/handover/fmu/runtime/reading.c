/* Sum over the states of the newest sample and the displacements z of the plates: a linear output. */
#include "march.h"

double NAME(read_row)(const March *job, const void *row, const double *z) {
  const V *weight = row, *x = job->x.at;
  int64_t states = state_count(job), k = 0;
  V sums[4] = {{0}, {0}, {0}, {0}};
  for (; k + 4 <= states; k += 4)
    for (int i = 0; i < 4; i++) sums[i] += weight[k + i] * x[k + i];
  for (; k < states; k++) sums[0] += weight[k] * x[k];
  for (int64_t plate = 0; plate < job->plates; plate++) sums[1] += weight[states + plate] * all(z[2 * plate]);
  return of_cars((sums[0] + sums[2]) + (sums[1] + sums[3]))[0];
}
