"""Items 20 to 32 of the bad inputs: refused before any model is written, by path, value and what is allowed."""

import re

import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.force_elements import FRICTION_LAWS
from vehicle.model.parameters.vehicle import load_vehicle

INSTANCE = re.compile(r"(?<![\w.])(front|engine|rear)\.(?!toml)")
"""Where the templates of the car are in its file."""

CASES = {
    "20 NaN stiffness": ("main_spring.stiffness=nan", "main_spring.stiffness: found nan N/m, must be a finite number"),
    "20 NaN in a vector": ("bushings.tyre.stiffness=[1e5, nan, 1e5]", "bushings.tyre.stiffness: found nan N/m"),
    "20 infinite stiffness": ("stabilizer.torsional_stiffness=inf", "stabilizer.torsional_stiffness: found inf N"),
    "21 negative stiffness": (
        "bushings.arm_rear.stiffness=[2.5e5, -8e5, 8e5]",
        "bushings.arm_rear.stiffness: found -800000.0 N/m, must be at least 0.0",
    ),
    "22 negative damping": (
        "bushings.rear_support.damping=[100.0, 500.0, -1.0]",
        "bushings.rear_support.damping: found -1.0 N s/m, must be at least 0.0",
    ),
    "22 negative viscous damping": (
        "damper.viscous=-2250",
        "damper.viscous: found -2250.0 N s/m, must be at least 0.0",
    ),
    "22 negative friction": (
        "damper.coulomb_friction=-0.1",
        "damper.coulomb_friction: found -0.1 N, must be at least 0.0",
    ),
    "24 zero mass": ("parts.tyre.mass=0", "parts.tyre.mass: found 0.0 kg, must be greater than 0.0"),
    "24 negative mass": ("body.mass=-813", "body.mass: found -813.0 kg, must be greater than 0.0"),
    "24 negative inertia": (
        "parts.knuckle.inertia=[0.01, 0.02, -0.03]",
        "parts.knuckle.inertia: found -0.03 kg m2, must be greater than 0.0",
    ),
    "24 triangle inequality": (
        "parts.engine.inertia=[5.0, 5.0, 15.0]",
        "parts.engine.inertia: found [5.0, 5.0, 15.0] kg m2",
    ),
    "25 zero step": ("solver.timestep=0", "solver.timestep: found 0.0 s, must be at least 1e-06"),
    "25 negative step": ("solver.timestep=-1e-3", "solver.timestep: found -0.001 s, must be at least 1e-06"),
    "25 step of a second": ("solver.timestep=1", "solver.timestep: found 1.0 s, must be at most 0.005"),
    "26 coincident points": (
        "hardpoints.tie_inner=[0.985, 0.6900001, 0.648]",
        "hardpoints.tie_outer, hardpoints.tie_inner: coincide (distance 1e-07 m)",
    ),
    "26 left side given": (
        "hardpoints.wheel_center=[0.85, -0.747, 0.695]",
        "hardpoints.wheel_center: found y = -0.747 m, must be above 0: give the points of the right side, "
        "the left side is mirrored",
    ),
    "26 strut top below the ball joint": (
        "hardpoints.strut_top=[0.877, 0.548, 0.55]",
        "hardpoints.strut_top: found z = 0.55 m, must be above 0.595 m, the z of hardpoints.lower_ball",
    ),
    "26 spring seat above the strut top": (
        "hardpoints.spring_lower=[0.8625, 0.6015, 1.3]",
        "hardpoints.strut_top: found z = 1.23 m, must be above 1.3 m, the z of hardpoints.spring_lower",
    ),
    "26 arm on one line": (
        "hardpoints.arm_rear=[0.839, 0.03, 0.615]",
        "hardpoints.lower_ball, hardpoints.arm_front, hardpoints.arm_rear: lie",
    ),
    "26 millimetres": (
        "hardpoints.strut_top=[877.0, 548.0, 1230.0]",
        "hardpoints.strut_top: found [877.0, 548.0, 1230.0] m, must be within 20.0 m",
    ),
    "28 Stribeck velocity zero": (
        "damper.stribeck_velocity=0",
        "damper.stribeck_velocity: found 0.0 m/s, must be greater than 0.0",
    ),
    "28 Stribeck exponent": (
        "damper.stribeck_exponent=-1",
        "damper.stribeck_exponent: found -1.0, must be greater than 0.0",
    ),
    "29 negative branch": (
        "bushings.hydromount.maxwell_damping=-1",
        "bushings.hydromount.maxwell_damping: found -1.0 N s/m, must be at least 0.0",
    ),
    "31 text for a number": ('damper.viscous="2250"', "damper.viscous: must be a number, not '2250'"),
    "31 truth value": ("damper.viscous=true", "damper.viscous: must be a number, not True"),
    "31 truth value in a vector": ("body.cog=[2.157, true, 1.011]", "body.cog: must be a number, not True"),
    "31 two components": (
        "bushings.tyre.stiffness=[1e5, 1e5]",
        "bushings.tyre.stiffness: must be a list of 3 numbers [N/m], not (100000.0, 100000.0)",
    ),
    "31 number for a vector": ("body.cog=2.157", "--set body.cog=2.157: body.cog is a vector"),
    "31 overflow": ("main_spring.stiffness=1e400", "main_spring.stiffness: found inf N/m, must be a finite number"),
    "31 number for a switch": ("body.flexible=1", "body.flexible: must be true or false, not 1"),
    "31 number for a text": ("name=3", "name: must be a text in quotes, not 3"),
    "31 unknown word": (
        "damper.friction_law=viscous",
        f"damper.friction_law: must be one of {', '.join(FRICTION_LAWS)}, not 'viscous'",
    ),
    "32 XML in a name": ('name="a\\"/><b"', "name: must be a name of letters, digits, '_', '.', '-', not 'a\"/><b'"),
    "32 newline in a name": ('name="a\\nb"', "name: must be a name of letters, digits, '_', '.', '-', not 'a\\nb'"),
    "32 quote in a file name": ('body.superelement="it\'s"', "body.superelement: "),
}


