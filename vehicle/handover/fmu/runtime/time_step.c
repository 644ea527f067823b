/* Time step of a car: its poles, then its damper forces. See vehicle/engines/reduced/time_step.py for the method.
 *
 * Sums over the poles are taken in LANES parts and then added in a fixed order, so that compilers can use vectors and
 * all platforms give equal bits; the build forbids fused products for the same reason. */
#include <math.h>
#include <string.h>

#include "car.h"

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* Sum of products of two rows whose length is a multiple of LANES. */
static double product(const double *restrict row, const double *restrict x, int64_t count) {
  double part[LANES] = {0.0, 0.0, 0.0, 0.0};
  for (int64_t k = 0; k < count; k += LANES)
    for (int lane = 0; lane < LANES; lane++) part[lane] += row[k + lane] * x[k + lane];
  return (part[0] + part[2]) + (part[1] + part[3]);
}

/* Half of the curve of a damper at a velocity, without D v: interpolated between its nodes. */
static double half_curve_at(const State *s, int64_t i, double velocity) {
  const double *law = s->car->law + i * s->car->n.nodes * 3, *half = s->half_curve + i * s->car->n.nodes;
  int64_t j = 0;
  while (j < s->car->n.nodes - 2 && velocity > law[3 * (j + 1)]) j++;
  double length = law[3 * (j + 1)] - law[3 * j];
  return half[j] + (length > 0.0 ? (half[j + 1] - half[j]) * (velocity - law[3 * j]) / length : 0.0);
}

/* Set the curve of a damper: scale F_c + coefficient v, less the part D v of the poles. */
static void set_curve(State *s, int64_t i, double coefficient) {
  const Car *car = s->car;
  const double *law = car->law + i * car->n.nodes * 3;
  double scale = s->parameter[i * PARAMETERS + PARAMETER_CURVE_SCALE];
  double viscous = car->damper[i * DAMPER_NUMBERS + DAMPER_VISCOUS];
  double half = 0.5 * ((scale - 1.0) * viscous + coefficient);
  for (int64_t j = 0; j < car->n.nodes; j++)
    s->half_curve[i * car->n.nodes + j] = scale * law[3 * j + 1] + half * law[3 * j];
  s->coefficient[i] = coefficient;
  s->hold[i] = half_curve_at(s, i, s->velocity[i]);
}

void set_curves(State *s) {
  for (int64_t i = 0; i < s->car->n.dampers; i++) set_curve(s, i, s->coefficient[i]);
}

static double friction_limit(const State *s, int64_t i, double velocity) {
  const double *p = s->parameter + i * PARAMETERS;
  double limit = p[PARAMETER_FRICTION];
  if ((int)s->car->damper[i * DAMPER_NUMBERS + DAMPER_FRICTION_LAW] == STRIBECK) {
    double ratio = smaller(fabs(velocity / p[PARAMETER_STRIBECK_VELOCITY]), 1e15);
    limit += (p[PARAMETER_STATIC_FRICTION] - limit) * exp(-pow(ratio, p[PARAMETER_STRIBECK_EXPONENT]));
  }
  return limit;
}

/* Coefficient that the law of a controlled damper demands; see vehicle/model/laws/control_laws.py. */
enum { SOFTEST, FIRMEST, SKY, GROUND, ON_OFF, PERIOD, LAG, CHANGE };
enum { HELD, REACHED, PRESENT, RING };

static double demanded(const double *law, double body, double wheel) {
  double relative = body - wheel, speed = fabs(relative);
  double way = relative > 0.0 ? 1.0 : relative < 0.0 ? -1.0 : 0.0;
  if (law[ON_OFF] > 0.0) {
    double share = law[SKY] * (body * way > 0.0) + law[GROUND] * (wheel * way < 0.0);
    return law[SOFTEST] + (law[FIRMEST] - law[SOFTEST]) * share;
  }
  double force = law[SKY] * larger(body * way, 0.0) + law[GROUND] * larger(-wheel * way, 0.0);
  double near = smaller(larger(force, law[SOFTEST] * speed), law[FIRMEST] * speed);
  return smaller(larger(near / (speed + (speed == 0.0)), law[SOFTEST]), law[FIRMEST]);
}

