"""Factors of a car: time-step factors of the integrated poles, and weights of the outputs.

With y = xi - kappa z, kappa = -b_z/s, and r = b_c + b_z/s, a step h with a quadratic z', given by its ends and its mean
m, gives

    y+ = E y + r ((M0 - 4 M1 + 3 M2) z' + (3 M2 - 2 M1) z'+ + 6 (M1 - M2) m) + e (M0 f + (M1 - M0/2) slope)

with the moments M_j of the exponential. eta = y - r (3 M2 - 2 M1) z' depends only on the beginning of a step. The
moments are phi functions (Hochbruck and Ostermann, Acta Numerica 2010, eq. 2.10):
int_0^1 exp(x (1 - t)) t^j dt = j! phi_{j+1}(x), phi_{k+1}(x) = (phi_k(x) - 1/k!)/x.

A pole near zero has no static value: kappa = 0, and z at the beginning of the step is an input. With the integral of
the quadratic z' over the step, b_z z gives b_z (M0 z + h ((M1 - 2 M2 + M3) z' + (M3 - M2) z'+ + (3 M2 - 2 M3) m)).

In single precision, fast poles are quasi-static, y = -(r z' + e f)/s, and not integrated. The set of fast poles is
chosen so that their total delay is at most `DELAY` of any response of a damper velocity or an acceleration at the end
of the band that the step resolves. The criterion uses the total, because poles occur in clusters whose residues cancel.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import factorial

import numpy as np

from vehicle.arrays import Complex, Indices, Mask, Vector
from vehicle.engines.linear.damper_elements import SliderElements, no_sliders
from vehicle.engines.linear.displacement_laws import DisplacementLaw
from vehicle.engines.reduced.phi_functions import phi_functions
from vehicle.engines.reduced.pole_model import Outputs, PoleModel

DELAY = 5e-4
"""Maximum error of a response at the end of the band, over its RMS in the band, due to all quasi-static poles.

The error grows with the frequency, so the RMS of an output on a road with white z' is wrong by at most about
DELAY/sqrt(3), 0.03 %. The value is a choice: for 100 modified cars, comfort changes by less than 0.002 % from 5e-5 to
5e-3."""

STEPS_A_PERIOD = 20
"""Steps in a period of the highest frequency that a step resolves: 100 Hz at 0.5 ms."""

LINES = np.array([0.2, 0.4, 0.7, 1.0])
"""Relative frequencies in the band at which the RMS of a response is computed."""

LARGEST_COUPLING = 0.01
"""Maximum coupling rho in single precision: total effect of the other dampers on a damper, over its effect on itself.

The change of a force is at most the change of its input, so an iteration reduces the largest error of a force,
initially its change in the step, by rho. Two iterations leave rho^2, and rho^3 with two dampers (Gauss-Seidel): 1e-6,
the round-off of sums in single precision."""

ACCURACY = 1e-8
"""Error of a force over its change in the step, at which the iteration ends in double precision.

