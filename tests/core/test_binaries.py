"""The shipped libraries are built from these sources, and a changed source is compiled with the compiler at hand."""

import hashlib
import importlib.util
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import HANG
from vehicle.core import build, library
from vehicle.core.library import BINARIES
from vehicle.errors import MissingPartError

STAMP = json.loads((BINARIES / "stamp.json").read_text(encoding="utf-8"))["core"]
ROOT = Path(__file__).resolve().parents[2]


def test_the_libraries_are_built_from_these_sources():
    assert STAMP["sources"] == build.digest(), "build the libraries again: make core"
    assert len(STAMP["libraries"]) == 6
    for name, digest in STAMP["libraries"].items():
        assert hashlib.sha256((BINARIES / name).read_bytes()).hexdigest() == digest, name


@pytest.mark.skipif(library.platform_name() != "x86_64-linux", reason="another library")
def test_the_shipped_library_needs_no_compiler(monkeypatch):
    monkeypatch.setattr(library, "COMPILERS", ())
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    assert library.core.__wrapped__().core_variant() in (2, 3)


@pytest.mark.skipif(importlib.util.find_spec("ziglang") is None, reason="the compiler is not there: make tools")
def test_all_eleven_libraries_are_built_again_byte_for_byte():
    done = subprocess.run([sys.executable, "tools/core.py", "--check"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.count("same bytes") == 11, done.stdout + done.stderr


def test_without_library_and_compiler_it_is_said(monkeypatch, tmp_path):
    monkeypatch.setattr(library, "BINARIES", tmp_path)
    monkeypatch.setattr(library, "COMPILERS", ())
    monkeypatch.setattr(library, "cache_folder", lambda: tmp_path)
    monkeypatch.delenv("CC", raising=False)
    with pytest.raises(MissingPartError, match=r"missing or outdated.* install gcc or clang"):
        library.core.__wrapped__()
    monkeypatch.setenv("CC", "false")
    with pytest.raises(MissingPartError, match=r"compiled with false: .* variable CC to"):
        library.core.__wrapped__()
    compiler = tmp_path / "compiler"
    compiler.write_text(
        "#!/bin/sh\necho 'In file included from march.c:20:' >&2\n"
        "echo \"laws.h:12:3: error: 'x' undeclared\" >&2\nexit 1\n"
    )
    compiler.chmod(0o700)
    monkeypatch.setenv("CC", str(compiler))
    with pytest.raises(MissingPartError, match=r"compiler: laws\.h:12:3: error: 'x' undeclared; "):
        library.core.__wrapped__()


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_changed_sources_are_compiled_once_for_all_processes(tmp_path):
    script = (
        "import shutil, sys; from pathlib import Path; from vehicle.core import build, library, records;"
        "folder = Path(sys.argv[1]) / 'source'; folder.exists() or shutil.copytree(build.SOURCES, folder);"
        "(folder / 'layout.c').write_text((build.SOURCES / 'layout.c').read_text() + '/* changed */');"
        "build.OPTIONS[1] = '-O0'; library.SOURCES = folder; library.cache_folder = lambda: Path(sys.argv[1]);"
        "library.digest.__defaults__ = (folder,); print(library.core().core_variant())"
    )
    times = []
    for _ in range(2):
        command = [sys.executable, "-c", script, str(tmp_path)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=HANG)
        assert done.returncode == 0 and done.stdout.strip() in ("1", "2", "3"), done.stderr
        (kept,) = tmp_path.glob("core-*")
        times.append(kept.stat().st_mtime_ns)
    assert times[0] == times[1]
