"""Cross-sections of the member groups of the trimmed body: assumed nominal sections and factors fitted to frequencies.

A nominal section is a thin-walled square steel box about as large as the part it stands for, made smaller where
spot-welded joints of bodies are soft, or the axial stiffness of a strut that stands for a sheet-metal or glass panel in
shear. The factor multiplies bending and torsion of a beam (its axial stiffness stays nominal) or the axial stiffness of
a strut.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.flexbody.beam import BeamSection

_E = 2.1e11  # Young's modulus of steel [N/m2]
_G = 8.1e10  # shear modulus of steel [N/m2]


@dataclass(frozen=True, kw_only=True, slots=True)
class GroupSection:
    """One member group: the part of its stiffness that a factor scales, the part that stays, and the factor."""

    scaled: BeamSection
    """multiplied by the factor"""
    fixed: BeamSection
    """independent of the factor"""
    factor: float
    """fitted, or 1 where the frequencies say too little about the group [1]"""
    fitted: bool
    """whether the factor was fitted"""


def _section(axial: float = 0.0, torsion: float = 0.0, bending_y: float = 0.0, bending_z: float = 0.0) -> BeamSection:
    return BeamSection(axial=axial, torsion=torsion, bending_y=bending_y, bending_z=bending_z)


def _box(width: float, wall: float, factor: float | None = None) -> GroupSection:
    # thin-walled square tube: A = 4 w t, I = 2/3 w^3 t, J = w^3 t
    inertia = 2.0 / 3.0 * width**3 * wall
    return GroupSection(
        scaled=_section(torsion=_G * width**3 * wall, bending_y=_E * inertia, bending_z=_E * inertia),
        fixed=_section(axial=_E * 4.0 * width * wall),
        factor=1.0 if factor is None else factor,
        fitted=factor is not None,
    )


def _panel(area: float, factor: float | None = None) -> GroupSection:
    return GroupSection(
        scaled=_section(axial=_E * area),
        fixed=_section(),
        factor=1.0 if factor is None else factor,
        fitted=factor is not None,
    )


# nominal width and wall [m] or strut area [m2]: assumed; third number: fitted to the frequencies of fit.py
SECTIONS: dict[str, GroupSection] = {
    "front rails": _box(0.080, 0.0018, 0.4453),
    "rail bumper": _box(0.060, 0.0015),
    "strut towers": _box(0.120, 0.0015, 0.87959),
    "subframe": _box(0.060, 0.0020, 0.37211),
    "engine mounts": _box(0.060, 0.0020),
    "sills": _box(0.070, 0.0012, 1.29),
    "hinge pillars": _box(0.150, 0.0015, 0.34091),
    "a pillars": _box(0.035, 0.0015, 0.15626),
    "centre pillars": _box(0.130, 0.0018, 5.0055),
    "rear pillars": _box(0.060, 0.0010, 0.77305),
    "roof rails": _box(0.050, 0.0010, 0.37472),
    "roof bows": _box(0.050, 0.0010, 11.641),
    "cowl": _box(0.120, 0.0012, 0.23711),
    "floor": _box(0.040, 0.0010, 0.31022),
    "floor cross members": _box(0.060, 0.0010, 0.47287),
    "rear rails": _box(0.050, 0.0010, 0.44486),
    "wheelhouses": _box(0.100, 0.0010, 0.91767),
    "rear seat back": _box(0.050, 0.0010, 0.83911),
    "rear frame": _box(0.080, 0.0012, 0.16309),
    "tailgate": _box(0.070, 0.0010),
    "seat frame": _box(0.060, 0.0020),  # stiff: a lone seat would tilt the modes to one side
    "roof skin": _panel(5.0e-5, 1.6796),
    "windscreen": _panel(1.0e-4, 1.3491),
    "firewall": _panel(3.0e-5, 0.39189),
    "floor skin": _panel(3.0e-6, 1.1158),
    "quarter panels": _panel(5.0e-6, 0.25339),
    "tailgate skin": _panel(2.0e-5),
}
