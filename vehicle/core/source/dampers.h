/* Dampers: rows of the viscous force, of the friction, of steeper pieces of a curve; stops; settings of a control.
 *
 * The friction row of a damper is f = -clamp(c (v + h a)): D = c h, aref = -v/h, its limit the friction force: set-valued
 * in effect, sticking is exact. With c = (2/pi) Fd eps it is a line through zero, clamped at the limit Fd: the slope at
 * rest of the published Fd (2/pi) atan(eps v), without its tail (vehicle/model/laws/friction.py).
 * Every steeper piece of the curve of a damper, clamp(e (v - m), e w), is a friction row too (vehicle/model/laws/curve.py).
 * It has no jump, so that it is centred like the viscous one: D = e h/2, aref = -2 (v - m)/h, second order, at any slope.
 * A Jenkins element of presliding friction, t = clamp(t + k dx, L), acts with the mean (t(-h) + 2 t + t(+h))/4: its last
 * term is a friction row with D = k h2/4, aref = -v/h - t/(k h2) and the limit L/4. That is Newmark's average
 * acceleration, which never adds energy: second order, stable at any stiffness.
 */
#ifndef DAMPERS_H
#define DAMPERS_H
#include "now.h"

/* Read the sensors and set the damping coefficients of the present step, once for each time.
 *
 * The sensors measure velocities along the damper, on the wheel side and on the body side, modes included. MuJoCo's
 * velocity is that of the middle of the past step; linear extrapolation of the last two gives the present velocity. A
 * row covers half a step before and half a step after the present, so its coefficient is the mean of the settings in
 * these two halves. This is exact for a setting that is constant between two instants. */
static void control(const Now *o, const Layout *e, State *s) {
  const Controls *p = &e->controls;
  const Modes *m = &e->modes;
  if (p->dampers.n[0] == 0 || o->time == s->last_time.at[0]) return;
  const double *turn = frame_of(o, m->body), *rate = o->f->qvel.at + m->first_velocity;
  for (int64_t row = 0; row < p->shapes.n[0]; row++) {
    double along[3], *sensed = ROW(s->sensed, row);
    into(turn, motion_of(o, e->dampers.dofs.at[p->dampers.at[row / 2]]) + 3, along);
    sensed[1] = sensed[0];
    sensed[0] = 0.0;
    for (int i = 0; i < 3; i++) sensed[0] += along[i] * dot(ROW(p->shapes, row) + i * m->size, rate, m->size);
  }
  for (int64_t entry = 0; entry < p->dofs.n[0]; entry++) {
    const int64_t *of = ROW(p->dofs, entry), n = of[0], end = of[1], dof = of[2], tree = of[3];
    double velocity[3];
    velocity_at(o, dof, tree, ROW(o->f->site_xpos, AT(p->sites, n, end)), velocity);
    AT(s->sensed, 2 * n + end, 0) +=
        o->f->qvel.at[dof] * dot3(motion_of(o, e->dampers.dofs.at[p->dampers.at[n]]) + 3, velocity);
  }
  for (int64_t n = 0; n < p->dampers.n[0]; n++) {
    const double *wheel = ROW(s->sensed, 2 * n), *body = ROW(s->sensed, 2 * n + 1);
    double *past = ROW(s->past, n);
    const double before = past[PRESENT];
    act(p->laws.at + n, (int64_t)s->steps.at[0], 1.5 * body[0] - 0.5 * body[1], 1.5 * wheel[0] - 0.5 * wheel[1], past);
    s->coefficient.at[p->dampers.at[n]] = 0.5 * (before + past[PRESENT]);
  }
  s->steps.at[0] += 1.0;
}

/* Keep the velocities of the dampers by address at the present time and at the last one. */
static void keep_speeds(const Now *o, const Layout *e, State *s) {
  const double last = s->last_time.at[0];
  for (int64_t k = 0; k < e->own.dampers.n[0]; k++) {
    double *speed = ROW(s->speeds, k), now = o->f->qvel.at[e->dampers.dofs.at[e->own.dampers.at[k]]];
    if (o->time != last) speed[1] = last >= 0.0 ? speed[0] : now;
    speed[0] = now;
  }
}

/* Dampers by address, F(x, v) = D v + R(x, v): R is explicit, its slope in the row of the viscous force, centred like
 * it; the slope is that from v to the velocity half a step later, extrapolated from the last step: second order. */
static void own_dampers(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Dampers *p = &e->dampers;
  for (int64_t k = 0; k < e->own.dampers.n[0]; k++) {
    const OwnLaw *law = e->own.laws.at + k;
    const int64_t n = e->own.dampers.at[k], row = p->rows.at[n];
    const double *speed = ROW(s->speeds, k), x = o->f->qpos.at[p->places.at[n]];
    double change = 0.5 * (speed[0] - speed[1]), slope = own_slope(law, x, speed[0], &change);
    s->explicit.at[row] = -own_force(law, x, speed[0]);
    o->D[row] = larger(0.5 * c->timestep * (law->viscous + slope), EMPTY_ROW);
  }
}

/* Advance the Jenkins elements of the dampers over the completed step, with the limits of its rows. */
static void advance_sliders(const Now *o, const Layout *e, State *s) {
  const Presliding *p = &e->presliding;
  const double last = s->last_time.at[0];
  if (o->time == last || p->rows.n[0] == 0) return;
  double *force = ROW(s->slider, 0), *past = ROW(s->slider, 1);
  for (int64_t k = 0; k < p->rows.n[0]; k++) {
    const int64_t n = p->dampers.at[k];
    const double moved = o->f->qpos.at[e->dampers.places.at[n]] - s->stroke.at[n];
    past[k] = force[k];
    if (last >= 0.0) force[k] = jenkins(force[k], p->stiffness.at[k], moved, p->share.at[k] * s->limit.at[n]);
  }
  for (int64_t n = 0; n < s->stroke.n[0]; n++) s->stroke.at[n] = o->f->qpos.at[e->dampers.places.at[n]];
}

