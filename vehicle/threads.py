"""Threads of the numerical libraries: one for each process.

Sums are then rounded alike whatever the number of workers, and work on matrices as small as those of a car is faster: a
reduced run on two threads takes half as long again.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Environment variables that number the threads of a process; read when a library is loaded."""


def prefer_one_thread() -> None:
    """Have libraries that this process loads from now on use one thread, unless the user has set a number."""
    if not any(name in os.environ for name in THREADS):
        os.environ.update(dict.fromkeys(THREADS, "1"))


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Have processes that start now use one thread; numerical libraries read this when they are loaded."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})
