"""Frame of every command: one message for each error, exit codes, interruption, a progress line."""

import argparse
import atexit
import gc
import io
import json
import math
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import FrameType
from typing import Any

from vehicle.commands.accepted_advice import ROUNDS, retried
from vehicle.commands.parser import Parser
from vehicle.commands.printable import printable_streams
from vehicle.digits import duration
from vehicle.errors import ConfigurationError, OutputError, VehicleError
from vehicle.signals.records.finding import FindingError
from vehicle.threads import prefer_one_thread

INTERRUPTED = 130

OPENGL = {"win32": ("glfw", "wgl"), "darwin": ("glfw", "cgl")}.get(sys.platform, ("osmesa", "egl", "glfw", "glx"))
"""OpenGL backends that MuJoCo accepts on this system; its import fails with any other value of MUJOCO_GL."""

SWITCHES = ("", "enable", "enabled", "on", "true", "1", "disable", "disabled", "off", "false", "0")
"""Further values of MUJOCO_GL."""

COLLECTED = (20_000, 5, 5)
"""Thresholds of the garbage collector in a command, see `gc.set_threshold`. The imported libraries create half a
million permanent objects; with the default thresholds of Python their collection takes 10 % of the time of a run."""

FIRST_COLLECTED = 600_000
"""Threshold of the first collection: nearly all objects until then are permanent, and collecting them in vain takes
4 % of the time of a short run."""


