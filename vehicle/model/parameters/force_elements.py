"""Force elements: bushings with rubber friction, hydromount, main spring, stabilizer, damper."""

import itertools
from dataclasses import dataclass, fields
from typing import Any

from vehicle.core.header import listed
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.curves import require_curve
from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.quantity import Validated, quantity, validate
from vehicle.model.parameters.semi_active_damper import PASSIVE, SemiActiveDamper
from vehicle.model.parameters.tested_range import TestedRange
from vehicle.names import AXES

STIFFEST: dict[str, Any] = {"at_most": 1e10, "why": "a 5 cm steel block has 1e10 N/m"}
STRONGEST: dict[str, Any] = {"at_most": 1e6, "why": "a truck's damper has 1e5 N s/m"}
MOVING: dict[str, Any] = {"at_least": 1e-6, "at_most": 10.0, "why": "dampers on a shaker move by 1e-6 to a few m/s"}
RUBBED: dict[str, Any] = {"at_most": 1e6, "why": "seals have 50 to 500 N; 1e5 N locks any damper"}
TWISTED: dict[str, Any] = {"at_most": 1e6, "why": "a stabilizer bar has 1e4 N m/rad"}

FRICTION_LAWS = tuple(name for (name,) in listed("laws.h", "EACH_FRICTION_LAW", "F"))
"""Names of the friction laws of the core; each is a module of `vehicle.model.laws` too."""

LIFTS = "would lift off its plate"
"""Words of a warning about a linear tyre whose load is negative."""

PULLS = (
    "the linear tyre then pulls the wheel down, so the result is invalid; let it lift off with "
    "--set AXLE.bushings.tyre.one_sided=true, AXLE for example front"
)
"""Effect and remedy in such a warning."""

