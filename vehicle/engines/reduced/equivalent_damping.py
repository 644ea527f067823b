"""Statistical linearisation of dampers and of laws over displacement: FRFs of the car about the motion of a run.

A damper with the force F(v) is replaced by the viscous damper that minimises the mean square error of the force over
the record, mean((F - mean F - c v)^2):

    c = mean((F - mean F) v) / mean(v^2).

It dissipates the same energy. A stuck damper is as stiff as the slope of its friction law at rest, and a slipping
damper as soft as its force over its stroke, so no constant FRF describes both. The poles of the car contain the damping
constants D already. A law over displacement, whose tangent at rest the poles contain, has the rest g(x), with
memory if it is rubber friction: g is replaced by k x + c x', k = mean(g x)/mean(x^2), c = mean(g x')/mean(x'^2).

The remainder acts as forces f = -(c - D) v, so that at each line

    v = (I + T_vf (c - D))^-1 T_vz z,    y = T_yz z - T_yf (c - D) v.

Sources: Caughey, J. Acoust. Soc. Am. 35 (1963) 1706; Roberts and Spanos, Random Vibration and Statistical
Linearization, 1990, chapter 2.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.model.laws.damper import damper_law
from vehicle.model.parameters.force_elements import Damper


def equivalent_damping(law: Damper, velocity: Vector, force: Vector) -> float:
    """Return the equivalent damping constant c of a damper [N s/m]; without motion, the slope of its law at rest.

    Args:
        law: law of the damper.
        velocity: damper velocity [m/s], (n,).
        force: damper force [N], positive against a positive velocity, (n,).
    """
    power = float(np.mean(velocity**2))
    if power == 0.0:
        return float(damper_law(law).slope(0.0))
    return float(np.mean((force - force.mean()) * velocity)) / power


def equivalent_laws(model: PoleModel, state: Complex, interval: float, samples: int) -> Vector:
    """Return stiffness k [N/m] and damping c [N s/m] of the laws over displacement beyond their tangents; (2, l).

    Both are 0 of a law that stays in the segment of the static equilibrium, or does not move.

    Args:
        model: the car.
        state: spectra of the state over a period, see `vehicle.engines.reduced.linear_motion.state_spectra`.
        interval: sampling interval [s].
        samples: samples of the period.
    """
    s = 2j * np.pi * np.arange(1, state.shape[1]) / (samples * interval)
    outputs, count = model.law_outputs, len(model.laws)
    (real, imaginary), inputs = np.split(state[: 2 * len(model.poles), 1:], 2), state[2 * len(model.poles) :, 1:]
    wheels = outputs.height.shape[1]
    # The spectrum of Re(row xi); the state contains separate spectra of Re xi and Im xi.
    x = outputs.poles.real @ real - outputs.poles.imag @ imaginary
    x += outputs.height @ inputs[:wheels] + outputs.velocity @ inputs[wheels : 2 * wheels]
    end = len(inputs) - model.applied.shape[1]
    # The forces of the laws are the last inputs before the applied forces.
    force, result = inputs[end - count : end], np.zeros((2, count))
    # Parseval: mean(g x)/mean(x^2) = sum Re(G X*)/sum |X|^2; the mean, line 0, is left out.
    for term, motion in zip(result, (x, s * x), strict=True):
        level = np.sum(np.abs(motion) ** 2, axis=1)
        np.divide(np.sum((force * motion.conj()).real, axis=1), level, out=term, where=level > 0.0)
    return result


def linearised_response(
    model: PoleModel, damping: Vector, channels: Sequence[str], wheels: Sequence[str], frequency: Vector
) -> Complex:
    """Return the FRFs of accelerations to plate displacements with viscous dampers [m/s2 per m]; (k, p, m).

    Args:
        model: pole model of the car.
        damping: damping constant c of each damper [N s/m], (d,).
        channels: names of k accelerations.
        wheels: names of the p plates.
        frequency: lines [Hz], (m,).
    """
    s = np.asarray(2j * np.pi * np.asarray(frequency), dtype=np.complex128)
    inputs = [model.matrices.system.inputs.index(wheel) for wheel in wheels]
    positions = model.outputs(channels).poles
    excess = (damping - model.matrices.viscous)[:, None]
    plate, rate, force = model.height[:, inputs], model.velocity[:, inputs], model.force
    # T_vz: a plate acts by its displacement and by its velocity s z.
    slip = _transfer(model, model.slip, plate, s) + s * _transfer(model, model.slip, rate, s)
    # I + T_vf (c - D) at each line; (m, d, d).
    coupling = np.eye(len(excess)) + np.moveaxis(_transfer(model, model.slip, force * excess.T, s), -1, 0)
    velocity = np.moveaxis(np.linalg.solve(coupling, np.moveaxis(slip, -1, 0)), 0, -1)
    direct = _transfer(model, positions, plate, s) + s * _transfer(model, positions, rate, s)
    by_force: Complex = _transfer(model, positions, force, s)
    displacement = direct - (by_force[:, :, None] * (excess[:, :, None] * velocity)[None]).sum(axis=1)
    return np.asarray(s**2 * displacement)


def _transfer(model: PoleModel, rows: Complex, residues: Complex, s: Complex) -> Complex:
    """Return the FRFs of Re(rows xi) to inputs with residues (p, i) on the poles; (outputs, i, m)."""
    products = rows[:, None, :] * residues.T[None]
    # Re(a xi) = (a xi + conj(a xi))/2: a stored pole and its conjugate; products: (outputs, inputs, poles).
    positive_part = 0.5 * products @ (1.0 / (s - model.poles[:, None]))
    return np.asarray(positive_part + 0.5 * products.conj() @ (1.0 / (s - model.poles.conj()[:, None])))
