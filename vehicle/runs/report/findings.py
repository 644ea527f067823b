"""What a run says, in sentences: computed from its summary, its FRFs and the modes of its car."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.engines.linear.car_modes import Mode
from vehicle.names import side_of
from vehicle.runs.report.body_modes import body_modes
from vehicle.runs.report.comfort_class import CREST_FACTOR_LIMIT, reactions
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import number
from vehicle.signals.analysis.comfort import COMFORT_BAND

STICKS, WORKS = 0.01, 0.25
"""Share of the time in slip up to which a damper sticks, and from which on it works as one."""

NEAR = 0.06
"""Relative distance of a resonance from the natural frequency of a mode that is named beside it: the peak of an
acceleration lies above it by about the square of the damping ratio, and dampers that slip now and then move it."""

COHERENT = 0.9
"""Coherence below which a fifth of the response over its plate displacement is not linear in it."""


@dataclass(frozen=True, slots=True)
class Finding:
    """A sentence, and what it is about."""

    topic: str
    text: str


def findings(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> list[Finding]:
    """Sentences about dampers, resonances, comfort, linearity and the computation.

    Args:
        run: the run.
        modes: of its car, for dampers "stuck" and "sliding"; empty where there are none.
    """
    summary = run.summary
    found = [Finding("Dampers", text) for text in _dampers(summary)]
    found += [Finding("Resonances", text) for text in _resonances(run, modes)]
    found += [Finding("Body", text) for text in body_modes(run, damper_state(run))]
    found += [Finding("Comfort", text) for text in _comfort(summary)]
    found += [Finding("Linearity", text) for text in _linearity(run)]
    return [*found, *(Finding("Computation", text) for text in _computation(summary))]


def _shares(summary: Mapping[str, Any]) -> dict[str, float]:
    """Share of the time in slip by wheel."""
    return {name: share for name, share in summary["slip_share"].items() if name != "slip_velocity"}


def _dampers(summary: Mapping[str, Any]) -> list[str]:
    shares, limit = _shares(summary), 1e3 * summary["slip_share"]["slip_velocity"]
    found = []
    for wheel, share in shares.items():
        side, first = side_of(wheel, shares), summary["first_slip_s"][wheel]
        percent = "never" if first is None else f"for {100 * share:.2g} % of the time, first at {first:.3f} s"
        if share <= STICKS:
            does = "sticks: it takes next to no energy out of the motion, and the wheel hangs on a rigid strut"
        elif share >= WORKS:
            does = "works: friction and viscous damping act over much of the time"
        else:
            does = "sticks and slips by turns: what it does depends on the level"
        found.append(f"The {side} damper {does}. It is faster than {limit:g} mm/s {percent}.")
    return found


def _resonances(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> list[str]:
    found = []
    for channel, place in main_places(run).items():
        peaks = run.summary["peaks"].get(channel)
        if peaks:
            top = max(peaks, key=lambda peak: peak["magnitude"])
            state, nearest = nearest_mode(run, top["frequency_hz"], modes)
            mode = (
                ""
                if nearest is None
                else f", beside the mode of {nearest.frequency:.1f} Hz ({nearest.description}; {state})"
            )
            found.append(
                f"The highest vertical resonance at the {place} lies at {top['frequency_hz']:.1f} Hz{mode}: "
                f"{number(top['magnitude'])} m/s² per m{of_plate(run)}."
            )
    return found or ["No resonance can be told: the input excites none, or there are no FRFs."]


def main_places(run: FinishedRun) -> dict[str, str]:
    """Channels whose resonances are told first, and their words."""
    return {f"knuckle_{run.wheel}_acc_z": "knuckle", "seat_rail_acc_z": "seat rail"}


def of_plate(run: FinishedRun) -> str:
    """Where plates move independently: words for the one to which the resonances are told."""
    if len(run.responses) < 2:
        return ""
    wheel = next(iter(run.responses[0].motion))
    return f" of the plate {side_of(wheel, run.car.vehicle.wheels)}"


def nearest_mode(run: FinishedRun, frequency: float, modes: Mapping[str, Sequence[Mode]]) -> tuple[str, Mode | None]:
    """The mode whose natural frequency is nearest to that of a resonance, where one is near.

    Args:
        run: tells by its slip in which state its dampers are most of the time.
        frequency: of the resonance [Hz].
        modes: of the car, for dampers "stuck" and "sliding".

    Returns:
        State of the dampers in words, and the mode; None where none is near.
    """
    state = damper_state(run)
    nearest = min(modes.get(state, ()), key=lambda mode: abs(mode.frequency - frequency), default=None)
    if nearest is not None and abs(nearest.frequency - frequency) > NEAR * frequency:
        nearest = None
    return f"dampers {state}", nearest


def damper_state(run: FinishedRun) -> str:
    """What its dampers do most of the time, "stuck" or "sliding"."""
    return "sliding" if max(_shares(run.summary).values(), default=0.0) > WORKS else "stuck"


def _comfort(summary: Mapping[str, Any]) -> list[str]:
    found = []
    for place, words in (("seat_rail", "seat rail"), ("seat", "seat")):
        value = summary["comfort"].get(place)
        if value is None:
            continue
        iso, rms = value["iso2631"], value.get("rms_of_band", value["rms_2_50_hz"])
        low, high = rms.get("band_hz", COMFORT_BAND)
        total = iso["vector_sum"]["weighted_rms"]
        axis = max("xyz", key=lambda one: iso[one]["multiplying_factor"] * iso[one]["weighted_rms"])
        found.append(
            f"At the {words} the weighted acceleration is {number(total)} m/s²: {' to '.join(reactions(total))} in the "
            f"words of ISO 2631-1, annex C. Most of it acts along {axis}. Unweighted, {low:g} to {high:g} "
            f"Hz: {number(rms['overall'])} m/s². Lower is better."
        )
        factor = max((iso[one]["crest_factor"] or 0.0) for one in "xyz")
        if factor > CREST_FACTOR_LIMIT:
            found.append(
                f"At the {words} the crest factor is {factor:.3g}, above {CREST_FACTOR_LIMIT:g}: the weighted RMS is "
                "low for what is felt; look at MTVV and VDV in the tables (ISO 2631-1, 6.2.1)."
            )
    return found


def _linearity(run: FinishedRun) -> list[str]:
    response, found = run.response, []
    if response is None:
        return ["There are no FRFs: see the notices." if run.summary["notices"] else "There are no FRFs."]
    rows = {name: row for row, name in enumerate(run.car.vehicle.acceleration_channels)}
    for channel, place in ((f"knuckle_{run.wheel}_acc_z", "knuckle"), ("seat_rail_acc_z", "seat rail")):
        if channel not in rows:
            continue
        coherence = response.coherence[rows[channel]]
        known = coherence[np.isfinite(coherence)]
        if known.size:
            low = float(np.mean(known < COHERENT))
            found.append(
                f"At the {place} the coherence is {np.median(known):.3f} in the median"
                + (
                    f", and below {COHERENT:g} on {100 * low:.2g} % of the lines: there the car does not answer "
                    "linearly, or hardly moves."
                    if low > 0.0
                    else f", and nowhere below {COHERENT:g}: the car answers linearly."
                )
            )
    return found


def _computation(summary: Mapping[str, Any]) -> list[str]:
    solver = summary["solver"]
    residual = solver["energy_residual"]
    balance = "" if residual is None else f"; its energy balance closes within {residual:.1e} of the work put in"
    found = [
        f"The {solver['engine']} engine took {number(solver['wall_s'])} s, {number(solver['realtime_factor'])} times "
        f"real time, with steps of {1e3 * solver['timestep_s']:g} ms{balance}."
    ]
    return [*found, *(f"Warning: {text}" for text in solver["warnings"])]
