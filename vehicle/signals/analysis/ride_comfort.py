"""Comfort of runs under the two names of every table: `unweighted` and `weighted`, at the seat rail and on the cushion.

`unweighted` is the RMS of the accelerations in 2 to 50 Hz, sqrt(x^2 + y^2 + z^2) over the axes (Bommer 2006,
chapter 4); `weighted` is the RMS after the weightings of a seat, Wd for x and y, Wk for z (ISO 2631-1:1997, 6.1 and
6.5), with the same vector sum. A suffix _x, _y or _z is one axis. The prefix `seat_` is the cushion of a seat;
`seat_value` is the SEAT value. Reports, runs in Python, sweeps and searches take their values from `comfort_columns`.
"""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.names import AXES
from vehicle.signals.analysis.comfort import COMFORT_BAND, comfort_values
from vehicle.signals.analysis.comfort_error import WAVES, overall_error, overall_waves, paired, weighted_lines
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.exposure import vector_sum, weighted_rms
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.seat_value import seat_value, weighted_axes

UNWEIGHTED, WEIGHTED = "unweighted", "weighted"
"""The two names of comfort."""

SEAT_PREFIX, SEAT_VALUE = "seat_", "seat_value"
"""Prefix of the values on the cushion, and the name of the SEAT value."""

RIM = "steering_wheel_rim"
"""Name of the output on the rim of a steering wheel, whose accelerations have the weighting of a steering wheel."""

ISO_2631 = "ISO 2631-1"

ERROR = "_error"
"""Suffix of the relative standard error of `unweighted` or `weighted`, see `vehicle.signals.analysis.comfort_error`."""

PHASE = "_phase"
"""Suffix of what the phases of one road add to a value of the linear twin, see `vehicle.runs.car.run_twin`."""

EXPLAINED = "_explained"
"""Suffix of the share of the scatter that the linear twin explains, see `vehicle.signals.analysis.comfort_error`."""


def wave_names(name: str) -> tuple[str, ...]:
    """Return the names of a comfort value's C_m and of its phase wave, which are no columns of a table.

    Args:
        name: `UNWEIGHTED` or `WEIGHTED`, with the prefix of its point; for C_m see
            `vehicle.signals.analysis.comfort_error`.
    """
    return tuple(f"{name}_wave_{number}_{part}" for number in range(1, WAVES + 2) for part in ("re", "im"))


MEANING = {UNWEIGHTED: "RMS in 2 to 50 Hz", WEIGHTED: "RMS after the weightings of a seat (ISO 2631-1)"}
"""Name to its words on the console, in reports and figures."""


def comfort_units(*, seated: bool) -> dict[str, str]:
    """Return the name of each value of `comfort_columns` to its unit, without `wave_names`.

    Args:
        seated: True for a car with a seat: its cushion and the SEAT value are added.
    """
    units: dict[str, str] = {}
    for prefix in ("", SEAT_PREFIX) if seated else ("",):
        for name in (UNWEIGHTED, WEIGHTED):
            units |= dict.fromkeys((f"{prefix}{name}_{axis}" for axis in AXES), "m/s2") | {f"{prefix}{name}": "m/s2"}
    errors = (UNWEIGHTED, WEIGHTED, *([f"{SEAT_PREFIX}{WEIGHTED}"] if seated else []))
    return units | ({SEAT_VALUE: "-"} if seated else {}) | {f"{name}{ERROR}": "-" for name in errors}


def comfort_columns(
    time_step: float,
    rail: Vector,
    cushion: Vector | None = None,
    *,
    skip: float = 0.0,
    band: tuple[float, float] = COMFORT_BAND,
    names: Collection[str] = (UNWEIGHTED, WEIGHTED),
    contact: str = "seat",
    errors: bool = True,
    axes: bool = False,
) -> dict[str, Vector]:
    """Return the comfort values of r runs; the values of a run are bitwise independent of the other runs.

    Args:
        time_step: sampling interval [s].
        rail: accelerations of the seat rail in x, y, z [m/s2], (r, 3, n); the last sample closes the span.
        cushion: accelerations of the cushion [m/s2], (r, 3, n); None for a car without a seat.
        skip: excluded time at the beginning [s]; the filters of the weightings process it.
        band: band of the unweighted value [Hz].
        names: `UNWEIGHTED`, `WEIGHTED` or both.
        contact: point of contact at `rail`, see `vehicle.signals.analysis.evaluation`.
        errors: False leaves out the standard errors and `wave_names`.
        axes: add the standard errors and `wave_names` of each axis.

    Returns:
        Name to values, (r,) each: those of `comfort_units` with these names, and their `wave_names`. `seat_value` is
        NaN for a rail at rest.
    """
    end = evaluated_span(rail.shape[2], time_step, skip).stop
    rail = rail[:, :, :end]
    columns = _point(time_step, rail, skip, band, names, contact, errors, axes)
    if cushion is not None:
        cushion = cushion[:, :, :end]
        on_seat = {
            f"{SEAT_PREFIX}{name}": values
            for name, values in _point(time_step, cushion, skip, band, names, errors=errors).items()
        }
        kept = {*comfort_units(seated=True), *wave_names(f"{SEAT_PREFIX}{WEIGHTED}")}
        columns |= {name: values for name, values in on_seat.items() if name in kept}
        columns[SEAT_VALUE] = np.array(
            [
                seat_value(time_step, above[2], below[2], skip=skip).rms if np.any(below[2]) else np.nan
                for above, below in zip(cushion, rail, strict=True)
            ]
        )
    return columns


