"""Half car with seat and rider over a bump: figures 5 to 25 of the paper, and its statements with our values.

python -m scenarios.half_car_rider [--output DIR] [--parameters FILE.toml] [--quick] [--force]
"""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.claims import Claim, Findings, markdown
from scenarios.half_car_rider.claims import (
    base_case_claims,
    dose_claims,
    first_mode_claim,
    law_claim,
    matrix_claim,
    speed_claims,
    travel_claims,
)
from scenarios.half_car_rider.figures import lift_off_figure, speed_figure, study_figures, time_figures
from scenarios.half_car_rider.runs import (
    SPEEDS,
    Outcome,
    at_first_mode,
    base_case_table,
    driven,
    outcome,
    parameter_study,
    passive,
)
from scenarios.half_car_rider.seats import FACTORS, Measure, with_experiment
from scenarios.lumped.half_car_rider_model import ENDS
from scenarios.lumped.half_car_rider_parameters import PUBLISHED, HalfCarRiderParameters, half_car_rider_parameters
from scenarios.study import VERTICAL_TYRES, LumpedSettings, lumped_study
from vehicle.model.parameters.semi_active_damper import LAWS, PASSIVE
from vehicle.signals.analysis.exposure import vibration_dose_value

TITLE = "Half car with seat and rider (Parametric study of rider's comfort in a vehicle with semi-active suspension)"

SETTLING_NOTE = (
    "Settling times: the source names no band. 0.5 % of the peak is the one of 0.5, 1, 2 and 5 % that comes nearest to "
    "its eleven times, so that these rows are `chosen`; the others stand beside each. Which of two places settles "
    "later is judged at all four bands."
)

ASSUMED = (
    "Assumed, because the source does not print them: seat mass 35 kg, stiffness 15000 N/m and damping 150 N s/m; all "
    "numbers of the semi-active dampers (scenarios/lumped/half_car_rider.toml)."
)


def study(car: HalfCarRiderParameters, folder: Path, settings: LumpedSettings) -> Findings:
    """Run everything, draw the figures into the folder, and compare."""
    factors = [float(f) for f in np.linspace(0.8, 1.2, 3 if settings.quick else 9)]
    history = passive(car, SPEEDS[0])
    studied = parameter_study(car, factors)
    skyhook = None if settings.quick else parameter_study(car, factors, "skyhook")
    speeds = np.arange(2.0 if settings.quick else 1.0, 61.0, 2.0 if settings.quick else 1.0).tolist()
    scanned = [outcome(car, passive(car, speed)) for speed in speeds]
    scan = {"speed": speeds, "upper": [o.upper_vdv for o in scanned], "lower": [o.lower_vdv for o in scanned]}
    outcomes = {PASSIVE: [outcome(car, passive(car, speed)) for speed in SPEEDS]}
    laws = ("skyhook", "hybrid") if settings.quick else LAWS
    semi_active = {law: driven(car, SPEEDS, law, one_sided_tyres=False) for law in laws}
    outcomes.update({law: [outcome(car, solution) for solution in histories] for law, histories in semi_active.items()})
    free = driven(car, SPEEDS, PASSIVE, one_sided_tyres=True)
    free_outcomes = [outcome(car, solution) for solution in free]

    claims = [
        *base_case_claims(car, history),
        *dose_claims(car, studied, factors),
        *speed_claims(car, scan, [o.upper_vdv for o in outcomes[PASSIVE]], [o.upper_vdv for o in free_outcomes]),
        *travel_claims(car, studied, factors),
        matrix_claim(car),
        law_claim({law: [o.upper_vdv for o in row] for law, row in outcomes.items()}),
        first_mode_claim(*at_first_mode(car, laws)),
    ]
    if not settings.quick:
        claims = with_experiment(claims, car, rows_of)
    shown = {PASSIVE: history, "skyhook": semi_active["skyhook"][0], "hybrid": semi_active["hybrid"][0]}
    time_figures(folder, shown, SPEEDS[0])
    study_figures(folder, factors, studied, skyhook)
    speed_figure(folder, scan, outcomes, SPEEDS)
    lift_off_figure(folder, car, history, free[0], SPEEDS[0])
    notes = [_lift_off_note(outcomes[PASSIVE], free_outcomes), _law_table(outcomes), SETTLING_NOTE, ASSUMED]
    data = {
        "speeds_kmh": list(SPEEDS),
        "laws": {law: [_row(o) for o in row] for law, row in outcomes.items()},
        "one_sided_tyres": [_row(o) for o in free_outcomes],
        "parameter_study": {
            "factors": factors,
            "passive": {name: [[_row(o) for o in row] for row in table] for name, table in studied.items()},
        },
        "speed_scan": scan,
        "base_case": base_case_table(car, history),
    }
    return Findings(title=TITLE, claims=claims, tyres=VERTICAL_TYRES, unjudged=None, notes=notes, data=data)


