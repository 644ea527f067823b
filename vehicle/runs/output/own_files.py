"""A car as a vehicle file, with copies of the templates and the body model of a user beside it."""

from dataclasses import replace
from pathlib import Path

from vehicle.model.flexbody.body_model import own_body_file
from vehicle.model.parameters.instance import instances
from vehicle.model.parameters.template import own_templates
from vehicle.model.parameters.toml_file import write_text as vehicle_text
from vehicle.runs.car import Car
from vehicle.runs.output.folder import check_file, write_text, write_whole


def parameters_text(car: Car, header: str) -> str:
    """Return the vehicle file of a car, with the name of the copied body model, see `write_own_files`."""
    vehicle = car.vehicle
    if "/" in (name := vehicle.body.superelement or ""):
        table = {**vehicle.table, "body": {**vehicle.table["body"], "superelement": Path(name).name}}
        vehicle = replace(vehicle, table=table)
    return vehicle_text(vehicle, header)


def write_own_files(folder: Path, car: Car) -> dict[str, str]:
    """Copy the templates and the body model of the user, which are not part of the package.

    Returns:
        Name of each file by its purpose, for the summary.
    """
    files: dict[str, Path] = {}
    if car.folder is not None:
        folders = (car.folder, car.folder / "templates")
        names = [str(i.numbers["template"]) for i in instances(car.vehicle.table, folders).values()]
        files = {f"templates/{file.name}": file for file in own_templates(names, folders)}
    if body := own_body_file(car.vehicle, car.folder):
        files[body.name] = body
    for name, file in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        text = file.read_bytes()
        if (folder / name).is_file() and (folder / name).read_bytes() == text:
            continue  # the car is saved in the folder of its file
        write_whole(folder / name, lambda path, text=text: path.write_bytes(text))  # type: ignore[misc]
    return {("template_" if "/" in name else "body_") + file.stem: name for name, file in files.items()}


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