def _point(
    time_step: float,
    records: Vector,
    skip: float,
    band: tuple[float, float],
    names: Collection[str],
    contact: str = "seat",
    errors: bool = True,
    axes: bool = False,
) -> dict[str, Vector]:
    """Return the values at one point."""
    columns: dict[str, Vector] = {}
    if UNWEIGHTED in names:
        value = comfort_values(time_step, records[:, :, round(skip / time_step) :], band)
        columns |= {f"{UNWEIGHTED}_{axis}": value.axes[:, number] for number, axis in enumerate(AXES)}
        columns[UNWEIGHTED] = value.overall
        if errors:
            columns |= _errors(UNWEIGHTED, value.error, value.waves)
        if axes:
            columns |= _axis_errors(UNWEIGHTED, value.lines)
    if WEIGHTED in names:
        factors, rms, lines = application(contact).comfort_factors, [], []
        for xyz in records:
            rows = weighted_axes(time_step, xyz, contact=contact, skip=skip)
            each = [weighted_rms(row) for row in rows]
            rms.append((*each, vector_sum(each, factors)))
            if errors or axes:
                lines.append(weighted_lines(time_step, rows, (1.0, 1.0, 1.0)))
        columns |= {f"{WEIGHTED}_{axis}": values for axis, values in zip(AXES, np.array(rms).T, strict=False)}
        columns[WEIGHTED] = np.array(rms)[:, 3]
        if errors:
            all_axes = (np.array(factors)[:, None] * each[None] for each in lines)
            of_runs = [(overall_error(each)[0], overall_waves(each)[0]) for each in all_axes]
            columns |= _errors(WEIGHTED, *map(np.array, zip(*of_runs, strict=True)))
        if axes:
            columns |= _axis_errors(WEIGHTED, np.array(lines))
    return columns


def _axis_errors(name: str, lines: Complex) -> dict[str, Vector]:
    """Return errors and waves of the axes of a comfort value as columns; lines: (r, 3, m)."""
    columns: dict[str, Vector] = {}
    for number, axis in enumerate(AXES):
        row = lines[:, number : number + 1]
        columns |= _errors(f"{name}_{axis}", overall_error(row), overall_waves(row))
    return columns


def with_twins(columns: Mapping[str, Vector], twins: Mapping[str, Vector]) -> dict[str, Vector]:
    """Return comfort values of runs with the errors that their linear twins leave, and the `EXPLAINED` shares.

    Args:
        columns: values of `comfort_columns`.
        twins: values of the twins, with the `PHASE` on this road.
    """
    result = dict(columns)
    for name in (column.removesuffix(ERROR) for column in columns if column.endswith(ERROR)):
        value, error = columns[name], columns[f"{name}{ERROR}"]
        waves, of_twins = (waves_of(each, name) for each in (columns, twins))
        pair = paired(error * value, waves, of_twins, twins[f"{name}{PHASE}"])
        relative = np.divide(pair.error, value, out=np.zeros_like(value), where=value > 0.0)
        result |= _errors(name, relative, pair.waves) | {f"{name}{EXPLAINED}": pair.explained}
    return result


def waves_of(columns: Mapping[str, Vector], name: str) -> Complex:
    """Return the C_m of a comfort value from its columns; (r, `WAVES` + 1)."""
    parts = np.stack([columns[each] for each in wave_names(name)], axis=1)
    return np.asarray(np.ascontiguousarray(parts, dtype=np.float64).view(np.complex128))


def wave_columns(name: str, waves: Complex) -> dict[str, Vector]:
    """Return the columns of the waves of a comfort value, (r, `WAVES` + 1)."""
    # As reals, the complex values alternate real and imaginary parts, in the order of the names.
    return dict(zip(wave_names(name), waves.view(np.float64).T, strict=True))


def _errors(name: str, error: Vector, waves: Complex) -> dict[str, Vector]:
    """Return the columns of the error of a comfort value, (r,), and of its waves, (r, `WAVES` + 1)."""
    return {f"{name}{ERROR}": error, **wave_columns(name, waves)}


