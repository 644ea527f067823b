"""Hidden folder next to the results, where a command writes new results, named finally when all are complete.

A file in this folder is the journal: it is named UNFINISHED, and renamed to COMPLETE when all results are on the disk.
The next command that reads or writes there finishes or removes the results of a killed command, with `put_in_order`:

- unfinished: the new results are removed, or kept for --resume;
- complete, in the hidden folder: the new results are put in place;
- complete, in the folder of the results: they are in place, and the old results are removed.
"""

import os
import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from vehicle.errors import OutputError
from vehicle.replacement import being_made, exchange, is_being_made, synchronise, synchronise_folder
from vehicle.runs.output.locks import OccupiedError, claimed, folder_lock, is_claimed, lock_file
from vehicle.runs.output.notices import say
from vehicle.runs.output.written_files import (
    COMPLETE,
    MARKER,
    UNFINISHED,
    digest_of,
    discard,
    foreign,
    mark,
    note,
    refuse_foreign_file,
)

FOLDER, FILES = "folder", "files"
"""First line of the journal: the hidden folder becomes the results, or its files are moved into an existing folder. The
second line is the file of finished rows, or empty."""


_named: set[Path] = set()
"""Goals whose finished rows a notice of this process has named."""


def work_of(goal: Path) -> Path:
    """Return the hidden folder in which new results are made."""
    return goal.parent / f".{goal.name}.partial"


def old_of(goal: Path) -> Path:
    """Return the name of the old results between two renames, where the system has no exchange in one step."""
    return goal.parent / f".{goal.name}.old"


