/* Forces of a step: dampers, groups of Jenkins elements, laws over displacement.
 *
 * A damper force has the mean f_n over step n. If the damper is stuck in this step and the last, the force is linear
 * with the slope (f_n - f_(n-1))/h: third order in the step. In sliding it is constant, except for the damper curve,
 * which acts with the mean of both ends. The forces depend on the velocities at the end of the step. They are solved by
 * Gauss-Seidel iterations, each by its inverse law: v + g F(v) = a is piecewise linear with nodes (x, F), and its
 * inverse has the nodes (x + g F, F), so F is a sum over the segments of their rises times shares between 0 and 1.
 * The iterations begin with the forces of the last step; a force adds the effects of its change to all others. */
#include "scalar_elements.h"

/* Add the effects of the change of force `force` to the velocities and displacements without their own forces; in the
 * last iteration only the later forces need them: laws come first, then dampers and groups. */
INLINE void add_effects(const March *job, int64_t force, V change, int last, int64_t d, int64_t groups, int64_t laws) {
  const Sections *r = &job->rows;
  int64_t others = d + groups, sums = others + laws;
  int is_law = force >= others;
  V *t = table_of(job), *work = t + r->work, stick = force < d ? t[r->stick + force] : (V){0};
  const V *gain = t + r->gain + force, *ramp = t + r->ramp + force;
  /* Dampers and groups; in the last iteration only those that are still to be solved. */
  for (int64_t i = last && !is_law ? force + 1 : 0; i < others; i++)
    if (i != force) {
      V effect = gain[i * sums];
      if (force < d) effect += stick * ramp[i * d];
      work[i] += effect * change;
    }
  /* Laws; in the last iteration only those after a law, because all laws come before the dampers. */
  for (int64_t i = last ? (is_law ? force + 1 : sums) : others; i < sums; i++)
    if (i != force) {
      V effect = gain[i * sums];
      if (force < d) effect += stick * ramp[i * d];
      work[i] += effect * change;
    }
}

/* Take the forces of the last step out of the velocities and displacements: what arrives without the own force. */
INLINE void remove_own(const March *job, int64_t d, int64_t groups, int64_t laws) {
  const Sections *r = &job->rows;
  int64_t tables = laws ? laws - r->rubbers : 0, others = d + groups, sums = others + laws;
  V *t = table_of(job), *arriving = t + r->work;
  const V *force = t + r->inputs, *scalar = force + d;
  for (int64_t i = 0; i < sums; i++) {
    V a = arriving[i];
    /* Forces of the last step as a first guess. A slope is f - f_last: zero for this guess, except that the own force,
     * the unknown, counts from -f_last. */
    for (int64_t k = 0; k < d; k++)
      a += k != i ? t[r->gain + i * sums + k] * force[k] : -t[r->stick + k] * t[r->ramp + i * d + k] * force[k];
    for (int64_t k = d; k < sums; k++)
      if (k != i) a += t[r->gain + i * sums + k] * scalar[k];
    /* A group is solved for its change u in the step. */
    if (i >= d && i < others) a -= t[r->place + i - d];
    if (i >= others) {
      /* r = w - G g_n/2 of a table; r' = w - G g_n of rubber friction. */
      V effect = t[r->own + i - others] * t[r->excess + i - others];
      a -= effect;
      if (i >= others + tables) a -= effect;
    }
    arriving[i] = a;
  }
}

/* Nodes of the inverse law of each damper: velocity without its force, 1/length, force, rise of the force. One car keeps
 * those of the last step if neither the effect g of the force on its velocity nor its friction limit changed. */
INLINE void invert_laws(const March *job, int64_t d, int64_t sums, V *effect, V *node) {
  const Sections *r = &job->rows;
  int64_t nodes = r->pieces + 1;
  V *t = table_of(job), *arriving = t + r->work;
  for (int64_t i = 0; i < d; i++, node += 4 * nodes) {
    const V *law = t + r->law + 3 * nodes * i;
    /* g of v + g F(v) = a: a stuck damper acts by its mean force and by its slope. The half of F_c of the last step is
     * known. */
    V own = t[r->gain + i * sums + i] + t[r->stick + i] * t[r->ramp + i * d + i];
    V *inverse = t + r->inverse + 2 * i, limit = t[r->limit + i];
    effect[i] = own;
    arriving[i] -= own * t[r->hold + i];
    if (!SINGLE && inverse[0][0] == own[0] && inverse[1][0] == limit[0]) continue;
    inverse[0] = own, inverse[1] = limit;
    for (int64_t k = 0; k <= job->pieces.at[i]; k++) {
      V force = law[3 * k + 1] + law[3 * k + 2] * limit;
      node[4 * k] = law[3 * k] + own * force, node[4 * k + 2] = force;
    }
    for (int64_t k = 0; k < job->pieces.at[i]; k++) {
      node[4 * k + 1] = all(1) / (node[4 * k + 4] - node[4 * k]);
      node[4 * k + 3] = node[4 * k + 6] - node[4 * k + 2];
    }
  }
}

