"""Fit of a law of a damper to all tests together, with the standard errors of its parameters.

    minimise  sum over tests of mean over time of (F_law - F)^2 / var(F),

(in a test with velocity steps: of the means over each of its strokes), over the logarithms of the parameters (F_0 and
k_g: over the parameter itself). The law is chosen in `damper_choice`.

The standard errors are from White's estimator with blocks of a cycle (residuals within a block may be correlated in
any way), or of independent residuals of equal size in each test where these are larger:

    cov = H^-1 (sum over blocks of g_b g_b') H^-1 B/(B - 1),   H = J'J,   g_b = J_b' r_b.

A positive parameter has the standard deviation 1 of its logarithm before the tests.

Source of the blocks: Liang and Zeger, Biometrika 73 (1986).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy

from vehicle.arrays import Mask, Vector
from vehicle.studies.dampers.damper_force import force_and_slopes
from vehicle.studies.dampers.damper_law import FIRM, LINEAR, DamperLaw, plain_parameters, sums_of
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.joint_tests import joint

DETERMINED = 0.5
"""Maximum relative standard error of a parameter that the tests determine."""

TRACE = 1.28
"""Standard errors of an upper limit in nine of ten cases (normal distribution)."""

LARGEST = 1e6
"""Largest square of an error over the standard deviation of the force; larger or infinite errors count as this."""

RANGES = {
    "damping": (1.0, 1e6),
    "velocity": (1e-3, 5.0),  # a bend below is friction
    "friction": (0.1, 1e5),
    "friction_at_rest": (0.1, 1e5),
    "stribeck_velocity": (5e-4, 1.0),
    "slider_limit": (0.1, 1e5),
    "slider_stroke": (5e-6, 0.05),
    "gas_stiffness": (0.0, 1e6),
    "series_stiffness": (1e4, 1e9),
    "gap": (1e-5, 0.1),
    "outer_friction": (0.1, 1e5),
    "gas_force": (-1e5, 1e5),
    "lag": (1e-4, 10.0),
    "saturation": (0.05, 20.0),
    "delay": (0.0, 0.2),
}
"""Ranges of the parameters in SI units, within the ranges of the vehicle file."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DamperFit:
    """A law fitted to tests."""

    law: DamperLaw  # parts of the law
    parameters: Vector  # in the order of `law.parameters`, SI units, velocities as widths of segments; (p,)
    errors: Vector = field(default_factory=lambda: np.zeros(0))  # standard errors of `values`; (p,)
    # RMS error over the standard deviation of the force, settled part of each test by its weights; (tests,)
    fitted: Vector = field(default_factory=lambda: np.zeros(0))
    whole: Vector = field(default_factory=lambda: np.zeros(0))  # error over all samples of the record; (tests,)
    # the same of the settled part of each test, by the fits without that test; NaN if not computed
    left_out: Vector = field(default_factory=lambda: np.zeros(0))
    # covariances of `parameters`, from correlated and from independent residuals; (2, p, p)
    spreads: Vector = field(default_factory=lambda: np.zeros((2, 0, 0)))
    # mean squares of the errors left out and of `FLOOR`, by blocks of each test; (tests, blocks)
    blocks: Vector = field(default_factory=lambda: np.ones((0, 1)))
    accepted: bool = False  # True for a law within the tolerance of the choice
    tolerance: float = np.nan  # of the logarithm of the error left out, in the choice of this law
    # errors of ranges that the fit does not contain, see `damper_choice.range_errors`: range to (tests,)
    ranges: Mapping[str, Vector] = field(default_factory=dict)
    # upper limit of the RMS of the systematic part of the residuals, over the standard deviation of the force
    systematic: float = np.inf
    # mean squares by which the accepted laws differ below the tests, by octaves; see `damper_ranges.law_differences`
    differences: Vector = field(default_factory=lambda: np.zeros(1))
    half_of: DamperLaw | None = None  # law with a changing setting, of which this is the soft or the firm one

    @property
    def left_out_error(self) -> float:
        """Geometric mean of the RMS errors left out and `FLOOR`, over the standard deviation of the force."""
        return float(np.exp(np.mean(self.logarithms)))

    @property
    def further(self) -> Vector:
        """Return the errors of whole tests left out; NaN with a single test; (tests,).

        With two tests these are the errors in each by the fit to the other: parts of a record left out are inside what
        the fit has seen. Ranges are compared with means over parts of a cycle, `thinned`: the difference of the squares
        is the part of the fit to the other; the error of the fit has the noise of single samples.
        """
        if "other" not in self.ranges:
            return self.left_out
        without, within = self.ranges["other"]
        return np.asarray(np.sqrt(self.fitted**2 + np.maximum(without**2 - within**2, 0.0)))

    @property
    def logarithms(self) -> Vector:
        """Return the logarithms of the RMS errors of each test left out and `FLOOR`; (tests,)."""
        return np.asarray(0.5 * np.log(np.mean(self.blocks, axis=1)))

    @property
    def tested_law(self) -> DamperLaw:
        """The law that was compared: with its changing setting, if it has one."""
        return self.half_of or self.law

    @property
    def values(self) -> Vector:
        """Parameters with the velocities of breakpoints; (p,)."""
        return plain_parameters(self.law, self.parameters)

    def at_setting(self, firm: bool) -> DamperFit:
        """Return the soft or the firm law of a damper whose setting changes during the tests, with the same errors."""
        half = self.law.halves[firm]
        plain = dataclasses.replace(self, law=self.law.passive, half_of=self.law, parameters=self.parameters[half])
        if not self.errors.size:
            return plain
        return dataclasses.replace(plain, errors=self.errors[half], spreads=self.spreads[:, half][:, :, half])

    @property
    def determined(self) -> Mask:
        """True for parameters with a relative standard error of at most `DETERMINED`; (p,)."""
        return np.asarray(self.errors <= DETERMINED * np.abs(self.values))

    def force(self, test: DamperTest) -> Vector:
        """Return the force of the law under the motion of a test [N]; (n,)."""
        return force_and_slopes(self.law, self.parameters, test.motion)[0]


