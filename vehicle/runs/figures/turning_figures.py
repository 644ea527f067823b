"""Figures of turning parts and of motions: amplitude at an order; frequency and damping of a motion."""

from collections.abc import Callable

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car.motion_figures import BODY_MOTIONS, MotionFigure, motion_figures
from vehicle.runs.figures.figure import Details, Figure, Reduction, Values
from vehicle.runs.figures.rows import unread
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.order_lines import OrderLines, order_lines
from vehicle.signals.analysis.samples import Vector

STUCK = " stuck"
"""End of the name of a motion for dampers that stick."""


ORDER_FREQUENCY = "order_frequency"
"""Name of the frequency of an order, in the column after its amplitude."""


def _constant_speed(details: Details, vehicle: Vehicle, _: object = None) -> float:
    """Return the angular speed of what turns [rad/s].

    Raises:
        ConfigurationError: it does not turn, or its speed changes.
    """
    angle, speed = vehicle.composition.turning(details.angle or None)
    if angle == CRANK and vehicle.composition.crank_run_up is not None:
        raise ConfigurationError(f"orders: the speed of {angle} changes in this run; use order_cut")
    return speed


def _lines(details: Details, runs: Runs) -> list[OrderLines]:
    """Return the amplitude of the channel at the order, for each run."""
    lines = []
    for run, vehicle in enumerate(runs.vehicles):
        speed = _constant_speed(details, vehicle)
        histories = np.array([runs[channel][run] for channel in details.channels])
        lines.append(order_lines(runs.time, histories, speed / (2.0 * np.pi), [details.order or 1.0], begin=runs.skip))
    return lines


def _order(_: Vector, details: Details, runs: Runs) -> Values:
    amplitudes, errors = [], []
    for line in _lines(details, runs):
        amplitude = abs(line.amplitude[:, 0])
        largest = np.argmax(amplitude)
        amplitudes.append(amplitude[largest])
        errors.append(line.error[largest, 0])
    return Values(np.array(amplitudes), np.array(errors))


def _order_frequency(_: Vector, details: Details, runs: Runs) -> Values:
    return Values(np.array([float(line.frequency[0]) for line in _lines(details, runs)]))


def _require_angle(details: Details, vehicle: Vehicle) -> None:
    composition = vehicle.composition
    names = [CRANK, *(f"wheel_{wheel}" for wheel in vehicle.wheels), *(force.name for force in composition.forces)]
    if details.angle and details.angle not in names:
        raise ConfigurationError(f"angle {details.angle!r}: must be one of {', '.join(names)}")


def _require_motion(details: Details, vehicle: Vehicle) -> None:
    hops = dict.fromkeys(f"{wheel.axle} wheel hop" for wheel in vehicle.composition.wheels)
    name, motions = details.motion.replace("_", " ").removesuffix(STUCK), (*BODY_MOTIONS, *hops)
    if name not in motions:
        raise ConfigurationError(f"motion {name!r}: must be one of {', '.join(motions)}")


def _of_motion(value: Callable[[MotionFigure], float | None]) -> Reduction:
    """Return the reduction to a number of a motion of the car itself."""

    def of(_: Vector, details: Details, runs: Runs) -> Values:
        motion = details.motion.replace("_", " ")
        state, name = ("stuck" if motion.endswith(STUCK) else "sliding"), motion.removesuffix(STUCK)
        values = []
        for car in runs.cars:
            _require_motion(details, car.vehicle)
            listed = {each.motion: each for each in motion_figures(car) if each.dampers == state}
            number = value(listed[name])
            values.append(np.nan if number is None else number)
        return Values(np.array(values))

    return Reduction(of=of)


def _channels(details: Details, _: object) -> tuple[str, ...]:
    return details.channels


ORDER_FIGURES = {
    "order": Figure(
        words="order amplitude", meaning="amplitude at an order of crank or wheel, of several channels the largest [U]",
        reads=unread(_channels), reduces=Reduction(of=_order), needs=("order", "channels"), takes=("angle",),
        companion=ORDER_FREQUENCY, alone=True, certain=True, require=_require_angle, on_input=_constant_speed,
    ),
    ORDER_FREQUENCY: Figure(
        words="order frequency", meaning="frequency of an order of crank or wheel [Hz]",
        unit="Hz", reads=unread(_channels), reduces=Reduction(of=_order_frequency), better="",
        needs=("order", "channels"), takes=("angle",), alone=True, exact=True, require=_require_angle,
        on_input=_constant_speed,
    ),
}  # fmt: skip
"""Name to figure of a turning part."""

MOTION_FIGURES = {
    "frequency": Figure(
        words="natural frequency", meaning="undamped natural frequency of a motion of the car, for example heave [Hz]",
        unit="Hz", reads=unread(lambda *_: ()), reduces=_of_motion(lambda each: each.frequency_hz), better="",
        needs=("motion",), exact=True, require=_require_motion,
    ),
    "damping_ratio": Figure(
        words="damping ratio",
        meaning="damping ratio of a motion of the car, for example heave, dampers at 0.1 m/s [-]",
        unit="-", reads=unread(lambda *_: ()), reduces=_of_motion(lambda each: each.damping_ratio), better="",
        needs=("motion",), exact=True, require=_require_motion,
    ),
}  # fmt: skip
"""Name to figure of a motion."""
