/* Acceleration of a step, solved with the sparsity of the car, as the start of MuJoCo's solver.
 *
 * MuJoCo minimises the Gauss function over the rows f_i = D_i (aref_i - J_i a), friction rows limited to f. With the rows
 * at their limits known, its minimum is the solution of
 *
 *     H a = Q + sum_i J_i' (D_i aref_i) +- sum_k J_k' f_k,      H = M + sum_i J_i' D_i J_i,
 *
 * i being the rows within their limits and k the friction rows at their limits. The limits of the last step hold in most
 * steps; otherwise the system is solved again with the new limits. MuJoCo evaluates the gradient at this acceleration,
 * and iterates from there if it exceeds the tolerance of the solver: the result is that of its own solver.
 *
 * H = L' D L is factorised from the last coordinate to the first, so that the body, which all parts act on, comes last.
 * H and L are stored in tiles of 4 x 4 numbers, and all tiles outside the pattern of the model are zero.
 * Source: George, Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), chapter 5.
 */
#ifndef PREDICTION_H
#define PREDICTION_H
#include "dampers.h"

typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));
#define FOUR(address) (*(Four *)(address))

enum { TILE = 4, ATTEMPTS = 4 }; /* ATTEMPTS: solutions with changed limits; MuJoCo continues from the last one */

/* Q + J' D aref of the equality rows: the explicit forces. */
static void right_side(const Now *o, const Layout *e, const State *c, const Solution *s) {
  const Fields *f = o->f;
  double *total = s->right.at;
  for (int64_t i = 0; i < s->right.n[0]; i++) total[i] = 0.0;
  for (int64_t i = 0; i < s->size; i++) total[i] = f->qfrc_passive.at[i] - f->qfrc_bias.at[i] + f->qfrc_applied.at[i];
  for (int64_t n = 0; n < e->dampers.dofs.n[0]; n++) total[e->dampers.dofs.at[n]] += damper_force(n, f, e, c);
  for (int64_t group = 0; group < s->groups.n[0]; group++) {
    const int64_t *of = ROW(s->groups, group);
    for (int64_t row = of[0]; row < of[0] + of[1]; row++) {
      const double force = o->D[row] * o->aref[row];
      if (force == 0.0) continue;
      for (int64_t k = of[2]; k < of[3]; k++) {
        const int64_t at = TILE * s->columns.at[k];
        FOUR(total + at) += force * FOUR(row_of(o, row) + at);
      }
    }
  }
}

/* Lower triangle of M + J' D J in its tiles; weight: D of each row, zero for rows at their limits. */
static void assemble(double *h, const double *mass, const double *jacobian, const double *weight, const Solution *s) {
  const int64_t n = s->matrix.n[0], blocks = s->starts.n[0] - 1;
  for (int64_t block = 0; block < blocks; block++)
    for (int64_t k = s->starts.at[block]; k < s->starts.at[block + 1]; k++)
      for (int i = 0; i < TILE; i++) FOUR(h + (TILE * block + i) * n + TILE * s->tiles.at[k]) = (Four){0};
  for (int64_t k = s->size; k < n; k++) h[k * n + k] = 1.0; /* beyond the coordinates of the car */
  for (int64_t k = 0; k < s->inertia.n[0]; k++) h[AT(s->inertia, k, 0) * n + AT(s->inertia, k, 1)] = mass[k];
  for (int64_t group = 0; group < s->groups.n[0]; group++) {
    const int64_t *of = ROW(s->groups, group), row = of[0], first = of[2], last = of[3];
    /* Three rows with the same columns are added at once; of a single row the others have zero weight. */
    const double *j0 = jacobian + row * n, *j1 = j0, *j2 = j0;
    double d0 = weight[row], d1 = 0.0, d2 = 0.0;
    if (of[1] == 3) {
      d1 = weight[row + 1], j1 = j0 + n;
      d2 = weight[row + 2], j2 = j1 + n;
    }
    for (int64_t a = first; a < last; a++) {
      const int64_t i = TILE * s->columns.at[a];
      double x[TILE], y[TILE], z[TILE], *line = h + i * n;
      for (int k = 0; k < TILE; k++) x[k] = d0 * j0[i + k], y[k] = d1 * j1[i + k], z[k] = d2 * j2[i + k];
      for (int64_t b = first; b <= a; b++) {
        const int64_t to = TILE * s->columns.at[b];
        const Four u = FOUR(j0 + to), v = FOUR(j1 + to), w = FOUR(j2 + to);
        for (int k = 0; k < TILE; k++) FOUR(line + k * n + to) += x[k] * u + y[k] * v + z[k] * w;
      }
    }
  }
  for (int64_t k = 0; k < s->singles.n[0]; k++) {
    const int64_t row = AT(s->singles, k, 0), dof = AT(s->singles, k, 1);
    const double J = jacobian[row * n + dof];
    h[dof * n + dof] += weight[row] * J * J;
  }
}

