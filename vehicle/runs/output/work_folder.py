"""Hidden folder next to the results, where a command writes new results until all are complete and on the disk.

There is no journal. The state after a killed command follows from these names:

- `.NAME.partial` contains incomplete results. The next command that writes NAME removes the files of the program in it,
  or continues its finished rows (--resume), unless `.vehicle-replaced` marks them as earlier results;
- `.NAME.old` contains earlier results until they are removed. Some systems cannot exchange two names in one step, and
  NAME is missing for a moment: the next command that writes NAME then restores it.

Other files and edited files get a visible name, `NAME.left`. A link or a folder of another user is never entered.
"""

import itertools
import os
import shutil
import stat
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.leftovers import (
    PLAIN,
    REPLACED,
    finished_rows,
    is_plain,
    is_replaced,
    left_at,
    lock_file,
    old_of,
    say,
    unfinished,
    work_of,
)
from vehicle.replacement import being_made, exchange, is_being_made, replaced_file, synchronise, synchronise_folder
from vehicle.runs.output.locks import OccupiedError, claimed, folder_lock, is_claimed
from vehicle.runs.output.written_files import (
    MARKER,
    digest_of,
    discard,
    foreign,
    is_whole,
    mark,
    note,
    refuse_foreign_file,
)


@contextmanager
def new_folder(
    goal: Path, *, check: Callable[[], None] = lambda: None, rows: Sequence[str] = (), resume: bool = False
) -> Iterator[Path]:
    """Yield a hidden folder; on success, it takes the place of the goal in one step. The caller holds the lock.

    Args:
        goal: final folder without links.
        check: called before the exchange; raises an error if the goal must not be replaced.
        rows: files of finished rows; if there are any, they are kept after a failure for `resume`.
        resume: begin with the rows of a killed command, else with those of the goal.

    Raises:
        ConfigurationError: the rows of the goal are a link.
        OutputError: a file cannot be written; the message describes the folder.
    """
    with _failures_told(goal, goal):
        work, continues_goal = _begin(goal, rows, resume=resume)
        with being_made(work), claimed(work):
            yield work
        check()
        if goal.exists():
            mark(goal)  # a folder of a clone has no list
        synchronise_folder(work)
        replaced = _put_in_place(goal)
    if replaced is not None:
        _retire(replaced, goal, say_rows=not continues_goal)


@contextmanager
def new_files(goals: Sequence[Path]) -> Iterator[list[Path]]:
    """Yield hidden names of files; on success, each takes its place in one step, one after the other.

    Args:
        goals: the files, in the folder of the first one or below; the caller holds the lock of the first one.

    Raises:
        ConfigurationError: an existing file is of the user, or was edited; or a folder below is a link.
        OutputError: a file cannot be written.
    """
    goal, folder = goals[0], goals[0].parent
    with _failures_told(goal, folder):
        if linked := [path.parent for path in goals if path.parent != folder and path.parent.is_symlink()]:
            raise ConfigurationError(f"{linked[0]}: is a link, which is never written through; remove it")
        folder.mkdir(parents=True, exist_ok=True)
        work, _ = _begin(goal)
        new = [work / path.relative_to(folder) for path in goals]
        with being_made(work), claimed(work):
            for hidden in new:
                note(hidden, with_folder=work)
            yield new
        written = [(path, hidden) for path, hidden in zip(goals, new, strict=True) if hidden.exists()]
        for path, _ in written:
            refuse_foreign_file(path)
        synchronise_folder(work)
        for path, hidden in written:
            digest = digest_of(hidden)
            note(hidden, digest, with_folder=work)
            note(path, digest, with_folder=folder)
        for number, (path, hidden) in enumerate(written):
            try:
                path.parent.mkdir(exist_ok=True)
                hidden.replace(path)
            except OSError as error:
                if not number:
                    raise
                names = ", ".join(before.name for before, _ in written[:number])
                raise OutputError(
                    f"{path}: cannot be written: {error.strerror or error}; {names} is new already, the other files "
                    "are earlier ones; repeat the command"
                ) from None
    with suppress(OSError):  # the results are in place
        synchronise(folder)
    _retire(work, goal)


