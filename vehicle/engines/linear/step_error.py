"""How well a step of the time integration answers a car, known before the run.

Three things are asked of the one-step map (`vehicle.engines.linear.step_map`), with the dampers stuck and sliding, and
a fourth of the laws over displacement:

- none of its eigenvalues grows, as none of the car's poles does;
- every pole up to 100 Hz stands where the matrices have it. Near its resonance a pole answers with 1/(i w - s), so
  |s_h - s| / |Re s| is the error of its peak;
- light parts behind stiff mounts vibrate above 100 Hz and ring when the damper breaks away or stops. Each acceleration
  a(t) after a step of the friction force is judged by its norm, int a2 exp(-2 t/T) dt with T = 1 s, of the map against
  that of the matrices; both are sums over pairs of poles;
- a step takes the tangent of a table into account as it goes, but what a piece is steeper by, dk, only as it begins: a
  stop that is hit. With 1/m = r N (N' M_h N)^-1 N' r', the mobility of the step along the row r, w = sqrt(dk/m) becomes
  2 asin(w h/2)/h (leapfrog), and w h = 2 is the end of stability.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.car_modes import require_stable
from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.engines.linear.step_map import StepMap, StepRows, step_map, step_rows
from vehicle.engines.linear.strained_part import holding_parameter, moving_part
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

HIGHEST_POLE = 2.0 * np.pi * 100.0
"""|s| [rad/s] up to which every pole is judged: the comfort band ends at 50 Hz, the weightings at 80."""

POLE_LIMIT = 0.10
"""Largest error of the peak of a pole. The `focus` car has 0.02 at its vibrations and 0.05 at a real pole of 71 Hz,
where every RMS below 100 Hz is within 0.4 % of an eighth of the step; up to 0.22 it stayed within 1 %."""

LEAST_DAMPING = 0.01
"""An undamped pole has a peak without bound; it is judged as if it had this damping ratio."""

LOCAL_LIMIT = 0.10
"""Largest error of the ringing after a step of friction. Friction is a part of the motion only: over 10 s of the high
input the RMS of the damper top was off by 2.4 % at 0.07 (the car of Bommer 2006), 5.3 % at 0.08, 10 % at 0.12, 16 % at
0.19 and 20 % at 0.31 (stiffer and stiffer suspension mounts); body, engine and knuckle stayed within 0.15 %."""

STEEP_LIMIT = 1.0
"""Largest w h of a steeper piece of a table: its vibration is 4.7 % high there. Stops of the dampers of `focus`, hit
at 12 mm on a road of 6 mm RMS, against an eighth of the step: the vertical RMS of the damper top was off by 2 % at 0.2
(friction alone), 3 % at 0.75, 5 % at 1.2 and 31 % at 1.7, that of the seat rail by 0.05 % at most."""

FADING = 1.0
"""1/T [1/s] of the norm: keeps the ringing of undamped parts finite."""

SMALLEST_STEP = 1e-5
"""Shortest step [s] that is offered: where even this does not do, a parameter is the mistake."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Fault:
    """Why a step does not do.

    Attributes:
        words: what goes wrong, with the part and the parameter.
        severity: error over its limit.
        pole, shape: the motion in which it shows.
        held: what holds it; the element that works most in that motion where it is empty.
    """

    words: str
    severity: float
    pole: complex
    shape: Complex
    held: str = ""


def accurate_step(car: CarModel, matrices: CarMatrices) -> float:
    """The step of a car, halved until it answers the car [s].

    Args:
        car: the car with the first step to try.
        matrices: of the same car.

    Raises:
        ConfigurationError: a pole of the car grows, or no step down to `SMALLEST_STEP` does.
    """
    judge, step = _Judge(car, matrices), float(car.model.opt.timestep)
    while judge.worst(step) is not None:
        step /= 2.0
        if step < SMALLEST_STEP:
            require_accurate_step(car, matrices)
    return step


