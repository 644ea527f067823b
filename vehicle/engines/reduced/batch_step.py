"""A step of eight cars at once: their poles, then the forces of their dampers.

A pole is marched as its difference y from the place where the plates would hold it at rest, xi = y - (b_z/s) z:

    y' = s y + (b_c + b_z/s) z' + e f.

Small numbers alone are left of a car that rides over hills, so that single precision loses nothing. z' is a quadratic
over a step, from its ends and its mean. A damper force is f_n in the mean over step n, and where the damper stuck in
that step and in the last it is a line of the slope (f_n - f_(n-1))/h: of third order in the step. Sliding, it is
constant but for the curve of the damper, which acts in the mean of both ends. Forces answer the velocities at the end
of the step, by turns, each by the inverse of its own law (`vehicle.engines.reduced.batch_tables`).

This module imports numba at its head: it is loaded only by a run that compiles.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vehicle.compiler import OPTIONS, numba_module
from vehicle.engines.reduced.batch_layout import ELEMENT, LANES, Rows
from vehicle.engines.reduced.simd_vector import alike, below, combined, larger, load, loads, smaller, spread, store
from vehicle.model.laws.damper import friction_limit

numba = numba_module()

# Sums in the order of the source: a lane must not depend on how many poles its neighbours have.
EXACT = OPTIONS | {"fastmath": {"contract"}}


def part(function: Callable[..., Any]) -> Any:
    """A function of the march, put into it where it is called: it counts no references."""
    return numba.njit(no_cpython_wrapper=True, forceinline=True, _nrt=False, **EXACT)(function)


def section(function: Callable[..., Any]) -> Any:
    """A function that is called once for many samples: compiled once, by itself."""
    return numba.njit(no_cpython_wrapper=True, _nrt=False, **EXACT)(function)


TURNS = 2
"""Turns among the dampers: `vehicle.engines.reduced.batch_factors.LOOSEST` says what they leave."""


@part
def solve(t: Any, r: Rows, dampers: Any) -> None:
    """Damper velocities and forces of a step, from the velocities without its forces in the first rows of the room."""
    count = len(dampers)
    step, old = r.room + count, r.inputs
    nodes = r.pieces + 1
    width = 3 * nodes
    kept = step + count  # forces of the last step
    work = kept + count  # of each damper: nodes of the inverse law: arriving velocity, 1/length, force, rise of force
    for i in range(count):
        force = load(t, old + i)
        store(t, kept + i, force)
        stick = load(t, r.stick + i)
        own = load(t, r.gain + i * count + i) + stick * load(t, r.ramp + i * count + i)
        store(t, step + i, own)
        arriving = load(t, r.room + i) - own * load(t, r.hold + i)
        limit = load(t, r.limit + i)
        at, law = work + 4 * nodes * i, r.law + width * i
        for j in range(nodes):
            here = load(t, law + 3 * j + 1) + load(t, law + 3 * j + 2) * limit
            store(t, at + 4 * j, load(t, law + 3 * j) + own * here)
            store(t, at + 4 * j + 2, here)
        for j in range(r.pieces):
            store(t, at + 4 * j + 1, alike(ELEMENT(1.0)) / (load(t, at + 4 * j + 4) - load(t, at + 4 * j)))
            store(t, at + 4 * j + 3, load(t, at + 4 * j + 6) - load(t, at + 4 * j + 2))
        for j in range(count):
            arriving = arriving - load(t, r.stick + j) * load(t, r.ramp + i * count + j) * load(t, old + j)
        store(t, r.room + i, arriving)
    zero, one = alike(ELEMENT(0.0)), alike(ELEMENT(1.0))
    for turn in range(TURNS):
        for i in range(count):
            arriving = load(t, r.room + i)
            for j in range(count):
                if j != i:
                    row = i * count + j
                    other = load(t, r.gain + row) + load(t, r.stick + j) * load(t, r.ramp + row)
                    arriving = arriving + other * load(t, old + j)
            at, law = work + 4 * nodes * i, r.law + width * i
            force, hold = load(t, at + 2), load(t, law + 1)
            for j in range(r.pieces):
                share = (arriving - load(t, at + 4 * j)) * load(t, at + 4 * j + 1)
                share = smaller(larger(share, zero), one)
                force = force + load(t, at + 4 * j + 3) * share
                hold = hold + (load(t, law + 3 * j + 4) - load(t, law + 3 * j + 1)) * share
            store(t, r.velocity + i, arriving - load(t, step + i) * force)
            store(t, old + i, zero - force - load(t, r.hold + i))
            if turn == TURNS - 1:
                store(t, step + i, hold)
    for i in range(count):
        stick = load(t, r.stick + i)
        store(t, old + count + i, stick * (load(t, old + i) - load(t, kept + i)))
        store(t, r.hold + i, load(t, step + i))
        speed = load(t, r.velocity + i)
        stuck = below(larger(speed, zero - speed), load(t, r.full + i))
        store(t, r.stick + i, stuck * load(t, r.stuck + i))
        store(t, r.stuck + i, stuck)


@part
def advance(
    t: Any, r: Rows, x: Any, before: int, at: int, rates: Any, laws: Any, step: int, inputs: Any, dampers: Any
) -> None:
    """A step.

    Args:
        t, r, rates, laws, inputs, dampers: as of `vehicle.engines.reduced.batch_stepping.march`.
        x: states of samples; of the poles here.
        before, at: rows of those at the beginning and at the end of the step.
        step: number of the step.
    """
    count, plates = len(dampers), rates.shape[1] // 2
    size = len(inputs)
    pair_rows, real_rows = 2 + 2 * size + 2 * count, 1 + size + count
    for k in range(plates):
        store(t, r.inputs + 2 * count + k, alike(rates[step, k]))
        store(t, r.inputs + 2 * count + plates + k, alike(rates[step, plates + k]))
    for i in range(count):
        arriving = alike(ELEMENT(0.0))
        for k in range(plates):
            arriving = arriving + load(t, r.slip + i * plates + k) * alike(rates[step + 1, k])
        store(t, r.room + i, arriving)
        store(t, r.room + count + i, alike(ELEMENT(0.0)))
    u = loads(t, r.inputs, inputs)
    w, more = loads(t, r.room, dampers), loads(t, r.room + count, dampers)
    for p in range(r.pairs):
        row = p * pair_rows
        a, b, decay, turn = load(x, before + 2 * p), load(x, before + 2 * p + 1), load(t, row), load(t, row + 1)
        real = combined(t, row + 2, u, decay * a - turn * b)
        imaginary = combined(t, row + 2 + size, u, decay * b + turn * a)
        store(x, at + 2 * p, real)
        store(x, at + 2 * p + 1, imaginary)
        w = spread(t, row + 2 + 2 * size, real, w)
        more = spread(t, row + 2 + 2 * size + count, imaginary, more)
    for q in range(r.reals):
        row, place = r.real + q * real_rows, 2 * r.pairs + q
        real = combined(t, row + 1, u, load(t, row) * load(x, before + place))
        store(x, at + place, real)
        w = spread(t, row + 1 + size, real, w)
    for i in range(count):
        store(t, r.room + i, w[i] + more[i])
    if laws.shape[0] > 0:
        for i in range(count):
            # The velocity in the middle of the step, from those at the ends of the last one.
            now = load(t, r.velocity + i)
            store(t, r.limit + i, now + alike(ELEMENT(0.5)) * (now - load(t, r.earlier + i)))
            store(t, r.earlier + i, now)
            for lane in range(LANES):
                t[r.limit + i, lane] = friction_limit(laws[i, lane], t[r.limit + i, lane])
    solve(t, r, dampers)
