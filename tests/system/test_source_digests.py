"""Digests of sources change with every file they stand for: without one, old code and old results pass as new."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import vehicle
from vehicle import compiler
from vehicle.studies.sweeps import program

PACKAGE = Path(vehicle.__file__).parent


def compiled_sources():
    """Files with functions that are compiled: those that import what compiles, wherever they stand."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        imports = [
            node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.ImportFrom)
        ]
        names = {alias.name for node in imports if node.module == "vehicle.compiler" for alias in node.names}
        if names & {"jitable", "numba_module"}:
            found.append(path)
    return found


def digest_with(change, of, monkeypatch):
    """Digest that a function gives while one file, or none, has another content."""
    read = Path.read_bytes
    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", lambda path: read(path) + (b"#" if path == change else b""))
        return of.__wrapped__()


def test_stamp_of_compiled_code_changes_with_each_of_its_sources(monkeypatch):
    sources = compiled_sources()
    assert len({path.parent for path in sources}) >= 2 and len(sources) > 10, "the compiled functions were not found"
    stamp = digest_with(None, compiler.stamp, monkeypatch)
    assert stamp == digest_with(None, compiler.stamp, monkeypatch)
    without = [path.name for path in sources if digest_with(path, compiler.stamp, monkeypatch) == stamp]
    assert without == []


@pytest.mark.parametrize("wing", [".", *(path.parent.name for path in sorted(PACKAGE.glob("*/__init__.py")))])
def test_program_of_a_sweep_changes_with_every_wing(wing, monkeypatch):
    digest = digest_with(None, program.program_digest, monkeypatch)
    sources = sorted(path for path in (PACKAGE / wing).rglob("*") if path.suffix in (".py", ".c", ".h"))
    for path in (sources[0], sources[-1]):
        assert digest_with(path, program.program_digest, monkeypatch) != digest, path
