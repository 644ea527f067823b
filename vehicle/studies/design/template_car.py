"""Car that a new car starts from: its two axles, their wheels, and the names of what a design changes."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.composition import PlacedWheel
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.toml_file import copy_table
from vehicle.model.parameters.vehicle import Vehicle, vehicle_of
from vehicle.model.parameters.whole_body import put
from vehicle.studies.design.stated_numbers import AXLES


@dataclass(frozen=True, kw_only=True, slots=True)
class TemplateCar:
    """Template of a new car, with a rigid body and without loads."""

    name: str  # name of the template car
    file: Path  # its vehicle file
    # its parameters, with a rigid body, without [load] and without the names of other files of its folder
    table: Mapping[str, Any]
    vehicle: Vehicle  # the same, composed
    # wheels by the word of their axle, "front" or "rear"; right and left
    wheels: Mapping[str, tuple[PlacedWheel, PlacedWheel]]
    left_out: tuple[str, ...]  # messages about parts of the template that are left out

    def axle(self, word: str) -> str:
        """Return the table of an axle in the vehicle file."""
        return self.wheels[word][0].axle

    @property
    def front_x(self) -> float:
        """Return the position of the front axle [m]."""
        return self.wheels["front"][0].center[0]

    @property
    def wheelbase(self) -> float:
        """Return the distance of the axles [m]."""
        return self.wheels["rear"][0].center[0] - self.front_x

    @property
    def tyre_radius(self) -> float:
        """Return the height of the front wheel centres above the ground [m]."""
        return self.wheels["front"][0].center[2] - self.ground

    @property
    def ground(self) -> float:
        """Return the height of the plates under the front wheels [m]."""
        return self.wheels["front"][0].patch[2]

    @property
    def point_names(self) -> dict[str, tuple[str, ...]]:
        """Return the names of hardpoints, parts and bushings by axle; parts as "parts.knuckle"."""
        axles = {word: self.table[self.axle(word)] for word in AXLES}
        return {
            word: (
                *axle.get("hardpoints", {}),
                *(f"{section}.{name}" for section in ("parts", "bushings") for name in axle.get(section, {})),
            )
            for word, axle in axles.items()
        }

    def with_powertrain(self, engine: Mapping[str, Any] | None) -> TemplateCar:
        """Return the template with another powertrain; itself for None."""
        if engine is None:
            return self
        if "engine" not in self.table:
            raise ConfigurationError(
                f"--car-class: {self.name} has no section [engine] for the powertrain; start from sedan"
            )
        table = {**self.table, "engine": copy_table(engine)}
        return dataclasses.replace(self, table=table, vehicle=vehicle_of(table, self.file.parent))

    def track(self, word: str) -> float:
        """Return the distance of the wheels of an axle [m]."""
        right, left = self.wheels[word]
        return right.center[1] - left.center[1]

    @property
    def mean_track(self) -> float:
        """Return the mean track of both axles [m]."""
        return float(np.mean([self.track(word) for word in AXLES]))

    @property
    def tyre_paths(self) -> dict[str, str]:
        """Return the path of the table of the tyres by the word of their axle."""
        by_plate = {link.carrier: link.path for link in self.vehicle.composition.connections if link.ground}
        return {word: by_plate[wheels[0].plate] for word, wheels in self.wheels.items()}

    def element_paths(self, word: str) -> dict[str, list[str]]:
        """Return the paths of the springs, bars and dampers of an axle, by "spring", "bar", "damper"."""
        car, axle = self.vehicle.composition, f"{self.axle(word)}."
        elements: dict[str, Sequence[Any]] = {"spring": car.springs, "bar": car.joint_springs, "damper": car.dampers}
        return {
            word_of_type: list(dict.fromkeys(entry.path for entry in entries if entry.path.startswith(axle)))
            for word_of_type, entries in elements.items()
        }


def template_car(source: Path | str) -> TemplateCar:
    """Read the template of a new car.

    Args:
        source: name of a shipped car, or a vehicle file.
    """
    file = vehicle_file(source)
    table = copy_table(vehicle_table(file))
    left_out = []
    if table["body"].get("flexible", True):
        left_out.append(
            "its flexible body, whose mode shapes belong to another body; the new body is rigid (docs: own body)"
        )
    for key in ("superelement", "modes_up_to", "frequency_scale", "model_mass", "modes"):
        table["body"].pop(key, None)
    put(table, {"body.flexible": False, "body.attachment_flexibility": False})
    users = _texts({key: value for key, value in table.items() if key != "alias"})
    points = table.get("hardpoints", {})
    table["hardpoints"] = {name: point for name, point in points.items() if name in users}
    if loads := table.pop("load", None):
        left_out.append(f"its loads {', '.join(loads)}; state your loads as [load.NAME] in the --numbers file")
    steady = [name for name in ("acceleration", "lateral") if table.get("driving", {}).pop(name, None)]
    if steady:
        names = " and ".join(f"driving.{name}" for name in steady)
        left_out.append(f"its {names}, which would move the loads; set it for each run")
    vehicle = vehicle_of(table, file.parent)
    axles: dict[str, list[PlacedWheel]] = {}
    for wheel in vehicle.composition.wheels:
        axles.setdefault(wheel.axle, []).append(wheel)
    pairs = sorted(axles.values(), key=lambda wheels: wheels[0].center[0])
    if [len(wheels) for wheels in pairs] != [2, 2]:
        raise ConfigurationError(
            f"--from {source}: a new car needs two axles with two wheels each; {vehicle.name} has "
            f"{', '.join(vehicle.wheels)}; start from sedan"
        )
    return TemplateCar(
        name=vehicle.name,
        file=file,
        table=vehicle.table,
        vehicle=vehicle,
        wheels={
            word: (right, left)
            for word, (left, right) in zip(
                AXLES, [sorted(wheels, key=lambda wheel: wheel.side) for wheels in pairs], strict=True
            )
        },
        left_out=tuple(left_out),
    )


def _texts(table: Mapping[str, Any]) -> set[str]:
    """Return all texts in a vehicle file: the names of the points that something uses are among them."""
    texts = {value for value in table.values() if isinstance(value, str)}
    return texts.union(*(_texts(value) for value in table.values() if isinstance(value, Mapping)))
