"""Tests of a damper whose forces by a law are computed together, and stored for the parameters that were tried last.

The fits of a law to all tests, and without each test in turn, begin with the same parameters. Each fit needs the forces
at these parameters, and its result gives the error in the test left out: a simulation of all tests serves all fits.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from vehicle.arrays import Vector
from vehicle.studies.dampers.damper_force import Motion, force_and_slopes, joined
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_test import DamperTest

STORED = 8
"""Number of parameter sets whose forces are stored: the start of a fit without a test, and its few steps."""

BATCH = 20_000
"""Maximum number of samples computed in one pass, unless a test has more: the arrays of a pass stay below 20 MB."""


class JointTests(tuple[DamperTest, ...]):
    """Tests with the forces of laws under all their motions."""

    def __init__(self, tests: Sequence[DamperTest]) -> None:
        self._stored: dict[tuple[DamperLaw, bytes], tuple[Vector, Vector]] = {}

    def force_and_slopes(self, law: DamperLaw, parameters: Vector) -> tuple[Vector, Vector]:
        """Return the force [N] over all samples of all tests, (n,), and its derivatives over the parameters, (n, p).

        Overflow gives infinite or undefined forces, which a search refuses.
        """
        key = law, parameters.tobytes()
        computed = self._stored.pop(key, None)
        if computed is None:
            with np.errstate(over="ignore", invalid="ignore"):
                forces, slopes = zip(*(force_and_slopes(law, parameters, each) for each in self._motions), strict=True)
            computed = np.concatenate(forces), np.concatenate(slopes)
        self._stored[key] = computed  # the last one used is at the end
        if len(self._stored) > STORED:
            self._stored.pop(next(iter(self._stored)))
        return computed

    def split(self, values: Vector) -> list[Vector]:
        """Split values over all samples into those of each test; (n, ...) each."""
        return np.split(values, np.cumsum([test.time.size for test in self[:-1]]))

    @cached_property
    def _motions(self) -> list[Motion]:
        """Return the motions of the tests in batches of at most `BATCH` samples."""
        batches: list[list[Motion]] = []
        size = BATCH
        for test in self:
            size += test.time.size
            if size > BATCH:
                batches.append([])
                size = test.time.size
            batches[-1].append(test.motion)
        return [joined(batch) for batch in batches]


def joint(tests: Sequence[DamperTest]) -> JointTests:
    """Return the tests with the forces of laws."""
    return tests if isinstance(tests, JointTests) else JointTests(tests)
