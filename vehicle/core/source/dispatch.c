/* The functions of the core that Python calls in the variant of this processor; see dispatch.h. */
#include "dispatch.h"

/* 3: AVX2, 2: SSE2, 1: the only variant of other processors. */
#if defined(__x86_64__) || defined(_M_X64)
EXPORT int64_t core_variant(void) { return avx2() ? 3 : 2; }
#else
EXPORT int64_t core_variant(void) { return 1; }
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
