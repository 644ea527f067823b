"""Half car with seat and rider: seven coordinates, two roads.

Heave and pitch of the body are about its centre of gravity; the seat base is q_b = x_b - a3 theta, the body above the
front wheel x_b - a1 theta, above the rear wheel x_b + a2 theta.

Source: "Parametric study of rider's comfort in a vehicle with semi-active suspension system under transient road
conditions", equations 8 to 10; its equations of motion and matrices contain misprints and are not used here.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from scenarios.lumped.axle import Axle
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters, Limb
from scenarios.lumped.history import History
from scenarios.lumped.network import Link, Network, masses_of, spring_damper
from vehicle.arrays import Vector
from vehicle.engines.linear.system import LinearSystem, Row

GRAVITY = 9.81
"""Gravity [m/s2]."""

ENDS = ("front", "rear")

ROADS = tuple(f"{end}_road" for end in ENDS)
"""Road heights under the front and the rear wheel."""


def output_points(parameters: HalfCarRiderParameters) -> Mapping[str, Mapping[str, float]]:
    """Return the displacements of the output points as linear forms of the coordinates [m per m, m per rad].

    Returns:
        Name of the output point -> coordinate -> coefficient. A travel is positive in rebound (wheel below the body).
    """
    body = parameters.body
    front = {"heave": 1.0, "pitch": -body.front_arm}
    rear = {"heave": 1.0, "pitch": body.rear_arm}
    return MappingProxyType(
        {
            "upper_limb": {"upper_limb": 1.0},
            "lower_limb": {"lower_limb": 1.0},
            "seat": {"seat": 1.0},
            "body": {"heave": 1.0},
            "seat_base": {"heave": 1.0, "pitch": -body.seat_arm},
            "front_body": front,
            "rear_body": rear,
            "pitch": {"pitch": 1.0},
            "front_wheel": {"front_wheel": 1.0},
            "rear_wheel": {"rear_wheel": 1.0},
            "front_travel": {**front, "front_wheel": -1.0},
            "rear_travel": {**rear, "rear_wheel": -1.0},
        }
    )


def half_car_rider(parameters: HalfCarRiderParameters) -> LinearSystem:
    """Return the linear model of the half car with rider; its outputs are the coordinates and `output_points`.

    Returns:
        The model with the coordinates upper_limb, lower_limb, seat, heave, front_wheel, rear_wheel [m], pitch [rad].
    """
    masses = {
        "upper_limb": parameters.upper_limb.mass,
        "lower_limb": parameters.lower_limb.mass,
        "seat": parameters.seat.mass,
        "heave": parameters.body.mass,
        "front_wheel": parameters.front.unsprung_mass,
        "rear_wheel": parameters.rear.unsprung_mass,
        "pitch": parameters.body.pitch_inertia,
    }
    points = output_points(parameters)
    links = (
        _on(parameters.upper_limb, {"upper_limb": 1.0, "seat": -1.0}),
        _on(parameters.lower_limb, {"lower_limb": 1.0, "seat": -1.0}),
        _on(parameters.seat, {"seat": 1.0, **{name: -value for name, value in points["seat_base"].items()}}),
        *axle_links(parameters.front, points["front_travel"], "front_wheel", "front_road"),
        *axle_links(parameters.rear, points["rear_travel"], "rear_wheel", "rear_road"),
    )
    coordinates, extra = tuple(masses), {name: form for name, form in points.items() if name not in masses}
    return Network(coordinates=coordinates, masses=masses_of(masses), links=links, outputs=extra, inputs=ROADS).system()


def static_tyre_load(parameters: HalfCarRiderParameters) -> Vector:
    """Return the load of the front and rear tyre at rest [N], shape (2,).

    K x = -M g e with e = 1 for every displacement and 0 for pitch; the load is the force of the compressed tyre.
    """
    model = half_car_rider(parameters)
    vertical = np.array([0.0 if name == "pitch" else 1.0 for name in model.coordinates])
    static_position = np.linalg.solve(model.stiffness, -GRAVITY * model.mass @ vertical)
    wheels = [model.coordinates.index(name) for name in ("front_wheel", "rear_wheel")]
    stiffness = np.array([parameters.front.tyre_stiffness, parameters.rear.tyre_stiffness])
    return np.asarray(-stiffness * static_position[wheels])


def linear_tyre_load(parameters: HalfCarRiderParameters, history: History) -> Vector:
    """Return the load of a linear tyre that cannot lift off [N]: static load + k (z - x) + c (z' - x').

    Returns:
        Front and rear load, shape (2, m); negative where the linear tyre pulls on the road.
    """
    loads = []
    for i, (end, axle) in enumerate(zip(ENDS, (parameters.front, parameters.rear), strict=True)):
        loads.append(
            axle.tyre_stiffness * (history.inputs[:, i] - history.displacement(f"{end}_wheel"))
            + axle.tyre_damping * (history.input_rates[:, i] - history.velocity(f"{end}_wheel"))
        )
    return np.asarray(static_tyre_load(parameters)[:, None] + np.stack(loads))


def lift_off(time: npt.ArrayLike, load: npt.ArrayLike) -> list[tuple[float, float]]:
    """Return the intervals in which a tyre load, (m,), is not positive: times of first and last sample, (m,) [s]."""
    instants, lifted = np.asarray(time, dtype=float), np.asarray(load, dtype=float) <= 0.0
    edges = np.diff(np.concatenate(([False], lifted, [False])).astype(int))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return [(float(instants[a]), float(instants[b])) for a, b in zip(starts, ends, strict=True)]


def axle_links(axle: Axle, travel: Row, wheel: str, road: str, damping: float | None = None) -> tuple[Link, Link]:
    """Return suspension and tyre of an axle as links.

    Args:
        axle: parameters of the axle.
        travel: extension of the suspension as a linear form.
        wheel: coordinate of the unsprung mass.
        road: input under the wheel.
        damping: damper coefficient that replaces the value of the axle [N s/m].
    """
    return (
        spring_damper(travel, axle.suspension_stiffness, axle.suspension_damping if damping is None else damping),
        spring_damper({wheel: 1.0, road: -1.0}, axle.tyre_stiffness, axle.tyre_damping),
    )


def _on(limb: Limb, extension: Row) -> Link:
    return spring_damper(extension, limb.stiffness, limb.damping)
