/* Spectra of records for a page; see spectra.c. */
#ifndef CORE_SPECTRA_H
#define CORE_SPECTRA_H
#include "layout.h"
#include "mathematics.h"

/* Fourier transform of a length n, a product of powers of 2, 3 and 5. circle: cos(2 pi k/n), then sin(2 pi k/n), 2 n
 * numbers; work: 4 n numbers, of which a transform changes the second half. */
typedef struct {
  int64_t n;
  double *circle, *work;
} Transform;

void core_circle(const Transform *t);
void core_transform(const Transform *t, double *x, double *y);
void core_weigh(const Transform *t, double *x, double *y, double interval, const double *sections, int64_t count);
void core_density(const Transform *t, const double *values, int64_t samples, int64_t distance, double interval, double *density);
void core_spline(int64_t n, const double *z, double interval, double *d, double *upper);
#endif
