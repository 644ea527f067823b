"""Histories of applied forces that a run gets from Python; they take the way of those of files."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.applied_forces import force_lines
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.placed_force import force_named
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.force_record import RecordedForce, recorded_force

GivenForce = npt.ArrayLike | Callable[[Vector], npt.ArrayLike]
"""Values of a force at the times of a signal, or a function of times [s]."""

SAMPLING = 8.0
"""Rate at which a function is read, over the record rate: the cubic spline through 40 points of a turn of the highest
frequency that a record shows has a mean 1e-6 low."""


def with_histories(car: Any, forces: Mapping[str, GivenForce], time: Vector) -> Any:
    """Return a car whose forces have given histories in place of their harmonics or files.

    Args:
        car: the car; its matrices and its model have the same forces at the same places.
        forces: histories by the name of the force.
        time: times of the signal [s]; (n,).

    Raises:
        ConfigurationError: the force does not exist, or is not enabled.
        DataError: a history has not one finite value for each time.
    """
    composition = car.vehicle.composition
    listed = list(composition.forces)
    for name, history in forces.items():
        index = force_named(name, listed, own=True)
        force = listed[index]
        if not force.law.enabled:
            raise ConfigurationError(f"forces: {force.path}.enabled is false; set it to true, or leave {name} out")
        law = replace(force.law, harmonics=(), file=None, channel=None, unit=None, ends_at_zero=False)
        record = _recorded(force.path, force.unit, history, time, car.vehicle.solver.record_rate)
        listed[index] = replace(force, law=law, given=record)
    vehicle = replace(car.vehicle, composition=replace(composition, forces=tuple(listed)))
    driven = type(car)(vehicle, folder=car.folder)
    driven.origin, driven.overrides = car.origin, car.overrides
    driven._base, driven._step = car._base, car._step
    if car._base is None:
        driven.__dict__ |= {"model": replace(car.model, vehicle=vehicle), "trimmed_body": car.trimmed_body}
    lines, coefficients = force_lines(listed)
    driven.__dict__ |= {"matrices": replace(car.matrices, lines=lines, coefficients=coefficients)}
    return driven


def _recorded(path: str, unit: str, history: GivenForce, time: Vector, record_rate: float) -> RecordedForce:
    """Return the history of a force through values at some times, or through those of a function."""
    if callable(history):
        time = np.linspace(time[0], time[-1], round(SAMPLING * record_rate * (time[-1] - time[0])) + 1)
        history = history(time)
    values = np.asarray(history, dtype=float)
    if values.shape != time.shape:
        raise DataError(
            f"forces: {path} has values of the shape {values.shape}; give a value for each of the {time.size} "
            "times of the signal, or a function of time"
        )
    if not np.isfinite(values).all():
        raise DataError(f"forces: {path} has a value that is not finite; give a number for each time")
    return recorded_force(path, unit, time, values)
