"""Table of a car in the words of the vehicle file, with guesses and omissions.

hardpoints, masses, CoG, inertia, rates, damper curves, tyres   CSV, text, XLSX
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vehicle.errors import DataError
from vehicle.studies.tables.axes import Vector3
from vehicle.studies.tables.axle_points import PlacedPoints, placed_points
from vehicle.studies.tables.car_numbers import car_numbers
from vehicle.studies.tables.number_names import DAMPING, RATE
from vehicle.studies.tables.point_names import OF_OTHER_AXLES, TEMPLATE_NAMES, point_of
from vehicle.studies.tables.statements import Number, Statements
from vehicle.studies.tables.table_file import file_statements
from vehicle.studies.tables.table_numbers import AXLES, CarNumbers, read_numbers
from vehicle.studies.tables.tyre_file import TyreFile
from vehicle.studies.tables.unit_factor import unit_factor


@dataclass(slots=True)
class CarTable:
    """Statements of a file on a car.

    Attributes:
        file: name of the file.
        numbers: values by names of `vehicle.studies.design.stated_numbers.StatedNumbers`.
        points: x and z from the wheel centre, y [m], by axle and name in its template.
        curves: velocity [m/s] and force [N] of the dampers by axle, extension positive.
        parameters: value and origin by axle and path in its table; "tyre." for its tyres.
        origins: rows behind each number, by name, and behind each point, by axle and name.
        guessed, left_out: sentences, each with its place in the file or "".
        axes: axes of the points in words; "" without points.
        axles: types of axles that replace the axles of the template.
        tyre: tyre of a `.tir` file, for its slip stiffness under the load of the car.
    """

    file: str
    numbers: dict[str, Any] = field(default_factory=dict)
    points: dict[str, dict[str, Vector3]] = field(default_factory=dict)
    curves: dict[str, list[tuple[float, float]]] = field(default_factory=dict)
    parameters: dict[tuple[str, str], tuple[Any, str]] = field(default_factory=dict)
    origins: dict[Any, str] = field(default_factory=dict)
    guessed: list[tuple[str, str]] = field(default_factory=list)
    left_out: list[tuple[str, str]] = field(default_factory=list)
    axes: str = ""
    tyre: TyreFile | None = None
    axles: dict[str, str] = field(default_factory=dict)

    def origin(self, axle: str, name: str) -> str:
        """Return the name of a point in the file, for the source of its coordinates."""
        return f"{self.origins[axle, name]} of {self.file}"


def car_table(
    paths: Sequence[Path], names: Mapping[str, Collection[str]], types: Mapping[str, Collection[str]] | None = None
) -> CarTable:
    """Read the statements of one or several files on one car.

    Args:
        paths: files; the axes of points may differ.
        names: names of the hardpoints and parts of the template by axle, "front" and "rear".
        types: the same of other types of axles, by the names of their templates; one replaces the axle of the template
            where the file has all points of its arms.

    Raises:
        ConfigurationError: a file is missing or of a kind that is not read.
        DataError: the content contradicts itself, or cannot be understood.
    """
    files = [file_statements(path) for path in paths]
    whole = Statements(file=", ".join(content.file for content in files))
    result, numbers = CarTable(file=whole.file), CarNumbers()
    for content in files:
        whole.numbers += content.numbers
        whole.remarks += content.remarks
        whole.curves += content.curves
        whole.bushings += content.bushings
        result.guessed += content.guessed
        result.left_out += content.left_out
        if content.tyre is not None:
            if result.tyre is not None:
                raise DataError(f"{content.file}: a second tyre file; give one, both axles have the same tyre")
            result.tyre = content.tyre
    names = _with_types(files, names, types or {}, result)
    whole.numbers = _without_parts(whole.numbers, names, result)
    values = read_numbers(whole, numbers)
    radius, track = ({axle: entry.value * factor for axle in AXLES
                      if (entry := values.get((key, axle)) or values.get((key, ""))) is not None}
                     for key, factor in (("tyre_radius", 1.0), ("track", 0.5)))  # fmt: skip
    lengths_given: dict[str, Any] = {}
    for content in files:
        _place(content, radius, track, names, lengths_given, result)
    at_spring = {axle: _has_spring(points) for axle, points in result.points.items()}
    car_numbers(values, numbers, lengths_given, at_spring)
    result.numbers, result.origins = numbers.stated, {**result.origins, **numbers.origins}
    result.parameters |= numbers.parameters
    _damper_curves(whole, result)
    _bushings(whole, names, result)
    result.guessed += numbers.guessed
    result.left_out += numbers.left_out
    if not (result.numbers or result.points or result.curves or result.parameters):
        examples = "; ".join(text for _, text in result.left_out[:3])
        raise DataError(f"{whole.file}: nothing in it is a number or a point of a car{examples and f' ({examples})'}; "
                        "name rows as in docs/howto/table.md")  # fmt: skip
    return result


ARMS = ("lower_ball", "lower_arm_front", "lower_arm_rear", "upper_ball", "upper_arm_front", "upper_arm_rear")
"""Points that make an axle one of double wishbones."""


def _with_types(files: Sequence[Statements], names: Mapping[str, Collection[str]],
                types: Mapping[str, Collection[str]], result: CarTable) -> dict[str, Collection[str]]:  # fmt: skip
    """Return the names of hardpoints and parts by axle, of another type where the points of a file need it."""
    changed = dict(names)
    rows = [point for content in files for point in content.points]
    only = {point.name.axle for point in rows} == {""}
    for axle in AXLES:
        keys = {point_of(point.name) for point in rows if point.name.axle == axle or (only and axle == "front")}
        if set(ARMS) <= keys and "upper_ball" not in names[axle] and "double_wishbone" in types:
            changed[axle] = types["double_wishbone"]
            result.axles[axle] = "double_wishbone"
            result.guessed.append(("", f"{axle} axle: double wishbones, in place of the axle of the template; "
                                   "its bushings, masses and points that the file lacks are assumed"))  # fmt: skip
    return changed


def _place(content: Statements, radius: Mapping[str, float], track: Mapping[str, float],
           names: Mapping[str, Collection[str]], lengths_given: dict[str, Any], result: CarTable) -> None:  # fmt: skip
    """Enter the points of a file, and the lengths and the centre of gravity that they give."""
    placed = placed_points(content, radius, track)
    lengths: dict[str, Any] = {"cog": placed.cog, "wheelbase": placed.wheelbase}
    for axle, points in placed.axles.items():
        if axle in result.points:
            raise DataError(f"{content.file}: has points of the {axle} axle like another file; give each axle once")
        lengths[f"track_{axle}"] = 2.0 * points.half_track
        if points.radius is not None and lengths.get("tyre_radius") is None:
            lengths["tyre_radius"] = points.radius
        _use_points(axle, placed, names[axle], result)
    lengths_given |= {key: value for key, value in lengths.items() if value is not None}
    result.guessed += placed.guessed
    result.left_out += placed.left_out
    if placed.axes is not None:
        result.axes = f"{placed.axes.text} ({placed.axes.origin})"


PARTS: dict[str, tuple[str, ...]] = {
    "lower arm": ("a_arm", "lower_arm"),
    "arm": ("a_arm",),
    "upper arm": ("upper_arm",),
    "knuckle": ("knuckle",),
    "wheel": ("tyre",),
    "wheel tyre": ("tyre",),
    "tie": ("steering_rod", "tie_link"),
    "brake disc": ("brake_disc",),
    "caliper": ("caliper",),
    "trailing": ("arm",),
}
"""Words of a part and its names in the templates."""


def _without_parts(rows: Sequence[Number], names: Mapping[str, Collection[str]], result: CarTable) -> list[Number]:
    """Return the numbers that are no masses of parts; enter these, which need an axle."""
    others = []
    for row in rows:
        terms = " ".join(sorted(set(row.name.terms) - {"mass", "gel", "ger"}, reverse="upper" in row.name.terms))
        terms = {"arm lower": "lower arm", "tyre wheel": "wheel tyre"}.get(terms, terms)
        unit = unit_factor(row.unit or "kg")
        if "mass" not in row.name.terms or terms not in PARTS or unit is None or not isinstance(row.value, float):
            others.append(row)
            continue
        axle = row.name.axle
        part = next((name for name in PARTS[terms] if axle and f"parts.{name}" in names[axle]), "")
        if part:
            result.parameters[axle, f"parts.{part}.mass"] = (row.value * unit.factor, f"{row.name.text} ({row.where})")
        else:
            why = f"the {axle} axle of the template has no such part" if axle else "names no axle"
            result.left_out.append((row.where, f"{row.name.text!r} = {row.value:g}: {why}"))
    return others


def _use_points(axle: str, placed: PlacedPoints, names: Collection[str], result: CarTable) -> None:
    """Enter the points of an axle by their names in the template, or give the reason why they do not fit it."""
    points = placed.axles[axle]
    named = {key: next((name for name in TEMPLATE_NAMES[key] if name in names), "") for key in points.at}
    other = sorted({OF_OTHER_AXLES[key] for key, name in named.items() if not name and key in OF_OTHER_AXLES})
    if other:
        result.left_out.append(("", f"points of the {axle} axle but its wheel centre: the template has no "
                                f"{' and no '.join(other)}; start from a car with such an axle (--from)"))  # fmt: skip
        named = {key: name if key in ("wheel_center", "tyre_patch") else "" for key, name in named.items()}
    used: dict[str, Vector3] = {}
    for key, name in named.items():
        where, text = points.rows_of_file[key]
        if name:
            used[name] = points.at[key]
            result.origins[axle, name] = text
        elif not other:
            result.left_out.append((where, f"{text!r}: the {axle} axle of the template has no such point"))
    if {"damper_upper", "damper_lower"} <= set(used) and axle in result.axles and "spring_lower" not in used:
        used |= {"spring_upper": used["damper_upper"], "spring_lower": used["damper_lower"]}
        result.origins |= {(axle, name): "around the damper" for name in ("spring_upper", "spring_lower")}
        result.guessed.append(("", f"{axle} spring: around the damper, because its seats are not in the file"))
    result.points[axle] = used


def _has_spring(points: Mapping[str, Vector3]) -> bool:
    """True if the points of an axle contain its spring seats and an arm."""
    seats = "strut_top" in points or {"spring_lower", "spring_upper"} <= set(points)
    return seats and bool({"lower_ball", "pivot"} & set(points))


BUSHINGS = {
    "lower_arm_front": ("arm_front", "lower_front"),
    "lower_arm_rear": ("arm_rear", "lower_rear"),
    "upper_arm_front": ("upper_front",),
    "upper_arm_rear": ("upper_rear",),
    "strut_top": ("suspension_mount", "damper_mount"),
    "trailing_pivot": ("pivot",),
}
"""Point -> names of its bushing in the templates."""


def _bushings(content: Statements, names: Mapping[str, Collection[str]], result: CarTable) -> None:
    """Enter stiffness and damping of bushings along the axes of the car, x, y and z."""
    for row in content.bushings:
        key, axle = point_of(row.name), row.name.axle
        unit = unit_factor(row.unit)
        if unit is None or unit.dimension not in (RATE, DAMPING):
            raise DataError(f"{row.where}: bushing {row.name.text!r} with the unit {row.unit or 'nothing'!r}; "
                            "write N/mm or N s/mm in the header, for example kx [N/mm]")  # fmt: skip
        named = next((name for name in BUSHINGS.get(key or "", ()) if axle and f"bushings.{name}" in names[axle]), "")
        if not named:
            why = f"the {axle} axle of the template has no such bushing" if axle else "names no axle"
            result.left_out.append((row.where, f"bushing {row.name.text!r}: {why}"))
            continue
        path = f"bushings.{named}.{'stiffness' if unit.dimension == RATE else 'damping'}"
        if (axle, path) in result.parameters:
            raise DataError(f"{row.where}: a second bushing {row.name.text!r} of the {axle} axle; remove one")
        result.parameters[axle, path] = ([unit.factor * value for value in row.at], f"{row.name.text} ({row.where})")
    if content.bushings:
        result.guessed.append(("", "bushings: x, y and z of their table are axes of the car"))


def _damper_curves(content: Statements, result: CarTable) -> None:
    """Enter the damper curves; forces of the other sign than the velocity are turned."""
    for curve in content.curves:
        scale = []
        for unit, dimension, si in zip(curve.units, ((0, 1, -1, 0), (1, 1, -2, 0)), ("m/s", "N"), strict=True):
            factor = unit_factor(unit, dimension)
            if factor is None or factor.dimension != dimension:
                raise DataError(f"{curve.where}: damper curve with the unit {unit or 'nothing'!r}; write {si} in its "
                                "header, for example force [N]")  # fmt: skip
            scale.append(factor.factor)
        if not curve.axle:
            raise DataError(f"{curve.where}: damper curve of no axle; write a title above it: damper front")
        if curve.axle in result.curves:
            raise DataError(f"{curve.where}: a second damper curve of the {curve.axle} axle; remove one")
        rows = sorted((velocity * scale[0], force * scale[1]) for velocity, force in curve.rows)
        if all(velocity * force <= 0.0 for velocity, force in rows):
            rows = [(velocity, -force) for velocity, force in rows]
            result.guessed.append((curve.where, "damper forces turned: they oppose the velocity"))
        result.curves[curve.axle] = rows
        result.origins[curve.axle, "curve"] = curve.where
        for name in ("wheel_damping", "damper_constant", "damping_ratio"):
            if (value := result.numbers.pop(f"{name}_{curve.axle}", None)) is not None:
                result.left_out.append(
                    ("", f"{name.replace('_', ' ')} {curve.axle} {value:g}: the damper has a curve in the table")
                )
