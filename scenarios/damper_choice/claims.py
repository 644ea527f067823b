"""Rows of printed statements about the choice of dampers with the results of the equations."""

from collections.abc import Mapping, Sequence

import numpy as np

from scenarios.claims import CHOSEN, COMPARED, FITTED, NOT_TESTABLE, PREDICTED, Claim, placed
from scenarios.damper_choice.experiments import rear_experiment, wheel_experiments
from scenarios.damper_choice.fit import FRONT_RATIOS, QUARTER_RATIOS, REAR_RATIOS
from scenarios.damper_choice.optimum import Optimum
from scenarios.damper_choice.other_vehicles import CROSSING, LOW_EDGE, SAME, Refit, region_verdicts
from scenarios.damper_choice.printed_determinant import PRINTED_TERMS, half_car_matrix, printed_determinant, wrong_terms
from scenarios.damper_choice.response_features import crossing, last_peak, local_peaks, spread_of
from scenarios.damper_choice.runs import HALF_DAMPING, QUARTER_DAMPING, RoadHolding
from scenarios.lumped.damper_choice import DamperChoiceParameters
from scenarios.lumped.half_car_rider_model import ENDS
from scenarios.lumped.road_holding import half_car_model, printed_load_fluctuation, quarter_car_model
from scenarios.verdict import common
from vehicle.arrays import Vector

READING = 125.0
"""Half of the 250 N s/m to which the source reads its optima [N s/m]."""

RATE_READING = 0.05
"""The printed R carry two to three digits and come from figures: 0.05 [-]."""

PICTURES = {2: "figure_02_03_quarter_car.png", 5: "figure_05_to_08_half_car.png", 9: "figure_09_10_highway.png"}
"""First figure of the source that a picture shows -> its file."""

DETERMINANT_HZ = (2.0, 6.0)
"""Frequencies at which the printed determinant is compared [Hz]: body resonance, and where the wheel curves cross."""

ITERATION = "figure_11_12_13_iteration.png"

ASIDE = (1000.0, 1500.0, 2000.0)
"""Distances from the optimum at which both flanks are compared [N s/m]; the source prints none."""


def ratio_claims(parameters: DamperChoiceParameters) -> list[Claim]:
    """Return the rows on the damping ratios: the fit of sqrt(k m) to several printed ratios."""
    quarter, half = parameters.quarter_car, parameters.half_car
    tyres = (*quarter_car_model(quarter).tyres, *half_car_model(half).tyres)
    names = (("quarter car", QUARTER_RATIOS), ("half car front", FRONT_RATIOS), ("half car rear", REAR_RATIOS))
    ends = [
        (*axle_names, t.axle.suspension_stiffness, t.sprung_share) for axle_names, t in zip(names, tyres, strict=True)
    ]
    why = "c / (2 sqrt(k m)); one sqrt(k m) is fitted to four printed ratios, so each may be off by its last digit"
    rows = [
        FITTED.number(f"{name}: damping ratio at {c:.0f} N s/m", printed, c / (2.0 * np.sqrt(k * m)), 0.011, why)
        for name, ratios, k, m in ends
        for c, printed in ratios.items()
    ]
    split = len(QUARTER_RATIOS)
    return placed(rows[:split], "figures 2 and 3", PICTURES[2]) + placed(rows[split:], "figures 5 to 8", PICTURES[5])


