"""Masses, loads, stiffnesses, frequencies, geometry and parameters of a car."""

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.parameters.parameter_list import Parameter, parameter_list
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.names import point_words
from vehicle.runs.car.axle import axle_names, car_at_rest, mass_and_cog
from vehicle.runs.car.axle_data import AxleData, axle_data
from vehicle.runs.car.motion_figures import MotionFigure, damper_notes, motion_figures
from vehicle.runs.car.steady_data import SteadyData, steady_data
from vehicle.runs.car.usual_figures import UsualFigure, usual_figures
from vehicle.threads import one_blas_thread
from vehicle.wording import in_words


@dataclass(frozen=True, kw_only=True, slots=True)
class CarData:
    """Data of a car at rest.

    Attributes:
        name: name of the car.
        overrides: changed parameters as "path=value".
        tyres: "standing" or "rolling at ... km/h".
        gravity: gravity [m/s2].
        mass_kg: mass of the whole car.
        trimmed_body_kg: mass of the trimmed body.
        sprung_kg, unsprung_kg: mass without the unsprung masses of the axles, and their sum.
        cog_m: centre of gravity in the frame of the hardpoints (x to the rear, y to the right, z up).
        cog_height_m: its height above the ground.
        cog_behind_front_m: its distance behind the wheel centres of the first axle.
        inertia_kg_m2: Ixx, Iyy, Izz and the integral of z x about it.
        wheelbase_m: distance of two axles; None for a car with another number of axles on wheels.
        loads_kg: masses of persons, luggage and other loads, `[load.NAME]` and `[seat.NAME]` of the vehicle file.
        support_n: static load of each contact with the ground other than a tyre [N].
        axles: axles with wheels.
        figures: headline figures: heave, pitch, roll, wheel hop; see `MotionFigure`.
        notes: quantities that are not defined for this car, and why.
        parameters: all parameters.
        steady: position and loads in steady acceleration; None without.
    """

    name: str
    overrides: tuple[str, ...]
    tyres: str
    gravity: float
    mass_kg: float
    trimmed_body_kg: float
    sprung_kg: float
    unsprung_kg: float
    cog_m: tuple[float, float, float]
    cog_height_m: float
    cog_behind_front_m: float
    inertia_kg_m2: tuple[float, float, float, float]
    wheelbase_m: float | None
    loads_kg: Mapping[str, float]
    support_n: Mapping[str, float]
    axles: tuple[AxleData, ...]
    figures: tuple[MotionFigure, ...]
    notes: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    steady: SteadyData | None = None

    def __repr__(self) -> str:
        """One line."""
        front = f", {100 * self.front_share:.0f} % in front" if self.wheelbase_m is not None else ""
        return f"CarData({self.name}, {self.mass_kg:.0f} kg{front}, CoG {1e3 * self.cog_height_m:.0f} mm high)"

    def __str__(self) -> str:
        """All values but the parameters, as text."""
        from vehicle.runs.car.car_text import car_text

        return in_words(car_text(self))

    def summary(self) -> dict[str, Any]:
        """Return all values as plain numbers and texts, for JSON; None for a value that is not defined."""
        plain = _plain(dataclasses.asdict(self))
        for entry, axle in zip(plain["axles"], self.axles, strict=True):
            entry["roll"] |= {"suspension": axle.roll.suspension, "total": axle.roll.total}
            percent = self.support_percent(axle) or (None, None)
            entry |= {"brake_support_percent": percent[0], "drive_support_percent": percent[1]}
        usual = [{**dataclasses.asdict(figure), "unusual": figure.unusual} for figure in self.usual]
        if self.steady is None:
            del plain["steady"]
        return {
            **plain,
            "front_share": _plain(self.front_share),
            "roll_share": self.roll_share,
            "usual": _plain(usual),
        }

    @property
    def usual(self) -> tuple[UsualFigure, ...]:
        """Figures of the car and of its axles with their usual ranges."""
        return usual_figures(self)

    @property
    def front_share(self) -> float:
        """Share of the first axle in the static loads [-]."""
        loads = [sum(axle.load_n.values()) for axle in self.axles]
        return loads[0] / (sum(loads) + sum(self.support_n.values()))

    def support_percent(self, axle: AxleData) -> tuple[float, float] | None:
        """Return anti-dive or anti-lift and anti-squat or anti-lift of an axle in per cent, for all of the force on it.

        100 tan(angle) l / h with the wheelbase l and the height h of the centre of gravity (Milliken, chapter 17): the
        share of the load transfer that the linkage carries. With a share of the brake or drive force the value is that
        share of it.

        Returns:
            Value for brake forces at the contact point, and for drive forces at the wheel centre; None without a
            wheelbase.
        """
        if self.wheelbase_m is None:
            return None
        angles = np.radians([axle.geometry.brake_support_deg, axle.geometry.drive_support_deg])
        brake, drive = 100.0 * np.tan(angles) * self.wheelbase_m / self.cog_height_m
        return float(brake), float(drive)

    @property
    def roll_share(self) -> float | None:
        """Share of the first axle in the roll stiffness with tyres [-]; None for another number of axles than two."""
        if self.wheelbase_m is None:
            return None
        first, second = (axle.roll.total for axle in self.axles)
        return first / (first + second)


