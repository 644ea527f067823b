"""Files of the cars: a unit and a source behind every value; of the Focus printed numbers, round trips, overrides."""

import dataclasses
import re
import tomllib
from typing import Any

import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import override, paths
from vehicle.model.parameters.shipped import CARS, FOCUS_FILE, vehicle_file
from vehicle.model.parameters.toml_file import as_table, read_table, write_text
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of

LINE = re.compile(r"^(?P<name>[a-z_0-9]+) = (?P<value>.+?)\s+# \[(?P<unit>[^]]+)\] (?P<source>.+)$")
SOURCE = re.compile(
    r"\b(section|appendix|equation|table|figure|Chrono)\b|^(assumed|fitted)\b|\bassumed\b|measured car", re.I
)

WHOLE = [name for name in CARS if "base" not in read_table(vehicle_file(name))]
"""Cars whose files are not laid over another one."""


def value_lines(file=FOCUS_FILE):
    """(dotted path, unit, source) of every line with a value."""
    found, table = [], ""
    for text in file.read_text(encoding="utf-8").splitlines():
        if text.startswith("[alias]"):
            break
        if text.startswith("["):
            table = text.strip("[]") + "."
        elif "=" in text.partition("#")[0]:
            match = LINE.match(text)
            assert match, f"no unit and source behind: {text}"
            found.append((table + match["name"], match["unit"], match["source"]))
    return found


@pytest.mark.parametrize("name", WHOLE)
def test_every_value_has_a_unit_and_a_source(name):
    lines = value_lines(vehicle_file(name))
    # Each file has 145 values or more; an empty or half-read file would pass everything else.
    assert len(lines) > 130
    without = [path for path, _, source in lines if not SOURCE.search(source)]
    assert without == []
    assert len({path for path, _, _ in lines}) == len(lines)


@pytest.mark.parametrize("name", WHOLE)
def test_the_units_are_those_of_the_classes(name):
    car = load_vehicle(name)
    lines = value_lines(vehicle_file(name))
    values = [path.removesuffix(".on").removesuffix(".at") for path in paths(car.table)]
    assert [path for path, _, _ in lines] == [
        *dict.fromkeys(one for one in values if one[-2:] not in (".x", ".y", ".z"))
    ]
    assert car.quantity_of("outputs.seat.at.x")["unit"] == "m"
    wrong = {path: unit for path, unit, _ in lines if car.quantity_of(path).get("unit", "-") != unit}
    assert wrong == {}


@pytest.mark.parametrize("name", WHOLE)
def test_assumed_numbers_say_why(name):
    for path, _, source in value_lines(vehicle_file(name)):
        for word in ("assumed", "fitted"):
            if source.startswith(word):
                reason = source.removeprefix(word).lstrip(": ")
                assert len(reason) >= 4, f"{path}: {word}, but why?"


def test_published_numbers_are_there():
    # Appendix F and section 3.1.2, typed from the source a second time.
    car = load_vehicle()
    law: dict[str, Any] = {one.name: one.law for one in car.composition.connections}
    assert law["tyre_fr"].stiffness == (1.5e5, 1.5e5, 2.5e5) and law["tyre_fr"].damping == (0.0, 0.0, 400.0)
    assert law["suspension_mount_fl"].stiffness == (3.0e6, 3.0e6, 7.0e5)
    assert law["suspension_mount_fl"].damping == (4000.0, 8000.0, 0.0)
    assert law["arm_rear_fr"].stiffness == (2.5e5, 8.0e5, 8.0e5) and law["arm_rear_fr"].damping[1] == 8000.0
    assert law["rear_support_left"].stiffness == (1.5e5, 4.0e4, 1.3e5)
    assert law["rear_support_left"].damping == (100.0, 500.0, 1000.0)
    assert law["linear_mount"].stiffness == (6.0e5, 3.0e5, 5.0e5)
    assert law["hydromount"].stiffness == (4.0e5, 8.0e5, 4.0e5)
    assert (law["hydromount"].maxwell_stiffness, law["hydromount"].maxwell_damping) == (1.0e5, 2000.0)
    assert {one.rotational_stiffness for one in law.values() if one is not None} == {100.0}
    assert {one.stiffness for one in car.composition.springs} == {2.5e4}
    assert [one.stiffness for one in car.composition.joint_springs] == [5.0e3]
    damper = car.damper
    assert (damper.viscous, damper.coulomb_friction, damper.smoothing) == (2250.0, 125.0, 1e5)
    assert (damper.viscous_law, damper.degressive_viscous, damper.degressive_velocity) == ("linear", 15000.0, 0.02)
    assert (damper.stribeck_friction, damper.stribeck_velocity, damper.stribeck_exponent) == (125.0, 0.03, 3.5)
    body = car.body
    assert (body.mass, body.cog) == (813.0, (2.157, 0.0, 1.011))
    own = body.inertia
    assert (own.about, own.ixx, own.iyy, own.izz) == ("origin", 1000.0, 5268.0, 4600.0)
    assert (own.ixy, own.izx, own.iyz) == (82.03, 1800.0, -50.04)