@pytest.mark.parametrize("case", CASES)
def test_bad_values(case):
    assignment, expected = CASES[case]
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, [assignment])
    # Of the head of the file the class names itself; elsewhere an instance stands before the path.
    assert INSTANCE.sub("", str(caught.value)).removeprefix("Head.").startswith(expected)


def test_item_28_static_friction_below_sliding():
    # Only with the Stribeck law, where it means something.
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, ["damper.friction_law=stribeck", "damper.stribeck_friction=60"])
    assert INSTANCE.sub("", str(caught.value)) == (
        "damper.stribeck_friction: found 60.0 N, must be at least coulomb_friction (125.0 N)"
    )
    load_vehicle(None, ["damper.stribeck_friction=60"])


def test_a_degressive_damper_is_steeper_below_its_velocity():
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(None, ["damper.viscous_law=degressive", "damper.degressive_viscous=2000"])
    assert INSTANCE.sub("", str(caught.value)) == (
        "damper.degressive_viscous: found 2000.0 N s/m, must be at least viscous (2250.0 N s/m)"
    )
    load_vehicle(None, ["damper.degressive_viscous=2000"])
    with pytest.raises(ConfigurationError, match=r"damper\.degressive_velocity: found 0\.0 m/s, must be greater than"):
        load_vehicle(None, ["damper.degressive_velocity=0"])


def test_missing_and_binary_files(tmp_path):
    with pytest.raises(ConfigurationError, match=r"none\.toml: the file does not exist"):
        load_vehicle(tmp_path / "none.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigurationError, match=r"binary\.toml: is not UTF-8 text at byte 0"):
        load_vehicle(tmp_path / "binary.toml")
