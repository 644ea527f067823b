/* Instance of a car: its variables by value reference, its communication steps, and all checks of what comes from
 * outside. Messages say what is wrong and how to mend it.
 *
 * Value references, as in variables.py: 0 time; 100 + 2 k and 101 + 2 k displacement and velocity of plate k;
 * 5000 + k its slope velocity beyond the velocity, for rolling tyres; 7000 + k applied force k; 10000 + 2 i and 10001 + 2 i force and coefficient
 * command of damper i; 20000 + PARAMETERS i + k parameters of damper i; 30000 + o outputs. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "car.h"
#include "laws.h"

enum { FIRST_PLATE = 100, FIRST_SLOPE = 5000, FIRST_FORCE = 7000, FIRST_COMMAND = 10000 };
enum { FIRST_PARAMETER = 20000, FIRST_OUTPUT = 30000 };
enum { MOST_STEPS = 100000, FROZEN_STEPS = 50 };

static const double TIME_TOLERANCE = 1e-3;             /* round-off of a communication point, share of the internal step */

static const double HIGHEST[2] = {1000.0, 100.0};      /* of plates [m, m/s] */
static const double STRONGEST[2] = {1e6, 1e6};         /* of commands [N, N s/m], and of applied forces [N or N m] */

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

static const char *plate_name(const Car *car, int64_t k) { return car->data.names.at + k * car->data.names.n[1]; }
static const char *damper_name(const Car *car, int64_t i) { return plate_name(car, plate_count(car) + i); }

/* Kinds of variables; the index within the kind is written to `index`. */
enum { UNKNOWN, TIME, PLATE, SLOPE, PUSH, COMMAND, DAMPER_PARAMETER, OUTPUT };

static int kind_of(const Car *car, uint32_t reference, int64_t *index) {
  static const uint32_t first[] = {FIRST_OUTPUT, FIRST_PARAMETER, FIRST_COMMAND, FIRST_FORCE, FIRST_SLOPE, FIRST_PLATE,
                                   0};
  static const int kinds[] = {OUTPUT, DAMPER_PARAMETER, COMMAND, PUSH, SLOPE, PLATE, TIME};
  int64_t counts[] = {output_count(car), damper_count(car) * PARAMETERS, 2 * damper_count(car), force_count(car),
                      car->data.march.tyres, 2 * plate_count(car), 1};
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
    if (reference < first[k]) continue;
    *index = (int64_t)(reference - first[k]);
    return *index < counts[k] ? kinds[k] : UNKNOWN;
  }
  return UNKNOWN;
}

int get_value(const Motion *s, uint32_t reference, double *value, char *message) {
  int64_t index = 0;
  switch (kind_of(s->car, reference, &index)) {
    case TIME: *value = s->time[0]; return 1;
    case PLATE: *value = s->plate[index]; return 1;
    case SLOPE: *value = s->slope_excess[index]; return 1;
    case PUSH: *value = s->plate[2 * (plate_count(s->car) + index) + 1]; return 1;
    case COMMAND: *value = s->command[index]; return 1;
    case DAMPER_PARAMETER: *value = s->parameter[index]; return 1;
    case OUTPUT: *value = output_value(s, index); return 1;
    default: return refuse(message, "no variable has the value reference %u", (unsigned)reference);
  }
}

static int is_within(double value, double low, double high) { return value >= low && value <= high; }

static int is_stribeck(const Car *car, int64_t i) { return car->data.dampers.at[i].friction_law == LAW_stribeck; }

static int set_parameter(Motion *s, int64_t index, double value, char *message) {
  const Car *car = s->car;
  int64_t i = index / PARAMETERS, k = index % PARAMETERS;
  double *own = s->parameter + i * PARAMETERS;
  int stribeck = is_stribeck(car, i), controlled = 0;
  for (int64_t c = 0; c < car->data.march.controlled.n[0]; c++) controlled |= car->data.march.controlled.at[c] == i;
  if ((k == PARAMETER_STATIC_FRICTION || k == PARAMETER_STRIBECK_VELOCITY || k == PARAMETER_STRIBECK_EXPONENT) &&
      !stribeck)
    return refuse(message, "%s_%s: the friction of this damper is constant; write the FMU of a car with friction_law = "
                  "\"stribeck\"", damper_name(car, i), PARAMETER[k].name);
  if (k == PARAMETER_CONTROL && !controlled)
    return refuse(message, "%s_control: this damper has no control law", damper_name(car, i));
  if (!is_within(value, PARAMETER[k].low, PARAMETER[k].high))
    return refuse(message, "%s_%s: found %g, must be %g to %g %s", damper_name(car, i), PARAMETER[k].name, value,
                  PARAMETER[k].low, PARAMETER[k].high, PARAMETER[k].unit);
  own[k] = value;
  return 1;
}

