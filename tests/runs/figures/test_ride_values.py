"""Figures of the ride against closed forms and against independent computations from a run; their names."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.runs.car.motion_figures import motion_figures
from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.figures.chosen_figure import available, chosen_figure
from vehicle.runs.figures.run_batch import Runs
from vehicle.runs.figures.value import values_of
from vehicle.studies.sweeps.measure import chosen_measure

TIME = np.arange(0.0, 10.0005, 1e-3)


@pytest.fixture(scope="module")
def run():
    car = Car.load(None, ["damper.coulomb_friction=20"])
    measure = chosen_measure(("unweighted", "tyre_load", "travel", "slip_share"), car.vehicle, 0.5)
    assert measure.channels is not None
    channels = (*measure.channels, "suspension_travel_fr")
    return car.run(random_road(rms=2e-3, seed=1, wheel="fr", duration=3.0), engine="reduced", channels=channels)


def of(runs, *names, skip=1.0):
    return {
        name: values_of(chosen_figure(name, runs.vehicles[0]), replace(runs, skip=skip, errors=False)).value
        for name in names
    }


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
    names = ("unweighted", "unweighted_z", "slip_share", "slip_share_fr", "travel_fr")
    values = chosen_measure(names, run.car.vehicle, 0.5)(run)
    # Parseval: the mean square of a band is twice the sum of its lines.
    xyz = np.array([run[f"seat_rail_acc_{axis}"][500:-1] for axis in "xyz"])
    frequency = np.fft.rfftfreq(2500, 1e-3)
    # The cell of a line, 0.2 Hz to both sides, counts with its part in the band: half of it at 2 and at 50 Hz.
    shares = np.clip((np.minimum(frequency + 0.2, 50.0) - np.maximum(frequency - 0.2, 2.0)) / 0.4, 0.0, 1.0)
    lines = shares * np.abs(np.fft.rfft(xyz) / 2500) ** 2
    assert values["unweighted_z"] == pytest.approx(np.sqrt(2.0 * lines[2].sum()), rel=1e-9)
    assert values["unweighted"] == pytest.approx(np.sqrt(2.0 * lines.sum()), rel=1e-9)
    limit = run.car.vehicle.damper.slip_velocity
    shares = [np.mean(np.abs(run[f"damper_{wheel}_velocity"][500:-1]) > limit) for wheel in ("fr", "fl")]
    assert values["slip_share_fr"] == pytest.approx(shares[0]) and values["slip_share"] == pytest.approx(
        np.mean(shares)
    )
    # The travel of the strut is about proportional to the travel of the wheel, a difference of displacements.
    wheel = run["suspension_travel_fr"] - run["suspension_travel_fr"][0]
    assert values["travel_fr"] == pytest.approx(np.max(np.abs(wheel)), rel=0.15)


def test_names_of_figures():
    car, seated = load_vehicle(), load_vehicle(Path("focus_road_seated"))
    for text, column, unit in (
        ("unweighted_z", "unweighted_z", "m/s2"),
        ("weighted:z", "weighted_z", "m/s2"),
        ("tyre_load", "tyre_load", "-"),
        ("tyre_load_rms_fr", "tyre_load_rms_fr", "N"),
        ("slip_share_fl", "slip_share_fl", "-"),
        ("travel:fr+fl", "travel_fr+fl", "m"),
        ("peak:seat rail z", "peak_seat_rail_acc_z", "m/s2"),
        ("rms:seat_rail_acc_z:Wk:5-25", "rms_seat_rail_acc_z_5-25_Wk", "m/s2"),
        ("vdv:seat_rail_acc_x,seat_rail_acc_z:seat", "vdv_seat_rail_acc_x+seat_rail_acc_z_seat", "m/s^1.75"),
        ("ratio:seat rail z:knuckle fr z:0.5-5", "ratio_seat_rail_acc_z_knuckle_fr_acc_z_0.5-5", "-"),
        ("order:2.5:seat_rail_acc_z:wheel_fr", "order_2.5_seat_rail_acc_z", "m/s2"),
        ("frequency:front wheel hop", "frequency_front_wheel_hop", "Hz"),
    ):
        chosen = chosen_figure(text, car)
        assert (chosen.column, chosen.unit_in()) == (column, unit)
        # A table names a figure so that its name can be typed again, but for the order and for a form with colons.
        if ":" not in text:
            assert chosen_figure(column, car) == chosen
    reads = chosen_figure("seat_weighted", seated).channels_of(seated)
    assert reads == tuple(f"{point}_acc_{axis}" for point in ("seat_rail", "seat") for axis in "xyz")
    assert {"seat_weighted", "seat_value"} == {*available(seated)} - {*available(car)} - {"seat_unweighted"}


def test_crests_and_running_means_of_waves():
    """A sine has the crest factor sqrt(2), a running mean over whole periods is its RMS, and a dose is known."""
    sine = np.sin(2 * np.pi * 4.0 * TIME)
    channels = {"seat_rail_acc_z": np.stack([3.0 * sine, sine]), "tyre_fr_force_z": 4000.0 * (1.0 + 0.5 * sine[None])}
    channels["tyre_fr_force_z"] = np.repeat(channels["tyre_fr_force_z"], 2, axis=0)
    vehicle = load_vehicle()
    runs = Runs(time=TIME, channels=channels, vehicles=(vehicle, vehicle), tyre_load={"fr": np.array([4000.0, 4000.0])})
    found = of(
        runs, "crest_factor:seat_rail_acc_z", "tyre_load_crest_fr", "mtvv:seat_rail_acc_z", "tyre_load_rms_fr",
        "rms:seat_rail_acc_z:3-5", "peak_to_peak:seat_rail_acc_z", skip=0.0,
    )  # fmt: skip
    assert found["crest_factor:seat_rail_acc_z"] == pytest.approx([np.sqrt(2.0)] * 2, rel=1e-4)
    assert found["tyre_load_crest_fr"] == pytest.approx([np.sqrt(2.0)] * 2, rel=1e-4)
    assert found["mtvv:seat_rail_acc_z"] == pytest.approx(np.array([3.0, 1.0]) / np.sqrt(2.0), rel=1e-9)
    assert found["tyre_load_rms_fr"] == pytest.approx([2000.0 / np.sqrt(2.0)] * 2, rel=1e-9)
    assert found["rms:seat_rail_acc_z:3-5"] == pytest.approx(np.array([3.0, 1.0]) / np.sqrt(2.0), rel=1e-9)
    assert found["peak_to_peak:seat_rail_acc_z"] == pytest.approx([6.0, 2.0], rel=1e-4)


def test_frequency_and_damping_of_a_motion_are_those_of_the_car(run):
    heave = next(each for each in motion_figures(run.car) if (each.motion, each.dampers) == ("heave", "stuck"))
    assert run.figure("frequency:heave stuck") == heave.frequency_hz
    assert run.figure("damping_ratio:heave stuck") == heave.damping_ratio


def test_every_figure_has_words_and_a_meaning():
    for name, figure in FIGURES.items():
        assert figure.words and figure.meaning.endswith("]"), name
        assert f"[{figure.unit or 'U'}]" in figure.meaning, name
        assert not figure.companion or figure.companion in FIGURES
