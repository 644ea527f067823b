"""Commands whose system calls are made to fail, each with short inputs."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from vehicle.__main__ import main
from vehicle.commands.command_line import run_command
from vehicle.runs.output.folder import output_folder, study_folder, whole_files, write_text
from vehicle.runs.output.written_files import note

SAMPLES, STEP_S = 300, 0.005


@dataclass(frozen=True)
class Written:
    """A command that writes.

    Attributes:
        name: name in the table.
        old: arguments that make the results of before.
        new: arguments that replace them.
    """

    name: str
    old: Sequence[str]
    new: Sequence[str]


def run_words(words: Sequence[str]) -> int:
    """Run a command, or with the word "door" only its way of writing, with small files; returns the exit code."""
    return run_command(partial(_write_only, *words[1:])) if words[0] == "door" else main(list(words))


def _write_only(kind: str, content: str) -> None:
    """Replace results by files with a content, as the commands do; the kind "renames" has no exchange in one step."""
    if kind == "renames":
        ctypes.CDLL(None).faults_without_exchange(1)
    if kind == "file":
        return write_text(Path("a.csv"), content)
    if kind == "files":
        with whole_files([Path(name) for name in ("a.csv", "b.csv", "c.csv")]) as paths:
            for path in paths:
                write_text(path, content)
        return None
    rows = ("rows.jsonl",) if kind == "study" else ()
    made = study_folder(Path("a"), force=True, rows=rows) if rows else output_folder(Path("a"), force=True)
    with made as folder:
        for name in rows:
            note(folder / name)
            (folder / name).write_text(content)
        write_text(folder / "a.csv", content)
        write_text(folder / "below" / "b.csv", content)
    return None


DOOR = {
    "file": "one file",
    "files": "several files among others",
    "folder": "a folder",
    "renames": "a folder by two renames",
    "study": "a folder with finished rows",
}


def writing_alone(kind: str) -> str:
    """Return the name of a kind of `DOOR` in the table."""
    return f"only writing: {DOOR[kind]}"


class InProcess(Executor):
    """Executor of a sweep that computes at once, in this process."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **named))
        except Exception as error:
            future.set_exception(error)
        return future


def write_signal_file(path: Path, frequency_hz: float) -> None:
    """Write a plate signal of two sines."""
    lines = ["time [s],displacement [m]"]
    for number in range(SAMPLES):
        time = number * STEP_S
        height = 2e-3 * math.sin(2.0 * math.pi * frequency_hz * time) + 3e-4 * math.sin(70.0 * time)
        lines.append(f"{time:.3f},{height:.7f}")
    path.write_text("\n".join(lines) + "\n")


def _with_format(words: Sequence[str], path: Path, *, ending: str) -> list[str]:
    return [*words, str(path), "--format", ending]


def commands(inputs: Path) -> list[Written]:
    """Write the inputs and return the commands."""
    inputs.mkdir(exist_ok=True)
    first, second = inputs / "first.csv", inputs / "second.csv"
    write_signal_file(first, 3.0)
    write_signal_file(second, 4.0)
    mounts = inputs / "mount1.csv", inputs / "mount2.csv"
    for number, mount in enumerate(mounts, 2):
        rows = [f"{f},0.1,{100 * number + f},{5 + 0.2 * f}" for f in range(1, 40, 4)]
        mount.write_text("frequency [Hz],amplitude [mm],stiffness [N/mm],loss_angle [deg]\n" + "\n".join(rows) + "\n")
    for name, source in (("run1", first), ("run2", second)):
        if not (inputs / name).exists():
            options = ["--input", str(source), "--output", str(inputs / name), "--engine", "reduced", "--no-figures"]
            assert main(["shaker", *options, "--channels", "loads"]) == 0

    def pair(make: Callable[[Path], list[str]]) -> tuple[list[str], list[str]]:
        return make(first), [*make(second), "--force"]

    def run(make: Callable[[Path], list[str]]) -> tuple[list[str], list[str]]:
        return make(inputs / "run1"), [*make(inputs / "run2"), "--force"]

    shaker = ["shaker", "--engine", "reduced", "--no-figures", "--output", "a", "--input"]
    drawn = [word for word in shaker if word != "--no-figures"]
    varied = ["--vary", "damper.coulomb_friction=50,100", "--engine", "reduced", "--output", "a"]
    varied += ["--executor", "tests.faults.commands:InProcess", "--input"]
    vary = ["--vary", "damper.coulomb_friction=50:100", "--minimise", "weighted", "--cars", "8", "--population", "8"]
    kinematics = ["kinematics", "--vehicle", "sedan", "--output", "a", "--axle"]
    new = ["new", "a", "--from", "sedan", "--wheelbase", "2.65", "--front-axle-load", "800", "--kerb-mass"]
    formats = {ending: f"shaker --format {ending}" for ending in ("h5", "mat", "rpc", "mf4")}
    return [
        *(Written(writing_alone(kind), ["door", kind, "old"], ["door", kind, "new"]) for kind in DOOR),
        Written("shaker", *pair(lambda path: [*shaker, str(path)])),
        Written("shaker with figures", *pair(lambda path: [*drawn, str(path)])),
        *(
            Written(name, *pair(partial(_with_format, shaker, ending=ending)))
            for ending, name in formats.items()
        ),
        Written("sweep", *pair(lambda path: ["sweep", *varied, str(path)])),
        Written("optimise", *pair(lambda path: ["optimise", *vary, "--output", "a", "--input", str(path)])),
        Written("road", ["road", "--class", "A", "--speed", "80", "--duration", "2", "--output", "a.csv"],
                ["road", "--class", "B", "--speed", "80", "--duration", "2", "--output", "a.csv", "--force"]),
        Written("kinematics", [*kinematics, "front", "--travel", "0:10:10"],
                [*kinematics, "rear", "--travel", "0:10:10", "--force"]),
        Written("loads", *run(lambda path: ["loads", str(path), "--output", "."])),
        Written("spectra", *run(lambda path: ["spectra", str(path), "--output", "."])),
        Written("report", *run(lambda path: ["report", str(path), "--output", "a.html"])),
        Written("new", [*new, "1450"], [*new, "1500", "--force"]),
        Written("mjcf", ["mjcf", "--output", "a"], ["mjcf", "--vehicle", "sedan", "--output", "a", "--force"]),
        Written("show", ["show", "--output", "a"], ["show", "--set", "damper.coulomb_friction=80", "--output", "a",
                "--force"]),
        Written("fmu", ["fmu", "--output", "a.fmu"],
                ["fmu", "--set", "damper.coulomb_friction=80", "--output", "a.fmu", "--force"]),
        Written("fit-mount", ["fit-mount", str(mounts[0]), "--output", "a"],
                ["fit-mount", str(mounts[1]), "--output", "a", "--force"]),
    ]  # fmt: skip
