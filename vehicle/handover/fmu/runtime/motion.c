/* Motion of an instance: its memory, the march of the core over a communication step, and outputs at its end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "car.h"

void core_march_d(March *job);
double core_read_row_d(const March *job, const void *row, const double *z);

enum { STEPS_AT_ONCE = 64, PAST = 10, BLOCK = 8 }; /* as in march.h and poles.c */

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* Rows of the table of this instance: all numbers of a row are equal. */
static double *table(const Motion *s) { return s->march.table.at; }
static double row(const Motion *s, int64_t index) { return table(s)[PARTS * index]; }
static void set_row(Motion *s, int64_t index, double value) {
  for (int k = 0; k < PARTS; k++) table(s)[PARTS * index + k] = value;
}
/* Number of a node of a damper law in the car: x, half of the curve without D v, friction over its limit. */
static double node(const double *numbers, const Sections *r, int64_t damper, int64_t k, int part) {
  return numbers[PARTS * (r->law + 3 * ((r->pieces + 1) * damper + k) + part)];
}

static int64_t up(int64_t numbers) { return PARTS * ((numbers + PARTS - 1) / PARTS); }

/* Place the memory behind `first`, whose alignment is ROW, if it is not NULL; return its length in numbers. The block
 * is what changes: the table from the section `law` on, small arrays, and the states of the last sample. */
static int64_t place(Motion *s, double *first) {
  const Embedded *e = &s->car->data;
  March *job = &s->march;
  const Sections *r = &job->rows;
  int64_t d = job->dampers, m = job->plates, k = job->controlled.n[0], states = PARTS * s->car->states;
  int64_t width = 3 * d + k + r->curves, constant = PARTS * r->law;
  struct { double **array; int64_t size; } arrays[] = {
    {&s->time, 1}, {&s->start_time, 1}, {&s->steps, 1}, {&s->mode, 1}, {&s->checked, 1},
    {&s->parameter, d * PARAMETERS}, {&s->plate, 2 * m}, {&s->slope_excess, job->tyres}, {&s->command, 2 * d},
    {&s->before, 2 * m}, {&s->applied, d * APPLIED}, {&s->end_force, d},
    {(double **)&job->pieces.at, d}, {&s->frozen, m}, {&s->warned, e->limits.n[0]},
    {(double **)&job->laws.at, job->laws.n[0] * (int64_t)(sizeof(DamperLaw) / sizeof(double))},
    {&job->memory.at, k * job->memory.n[1]}, {&job->outside.at, 3 * k},
  };
  int64_t length = PARTS * job->table.n[0];
  for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
    if (first) *arrays[i].array = first + length;
    length += arrays[i].size;
  }
  length = up(length);
  int64_t end = length + states;
  if (first) {
    job->table.at = first, job->x.at = first + length, job->y.at = first + end + states + PARTS * BLOCK;
    job->rates.at = (double *)job->y.at + PARTS * (PAST + 1) * width;
    job->plate_z.at = job->rates.at + (STEPS_AT_ONCE + 1) * 4 * m;
    s->block = first + constant, s->size = (size_t)(end - constant);
  }
  return end + states + PARTS * (BLOCK + (PAST + 1) * width) + (STEPS_AT_ONCE + 1) * 4 * m + 2 * m;
}

int make_state(Motion *s, Car *car) {
  s->car = car;
  s->march = car->data.march;
  s->memory = calloc((size_t)place(s, NULL) * sizeof(double) + ROW, 1);
  if (!s->memory) return 0;
  place(s, (double *)((char *)s->memory + (ROW - (uintptr_t)s->memory % ROW) % ROW));
  s->march.every = 1, s->march.plate_z.n[0] = 1;
  memcpy(table(s), car->data.march.table.at, (size_t)(ROW * s->march.table.n[0]));
  reset_state(s);
  return 1;
}

void free_state(Motion *s) { free(s->memory); }

