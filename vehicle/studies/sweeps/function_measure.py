"""Measure of a sweep or a search by functions of a run."""

import functools
import math
import pickle
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any
from uuid import uuid4

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run

RunFunction = Callable[[Run], float | Mapping[str, float]]
"""Function of a run that returns a number or a dictionary of numbers."""


@dataclass(frozen=True, slots=True)
class NamedFunctions:
    """Numbers of a run by name: each a function of the run, or the name of a figure."""

    functions: Mapping[str, RunFunction | str]

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the numbers; NaN for an infinite figure, as in a table of figures."""
        numbers = {}
        for name, function in self.functions.items():
            value = run.figure(function) if isinstance(function, str) else function(run)
            if isinstance(value, Mapping):
                raise ConfigurationError(f"measure {name!r}: its function returned a dictionary instead of a number")
            numbers[name] = math.nan if isinstance(function, str) and math.isinf(value) else float(value)
        return numbers


@dataclass(frozen=True, kw_only=True, slots=True)
class FunctionMeasure:
    """Measure by a function of a run."""

    function: RunFunction  # a function or a callable object; for worker processes it must be defined in a module
    skip: float = 0.0  # excluded time at the beginning [s], the `skip` of its runs
    channels: None = None  # required channels; all
    # empty: the table takes the names of its first finished run, with unit "?"
    units: Mapping[str, str] = field(default_factory=dict)
    # unique. The text of a function does not show all values that it reads, so stored rows of another measure are not
    # used again; with a class of your own with a `repr` of all its values, see `Measure`, they are.
    token: str = field(default_factory=lambda: uuid4().hex)

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        values = self.function(replace(run, skip=self.skip))
        return dict(values) if isinstance(values, Mapping) else {self.name: float(values)}

    def __repr__(self) -> str:
        """Return the text that identifies stored rows."""
        return f"FunctionMeasure({self.name}, {self.token})"

    @property
    def name(self) -> str:
        """Name of the function below partial arguments, or of the class of an object."""
        function: Any = self.function
        while isinstance(function, functools.partial):
            function = function.func
        return str(getattr(function, "__name__", type(function).__name__))


def require_picklable(measure: object) -> None:
    """Check that a measure can be sent to other processes.

    Raises:
        ConfigurationError: a lambda or a function inside another function.
    """
    try:
        pickle.dumps(measure)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ConfigurationError(
            f"measure: other processes cannot load it ({error}); define the function at the top of a module, or set "
            "jobs=1 without executor and time_limit"
        ) from None