def run_command(job: Callable[[], None], *, debug: bool = False) -> int:
    """Run the job of a command, and convert a failure to one message and an exit code.

    Returns:
        0, or the code of the failure: 2 usage, 3 data, 4 simulation, 5 missing part, 6 output, 130 interrupted.
    """
    # SIGTERM cleans up like Ctrl-C.
    previous = {number: signal.signal(number, _interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    _asked_to_end.clear()
    lost = _stand_in_for_closed_streams()
    with printable_streams():
        return _exit_code(job, previous, lost, debug=debug)


def _exit_code(
    job: Callable[[], None], previous: Mapping[signal.Signals, Any], lost: io.StringIO | None, *, debug: bool
) -> int:
    """Run the job; see `run_command`.

    Args:
        job: work of the command.
        previous: handlers of signals, restored at the end.
        lost: substitute of a closed standard output; None: it is open.
        debug: print the traceback of a failure.
    """
    try:
        backend = os.environ.get("MUJOCO_GL", "").strip().lower()
        if backend not in (*OPENGL, *SWITCHES):
            raise ConfigurationError(
                f"environment variable MUJOCO_GL={backend}: is not an OpenGL backend; must be "
                f"{', '.join(OPENGL)} or unset"
            )
        job()
        _flush()
        if lost is not None and lost.getvalue():
            raise OutputError("standard output is closed: the printed results are lost")
    except KeyboardInterrupt:
        _say("interrupted; every file written so far is complete")
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
        _say("out of memory; use a shorter input, or store fewer samples a second with --set solver.record_rate=HZ")
        return VehicleError.exit_code
    except Exception as error:
        if debug:
            traceback.print_exc()
        _say(
            f"{FAULT} ({type(error).__name__}: {error}); please report it together with the output of the same "
            "command with --debug"
        )
        return VehicleError.exit_code
    finally:
        for line in tuple(_moving_lines):
            line.stop()
        for number, handler in previous.items():
            signal.signal(number, handler)
    return 0


def begin_process() -> None:
    """Set up garbage collector, OpenGL and threads for the process of a command; call it before heavy imports."""
    gc.set_threshold(FIRST_COLLECTED, *COLLECTED[1:])
    gc.callbacks.append(_collect_more_often)
    # The operating system frees the memory; a last collection would take as long as a run.
    atexit.register(gc.freeze)
    # Without this MuJoCo loads the GLFW library at its import. Films select a backend themselves.
    os.environ.setdefault("MUJOCO_GL", "disable")
    prefer_one_thread()
    if isinstance(sys.stdout, io.TextIOWrapper) and sys.stdout.errors == "strict":
        # A pipe of Windows takes cp1252, which lacks most characters that a file name may have.
        sys.stdout.reconfigure(errors="backslashreplace")


def _collect_more_often(phase: str, information: dict[str, int]) -> None:
    """Set the thresholds that apply from the first collection on; called by the garbage collector."""
    gc.callbacks.remove(_collect_more_often)
    gc.set_threshold(*COLLECTED)


def _stand_in_for_closed_streams() -> io.StringIO | None:
    """Replace standard streams that were closed at the start (>&-); return the substitute of stdout, or None."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass  # a file of the run must not get descriptor 0, 1 or 2
    os.close(descriptor)
    if sys.stderr is None:
        sys.stderr = io.StringIO()
    if sys.stdout is None:
        sys.stdout = io.StringIO()
        return sys.stdout
    return None


def _flush() -> None:
    """Flush standard output; an error, for example a full disk, is raised here."""
    try:
        sys.stdout.flush()
    except OSError:
        _print_nowhere()
        raise


def _print_nowhere() -> None:
    """Redirect standard output to the null device, after its reader has ended (| head) or its disk is full."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def parse_and_run(parser: Parser, job: Callable[[argparse.Namespace], None], arguments: Sequence[str] | None) -> int:
    """Parse the arguments of a command and run its job.

    Args:
        parser: with the option --debug.
        job: work of the command with the parsed options; they also have `words`, the arguments, `held`, an exit
            stack that is closed when the command ends, and `accepted`, the options that --accept-advice has added.
        arguments: without the program name; those of the process by default.

    Returns:
        Exit code, see `run_command`.
    """
    typed = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        begin_process()

    def work() -> None:
        for word in typed:
            if "\0" in word:
                raise ConfigurationError(f"argument {word!r}: contains a NUL character; remove it")
        line: list[str] | None = typed
        accepted: set[tuple[str, str]] = set()
        rounds = 0
        while line is not None:
            with ExitStack() as held:
                options = parser.parse_args(line, argparse.Namespace(words=line, held=held, accepted=accepted))
                if line is typed:
                    _mention_leftovers(typed, getattr(options, "output", None))
                try:
                    job(options)
                    line = None
                except FindingError as error:
                    rounds += 1
                    line = retried(error, options) if rounds <= ROUNDS else None
                    if line is None:
                        raise

    # Not from the parsed options: --debug also applies to an error of the parser.
    return run_command(work, debug="--debug" in typed)


def _mention_leftovers(arguments: Sequence[str], output: Path | None) -> None:
    """Print what a killed command left at the paths of a command line; a command that writes clears its output."""
    from vehicle.leftovers import mention

    for text in dict.fromkeys(part for word in arguments for part in (word, word.partition("=")[2])):
        if text and not text.startswith("-") and Path(text) != output:
            mention(Path(text))


def command(parser: Callable[[], Parser], job: Callable[[argparse.Namespace], None]) -> Callable[..., int]:
    """Return the `main` function of a command: from its arguments to its exit code, see `parse_and_run`."""
    return lambda arguments=None: parse_and_run(parser(), job, arguments)


def print_result(options: argparse.Namespace, content: Any, text: object) -> None:
    """Print the content as JSON with --json, else the text, which --quiet leaves out."""
    if options.json:
        print(json.dumps(content, indent=2, allow_nan=False), flush=True)
    elif not getattr(options, "quiet", False):
        print(text, flush=True)


FAULT = "a fault of the program"
"""Beginning of the message of an unexpected error."""

_asked_to_end = threading.Event()
"""Set by SIGINT and SIGTERM: a KeyboardInterrupt can be lost in a Python callback that C code calls."""


def _interrupt(number: int, frame: FrameType | None) -> None:
    _asked_to_end.set()
    raise KeyboardInterrupt


def _say(message: str) -> None:
    print(f"error: {message}", file=sys.stderr)


class ProgressLine:
    """Progress of a long computation: a bar on a terminal, a new line every half minute in a file.

    The bar moves every second even if no part of the computation ends: the time left counts down, or without an
    estimate the time so far counts up.

    Args:
        runs: number of runs of the computation; the line then has the number of finished runs too.
    """

    def __init__(self, work: str, *, enabled: bool = True, runs: int = 0) -> None:
        self.what = work
        self.runs = runs
        self.enabled = enabled
        self.moving = sys.stderr.isatty()
        self.started = time.monotonic()
        self.last = self.started - (MOVING_EVERY if self.moving else 0.0)
        self.first: tuple[float, float] | None = None
        self.fraction, self.end = 0.0, math.nan  # expected time of the end
        self._ended = threading.Event()
        if enabled and self.moving:
            _moving_lines.add(self)
            threading.Thread(target=self._beat, daemon=True).start()

    def __call__(self, fraction: float) -> None:
        """Print a finished fraction [-]; raise KeyboardInterrupt after a lost interruption."""
        if _asked_to_end.is_set():
            raise KeyboardInterrupt
        now = time.monotonic()
        if self.first is None:
            self.first = (now, fraction)  # the time left is estimated without compiling and reading
        begun, done = self.first
        if fraction > done:
            self.end = now + (now - begun) * (1.0 - fraction) / (fraction - done)
        self.fraction = fraction
        due = now - self.last >= (MOVING_EVERY if self.moving else LINE_EVERY) or (self.moving and fraction >= 1.0)
        # The first estimate of many runs comes at once: it tells whether to wait.
        due = due or (bool(self.runs) and self.last == self.started and self.end - now > LINE_EVERY)
        if not (self.enabled and due) or self._ended.is_set():
            return
        self.last = now
        if self.moving:
            self._draw(now)
        else:
            left = "" if math.isnan(self.end) else f", {duration(self.end - now)} left"
            counted = f", {self._counted()}" if self.runs else ""
            sys.stderr.write(f"{self.what.strip()}: {100 * fraction:.0f} %{counted}{left}\n")
            sys.stderr.flush()
        if fraction >= 1.0:
            self.stop()

    def stop(self) -> None:
        """End the movement of the bar, because the computation has ended or failed."""
        self._ended.set()
        _moving_lines.discard(self)

    def _beat(self) -> None:
        """Draw the bar every second until the computation ends."""
        while not self._ended.wait(BEAT):
            now = time.monotonic()
            if now - self.last >= BEAT:
                self._draw(now)

    def _draw(self, now: float) -> None:
        """Draw the bar with the time left [s], or without an estimate with the time so far."""
        bar = "#" * round(30 * self.fraction)
        newline = "\n" if self.fraction >= 1.0 else ""
        elapsed = f"after {now - self.started:.0f} s"
        remark = elapsed if math.isnan(self.end) else f"{duration(max(self.end - now, 0.0))} left"
        counted = f"  {self._counted()}" if self.runs else ""
        stream = getattr(sys.stderr, "stream", sys.stderr)  # the carriage return is intended
        stream.write(f"\r{self.what} [{bar:<30}] {100 * self.fraction:3.0f} %{counted}  {remark:>12} {newline}")
        sys.stderr.flush()

    def _counted(self) -> str:
        """Return the number of finished runs of all."""
        return f"{round(self.fraction * self.runs)} of {self.runs} runs"


_moving_lines: set[ProgressLine] = set()
"""Bars that move on a terminal; the end of a command stops them."""

MOVING_EVERY, LINE_EVERY = 0.2, 30.0
"""Minimum time between two outputs on a terminal and in a file [s]."""

BEAT = 1.0
"""Time after which the bar of a terminal moves without a finished part [s]."""
