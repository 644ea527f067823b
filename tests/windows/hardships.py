"""What a laptop does to a command: a kill, a lock, a file open in another program, a full disk, a read-only folder."""

import csv
import shutil
import subprocess
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.windows.comparison import differences
from tests.windows.emulated import LONGEST, Windows, ended, here

SWEEP = (
    *("sweep", "--vehicle", "sedan", "--road", "A", "--speed", "80", "--duration", "4", "--engine", "reduced"),
    *("--vary", "rear.damper.viscous=800:2400:20", "--vary", "body.mass=900:1100:10", "--quiet"),
    *("--output", "runs/killed"),
)
"""200 cars."""

RUN = ("shaker", "--input", "bump_7p5mm.csv", "--engine", "reduced", "--quiet", "--output")

HOLD = "import sys; file = open(sys.argv[1]); print('held', flush=True); sys.stdin.read()"
LOCK = (
    "import sys; from pathlib import Path; from vehicle.runs.output.locks import folder_lock\n"
    "with folder_lock(Path(sys.argv[1]).resolve()): print('held', flush=True); sys.stdin.read()"
)

INTERRUPT = """
import ctypes, subprocess, sys, time
from pathlib import Path
command, rows = [sys.executable, "-m", "vehicle", *sys.argv[2:]], Path(sys.argv[1])
process = subprocess.Popen(
    command, creationflags=subprocess.CREATE_NEW_CONSOLE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
)
while not (rows.is_file() and rows.stat().st_size) and process.poll() is None:
    time.sleep(0.1)
console = ctypes.windll.kernel32
console.FreeConsole(), console.AttachConsole(process.pid), console.SetConsoleCtrlHandler(None, True)
console.GenerateConsoleCtrlEvent(0, 0)
print(process.communicate()[0].decode().strip())
sys.exit(process.returncode)
"""
"""Program that starts a command in a console of its own and presses Ctrl-C there once a file has content."""


def interrupted(windows: Windows, this: Path, other: Path) -> str:
    """Press Ctrl-C in the console of a sweep with two jobs, and resume it."""
    folder = other / "runs" / ".interrupted.partial"
    command = [*SWEEP[:-1], "runs/interrupted", "--jobs", "2"]
    done = windows.run(["-c", INTERRUPT, str(folder / "rows.jsonl"), *command], other)
    kept, text = _rows(folder), done.text.strip()
    if done.code != 130 or "--resume goes on" not in text or not text.endswith("half-written") or not 0 < kept < 200:
        return f"exit {done.code}, {kept} rows: {text}"
    last = windows.run(["-m", "vehicle", *command, "--resume"], other)
    table = other / "runs" / "interrupted" / "table.csv"
    count = len(table.read_text(encoding="utf-8").splitlines()) - 1 if table.is_file() else 0
    return (
        f"= exit 130, {kept} rows kept"
        if not last.code and count == 200
        else f"exit {last.code}, {count} rows: {last.text}"
    )


def sweep_killed_twice(windows: Windows, this: Path, other: Path) -> str:
    """Kill the sweep after 50 and after 110 rows, resume it, and compare the table with that of this system."""
    folder = other / "runs" / ".killed.partial"
    arguments = ["-m", "vehicle", *SWEEP, "--jobs", "2"]
    kept: list[int] = []
    for number in (50, 110):
        process = windows.start([*arguments, *(["--resume"] if kept else [])], other)
        end = time.monotonic() + LONGEST
        while _rows(folder) < number:
            if process.poll() is not None or time.monotonic() > end:
                windows.end()
                return f"no {number} rows: {process.communicate()[0]}"
            time.sleep(0.1)
        process.kill()  # python.exe itself; its workers end with it
        process.communicate(timeout=60.0)
        kept.append(_rows(folder))
    last = windows.run([*arguments, "--resume"], other)
    if last.code or here([*SWEEP, "--jobs", "2"], this).code:
        return f"exit {last.code}: {last.text}"
    worst, faults = differences(this / "runs/killed", other / "runs/killed", {"table.csv"})
    rows = list(csv.reader((other / "runs/killed/table.csv").open(encoding="utf-8")))[1:]
    if faults or len(rows) != 200 or len({tuple(row[2:4]) for row in rows}) != 200 or not 50 <= kept[0] < kept[1] < 200:
        return f"{len(rows)} rows, at the kills {kept}; {faults}"
    return f"= {kept[0]} and {kept[1]} rows at the kills; 200 rows, within {worst:.1e}"


def lock_held(windows: Windows, this: Path, other: Path) -> str:
    """Write a folder that another process writes."""
    with _process(windows, LOCK, "runs/locked", other):
        return _refused(windows, [*RUN, "runs/locked"], other, "is writing there", other)


def open_file(windows: Windows, this: Path, other: Path) -> str:
    """Replace a folder with a file that another program has opened; again when it is closed."""
    first = windows.run(["-m", "vehicle", *RUN, "runs/open"], other)
    before = _contents(other / "runs" / "open")
    with _process(windows, HOLD, "runs/open/frf.csv", other):
        held = windows.run(["-m", "vehicle", *RUN, "runs/open", "--force"], other)
        after = _contents(other / "runs" / "open")
    last = windows.run(["-m", "vehicle", *RUN, "runs/open", "--force"], other)
    left = sorted(path.name for path in (other / "runs").iterdir() if path.name.startswith(".open"))
    # A folder with an open file can be renamed under wine; then the new results are in place, and the old ones left.
    if held.code not in (0, 6) or len(held.text.strip().splitlines()) > 1 or not after.keys() >= before.keys():
        return f"exit {held.code}: {held.text}"
    if first.code or last.code or left or _contents(other / "runs" / "open").keys() != before.keys():
        return f"exit {first.code}, {last.code}: {last.text} {left}"
    return f"= exit {held.code}: {held.text.strip() or 'replaced'}"


