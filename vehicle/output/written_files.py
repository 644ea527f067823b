"""Which files of a folder the program wrote: a list in the folder itself. No other file is ever replaced or removed."""

from __future__ import annotations

import json
import re
from pathlib import Path

from vehicle.errors import ConfigurationError

MARKER = ".vehicle-files"
HEAD = "# Files that the program wrote here. --force replaces these, and stops at any other.\n"

SWEEP = {"rows.jsonl", "table.csv", "sweep.json", "timing.csv"}
STUDY = {".md", ".json", ".jsonl", ".csv", ".png", ".mp4"}
"""Endings of what the studies of earlier versions wrote."""
_TEMPORARY = re.compile(r"(^|/)\.\d+\.(?=[^/]+$)")
"""Beginning of the name of a file while it is written."""
SHOWN = 5
"""Most foreign files that a message names."""


def mark(folder: Path) -> None:
    """Begin the list of a folder; a folder of an earlier version keeps what is known of it."""
    if not (folder / MARKER).exists():
        (folder / MARKER).write_text(HEAD + "".join(f"{name}\n" for name in sorted(written(folder))), encoding="utf-8")


def note(path: Path) -> None:
    """Add a file to the list of the marked folder that it lies in, or in a folder of which it lies."""
    folder = next((parent for parent in path.parents if (parent / MARKER).exists()), None)
    if folder is not None and (name := path.relative_to(folder).as_posix()) not in written(folder):
        with (folder / MARKER).open("a", encoding="utf-8") as file:
            file.write(f"{name}\n")


def written(folder: Path) -> set[str]:
    """Names, relative to the folder, of what the program wrote there."""
    try:
        lines = (folder / MARKER).read_text(encoding="utf-8").splitlines()
        return {line for line in lines if line and not line.startswith("#")} | {MARKER}
    except (OSError, UnicodeDecodeError):
        pass
    # Folders of earlier versions, by the file that each of them ends with.
    found: set[str] = set()
    if (folder / "summary.json").is_file():
        files = _files_of_summary(folder / "summary.json")
        found |= {"summary.json", *files} if files else set()
    if (folder / "rows.jsonl").is_file():
        found |= SWEEP
    if (folder / "results.json").is_file():
        found |= {path.name for path in folder.iterdir() if path.suffix in STUDY and path.is_file()}
    return found


def _files_of_summary(path: Path) -> set[str]:
    try:
        files = json.loads(path.read_text(encoding="utf-8"))["files"]
        return {name for name in files.values() if Path(name).name == name}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return set()


def foreign(folder: Path) -> list[str]:
    """Files in a folder and below that the program did not write, relative to it, sorted."""
    return sorted(_files(folder) - _ours(folder))


def _files(folder: Path) -> set[str]:
    """Everything in a folder and below that is no folder itself."""
    found = (path for path in folder.rglob("*") if path.is_symlink() or not path.is_dir())
    return {path.relative_to(folder).as_posix() for path in found}


def _ours(folder: Path) -> set[str]:
    """What the program wrote, and what a killed process left of it under a temporary name."""
    known = written(folder)
    return known | {name for name in _files(folder) if _TEMPORARY.sub(r"\1", name) in known}


def refuse_foreign(folder: Path) -> None:
    """Refuse to replace a folder that holds files of somebody else.

    Raises:
        ConfigurationError: naming them.
    """
    found = foreign(folder)
    if found:
        more = f" and {len(found) - SHOWN} more" if len(found) > SHOWN else ""
        raise ConfigurationError(
            f"--output {folder}: holds files that no run wrote: {', '.join(found[:SHOWN])}{more}; --force replaces "
            "only what a run wrote; move them away, or give another folder"
        )


def discard(folder: Path) -> None:
    """Remove what the program wrote, and the folder where nothing else is left in it."""
    for name in _ours(folder):
        (folder / name).unlink(missing_ok=True)
    inner = [path for path in folder.rglob("*") if path.is_dir() and not path.is_symlink()]
    for place in [*sorted(inner, key=lambda path: -len(path.parts)), folder]:
        if not any(place.iterdir()):
            place.rmdir()
