/* Functions of the WebAssembly module: whole runs of a car for the script of a web page. */
#include <stdlib.h>
#include <string.h>

#include "car.h"

#undef EXPORT /* of the core */
#define EXPORT __attribute__((visibility("default")))

/* Memory of the page is never given back: allocation is a mark that moves up. */
extern char __heap_base;
void *malloc(size_t size) {
  static uintptr_t top;
  uintptr_t first = ((top ? top : (uintptr_t)&__heap_base) + ROW - 1) / ROW * ROW, page = 65536;
  uintptr_t have = __builtin_wasm_memory_size(0) * page;
  if (size > UINTPTR_MAX / 2) return NULL;
  if (first + size > have && __builtin_wasm_memory_grow(0, (first + size - have + page - 1) / page) == SIZE_MAX) return NULL;
  top = first + size;
  return (void *)first;
}
void *calloc(size_t count, size_t size) { return malloc(count * size); } /* new memory is zero */
void free(void *memory) { (void)memory; }

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

/* Return 1 if a watched quantity left its limits in the last run. */
EXPORT int32_t left(const Motion *s, int32_t k) { return s->warned[k] > 0.0; }