void reset_state(Motion *s) {
  memset(s->block, 0, s->size * sizeof(double));
  memcpy(s->parameter, s->car->data.parameters.at, (size_t)(damper_count(s->car) * PARAMETERS) * sizeof(double));
  set_at_rest(s);
}

/* Half of the curve of a damper at its velocity. */
static double half_curve(const Motion *s, int64_t i) {
  const Sections *r = &s->march.rows;
  double velocity = row(s, r->velocity + i), half = node(table(s), r, i, 0, 1);
  for (int64_t k = 0; k < s->march.pieces.at[i]; k++) {
    double from = node(table(s), r, i, k, 0), length = node(table(s), r, i, k + 1, 0) - from;
    double rise = node(table(s), r, i, k + 1, 1) - node(table(s), r, i, k, 1);
    if (length > 0.0) half += rise * smaller(larger((velocity - from) / length, 0.0), 1.0);
  }
  return half;
}

/* Set the curve of a damper: scale F_c + added v, and a force, of which half acts at either end of a step. */
static void set_curve(Motion *s, int64_t i, double scale, double added, double force) {
  const Sections *r = &s->march.rows;
  const double *numbers = s->car->data.march.table.at;
  const int64_t *inner = s->car->data.inner.at + 2 * i;
  int changed = scale != 1.0 || added != 0.0;
  int64_t first = changed ? 0 : inner[0], last = changed ? s->car->data.march.pieces.at[i] : inner[1];
  s->march.pieces.at[i] = last - first;
  for (int64_t k = first; k <= last; k++) {
    int64_t to = r->law + 3 * ((r->pieces + 1) * i + k - first);
    double x = node(numbers, r, i, k, 0);
    set_row(s, to, x);
    set_row(s, to + 1, scale * node(numbers, r, i, k, 1) + 0.5 * (added * x + force));
    set_row(s, to + 2, node(numbers, r, i, k, 2));
  }
  set_row(s, r->inverse + 2 * i, 0.0);
  set_row(s, r->hold + i, half_curve(s, i));
}

/* 1 if factor and coefficient of a damper are those of the last step. */
static int is_applied(const Motion *s, int64_t i) {
  const double *applied = s->applied + APPLIED * i;
  return applied[APPLIED_SCALE] == s->parameter[i * PARAMETERS + PARAMETER_CURVE_SCALE] &&
         applied[APPLIED_COEFFICIENT] == s->command[2 * i + 1];
}

/* Take parameters and commands of a damper for the next step. Its curve is scale F_c + coefficient v, less the part D v
 * of the poles. */
static void apply(Motion *s, int64_t i, double force) {
  const Sections *r = &s->march.rows;
  const double *own = s->parameter + i * PARAMETERS;
  double scale = own[PARAMETER_CURVE_SCALE], coefficient = s->command[2 * i + 1], *applied = s->applied + APPLIED * i;
  double added = (scale - 1.0) * s->car->data.dampers.at[i].viscous_damping + coefficient;
  int same = is_applied(s, i) && applied[APPLIED_FORCE] == force;
  /* A force that sets in does not do so evenly over a step: no slope in this step. */
  if (force != applied[APPLIED_FORCE]) set_row(s, r->stick + i, 0.0);
  applied[APPLIED_SCALE] = scale, applied[APPLIED_COEFFICIENT] = coefficient, applied[APPLIED_FORCE] = force;
  if (s->march.laws.n[0]) memcpy(&s->march.laws.at[i].friction_limit, own, 4 * sizeof(double));
  else set_row(s, r->limit + i, own[PARAMETER_FRICTION]);
  for (int64_t k = 0; k < s->march.controlled.n[0]; k++)
    if (s->march.controlled.at[k] == i) {
      double *outside = s->march.outside.at + 3 * k;
      outside[0] = own[PARAMETER_CONTROL] > 0.5, outside[1] = added, outside[2] = 0.5 * force;
      return;
    }
  if (!same) set_curve(s, i, scale, added, force);
}

void apply_commands(Motion *s) {
  for (int64_t i = 0; i < s->march.dampers; i++) apply(s, i, s->command[2 * i]);
}