def unfinished(goal: Path) -> str:
    """Return the file of finished rows of a killed command that --resume continues, or an empty text."""
    rows = _journal(work_of(goal), UNFINISHED)[1]
    return rows if rows and (work_of(goal) / rows).is_file() else ""


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
        OutputError: a file cannot be written; the message says what is in the folder.
    """
    with _failures_undone(goal, FOLDER):
        work = _begin(goal, FOLDER, rows, resume=resume)
        with being_made(work), claimed(work):
            yield work
        check()
        if goal.exists():
            mark(goal)  # what of it is the program's is known also when half of it is removed
        _complete(work)
        _put_in_place(goal)


@contextmanager
def new_files(goals: Sequence[Path]) -> Iterator[list[Path]]:
    """Yield hidden names of files; on success, all take their places, also after a kill in between.

    Args:
        goals: the files, in the folder of the first one or below; the caller holds the lock of the first one.

    Raises:
        ConfigurationError: an existing file is of the user, or was edited.
        OutputError: a file cannot be written.
    """
    goal = goals[0]
    with _failures_undone(goal, FILES):
        goal.parent.mkdir(parents=True, exist_ok=True)
        work = _begin(goal, FILES)
        with being_made(work), claimed(work):
            yield (new := [work / path.relative_to(goal.parent) for path in goals])
        for path, hidden in zip(goals, new, strict=True):
            if hidden.exists():
                refuse_foreign_file(path)
                note(path, digest_of(hidden), with_folder=goal.parent)
        _complete(work)
        _put_in_place(goal)


@contextmanager
def _failures_undone(goal: Path, result_type: str) -> Iterator[None]:
    """Undo after an error, and convert an OSError to an OutputError that describes the results that exist."""
    work = work_of(goal)
    try:
        yield
    except BaseException as error:
        in_place = _abandon(goal)
        with suppress(OSError):
            if rows := unfinished(goal):
                say(f"{goal}: the finished rows are kept in {work.name}/{rows}; continue with --resume")
        if not isinstance(error, OSError):
            raise
        if in_place:
            return
        name = Path(os.fsdecode(error.filename or b"")).name if not isinstance(error.filename, int) else ""
        where = goal if not name or name[0] == "." else goal / name if result_type == FOLDER else goal.with_name(name)
        raise OutputError(f"{where}: cannot be written: {error.strerror or error}; {_outcome(goal)}") from None


def put_in_order(path: Path) -> None:
    """Finish or remove the results of a killed command at a folder or a file, and print a notice."""
    with suppress(OSError, RuntimeError, ValueError):
        goal = path.resolve()
        _put_goal_in_order(goal)
        # Files that were completed together are found at each of them, and at their folder.
        for folder in (goal.parent, goal):
            for work in _complete_works(folder):
                _put_goal_in_order(folder / work.removeprefix(".").removesuffix(".partial"))


def _complete_works(folder: Path) -> list[str]:
    """Return the hidden folders with complete results in a folder."""
    if not folder.is_dir():
        return []
    with os.scandir(folder) as entries:
        names = [entry.name for entry in entries if entry.name[0] == "." and entry.name.endswith(".partial")]
    return [name for name in names if (folder / name / COMPLETE).exists()]


def _put_goal_in_order(goal: Path) -> None:
    remains = _remains(goal)
    if is_claimed(goal) and lock_file(goal).name in remains:
        remains.remove(lock_file(goal).name)
    if not remains or is_being_made(work_of(goal) / MARKER):
        return
    try:
        with folder_lock(goal):
            say(*_put_in_order(goal, remains))
    except OccupiedError:
        return  # of a command that is running
    except (OSError, OutputError) as error:
        names = ", ".join(name for name in remains if not name.endswith(".lock"))
        reason = error.strerror if isinstance(error, OSError) else "the folder cannot be written"
        say(f"{goal}: a killed command left {names or 'a lock file'} there, which cannot be cleaned up: {reason}")


def _remains(goal: Path) -> list[str]:
    """Return the names that a killed command may have left for a goal."""
    pattern = re.compile(rf"\.{re.escape(goal.name)}\.(partial|old|lock|\d+\.partial.*)")
    with os.scandir(goal.parent) as entries:
        remains = sorted(entry.name for entry in entries if pattern.fullmatch(entry.name))
    return remains + ([COMPLETE] if (goal / COMPLETE).exists() else [])


def _put_in_order(goal: Path, remains: Sequence[str]) -> list[str]:
    """Return what was done, as sentences; see `put_in_order`."""
    work, old = work_of(goal), old_of(goal)
    said = []
    if (work / COMPLETE).exists() or (goal / COMPLETE).exists():
        _put_in_place(goal)
        said.append(f"{goal}: the complete results of a killed command were put in place")
    elif old.exists() and not goal.exists():
        old.rename(goal)
        said.append(f"{goal}: a killed command had moved the earlier results away; they were put back")
    if rows := unfinished(goal):
        if goal in _named:
            return said
        _named.add(goal)
        said.append(
            f"{goal}: a killed command left finished rows in {work.name}/{rows}; continue with --resume, or "
            "start again with --force"
        )
    elif _is_own_work(work):
        _remove(work)
        said.append(f"{goal}: a killed command left unfinished results; they were removed")
    for name in remains:
        number, path = name.removeprefix(f".{goal.name}.").partition(".")[0], goal.parent / name
        if number.isdigit() and not _lives(int(number)) and (not path.is_dir() or (path / MARKER).exists()):
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)  # a folder: of an earlier version
            said.append(f"{goal}: a killed command left an unfinished file; it was removed")
    if not said and lock_file(goal).name in remains:
        said.append(f"{goal}: an earlier command left only its lock file; it was removed")
    return said


def _begin(goal: Path, result_type: str, rows: Sequence[str] = (), *, resume: bool = False) -> Path:
    """Make the hidden folder; with `resume`, with the rows of a killed command or of the goal."""
    work = work_of(goal)
    if resume and unfinished(goal):
        for path in work.iterdir():
            if path.name not in (UNFINISHED, *rows):
                shutil.rmtree(path) if path.is_dir() else path.unlink()
        mark(work)
        for name in rows:
            if (work / name).is_file():
                note(work / name)
        return work
    if _is_own_work(work):
        _remove(work)
    work.mkdir(parents=True)
    journal = work / f"{UNFINISHED}-new"
    journal.write_text(f"{result_type}\n{rows[0] if rows else ''}\n", encoding="utf-8")
    journal.rename(work / UNFINISHED)
    mark(work)
    for name in rows if resume else ():
        if (goal / name).is_file():
            shutil.copyfile(goal / name, work / name)
            note(work / name)
    return work


def _journal(work: Path, state: str) -> tuple[str, str]:
    """Return the lines of a journal in this state; empty without a journal."""
    try:
        result_type, rows = (work / state).read_text(encoding="utf-8").splitlines()
    except (FileNotFoundError, NotADirectoryError):
        return "", ""
    return result_type, rows


def _is_own_work(work: Path) -> bool:
    """True for a hidden folder that a command made, also if it was killed as it made or removed the folder."""
    return work.is_dir() and (
        (work / UNFINISHED).exists() or all(path.name.startswith(MARKER_BEGINNING) for path in work.iterdir())
    )


MARKER_BEGINNING = ".vehicle-"
"""Beginning of the names of the files of the program that are no results."""


def _remove(work: Path) -> None:
    """Remove a hidden folder, its journal last."""
    for path in work.iterdir():
        if path.name != UNFINISHED:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    (work / UNFINISHED).unlink(missing_ok=True)
    work.rmdir()


def _complete(work: Path) -> None:
    """Write the new results to the disk, and note in the journal that they are complete."""
    synchronise_folder(work)
    (work / UNFINISHED).rename(work / COMPLETE)
    synchronise(work)


def _put_in_place(goal: Path) -> None:
    """Give complete results their names; the parts of this that have been done are not repeated."""
    work, old = work_of(goal), old_of(goal)
    result_type, _ = _journal(work, COMPLETE)
    if result_type == FILES:
        for path in sorted(work.rglob("*")):
            if path.is_file() and path.parent / path.name not in (work / MARKER, work / COMPLETE):
                final = goal.parent / path.relative_to(work)
                final.parent.mkdir(exist_ok=True)
                path.replace(final)
        with suppress(OSError):  # from here on, the results are in place
            synchronise(goal.parent)
        try:
            (work / COMPLETE).rename(work / UNFINISHED)
            _remove(work)
        except OSError:
            say(f"{goal}: is complete; the empty folder {work.name} remains, until the next command there removes it")
        return
    if result_type:
        if not goal.exists():
            work.rename(goal)
        elif not exchange(work, goal):
            goal.rename(old)
            work.rename(goal)
        with suppress(OSError):
            synchronise(goal.parent)
    try:
        for replaced in (work, old):
            if replaced.exists() and (goal / COMPLETE).exists():
                _retire(replaced, goal)
        (goal / COMPLETE).unlink(missing_ok=True)
    except OSError:
        say(f"{goal}: is complete; files of the earlier results remain, until the next command there removes them")


def _retire(replaced: Path, goal: Path) -> None:
    """Remove replaced results; move files of the user among them to the new results."""
    for name in foreign(replaced):
        if not os.path.lexists(goal / name):
            (goal / name).parent.mkdir(parents=True, exist_ok=True)
            (replaced / name).rename(goal / name)
    discard(replaced)


def _abandon(goal: Path) -> bool:
    """Undo after a failure, as far as possible; True if it came so late that the new results are in place."""
    work, old = work_of(goal), old_of(goal)
    with suppress(OSError):
        if (goal / COMPLETE).exists() or _journal(work, COMPLETE)[0] == FILES:
            _put_in_place(goal)  # the new results have their names, or some of them
            return True
        if old.exists() and not goal.exists():
            old.rename(goal)
        if (work / COMPLETE).exists():
            (work / COMPLETE).rename(work / UNFINISHED)
        if not unfinished(goal) and _is_own_work(work):
            _remove(work)
    return False


def _outcome(goal: Path) -> str:
    """Return what is there after a failure."""
    work, old = work_of(goal), old_of(goal)
    if (work / COMPLETE).exists() or (goal / COMPLETE).exists():
        return "the new results are complete, and the next command there puts them in place"
    if old.exists() and not goal.exists():
        return "the next command there puts the earlier results back"
    there = "the earlier results are unchanged" if goal.exists() else "nothing is left behind"
    if work.exists():
        remainder = "the finished rows" if unfinished(goal) else "an unfinished folder, which the next command removes"
        return f"{there.replace('nothing is left behind', 'no results are there')}; left is {remainder}"
    return there


def _lives(number: int) -> bool:
    """True if a process with this number exists."""
    if os.name == "nt":
        return False  # an open file cannot be removed there anyway
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
