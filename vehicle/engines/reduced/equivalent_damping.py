"""Statistical linearisation of dampers and of laws over displacement: FRFs of the car about the motion of a run.

A damper with the force F(v) is replaced by the viscous damper that minimises the mean square error of the force over
the record, mean((F - mean F - c v)^2):

    c = mean((F - mean F) v) / mean(v^2).

It dissipates the same energy. A stuck damper is as stiff as the slope of its friction law at rest, and a slipping
damper as soft as its force over its stroke, so no constant FRF describes both. The poles of the car contain the damping
constants D already. A law over displacement, whose tangent at rest the poles contain, has the rest g(x), with
memory if it is rubber friction: g is replaced by k x + c x', k = mean(g x)/mean(x^2), c = mean(g x')/mean(x'^2).

`vehicle.engines.reduced.linear_twin` has the responses with other damping constants.

Sources: Caughey, J. Acoust. Soc. Am. 35 (1963) 1706; Roberts and Spanos, Random Vibration and Statistical
Linearization, 1990, chapter 2.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.mapped_table import release
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
    done = float(np.mean((force - force.mean()) * velocity))
    release(force)
    return done / power


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
    inputs = [model.matrices.system.inputs.index(wheel) for wheel in wheels]
    unit_plates = np.eye(len(model.matrices.system.inputs))[:, inputs, None]
    return linear_twin(model, channels, frequency, unit_plates).responses(damping)
