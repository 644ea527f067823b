/* Functions of the WebAssembly module: whole runs of a car for the script of a web page. */
#include <stdlib.h>
#include <string.h>

#include "car.h"

#define EXPORT __attribute__((visibility("default")))

static char message[MESSAGE];

EXPORT void *reserve(size_t size) { return malloc(size); }

EXPORT const char *last_message(void) { return message; }

/* Return an instance of the car whose numbers are the content of resources/car.bin; NULL if they are damaged. */
EXPORT State *open_car(const char *bytes, size_t size) {
  State *s = calloc(1, sizeof(State));
  Car *car = s ? car_from(bytes, size) : NULL;
  return car && make_state(s, car) ? s : NULL;
}

/* Run the car from rest; return the samples done, fewer than `samples` if a step was refused (see last_message).
 *
 * parameter: (dampers, PARAMETERS); plate: z, z' of each plate at the samples, (samples, plates, 2); interval [s];
 * output: indices of outputs, (outputs); value: (outputs, samples), written. */
EXPORT int32_t run_car(State *s, const double *parameter, const double *plate, int32_t samples, double interval,
                       const int32_t *output, int32_t outputs, double *value) {
  const Sizes *n = &s->car->n;
  size_t plates = (size_t)(2 * n->plates);
  reset_state(s);
  memcpy(s->parameter, parameter, (size_t)(n->dampers * PARAMETERS) * sizeof(double));
  for (int32_t k = 0; k < samples; k++) {
    memcpy(s->plate, plate + plates * (size_t)k, plates * sizeof(double));
    if (k == 0) set_at_rest(s);
    else if (!communication_step(s, s->time[0], interval, message)) return k;
    while (new_notice(s) >= 0) continue;
    for (int32_t o = 0; o < outputs; o++) value[o * samples + k] = output_value(s, output[o]);
  }
  return samples;
}

/* Return the number of watched quantities, and the notice on one of them; NULL if it stayed within its limits. */
EXPORT int32_t watched(const State *s) { return (int32_t)s->car->n.watched; }

EXPORT const char *notice(const State *s, int32_t k) { return s->warned[k] > 0.0 ? s->car->notice + k * NOTICE : NULL; }
