"""`make faults`: every system call of every command fails once, random kills; writes the table `docs/faults.md`."""

import argparse
import contextlib
import io
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from tests.faults.cases import FAULTS
from tests.faults.jobs import commands
from tests.faults.table import ROOT, Count, build, counted, outcomes
from tools.wrap_docs import wrapped

PAGE = ROOT / "docs" / "faults.md"

HEAD = """# Faults

No written result is lost. This is tested as in SQLite: a preloaded library makes the n-th system call (open, read
access, write, sync, rename, removal, memory map, close, new folder) of a command fail, or kills the process there. Each
command replaces results of another input (`--force`). After each case the results must be those of before, byte for
byte, or the new ones, complete; exit code and message must be correct; leftovers must be named, and the next command
must succeed, report them and remove them.

Several files that a command adds to a folder with others (`loads`, `spectra`, `road`, `fit-mount`, `fit-damper`) cannot
be exchanged in one step: each is whole at any time, but after a kill between their renames some are new and some are
earlier ones. The next command that reads them reports this, and the same command, repeated, writes all.

Each command that writes has a row, for each option and format that writes; a test compares them with the parsers. The
rows "only writing" write small files in each way that the commands use, without a computation. `bench` replaces nothing
and has none. A film is written by ffmpeg, a process of its own whose calls do not fail here: the rows of both films are
of the calls of this process, its other files and the exchange, fewer for the film of a run; a test writes a film, and
each other format, beyond a limit of the size of files. Files with the time that was computed (`summary.json`,
`timing.csv`, `rows.jsonl`, `report.html` of a run) differ between two equal commands and are compared with their list
of digests; all other files must be the same twice, byte for byte, in each format.

"Calls" are the system calls on files below the folder of the results that the fault can meet. Of calls of one kind in a
row for one file, the first, the middle one and the last are tried, as only the length of an unfinished file differs
between them: these are the "different" ones. "Cases" are those that were made to fail: with fewer cases than different
calls, they have equal distances. The next command is run once for all cases of a command that leave the same names,
lists and journals.

`make faults` runs all different calls and writes this page; `make test-all` runs a sample. Rows with a `*` are of an
earlier run of the page; where the column "some of each" is empty, of a version that moved all files after a kill.
"""

HEADS = ("command", "fault", "calls", "different", "cases", "results of before", "new results", "some of each", "wrong")

Cells = list[str]


def page(table: dict[tuple[str, str], Count], names: Sequence[str], earlier: str) -> str:
    """Return the page of the counts.

    Args:
        table: counts of this run.
        names: all commands of the page, in its order.
        earlier: the page so far, whose rows are kept for commands that are not in the table.
    """
    rows = [row for name in names for row in (_rows(table, name) or _earlier(earlier, name))]
    cases, wrong = (sum(int(row[HEADS.index(head)]) for row in rows) for head in ("cases", "wrong"))
    lines = [HEAD, f"{cases} cases, {wrong} with a fault of the program.", ""]
    lines += [f"| {' | '.join(row)} |" for row in (HEADS, ["---"] * len(HEADS), *rows)]
    seen = {row[0].removesuffix(" *") for row in rows}
    if missing := [name for name in names if name not in seen]:
        lines += ["", f"Not run yet: {', '.join(missing)}."]
    texts = dict.fromkeys(
        f"- {name}, {fault}: {case['wrong']}" for (name, fault), c in table.items() for case in c.wrong
    )
    lines += ["", "What was wrong:", "", *(text[:400] for text in texts)] if texts else []
    return wrapped("\n".join(lines) + "\n")


def _rows(table: dict[tuple[str, str], Count], name: str) -> list[Cells]:
    """Return the rows of a command, faults of system calls first."""
    faults = [fault for command, fault in table if command == name]
    rows = []
    for fault in sorted(faults, key=[*FAULTS, *(fault for fault in faults if fault not in FAULTS)].index):
        count = table[name, fault]
        numbers = (count.results.total(), *map(count.results.get, ("old", "new", "mixed")), len(count.wrong))
        cells = (str(number or 0) for number in numbers)
        rows.append([name, fault, str(count.calls or ""), str(count.different or ""), *cells])
    return rows


def _earlier(text: str, name: str) -> list[Cells]:
    """Return the rows of a command in a page, marked as earlier."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:1] == "|"]
    rows = [cells for cells in lines if cells[0].removesuffix(" *") == name]
    return [[f"{name} *", *(cells[1:] if len(cells) == len(HEADS) else [*cells[1:7], "", cells[7]])] for cells in rows]


def main() -> int:
    """Run all commands, and write the page after each; the exit code is 1 if something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "faults", help="folder for inputs and results")
    parser.add_argument("--most", type=int, default=0, help="maximum cases of a fault of a command; 0 for all")
    parser.add_argument(
        "--whole", default="", help="faults that are tried at all calls in spite of --most, with commas"
    )
    parser.add_argument("--kills", type=int, default=32, help="kills of each command at random times")
    parser.add_argument("--minutes", type=float, default=0.0, help="time for all; 0 for no limit")
    parser.add_argument("--only", default="", help="names of commands, with commas between them")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    whole = [fault for fault in options.whole.split(",") if fault]
    earlier = PAGE.read_text()
    library, began = build(options.work), time.monotonic()
    with contextlib.redirect_stdout(io.StringIO()):
        all_names = [command.name for command in commands(options.work / "inputs")]
    names = options.only.split(",") if options.only else all_names
    for number, name in enumerate(names):
        left = 60.0 * options.minutes - (time.monotonic() - began)
        if options.minutes and left < 0.0:
            break
        limit = left / (len(names) - number) * 2.0 if options.minutes else 0.0
        with lines_of(options.work, name).open("w", encoding="utf-8") as file:
            for line in outcomes(library, options.work, name, options.most, options.kills, whole, limit):
                file.write(json.dumps(line) + "\n")
                file.flush()
        table = read_table(options.work, all_names)
        PAGE.write_text(page(table, all_names, earlier))
        print(
            f"{name}: {sum(count.results.total() for key, count in table.items() if key[0] == name)} cases", flush=True
        )
    return int(any(count.wrong for count in read_table(options.work, all_names).values()))


def lines_of(work: Path, name: str) -> Path:
    """Return the file of the outcomes of a command, which the next call with this folder reads too."""
    return work / f"{name.replace(' ', '_')}.jsonl"


def read_table(work: Path, names: Sequence[str]) -> dict[tuple[str, str], Count]:
    """Return the counts of all commands with a file of outcomes."""
    files = [lines_of(work, name) for name in names if lines_of(work, name).exists()]
    return counted(json.loads(line) for file in files for line in file.read_text().splitlines())


if __name__ == "__main__":
    sys.exit(main())
