"""Force laws of dampers that a user brings as a function at an address, from any language, without a build.

    F = function(memory, x, v),    double function(void *memory, double x, double v)

with the displacement x of the damper from the design position and its velocity v, both positive in extension. The
force is the hydraulic one: friction, gas and stop are added by the other parameters of the damper. It is zero at rest
at every displacement (a spring is a stop), and rises with v at rest, with the slope D = dF/dv(0, 0) by a
central difference.

The linear system contains D. Both engines call the function several times in a step for the remainder R = F - D v
(`own_laws` of `vehicle/core/source/march.c`, `own_dampers` of `dampers.h`): second order, exact for a line. So the
function must not depend on the order of its calls. A run whose law raises an exception fails (`law_exceptions.py`). A
vehicle file has its name: the address is valid in this process only.

Source of the integration: Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.7 (linearly
implicit methods).
"""

import ctypes
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.laws.law import Numbers
from vehicle.model.laws.law_exceptions import exceptions_of_laws, register_function

RECORD = np.dtype(
    [
        ("function", np.int64),  # address
        ("memory", np.int64),  # first argument of the function
        ("viscous", np.float64),  # D [N s/m]
        ("timestep", np.float64),  # h [s]
    ],
    align=True,
)
"""Record of a law by address in a run."""

STEP = 2.0**-10
"""Velocity [m/s] of the difference for D: a power of two, so that the slope of a line is exact."""

STROKES = (-0.05, -0.01, 0.01, 0.05)
"""Displacements [m] at which the force at rest is tested."""

AT_REST = 1e-6
"""Maximum force at rest over the force at `STEP`: far above round-off, far below the effect of a spring."""

CALL = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)
"""Type of these functions."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LawByAddress:
    """Force law at an address in this process.

    Attributes:
        name: value of the parameter `function` of a damper.
        address: of the C function.
        memory: first argument of the function.
        viscous: slope D at rest [N s/m].
        kept: object that owns the function.
    """

    name: str
    address: int
    memory: int
    viscous: float
    kept: Any = field(repr=False)

    def force(self, velocity: Numbers, displacement: Numbers = 0.0) -> Vector:
        """Return the force F(x, v) [N].

        Args:
            velocity: v [m/s].
            displacement: x [m]; both broadcast together.
        """
        with exceptions_of_laws():
            return self._force(velocity, displacement)

    def _force(self, velocity: Numbers, displacement: Numbers = 0.0) -> Vector:
        function, pairs = CALL(self.address), np.broadcast(displacement, velocity)
        return np.array([function(self.memory, float(x), float(v)) for x, v in pairs]).reshape(pairs.shape)

    def slope(self, velocity: Numbers) -> Vector:
        """Return dF/dv [N s/m] at zero displacement, by a central difference."""
        v = np.asarray(velocity, dtype=float)
        return np.asarray((self.force(v + STEP) - self.force(v - STEP)) / (2.0 * STEP))

    def record(self, timestep: float) -> tuple[int, int, float, float]:
        """Return the values of `RECORD` for a time step [s]."""
        return self.address, self.memory, self.viscous, timestep


_LAWS: dict[str, LawByAddress] = {}


def register_law(name: str, function: Any, memory: int = 0) -> LawByAddress:
    """Return a force law of a damper from a function at an address, and make its name a value for `function`.

    `car.with_({"front.damper.function": name})` then has it. The object is kept until the end of the process.

    Args:
        name: name of the law: letters, digits, "_", "." and "-".
        function: address of `double function(void *memory, double x, double v)`: an integer (of cffi:
            `int(ffi.cast("intptr_t", f))`), a function of ctypes, or an object with an `address`, as of `numba.cfunc`.
        memory: first argument of the function, an address of the caller's own.

    Returns:
        The law, with its force and slope for arrays.

    Raises:
        ConfigurationError: the name is not valid or belongs to another function, there is no address, the function
            raises an exception, or the force is not finite, not zero at rest or falls at rest.
    """
    address = checked_address(name, function)
    earlier = _LAWS.get(name)
    if earlier is not None and (earlier.address, earlier.memory) != (address, memory):
        raise taken("damper law", name)
    law = LawByAddress(name=name, address=address, memory=memory, viscous=0.0, kept=function)
    title = f"damper law {name!r}"
    with exceptions_of_laws(title):
        at_rest = law._force(0.0, np.array([0.0, *STROKES]))
        ends = law._force(np.array([-STEP, STEP]))
    if not (np.isfinite(at_rest).all() and np.isfinite(ends).all()):
        raise ConfigurationError(f"damper law {name!r}: the force at rest or at {STEP:.3g} m/s is not a finite number")
    largest = float(np.max(np.abs(at_rest)))
    if largest > AT_REST * np.max(np.abs(ends)):
        raise ConfigurationError(
            f"damper law {name!r}: found a force of {largest:.4g} N at rest, must be zero at every displacement; "
            "for a gas force or a spring use the parameters gas_force and stop of the damper"
        )
    viscous = float(ends[1] - ends[0]) / (2.0 * STEP)
    if viscous < 0.0:
        raise ConfigurationError(
            f"damper law {name!r}: the force falls with velocity, by {-viscous:.4g} N s/m at rest; it must have "
            "the sign of the velocity, positive in extension"
        )
    register_function(title, function)
    _LAWS[name] = LawByAddress(name=name, address=address, memory=memory, viscous=viscous, kept=function)
    return _LAWS[name]


def law_by_address(name: str) -> LawByAddress:
    """Return a registered law by its name.

    Raises:
        ConfigurationError: no law of this name is registered in this process.
    """
    if name not in _LAWS:
        raise missing("damper law", name, _LAWS, "register_law")
    return _LAWS[name]


def taken(kind: str, name: str) -> ConfigurationError:
    """Return the error of a name that another function of a kind has in this process."""
    return ConfigurationError(
        f"{kind} {name!r}: the name already belongs to another function, and cars that use it would change; "
        "register the new function under another name"
    )


def missing(kind: str, name: str, known: Iterable[str], register: str) -> ConfigurationError:
    """Return the error of a name that no law of a kind has in this process."""
    return ConfigurationError(
        f"{kind} {name!r}: is not registered in this process (registered: {', '.join(known) or 'none'}); call "
        f"vehicle.{register} first, and run sweeps of this car with jobs=1"
    )


def checked_address(name: str, function: Any) -> int:
    """Return the address of a function that gets a name.

    Raises:
        ConfigurationError: the object has none, or the name is not valid.
    """
    if not re.fullmatch(r"[A-Za-z0-9_.-]+", name):
        raise ConfigurationError(f"law {name!r}: a name must consist of letters, digits, '_', '.' and '-'")
    value = getattr(function, "address", function)
    if callable(value):
        try:
            value = ctypes.cast(value, ctypes.c_void_p).value
        except (ctypes.ArgumentError, TypeError):
            value = None
    if not isinstance(value, int) or isinstance(value, bool) or value <= 0:
        raise ConfigurationError(
            f"law {name!r}: found {type(function).__name__} without an address; pass an integer, a function "
            "of ctypes (CFUNCTYPE), or numba.cfunc"
        )
    return value
