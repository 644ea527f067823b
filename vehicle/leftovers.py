"""Hidden files and folders of results that are being written, and the notice about what a killed command left.

A command that only reads changes nothing on the disk: it prints a notice of unfinished results.
"""

import logging
import os
import re
import stat
import sys
from contextlib import suppress
from pathlib import Path

from vehicle.wording import in_words

_NOTICES = logging.getLogger("vehicle.results")
_NOTICES.addHandler(logging.lastResort or logging.StreamHandler(sys.stderr))
_NOTICES.propagate = False

FINISHED_ROWS = ("rows.jsonl", "cars.csv")
"""Files of finished rows: of a sweep, a line a run; of a search, a head and a line a car."""

REPLACED = ".vehicle-replaced"
"""Empty file in earlier results that new ones replace: their rows are not continued under the hidden name."""

PLAIN = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
"""Flags of `os.open` that follow no link and wait for no pipe; 0 under Windows."""

_mentioned: set[tuple[str, int]] = set()
"""Sentences of `mention` with the time of the last change of what they are about: each is printed once."""


def say(*sentences: str) -> None:
    """Print notices on standard error, a line for each; the logger `vehicle.results` of `logging`."""
    for sentence in sentences:
        _NOTICES.warning("notice: %s", in_words(sentence))


def work_of(goal: Path) -> Path:
    """Return the hidden folder in which new results are made."""
    return goal.parent / f".{goal.name}.partial"


def old_of(goal: Path) -> Path:
    """Return the hidden name of earlier results, from their exchange until they are removed."""
    return goal.parent / f".{goal.name}.old"


def lock_file(goal: Path) -> Path:
    """Return the lock file of a folder or a file."""
    return goal.parent / f".{goal.name}.lock"


def left_at(goal: Path) -> list[str]:
    """Return the hidden names that a killed command may have left for a goal, sorted."""
    return [path.name for path in (lock_file(goal), old_of(goal), work_of(goal)) if os.path.lexists(path)]


def is_plain(path: Path, *, folder: bool = False) -> bool:
    """True if a path is a file or a folder of this user, not a link or a pipe."""
    try:
        status = path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    expected = stat.S_ISDIR(status.st_mode) if folder else stat.S_ISREG(status.st_mode)
    return expected and (os.name == "nt" or status.st_uid == os.geteuid())


def finished_rows(folder: Path, *, count_all: bool = True) -> tuple[str, int]:
    """Return the file of finished rows in a folder and the number of complete rows; empty and 0 without rows.

    Args:
        count_all: False to read only until there is a complete row, where the number does not matter.
    """
    for name in FINISHED_ROWS if is_plain(folder, folder=True) else ():
        if is_plain(folder / name):
            count = -1 if name.endswith(".csv") else 0
            with (folder / name).open("rb") as file:
                while (count_all or count < 1) and (block := file.read(1 << 20)):
                    count += block.count(b"\n")
            if count > 0:
                return name, count
    return "", 0


def unfinished(goal: Path) -> str:
    """Return the file of finished rows of a killed command that --resume continues, or an empty text."""
    return "" if is_replaced(work_of(goal)) else finished_rows(work_of(goal), count_all=False)[0]


def is_replaced(hidden: Path) -> bool:
    """True if a hidden folder contains earlier results that new ones have replaced."""
    return is_plain(hidden, folder=True) and is_plain(hidden / REPLACED)


def mention(path: Path) -> Path:
    """Print a notice of unfinished results at a path without changing anything; return the path."""
    with suppress(OSError, RuntimeError, ValueError):
        goal = path.resolve()
        _mention(goal)
        if goal.is_dir():
            with os.scandir(goal) as entries:
                names = [entry.name for entry in entries if re.fullmatch(r"\..+\.(partial|old)", entry.name)]
            for name in dict.fromkeys(name[1:].rpartition(".")[0] for name in sorted(names)):
                _mention(goal / name)
    return path


def _mention(goal: Path) -> None:
    left = [name for name in left_at(goal) if name != lock_file(goal).name]
    if not left or is_locked(goal):
        return
    if not os.path.lexists(goal) and is_plain(old_of(goal), folder=True):
        text = f"the earlier results in {old_of(goal).name}; the next command that writes {goal.name} puts them back"
    elif name := unfinished(goal):
        text = f"finished rows in {work_of(goal).name}/{name}; continue with --resume, or start again with --force"
    else:
        mixed = "" if goal.is_dir() else ", and of files that it wrote together some may be earlier ones"
        text = f"{', '.join(left)}{mixed}; the next command that writes {goal.name} removes what it made"
    sentence, changed = f"{goal}: a killed command left {text}", (goal.parent / left[0]).lstat().st_mtime_ns
    if (sentence, changed) not in _mentioned:
        _mentioned.add((sentence, changed))
        say(sentence)


def is_locked(goal: Path) -> bool:
    """True if a process writes there now; changes nothing."""
    try:
        descriptor = os.open(lock_file(goal), os.O_RDONLY | PLAIN)
    except OSError:
        return False
    try:
        return not take_lock(descriptor)
    except OSError:
        return False  # the file system does not support locks
    finally:
        os.close(descriptor)


def take_lock(descriptor: int) -> bool:
    """Lock an open lock file; False if another process holds the lock.

    Raises:
        OSError: the file system does not support locks.
    """
    try:
        if os.name == "nt":
            import msvcrt

            os.lseek(descriptor, LOCKED_BYTE, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined, unused-ignore]
            os.lseek(descriptor, 0, os.SEEK_SET)
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    return True


LOCKED_BYTE = 1 << 20
"""Position of the locked byte under Windows, which cannot be read; the process id is before it."""