/* Advance a control law by a step; return its mean coefficient over the step. */
static double act(const double *law, int64_t step, double body, double wheel, double *memory) {
  int64_t length = (int64_t)law[LAG] + 1;
  if (step % (int64_t)law[PERIOD] == 0) memory[HELD] = demanded(law, body, wheel);
  memory[RING + step % length] = memory[HELD];
  double wanted = memory[RING + (step + 1) % length], before = memory[REACHED];
  memory[REACHED] = smaller(larger(wanted, before - law[CHANGE]), before + law[CHANGE]);
  double moved = memory[REACHED] - before;
  memory[PRESENT] = memory[REACHED] - 0.5 * moved * fabs(moved) / law[CHANGE];
  return memory[PRESENT];
}

/* Inputs of the next step, its friction limits and curves. */
static void set_inputs(State *s, const double *end, double *u) {
  const Car *car = s->car;
  const Sizes *n = &car->n;
  int64_t d = n->dampers, m = n->plates;
  for (int64_t i = 0; i < d; i++) {
    u[i] = s->force[i] - s->pushed[i];
    u[d + i] = s->slope[i];
    s->pushed[i] = s->command[2 * i];
  }
  double *rate = u + 2 * d + n->groups, *mean = rate + m, *rest = mean + m;
  for (int64_t k = 0; k < n->groups; k++) u[2 * d + k] = s->group_force[k];
  for (int64_t k = 0; k < m; k++) {
    rate[k] = s->before[2 * k + 1];
    mean[k] = (end[2 * k] - s->before[2 * k]) / car->step;
  }
  for (int64_t k = 0; k < n->tyres; k++) {
    double middle = s->sensor[k] + 0.5 * (s->sensor[k] - s->past[k]);
    s->past[k] = s->sensor[k];
    rest[k] = larger(middle, -1.0) * (mean[k] + s->slope_excess[k]) + s->slope_excess[k];
  }
  for (int64_t k = 0; k < n->heights; k++) rest[n->tyres + k] = s->before[2 * k];
  for (int64_t i = 0; i < d; i++) {
    double coefficient = s->command[2 * i + 1];
    int64_t k = (int64_t)car->damper[i * DAMPER_NUMBERS + DAMPER_CONTROL];
    if (k >= 0) {
      const double *law = car->control + k * CONTROL_NUMBERS, *sensor = s->sensor + n->tyres + 2 * k;
      double *memory = s->memory + k * (CONTROL_MEMORY + n->ring);
      double own = act(law, (int64_t)s->steps[0], sensor[1], sensor[0], memory);
      if (s->parameter[i * PARAMETERS + PARAMETER_CONTROL] > 0.5) coefficient += own - law[SOFTEST];
    }
    if (coefficient != s->coefficient[i]) set_curve(s, i, coefficient);
    /* The velocity in the middle of the step is extrapolated from both ends of the last step. */
    double now = s->velocity[i];
    s->friction_limit[i] = n->varying ? friction_limit(s, i, now + 0.5 * (now - s->earlier[i]))
                                      : s->parameter[i * PARAMETERS + PARAMETER_FRICTION];
    s->earlier[i] = now;
  }
}

/* Corners of the equation u + G f(u) = r of a group of Jenkins elements: smallest and largest mean force, then left side
 * and mean force at each corner, see `prepare_groups` of the reduced engine. */
static void prepare_group(const State *s, int64_t group, double *at) {
  const Car *car = s->car;
  int64_t count = car->n.elements, first = count * group, i = car->n.dampers + group;
  const double *spring = car->spring + first, *share = car->share + first, *element = s->element + first;
  double limit = s->friction_limit[(int64_t)car->owner[group]], gain = car->gain[i * (car->solved + 1)];
  at[0] = at[1] = 0.0;
  for (int64_t k = 0; k < count; k++) {
    at[0] += 0.5 * (element[k] - limit * share[k]);
    at[1] += 0.5 * (element[k] + limit * share[k]);
  }
  for (int64_t corner = 0; corner < 2 * count; corner++) {
    int64_t k = corner / 2;
    double end = corner % 2 ? limit * share[k] : -limit * share[k], force = 0.0;
    double stroke = spring[k] > 0.0 ? (end - element[k]) / spring[k] : 0.0;
    for (int64_t j = 0; j < count; j++) {
      double bound = limit * share[j];
      force += 0.5 * (element[j] + smaller(larger(element[j] + spring[j] * stroke, -bound), bound));
    }
    at[2 + 2 * corner] = stroke + gain * force;
    at[3 + 2 * corner] = force;
  }
}

