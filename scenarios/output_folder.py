"""The folder of a study: refused if it holds files, written by temporary names."""

from __future__ import annotations

from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.output.folder import write_whole
from vehicle.output.written_files import MARKER, mark, refuse_foreign


def prepare_folder(folder: Path, *, force: bool) -> Path:
    """Make the folder of the results.

    Args:
        folder: where to.
        force: write into a folder that holds results already.

    Returns:
        The folder.

    Raises:
        ConfigurationError: it is not empty and force is off, or it holds files that no study wrote.
        OutputError: it cannot be made or is not a folder.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        occupied = any(path.name != MARKER for path in folder.iterdir())
    except OSError as error:
        raise OutputError(f"--output {folder}: cannot be made: {error.strerror}; give another folder") from None
    if occupied and not force:
        raise ConfigurationError(
            f"--output {folder}: holds files already; give another folder, or --force to overwrite"
        )
    refuse_foreign(folder)
    mark(folder)
    return folder


def write_text(path: Path, text: str) -> None:
    """Write a text file under a temporary name and rename it when complete.

    Raises:
        OutputError: the file cannot be written.
    """
    write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
