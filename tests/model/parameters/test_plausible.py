"""Item 56: cars that no engineer could mean are refused by parameter, value, range and reason, before any engine."""

import re
from pathlib import Path

import pytest

from tests.model.parameters.test_bad_parameters import INSTANCE
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car

ABSURD = {
    "wheel centre below the plate": (
        "hardpoints.wheel_center.z=0.3",
        "hardpoints.wheel_center.z less hardpoints.tyre_patch.z: found -0.1 m, must be 0.15 to 0.7 m",
    ),
    "patch above the wheel centre": (
        "hardpoints.tyre_patch.z=0.8",
        "hardpoints.wheel_center.z less hardpoints.tyre_patch.z: found -0.105 m, must be ",
    ),
    "patch beside the wheel": (
        "hardpoints.tyre_patch.x=1.5",
        "hardpoints.tyre_patch.x less hardpoints.wheel_center.x: found 0.65 m, must be -0.2 to 0.2 m",
    ),
    "a point below the plate": (
        "hardpoints.lower_ball.z=0.3",
        ("hardpoints.lower_ball.z: found 0.3 m, must be at least 0.4 m, the height of the plate"),
    ),
    "rear support without stiffness": (
        "bushings.rear_support.stiffness.z=0",
        "bushings.rear_support.stiffness.z: found 0 N/m, must be at least 5000 N/m",
    ),
    "strut mount without stiffness": (
        "bushings.suspension_mount.stiffness.z=0",
        "bushings.suspension_mount.stiffness.z: found 0 N/m, must be at least 10000 N/m",
    ),
    "tyre without stiffness": (
        "bushings.tyre.stiffness=[0, 0, 0]",
        "bushings.tyre.stiffness.x: found 0 N/m, must be at least 10000 N/m",
    ),
    "mount of ten tonnes": (
        "parts.suspension_mount.mass=1e4",
        "parts.suspension_mount.mass: found 10000 kg, must be 0.02 to 150 kg",
    ),
    "knuckle of a microgram": ("parts.knuckle.mass=1e-9", "parts.knuckle.mass: found 1e-09 kg, must be 0.02 to 150 kg"),
    "engine in grams": ("parts.engine.mass=220000", "parts.engine.mass: found 220000 kg, must be 20 to 1000 kg"),
    "engine inertia in kg cm2": (
        "parts.engine.inertia=[151700, 68800, 151700]",
        "parts.engine.inertia.x: found 151700 kg m2, must be 0.00022 to 220 kg m2",
    ),
    "offset in mm": ("parts.caliper.offset.x=120", "parts.caliper.offset.x: found 120 m, must be -1 to 1 m ("),
    "body of 16 kg": ("body.mass=16", "body.mass: found 16.0 kg, must be at least 100.0"),
    "body of 100 tonnes": ("body.mass=100000", "body.mass: found 100000.0 kg, must be at most 5000.0"),
    "centre of gravity in mm": ("body.cog=[2157, 0, 1011]", "body.cog.x: found 2157 m, must be 0.45 to 3.9 m"),
    "height of it in mm": ("body.cog.z=1011", "body.cog.z: found 1011 m, must be 0.4 to 1.85 m ("),
    "inertia without its thousands": (
        "body.inertia.iyy=5.268",
        "body.inertia.iyy: found 5.268 kg m2, must be 32.52 to 17621.6 kg m2",
    ),
    "gravity of 500": ("gravity=500", "gravity: found 500.0 m/s2, must be at most 30.0 (9.81 on Earth; "),
    "stiffness of 1e12": (
        "bushings.tyre.stiffness.z=1e12",
        "bushings.tyre.stiffness: found 1000000000000.0 N/m, must be at most 10000000000.0",
    ),
    "a law that is off": (
        "damper.stribeck_velocity=1e300",
        "damper.stribeck_velocity: found 1e+300 m/s, must be at most 10.0",
    ),
    "body modes at 20 kHz": ("body.frequency_scale=1000", "body.frequency_scale: found 1000.0, must be at most 20.0"),
}


