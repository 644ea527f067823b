"""Moments of inertia of a car from its indices, and the indices of measured cars.

    Ixx = m (i_x t)^2         t: mean track
    Iyy = i_y m a b           a, b: distance of the CoG from front and rear axle (dynamic index in pitch k_y^2 / a b)
    Izz = i_z m a b

i_x = 0.409, i_y = 1.042, i_z = 1.091 are the means of the 73 passenger cars without ballast in NHTSA's inertial
parameter database (Heydinger et al., SAE 1999-01-1336), evaluated in "Estimating vehicle inertia and centre-of-gravity
height using the NHTSA light vehicle inertial parameter database" (kktse.github.io, October 2020).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple


class Index(NamedTuple):
    """Mean, smallest and largest value of an index over the 73 cars of the survey [-]."""

    mean: float
    least: float
    most: float


SURVEY = {
    "k_x / mean track": Index(0.409, 0.378, 0.471),
    "k_y^2 / a b": Index(1.042, 0.831, 1.225),
    "k_z^2 / a b": Index(1.091, 0.914, 1.242),
}
"""Indices of roll, pitch and yaw of the measured cars."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AxleGeometry:
    """Lengths by which radii of gyration are measured [m]."""

    track: float  # mean track
    front: float  # front, rear: distance of the centre of gravity from the axles
    rear: float

    def inertia(self, mass: float, indices: Sequence[float]) -> tuple[float, float, float]:
        """Return Ixx, Iyy, Izz of a car about its centre of gravity [kg m2].

        Args:
            mass: mass of the car [kg].
            indices: i_x, i_y, i_z [-].
        """
        roll, pitch, yaw = indices
        return (
            mass * (roll * self.track) ** 2,
            pitch * mass * self.front * self.rear,
            yaw * mass * self.front * self.rear,
        )

    def indices(self, mass: float, moments: Sequence[float]) -> tuple[float, float, float]:
        """Return i_x, i_y, i_z of a car [-], the inverse of `inertia`."""
        ixx, iyy, izz = moments
        area = mass * self.front * self.rear
        return math.sqrt(ixx / mass) / self.track, iyy / area, izz / area
