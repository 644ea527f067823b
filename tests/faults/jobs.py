"""Jobs of the fault table: each command that writes, with each option that writes, and short inputs."""

import argparse
from collections.abc import Iterator, Sequence
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import numpy as np

from tests.faults.commands import DOOR, Written, writing_alone
from tests.model.flexbody.hung_body import HungBody, write_test
from tests.model.flexbody.modal_test import write_modes
from vehicle import Car, road
from vehicle.__main__ import main
from vehicle.commands import COMMANDS, module_of
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.signals.formats.formats import WRITTEN

SAMPLES, STEP_S = 300, 0.005

READ = {
    "--input", "--road", "--dbc", "--vehicle", "--set", "--controller", "--measured", "--vary", "--table", "--profile",
    "--mass", "--dofs", "--nodes", "--residual", "--point-nodes", "--design", "--target", "--beside", "--tolerance",
    "--parameters", "--frf", "--record", "--signal", "--rival", "--numbers", "--damper-curve-front",
    "--damper-curve-rear", "--channel", "--map", "--unit", "--points", "--cases", "--targets", "--cost",
}  # fmt: skip
"""Options with a file, or with a text of its own, that is read."""

ONLY_NEW_NAMES = {"bench"}
"""Commands that replace nothing: each click writes under a free name, with the functions of shaker and report."""


def writing_options() -> Iterator[tuple[str, str, str]]:
    """Yield command, option and choice of all that writes, from the parsers: an option that names a file or folder.

    Raises:
        AssertionError: an option with a file is neither known as read nor one of those that write.
    """

    def walk(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, str, str]]:
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                for word, inner in action.choices.items():
                    yield from walk(f"{name} {word}", inner)
            option = action.option_strings[0] if action.option_strings else ""
            names_a_file = any(word in str(action.metavar) for word in ("FILE", "DIR", "PATH"))
            if option in ("--format", "--time-format"):
                yield from ((name, option, str(choice)) for choice in action.choices or ())
            elif option == "--force" or (option and names_a_file and option not in READ):
                yield name, option, ""

    for name in COMMANDS:
        if name not in ONLY_NEW_NAMES:
            yield from walk(name, import_module(module_of(name)).parser())


def job_of(wanted: tuple[str, str, str], words: Sequence[str]) -> bool:
    """True if the words of a command write with a command, option and choice of `writing_options`."""
    name, option, choice = wanted
    command, pairs = name.split(), list(pairwise([*words, ""]))
    return list(words[: len(command)]) == command and any(
        word == option and choice in ("", follows) for word, follows in pairs
    )


def signal_file(path: Path, frequency_hz: float) -> Path:
    """Write a plate signal of a sine and noise, which excites every frequency."""
    time, chance = STEP_S * np.arange(SAMPLES), np.random.default_rng(round(frequency_hz))
    height = 2e-3 * np.sin(2.0 * np.pi * frequency_hz * time) + 1e-4 * chance.standard_normal(SAMPLES)
    rows = np.column_stack([time, height - height[0]])
    np.savetxt(path, rows, "%.7f", ",", header="time [s],displacement [m]", comments="")
    return path


def mount_file(path: Path, stiffness: float) -> Path:
    """Write a measured dynamic stiffness."""
    rows = [f"{f},0.1,{stiffness + f},{5 + 0.2 * f}" for f in range(1, 40, 4)]
    path.write_text("frequency [Hz],amplitude [mm],stiffness [N/mm],loss_angle [deg]\n" + "\n".join(rows) + "\n")
    return path


def damper_file(path: Path, damping: float) -> Path:
    """Write a test of a viscous damper with friction."""
    time = np.arange(200) / 200.0
    x, v = 0.02 * np.sin(2.0 * np.pi * time), 0.04 * np.pi * np.cos(2.0 * np.pi * time)
    table = np.column_stack([time, 1e3 * x, 1e3 * v, damping * v + 60.0 * np.tanh(v / 1e-4)])
    head = "time [s],displacement [mm],velocity [mm/s],force [N]"
    np.savetxt(path, table, delimiter=",", header=head, comments="")
    return path


