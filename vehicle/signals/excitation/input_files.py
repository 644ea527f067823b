"""Find input files by path or by the name of a shipped input."""

from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.signals.formats.shipped_record import find_record
from vehicle.wording import did_you_mean

INPUT_FOLDER = Path(__file__).resolve().parents[1] / "inputs"
"""Folder of the shipped inputs, part of the package; `python -m scenarios.inputs.make_inputs` writes them."""


def find_input(name: str | Path) -> Path:
    """Return the path of an existing file, else of the shipped input or record with this name.

    Raises:
        ConfigurationError: neither exists; the message lists the names of the shipped inputs.
    """
    path = find_record(name)
    if path.is_file():
        return path
    if path.exists():
        raise ConfigurationError(f"input {str(name)!r} is not a file; give the path of a measurement file")
    names = shipped_inputs()
    if path.name == str(name) and path.name in names:
        return INPUT_FOLDER / path.name
    hint = did_you_mean(path.name, names, cutoff=0.6)
    raise ConfigurationError(
        f"input {str(name)!r} is neither a file nor a shipped input{hint or '.'} Give the path of a measurement file "
        "or "
        f"one of: {', '.join(names)}"
    )


def shipped_inputs() -> list[str]:
    """Return the sorted names of the shipped inputs, which `Car.run` accepts."""
    return sorted(path.name for path in INPUT_FOLDER.glob("*.csv"))
