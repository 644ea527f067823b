/* March of a group of cars over a block of samples: eight cars in single precision, or one in double precision.
 *
 * A step advances the poles (poles.c) with the inputs that are known at its beginning, solves the forces of the step
 * (forces.c), and sums up the sensors at its end. Every `every` steps a sample of states is kept; after INNER samples
 * their outputs are computed (outputs.c). Nothing is allocated, no global state: all memory is in the March record, and
 * the next call goes on where this one ends. `vehicle.engines.reduced.group_run` makes the record and describes its
 * arrays in layout.h. Another program calls it in the same way: fill a March, call march_d1 (or core_march_d) for each
 * block of samples, read `out`. */
#include "march.h"

/* Inputs that act by the sensors of rolling tyres.
 *
 * A rolling tyre pushes its wheel centre along x by F_z tan(beta). The poles contain the effect of the static load F_0
 * on the slope z'/V, as a force b z' of the velocity of the plate. The current load and a slope that is not z'/V add
 * b (max(0, F_z) / F_0 - 1) V tan(beta) + b (V tan(beta) - z') as a force that is constant over a step: F_z is
 * extrapolated to the middle of the step from the beginnings of this step and of the last one, of second order; z' in
 * the first term is the mean over the step. A sensor is F_z / F_0 - 1. */
static void slope_forces(const March *job, const REAL *rate, V *row) {
  const Sections *r = &job->rows;
  V *t = table_of(job), half = all((REAL)0.5);
  for (int64_t i = 0; i < job->tyres; i++) {
    V load = t[r->sensors + i], middle = load + half * (load - t[r->past + i]), excess = all(rate[3 * job->plates + i]);
    t[r->past + i] = load;
    row[i] = vmax(middle, all(-1)) * (all(rate[job->plates + i]) + excess) + excess;
  }
}

/* Settings of the controlled dampers. The poles contain the softest one; the excess e = c - cmin acts on the mean
 * velocity of a step, f = -e (v + v+)/2: second order, and dissipative at any step. This is the damper curve F_c = e v.
 * Coefficient and force from outside the law, as the commands of an FMU, are a part of this curve. A control law has
 * branches and a memory: it runs for one car, in double precision. */
static void control(const March *job) {
  const Sections *r = &job->rows;
  V *t = table_of(job);
  for (int64_t k = 0; k < job->controlled.n[0]; k++) {
    const Setting *law = job->settings.at + k;
    const V *sensor = t + r->sensors + job->tyres + 2 * k;
    double *memory = job->memory.at + k * job->memory.n[1];
    int64_t i = job->controlled.at[k], nodes = r->pieces + 1;
    act(law, job->step, (double)sensor[1][0], (double)sensor[0][0], memory);
    const double *outside = job->outside.at + 3 * k;
    /* Curve of the step: half of F_c = e v, by the coefficient of the law and what another program gives. */
    V half = all((REAL)(0.5 * (outside[0] * (memory[PRESENT] - law->softest) + outside[1])));
    V push = all((REAL)outside[2]), *node = t + r->law + 3 * nodes * i;
    t[r->hold + i] = half * t[r->velocity + i] + push;
    t[r->inverse + 2 * i] = (V){0}; /* its nodes move */
    for (int64_t n = 0; n < nodes; n++) node[3 * n + 1] = half * node[3 * n] + push;
  }
}

/* Forces of the dampers by address, F(x, v) = D v + R(x, v): D is in the poles, R acts with the mean of both ends of the
 * step. At its end R is the line through the velocities v and v' that are expected there, extrapolated from the last
 * step: second order, exact for a line. x is a sensor. A law by address runs for one car, in double precision. */
static void own_laws(const March *job) {
  const Sections *r = &job->rows;
  V *t = table_of(job);
  int64_t first = r->sensors + job->tyres + 2 * (job->controlled.n[0] + job->sides.n[0]), nodes = r->pieces + 1;
  for (int64_t k = 0; k < job->own.n[0]; k++) {
    const OwnLaw *law = job->own_laws.at + k;
    int64_t i = job->own.at[k];
    double x = (double)t[first + k][0], v = (double)t[r->velocity + i][0], change = v - (double)t[r->earlier + i][0];
    /* Displacement at the end of the step; there the curve becomes the line through the velocities v and v + change. */
    double end = x + law->timestep * (v + 0.5 * change), slope = own_slope(law, end, v, &change);
    double force = own_force(law, end, v);
    V *node = t + r->law + 3 * nodes * i;
    t[r->hold + i] = all((REAL)(0.5 * own_force(law, x, v)));
    t[r->inverse + 2 * i] = (V){0}; /* its nodes move */
    for (int64_t n = 0; n < nodes; n++) node[3 * n + 1] = all((REAL)(0.5 * (force + slope * ((double)node[3 * n][0] - v))));
  }
}

