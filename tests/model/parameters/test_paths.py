"""Paths of parameters: into vehicles and back, whole or their ends, with their units."""

import re
import tomllib

import numpy as np
import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.driving import require_speed_once
from vehicle.model.parameters.force_elements import Hydromount
from vehicle.model.parameters.paths import assignments, full_path, override, overrides_of, unit_of, value_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.toml_file import as_table
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car


@pytest.mark.parametrize(
    ("below", "above", "merged"),
    [
        ("[crank]\nrpm = 900", '[crank]\nfile = "speed.csv"', {"crank": {"file": "speed.csv"}}),
        ('[crank]\nfile = "speed.csv"\nchannel = "n"', "[crank]\nrpm = 900", {"crank": {"rpm": 900}}),
        ("[crank]\nrpm = 900", "[crank]\nend_rpm = 2000", {"crank": {"rpm": 900, "end_rpm": 2000}}),
        ("[force.a]\non = 'hub'\nforce = [0, 0, 1]\nfrequency = 2", "[force.a]\nmoment = [0, 1, 0]\nangle = 'crank'",
         {"force": {"a": {"on": "hub", "moment": [0, 1, 0], "angle": "crank"}}}),
        ("[force.a]\nharmonics = [[1, 2, 3]]\nangle = 'crank'", "[force.a]\nfile = 'f.csv'",
         {"force": {"a": {"file": "f.csv"}}}),
        ("[rear.nonuniformity]\nrfv = [[1, 9, 0]]\nlfv = [[1, 9, 0]]", "[rear.nonuniformity]\nrunout = [[1, 1e-4, 0]]",
         {"rear": {"nonuniformity": {"runout": [[1, 1e-4, 0]], "lfv": [[1, 9, 0]]}}}),
    ],
)  # fmt: skip
def test_a_key_replaces_the_one_of_the_base_that_excludes_it(below, above, merged, tmp_path):
    (tmp_path / "below.toml").write_text(below)
    (tmp_path / "above.toml").write_text(f'base = "below.toml"\n{above}')
    assert vehicle_table(tmp_path / "above.toml") == merged


def test_an_override_replaces_the_key_that_excludes_it_but_not_another_override():
    table = {"crank": {"file": "speed.csv", "channel": "n"}}
    optional = ["crank.rpm", "crank.file"]
    assert override(table, ["crank.rpm=900"], lambda: optional) == {"crank": {"rpm": 900}}
    both = override({"crank": {"rpm": 900}}, ["crank.file='a'", "crank.rpm=800"], lambda: optional)
    assert both == {"crank": {"rpm": 800, "file": "a"}}  # refused by the car, as given twice


def test_an_override_of_another_table_with_the_same_key_is_no_second_value():
    def table():
        return {"force": {"b": {"harmonics": [[1, 2, 3]]}, "a": {"harmonics": [[1, 2, 3]]}}}

    found = override(table(), ["force.b.harmonics=[[1, 5, 0]]", "force.a.file='f.csv'"], lambda: ["force.a.file"])
    assert found["force"] == {"b": {"harmonics": [[1, 5, 0]]}, "a": {"file": "f.csv"}}
    tables = {"spring": {"stiffness": 2.0}, "tyre": {"stiffness": [1.0, 1.0, 1.0]}}
    optional = ["spring.curve", "tyre.curve"]
    found = override(tables, ["tyre.stiffness.z=2e5", "spring.curve='F'"], lambda: optional)
    assert found == {"spring": {"curve": "F"}, "tyre": {"stiffness": [1.0, 1.0, 2e5]}}
    found = override(tables, ["tyre.stiffness.z=2e5", "tyre.curve='F'"], lambda: optional)
    assert found["tyre"] == {"stiffness": [1.0, 1.0, 2e5], "curve": "F"}  # refused by the car


def test_a_speed_that_is_no_number_does_not_agree_with_the_one_before():
    assert require_speed_once(["driving.speed=20"], 20.0)
    with pytest.raises(ConfigurationError, match=r"driving\.speed=fast: .* 72 km/h of --speed, 20 m/s"):
        require_speed_once(["driving.speed=20", "driving.speed=fast"], 20.0)


