"""Files of a car: its drawing, its data and its parameters."""

import io
from pathlib import Path

from vehicle.drawing.rendering.car_drawing import plot_car
from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.model.parameters.parameter_list import Parameter, value_text
from vehicle.runs.car import Car
from vehicle.runs.car.car_data import CarData
from vehicle.runs.output.folder import output_folder, write_json, write_text, write_whole
from vehicle.signals.formats.csv_table import RowWriter


def write_car(folder: Path, car: Car, data: CarData, *, force: bool = False) -> None:
    """Write car.png, car.json and parameters.csv into a new folder.

    Raises:
        ConfigurationError: the folder exists without `force`, or holds other files.
        OutputError: a file cannot be written.
    """
    with output_folder(folder, force=force) as work:
        write_whole(work / "car.png", lambda path: plot_car(path, car_wireframe(car.model), data))
        write_json(work / "car.json", data.summary())
        write_text(work / "parameters.csv", parameters_csv(data.parameters))


def parameters_csv(parameters: tuple[Parameter, ...]) -> str:
    """Return parameters as CSV text, a row for each parameter."""
    text = io.StringIO()
    table = RowWriter(text)
    table.writerow(["path", "value", "unit", "range", "meaning", "source"])
    table.writerows([p.path, value_text(p.value), p.unit, p.range, p.meaning, p.source] for p in parameters)
    return text.getvalue()