def _put_in_place(goal: Path) -> Path | None:
    """Exchange the hidden folder with the goal; return the folder of the earlier results."""
    work, old, replaced = work_of(goal), old_of(goal), None
    if not goal.exists():
        work.rename(goal)
    elif _exchanged(work, goal):
        with suppress(OSError):
            replaced = work
            work.rename(old)
            replaced = old
    else:
        goal.rename(old)
        try:
            work.rename(goal)
        except BaseException:
            if not goal.exists():
                old.rename(goal)
            raise
        replaced = old
    with suppress(OSError):  # the results are in place
        synchronise(goal.parent)
    return replaced


def _exchanged(work: Path, goal: Path) -> bool:
    """Exchange new results with marked earlier ones in one step; False if the system cannot, see `exchange`."""
    done = False
    try:
        with suppress(OSError):  # the exchange needs no right to write in the folder
            os.close(os.open(goal / REPLACED, os.O_WRONLY | os.O_CREAT | PLAIN, 0o644))
            synchronise(goal)
        done = exchange(work, goal)
    finally:
        if not done:
            with suppress(OSError):
                (goal / REPLACED).unlink(missing_ok=True)
    return done


def _retire(replaced: Path, goal: Path, *, say_rows: bool = False) -> None:
    """Remove replaced results, or an emptied hidden folder; move files of the user among them to the new results."""
    try:
        count = finished_rows(replaced)[1] if say_rows else 0
        for name in foreign(replaced) if goal.is_dir() else ():
            if not os.path.lexists(goal / name):
                (goal / name).parent.mkdir(parents=True, exist_ok=True)
                (replaced / name).rename(goal / name)
        discard(replaced)
        if count:
            say(f"{goal}: {count} finished rows of the earlier results were replaced")
        if os.path.lexists(replaced):
            say(f"{goal}: {_set_aside(replaced, goal)}")
    except OSError:
        say(f"{goal}: is complete; the next command that writes there removes {replaced.name}")


@contextmanager
def _failures_told(goal: Path, folder: Path) -> Iterator[None]:
    """Remove unfinished results after an error; convert an OSError to an OutputError that describes what exists.

    Args:
        folder: folder of the files that are written.
    """
    work, old = work_of(goal), old_of(goal)
    try:
        yield
    except BaseException as error:
        rows = ""
        with suppress(OSError):
            if rows := unfinished(goal):
                say(f"{goal}: the finished rows are kept in {work.name}/{rows}; continue with --resume")
            elif is_plain(work, folder=True):
                discard(work)
        if not isinstance(error, OSError):
            raise
        if os.path.lexists(old) and not goal.exists():
            state = f"the earlier results are in {old.name}; the next command that writes there puts them back"
        else:
            state = "the earlier results are unchanged" if goal.exists() else "no results are there"
            if os.path.lexists(work):
                left = "the finished rows" if rows else f"{work.name}, which the next command that writes there removes"
                state += f"; left is {left}"
        name = Path(os.fsdecode(error.filename or b"")).name if not isinstance(error.filename, int) else ""
        where = folder / name if name and name[0] != "." else goal
        raise OutputError(f"{where}: cannot be written: {error.strerror or error}; {state}") from None


def put_in_order(goal: Path) -> None:
    """Remove what a killed command left at a goal that a command writes, and print a notice; see the module."""
    try:
        left = left_at(goal)
    except OSError:
        return  # no parent folder
    if is_claimed(goal) and lock_file(goal).name in left:
        left.remove(lock_file(goal).name)
    if not left or is_being_made(work_of(goal) / MARKER):
        return
    try:
        with folder_lock(goal):
            say(*_put_in_order(goal, left))
    except OccupiedError:
        return  # of a command that is running
    except (OSError, OutputError) as error:
        names = ", ".join(name for name in left if not name.endswith(".lock"))
        reason = error.strerror if isinstance(error, OSError) else "the folder cannot be written"
        say(f"{goal}: a killed command left {names or 'a lock file'} there, which cannot be cleaned up: {reason}")


