"""Frequency and damping of single body modes: changed by a vehicle file, in both engines, identified by a fit."""

import numpy as np
import pytest

from tests.studies.tuning.test_tuned_car import target_of
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import overrides_of, unit_of, value_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.toml_file import write_text
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.tuning.least_squares import fit

FACTOR, RATIO = "body.modes.2.frequency_factor", "body.modes.2.damping_ratio"
CHANGED = {FACTOR: 1.12, RATIO: 0.06}


@pytest.fixture(scope="module")
def changed(car):
    return Car.load(overrides=overrides_of(car.vehicle, CHANGED))


def test_one_mode_changes_and_keeps_its_number(car, changed):
    old, new = car.trimmed_body, changed.trimmed_body
    assert new.frequencies / old.frequencies == pytest.approx([1.0, 1.12, *7 * [1.0]], rel=1e-14)
    assert new.frequencies[1] > new.frequencies[2]  # numbers are those of the file, not those of a new order
    assert new.damping_ratio.tolist() == [0.03, 0.06, *7 * [0.03]]
    assert (new.shapes == old.shapes).all()


def test_what_is_changed_stands_in_the_file_of_a_run(changed, tmp_path):
    file = tmp_path / "vehicle.toml"
    file.write_text(write_text(changed.vehicle), encoding="utf-8")
    assert "[body.modes.2]\nfrequency_factor = 1.12  # [-] factor on the natural frequency" in file.read_text()
    again = Car.load(file)
    assert again.trimmed_body.frequencies.tolist() == changed.trimmed_body.frequencies.tolist()
    assert value_of(again.vehicle, RATIO) == 0.06
    assert unit_of(again.vehicle, FACTOR) == "-"


@pytest.mark.parametrize(
    ("change", "message"),
    {
        "no such mode": ("body.modes.12.frequency_factor=1.1", r"^body\.modes\.12: \S+ has modes 1 to 9; "),
        "left out": (
            "body.modes.9.frequency_factor=1.1",
            "^body\\.modes\\.9: \\S+ has modes 1 to 4 up to body\\.modes_up_to = 30 Hz",
        ),
        "zero": ("body.modes.2.frequency_factor=0", "frequency_factor: found 0.0, must be at least 0.1"),
        "overdamped": ("body.modes.2.damping_ratio=0.9", "must be at most 0.3 .trimmed bodies have 0.01 to 0.08"),
        "no number": ("body.modes.first.damping_ratio=0.1", "did you mean"),
        "which mode": ("frequency_factor=1.1", "or one of 995 others"),
    }.values(),
)
def test_a_change_of_no_mode_is_refused(change, message):
    further = ["body.modes_up_to=30"] if "modes.9" in change else []
    with pytest.raises(ConfigurationError, match=message):
        _ = Car.load(overrides=[change, *further]).trimmed_body


def test_a_table_that_is_no_number_is_refused(car, tmp_path):
    file = tmp_path / "vehicle.toml"
    text = write_text(car.vehicle)
    file.write_text(text + "\n[body.modes.torsion]\nfrequency_factor = 1.1\n", encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"body\.modes\.torsion: must be a mode number, at least 1"):
        Car.load(file)


def test_both_engines_feel_it_alike(car):
    # Without friction the engines differ by 0.2 % (tests/physics/test_response_of_the_engines.py).
    time = np.arange(0.0, 0.4, 1e-3)
    short = Signal(
        time=time, displacement={"fr": 1e-4 * np.minimum(time / 0.1, 1.0) ** 2 * np.sin(52.0 * np.pi * time)}
    )
    changes = [f"{path}={value}" for path, value in {**CHANGED, "damper.coulomb_friction": 0.0}.items()]
    histories = {
        engine: Car.load(overrides=changes).run(short, engine=engine, channels=["seat_rail_acc_z"])["seat_rail_acc_z"]
        for engine in ("mujoco", "reduced")
    }
    unchanged = Car.load(overrides=changes[-1:]).run(short, engine="reduced")["seat_rail_acc_z"]
    level = np.linalg.norm(histories["reduced"])
    assert np.linalg.norm(histories["mujoco"] - histories["reduced"]) < 5e-3 * level
    assert np.linalg.norm(unchanged - histories["reduced"]) > 0.05 * level


def test_frequency_and_damping_of_a_mode_are_found_again_in_an_frf(car, changed):
    parameters = [
        Range(path=FACTOR, low=0.8, high=1.25, start=value_of(car.vehicle, FACTOR)),
        Range(path=RATIO, low=0.005, high=0.2, start=0.03),
    ]

    def build(values):
        mode = {path.rpartition(".")[2]: value for path, value in values.items()}
        return Car(vehicle_of({**car.vehicle.table, "body": {**car.vehicle.table["body"], "modes": {"2": mode}}}))

    result = fit(parameters, [target_of(changed, None)], build)
    assert result.converged and not result.unidentified
    for path, value in CHANGED.items():
        assert abs(result.deviation(path, value)) < 3.0, path
    assert result.standard_errors[FACTOR] < 0.005 * 1.12  # otherwise three of the values would test nothing
    assert result.standard_errors[RATIO] < 0.1 * 0.06
