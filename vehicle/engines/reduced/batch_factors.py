"""Factors of a car in a batch: time-step factors of the integrated poles, and weights of the outputs.

With y = xi - kappa z, kappa = -b_z/s, and r = b_c + b_z/s, a step h with a quadratic z', given by its ends and its mean
m, gives

    y+ = E y + r ((M0 - 4 M1 + 3 M2) z' + (3 M2 - 2 M1) z'+ + 6 (M1 - M2) m) + e (M0 f + (M1 - M0/2) slope)

with the moments M_j of the exponential. eta = y - r (3 M2 - 2 M1) z' depends only on the beginning of a step.

Fast poles are quasi-static, y = -(r z' + e f)/s, and not integrated. The set of fast poles is chosen so that their
total delay is at most `DELAY` of any response of a damper velocity or an acceleration at the end of the band that the
step resolves. The criterion uses the total, because poles occur in clusters whose residues cancel.
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
"""Maximum error of a response at the end of the band, over its RMS in the band, due to all quasi-static poles.

The error grows with the frequency, so the RMS of an output on a road with white z' is wrong by at most about
DELAY/sqrt(3), 0.03 %: a fifth of the tolerance of comfort. The value is a choice: for 100 modified cars, comfort
changes by less than 0.002 % from 5e-5 to 5e-3, and six of 14 real poles and two of 39 pairs are not integrated."""

STEPS_A_PERIOD = 20
"""Steps in a period of the highest frequency that a step resolves: 100 Hz at 0.5 ms."""

LINES = np.array([0.2, 0.4, 0.7, 1.0])
"""Relative frequencies in the band at which the RMS of a response is computed."""

LARGEST_COUPLING = 0.01
"""Maximum coupling rho: total effect of the other dampers on a damper, over its effect on itself.

The change of a force is at most the change of its input, so an iteration reduces the largest error of a force,
initially its change in the step, by rho. Two iterations leave rho^2, and rho^3 with two dampers (Gauss-Seidel): 1e-6,
the round-off of sums in single precision. The dampers of the `focus` car, also at four corners, stay below 1e-3."""

SLOWEST = 1e-2
"""Minimum |s| [rad/s] of a pole that can be integrated as a difference from its static value."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarFactors:
    """Factors of a car for a time step.

    Attributes:
        columns: indices of the driven plates; (m,).
        integrated: indices of the integrated poles, p pairs and q real poles; (p + q,).
        pairs: p.
        step: E and factors of mean forces, slopes, z' and mean z' for the integrated poles; (p + q, 1 + 2 d + 2 m).
        direct: contributions of mean forces, their slopes, z' and z to eta of all poles; (n, 2 d + 2 m).
        slip: rows of the damper velocities; (d, n).
        gains: contributions of z', mean forces and slopes to the damper velocities; (d, m), (d, d), (d, d).
    """

    columns: list[int]
    integrated: npt.NDArray[np.intp]
    pairs: int
    step: Complex
    direct: Complex
    slip: Complex
    gains: tuple[Vector, Vector, Vector]

    @property
    def reals(self) -> int:
        """Return the number q of integrated real poles."""
        return len(self.integrated) - self.pairs

    @property
    def coupling(self) -> float:
        """Return the largest total effect of other dampers on a damper, over its effect on itself."""
        gain = np.abs(self.gains[1])
        return float(np.max(gain.sum(axis=1) / np.diag(gain))) - 1.0

    def start(self, displacements: Vector, rates: Vector) -> tuple[Vector, Vector]:
        """Return the initial states of a car at rest: pairs, real and imaginary parts alternating, and real poles.

        Args:
            displacements, rates: z and z' of the driven plates at the first instant; (m,) each.
        """
        eta = -self.direct[self.integrated, -2 * len(self.columns) :] @ np.append(rates, displacements)
        return eta[: self.pairs].view(np.float64), eta[self.pairs :].real

    def rows(self) -> tuple[Vector, Vector]:
        """Return the rows of the pairs and of the real poles for `vehicle.engines.reduced.batch_step.advance_batch`.

        Returns:
            Decay, inputs and damper velocities: (pairs, ...) with real and imaginary parts, (reals, ...).
        """
        slip, p = self.slip[:, self.integrated].T, self.pairs
        decay, inputs = self.step[:p, :1], self.step[:p, 1:]
        pairs = [decay.real, decay.imag, inputs.real, inputs.imag, slip[:p].real, -slip[:p].imag]
        return np.hstack(pairs), np.hstack([self.step[p:].real, slip[p:].real])

    def weights(self, rows: Complex) -> Vector:
        """Return the weights of states (pairs, real poles), mean forces, slopes, z' and z in sums Re(rows xi).

        Args:
            rows: rows over the poles; (k, n).

        Returns:
            Weights; (k, 2 p + q + 2 d + 2 m).
        """
        integrated_rows, p = rows[:, self.integrated].conj(), self.pairs
        pairs = np.ascontiguousarray(integrated_rows[:, :p]).view(np.float64)
        return np.hstack([pairs, integrated_rows[:, p:].real, (rows @ self.direct).real])

    def weights_of(self, outputs: Outputs) -> Vector:
        """Return the weights of linear outputs, with their direct terms of the plates."""
        weights, m = self.weights(outputs.poles), len(self.columns)
        weights[:, -2 * m : -m] += outputs.velocity[:, self.columns]
        weights[:, -m:] += outputs.height[:, self.columns]
        return weights


