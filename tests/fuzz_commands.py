"""Damaged files and options of `compare`, `tune`, `drive`, `body`, of property files and ERD profiles.

Run by `python -m tests.fuzz`.
"""

import functools
import io
import random
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stdout
from pathlib import Path

import numpy as np

from tests.fuzz_files import damaged
from tests.fuzz_texts import mutated
from tests.model.flexbody.modal_test import write_modes
from tests.property_file_set import FILES, write_car
from vehicle.__main__ import main
from vehicle.model.parameters.shipped import FOCUS_FILE

Case = tuple[Callable[[list[str]], int], list[str]]

BAD = (
    "nan", "inf", "-1", "0", "1e400", "1e-300", "1e300", "", ":", "5:2", "2:nan", "a=b", "=", "x=", "*", "*=*",
    "9" * 40, "é", "2:20:3", "1,2", ",", "time=1", "seat_rail_acc_z=*", "knuckle_fl_acc_z=plate*", "none", "-0.0",
    "0.3:0.2",
)  # fmt: skip
"""Values of options that mostly are none."""

HISTORY = ("seat_rail_acc_z", "knuckle_fl_acc_z", "plate_fl_displacement")

READING: Mapping[str, Sequence[str]] = {
    "--unit": ("mm", "g", "plate_fl_displacement=mm"), "--rate": ("500", "1"), "--from": ("0.2", "1.5"),
    "--to": ("1.2", "0.1"), "--resample": ("250",), "--highpass": ("1",), "--delay": ("0.01", "accelerations=2ms"),
    "--detrend": (),
}  # fmt: skip
"""Options of all commands that read a measurement, with values that are allowed."""

OPTIONS: dict[str, Mapping[str, Sequence[str]]] = {
    "compare": {
        **READING, "--map": ("seat_rail_acc_z=knuckle_fl_acc_z", "seat_rail_acc_z=1"), "--turn": ("seat_rail_acc_z",),
        "--drift": ("50", "1e6"), "--window": ("0.5", "30"), "--bands": ("1,5,20", "20,5"), "--json": (),
    },
    "drive": {
        **READING, "--channel": ("knuckle_fl_acc_z=seat_rail_acc_z",), "--band": ("2:20", "1:200"), "--gain": ("0.8",),
        "--target-error": ("50", "0.1"), "--wheel": ("front_left", "rear_left"), "--set": ("damper.viscous=1e5",),
    },
    "tune --record": {
        **READING, "--map": ("knuckle_fl_acc_z=seat_rail_acc_z",), "--turn": ("knuckle_fl_acc_z",),
        "--stretch": ("0.2:1.2", "0:99"), "--lowpass": ("30",), "--drift": ("50",), "--levels": ("2", "30"),
        "--speed": ("50",), "--road": ("C", "bump"), "--contact": ("cams",), "--json": (),
    },
    "tune --frf": {
        **READING, "--map": ("knuckle_fl_acc_z=seat_rail_acc_z",), "--turn": ("knuckle_fl_acc_z",),
        "--band": ("3:20", "3:400"), "--spacing": ("1", "50"), "--averages": ("3",), "--window": ("0.5", "9"),
        "--stuck": (), "--posterior": (), "--samples": ("8",), "--discrepancy": ("5",), "--json": (),
    },
}  # fmt: skip


@functools.cache
def _made() -> tuple[tempfile.TemporaryDirectory[str], Path]:
    """Folder with good files, kept as long as the process."""
    kept = tempfile.TemporaryDirectory()
    folder = Path(kept.name)
    time = np.arange(0.0, 2.0, 0.002)
    height = 2e-3 * np.sin(18.0 * time) + 1e-3 * np.sin(65.0 * time + 1.0) - 1e-3 * np.sin(1.0)
    table = np.column_stack([time, height])
    np.savetxt(folder / "plate.csv", table, "%.6f", ",", header="time [s],displacement [m]", comments="")
    words = ["shaker", "--input", str(folder / "plate.csv"), "--output", str(folder / "run"), "--engine", "reduced"]
    with redirect_stdout(io.StringIO()):
        assert main([*words, "--no-figures", "--channels", ",".join(HISTORY), "--time-format", "csv"]) == 0
    write_modes(folder / "body.uff")
    shutil.copyfile(FOCUS_FILE.with_name("trimmed_body.toml"), folder / "body.toml")
    shutil.copyfile(FOCUS_FILE.with_name("body_design.toml"), folder / "design.toml")
    rows = [f" {3e-3 * np.sin(0.3 * k):.5f} {2e-3 * np.cos(0.2 * k):.5f}" for k in range(400)]
    head = [
        "ERDFILEV2.00", "      2,   400,     -1,      1,      5,       0.0500,     -1,", "TITLE   road",
        "SHORTNAMLElev.  RElev.  ", "UNITSNAMm       m       ", "XLABEL  Distance", "XUNITS  m", "END",
    ]  # fmt: skip
    (folder / "road.erd").write_text("\n".join([*head, *rows]) + "\n", encoding="ascii")
    return kept, folder


