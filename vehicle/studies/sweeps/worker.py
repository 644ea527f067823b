"""Function that a worker runs: evaluate the cases of a task with the same program as the sweep, within a time limit."""

import errno
import faulthandler
import os
import socket
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from vehicle.errors import ConfigurationError, OutputError
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.case_result import Block
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import require_same_program

FULL = {errno.ENOSPC, errno.EDQUOT}
"""Error numbers of a full disk and of a used-up quota."""

_WATCHED = threading.Lock()
"""Lock of the one timer of a process, see `faulthandler.dump_traceback_later`."""


def process_name() -> str:
    """Return host and number of this process."""
    return f"{socket.gethostname()}:{os.getpid()}"


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeLimit:
    """Time after which the process of a worker ends, which is the only way to stop compiled code that hangs."""

    seconds: float  # maximum computing time of a task [s]
    sweep: str = field(default_factory=process_name)  # `process_name` of the sweep, which must not end


def carry_out(
    cases: Sequence[Case], keys: Sequence[str], measure: Measure, program: str, limit: TimeLimit | None = None
) -> Block:
    """Run the cases of a task and return their rows, in the order of the cases.

    Args:
        keys: key of each case, see `vehicle.studies.sweeps.case_keys`.
        measure: measure of the runs.
        program: `program_digest` of the process that started the sweep.
        limit: maximum computing time; None for no limit.

    Raises:
        ConfigurationError: the program of this process differs, or a time limit cannot be kept here.
        OutputError: the disk of this machine is full.
    """
    require_same_program(program)
    try:
        with _ended_after(limit):
            return Block.of(cases, keys, evaluate(cases, measure))
    except OSError as error:
        if error.errno not in FULL:
            raise
        raise OutputError(
            f"worker {process_name()}: {error}; free space there. Finished rows are stored; continue with --resume"
        ) from None


@contextmanager
def _ended_after(limit: TimeLimit | None) -> Iterator[None]:
    """End this process if the body takes longer than a limit."""
    if limit is None:
        yield
        return
    if limit.sweep == process_name():
        raise ConfigurationError(
            "time limit: the executor runs in the process of the sweep, where a run cannot be stopped; use processes "
            "(--jobs) or a cluster"
        )
    if not _WATCHED.acquire(blocking=False):
        raise ConfigurationError(
            "time limit: this worker runs several tasks at once; start the workers with one thread each (dask worker "
            "--nthreads 1)"
        )
    try:
        with Path(os.devnull).open("w") as nowhere:
            # Its timer needs no interpreter, so it also ends compiled code that never returns.
            faulthandler.dump_traceback_later(limit.seconds, exit=True, file=nowhere)
            try:
                yield
            finally:
                faulthandler.cancel_dump_traceback_later()
    finally:
        _WATCHED.release()
