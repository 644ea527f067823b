"""Files beside a vehicle file that its car is made of: a run keeps them, so that it can be repeated from its folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from vehicle.model.flexbody.body_model import own_body_file
from vehicle.model.parameters.instances import instances
from vehicle.model.parameters.template import own_templates
from vehicle.model.parameters.toml_file import write_text as vehicle_text
from vehicle.runs.car import Car
from vehicle.runs.output.folder import write_whole


def parameters_text(car: Car, header: str) -> str:
    """Return the vehicle file of a car; a body model of elsewhere is named as `write_own_files` copies it."""
    vehicle = car.vehicle
    if "/" in (name := vehicle.body.superelement or ""):
        table = {**vehicle.table, "body": {**vehicle.table["body"], "superelement": Path(name).name}}
        vehicle = replace(vehicle, table=table)
    return vehicle_text(vehicle, header)


def write_own_files(folder: Path, car: Car) -> dict[str, str]:
    """Copy the templates and the body model that are not of the package.

    Args:
        folder: of the run, beside its `vehicle.toml`.
        car: the car.

    Returns:
        Kind of file to its name in the folder, for the summary.

    Raises:
        OutputError: a file cannot be written.
    """
    found: dict[str, Path] = {}
    if car.folder is not None:
        places = (car.folder, car.folder / "templates")
        names = [str(i.numbers["template"]) for i in instances(car.vehicle.table, places).values()]
        found = {f"templates/{file.name}": file for file in own_templates(names, places)}
    if body := own_body_file(car.vehicle, car.folder):
        found[body.name] = body
    for name, file in found.items():
        (folder / name).parent.mkdir(exist_ok=True)
        text = file.read_bytes()
        write_whole(folder / name, lambda path, text=text: path.write_bytes(text))  # type: ignore[misc]
    return {("template_" if "/" in name else "body_") + file.stem: name for name, file in found.items()}
