"""Numbers and points of a new car as a table that `--table` reads again."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from vehicle.studies.design.template_car import TemplateCar
from vehicle.studies.tables.car_table import BUSHINGS, PARTS, CarTable

if TYPE_CHECKING:
    from vehicle.studies.design.new_car import NewCar

HEAD = ("name", "axle", "value", "unit")
POINT_HEAD = ("name", "axle", "x [m]", "y [m]", "z [m]")
AXES = "# axes: x rearward, y right, z up; origin of the vehicle file; right side"


def table_lines(result: "NewCar", template: TemplateCar, source: CarTable) -> Iterable[str]:
    """Yield the lines of the table of a new car: the numbers and the points that its table has source.

    Args:
        result: the new car.
        template: its template.
        source: the table that it was made from.
    """
    yield AXES
    yield ",".join(HEAD)
    for check in result.checks:
        if check.name in source.numbers:
            # "axle": an unsprung mass without it may be of a wheel.
            name = check.name.replace("unsprung_mass", "unsprung_mass_axle")
            yield f"{name},,{check.value:.9g},{check.unit}"
    # The radius follows from these two, which have no check.
    for name, unit in (("tyre_free_radius", "m"), ("tyre_size", "")):
        if name in source.numbers:
            yield f"{name},,{source.numbers[name]},{unit}"
    yield ""
    yield ",".join(POINT_HEAD)
    for word, points in source.points.items():
        placed = car_points(result, template, word)
        center = template.wheels[word][0].paths[0].rpartition(".")[2]
        for name in dict.fromkeys((center, *points)):
            yield ",".join((name, word, *(f"{value:.6f}" for value in placed[name])))
    yield from _parameter_lines(source)
    for word, rows in source.curves.items():
        yield from ("", f"damper {word}", "velocity [m/s],force [N]", *(f"{v:.9g},{f:.9g}" for v, f in rows))


def _parameter_lines(source: CarTable) -> Iterable[str]:
    """Yield the lines of masses of parts, tyre damping and bushings."""
    parts = {name: words for words, names in PARTS.items() for name in names}
    bushings = {name: key for key, names in BUSHINGS.items() for name in names}
    for (word, path), (value, _) in source.parameters.items():
        section, name, *_ = path.split(".")
        if section == "bushings":
            letter, unit = ("k", "N/m") if path.endswith("stiffness") else ("c", "N s/m")
            yield from ("", f"bushing,axle,{','.join(f'{letter}{axis} [{unit}]' for axis in 'xyz')}")
            yield f"{bushings[name]},{word},{','.join(f'{part:.9g}' for part in value)}"
        else:
            text, unit = (f"{parts[name]} mass", "kg") if section == "parts" else ("tyre damping", "N s/m")
            yield from ("", "name,axle,value,unit", f"{text},{word},{value:.9g},{unit}")


def car_points(result: "NewCar", template: TemplateCar, word: str) -> dict[str, tuple[float, float, float]]:
    """Return the hardpoints of an axle of a new car [m], by name."""
    points = result.car.vehicle.table[template.axle(word)]["hardpoints"]
    return {name: (float(x), float(y), float(z)) for name, (x, y, z) in points.items()}