/* Friction limits of a damper of each car at its velocity; those of eight Stribeck laws are computed at once. */
static V limits_at(V velocity, const DamperLaw *law, int64_t lanes) {
  double speed[LANES], value[LANES];
  V limit = {0};
  int stribeck = lanes == LANES;
  for (int64_t i = 0; i < lanes; i++) speed[i] = (double)velocity[i], stribeck &= law[i].friction_law == LAW_stribeck;
  if (stribeck)
    for (int i = 0; i < LANES; i++) value[i] = stribeck_limit(law + i, speed[i]);
  else
    for (int64_t i = 0; i < lanes; i++) value[i] = friction_limit(law + i, speed[i]);
  for (int64_t i = 0; i < lanes; i++) limit[i] = (REAL)value[i];
  return limit;
}

/* Friction limits by the velocity in the middle of the step, extrapolated from both ends of the last step, and their
 * growth with the side force, extrapolated likewise. */
static void friction_limits(const March *job) {
  const Sections *r = &job->rows;
  V *t = table_of(job), half = all((REAL)0.5);
  int64_t varying = job->laws.n[0], lanes = job->laws.n[1], first = job->tyres + 2 * job->controlled.n[0];
  for (int64_t i = 0; i < job->dampers; i++) {
    /* Velocity in the middle: v + (v - v_earlier)/2. */
    V now = t[r->velocity + i], *limit = t + r->limit + i;
    if (varying) *limit = limits_at(now + half * (now - t[r->earlier + i]), job->laws.at + i * lanes, lanes);
    t[r->earlier + i] = now;
  }
  for (int64_t k = 0; k < job->sides.n[0]; k++) {
    V middle[2], *limit = t + r->limit + job->sides.at[k];
    for (int i = 0; i < 2; i++) {
      V *past = t + r->past + first + 2 * k + i, force = t[r->sensors + first + 2 * k + i];
      middle[i] = t[r->rest + 2 * k + i] + force + half * (force - *past);
      *past = force;
    }
    for (int64_t lane = 0; lane < lanes; lane++) {
      double x = (double)middle[0][lane], y = (double)middle[1][lane];
      double growth = job->laws.at[job->sides.at[k] * lanes + lane].side_force;
      (*limit)[lane] = (REAL)((double)(*limit)[lane] + growth * root(x * x + y * y));
    }
  }
  /* One car: its four columns are equal. */
  if (varying && lanes == 1)
    for (int64_t i = 0; i < job->dampers; i++) t[r->limit + i] = all(t[r->limit + i][0]);
}

/* Inputs of the next step: forces stay, z' and mean z' of the plates, slope forces, z of the plates of slow poles. */
static void set_inputs(const March *job, const REAL *rate) {
  int64_t m = job->plates;
  V *row = table_of(job) + job->rows.inputs + force_count(job);
  for (int64_t k = 0; k < 2 * m; k++) row[k] = all(rate[k]);
  slope_forces(job, rate, row + 2 * m);
  for (int64_t k = 0; k < job->plate_inputs; k++) row[2 * m + job->tyres + k] = all(rate[2 * m + k]);
  control(job);
  own_laws(job);
  friction_limits(job);
}

/* Begin the sums of a step with the contributions of the plates at its end. */
static void begin_sums(const March *job, const REAL *end) {
  const Sections *r = &job->rows;
  int64_t m = job->plates, d = job->dampers, solved = solved_count(job);
  V *t = table_of(job);
  for (int64_t i = 0; i < job->sums; i++) {
    V sum = {0};
    if (i < solved)
      for (int64_t k = 0; k < m; k++) sum += t[r->slip + i * m + k] * all(end[k]);
    if (i >= d && i < solved)
      for (int64_t k = 0; k < m; k++) sum += t[r->level + (i - d) * m + k] * all(end[2 * m + k]);
    t[r->work + i] = sum;
  }
}

/* Add the terms of forces, plates and laws over displacement at the end of a step to the sums of the sensors. */
static void read_sensors(const March *job, const REAL *end) {
  const Sections *r = &job->rows;
  int64_t m = job->plates, forces = force_count(job);
  V *t = table_of(job);
  const V *row = t + r->direct, *heard = t + r->heard;
  for (int64_t i = 0; i < job->sums - solved_count(job); i++, row += forces + 2 * m, heard += r->curves) {
    V value = t[r->sensors + i];
    for (int64_t k = 0; k < forces; k++) value += row[k] * t[r->inputs + k];
    for (int64_t k = 0; k < m; k++) {
      value += row[forces + k] * all(end[k]);
      value += row[forces + m + k] * all(end[2 * m + k]);
    }
    for (int64_t k = 0; k < r->curves; k++) value += heard[k] * t[r->excess + k];
    t[r->sensors + i] = value;
  }
}

/* Advance poles and forces by a step. rate: z' at its beginning, mean z', z, V tan(beta) - z'; then the next step's. */
static void advance(March *job, const REAL *rate, const V *x, V *to, const V *last, V *now) {
  const Sections *r = &job->rows;
  int64_t solved = solved_count(job);
  const REAL *end = rate + 4 * job->plates;
  V *t = table_of(job);
  set_inputs(job, rate);
  begin_sums(job, end);
  NAME(advance_poles)(job, x, to, last, now);
  /* Sums over the poles are added over the four parts of a car. */
  for (int64_t i = 0; i < solved; i++) t[r->work + i] = of_cars(t[r->work + i]);
  for (int64_t i = solved; i < job->sums; i++) t[r->sensors + i - solved] = of_cars(t[r->work + i]);
  NAME(solve_forces)(job);
  read_sensors(job, end);
  job->step++;
}

