"""A damper law of the user's own: a C function by its address, in both engines, a batch and the linear system."""

import ctypes
import sys
import threading
from typing import Any

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.documentation.pages import blocks
from tests.patience import HANG
from vehicle import Car, Road, register_friction, register_law, sweep
from vehicle.engines.reduced.batch_simulation import COARSE_STEP, simulate_batch
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.handover.fmu.fmu_file import write_fmu
from vehicle.model.laws import law_exceptions
from vehicle.model.laws.law_by_address import law_by_address
from vehicle.model.laws.law_exceptions import exceptions_of_laws

ROAD = Road("C", speed=80.0, duration=1.5)
PLATES = random_road(rms=5e-3, seed=3, wheel="fr", duration=1.5)
OBSERVED = ("seat_rail_acc_z", "damper_rl_force", "damper_fr_force", "damper_fr_velocity")
STRIBECK = {"front.damper.friction_law": "stribeck", "front.damper.stribeck_friction": 150.0}
SOFT, HARD, KNEE = 1500.0, 4500.0, 0.05
DEGRESSIVE = {
    "front.damper.viscous_law": "degressive",
    "front.damper.viscous": SOFT,
    "front.damper.degressive_viscous": HARD,
    "front.damper.degressive_velocity": KNEE,
}
LAW = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)


@LAW
def line(memory, x, v):
    return 2250.0 * v


@LAW
def degressive(memory, x, v):
    return SOFT * v + (HARD - SOFT) * min(KNEE, max(-KNEE, v))


@LAW
def zoned(memory, x, v):
    return 2250.0 * v * (1.0 + min((x / 0.01) ** 2, 4.0))


@LAW
def broken(memory, x, v):
    return 2250.0 * v if abs(v) < 0.05 else float("nan")


for word, function in (("line", line), ("degressive", degressive), ("zoned", zoned), ("broken", broken)):
    register_law(word, function)


def car_with(function=None, **more):
    changes = {"front.damper.viscous": 2250.0} | more
    return Car.load("focus_road", changes | ({"front.damper.function": function} if function else {}))


def distance(run, other):
    """Largest rms of a difference over the rms of the channel."""
    return max(float(np.std(run[name] - other[name]) / np.std(other[name])) for name in OBSERVED)


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_line_by_address_is_the_same_run(engine):
    own, outside = (car_with(word, **STRIBECK).run(ROAD, engine=engine, skip=0.5) for word in (None, "line"))
    for name in OBSERVED:
        np.testing.assert_allclose(outside[name], own[name], rtol=0.0, atol=1e-12 * np.ptp(own[name]), err_msg=name)


def reduced(car, step):
    """Run of a car on plates by the reduced engine."""
    return simulate_reduced(car.poles, PLATES, step=step, channels=OBSERVED, **numbers_of(car))


def numbers_of(car):
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    return {"dampers": laws, "record_rate": car.vehicle.solver.record_rate, "tyre_load": car.static.tyre_load}


def test_a_batch_with_a_line_by_address():
    own, outside = car_with(None, **STRIBECK), car_with("line", **STRIBECK)
    numbers = [numbers_of(car) for car in (outside, own, outside)]
    batch = simulate_batch(
        [car.poles for car in (outside, own, outside)],
        PLATES,
        dampers=[each["dampers"] for each in numbers],
        tyre_load=[each["tyre_load"] for each in numbers],
        record_rate=numbers[0]["record_rate"],
        channels=OBSERVED,
    )
    expected = reduced(own, COARSE_STEP)
    for name in OBSERVED:
        for car in (0, 2):
            found = batch.channels[name][car]
            np.testing.assert_allclose(found, expected[name], rtol=0.0, atol=1e-12 * np.ptp(expected[name]))


