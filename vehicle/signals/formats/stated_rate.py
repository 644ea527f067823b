"""Sampling rate in a file: an attribute or a single number, for example "sample_rate" or "dt_ms"."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from vehicle.signals.formats.units import find_unit

RATES = re.compile(
    r"sampl(e|es|ing)?(rate|freq|frequency|frequenz)|fs|fsampl(e|ing)|fsamp|abtast(rate|frequenz|freq)|samplesper(second|sec|s)|sps"
)
STEPS = re.compile(
    r"dt|deltat|tdelta|sampl(e|es|ing)?(interval|period|time|step)|t(ime)?step|t(ime)?increment|wfincrement|abtast(zeit|intervall|periode)"
)
"""Names of a rate and of a step, in small letters, without signs and without a unit at the end."""

UNSURE = re.compile(r"delta|step|increment|x?incr(ement)?|xdelta|xstep|rate|frequency|freq|deltax|dx|spacing")
"""Names of a rate or step of any quantity, which are shown to the user."""

LONGEST = 40
"""Maximum length of a text that is a number with a unit."""

_UNITS = {"hz": "Hz", "khz": "kHz", "s": "s", "sec": "s", "seconds": "s", "ms": "ms", "us": "us", "ns": "ns"}
_NUMBER = re.compile(r"\s*(?P<number>[+-]?\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s*(?P<unit>[A-Za-z]*)\s*")


def stated_step(numbers: Mapping[str, Any], *, of_time: bool = False) -> tuple[float | None, str]:
    """Return the step of the samples [s] that names and numbers state, and a remark for the user.

    Args:
        numbers: name to value: a number, an array of one number, or a text with number and unit, as "100 Hz".
        of_time: True if a step of any quantity can only be that of the time, for example beside a start and signed
            accelerations; the remark then contains it.

    Returns:
        The step; None if nothing is named as a rate or step, or if several contradict each other. The remark contains a
        possible step, or the contradiction; empty without a remark.
    """
    steps: dict[str, float] = {}
    guesses: dict[str, float] = {}
    unsure = ""
    for key, value in numbers.items():
        plain = re.sub(r"[\W_]", "", key.lower())
        suffix = next((unit for unit in sorted(_UNITS, key=len, reverse=True) if plain.endswith(unit)
                       and re.search(rf"[\W_]{unit}[\W_]*$", key.lower())), "")  # fmt: skip
        name = plain.removesuffix(suffix)
        number, unit = number_of(value)
        unit = unit or _UNITS.get(suffix, "")
        entry = find_unit(unit) if unit else None
        if number is None or not 0.0 < number < np.inf or (unit and entry is None):
            continue
        factor = entry.factor if entry is not None else 1.0
        quantity = entry.quantity if entry is not None else ""
        if (RATES.fullmatch(name) and quantity in ("", "frequency")) or (name == "rate" and quantity == "frequency"):
            steps[key] = 1.0 / (number * factor)
        elif STEPS.fullmatch(name) and quantity in ("", "time"):
            steps[key] = number * factor
        elif UNSURE.fullmatch(name):
            of_rate = name in ("rate", "frequency", "freq")
            guesses[key] = 1.0 / number if of_rate else number
            unsure = (
                f"{key!r} = {number:g}; if this is the {'rate' if of_rate else 'step'} of the samples, set --rate "
                f"{number if of_rate else 1.0 / number:.9g}"
            )
    if not steps and of_time and len(set(guesses.values())) == 1:
        key, step = next(iter(guesses.items()))
        shown = f"{key!r} = {number_of(numbers[key])[0]:g}"
        return step, f"{shown} is taken for the step of the samples ({1.0 / step:.6g} Hz); if it is not, set --rate HZ"
    if not steps:
        return None, unsure
    first, *others = steps.values()
    if any(abs(other / first - 1.0) > 1e-6 for other in others):
        shown = ", ".join(f"{key!r} = {number_of(numbers[key])[0]:g}" for key in steps)
        return None, f"{shown} contradict each other; set --rate HZ"
    return first, ""


def number_of(value: Any) -> tuple[float | None, str]:
    """Return a number and its unit from a number, an array of one number, or a text; None without a number."""
    array = np.ravel(np.asarray(value))
    if array.size != 1:
        return None, ""
    item = array[0]
    if array.dtype.kind in "fiu":
        return float(item), ""
    text = item.decode("utf-8", "replace") if isinstance(item, bytes) else str(item)
    match = _NUMBER.fullmatch(text) if array.dtype.kind in "USO" and len(text) <= LONGEST else None
    return (float(match["number"]), match["unit"]) if match else (None, "")
