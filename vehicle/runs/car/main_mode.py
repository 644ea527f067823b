"""Mode of the car with the largest part in the motion of a run."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.drawing.rendering.mode_inset import BesideMode
from vehicle.engines.linear.car_modes import Mode
from vehicle.engines.linear.mode_shares import ModeShares, mode_shares
from vehicle.engines.simulation.recording import Recording
from vehicle.errors import ConfigurationError
from vehicle.mapped_table import release
from vehicle.runs.car.run import FRF_BAND, Run
from vehicle.signals.analysis.record_lines import RecordLines

CHANNEL = "seat_rail_acc_z"
"""Acceleration whose modes are compared."""

WORKS = 0.25
"""Minimum share of the time in slip of a sliding damper."""


@dataclass(frozen=True, slots=True)
class Lines:
    """Plates of a run at spectral lines."""

    frequency: Vector  # [Hz]; (m,)
    plates: Complex  # complex amplitudes of the plate displacements [m]; (w, m)


@dataclass(frozen=True, kw_only=True, slots=True)
class MainMode:
    """Mode of the linear car, and its share in the recorded `CHANNEL` of a run; see `as_measured`."""

    mode: Mode
    share: float | None  # [-]; None for a run without the channel, or with plates at rest
    damper: str  # "stuck" or "sliding", the state during most of the run


def plate_lines(
    recording: Recording, wheels: Sequence[str], evaluated: slice, band: tuple[float, float], limit: int | None = None
) -> Lines | None:
    """Return the lines of the periodogram of the plates in a band; None without plates.

    Args:
        recording: recording of the run.
        wheels: wheels of the plates, all of the car.
        evaluated: evaluated samples.
        band: frequencies [Hz].
        limit: about the maximum number of lines, evenly chosen; all by default.
    """
    names = [f"plate_{wheel}_displacement" for wheel in wheels]
    if not all(name in recording.channels for name in names):
        return None
    frequency = np.fft.rfftfreq(recording.time[evaluated].size, recording.timestep)
    inside = np.flatnonzero((frequency >= band[0]) & (frequency <= band[1]))
    first, step = int(inside[0]) if inside.size else 0, max(inside.size // limit, 1) if limit else 1
    spectra = _windowed_lines([recording[name][evaluated] for name in names], first, first + inside.size)
    return Lines(np.asarray(frequency[inside[::step]], dtype=float), spectra[:, ::step])


def _windowed(row: Vector, mean: float, window: Vector, part: slice) -> Vector:
    """Return a part of a record without its mean under a window."""
    return window[part] * (row[part] - mean)


def _windowed_lines(rows: Sequence[Vector], first: int, last: int) -> Complex:
    """Return the lines from first to last, excluded, of records without their mean under a Hann window."""
    transform, window = RecordLines(rows[0].size, first, last), np.hanning(rows[0].size)
    lines = np.empty((len(rows), last - first), dtype=np.complex128)
    for row, of_row in zip(rows, lines, strict=True):
        of_row[:] = transform.of(partial(_windowed, row, float(row.mean()), window))
        release(row)
    return lines


def mode_of(modes: Sequence[Mode], shares: ModeShares, at: int) -> Mode | None:
    """Return the mode of a pole; None if it is not among these modes."""
    natural = abs(shares.poles[at]) / (2.0 * np.pi)
    mode = min(modes, key=lambda other: abs(other.frequency - natural), default=None)
    return mode if mode is not None and abs(mode.frequency - natural) < 1e-6 * natural else None


def as_measured(run: Run, lines: Lines, *, stuck: bool) -> ModeShares:
    """Return the shares of the modes in `CHANNEL` at its recorded level.

    The linear car, without friction, moves too far in some modes. At each line its plates are therefore scaled by
    |A| / |a|, with the recorded acceleration A and that of the linear car a.

    Args:
        run: the run.
        lines: lines of its plates.
        stuck: True for locked dampers.
    """
    system, values = run.car.matrices.system, run[CHANNEL][run.evaluated]
    linear = np.abs(mode_shares(system, CHANNEL, lines.frequency, lines.plates, stuck=stuck).acceleration)
    first = round(float(lines.frequency[0]) * values.size * run.recording.timestep)
    recorded = np.abs(_windowed_lines([values], first, first + lines.frequency.size)[0])
    scale = np.divide(recorded, linear, out=np.zeros_like(linear), where=linear > 0.0)
    return mode_shares(system, CHANNEL, lines.frequency, scale * lines.plates, stuck=stuck)


def main_mode(run: Run, frequency: float | None = None) -> MainMode:
    """Return the mode with the largest share in the vertical acceleration of the seat rail, 1 to 50 Hz, or another.

    The dampers of the linear car are in the state of most of the run, stuck or sliding.

    Args:
        run: the run.
        frequency: take the mode nearest to this frequency [Hz]; by default, that with the largest share, or the lowest
            mode of a car at rest.

    Raises:
        ConfigurationError: the car has no mode.
    """
    car, vehicle = run.car, run.car.vehicle
    slip = max((run.slip_share(wheel) for wheel in vehicle.damped_wheels), default=0.0)
    damper = "sliding" if slip > WORKS else "stuck"
    modes = [mode for mode in car.modes(damper) if not mode.grows]
    system = car.matrices.system
    lines = plate_lines(run.recording, system.inputs, run.evaluated, run.signal.band(FRF_BAND))
    by_mode: dict[float, float] = {}
    if lines is not None and np.any(lines.plates) and CHANNEL in run.channels:
        shares = as_measured(run, lines, stuck=damper == "stuck")
        for at, share in enumerate(shares.shares):
            if (mode := mode_of(modes, shares, at)) is not None:
                by_mode[mode.frequency] = float(share)
    if frequency is None and max(by_mode.values(), default=0.0) > 0.0:
        chosen = max(modes, key=lambda mode: by_mode.get(mode.frequency, 0.0))
    else:
        chosen = nearest(modes, frequency or 0.0)
    return MainMode(mode=chosen, share=by_mode.get(chosen.frequency), damper=damper)


def beside(run: Run, frequency: float | None = None) -> BesideMode:
    """Return a mode for the film of a run; see `main_mode`."""
    main = main_mode(run, frequency)
    of_seat_rail = "of the seat rail's vertical acceleration"
    share = [] if main.share is None else [f"share {of_seat_rail}: {100.0 * main.share:.0f} %"]
    return BesideMode(mode=main.mode, words=[*share, f"linear car, dampers {main.damper}"])


def nearest(modes: Sequence[Mode], frequency: float) -> Mode:
    """Return the mode whose natural frequency [Hz] is nearest; unstable motions are left out.

    Raises:
        ConfigurationError: the car has no mode.
    """
    swinging = [mode for mode in modes if mode.frequency > 0.0 and not mode.grows]
    if not swinging:
        raise ConfigurationError(
            f"this car has no mode up to 60 Hz, so {frequency:g} Hz cannot select one; leave out the frequency"
        )
    return min(swinging, key=lambda mode: abs(mode.frequency - frequency))