def quarter_response_claims(
    parameters: DamperChoiceParameters, lines: Vector, responses: dict[float, Vector]
) -> list[Claim]:
    """Return the rows on figures 2 and 3: damping [N s/m] to |response| of wheel and body over lines [Hz], (2, m)."""
    wheel = np.array([responses[c][0] for c in QUARTER_DAMPING])
    body = np.array([responses[c][1] for c in QUARTER_DAMPING])
    rows = _regions("quarter car wheel", lines, wheel, 2.0, "2 to 3 Hz")
    peaks = [local_peaks(lines, curve) for curve in wheel]
    rows.append(
        FITTED.statement(
            "low damping adds a second local maximum at about 7 Hz",
            "two maxima at 0.62, one at 1.09",
            f"maxima at {_hz(peaks[0])} Hz for {QUARTER_DAMPING[0]:.0f} N s/m, {_hz(peaks[-1])} Hz for "
            f"{QUARTER_DAMPING[-1]:.0f} N s/m",
            len(peaks[0]) == 2 and len(peaks[-1]) == 1 and abs(peaks[0][1] - 7.0) < 1.0,
            "7 Hz is read from an axis with ticks every 5 Hz: within 1 Hz",
        )
    )
    rows.append(_second_maximum(parameters, lines))
    rows = placed(rows, "figure 2", PICTURES[2])
    for c, curve in zip(QUARTER_DAMPING, body, strict=True):
        rows.append(
            FITTED.number(
                f"quarter car sprung peak at {c:.0f} N s/m [Hz]",
                2.0,
                float(lines[curve.argmax()]),
                0.5,
                "read from an axis with ticks every 5 Hz: within 0.5 Hz; the peak moves up with damping, as the wheel "
                "locks to the body on the tyre",
            )
        )
    rows.append(
        FITTED.statement(
            "one sprung peak for every damping, lower with more damping",
            "one peak, falling",
            f"{[len(local_peaks(lines, curve)) for curve in body]} maxima, heights "
            + ", ".join(f"{value:.2f}" for value in body.max(axis=1)),
            all(len(local_peaks(lines, curve)) == 1 for curve in body)
            and bool(np.all(np.diff(body.max(axis=1)) < 0.0)),
            "counted on lines 0.01 Hz apart up to 15 Hz",
        )
    )
    return placed(rows, "figure 3", PICTURES[2])


def _second_maximum(parameters: DamperChoiceParameters, lines: Vector) -> Claim:
    """Return the row on the height of the second maximum of the wheel."""
    dampings, maxima = (4000.0, 3000.0, 2500.0), []
    for c in dampings:
        curve = np.abs(quarter_car_model(parameters.quarter_car, c).response(lines))[0]
        maxima.append(float(curve[np.searchsorted(lines, last_peak(lines, curve))]))
    return PREDICTED.statement(
        "the second maximum of the wheel grows as the damping falls",
        "grows",
        f"{_values(np.array(maxima))} m/m at {', '.join(f'{c:.0f}' for c in dampings)} N s/m",
        bool(np.all(np.diff(maxima) > 0.0)),
        "last local maximum up to 15 Hz",
    )


def half_response_claims(
    parameters: DamperChoiceParameters, lines: Vector, responses: dict[float, Vector], other: Refit | None = None
) -> list[Claim]:
    """Return the rows on figures 5 to 8: damping [N s/m] to |response| over lines [Hz], (4, m).

    The coordinates are front wheel, rear wheel, heave and pitch. The other vehicle, fitted to these rows as well, is
    the experiment for a row that disagrees.
    """
    stack = np.array([responses[c] for c in HALF_DAMPING])  # (damping, coordinate, line)
    rows = []
    for end, (name, figure) in enumerate((("front", 5), ("rear", 6))):
        why = list(wheel_experiments(parameters, lines, end))
        if other is not None:
            verdicts = region_verdicts(lines, stack[:, end], LOW_EDGE)
            why = [why[row] + ("" if holds else f"; {other.text(end, row)}") for row, holds in enumerate(verdicts)]
        regions = _regions(f"half car {name} wheel", lines, stack[:, end], LOW_EDGE, "2 Hz", why)
        rows += placed(regions, f"figure {figure}", PICTURES[5])
    hop = [last_peak(lines, curves[0]) for curves in (stack[:, 0], stack[:, 1])]
    masses = [axle.unsprung_mass for axle in (parameters.half_car.front, parameters.half_car.rear)]
    rows.append(
        FITTED.statement(
            "the unsprung mass of the rear is higher, which moves its peaks",
            "rear heavier, other frequencies",
            f"{masses[1]:.0f} against {masses[0]:.0f} kg; last maximum at {hop[1]:.1f} against {hop[0]:.1f} Hz with "
            f"{HALF_DAMPING[0]:.0f} N s/m",
            masses[1] > masses[0] and hop[1] < hop[0],
            "the masses are fitted to the printed R, optima and axes",
        ).at("figures 5 and 6", PICTURES[5])
    )
    heave, pitch = stack[:, 2].max(axis=1), stack[:, 3].max(axis=1)
    dampings = ", ".join(f"{c:.0f}" for c in HALF_DAMPING)
    rows.append(
        FITTED.statement(
            "the pitch peak rises with damping while the heave peak falls",
            "rises, falls",
            f"pitch {_values(pitch)} rad/m, heave {_values(heave)} m/m at {dampings} N s/m",
            bool(np.all(np.diff(pitch) > 0.0) and np.all(np.diff(heave) < 0.0)),
            "equal dampers at unequal arms couple heave and pitch through c (a - b); the springs nearly balance",
        ).at("figures 7 and 8", PICTURES[5])
    )
    rows.append(
        FITTED.number(
            "heave peak, mean over damping [Hz]",
            2.0,
            float(lines[stack[:, 2].argmax(axis=1)].mean()),
            0.5,
            "printed as the frequency of the quarter car; read from an axis with ticks every 5 Hz",
        ).at("figure 7", PICTURES[5])
    )
    return rows


