/* Functions of the core that the library calls in the variant of the processor. */
#include "dispatch.h"

CHOOSE(void, d, march, (March *job), (job))
CHOOSE(double, d, read_row, (const March *job, const void *row, const double *z), (job, row, z))
