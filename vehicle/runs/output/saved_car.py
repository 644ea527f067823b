"""Save a car: a vehicle file, and the templates and the body model of the user."""

from __future__ import annotations

from pathlib import Path

from vehicle.runs.car import Car
from vehicle.runs.output.folder import check_file, write_text
from vehicle.runs.output.own_files import parameters_text, write_own_files


def save_car(car: Car, file: Path | str, *, force: bool = False) -> Path:
    """Write a car as a vehicle file, from which `Car.load` makes the same car.

    Every parameter is written with its current value, also the numbers of force laws that were read from other files.
    Templates and a body model of the user are copied to the same folder.

    Args:
        car: the car.
        file: name of the file, with the ending .toml.
        force: replace a file that was written there before.

    Returns:
        The file.

    Raises:
        ConfigurationError: the file exists without `force`, or a template or body model would replace another file.
        OutputError: a file cannot be written.
    """
    path = Path(file)
    check_file(path, ending=".toml", force=force)
    changes = "".join(f"\n  {text}" for text in car.overrides)
    origin = car.origin["file"] or "the default car"
    header = f"{car.vehicle.name}, from {origin}" + (f" with{changes}" if changes else "")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_own_files(path.parent, car)
    write_text(path, parameters_text(car, header))
    return path
