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

from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.step_factors import phi_functions
from vehicle.model.parameters.force_elements import Damper

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

DELAY = 5e-4
"""Error of a response at the end of the band, over its RMS in it, that may come from all poles that are not marched.

What a fast pole leaves out grows with the frequency, so the RMS of an output of a road with white z' lacks about
DELAY/sqrt(3), 0.03 %, at most: a fifth of what is asked of comfort. The number is chosen. 100 varied cars do not tell:
from 5e-5 to 5e-3 their comfort moves by less than 0.002 %, and six real poles of 14 and two pairs of 39 are saved."""

STEPS_A_PERIOD = 20
"""Of the highest frequency that a step resolves: 100 Hz at 0.5 ms."""

LINES = np.array([0.2, 0.4, 0.7, 1.0])
"""Frequencies of that band whose mean square is the size of a response."""

LOOSEST = 0.01
"""Largest effect rho of the other dampers on one, over its own, in all.

No law answers by more than what arrives. So a turn leaves at most rho of the largest error of a force, which was at
first its change in the step: two turns leave rho^2, and rho^3 with two dampers, where the second sees the first: 1e-6,
the round-off of sums in single precision. The dampers of the Focus, at its four corners too, stay below 1e-3."""

SLOWEST = 1e-2
"""Slowest pole [rad/s] that can be marched as a difference from rest."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarFactors:
    """Factors of a car for a step.

    Attributes:
        columns: driven plates; (m,).
        marched: marched poles, p of pairs and q real ones; (p + q,).
        pairs: p.
        step: E and factors of mean forces, slopes, z' and mean z', of the marched poles; (p + q, 1 + 2 d + 2 m).
        direct: what mean forces, their slopes, z' and z add to eta, of all poles; (n, 2 d + 2 m).
        slip: rows of the damper velocities; (d, n).
        gains: what z', mean forces and slopes add to the damper velocities; (d, m), (d, d), (d, d).
    """

    columns: list[int]
    marched: npt.NDArray[np.intp]
    pairs: int
    step: Complex
    direct: Complex
    slip: Complex
    gains: tuple[Vector, Vector, Vector]

    @property
    def reals(self) -> int:
        """Number of marched real poles, q."""
        return len(self.marched) - self.pairs

    @property
    def coupled(self) -> float:
        """Largest effect of the other dampers on one, over its own."""
        gain = np.abs(self.gains[1])
        return float(np.max(gain.sum(axis=1) / np.diag(gain))) - 1.0

    def start(self, heights: Vector, rates: Vector) -> tuple[Vector, Vector]:
        """States of the pairs, real and imaginary parts by turns, and of the real poles of a car at rest by design.

        Args:
            heights, rates: (z, z') of the driven plates at the first instant; (m,) each.
        """
        eta = -self.direct[self.marched, -2 * len(self.columns) :] @ np.append(rates, heights)
        return eta[: self.pairs].view(np.float64), eta[self.pairs :].real

    def rows(self) -> tuple[Vector, Vector]:
        """Rows of the pairs and of the real poles, as `vehicle.engines.reduced.lane_step.advance` takes them.

        Returns:
            Decay, inputs, damper velocities: (pairs, ...) with real and imaginary parts, (reals, ...).
        """
        slip, p = self.slip[:, self.marched].T, self.pairs
        decay, inputs = self.step[:p, :1], self.step[:p, 1:]
        pairs = [decay.real, decay.imag, inputs.real, inputs.imag, slip[:p].real, -slip[:p].imag]
        return np.hstack(pairs), np.hstack([self.step[p:].real, slip[p:].real])

    def weights(self, rows: Complex) -> Vector:
        """Weights of the states (pairs, real poles), and of mean forces, slopes, z' and z, in sums Re(rows xi).

        Args:
            rows: (k, n).

        Returns:
            (k, 2 p + q + 2 d + 2 m).
        """
        chosen, p = rows[:, self.marched].conj(), self.pairs
        pairs = np.ascontiguousarray(chosen[:, :p]).view(np.float64)
        return np.hstack([pairs, chosen[:, p:].real, (rows @ self.direct).real])

    def weights_of(self, outputs: Outputs) -> Vector:
        """Weights of linear outputs, in which plates stand too."""
        found, m = self.weights(outputs.poles), len(self.columns)
        found[:, -2 * m : -m] += outputs.velocity[:, self.columns]
        found[:, -m:] += outputs.height[:, self.columns]
        return found


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
    h, chosen = timestep, list(columns)
    m, d = len(chosen), models[known[0]].force.shape[1]
    own = [_Inputs(models[car], chosen, h) for car in known]
    # The marched poles of all cars at once.
    s = np.concatenate([one.poles[one.marched] for one in own])[:, None]
    inputs = np.concatenate([one.both[one.marched] for one in own])
    residue, force = inputs[:, :m], inputs[:, m:]
    m0, m1, m2 = (
        h * factorial(j) * phi for j, phi in enumerate(phi_functions(np.asarray(s * h, dtype=np.complex128), 3))
    )
    decay, ahead = np.exp(s * h), residue * (3.0 * m2 - 2.0 * m1)
    direct = np.hstack([force * m0, force * (m1 - 0.5 * m0), ahead])
    begin = residue * (m0 - 4.0 * m1 + 3.0 * m2) + decay * ahead
    step = np.hstack([decay, decay * direct[:, : 2 * d], begin, residue * 6.0 * (m1 - m2)])
    found, first = {}, 0
    for car, one in zip(known, own, strict=True):
        part = slice(first, first + len(one.marched))
        first = part.stop
        # Those that are not marched follow at once.
        at_once = one.both / -one.poles[:, None]
        whole = np.hstack([at_once[:, m:], 0.5 * at_once[:, m:], at_once[:, :m], one.static])
        whole[one.marched, :-m] = direct[part]
        slip = models[car].slip
        added = (slip @ whole).real
        factors = CarFactors(
            columns=chosen,
            marched=one.marched,
            pairs=int(np.count_nonzero(one.marched < models[car].pairs)),
            step=step[part],
            direct=whole,
            slip=slip,
            gains=(added[:, 2 * d : -m], added[:, :d], added[:, d : 2 * d]),
        )
        if factors.coupled <= LOOSEST:
            found[car] = factors
    return found


class _Inputs:
    """What moves the poles of a car, and which are marched.

    Args:
        model: the car.
        columns: driven plates.
        timestep: [s].

    Attributes:
        poles: s; (n,).
        static: kappa; (n, m).
        both: residues r of z' of the driven plates, and e of the forces; (n, m + d).
        marched: numbers of the marched poles.
    """

    def __init__(self, model: PoleModel, columns: list[int], timestep: float) -> None:
        self.poles = model.poles
        self.static = -model.height[:, columns] / model.poles[:, None]
        self.both = np.hstack([model.velocity[:, columns] - self.static, model.force])
        self.marched = np.flatnonzero(_marched(model, self.both, timestep))


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
    shapes = np.ascontiguousarray(model.modal).view(np.float64)
    rows = np.concatenate([model.slip, (places @ shapes).view(np.complex128)])
    order = np.where(np.arange(len(rows)) < len(model.slip), 0, 2)[:, None, None]
    # A pole of a pair stands for its conjugate, whose share at a line is the conjugate of its own at minus the line.
    band = 2j * np.pi / (STEPS_A_PERIOD * timestep)
    lines = band * np.concatenate([LINES, -LINES])
    shares = rows @ (inputs[:, :, None] / (lines - s[:, None])[:, None, :]).reshape(n, -1)
    shares = shares.reshape(len(rows), -1, 2, len(LINES))
    response = (shares[:, :, 0] + shares[:, :, 1].conj()) * LINES**order
    size = np.sqrt(np.mean(_squares(response), axis=2)) + np.finfo(float).tiny
    quick, found = np.flatnonzero(np.abs(s) > abs(band)), np.ones(n, dtype=bool)
    if not quick.size:
        return found
    s = s[quick][:, None]
    products = (np.ascontiguousarray(rows.T[quick])[:, None] * (inputs[quick][:, :, None] / size.T)).reshape(len(s), -1)
    late = products * (band / (s * (band - s))) + (products * (band / (s * (band + s)))).conj()
    sequence = np.argsort(np.max(_squares(late), axis=1), kind="stable")
    together = np.max(_squares(np.cumsum(late[sequence], axis=0)), axis=1)
    fast = np.flatnonzero(together <= DELAY**2)
    found[quick[sequence[: fast[-1] + 1 if fast.size else 0]]] = False
    return found


def _squares(numbers: Complex) -> Vector:
    """Squares of magnitudes."""
    return np.asarray(numbers.real**2 + numbers.imag**2)