def car_factors(
    models: Sequence[PoleModel], dampers: Sequence[Sequence[Damper]], timestep: float, columns: Sequence[int]
) -> dict[int, CarFactors]:
    """Compute the factors of the cars that can be simulated as a batch.

    Cars with controlled or strongly coupled dampers, or with a pole near zero, are left out.

    Args:
        models, dampers: pole models and damper laws of the cars.
        timestep: h [s].
        columns: indices of the driven plates.

    Returns:
        Index of a car to its factors.
    """
    supported = [
        car
        for car, laws in enumerate(dampers)
        if not any(law.controlled for law in laws) and np.min(np.abs(models[car].poles)) >= SLOWEST
    ]
    if not supported:
        return {}
    h, driven = timestep, list(columns)
    m, d = len(driven), models[supported[0]].force.shape[1]
    inputs_of_cars = [_Inputs(models[car], driven, h) for car in supported]
    # Compute the integrated poles of all cars at once.
    s = np.concatenate([car_inputs.poles[car_inputs.integrated] for car_inputs in inputs_of_cars])[:, None]
    inputs = np.concatenate([car_inputs.both[car_inputs.integrated] for car_inputs in inputs_of_cars])
    residue, force = inputs[:, :m], inputs[:, m:]
    m0, m1, m2 = (
        h * factorial(j) * phi for j, phi in enumerate(phi_functions(np.asarray(s * h, dtype=np.complex128), 3))
    )
    decay, ahead = np.exp(s * h), residue * (3.0 * m2 - 2.0 * m1)
    direct = np.hstack([force * m0, force * (m1 - 0.5 * m0), ahead])
    plate_factors = residue * (m0 - 4.0 * m1 + 3.0 * m2) + decay * ahead
    step = np.hstack([decay, decay * direct[:, : 2 * d], plate_factors, residue * 6.0 * (m1 - m2)])
    factors_of_cars, first = {}, 0
    for car, car_inputs in zip(supported, inputs_of_cars, strict=True):
        part = slice(first, first + len(car_inputs.integrated))
        first = part.stop
        # The other poles are quasi-static.
        quasi_static = car_inputs.both / -car_inputs.poles[:, None]
        direct_factors = np.hstack(
            [quasi_static[:, m:], 0.5 * quasi_static[:, m:], quasi_static[:, :m], car_inputs.static]
        )
        direct_factors[car_inputs.integrated, :-m] = direct[part]
        slip = models[car].slip
        velocity_gains = (slip @ direct_factors).real
        factors = CarFactors(
            columns=driven,
            integrated=car_inputs.integrated,
            pairs=int(np.count_nonzero(car_inputs.integrated < models[car].pairs)),
            step=step[part],
            direct=direct_factors,
            slip=slip,
            gains=(velocity_gains[:, 2 * d : -m], velocity_gains[:, :d], velocity_gains[:, d : 2 * d]),
        )
        if factors.coupling <= LARGEST_COUPLING:
            factors_of_cars[car] = factors
    return factors_of_cars


