"""Notice on a run in which an air spring moves beyond the range of its linear law.

The linear law of `AirSpring` gives the force over the load F0 at rest, positive in compression x, bellows included:

    F - F0 = (K_z + K) x + D_z x' + f2,     f2' = K_2 x' - f2/tau

so that the travel follows from the recorded force. Fast motion of the gas is adiabatic, with dV/dx = -A - s x:

    F_gas(x) = (p (V/(V - A x - s x^2/2))^gamma - p_a) (A + s x)
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.model.parameters.air_spring import ATMOSPHERE, GAMMA, AirSpring, air_stiffness
from vehicle.model.parameters.composition import PlacedConnection

LARGEST_ERROR = 0.05
"""Maximum error of the linear law [-] without a notice, of the change of force at the largest travel. A box on exact
gas on classes B, C and D, with errors of 6, 13 and 30 %: RMS 0.5, 1.3 and 3.5 % higher, peaks 7, 12 and 21 % off."""


def air_springs(car: Any) -> dict[str, PlacedConnection]:
    """Return the air springs of a car by the channel of their force along z."""
    links = car.vehicle.composition.connections
    return {f"{link.name}_force_z": link for link in links if isinstance(link.law, AirSpring)}


def air_notice(car: Any, channels: Mapping[str, Vector]) -> tuple[str, ...]:
    """Return text on the air spring whose linear law has the largest error in a run, if it is above `LARGEST_ERROR`.

    Args:
        car: the car.
        channels: its run, with the forces of the air springs.
    """
    worst, text = LARGEST_ERROR, tuple[str, ...]()
    for channel, link in air_springs(car).items():
        if channel not in channels:
            continue
        assert isinstance(link.law, AirSpring)
        load = -car.load_rows.static[car.load_rows.names.index(channel)]
        travel = air_travel(link.law, load, -channels[channel] - load, 1.0 / car.vehicle.solver.record_rate)
        ends = float(np.min(travel)), float(np.max(travel))
        largest = max(abs(gas_error(link.law, load, end)) for end in ends)
        if largest > worst:
            worst = largest
            low, high = (number(1e3 * end) for end in ends)
            text = (
                f"{link.path} moves from {low} to {high} mm (compression positive), where its linear law is wrong by "
                f"up to {number(100.0 * largest, 2)} % of the change of its force, as the gas is adiabatic: peaks are "
                "wrong by about as much, RMS values by a tenth of that",
            )
    return text


def air_travel(law: AirSpring, load: float, force: Vector, interval: float) -> Vector:
    """Return the travel x [m] of an air spring, positive in compression, from the change of its force.

    f2 is exact for a velocity that is constant over an interval: f2_n = a f2_(n-1) + K_2 g (x_n - x_(n-1)) with
    a = exp(-h/tau), g = (1 - a) tau/h.

    Args:
        law: the air spring.
        load: its load at rest [N].
        force: F - F0, at rest in the beginning [N]; (n,).
        interval: h, time between two samples [s].
    """
    static, branch = air_stiffness(load, law.air_area, law.air_volume, law.air_area_slope)
    decay = np.exp(-interval / law.air_exchange_time)
    gain = (1.0 - decay) * law.air_exchange_time / interval
    fading, difference = np.array([1.0, -decay]), np.array([1.0, -1.0])
    elastic = np.array([law.stiffness[2] + static, 0.0]) + law.damping[2] / interval * difference
    whole = np.polyadd(np.polymul(elastic, fading), np.append(branch * gain * difference, 0.0))
    return np.asarray(scipy.signal.lfilter(fading, whole, force))


def gas_error(law: AirSpring, load: float, travel: float) -> float:
    """Return the relative error of the change of the force of the gas by its linear law, exact over linear, less one.

    Args:
        law: the air spring.
        load: its load at rest [N].
        travel: fast motion from rest, positive in compression [m].
    """
    area, volume, slope = law.air_area, law.air_volume, law.air_area_slope
    left = volume - area * travel - 0.5 * slope * travel**2
    if not travel or left <= 0.0:
        # Without volume the force is infinite.
        return np.inf if travel else 0.0
    pressure = ATMOSPHERE + load / area
    exact = (pressure * (volume / left) ** GAMMA - ATMOSPHERE) * (area + slope * travel) - load
    return float(exact / (sum(air_stiffness(load, area, volume, slope)) * travel) - 1.0)
