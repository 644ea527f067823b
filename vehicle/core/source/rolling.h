/* Rolling tyres: contact point on the road, slip, and explicit forces without a constraint row.
 *
 * The wheel turns at -V/R + theta' about its axle e, the car driving along -x; theta is a coordinate of the model, the
 * steady part is not. The lowest point of the tread is at r = -a_y e - R d from the centre c, with d the component of
 * the vertical normal to e. It is a point of the wheel, so its velocity has the column e x r of the spin; pitch of the
 * hub about e leaves it at rest. The rows of a tyre at the point of the hub become those of this point,
 *
 *     J -> J + w x (c + r - p_hub),   J_spin = e x r,
 *
 * and their branches along x and y represent the slip (docs/theory/rolling-tyre.md). The input of the branch along y is
 * v_y + V psi, psi being the heading of the axle, in the middle of the past step. The known part of
 *
 * - the slope of the road, F_z tan(beta) along x at the wheel centre, with the present load; tan(beta) is that of the
 *   cams of the tyre, or w'/V;
 * - the aligning moment, trail times side force, on the hub;
 * - the turn of a steady brake, drive or side force (X, Y) with the heading, psi (-Y, X);
 * - the gyroscopic moment -omega x (H e) on the hub, H = -I V/R, carried to the present by the last two velocities;
 * - the course control on the body: along x, along y at the front axle, where a driver steers, and in yaw,
 *
 * acts explicitly on the coordinates, as `push`. Source: Pacejka, Tire and Vehicle Dynamics, 3rd ed., chapters 7 to 9.
 */
#ifndef ROLLING_H
#define ROLLING_H
#include <math.h>
#include "rows.h"

/* Move rows, residuals and rates of the rolling tyres to the lowest point of the tread. */
static void rolling_rows(const Now *o, const Layout *e) {
  const Rolling *r = &e->rolling;
  double arm[3], change[3];
  for (int64_t entry = 0; entry < r->dofs.n[0]; entry++) {
    const int64_t n = AT(r->dofs, entry, 0), dof = AT(r->dofs, entry, 1), row = AT(e->bushings.rows, r->tyres.at[n], 0);
    lowest(frame_of(o, r->hubs.at[n]), AT(r->arms, n, 2), arm);
    cross(motion_of(o, dof), arm, change);
    for (int i = 0; i < 3; i++) {
      row_of(o, row + i)[dof] += change[i];
      o->vel[row + i] += change[i] * o->f->qvel.at[dof];
    }
  }
  for (int64_t n = 0; n < r->tyres.n[0]; n++) {
    const double *frame = frame_of(o, r->hubs.at[n]), radius = AT(r->arms, n, 2);
    const int64_t row = AT(e->bushings.rows, r->tyres.at[n], 0), spin = r->spins.at[n];
    const double level = root(1.0 - frame[7] * frame[7]);
    /* e x r = -R e x d, which is level. */
    const double column[3] = {-radius * frame[4] / level, radius * frame[1] / level, 0.0};
    lowest(frame, radius, arm);
    for (int i = 0; i < 3; i++) {
      o->pos[row + i] += arm[i];
      row_of(o, row + i)[spin] = column[i];
      o->vel[row + i] += column[i] * o->f->qvel.at[spin];
    }
  }
}

/* Update heading and angular velocity of the hubs once for each time, and add the heading to the side slip.
 *
 * Headings count from those at rest, where each wheel points as its static side force needs.
 * At t = 0, where the car is linearised, the side slip has no heading. */
static void headings(const Now *o, const Layout *e, State *s) {
  const Rolling *r = &e->rolling;
  if (r->tyres.n[0] == 0) return;
  double *present = ROW(s->heading, 0), *past = ROW(s->heading, 1);
  if (o->time != s->last_time.at[0]) {
    for (int64_t n = 0; n < r->tyres.n[0]; n++) {
      const double *frame = frame_of(o, r->hubs.at[n]);
      double *turning = ROW(s->turning, n);
      past[n] = present[n];
      present[n] = atan2(-frame[1], frame[4]) - r->rest.at[2 + n];
      for (int i = 0; i < 3; i++) {
        turning[3 + i] = turning[i];
        turning[i] = 0.0;
      }
    }
    for (int64_t entry = 0; entry < r->dofs.n[0]; entry++) {
      const int64_t n = AT(r->dofs, entry, 0), dof = AT(r->dofs, entry, 1);
      for (int i = 0; i < 3; i++) AT(s->turning, n, i) += motion_of(o, dof)[i] * o->f->qvel.at[dof];
    }
  }
  if (o->time > 0.0)
    for (int64_t n = 0; n < r->tyres.n[0]; n++)
      AT(s->rate, r->tyres.at[n], 1) += r->speeds.at[n] * 0.5 * (present[n] + past[n]);
}

