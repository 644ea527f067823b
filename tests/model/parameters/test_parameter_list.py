"""All parameters of a car with unit, range and source; comments of vehicle files by path."""

from vehicle import Car
from vehicle.model.parameters.force_elements import FRICTION_LAWS
from vehicle.model.parameters.parameter_list import CHANGED, DEFAULT, parameter_list
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.model.parameters.value_sources import comments, value_sources
from vehicle.model.parameters.vehicle import load_vehicle

TEXT = """
name = "a # b"  # [-] a name
plain = 1.0
[front.damper]   # no value
velocity = [-1.0,  # inside
  1.0]  # [m/s] two lines
"quoted" = 'x'  # its source
[outputs]
seat = { on = "body", at = "seat" }  # [-] assumed
"""


def test_comments_by_path():
    assert comments(TEXT) == {
        "name": "a name",
        "front.damper.velocity": "two lines",
        "front.damper.quoted": "its source",
        "outputs.seat": "assumed",
    }


def test_every_value_of_a_shipped_car_has_its_source():
    for name in CARS:
        vehicle, file = load_vehicle(vehicle_file(name)), vehicle_file(name)
        parameters = {one.path: one for one in parameter_list(vehicle, file)}
        assert len(parameters) > 150
        without = [path for path, one in parameters.items() if not one.source]
        assert [path for path in without if not path.startswith("seat.")] == []
        assert all(
            value_at(vehicle.table, path) == one.value for path, one in parameters.items() if one.source != DEFAULT
        )
    sources = value_sources(vehicle_file("focus_road_seated"))
    assert sources["body.mass"] == "section 3.1.2"  # of its base


def test_a_changed_value_loses_its_source():
    car = Car.load("sedan", {"front.damper.coulomb_friction": 60.0})
    (friction,) = car.search("front coulomb")
    assert (friction.value, friction.unit, friction.source) == (60.0, "N", CHANGED)
    assert friction.range == "0 to 1e+06"
    (same,) = Car.load("sedan").search("FRONT coulomb")
    assert repr(same) == "front.damper.coulomb_friction = 80 N  # assumed: seal and guide of a strut"
    (law,) = car.search("front.damper.friction_law")
    assert law.range == ", ".join(FRICTION_LAWS)
    (speed,) = car.search("driving.speed")
    assert (speed.value, speed.source) == (0.0, DEFAULT)
    assert len(car.search()) > 200 and car.search("nowhere") == []
