"""Range of the tests of a law: part of the vehicle file, and dropped with the numbers to which it belongs."""

from typing import Any

import pytest

from vehicle import Car
from vehicle.errors import ConfigurationError

RANGE = {"front.damper.tested.velocity": [0.016, 0.079], "front.damper.tested.current": [1.0, 1.0]}


def ranges(car):
    """Velocities of the range of the right and the left front damper."""
    laws = (damper.law for damper in car.vehicle.composition.dampers if damper.name in ("damper_fr", "damper_fl"))
    return [law.tested and law.tested.velocity for law in laws]


BOTH = [(0.016, 0.079)] * 2


@pytest.fixture(scope="module")
def car():
    return Car.load("focus_road", RANGE)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"front.damper.viscous": 1500.0}, [None, None]),
        ({"*.damper.coulomb_friction": 10.0}, [None, None]),
        ({"front.damper.viscous": 2250.0}, BOTH),  # its value in the file
        ({"front.damper.slip_velocity": 0.005}, BOTH),
        ({"front.damper.gas_force": 100.0}, BOTH),
        ({"body.mass": 1000.0}, BOTH),
        ({"front.right.damper.viscous": 1500.0}, [None, (0.016, 0.079)]),
        ({"front.damper.viscous": 1500.0, "front.damper.tested.velocity": [0.0, 0.2]}, [(0.0, 0.2)] * 2),
        ({"front.damper.tested.velocity": [0.0, 0.2], "front.damper.viscous": 1500.0}, [None, None]),
    ],
)  # fmt: skip
def test_a_change_of_the_law_drops_the_range(car, changes, expected):
    variant = car.with_(changes)
    assert ranges(variant) == expected
    assert ranges(Car.load("focus_road", variant.overrides)) == expected


def test_values_of_an_older_range_do_not_remain(car):
    changed = car.with_({"front.damper.viscous": 1500.0, "front.damper.tested.velocity": [0.0, 0.2]})
    assert changed.vehicle.damper.tested.current is None
    assert car.with_({"front.damper.tested.velocity": [0.0, 0.2]}).vehicle.damper.tested.current == (1.0, 1.0)


def test_files_keep_the_range(car, tmp_path):
    car.save(tmp_path / "a.toml")
    assert ranges(Car.load(tmp_path / "a.toml")) == BOTH
    for line, expected in (("viscous = 1400.0", [None, None]), ("slip_velocity = 0.005", BOTH),
                           ("viscous = 1400.0\ntested.velocity = [0.0, 0.3]", [(0.0, 0.3)] * 2)):  # fmt: skip
        (tmp_path / "b.toml").write_text(f'base = "a.toml"\nname = "b"\n[front.damper]\n{line}\n')
        assert ranges(Car.load(tmp_path / "b.toml")) == expected


@pytest.mark.parametrize(("value", "said"), [([0.2, 0.079], "must be the lowest and the highest value"),
                                             ([0.2], "must be a list of 2 numbers")])  # fmt: skip
def test_a_wrong_range_is_refused(value, said):
    with pytest.raises(ConfigurationError, match=said):
        Car.load("focus_road", {"front.damper.tested.velocity": value})


def test_a_bushing_has_a_range():
    tested = Car.load("focus_road", {"front.bushings.suspension_mount.tested.frequency": [1.0, 100.0]})
    laws: dict[str, Any] = {link.name: link.law for link in tested.vehicle.composition.connections}
    assert laws["suspension_mount_fr"].tested.frequency == (1.0, 100.0)


BAND = {"velocity": [-0.5, -0.1, 0.1, 0.5], "soft": [-60.0, -30.0, -30.0, -80.0], "firm": [50.0, 20.0, 20.0, 50.0]}


@pytest.mark.parametrize(("changes", "said"), [
    ({"soft": [-60.0, -30.0, -30.0]}, "found 4 velocities, 3 changes at the soft and 4 .* give as many of each"),
    ({"velocity": [-0.1, -0.5, 0.1, 0.5]}, "must be ascending, .*; sort them"),
    ({"velocity": [-0.5, -0.5, 0.1, 0.5]}, "must be ascending"),
    ({"velocity": [-0.5, -0.1, 0.0, 0.5]}, "without zero"),
    ({"velocity": [-0.5, 0.1, 0.2, 0.5]}, "as many below as above zero"),
    ({"velocity": [-0.5, -0.1, 0.1, float("nan")]}, "found nan m/s, must be a finite number"),
    ({"firm": [50.0, 20.0, float("inf"), 50.0]}, "found inf N, must be a finite number"),
    ({"soft": BAND["firm"], "firm": BAND["soft"]}, "band_soft: found 50 N at -0.5 m/s, must be at most 0: .* exchange"),
    ({"firm": [50.0, -20.0, 20.0, 50.0]}, "band_firm: found -20 N at -0.1 m/s, must be at least 0: .*; subtract"),
    ({"soft": -60.0}, "must be a list, not -60.0"),
])  # fmt: skip
def test_a_wrong_band_is_refused(changes, said):
    with pytest.raises(ConfigurationError, match=f"front.damper.tested.*{said}"):
        Car.load("focus_road", {f"front.damper.tested.band_{name}": each for name, each in (BAND | changes).items()})