/* A damper whose force falls with the velocity is solved only while v + g F(v) rises: the slope of this sum must stay
 * above SMALLEST_RATE. */
int has_solution(const Motion *s, int64_t i) {
  static const double SMALLEST_RATE = 0.25;
  if (is_applied(s, i)) return 1;
  const Sections *r = &s->march.rows;
  const double *numbers = s->car->data.march.table.at;
  int64_t d = s->march.dampers, solved = d + r->groups + r->curves;
  double scale = s->parameter[i * PARAMETERS + PARAMETER_CURVE_SCALE];
  double half = 0.5 * ((scale - 1.0) * s->car->data.dampers.at[i].viscous_damping + s->command[2 * i + 1]);
  double gain = row(s, r->gain + i * (solved + 1)) + larger(row(s, r->ramp + i * (d + 1)), 0.0);
  for (int64_t k = 1; k <= s->car->data.march.pieces.at[i]; k++) {
    double length = node(numbers, r, i, k, 0) - node(numbers, r, i, k - 1, 0);
    if (!(length > 0.0)) continue;
    double slope = scale * (node(numbers, r, i, k, 1) - node(numbers, r, i, k - 1, 1)) / length + half;
    if (1.0 + gain * slope < SMALLEST_RATE) return 0;
  }
  return 1;
}

/* Nonlinear force of a damper at the end of the last step: extrapolated if it was stuck, otherwise by its law at the
 * final velocity; the Jenkins elements of its friction act with their forces at the end. */
static double force_at_end(const Motion *s, int64_t i) {
  const Sections *r = &s->march.rows;
  double slope = row(s, r->inputs + s->march.dampers + i), force = row(s, r->inputs + i) + 0.5 * slope;
  if (slope == 0.0) {
    double velocity = row(s, r->velocity + i), limit = row(s, r->limit + i);
    force = -2.0 * node(table(s), r, i, 0, 1) - limit * node(table(s), r, i, 0, 2);
    for (int64_t k = 0; k < s->march.pieces.at[i]; k++) {
      double from = node(table(s), r, i, k, 0), length = node(table(s), r, i, k + 1, 0) - from;
      double rise = 2.0 * (node(table(s), r, i, k + 1, 1) - node(table(s), r, i, k, 1));
      rise += limit * (node(table(s), r, i, k + 1, 2) - node(table(s), r, i, k, 2));
      if (length > 0.0) force -= rise * smaller(larger((velocity - from) / length, 0.0), 1.0);
    }
  }
  for (int64_t group = 0; group < r->groups; group++)
    for (int64_t k = 0; k < r->elements && s->march.owners.at[group] == i; k++)
      force -= row(s, r->slider + group * r->elements + k);
  return force;
}

