"""Exceptions in force laws that a user brings as Python functions: the run that calls them fails.

C calls the function through ctypes or numba, which passes an exception to `sys.unraisablehook`, returns 0, and lets
the run continue. So a hook collects the first exception, and the run is discarded.
"""

import gc
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from vehicle.errors import ConfigurationError, SimulationError

FUNCTIONS: dict[str, Any] = {}
"""Function of each registered law by the title of the law, as "damper law 'valve'"."""


def register_function(title: str, function: Any) -> None:
    """Keep the function of a law until the end of the process, so that a message can name the law."""
    FUNCTIONS.setdefault(title, function)


@contextmanager
def exceptions_of_laws(title: str = "") -> Iterator[Callable[[], None]]:
    """Collect exceptions in laws during a `with` block; raise the first one at its end.

    Args:
        title: law that is being registered; empty in a run.

    Yields:
        Function that raises the first exception collected so far.

    Raises:
        SimulationError: a law raised an exception or returned no number; a ConfigurationError at registration.
    """
    previous_hook, exceptions = sys.unraisablehook, list[Any]()

    def collect(unraisable: Any) -> None:
        # ctypes: "Exception ignored on calling ctypes callback function"; numba: object "<numba.ccallback 'f'>".
        if "callback" not in f"{unraisable.err_msg} {unraisable.object}":
            previous_hook(unraisable)
        elif not exceptions:
            exceptions.append((unraisable.exc_value, unraisable.object))

    def check() -> None:
        if not exceptions:
            return
        error, function = exceptions[0]
        if isinstance(error, KeyboardInterrupt):
            raise error
        name = title or _title_of(function)
        message = (
            f"{name}: the function raises {type(error).__name__}: {error}; correct it: it is called with (memory, x, "
            "v), a friction law with (memory, friction, v), and must return a number"
        )
        raise ConfigurationError(message) if title else SimulationError(f"{message}; the run is discarded")

    sys.unraisablehook = collect
    try:
        yield check
    finally:
        sys.unraisablehook = previous_hook
        check()


def _title_of(function: Any) -> str:
    """Return the title of the law with a Python function; of all laws for a function of numba."""
    # The object of ctypes refers to the Python function, without an attribute for it.
    titles = [title for title, law in FUNCTIONS.items() if any(part is function for part in gc.get_referents(law))]
    return " or ".join(titles or FUNCTIONS)
