"""Numbers of a car and its plates for the script of a page, which runs the car with the module of the FMU runtime.

The module is the C runtime of `vehicle.runs.fmu` as WebAssembly, the numbers of the car are those of its FMU. Friction
limits, Stribeck parameters and level are exact; a factor on the damper curve acts as a force beside the fixed poles.
"""

from __future__ import annotations

import base64
import dataclasses
import json
import zlib
from collections.abc import Sequence
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.group_run import time_steps
from vehicle.engines.reduced.reduced_run import LONGEST_STEP
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS
from vehicle.errors import ConfigurationError
from vehicle.names import AXES, axle_and_side, is_wheel
from vehicle.runs.fmu.car_numbers import PARAMETERS, CarNumbers, car_numbers
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.excitation.signal import Signal

if TYPE_CHECKING:
    from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]

LONGEST = 30.0
"""Maximum length of the record in the page [s]."""

POINT = "seat_rail"
"""Output point of the comfort values."""

LEVELS = 32767
"""Maximum integer of a plate displacement in the page: steps of 1/32767 of its peak, 90 dB below it."""

SCALES = (0.25, 4.0)
"""Range of the factor on the level of the input."""

CURVE_SCALES = (0.6, 2.0)
"""Range of the factor on the damper curve, within which it is exact to 0.1 %."""

FRICTION = {
    "coulomb_friction": ("Coulomb friction", 300.0),
    "static_friction": ("static friction (Stribeck)", 400.0),
    "stribeck_velocity": ("Stribeck velocity", 0.2),
    "stribeck_exponent": ("Stribeck exponent", 4.0),
}
"""Parameters with a slider: words, and usual end of the range, which is larger for a car with larger values."""

WORKER = "trial_worker.js"
"""Script of the numbers, which the page runs in a worker."""


def page_signal(signal: Signal) -> Signal:
    """Return a plate signal as the page has it: at most `LONGEST` seconds, from the height of the first sample.

    Displacements are rounded to `LEVELS` steps of the peak.

    Args:
        signal: displacement of the plates.
    """
    count = min(signal.time.size, round(LONGEST / signal.timestep) + 1)
    rounded = {wheel: _integers(z[:count] - z[0]) for wheel, z in signal.displacement.items()}
    return dataclasses.replace(
        signal,
        time=signal.time[:count],
        displacement={wheel: (step * integers).astype(np.float64) for wheel, (integers, step) in rounded.items()},
    )


def trial_data(car: Car, signal: Signal, *, wheel: str, skip: float = 0.0, road_class: str | None = None) -> str:
    """Return the numbers of a car and its plates for the script of a page, as JSON.

    Args:
        car: the car.
        signal: displacement of the plates at the record rate of the car.
        wheel: wheel whose plate excites the FRF in the page, and whose damper the page shows.
        skip: excluded time at the beginning [s].
        road_class: class of the road of ISO 8608 under the car; None for another input.

    Raises:
        ConfigurationError: the reduced engine or the C runtime cannot take the car, or the input (see `_require`).
    """
    _require(car, signal, skip)
    names = [damper.name for damper in car.vehicle.composition.dampers]
    channels = [f"{POINT}_acc_{axis}" for axis in AXES]
    histories = [f"{name}_{quantity}" for name in names for quantity in ("velocity", "force")]
    _, every = time_steps(signal, car.vehicle.solver.record_rate, LONGEST_STEP)
    numbers = car_numbers(car, [*channels, *histories], signal.timestep / every)
    outputs = {output.name: index for index, output in enumerate(numbers.outputs)}
    contact = application("seat")
    data: dict[str, Any] = {
        "module": _text(_module()),
        "car": _text(numbers.content),
        "interval": signal.timestep,
        "samples": min(signal.time.size, round(LONGEST / signal.timestep) + 1),
        "skip": round(skip / signal.timestep),
        "plates": _plates(signal, numbers.plates),
        "plateCount": len(numbers.plates),
        "excited": numbers.plates.index(wheel),
        "frf": road_class is None and sum(bool(np.any(z)) for z in signal.displacement.values()) == 1,
        "parameters": np.asarray(numbers.parameters).tolist(),
        "names": list(PARAMETERS),
        "positions": [outputs[f"{POINT}_displacement_{axis}"] for axis in AXES],
        "dampers": [
            {
                "name": _words(name),
                "velocity": outputs[f"{name}_velocity"],
                "force": outputs[f"{name}_force"],
                "slip": damper.law.slip_velocity,
            }
            for name, damper in zip(names, car.vehicle.composition.dampers, strict=True)
        ],
        "shown": next((index for index, name in enumerate(names) if name == f"damper_{wheel}"), 0),
        "derivative": WEIGHTS.tolist(),
        "ahead": AHEAD,
        "weightings": [_finite(dataclasses.asdict(weighting(name))) for name in contact.weightings],
        "factors": list(contact.comfort_factors),
        "sliders": _sliders(car, numbers, road_class),
        "roadClass": road_class,
    }
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


