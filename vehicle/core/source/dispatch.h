/* Functions that exist for several processors and number types, chosen once by the processor.
 *
 * A variant file (march.c, ...) is compiled as name_d3 and name_f3 for AVX2 and as name_d2 and name_f2 for SSE2 on
 * x86-64, elsewhere as name_d1 and name_f1; callers use core_name_d and core_name_f. `__builtin_cpu_supports` is not
 * used: in a library built by zig it is false for everything, because nothing fills its table. */
#ifndef CORE_DISPATCH_H
#define CORE_DISPATCH_H
#include "layout.h"

#if defined(__x86_64__) || defined(_M_X64)
#include <cpuid.h>
static int avx2(void) {
  static int known = -1;
  unsigned a, b, c, d, low, high;
  if (known >= 0) return known;
  known = 0;
  if (!__get_cpuid(1, &a, &b, &c, &d) || !(c >> 27 & 1) || !(c >> 28 & 1)) return 0; /* OSXSAVE, AVX */
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  if ((low & 6) != 6 || !__get_cpuid_count(7, 0, &a, &b, &c, &d)) return 0; /* the system saves YMM */
  return known = b >> 5 & 1;
}
#define CHOOSE(result, precision, name, parameters, arguments) \
  result name##_##precision##2 parameters; \
  result name##_##precision##3 parameters; \
  EXPORT result core_##name##_##precision parameters { \
    if (avx2()) return name##_##precision##3 arguments; \
    return name##_##precision##2 arguments; \
  }
#else
#define CHOOSE(result, precision, name, parameters, arguments) \
  result name##_##precision##1 parameters; \
  EXPORT result core_##name##_##precision parameters { return name##_##precision##1 arguments; }
#endif
#endif
