/* Instance of a car: its variables by value reference, its communication steps, and all checks of what comes from
 * outside. Messages say what is wrong and how to mend it.
 *
 * Value references, as in variables.py: 0 time; 100 + 2 k and 101 + 2 k displacement and velocity of plate k;
 * 5000 + k its slope velocity beyond the velocity, for rolling tyres; 10000 + 2 i and 10001 + 2 i force and coefficient command of damper i; 20000 + PARAMETERS i + k parameters of damper
 * i; 30000 + o outputs. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "car.h"

enum { FIRST_PLATE = 100, FIRST_SLOPE = 5000, FIRST_COMMAND = 10000, FIRST_PARAMETER = 20000, FIRST_OUTPUT = 30000 };
enum { MOST_STEPS = 100000, FROZEN_STEPS = 50 };

static const double CHECK_TIME = 0.016;                /* between two checks of watched quantities [s] */
static const double TIME_TOLERANCE = 1e-3;             /* round-off of a communication point, share of the internal step */

static const double HIGHEST[2] = {1000.0, 100.0};      /* of plates [m, m/s] */
static const double STRONGEST[2] = {1e6, 1e6};         /* of commands [N, N s/m] */
static const double SMALLEST_RATE = 0.25;              /* of the force at a velocity that a damper takes up, see below */

/* Names, units and limits of the parameters of a damper. */
static const struct { const char *name, *unit; double low, high; } PARAMETER[PARAMETERS] = {
  {"coulomb_friction", "N", 0.0, 1e6},
  {"static_friction", "N", 0.0, 1e6},
  {"stribeck_velocity", "m/s", 1e-6, 10.0},
  {"stribeck_exponent", "", 1e-3, 20.0},
  {"curve_scale", "", 0.0, 10.0},
  {"control", "", 0.0, 1.0},
};

static int refuse(char *message, const char *format, ...) {
  va_list values;
  va_start(values, format);
  vsnprintf(message, MESSAGE, format, values);
  va_end(values);
  return 0;
}

static const char *plate_name(const Car *car, int64_t k) { return car->names + k * NAME; }
static const char *damper_name(const Car *car, int64_t i) { return car->names + (car->n.plates + i) * NAME; }

/* Arrays of a state, in the order of the block. */
static size_t place(State *s, double *block) {
  const Car *car = s->car;
  const Sizes *n = &car->n;
  int64_t d = n->dampers, m = n->plates;
  int64_t work = car->inputs + car->sums + car->states + d * (3 + 4 * n->nodes) + n->groups * (2 + 4 * n->elements) + 4 * m;
  struct { double **array; int64_t size; } arrays[] = {
    {&s->time, 1}, {&s->start_time, 1}, {&s->steps, 1}, {&s->mode, 1}, {&s->checked, 1},
    {&s->parameter, d * PARAMETERS}, {&s->plate, 2 * m}, {&s->slope_excess, n->tyres}, {&s->command, 2 * d}, {&s->before, 2 * m},
    {&s->poles, car->states}, {&s->force, d}, {&s->slope, d}, {&s->end_force, d}, {&s->pushed, d},
    {&s->group_force, n->groups}, {&s->place, n->groups}, {&s->element, n->groups * n->elements},
    {&s->velocity, d}, {&s->earlier, d}, {&s->hold, d}, {&s->stuck, d}, {&s->stick, d},
    {&s->friction_limit, d}, {&s->coefficient, d}, {&s->half_curve, d * n->nodes},
    {&s->sensor, car->sensors}, {&s->past, car->sensors},
    {&s->memory, n->controls * (CONTROL_MEMORY + n->ring)}, {&s->frozen, m}, {&s->warned, n->watched},
    {&s->work, work},
  };
  size_t length = 0;
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) {
    if (block) *arrays[k].array = block + length;
    length += (size_t)arrays[k].size;
  }
  return length;
}