/* Force of the bushings of a rod across its slide [N]; after elements. */
static double side_force(int64_t damper, const Now *o, const Layout *e, const State *s) {
  const Bushings *b = &e->bushings;
  const SideForces *p = &e->sides;
  double total[3] = {0.0, 0.0, 0.0};
  for (int64_t k = 0; k < p->dampers.n[0]; k++) {
    if (p->dampers.at[k] != damper) continue;
    const int64_t n = p->elements.at[k];
    const double *explicit = s->explicit.at + AT(b->rows, n, 0);
    double f[3] = {explicit[0], explicit[1], explicit[2]};
    if (p->oblique.at[k] >= 0) {
      into(ROW(b->directions, p->oblique.at[k]), f, f);
      out_of(frame_of(o, b->carriers.at[n]), f, f);
    }
    for (int i = 0; i < 3; i++) total[i] += p->signs.at[k] * f[i];
  }
  /* The axis of a slide is the linear part of its motion. */
  const double along = dot3(total, motion_of(o, e->dampers.dofs.at[damper]) + 3);
  return root(larger(dot3(total, total) - along * along, 0.0));
}

/* Rows of the viscous force, of the friction and of the steeper pieces. */
static void dampers(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Dampers *p = &e->dampers;
  const double h = c->timestep;
  for (int64_t n = 0; n < p->rows.n[0]; n++) {
    const DamperLaw *law = p->laws.at + n;
    const int64_t row = p->frictions.at[n];
    const double sliding = o->f->qvel.at[p->dofs.at[n]];
    double limit = friction_limit(law, sliding);
    if (law->side_force > 0.0) limit += law->side_force * side_force(n, o, e, s);
    o->D[p->rows.at[n]] = c->damper_impedance.at[n];
    o->aref[p->rows.at[n]] = 0.0;
    o->D[row] = larger(EMPTY_ROW, slope_at_rest(limit, law->smoothing) * h); /* in this order NaN stays NaN */
    o->aref[row] = -sliding / h;
    o->loss[row] = s->limit.at[n] = limit;
  }
  for (int64_t k = 0; k < e->controls.dampers.n[0]; k++) {
    const int64_t n = e->controls.dampers.at[k];
    /* The viscous row with the present coefficient in place of D. */
    o->D[p->rows.at[n]] = larger(0.5 * h * s->coefficient.at[n], EMPTY_ROW);
  }
  own_dampers(o, e, c, s);
  for (int64_t n = 0; n < p->valves.n[0]; n++) {
    const int64_t row = AT(p->valves, n, 0), damper = AT(p->valves, n, 1);
    o->D[row] = c->valve_impedance.at[n];
    o->aref[row] = -2.0 * (o->f->qvel.at[p->dofs.at[damper]] - AT(p->pieces, n, 1)) / h;
    o->loss[row] = AT(p->pieces, n, 2);
  }
  const Presliding *j = &e->presliding;
  for (int64_t k = 0; k < j->rows.n[0]; k++) {
    const int64_t row = j->rows.at[k], n = j->dampers.at[k];
    const double stiffness = j->stiffness.at[k], force = AT(s->slider, 0, k);
    o->D[row] = 0.25 * stiffness * h * h;
    o->aref[row] = -(o->f->qvel.at[p->dofs.at[n]] + force / (stiffness * h)) / h;
    o->loss[row] = 0.25 * j->share.at[k] * s->limit.at[n];
    s->explicit.at[row] = -0.25 * (AT(s->slider, 1, k) + 2.0 * force);
  }
}

/* Add the forces of bump stops and decoupler seats, of dampers by address, and the known part of the Jenkins elements;
 * after generalised_forces. */
static void joint_forces(const Now *o, const Layout *e, State *s) {
  const Tables *t = &e->tables;
  for (int64_t k = 0; k < t->kinds.n[0]; k++) {
    if (t->kinds.at[k] < 2) continue;
    const int64_t n = t->elements.at[k], stop = t->kinds.at[k] == 2;
    const int64_t dof = stop ? e->dampers.dofs.at[n] : e->fluids.dofs.at[n];
    s->stretch.at[k] = o->f->qpos.at[stop ? e->dampers.places.at[n] : e->fluids.places.at[n]];
    o->f->qfrc_applied.at[dof] -=
        curve_force(s->stretch.at[k], ROW(t->edges, k), ROW(t->slopes, k), ROW(t->offsets, k));
  }
  for (int64_t k = 0; k < e->own.dampers.n[0]; k++)
    o->f->qfrc_applied.at[e->dampers.dofs.at[e->own.dampers.at[k]]] +=
        s->explicit.at[e->dampers.rows.at[e->own.dampers.at[k]]];
  const Presliding *p = &e->presliding;
  for (int64_t k = 0; k < p->rows.n[0]; k++)
    o->f->qfrc_applied.at[e->dampers.dofs.at[p->dampers.at[k]]] += s->explicit.at[p->rows.at[k]];
}

/* Force -c v - F0 [N] of a damper, whose friction is a row; c is its coefficient at the velocity v. */
static double damper_force(int64_t n, const Fields *f, const Layout *e, const State *s) {
  return -s->coefficient.at[n] * f->actuator_velocity.at[n] - e->dampers.laws.at[n].shift;
}
#endif
