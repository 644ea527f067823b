"""Reading an excitation from a CSV file: the whole path from bytes to a checked `Signal`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import ConfigurationError, DataError
from vehicle.excitation.csv_cells import CsvCells, is_comment, parse_cells
from vehicle.excitation.csv_gaps import fill_missing
from vehicle.excitation.csv_header import NEEDED, parse_header
from vehicle.excitation.csv_text import read_text
from vehicle.excitation.plausibility import aliasing_notices, check_level
from vehicle.excitation.rest import start_from_rest
from vehicle.excitation.signal import MINIMUM_SAMPLES, Signal, uniform_time
from vehicle.excitation.steadiness import drifts, pauses
from vehicle.excitation.time_grid import (
    LOWEST_RATE,
    check_increasing,
    check_rate,
    check_uniform,
    clock_of_rounded,
    decimate,
    is_uniform,
    refine,
)
from vehicle.names import WHEELS


def read_signal(
    path: str | Path,
    *,
    wheel: str = "fr",
    interpolate: bool = False,
    resample_hz: float | None = None,
    remove_mean: bool = False,
    accept_implausible: bool = False,
) -> Signal:
    """Read plate displacements from a CSV file; everything unusual is refused or recorded in `notices`.

    UTF-8, `#` comments, one header line `time [s],displacement [m]` (or `[mm]`; or `displacement_fr [m]`,
    `displacement_fl [m]`), then one row per sample in uniform time. Times are shifted to begin at 0. A record that does
    not begin at rest gets a half-cosine ramp.

    Args:
        path: the file.
        wheel: wheel that a plain `displacement` column drives, 'fr' or 'fl'.
        interpolate: fill missing displacements by a cubic spline over gaps up to 10 ms.
        resample_hz: new sampling rate [Hz] with anti-alias filter, also for non-uniform times.
        remove_mean: subtract the mean of each column.
        accept_implausible: keep going where level or acceleration is beyond a shaker's (roads), with a notice.

    Raises:
        ConfigurationError: no such file, unknown wheel, resampling rate out of range.
        DataError: bad data; the message names file, line, column, the value found, what is allowed and the remedy.
    """
    path = Path(path)
    if wheel not in WHEELS:
        raise ConfigurationError(f"wheel {wheel!r} is unknown; allowed: {', '.join(WHEELS)}")
    if resample_hz is not None and not LOWEST_RATE <= resample_hz < np.inf:
        raise ConfigurationError(
            f"--resample {resample_hz:g} Hz: allowed from {LOWEST_RATE:g} Hz on (samples a second)"
        )
    text = read_text(path)
    header_line = next((n for n, line in enumerate(text.lines, 1) if not is_comment(line)), None)
    if header_line is None:
        raise DataError(
            f"{path}: only comments; needed are the columns {NEEDED} in a header line and one row per sample"
        )
    header = parse_header(path, header_line, text.lines[header_line - 1], wheel=wheel)
    cells = parse_cells(path, text.lines, header_line, header, keep_missing=interpolate)
    notices = [*text.notices, *header.notices, *cells.notices]
    if cells.line_numbers.size < MINIMUM_SAMPLES:
        raise DataError(
            f"{path}: {cells.line_numbers.size} rows; allowed from {MINIMUM_SAMPLES} rows; this is no record of a "
            "vibration"
        )

    time = cells.values[:, header.time_column]
    check_increasing(path, time, cells.line_numbers)
    columns = {}
    for driven, column in header.wheel_columns.items():
        place = f"column {header.cells[column]!r}"
        values, filled = fill_missing(path, time, cells, column, place)
        notices.extend([*filled, *pauses(driven, time, values)])
        columns[driven] = values * header.factors[driven]

    timestep, columns, resampled = _uniform_columns(path, time, columns, cells, resample_hz)
    notices.extend(resampled)
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
        check_level(path, columns, timestep, header.units)
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
        sha256=text.sha256,
    )


def _uniform_columns(
    path: Path,
    time: NDArray[np.float64],
    columns: dict[str, NDArray[np.float64]],
    cells: CsvCells,
    resample_hz: float | None,
) -> tuple[float, dict[str, NDArray[np.float64]], list[str]]:
    """Check the time grid, or make a new one on request: step [s], columns and notices."""
    notices = []
    clock = None if is_uniform(time) else clock_of_rounded(time)
    if clock is not None:
        time = time[0] + np.arange(time.size) / clock[0]
        notices.append(f"time stamps are rounded to {clock[1]} decimals: taken as a clock of {clock[0]:.9g} Hz")
    rate = 1.0 / float(np.median(np.diff(time)))
    if resample_hz is None:
        check_uniform(path, time, cells.line_numbers)
    uniform = is_uniform(time)
    if uniform:
        rate = (time.size - 1) / float(time[-1] - time[0])
    notices.extend(check_rate(path, rate))
    if resample_hz is None or (uniform and abs(rate / resample_hz - 1.0) < 1e-9):
        return 1.0 / rate, columns, [*notices, *aliasing_notices(columns, 1.0 / rate)]
    notices.extend(check_rate(path, resample_hz))
    factor, fine = refine(path, time, columns, cells.line_numbers, resample_hz)
    notices.extend(aliasing_notices(fine, 1.0 / (factor * resample_hz)))
    shape = "uniform" if uniform else "non-uniform"
    how = f" and an anti-alias FIR filter from {0.4 * resample_hz:g} Hz on" if factor > 1 else ""
    notices.append(f"resampled from {shape} times at {rate:.6g} Hz to {resample_hz:g} Hz by a cubic spline{how}")
    return 1.0 / resample_hz, {wheel: decimate(z, factor) for wheel, z in fine.items()}, notices
