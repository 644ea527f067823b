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

/* Words of 8 bytes from runs (count, size, times) of their most significant bytes, bytes of equal significance together;
 * each word is there `times` times. See packed_numbers.py. */
static void unpack(const char *bytes, const int32_t *run, int32_t runs, char *words) {
  for (; runs--; words += 8 * run[0] * run[2], run += 3)
    for (int32_t byte = 8 - run[1]; byte < 8; byte++)
      for (int32_t k = 0; k < run[0]; k++, bytes++)
        for (int32_t t = 0; t < run[2]; t++) words[8 * (k * run[2] + t) + byte] = *bytes;
}

/* Return an instance of the car whose numbers are the packed content of resources/car.bin; NULL if they are damaged. */
EXPORT Motion *open_car(const char *bytes, const int32_t *run, int32_t runs) {
  size_t size = 0;
  for (int32_t i = 0; i < runs; i++) size += (size_t)(8 * run[3 * i] * run[3 * i + 2]);
  Motion *s = calloc(1, sizeof(Motion));
  char *words = calloc(1, size);
  unpack(bytes, run, runs, words);
  Car *car = car_from(words, size);
  return car && make_state(s, car) ? s : NULL;
}

/* Run the car from rest; return the samples done, fewer than `samples` if the motion has no solution.
 *
 * parameter: (dampers, PARAMETERS), then a factor on the plates; plate: z, z' of each plate at the samples, (samples,
 * plates, 2); interval [s]; output: indices of outputs, (outputs); value: (outputs, samples), written. */
EXPORT int32_t run_car(Motion *s, const double *parameter, const double *plate, int32_t samples, double interval,
                       const int32_t *output, int32_t outputs, double *value) {
  int32_t plates = 2 * (int32_t)plate_count(s->car);
  double level = parameter[damper_count(s->car) * PARAMETERS];
  int64_t steps = (int64_t)(interval / s->car->data.step + 0.5);
  reset_state(s);
  memcpy(s->parameter, parameter, (size_t)(damper_count(s->car) * PARAMETERS) * sizeof(double));
  for (int64_t i = 0; i < damper_count(s->car); i++)
    if (!has_solution(s, i)) return 0;
  for (int32_t k = 0; k < samples; k++) {
    for (int32_t i = 0; i < plates; i++) s->plate[i] = level * plate[plates * k + i];
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
