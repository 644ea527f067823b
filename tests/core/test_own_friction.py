"""A friction law of the user's own: a C function by its address, in both engines, a batch and the laws of arrays."""

import ctypes
import math

import numpy as np
import pytest

from tests.core.test_own_law import LAW, OBSERVED, PLATES, ROAD, numbers_of, reduced
from vehicle import Car, register_friction
from vehicle.engines.reduced.batch_simulation import COARSE_STEP, simulate_batch
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.handover.fmu.fmu_file import write_fmu
from vehicle.model.laws.damper import damper_law

STATIC, SLIDING, VELOCITY, EXPONENT = 160.0, 90.0, 0.05, 1.5
STRIBECK = {
    "front.damper.friction_law": "stribeck",
    "front.damper.stribeck_friction": STATIC,
    "front.damper.stribeck_velocity": VELOCITY,
    "front.damper.stribeck_exponent": EXPONENT,
}


@LAW
def coulomb(memory, friction, v):
    return friction


@LAW
def stribeck(memory, friction, v):
    calls = ctypes.c_int64.from_address(memory)
    calls.value += 1
    return friction + (STATIC - friction) * math.exp(-((abs(v) / VELOCITY) ** EXPONENT))


@LAW
def broken(memory, friction, v):
    return friction if v < 0.05 or v >= 0.1 else float("nan")


CALLS = ctypes.c_int64(0)
register_friction("coulomb", coulomb)
register_friction("stribeck", stribeck, ctypes.addressof(CALLS))
register_friction("broken", broken)


def car_with(function=None, **more):
    changes = {"front.damper.coulomb_friction": SLIDING} | more
    return Car.load("focus_road", changes | ({"front.damper.friction_function": function} if function else {}))


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_constant_limit_is_the_same_run(engine):
    own, outside = (car_with(word).run(ROAD, engine=engine, skip=0.5) for word in (None, "coulomb"))
    for name in OBSERVED:
        np.testing.assert_array_equal(outside[name], own[name], err_msg=name)


# The core's exponential and that of Python differ in their last digits; accelerations of MuJoCo are second differences.
@pytest.mark.parametrize(("engine", "rounding"), [("reduced", 1e-10), ("mujoco", 1e-7)])
def test_stribeck_by_address_is_the_law_of_the_core(engine, rounding):
    before = CALLS.value
    runs = [car.run(ROAD, engine=engine, skip=0.5) for car in (car_with(None, **STRIBECK), car_with("stribeck"))]
    assert CALLS.value > before + 2 * 1500
    for name in OBSERVED:
        expected = runs[0][name]
        np.testing.assert_allclose(runs[1][name], expected, rtol=0.0, atol=rounding * np.ptp(expected), err_msg=name)
    plain = car_with().run(ROAD, engine=engine, skip=0.5)
    assert np.ptp(plain["damper_fr_force"] - runs[0]["damper_fr_force"]) > 50.0


def test_a_batch_in_single_precision_has_it():
    cars = [car_with("stribeck"), car_with("stribeck"), car_with("coulomb")]
    numbers = [numbers_of(car) for car in cars]
    batch = simulate_batch(
        [car.poles for car in cars],
        PLATES,
        dampers=[each["dampers"] for each in numbers],
        tyre_load=[each["tyre_load"] for each in numbers],
        record_rate=numbers[0]["record_rate"],
        channels=OBSERVED,
    )
    for index, car in enumerate((car_with(None, **STRIBECK), car_with(None, **STRIBECK), car_with())):
        expected = reduced(car, COARSE_STEP)
        for name in OBSERVED:
            found = batch.channels[name][index]
            assert np.std(found - expected[name]) < 1e-4 * np.std(expected[name]), (index, name)


def test_arrays_have_it():
    """Force and slope in the smooth form, which the equivalent damping of a damper at rest is."""
    own, outside = (
        damper_law(car.vehicle.composition.dampers[0].law) for car in (car_with(None, **STRIBECK), car_with("stribeck"))
    )
    v = np.array([-0.3, -0.01, 0.0, 1e-4, 0.02, 0.1])
    np.testing.assert_allclose(outside.force(v), own.force(v), rtol=1e-12)
    np.testing.assert_allclose(outside.slope(v), own.slope(v), rtol=1e-6, atol=1e-4 * np.max(own.slope(v)))


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_limit_that_is_no_number_ends_the_run(engine):
    with pytest.raises(SimulationError, match=r"finite|is nan m/s2"):
        car_with("broken").run(ROAD, engine=engine, skip=0.5)


def test_laws_that_are_refused(tmp_path):
    for force, match in ((lambda *_: -1.0, "found a limit of -1 N at 0 m/s"), (lambda *_: math.inf, "must be finite")):
        with pytest.raises(ConfigurationError, match=match):
            register_friction("wrong", LAW(force))
    with pytest.raises(ConfigurationError, match="belongs to another function"):
        register_friction("coulomb", stribeck)
    assert register_friction("coulomb", coulomb).limit(70.0, 0.2) == 70.0  # the same again
    with pytest.raises(ConfigurationError, match=r"'missing': is not registered in this process \(registered: coulomb"):
        car_with("missing").run(ROAD, engine="reduced", skip=0.5)
    with pytest.raises(ConfigurationError, match="with friction_law = stribeck; it replaces"):
        car_with("coulomb", **STRIBECK)
    with pytest.raises(ConfigurationError, match=r"friction_function: found the Python function 'coulomb'"):
        write_fmu(car_with("coulomb"), tmp_path / "car.fmu")
