"""Cached and parallel runs of the complete car, and what all of its scenarios share on the command line."""

import dataclasses
import os

import numpy as np
import pytest

from scenarios import car_runs
from scenarios.car_runs import CarRuns
from scenarios.claims import PREDICTED, Findings
from scenarios.signals.bump import bump
from scenarios.study import CarSettings, car_study
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.signal import Signal

SHORT = bump(amplitude=7.5e-3, wheel="fr", duration=1.0, start=0.1)


def test_a_case_is_computed_once_and_overrides_of_the_case_win():
    runs = CarRuns(overrides=["damper.coulomb_friction=75"])
    changed = runs.case(SHORT, ["damper.coulomb_friction=150"])
    first, other, again = runs([runs.case(SHORT), changed, runs.case(dataclasses.replace(SHORT, source="again"))])
    assert first is again
    assert runs([changed])[0] is other
    assert first.car.vehicle.damper.coulomb_friction == 75.0
    assert other.car.vehicle.damper.coulomb_friction == 150.0
    assert np.max(np.abs(first["damper_fr_velocity"])) > np.max(np.abs(other["damper_fr_velocity"]))


def test_another_signal_of_the_same_name_is_another_run():
    runs = CarRuns()
    higher = Signal(time=SHORT.time, displacement={"fr": 1.01 * SHORT.displacement["fr"]}, source=SHORT.source)
    left = Signal(time=SHORT.time, displacement={"fl": SHORT.displacement["fr"]}, source=SHORT.source)
    results = runs([runs.case(signal) for signal in (SHORT, higher, left)])
    assert len({id(run) for run in results}) == 3
    assert results[2].wheel == "fl"


def test_worker_processes_give_the_same_numbers_with_one_thread_each(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    changes = ["damper.viscous=2000"]
    runs = CarRuns(overrides=changes)
    cases = [runs.case(SHORT), runs.case(SHORT, ["damper.coulomb_friction=75"])]
    serial, parallel = runs(cases), CarRuns(overrides=changes, jobs=2)(cases)
    for expected, other in zip(serial, parallel, strict=True):
        assert other.car.vehicle == expected.car.vehicle
        for name, values in expected.recording.channels.items():
            # The same steps of the same program: not one bit differs.
            np.testing.assert_array_equal(other[name], values)
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ


def test_one_process_is_asked_for_where_several_would_not_help(monkeypatch):
    monkeypatch.setattr(car_runs, "process_pool", lambda jobs: pytest.fail("a process for one run"))
    runs = CarRuns(jobs=4)
    assert runs([runs.case(SHORT)])


def findings(runs, folder, settings):
    row = PREDICTED.statement("a statement", "so", "so", True, "because")
    return Findings(title="Example", claims=[row], unjudged={"another": "too short"}, notes=["a note"], data={"n": 1})


def test_the_command_writes_what_was_found_and_what_was_not_judged(tmp_path, capsys):
    folder = tmp_path / "out"
    assert car_study("example", findings, CarSettings)(["--output", str(folder)]) == 0
    text = (folder / "results.md").read_text(encoding="utf-8")
    assert "Not judged here: another: too short." in text
    assert "a note" in text
    assert "1 of 1 predicted rows agree, 1 not judged" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--jobs", "0"], "--jobs 0"),
        (["--set", "damper.viscuos=1"], "viscous"),
        (["--engine", "adams"], "mujoco"),
        (["--vehicle", "no_such.toml"], "no_such.toml"),
    ],
)
def test_wrong_options_are_refused_before_the_folder_is_made(arguments, message, tmp_path, capsys):
    folder = tmp_path / "out"
    assert car_study("example", findings, CarSettings)([*arguments, "--output", str(folder)]) == 2
    assert message in capsys.readouterr().err
    assert not folder.exists()


def test_an_error_of_a_worker_reaches_the_user():
    broken = ("solver.record_rate=333",)
    runs = CarRuns(overrides=broken)
    with pytest.raises(ConfigurationError, match="record_rate"):
        runs([runs.case(SHORT)])
