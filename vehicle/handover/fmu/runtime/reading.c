/* Outputs of an instance: rows over the newest sample, read when they are asked for. */
#include "march.h"

/* In the place of outputs.c, whose channels of a whole run an instance does not have. */
void NAME(write_outputs)(const March *job, int64_t done, int64_t size) { (void)job, (void)done, (void)size; }

/* Sum over the states of the newest sample and the displacements z of the plates: a linear output. */
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
