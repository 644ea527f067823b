"""Points, curves and parameters of a table of a car, put into the vehicle table of a new car."""

from typing import Any

import numpy as np

from vehicle.digits import rounded
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.whole_body import put
from vehicle.studies.design.mass_balance import axle_loads, kerb_model
from vehicle.studies.design.moved_points import DIGITS, Sources
from vehicle.studies.design.template_car import TemplateCar
from vehicle.studies.design.unsprung_parts import times
from vehicle.studies.tables.car_table import CarTable


def put_points(table: dict[str, Any], template: TemplateCar, points: CarTable) -> Sources:
    """Put the points of a table into a vehicle table with placed axles; return their sources.

    A point is placed from the wheel centre of its axle. The lower seat of a spring around a strut that the table leaves
    out stays at its share of the line through the strut.
    """
    sources = Sources()
    for word, points_of_axle in points.points.items():
        axle = template.axle(word)
        old = template.table[axle]["hardpoints"]
        new = table[axle]["hardpoints"]
        center = new[_name(template, word, "center")]
        for name, (x, y, z) in points_of_axle.items():
            at = [center[0] + x, y, center[2] + z]
            if name == _name(template, word, "patch"):
                at[2] = new[name][2]
            _enter(table, sources, f"{axle}.hardpoints.{name}", at, f"given: {points.origin(word, name)}")
        strut = ("damper_bottom", "strut_top", "spring_lower")
        if (
            set(strut) <= set(old)
            and {"strut_top", "damper_bottom"} & set(points_of_axle)
            and "spring_lower" not in points_of_axle
        ):
            bottom, top, seat = (np.array(old[name], dtype=float) for name in strut)
            share = float((seat - bottom) @ (top - bottom) / ((top - bottom) @ (top - bottom)))
            new = table[axle]["hardpoints"]
            bottom, top = (np.array(new[name], dtype=float) for name in strut[:2])
            seat = bottom + share * (top - bottom)
            _enter(table, sources, f"{axle}.hardpoints.spring_lower", seat.tolist(),
                   f"estimated: on the line of the strut, at its share in template {template.name}")  # fmt: skip
    return sources


def _name(template: TemplateCar, word: str, which: str) -> str:
    """Return the name of the wheel centre or the tyre patch of an axle in its table."""
    return template.wheels[word][0].paths[("center", "patch").index(which)].rpartition(".")[2]


def _enter(table: dict[str, Any], sources: Sources, path: str, point: list[float], source: str) -> None:
    put(table, {path: [round(float(value), DIGITS) + 0.0 for value in point]})  # type: ignore[dict-item]
    sources[path] = source


def put_parameters(table: dict[str, Any], template: TemplateCar, points: CarTable) -> Sources:
    """Put the numbers of tyres, bushings and parts of a table into a vehicle table; return their sources.

    Raises:
        ConfigurationError: the axle of the template has no such part.
    """
    sources = Sources()
    for (word, path), (value, origin) in points.parameters.items():
        suffix = path.removeprefix("tyre.")
        whole = f"{template.tyre_paths[word]}.{suffix}" if suffix != path else f"{template.axle(word)}.{path}"
        vector = whole.removesuffix(".z")
        try:
            before = value_at(table, vector.rpartition(".")[0])
        except (KeyError, ConfigurationError):
            before = None
        if before is None:
            raise ConfigurationError(
                f"{origin}: the {word} axle of {template.name} has no {path}; remove the row, or start from another car"
            )
        if whole != vector:
            numbers = list(value_at(table, vector))
            numbers[2] = value
            put(table, {vector: numbers})  # type: ignore[dict-item]
        else:
            put(table, {vector: value})
        sources[vector] = f"given: {origin}"
        beside = f"{vector.removesuffix('.mass')}.inertia"
        if vector.endswith(".mass") and isinstance(before.get("inertia"), list | tuple):
            put(table, {beside: times(before["inertia"], value / before["mass"])})
            sources[beside] = f"template {template.name}, in proportion to the mass"
    return sources


def put_tyre(table: dict[str, Any], template: TemplateCar, points: CarTable) -> Sources:
    """Put slip stiffness, trail and carcass of a tyre file, under the load of each axle, into a vehicle table."""
    sources, tyre = Sources(), points.tyre
    if tyre is None:
        return sources
    loads = axle_loads(kerb_model(table, template), template)
    for word, path in template.tyre_paths.items():
        load = 0.5 * loads[word] * template.vehicle.gravity
        along, across = tyre.carcass()
        at = f"{tyre.file} ({tyre.model}) at {load:.0f} N"
        numbers = {
            "slip_stiffness": (tyre.longitudinal(load), at),
            "cornering_stiffness": (tyre.lateral(load), at),
            "trail": (min(max(tyre.trail(load), 0.0), 0.1), at),
            "carcass_longitudinal": (along, f"{tyre.file} at {tyre.nominal_load:.0f} N"),
            "carcass_lateral": (across, f"{tyre.file} at {tyre.nominal_load:.0f} N"),
        }
        for name, (value, origin) in numbers.items():
            if value is None:
                points.left_out.append(("", f"{word} {name}: {tyre.file} has no transient coefficients; template"))
                continue
            put(table, {f"{path}.{name}": rounded(value, 6)})
            sources[f"{path}.{name}"] = f"given: {origin}"
    return sources
