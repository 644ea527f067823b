"""Plate signals as files: the whole path from a file to a checked `Signal`, and back."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError, OutputError
from vehicle.names import CORNERS, in_order, is_wheel
from vehicle.signals.excitation.chosen_plates import WHEEL_REMEDY, chosen_plates
from vehicle.signals.excitation.plausibility import aliasing_notices, check_level, clipping, drifts, pauses
from vehicle.signals.excitation.rest import start_from_rest
from vehicle.signals.excitation.signal import MINIMUM_SAMPLES, Signal, uniform_time
from vehicle.signals.excitation.time_grid import FINE_RATE, LOWEST_RATE, SMOOTH_RATE, check_rate, fill_missing
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.clock import (
    UNIFORM_TOLERANCE,
    check_increasing,
    check_uniform,
    clock_options,
    is_uniform,
    without_rounding,
)
from vehicle.signals.records.reader import is_table, read_table
from vehicle.signals.records.resampled import resampled
from vehicle.signals.records.table import TIME, USABLE, Header, Table, Vector, Wanted, name_and_unit
from vehicle.signals.records.text_format import write_table
from vehicle.signals.records.units import find_unit

NEEDED = "'time [s]' and 'displacement [m]' (or 'displacement_fr [m]', 'displacement_fl [m]'); [mm] is accepted"

_LENGTH_UNITS = {"m": 1.0, "mm": 1e-3}
_OTHER_QUANTITY = re.compile(r"(^|_)(acc|vel)|^[av](_|$)", re.IGNORECASE)
_WHEEL_COLUMN = re.compile(r"displacement_(\w+)|plate_(\w+)_displacement")
_OTHER_UNIT = re.compile(r"m?m/s(2|\^2|²)?|g")


def read_signal(
    path: str | Path,
    *,
    wheel: str | None = None,
    interpolate: bool = False,
    remove_mean: bool = False,
    accept_implausible: bool = False,
    choice: Choice | None = None,
) -> Signal:
    """Read plate displacements from a file; everything unusual is refused or recorded in `notices`.

    Columns `time [s],displacement [m]` (or `[mm]`; or `displacement_fr [m]`, `displacement_fl [m]`), one row per sample
    in uniform time; or the `time.csv` or `time.npz` of a run, whose plates are taken and all else left. Times are
    shifted to begin at 0. A record that does not begin at rest gets a half-cosine ramp.

    Args:
        path: the file, of a format of `vehicle.signals.records`.
        wheel: wheel that a plain `displacement` column drives, such as `car.vehicle.shaker_wheel`; None if the columns
            name their wheels.
        interpolate: fill missing displacements by a cubic spline over gaps up to 10 ms.
        remove_mean: subtract the mean of each column.
        accept_implausible: keep going where level or acceleration is beyond a shaker's (roads), with a notice.
        choice: channels of a measurement file, and what is done to them; None, or a rate to resample to alone, for the
            columns above.

    Returns:
        The signal, with a notice for everything that was done to the data.

    Raises:
        ConfigurationError: no such file, unknown wheel, resampling rate out of range.
        DataError: bad data; the message names file, line, column, the value found, what is allowed and the remedy.
    """
    path = Path(path)
    if wheel is not None and not is_wheel(wheel):
        raise ConfigurationError(f"wheel {wheel!r} is unknown; allowed: {', '.join(CORNERS.values())}")
    resample = None if choice is None else choice.resample
    if resample is not None and not LOWEST_RATE <= resample < np.inf:
        raise ConfigurationError(f"--resample {resample:g} Hz: allowed from {LOWEST_RATE:g} Hz on (samples a second)")
    wanted = Wanted(
        needed=NEEDED,
        key=lambda header: plate_columns(header, wheel)["time"][0],
        missing="fill" if interpolate else "refuse",
        remedy="repair the cell, or ask for interpolation (--interpolate)",
    )
    plain = (choice is None or choice == Choice(resample=resample)) and is_table(path)
    table, band_rate = (read_table(path, wanted), math.inf) if plain else chosen_plates(path, choice, wheel)
    plates = plate_columns(table.header, wheel)
    del plates["time"]
    units = {driven: unit for driven, (_, unit) in plates.items()}
    cells = [table.header.cells[column] for column, unit in plates.values() if unit == "mm"]
    notices = [*table.notices, *(f"column {cell!r} converted from mm to m" for cell in cells)]
    time = table.values[:, table.key]
    if time.size < MINIMUM_SAMPLES:
        raise DataError(
            f"{path}: {time.size} rows; allowed from {MINIMUM_SAMPLES} rows; this is no record of a vibration"
        )
    check_increasing(table, time)
    columns = {}
    for driven, (column, unit) in plates.items():
        values, filled = fill_missing(table, time, column)
        if table.header.cells[column].startswith("plate_") and not np.ptp(values) > 0.0:
            continue  # a run records the plate that it did not drive, too
        plain_said = [*pauses(driven, time, values), *clipping(driven, values)] if plain else []  # else `choose` has
        notices.extend([*filled, *plain_said])
        columns[driven] = values * _LENGTH_UNITS[unit]
    timestep, columns, recorded, brought = _uniform_columns(table, time, columns, resample)
    notices.extend(brought)
    band_rate = min(band_rate, recorded)
    notices.extend(check_rate(path, band_rate))
    if time[0] != 0.0:
        notices.append(f"time begins at {time[0]:.9g} s in the file and was shifted to 0")
    if remove_mean:
        for driven, z in columns.items():
            notices.append(f"mean {np.mean(z):.6g} m of plate {driven} removed on request")
            columns[driven] = z - np.mean(z)
    if not any(np.ptp(z) > 0.0 for z in columns.values()):
        raise DataError(f"{path}: no plate moves: every column holds one value only; give a record with motion")
    notices.extend(drifts(columns))
    try:
        notices.extend(check_level(path, columns, timestep, units if plain else dict.fromkeys(units, "")))
    except DataError as error:
        if not accept_implausible:
            raise
        notices.append(f"accepted on request: {error}")
    columns, ramped = start_from_rest(columns, timestep=timestep)
    samples = next(iter(columns.values())).size
    return Signal(
        time=uniform_time(samples=samples, timestep=timestep),
        displacement=columns,
        notices=(*notices, *ramped),
        source=path.name,
        sha256=table.sha256,
        highest=USABLE * band_rate if band_rate < SMOOTH_RATE * (1.0 - UNIFORM_TOLERANCE) else None,
    )


def plate_columns(header: Header, wheel: str | None) -> dict[str, tuple[int, str]]:
    """Find the time and the plates in the header of a file; nothing is mapped by position.

    Args:
        header: of the file.
        wheel: wheel that a plain `displacement` column drives; None if the columns name their wheels.

    Returns:
        "time" and the wheels, in the order of files, to the index of their column and its unit.

    Raises:
        DataError: no header, unit missing or not allowed, unknown, missing or duplicate columns, another quantity, a
            plain `displacement` column without `wheel`.
    """
    if any(_is_number(cell) for cell in header.cells):
        raise DataError(f"{header.where}:1: no header line: found {header.found}; needed are the columns {NEEDED}")
    named = [(index, cell, *name_and_unit(cell)) for index, cell in enumerate(header.cells)]
    ends = [_WHEEL_COLUMN.fullmatch(name.lower()) for _, _, name, _ in named]
    wheels = in_order({one for end in ends if end and is_wheel(one := end[1] or end[2])})
    keys = {"time": "time", "displacement": wheel or "", **{f"displacement_{one}": one for one in wheels}}
    channels = {"time": "time", **{f"plate_{one}_displacement": one for one in wheels}}
    if any(name.startswith("plate_") and name in channels for _, _, name, _ in named):
        keys, named = channels, [one for one in named if one[2] in channels]
    columns: dict[str, tuple[int, str]] = {}
    unknown = []
    for index, cell, name, unit in named:
        place = f"{header.where}:{index + 1}: column {cell!r}"
        if _OTHER_UNIT.fullmatch(unit or "") or _OTHER_QUANTITY.search(name):
            raise DataError(
                f"{place} is an acceleration or a velocity; the plate needs a displacement. Drift makes "
                "integration depend on a high-pass filter that only you can choose: name the column and the corner, as "
                f"--channel {wheel or 'fl'}={name!r} --highpass 0.5; "
                f"or give {NEEDED}"
            )
        key = keys.get(name.lower())
        if key == "":
            raise DataError(f"{place} names no wheel; {WHEEL_REMEDY}")
        if key is None:
            unknown.append(repr(cell))
        elif key in columns:
            first = columns[key][0]
            raise DataError(
                f"{place} gives the same quantity as column {first + 1} ({header.cells[first]!r}); each may appear "
                f"once; found {header.found}"
            )
        else:
            columns[key] = index, _checked_unit(place, key, unit)
    if unknown:
        raise DataError(
            f"{header.where}: unknown column {', '.join(unknown)}; found {header.found}; needed are {NEEDED}; remove "
            f"the others, or assign a column to a wheel: --channel {wheel or 'fl'}=NAME"
        )
    if "time" not in columns or len(columns) == 1:
        missing = "displacement" if "time" in columns else "time"
        raise DataError(f"{header.where}: no {missing} column; found {header.found}; needed are {NEEDED}")
    return {key: columns[key] for key in ("time", *in_order({wheel or "fl", *wheels})) if key in columns}


def _checked_unit(place: str, key: str, unit: str | None) -> str:
    allowed, shown = (("s",), "[s]") if key == "time" else (tuple(_LENGTH_UNITS), "[m] or [mm]")
    if not unit:
        raise DataError(f"{place} has no unit; write it in brackets behind the name, allowed: {shown}")
    if unit not in allowed:
        known, hint = find_unit(unit), ""
        if known is not None and known.si == ("s" if key == "time" else "m"):
            hint = (
                "; with --channel, as --channel fr=displacement, the shaker reads any unit of `python -m vehicle "
                "inspect`, and every command takes the time.npz of its run"
            )
        raise DataError(f"{place} has the unit [{unit}]; allowed: {shown}{hint}")
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
    """Check the time grid, or make a new one.

    Args:
        table: for messages.
        time: increasing times [s], shape (n,).
        columns: wheel -> displacement [m], shape (n,).
        rate: wanted sampling rate [Hz]; None for that of the file.

    Returns:
        Step [s], columns, the rate for which their band stands [Hz], and notices.
    """
    time, rounded = without_rounding(time)
    notices = list(rounded)
    if rate is None:
        check_uniform(table, time, f"set {' '.join(clock_options(time)) or '--resample HZ'}")
    uniform = is_uniform(time)
    held = (time.size - 1) / float(time[-1] - time[0]) if uniform else 1.0 / float(np.median(np.diff(time)))
    notices.extend(aliasing_notices(columns, 1.0 / held))
    lowest = held
    wanted = [] if rate is None else [rate]
    if (rate or held) < SMOOTH_RATE * (1.0 - UNIFORM_TOLERANCE):
        wanted.append(FINE_RATE)
    for target in wanted:
        if uniform and abs(held / target - 1.0) < 1e-9:
            continue
        columns, said = resampled(time, columns, target, table.place, uniform)
        notices.append(said)
        time = time[0] + np.arange(next(iter(columns.values())).size) / target
        lowest, held, uniform = min(lowest, target), target, True
    return 1.0 / held, columns, lowest, notices


def write_signal(path: str | Path, signal: Signal, comments: Sequence[str] = (), *, plain: bool = False) -> None:
    """Write a signal as `read_signal` reads it: comments, header, time, displacements with 7 significant digits.

    Written under a temporary name and renamed when complete. The columns name their wheels, as `displacement_fl [m]`.

    Args:
        path: the file.
        signal: what it holds.
        comments: lines above the header.
        plain: name the column of the only plate `displacement [m]`; it then drives the shaker wheel of any car.

    Raises:
        OutputError: the file cannot be written, or a comment holds a line break.
    """
    path = Path(path)
    if any("\n" in comment or "\r" in comment for comment in comments):
        raise OutputError(f"{path}: a comment holds a line break; give one line for each comment")
    names = (
        ["displacement"] if plain and len(signal.wheels) == 1 else [f"displacement_{wheel}" for wheel in signal.wheels]
    )
    columns = [signal.time, *(signal.displacement[wheel] for wheel in signal.wheels)]
    # Fewest decimals that keep each time stamp within 1e-6 of a step.
    errors = {digits: np.max(np.abs(np.round(signal.time, digits) - signal.time)) for digits in range(3, 12)}
    digits = next((digits for digits, error in errors.items() if error < 1e-6 * signal.timestep), 12)
    forms = ",".join([f"%.{digits}f", *(["%.6e"] * len(names))])
    temporary = path.with_name(f".{path.name}.partial")
    try:
        write_table(temporary, [TIME, *(f"{name} [m]" for name in names)], columns, comments, forms)
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise OutputError(
            f"{path}: cannot be written ({error.strerror}); check the folder, its permissions and the space"
        ) from error
