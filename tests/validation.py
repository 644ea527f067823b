"""Rows that tests of physical claims record, and the page `docs/validation.md`, which is written from them.

A test calls `validated` instead of an assertion. `python -m tests.validation [FILES]` runs the tests of these files (by
default of all that call it) and writes their rows into the page. In any other run, each test is compared with its
rows there.
"""

import math
import os
import re
import sys
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

EVIDENCE = (
    *("closed form", "second derivation", "foreign code", "standard", "publication", "conservation"),
    "own function",
)
"""First words of a source: kinds of evidence, columns of the summary."""

SUBJECTS = {
    "Static equilibrium": "Wheel loads, preloads and rest of the complete car.",
    "Dampers and friction": "Force laws of dampers, Coulomb and Stribeck friction, tables, degressive valves.",
    "Bushings, springs and stops": "Laws of connections, Maxwell branches, attachments to the body, tables, stops.",
    "Tyres": "Tyres on a moving plate, tyres that can lift off, rolling tyres.",
    "Applied forces": "Forces and moments on parts, torques on joints, imbalance of rolling wheels, orders.",
    "Suspension kinematics": "Wheel travel, camber and toe of struts and twist beams; compliance of an axle.",
    "Body models": "Beams, imported finite elements, reduction by Rubin and by Craig and Bampton, modal tests.",
    "Integration in MuJoCo": "Time integration: order of convergence, step, energy, compiled laws, FRFs from runs.",
    "Reduced engine": "The car as a sum over its poles, against MuJoCo and stiff solvers.",
    "Linear system": "Matrices, poles, natural modes and participation of the linearised car.",
    "Quarter and half cars": "Lumped models, bumps, settling, road holding.",
    "Semi-active dampers": "Skyhook, groundhook and hybrid control, in both engines and the lumped half car.",
    "Exported FMUs": "Cars written as FMUs of FMI 2.0 and 3.0 (a C program), against the reduced engine.",
    "FRF estimation and spectra": "FRF, coherence, local rational models, spectra, record alignment.",
    "Comfort, ISO 2631": "Frequency weightings, weighted RMS, MTVV, dose values, SEAT value.",
    "Load histories": "Rainflow counts and equivalent amplitudes.",
    "File readers": "Measurement files of loggers and foreign programs; matrices and modes of finite elements.",
    "Roads and excitation": "ISO 8608 roads, contact patch, bumps, shaker signals.",
    "Sweeps, tuning and optimisation": "Sensitivity indices, parameter fits, Pareto fronts, drive replication.",
    "Statistics and intervals": "Standard errors, effective averages, probability that a value lies in an interval.",
    "Published cars": "Values printed by Bommer 2006, the half car with rider and the choice of dampers.",
}
"""Sections of the page in their order, and what each contains."""


@dataclass(frozen=True)
class Row:
    """A claim as on the page; all cells are text.

    Attributes:
        subject: section of the page.
        claim: statement that is checked.
        expected, computed: values with unit.
        tolerance: allowed deviation.
        used: largest deviation as a share of the tolerance.
        source: kind of evidence and place of the expected value.
        test: node of the test, as pytest names it.
        agrees: True if the deviation is at most the tolerance.
        reason: explanation of a known disagreement; empty if there is none.
    """

    subject: str
    claim: str
    expected: str
    computed: str
    tolerance: str
    used: str
    source: str
    test: str
    agrees: bool = True
    reason: str = ""


UNQUOTED = str.maketrans('"|', "'/")
RECORDED: dict[str, list[Row]] = {}
"""Rows of this process by test."""


