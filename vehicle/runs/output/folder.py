"""Results of a command, a folder or files: checked before the computation, made whole, put in place in one step."""

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError, OutputError
from vehicle.leftovers import unfinished
from vehicle.replacement import is_being_made
from vehicle.runs.output.locks import folder_lock
from vehicle.runs.output.work_folder import new_files, new_folder, put_in_order
from vehicle.runs.output.written_files import MARKER, digest_of, note, refuse_foreign, refuse_foreign_file

Content = str | bytes | Callable[[Path], object]
"""Content of a file: a text, bytes, or a function that writes the file to a path."""


@contextmanager
def output_folder(path: Path, *, force: bool, protect: tuple[Path, ...] = ()) -> Iterator[Path]:
    """Yield a hidden folder; on success it takes the place of `path` in one step, on failure it is removed.

    Args:
        path: final folder; a link is resolved.
        force: replace files of an earlier run.
        protect: input files; a folder that contains one of them is never replaced.

    Yields:
        The hidden folder, in the same parent folder.

    Raises:
        ConfigurationError: see `check_output`, or another process writes there.
        OutputError: the folder cannot be written.
    """
    path = check_output(path, force=force, protect=protect)

    def check() -> None:
        if path.exists():
            if not force:  # made meanwhile
                raise ConfigurationError(
                    f"{path}: was created meanwhile; give --force to replace it, or another --output"
                )
            refuse_foreign(path)

    with folder_lock(path), new_folder(path, check=check) as work:
        yield work


@contextmanager
def study_folder(folder: Path, *, force: bool, resume: bool = False, rows: Sequence[str] = ()) -> Iterator[Path]:
    """Yield the hidden folder of a study, a sweep or a search, whose finished rows survive its end.

    Args:
        folder: final folder; it keeps the results of before until the new ones are complete.
        force: replace results.
        resume: begin with the finished rows: of a killed command, else of the folder.
        rows: files with the finished rows; none for a job that cannot be continued.

    Yields:
        The hidden folder, which takes the place of the final one in one step.

    Raises:
        ConfigurationError: see `check_study`.
        OutputError: the folder cannot be made, or is no folder.
    """
    path = check_study(folder, force=force, resume=resume, rows=rows)

    def check() -> None:
        refuse_foreign(path, changes_only=resume)

    with folder_lock(path), new_folder(path, check=check, rows=rows, resume=resume) as work:
        yield work


def check_study(folder: Path, *, force: bool, resume: bool = False, rows: Sequence[str] = ()) -> Path:
    """Check the folder of a study before the computation; arguments as in `study_folder`.

    Returns:
        The folder without links.

    Raises:
        ConfigurationError: the folder has results, or a killed command left finished rows, and not exactly one of
            `force` and `resume` is set; or it has files of the user.
        OutputError: the folder cannot be made, or is no folder.
    """
    if resume and force:
        raise ConfigurationError("--resume keeps the finished rows, --force deletes them; leave one of them out")
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"--output {folder}: cannot be created, because a file has this name; give another folder")
    goal = _resolved(folder)
    put_in_order(goal)
    begun, left = folder.exists() and any(path.name != MARKER for path in folder.iterdir()), unfinished(goal)
    if rows:
        begun = (folder / rows[0]).exists()
    other = left not in ("", *rows)
    if (begun or left) and not force and (other or not resume):
        ways = "files; give another folder, or --force to overwrite"
        if other:
            ways = f"{left} of another killed command; give another folder, or --force to delete its finished rows"
        elif rows:
            ways = "finished runs; continue them with --resume, or start again with --force"
        raise ConfigurationError(f"--output {folder}: holds {ways}")
    return check_output(folder, force=True, changes_only=resume and begun)


def check_output(path: Path, *, force: bool, protect: tuple[Path, ...] = (), changes_only: bool = False) -> Path:
    """Check an output folder before the computation, and put in order what a killed command left there.

    Args:
        path, force, protect: see `output_folder`.
        changes_only: see `refuse_foreign`.

    Returns:
        The folder without links.

    Raises:
        ConfigurationError: it exists without `force`, is a file, holds an input, the working folder, or files that no
            run wrote.
        OutputError: its parent cannot be written.
    """
    folder, current = _resolved(path), _resolved(Path.cwd())
    put_in_order(folder)
    for file in protect:
        source = file.resolve()
        if folder == source or folder in source.parents:
            raise ConfigurationError(f"--output {path}: contains the input {file}; choose another folder")
    if folder == current or folder in current.parents:
        raise ConfigurationError(f"--output {path}: is the current folder, or contains it; give another folder")
    if folder.exists() and not folder.is_dir():
        raise ConfigurationError(f"--output {path}: is a file; give a folder")
    if folder.exists() and not force:
        raise ConfigurationError(f"--output {path}: exists; give --force to replace it, or another folder")
    if not force and unfinished(folder):
        raise ConfigurationError(
            f"--output {path}: a killed command left finished rows there; continue with --resume, delete them with "
            "--force, or give another folder"
        )
    if os.path.ismount(folder):
        raise ConfigurationError(f"--output {path}: is the root of a file system; give a folder in it")
    parent = next(parent for parent in folder.parents if parent.exists())
    if not os.access(parent, os.W_OK) or not parent.is_dir():
        raise OutputError(f"--output {path}: {parent} cannot be written to; choose another folder")
    if folder.exists():
        refuse_foreign(folder, changes_only=changes_only)
    return folder


