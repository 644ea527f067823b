/* Fields of mjData in one call of the callback, and the small vectors of its elements.
 *
 * No header of MuJoCo is needed: fields with constant addresses come in the records, those of the constraint rows by
 * byte offsets that vehicle/engines/simulation/structures.py checks against the library in use.
 */
#ifndef NOW_H
#define NOW_H
#include "laws.h"

#define FIELD_AT(type, owner, offset) (*(type *)((char *)(owner) + (offset)))
#define AT(array, row, column) (array).at[(row) * (array).n[1] + (column)]
#define ROW(array, row) ((array).at + (row) * (array).n[1])

/* Fields over the constraint rows, which move between steps; J always has all columns. */
typedef struct {
  const Fields *f;
  double time, *J, *KBIP, *pos, *vel, *aref, *D, *R, *loss;
  int64_t rows, width; /* width: numbers in a row of J */
} Now;

static const double EMPTY_ROW = 1e-9; /* impedance [kg] of a row without damping and stiffness: small, not zero */

static inline double *frame_of(const Now *o, int64_t body) { return o->f->xmat.at + 9 * body; }
static inline double *motion_of(const Now *o, int64_t dof) { return o->f->cdof.at + 6 * dof; }
static inline double *row_of(const Now *o, int64_t row) { return o->J + row * o->width; }

static inline double dot3(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void cross(const double *a, const double *b, double *r) {
  r[0] = a[1] * b[2] - a[2] * b[1];
  r[1] = a[2] * b[0] - a[0] * b[2];
  r[2] = a[0] * b[1] - a[1] * b[0];
}
/* Vector of a frame in the axes around it, r = F v, and the inverse. */
static inline void out_of(const double *frame, const double *v, double *r) {
  double x = v[0], y = v[1], z = v[2];
  for (int i = 0; i < 3; i++) r[i] = frame[3 * i] * x + frame[3 * i + 1] * y + frame[3 * i + 2] * z;
}
static inline void into(const double *frame, const double *v, double *r) {
  double x = v[0], y = v[1], z = v[2];
  for (int i = 0; i < 3; i++) r[i] = frame[i] * x + frame[3 + i] * y + frame[6 + i] * z;
}
/* Velocity of a point by a unit of a coordinate: v + w x (point - centre of mass of its tree). */
static inline void velocity_at(const Now *o, int64_t dof, int64_t tree, const double *point, double *r) {
  const double *motion = motion_of(o, dof), *centre = o->f->subtree_com.at + 3 * tree;
  double arm[3] = {point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]};
  cross(motion, arm, r);
  for (int i = 0; i < 3; i++) r[i] += motion[3 + i];
}

/* Sum of products in four parts, so that all compilers use SIMD and round alike. */
static inline double dot(const double *a, const double *b, int64_t count) {
  double part[4] = {0, 0, 0, 0};
  int64_t i = 0;
  for (; i + 4 <= count; i += 4)
    for (int k = 0; k < 4; k++) part[k] += a[i + k] * b[i + k];
  for (int k = 0; i < count; i++, k++) part[k] += a[i] * b[i];
  return (part[0] + part[1]) + (part[2] + part[3]);
}
#endif
