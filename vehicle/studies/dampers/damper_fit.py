"""Fit of the laws of dampers to all tests together, and the choice of a law on tests left out.

    minimise  sum over tests of mean over time of (F_law - F)^2 / var(F),

(in a test with velocity steps: of the means over each of its strokes), over the logarithms of the parameters (F_0 and
k_g: over the parameter itself). A law grows by one part at a time (`DamperLaw.larger`), and is pursued while its error
on tests left out falls: each candidate is fitted without one test in turn, and judged by that test. In the end the law
with the fewest parameters within one standard error of the best is chosen, by the logarithms of the ratios of their
errors, so that all tests count alike. With less than three tests, parts of the records are left out instead of tests.

The standard errors are from White's estimator with blocks of a cycle (residuals within a block may be correlated in
any way), or of independent residuals of equal size in each test where these are larger:

    cov = H^-1 (sum over blocks of g_b g_b') H^-1 B/(B - 1),   H = J'J,   g_b = J_b' r_b.

Sources: leave-one-out and the rule of one standard error: Hastie, Tibshirani, Friedman, The Elements of Statistical
Learning, 7.10; blocks: Liang and Zeger, Biometrika 73 (1986).
"""

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy

from vehicle.arrays import Mask, Vector
from vehicle.errors import DataError
from vehicle.studies.dampers.damper_force import force_and_slopes
from vehicle.studies.dampers.damper_law import LINEAR, DamperLaw, plain_parameters
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.waveform import reversals

PER_CYCLE, CYCLES = 250, 2
"""Samples of a cycle, and settled cycles of a periodic test, with which laws are compared; the chosen law has all."""

JUMP, AFTER = 0.1, 12
"""Change of the velocity in a sample, over its maximum, after which `AFTER` samples stay single; as many do before and
after a reversal."""

FEW_TESTS, PARTS = 3, 4
"""Number of tests from which on whole tests are left out, and number of parts of a record otherwise."""

FOLDS = 6
"""Maximum number of fits with tests left out; above it several tests are left out together."""

BEAM = 2
"""Number of laws that get a further part at a time."""

BLOCKS = 8
"""Blocks of a test in the comparison of two laws."""

FLOOR = 0.01
"""Error over the standard deviation of the force, added in quadrature to the error of each block: laws that describe
a damper within this are alike."""

LARGEST = 1e6
"""Largest square of an error over the standard deviation of the force; larger or infinite errors count as this."""

RELEVANT = 0.03
"""Relative difference of two errors, with `FLOOR` in them, that is a reason for a further part."""

DETERMINED = 0.5
"""Maximum relative standard error of a parameter that the tests determine."""