def test_written_text_builds_an_equal_car():
    car = load_vehicle(None, ["damper.coulomb_friction=93.75", "body.flexible=false", "name=other-1.2"])
    text = write_text(car, "one line\n\nanother")
    assert text.startswith("# one line\n#\n# another\n")
    assert vehicle_of(tomllib.loads(text)) == car
    assert vehicle_of(as_table(car)) == car
    # Written twice is written the same.
    assert write_text(vehicle_of(tomllib.loads(text)), "one line\n\nanother") == text
    # Units travel with the numbers.
    assert "coulomb_friction = 93.75  # [N] Fd, Coulomb friction" in text


def test_overrides_change_one_value_and_not_the_table():
    table = read_table(FOCUS_FILE)
    before = repr(table)
    changed = override(table, ["damper.coulomb_friction=93.75", "bushings.tyre.stiffness=[1e5, 1e5, 2e5]"])
    assert repr(table) == before
    assert changed["front"]["damper"]["coulomb_friction"] == 93.75
    assert changed["front"]["bushings"]["tyre"]["stiffness"] == [1e5, 1e5, 2e5]
    table["front"]["damper"]["coulomb_friction"] = 93.75
    table["front"]["bushings"]["tyre"]["stiffness"] = [1e5, 1e5, 2e5]
    assert vehicle_of(changed) == vehicle_of(table) != load_vehicle()
    # A whole number is a number; the last of two wins; a word needs no quotes.
    assert load_vehicle(None, ["damper.viscous=2000", "damper.viscous=2100"]).damper.viscous == 2100.0
    assert load_vehicle(None, ["damper.friction_law=stribeck"]).damper.friction_law == "stribeck"


def test_an_override_may_name_an_axis():
    table = read_table(FOCUS_FILE)
    path = "bushings.suspension_mount.stiffness"
    changed = load_vehicle(None, [f"{path}.z=5e5", f"{path}.x=1e6"]).table["front"]["bushings"]
    assert changed["suspension_mount"]["stiffness"] == [1e6, 3e6, 5e5]
    assert override(table, ["hardpoints.seat_rail.y=-0.4"])["hardpoints"]["seat_rail"][1] == -0.4
    for wrong in (f"{path}.w=1", f"{path}.z.x=1", "damper.viscous.z=1"):
        with pytest.raises(ConfigurationError, match="unknown parameter"):
            load_vehicle(None, [wrong])
    with pytest.raises(ConfigurationError, match=r"must be at least 0\.0"):
        load_vehicle(None, [f"{path}.z=-1"])


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        (
            "damper.coulomb_fricton=1",
            "--set damper.coulomb_fricton=1: unknown parameter damper.coulomb_fricton; "
            "did you mean front.damper.coulomb_friction",
        ),
        ("damper", "--set damper: must be PATH=VALUE, for example damper.coulomb_friction=93.75"),
        ("=3", "--set =3: must be PATH=VALUE, for example damper.coulomb_friction=93.75"),
        ("main_spring=3", "--set main_spring=3: main_spring is a group; set one of front.main_spring.stiffness"),
        *(
            (f"damper.viscous={text}", f"--set damper.viscous={text}: must be the new value")
            for text in ("+20", "+25%", "*1.2", "2250+20")
        ),
        ("damper.viscous=many", ("--set damper.viscous=many: cannot read many")),
    ],
)
def test_bad_overrides(assignment, message):
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, [assignment])
    assert str(caught.value).startswith(message)


def test_parameters_are_frozen():
    car = load_vehicle()
    with pytest.raises(dataclasses.FrozenInstanceError):
        car.damper.viscous = 1.0  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        car.composition.parts[0].numbers.mass = 1.0  # type: ignore[misc]
