"""Sinusoidal inputs of a car: shares of its plates or of its applied forces in one level, with their phases."""

import cmath
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.placed_force import PlacedForce, force_named, on_parts
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import axle_and_side, wheel_words

Shares = str | Mapping[str, complex]
"""Motion of the plates, or force: a name, shares as text, or the share of each as a complex number."""

MOTIONS = ("heave", "pitch", "roll", "warp")
"""Names of motions of all plates."""

LEVEL_UNITS = ("m", "m/s2")
"""Units of the level of plates: amplitude of their displacement or of their acceleration."""

SHARE = re.compile(r"\s*(\w+)\s*=\s*([-+.\deE]+)\s*(?:@\s*([-+.\deE]+)\s*)?")
"""Share of a plate or of a force, with its phase [deg]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelInput:
    """Sinusoidal input of a car with one level.

    Attributes:
        shares: share of each plate or force in the level, with its phase.
        words: the input in words.
        unit: unit of the level: "m" or "m/s2" of plates, "N" or "N m" of forces.
        forces: indices in the forces of the car; empty for plates.
        delay: delay of each plate [s].
    """

    shares: dict[str, complex]
    words: str
    unit: str
    forces: tuple[int, ...] = ()
    delay: tuple[float, ...] = ()

    @property
    def shown(self) -> tuple[float, str]:
        """Return factor and unit of levels for a reader."""
        return (1e3, "mm") if self.unit == "m" else (1.0, self.unit)

    @property
    def amplitude(self) -> str:
        """Return the label of the level."""
        of = "force" if self.unit == "N" else "moment" if self.forces else "plates"
        return f"amplitude of the {of} [{self.shown[1].replace('m/s2', 'm/s²')}]"

    def at(self, frequency: Vector) -> Complex:
        """Return the amplitude of each input over the level [m or N over its unit]; (f, i).

        A level of acceleration moves the plates by a/(jw)^2, and a delay T turns them by exp(-jwT).
        """
        s = 2j * np.pi * frequency[:, None]
        result = np.array(list(self.shares.values())) * np.exp(-s * np.array(self.delay or 0.0))
        return np.asarray(result / s**2 if self.unit == "m/s2" else result)


def plate_input(plates: Shares, vehicle: Vehicle, unit: str = "m", axle_delay: float | None = None) -> LevelInput:
    """Return the input by plates.

    Args:
        plates: see `plate_shares`.
        vehicle: the car.
        unit: "m" or "m/s2", see `LEVEL_UNITS`.
        axle_delay: speed of the car over the plates [km/h], whose rear axles move later; None for no delay.

    Raises:
        ConfigurationError: see `plate_shares`; a speed or unit out of range.
    """
    if unit not in LEVEL_UNITS:
        raise ConfigurationError(f"level: unit {unit!r}, must be {' or '.join(LEVEL_UNITS)} for plates")
    shares, motion = plate_shares(plates, vehicle.wheels), str(plates)
    if not isinstance(plates, str):
        motion = ",".join(f"{name}={abs(share):g}@{np.degrees(cmath.phase(share)):g}" for name, share in shares.items())
    motion = f"plates {'in ' if motion in MOTIONS else ''}{motion}"
    if plates in vehicle.wheels:
        motion = f"plate of the {wheel_words(str(plates), vehicle.wheels)}"
    driven = LevelInput(shares=shares, words=motion, unit=unit)
    if axle_delay is None:
        return driven
    if not 0.0 < axle_delay < np.inf:
        raise ConfigurationError(f"axle_delay {axle_delay:g} km/h: must be a speed above 0")
    along = np.array([wheel.patch[0] for wheel in vehicle.composition.wheels])
    # x points to the rear: the first axle has the smallest.
    delay = (along - along.min()) / (axle_delay / 3.6)
    return replace(driven, delay=tuple(delay.tolist()), words=f"{motion}, axles in turn at {axle_delay:g} km/h")


def plate_shares(plates: Shares, wheels: Sequence[str]) -> dict[str, complex]:
    """Return the share of each plate in the level, in the order of the wheels.

    Args:
        plates: heave, pitch (front axle up, others down), roll (left up, right down), warp (both), a wheel, shares with
            their phases in degrees as "fl=1,fr=1@90", or a dictionary of complex numbers.
        wheels: names of the wheels.

    Raises:
        ConfigurationError: another word or wheel, no motion, or pitch or warp of a single axle.
    """
    if isinstance(plates, str):
        plates = _motion(plates.strip(), wheels) or _shares(
            "plates", plates, f"{', '.join(MOTIONS)}, a wheel ({', '.join(wheels)})", "fl=1,fr=1@90"
        )
    if unknown := [wheel for wheel in plates if wheel not in wheels]:
        raise ConfigurationError(f"plates: the car has no wheel {unknown[0]!r}; choose from {', '.join(wheels)}")
    return _checked("plates", {wheel: complex(plates.get(wheel, 0.0)) for wheel in wheels})


def force_input(force: Shares, forces: Sequence[PlacedForce]) -> LevelInput:
    """Return the input by applied forces.

    Args:
        force: name of a force; common beginning of the names of forces that turn together, "imbalance_fr" for
            imbalance_fr_x and imbalance_fr_z, with the ratios and phases of their first order; shares with phases in
            degrees, "imbalance_fr_x=1,imbalance_fr_z=1@-90"; or a dictionary of complex numbers.
        forces: forces of the car.

    Raises:
        ConfigurationError: no such force, forces and moments together, or a force that changes a tyre.
    """
    names = force if isinstance(force, str) else ", ".join(force)
    if isinstance(force, str):
        if "=" in force:
            force = _shares("force", force, "a name", "crank_torque=1,crank_lift=1@90")
        else:
            force = _together(force.strip(), forces)
    indices = tuple(force_named(name, forces) for name in force)
    chosen = [forces[index] for index in indices]
    if tyres := [each.name for each in chosen if each not in on_parts(forces)]:
        raise ConfigurationError(f"force {tyres[0]}: it changes a tyre and is no force; choose another, or plates")
    if len(units := {each.unit for each in chosen}) > 1:
        raise ConfigurationError(f"force {names}: has forces and moments, but one level; choose forces of one unit")
    shares = _checked("force", {name: complex(share) for name, share in force.items()})
    return LevelInput(shares=shares, words=f"force {names}", unit=units.pop(), forces=indices)


def _together(name: str, forces: Sequence[PlacedForce]) -> dict[str, complex]:
    """Return the share of a force, or the shares of those that turn together."""
    rotating = [force for force in forces if force.name.startswith(f"{name}_") and force.harmonics]
    if not rotating or any(force.name == name for force in forces):
        return {forces[force_named(name, forces)].name: 1.0 + 0.0j}
    first = min(frequency for force in rotating for frequency in force.harmonics)
    amplitudes = {force.name: force.harmonics.get(first, 0.0j) for force in rotating}
    largest = max(amplitudes.values(), key=abs)
    return {each: amplitude / largest for each, amplitude in amplitudes.items()}


def _checked(argument: str, shares: dict[str, complex]) -> dict[str, complex]:
    if not any(shares.values()) or not all(map(cmath.isfinite, shares.values())):
        raise ConfigurationError(f"{argument}: must have finite shares, at least one of them not 0")
    return shares


def _motion(text: str, wheels: Sequence[str]) -> dict[str, complex]:
    """Return the shares of a motion of all plates or of a wheel; none for another text."""
    if text in wheels:
        return {text: 1.0 + 0.0j}
    if text not in MOTIONS:
        return {}
    axles = list(dict.fromkeys(axle_and_side(wheel)[0] for wheel in wheels))
    if text in ("pitch", "warp") and len(axles) < 2:
        raise ConfigurationError(f"plates {text}: the car has plates under one axle only; choose heave or roll")
    signs = {wheel: (1.0 if axle == axles[0] else -1.0, 1.0 if side == "left" else -1.0)
             for wheel in wheels for axle, side in [axle_and_side(wheel)]}  # fmt: skip
    factors = {"heave": (0, 0), "pitch": (1, 0), "roll": (0, 1), "warp": (1, 1)}[text]
    return {wheel: complex(by_axle ** factors[0] * by_side ** factors[1])
            for wheel, (by_axle, by_side) in signs.items()}  # fmt: skip


def _shares(argument: str, text: str, names: str, example: str) -> dict[str, complex]:
    """Return the shares of a text as "fl=1,fr=1@90"."""
    shares = {}
    for part in text.split(","):
        try:
            name, size, phase = SHARE.fullmatch(part).groups()  # type: ignore[union-attr]
            shares[name] = cmath.rect(float(size), np.radians(float(phase or 0.0)))
        except (AttributeError, ValueError):
            raise ConfigurationError(
                f"{argument} {text!r}: must be {names}, or shares with phases in degrees, for example {example}"
            ) from None
    return shares
