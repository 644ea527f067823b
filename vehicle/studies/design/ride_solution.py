"""Springs, tyres, bars and pitch inertia of a new car from its frequencies, by Newton's method on the model itself.

Unknown factors x on the parameters of the table, one for each target: springs for the ride frequencies, tyres for the
wheel hop, bars for the roll stiffness, dampers for the damping ratios, pitch inertia of the body for the pitch
frequency. Residuals are the relative deviations q(x) / q_target - 1 of the quantities of the assembled car, so wheel
kinematics, bushings, preloads and the coupling of the modes are part of the solution. The Jacobian is taken by
differences once and then updated by Broyden's formula.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.axle_ride import axle_rides
from vehicle.engines.simulation.ride_figures import ride_figures
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.model.parameters.whole_body import put
from vehicle.runs.car import Car
from vehicle.studies.design.stated_numbers import AXLES, StatedNumbers, option
from vehicle.studies.design.template_car import TemplateCar

Vector = npt.NDArray[np.float64]

DIFFERENCE = 0.02
"""Relative step of the differences for the Jacobian."""
SOLVED = 1e-5
"""Largest relative deviation of a solution, far below the promised 1 %."""
MOST_STEPS = 40
"""Maximum number of Newton steps; 4 to 8 are usual."""
LARGEST_STEP = 4.0
"""Largest factor by which one step may change a parameter."""
LEAST = 1e-3
"""Factor on a parameter of the template below which the target requires a negative value."""

SPRING_FORCES = ("stiffness", "table.force")
"""Parameters of a spring that are proportional to its force."""
DAMPER_FORCES = ("viscous", "degressive_viscous", "force")
"""Parameters of a damper that are proportional to its viscous force."""
KEPT = ("ride_frequency", "damping_ratio")
"""Quantities of the template that the new car keeps if no others are stated: springs and dampers fit the car."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Target:
    """Target value of a quantity, and the parameters to be solved for.

    Attributes:
        name: name of the quantity, a field of `StatedNumbers`.
        value: value to be met.
        paths: parameters that a common factor multiplies.
    """

    name: str
    value: float
    paths: tuple[str, ...]


def quantities(car: Car, template: TemplateCar) -> dict[str, float]:
    """Return the quantities of a car by the names of `StatedNumbers`.

    Args:
        car: car with the axles of the template.
        template: the template car.
    """
    rides = axle_rides(car.model)
    figures = ride_figures(car.model, rides)
    values = {"pitch_frequency": figures["pitch"].frequency_hz}
    for word in AXLES:
        ride = rides[template.axle(word)]
        values[f"ride_frequency_{word}"] = ride.ride_frequency
        values[f"damping_ratio_{word}"] = ride.damping_ratio
        values[f"roll_stiffness_{word}"] = ride.roll.stiffness * math.pi / 180.0
        values[f"wheel_hop_{word}"] = figures[f"{template.axle(word)} wheel hop"].frequency_hz
    return values


def new_car_of(table: Mapping[str, Any], template: TemplateCar) -> Car:
    """Return the car of a vehicle table; templates of a user are in the folder of the template car."""
    return Car(vehicle_of(table, template.file.parent), folder=template.file.parent)


def targets_of(template: TemplateCar, stated: StatedNumbers) -> list[Target]:
    """Return the targets: the stated quantities, by default ride frequencies and damping ratios of the template.

    Raises:
        ConfigurationError: the template lacks the part that a target needs, or has a controlled damper.
    """
    template_values = quantities(new_car_of(template.table, template), template)
    targets = []
    for word in AXLES:
        for name, paths in _parameters(template, word).items():
            value = getattr(stated, name)
            curve = name.startswith("damping") and stated.of_axle("damper_curve", word) is not None
            if curve or (value is None and not name.startswith(KEPT)):
                continue
            present = tuple(path for path in paths if value_at(template.table, path) not in (None, 0.0))
            if value is not None and not present:
                raise ConfigurationError(
                    f"{option(name)}: the {word} axle of {template.name} has no part for it; leave it out, or "
                    "start from another car"
                )
            if present:
                targets.append(Target(name=name, value=value or template_values[name], paths=present))
    if stated.pitch_frequency is not None:
        # A long body is long in pitch and yaw: the estimate of the yaw inertia follows.
        moments = ("iyy",) if stated.yaw_inertia is not None else ("iyy", "izz")
        followed = tuple(f"body.inertia.{moment}" for moment in moments)
        targets.append(Target(name="pitch_frequency", value=stated.pitch_frequency, paths=followed))
    return targets


def _parameters(template: TemplateCar, word: str) -> dict[str, list[str]]:
    """Return the parameters of each quantity of an axle; some may be absent from the vehicle file.

    Raises:
        ConfigurationError: a controlled damper, which has no fixed damping ratio.
    """
    elements = template.element_paths(word)
    for damper in template.vehicle.composition.dampers:
        if damper.law.controlled is not None:
            raise ConfigurationError(
                f"{damper.path}.control: a controlled damper has no fixed damping ratio; start from a car with passive "
                "dampers, and add the control to the new vehicle file"
            )
    return {
        f"ride_frequency_{word}": [f"{path}.{key}" for path in elements["spring"] for key in SPRING_FORCES],
        f"damping_ratio_{word}": [f"{path}.{key}" for path in elements["damper"] for key in DAMPER_FORCES],
        f"wheel_hop_{word}": [f"{template.tyre_paths[word]}.stiffness.z"],
        f"roll_stiffness_{word}": [f"{path}.torsional_stiffness" for path in elements["bar"]],
    }


