"""Stated numbers of a new car; all are optional, and the template car supplies the others."""

import dataclasses
import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import quantity, validate
from vehicle.model.parameters.rigid_part import Load
from vehicle.model.parameters.toml_file import build, read_table

AXLES = ("front", "rear")
"""Words for the two axles in the names of the numbers."""

BODY: dict[str, Any] = {
    "at_least": 0.3,
    "at_most": 8.0,
    "why": "bodies of cars move at 1 to 2 Hz, of race cars up to 6 Hz",
}
CAR: dict[str, Any] = {"at_least": 100.0, "why": "kg, not t"}
AXLE: dict[str, Any] = {"at_least": 20.0, "why": "kg, neither a share nor t"}
METRES: dict[str, Any] = {"why": "m, not mm"}
HOP: dict[str, Any] = {"at_least": 4.0, "at_most": 30.0, "why": "wheels of cars hop at 8 to 16 Hz"}
RATIO: dict[str, Any] = {"why": "a ratio: 30 % of critical damping is 0.3"}
UNSPRUNG: dict[str, Any] = {"at_least": 20.0, "at_most": 2000.0, "why": "of the axle, not of a wheel"}
RATE: dict[str, Any] = {"at_least": 3e3, "at_most": 1e6, "why": "N/m, not N/mm; springs of cars have 1.5e4 to 2e5"}
TYRE: dict[str, Any] = {"at_least": 5e4, "at_most": 2e6, "why": "N/m, not N/mm; tyres of cars have 1.5e5 to 4e5"}
DAMPING: dict[str, Any] = {"at_least": 50.0, "at_most": 1e5, "why": "N s/m; dampers of cars have 1e3 to 5e3"}

