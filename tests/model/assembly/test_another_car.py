"""The generator takes any MacPherson front end: another car's hardpoints, its own body nodes, its own file."""

import mujoco
import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.engines.simulation.car_model import build_model
from vehicle.errors import DataError
from vehicle.model.assembly.spec import assemble
from vehicle.model.flexbody.superelement import attached_nodes
from vehicle.model.flexbody.superelement_file import write_superelement
from vehicle.model.parameters.paths import override
from vehicle.model.parameters.toml_file import write_text
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.runs.car import Car

WIDER = 0.03  # m on each side


POINTS = ("wheel_center", "tyre_patch", "lower_ball", "damper_bottom", "spring_lower", "tie_outer")


@pytest.fixture(scope="module")
def other():
    """Wider track, and a strut top 12 mm further back and 20 mm higher."""
    points = load_vehicle().table["front"]["hardpoints"]
    changes = [f"hardpoints.{name}.y={points[name][1] + WIDER}" for name in POINTS]
    x, y, z = points["strut_top"]
    vehicle = load_vehicle(None, [*changes, f"hardpoints.strut_top={[x + 0.012, y + WIDER, z + 0.02]}", "name=other"])
    return vehicle, Car(vehicle).trimmed_body


def test_another_car_builds_and_stands(other):
    vehicle, body = other
    model = build_model(vehicle, body)
    assert model.static.residual < 1e-6
    data = mujoco.MjData(model.model)
    mujoco.mj_forward(model.model, data)
    points = vehicle.points
    np.testing.assert_allclose(data.site("place/damper_top_fr").xpos, points["strut_top_fr"], atol=1e-12)
    assert data.site("bushing/tyre_fl/moving").xpos[1] == pytest.approx(-0.777, abs=1e-12)
    # The tyres of the wider car still carry the front: their loads changed by the track alone.
    loads = [*model.static.tyre_load.values(), *model.static.support_load.values()]
    assert sum(loads) == pytest.approx(vehicle.gravity * (model.model.body_mass.sum()), rel=1e-9)


def test_another_car_from_its_files_runs(other, tmp_path):
    vehicle, body = other
    vehicle = vehicle_of(override(vehicle.table, ["body.superelement=other.toml"]))
    (tmp_path / "car.toml").write_text(write_text(vehicle), encoding="utf-8")
    write_superelement(tmp_path / "other.toml", body)
    car = Car.load(tmp_path / "car.toml")
    assert car.vehicle == vehicle
    run = car.run(random_road(rms=1e-4, seed=1, wheel="fr", duration=1.0))
    rms = float(np.sqrt(np.mean(run["knuckle_fr_acc_z"] ** 2)))
    assert 0.05 < rms < 5.0
    # A wider track rolls slower: more inertia at the wheels, same springs on longer arms; it is another car.
    assert car.modes()[5].frequency != pytest.approx(Car.load().modes()[5].frequency, rel=1e-3)


def test_item_27_hardpoints_that_the_body_does_not_have_are_refused(other):
    vehicle, _ = other
    published = Car(load_vehicle()).trimmed_body
    with pytest.raises(DataError) as caught:
        assemble(vehicle, published)
    message = str(caught.value)
    assert "no node at the attachment strut_top_fr of the" in message and "'strut_top_fr'" in message
    assert "move the hardpoint, use a body model with a node there, or compute the body from the" in message


def test_item_27_a_missing_interface_node_is_refused(other):
    vehicle, body = other
    places = vehicle.composition.attachments() | {"brace": (0.8, 0.44, 1.4)}
    with pytest.raises(DataError, match=r"attachment brace of the car, \[0\.8, 0\.44, 1\.4\] m"):
        attached_nodes(body, places)
