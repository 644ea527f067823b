"""Comparison of the results of a command on two systems: texts without paths and times, numbers within 1e-8."""

import csv
import difflib
import json
import re
from collections.abc import Collection, Iterator, Mapping
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.runs.output.written_files import MARKER

ALLOWED = {
    "frf.csv": 1e-6,
    "time.npz": 1e-7,
    "drive.csv": 1e-7,
    "summary.json": 1e-7,
    "table.csv": 1e-5,
    "rows.jsonl": 1e-5,
    "differences.csv": 1e-5,
    "": 1e-8,
}
"""Allowed difference of a number, as a part of the largest number of its column or array, by the name of the file.

Phases of motions that almost vanish, and coherences and random errors, which are differences of nearly equal numbers,
differ by more than the time histories; of these, small forces beside large ones in one matrix differ most. Cars of a
table march together in single precision: another kernel of OpenBLAS on one Linux moves the lateral RMS of rolling cars
by 4.6e-6, and a mass larger by 1e-13 by 4e-7 (in a run of its own, in double precision, by 1e-11). Differences of cars
have six printed digits."""

ZERO = 1e-6
"""Columns whose largest number is below are zero but for the end of an iteration, as the lateral roll centre [m]."""

TIMES = re.compile(
    r"[\d.]+(?= times real time)|(?<=energy residual )[\d.e-]+|[\d.]+ [kM]B|[0-9a-f]{64}|x86_64-\w+"
    r"|-?\d[\d.]*e-(?:0[5-9]|1\d)"
)
"""Texts that differ by nature: times, sizes of files, digests, names of systems, and numbers of pure round-off."""

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")

PROGRESS = re.compile(r"\w+: +\d+ %.*|Matplotlib is building.*")
SKIPPED = {".png", ".html", ".mp4", ".fmu", ".h5", ".svg", MARKER, "timing.csv"}
"""Endings and names of files of which only the existence is compared."""

TRIANGLE = np.dtype([("numbers", "<f4", 12), ("unused", "<u2")])
"""Normal and corners of a triangle in a binary STL file."""

UNEQUAL = {
    "software",
    "platform",
    "versions",
    "python",
    "wall_s",
    "timing",
    "elapsed_s",
    "seconds",
    "sha256",
    "created",
    "realtime_factor",
    "file",
}
"""Keys of summaries with systems and times."""


def same_text(first: str, second: str) -> list[str]:
    """Return the lines in which two texts differ beyond paths, times and systems."""
    one, two = (_plain(text) for text in (first, second))
    return [
        line
        for line in difflib.unified_diff(one, two, "here", "wine", n=0, lineterm="")
        if line[:2] not in ("--", "++", "@@")
    ]


def _plain(text: str) -> list[str]:
    lines = (TIMES.sub("...", line.replace("\\", "/")).rstrip() for line in text.replace("\r", "\n").split("\n"))
    return [line for line in lines if line and not PROGRESS.fullmatch(line)]


def changed(folder: Path, known: Mapping[str, int]) -> dict[str, int]:
    """Return the files of a folder that are new, or newer than known, with their times of change [ns]."""
    times = {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}
    return {name: time for name, time in times.items() if known.get(name) != time}


def differences(first: Path, second: Path, compared: Collection[str]) -> tuple[float, list[str]]:
    """Compare files of two folders.

    Args:
        first, second: folders; the names in them must be the same.
        compared: names of the files whose content is compared.

    Returns:
        Largest difference of a number as a part of the largest of its array, and the faults.
    """
    one, two = (
        {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()} for folder in (first, second)
    )
    faults = [f"only {'here' if name in one else 'under wine'}: {name}" for name in sorted(one ^ two)]
    largest = 0.0
    for name in sorted(one & two & set(compared)):
        if {Path(name).suffix, Path(name).name} & SKIPPED:
            continue
        for label, a, b in _pairs(first / name, second / name):
            if isinstance(a, str) or isinstance(b, str) or a.shape != b.shape:
                if not isinstance(a, str) or a != b:
                    faults.append(f"{name}: {label} differs: {str(a)[:60]} | {str(b)[:60]}")
                continue
            scale = np.nanmax(np.abs(a), initial=0.0)
            if max(scale, np.nanmax(np.abs(b), initial=0.0)) < ZERO:
                continue
            difference = float(np.nanmax(np.abs(a - b), initial=0.0) / scale) if scale > 0.0 else 1.0
            largest = max(largest, difference)
            if difference > ALLOWED.get(Path(name).name, ALLOWED[""]) or not np.array_equal(np.isnan(a), np.isnan(b)):
                faults.append(f"{name}: {label} differs by {difference:.1e}")
    return largest, faults