int set_value(Motion *s, uint32_t reference, double value, char *message) {
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
    case PUSH:
      if (!is_within(value, -STRONGEST[0], STRONGEST[0]))
        return refuse(message, "%s: found %g, must be %g to %g N or N m",
                      car->data.forces.at + index * car->data.forces.n[1], value, -STRONGEST[0], STRONGEST[0]);
      s->plate[2 * (plate_count(car) + index) + 1] = value;
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

static int check_dampers(const Motion *s, char *message) {
  const Car *car = s->car;
  for (int64_t i = 0; i < damper_count(car); i++) {
    const double *own = s->parameter + i * PARAMETERS;
    if (is_stribeck(car, i) && own[PARAMETER_STATIC_FRICTION] < own[PARAMETER_FRICTION])
      return refuse(message, "%s_static_friction: found %g N, must be at least %s_coulomb_friction = %g N",
                    damper_name(car, i), own[PARAMETER_STATIC_FRICTION], damper_name(car, i), own[PARAMETER_FRICTION]);
    if (!has_solution(s, i))
      return refuse(message, "%s_coefficient_command: %g N s/m with curve_scale %g makes the damper drive the car faster "
                    "than a step resolves; set a larger value", damper_name(car, i), s->command[2 * i + 1],
                    own[PARAMETER_CURVE_SCALE]);
  }
  return 1;
}

/* A master that connects displacements only leaves the velocities at 0, which gives wrong forces without a sign of it. */
static int check_plates(Motion *s, char *message) {
  for (int64_t k = 0; k < plate_count(s->car); k++) {
    const double *now = s->plate + 2 * k, *before = s->before + 2 * k;
    int frozen = now[0] != before[0] && now[1] == 0.0 && before[1] == 0.0;
    s->frozen[k] = frozen ? s->frozen[k] + 1.0 : 0.0;
    if ((int)s->frozen[k] >= FROZEN_STEPS)
      return refuse(message, "plate_%s_velocity has been 0 for %d steps while plate_%s_displacement moved; connect the "
                    "velocity of the plate too", plate_name(s->car, k), FROZEN_STEPS, plate_name(s->car, k));
  }
  return 1;
}

/* Advance by a communication step. The inputs belong to its end; within it the plates follow the cubic through
 * displacement and velocity at both ends. The car does not move if it is refused. */
int communication_step(Motion *s, double point, double length, char *message) {
  double step = s->car->data.step, count = floor(length / step + 0.5);
  if (!(length > 0.0))
    return refuse(message, "communication step of %g s: must be above 0", length);
  if (!(fabs(point - s->time[0]) <= TIME_TOLERANCE * step + 1e-9 * fabs(point)))
    return refuse(message, "communication point %.9g s: the car is at %.9g s; set back its state, or go on from there",
                  point, s->time[0]);
  /* A master that adds up its time has a remainder of round-off before its stop time; the car has arrived there. */
  if (length <= TIME_TOLERANCE * step) return 1;
  if (!(count >= 1.0 && count <= (double)MOST_STEPS) || fabs(length - count * step) > 1e-6 * step * count)
    return refuse(message, "communication step of %.9g s: must be a multiple of the internal step of %.9g s, up to %d "
                  "times; write the FMU with another --step", length, step, MOST_STEPS);
  if (!check_dampers(s, message) || !check_plates(s, message)) return 0;
  apply_commands(s);
  advance(s, (int64_t)count);
  s->time[0] = s->start_time[0] + s->steps[0] * step;
  if (!is_finite(s))
    return refuse(message, "the motion of the car is no longer finite; reset the instance and check the inputs");
  return 1;
}
