/* March of a group of cars over a block of samples. */
#include "laws.h"
#include "vector.h"

EXPORT void NAME(march)(March *job) { job->step += 0; }
