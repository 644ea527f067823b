"""Statistical linearisation of the dampers: the FRFs of the car about the motion that a run has shown.

A damper of the force F(v) is replaced by the viscous one whose force is nearest to it over the record, which has the
mean square error mean((F - mean F - c v)^2) at its least:

    c = mean((F - mean F) v) / mean(v^2).

The energy that it takes is the same. A damper that sticks is as stiff as its friction law is steep at rest, one that
slips is as soft as its force over its stroke: no constant FRF says both. With the car as a sum over its poles, whose
dampers have their constants D already, the rest acts as forces f = -(c - D) v, so that at each line

    v = (I + T_vf (c - D))^-1 T_vz z,    y = T_yz z - T_yf (c - D) v.

Sources: Caughey, J. Acoust. Soc. Am. 35 (1963) 1706; Roberts and Spanos, Random Vibration and Statistical
Linearization, 1990, chapter 2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.model.laws.damper import damper_law
from vehicle.model.parameters.force_elements import Damper

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


def equivalent_damping(law: Damper, velocity: Vector, force: Vector) -> float:
    """Damping constant c of a damper over a record [N s/m]; the slope of its law at rest where it did not move.

    Args:
        law: of the damper.
        velocity: [m/s], (n,).
        force: positive against a positive velocity [N], (n,).
    """
    power = float(np.mean(velocity**2))
    if power == 0.0:
        return float(damper_law(law).slope(0.0))
    return float(np.mean((force - force.mean()) * velocity)) / power


def linearised_response(
    model: PoleModel, damping: Vector, channels: Sequence[str], wheels: Sequence[str], frequency: Vector
) -> Complex:
    """FRFs of accelerations to plate displacements with viscous dampers.

    Args:
        model: the car.
        damping: c of each damper [N s/m], (d,).
        channels: names of k accelerations.
        wheels: names of the p plates.
        frequency: lines [Hz], (m,).

    Returns:
        [m/s2 per m], (k, p, m).
    """
    s = np.asarray(2j * np.pi * np.asarray(frequency), dtype=np.complex128)
    inputs = [model.matrices.system.inputs.index(wheel) for wheel in wheels]
    positions = model.outputs(channels).poles
    more = (damping - model.matrices.viscous)[:, None]
    plate, rate, force = model.height[:, inputs], model.velocity[:, inputs], model.force
    slip = _transfer(model, model.slip, plate, s) + s * _transfer(model, model.slip, rate, s)
    held = np.eye(len(more)) + np.moveaxis(_transfer(model, model.slip, force * more.T, s), -1, 0)
    velocity = np.moveaxis(np.linalg.solve(held, np.moveaxis(slip, -1, 0)), 0, -1)
    own = _transfer(model, positions, plate, s) + s * _transfer(model, positions, rate, s)
    back: Complex = _transfer(model, positions, force, s)
    found = own - (back[:, :, None] * (more[:, :, None] * velocity)[None]).sum(axis=1)
    return np.asarray(s**2 * found)


def _transfer(model: PoleModel, rows: Complex, residues: Complex, s: Complex) -> Complex:
    """Re(rows xi) per unit of the inputs that act on the poles as residues (p, i): (outputs, i, m)."""
    products = rows[:, None, :] * residues.T[None]
    before = 0.5 * products @ (1.0 / (s - model.poles[:, None]))
    return np.asarray(before + 0.5 * products.conj() @ (1.0 / (s - model.poles.conj()[:, None])))
