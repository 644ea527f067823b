"""Modes of the assembled car with names of the moving parts; rejection of unstable cars."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.modal_scale import modal_a
from vehicle.engines.linear.motion_names import description, motion_shares
from vehicle.engines.linear.natural_modes import grows, natural_modes
from vehicle.engines.linear.part_motions import group_of, rigid_rows
from vehicle.engines.linear.strained_part import parameter_text, strained_elements
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
        grows: True if the mode is unstable: Re(s) is above round-off.
        motions: share of the kinetic energy by named motion, largest first; sums to 1. See `motion_names`.
        description: name of the motion with at least half of the kinetic energy; otherwise of the two largest motions.
        modal_a: Modal A of this shape [kg/s]; see `vehicle.engines.linear.modal_scale`.
    """

    frequency: float
    damping_ratio: float
    growth: float
    grows: bool
    shape: Complex
    energy: dict[str, float]
    motions: dict[str, float]
    description: str
    modal_a: complex

    def __repr__(self) -> str:
        """One line."""
        return f"Mode({self.frequency:.4g} Hz, damping {100.0 * self.damping_ratio:.3g} %, {self.description})"


def car_modes(matrices: CarMatrices, *, stuck: bool, highest: float = 60.0, names: Sequence[str] = ()) -> list[Mode]:
    """Return the modes of the car up to a frequency.

    Args:
        matrices: matrices of the assembled car.
        stuck: True for locked dampers, False for their viscous part without friction.
        highest: highest natural frequency [Hz].
        names: names of the modes of the free flexible body, for the descriptions; empty by default.

    Returns:
        Modes sorted by natural frequency, without overdamped motions (real poles). Unstable modes are included at any
        frequency, real poles too, and their description begins with "grows: ".
    """
    natural, rows = natural_modes(first_order(matrices.system, stuck=stuck)), rigid_rows(matrices)
    car_mode_list = []
    for index in np.flatnonzero((natural.frequency <= highest) | grows(natural.pole)):
        shape, growing = natural.motion[index], bool(grows(natural.pole)[index])
        energy, scale = _energy(matrices, shape)
        motions = motion_shares(
            {group: group_rows @ shape / scale for group, group_rows in rows.items()},
            energy,
            shape[matrices.modal] / scale,
            names,
            float(natural.frequency[index]),
        )
        car_mode_list.append(
            Mode(
                frequency=float(natural.frequency[index]),
                damping_ratio=float(natural.damping_ratio[index]),
                growth=float(natural.pole[index].real),
                grows=growing,
                shape=shape,
                energy=energy,
                motions=motions,
                description=("grows: " if growing else "") + description(motions),
                modal_a=modal_a(matrices.system, natural.pole[index], shape),
            )
        )
    return car_mode_list


def _energy(matrices: CarMatrices, shape: Complex) -> tuple[dict[str, float], float]:
    """Return the share of each group in the kinetic energy v^H M v, and the root of the total."""
    energy: dict[str, float] = {}
    for body, rows in matrices.body_rows.items():
        velocity = rows @ shape
        value = float(np.real(np.vdot(velocity, matrices.body_masses[body] @ velocity)))
        group = group_of(matrices, body)
        energy[group] = energy.get(group, 0.0) + value
    # Modes are mass-normalised.
    energy["flexible"] = float(np.sum(np.abs(shape[matrices.modal]) ** 2))
    for name, dof in matrices.fluids.items():
        energy[name] = float(matrices.system.mass[dof, dof] * np.abs(shape[dof]) ** 2)
    total = sum(energy.values())
    return {name: value / total for name, value in energy.items()}, float(np.sqrt(total))


def require_stable(car: CarModel, matrices: CarMatrices, poles: Complex) -> None:
    """Raise an error if the car has an unstable pole.

    The poles with sliding dampers are sufficient: a car that buckles while friction holds the dampers also buckles
    without friction, because a stiffness that is indefinite on a subspace is indefinite on the whole space.

    Args:
        car: compiled and trimmed car.
        matrices: matrices of the car.
        poles: poles of the car with sliding dampers [rad/s].

    Raises:
        ConfigurationError: the car is unstable; the message names the moving part, the growth and likely causes.
    """
    if not np.any(grows(poles)):
        return
    growing = [mode for mode in car_modes(matrices, stuck=False) if mode.grows]
    fastest = max(growing, key=lambda mode: mode.growth)
    vehicle = car.vehicle
    if vehicle.driving.rolling:
        raise ConfigurationError(
            f"the car is unstable at {vehicle.driving.speed:g} m/s: "
            f"{fastest.description.removeprefix('grows: ')} grows by a factor of e in {1.0 / fastest.growth:.3g} s. "
            "Lower driving.speed or driving.hold_frequency, because the springs that keep the course can make a "
            "fast car unstable, or check cornering_stiffness, which may be too large at the front axle. If the "
            "car is unstable with driving.speed=0 too, its springs are too soft: see python -m vehicle modes"
        )
    strained = strained_elements(car, fastest.growth + 0j, fastest.shape)
    raise ConfigurationError(
        f"the car is statically unstable: {fastest.description.removeprefix('grows: ')} grows by a factor of e in "
        f"{1.0 / fastest.growth:.3g} s. Its springs cannot support its weight and preloads; the most loaded is "
        f"{parameter_text(car, strained[0].path)}. Check this parameter against body.mass ({vehicle.body.mass:g} "
        f"kg), body.cog and gravity ({vehicle.gravity:g} m/s2), or see python -m vehicle modes"
    )
