"""Laws as tables of points: numbers in the vehicle file, or a file of a test that it names."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.errors import ConfigurationError, VehicleError

if TYPE_CHECKING:
    from vehicle.signals.records.table import Header

MOST_POINTS = 40
"""A row of the solver for each piece: more points than this only cost time."""

HEADS = {"velocity": "velocity [m/s]", "displacement": "displacement [m]"}
"""Heads of the columns of a file, beside `force [N]`."""
SI = {"velocity": "m/s", "displacement": "m"}
"""Units of what they hold; a file of another program may have any other of the same quantity."""


def require_curve(where: str, key: str, positions: Sequence[float], forces: Sequence[float]) -> None:
    """Refuse points that are no rising curve through both signs of its abscissa.

    Args:
        where: path of the table.
        key: name of the abscissa, a key of `HEADS`.
        positions: abscissae.
        forces: [N].

    Raises:
        ConfigurationError: naming the key and the first bad point.
    """
    if len(positions) != len(forces):
        raise ConfigurationError(f"{where}.force: found {len(forces)} numbers for {len(positions)} of {key}; needed is "
                                 "a force for each")  # fmt: skip
    if not 2 <= len(positions) <= MOST_POINTS:
        raise ConfigurationError(f"{where}.{key}: found {len(positions)} points, needed are 2 to {MOST_POINTS}; leave "
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


def with_curve_files(table: Mapping[str, Any], folder: Path, place: str = "") -> dict[str, Any]:
    """A vehicle file with the points of every `curve = FILE` in its place.

    Args:
        table: as of a vehicle file.
        folder: that the names of files are relative to.
        place: path of this table, for messages.

    Returns:
        A copy, that needs no other file.

    Raises:
        ConfigurationError: there is no such file, it holds no such columns, or the points are given twice; the message
            names the place.
    """
    found: dict[str, Any] = {}
    for key, value in table.items():
        path = f"{place}.{key}" if place else key
        if isinstance(value, Mapping):
            found[key] = with_curve_files(value, folder, path)
        elif key != "curve":
            found[key] = value
        elif not isinstance(value, str) or "force" in table:
            raise ConfigurationError(f"{path}: found {value!r}; needed is the name of a file, and no force beside it")
        else:
            # What has a law of damping is a damper.
            found |= _points(folder / value, path, "velocity" if "viscous_law" in table else "displacement")
    return found


def _points(file: Path, path: str, key: str) -> dict[str, Any]:
    """The columns of a file by their keys."""
    # Parameters are known without numpy, which tables are read with.
    from vehicle.signals.records.named_columns import named_columns
    from vehicle.signals.records.reader import read_table
    from vehicle.signals.records.table import Wanted

    heads = {key: HEADS[key], "force": "force [N]"}
    needed = " and ".join(map(repr, heads.values()))

    def column(header: Header) -> int:
        if missing := set(heads.values()) - set(header.cells):
            raise ConfigurationError(f"{header.where}: no column {min(missing)!r}; found {header.found}, needed are "
                                     f"{needed}")  # fmt: skip
        return header.cells.index(HEADS[key])

    try:
        table = read_table(file, Wanted(needed=needed, key=column, remedy="repair or remove the row"))
    except VehicleError as error:
        # Of a machine, in a format or in units of its own.
        try:
            return {name: values.tolist() for name, values in named_columns(file, {key: SI[key], "force": "N"}).items()}
        except VehicleError:
            raise ConfigurationError(f"{path}: {error}") from None
    return {name: table.values[:, table.header.cells.index(head)].tolist() for name, head in heads.items()}