def script(name: str) -> str:
    """Return the text of a script of this package."""
    return resources.files("vehicle.runs.trial").joinpath(name).read_text(encoding="utf-8")


def _require(car: Car, signal: Signal, skip: float) -> None:
    """Check that the page can run a car on its plates.

    Raises:
        ConfigurationError: the car is unstable for the reduced engine, lacks the seat rail, or the input has another
            rate than the record, slopes of its own, or ends before the evaluation begins.
    """
    car.check("reduced")
    car.vehicle.require_channels([f"{POINT}_acc_{axis}" for axis in AXES], car.vehicle.acceleration_channels)
    if signal.slope_velocity or abs(signal.timestep * car.vehicle.solver.record_rate - 1.0) > 1e-6:
        raise ConfigurationError("trial: the input must be heights of the plates at the record rate")
    if min(signal.duration, LONGEST) < skip + 5.0:
        raise ConfigurationError(f"trial: found {signal.duration:g} s, must be at least {skip + 5.0:g} s")


def _module() -> bytes:
    """Return the WebAssembly module, built by tools/fmu_runtime.py."""
    return resources.files("vehicle.runs.fmu").joinpath("binaries/wasm32/car.wasm").read_bytes()


def _text(content: bytes) -> str:
    """Return compressed bytes as text (deflate, base64)."""
    return base64.b64encode(zlib.compress(content, 9)).decode()


def _finite(record: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters of a weighting with None for infinite frequencies, which JSON lacks."""
    return {name: None if value == np.inf else value for name, value in record.items()}


def _integers(values: Vector) -> tuple[npt.NDArray[np.int16], float]:
    """Return displacements as integers, and the step of the integers [m]."""
    step = float(np.max(np.abs(values))) / LEVELS or 1.0
    return np.rint(values / step).astype("<i2"), step


def _plates(signal: Signal, wheels: Sequence[str]) -> list[dict[str, Any]]:
    """Return the plates that move: index, step [m], and second differences of the integers modulo 2^16."""
    count = min(signal.time.size, round(LONGEST / signal.timestep) + 1)
    plates = []
    for wheel, z in signal.displacement.items():
        if np.any(z[:count] != z[0]):
            integers, step = _integers(z[:count] - z[0])
            changes = np.diff(integers, 2, prepend=np.zeros(2, dtype="<i2"))
            plates.append({"plate": wheels.index(wheel), "step": step, "changes": _text(changes.tobytes())})
    return plates


def _words(damper: str) -> str:
    """Return a damper in words, as "front right"."""
    wheel = damper.removeprefix("damper_")
    return " ".join(axle_and_side(wheel)) if is_wheel(wheel) else wheel.replace("_", " ")


def _sliders(car: Car, numbers: CarNumbers, road_class: str | None) -> list[dict[str, Any]]:
    """Return the sliders: words, unit, range, value, and the dampers and parameter that each sets."""
    sliders: list[dict[str, Any]] = []
    dampers = car.vehicle.composition.dampers
    axles: dict[str, list[int]] = {}
    for index, damper in enumerate(dampers):
        wheel = damper.name.removeprefix("damper_")
        axles.setdefault(axle_and_side(wheel)[0] if is_wheel(wheel) else damper.name, []).append(index)
    names, values = list(PARAMETERS), np.asarray(numbers.parameters)
    for axle, indices in axles.items():
        law = dampers[indices[0]].law
        of_law = FRICTION if law.friction_law == "stribeck" else ["coulomb_friction"]
        for name in of_law:
            words, usual = FRICTION[name]
            value = float(values[indices[0], names.index(name)])
            high = max(usual, 2.0 * value)
            low = 0.0 if name.endswith("friction") else 0.01 * high
            sliders.append(
                {
                    "id": f"{axle}-{name}",
                    "words": f"{axle} {words}",
                    "unit": PARAMETERS[name],
                    "low": low,
                    "high": high,
                    "value": value,
                    "parameter": names.index(name),
                    "dampers": indices,
                }
            )
    low, high = CURVE_SCALES
    for axle, indices in axles.items():
        sliders.append(
            {
                "id": f"{axle}-curve_scale",
                "words": f"{axle} damper curve, factor (to 0.1 %)",
                "unit": "",
                "low": low,
                "high": high,
                "value": 1.0,
                "parameter": names.index("curve_scale"),
                "dampers": indices,
            }
        )
    low, high = SCALES
    words = "level of the input, factor" if road_class is None else "road"
    sliders.append({"id": "level", "words": words, "unit": "", "low": low, "high": high, "value": 1.0, "dampers": []})
    return sliders
