"""Native code of other people that this user allows: a list of SHA-256 digests in his configuration folder.

An FMU runs with all rights of the user, so only he can allow it: with `vehicle trust FILE` or `--trust`. A vehicle file
may name a digest, which must then fit, but no file that is loaded can allow itself.
"""

import hashlib
import os
import re
from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.replacement import replaced_file

FILE = "trusted-code.txt"
ENTRY = re.compile(r"([0-9a-f]{64})  (.*)")
"""Line of the list: digest, and the path that the file had when it was added."""


def trusted_list() -> Path:
    """Return the file of the list, in $XDG_CONFIG_HOME/vehicle or ~/.config/vehicle; Windows: %APPDATA%/vehicle."""
    named = os.environ.get("APPDATA" if os.name == "nt" else "XDG_CONFIG_HOME", "")
    home = Path(named) if Path(named).is_absolute() else Path(os.path.expanduser("~")) / ".config"  # noqa: PTH111
    return home / "vehicle" / FILE


def trusted() -> dict[str, str]:
    """Return the allowed digests with the path of each file when it was added; empty without a list.

    Raises:
        ConfigurationError: another user can change the list, or it cannot be read.
    """
    path = trusted_list()
    try:
        status, text = path.stat(), path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise ConfigurationError(f"{path}: the list of trusted code cannot be read ({error.strerror})") from None
    if os.name != "nt" and (status.st_uid != os.geteuid() or status.st_mode & 0o022):
        raise ConfigurationError(
            f"{path}: another user owns or can change this list of trusted code; make it yours alone: chmod 600 {path}"
        )
    return {entry[1]: entry[2] for line in text.splitlines() if (entry := ENTRY.fullmatch(line))}


def trust(path: Path) -> str:
    """Add a file to the list; returns its digest.

    Raises:
        ConfigurationError: the file does not exist, or see `trusted`.
        OutputError: the list cannot be written.
    """
    try:
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read ({error.strerror}); give the path of an FMU") from None
    name = "".join(letter if letter.isprintable() else "?" for letter in str(path.resolve()))
    _write({**trusted(), digest: name})
    return digest


def distrust(beginning: str) -> tuple[str, str]:
    """Remove the entry whose digest begins with these digits; returns its digest and path.

    Raises:
        ConfigurationError: no entry or several entries begin with them.
        OutputError: the list cannot be written.
    """
    entries = trusted()
    matches = [digest for digest in entries if beginning and digest.startswith(beginning.lower())]
    if len(matches) != 1:
        raise ConfigurationError(
            f"--remove {beginning}: {len(matches) or 'no'} entries of the list begin so; give more digits of one of "
            "python -m vehicle trust --list"
        )
    name = entries.pop(matches[0])
    _write(entries)
    return matches[0], name


def _write(entries: dict[str, str]) -> None:
    """Replace the list by other entries, in a folder and a file that only this user can change."""
    path = trusted_list()
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with replaced_file(path) as temporary:
            temporary.touch(mode=0o600)
            temporary.write_text("".join(f"{digest}  {name}\n" for digest, name in entries.items()), encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"{path}: the list of trusted code cannot be written ({error.strerror}); set XDG_CONFIG_HOME to a folder "
            "of your own"
        ) from None
