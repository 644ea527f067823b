"""Masses, inertias and wheels of a car in a URDF file: links with inertia, joined by joints with an origin.

    r_child = r + R(rpy) ...,  m = sum m_i,  m c = sum m_i c_i,  I = sum (R I_i R' + m_i (|d_i|^2 1 - d_i d_i'))

Links with "wheel" in their name are the wheels; the unsprung masses are the wheels and the links that lead only
to one of them. Frame of URDF: x forward, y left, z up, SI units (ROS REP 103).

Source: specification of URDF (ROS), elements link, inertial, joint.
"""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.text import read_text
from vehicle.studies.tables.name_words import NameWords, name_words
from vehicle.studies.tables.statements import Number, Point, Statements

FRAME = "axes: x forward, y left, z up"


@dataclass(slots=True)
class _Link:
    name: str
    mass: float
    cog: Vector  # in the frame of the link
    inertia: Vector
    radius: float
    parent: str = ""
    origin: Vector | None = None
    turn: Vector | None = None


def read_robot_model(path: Path) -> Statements:
    """Return the masses, the inertia and the wheels of a URDF file.

    Raises:
        DataError: not a URDF file of a car with four wheels, or a link or joint is wrong.
    """
    text = read_text(path).body
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise DataError(f"{path}: has a document type; remove it, entities are not read")
    if "xacro:" in text:
        raise DataError(f"{path}: is a xacro file; run `xacro FILE > car.urdf` and give its result")
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise DataError(f"{path}: is no XML file ({error}); export it again") from None
    if root.tag != "robot":
        raise DataError(f"{path}: begins with <{root.tag}>, not with <robot>; give a URDF file")
    links = {link.get("name", ""): _link(path, link) for link in root.findall("link")}
    for joint in root.findall("joint"):
        parent, child = (joint.find(sort) for sort in ("parent", "child"))
        if parent is None or child is None or child.get("link") not in links or parent.get("link") not in links:
            raise DataError(f"{path}: joint {joint.get('name')!r} has no parent or no child that is a link; correct it")
        link = links[child.get("link", "")]
        link.parent = parent.get("link", "")
        link.origin, link.turn = _origin(path, joint.find("origin"))
    return _statements(path, links)


def _statements(path: Path, links: dict[str, _Link]) -> Statements:
    rows_of_file = {name: _place(path, links, name) for name in links}
    wheels = [name for name, link in links.items() if "wheel" in name.lower() and link.mass > 0.0
              and not any(other.parent == name and "wheel" in other.name.lower()
                          for other in links.values())]  # fmt: skip
    # A steering wheel is at no corner of the car.
    at_corners = [name for name in wheels if (parsed := name_words(name, right_letter="")).axle and parsed.side]
    wheels = at_corners if len(at_corners) == 4 else wheels
    if len(wheels) != 4:
        raise DataError(
            f"{path}: has {len(wheels)} links with a mass and 'wheel' in their names, must be 4; rename them"
        )
    centers = {name: rows_of_file[name][0] for name in wheels}
    middle = np.mean([center[0] for center in centers.values()])
    axles = {"front": [name for name in wheels if centers[name][0] > middle],
             "rear": [name for name in wheels if centers[name][0] <= middle]}  # fmt: skip
    if [len(names) for names in axles.values()] != [2, 2]:
        raise DataError(f"{path}: wheels are not at two axles along x; URDF has x forward, y left, z up")
    mass = sum(link.mass for link in links.values())
    cogs = {name: rows_of_file[name][0] + rows_of_file[name][1] @ link.cog for name, link in links.items()}
    cog = np.sum([link.mass * cogs[name] for name, link in links.items()], axis=0) / mass
    inertia = np.zeros((3, 3))
    for name, link in links.items():
        turn, arm = rows_of_file[name][1], cogs[name] - cog
        inertia += turn @ link.inertia @ turn.T + link.mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    content = Statements(file=path.name, remarks=[FRAME])

    def number(terms: str, value: float, unit: str, axle: str = "") -> None:
        name = NameWords(text=f"{terms} {axle} axle" if axle else terms, terms=tuple(terms.split()), axle=axle, side="")
        content.numbers.append(Number(where=str(path), name=name, value=round(value, 9), unit=unit))

    number("kerb mass", mass, "kg")
    for index, terms in enumerate(("roll inertia", "pitch inertia", "yaw inertia")):
        number(terms, inertia[index, index], "kg m2")
    for axle, names in axles.items():
        number("unsprung mass", sum(_unsprung(links, name, wheels) for name in names), "kg", axle)
        radius = max(links[name].radius for name in names)
        if radius:
            number("tyre radius loaded", radius, "m", axle)
        for name in names:
            side = "left" if centers[name][1] > 0.0 else "right"
            named = NameWords(text=name, terms=("wheel", "center"), axle=axle, side=side)
            at = centers[name]
            content.points.append(Point(where=str(path), name=named, at=(at[0], at[1], at[2]), unit="m"))
    whole = NameWords(text="centre of gravity of all links", terms=("cog",), axle="front", side="")
    content.points.append(Point(where=str(path), name=whole, at=(cog[0], cog[1], cog[2]), unit="m"))
    return content


