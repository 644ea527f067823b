"""Commands as a user runs them: in a folder of their own, with a short signal."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.commands.shaker import main
from vehicle.signals.excitation.signal_file import write_signal


@dataclass(frozen=True)
class Outcome:
    """Exit code and what was printed."""

    code: int
    out: str
    err: str


@pytest.fixture
def shaker(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Outcome]:
    """Run the shaker command in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> Outcome:
        code = main(list(arguments))
        printed = capsys.readouterr()
        return Outcome(code, printed.out, printed.err)

    return run


@pytest.fixture
def short_signal(tmp_path: Path) -> Path:
    """A random signal of 6 s at the high level."""
    return write_short(tmp_path / "short.csv")


def write_short(path: Path) -> Path:
    """Write that signal."""
    write_signal(path, random_road(rms=5.25e-4, seed=3, wheel="fl", duration=6.0), plain=True)
    return path


def csv_text(displacement: np.ndarray, rate: float = 1000.0, header: str = "time [s],displacement [m]") -> str:
    """A signal file as text."""
    rows = [f"{index / rate:.6f},{value:.6e}" for index, value in enumerate(displacement)]
    return "\n".join([header, *rows]) + "\n"
