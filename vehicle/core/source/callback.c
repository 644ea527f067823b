/* Callbacks of MuJoCo, and the stepping loop of a run.
 *
 * mjData.userdata of a simulation has the address of its records and a mark. A callback acts on a state only if the mark
 * and the address of the model match; all others are left alone. Where the two arrays are in MuJoCo's structures is a
 * property of the library in the process, like the callbacks themselves: locate sets it once.
 */
#include <stddef.h>
#include "applied.h"
#include "modes.h"
#include "prediction.h"
#include "rolling.h"
#include "rotations.h"
#include "stepping.h"
#include "vector.h"

#define USER_SIZE 2
#define MARK 20411.0625 /* userdata[1] of a state with records */

static struct {
  int64_t user_size, user_data; /* byte offsets of nuserdata in mjModel and of userdata in mjData */
} located;

EXPORT void NAME(locate)(int64_t user_size, int64_t user_data) {
  located.user_size = user_size;
  located.user_data = user_data;
}

/* Records of a simulation; NULL for a model without them. */
static Simulation *records_of(const void *model, const void *data) {
  if (FIELD_AT(const int64_t, model, located.user_size) < USER_SIZE) return NULL;
  const double *user = FIELD_AT(const double *const, data, located.user_data);
  if (user[1] != MARK) return NULL;
  Simulation *s = (Simulation *)(intptr_t)user[0];
  return s->ticket.model == (int64_t)(intptr_t)model ? s : NULL;
}

/* Rows of MuJoCo at their present addresses. A dense Jacobian has all columns; of a sparse one, take a copy. */
static Now now_of(Simulation *s, const void *data) {
  const SparseRows *p = &s->ticket.sparse;
  double *of[8]; /* in the order of Efc in step_records.py */
  for (int i = 0; i < 8; i++) of[i] = FIELD_AT(double *const, data, s->ticket.efc.at[i]);
  Now o = {.f = &s->fields, .time = FIELD_AT(const double, data, s->ticket.time), .J = of[0], .KBIP = of[1],
           .pos = of[2], .vel = of[3], .aref = of[4], .D = of[5], .R = of[6], .loss = of[7],
           .rows = s->ticket.rows, .width = s->layout.velocity_count};
  if (p->jacobian.n[0] == 0) return o;
  const double *values = FIELD_AT(const double *const, data, p->offsets.at[4]);
  o.J = p->jacobian.at, o.width = p->jacobian.n[1];
  for (int64_t k = 0; k < p->own.n[0]; k++) o.J[p->own.at[k]] = values[k];
  return o;
}

/* Make MuJoCo use the nonzero columns of the rewritten rows. */
static void store_sparse(void *data, const SparseRows *p) {
  for (int64_t k = 0; k < p->values.n[0]; k++) p->values.at[k] = p->jacobian.at[p->places.at[k]];
  for (int64_t k = 0; k < p->offsets.n[0]; k++) {
    int64_t *pointer = &FIELD_AT(int64_t, data, p->offsets.at[k]);
    p->replaced.at[k] = *pointer;
    *pointer = p->addresses.at[k];
  }
  int *size = &FIELD_AT(int, data, p->size);
  p->replaced.at[p->offsets.n[0]] = *size;
  *size = (int)p->values.n[0];
}

/* Forces that act on the coordinates explicitly, as `push`: of rolling tyres, of the course control, applied ones. */
static void explicit_forces(const Now *o, const Layout *e, const Weights *c, State *s) {
  double *push = s->push.at;
  for (int64_t i = 0; i < s->push.n[0]; i++) push[i] = 0.0;
  rolling_forces(o, e, c, s);
  applied_forces(o, e, s);
  for (int64_t i = 0; i < s->push.n[0]; i++) o->f->qfrc_applied.at[i] += push[i];
}

