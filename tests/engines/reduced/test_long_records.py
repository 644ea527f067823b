"""Long records: plates are made piece by piece, and what cannot be held is refused before it is computed."""

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.engines.reduced import group_run, plate_samples
from vehicle.engines.simulation import recorded_acceleration
from vehicle.engines.simulation.judgement import require_samples
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road


def test_pieces_give_the_same_run(car, monkeypatch):
    road = random_road(rms=5e-4, seed=2, wheel="fr", duration=3.0)
    channels = ["seat_rail_acc_z", "damper_fr_velocity", "plate_fr_displacement", "plate_fl_displacement"]
    whole = car.run(road, engine="reduced", channels=channels)
    monkeypatch.setattr(plate_samples, "LARGEST_TABLE", 0)
    pieces = car.run(road, engine="reduced", channels=channels)
    assert isinstance(plate_samples.plate_samples(road, 1e-3, 10, 2), plate_samples.LongPlateSamples)
    for name in channels:
        np.testing.assert_array_equal(whole[name], pieces[name])


def test_blocks_of_any_length_give_the_same_run(car, monkeypatch):
    """Check the state that a block passes on: damper forces around a sample, past positions, plates."""
    road = random_road(rms=4e-3, seed=3, wheel="fr", duration=2.0)
    names = [*car.vehicle.channels, *car.vehicle.requested_channels]
    whole = car.run(road, engine="reduced", channels=names)
    monkeypatch.setattr(group_run, "BLOCK", 333)
    monkeypatch.setattr(recorded_acceleration, "BLOCK", 77)
    blocks = car.run(road, engine="reduced", channels=names)
    for name in names:
        np.testing.assert_array_equal(blocks[name], whole[name], err_msg=name)


def test_loads_of_parts_are_those_of_the_whole(monkeypatch):
    """Rolling tyres on slopes, nonlinear dampers and bump stops act directly on the loads of each part."""
    car = Car.load("focus_road")
    names = [*car.vehicle.channels, *car.vehicle.requested_channels]
    whole = car.run(Road("C", 80.0, duration=4.0), engine="reduced", channels=names)
    monkeypatch.setattr(group_run, "PART", 1500)
    parts = car.run(Road("C", 80.0, duration=4.0), engine="reduced", channels=names)
    for name in names:
        # The splines of a part end 64 samples beyond it, which is below round-off.
        np.testing.assert_allclose(
            parts[name], whole[name], rtol=0.0, atol=1e-12 * max(np.max(np.abs(whole[name])), 1e-3), err_msg=name
        )


def test_a_recording_that_does_not_fit_is_refused(monkeypatch):
    monkeypatch.setattr("os.sysconf", {"SC_PAGE_SIZE": 4096, "SC_PHYS_PAGES": 1000}.__getitem__)  # 4 MB
    with pytest.raises(ConfigurationError, match=r"^solver\.record_rate: 10 channels of 3e\+04 .* 0\.0024 GB"):
        require_samples(30_000, 10)
    require_samples(20_000, 10)
    car = Car.load()
    with pytest.raises(ConfigurationError, match=r"solver\.record_rate: .* GB.*; lower the rate"):
        car.run(random_road(rms=5e-4, seed=2, wheel="fr", duration=12.0), engine="reduced")
    assert "matrices" not in vars(car), "refused before anything is computed"
