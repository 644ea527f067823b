"""Damaged files of loggers, bus logs, frames and Parquet against `vehicle inspect`; run by `python -m tests.fuzz`."""

import functools
import io
import json
import random
import resource
import tempfile
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np

from tests.signals.formats.logger_files import DBC, TEXTS
from vehicle.commands import inspect

LARGEST_GROWTH = 400.0
"""Growth of the memory of the process in a case that is absurd for files of some kB [MB]."""
SIGNS = (",", ";", "\t", " ", "|", ":", "\n", "\r\n", '"', "\0", ".", "-")
NUMBERS = ("1e400", "-1e300", "9" * 300, "nan", "inf", "0x1F", "1_000", "1e-400", "2147483648", "-1", "1,5", "", "é")


def damaged(data: bytes, rng: random.Random) -> bytes:
    """Bytes with one to three of: cut, a hole, bytes changed, NULs, a piece twice; and for text what `retyped` does."""
    for _ in range(rng.randint(1, 3)):
        at = rng.randrange(len(data) + 1)
        match rng.randrange(8):
            case 0:
                data = data[:at]
            case 1:
                data = data[:at] + data[at + rng.randint(1, 40) :]
            case 2:
                changed = bytearray(data)
                for _ in range(min(rng.randint(1, 6), len(changed))):
                    changed[rng.randrange(len(changed))] = rng.randrange(256)
                data = bytes(changed)
            case 3:
                data = data[:at] + bytes(rng.randint(1, 8)) + data[at:]
            case 4:
                data = data[:at] + data[at // 2 : at] + data[at:]
            case _:
                data = retyped(data, rng)
    return data


def retyped(data: bytes, rng: random.Random) -> bytes:
    """A text with other delimiters, a line lost, moved or twice, or another number; other bytes as they are."""
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        return data
    lines = text.split("\n")
    at, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    match rng.randrange(6):
        case 0:
            old, new = rng.choice(SIGNS), rng.choice(SIGNS)
            text = text.replace(old, new, rng.choice([-1, 1, 5]))
        case 1:
            text = "\n".join(lines[:at] + lines[at + 1 :])
        case 2:
            lines[at], lines[other] = lines[other], lines[at]
            text = "\n".join(lines)
        case 3:
            text = "\n".join([*lines[:at], *lines[at:other], *lines[at:]])
        case 4:
            cells = lines[at].split("\t" if "\t" in lines[at] else ",")
            cells[rng.randrange(len(cells))] = rng.choice(NUMBERS)
            lines[at] = ("\t" if "\t" in lines[at] else ",").join(cells)
            text = "\n".join(lines)
        case 5:
            text = text.replace(rng.choice("0123456789."), rng.choice(("7", "", "e9", "-")), rng.choice([1, 3, -1]))
    return text.encode("utf-8")


@functools.cache
def good_files() -> dict[str, bytes]:
    """Name to bytes of a good file of each format."""
    found = {name: text.encode("utf-8") for name, text in TEXTS.items()}
    with tempfile.TemporaryDirectory() as folder:
        for name, make in _MAKERS.items():
            path = Path(folder) / name
            try:
                make(path)
            except ImportError:
                continue  # an extra that is not installed
            found[name] = path.read_bytes()
    return found


def _parquet(path: Path) -> None:
    pyarrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    stamps = pyarrow.array(1770664802000000000 + 10000000 * np.arange(50), pyarrow.timestamp("ns"))
    parquet.write_table(pyarrow.table({"when": stamps, "acc_z_g": np.arange(50.0), "x": ["a"] * 50}), path)


def _frame(path: Path) -> None:
    h5py = import_module("h5py")
    with h5py.File(path, "w") as file:
        group = file.create_group("data")
        group.attrs.update({"pandas_type": np.bytes_("frame"), "nblocks": 1})
        group["axis0"] = group["block0_items"] = np.array([b"a", b"b"])
        group["axis1"] = 1770664802000000000 + 10000000 * np.arange(8)
        group["axis1"].attrs["kind"] = np.bytes_("datetime64")
        group["block0_values"] = np.arange(16.0).reshape(8, 2)
        file["row"] = np.arange(40.0)[np.newaxis, :]
        file["log"] = np.zeros(8, dtype=[("time_s", "f8"), ("acc_z_g", "f4")])


def _bus(path: Path) -> None:
    from tests.signals.formats.test_buses_and_frames import raw_mdf

    raw_mdf(path.with_suffix(".mf4"), with_signals=True)
    path.with_suffix(".mf4").rename(path)


def _matlab(path: Path) -> None:
    from scipy.io import savemat

    held = io.BytesIO()
    savemat(held, {"S": {"acc": np.arange(9.0), "t": np.arange(9.0)}, "x": np.arange(30.0).reshape(10, 3)})
    path.write_bytes(held.getvalue())


_MAKERS: dict[str, Callable[[Path], None]] = {
    "log.parquet": _parquet, "frame.h5": _frame, "bus.mf4": _bus, "held.mat": _matlab,
}  # fmt: skip


def file_case(rng: random.Random) -> tuple[Callable[[list[str]], int], list[str]]:
    """A damaged file in the working folder and the command that reads it, sometimes with a damaged database."""
    files = good_files()
    name = rng.choice(sorted(files))
    Path(name).write_bytes(damaged(files[name], rng))
    arguments = [name] if rng.random() < 0.3 else [name, "--json"]
    if name.startswith("bus") and rng.random() < 0.7:
        database = DBC.encode("utf-8")
        Path("car.dbc").write_bytes(damaged(database, rng) if rng.random() < 0.5 else database)
        arguments += ["--dbc", "car.dbc"]
    return inspect.main, arguments


def judge_file(code: int, out: str, err: str, memory_before: float) -> str:
    """What is wrong with the end of `inspect`; empty where nothing is.

    Args:
        code: its exit code.
        out, err: what it printed.
        memory_before: largest memory of the process before the case [MB].
    """
    grown = largest_memory() - memory_before
    if code not in (0, 2, 3):
        return f"exit code {code}"
    if code and (not err.startswith("error: ") or err.count("\n") != 1):
        return "no message, or more than one line"
    if not code and err:
        return "something on the error console"
    if grown > LARGEST_GROWTH:
        return f"{grown:.0f} MB of memory"
    if not code and out.startswith("{"):
        json.loads(out, parse_constant=_no_constant)
    return ""


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} in JSON")


def largest_memory() -> float:
    """Largest memory that this process has had [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