def validated(
    subject: str,
    claim: str,
    value: Any,
    expected: Any,
    *,
    source: str,
    rel: float = 0.0,
    abs: float = 0.0,
    peak: float = 0.0,
    within: tuple[float, float] | None = None,
    unit: str = "",
    reason: str = "",
) -> None:
    """Record a row of the validation page, and raise AssertionError if the claim does not hold.

    A value agrees if its deviation is at most the largest of rel |expected|, abs and peak max |expected|. Without any
    of them, only an equal value agrees.

    Args:
        subject: section of the page, one of `SUBJECTS`.
        claim: statement that is checked, unique in its section.
        value: computed by the code under test, number or array, real or complex.
        expected: of the same shape, or one number for all.
        source: first words of `EVIDENCE`, a colon, and where the expected value comes from.
        rel: tolerance relative to each expected value.
        abs: tolerance in the unit of the value.
        peak: tolerance relative to the largest magnitude of the expected values.
        within: lowest and highest allowed value, instead of a tolerance.
        unit: of value and expected; empty without one.
        reason: explanation of a known disagreement; the claim must then not hold.
    """
    assert subject in SUBJECTS, f"subject: found {subject!r}, must be one of {', '.join(SUBJECTS)}"
    assert source.split(": ")[0] in EVIDENCE, f"source: found {source!r}, must begin with one of {', '.join(EVIDENCE)}"
    got, want = np.asarray(value), np.asarray(expected)
    same = got.size > 0 and (want.ndim == 0 or got.shape == want.shape)
    high = float(np.max(np.abs(want), initial=0.0))
    allowed = np.maximum(np.maximum(rel * np.abs(want), abs), peak * high)
    gap = np.abs(got - want) if same else np.array(np.inf)
    if within is not None:
        allowed = np.where(np.real(got) < want, want - within[0], within[1] - want)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = float(np.max(np.where(gap == 0.0, 0.0, gap / allowed), initial=0.0))
    agrees = same and share <= 1.0
    finest = float(np.max(allowed)) / 10.0
    row = Row(
        subject=subject,
        claim=claim,
        expected=_values(want, finest, unit),
        computed=_values(got, finest, unit),
        tolerance=_tolerance(rel, abs, peak, within, unit),
        used=_share(share),
        source=source,
        test=current_test(),
        agrees=agrees,
        reason=reason,
    )
    RECORDED.setdefault(row.test, []).append(row)
    if reason:
        assert not agrees, f"{claim}: agrees now; remove its reason: {reason}"
        return
    assert agrees, (
        f"{claim}: computed {value}, expected {expected}, tolerance {row.tolerance}, used {row.used}; {source}"
    )


def current_test() -> str:
    """Return the node of the test that runs; without the characters that end a cell or a title of the page."""
    return os.environ["PYTEST_CURRENT_TEST"].rsplit(" (", 1)[0].translate(UNQUOTED)


def foreign(package: str, what: str = "") -> str:
    """Return the source text of a foreign package with its installed version."""
    return f"foreign code: {package} {version(package)}{', ' if what else ''}{what}"


def own_function(package: str, what: str) -> str:
    """Return the source text of a foreign solver that integrates equations, matrices or laws of this program."""
    return f"own function: {what}, solved by {package} {version(package)}"


def _values(values: Any, finest: float, unit: str) -> str:
    """Return a number, or the range of magnitudes of an array, to four digits or a tenth of the tolerance."""
    if values.size == 1 and not np.iscomplexobj(values):
        return f"{_number(float(values.reshape(())), finest)} {unit}".strip()
    ends = [_number(float(end), finest) for end in (np.min(np.abs(values)), np.max(np.abs(values)))]
    text = f"{ends[0] if ends[0] == ends[1] else ' to '.join(ends)} {unit}".strip()
    return f"{text} ({values.size} values)" if values.size > 1 else f"{text} (magnitude)"


def _number(value: float, finest: float = 0.0, digits: int = 4) -> str:
    """Return a number with at most these digits, 0 below the finest resolution."""
    if math.isfinite(value) and value != 0.0 and math.isfinite(finest) and finest > 0.0:
        digits = min(digits, math.floor(math.log10(abs(value))) - math.floor(math.log10(finest)) + 1)
    if digits <= 0:
        return "0"
    return re.sub(r"e([+-])0*", lambda found: "e" + found[1].strip("+"), f"{float(f'{value:.{digits - 1}e}'):.6g}")


def _tolerance(rel: float, absolute: float, peak: float, within: tuple[float, float] | None, unit: str) -> str:
    """Return the tolerance as text."""
    if within is not None:
        return f"{_number(within[0])} to {_number(within[1])} {unit}".strip()
    parts = [
        *([_percent(rel)] if rel else []),
        *([f"{_number(absolute, digits=2)} {unit}".strip()] if absolute else []),
        *([f"{_percent(peak)} of the largest"] if peak else []),
    ]
    return " or ".join(parts) or "equal"


def _percent(share: float) -> str:
    """Return a share in percent, or as a power of ten below 0.01 %."""
    return f"{_number(100.0 * share, digits=2)} %" if share >= 1e-4 else f"{_number(share)} relative"


def _share(share: float) -> str:
    """Return a share of the tolerance in percent, rounded up to one digit."""
    if share == 0.0:
        return "0"
    if share <= 0.01:
        return "< 1 %"
    if not share <= 10.0:
        return "more than 10 times"
    size = 10.0 ** math.floor(math.log10(100.0 * share))
    return f"{math.ceil(100.0 * share / size - 1e-9) * size:g} %"


if __name__ == "__main__":
    from tests.validation_page import main

    raise SystemExit(main(sys.argv[1:]))
