"""Free, or replaceable, names for the results of a command, locked until the command ends.

`held` is the exit stack that holds the lock until then. Errors: see `check_output`, `check_file` and `folder_lock`.
"""

import itertools
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.leftovers import mention, old_of, unfinished
from vehicle.runs.output.folder import check_file, check_output
from vehicle.runs.output.locks import OccupiedError, claim

MOST = 10_000
"""Maximum number in a name, as low-10000; more runs of one input are not expected."""


def named(held: ExitStack, path: Path, *, force: bool, protect: tuple[Path, ...] = ()) -> Path:
    """Check and lock a folder that the user names, and return it.

    Args:
        force: replace files of an earlier run.
        protect: input files; a folder that contains one of them is never replaced.
    """
    held.enter_context(claim(check_output(path, force=force, protect=protect)))
    return path


def free_folder(held: ExitStack, default: Path, *, protect: tuple[Path, ...] = ()) -> Path:
    """Lock the first folder of `low`, `low-2`, `low-3` ... that is free."""
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
    """Check and lock a file that the user names; see `named` and `check_file`."""
    check_file(path, option, ending=ending, force=force, protect=protect)
    held.enter_context(claim(path.parent.resolve() / path.name))
    return path


def free_file(held: ExitStack, default: Path, *, option: str = "--output") -> Path:
    """Lock the first file of `road.csv`, `road-2.csv`, `road-3.csv` ... that is free."""
    for number in itertools.count(1):
        path = _numbered(default, number)
        if _claimed_if_free(held, path, number):
            check_file(path, option, force=False)
            return path
    raise AssertionError


def free_files(held: ExitStack, folder: Path, names: Sequence[str]) -> list[Path]:
    """Lock the first free set of names: `loads.csv`, `loads.png`, then `loads-2.csv`, `loads-2.png` ..."""
    for number in itertools.count(1):
        paths = [folder / _numbered(Path(name), number) for name in names]
        if not any(path.exists() for path in paths[1:]) and _claimed_if_free(held, paths[0], number):
            check_file(paths[0], force=False)
            return paths
    raise AssertionError


def _numbered(path: Path, number: int) -> Path:
    return path if number == 1 else path.with_name(f"{path.stem}-{number}{path.suffix}")


def _claimed_if_free(held: ExitStack, path: Path, number: int) -> bool:
    """Lock a free path; return False if the path exists or another process writes there."""
    if number > MOST:
        raise ConfigurationError(f"{path}: exists, like the {MOST} names before it; choose a name with --output")
    goal = path.parent.resolve() / path.name
    if path.exists() or path.is_symlink() or unfinished(goal) or old_of(goal).exists():
        mention(path)
        return False
    with ExitStack() as attempt:
        try:
            attempt.enter_context(claim(goal))
        except OccupiedError:
            return False
        if path.exists():  # written by another process in the meantime
            return False
        held.push(attempt.pop_all())
    return True
