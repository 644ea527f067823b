"""Force laws in files that a vehicle file names: measurement files, and property files of other programs."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from vehicle.errors import ConfigurationError, VehicleError
from vehicle.model.parameters.alternatives import is_bushing
from vehicle.model.parameters.engine_orders import ORDERS

if TYPE_CHECKING:
    from vehicle.signals.formats.table import Header

T = TypeVar("T")

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
        raise ConfigurationError(f"{where}.force: found {len(forces)} forces for {len(positions)} values of {key}; "
        "give one force for each")  # fmt: skip
    if not 2 <= len(positions) <= MAX_POINTS:
        raise ConfigurationError(f"{where}.{key}: found {len(positions)} points, must be 2 to {MAX_POINTS}; leave "
                                 "out points on a straight line")  # fmt: skip
    for x, following in itertools.pairwise(positions):
        if not x < following:
            raise ConfigurationError(f"{where}.{key}: found {following!r} after {x!r}, must be ascending; sort the "
            "points and remove duplicates")  # fmt: skip
    for f, following in itertools.pairwise(forces):
        if following < f:
            raise ConfigurationError(f"{where}.force: found {following!r} N after {f!r} N, must not decrease; give "
            f"{key} and force as positive in extension (rebound)")  # fmt: skip
    if key == "velocity" and not positions[0] < 0.0 < positions[-1]:
        raise ConfigurationError(f"{where}.{key}: found {positions[0]!r} to {positions[-1]!r}, must lie on both sides "
                                 "of 0: compression (bump) is negative, extension (rebound) positive")  # fmt: skip


def with_curve_files(table: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a vehicle file with every `curve = FILE` replaced by the numbers of the file, and whole paths of FMUs
    and of the files of forces and of pressures.

    Args:
        table: vehicle file.
        folder: folder that the file names are relative to; files that are not there are in the working folder.

    Raises:
        ConfigurationError: a file or a part of it is missing or wrong, or numbers are given twice; with the path.
    """
    return _filled(table, folder, "", {})


def curve_sources(table: Mapping[str, Any], folder: Path) -> dict[str, str]:
    """Return the file of each number that a vehicle file takes from another file, by the path of the number.

    Args:
        table: vehicle file.
        folder: folder that the file names are relative to; files that are not there are in the working folder.

    Raises:
        ConfigurationError: see `with_curve_files`.
    """
    sources: dict[str, str] = {}
    _filled(table, folder, "", sources)
    return sources


def _filled(table: Mapping[str, Any], folder: Path, prefix: str, sources: dict[str, str]) -> dict[str, Any]:
    """Return a table with the numbers of its files; enter their sources by path."""
    filled: dict[str, Any] = {}
    for key, value in table.items():
        path = f"{prefix}.{key}" if prefix else key
        # A stop from files: its two ends become the points of one curve.
        if isinstance(value, Mapping) and key == "stop" and {"bump", "rebound"} & set(value):
            filled[key] = _stop(value, folder, path, sources)
        # Sections of a section, at any depth.
        elif isinstance(value, Mapping):
            filled[key] = _filled(value, folder, path, sources)
        elif isinstance(value, str) and (
            # Names of files that stay names: whole paths, so that a copy of the vehicle file elsewhere finds them.
            key == "fmu"
            or (key == "file" and prefix.startswith(("force.", "crank")))
            or (key == "pressure" and prefix.endswith(f".{ORDERS}"))
        ):
            filled[key] = _beside(folder, value).resolve().as_posix()
        # Every other entry is kept.
        elif key != "curve":
            filled[key] = value
        else:
            if not isinstance(value, str) or (twice := sorted({"force", "stiffness"} & set(table))):
                raise ConfigurationError(
                    f"{path}: found {value!r}, must be the name of a file, without "
                    f"{' and '.join(twice) if isinstance(value, str) else 'force'} in the same section"
                )
            numbers, source = _numbers(table, _file(folder, value, path), path)
            # Numbers of the vehicle file win over those of the curve, and have no source in it.
            filled |= {name: number for name, number in numbers.items() if name not in table}
            sources |= {f"{prefix}.{name}": source for name in numbers if name not in table}
    return filled


def _file(folder: Path, name: str, path: str) -> Path:
    """Return a file that is there; else raise an error with the path of its key in the vehicle file."""
    file = _beside(folder, name)
    if not file.exists():
        raise ConfigurationError(
            f"{path}: the file {file} does not exist; give a file in the same folder as the vehicle file or in "
            "the current folder"
        )
    return file


def _beside(folder: Path, name: str) -> Path:
    """Return a file in the folder of the vehicle file, otherwise in the working folder, where `--set` is typed."""
    beside, typed = folder / name, Path(name)
    return typed if typed.is_file() and not beside.exists() else beside