A hundred-thousandth of the error of the step; 1e-9 would cost `focus_road` with rubber friction a fifth of its time."""

SINGLE_ACCURACY, SINGLE_ITERATIONS = 1e-6, 12
"""The same in single precision for cars with laws over displacement, the round-off of its sums, and the maximum number
of iterations: a bump stop acts along its damper, so that each changes the force of the other."""

ITERATIONS = 2, 60
"""Minimum and maximum number of iterations. For rho above 1, too, the iteration converges: it minimises a convex
function by one coordinate at a time, because the gains are symmetric and positive."""

SLOWEST = 1e-2
"""Minimum |s| [rad/s] of a pole that can be integrated as a difference from its static value."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarFactors:
    """Factors of a car for a time step.

    Attributes:
        columns: indices of the driven plates; (m - l,).
        lines: number l of histories of the applied forces, inputs like z' of a plate; m counts both.
        integrated: indices of the integrated poles, p pairs and q real poles; (p + q,).
        pairs: p.
        plate_inputs: number of plates whose z is an input; m for a car with slow poles, else 0.
        step: E - 1 and factors of mean damper forces, their slopes, mean forces of scalar elements, z', mean z', slope
            forces and z for the integrated poles; (p + q, 1 + 2 d + g + 2 m + ...).
        direct: contributions of mean forces, their slopes, forces of scalar elements, z' and z to eta of all poles;
            (n, 2 d + g + 2 m).
        slip: rows of the damper velocities; (d, n).
        gains: contributions of z', mean forces and slopes to the damper velocities and to the displacements of the
            scalar elements; (d + g, m), (d + g, d + g), (d + g, d).
        strokes: rows of these displacements; (g, n). levels: contributions of z to them; (g, m).
        steepness: smallest and largest slopes of the mean force of a step, over velocity for a damper, over
            displacement for a scalar element; (2, d + g).
        sliders: numbers of the Jenkins elements.
        laws: nonlinear laws over displacement, the last scalar elements.
    """

    columns: list[int]
    lines: int
    integrated: Indices
    pairs: int
    plate_inputs: int
    step: Complex
    direct: Complex
    slip: Complex
    gains: tuple[Vector, Vector, Vector]
    strokes: Complex = field(default_factory=lambda: np.zeros((0, 0), dtype=np.complex128))
    levels: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    steepness: Vector = field(default_factory=lambda: np.array([[0.0], [np.inf]]))
    sliders: SliderElements = field(default_factory=no_sliders)
    laws: tuple[DisplacementLaw, ...] = ()

    @property
    def reals(self) -> int:
        """Return the number q of integrated real poles."""
        return len(self.integrated) - self.pairs

    @property
    def states(self) -> int:
        """Return the number 2 p + q of states."""
        return self.pairs + len(self.integrated)

    @property
    def coupling(self) -> float:
        """Return the largest total effect of other forces on a force, over the effect of the force on itself [-]."""
        return float(np.max(self._effects.sum(axis=1) - 1.0, initial=0.0))

    @property
    def _effects(self) -> Vector:
        """Return the largest change of each force over the change of another; 1 on the diagonal."""
        (lowest, highest), gain = self.steepness, np.abs(self.gains[1])
        diagonal, stiff = np.diag(gain), np.isinf(highest)
        highest = np.where(stiff, 0.0, highest)
        # With x + G F(x) = w a force of slope k over x has the slope k/(1 + G k) over w, also for k < 0.
        slope = np.maximum(highest / (1.0 + diagonal * highest), -lowest / (1.0 + diagonal * lowest))
        # A vertical line, as of friction: the force changes by 1/G so that the displacement does not.
        effects = np.where(stiff, 1.0 / diagonal, slope)[:, None] * gain
        # A force that is zero at every velocity does not change.
        effects = np.where(stiff | (highest > 0.0) | (lowest < 0.0), effects, 0.0)
        np.fill_diagonal(effects, 1.0)
        return np.asarray(effects)

    @property
    def iterations(self) -> int:
        """Return the number of Gauss-Seidel iterations over the forces in double precision; it leaves `ACCURACY`."""
        return self._iterations_to(ACCURACY)

    @property
    def single_iterations(self) -> int:
        """Return the number of iterations in single precision; 0 for a car that needs double precision."""
        if self.coupling <= LARGEST_COUPLING:
            return ITERATIONS[0]
        count = self._iterations_to(SINGLE_ACCURACY) if self.laws else ITERATIONS[1]
        return count if count <= SINGLE_ITERATIONS else 0

    def _iterations_to(self, accuracy: float) -> int:
        """Return the number of iterations that leaves an error of the forces over their change in the step.

        The change of a force is at most that of its input over the gain, whatever its law, and less if its law has no
        steep part, so the iteration of the linear equations with the absolute values of the gains is a bound. Laws over
        displacement come first, then dampers: a law changes the force of a damper that sticks, but hardly the reverse.
        """
        # Laws over displacement are the last rows and the first unknowns.
        order = np.roll(np.arange(len(self._effects)), len(self.laws))
        effects, count = self._effects[np.ix_(order, order)], 0
        # Gauss-Seidel of (L + U) f = b: an error e becomes -L^-1 U e, with absolute values at most L^-1 |U| e.
        error, iteration = np.ones(len(effects)), np.linalg.solve(np.tril(effects), np.triu(effects, 1))
        while count < ITERATIONS[0] or (np.max(error, initial=0.0) > accuracy and count < ITERATIONS[1]):
            error, count = iteration @ error, count + 1
        return count

    def start(self, displacements: Vector, rates: Vector) -> tuple[Complex, Vector]:
        """Return the initial states of a car at rest, of pairs and of real poles.

        Args:
            displacements, rates: z and z' of the driven plates at the first instant; (m,) each.
        """
        # At rest xi = eta + direct (..., z', z) = 0.
        eta = -self.direct[self.integrated, -2 * len(rates) :] @ np.append(rates, displacements)
        return eta[: self.pairs], eta[self.pairs :].real

    def rows(self, sensors: Complex) -> tuple[Vector, Vector, Vector, Vector]:
        """Return the rows of the pairs and of the real poles for the tables of the core.

        Args:
            sensors: rows of sensors over the poles; (s, n).

        Returns:
            E - 1 and inputs, (pairs, ...) with real and imaginary parts, and (reals, ...); then damper velocities,
            displacements of scalar elements and sensors over the states, (pairs, 2, ...) and (reals, ...).
        """
        strokes = self.strokes.reshape(-1, self.slip.shape[1])
        sums, p = np.concatenate([self.slip, strokes, sensors])[:, self.integrated].T, self.pairs
        # Re(a xi) = Re a Re xi - Im a Im xi: hence the sign of the imaginary weights.
        change, inputs = self.step[:p, :1], self.step[:p, 1:]
        pairs = np.hstack([change.real, change.imag, inputs.real, inputs.imag])
        return pairs, self.step[p:].real, np.stack([sums[:p].real, -sums[:p].imag], axis=1), sums[p:].real

    def weights(self, rows: Complex) -> Vector:
        """Return the weights of states and `direct` terms, in that order, in Re(rows xi); (k, 2p + q + 2d + g + 2m).

        Args:
            rows: rows over the poles; (k, n).
        """
        integrated_rows, p = rows[:, self.integrated].conj(), self.pairs
        # Likewise: the conjugate has the weights (Re a, -Im a).
        pairs = np.ascontiguousarray(integrated_rows[:, :p]).view(np.float64)
        return np.hstack([pairs, integrated_rows[:, p:].real, (rows @ self.direct).real])

    def weights_of(self, outputs: Outputs) -> Vector:
        """Return the weights of linear outputs, with their direct terms of the plates."""
        weights, plates = self.weights(outputs.poles), len(self.columns)
        rate_weights, height_weights = np.hsplit(weights[:, -2 * (plates + self.lines) :], 2)
        rate_weights[:, :plates] += outputs.velocity[:, self.columns]
        height_weights[:, :plates] += outputs.height[:, self.columns]
        return weights


