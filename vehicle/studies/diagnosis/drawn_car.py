"""Cars that a diagnosis considers possible: dampers, tyres, springs, mounts, masses and loads, drawn at random.

All are uniform, or uniform on a logarithmic scale where the range is given as a ratio. Unknowns that
no record shows are drawn too, and widen the intervals of a diagnosis.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.errors import SimulationError
from vehicle.model.parameters.force_elements import Bushing, Damper, Hydromount, MainSpring, Stabilizer, Tyre
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.paths import value_at
from vehicle.names import AXES, axle_and_side
from vehicle.runs.car import Car
from vehicle.studies.diagnosis.damper_force import drawn_damper, outer_slope, require_passive, with_static_friction

WEAKEST, STRONGEST = 0.25, 1.2
"""Range of the factor of a damper [-]: from a loss of three quarters of the force to a new damper that is a fifth
stronger than stated. All values are equally likely before the record is read."""

FRICTION, FRICTION_SIDES, STATIC = 1.7, 1.4, 2.0
"""Ratio by which the friction of both dampers of an axle is smaller or larger, and of one damper further; largest ratio
of friction at rest and in motion, for Stribeck friction in place of Coulomb friction."""

BEND, REBOUND = 0.2, 1.2
"""Largest exponent of the shape of the dampers of an axle, and largest ratio of their rebound and compression."""

KNEE, KNEE_VELOCITY = 1.8, (0.03, 0.2)
"""Largest ratio of the slopes below and above the knee of one damper, either way, and range of its velocity [m/s],
logarithmic: valves differ, and wear moves them."""

TYRE, TYRE_SIDES, TYRE_DAMPING = 1.15, 1.08, 2.0
"""Ratios of the vertical stiffness of the tyres of an axle, of one tyre further, and of their damping."""

SPRING, MOUNT, MOUNT_SIDES, BODY = 1.3, 1.3, 1.35, 1.05
"""Ratios of springs and stabilizers, of both bushings of an axle, of one bushing further, and of the body mass."""

LOADS = {"front_left": (0.45, -0.35, 110.0), "front_right": (0.45, 0.35, 110.0), "rear": (0.85, 0.0, 250.0)}
"""Loads: distance from the front axle over the wheelbase [-], distance from the middle [m], largest mass [kg]. The
rear and one of the front seats, either, are empty in half of the cars."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DrawnCar:
    """A drawn car in the form that the batch engine takes.

    Attributes:
        values: names of its unknowns to their values.
        poles: its linear part.
        dampers: its dampers.
        tyre_load: static loads of its tyres [N].
    """

    values: Mapping[str, float]
    poles: PoleModel
    dampers: Sequence[Damper]
    tyre_load: Mapping[str, float]


