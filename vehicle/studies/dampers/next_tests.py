"""Further tests of a damper, with the uncertainty of its force over the velocity that each would leave.

The force of curve and sliding friction F(v) deviates from the chosen law in directions of unit variance: the columns of
A, (v, d). The columns of B, (n, d), are the same deviations in n samples of a further test. With independent
errors of variance R, the test leaves

    cov F = A (1 + B'B/R)^-1 A',    u^2 = sum over velocities of w cov F(v, v),

the linear update of a normal distribution; for the weights w see `Use`. The directions are of two groups:

    parameters: dF/dp L/sqrt(m) for each of the m laws within the tolerance, with the covariance L L' of its parameters;
    and above the fastest test a further bend, each case with the root of its probability (`damper_ranges`);
    structure: (F_l - F)/sqrt(m) of each other of these laws; and below the slowest test the unknown force of
    `damper_ranges`, independent increments over ln v.

A further test of N samples with the relative error e of the fits has R = n s^2/N, s^2 = max(e^2 var F, r^2) with the
smallest RMS error r of the tests [N]. For the parameters N is divided by the ratio of the variances of the curve from
correlated and from independent residuals (design effect, Kish 1965): the residuals of the further test are as
correlated as in the other tests. For the structure N is 1: the choice compares laws by the RMS error of whole tests
(`damper_choice`), and the tests that were fitted contain slow samples too, which did not decide. For the same reason,
the samples below half of the highest velocity of a test do not show the unknown force there.

Sources: where to observe next, by the linear update: Bishop, Etherton, Majumdar, Monthly Weather Review 129 (2001);
weighted trace as criterion: Chaloner and Verdinelli, Statistical Science 10 (1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number, rounded
from vehicle.studies.dampers.damper_force import Motion, force_and_slopes, steady_force
from vehicle.studies.dampers.damper_ranges import RATIO, bend_probability, bends_beyond, expected_error
from vehicle.studies.dampers.fitted_damper import FittedDamper

SLOWEST, FASTEST, PER_OCTAVE = 1e-3, 1.0, 4
"""Velocities of a damper in a car on a road [m/s], and number of them in an octave."""

SPEEDS = 1e-3 * np.array([2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0])
"""Highest velocities of the sines that are compared [m/s]."""

LOWEST, HIGHEST = 0.02, 20.0
"""Frequencies of these sines [Hz]: a cycle takes 50 s, or its column begins to vibrate."""

SAMPLES = 250
"""Samples of a cycle of a further test."""

SHOWN = 5
"""Number of tests in the printed table."""

WORTH = 0.9
"""Largest ratio of the uncertainties with and without a further test that is worth it."""


class Quantity(NamedTuple):
    """Result of a car that depends on the force of its dampers."""

    name: str  # with its road, for example "stick share on class A"
    value: str  # with its unit
    slopes: Vector  # change of the result [%] over the force at each velocity of the use [N]; (v,)
    unit: str = "%"  # of its uncertainty


class Use(NamedTuple):
    """Velocities at which the force matters."""

    velocity: Vector  # both directions, without zero [m/s]; (v,)
    shares: Vector | None = None  # of the time; None: the relative error counts, alike at all velocities; (v,)
    caption: str = f"{1e3 * SLOWEST:g} to {1e3 * FASTEST:g} mm/s, each octave alike"
    quantities: tuple[Quantity, ...] = ()  # results of a car

    def weights(self, force: Vector) -> Vector:
        """Return w [1/N^2]: 1/(v F^2), or the shares of the time over the mean square of the force; (v,)."""
        if self.shares is None:
            return np.asarray(1.0 / (force.size * force**2))
        return np.asarray(self.shares / np.sum(self.shares * force**2))


class NextTest(NamedTuple):
    """A further sine, and what it would leave of the uncertainty of the force."""

    condition: str  # of the test, for example "current 1"; empty without conditions
    amplitude: float  # [m]
    frequency: float  # [Hz]
    before: float  # before, after: u without and with the test [-], root of the mean square over all conditions
    after: float
    quantities: tuple[tuple[str, float, float], ...] = ()  # name, before and after [%] of results of a car

    @property
    def velocity(self) -> float:
        """Highest velocity [m/s]."""
        return 2.0 * np.pi * self.frequency * self.amplitude

    @property
    def cells(self) -> list[str]:
        """Amplitude [mm], frequency [Hz], highest velocity [mm/s], uncertainty left [%], and the condition, if any."""
        values = 1e3 * self.amplitude, self.frequency, 1e3 * self.velocity, 100.0 * self.after
        return [*(number(value, 2) for value in values), *([self.condition] if self.condition else [])]


HEADS = ("amplitude [mm]", "frequency [Hz]", "up to [mm/s]", "uncertainty left [%]", "condition")
"""Heads of `NextTest.cells`."""


def speeds_between(highest: float) -> Vector:
    """Return velocities from `SLOWEST` to the highest [m/s], with `PER_OCTAVE` in an octave; (v/2,)."""
    return np.geomspace(SLOWEST, highest, max(round(PER_OCTAVE * np.log2(highest / SLOWEST)), 1) + 1)


def even_use() -> Use:
    """Return the use of a damper in an unknown car: all octaves of the velocity alike."""
    size = speeds_between(FASTEST)
    return Use(np.concatenate([-size[::-1], size]))


def next_tests(fits: Sequence[FittedDamper], use: Use | None = None) -> list[NextTest]:
    """Return a sine for each highest velocity and condition, in the order of the remaining uncertainty.

    Args:
        fits: laws of one damper at all its conditions; each counts alike, and a test changes only the law of its
            conditions.
        use: velocities at which the force matters; default: `even_use`.
    """
    designs = [Design(fitted, use or even_use()) for fitted in fits]
    now = [design.uncertainty() for design in designs]
    squares = np.array([uncertainty**2 for uncertainty, _ in now])
    before, tests = float(np.sqrt(np.mean(squares))), []
    for fitted, design, square in zip(fits, designs, squares, strict=True):
        others = np.mean(squares) - square / len(fits)
        amplitudes = sorted({rounded(each, 2) for each in fitted.tested["amplitude"]})
        for speed in SPEEDS:
            sines = [(each, rounded(float(speed / (2.0 * np.pi * each)), 2)) for each in amplitudes]
            left = []
            for sine in sines:
                if LOWEST <= sine[1] <= HIGHEST:
                    after, results = design.uncertainty(*sine)
                    # Results of a car belong to a single law.
                    rows = zip([each.name for each in design.use.quantities], now[0][1], results, strict=True)
                    of_car = tuple(rows) if len(fits) == 1 else ()
                    whole = float(np.sqrt(others + after**2 / len(fits)))
                    left.append(NextTest(fitted.condition_words, *sine, before, whole, of_car))
            tests += [min(left, key=lambda test: test.after)] if left else []
    return sorted(tests, key=lambda test: test.after)


def next_sentence(tests: Sequence[NextTest], use: Use | None = None) -> str:
    """Return the first of the further tests in words; empty without tests."""
    if not tests:
        return ""
    best, caption = tests[0], (use or even_use()).caption
    if best.after > WORTH * best.before:
        before = number(100.0 * best.before, 2)
        return f"no further sine takes a tenth off the uncertainty of the force, {before} % ({caption})"
    amplitude, frequency, velocity, after, *condition = best.cells
    at = f" at {condition[0]}" if condition else ""
    return (
        f"a sine of {amplitude} mm with {frequency} Hz, up to {velocity} mm/s,{at} would reduce the uncertainty of the "
        f"force from {number(100.0 * best.before, 2)} to {after} % ({caption})"
    )


def next_lines(tests: Sequence[NextTest], use: Use | None = None) -> list[str]:
    """Return printed lines: the first test in words, and a table of the first `SHOWN` tests."""
    if not tests:
        return []
    heads = HEADS[: len(tests[0].cells)]
    rows = [heads, *(test.cells for test in tests[:SHOWN])]
    widths = [2 + max(map(len, column)) for column in zip(*rows, strict=True)]
    table = ["".join(f"{cell:>{width}}" for width, cell in zip(widths, row, strict=True)) for row in rows]
    return [f"next: {next_sentence(tests, use)}", *table, *(f"next: {text}" for text in result_sentences(tests, use))]


def result_sentences(tests: Sequence[NextTest], use: Use | None = None) -> list[str]:
    """Return for each result of the car the test that leaves its smallest uncertainty, in words."""
    sentences = []
    for index, quantity in enumerate((use or even_use()).quantities if tests and tests[0].quantities else ()):
        best = min(tests, key=lambda test: test.quantities[index][2])
        _, before, after = best.quantities[index]
        amplitude, frequency, velocity, *_ = best.cells
        start = f"the {quantity.name}, {quantity.value}, has an uncertainty of {number(before, 2)} {quantity.unit}"
        if after > WORTH * before:
            sentences.append(f"{start}; no further sine takes a tenth off")
        else:
            sentences.append(
                f"{start}; a sine of {amplitude} mm with {frequency} Hz, up to {velocity} mm/s, would reduce it to "
                f"{number(after, 2)} {quantity.unit}"
            )
    return sentences


def next_json(tests: Sequence[NextTest], use: Use | None = None) -> dict[str, Any]:
    """Return the first test in words and all tests for `--json`, in SI units."""
    rows = [
        test._asdict() | {"velocity": test.velocity}
        | {"quantities": [{"name": n, "before": b, "after": a} for n, b, a in test.quantities]}
        for test in tests
    ]  # fmt: skip
    return {"next_test": next_sentence(tests, use), "next_tests": rows}


class Design:
    """Deviations of the force of a fitted damper, and what a further test leaves of them."""

    def __init__(self, fitted: FittedDamper, use: Use) -> None:
        self.use = use
        self.chosen, self.speeds, self.highest = fitted.fit, fitted.speeds, float(np.max(np.abs(use.velocity)))
        self.laws = [fitted.fit, *(fit for fit in fitted.accepted if fit.tested_law != fitted.fit.tested_law)]
        # Unknown force below the slowest test, in steps between the velocities of the use.
        slowest = self.speeds[0]
        octave, inside = (expected_error(self.chosen, self.speeds, each).usual for each in (slowest / RATIO, slowest))
        size = np.unique(np.abs(use.velocity))
        steps = np.append(size[size < slowest], slowest)
        self.thresholds = steps[1:]
        self.increments = np.sqrt(max(octave**2 - inside**2, 0.0) * np.diff(np.log2(steps)))
        # As in the standard errors, the larger variance of the curve counts.
        self.factors: list[Vector] = []
        self.effect = 1.0
        for law in reversed(self.laws):
            columns = steady_force(law.law, law.parameters, use.velocity)[1]
            blocks, independent = (float(np.sum((columns @ spread) * columns)) for spread in law.spreads)
            values, vectors = np.linalg.eigh(law.spreads[0 if blocks > independent else 1])
            self.factors.insert(0, vectors * np.sqrt(np.maximum(values, 0.0)))
            self.effect = max(blocks / independent, 1.0) if independent else 1.0  # of the chosen law in the end
        forces = [steady_force(law.law, law.parameters, use.velocity) for law in self.laws]
        self.deviations = self._deviations(forces, use.velocity)
        self.weights = use.weights(forces[0][0])
        self.relative = float(np.sqrt(np.mean(self.chosen.fitted**2)))
        self.smallest = min(e * test.scale for e, test in zip(self.chosen.fitted.tolist(), fitted.tests, strict=True))
        self.samples = float(np.median([np.count_nonzero(test.settled) for test in fitted.tests]))

    def uncertainty(self, amplitude: float = 0.0, frequency: float = 0.0) -> tuple[float, list[float]]:
        """Return u after a further sine [-], and the uncertainties of the results of the car [%].

        Without a sine, only the tests count.

        Args:
            amplitude, frequency: of the sine [m], [Hz].
        """
        left = self.deviations
        if amplitude:
            time = np.arange(2 * SAMPLES + 1) / (SAMPLES * frequency)
            # No sample is at a reversal.
            phase = 2.0 * np.pi * (frequency * time + 0.25 / SAMPLES)
            x, v = amplitude * np.sin(phase), 2.0 * np.pi * frequency * amplitude * np.cos(phase)
            motion = Motion(time, x, v, float(steady_force(self.chosen.law, self.chosen.parameters, v[:1])[0][0]))
            second = slice(SAMPLES + 1, None)
            forces = [force_and_slopes(law.law, law.parameters, motion) for law in self.laws]
            forces = [(force[second], slopes[second]) for force, slopes in forces]
            observed = self._deviations(forces, v[second], float(np.max(np.abs(v))) / RATIO)
            error = max(self.relative * float(np.std(forces[0][0])), self.smallest)
            counts = self.samples / self.effect, 1.0
            variances = (error**2 * SAMPLES / count for count in counts)
            left = [_updated(*each) for each in zip(left, observed, variances, strict=True)]
        force = float(np.sqrt(sum(self.weights @ np.sum(group**2, axis=1) for group in left)))
        return force, [
            float(np.sqrt(sum(np.sum((each.slopes @ group) ** 2) for group in left))) for each in self.use.quantities
        ]

    def _deviations(self, forces: Sequence[tuple[Vector, Vector]], velocity: Vector, seen: float = 0.0) -> list[Vector]:
        """Return the deviations of the force by the parameters, and by the structure; (n, d) each.

        Args:
            forces: force and derivatives of each law, the chosen one first.
            velocity: velocities of the damper [m/s]; (n,).
            seen: lowest velocity at which the unknown force below the slowest test is seen [m/s].
        """
        share = 1.0 / np.sqrt(len(self.laws))
        parameters = [share * slopes @ factor for (_, slopes), factor in zip(forces, self.factors, strict=True)]
        slowest, fastest = self.speeds
        if self.highest > fastest:
            octaves = np.log2([fastest / slowest, self.highest / fastest])
            bend = bend_probability(self.chosen.law.bends, *octaves)
            changes = bends_beyond(self.chosen, fastest, self.highest, velocity)
            parameters.append(np.sqrt(bend / changes.shape[0]) * changes.T)
        structure = [share * (force - forces[0][0])[:, None] for force, _ in forces[1:]]
        curve, size = steady_force(self.chosen.law, self.chosen.parameters, velocity)[0], np.abs(velocity)[:, None]
        structure.append(curve[:, None] * self.increments * ((size < self.thresholds) & (size >= seen)))
        return [np.concatenate(parameters, axis=1), np.concatenate(structure, axis=1)]


def _updated(prior: Vector, observed: Vector, variance: float) -> Vector:
    """Return A (1 + B'B/R)^(-1/2), whose square is the covariance after the observation; (v, d)."""
    root = np.linalg.cholesky(np.eye(prior.shape[1]) + observed.T @ observed / variance)
    return np.asarray(np.linalg.solve(root, prior.T).T)
