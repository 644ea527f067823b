"""Laws of a damper as one record: written to a model as the parameters of its actuator, read back as an array.

    F = F_c(v) - F_gas + clamp(c v, L(v)),   F_c = D v + shift + sum of clamp(e (v - m), e w)

with the friction of `vehicle.model.laws.friction` and the curve F_c of `vehicle.model.laws.curve`: linear, degressive,
or a table. For a controlled damper, F_c is the force of its softest setting; `vehicle.model.laws.control_laws` computes
the remainder. For a law by address (`vehicle.model.laws.law_by_address`), F_c is its tangent at rest; the engines call
the function for the remainder.
"""

import dataclasses
import importlib.util
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.core.records import dtype
from vehicle.errors import ConfigurationError
from vehicle.model.laws.curve import Curve
from vehicle.model.laws.friction import Friction
from vehicle.model.laws.friction_by_address import OwnFriction, friction_by_address
from vehicle.model.laws.law import Constant, ForceLaw, Parallel
from vehicle.model.laws.law_by_address import law_by_address
from vehicle.model.parameters.force_elements import FRICTION_LAWS, NUMBERS, Damper

RECORD = dtype("DamperLaw")
"""Record of the laws of a damper (`DAMPER_LAW_FIELDS` of layout.h), at least as long as the 10 parameters of an
actuator; a longer record is also a field of the model."""

KEYS = {"friction_limit": "coulomb_friction", "static_limit": "static_friction", "side_force": "side_force_coefficient"}
"""Parameter of a damper by the name in `RECORD` where both differ."""


def pack(damper: Damper) -> npt.NDArray[Any]:
    """Return the record of the laws of a damper; ().

    Raises:
        ConfigurationError: a law by address is not registered in this process.
    """
    curve = damper_curve(damper)
    force_at_rest = float(curve.force(0.0)) - damper.gas_force
    numbers = {
        "viscous_damping": curve.least_slope,
        "rest_force": force_at_rest,
        "shift": force_at_rest - curve.at_rest(),
        "friction_law": FRICTION_LAWS.index(damper.friction_law)
        if damper.friction_function is None
        else friction_by_address(damper.friction_function).call.address,
    }
    # 1 is a placeholder for parameters of a law that is not chosen.
    for name in RECORD.names or ():
        if name not in numbers:
            value = getattr(damper, KEYS.get(name, name))
            numbers[name] = 1.0 if value is None else value
    return np.array(tuple(numbers[name] for name in RECORD.names or ()), dtype=RECORD)


def damper_curve(damper: Damper) -> Curve:
    """Return force over velocity without friction and gas.

    A controlled damper has its softest setting, a law by address its tangent at rest.

    Raises:
        ConfigurationError: the law by address is not registered in this process.
    """
    if damper.function is not None:
        return Curve.line(law_by_address(damper.function).viscous)
    if damper.controlled is not None:
        return Curve.line(damper.controlled.minimum_damping)
    if damper.viscous_law == "table":
        return Curve.through(damper.velocity, damper.force)
    high, low, knee = (
        value or 0.0 for value in (damper.viscous, damper.degressive_viscous, damper.degressive_velocity)
    )
    if damper.viscous_law == "linear":
        return Curve.line(high)
    excess = low - high
    return Curve(
        knots=np.array([-knee, knee]),
        slopes=np.array([high, low, high]),
        offsets=np.array([-excess * knee, 0.0, excess * knee]),
    )


def actuator_parameters(record: npt.NDArray[Any]) -> Vector:
    """Return the parameters of the actuator of a damper with this record; (n,), n the length of `RECORD`."""
    return np.atleast_1d(record).view(np.float64)


def unpack(parameters: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return the records (w,) of the parameters of w actuators, n for each, n the length of `RECORD`."""
    return np.reshape(np.array(parameters, dtype=np.float64), -1).view(RECORD)


def viscous_law(damper: Damper) -> ForceLaw:
    """Return force over velocity without friction and gas as in `damper_curve`, but a law by address whole."""
    return damper_curve(damper) if damper.function is None else law_by_address(damper.function)


def damper_law(damper: Damper) -> Parallel:
    """Return the total force of a damper as a law of arrays, with friction in the smooth form."""
    record, law = pack(damper), FRICTION[damper.friction_law]
    friction = law(**{entry.name: float(record[entry.name]) for entry in dataclasses.fields(law)})
    if damper.friction_function is not None:
        limit, smoothing = damper.coulomb_friction, damper.smoothing
        friction = OwnFriction(name=damper.friction_function, friction_limit=limit, smoothing=smoothing)
    return Parallel(laws=(viscous_law(damper), Constant(value=-damper.gas_force), friction))


def _friction_laws() -> dict[str, type[Friction]]:
    """Return the classes of the friction laws by their names.

    Raises:
        ConfigurationError: a law of the core has no class, or the record of a damper lacks a number of a law, or a
            damper with the law may leave the number out.
    """
    laws: dict[str, type[Friction]] = {}
    for name in FRICTION_LAWS:
        title = name.title().replace("_", "")
        module = f"vehicle.model.laws.{name}"
        law = getattr(importlib.import_module(module), title, None) if importlib.util.find_spec(module) else None
        if law is None:
            raise ConfigurationError(
                f"friction law {name}: EACH_FRICTION_LAW of laws.h has it; add vehicle/model/laws/{name}.py with the "
                f"class {title}"
            )
        laws[name] = law
        numbers = [entry.name for entry in dataclasses.fields(law)]
        if missing := [number for number in numbers if number not in (RECORD.names or ())]:
            raise ConfigurationError(
                f"friction law {name}: the record of a damper has no {', '.join(missing)}, but only "
                f"{', '.join(RECORD.names or ())}; add them to DAMPER_LAW_FIELDS of vehicle/core/source/layout.h"
            )
        needed = ["stribeck_friction" if key == "static_limit" else key for key in numbers[len(COMMON) :]]
        if left_out := [key for key in needed if key not in NUMBERS.get(name, {})]:
            raise ConfigurationError(
                f"friction law {name}: a damper need not have {', '.join(left_out)}, and without them would run with "
                f"other values. Declare them in Damper of vehicle/model/parameters/force_elements.py, with laws = "
                f"({name!r},)"
            )
    return laws


COMMON = dataclasses.fields(Friction)
"""Numbers of every friction law."""

FRICTION = _friction_laws()
"""Classes of the friction laws by their names, in the order of `FRICTION_LAWS`."""
