"""List of the files that the program wrote, stored in their folder; only these files are replaced or removed.

A line contains the beginning of the SHA-256 of a file and its name. A file belongs to the program as long as its
content matches a digest of its lines: an edited file belongs to the user. The last line of a
growing or unfinished file has no digest. The list moves with its folder; a single file that is moved
away has no list and is not replaced.

A list names the files of its own folder, and files below from the same command, for example
meshes/wheel.stl of a model: never the files of another command below, which are in a list of their own. So a list in
the folder of all, as /tmp, concerns nothing in the folders there.
"""

import errno
import os
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.replacement import folder_being_made, is_being_made
from vehicle.signals.formats.file_digest import digest

MARKER = ".vehicle-files"
HEAD = "# Files that the program wrote here. --force replaces these, and stops at any other.\n"

GENERATED = "mjcf; never edited by hand"
"""In the head of generated MJCF files; in those of earlier versions too, which name the command `vehicle.mjcf`."""
GENERATED_PAGE = "<!-- Written by `python -m"
"""In the head of generated pages of the documentation."""
_LEFT_OVER = re.compile(
    r"(^|/)(\.[^/]+\.lock|\.[^/]+\.\d+\.partial[^/]*|\.vehicle-(replaced|(unfinished|complete)(-new)?)"
    r"|\.[^/]+\.partial/\.vehicle-files)$"
)
"""Files that a killed process leaves: locks, unfinished files, mark of replaced results, list of a hidden folder; and
the journal of an earlier version."""
DIGITS = 32
_LINE = re.compile(rf"(?:([0-9a-f]{{{DIGITS}}})  )?(.+)")
SHOWN = 5
"""Maximum number of files that a message names."""


def mark(folder: Path) -> None:
    """Start the list of a folder, with the generated files of a clone."""
    if not (folder / MARKER).exists() or not (folder / MARKER).stat().st_size:
        _append(folder / MARKER, HEAD + "".join(f"{name}\n" for name in sorted(written(folder))))


def note(path: Path, digest: str = "", *, with_folder: Path | None = None) -> None:
    """Add a file to the list of its folder.

    Args:
        path: the file under its final name.
        digest: see `digest_of`; empty for a file that grows, which belongs to the program with any content.
        with_folder: folder above with the list for this file and the files of the same command; by default the
            folder of `being_made` that contains the file, else its own.
    """
    at = path.parent.resolve() / path.name
    folder = with_folder or folder_being_made(path) or at.parent
    name = at.relative_to(folder.resolve()).as_posix()
    mark(folder)
    listed = written(folder)
    if name not in listed or (digest not in listed[name] if digest else listed[name]):
        _append(folder / MARKER, f"{digest}  {name}\n" if digest else f"{name}\n")


def _append(marker: Path, text: str) -> None:
    """Append lines to a list in one call; a failed call appends nothing, and half a line of a killed one ends."""
    if (os.path.lexists(marker) and not marker.is_file()) or marker.is_symlink():
        raise OutputError(f"{marker}: must be a file, not a link, because it lists the files in this folder; remove it")
    with marker.open("ab", buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        if size:
            with marker.open("rb") as lines:
                lines.seek(size - 1)
                text = text if lines.read(1) == b"\n" else f"\n{text}"
        data = text.encode()
        try:
            if file.write(data) != len(data):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(marker))
        except OSError:
            with suppress(OSError):
                file.truncate(size)
            raise
        if not is_being_made(marker):
            os.fsync(file.fileno())


def digest_of(path: Path) -> str:
    """Return the beginning of the SHA-256 of a file."""
    return digest(path)[:DIGITS]


def written(folder: Path) -> dict[str, frozenset[str]]:
    """Return the names, relative to the folder, of what the program wrote there, and the digests of each.

    An empty set means any content.
    """
    return listing(folder) or dict.fromkeys(_of_a_clone(folder), frozenset())


def listing(folder: Path) -> dict[str, frozenset[str]]:
    """Return the names in the list of a folder and the digests of each, see `written`; empty without a list."""
    marker = folder / MARKER
    try:
        lines = marker.read_text(encoding="utf-8").splitlines() if marker.is_file() and not marker.is_symlink() else []
    except (FileNotFoundError, UnicodeDecodeError):
        lines = []
    names: dict[str, frozenset[str]] = {MARKER: frozenset()} if lines else {}
    for line in lines:
        if (match := _LINE.fullmatch(line)) and not line.startswith("#"):
            digest, name = match.groups()
            names[name] = names.get(name, frozenset()) | {digest} if digest else frozenset()
    return names


