"""Springs, tyres, bars and pitch inertia of a new car from its frequencies, by Newton's method on the model itself.

Unknown factors x on the parameters of the table, one for each target: springs for the ride frequencies, tyres for the
wheel hop, bars for the roll stiffness, dampers for the damping ratios, pitch inertia of the body for the pitch
frequency. Residuals are the relative deviations q(x) / q_target - 1 of the quantities of the assembled car, so wheel
kinematics, bushings, preloads and the coupling of the modes are part of the solution. The Jacobian is taken by
differences once and then updated by Broyden's formula.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.engines.kinematics.axle_ride import axle_rides, damper_constant
from vehicle.engines.kinematics.ride_figures import ride_figures
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.quantity import field_quantity
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.model.parameters.whole_body import put
from vehicle.runs.car import Car
from vehicle.studies.design.stated_numbers import AXLES, StatedNumbers, option
from vehicle.studies.design.template_car import TemplateCar

DIFFERENCE = 0.02
"""Relative step of the differences for the Jacobian."""
SOLVED = 1e-5
"""Largest relative deviation of a solution, far below the promised 1 %."""
MOST_STEPS = 40
"""Maximum number of Newton steps; 4 to 8 are usual."""
LARGEST_STEP = 4.0
"""Largest factor by which one step may change a parameter."""
LEAST = 1e-3
"""Least factor on a parameter; the largest is its inverse."""

TYRE_SAG = (0.006, 0.05)
"""Least and largest static deflection of a tyre [m]: a solid tyre, and a flat tyre."""
BISECTIONS = 12
"""Steps of the search for the last possible car: the factor is then within 0.2 % for a bound of 1000."""
LIMITS = dict.fromkeys(("wheel_hop", "tyre_stiffness"), " (static deflection of 50 to 6 mm)")
"""Reason of the limits of a parameter, by the name of the quantity."""
WIDENS = {
    "ride_frequency": "Softer or stiffer tyres (--wheel-hop-front, -rear) and another axle load move the interval.",
    "damping_ratio": "It holds at a damper velocity of 0.1 m/s: state a value inside the range, or a --damper-curve.",
    "wheel_hop": "Lighter wheels and brakes raise it, heavier wheels lower it: change parts.*.mass of this axle in the "
    "template file, or state another kerb mass, which scales them.",
    "roll_stiffness": "The springs alone give the lowest value: a lower ride frequency or a narrower track reduces it.",
    "wheel_rate": "Bushings of the axle add to the springs: state the stiffness of the spring instead.",
    "wheel_damping": "It holds at a damper velocity of 0.1 m/s: state a value inside the range, or a --damper-curve.",
    "tyre_stiffness": "The static load of the axle limits it: state other axle loads.",
    "pitch_frequency": "The moments of a real body limit it: state other ride frequencies, axle loads, roll or yaw "
    "inertia.",
}
"""Advice on the interval that can be reached, by the name of the quantity."""

SPRING_FORCES = ("stiffness", "table.force")
"""Parameters of a spring that are proportional to its force."""
DAMPER_FORCES = ("viscous", "degressive_viscous", "force")
"""Parameters of a damper that are proportional to its viscous force."""
KEPT = {
    "ride_frequency": ("wheel_rate", "spring_stiffness"),
    "damping_ratio": ("damper_curve", "wheel_damping", "damper_constant"),
}
"""Quantities of the template that the new car keeps, unless one of these sets the part: springs and dampers fit it."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Target:
    """Target value of a quantity, and the parameters to be solved for."""

    name: str  # name of the quantity, a field of `StatedNumbers`
    value: float  # value to be met
    paths: tuple[str, ...]  # parameters that a common factor multiplies


