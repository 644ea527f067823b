"""Points of the axles of a table in the vehicle frame, relative to the wheel centre of their axle."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle.errors import DataError
from vehicle.studies.tables.axes import SEPARATE, SIGNS, Axes, Vector3, axes_of, seen_axes, stated_axes
from vehicle.studies.tables.point_names import point_of
from vehicle.studies.tables.statements import Point, Statements
from vehicle.studies.tables.unit_factor import LENGTH, unit_factor

HALF_TRACK = {"m": (0.4, 1.4), "mm": (400.0, 1400.0)}
"""Possible sizes of the outermost y of an axle, by the unit."""

MIRRORED = 5e-4
"""Largest deviation of a left point from the mirrored right one [m] that gets no note: half a millimetre."""


@dataclass(slots=True)
class AxlePoints:
    """Points of one axle, right side.

    Attributes:
        at: x and z from the wheel centre, y from the middle of the car, by point [m].
        rows_of_file: row and name in the file, by point.
        half_track: y of the wheel centre [m].
        radius: height of the wheel centre above the tyre patch [m]; None without a patch.
    """

    at: dict[str, Vector3] = field(default_factory=dict)
    rows_of_file: dict[str, tuple[str, str]] = field(default_factory=dict)
    half_track: float = 0.0
    radius: float | None = None


@dataclass(slots=True)
class PlacedPoints:
    """Points of a table.

    Attributes:
        axles: by "front" and "rear".
        wheelbase: distance of the wheel centres in x [m]; None if they have no common frame.
        cog: x and z of the CoG from the front wheel centre [m], and whether it is of the sprung mass; or None.
        axes: directions in the table; None without points.
        guessed, left_out: sentences, each with the place or "".
    """

    axles: dict[str, AxlePoints] = field(default_factory=dict)
    wheelbase: float | None = None
    cog: tuple[float, float, bool] | None = None
    axes: Axes | None = None
    guessed: list[tuple[str, str]] = field(default_factory=list)
    left_out: list[tuple[str, str]] = field(default_factory=list)


def placed_points(content: Statements, radius: Mapping[str, float], half_track: Mapping[str, float]) -> PlacedPoints:
    """Return the points of a table in the vehicle frame.

    Args:
        content: statements of the file.
        radius, half_track: stated loaded radius and half track by axle [m], where a wheel centre is missing.

    Raises:
        DataError: two points of one name, left-handed or unknown axes, unknown units, no wheel centre.
    """
    placed = PlacedPoints()
    listed: list[tuple[str, Point]] = []
    for point in content.points:
        key = point_of(point.name)
        if key is None:
            placed.left_out.append((point.where, f"point {point.name.text!r}: no point of the axles here"))
        else:
            listed.append((key, point))
    if not listed:
        return placed
    scale = _unit(content, listed, placed)
    cogs = [(key, point) for key, point in listed if key == "cog"]
    axles = _by_axle(content, [(key, point) for key, point in listed if key != "cog"], scale, placed)
    raw = {axle: {key: at for key, (at, _) in points.items()} for axle, (points, _) in axles.items()}
    sides = {axle: side for axle, (_, side) in axles.items()}
    placed.axes = axes = axes_of(
        stated_axes(content.remarks, content.file), seen_axes(raw, sides, content.file), content.file
    )
    centers: dict[str, Vector3] = {}
    for axle, (points, _) in axles.items():
        centers[axle] = _center(content, axle, raw[axle], axes, radius.get(axle), half_track.get(axle), placed)
        placed.axles[axle] = _relative(points, centers[axle], axes)
    if len(centers) == 2:
        distance = SIGNS[axes.x] * (centers["rear"][0] - centers["front"][0])
        placed.wheelbase = distance if abs(distance) > SEPARATE else None
        if placed.wheelbase is None:
            placed.guessed.append(("", "each axle has a separate origin, because both wheel centres have the same x"))
    if cogs and "front" in centers:
        (_, point), *more = cogs
        if more:
            raise DataError(f"{more[0][1].where}: a second centre of gravity; give one")
        x, _, z = (scale(point) * value for value in point.at)
        placed.cog = (SIGNS[axes.x] * (x - centers["front"][0]), SIGNS[axes.z] * (z - centers["front"][2]),
                      point.name.has("sprung"))  # fmt: skip
    return placed


def _unit(content: Statements, listed: list[tuple[str, Point]], placed: PlacedPoints):  # type: ignore[no-untyped-def]
    """Return a function from a point to the factor of its unit."""
    stated = {point.unit for _, point in listed if point.unit}
    for unit in stated:
        factor = unit_factor(unit)
        if factor is None or factor.dimension != LENGTH:
            where = next(point.where for _, point in listed if point.unit == unit)
            raise DataError(f"{where}: unit {unit!r} is no length; write mm, m, cm or in")
    guess = ""
    if any(not point.unit for _, point in listed):
        outer = max(abs(point.at[1]) for _, point in listed if not point.unit)
        fitting = [unit for unit, (low, high) in HALF_TRACK.items() if low <= outer <= high]
        if len(fitting) != 1:
            raise DataError(
                f"{content.file}: points have no unit, and their largest y of {outer:g} is no half track in m or mm; "
                "write the unit in the header, for example x [mm]"
            )
        guess = fitting[0]
        placed.guessed.append(("", f"points without a unit: {guess}, because the largest y is {outer:g}"))
    factors = {unit: entry.factor for unit in (*stated, guess) if unit and (entry := unit_factor(unit)) is not None}
    largest = max(factors[point.unit or guess] * max(map(abs, point.at)) for _, point in listed)
    if largest > 20.0:
        raise DataError(f"{content.file}: a point is {largest:g} m from the origin; check the unit of the points")
    return lambda point: factors[point.unit or guess]


Chosen = dict[str, tuple[Vector3, Point]]


def _by_axle(content: Statements, listed: list[tuple[str, Point]], scale, placed: PlacedPoints):  # type: ignore[no-untyped-def]
    """Return the side and the points of each axle: by axle, ({point: (coordinates, row)}, side)."""
    named = {point.name.axle for _, point in listed if point.name.axle}
    default = ""
    if any(not point.name.axle for _, point in listed):
        default = "front" if not named else named.pop() if len(named) == 1 else ""
        if not default:
            lost = next(point for _, point in listed if not point.name.axle)
            raise DataError(f"{lost.where}: {lost.name.text!r} names no axle; add a column "
                            "axle, or begin its name with front or rear")  # fmt: skip
        placed.guessed.append(("", f"points that name no axle: {default} axle"))
    groups: dict[str, dict[str, dict[str, tuple[Vector3, Point]]]] = {}
    for key, point in listed:
        factor, side = scale(point), point.name.side
        at = (factor * point.at[0], factor * point.at[1], factor * point.at[2])
        entries = groups.setdefault(point.name.axle or default, {}).setdefault(key, {})
        if side in entries:
            other, first = entries[side]
            mirrored = (other[0], -other[1], other[2])
            if side or max(abs(a - b) for a, b in zip(at, mirrored, strict=True)) > MIRRORED or at[1] == 0.0:
                raise DataError(
                    f"{point.where}: {point.name.text!r} and {first.name.text!r} ({first.where.rpartition(':')[2]}) "
                    "are the same point of one side of an axle; remove one, or name axle and side"
                )
            continue
        entries[side] = (at, point)
    result = {}
    for axle, points in groups.items():
        counts = {side: sum(side in entries for entries in points.values()) for side in ("right", "left", "", "single")}
        side = max(counts, key=lambda name: counts[name])
        chosen: Chosen = {}
        for key, entries in points.items():
            name = side if side in entries else next(iter(entries))
            chosen[key] = entries[name]
            turn = {side, name} == {"left", "right"}
            at, point = entries[name]
            chosen[key] = ((at[0], -at[1] if turn else at[1], at[2]), point)
            if {"left", "right"} <= set(entries):
                left, right = (entries[end][0] for end in ("left", "right"))
                apart = max(abs(left[0] - right[0]), abs(left[1] + right[1]), abs(left[2] - right[2]))
                if apart > MIRRORED:
                    placed.left_out.append((point.where, f"{point.name.text!r}: left and right differ by "
                                            f"{1e3 * apart:.1f} mm; the {name} side is used for both"))  # fmt: skip
        result[axle] = (chosen, side)
    return result


def _center(content: Statements, axle: str, points: Mapping[str, Vector3], axes: Axes, radius: float | None,
            half_track: float | None, placed: PlacedPoints) -> Vector3:  # fmt: skip
    """Return the wheel centre of an axle in the axes of the table."""
    if "wheel_center" in points:
        return points["wheel_center"]
    if "tyre_patch" in points and radius is not None:
        x, y, z = points["tyre_patch"]
        placed.guessed.append(("", f"{axle} wheel centre: the tyre radius above the tyre patch"))
        return (x, y, z + SIGNS[axes.z] * radius)
    remarks = " ".join(content.remarks).lower()
    if half_track is not None and "origin" in remarks and "axle" in remarks and "wheel cent" in remarks:
        placed.guessed.append(("", f"{axle} wheel centre: at the stated origin and the stated track"))
        sign = 1.0 if sum(point[1] for point in points.values()) >= 0.0 else -1.0
        return (0.0, sign * half_track, 0.0)
    raise DataError(
        f"{content.file}: the {axle} axle has no wheel centre, from which its points are placed; add its row"
    )


def _relative(points: Chosen, center: Vector3, axes: Axes) -> AxlePoints:
    result = AxlePoints(half_track=abs(center[1]))
    outward = 1.0 if center[1] > 0.0 else -1.0
    if center[1] == 0.0:
        raise DataError("the wheel centre has y = 0; state half the track as y")
    for key, (at, point) in points.items():
        y = outward * at[1]
        if y < 0.0 or (y == 0.0 and key != "beam"):
            raise DataError(f"{point.where}: {point.name.text!r} lies at y = {at[1]:g} m, across the middle "
                            "from its wheel centre; correct its sign or its side")  # fmt: skip
        result.at[key] = (SIGNS[axes.x] * (at[0] - center[0]), y, SIGNS[axes.z] * (at[2] - center[2]))
        result.rows_of_file[key] = (point.where, point.name.text)
    if "tyre_patch" in result.at:
        result.radius = -result.at["tyre_patch"][2]
    return result
