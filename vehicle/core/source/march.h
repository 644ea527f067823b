/* Parts of the march of a group of cars; see march.c. The table of a group has a row for each number, a column for each
 * number of a vector; `rows` gives the first row of each section (layout.h). */
#ifndef CORE_MARCH_H
#define CORE_MARCH_H
#include "laws.h"
#include "vector.h"

enum { TILE = 3, PAST = 10, AHEAD = PAST / 2, INNER = 64 }; /* as in table_layout.py, and recorded_acceleration.py */

INLINE V *table_of(const March *job) { return job->table.at; }

/* Number of forces of a step: mean forces of the dampers and their slopes, forces of groups and of laws. */
INLINE int64_t force_count(const March *job) { return 2 * job->dampers + job->rows.groups + job->rows.curves; }

/* Number of the sums that have a force: damper velocities, displacements of groups and of laws. */
INLINE int64_t solved_count(const March *job) { return job->dampers + job->rows.groups + job->rows.curves; }

/* States of a sample: poles, forces, z' of the plates. */
INLINE int64_t state_count(const March *job) { return job->rows.states + force_count(job) + job->plates; }

/* First rows of a sample of the outputs: positions, levels, then of the dampers velocities, forces, friction and
 * coefficients, then the forces of the laws over displacement. */
typedef struct { int64_t levels, speeds, curves, width; } SampleRows;
INLINE SampleRows sample_rows(const March *job) {
  int64_t weights = (state_count(job) + job->plates) * TILE;
  SampleRows s = {.levels = TILE * (job->positions.n[0] / weights)};
  s.speeds = s.levels + TILE * (job->levels.n[0] / weights);
  s.curves = s.speeds + 3 * job->dampers + job->controlled.n[0];
  s.width = s.curves + job->rows.curves;
  return s;
}

void NAME(advance_poles)(const March *job, const V *x, V *to, const V *last, V *now);
void NAME(solve_forces)(const March *job);
void NAME(write_outputs)(const March *job, int64_t done, int64_t size);
#endif
