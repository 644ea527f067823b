/* Bushings, tyres, springs and rotations as constraint rows, written before MuJoCo solves.
 *
 * The force of a quadratic row of MuJoCo is f = D (aref - J a). The callback rewrites each row of an element so that,
 * with the explicit part f0 given to the generalised forces,
 *
 *     f = f0 - D J a,    f0 = preload - K r - B r' - f2,    D = B h/2 + beta K h2 + branch,
 *
 * r' being the rate at the middle of the past step: B (r' + h a/2) is the damping at the present time (centred, second
 * order), and beta = 1/12 makes the step of a linear system fourth order in its frequencies (Fox and Goodwin, Numerov);
 * stiff local springs take up to beta = 1/4, which is stable at any step (Newmark; see step_weights.py).
 * The two forces of a bushing are opposite and act at the points of their parts, in the axes of the carrier; the moment
 * r x f of their distance r is neglected, which changes no frequency by more than 0.05 %.
 *
 * The line of a main spring goes through the displaced seat: n = (x_up + d - x_low) / length, r = length - L0,
 * J = n' (J_up + R Phi - [d]x - J_low). Without d in n, the transverse stiffness F / length of a loaded spring would
 * not act on the modes.
 */
#ifndef ROWS_H
#define ROWS_H
#include "now.h"

/* Difference of a curve from the tangent at its operating point, F(at + x) - F(at) - K x [N]. */
static double bent(int64_t k, double displacement, double stiffness, const Tables *t, State *s) {
  const double *edges = ROW(t->edges, k), *slopes = ROW(t->slopes, k), *offsets = ROW(t->offsets, k);
  s->stretch.at[k] = t->at.at[k] + displacement;
  double force = curve_force(s->stretch.at[k], edges, slopes, offsets);
  return force - curve_force(t->at.at[k], edges, slopes, offsets) - stiffness * displacement;
}

/* Rotate the rows of oblique elements from world axes into their directions: P R' (J, r, r'). */
static void oblique_rows(const Now *o, const Layout *e) {
  const Bushings *b = &e->bushings;
  for (int64_t k = 0; k < b->oblique.n[0]; k++) {
    const int64_t n = b->oblique.at[k], row = AT(b->rows, n, 0);
    const double *frame = frame_of(o, b->carriers.at[n]), *way = ROW(b->directions, k);
    double turn[9];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) turn[3 * i + j] = dot3(way + 3 * i, frame + 3 * j);
    double *restrict x = row_of(o, row), *restrict y = x + o->width, *restrict z = y + o->width;
    for (int64_t i = 0; i < o->width; i++) {
      const double u = x[i], v = y[i], w = z[i];
      x[i] = turn[0] * u + turn[1] * v + turn[2] * w;
      y[i] = turn[3] * u + turn[4] * v + turn[5] * w;
      z[i] = turn[6] * u + turn[7] * v + turn[8] * w;
    }
    out_of(turn, o->pos + row, o->pos + row);
    out_of(turn, o->vel + row, o->vel + row);
  }
}

/* Add the displacements of the fluids to the rows of their hydromounts; after oblique_rows.
 *
 * The upper chamber with the bulge stiffness Kb is between the displaced volume, the extension z of the mount along its
 * z axis, and the volume in the track. Divided by the pumping area Ap of the rubber, the latter is the displacement x of
 * the coordinate of the fluid, with the mass mt = rho L Ap^2/At of a track of length L and area At:
 *
 *     f = -Kb (z - x),    mt x'' + ct x' = Kb (z - x),    K(s) = Kb Z / (Kb + Z),    Z = mt s^2 + ct s.
 *
 * x is relative to the mount, so no other motion accelerates mt, and mt has no weight. The rows of the fluid are those of
 * its mount with x subtracted, r -> r + n x e_z and J_x = n e_z with n = -1, e_z being the z axis of the law. Behind a
 * flexible attachment the rubber has x too (vehicle/model/assembly/connections.py).
 *
 * A decoupler with the coordinate y has the same pressure and is parallel to the track: z - x - y in place of z - x, and
 * md y'' + cd y' + Km y + seat(y) = Kb (z - x - y). Within its gap it takes the fluid from the track; beyond the gap it
 * lies on its seat, and the fluid goes through the track.
 *
 * Source: Singh, Kim and Ravindra, Linear analysis of automotive hydro-mechanical mount with emphasis on decoupler
 * characteristics, Journal of Sound and Vibration 158 (1992) 219-243, with p1 = Kb (z - x) / Ap and C1 = Ap^2 / Kb; the
 * lower chamber is soft. */
