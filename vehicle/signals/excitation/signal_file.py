"""Read plate signals from files, with all checks, and write them."""

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError, OutputError
from vehicle.names import CORNERS, in_order, is_wheel
from vehicle.replacement import replaced_file
from vehicle.signals.excitation.chosen_plates import WHEEL_REMEDY, chosen_plates
from vehicle.signals.excitation.plausibility import ImplausibleError, aliasing_notices, check_level, drifts
from vehicle.signals.excitation.rest import start_from_rest
from vehicle.signals.excitation.signal import MINIMUM_SAMPLES, Signal, is_event, uniform_time
from vehicle.signals.excitation.time_grid import FINE_RATE, LOWEST_RATE, SMOOTH_RATE, check_rate, fill_missing
from vehicle.signals.formats.clock import (
    UNIFORM_TOLERANCE,
    check_increasing,
    check_stamps,
    check_uniform,
    clock_options,
    is_uniform,
    without_rounding,
)
from vehicle.signals.formats.csv_table import write_table
from vehicle.signals.formats.reader import is_table
from vehicle.signals.formats.table import TIME, USABLE, Header, Table, Wanted, name_and_unit
from vehicle.signals.formats.table_file import read_table
from vehicle.signals.formats.units import find_unit
from vehicle.signals.records.channel_findings import channel_findings
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.plate_offset import without_offsets
from vehicle.signals.records.resampled import resampled

NEEDED = "'time [s]' and 'displacement [m]' (or 'displacement_fr [m]', 'displacement_fl [m]'); [mm] is accepted"

_LENGTH_UNITS = {"m": 1.0, "mm": 1e-3}
_OTHER_QUANTITY = re.compile(r"(^|_)(acc|vel)|^[av](_|$)", re.IGNORECASE)
_WHEEL_COLUMN = re.compile(r"displacement_(\w+)|plate_(\w+)_displacement")
_OF_ROAD = re.compile(r"(?:road|slope)_(\w+)")
"""Columns that `python -m vehicle road` writes beside those of the plates, which do not drive the car."""
_OTHER_UNIT = re.compile(r"m?m/s(2|\^2|²)?|g")


class ForeignTableError(DataError):
    """Text table whose first line names no time and no plate, for example an export with lines above its header."""