@dataclass(frozen=True, kw_only=True, slots=True)
class AxisRms:
    """RMS accelerations of a point by axis [m/s2]."""

    x: float
    y: float
    z: float
    overall: float
    """sqrt(x^2 + y^2 + z^2) [m/s2]"""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class PointComfort:
    """Comfort at one point, under the two names of `comfort_columns`.

    Attributes:
        point: words of the point, as "seat rail".
        unweighted: unweighted RMS in `band`.
        weighted: weighted RMS as on a seat (ISO 2631-1: Wd for x and y, Wk for z); on a steering wheel by Ws.
        standard: standard or publication of the weighting.
        band: band of the unweighted value [Hz].
    """

    point: str
    unweighted: AxisRms
    weighted: AxisRms
    band: tuple[float, float]
    standard: str = ISO_2631

    def __repr__(self) -> str:
        """Return a summary in one line."""
        low, high = self.band
        return (
            f"{self.point}: unweighted {self.unweighted.overall:.4g} m/s2 ({low:g} to {high:g} Hz), weighted "
            f"{self.weighted.overall:.4g} m/s2 ({self.standard})"
        )


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class RunComfort(PointComfort):
    """Comfort of a run at the seat rail; with a seat also on its cushion, and the SEAT value.

    Attributes:
        cushion: both values on the cushion; None for a car without a seat.
        seat_value: SEAT value [-]; None for a car without a seat, or a rail at rest.
        values: all values under their names in sweeps and searches, see `comfort_units`.
        errors: relative standard errors of values and axes [-], by the names "weighted", "weighted_x" and so on.
        explained: share of the scatter that the linear twin explains [-], by the same names; empty without a twin.
    """

    cushion: PointComfort | None
    seat_value: float | None
    values: Mapping[str, float]
    errors: Mapping[str, float]
    explained: Mapping[str, float]

    def __repr__(self) -> str:
        """Return a summary in one line."""
        text = PointComfort.__repr__(self)
        if self.cushion is not None:
            text += f"; {self.cushion!r}"
        return text if self.seat_value is None else f"{text}; SEAT {self.seat_value:.4g}"


def point_comfort(point: str, values: Mapping[str, float], band: tuple[float, float], prefix: str = "") -> PointComfort:
    """Return the comfort at a point from named values.

    Args:
        point: words of the point.
        values: values of `comfort_columns` of one run.
        band: band of the unweighted values [Hz].
        prefix: prefix of the names.
    """

    def axes(name: str) -> AxisRms:
        x, y, z = (values[f"{prefix}{name}_{axis}"] for axis in AXES)
        return AxisRms(x=x, y=y, z=z, overall=values[f"{prefix}{name}"])

    return PointComfort(point=point, unweighted=axes(UNWEIGHTED), weighted=axes(WEIGHTED), band=band)


def run_comfort(
    time_step: float,
    rail: Vector,
    cushion: Vector | None = None,
    *,
    skip: float,
    band: tuple[float, float],
    point: str = "seat rail",
    contact: str = "seat",
    twin: Mapping[str, Vector] | None = None,
) -> RunComfort:
    """Return the comfort of one run; arguments as in `comfort_columns`, with accelerations of (3, n).

    Args:
        time_step, skip, band: see `comfort_columns`.
        rail: accelerations of the seat rail [m/s2], (3, n).
        cushion: accelerations of the cushion [m/s2], (3, n), or None.
        point: words of the point of `rail`.
        contact: point of contact there, see `comfort_columns`.
        twin: values of the linear twin by `comfort_lines`; None without a twin.
    """
    above = None if cushion is None else cushion[None]
    columns = comfort_columns(time_step, rail[None], above, skip=skip, band=band, contact=contact, axes=True)
    if twin is not None:
        columns = with_twins(columns, twin)
    errors, explained = (
        {name.removesuffix(suffix): float(column[0]) for name, column in columns.items() if name.endswith(suffix)}
        for suffix in (ERROR, EXPLAINED)
    )
    values = {name: float(columns[name][0]) for name in comfort_units(seated=cushion is not None)}
    at_rail = point_comfort(point, values, band)
    seat = values.get(SEAT_VALUE, math.nan)
    return RunComfort(
        point=at_rail.point,
        unweighted=at_rail.unweighted,
        weighted=at_rail.weighted,
        band=band,
        standard=ISO_2631 if contact == "seat" else application(contact).standard,
        cushion=None if cushion is None else point_comfort("cushion", values, band, SEAT_PREFIX),
        seat_value=None if math.isnan(seat) else seat,
        values=values,
        errors=errors,
        explained=explained,
    )
