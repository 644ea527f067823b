"""focus.toml: a unit and a source behind every value, the same units as the classes, round trips and overrides."""

from __future__ import annotations

import dataclasses
import re
import tomllib
import typing

import pytest

from vehicle.errors import ConfigurationError
from vehicle.parameters.parts import CENTER_PARTS, SIDE_PARTS, Part
from vehicle.parameters.paths import override
from vehicle.parameters.toml_file import as_table, build, read_table, write_text
from vehicle.parameters.vehicle import FOCUS_FILE, Vehicle, load_vehicle

LINE = re.compile(r"^(?P<name>[a-z_0-9]+) = (?P<value>.+?)\s+# \[(?P<unit>[^]]+)\] (?P<source>.+)$")
SOURCE = re.compile(r"\b(section|appendix|equation|table|figure)\b|^(assumed|fitted)\b|\bassumed\b|measured car", re.I)


def value_lines():
    """(dotted path, unit, source) of every line with a value."""
    found, table = [], ""
    for text in FOCUS_FILE.read_text(encoding="utf-8").splitlines():
        if text.startswith("["):
            table = text.strip("[]") + "."
        elif "=" in text.partition("#")[0]:
            match = LINE.match(text)
            assert match, f"no unit and source behind: {text}"
            found.append((table + match["name"], match["unit"], match["source"]))
    return found


def fields_by_path(cls=Vehicle, prefix=""):
    """Unit of the field metadata by dotted path; None for switches without a unit."""
    hints = typing.get_type_hints(cls)
    found: dict[str, str | None] = {}
    for entry in dataclasses.fields(cls):
        hint = hints[entry.name]
        if dataclasses.is_dataclass(hint):
            found |= fields_by_path(hint, f"{prefix}{entry.name}.")
        elif entry.name == "parts":
            for part in (*SIDE_PARTS, *CENTER_PARTS):
                found |= fields_by_path(Part, f"{prefix}parts.{part}.")
        else:
            found[prefix + entry.name] = entry.metadata.get("unit")
    return found


def test_every_value_has_a_unit_and_a_source():
    lines = value_lines()
    # The file has some 145 values; an empty or half-read file would pass everything else.
    assert len(lines) > 130
    without = [path for path, _, source in lines if not SOURCE.search(source)]
    assert without == []
    assert len({path for path, _, _ in lines}) == len(lines)


def test_the_units_are_those_of_the_classes():
    fields = fields_by_path()
    lines = value_lines()
    assert {path for path, _, _ in lines} == set(fields)
    wrong = {path: (unit, fields[path]) for path, unit, _ in lines if (fields[path] or "-") != unit}
    assert wrong == {}


def test_assumed_numbers_say_why():
    for path, _, source in value_lines():
        for word in ("assumed", "fitted"):
            if source.startswith(word):
                reason = source.removeprefix(word).lstrip(": ")
                assert len(reason) >= 4, f"{path}: {word}, but why?"


def test_published_numbers_are_there():
    # Appendix F and section 3.1.2, typed from the source a second time.
    car = load_vehicle()
    assert car.bushings.tyre.stiffness == (1.5e5, 1.5e5, 2.5e5) and car.bushings.tyre.damping == (0.0, 0.0, 400.0)
    assert car.bushings.suspension_mount.stiffness == (3.0e6, 3.0e6, 7.0e5)
    assert car.bushings.suspension_mount.damping == (4000.0, 8000.0, 0.0)
    assert car.bushings.arm_rear.stiffness == (2.5e5, 8.0e5, 8.0e5) and car.bushings.arm_rear.damping[1] == 8000.0
    assert car.bushings.rear_support.stiffness == (1.5e5, 4.0e4, 1.3e5)
    assert car.bushings.rear_support.damping == (100.0, 500.0, 1000.0)
    assert car.bushings.linear_mount.stiffness == (6.0e5, 3.0e5, 5.0e5)
    assert car.bushings.hydromount.stiffness == (4.0e5, 8.0e5, 4.0e5)
    assert (car.bushings.hydromount.maxwell_stiffness, car.bushings.hydromount.maxwell_damping) == (1.0e5, 2000.0)
    assert (car.main_spring.stiffness, car.stabilizer.torsional_stiffness) == (2.5e4, 5.0e3)
    damper = car.damper
    assert (damper.viscous, damper.coulomb_friction, damper.smoothing) == (2250.0, 125.0, 1e5)
    assert (damper.viscous_law, damper.degressive_viscous, damper.degressive_velocity) == ("linear", 15000.0, 0.02)
    assert (damper.stribeck_friction, damper.stribeck_velocity, damper.stribeck_exponent) == (125.0, 0.03, 3.5)
    body = car.body
    assert (body.mass, body.cog) == (813.0, (2.157, 0.0, 1.011))
    assert (body.ixx_published, body.ixx_improved, body.iyy, body.izz) == (1000.0, 1200.0, 5268.0, 4600.0)
    assert (body.ixy, body.izx, body.iyz) == (82.03, 1800.0, -50.04)
    assert dataclasses.replace(body, inertia_variant="improved").ixx == 1200.0
    rotational = {getattr(car.bushings, entry.name).rotational_stiffness for entry in dataclasses.fields(car.bushings)}
    assert rotational == {100.0}


