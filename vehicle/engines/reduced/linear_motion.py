"""Linear motion of a car in a finished run of the reduced engine, from the forces and plates of its record.

The inputs of the poles are the plates z and z', the slopes of rolling tyres, the nonlinear forces of dampers and of
laws over displacement, and the histories of applied forces. With the spectrum X of an input, xi = b X / (s - p), and
every linear quantity of the car is a row over the state S = (Re xi, Im xi, inputs): displacements u, velocities,
accelerations, forces of the Maxwell branches and of ideal joints. The record is continued by a return to its start, so
that it is periodic.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Complex, Indices, Vector
from vehicle.engines.linear.displacement_laws import law_rows
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.excitation.signal import Signal

BAND = 90.0
"""Highest frequency of the linear motion [Hz]: products of two motions have frequencies up to twice this."""

RATE = 3.0 * BAND
"""Rate at which products are computed [Hz], so that they are true up to `BAND`."""

SLOWEST = 0.01
"""Rate of a pole that a constant input moves to a place [rad/s]."""

SLOW = 3.5
"""Rate of decay up to which a motion is not at rest after the pause [1/s]: 0.1 % are left of a faster one."""

RETURN, PAUSE = 1.0, 3.0
"""Time in which inputs return to their start, and until the motion repeats [s]."""


class MotionRows(NamedTuple):
    """Rows of linear quantities over the state (Re xi, Im xi, inputs).

    Attributes:
        displacement, velocity, acceleration: of the velocity coordinates of MuJoCo, without turns of rolling wheels
            about their axles in `displacement`; (n, states).
        branch: forces of the Maxwell branches; (b, states).
        height, height_rate: plates; (w, states).
        slope: V tan(beta) of the road under rolling tyres times the present load over the static one; (w, states).
        laws: forces of laws over displacement beyond their tangents; (l, states).
        joints: forces of the ideal joints; (k, states).
    """

    displacement: Vector
    velocity: Vector
    acceleration: Vector
    branch: Vector
    height: Vector
    height_rate: Vector
    slope: Vector
    laws: Vector
    joints: Vector


def input_effects(model: PoleModel) -> Complex:
    """Return the effects of z, z', slopes, forces of dampers and laws, and applied forces on the poles; (p, inputs)."""
    return np.hstack([model.height, model.velocity, model.slope, -model.element_forces, model.applied])


