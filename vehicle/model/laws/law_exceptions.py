"""Exceptions in force laws that a user brings as Python functions: the run that calls them fails.

C calls the function through ctypes or numba, which passes an exception to `sys.unraisablehook`, returns 0, and lets
the run continue. So a hook collects the first exception, and the run is discarded.

There is one hook for the runs of all threads, and the hook of before has all other exceptions. A law that is called in
a thread without a run, for example of the core, ends the runs of all threads: it is not known whose law it is.
"""

import gc
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from vehicle.errors import ConfigurationError, SimulationError

FUNCTIONS: dict[str, Any] = {}
"""Function of each registered law by the title of the law, for example "damper law 'valve'"."""


def register_function(title: str, function: Any) -> None:
    """Keep the function of a law until the end of the process, so that a message can name the law."""
    FUNCTIONS.setdefault(title, function)


class _Collector(NamedTuple):
    """A `with` block: the law that is being registered, its thread, and exceptions with the names of their laws."""

    title: str
    thread: int
    found: list[tuple[BaseException, str]]


_LOCK = threading.RLock()  # an exception may be reported, by the garbage collection, where the lock is held
_COLLECTORS: list[_Collector] = []
_PREVIOUS: list[Callable[[Any], Any]] = []
"""The hook of before while there are collectors."""


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
    collector = _Collector(title, threading.get_ident(), [])

    def check() -> None:
        if not collector.found:
            return
        error, name = collector.found[0]
        if isinstance(error, KeyboardInterrupt):
            raise error
        message = (
            f"{name}: the function raises {type(error).__name__}: {error}; correct it: it is called with (memory, x, "
            "v), a friction law with (memory, friction, v), and must return a number"
        )
        raise ConfigurationError(message) if title else SimulationError(f"{message}; the run is discarded")

    with _LOCK:
        if not _COLLECTORS:
            _PREVIOUS[:] = [sys.unraisablehook]
            sys.unraisablehook = _collect
        _COLLECTORS.append(collector)
    try:
        yield check
    finally:
        with _LOCK:
            _COLLECTORS[:] = [each for each in _COLLECTORS if each is not collector]
            if not _COLLECTORS and sys.unraisablehook is _collect:
                sys.unraisablehook = _PREVIOUS[0]
        check()


def _collect(unraisable: Any) -> None:
    """Give an exception in a law to its run, and any other one to the hook of before."""
    with _LOCK:
        present = [each for each in _COLLECTORS if each.thread == threading.get_ident()][-1:] or [*_COLLECTORS]
        # ctypes: "Exception ignored on calling ctypes callback function"; numba: object "<numba.ccallback 'f'>".
        title = _title_of(unraisable.object) if "callback" in f"{unraisable.err_msg} {unraisable.object}" else None
        takes = [] if title is None else [each for each in present if each.title or title]
        for each in takes:
            each.found.append((unraisable.exc_value, each.title or title or ""))
        previous = _PREVIOUS[0]
    if not takes:
        previous(unraisable)


def _title_of(function: Any) -> str:
    """Return the title of the law with a Python function; empty for another function.

    A function of numba, and that of an address, may be of several laws.
    """
    # The object of ctypes refers to the Python function, without an attribute for it.
    titles = [title for title, law in FUNCTIONS.items() if any(part is function for part in gc.get_referents(law))]
    unknown = (title for title, law in FUNCTIONS.items() if isinstance(law, int) or not callable(function))
    return " or ".join(titles or unknown)
