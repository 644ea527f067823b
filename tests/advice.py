"""Run the commands that `inspect` advises for a file, as printed."""

import contextlib
import io
import shlex
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from vehicle.commands.inspect import main as inspect


def advised(file: Path, *options: str) -> tuple[list[list[str]], str]:
    """Return the words of each command that `inspect` prints for a file, and its output; no commands if it fails."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = inspect([str(file), *options])
    assert err.getvalue() == "" or code, f"inspect {file.name}: {err.getvalue()}"
    lines = [line.strip() for line in out.getvalue().splitlines() if line.startswith("  python -m vehicle ")]
    return ([shlex.split(line)[3:] for line in lines] if code == 0 else []), out.getvalue() + err.getvalue()


def run_advice(file: Path, folder: Path, *options: str, commands: Sequence[Sequence[str]] | None = None) -> list[str]:
    """Run each advised command to its end; return the names of the commands.

    Runs take the reduced engine and draw nothing. The run of a comparison is that of the command above it.

    Args:
        file: measurement file.
        folder: folder for the results.
        options: further options of `inspect`.
        commands: what it advises, if that is known.
    """
    commands = advised(file, *options)[0] if commands is None else commands
    run = folder / "run"
    for number, (name, *words) in enumerate(commands):
        more = []
        if name == "shaker":
            more = ["--engine", "reduced", "--no-figures", "--quiet", "--output", str(run)]
        elif name == "compare":
            words = [str(run) if word == "RUN" else word for word in words]
            more = ["--no-figures", "--quiet", "--output", str(folder / f"compared_{number}")]
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = import_module(f"vehicle.commands.{name}").main([*words, *more])
        assert code == 0, f"{file.name}: {shlex.join([name, *words])}: {err.getvalue()}"
    return [command[0] for command in commands]