def motion_rows(model: PoleModel) -> MotionRows:
    """Return the rows of linear quantities of a car over its state."""
    system, matrices = model.matrices.system, model.matrices
    n, wheels, effects = system.size, len(system.inputs), input_effects(model)
    count = effects.shape[1]

    def over_state(poles: Complex, inputs: Vector | None = None) -> Vector:
        direct = np.zeros((len(poles), count)) if inputs is None else inputs
        # Re(row xi) = Re row Re xi - Im row Im xi.
        return np.hstack([poles.real, -poles.imag, direct])

    displacement, rate = over_state(model.modal), model.modal * model.poles
    velocity, branch = over_state(rate), over_state(model.branch)
    # u'' = Re(row s xi') with xi' = s xi + b X.
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
    # M u'' + C u' + K u + H' f_b - forces = Jc' l, the forces of the joints.
    needed = system.mass @ acceleration + system.damping @ velocity + system.stiffness @ displacement
    needed += system.effects.T @ branch
    needed[:, -count:] -= forces
    # Rows that pick the inputs, which are the end of the state.
    inputs = np.eye(count, displacement.shape[1], displacement.shape[1] - count)
    height_rate, last = inputs[wheels : 2 * wheels], count - model.applied.shape[1]
    rolling = matrices.slope.size > 0
    # No force depends on the angle of a rolling wheel.
    displacement[list(system.cyclic)] = 0.0
    return MotionRows(
        displacement=displacement,
        velocity=velocity,
        acceleration=acceleration,
        branch=branch,
        height=inputs[:wheels],
        height_rate=height_rate,
        slope=height_rate + inputs[2 * wheels : 3 * wheels] if rolling else np.zeros_like(height_rate),
        laws=inputs[last - len(matrices.laws) : last],
        # Of redundant joints the smallest forces that balance.
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
    at = np.flatnonzero(s.imag <= 2.0 * np.pi * BAND)
    # z' = s z follows from z.
    height, others = spectra[:wheels, at], spectra[wheels:, at]
    inputs, effects = np.vstack([height, s[at] * height, others]), input_effects(model)
    poles = model.poles[:, None]
    # The constant part of a motion that nothing holds stays unknown.
    held = (s[at] != 0.0) | (np.abs(poles) > SLOWEST)
    ahead, back = (
        np.divide(b @ inputs, s[at] - p, out=np.zeros(held.shape, dtype=complex), where=held)
        for b, p in ((effects, poles), (effects.conj(), poles.conj()))
    )
    result = np.zeros((2 * len(poles) + len(inputs), lines), dtype=complex)
    result[:, at] = np.vstack([0.5 * (ahead + back), -0.5j * (ahead - back), inputs])
    return result


def periodic_spectra(inputs: Vector, interval: float, every: int) -> tuple[Complex, int]:
    """Return the spectra of inputs that return to their start, at each `every`-th sample, and the samples of a period.

    Args:
        inputs: histories, less what they are at rest; (inputs, n).
        interval: sampling interval of the histories [s].
        every: samples from one to the next of the result.
    """
    count, fall = inputs.shape[1], round(RETURN / interval)
    # Rounded up; `fast_length` makes it a product of small primes.
    coarse = -(-(count + round(PAUSE / interval)) // every)
    period = fast_length(coarse)
    padded = np.tile(inputs[:, :1], period * every)
    padded[:, :count] = inputs
    # A half cosine from the last value to the first: no jump, hence no high frequencies.
    way = 0.5 * (1.0 + np.cos(np.pi * np.arange(fall) / fall))
    padded[:, count : count + fall] += (inputs[:, -1:] - inputs[:, :1]) * way
    # The lines up to the coarse Nyquist frequency alone: every `every`-th sample without aliasing.
    return np.fft.rfft(padded, axis=1)[:, : period // 2 + 1] / every, period


def _slow(model: PoleModel) -> Indices:
    """Return the slow poles up to `BAND`: what is above it has no motion of its own here."""
    return np.flatnonzero((model.poles.real > -SLOW) & (np.abs(model.poles.imag) <= 2.0 * np.pi * BAND))


def continued(
    model: PoleModel, state: Complex, interval: float, samples: int, count: int, start: Complex | None
) -> tuple[Vector, Complex]:
    """Return what a periodic motion lacks to one that continues that of the samples before.

    Poles with a decay rate below `SLOW` would begin with what is left of the end of the period.

    Args:
        model: the car.
        state: spectra of the state over the period; (states, lines).
        interval: sampling interval [s].
        samples: samples of the period.
        count: samples of the record; from there to the end of the period the difference returns to its start.
        start: state of the slow poles at the first sample; None at rest.

    Returns:
        The difference of the state; (2 p, samples). State of the slow poles after the record.
    """
    poles = len(model.poles)
    slow = _slow(model)
    spectra = np.vstack([state[slow], state[poles + slow]])

    def present(sample: int) -> Complex:
        # One sample of the inverse transform: (2 Re sum X_k e^(2 pi i k n/N) - X_0)/N.
        turned = spectra * np.exp(2j * np.pi * sample / samples * np.arange(spectra.shape[1]))
        real, imaginary = np.split((2.0 * np.sum(turned.real, axis=1) - turned[:, 0].real) / samples, 2)
        return np.asarray(real + 1j * imaginary)

    # A difference of two solutions is free: it decays as exp(s t).
    lacking = -present(0) if start is None else start - present(0)
    decay = np.exp(model.poles[slow, None] * (interval * np.arange(samples)))
    end = present(count) + lacking * np.exp(model.poles[slow] * (interval * count))
    # After the record it returns to its start, so that the sum stays periodic.
    way = 0.5 * (1.0 - np.cos(np.pi * np.arange(samples - count) / (samples - count)))
    decay[:, count:] += (1.0 - decay[:, count:]) * way
    difference = np.zeros((2 * poles, samples))
    difference[slow], difference[poles + slow] = (lacking[:, None] * decay).real, (lacking[:, None] * decay).imag
    return difference, end


def slow_end(model: PoleModel, inputs: Vector, interval: float, start: Complex | None) -> Complex:
    """Return the state of the slow poles, see `continued`, one interval after the last sample of their inputs.

    xi(T) = e^(p T) xi(0) + integral of e^(p (T - t)) b u(t) dt, by the trapezoidal rule, with z' by parts.

    Args:
        model: the car.
        inputs: inputs without z', less what they are at rest; (inputs - w, n).
        interval: sampling interval [s].
        start: state at the first sample; None at rest.
    """
    wheels, count = len(model.matrices.system.inputs), inputs.shape[1]
    slow = _slow(model)
    poles, effects = model.poles[slow, None], input_effects(model)[slow]
    height, velocity, others = np.split(effects, [wheels, 2 * wheels], axis=1)
    # The last sample holds until the end.
    inputs = np.hstack([inputs, inputs[:, -1:]])
    weights = np.exp(poles * (interval * np.arange(count, -1, -1)))
    end = np.zeros(len(slow), dtype=complex) if start is None else start * weights[:, 0]
    # integral e^(p (T - t)) z' dt = z(T) - e^(p T) z(0) + p integral e^(p (T - t)) z dt.
    end = end + velocity @ inputs[:wheels, -1] - weights[:, 0] * (velocity @ inputs[:wheels, 0])
    weights[:, [0, -1]] *= 0.5
    driven = np.hstack([height + poles * velocity, others]) @ inputs
    return np.asarray(end + interval * np.sum(weights * driven, axis=1))


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
