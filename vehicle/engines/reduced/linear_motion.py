"""Linear motion of a car in a finished run of the reduced engine, from the forces and plates of its record.

The inputs of the poles are the plates z and z', the slopes of rolling tyres, the nonlinear forces of dampers and of
laws over displacement, and the histories of applied forces. With the spectrum X of an input, xi = b X / (s - p), and
every linear quantity of the car is a row over the state S = (Re xi, Im xi, inputs): displacements u, velocities,
accelerations, forces of the Maxwell branches and of ideal joints. The record ends with a
return to its start, so that it is periodic.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.displacement_laws import law_rows
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

BAND = 90.0
"""Highest frequency of the linear motion [Hz]: products of two motions have frequencies up to twice this."""

RATE = 3.0 * BAND
"""Rate at which products are computed [Hz], so that they are true up to `BAND`."""

RETURN, PAUSE = 1.0, 3.0
"""Last part of a record in which all inputs return to their start, and time until the motion repeats [s]."""


class MotionRows(NamedTuple):
    """Rows of linear quantities over the state (Re xi, Im xi, inputs).

    Attributes:
        displacement, velocity, acceleration: of the velocity coordinates of MuJoCo, without turns of rolling wheels
            about their axles in `displacement`; (n, states).
        branch: forces of the Maxwell branches; (b, states).
        height, height_rate: plates; (w, states).
        joints: forces of the ideal joints; (k, states).
    """

    displacement: Vector
    velocity: Vector
    acceleration: Vector
    branch: Vector
    height: Vector
    height_rate: Vector
    joints: Vector


def input_effects(model: PoleModel) -> Complex:
    """Return the effects of z, z', slopes, forces of dampers and laws, and applied forces on the poles; (p, inputs)."""
    laws = model.scalar_force[:, model.groups :]
    return np.hstack([model.height, model.velocity, model.slope, -model.force, -laws, model.applied])


def motion_rows(model: PoleModel) -> MotionRows:
    """Return the rows of linear quantities of a car over its state."""
    system, matrices = model.matrices.system, model.matrices
    n, wheels, effects = system.size, len(system.inputs), input_effects(model)
    count = effects.shape[1]

    def over_state(poles: Complex, inputs: Vector | None = None) -> Vector:
        direct = np.zeros((len(poles), count)) if inputs is None else inputs
        return np.hstack([poles.real, -poles.imag, direct])

    displacement, rate = over_state(model.modal), model.modal * model.poles
    velocity, branch = over_state(rate), over_state(model.branch)
    acceleration = over_state(rate * model.poles, (rate @ effects).real)
    forces = np.hstack(
        [
            system.input_stiffness,
            system.input_damping,
            matrices.slope.reshape(n, -1),
            -system.slide_rows.T,
            -law_rows(matrices.laws, n).T,
            matrices.applied,
        ]
    )
    needed = system.mass @ acceleration + system.damping @ velocity + system.stiffness @ displacement
    needed += system.effects.T @ branch
    needed[:, -count:] -= forces
    plates = np.zeros((2 * wheels, displacement.shape[1]))
    plates[:, -count:][:, : 2 * wheels] = np.eye(2 * wheels)
    displacement[list(system.cyclic)] = 0.0
    return MotionRows(
        displacement=displacement,
        velocity=velocity,
        acceleration=acceleration,
        branch=branch,
        height=plates[:wheels],
        height_rate=plates[wheels:],
        joints=np.linalg.pinv(system.constraints.T) @ needed,
    )


