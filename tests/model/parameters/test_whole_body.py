"""Mass or centre of gravity of the body varied alone: the tensor is that of the body whose particles are varied."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.rigid_body import cog_inertia
from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.body_notices import body_notices, body_rules
from vehicle.model.parameters.toml_file import write_text
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.model.parameters.whole_body import followers
from vehicle.runs.car import Car

RNG = np.random.default_rng(5)
PARTICLES, PLACES = RNG.uniform(5.0, 40.0, 12), RNG.uniform(-1.0, 1.0, (12, 3)) * (2.0, 0.8, 0.6) + (2.0, 0.02, 1.0)


def body_of(masses, places, about):
    """Table [body] of particles: sums over them."""
    cog = masses @ places / masses.sum()
    x, y, z = (places - (cog if about == "cog" else 0.0)).T
    integrals = (y * y + z * z, x * x + z * z, x * x + y * y, x * y, z * x, y * z)
    moments = {name: float(masses @ one) for name, one in zip(MOMENTS, integrals, strict=True)}
    return {"mass": float(masses.sum()), "cog": cog.tolist(), "inertia": {"about": about, **moments}}


@pytest.mark.parametrize("about", ["cog", "origin"])
@pytest.mark.parametrize(("factor", "way"), [(1.3, (0, 0, 0)), (1.0, (0.1, 0.0, -0.05)), (0.8, (-0.2, 0.03, 0.1))])
def test_every_particle_is_scaled_and_moved(about, factor, way):
    before = body_of(PARTICLES, PLACES, about)
    after = body_of(factor * PARTICLES, PLACES + np.array(way), about)
    found = followers(before, {**after, "inertia": before["inertia"]}, set())
    expected = {f"body.inertia.{name}": after["inertia"][name] for name in MOMENTS}
    kept = {f"body.inertia.{name}": before["inertia"][name] for name in MOMENTS}
    assert kept | found == pytest.approx(expected, rel=1e-12)
    # What is given does not follow.
    assert "body.inertia.ixx" not in followers(before, {**after, "inertia": before["inertia"]}, {"body.inertia.ixx"})


CHANGES = [
    ("sedan", ["body.mass=1300"]),
    ("sedan", ["body.cog.z=1.0", "body.mass=1300", "body.inertia.ixx=600"]),
    ("focus", ["body.mass=829.26"]),
    ("focus", ["body.cog=[2.1, 0.0, 1.0]"]),
]


@pytest.mark.parametrize(("name", "changes"), CHANGES)
def test_all_ways_to_a_value_make_the_same_car(name, changes):
    built = Car.load(name, changes)
    assert Car.load(name).with_(changes).vehicle == built.vehicle
    *first, last = changes
    body = Car.load(name, first).with_([last]).vehicle.body
    assert body.mass == built.vehicle.body.mass and body.model_mass == built.vehicle.body.model_mass
    np.testing.assert_allclose(cog_inertia(body), cog_inertia(built.vehicle.body), rtol=1e-12, atol=1e-9)
    # A run repeats from the file that it writes.
    assert vehicle_of(tomllib.loads(write_text(built.vehicle))) == built.vehicle


def test_radii_of_gyration_stay_and_given_moments_win():
    own, varied = (
        load_vehicle(Path("sedan")).body,
        load_vehicle(Path("sedan"), ["body.mass=1300", "body.inertia.ixx=600"]).body,
    )
    assert (varied.inertia.ixx, varied.cog) == (600.0, own.cog)
    for name in ("iyy", "izz", "izx"):
        assert getattr(varied.inertia, name) / 1300.0 == pytest.approx(getattr(own.inertia, name) / own.mass, rel=1e-14)
    # In whatever order.
    assert load_vehicle(Path("sedan"), ["body.inertia.ixx=600", "body.mass=1300"]).body == varied


def test_modes_of_the_body_go_with_the_root_of_the_mass():
    changes = ["body.mass=829.26"]
    one, other = Car.load("focus").trimmed_body, Car.load("focus", changes).trimmed_body
    np.testing.assert_allclose(other.frequencies, one.frequencies / np.sqrt(1.02), rtol=1e-12)
    np.testing.assert_allclose(other.shapes, one.shapes / np.sqrt(1.02), rtol=1e-12, atol=1e-15)
    assert one.node_mass is not None and other.node_mass is not None
    np.testing.assert_allclose(other.node_mass, 1.02 * one.node_mass, rtol=1e-12)
    assert load_vehicle(Path("focus"), changes).body.model_factor == pytest.approx(1.02, rel=1e-15)
    # A body model that is given in the same breath is not scaled: it is that of the mass that is given.
    assert load_vehicle(Path("focus"), [*changes, "body.superelement=trimmed_body.toml"]).body.model_mass is None


def test_what_followed_is_said():
    changes = ["body.mass=829.26"]
    (said,) = body_notices(load_vehicle(Path("focus"), changes), changes)
    assert said.startswith(
        "body.mass=829.26: the whole body is scaled, so its radii of gyration stay the same; ixx 1020, iyy 5373.36, "
    )
    assert said.endswith("the masses of the body model are multiplied by 1.02, its frequencies by 0.990148")
    (said,) = body_notices(load_vehicle(Path("sedan"), ["body.cog.z=1"]), ["body.cog.z=1"])
    assert said == (
        "body.cog.z=1: the inertia about the centre of gravity stays the same; ixx 556.49, iyy 1923.74, izz "
        "2199.25 kg m2 about the CoG"
    )
    assert body_notices(load_vehicle(Path("sedan")), ["front.damper.gas_force=1"]) == []
    assert body_rules(load_vehicle(Path("sedan")), ["body.mass", "body.inertia.ixx", "cog.x"]) == [
        "body.mass: the whole body is scaled, so its radii of gyration stay the same, except the given values "
        "of body.inertia",
        "cog.x: the inertia about the centre of gravity stays the same, except the given values of body.inertia",
    ]


def test_a_car_over_another_follows_too_and_earlier_keys_are_refused(tmp_path):
    file = tmp_path / "car.toml"
    file.write_text('base = "focus"\nname = "heavy"\n[body]\nmass = 829.26\n', encoding="utf-8")
    assert load_vehicle(file).body == load_vehicle(Path("focus"), ["body.mass=829.26"]).body
    file.write_text('base = "focus"\n[body]\ninertia = { ixx = 400, iyy = 600, izz = 800 }\n', encoding="utf-8")
    assert load_vehicle(file).body.inertia.about == "cog"
    file.write_text('base = "focus"\n[body]\nixx_improved = 1200.0\niyy = 5268.0\nizx = 1800.0\n', encoding="utf-8")
    with pytest.raises(
        ConfigurationError,
        match=r"body: found ixx_improved, iyy, izx; .* Write inertia = \{ about = \"origin\", ixx = 1200\.0, iyy = "
        r"5268\.0, izx = 1800\.0 \} in \[body\]",
    ):
        load_vehicle(file)