def _pairs(first: Path, second: Path) -> Iterator[tuple[str, Any, Any]]:
    """Yield the parts of two files: their name, and texts or arrays of numbers."""
    if first.suffix == ".uff":
        return  # the same numbers as in time.npz
    if first.suffix == ".npz":
        with np.load(first) as one, np.load(second) as two:
            yield "arrays", " ".join(one), " ".join(two)
            for key in one:
                if np.issubdtype(one[key].dtype, np.number):
                    yield key, one[key], two[key]
        return
    if first.suffix == ".stl":
        one, two = (np.frombuffer(path.read_bytes(), TRIANGLE, offset=84)["numbers"] for path in (first, second))
        yield "triangles", one, two
        return
    texts = [path.read_text(encoding="utf-8", errors="replace").replace("\r\n", "\n") for path in (first, second)]
    if first.suffix == ".json":
        yield from _json_pairs("", *(json.loads(text) for text in texts))
        return
    if first.suffix == ".jsonl":  # two processes end in any order
        yield from _json_pairs(
            "", *(sorted(map(json.loads, text.splitlines()), key=itemgetter("case")) for text in texts)
        )
        return
    if first.suffix == ".csv":
        yield from _table_pairs(*texts)
        return
    plain = [TIMES.sub("...", text).replace("\\", "/") for text in texts]
    yield ("text", *_both(NUMBER.sub("0", text) for text in plain))
    for number, (one, two) in enumerate(zip(*map(NUMBER.findall, plain), strict=False)):
        yield f"number {number}", np.array([float(one)]), np.array([float(two)])


def _table_pairs(first: str, second: str) -> Iterator[tuple[str, Any, Any]]:
    """Yield head and columns of two tables; columns with other than numbers as text."""
    tables = [[line for line in text.splitlines() if not line.startswith("#")] for text in (first, second)]
    yield "head", tables[0][0], tables[1][0]
    columns = [list(zip(*csv.reader(lines[1:]), strict=True)) for lines in tables]
    for name, *both in zip(tables[0][0].split(","), *columns, strict=False):
        try:
            yield (name, *(np.array([float(cell or "nan") for cell in column]) for column in both))
        except ValueError:
            yield (name, *_both(" ".join(column).replace("\\", "/") for column in both))


def _json_pairs(path: str, first: Any, second: Any) -> Iterator[tuple[str, Any, Any]]:
    if isinstance(first, dict) and isinstance(second, dict):
        yield path + " keys", " ".join(sorted(first)), " ".join(sorted(second))
        for key in sorted(first.keys() & second.keys()):
            if key not in UNEQUAL:
                yield from _json_pairs(f"{path}/{key}", first[key], second[key])
    elif isinstance(first, list) and isinstance(second, list) and len(first) == len(second):
        for number, (a, b) in enumerate(zip(first, second, strict=True)):
            yield from _json_pairs(f"{path}/{number}", a, b)
    elif isinstance(first, float) and isinstance(second, float):
        yield path, np.array([first]), np.array([second])
    else:
        yield (path, *_both(TIMES.sub("...", str(value).replace("\\", "/")) for value in (first, second)))


def _both(parts: Iterator[str]) -> tuple[str, str]:
    first, second = parts
    return first, second