def quantities(car: Car, template: TemplateCar, *, roll: bool = True) -> dict[str, float]:
    """Return the quantities of a car by the names of `StatedNumbers`.

    Args:
        roll: False leaves the roll stiffnesses nan, in a third of the time.
    """
    rides = axle_rides(car.model, roll=roll)
    figures = ride_figures(car.model, rides, roll=False)
    values = {"pitch_frequency": figures["pitch"].frequency_hz}
    for word in AXLES:
        ride = rides[template.axle(word)]
        values[f"ride_frequency_{word}"] = ride.ride_frequency
        values[f"damping_ratio_{word}"] = ride.damping_ratio
        values[f"roll_stiffness_{word}"] = ride.roll.stiffness * math.pi / 180.0
        values |= {
            f"unsprung_mass_{word}": 2.0 * ride.unsprung_mass,
            f"wheel_rate_{word}": ride.wheel.stiffness,
            f"wheel_damping_{word}": ride.wheel.damping,
            f"tyre_stiffness_{word}": ride.tyre.stiffness,
        }
        elements, table = template.element_paths(word), car.vehicle.table
        if elements["spring"]:
            values[f"spring_stiffness_{word}"] = value_at(table, f"{elements['spring'][0]}.stiffness")
        laws = [damper.law for damper in car.vehicle.composition.dampers if damper.path in elements["damper"]]
        if laws:
            values[f"damper_constant_{word}"] = damper_constant(laws[0])
        values[f"wheel_hop_{word}"] = figures[f"{template.axle(word)} wheel hop"].frequency_hz
    return values


def new_car_of(table: Mapping[str, Any], template: TemplateCar) -> Car:
    """Return the car of a vehicle table; templates of a user are in the folder of the template car."""
    return Car(vehicle_of(table, template.file.parent), folder=template.file.parent)


