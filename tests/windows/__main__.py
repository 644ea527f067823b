"""Run the commands here and with CPython for Windows under wine, and compare exit codes, texts and numbers; then
kills, locks and disks that are full or cannot be written.

    python -m tests.windows FOLDER [--only TEXT]

FOLDER is made by `tools/windows_folder.py FOLDER --for-wine`. Wine is not Windows: file systems, consoles and drivers
differ, so a good table means "tested with CPython for Windows under wine".
"""

import argparse
import shlex
import shutil
import sys
import tempfile
import time
from pathlib import Path

from tests.windows.comparison import changed, differences, same_text
from tests.windows.emulated import Windows, here
from tests.windows.hardships import HARDSHIPS

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "mr-damper"
SHIPPED = Path(__file__).resolve().parents[2] / "vehicle" / "signals" / "inputs"
INPUTS = ("low.csv", "bump_7p5mm.csv")
COMMANDS = Path(__file__).with_name("commands.txt")
"""A command a line, as in a shell; most are those of README.md, tutorials and how-tos. They run in this order."""


def main() -> int:
    """Print a row for each command and each hardship; return 1 if a row differs."""
    parser = argparse.ArgumentParser(description="Compare the program here and under wine.")
    parser.add_argument("folder", type=Path, help="folder of tools/windows_folder.py")
    parser.add_argument("--from", dest="first", default="", help="begin with the first row that contains this text")
    parser.add_argument("--keep", type=Path, help="keep the results in this folder, and those that it has for --from")
    options = parser.parse_args()
    base = options.keep or Path(tempfile.mkdtemp(prefix="windows-"))
    if not options.first:
        shutil.rmtree(base, ignore_errors=True)
    this, other = base / "here", base / "under wine ü"
    for folder in (this, other):
        folder.mkdir(parents=True, exist_ok=True)
        for path in (*(SHIPPED / name for name in INPUTS), *DATA.glob("*0A.txt")):
            shutil.copy(path, folder)
    windows, wrong, known = Windows(options.folder.resolve()), 0, changed(other, {})
    lines = COMMANDS.read_text(encoding="utf-8").splitlines()
    print("| command | exit | s here | s under wine | largest difference of a number |\n|---|---|---|---|---|")
    titles = [*lines, *(str(hardship.__doc__) for hardship in HARDSHIPS)]
    begin = next(number for number, title in enumerate(titles) if options.first in title)
    for line in lines[begin:]:
        arguments = shlex.split(line)[1:]
        started = time.monotonic()
        first = here(arguments, this)
        middle = time.monotonic()
        second = windows.run(["-m", "vehicle", *arguments], other)
        ended = time.monotonic()
        faults = [] if first.code == second.code else [f"exit {first.code} here"]
        faults += same_text(first.text, second.text)
        largest, more = differences(this, other, changed(other, known))
        faults, known = faults + more, known | changed(other, known)
        wrong += bool(faults)
        times = f"{middle - started:.0f} | {ended - middle:.0f}"
        row = f"| `{line.removeprefix('vehicle ')}` | {second.code} | {times} | {largest:.1e} |"
        print(row, *faults, sep="\n  ", flush=True)
    print("| hardship | s | seen |\n|---|---|---|")
    for hardship in HARDSHIPS[max(begin - len(lines), 0) :]:
        started = time.monotonic()
        seen = hardship(windows, this, other)
        wrong += not seen.startswith("= ")
        print(f"| {hardship.__doc__} | {time.monotonic() - started:.0f} | {seen} |", flush=True)
    print(f"{wrong} rows differ")
    if not options.keep:
        shutil.rmtree(base)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
