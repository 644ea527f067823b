"""Values of the figures of a ride, with their standard errors.

On a random road a figure of one record is an estimate. The standard error of an RMS is that of a Gaussian vibration
with the spectrum of the record (`vehicle.signals.analysis.comfort_error`); that of a share of time, or of a ratio of
two RMS values, comes from `BLOCKS` blocks of the record. Extremes, doses and values over one obstacle have none.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.runs.output.run_obstacle import settling_time
from vehicle.runs.targets.figure import QUANTITIES, SEAT, Figure
from vehicle.signals.analysis.comfort_error import overall_error
from vehicle.signals.analysis.exposure import vibration_dose_value
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.slip import slip_shares
from vehicle.signals.analysis.spectra import band_periodogram
from vehicle.signals.analysis.weighting import weighted_record

BLOCKS = 8
"""Blocks of a record for the standard error of a share or a ratio: 7 degrees of freedom."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Histories:
    """Time histories and static data of a run.

    Attributes:
        time: sampling times [s], (n,).
        of: returns the samples of a channel, (n,).
        unit: returns the unit of a channel.
        named: returns the channels with a name or words; raises `ConfigurationError` for none.
        skip: time at the beginning that is not evaluated [s].
        tyre_load: wheel to static tyre load [N].
        dampers: wheels with a damper.
        slip_velocity: minimum velocity of slip [m/s].
        left_obstacle: time at which the last wheel leaves an obstacle [s]; None without an obstacle.
        random: True for a random road, whose figures have standard errors.
    """

    time: Vector
    of: Callable[[str], Vector]
    unit: Callable[[str], str]
    named: Callable[[Sequence[str]], tuple[str, ...]]
    skip: float
    tyre_load: dict[str, float]
    dampers: tuple[str, ...]
    slip_velocity: float
    left_obstacle: float | None = None
    random: bool = False

    @property
    def step(self) -> float:
        """Return the sampling interval [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def evaluated(self) -> slice:
        """Return the evaluated samples."""
        return slice(round(self.skip / self.step), None)

    def stacked(self, channels: Sequence[str], weighting: str = "") -> Vector:
        """Return the evaluated samples of channels, weighted if asked for, (channels, n)."""
        rows = []
        for channel in channels:
            history = self.of(channel)
            if weighting:
                history = weighted_record(self.step, history, axis_weighting(weighting, channel))
            rows.append(history[self.evaluated])
        return np.stack(rows)


def axis_weighting(weighting: str, channel: str) -> str:
    """Return the weighting of a channel: itself, or that of its axis on a seat.

    Args:
        weighting: name of a weighting, or `SEAT`.
        channel: name of the channel, which ends with its axis.

    Raises:
        ConfigurationError: a seat weighting for a channel without an axis.
    """
    if weighting != SEAT:
        return weighting
    if channel[-2:] not in (f"_{axis}" for axis in AXES):
        raise ConfigurationError(f"weighting {SEAT!r}: {channel} has no axis x, y or z; set Wk or Wd")
    return "Wk" if channel.endswith("_z") else "Wd"


def value_of(figure: Figure, ride: Histories, *, checked: bool = False) -> tuple[float, float | None]:
    """Return the value of a figure on a run, and its standard error or None.

    Args:
        checked: True if the unit of the figure is known to be right.

    Raises:
        ConfigurationError: a channel or wheel is missing in the run, or the unit of the figure is wrong.
        DataError: the record is too short for the band.
    """
    definition = QUANTITIES[figure.quantity]
    channels = ride.named(figure.channels) if figure.channels else ()
    unit = definition.unit or ride.unit(channels[0])
    if not checked and figure.unit != unit:
        raise ConfigurationError(
            f"unit: found {figure.unit!r}, must be {unit!r} for {figure.quantity} of {channels or 'the car'}"
        )
    value, error = _VALUES[figure.quantity](figure, ride, channels)
    return value, error if ride.random else None


def _rms(figure: Figure, ride: Histories, channels: Sequence[str]) -> tuple[float, float | None]:
    return _rms_and_error(ride.stacked(channels, figure.weighting), figure, ride)


def _rms_and_error(rows: Vector, figure: Figure, ride: Histories) -> tuple[float, float]:
    """Return the RMS over all rows (channels, n), in the band of the figure if it has one, and its standard error."""
    lines = band_periodogram(ride.step, rows, _band(figure, ride)).lines
    assert lines is not None  # a periodogram
    square = np.sum(np.abs(lines) ** 2) if figure.band else np.sum(np.mean(rows**2, axis=1))
    return float(np.sqrt(square)), float(np.sqrt(square) * overall_error(lines[None])[0])


def _band(figure: Figure, ride: Histories) -> tuple[float, float]:
    """Return the band of a figure; by default all lines from the first to 0.8 of the Nyquist frequency."""
    samples = ride.time[ride.evaluated].size
    return (figure.band[0], figure.band[1]) if figure.band else (1.0 / (samples * ride.step), 0.4 / ride.step)


def _ratio(figure: Figure, ride: Histories, channels: Sequence[str]) -> tuple[float, float | None]:
    above, below = (ride.stacked(names, figure.weighting) for names in (channels, ride.named(figure.over)))
    band = _band(figure, ride)

    def ratio(part: slice) -> float:
        spectra = [band_periodogram(ride.step, rows[:, part], band) for rows in (above, below)]
        squares = [each.density.sum() * each.resolution_hz for each in spectra]
        return float(np.sqrt(squares[0] / squares[1])) if squares[1] else float("nan")

    return ratio(slice(None)), _of_blocks(ratio, above.shape[1])


def _of_blocks(value: Callable[[slice], float], samples: int) -> float:
    """Return the standard error of the mean of the values of `BLOCKS` blocks."""
    edges = np.linspace(0, samples, BLOCKS + 1).astype(int)
    values = [value(slice(begin, end)) for begin, end in pairwise(edges)]
    return float(np.std(values, ddof=1) / np.sqrt(BLOCKS))


def _peak(_: Figure, ride: Histories, channels: Sequence[str]) -> tuple[float, None]:
    return float(np.abs(ride.stacked(channels)).max()), None


def _peak_to_peak(_: Figure, ride: Histories, channels: Sequence[str]) -> tuple[float, None]:
    return float(np.ptp(ride.stacked(channels), axis=1).max()), None


def _dose(figure: Figure, ride: Histories, channels: Sequence[str]) -> tuple[float, None]:
    doses = [vibration_dose_value(ride.step, row) for row in ride.stacked(channels, figure.weighting)]
    return float(np.sum(np.power(doses, 4)) ** 0.25), None


def _settling(_: Figure, ride: Histories, channels: Sequence[str]) -> tuple[float, None]:
    if ride.left_obstacle is None:
        raise ConfigurationError('settling: the run has no obstacle; set it, for example obstacle = "cleat"')
    time = ride.time[ride.evaluated]
    times = [settling_time(time, row, ride.left_obstacle) for row in ride.stacked(channels)]
    # Not settled at the end of the record.
    return float("inf") if None in times else max(float(each or 0.0) for each in times), None


def _selected_wheels(figure: Figure, car_wheels: Sequence[str]) -> Sequence[str]:
    """Return the wheels of a figure; by default all."""
    if missing := [wheel for wheel in figure.wheels if wheel not in car_wheels]:
        raise ConfigurationError(f"wheels: found {', '.join(missing)}, must be among {', '.join(car_wheels)}")
    return figure.wheels or car_wheels


def _stick_share(figure: Figure, ride: Histories, _: Sequence[str]) -> tuple[float, float | None]:
    limit, shares = np.array([ride.slip_velocity]), {}
    for wheel in _selected_wheels(figure, ride.dampers):
        velocity = ride.of(f"damper_{wheel}_velocity")[None, ride.evaluated]
        shares[wheel] = (1.0 - float(slip_shares(velocity, limit)[0]), velocity)
    if not shares:
        raise ConfigurationError("stick_share: the car has no damper")
    share, velocity = max(shares.values(), key=lambda pair: pair[0])
    return share, _of_blocks(lambda part: float(slip_shares(velocity[:, part], limit)[0]), velocity.shape[1])


def _tyre_load(figure: Figure, ride: Histories, _: Sequence[str]) -> tuple[float, float | None]:
    wheels = _selected_wheels(figure, tuple(ride.tyre_load))
    loads = np.stack([ride.of(f"tyre_{wheel}_force_z")[ride.evaluated] / ride.tyre_load[wheel] for wheel in wheels])
    # The root of the mean over the wheels.
    return _rms_and_error((loads - 1.0) / np.sqrt(len(wheels)), figure, ride)


def _travel(figure: Figure, ride: Histories, _: Sequence[str]) -> tuple[float, None]:
    travels = [
        scipy.integrate.cumulative_trapezoid(ride.of(f"damper_{wheel}_velocity"), dx=ride.step, initial=0.0)
        for wheel in _selected_wheels(figure, ride.dampers)
    ]
    if not travels:
        raise ConfigurationError("travel: the car has no damper")
    return float(np.max(np.abs(travels)[:, ride.evaluated])), None


_VALUES = {
    "rms": _rms,
    "peak": _peak,
    "peak_to_peak": _peak_to_peak,
    "vdv": _dose,
    "settling": _settling,
    "ratio": _ratio,
    "stick_share": _stick_share,
    "tyre_load": _tyre_load,
    "travel": _travel,
}
"""Function of each kind of figure."""

if set(_VALUES) != set(QUANTITIES):
    raise ConfigurationError(
        f"figures: {', '.join(sorted(set(_VALUES) ^ set(QUANTITIES)))} is in one of two tables only; add it to "
        "QUANTITIES of vehicle/runs/targets/figure.py and to _VALUES of vehicle/runs/targets/values.py"
    )
