"""Numbers for people, with a number of significant digits and no exponent; times; tables of texts."""

import math
from collections.abc import Sequence


def finite(value: float) -> float | None:
    """Return a finite number, or an empty value for NaN and infinity, for which JSON has no sign."""
    return float(value) if math.isfinite(value) else None


def number_in(text: str) -> float:
    """Return the number of a text; NaN for another text."""
    try:
        return float(text)
    except ValueError:
        return math.nan


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


def decimals(error: float) -> int:
    """Return the number of decimals, two to four, with which the half width of an interval is not 0; 2 without one."""
    return min(max(2, -math.floor(math.log10(error))), 4) if 0.0 < error < math.inf else 2


def beside_limit(value: float, limit: float, digits: int = 3) -> tuple[str, str]:
    """Return a value and its limit with as many digits, at least `digits`, as their sizes need to differ."""
    shown = next((more for more in range(digits, 10) if number(abs(value), more) != number(abs(limit), more)), digits)
    return number(value, shown), number(limit, shown)


def duration(seconds: float) -> str:
    """Return a computing time for people: in s below 2 min, in min below 2 h, else in h.

    Args:
        seconds: the time [s].
    """
    for size, unit in ((7200.0, "h"), (120.0, "min")):
        if seconds >= size:
            return f"{number(seconds / (0.5 * size), 2)} {unit}"
    return f"{seconds:.0f} s"


def aligned(rows: Sequence[Sequence[str]], *, left: int = 1) -> list[str]:
    """Return rows of cells as lines with aligned columns.

    Args:
        rows: cells; all rows have the same number.
        left: number of first columns that are aligned left; the others are aligned right.
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if column < left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