def quarter_optimum_claims(parameters: DamperChoiceParameters, road_holding: RoadHolding, measure: str) -> list[Claim]:
    """Return the rows on figure 9 for one measure."""
    best = road_holding.quarter_optimum
    row_maker = FITTED if measure == "printed" else COMPARED
    rows = [
        row_maker.number(
            f"quarter car optimum damping, {measure} measure [N s/m]",
            3750.0,
            best.damping,
            250.0,
            f"printed as 3500 to 4000; R = {best.value:.3f} there",
        ),
        _steeper("quarter car", measure, best, road_holding.damping, road_holding.quarter),
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
            ).at("equation 10")
        )
    return placed(rows, "figure 9", PICTURES[9])


def city_claim(highway: Mapping[str, RoadHolding], city: Mapping[str, RoadHolding]) -> Claim:
    """Return the row on the best damper of the quarter car on both roads of table 1, by measure."""
    optima = [
        f"{measure} measure: city {city[measure].quarter_optimum.damping:.0f}, highway "
        f"{highway[measure].quarter_optimum.damping:.0f} N s/m"
        for measure in highway
    ]
    return NOT_TESTABLE.statement(
        "quarter car optimum on the city road against the highway",
        "another road may have another best damper",
        "; ".join(optima),
        None,
        "the source computes the highway only and says that the best damper need not be that of another road; both "
        "spectra have nearly one shape (b 0.213 against 0.19 s), and a alone moves no optimum",
    ).at("table 1", PICTURES[9])


def determinant_claim(parameters: DamperChoiceParameters) -> Claim:
    """Return the row on the printed determinant of the half car."""
    wrong = wrong_terms()
    ratios = [
        abs(printed_determinant(matrix) / np.linalg.det(matrix))
        for matrix in (half_car_matrix(parameters.half_car, frequency) for frequency in DETERMINANT_HZ)
    ]
    at = " and ".join(f"{ratio:.2f} at {line:g} Hz" for ratio, line in zip(ratios, DETERMINANT_HZ, strict=True))
    return COMPARED.statement(
        "determinant D below equation 6",
        "determinant of the matrix a",
        f"{len(PRINTED_TERMS) - len(wrong)} of {len(PRINTED_TERMS)} terms are permutations; |D| as printed over the "
        f"determinant: {at}",
        not wrong,
        f"{' and '.join(wrong)} has two factors of one column and none of another, so it is no term of a determinant "
        "(a31 a42 a14 a23 is missing). The scan lost the signs; each term has that of its permutation",
    ).at("equation 6")


def _steeper(name: str, measure: str, best: Optimum, damping: Vector, curve: Vector) -> Claim:
    """Return the row on the flanks of a curve of R, undecided where the distance from the optimum turns it."""
    rises = {
        distance: [float(np.interp(best.damping + side * distance, damping, curve)) - best.value for side in (-1, 1)]
        for distance in ASIDE
    }
    return (PREDICTED if measure == "printed" else COMPARED).statement(
        f"{name}: steeper below the optimum than above, {measure} measure",
        "steeper below",
        "R rises below / above by "
        + ", ".join(f"{below:.3f} / {above:.3f} ({distance:.0f} N s/m)" for distance, (below, above) in rises.items()),
        common(below > above for below, above in rises.values()),
        "at each of three distances from the optimum; the source prints none",
    )


