"""Cars of the package, by their names."""

import tomllib
from collections.abc import Iterable
from importlib import resources
from pathlib import Path

from vehicle.errors import ConfigurationError

VEHICLES = Path(str(resources.files("vehicle.model"))) / "vehicles"
OTHER_FILES = frozenset({
    ".json", ".csv", ".txt", ".tsv", ".xlsx", ".xls", ".ods", ".adm", ".cmd", ".asy", ".sub", ".bin", ".mnf", ".par",
    ".cpar", ".spck", ".urdf", ".xacro", ".sdf", ".xml", ".tir", ".dpr", ".spr", ".bus", ".bum", ".reb", ".hpt",
    ".tpl", ".m", ".mat", ".pdf",
})  # fmt: skip
"""Endings of files of other programs that people give as a vehicle file."""
FOCUS_FILE = VEHICLES / "focus" / "vehicle.toml"
"""The Ford-Focus-like car of Bommer 2006."""

CARS = tuple(sorted(folder.parent.name for folder in VEHICLES.glob("*/vehicle.toml")))
"""Names of all cars."""


def shipped_cars() -> tuple[str, ...]:
    """Return the names of the cars of the package, for `Car.load`."""
    return CARS


def vehicle_file(path: Path | str) -> Path:
    """Return the vehicle file of a car: a path, the file in a folder, or the file of the shipped car of this name.

    Raises:
        ConfigurationError: neither a file, nor the folder of a car, nor a shipped car; or a car of another program.
    """
    path = Path(path)
    if path.suffix.lower() in OTHER_FILES:
        raise ConfigurationError(
            f"{path}: is not a vehicle file; give a TOML file of a car, its folder, or a shipped car "
            f"({', '.join(CARS)}). A table of points, masses and rates (CSV, XLSX), points and parts of an Adams model "
            "(.adm, .cmd, .sub), a CarSim file (.par), a URDF and a tyre file (.tir) become a car with vehicle new "
            "NAME --table FILE; a property file from Adams Car belongs in a vehicle file, for example curve = FILE.dpr"
        )
    if path.is_dir() and (path / "vehicle.toml").is_file():
        return path / "vehicle.toml"
    if path.suffix or path.exists() or path.name != str(path):
        return path
    if path.name not in CARS:
        raise ConfigurationError(f"{path}: is neither a file nor a shipped car; shipped cars are {', '.join(CARS)}")
    return VEHICLES / path / "vehicle.toml"


def sets_step(file: str | None, overrides: Iterable[str]) -> bool:
    """Return True if the user has set the time step, by a change or in a vehicle file of his own.

    Args:
        file: vehicle file of the car; None for a car from no file.
        overrides: changed parameters as "path=value".
    """
    if any(text.partition("=")[0].strip().endswith("timestep") for text in overrides):
        return True
    if file is None or VEHICLES in Path(file).resolve().parents:
        return False
    table = tomllib.loads(Path(file).read_text(encoding="utf-8-sig"))
    return "timestep" in table.get("solver", {})
