"""Points and masses of an Adams model: a solver deck (`.adm`), or commands of Adams View (`.cmd`).

A deck names a statement by a comment above it; positions of markers on a part are turned by its Euler angles (z, x, z):

    ! adams_view_name='hpl_lca_front'          point create point_name = .car.ground.hpl_lca_front &
    MARKER/12, PART = 1, QP = -200, -400, 225     location = -200, -400, 225

    r = r_part + A_z(psi) A_x(theta) A_z(phi) r_marker

Source: documentation of Adams Solver, statements PART, MARKER, UNITS (REULER: body 3-1-3 rotations).
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.teim_orbit import UNITS
from vehicle.signals.formats.text import read_text
from vehicle.studies.tables.name_words import name_words, right_letters
from vehicle.studies.tables.point_names import point_of
from vehicle.studies.tables.statements import Number, Point, Statements
from vehicle.studies.tables.unit_factor import unit_factor

_NAME = re.compile(r"adams_view_name\s*=\s*'([^']*)'", re.IGNORECASE)
_VALUE = re.compile(r"[,\s]([A-Za-z_]+)\s*=\s*(.*?)(?=[,\s]\s*[A-Za-z_]+\s*=|$)", re.DOTALL)
_DECK = re.compile(r"(PART|MARKER|UNITS|POINT_MASS)/(\d*)(.*)", re.IGNORECASE | re.DOTALL)
_COMMAND = re.compile(r"(point|marker|part) +(?:create|modify)(?: +rigid_body +\w+)?\b(.*)|defaults +units(.*)",
                      re.IGNORECASE | re.DOTALL)  # fmt: skip


@dataclass(slots=True)
class _Part:
    name: str
    position: Vector
    turn: Vector
    mass: float = 0.0


@dataclass(slots=True)
class _Model:
    length: str = ""
    mass: str = ""
    parts: dict[str, _Part] = field(default_factory=dict)
    points: list[tuple[str, str, str, Vector]] = field(default_factory=list)


def read_adams_model(path: Path) -> Statements:
    """Return the statements of an Adams model.

    Raises:
        DataError: no named point or part can be read, or the unit of length is missing.
    """
    lines = read_text(path).lines
    model = _Model()
    for where, name, text in _statements(path, lines):
        if match := _DECK.match(text):
            _deck(model, where, name, match[1].upper(), match[2], dict(_pairs(match[3])))
        elif match := _COMMAND.match(text):
            _command(model, where, (match[1] or "units").lower(), dict(_pairs(" " + (match[2] or match[3]))))
    content = Statements(file=path.name)
    names = [name for _, name, _, _ in model.points] + [part.name for part in model.parts.values()]
    letters = right_letters(names)
    seen: dict[str, Vector] = {}
    for where, name, part, at in model.points:
        terms = name_words(name.replace(".", " "), right_letter=letters.get(name, ""), where=where)
        if point_of(terms) is None:
            continue
        frame = model.parts.get(part)
        ground = at if frame is None else frame.position + frame.turn @ at
        key = f"{point_of(terms)} {terms.axle} {terms.side}"
        if key in seen and np.allclose(seen[key], ground, atol=1e-6 * (1.0 + np.abs(ground).max())):
            continue
        seen[key] = ground
        content.points.append(Point(where=where, name=terms, at=(ground[0], ground[1], ground[2]), unit=model.length))
    for body in model.parts.values():
        if body.mass:
            terms = name_words(f"{body.name.replace('.', ' ')} mass", right_letter=letters.get(body.name, ""))
            content.numbers.append(Number(where=str(path), name=terms, value=body.mass, unit=model.mass or "kg"))
    if not (content.points or content.numbers):
        raise DataError(f"{path}: has no point or part with a known name; export the hardpoints as a table (CSV)")
    if not model.length:
        raise DataError(f"{path}: does not state its unit of length (UNITS or defaults units); add it")
    return content


def _statements(path: Path, lines: Sequence[str]):  # type: ignore[no-untyped-def]
    """Yield place, name of the comment above, and whole text of each statement, with its continued lines."""
    name, text, where, continued = "", "", "", False
    for number, raw in enumerate(lines, 1):
        line = raw.strip()
        if line.startswith("!"):
            if match := _NAME.search(line):
                if text:
                    yield where, name, text
                    text = ""
                name = match[1]
            continue
        if line.startswith(",") or continued:
            text += " " + line.rstrip("&")
        else:
            if text:
                yield where, name, text
                name = "" if not line else name
            text, where = line.rstrip("&"), f"{path}:{number}"
        continued = line.endswith("&")
    if text:
        yield where, name, text


def _pairs(text: str) -> list[tuple[str, str]]:
    return [(key.lower(), value.strip().rstrip(",").strip()) for key, value in _VALUE.findall(text)]


def _numbers(text: str | None) -> Vector:
    """Return up to three numbers; angles with the letter d are degrees."""
    if not text:
        return np.zeros(3)
    values = []
    for word in text.replace("(", "").replace(")", "").split(","):
        degrees = word.strip().lower().endswith("d")
        try:
            value = float(word.strip().lower().rstrip("d"))
        except ValueError:
            return np.full(3, math.nan)
        values.append(math.radians(value) if degrees else value)
    return np.array([*values, 0.0, 0.0][:3])


def _turn(angles: Vector) -> Vector:
    """Return A_z(psi) A_x(theta) A_z(phi)."""

    def about(axis: int, angle: float) -> Vector:
        c, s = math.cos(angle), math.sin(angle)
        if axis == 2:
            return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])

    return np.asarray(about(2, angles[0]) @ about(0, angles[1]) @ about(2, angles[2]))


def _deck(model: _Model, where: str, name: str, sort: str, number: str, values: dict[str, str]) -> None:
    if sort == "UNITS":
        model.length, model.mass = _unit(values.get("length", "")), _unit(values.get("mass", ""))
    elif sort == "PART":
        mass = _numbers(values.get("mass"))[0]
        model.parts[number] = _Part(name or f"part {number}", _numbers(values.get("qg")),
                                    _turn(_numbers(values.get("reuler"))), mass)  # fmt: skip
    elif sort == "MARKER" and name:
        model.points.append((where, name, values.get("part", ""), _numbers(values.get("qp"))))


def _command(model: _Model, where: str, sort: str, values: dict[str, str]) -> None:
    if sort == "units":
        model.length = _unit(values.get("length", model.length))
        model.mass = _unit(values.get("mass", model.mass)) or model.mass
        return
    name = values.get(f"{sort}_name", values.get("name", ""))
    if sort == "part":
        part = model.parts.setdefault(name, _Part(name.rpartition(".")[2], np.zeros(3), np.eye(3)))
        if "location" in values:
            part.position = _numbers(values["location"])
            angles = values.get("orientation", "")
            part.turn = _turn(_numbers(angles if "d" in angles.lower() else angles.replace(",", "d,") + "d"
                                       if angles else None))  # fmt: skip
        if "mass" in values:
            part.mass = float(_numbers(values["mass"])[0])
    elif "location" in values:
        owner, _, last = name.rpartition(".")
        model.points.append((where, last, owner, _numbers(values["location"])))


def _unit(text: str) -> str:
    """Return a unit of Adams in the words of a table."""
    plain = text.strip().lower()
    if plain in UNITS["LENGTH"]:
        return next(unit for unit in ("m", "mm", "cm", "in", "ft", "km")
                    if UNITS["LENGTH"][unit] == UNITS["LENGTH"][plain])  # fmt: skip
    plain = {"kilogram": "kg", "gram": "g", "pound_mass": "lb", "slug": "slug", "tonne": "t"}.get(plain, plain)
    return plain if unit_factor(plain) is not None else ""
