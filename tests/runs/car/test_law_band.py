"""Cars with the edges of the band of a fitted damper."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, road
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_curve
from vehicle.runs.car.law_band import edge_overrides

SUBJECT = "Dampers and friction"
LAW = {
    "viscous_law": "degressive",
    "viscous": 1200.0,
    "degressive_viscous": 5000.0,
    "degressive_velocity": 0.06,
    "friction_law": "coulomb",
    "coulomb_friction": 60.0,
    "gas_force": 150.0,
    "tested.band_velocity": [-0.5, -0.1, -0.001, 0.001, 0.1, 0.5],
    "tested.band_soft": [-60.0, -30.0, -10.0, -10.0, -30.0, -80.0],
    "tested.band_firm": [50.0, 20.0, 5.0, 5.0, 20.0, 50.0],
}


def banded(**changes):
    """The car with this damper in front."""
    return Car.load("focus_road", {f"front.damper.{name}": value for name, value in (LAW | changes).items()})


def force(law, velocity):
    """Curve and friction at velocities, which are above those of the smoothing."""
    return damper_curve(law).force(velocity) + law.coulomb_friction * np.sign(velocity)


def test_the_edges_have_the_force_of_the_band():
    car = banded()
    law = car.vehicle.composition.dampers[0].law
    velocity = np.array(LAW["tested.band_velocity"])
    for edge, name in zip(car.law_band(), ("band_soft", "band_firm"), strict=True):
        other = edge.vehicle.composition.dampers[0].law
        change = np.sign(velocity) * (force(other, velocity) - force(law, velocity))
        assert change == pytest.approx(np.array(LAW[f"tested.{name}"]), abs=1e-6)
        assert other.tested is None and other.gas_force == law.gas_force
        assert np.all(np.diff(other.force) >= 0.0)


def test_the_band_of_some_velocities_leaves_the_others():
    car = banded()
    law = car.vehicle.composition.dampers[0].law
    velocity = np.array(LAW["tested.band_velocity"])
    (soft, _) = car.law_band(velocities=(0.05, 0.2))
    change = np.sign(velocity) * (force(soft.vehicle.composition.dampers[0].law, velocity) - force(law, velocity))
    assert change == pytest.approx([0.0, -30.0, 0.0, 0.0, -30.0, 0.0], abs=1e-6)


def test_both_engines_agree_at_the_edges():
    drive, car = road("B", 80, duration=4), banded()
    comfort = {}
    for name, each in zip(("soft", "firm"), car.law_band(), strict=True):
        reduced, mujoco = (each.run(drive, engine=engine) for engine in ("reduced", "mujoco"))
        comfort[name] = [run.comfort().weighted.overall for run in (reduced, mujoco)]
        validated(SUBJECT, f"{name} edge of a band: comfort of both engines on class B", comfort[name][0],
                  comfort[name][1], rel=0.005, unit="m/s2",
                  source="second derivation: MuJoCo against the reduced engine")  # fmt: skip
    assert comfort["soft"] != pytest.approx(comfort["firm"], rel=1e-3)


def test_a_car_without_a_band_is_refused():
    with pytest.raises(ConfigurationError, match="none of the dampers front"):
        Car.load("focus_road").law_band()
    law = banded().vehicle.composition.dampers[0].law
    with pytest.raises(ConfigurationError, match="found 2 velocities, 6 changes"):
        banded(**{"tested.band_velocity": [-0.1, 0.1]})
    with pytest.raises(ConfigurationError, match="must be ascending, without zero, and as many"):
        banded(**{"tested.band_velocity": [-0.5, -0.1, 0.0, 0.001, 0.1, 0.5]})
    assert set(edge_overrides({"a": law}, "soft")) == {
        f"a.{name}" for name in ("viscous_law", "velocity", "force", "coulomb_friction")
    }
