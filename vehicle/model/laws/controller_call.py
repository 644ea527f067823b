"""Call of a controller FMU in a time step, by the addresses of its functions: see `controller_fmu` for the FMU itself.

At the communication point t_k = k T the FMU gets its sensors, does the communication step from t_k to t_k + T, and
returns the damper coefficient c that holds over this step. T is the control period, a multiple of the time step.

    body_velocity      vb      velocity of the damper end on the body, along the damper [m/s]
    wheel_velocity     vw      likewise on the wheel
    damper_velocity    vb - vw, rate of extension
    body_acceleration  (vb(t_k) - vb(t_k - T)) / T, mean over the last communication step; 0 in the first [m/s2]
    wheel_acceleration likewise of vw

The memory of a controller is an array of 64-bit integers or floats; the constants below are its indices. After a
failed call the controller is not called again in this run, and the last coefficient holds; the engine then raises.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from vehicle.compiler import OPTIONS, jitable, numba_module, stamp
from vehicle.model.laws.function_address import do_step, floats_at, transfer, words_at

SENSORS = ("body_velocity", "wheel_velocity", "damper_velocity", "body_acceleration", "wheel_acceleration")
"""Names of the inputs of a controller FMU, in the order of their values in the memory."""

COEFFICIENT = "coefficient"
"""Name of the output of a controller FMU [N s/m]."""

CALL, SET, STEP, GET, INSTANCE, STATUS, READINGS, COUNT = range(8)
"""Addresses of `controller_step` in compiled form, of functions and instance of the FMU; status of the last call;
finished readings; number of inputs."""
PERIOD, OUTPUT = 8, 9
"""T [s] and the coefficient [N s/m]."""
MEASURED = 10
"""Values of `SENSORS`."""
SOURCES, VALUES = 15, 20
"""Index among `SENSORS`, and value, of each input of the FMU."""
REFERENCES, OUTPUT_REFERENCE = 25, 28
"""Value references, 32 bits each: of the inputs, and of the output."""
RESULTS, SIZE = 29, 33
"""Results of a step, see `do_step`; number of integers."""

WARNING = 1
"""Maximum status of a successful call of FMI."""
NOT_FINITE, TERMINATED = 10, 11
"""Further status: a coefficient that is not a finite number; a controller that ends the simulation."""


@jitable
def controller_step(start: int, body: float, wheel: float) -> float:
    """Return the coefficient of a controller FMU for the next communication step, without limits [N s/m].

    Args:
        start: address of the memory.
        body, wheel: vb and vw [m/s].
    """
    integers, numbers = words_at(start, SIZE), floats_at(start, SIZE)
    if integers[STATUS] > WARNING:
        return float(numbers[OUTPUT])
    period, readings = numbers[PERIOD], integers[READINGS]
    if readings > 0:
        numbers[MEASURED + 3] = (body - numbers[MEASURED]) / period
        numbers[MEASURED + 4] = (wheel - numbers[MEASURED + 1]) / period
    numbers[MEASURED], numbers[MEASURED + 1], numbers[MEASURED + 2] = body, wheel, body - wheel
    for n in range(integers[COUNT]):
        numbers[VALUES + n] = numbers[MEASURED + integers[SOURCES + n]]
    before, instance = numbers[OUTPUT] + 0.0, integers[INSTANCE]
    status = transfer(integers[SET], instance, start + 8 * REFERENCES, integers[COUNT], start + 8 * VALUES)
    if status <= WARNING:
        status = do_step(integers[STEP], instance, readings * period, period, start + 8 * RESULTS)
    if status <= WARNING:
        status = transfer(integers[GET], instance, start + 8 * OUTPUT_REFERENCE, 1, start + 8 * OUTPUT)
    # The comparison is false for NaN too.
    if status <= WARNING and not abs(numbers[OUTPUT]) < 1e300:
        status = NOT_FINITE
    if status <= WARNING and integers[RESULTS + 1] % 256 != 0:
        status = TERMINATED
    if status > WARNING:
        integers[STATUS], numbers[OUTPUT] = status, before
        return float(before)
    integers[READINGS] = readings + 1
    return float(numbers[OUTPUT])


@cache
def compiled_step() -> Any:
    """Return `controller_step` as a C function: compiled alone, it is no part of the functions of the engines."""
    numba, mark = numba_module(), stamp()

    # Closure variables are part of the key of numba's cache.
    def entry(start: int, body: float, wheel: float) -> float:
        return controller_step(start, body, wheel) if mark else 0.0

    return numba.cfunc("float64(int64, float64, float64)", cache=True, **OPTIONS)(entry)