def _put_in_order(goal: Path, left: Sequence[str]) -> list[str]:
    """Return sentences about the changes; see `put_in_order`."""
    work, old, said = work_of(goal), old_of(goal), []
    if is_replaced(work) and not os.path.lexists(old):
        work.rename(old)  # as the killed command would have done
    if is_plain(old, folder=True) and is_whole(old) and not os.path.lexists(goal):
        old.rename(goal)
        said.append(f"{goal}: a killed command had moved the earlier results away; they were put back")
    if os.path.lexists(old):
        # Replaced results if NAME has a list; otherwise the user has made a folder NAME meanwhile.
        said.append(_cleared(old, goal, keep=not (goal / MARKER).exists() or os.path.lexists(work)))
    if os.path.lexists(work) and not unfinished(goal):  # finished rows wait for --resume or --force
        said.append(_cleared(work, goal))
    if not said and lock_file(goal).name in left:
        said.append(f"{goal}: an earlier command left only its lock file; it was removed")
    return said


def _cleared(hidden: Path, goal: Path, *, keep: bool = False) -> str:
    """Remove the files of the program from a hidden folder, or keep all; return a sentence, with the count of rows."""
    count = finished_rows(hidden)[1]
    if is_plain(hidden, folder=True) and not keep:
        discard(hidden)
    if os.path.lexists(hidden):
        return f"{goal}: {_set_aside(hidden, goal)}"
    rows = f" with {count} finished rows" if count else ""
    return f"{goal}: a killed command left {hidden.name}{rows}; it was removed"


def _set_aside(hidden: Path, goal: Path) -> str:
    """Give what is left of a hidden folder, or a link of its name, a visible name; return a sentence."""
    hidden.rename(visible := _visible(goal))
    return f"{hidden.name} does not consist only of unchanged files of the program; what is left is now {visible.name}"


def _visible(goal: Path) -> Path:
    """Return a free name in the folder of a goal."""
    names = (f"{goal.name}.left{'' if number == 1 else f'-{number}'}" for number in itertools.count(1))
    return next(path for path in map(goal.with_name, names) if not os.path.lexists(path))


def _begin(goal: Path, rows: Sequence[str] = (), *, resume: bool = False) -> tuple[Path, bool]:
    """Make the hidden folder; with `resume`, with the rows of a killed command or of the goal.

    Returns:
        The folder; True if it has the rows of the goal.
    """
    work, continues_goal = work_of(goal), False
    goes_on = resume and unfinished(goal) in rows
    if goes_on:
        discard(work, kept=rows)
        if others := [path for path in work.iterdir() if path.name not in (MARKER, *rows) or not is_plain(path)]:
            visible = _visible(goal)
            visible.mkdir()
            for path in others:
                path.rename(visible / path.name)
            say(f"{goal}: files in {work.name} that the program did not write, or that were edited: now {visible.name}")
    else:
        if os.path.lexists(work):
            say(_cleared(work, goal))
        work.mkdir(parents=True)
    mark(work)
    for name in reversed(rows) if resume else ():  # the finished rows are the last
        source = (work if goes_on else goal) / name
        # A second name of a file, as in a backup of hard links, must not grow with it.
        if os.path.lexists(source) and (not goes_on or source.lstat().st_nlink > 1):
            note(work / name)  # before it exists, so that a killed command leaves nothing unknown
            _copy(source, work / name)
            continues_goal = not goes_on
        if is_plain(work / name):
            note(work / name)
    return work, continues_goal


def _copy(source: Path, path: Path) -> None:
    """Copy a file that is no link; a killed copy has another name."""
    if not stat.S_ISREG(source.lstat().st_mode):
        raise ConfigurationError(f"{source}: is a link, or no file, so --resume cannot continue it; put a copy there")
    with (
        os.fdopen(os.open(source, os.O_RDONLY | PLAIN), "rb") as old,
        replaced_file(path) as new,
        new.open("wb") as file,
    ):
        shutil.copyfileobj(old, file)