def state_spectra(model: PoleModel, spectra: Complex, interval: float, samples: int) -> Complex:
    """Return the state of the car over a period, as `numpy.fft.rfft` would; (states, lines).

    Args:
        model: the car.
        spectra: inputs without z', as `numpy.fft.rfft` of a period; (inputs - w, lines).
        interval: sampling interval [s].
        samples: samples of the period.

    Returns:
        Spectra of Re xi, Im xi and the inputs: with X of xi at s and Y of its conjugate, (X + Y)/2 and (X - Y)/2i.
    """
    wheels, lines = len(model.matrices.system.inputs), spectra.shape[1]
    s = 2j * np.pi * np.arange(lines) / (samples * interval)
    at = np.flatnonzero((s.imag > 0.0) & (s.imag <= 2.0 * np.pi * BAND))
    height, others = spectra[:wheels, at], spectra[wheels:, at]
    inputs, effects = np.vstack([height, s[at] * height, others]), input_effects(model)
    poles = model.poles[:, None]
    ahead, back = (effects @ inputs) / (s[at] - poles), (effects.conj() @ inputs) / (s[at] - poles.conj())
    result = np.zeros((2 * len(poles) + len(inputs), lines), dtype=complex)
    result[:, at] = np.vstack([0.5 * (ahead + back), -0.5j * (ahead - back), inputs])
    return result


def returning(samples: int, interval: float) -> int:
    """Return the number of samples at the end of a record in which its inputs return to their start."""
    return min(round(RETURN / interval), samples // 2)


def periodic_spectra(inputs: Vector, interval: float, every: int) -> tuple[Complex, int]:
    """Return the spectra of inputs that return to their start, at each `every`-th sample, and the samples of a period.

    Inputs return together: motion and friction become small together, and dampers that stick go on sticking. A friction
    that was held instead, without the motion that it stops, would move the car on its springs.

    Args:
        inputs: histories; (inputs, n).
        interval: sampling interval of the histories [s].
        every: samples from one to the next of the result.
    """
    count = inputs.shape[1]
    fall = returning(count, interval)
    coarse = -(-(count + round(PAUSE / interval)) // every)
    period = fast_length(coarse)
    padded = np.zeros((len(inputs), period * every))
    padded[:, :count] = inputs - inputs[:, :1]
    padded[:, count - fall : count] *= 0.5 * (1.0 + np.cos(np.pi * np.arange(fall) / fall))
    return np.fft.rfft(padded, axis=1)[:, : period // 2 + 1] / every, period


def plate_inputs(
    model: PoleModel, signal: Signal, time: Vector, channels: Mapping[str, Vector], tyre_load: Mapping[str, float]
) -> tuple[Vector, Vector]:
    """Return displacements of the plates, and what the slopes under rolling tyres exceed z' by; (w, n), (w or 0, n).

    Args:
        model: the car.
        signal: motion of the plates.
        time: times of the n samples [s].
        channels: record with the tyre forces: the slope force is that of the present load.
        tyre_load: static tyre loads by wheel [N].
    """
    wheels = model.matrices.system.inputs
    plate_displacement, slopes = np.zeros((2, len(wheels), time.size))
    motion = signal.plate_motion(time, [wheel for wheel in wheels if wheel in signal.wheels])
    for row, wheel in enumerate(wheels):
        if wheel in signal.wheels:
            plate_displacement[row], rate = motion.displacement[wheel], motion.velocity[wheel]
            if model.slope.size:
                slope = signal.slope_spline(wheel, time[0], time[-1])(time) if signal.slope_velocity else rate
                share = np.maximum(channels[f"tyre_{wheel}_force_z"], 0.0) / tyre_load[wheel]
                slopes[row] = share * slope - rate
    return plate_displacement, slopes[: model.slope.shape[1]]


def run_inputs(model: PoleModel, plates: tuple[Vector, Vector], channels: Mapping[str, Vector], time: Vector) -> Vector:
    """Return the inputs of the poles in a run, without z', in the order of `input_effects`; (inputs - w, n).

    Args:
        model: the car.
        plates: see `plate_inputs`.
        time: times of the n samples [s].
        channels: record with damper forces and velocities, and "law_<index>".
    """
    dampers = [
        channels[f"{damper}_force"] - viscous * channels[f"{damper}_velocity"]
        for damper, viscous in zip(model.matrices.damper_names, model.matrices.viscous, strict=True)
    ]
    laws = [channels[f"law_{index}"] for index in range(len(model.laws))]
    return np.vstack([*plates, *dampers, *laws, *model.matrices.lines.values(time).T])