def _numbers(table: Mapping[str, Any], file: Path, path: str) -> tuple[dict[str, Any], str]:
    """Return the numbers of a file for the table that names it, and their source.

    Args:
        table: table of a damper, spring or bushing, or table of points.
        file: property file, or a file of a test with two columns.
        path: path of `curve` in the vehicle file.
    """
    # Imported here: parameters are read without them, and only few cars name files.
    from vehicle.model.parameters.property_files import (
        bushing_numbers,
        damper_numbers,
        spring_numbers,
        spring_of_points,
    )
    from vehicle.signals.formats.teim_orbit import is_property_file, read_property_file

    *above, name = path.split(".")[:-1] or [""]
    of_points = name == "stop" or name.startswith("table")
    bushing = is_bushing(above)
    # Only dampers have a law of damping; a table of one side may leave it out.
    damper = "viscous_law" in table
    if not is_property_file(file):
        if bushing and not of_points:
            raise ConfigurationError(f"{path}: {file} is not a property file; name a file with the curve of a single "
                f"axis in a section {path.removesuffix('curve')}table_z")  # fmt: skip
        points = _points(file, path, "velocity" if damper else "displacement")
        if damper or of_points:
            return points, file.name
        rows = list(zip(points["displacement"], points["force"], strict=True))
        return _within(path, lambda: spring_of_points(rows, "table", str(file))), file.name
    if of_points:
        raise ConfigurationError(f"{path}: {file} is a property file; set it one level higher: "
            f"{'.'.join(above)}.{'stop.bump.curve' if name == 'stop' else 'curve'}")  # fmt: skip
    properties = _within(path, lambda: read_property_file(file))
    if damper or (properties.file_type == "dpr" and {"left", "right"} & set(above)):
        numbers = _within(path, lambda: damper_numbers(properties))
    elif bushing:
        numbers = _within(path, lambda: bushing_numbers(properties, table))
    else:
        numbers = _within(path, lambda: spring_numbers(properties))
    return numbers, properties.source


def _stop(stop: Mapping[str, Any], folder: Path, path: str, sources: dict[str, str]) -> dict[str, Any]:
    """Return the table of a stop whose ends are files of a bump stop and a rebound stop."""
    from vehicle.model.parameters.property_files import stop_numbers, stop_points
    from vehicle.signals.formats.teim_orbit import is_property_file, read_property_file

    ends: dict[str, list[tuple[float, float]]] = {}
    files = []
    for end, entry in stop.items():
        keys = set(entry) if isinstance(entry, Mapping) else set()
        if end not in ("bump", "rebound") or keys != {"curve", "clearance"} or not isinstance(entry["curve"], str):
            raise ConfigurationError(
                f"{path}.{end}: found {entry!r}; a stop from files must have only bump and rebound, each with "
                "curve (a file) and clearance [m]"
            )
        where = f"{path}.{end}.curve"
        file = _file(folder, entry["curve"], where)
        if is_property_file(file):
            properties = _within(where, lambda file=file: read_property_file(file))  # type: ignore[misc]
            ends[end] = _within(where, lambda properties=properties, end=end: stop_points(properties, end))  # type: ignore[misc]
            files.append(properties.source)
        else:
            points = _points(file, where, "displacement")
            ends[end] = list(zip(points["displacement"], points["force"], strict=True))
            files.append(file.name)
    sources |= {f"{path}.{name}": "; ".join(files) for name in ("displacement", "force")}
    return stop_numbers(stop, ends, path)


def _within(path: str, read: Callable[[], T]) -> T:
    """Call a function that reads a file; its error names the path in the vehicle file."""
    try:
        return read()
    except VehicleError as error:
        raise ConfigurationError(f"{path}: {error}") from None


def _points(file: Path, path: str, key: str) -> dict[str, Any]:
    """Return the columns of a file by their keys: the abscissa and "force"."""
    # Imported here: parameters are read without numpy, tables are not.
    from vehicle.signals.formats.named_columns import named_columns
    from vehicle.signals.formats.table import Wanted
    from vehicle.signals.formats.table_file import read_table

    heads = {key: HEADS[key], "force": "force [N]"}
    needed = " and ".join(map(repr, heads.values()))

    def column(header: Header) -> int:
        if missing := set(heads.values()) - set(header.cells):
            raise ConfigurationError(f"{header.where}: column {min(missing)!r} is missing; expected {needed}, found "
            f"{header.found}")  # fmt: skip
        return header.cells.index(HEADS[key])

    def columns(header: Header) -> list[int]:
        return [header.cells.index(head) for head in heads.values()]

    try:
        wanted = Wanted(needed=needed, key=column, remedy="correct or remove the row", columns=columns)
        table = read_table(file, wanted)
    except VehicleError as error:
        # A file of a test bench may have another format and other units.
        try:
            return {name: values.tolist() for name, values in named_columns(file, {key: SI[key], "force": "N"}).items()}
        except VehicleError:
            raise ConfigurationError(f"{path}: {error}") from None
    return {name: table.values[:, table.header.cells.index(head)].tolist() for name, head in heads.items()}
