"""Laws of a damper fitted to its tests, one for each set of conditions."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from os import PathLike
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.errors import ConfigurationError
from vehicle.signals.records.choice import Choice
from vehicle.studies.dampers.conditions import by_conditions, fitted_beyond_lag, with_setting
from vehicle.studies.dampers.damper_choice import choose_law
from vehicle.studies.dampers.damper_fit import DamperFit, kind_of, limits_of
from vehicle.studies.dampers.damper_law import LINEAR, values_of
from vehicle.studies.dampers.damper_ranges import speeds_of
from vehicle.studies.dampers.damper_test import DamperTest, read_test
from vehicle.studies.dampers.direction import require_direction

SLOW = 0.01
"""Maximum velocity [m/s] of a test that shows friction near rest."""

AT_LIMIT = 1.02
"""Ratio to a limit of its range within which a parameter counts as being there."""

ERRORS = 2.0
"""Standard errors by which a mean force has the wrong sign for gas."""

READING, HALF_OF_LAWS = 0.05, 15.0
"""Share of the progress for the reading of the files, and number of compared laws at half of a fit."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FittedDamper:
    """Tests of equal conditions with their law.

    Attributes:
        conditions: name of a condition to its value; may be empty.
        tests: the tests.
        fit: the chosen law.
        compared: all laws that were compared, by their errors on tests left out.
        changing: soft and firm law together, with lag and delay, of a condition that changes during the tests; `fit`
            is then the law at the condition of `conditions`.
    """

    conditions: Mapping[str, float]
    tests: Sequence[DamperTest]
    fit: DamperFit
    compared: Sequence[DamperFit]
    changing: DamperFit | None = None

    def settings(self) -> list[FittedDamper]:
        """Return the fit, or soft and firm law of a condition that changes during the tests."""
        setting = self.tests[0].setting
        if setting is None:
            return [self]
        return [
            dataclasses.replace(
                self, conditions={**self.conditions, setting.name: rounded(value, 3)}, changing=self.fit,
                fit=self.fit.at_setting(firm), compared=[fit.at_setting(firm) for fit in self.compared],
            )
            for firm, value in ((False, setting.lowest), (True, setting.highest))
        ]  # fmt: skip

    def force(self, test: DamperTest) -> Vector:
        """Return the force under the motion of a test and its changing condition, if it has one [N]; (n,)."""
        fit = self.fit if self.changing is None else self.changing
        return fit.force(test)

    @property
    def name(self) -> str:
        """Conditions in words for file names, for example "_current_1"; empty without conditions."""
        return "".join(f"_{name}_{value:g}" for name, value in self.conditions.items())

    @property
    def condition_words(self) -> str:
        """Conditions in words, for example "current 1, clicks 4"; empty without conditions."""
        return ", ".join(f"{name} {value:g}" for name, value in self.conditions.items())

    @property
    def speeds(self) -> tuple[float, float]:
        """Highest velocities of the slowest and of the fastest test [m/s]."""
        return speeds_of(self.tests)

    @property
    def accepted(self) -> list[DamperFit]:
        """Return the laws within the tolerance of the choice, see `damper_choice`."""
        return [fit for fit in self.compared if fit.accepted]

    @property
    def tested(self) -> dict[str, tuple[float, float]]:
        """Lowest and highest values of the tests, by their keys in `TestedRange`."""
        values = {
            "velocity": list(self.speeds),
            "amplitude": [0.5 * float(np.ptp(test.displacement)) for test in self.tests],
            "frequency": [1.0 / test.cycle for test in self.tests],
        }
        values |= {name: [self.conditions[name]] for name in ("temperature", "current") if name in self.conditions}
        return {name: (min(each), max(each)) for name, each in values.items()}

    def curve(self, velocity: Vector) -> Vector:
        """Return the force of the curve F_c [N] at velocities [m/s]; (n,)."""
        values = values_of(self.fit.law, self.fit.parameters)
        force = np.zeros(velocity.size)
        sides = velocity > 0.0, velocity <= 0.0
        for side, slopes, widths in zip(sides, values.slopes, values.widths, strict=True):
            ends = np.concatenate([[0.0], np.cumsum(widths)])
            for start, width, slope in zip(ends, [*widths, np.inf], slopes, strict=True):
                force += side * np.sign(velocity) * slope * np.clip(np.abs(velocity) - start, 0.0, width)
        return force

    def curve_damping(self) -> float:
        """Return the damping constant with the work of the curve F_c in these tests, sum F_c v / sum v^2 [N s/m]."""
        v = np.concatenate([test.velocity[test.settled] for test in self.tests])
        return float(np.sum(self.curve(v) * v) / np.sum(v**2))

    def left_open(self) -> list[str]:
        """Return texts on the parameters that the tests do not determine."""
        slowest, fastest = self.speeds
        law, fit = self.fit.law, self.fit
        sentences = []
        if slowest > SLOW:
            sentences.append(
                f"friction at rest: the slowest test reaches {1e3 * slowest:.3g} mm/s, must be below "
                f"{1e3 * SLOW:.0f} mm/s"
            )
        sentences.append(f"forces above {fastest:.3g} m/s, the fastest test: the curve continues with its last slope")
        if len(self.tests) == 1:
            sentences.append("other strokes and frequencies: there is a single test")
        mean_force = -float(fit.values[0])
        if mean_force > ERRORS * float(fit.errors[0]):
            sentences.append(
                f"gas force: the mean force is {mean_force:.3g} N in extension, but gas pushes the rod out: an offset "
                "of the load cell; the lines have 0 N"
            )
        low, high = limits_of(law)
        for name, value, lowest, highest, determined in zip(
            law.parameters, fit.parameters, low, high, fit.determined, strict=True
        ):
            if name not in LINEAR and not lowest * AT_LIMIT < value < highest / AT_LIMIT:
                quantity = kind_of(name).replace("_", " ")
                sentences.append(f"{quantity}: {name} is at the limit of its range")
            elif not determined and name not in LINEAR:
                sentences.append(f"{name}: its standard error is above half of its value")
        return sentences


