"""Published statements about the Stribeck law beside ours."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from scenarios.claim import Claim, statement_claim
from scenarios.slip_peaks import SEARCHED, STANDING_OUT, SlipPhase, extra_peaks, most_prominent
from vehicle.car import SATURATED_VELOCITY, Run
from vehicle.excitation.bump import BUMP_START_S
from vehicle.laws.coulomb import SmoothCoulomb
from vehicle.laws.degressive import Degressive
from vehicle.laws.stribeck import Stribeck
from vehicle.parameters.elements import Damper

FORCE_TOLERANCE = 0.012
"""Largest difference between simulated force and law over the largest force: the line up to the limit in place of the
arctangent (0.6 % of 125 N at 1 mm/s) and a Stribeck limit that is one step of 0.125 ms old (2600 N s/m at 5 m/s2)."""


def law_force(damper: Damper, velocity: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Damper force [N] of equations 3.1 and 3.2, or with C.1 for D v, at velocities [m/s]."""
    speeds = np.asarray(velocity, dtype=float)
    friction: SmoothCoulomb | Stribeck
    if damper.friction_law == "stribeck":
        friction = Stribeck(
            sliding_limit=damper.coulomb_friction,
            static_limit=damper.stribeck_friction,
            stribeck_velocity=damper.stribeck_velocity,
            exponent=damper.stribeck_exponent,
            steepness=damper.smoothing,
        )
    else:
        friction = SmoothCoulomb(limit=damper.coulomb_friction, steepness=damper.smoothing)
    viscous = damper.viscous * speeds
    if damper.viscous_law == "degressive":
        law = Degressive(
            low_damping=damper.degressive_viscous,
            high_damping=damper.viscous,
            knee_velocity=damper.degressive_velocity,
        )
        viscous = law.force(speeds)
    return np.asarray(viscous + friction.force(speeds))


def force_error(run: Run) -> float:
    """Largest |simulated force - law| over the largest force, where the right damper is faster than 1 mm/s [-]."""
    velocity, force = run["damper_fr_velocity"], run["damper_fr_force"]
    fast = np.abs(velocity) > SATURATED_VELOCITY
    if not fast.any():
        return 0.0
    wanted = law_force(run.car.vehicle.damper, velocity[fast])
    return float(np.max(np.abs(force[fast] - wanted)) / np.max(np.abs(force)))


def peak_claims(runs: Mapping[str, Run], phases: Mapping[str, list[SlipPhase]]) -> list[Claim]:
    """Rows: the extra peak with each law, and the simulated force against the law."""
    rule = (
        f"an extremum of the relative acceleration 5 to {1e3 * SEARCHED:g} ms after the end of stick that stands out "
        f"by at least {100 * STANDING_OUT:g} % of the largest break-away jump of its run"
    )
    claims = []
    for name, published in (("Stribeck", "present"), ("Coulomb", "absent")):
        count, top = len(extra_peaks(phases[name])), most_prominent(phases[name])
        text = "no extremum" if top is None else f"the largest stands out by {top.prominence:.2f} m/s2"
        claims.append(
            statement_claim(
                f"extra peak after stick ends, {name}",
                published,
                f"{count}; {text} ({1e3 * top.delay:.0f} ms after)" if top else f"{count}; {text}",
                (count > 0) == (published == "present"),
                f"{rule}; largest jump {max((phase.jump for phase in phases[name]), default=0.0):.2f} m/s2",
                status="predicted",
                source="text",
            )
        )
    errors = {name: force_error(run) for name, run in runs.items()}
    claims.append(
        statement_claim(
            "damper force over velocity against equations 3.1 and 3.2",
            "on the law",
            ", ".join(f"{name}: {100 * error:.2f} % of the largest force" for name, error in errors.items()),
            max(errors.values()) <= FORCE_TOLERANCE,
            f"largest difference above 1 mm/s; {100 * FORCE_TOLERANCE:g} %: line for arctangent, limit one step behind",
            status="own check",
            source="inferred",
        )
    )
    return claims


def peak_table(phases: Mapping[str, list[SlipPhase]], start: float) -> str:
    """Every slip with its break-away jump and its most prominent later peak."""
    lines = [
        f"Slides of the right damper from the end of stick, above {1e3 * SATURATED_VELOCITY:g} mm/s, where friction "
        "is saturated (bump begins at 5 s):",
        "",
        "| law | stick ends [s] | sliding lasts [ms] | largest velocity [mm/s] | break-away jump [m/s2] "
        "| most prominent later extremum: delay [ms], height, prominence [m/s2] |",
        "|---|---|---|---|---|---|",
    ]
    for name, found in phases.items():
        for phase in found:
            top = most_prominent([phase])
            text = "none" if top is None else f"{1e3 * top.delay:.0f}, {top.height:.2f}, {top.prominence:.2f}"
            lines.append(
                f"| {name} | {phase.start - start + BUMP_START_S:.3f} | {1e3 * (phase.end - phase.start):.0f} "
                f"| {1e3 * phase.velocity:.1f} | {phase.jump:.2f} | {text} |"
            )
    return "\n".join(lines)
