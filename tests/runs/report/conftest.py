"""One short run with all its files and its report, made once."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from vehicle.commands.shaker import main
from vehicle.signals.excitation.random_road import random_road
from vehicle.signals.excitation.signal_file import write_signal


@dataclass(frozen=True)
class Reported:
    """A folder of a run, and its report."""

    folder: Path
    page: Path

    @property
    def text(self) -> str:
        return self.page.read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def reported(tmp_path_factory: pytest.TempPathFactory) -> Reported:
    """A run of 20 s with another friction, whose input has a name that is markup."""
    place = tmp_path_factory.mktemp("report")
    write_signal(place / "a<b>&c.csv", random_road(rms=5.25e-4, seed=3, wheel="fl", duration=20.0), plain=True)
    folder = place / "run"
    words = [
        "--input",
        str(place / "a<b>&c.csv"),
        "--output",
        str(folder),
        "--engine",
        "reduced",
        "--quiet",
        "--report",
        "--author",
        "A. Engineer",
        "--project",
        "Ride",
    ]
    assert main([*words, "--set", "damper.coulomb_friction=100"]) == 0
    return Reported(folder=folder, page=folder / "report.html")