def test_values_arrive_where_their_paths_say(car):
    values = {
        "damper.viscous": 2100.0,
        "bushings.suspension_mount.stiffness.z": 6.9e5,
        "bushings.suspension_mount.stiffness.x": 2.9e6,
        "body.mass": 800.0,
    }
    texts = overrides_of(car.vehicle, values)
    changed = Car.load(overrides=texts).vehicle
    assert {path: value_of(changed, path) for path in values} == values
    # The third component is not a parameter and stays.
    there = "front.bushings.suspension_mount.stiffness.y"
    assert value_of(changed, there) == value_of(car.vehicle, there)
    assert overrides_of(car.vehicle, {}) == ()


@pytest.mark.parametrize("path", [
    "bushings.suspension_mount.stifness.z", "bushings.suspension_mount.stiffness",
    "bushings.suspension_mount.stiffness.w", "damper.friction_law", "damper", "body.flexible", "w",
])  # fmt: skip
def test_a_path_that_is_no_number_is_refused_with_the_nearest(car, path):
    for use in (lambda: overrides_of(car.vehicle, {path: 1.0}), lambda: value_of(car.vehicle, path)):
        with pytest.raises(ConfigurationError, match=f"parameter {path}: .*; did you mean "):
            use()


def test_the_nearest_path_has_its_axis(car):
    for misspelt in ("bushings.suspension_mount.stifness.z", "suspension_mount.stifness.z"):
        with pytest.raises(ConfigurationError, match=r"did you mean front\.bushings\.suspension_mount\.stiffness\.z"):
            value_of(car.vehicle, misspelt)


def test_the_end_of_a_path_is_enough_where_it_can_mean_one_thing_only(car):
    changed = load_vehicle(None, ["coulomb_friction=80", "suspension_mount.stiffness.z=5e5", "hydromount.damping.x=7"])
    whole = [
        "damper.coulomb_friction=80",
        "bushings.suspension_mount.stiffness.z=5e5",
        "bushings.hydromount.damping.x=7",
    ]
    assert changed == load_vehicle(None, whole) != car.vehicle
    assert value_of(changed, "coulomb_friction") == 80.0
    # A whole path wins over the end of another one: the point, not a group of bushings.
    assert full_path(as_table(car.vehicle), "damper") == "front.damper"
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, ["torsional_stifness=1"])
    assert str(caught.value) == (
        "--set torsional_stifness=1: unknown parameter torsional_stifness; did you mean "
        "front.stabilizer.torsional_stiffness?"
    )
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, ["maxwell_stiffness=1", "mass=1"])
    assert str(caught.value) == (
        "--set mass=1: parameter mass is ambiguous: it may be body.mass, engine.parts.engine.mass, "
        "engine.parts.torque_arm.mass, front.parts.a_arm.mass or one of 12 others; write more of its path"
    )
    with pytest.raises(ConfigurationError, match=r"parameter stiffness\.z: is not a number of the vehicle; .* may"):
        value_of(car.vehicle, "stiffness.z")


