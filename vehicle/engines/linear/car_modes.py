"""Modes of the assembled car and what moves in them; a car whose motion grows by itself is refused by what moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.modal_scale import modal_a
from vehicle.engines.linear.motion_names import description, motion_shares
from vehicle.engines.linear.natural_modes import grows, natural_modes
from vehicle.engines.linear.part_motions import group_of, rigid_rows
from vehicle.engines.linear.strained_part import holding_parameter
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Mode:
    """A damped mode u(t) = Re(shape exp(s t)).

    Attributes:
        frequency: |s| / 2 pi, natural frequency [Hz].
        damping_ratio: -Re(s) / |s| [-].
        shape: complex displacement of the velocity coordinates; (n,).
        energy: share of the kinetic energy by group of parts; sums to 1.
        growth: Re(s) [1/s].
        grows: whether the motion grows by itself, beyond round-off.
        motions: share of the kinetic energy by named motion, largest first; sums to 1. See `motion_names`.
        description: name of the motion that holds half of it, else of the two largest.
        modal_a: as of `vehicle.engines.linear.modal_scale`, of this shape [kg/s].
    """

    frequency: float
    damping_ratio: float
    growth: float
    grows: bool
    shape: npt.NDArray[np.complex128]
    energy: dict[str, float]
    motions: dict[str, float]
    description: str
    modal_a: complex


def car_modes(matrices: CarMatrices, *, stuck: bool, highest: float = 60.0, names: Sequence[str] = ()) -> list[Mode]:
    """Modes of the car up to a frequency.

    Args:
        matrices: of the assembled car.
        stuck: True with the dampers locked, False with their viscous part and no friction.
        highest: highest natural frequency [Hz].
        names: of the modes of the free flexible body, for the descriptions; none by default.

    Returns:
        Modes sorted by natural frequency; overdamped motions (real poles) are left out. What grows is listed at any
        frequency, real poles too, with "grows: " before its description.
    """
    modes, rows = natural_modes(first_order(matrices.system, stuck=stuck)), rigid_rows(matrices)
    found = []
    for index in np.flatnonzero((modes.frequency <= highest) | grows(modes.pole)):
        shape, growing = modes.motion[index], bool(grows(modes.pole)[index])
        energy, scale = _energy(matrices, shape)
        motions = motion_shares(
            {group: own @ shape / scale for group, own in rows.items()},
            energy,
            shape[matrices.modal] / scale,
            names,
            float(modes.frequency[index]),
        )
        found.append(
            Mode(
                frequency=float(modes.frequency[index]),
                damping_ratio=float(modes.damping_ratio[index]),
                growth=float(modes.pole[index].real),
                grows=growing,
                shape=shape,
                energy=energy,
                motions=motions,
                description=("grows: " if growing else "") + description(motions),
                modal_a=modal_a(matrices.system, modes.pole[index], shape),
            )
        )
    return found


def _energy(matrices: CarMatrices, shape: npt.NDArray[np.complex128]) -> tuple[dict[str, float], float]:
    """Shares of the kinetic energy, v^H M v of each group; the root of its sum, which scales the shape."""
    energy: dict[str, float] = {}
    for body, rows in matrices.body_rows.items():
        velocity = rows @ shape
        value = float(np.real(np.vdot(velocity, matrices.body_masses[body] @ velocity)))
        group = group_of(matrices, body)
        energy[group] = energy.get(group, 0.0) + value
    energy["flexible"] = float(np.sum(np.abs(shape[matrices.modal]) ** 2))
    total = sum(energy.values())
    return {name: value / total for name, value in energy.items()}, float(np.sqrt(total))


def require_stable(car: CarModel, matrices: CarMatrices, poles: npt.NDArray[np.complex128]) -> None:
    """Refuse a car with a growing pole.

    The poles with sliding dampers tell: what buckles while the friction holds buckles all the more without it, for
    a stiffness that is indefinite in a part of the motions is so in all of them.

    Args:
        car: the car.
        matrices: its matrices.
        poles: its poles with sliding dampers [rad/s].

    Raises:
        ConfigurationError: what moves, how fast it grows, and what could be wrong.
    """
    if not np.any(grows(poles)):
        return
    growing = [mode for mode in car_modes(matrices, stuck=False) if mode.grows]
    worst = max(growing, key=lambda mode: mode.growth)
    vehicle = car.vehicle
    if vehicle.driving.rolling:
        raise ConfigurationError(
            f"this car does not keep its course at {vehicle.driving.speed:g} m/s: "
            f"{worst.description.removeprefix('grows: ')} grows by itself, e-fold in {1.0 / worst.growth:.3g} s. Lower "
            "driving.speed, or look at cornering_stiffness of the tyres, more in front than behind; where it grows "
            "with driving.speed=0 too, its springs do not hold it: python -m vehicle.modes"
        )
    raise ConfigurationError(
        f"this car does not stand: {worst.description.removeprefix('grows: ')} grows by itself, e-fold in "
        f"{1.0 / worst.growth:.3g} s. Its weight and preloads are more than its springs hold: what works most there is "
        f"{holding_parameter(car, worst.growth + 0j, worst.shape)}; check it against "
        f"body.mass ({vehicle.body.mass:g} kg), body.cog and gravity ({vehicle.gravity:g} m/s2), or look at "
        "python -m vehicle.modes"
    )
