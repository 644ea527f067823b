"""What all commands share: one message for each error, exit codes, interruption, a progress line."""

from __future__ import annotations

import argparse
import atexit
import gc
import io
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from types import FrameType

from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError, OutputError, VehicleError

INTERRUPTED = 130

OPENGL = ("", "enable", "enabled", "on", "true", "1", "disable", "disabled", "off", "false", "0", "glfw", "glx", "egl",
          "osmesa")  # fmt: skip
"""What MuJoCo takes as MUJOCO_GL on Linux; with anything else its import fails."""


COLLECTED = (20_000, 5, 5)
"""How often a command looks for unreachable objects, as of `gc.set_threshold`. Loading its libraries makes half a
million objects that stay: at Python's own pace, that of programs that run on, looking through them takes a tenth of a
run."""


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
    lost = _stand_in_for_closed_streams()
    try:
        backend = os.environ.get("MUJOCO_GL", "").strip().lower()
        if backend not in OPENGL:
            raise ConfigurationError(f"MUJOCO_GL={backend}: no OpenGL backend; must be osmesa, egl, glfw or unset")
        job()
        _flush()
        if lost is not None and lost.getvalue():
            raise OutputError("standard output is closed: what was to be printed is lost")
    except KeyboardInterrupt:
        _say("interrupted; nothing half-written is left behind")
        return INTERRUPTED
    except BrokenPipeError:
        _print_nowhere()
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
    except Exception as error:
        if debug:
            traceback.print_exc()
        _say(f"{FAULT} ({type(error).__name__}: {error}); please report it with what --debug shows")
        return VehicleError.exit_code
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
    return 0


def begin_process() -> None:
    """Tell a process that it is one command: to be called before it loads what the command needs."""
    gc.set_threshold(*COLLECTED)
    # What is left at the end goes with the process; looking through it would take as long as a run.
    atexit.register(gc.freeze)
    # No command opens a window, for which MuJoCo would load a library; films name their own.
    os.environ.setdefault("MUJOCO_GL", "disable")


def _stand_in_for_closed_streams() -> io.StringIO | None:
    """Give the process the standard streams that it was started without (>&-); returns that of the output, if so."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass  # so that no file of a run gets the number of a standard stream
    os.close(descriptor)
    if sys.stderr is None:
        sys.stderr = io.StringIO()
    if sys.stdout is None:
        sys.stdout = io.StringIO()
        return sys.stdout
    return None


def _flush() -> None:
    """Hand over what was printed; a full disk behind it shows here."""
    try:
        sys.stdout.flush()
    except OSError:
        _print_nowhere()
        raise


def _print_nowhere() -> None:
    """Discard what is still to be printed: its reader has gone (| head), or its disk is full."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def parse_and_run(parser: Parser, job: Callable[[argparse.Namespace], None], arguments: Sequence[str] | None) -> int:
    """Parse the arguments of a command and run its job.

    Args:
        parser: with the option --debug.
        job: as of `run_command`, given the options; in addition to those of the parser `words`, the arguments, and
            `held`, what is released when the command ends.
        arguments: without the program name; those of the process by default.

    Returns:
        Exit code, as of `run_command`.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        begin_process()

    def work() -> None:
        for word in given:
            if "\0" in word:
                raise ConfigurationError(f"argument {word!r}: holds a NUL byte; no path or value may")
        with ExitStack() as held:
            job(parser.parse_args(given, argparse.Namespace(words=given, held=held)))

    # Looked for by hand: a failure to parse must show its traceback too.
    return run_command(work, debug="--debug" in given)


def command(parser: Callable[[], Parser], job: Callable[[argparse.Namespace], None]) -> Callable[..., int]:
    """The `main` of a command: given its arguments (of the process by default) it returns the exit code.

    Args:
        parser: makes its parser.
        job: as of `parse_and_run`.
    """
    return lambda arguments=None: parse_and_run(parser(), job, arguments)


FAULT = "a fault of the program"
"""What every error begins with that no one has foreseen."""

_asked_to_end = threading.Event()
"""Set by a signal. The exception alone can be lost: a compiler that is called back from C swallows it."""


def _interrupt(number: int, frame: FrameType | None) -> None:
    _asked_to_end.set()
    raise KeyboardInterrupt


def _say(message: str) -> None:
    print(f"error: {message}", file=sys.stderr)


class ProgressLine:
    """Tells how far a long piece of work is: a line that moves on a terminal, else a new line every half minute.

    Args:
        what: name of the work.
        enabled: False keeps it silent.
    """

    def __init__(self, what: str, *, enabled: bool = True) -> None:
        self.what = what
        self.enabled = enabled
        self.moving = sys.stderr.isatty()
        self.started = time.monotonic()
        self.last = self.started - (MOVING_EVERY if self.moving else 0.0)
        self.first: tuple[float, float] | None = None

    def __call__(self, fraction: float) -> None:
        """Show a fraction [-]. The place where a lost interruption is noticed."""
        if _asked_to_end.is_set():
            raise KeyboardInterrupt
        now = time.monotonic()
        if self.first is None:
            self.first = (now, fraction)  # what was compiled and read before is no measure of what follows
        due = now - self.last >= (MOVING_EVERY if self.moving else LINE_EVERY) or (self.moving and fraction >= 1.0)
        if not (self.enabled and due):
            return
        self.last = now
        begun, done = self.first
        left = f"{(now - begun) * (1.0 - fraction) / (fraction - done):.0f} s left" if fraction > done else ""
        if self.moving:
            bar = "#" * round(30 * fraction)
            end = "\n" if fraction >= 1.0 else ""
            sys.stderr.write(f"\r{self.what} [{bar:<30}] {100 * fraction:3.0f} %  {left:>11} {end}")
        else:
            sys.stderr.write(f"{self.what.strip()}: {100 * fraction:.0f} %{', ' * bool(left)}{left}\n")
        sys.stderr.flush()


MOVING_EVERY, LINE_EVERY = 0.2, 30.0
"""Time between two signs of progress on a terminal and elsewhere [s]."""