def read_signal(
    path: str | Path,
    *,
    wheel: str | None = None,
    interpolate: bool = False,
    remove_mean: bool = False,
    accept_implausible: bool = False,
    choice: Choice | None = None,
) -> Signal:
    """Read plate displacements from a file; reject bad data, and report unusual data in `notices`.

    Columns `time [s],displacement [m]` (or `[mm]`; or `displacement_fr [m]`, `displacement_fl [m]`), one row per sample
    at uniform times; or the plates in the `time.csv` or `time.npz` of a run. Times are shifted to begin at 0. A record
    that does not begin at rest gets a half-cosine ramp.

    Args:
        path: measurement file of any format of `vehicle.signals.formats`.
        wheel: wheel that a plain `displacement` column drives, as `car.vehicle.shaker_wheel`; None if the columns
            name their wheels.
        interpolate: fill missing displacements by a cubic spline over gaps up to 10 ms.
        remove_mean: subtract the mean of each column.
        accept_implausible: accept levels and accelerations above those of a shaker (roads), with a notice.
        choice: channels of a measurement file, and preprocessing; None, or a resampling rate only, for the columns
            above.

    Returns:
        Signal with a notice on each change of the data.

    Raises:
        ConfigurationError: unknown file, unknown wheel, or a resampling rate out of range.
        DataError: bad data; the message names file, line, column, value, limit and remedy.
    """
    path = Path(path)
    if wheel is not None and not is_wheel(wheel):
        raise ConfigurationError(f"wheel {wheel!r} is unknown; must be one of {', '.join(CORNERS.values())}")
    resample = None if choice is None else choice.resample
    if resample is not None and not LOWEST_RATE <= resample < np.inf:
        raise ConfigurationError(f"--resample {resample:g} Hz: must be at least {LOWEST_RATE:g} Hz")
    wanted = Wanted(
        needed=NEEDED,
        key=lambda header: plate_columns(header, wheel)["time"][0],
        missing="fill" if interpolate else "refuse",
        remedy="correct the cell, or add --interpolate",
    )
    is_plain_table = (choice is None or choice == Choice(resample=resample)) and is_table(path)
    try:
        table, band_rate = (
            (read_table(path, wanted), math.inf) if is_plain_table else chosen_plates(path, choice, wheel)
        )
    except ForeignTableError as error:
        try:
            table, band_rate = chosen_plates(path, choice, None)
        except DataError:
            raise error from None
        is_plain_table = False
    plates = plate_columns(table.header, wheel)
    del plates["time"]
    units = {driven: unit for driven, (_, unit) in plates.items()}
    cells = [table.header.cells[column] for column, unit in plates.values() if unit == "mm"]
    notices = [*table.notices, *(f"column {cell!r} converted from mm to m" for cell in cells)]
    time = table.values[:, table.key]
    if time.size < MINIMUM_SAMPLES:
        raise DataError(f"{path}: has {time.size} rows, but at least {MINIMUM_SAMPLES} are needed; use a longer record")
    check_stamps(path, time)
    check_increasing(table, time)
    columns = {}
    for driven, (column, unit) in plates.items():
        values, filled = fill_missing(table, time, column)
        if table.header.cells[column].startswith("plate_") and not np.ptp(values) > 0.0:
            continue  # a run also records the plates that it did not drive
        notices.extend(filled)
        columns[driven] = values * _LENGTH_UNITS[unit]
    if is_plain_table:  # otherwise checked by `choose`
        notices.extend(channel_findings(path, time, columns, dict.fromkeys(columns, "m")))
    timestep, columns, recorded, grid_notices = _uniform_columns(table, time, columns, resample)
    notices.extend(grid_notices)
    band_rate = min(band_rate, recorded)
    notices.extend(check_rate(path, band_rate))
    if time[0] != 0.0:
        notices.append(f"time begins at {time[0]:.9g} s in the file and was shifted to 0")
    if remove_mean:
        for driven, displacement in columns.items():
            mean = 1e3 * np.mean(displacement)
            notices.append(f"mean {mean:.3g} mm of plate {driven} was subtracted, as requested")
            columns[driven] = displacement - np.mean(displacement)
    columns, offsets = without_offsets(columns)
    notices.extend(offsets)
    if not any(np.ptp(displacement) > 0.0 for displacement in columns.values()):
        raise DataError(f"{path}: no plate moves: all columns are constant; use a record with motion")
    notices.extend(drifts({driven: z for driven, z in columns.items() if not is_event(z)}))
    try:
        notices.extend(check_level(path, columns, timestep, units if is_plain_table else dict.fromkeys(units, "")))
    except ImplausibleError as error:
        if not accept_implausible:
            raise
        notices.append(f"accepted on request: {error.observation}")
    columns, ramped = start_from_rest(columns, timestep=timestep)
    samples = next(iter(columns.values())).size
    return Signal(
        time=uniform_time(samples=samples, timestep=timestep),
        displacement=columns,
        notices=(*notices, *ramped),
        source=path.name,
        sha256=table.sha256,
        random=not any(map(is_event, columns.values())),
        highest=USABLE * band_rate if band_rate < SMOOTH_RATE * (1.0 - UNIFORM_TOLERANCE) else None,
    )


def plate_columns(header: Header, wheel: str | None) -> dict[str, tuple[int, str]]:
    """Find the columns of time and plates in a header by name.

    Args:
        header: column headers of the file.
        wheel: wheel that a plain `displacement` column drives; None if the columns name their wheels.

    Returns:
        "time" and the wheels, in the order of written files, to index and unit of their columns.

    Raises:
        ForeignTableError: no known column.
        DataError: no header, unit missing or not allowed, unknown, missing or duplicate columns, another quantity, a
            plain `displacement` column without `wheel`.
    """
    if any(_is_number(cell) for cell in header.cells):
        raise DataError(f"{header.where}:1: no header line, found {header.found}; add a header with {NEEDED}")
    named = [(index, cell, *name_and_unit(cell)) for index, cell in enumerate(header.cells)]
    of_road = [match is not None and is_wheel(match[1]) for match in (_OF_ROAD.fullmatch(row[2]) for row in named)]
    named = [row for row, beside in zip(named, of_road, strict=True) if not beside]
    matches = [_WHEEL_COLUMN.fullmatch(name.lower()) for _, _, name, _ in named]
    wheels = in_order({name_of_wheel for match in matches if match and is_wheel(name_of_wheel := match[1] or match[2])})
    keys = {
        "time": "time",
        "displacement": wheel or "",
        **{f"displacement_{name_of_wheel}": name_of_wheel for name_of_wheel in wheels},
    }
    channels = {"time": "time", **{f"plate_{name_of_wheel}_displacement": name_of_wheel for name_of_wheel in wheels}}
    if any(name.startswith("plate_") and name in channels for _, _, name, _ in named):
        keys, named = channels, [name_of_wheel for name_of_wheel in named if name_of_wheel[2] in channels]
    columns: dict[str, tuple[int, str]] = {}
    unknown = []
    for index, cell, name, unit in named:
        where = f"{header.where}:{index + 1}: column {cell!r}"
        if _OTHER_UNIT.fullmatch(unit or "") or _OTHER_QUANTITY.search(name):
            raise DataError(
                f"{where} is an acceleration or a velocity, but a plate needs its displacement. Integrate it with a "
                f"high-pass filter to prevent drift, for example --channel {wheel or 'fl'}={name!r} --highpass 0.5"
            )
        key = keys.get(name.lower())
        if key == "":
            raise DataError(f"{where} names no wheel; {WHEEL_REMEDY}")
        if key is None:
            unknown.append(repr(cell))
        elif key in columns:
            first = columns[key][0]
            raise DataError(f"{where} repeats column {first + 1} ({header.cells[first]!r}); remove one")
        else:
            columns[key] = index, _checked_unit(where, key, unit)
    if unknown:
        raise (DataError if columns else ForeignTableError)(
            f"{header.where}: unknown column {', '.join(unknown)}; must be {NEEDED}; remove other columns, or name the "
            f"column of a wheel: --channel {wheel or 'fl'}=NAME (python -m vehicle inspect FILE prints the command); "
            f"found {header.found}"
        )
    if "time" not in columns or len(columns) == 1:
        missing = "displacement" if "time" in columns else "time"
        raise DataError(f"{header.where}: no {missing} column; found {header.found}, must be {NEEDED}")
    return {key: columns[key] for key in ("time", *in_order({wheel or "fl", *wheels})) if key in columns}


