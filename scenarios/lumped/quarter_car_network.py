"""Quarter-car models of Bommer 2006, composed from one set of parts."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Literal

import numpy as np

from scenarios.lumped.degressive import Degressive
from scenarios.lumped.network import ROAD, Link, Mass, Network
from scenarios.lumped.quarter_car_parameters import QuarterCar
from vehicle.engines.linear.system import Row, Slide
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import FRICTION
from vehicle.model.laws.elastomer import Kelvin, Maxwell, in_series
from vehicle.model.laws.law import ForceLaw, Numbers
from vehicle.model.parameters.paths import full_path, quantity_of
from vehicle.model.parameters.quantity import check
from vehicle.model.parameters.toml_file import as_table

PUBLISHED = {"friction_limit": "limit", "smoothing": "steepness"}
"""Names of friction-law parameters in the source."""


def quarter_car(
    car: QuarterCar,
    *,
    damper: Literal["slip", "stick", "friction"],
    friction: str = "coulomb",
    engine: Literal["none", "linear", "elastomer"] = "none",
    degressive: bool = False,
    strut: bool = False,
    small_mass: bool = False,
    vary: Mapping[str, Numbers] | None = None,
) -> Network:
    """Return a quarter car composed of the selected parts.

    Coordinates: `body`, `wheel` (vertical), `mount` (extension of the suspension mount along the strut, only with
    friction), `engine`, `longitudinal` (wheel, only with the strut at an angle), `small_mass`. Outputs: `body`,
    `wheel`, `damper` (vertical motion of the damper mass), `engine`, `small_mass`.

    | composition | equation |
    |---|---|
    | damper="slip": massless damper D in series with the mount Kd | 2.1 |
    | damper="stick": damper rigid, Kd parallel to Km | 2.2 |
    | damper="friction": damper mass Md, viscous damper and smooth Coulomb friction in parallel | 2.6 |
    | engine="linear" | 2.7 |
    | engine="elastomer" | 2.13 |
    | degressive=True | C.2 |
    | strut=True: spring, damper, friction and mount at an angle, wheel free to move longitudinally | D.28 to D.34 |

    The equations at an angle follow from Lagrange's equations with T = Mb yb'^2/2 + Me ye'^2/2 + Mt (xt'^2 + yt'^2)/2 +
    Md ((yb' + u' cos a)^2 + (u' sin a)^2)/2, the spring extension l = (yb - yt) cos a - xt sin a and the sliding
    velocity u' + l', where a is the angle from the vertical (the thesis counts beta = 90 deg - a) and ye is absolute.

    Args:
        car: the parameters.
        damper: how the shock absorber is modelled.
        friction: name of the friction law in `vehicle.model.laws.damper.FRICTION`, with damper="friction".
        engine: engine mass on a linear mount or on the elastomer.
        degressive: degressive damper in place of the viscous one; needs damper="friction".
        strut: put the suspension at the angle of the strut.
        small_mass: add a small mass on the body (appendix B).
        vary: dotted parameter path -> value or array that replaces the value of the car; arrays make a stack of models.

    Returns:
        The network of masses and elements.

    Raises:
        ConfigurationError: an unknown path or an invalid value in `vary`, or parts that exclude each other.

    Source: Bommer 2006, equations 2.1, 2.2, 2.6, 2.7, 2.13, C.2, D.28 to D.34 (signs derived again).
    """
    if damper not in ("slip", "stick", "friction"):
        raise ConfigurationError(f"damper: found {damper!r}, must be slip, stick or friction")
    # The force of a sliding pair depends on its velocity alone, presliding friction on the path.
    laws = [name for name in FRICTION if name != "presliding"]
    if friction not in laws:
        raise ConfigurationError(f"friction: found {friction!r}, must be one of {', '.join(laws)}")
    if engine not in ("none", "linear", "elastomer"):
        raise ConfigurationError(f"engine: found {engine!r}, must be none, linear or elastomer")
    if degressive and damper != "friction":
        raise ConfigurationError(f"degressive: found damper={damper!r}, must be damper='friction'")
    value = Variation(car, vary or {})
    coordinates = ["body", "wheel"]
    outputs: dict[str, Row] = {"body": {"body": 1.0}, "wheel": {"wheel": 1.0}}
    wheel_axes: tuple[Row, ...] = ({"wheel": 1.0},)
    axis: dict[str, Numbers] = {"body": 1.0, "wheel": -1.0}
    vertical: Numbers = 1.0
    links = [Link(row={"wheel": 1.0, ROAD: -1.0}, law=Kelvin(stiffness=value("wheel.tyre_stiffness"), damping=0.0))]
    mount_axes: tuple[Row, ...] = ({"body": 1.0, "mount": 1.0},)
    if strut:
        angle = np.radians(value("strut.angle"))
        vertical, horizontal = np.cos(angle), np.sin(angle)
        coordinates.append("longitudinal")
        outputs["longitudinal"] = {"longitudinal": 1.0}
        wheel_axes = ({"wheel": 1.0}, {"longitudinal": 1.0})
        axis = {"body": vertical, "wheel": -vertical, "longitudinal": -horizontal}
        mount_axes = ({"body": 1.0, "mount": vertical}, {"mount": horizontal})
        bedding = Kelvin(stiffness=value("strut.longitudinal_stiffness"), damping=value("strut.longitudinal_damping"))
        links.append(Link(row={"longitudinal": 1.0}, law=bedding))
    links.append(Link(row=axis, law=Kelvin(stiffness=value("spring.stiffness"), damping=0.0)))
    masses = [Mass(mass=value("body.mass"), axes=({"body": 1.0},)), Mass(mass=value("wheel.mass"), axes=wheel_axes)]
    slides: tuple[Slide, ...] = ()
    mount = value("mount.stiffness")
    if damper == "stick":
        links.append(Link(row=axis, law=Kelvin(stiffness=mount, damping=0.0)))
    elif damper == "slip":
        links.append(Link(row=axis, law=in_series(mount, Kelvin(stiffness=0.0, damping=value("damper.damping")))))
    else:
        coordinates.append("mount")
        outputs["damper"] = {"body": 1.0, "mount": vertical}
        masses.append(Mass(mass=value("damper.mass"), axes=mount_axes))
        links.append(Link(row={"mount": 1.0}, law=Kelvin(stiffness=mount, damping=0.0)))
        sliding = {**axis, "mount": 1.0}
        if not degressive:
            links.append(Link(row=sliding, law=Kelvin(stiffness=0.0, damping=value("damper.damping"))))
        names = [(entry.name, PUBLISHED.get(entry.name, entry.name)) for entry in fields(FRICTION[friction])]
        law = FRICTION[friction](**{name: value(f"friction.{path_name}") for name, path_name in names})
        degressive_law = Degressive(
            low_damping=value("degressive.low_damping"),
            high_damping=value("damper.damping"),
            knee_velocity=value("degressive.knee_velocity"),
        )
        slides = (Slide(row=sliding, friction=law, viscous=degressive_law if degressive else None),)
    if engine != "none":
        coordinates.append("engine")
        outputs["engine"] = {"engine": 1.0}
        masses.append(Mass(mass=value("engine.mass"), axes=({"engine": 1.0},)))
        linear = Kelvin(stiffness=value("engine_mount.stiffness"), damping=value("engine_mount.damping"))
        mounted = linear if engine == "linear" else elastomer(car, vary)
        links.append(Link(row={"engine": 1.0, "body": -1.0}, law=mounted))
    if small_mass:
        coordinates.append("small_mass")
        outputs["small_mass"] = {"small_mass": 1.0}
        small = value("small_mass.mass")
        stiffness = small * (2.0 * np.pi * np.asarray(value("small_mass.frequency"))) ** 2
        masses.append(Mass(mass=small, axes=({"small_mass": 1.0},)))
        links.append(Link(row={"small_mass": 1.0, "body": -1.0}, law=Kelvin(stiffness=stiffness, damping=0.0)))
    return Network(
        coordinates=tuple(coordinates), masses=tuple(masses), links=tuple(links), outputs=outputs, slides=slides
    )


def elastomer(car: QuarterCar, vary: Mapping[str, Numbers] | None = None) -> Maxwell:
    """Return the law of the elastomer (2.8); see `quarter_car` for the arguments."""
    value = Variation(car, vary or {})
    names = ("stiffness", "branch_stiffness", "branch_damping")
    return Maxwell(**{name: value(f"elastomer.{name}") for name in names})


def single_mass(
    *, mass: Numbers, friction: ForceLaw, stiffness: Numbers = 0.0, damping: Numbers = 0.0, belt: bool = False
) -> Network:
    """Return a single mass m x'' + D x' + K x + f(x') = F; on a belt, f acts on x' minus the belt velocity.

    Coordinate and output: `mass`. The applied force acts on the mass; the road displacement acts on the belt.

    Args:
        mass: mass m [kg].
        friction: law of the friction f.
        stiffness: spring K to the ground [N/m].
        damping: damper D to the ground [N s/m].
        belt: friction between mass and belt instead of mass and ground.

    Returns:
        The network.

    Source: Bommer 2006, section 2.3.2.1 and equation 2.5.
    """
    row = {"mass": 1.0}
    return Network(
        coordinates=("mass",),
        masses=(Mass(mass=mass, axes=(row,)),),
        links=(Link(row=row, law=Kelvin(stiffness=stiffness, damping=damping)),),
        outputs={"mass": row},
        slides=(Slide(row={**row, ROAD: -1.0} if belt else row, friction=friction),),
        force=row,
    )


@dataclass(frozen=True, slots=True)
class Variation:
    """Parameter values of a quarter car by path, with replacements, for example {"mount.stiffness": array}.

    Raises:
        ConfigurationError: an unknown path (the message suggests the nearest) or a value out of range.
    """

    car: QuarterCar
    replaced: Mapping[str, Numbers] = field(default_factory=dict)

    def __post_init__(self) -> None:
        table = as_table(self.car)
        by_full_path = {full_path(table, path): value for path, value in self.replaced.items()}
        for path, value in by_full_path.items():
            check(path, value, quantity_of(QuarterCar, path))
        object.__setattr__(self, "replaced", by_full_path)

    def __call__(self, path: str) -> Numbers:
        """Return the value of a parameter, for example "mount.stiffness"."""
        if path in self.replaced:
            return self.replaced[path]
        part, _, name = path.partition(".")
        value: float = getattr(getattr(self.car, part), name)
        return value
