"""Units of finite-element bodies: with force in N (or lbf) and time in s the unit of mass follows that of length.

Newton's law in consistent units: N = t mm/s2 = kg m/s2, lbf = (lbf s2/in) in/s2. K in N/mm so belongs to M in tonnes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.mass_difference import powers_of_thousand
from vehicle.model.flexbody.sources import FOLLOWING, LENGTHS, MASSES
from vehicle.model.flexbody.superelement_checks import HIGHEST_FIRST_MODE, LOWEST_FIRST_MODE
from vehicle.model.parameters.hardpoints import Point

_SAME_SIZE = 5.0
"""Factor up to which the extent of a body may differ from that of the points of its car [1]: cars reach 1.3 to 2 times
beyond their outermost points, the units of length are 25 and more apart."""
_LEVEL = 1000.0**0.25
"""Factor from which the scale of shapes is nearer to another unit of mass: half of sqrt(1000) as a logarithm."""


@dataclass(frozen=True, slots=True)
class Units:
    """Units of a source.

    Attributes:
        length: of `LENGTHS`.
        mass: of `MASSES`.
        stated: True where the user stated the unit of mass.
    """

    length: str
    mass: str
    stated: bool

    @property
    def words(self) -> str:
        """What was taken, for the notice and the stored file."""
        if self.stated:
            return f"lengths in {self.length}, masses in {self.mass} as stated"
        force = "lbf" if self.length == "in" else "N"
        return f"lengths in {self.length}, masses in {self.mass}, which follows from {self.length}, {force} and s"

    @property
    def sizes(self) -> tuple[float, float]:
        """Size of the unit of length [m] and of mass [kg]."""
        return LENGTHS[self.length], MASSES[self.mass]


def units_of(length: str | None, mass: str | None) -> Units:
    """The units that options state: metres where no length is stated, and the mass that follows from the length.

    Args:
        length: of `LENGTHS`, None by default.
        mass: of `MASSES`, None where it follows.
    """
    own = length or "m"
    return Units(own, mass or FOLLOWING[own], stated=mass is not None)


def require_size(positions: FloatArray, places: Mapping[str, Point], units: Units) -> None:
    """Refuse a body in another unit of length than stated.

    Args:
        positions: of its nodes [m], shape (n, 3).
        places: points of the car [m].
        units: as stated.

    Raises:
        DataError: the body is far larger or smaller than its car, with the option that mends it.
    """
    wanted = float(np.ptp(np.array(list(places.values())), axis=0).max())
    extent = float(np.ptp(positions, axis=0).max())
    if _is_size(extent, wanted):
        return
    fits = [name for name, size in LENGTHS.items() if _is_size(extent * size / LENGTHS[units.length], wanted)]
    raise DataError(
        f"nodes: the body is {extent:.4g} m long with lengths in {units.length}, the points of the car span "
        f"{wanted:.4g} m: another unit of length. " + (f"Set --length-unit {fits[0]}." if fits else "Check the model.")
    )


def _is_size(extent: float, wanted: float) -> bool:
    return wanted / _SAME_SIZE <= extent <= _SAME_SIZE * wanted


def require_mass(mass: float, vehicle_mass: float, units: Units) -> None:
    """Refuse a body in another unit of mass than stated.

    Args:
        mass: of the body [kg].
        vehicle_mass: of the trimmed body in the vehicle file [kg].
        units: as stated.

    Raises:
        DataError: the masses are about a power of 1000 apart, with the option that mends it.
    """
    if not powers_of_thousand(mass, vehicle_mass):
        return
    best = _unit(mass / vehicle_mass, units)
    mend = f'Set --mass-unit "{best}"' if best else "Check the mass matrix, or set body.mass of the vehicle"
    raise DataError(
        f"mass: found {mass:.4g} kg with {units.words}; the trimmed body of the vehicle has {vehicle_mass:.4g} kg, "
        f"about {1000.0 ** powers_of_thousand(vehicle_mass, mass):g} times as much: another unit of mass. {mend}."
    )


def require_first_mode(frequency: float, units: Units) -> None:
    """Refuse stiffness and mass that are not of one system of units.

    Args:
        frequency: of the first elastic mode [Hz].
        units: as stated.

    Raises:
        DataError: the first mode is none of a trimmed body, with what the units of K and M must be.
    """
    if LOWEST_FIRST_MODE <= frequency <= HIGHEST_FIRST_MODE:
        return
    force = f"{units.mass} {units.length}/s2" if units.stated else ("lbf" if units.length == "in" else "N")
    raise DataError(
        f"stiffness and mass: the first elastic mode is at {frequency:.4g} Hz, expected are {LOWEST_FIRST_MODE:g} to "
        f"{HIGHEST_FIRST_MODE:g} Hz. With {units.words}, the stiffness must be in ({force})/{units.length} and time in "
        "s: K in N/mm needs M in t (a factor of 1000 between both is one of 31.6 in frequency). Export both in one "
        "system of units."
    )


def require_level(vectors: FloatArray, modal_mass: FloatArray, mass: float, units: Units) -> None:
    """Refuse shapes of all nodes whose scale is that of another unit of mass.

    Shapes with modal mass m at all nodes of a body have sum of m_i phi_i^2 = m, so that sqrt(3 M / m) times their RMS
    over the displacements is about 1.

    Args:
        vectors: shapes, displacements alone, shape (dofs, modes).
        modal_mass: of them [kg], shape (modes,); NaN is left out.
        mass: M of the body [kg].
        units: as stated.

    Raises:
        DataError: the scale is nearer to another power of 1000, with the option.
    """
    known = np.isfinite(modal_mass) & (modal_mass > 0.0)
    if not known.any():
        return
    level = float(np.sqrt(3.0 * mass * np.median(np.mean(np.abs(vectors[:, known]) ** 2, axis=0) / modal_mass[known])))
    if 1.0 / _LEVEL < level < _LEVEL:
        return
    best = _unit(1.0 / level**2, units)
    mend = f'Set --mass-unit "{best}"' if best else "Check the modal masses"
    raise DataError(
        f"shapes: their RMS is {level:.3g} of that of a rigid motion of {mass:.4g} kg with {units.words}, expected is "
        f"about 1: another unit of mass. {mend}."
    )


def _unit(ratio: float, units: Units) -> str | None:
    """Return the unit that brings a mass within half a power of 1000 of the expected one, None without.

    Args:
        ratio: mass in the stated units over the expected one [1].
        units: as stated.
    """
    for name in (FOLLOWING[units.length], *MASSES):
        if abs(np.log10(ratio * MASSES[name] / MASSES[units.mass])) < 1.5:
            return name
    return None