def full_disk(windows: Windows, this: Path, other: Path) -> str:
    """Write on a disk of 300 kB."""
    with _disk(other / "disk") as disk:
        if disk is None:
            return "= not tried: no right to mount"
        (disk / "note.txt").write_text("of the user")
        return _refused(windows, [*RUN, "disk/run"], other, "cannot be written", disk)


def read_only(windows: Windows, this: Path, other: Path) -> str:
    """Write on a disk that cannot be written."""
    with _disk(other / "disk", "ro") as disk:
        if disk is None:
            return "= not tried: no right to mount"
        return _refused(windows, [*RUN, "disk/run"], other, "cannot be written", disk)


def film(windows: Windows, this: Path, other: Path) -> str:
    """Make a film without OpenGL."""
    words = "no off-screen OpenGL library works on this machine (glfw: "
    return _refused(
        windows, ["shaker", "--input", "bump_7p5mm.csv", "--video", "--output", "film"], other, words, other
    )


def long_path(windows: Windows, this: Path, other: Path) -> str:
    """Write to a path of more than 200 characters."""
    name = "/".join(["runs", *["langer Name ü" * 5] * 3])
    done = windows.run(["-m", "vehicle", *RUN, name], other)
    if done.code or not (other / name / "summary.json").is_file():
        return f"exit {done.code}: {done.text}"
    return f"= {len(str(other / name))} characters"


def own_encoding(windows: Windows, this: Path, other: Path) -> str:
    """Print the name of a file that the encoding of the console lacks."""
    shutil.copy(other / "bump_7p5mm.csv", other / "Ω.csv")
    plain = Windows(windows.folder, {"PYTHONUTF8": "0", "PYTHONIOENCODING": "cp1252"})
    done = plain.run(["-m", "vehicle", "inspect", "Ω.csv"], other)
    return "= \\u03a9.csv" if not done.code and "\\u03a9.csv" in done.text else f"exit {done.code}: {done.text}"


def unpacked(windows: Windows, this: Path, other: Path) -> str:
    """Make the first report with vehicle.cmd, and ask bench.cmd for its page."""
    done = ended(windows.start_script("vehicle.cmd", [*RUN, "runs/first", "--report"], other))
    if done.code or not (other / "runs" / "first" / "report.html").is_file():
        return f"exit {done.code}: {done.text}"
    bench = windows.start_script("bench.cmd", ["focus", "--input", "low.csv", "--port", "8791"], other)
    text = ""
    try:
        assert bench.stdout is not None
        while line := bench.stdout.readline():
            text += line
            if line.startswith("ready: "):
                with urllib.request.urlopen(line.split()[1], timeout=300) as answer:
                    page = answer.read().decode()
                return "= report.html, page of the bench" if "<html" in page.lower() else page[:200]
    finally:
        windows.end()
        bench.communicate()
    return f"no page: {text}"


HARDSHIPS: tuple[Callable[[Windows, Path, Path], str], ...] = (
    lock_held, open_file, full_disk, read_only, film, long_path, own_encoding, interrupted, sweep_killed_twice,
    unpacked,
)  # fmt: skip
"""Each returns a text that begins with "=" where all is as it must be, else what was seen."""


def _rows(folder: Path) -> int:
    path = folder / "rows.jsonl"
    return path.read_bytes().count(b"\n") if path.is_file() else 0


def _contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _refused(windows: Windows, command: list[str], folder: Path, words: str, kept: Path) -> str:
    """Run a command that must fail with one sentence and leave a folder as it was."""
    before = _contents(kept)
    done = windows.run(["-m", "vehicle", *command], folder)
    text = done.text.strip()
    if done.code not in (2, 5, 6) or words not in text or "\n" in text or not text.startswith("error: "):
        return f"exit {done.code}: {text}"
    if _contents(kept) != before:
        return f"other files: {sorted(_contents(kept).keys() ^ before.keys())}"
    return f"= exit {done.code}: {text}"


@contextmanager
def _process(windows: Windows, program: str, argument: str, folder: Path) -> Iterator[None]:
    """Run a Python program for Windows that prints a line and waits for the end of its input."""
    process = windows.start(["-c", program, argument], folder)
    assert process.stdout is not None
    while (line := process.stdout.readline()) and line.strip() != "held":
        pass
    try:
        yield
    finally:
        process.communicate("", 60.0)


@contextmanager
def _disk(folder: Path, *options: str) -> Iterator[Path | None]:
    """Mount a disk of 300 kB; yield None without the right to."""
    folder.mkdir(exist_ok=True)
    mount = ["mount", "-t", "tmpfs", "-o", ",".join(["size=300k", *options]), "tmpfs", str(folder)]
    if subprocess.run(mount, capture_output=True).returncode:
        yield None
        return
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)