def _mutated(data: bytes, rng: random.Random) -> bytes:
    """A text with other numbers and lines, or damaged bytes."""
    text = data.decode("utf-8", errors="surrogateescape")
    return mutated(text, rng).encode("utf-8", "replace") if rng.random() < 0.7 else damaged(data, rng)


def _damaged(name: str, rng: random.Random, chance: float = 1.0) -> str:
    """Write a good file into the working folder, damaged with a probability; returns its name."""
    data = (_made()[1] / name).read_bytes()
    target = Path(name).name
    Path(target).write_bytes(_mutated(data, rng) if rng.random() < chance else data)
    return target


def _options(command: str, rng: random.Random) -> list[str]:
    """Up to three options of a command, one value in three of no use."""
    words = []
    for option in rng.sample(sorted(OPTIONS[command]), rng.randint(0, 3)):
        values = OPTIONS[command][option]
        words += [option, *([rng.choice(BAD if rng.random() < 0.33 else values)] if values else [])]
    return words


def compare_case(rng: random.Random) -> Case:
    """`compare` of a run with its own time histories, damaged."""
    shutil.copytree(_made()[1] / "run", "run")
    of = "run"
    if rng.random() < 0.3:
        of = "run/" + rng.choice(("summary.json", "vehicle.toml", "time.csv"))
        Path(of).write_bytes(_mutated(Path(of).read_bytes(), rng))
        of = "run"
    measured = _damaged("run/time.csv", rng, 0.6)
    return main, ["compare", of, "--measured", measured, *_options("compare", rng), "--no-figures", "--output", "out"]


def drive_case(rng: random.Random) -> Case:
    """`drive` with a damaged target, and one or two iterations."""
    words = ["drive", "--target", _damaged("run/time.csv", rng, 0.5), "--iterations", rng.choice("11112230")]
    words += [] if rng.random() < 0.1 else ["--channel", "knuckle_fl_acc_z=knuckle_fl_acc_z", "--band", "5:30"]
    return main, [*words, "--engine", "reduced", "--no-figures", "--quiet", "--output", "out", *_options("drive", rng)]


def tune_case(rng: random.Random) -> Case:
    """`tune` of one or two parameters to a damaged record, its levels, or its FRF."""
    bounds = rng.choice(("800:4000", "1500:2500", "1:1e9", rng.choice(BAD)))
    words = ["tune", "focus", "--parameters", f"damper.viscous={bounds}"]
    words += ["damper.coulomb_friction=20:200"] if rng.random() < 0.3 else []
    kind = rng.choice(("tune --record", "tune --record", "tune --frf"))
    words += [kind.split()[1], _damaged("run/time.csv", rng, 0.5)]
    words += ["--signal", _damaged("plate.csv", rng, 0.5)] if rng.random() < 0.3 else []
    words += [] if rng.random() < 0.1 else ["--channels", "seat_rail_acc_z,knuckle_fl_acc_z"]
    return main, [*words, "--engine", "reduced", "--output", "out", "--quiet", *_options(kind, rng)]


def body_case(rng: random.Random) -> Case:
    """`body` with a damaged file of modes, body model or design."""
    match rng.randrange(4):
        case 0:
            words = ["import", _damaged("body.uff", rng), "--output", "b.toml", "--modal-mass", rng.choice(("1", *BAD))]
            words = words if rng.random() < 0.3 else words[:-2]
        case 1:
            words = ["show", _damaged("body.toml", rng), "--json"]
        case 2:
            words = ["build", "--design", _damaged("design.toml", rng), "--output", "b.npz"]
        case _:
            first = str(_made()[1] / "body.toml")
            words = ["compare", first, _damaged("body.toml", rng)]
    return main, ["body", *words]


def property_case(rng: random.Random) -> Case:
    """A car with a damaged property file."""
    name = rng.choice(sorted(FILES))
    files = dict(FILES)
    files[name] = _mutated(files[name].encode("latin-1"), rng).decode("latin-1")
    write_car(Path(), files=files)
    return main, rng.choice((["modes", "--json", "--vehicle", "vehicle.toml"], ["show", "vehicle.toml", "--json"]))


def erd_case(rng: random.Random) -> Case:
    """A damaged road profile, listed or driven on."""
    road = _damaged("road.erd", rng)
    if rng.random() < 0.4:
        return main, ["inspect", road, "--json"]
    words = ["shaker", "--road", road, "--speed", rng.choice(("30", "90", "90", *BAD)), "--vehicle", "focus_road"]
    return main, [*words, "--engine", "reduced", "--no-figures", "--channels", "seat", "--output", "out"]


COMMAND_KINDS: dict[str, Callable[[random.Random], Case]] = {
    "compare": compare_case, "drive": drive_case, "tune": tune_case, "body": body_case, "property": property_case,
    "erd": erd_case,
}  # fmt: skip
