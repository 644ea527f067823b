"""Small CSV files for the tests of this folder."""

from functools import partial
from pathlib import Path

import numpy as np

from vehicle.signals.excitation.signal_file import read_signal

HEADER = "time [s],displacement [m]"

read_plain = partial(read_signal, wheel="fr")
"""Read a signal whose plain `displacement` column drives the wheel fr."""


def rows(count: int = 400, *, rate: float = 1000.0, amplitude: float = 1e-3, frequency: float = 10.0) -> list[str]:
    """Rows of a raised cosine, at rest at t = 0: z = A/2 (1 - cos(2 pi f t))."""
    t = np.arange(count) / rate
    z = 0.5 * amplitude * (1.0 - np.cos(2.0 * np.pi * frequency * t))
    return [f"{a:.6f},{b:.9e}" for a, b in zip(t, z, strict=True)]


def write(folder: Path, lines: list[str], name: str = "signal.csv") -> Path:
    path = folder / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="")
    return path


def with_row(index: int, text: str, count: int = 400) -> list[str]:
    """Header and rows, row `index` (line index + 2) replaced."""
    lines = rows(count)
    lines[index] = text
    return [HEADER, *lines]


def curve(time, z, decimals: int = 3) -> list[str]:
    """Header and rows of times [s] and displacements [m]."""
    return [HEADER, *(f"{a:.{decimals}f},{b:.9e}" for a, b in zip(time, z, strict=True))]
