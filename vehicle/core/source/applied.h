/* Applied forces: forces and moments along fixed directions of the world or of a part, at points of parts, and torques
 * on joints.
 *
 * The generalised force of a force f and a moment m at a point p of a part is J_p' f + J_r' m with the Jacobians of the
 * present position; at a node of the flexible body also Phi' R' f + Psi' R' m on the modes, R being the rotation of the
 * body. `applied` holds each force at the present time, averaged over three steps like springs and plates:
 * F + (F(t + h) - 2 F(t) + F(t - h))/12; without it the answer of a part to a force would be wrong by (w h)^2/12.
 */
#ifndef APPLIED_H
#define APPLIED_H
#include "now.h"

/* Directions of force and moment of an element in world axes. */
static inline void direction_of(const Now *o, const Applied *a, int64_t n, double *way) {
  const double *given = ROW(a->directions, n), none[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double *frame = a->frames.at[n] < 0 ? none : frame_of(o, a->frames.at[n]);
  out_of(frame, given, way);
  out_of(frame, given + 3, way + 3);
}

static void applied_forces(const Now *o, const Layout *e, State *s) {
  const Applied *a = &e->applied;
  const Modes *m = &e->modes;
  double *push = s->push.at;
  for (int64_t entry = 0; entry < a->dofs.n[0]; entry++) {
    const int64_t n = AT(a->dofs, entry, 0), dof = AT(a->dofs, entry, 1), tree = AT(a->dofs, entry, 2);
    double velocity[3], way[6];
    direction_of(o, a, n, way);
    velocity_at(o, dof, tree, ROW(o->f->site_xpos, a->sites.at[n]), velocity);
    push[dof] += s->applied.at[a->forces.at[n]] * (dot3(way, velocity) + dot3(way + 3, motion_of(o, dof)));
  }
  for (int64_t k = 0; k < a->nodes.n[0]; k++) {
    const int64_t n = a->nodes.at[k];
    double local[6], way[6];
    direction_of(o, a, n, way);
    into(frame_of(o, m->body), way, local);
    into(frame_of(o, m->body), way + 3, local + 3);
    for (int i = 0; i < 6; i++) {
      const double *shape = ROW(a->shapes, k) + i * m->size, part = s->applied.at[a->forces.at[n]] * local[i];
      for (int64_t j = 0; j < m->size; j++) push[m->first_velocity + j] += part * shape[j];
    }
  }
  for (int64_t k = 0; k < a->torques.n[0]; k++) push[AT(a->torques, k, 0)] += s->applied.at[AT(a->torques, k, 1)];
}
#endif