static void fluid_rows(const Now *o, const Layout *e) {
  const Bushings *b = &e->bushings;
  for (int64_t k = 0; k < e->fluids.elements.n[0]; k++) {
    const int64_t n = e->fluids.elements.at[k], dof = e->fluids.dofs.at[k];
    const double *frame = frame_of(o, b->carriers.at[n]);
    int oblique = 0;
    for (int64_t i = 0; i < b->oblique.n[0]; i++) oblique |= b->oblique.at[i] == n;
    for (int i = 0; i < 3; i++) {
      const int64_t row = AT(b->rows, n, i);
      const double axis = oblique ? (i == 2 ? 1.0 : 0.0) : frame[3 * i + 2], along = e->fluids.factors.at[k] * axis;
      row_of(o, row)[dof] = along;
      o->pos[row] += along * o->f->qpos.at[e->fluids.places.at[k]];
      o->vel[row] += along * o->f->qvel.at[dof];
    }
  }
}

/* Residual and rate of every element in element axes, relative to the velocity of the plates. */
static void local_axes(const Now *o, const Layout *e, State *s) {
  const Bushings *b = &e->bushings;
  for (int64_t n = 0; n < b->rows.n[0]; n++)
    for (int i = 0; i < 3; i++) AT(s->force, n, i) = o->vel[AT(b->rows, n, i)];
  for (int64_t tyre = 0; tyre < e->tyres.n[0]; tyre++)
    for (int i = 0; i < 3; i++) AT(s->force, e->tyres.at[tyre], i) -= AT(s->plate_velocity, tyre, i);
  for (int64_t n = 0; n < b->rows.n[0]; n++) {
    const double *frame = frame_of(o, b->carriers.at[n]);
    into(frame, o->pos + AT(b->rows, n, 0), ROW(s->residual, n));
    into(frame, ROW(s->force, n), ROW(s->rate, n));
  }
  for (int64_t k = 0; k < b->oblique.n[0]; k++) {
    const int64_t n = b->oblique.at[k];
    for (int i = 0; i < 3; i++) {
      AT(s->residual, n, i) = o->pos[AT(b->rows, n, i)];
      AT(s->rate, n, i) = o->vel[AT(b->rows, n, i)];
    }
  }
}

/* Advance the Maxwell branches over the completed step. */
static void advance_branches(const Now *o, const Weights *c, State *s) {
  const double last = s->last_time.at[0];
  if (o->time == last) return;
  for (int64_t i = 0; i < 3 * s->rate.n[0]; i++) {
    const double rate = s->rate.at[i];
    if (last >= 0.0) {
      const double acceleration = (rate - s->last_rate.at[i]) / c->timestep;
      s->branch_force.at[i] = s->branch_past.at[i] + c->slope.at[i] * acceleration;
      s->branch_past.at[i] = c->decay.at[i] * s->branch_force.at[i] + c->gain.at[i] * rate;
    }
    s->last_rate.at[i] = rate;
  }
  s->last_time.at[0] = o->time;
}

/* Rubber friction: Jenkins elements over the displacement of an axis (vehicle/model/laws/amplitude.py).
 *
 * The force t of an element follows from the displacement r at the present time, so it is explicit. Its stiffness k is
 * in the stiffness K of the row: f0 contains -K r - (t - k r). A vibration below the limits is integrated like that of a
 * spring K; beyond them t - k r enters a step like a table over displacement, with second order.
 *
 * Advance from the state at the last time; after local_axes. An evaluation at the same time replaces the last one. */
static void advance_rubber(const Now *o, const Layout *e, State *s) {
  const RubberFriction *r = &e->rubber;
  double *force = ROW(s->rubber, 0), *stretch = ROW(s->rubber, 1);
  double *past_force = ROW(s->rubber, 2), *past_stretch = ROW(s->rubber, 3);
  for (int64_t k = 0; k < r->elements.n[0]; k++) {
    if (o->time != s->last_time.at[0] && s->last_time.at[0] >= 0.0) {
      past_force[k] = force[k];
      past_stretch[k] = stretch[k];
    }
    stretch[k] = AT(s->residual, r->elements.at[k], r->axes.at[k]);
    force[k] = jenkins(past_force[k], r->stiffness.at[k], stretch[k] - past_stretch[k], r->limit.at[k]);
  }
}

/* Limit one-sided contacts to max(0, f0 - D J a) along z: clear a row that would pull at the last J a.
 *
 * The force is continuous, so a row in the wrong state for a step changes a velocity by h2 at most: second order.
 * Carriers are the ground and the plates, which do not rotate: rows are along element axes. */
static void lift_off(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Bushings *b = &e->bushings;
  for (int64_t k = 0; k < b->one_sided.n[0]; k++) {
    const int64_t n = b->one_sided.at[k], row = AT(b->rows, n, 2);
    const double rate = AT(s->rate, n, 2), acceleration = (rate - AT(s->contact, 1, k)) / c->timestep;
    if (AT(s->force, n, 2) - AT(c->impedance, n, 2) * acceleration <= 0.0) {
      s->explicit.at[row] = 0.0;
      o->D[row] = EMPTY_ROW;
    }
    AT(s->contact, 1, k) = rate;
  }
}

