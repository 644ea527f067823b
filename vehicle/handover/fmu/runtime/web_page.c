/* Functions of the WebAssembly module: whole runs of a car for the script of a web page. */
#include <stdlib.h>
#include <string.h>

#include "car.h"

#undef EXPORT /* of the core */
#define EXPORT __attribute__((visibility("default")))

EXPORT void *reserve(size_t size) { return malloc(size); }

/* Return an instance of the car whose numbers are the content of resources/car.bin; NULL if they are damaged. */
EXPORT Motion *open_car(const char *bytes, size_t size) {
  Motion *s = calloc(1, sizeof(Motion));
  Car *car = s ? car_from(bytes, size) : NULL;
  return car && make_state(s, car) ? s : NULL;
}

/* Run the car from rest; return the samples done, fewer than `samples` if the motion has no solution.
 *
 * parameter: (dampers, PARAMETERS); plate: z, z' of each plate at the samples, (samples, plates, 2); interval [s];
 * output: indices of outputs, (outputs); value: (outputs, samples), written. */
EXPORT int32_t run_car(Motion *s, const double *parameter, const double *plate, int32_t samples, double interval,
                       const int32_t *output, int32_t outputs, double *value) {
  size_t plates = (size_t)(2 * plate_count(s->car));
  int64_t steps = (int64_t)(interval / s->car->data.step + 0.5);
  reset_state(s);
  memcpy(s->parameter, parameter, (size_t)(damper_count(s->car) * PARAMETERS) * sizeof(double));
  for (int64_t i = 0; i < damper_count(s->car); i++)
    if (!has_solution(s, i)) return 0;
  for (int32_t k = 0; k < samples; k++) {
    memcpy(s->plate, plate + plates * (size_t)k, plates * sizeof(double));
    if (k == 0) set_at_rest(s);
    else advance(s, steps), s->time[0] = s->steps[0] * s->car->data.step;
    if (!is_finite(s)) return k;
    while (new_notice(s) >= 0) continue;
    for (int32_t o = 0; o < outputs; o++) value[o * samples + k] = output_value(s, output[o]);
  }
  return samples;
}

/* Return the number of watched quantities, and the notice on one of them; NULL if it stayed within its limits. */
EXPORT int32_t watched(const Motion *s) { return (int32_t)watched_count(s->car); }

EXPORT const char *notice(const Motion *s, int32_t k) { return s->warned[k] > 0.0 ? notice_of(s->car, k) : NULL; }
