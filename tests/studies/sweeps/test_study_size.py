"""Memory and disk of sweeps, searches, fits and orders are stated before the first run, and refused if too large."""

import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.studies.sweeps.sweep_samples import ShortRoad, grid
from vehicle import mapped_table
from vehicle.commands import optimise, orders
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.runs.output import run_size
from vehicle.runs.output.run_size import BASE, batch_memory, run_memory
from vehicle.studies.sweeps import study_size
from vehicle.studies.sweeps.measure import ComfortMeasure
from vehicle.studies.sweeps.study_size import KEPT_SIGNALS, SIGNAL, state_size
from vehicle.studies.sweeps.sweep import sweep_cases
from vehicle.studies.sweeps.sweep_settings import RunSettings
from vehicle.studies.tuning.fit_size import state_fit_size

MEASURE = ComfortMeasure()


@pytest.fixture
def machine(monkeypatch):
    """Set the memory, all of it free, and the free disk [byte]."""

    def set_free(*, memory: float = 1e15, disk: float = 1e15) -> None:
        for module in (run_size, study_size):
            monkeypatch.setattr(module, "free_memory", lambda: memory)
        monkeypatch.setattr(run_size, "physical_memory", lambda: memory)
        monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=disk))

    set_free()
    monkeypatch.setattr(run_size, "_said", set())
    return set_free


def roads(*hours: float):
    car = Car.load()
    return [Road("C", 80.0, duration=3600.0 * each).under(car.vehicle, car.overrides) for each in hours]


def cases(*hours: float, engine: str = "reduced", cars: int = 64):
    return grid({"damper.viscous": [1500.0 + each for each in range(cars)]}, roads(*hours), engine=engine)


def state(each, count=64, **settings):
    state_size(each, count, MEASURE, RunSettings(**settings))


def test_memory_follows_length_engine_inputs_and_processes(machine, capsys):
    # 3.6e6 samples; a car of 5 channels at once, as two have more than 64 MiB
    assert batch_memory(3.6e6, 5) == BASE + 3.6e6 * (220.0 + 110.0)
    for engine, expected in [
        ("reduced", batch_memory(3.6e6, 5)),
        ("mujoco", batch_memory(3.6e6, 5, reduced=False)),
        ("auto", batch_memory(3.6e6, 5, reduced=False)),
    ]:
        run_size._said.clear()
        state(cases(1.0, engine=engine)[:1])
        said = capsys.readouterr().err
        assert "64 runs of up to 3.6e+06 samples" in said and f" {expected / 1e9:.2g} GB of memory" in said
        assert said.count("\n") == 1 and "solver.record_rate" in said
    state(cases(1.0, engine="auto")[:1])
    assert capsys.readouterr().err == ""  # once in a process
    state(cases(1.0)[:1], jobs=8)
    assert "on 8 processes need about 11 GB" in capsys.readouterr().err
    state(cases(1.0)[:1], 2, jobs=8)  # six processes have no run
    assert f"need about {(2 * batch_memory(3.6e6, 5) + 6 * BASE) / 1e9:.2g} GB" in capsys.readouterr().err
    hours = [1.0 + 0.1 * number for number in range(KEPT_SIGNALS + 4)]
    each = [cases(hour)[0] for hour in hours]
    kept = SIGNAL * 3.6e6 * sum(hours[-KEPT_SIGNALS:-1])
    state(each)
    assert f"need about {(batch_memory(3.6e6 * hours[-1], 5) + kept) / 1e9:.2g} GB" in capsys.readouterr().err
    # short runs are many cars at once, and say nothing
    state(cases(0.01)[:1])
    assert capsys.readouterr().err == ""


def test_what_exceeds_the_free_memory_is_refused_with_the_processes_that_fit(machine, tmp_path):
    machine(memory=5e9)
    with pytest.raises(ConfigurationError, match=r"10\.9 GB of memory .* 5 GB; .*--jobs 3,"):
        state(cases(1.0)[:1], jobs=8)
    machine(memory=1e9)
    with pytest.raises(ConfigurationError, match=r"1\.36 GB of memory .* 1 GB; .*solver.record_rate"):
        sweep_cases(cases(1.0), MEASURE, RunSettings(folder=tmp_path))
    assert not (tmp_path / "table.csv").exists()


def test_the_case_that_needs_most_counts(machine):
    """Of the rates of a sweep, whatever their order, and of its engines."""
    machine(memory=1e9)
    for rates in (["2000", "200"], ["200", "2000"]):
        runs = grid({"solver.record_rate": rates}, roads(1.0), engine="reduced")
        with pytest.raises(ConfigurationError, match=r"2 runs of up to 7\.2e\+06 samples .* need 2\.55 GB"):
            sweep_cases(runs, MEASURE, RunSettings())
    each = [cases(1.0, engine=engine)[0] for engine in ("mujoco", "reduced")]
    with pytest.raises(ConfigurationError, match=r"need 1\.36 GB"):
        state([*each, grid({"body.mass": ["-1.0"]}, roads(1.0), engine="reduced")[0]])