/* Write f0 = preload - K r - B r' - f2, and impedance and reference of the rows.
 *
 * The explicit part of the branch force is f2 + beta (f2(+h) - 2 f2 + f2(-h)) without the share of the acceleration. */
static void elements(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Bushings *b = &e->bushings;
  const Tables *t = &e->tables;
  for (int64_t n = 0; n < b->rows.n[0]; n++)
    for (int i = 0; i < 3; i++) {
      const double rate = AT(s->rate, n, i), past = AT(s->branch_past, n, i);
      /* f2(+h) - 2 f2 + f2(-h), with f2(+h) = E p + g v, f2 = p and f2(-h) of the completed step. */
      const double curvature = (AT(c->decay, n, i) - 2.0) * past + AT(c->gain, n, i) * rate + AT(s->branch_force, n, i);
      const double branch = past + AT(c->average, n, i) * curvature;
      const double elastic = AT(b->stiffness, n, i) * AT(s->residual, n, i);
      AT(s->force, n, i) = c->preload.at[AT(b->rows, n, i)] - elastic - AT(b->damping, n, i) * rate - branch;
    }
  for (int64_t k = 0; k < t->kinds.n[0]; k++)
    if (t->kinds.at[k] == 0) {
      const int64_t n = t->elements.at[k], i = t->axes.at[k];
      AT(s->force, n, i) -= bent(k, AT(s->residual, n, i), AT(b->stiffness, n, i), t, s);
    }
  for (int64_t k = 0; k < e->rubber.elements.n[0]; k++)
    AT(s->force, e->rubber.elements.at[k], e->rubber.axes.at[k]) -=
        AT(s->rubber, 0, k) - e->rubber.stiffness.at[k] * AT(s->rubber, 1, k);
  for (int64_t k = 0; k < b->one_sided.n[0]; k++) {
    const int64_t n = b->one_sided.at[k];
    AT(s->contact, 0, k) = larger(0.0, AT(s->force, n, 2) + AT(b->damping, n, 2) * AT(s->rate, n, 2));
  }
  for (int64_t tyre = 0; tyre < e->tyres.n[0]; tyre++)
    for (int i = 0; i < 3; i++)
      AT(s->force, e->tyres.at[tyre], i) += AT(c->inertial, tyre, i) * AT(s->plate_acceleration, tyre, i);
  for (int64_t n = 0; n < b->rows.n[0]; n++) {
    const int64_t row = AT(b->rows, n, 0);
    out_of(frame_of(o, b->carriers.at[n]), ROW(s->force, n), s->explicit.at + row);
    for (int i = 0; i < 3; i++) {
      o->D[row + i] = AT(c->impedance, n, i);
      o->aref[row + i] = 0.0;
    }
  }
  for (int64_t k = 0; k < b->oblique.n[0]; k++)
    for (int i = 0; i < 3; i++)
      s->explicit.at[AT(b->rows, b->oblique.at[k], i)] = AT(s->force, b->oblique.at[k], i);
  lift_off(o, e, c, s);
}

/* Main springs: direction through the displaced seat, its derivatives, elastic force. */
static void springs(const Now *o, const Layout *e, const Weights *c, State *s) {
  const Springs *p = &e->springs;
  const Modes *m = &e->modes;
  const double *turn = frame_of(o, m->body), *q = o->f->qpos.at + m->first_position;
  for (int64_t n = 0; n < p->rows.n[0]; n++) {
    const int64_t row = p->rows.at[n];
    const double *shape = ROW(p->shapes, n);
    double *low = ROW(s->ends, 2 * n), *up = ROW(s->ends, 2 * n + 1), *line = ROW(s->line, n), *J = row_of(o, row);
    double moved[3];
    for (int i = 0; i < 3; i++) moved[i] = dot(shape + i * m->size, q, m->size);
    out_of(turn, moved, moved);
    for (int i = 0; i < 3; i++) {
      low[i] = AT(o->f->site_xpos, AT(p->sites, n, 0), i);
      up[i] = AT(o->f->site_xpos, AT(p->sites, n, 1), i) + moved[i];
      line[i] = up[i] - low[i];
    }
    const double length = root(dot3(line, line)), stretch = length - p->lengths.at[n];
    for (int i = 0; i < 3; i++) line[i] /= length;
    for (int64_t i = 0; i < o->width; i++) J[i] = 0.0;
    double along[3];
    into(turn, line, along);
    for (int i = 0; i < 3; i++)
      for (int64_t k = 0; k < m->size; k++) J[m->first_velocity + k] += along[i] * shape[i * m->size + k];
    s->explicit.at[row] = c->preload.at[row] - p->stiffness.at[n] * stretch;
    for (int64_t k = 0; k < e->tables.kinds.n[0]; k++)
      if (e->tables.kinds.at[k] == 1 && e->tables.elements.at[k] == n)
        s->explicit.at[row] -= bent(k, stretch, p->stiffness.at[n], &e->tables, s);
    o->D[row] = c->spring_impedance.at[n];
    o->aref[row] = 0.0;
  }
  for (int64_t entry = 0; entry < p->dofs.n[0]; entry++) {
    const int64_t *of = ROW(p->dofs, entry), n = of[0], end = of[1], dof = of[2], tree = of[3];
    double velocity[3];
    velocity_at(o, dof, tree, ROW(s->ends, 2 * n + end), velocity);
    row_of(o, p->rows.at[n])[dof] += (double)(2 * end - 1) * dot3(ROW(s->line, n), velocity);
  }
}

