"""Advancing the poles step by step, compiled: the damper forces of every step are implicit.

v+ = a + G f with a the w velocities without the forces of the step, f = -phi(v+) and

    phi(v) = clamp(c v, L) + F_c(v) - D v - F_c(0),   c = (2/pi) L eps: friction;  F_c: curve, D its smallest slope.

phi grows with v and is piecewise linear, so one damper alone is solved exactly. Several are solved by turns: the fixed
point is the minimum of a convex function (G is symmetric, positive). Two find it from anywhere, by coordinate descent;
more do where the dampers act on themselves more than all others on them. In a car it is a hundred times more, so few
turns do.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from vehicle.compiler import OPTIONS, jitable, numba_module, stamp
from vehicle.engines.reduced.damper_control import Control, control, keep
from vehicle.engines.reduced.slope_force import Slope, slopes
from vehicle.engines.simulation.sampling import copy_row
from vehicle.errors import MissingPartError
from vehicle.model.laws.damper import friction_limit
from vehicle.model.laws.friction import clamp, slope_at_rest

MISSING = "the reduced engine needs numba, which is missing (pip install numba)"

March = Callable[..., None]

TURNS = 60
"""Most turns among the dampers; of two, each shrinks the error by the square of their coupling."""

ACCURACY = 1e-9
"""Error [N] of a damper force at which the turns end, far below what friction is known to."""


@jitable
def solve_damper(a: float, g: float, limit: float, full: float, curve: Any, piece: int) -> tuple[float, int]:
    """Velocity v of a = v + g (clamp(c v, L) + s v + b), and the piece of the curve that it is on.

    With the piece s v + b known, v = (a - g b) k - g k clamp(c v, L), k = 1/(1 + g s). Beyond the edge of that piece,
    the solution is beyond it in truth too, for all of the law rises: the next piece is tried.

    Args:
        a: velocity without the forces of the step.
        g: own gain, above 0.
        limit: L.
        full: velocity pi/(2 eps) at which the friction is full, for c = (2/pi) L eps.
        curve: upper edge, s, b and k of every piece; (4, pieces).
        piece: to begin with.
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
    """-phi(v)."""
    force: float = -clamp(slope_at_rest(limit, smoothing) * v, limit) - curve[1, piece] * v - curve[2, piece]
    return force


@jitable
def solve_dampers(
    count: int, arriving: Any, gain: Any, laws: Any, curves: Any, velocity: Any, force: Any, last: Any, pieces: Any
) -> None:
    """Velocities and forces of w dampers in a step.

    Args:
        count: w.
        arriving: velocities without the forces of the step [m/s]; (w,).
        gain: G [m/(N s)]; (w, w).
        laws: records of `vehicle.model.laws.damper`; (w,).
        curves: what the pieces of the curves have beside D v, as of `solve_damper`; (w, 4, pieces).
        velocity: at the beginning of the step, which sets the friction limits, and at its end; changed in place, (w,).
        force: of the last step and of this one [N], changed in place; (w,).
        last: room for limits and last forces, and the velocities of full friction; (3, w).
        pieces: which of a curve each damper was on; changed in place, (w,).
    """
    limit, before, full = last[0], last[1], last[2]
    for i in range(count):
        limit[i] = friction_limit(laws[i], velocity[i])
    for _ in range(TURNS):
        # By turns with the others' last forces; all at once, so that none waits for another.
        for i in range(count):
            own = arriving[i]
            for j in range(count):
                if j != i:
                    own += gain[i, j] * force[j]
            velocity[i], pieces[i] = solve_damper(own, gain[i, i], limit[i], full[i], curves[i], pieces[i])
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
def march(
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
    slope: Slope,
) -> None:
    """March over the steps between the rows of `plates` and keep every `every`-th end.

    Inputs and damper velocities are taken in pairs: an odd number of dampers has one more that does nothing (e).

    Args:
        count: e.
        pair_factors: real and imaginary rows for the pairs: decay, damper velocities (e), inputs in the order two
            forces, first plate, further forces, further plates, tyres on slopes; (2 (1 + e + e + m + r), p). One table,
            so that the compiler sees that no row overlaps the state.
        real_factors: the same rows for the real poles, real parts; (1 + e + e + m + r, q).
        slip_plate: what the plates add to the damper velocities, (e, m).
        gain: G of the damper forces of a step, (e, e).
        laws: records of `vehicle.model.laws.damper`; (e,).
        curves: pieces of their curves, as of `solve_damper`; (e, 4, pieces).
        plates: (z, z') of the driven plates at the ends of the steps; (steps + 1, m).
        pair, real: eta without the forces of the step, changed in place; (2, p), (q,).
        force: damper forces of the last step [N], changed in place; (e,).
        every: steps between two samples.
        first: index of the first sample.
        samples: eta without the forces of the step at the samples; (block, 2 p + q).
        velocities, before, after: damper velocities [m/s], and damper forces [N] of the steps that end and
            begin at a sample; (all samples, e).
        controls: controlled dampers, whose curves it changes.
        slope: rolling tyres, an even number r.
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
        # An idle damper has no smoothing, and no friction.
        room[2, i] = 0.5 * np.pi / laws[i]["smoothing"] if laws[i]["smoothing"] > 0.0 else 1.0
    for step in range(plates.shape[0] - 1):
        control(pair, real, plates[step], force, gain, velocity, curves, controls)
        u[0], u[1], u[2], u[3] = force[0], force[1], plates[step, 0], plates[step, 1]
        for k in range(2, count):
            u[2 + k] = force[k]
        for k in range(2, plates.shape[1]):
            u[count + k] = plates[step, k]
        slopes(pair, real, plates, step, force, u, count + plates.shape[1], slope)
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
            keep(sample - 1, 1, velocity, curves, controls)
        if phase == every:
            phase = 0
            row = samples[sample - first]
            copy_row(row, x)
            copy_row(row[pairs:], y)
            copy_row(row[2 * pairs :], real)
            copy_row(velocities[sample], velocity)
            copy_row(before[sample], force)
            keep(sample, 0, velocity, curves, controls)
            sample += 1


def has_compiler() -> bool:
    """Whether numba is installed."""
    return find_spec("numba") is not None


@cache
def compiled_stepping(count: int) -> March:
    """The compiled march of an even number of dampers, which the compiler knows: loops over two are none.

    Raises:
        MissingPartError: numba is not installed.
    """
    try:
        numba = numba_module()
    except ImportError:
        raise MissingPartError(MISSING) from None
    mark = stamp()

    # What it closes over is part of the key of the compiler's cache.
    def entry(*arguments: Any) -> None:
        if mark:
            march(count, *arguments)

    compiled: March = numba.njit(cache=True, nogil=True, **OPTIONS)(entry)
    return compiled