@pytest.mark.parametrize("case", ABSURD)
def test_absurd_values_are_refused_when_the_car_is_read(case):
    assignment, expected = ABSURD[case]
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, [assignment])
    said = INSTANCE.sub("", str(caught.value)).removeprefix("Head.")
    assert said.startswith(expected), said


IMPOSSIBLE = {
    "first mode at 3 Hz": (
        ["body.frequency_scale=0.16"],
        r"body\.frequency_scale: found 0\.16, .* \(19\S* Hz .*body_design\.toml\) at 3\.04 Hz, .*must be at least 5 Hz",
    ),
    "first mode at 0.001 Hz": (
        ["body.frequency_scale=5e-5"],
        r"body\.frequency_scale: .* at 0\.00095 Hz, but it must be at least 5 Hz",
    ),
    "springs too soft to carry": (
        ["main_spring.stiffness=1000"],
        r"main_spring\.stiffness: .*\(body\.mass 813 kg, gravity 9\.81 m/s2\).* 1\.6\d m, but at most 0\.5 m",
    ),
    "engine on threads": (
        [
            "bushings.linear_mount.stiffness=[1, 1, 1]",
            "bushings.hydromount.stiffness=[1, 1, 1]",
            "bushings.hydromount.maxwell_stiffness=0",
        ],
        r"bushings\.hydromount\.stiffness\.x: ",
    ),
    "a car that tips forward": (
        # Rigid: no masses at the nodes of the design have this centre of gravity and inertia.
        [
            *("body.cog.x=0.8", "body.inertia.ixx=1200", "body.inertia.iyy=3000", "body.inertia.izx=700"),
            *("body.inertia.izz=2000", "body.inertia.ixy=82.03"),
            "body.flexible=false",
        ],
        r"body\.cog: found \[0\.8, 0\.0, 1\.011\] m\. .*rear support right would carry -\d+ N",
    ),
    "inertia with a turned sign": (
        ["body.inertia.izx=-1800"],
        r"body\.inertia: ixx 1000, .*izx -1800, .* the origin: with body\.mass \(813 kg\) .* -3097, 656\.7 and 4081 "
        r"kg m2.*\(-2440 >= 4081\?\).* 3\.26e\+03 kg m2 but must differ by at most 81\.6 \(2%",
    ),
    "inertia of 1e30": (["body.inertia.izx=1e30"], r"body\.inertia: ixx 1000, .*differs by 1e\+30 kg m2"),
    "mass against inertia": (
        ["body.mass=3000", *(f"body.inertia.{key}" for key in ("ixx=1000", "iyy=5268", "izz=4600", "izx=1800"))],
        r"body\.inertia: ixx 1000, .*with body\.mass \(3000 kg\).*",
    ),
}


@pytest.mark.parametrize("case", IMPOSSIBLE)
def test_impossible_cars_are_refused_when_they_are_built(case):
    settings, expected = IMPOSSIBLE[case]
    with pytest.raises(ConfigurationError) as caught:
        _ = Car.load(None, settings).model
    assert re.match(expected, INSTANCE.sub("", str(caught.value))), str(caught.value)


ROAD_VEHICLES = {
    "a light body": [*("body.mass=300", "body.inertia.ixx=443", "main_spring.stiffness=12000")],
    "a heavy one": [*("body.mass=1600", "main_spring.stiffness=60000")],
    "on the moon": ["gravity=1.62"],
    "weightless": ["gravity=0"],
    "no stabilizer": ["stabilizer.torsional_stiffness=0"],
    "soft tyres and air springs": ["bushings.tyre.stiffness.z=1e5", "bushings.rear_support.stiffness.z=2e4"],
    "a soft convertible": ["body.frequency_scale=0.63"],
    "no friction": ["damper.coulomb_friction=0"],
}


@pytest.mark.parametrize("name", ROAD_VEHICLES)
def test_road_vehicles_are_accepted_in_both_engines(name, high_piece):
    car = Car.load(None, ROAD_VEHICLES[name])
    for engine in ("reduced", "mujoco"):
        assert car.run(high_piece, engine=engine).comfort().unweighted.overall > 0.1