/* Reference of ideal ball joints by MuJoCo's formula, from residuals that include the modes. */
static void ideal_joints(const Now *o, const Layout *e, const Weights *c, State *s) {
  for (int64_t i = 0; i < 3 * e->joints.n[0]; i++) {
    const int64_t row = e->joints.at[i];
    const double *k = o->KBIP + 4 * row;
    s->explicit.at[row] = c->preload.at[row];
    o->aref[row] = -k[1] * o->vel[row] - k[0] * k[2] * o->pos[row];
  }
}

/* Round tyres at rest: the vertical force acts on the lowest point of the tread, horizontal forces on the patch.
 *
 * A wheel that stands on a plate with its axle fixed to the hub carries the patch with it. If the hub pitches by theta, a
 * patch fixed to the wheel moves along x by R theta, and the vertical force F would turn the hub on: a stiffness of -F R
 * about the axle, which takes a fifth off the wheel rate of a trailing arm. A round tread does not do so: its height over
 * the plate depends on the wheel centre c and the axle e alone. The vertical row of the tyre becomes that of the point
 * below the centre, c - R d with d the component of the vertical normal to e,
 *
 *     z -> z + R (d_wheel z - d z),   J_z -> J_z + (w x (c - R d - p))_z,
 *
 * with the point p = c - R d_wheel of the wheel. Rows along x and y and the rotational stiffness stay with the wheel: the
 * tread sticks to the plate. `lowest` is R (d_wheel - d), the frame of the hub being given. */
static void lowest(const double *frame, double radius, double *r) {
  const double level = root(1.0 - frame[7] * frame[7]);
  r[0] = radius * (frame[2] + frame[7] * frame[1] / level);
  r[1] = radius * (frame[5] + frame[7] * frame[4] / level);
  r[2] = radius * (frame[8] - level);
}

static void round_rows(const Now *o, const Layout *e) {
  const RoundTyres *t = &e->round;
  double arm[3], change[3];
  for (int64_t entry = 0; entry < t->dofs.n[0]; entry++) {
    const int64_t n = AT(t->dofs, entry, 0), dof = AT(t->dofs, entry, 1), row = AT(e->bushings.rows, t->tyres.at[n], 2);
    lowest(frame_of(o, t->hubs.at[n]), t->radii.at[n], arm);
    cross(motion_of(o, dof), arm, change);
    row_of(o, row)[dof] += change[2];
    o->vel[row] += change[2] * o->f->qvel.at[dof];
  }
  for (int64_t n = 0; n < t->tyres.n[0]; n++) {
    lowest(frame_of(o, t->hubs.at[n]), t->radii.at[n], arm);
    o->pos[AT(e->bushings.rows, t->tyres.at[n], 2)] += arm[2];
  }
}

/* R = 1 / D, and the generalised force J' f0 of the explicit forces, with S' (-k (q - q_0) - b q') of the modes. */
static void generalised_forces(const Now *o, const Layout *e, State *s) {
  double *restrict total = o->f->qfrc_applied.at;
  for (int64_t i = 0; i < o->rows; i++) o->R[i] = 1.0 / o->D[i];
  for (int64_t i = 0; i < e->velocity_count; i++) total[i] = 0.0;
  for (int64_t k = 0; k < e->reach.n[0]; k++) {
    const int64_t *of = ROW(e->reach, k), first = of[2], last = of[3];
    const double *restrict f = s->explicit.at + of[0], *restrict x = row_of(o, of[0]);
    if (of[1] == 3) {
      const double *restrict y = x + o->width, *restrict z = y + o->width;
      for (int64_t i = first; i < last; i++) total[i] += f[0] * x[i] + f[1] * y[i] + f[2] * z[i];
    } else {
      for (int64_t i = first; i < last; i++) total[i] += f[0] * x[i];
    }
  }
  for (int64_t i = 0; i < s->modal_force.n[0]; i++) total[e->modes.first_velocity + i] += s->modal_force.at[i];
}
#endif
