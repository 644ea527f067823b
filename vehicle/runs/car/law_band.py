"""Cars with the edges of the band of their fitted dampers: the softest and the firmest law that the tests allow.

The band is stored with the law (`tested.band_velocity`, `band_soft`, `band_firm`: changes of the force in its
direction). At an edge, the friction limit takes the change at the lowest velocity of the band, the mean of both sides
and at least to zero; the curve takes the rest, straight between the velocities, to zero at rest, and beyond the band
with its last slope. The table of a curve does not fall with the velocity: where an edge would, its force is constant.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
import scipy

from vehicle.digits import rounded
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.composition import PlacedDamper
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.tested_range import TestedRange
from vehicle.names import SIDE_SIGN

EDGES = ("soft", "firm")
"""Edges of a band."""


def laws_by_path(dampers: Sequence[PlacedDamper]) -> dict[str, Damper]:
    """Return the law of each table of a vehicle file, that of a side if it has a separate table.

    Args:
        dampers: dampers of a car; those of a path are right and left.
    """
    laws: dict[str, Damper] = {}
    for path in dict.fromkeys(damper.path for damper in dampers):
        both = [damper for damper in dampers if damper.path == path]
        axle, _, name = path.rpartition(".")
        alike = all(damper.tables == both[0].tables for damper in both)
        paths = [path] * len(both) if alike else [f"{axle}.{side}.{name}" for side in SIDE_SIGN]
        laws |= {each: damper.law for each, damper in zip(paths, both, strict=True)}
    return laws


def banded_laws(laws: Mapping[str, Damper]) -> dict[str, Damper]:
    """Return the laws with a band."""
    return {path: law for path, law in laws.items() if law.tested is not None and law.tested.band_velocity}


def edge_overrides(
    dampers: Mapping[str, Damper], edge: str, velocities: tuple[float, float] = (0.0, np.inf)
) -> dict[str, Any]:
    """Return the parameters of a car whose banded dampers have the curve of an edge.

    Args:
        dampers: path in the vehicle file, for example "front.damper", to the law.
        edge: "soft" or "firm".
        velocities: lowest and highest speed [m/s] with the band; at other speeds the force of the law remains.

    Raises:
        ConfigurationError: no damper has a band, or a damper with a band has a control or a function for its curve.
    """
    banded = banded_laws(dampers)
    if not banded:
        raise ConfigurationError(
            f"law band: none of the dampers {', '.join(dampers)} has a band; fit one with fit-damper and take over all "
            "lines of its damper.toml, tested.band_velocity and the next two included"
        )
    values: dict[str, Any] = {}
    for path, law in banded.items():
        if law.controlled or law.function is not None or law.friction_function is not None:
            raise ConfigurationError(
                f"{path}: has a band, but a control or a function replaces its law; remove tested.band_velocity, "
                "band_soft and band_firm"
            )
        assert law.tested is not None
        velocity, force, friction = edge_of(law, law.tested, edge, velocities)
        values |= {f"{path}.viscous_law": "table", f"{path}.velocity": velocity, f"{path}.force": force}
        values[f"{path}.coulomb_friction"] = friction
        if law.static_friction is not None and law.friction_law == "stribeck":
            values[f"{path}.stribeck_friction"] = rounded(law.static_friction + friction - law.coulomb_friction, 6)
    return values


def edge_of(
    law: Damper, tested: TestedRange, edge: str, velocities: tuple[float, float]
) -> tuple[list[float], list[float], float]:
    """Return velocities [m/s] and forces [N] of the curve at an edge, and its friction limit [N]."""
    velocity = np.array(tested.band_velocity)
    change = np.array(tested.band_soft if edge == "soft" else tested.band_firm)
    change = np.where((np.abs(velocity) >= velocities[0]) & (np.abs(velocity) <= velocities[1]), change, 0.0)
    order = np.argsort(np.abs(velocity), kind="stable")
    friction = max(law.coulomb_friction + float(np.mean(change[order[:2]])), 0.0)
    remaining = np.sign(velocity) * (change - (friction - law.coulomb_friction))
    curve = damper_curve(law)
    # The change is straight through zero between the lowest velocities of both sides.
    middle, last = velocity.size // 2, 2.0 * float(np.max(np.abs([*velocity, *curve.knots])))
    speeds = np.unique([-last, *velocity, *curve.knots, 0.0, last])  # a table continues with the slope of its ends
    ends, changes = np.insert(velocity, middle, 0.0), np.insert(remaining, middle, 0.0)
    force = curve.force(speeds) + scipy.interpolate.make_interp_spline(ends, changes, k=1)(speeds)
    # The curve of the vehicle file does not fall with the velocity.
    zero_at = int(np.searchsorted(speeds, 0.0))
    force[zero_at:] = np.maximum.accumulate(force[zero_at:])
    force[: zero_at + 1] = np.minimum.accumulate(force[zero_at::-1])[::-1]
    forces = [rounded(float(each), 7) for each in force]
    return [rounded(float(each), 7) for each in speeds], forces, rounded(friction, 6)


class BandedCar:
    """Base of `Car`: the edges of the band of its dampers."""

    def law_band(self, velocities: tuple[float, float] = (0.0, np.inf)) -> tuple[Self, Self]:
        """Return this car with the softest and with the firmest dampers that their tests allow.

        The band of a damper is in the lines of `fit-damper`, for example `front.damper.tested.band_soft`; all dampers
        with a band change together. A `ConfigurationError` is raised if no damper has one.

        Args:
            velocities: lowest and highest speed [m/s] with the band; at other speeds the force of the law remains.
        """
        car: Any = self
        dampers = laws_by_path(car.vehicle.composition.dampers)
        soft, firm = (car.with_(edge_overrides(dampers, edge, velocities)) for edge in EDGES)
        return soft, firm
