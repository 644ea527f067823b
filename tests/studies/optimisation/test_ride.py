"""Quantities of the ride against closed forms and against independent computations from a run."""

from pathlib import Path

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.studies.optimisation.ride import QUANTITIES, RideMeasure, ride_measure, split_name
from vehicle.studies.sweeps.run_batch import Runs

TIME = np.arange(0.0, 10.0005, 1e-3)


@pytest.fixture(scope="module")
def run():
    car = Car.load(None, ["damper.coulomb_friction=20"])
    measure = ride_measure(car.vehicle, ("unweighted", "tyre_load", "travel", "slip_share"), 0.5)
    channels = (*measure.channels, "suspension_travel_fr")
    return car.run(random_road(rms=2e-3, seed=1, wheel="fr", duration=3.0), engine="reduced", channels=channels)


def of(runs, *numbers, skip=1.0):
    measure = RideMeasure(numbers=numbers, wheels=("fr", "fl"), dampers=("fr", "fl"), skip=skip)
    assert set(measure.channels) <= set(runs.channels)
    return measure.of(runs)


def test_travel_load_and_slip_of_sines():
    vehicle = load_vehicle()
    sine, cosine = np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME)
    stroke = np.array([[0.02], [0.01]])  # of two cars
    runs = Runs(
        time=TIME,
        channels={
            "damper_fr_velocity": stroke * 2 * np.pi * cosine,
            "damper_fl_velocity": 0.5 * stroke * 2 * np.pi * cosine,
            "tyre_fr_force_z": np.array([[4000.0], [3000.0]]) * (1.0 + 0.4 * sine),
            "tyre_fl_force_z": np.array([[4000.0], [3000.0]]) * (1.0 + 0.2 * sine),
        },
        vehicles=(vehicle, vehicle),
        tyre_load={wheel: np.array([4000.0, 3000.0]) for wheel in ("fr", "fl")},
    )
    # The trapezoidal rule at 1 ms has an error of (2 pi 1e-3)^2 / 12 of the stroke; whole periods are skipped.
    values = of(
        runs, "travel", "travel_fl", "tyre_load", "tyre_load_fr", "lowest_load", "lowest_load_fl", "slip_share_fr"
    )
    assert values["travel"] == pytest.approx([0.02, 0.01], rel=1e-5)
    assert values["travel_fl"] == pytest.approx([0.01, 0.005], rel=1e-5)
    assert values["tyre_load_fr"] == pytest.approx([0.4 / np.sqrt(2.0)] * 2, rel=1e-4)
    assert values["tyre_load"] == pytest.approx([np.sqrt((0.4**2 + 0.2**2) / 4.0)] * 2, rel=1e-4)
    assert values["lowest_load"] == pytest.approx([0.6] * 2) and values["lowest_load_fl"] == pytest.approx([0.8] * 2)
    # |cos| is below a small share s for 2 asin(s) / pi of the time.
    share = 1.0 - 2.0 / np.pi * np.arcsin(vehicle.damper.slip_velocity / (2 * np.pi * 0.02))
    assert values["slip_share_fr"][0] == pytest.approx(share, abs=2e-3)


def test_numbers_of_a_run(run):
    values = ride_measure(
        run.car.vehicle, ("unweighted", "unweighted_z", "slip_share", "slip_share_fr", "travel_fr"), 0.5
    )(run)
    # Parseval: the mean square of a band is twice the sum of its lines.
    xyz = np.array([run[f"seat_rail_acc_{axis}"][500:] for axis in "xyz"])
    frequency = np.fft.rfftfreq(2501, 1e-3)
    lines = np.abs(np.fft.rfft(xyz)[:, (frequency > 1.9999) & (frequency < 50.0001)] / 2501) ** 2
    assert values["unweighted_z"] == pytest.approx(np.sqrt(2.0 * lines[2].sum()), rel=1e-9)
    assert values["unweighted"] == pytest.approx(np.sqrt(2.0 * lines.sum()), rel=1e-9)
    limit = run.car.vehicle.damper.slip_velocity
    shares = [np.mean(np.abs(run[f"damper_{wheel}_velocity"][500:]) > limit) for wheel in ("fr", "fl")]
    assert values["slip_share_fr"] == pytest.approx(shares[0]) and values["slip_share"] == pytest.approx(
        np.mean(shares)
    )
    # The travel of the strut is about proportional to the travel of the wheel, a difference of displacements.
    wheel = run["suspension_travel_fr"] - run["suspension_travel_fr"][0]
    assert values["travel_fr"] == pytest.approx(np.max(np.abs(wheel)), rel=0.15)


def test_names_of_quantities():
    assert split_name("unweighted_z") == ("unweighted", "z") and split_name("tyre_load") == ("tyre_load", "")
    assert split_name("slip_share_rl") == ("slip_share", "rl") and split_name("seat_value") == ("seat_value", "")
    car = load_vehicle()
    assert ride_measure(car, ("travel", "unweighted", "travel"), 2.0).units == {"travel": "m", "unweighted": "m/s2"}
    with pytest.raises(ConfigurationError) as caught:
        ride_measure(car, ("unweighted", "seat_weighted"), 2.0)  # a car without an occupant
    assert str(caught.value) == (
        "focus has no quantity 'seat_weighted'; choose from unweighted, unweighted_x, unweighted_y, unweighted_z, "
        "weighted, weighted_x, weighted_y, weighted_z, tyre_load, tyre_load_fr, tyre_load_fl, lowest_load, "
        "lowest_load_fr, lowest_load_fl, travel, travel_fr, travel_fl, "
        "slip_share, slip_share_fr, slip_share_fl"
    )
    assert all(quantity in QUANTITIES for quantity in ("weighted", "lowest_load"))
    assert ride_measure(load_vehicle(Path("focus_road_seated")), ("seat_weighted",), 2.0).channels == tuple(
        f"{point}_acc_{axis}" for point in ("seat_rail", "seat") for axis in "xyz"
    )
