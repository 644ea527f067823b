"""Measure of a sweep by a function of a run, and the text that identifies what this function computes."""

import copyreg
import functools
import hashlib
import inspect
import sys
import sysconfig
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run

RunFunction = Callable[[Run], float | Mapping[str, float]]
"""Function of a run that returns a number or a dictionary of numbers."""

_PLAIN = (type(None), type(Ellipsis), bool, int, float, complex, str, bytes)
"""Types whose `repr` has the whole value."""

_LIBRARIES = tuple(Path(sysconfig.get_path(name)) for name in ("purelib", "platlib"))
"""Folders of installed packages."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FunctionMeasure:
    """Measure by a function of a run.

    Attributes:
        function: the function, or an object that is called like one; for worker processes one of a module.
        skip: excluded time at the beginning [s], the `skip` of its runs.
        channels: required channels; all.
        units: empty: the table takes the names of its first finished run, with unit "?".
    """

    function: RunFunction
    skip: float = 0.0
    channels: None = None
    units: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        """Return the source of the function and a digest of all that it reads, which identify stored rows."""
        try:
            content = self.identity()
        except ConfigurationError:
            content = "?"
        return f"FunctionMeasure({_source(self._named)}, {content}, skip={self.skip!r})"

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        values = self.function(replace(run, skip=self.skip))
        if isinstance(values, Mapping):
            return dict(values)
        return {getattr(self._named, "__name__", type(self._named).__name__): float(values)}

    def identity(self) -> str:
        """Return a digest of the function, and of the values, functions and modules that it reads.

        Raises:
            ConfigurationError: a value has no content that can be read, as an open file, so that stored rows could
                belong to another function.
        """
        try:
            return hashlib.sha256(repr(_content(self.function, ())).encode()).hexdigest()[:20]
        except (TypeError, RecursionError) as error:
            name = getattr(self._named, "__name__", type(self._named).__name__)
            raise ConfigurationError(
                f"measure {name}: reads a value that cannot be compared with that of stored rows ({error}); run "
                "without a folder, or make this value in the function"
            ) from None

    @property
    def _named(self) -> Any:
        """Return the function below partial arguments."""
        function: Any = self.function
        while isinstance(function, functools.partial):
            function = function.func
        return function


def _source(function: Any) -> str:
    """Return the source text of a function, or of the class of an object; its name without a source."""
    named = function if hasattr(function, "__qualname__") else type(function)
    try:
        return inspect.getsource(named)
    except (OSError, TypeError):
        return str(named.__qualname__)


def _content(value: Any, above: tuple[int, ...]) -> Any:
    """Return plain data that are equal only for values with which a function computes the same numbers.

    Args:
        above: ids of the values that contain this value.

    Raises:
        TypeError: the content of a value cannot be read.
    """
    if isinstance(value, _PLAIN):
        return value
    if id(value) in above:
        return ("above", len(above) - above.index(id(value)))

    def inner(part: Any) -> Any:
        return _content(part, (*above, id(value)))

    type_of_value = type(value)
    if isinstance(value, ModuleType):
        file = None if _installed(value.__name__) else getattr(value, "__file__", None)
        return (value.__name__, hashlib.sha256(Path(file).read_bytes()).hexdigest() if file else "")
    if isinstance(value, type):
        return [(each.__module__, _source(each)) for each in value.__mro__ if not _installed(each.__module__)] + [
            (value.__module__, value.__qualname__)
        ]
    if isinstance(value, FunctionType):
        if _installed(value.__module__):
            return (value.__module__, value.__qualname__)
        return [inner(part) for part in (value.__code__, value.__defaults__, value.__kwdefaults__, _read_values(value))]
    if isinstance(value, CodeType):
        return (value.co_code, value.co_names, [inner(each) for each in value.co_consts])
    if type_of_value in (list, tuple):
        return (type_of_value.__name__, [inner(each) for each in value])
    if type_of_value in (set, frozenset):
        return (type_of_value.__name__, sorted(repr(inner(each)) for each in value))
    if type_of_value is dict:
        return ("dict", [(inner(key), inner(each)) for key, each in value.items()])
    reduce = copyreg.dispatch_table.get(type_of_value)
    parts = reduce(value) if reduce else value.__reduce_ex__(4)
    if isinstance(parts, str):
        return (getattr(value, "__module__", ""), parts)
    return [inner(tuple(part) if isinstance(part, Iterator) else part) for part in parts]


def _read_values(function: FunctionType) -> dict[str, Any]:
    """Return the values of other scopes that a function reads, by name."""
    values = {}
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        try:
            values[name] = cell.cell_contents
        except ValueError:
            continue  # not set yet
    names = sorted(_names(function.__code__) & function.__globals__.keys())
    return values | {f"global {name}": function.__globals__[name] for name in names}


def _names(code: CodeType) -> set[str]:
    """Return the names in a function and in the functions inside it."""
    return set(code.co_names).union(*(_names(each) for each in code.co_consts if isinstance(each, CodeType)))


def _installed(module: str | None) -> bool:
    """Return True for a module of Python, of this package, or of an installed package."""
    top = (module or "builtins").partition(".")[0]
    if top in sys.stdlib_module_names or top == __name__.partition(".")[0]:
        return True
    file = getattr(sys.modules.get(top), "__file__", None)
    return file is not None and any(folder in Path(file).parents for folder in _LIBRARIES)
