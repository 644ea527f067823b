"""Cross-sections of the member groups of the trimmed body: assumed nominal sections and factors fitted to frequencies.

A nominal section is a thin-walled square steel box about as large as the part it stands for, made smaller where
spot-welded joints of bodies are soft (most at hinge pillars and A pillars), or the axial stiffness of a strut that
stands for a sheet-metal or glass panel in shear. The factor multiplies bending and torsion of a beam (its axial
stiffness stays nominal) or the axial stiffness of a strut. Where the first fits asked for more than a factor of four,
the nominal section was moved, so the stored factors lie between 0.25 and 2.8.
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
    "front rails": _box(0.055, 0.0018, 1.0962),
    "rail bumper": _box(0.060, 0.0015),
    "strut towers": _box(0.150, 0.0015, 1.4682),
    "subframe": _box(0.045, 0.0020, 0.70706),
    "engine mounts": _box(0.060, 0.0020),
    "sills": _box(0.065, 0.0012, 2.2114),
    "hinge pillars": _box(0.048, 0.0012, 0.29792),
    "a pillars": _box(0.022, 0.0012, 0.2536),
    "centre pillars": _box(0.070, 0.0015, 0.97819),
    "rear pillars": _box(0.060, 0.0010, 0.62509),
    "roof rails": _box(0.042, 0.0010, 1.4542),
    "roof bows": _box(0.060, 0.0010, 0.55761),
    "cowl": _box(0.120, 0.0012, 1.5756),
    "floor": _box(0.055, 0.0010, 2.8274),
    "tunnel": _box(0.130, 0.0010, 2.5669),
    "seat cross members": _box(0.055, 0.0010, 0.2576),
    "floor cross members": _box(0.110, 0.0010, 1.0566),
    "rear rails": _box(0.040, 0.0010, 0.88926),
    "wheelhouses": _box(0.075, 0.0010, 0.78727),
    "rear seat back": _box(0.065, 0.0010, 0.99323),
    "rear frame": _box(0.048, 0.0010, 0.47225),
    "tailgate": _box(0.070, 0.0010, 1.1904),
    "seat frame": _box(0.060, 0.0020),  # stiff: a lone seat would tilt the modes to one side
    "roof skin": _panel(5.0e-5, 0.35863),
    "windscreen": _panel(8.0e-5, 1.8691),
    "firewall": _panel(3.0e-5, 0.54494),
    "floor skin": _panel(1.0e-5, 0.70425),
    "front floor skin": _panel(1.0e-5, 0.62915),
    "wings": _panel(5.0e-6, 1.4903),
    "quarter panels": _panel(3.0e-6, 0.55271),
    "tailgate skin": _panel(1.0e-5, 0.85937),
}
