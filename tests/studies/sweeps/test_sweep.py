"""Sweeps: tables independent of the number of workers, stored rows, failed rows, executors."""

import json
import math
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from scenarios.signals.random_road import random_road
from tests.patience import HANG
from tests.studies.sweeps.sweep_samples import Peak, ShortRoad, Worker, grid, threads
from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.runs.car import Car
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED, wave_names
from vehicle.studies.sweeps.case import SignalFile
from vehicle.studies.sweeps.case_keys import case_keys
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.dispatcher import DIED, overdue
from vehicle.studies.sweeps.executors import executor_factory
from vehicle.studies.sweeps.measure import ComfortMeasure
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep import sweep

FRICTION = {"damper.coulomb_friction": [100.0, 125.0]}
ROOT = Path(__file__).parents[3]


def two_by_two(engine="reduced", **changes):
    return grid(FRICTION, [ShortRoad(seed=1, **changes), ShortRoad(seed=2, **changes)], engine=engine)


def in_threads():
    """Return an executor with one worker thread in this process, the fastest executor."""
    return ThreadPoolExecutor(1)


def test_grid_and_table_put_the_cases_in_order():
    cases = grid({"a.b": [1.0, 2.0], "c": ["x"]}, [ShortRoad(name="one"), ShortRoad(name="two")], fixed=["d=4"])
    labels = [f"{name}, d=4, a.b={value}, c=x" for name in ("one", "two") for value in (1.0, 2.0)]
    assert [case.label for case in cases] == labels
    assert cases[1].overrides == ("d=4", "a.b=2.0", "c=x")
    pairs = table_cases(["a", "b"], [(1.0, 2.0), (3.0, 4.0)], [ShortRoad()], engine="mujoco")
    assert [case.overrides for case in pairs] == [("a=1.0", "b=2.0"), ("a=3.0", "b=4.0")]


def test_numbers_are_those_of_the_run():
    source = random_road(rms=5e-4, seed=3, wheel="fr", duration=3.0, lower_band_edge=2.0)
    case = grid({"damper.coulomb_friction": [80.0]}, [source], engine="reduced")
    measure = ComfortMeasure(skip=1.0)
    table = sweep(case, measure, executor=in_threads)
    run = Car.load(None, ["damper.coulomb_friction=80"]).run(source, engine="reduced")
    (swept,) = [result.values for result in table.results]
    values = measure(run)
    assert set(values) == set(swept) == {*measure.units, *wave_names(UNWEIGHTED), *wave_names(WEIGHTED)}
    # A sweep uses a longer time step (`tests/studies/sweeps/test_case_evaluation.py`).
    assert swept["unweighted"] == pytest.approx(values["unweighted"], rel=2e-3)
    rate = 1.0 / run.recording.timestep
    later, limit = run["damper_fr_velocity"][round(rate) : -1], run.car.vehicle.damper.slip_velocity
    assert values["slip_share_fr"] == pytest.approx(float((abs(later) > limit).mean()), abs=1e-12)
    # The first slip refers to the whole run, as in summary.json, with the slip velocity of the share.
    first = run.time[abs(run["damper_fr_velocity"]) > limit][0]
    assert values["first_slip_fr"] == pytest.approx(float(first), abs=1e-12) and first < 1.0
    # Comfort excludes the first second, so it is near but not equal to the comfort of the whole run.
    assert 1e-3 < abs(values["unweighted"] / run.comfort().unweighted.overall - 1.0) < 0.3
    squares = sum(values[f"unweighted_{axis}"] ** 2 for axis in "xyz")
    assert values["unweighted"] == pytest.approx(math.sqrt(squares), rel=1e-12)
    assert 0.0 < values["unweighted_error"] < 0.2
    assert table.results[0].engine == "reduced"