def test_written_text_builds_an_equal_car():
    car = load_vehicle(None, ["damper.coulomb_friction=93.75", "body.flexible=false", "name=other-1.2"])
    text = write_text(car, "one line\n\nanother")
    assert text.startswith("# one line\n#\n# another\n")
    assert build(Vehicle, tomllib.loads(text)) == car
    assert build(Vehicle, as_table(car)) == car
    # Written twice is written the same.
    assert write_text(build(Vehicle, tomllib.loads(text)), "one line\n\nanother") == text
    # Units travel with the numbers.
    assert "coulomb_friction = 93.75  # [N] Fd, Coulomb friction" in text


def test_overrides_change_one_value_and_not_the_table():
    table = read_table(FOCUS_FILE)
    before = repr(table)
    changed = override(table, ["damper.coulomb_friction=93.75", "bushings.tyre.stiffness=[1e5, 1e5, 2e5]"])
    assert repr(table) == before
    assert changed["damper"]["coulomb_friction"] == 93.75
    assert changed["bushings"]["tyre"]["stiffness"] == [1e5, 1e5, 2e5]
    car, plain = build(Vehicle, changed), load_vehicle()
    assert dataclasses.replace(car, damper=plain.damper, bushings=plain.bushings) == plain
    # A whole number is a number; the last of two wins; a word needs no quotes.
    assert load_vehicle(None, ["damper.viscous=2000", "damper.viscous=2100"]).damper.viscous == 2100.0
    assert load_vehicle(None, ["damper.friction_law=stribeck"]).damper.friction_law == "stribeck"


def test_an_override_may_name_an_axis():
    table = read_table(FOCUS_FILE)
    path = "bushings.suspension_mount.stiffness"
    changed = load_vehicle(None, [f"{path}.z=5e5", f"{path}.x=1e6"]).bushings.suspension_mount.stiffness
    assert changed == (1e6, table["bushings"]["suspension_mount"]["stiffness"][1], 5e5)
    assert override(table, ["hardpoints.seat_rail.y=-0.4"])["hardpoints"]["seat_rail"][1] == -0.4
    for wrong in (f"{path}.w=1", f"{path}.z.x=1", "damper.viscous.z=1"):
        with pytest.raises(ConfigurationError, match="no parameter"):
            load_vehicle(None, [wrong])
    with pytest.raises(ConfigurationError, match=r"must be at least 0\.0"):
        load_vehicle(None, [f"{path}.z=-1"])


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        (
            "damper.coulomb_fricton=1",
            "--set damper.coulomb_fricton=1: no parameter damper.coulomb_fricton; "
            "the nearest is damper.coulomb_friction",
        ),
        ("damper", "--set damper: needed is PATH=VALUE, as in damper.coulomb_friction=93.75"),
        ("=3", "--set =3: needed is PATH=VALUE, as in damper.coulomb_friction=93.75"),
        (
            "main_spring=3",
            "--set main_spring=3: main_spring is a group; set one of main_spring.stiffness",
        ),
        (
            "damper.viscous=many",
            "--set damper.viscous=many: 'many' is not a number, a list of numbers or a text",
        ),
    ],
)
def test_bad_overrides(assignment, message):
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, [assignment])
    assert str(caught.value) == message


def test_parameters_are_frozen():
    car = load_vehicle()
    with pytest.raises(dataclasses.FrozenInstanceError):
        car.damper.viscous = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        car.parts["engine"] = car.parts["tyre"]  # type: ignore[index]
