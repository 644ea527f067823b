"""Further cars of a page: a few stiffnesses and speeds, each a set of poles, for sliders with fixed positions."""

from collections.abc import Iterator, Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.handover.page.page_input import PageInput
from vehicle.model.parameters.force_elements import LinearBushing, Tyre
from vehicle.runs.car import Car

STIFFNESSES = (0.8, 1.0, 1.2)
"""Factors on a stiffness."""

DAMPER_MOUNTS = ("suspension_mount", "damper_mount")
"""Names of the bushings between dampers and body in the shipped templates."""


def stiffness_groups(car: Car) -> dict[str, dict[str, float]]:
    """Return the stiffnesses of a car that a slider scales together: words to paths and values [N/m].

    Main springs, vertical stiffness of the tyres, and stiffness of the damper mounts along the damper (z). Springs and
    bushings with a table, which has no stiffness to scale, are left out.
    """
    composition = car.vehicle.composition
    laws = {f"{spring.path}.stiffness": spring.law for spring in composition.springs}
    springs = {path: law.stiffness for path, law in laws.items() if law.table is None}
    tyres, mounts = {}, {}
    for connection in composition.connections:
        law = connection.law
        if not isinstance(law, LinearBushing) or law.table_z is not None:
            continue
        if isinstance(law, Tyre):
            tyres[f"{connection.path}.stiffness.z"] = law.stiffness[2]
        elif connection.path.rpartition(".")[2] in DAMPER_MOUNTS:
            mounts[f"{connection.path}.stiffness.z"] = law.stiffness[2]
    groups = {"main springs": springs, "tyres, vertical": tyres, "damper mounts": mounts}
    return {title: values for title, values in groups.items() if values}


def _changes(car: Car, drive: PageInput) -> Iterator[tuple[dict[str, Any], Mapping[float, dict[str, float]]]]:
    """Yield sliders with fixed positions, and the changes of the car at each value except that of the run."""
    speeds = drive.speeds()
    if speeds:
        rolling = car.vehicle.driving.rolling
        values = {value: {"driving.speed": value / 3.6} if rolling else {} for value in speeds}
        slider = {"id": "speed", "words": "speed", "unit": "km/h", "ratios": list(speeds.values())}
        yield slider, {value: change for value, change in values.items() if speeds[value] != 1.0}
    for title, stiffness in stiffness_groups(car).items():
        changes = {
            factor: {path: factor * value for path, value in stiffness.items()}
            for factor in STIFFNESSES
            if factor != 1.0
        }
        name = title.replace(",", "").replace(" ", "-")
        slider = {"id": name, "words": f"{title}{'' if ',' in title else ','} stiffness factor", "unit": ""}
        yield slider, changes


def stepped_sliders(car: Car, drive: PageInput) -> tuple[list[dict[str, Any]], list[Car]]:
    """Return the sliders with fixed positions and the cars of the page; the first car is that of the run.

    A slider contains its values and, for each value, the ratio of the speed and the index of the car. A position at
    which the car is unstable, or out of the range of its parameters, is left out.
    """
    cars, sliders = [car], []
    for slider, changes in _changes(car, drive):
        value = drive.road.speed if slider["id"] == "speed" and drive.road else 1.0
        car_of_value = {value: 0}
        for other, change in changes.items():
            try:
                variant = car.with_(change) if change else car
                variant.check("reduced")
            except ConfigurationError:
                continue
            car_of_value[other] = 0 if variant is car else len(cars)
            cars += [] if variant is car else [variant]
        values = sorted(car_of_value)
        ratios = drive.speeds()
        numbers = {"value": value, "values": values, "cars": [car_of_value[number] for number in values]}
        numbers["ratios"] = [ratios.get(number, 1.0) if slider["id"] == "speed" else 1.0 for number in values]
        if len(values) > 1:
            sliders.append({**slider, **numbers, "dampers": []})
    return sliders, cars