def test_a_curve_by_address_converges_with_second_order():
    """The linear systems have other slopes, 4500 and 1500 N s/m, so the runs agree for short steps only."""
    own, outside = car_with(None, **DEGRESSIVE), car_with("degressive")
    assert law_by_address("degressive").viscous == HARD
    assert outside.matrices.viscous[0] == pytest.approx(HARD, rel=1e-14) != own.matrices.viscous[0]
    coarse, fine = (distance(reduced(outside, step), reduced(own, step)) for step in (2e-4, 5e-5))
    assert coarse < 2e-3 and fine < coarse / 8.0  # 16 without the kinks
    assert distance(reduced(car_with(), 2e-4), reduced(own, 2e-4)) > 0.1
    mujoco = [car.run(ROAD, engine="mujoco", skip=0.5) for car in (outside, own)]
    assert distance(*mujoco) < 1e-3


def test_a_force_over_displacement_and_velocity():
    """The engines have only the function in common; a linear car differs by far more."""
    car = car_with("zoned")
    both = [car.run(ROAD, engine=engine, skip=0.5) for engine in ("reduced", "mujoco")]
    plain = car_with().run(ROAD, engine="mujoco", skip=0.5)
    assert distance(*both) < 0.2 * distance(plain, both[1])


def test_a_friction_limit_and_a_stop_stay():
    limits = {"front.damper.coulomb_friction": 200.0, "front.damper.gas_force": 150.0}
    own, outside = (car_with(word, **limits).run(ROAD, engine="mujoco", skip=0.5) for word in (None, "line"))
    np.testing.assert_array_equal(outside["damper_fr_force"], own["damper_fr_force"])


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_force_that_is_no_number_ends_the_run(engine):
    with pytest.raises(SimulationError, match=r"finite|is nan m/s2"):
        car_with("broken").run(ROAD, engine=engine, skip=0.5)


def raising(memory, x, v):
    if abs(v) > 0.05:
        raise ValueError("no point above 0.05 m/s")
    return 2250.0 * v


def dividing(memory, x, v):
    return 2250.0 * v / (abs(v) < 0.05)


def worded(memory, x, v):
    return 2250.0 * v if abs(v) < 0.05 else "2250"


RAISING: dict[str, tuple[Any, str]] = {
    "raising": (raising, "ValueError: no point above 0.05 m/s"),
    "dividing": (dividing, "ZeroDivisionError: "),
    "worded": (worded, "TypeError: must be real number, not str"),
}
KEPT = {word: LAW(function) for word, (function, _) in RAISING.items()}


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
@pytest.mark.parametrize("word", RAISING)
def test_an_exception_in_a_law_ends_the_run(word, engine, capfd):
    register_law(word, KEPT[word])
    with pytest.raises(SimulationError) as raised:
        car_with(word).run(ROAD, engine=engine, skip=0.5)
    assert f"damper law '{word}': the function raises {RAISING[word][1]}" in str(raised.value)
    assert "the run is discarded" in str(raised.value)
    assert capfd.readouterr().err == ""


def test_an_exception_in_a_law_ends_its_runs_of_a_sweep(capfd):
    register_law("raising", KEPT["raising"])
    ride = Road("C", speed=80.0, duration=3.0)
    table = sweep(car_with(), {"front.damper.function": ["line", "raising"]}, ride, engine="reduced", jobs=1)
    ((case, reason),) = table.failed
    assert "raising" in str(case) and "damper law 'raising': the function raises ValueError" in reason
    assert np.isfinite(table.column("unweighted")[0])
    assert capfd.readouterr().err == ""


def test_an_exception_in_a_friction_law_ends_the_run():
    def limit(memory, friction, v):
        if 0.03 < abs(v) < 0.09:
            raise KeyError("v")
        return friction

    function = LAW(limit)
    register_friction("raising", function)
    for engine in ("reduced", "mujoco"):
        with pytest.raises(SimulationError, match=r"friction law 'raising': the function raises KeyError: 'v'"):
            car_with("line", **{"front.damper.friction_function": "raising"}).run(ROAD, engine=engine, skip=0.5)