/* Set the car at rest in equilibrium over plates at any height, which may begin to move: the inputs `plate`. */
void set_at_rest(Motion *s) {
  const Embedded *e = &s->car->data;
  March *job = &s->march;
  const Sections *r = &job->rows;
  int64_t m = job->plates, changing = job->table.n[0] - r->law, numbers = PARTS * s->car->states;
  double *x = job->x.at;
  const double *start = e->start.at, *z = s->plate;
  memcpy(table(s) + PARTS * r->law, (double *)e->march.table.at + PARTS * r->law, (size_t)(ROW * changing));
  memcpy((void *)job->laws.at, e->march.laws.at, (size_t)job->laws.n[0] * sizeof(DamperLaw));
  memcpy(job->memory.at, e->march.memory.at, (size_t)(job->memory.n[0] * job->memory.n[1]) * sizeof(double));
  memcpy(job->pieces.at, e->march.pieces.at, (size_t)job->dampers * sizeof(int64_t));
  memcpy(job->outside.at, e->march.outside.at, (size_t)(3 * job->outside.n[0]) * sizeof(double));
  memcpy(s->before, s->plate, (size_t)(2 * m) * sizeof(double));
  for (int64_t k = 0; k < numbers; k++) {
    x[k] = 0.0;
    for (int64_t i = 0; i < m; i++) x[k] += start[i * numbers + k] * z[2 * i + 1];
  }
  for (int64_t i = 0; i < e->sensor_start.n[0]; i++) {
    double value = 0.0;
    for (int64_t k = 0; k < m; k++)
      value += e->sensor_start.at[i * 2 * m + k] * z[2 * k + 1] + e->sensor_start.at[(i * 2 + 1) * m + k] * z[2 * k];
    set_row(s, r->sensors + i, value);
  }
  for (int64_t i = 0; i < r->groups; i++) {
    double value = 0.0;
    for (int64_t k = 0; k < m; k++) value += row(s, r->level + i * m + k) * z[2 * k];
    set_row(s, r->place + i, value);
  }
  for (int64_t i = 0; i < e->law_start.n[0]; i++) {
    const double *by = e->law_start.at + i * 2 * m, *corner = e->law_corners.at + i * 2 * e->law_corners.n[1];
    double position = 0.0, force = 0.0;
    for (int64_t k = 0; k < m; k++) position += by[k] * z[2 * k + 1] + by[m + k] * z[2 * k];
    for (int64_t k = 0; k < e->law_corners.n[1]; k++, corner += 2)
      force += corner[1] * larger(copysign(1.0, corner[0]) * (position - corner[0]), 0.0);
    set_row(s, r->excess + i, force);
  }
  s->steps[0] = 0.0;
  for (int64_t i = 0; i < job->dampers; i++) {
    s->applied[APPLIED * i + APPLIED_SCALE] = -1.0; /* none yet */
    s->applied[APPLIED * i + APPLIED_FORCE] = 0.0;
    apply(s, i, 0.0);
    s->end_force[i] = force_at_end(s, i);
  }
}

/* z and z' of a plate after a part t of a communication step: the cubic through those at both ends. */
static void plate_at(const double *begin, const double *end, double t, double duration, double *now) {
  double r = 1.0 - t, rise = end[0] - begin[0];
  now[0] = begin[0] + t * t * (3.0 - 2.0 * t) * rise + duration * t * r * (r * begin[1] - t * end[1]);
  now[1] = 6.0 * t * r * rise / duration + r * (1.0 - 3.0 * t) * begin[1] + t * (3.0 * t - 2.0) * end[1];
  if (t == 1.0) now[0] = end[0], now[1] = end[1];
}

/* Integral of an applied force and the force after a part t of a communication step: linear between both ends. */
static void force_at(const double *begin, const double *end, double t, double duration, double *now) {
  double rise = end[1] - begin[1];
  now[0] = duration * t * (begin[1] + 0.5 * t * rise);
  now[1] = begin[1] + t * rise;
}

/* Advance by steps, until plates and forces have the inputs. */
void advance(Motion *s, int64_t steps) {
  March *job = &s->march;
  int64_t m = job->plates, driven = plate_count(s->car), first = (int64_t)s->steps[0];
  double step = s->car->data.step, now[2];
  for (int64_t done = 0; done < steps; done += job->every) {
    job->every = steps - done < STEPS_AT_ONCE ? steps - done : STEPS_AT_ONCE, job->step = first + done;
    for (int64_t i = 0; i < m; i++)
      for (int64_t k = 0; k <= job->every; k++) {
        double *rate = job->rates.at + 4 * m * k + i, t = (double)(done + k) / (double)steps;
        (i < driven ? plate_at : force_at)(s->before + 2 * i, s->plate + 2 * i, t, (double)steps * step, now);
        rate[0] = now[1], rate[2 * m] = now[0], rate[3 * m] = i < job->tyres ? s->slope_excess[i] : 0.0;
        if (k) rate[-3 * m] = (now[0] - rate[-2 * m]) / step;
      }
    core_march_d(job);
  }
  memcpy(s->before, s->plate, (size_t)(2 * m) * sizeof(double));
  s->steps[0] += (double)steps;
  for (int64_t i = 0; i < job->dampers; i++) s->end_force[i] = force_at_end(s, i);
}

