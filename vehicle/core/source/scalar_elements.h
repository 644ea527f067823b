/* Scalar elements of a time step: groups of Jenkins elements, laws over displacement, and rubber friction.
 *
 * The Jenkins elements of a group act with the mean of their forces at both ends, t = clamp(t + k u, L) with the change
 * u of the displacement over the step: second order, and no work is added at any step and stiffness, because u is exact.
 * The equation u + G f(u) = r of a group is monotone and piecewise linear. Its solution lies between the corners with
 * the nearest values of the left side, in whatever order the corners are.
 *
 * A law g over displacement (`vehicle.engines.linear.displacement_laws`) acts with the mean of both ends of the step:
 *
 *     x+ = w - G (g_n + g+)/2,    g+ = g(x+).
 *
 * G <= 2/K, because the compliance of a passive car with the tangent K of the law in it is at most 1/K at rest, and a
 * step response at most twice that. The slope of g is at least -K, so x+ + G g(x+)/2 = r = w - G g_n/2 is monotone at
 * any step, and also for a tyre that lifts off. Each segment of slope k gets the slope k/(1 + G k/2) over r, so
 *
 *     g+ = sum over j of a_j max(0, sign(p_j) (r - p_j)),    with p_j + G g(p_j)/2 as breakpoints,
 *
 * is a closed form without any search, and exactly zero in the segment in which the car is at rest. The work of the mean
 * force is the change of the energy of the law in a step within one segment: second order.
 *
 * Rubber friction has the force g = -q with q = sum of k_i q_i, whose sliders q_i move in a step. With r' = w + G q_n,
 *
 *     x+ - G (q+ - q_n)/2 = r',    so that x+ = r' and q+ = q_n if no slider moves.
 *
 * Sliders of elements with ascending strokes x_i always lie so that they begin to move in this order: |q_i - q_j| is at
 * most |x_i - x_j|. When slider i begins to move up, x+ = q_i + x_i, and those before it have moved, which gives
 *
 *     r' = m_i + e_i,    m_i = p_i q_i + G/2 (sum of k_j q_j before i),    e_i = p_i x_i + G/2 (sum of k_j x_j before i),
 *
 * with p_i = 1 - G/2 (sum of k_j before i); down, r' = m_i - e_i. Beyond, the slope of q+ - q_n over r' rises by the
 * weight w_i, that is from S/p to S'/p' with the sums S and S' of the k_j before i and up to i:
 *
 *     q+ - q_n = sum over i of w_i (r' - max(m_i - e_i, min(m_i + e_i, r'))). */
#ifndef CORE_SCALAR_ELEMENTS_H
#define CORE_SCALAR_ELEMENTS_H
#include "march.h"

/* Rows of a group in the work space: smallest and largest mean force, then left side and mean force at each corner. */
INLINE int64_t group_rows(const March *job) { return 2 + 4 * job->rows.elements; }

/* Corners of the equation u + G f(u) = r of each group. */
static void prepare_groups(const March *job, V *work) {
  const Sections *r = &job->rows;
  const V *t = table_of(job), half = all((REAL)0.5);
  int64_t d = job->dampers, width = solved_count(job);
  for (int64_t group = 0; group < r->groups; group++, work += group_rows(job)) {
    int64_t first = r->elements * group, end = first + r->elements;
    V limit = t[r->limit + job->owners.at[group]], gain = t[r->gain + (d + group) * (width + 1)];
    V low = {0}, high = {0}, *corner = work + 2;
    for (int64_t i = first; i < end; i++) {
      V slider = t[r->slider + i], bound = limit * t[r->share + i];
      low += half * (slider - bound), high += half * (slider + bound);
    }
    work[0] = low, work[1] = high;
    for (int64_t i = first; i < end; i++)
      for (int side = -1; side < 2; side += 2, corner += 2) {
        V bound = all((REAL)side) * (limit * t[r->share + i]), force = {0};
        V u = (bound - t[r->slider + i]) * t[r->give + i];
        for (int64_t k = first; k < end; k++) {
          V slider = t[r->slider + k];
          force += half * (slider + vclamp(slider + t[r->spring + k] * u, limit * t[r->share + k]));
        }
        corner[0] = u + gain * force, corner[1] = force;
      }
  }
}

/* Mean force of a group from the left side of its equation; `far` stands for an infinite displacement. */
static V group_force(const V *work, int64_t corners, V value) {
  const REAL far = (REAL)1e30;
  V low = work[0], high = work[1], below = all(-far), above = all(far), lower = low, upper = high;
  for (int64_t c = 0; c < corners; c++) {
    V left = work[2 + 2 * c], force = work[3 + 2 * c];
    Mask under = value < left;
    /* Nearest corners on both sides of the value, with their forces; beyond all corners the smallest and largest
     * force. */
    below = vmax(below, pick(under, below, left)), lower = vmax(lower, pick(under, low, force));
    above = vmin(above, pick(under, left, above)), upper = vmin(upper, pick(under, force, high));
  }
  return lower + (upper - lower) * ((value - below) / (above - below));
}

/* Advance the Jenkins elements of a group over a step, in which its displacement changes by u. */
static void advance_group(const March *job, int64_t group, V u) {
  const Sections *r = &job->rows;
  V *t = table_of(job), limit = t[r->limit + job->owners.at[group]];
  t[r->place + group] += u;
  for (int64_t i = r->elements * group; i < r->elements * (group + 1); i++)
    t[r->slider + i] = vclamp(t[r->slider + i] + t[r->spring + i] * u, limit * t[r->share + i]);
}

/* Force g of a law over displacement at the end of a step from r. */
INLINE V law_force(const March *job, int64_t curve, V value) {
  V force = {0};
  const V *corner = table_of(job) + job->rows.corner + 3 * job->rows.corners * curve;
  for (int64_t i = 0; i < job->rows.corners; i++, corner += 3)
    force += corner[2] * vmax(corner[0] * value - corner[1], (V){0});
  return force;
}

/* Change q+ - q_n of the sliders of rubber friction in a step from r'. */
INLINE V rubber_change(const March *job, int64_t rubber, V value) {
  const Sections *r = &job->rows;
  const V *t = table_of(job);
  V change = {0}, moved = value - t[r->ahead + rubber];
  for (int64_t i = r->layers * rubber; i < r->layers * (rubber + 1); i++) {
    V distance = moved - t[r->middle + i];
    change += t[r->weight + i] * (distance - vclamp(distance, t[r->reach + i]));
  }
  return of_cars(change);
}

/* Move the sliders of rubber friction to the displacement at the end of a step; set its force g and the next middles. */
static void advance_rubber(const March *job, int64_t rubber, V displacement) {
  const Sections *r = &job->rows;
  int64_t curve = r->curves - r->rubbers + rubber;
  V *t = table_of(job), half = t[r->own + curve], held = {0};
  for (int64_t i = r->layers * rubber; i < r->layers * (rubber + 1); i++) {
    V stroke = t[r->stroke + i], anchor = t[r->anchor + i];
    anchor = vmax(displacement - stroke, vmin(displacement + stroke, anchor));
    t[r->anchor + i] = anchor, t[r->middle + i] = t[r->part + i] * anchor + half * held;
    held += t[r->stiff + i] * anchor;
  }
  t[r->ahead + rubber] = half * before(held);
  t[r->excess + curve] = -of_cars(held);
}
#endif