def _of_a_clone(folder: Path) -> set[str]:
    """Return the generated files of a folder without a list, in a clone of the repository, by what marks them."""
    pages = (path for path in folder.glob("*.md") if path.is_file())
    names = {path.name for path in pages if GENERATED_PAGE.encode() in path.read_bytes()[:1000]}
    car = folder / "car.xml"
    if car.is_file() and GENERATED.encode() in car.read_bytes()[:1000]:
        meshes = (f"meshes/{mesh.name}" for mesh in (folder / "meshes").glob("*.stl"))
        names |= {"car.xml", "scene.xml", *meshes}
    return names


def is_own(path: Path) -> bool:
    """True if the program wrote the file, as a list of its folder or one above says, and its content is unchanged."""
    at = path.parent.resolve() / path.name
    digests = written(at.parent).get(at.name)
    for number, folder in enumerate(at.parents[1:]):
        if digests is not None:
            break
        with suppress(PermissionError):  # a folder of others
            # A clone has generated files and no list: a mesh belongs to the folder of its model.
            if number == 0 or (folder / MARKER).exists():
                digests = written(folder).get(at.relative_to(folder).as_posix())
    return _unchanged(path, digests)


def _unchanged(path: Path, digests: frozenset[str] | None) -> bool:
    if digests is None or path.is_symlink() or not path.is_file():
        return False
    return not digests or digest_of(path) in digests


def foreign(folder: Path) -> list[str]:
    """Return the files in a folder and below that the program did not write, relative to it, sorted."""
    listed = written(folder)
    return sorted(name for name in _files(folder) if name not in listed and not _is_left_over(folder, name))


def changed(folder: Path) -> list[str]:
    """Return the files in a folder and below that were changed since the program wrote them, sorted."""
    listed = written(folder)
    return sorted(name for name in _files(folder) & listed.keys() if not _unchanged(folder / name, listed[name]))


def is_whole(folder: Path) -> bool:
    """True if a folder has a list, and every file of the list."""
    return {MARKER} < listing(folder).keys() <= _files(folder)


def _files(folder: Path) -> set[str]:
    """Return all files and links in a folder and below, relative to the folder."""
    paths = (path for path in folder.rglob("*") if path.is_symlink() or not path.is_dir())
    return {path.relative_to(folder).as_posix() for path in paths}


def _is_left_over(folder: Path, name: str) -> bool:
    """Return True for what a killed process left in a folder: a lock, an unfinished file, files of a hidden folder."""
    if _LEFT_OVER.search(name):
        return True
    hidden = [folder / parent for parent in Path(name).parents if parent.name.endswith(".partial")]
    return any(_unchanged(folder / name, listing(at).get((folder / name).relative_to(at).as_posix())) for at in hidden)


def refuse_foreign(folder: Path, *, changes_only: bool = False) -> None:
    """Check that a folder contains no files of the user before replacing it.

    Args:
        changes_only: accept other files, and reject only edited files of the program.

    Raises:
        ConfigurationError: the message lists the files.
    """
    others = [] if changes_only else foreign(folder)
    faults = [f"files that are not results of a run: {_some(others)}"] if others else []
    if edited := changed(folder):
        faults.append(f"results that were edited afterwards: {_some(edited)}")
    if faults:
        raise ConfigurationError(
            f"--output {folder}: contains {'; and '.join(faults)}; --force replaces only unchanged results of a "
            "run; move the other files, or give another folder"
        )


def _some(names: list[str]) -> str:
    return ", ".join(names[:SHOWN]) + (f" and {len(names) - SHOWN} more" if len(names) > SHOWN else "")


def refuse_foreign_file(path: Path, option: str = "--output") -> None:
    """Check that an existing file belongs to the program before replacing it.

    Args:
        path: the file; a missing file passes.

    Raises:
        ConfigurationError: the program did not write the file, or it was edited.
    """
    if (path.is_file() or path.is_symlink()) and not is_own(path):
        raise ConfigurationError(
            f"{option} {path}: was not written by this program, or was changed since, so it is not replaced; "
            "move the file, or give another name"
        )


def discard(folder: Path, *, kept: Sequence[str] = ()) -> None:
    """Remove the unchanged files of the list of a folder, and folders that become empty.

    Args:
        kept: names that are kept, with the list.
    """
    names, files = listing(folder), _files(folder)
    removable = {name for name in files if name in names and _unchanged(folder / name, names[name])}
    removable |= {name for name in files - removable if _is_left_over(folder, name)}
    removable -= {*kept, MARKER} if kept else set()
    for name in sorted(removable, key=lambda name: (name.startswith(".vehicle-"), name)):  # list and mark are the last
        (folder / name).unlink(missing_ok=True)
    inner = [path for path in folder.rglob("*") if path.is_dir() and not path.is_symlink()]
    for emptied in [*sorted(inner, key=lambda path: -len(path.parts)), folder]:
        if not any(emptied.iterdir()):
            emptied.rmdir()
