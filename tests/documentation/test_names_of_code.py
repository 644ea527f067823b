"""Files, modules and classes that a page names exist: a page outlives a name of the code without a test."""

import pkgutil
import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md"))]

CODE = re.compile(r"`([^`\n]+)`")
"""Text in code type."""

FILE = re.compile(r"(?<![\w./*<{~\"'-])((?:[\w-]+/)*[\w-]+\.(?:py|c|h|js)|(?:[\w-]+/)+[\w.-]*)(?![\w/*<{-])")
"""A source file, or a path of folders."""

MODULE = re.compile(r"(?<![\w./-])((?:vehicle|scenarios|tests)(?:\.[A-Za-z_]\w*)+)")
"""A dotted name of a package."""

CLASS = re.compile(r"(?<![\w.])([A-Z][a-z]+[a-z0-9]*(?:[A-Z][a-z0-9]+)+)(?!\w)")
"""A name of two or more words, as of a class."""

WRITTEN = re.compile(r"^\s*# file: (\S+)$", re.MULTILINE)
"""File that a page writes (`tests.documentation.pages`)."""

ELSEWHERE = {"vehicle.toml", "vehicle.schema.json", "vehicle.cmd", "vehicle.force_laws", "scenarios.md"}
"""Dotted names that are files, and the plugin of MuJoCo that no program has."""


FOREIGN = {"ChVehicle", "MarkupSafe"}
"""Classes and packages of others."""


@cache
def sources() -> tuple[str, ...]:
    """Return the files of the repository, with / before each."""
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True)
    return tuple(f"/{name}" for name in names.stdout.split("\n") if (ROOT / name).is_file())


@cache
def words() -> frozenset[str]:
    """Return all identifiers of the program in Python, C, JavaScript and TOML."""
    program = (name for name in sources() if name.startswith(("/vehicle/", "/scenarios/", "/tools/")))
    code = (name for name in program if name.endswith((".py", ".c", ".h", ".js", ".toml")))
    return frozenset(word for name in code for word in re.findall(r"\w+", (ROOT / name[1:]).read_text("utf-8")))


def missing(text: str) -> list[str]:
    """Return the names of files, modules and classes in a page that the repository does not have."""
    written = {f"/{name}" for name in WRITTEN.findall(text)}
    quoted = [match[1] for match in CODE.finditer(text)]
    return [
        *(name for code in quoted for name in FILE.findall(code) if not _is_file(name, written)),
        *(name for name in MODULE.findall(text) if not _is_module(name, written)),
        *(name for code in quoted for name in CLASS.findall(code) if name not in words() | FOREIGN | _defined(text)),
    ]


def _defined(text: str) -> set[str]:
    """Return the names that the code blocks of a page define or import."""
    return set(re.findall(r"(?:class|def|import) (\w+)", text))


def _is_file(name: str, written: set[str]) -> bool:
    if name.endswith((".py", ".c", ".h", ".js")):
        return any(file.endswith(f"/{name.removeprefix('../')}") for file in (*sources(), *written))
    first = name.split("/")[0]
    packages = {path.name for path in (ROOT / "vehicle").iterdir() if path.is_dir()} - {"runs"}
    if first not in packages | {"vehicle", "scenarios", "tests", "tools", "docs"}:
        return True  # a unit, a channel, or a folder of the user
    return any(f"/{name.rstrip('/')}" in f"{file}/" for file in (*sources(), *written))


def _is_module(name: str, written: set[str]) -> bool:
    if name in ELSEWHERE or name.isupper() or name.rsplit(".", 1)[1].isupper():
        return True
    if any(file.endswith(f"/{name.replace('.', '/')}.py") for file in written):
        return True
    try:
        return pkgutil.resolve_name(name) is not None
    except (ImportError, AttributeError):
        return False


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_names_of_code_on_a_page_exist(page):
    text = page.read_text(encoding="utf-8")
    assert missing(text) == []


def test_a_name_that_was_renamed_is_found():
    text = (
        "`model/laws/elastomer_law.py`, `stepping.h`, `rows_of_old.h`, `engines/linear/`, `engines/fluid/`, m/s2 in "
        "`N/mm`, `python -m tests.benchmarks.speed`, `python -m tests.benchmarks.gone`, `vehicle.Car.load`, "
        "`vehicle.Car.loaded`, `RoadSettings`, `RoadSetting`"
    )
    assert missing(text) == [
        "model/laws/elastomer_law.py",
        "rows_of_old.h",
        "engines/fluid/",
        "tests.benchmarks.gone",
        "vehicle.Car.loaded",
        "RoadSetting",
    ]
