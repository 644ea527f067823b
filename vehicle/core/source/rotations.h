/* Explicit torques of the elements with a rotational stiffness, after the forces of the rows.
 *
 * The torque on the moving part is T = C p - K_rot sin(angle) n with sin(angle) n = half the sum of c_k x m_k over the
 * axes of the carrier's frame C and of the moving part's: K_rot is soft compared with every inertia and undamped, so it
 * needs no rows.
 *
 * With rotational mode shapes of a node, theta = R Psi_n q rotates the frame of that side: c_k + theta x c_k. The preload
 * p rotates with the node too. The torque acts on the modes by +-Psi_n' R' T and on the rigid body by +-T. Without
 * rotational shapes, the side rotates as a rigid body. Only torques depend on theta. The axes of the forces of a bushing
 * rotate with the rigid body: the neglected theta x f0 is of the order of the neglected moment r x f (rows.h).
 */
#ifndef ROTATIONS_H
#define ROTATIONS_H
#include "now.h"

/* Torque of an element between two frames, given row by row, in world axes. */
static void torque(int64_t n, const double *moving, const double *carrier, const Layout *e, const Weights *w, State *s) {
  const double half = 0.5 * e->rotations.stiffness.at[n];
  const double *preload = w->preload.at + w->preload.n[0] - 3 * e->rotations.sites.n[0] + 3 * n;
  double *total = ROW(s->torque, n);
  total[0] = total[1] = total[2] = 0.0;
  for (int axis = 0; axis < 3; axis++) {
    double c[3] = {carrier[axis], carrier[3 + axis], carrier[6 + axis]}, turned[3];
    double m[3] = {moving[axis], moving[3 + axis], moving[6 + axis]};
    cross(c, m, turned);
    for (int i = 0; i < 3; i++) total[i] += preload[axis] * c[i] - half * turned[i];
  }
}

/* Torque of an element at a node with rotational mode shapes, applied to the modes. */
static void node_torque(int64_t k, const Now *o, const Layout *e, const Weights *c, State *s) {
  const Rotations *p = &e->rotations;
  const Modes *m = &e->modes;
  const int64_t n = AT(p->nodes, k, 0), side = AT(p->nodes, k, 1);
  const double *shape = ROW(p->shapes, k), *turn = frame_of(o, m->body), *q = o->f->qpos.at + m->first_position;
  const double *rigid = ROW(o->f->site_xmat, AT(p->sites, n, side));
  const double *other = ROW(o->f->site_xmat, AT(p->sites, n, 1 - side));
  double *frame = ROW(s->frame, k), theta[3], along[3];
  for (int i = 0; i < 3; i++) theta[i] = dot(shape + i * m->size, q, m->size);
  out_of(turn, theta, theta);
  for (int axis = 0; axis < 3; axis++) {
    double was[3] = {rigid[axis], rigid[3 + axis], rigid[6 + axis]}, change[3];
    cross(theta, was, change);
    for (int i = 0; i < 3; i++) frame[3 * i + axis] = was[i] + change[i];
  }
  torque(n, side ? other : frame, side ? frame : other, e, c, s);
  into(turn, ROW(s->torque, n), along);
  for (int i = 0; i < 3; i++) along[i] *= (double)(1 - 2 * side);
  double *restrict total = o->f->qfrc_applied.at + m->first_velocity;
  for (int64_t mode = 0; mode < m->size; mode++)
    total[mode] += shape[mode] * along[0] + shape[m->size + mode] * along[1] + shape[2 * m->size + mode] * along[2];
}

static void rotations(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Rotations *p = &e->rotations;
  for (int64_t n = 0; n < p->sites.n[0]; n++)
    torque(n, ROW(o->f->site_xmat, AT(p->sites, n, 0)), ROW(o->f->site_xmat, AT(p->sites, n, 1)), e, c, s);
  for (int64_t k = 0; k < p->nodes.n[0]; k++) node_torque(k, o, e, c, s);
  for (int64_t entry = 0; entry < p->turning.n[0]; entry++) {
    const int64_t *of = ROW(p->turning, entry), n = of[0], dof = of[1], sign = of[2];
    o->f->qfrc_applied.at[dof] += (double)sign * dot3(motion_of(o, dof), ROW(s->torque, n));
  }
}
#endif
