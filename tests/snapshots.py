"""Texts of the console, a file for each command in tests/commands/snapshots: lines `$ COMMAND`, output, exit code.

`python -m tests.snapshots [NAME ...]` runs the commands of the files and writes what they print now: after a change of
words, read `git diff` instead of assertions. A new case is a new line `$ COMMAND` in a file.
"""

import sys
import tempfile
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

from tests.documentation.pages import in_process, output_of

FOLDER = Path(__file__).parent / "commands" / "snapshots"


def names() -> list[str]:
    """Return the commands that have a file."""
    return sorted(path.stem for path in FOLDER.glob("*.txt"))


def cases(name: str) -> Iterator[tuple[str, list[str]]]:
    """Yield each command of a file, and the lines that it prints, with the exit code as the last."""
    for block in (FOLDER / f"{name}.txt").read_text(encoding="utf-8").split("$ ")[1:]:
        line, *shown = block.rstrip("\n").split("\n")
        yield line, shown


def printed(line: str, folder: Path) -> list[str]:
    """Run a command in a folder; return what it prints, and its exit code as the last line."""
    code, text = output_of(line, folder, in_process(line))
    return [*(part.rstrip() for part in text.rstrip("\n").split("\n") if text.strip()), f"exit code {code}"]


def changed(name: str, folder: Path) -> list[str]:
    """Return the commands of a file that print something else, with their first other line; numbers count too."""
    differences = []
    for line, shown in cases(name):
        pairs = zip_longest(shown, printed(line, folder))
        if other := next((pair for pair in pairs if pair[0] != pair[1]), None):
            differences.append(f"{line}: {other[1]!r} in place of {other[0]!r}")
    return differences


def main(arguments: list[str]) -> int:
    """Write what the commands print now."""
    for name in arguments or names():
        with tempfile.TemporaryDirectory() as folder:
            blocks = ["\n".join([f"$ {line}", *printed(line, Path(folder))]) for line, _ in cases(name)]
        (FOLDER / f"{name}.txt").write_text("\n\n".join(blocks) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
