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


def duration(seconds: float) -> str:
    """Return a computing time for people: in s below 2 min, in min below 2 h, else in h.

    Args:
        seconds: the time [s].
    """
    for size, unit in ((7200.0, "h"), (120.0, "min")):
        if seconds >= size:
            return f"{number(seconds / (0.5 * size), 2)} {unit}"
    return f"{seconds:.0f} s"