RANGES = {
    "damping": (1.0, 1e6),
    "velocity": (2e-4, 5.0),
    "friction": (0.1, 1e5),
    "friction_at_rest": (0.1, 1e5),
    "stribeck_velocity": (5e-4, 1.0),
    "slider_limit": (0.1, 1e5),
    "slider_stroke": (5e-6, 0.05),
    "gas_stiffness": (0.0, 1e6),
    "series_stiffness": (1e4, 1e9),
    "gas_force": (-1e5, 1e5),
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
    # mean squares of the errors left out and of `FLOOR`, by blocks; (b,)
    blocks: Vector = field(default_factory=lambda: np.zeros(0))

    @property
    def left_out_error(self) -> float:
        """Geometric mean of the RMS errors left out and `FLOOR`, over the standard deviation of the force."""
        return float(np.exp(0.5 * np.mean(np.log(self.blocks))))

    @property
    def values(self) -> Vector:
        """Parameters with the velocities of breakpoints; (p,)."""
        return plain_parameters(self.law, self.parameters)

    @property
    def determined(self) -> Mask:
        """True for parameters with a relative standard error of at most `DETERMINED`; (p,)."""
        return np.asarray(self.errors <= DETERMINED * np.abs(self.values))

    def force(self, test: DamperTest) -> Vector:
        """Return the force of the law under the motion of a test [N]; (n,)."""
        return force_and_slopes(self.law, self.parameters, test.motion)[0]


def kind_of(name: str) -> str:
    """Return the name of a parameter without side and number, a key of `RANGES`."""
    return name.removeprefix("rebound_").removeprefix("bump_").rstrip("0123456789").rstrip("_")


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
    chosen = [test.settled for test in tests] if masks is None else masks
    used = [(test, mask) for test, mask in zip(tests, chosen, strict=True) if mask.any()]
    linear = np.array([name in LINEAR for name in law.parameters])
    scale = np.array([{"gas_force": 100.0, "gas_stiffness": 1e3}.get(name, 1.0) for name in law.parameters])
    low, high = limits_of(law)

    def internal(values: Vector) -> Vector:
        return np.where(linear, values / scale, np.log(np.where(linear, 1.0, values)))

    def plain(inner: Vector) -> Vector:
        return np.where(linear, inner * scale, np.exp(np.where(linear, 0.0, inner)))

    last: dict[bytes, tuple[Vector, Vector]] = {}

    def evaluate(inner: Vector) -> tuple[Vector, Vector]:
        key = inner.tobytes()
        if key not in last:
            values, rows, columns = plain(inner), [], []
            for test, mask in used:
                # A step of the search may overflow: the search refuses it, and takes a shorter one.
                with np.errstate(over="ignore", invalid="ignore"):
                    force, slopes = force_and_slopes(law, values, test.motion)
                share = test.weights[mask]
                weight = np.sqrt(share / np.sum(share)) / test.scale
                rows.append(weight * (force - test.force)[mask])
                columns.append(weight[:, None] * slopes[mask] * np.where(linear, scale, values))
            last.clear()
            last[key] = np.concatenate(rows), np.concatenate(columns)
        return last[key]

    results = []
    bounds = internal(low), internal(high)
    for start in starts:
        begin = np.clip(internal(np.clip(start, low, high)), bounds[0] + 1e-6, bounds[1] - 1e-6)
        results.append(
            scipy.optimize.least_squares(
                lambda inner: evaluate(inner)[0], begin, lambda inner: evaluate(inner)[1], bounds=bounds,
                max_nfev=evaluations, x_scale=0.3, ftol=tolerance, xtol=tolerance,
            )
        )  # fmt: skip
    return plain(min(results, key=lambda each: float(each.cost)).x)


def starts_of(law: DamperLaw, smaller: DamperFit, tests: Sequence[DamperTest]) -> list[Vector]:
    """Return start values of a law from the fit of a law with one part less."""
    force = max(test.scale for test in tests)
    speed = max(float(np.percentile(np.abs(test.velocity), 95.0)) for test in tests)
    previous = dict(zip(smaller.law.parameters, smaller.parameters.tolist(), strict=True))
    starts = []
    for share in (0.1, 0.4):
        new = {
            "friction": share * force, "friction_at_rest": 1.3 * previous.get("friction", share * force),
            "stribeck_velocity": 0.2 * share * speed, "gas_stiffness": 100.0, "gas_force": previous["gas_force"],
            "series_stiffness": force / (speed * (3e-4 if share < 0.2 else 5e-3)),
        }  # fmt: skip
        for i in range(law.elements):
            new |= {f"slider_limit_{i + 1}": share * force, f"slider_stroke_{i + 1}": 1e-3 * 4.0**-i}
        for side in law.sides:
            fallback = previous.get(f"{side}damping_1") or previous.get("damping_1") or previous["rebound_damping_1"]
            for j in range(law.bends + 1):
                beyond = law.bends > smaller.law.bends
                before = previous.get(f"{side}damping_{j + 1}") or previous.get(f"damping_{j + 1}")
                if beyond:
                    shifted = previous.get(f"{side}damping_{j}") or previous.get(f"damping_{j}") or fallback
                    before = shifted if j else (1.5 + 3.0 * share) * fallback
                new[f"{side}damping_{j + 1}"] = before or fallback
                if j < law.bends:
                    width = previous.get(f"{side}velocity_{j}") or previous.get(f"velocity_{j}") or share * speed
                    same = previous.get(f"{side}velocity_{j + 1}") or previous.get(f"velocity_{j + 1}")
                    new[f"{side}velocity_{j + 1}"] = (width if j else share * speed / law.bends) if beyond else same
        merged = new | {name: value for name, value in previous.items() if law.bends == smaller.law.bends}
        starts.append(np.array([merged[name] for name in law.parameters]))
    return starts


def folds_of(tests: Sequence[DamperTest]) -> list[list[Mask]]:
    """Return the samples left out by each fit, for each test: whole tests, or parts of the records of few tests."""
    if len(tests) >= FEW_TESTS:
        count = min(len(tests), FOLDS)
        return [
            [
                test.settled if i % count == fold else np.zeros(test.time.size, dtype=bool)
                for i, test in enumerate(tests)
            ]
            for fold in range(count)
        ]
    folds = []
    for part in range(PARTS):
        masks = []
        for test in tests:
            rows = np.flatnonzero(test.settled)
            mask = np.zeros(test.time.size, dtype=bool)
            mask[np.array_split(rows, PARTS)[part]] = True
            masks.append(mask)
        folds.append(masks)
    return folds


def judged(tests: Sequence[DamperTest], law: DamperLaw, starts: Sequence[Vector]) -> DamperFit:
    """Fit a law to all tests, and without each fold in turn; return the fit with its errors on what was left out."""
    parameters = fit_law(tests, law, starts)
    errors = [np.full(test.time.size, np.nan) for test in tests]
    for masks in folds_of(tests):
        remaining = [test.settled & ~mask for test, mask in zip(tests, masks, strict=True)]
        part = fit_law(tests, law, [parameters], remaining, 12)
        for test, mask, error in zip(tests, masks, errors, strict=True):
            if mask.any():
                with np.errstate(over="ignore", invalid="ignore"):
                    error[mask] = (force_and_slopes(law, part, test.motion)[0] - test.force)[mask] / test.scale
    blocks, left_out = [], []
    for test, error in zip(tests, errors, strict=True):
        squares = np.minimum(np.nan_to_num(error[test.settled] ** 2, nan=LARGEST), LARGEST)
        shares = test.weights[test.settled]
        left_out.append(np.sqrt(np.average(squares, weights=shares)))
        for rows in np.array_split(np.arange(squares.size), BLOCKS):
            blocks.append(float(np.average(squares[rows], weights=shares[rows])) + FLOOR**2)
    return DamperFit(law=law, parameters=parameters, left_out=np.array(left_out), blocks=np.array(blocks))


def thinned(test: DamperTest) -> DamperTest:
    """Return a test with means over parts of a cycle, of a periodic test at most `CYCLES` cycles.

    Samples stay single where the velocity changes fast, and around reversals.
    """
    last = test.time.size
    if test.waveform.periodic:
        end = test.time[np.argmax(test.settled)] + CYCLES * test.cycle
        last = min(last, int(np.searchsorted(test.time, end)) + 1)
    change = np.abs(np.diff(test.velocity, prepend=test.velocity[0])) / np.max(np.abs(test.velocity))
    stroke = np.abs(np.diff(test.displacement, prepend=test.displacement[0])) / np.ptp(test.displacement)
    count = np.floor(np.cumsum(PER_CYCLE * (change / 8.0 + stroke / 4.0)))
    first = np.diff(count, prepend=-1.0) > 0.0
    for jump in np.flatnonzero(change > JUMP):
        first[max(jump - 1, 0) : jump + AFTER] = True
    for turn in reversals(test.displacement, test.velocity):
        first[max(turn - AFTER, 0) : turn + AFTER] = True
    return test.averaged(np.flatnonzero(first[:last]), last)


def choose_law(
    tests: Sequence[DamperTest], progress: Callable[[int], None] | None = None
) -> tuple[DamperFit, list[DamperFit]]:
    """Return the chosen law fitted to all samples, with standard errors, and all laws that were compared.

    Args:
        progress: called with the number of compared laws.
    """
    if not tests:
        raise DataError("the tests are missing; name at least one file with a damper test")
    few = [thinned(test) for test in tests]
    first = DamperLaw()
    size = max(test.scale for test in few) / max(float(np.std(test.velocity)) for test in few)
    front = [judged(few, first, [np.array([0.0, size])])]
    fits = {first: front[0]}
    while front:
        lowest_error = min(fit.left_out_error for fit in fits.values())
        new = []
        for smaller in front:
            for law in smaller.law.larger():
                if law not in fits:
                    fits[law] = judged(few, law, starts_of(law, smaller, few))
                    new.append(fits[law])
                    if progress is not None:
                        progress(len(fits))
        front = [
            fit
            for fit in sorted(new, key=lambda fit: fit.left_out_error)[:BEAM]
            if fit.left_out_error * (1.0 + RELEVANT) < lowest_error
        ]
    compared = sorted(fits.values(), key=lambda fit: fit.left_out_error)
    top = compared[0]
    within = [fit for fit in compared if not _better(top, fit, len(few))]
    chosen = min(within, key=lambda fit: (len(fit.law.parameters), fit.left_out_error))
    chosen = judged(tests, chosen.law, [chosen.parameters])
    return finished(tests, chosen), compared


def _better(fit: DamperFit, other: DamperFit, tests: int) -> bool:
    """True if the errors of a fit on left-out data are smaller than in another fit by over one standard error.

    A difference below `RELEVANT` does not count.

    The mean logarithm of the ratio is compared with its standard error over blocks, or over tests where that is larger:
    blocks of one test share the error of a law that does not fit that test.

    Args:
        fit, other: fits with mean squares of the errors by blocks.
        tests: number of tests, `BLOCKS` blocks each.
    """
    ratios = np.log(other.blocks / fit.blocks)
    spreads = [float(np.std(ratios, ddof=1) / np.sqrt(ratios.size))]
    if tests >= FEW_TESTS:
        spreads.append(float(np.std(ratios.reshape(tests, -1).mean(axis=1), ddof=1)) / np.sqrt(tests))
    return bool(np.mean(ratios) > max(*spreads, 2.0 * np.log(1.0 + RELEVANT)))


def finished(tests: Sequence[DamperTest], fit: DamperFit) -> DamperFit:
    """Return a fit of all samples, with standard errors and the errors of each test."""
    law = fit.law
    parameters = fit_law(tests, law, [fit.parameters], tolerance=1e-7)
    scores, curvature, fitted, whole = [], np.zeros((parameters.size,) * 2), [], []
    noise = np.zeros_like(curvature)
    # Columns of equal size: the parameters differ by many orders of magnitude.
    sizes = np.maximum(
        np.abs(parameters), [{"gas_force": 1.0, "gas_stiffness": 10.0}.get(n, 0.0) for n in law.parameters]
    )
    for test in tests:
        force, slopes = force_and_slopes(law, parameters, test.motion)
        error = (force - test.force) / test.scale
        shares = np.where(test.settled, test.weights, 0.0) / np.sum(test.weights[test.settled])
        columns = slopes * sizes / test.scale
        curvature += columns.T @ (shares[:, None] * columns)
        square = shares @ error**2
        noise += square * columns.T @ (shares[:, None] ** 2 * columns)
        scores += [columns[rows].T @ (shares[rows] * error[rows]) for rows in test.cycle_rows]
        fitted.append(np.sqrt(square))
        whole.append(np.sqrt(np.mean(error**2)))
    inverse = np.linalg.pinv(curvature, hermitian=True, rcond=1e-12)
    middle = np.array(scores).T @ np.array(scores) * len(scores) / (len(scores) - 1)
    correlated, independent = (inverse @ each @ inverse * np.outer(sizes, sizes) for each in (middle, noise))
    return dataclasses.replace(
        fit, parameters=parameters, fitted=np.array(fitted), whole=np.array(whole),
        errors=np.sqrt(np.maximum(_variances(law, correlated), _variances(law, independent))),
    )  # fmt: skip


def _variances(law: DamperLaw, covariance: Vector) -> Vector:
    """Return the variances of the parameters with velocities of breakpoints, from the covariance with widths."""
    names = list(law.parameters)
    change = np.eye(len(names))
    for side in law.sides:
        at = [names.index(f"{side}velocity_{j + 1}") for j in range(law.bends)]
        change[np.ix_(at, at)] = np.tril(np.ones((len(at), len(at))))
    return np.asarray(np.maximum(np.einsum("ij,jk,ik->i", change, covariance, change), 0.0))
