"""Headline figures of a car: heave, pitch and roll of the sprung mass, and the hop of its wheels, each on its rates.

Each figure is the natural frequency and the damping ratio of one motion alone, by its mass m, rate k and damping c:

    f = sqrt(k / m) / 2 pi,    zeta = c / (2 sqrt(k m))

    heave   m_s     k = sum of k_i
    pitch   I_yy    k = sum of k_i (x_i - x_s)^2
    roll    I_xx    k = sum of K_phi,i - N_i (z_s - z_c,i)
    hop     m_u     k = K_w + K_t            (both wheels of an axle in phase, the body at rest)

The sprung mass m_s is the whole car without the unsprung masses m_u, which count as points in the wheel centres: body,
engine, seats, occupants and loads as one rigid part, with the inertia I about its centre of gravity (x_s, z_s). The
stations i support this part: each axle with k_i = 2 K_r and K_phi,i of its suspension in series with its tyres (see
`vehicle.engines.kinematics.axle_ride`), and each other contact with the ground, a rubber block, with k_i and k_i y_i^2.
The damping c follows in the same way from dampers at 0.1 m/s, tyres and blocks. Stuck dampers keep their length.

This is the ride model of a car on the road, where rolling tyres oppose no slow motion along or across: the sprung mass
pitches and rolls about its centre of gravity. In roll its weight moves to the side of each station by the height above
the roll centre z_c,i (a block: its place), under the load N_i on the springs there; with two axles the sum is m_s g h,
with the height h of the centre of gravity above the roll axis.

The motions of one car share its modes, so that a figure is no mode: coupling by the pitch rate sum of k_i (x_i - x_s),
the engine on its mounts, standing tyres and the linkage in the side view change the modes, and not the figures.

Source: Gillespie, Fundamentals of Vehicle Dynamics, chapter 5 (bounce and pitch of the sprung mass on the ride rates,
here without their coupling; wheel hop) and chapter 6 (roll stiffness less the weight at its height above the roll
axis).
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.engines.kinematics.axle_curves import design_axle
from vehicle.engines.kinematics.axle_ride import AxleRide, Support
from vehicle.engines.simulation.car_masses import car_masses
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.flexbody.mass_properties import MassProperties


@dataclass(frozen=True, kw_only=True, slots=True)
class RideFigure:
    """Natural frequency of a motion of the sprung mass or of the wheels of an axle on its rates.

    Attributes:
        frequency_hz: undamped [Hz]; nan if its stiffness or its mass is not positive or not defined.
        damping_ratio: [-]; nan likewise.
    """

    frequency_hz: float
    damping_ratio: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Station:
    """Support of the sprung mass: an axle, or a contact of the body with the ground.

    Attributes:
        x: position along the car [m].
        load: static load on its springs [N].
        vertical: rate and damping, vertical.
        roll: roll stiffness and roll damping.
        roll_centre: height of the roll centre in the frame of the hardpoints [m]; nan if roll is left out.
    """

    x: float
    load: float
    vertical: Support
    roll: Support
    roll_centre: float


def ride_figures(car: CarModel, axles: Mapping[str, AxleRide], *, roll: bool = True) -> dict[str, RideFigure]:
    """Compute the figures of a car at rest: "heave", "pitch", "roll", then "front wheel hop" and so on by axle.

    Args:
        car: car in static equilibrium, with standing tyres.
        axles: its axles, with their dampers stuck or sliding; see `axle_rides`.
        roll: False leaves out roll, which needs the roll centres of the axles; its figure is nan.

    Raises:
        SimulationError: an axle has no equilibrium near its design position.
    """
    sprung = _sprung(car, axles)
    stations = [*(_axle_station(car, axle, ride, roll) for axle, ride in axles.items()), *_blocks(car, sprung.cog[1])]
    # The weight on each station moves to the side by its height above the roll centre: a negative stiffness.
    tilt = math.fsum(station.load * (sprung.cog[2] - station.roll_centre) for station in stations)
    rolling = _sum([*(station.roll for station in stations), Support(stiffness=-tilt, damping=0.0)])
    pitch = _sum([station.vertical.times((station.x - sprung.cog[0]) ** 2) for station in stations])
    figures = {
        "heave": _figure(_sum([station.vertical for station in stations]), sprung.mass),
        "pitch": _figure(pitch, float(sprung.inertia[1, 1])),
        "roll": _figure(rolling, float(sprung.inertia[0, 0])),
    }
    return figures | {
        f"{axle} wheel hop": _figure(_sum([ride.wheel, ride.tyre]), ride.unsprung_mass) for axle, ride in axles.items()
    }


def _figure(support: Support, mass: float) -> RideFigure:
    return RideFigure(frequency_hz=support.frequency(mass), damping_ratio=support.damping_ratio(mass))


def _sum(supports: list[Support]) -> Support:
    """Return supports in parallel."""
    return Support(
        stiffness=math.fsum(each.stiffness for each in supports), damping=math.fsum(each.damping for each in supports)
    )


def _sprung(car: CarModel, axles: Mapping[str, AxleRide]) -> MassProperties:
    """Return the sprung mass: the car without the unsprung masses, which are points in the wheel centres."""
    whole = car_masses(car, loads=True)
    wheels = car.vehicle.composition.wheels
    unsprung = MassProperties.of_points(
        np.array([axles[wheel.axle].unsprung_mass for wheel in wheels]), np.array([wheel.center for wheel in wheels])
    )
    # Masses and moments subtract about a common centre.
    return whole.without(unsprung)


def _axle_station(car: CarModel, axle: str, ride: AxleRide, roll: bool) -> Station:
    """Return an axle as a station, with its roll centre or without."""
    wheels = [wheel for wheel in car.vehicle.composition.wheels if wheel.axle == axle]
    height = math.nan
    if roll:
        # Both directions towards the middle of the car have the same roll centre.
        _, geometry = design_axle(car.model, car.static.preload, wheels, towards=1.0)
        height = geometry.roll_centre_height_m
    return Station(
        x=wheels[0].center[0],
        load=len(wheels) * ride.spring_load,
        vertical=ride.ride.times(len(wheels)),
        roll=ride.roll.in_series(ride.tyre_roll),
        roll_centre=wheels[0].patch[2] + height,
    )


def _blocks(car: CarModel, middle: float) -> Iterator[Station]:
    """Yield the contacts of the car with the ground other than its tyres; `middle`: y of the centre of gravity [m]."""
    plates = {wheel.plate for wheel in car.vehicle.composition.wheels}
    for link in car.vehicle.composition.connections:
        if not link.ground or link.carrier in plates or link.law is None:
            continue
        vertical = Support(stiffness=link.law.stiffness[2], damping=link.law.damping[2])
        yield Station(
            x=link.at[0],
            load=car.static.support_load.get(link.name, 0.0),
            vertical=vertical,
            roll=vertical.times((link.at[1] - middle) ** 2),
            roll_centre=link.at[2],
        )
