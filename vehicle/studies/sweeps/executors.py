"""Executors of a sweep: processes on this machine, a Dask cluster, or a user-defined executor."""

import importlib
import logging
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from typing import Any, Self

from vehicle.errors import ConfigurationError, MissingPartError, SimulationError
from vehicle.threads import one_blas_thread, one_thread_each
from vehicle.wording import is_command, speak_options

DASK = "dask://"

WATCH = "parent watch"


def executor_factory(text: str) -> Callable[[], Executor]:
    """Return a function that creates the executor of a sweep; called again after the death of a worker.

    Args:
        text: "dask://host:port" for an existing Dask cluster; "module:factory" for a function without arguments that
            returns an executor.

    Raises:
        ConfigurationError: the text has another form.
        MissingPartError: Dask is required and not installed.
    """
    if text.startswith(DASK):
        return _dask(text.removeprefix(DASK))
    if text.count(":") == 1 and all(text.split(":")):
        return _own(*text.split(":"))
    raise ConfigurationError(f"--executor {text!r}: must be dask://host:port or module:factory")


class ThisProcess(Executor):
    """Executor that runs a task in this process when it is submitted: no new process, and your own laws are known."""

    _max_workers = 1

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Return the finished task; BLAS has one thread, as in `process_pool`, so that rounding is equal."""
        future: Future[Any] = Future()
        try:
            with one_blas_thread():
                future.set_result(function(*arguments, **named))
        except Exception as error:
            future.set_exception(error)
        return future


def process_pool(jobs: int) -> ProcessPoolExecutor:
    """Return a pool of processes with one thread each, so that rounding does not depend on the number of workers."""
    with one_thread_each():
        pool = ProcessPoolExecutor(jobs, get_context("spawn"), _ready, (is_command(),))
        # The processes inherit the environment when they start, so start them now and not at the first run.
        try:
            for future in [pool.submit(_ready, is_command()) for _ in range(jobs)]:
                future.result()
        except BrokenExecutor:
            pool.shutdown(wait=False)
            raise ConfigurationError(
                "the worker processes do not start; see their error above. A script must call a sweep below "
                'if __name__ == "__main__":, because each process imports the script'
            ) from None
    return pool


class StandingExecutor:
    """Executor of several sweeps in turn: it stays open between them, and is replaced after the death of a worker.

    Args:
        make: function that returns an executor.
    """

    def __init__(self, make: Callable[[], Executor]) -> None:
        self._make, self._executor = make, make()

    def __call__(self) -> Executor:
        """Return the present executor."""
        return self._executor

    def renew(self) -> Executor:
        """Close the executor and return a new one."""
        close(self._executor)
        self._executor = self._make()
        return self._executor

    def __enter__(self) -> Self:
        """Return the object; the executor is closed at the end of the block."""
        return self

    def __exit__(self, *error: object) -> None:
        """Close the executor."""
        close(self._executor)


def close(executor: Executor) -> None:
    """Shut down an executor and cancel its pending tasks; close the client of a Dask executor."""
    client = getattr(executor, "_client", None)
    if client is None:
        executor.shutdown(wait=True, cancel_futures=True)
    else:
        executor.shutdown(wait=False)
        client.close()


def workers_of(executor: Executor) -> int | None:
    """Return the present number of workers of an executor; None if unknown."""
    client = getattr(executor, "_client", None)
    if client is not None:
        try:
            return int(sum(client.nthreads().values()))
        except (OSError, ValueError, TimeoutError) as error:
            raise SimulationError(
                f"connection to the scheduler of the cluster lost ({error}); finished runs are stored. Start scheduler "
                "and workers again and continue with --resume"
            ) from None
    # Both executors of the standard library have this attribute, and no public one.
    count = getattr(executor, "_max_workers", None)
    return count if isinstance(count, int) and count > 0 else None


def worker_remedy(executor: Executor) -> str:
    """Return the instruction that starts workers of an executor."""
    client = getattr(executor, "_client", None)
    address = "" if client is None or client.scheduler is None else client.scheduler.address
    return f"start workers, for example: dask worker {address} --nthreads 1" if address else "start its workers"


def _ready(of_command: bool) -> None:
    """Initialise a worker: import the modules of a run, ignore interrupts, and end with the parent process."""
    if of_command and not is_command():
        speak_options()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    importlib.import_module("vehicle.runs.car")
    parent = parent_process()
    if parent is not None and not any(thread.name == WATCH for thread in threading.enumerate()):
        threading.Thread(target=_end_with, args=(parent.sentinel,), name=WATCH, daemon=True).start()


def _end_with(sentinel: int) -> None:
    """Wait for the end of the parent process, which may be killed, and exit."""
    connection.wait([sentinel])
    os._exit(1)


def _dask(address: str) -> Callable[[], Executor]:
    """Return a function that creates an executor of an existing cluster."""
    try:
        distributed: Any = importlib.import_module("distributed")
    except ImportError:
        raise MissingPartError(
            "--executor dask://...: needs Dask from the extra 'cluster' (pip install distributed)"
        ) from None

    def make() -> Executor:
        # The loggers of Dask write tracebacks for errors that have a message here.
        for name in [name for name in logging.root.manager.loggerDict if name.startswith("distributed")]:
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            client = distributed.Client(address, timeout="10s", set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ConfigurationError(f"--executor dask://{address}: no response from a scheduler ({error})") from None
        executor: Executor = client.get_executor(pure=False)
        return executor

    return make


def _own(module: str, name: str) -> Callable[[], Executor]:
    """Return a function that calls a user-defined factory and checks its result."""
    # Code of the user, in which anything may go wrong.
    try:
        factory = getattr(importlib.import_module(module), name)
    except Exception as error:
        raise ConfigurationError(f"--executor {module}:{name}: {type(error).__name__}: {error}") from None

    def make() -> Executor:
        try:
            executor = factory()
        except Exception as error:
            raise ConfigurationError(
                f"--executor {module}:{name}: {type(error).__name__}: {error}; must be a function without arguments"
            ) from None
        if not isinstance(executor, Executor):
            raise ConfigurationError(
                f"--executor {module}:{name}: returned {type(executor).__name__} instead of a "
                "concurrent.futures.Executor"
            )
        return executor

    return make
