"""Gravity in records of accelerometers: a check of their unit and range.

Accelerometers that measure from 0 Hz on show the standard gravity as the mean of its vertical axis, or as the
length of the vector of the means of three axes.
"""

import math
import re
import shlex
from collections.abc import Collection, Mapping

from vehicle.names import AXES
from vehicle.signals.formats.units import STANDARD_GRAVITY, find_unit
from vehicle.signals.records.finding import Finding

AXIS = re.compile(r"(?:.*[_ ])?(?P<axis>[xyz])", re.IGNORECASE)
"""Name that ends with its axis."""

TOLERANCE = 0.03
"""Maximum deviation of a mean from gravity or a multiple of it [-]: 14 degrees of tilt, or calibration and offset."""

ACCELERATIONS = ("m/s2", "g", "mm/s2")
"""Units in which accelerometers are recorded, the first the most frequent."""

RANGES = (2.0, 0.5, 4.0, 8.0)
"""Ratios of a recorded to the true acceleration with a wrong range: ranges of sensors are 2, 4, 8 and 16 g."""

HIGHEST_MEAN = 1.5 * STANDARD_GRAVITY
"""Mean above which neither tilt nor the offset of a sensor explains it [m/s2]."""

SMALLEST_LEVEL = 0.1
"""RMS about the mean below which the motion is too small for a car [m/s2]: a third of "not uncomfortable" in ISO 2631-1
(0.315 m/s2)."""


def gravity_findings(
    means: Mapping[str, float], levels: Mapping[str, float], units: Mapping[str, str], stated: Collection[str] = ()
) -> list[Finding]:
    """Return findings on gravity in the means of accelerations: a wrong unit or range ("unit"), or gravity ("gravity").

    The mean of a single axis may also be an offset or a tilt: below `HIGHEST_MEAN` the level of the motion must show a
    wrong unit too, and the range is in doubt ("doubt", without options).

    Args:
        means: role to mean by the unit [m/s2].
        levels: role to RMS about the mean [m/s2].
        units: role to unit.
        stated: roles whose unit the user stated; it is taken as right.
    """
    findings, with_gravity = [], dict[str, float]()
    for roles in _groups(means):
        mean = math.hypot(*(means[role] for role in roles))
        vertical = [role for role in roles if axis_of_role(role) in ("", "z")]
        if _near(mean, STANDARD_GRAVITY):
            with_gravity |= {role: means[role] for role in roles if abs(means[role]) > TOLERANCE * STANDARD_GRAVITY}
        elif vertical and not {*roles} & {*stated}:
            findings += [each for role in vertical for each in _unit_of(role, roles, mean, levels[role], units)]
    if with_gravity:
        low, high = (pick(map(abs, with_gravity.values())) for pick in (min, max))
        shown = f"{high:.4g}" if high - low < 5e-3 * high else f"{low:.4g} to {high:.4g}"
        which = "the mean" if len(with_gravity) == 1 else "the means"
        text = f"{', '.join(with_gravity)}: gravity is included in {which} ({shown} m/s2); --detrend subtracts it"
        findings.append(Finding(text, "gravity", ("--detrend",)))
    return findings


def axis_of_role(role: str) -> str:
    """Return the axis of a role, "z" for "z", "seat_acc_z" and "Seat Z"; empty for another name."""
    match = AXIS.fullmatch(role)
    return match["axis"].lower() if match else ""


def _groups(means: Mapping[str, float]) -> list[tuple[str, ...]]:
    """Return the roles of each point together: x, y and z."""
    points: dict[str, list[str]] = {}
    for role in means:
        points.setdefault(role[:-1] if axis_of_role(role) else role, []).append(role)
    return [tuple(roles) for roles in points.values()]


def _near(value: float, gravity: float) -> bool:
    return abs(abs(value) / gravity - 1.0) <= TOLERANCE


def _unit_of(role: str, roles: tuple[str, ...], mean: float, level: float, units: Mapping[str, str]) -> list[Finding]:
    """Return the finding on the unit or range of a role whose mean is not gravity by its unit, or none."""
    unit, subject = (
        units[role],
        "the mean is" if len(roles) == 1 else f"the vector of the means of {', '.join(roles)} is",
    )
    entry = find_unit(unit)
    factor = entry.factor if entry is not None else 1.0
    others = {other: entry.factor for other in ACCELERATIONS if (entry := find_unit(other)) is not None}
    vector = len(roles) == len(AXES) or mean > HIGHEST_MEAN

    def finding(observed: str, cause: str, right: str, *, sure: bool) -> list[Finding]:
        options, same = (
            tuple(word for each in roles for word in ("--unit", f"{each}={text}")) for text in (right, unit)
        )
        text = (
            f"{role}: {subject} {mean:.3g} m/s2{observed}{', so ' if sure else ': perhaps '}{cause}; set "
            f"{shlex.join(options)}, or for an offset{'' if sure else ' or a tilt'} of the sensor {shlex.join(same)}"
        )
        return [Finding(text, "unit" if sure else "doubt", options if sure else ())]

    for other, other_factor in others.items():
        if other_factor != factor and _near(mean / factor * other_factor, STANDARD_GRAVITY):
            observed = f" by the unit [{unit}] of the file, not 9.81 m/s2"
            return finding(observed, f"the values are in {other}", other, sure=vector or level < SMALLEST_LEVEL)
    for ratio in RANGES:
        if _near(mean, ratio * STANDARD_GRAVITY):
            cause = "range or calibration of the sensor are wrong"
            return finding(f", {ratio:g} times gravity", cause, f"{1.0 / ratio:g} {unit}", sure=vector)
    return []