def test_exceptions_belong_to_the_laws_of_their_own_thread(monkeypatch):
    """Two overlapping blocks: each has its own exception, and a callback that is no law goes to the hook of before."""
    # Without the laws by address of other tests: the function of an address cannot be told from a callback.
    monkeypatch.setattr(law_exceptions, "FUNCTIONS", {"damper law 'raising'": KEPT["raising"]})
    begun, ended, hook = threading.Event(), threading.Event(), sys.unraisablehook
    said: list[Any] = []

    def other():
        with exceptions_of_laws():
            begun.set()
            ended.wait(HANG)

    sys.unraisablehook = before = said.append
    try:
        thread = threading.Thread(target=other)
        thread.start()
        assert begun.wait(HANG)
        with exceptions_of_laws():
            LAW(lambda memory, x, v: 1 / 0)(0, 0.0, 0.0)
        assert len(said) == 1
        with (
            pytest.raises(SimulationError, match=r"^damper law 'raising': the function raises ValueError"),
            exceptions_of_laws(),
        ):
            KEPT["raising"](0, 0.0, 0.06)
        ended.set()
        thread.join()
        assert sys.unraisablehook is before and len(said) == 1
    finally:
        sys.unraisablehook = hook
        ended.set()


def test_laws_that_are_refused():
    def refused(name, force, match):
        with pytest.raises(ConfigurationError, match=match):
            register_law(name, LAW(force))

    refused("spring", lambda memory, x, v: 2000.0 * v + 1e4 * x, "must be zero at every displacement")
    refused("motor", lambda memory, x, v: -2000.0 * v, "falls with velocity, by 2000 N s/m")
    refused("nothing", lambda memory, x, v: float("nan"), "not a finite number")
    refused("memory", lambda x, v: 2000.0 * v, r"'memory': the function raises TypeError: .* but 3 were given")
    refused("none", lambda memory, x, v: None, "TypeError: must be real number, not NoneType")
    refused("two words", lambda memory, x, v: v, "a name must consist of letters")
    refused("line", lambda memory, x, v: 1.0 * v, "belongs to another function")
    assert register_law("line", line).viscous == 2250.0  # the same again
    for wrong in ("text", 0, True, print):
        with pytest.raises(ConfigurationError, match="without an address"):
            register_law("wrong", wrong)
    with pytest.raises(ConfigurationError, match=r"'missing': is not registered in this process \(registered: line"):
        car_with("missing").run(ROAD, engine="reduced", skip=0.5)
    with pytest.raises(ConfigurationError, match=r"damper\.function: found 'line' with control\.law = sky"):
        car_with("line", **{"front.damper.control.law": "skyhook"})


def test_an_fmu_does_not_contain_it(tmp_path):
    with pytest.raises(ConfigurationError, match=r"function: found the Python function 'line'"):
        write_fmu(car_with("line"), tmp_path / "car.fmu")


def test_the_example_of_numba():
    """The page shows it without running it: this package does not need numba."""
    pytest.importorskip("numba")
    (block,) = (text for text in blocks("docs/howto/add/own-law.md", "text") if "numba" in text)
    names: dict[str, object] = {}
    exec(compile(block, "own-law.md", "exec"), names)
    found = law_by_address("jitted")
    assert found.viscous == pytest.approx(4500.0) and found.force(1.0) == pytest.approx(1650.0)


def test_a_sweep_with_one_job_knows_the_law():
    ride = Road("C", speed=80.0, duration=3.0)
    table = sweep(car_with("degressive"), {"body.mass": [1250.0, 1350.0]}, ride, engine="reduced")
    alone = [car_with("degressive", **{"body.mass": mass}).run(ride, engine="reduced") for mass in (1250.0, 1350.0)]
    expected = [run.comfort().unweighted.overall for run in alone]
    # Cars of a table march together in single precision.
    assert table.column("unweighted") == pytest.approx(expected, rel=1e-3)  # steps of 0.5 ms: 0.05 %
