"""State of the bench without a browser: settings, changes, A and B, faulty cars, latest request."""

import json
import math
import threading
import time

import pytest

from tests.patience import HANG
from vehicle import road
from vehicle.errors import ConfigurationError
from vehicle.handover.bench.drive import bench_drive
from vehicle.handover.bench.results import write_car, write_comparison, write_run
from vehicle.handover.bench.setting import settings
from vehicle.handover.bench.state import BenchState, LatestOnly
from vehicle.runs.car import Car

FRICTION = "front.damper.coulomb_friction"


@pytest.fixture(scope="module")
def bench(car, drive):
    return BenchState(car, drive)


@pytest.fixture
def state(bench, monkeypatch):
    """State of the unchanged car, with the message and the car A of the beginning."""
    bench.reset()
    assert bench.update()
    bench.keep()
    return bench


def test_settings_are_numbers_and_components_with_their_ranges(state):
    friction, tyre, top = (
        state.setting(path) for path in (FRICTION, "front.bushings.tyre.stiffness.z", "front.hardpoints.strut_top.z")
    )
    assert (friction.low, friction.value, friction.high, friction.unit) == (0.0, 125.0, 500.0, "N")
    assert tyre.value == state.car["front.bushings.tyre.stiffness"].value[2]
    assert tyre.high == float(f"{4.0 * tyre.value:.2g}")  # an end that can be read
    assert top.high - top.value == pytest.approx(0.05, abs=1e-4) == top.value - top.low
    for setting in state.settings.values():
        assert setting.low <= setting.value <= setting.high and 0.0 < setting.step < setting.high - setting.low
    assert not [path for path in state.settings if path.rpartition(".")[2] in ("table", "friction_law", "name")]
    # The solver has no effect on the numbers of the reduced engine.
    assert not [path for path in state.settings if path.startswith("solver.")]


def test_a_zero_has_a_range_of_a_usual_size(car):
    found = settings(car)
    damping, mount = (found[f"front.bushings.suspension_mount.{end}.z"] for end in ("damping", "friction_force"))
    assert (damping.low, damping.value, damping.high) == (0.0, 0.0, 2000.0)
    assert (mount.low, mount.value, mount.high) == (0.0, 0.0, 500.0)


@pytest.mark.parametrize(
    "path",
    [
        *("front.parts.knuckle.inertia.z", "body.inertia.ixx", "front.parts.a_arm.products.x"),
        *("front.parts.suspension_mount.inertia.z", "body.inertia.izx"),
    ],
)
def test_a_slider_ends_where_the_car_cannot_be_built(state, path):
    whole, setting = state.settings[path], state.setting(path)
    assert whole.low <= setting.low < setting.high <= whole.high and setting.high - setting.low < whole.high - whole.low
    for share in (0.0, 1.0):
        state.reset()
        state.change(path, setting.low + share * (setting.high - setting.low))
        assert state.update(), state.message
    margin = 0.03 * (whole.high - whole.low)
    beyond = [end for end in (setting.low - margin, setting.high + margin) if whole.low <= end <= whole.high]
    refused = []
    for value in beyond:
        try:
            state.car.with_([f"{path}={value!r}"]).static  # noqa: B018
        except ConfigurationError:
            refused.append(value)
    assert refused, "the range is narrower than the car allows"
    with pytest.raises(ConfigurationError, match="must be"):
        state.change(path, refused[0])


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("engine.bushings.hydromount.friction_force.z", r"friction_stroke\.z: found 0\.0 m"),
        # A thin rod: its two large moments differ by less than the third.
        ("front.parts.steering_rod.inertia.x", "sum of the two smaller"),
    ],
)
def test_a_number_of_which_no_other_value_is_possible_has_no_slider(state, path, reason):
    with pytest.raises(ConfigurationError, match=reason):
        state.setting(path)


def test_search_finds_words_in_path_or_meaning(state):
    assert state.search("FRONT coulomb") == [FRICTION]
    assert "front.hardpoints.strut_top.x" in state.search("strut_top")
    assert state.search("no such words") == []
    assert len(state.search("")) == 50


def test_values_outside_the_slider_and_unknown_paths_are_refused(state):
    for value in (math.nan, math.inf, -math.inf, 1e300, -1.0, 500.1):
        with pytest.raises(ConfigurationError, match=r"coulomb_friction: found .* 0 to 500 N"):
            state.change(FRICTION, value)
    for path in ("body", "__class__", "x" * 1000, ""):
        with pytest.raises(ConfigurationError, match="path of a number"):
            state.change(path, 1.0)
    assert state.changes == {}


