"""Checks of a run: size of the recording before it, finite values and energy balance after it."""

import numpy as np

from vehicle.digits import number
from vehicle.engines.simulation.recording import Energies, Recording
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.machine import physical_memory
from vehicle.mapped_table import release, size_in_memory

LARGEST = 1e8
"""Maximum value of a channel: forces of cars are below 1e6 N, accelerations below 1e5 m/s2."""

RESIDUAL_WARNED = 1e-2
"""Energy residual above which a run warns; the shipped inputs are between 1e-4 and 3e-4, a bump below 1e-3."""

RESIDUAL_FAILED = 5e-2
"""Energy residual above which a run fails: a level error of 2.5 % in all signals corresponds to it."""

ENERGY_ROUND_OFF = 1e-7
"""Energy residual [J] accepted in any run: round-off of the potential energy of the weight, 1e4 J."""

BALANCED_RATE = 100.0
"""Minimum sample rate [Hz] for an integration of the powers: the high input has a residual of 2e-4 from
samples at 1 kHz and of 1e-3 at this rate."""


def require_samples(samples: float, channels: int) -> None:
    """Reject a run with a recording of a single sample, or with one that exceeds the memory, before it starts.

    Memory: 8 bytes for every sample of every channel, at most half of the memory, unless they are in a file;
    evaluations work in blocks.

    Raises:
        ConfigurationError: the message contains the required and the available amount.
    """
    if samples < 1.0 - 1e-6:
        raise ConfigurationError(
            f"solver.record_rate: the signal lasts {number(samples, 2)} sampling intervals but must last at least 1; "
            "give a longer signal"
        )
    needed, there = size_in_memory(8.0 * samples * channels), physical_memory()
    if needed > 0.5 * there:
        raise ConfigurationError(
            f"solver.record_rate: {channels} channels of {samples:.3g} samples need {needed / 1e9:.3g} GB but may "
            f"need at most {0.5 * there / 1e9:.3g} GB, half the memory of this machine; lower the rate, record "
            "fewer channels, cut the record into parts, or free as much disk for temporary files (TMPDIR)"
        )


def require_finite(recording: Recording) -> None:
    """Reject a recording with a value that is not finite or above `LARGEST`.

    Raises:
        SimulationError: the message contains channel, time and value.
    """
    for name, values in recording.channels.items():
        # One pass over the channel: NaN and infinity fail the comparison too.
        if not -LARGEST < values.min() <= values.max() < LARGEST:
            bad = int(np.argmin(np.abs(values) < LARGEST))
            raise SimulationError(
                f"channel {name} is {values[bad]:.3g} {recording.units[name]} at t = {recording.time[bad]:.4f} "
                "s, impossible for a car; check the input and the parameters that you changed"
            )
        release(values)


def judge_energy(energies: Energies, rate: float, step: float) -> tuple[str, ...]:
    """Check the energy balance of a run and return warnings.

    The residual is relative to the larger of the work of the plates and the dissipated energy: plates that end lower
    than they began recover the work of lifting the car, and the sum may be near zero.

    Args:
        energies: energy balance of the run.
        rate: rate of the samples in the sums [Hz].
        step: time step of the run [s].

    Raises:
        SimulationError: the residual exceeds `RESIDUAL_FAILED`.
    """
    missing = abs(energies.work_in - energies.dissipated - energies.stored)
    work, lost = abs(energies.work_in), energies.dissipated
    residual = missing / max(work, lost, ENERGY_ROUND_OFF)
    if missing <= ENERGY_ROUND_OFF or residual <= RESIDUAL_WARNED:
        return ()
    whole = f"{lost:.3g} J dissipated" if lost > work else f"{energies.work_in:.3g} J put in by the plates"
    said = f"energy balance: {missing:.3g} J of {whole} are unaccounted for (residual {number(residual, 2)})"
    if rate < BALANCED_RATE:
        return (f"{said}; {rate:g} Hz is too low a sample rate to judge the balance",)
    smaller = f"--set solver.timestep={0.5 * step:g}"
    if residual > RESIDUAL_FAILED:
        raise SimulationError(
            f"{said}, must be at most {RESIDUAL_FAILED:g}: the time steps are too long for the force laws of "
            f"this car. Choose a smaller step, for example {smaller}, or check the parameters that you changed"
        )
    return (
        f"{said}, usually below {RESIDUAL_WARNED:g}; repeat the run with {smaller}: if the residual falls, the step "
        "was too long; if it stays, the balance lacks a work term, and the change of the channels is their error",
    )
