/* A damper behind a series stiffness under a measured motion; see vehicle/studies/dampers/damper_force.py. */
#include "layout.h"
#include "mathematics.h"

enum { ITERATIONS = 60, SLOW = 8 }; /* of a sample; from SLOW on every second one is a bisection: the force may fall with w */
static const double CLOSED = 1e-10; /* residual over the sum of the forces */

/* Solve K e(s) = F_c(v - s') + sum of clamp(t + k du, l) + k_g (x - s) + F_0 at each sample, by Newton's method in a
   bracket; e(s) is the deflection beyond a gap of the width 2 h: s - h above h, s + h below -h, otherwise zero. */
EXPORT void core_damper_rig(const DamperRig *rig) {
  int64_t n = rig->displacement.n[0], m = rig->limit.n[0], last = rig->knots.n[0], segment = 0;
  const double *rates = rig->rates.at, *near = rates + n, *far = near + n, *x = rig->displacement.at, *v = rig->velocity.at;
  const double *stiffness = rig->stiffness.at, *limits = rig->limit.at;
  double *forces = rig->forces.at, *deflection = rig->deflection.at, *inner = rig->inner.at;
  char *sticking = rig->sticking.at;
  double half = rig->half, s = rig->first / rig->spring + (rig->first < 0.0 ? -half : half), before = s;
  deflection[0] = s, inner[0] = v[0];
  for (int64_t i = 0; i < m; i++) sticking[i] = 1;
  for (int64_t at = 1; at < n; at++) {
    double rate = rates[at], previous = deflection[at - 1], back = -near[at] * previous - far[at] * before;
    double low = -1e300, high = 1e300, anchor = x[at] - x[at - 1] + previous;
    for (int count = 0; count < ITERATIONS; count++) {
      double w = v[at] - rate * s + back;
      while (segment < last && w > rig->knots.at[segment]) segment++;
      while (segment && w <= rig->knots.at[segment - 1]) segment--;
      double slope = rig->slopes.at[segment], curve = slope * w + rig->offsets.at[segment];
      if (rig->drop != 0.0) {
        double ratio = absolute(w) / rig->critical, weight = exponential(-ratio * ratio), fall = rig->drop * (1.0 - weight);
        curve -= w < 0.0 ? -fall : fall;
        /* Where the force falls with the velocity, its slope is left out: a shorter step of the iteration. */
        slope = larger(slope - 2.0 * rig->drop * weight * ratio / rig->critical, 0.0);
      }
      double engaged = s > half ? s - half : s < -half ? s + half : 0.0, spring = rig->spring;
      /* In the gap the force is zero: an error of 1e-10 N counts as none, and a slope of 1 N s/m keeps the step finite. */
      if (engaged == 0.0 && half > 0.0) spring = rate;
      double size = absolute(curve) + absolute(rig->offset) + (half > 0.0), total = spring + rate * slope + rig->gas;
      double error = rig->spring * engaged - curve - rig->gas * (x[at] - s) - rig->offset;
      for (int64_t i = 0; i < m; i++) {
        double t = forces[i] + stiffness[i] * (anchor - s), limit = limits[i];
        size += limit;
        if (t > limit) error -= limit;
        else if (t < -limit) error += limit;
        else error -= t, total += stiffness[i];
      }
      if (absolute(error) <= CLOSED * size) break;
      if (error > 0.0) high = smaller(high, s);
      else low = larger(low, s);
      double next = s - error / total;
      if (next == s) break; /* the step is below the digits of s */
      if (high - low < 1e299 && (!(low < next && next < high) || (count > SLOW && count % 2))) next = 0.5 * (low + high);
      s = next;
    }
    for (int64_t i = 0; i < m; i++) {
      double t = forces[i] + stiffness[i] * (anchor - s), limit = limits[i];
      sticking[at * m + i] = t >= -limit && t <= limit;
      forces[i] = smaller(larger(t, -limit), limit);
    }
    deflection[at] = s, inner[at] = v[at] - rate * s + back, before = previous;
  }
}

/* Force of a Jenkins element at n displacements, from rest at the first. */
EXPORT void core_slider(int64_t n, const double *x, double stiffness, double limit, double *force) {
  force[0] = 0.0;
  for (int64_t i = 1; i < n; i++) force[i] = smaller(larger(force[i - 1] + stiffness * (x[i] - x[i - 1]), -limit), limit);
}
