"""Exercise of the course: solution by a closed form, and the wrong results of known mistakes."""

import re
from dataclasses import dataclass

from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.signals.formats.units import find_ratio

FACTORS = {"-": 1.0, "%": 0.01, "N s/m": 1.0, "Ns/m": 1.0, "kN s/m": 1e3, "N s/mm": 1e3}
"""Units that are unknown in measurement files, with the factor to SI."""

SIMILAR = {"-": ("%",), "N s/m": ("Ns/m", "kN s/m", "N s/mm")}
"""Units among `FACTORS` of the same quantity."""

POWERS = {1e3: "1000 times too large", 1e-3: "1000 times too small"}
"""Factor of a result that confuses a unit with its thousandth."""


@dataclass(frozen=True, slots=True)
class Slip:
    """A known mistake.

    Attributes:
        value: result with this mistake, in the unit of the exercise.
        hint: step to repeat; without the solution.
    """

    value: float
    hint: str


@dataclass(frozen=True, slots=True)
class Exercise:
    """Exercise whose solution is a number.

    Attributes:
        value: solution, in `unit`.
        unit: unit of the solution on the page.
        tolerance: relative tolerance: rounding to three digits, below half of the distance to the nearest slip.
        slips: known mistakes.
        remedy: hint for any other wrong result.
    """

    value: float
    unit: str
    tolerance: float
    slips: tuple[Slip, ...]
    remedy: str

    def verdict(self, text: str) -> str:
        """Return "right" with the solution, or "not yet" with a hint.

        Args:
            text: number with its unit, for example "1.2 mm"; the unit is optional for a ratio.

        Raises:
            ConfigurationError: no number.
        """
        match = re.fullmatch(r"\s*([-+]?\d*\.?\d+(?:[eE][-+]?\d+)?)\s*(.*?)\s*", text)
        if match is None:
            raise ConfigurationError(f"{text!r}: no number; type a number and its unit, for example '12 {self.unit}'")
        unit = match[2] or "-"
        factor = self._factor(unit)
        if factor is None:
            fault = f"{unit} is no unit of this answer" if match[2] else "the unit is missing"
            return f"not yet: {fault}; the answer is in {self.unit}"
        value = float(match[1]) * factor
        if self._agrees(value, self.value):
            return f"right: {number(self.value)} {self.unit}".removesuffix(" -")
        for slip in self.slips:
            if self._agrees(value, slip.value):
                return f"not yet: {slip.hint}"
        for power, size in POWERS.items():
            if self._agrees(value, power * self.value):
                return f"not yet: {size}: write all quantities in SI units first (1 mm = 0.001 m)"
        if self._agrees(-value, self.value):
            return "not yet: look at the sign"
        return f"not yet: {self.remedy}"

    def _agrees(self, value: float, reference: float) -> bool:
        return abs(value - reference) <= self.tolerance * abs(reference)

    def _factor(self, unit: str) -> float | None:
        """Return the factor from a typed unit to the unit of the exercise; None if the quantities differ."""
        if self.unit in FACTORS:
            same = unit == self.unit or unit in SIMILAR.get(self.unit, ())
            return FACTORS[unit] / FACTORS[self.unit] if same else None
        typed, asked = find_ratio(unit), find_ratio(self.unit)
        if typed is None or asked is None or typed.si != asked.si:
            return None
        return typed.factor / asked.factor
