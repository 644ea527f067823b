"""Every path that `show --search` or the bench offers can be read and set, for all shipped cars."""

import pytest

from vehicle.handover.bench.setting import settings
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.parameter_list import parameter_at
from vehicle.model.parameters.paths import assignments, override, value_at
from vehicle.model.parameters.shipped import shipped_cars
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car


def plain(value):
    return list(value) if isinstance(value, tuple) else value


# All paths of these two are paths of another car.
@pytest.mark.parametrize("name", sorted({*shipped_cars()} - {"focus_measured_roll", "focus_road"}))
def test_every_offered_path_is_read_and_set(name):
    car = Car.load(name)
    assert car.folder is not None
    optional = optional_paths(car.vehicle.table, car.folder)
    listed = {parameter.path: parameter.value for parameter in car.search()}
    sliders = {path: setting.value for path, setting in settings(car).items()}
    assert len(listed) > 150 and len(sliders) > 200
    # Components of vectors that stand at their default, zeros, have paths too: 117 sliders of the sedan had none.
    mounts = car.vehicle.table["engine"]["bushings"]
    assert all(f"engine.bushings.{mount}.friction_force.z" in sliders for mount in mounts)
    for path, value in {**listed, **sliders}.items():
        assert plain(parameter_at(car.vehicle, path, None, lambda: optional).value) == plain(value), path
    for offered in (listed, sliders):
        changed = override(car.vehicle.table, assignments(offered), lambda: optional)
        for path, value in offered.items():
            assert value_at(changed, path) == plain(value), path
        vehicle_of(changed, car.folder)


def test_a_component_of_a_default_vector_keeps_the_others():
    path = "engine.bushings.hydromount.friction_force"
    car = Car.load("focus", [f"{path}.z=40", "hydromount.friction_stroke.z=0.0002"])
    assert car[path].value == [0.0, 0.0, 40.0] and car[f"{path}.z"].value == 40.0
    assert Car.load("focus")[f"{path}.z"].value == 0.0
    turned = Car.load("sedan", ["front.left.parts.knuckle.products.x=0.01"])
    assert turned["front.left.parts.knuckle.products"].value == [0.01, 0.0, 0.0]
