"""Friction laws of dampers that a user brings as a function at an address, from any language, without a build.

    L = function(memory, Fd, v),    double function(void *memory, double friction, double velocity)

with the parameter Fd = `coulomb_friction` of the damper and its velocity v, positive in extension. Both engines call it
where they read the limit of any friction law, once in a step (`friction_limit` of `vehicle/core/source/laws.h`). The
force near rest is clamp(c v, L) with c = (2/pi) L eps, as in all laws. A law with a state of its own, such as bristles,
cannot be brought in this way: it needs a memory for each damper, which the engines advance once in a step.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.core.records import Packed, packed
from vehicle.errors import ConfigurationError
from vehicle.model.laws.friction import Friction
from vehicle.model.laws.law import Numbers
from vehicle.model.laws.law_by_address import CALL, checked_address, missing, taken
from vehicle.model.laws.law_exceptions import exceptions_of_laws, register_function

TRIED = (0.0, 1e-3, -1e-3, 0.1, -0.1, 1.0, -1.0)
"""Velocities at which a limit is tested [m/s]."""

USUAL = 100.0
"""Parameter Fd of these tests [N]."""

STEP = 1e-6
"""Velocity [m/s] of the central difference for v dL/dv."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrictionByAddress:
    """Friction law at an address in this process.

    Attributes:
        name: value of the parameter `friction_function` of a damper.
        call: record of function and memory, whose address the engines get.
        kept: object that owns the function.
    """

    name: str
    call: Packed = field(repr=False)
    kept: Any = field(repr=False)

    def limit(self, friction: Numbers, velocity: Numbers) -> Vector:
        """Return the limit L(Fd, v) [N], at least 0.

        Args:
            friction: Fd [N].
            velocity: v [m/s]; both broadcast together.
        """
        record, pairs = self.call.memory, np.broadcast(friction, velocity)
        function = CALL(record.function)
        with exceptions_of_laws():
            values = [function(record.memory, float(limit), float(v)) for limit, v in pairs]
        return np.maximum(np.reshape(values, pairs.shape), 0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class OwnFriction(Friction):
    """Smooth form of a registered friction law."""

    name: str

    @staticmethod
    def limit_at(velocity: Any, numbers: Any) -> Any:
        """Return L(Fd, v) [N]."""
        return friction_by_address(numbers["name"]).limit(numbers["friction_limit"], velocity)

    @staticmethod
    def fall_at(velocity: Any, numbers: Any) -> Any:
        """Return v dL/dv [N], by a central difference."""
        v = np.asarray(velocity, dtype=float)
        rise = OwnFriction.limit_at(v + STEP, numbers) - OwnFriction.limit_at(v - STEP, numbers)
        return v * rise / (2.0 * STEP)


_LAWS: dict[str, FrictionByAddress] = {}


def register_friction(name: str, function: Any, memory: int = 0) -> FrictionByAddress:
    """Return a friction law of a damper from a function at an address, and make its name a `friction_function`.

    `car.with_({"front.damper.friction_function": name})` then has it in place of the Coulomb law. The object is kept
    until the end of the process.

    Args:
        name: name of the law: letters, digits, "_", "." and "-".
        function: address of `double function(void *memory, double friction, double velocity)`, which returns the limit
            [N] at a velocity [m/s]; `friction` is the parameter `coulomb_friction` [N]. Its forms are those of
            `register_law`.
        memory: first argument of the function, an address of the caller's own.

    Returns:
        The law, with its limit for arrays.

    Raises:
        ConfigurationError: the name is not valid or belongs to another function, there is no address, the function
            raises an exception, or the limit is negative or not finite between -1 and 1 m/s.
    """
    address, earlier = checked_address(name, function), _LAWS.get(name)
    call = packed("Call", {"function": address, "memory": memory})
    if earlier is not None and bytes(earlier.call.memory) != bytes(call.memory):
        raise taken("friction law", name)
    title = f"friction law {name!r}"
    for velocity in TRIED:
        with exceptions_of_laws(title):
            limit = CALL(address)(memory, USUAL, velocity)
        if not 0.0 <= limit < np.inf:
            raise ConfigurationError(
                f"{title}: found a limit of {limit:.4g} N at {velocity:g} m/s, must be finite and "
                "at least 0 in both directions, because the simulation adds the sign"
            )
    register_function(title, function)
    return _LAWS.setdefault(name, FrictionByAddress(name=name, call=call, kept=function))


def friction_by_address(name: str) -> FrictionByAddress:
    """Return a registered law by its name.

    Raises:
        ConfigurationError: no law of this name is registered in this process.
    """
    if name not in _LAWS:
        raise missing("friction law", name, _LAWS, "register_friction")
    return _LAWS[name]