class CarPrior:
    """Random cars around a given car, at one speed.

    Args:
        car: car that is not worn.
        speed: speed at which its tyres roll [m/s].
    """

    def __init__(self, car: Car, speed: float) -> None:
        composition = car.vehicle.composition
        require_passive(composition)
        self.nominal = [damper.law for damper in composition.dampers]
        wheels = {wheel.name: wheel.patch for wheel in composition.wheels}
        front = min(patch[0] for patch in wheels.values())
        wheelbase = max(patch[0] for patch in wheels.values()) - front
        height = car.vehicle.body.cog[2]
        stated: dict[str, Any] = {"driving.speed": speed}
        for name, (along, across, _) in LOADS.items():
            stated |= {f"load.{name}.mass": 0.0, f"load.{name}.at": [front + along * wheelbase, across, height]}
        self.tyres: dict[str, tuple[str, float, float]] = {}
        mounts = list[tuple[str, str, str, Point]]()
        for connection in composition.connections:
            # The last table belongs to the side.
            law, path = connection.law, connection.tables[-1] if connection.tables else ""
            if isinstance(law, Tyre):
                wheel = connection.carrier.removeprefix("plate_")
                stated |= {f"{path}.{key}": list(getattr(law, key)) for key in ("stiffness", "damping")}
                self.tyres[wheel] = path, law.stiffness[2], law.damping[2]
            elif isinstance(law, Bushing | Hydromount):
                stated[f"{path}.stiffness"] = list(law.stiffness)
                mounts.append((connection.name, connection.path, path, law.stiffness))
        self.mounts = tuple(mounts)
        stated_car = car.with_(stated)
        tables = tuple(
            replace(damper, law=drawn_damper(damper.law, 1.0, 0.0, 1.0, 1.0))
            for damper in stated_car.vehicle.composition.dampers
        )
        vehicle = replace(stated_car.vehicle, composition=replace(stated_car.vehicle.composition, dampers=tables))
        self.car = Car(vehicle, folder=car.folder)
        self._axles = sorted({axle_and_side(wheel)[0] for wheel in wheels})
        self.slopes = np.array([outer_slope(law) for law in self.nominal])
        _ = self.car.poles

    @cached_property
    def _numbers(self) -> dict[str, list[tuple[str, float]]]:
        """Return the unknowns of springs: name to the paths that it scales and their values."""
        table, numbers = self.car.vehicle.table, dict[str, list[tuple[str, float]]]()
        for path, law in self.car.vehicle.composition.kinds.items():
            if law is MainSpring:
                numbers[f"spring {path}"] = [(f"{path}.stiffness", value_at(table, f"{path}.stiffness"))]
            elif law is Stabilizer:
                key = f"{path}.torsional_stiffness"
                numbers[f"stabilizer {path}"] = [(key, value_at(table, key))]
        return {name: pairs for name, pairs in numbers.items() if all(value for _, value in pairs)}

    def draw(self, rng: np.random.Generator) -> DrawnCar:
        """Return a car drawn at random, whose dampers are not worn; see `with_dampers`."""
        values, overrides = dict[str, float](), dict[str, float]()
        axles = {axle: (_ratio(TYRE, rng), _ratio(TYRE_DAMPING, rng)) for axle in self._axles}
        for wheel, (path, stiffness, damping) in self.tyres.items():
            tyre, tyre_damping = axles[axle_and_side(wheel)[0]]
            factor = tyre * _ratio(TYRE_SIDES, rng)
            overrides |= {f"{path}.stiffness.z": factor * stiffness, f"{path}.damping.z": tyre_damping * damping}
            values[f"tyre {wheel}"] = factor
        for name, pairs in self._numbers.items():
            factor = _ratio(SPRING, rng)
            overrides |= {path: factor * value for path, value in pairs}
            values[name] = factor
        of_axle = {path: _ratio(MOUNT, rng) for path in dict.fromkeys(path for _, path, _, _ in self.mounts)}
        for name, of_both, path, constants in self.mounts:
            values[f"mount {name}"] = factor = of_axle[of_both] * _ratio(MOUNT_SIDES, rng)
            by_axis = zip(AXES, constants, strict=True)
            overrides |= {f"{path}.stiffness.{axis}": factor * value for axis, value in by_axis if value > 0.0}
        values["body"] = _ratio(BODY, rng)
        overrides["body.mass"] = values["body"] * self.car.vehicle.body.mass
        seats = ("front_left", "front_right", None, None)
        empty = (seats[rng.integers(4)], "rear" if rng.random() < 0.5 else None)
        for name, (_, _, heaviest) in LOADS.items():
            values[f"load {name}"] = 0.0 if name in empty else float(rng.uniform(0.0, heaviest))
            overrides[f"load.{name}.mass"] = values[f"load {name}"]
        car = self.car.with_(overrides)
        poles = car.poles
        if not np.allclose(poles.matrices.viscous, self.slopes, rtol=1e-6):
            raise SimulationError("diagnose: the car needs a new model for each change; state its dampers as tables")
        return DrawnCar(values=values, poles=poles, dampers=self.nominal, tyre_load=car.static.tyre_load)

    def with_dampers(self, car: DrawnCar, rng: np.random.Generator) -> DrawnCar:
        """Return a drawn car with dampers drawn at random; its poles are the same."""
        values, dampers = dict[str, float](), list[Damper]()
        axles = {
            axle: (_ratio(FRICTION, rng), float(rng.uniform(-BEND, BEND)), _ratio(REBOUND, rng)) for axle in self._axles
        }
        for placed, nominal in zip(self.car.vehicle.composition.dampers, self.nominal, strict=True):
            wheel = placed.name.removeprefix("damper_")
            friction, bend, rebound = axles[axle_and_side(wheel)[0]]
            factor, friction = float(rng.uniform(WEAKEST, STRONGEST)), friction * _ratio(FRICTION_SIDES, rng)
            knee = float(np.exp(rng.uniform(*np.log(KNEE_VELOCITY)))), _ratio(KNEE, rng)
            dampers.append(drawn_damper(nominal, factor, bend, rebound, friction, knee))
            if nominal.friction_law == "coulomb" and rng.random() < 0.5:
                dampers[-1] = with_static_friction(dampers[-1], float(rng.uniform(1.0, STATIC)))
            values |= {f"damper {wheel}": factor, f"friction {wheel}": friction}
        return replace(car, values={**values, **car.values}, dampers=dampers)


def _ratio(largest: float, rng: np.random.Generator) -> float:
    """Return a ratio from 1/largest to largest, uniform on a logarithmic scale."""
    return float(largest ** rng.uniform(-1.0, 1.0))
