"""Numbers of the damper study: frequency responses, load fluctuation over damping, iteration and joint optimum."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from scenarios.damper_choice.optimum import Fluctuation, Optimum, Step, iterate, joint_optimum, optimum
from scenarios.lumped.axle import Axle
from scenarios.lumped.damper_choice import (
    DamperChoiceParameters,
    ExponentialRoad,
    FrequencyBands,
    RoadHoldingQuarterCar,
)
from scenarios.lumped.road_holding import (
    RideMeasures,
    RoadHoldingModel,
    half_car_model,
    printed_load_fluctuation,
    quarter_car_model,
    ride_measures,
    tyre_load_ratio,
)
from vehicle.arrays import Vector
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.analysis.road_level import CLASSES, REFERENCE
from vehicle.signals.analysis.weighting import weighting

QUARTER_DAMPING = (4000.0, 5000.0, 6000.0, 7000.0)
"""Damping of figures 2 and 3 [N s/m]."""

HALF_DAMPING = (3000.0, 4500.0, 6000.0, 7500.0)
"""Damping of figures 5 to 8, front and rear alike [N s/m]."""

READ_OFF = np.arange(1000.0, 8001.0, 250.0)
"""Damping among which the source reads its optima [N s/m]: all that it prints are multiples of 250."""

START_REAR = 3250.0
"""Rear damping with which the source starts its iteration [N s/m]."""

MEASURES: dict[str, Callable[[RoadHoldingModel, ExponentialRoad, FrequencyBands], Vector]] = {
    "printed": printed_load_fluctuation,
    "physical": tyre_load_ratio,
}
"""Sum of band amplitudes as printed, and RMS tyre force over static load."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoadHolding:
    """Curves and optima of a measure on a road."""

    damping: Vector  # Abscissa of the curves [N s/m], shape (m,)
    quarter: Vector  # Quarter car over damping [-], shape (m,)
    equal: Vector  # Front and rear tyre of the half car with equal dampers [-], shape (2, m)
    quarter_optimum: Optimum
    equal_optima: tuple[Optimum, Optimum]
    read_off: list[Step]  # Iteration among the values of `READ_OFF`, as in the source
    continuous: list[Step]  # Iteration over all coefficients
    joint: tuple[float, float, Vector]
    """Front and rear coefficient of the least sum of both tyres [N s/m], measures there."""


def quarter_responses(parameters: DamperChoiceParameters, lines: Vector) -> dict[float, Vector]:
    """Return damping of figures 2 and 3 to |response| of wheel and body, (2, m)."""
    return {c: np.abs(quarter_car_model(parameters.quarter_car, c).response(lines)) for c in QUARTER_DAMPING}


def half_responses(
    parameters: DamperChoiceParameters, lines: Vector, dampings: Sequence[float] = HALF_DAMPING
) -> dict[float, Vector]:
    """Return damping [N s/m] to |response| of front wheel, rear wheel, heave, pitch with equal dampers, (4, m)."""
    return {c: np.abs(half_car_model(parameters.half_car, c, c).response(lines)) for c in dampings}


def half_car_measure(parameters: DamperChoiceParameters, measure: str, road: ExponentialRoad) -> Fluctuation:
    """Measure of both tyres as a function of front and rear damping."""
    return lambda front, rear: MEASURES[measure](
        half_car_model(parameters.half_car, front, rear), road, parameters.bands
    )


def road_holding(
    parameters: DamperChoiceParameters, measure: str, road: ExponentialRoad, damping: Sequence[float]
) -> RoadHolding:
    """Compute the curves and optima of a measure on a road."""
    rate = MEASURES[measure]
    both = half_car_measure(parameters, measure, road)

    def quarter(c: float) -> float:
        return float(rate(quarter_car_model(parameters.quarter_car, c), road, parameters.bands)[0])

    read_off = iterate(both, rear=START_REAR, grid=READ_OFF)
    return RoadHolding(
        damping=np.asarray(damping, dtype=float),
        quarter=np.array([quarter(c) for c in damping]),
        equal=np.array([both(c, c) for c in damping]).T,
        quarter_optimum=optimum(quarter),
        equal_optima=(optimum(lambda c: float(both(c, c)[0])), optimum(lambda c: float(both(c, c)[1]))),
        read_off=read_off,
        continuous=iterate(both, rear=START_REAR),
        joint=joint_optimum(both, start=(read_off[-1].front, read_off[-1].rear)),
    )


