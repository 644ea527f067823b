"""Verdict of a row: agrees, disagrees, or undecided where the uncertainty of our value decides it."""

from collections.abc import Callable, Iterable

Verdict = bool | None
"""True: agrees; False: disagrees; None: undecided."""

ERRORS = 2.0
"""Half width of the interval of our value [standard errors]: 95 % of normal values."""


def verdict(holds: Callable[[float], object], value: float, error: float = 0.0) -> Verdict:
    """Return the verdict of a statement that holds at the value and at both ends of value +- 2 error.

    Args:
        holds: function of a value that returns True if the statement holds; its values form one interval.
        value: our value, a mean over noise seeds, roads or windows.
        error: standard error of the value, in its unit; 0 for a value that depends on no random input.

    Returns:
        The verdict at all three values; None (undecided) where they differ: another seed may turn the row.
    """
    return common(holds(value + factor * error) for factor in (-ERRORS, 0.0, ERRORS))


def common(verdicts: Iterable[object]) -> Verdict:
    """Return the common verdict of all seeds, windows or readings of a statement; None (undecided) if they differ."""
    distinct = {bool(verdict_of_seed) for verdict_of_seed in verdicts}
    return distinct.pop() if len(distinct) == 1 else None
