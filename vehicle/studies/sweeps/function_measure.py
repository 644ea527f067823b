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
    """Measure by a function of a run.

    Attributes:
        function: the function, or an object that is called like one; for worker processes one of a module.
        skip: excluded time at the beginning [s], the `skip` of its runs.
        channels: required channels; all.
        units: empty: the table takes the names of its first finished run, with unit "?".
        token: other for each measure. A function reads values that its text does not show, so rows that another
            measure stored are not used again; a class of your own with a `repr` of all its values, see `Measure`, is.
    """

    function: RunFunction
    skip: float = 0.0
    channels: None = None
    units: Mapping[str, str] = field(default_factory=dict)
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
