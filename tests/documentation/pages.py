"""Execution of the code blocks of README.md and docs/: one mechanism for every page.

| block | what happens |
|---|---|
| `console` | each line `$ COMMAND` runs; the lines below it must be its output |
| `python` | runs from top to bottom in one namespace for each page |
| any language, first line `# file: PATH` | the block is written to PATH |
| `diff` with `+++ PATH` | the lines of the block are replaced in PATH |
| `sh` | does not run (network, another machine); `test_pages.py` lists each with its reason |

A line `...` stands for omitted lines of output, `...` in a line for any text. Numbers agree within 1 % or one unit of
the last printed digit. A page starts in a folder with links to the packages, as a clone has them. A page with the
comment `<!-- run: in a copy of the repository -->` starts in a copy of them, which it may change; its commands are
processes of their own. After a change of messages, `python -m tests.documentation.pages PAGE ...` writes the new
outputs.
"""

import contextlib
import gc
import io
import os
import re
import runpy
import shlex
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any
from unittest import mock

from tests.patience import HANG

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
BLOCK = re.compile(r"^( *)```(\w*)[^\n]*\n(.*?)^ *```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
LONGEST = 12
"""Maximum number of output lines that the renewal of a page writes; the rest becomes `...`."""

UNREPEATABLE = re.compile(
    r"[\d.]+(?= times real time)|(?<=energy residual )[\d.e-]+|(?<=results\.md; )\d+(?= s$)|[0-9a-f]{64}"
    r"|\d[\d.]*e-(?:0[5-9]|1\d)|(?<=\.html, )[\d.]+ [kM]B"
    r"|(?<=reduced would take about )[\d.]+ (?:s|min|h)"
    # A search goes another way after a difference of round-off.
    r"|\d+(?= on the front)|(?<=the front still grew by )[\d.]+"
)
"""Text of an output that differs from run to run, or with the platform; written as `...`."""

PROGRESS = re.compile(r"\w+: +\d+ %.*")
"""A line of progress, which a slow machine prints and a fast one does not."""

COPIED = ("vehicle", "scenarios", "renders", "pyproject.toml", "README.md")
"""Files and folders in a copy of the repository."""


def pages() -> list[str]:
    """Return the path of each page relative to the repository, README.md first."""
    return ["README.md", *sorted(path.relative_to(ROOT).as_posix() for path in DOCS.rglob("*.md"))]


def blocks(page: str, *languages: str) -> list[str]:
    """Return the code blocks of a page in these languages, in order."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return [dedented(match) for match in BLOCK.finditer(text) if match[2] in languages]


def dedented(match: re.Match[str]) -> str:
    """Return the text of a block without the indentation of its fence."""
    return "".join(line.removeprefix(match[1]) for line in match[3].splitlines(keepends=True))


@dataclass
class Command:
    """A command of a console block with the output that the page shows."""

    line: str
    shown: list[str] = field(default_factory=list)
    expected: list[str] = field(default_factory=list)


def commands(block: str) -> list[Command]:
    """Return the commands of a console block; a backslash at the end of a line continues it."""
    result: list[Command] = []
    for text in block.splitlines():
        if result and result[-1].shown[-1].endswith("\\"):
            result[-1].shown.append(text)
            result[-1].line = result[-1].line.removesuffix("\\").rstrip() + " " + text.strip().removeprefix("> ")
        elif text.startswith("$ "):
            result.append(Command(text[2:], [text]))
        else:
            result[-1].expected.append(text)
    return result


def agrees(expected: str, line: str) -> bool:
    """True if a line of output has the text of the expected line, and its numbers within the tolerance."""
    expected, line = " ".join(expected.split()), " ".join(line.split())
    pieces = (re.escape(piece).replace(re.escape("..."), ".*?") for piece in NUMBER.split(expected))
    match = re.fullmatch(f"({NUMBER.pattern})".join(pieces), line)
    return match is not None and all(map(_close, NUMBER.findall(expected), match.groups()))


def _close(text: str, number: str) -> bool:
    mantissa, _, exponent = text.lower().partition("e")
    digit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(float(text) - float(number)) <= max(0.01 * abs(float(text)), 1.01 * digit * ("." in mantissa))


def first_difference(expected: list[str], lines: list[str]) -> str | None:
    """Return the first expected line that the output lacks at its place, or None."""
    lines = [line.rstrip() for line in lines]
    position, free = 0, False
    for text in expected:
        if text.strip() == "...":
            free = True
            continue
        while position < len(lines) and free and not agrees(text, lines[position]):
            position += 1
        if position == len(lines) or not agrees(text, lines[position]):
            return text
        position, free = position + 1, False
    return None if free or position == len(lines) else f"end of output before {lines[position]!r}"


WIDTH = {"COLUMNS": "80"}
"""Environment of the outputs on the pages: help texts are as wide as the terminal says."""


def in_process(line: str) -> Callable[[], object] | None:
    """Return the call of a plain `python -m vehicle...`, `python -m scenarios...` or `python FILE.py`, or None."""
    words = shlex.split(line)
    if re.search(r"[|>;&*]", re.sub(r"'[^']*'|\"[^\"]*\"", "", line)):
        return None
    if re.fullmatch(r"python \S+\.py", line):
        return partial(run_script, words[1])
    if not re.match(r"python -m (vehicle|scenarios)\b", line):
        return None
    module = import_module(words[2])
    if hasattr(module, "__path__"):
        module = import_module(f"{words[2]}.__main__")
    return partial(module.main, words[3:]) if words[2] != "scenarios" else module.main


def run_script(file: str) -> int:
    """Run a script of a page; the end of a process would close the files that it leaves open."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        runpy.run_path(file, run_name="__main__")
        gc.collect()
    return 0


def output_of(line: str, folder: Path, call: Callable[[], Any] | None = None) -> tuple[int, str]:
    """Run a command in a folder and return its exit code and its output, both streams together.

    Args:
        line: command, as a user types it.
        folder: working directory.
        call: `in_process(line)`, which saves the imports; None for a process of its own.
    """
    if call is not None:
        stream, wide = io.StringIO(), mock.patch.dict(os.environ, WIDTH)
        with wide, contextlib.chdir(folder), contextlib.redirect_stdout(stream), contextlib.redirect_stderr(stream):
            try:
                code = call()
            except SystemExit as end:
                code = int(end.code or 0)
        return code, stream.getvalue()
    copied = (folder / "pyproject.toml").is_file()
    environment = {
        **os.environ,
        **WIDTH,
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
        "PYTHONPATH": str(folder if copied else ROOT),
    }
    done = subprocess.run(
        ["bash", "-c", line], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        timeout=HANG, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout


SHARED: dict[str, tuple[int, str, Path, dict[str, int]]] = {}
"""Command to its exit code and output, the folder of the page that ran it, and the files that it wrote there."""


def shared_output(line: str, folder: Path) -> tuple[int, str]:
    """Run a command of a page in this process, once for all pages where it reads and replaces no file of the page."""
    call, before = in_process(line), files_of(folder)
    if call is None or any((folder / part).exists() for part in re.split(r"[\s=:,]+", line)):
        return output_of(line, folder, call)
    code, output, source, made = SHARED.get(line, (0, "", folder, {}))
    if source == folder or before.keys() & made or not made.items() <= files_of(source).items():
        code, output = output_of(line, folder, call)
        made = dict(files_of(folder).items() - before.items())
        SHARED[line] = code, output, folder, made
        return code, output
    for name in made:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source / name, folder / name)
    return code, output


def files_of(folder: Path) -> dict[str, int]:
    """Return the files of a page, relative to its folder, with the time of their last change [ns]."""
    return {
        path.relative_to(folder).as_posix(): path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()
    }


@dataclass
class Execution:
    """A page that ran: its folder, the names of its Python blocks, and its text with the outputs of this execution."""

    folder: Path
    names: dict[str, Any]
    text: str


def execute(page: str, folder: Path, renew: bool = False) -> Execution:
    """Run all blocks of a page in a folder.

    Args:
        page: path relative to the repository.
        folder: working directory; holds links to the packages, or a copy of the repository.
        renew: write the present outputs into the text, instead of comparing them.

    Raises:
        AssertionError: a command fails, or its output is not that of the page.
    """
    text = (ROOT / page).read_text(encoding="utf-8")
    copied = "<!-- run: in a copy of the repository -->" in text
    names: dict[str, Any] = {"__name__": "__main__"}
    written: list[str] = []
    end = 0
    for match in BLOCK.finditer(text):
        language, block = match[2], dedented(match)
        file = re.match(r"# file: (\S+)\n", block)
        if file:
            path = inside(folder, file[1])
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block[file.end() :], encoding="utf-8")
        elif language == "diff":
            apply(block, folder)
        elif language == "python" and copied:
            code, output = output_of(f"{shlex.quote(sys.executable)} -c {shlex.quote(block)}", folder)
            assert code == 0, f"{page}: {output}"
        elif language == "python":
            with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block, page, "exec"), names)
        elif language == "console":
            shown: list[str] = []
            for command in commands(block):
                code, output = output_of(command.line, folder) if copied else shared_output(command.line, folder)
                lines = [line for line in output.rstrip("\n").split("\n") if not PROGRESS.fullmatch(line.strip())]
                if not output.strip():
                    lines = []
                difference = first_difference(command.expected, lines)
                assert renew or difference is None, f"{page}: {command.line}\nno line {difference!r} in\n{output}"
                failed = any(line.startswith("error: ") for line in lines)
                assert (code != 0) == failed, f"{page}: {command.line}\nexit code {code}\n{output}"
                if difference is not None:
                    lines = [UNREPEATABLE.sub("...", line) for line in lines]
                    command.expected = lines if len(lines) <= LONGEST else [*lines[:LONGEST], "..."]
                shown += [*command.shown, *command.expected]
            written.append(text[end : match.start(3)])
            written += [f"{match[1]}{line}".rstrip() + "\n" for line in shown]
            end = match.end(3)
    return Execution(folder, names, "".join(written) + text[end:])