def _unsprung(links: dict[str, _Link], wheel: str, wheels: list[str]) -> float:
    """Return the mass of a wheel and of the links that lead only to it."""
    mass, name = links[wheel].mass, links[wheel].parent
    while name and links[name].parent and sum(link.parent == name for link in links.values()) == 1:
        mass += links[name].mass
        name = links[name].parent
    return mass


def _place(path: Path, links: dict[str, _Link], name: str) -> tuple[Vector, Vector]:
    """Return position and directions of a link in the frame of the root."""
    at, turn, seen = np.zeros(3), np.eye(3), set()
    while links[name].parent:
        if name in seen:
            raise DataError(f"{path}: joints of link {name!r} form a loop; a URDF is a tree")
        seen.add(name)
        link = links[name]
        assert link.origin is not None and link.turn is not None  # fmt: skip
        at, turn = link.origin + link.turn @ at, link.turn @ turn
        name = link.parent
    return at, turn


def _link(path: Path, link: ElementTree.Element) -> _Link:
    inertial = link.find("inertial")
    mass, cog, inertia = 0.0, np.zeros(3), np.zeros((3, 3))
    if inertial is not None:
        mass = _values(path, inertial.find("mass"), "value")[0]
        cog, turn = _origin(path, inertial.find("origin"))
        element = inertial.find("inertia")
        xx, xy, xz, yy, yz, zz = (_values(path, element, key, missing="0")[0]
                                  for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))  # fmt: skip
        moments = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        inertia = turn @ moments @ turn.T
        if mass < 0.0 or np.linalg.eigvalsh(inertia).min() < -1e-9:
            raise DataError(f"{path}: link {link.get('name')!r} has a negative mass or moment of inertia; correct it")
    shapes = link.findall(".//cylinder") + link.findall(".//sphere")
    radius = max((_values(path, shape, "radius")[0] for shape in shapes), default=0.0)
    return _Link(name=link.get("name", ""), mass=mass, cog=cog, inertia=inertia, radius=radius)


def _origin(path: Path, element: ElementTree.Element | None) -> tuple[Vector, Vector]:
    at = _values(path, element, "xyz", missing="0 0 0", count=3)
    roll, pitch, yaw = _values(path, element, "rpy", missing="0 0 0", count=3)
    cr, sr, cp, sp, cy, sy = (math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch), math.cos(yaw),
                              math.sin(yaw))  # fmt: skip
    turn = np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                     [-sp, cp * sr, cp * cr]])  # fmt: skip
    return at, turn


def _values(path: Path, element: ElementTree.Element | None, key: str, missing: str | None = None,
            count: int = 1) -> Vector:  # fmt: skip
    text = missing if element is None else element.get(key, missing)
    try:
        values = np.array([float(word) for word in (text or "").split()])
    except ValueError:
        values = np.array([])
    if len(values) != count or not np.isfinite(values).all():
        tag = "an element" if element is None else f"<{element.tag}>"
        raise DataError(f"{path}: {tag} has {key} = {text!r}, must be {count} numbers; correct it")
    return values
