"""A priori check of the MuJoCo time step: stability and discretisation error of the linearised car.

The one-step map (`vehicle.engines.linear.step_map`), with the dampers stuck and sliding, must meet three criteria, and
the laws over displacement a fourth:

- the map is stable: no eigenvalue has a magnitude above 1;
- every pole up to 100 Hz agrees with the pole of the matrices. Near resonance the response to a pole is 1/(i w - s), so
  |s_h - s| / |Re s| is the error of its peak;
- low-mass parts on stiff mounts vibrate above 100 Hz and ring when the damper breaks away or sticks. Each acceleration
  a(t) after a step of the friction force is compared by its norm, int a2 exp(-2 t/T) dt with T = 1 s, between the map
  and the matrices; both norms are sums over pairs of poles;
- the step treats the tangent of a table implicitly, but the stiffness increase dk of another segment explicitly, for
  example a bump stop. With 1/m = r N (N' M_h N)^-1 N' r', the mobility of the step along the row r, w = sqrt(dk/m)
  becomes 2 asin(w h/2)/h (leapfrog), with the stability limit w h = 2.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Complex, Vector
from vehicle.digits import number
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.car_modes import require_stable
from vehicle.engines.linear.displacement_laws import law_rows
from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.engines.linear.step_map import StepMap, StepRows, step_map, step_rows
from vehicle.engines.linear.strained_part import Strained, moving_part, parameter_text, strained_elements
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError

HIGHEST_POLE = 2.0 * np.pi * 100.0
"""Maximum |s| [rad/s] of the poles that are checked: the comfort band ends at 50 Hz, the weightings at 80."""

POLE_LIMIT = 0.10
"""Maximum error of the peak of a pole. The `focus` car has 0.02 at its vibrations and 0.05 at a real pole of 71 Hz,
where every RMS below 100 Hz is within 0.4 % of an eighth of the step; up to 0.22 it stayed within 1 %."""

MINIMUM_DAMPING = 0.01
"""Minimum damping ratio in the error of a peak, since the peak of an undamped pole is unbounded."""

LOCAL_LIMIT = 0.10
"""Maximum error of the ringing after a step of friction. Friction causes only a part of the motion: over 10 s of the
high input the RMS of the damper top was off by 2.4 % at 0.07 (the car of Bommer 2006), 5.3 % at 0.08, 10 % at 0.12, 16
% at 0.19 and 20 % at 0.31 (stiffer and stiffer suspension mounts); body, engine and knuckle stayed within 0.15 %."""

SEGMENT_LIMIT = 1.0
"""Maximum w h of a stiffer segment of a table, whose frequency is then 4.7 % high. Stops of the dampers of `focus`, hit
at 12 mm on a road of 6 mm RMS, against an eighth of the step: the vertical RMS of the damper top was off by 2 % at 0.2
(friction alone), 3 % at 0.75, 5 % at 1.2 and 31 % at 1.7, that of the seat rail by 0.05 % at most."""

ROUND_OFF = 1e-9
"""Share of the largest ringing below which an output is not compared: its rest is round-off of the eigenvectors."""

FADING = 1.0
"""Decay rate 1/T [1/s] in the norm, so that the norm of undamped ringing is finite."""

SMALLEST_STEP = 1e-5
"""Minimum step [s] that is suggested: if it is too long, a parameter of the car is wrong."""


LEFT = 0.5
"""Factor on an element that is softened to see its effect [-]."""

TRIED = 8
"""Number of the most strained parameters whose effect is tried."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepError:
    """Violated criterion of the time-step check.

    Attributes:
        message: description of the error for the user.
        severity: error over its limit.
        pole, shape: pole [rad/s] and shape (n,) of the affected motion.
        element: name of the responsible element; empty for the most strained element of the motion.
    """

    message: str
    severity: float
    pole: complex
    shape: Complex
    element: str = ""