def test_one_and_two_workers_make_the_same_table_bit_for_bit(tmp_path):
    texts = []
    for jobs in (1, 2):
        folder = tmp_path / str(jobs)
        folder.mkdir()
        table = sweep(two_by_two(), ComfortMeasure(skip=0.2), jobs=jobs, folder=folder)
        assert not table.failed
        texts.append((folder / "table.csv").read_bytes())
    assert texts[0] == texts[1]
    lines = texts[0].decode().splitlines()
    assert len(lines) == 5
    assert lines[0].startswith("input,damper.coulomb_friction,unweighted_x [m/s2],")
    assert lines[0].endswith("first_slip_fl [s],engine,failed because")
    assert ",unweighted [m/s2],weighted_x [m/s2]," in lines[0]
    origin = json.loads((tmp_path / "1" / "sweep.json").read_text(encoding="utf-8"))
    assert origin["runs"] == 4 and origin["failed"] == [] and origin["engines_asked"] == ["reduced"]


def test_a_failed_run_is_a_row_with_its_reason():
    cases = grid({"damper.coulomb_friction": [-1.0, 125.0], "solver.record_rate": [1000.0]}, [ShortRoad()])
    table = sweep(cases, Peak(), executor=in_threads)
    bad, good = table.results
    assert "coulomb_friction: found -1.0 N, must be at least 0.0" in bad.reason and not bad.values
    assert not good.reason and good.values["peak"] > 0.0
    assert [case.label for case, _ in table.failed] == [cases[0].label]
    assert math.isnan(table.column("peak")[0]) and table.column("peak")[1] == good.values["peak"]
    with pytest.raises(ConfigurationError, match="no column 'peek'; did you mean peak"):
        table.column("peek")


def test_finished_rows_are_not_computed_again(tmp_path):
    cases = two_by_two()
    seen: list[float] = []
    first = sweep(cases[:2], Peak(), executor=in_threads, folder=tmp_path)
    whole = sweep(cases, Peak(), executor=in_threads, folder=tmp_path, progress=seen.append)
    # Stored rows are finished runs; the other two are one task.
    assert seen == [0.5, 1.0]
    assert [r.values for r in whole.results[:2]] == [r.values for r in first.results]
    assert len((tmp_path / "rows.jsonl").read_text(encoding="utf-8").splitlines()) == 4
    # Another measure has other rows.
    sweep(cases, ComfortMeasure(skip=0.0), executor=in_threads, folder=tmp_path)
    assert len((tmp_path / "rows.jsonl").read_text(encoding="utf-8").splitlines()) == 8


def test_failed_rows_are_kept_or_tried_again(tmp_path):
    cases = grid({"damper.coulomb_friction": [-1.0]}, [ShortRoad()])
    for retry, lines in ((False, 1), (False, 1), (True, 2)):
        sweep(cases, Peak(), executor=in_threads, folder=tmp_path, retry_failed=retry)
        assert len((tmp_path / "rows.jsonl").read_text(encoding="utf-8").splitlines()) == lines


def row_line(key="0" * 20, values='{"peak": 1.0}'):
    return f'{{"key": "{key}", "values": {values}, "engine": "", "reason": "", "seconds": 1.0}}'


DAMAGED = ["{", "[" * 3000 + "]" * 3000, "\0" * 50, row_line(key="0"), row_line(values="{}")]
DAMAGED += [row_line(values=f'{{"peak": {value}}}') for value in ("NaN", "1e999", '"nan"')]


def test_whole_rows_are_taken_and_those_of_a_damaged_line_computed_again(tmp_path, capsys):
    cases, rows = two_by_two()[:2], tmp_path / "rows.jsonl"
    whole = sweep(cases, Peak(), executor=in_threads, folder=tmp_path).text()
    first, second = rows.read_text(encoding="utf-8").splitlines()
    rows.write_text(f"{first}\n{second}"[:-20], encoding="utf-8")
    assert sweep(cases, Peak(), executor=in_threads, folder=tmp_path).text() == whole
    assert len(rows.read_text(encoding="utf-8").splitlines()) == 2 and not capsys.readouterr().err
    rows.write_text("\n".join([first, *DAMAGED, ""]), encoding="utf-8")
    assert sweep(cases, Peak(), executor=in_threads, folder=tmp_path).text() == whole
    assert f"{len(DAMAGED)} damaged rows, the first in line 2 (" in capsys.readouterr().err
    *kept, added = rows.read_text(encoding="utf-8").splitlines()
    assert kept == [first, *DAMAGED] and second.split('"')[3] in added


