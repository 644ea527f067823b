"""Number of threads of the numerical libraries: one for each process.

Sums are then rounded equally for any number of workers, and operations on the small matrices of a car are faster: a
reduced run on two threads takes 50 % longer.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Environment variables with the number of threads; a library reads them when it is loaded."""


def prefer_one_thread() -> None:
    """Set one thread for libraries that this process loads later, unless the user has set a number."""
    if not any(name in os.environ for name in THREADS):
        os.environ.update(dict.fromkeys(THREADS, "1"))


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
