"""Range of the tests that the law of a damper or of a bushing was fitted to, stored with the law.

The range belongs to the numbers beside it: a base car, a table of one side or an override that changes one of them
without a range of its own removes the range. No force depends on it; a run compares its motion with it
(`vehicle.runs.car.outside_tests`).
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from vehicle.digits import rounded
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import quantity, validate
from vehicle.names import AXES

RANGE = "tested"
"""Key of the range in the table of a law."""

NO_PART_OF_A_FIT = frozenset(
    (RANGE, "slip_velocity", "smoothing", "side_force_coefficient", "gas_force", "stop", "control")
)
"""Keys of a law whose change leaves the range valid."""

BAND = "band_"
"""First letters of the keys of the band of the force."""

Range = tuple[float, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class TestedRange:
    """Lowest and highest values of the tests of a law; no force depends on them.

    A run states the share of time with velocities of a damper outside `velocity`, if the comfort depends on the
    continuation of the law there. The other values describe the tests for the reader of the file.
    """

    __test__ = False  # no class of tests for pytest

    velocity: Range | None = quantity(
        "m/s", "highest velocities of the slowest and of the fastest test of a damper; a run states times outside",
        at_least=0.0, at_most=10.0, length=2, default=None,
    )  # fmt: skip
    amplitude: Range | None = quantity(
        "m", "smallest and largest amplitude of the tests, half of peak to peak; for information only", at_least=0.0,
        at_most=1.0, length=2, default=None,
    )  # fmt: skip
    frequency: Range | None = quantity(
        "Hz", "lowest and highest frequency of the tests; for information only", at_least=0.0, at_most=1e4, length=2,
        default=None,
    )  # fmt: skip
    temperature: Range | None = quantity(
        "degC", "lowest and highest temperature of the tests; for information only", at_least=-273.15, at_most=1e3,
        length=2, default=None,
    )  # fmt: skip
    current: Range | None = quantity(
        "A", "lowest and highest coil current of the tests; for information only", at_least=-100.0, at_most=100.0,
        length=2, default=None,
    )  # fmt: skip

    band_velocity: Range = quantity(
        "m/s", "ascending velocities of the band of the force of a damper, without zero, as many below as above zero; "
        "`Car.law_band` runs its edges", at_least=-20.0, at_most=20.0, default=(),
    )  # fmt: skip
    band_soft: Range = quantity(
        "N", "lowest force of the band minus the force of the law, in the direction of the velocity: at most zero, one "
        "value for each of `band_velocity`", at_least=-1e6, at_most=1e6, default=(),
    )  # fmt: skip
    band_firm: Range = quantity(
        "N", "highest force of the band minus the force of the law, in the direction of the velocity: at least zero, "
        "one value for each of `band_velocity`", at_least=-1e6, at_most=1e6, default=(),
    )  # fmt: skip

    def __post_init__(self) -> None:
        validate(self)
        velocity = self.band_velocity
        if not len(velocity) == len(self.band_soft) == len(self.band_firm):
            raise ConfigurationError(
                f"TestedRange.band_velocity: found {len(velocity)} velocities, {len(self.band_soft)} changes at the "
                f"soft and {len(self.band_firm)} at the firm edge; give as many of each"
            )
        if (
            list(velocity) != sorted(set(velocity))
            or 0.0 in velocity
            or 2 * sum(v > 0.0 for v in velocity) != len(velocity)
        ):
            raise ConfigurationError(
                f"TestedRange.band_velocity: found {list(velocity)}, must be ascending, without zero, and as many "
                "below as above zero; sort them, each with its two changes"
            )
        for name, sign, limit in (("band_soft", 1.0, "at most"), ("band_firm", -1.0, "at least")):
            wrong = next((at for at, change in enumerate(getattr(self, name)) if sign * change > 0.0), None)
            if wrong is not None:
                raise ConfigurationError(
                    f"TestedRange.{name}: found {getattr(self, name)[wrong]:g} N at {velocity[wrong]:g} m/s, must be "
                    f"{limit} 0: band_soft and band_firm are changes of the force of the law in the direction of the "
                    "velocity; subtract the force of the law, or exchange both edges"
                )
        for entry in fields(self):
            values = getattr(self, entry.name)
            if values is not None and not entry.name.startswith(BAND) and values[0] > values[1]:
                raise ConfigurationError(
                    f"TestedRange.{entry.name}: found {list(values)}, must be the lowest and the highest value of the "
                    "tests, in this order"
                )


def range_lines(tested: Mapping[str, Range]) -> list[str]:
    """Return the lines of a range for the table of a law.

    Args:
        tested: lowest and highest values of the tests, or values of the band, by key.
    """
    units = {entry.name: entry.metadata["unit"] for entry in fields(TestedRange)}
    texts = {name: "band of the force" if name.startswith(BAND) else "range of the tests" for name in tested}
    return [
        f"{RANGE}.{name} = {[rounded(value, 4) for value in values]!r}  # [{units[name]}] {texts[name]}"
        for name, values in tested.items()
    ]


def merged_law(below: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """Return the table of a law with the values of a second table, without a range that they make invalid.

    Args:
        below: table of a base car or of both sides.
        above: values that take precedence.
    """
    merged = {**below, **above}
    changed = (key for key in above if key not in NO_PART_OF_A_FIT and above[key] != below.get(key))
    if RANGE in below and RANGE not in above and any(changed):
        del merged[RANGE]
    return merged


class StaleRanges:
    """Ranges of laws whose values change by overrides; values of a range that are set afterwards remain."""

    def __init__(self) -> None:
        self._set_again: dict[str, set[str]] = {}

    def note(self, path: str, *, changed: bool) -> None:
        """Record an override.

        Args:
            path: whole path of the value, or of a component.
            changed: True if the value differs from the value before.
        """
        *parents, name = path.split(".")
        if name in AXES and parents:
            name = parents.pop()
        law = ".".join(parents)
        if name == RANGE:
            self._set_again.pop(law, None)
        elif law.endswith(f".{RANGE}"):
            self._set_again.get(law.removesuffix(f".{RANGE}"), set()).add(name)
        elif changed and name not in NO_PART_OF_A_FIT:
            self._set_again[law] = set()

    def remove_from(self, table: Mapping[str, Any]) -> None:
        """Remove the ranges from a vehicle file in place; the tables of their laws are changed."""
        for path, names in self._set_again.items():
            law: Any = table
            for key in path.split("."):
                law = law.get(key) if isinstance(law, Mapping) else None
            if isinstance(law, dict) and isinstance(law.get(RANGE), Mapping):
                law[RANGE] = {name: value for name, value in law[RANGE].items() if name in names}
                if not names:
                    del law[RANGE]
