"""Folder for a core that is compiled from its sources on this machine.

The next process executes the code in it, so folders writable by others are not used.
"""

import os
import stat
import tempfile
from pathlib import Path


def cache_folder() -> Path:
    """Return the first folder that can be written: $XDG_CACHE_HOME or ~/.cache, a private one in the temporary folder.

    Under Windows it is %LOCALAPPDATA%. Without any of them it is a new temporary folder.
    """
    folder = next((folder for folder in _candidates() if _writable(folder)), None)
    return Path(tempfile.mkdtemp(prefix="vehicle-")) if folder is None else folder


def _candidates() -> list[Path]:
    """Return candidate folders, preferred first."""
    candidates = []
    if os.name == "nt":
        local = os.environ.get("LOCALAPPDATA", "")  # of this user alone
        return [Path(local) / "vehicle"] if Path(local).is_absolute() else []
    named = os.environ.get("XDG_CACHE_HOME", "")
    home = Path(os.path.expanduser("~"))  # noqa: PTH111 - Path.home() raises where there is none
    if Path(named).is_absolute():
        candidates.append(Path(named) / "vehicle")
    elif home.is_absolute() and home.is_dir():
        candidates.append(home / ".cache" / "vehicle")
    shared = Path(tempfile.gettempdir()) / f"vehicle-{os.geteuid()}"
    if _private(shared):
        candidates.append(shared)
    return candidates


def _private(folder: Path) -> bool:
    """Return True if a folder exists, or can be made, that belongs to this user alone."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid() and not status.st_mode & 0o077


def _writable(folder: Path) -> bool:
    """Return True if a file can be created in a folder, which is made if missing; tested by creating a file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