/* Solve the forces of d dampers, groups and laws; the work space begins with their velocities and displacements. */
INLINE void solve(const March *job, int64_t d, int64_t groups, int64_t laws) {
  const Sections *r = &job->rows;
  int64_t tables = laws ? laws - r->rubbers : 0, others = d + groups, sums = others + laws, nodes = r->pieces + 1;
  V *t = table_of(job), *arriving = t + r->work, *effect = arriving + sums, *kept = effect + d, *node = kept + d;
  V *corners = node + 4 * nodes * d, *force = t + r->inputs, *scalar = force + 2 * d;
  const V one = all(1), half = all((REAL)0.5), zero = {0};
  if (groups) prepare_groups(job, corners);
  remove_own(job, d, groups, laws);
  for (int64_t i = 0; i < d; i++) kept[i] = force[i];
  invert_laws(job, d, sums, effect, node);
  for (int64_t iteration = 0; iteration < r->iterations; iteration++) {
    int last = iteration == r->iterations - 1;
    for (int64_t c = 0; c < laws; c++) {
      V value = arriving[others + c], excess = t[r->excess + c], f;
      if (c < tables) {
        /* Table: force -(g_n + g+)/2. */
        V end = law_force(job, c, value);
        f = -half * (excess + end);
        if (last) t[r->excess + c] = end;
      } else {
        /* Rubber friction, g = -q: force (q_n + q+)/2 = (q+ - q_n)/2 - g_n. */
        V change = rubber_change(job, c - tables, value);
        f = half * change - excess;
        if (last) advance_rubber(job, c - tables, value + t[r->own + c] * change);
      }
      add_effects(job, others + c, f - scalar[groups + c], last, d, groups, laws);
      scalar[groups + c] = f;
    }
    for (int64_t i = 0; i < d; i++) {
      const V *at = node + 4 * nodes * i, *law = t + r->law + 3 * nodes * i;
      V f = at[2], hold = law[1], a = arriving[i];
      for (int64_t k = 0; k < job->pieces.at[i]; k++) {
        /* Share of segment k that a has passed, 0 to 1; its rises of the force and of F_c/2 count in proportion. */
        V share = vmin(vmax((a - at[4 * k]) * at[4 * k + 1], zero), one);
        f += at[4 * k + 3] * share;
        hold += (law[3 * k + 4] - law[3 * k + 1]) * share;
      }
      /* v+ = a - g F; the mean force contains the half of F_c at the beginning, and keeps that at the end for the next
       * step. */
      t[r->velocity + i] = a - effect[i] * f;
      f = -f - t[r->hold + i];
      add_effects(job, i, f - force[i], last, d, groups, laws);
      force[i] = f;
      if (last) effect[i] = hold;
    }
    for (int64_t g = 0; g < groups; g++) {
      V value = arriving[d + g], f = -group_force(corners + group_rows(job) * g, 2 * r->elements, value);
      if (last) advance_group(job, g, value + t[r->gain + (d + g) * (sums + 1)] * f);
      add_effects(job, d + g, f - scalar[g], last, d, groups, laws);
      scalar[g] = f;
    }
  }
  for (int64_t i = 0; i < d; i++) {
    /* The slope acts if the damper stuck in this step and in the last. */
    force[d + i] = t[r->stick + i] * (force[i] - kept[i]);
    t[r->hold + i] = effect[i];
    V speed = t[r->velocity + i], stuck = pick(vmax(speed, -speed) < t[r->full + i], one, zero);
    t[r->stick + i] = stuck * t[r->stuck + i];
    t[r->stuck + i] = stuck;
  }
}

/* Two or four dampers alone are the common cars: the compiler knows their number. All others in one form. */
void NAME(solve_forces)(const March *job) {
  if (!job->rows.groups && !job->rows.curves && job->dampers == 2) solve(job, 2, 0, 0);
  else if (!job->rows.groups && !job->rows.curves && job->dampers == 4) solve(job, 4, 0, 0);
  else solve(job, job->dampers, job->rows.groups, job->rows.curves);
}
