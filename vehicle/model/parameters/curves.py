"""Force laws as tables of points: numbers in the vehicle file, or a measurement file that it names."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.errors import ConfigurationError, VehicleError

if TYPE_CHECKING:
    from vehicle.signals.records.table import Header

MAX_POINTS = 40
"""Maximum number of points: each segment is a row of the solver, and more would only cost time."""

HEADS = {"velocity": "velocity [m/s]", "displacement": "displacement [m]"}
"""Headers of the abscissa column of a file; the other column is `force [N]`."""
SI = {"velocity": "m/s", "displacement": "m"}
"""SI units of the abscissae; a file of another program may have any unit of the same quantity."""


def require_curve(where: str, key: str, positions: Sequence[float], forces: Sequence[float]) -> None:
    """Check that points form a rising curve; a curve over velocity must extend to both sides of zero.

    Args:
        where: path of the table.
        key: name of the abscissa, a key of `HEADS`.
        positions: abscissae [m] or [m/s].
        forces: forces [N].

    Raises:
        ConfigurationError: a wrong number of points, or the first wrong point.
    """
    if len(positions) != len(forces):
        raise ConfigurationError(f"{where}.force: found {len(forces)} numbers for {len(positions)} of {key}; set "
                                 "a force for each")  # fmt: skip
    if not 2 <= len(positions) <= MAX_POINTS:
        raise ConfigurationError(f"{where}.{key}: found {len(positions)} points, must be 2 to {MAX_POINTS}; leave "
                                 "out points on a straight line")  # fmt: skip
    for x, following in itertools.pairwise(positions):
        if not x < following:
            raise ConfigurationError(f"{where}.{key}: found {following!r} after {x!r}, must be ascending; sort the "
                                     "points, and give each once")  # fmt: skip
    for f, following in itertools.pairwise(forces):
        if following < f:
            raise ConfigurationError(f"{where}.force: found {following!r} N after {f!r} N, must not fall; {key} and "
                                     "force are positive in extension (rebound)")  # fmt: skip
    if key == "velocity" and not positions[0] < 0.0 < positions[-1]:
        raise ConfigurationError(f"{where}.{key}: found {positions[0]!r} to {positions[-1]!r}, must lie on both sides "
                                 "of 0: compression (bump) is negative, extension (rebound) positive")  # fmt: skip


def with_curve_files(table: Mapping[str, Any], folder: Path, prefix: str = "") -> dict[str, Any]:
    """Return a vehicle file with every `curve = FILE` replaced by the points of the file.

    Args:
        table: vehicle file.
        folder: folder that the file names are relative to.
        prefix: path of this table, for messages.

    Raises:
        ConfigurationError: a file or one of its columns is missing, or the points are given twice; with the path.
    """
    filled: dict[str, Any] = {}
    for key, value in table.items():
        path = f"{prefix}.{key}" if prefix else key
        if isinstance(value, Mapping):
            filled[key] = with_curve_files(value, folder, path)
        elif key != "curve":
            filled[key] = value
        elif not isinstance(value, str) or "force" in table:
            raise ConfigurationError(
                f"{path}: found {value!r}; must be the name of a file, without force in the same table"
            )
        else:
            # Only dampers have a law of damping.
            filled |= _points(folder / value, path, "velocity" if "viscous_law" in table else "displacement")
    return filled


def _points(file: Path, path: str, key: str) -> dict[str, Any]:
    """Return the columns of a file by their keys: the abscissa and "force"."""
    # Imported here: parameters are read without numpy, tables are not.
    from vehicle.signals.records.named_columns import named_columns
    from vehicle.signals.records.reader import read_table
    from vehicle.signals.records.table import Wanted

    heads = {key: HEADS[key], "force": "force [N]"}
    needed = " and ".join(map(repr, heads.values()))

    def column(header: Header) -> int:
        if missing := set(heads.values()) - set(header.cells):
            raise ConfigurationError(f"{header.where}: no column {min(missing)!r}; found {header.found}, must have "
                                     f"{needed}")  # fmt: skip
        return header.cells.index(HEADS[key])

    try:
        table = read_table(file, Wanted(needed=needed, key=column, remedy="repair or remove the row"))
    except VehicleError as error:
        # A file of a test bench may have another format and other units.
        try:
            return {name: values.tolist() for name, values in named_columns(file, {key: SI[key], "force": "N"}).items()}
        except VehicleError:
            raise ConfigurationError(f"{path}: {error}") from None
    return {name: table.values[:, table.header.cells.index(head)].tolist() for name, head in heads.items()}