def test_changes_give_the_numbers_of_the_changed_car(car, state):
    unchanged = state.present[1].table
    state.change(FRICTION, 60.0)
    assert state.update() and state.message == ""
    assert state.present[0].overrides == (f"{FRICTION}=60.0",)
    table = state.present[1].table
    loaded = car.with_({FRICTION: 60.0}).run(state.drive.record, engine="reduced").comfort()
    assert table["comfort unweighted"][0] == pytest.approx(loaded.unweighted.overall, rel=1e-9)
    name, a, b, unit = state.rows()[0]
    assert (name, unit) == ("comfort unweighted", "m/s2")
    assert (a, b) == (unchanged[name][0], table[name][0]) and b < 0.95 * a
    state.keep()
    assert all(row[1] == row[2] for row in state.rows())
    state.change(FRICTION, 125.0)
    assert state.changes == {}
    assert state.update() and state.present[1].table == unchanged


def test_the_speed_of_the_road_has_no_slider(state):
    assert "driving.speed" in state.settings
    rolling = Car.load("focus_road")
    on_road = BenchState(rolling, bench_drive(rolling, road("cleat:20x50", 30)))
    assert "driving.speed" not in on_road.settings and on_road.car["driving.speed"].value == pytest.approx(30 / 3.6)


def test_geometry_is_a_setting_too(state):
    state.change("front.hardpoints.strut_top.y", state.setting("front.hardpoints.strut_top.y").value + 0.02)
    before = state.present[1].table
    assert state.update(), state.message
    assert state.present[1].table != before


def test_a_car_that_cannot_be_computed_keeps_the_last_numbers(state, monkeypatch):
    before = state.present
    state.change(FRICTION, 60.0)
    for error in (ConfigurationError("unstable: 3 Hz"), FloatingPointError("overflow"), RuntimeError("any other")):

        def fails(car, drive, measure, error=error):
            raise error

        with monkeypatch.context() as patch:
            patch.setattr("vehicle.handover.bench.state.numbers", fails)
            assert not state.update()
        assert state.present is before and str(error) in state.message
    assert state.update() and state.message == ""


def test_requests_during_a_computation_become_one():
    values, computed, first, free = [0], [], threading.Event(), threading.Event()

    def job():
        first.set()
        assert free.wait(HANG)
        computed.append(values[-1])

    worker = LatestOnly(job)
    for value in range(60):
        values.append(value)
        worker.request()
        assert first.wait(HANG)
    assert worker.pending
    free.set()
    late = time.monotonic() + HANG
    while worker.runs < 2 and time.monotonic() < late:
        time.sleep(0.01)
    worker.stop()
    assert computed == [59, 59] and worker.runs == 2


def test_the_written_vehicle_file_is_the_shown_car(state, tmp_path):
    state.change(FRICTION, 60.0)
    assert state.update()
    paths = [write_car(state, tmp_path) for _ in range(2)]
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == ["car/vehicle.toml", "car-2/vehicle.toml"]
    assert Car.load(paths[0])[FRICTION].value == 60.0


def test_files_of_a_moved_point_on_an_obstacle(tmp_path):
    car = Car.load("focus_road")
    state = BenchState(car, bench_drive(car, road("cleat:20x50", 30)))
    top = "front.hardpoints.strut_top.z"
    state.change("front.damper.viscous", 1500.0)
    assert state.update()
    state.keep()
    state.change(top, state.setting(top).value + 0.03)
    assert state.update(), state.message
    written = Car.load(write_car(state, tmp_path))
    assert written[top.removesuffix(".z")].value[2] == pytest.approx(1.26)
    assert written["front.damper.viscous"].value == 1500.0
    again = written.run(road("cleat:20x50", 30, duration=state.drive.record.duration), engine="reduced")
    shown = state.present[1]
    assert again.comfort().unweighted.overall == pytest.approx(shown.table["comfort unweighted"][0], rel=1e-6)
    summary = json.loads((write_run(state, tmp_path) / "summary.json").read_text(encoding="utf-8"))
    assert summary["obstacle"]["vdv"]["seat_rail"]["overall"] == pytest.approx(shown.table["VDV seat rail"][0])
    report = write_comparison(state, tmp_path).read_text(encoding="utf-8")
    assert "strut_top" in report and "cleat" in report
    names = sorted(path.name for path in tmp_path.iterdir() if not path.name.startswith("."))
    assert names == ["car", "report.html", "run"]
