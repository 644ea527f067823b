/* Plate motion before a step of MuJoCo, the step, and a sample after it. */
#ifndef STEPPING_H
#define STEPPING_H
#include "modes.h"

typedef void Step(const void *model, void *data); /* mj_step, by its address */

static void copy(double *to, const double *from, int64_t count) {
  for (int64_t i = 0; i < count; i++) to[i] = from[i];
}

/* Plate heights of a step, the plate motion of the tyre rows, and the applied forces.
 *
 * A rolling tyre whose rolling radius varies has a tread with a velocity u along x: that of a road that moves by -u. */
static void move_plates(int64_t step, const Plates *p) {
  for (int64_t plate = 0; plate < p->mocap.n[0]; plate++) {
    AT(p->mocap_position, p->mocap.at[plate], 2) = AT(p->height, step, plate);
    AT(p->row_velocity, plate, 2) = AT(p->velocity, step, plate);
    AT(p->row_acceleration, plate, 2) = AT(p->acceleration, step, plate);
    p->row_slope.at[plate] = AT(p->slope, step, plate);
  }
  for (int64_t plate = 0; plate < p->tread.n[1]; plate++) {
    AT(p->row_velocity, plate, 0) = -AT(p->tread, step, plate);
    AT(p->row_acceleration, plate, 0) = -AT(p->tread_change, step, plate);
  }
  copy(p->applied.at, ROW(p->force, step), p->force.n[1]);
}

/* MuJoCo's velocity is that of the middle of a step; `half` times the acceleration extrapolates to the present. */
static inline double speed(const Sources *s, int64_t dof, double half) {
  return s->velocity.at[dof] + half * s->acceleration.at[dof];
}

/* Modal coordinates of the last evaluation, and their velocities half a step later. */
static void keep_modes(int64_t row, const Order *order, const Sources *s, const Samples *b) {
  const double *q = ROW(s->modal, 0), *rate = ROW(s->modal, 1);
  const double *acceleration = s->acceleration.at + order->first_velocity;
  double *pull = b->modal_pull.at;
  /* eta'' - S' (-k q - b q'), which the attachments add to q''. */
  for (int64_t j = 0; j < b->modal_pull.n[0]; j++) pull[j] = acceleration[j] - s->modal_force.at[j];
  for (int64_t k = 0; k < s->modal.n[1]; k++) {
    const double faster = b->modal_pull.n[0] ? modal_acceleration(k, q, rate, pull, &s->space) : acceleration[k];
    AT(b->modal_position, row, k) = q[k];
    AT(b->modal_velocity, row, k) = rate[k] - order->half * faster;
  }
}

/* Forces, rates and positions of the present time. */
static void keep_sample(int64_t row, double half, const Loop *loop) {
  const Order *order = &loop->order;
  const Sources *s = &loop->sources;
  const Samples *b = &loop->samples;
  const double *solved = FIELD_AT(const double *const, (intptr_t)order->data, order->force_offset);
  for (int64_t k = 0; k < s->sites.n[0]; k++)
    copy(ROW(b->places, row) + 3 * k, ROW(s->site_positions, s->sites.at[k]), 3);
  copy(ROW(b->turn, row), ROW(s->orientation, order->body), b->turn.n[1]);
  keep_modes(row, order, s, b);
  for (int64_t k = 0; k < s->dampers.n[0]; k++) AT(b->damper_velocity, row, k) = speed(s, s->dampers.at[k], half);
  copy(ROW(b->coefficient, row), s->coefficient.at, b->coefficient.n[1]);
  copy(ROW(b->actuator, row), s->actuator.at, b->actuator.n[1]);
  copy(ROW(b->solved, row), solved, b->solved.n[1]);
  copy(ROW(b->explicit, row), s->explicit.at, b->explicit.n[1]);
  const int64_t size = b->rate.n[1] * b->rate.n[2];
  copy(b->rate.at + row * size, s->rate.at, size);
  copy(b->branch.at + row * size, s->branch.at, size);
  copy(ROW(b->contact, row), s->contact.at, b->contact.n[1]);
  copy(ROW(b->rubber, row), s->rubber.at, b->rubber.n[1]);
  copy(ROW(b->heading, row), s->heading.at, b->heading.n[1]);
  b->pushed.at[row] = 0.0;
  for (int64_t dof = 0; dof < s->push.n[0]; dof++) b->pushed.at[row] += s->push.at[dof] * speed(s, dof, half);
  for (int64_t k = 0; k < s->spring_rates.n[0]; k++)
    AT(b->spring_rates, row, k) = speed(s, s->spring_rates.at[k], half);
  for (int64_t k = 0; k < s->load_bodies.n[0]; k++) {
    double *frame = ROW(b->load_frames, row) + 12 * k;
    copy(frame, ROW(s->origins, s->load_bodies.at[k]), 3);
    copy(frame + 3, ROW(s->orientation, s->load_bodies.at[k]), 9);
  }
  for (int64_t k = 0; k < s->load_springs.n[0]; k++) { /* after a step, half < 0, positions are those of its end */
    const int64_t dof = AT(s->load_springs, k, 1);
    const double since = half < 0.0 ? 2.0 * half * s->velocity.at[dof] : 0.0;
    AT(b->load_springs, row, 2 * k) = s->position.at[AT(s->load_springs, k, 0)] + since;
    AT(b->load_springs, row, 2 * k + 1) = speed(s, dof, half);
  }
}

/* Take the steps first..last, with samples from `row` on; return the number of stored poses. */
static int64_t advance(const Loop *loop, int64_t first, int64_t last, int64_t row) {
  const Order *order = &loop->order;
  const void *model = (const void *)(intptr_t)order->model;
  Step *step = (Step *)(intptr_t)order->step;
  int64_t posed = 0;
  for (int64_t i = first; i <= last; i++) {
    const int recorded = i % order->every == 0;
    move_plates(i, &loop->plates);
    if (recorded && (i / order->every) % order->pose_every == 0)
      copy(ROW(loop->samples.poses, posed++), loop->sources.position.at, loop->samples.poses.n[1]);
    step(model, (void *)(intptr_t)order->data);
    if (recorded) keep_sample(row++, order->half, loop);
  }
  return posed;
}
#endif
