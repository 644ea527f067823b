"""Published statements about the low, mid and high level beside ours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from scenarios.claim import Claim, interval_claim, number_claim, statement_claim
from scenarios.levels_figures import CHANNELS
from vehicle.analysis.frf import FrequencyResponse
from vehicle.car import Run

Vector = npt.NDArray[np.float64]

PUBLISHED_SLIP = {"low": (0.0, 0.0), "mid": (0.039, 0.0), "high": (0.218, 0.0)}
"""Share of the time in slip of the right and the left damper (table 3.2)."""

SLIP_TOLERANCE = 0.03
"""Three points: what a quarter of the slip velocity, which is not published, changes in the high level. One record of
60 s alone tells the share to 0.2 points (mid) and 0.6 points (high; standard error of its twelfths)."""

FRF_AXIS = (1e1, 1e5)
"""Ends of the axes of the FRFs [(m/s2)/m]."""

WHEEL_BAND = (20.0, 35.0)
"""The vertical wheel mode is looked for here [Hz]."""

BODY_BAND = (3.0, 10.0)
"""The rigid body modes that the input drives [Hz]."""

DAMPER_BAND = (10.0, 50.0)
"""Damper top and knuckle are compared here [Hz]: below, both move with the body and differ by its rotation."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LevelNumbers:
    """What is read off one level.

    Attributes:
        slip: share of the time above the slip velocity, right and left.
        saturated: the same above 1 mm/s.
        wheel_hz: frequency [Hz] in `WHEEL_BAND` where the phase of the knuckle falls through 90 deg, or NaN.
        wheel_peak_hz, wheel_peak: largest line of the knuckle in `WHEEL_BAND` [Hz], [m/s2 per m].
        body_peak: largest line of the knuckle in `BODY_BAND` [m/s2 per m].
        damper_ratio: |H| of the damper top over that of the knuckle, geometric mean over `DAMPER_BAND` [-].
    """

    slip: tuple[float, float]
    saturated: tuple[float, float]
    wheel_hz: float
    wheel_peak_hz: float
    wheel_peak: float
    body_peak: float
    damper_ratio: float


def numbers(run: Run, response: FrequencyResponse) -> LevelNumbers:
    """Read the numbers off one run and its FRFs (rows as `CHANNELS`)."""
    complex_knuckle = response.response[CHANNELS.index("knuckle_fr_acc_z")]
    knuckle, top = np.abs(complex_knuckle), np.abs(response.response[CHANNELS.index("damper_top_fr_acc_z")])
    frequency = response.frequency
    wheel, body, damper = (
        (frequency >= band[0]) & (frequency <= band[1]) for band in (WHEEL_BAND, BODY_BAND, DAMPER_BAND)
    )
    return LevelNumbers(
        slip=(run.slip_share("fr"), run.slip_share("fl")),
        saturated=(run.slip_share("fr", 1e-3), run.slip_share("fl", 1e-3)),
        wheel_hz=quarter_turn(frequency[wheel], complex_knuckle[wheel], knuckle[wheel]),
        wheel_peak_hz=float(frequency[wheel][np.nanargmax(knuckle[wheel])]),
        wheel_peak=float(np.nanmax(knuckle[wheel])),
        body_peak=float(np.nanmax(knuckle[body])),
        damper_ratio=float(np.exp(np.nanmean(np.log(top[damper] / knuckle[damper])))),
    )


def quarter_turn(frequency: Vector, response: npt.NDArray[np.complex128], magnitude: Vector) -> float:
    """Frequency where the phase falls through 90 deg, nearest to the largest line: the resonance, whatever its damping.

    Args:
        frequency: lines of the band [Hz], (m,).
        response: acceleration over displacement, (m,); it turns from 180 to 0 deg through a resonance.
        magnitude: its magnitude, (m,).

    Returns:
        Interpolated frequency [Hz]; NaN where the phase passes 90 deg nowhere.
    """
    # Through 90 deg from above, the real part changes from negative to positive while the imaginary part is positive.
    real, upper = response.real, response.imag > 0.0
    at = np.flatnonzero((real[:-1] < 0.0) & (real[1:] >= 0.0) & upper[:-1] & upper[1:])
    if not at.size:
        return float("nan")
    crossings = frequency[at] - real[at] * (frequency[at + 1] - frequency[at]) / (real[at + 1] - real[at])
    return float(crossings[np.argmin(np.abs(crossings - frequency[np.nanargmax(magnitude)]))])


def slip_claims(found: Mapping[str, LevelNumbers], slip_velocity: float) -> list[Claim]:
    """Rows of table 3.2."""
    claims = []
    for level, published in PUBLISHED_SLIP.items():
        for wheel, share, ours in zip(("right", "left"), published, found[level].slip, strict=True):
            saturated = found[level].saturated[("right", "left").index(wheel)]
            why = (
                f"share of the samples above {1e3 * slip_velocity:g} mm/s ({100 * saturated:.2f} % above 1 mm/s); the "
                "slip velocity and the band edge of the input are not published and were fitted, once, to these six "
                f"shares; tolerance {100 * SLIP_TOLERANCE:g} points, what a quarter of the slip velocity changes"
            )
            name = f"slip share of the {wheel} damper, {level} [%]"
            kind: dict[str, Any] = {"status": "fitted", "source": "table" if wheel == "right" else "text"}
            if share > 0.0:
                claims.append(number_claim(name, 100 * share, 100 * ours, 100 * SLIP_TOLERANCE, why, **kind))
            else:
                claims.append(statement_claim(name, "0", f"{100 * ours:.2f}", ours <= SLIP_TOLERANCE, why, **kind))
    return claims