int make_state(State *s, Car *car) {
  s->car = car;
  s->size = place(s, NULL);
  s->block = calloc(s->size, sizeof(double));
  if (!s->block) return 0;
  place(s, s->block);
  reset_state(s);
  return 1;
}

void reset_state(State *s) {
  memset(s->block, 0, s->size * sizeof(double));
  memcpy(s->parameter, s->car->parameter, (size_t)(s->car->n.dampers * PARAMETERS) * sizeof(double));
  set_at_rest(s);
}

/* Kinds of variables; the index within the kind is written to `index`. */
enum { UNKNOWN, TIME, PLATE, SLOPE, COMMAND, DAMPER_PARAMETER, OUTPUT };

static int kind_of(const Car *car, uint32_t reference, int64_t *index) {
  static const uint32_t first[] = {FIRST_OUTPUT, FIRST_PARAMETER, FIRST_COMMAND, FIRST_SLOPE, FIRST_PLATE, 0};
  static const int kinds[] = {OUTPUT, DAMPER_PARAMETER, COMMAND, SLOPE, PLATE, TIME};
  int64_t counts[] = {car->n.outputs, car->n.dampers * PARAMETERS, 2 * car->n.dampers, car->n.tyres,
                      2 * car->n.plates, 1};
  for (int k = 0; k < 6; k++) {
    if (reference < first[k]) continue;
    *index = (int64_t)(reference - first[k]);
    return *index < counts[k] ? kinds[k] : UNKNOWN;
  }
  return UNKNOWN;
}

int get_value(const State *s, uint32_t reference, double *value, char *message) {
  int64_t index = 0;
  switch (kind_of(s->car, reference, &index)) {
    case TIME: *value = s->time[0]; return 1;
    case PLATE: *value = s->plate[index]; return 1;
    case SLOPE: *value = s->slope_excess[index]; return 1;
    case COMMAND: *value = s->command[index]; return 1;
    case DAMPER_PARAMETER: *value = s->parameter[index]; return 1;
    case OUTPUT: *value = output_value(s, index); return 1;
    default: return refuse(message, "no variable has the value reference %u", (unsigned)reference);
  }
}

static int is_within(double value, double low, double high) { return value >= low && value <= high; }

static int set_parameter(State *s, int64_t index, double value, char *message) {
  const Car *car = s->car;
  int64_t i = index / PARAMETERS, k = index % PARAMETERS;
  double *own = s->parameter + i * PARAMETERS;
  int law = (int)car->damper[i * DAMPER_NUMBERS + DAMPER_FRICTION_LAW];
  int controlled = car->damper[i * DAMPER_NUMBERS + DAMPER_CONTROL] >= 0.0;
  if ((k == PARAMETER_STATIC_FRICTION || k == PARAMETER_STRIBECK_VELOCITY || k == PARAMETER_STRIBECK_EXPONENT) &&
      law != STRIBECK)
    return refuse(message, "%s_%s: the friction of this damper is constant; write the FMU of a car with friction_law = "
                  "\"stribeck\"", damper_name(car, i), PARAMETER[k].name);
  if (k == PARAMETER_CONTROL && !controlled)
    return refuse(message, "%s_control: this damper has no control law", damper_name(car, i));
  if (!is_within(value, PARAMETER[k].low, PARAMETER[k].high))
    return refuse(message, "%s_%s: found %g, must be %g to %g %s", damper_name(car, i), PARAMETER[k].name, value,
                  PARAMETER[k].low, PARAMETER[k].high, PARAMETER[k].unit);
  own[k] = value;
  if (k == PARAMETER_CURVE_SCALE) set_curves(s);
  return 1;
}