def half_optimum_claims(road_holding: RoadHolding, measure: str) -> list[Claim]:
    """Return the rows on figures 10 to 13 for a measure; values of R only for the printed measure."""
    front, rear = road_holding.equal_optima
    first, second, third = road_holding.read_off[:3]
    row_maker = FITTED if measure == "printed" else COMPARED
    why = "printed to 250 N s/m"
    if measure == "physical":
        why += "; the source optimises the printed measure, to which the car is fitted: here for comparison"
    rows = [
        row_maker.number(
            f"front optimum, equal dampers, {measure} measure [N s/m]", 4000.0, front.damping, READING, why
        ),
        row_maker.number(
            f"rear optimum, equal dampers, {measure} measure [N s/m]",
            3125.0,
            rear.damping,
            2.0 * READING,
            f"{why}; both 3000 and 3250 are printed, their middle is compared",
        ),
        row_maker.statement(
            f"optimum front above rear, {measure} measure",
            "front above rear",
            f"front {front.damping:.0f}, rear {rear.damping:.0f} N s/m with equal dampers; front {second.front:.0f}, "
            f"rear {second.rear:.0f} N s/m after the iteration",
            front.damping > rear.damping and second.front > second.rear,
            "the rear wheel is heavier than the front one in the fitted car",
        ),
    ]
    rows += [
        _steeper(f"half car {name}", measure, best, road_holding.damping, curve)
        for name, best, curve in zip(ENDS, road_holding.equal_optima, road_holding.equal, strict=True)
    ]
    rows = placed(rows, "figure 10", PICTURES[9])
    for step, printed, figure in ((first, 4250.0, 11), (second, 3000.0, 12), (third, 4250.0, 13)):
        rows.append(
            row_maker.number(
                f"step {figure - 10}: {step.changed} damping, {measure} measure [N s/m]",
                printed,
                step.damping,
                READING,
                why,
            ).at(f"figure {figure}", ITERATION)
        )
    rows.append(
        row_maker.statement(
            f"iteration converges in three steps, {measure} measure",
            "3 steps",
            f"{len(road_holding.read_off)} steps: "
            + ", ".join(f"{s.changed} {s.damping:.0f}" for s in road_holding.read_off),
            len(road_holding.read_off) == 3,
            "each end read among multiples of 250 N s/m, as printed",
        ).at("section 4.2", ITERATION)
    )
    return rows


def rate_claims(
    parameters: DamperChoiceParameters, road_holding: RoadHolding, at_front: Vector, at_rear: Vector
) -> list[Claim]:
    """Return the rows on the values of R of the printed measure.

    `at_front` and `at_rear` are R with 4000 and with 3250 N s/m at both ends.
    """
    first, second, third = road_holding.read_off[:3]
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
                f"R {name}",
                printed,
                float(ours),
                RATE_READING if "front" in name else 2.0 * RATE_READING,
                "two digits read from a figure whose axis ends at 9 (front) or 10 (rear): 0.05 and 0.1"
                + (f"; {rear_experiment(parameters)}" if name.startswith("rear, equal") else ""),
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
    return placed(rows, "section 4.2, figures 10 to 13", ITERATION)


def _regions(
    name: str, lines: Vector, curves: Vector, low_edge: float, printed_edge: str, why: Sequence[str] = ("", "")
) -> list[Claim]:
    """Return the rows on the three frequency regions of a wheel response; `why` has a note for each of two rows."""
    same, ordered = region_verdicts(lines, curves, low_edge)
    apart = spread_of(curves)
    spread = float(apart[lines < low_edge].max())
    beyond = float(lines[np.flatnonzero(apart > SAME)[0]])
    change = crossing(lines, curves[0], curves[-1])
    extra = [f"; {note}" if note else "" for note in why]
    return [
        PREDICTED.statement(
            f"{name}: no effect of damping below {printed_edge}",
            "no meaningful difference",
            f"the curves differ by at most {spread:.2f} m/m below {low_edge:g} Hz",
            same,
            f"rule: less than {SAME} m/m, a tenth of the printed axis; they differ by more from {beyond:.2f} Hz on, by "
            f"the body resonance, whose height depends on damping{extra[0]}",
        ),
        PREDICTED.statement(
            f"{name}: 2 to 6 Hz less with low damping, beyond less with high damping",
            "change of order at 6 Hz",
            f"the curves of lowest and highest damping cross at {change:.1f} Hz",
            ordered,
            f"rule: in order from 3 to 5 Hz and above 8 Hz, crossing within {CROSSING} Hz of 6 Hz, a third of a tick "
            f"interval{extra[1]}",
        ),
    ]


def _hz(values: list[float]) -> str:
    return " and ".join(f"{value:.1f}" for value in values)


def _values(values: Vector) -> str:
    return ", ".join(f"{value:.3g}" for value in values)