/* Replace the lower triangle of H by D L of H = L' D L, L with a unit diagonal; the last row comes first. */
static void factorise(double *h, const Solution *s) {
  const int64_t n = s->matrix.n[0];
  for (int64_t block = s->starts.n[0] - 2; block >= 0; block--) {
    const int64_t r = TILE * block, first = s->starts.at[block], last = s->starts.at[block + 1];
    double *u0 = h + r * n, *u1 = u0 + n, *u2 = u1 + n, *u3 = u2 + n;
    /* The diagonal tile, last row first: row i loses L_ji times each later row j. */
    const double f32 = u3[r + 2] / u3[r + 3], f31 = u3[r + 1] / u3[r + 3], f30 = u3[r] / u3[r + 3];
    u2[r + 2] -= f32 * u3[r + 2], u2[r + 1] -= f32 * u3[r + 1], u2[r] -= f32 * u3[r];
    u1[r + 1] -= f31 * u3[r + 1], u1[r] -= f31 * u3[r];
    u0[r] -= f30 * u3[r];
    const double f21 = u2[r + 1] / u2[r + 2], f20 = u2[r] / u2[r + 2];
    u1[r + 1] -= f21 * u2[r + 1], u1[r] -= f21 * u2[r];
    u0[r] -= f20 * u2[r];
    const double f10 = u1[r] / u1[r + 1];
    u0[r] -= f10 * u1[r];
    const double i0 = 1.0 / u0[r], i1 = 1.0 / u1[r + 1], i2 = 1.0 / u2[r + 2], i3 = 1.0 / u3[r + 3];
    for (int64_t a = first; a < last - 1; a++) { /* the last tile of a row of tiles is on the diagonal */
      const int64_t at = TILE * s->tiles.at[a];
      FOUR(u2 + at) -= f32 * FOUR(u3 + at);
      FOUR(u1 + at) -= f31 * FOUR(u3 + at) + f21 * FOUR(u2 + at);
      FOUR(u0 + at) -= f30 * FOUR(u3 + at) + f20 * FOUR(u2 + at) + f10 * FOUR(u1 + at);
      /* Earlier rows lose u' D^-1 u of the four rows of this tile. */
      double g[TILE][TILE], *line = h + at * n;
      for (int k = 0; k < TILE; k++) {
        g[0][k] = i0 * u0[at + k], g[1][k] = i1 * u1[at + k];
        g[2][k] = i2 * u2[at + k], g[3][k] = i3 * u3[at + k];
      }
      for (int64_t b = first; b <= a; b++) {
        const int64_t to = TILE * s->tiles.at[b];
        const Four x = FOUR(u0 + to), y = FOUR(u1 + to), z = FOUR(u2 + to), w = FOUR(u3 + to);
        for (int k = 0; k < TILE; k++)
          FOUR(line + k * n + to) -= g[0][k] * x + g[1][k] * y + g[2][k] * z + g[3][k] * w;
      }
    }
  }
}

static inline double sum_of(Four v) { return (v[0] + v[1]) + (v[2] + v[3]); }

