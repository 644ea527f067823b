"""Conditions of a damper test: numbers, values from the name of its file, and channels."""

import dataclasses
import re
from collections.abc import Mapping

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.errors import ConfigurationError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.records.choice import Choice, choose, pick
from vehicle.studies.dampers.record_checks import is_copy

MEASURED = ("time", "displacement", "velocity", "force")
"""Quantities of a test, which are no conditions."""

CHANNEL = "channel:"
"""First letters of a condition that is a channel of the file."""


def condition_values(
    measurement: Measurement, choice: Choice, typed: Mapping[str, str], pattern: str, measured: Mapping[str, Vector]
) -> tuple[dict[str, float], dict[str, Vector]]:
    """Return the conditions of a test: typed, the mean of a channel, or from the name of the file; and the channels.

    Args:
        choice: channels of the quantities of the test.
        typed: name of a condition to a number, or to "channel:NAME".
        pattern: pattern of the file name with conditions in braces; may be empty.
        measured: quantity of the test to its samples; (n,) each.

    Raises:
        ConfigurationError: a wrong number or pattern, a condition with the name or the values of a measured quantity,
            or a channel that is chosen twice.
        DataError: see `choose`.
    """
    columns = {role: pick(measurement, wanted) for role, wanted in choice.channels.items()}
    values: dict[str, float] = {}
    traces: dict[str, Vector] = {}
    plain = dataclasses.replace(choice, detrend=False, highpass=None)
    for name, text in typed.items():
        option = f"--condition {name}={text}"
        _require_condition(option, name)
        if not text.startswith(CHANNEL):
            values[name] = _number(text, option)
            continue
        wanted = text.removeprefix(CHANNEL)
        column = pick(measurement, wanted, option="--condition")
        other = next((role for role, used in columns.items() if used == column), None)
        if other is None:
            channels = {role: choice.channels[role] for role in ("time", "displacement") if role in choice.channels}
            trace = choose(measurement, dataclasses.replace(plain, channels=channels | {name: wanted})).values[name]
            other = next((role for role, samples in measured.items() if is_copy(samples, trace)), None)
        if other is not None:
            raise ConfigurationError(
                f"{measurement.path}: {option}: channel {column + 1} {measurement.channels[column].name!r} contains "
                f"the {other} of this test; choose the channel of the condition, or leave this option out"
            )
        columns[name], traces[name] = column, trace
        values[name] = rounded(float(np.mean(trace)), 3)
    for name, text in _from_name(measurement.path.stem, pattern):
        _require_condition(f"--pattern {pattern}", name)
        if name in values:
            raise ConfigurationError(f"--pattern {pattern}: gives the condition {name} a second time; name it once")
        values[name] = _number(re.sub("[x,]", ".", text), pattern)
    return values, traces


def _from_name(stem: str, pattern: str) -> list[tuple[str, str]]:
    """Return names and texts of the conditions in the name of a file; none without a pattern."""
    if not pattern:
        return []
    names = re.findall(r"\{(\w+)\}", pattern)
    parts = re.split(r"(\{\w+\}|\*)", pattern)
    form = "".join(
        ".*?" if part == "*" else r"(-?\d+(?:[.x,]\d+)?)" if part.startswith("{") else re.escape(part) for part in parts
    )
    match = re.fullmatch(form, stem)
    if not names or match is None:
        raise ConfigurationError(
            f"--pattern {pattern}: {'has no {condition}' if not names else f'does not match {stem}'}; "
            "write the file name with the condition in braces and * for the rest, for example "
            f"'*Hz{{current}}A'"
        )
    return list(zip(names, match.groups(), strict=True))


def _require_condition(option: str, name: str) -> None:
    """Check that a condition has no name of a measured quantity."""
    if name in MEASURED:
        raise ConfigurationError(
            f"{option}: {name} is a measured quantity, not a condition of the test; name a condition, for example "
            f"current or temperature, or choose the channel of the {name} with --channel {name}=NAME"
        )


def _number(text: str, where: str) -> float:
    """Return a number; raise ConfigurationError with the option."""
    try:
        return float(text)
    except ValueError:
        raise ConfigurationError(f"{where}: must be a number, or channel:NAME") from None
