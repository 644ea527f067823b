"""Findings of a run as sentences, computed from its summary, its FRFs and the modes of its car."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.digits import number
from vehicle.engines.linear.car_modes import Mode
from vehicle.names import point_words, side_of, slip_words
from vehicle.runs.car.main_mode import WORKS
from vehicle.runs.report.body_modes import body_modes
from vehicle.runs.report.comfort_class import CREST_FACTOR_LIMIT
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.order_words import order_sentences
from vehicle.signals.records.run_summary import RunSummary

STICKS = 0.01
"""Maximum share of the time in slip of a sticking damper."""

NEAR = 0.06
"""Maximum relative distance of a resonance from the natural frequency of its mode: the peak of an acceleration is
higher by about the square of the damping ratio, and dampers that slip at times shift it."""

COHERENT = 0.9
"""Coherence below which the response counts as nonlinear; at this value the incoherent part of the power is 10 %."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Sentence with its topic."""

    topic: str
    text: str


def findings(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> list[Finding]:
    """Return sentences on dampers, applied forces, resonances, body modes, crest factor, linearity and solver warnings.

    Args:
        modes: modes of the car, for dampers "stuck" and "sliding".
    """
    summary = run.summary
    sentences = [Finding("Dampers", text) for text in damper_sentences(summary, friction=run.friction)]
    sentences += [Finding("Forces", text) for text in order_sentences(summary)]
    sentences += [Finding("Resonances", text) for text in _resonances(run, modes)]
    sentences += [Finding("Body", text) for text in body_modes(run, damper_state(run))]
    sentences += [Finding("Comfort", text) for text in _comfort(run)]
    sentences += [Finding("Linearity", text) for text in _linearity(run)]
    return [*sentences, *(Finding("Computation", f"Warning: {text}") for text in summary.solver.warnings)]


def damper_sentences(summary: RunSummary, *, friction: bool = True) -> list[str]:
    """Return a sentence for each state: the dampers in it, and their shares of the time in slip.

    Args:
        summary: content of the `summary.json` of the run.
        friction: False for dampers that cannot stick.
    """
    shares, limits = summary.slip_shares, summary.slip_limits
    by_state: dict[str, list[str]] = {}
    for wheel, share in shares.items():
        if not friction:
            state = "without friction"
        elif share <= STICKS < summary.friction_saturated_share[wheel]:
            state = f"at times sliding slowly, seldom or never faster than {1e3 * limits[wheel]:g} mm/s"
        elif summary.first_slip_s[wheel] is None:
            state = "stuck all the time: almost no energy is dissipated, and the strut acts as a rigid link"
        elif share <= STICKS:
            state = "almost always stuck: almost no energy is dissipated, and the strut acts as a rigid link"
        elif share >= WORKS:
            state = "slipping often: friction and viscous damping act much of the time"
        else:
            state = "partly stuck, partly slipping: the effect depends on the level of the input"
        by_state.setdefault(state, []).append(wheel)
    sentences = []
    for state, wheels in by_state.items():
        text = f"{_names([side_of(wheel, shares) for wheel in wheels], len(shares))} {state}."
        if any(summary.first_slip_s[wheel] is not None for wheel in wheels):
            each = [f"{number(100 * shares[wheel], 2)} % ({side_of(wheel, shares)})" for wheel in wheels]
            slip = "Slip, faster than" if friction else "Faster than"
            limit = slip_words({wheel: limits[wheel] for wheel in wheels}, shares)
            text += f" {slip} {limit} mm/s: {' and '.join(each)} of the time."
        sentences.append(text)
    return sentences


def _names(sides: Sequence[str], count: int) -> str:
    """Return dampers with a verb, as "Both dampers are"."""
    if len(sides) == 1:
        return f"The {sides[0]} damper is"
    if len(sides) == count:
        return f"{'Both' if count == 2 else 'All'} dampers are"
    return f"The dampers {' and '.join(sides)} are"


def _resonances(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> list[str]:
    sentences = []
    for wheel, plate, resonances in run.peaks:
        for channel, point in main_points(run, wheel).items():
            peaks = resonances.get(channel)
            if not peaks:
                continue
            top = max(peaks, key=lambda peak: peak.magnitude)
            state, nearest = nearest_mode(run, top.frequency_hz, modes)
            mode = (
                ""
                if nearest is None
                else f", near the mode of {nearest.frequency:.1f} Hz ({nearest.description}; {state})"
            )
            sentences.append(
                f"The highest vertical resonance at the {point} is at {top.frequency_hz:.1f} Hz{mode}: "
                f"{number(top.magnitude)} m/s² per m{f' of the {plate}' if plate else ''}."
            )
    if not sentences and not run.summary.input.rms_m:
        return ["No plate moves, so there are no FRFs and no resonances."]
    if not sentences and not run.responses:
        return ["This run has no FRFs, so it shows no resonances; the modes of the car are listed below."]
    return sentences or ["The input excites no resonance."]


def main_points(run: FinishedRun, wheel: str) -> dict[str, str]:
    """Return the channels with the most important resonances, and their names in sentences.

    Args:
        run: the run.
        wheel: wheel of the plate of the FRFs; its knuckle is named with the side if several plates move apart.
    """
    side = f"{side_of(wheel, run.car.vehicle.wheels)} " if len(run.responses) > 1 else ""
    return {f"knuckle_{wheel}_acc_z": f"{side}knuckle", "seat_rail_acc_z": "seat rail"}


def nearest_mode(run: FinishedRun, frequency: float, modes: Mapping[str, Sequence[Mode]]) -> tuple[str, Mode | None]:
    """Return the mode with the natural frequency nearest to a resonance.

    Args:
        run: the run; its slip shares determine the state of the dampers.
        frequency: frequency of the resonance [Hz].
        modes: modes of the car, for dampers "stuck" and "sliding".

    Returns:
        State of the dampers in words, and the mode; None if its distance exceeds `NEAR`.
    """
    state = damper_state(run)
    nearest = min(modes.get(state, ()), key=lambda mode: abs(mode.frequency - frequency), default=None)
    if nearest is not None and abs(nearest.frequency - frequency) > NEAR * frequency:
        nearest = None
    return f"dampers {state}", nearest


def damper_state(run: FinishedRun) -> str:
    """Return the state of the dampers during most of the run, "stuck" or "sliding"."""
    return "sliding" if max(run.summary.slip_shares.values(), default=0.0) > WORKS else "stuck"


def _comfort(run: FinishedRun) -> list[str]:
    """Return a sentence for each point whose crest factor asks for other measures than the RMS of the table."""
    sentences = []
    for point, value in run.comfort.items():
        factor = max(axis.crest_factor or 0.0 for axis in value.iso2631.axes.values())
        if factor > CREST_FACTOR_LIMIT:
            sentences.append(
                f"At the {point_words(point)} the crest factor is {factor:.3g}, above {CREST_FACTOR_LIMIT:g}: the "
                "weighted RMS underestimates the discomfort; consider MTVV and VDV in the tables (ISO 2631-1, 6.2.1)."
            )
    return sentences


def _linearity(run: FinishedRun) -> list[str]:
    sentences: list[str] = []
    if not run.responses and not run.summary.input.rms_m:
        return sentences
    if not run.responses:
        if run.summary.input.road:
            return [
                "There are no FRFs: on a road the rear wheels repeat what the front wheels met, so the responses to "
                "the plates cannot be separated."
            ]
        reason = next((text.removeprefix("no FRFs: ") for text in run.summary.notices if "no FRFs" in text), "")
        return [f"There are no FRFs: {reason}." if reason else "There are no FRFs."]
    rows = {name: row for row, name in enumerate(run.car.vehicle.acceleration_channels)}
    multiple = "multiple coherence, with all plates," if len(run.responses) > 1 else "coherence"
    points = {channel: point for wheel, _, _ in run.peaks for channel, point in main_points(run, wheel).items()}
    for channel, point in points.items():
        if channel not in rows:
            continue
        coherence = run.responses[0].response.coherence[rows[channel]]  # the same for every plate
        finite = coherence[np.isfinite(coherence)]
        if finite.size:
            low = float(np.mean(finite < COHERENT))
            sentences.append(
                f"At the {point} the median of the {multiple} is {np.median(finite):.3f}"
                + (
                    f"; it is below {COHERENT:g} on {number(100 * low, 2)} % of the lines: there the response is "
                    "nonlinear or very small."
                    if low > 0.0
                    else f"; it is never below {COHERENT:g}: the response is linear."
                )
            )
    return sentences