def kind_of(name: str) -> str:
    """Return the name of a parameter without setting, side and number, a key of `RANGES`."""
    return name.removeprefix(FIRM).removeprefix("rebound_").removeprefix("bump_").rstrip("0123456789").rstrip("_")


def limits_of(law: DamperLaw) -> tuple[Vector, Vector]:
    """Return the lowest and highest values of the parameters of a law, in their order; both (p,)."""
    low, high = np.array([RANGES[kind_of(name)] for name in law.parameters]).T
    return low, high


def fit_law(tests: Sequence[DamperTest], law: DamperLaw, starts: Sequence[Vector],
            masks: Sequence[Mask] | None = None, evaluations: int = 40, tolerance: float = 1e-4) -> Vector:  # fmt: skip
    """Return the parameters of the least squares fit, the best of all starts; (p,).

    Args:
        starts: start values in the order of `law.parameters`.
        masks: samples of each test that are fitted; the settled samples by default.
        evaluations: maximum number of evaluations of a start.
        tolerance: relative change of cost and parameters at which a fit ends.
    """
    group = joint(tests)
    chosen = [test.settled for test in tests] if masks is None else masks
    used = np.concatenate(chosen)
    measured = np.concatenate([test.force for test in tests])[used]
    weight = np.concatenate([np.sqrt(test.weights[mask] / np.sum(test.weights[mask])) / test.scale
                             for test, mask in zip(tests, chosen, strict=True) if mask.any()])  # fmt: skip
    linear = np.array([name in LINEAR for name in law.parameters])
    scale = np.array([LINEAR.get(name, 1.0) for name in law.parameters])
    low, high = limits_of(law)

    def internal(values: Vector) -> Vector:
        return np.where(linear, values / scale, np.log(np.where(linear, 1.0, values)))

    def plain(inner: Vector) -> Vector:
        return np.where(linear, inner * scale, np.exp(np.where(linear, 0.0, inner)))

    last: dict[bytes, tuple[Vector, Vector]] = {}

    def evaluate(inner: Vector) -> tuple[Vector, Vector]:
        key = inner.tobytes()
        if key not in last:
            values = plain(inner)
            # A step of the search may overflow: the search refuses it, and takes a shorter one.
            force, slopes = group.force_and_slopes(law, values)
            columns = weight[:, None] * slopes[used] * np.where(linear, scale, values)
            # QR gives few rows with the same sum of squares, slopes and curvature.
            both = np.column_stack([columns, weight * (force[used] - measured)])
            triangle = np.asarray(np.linalg.qr(both, mode="r"))
            last.clear()
            last[key] = triangle[:, -1], triangle[:, :-1]
        return last[key]

    bounds = internal(low), internal(high)

    def search(begin: Vector) -> scipy.optimize.OptimizeResult:
        return scipy.optimize.least_squares(
            lambda inner: evaluate(inner)[0], np.clip(begin, bounds[0] + 1e-6, bounds[1] - 1e-6),
            lambda inner: evaluate(inner)[1], bounds=bounds, max_nfev=evaluations, x_scale=0.3, ftol=tolerance,
            xtol=tolerance,
        )  # fmt: skip

    results = [search(internal(np.clip(start, low, high))) for start in starts]
    return plain(min(results, key=lambda each: float(each.cost)).x)


def squares_of(tests: Sequence[DamperTest], law: DamperLaw, parameters: Vector) -> list[Vector]:
    """Return the squares of the errors of a law over the variance of the force in each test, at most `LARGEST`."""
    group = joint(tests)
    squares = []
    for test, force in zip(group, group.split(group.force_and_slopes(law, parameters)[0]), strict=True):
        with np.errstate(over="ignore", invalid="ignore"):
            squares.append(np.minimum(np.nan_to_num(((force - test.force) / test.scale) ** 2, nan=LARGEST), LARGEST))
    return squares