def test_mujoco_counts_where_its_recording_is_in_memory(machine, capsys, monkeypatch):
    """Of its 64 channels 1.84 GB are recorded, of which a sweep reads five."""
    monkeypatch.setattr(mapped_table, "MAPPED_FROM", float("inf"))
    state(cases(1.0, engine="mujoco")[:1])
    assert " 3.1 GB of memory" in capsys.readouterr().err
    assert run_memory(3.6e6, 5, reduced=False) == batch_memory(3.6e6, 5, reduced=False) > batch_memory(3.6e6, 5)


def test_workers_elsewhere_have_their_own_memory(machine, tmp_path):
    machine(memory=1e9, disk=1e6)
    state(cases(1.0)[:1], executor=ThreadPoolExecutor)
    with pytest.raises(ConfigurationError, match=r"1000 runs need 0\.00174 GB on the disk"):
        state(cases(1.0)[:1], 1000, executor=ThreadPoolExecutor, folder=tmp_path)
    state(cases(1.0)[:1], 1000, executor=ThreadPoolExecutor)  # stores nothing


def test_the_rows_have_the_stated_size(machine, tmp_path, capsys, monkeypatch):
    """From the first byte on."""
    monkeypatch.setattr(run_size, "STATED_FROM", 1.0)
    runs = grid(
        {"damper.viscous": [1500.0, 1600.0, 1700.0, 1800.0]}, [ShortRoad(seed=1), ShortRoad(seed=2)], engine="reduced"
    )
    sweep_cases(runs, MEASURE, RunSettings(folder=tmp_path))
    stated = float(capsys.readouterr().err.partition("memory and ")[2].split()[0]) * 1e9
    written = sum((tmp_path / name).stat().st_size for name in ("rows.jsonl", "table.csv", "differences.csv"))
    assert stated == pytest.approx(written, rel=0.25)  # heads of the tables


@dataclass(frozen=True, kw_only=True, slots=True)
class Raises:
    """Input of a user with a fault."""

    name: str = "raises"

    def signal(self):
        raise ZeroDivisionError

    def identity(self):
        return {"name": self.name}


def test_an_invalid_car_or_input_is_left_to_its_row(machine):
    state(grid({"body.mass": ["-1.0"]}, roads(1.0), engine="reduced")[:1])
    sources: list[Any] = [Raises(), ShortRoad()]
    result = sweep_cases(grid({"damper.viscous": [1500.0]}, sources, engine="reduced"), MEASURE, RunSettings())
    assert [case.source.name for case, _ in result.failed] == ["raises"]


def test_a_search_is_refused_before_its_first_car(machine, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    machine(memory=1e8)
    words = ["--vary", "damper.viscous=1000:2000", "--minimise", "weighted", "--road", "C", "--speed", "80"]
    assert optimise.main([*words, "--duration", "5", "--cars", "8", "--population", "8", "--quiet"]) == 2
    said = capsys.readouterr().err
    assert "8 runs of up to 5e+03 samples in one process need 0.1" in said and "0.1 GB" in said
    assert not (tmp_path / "runs" / "optimise").exists()
    machine(disk=1e3)
    assert optimise.main([*words, "--duration", "5", "--cars", "2000", "--quiet"]) == 2
    assert "on the disk" in capsys.readouterr().err


def test_orders_and_fits_are_refused_before_their_first_run(machine, capsys):
    machine(memory=1e8)
    words = ["--vehicle", "sedan", "--set", "front.imbalance.mass=0.01", "--set", "front.imbalance.radius=0.2"]
    assert orders.main([*words, "--speed", "100:120:10", "--duration", "600"]) == 2
    assert "runs of 600 s need 0.368 GB of memory" in capsys.readouterr().err
    signal = SimpleNamespace(duration=3600.0)
    data = SimpleNamespace(response=np.zeros((2, 1000)))
    measured: Any = SimpleNamespace(signal=signal, target=SimpleNamespace(recorded=("seat_rail_acc_z",), data=data))
    vehicle = Car.load().vehicle
    with pytest.raises(ConfigurationError, match=r"1 measurements of up to 3\.6e\+06 samples need 1\.29 GB of memory"):
        state_fit_size(vehicle, [measured], 3, "mujoco")
    data.response = np.zeros((2, 10**7))  # and 8 (2 * 2e7) (1 + 9) byte of residuals
    with pytest.raises(ConfigurationError, match=r"need 4\.49 GB of memory"):
        state_fit_size(vehicle, [measured], 3, "mujoco")
    measured.signal = None
    state_fit_size(vehicle, [measured], 3, "mujoco")
