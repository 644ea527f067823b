"""Tyres that are not uniform: their run-out as a motion of the plates, and the velocity of their treads.

A run-out r(t) lifts one wheel like a plate, z + r, in series with the tyre; the slope of the road stays V tan(beta), or
z'/V without it. A rolling radius R + d gives the tread the velocity V d/R, as if the road moved back by it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.signals.excitation.force_lines import ForceLines
from vehicle.signals.excitation.signal import Signal

RunOut = tuple[tuple[str, tuple[float, ...], tuple[float, ...]], ...]
"""Wheels, each with the angular frequencies [rad/s] of its run-out and its coefficients on their histories [m]."""

LOWEST_SAMPLING = 5.0
"""Lowest sampling rate of a signal over the frequency of a run-out: a cubic spline of five points a turn has a
velocity 1 % wrong."""


def run_out(forces: Sequence[PlacedForce]) -> RunOut:
    """Return the run-outs of the tyres among some forces; empty at standstill."""
    run_outs = []
    for force in forces:
        if force.unit == "m" and force.harmonics:
            lines = ForceLines(tuple(sorted(force.harmonics)))
            run_outs.append(
                (force.tyre, lines.frequencies, tuple(lines.coefficients(dict(force.harmonics.items())).tolist()))
            )
    return tuple(run_outs)


def with_plates(signal: Signal, wheels: Iterable[str]) -> Signal:
    """Return a signal that has a plate at rest under each of some wheels that it does not drive."""
    resting = dict.fromkeys((wheel for wheel in wheels if wheel not in signal.displacement), np.zeros(signal.time.size))
    if not resting:
        return signal
    slopes, profile = (({**of, **resting} if of else of) for of in (signal.slope_velocity, signal.profile))
    return replace(signal, displacement={**signal.displacement, **resting}, slope_velocity=slopes, profile=profile)


@lru_cache(maxsize=4)
def with_run_out(signal: Signal, run_outs: RunOut) -> Signal:
    """Return the motion of the road as the tyres take it: with their run-out, and with the slope of the road alone.

    Raises:
        ConfigurationError: the samples of the signal are too far apart for the run-out.
    """
    if not run_outs:
        return signal
    signal = with_plates(signal, [wheel for wheel, _, _ in run_outs])
    displacement = dict(signal.displacement)
    slopes = signal.slope_velocity or signal.plate_motion(signal.time).velocity
    for wheel, frequencies, coefficients in run_outs:
        rate, highest = 1.0 / signal.timestep, max(frequencies) / (2.0 * np.pi)
        if rate < LOWEST_SAMPLING * highest:
            raise ConfigurationError(
                f"the signal {signal.source} has {rate:g} samples a second, too few for a run-out of {highest:.4g} Hz; "
                f"set at least {LOWEST_SAMPLING * highest:.0f} Hz"
            )
        displacement[wheel] = displacement[wheel] + ForceLines(frequencies).values(signal.time) @ coefficients
    return replace(signal, displacement=displacement, slope_velocity=slopes)


def tread_motion(
    forces: Sequence[PlacedForce], wheels: Sequence[str], step: float, first: int, count: int
) -> tuple[Vector, Vector]:
    """Return velocities of the treads in some steps [m/s], and their changes over it [m/s2]; (count, w) each.

    Both are those of MuJoCo's velocities: the mean over the past step, and the difference of the means of two steps.
    They have no columns if no rolling radius varies.

    Args:
        forces: applied forces.
        wheels: names of the wheels.
        step: time step [s].
        first, count: first of the steps, and their number.
    """
    treads = [force for force in forces if force.unit == "m/s" and force.harmonics]
    if not treads:
        return np.zeros((count, 0)), np.zeros((count, 0))
    lines = ForceLines(tuple(sorted({frequency for force in treads for frequency in force.harmonics})))
    by_wheel = np.zeros((len(lines), len(wheels)))
    for force in treads:
        by_wheel[:, wheels.index(force.tyre)] += lines.coefficients(dict(force.harmonics.items()))
    # One mean more than steps, for the differences.
    starts: Vector = step * np.arange(first - 1.0, first + count)
    means = lines.means(starts, step) @ by_wheel
    return means[:-1], np.diff(means, axis=0) / step