def car_factors(
    models: Sequence[PoleModel], timestep: float, columns: Sequence[int], *, exact: bool, present_load: bool = False
) -> list[CarFactors]:
    """Compute the factors of cars with equal numbers of dampers.

    Args:
        models: pole models of the cars.
        timestep: h [s].
        columns: indices of the driven plates.
        exact: all poles are integrated, for double precision.
        present_load: slope forces of rolling tyres are inputs.
    """
    if not models:
        return []
    h, driven = timestep, list(columns)
    plates, lines = len(driven), models[0].applied.shape[1]
    m, d, g = plates + lines, models[0].force.shape[1], models[0].scalar_force.shape[1]
    inputs_of_cars = [_Inputs(model, driven, None if exact else h) for model in models]
    # Compute the integrated poles of all cars at once.
    s, inputs, held, slope = (
        np.concatenate([getattr(car_inputs, name)[car_inputs.integrated] for car_inputs in inputs_of_cars])
        for name in ("poles", "both", "held", "slope")
    )
    residue, force, s = inputs[:, :m], inputs[:, m:], s[:, None]
    phi = phi_functions(np.asarray(s * h, dtype=np.complex128), 4 if exact else 3)
    # M_j = int_0^h exp(s (h - t)) (t/h)^j dt = h j! phi_{j+1}(s h).
    m0, m1, m2, *cubic = (h * factorial(j) * moment for j, moment in enumerate(phi))
    decay, ahead = np.exp(s * h), residue * (3.0 * m2 - 2.0 * m1)
    # Weights of the three quadratics over the step that have unit z' at its beginning, its end, and as its mean.
    plate, mean, extra = residue * (m0 - 4.0 * m1 + 3.0 * m2), residue * 6.0 * (m1 - m2), []
    if present_load:
        extra.append(slope * m0)
    # Near-zero poles have b_z z in place of kappa: z' integrated over the step, a cubic.
    for m3 in cubic if np.any(held) else []:
        ahead = ahead + held * h * (m3 - m2)
        plate, mean = plate + held * h * (m1 - 2.0 * m2 + m3), mean + held * h * (3.0 * m2 - 2.0 * m3)
        extra.append(held * m0)
    # y = eta + direct (f, slopes, g, z'), all at the end of a step, and eta+ = E y + plate z' + mean m: what a step
    # knows at its beginning is in eta, and its end is added when the forces are solved.
    direct = np.hstack([force[:, :d] * m0, force[:, :d] * (m1 - 0.5 * m0), force[:, d:] * m0, ahead])
    # eta+ = E (eta + direct ...) + ...: hence E times the direct terms. E - 1 instead of E, because the core adds
    # changes.
    step = np.hstack([np.expm1(s * h), decay * direct[:, : 2 * d + g], plate + decay * ahead, mean, *extra])
    factors_of_cars, first = [], 0
    for model, car_inputs in zip(models, inputs_of_cars, strict=True):
        part = slice(first, first + len(car_inputs.integrated))
        first = part.stop
        # The other poles are quasi-static.
        quasi_static = car_inputs.both / -np.where(car_inputs.slow, 1.0, car_inputs.poles)[:, None]
        rates, damper_forces, slider_forces = np.split(quasi_static, [m, m + d], axis=1)
        # A force f + slope (t/h - 1/2) ends at f + slope/2.
        direct_factors = np.hstack([damper_forces, 0.5 * damper_forces, slider_forces, rates, car_inputs.static])
        direct_factors[car_inputs.integrated, :-m] = direct[part]
        scalars = model.scalar_rows
        rows = np.concatenate([model.slip, scalars.poles])
        mean_force, ramp, mean_slider, rate, level = np.split(
            (rows @ direct_factors).real, np.cumsum([d, d, g, m]), axis=1
        )
        # A tyre is compressed by its plate, too: x = d + tau d' over z + tau z'.
        rate[d:, :plates] += scalars.velocity[:, driven]
        level[d:, :plates] += scalars.height[:, driven]
        factors_of_cars.append(
            CarFactors(
                columns=driven,
                lines=lines,
                integrated=car_inputs.integrated,
                pairs=int(np.count_nonzero(car_inputs.integrated < model.pairs)),
                plate_inputs=m * bool(np.any(held)),
                step=step[part],
                direct=direct_factors,
                slip=model.slip,
                gains=(rate, np.hstack([mean_force, mean_slider]), ramp),
                strokes=rows[d:],
                levels=level[d:],
                steepness=_steepness(model),
                sliders=model.matrices.sliders if model.groups else no_sliders(),
                laws=model.laws,
            )
        )
    return factors_of_cars


