"""Conditions of the tests of a damper: groups of equal conditions, and a condition that changes during its tests."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.studies.dampers.damper_setting import Setting
from vehicle.studies.dampers.damper_test import DamperTest

CHANGED = 0.1
"""Smallest change of a condition during a test, from 5 to 95 % of its samples, over the largest value of all tests."""

WHITE = 1.0
"""Mean squared change from sample to sample over the variance: 2 of white noise, close to 0 of a changing condition."""

ENDS = 1.0, 99.0
"""Percentiles of all samples that count as lowest and highest condition: a controlled current overshoots."""


BEGIN = 0.1
"""Time [s] at the begin of a test whose condition changes that is not fitted: the lag remembers what was before. After
five lags of 20 ms 0.7 % of it is left."""


def by_conditions(tests: Sequence[DamperTest]) -> dict[tuple[tuple[str, float], ...], list[DamperTest]]:
    """Return the tests in groups with the same conditions, sorted by them."""
    groups: dict[tuple[tuple[str, float], ...], list[DamperTest]] = {}
    for test in tests:
        groups.setdefault(tuple(test.conditions.items()), []).append(test)
    return dict(sorted(groups.items(), key=lambda entry: [value for _, value in entry[0]]))


def with_setting(tests: Sequence[DamperTest]) -> list[DamperTest]:
    """Return the tests, with the condition that changes during at least one of them as their setting.

    Raises:
        ConfigurationError: two conditions change.
    """
    names = [name for name in (tests[0].traces if tests else ()) if _changes([test.traces[name] for test in tests])]
    if not names:
        return list(tests)
    if len(names) > 1:
        raise ConfigurationError(
            f"--condition: {' and '.join(names)} change during the tests, but at most one condition may; name one of "
            "them, and give the others a value with --condition NAME=VALUE"
        )
    name = names[0]
    lowest, highest = np.percentile(np.concatenate([test.traces[name] for test in tests]), ENDS).tolist()
    text = (
        f"{name} changes during the tests, from {number(lowest, 3)} to {number(highest, 3)}: one law is fitted, which "
        "follows it with a lag"
    )
    return [
        dataclasses.replace(
            test, conditions={key: value for key, value in test.conditions.items() if key != name},
            notices=(*test.notices, text), setting=Setting(name=name, time=test.time, values=test.traces[name],
            lowest=lowest, highest=highest), waveform=test.waveform._replace(
            settled=test.settled & (test.time >= test.time[0] + BEGIN)),
        )
        for test in tests
    ]  # fmt: skip


def _changes(traces: Sequence[Vector]) -> bool:
    """True if a condition changes during one of the tests by more than noise."""
    largest = max(float(np.max(np.abs(values))) for values in traces)
    for values in traces:
        variance = float(np.var(values))
        change = float(np.subtract(*np.percentile(values, (95.0, 5.0))))
        if change > CHANGED * largest and np.mean(np.diff(values) ** 2) < WHITE * variance:
            return True
    return False