def accurate_step(car: CarModel, matrices: CarMatrices) -> float:
    """Halve the time step of a car until it passes all criteria.

    Raises:
        ConfigurationError: the car is unstable, or fails at every step down to `SMALLEST_STEP`; the message names the
            moving part and the responsible parameter.
    """
    check, first = _StepCheck(car, matrices), float(car.model.opt.timestep)
    step = first
    while (violation := check.worst(step)) is not None:
        if 0.5 * step < SMALLEST_STEP:
            raise ConfigurationError(
                f"no time step from {first:g} s down to {number(step, 2)} s is short enough for this car: "
                f"{number(step, 2)} s, {check.cause(violation, step)}; correct this parameter, or the mass of "
                "the part, or use --engine reduced, which does not need this step"
            )
        step *= 0.5
    return step


def require_accurate_step(car: CarModel, matrices: CarMatrices) -> None:
    """Raise an error if the time step of a car is too long, and name a sufficient step.

    Raises:
        ConfigurationError: the car is unstable, or the step is too long; the message names the moving part, the
            responsible parameter and a sufficient step.
    """
    check = _StepCheck(car, matrices)
    timestep = float(car.model.opt.timestep)
    violation = check.worst(timestep)
    if violation is None:
        return
    step = timestep / 2.0
    while step >= SMALLEST_STEP and check.worst(step) is not None:
        step /= 2.0
    cause = check.cause(violation, timestep)
    remedy = (
        f"set solver.timestep={step:g}, or correct this parameter"
        if step >= SMALLEST_STEP
        else f"every step down to {SMALLEST_STEP:g} s is too long: check this parameter and the mass of the part"
    )
    raise ConfigurationError(
        f"solver.timestep: found {timestep:g} s, {cause}; {remedy}; the reduced engine does not depend on this step"
    )


