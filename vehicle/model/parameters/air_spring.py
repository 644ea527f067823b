"""Air spring: air in a bellows between isothermal and adiabatic, levelled at rest."""

from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.force_elements import MAXWELL, TRACK, Hydromount
from vehicle.model.parameters.quantity import quantity

ATMOSPHERE = 101325.0
"""Standard pressure outside [Pa], ISO 2533."""

GAMMA = 1.4
"""Ratio of the specific heats of air [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class AirSpring(Hydromount):
    """Connection whose z axis carries its static load by air: F = (p - pa) A, with the moving part below.

    Small motions about the static height, at which levelling sets p = pa + F/A:

        m cv T' = -p V' - G (T - T0),  p V = m R T   =>   K(s) = p A^2/V (1 + (gamma - 1) tau s/(1 + tau s))
                                                               + (p - pa) dA/ds,  tau = m cv/G

    which is isothermal at rest and adiabatic in fast motion: a spring with a Maxwell branch, one internal force. The
    stiffness along z belongs to the bellows alone. The change of force at a displacement x is wrong by
    (gamma + 1)/2 x A/V of itself, since the law is linear.
    """

    air_area: float = quantity(
        "m2", "A, effective area of an air spring", above=0.0, at_least=1e-4, at_most=1.0,
        why="bellows of cars and trucks have 0.005 to 0.08 m2",
    )  # fmt: skip
    air_volume: float = quantity(
        "m3", "V, volume of air at the static height, with its reservoir", above=0.0, at_least=1e-5, at_most=1.0,
        why="bellows of cars and trucks have 0.001 to 0.03 m3",
    )  # fmt: skip
    air_area_slope: float = quantity(
        "m", "dA/ds, growth of the area in compression; below 0 on a falling piston", at_least=-1.0, at_most=1.0,
        why="0.05 m is 0.5 cm2 for each mm", default=0.0,
    )  # fmt: skip
    air_exchange_time: float = quantity(
        "s", "tau, time constant of the heat exchange between air and wall", above=0.0, at_least=0.01, at_most=1e3,
        why="bellows have 1 to 20 s",
    )  # fmt: skip

    def __post_init__(self) -> None:
        Hydromount.__post_init__(self)
        other = next((key for key in (MAXWELL[0], TRACK[0]) if getattr(self, key) is not None), None)
        if other is not None or self.friction_force[2] > 0.0:
            raise ConfigurationError(
                f"AirSpring.air_area: found together with {other or 'friction_force.z'}; air is the only branch "
                "along z: remove one of them, or add a second connection"
            )

    @property
    def maxwell(self) -> tuple[float, float]:
        """Spring [N/m] and dashpot [N s/m] of the Maxwell branch without load; the trim adds the effect of the load."""
        spring = air_stiffness(0.0, self.air_area, self.air_volume, self.air_area_slope)[1]
        return spring, spring * self.air_exchange_time


AIR = ("air_area", "air_volume", "air_exchange_time", "air_area_slope")
"""Keys that make a connection an air spring."""


def air_stiffness(load: float, area: float, volume: float, slope: float) -> tuple[float, float]:
    """Return isothermal stiffness and stiffness of the Maxwell branch [N/m]; see `AirSpring`.

    Args:
        load: static load F [N]; below 0 as 0.
        area, volume, slope: A [m2], V [m3] and dA/ds [m].
    """
    excess = max(load, 0.0) / area
    gas = (ATMOSPHERE + excess) * area**2 / volume
    return gas + excess * slope, (GAMMA - 1.0) * gas