def apply(block: str, folder: Path) -> None:
    """Replace the lines of a diff block in the file that its `+++` line names.

    Raises:
        AssertionError: the file does not have the old lines exactly once.
    """
    header, *lines = block.splitlines(keepends=True)
    path = inside(folder, header.removeprefix("+++ ").strip())
    for hunk in re.split(r"^@@.*\n", "".join(lines), flags=re.MULTILINE):
        if not hunk:
            continue
        rows = hunk.splitlines(keepends=True)
        old = "".join(row[1:] for row in rows if row[0] in " -")
        new = "".join(row[1:] for row in rows if row[0] in " +")
        text = path.read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{path} has these lines {text.count(old)} times:\n{old}"
        path.write_text(text.replace(old, new), encoding="utf-8")


def inside(folder: Path, name: str) -> Path:
    """Return the path of a file of a page.

    Raises:
        AssertionError: the path leads out of the folder, for example through the link to the sources.
    """
    path = (folder / name).resolve()
    assert path.is_relative_to(folder.resolve()), f"{name} is not in the folder of the page"
    return path


class Site:
    """Executions of the pages of a session, each once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.done: dict[str, Execution] = {}

    def execution(self, page: str, renew: bool = False) -> Execution:
        """Return the execution of a page; run it at the first call."""
        if page not in self.done:
            folder = self.folder / re.sub(r"\W", "_", page)
            text = (ROOT / page).read_text(encoding="utf-8")
            if "<!-- run: in a copy of the repository -->" in text:
                copy_repository(folder)
            else:
                folder.mkdir()
                for name in ("vehicle", "scenarios", "mjcf"):
                    (folder / name).symlink_to(ROOT / name)
            self.done[page] = execute(page, folder, renew)
        return self.done[page]


def copy_repository(folder: Path) -> None:
    """Copy what a recipe may edit: the packages with their compiled code, and the files of the installation."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("*.mp4", "*.png", "*.pyc.*"))
        else:
            folder.mkdir(exist_ok=True)
            shutil.copy(source, folder / name)


def prose_commands(page: str) -> Iterator[list[str]]:
    """Yield the words of each command that a page names in its prose: `python -m vehicle ...` in backquotes."""
    text = BLOCK.sub("", (ROOT / page).read_text(encoding="utf-8"))
    for match in re.finditer(r"`(?:python -m )?(vehicle|python -m vehicle|vehicle\.\w+) ([^`]+)`", text):
        yield shlex.split(match[0].strip("`"))


def main(arguments: list[str]) -> int:
    """Renew the outputs of pages."""
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder))
        for page in arguments:
            result = site.execution(page, renew=True)
            (ROOT / page).write_text(result.text, encoding="utf-8")
            print(page)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