def frequency_claims(found: Mapping[str, LevelNumbers]) -> list[Claim]:
    """Frequency of the vertical wheel mode."""
    low, mid, high = (found[level] for level in ("low", "mid", "high"))
    return [
        number_claim(
            "vertical wheel mode, low [Hz]",
            28.0,
            low.wheel_hz,
            0.05 * 28.0,
            "where the knuckle FRF passes 90 deg; 5 %. Body torsion and strut-top attachment were fitted to it",
            status="fitted",
            source="text",
        ),
        statement_claim(
            "vertical wheel mode for mid and high against low",
            "lower frequency",
            f"{low.wheel_hz:.1f}, {mid.wheel_hz:.1f}, {high.wheel_hz:.1f} Hz",
            low.wheel_hz > mid.wheel_hz > high.wheel_hz,
            "where the knuckle FRF passes 90 deg; falling from level to level. Largest lines: "
            f"{low.wheel_peak_hz:.1f}, {mid.wheel_peak_hz:.1f}, {high.wheel_peak_hz:.1f} Hz",
            status="predicted",
            source="text",
        ),
    ]


def order_claims(found: Mapping[str, LevelNumbers]) -> list[Claim]:
    """Damping from level to level, and the two ends of the damper."""
    low, mid, high = (found[level] for level in ("low", "mid", "high"))
    return [
        statement_claim(
            "vertical wheel mode for mid and high against low, damping",
            "more damped",
            f"peak {low.wheel_peak:.3g}, {mid.wheel_peak:.3g}, {high.wheel_peak:.3g} (m/s2)/m",
            low.wheel_peak > mid.wheel_peak > high.wheel_peak,
            "the same input in larger: a lower peak is more damping",
            status="predicted",
            source="text",
        ),
        statement_claim(
            "rigid body modes in the knuckle for mid and high against low",
            "less influence, more damped",
            f"peak {low.body_peak:.3g}, {mid.body_peak:.3g}, {high.body_peak:.3g} (m/s2)/m",
            low.body_peak > mid.body_peak > high.body_peak,
            f"largest line of the knuckle FRF in {BODY_BAND[0]:g} to {BODY_BAND[1]:g} Hz",
            status="predicted",
            source="text",
        ),
        statement_claim(
            "damper top against knuckle, low",
            "equal",
            f"ratio {low.damper_ratio:.3f}",
            abs(low.damper_ratio - 1.0) <= 0.05,
            f"mean of |H| over |H|, {DAMPER_BAND[0]:g} to {DAMPER_BAND[1]:g} Hz; equal in a figure with log axes: 5 %",
            status="predicted",
            source="text",
        ),
        statement_claim(
            "damper top against knuckle, mid and high",
            "below for mid, further below for high",
            f"ratio {mid.damper_ratio:.3f}, {high.damper_ratio:.3f}",
            high.damper_ratio < mid.damper_ratio < low.damper_ratio,
            "falling from level to level",
            status="predicted",
            source="text",
        ),
    ]


def axis_claims(responses: Mapping[str, FrequencyResponse]) -> list[Claim]:
    """Largest and smallest line of all FRFs against the axes of figures 3.3 to 3.36.

    Args:
        responses: level to FRFs, rows as `CHANNELS`.
    """
    lines = {
        f"{channel}, {level}, {frequency:.3g} Hz": magnitude
        for level, found in responses.items()
        for channel, row in zip(CHANNELS, np.abs(found.response), strict=True)
        for frequency, magnitude in zip(found.frequency, row, strict=True)
        if np.isfinite(magnitude)
    }
    values = np.array(list(lines.values()))
    outside = 100.0 * np.mean((values < FRF_AXIS[0]) | (values > FRF_AXIS[1]))
    return [
        interval_claim(
            f"{word} line of the FRFs, 1 to 50 Hz [(m/s2)/m]",
            FRF_AXIS,
            float(lines[where]),
            f"{where}; every figure from 3.3 to 3.36 has this axis; {len(CHANNELS)} outputs, {len(responses)} levels, "
            f"{outside:.1f} % of all lines outside; the axis may cut off antiresonances",
        )
        for word, where in (
            ("largest", max(lines, key=lines.__getitem__)),
            ("smallest", min(lines, key=lines.__getitem__)),
        )
    ]


def slip_table(found: Mapping[str, LevelNumbers], slip_velocity: float) -> str:
    """Table 3.2 with ours beside it."""
    lines = [
        f"Share of the time in slip [%], |v| > {1e3 * slip_velocity:g} mm/s (in brackets: > 1 mm/s):",
        "",
        "| level | right, published | right, ours | left, published | left, ours |",
        "|---|---|---|---|---|",
    ]
    for level, published in PUBLISHED_SLIP.items():
        cells = [
            cell
            for share, ours, loose in zip(published, found[level].slip, found[level].saturated, strict=True)
            for cell in (f"{100 * share:g}", f"{100 * ours:.2f} ({100 * loose:.2f})")
        ]
        lines.append(f"| {level} | {' | '.join(cells)} |")
    return "\n".join(lines)