class _StepCheck:
    """Time-step check of one car against its poles, with some elements, by their rows, softened to `LEFT`."""

    def __init__(self, car: CarModel, matrices: CarMatrices, softened: Sequence[int] = ()) -> None:
        self.car, self.matrices, self.softened = car, matrices, softened
        self.forms = {stuck: first_order(matrices.system, stuck=stuck) for stuck in (True, False)}
        self.poles, self.shapes = np.linalg.eig(self.forms[False].state)
        require_stable(car, matrices, self.poles)
        self.stuck_poles = np.linalg.eigvals(self.forms[True].state)
        self.names = list(matrices.system.outputs)

    def worst(self, step: float) -> StepError | None:
        """Return the most severe violation at a step [s], or None."""
        rows = step_rows(self.car, self.matrices, step, self.softened, LEFT)
        violations = self._stiff_segments(rows, step)
        for stuck, form in self.forms.items():
            one_step = step_map(rows, form)
            values = np.linalg.eigvals(one_step.matrix).astype(complex)
            violations += self._growing(values, one_step.matrix, form, step) or self._poles(values, step, stuck)
        return max(violations, key=lambda violation: violation.severity, default=None) or self._ringing(one_step, step)

    def cause(self, violation: StepError, step: float) -> str:
        """Return message, frequency, moving part and responsible parameter of a violation at a step [s].

        Of the most strained parameters, it is the parameter that, softened to `LEFT`, reduces the violation most: the
        effect of a parameter decides, not its share in the motion.
        """
        return (
            f"{violation.message} ({abs(violation.pole) / (2.0 * np.pi):.0f} Hz: "
            f"{moving_part(self.matrices, violation.shape)} moves, held by "
            f"{violation.element or self._holding(violation, step)})"
        )

    def _holding(self, violation: StepError, step: float) -> str:
        """Return path and value of the parameter with the largest effect on a violation at a step [s]."""
        strained = strained_elements(self.car, violation.pole, violation.shape)[:TRIED]
        effects = [violation.severity - self._softened_severity(element, step) for element in strained]
        return parameter_text(self.car, strained[int(np.argmax(effects))].path)

    def _softened_severity(self, element: Strained, step: float) -> float:
        """Return the severity of the worst violation with softened elements; 0 without a violation."""
        system, less, row = self.matrices.system, 1.0 - LEFT, element.rows
        effects = system.effects.copy()
        # A softer branch has a smaller force; K, C and joints follow below.
        effects[element.branches[element.branches >= 0]] *= LEFT
        softer = replace(
            system,
            stiffness=system.stiffness - less * row.T @ (element.stiffness[:, None] * row),
            damping=system.damping - less * row.T @ (element.damping[:, None] * row),
            branch_effects=effects,
        )
        constraints = element.constraints[element.constraints >= 0].tolist()
        try:
            worst = _StepCheck(self.car, replace(self.matrices, system=softer), constraints).worst(step)
        except ConfigurationError:  # without this element the car has no equilibrium
            return np.inf
        return 0.0 if worst is None else worst.severity

    def _stiff_segments(self, rows: StepRows, step: float) -> list[StepError]:
        """Return the law over displacement with a segment too stiff for the step, if any."""
        laws = [law for law in self.matrices.laws if law.stiffness_increase > 0.0]
        if not laws:
            return []
        basis = self.forms[False].basis
        directions = law_rows(laws, self.matrices.system.size)
        # Acceleration by a unit force along each law, N (N' M_h N)^-1 N' r'.
        mobility = basis @ np.linalg.solve(basis.T @ rows.mass @ basis, basis.T @ directions.T)  # (n, laws)
        # w^2 = dk r M^-1 r'.
        frequencies = np.sqrt([law.stiffness_increase for law in laws] * np.sum(directions * mobility.T, axis=1))
        worst = int(np.argmax(frequencies))
        angle = float(frequencies[worst]) * step
        if angle <= SEGMENT_LIMIT:
            return []
        message = (
            "at which the integration is unstable"
            if angle >= 2.0
            else "at which the frequency on a stiffer segment of a table is "
            f"{100.0 * (2.0 * np.arcsin(angle / 2.0) / angle - 1.0):.0f} % too high"
        )
        element = f"{laws[worst].name}, up to {laws[worst].stiffness_increase:.3g} N/m stiffer than at rest"
        severity = angle / SEGMENT_LIMIT
        shape = mobility[:, worst].astype(np.complex128)
        return [
            StepError(message=message, severity=severity, pole=1j * frequencies[worst], shape=shape, element=element)
        ]

    def _shape(self, matrix: Vector, value: complex, form: FirstOrder) -> Complex:
        """Return the displacements of the eigenvector of an eigenvalue, by one step of inverse iteration."""
        # (A - z)^-1 enlarges the eigenvector of z most; the shift keeps the matrix from being singular.
        shifted = matrix - value * (1.0 + 1e-10) * np.eye(len(matrix))
        start = np.random.default_rng(0).standard_normal(len(matrix))
        return form.shape(np.linalg.solve(shifted, start))

    def _growing(self, values: Complex, matrix: Vector, form: FirstOrder, step: float) -> list[StepError]:
        """Return the fastest growing motion of the one-step map, if any grows."""
        index = int(np.argmax(np.abs(values)))
        growth = float(abs(values[index]))
        if growth <= 1.0 + 1e-6:  # round-off of close eigenvalues
            return []
        shape = self._shape(matrix, values[index], form)
        pole = complex(np.log(complex(values[index])) / step)
        return [
            StepError(message="at which the integration is unstable", severity=1e6 * growth, pole=pole, shape=shape)
        ]

    def _poles(self, values: Complex, step: float, stuck: bool) -> list[StepError]:
        """Return the pole up to 100 Hz with the largest error of its peak, if above the limit."""
        poles = self.stuck_poles if stuck else self.poles
        upper_poles = poles[poles.imag >= 0.0]
        # Eigenvalues at z = 0 (states eliminated within one step) have no continuous counterpart.
        lasting = values[(values.imag >= 0.0) & (np.abs(values) > 1e-12)]
        exact, mapped = upper_poles.astype(complex), np.log(lasting.astype(complex)) / step
        # Pairs of exact and mapped poles with the smallest sum of relative distances; (exact, mapped).
        distance = np.minimum(np.abs(exact[:, None] - mapped) / np.abs(exact)[:, None], 1e3)
        row, column = scipy.optimize.linear_sum_assignment(distance)
        decay_floor = MINIMUM_DAMPING * np.abs(exact[row])
        # The peak of 1/(jw - s) is 1/|Re s|.
        error = np.abs(mapped[column] - exact[row]) / np.maximum(np.abs(exact[row].real), decay_floor)
        error[np.abs(exact[row]) > HIGHEST_POLE] = 0.0
        worst = int(np.argmax(error))
        if error[worst] <= POLE_LIMIT:
            return []
        pole = complex(exact[row[worst]])
        message = (
            f"at which the peak of a {'vibration' if pole.imag else 'creeping motion'} of the car is "
            f"{100.0 * error[worst]:.0f} % wrong but must be at most {100.0 * POLE_LIMIT:g} %"
        )
        severity = float(error[worst]) / POLE_LIMIT
        form = self.forms[stuck]
        return [StepError(message=message, severity=severity, pole=pole, shape=self._shape(form.state, pole, form))]

    def _ringing(self, one_step: StepMap, step: float) -> StepError | None:
        """Return the acceleration with the largest error of its ringing after a step of friction, if above the limit.

        `one_step` is the one-step map of the car with sliding dampers.
        """
        values, vectors = np.linalg.eig(one_step.matrix)
        form = self.forms[False]
        # Without cyclic motions, whose velocities are the last.
        velocity = slice(form.placed, 2 * form.placed)
        output_rows = np.array([form.output(name)[0] for name in self.names])
        poles, shapes = self.poles, self.shapes
        # a(t) = sum_i r_i exp(s_i t); for the map, sum_i r_i z_i^n.
        # After a step of the force x' = exp(A t) N: its velocity rows are accelerations. The map has (x+ - x)/h =
        # A_h^n load/h.
        exact = _residues(output_rows @ shapes[velocity], np.linalg.solve(shapes, form.friction))
        stepped = _residues(output_rows @ vectors[velocity], np.linalg.solve(vectors, one_step.load) / step)
        faded, shrunk = poles - FADING, values * np.exp(-FADING * step)
        # int exp((s_i + s_j*) t) exp(-2 t/T) dt = -1/(s_i + s_j* - 2/T); for the map the geometric series h/(1 - z_i
        # z_j*).
        weight = -1.0 / (faded[:, None] + faded.conj())
        exact_norm = _norm(exact, weight)
        stepped_norm = _norm(stepped, step / (1.0 - shrunk[:, None] * shrunk.conj()))
        # A row that friction does not move, by symmetry or for lack of dampers, is round-off without a relative error.
        moved = exact_norm > ROUND_OFF * np.max(exact_norm, initial=0.0)
        error = np.divide(stepped_norm, exact_norm, out=np.ones_like(exact_norm), where=moved) - 1.0
        worst = int(np.argmax(np.abs(error)))
        if abs(error[worst]) <= LOCAL_LIMIT:
            return None
        # Find the motion with the largest share, among those above the checked poles.
        share = np.sum(np.abs(exact[worst]) ** 2, axis=0) * np.diag(weight).real * (np.abs(poles) > HIGHEST_POLE)
        index = int(np.argmax(share))
        message = (
            f"at which the ringing of {self.names[worst]} after the damper breaks away is "
            f"{100.0 * error[worst]:+.0f} % wrong but must be at most {100.0 * LOCAL_LIMIT:g} %"
        )
        severity = float(abs(error[worst])) / LOCAL_LIMIT
        return StepError(
            message=message, severity=severity, pole=complex(poles[index]), shape=form.shape(shapes[:, index])
        )


def _residues(outputs: npt.NDArray[Any], inputs: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the products of every output (outputs, p) with every input (p, 2); (outputs, 2, p)."""
    return np.asarray(outputs[:, None] * inputs.T, dtype=complex)


def _norm(residues: npt.NDArray[Any], weight: npt.NDArray[Any]) -> Vector:
    """Return sqrt(sum_ij r_i w_ij r_j*) of each output over both dampers; residues (outputs, 2, p)."""
    return np.asarray(np.sqrt(np.sum((residues @ weight * residues.conj()).real, axis=(1, 2))))
