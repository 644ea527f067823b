"""Advancing the poles step by step, compiled: the damper forces of every step are implicit.

v+ = w + G f with w the velocity without the forces of the step, f = -phi(v+) and

    phi(v) = clamp(c v, L) + clamp(d v, M),   c = (2/pi) L eps: friction;  d = Ddeg - D, M = d Vdeg: degressive law.

phi grows with v and is piecewise linear, so one damper alone is solved exactly. Two are solved by turns: the fixed
point is the minimum of a convex function (G is symmetric, positive), which coordinate descent finds from anywhere; the
dampers act on each other through the whole car, a hundred times less than on themselves, so few turns do.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from vehicle.compiler import prepare_compiler_cache
from vehicle.errors import MissingPartError

MISSING = "the reduced engine needs numba, which is missing (pip install numba)"

March = Callable[..., None]

LAW_ROWS = 7
"""Rows of the law table: sliding limit [N], static limit [N], Stribeck velocity [m/s] and exponent, smoothing eps
[s/m], extra slope [N s/m] and its limit [N] of the degressive law; a column for each damper."""

TURNS = 60
"""Most turns between the two dampers; each shrinks the error by the square of their coupling."""

ACCURACY = 1e-9
"""Error [N] of a damper force at which the turns end, far below what friction is known to."""


def solve_damper(
    w: float, g: float, c: float, limit: float, d: float, limit2: float, both: float, alone: float, extra: float
) -> float:
    """Velocity v of w = v + g (clamp(c v, limit) + clamp(d v, limit2)); odd in w, g > 0.

    `both`, `alone` and `extra` are 1 / (1 + g (c + d)), 1 / (1 + g c) and 1 / (1 + g d): divisions are slow, and these
    do not wait for w.
    """
    size = abs(w)
    v = size * both
    if c * v > limit or d * v > limit2:
        # The corner that comes first on the way up: as a rule friction, at some micrometres a second.
        if limit * d <= limit2 * c:
            v = (size - g * limit) * extra
            if d * v > limit2:
                v = size - g * (limit + limit2)
        else:
            v = (size - g * limit2) * alone
            if c * v > limit:
                v = size - g * (limit + limit2)
    return v if w > 0.0 else -v


def damper_force(v: float, c: float, limit: float, d: float, limit2: float) -> float:
    """-phi(v)."""
    return -min(max(c * v, -limit), limit) - min(max(d * v, -limit2), limit2)


def friction_limit(v: float, sliding: float, static: float, velocity: float, exponent: float) -> float:
    """Fd + (Fs - Fd) exp(-|v/vs|^delta)."""
    if static == sliding:
        return sliding
    weight: float = np.exp(-((abs(v) / velocity) ** exponent))
    return sliding + (static - sliding) * weight


def has_compiler() -> bool:
    """Whether numba is installed."""
    return find_spec("numba") is not None


@cache
def compiled_march() -> March:
    """The compiled march.

    Raises:
        MissingPartError: numba is not installed.
    """
    prepare_compiler_cache()
    try:
        import numba
    except ImportError:
        raise MissingPartError(MISSING) from None
    options: dict[str, Any] = {"cache": True, "boundscheck": False, "error_model": "numpy", "nogil": True}
    # Sums over poles may be taken in any order, so that they fill the vector units; nothing else is loosened.
    fast = {"reassoc", "contract", "nsz"}
    # Known to the compiler by their names: what a function closes over is part of the key of the compiler's cache, and
    # a compiled function is another object in every process.
    for law in (solve_damper, damper_force, friction_limit):
        numba.extending.register_jitable(fastmath=fast, boundscheck=False, error_model="numpy")(law)

    def march(
        pair_factors: Any,
        real_factors: Any,
        slip_plate: Any,
        gain: Any,
        laws: Any,
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
    ) -> None:
        """March over the steps between the rows of `plates` and keep every `every`-th end.

        Args:
            pair_factors: real and imaginary rows for the pairs: decay, damper velocities (2), forces (2), columns of
                `plates` (m); (2 (5 + m), p). One table, so that the compiler sees that no row overlaps the state.
            real_factors: the same rows for the real poles, real parts; (5 + m, q).
            slip_plate: what the plates add to the damper velocities, (2, m).
            gain: G of the damper forces of a step, (2, 2).
            laws: table of the laws, (LAW_ROWS, 2).
            plates: (z, z') of the driven plates at the ends of the steps; (steps + 1, m), m = 2 or 4.
            pair, real: eta without the forces of the step, changed in place; (2, p), (q,).
            force: damper forces of the last step [N], changed in place; (2,).
            every: steps between two samples.
            first: index of the first sample.
            samples: eta without the forces of the step at the samples; (block, 2 p + q).
            velocities, before, after: damper velocities [m/s], and damper forces [N] of the steps that end and
                begin at a sample; (all samples, 2).
        """
        pairs, reals, inputs = pair.shape[1], real.shape[0], plates.shape[1]
        c, r = pair_factors, real_factors
        sample = first
        phase = 0  # steps since the last sample
        v0, v1 = velocities[first - 1, 0], velocities[first - 1, 1]
        f0, f1 = force[0], force[1]
        g00, g01, g10, g11 = gain[0, 0], gain[0, 1], gain[1, 0], gain[1, 1]
        d0, d1, m0, m1 = laws[5, 0], laws[5, 1], laws[6, 0], laws[6, 1]
        extra0, extra1 = 1.0 / (1.0 + g00 * d0), 1.0 / (1.0 + g11 * d1)
        for step in range(plates.shape[0] - 1):
            z, d = plates[step, 0], plates[step, 1]
            l0 = friction_limit(v0, laws[0, 0], laws[1, 0], laws[2, 0], laws[3, 0])
            l1 = friction_limit(v1, laws[0, 1], laws[1, 1], laws[2, 1], laws[3, 1])
            s0, s1 = 2.0 / np.pi * l0 * laws[4, 0], 2.0 / np.pi * l1 * laws[4, 1]
            both0, alone0 = 1.0 / (1.0 + g00 * (s0 + d0)), 1.0 / (1.0 + g00 * s0)
            both1, alone1 = 1.0 / (1.0 + g11 * (s1 + d1)), 1.0 / (1.0 + g11 * s1)
            w0 = 0.0
            w1 = 0.0
            for p in range(pairs):
                a, b = pair[0, p], pair[1, p]
                re = c[0, p] * a - c[1, p] * b + c[6, p] * f0 + c[8, p] * f1 + c[10, p] * z + c[12, p] * d
                im = c[0, p] * b + c[1, p] * a + c[7, p] * f0 + c[9, p] * f1 + c[11, p] * z + c[13, p] * d
                w0 += c[2, p] * re - c[3, p] * im
                w1 += c[4, p] * re - c[5, p] * im
                pair[0, p] = re
                pair[1, p] = im
            for q in range(reals):
                value = r[0, q] * real[q] + r[3, q] * f0 + r[4, q] * f1 + r[5, q] * z + r[6, q] * d
                w0 += r[1, q] * value
                w1 += r[2, q] * value
                real[q] = value
            if inputs == 4:
                z, d = plates[step, 2], plates[step, 3]
                for p in range(pairs):
                    re = c[14, p] * z + c[16, p] * d
                    im = c[15, p] * z + c[17, p] * d
                    w0 += c[2, p] * re - c[3, p] * im
                    w1 += c[4, p] * re - c[5, p] * im
                    pair[0, p] += re
                    pair[1, p] += im
                for q in range(reals):
                    value = r[7, q] * z + r[8, q] * d
                    w0 += r[1, q] * value
                    w1 += r[2, q] * value
                    real[q] += value
            for column in range(inputs):
                w0 += slip_plate[0, column] * plates[step + 1, column]
                w1 += slip_plate[1, column] * plates[step + 1, column]
            for _ in range(TURNS):
                # By turns with the other's last force; both at once, so that neither waits for the other.
                u0, u1 = w0 + g01 * f1, w1 + g10 * f0
                v0 = solve_damper(u0, g00, s0, l0, d0, m0, both0, alone0, extra0)
                v1 = solve_damper(u1, g11, s1, l1, d1, m1, both1, alone1, extra1)
                last0, last1 = f0, f1
                f0, f1 = damper_force(v0, s0, l0, d0, m0), damper_force(v1, s1, l1, d1, m1)
                if abs(g01 * (f1 - last1)) <= ACCURACY * g00 and abs(g10 * (f0 - last0)) <= ACCURACY * g11:
                    break
            phase += 1
            if phase == 1:
                after[sample - 1, 0] = f0
                after[sample - 1, 1] = f1
            if phase == every:
                phase = 0
                row = sample - first
                for p in range(pairs):
                    samples[row, p] = pair[0, p]
                    samples[row, pairs + p] = pair[1, p]
                for q in range(reals):
                    samples[row, 2 * pairs + q] = real[q]
                velocities[sample, 0] = v0
                velocities[sample, 1] = v1
                before[sample, 0] = f0
                before[sample, 1] = f1
                sample += 1
        force[0] = f0
        force[1] = f1

    compiled: March = numba.njit(fastmath=fast, **options)(march)
    return compiled