def _resolved(path: Path) -> Path:
    """Return a path without links."""
    try:
        return path.resolve()
    except (OSError, RuntimeError) as error:
        raise OutputError(f"--output {path}: cannot be reached ({error}); choose another folder") from None


def check_file(
    path: Path, option: str = "--output", *, ending: str = "", force: bool, protect: tuple[Path, ...] = ()
) -> None:
    """Check the path of a single output file before the computation.

    Args:
        option: option that names the file.
        ending: required ending, as ".csv".
        force: replace a file that the program wrote.
        protect: input files, which are never replaced.

    Raises:
        ConfigurationError: another ending, a folder, an input, a file that exists without `force`, or one that the
            program did not write.
        OutputError: its folder cannot be made or written.
    """
    if ending and path.suffix != ending:
        raise ConfigurationError(f"{option} {path}: the name must end in {ending}; give FILE{ending}")
    if path.is_dir():
        raise ConfigurationError(f"{option} {path}: is a folder; give FILE{ending}")
    put_in_order(_resolved(path.parent) / path.name)
    if any(file.resolve() == path.resolve() for file in protect):
        raise ConfigurationError(f"{option} {path}: is an input of this command; give another name")
    if path.exists() or path.is_symlink():
        if not force:
            raise ConfigurationError(f"{option} {path}: exists; give --force to replace it, or another name")
        refuse_foreign_file(path, option)
    above = next(folder for folder in path.absolute().parents if folder.exists())
    if not above.is_dir():
        raise ConfigurationError(f"{option} {path}: {above.name} is a file, not a folder; give another name")
    if not os.access(above, os.W_OK):
        raise OutputError(f"{option} {path}: {above} cannot be written to; choose another folder")


def check_files(folder: Path, names: Iterable[str], *, force: bool) -> None:
    """Check files that are added to a folder with other files.

    Raises:
        ConfigurationError: the folder is a file, or a file is in the way.
        OutputError: the folder cannot be written.
    """
    if folder.exists() and not folder.is_dir():
        raise ConfigurationError(f"--output {folder}: is a file; give a folder")
    for name in names:
        check_file(folder / name, force=force)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a name for a file; on success, it takes the place of `path` and is added to the list of its folder.

    Yields:
        A path with the same ending, where the body writes the file.

    Raises:
        ConfigurationError: the existing file is of the user, or was edited.
        OutputError: the file cannot be written; an existing file is unchanged.
    """
    if is_being_made(path):  # errors are those of the folder that is being made
        path.parent.mkdir(parents=True, exist_ok=True)
        note(path)  # a killed command's file is known by this, complete or not
        yield path
        note(path, digest_of(path))
        return
    with whole_files([path]) as temporary:
        yield temporary[0]


@contextmanager
def whole_files(paths: Sequence[Path]) -> Iterator[list[Path]]:
    """Yield names for several files of one folder and below; on success, each takes its place; see `whole_file`.

    Each file is whole at any time. A command that is killed between the renames leaves new and earlier files, with a
    notice of the next command.

    Args:
        paths: final names; a file that the body does not write is not changed.
    """
    for path in paths:
        if path.is_dir():
            raise OutputError(f"{path}: cannot be written, because it is a folder; no file was changed")
    goal = _resolved(paths[0].parent) / paths[0].name
    put_in_order(goal)
    with folder_lock(goal), new_files(paths) as temporary:
        yield temporary


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file with a function that writes it to a path, see `whole_file`."""
    with whole_file(path) as temporary:
        write(temporary)


def write_text(path: Path, text: str) -> None:
    """Write a text file, see `write_whole`."""
    write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_json(path: Path, content: Any) -> None:
    """Write JSON with an indent of two blanks; NaN raises a ValueError."""
    write_text(path, json.dumps(content, indent=2, allow_nan=False) + "\n")


def write_files(folder: Path, contents: Mapping[str, Content]) -> None:
    """Write files of a folder by their names, each as `write_whole` does."""
    for name, content in contents.items():
        if isinstance(content, str):
            write_text(folder / name, content)
        else:
            write_whole(
                folder / name, partial(Path.write_bytes, data=content) if isinstance(content, bytes) else content
            )


def write_together(paths: Sequence[Path], contents: Iterable[Content]) -> None:
    """Write several files of one folder, all or none, see `whole_files`."""
    with whole_files(paths) as temporary:
        for path, content in zip(temporary, contents, strict=True):
            write_files(path.parent, {path.name: content})
