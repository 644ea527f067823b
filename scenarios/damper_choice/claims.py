"""Printed statements about the choice of dampers beside what the equations say."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from scenarios.claims import CHOSEN, COMPARED, FITTED, PREDICTED, Claim
from scenarios.damper_choice.fit import FRONT_RATIOS, QUARTER_RATIOS, REAR_RATIOS
from scenarios.damper_choice.runs import HALF_DAMPING, QUARTER_DAMPING, RoadHolding
from vehicle.lumped.road_holding import half_car_model, printed_load_fluctuation, quarter_car_model
from vehicle.parameters.damper_choice import DamperChoiceParameters

Array = npt.NDArray[np.float64]

READING = 125.0
"""Half of the 250 N s/m to which the source reads its optima [N s/m]."""

RATE_READING = 0.05
"""The printed R carry two to three digits and come from figures: 0.05 [-]."""

SAME = 0.15
""""No effect of damping": the curves differ by less than this share of the road amplitude [-]."""

ASIDE = 1500.0
"""Distance from the optimum at which both flanks are compared [N s/m]."""


def ratio_claims(parameters: DamperChoiceParameters) -> list[Claim]:
    """Rows on the damping ratios: the fit of sqrt(k m) to several printed ratios at once."""
    quarter, half = parameters.quarter_car, parameters.half_car
    tyres = (*quarter_car_model(quarter).tyres, *half_car_model(half).tyres)
    names = (("quarter car", QUARTER_RATIOS), ("half car front", FRONT_RATIOS), ("half car rear", REAR_RATIOS))
    ends = [(*one, t.axle.suspension_stiffness, t.sprung_share) for one, t in zip(names, tyres, strict=True)]
    why = "c / (2 sqrt(k m)); one sqrt(k m) is fitted to four printed ratios, so each may be off by its last digit"
    return [
        FITTED.number(f"{name}: damping ratio at {c:.0f} N s/m", printed, c / (2.0 * np.sqrt(k * m)), 0.011, why)
        for name, ratios, k, m in ends
        for c, printed in ratios.items()
    ]


def quarter_response_claims(lines: Array, responses: dict[float, Array]) -> list[Claim]:
    """Rows on figures 2 and 3."""
    wheel = np.array([responses[c][0] for c in QUARTER_DAMPING])
    body = np.array([responses[c][1] for c in QUARTER_DAMPING])
    rows = _regions("figure 2: quarter car wheel", lines, wheel, 2.0, "2 to 3 Hz")
    peaks = [_local_peaks(lines, curve) for curve in wheel]
    rows.append(
        FITTED.statement(
            "figure 2: low damping adds a second local maximum at about 7 Hz",
            "two maxima at 0.62, one at 1.09",
            f"maxima at {_hz(peaks[0])} Hz for {QUARTER_DAMPING[0]:.0f} N s/m, {_hz(peaks[-1])} Hz for "
            f"{QUARTER_DAMPING[-1]:.0f} N s/m",
            len(peaks[0]) == 2 and len(peaks[-1]) == 1 and abs(peaks[0][1] - 7.0) < 1.0,
            "7 Hz is read from an axis with ticks every 5 Hz: within 1 Hz",
        )
    )
    for c, curve in zip(QUARTER_DAMPING, body, strict=True):
        rows.append(
            FITTED.number(
                f"figure 3: quarter car sprung peak at {c:.0f} N s/m [Hz]",
                2.0,
                float(lines[curve.argmax()]),
                0.5,
                "read from an axis with ticks every 5 Hz: within 0.5 Hz; the peak moves up with damping, as the wheel "
                "locks to the body on the tyre",
            )
        )
    rows.append(
        FITTED.statement(
            "figure 3: one sprung peak for every damping, lower with more damping",
            "one peak, falling",
            f"{[len(_local_peaks(lines, curve)) for curve in body]} maxima, heights "
            + ", ".join(f"{value:.2f}" for value in body.max(axis=1)),
            all(len(_local_peaks(lines, curve)) == 1 for curve in body)
            and bool(np.all(np.diff(body.max(axis=1)) < 0.0)),
            "counted on lines 0.01 Hz apart up to 15 Hz",
        )
    )
    return rows


def half_response_claims(lines: Array, responses: dict[float, Array]) -> list[Claim]:
    """Rows on figures 5 to 8."""
    stack = np.array([responses[c] for c in HALF_DAMPING])  # (damping, coordinate, line)
    rows = _regions("figure 5: half car front wheel", lines, stack[:, 0], 2.0, "2 Hz")
    rows += _regions("figure 6: half car rear wheel", lines, stack[:, 1], 2.0, "2 Hz")
    heave, pitch = stack[:, 2].max(axis=1), stack[:, 3].max(axis=1)
    dampings = ", ".join(f"{c:.0f}" for c in HALF_DAMPING)
    rows.append(
        FITTED.statement(
            "figures 7 and 8: the pitch peak rises with damping while the heave peak falls",
            "rises, falls",
            f"pitch {_values(pitch)} rad/m, heave {_values(heave)} m/m at {dampings} N s/m",
            bool(np.all(np.diff(pitch) > 0.0) and np.all(np.diff(heave) < 0.0)),
            "equal dampers at unequal arms couple heave and pitch through c (a - b); the springs nearly balance",
        )
    )
    rows.append(
        FITTED.number(
            "figure 7: heave peak, mean over damping [Hz]",
            2.0,
            float(lines[stack[:, 2].argmax(axis=1)].mean()),
            0.5,
            "printed as the frequency of the quarter car; read from an axis with ticks every 5 Hz",
        )
    )
    return rows


def quarter_optimum_claims(parameters: DamperChoiceParameters, found: RoadHolding, measure: str) -> list[Claim]:
    """Rows on figure 9 for one measure."""
    best = found.quarter_optimum
    below, above = (
        float(np.interp(best.damping + shift, found.damping, found.quarter)) - best.value for shift in (-ASIDE, ASIDE)
    )
    kind = FITTED if measure == "printed" else COMPARED
    rows = [
        kind.number(
            f"figure 9: quarter car optimum damping, {measure} measure [N s/m]",
            3750.0,
            best.damping,
            250.0,
            f"printed as 3500 to 4000; R = {best.value:.3f} there",
        ),
        (PREDICTED if measure == "printed" else COMPARED).statement(
            f"figure 9: steeper below the optimum than above, {measure} measure",
            "steeper below",
            f"R rises by {below:.3f} to {ASIDE:.0f} N s/m below, by {above:.3f} to {ASIDE:.0f} N s/m above",
            below > above,
            "both flanks at the same distance from the optimum",
        ),
    ]
    if measure == "printed":
        signed = [
            float(
                printed_load_fluctuation(
                    quarter_car_model(parameters.quarter_car, c), parameters.highway, parameters.bands, signed=True
                )[0]
            )
            for c in (1000.0, 2000.0, 4000.0, 8000.0)
        ]
        rows.append(
            CHOSEN.statement(
                "equation 10 without magnitude bars",
                "has a minimum (figure 9)",
                f"R = {_values(np.array(signed))} at 1000, 2000, 4000, 8000 N s/m",
                not bool(np.all(np.diff(signed) > 0.0)),
                "bands in which the wheel moves more than the road count negative, so the signed sum only rises with "
                "damping; the printed curves must come from magnitudes, and R as printed is taken with them",
            )
        )
    return rows


def half_optimum_claims(found: RoadHolding, measure: str) -> list[Claim]:
    """Rows on figures 10 to 13 for one measure; the values of R only for the printed one."""
    front, rear = found.equal_optima
    first, second, third = found.read_off[:3]
    kind = FITTED if measure == "printed" else COMPARED
    why = "printed to 250 N s/m"
    if measure == "physical":
        why += "; the source optimises the printed measure, to which the car is fitted: here for comparison"
    rows = [
        kind.number(
            f"figure 10: front optimum, equal dampers, {measure} measure [N s/m]", 4000.0, front.damping, READING, why
        ),
        kind.number(
            f"figure 10: rear optimum, equal dampers, {measure} measure [N s/m]",
            3125.0,
            rear.damping,
            2.0 * READING,
            f"{why}; both 3000 and 3250 are printed, their middle is compared",
        ),
        kind.statement(
            f"optimum front above rear, {measure} measure",
            "front above rear",
            f"front {front.damping:.0f}, rear {rear.damping:.0f} N s/m with equal dampers; front {second.front:.0f}, "
            f"rear {second.rear:.0f} N s/m after the iteration",
            front.damping > rear.damping and second.front > second.rear,
            "the rear wheel is heavier than the front one in the fitted car",
        ),
    ]
    for step, printed, figure in ((first, 4250.0, 11), (second, 3000.0, 12), (third, 4250.0, 13)):
        rows.append(
            kind.number(
                f"figure {figure}: {step.changed} damping, {measure} measure [N s/m]",
                printed,
                step.damping,
                READING,
                why,
            )
        )
    rows.append(
        kind.statement(
            f"iteration converges in three steps, {measure} measure",
            "3 steps",
            f"{len(found.read_off)} steps: " + ", ".join(f"{s.changed} {s.damping:.0f}" for s in found.read_off),
            len(found.read_off) == 3,
            "each end read among multiples of 250 N s/m, as printed",
        )
    )
    return rows


def rate_claims(found: RoadHolding, at_front: Array, at_rear: Array) -> list[Claim]:
    """Rows on the values of R of the printed measure.

    Args:
        found: printed measure on the highway.
        at_front: R with 4000 N s/m at both ends.
        at_rear: R with 3250 N s/m at both ends.
    """
    first, second, third = found.read_off[:3]
    rows = []
    for name, printed, ours in (
        ("front, equal dampers 4000 N s/m", 2.25, at_front[0]),
        ("front after step 1", 2.125, first.fluctuation[0]),
        ("front after step 3", 2.1, third.fluctuation[0]),
        ("rear, equal dampers 3250 N s/m", 3.9, at_rear[1]),
        ("rear after step 1", 3.55, first.fluctuation[1]),
        ("rear after step 2", 3.5, second.fluctuation[1]),
    ):
        rows.append(
            FITTED.number(
                f"figures 10 to 13: R {name}",
                printed,
                float(ours),
                RATE_READING if "front" in name else 2.0 * RATE_READING,
                "two digits read from a figure whose axis ends at 9 (front) or 10 (rear): 0.05 and 0.1",
            )
        )
    fronts = [float(at_front[0]), first.fluctuation[0], second.fluctuation[0]]
    rears = [float(at_rear[1]), first.fluctuation[1], second.fluctuation[1]]
    rows.append(
        FITTED.statement(
            "R of both ends falls through the iteration",
            "2.25, 2.125, 2.1 and 3.9, 3.55, 3.5",
            f"{_values(np.array(fronts))} and {_values(np.array(rears))}",
            bool(np.all(np.diff(fronts) < 0.0) and np.all(np.diff(rears) < 0.0)),
            "needs strong coupling of the ends: the fit takes a moment of inertia far below that of a real car",
        )
    )
    return rows


def _regions(name: str, lines: Array, curves: Array, low_edge: float, printed_edge: str) -> list[Claim]:
    """Rows on the three frequency regions of a wheel response."""
    softest, firmest = curves[0], curves[-1]
    low = lines < low_edge
    middle, high = (lines > 3.0) & (lines < 5.0), lines > 8.0
    spread = float((curves.max(axis=0) - curves.min(axis=0))[low].max())
    above = firmest > softest
    crossing = float(lines[np.flatnonzero(above & (lines < 12.0))[-1]])
    return [
        PREDICTED.statement(
            f"{name}: no effect of damping below {printed_edge}",
            "no meaningful difference",
            f"the curves differ by at most {spread:.2f} m/m below {low_edge:g} Hz",
            spread < SAME,
            f"rule: less than {SAME} m/m, a tenth of the printed axis; differences here come from the "
            "body resonance, whose height depends on damping",
        ),
        PREDICTED.statement(
            f"{name}: 2 to 6 Hz less with low damping, beyond less with high damping",
            "change of order at 6 Hz",
            f"the curves of lowest and highest damping cross at {crossing:.1f} Hz",
            bool(np.all(above[middle]) and not np.any(above[high]) and abs(crossing - 6.0) < 1.5),
            "rule: in order from 3 to 5 Hz and above 8 Hz, crossing within 1.5 Hz of 6 Hz, a third of a tick interval",
        ),
    ]


def _local_peaks(lines: Array, curve: Array) -> list[float]:
    inner = curve[1:-1]
    return [float(lines[i + 1]) for i in np.flatnonzero((inner > curve[:-2]) & (inner > curve[2:]))]


def _hz(values: list[float]) -> str:
    return " and ".join(f"{value:.1f}" for value in values)


def _values(values: Array) -> str:
    return ", ".join(f"{value:.3g}" for value in values)
