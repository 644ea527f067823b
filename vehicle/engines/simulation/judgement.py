"""What a finished run says about itself: whether its numbers are numbers, and whether its energy balance closes."""

from __future__ import annotations

import os

import numpy as np

from vehicle.engines.simulation.recording import Energies, Recording
from vehicle.errors import ConfigurationError, SimulationError

LARGEST = 1e8
"""Largest value of a channel: forces of cars are below 1e6 N, accelerations below 1e5 m/s2."""

RESIDUAL_WARNED = 1e-2
"""Energy residual above which a run warns; the shipped inputs are between 1e-4 and 3e-4, a bump below 1e-3."""

RESIDUAL_FAILED = 5e-2
"""Energy residual above which a run fails: a level that is 2.5 % wrong everywhere would give it."""

ENERGY_ROUND_OFF = 1e-7
"""Energy [J] that may be missing in any run: round-off of the weight's potential energy, 1e4 J, over many sums."""

BALANCED_RATE = 100.0
"""Rate of the samples [Hz] from which their powers can be integrated: the high input has a residual of 2e-4 from
samples at 1 kHz and of 1e-3 at this rate."""


def require_samples(samples: float, channels: int) -> None:
    """Refuse a run whose recording would be a single sample, or would not fit into this machine, before it begins.

    Memory: every sample of every channel, 8 bytes; what is computed from them goes by blocks. Half the machine at most.

    Raises:
        ConfigurationError: naming what is needed and what there is.
    """
    if samples < 1.0 - 1e-6:
        raise ConfigurationError(
            f"solver.record_rate: the signal ends after {samples:.2g} of an interval between two recorded samples, "
            "needed is 1; give a longer signal"
        )
    needed, there = 8.0 * samples * channels, os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    if needed > 0.5 * there:
        raise ConfigurationError(
            f"solver.record_rate: {channels} channels of {samples:.3g} samples need {needed / 1e9:.3g} GB, allowed is "
            f"half the memory of this machine, {0.5 * there / 1e9:.3g} GB; lower the rate, or cut the record into parts"
        )


def require_finite(recording: Recording) -> None:
    """Refuse a recording with a value that is no number, or beyond every car.

    Raises:
        SimulationError: naming the channel, the time and the value.
    """
    for name, values in recording.channels.items():
        # One pass over the channel: NaN and infinity fail the comparison too.
        if not -LARGEST < values.min() <= values.max() < LARGEST:
            bad = int(np.argmin(np.abs(values) < LARGEST))
            raise SimulationError(
                f"channel {name} is {values[bad]:.3g} {recording.units[name]} at t = {recording.time[bad]:.4f} s: the "
                "car does not hold this motion; check the input and the parameters that you changed"
            )


def judge_energy(energies: Energies, rate: float) -> tuple[str, ...]:
    """Sentences about the energy balance of a run.

    What is missing counts against the work of the plates or what was dissipated, whichever is more: plates that end
    lower than they began take back the work of lifting the car, and the sum may be next to nothing.

    Args:
        energies: the balance.
        rate: of the samples that it was summed from [Hz].

    Returns:
        Warnings.

    Raises:
        SimulationError: more than `RESIDUAL_FAILED` of the work is missing.
    """
    missing = abs(energies.work_in - energies.dissipated - energies.stored)
    work, lost = abs(energies.work_in), energies.dissipated
    residual = missing / max(work, lost, ENERGY_ROUND_OFF)
    if missing <= ENERGY_ROUND_OFF or residual <= RESIDUAL_WARNED:
        return ()
    whole = f"{lost:.3g} J dissipated" if lost > work else f"{energies.work_in:.3g} J put in by the plates"
    said = f"energy residual {residual:.2g}: of {whole} {missing:.3g} J are unaccounted for"
    if rate < BALANCED_RATE:
        return (f"{said}; it is summed from samples at {rate:g} Hz, too few to judge the run by",)
    if residual > RESIDUAL_FAILED:
        raise SimulationError(
            f"{said}, allowed are {RESIDUAL_FAILED:g}: the integration does not hold the laws of this car. Reduce "
            "solver.timestep, or check the parameters that you changed"
        )
    return (f"{said} (up to {RESIDUAL_WARNED:g} is usual); check the run with half its solver.timestep",)
