"""Reductions of time histories to one number for each run, with standard errors where they are known.

On a random road a figure of one record is an estimate. The standard error of an RMS is that of a Gaussian vibration
with the spectrum of the record (`vehicle.signals.analysis.comfort_error`); that of a share of time, or of a ratio of
two RMS values, comes from `BLOCKS` blocks of the record. A dose has one on a road that repeats, from its linear twin.
Extremes, travel, which drifts with friction, and values over one obstacle have none.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.runs.car import SATURATED_VELOCITY
from vehicle.runs.car.run_twin import TwinLines
from vehicle.runs.figures.figure import Details, Reduction, TwinValues, Values
from vehicle.runs.figures.rows import recorded, velocities, wheels_of
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.comfort_error import overall_error, overall_waves, power_waves
from vehicle.signals.analysis.comfort_lines import lines_of_share
from vehicle.signals.analysis.exposure import crest_factor, mtvv, vibration_dose_value
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.settled import settling_time
from vehicle.signals.analysis.slip import first_slips, slip_shares
from vehicle.signals.analysis.spectra import band_periodogram

BLOCKS = 8
"""Blocks of a record for the standard error of a share or a ratio: 7 degrees of freedom."""


def _band(details: Details, samples: int, step: float) -> tuple[float, float]:
    """Return the band of a figure; by default all lines from the first, whole, to 0.8 of the Nyquist frequency."""
    return (details.band[0], details.band[1]) if details.band else (0.5 / (samples * step), 0.4 / step)


def _rms(rows: Vector, details: Details, runs: Runs, squares: Callable[[Vector], Vector]) -> Values:
    """Return the root of a sum of mean squares with its standard error.

    Args:
        rows: histories, whose lines in the band, or all, give the error; (r, rows, n).
        squares: mean squares of histories without a band; (r,) of (r, rows, n).
    """
    value, error, waves = np.empty(len(rows)), [], []
    whole = squares(rows) if details.band is None else None
    for run, history in enumerate(rows):
        if details.band is None and not runs.errors:
            break
        lines = band_periodogram(runs.timestep, history, _band(details, rows.shape[2], runs.timestep)).lines
        assert lines is not None  # a periodogram
        if details.band is not None:
            value[run] = np.sqrt(np.sum(np.abs(lines) ** 2))
        error.append(overall_error(lines[None])[0])
        waves.append(overall_waves(lines[None])[0])
    value = value if whole is None else np.sqrt(whole)
    return Values(value, value * np.array(error), np.array(waves)) if runs.errors else Values(value)


def _rms_of_channels(rows: Vector, details: Details, runs: Runs) -> Values:
    return _rms(rows, details, runs, lambda each: np.sum(np.mean(each**2, axis=2), axis=1))


def _rms_of_wheels(rows: Vector, details: Details, runs: Runs) -> Values:
    # The root of the mean over the wheels.
    values = _rms(rows, details, runs, lambda each: np.mean(np.mean(each**2, axis=2), axis=1))
    return values if values.waves is None else values._replace(waves=values.waves / np.sqrt(rows.shape[1]))


def _of_lines(lines: Complex, details: Details, _: Runs, twin: TwinLines) -> TwinValues:
    """Return the root of a sum of mean squares of lines."""
    if details.band:
        lines = lines_of_share(twin.frequency, lines, (details.band[0], details.band[1]))
    value = np.sqrt(np.sum(np.abs(lines) ** 2, axis=(1, 2)))
    return TwinValues(value, overall_waves(lines), value)


def _of_lines_of_wheels(lines: Complex, details: Details, runs: Runs, twin: TwinLines) -> TwinValues:
    values, root = _of_lines(lines, details, runs, twin), np.sqrt(lines.shape[1])
    return TwinValues(*(each / root for each in values))


def _ratio(rows: Vector, details: Details, runs: Runs) -> Values:
    below = recorded(details.over, details.weighting, runs)
    band, step = _band(details, rows.shape[2], runs.timestep), runs.timestep

    def ratios(part: slice) -> Vector:
        squares = []
        for each in (rows, below):
            spectra = [band_periodogram(step, history[:, part], band) for history in each]
            squares.append(np.array([each.density.sum() * each.resolution_hz for each in spectra]))
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(squares[1] > 0.0, np.sqrt(squares[0] / squares[1]), np.nan)

    return Values(ratios(slice(None)), _of_blocks(ratios, rows.shape[2], runs))


def _of_blocks(values: Callable[[slice], Vector], samples: int, runs: Runs) -> Vector | None:
    """Return the standard error of the mean of the values of `BLOCKS` blocks, (r,)."""
    if not runs.errors:
        return None
    edges = np.linspace(0, samples, BLOCKS + 1).astype(int)
    blocks = [values(slice(begin, end)) for begin, end in pairwise(edges)]
    return np.asarray(np.std(blocks, axis=0, ddof=1) / np.sqrt(BLOCKS))


def _largest_crest(rows: Vector, *_: object) -> Values:
    crests = [[crest_factor(row) or np.nan for row in run] for run in rows]
    return Values(np.max(crests, axis=1))


def _dose(rows: Vector, _: Details, runs: Runs) -> Values:
    doses = [[vibration_dose_value(runs.timestep, row) for row in run] for run in rows]
    value = np.sum(np.power(doses, 4), axis=1) ** 0.25
    if runs.twin is None or not runs.errors:
        return Values(value)
    return Values(value, np.full(value.size, np.nan), power_waves(value, rows))


def _dose_of_lines(lines: Complex, _: Details, runs: Runs, __: TwinLines) -> TwinValues:
    """Return the dose of lines: their history over one period, and the mean over random phases.

    The lines P_k = |line|^2 of one channel with independent phases have E[a^4] = 3 (sum P_k)^2 - 3/2 sum P_k^2, three
    times s^4 for many lines, and VDV^4 = T E[a^4].
    """
    samples = runs.evaluated.stop - runs.evaluated.start
    whole = np.zeros((*lines.shape[:2], samples // 2 + 1), dtype=np.complex128)
    whole[:, :, 1 : lines.shape[2] + 1] = lines * (samples / np.sqrt(2.0))
    rows, duration = np.fft.irfft(whole, samples, axis=2), samples * runs.timestep
    value = (duration * np.sum(np.mean(rows**4, axis=2), axis=1)) ** 0.25
    power = np.abs(lines) ** 2
    fourth = 3.0 * np.sum(power, axis=2) ** 2 - 1.5 * np.sum(power**2, axis=2)
    return TwinValues(value, power_waves(value, rows), (duration * np.sum(fourth, axis=1)) ** 0.25)


def require_obstacle(_: object, __: object, left_obstacle: float | None) -> None:
    """Check that an input has an obstacle.

    Args:
        left_obstacle: time at which the last wheel leaves it [s]; None without one.

    Raises:
        ConfigurationError: no obstacle.
    """
    if left_obstacle is None:
        raise ConfigurationError("settling: the run has no obstacle; choose a road with one, for example cleat:20x50")


def _settling(rows: Vector, _: Details, runs: Runs) -> Values:
    require_obstacle(None, None, runs.left_obstacle)
    assert runs.left_obstacle is not None
    time, longest = runs.time[runs.evaluated], []
    for run in rows:
        times = [settling_time(time, row, runs.left_obstacle) for row in run]
        # Not settled at the end of the record.
        longest.append(float("inf") if None in times else max(float(each or 0.0) for each in times))
    return Values(np.array(longest))


def _shares(rows: Vector, limits: Vector) -> Vector:
    """Return the share of the time with |velocity| above a limit; limits and shares (r, dampers)."""
    return np.stack([slip_shares(rows[:, damper], limits[:, damper]) for damper in range(rows.shape[1])], axis=1)


def _limits(details: Details, runs: Runs) -> Vector:
    """Return the slip velocity of each damper of a figure [m/s]; (r, dampers)."""
    return runs.slip_velocities(wheels_of(details, runs.dampers, "damper"))


def _slip(rows: Vector, details: Details, runs: Runs) -> Values:
    limits = _limits(details, runs)
    error = _of_blocks(lambda part: np.mean(_shares(rows[:, :, part], limits), axis=1), rows.shape[2], runs)
    return Values(np.mean(_shares(rows, limits), axis=1), error)


def _stick(rows: Vector, details: Details, runs: Runs) -> Values:
    limits = _limits(details, runs)
    sticks = 1.0 - _shares(rows, limits)
    longest = np.arange(len(rows)), np.argmax(sticks, axis=1)
    chosen, limit = rows[longest], limits[longest]
    error = _of_blocks(lambda part: slip_shares(chosen[:, part], limit), rows.shape[2], runs)
    return Values(np.max(sticks, axis=1), error)


def _saturated(rows: Vector, *_: object) -> Values:
    return Values(np.mean(_shares(rows, np.full(rows.shape[:2], SATURATED_VELOCITY)), axis=1))


def _first_slip(_: Vector, details: Details, runs: Runs) -> Values:
    # Of the whole run, as in `summary.json`.
    whole, limits = velocities(details, runs), _limits(details, runs)
    each = [first_slips(runs.time, whole[:, damper], limits[:, damper]) for damper in range(whole.shape[1])]
    return Values(np.fmin.reduce(each))


RMS = Reduction(of=_rms_of_channels, page="rms", lines=_of_lines)
WHEEL_RMS = Reduction(of=_rms_of_wheels, page="wheel_rms", lines=_of_lines_of_wheels)
RATIO = Reduction(of=_ratio)
PEAK = Reduction(of=lambda rows, *_: Values(np.abs(rows).max(axis=(1, 2))), page="peak")
PEAK_TO_PEAK = Reduction(of=lambda rows, *_: Values(np.ptp(rows, axis=2).max(axis=1)), page="peak_to_peak")
LOWEST = Reduction(of=lambda rows, *_: Values(rows.min(axis=(1, 2))), page="lowest")
LARGEST_CREST = Reduction(of=_largest_crest, page="largest_crest")
MTVV = Reduction(
    of=lambda rows, _, runs: Values(np.array([max(mtvv(runs.timestep, row) for row in run) for run in rows]))
)
DOSE = Reduction(of=_dose, lines=_dose_of_lines)
SETTLING = Reduction(of=_settling)
SLIP = Reduction(of=_slip)
STICK = Reduction(of=_stick)
SATURATED = Reduction(of=_saturated)
FIRST_SLIP = Reduction(of=_first_slip)