optional = partial(quantity, default=None)
"""Declaration of a number that need not be stated."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StatedNumbers:
    """Numbers of a car; None: not stated. `option` returns its name on a command line.

    `tyre_size`, e.g. 205/55R16, replaces the radius. `of_class` has the names of the numbers taken from the class
    of the car, `of_load` of those that follow from the load of the wheels.
    """

    kerb_mass: float | None = optional("kg", "mass of the car without driver and loads ([load])", at_most=2e4, **CAR)
    front_axle_load: float | None = optional(
        "kg", "axle load of the front axle, without driver and loads ([load])", at_most=2e4, **AXLE
    )
    rear_axle_load: float | None = optional(
        "kg", "axle load of the rear axle, without driver and loads ([load])", at_most=2e4, **AXLE
    )
    cog_x: float | None = optional(
        "m", "centre of gravity behind the front axle, instead of an axle load", above=0.0, at_most=8.0, **METRES
    )
    cog_height: float | None = optional(
        "m",
        "centre of gravity above the ground",
        at_least=0.2,
        at_most=1.5,
        why="m, not mm; cars have 0.44 to 0.85 m, tracks of 1.4 to 1.7 m being 1 to 1.6 times twice the height",
    )
    wheelbase: float | None = optional("m", "wheelbase", above=0.0, at_most=8.0, **METRES)
    track_front: float | None = optional("m", "track of the front wheels", above=0.0, at_most=4.0, **METRES)
    track_rear: float | None = optional("m", "track of the rear wheels", above=0.0, at_most=4.0, **METRES)
    tyre_radius: float | None = optional(
        "m", "loaded radius: wheel centre above the ground", above=0.0, at_most=2.0, **METRES
    )
    tyre_free_radius: float | None = optional(
        "m", "radius without load, instead of the loaded radius", above=0.0, at_most=2.0, **METRES
    )
    roll_inertia: float | None = optional(
        "kg m2", "Ixx of the car about its centre of gravity, without [load]", above=0.0
    )
    pitch_inertia: float | None = optional(
        "kg m2", "Iyy of the car about its centre of gravity, without [load]", above=0.0
    )
    yaw_inertia: float | None = optional(
        "kg m2", "Izz of the car about its centre of gravity, without [load]", above=0.0
    )
    inertia: str = quantity(
        "-",
        "estimate of moments of inertia that are not stated: from the radii of gyration of the template, or "
        "from the means of 73 cars",
        choices=("template", "survey"),
        default="template",
    )
    ride_frequency_front: float | None = optional("Hz", "ride frequency of the front axle", **BODY)
    ride_frequency_rear: float | None = optional("Hz", "ride frequency of the rear axle", **BODY)
    pitch_frequency: float | None = optional("Hz", "pitch frequency of the sprung mass; sets the pitch inertia", **BODY)
    wheel_hop_front: float | None = optional("Hz", "hop frequency of the front wheels; sets the tyre stiffness", **HOP)
    wheel_hop_rear: float | None = optional("Hz", "hop frequency of the rear wheels; sets the tyre stiffness", **HOP)
    damping_ratio_front: float | None = optional(
        "-", "damping ratio of the front axle, dampers at 0.1 m/s", above=0.0, at_most=3.0, **RATIO
    )
    damping_ratio_rear: float | None = optional(
        "-", "damping ratio of the rear axle, dampers at 0.1 m/s", above=0.0, at_most=3.0, **RATIO
    )
    damper_curve_front: str | None = optional(
        "-", "damper test of the front axle: table of velocity and force", is_file=True
    )
    damper_curve_rear: str | None = optional(
        "-", "damper test of the rear axle: table of velocity and force", is_file=True
    )
    roll_stiffness_front: float | None = optional(
        "N m/deg", "roll stiffness of the front axle without the tyres; sets the stabilizer", above=0.0
    )
    roll_stiffness_rear: float | None = optional(
        "N m/deg",
        "roll stiffness of the rear axle without the tyres; sets the stabilizer, or the torsion of the beam",
        above=0.0,
    )
    unsprung_mass_front: float | None = optional("kg", "unsprung mass of the front axle, both wheels", **UNSPRUNG)
    unsprung_mass_rear: float | None = optional("kg", "unsprung mass of the rear axle, both wheels", **UNSPRUNG)
    wheel_rate_front: float | None = optional("N/m", "spring rate of a front wheel, at the wheel", **RATE)
    wheel_rate_rear: float | None = optional("N/m", "spring rate of a rear wheel, at the wheel", **RATE)
    spring_stiffness_front: float | None = optional("N/m", "stiffness of a front spring, at the spring", **RATE)
    spring_stiffness_rear: float | None = optional("N/m", "stiffness of a rear spring, at the spring", **RATE)
    tyre_stiffness_front: float | None = optional("N/m", "vertical stiffness of a front tyre", **TYRE)
    tyre_stiffness_rear: float | None = optional("N/m", "vertical stiffness of a rear tyre", **TYRE)
    wheel_damping_front: float | None = optional("N s/m", "damping of a front wheel, at the wheel", **DAMPING)
    wheel_damping_rear: float | None = optional("N s/m", "damping of a rear wheel, at the wheel", **DAMPING)
    damper_constant_front: float | None = optional("N s/m", "constant of a front damper at 0.1 m/s", **DAMPING)
    damper_constant_rear: float | None = optional("N s/m", "constant of a rear damper at 0.1 m/s", **DAMPING)
    car_class: str | None = optional("-", "class of the car, which sets default values")
    tyre_size: str | None = None
    of_class: tuple[str, ...] = ()
    of_load: tuple[str, ...] = ()
    load: Mapping[str, dict] = field(default_factory=dict)  # type: ignore[type-arg]

    def __post_init__(self) -> None:
        validate(self)
        same = [
            pair
            for names in SAME_PARAMETER
            for axle in AXLES
            for pair in itertools.combinations([f"{name}_{axle}" for name in names], 2)
        ]
        for first, second, why in (
            *((*pair, "both set the same part") for pair in same),
            ("pitch_frequency", "pitch_inertia", "each follows from the other"),
            ("damping_ratio_front", "damper_curve_front", "the curve sets the damping"),
            ("damping_ratio_rear", "damper_curve_rear", "the curve sets the damping"),
            ("tyre_radius", "tyre_free_radius", "each follows from the other under the load"),
            ("cog_x", "front_axle_load", "both give the position of the centre of gravity"),
            ("cog_x", "rear_axle_load", "both give the position of the centre of gravity"),
        ):
            solved = {first, second} == {"tyre_radius", "tyre_free_radius"} and "tyre_radius" in self.of_load
            if getattr(self, first) is not None and getattr(self, second) is not None and not solved:
                raise ConfigurationError(f"{option(first)} and {option(second)}: {why}; leave one of the two out")
        mass, front, rear = self.kerb_mass, self.front_axle_load, self.rear_axle_load
        if (
            mass is not None
            and front is not None
            and rear is not None
            and abs(front + rear - mass) > LOADS_AGREE * mass
        ):
            raise ConfigurationError(
                f"{option('front_axle_load')} {front:g} kg and {option('rear_axle_load')} {rear:g} kg: together "
                f"{front + rear:g} kg instead of the kerb mass of {mass:g} kg; leave one of the three out"
            )
        for name, load in self.load.items():
            build(Load, {key: value for key, value in load.items() if key not in ("at", "on")}, f"load.{name}")

    def of_axle(self, name: str, axle: str) -> Any:
        """Return a number of an axle: `name` followed by its word."""
        return getattr(self, f"{name}_{axle}")

    def stated(self, name: str) -> str:
        """Return the text of a number: "kerb mass 1450 kg (given)", or "(class small)" for a number of the class."""
        unit = self.__dataclass_fields__[name].metadata["unit"]
        unit = "" if unit == "-" else f" {unit}"
        return f"{name.replace('_', ' ')} {getattr(self, name):g}{unit} ({self.origin(name)})"

    def origin(self, name: str) -> str:
        """Return where a number comes from: "given", "class small" or "tyre 205/55R16"."""
        if name == "tyre_radius" and self.tyre_size is not None:
            return f"tyre {self.tyre_size}"
        if name == "tyre_radius" and self.tyre_free_radius is not None:
            return f"free radius {self.tyre_free_radius:g} m"
        return f"class {self.car_class}" if name in self.of_class else "given"


SAME_PARAMETER = (
    ("ride_frequency", "wheel_rate", "spring_stiffness"),
    ("damping_ratio", "wheel_damping", "damper_constant"),
    ("damper_curve", "wheel_damping"),
    ("damper_curve", "damper_constant"),
    ("wheel_hop", "tyre_stiffness"),
)
"""Numbers of an axle of which one sets a part: spring, damper, tyre."""

LOADS_AGREE = 5e-4
"""Largest deviation of the sum of two axle loads from the kerb mass, divided by it: half of the promised 0.1 %."""

NOT_NUMBERS = ("tyre_size", "load", "inertia", "car_class", "of_class", "of_load")
"""Fields that are no numbers of a car."""

NAMES = tuple(entry.name for entry in dataclasses.fields(StatedNumbers) if entry.name not in NOT_NUMBERS)


AXLE_LOADS = ("front_axle_load", "rear_axle_load")
"""Numbers that may also be stated in percent of the kerb mass."""


def option(name: str) -> str:
    """Return the option of a number on the command line: "--kerb-mass"."""
    return f"--{name.replace('_', '-')}"


def stated_numbers(
    file: Path | None, more: Mapping[str, Any], of_table: Mapping[str, Any] | None = None
) -> StatedNumbers:
    """Return the numbers of a TOML file and of a command line, which takes precedence.

    Args:
        file: TOML file with the names of `StatedNumbers` and tables [load.NAME]; None without a file.
        more: numbers by name, which may be None.
        of_table: numbers of a table of the car, which typed numbers replace, also where both set the same part.
    """
    table = {} if file is None else read_table(file)
    for name in ("damper_curve_front", "damper_curve_rear"):
        if file is not None and isinstance(table.get(name), str):
            table[name] = str(file.parent / table[name])
    table |= {name: value for name, value in more.items() if value is not None}
    of_table, typed = dict(of_table or {}), set(table)
    if typed & {*AXLE_LOADS, "cog_x"} and set(AXLE_LOADS) <= set(of_table):
        # The mass of the table stays where a typed load replaces its two.
        of_table["kerb_mass"] = sum(of_table[name] for name in AXLE_LOADS)
    for name, value in of_table.items():
        if not any(name in names and typed & set(names) for names in _replaced()):
            table.setdefault(name, value)
    table |= {name: _load_of(name, table) for name in AXLE_LOADS if isinstance(table.get(name), str)}
    try:
        return build(StatedNumbers, table)
    except ConfigurationError as error:
        text = str(error).replace("StatedNumbers.", "")
        key = text.split(":")[0]
        raise ConfigurationError(f"{option(key)}{text[len(key) :]}" if key in NAMES else text) from None


def _replaced() -> list[tuple[str, ...]]:
    """Return groups of numbers: a typed number replaces the others of its group in a table."""
    loads = ("cog_x", "front_axle_load", "rear_axle_load")
    parts = [tuple(f"{name}_{axle}" for name in names) for names in SAME_PARAMETER for axle in AXLES]
    return [loads, ("tyre_radius", "tyre_free_radius", "tyre_size"), ("pitch_frequency", "pitch_inertia"), *parts]


def _load_of(name: str, table: Mapping[str, Any]) -> float:
    """Return an axle load in percent of the kerb mass, for example "57%", in kg."""
    text, mass = str(table[name]).strip(), table.get("kerb_mass")
    try:
        share = 0.01 * float(text.removesuffix("%"))
    except ValueError:
        share = math.nan
    if not (text.endswith("%") and math.isfinite(share)):
        raise ConfigurationError(
            f"{option(name)} {table[name]!r}: must be a number in kg, or a share of the kerb mass, e.g. 57%"
        )
    if not isinstance(mass, (int, float)):
        raise ConfigurationError(f"{option(name)} {text}: is a share of the kerb mass; state {option('kerb_mass')} too")
    return share * mass