def test_the_key_tells_car_input_engine_and_measure(tmp_path):
    (case,) = grid({"damper.viscous": [2000.0]}, [ShortRoad()])
    file = tmp_path / "a.csv"
    file.write_text("time [s],displacement [m]\n0,0\n", encoding="utf-8")
    other = tmp_path / "car.toml"
    other.write_bytes((ROOT / "vehicle/model/vehicles/focus/vehicle.toml").read_bytes())
    signal = random_road(rms=1e-4, seed=1, wheel="fr", duration=1.0)
    sources = [ShortRoad(seed=2), SignalFile(path=file, wheel="fr"), signal]
    variants = [case, *grid({"damper.viscous": [2001.0]}, [ShortRoad()])]
    variants += [replace(case, engine="mujoco"), replace(case, vehicle=other)]
    variants += [replace(case, source=source) for source in sources]
    keys = case_keys(variants, Peak())
    assert len(set(keys)) == len(keys)
    assert case_keys([case], Peak()) == keys[:1]
    assert case_keys([case], ComfortMeasure()) != keys[:1]
    other.write_text(other.read_text(encoding="utf-8") + "\n# changed\n", encoding="utf-8")
    file.write_text("time [s],displacement [m]\n0,1\n", encoding="utf-8")
    changed = case_keys(variants, Peak())
    assert [a == b for a, b in zip(keys, changed, strict=True)] == [True, True, True, False, True, False, True]


def test_a_killed_worker_and_a_run_that_hangs_take_nothing_with_them(tmp_path):
    once = ShortRoad(name="once", kill=str(tmp_path / "flag"))
    always = ShortRoad(name="always", kill=str(tmp_path / "flag.always"))
    roads = [ShortRoad(), once, always, ShortRoad(name="hanging", wait=10.0 * HANG), ShortRoad(seed=5)]
    cases, folder = grid({"damper.coulomb_friction": [125.0]}, roads, engine="reduced"), tmp_path / "sweep"
    folder.mkdir()
    limit, reasons = 4.0, [""]
    while reasons != ["", "", DIED, overdue(limit), ""]:  # a busy machine may take any time for the runs that end
        assert limit < HANG, reasons
        limit, settings = 2.0 * limit, {"jobs": 2, "folder": folder, "retry_failed": True}
        reasons = [result.reason for result in sweep(cases, Peak(), time_limit=limit, **settings).results]
        assert DIED not in [*reasons[:2], *reasons[3:]]
    assert len({line.split('"')[3] for line in (folder / "rows.jsonl").read_text(encoding="utf-8").splitlines()}) == 5


SCRIPT = """
from pathlib import Path
from tests.studies.sweeps.sweep_samples import Peak, ShortRoad
from tests.studies.sweeps.sweep_samples import grid
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep import sweep

if __name__ == "__main__":
    roads = [ShortRoad(seed=s, wait=0.2) for s in range(40)]
    cases = grid({"damper.coulomb_friction": [125.0]}, roads, engine="reduced")
    sweep(cases, Peak(), jobs=2, folder=Path(FOLDER))
"""


def running(marker):
    """Return the ids of processes whose environment contains a marker."""
    ids = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if (
                marker.encode() in (folder / "environ").read_bytes()
                and "State:\tZ" not in (folder / "status").read_text()
            ):
                ids.append(int(folder.name))
        except OSError:
            continue
    return ids


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="looks for processes in /proc")
def test_a_killed_sweep_keeps_its_rows_leaves_no_worker_and_goes_on(tmp_path):
    folder, script = tmp_path / "sweep", tmp_path / "study.py"
    folder.mkdir()
    script.write_text(SCRIPT.replace("FOLDER", repr(str(folder))), encoding="utf-8")
    marker = f"SWEEP_TEST={tmp_path}"
    environment = os.environ | {"PYTHONPATH": str(ROOT), "SWEEP_TEST": str(tmp_path)}
    process = subprocess.Popen([sys.executable, str(script)], env=environment)
    rows, patience = folder / "rows.jsonl", time.monotonic() + HANG
    while time.monotonic() < patience and (not rows.exists() or rows.read_bytes().count(b"\n") < 3):
        time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    process.wait()
    patience = time.monotonic() + HANG
    while running(marker) and time.monotonic() < patience:
        time.sleep(0.1)
    assert running(marker) == []
    kept = rows.read_bytes().count(b"\n")
    assert 3 <= kept < 40
    roads, counted = [ShortRoad(seed=s, wait=0.2) for s in range(kept + 1)], list[float]()
    cases = grid({"damper.coulomb_friction": [125.0]}, roads, engine="reduced")
    table = sweep(cases, Peak(), executor=in_threads, folder=folder, progress=counted.append)
    # Two workers finish in any order: at most the submitted tasks and the additional case are missing.
    assert 1 <= len(counted[1:]) <= kept
    assert not table.failed


