"""`car[path]`: every path that can be set is read, with its value, and without reading the file again."""

from pathlib import Path

import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.parameters import parameter_list
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.paths import paths, value_at
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car


def test_axes_sides_ends_and_defaults():
    focus, sedan = Car.load("focus"), Car.load("sedan")
    stiffness = focus["tyre.stiffness.z"]
    assert (stiffness.path, stiffness.value, stiffness.unit) == ("front.bushings.tyre.stiffness.z", 250e3, "N/m")
    assert stiffness.source == focus["tyre.stiffness"].source == "appendix F"
    assert sedan["engine.hardpoints.hydromount.y"].value == 0.46
    # Of one side: the value of both, mirrored on the left where it is a point.
    one = sedan["front.left.damper.coulomb_friction"]
    assert (one.value, one.unit, one.source) == (80.0, "N", "assumed: seal and guide of a strut")
    changed = sedan.with_({"front.left.damper.coulomb_friction": 60.0})
    assert changed["front.left.damper.coulomb_friction"].value == 60.0
    assert changed["front.right.damper.coulomb_friction"].value == 80.0
    right = sedan["front.hardpoints.strut_top"].value
    left = sedan["front.left.hardpoints.strut_top"].value
    assert left == [right[0], -right[1], right[2]] == list(sedan.vehicle.points["strut_top_fl"])
    assert sedan.with_({"front.left.hardpoints.strut_top": left}).vehicle.points == sedan.vehicle.points
    # Of all axles, if they are equal.
    assert sedan["*.damper.slip_velocity"].value == 0.006
    with pytest.raises(ConfigurationError, match=r"several values: front\.damper\.coulomb_friction = 80, rear\."):
        sedan["*.damper.coulomb_friction"]
    # What the file leaves out.
    assert (sedan["driving.speed"].value, sedan["driving.speed"].unit) == (0.0, "m/s")
    assert (sedan["body.modes_up_to"].value, sedan["body.modes_up_to"].unit) == (None, "Hz")
    assert repr(sedan["body.modes_up_to"]).startswith("body.modes_up_to = not set")
    assert sedan["load.trunk.mass"].value is None
    with pytest.raises(ConfigurationError, match=r"unknown parameter damper\.viscus"):
        sedan["damper.viscus"]
    with pytest.raises(ConfigurationError, match=r"front\.damper is a section or a component"):
        sedan["front.damper"]


@pytest.mark.parametrize("name", ["focus", "sedan"])
def test_every_settable_path_is_read(name):
    """Of the paths of the file and of its optional ones, every seventh, which takes all kinds of elements."""
    car = Car.load(name)
    table = car.vehicle.table
    settable = [*paths(table), *optional_paths(table, car.folder or FOLDER)]
    assert len(settable) > 1000
    for path in settable[::7]:
        parameter = car[path]
        assert parameter.path == path
        if (value := value_at(table, path)) is not None:
            assert parameter.value == value


FOLDER = Path()


def test_a_look_reads_nothing_after_the_first(monkeypatch):
    """A second look declares one parameter; it was a second of processor time for all of them, and the file again."""
    car = Car.load("sedan")
    car["front.left.damper.coulomb_friction"]
    declared, original = [], Vehicle.quantity_of

    def quantity_of(self, path):
        declared.append(path)
        return original(self, path)

    monkeypatch.setattr(Vehicle, "quantity_of", quantity_of)
    for reader in ("vehicle_table", "value_sources", "with_curve_files"):
        monkeypatch.setattr(parameter_list, reader, lambda *_: pytest.fail("the file is read again"))
    looks = ["rear.damper.coulomb_friction", "front.bushings.tyre.stiffness.z", "front.right.damper.coulomb_friction"]
    variant = car.with_({"front.damper.coulomb_friction": 70.0})
    assert [car[path].value for path in looks] == [40.0, 2.2e5, 80.0] and declared == looks
    assert variant["front.damper.coulomb_friction"].value == 70.0 and len(declared) == 4