/* Mean force of a group from the left side of its equation. */
static double group_force(const double *at, int64_t corners, double value) {
  double below = -1e30, above = 1e30, lower = at[0], upper = at[1];
  for (int64_t k = 0; k < corners; k++) {
    double left = at[2 + 2 * k], force = at[3 + 2 * k];
    if (value < left) {
      above = smaller(above, left);
      upper = smaller(upper, force);
    } else {
      below = larger(below, left);
      lower = larger(lower, force);
    }
  }
  return lower + (upper - lower) * ((value - below) / (above - below));
}

/* Advance the Jenkins elements over a step; `moved`: changes of their strokes. */
static void advance_groups(State *s, const double *moved) {
  const Car *car = s->car;
  for (int64_t group = 0; group < car->n.groups; group++) {
    int64_t damper = (int64_t)car->owner[group];
    s->place[group] += moved[group];
    for (int64_t k = car->n.elements * group; k < car->n.elements * (group + 1); k++) {
      double end = s->friction_limit[damper] * car->share[k];
      s->element[k] = smaller(larger(s->element[k] + car->spring[k] * moved[group], -end), end);
      s->end_force[damper] -= s->element[k];
    }
  }
}

/* Velocities of the dampers, and forces of dampers and groups: Gauss-Seidel iterations, each force by its inverse law.
 * `arriving`: velocities and strokes without the forces of this step. */
static void solve_forces(State *s, double *arriving, double *work) {
  const Car *car = s->car;
  int64_t d = car->n.dampers, g = car->n.groups, all = car->solved, nodes = car->n.nodes, pieces = nodes - 1;
  int64_t corners = 2 + 4 * car->n.elements;
  double *kept = work, *diagonal = kept + d, *hold = diagonal + d, *table = hold + d, *group = table + 4 * nodes * d;
  for (int64_t k = 0; k < g; k++) {
    prepare_group(s, k, group + corners * k);
    arriving[d + k] -= s->place[k];
  }
  for (int64_t i = 0; i < all; i++) {
    if (i < d) {
      double own = car->gain[i * all + i] + s->stick[i] * car->ramp[i * d + i];
      const double *law = car->law + i * nodes * 3, *half = s->half_curve + i * nodes;
      double *at = table + 4 * nodes * i;
      kept[i] = s->force[i];
      diagonal[i] = own;
      arriving[i] -= own * s->hold[i];
      for (int64_t j = 0; j < nodes; j++) {
        double force = half[j] + law[3 * j + 2] * s->friction_limit[i];
        at[4 * j] = law[3 * j] + own * force;
        at[4 * j + 2] = force;
      }
      for (int64_t j = 0; j < pieces; j++) {
        double length = at[4 * j + 4] - at[4 * j];
        at[4 * j + 1] = length > 0.0 ? 1.0 / length : 0.0;
        at[4 * j + 3] = at[4 * j + 6] - at[4 * j + 2];
      }
    }
    for (int64_t j = 0; j < d; j++) {
      arriving[i] -= s->stick[j] * car->ramp[i * d + j] * s->force[j];
      arriving[i] -= car->gain[i * all + j] * s->pushed[j];
    }
  }
  for (int64_t iteration = 0; iteration < car->n.iterations; iteration++) {
    for (int64_t i = 0; i < all; i++) {
      double value = arriving[i];
      for (int64_t j = 0; j < d; j++)
        if (j != i) value += (car->gain[i * all + j] + s->stick[j] * car->ramp[i * d + j]) * s->force[j];
      for (int64_t j = d; j < all; j++)
        if (j != i) value += car->gain[i * all + j] * s->group_force[j - d];
      if (i >= d) {
        double force = group_force(group + corners * (i - d), corners / 2 - 1, value);
        s->group_force[i - d] = -force;
        if (iteration == car->n.iterations - 1) arriving[i] = value - car->gain[i * all + i] * force;
        continue;
      }
      const double *half = s->half_curve + i * nodes, *at = table + 4 * nodes * i;
      double force = at[2];
      hold[i] = half[0];
      for (int64_t j = 0; j < pieces; j++) {
        double share = smaller(larger((value - at[4 * j]) * at[4 * j + 1], 0.0), 1.0);
        force += at[4 * j + 3] * share;
        hold[i] += (half[j + 1] - half[j]) * share;
      }
      s->velocity[i] = value - diagonal[i] * force;
      s->force[i] = -force - s->hold[i];
    }
  }
  for (int64_t i = 0; i < d; i++) {
    double change = s->force[i] - kept[i];
    /* At the end of the step: extrapolated if stuck, otherwise with the curve at the final velocity. */
    s->end_force[i] = s->stick[i] > 0.0 ? s->force[i] + 0.5 * change : s->force[i] + s->hold[i] - hold[i];
    s->slope[i] = s->stick[i] * change;
    s->hold[i] = hold[i];
    double stuck = fabs(s->velocity[i]) < car->damper[i * DAMPER_NUMBERS + DAMPER_FULL];
    s->stick[i] = stuck * s->stuck[i];
    s->stuck[i] = stuck;
  }
  advance_groups(s, arriving + d);
}