def _steepness(model: PoleModel) -> Vector:
    """Return smallest and largest slopes of the mean forces of a step, dampers and scalar elements; (2, d + g)."""
    stiff, d = np.full(model.force.shape[1], np.inf), model.force.shape[1]
    if not model.scalar_force.size:
        return np.stack([np.zeros(d), stiff])
    sliders = model.matrices.sliders
    slopes = 0.5 * np.array([law.slopes for law in model.laws]).reshape(-1, 2)
    groups = 0.5 * sliders.stiffness.sum(axis=1)
    dampers = sliders.steepness if len(groups) else stiff
    return np.stack(
        [np.concatenate([np.zeros(d + len(groups)), slopes[:, 0]]), np.concatenate([dampers, groups, slopes[:, 1]])]
    )


class _Inputs:
    """Inputs of the poles of a car, and the set of integrated poles: all without a time step.

    Attributes:
        poles: poles s; (n,).
        slow: mask of the poles without a static value; (n,).
        static: kappa, zero for applied forces; (n, m).
        held: b_z of the slow poles, likewise; (n, m).
        both: residues r of z' of the driven plates and of applied forces, and e of the forces; (n, m + d + g).
        slope: residues of the slope forces of rolling tyres; (n, plates) or (n, 0).
        integrated: indices of the integrated poles.
    """

    def __init__(self, model: PoleModel, columns: list[int], timestep: float | None) -> None:
        self.poles, height = model.poles, np.hstack([model.height[:, columns], np.zeros_like(model.applied)])
        self.slow = np.abs(model.poles) < SLOWEST
        slow = self.slow[:, None]
        self.static = np.where(slow, 0.0, -height / np.where(slow, 1.0, model.poles[:, None]))
        self.held = np.where(slow, height, 0.0)
        rates = np.hstack([model.velocity[:, columns], model.applied]) - self.static
        self.both = np.hstack([rates, model.force, model.scalar_force])
        self.slope = model.slope[:, columns] if model.slope.shape[1] else model.slope
        self.integrated = np.arange(len(self.poles))
        if timestep is not None:
            self.integrated = np.flatnonzero(_integrated(model, self.both, timestep))


