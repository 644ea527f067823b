"""Units of tables as products of powers: "N/mm", "kg m^2", "lbf/in", "N s/m", "Nm/deg"; their factors to SI units."""

import math
import re
from dataclasses import dataclass

from vehicle.signals.formats.units import STANDARD_GRAVITY

Dimension = tuple[int, int, int, int]
"""Powers of kg, m, s and rad."""

POUND, INCH, FOOT = 0.45359237, 0.0254, 0.3048

MASS, LENGTH, TIME, ANGLE, FORCE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (1, 1, -2, 0)
NONE: Dimension = (0, 0, 0, 0)

BASE: dict[str, tuple[Dimension, float]] = {
    **{name: (MASS, factor) for name, factor in {
        "kg": 1.0, "g": 1e-3, "t": 1e3, "to": 1e3, "tonne": 1e3, "lb": POUND, "lbs": POUND, "lbm": POUND,
        "slug": POUND * STANDARD_GRAVITY / FOOT, "slugs": POUND * STANDARD_GRAVITY / FOOT}.items()},
    **{name: (LENGTH, factor) for name, factor in {
        "m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": INCH, "inch": INCH, "inches": INCH, '"': INCH, "ft": FOOT,
        "meter": 1.0, "metre": 1.0, "meters": 1.0, "metres": 1.0, "millimeter": 1e-3, "millimetre": 1e-3,
        "millimeters": 1e-3, "millimetres": 1e-3}.items()},
    **{name: (TIME, factor) for name, factor in {"s": 1.0, "sec": 1.0, "ms": 1e-3}.items()},
    **{name: (ANGLE, factor) for name, factor in {
        "rad": 1.0, "deg": math.pi / 180.0, "°": math.pi / 180.0, "degree": math.pi / 180.0, "grad": math.pi / 180.0,
        "degrees": math.pi / 180.0}.items()},
    **{name: (FORCE, factor) for name, factor in {
        "n": 1.0, "kn": 1e3, "newton": 1.0, "dan": 10.0, "lbf": POUND * STANDARD_GRAVITY, "kgf": STANDARD_GRAVITY,
        "kp": STANDARD_GRAVITY}.items()},
    "hz": ((0, 0, -1, 0), 1.0), "%": (NONE, 1e-2), "-": (NONE, 1.0), "1": (NONE, 1.0),
}  # fmt: skip
"""Unit in small letters -> powers and factor to SI units; `g` is the gram."""

_JOINED = re.compile(r"(kn|n)(mm|m|s)|(kg|slug|lbf?|n)(m|mm|ft|in)", re.IGNORECASE)
"""Units written without a sign between them: Nm, Ns, kgm2."""
_FACTOR = re.compile(r'([a-z%°"]+|1)(?:\^?\(?(-?\d)\)?|)', re.IGNORECASE)


@dataclass(frozen=True, kw_only=True, slots=True)
class Factor:
    """Unit of a table: value in SI units = value * factor."""

    dimension: Dimension
    factor: float


def unit_factor(text: str, expected: Dimension | None = None) -> Factor | None:
    """Return powers and factor of a unit; None for other texts.

    A slash divides by all that follows up to the next one, so N/(m/s) and N s/m are equal. A pound or a kg is a force
    where only this gives the expected dimension: lb/in, kg/mm.

    Args:
        text: unit, for example "N/mm".
        expected: dimension of the quantity; None if it is not listed.
    """
    plain = text.strip().strip("[]").strip().lower()
    for sign, replacement in (("²", "^2"), ("³", "^3"), ("·", " "), ("*", " "), (".", " "), ("–", "-"), ("−", "-")):
        plain = plain.replace(sign, replacement)
    plain = re.sub(r"\bper\b", "/", plain)
    plain = re.sub(r"/ *\( *m */ *s *\)", " s/m", plain)
    plain = re.sub(r"/ *\( *mm */ *s *\)", " s/mm", plain)
    plain = re.sub(r"(?<=[a-z])-(?=[a-z])", " ", plain).replace("(", " ").replace(")", " ").strip()
    content = _product(plain)
    if content is not None and expected is not None and content.dimension != expected:
        force = _product(re.sub(r"\b(lb|kg)s?\b", r"\1f", plain))
        content = force if force is not None and force.dimension == expected else content
    return content


def _product(text: str) -> Factor | None:
    if not text:
        return None
    dimension, factor = [0, 0, 0, 0], 1.0
    for index, group in enumerate(text.split("/")):
        for word in group.split():
            for name, power in _words(word):
                if name not in BASE:
                    return None
                powers, size = BASE[name]
                sign = power if index == 0 else -power
                dimension = [a + sign * b for a, b in zip(dimension, powers, strict=True)]
                factor *= size**sign
    return Factor(dimension=(dimension[0], dimension[1], dimension[2], dimension[3]), factor=factor)


def _words(word: str) -> list[tuple[str, int]]:
    """Return the units of a word without signs between them, and their powers."""
    match = _FACTOR.fullmatch(word)
    if match is None:
        return [(word, 1)]
    name, power = match[1], int(match[2] or 1)
    if name in BASE:
        return [(name, power)]
    joined = _JOINED.fullmatch(name)
    if joined is None:
        return [(name, power)]
    first, second = (joined[1], joined[2]) if joined[1] else (joined[3], joined[4])
    return [(first, 1), (second, power)]