/* Sum of the direct terms of forces and plates at the end of the last step. */
static double direct_sum(const State *s, const double *row, const double *plates) {
  const Sizes *n = &s->car->n;
  const double *group = row + 2 * n->dampers, *rate = group + n->groups, *height = rate + n->plates;
  double value = 0.0;
  for (int64_t i = 0; i < n->dampers; i++)
    value += row[i] * (s->force[i] - s->pushed[i]) + row[n->dampers + i] * s->slope[i];
  for (int64_t k = 0; k < n->groups; k++) value += group[k] * s->group_force[k];
  for (int64_t k = 0; k < n->plates; k++) value += rate[k] * plates[2 * k + 1] + height[k] * plates[2 * k];
  return value;
}

/* Changes of the states over a step, without the forces in it. */
static void pole_changes(const Car *car, const double *restrict u, const double *restrict poles,
                         double *restrict change) {
  int64_t p = car->n.pairs, q = car->n.reals;
  const double *decay = car->pair_change, *rotation = decay + p;
  for (int64_t k = 0; k < p; k++) {
    change[k] = decay[k] * poles[k] - rotation[k] * poles[p + k];
    change[p + k] = decay[k] * poles[p + k] + rotation[k] * poles[k];
  }
  for (int64_t k = 0; k < q; k++) change[2 * p + k] = car->real_change[k] * poles[2 * p + k];
  for (int64_t i = 0; i < car->inputs; i++) {
    const double *pair = car->pair_inputs + 2 * i * p, *real = car->real_inputs + i * q;
    double input = u[i];
    if (input == 0.0) continue;
    for (int64_t k = 0; k < 2 * p; k++) change[k] += pair[k] * input;
    for (int64_t k = 0; k < q; k++) change[2 * p + k] += real[k] * input;
  }
}

/* Advance the car by h to z, z' of the plates at the end of the step. */
void time_step(State *s, const double *end) {
  const Car *car = s->car;
  const Sizes *n = &car->n;
  int64_t d = n->dampers, m = n->plates, p = n->pairs, q = n->reals;
  double *u = s->work, *sums = u + car->inputs, *change = sums + car->sums, *solver = change + car->states;
  set_inputs(s, end, u);
  pole_changes(car, u, s->poles, change);
  for (int64_t k = 0; k < car->states; k++) s->poles[k] += change[k];
  for (int64_t i = 0; i < car->sums; i++)
    sums[i] = product(car->pair_sums + 2 * i * p, s->poles, 2 * p) + product(car->real_sums + i * q, s->poles + 2 * p, q);
  for (int64_t i = 0; i < car->solved; i++)
    for (int64_t k = 0; k < m; k++) sums[i] += car->slip[i * m + k] * end[2 * k + 1];
  for (int64_t i = 0; i < n->groups; i++)
    for (int64_t k = 0; k < m; k++) sums[d + i] += car->level[i * m + k] * end[2 * k];
  solve_forces(s, sums, solver);
  for (int64_t i = 0; i < car->sensors; i++)
    s->sensor[i] = sums[car->solved + i] + direct_sum(s, car->direct + i * car->direct_terms, end);
  memcpy(s->before, end, (size_t)(2 * m) * sizeof(double));
  s->steps[0] += 1.0;
}

