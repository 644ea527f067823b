"""What all commands share: one message for each error, exit codes, interruption, a progress line."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Sequence
from types import FrameType

from vehicle.errors import ConfigurationError, OutputError, VehicleError

INTERRUPTED = 130


class Parser(argparse.ArgumentParser):
    """Argument parser whose errors are one message and exit code 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        """Raise the message instead of leaving the process."""
        raise ConfigurationError(f"{message}; see {self.prog} --help")


def run_command(job: Callable[[], None], *, debug: bool = False) -> int:
    """Run the job of a command and turn every failure into one message and an exit code.

    Args:
        job: does everything; returns when all that was asked for exists.
        debug: show the traceback too.

    Returns:
        0, or the code of the failure: 2 usage, 3 data, 4 simulation, 5 missing part, 6 output, 130 interrupted.
    """
    # A terminated run cleans up as an interrupted one does.
    previous = {number: signal.signal(number, _interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    _asked_to_end.clear()
    try:
        job()
        sys.stdout.flush()
    except KeyboardInterrupt:
        _say("interrupted; nothing half-written is left behind")
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of our output has gone (| head); what follows goes nowhere.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OutputError.exit_code
    except VehicleError as error:
        if debug:
            traceback.print_exc()
        _say(str(error))
        return error.exit_code
    except OSError as error:
        if debug:
            traceback.print_exc()
        _say(f"{error.filename or 'output'}: {error.strerror or error}")
        return OutputError.exit_code
    except MemoryError:
        _say("out of memory; give a shorter input or a lower solver.record_rate")
        return VehicleError.exit_code
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
    return 0


def parse_and_run(
    parser: argparse.ArgumentParser, job: Callable[[argparse.Namespace], None], arguments: Sequence[str] | None
) -> int:
    """Parse the arguments of a command and run its job.

    Args:
        parser: with the option --debug.
        job: as of `run_command`, given the options.
        arguments: without the program name; those of the process by default.

    Returns:
        Exit code, as of `run_command`.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    # Looked for by hand: a failure to parse must show its traceback too.
    return run_command(lambda: job(parser.parse_args(given)), debug="--debug" in given)


_asked_to_end = threading.Event()
"""Set by a signal. The exception alone can be lost: a compiler that is called back from C swallows it."""


def _interrupt(number: int, frame: FrameType | None) -> None:
    _asked_to_end.set()
    raise KeyboardInterrupt


def _say(message: str) -> None:
    print(f"error: {message}", file=sys.stderr)


class ProgressLine:
    """A line on the terminal that tells how far a long piece of work is; silent where nobody watches.

    Args:
        what: name of the work.
        enabled: False keeps it silent.
    """

    def __init__(self, what: str, *, enabled: bool = True) -> None:
        self.what = what
        self.enabled = enabled and sys.stderr.isatty()
        self.started = time.monotonic()
        self.last = 0.0

    def __call__(self, fraction: float) -> None:
        """Show a fraction [-]; at most five times a second. The place where a lost interruption is noticed."""
        if _asked_to_end.is_set():
            raise KeyboardInterrupt
        now = time.monotonic()
        if not self.enabled or (now - self.last < 0.2 and fraction < 1.0):
            return
        self.last = now
        left = (now - self.started) * (1.0 / max(fraction, 1e-6) - 1.0)
        bar = "#" * round(30 * fraction)
        end = "\n" if fraction >= 1.0 else ""
        sys.stderr.write(f"\r{self.what} [{bar:<30}] {100 * fraction:3.0f} %  {left:4.0f} s left {end}")
        sys.stderr.flush()