def test_optional_keys_are_given_where_the_law_has_them():
    table = ["displacement=[-0.05, -0.02, 0.05]", "force=[-900.0, 0.0, 0.0]"]
    laws = {
        "damper.gas_force=200": lambda own: own.dampers[0].law.gas_force == 200.0,
        "front.damper.stop={" + ", ".join(table) + "}": lambda own: own.dampers[0].law.stop.force[0] == -900.0,
        "main_spring.table={" + ", ".join(table) + "}": lambda own: own.springs[0].table.force[0] == -900.0,
        "*.damper.viscous=1999": lambda own: own.dampers[0].law.viscous == 1999.0,
        "front.right.damper.viscous=1999": lambda own: [one.law.viscous for one in own.dampers] == [1999.0, 2250.0],
    }
    for text, holds in laws.items():
        assert holds(load_vehicle(None, [text]).composition), text
    branch = ["linear_mount.maxwell_stiffness=1e5", "linear_mount.maxwell_damping=1e3"]
    mount = next(one.law for one in load_vehicle(None, branch).composition.connections if one.name == "linear_mount")
    assert isinstance(mount, Hydromount) and mount.maxwell_damping == 1e3
    ideal = [f"front.bushings.arm_front.{key}" for key in ("stiffness=[1e6, 1e6, 1e6]", "damping=[9, 9, 9]")]
    links = load_vehicle(None, [*ideal, "arm_front.rotational_stiffness=1"]).composition.connections
    arm = next(one.law for one in links if one.name == "arm_front_fl")
    assert arm is not None and arm.damping == (9.0, 9.0, 9.0)
    for text, near in (("gas_forse=1", "damper.gas_force"), ("*.stopp=1", "damper.stop"), ("w.tabel_x=1", "table_x")):
        with pytest.raises(ConfigurationError, match=rf"^--set {re.escape(text)}: unknown .* did you mean .*{near}\?$"):
            load_vehicle(None, [text])
    with pytest.raises(ConfigurationError, match="parameter table_x is ambiguous: it may be"):
        load_vehicle(None, ["table_x=1"])


def test_units_are_those_of_the_fields(car):
    units = {
        "damper.viscous": "N s/m", "bushings.tyre.stiffness": "N/m", "bushings.tyre.stiffness.z": "N/m",
        "parts.engine.mass": "kg", "hardpoints.strut_top.x": "m",
    }  # fmt: skip
    assert {path: unit_of(car.vehicle, path) for path in units} == units
    for path in ("damper", "body.flexible", "front.template", "outputs.seat.on"):
        with pytest.raises(ConfigurationError, match=f"parameter {path}: is not a value of a vehicle"):
            unit_of(car.vehicle, path)


def test_logarithmic_scale():
    parameter = Range(path="a", low=1.0, high=4.0, start=2.0)
    assert parameter.value(0.0) == 2.0
    assert parameter.value(parameter.half_width) == pytest.approx(4.0)
    assert parameter.value(-parameter.half_width) == pytest.approx(1.0)


def test_what_a_path_begins_is_nearer_than_what_is_spelt_alike(car):
    with pytest.raises(ConfigurationError, match=r"did you mean front\.damper\.coulomb_friction\?$"):
        full_path(car.vehicle.table, "front.damper.coulom")


def test_a_damper_with_a_table_has_no_constant_and_the_message_says_how_to_get_one():
    sedan = Car.load("sedan")
    with pytest.raises(ConfigurationError, match=r"front\.damper\.viscous_law = table has none; to add it, set --set"):
        full_path(as_table(sedan.vehicle), "front.damper.viscous")
    with pytest.raises(ConfigurationError, match=r"did you mean front\.damper\.friction_law\?$"):
        full_path(as_table(sedan.vehicle), "front.damper.friction")


def test_overrides_as_a_mapping_and_a_single_text():
    given = {"a.b": 1.5, "c": True, "d": (1, 2.0, 3), "e": "stribeck", "f": np.float64(2.0), "g": {"x": [1, 2]}}
    assert assignments(given) == [
        "a.b=1.5", "c=true", "d=[1, 2.0, 3]", 'e="stribeck"', "f=2.0", "g={x = [1, 2]}"
    ]  # fmt: skip
    assert assignments(["a=1"]) == ["a=1"]
    with pytest.raises(ConfigurationError, match=r"overrides: .*'a=1' .*\['a=1'\]"):
        assignments("a=1")
    with pytest.raises(ConfigurationError, match="a is a object; must be a number"):
        assignments({"a": object()})


@pytest.mark.parametrize("text", ['C:\\cars\\"new".csv', "two\nlines", "Prüfstand"])
def test_a_text_keeps_its_quotes_and_line_breaks(text):
    """They were refused in a mapping, as the path of a file on Windows."""
    (assignment,) = assignments({"file": text})
    assert tomllib.loads(assignment) == {"file": text}
