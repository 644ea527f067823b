"""The design of a body as data: nodes, members and sections of a space frame, apart from the car that it is built for.

Interface and output points are hardpoints of the vehicle and stand in its file only; a design adds the joints of the
shell, the members between all of them, and what a frame of beams cannot know: guessed masses and local stiffnesses.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import BeamSection
from vehicle.model.parameters.hardpoints import Point, mirrored
from vehicle.model.parameters.quantity import quantity, validate
from vehicle.model.parameters.toml_file import build, nearest, read_table

FORMAT = "body design 1"
_SIDES = (("_fr", "_fl"), ("_rr", "_rl"), ("_right", "_left"))
"""Endings of the right and the left node of a pair: at the wheels, elsewhere."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DesignNode:
    """A node, or a pair of them; without `place` and `mirror` it is the hardpoint of its name."""

    mass: float = quantity("kg", "guess of the mass that it carries", above=0.0)
    freedom: float = quantity("-", "how far the guess may be changed, relative to the others", above=0.0)
    place: Point | None = quantity("m", "joint of the shell, right side; single where y = 0", length=3, default=None)
    mirror: str | None = quantity("-", "single hardpoint whose mirror image it is", default=None)
    attachment: Point | None = quantity("N/m", "local stiffness, x, y, z", above=0.0, length=3, default=None)

    def __post_init__(self) -> None:
        validate(self)
        if self.place is not None and self.mirror is not None:
            raise ConfigurationError("DesignNode.mirror: found beside place; a node has one of them, or none")
        if self.place is not None and self.place[1] < 0.0:
            raise ConfigurationError(
                f"DesignNode.place: found y = {self.place[1]} m, allowed are 0 and more; the left side is mirrored"
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class MemberGroup:
    """Members of one section: a thin-walled square tube (`width`, `wall`), or a strut for a panel in shear (`area`)."""

    between: tuple[str, ...]
    """ends of each member: "a-b", crossed "a=b", "a" across the car"""
    width: float | None = quantity("m", "width of a tube", above=0.0, default=None)
    wall: float | None = quantity("m", "wall thickness of a tube", above=0.0, default=None)
    area: float | None = quantity("m2", "area of a strut", above=0.0, default=None)
    factor: float | None = quantity("-", "fitted factor on the stiffness; none: 1", above=0.0, default=None)

    def __post_init__(self) -> None:
        validate(self)
        given = [name for name in ("width", "wall", "area") if getattr(self, name) is not None]
        if given not in (["width", "wall"], ["area"]):
            raise ConfigurationError(
                f"MemberGroup.between: a section of {', '.join(given) or 'nothing'}; needed are width and wall of a "
                "tube, or the area of a strut"
            )
        if not self.between:
            raise ConfigurationError("MemberGroup.between: found an empty list, needed is at least one member")

    def sections(self, youngs: float, shear: float) -> tuple[BeamSection, BeamSection]:
        """Stiffness that the factor scales, and stiffness that stays.

        Tube of width w and wall t: A = 4 w t, I = 2/3 w^3 t, J = w^3 t; its axial stiffness stays nominal.

        Args:
            youngs: Young's modulus [N/m2].
            shear: shear modulus [N/m2].
        """
        nothing = BeamSection(axial=0.0, torsion=0.0, bending_y=0.0, bending_z=0.0)
        if self.width is None or self.wall is None:
            area = self.area or 0.0
            return BeamSection(axial=youngs * area, torsion=0.0, bending_y=0.0, bending_z=0.0), nothing
        bending = youngs * (2.0 / 3.0 * self.width**3 * self.wall)
        torsion = shear * self.width**3 * self.wall
        return (
            BeamSection(axial=0.0, torsion=torsion, bending_y=bending, bending_z=bending),
            BeamSection(axial=youngs * 4.0 * self.width * self.wall, torsion=0.0, bending_y=0.0, bending_z=0.0),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyDesign:
    """Everything of a body that is neither a hardpoint nor a mass property of the vehicle."""

    format: str = quantity("-", "kind of file", choices=(FORMAT,))
    name: str = quantity("-", "name of the body")
    provenance: str
    """where the numbers come from, in words"""
    mode_count: float = quantity("-", "number of elastic modes, the lowest", at_least=1.0, at_most=60.0)
    damping_ratio: float = quantity("-", "share of critical damping of every mode", at_least=0.0, at_most=0.3)
    youngs_modulus: float = quantity("N/m2", "Young's modulus", above=0.0)
    shear_modulus: float = quantity("N/m2", "shear modulus", above=0.0)
    node_rotations: bool = False
    """true: the model knows the rotations of its nodes, which elements with a rotational stiffness then act on"""
    least_ixx: float = quantity(
        "kg m2", "least Ixx about the CoG that the node masses are fitted to", at_least=0.0, default=0.0
    )
    nodes: Mapping[str, DesignNode]
    members: Mapping[str, MemberGroup]

    def __post_init__(self) -> None:
        validate(self)
        if self.mode_count != int(self.mode_count):
            raise ConfigurationError(f"BodyDesign.mode_count: found {self.mode_count!r}, needed is a whole number")

    @property
    def factors(self) -> dict[str, float]:
        """Factor of every member group [1]."""
        return {name: 1.0 if group.factor is None else group.factor for name, group in self.members.items()}

    @property
    def fitted_groups(self) -> tuple[str, ...]:
        """Member groups with a fitted factor."""
        return tuple(name for name, group in self.members.items() if group.factor is not None)

    def placed(self, points: Mapping[str, Point]) -> dict[str, dict[str, Point]]:
        """Nodes of every entry on a car: one, or the right and the left one.

        Args:
            points: of the car.

        Returns:
            Name of the entry -> name of the node -> position in the vehicle frame [m].

        Raises:
            ConfigurationError: the car has no such hardpoint, or two nodes have one name.
        """
        found: dict[str, dict[str, Point]] = {}
        for name, node in self.nodes.items():
            pair = next((ends for ends in _SIDES if f"{name}{ends[0]}" in points), None)
            if node.place is not None:
                right, left = (f"{name}{end}" for end in _SIDES[-1])
                pairs = {right: node.place, left: mirrored(node.place, -1.0)}
                found[name] = pairs if node.place[1] > 0.0 else {name: node.place}
            elif node.mirror is not None and node.mirror in points:
                found[name] = {name: mirrored(points[node.mirror], -1.0)}
            elif node.mirror is None and (name in points or pair):
                found[name] = {f"{name}{end}": points[f"{name}{end}"] for end in (pair or ("",))}
            else:
                wanted, known = node.mirror or name, [*points, *(key.removesuffix("_fr") for key in points)]
                raise ConfigurationError(
                    f"nodes.{name}: the vehicle has no hardpoint {wanted}; the nearest is {nearest(wanted, known)}. "
                    "Give the node a place, or the name of a hardpoint"
                )
        names = [name for nodes in found.values() for name in nodes]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ConfigurationError(f"nodes: {', '.join(twice)} made by two entries; rename one of them")
        return found

    def member_ends(self, group: str, placed: Mapping[str, Mapping[str, Point]]) -> list[tuple[str, str]]:
        """End nodes of every member of a group.

        Args:
            group: name of the group.
            placed: as `placed` returns it.

        Raises:
            ConfigurationError: a member without such a node, or from a node to itself.
        """
        sides = {node: (node, node) for nodes in placed.values() for node in nodes}
        sides |= {name: (next(iter(nodes)), tuple(nodes)[-1]) for name, nodes in placed.items()}
        ends: list[tuple[str, str]] = []
        for member in self.members[group].between:
            names = member.replace("=", "-").split("-")
            for name in names:
                if name not in sides:
                    raise ConfigurationError(
                        f"members.{group}.between: {member!r} ends at no node {name!r}; the nearest is "
                        f"{nearest(name, sides)}"
                    )
            if len(names) == 1:
                pairs = [sides[names[0]]]
            elif len(names) == 2:
                first, second = sides[names[0]], sides[names[1]]
                pairs = list(zip(first, second[::-1] if "=" in member else second, strict=True))
            if len(names) > 2 or any(a == b for a, b in pairs):
                raise ConfigurationError(
                    f"members.{group}.between: {member!r} is no member; allowed are 'a-b', 'a=b' crossed and 'a' "
                    "across the car, between two different nodes"
                )
            ends += [pair for pair in dict.fromkeys(pairs) if pair not in ends]
        return ends


def read_design(path: Path) -> BodyDesign:
    """Read a body design.

    Args:
        path: TOML file.

    Returns:
        The design.

    Raises:
        ConfigurationError: the file, a name or a value is wrong; the message names it.
    """
    try:
        return build(BodyDesign, read_table(path))
    except ConfigurationError as error:
        text = str(error)
        raise ConfigurationError(text if text.startswith(str(path)) else f"{path}: {text}") from None
