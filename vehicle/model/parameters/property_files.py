"""Numbers of dampers, springs, bushings and stops in property files of other programs.

Adams counts as follows, and the vehicle file as here:

    damper  (dpr)  force over velocity, both positive in extension               as here
    spring  (spr)  F(L0 - L): force over deflection, positive in compression     both signs change
    bushing (bus)  force over displacement of the moving part, for each axis     as here
    bump stop (bum), rebound stop (reb)  force over penetration, both positive    from the clearance on

Forces are interpolated by straight lines here, by Akima splines there: equal at the points, and outside them.
Sources: documentation of Adams Car, "Use Hardpoints" (F = AKISPL(L0 - DM(I, J))) and "Property File Editor".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from vehicle.errors import ConfigurationError, DataError

if TYPE_CHECKING:
    from vehicle.signals.formats.teim_orbit import PropertyFile

NAMES = {"dpr": "damper", "spr": "spring", "bus": "bushing", "bum": "bump stop", "reb": "rebound stop"}
"""Elements by the type of their property file."""

AXES = "xyz"
TURNING_AGREES = 0.01
"""Relative difference of the three rotational stiffnesses of a bushing file, up to which one number replaces them."""

Point = tuple[float, float]


def require_type(file: PropertyFile, *allowed: str) -> None:
    """Check that a property file describes the right type of element.

    Raises:
        DataError: it describes another type.
    """
    if file.file_type not in allowed:
        needed = " or ".join(f"a {NAMES[name]} ({name!r})" for name in allowed)
        actual = f"type {file.file_type!r}"
        if file.file_type in NAMES:
            actual = f"a {NAMES[file.file_type]} ({file.file_type!r})"
        raise DataError(f"{file.path}: is a property file for {actual}, not for {needed}; name another file")


def damper_numbers(file: PropertyFile) -> dict[str, Any]:
    """Return velocity [m/s] and force [N] of a damper file (dpr).

    Raises:
        DataError: another type of file, or a wrong block, unit or curve.
    """
    require_type(file, "dpr")
    points = file.points("CURVE", file.unit("LENGTH") / file.unit("TIME"), file.unit("FORCE"))
    return {"velocity": [v for v, _ in points], "force": [f for _, f in points]}


def spring_numbers(file: PropertyFile) -> dict[str, Any]:
    """Return the stiffness at F = 0 [N/m] of a spring file (spr), and the table of a spring that is not linear.

    Raises:
        DataError: another type of file, or a wrong block, unit or curve.
    """
    require_type(file, "spr")
    points = file.points("CURVE", file.unit("LENGTH"), file.unit("FORCE"))
    return spring_of_points([(-x, -f) for x, f in reversed(points)], "table", str(file.path))


def bushing_numbers(file: PropertyFile, beside: Mapping[str, Any]) -> dict[str, Any]:
    """Return stiffness [N/m], damping [N s/m], rotational stiffness [N m/rad] and tables of a bushing file (bus).

    Args:
        file: property file.
        beside: further numbers of the same table, which take precedence.

    Raises:
        DataError: another type of file, or a wrong block, unit or curve; rotational stiffnesses that differ.
    """
    require_type(file, "bus")
    length, force = file.unit("LENGTH"), file.unit("FORCE")
    numbers: dict[str, Any] = {"stiffness": []}
    for axis in AXES:
        law = spring_of_points(file.points(f"F{axis.upper()}_CURVE", length, force), f"table_{axis}", str(file.path))
        numbers["stiffness"].append(law.pop("stiffness"))
        numbers |= law
    if "damping" not in beside:
        rates = [file.number("DAMPING", f"F{axis.upper()}_DAMPING") for axis in AXES]
        if None in rates:
            raise DataError(f"{file.path}: [DAMPING] lacks FX_DAMPING, FY_DAMPING and FZ_DAMPING; add them, or set "
                "damping [N s/m] in the same section of the vehicle file")  # fmt: skip
        numbers["damping"] = [rate * force * file.unit("TIME") / length for rate in rates if rate is not None]
    if "rotational_stiffness" not in beside:
        numbers["rotational_stiffness"] = _turning(file)
    return numbers


def _turning(file: PropertyFile) -> float:
    """Return the rotational stiffness of a bushing file [N m/rad]: that at rest, of all axes."""
    angle, torque = file.unit("ANGLE"), file.unit("FORCE") * file.unit("LENGTH")
    slopes = [_slope(file.points(f"T{axis.upper()}_CURVE", angle, torque)) for axis in AXES]
    if max(slopes) - min(slopes) > TURNING_AGREES * max(map(abs, slopes)):
        raise DataError(
            f"{file.path}: TX, TY, TZ_CURVE have {', '.join(f'{slope:.4g}' for slope in slopes)} N m/rad at "
            "rest, but a bushing has one rotational stiffness for all axes; set rotational_stiffness [N m/rad] in "
            "the same section of the vehicle file"
        )
    return sum(slopes) / len(slopes)


def stop_numbers(stop: Mapping[str, Any], ends: Mapping[str, list[Point]], path: str) -> dict[str, Any]:
    """Return the table of a stop from penetration and force of its bump and rebound end.

        F(x) = -F_bump(-x - c_bump) for x < -c_bump,   F_rebound(x - c_rebound) for x > c_rebound,   0 between

    Args:
        stop: table of the vehicle file with [bump] and [rebound], or one of them.
        ends: points of penetration [m] and force [N] by "bump" and "rebound".
        path: path of the table.

    Raises:
        ConfigurationError: a clearance is missing or negative, or a curve does not begin with no force.
    """
    displacement, force = [], []
    for end, points in ends.items():
        clearance = stop[end].get("clearance")
        if not isinstance(clearance, int | float) or isinstance(clearance, bool) or not clearance >= 0.0:
            raise ConfigurationError(
                f"{path}.{end}.clearance: found {clearance!r}, must be a number of at least 0 [m]: the travel of "
                "the damper from its design position to the stop"
            )
        # Rows with zero force before the contact have no effect.
        contact = max((index for index, (_, f) in enumerate(points) if f == 0.0), default=-1)
        if contact < 0 or contact == len(points) - 1 or points[contact][0] < 0.0:
            raise ConfigurationError(
                f"{path}.{end}.curve: found {points[0][1]:g} N at {points[0][0]:g} m; a stop must have 0 N at "
                "its contact (penetration 0) and a force beyond it"
            )
        sign = -1.0 if end == "bump" else 1.0
        displacement += [sign * (clearance + x) + 0.0 for x, _ in points[contact:]]
        force += [sign * f + 0.0 for _, f in points[contact:]]
    if len(ends) == 1:
        # The law goes on in a straight line: one more point keeps it at zero.
        at = max(displacement) + 1.0 if "bump" in ends else min(displacement) - 1.0
        displacement.append(at)
        force.append(0.0)
    # Without clearances both ends have their contact in the design position.
    pairs = sorted(dict.fromkeys(zip(displacement, force, strict=True)))
    return {"displacement": [x for x, _ in pairs], "force": [f for _, f in pairs]}


def stop_points(file: PropertyFile, end: str) -> list[Point]:
    """Return penetration [m] and force [N] of the file of a bump stop or a rebound stop.

    Args:
        file: property file.
        end: "bump" or "rebound"; a bump stop may limit both.

    Raises:
        DataError: another type of file, or a wrong block, unit or curve.
    """
    require_type(file, *(("bum",) if end == "bump" else ("reb", "bum")))
    return file.points("CURVE", file.unit("LENGTH"), file.unit("FORCE"))


def spring_of_points(points: Sequence[Point], table: str, where: str) -> dict[str, Any]:
    """Return the stiffness at rest [N/m] of a curve and, if it is no line through zero, its table.

    Args:
        points: displacement [m] and force [N], ascending, extension positive.
        table: name of the table.
        where: file of the curve, for messages.

    Raises:
        DataError: the curve does not contain zero.
    """
    if not points[0][0] <= 0.0 <= points[-1][0]:
        raise DataError(f"{where}: the curve extends from {points[0][0]:g} to {points[-1][0]:g} m but must contain 0")
    # Without the round-off of the units.
    stiffness, scale = float(f"{_slope(points):.12g}"), max(abs(f) for _, f in points)
    if all(abs(f - stiffness * x) <= 1e-9 * scale for x, f in points):
        return {"stiffness": stiffness}
    return {"stiffness": stiffness, table: {"displacement": [x for x, _ in points], "force": [f for _, f in points]}}


def _slope(points: Sequence[Point]) -> float:
    """Return the slope of a curve at zero; at a corner, the mean of both sides."""
    below = next(index for index in range(len(points) - 1) if points[index + 1][0] >= 0.0 or index == len(points) - 2)
    slopes = [(points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]) for i in range(len(points) - 1)]
    corner = points[below + 1][0] == 0.0 and below + 1 < len(slopes)
    return 0.5 * (slopes[below] + slopes[below + 1]) if corner else slopes[below]