def fitted_squares(tests: Sequence[DamperTest], law: DamperLaw, parameters: Vector) -> Vector:
    """Return the weighted mean square of the error over the settled samples of each test, as in `squares_of`."""
    squares = squares_of(tests, law, parameters)
    return np.array(
        [np.average(e[t.settled], weights=t.weights[t.settled]) for e, t in zip(squares, tests, strict=True)]
    )


def finished(tests: Sequence[DamperTest], fit: DamperFit) -> DamperFit:
    """Return a fit of all samples, with standard errors and the errors of each test."""
    group = joint(tests)
    parameters = fit_law(group, fit.law, [fit.parameters], tolerance=1e-7)
    forces = group.split(group.force_and_slopes(fit.law, parameters)[0])
    residuals = [(force - test.force)[test.settled] / test.scale for test, force in zip(group, forces, strict=True)]
    # Neighbours have independent noise: their mean product is the square of what they have in common. Noise alone gives
    # it the standard error mean(r^2)/sqrt(n).
    common = np.array([np.mean(each[1:] * each[:-1]) for each in residuals])
    noise = np.array([np.mean(each**2) / np.sqrt(each.size) for each in residuals])
    trace = max(float(np.mean(common)), 0.0) + TRACE * float(np.sqrt(np.sum(noise**2))) / noise.size
    spreads = covariances(group, fit.law, parameters)
    squares = squares_of(group, fit.law, parameters)
    return dataclasses.replace(
        fit, parameters=parameters, spreads=spreads, systematic=float(np.sqrt(trace)),
        errors=deviations(spreads, sums_of(fit.law)), fitted=np.sqrt(fitted_squares(group, fit.law, parameters)),
        whole=np.sqrt([np.mean(each) for each in squares]),
    )  # fmt: skip


def covariances(
    tests: Sequence[DamperTest], law: DamperLaw, parameters: Vector, masks: Sequence[Mask] | None = None
) -> Vector:
    """Return the covariances of fitted parameters, from correlated and from independent residuals; (2, p, p).

    Args:
        masks: samples of each test that were fitted; the settled samples by default.
    """
    # Columns of equal size: the parameters differ by many orders of magnitude.
    sizes = np.maximum(np.abs(parameters), [0.01 * LINEAR.get(name, 0.0) for name in law.parameters])
    scores, curvature = [], np.zeros((parameters.size,) * 2)
    noise = np.zeros_like(curvature)
    group = joint(tests)
    both = (group.split(each) for each in group.force_and_slopes(law, parameters))
    chosen = [test.settled for test in tests] if masks is None else masks
    for test, mask, force, slopes in zip(tests, chosen, *both, strict=True):
        if not mask.any():
            continue
        error = (force - test.force) / test.scale
        shares = np.where(mask, test.weights, 0.0) / np.sum(test.weights[mask])
        columns = slopes * sizes / test.scale
        curvature += columns.T @ (shares[:, None] * columns)
        noise += (shares @ error**2) * columns.T @ (shares[:, None] ** 2 * columns)
        scores += [columns[rows].T @ (shares[rows] * error[rows]) for rows in test.cycle_rows]
    inverse = np.linalg.pinv(curvature, hermitian=True, rcond=1e-12)
    middle = np.array(scores).T @ np.array(scores) * len(scores) / (len(scores) - 1)
    relative = [inverse @ each @ inverse for each in (middle, noise)]
    # Before the tests, a positive parameter is known within a factor e: larger relative errors are beyond the linear
    # propagation, and would make the force as uncertain as a parameter without effect on it.
    precision = np.diag([0.0 if name in LINEAR else 1.0 for name in law.parameters])
    prior = [
        each - each @ precision @ np.linalg.solve(precision @ each @ precision + np.eye(sizes.size), precision @ each)
        for each in relative
    ]
    return np.array([0.5 * (each + each.T) * np.outer(sizes, sizes) for each in prior])


def deviations(spreads: Vector, rows: Vector) -> Vector:
    """Return the standard errors of sums over the parameters by the larger variance of both; (n,).

    Args:
        rows: derivatives of the sums over the parameters; (n, p).
    """
    return np.asarray(np.sqrt(np.maximum(np.max(np.einsum("ij,kjl,il->ki", rows, spreads, rows), axis=0), 0.0)))


def parameter_squares(law: DamperLaw, parameters: Vector, spreads: Vector, test: DamperTest) -> Vector:
    """Return the variance of the fitted force from the covariances of the parameters, over the measured one; (n,)."""
    return (deviations(spreads, force_and_slopes(law, parameters, test.motion)[1]) / test.scale) ** 2
