/* Force laws, one function each, for the reduced car and for the rows of MuJoCo alike. The classes of the same names in
 * `vehicle/model/laws` give equations, sources and units; tests compare these functions with them. */
#ifndef CORE_LAWS_H
#define CORE_LAWS_H
#include "layout.h"
#include "mathematics.h"

/* min(L, max(-L, F)). */
static inline double clamp(double force, double limit) { return smaller(larger(force, -limit), limit); }

/* c = (2/pi) L eps: slope at rest of clamped friction [N s/m]. */
static inline double slope_at_rest(double limit, double smoothing) {
  return 0.6366197723675814 * limit * smoothing;
}

/* Friction laws by name, in the order of FRICTION_LAWS: each has a function NAME_limit, the limit L(v) [N]. */
#define EACH_FRICTION_LAW(F) F(coulomb) F(stribeck) F(presliding)

static inline double coulomb_limit(const DamperLaw *law, double velocity) {
  (void)velocity;
  return law->friction_limit;
}

/* Jenkins elements yield below the limit, see scalar_elements.h. */
static inline double presliding_limit(const DamperLaw *law, double velocity) { return coulomb_limit(law, velocity); }

/* Fd + (Fs - Fd) exp(-|v/vs|^delta); a ratio of 1e15 is sliding. */
static inline double stribeck_limit(const DamperLaw *law, double velocity) {
  double ratio = smaller(absolute(velocity / law->stribeck_velocity), 1e15);
  double weight = exponential(-power(ratio, law->stribeck_exponent));
  return law->friction_limit + (law->static_limit - law->friction_limit) * weight;
}

#define NUMBER_OF_LAW(name) LAW_##name,
enum { EACH_FRICTION_LAW(NUMBER_OF_LAW) };

/* Law by address: double function(void *memory, double first, double second); `call`: address of a Call. */
typedef double LawByAddress(void *memory, double first, double second);
static inline double call_law(double call, double first, double second) {
  const Call *c = (const Call *)(uintptr_t)call;
  return ((LawByAddress *)(uintptr_t)c->function)((void *)(uintptr_t)c->memory, first, second);
}

/* Friction limit L(v) of a damper [N] by its law. From FIRST_ADDRESS on, the law is no index but the address of a Call of
 * Fd and v; a limit below zero counts as zero, and NaN stays NaN. */
enum { FIRST_ADDRESS = 4096 };
static inline double friction_limit(const DamperLaw *law, double velocity) {
  if (law->friction_law >= FIRST_ADDRESS) return larger(0.0, call_law(law->friction_law, law->friction_limit, velocity));
  switch ((int)law->friction_law) {
#define LIMIT_OF_LAW(name) case LAW_##name: return name##_limit(law, velocity);
    EACH_FRICTION_LAW(LIMIT_OF_LAW)
  }
  return law->friction_limit;
}

/* Piecewise linear F(x) = s x + b: upper edges (the last infinite), slopes and offsets of the segments. */
static inline double curve_force(double x, const double *edge, const double *slope, const double *offset) {
  int64_t i = 0;
  while (x > edge[i]) i++;
  return slope[i] * x + offset[i];
}

/* Jenkins element after a further displacement: clamp(t + k dx, l). */
static inline double jenkins(double force, double stiffness, double change, double limit) {
  return clamp(force + stiffness * change, limit);
}

/* Force of a damper by address beyond its line, F(x, v) - D v [N]. */
static inline double own_force(const OwnLaw *law, double x, double v) {
  LawByAddress *function = (LawByAddress *)(uintptr_t)law->function;
  return function((void *)(uintptr_t)law->memory, x, v) - law->viscous * v;
}

/* Its slope from v to the velocity v + *change that is expected; a change below 1e-6 m/s becomes that. At least -D: a
 * force that falls with the velocity is explicit. */
static inline double own_slope(const OwnLaw *law, double x, double v, double *change) {
  if (absolute(*change) < 1e-6) *change = 1e-6;
  return larger((own_force(law, x, v + *change) - own_force(law, x, v)) / *change, -law->viscous);
}

/* Coefficient c that a control law demands, from the velocities of both ends along the damper [N s/m]. */
static inline double demanded(const Setting *law, double body, double wheel) {
  if (law->controller > 0.0) return smaller(larger(call_law(law->controller, body, wheel), law->softest), law->firmest);
  double way = body > wheel ? 1.0 : body < wheel ? -1.0 : 0.0, speed = absolute(body - wheel);
  if (law->on_off > 0.0) {
    double share = law->sky * (body * way > 0.0) + law->ground * (wheel * way < 0.0);
    return law->softest + (law->firmest - law->softest) * share;
  }
  double force = law->sky * larger(body * way, 0.0) + law->ground * larger(-wheel * way, 0.0);
  /* Limit the force before the division: the quotient stays finite, and at rest the damper is soft. */
  double near = smaller(larger(force, law->softest * speed), law->firmest * speed);
  return smaller(larger(near / (speed + (speed == 0.0)), law->softest), law->firmest);
}

/* Memory of a controlled damper: demand, coefficient at the end of the step, its mean over it, demands of past steps. */
enum { HELD, REACHED, PRESENT, RING };

/* Advance a controlled damper by one time step: past[PRESENT] is then its mean coefficient. */
static inline void act(const Setting *law, int64_t step, double body, double wheel, double *past) {
  if (step % (int64_t)law->period == 0) past[HELD] = demanded(law, body, wheel);
  int64_t length = (int64_t)law->lag + 1;
  past[RING + step % length] = past[HELD];
  double wanted = past[RING + (step + 1) % length], change = law->change, from = past[REACHED];
  past[REACHED] = smaller(larger(wanted, from - change), from + change);
  /* The change takes the share |moved| / change of the step, with half of it as its mean. */
  double moved = past[REACHED] - from;
  past[PRESENT] = past[REACHED] - 0.5 * moved * absolute(moved) / change;
}
#endif
