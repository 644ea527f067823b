"""A control law of the user's own: a C function by its address, here one of ctypes, in both engines."""

import ctypes
from contextlib import contextmanager

import numpy as np
import pytest

from vehicle.core.records import packed
from vehicle.engines.reduced import group_run
from vehicle.engines.simulation import stepping
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

ROAD = Road("A", speed=80.0, duration=2.2)
OBSERVED = ("seat_rail_acc_z", "damper_rl_force", "damper_fr_coefficient")
SKY = 3000.0


@ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)  # type: ignore[untyped-decorator]
def skyhook(memory: int | None, body: float, wheel: float) -> float:
    """Coefficient c_sky vb / (vb - vw) without limits, which the damper sets; counts its calls in its memory."""
    calls = ctypes.c_int64.from_address(memory or 0)
    calls.value += 1
    return SKY * body / (body - wheel) if body != wheel else 0.0


# Accelerations of MuJoCo are second differences of positions at 1 kHz: 1e-15 m of round-off is 1e-9 m/s2.
@pytest.mark.parametrize(("engine", "rounding"), [("reduced", 1e-10), ("mujoco", 4e-9)])
def test_a_function_of_ctypes_equals_the_own_law(monkeypatch, engine, rounding):
    values = {"law": "skyhook", "skyhook_damping": SKY, "control_period": 0.002, "delay": 0.004}
    car = Car.load("focus_road", {f"{a}.damper.control.{n}": v for a in ("front", "rear") for n, v in values.items()})
    own = car.run(ROAD, engine=engine, channels=OBSERVED)
    calls = ctypes.c_int64(0)
    function = ctypes.cast(skyhook, ctypes.c_void_p).value
    call = packed("Call", {"function": function, "memory": ctypes.addressof(calls)})

    @contextmanager
    def with_own_law(laws, dampers, timestep):
        laws["controller"] = call.address
        yield lambda: None
        laws["controller"] = 0.0

    for module in (group_run, stepping):
        monkeypatch.setattr(module, "controllers", with_own_law)
    outside = car.run(ROAD, engine=engine, channels=OBSERVED)
    assert calls.value > 4 * 1000  # four dampers, a reading every 2 ms
    assert np.ptp(own["damper_fr_coefficient"]) > 2000.0
    for name in OBSERVED:
        np.testing.assert_allclose(outside[name], own[name], rtol=0.0, atol=rounding * np.ptp(own[name]), err_msg=name)
