"""Compiled time stepping of the poles with implicit damper forces.

v+ = a + G f with the w velocities a without the forces of the step, f = -phi(v+) and

    phi(v) = clamp(c v, L) + F_c(v) - D v - F_c(0),   c = (2/pi) L eps: friction;  F_c: curve, D its smallest slope.

phi increases with v and is piecewise linear, so a single damper is solved exactly. Several dampers are solved by
iteration, each with the last forces of the others (Jacobi); the fixed point is the minimum of a convex function (G is
symmetric, positive). With two dampers the iteration converges from any start (coordinate descent). With more it
converges if the effect of each damper on itself is larger than that of all others on it. In a car it is a hundred times
larger, so few iterations are sufficient.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from vehicle.compiler import OPTIONS, jitable, numba_module, stamp
from vehicle.engines.reduced.controlled_dampers import Control, record_sample, set_coefficients
from vehicle.engines.reduced.slope_force import SlopeForces, set_slope_forces
from vehicle.engines.simulation.sampling import copy_row
from vehicle.errors import MissingPartError
from vehicle.model.laws.damper import friction_limit
from vehicle.model.laws.friction import clamp, slope_at_rest

MISSING = "the reduced engine needs numba; install it: pip install numba"

PoleStepping = Callable[..., None]

ITERATIONS = 60
"""Maximum number of iterations; with two dampers, two iterations reduce the error by the square of their coupling."""

ACCURACY = 1e-9
"""Error [N] of a damper force at which the iteration ends, far below the accuracy of any friction limit."""


@jitable
def solve_damper(a: float, g: float, limit: float, full: float, curve: Any, piece: int) -> tuple[float, int]:
    """Solve a = v + g (clamp(c v, L) + s v + b) for v; return v and its segment of the curve.

    For a given segment s v + b, v = (a - g b) k - g k clamp(c v, L), k = 1/(1 + g s). If v is beyond an end of the
    segment, so is the solution, because the law is monotonic: the next segment is tried.

    Args:
        a: velocity without the forces of the step.
        g: gain of the damper on its own velocity, above 0.
        limit: friction limit L.
        full: velocity pi/(2 eps) of full friction, for c = (2/pi) L eps.
        curve: upper end, s, b and k of every segment; (4, segments).
        piece: index of the first segment to try.
    """
    while True:
        k = curve[3, piece]
        u, brake = (a - g * curve[2, piece]) * k, g * k * limit
        if abs(u) > full + brake:
            v = u - brake if u > 0.0 else u + brake
        else:
            v = u * full / (full + brake)
        if v > curve[0, piece]:
            piece += 1
        elif piece > 0 and v < curve[0, piece - 1]:
            piece -= 1
        else:
            return v, piece


@jitable
def damper_force(v: float, limit: float, smoothing: float, curve: Any, piece: int) -> float:
    """Return the damper force -phi(v)."""
    force: float = -clamp(slope_at_rest(limit, smoothing) * v, limit) - curve[1, piece] * v - curve[2, piece]
    return force


@jitable
def solve_dampers(
    count: int, arriving: Any, gain: Any, laws: Any, curves: Any, velocity: Any, force: Any, last: Any, pieces: Any
) -> None:
    """Solve for the velocities and forces of w dampers in a step.

    Args:
        count: w.
        arriving: velocities without the forces of the step [m/s]; (w,).
        gain: G [m/(N s)]; (w, w).
        laws: records of `vehicle.model.laws.damper`; (w,).
        curves: segments of the curves without D v, see `solve_damper`; (w, 4, segments).
        velocity: velocity at the beginning of the step, which sets the friction limits, then at its end; changed in
            place, (w,).
        force: force of the last step, then of this step [N]; changed in place, (w,).
        last: buffers for limits and last forces, and the velocities of full friction; (3, w).
        pieces: current segment of each damper; changed in place, (w,).
    """
    limit, before, full = last[0], last[1], last[2]
    for i in range(count):
        limit[i] = friction_limit(laws[i], velocity[i])
    for _ in range(ITERATIONS):
        # Jacobi iteration: all dampers use the last forces of the others, so the processor can overlap them.
        for i in range(count):
            uncoupled = arriving[i]
            for j in range(count):
                if j != i:
                    uncoupled += gain[i, j] * force[j]
            velocity[i], pieces[i] = solve_damper(uncoupled, gain[i, i], limit[i], full[i], curves[i], pieces[i])
        for i in range(count):
            before[i] = force[i]
            force[i] = damper_force(velocity[i], limit[i], laws[i]["smoothing"], curves[i], pieces[i])
        settled = True
        for i in range(count):
            change = 0.0
            for j in range(count):
                if j != i:
                    change += gain[i, j] * (force[j] - before[j])
            settled = settled and abs(change) <= ACCURACY * gain[i, i]
        if settled:
            return


@jitable
def step_poles(
    count: int,
    pair_factors: Any,
    real_factors: Any,
    slip_plate: Any,
    gain: Any,
    laws: Any,
    curves: Any,
    plates: Any,
    pair: Any,
    real: Any,
    force: Any,
    every: int,
    first: int,
    samples: Any,
    velocities: Any,
    before: Any,
    after: Any,
    controls: Control,
    slope: SlopeForces,
) -> None:
    """Advance the poles over the steps between the rows of `plates` and store every `every`-th end.

    Inputs and damper velocities are processed in pairs: an odd number of dampers is padded by an idle damper.

    Args:
        count: even number e of dampers.
        pair_factors: real and imaginary rows for the pairs: decay, damper velocities (e), inputs in the order two
            forces, first plate, further forces, further plates, tyres on slopes; (2 (1 + e + e + m + r), p). One table,
            so that the compiler sees that no row overlaps the state.
        real_factors: the same rows for the real poles, real parts; (1 + e + e + m + r, q).
        slip_plate: contribution of the plates to the damper velocities, (e, m).
        gain: G of the damper forces of a step, (e, e).
        laws: records of `vehicle.model.laws.damper`; (e,).
        curves: segments of the damper curves, see `solve_damper`; (e, 4, segments).
        plates: (z, z') of the driven plates at the ends of the steps; (steps + 1, m).
        pair, real: eta without the forces of the step, changed in place; (2, p), (q,).
        force: damper forces of the last step [N], changed in place; (e,).
        every: steps between two samples.
        first: index of the first sample.
        samples: eta without the forces of the step at the samples; (block, 2 p + q).
        velocities, before, after: damper velocities [m/s], and damper forces [N] of the steps that end and
            begin at a sample; (all samples, e).
        controls: controlled dampers; their curves are changed in place.
        slope: slope forces of an even number r of rolling tyres.
    """
    pairs, reals = pair.shape[1], real.shape[0]
    inputs, at = count + plates.shape[1] + slope.past.shape[0], 1 + count
    x, y, c, r = pair[0], pair[1], pair_factors, real_factors
    c0, c1, c2, c3, c4, c5 = c[0], c[1], c[2], c[3], c[4], c[5]
    c6, c7, c8, c9 = c[2 * at], c[2 * at + 1], c[2 * at + 2], c[2 * at + 3]
    c10, c11, c12, c13 = c[2 * at + 4], c[2 * at + 5], c[2 * at + 6], c[2 * at + 7]
    r0, r1, r2, r3, r4, r5, r6 = r[0], r[1], r[2], r[at], r[at + 1], r[at + 2], r[at + 3]
    sample, phase = first, 0  # phase: steps since the last sample
    velocity, arriving, u = np.empty(count), np.empty(count), np.empty(inputs)
    copy_row(velocity, velocities[first - 1])
    room, pieces = np.empty((3, count)), np.zeros(count, dtype=np.int64)
    for i in range(count):
        # An idle damper has no smoothing and no friction.
        room[2, i] = 0.5 * np.pi / laws[i]["smoothing"] if laws[i]["smoothing"] > 0.0 else 1.0
    for step in range(plates.shape[0] - 1):
        set_coefficients(pair, real, plates[step], force, gain, velocity, curves, controls)
        u[0], u[1], u[2], u[3] = force[0], force[1], plates[step, 0], plates[step, 1]
        for k in range(2, count):
            u[2 + k] = force[k]
        for k in range(2, plates.shape[1]):
            u[count + k] = plates[step, k]
        set_slope_forces(pair, real, plates, step, force, u, count + plates.shape[1], slope)
        f0, f1, z, d = u[0], u[1], u[2], u[3]
        w0, w1 = 0.0, 0.0
        for p in range(pairs):
            a, b = x[p], y[p]
            re = c0[p] * a - c1[p] * b + c6[p] * f0 + c8[p] * f1 + c10[p] * z + c12[p] * d
            im = c0[p] * b + c1[p] * a + c7[p] * f0 + c9[p] * f1 + c11[p] * z + c13[p] * d
            w0 += c2[p] * re - c3[p] * im
            w1 += c4[p] * re - c5[p] * im
            x[p] = re
            y[p] = im
        for q in range(reals):
            value = r0[q] * real[q] + r3[q] * f0 + r4[q] * f1 + r5[q] * z + r6[q] * d
            w0 += r1[q] * value
            w1 += r2[q] * value
            real[q] = value
        for k in range(4, inputs, 2):
            f0, f1, at = u[k], u[k + 1], 1 + count + k
            b0, b1, b2, b3 = c[2 * at], c[2 * at + 1], c[2 * at + 2], c[2 * at + 3]
            for p in range(pairs):
                re = b0[p] * f0 + b2[p] * f1
                im = b1[p] * f0 + b3[p] * f1
                w0 += c2[p] * re - c3[p] * im
                w1 += c4[p] * re - c5[p] * im
                x[p] += re
                y[p] += im
            for q in range(reals):
                value = r[at, q] * f0 + r[at + 1, q] * f1
                w0 += r1[q] * value
                w1 += r2[q] * value
                real[q] += value
        arriving[0], arriving[1] = w0, w1
        for i in range(2, count):
            along = 0.0
            for p in range(pairs):
                along += c[2 + 2 * i, p] * x[p] - c[3 + 2 * i, p] * y[p]
            for q in range(reals):
                along += r[1 + i, q] * real[q]
            arriving[i] = along
        for i in range(count):
            for k in range(plates.shape[1]):
                arriving[i] += slip_plate[i, k] * plates[step + 1, k]
        solve_dampers(count, arriving, gain, laws, curves, velocity, force, room, pieces)
        phase += 1
        if phase == 1:
            copy_row(after[sample - 1], force)
            record_sample(sample - 1, 1, velocity, curves, controls)
        if phase == every:
            phase = 0
            row = samples[sample - first]
            copy_row(row, x)
            copy_row(row[pairs:], y)
            copy_row(row[2 * pairs :], real)
            copy_row(velocities[sample], velocity)
            copy_row(before[sample], force)
            record_sample(sample, 0, velocity, curves, controls)
            sample += 1


def has_compiler() -> bool:
    """Return True if numba is installed."""
    return find_spec("numba") is not None


@cache
def compiled_stepping(count: int) -> PoleStepping:
    """Compile `step_poles` for an even number of dampers; the constant number lets the compiler unroll its loops.

    Raises:
        MissingPartError: numba is not installed.
    """
    try:
        numba = numba_module()
    except ImportError:
        raise MissingPartError(MISSING) from None
    mark = stamp()

    # Closure variables are part of the key of numba's cache.
    def entry(*arguments: Any) -> None:
        if mark:
            step_poles(count, *arguments)

    compiled: PoleStepping = numba.njit(cache=True, nogil=True, **OPTIONS)(entry)
    return compiled
