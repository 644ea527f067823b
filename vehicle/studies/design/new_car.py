"""Make a new car from a template car and stated numbers, write its vehicle file, check the stated numbers."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from vehicle.engines.simulation.car_masses import car_masses
from vehicle.errors import SimulationError
from vehicle.model.parameters.instance import instances
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.quantity import field_quantity
from vehicle.model.parameters.template import own_templates
from vehicle.model.parameters.value_sources import value_sources
from vehicle.model.parameters.whole_body import put
from vehicle.runs.car import Car
from vehicle.studies.design.axle_types import with_axles
from vehicle.studies.design.car_class import POWERTRAIN, of_class, powertrain
from vehicle.studies.design.car_file import vehicle_text
from vehicle.studies.design.mass_balance import axle_loads, balanced, kerb_mass, kerb_model
from vehicle.studies.design.moved_points import Sources, moved_points
from vehicle.studies.design.ride_solution import Target, new_car_of, quantities, solved, targets_of
from vehicle.studies.design.scaled_parts import scaled_parts
from vehicle.studies.design.stated_numbers import AXLES, NAMES, StatedNumbers, option
from vehicle.studies.design.table_points import put_parameters, put_points, put_tyre
from vehicle.studies.design.template_car import TemplateCar, template_car
from vehicle.studies.design.tyre_size import with_tyre_size
from vehicle.studies.design.unsprung_parts import put_unsprung
from vehicle.studies.tables.car_table import CarTable
from vehicle.threads import one_blas_thread

LOADS_MET, FREQUENCIES_MET = 1e-3, 1e-2
"""Largest relative deviation of masses and lengths, and of frequencies, damping ratios and roll stiffnesses."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Check:
    """Stated number and the value of the new car.

    Attributes:
        name: name of the number, a field of `StatedNumbers`.
        unit: its unit.
        stated: stated value, or that of the class of the car; None without one.
        value: value of the new car.
        origin: where the value comes from; empty for a number that the user has stated.
    """

    name: str
    unit: str
    stated: float | None
    value: float
    origin: str

    @property
    def deviation(self) -> float:
        """Relative deviation of the value from the stated one [-]; 0 without a stated one."""
        return 0.0 if self.stated is None else self.value / self.stated - 1.0


@dataclass(frozen=True, kw_only=True, slots=True)
class NewCar:
    """A new car.

    Attributes:
        car: the car, ready to run.
        text: its vehicle file.
        checks: each number of the car with its stated value.
        parts: parts without a stated number, and their origin.
        notes: messages about unusual figures and about parts of the template that are left out.
    """

    car: Car
    text: str
    checks: tuple[Check, ...]
    parts: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]


@one_blas_thread()
def new_car(name: str, source: Path | str, stated: StatedNumbers, points: CarTable | None = None) -> NewCar:
    """Make a new car.

    Args:
        name: name of the new car.
        source: template: name of a shipped car, or a vehicle file.
        stated: numbers of the new car; all others come from its class or the template, or are estimated.
        points: table of the car with points, curves and numbers of parts.

    Returns:
        The car, whose numbers are met within `LOADS_MET` and `FREQUENCIES_MET`.

    Raises:
        ConfigurationError: a car that cannot be; the message has the number that must change.
        SimulationError: a number is not met.
    """
    stated = of_class(stated)
    template = template_car(source)
    template_mass = car_masses(kerb_model(template.table, template)).mass
    ratio = kerb_mass(stated, template_mass) / template_mass
    stated = with_tyre_size(stated, template, ratio)
    engine = powertrain(stated.car_class)
    template = template.with_powertrain(engine)
    source_car = template
    if points is not None:
        template = with_axles(template, points.axles)
    table, sources = moved_points(template, stated)
    if points is not None:
        sources |= put_points(table, template, points)
    before = value_sources(template.file)
    table, scaled = scaled_parts(table, template, ratio, powertrain=engine is None)
    of_parts = {path: f"{text}: {before[path]}" if path in before else text for path, text in scaled.items()}
    if points is not None:
        of_parts |= put_parameters(table, template, points)
    of_parts |= put_unsprung(table, template, stated)
    table, of_body = balanced(table, template, stated)
    if points is not None:
        of_parts |= put_tyre(table, template, points)
    sources |= of_parts | of_body | _curves(table, template, stated, points)
    if engine is not None:
        sources["engine"] = f"class {stated.car_class}: {POWERTRAIN}"
    if stated.load:
        table["load"] = dict(stated.load)
        sources |= {f"load.{load}": "given" for load in stated.load}
    targets = targets_of(template, stated, () if points is None else tuple(points.curves), source_car)
    # The step of the template is short enough for the template; without it each car gets its own.
    solver = {key: value for key, value in table.get("solver", {}).items() if key != "timestep"}
    table = solved({**table, "name": name, "solver": solver}, template, targets)
    sources |= {"name": "given", **_sources_of_targets(targets, stated, template)}
    car = new_car_of(table, template)
    checks = _checks_of(car, template, stated, ratio)
    _require_met(checks)
    header = (
        f"{name}: made by `python -m vehicle new` from the template {template.name}.\n"
        "Behind each value stand its unit and its origin: given, estimated by ..., or taken from the template (and\n"
        "the source stated there).\n"
        "Frame: x to the rear, y to the driver's right, z up. SI units."
    )
    text = vehicle_text(car.vehicle, header, sources, template.name, before)
    return NewCar(
        car=car,
        text=text,
        checks=checks,
        parts=_parts(template, stated, ratio),
        notes=_notes(car, template, stated, points),
    )