def _checked_unit(where: str, key: str, unit: str | None) -> str:
    allowed, expected = (("s",), "[s]") if key == "time" else (tuple(_LENGTH_UNITS), "[m] or [mm]")
    if not unit:
        raise DataError(f"{where} has no unit; write {expected} after the name")
    if unit not in allowed:
        unit_entry, hint = find_unit(unit), ""
        if unit_entry is not None and unit_entry.si == ("s" if key == "time" else "m"):
            hint = "; or name the channel, for example --channel fl=displacement: every unit is then read"
        raise DataError(f"{where} has the unit [{unit}] but must have {expected}{hint}")
    return unit


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


def _uniform_columns(
    table: Table, time: Vector, columns: dict[str, Vector], rate: float | None
) -> tuple[float, dict[str, Vector], float, list[str]]:
    """Check for uniform times, or resample the columns.

    Returns:
        Step [s], columns, sampling rate that limits their band [Hz], and notices.
    """
    time, rounded = without_rounding(time)
    notices = list(rounded)
    if rate is None:
        check_uniform(table, time, f"set {' '.join(clock_options(time)) or '--resample HZ'}")
    uniform = is_uniform(time)
    current = (time.size - 1) / float(time[-1] - time[0]) if uniform else 1.0 / float(np.median(np.diff(time)))
    notices.extend(aliasing_notices(columns, 1.0 / current))
    lowest = current
    wanted = [] if rate is None else [rate]
    if (rate or current) < SMOOTH_RATE * (1.0 - UNIFORM_TOLERANCE):
        wanted.append(FINE_RATE)
    for target in wanted:
        if uniform and abs(current / target - 1.0) < 1e-9:
            continue
        columns, notice = resampled(time, columns, target, table.place, uniform)
        notices.append(notice)
        time = time[0] + np.arange(next(iter(columns.values())).size) / target
        lowest, current, uniform = min(lowest, target), target, True
    return 1.0 / current, columns, lowest, notices


def write_signal(
    path: str | Path,
    signal: Signal,
    comments: Sequence[str] = (),
    *,
    plain: bool = False,
    beside: Mapping[str, Vector] | None = None,
) -> None:
    """Write a signal in the format of `read_signal`.

    Comments, header, times, displacements with 7 significant digits. Written under a temporary name and renamed when
    complete. The columns name their wheels, as `displacement_fl [m]`.

    Args:
        path: file to write.
        signal: plate displacements.
        comments: lines above the header.
        plain: name the column of the only plate `displacement [m]`; it then drives the shaker wheel of any car.
        beside: further columns by their headers, (n,) each.

    Raises:
        OutputError: the file cannot be written, or a comment contains a line break.
    """
    path = Path(path)
    if any("\n" in comment or "\r" in comment for comment in comments):
        raise OutputError(f"{path}: a comment contains a line break; use one comment per line")
    names = (
        ["displacement"] if plain and len(signal.wheels) == 1 else [f"displacement_{wheel}" for wheel in signal.wheels]
    )
    further = beside or {}
    columns = [signal.time, *(signal.displacement[wheel] for wheel in signal.wheels), *further.values()]
    # Minimum number of decimals for time stamps accurate to 1e-6 of a step.
    errors = {digits: np.max(np.abs(np.round(signal.time, digits) - signal.time)) for digits in range(3, 12)}
    digits = next((digits for digits, error in errors.items() if error < 1e-6 * signal.timestep), 12)
    forms = ",".join([f"%.{digits}f", *(["%.6e"] * (len(names) + len(further)))])
    try:
        with replaced_file(path) as temporary:
            write_table(temporary, [TIME, *(f"{name} [m]" for name in names), *further], columns, comments, forms)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror}); check the folder and its space") from error