class _Inputs:
    """Inputs of the poles of a car, and the set of integrated poles.

    Args:
        model: pole model of the car.
        columns: indices of the driven plates.
        timestep: time step [s].

    Attributes:
        poles: poles s; (n,).
        static: kappa; (n, m).
        both: residues r of z' of the driven plates, and e of the forces; (n, m + d).
        integrated: indices of the integrated poles.
    """

    def __init__(self, model: PoleModel, columns: list[int], timestep: float) -> None:
        self.poles = model.poles
        self.static = -model.height[:, columns] / model.poles[:, None]
        self.both = np.hstack([model.velocity[:, columns] - self.static, model.force])
        self.integrated = np.flatnonzero(_integrated(model, self.both, timestep))


def _integrated(model: PoleModel, inputs: Complex, timestep: float) -> npt.NDArray[np.bool_]:
    """Return a mask of the poles that are integrated, True for an integrated pole.

    Args:
        model: pole model of the car.
        inputs: residues of z' of the driven plates and of the forces; (n, m + d).
        timestep: time step [s].
    """
    system, s, n = model.matrices.system, model.poles, len(model.poles)
    positions = np.array([row[: system.size] for row in system.outputs.values()]).reshape(-1, system.size)
    # Damper velocities, and displacements of the acceleration channels.
    shapes = np.ascontiguousarray(model.modal).view(np.float64)
    rows = np.concatenate([model.slip, (positions @ shapes).view(np.complex128)])
    derivative = np.where(np.arange(len(rows)) < len(model.slip), 0, 2)[:, None, None]
    # A pole represents its conjugate, whose contribution at a line is the conjugate of that of the pole at minus the
    # line.
    band = 2j * np.pi / (STEPS_A_PERIOD * timestep)
    lines = band * np.concatenate([LINES, -LINES])
    shares = rows @ (inputs[:, :, None] / (lines - s[:, None])[:, None, :]).reshape(n, -1)
    shares = shares.reshape(len(rows), -1, 2, len(LINES))
    response = (shares[:, :, 0] + shares[:, :, 1].conj()) * LINES**derivative
    rms = np.sqrt(np.mean(_squares(response), axis=2)) + np.finfo(float).tiny
    fast_candidates, is_integrated = np.flatnonzero(np.abs(s) > abs(band)), np.ones(n, dtype=bool)
    if not fast_candidates.size:
        return is_integrated
    s = s[fast_candidates][:, None]
    products = (
        np.ascontiguousarray(rows.T[fast_candidates])[:, None] * (inputs[fast_candidates][:, :, None] / rms.T)
    ).reshape(len(s), -1)
    delay = products * (band / (s * (band - s))) + (products * (band / (s * (band + s)))).conj()
    sequence = np.argsort(np.max(_squares(delay), axis=1), kind="stable")
    total_delay = np.max(_squares(np.cumsum(delay[sequence], axis=0)), axis=1)
    negligible = np.flatnonzero(total_delay <= DELAY**2)
    is_integrated[fast_candidates[sequence[: negligible[-1] + 1 if negligible.size else 0]]] = False
    return is_integrated


def _squares(numbers: Complex) -> Vector:
    """Return squares of magnitudes."""
    return np.asarray(numbers.real**2 + numbers.imag**2)
