"""Conditions of the tests of a damper: groups of equal conditions, and a condition that changes during its tests."""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.studies.dampers.damper_fit import DamperFit
from vehicle.studies.dampers.damper_setting import Setting
from vehicle.studies.dampers.damper_test import DamperTest

Fits = tuple[DamperFit, list[DamperFit]]
"""Chosen law, and all laws that were compared."""

CHANGED = 0.1
"""Smallest change of a condition during a test, from 5 to 95 % of its samples, over the largest value of all tests."""

WHITE = 1.0
"""Mean squared change from sample to sample over the variance: 2 of white noise, close to 0 of a changing condition."""

ENDS = 1.0, 99.0
"""Percentiles of all samples that count as lowest and highest condition: a controlled current overshoots."""

BEGIN = 0.1
"""Time [s] at the begin of a test whose condition changes that is not fitted: the lag remembers what was before. It is
five lags of 20 ms; with a longer lag the tests are fitted again without a longer time, see `fitted_beyond_lag`."""

LAGS, LEFT = 5.0, 0.01
"""Lags that are left out, after which 0.7 % of the earlier state remains, and share that may remain [-]."""

LONGEST = 0.5
"""Longest part that is left out, over the fitted part of the shortest test."""


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
            notices=(*test.notices, text),
            setting=Setting(
                name=name, time=test.time, values=test.traces[name], lowest=lowest, highest=highest
            ),
        )
        for test in tests
    ]  # fmt: skip


def fitted_beyond_lag(
    tests: Sequence[DamperTest], fit_of: Callable[[Sequence[DamperTest]], Fits]
) -> tuple[Sequence[DamperTest], Fits]:
    """Fit tests, and fit them again without their begin until this is longer than the memory of the fitted lag.

    The state y of a changing condition at the first sample is not measured (`damper_setting`): the condition may have
    changed just before. An error of it falls with exp(-(t - delay)/lag).

    Args:
        tests: tests of equal conditions.
        fit_of: fits laws to the settled samples of tests, see `choose_law`; its first result is the chosen law.

    Returns:
        The tests with the samples that were fitted as settled, and with a notice on a begin that is left out; the fits.
    """
    setting = tests[0].setting
    if setting is None:
        return tests, fit_of(tests)
    longest = LONGEST * min(float(np.ptp(test.time[test.settled])) for test in tests)
    begin = min(BEGIN, longest)
    while True:
        later = [_without_begin(test, begin) for test in tests]
        fits = fit_of(later)
        values = dict(zip(fits[0].law.parameters, fits[0].parameters.tolist(), strict=True))
        lag, delay = values["lag"], values.get("delay", 0.0)
        if np.exp((delay - begin) / lag) <= LEFT or begin == longest:
            break
        begin = min(delay + LAGS * lag, longest)
    follows = f"the damper follows {setting.name} with a lag of {number(lag, 2)} s"
    text = f"the first {number(begin, 2)} s are not fitted: {follows}"
    if begin == longest:
        text += f"; what {setting.name} was before the record may still count: record longer"
    noted = [dataclasses.replace(test, notices=(*test.notices, text)) for test in later] if begin != BEGIN else later
    return noted, fits


def _without_begin(test: DamperTest, begin: float) -> DamperTest:
    """Return a test whose first settled samples, for a time [s] after the first sample, are not settled."""
    settled = test.settled & (test.time >= test.time[0] + begin)
    return dataclasses.replace(test, waveform=test.waveform._replace(settled=settled))


def _changes(traces: Sequence[Vector]) -> bool:
    """True if a condition changes during one of the tests by more than noise."""
    largest = max(float(np.max(np.abs(values))) for values in traces)
    for values in traces:
        variance = float(np.var(values))
        change = float(np.subtract(*np.percentile(values, (95.0, 5.0))))
        if change > CHANGED * largest and np.mean(np.diff(values) ** 2) < WHITE * variance:
            return True
    return False
