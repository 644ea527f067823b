/* The functions of the core that exist for several processors and number types, chosen once by the processor.
 *
 * A variant file (march.c, ...) is compiled as name_d3 and name_f3 for AVX2 and as name_d2 and name_f2 for SSE2 on
 * x86-64, elsewhere as name_d1 and name_f1; Python calls core_name_d and core_name_f. `__builtin_cpu_supports` is not
 * used: in a library built by zig it is false for everything, because nothing fills its table. */
#include "layout.h"

#if defined(__x86_64__) || defined(_M_X64)
#include <cpuid.h>
static int known = -1, offered = -1; /* in use; offered by the processor */
static int avx2(void) {
  unsigned a, b, c, d, low, high;
  if (known >= 0) return known;
  known = offered = 0;
  if (!__get_cpuid(1, &a, &b, &c, &d) || !(c >> 27 & 1) || !(c >> 28 & 1)) return 0; /* OSXSAVE, AVX */
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  if ((low & 6) != 6 || !__get_cpuid_count(7, 0, &a, &b, &c, &d)) return 0; /* the system saves YMM */
  return known = offered = b >> 5 & 1;
}
/* 3: AVX2, 2: SSE2, 1: the only variant of other processors. */
EXPORT int64_t core_variant(void) { return avx2() ? 3 : 2; }
/* Take the variant 2 or 3 from now on, for tests; return the one that is taken. */
EXPORT int64_t core_use(int64_t variant) {
  avx2();
  known = offered && variant == 3;
  return core_variant();
}
#define CHOOSE(result, precision, name, parameters, arguments) \
  result name##_##precision##2 parameters; \
  result name##_##precision##3 parameters; \
  EXPORT result core_##name##_##precision parameters { \
    if (avx2()) return name##_##precision##3 arguments; \
    return name##_##precision##2 arguments; \
  }
#else
EXPORT int64_t core_variant(void) { return 1; }
#define CHOOSE(result, precision, name, parameters, arguments) \
  result name##_##precision##1 parameters; \
  EXPORT result core_##name##_##precision parameters { return name##_##precision##1 arguments; }
#endif

CHOOSE(void, d, march, (March *job), (job))
CHOOSE(void, f, march, (March *job), (job))
CHOOSE(void, d, solve_forces, (const March *job), (job))
CHOOSE(void, f, solve_forces, (const March *job), (job))

CHOOSE(void, d, locate, (int64_t user_size, int64_t user_data), (user_size, user_data))
CHOOSE(void, d, attach, (const Simulation *simulation, void *data), (simulation, data))
CHOOSE(void, d, detach, (const Simulation *simulation, void *data), (simulation, data))
CHOOSE(void, d, rewrite, (Simulation *simulation, void *data), (simulation, data))
CHOOSE(void, d, control, (const void *model, void *data), (model, data))
CHOOSE(double, d, gain, (const void *model, const void *data, int index), (model, data, index))
CHOOSE(double, d, bias, (const void *model, const void *data, int index), (model, data, index))
CHOOSE(double, d, damper_force, (const Simulation *simulation, int64_t index), (simulation, index))
CHOOSE(void, d, set_plates, (Loop *loop, int64_t step), (loop, step))
CHOOSE(void, d, keep_row, (Loop *loop, int64_t row, double half), (loop, row, half))
CHOOSE(int64_t, d, run_steps, (Loop *loop, int64_t first, int64_t last, int64_t row), (loop, first, last, row))
CHOOSE(void, d, solution, (const double *mass, const double *jacobian, const double *weight, const Solution *s),
       (mass, jacobian, weight, s))