int set_value(State *s, uint32_t reference, double value, char *message) {
  const Car *car = s->car;
  static const char *const plates[] = {"displacement", "velocity"}, *const commands[] = {"force", "coefficient"};
  static const char *const plate_units[] = {"m", "m/s"}, *const command_units[] = {"N", "N s/m"};
  int64_t index = 0;
  int kind = kind_of(car, reference, &index), part = (int)(index % 2);
  switch (kind) {
    case PLATE:
      if (!is_within(value, -HIGHEST[part], HIGHEST[part]))
        return refuse(message, "plate_%s_%s: found %g, must be %g to %g %s", plate_name(car, index / 2), plates[part],
                      value, -HIGHEST[part], HIGHEST[part], plate_units[part]);
      s->plate[index] = value;
      return 1;
    case SLOPE:
      if (!is_within(value, -HIGHEST[1], HIGHEST[1]))
        return refuse(message, "plate_%s_slope_excess: found %g, must be %g to %g m/s", plate_name(car, index), value,
                      -HIGHEST[1], HIGHEST[1]);
      s->slope_excess[index] = value;
      return 1;
    case COMMAND:
      if (!is_within(value, -STRONGEST[part], STRONGEST[part]))
        return refuse(message, "%s_%s_command: found %g, must be %g to %g %s", damper_name(car, index / 2),
                      commands[part], value, -STRONGEST[part], STRONGEST[part], command_units[part]);
      s->command[index] = value;
      return 1;
    case DAMPER_PARAMETER: return set_parameter(s, index, value, message);
    case OUTPUT: case TIME: return refuse(message, "value reference %u: outputs and the time cannot be set",
                                          (unsigned)reference);
    default: return refuse(message, "no variable has the value reference %u", (unsigned)reference);
  }
}

/* A damper whose force falls with the velocity is solved only while v + g F(v) rises: the slope of this sum must stay
 * above SMALLEST_RATE. */
static int has_solution(const State *s, int64_t i, double coefficient) {
  const Car *car = s->car;
  const double *law = car->law + i * car->n.nodes * 3;
  double scale = s->parameter[i * PARAMETERS + PARAMETER_CURVE_SCALE];
  double half = 0.5 * ((scale - 1.0) * car->damper[i * DAMPER_NUMBERS + DAMPER_VISCOUS] + coefficient);
  double ramp = car->ramp[i * car->n.dampers + i];
  double gain = car->gain[i * (car->solved + 1)] + (ramp > 0.0 ? ramp : 0.0);
  for (int64_t j = 1; j < car->n.nodes; j++) {
    double length = law[3 * j] - law[3 * (j - 1)];
    if (!(length > 0.0)) continue;
    double slope = scale * (law[3 * j + 1] - law[3 * (j - 1) + 1]) / length + half;
    if (1.0 + gain * slope < SMALLEST_RATE) return 0;
  }
  return 1;
}

static int check_dampers(const State *s, char *message) {
  const Car *car = s->car;
  for (int64_t i = 0; i < car->n.dampers; i++) {
    const double *own = s->parameter + i * PARAMETERS;
    if ((int)car->damper[i * DAMPER_NUMBERS + DAMPER_FRICTION_LAW] == STRIBECK &&
        own[PARAMETER_STATIC_FRICTION] < own[PARAMETER_FRICTION])
      return refuse(message, "%s_static_friction: found %g N, must be at least %s_coulomb_friction = %g N",
                    damper_name(car, i), own[PARAMETER_STATIC_FRICTION], damper_name(car, i), own[PARAMETER_FRICTION]);
    if (!has_solution(s, i, s->command[2 * i + 1]))
      return refuse(message, "%s_coefficient_command: %g N s/m with curve_scale %g makes the damper drive the car faster "
                    "than a step resolves; set a larger value", damper_name(car, i), s->command[2 * i + 1],
                    own[PARAMETER_CURVE_SCALE]);
  }
  return 1;
}

/* A master that connects displacements only leaves the velocities at 0, which gives wrong forces without a sign of it. */
static int check_plates(State *s, char *message) {
  for (int64_t k = 0; k < s->car->n.plates; k++) {
    const double *now = s->plate + 2 * k, *before = s->before + 2 * k;
    int frozen = now[0] != before[0] && now[1] == 0.0 && before[1] == 0.0;
    s->frozen[k] = frozen ? s->frozen[k] + 1.0 : 0.0;
    if ((int)s->frozen[k] >= FROZEN_STEPS)
      return refuse(message, "plate_%s_velocity has been 0 for %d steps while plate_%s_displacement moved; connect the "
                    "velocity of the plate too", plate_name(s->car, k), FROZEN_STEPS, plate_name(s->car, k));
  }
  return 1;
}

