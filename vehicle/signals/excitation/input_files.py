"""Finding an input file by its path or by the name of a shipped one."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from vehicle.errors import ConfigurationError

INPUT_FOLDER = Path(__file__).resolve().parents[1] / "inputs"
"""The shipped inputs, part of the package; `python -m scenarios.inputs.make_inputs` writes them."""


def find_input(name: str | Path) -> Path:
    """Return the file at the path as given, else the shipped one of that name.

    Args:
        name: path of a measurement file, or the plain name of a shipped one such as 'low.csv'.

    Raises:
        ConfigurationError: there is no such file; the message lists the names that exist.
    """
    given = Path(name)
    if given.is_file():
        return given
    if given.exists():
        raise ConfigurationError(f"input {str(name)!r} is not a file; give the path of a measurement file")
    names = shipped_inputs()
    if given.name == str(name) and given.name in names:
        return INPUT_FOLDER / given.name
    close = get_close_matches(given.name, names, n=1)
    hint = f" Did you mean {close[0]}?" if close else ""
    raise ConfigurationError(
        f"input {str(name)!r} not found: no such file, and none of that name is shipped.{hint} "
        f"Give the path of a measurement file or one of: {', '.join(names)}"
    )


def shipped_inputs() -> list[str]:
    """Return the names of the shipped input files, as `Car.run` takes them, sorted."""
    return sorted(path.name for path in INPUT_FOLDER.glob("*.csv"))
