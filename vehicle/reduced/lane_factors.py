"""What a car gives the march in lanes: factors of a step for the poles that it needs, weights of what is read.

With y = xi - kappa z, kappa = -b_z/s, and r = b_c + b_z/s, a step h with z' a quadratic of its ends and mean m gives

    y+ = E y + r ((M0 - 4 M1 + 3 M2) z' + (3 M2 - 2 M1) z'+ + 6 (M1 - M2) m) + e (M0 f + (M1 - M0/2) slope)

with M_j the moments of the exponential. eta = y - r (3 M2 - 2 M1) z' knows the beginning of a step alone.

A pole so fast that it follows at once, y = -(r z' + e f)/s, is not marched. Which are: those whose delay, of all
together, is at most `DELAY` of any response of a damper velocity or an acceleration at the end of the band that the
step resolves. A single pole says little, for poles of a kind come in clusters whose residues cancel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial

import numpy as np
import numpy.typing as npt

from vehicle.parameters.elements import Damper
from vehicle.reduced.pole_model import Outputs, PoleModel
from vehicle.reduced.step_factors import phi_functions

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

DELAY = 5e-4
"""Error of a response, over its size, that may come from all poles that are not marched."""

STEPS_A_PERIOD = 20
"""Of the highest frequency that a step resolves: 100 Hz at 0.5 ms."""

LINES = np.array([0.2, 0.4, 0.7, 1.0])
"""Frequencies of that band whose mean square is the size of a response."""

LOOSEST = 0.01
"""Largest effect of the other dampers on one, over its own, with which two turns solve a step in single precision."""

SLOWEST = 1e-2
"""Slowest pole [rad/s] that can be marched as a difference from rest."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarFactors:
    """Factors of a car for a step.

    Attributes:
        columns: driven plates; (m,).
        marched: marched poles; (p + q,).
        pairs, reals: numbers of those, p and q.
        decay, inputs: E and factors of mean forces, slopes, z' and mean z', of all poles; (n, 1), (n, 2 d + 2 m).
        static: kappa; (n, m).
        ahead, force, ramp: what z', the mean forces and their slopes add to eta; (n, m), (n, d), (n, d).
        slip: rows of the damper velocities; (d, n).
    """

    columns: list[int]
    marched: npt.NDArray[np.intp]
    pairs: int
    reals: int
    decay: Complex
    inputs: Complex
    static: Complex
    ahead: Complex
    force: Complex
    ramp: Complex
    slip: Complex

    @property
    def gains(self) -> tuple[Vector, Vector, Vector]:
        """What z', the mean forces and their slopes add to the damper velocities; (d, m), (d, d), (d, d)."""
        return (self.slip @ self.ahead).real, (self.slip @ self.force).real, (self.slip @ self.ramp).real

    @property
    def coupled(self) -> float:
        """Largest effect of the other dampers on one, over its own."""
        gain = np.abs(self.gains[1])
        return float(np.max(gain.sum(axis=1) / np.diag(gain))) - 1.0

    def poles(self, heights: Vector, rates: Vector) -> tuple[Vector, Vector]:
        """Rows of the pairs and of the real poles, as `advance` takes them, of a car at rest in its design position.

        Args:
            heights, rates: (z, z') of the driven plates at the first instant; (m,) each.

        Returns:
            State, decay, inputs, damper velocities: (pairs, ...) with real and imaginary parts, (reals, ...).
        """
        eta = (-self.static @ heights - self.ahead @ rates)[:, None]
        rows, p = np.hstack([eta, self.decay, self.inputs, self.slip.T])[self.marched], self.pairs
        groups = np.split(rows[:p], np.cumsum([1, 1, self.inputs.shape[1]]), axis=1)
        parts = [part for one in groups for part in (one.real, one.imag)]
        return np.hstack([*parts[:-1], -parts[-1]]), rows[p:].real

    def weights(self, outputs: Outputs) -> tuple[Vector, Vector, Vector]:
        """Weights of the pairs, the real poles, and of mean forces, slopes, z' and z; (outputs, ...) each."""
        rows, p = outputs.poles[:, self.marched], self.pairs
        pairs = np.stack([rows[:, :p].real, -rows[:, :p].imag], axis=2).reshape(len(rows), 2 * p)
        direct = (outputs.poles @ np.hstack([self.force, self.ramp, self.ahead, self.static])).real
        m = len(self.columns)
        direct[:, -2 * m : -m] += outputs.velocity[:, self.columns]
        direct[:, -m:] += outputs.height[:, self.columns]
        return pairs, rows[:, p:].real, direct