def solved(table: Mapping[str, Any], template: TemplateCar, targets: Sequence[Target]) -> dict[str, Any]:
    """Return the vehicle table whose quantities are those of the targets.

    Args:
        table: vehicle table with lengths, masses and loads of the new car.
        template: the template car.
        targets: quantities to be met.

    Raises:
        ConfigurationError: a target requires a negative parameter, or the springs cannot support the car.
        SimulationError: the iteration does not converge.
    """

    def deviation(factors: Vector) -> Vector:
        changed = scaled(table, targets, factors)
        _require_inertia(changed, targets)
        try:
            values = quantities(new_car_of(changed, template), template)
        except ConfigurationError as error:
            values_text = ", ".join(f"{option(target.name)} {target.value:.4g}" for target in targets)
            raise ConfigurationError(f"with {values_text}: {error}") from None
        return np.array([values[target.name] / target.value - 1.0 for target in targets])

    factors = np.ones(len(targets))
    residual = deviation(factors)
    jacobian = np.empty((len(targets), len(targets)))
    for column in range(len(targets)):
        moved = factors.copy()
        moved[column] += DIFFERENCE
        jacobian[:, column] = (deviation(moved) - residual) / DIFFERENCE
    for _ in range(MOST_STEPS):
        if np.max(np.abs(residual)) < SOLVED:
            return scaled(table, targets, factors)
        aim = factors - np.linalg.lstsq(jacobian, residual, rcond=None)[0]
        bounded = np.clip(aim, factors / LARGEST_STEP, factors * LARGEST_STEP)
        _require_positive(bounded, targets, residual)
        step, last = bounded - factors, residual
        factors = bounded
        residual = deviation(factors)
        jacobian += np.outer(residual - last - jacobian @ step, step) / (step @ step)
    worst = int(np.argmax(np.abs(residual)))
    raise SimulationError(
        f"{option(targets[worst].name)} {targets[worst].value:g}: not met within {MOST_STEPS} steps, deviation "
        f"{100.0 * residual[worst]:.2f} %; state a value nearer to that of {template.name}, or leave it out"
    )


def _require_inertia(table: Mapping[str, Any], targets: Sequence[Target]) -> None:
    """Raise an error if the pitch frequency needs moments of inertia that are not physical."""
    for target in targets:
        if target.name == "pitch_frequency":
            ixx, iyy, izz = (table["body"]["inertia"][key] for key in ("ixx", "iyy", "izz"))
            if not abs(izz - ixx) < iyy < ixx + izz:
                raise ConfigurationError(
                    f"{option(target.name)} {target.value:g} Hz: with these ride frequencies it needs Iyy = {iyy:.0f} "
                    f"kg m2 of the body, must be between {abs(izz - ixx):.0f} and {ixx + izz:.0f} kg m2 (Ixx "
                    f"{ixx:.0f}, Izz {izz:.0f}); check it against the ride frequencies, or leave it out"
                )


def _require_positive(factors: Vector, targets: Sequence[Target], residual: Vector) -> None:
    """Raise an error for a target that requires a negative parameter."""
    for factor, target, deviation in zip(factors, targets, residual, strict=True):
        if factor < LEAST:
            raise ConfigurationError(
                f"{option(target.name)} {target.value:g}: needs a negative {target.paths[0]}; with it near zero the "
                f"other parts of the car still give {target.value * (1.0 + deviation):.3g}; state a higher value"
            )


def scaled(table: Mapping[str, Any], targets: Sequence[Target], factors: Vector) -> dict[str, Any]:
    """Return a vehicle table with the parameters of the targets multiplied by their factors."""
    changed = dict(table)
    for target, factor in zip(targets, factors, strict=True):
        for path in target.paths:
            _multiply(changed, path, float(factor))
    return changed


def _multiply(table: dict[str, Any], path: str, factor: float) -> None:
    """Multiply a number, a list of numbers or the component z of a vector in a vehicle table."""
    if path.endswith(".z"):
        vector = list(value_at(table, path.removesuffix(".z")))
        vector[2] = _rounded(factor * vector[2])
        put(table, {path.removesuffix(".z"): vector})  # type: ignore[dict-item]
        return
    value = value_at(table, path)
    numbers = [_rounded(factor * item) for item in (value if isinstance(value, list | tuple) else [value])]
    put(table, {path: numbers if isinstance(value, list | tuple) else numbers[0]})  # type: ignore[dict-item]


def _rounded(value: float) -> float:
    """Return a number of nine digits: below the tolerance of the solution, and legible in a file."""
    return float(f"{value:.9g}")