WHEEL_PARTS = ("knuckle", "tyre", "brake_disc", "caliper", "damper_bottom", "main_spring_lower", "stabilizer_rod")
"""Parts that move with the wheel."""

LINK_PARTS = ("a_arm", "steering_rod")
"""Parts between body and wheel: half of their mass moves with the wheel."""


def complete_car_quarter(vehicle: Vehicle) -> RoadHoldingQuarterCar:
    """Return the equivalent quarter car of the front right corner of the complete car.

    The sprung mass is the share of body and engine on one front wheel between front wheels and rear supports; spring
    and damper act along the strut, at the wheel with the square of the cosine of its angle. Neglected: the flexible
    body, the engine on its mounts, the friction of the damper, the suspension mount and the stabilizer.
    """
    points, parts = vehicle.points, {part.name: part for part in vehicle.composition.parts}
    rear, engine = points["rear_support_right"][0], parts["engine"]
    base = rear - points["wheel_center_fr"][0]
    front_share = (
        vehicle.body.mass * (rear - vehicle.body.cog[0]) + engine.numbers.mass * (rear - engine.cog[0])
    ) / base
    strut = np.subtract(points["strut_top_fr"], points["damper_bottom_fr"])
    slope = float(strut[2] / np.linalg.norm(strut)) ** 2
    unsprung = sum(parts[f"{name}_fr"].numbers.mass for name in WHEEL_PARTS)
    unsprung += 0.5 * sum(parts[f"{name}_fr"].numbers.mass for name in LINK_PARTS)
    return RoadHoldingQuarterCar(
        sprung_mass=0.5 * front_share,
        wheel=Axle(
            unsprung_mass=unsprung,
            suspension_stiffness=slope * value_of(vehicle, "front.main_spring.stiffness"),
            suspension_damping=slope * value_of(vehicle, "front.damper.viscous"),
            tyre_stiffness=value_of(vehicle, "front.bushings.tyre.stiffness.z"),
            tyre_damping=value_of(vehicle, "front.bushings.tyre.damping.z"),
        ),
    )


SPEED = 80.0 / 3.6
"""Speed on the roads of ISO 8608 [m/s], assumed."""

EDGES = np.geomspace(0.1, 50.0, 801)
"""Edges of the intervals of integration [Hz]; twice as many change no measure by more than 0.1 %."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TradeOff:
    """Measures of one car over damping for every road class."""

    damping: Vector  # [N s/m], shape (m,)
    measures: dict[str, list[RideMeasures]]  # Road class -> one for each damping
    own: float  # Damping of the car itself [N s/m]

    def best(self, name: str) -> float:
        """Return the damping of the minimum of a measure, equal for all classes, as their PSDs are proportional."""
        return float(self.damping[np.argmin([getattr(measure, name) for measure in self.measures["A"]])])


def trade_off(car: RoadHoldingQuarterCar, damping: npt.ArrayLike) -> TradeOff:
    """Return the measures of a quarter car over damping on all classes of ISO 8608."""
    lines = np.asarray(np.sqrt(EDGES[1:] * EDGES[:-1]), dtype=np.float64)
    width = np.diff(EDGES)
    coefficients = np.asarray(damping, dtype=np.float64)
    # Gd(n) = Gd(n0) (n / n0)^-2 with n = f / v, hence G(f) = Gd(n0) n0^2 v / f^2.
    road = {name: level * REFERENCE**2 * SPEED / lines**2 for name, level in CLASSES.items()}
    weight = weighting("Wk").spectrum_factor(lines)
    return TradeOff(
        damping=coefficients,
        measures={
            name: [ride_measures(car, c, lines, spectrum, width, weight) for c in coefficients.tolist()]
            for name, spectrum in road.items()
        },
        own=car.wheel.suspension_damping,
    )
