/* Modes of the flexible body, in the rows of its nodes and, if it has many, integrated here.
 *
 * Modal coordinates q move node n by d = R Phi_n q, R being the rotation of the body. They enter a row there as
 * r -> r +- d, and its derivative by the coordinates as J -> J +- (R Phi_n, -[d]x on what turns the body): without the
 * second part the body would miss the torque d x F of every force at a node.
 *
 * Bodies with many modes: MuJoCo solves for the motion of the attachments, the callback integrates all modes. All forces
 * act on the N modes through the shapes Phi at the attachments, (r_0, N), and depend on q only by Phi q:
 *
 *     m q'' = -k (q - q_0) - b q' + Phi' f        (diagonal m, k, b)
 *
 * With an orthonormal basis Q of the range of m^-1/2 Phi', N x r, r <= r_0, and S = m^-1/2 Q, the motion of the
 * attachments is Phi q = (Phi S) eta, eta = Q' m^1/2 q, and
 *
 *     eta'' = S' (-k (q - q_0) - b q') + (Phi S)' f,      q'' = (-k (q - q_0) - b q') / m + S (eta'' - S' (...)).
 *
 * The MuJoCo model has the r coordinates eta with unit masses, the shapes Phi S and the applied force S' (...). From
 * eta'' the N modes take the same step, v+ = v + h q'', q+ = q + h v+, at the beginning of the next step. Results equal
 * those of a model with all modes, to round-off. Modes cost r N products a step, in place of nv^2 products for each row
 * of a dense solver. With no more than r modes, the MuJoCo model contains the modes.
 */
#ifndef MODES_H
#define MODES_H
#include "now.h"

/* q'' of a mode from all modal positions and rates, and from the force of the attachments. */
static double modal_acceleration(int64_t k, const double *q, const double *rate, const double *pull,
                                 const ModalSpace *space) {
  double elastic = space->stiffness.at[k] * (space->rest.at[k] - q[k]) - space->damping.at[k] * rate[k];
  return elastic / space->mass.at[k] + dot(ROW(space->spread, k), pull, space->spread.n[1]);
}

/* Advance the modal coordinates over the completed step; before advance_branches, which sets the time. */
static void advance_modes(const Now *o, const Layout *e, const Weights *c, State *s) {
  const ModalSpace *space = &e->space;
  const int64_t size = e->modes.size;
  const double *position = o->f->qpos.at + e->modes.first_position, *velocity = o->f->qvel.at + e->modes.first_velocity;
  double *q = ROW(s->modal, 0), *rate = ROW(s->modal, 1);
  if (space->mass.n[0] == 0) {
    for (int64_t k = 0; k < size; k++) q[k] = position[k], rate[k] = velocity[k];
    return;
  }
  const double last = s->last_time.at[0], h = c->timestep;
  double *force = s->modal_force.at, *pull = s->modal_pull.at;
  if (o->time == last) return;
  for (int64_t j = 0; j < size; j++) {
    pull[j] = (velocity[j] - s->modal_rate.at[j]) / h - force[j];
    s->modal_rate.at[j] = velocity[j];
    force[j] = 0.0;
  }
  for (int64_t k = 0; k < s->modal.n[1]; k++) {
    if (last >= 0.0) {
      rate[k] += h * modal_acceleration(k, q, rate, pull, space);
      q[k] += h * rate[k];
    }
    const double *row = ROW(space->spread, k);
    double elastic = space->stiffness.at[k] * (space->rest.at[k] - q[k]) - space->damping.at[k] * rate[k];
    for (int64_t j = 0; j < size; j++) force[j] += row[j] * elastic;
  }
}

/* Add the modes to the rows at flexible nodes: J -> J +- (R Phi_n, -[d]x), r -> r +- d, r' -> r' +- (R Phi_n q' + w x d).
 */
static void modal_rows(const Now *o, const Layout *e, State *s) {
  const Modes *m = &e->modes;
  const int64_t modes = m->size, nodes = m->rows.n[1], count = m->mode_shapes.n[1];
  const double *turn = frame_of(o, m->body);
  double *restrict moved = ROW(s->deflection, 0), *restrict moving = ROW(s->deflection, 1);
  for (int64_t i = 0; i < count; i++) moved[i] = moving[i] = 0.0;
  for (int64_t k = 0; k < modes; k++) { /* mode by mode: long loops without dependent sums */
    const double q = o->f->qpos.at[m->first_position + k], rate = o->f->qvel.at[m->first_velocity + k];
    const double *restrict shape = ROW(m->mode_shapes, k);
    for (int64_t i = 0; i < count; i++) {
      moved[i] += shape[i] * q;
      moving[i] += shape[i] * rate;
    }
  }
  for (int64_t node = 0; node < nodes; node++) {
    double d[3] = {moved[node], moved[nodes + node], moved[2 * nodes + node]}, v[3];
    double rate[3] = {moving[node], moving[nodes + node], moving[2 * nodes + node]};
    out_of(turn, d, d);
    out_of(turn, rate, v);
    for (int64_t k = 0; k < m->turns.n[0]; k++) {
      double column[3];
      cross(motion_of(o, m->turns.at[k]), d, column);
      for (int i = 0; i < 3; i++) {
        row_of(o, AT(m->rows, i, node))[m->turns.at[k]] += column[i];
        v[i] += column[i] * o->f->qvel.at[m->turns.at[k]];
      }
    }
    const double *restrict a = ROW(m->node_shapes, 0) + node * modes, *restrict b = ROW(m->node_shapes, 1) + node * modes;
    const double *restrict c = ROW(m->node_shapes, 2) + node * modes;
    for (int i = 0; i < 3; i++) {
      const int64_t row = AT(m->rows, i, node);
      const double x = turn[3 * i], y = turn[3 * i + 1], z = turn[3 * i + 2];
      double *restrict line = row_of(o, row) + m->first_velocity;
      o->pos[row] += d[i];
      o->vel[row] += v[i];
      for (int64_t k = 0; k < modes; k++) line[k] = x * a[k] + y * b[k] + z * c[k];
    }
  }
}
#endif