/* A damper velocity is a sum over all poles: it is not finite if one of them is not. */
int is_finite(const Motion *s) {
  for (int64_t i = 0; i < s->march.dampers; i++)
    if (!isfinite(row(s, s->march.rows.velocity + i))) return 0;
  return 1;
}

static double linear_value(const Motion *s, int64_t output) {
  const Embedded *e = &s->car->data;
  const Sections *r = &s->march.rows;
  int64_t d = s->march.dampers, m = s->march.plates, terms = s->car->states + m;
  double value = core_read_row_d(&s->march, (double *)e->rows.at + PARTS * output * terms, s->before);
  for (int64_t i = 0; i < d; i++) value += e->by_force.at[output * d + i] * s->end_force[i];
  for (int64_t k = 0; k < s->march.tyres; k++) {
    double excess = s->slope_excess[k], change = larger(row(s, r->sensors + k), -1.0);
    value += e->by_slope.at[output * m + k] * (change * (s->before[2 * k + 1] + excess) + excess);
  }
  for (int64_t k = 0; k < r->curves; k++) value += e->by_law.at[output * r->curves + k] * row(s, r->excess + k);
  return value + e->fixed.at[output];
}

/* The solution of a step belongs to a mean force, so the velocity of a stuck damper is extrapolated to the end. */
static double damper_velocity(const Motion *s, int64_t i) {
  const Sections *r = &s->march.rows;
  double speed = row(s, r->velocity + i), share = row(s, r->limit + i) > 0.0 ? 0.5 * row(s, r->stick + i) : 0.0;
  return speed + share * (speed - row(s, r->earlier + i));
}

/* Damping coefficient of a damper in the last step, with that of its control law. */
static double coefficient(const Motion *s, int64_t i) {
  const double *applied = s->applied + APPLIED * i;
  double value = applied[APPLIED_SCALE] * s->car->data.dampers.at[i].viscous_damping + applied[APPLIED_COEFFICIENT];
  for (int64_t k = 0; k < s->march.controlled.n[0]; k++)
    if (s->march.controlled.at[k] == i) {
      enum { PRESENT = 2 }; /* of the memory, see laws.h */
      double present = s->march.memory.at[k * s->march.memory.n[1] + PRESENT];
      value += s->march.outside.at[3 * k] * (present - s->march.settings.at[k].softest);
    }
  return value;
}

/* Value of an output, or of a watched quantity after them, at the end of the last step. */
double output_value(const Motion *s, int64_t output) {
  const Embedded *e = &s->car->data;
  if (output >= output_count(s->car)) return linear_value(s, output);
  int64_t kind = e->kinds.at[2 * output], i = e->kinds.at[2 * output + 1];
  const DamperLaw *law = e->dampers.at + i;
  if (kind == OUTPUT_VELOCITY) return damper_velocity(s, i);
  if (kind == OUTPUT_FORCE) { /* its row is that of its stop, a law over displacement */
    double stop = s->march.rows.curves ? linear_value(s, output) : 0.0;
    return law->viscous_damping * damper_velocity(s, i) - s->end_force[i] + law->rest_force + stop;
  }
  if (kind == OUTPUT_COEFFICIENT) return coefficient(s, i);
  return linear_value(s, output);
}

/* Index of a watched quantity that newly left its limits; -1 after the last of a check. Checked every CHECK_TIME. */
int64_t new_notice(Motion *s) {
  static const double CHECK_TIME = 0.016; /* between two checks [s] */
  const Car *car = s->car;
  if (s->time[0] < s->checked[0]) return -1;
  for (int64_t k = 0; k < watched_count(car); k++) {
    if (s->warned[k] > 0.0) continue;
    double value = output_value(s, output_count(car) + k);
    if (value >= car->data.limits.at[2 * k] && value <= car->data.limits.at[2 * k + 1]) continue;
    s->warned[k] = 1.0;
    return k;
  }
  s->checked[0] = s->time[0] + CHECK_TIME;
  return -1;
}
