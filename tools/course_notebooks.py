"""Make the notebooks of the course from its pages: `python tools/course_notebooks.py FOLDER`.

The pages in docs/course are the only source; no notebook is kept in the repository. Prose becomes Markdown cells,
commands and scripts become code cells, and outputs are left out: the reader computes them.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from vehicle.runs.output.folder import write_text  # noqa: E402

COURSE = ROOT / "docs" / "course"
BLOCK = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?:|#)([^)\s]+)")
CLONE = """import os

os.environ["PYTHONPATH"] = os.path.abspath("{root}")  # the clone, whose folder `scenarios` checks the answers"""
HIDDEN = re.compile(r"^<!--.*?-->\n", re.MULTILINE | re.DOTALL)
DIRECTIVE = re.compile(r"^```\{.*?^```$", re.MULTILINE | re.DOTALL)


def lessons() -> list[Path]:
    """Return the pages of the lessons, in order."""
    return sorted(COURSE.glob("[0-9]*.md"))


def notebook(page: Path, folder: Path) -> dict[str, Any]:
    """Return the notebook of a page, in the format 4.5.

    Args:
        page: page of a lesson.
        folder: folder of the notebook, from which its links start.
    """
    text = HIDDEN.sub("", DIRECTIVE.sub("", page.read_text(encoding="utf-8")))
    cells: list[dict[str, Any]] = []
    _append(cells, "code", CLONE.format(root=os.path.relpath(ROOT, folder).replace(os.sep, "/")))
    end = 0
    for match in BLOCK.finditer(text):
        _prose(cells, text[end : match.start()], page, folder)
        code = _code(match[1], match[2])
        if code is None:
            _prose(cells, match[0], page, folder)
        elif code:
            _append(cells, "code", code)
        end = match.end()
    _prose(cells, text[end:], page, folder)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def _prose(cells: list[dict[str, Any]], text: str, page: Path, folder: Path) -> None:
    """Append a Markdown cell; relative links lead from the notebook to the same files."""

    def moved(match: re.Match[str]) -> str:
        path, mark, anchor = match[1].partition("#")
        return "](" + os.path.relpath(page.parent / path, folder).replace(os.sep, "/") + mark + anchor

    if text.strip():
        _append(cells, "markdown", LINK.sub(moved, text.strip()))


def _append(cells: list[dict[str, Any]], kind: str, source: str) -> None:
    cell: dict[str, Any] = {"cell_type": kind, "id": f"cell-{len(cells)}", "metadata": {}, "source": source}
    cells.append(cell if kind == "markdown" else {**cell, "execution_count": None, "outputs": []})


def _code(language: str, block: str) -> str | None:
    """Return the code of a block; "" for a command that runs a script of the page, None for a block of text."""
    file = re.match(r"# file: (\S+)\n", block)
    if file and file[1].endswith(".py"):
        return block[file.end() :].rstrip()
    if file:
        return f"%%writefile {file[1]}\n{block[file.end() :].rstrip()}"
    if language == "python":
        return block.rstrip()
    if language != "console":
        return None
    joined = re.sub(r"\\\n> *", "", block)
    commands = [line[2:] for line in joined.splitlines() if line.startswith("$ ")]
    return "\n".join(f"!{line}" for line in commands if not re.fullmatch(r"python \S+\.py", line))


def main() -> int:
    """Write all notebooks into the folder of the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition(":")[0] + ".")
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="folder of the notebooks; made if it is missing")
    folder = parser.parse_args().folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for page in lessons():
        path = folder / f"{page.stem}.ipynb"
        write_text(path, json.dumps(notebook(page, folder), indent=1, ensure_ascii=False) + "\n")
        print(path)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
