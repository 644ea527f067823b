"""Waveform of a test of a damper: sine, triangle, velocity steps or random motion, from its swings between reversals.

A swing is a half cycle of a sine if its displacement differs from that by at most `LIKE` of the swing (RMS); it is
straight if its mean velocities over the inner 50 % and 16 % of the travel are equal within `LIKE`: for a sine they
differ by 4 %, and a machine rounds the ends. Equal swings of equal duration are a periodic test, whose run-up and
run-down are left out; straight swings of different velocities are velocity steps.
"""

import itertools
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Indices, Mask, Vector
from vehicle.digits import number

FULL = 0.95
"""Minimum swing of a settled cycle, over the median swing: smaller swings at both ends are run-up and run-down."""

EQUAL = 0.05
"""Maximum relative standard deviation of swings, or of their durations, that count as equal."""

FEWEST, NAMED = 4, 2
"""Minimum number of equal swings of a periodic test, and of swings of a waveform that is named."""

LIKE = 0.02
"""Maximum relative deviation from a waveform: half of that between a sine and a straight swing."""

SAME_SPEED = 0.1
"""Maximum relative difference of two velocities of a step."""

NAMED_STEPS = 8
"""Maximum number of velocities that are listed."""


class Waveform(NamedTuple):
    """Waveform of a test."""

    words: str  # description, for example "sine, 1 Hz"
    periodic: bool  # True if all settled swings are equal and equally long
    steps: bool  # True for velocity steps
    settled: Mask  # True for the samples without run-up and run-down of equal swings; (n,)


def reversals(x: Vector, velocity: Vector, share: float = 0.1) -> Indices:
    """Return the samples before reversals with swings of at least a share of the stroke, and both ends."""
    smallest_swing = share * np.ptp(x)
    turns = [0]
    for at in np.flatnonzero(np.diff(np.sign(velocity)) != 0.0):
        if abs(x[at] - x[turns[-1]]) >= smallest_swing:
            turns.append(int(at))
    return np.array([*turns, x.size - 1])


def reversal_times(time: Vector, velocity: Vector, turns: Indices) -> Vector:
    """Return the times [s] at which the velocity is zero after the samples before reversals; ends as they are."""
    after = np.minimum(turns + 1, time.size - 1)
    rise = velocity[after] - velocity[turns]
    share = np.where((turns > 0) & (rise != 0.0), -velocity[turns] / np.where(rise, rise, 1.0), 0.0)
    return np.asarray(time[turns] + np.clip(share, 0.0, 1.0) * (time[after] - time[turns]))


def waveform_of(time: Vector, x: Vector, velocity: Vector) -> Waveform:
    """Return the waveform of a motion: times [s], displacements [m] and velocities [m/s]; all (n,)."""
    turns = reversals(x, velocity)
    swings = np.abs(np.diff(x[turns]))
    full = np.flatnonzero(swings >= FULL * np.median(swings))
    inner = turns[full[0] : full[-1] + 2]
    settled = np.ones(x.size, dtype=bool)
    if inner.size <= FEWEST or not _equal(np.abs(np.diff(x[inner]))):
        # The first and the last swing may be parts of swings.
        inner = turns[1:-1] if turns.size > NAMED + 2 else turns
    else:
        settled[: inner[0]] = settled[inner[-1] + 1 :] = False
    equal = _equal(np.abs(np.diff(x[inner])))
    times = reversal_times(time, velocity, inner)
    durations = np.diff(times)
    pieces = [(time[a : b + 1], x[a : b + 1]) for a, b in itertools.pairwise(inner)]
    shapes = [_shape(*piece, first, last) for piece, first, last in zip(pieces, times[:-1], times[1:], strict=True)]
    straight, sine = (sum(shape == name for shape in shapes) > 0.75 * len(shapes) for name in ("straight", "sine"))
    if len(shapes) < NAMED or not (straight or sine):
        return Waveform("random motion", False, False, np.ones(x.size, dtype=bool))
    periodic = equal and _equal(durations)
    if sine:
        rates = 0.5 / durations
        single = _equal(durations, NAMED)
        rate = number(float(np.mean(rates)), 2) if single else f"{number(rates.min(), 2)} to {number(rates.max(), 2)}"
        return Waveform(f"{'sine' if single else 'sine steps'}, {rate} Hz", periodic, False, settled)
    steps = _steps(np.array([_speed(*piece) for piece in pieces]))
    texts = [number(1e3 * speed, 3) for speed in steps]
    listed = ", ".join(texts) if len(texts) <= NAMED_STEPS else f"{texts[0]} to {texts[-1]}"
    single = len(steps) == 1
    return Waveform(f"{'triangle' if single else 'velocity steps'}, {listed} mm/s", periodic, not single, settled)


def _equal(values: Vector, fewest: int = FEWEST) -> bool:
    """True for `fewest` or more values that are equal within `EQUAL`."""
    return bool(values.size >= fewest and np.std(values) <= EQUAL * np.mean(values))


def _shape(time: Vector, x: Vector, first: float, last: float) -> str:
    """Return "straight", "sine" or "" for the displacements of a swing between two times of reversal [s]."""
    travel = (x - x[0]) / (x[-1] - x[0])
    sine = 0.5 - 0.5 * np.cos(np.pi * (time - first) / (last - first))
    if np.sqrt(np.mean((travel - sine) ** 2)) <= LIKE:
        return "sine"
    times = np.interp([0.25, 0.42, 0.58, 0.75], np.maximum.accumulate(travel), time)
    ratio = 0.16 / 0.5 * (times[3] - times[0]) / (times[2] - times[1])
    return "straight" if abs(ratio - 1.0) <= LIKE else ""


def _speed(time: Vector, x: Vector) -> float:
    """Return the mean velocity over the inner half of the travel of a swing [m/s]."""
    travel = np.maximum.accumulate((x - x[0]) / (x[-1] - x[0]))
    first, last = np.interp([0.25, 0.75], travel, time)
    return float(0.5 * abs(x[-1] - x[0]) / (last - first))


def _steps(speeds: Vector) -> list[float]:
    """Return the mean velocities of the steps [m/s], ascending."""
    ordered = np.sort(speeds)
    bounds = np.flatnonzero(np.diff(ordered) > SAME_SPEED * ordered[:-1]) + 1
    return [float(np.mean(group)) for group in np.split(ordered, bounds)]
