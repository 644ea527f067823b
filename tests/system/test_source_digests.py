"""The digest of the program changes with every file it stands for: without one, old results pass as new."""

from pathlib import Path

import pytest

import vehicle
from vehicle.studies.sweeps import program

PACKAGE = Path(vehicle.__file__).parent


def digest_with(change, of, monkeypatch):
    """Digest that a function gives while one file, or none, has another content."""
    read = Path.read_bytes
    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", lambda path: read(path) + (b"#" if path == change else b""))
        return of.__wrapped__()


@pytest.mark.parametrize("wing", [".", *(path.parent.name for path in sorted(PACKAGE.glob("*/__init__.py")))])
def test_program_of_a_sweep_changes_with_every_wing(wing, monkeypatch):
    digest = digest_with(None, program.program_digest, monkeypatch)
    sources = sorted(path for path in (PACKAGE / wing).rglob("*") if path.suffix in (".py", ".c", ".h"))
    for path in (sources[0], sources[-1]):
        assert digest_with(path, program.program_digest, monkeypatch) != digest, path