/* Rewrite all rows and applied forces of a state. */
EXPORT void NAME(rewrite)(Simulation *simulation, void *data) {
  const Now now = now_of(simulation, data), *o = &now;
  const Layout *e = &simulation->layout;
  const Weights *c = &simulation->weights;
  State *s = &simulation->state;
  /* In this order: first the rows of the present position (modes, oblique directions, contact points, fluids), then
   * residuals and rates in element axes, then the laws with memory over the completed step, then the forces. */
  advance_modes(o, e, c, s);
  if (e->modes.size > 0) modal_rows(o, e, s);
  oblique_rows(o, e);
  rolling_rows(o, e);
  round_rows(o, e);
  fluid_rows(o, e);
  local_axes(o, e, s);
  headings(o, e, s);
  control(o, e, s);
  keep_speeds(o, e, s);
  advance_sliders(o, e, s);
  advance_rubber(o, e, s);
  advance_branches(o, c, s);
  elements(o, e, c, s);
  springs(o, e, c, s);
  ideal_joints(o, e, c, s);
  dampers(o, e, c, s);
  generalised_forces(o, e, s);
  rotations(o, e, c, s);
  explicit_forces(o, e, c, s);
  joint_forces(o, e, s);
  if (simulation->solution.size > 0) {
    predict(o, e, s, &simulation->solution);
    store_sparse(data, &simulation->ticket.sparse);
  }
}

/* ---- records of a state ---- */
EXPORT void NAME(attach)(const Simulation *s, void *data) {
  double *user = FIELD_AT(double *, data, located.user_data);
  user[0] = (double)(intptr_t)s, user[1] = MARK;
}

/* Take the records from a state; its rows are MuJoCo's own again, so that the arrays of the car may be deleted. */
EXPORT void NAME(detach)(const Simulation *s, void *data) {
  const SparseRows *p = &s->ticket.sparse;
  double *user = FIELD_AT(double *, data, located.user_data);
  user[0] = user[1] = 0.0;
  const int64_t count = p->offsets.n[0];
  for (int64_t k = 0; k < count; k++)
    if (FIELD_AT(int64_t, data, p->offsets.at[k]) != p->addresses.at[k]) return;
  for (int64_t k = 0; k < count; k++) FIELD_AT(int64_t, data, p->offsets.at[k]) = p->replaced.at[k];
  if (count > 0) FIELD_AT(int, data, p->size) = (int)p->replaced.at[count];
}

/* ---- mjcb_control, mjcb_act_gain, mjcb_act_bias ---- */
EXPORT void NAME(control)(const void *model, void *data) {
  Simulation *s = records_of(model, data);
  if (s == NULL) return;
  const SparseRows *p = &s->ticket.sparse;
  const int same = p->jacobian.n[0] == 0 || FIELD_AT(int, data, p->size) == p->own.n[0];
  if (same && FIELD_AT(int, data, s->ticket.row_count) == s->ticket.rows) {
    NAME(rewrite)(s, data);
  } else { /* the rows are not those of the records: make the state invalid, so that the run stops */
    for (int64_t i = 0; i < s->layout.velocity_count; i++) s->fields.qfrc_applied.at[i] = 0.0 / 0.0;
  }
}

EXPORT double NAME(gain)(const void *model, const void *data, int index) {
  (void)model, (void)data, (void)index;
  return 0.0;
}

EXPORT double NAME(bias)(const void *model, const void *data, int index) {
  const Simulation *s = records_of(model, data);
  return s == NULL ? 0.0 : damper_force(index, &s->fields, &s->layout, &s->state);
}

EXPORT double NAME(damper_force)(const Simulation *s, int64_t index) {
  return damper_force(index, &s->fields, &s->layout, &s->state);
}

/* ---- stepping loop ---- */
EXPORT void NAME(set_plates)(Loop *loop, int64_t step) { move_plates(step, &loop->plates); }

EXPORT void NAME(keep_row)(Loop *loop, int64_t row, double half) { keep_sample(row, half, loop); }

EXPORT int64_t NAME(run_steps)(Loop *loop, int64_t first, int64_t last, int64_t row) {
  return advance(loop, first, last, row);
}

/* ---- for tests: one solution of H x = b ---- */
EXPORT void NAME(solution)(const double *mass, const double *jacobian, const double *weight, const Solution *s) {
  assemble(s->matrix.at, mass, jacobian, weight, s);
  factorise(s->matrix.at, s);
  solve(s->matrix.at, s->right.at, s);
}