def test_a_user_defined_executor():
    make = executor_factory("tests.studies.sweeps.sweep_samples:threads")
    table = sweep(two_by_two(), Peak(), executor=make)
    expected = sweep(two_by_two(), Peak(), executor=in_threads)
    assert [r.values for r in table.results] == [r.values for r in expected.results]
    assert isinstance(threads(), ThreadPoolExecutor)


@pytest.mark.parametrize(("text", "message"), [
    ("dusk://host:1", "dask://host:port or module:factory"),
    ("nowhere.at_all:make", "No module named 'nowhere'"),
    ("tests.studies.sweeps.sweep_samples:missing", "has no attribute 'missing'"),
    ("threads", "dask://host:port or module:factory"),
    ("tests.studies.sweeps.sweep_samples:no_executor", r"str .*concurrent\.futures\.Executor"),
])  # fmt: skip
def test_bad_executors(text, message):
    with pytest.raises(ConfigurationError, match=message):
        executor_factory(text)()


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingPartError, match=r"'cluster' \(pip install distributed\)"):
        executor_factory("dask://host:8786")


@pytest.fixture(scope="module")
def cluster():
    """A real scheduler with one worker process."""
    distributed = pytest.importorskip("distributed")
    options: dict[str, Any] = {"dashboard_address": None, "worker_dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=True, **options) as cluster:
        yield cluster


def widened(cluster):
    """Start a second worker process."""
    import distributed

    cluster.scale(2)
    with distributed.Client(cluster.scheduler_address, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=HANG)


def test_a_worker_that_joins_a_running_sweep_is_used(cluster):
    """Another worker starts after the first row."""
    joined: list[float] = []

    def join(fraction):
        if fraction and not joined:
            widened(cluster)
            joined.append(time.time())

    make = executor_factory(cluster.scheduler_address.replace("tcp", "dask"))
    roads = [ShortRoad(seed=seed, wait=0.3) for seed in range(30)]
    table = sweep(grid({"damper.viscous": [2000.0]}, roads, engine="reduced"), Worker(), executor=make, progress=join)
    assert not table.failed
    processes, times = table.column("process"), table.column("time")
    assert len(set(processes)) == 2
    later = max(set(processes), key=lambda process: times[processes == process].min())
    assert times[processes == later].min() > joined[0]


def test_a_dask_cluster_makes_the_same_table(cluster):
    widened(cluster)
    make = executor_factory(cluster.scheduler_address.replace("tcp", "dask"))
    table = sweep(two_by_two(), Peak(), executor=make)
    assert table.text() == sweep(two_by_two(), Peak(), executor=in_threads).text()
    assert not table.failed


def test_a_cluster_without_response_is_named(monkeypatch):
    distributed = pytest.importorskip("distributed")

    def nobody(address, **options):
        raise OSError("Timed out trying to connect")

    monkeypatch.setattr(distributed, "Client", nobody)
    with pytest.raises(ConfigurationError, match=r"dask://nowhere:1: .*Timed out"):
        executor_factory("dask://nowhere:1")()


def test_rows_of_a_sweep_may_have_different_parameters():
    # Presliding in the second row gives the stiffness a meaning there: no message on the first row.
    stiff = {"damper.presliding_stiffness": 5e5}
    plan = plan_sweep(Car.load(), [stiff, {**stiff, "damper.friction_law": "presliding"}], ShortRoad())
    assert [len(case.overrides) for case in plan.cases] == [1, 2] and plan.notes == ()
    (note,) = plan_sweep(Car.load(), [stiff, {"damper.viscous": 2e3, **stiff}], ShortRoad()).notes
    assert "has no effect" in note
