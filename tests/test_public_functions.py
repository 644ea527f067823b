"""What the public functions refuse before anything is computed, and how they read their arguments."""

from typing import Any

import numpy as np
import pytest

from vehicle import (
    Car,
    ConfigurationError,
    DataError,
    Road,
    Signal,
    compare,
    evaluate_comfort,
    optimise,
    replicate_drive,
    save_run,
    sweep,
    tune,
    write_report,
)
from vehicle.signals.formats.csv_table import write_table
from vehicle.studies.sweeps.plan import changes_of, plan_sweep
from vehicle.studies.sweeps.sweep_inputs import file_of, inputs_of
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.tuning.car_fit import ranges_of

VISCOUS = "damper.viscous"


@pytest.fixture
def record(tmp_path):
    """Acceleration with the mean of gravity."""
    time = np.arange(0.0, 12.0, 2e-3)
    z = 9.81 + np.random.default_rng(1).standard_normal(time.size)
    path = tmp_path / "seat.csv"
    write_table(path, ["time [s]", "x [m/s2]", "y [m/s2]", "z [m/s2]"], [time, z - 9.81, 9.81 - z[::-1], z], [])
    return path


def test_variations_of_a_sweep():
    every = [("a=1", "b=[2, 3]"), ("a=1", 'b="x"'), ("a=1.5", "b=[2, 3]"), ("a=1.5", 'b="x"')]
    assert list(changes_of({"a": [1, 1.5], "b": [[2, 3], "x"]})) == every
    assert changes_of([{"a": 1}, ["a=2"]]) == [("a=1",), ("a=2",)]
    nothings: list[Any] = [{}, [], {"a": []}]
    for nothing in nothings:
        with pytest.raises(ConfigurationError, match="vary: no variation"):
            changes_of(nothing)


def test_inputs_of_many_runs(sedan):
    roads: list[Any] = [Road("A", speed=72, seed=1), Road("A", speed=72, seed=2), Road("C", speed=72), "low.csv"]
    assert [one.name for one in inputs_of(sedan, roads)] == ["road_A_72_seed_1", "road_A_72_seed_2", "road_C_72", "low"]
    signal = Signal(time=np.arange(40) / 100.0, displacement={"fr": np.zeros(40)}, source="mine", highest=40.0)
    with pytest.raises(DataError, match="mine: contains vibration only up to 40 Hz"):
        inputs_of(sedan, signal)
    with pytest.raises(ConfigurationError, match="inputs: none given"):
        inputs_of(sedan, [])
    with pytest.raises(ConfigurationError, match=r"road class 'nowhere\.csv'"):
        inputs_of(sedan, Road("nowhere.csv", speed=60))[0].signal()
    with pytest.raises(ConfigurationError, match=r"tyre: .* not 'soft'"):
        Road("A", speed=72, tyre="soft").under(sedan.vehicle)


def test_a_sweep_runs_the_car_that_it_is_given(sedan):
    stiff = Car.load("sedan", {"body.mass": 1100.0})
    plan = plan_sweep(
        stiff, {"rear.damper.viscous": [1500, 2500]}, Road("A", speed=72, duration=3), SweepSettings(skip=1.0)
    )
    assert [case.overrides for case in plan.cases] == [
        ("body.mass=1100.0", "driving.speed=20.0", f"rear.damper.viscous={value}") for value in (1500, 2500)
    ]
    assert plan.skip == 1.0 and plan.cases[0].vehicle == file_of(sedan)
    changed = Car(stiff.vehicle)  # from no file: workers could not load it
    with pytest.raises(ConfigurationError, match=r"loaded from a file; load the car with Car\.load"):
        sweep(changed, {"rear.damper.viscous": [1500]}, "low.csv")


def test_parameters_of_a_fit_start_at_the_car(car):
    (one,) = ranges_of(car.vehicle, {VISCOUS: (500.0, 5000.0)})
    assert (one.low, one.start, one.high) == (500.0, car.vehicle.damper.viscous, 5000.0)
    assert ranges_of(car.vehicle, {VISCOUS: (500.0, 5000.0, 900.0)})[0].start == 900.0
    with pytest.raises(ConfigurationError, match=r"must be \(lower, upper\)"):
        ranges_of(car.vehicle, {VISCOUS: (500.0,)})
    with pytest.raises(ConfigurationError, match=r"did you mean front\.damper\.viscous"):
        tune(car, {"damper.vicsous": (1.0, 2.0)}, [])
    with pytest.raises(ConfigurationError, match="targets: the measurement is missing"):
        tune(car, {VISCOUS: (500.0, 5000.0)}, [])


def test_gravity_in_a_record_is_refused_until_it_is_removed(record):
    with pytest.raises(DataError, match=r"gravity is included in the mean \(9\.8"):
        evaluate_comfort(record)
    found = evaluate_comfort(record, offset="remove")
    assert found.offset.mean["z"] == pytest.approx(9.81, abs=0.05)
    assert found.overall == pytest.approx(np.sqrt(sum(value**2 for value in found.weighted_rms.values())))
    assert "weighted RMS" in repr(found) and found.seat_value is None
    with pytest.raises(ConfigurationError, match=r"offset: .* not 'drop'"):
        evaluate_comfort(record, offset="drop")


def test_a_run_of_some_channels_is_not_saved(car, tmp_path):
    time = np.arange(0.0, 2.0, 1e-3)
    signal = Signal(time=time, displacement={"fr": 1e-3 * np.sin(60.0 * time)})
    run = car.run(signal, engine="reduced", channels=["seat_rail_acc_z"])
    with pytest.raises(ConfigurationError, match="channel"):
        save_run(run, tmp_path / "mine")
    assert not (tmp_path / "mine").exists()


def test_wrong_arguments_are_refused(car, record, tmp_path):
    vary = {VISCOUS: (800.0, 4000.0)}
    for call, message in (
        (lambda: car.run("low.csv", skip=70.0), r"--skip 70 s: must be at least 0 and below the 60 s of low\.csv"),
        (lambda: compare(tmp_path, record, drift=0.2), "--drift 200000: must be"),
        (lambda: compare(tmp_path, record, bands=(9.0, 3.0)), "must be increasing frequencies"),
        (lambda: write_report("nowhere", "report.html"), "nowhere: is not a folder"),
        (lambda: write_report([tmp_path], "report.pdf"), r"the name must end in \.html"),
        (lambda: optimise(car, vary, "low.csv", ["unweighted"], cars=4), "--cars 4: must be at least 8"),
        (lambda: optimise(car, vary, "low.csv", ["unweighted"], samples=8), "only valid with tolerances"),
        (lambda: optimise(car, {VISCOUS: (1.0,)}, "low.csv", ["unweighted"]), r"must be \(lower, upper\)"),
        (lambda: replicate_drive(car, record, {"knuckle_fr_acc_z": "z"}, wheels=("fr", "fl")), "2 plates"),
        (lambda: replicate_drive(car, record, ["knuckle_fr_acc_z"], gain=2.0), "--gain 2: must be above 0"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            call()
