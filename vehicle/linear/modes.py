"""Modes of the assembled car: constraints eliminated, Maxwell branches as states, damped eigenvalues."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.linear.first_order import first_order
from vehicle.linear.matrices import CarMatrices

Vector = npt.NDArray[np.float64]


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
        description: what moves.
    """

    frequency: float
    damping_ratio: float
    growth: float
    grows: bool
    shape: npt.NDArray[np.complex128]
    energy: dict[str, float]
    description: str


GROWTH_FLOOR = 1e-4
"""Growth [1/s] below which a pole counts as neutral: e-fold in three hours, far beyond any record."""

ROUND_OFF = 1e-6
"""Growth over |s| below which it is round-off of the matrices, whose differences are good to 1e-8."""


def grows(poles: npt.NDArray[np.complex128]) -> npt.NDArray[np.bool_]:
    """Which poles [rad/s] grow beyond round-off."""
    return np.asarray(poles.real > GROWTH_FLOOR + ROUND_OFF * np.abs(poles))


def car_modes(matrices: CarMatrices, *, stuck: bool, highest: float = 60.0) -> list[Mode]:
    """Modes of the car up to a frequency.

    Args:
        matrices: of the assembled car.
        stuck: True with the dampers locked, False with their viscous part and no friction.
        highest: highest natural frequency [Hz].

    Returns:
        Modes sorted by natural frequency; overdamped motions (real poles) are left out. What grows is listed at any
        frequency, real poles too, with "grows: " before its description.
    """
    form = first_order(matrices.system, stuck=stuck)
    poles, vectors = np.linalg.eig(form.state)
    found = []
    growing = grows(poles)
    for index in np.flatnonzero((poles.imag > 1e-6) | (growing & (poles.imag >= 0.0))):
        frequency = float(abs(poles[index])) / (2.0 * np.pi)
        if frequency <= highest or growing[index]:
            shape = form.shape(vectors[:, index])
            energy = _energy(matrices, shape)
            found.append(
                Mode(
                    frequency=frequency,
                    damping_ratio=float(-poles[index].real / abs(poles[index])),
                    growth=float(poles[index].real),
                    grows=bool(growing[index]),
                    shape=shape,
                    energy=energy,
                    description=("grows: " if growing[index] else "") + _describe(matrices, shape, energy),
                )
            )
    return sorted(found, key=lambda mode: mode.frequency)


def group_of(body: str) -> str:
    """Group of parts that a rigid body belongs to in the energy shares."""
    if body.startswith("main_spring_upper"):
        return "body"
    if body.startswith("stabilizer"):
        return "stabilizer"
    for wheel in ("fr", "fl"):
        if body.endswith(f"_{wheel}"):
            return f"wheel_{wheel}"
    return body


def _energy(matrices: CarMatrices, shape: npt.NDArray[np.complex128]) -> dict[str, float]:
    """Shares of the kinetic energy, v^H M v of each group."""
    energy: dict[str, float] = {}
    for body, rows in matrices.body_rows.items():
        velocity = rows @ shape
        value = float(np.real(np.vdot(velocity, matrices.body_masses[body] @ velocity)))
        energy[group_of(body)] = energy.get(group_of(body), 0.0) + value
    energy["flexible"] = float(np.sum(np.abs(shape[matrices.modal]) ** 2))
    total = sum(energy.values())
    return {name: value / total for name, value in energy.items()}


def _describe(matrices: CarMatrices, shape: npt.NDArray[np.complex128], energy: dict[str, float]) -> str:
    """Words for a mode: the group with the largest share and the direction in which it moves."""
    leader = max(energy, key=lambda name: energy[name])
    if leader == "flexible":
        amplitudes = np.abs(shape[matrices.modal]) ** 2
        number = int(np.argmax(amplitudes)) + 1
        words = f"flexible body, mode {number}"
    elif leader in ("body", "engine"):
        words = f"{leader} {_rigid_direction(matrices, leader, shape)}"
    elif leader.startswith("wheel"):
        wheel = leader[-2:]
        velocity = np.abs(matrices.body_rows[f"tyre_{wheel}"][:3] @ shape)
        direction = ("longitudinal", "lateral", "vertical")[int(np.argmax(velocity))]
        side = "right" if wheel == "fr" else "left"
        words = f"{side} wheel {direction}"
    else:
        words = leader.replace("_", " ")
    others = [name for name, share in sorted(energy.items(), key=lambda item: -item[1]) if share > 0.2]
    partners = [name.replace("_", " ") for name in others if name != leader]
    return words + (f", with {', '.join(partners)}" if partners else "")


def _rigid_direction(matrices: CarMatrices, body: str, shape: npt.NDArray[np.complex128]) -> str:
    """Direction of a rigid body's motion that holds most of its kinetic energy."""
    velocity = matrices.body_rows[body] @ shape
    weights = np.real(np.conj(velocity) * (matrices.body_masses[body] @ velocity))
    names = ("longitudinal (x)", "lateral (y)", "heave (z)", "roll (Rx)", "pitch (Ry)", "yaw (Rz)")
    return names[int(np.argmax(weights))]