/* Course control of the body. */
static void hold_course(const Now *o, const Layout *e, double *push) {
  const Rolling *r = &e->rolling;
  if (r->course.n[0] == 0) return;
  const int64_t x = r->course.at[0], y = r->course.at[1], yaw = r->course.at[2];
  const double *frame = frame_of(o, e->modes.body), *hold = r->hold.at, *rate = o->f->qvel.at, ahead = hold[6];
  const double angle = atan2(frame[3], frame[0]);
  const double along = o->f->qpos.at[r->course.at[3]] - r->rest.at[0];
  const double across = o->f->qpos.at[r->course.at[4]] - r->rest.at[1] + ahead * angle;
  const double side = hold[1] * across + hold[4] * (rate[y] + ahead * rate[yaw]);
  push[x] -= hold[0] * along + hold[3] * rate[x];
  push[y] -= side;
  push[yaw] -= hold[2] * angle + hold[5] * rate[yaw] + ahead * side;
}

/* Add road slope, aligning and gyroscopic moments on the hubs, and the course control to `push`.
 *
 * The static horizontal tyre forces, mN from SLIDING_SHARE of the trim, act on the hub and rotate no wheel. */
static void rolling_forces(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Rolling *r = &e->rolling;
  double *push = s->push.at;
  for (int64_t n = 0; n < r->tyres.n[0]; n++) {
    const int64_t tyre = r->tyres.at[n], row = AT(e->bushings.rows, tyre, 0), spin = r->spins.at[n];
    const double *frame = frame_of(o, r->hubs.at[n]), *turning = ROW(s->turning, n);
    const double axle[3] = {frame[1], frame[4], frame[7]};
    double *load = ROW(s->slope, n), omega[3];
    push[spin] = -c->preload.at[row] * row_of(o, row)[spin] - c->preload.at[row + 1] * row_of(o, row + 1)[spin];
    load[0] = larger(0.0, AT(s->force, tyre, 2)) * s->slope_velocity.at[r->plates.at[n]] / r->speeds.at[n];
    /* -omega x (H e) = H e x omega */
    const double momentum = -r->inertias.at[n] * r->speeds.at[n] / AT(r->arms, n, 2);
    for (int i = 0; i < 3; i++) omega[i] = 1.5 * turning[i] - 0.5 * turning[3 + i];
    cross(axle, omega, load + 1);
    for (int i = 1; i < 4; i++) load[i] *= momentum;
    load[3] -= r->trails.at[n] * AT(s->branch_past, tyre, 1);
  }
  for (int64_t entry = 0; entry < r->dofs.n[0]; entry++) {
    const int64_t n = AT(r->dofs, entry, 0), dof = AT(r->dofs, entry, 1), tree = AT(r->dofs, entry, 2);
    const double *load = ROW(s->slope, n), *site = ROW(o->f->site_xpos, r->sites.at[n]);
    double point[3], velocity[3];
    out_of(frame_of(o, r->hubs.at[n]), ROW(r->arms, n), point);
    for (int i = 0; i < 3; i++) point[i] += site[i];
    velocity_at(o, dof, tree, point, velocity);
    push[dof] += load[0] * velocity[0] + dot3(load + 1, motion_of(o, dof));
    /* (X, Y) of a car in steady acceleration, after the place and the headings at rest. */
    const double *steady = r->rest.at + 2 + r->tyres.n[0] + 2 * n;
    if (steady[0] != 0.0 || steady[1] != 0.0) {
      const int64_t row = AT(e->bushings.rows, r->tyres.at[n], 0);
      const double turned = steady[0] * row_of(o, row + 1)[dof] - steady[1] * row_of(o, row)[dof];
      push[dof] += AT(s->heading, 0, n) * turned;
    }
  }
  hold_course(o, e, push);
}
#endif
