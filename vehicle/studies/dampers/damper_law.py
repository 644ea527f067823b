"""Laws of a damper for a fit: the parts of a law, its parameters, and the order in which parts are added.

In extension positive, with the displacement x, the deflection s of a series stiffness K and the velocity w = x' - s' of
the damper itself,

    F = K s = F_c(w) + friction + k_g (x - s) + F_0,

With a gap g in series and a Coulomb friction F_o parallel to all,

    F = K e(s) + F_o sgn x',   e = s - g/2 for s > g/2, s + g/2 for s < -g/2, otherwise zero.

F_c has straight segments: slope c_j up to the velocity v_j, alike or separate on both sides. The friction is Coulomb
friction, a step of F_c within `STEP`; Stribeck friction; or presliding, Jenkins elements over x - s. F_0 is minus the
gas force, k_g the stiffness of the gas. All but F_o are laws of the vehicle file
(`vehicle.studies.dampers.damper_text`); K and the gap belong to the mount of the rod.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector

MAX_BENDS, MAX_ELEMENTS = 3, 4
"""Maximum numbers of breakpoints on each side of a curve, and of Jenkins elements."""

SMOOTHING = 1e4
"""Smoothing eps [s/m] of Coulomb and Stribeck friction in the lines: full friction from 0.16 mm/s."""

SOFT_STEP = np.pi / (2.0 * SMOOTHING)
"""Velocity [m/s] at which friction reaches its limit in a fit without a series stiffness, as in the lines."""

STEP = 1e-6
"""The same with a series stiffness. With 0.16 mm/s the damper would creep by a tenth of the deflection of a machine of
2e7 N/m while dry friction turns, and that stiffness would be fitted 15 % too low."""

EXPONENT = 2.0
"""Exponent delta of Stribeck friction; tests hardly distinguish it from the velocity vs."""

LINEAR = {"gas_force": 100.0, "gas_stiffness": 1e3, "delay": 1e-3}
"""Parameters that may be zero or negative, fitted without logarithm, and their usual sizes."""

FIRM = "firm_"
"""Prefix of the parameters of the firm law of a damper whose setting changes during the tests."""

SETTING = ("lag", "saturation", "delay")
"""Parameters of a setting that changes during the tests."""

SIDES = ("rebound", "bump")
"""Sides of a curve: extension, then compression."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DamperLaw:
    """Parts of a law."""

    bends: int = 0  # breakpoints of the curve on each side
    own_sides: bool = False  # bump and rebound have different slopes and breakpoints
    friction: str = ""  # "", "coulomb", "stribeck" or "presliding"
    elements: int = 0  # Jenkins elements of presliding
    series: bool = False  # a stiffness in series with the damper
    gap: bool = False  # a gap (backlash) in series with both, and Coulomb friction parallel to all
    gas_stiffness: bool = False  # a stiffness parallel to the damper
    # condition that changes during the tests: "", "lag" (soft and firm law, lag) or "saturating", see `damper_setting`
    setting: str = ""
    delayed: bool = False  # the setting has a delay besides its lag

    @property
    def passive(self) -> DamperLaw:
        """The law at a constant setting."""
        return dataclasses.replace(self, setting="", delayed=False)

    @property
    def halves(self) -> tuple[list[int], list[int]]:
        """Places of the parameters of the soft and of the firm law; they share gas force and gas stiffness."""
        names = list(self.parameters)
        soft = [names.index(name) for name in self.passive.parameters]
        firm = [names.index(FIRM + name if FIRM + name in names else name) for name in self.passive.parameters]
        return soft, firm

    @property
    def sides(self) -> tuple[str, ...]:
        """Prefixes of the parameters of the curve."""
        return tuple(f"{side}_" for side in SIDES) if self.own_sides else ("",)

    @property
    def parameters(self) -> dict[str, str]:
        """Names of the parameters and their units, in the order of all arrays."""
        if self.setting:
            soft = self.passive.parameters
            firm = {FIRM + name: unit for name, unit in soft.items() if name not in LINEAR}
            names = soft | firm | {"lag": "s"}
            names |= {"saturation": "-"} if self.setting == "saturating" else {}
            return names | ({"delay": "s"} if self.delayed else {})
        names = {"gas_force": "N"}
        for side in self.sides:
            names |= {f"{side}damping_{j + 1}": "N s/m" for j in range(self.bends + 1)}
            names |= {f"{side}velocity_{j + 1}": "m/s" for j in range(self.bends)}
        if self.friction in ("coulomb", "stribeck"):
            names["friction"] = "N"
        if self.friction == "stribeck":
            names |= {"friction_at_rest": "N", "stribeck_velocity": "m/s"}
        for i in range(self.elements):
            names |= {f"slider_limit_{i + 1}": "N", f"slider_stroke_{i + 1}": "m"}
        names |= {"gas_stiffness": "N/m"} if self.gas_stiffness else {}
        names |= {"series_stiffness": "N/m"} if self.series else {}
        return names | ({"gap": "m", "outer_friction": "N"} if self.gap else {})

    @property
    def title(self) -> str:
        """Parts of the law in words."""
        curve = "linear damping" if not self.bends else f"damping curve with {self.bends} bend{'s'[: self.bends > 1]}"
        parts = [curve + (", separate for bump and rebound" if self.own_sides else "")]
        elements = f"presliding friction ({self.elements} element{'s'[: self.elements > 1]})"
        parts += [elements] if self.elements else [f"{self.friction.title()} friction"] if self.friction else []
        parts += ["gas stiffness"] if self.gas_stiffness else []
        parts += ["series stiffness"] if self.series else []
        parts += ["gap"] if self.gap else []
        parts += [f"{self.setting} setting".replace("lag", "lagging")] if self.setting else []
        return " + ".join(parts + (["delay"] if self.delayed else []))

    def larger(self) -> Iterator[DamperLaw]:
        """Yield the laws with one more part.

        A slider is close to dry friction in series with a stiffness: those laws are tried too.
        """
        change = dataclasses.replace
        if self.bends < MAX_BENDS:
            yield change(self, bends=self.bends + 1)
        if not self.own_sides:
            yield change(self, own_sides=True)
        if not self.series:
            yield change(self, series=True)
        elif not self.gap:
            yield change(self, gap=True)
        if not self.gas_stiffness:
            yield change(self, gas_stiffness=True)
        if not self.friction:
            yield change(self, friction="coulomb")
        if self.friction == "coulomb":
            yield change(self, friction="stribeck")
        if self.elements == 1 and not self.series:
            yield change(self, friction="coulomb", elements=0, series=True)
            yield change(self, friction="stribeck", elements=0, series=True)
            yield change(self, friction="coulomb", elements=0, series=True, gap=True)
        if self.friction != "stribeck" and self.elements < MAX_ELEMENTS:
            yield change(self, friction="presliding", elements=self.elements + 1)
        if self.setting == "lag":
            yield change(self, setting="saturating")
        if self.setting and not self.delayed:
            yield change(self, delayed=True)

    def smaller(self) -> Iterator[DamperLaw]:
        """Yield the laws with one part less."""
        change = dataclasses.replace
        if self.bends:
            yield change(self, bends=self.bends - 1)
        if self.own_sides:
            yield change(self, own_sides=False)
        if self.gap:
            yield change(self, gap=False)
        elif self.series:
            yield change(self, series=False)
        if self.gas_stiffness:
            yield change(self, gas_stiffness=False)
        if self.friction == "stribeck":
            yield change(self, friction="coulomb")
        if self.friction == "coulomb" or self.elements == 1:
            yield change(self, friction="", elements=0)
        if self.elements == 1:
            yield change(self, friction="coulomb", elements=0)
        if self.elements > 1:
            yield change(self, elements=self.elements - 1)
        if self.setting == "saturating":
            yield change(self, setting="lag")
        if self.delayed:
            yield change(self, delayed=False)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DamperValues:
    """Parameters of a law as numbers of its parts."""

    slopes: Vector  # c_j of rebound and bump, from rest outwards [N s/m]; (2, k + 1)
    widths: Vector  # widths of the inner segments [m/s]; (2, k)
    stiffness: Vector  # stiffness, limit: Jenkins elements [N/m], [N]; (m,)
    limit: Vector
    friction: tuple[float, float, float]  # Coulomb or Stribeck friction, its limit at rest [N], and vs [m/s]
    offset: float  # F_0 [N]
    gas_stiffness: float  # k_g [N/m]
    series: float  # K [N/m]; infinite without
    gap: float = 0.0  # g [m]
    outer_friction: float = 0.0  # F_o [N]