def _plain(value: Any) -> Any:
    """Return a value with lists for tuples, and None for a number that is not finite."""
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


@one_blas_thread()
def car_data(car: Any) -> CarData:
    """Compute the data of a car.

    Args:
        car: the car; on rolling tyres the modes listed with the figures are those at its speed, and `steady` is that
            in its steady acceleration, all other data are those at rest.

    Raises:
        ConfigurationError: the car cannot be built.
        SimulationError: an axle has no equilibrium near its design position.
    """
    still = car_at_rest(car)
    vehicle = car.vehicle
    mass, cog = mass_and_cog(still)
    axles = tuple(axle_data(still, name) for name in axle_names(car))
    unsprung = sum(axle.unsprung_kg for axle in axles)
    wheels = vehicle.composition.wheels
    ground = float(np.mean([wheel.patch[2] for wheel in wheels])) if wheels else 0.0
    x, y, z = (float(value) for value in cog)
    return CarData(
        name=vehicle.name,
        overrides=car.overrides,
        tyres=vehicle.driving.words,
        gravity=vehicle.gravity,
        mass_kg=mass,
        trimmed_body_kg=vehicle.body.mass,
        sprung_kg=mass - unsprung,
        unsprung_kg=unsprung,
        cog_m=(x, y, z),
        cog_height_m=z - ground,
        cog_behind_front_m=x - axles[0].x_m if axles else x,
        inertia_kg_m2=_inertia(still, cog),
        wheelbase_m=abs(axles[1].x_m - axles[0].x_m) if len(axles) == 2 else None,
        loads_kg=_loads(vehicle.table),
        support_n={name: float(load) for name, load in still.static.support_load.items()},
        axles=axles,
        figures=motion_figures(car),
        notes=tuple(_notes(still, axles)),
        parameters=car_parameters(car),
        steady=steady_data(car, still, axles, z - ground),
    )


def car_parameters(car: Any) -> tuple[Parameter, ...]:
    """Return all parameters of a car, see `parameter_list`."""
    return parameter_list(car.vehicle, source_file(car), car.folder)


def source_file(car: Any) -> Path | None:
    """Return the vehicle file with the sources of the values of a car; None without one, as on another machine."""
    origin = car.origin["file"]
    default = FOCUS_FILE if car.vehicle.name == FOCUS_FILE.parent.name else None
    file = default if origin is None else Path(origin)
    return file if file is not None and file.is_file() else None


def _loads(table: Mapping[str, Any]) -> dict[str, float]:
    """Return the masses of the loads of a vehicle table, and of persons on seats [kg]."""
    loads = {name: float(load["mass"]) for name, load in (table.get("load") or {}).items() if load["mass"]}
    for name, seat in (table.get("seat") or {}).items():
        loads[f"{name} (on a seat)"] = sum(float(part["mass"]) for part in seat["parts"].values())
    return loads


def _inertia(car: Any, cog: Vector) -> tuple[float, float, float, float]:
    """Return Ixx, Iyy, Izz and the integral of z x of the whole car about its centre of gravity [kg m2]."""
    total = np.zeros((3, 3))
    for body, centre in car.matrices.body_centres.items():
        r, matrix = centre - cog, car.matrices.body_masses[body]
        total += matrix[3:, 3:] + matrix[0, 0] * ((r @ r) * np.eye(3) - np.outer(r, r))
    return float(total[0, 0]), float(total[1, 1]), float(total[2, 2]), float(-total[2, 0])


def _notes(car: Any, axles: Sequence[AxleData]) -> Iterator[str]:
    """Yield sentences about quantities that are not defined for a car."""
    if len(axles) != 2:
        supports = ", ".join(point_words(name) for name in car.static.support_load)
        yield (
            "wheelbase, anti-dive [%] and distribution of roll stiffness are not defined, because only "
            f"{len(axles)} axle has wheels on "
            f"plates{f'; the rest of the car stands on {supports}' if supports else ''}"
        )
    for axle in axles:
        if not axle.ideal:
            yield (
                f"{axle.name}: geometry, motion ratios and unsprung mass are computed with its bushings, because "
                "ideal joints would lock this axle"
            )
        if math.isnan(axle.geometry.caster_deg):
            yield f"{axle.name}: no steering figures, because its template {axle.template} has no steering_axis"
        if math.isnan(axle.geometry.side_swing_arm_m):
            yield f"{axle.name}: no swing centre in the side view, because the wheel moves there without rotating"
        if math.isnan(axle.geometry.front_swing_arm_m):
            yield f"{axle.name}: no swing centre in the front view, because the wheel moves without change of camber"
        if math.isnan(axle.geometry.roll_centre_height_m):
            yield f"{axle.name}: no roll centre, because the lines from both contact points are parallel"
        if {"right", "left"} & set(car.vehicle.table[axle.name]):
            yield f"{axle.name}: left and right wheel differ; values of a single wheel are those of the right wheel"
    yield from damper_notes(car)
    if not car.vehicle.gravity:
        yield "sprung masses of the axles and ride frequencies are not defined without gravity"
