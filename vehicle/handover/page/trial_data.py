"""Numbers of a car and its plates for the script of a page, which runs the car with the module of the FMU runtime.

The module is the C runtime of `vehicle.handover.fmu` as WebAssembly, the numbers of the car are those of its FMU.
Friction limits, Stribeck parameters and level are exact; a factor on the damper curve acts as a force in addition to
the fixed poles. Each stiffness and each speed has a separate set of poles.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.digits import number
from vehicle.engines.reduced.group_run import time_steps
from vehicle.engines.reduced.reduced_run import LONGEST_STEP
from vehicle.engines.reduced.validity import (
    ERROR_IN_RANGE,
    ERROR_ON_CLASS_C,
    LARGEST_ANGLE,
    LARGEST_ANGLE_ON_ROADS,
    rotating_bodies,
)
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS
from vehicle.errors import ConfigurationError
from vehicle.handover.fmu.car_numbers import FRICTION, PARAMETERS, CarNumbers, friction_numbers, numbers_with
from vehicle.handover.fmu.output_rows import Output, Watched, car_outputs, joined_rows, motion_rows, watched_outputs
from vehicle.handover.page.car_sets import stepped_sliders
from vehicle.handover.page.level_numbers import level_numbers
from vehicle.handover.page.live_figures import figure_data, page_figures
from vehicle.handover.page.moving_car import moving_picture, picture_rows, turning_parts
from vehicle.handover.page.packed_numbers import byte_runs, packed, text
from vehicle.handover.page.page_input import LONGEST, SPEEDS, PageInput, RunRoad, page_input
from vehicle.names import AXES, axle_and_side, is_wheel
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.excitation.signal import Signal

if TYPE_CHECKING:
    from vehicle.runs.car import Car

POINT = "seat_rail"
"""Output point of the comfort values."""

SCALES = (0.25, 4.0)
"""Range of the factor on the level of the input."""

CURVE_SCALES = (0.6, 2.0)
"""Range of the factor on the damper curve, within which it is exact to 0.1 %."""

WINDOW = 4096
"""Samples of a window of the densities; LINES of trial_worker.js."""

SHORTEST = 1.05 * max(SPEEDS)
"""Minimum length of the evaluated record in windows: one window at the highest speed, and the lost last samples."""

WORKER = ("trial_worker.js",)
"""Scripts of the tasks, which the page runs in a worker."""

PAGE = ("trial_picture.js", "trial.js")
"""Scripts of sliders, plots and moving picture, after wireframe.js of the report."""


def trial_data(
    car: Car,
    signal: Signal,
    *,
    wheel: str,
    skip: float = 0.0,
    road: RunRoad | None = None,
    measure: Sequence[str] = (),
) -> str:
    """Return the numbers of a car and its plates for the script of a page, as JSON.

    Args:
        signal: displacement of the plates at the record rate of the car.
        wheel: wheel whose plate excites the FRF in the page, and whose damper the page shows.
        skip: excluded time at the beginning [s].
        road: road of the run; None for another input.
        measure: further figures by their names in the catalogue; the page shows those that it can compute.

    Raises:
        ConfigurationError: the reduced engine or the C runtime cannot take the car, or the input (see `_require`).
    """
    _require(car, signal, skip)
    drive = page_input(car, signal, road)
    stepped, cars = stepped_sliders(car, drive)
    names = [damper.name for damper in car.vehicle.composition.dampers]
    on_class = road is not None and road.road_class is not None
    angle, error = (LARGEST_ANGLE_ON_ROADS, ERROR_ON_CLASS_C) if on_class else (LARGEST_ANGLE, ERROR_IN_RANGE)
    rotations = turning_parts(car, drive.signal)
    figures = page_figures(car, measure)
    channels = tuple(dict.fromkeys(channel for figure in figures for channel in figure["channels"]))
    numbers = [_page_numbers(each, drive, _watched(each, rotations, angle), channels) for each in cars]
    base, shown = numbers[0], len(picture_rows(car))
    outputs = {output.name: index for index, output in enumerate(base.outputs)}
    contact = application("seat")
    data: dict[str, Any] = {
        "module": text(_module()),
        "cars": [packed(each.content, byte_runs(each, shown, exact=each is base)) for each in numbers],
        "interval": signal.timestep,
        "samples": drive.signal.time.size,
        "shortened": drive.signal.time.size < signal.time.size,
        "skip": evaluated_span(signal.time.size, signal.timestep, skip).start,
        **drive.data(base.plates),
        "plateCount": len(base.plates),
        "excited": base.plates.index(wheel),
        "frf": drive.road is not None or len(drive.wheels) == 1,
        "parameters": np.asarray(base.parameters).tolist(),
        "names": list(PARAMETERS),
        "notices": list(_watched(car, rotations, angle).notices),
        "positions": [outputs[f"{POINT}_displacement_{axis}"] for axis in AXES],
        "motions": [outputs[f"motion_{index}"] for index in range(shown)],
        "picture": moving_picture(car),
        "dampers": [
            {
                "name": _words(name),
                "velocity": outputs[f"{name}_velocity"],
                "force": outputs[f"{name}_force"],
                "slip": damper.law.slip_velocity,
            }
            for name, damper in zip(names, car.vehicle.composition.dampers, strict=True)
        ],
        **figure_data(figures, outputs),
        "shown": next((index for index, name in enumerate(names) if name == f"damper_{wheel}"), 0),
        "derivative": WEIGHTS.tolist(),
        "ahead": AHEAD,
        "weightings": [weighting(name).sections.tolist() for name in contact.weightings],
        "decay": max(weighting(name).decay_s for name in contact.weightings),
        "factors": list(contact.comfort_factors),
        "sliders": [*_sliders(car, base, road), *stepped],
        "levels": level_numbers(car, drive.signal),
        "roadClass": road and road.road_class,
        "road": drive.road is not None,
        "checked": f"Checked against MuJoCo while parts rotate by up to {number(np.degrees(angle), 2)} deg: {error}.",
    }
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


def _page_numbers(car: Car, drive: PageInput, watched: Watched, further: Sequence[str]) -> CarNumbers:
    """Return the numbers of a car with the outputs of the page, those of further channels among them."""
    names = [damper.name for damper in car.vehicle.composition.dampers]
    channels = [f"{POINT}_acc_{axis}" for axis in AXES]
    of_dampers = [f"{name}_{end}" for name in names for end in ("velocity", "force")]
    outputs, rows = car_outputs(car, [*dict.fromkeys([*channels, *of_dampers, *further])])
    # The page computes accelerations from displacements.
    kept = [index for index, output in enumerate(outputs) if "_acc_" not in output.name]
    motions = motion_rows(car, picture_rows(car))
    read = [outputs[index] for index in kept]
    read += [Output(name=f"motion_{k}", unit="m", meaning="") for k in range(len(motions.fixed))]
    _, every = time_steps(drive.signal, car.vehicle.solver.record_rate, LONGEST_STEP)
    return numbers_with(
        car,
        drive.interval / every,
        (read, joined_rows([rows.part(kept), motions])),
        # The page has the notices once, not in each car.
        dataclasses.replace(watched, notices=[]),
    )


def _watched(car: Car, rotations: Sequence[int], largest_angle: float) -> Watched:
    """Return what the page watches: linear tyres, and rotations by their indices among `rotation_outputs`."""
    watched = watched_outputs(car, largest_angle=largest_angle)
    others = len(watched.notices) - 3 * len(rotating_bodies(car.matrices))
    return watched.part([*range(others), *(others + index for index in rotations)])


def scripts(names: Sequence[str]) -> str:
    """Return the text of scripts of this package, concatenated."""
    folder = resources.files("vehicle.handover.page")
    return "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in names)


def _require(car: Car, signal: Signal, skip: float) -> None:
    """Check that the page can run a car on its plates.

    Raises:
        ConfigurationError: the car is unstable for the reduced engine, lacks the seat rail, or the input has another
            rate than the record, slopes of its own, or is too short for a density at the highest speed.
    """
    car.check("reduced")
    car.vehicle.require_channels([f"{POINT}_acc_{axis}" for axis in AXES], car.vehicle.acceleration_channels)
    if signal.slope_velocity or abs(signal.timestep * car.vehicle.solver.record_rate - 1.0) > 1e-6:
        raise ConfigurationError("the input must be plate displacements at the sampling rate of the recorded channels")
    shortest = skip + SHORTEST * WINDOW * signal.timestep
    if min(signal.duration, LONGEST) < shortest:
        raise ConfigurationError(
            f"the input lasts {signal.duration:g} s, of which the page runs at most {LONGEST:g} s, but it needs at "
            f"least {shortest:.3g} s"
        )


def _module() -> bytes:
    """Return the WebAssembly module, built by tools/core.py."""
    return resources.files("vehicle.handover.fmu").joinpath("binaries/wasm32-wasi/page.wasm").read_bytes()


def _words(damper: str) -> str:
    """Return a damper in words, as "front right"."""
    wheel = damper.removeprefix("damper_")
    return " ".join(axle_and_side(wheel)) if is_wheel(wheel) else wheel.replace("_", " ")


def _sliders(car: Car, numbers: CarNumbers, road: RunRoad | None) -> list[dict[str, Any]]:
    """Return the sliders: words, unit, range, value, and the dampers and parameter that each sets."""
    sliders: list[dict[str, Any]] = []
    dampers = car.vehicle.composition.dampers
    axles: dict[str, list[int]] = {}
    for index, damper in enumerate(dampers):
        wheel = damper.name.removeprefix("damper_")
        axles.setdefault(axle_and_side(wheel)[0] if is_wheel(wheel) else damper.name, []).append(index)
    names, values = list(PARAMETERS), np.asarray(numbers.parameters)
    for axle, indices in axles.items():
        for name in friction_numbers(dampers[indices[0]].law):
            value = float(values[indices[0], names.index(name)])
            high = max(FRICTION[name].usual, 2.0 * value)
            low = 0.0 if name.endswith("friction") else 0.01 * high
            sliders.append(
                {
                    "id": f"{axle}-{name}",
                    "words": f"{axle} {FRICTION[name].words}",
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
        if dampers[indices[0]].law.controlled:
            # The controller sets the coefficient; a factor would act on the softest line alone.
            continue
        sliders.append(
            {
                "id": f"{axle}-curve_scale",
                "words": f"{axle} damper curve, factor",
                "unit": "",
                "low": low,
                "high": high,
                "value": 1.0,
                "parameter": names.index("curve_scale"),
                "dampers": indices,
            }
        )
    low, high = SCALES
    words = "level of the input, factor" if road is None or road.road_class is None else "road"
    sliders.append({"id": "level", "words": words, "unit": "", "low": low, "high": high, "value": 1.0, "dampers": []})
    return sliders