def require_accurate_step(car: CarModel, matrices: CarMatrices) -> None:
    """Refuse a step that would not answer a car, with the step that does.

    Args:
        car: the car with its step.
        matrices: of the same car.

    Raises:
        ConfigurationError: a pole of the car grows, or the step does not do: which part, which parameter, which step.
    """
    judge = _Judge(car, matrices)
    found = float(car.model.opt.timestep)
    fault = judge.worst(found)
    if fault is None:
        return
    step = found / 2.0
    while step >= SMALLEST_STEP and judge.worst(step) is not None:
        step /= 2.0
    culprit = (
        f"{fault.words} ({abs(fault.pole) / (2.0 * np.pi):.0f} Hz: {moving_part(matrices, fault.shape)} moves, held by "
        f"{fault.held or holding_parameter(car, fault.pole, fault.shape)})"
    )
    mend = (
        f"give solver.timestep={step:g}, or another value of that parameter where it is a mistake"
        if step >= SMALLEST_STEP
        else f"no step down to {SMALLEST_STEP:g} s does, so look at that parameter, and at the mass of the part"
    )
    raise ConfigurationError(
        f"solver.timestep: found {found:g} s, {culprit}; {mend}; the reduced engine does not depend on this step"
    )


class _Judge:
    """Poles of a car with dampers stuck and sliding, against which steps are judged.

    Args:
        car, matrices: the car.
    """

    def __init__(self, car: CarModel, matrices: CarMatrices) -> None:
        self.car, self.matrices = car, matrices
        self.forms = {stuck: first_order(matrices.system, stuck=stuck) for stuck in (True, False)}
        self.poles, self.shapes = np.linalg.eig(self.forms[False].state)
        require_stable(car, matrices, self.poles)
        self.stuck_poles = np.linalg.eigvals(self.forms[True].state)
        self.names = list(matrices.system.outputs)

    def worst(self, step: float) -> Fault | None:
        """What is worst at a step [s]; None where the step does."""
        rows = step_rows(self.car, self.matrices, step)
        found = self._steep(rows, step)
        for stuck, form in self.forms.items():
            made = step_map(rows, form)
            values = np.linalg.eigvals(made.matrix).astype(complex)
            found += self._growing(values, made.matrix, form, step) or self._poles(values, step, stuck)
        return max(found, key=lambda fault: fault.severity, default=None) or self._ringing(made, step)

    def _steep(self, rows: StepRows, step: float) -> list[Fault]:
        """The law over displacement with a piece that is too steep for a step."""
        bends = [bend for bend in self.matrices.bends if bend.steeper > 0.0]
        if not bends:
            return []
        basis = self.forms[False].basis
        along = np.array([bend.row for bend in bends])
        moved = basis @ np.linalg.solve(basis.T @ rows.mass @ basis, basis.T @ along.T)  # (n, bends)
        speeds = np.sqrt([bend.steeper for bend in bends] * np.sum(along * moved.T, axis=1))
        worst = int(np.argmax(speeds))
        angle = float(speeds[worst]) * step
        if angle <= STEEP_LIMIT:
            return []
        words = (
            "at which the integration is unstable"
            if angle >= 2.0
            else "at which a vibration on a piece of a table is "
            f"{100.0 * (2.0 * np.arcsin(angle / 2.0) / angle - 1.0):.0f} % high"
        )
        held = f"{bends[worst].name}, up to {bends[worst].steeper:.3g} N/m steeper than where the car stands"
        severity = angle / STEEP_LIMIT
        shape = moved[:, worst].astype(np.complex128)
        return [Fault(words=words, severity=severity, pole=1j * speeds[worst], shape=shape, held=held)]

    def _shape(self, matrix: Vector, value: complex, form: FirstOrder) -> Complex:
        """Displacements of the eigenvector of a value, by one step of inverse iteration."""
        shifted = matrix - value * (1.0 + 1e-10) * np.eye(len(matrix))
        start = np.random.default_rng(0).standard_normal(len(matrix))
        return form.shape(np.linalg.solve(shifted, start))

    def _growing(self, values: Complex, matrix: Vector, form: FirstOrder, step: float) -> list[Fault]:
        """The motion that grows fastest from step to step."""
        index = int(np.argmax(np.abs(values)))
        growth = float(abs(values[index]))
        if growth <= 1.0 + 1e-6:  # round-off of close eigenvalues
            return []
        shape = self._shape(matrix, values[index], form)
        pole = complex(np.log(complex(values[index])) / step)
        return [Fault(words="at which the integration is unstable", severity=1e6 * growth, pole=pole, shape=shape)]

    def _poles(self, values: Complex, step: float, stuck: bool) -> list[Fault]:
        """The pole up to 100 Hz whose peak is farthest off."""
        poles = self.stuck_poles if stuck else self.poles
        kept = poles[poles.imag >= 0.0]
        # What a step forgets at once, z = 0, stands for no pole.
        lasting = values[(values.imag >= 0.0) & (np.abs(values) > 1e-12)]
        exact, made = kept.astype(complex), np.log(lasting.astype(complex)) / step
        away = np.minimum(np.abs(exact[:, None] - made) / np.abs(exact)[:, None], 1e3)
        row, column = scipy.optimize.linear_sum_assignment(away)
        least = LEAST_DAMPING * np.abs(exact[row])
        error = np.abs(made[column] - exact[row]) / np.maximum(np.abs(exact[row].real), least)
        error[np.abs(exact[row]) > HIGHEST_POLE] = 0.0
        worst = int(np.argmax(error))
        if error[worst] <= POLE_LIMIT:
            return []
        pole = complex(exact[row[worst]])
        words = (
            f"at which the peak of a {'vibration' if pole.imag else 'creeping motion'} of the car is "
            f"{100.0 * error[worst]:.0f} % off, allowed are {100.0 * POLE_LIMIT:g} %"
        )
        severity = float(error[worst]) / POLE_LIMIT
        form = self.forms[stuck]
        return [Fault(words=words, severity=severity, pole=pole, shape=self._shape(form.state, pole, form))]

    def _ringing(self, made: StepMap, step: float) -> Fault | None:
        """The acceleration whose ringing after a step of friction is farthest off; the map is that of sliding."""
        values, vectors = np.linalg.eig(made.matrix)
        form = self.forms[False]
        velocity = slice(form.placed, 2 * form.placed)
        places = np.array([form.output(name)[0] for name in self.names])
        poles, shapes = self.poles, self.shapes
        # a(t) = sum_i r_i exp(s_i t), and of the map r_i z_i^n.
        exact = _residues(places @ shapes[velocity], np.linalg.solve(shapes, form.friction))
        stepped = _residues(places @ vectors[velocity], np.linalg.solve(vectors, made.load) / step)
        faded, shrunk = poles - FADING, values * np.exp(-FADING * step)
        weight = -1.0 / (faded[:, None] + faded.conj())
        wanted = _norm(exact, weight)
        error = _norm(stepped, step / (1.0 - shrunk[:, None] * shrunk.conj())) / wanted - 1.0
        worst = int(np.argmax(np.abs(error)))
        if abs(error[worst]) <= LOCAL_LIMIT:
            return None
        # The motion that carries most of it, among those that a step resolves badly.
        share = np.sum(np.abs(exact[worst]) ** 2, axis=0) * np.diag(weight).real * (np.abs(poles) > HIGHEST_POLE)
        index = int(np.argmax(share))
        words = (
            f"at which the ringing of {self.names[worst]} after the damper breaks away is "
            f"{100.0 * error[worst]:+.0f} % off, allowed are {100.0 * LOCAL_LIMIT:g} %"
        )
        severity = float(abs(error[worst])) / LOCAL_LIMIT
        return Fault(words=words, severity=severity, pole=complex(poles[index]), shape=form.shape(shapes[:, index]))


def _residues(outputs: npt.NDArray[Any], inputs: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Products of every output (outputs, p) with every input (p, 2); (outputs, 2, p)."""
    return np.asarray(outputs[:, None] * inputs.T, dtype=complex)


def _norm(residues: npt.NDArray[Any], weight: npt.NDArray[Any]) -> Vector:
    """sqrt(sum_ij r_i w_ij r_j*) of each output over both dampers; residues (outputs, 2, p)."""
    return np.asarray(np.sqrt(np.sum((residues @ weight * residues.conj()).real, axis=(1, 2))))