def values_of(law: DamperLaw, parameters: Vector) -> DamperValues:
    """Return the numbers of a law for parameters in the order of `law.parameters`, widths and excess."""
    number = dict(zip(law.parameters, parameters.tolist(), strict=True))
    sides = law.sides * (2 if len(law.sides) == 1 else 1)
    slopes = [[number[f"{side}damping_{j + 1}"] for j in range(law.bends + 1)] for side in sides]
    widths = [[number[f"{side}velocity_{j + 1}"] for j in range(law.bends)] for side in sides]
    limit = np.array([number[f"slider_limit_{i + 1}"] for i in range(law.elements)])
    stroke = np.array([number[f"slider_stroke_{i + 1}"] for i in range(law.elements)])
    sliding = number.get("friction", 0.0)
    return DamperValues(
        slopes=np.array(slopes),
        widths=np.array(widths).reshape(2, law.bends),
        stiffness=limit / stroke,
        limit=limit,
        friction=(sliding, sliding + number.get("friction_at_rest", 0.0), number.get("stribeck_velocity", 1.0)),
        offset=-number["gas_force"],
        gas_stiffness=number.get("gas_stiffness", 0.0),
        series=number.get("series_stiffness", np.inf),
        gap=number.get("gap", 0.0),
        outer_friction=number.get("outer_friction", 0.0),
    )


def plain_parameters(law: DamperLaw, parameters: Vector) -> Vector:
    """Return velocities of breakpoints and friction at rest from widths of segments and excess over sliding; (p,)."""
    return np.asarray(sums_of(law) @ parameters)


def sums_of(law: DamperLaw) -> Vector:
    """Return the matrix from fitted to plain parameters, (p, p).

    Widths and excess are positive: bends are in order, and friction at rest is not below sliding friction.
    """
    names = list(law.parameters)
    sums = np.eye(len(names))
    if law.setting:
        for half in law.halves:
            sums[np.ix_(half, half)] = sums_of(law.passive)
        return sums
    for side in law.sides:
        at = [names.index(f"{side}velocity_{j + 1}") for j in range(law.bends)]
        sums[np.ix_(at, at)] = np.tril(np.ones((len(at), len(at))))
    if law.friction == "stribeck":
        sums[names.index("friction_at_rest"), names.index("friction")] = 1.0
    return sums
