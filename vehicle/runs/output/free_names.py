"""Where a command writes: a name that is free, or one that may be replaced, locked until the command ends."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.output.folder import OccupiedError, check_file, check_output, claim

MOST = 10_000
"""Maximum number behind a name; nobody keeps as many runs of one input."""


def named(held: ExitStack, path: Path, *, force: bool, protect: tuple[Path, ...] = ()) -> Path:
    """Check and lock a folder that the user names.

    Args:
        held: keeps the lock until the command ends.
        path: the folder.
        force: replace what a run wrote there.
        protect: input files; a folder that holds one of them is never replaced.

    Returns:
        The same path.

    Raises:
        ConfigurationError, OutputError: as of `check_output` and `folder_lock`.
    """
    held.enter_context(claim(check_output(path, force=force, protect=protect)))
    return path


def free_folder(held: ExitStack, default: Path, *, protect: tuple[Path, ...] = ()) -> Path:
    """Lock the first folder of `low`, `low-2`, `low-3` ... that neither exists nor is being written.

    Args:
        held: keeps the lock until the command ends.
        default: the first one.
        protect: as of `named`.

    Returns:
        The folder.

    Raises:
        ConfigurationError, OutputError: as of `check_output`.
    """
    for number in itertools.count(1):
        path = default if number == 1 else default.with_name(f"{default.name}-{number}")
        if _claimed_if_free(held, path, number) and check_output(path, force=False, protect=protect):
            return path
    raise AssertionError


def named_file(
    held: ExitStack,
    path: Path,
    option: str = "--output",
    *,
    ending: str = "",
    force: bool,
    protect: tuple[Path, ...] = (),
) -> Path:
    """Check and lock a file that the user names; arguments, result and errors as of `named` and `check_file`."""
    check_file(path, option, ending=ending, force=force, protect=protect)
    held.enter_context(claim(path.parent.resolve() / path.name))
    return path


def free_file(held: ExitStack, default: Path, *, option: str = "--output") -> Path:
    """Lock the first file of `road.csv`, `road-2.csv`, `road-3.csv` ... that neither exists nor is being written.

    Args:
        held: keeps the lock until the command ends.
        default: the first one.
        option: that names another file.

    Returns:
        The file.

    Raises:
        ConfigurationError, OutputError: as of `check_file`.
    """
    for number in itertools.count(1):
        path = _numbered(default, number)
        if _claimed_if_free(held, path, number):
            check_file(path, option, force=False)
            return path
    raise AssertionError


def free_files(held: ExitStack, folder: Path, names: Sequence[str]) -> list[Path]:
    """Lock the first set of `loads.csv`, `loads.png`, then `loads-2.csv`, `loads-2.png` ... of which nothing exists.

    Args:
        held: keeps the lock until the command ends.
        folder: of the files.
        names: of the files.

    Returns:
        The files.

    Raises:
        ConfigurationError, OutputError: as of `check_file`.
    """
    for number in itertools.count(1):
        paths = [folder / _numbered(Path(name), number) for name in names]
        if not any(path.exists() for path in paths[1:]) and _claimed_if_free(held, paths[0], number):
            check_file(paths[0], force=False)
            return paths
    raise AssertionError


def _numbered(path: Path, number: int) -> Path:
    return path if number == 1 else path.with_name(f"{path.stem}-{number}{path.suffix}")


def _claimed_if_free(held: ExitStack, path: Path, number: int) -> bool:
    """Lock a path where nothing is; False where something is or another process writes."""
    if number > MOST:
        raise ConfigurationError(f"{path}: exists, as do the {MOST} names before it; give --output")
    if path.exists() or path.is_symlink():
        return False
    with ExitStack() as attempt:
        try:
            attempt.enter_context(claim(path.parent.resolve() / path.name))
        except OccupiedError:
            return False
        if path.exists():  # finished between the two lines
            return False
        held.push(attempt.pop_all())
    return True