def _integrated(model: PoleModel, inputs: Complex, timestep: float) -> Mask:
    """Return a mask of the poles that are integrated, True for an integrated pole.

    `inputs` are the residues of z' of the driven plates and of the forces; (n, m + d + g).
    """
    system, s, n = model.matrices.system, model.poles, len(model.poles)
    positions = np.array([row[: system.size] for row in system.outputs.values()]).reshape(-1, system.size)
    # Damper velocities, and displacements of the acceleration channels.
    shapes = np.ascontiguousarray(model.modal).view(np.float64)
    rows = np.concatenate([model.slip, (positions @ shapes).view(np.complex128)])
    # An acceleration grows with the square of the frequency over its displacement.
    derivative = np.where(np.arange(len(rows)) < len(model.slip), 0, 2)[:, None, None]
    # A pole represents its conjugate, whose contribution at a line is the conjugate of that of the pole at minus the
    # line.
    band = 2j * np.pi / (STEPS_A_PERIOD * timestep)
    lines = band * np.concatenate([LINES, -LINES])
    shares = rows @ (inputs[:, :, None] / (lines - s[:, None])[:, None, :]).reshape(n, -1)
    shares = shares.reshape(len(rows), -1, 2, len(LINES))
    response = (shares[:, :, 0] + shares[:, :, 1].conj()) * LINES**derivative
    rms = np.sqrt(np.mean(_squares(response), axis=2)) + np.finfo(float).tiny
    # Poles within the band are always integrated.
    fast_candidates, is_integrated = np.flatnonzero(np.abs(s) > abs(band)), np.ones(n, dtype=bool)
    if not fast_candidates.size:
        return is_integrated
    s = s[fast_candidates][:, None]
    # (poles, inputs, rows): residues over the RMS of each response.
    products = (
        np.ascontiguousarray(rows.T[fast_candidates])[:, None] * (inputs[fast_candidates][:, :, None] / rms.T)
    ).reshape(len(s), -1)
    # Error at the end of the band: 1/(jw - s) + 1/s = jw/(s (jw - s)), and the same of the conjugate pole.
    delay = products * (band / (s * (band - s))) + (products * (band / (s * (band + s)))).conj()
    # From the smallest delay on, the longest run of poles whose total, with its cancellations, stays below the limit.
    sequence = np.argsort(np.max(_squares(delay), axis=1), kind="stable")
    total_delay = np.max(_squares(np.cumsum(delay[sequence], axis=0)), axis=1)
    negligible = np.flatnonzero(total_delay <= DELAY**2)
    is_integrated[fast_candidates[sequence[: negligible[-1] + 1 if negligible.size else 0]]] = False
    return is_integrated


def _squares(numbers: Complex) -> Vector:
    """Return squares of magnitudes."""
    return np.asarray(numbers.real**2 + numbers.imag**2)