def drive_file(path: Path, seed: int) -> Path:
    """Write a record of a drive over a road."""
    names = [f"seat_rail_acc_{axis}" for axis in "xyz"]
    run = Car.load("focus_road").run(road("C", 80, duration=21, seed=seed), "reduced", channels=names)
    rows = np.column_stack([run.time, *(run[name] for name in names)])[run.time >= 3.0]
    head = ",".join(["time [s]", *(f"{name} [m/s2]" for name in names)])
    np.savetxt(path, rows, "%.5f", ",", header=head, comments="")
    return path


def shipped_copies(inputs: Path, file: Path, old: str, new: str) -> list[str]:
    """Write a copy of a shipped file, and one with another number."""
    text = file.read_text(encoding="utf-8")
    assert old in text
    copies = [inputs / f"{number}_{file.name}" for number in (1, 2)]
    for copy, content in zip(copies, (text, text.replace(old, new, 1)), strict=True):
        copy.write_text(content, encoding="utf-8")
    return [str(copy) for copy in copies]


def commands(inputs: Path) -> list[Written]:
    """Write the inputs and return the commands."""
    inputs.mkdir(exist_ok=True)
    first, second = signal_file(inputs / "first.csv", 3.0), signal_file(inputs / "second.csv", 4.0)
    mounts = mount_file(inputs / "mount1.csv", 200.0), mount_file(inputs / "mount2.csv", 300.0)
    dampers = damper_file(inputs / "damper1.csv", 1200.0), damper_file(inputs / "damper2.csv", 1500.0)
    drives = drive_file(inputs / "drive1.csv", 1), drive_file(inputs / "drive2.csv", 2)
    tables = inputs / "car1.csv", inputs / "car2.csv"
    for path, mass in zip(tables, (1450, 1500), strict=True):
        path.write_text(f"mass,{mass},kg\nfront wheel centre x,0,mm\nfront wheel centre y,750,mm\n"
                        "front wheel centre z,300,mm\nfront strut top x,40,mm\nfront strut top y,571,mm\n"
                        "front strut top z,765,mm\naxes: Adams\n")  # fmt: skip
    runs = inputs / "run1", inputs / "run2"
    for run, source in zip(runs, (first, second), strict=True):
        if not run.exists():
            options = ["--input", str(source), "--output", str(run), "--engine", "reduced", "--no-figures"]
            assert main(["shaker", *options, "--channels", "loads", "--time-format", "csv"]) == 0
    bodies = inputs / "body1.uff", inputs / "body2.uff"
    for body, speed in zip(bodies, (1.0, 1.1), strict=True):
        write_modes(body, speed=speed)
    hung = [write_test(inputs / f"hung{seed}.uff", HungBody(seed=seed), np.arange(8.0, 75.0, 2.0)) for seed in (1, 2)]
    shipped = FOCUS_FILE.with_name("trimmed_body.toml")
    others = shipped_copies(inputs, shipped, "frequency_hz = 19.0", "frequency_hz = 19.1")
    designs = shipped_copies(inputs, FOCUS_FILE.with_name("body_design.toml"), "ratio = 0.03", "ratio = 0.02")
    histories = tuple(str(run / "time.csv") for run in runs)

    def job(name: str, words: Sequence[str], old: Sequence[str], new: Sequence[str]) -> Written:
        return Written(name, [*words, *old], [*words, *new, "--force"], draws="--video" in words)

    def signals(name: str, *words: str) -> Written:
        return job(name, words, ["--input", str(first)], ["--input", str(second)])

    def changed(name: str, *words: str) -> Written:
        return job(name, words, [], ["--set", "damper.coulomb_friction=80"])

    shaker = ("shaker", "--engine", "reduced", "--output", "a")
    vary = ("--vary", "damper.coulomb_friction=50,100", "--engine", "reduced", "--output", "a")
    search = ("--vary", "damper.coulomb_friction=50:100", "--minimise", "weighted", "--cars", "8", "--population", "8")
    new = ("new", "a", "--from", "sedan", "--wheelbase", "2.65", "--front-axle-load", "800", "--kerb-mass")
    class_road = ("road", "--speed", "80", "--duration", "2", "--output", "a.csv", "--class")
    kinematics = ("kinematics", "--vehicle", "sedan", "--output", "a", "--travel", "0:10:10", "--axle")
    orders = ("orders", "--vehicle", "sedan", "--set", "front.imbalance.mass=0.01", "--set",
              "front.imbalance.radius=0.2", "--duration", "4", "--output", "a", "--speed")  # fmt: skip
    channel = ("--channel", "knuckle_fl_acc_z=knuckle_fl_acc_z", "--band", "2:20", "--iterations", "3",
               "--wheel", "front_left")  # fmt: skip
    mapped = (str(runs[0]), "--map", "seat_rail_acc_z=seat_rail_acc_z")
    fitted = ("--parameters", "damper.viscous=800:4000", "--engine", "reduced", "--channels", "knuckle_fl_acc_z")
    return [
        *(Written(writing_alone(kind), ["door", kind, "old"], ["door", kind, "new"]) for kind in DOOR),
        signals("shaker", *shaker, "--no-figures"),
        signals("shaker with figures", *shaker),
        *(signals(f"shaker --format {ending}", *shaker, "--no-figures", "--format", ending) for ending in WRITTEN),
        *(signals(f"shaker --time-format {ending}", *shaker, "--no-figures", "--time-format", ending)
          for ending in ("npz", "csv")),
        signals("shaker --report", *shaker, "--no-figures", "--report"),
        signals("sweep", "sweep", *vary, "--executor", "tests.faults.commands:InProcess"),
        signals("sweep --report", "sweep", *vary, "--executor", "tests.faults.commands:InProcess", "--report"),
        signals("optimise", "optimise", *search, "--output", "a"),
        job("road", class_road, ["A"], ["B"]),
        job("kinematics", kinematics, ["front"], ["rear"]),
        job("orders", orders, ["100:110:10"], ["110:120:10"]),
        job("loads", ["loads", "--output", "."], [str(runs[0])], [str(runs[1])]),
        job("spectra", ["spectra", "--output", "."], [str(runs[0])], [str(runs[1])]),
        job("report", ["report", "--output", "a.html"], [str(runs[0])], [str(runs[1])]),
        job("compare", ["compare", *mapped, "--output", "a", "--measured"], [histories[0]], [histories[1]]),
        job("drive", ["drive", *channel, "--output", "a", "--target"], [histories[0]], [histories[1]]),
        job("tune", ["tune", "focus", *fitted, "--output", "a", "--record"], [histories[0]], [histories[1]]),
        job("new", new, ["1450"], ["1500"]),
        job("new --table", ["new", "a", "--table"], [str(tables[0])], [str(tables[1])]),
        changed("mjcf", "mjcf", "--output", "a"),
        changed("show", "show", "--output", "a"),
        changed("levels", "levels", "focus", "--frequency", "3,8", "--level", "0.1,1", "--output", "a"),
        changed("fmu", "fmu", "--output", "a.fmu"),
        job("modes --uff", ["modes", "--uff", "a.uff", "--damper"], ["stuck"], ["sliding"]),
        job("diagnose", ["diagnose", "--vehicle", "focus_road", "--speed", "80", "--drives", "160", "--output", "a"],
            [str(drives[0])], [str(drives[1])]),
        job("fit-mount", ["fit-mount", "--output", "a"], [str(mounts[0])], [str(mounts[1])]),
        job("fit-damper", ["fit-damper", "--output", "a"], [str(dampers[0])], [str(dampers[1])]),
        job("body import", ["body", "import", "--output", "a.toml"], [str(bodies[0])], [str(bodies[1])]),
        job("body build", ["body", "build", "--output", "a.npz", "--design"], [designs[0]], [designs[1]]),
        job("body rigid", ["body", "rigid", "--output", "a.toml"], [str(hung[0])], [str(hung[1])]),
        job("body show", ["body", "show", "--output", "a"], [others[0]], [others[1]]),
        job("body compare", ["body", "compare", "--output", "a", str(shipped)], [others[0]], [others[1]]),
        job("body participation", ["body", "participation", "--output", "a", "--damper"], ["stuck"], ["sliding"]),
        job("modes --video", ["modes", "--video", "a.mp4", "--animate"], ["20"], ["30"]),
        job("report --video", ["report", "--output", "a.html", "--video", "a.mp4", "--video-duration", "0.1"],
            [str(runs[0])] * 2, [str(runs[1])] * 2),
        signals("shaker --video", "shaker", "--no-figures", "--output", "a", "--video", "--video-duration", "0.1"),
    ]  # fmt: skip
