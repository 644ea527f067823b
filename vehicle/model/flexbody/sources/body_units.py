"""Units of finite-element bodies: with N (or lbf) and s, the unit of length determines the unit of mass.

Newton's law in consistent units: N = t mm/s2 = kg m/s2, lbf = (lbf s2/in) in/s2. K in N/mm requires M in tonnes.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.mass_difference import powers_of_thousand
from vehicle.model.flexbody.sources import FOLLOWING, LENGTHS, MASSES
from vehicle.model.flexbody.superelement_checks import HIGHEST_FIRST_MODE, LOWEST_FIRST_MODE
from vehicle.model.parameters.hardpoints import Point

_SAME_SIZE = 5.0
"""Maximum factor between the extents of a body and of the points of its car [1]: cars are 1.3 to 2 times as long as
their outermost points, and units of length differ by a factor of 25 or more."""
_LEVEL = 1000.0**0.25
"""Factor above which the scale of shapes is nearer to another unit of mass [1]: half of sqrt(1000) on a log scale."""


@dataclass(frozen=True, slots=True)
class Units:
    """Units of a source.

    Attributes:
        length: unit of length, a key of `LENGTHS`.
        mass: unit of mass, a key of `MASSES`.
        stated: True if the user specified the unit of mass.
    """

    length: str
    mass: str
    stated: bool

    @property
    def words(self) -> str:
        """Description of the units, for the notice and the stored file."""
        if self.stated:
            return f"lengths in {self.length}, masses in {self.mass} as stated"
        force = "lbf" if self.length == "in" else "N"
        return f"lengths in {self.length}, masses in {self.mass}, which follows from {self.length}, {force} and s"

    @property
    def sizes(self) -> tuple[float, float]:
        """Size of the unit of length [m] and of mass [kg]."""
        return LENGTHS[self.length], MASSES[self.mass]


def units_of(length: str | None, mass: str | None) -> Units:
    """Return the units of a source from the options of the user.

    Args:
        length: key of `LENGTHS`; None for metres.
        mass: key of `MASSES`; None for the unit consistent with the length.
    """
    length_unit = length or "m"
    return Units(length_unit, mass or FOLLOWING[length_unit], stated=mass is not None)


def require_size(positions: Vector, points: Mapping[str, Point], units: Units) -> None:
    """Check the unit of length of a body by comparing its size with the car.

    Args:
        positions: node positions of the body [m], shape (n, 3).
        points: points of the car [m], by name.
        units: units of the source.

    Raises:
        DataError: the body is far larger or smaller than the car; the message contains the correct option.
    """
    car_extent = float(np.ptp(np.array(list(points.values())), axis=0).max())
    extent = float(np.ptp(positions, axis=0).max())
    if _is_size(extent, car_extent):
        return
    fits = [name for name, size in LENGTHS.items() if _is_size(extent * size / LENGTHS[units.length], car_extent)]
    raise DataError(
        f"nodes: with lengths in {units.length} the body is {extent:.4g} m long, but the points of the car span "
        f"{car_extent:.4g} m, so the unit of length is wrong. "
        + (f"Set --length-unit {fits[0]}." if fits else "Check the model.")
    )


def _is_size(extent: float, expected: float) -> bool:
    return expected / _SAME_SIZE <= extent <= _SAME_SIZE * expected


def require_mass(mass: float, vehicle_mass: float, units: Units) -> None:
    """Check the unit of mass of a body by comparing its mass with the vehicle file.

    Args:
        mass: mass of the body [kg].
        vehicle_mass: mass of the body in the vehicle file [kg].
        units: units of the source.

    Raises:
        DataError: the masses differ by about a power of 1000; the message contains the correct option.
    """
    if not powers_of_thousand(mass, vehicle_mass):
        return
    best = _unit(mass / vehicle_mass, units)
    remedy = f'Set --mass-unit "{best}"' if best else "Check the mass matrix, or set body.mass of the vehicle"
    raise DataError(
        f"mass: found {mass:.4g} kg with {units.words}; the body in the vehicle file has {vehicle_mass:.4g} kg, "
        f"about {1000.0 ** powers_of_thousand(vehicle_mass, mass):g} times as much, so the unit of mass is "
        f"wrong. {remedy}."
    )


def require_first_mode(frequency: float, units: Units) -> None:
    """Check that stiffness and mass are in a consistent system of units, by the frequency of the first mode.

    Args:
        frequency: frequency of the first elastic mode [Hz].
        units: units of the source.

    Raises:
        DataError: the frequency is implausible for a car body; the message contains the required units of K and M.
    """
    if LOWEST_FIRST_MODE <= frequency <= HIGHEST_FIRST_MODE:
        return
    force = f"{units.mass} {units.length}/s2" if units.stated else ("lbf" if units.length == "in" else "N")
    raise DataError(
        f"stiffness and mass: the first elastic mode is at {frequency:.4g} Hz but must be {LOWEST_FIRST_MODE:g} to "
        f"{HIGHEST_FIRST_MODE:g} Hz. With {units.words}, the stiffness must be in ({force})/{units.length} and "
        "time in s: K in N/mm needs M in t (a wrong unit by a factor of 1000 changes frequencies by a factor of "
        "31.6). Export K and M in a consistent system of units."
    )


def require_level(vectors: Vector, modal_mass: Vector, mass: float, units: Units) -> None:
    """Check the unit of mass of mode shapes by their scale.

    Shapes with modal mass m at all nodes of a body have sum of m_i phi_i^2 = m, so that sqrt(3 M / m) times their RMS
    over the displacements is about 1.

    Args:
        vectors: displacements of the shapes, without rotations, shape (dofs, modes).
        modal_mass: modal masses m [kg], shape (modes,); NaN where unknown.
        mass: mass M of the body [kg].
        units: units of the source.

    Raises:
        DataError: the scale is nearer to another power of 1000; the message contains the correct option.
    """
    has_mass = np.isfinite(modal_mass) & (modal_mass > 0.0)
    if not has_mass.any():
        return
    level = float(
        np.sqrt(3.0 * mass * np.median(np.mean(np.abs(vectors[:, has_mass]) ** 2, axis=0) / modal_mass[has_mass]))
    )
    if 1.0 / _LEVEL < level < _LEVEL:
        return
    best = _unit(1.0 / level**2, units)
    remedy = f'Set --mass-unit "{best}"' if best else "Check the modal masses"
    raise DataError(
        f"shapes: their RMS is {level:.3g} times that of a rigid motion of {mass:.4g} kg with {units.words} instead "
        f"of about 1, so the unit of mass is wrong. {remedy}."
    )


def _unit(ratio: float, units: Units) -> str | None:
    """Return the unit that brings a mass, `ratio` times the expected mass, within half a power of 1000 of it."""
    for name in (FOLLOWING[units.length], *MASSES):
        if abs(np.log10(ratio * MASSES[name] / MASSES[units.mass])) < 1.5:
            return name
    return None