def template_files(source: Path, car: Car) -> list[Path]:
    """Return the templates of a user that a new car needs in its folder."""
    folders = (source.parent, source.parent / "templates")
    names = [str(instance.numbers["template"]) for instance in instances(car.vehicle.table, folders).values()]
    return own_templates(names, folders)


def _curves(table: dict[str, Any], template: TemplateCar, stated: StatedNumbers, points: CarTable | None) -> Sources:
    """Put the stated damper curves into a vehicle table; return their sources."""
    sources = Sources()
    for word in AXLES:
        rows = None if points is None else points.curves.get(word)
        if (file := stated.of_axle("damper_curve", word)) is not None:
            law: dict[str, Any] = {"curve": str(Path(file).absolute())}
            name = Path(file).name
        elif rows is not None and points is not None:
            law = {"velocity": [velocity for velocity, _ in rows], "force": [force for _, force in rows]}
            name = points.file
        else:
            continue
        for path in template.element_paths(word)["damper"]:
            numbers = {k: v for k, v in value_at(table, path).items() if k not in ("viscous", "velocity", "force")}
            numbers |= {"viscous_law": "table", **law}
            put(table, {path: numbers})  # type: ignore[dict-item]
            sources |= {f"{path}.{key}": f"given: {name}" for key in ("viscous_law", "velocity", "force")}
    return sources


def _sources_of_targets(targets: list[Target], stated: StatedNumbers, template: TemplateCar) -> Sources:
    """Return the sources of the solved parameters."""
    sources = Sources()
    for target in targets:
        if getattr(stated, target.name) is not None:
            text = f"from {stated.stated(target.name)}"
        else:
            text = f"estimated: {target.name.replace('_', ' ')} of {template.name}, {target.value:.4g}"
        if target.name == "pitch_frequency":
            sources |= {"body.inertia.izz": f"scaled with Iyy, which is {text}"}
        sources |= {path.removesuffix(".z"): text for path in target.paths if path != "body.inertia.izz"}
        for path in target.paths:
            if path.endswith(".z"):
                sources[path.removesuffix(".z")] = f"z {text}; x and y of template {template.name}"
    return sources


def _checks_of(car: Car, template: TemplateCar, stated: StatedNumbers, ratio: float) -> tuple[Check, ...]:
    """Return all numbers of a car with their stated values and origins."""
    kerb = kerb_model(car.vehicle.table, template)
    whole, loads = car_masses(kerb), axle_loads(kerb, template)
    wheels = {wheel.name: wheel for wheel in car.vehicle.composition.wheels}
    front, rear = ([wheels[wheel.name] for wheel in template.wheels[word]] for word in AXLES)
    values = {
        "kerb_mass": whole.mass,
        "front_axle_load": loads["front"],
        "rear_axle_load": loads["rear"],
        "cog_x": float(whole.cog[0]) - front[0].center[0],
        "cog_height": float(whole.cog[2]) - front[0].patch[2],
        "wheelbase": rear[0].center[0] - front[0].center[0],
        "track_front": front[0].center[1] - front[1].center[1],
        "track_rear": rear[0].center[1] - rear[1].center[1],
        "tyre_radius": front[0].center[2] - front[0].patch[2],
        **{f"{axis}_inertia": float(whole.inertia[i, i]) for i, axis in enumerate(("roll", "pitch", "yaw"))},
        **quantities(car, template),
    }
    return tuple(
        Check(
            name=name,
            unit=field_quantity(StatedNumbers, name)["unit"],
            stated=getattr(stated, name),
            value=values[name],
            origin=_origin(name, template, stated, ratio),
        )
        for name in NAMES
        if name in values and (name not in ONLY_STATED or getattr(stated, name) is not None)
    )


