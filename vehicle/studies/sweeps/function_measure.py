"""Measure of a sweep by a function of a run."""

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any
from uuid import uuid4

from vehicle.runs.car import Run

RunFunction = Callable[[Run], float | Mapping[str, float]]
"""Function of a run that returns a number or a dictionary of numbers."""


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