/* Set the outputs of the dampers at a sample, without the means of both adjacent steps. The solution of a step belongs
 * to a mean force, so the velocity of a stuck damper is that of the middle of the step; it is extrapolated to the end. */
static void begin_damper_outputs(const March *job, V *y) {
  const Sections *r = &job->rows;
  int64_t d = job->dampers;
  const V *t = table_of(job), zero = {0};
  for (int64_t i = 0; i < d; i++) {
    V speed = t[r->velocity + i], share = all((REAL)0.5) * t[r->stick + i] * pick(zero < t[r->limit + i], all(1), zero);
    y[i] = speed + share * (speed - t[r->earlier + i]);
    y[d + i] = t[r->viscous + i] * speed;
    y[2 * d + i] = zero;
  }
  for (int64_t k = 0; k < job->controlled.n[0]; k++) y[3 * d + k] = zero;
}

/* Add the half of the outputs of a sample that belongs to the step after it (side -1) or before it (1): the force of a
 * step belongs to its middle, so the force at a sample is the mean of both adjacent steps. A controlled damper has the
 * force (c - cmin) v at the sample in the place of the mean over the step. */
static void add_damper_outputs(const March *job, V *y, double side) {
  const Sections *r = &job->rows;
  int64_t d = job->dampers;
  const V *t = table_of(job), half = all((REAL)0.5);
  for (int64_t i = 0; i < d; i++) {
    V force = half * t[r->inputs + i];
    y[d + i] -= force, y[2 * d + i] += force;
  }
  for (int64_t group = 0; group < r->groups; group++) {
    int64_t i = job->owners.at[group];
    V force = half * t[r->inputs + 2 * d + group];
    y[d + i] -= force, y[2 * d + i] += force;
  }
  for (int64_t k = 0; k < job->controlled.n[0]; k++) {
    int64_t i = job->controlled.at[k];
    double present = job->memory.at[k * job->memory.n[1] + PRESENT], excess = present - job->settings.at[k].softest;
    /* Half of e v at the sample in place of half of e (v + v_earlier)/2: the difference is +-e (v - v_earlier)/4. */
    y[d + i] += all((REAL)(0.25 * side * excess)) * (t[r->velocity + i] - t[r->earlier + i]);
    y[3 * d + k] += all((REAL)(0.5 * present));
  }
}

/* Keep the states of a sample: forces, z' of the plates, and the forces of the laws with the outputs. */
static void keep_sample(const March *job, const REAL *end, V *x, V *y, SampleRows s) {
  const V *t = table_of(job);
  int64_t forces = force_count(job);
  V *state = x + job->rows.states;
  for (int64_t i = 0; i < forces; i++) state[i] = t[job->rows.inputs + i];
  for (int64_t k = 0; k < job->plates; k++) state[forces + k] = all(end[k]);
  for (int64_t i = 0; i < job->rows.curves; i++) y[s.curves + i] = t[job->rows.excess + i];
  begin_damper_outputs(job, y + s.speeds);
  add_damper_outputs(job, y + s.speeds, 1.0);
}

/* Advance the cars over the samples of `plate_z`, and write their channels except for the last AHEAD samples. */
EXPORT void NAME(march)(March *job) {
  const SampleRows s = sample_rows(job);
  int64_t states = state_count(job), poles = job->changes.n[0] ? job->rows.states : 0, samples = job->plate_z.n[0];
  V *x = job->x.at, *changes = job->changes.at, *y = job->y.at;
  const REAL *rate = job->rates.at;
  for (int64_t done = 0; done < samples; done += INNER) {
    int64_t size = INNER < samples - done ? INNER : samples - done;
    for (int64_t k = 0; k < size * job->every; k++, rate += 4 * job->plates) {
      int64_t sample = k / job->every, phase = k % job->every;
      V *to = x + (sample + 1) * states, *now = changes + (sample + 1) * poles, *row = y + (PAST + sample) * s.width;
      /* The first step of a sample starts from the sample before; the others advance the new sample in place. */
      advance(job, rate, phase ? to : to - states, to, phase ? now : changes, now);
      if (phase == 0) add_damper_outputs(job, row - s.width + s.speeds, -1.0);
      if (phase == job->every - 1) keep_sample(job, rate + 4 * job->plates, to, row, s);
    }
    NAME(write_outputs)(job, done, size);
    /* The last sample, and the past outputs that second differences need, start the next inner block. */
    for (int64_t k = 0; k < states; k++) x[k] = x[size * states + k];
    for (int64_t k = 0; k < PAST * s.width; k++) y[k] = y[size * s.width + k];
  }
}
