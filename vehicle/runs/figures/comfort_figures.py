"""Comfort at the seat rail and on the cushion as figures; the values are those of `ride_comfort.comfort_columns`."""

import numpy as np

from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car.run_twin import TwinLines
from vehicle.runs.figures.figure import Details, Figure, Reduction, TwinValues, Values
from vehicle.runs.figures.rows import unread
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.comfort_error import wave_error
from vehicle.signals.analysis.comfort_lines import comfort_lines
from vehicle.signals.analysis.ride_comfort import (
    ERROR,
    SEAT_PREFIX,
    SEAT_VALUE,
    UNWEIGHTED,
    WEIGHTED,
    comfort_units,
    waves_of,
)
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.seat_value import seat_value

POINTS = {"": "seat_rail", SEAT_PREFIX: "seat"}
"""Prefix of a comfort value to its point."""


def _channels(*points: str) -> tuple[str, ...]:
    return tuple(f"{point}_acc_{axis}" for point in points for axis in AXES)


def _comfort(point: str, name: str) -> Reduction:
    """Return the reduction to a comfort value, overall or of an axis."""

    def of(_: Vector, details: Details, runs: Runs) -> Values:
        columns = runs.comfort(point, name)
        column = f"{name}_{details.axis}" if details.axis else name
        if not runs.errors:
            return Values(columns[column])
        return Values(columns[column], columns[column] * columns[f"{column}{ERROR}"], waves_of(columns, column))

    def lines(_: Complex, details: Details, runs: Runs, twin: TwinLines) -> TwinValues:
        columns = _of_twin(point, name, runs, twin)
        column = f"{name}_{details.axis}" if details.axis else name
        return TwinValues(columns[column], waves_of(columns, column), columns[column])

    return Reduction(of=of, lines=lines, page="comfort" if (point, name) == ("seat_rail", WEIGHTED) else "")


def _of_twin(point: str, name: str, runs: Runs, twin: TwinLines) -> dict[str, Vector]:
    lines = np.stack([twin.channels[f"{point}_acc_{axis}"] for axis in AXES], axis=1)
    return comfort_lines(twin.frequency, lines, band=runs.band, names=[name], axes=True)


def _seat_value(_: Vector, __: Details, runs: Runs) -> Values:
    above, below = (runs[name][:, : runs.evaluated.stop] for name in ("seat_acc_z", "seat_rail_acc_z"))
    values = [
        seat_value(runs.timestep, cushion, rail, skip=runs.skip).rms if np.any(rail) else np.nan
        for cushion, rail in zip(above, below, strict=True)
    ]
    value = np.array(values)
    if not runs.errors:
        return Values(value)
    waves = value[:, None] * _ratio_waves(*(runs.comfort(point, WEIGHTED) for point in ("seat", "seat_rail")))
    return Values(value, wave_error(waves), waves)


def _ratio_waves(*points: dict[str, Vector]) -> Complex:
    """Return the waves of the ratio of two weighted values over the ratio: d(a/b)/(a/b) = da/a - db/b."""
    name = f"{WEIGHTED}_z"
    with np.errstate(divide="ignore", invalid="ignore"):
        above, below = (waves_of(columns, name) / columns[name][:, None] for columns in points)
    return np.asarray(above - below)


def _seat_lines(_: Complex, __: Details, runs: Runs, twin: TwinLines) -> TwinValues:
    cushion, rail = (_of_twin(point, WEIGHTED, runs, twin) for point in ("seat", "seat_rail"))
    with np.errstate(divide="ignore", invalid="ignore"):
        value = cushion[f"{WEIGHTED}_z"] / rail[f"{WEIGHTED}_z"]
    return TwinValues(value, value[:, None] * _ratio_waves(cushion, rail), value)


def _figure(prefix: str, name: str, meaning: str) -> Figure:
    """Return the figure of a comfort value at a point."""
    point = POINTS[prefix]

    def channels(_: Details, __: Vehicle) -> tuple[str, ...]:
        # With the rail, as in a table of comfort.
        return _channels("seat_rail", "seat") if prefix else _channels("seat_rail")

    return Figure(
        words=f"{name} acceleration {'on the cushion' if prefix else 'at the seat rail'}",
        meaning=meaning,
        unit="m/s2",
        reads=unread(channels),
        reduces=_comfort(point, name),
        takes=("axis",),
        of_car="seat" if prefix else "",
    )


COMFORT_FIGURES = {
    UNWEIGHTED: _figure("", UNWEIGHTED, "unweighted RMS of the seat rail, 2 to 50 Hz, all axes [m/s2]"),
    WEIGHTED: _figure("", WEIGHTED, "weighted RMS of the seat rail (ISO 2631-1), all axes [m/s2]"),
    f"{SEAT_PREFIX}{UNWEIGHTED}": _figure(
        SEAT_PREFIX, UNWEIGHTED, "unweighted RMS of the cushion, 2 to 50 Hz, all axes [m/s2]"
    ),
    f"{SEAT_PREFIX}{WEIGHTED}": _figure(
        SEAT_PREFIX, WEIGHTED, "weighted RMS of the cushion (ISO 2631-1), all axes [m/s2]"
    ),
    SEAT_VALUE: Figure(
        words="SEAT value",
        meaning="weighted RMS of the cushion divided by that of the seat rail, vertical (ISO 10326-1) [-]",
        unit=comfort_units(seated=True)[SEAT_VALUE],
        reads=unread(lambda *_: _channels("seat_rail", "seat")),
        reduces=Reduction(of=_seat_value, lines=_seat_lines),
        of_car="seat",
    ),
}
"""Name to figure."""