MAX_SLIDERS = 8
"""Maximum number of segments of a presliding curve: each is a friction row of the solver."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LinearBushing:
    """Bushing without rubber friction: f = -K r - D r' in the axes of the body that carries it, torque = -K_rot angle.

    A table of an axis replaces its K: force over the displacement of the moving part, without load at F = 0.
    """

    stiffness: Point = quantity("N/m", "Kx, Ky, Kz", at_least=0.0, length=3, **STIFFEST)
    damping: Point = quantity("N s/m", "Dx, Dy, Dz", at_least=0.0, length=3, **STRONGEST)
    rotational_stiffness: float = quantity("N m/rad", "stiffness about each axis", at_least=0.0, **TWISTED)
    table_x: ForceTable | None = None
    table_y: ForceTable | None = None
    table_z: ForceTable | None = None
    one_sided: bool = False
    """for a contact with the ground: the vertical force is max(0, load - K r - D r'), so that it never pulls"""

    def __post_init__(self) -> None:
        validate(self)
        if self.one_sided and self.table_z is not None:
            raise ConfigurationError(
                f"{type(self).__name__}.one_sided: found true together with table_z; a one-sided contact "
                "needs a stiffness; remove one of them"
            )


NO_FRICTION: Point = (0.0, 0.0, 0.0)
SHORTEST_STROKE = 1e-6
"""Minimum friction stroke [m] of an axis with friction: a hundredth of the stroke of thin rubber."""


def _friction_force() -> Any:
    return quantity(
        "N", "Fmax on each axis: friction force of rubber at large displacements; 0: none", at_least=0.0,
        at_most=1e6, length=3, why="a suspension bushing has 10 to 1000 N", default=NO_FRICTION,
    )  # fmt: skip


def _friction_stroke() -> Any:
    return quantity(
        "m", "x2 on each axis: displacement from rest where rubber friction is Fmax / 2", at_least=0.0, at_most=0.1,
        length=3, why="rubber mounts of cars have 1e-4 to 2e-3 m", default=NO_FRICTION,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True, slots=True)
class Bushing(LinearBushing):
    """Bushing with rubber friction, which is parallel to its elastic and viscous part on each axis.

    On first loading the friction is Fmax r / (x2 + r), with the displacement r of the moving part relative to the
    carrier, in the axes of the law; see `vehicle.model.laws.amplitude`. Its tangent at rest Fmax / x2 adds to the
    stiffness of small vibrations; large ones have the stiffness without it. With Fmax = 0 an axis has no friction.
    """

    friction_force: Point = _friction_force()
    friction_stroke: Point = _friction_stroke()
    tested: TestedRange | None = None

    def __post_init__(self) -> None:
        LinearBushing.__post_init__(self)
        _require_stroke(self)
        for axis, force in zip(AXES, self.friction_force, strict=True):
            if force > 0.0 and (self.one_sided or getattr(self, f"table_{axis}") is not None):
                other = "one_sided" if self.one_sided else f"table_{axis}"
                raise ConfigurationError(
                    f"{type(self).__name__}.friction_force.{axis}: found {force!r} N together with {other}; rubber "
                    "friction needs a two-sided element with a stiffness; remove one of them"
                )


SLIPPING: dict[str, Any] = {"at_least": 1e3, "at_most": 1e7, "why": "a car tyre has 2e4 to 2e5 per unit of slip"}
CARCASS: dict[str, Any] = {"at_least": 1e4, "at_most": 1e7, "why": "a car tyre has 5e4 to 8e5 N/m"}


@dataclass(frozen=True, kw_only=True, slots=True)
class Tyre(LinearBushing):
    """Tyre between hub and plate: a bushing at rest; if it rolls, its horizontal force comes from slip.

    K and D along x and y and the rotational stiffness describe the tyre at rest and do not act on a rolling tyre.
    """

    round: bool = True
    """contact of the tyre at rest: true for a round tread, whose vertical force acts below the wheel centre; false
    for a bushing fixed to the wheel at the patch (Bommer 2006), whose vertical force F takes F R off the pitch
    stiffness"""

    slip_stiffness: float | None = quantity(
        "N", "C_kappa, force per longitudinal slip of the rolling tyre at its static load", default=None, **SLIPPING
    )
    cornering_stiffness: float | None = quantity(
        "N/rad", "C_alpha, side force per slip angle of the rolling tyre at its static load", default=None, **SLIPPING
    )
    carcass_longitudinal: float | None = quantity(
        "N/m", "stiffness of the carcass along x; relaxation length = C_kappa / this value", default=None, **CARCASS
    )
    carcass_lateral: float | None = quantity(
        "N/m", "stiffness of the carcass along y; relaxation length = C_alpha / this value", default=None, **CARCASS
    )
    trail: float = quantity(
        "m", "pneumatic trail, by which the side force acts behind the middle of the contact patch", at_least=0.0,
        at_most=0.1, why="a third of half the contact length by the brush model, 0.02 to 0.04 m", default=0.0,
    )  # fmt: skip
    rolling_radius: float | None = quantity(
        "m", "effective rolling radius, for forces that turn with the wheel; default: height of the wheel "
            "centre, 3 to 5 % less", above=0.1, at_most=1.0, default=None,
    )  # fmt: skip


TRACKED: dict[str, Any] = {"at_least": 0.01, "at_most": 1e4, "why": "mount tracks have 1 to 300 kg at the rubber"}


@dataclass(frozen=True, kw_only=True, slots=True)
class Hydromount:
    """Bushing whose z axis is an elastomer, a fluid with an inertia track, or both in parallel.

    K(s) = Kz1 + Dz1 s + Kz2 Dz2 s / (Dz2 s + Kz2) + Kb Z / (Kb + Z) with Z = mt s^2 + ct s. A decoupler
    gives way to the pressure in parallel with the track, with md, cd and its membrane Km, beyond the gap its seat too.
    For rubber friction see `Bushing`.
    """

    stiffness: Point = quantity("N/m", "Kx, Ky, Kz1", at_least=0.0, length=3, **STIFFEST)
    damping: Point = quantity("N s/m", "Dx, Dy, Dz1", at_least=0.0, length=3, **STRONGEST)
    rotational_stiffness: float = quantity("N m/rad", "stiffness about each axis", at_least=0.0, **TWISTED)
    maxwell_stiffness: float | None = quantity(
        "N/m", "Kz2, spring of the Maxwell branch; 0: no branch", at_least=0.0, default=None, **STIFFEST
    )
    maxwell_damping: float | None = quantity(
        "N s/m", "Dz2, damper of the Maxwell branch; 0: no branch", at_least=0.0, default=None, **STRONGEST
    )
    chamber_stiffness: float | None = quantity(
        "N/m", "Kb, bulge stiffness of the upper chamber against the displaced fluid", above=0.0, default=None,
        **STIFFEST,
    )  # fmt: skip
    track_mass: float | None = quantity(
        "kg", "mt, fluid mass in the inertia track, referred to the rubber: rho L Ap^2/At", default=None, **TRACKED
    )
    track_damping: float | None = quantity(
        "N s/m",
        "ct, linear flow resistance of the inertia track, referred to the rubber",
        at_least=0.0,
        default=None,
        **STRONGEST,
    )
    friction_force: Point = _friction_force()
    friction_stroke: Point = _friction_stroke()

    decoupler_gap: float | None = quantity(
        "m", "free displacement of the decoupler to each side, referred to the rubber", at_least=2e-5, at_most=0.02,
        why="decouplers of engine mounts move by 0.1 to 1 mm", default=None,
    )  # fmt: skip
    decoupler_mass: float | None = quantity(
        "kg", "md, mass of the decoupler and its fluid, referred to the rubber", default=None, **TRACKED
    )
    decoupler_damping: float | None = quantity(
        "N s/m", "cd, flow resistance of the decoupler, referred to the rubber", at_least=0.0, default=None, **STRONGEST
    )
    decoupler_stiffness: float | None = quantity(
        "N/m", "Km, membrane of the decoupler, which centres it", above=0.0, at_least=1.0, default=None, **STIFFEST
    )
    decoupler_seat: float | None = quantity(
        "N/m", "stiffness of the seat of the decoupler beyond the gap", above=0.0, default=None, **STIFFEST
    )
    tested: TestedRange | None = None

    def __post_init__(self) -> None:
        validate(self)
        _require_stroke(self)
        if self.decoupler_gap is not None and self.chamber_stiffness is None:
            raise ConfigurationError(
                f"Hydromount.chamber_stiffness: missing; decoupler_gap needs an inertia track, {' and '.join(TRACK)}"
            )
        for keys in (MAXWELL, TRACK, DECOUPLER):
            missing = [key for key in keys if getattr(self, key) is None]
            if 0 < len(missing) < len(keys):
                present = next(key for key in keys if key not in missing)
                raise ConfigurationError(f"Hydromount.{missing[0]}: missing; {present} needs {' and '.join(missing)}")
        # In series with an attachment both share its spring; no formula here covers that.
        if self.chamber_stiffness is not None and self.friction_force[2] > 0.0:
            raise ConfigurationError(
                f"Hydromount.friction_force.z: found {self.friction_force[2]:g} N with an inertia track; rubber "
                "friction along the axis of the fluid is not modelled: set friction_force.z to 0, or remove the track"
            )

    @property
    def maxwell(self) -> tuple[float, float] | None:
        """Spring Kz2 [N/m] and dashpot Dz2 [N s/m] of the Maxwell branch; None without a branch."""
        if not self.maxwell_stiffness or not self.maxwell_damping:
            return None
        return self.maxwell_stiffness, self.maxwell_damping


def _require_stroke(law: Bushing | Hydromount) -> None:
    """Check that each axis with rubber friction has a stroke that is long enough."""
    for axis, force, stroke in zip(AXES, law.friction_force, law.friction_stroke, strict=True):
        if force > 0.0 and stroke < SHORTEST_STROKE:
            raise ConfigurationError(
                f"{type(law).__name__}.friction_stroke.{axis}: found {stroke!r} m, must be at least "
                f"{SHORTEST_STROKE:g} m, because friction_force.{axis} is {force!r} N; set the displacement at which "
                f"the friction is half its maximum, or for no friction friction_force.{axis} = 0"
            )


MAXWELL = ("maxwell_stiffness", "maxwell_damping")
TRACK = ("chamber_stiffness", "track_mass", "track_damping")
DECOUPLER = ("decoupler_gap", "decoupler_mass", "decoupler_damping", "decoupler_stiffness", "decoupler_seat")
"""Parameters of Maxwell branch, inertia track and decoupler of a hydromount; each group is complete or absent."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MainSpring(Validated):
    """Spring between the lower spring seat and the strut top, along the line between both.

    A table over the extension from the unloaded length replaces the stiffness."""

    stiffness: float = quantity(
        "N/m", "stiffness", above=0.0, at_least=1e3, at_most=1e6, why="1e4 N/m in a micro car, 2e5 N/m in a van"
    )
    table: ForceTable | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Stabilizer(Validated):
    """Torsion spring between the two halves of the stabilizer bar."""

    torsional_stiffness: float = quantity(
        "N m/rad", "torque per relative angle of its two halves", at_least=0.0, **TWISTED
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class SlideSpring(Validated):
    """Spring and damper along a slide: f = -k q - d q'."""

    stiffness: float = quantity("N/m", "stiffness", at_least=0.0, **STIFFEST)
    damping: float = quantity("N s/m", "damping", at_least=0.0, default=0.0, **STRONGEST)


@dataclass(frozen=True, kw_only=True, slots=True)
class Damper:
    """F = D v + clamp(c v, limit(v)), plus (Ddeg - D) v up to Vdeg and (Ddeg - D) Vdeg above, if degressive.

    With the table law, D v is replaced by straight lines through points of velocity and force, positive in extension
    and extrapolated. The gas force extends the damper; in static equilibrium the preload of the springs balances it.
    The stop is a parallel spring, bump and rebound stop in one: force over the displacement from the design position.
    Friction is a line with c = (2/pi) limit eps, the slope of the published limit (2/pi) atan(eps v) at rest, up to
    the limit (clamp(x, L) = min(L, max(-L, x))): the atan itself is the law of the lumped models.
    The limit is Fd for the Coulomb law and Fd + (Fs - Fd) exp(-|v/vs|^delta) for the Stribeck law.
    With a side force coefficient the limit of every law grows by it times the transverse force of the mounts of the
    rod. Presliding friction has the limit Fd, and below it springs with sliders over the stroke in place of the line:
    on first loading the force rises with K slope[j] up to Fd force[j] on each segment j, and after a reversal by twice
    that curve (`vehicle.model.laws.presliding`); the smoothing has no effect.
    Parameters of a law that is not chosen are optional. A control law other than "passive", or a function F(x, v) of
    the user's own, replaces the viscous law; a function L(Fd, v) of the user's own is the limit in place of Fd.
    """

    viscous: float | None = quantity(
        "N s/m", "D, damping constant", at_least=0.0, laws=("linear", "degressive"), default=None, **STRONGEST
    )
    viscous_law: str = quantity("-", "damping law", choices=("linear", "degressive", "table"))
    degressive_viscous: float | None = quantity("N s/m", "Ddeg, damping constant of the degressive law below Vdeg",
        at_least=0.0, laws=("degressive",), default=None, **STRONGEST)  # fmt: skip
    degressive_velocity: float | None = quantity("m/s", "Vdeg, velocity above which the degressive law is flatter",
        above=0.0, laws=("degressive",), default=None, **MOVING)  # fmt: skip
    velocity: tuple[float, ...] = quantity(
        "m/s",
        "velocities of the force-velocity table; compression (bump) is negative",
        default=(),
        at_least=-10.0,
        at_most=10.0,
    )
    force: tuple[float, ...] = quantity(
        "N", "forces of the force-velocity table; compression is negative", default=(), at_least=-1e6, at_most=1e6
    )
    gas_force: float = quantity("N", "gas force, which pushes the damper apart", default=0.0, at_least=0.0, at_most=1e4)
    function: str | None = quantity("-", "`vehicle.register_law` name that replaces viscous_law", default=None)
    stop: ForceTable | None = None
    control: SemiActiveDamper | None = None
    friction_law: str = quantity("-", "friction law", choices=FRICTION_LAWS)
    friction_function: str | None = quantity("-", "`vehicle.register_friction` name of the limit", default=None)
    coulomb_friction: float = quantity("N", "Fd, Coulomb friction", at_least=0.0, **RUBBED)
    smoothing: float = quantity(
        "s/m", "eps: slope of the friction at rest is (2/pi) Fd eps", above=0.0, at_least=10.0, at_most=1e8,
        why="friction is complete at a few times 1/eps; above 1e9 rounding errors spoil the result",
    )  # fmt: skip
    stribeck_friction: float | None = quantity(
        "N", "Fs, friction at rest of the Stribeck law", at_least=0.0, laws=("stribeck",), default=None, **RUBBED
    )
    stribeck_velocity: float | None = quantity(
        "m/s", "vs, critical velocity of the Stribeck law", above=0.0, laws=("stribeck",), default=None, **MOVING
    )
    stribeck_exponent: float | None = quantity("-", "delta, exponent of the Stribeck law", above=0.0, at_most=20.0,
        why="1 and 2 are usual", laws=("stribeck",), default=None)  # fmt: skip
    side_force_coefficient: float = quantity(
        "-", "increase of the friction limit with the side force Q on the rod: limit + coefficient |Q|", at_least=0.0,
        at_most=2.0, why="0.1 to 0.4 for a sliding bush and its lever; 0 for a damper between two joints", default=0.0,
    )  # fmt: skip
    presliding_stiffness: float | None = quantity("N/m", "K, stiffness of the stuck damper after a reversal",
        above=0.0, laws=("presliding",), default=None, **STIFFEST)  # fmt: skip
    presliding_force: tuple[float, ...] = quantity(
        "-", "ends of the segments of the presliding curve, as shares of Fd", above=0.0, at_most=1.0,
        default=(0.25, 0.5, 0.75, 1.0),
    )  # fmt: skip
    presliding_slope: tuple[float, ...] = quantity(
        "-", "slopes of these segments, as shares of K", above=0.0, at_most=1.0, default=(1.0, 0.75, 0.5, 0.25)
    )
    slip_velocity: float = quantity("m/s", "velocity above which the damper counts as slipping", above=0.0, **MOVING)
    tested: TestedRange | None = None

    def __post_init__(self) -> None:
        validate(self)
        for key, law in (("viscous_law", self.viscous_law), ("friction_law", self.friction_law)):
            for name, unit in NUMBERS.get(law, {}).items():
                if getattr(self, name) is None:
                    raise ConfigurationError(f"Damper.{name}: missing; {key} = {law} needs this value [{unit}]")
        self._check_presliding()
        if self.function is not None and self.controlled is not None:
            raise ConfigurationError(
                f"Damper.function: found {self.function!r} with control.law = {self.controlled.law}; remove one of them"
            )
        if self.friction_function is not None and self.friction_law != "coulomb":
            found = f"found {self.friction_function!r} with friction_law = {self.friction_law}"
            raise ConfigurationError(f"Damper.friction_function: {found}; it replaces friction_law = coulomb")
        if self.static_friction < self.coulomb_friction:
            raise ConfigurationError(
                f"Damper.stribeck_friction: found {self.stribeck_friction!r} N, must be at least "
                f"coulomb_friction ({self.coulomb_friction!r} N)"
            )
        if self.viscous_law == "table":
            require_curve("Damper", "velocity", self.velocity, self.force)
        if self.viscous_law == "degressive" and (self.degressive_viscous or 0.0) < (self.viscous or 0.0):
            raise ConfigurationError(
                f"Damper.degressive_viscous: found {self.degressive_viscous!r} N s/m, must be at least "
                f"viscous ({self.viscous!r} N s/m)"
            )

    def _check_presliding(self) -> None:
        """Check that the presliding curve rises to the limit, with falling slopes that begin with K."""
        ends, slopes = self.presliding_force, self.presliding_slope
        if len(ends) != len(slopes) or not 1 <= len(ends) <= MAX_SLIDERS:
            numbers = f"found {len(slopes)} values, but presliding_force has {len(ends)}"
            raise ConfigurationError(f"Damper.presliding_slope: {numbers}; give both the same, 1 to {MAX_SLIDERS}")
        orders = ("force", ends, ends[::-1], "rise to 1"), ("slope", slopes, slopes, "fall from 1")
        for name, values, falling, shape in orders:
            if falling[0] != 1.0 or any(after >= value for value, after in itertools.pairwise(falling)):
                raise ConfigurationError(f"Damper.presliding_{name}: found {list(values)}, must {shape}")

    @property
    def controlled(self) -> SemiActiveDamper | None:
        """Control of a semi-active damper; None for a passive damper."""
        return None if self.control is None or self.control.law == PASSIVE else self.control

    @property
    def static_friction(self) -> float:
        """Friction limit at rest [N]: Fs for the Stribeck law, Fd for a law without it."""
        if "stribeck_friction" not in NUMBERS.get(self.friction_law, {}) or self.stribeck_friction is None:
            return self.coulomb_friction
        return self.stribeck_friction


_OF_LAWS = [(law, entry) for entry in fields(Damper) for law in entry.metadata.get("laws", ())]
NUMBERS = {law: {entry.name: entry.metadata["unit"] for of, entry in _OF_LAWS if of == law} for law, _ in _OF_LAWS}
"""Parameters of a damper that some laws require, with their units, by the name of the law."""
