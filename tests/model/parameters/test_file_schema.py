"""JSON Schema of vehicle files and templates against jsonschema: shipped files pass, slips of the pen do not."""

import json
import tomllib
from typing import Any

import pytest

from vehicle.__main__ import main
from vehicle.model.parameters.file_schema import template_schema, vehicle_schema
from vehicle.model.parameters.shipped import CARS, FOCUS_FILE, VEHICLES
from vehicle.model.parameters.template import SHIPPED

jsonschema = pytest.importorskip("jsonschema")
TEMPLATES = sorted(file.stem for file in SHIPPED.glob("*.toml"))


@pytest.fixture(scope="module")
def vehicles() -> Any:
    jsonschema.Draft7Validator.check_schema(vehicle_schema())
    return jsonschema.Draft7Validator(vehicle_schema())


@pytest.fixture(scope="module")
def templates() -> Any:
    jsonschema.Draft7Validator.check_schema(template_schema())
    return jsonschema.Draft7Validator(template_schema())


@pytest.mark.parametrize("name", CARS)
def test_a_shipped_car_is_valid(name, vehicles):
    vehicles.validate(tomllib.loads((VEHICLES / name / "vehicle.toml").read_text(encoding="utf-8")))


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_shipped_template_is_valid(name, templates):
    templates.validate(tomllib.loads((SHIPPED / f"{name}.toml").read_text(encoding="utf-8")))


VALID = (
    "driving.speed=20",
    "front.left.bushings.arm_rear.stiffness=[5e5,5e5,5e5]",
    "front.damper.control={law='skyhook', minimum_damping=500, maximum_damping=4000, skyhook_damping=2500, "
    "groundhook_damping=0, skyhook_share=0.5, control_period=0.001}",
    "front.damper.control={law='fmu', fmu='my controllers/skyhook.fmu', minimum_damping=500, maximum_damping=4000, "
    "skyhook_damping=0, groundhook_damping=0, skyhook_share=0.5, control_period=0.001}",
    "front.damper.stop={curve='stop.csv'}",
    "rear.bushings.rear_support={stiffness=[1e5,1e5,1e5], damping=[0,0,0], rotational_stiffness=0, "
    "maxwell_stiffness=1e5, maxwell_damping=1e3}",
    "load.trunk={mass=80, at=[3.6, 0, 0.7]}",
    "connection.brace={moving='engine', carrier='body', at='seat'}",
    "body.modes.3.damping_ratio=0.02",
    "rear.template=my_axle",
    "seat.driver={template='seat_occupant', hardpoints={rail='seat_rail'}, parts={seat={mass=6.4}, "
    "occupant={mass=50}}}",
)

WRONG = {
    "gravitation=9.81": "9.81 is not of type 'object'", "body.masss=800": "'masss' was unexpected",
    "body.mass=heavy": "'heavy' is not of type 'number'", "body.mass=50": "50 is less than the minimum of 100.0",
    "body.flexible=1": "1 is not of type 'boolean'", "body.cog=[2.1, 0.0]": r"\[2.1, 0.0\] is too short",
    "driving.speed=-1": "-1 is less than the minimum of 0.0",
    "solver.timestep=1": "1 is greater than the maximum of 0.005",
    "front.hardpoints.strut_topp=[0.9, 0.5, 1.2]": "'strut_topp' was unexpected",
    "front.hardpoints.strut_top=[877, 548, 1230]": "is not valid under any of the given schemas",
    "front.parts.knuckle.mass=0": "0 is less than or equal to the minimum of 0.0",
    "front.bushings.arm_rear.stiffness=[2e5, 8e5, 100.0]": "100.0 is less than the minimum of 10000.0",
    "front.bushings.arm_rear.slip_stiffness=5e4": "'slip_stiffness' was unexpected",
    "front.damper.friction_law=dry": r"'dry' is not one of \['coulomb', 'stribeck', ",
    "front.damper.control={law='sky'}": "'sky' is not one of",
    "front.stabiliser.torsional_stiffness=900": "'template' is a required property",
    "front.left.bushings.arm_rear.damping=[1.0]": r"\[1.0\] is too short",
    "outputs.head={on='body'}": "'at' is a required property",
    "load.trunk={mass=-80, at=[3.6, 0, 0.7]}": "-80 is less than the minimum of 0.0",
    "shaker_wheel=xx": "'xx' is not one of",
}  # fmt: skip


def focus(text: str = "") -> dict[str, Any]:
    """Return the vehicle file of the focus car with another value; a value that is not TOML is a text."""
    path, _, value = text.partition("=")
    table = inner = tomllib.loads(FOCUS_FILE.read_text(encoding="utf-8"))
    *parents, name = path.split(".")
    for key in parents:
        inner = inner.setdefault(key, {})
    if text:
        try:
            inner[name] = tomllib.loads(f"value = {value}")["value"]
        except tomllib.TOMLDecodeError:
            inner[name] = value
    return table


@pytest.mark.parametrize("text", VALID)
def test_what_a_file_may_give_is_valid(text, vehicles):
    vehicles.validate(focus(text))


@pytest.mark.parametrize("text", WRONG)
def test_a_wrong_name_type_or_value_is_rejected(text, vehicles):
    with pytest.raises(jsonschema.ValidationError, match=WRONG[text]):
        vehicles.validate(focus(text))


@pytest.mark.parametrize("path", ["name", "body.mass", "front.hardpoints.strut_top", "front.parts.knuckle.mass",
                                  "front.damper.viscous"])  # fmt: skip
def test_a_missing_parameter_is_rejected(path, vehicles):
    table = inner = focus()
    *parents, name = path.split(".")
    for key in parents:
        inner = inner[key]
    del inner[name]
    with pytest.raises(jsonschema.ValidationError, match=f"'{name}' is a required property"):
        vehicles.validate(table)


def test_a_file_over_a_base_gives_what_differs_alone(vehicles):
    vehicles.validate({"base": "focus", "body": {"mass": 900.0}, "front": {"damper": {"viscous": 1500.0}}})
    with pytest.raises(jsonschema.ValidationError, match="50 is less than the minimum"):
        vehicles.validate({"base": "focus", "body": {"mass": 50}})


@pytest.mark.parametrize(
    "change",
    [{"mirored": True}, {"mirrored": "yes"}, {"joint": [{"kind": "loose", "child": "a"}]}, {"above": [["a"]]},
     {"parts": {"a": {"shape": "rod"}}}, {"use": [{"prefix": "a"}]}],
)  # fmt: skip
def test_a_wrong_template_is_rejected(change, templates):
    table = tomllib.loads((SHIPPED / "macpherson.toml").read_text(encoding="utf-8"))
    with pytest.raises(jsonschema.ValidationError):
        templates.validate({**table, **change})


def test_the_schema_has_unit_meaning_and_range_of_a_parameter(vehicles):
    mass = vehicles.schema["definitions"]["vehicle"]["properties"]["body"]["properties"]["mass"]
    assert mass["description"].startswith(
        "[kg] mass of the trimmed body (with seats and interior) (without engine and axles"
    )
    assert (mass["exclusiveMinimum"], mass["minimum"], mass["maximum"]) == (0.0, 100.0, 5000.0)


def test_the_command_prints_the_schema(capsys, vehicles, templates):
    for arguments, validator in ((["--schema"], vehicles), (["--schema", "template"], templates)):
        assert main(arguments) == 0
        assert json.loads(capsys.readouterr().out) == json.loads(json.dumps(validator.schema))
    assert main(["--schema", "car"]) == 2
    assert capsys.readouterr().err == "error: --schema car: must be one of vehicle, template\n"