static int is_finite(const State *s) {
  const Car *car = s->car;
  for (int64_t k = 0; k < car->states; k++)
    if (!isfinite(s->poles[k])) return 0;
  for (int64_t i = 0; i < car->n.dampers; i++)
    if (!isfinite(s->velocity[i]) || !isfinite(s->force[i])) return 0;
  return 1;
}

/* Advance by a communication step. The inputs belong to its end; within it the plates follow the cubic through
 * displacement and velocity at both ends. The car does not move if it is refused. */
int communication_step(State *s, double point, double length, char *message) {
  const Car *car = s->car;
  int64_t m = car->n.plates;
  double count = floor(length / car->step + 0.5);
  if (!(length > 0.0))
    return refuse(message, "communication step of %g s: must be above 0", length);
  if (!(fabs(point - s->time[0]) <= TIME_TOLERANCE * car->step + 1e-9 * fabs(point)))
    return refuse(message, "communication point %.9g s: the car is at %.9g s; set back its state, or go on from there",
                  point, s->time[0]);
  /* A master that adds up its time has a remainder of round-off before its stop time; the car has arrived there. */
  if (length <= TIME_TOLERANCE * car->step) return 1;
  if (!(count >= 1.0 && count <= (double)MOST_STEPS) || fabs(length - count * car->step) > 1e-6 * car->step * count)
    return refuse(message, "communication step of %.9g s: must be a multiple of the internal step of %.9g s, up to %d "
                  "times; write the FMU with another --step", length, car->step, MOST_STEPS);
  if (!check_dampers(s, message) || !check_plates(s, message)) return 0;
  int64_t steps = (int64_t)count;
  /* The last rooms of the work space, which the time step does not use. */
  double *at = s->block + s->size - 2 * m, *from = at - 2 * m, begin[2], duration = count * car->step;
  memcpy(from, s->before, (size_t)(2 * m) * sizeof(double));
  for (int64_t step = 1; step < steps; step++) {
    double t = (double)step / count, r = 1.0 - t;
    for (int64_t k = 0; k < m; k++) {
      const double *end = s->plate + 2 * k;
      memcpy(begin, from + 2 * k, sizeof begin);
      double rise = end[0] - begin[0];
      at[2 * k] = begin[0] + t * t * (3.0 - 2.0 * t) * rise + duration * t * r * (r * begin[1] - t * end[1]);
      at[2 * k + 1] = 6.0 * t * r * rise / duration + r * (1.0 - 3.0 * t) * begin[1] + t * (3.0 * t - 2.0) * end[1];
    }
    time_step(s, at);
  }
  memcpy(at, s->plate, (size_t)(2 * m) * sizeof(double));
  time_step(s, at);
  s->time[0] = s->start_time[0] + s->steps[0] * car->step;
  if (!is_finite(s))
    return refuse(message, "the motion of the car is no longer finite; reset the instance and check the inputs");
  return 1;
}

/* Index of a watched quantity that newly left its limits; -1 after the last of a check. Checked every CHECK_TIME. */
int64_t new_notice(State *s) {
  const Car *car = s->car;
  if (s->time[0] < s->checked[0]) return -1;
  for (int64_t k = 0; k < car->n.watched; k++) {
    if (s->warned[k] > 0.0) continue;
    double value = output_value(s, car->n.outputs + k);
    if (is_within(value, car->limit[2 * k], car->limit[2 * k + 1])) continue;
    s->warned[k] = 1.0;
    return k;
  }
  s->checked[0] = s->time[0] + CHECK_TIME;
  return -1;
}
