"""The quarter car in MuJoCo beside the stiff solver."""

from __future__ import annotations

from scenarios.claim import Claim, statement_claim
from scenarios.quarter_car_in_mujoco import DEFAULT_STEP, friction_of_the_rows, in_mujoco
from scenarios.quarter_car_runs import STEP, Runs, rms
from vehicle.analysis.slip import slip_share

MIDDLE = 0.005
"""RMS of the road [m] on which the damper slips part of the time."""


def in_mujoco_claims(runs: Runs) -> list[Claim]:
    """The same physics twice: element rows of the complete car in MuJoCo against the stiff solver."""
    motion = in_mujoco(runs.car, runs.road_signal(MIDDLE))
    every = round(STEP / DEFAULT_STEP)
    slipping = 100.0 / runs.car.friction.steepness
    share = 100.0 * slip_share(motion.sliding_velocity[::every], slipping)
    claims = []
    for law, history, places in (
        ("the law of the row", runs.road_of(friction_of_the_rows(runs.car), MIDDLE), ("body", "wheel", "damper")),
        ("the published atan law", runs.road(MIDDLE), ("body", "wheel")),
    ):
        gaps = {
            place: 100.0 * (rms(value[::every]) / rms(history.acceleration(place)) - 1.0)
            for place, value in motion.acceleration.items()
        }
        expected = 100.0 * slip_share(history.sliding_velocity(), slipping)
        ours = ", ".join(f"{place} {gap:+.2f} %" for place, gap in gaps.items())
        claims.append(
            statement_claim(
                f"road 5 mm, quarter car in MuJoCo against the stiff solver with {law}",
                "same physics",
                f"acceleration RMS {ours}; slip {share:.1f} against {expected:.1f} % of the time",
                all(abs(gaps[place]) < 1.0 for place in places) and abs(share - expected) < 0.5,
                f"not printed, our own check at {1e3 * DEFAULT_STEP:g} ms: RMS of {', '.join(places)} within 1 %, slip "
                "(100/eps) within 0.5 points"
                + ("" if "damper" in places else "; the two laws differ below 1/eps, which the damper mass feels"),
                status="own check",
                source="inferred",
            )
        )
    return claims