def test_parameters_without_effect_are_said():
    changes = ["damper.stribeck_velocity=0.05", "damper.viscous=2000", "body.frequency_scale=1.1"]
    assert idle_parameters(load_vehicle(None, changes), changes) == (
        "damper.stribeck_velocity=0.05: has no effect; it acts only with front.damper.friction_law = stribeck",
    )
    changes = ["front.damper.viscous=2000"]
    assert idle_parameters(load_vehicle(Path("sedan"), changes), changes) == (
        "front.damper.viscous=2000: has no effect; it acts only with front.damper.viscous_law = linear or degressive",
    )
    # Attachments of a rigid body give way too.
    changes = ["body.flexible=false", "body.frequency_scale=1.1", "body.attachment_flexibility=false"]
    assert idle_parameters(load_vehicle(None, changes), changes) == (
        "body.frequency_scale=1.1: has no effect; it acts only with body.flexible = true",
    )
    changes = ["damper.friction_law=stribeck", "damper.coulomb_friction=65", "damper.stribeck_velocity=0.05"]
    assert idle_parameters(load_vehicle(None, changes), changes) == ()


CAB = """mirrored = false
joint = [{ kind = "free", child = ["cab"] }]
connection = [
  { name = "cab_fl", moving = "cab", carrier = "body", at = "fl" },
  { name = "cab_fr", moving = "cab", carrier = "body", at = "fr" },
  { name = "cab_rear", moving = "cab", carrier = "body", at = "rear" },
]
[hardpoints]
cog = "centre of gravity of the cab"
fl = "mount"
fr = "mount"
rear = "mount"
[parts]
cab = { shape = "none", points = ["cog"] }
"""
TRUCK = """base = "sedan"
name = "truck"
[cab]
template = "cab"
hardpoints = { cog = [1.6, 0.0, 1.1], fl = [1.0, -0.6, 0.9], fr = [1.0, 0.6, 0.9], rear = [2.4, 0.0, 0.9] }
parts.cab = { mass = 600.0, inertia = [180, 190, 150] }
"""


def test_mass_limits_belong_to_the_place_of_a_part(tmp_path):
    """A cab of 600 kg was refused, since it is not drawn as an engine; a hub of 600 kg stays refused."""
    (tmp_path / "cab.toml").write_text(CAB)
    mount = "stiffness = [4e5, 4e5, 6e4], damping = [2e3, 2e3, 2e3], rotational_stiffness = 100"
    mounts = "".join(f"bushings.cab_{name} = {{ {mount} }}\n" for name in ("fl", "fr", "rear"))
    file = tmp_path / "truck.toml"
    file.write_text(TRUCK + mounts)
    car = load_vehicle(file)
    assert next(part for part in car.composition.parts if part.name == "cab").numbers.mass == 600.0
    for path, limit in (("front.parts.knuckle", "150"), ("engine.parts.engine", "1000"), ("cab.parts.cab", "5000")):
        with pytest.raises(ConfigurationError, match=rf"{path}\.mass: found 6000 kg, must be 0?\.?\d+ to {limit} kg"):
            load_vehicle(file, [f"{path}.mass=6000"])


def test_a_guide_on_the_world_is_no_support(tmp_path):
    """Without vertical stiffness it carries nothing, and was refused as a car that would tip over."""
    guide = "moving = 'body'\ncarrier = 'world'\nat = [2.0, 0.0, 0.8]\ndamping = [1e3, 1e3, 0.0]\n"
    guide += "stiffness = [1e5, 1e5, 0.0]\nrotational_stiffness = 0.0\n"
    file = tmp_path / "guided.toml"
    loads = []
    for ground in ("", "ground = true\n"):
        file.write_text(f'base = "sedan"\nname = "guided"\n[connection.guide]\n{guide}{ground}')
        static = Car.load(file).static
        assert static.support_load == {}
        loads.append(static.tyre_load)
    assert loads[0] == pytest.approx(Car.load("sedan").static.tyre_load, rel=1e-3) and loads[1] == loads[0]