def rows_of(car: HalfCarRiderParameters, measure: Measure = vibration_dose_value) -> list[Claim]:
    """Return the rows of a passive car with coarse variations, for the experiments; see `seats`."""
    studied = parameter_study(car, FACTORS, measure=measure)
    middle = [row[FACTORS.index(1.0)].upper_vdv for row in studied["sprung_mass"]]
    return [
        *base_case_claims(car, passive(car, SPEEDS[0])),
        *dose_claims(car, studied, FACTORS),
        *speed_claims(car, {"speed": SPEEDS, "upper": middle}, middle, middle),
        *travel_claims(car, studied, FACTORS),
    ]


def _lift_off_note(glued: Sequence[Outcome], free: Sequence[Outcome]) -> str:
    """Return a note on runs in which the linear tyres pull on the road."""
    rows = [
        (f"{speed:.0f}", name, _intervals(a.lift_off[end]), f"{a.least_load[end]:.0f}", _intervals(b.lift_off[end]))
        for speed, a, b in zip(SPEEDS, glued, free, strict=True)
        for end, name in enumerate(ENDS)
    ]
    heads = (
        "speed [km/h]",
        "wheel",
        "linear tyre: load below 0 [s]",
        "least load [N]",
        "one-sided tyre: in the air [s]",
    )
    title = "Tyre lift-off (passive; the linear tyre pulls on the road during these times):"
    return f"{title}\n\n{markdown(heads, rows)}"


def _intervals(intervals: Sequence[tuple[float, float]]) -> str:
    return "; ".join(f"{start:.3f} to {end:.3f}" for start, end in intervals) or "none"


def _law_table(outcomes: Mapping[str, Sequence[Outcome]]) -> str:
    rows = [(law, *(f"{o.upper_vdv:.3f}" for o in row), f"{1e3 * row[0].travel:.1f}") for law, row in outcomes.items()]
    heads = ("law", *(f"{speed:.0f} km/h" for speed in SPEEDS), "travel at 20 km/h [mm]")
    title = "Passive against semi-active dampers (tyres glued to the road), VDV of the upper body [m/s^1.75]:"
    return f"{title}\n\n{markdown(heads, rows)}"


def _row(outcome: Outcome) -> dict[str, Any]:
    return {
        "upper_vdv": outcome.upper_vdv,
        "lower_vdv": outcome.lower_vdv,
        "travel_m": outcome.travel,
        "lift_off_s": dict(zip(ENDS, map(list, outcome.lift_off), strict=True)),
        "least_linear_tyre_load_n": list(outcome.least_load),
    }


def load(settings: LumpedSettings) -> HalfCarRiderParameters:
    """Return the parameters."""
    return half_car_rider_parameters(settings.parameters or PUBLISHED)


main = lumped_study("half_car_rider", load, study, LumpedSettings)


if __name__ == "__main__":
    sys.exit(main())