/* Replace the right-hand side b by the solution of H x = b; h has the factor. */
static void solve(const double *h, double *b, const Solution *s) {
  const int64_t n = s->matrix.n[0], blocks = s->starts.n[0] - 1;
  for (int64_t block = blocks - 1; block >= 0; block--) {
    const int64_t r = TILE * block;
    const double *u0 = h + r * n, *u1 = u0 + n, *u2 = u1 + n, *u3 = u2 + n;
    /* L' D y = b from the last row to the first, then L x = y the other way. */
    const double w = b[r + 3] / u3[r + 3];
    b[r + 2] -= u3[r + 2] * w;
    const double z = b[r + 2] / u2[r + 2];
    b[r + 1] -= u3[r + 1] * w + u2[r + 1] * z;
    const double y = b[r + 1] / u1[r + 1];
    b[r] -= u3[r] * w + u2[r] * z + u1[r] * y;
    const double x = b[r] / u0[r];
    for (int64_t a = s->starts.at[block]; a < s->starts.at[block + 1] - 1; a++) {
      const int64_t to = TILE * s->tiles.at[a];
      FOUR(b + to) -= x * FOUR(u0 + to) + y * FOUR(u1 + to) + z * FOUR(u2 + to) + w * FOUR(u3 + to);
    }
  }
  for (int64_t block = 0; block < blocks; block++) {
    const int64_t r = TILE * block;
    const double *u0 = h + r * n, *u1 = u0 + n, *u2 = u1 + n, *u3 = u2 + n;
    Four s0 = {0}, s1 = {0}, s2 = {0}, s3 = {0};
    for (int64_t a = s->starts.at[block]; a < s->starts.at[block + 1] - 1; a++) {
      const int64_t at = TILE * s->tiles.at[a];
      const Four known = FOUR(b + at);
      s0 += FOUR(u0 + at) * known, s1 += FOUR(u1 + at) * known;
      s2 += FOUR(u2 + at) * known, s3 += FOUR(u3 + at) * known;
    }
    b[r] = (b[r] - sum_of(s0)) / u0[r];
    b[r + 1] = (b[r + 1] - sum_of(s1) - u1[r] * b[r]) / u1[r + 1];
    b[r + 2] = (b[r + 2] - sum_of(s2) - u2[r] * b[r] - u2[r + 1] * b[r + 1]) / u2[r + 2];
    b[r + 3] = (b[r + 3] - sum_of(s3) - u3[r] * b[r] - u3[r + 1] * b[r + 1] - u3[r + 2] * b[r + 2]) / u3[r + 3];
  }
}

/* Limits of the friction rows at an acceleration: sign of the force at its limit, else zero; 1 if one has changed. */
static int limits_changed(const Now *o, const double *a, const Solution *s) {
  int changed = 0;
  for (int64_t k = 0; k < s->frictions.n[0]; k++) {
    const int64_t row = AT(s->frictions, k, 0), dof = AT(s->frictions, k, 1);
    const double beyond = row_of(o, row)[dof] * a[dof] - o->aref[row], most = o->R[row] * o->loss[row];
    double force = beyond <= -most ? 1.0 : beyond >= most ? -1.0 : 0.0;
    /* From one limit to the other by way of none: a damper that comes to rest would alternate between them. */
    if (force * s->limited.at[k] < 0.0) force = 0.0;
    changed |= force != s->limited.at[k];
    s->limited.at[k] = force;
  }
  return changed;
}

/* Write the acceleration of the step where MuJoCo's solver starts; after all rows. */
static void predict(const Now *o, const Layout *e, const State *c, const Solution *s) {
  double *a = s->acceleration.at, *weight = s->weight.at;
  right_side(o, e, c, s);
  for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
    for (int64_t i = 0; i < s->right.n[0]; i++) a[i] = s->right.at[i];
    for (int64_t i = 0; i < o->rows; i++) weight[i] = o->D[i];
    for (int64_t k = 0; k < s->frictions.n[0]; k++) {
      const int64_t row = AT(s->frictions, k, 0), dof = AT(s->frictions, k, 1);
      const double J = row_of(o, row)[dof];
      if (s->limited.at[k] == 0.0) {
        a[dof] += J * weight[row] * o->aref[row];
      } else {
        weight[row] = 0.0;
        a[dof] += J * s->limited.at[k] * o->loss[row];
      }
    }
    assemble(s->matrix.at, o->f->M.at, o->J, weight, s);
    factorise(s->matrix.at, s);
    solve(s->matrix.at, a, s);
    if (!limits_changed(o, a, s)) break;
  }
  for (int64_t i = 0; i < s->size; i++) o->f->qacc_warmstart.at[i] = a[i];
}
#endif