def _require_met(checks: tuple[Check, ...]) -> None:
    """Raise an error if a stated number is not met; the pitch inertia is met by the pitch frequency instead."""
    exact = {entry.name for entry in fields(StatedNumbers) if entry.metadata.get("unit") in ("kg", "m", "kg m2")}
    for check in checks:
        if abs(check.deviation) > (LOADS_MET if check.name in exact else FREQUENCIES_MET):
            raise SimulationError(
                f"{check.name}: stated {check.stated:g} {check.unit}, but the new car has {check.value:g} "
                f"{check.unit}; your numbers contradict each other: leave one of them out"
            )


DAMPING = ("damping_ratio_front", "damping_ratio_rear", "damper_curve_front", "damper_curve_rear")
"""Numbers of the dampers."""

FOLLOWS: dict[str, tuple[str, ...]] = {
    "mass [kg]": ("kerb_mass", "front_axle_load", "rear_axle_load"),
    "load on the front axle [%]": ("front_axle_load", "rear_axle_load", "cog_x"),
    "track over twice the CoG height": ("cog_height", "track_front", "track_rear"),
    "wheelbase [mm]": ("wheelbase",),
    "k_x / mean track": ("roll_inertia",),
    "k_y^2 / a b": ("pitch_inertia", "pitch_frequency"),
    "k_z^2 / a b": ("yaw_inertia", "pitch_frequency"),
    "track [mm]": ("track",),
    "loaded tyre radius [mm]": ("tyre_radius",),
    "spring stiffness [N/mm]": ("ride_frequency",),
    "wheel rate [N/mm]": ("ride_frequency",),
    "ride rate [N/mm]": ("ride_frequency",),
    "ride frequency [Hz]": ("ride_frequency",),
    "damping constant, smallest slope [N s/m]": ("damping_ratio", "damper_curve"),
    "tyre stiffness [N/mm]": ("wheel_hop",),
    "tyre deflection, static [mm]": ("wheel_hop",),
    "roll stiffness, springs [N m/deg]": ("ride_frequency",),
    "roll stiffness, anti-roll bar or beam [N m/deg]": ("roll_stiffness",),
    "roll stiffness, all in series [N m/deg]": ("roll_stiffness", "ride_frequency"),
    "heave [Hz]": ("ride_frequency_front", "ride_frequency_rear"),
    "pitch [Hz]": ("pitch_frequency", "ride_frequency_front", "ride_frequency_rear"),
    "roll [Hz]": ("roll_stiffness_front", "roll_stiffness_rear"),
    **dict.fromkeys((f"{motion}, damping [%]" for motion in ("heave", "pitch", "roll")), DAMPING),
    "wheel hop [Hz]": ("wheel_hop",),
    "wheel hop, damping [%]": ("damping_ratio", "damper_curve"),
    "share of roll stiffness, suspension [%]": ("roll_stiffness",),
    "share of roll stiffness, with tyres [%]": ("roll_stiffness",),
}
"""Stated numbers that a figure of the car follows from, without the word of an axle; all others are the template's."""


def _unusual_notes(car: Car, template: TemplateCar, stated: StatedNumbers, points: CarTable | None) -> Iterator[str]:
    """Yield a note with the origin of each figure outside the usual range; the loads of the car are left out."""
    kerb = new_car_of({key: value for key, value in car.vehicle.table.items() if key != "load"}, template)
    axle_words = {template.axle(word): word for word in AXLES}
    for figure in kerb.show().usual:
        if not figure.unusual:
            continue
        names = [
            name if hasattr(stated, name) else f"{name}_{axle_words[figure.axle]}"
            for name in FOLLOWS.get(figure.name, ())
        ]
        origins = [f"follows from {stated.stated(name)}" if isinstance(getattr(stated, name), float) else
                   f"follows from {option(name)}"
                   for name in dict.fromkeys(form for name in names for form in (name, *OTHER_NAMES.get(name, ())))
                   if getattr(stated, name) is not None]  # fmt: skip
        otherwise = f"from the template {template.name}"
        if points is not None and not names and len(points.points.get(axle_words.get(figure.axle, ""), {})) > 1:
            otherwise = f"from the points of {points.file}, others of the template {template.name}"
        if names:
            otherwise += f"; state {' or '.join(map(option, names))}"
        yield f"unusual: {figure}; {', '.join(origins) or otherwise}"


