"""Processes: of this system, and of CPython for Windows under wine."""

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 3600.0
"""Time after which a command counts as hung [s]."""


@dataclass(frozen=True)
class Ended:
    """A process that ended: exit code, and what it printed on both channels."""

    code: int
    text: str


def here(arguments: Sequence[str], folder: Path) -> Ended:
    """Run the program of this check-out with the Python of this process."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    return _run([sys.executable, "-m", "vehicle", *arguments], folder, environment)


class Windows:
    """CPython for Windows in a folder of `tools/windows_folder.py`, under wine."""

    def __init__(self, folder: Path, more: dict[str, str] | None = None) -> None:
        self.folder = folder
        self.python = folder / "python" / "python.exe"
        if not self.python.is_file():
            sys.exit(f"{self.python} is missing; make it with: python tools/windows_folder.py {folder} --for-wine")
        unset = {"DISPLAY", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MUJOCO_GL", "PYTHONPATH"}
        self.environment = {name: value for name, value in os.environ.items() if name not in unset} | {
            "WINEPREFIX": str(folder.parent / "wine-prefix"),
            "WINEARCH": "win64",
            "WINEDEBUG": "-all",
            "WINEDLLOVERRIDES": "mscoree=d;mshtml=d;ucrtbase=n,b",
            "PYTHONUTF8": "1",
            **(more or {}),
        }
        if not Path(self.environment["WINEPREFIX"]).is_dir():
            # As Windows 7, which wine 8 is by default, CPython takes an empty message of a pipe for one that is still
            # there: a pool of processes waits for ever.
            _run(["wine", "winecfg", "-v", "win10"], folder, self.environment)

    def start(self, arguments: Sequence[str], folder: Path) -> subprocess.Popen[str]:
        """Start python.exe with arguments; input and output are pipes, since wine has no console here."""
        return _start(["wine", str(self.python), *arguments], folder, self.environment)

    def start_script(self, name: str, arguments: Sequence[str], folder: Path) -> subprocess.Popen[str]:
        """Start a script of the folder, as vehicle.cmd."""
        return _start(["wine", "cmd", "/c", f"Z:{self.folder / name}", *arguments], folder, self.environment)

    def run(self, arguments: Sequence[str], folder: Path) -> Ended:
        """Run python.exe to its end."""
        return ended(self.start(arguments, folder))

    def end(self) -> None:
        """End all processes under this wine."""
        subprocess.run(["wineserver", "--kill"], env=self.environment)


def _start(command: Sequence[str], folder: Path, environment: dict[str, str]) -> subprocess.Popen[str]:
    return subprocess.Popen(
        command, cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        encoding="utf-8", errors="replace",
    )  # fmt: skip


def ended(process: subprocess.Popen[str]) -> Ended:
    """Wait for the end of a process, and kill one that hangs."""
    try:
        text, _ = process.communicate("", LONGEST)
    except subprocess.TimeoutExpired:
        process.kill()
        text, _ = process.communicate()
        return Ended(-1, f"{text}\nhung: no end in {LONGEST:g} s")
    return Ended(process.returncode, text)


def _run(command: Sequence[str], folder: Path, environment: dict[str, str]) -> Ended:
    return ended(_start(command, folder, environment))
