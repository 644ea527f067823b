"""Parameters of the half-car studies: shipped files, refusals by name."""

import dataclasses
import re
import tomllib

import pytest

from scenarios.lumped.damper_choice import (
    FITTED,
    DamperChoiceParameters,
    FrequencyBands,
    damper_choice_parameters,
)
from scenarios.lumped.half_car_rider_parameters import (
    PUBLISHED,
    HalfCarRiderParameters,
    half_car_rider_parameters,
)
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import override
from vehicle.model.parameters.toml_file import build, read_table

FILES = [(PUBLISHED, HalfCarRiderParameters), (FITTED, DamperChoiceParameters)]


@pytest.mark.parametrize(("path", "cls"), FILES)
def test_every_value_carries_unit_and_source(path, cls):
    for line in path.read_text(encoding="utf-8").splitlines():
        if "=" in line.partition("#")[0]:
            assert re.search(r"# \[[^]]+\] \S+", line), line


def test_source_values():
    car = half_car_rider_parameters()
    assert (car.body.mass, car.body.pitch_inertia) == (575.0, 769.0)
    assert (car.body.front_arm, car.body.rear_arm, car.body.seat_arm) == (1.35, 1.45, 0.65)
    assert dataclasses.astuple(car.front) == dataclasses.astuple(car.rear) == (60.0, 16812.0, 1000.0, 190000.0, 350.0)
    assert dataclasses.astuple(car.lower_limb) == (5.5, 144000.0, 909.0)
    assert dataclasses.astuple(car.upper_limb) == (36.0, 20000.0, 330.0)
    assert (car.bump.height, car.bump.length) == (0.05, 0.5)


def test_assumed_values_say_so():
    text = PUBLISHED.read_text(encoding="utf-8")
    for section in ("seat", "semi_active"):
        block = text.split(f"[{section}]")[1].split("\n[")[0].strip().splitlines()
        assert all("assumed: not printed" in line for line in block)


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("body.mass=0.0", "body.mass: found 0.0 kg, must be greater than 0.0"),
        ("body.pitch_inertia=-1.0", "body.pitch_inertia: found -1.0 kg m2, must be greater than 0.0"),
        ("front.suspension_damping=-1.0", "front.suspension_damping: found -1.0 N s/m, must be at least 0.0"),
        ("rear.tyre_stiffness=0.0", "rear.tyre_stiffness: found 0.0 N/m, must be greater than 0.0"),
        (
            "seat.stiffness=nan",
            "seat.stiffness: found nan N/m, must be a finite number (stiffness of its support)",
        ),
        ("bump.length=0.0", "bump.length: found 0.0 m, must be greater than 0.0"),
        ("semi_active.skyhook_share=1.5", "semi_active.skyhook_share: found 1.5, must be at most 1.0"),
        ("semi_active.control_period=0.0", "semi_active.control_period: found 0.0 s, must be greater than 0.0"),
        (
            "semi_active.maximum_damping=200.0",
            "semi_active.maximum_damping: found 200.0 N s/m, must be at least minimum_damping 300.0 N s/m",
        ),
        ("upper_limb.mass=true", "upper_limb.mass: must be a number, not True"),
    ],
)
def test_bad_rider_parameters_are_refused_by_name(assignment, message):
    with pytest.raises(ConfigurationError) as caught:
        build(HalfCarRiderParameters, override(read_table(PUBLISHED), [assignment]))
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("quarter_car.sprung_mass=-1.0", "quarter_car.sprung_mass: found -1.0 kg, must be greater than 0.0"),
        ("half_car.front.unsprung_mass=0.0", "half_car.front.unsprung_mass: found 0.0 kg, must be greater than 0.0"),
        ("highway.decay=0.0", "highway.decay: found 0.0 s, must be greater than 0.0"),
        ("bands.highest=0.5", "bands.highest: found 0.5 Hz, must be at least one band of 1.0 Hz"),
    ],
)
def test_bad_damper_parameters_are_refused_by_name(assignment, message):
    with pytest.raises(ConfigurationError) as caught:
        build(DamperChoiceParameters, override(read_table(FITTED), [assignment]))
    assert str(caught.value) == message


def test_misspelt_name_is_refused_with_the_nearest(tmp_path):
    path = tmp_path / "car.toml"
    path.write_text(PUBLISHED.read_text(encoding="utf-8").replace("seat_arm", "seat_arn"), encoding="utf-8")
    with pytest.raises(ConfigurationError) as caught:
        half_car_rider_parameters(path)
    assert str(caught.value) == "body.seat_arn: unknown parameter; did you mean seat_arm?"


def test_bands_need_a_width():
    with pytest.raises(ConfigurationError, match=r"FrequencyBands\.width: found 0\.0 Hz, must be greater than 0\.0"):
        FrequencyBands(width=0.0, highest=1.0)


def test_damper_file_is_complete():
    assert tomllib.loads(FITTED.read_text(encoding="utf-8")).keys() == {
        "quarter_car",
        "half_car",
        "highway",
        "city",
        "bands",
    }
    assert damper_choice_parameters().bands.width == 1.0
