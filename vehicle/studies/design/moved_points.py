"""Hardpoints of a new car: the axles of the template moved to another wheelbase, track and tyre radius.

An axle moves as a whole: along x by the change of the wheelbase, each side outwards by half the change of the track. So
a wheel keeps its kinematics relative to its body points. The distance of a body point from the front axle is scaled
with the wheelbase. Another tyre radius lowers or raises the ground under the car.
"""

from collections.abc import Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.whole_body import put
from vehicle.names import SIDE_SIGN
from vehicle.studies.design.stated_numbers import AXLES, StatedNumbers, option
from vehicle.studies.design.template_car import TemplateCar

Sources = dict[str, str]
"""Source of each changed parameter by its path."""

DIGITS = 6
"""Decimals of a coordinate [m]: a micrometre."""


def moved_points(template: TemplateCar, stated: StatedNumbers) -> tuple[dict[str, Any], Sources]:
    """Return the table of the template with the lengths of the new car, and the sources of what has moved."""
    table, sources = dict(template.table), Sources()
    along = (stated.wheelbase or template.wheelbase) - template.wheelbase
    radius = template.tyre_radius if stated.tyre_radius is None else stated.tyre_radius
    ground = template.wheels["front"][0].center[2] - radius
    for word in AXLES:
        axle, center = template.axle(word), template.wheels[word][0].center
        track = stated.of_axle("track", word)
        move = {
            "x": along if word == "rear" else 0.0,
            "y": 0.0 if track is None else (track - template.track(word)) / 2.0,
            "z": ground + radius - center[2],
        }
        patch = template.wheels[word][0].paths[1]
        for path, point, sign in _points_of(template.table, axle):
            new = [point[0] + move["x"], point[1] + sign * move["y"], point[2] + move["z"]]
            if path == patch or path.rpartition(".")[2] == patch.rpartition(".")[2]:
                new[2] = ground
            if sign * point[1] > 0.0 and not sign * new[1] > 0.0:
                raise ConfigurationError(
                    f"{option(f'track_{word}')} {track:g} m: must be above "
                    f"{template.track(word) - 2.0 * abs(point[1]):.3f} m, or {path} would be "
                    f"{1e3 * abs(new[1]):.0f} mm beyond the middle of the car"
                )
            _set(table, sources, path, point, new, _reason(stated, word, template.name))
    ratio = 1.0 + along / template.wheelbase
    for path, point in _body_points(template.table):
        new = [template.front_x + (point[0] - template.front_x) * ratio, *point[1:]]
        _set(table, sources, path, point, new, f"template {template.name}, x at the same share of the wheelbase")
    return table, sources


def _points_of(table: Mapping[str, Any], axle: str) -> list[tuple[str, list[float], float]]:
    """Return path, coordinates and sign of the side of every hardpoint of an axle."""
    groups = [(f"{axle}.hardpoints", table[axle].get("hardpoints", {}), 1.0)]
    for side, sign in SIDE_SIGN.items():
        groups.append((f"{axle}.{side}.hardpoints", table[axle].get(side, {}).get("hardpoints", {}), sign))
    return [(f"{path}.{name}", point, sign) for path, points, sign in groups for name, point in points.items()]


def _body_points(table: Mapping[str, Any]) -> list[tuple[str, list[float]]]:
    """Return path and coordinates of the points of the body: [hardpoints], outputs, connections of the file."""
    points = [(f"hardpoints.{name}", point) for name, point in table.get("hardpoints", {}).items()]
    for group in ("outputs", "connection"):
        entries = table.get(group, {}).items()
        points += [(f"{group}.{name}.at", entry["at"]) for name, entry in entries if isinstance(entry.get("at"), list)]
    return points


def _set(table: dict[str, Any], sources: Sources, path: str, old: list[float], new: list[float], reason: str) -> None:
    rounded = [round(value, DIGITS) for value in new]
    if any(abs(a - b) >= 10.0**-DIGITS for a, b in zip(old, rounded, strict=True)):
        put(table, {path: rounded})  # type: ignore[dict-item]
        sources[path] = reason


def _reason(stated: StatedNumbers, word: str, template: str) -> str:
    """Return the source of a moved point of an axle."""
    names = ["wheelbase"] if word == "rear" else []
    names += [f"track_{word}", "tyre_radius"]
    lengths = ", ".join(stated.stated(name) for name in names if getattr(stated, name) is not None)
    return f"template {template}, moved with its axle: {lengths}"
