"""Rows that compare axle theory with the rig, and the table of slopes and compliances."""

from __future__ import annotations

import math
from collections.abc import Sequence

from scenarios.claims import OWN_CHECK, Claim, markdown
from scenarios.kinematics.axles import Axle, Moved

COMPLIANCES = {
    "lateral [mm/kN], lateral force": ("across", "patch_lateral_m", 1e3),
    "toe-in [deg/kN], lateral force": ("across", "toe_deg", 1.0),
    "longitudinal [mm/kN], braking force": ("along", "patch_longitudinal_m", 1e3),
    "toe-in [deg/kN], braking force": ("along", "toe_deg", 1.0),
}
"""Label of a compliance of the right wheel to the direction of the force, the quantity and its scale."""

TWISTED = 5e-3
"""Toe and camber [deg] of an axle that swings about its pivots: bushings of both sides yield alike."""

LEVER_ERROR = 0.1
"""Relative error of the closed form of bump steer: the steering axis tilts and the outer end rises less."""


def claims(axles: Sequence[Axle], moved: Sequence[Moved]) -> list[Claim]:
    """Return the rows that compare axle theory with the rig."""
    rows = []
    for axle in axles:
        if axle.template == "twist_beam":
            largest_angle = max(max(abs(pose.camber_deg), abs(pose.toe_deg)) for pose in axle.equal)
            why = f"it swings about the line through its pivots; {TWISTED:g} deg for the bushings"
            name = f"{axle.label}: camber and toe over equal travel"
            rows.append(
                OWN_CHECK.statement(name, "none", f"at most {largest_angle:.1e} deg", largest_angle <= TWISTED, why)
            )
        equal, rolling = (1e-3 * float(entry["wheel_rate_n_per_m"] or 0.0) for entry in (axle.slopes, axle.rolling))
        rows.append(
            OWN_CHECK.statement(
                f"{axle.label}: wheel rate over opposite travel",
                "not below that over equal travel",
                f"{rolling:.1f} against {equal:.1f} N/mm",
                rolling > 0.999 * equal,
                "an anti-roll bar or a beam twists over opposite travel alone; 0.1 % for axles that have neither",
            )
        )
    for entry in moved:
        if math.isfinite(entry.closed_form):
            why = f"a rod of fixed length about the steering axis; {100 * LEVER_ERROR:g} % for what it leaves out"
            name = f"{entry.label}: toe slope for a higher inner end of the tie rod [deg/m2]"
            rows.append(
                OWN_CHECK.number(name, entry.closed_form, entry.gain, LEVER_ERROR * abs(entry.closed_form), why)
            )
    return rows


def axle_table(axles: Sequence[Axle]) -> str:
    """Return the table of slopes and compliances of all axles."""
    heads = ("camber", "toe-in", "patch, lateral", "spring ratio", "wheel rate", "of it the spring", "opposite travel")
    units = ("[deg/100 mm]", "[deg/100 mm]", "[mm/100 mm]", "[-]", "[N/mm]", "[N/mm]", "[N/mm]")
    columns = ["axle", "template", *(f"{head} {unit}" for head, unit in zip(heads, units, strict=True))]
    rows = []
    for axle in axles:
        slope = {name: math.nan if value is None else value for name, value in axle.slopes.items()}
        cells = [0.1 * slope["camber_deg_per_m"], 0.1 * slope["toe_deg_per_m"], 100.0 * slope["patch_lateral_per_m"]]
        cells += [slope["spring_ratio"], 1e-3 * slope["wheel_rate_n_per_m"], 1e-3 * axle.from_spring]
        cells += [1e-3 * float(axle.rolling["wheel_rate_n_per_m"] or 0.0)]
        pushed = [scale * getattr(getattr(axle, way), name) for way, name, scale in COMPLIANCES.values()]
        rows.append([axle.label, axle.template, *map(_cell, (*cells, *pushed))])
    return (
        "Slopes in the design position, equal travel, wheel on the right; compliance under 1 kN to the right or to "
        + (f"the rear on both wheels at the ground:\n\n{markdown([*columns, *COMPLIANCES], rows)}")
    )


def _cell(value: float) -> str:
    """Return a number with three digits; a dash for NaN, no sign for zero."""
    return "-" if math.isnan(value) else f"{round(value, 6) + 0.0:.3g}"