def car_factors(
    models: Sequence[PoleModel], dampers: Sequence[Sequence[Damper]], timestep: float, columns: Sequence[int]
) -> dict[int, CarFactors]:
    """Factors of the cars that the march in lanes knows: no damper controlled or tied to another, no pole at rest.

    Args:
        models, dampers: the cars.
        timestep: h [s].
        columns: driven plates.
    """
    known = [
        car
        for car, laws in enumerate(dampers)
        if not any(law.controlled for law in laws) and np.min(np.abs(models[car].poles)) >= SLOWEST
    ]
    if not known:
        return {}
    # The poles of all cars at once.
    poles, height, velocity, force = (
        np.concatenate([getattr(models[car], name) for car in known])
        for name in ("poles", "height", "velocity", "force")
    )
    h, s, chosen = timestep, poles[:, None], list(columns)
    m0, m1, m2 = (
        h * factorial(j) * phi[:, None]
        for j, phi in enumerate(phi_functions(np.asarray(poles * h, dtype=np.complex128), 3))
    )
    decay, static = np.exp(s * h), -height[:, chosen] / s
    residue = velocity[:, chosen] - static
    both = np.hstack([residue, force])
    ends = np.cumsum([0, *(len(models[car].poles) for car in known)]).tolist()
    own = [slice(*ends[place : place + 2]) for place in range(len(known))]
    marched = [_marched(models[car], both[part], h) for car, part in zip(known, own, strict=True)]
    late = np.concatenate(marched)[:, None]
    ahead = np.where(late, residue * (3.0 * m2 - 2.0 * m1), -residue / s)
    ramp = force * np.where(late, m1 - 0.5 * m0, -0.5 / s)
    force = force * np.where(late, m0, -1.0 / s)
    begin = residue * (m0 - 4.0 * m1 + 3.0 * m2) + decay * ahead
    inputs = np.hstack([decay * force, decay * ramp, begin, residue * 6.0 * (m1 - m2)])
    found = {}
    for car, part, one in zip(known, own, marched, strict=True):
        places = np.flatnonzero(one)
        pairs = int(np.count_nonzero(places < models[car].pairs))
        factors = CarFactors(
            columns=chosen,
            marched=places,
            pairs=pairs,
            reals=len(places) - pairs,
            decay=decay[part],
            inputs=inputs[part],
            static=static[part],
            ahead=ahead[part],
            force=force[part],
            ramp=ramp[part],
            slip=models[car].slip,
        )
        if factors.coupled <= LOOSEST:
            found[car] = factors
    return found


def _marched(model: PoleModel, inputs: Complex, timestep: float) -> npt.NDArray[np.bool_]:
    """Which poles are marched.

    Args:
        model: the car.
        inputs: residues of z' of the driven plates and of the forces; (n, m + d).
        timestep: [s].
    """
    system, s, n = model.matrices.system, model.poles, len(model.poles)
    places = np.array([row[: system.size] for row in system.outputs.values()]).reshape(-1, system.size)
    # Damper velocities, and positions, of which accelerations are made.
    rows = np.vstack([model.slip, places @ model.modal])
    order = np.where(np.arange(len(rows)) < len(model.slip), 0, 2)[:, None, None]
    # A pole of a pair stands for its conjugate, whose share at a line is the conjugate of its own at minus the line.
    band = 2j * np.pi / (STEPS_A_PERIOD * timestep)
    lines = band * np.concatenate([LINES, -LINES])
    shares = rows @ (inputs[:, :, None] / (lines - s[:, None])[:, None, :]).reshape(n, -1)
    shares = shares.reshape(len(rows), -1, 2, len(LINES))
    response = (shares[:, :, 0] + shares[:, :, 1].conj()) * LINES**order
    size = np.sqrt(np.mean(np.abs(response) ** 2, axis=2, keepdims=True)) + np.finfo(float).tiny
    quick, found = np.flatnonzero(np.abs(s) > abs(band)), np.ones(n, dtype=bool)
    if not quick.size:
        return found
    s = s[quick]
    products = (rows[:, quick][:, None] * (inputs[quick].T / size)).reshape(-1, len(s))
    late = products * (band / (s * (band - s))) + (products * (band / (s * (band + s)))).conj()
    sequence = np.argsort(np.max(np.abs(late), axis=0), kind="stable")
    together = np.max(np.abs(np.cumsum(late[:, sequence], axis=1)), axis=0)
    fast = np.flatnonzero(together <= DELAY)
    found[quick[sequence[: fast[-1] + 1 if fast.size else 0]]] = False
    return found