def _notes(car: Car, template: TemplateCar, stated: StatedNumbers, points: CarTable | None) -> tuple[str, ...]:
    """Return the notes: figures outside their usual ranges, and what is left out or kept."""
    return (
        *_unusual_notes(car, template, stated, points),
        *_tyre_notes(template, stated),
        *(f"left out from {template.name}: {text}" for text in template.left_out),
    )


def _parts(template: TemplateCar, stated: StatedNumbers, ratio: float) -> tuple[tuple[str, str], ...]:
    """Return parts without a stated number, and their origin."""
    powered = powertrain(stated.car_class) is None
    parts = "axles, powertrain, bushings, mounts, friction, tyres" if powered else "axles, bushings, friction, tyres"
    scaled = "" if ratio == 1.0 else f", scaled with the kerb mass ({ratio:.3f})"
    return (parts, f"{template.name}{scaled}"), ("points of the body", f"{template.name}, same share of the wheelbase")


ONLY_STATED = tuple(
    f"{name}_{axle}"
    for name in ("unsprung_mass", "wheel_rate", "spring_stiffness", "tyre_stiffness", "wheel_damping",
                 "damper_constant")
    for axle in AXLES
)  # fmt: skip
"""Numbers that appear only if they are stated: each is another form of one of `RIDE_ORDER`."""

RIDE_ORDER = (
    *("wheel_hop_front", "wheel_hop_rear", "ride_frequency_front", "ride_frequency_rear", "kerb_mass", "cog_x"),
    *("roll_inertia", "damping_ratio_front", "damping_ratio_rear", "track_front", "track_rear", "wheelbase"),
    *("cog_height", "tyre_radius", "roll_stiffness_front", "roll_stiffness_rear", "pitch_inertia", "yaw_inertia"),
)
"""Numbers by their influence on the weighted comfort at the seat rail. `my_car` of the README, on a class B road at
80 km/h for 30 s with the reduced engine, changes for 10 % more of a number (axles: the larger) by: wheel hop 10.1 %,
ride frequency 4.0, front axle load 2.6, roll inertia 2.5, damping ratio 1.6, track 1.6, wheelbase 1.3, height 0.8,
radius 0.5, roll stiffness 0.2, pitch and yaw inertia 0.1 % or less. The kerb mass was not varied.
"""

OTHER_NAMES = {
    "kerb_mass": ("front_axle_load", "rear_axle_load"),
    "cog_x": ("front_axle_load", "rear_axle_load"),
    "pitch_inertia": ("pitch_frequency",),
    **{
        f"{name}_{axle}": tuple(f"{other}_{axle}" for other in others)
        for axle in AXLES
        for name, others in {
            "ride_frequency": ("wheel_rate", "spring_stiffness"),
            "damping_ratio": ("damper_curve", "wheel_damping", "damper_constant"),
            "wheel_hop": ("tyre_stiffness",),
        }.items()
    },
}
"""Numbers that state another number too; the kerb mass needs both axle loads."""


def _origin(name: str, template: TemplateCar, stated: StatedNumbers, ratio: float) -> str:
    """Return where a number of the new car comes from; empty for a number that the user has stated."""
    if name in stated.of_class:
        return f"class {stated.car_class}"
    if getattr(stated, name) is not None:
        return ""
    if name not in RIDE_ORDER or _is_stated(stated, name):
        return "the other numbers"
    if name.endswith("inertia"):
        other = {"pitch_inertia": "yaw_inertia", "yaw_inertia": "pitch_inertia"}.get(name, "")
        if other and getattr(stated, other) is not None:
            return f"scaled with {other.replace('_', ' ')}"
        return "means of 73 cars" if stated.inertia == "survey" else f"{template.name}, same radius of gyration"
    scaled = ratio != 1.0 and name.startswith(("wheel_hop", "roll_stiffness"))
    return f"{template.name}, parts scaled with the kerb mass" if scaled else template.name


def _is_stated(stated: StatedNumbers, name: str) -> bool:
    """True if a number is stated, or follows from stated numbers."""
    others = [getattr(stated, other) is not None for other in OTHER_NAMES.get(name, ())]
    return getattr(stated, name) is not None or (all(others) if name == "kerb_mass" else any(others))


def _tyre_notes(template: TemplateCar, stated: StatedNumbers) -> list[str]:
    """Return the note on what the size of a tyre leaves as it is."""
    if not stated.tyre_size:
        return []
    others = f"stiffness and mass of tyres and wheels follow from {template.name}"
    return [f"--tyre-size {stated.tyre_size} sets the radius alone; {others}: set your own with --set"]
