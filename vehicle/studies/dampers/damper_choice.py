"""Choice of the law of a damper by its errors on tests left out of the fit.

A law grows by one part at a time (`DamperLaw.larger`), and is pursued while its error on tests left out falls: each
candidate is fitted without one test in turn, and judged by that test. With less than three tests, parts of the records
are left out instead of tests. The error of a law is the mean of the logarithms of its RMS errors, so that all tests
count alike. In the end the law with the fewest parameters is chosen whose error is within one standard error of the
best, and which is on no test worse than the best by more than `WORST` and one standard error there.

The standard error describes the error of the best law itself. Tests are chosen by the engineer, not drawn at random:
the error is a mean over strata (Cochran, Sampling Techniques, 5.3). In each of the n tests, the mean square varies
between its B blocks, and by the errors s of the force that the other tests leave in the parameters, common to all
blocks. With d ln e = d mean(e^2)/(2 mean(e^2)),

    SE^2 = 1/n^2 sum over tests of (var(e^2)/B + 2 s^4)/(4 mean(e^2)^2),   s^2 = mean of x' cov x <= e^2,   x = dF/dp.

The mean square of x' dp for normal errors dp of the parameters has the variance 2 tr((A cov)^2), A = mean of x x'. It
is at most 2 tr(A cov)^2 = 2 s^4, and equal if one combination of the parameters dominates: SE is an upper estimate. The
spread between tests does not count: one test is harder than another for all laws alike. The fits without a test share
most of their data; the correlation of their errors between tests is neglected, and has no unbiased estimate (Bengio and
Grandvalet, J. Machine Learning Research 5, 2004).

Sources: leave-one-out and the rule of one standard error: Hastie, Tibshirani, Friedman, The Elements of Statistical
Learning, 7.10.
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from vehicle.arrays import Mask, Vector
from vehicle.errors import DataError
from vehicle.studies.dampers.damper_fit import (
    DamperFit,
    covariances,
    finished,
    fit_law,
    fitted_squares,
    parameter_squares,
    squares_of,
)
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_ranges import law_differences, range_errors
from vehicle.studies.dampers.damper_starts import first_start, starts_from_larger, starts_of
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.joint_tests import joint
from vehicle.studies.dampers.waveform import reversals
from vehicle.threads import one_blas_thread

PER_CYCLE, CYCLES = 250, 2
"""Samples of a cycle, and settled cycles of a periodic test, with which laws are compared; the chosen law has all."""

GROUPS = 2000
"""Number of means of a test with a changing setting."""

JUMP, AFTER = 0.1, 12
"""Change of the velocity in a sample, over its maximum, after which `AFTER` samples stay single; as many do before and
after a reversal."""

FEW_TESTS, PARTS = 3, 4
"""Number of tests from which on whole tests are left out, and number of parts of a record otherwise."""

FOLDS = 6
"""Maximum number of fits with tests left out; above it several tests are left out together."""

RETRIED = 12
"""Maximum number of evaluations of a start for a law that was fitted from other starts before."""

BEAM = 2
"""Number of laws that get a further part at a time."""

BLOCKS = 8
"""Blocks of a test for the standard error of the choice."""

FLOOR = 0.01
"""Error over the standard deviation of the force, added in quadrature to the error of each block: laws that describe
a damper within this are alike."""

RELEVANT = 0.03
"""Relative difference of two errors, with `FLOOR` in them, that is a reason for a further part."""

NEAR = 1.25
"""Largest ratio of the error of a law to the best error left out, up to which the law is judged, and its own smaller
laws are fitted from it: above the tolerance of the choice."""

WORST = 1.5
"""Largest ratio of the errors of a law and of the best law on a test left out: the accuracy of stated errors."""


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
    tests = joint(tests)
    parameters = fit_law(tests, law, starts)
    squares = np.full((len(tests), BLOCKS), np.nan)
    left_out = np.zeros(len(tests))
    errors = [np.zeros(test.time.size) for test in tests]
    for masks in folds_of(tests):
        part = without(tests, law, parameters, masks)
        for error, mask, each in zip(errors, masks, part, strict=True):
            error[mask] = each[mask]
    for at, (test, error) in enumerate(zip(tests, errors, strict=True)):
        shares, inside = test.weights[test.settled], error[test.settled]
        left_out[at] = np.sqrt(np.average(inside, weights=shares))
        for block, rows in enumerate(np.array_split(np.arange(inside.size), BLOCKS)):
            squares[at, block] = np.average(inside[rows], weights=shares[rows]) + FLOOR**2
    return DamperFit(law=law, parameters=parameters, left_out=left_out, blocks=squares)


def without(tests: Sequence[DamperTest], law: DamperLaw, start: Vector, masks: Sequence[Mask]) -> list[Vector]:
    """Fit a law without the samples of the masks; return the squares of its errors over the variance of the force."""
    remaining = [test.settled & ~mask for test, mask in zip(tests, masks, strict=True)]
    return squares_of(tests, law, fit_law(tests, law, [start], remaining, 12))


def thinned(test: DamperTest) -> DamperTest:
    """Return a test with means over parts of a cycle, of a periodic test at most `CYCLES` cycles.

    Samples stay single where the velocity changes fast, and around reversals. With a changing setting the means are
    over equal groups, at most `GROUPS` of them.
    """
    last = test.time.size
    if test.waveform.periodic:
        end = test.time[np.argmax(test.settled)] + CYCLES * test.cycle
        last = min(last, int(np.searchsorted(test.time, end)) + 1)
    change = np.abs(np.diff(test.velocity, prepend=test.velocity[0])) / np.max(np.abs(test.velocity))
    stroke = np.abs(np.diff(test.displacement, prepend=test.displacement[0])) / np.ptp(test.displacement)
    count = np.floor(np.cumsum(PER_CYCLE * (change / 8.0 + stroke / 4.0)))
    first = np.diff(count, prepend=-1.0) > 0.0
    if test.setting is not None:
        first = np.arange(test.time.size) % -(-test.time.size // GROUPS) == 0
    for jump in np.flatnonzero(change > JUMP):
        first[max(jump - 1, 0) : jump + AFTER] = True
    for turn in reversals(test.displacement, test.velocity):
        first[max(turn - AFTER, 0) : turn + AFTER] = True
    return test.averaged(np.flatnonzero(first[:last]), last)


@one_blas_thread()
def choose_law(
    tests: Sequence[DamperTest], progress: Callable[[int], None] | None = None
) -> tuple[DamperFit, list[DamperFit]]:
    """Return the chosen law fitted to all samples, with standard errors, and all laws that were compared.

    Args:
        progress: called with the number of compared laws.
    """
    if not tests:
        raise DataError("the tests are missing; name at least one file with a damper test")
    few = joint([thinned(test) for test in tests])
    fits = LawSearch(few, progress).run()
    compared = sorted(fits.values(), key=lambda fit: fit.left_out_error)
    errors = standard_errors(few, compared[0])
    accepted = [is_accepted(compared[0], fit, errors) for fit in compared]
    compared = [
        dataclasses.replace(finished(few, fit), ranges=range_errors(few, fit), accepted=True) if within else fit
        for fit, within in zip(compared, accepted, strict=True)
    ]
    chosen = min(compared, key=lambda fit: (not fit.accepted, len(fit.law.parameters), fit.left_out_error))
    tests = joint(tests)
    whole = judged(tests, chosen.law, [chosen.parameters])
    chosen = dataclasses.replace(
        finished(tests, whole), ranges=chosen.ranges, accepted=True, tolerance=tolerance_of(errors)
    )
    within = [fit for fit in compared if fit.accepted]
    chosen = dataclasses.replace(chosen, differences=law_differences(few, chosen, within))
    return chosen, compared


class LawSearch:
    """Fits of laws, each larger or smaller by a part than another.

    A law grows while its error left out falls. Then the laws with one part less than the best are fitted from its
    parameters, and so on while they stay near the best: a law that grew from a poor fit may be in a poor minimum. A law
    that is so fitted better grows again.
    """

    def __init__(self, tests: Sequence[DamperTest], progress: Callable[[int], None] | None) -> None:
        self.tests, self.progress = tests, progress or (lambda count: None)
        self.fits: dict[DamperLaw, DamperFit] = {}
        self.squares: dict[DamperLaw, Vector] = {}  # mean squares of the errors of all fitted laws; (tests,) each

    def run(self) -> dict[DamperLaw, DamperFit]:
        """Return all fits by their laws, without those that `slipping` leaves out."""
        first = DamperLaw(setting="lag" if self.tests[0].setting is not None else "")
        self._fit(first, first_start(first, self.tests))
        improved = [self.fits[first]]
        while improved:
            self._grow(improved)
            improved = self._shrink()
        return self.slipping()

    def slipping(self) -> dict[DamperLaw, DamperFit]:
        """Return the fits whose sliders all slip in a test.

        Another slider is a spring there: the law with gas stiffness fits alike, without a sliding force that no test
        shows. From a reversal to slip a slider takes twice its stroke from rest.
        """
        longest = max(float(np.ptp(test.displacement)) for test in self.tests)
        strokes = {
            law: [value for name, value in zip(law.parameters, fit.parameters, strict=True) if "slider_stroke" in name]
            for law, fit in self.fits.items()
        }
        return {law: fit for law, fit in self.fits.items() if 2.0 * max(strokes[law], default=0.0) < longest}

    def _fit(self, law: DamperLaw, starts: Sequence[Vector]) -> bool:
        """Fit a law from some starts; return True if it is judged: new or fitted better than before, and not poor."""
        # A law that is known already is tried with a few steps only: a better minimum shows early.
        parameters = fit_law(self.tests, law, starts, evaluations=RETRIED if law in self.squares else 40)
        errors = fitted_squares(self.tests, law, parameters)
        if law in self.squares and np.sum(errors) * (1.0 + RELEVANT) ** 2 > np.sum(self.squares[law]):
            return False
        self.squares[law] = errors
        self.progress(len(self.squares))
        # The error left out is hardly below the error of the fit.
        if self.fits and np.exp(0.5 * np.mean(np.log(errors + FLOOR**2))) > NEAR * self.lowest_error:
            return False
        self.fits[law] = judged(self.tests, law, [parameters])
        return True

    @property
    def lowest_error(self) -> float:
        """Smallest error left out of all fits."""
        return min(fit.left_out_error for fit in self.fits.values())

    def _grow(self, front: list[DamperFit]) -> None:
        """Add parts to some laws while their errors left out fall, `BEAM` laws at a time."""
        while front:
            lowest_error = self.lowest_error
            new: dict[DamperLaw, DamperFit] = {}
            for smaller in front:
                for law in smaller.law.larger():
                    if self._fit(law, starts_of(law, smaller, self.tests)):
                        new[law] = self.fits[law]
            front = [
                fit
                for fit in sorted(new.values(), key=lambda fit: fit.left_out_error)[:BEAM]
                if fit.left_out_error * (1.0 + RELEVANT) < lowest_error
            ]

    def _shrink(self) -> list[DamperFit]:
        """Fit the laws with one part less than the best, and so on; return the laws that are fitted better so."""
        improved: dict[DamperLaw, DamperFit] = {}
        front = [min(self.fits.values(), key=lambda fit: fit.left_out_error)]
        while front:
            new: dict[DamperLaw, DamperFit] = {}
            for larger in front:
                for law in larger.law.smaller():
                    if self._fit(law, starts_from_larger(law, larger)):
                        new[law] = self.fits[law]
            near = [fit for fit in new.values() if fit.left_out_error < NEAR * self.lowest_error]
            front = sorted(near, key=lambda fit: fit.left_out_error)[:BEAM]
            improved |= {fit.law: fit for fit in front}
        return list(improved.values())[:BEAM]


def standard_errors(tests: Sequence[DamperTest], fit: DamperFit) -> Vector:
    """Return the standard errors of the logarithms of the errors left out; (tests,)."""
    variances = np.zeros(len(tests))
    for masks in folds_of(tests):
        remaining = [test.settled & ~mask for test, mask in zip(tests, masks, strict=True)]
        parameters = fit_law(tests, fit.law, [fit.parameters], remaining, 12)
        spreads = covariances(tests, fit.law, parameters, remaining)
        for at, (test, mask) in enumerate(zip(tests, masks, strict=True)):
            if mask.any():
                squares = parameter_squares(fit.law, parameters, spreads, test)[mask]
                variances[at] += np.sum(squares * test.weights[mask]) / np.sum(test.weights[test.settled])
    means = np.mean(fit.blocks, axis=1)
    between = np.var(fit.blocks, axis=1, ddof=1) / fit.blocks.shape[1]
    # The linear estimate may exceed the error itself, which is one draw of it.
    return np.asarray(np.sqrt(between + 2.0 * np.minimum(variances, means) ** 2) / (2.0 * means))


def is_accepted(best: DamperFit, fit: DamperFit, errors: Vector) -> bool:
    """True if the error of a fit is within the tolerance of the best, and nowhere worse by more than `WORST`.

    Args:
        errors: standard errors of the logarithms of the best errors; (tests,).
    """
    worse = fit.logarithms - best.logarithms
    return bool(np.mean(worse) <= tolerance_of(errors) and np.all(worse <= np.log(WORST) + errors))


def tolerance_of(errors: Vector) -> float:
    """Return the standard error of the mean logarithm, at least ln(1 + `RELEVANT`)."""
    return max(float(np.sqrt(np.sum(errors**2))) / errors.size, float(np.log(1.0 + RELEVANT)))
