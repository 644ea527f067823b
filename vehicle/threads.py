"""Number of threads of the numerical libraries: one, in the calls of this package and in the processes that it starts.

The matrices of a car have about 135 rows. With two threads, `Car.modes` of `focus_road` takes 12 to 60 times the
processor time of one thread, because waiting threads of OpenBLAS spin. Sums are also rounded equally on every machine.
"""

import os
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from threading import Lock, get_ident
from typing import Any

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Environment variables with the number of threads; a library reads them when it is loaded."""

_lock = Lock()
_entered: Counter[int] = Counter()
"""Number of `one_blas_thread` blocks that each thread of this process is in."""
_loaded_single = False
"""True if NumPy and SciPy load their libraries with one thread, so that there is nothing to limit; OpenBLAS, MKL and
libraries on OpenMP read the environment."""
_postponed: dict[Any, int] = {}
"""Library to the number of threads to restore when no thread is in a block any more."""


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit BLAS to one thread in a `with` block or a decorated function; restore the number of threads afterwards.

    The number of OpenBLAS belongs to the whole process: calls of other threads are limited during the block, too, and
    the number is restored when the last thread leaves its block. A block takes 24 us (6 us within
    another block or if the number is 1 already), the first one of a process 13 ms.
    """
    thread = get_ident()
    with _lock:
        numbers = {library: number for library in _libraries() if (number := library.num_threads) != 1}
        for library in numbers:
            _set_number(library, 1)
        _entered[thread] += 1
    try:
        yield
    finally:
        with _lock:
            _entered[thread] -= 1
            if not _entered[thread]:
                del _entered[thread]
            if _entered.keys() - {thread}:
                shared = {library: number for library, number in numbers.items() if not _is_per_thread(library)}
                _postponed.update(shared)
                _restore({library: number for library, number in numbers.items() if library not in shared})
            else:
                _restore(numbers)
            if not _entered:
                _restore(_postponed)
                _postponed.clear()


@cache
def _libraries() -> tuple[Any, ...]:
    """Return the controllers of the BLAS libraries of NumPy and SciPy; none if they load with one thread.

    The search takes 0.1 s in a process that does not need `scipy.linalg` otherwise, else 3 ms.
    """
    if _loaded_single:
        return ()
    import scipy.linalg  # noqa: F401  # loads both libraries: a library loaded after the search would be missed
    from threadpoolctl import ThreadpoolController

    return tuple(ThreadpoolController().select(user_api="blas").lib_controllers)


def _is_per_thread(library: Any) -> bool:
    """Return True if the number of threads that is set applies to calls of the setting thread only."""
    return library.internal_api == "mkl" or getattr(library, "threading_layer", None) == "openmp"


def _set_number(library: Any, number: int) -> None:
    """Set the number of threads of a library."""
    # threadpoolctl lets only the first thread that sets a number of OpenBLAS set others, until the record is cleared.
    clear = getattr(library, "clear_controlling_thread", lambda force: None)
    clear(force=True)
    library.set_num_threads(number)
    clear(force=True)


def _restore(numbers: Mapping[Any, int]) -> None:
    """Restore numbers of threads, except where the user has set another number in the meantime."""
    for library, number in numbers.items():
        if library.num_threads == 1:
            _set_number(library, number)


def prefer_one_thread() -> None:
    """Set one thread for libraries that this process loads later, unless the user has set another number."""
    global _loaded_single
    if all(os.environ.get(name, "1") == "1" for name in THREADS):
        os.environ.update(dict.fromkeys(THREADS, "1"))
        # A library that is loaded already keeps its number.
        _loaded_single = "numpy" not in sys.modules


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Set one thread for processes that start inside the `with` block."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
