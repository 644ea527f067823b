"""Run the commands that `inspect` advises for a file, as printed."""

import contextlib
import io
import shlex
from importlib import import_module
from pathlib import Path

import pytest

from vehicle.commands.inspect import main as inspect
from vehicle.runs.car import Car

LARGEST = 20_000_000
"""Largest file that is checked [bytes]."""


def advised(file: Path, *options: str) -> tuple[list[list[str]], str]:
    """Return the words of each command that `inspect` prints for a file, and its output; no commands if it fails."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = inspect([str(file), *options])
    assert err.getvalue() == "" or code, f"inspect {file.name}: {err.getvalue()}"
    lines = [line.strip() for line in out.getvalue().splitlines() if line.startswith("  python -m vehicle ")]
    return ([shlex.split(line)[3:] for line in lines] if code == 0 else []), out.getvalue() + err.getvalue()


class _RunBegins(BaseException):
    """Everything that a shaker run needs has been read and accepted."""


_run_whole: set[tuple[str, ...]] = set()


def run_advice(file: Path, folder: Path, *options: str, whole: bool = True) -> list[str]:
    """Run each advised command to its end; return the names of the commands.

    Runs take the reduced engine and draw nothing. The run of a comparison is that of the command above it.

    Args:
        file: measurement file.
        folder: folder for the results.
        options: further options of `inspect`.
        whole: False ends a shaker command where its car begins to run, if one with the same options for a file of this
            format ran to its end in this process, and leaves out the comparison with its run.
    """
    commands, _ = advised(file, *options)
    kind = (file.suffix, *(word for words in commands for word in words if word in words[:1] or word.startswith("--")))
    whole = whole or kind not in _run_whole
    _run_whole.add(kind)
    run = folder / "run"
    for number, (name, *words) in enumerate(commands):
        if name == "compare" and not whole:
            continue
        more = []
        if name == "shaker":
            more = ["--engine", "reduced", "--no-figures", "--quiet", "--output", str(run)]
        elif name == "compare":
            words = [str(run) if word == "RUN" else word for word in words]
            more = ["--no-figures", "--quiet", "--output", str(folder / f"compared_{number}")]
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.MonkeyPatch.context() as patch:
            if not whole:
                patch.setattr(Car, "run", _accepted)
            try:
                code = import_module(f"vehicle.commands.{name}").main([*words, *more])
            except _RunBegins:
                code = 0
        assert code == 0, f"{file.name}: {shlex.join([name, *words])}: {err.getvalue()}"
    return [command[0] for command in commands]


def _accepted(*_: object, **__: object) -> None:
    raise _RunBegins