/* Set the car at rest in equilibrium over plates at any height, which may begin to move: the inputs `plate`. */
void set_at_rest(State *s) {
  const Car *car = s->car;
  const Sizes *n = &car->n;
  int64_t m = n->plates;
  memcpy(s->before, s->plate, (size_t)(2 * m) * sizeof(double));
  for (int64_t k = 0; k < car->states; k++) {
    s->poles[k] = 0.0;
    for (int64_t i = 0; i < m; i++) {
      s->poles[k] += car->start[i * car->states + k] * s->before[2 * i + 1];
      s->poles[k] += car->start[(m + i) * car->states + k] * s->before[2 * i];
    }
  }
  for (int64_t i = 0; i < car->sensors; i++) {
    s->sensor[i] = s->past[i] = 0.0;
    for (int64_t k = 0; k < m; k++) {
      s->sensor[i] += car->sensor_start[i * 2 * m + k] * s->before[2 * k + 1];
      s->sensor[i] += car->sensor_start[i * 2 * m + m + k] * s->before[2 * k];
    }
  }
  for (int64_t i = 0; i < n->dampers; i++) {
    s->force[i] = s->slope[i] = s->end_force[i] = s->pushed[i] = 0.0;
    s->velocity[i] = s->earlier[i] = s->coefficient[i] = 0.0;
    s->friction_limit[i] = s->parameter[i * PARAMETERS + PARAMETER_FRICTION];
    s->stuck[i] = s->stick[i] = car->damper[i * DAMPER_NUMBERS + DAMPER_FULL] > 0.0;
  }
  for (int64_t i = 0; i < n->groups; i++) {
    s->group_force[i] = s->place[i] = 0.0;
    for (int64_t k = 0; k < m; k++) s->place[i] += car->level[i * m + k] * s->before[2 * k];
    for (int64_t k = 0; k < n->elements; k++) s->element[i * n->elements + k] = 0.0;
  }
  for (int64_t k = 0; k < n->controls; k++)
    for (int64_t j = 0; j < CONTROL_MEMORY + n->ring; j++)
      s->memory[k * (CONTROL_MEMORY + n->ring) + j] = car->control[k * CONTROL_NUMBERS + SOFTEST];
  s->steps[0] = 0.0;
  set_curves(s);
}

static double linear_value(const State *s, int64_t output) {
  const Car *car = s->car;
  int64_t d = car->n.dampers, m = car->n.plates, states = car->states;
  const double *row = car->rows + output * (states + car->direct_terms);
  double value = product(row, s->poles, states) + direct_sum(s, row + states, s->before);
  for (int64_t i = 0; i < d; i++) value += car->by_force[output * d + i] * (s->end_force[i] - s->pushed[i]);
  for (int64_t k = 0; k < car->n.tyres; k++) {
    double excess = s->slope_excess[k], change = larger(s->sensor[k], -1.0);
    value += car->by_tyre[output * m + k] * (change * (s->before[2 * k + 1] + excess) + excess);
  }
  return value + car->fixed[output];
}

/* The solution of a step belongs to a mean force, so the velocity of a stuck damper is extrapolated to the end. */
static double damper_velocity(const State *s, int64_t i) {
  double share = s->friction_limit[i] > 0.0 ? 0.5 * s->stick[i] : 0.0;
  return s->velocity[i] + share * (s->velocity[i] - s->earlier[i]);
}

/* Value of an output, or of a watched quantity after them, at the end of the last step. */
double output_value(const State *s, int64_t output) {
  const Car *car = s->car;
  if (output >= car->n.outputs) return linear_value(s, output);
  int64_t kind = (int64_t)car->output_kind[2 * output], i = (int64_t)car->output_kind[2 * output + 1];
  const double *damper = car->damper + i * DAMPER_NUMBERS;
  if (kind == OUTPUT_VELOCITY) return damper_velocity(s, i);
  if (kind == OUTPUT_FORCE)
    return damper[DAMPER_VISCOUS] * damper_velocity(s, i) - s->end_force[i] + s->pushed[i] + damper[DAMPER_REST_FORCE];
  if (kind == OUTPUT_COEFFICIENT) {
    double scale = s->parameter[i * PARAMETERS + PARAMETER_CURVE_SCALE];
    return scale * damper[DAMPER_VISCOUS] + s->coefficient[i];
  }
  return linear_value(s, output);
}
