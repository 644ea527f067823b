/* Step of a controller FMU, a law by address (call_law in laws.h) whose memory is a Controller record.
 *
 * At the communication point t_k = k T the FMU gets its sensors, does the communication step from t_k to t_k + T, and
 * returns the damper coefficient c that holds over this step. Sensors: body velocity vb, wheel velocity vw, vb - vw,
 * and the mean accelerations of both since t_k - T, 0 in the first step. After a failed call the FMU is not called
 * again in this run, and the last coefficient holds; Python then raises (`vehicle.model.laws.controller_fmu`). */
#include <stddef.h>
#include "laws.h"

enum { WARNING = 1, NOT_FINITE = 10, TERMINATED = 11 }; /* largest status of a successful call; further statuses */

/* fmi2SetReal, fmi2GetReal, fmi3SetFloat64, fmi3GetFloat64: those of FMI 3.0 take the number of values as a last
 * argument, which those of FMI 2.0 ignore: by the calling conventions of these platforms the caller removes it. */
typedef int32_t Transfer(void *instance, const uint32_t *references, size_t count, double *values, size_t values_count);
/* fmi2DoStep, and fmi3DoStep with its four results. The third number: no later reset of the state. */
typedef int32_t DoStep(void *instance, double time, double length, int32_t no_reset, void *event, void *terminate,
                       void *early, void *last);

EXPORT double core_controller_step(void *memory, double body, double wheel) {
  Controller *c = memory;
  if (c->status > WARNING) return c->coefficient;
  double *measured = c->measured.at, before = c->coefficient;
  size_t count = (size_t)c->sources.n[0];
  /* measured[0], [1] still have the velocities of the last reading: mean accelerations since then. */
  if (c->readings > 0) {
    measured[3] = (body - measured[0]) / c->period;
    measured[4] = (wheel - measured[1]) / c->period;
  }
  measured[0] = body, measured[1] = wheel, measured[2] = body - wheel;
  for (size_t i = 0; i < count; i++) c->inputs.at[i] = measured[c->sources.at[i]];
  void *instance = (void *)(uintptr_t)c->instance;
  int32_t status = ((Transfer *)(uintptr_t)c->set)(instance, c->references.at, count, c->inputs.at, count);
  if (status <= WARNING) {
    int64_t *r = c->results.at;
    status = ((DoStep *)(uintptr_t)c->step)(instance, (double)c->readings * c->period, c->period, 1, r, r + 1, r + 2, r + 3);
  }
  if (status <= WARNING)
    status = ((Transfer *)(uintptr_t)c->get)(instance, c->references.at + count, 1, &c->coefficient, 1);
  /* The comparison is false for NaN too. */
  if (status <= WARNING && !(absolute(c->coefficient) < 1e300)) status = NOT_FINITE;
  if (status <= WARNING && c->results.at[1] % 256 != 0) status = TERMINATED;
  if (status > WARNING) {
    c->status = status;
    return c->coefficient = before;
  }
  c->readings++;
  return c->coefficient;
}
