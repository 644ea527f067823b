/* What Python asks of a loaded core: its stamp, the layout of its records, and single laws for tests. */
#include "laws.h"

#ifndef STAMP
#define STAMP "" /* digest of the sources, from the command of the compiler */
#endif

EXPORT const char *core_stamp(void) { return STAMP; }

/* Size of each record of layout.h, each followed by the offsets of its fields; returns how many numbers these are. */
EXPORT int64_t core_layout(int64_t *numbers, int64_t room) {
  int64_t count = 0;
#define ADD(number) do { if (count < room) numbers[count] = (int64_t)(number); count++; } while (0)
#define OFFSET(kind, name) ADD((char *)&here.name - (char *)&here);
#define ADD_RECORD(record, fields) { record here; ADD(sizeof here); fields(OFFSET) }
  EACH_LAW(ADD_RECORD)
  EACH_RECORD(ADD_RECORD)
  return count;
}

/* Names of the friction laws in their order, each followed by a space. */
EXPORT const char *core_friction_laws(void) {
#define NAME_OF_LAW(name) #name " "
  return EACH_FRICTION_LAW(NAME_OF_LAW);
}

/* Laws and mathematics at one state, for tests and for Python. */
EXPORT double core_friction_limit(const DamperLaw *law, double velocity) { return friction_limit(law, velocity); }
EXPORT double core_demanded(const Setting *law, double body, double wheel) { return demanded(law, body, wheel); }
EXPORT void core_act(const Setting *law, int64_t step, double body, double wheel, double *past) {
  act(law, step, body, wheel, past);
}
EXPORT double core_curve_force(double x, const double *edge, const double *slope, const double *offset) {
  return curve_force(x, edge, slope, offset);
}
EXPORT double core_exponential(double x) { return exponential(x); }
EXPORT double core_logarithm(double x) { return logarithm(x); }
EXPORT double core_power(double x, double y) { return power(x, y); }
