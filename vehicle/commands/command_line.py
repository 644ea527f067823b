"""Frame of every command: from its arguments to settings, one message for each error, exit codes, interruption."""

import argparse
import atexit
import gc
import io
import os
import signal
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import FrameType
from typing import Any, TypeVar

from vehicle.commands.accepted_advice import ROUNDS, retried
from vehicle.commands.console import Console, asked_to_end, moving_lines
from vehicle.commands.options import read
from vehicle.commands.parser import Parser, idle_options
from vehicle.commands.printable import printable_streams
from vehicle.errors import ConfigurationError, OutputError, VehicleError
from vehicle.signals.records.finding import FindingError
from vehicle.threads import prefer_one_thread
from vehicle.wording import in_command

Settings = TypeVar("Settings")

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
    asked_to_end.clear()
    lost = _stand_in_for_closed_streams()
    with printable_streams(), in_command():
        return _exit_code(job, previous, lost, debug=debug)


def _exit_code(
    job: Callable[[], None], previous: Mapping[signal.Signals, Any], lost: io.StringIO | None, *, debug: bool
) -> int:
    """Run the job; see `run_command`.

    Args:
        previous: handlers of signals, restored at the end.
        lost: substitute of a closed standard output; None: it is open.
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
        _say("out of memory; use a shorter input, or store fewer samples per second with --set solver.record_rate=HZ")
        return VehicleError.exit_code
    except Exception as error:
        if debug:
            traceback.print_exc()
        _say(
            f"{FAULT} ({type(error).__name__}: {error}); please report it with the output of the same command with "
            "--debug"
        )
        return VehicleError.exit_code
    finally:
        for line in tuple(moving_lines):
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


def parse_and_run(
    parser: Parser, job: Callable[[argparse.Namespace, Console], None], arguments: Sequence[str] | None
) -> int:
    """Parse the arguments of a command, run its job, and return the exit code of `run_command`.

    Args:
        parser: with the option --debug.
        job: work of the command with the parsed options and its console; the options also have `held`, an exit stack
            that is closed when the command ends.
        arguments: without the program name; by default the arguments of the process.
    """
    typed = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        begin_process()

    def work() -> None:
        for word in typed:
            if "\0" in word:
                raise ConfigurationError(f"argument {word!r}: contains a NUL character; remove it")
        line: list[str] | None = typed
        accepted: set[tuple[str, str]] = set()  # what --accept-advice has added
        rounds = 0
        while line is not None:
            with ExitStack() as held:
                options = parser.parse_args(line, argparse.Namespace(words=line, held=held, accepted=accepted))
                console = Console(
                    words=tuple(line),
                    quiet=getattr(options, "quiet", False),
                    json=getattr(options, "json", False),
                    accept_advice=getattr(options, "accept_advice", False),
                    accepted=accepted,
                    idle=idle_options(options),
                )
                if line is typed:
                    _mention_leftovers(typed, getattr(options, "output", None))
                try:
                    job(options, console)
                    line = None
                except FindingError as error:
                    rounds += 1
                    line = retried(error, console) if rounds <= ROUNDS else None
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


def command(
    parser: Callable[[], Parser],
    settings: type[Settings] | Callable[[argparse.Namespace], Settings],
    job: Callable[[Settings, Console], None],
) -> Callable[..., int]:
    """Return the `main` function of a command: from its arguments to its exit code, see `parse_and_run`.

    Args:
        parser: makes the parser of the options.
        settings: class of the settings, or function that makes them of the parsed options.
        job: work of the command.
    """

    def work(options: argparse.Namespace, console: Console) -> None:
        job(read(options, settings) if isinstance(settings, type) else settings(options), console)

    return lambda arguments=None: parse_and_run(parser(), work, arguments)


FAULT = "internal error"
"""Beginning of the message of an unexpected error."""


def _interrupt(number: int, frame: FrameType | None) -> None:
    asked_to_end.set()
    raise KeyboardInterrupt


def _say(message: str) -> None:
    print(f"error: {message}", file=sys.stderr)
