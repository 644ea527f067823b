"""Design of a body as data: nodes, members and sections of a space frame, independent of a particular car.

Interface and output points are hardpoints, defined in the vehicle file only. A design adds the joints of the shell, the
members between all nodes, and data that beams do not provide: estimated masses and local stiffnesses.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import BeamSection
from vehicle.model.parameters.hardpoints import Point, mirrored
from vehicle.model.parameters.quantity import quantity, validate
from vehicle.model.parameters.toml_file import build, read_table
from vehicle.wording import did_you_mean

FORMAT = "body design 1"
_SIDES = (("_fr", "_fl"), ("_rr", "_rl"), ("_right", "_left"))
"""Name suffixes of the right and left node of a pair: at front and rear wheels, elsewhere."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DesignNode:
    """Node, or right and left pair of nodes; without `place` and `mirror`, the hardpoint with the name of the entry."""

    mass: float = quantity("kg", "estimate of the mass that the node carries", above=0.0)
    freedom: float = quantity("-", "allowed relative change of the estimated mass, relative to other nodes", above=0.0)
    place: Point | None = quantity("m", "joint of the shell, right side; single where y = 0", length=3, default=None)
    mirror: str | None = quantity("-", "single hardpoint of which the node is the mirror image", default=None)
    attachment: Point | None = quantity("N/m", "local stiffness, x, y, z", above=0.0, length=3, default=None)

    def __post_init__(self) -> None:
        validate(self)
        if self.place is not None and self.mirror is not None:
            raise ConfigurationError("DesignNode.mirror: cannot be used together with place; remove one of them")
        if self.place is not None and self.place[1] < 0.0:
            raise ConfigurationError(
                f"DesignNode.place: found y = {self.place[1]} m, must be at least 0; the left side is mirrored"
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class MemberGroup:
    """Members with a common section: thin-walled square tube (`width`, `wall`) or strut for a shear panel (`area`)."""

    between: tuple[str, ...]
    """end nodes of each member: "a-b", "a=b" crosswise between the sides, "a" from right to left across the car"""
    width: float | None = quantity("m", "width of a tube", above=0.0, default=None)
    wall: float | None = quantity("m", "wall thickness of a tube", above=0.0, default=None)
    area: float | None = quantity("m2", "area of a strut", above=0.0, default=None)
    factor: float | None = quantity("-", "fitted factor on the stiffness; 1 where omitted", above=0.0, default=None)

    def __post_init__(self) -> None:
        validate(self)
        dimensions = [name for name in ("width", "wall", "area") if getattr(self, name) is not None]
        if dimensions not in (["width", "wall"], ["area"]):
            raise ConfigurationError(
                f"MemberGroup.between: the section has {', '.join(dimensions) or 'no dimension'}; it needs width and "
                "wall (a tube) or area (a strut)"
            )
        if not self.between:
            raise ConfigurationError("MemberGroup.between: the list is empty; it must contain at least one member")

    def sections(self, youngs: float, shear: float) -> tuple[BeamSection, BeamSection]:
        """Return the section scaled by the factor, and the section independent of the factor.

        Tube of width w and wall t: A = 4 w t, I = 2/3 w^3 t, J = w^3 t; the factor does not scale its axial stiffness.

        Args:
            youngs: Young's modulus [N/m2].
            shear: shear modulus [N/m2].
        """
        zero = BeamSection(axial=0.0, torsion=0.0, bending_y=0.0, bending_z=0.0)
        if self.width is None or self.wall is None:
            area = self.area or 0.0
            return BeamSection(axial=youngs * area, torsion=0.0, bending_y=0.0, bending_z=0.0), zero
        bending = youngs * (2.0 / 3.0 * self.width**3 * self.wall)
        torsion = shear * self.width**3 * self.wall
        return (
            BeamSection(axial=0.0, torsion=torsion, bending_y=bending, bending_z=bending),
            BeamSection(axial=youngs * 4.0 * self.width * self.wall, torsion=0.0, bending_y=0.0, bending_z=0.0),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyDesign:
    """Data of a body apart from the hardpoints and mass properties of the vehicle."""

    format: str = quantity("-", "file format and version", choices=(FORMAT,))
    name: str = quantity("-", "name of the body")
    provenance: str
    """sources of the values, as text"""
    mode_count: float = quantity("-", "number of elastic modes, lowest frequencies first", at_least=1.0, at_most=60.0)
    damping_ratio: float = quantity("-", "share of critical damping of every mode", at_least=0.0, at_most=0.3)
    youngs_modulus: float = quantity("N/m2", "Young's modulus", above=0.0)
    shear_modulus: float = quantity("N/m2", "shear modulus", above=0.0)
    node_rotations: bool = False
    """true: the model includes node rotations, on which elements with a rotational stiffness act"""
    least_ixx: float = quantity(
        "kg m2", "minimum Ixx about the CoG to which the node masses are fitted", at_least=0.0, default=0.0
    )
    nodes: Mapping[str, DesignNode]
    members: Mapping[str, MemberGroup]

    def __post_init__(self) -> None:
        validate(self)
        if self.mode_count != int(self.mode_count):
            raise ConfigurationError(f"BodyDesign.mode_count: must be a whole number, not {self.mode_count!r}")

    @property
    def factors(self) -> dict[str, float]:
        """Stiffness factor of every member group [1]."""
        return {name: 1.0 if group.factor is None else group.factor for name, group in self.members.items()}

    @property
    def fitted_groups(self) -> tuple[str, ...]:
        """Member groups with a fitted factor."""
        return tuple(name for name, group in self.members.items() if group.factor is not None)

    def placed(self, points: Mapping[str, Point]) -> dict[str, dict[str, Point]]:
        """Return the positions [m] of the node, or right and left node, of every entry for a car, by entry and node.

        Args:
            points: hardpoints of the car in the vehicle frame [m], by name.

        Raises:
            ConfigurationError: the car lacks a hardpoint, or two entries define the same node name.
        """
        positions: dict[str, dict[str, Point]] = {}
        for name, node in self.nodes.items():
            pair = next((ends for ends in _SIDES if f"{name}{ends[0]}" in points), None)
            if node.place is not None:
                right, left = (f"{name}{end}" for end in _SIDES[-1])
                sides = {right: node.place, left: mirrored(node.place, -1.0)}
                positions[name] = sides if node.place[1] > 0.0 else {name: node.place}
            elif node.mirror is not None and node.mirror in points:
                positions[name] = {name: mirrored(points[node.mirror], -1.0)}
            elif node.mirror is None and (name in points or pair):
                positions[name] = {f"{name}{end}": points[f"{name}{end}"] for end in (pair or ("",))}
            else:
                hardpoint = node.mirror or name
                similar = did_you_mean(hardpoint, [*points, *(key.removesuffix("_fr") for key in points)])
                raise ConfigurationError(
                    f"nodes.{name}: the vehicle has no hardpoint {hardpoint}{similar} "
                    "Give the place of the node, or name it after a hardpoint"
                )
        names = [name for nodes in positions.values() for name in nodes]
        duplicates = sorted({name for name in names if names.count(name) > 1})
        if duplicates:
            raise ConfigurationError(f"nodes: {', '.join(duplicates)} defined twice; rename one entry")
        return positions

    def member_ends(self, group: str, placed: Mapping[str, Mapping[str, Point]]) -> list[tuple[str, str]]:
        """Return the end nodes of every member of a group.

        Raises:
            ConfigurationError: a member names an unknown node or connects a node with itself.
        """
        sides = {node: (node, node) for nodes in placed.values() for node in nodes}
        sides |= {name: (next(iter(nodes)), tuple(nodes)[-1]) for name, nodes in placed.items()}
        ends: list[tuple[str, str]] = []
        for member in self.members[group].between:
            names = member.replace("=", "-").split("-")
            for name in names:
                if name not in sides:
                    raise ConfigurationError(
                        f"members.{group}.between: {member!r} has no node {name!r}{did_you_mean(name, sides)}"
                    )
            if len(names) == 1:
                pairs = [sides[names[0]]]
            elif len(names) == 2:
                first, second = sides[names[0]], sides[names[1]]
                pairs = list(zip(first, second[::-1] if "=" in member else second, strict=True))
            if len(names) > 2 or any(a == b for a, b in pairs):
                raise ConfigurationError(
                    f"members.{group}.between: found {member!r}, must be 'a-b', 'a=b' crosswise, or 'a' across the "
                    "car, between two different nodes"
                )
            ends += [pair for pair in dict.fromkeys(pairs) if pair not in ends]
        return ends


def read_design(path: Path) -> BodyDesign:
    """Read a body design from a TOML file.

    Raises:
        ConfigurationError: the file, a name or a value is wrong; the message names the file.
    """
    try:
        return build(BodyDesign, read_table(path))
    except ConfigurationError as error:
        text = str(error)
        raise ConfigurationError(text if text.startswith(str(path)) else f"{path}: {text}") from None
