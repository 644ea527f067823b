"""Numbers for people, with a number of significant digits and no exponent."""

from __future__ import annotations


def rounded(value: float, digits: int) -> float:
    """Return a value rounded to a number of significant digits."""
    return float(f"{value:.{digits}g}")


def number(value: float | None, digits: int = 3) -> str:
    """Return a number with a number of significant digits, without an exponent below ten billion; a dash for None.

    Args:
        value: the number.
        digits: significant digits; 100 with one is "100", not "1e+02".
    """
    return "–" if value is None else f"{rounded(value, digits):.10g}"