def targets_of(
    template: TemplateCar, stated: StatedNumbers, curves: Collection[str] = (), source: TemplateCar | None = None
) -> list[Target]:
    """Return the targets: the stated quantities, by default ride frequencies and damping ratios of the template.

    Args:
        template, stated: template and stated numbers.
        curves: axles whose dampers have a curve of a table.
        source: template before its axles were replaced, which gives the kept values; default: `template`.
    """
    source = source or template
    template_values = quantities(new_car_of(source.table, source), source)
    targets = []
    for word in AXLES:
        for name, paths in _parameters(template, word).items():
            value = getattr(stated, name)
            kept = next((others for first, others in KEPT.items() if name.startswith(first)), None)
            if value is None and (
                kept is None
                or (name.startswith("damping") and word in curves)
                or any(stated.of_axle(other, word) is not None for other in kept)
            ):
                continue
            present = tuple(path for path in paths if value_at(template.table, path) not in (None, 0.0))
            if value is not None and not present:
                raise ConfigurationError(
                    f"{option(name)}: the {word} axle of {template.name} has no part that sets this value; leave "
                    "it out, or start from another car"
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
    """Return the parameters of each quantity of an axle; some may be absent from the vehicle file."""
    elements = template.element_paths(word)
    for damper in template.vehicle.composition.dampers:
        if damper.law.controlled is not None:
            raise ConfigurationError(
                f"{damper.path}.control: a controlled damper has no fixed damping ratio; start from a car with passive "
                "dampers, and add the control to the new vehicle file"
            )
    springs = [f"{path}.{key}" for path in elements["spring"] for key in SPRING_FORCES]
    dampers = [f"{path}.{key}" for path in elements["damper"] for key in DAMPER_FORCES]
    tyres = [f"{template.tyre_paths[word]}.stiffness.z"]
    return {
        **{f"{name}_{word}": springs for name in ("ride_frequency", "wheel_rate", "spring_stiffness")},
        **{f"{name}_{word}": dampers for name in ("damping_ratio", "wheel_damping", "damper_constant")},
        **{f"{name}_{word}": tyres for name in ("wheel_hop", "tyre_stiffness")},
        f"roll_stiffness_{word}": [f"{path}.torsional_stiffness" for path in elements["bar"]],
    }


def solved(table: Mapping[str, Any], template: TemplateCar, targets: Sequence[Target]) -> dict[str, Any]:
    """Return the vehicle table whose quantities meet the targets.

    Raises:
        ConfigurationError: a target cannot be reached; the message has the interval that can be reached.
        SimulationError: the iteration does not converge.
    """
    problem = RideProblem(table=table, template=template, targets=tuple(targets))
    try:
        factors, unreached = problem.solved_factors()
    except ConfigurationError as error:
        raise problem.explained_error(error) from None
    if unreached is not None:
        raise problem.unreachable_error(unreached)
    return scaled(table, targets, factors)


@dataclass(frozen=True, kw_only=True, slots=True)
class RideProblem:
    """Targets of a new car and the parameters to be solved for."""

    table: Mapping[str, Any]  # vehicle table with lengths, masses and loads of the new car
    template: TemplateCar  # the template car
    targets: tuple[Target, ...]  # quantities to be met

    def values(self, factors: Vector, names: Sequence[str]) -> list[float]:
        """Return quantities of the car with factors on the parameters of the targets.

        Raises:
            ConfigurationError: the car is impossible.
        """
        changed = scaled(self.table, self.targets, factors)
        _require_inertia(changed, self.targets)
        roll = any(name.startswith("roll_stiffness") for name in names)
        figures = quantities(new_car_of(changed, self.template), self.template, roll=roll)
        return [figures[name] for name in names]

    def factor_bounds(self) -> tuple[Vector, Vector]:
        """Return the lower and the upper bound of the factor on the parameter of each target."""
        lower, upper = np.full((2, len(self.targets)), [[LEAST], [1.0 / LEAST]])
        for index, target in enumerate(self.targets):
            if target.name.startswith(("wheel_hop", "tyre_stiffness")):
                load = _mean_load(self.table, self.template, target.name.rpartition("_")[2])
                stiffness = value_at(self.table, target.paths[0].removesuffix(".z"))[2]
                lower[index], upper[index] = (load / (sag * stiffness) for sag in reversed(TYRE_SAG))
        return lower, upper

    def solved_factors(self) -> tuple[Vector, int | None]:
        """Return the factors that meet the targets, and the index of a target out of reach of its parameter.

        A parameter stays at its bound while its target requires more; the other targets are solved without it.

        Raises:
            ConfigurationError: an iterate is no car.
            SimulationError: the iteration does not converge.
        """
        aims = np.array([target.value for target in self.targets])
        lower, upper = self.factor_bounds()

        def deviation(factors: Vector) -> Vector:
            figures = np.array(self.values(factors, [target.name for target in self.targets]))
            return np.asarray(figures / aims - 1.0)

        factors = np.clip(np.ones(len(aims)), lower, upper)
        residual = deviation(factors)
        jacobian = np.empty((len(aims), len(aims)))
        for column in range(len(aims)):
            moved = factors.copy()
            moved[column] += DIFFERENCE * factors[column]
            jacobian[:, column] = (deviation(moved) - residual) / (DIFFERENCE * factors[column])
        for _ in range(MOST_STEPS):
            # A quantity grows with the parameter of its target; only pitch falls, and Iyy limits it first.
            held = ((factors <= lower) & (residual > SOLVED)) | ((factors >= upper) & (residual < -SOLVED))
            free = ~held
            if not np.any(np.abs(residual[free]) >= SOLVED):
                return factors, int(np.argmax(held)) if np.any(held) else None
            step = np.zeros(len(aims))
            step[free] = -np.linalg.lstsq(jacobian[np.ix_(free, free)], residual[free], rcond=None)[0]
            low, high = np.maximum(lower, factors / LARGEST_STEP), np.minimum(upper, factors * LARGEST_STEP)
            step = np.clip(factors + step, low, high) - factors
            factors, last = factors + step, residual
            residual = deviation(factors)
            jacobian += np.outer(residual - last - jacobian @ step, step) / (step @ step)
        worst = int(np.argmax(np.abs(residual)))
        raise SimulationError(
            f"{option(self.targets[worst].name)} {aims[worst]:g}: not reached within {MOST_STEPS} steps (deviation "
            f"{100.0 * residual[worst]:.2f} %); state a value nearer to that in {self.template.name}, or leave it out"
        )

    def reachable_interval(self, index: int) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the interval that a target can reach, and the factors on its parameter at both ends.

        All other targets are met at both ends. If that is impossible at a bound, the last possible factor replaces it.
        """
        lower, upper = self.factor_bounds()
        ends = [self.last_end(index, float(bound[index])) for bound in (lower, upper)]
        values = sorted(value for _, value in ends)
        return (values[0], values[-1]), (ends[0][0], ends[1][0])

    def value_at_factor(self, index: int, factor: float) -> float:
        """Return the quantity of a target with a factor on its parameter, all other targets met.

        Raises:
            ConfigurationError, SimulationError: the other targets cannot be met.
        """
        target, others = self.targets[index], (*self.targets[:index], *self.targets[index + 1 :])
        table = scaled(self.table, [target], np.array([factor]))
        # Of the target itself only the limits of its parameter count.
        _require_inertia(table, [target])
        problem = RideProblem(table=table, template=self.template, targets=others)
        factors, unreached = problem.solved_factors()
        if unreached is not None:
            raise ConfigurationError(f"{option(others[unreached].name)}: out of reach")
        return problem.values(factors, [target.name])[0]

    def last_end(self, index: int, bound: float) -> tuple[float, float]:
        """Return factor and quantity at a bound, or at the last factor between 1 and the bound that is possible.

        Raises:
            ConfigurationError, SimulationError: a factor of 1 is impossible too.
        """
        possible, impossible, factor, value = 1.0, bound, bound, math.nan
        for _ in range(BISECTIONS):
            try:
                value = self.value_at_factor(index, factor)
            except (ConfigurationError, SimulationError):
                impossible = factor
            else:
                possible = factor
            if possible == bound:
                break
            factor = math.sqrt(possible * impossible)
        return possible, value if math.isfinite(value) else self.value_at_factor(index, possible)

    def unreachable_error(self, index: int) -> ConfigurationError:
        """Return the error of a target that cannot be reached, with the interval and what widens it."""
        target = self.targets[index]
        (low, high), factors = self.reachable_interval(index)
        path = target.paths[0]
        value = value_at(self.table, path.removesuffix(".z"))
        value = value[2] if path.endswith(".z") else value[-1] if isinstance(value, list | tuple) else value
        unit = self.template.vehicle.quantity_of(path).get("unit", "-")
        first, last = (f"{factor * value:.4g}" for factor in factors)
        name = target.name.removesuffix("_front").removesuffix("_rear")
        of = field_quantity(StatedNumbers, target.name)["unit"]
        return ConfigurationError(
            f"{option(target.name)} {target.value:g} {'' if of == '-' else of}: cannot be reached; must be "
            f"{low:.4g} to {high:.4g} {'' if of == '-' else of}, with {path} from {first} to {last} "
            f"{unit}{LIMITS.get(name, '')}. {WIDENS.get(name, '')}".rstrip()
            .replace(" :", ":")
            .replace(" ,", ",")
        )

    def explained_error(self, error: ConfigurationError) -> ConfigurationError:
        """Return the error of an iterate that is no car: of the target whose parameter it names, with its interval."""
        for index, target in enumerate(self.targets):
            names = (option(target.name), *(path.removesuffix(".z") for path in target.paths))
            if any(name in error.args[0] for name in names):  # the text with options, also in Python
                return self.unreachable_error(index)
        values = ", ".join(f"{option(target.name)} {target.value:.4g}" for target in self.targets)
        return ConfigurationError(f"with {values}: {error}")


def _mean_load(table: Mapping[str, Any], template: TemplateCar, word: str) -> float:
    """Return the mean static load of the wheels of an axle [N]."""
    loads = new_car_of(table, template).model.static.tyre_load
    return float(np.mean([loads[wheel.name] for wheel in template.wheels[word]]))


def _require_inertia(table: Mapping[str, Any], targets: Sequence[Target]) -> None:
    """Raise an error if the pitch frequency needs moments of inertia that are not physical."""
    for target in targets:
        if target.name == "pitch_frequency":
            ixx, iyy, izz = (table["body"]["inertia"][key] for key in ("ixx", "iyy", "izz"))
            if not abs(izz - ixx) < iyy < ixx + izz:
                raise ConfigurationError(
                    f"{option(target.name)} {target.value:g} Hz: with these ride frequencies it needs Iyy = {iyy:.0f} "
                    f"kg m2 of the body, which must be between {abs(izz - ixx):.0f} and {ixx + izz:.0f} kg m2 (Ixx "
                    f"{ixx:.0f}, Izz {izz:.0f}); check it against the ride frequencies, or leave it out"
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
        vector[2] = rounded(factor * vector[2], 9)
        put(table, {path.removesuffix(".z"): vector})  # type: ignore[dict-item]
        return
    value = value_at(table, path)
    numbers = [rounded(factor * item, 9) for item in (value if isinstance(value, list | tuple) else [value])]
    put(table, {path: numbers if isinstance(value, list | tuple) else numbers[0]})  # type: ignore[dict-item]
