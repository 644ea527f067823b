"""The core dependencies: what the main job imports and nothing else, each with a lower bound and a locked version."""

import ast
import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
CORE = {requirement.name: requirement for requirement in map(Requirement, PROJECT["dependencies"])}
EXTRAS = {Requirement(text).name for texts in PROJECT["optional-dependencies"].values() for text in texts}


def imported(path):
    """Names that a file imports, at its top or within a function."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def file_of(name):
    """Return the file of a module of the program; None for a name within a module."""
    place = ROOT.joinpath(*name.split("."))
    return next((file for file in (place.with_suffix(".py"), place / "__init__.py") if file.is_file()), None)


def packages_of_the_main_job():
    """Names of the packages that are imported by any module that `vehicle shaker` may import."""
    waiting, seen, packages = ["vehicle.commands.shaker"], set(), set()
    while waiting:
        file = file_of(waiting.pop())
        if file is None or file in seen:
            continue
        seen.add(file)
        for name in imported(file):
            if name.split(".")[0] == "vehicle":
                waiting.append(name)
            else:
                packages.add(name.split(".")[0])
    assert len(seen) > 150, "the modules were not found"
    return packages - sys.stdlib_module_names


def test_the_core_is_what_the_main_job_imports():
    """An import of a package of an extra stands within the function that needs it, and is no part of the core."""
    of = packages_distributions()
    reached = {name: {*of.get(name, [name])} for name in packages_of_the_main_job()}
    undeclared = {name for name, owners in reached.items() if not owners & (CORE.keys() | EXTRAS)}
    assert not undeclared, "imported, and in no dependency of pyproject.toml"
    assert CORE.keys() == set().union(*reached.values()) & CORE.keys(), "a core dependency that nothing imports"
    assert not CORE.keys() & EXTRAS


def test_every_core_dependency_has_a_lower_bound_and_a_locked_version():
    locked = dict(line.split("==") for line in (ROOT / "constraints.txt").read_text("utf-8").splitlines())
    for name, requirement in CORE.items():
        (bound,) = requirement.specifier
        assert bound.operator == ">=", f"{name}: a lower bound and no other; constraints.txt holds the upper one"
        assert requirement.specifier.contains(locked[name]), name


def test_every_locked_version_has_its_hashes_and_no_address():
    hashes = (ROOT / "constraints-hashes.txt").read_text("utf-8")
    versions = re.findall(r"^([\w.-]+==[^\s;]+)[^\n]*\\\n +--hash=sha256:[0-9a-f]{64}", hashes, re.MULTILINE)
    normal = [re.sub("[-_.]+", "-", line).lower() for line in versions]
    locked = (ROOT / "constraints.txt").read_text("utf-8").split()
    assert sorted(normal) == sorted(re.sub("[-_.]+", "-", line).lower() for line in locked), "run tools/lock.py"
    assert "://" not in hashes and {line.partition("==")[0] for line in locked} >= {"ziglang", "uv"}


def test_the_page_of_installation_names_every_core_dependency_with_its_bound():
    page = (ROOT / "docs" / "install.md").read_text("utf-8")
    rows = re.findall(r"^\| `([\w-]+)` \| ([\d.]+) \| [\d.]+ \|", page, re.MULTILINE)
    assert dict(rows) == {name: next(iter(requirement.specifier)).version for name, requirement in CORE.items()}