def fit_damper(
    files: Sequence[str | PathLike[str]], choice: Choice | None = None, *, compression: bool | None = None,
    conditions: Mapping[str, str] | None = None, pattern: str = "", progress: Callable[[float], None] | None = None,
) -> list[FittedDamper]:  # fmt: skip
    """Fit the law of a damper to records of a test machine: one law for each set of conditions.

    Args:
        files: measurement files of any format, with displacement, force, and velocity if measured.
        choice: channels, units and excerpt; see `vehicle.studies.dampers.damper_test.read_test`.
        compression: True if the files are positive in compression, False in extension; None for extension, unless bump
            damps more than rebound.
        conditions: name of a condition to a number, to numbers of all files as "0,0.5,1", or to "channel:NAME".
        pattern: pattern of the file names with conditions in braces, for example "*Hz{current}A".
        progress: called with the finished fraction.

    Returns:
        Fits sorted by their conditions; `fits[0].fit.values` are the parameters in the order of `fit.law.parameters`.
        A condition that changes during the tests gives two fits, at its lowest and at its highest value.

    Raises:
        ConfigurationError: no file, a file twice or missing, or wrong conditions.
        DataError: bad data in a file, or files of the other direction.
    """
    tell = progress or (lambda fraction: None)
    paths = [Path(file) for file in files]
    if not paths or len(set(paths)) < len(paths):
        raise ConfigurationError(f"found {len(paths)} files of tests; name at least one, each once")
    typed = _typed(conditions or {}, len(paths))
    tests = []
    for path, of_file in zip(paths, typed, strict=True):
        tests.append(read_test(path, choice, compression=bool(compression), conditions=of_file, pattern=pattern))
        tell(READING * len(tests) / len(paths))
    require_direction(tests, compression)
    tests = with_setting(tests)
    fitted: list[FittedDamper] = []
    groups = by_conditions(tests).values()
    for group in groups:

        def of_laws(count: int) -> None:
            # The number of laws is not known before: 25 to 45 are usual.
            tell(READING + (1.0 - READING) * (len(fitted) + count / (count + HALF_OF_LAWS)) / len(groups))

        fitted_tests, (fit, compared) = fitted_beyond_lag(group, partial(choose_law, progress=of_laws))
        fitted.append(FittedDamper(conditions=group[0].conditions, tests=fitted_tests, fit=fit, compared=compared))
    tell(1.0)
    return [each for whole in fitted for each in whole.settings()]


def _typed(conditions: Mapping[str, str], files: int) -> list[dict[str, str]]:
    """Return the conditions of each file: one value for all, or values of all files with commas between them."""
    columns = {}
    for name, text in conditions.items():
        values = [text] if text.startswith("channel:") else text.split(",")
        if len(values) not in (1, files):
            raise ConfigurationError(
                f"--condition {name}={text}: found {len(values)} values for {files} files; give one value for all "
                "files, or one for each"
            )
        columns[name] = values * (files // len(values))
    return [{name: values[number] for name, values in columns.items()} for number in range(files)]
