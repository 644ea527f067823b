"""Findings of the quarter-car study: published statements with our values."""

from scenarios.claims import Claim, Findings
from scenarios.quarter_car.axis_claims import axis_claims
from scenarios.quarter_car.damper_claims import degressive_claims, strut_claims
from scenarios.quarter_car.in_mujoco import in_mujoco_claims
from scenarios.quarter_car.linear_claims import element_claims, mass_on_damper_claims, mode_claims, phase_claims
from scenarios.quarter_car.road_claims import (
    FIRST,
    SECOND,
    engine_road_claims,
    level_claims,
    steepness_claims,
    swing_claim,
)
from scenarios.quarter_car.runs import SEED, Runs
from scenarios.quarter_car.sine_claims import engine_sine_claims, sine_claims
from scenarios.study import VERTICAL_TYRES

LARGEST = (
    "low road: relative velocity of the damper stays below the knee",
    "low road: largest relative velocity of the damper [m/s]",
    "high road: largest relative velocity of the damper [m/s]",
)
"""Rows of a largest value over time, which grows with the length of the road."""

TOO_SHORT = "the largest value of a short road is smaller"


def findings(runs: Runs) -> Findings:
    """Return the findings of the whole study."""
    claims: list[Claim] = [*mode_claims(runs), *phase_claims(runs), swing_claim(), *mass_on_damper_claims(runs)]
    claims += [*sine_claims(runs), *level_claims(runs), *element_claims(runs), *engine_sine_claims(runs)]
    claims += [*engine_road_claims(runs), *steepness_claims(runs), *degressive_claims(runs), *strut_claims(runs)]
    claims += [*axis_claims(runs), *in_mujoco_claims(runs)]
    notes = [
        f"Random road: constant velocity PSD up to 100 Hz, {runs.duration:g} s, seeds from {SEED} on, scaled to each "
        "level: the RMS in 30 s, from 1/30 Hz on; the band is not printed, and with it the level inside 1 to 50 Hz is "
        "open. Time histories: LSODA with analytic Jacobian, relative tolerance 1e-6. "
        f"Random roads: {runs.roads} of them, vectorised march with steps of {1e3 * runs.march_step:g} ms; spectra are "
        "the mean over them.",
        f"Resonances of nonlinear runs are the largest lines ({runs.resolution:.2g} Hz apart) of the body acceleration "
        "PSD over the road velocity PSD, looked for in "
        f"{FIRST[0]:g} to {FIRST[1]:g} Hz and {SECOND[0]:g} to {SECOND[1]:g} Hz.",
        "Where the source has words and no number (much more, much higher, equal), the rule was set with our values in "
        "view: such a row is weaker evidence than one of a printed number.",
    ]
    title = "Quarter-car family (thesis, Bommer 2006, chapter 2 and appendices A to D)"
    return Findings(
        title=title,
        claims=claims,
        tyres=VERTICAL_TYRES,
        unjudged=dict.fromkeys(LARGEST, TOO_SHORT) if runs.quick else {},
        notes=notes,
        data={"quick": runs.quick},
    )
