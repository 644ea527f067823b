"""Generated MJCF files in a folder, which may hold files of others in addition."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from vehicle.runs.output.folder import check_files, whole_files, write_whole
from vehicle.runs.output.written_files import is_own, mark


def write_mjcf(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the files into a folder; meshes of an earlier model that no longer exist are removed.

    Args:
        folder: target.
        files: name, relative to the folder, to content, see `vehicle.model.assembly.mjcf_files`.

    Raises:
        ConfigurationError: a file is in the way that the program did not write, or that was changed since.
        OutputError: a file cannot be written.
    """
    old = [path for path in (folder / "meshes").glob("*.stl") if f"meshes/{path.name}" not in files]
    # A viewer takes all meshes of the folder; one of somebody else is no part of this model.
    check_files(folder, [*files, *(f"meshes/{path.name}" for path in old)], force=True)
    folder.mkdir(parents=True, exist_ok=True)
    mark(folder)
    names = sorted(files, key=lambda name: ("/" in name, name))  # the folder is that of the first file
    with whole_files([folder / name for name in names]) as paths:
        for path, name in zip(paths, names, strict=True):
            write_whole(path, partial(_write, content=files[name]))
    for path in old:
        if is_own(path):
            path.unlink()


def _write(path: Path, content: bytes) -> None:
    path.write_bytes(content)
