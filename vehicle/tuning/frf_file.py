"""Reading FRFs back from `frf.csv`, strictly: whatever is wrong is refused with file, line and column."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, DataError

Vector = npt.NDArray[np.float64]

SUFFIXES = ("_magnitude", "_phase [deg]", "_coherence")
RANDOM_ERROR = "_random_error"
FREQUENCY = "frequency [Hz]"
LEAST_LINES = 8
"""Frequencies that a file must hold: a resonance that is fitted needs about as many."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfData:
    """Measured FRFs of one level.

    Attributes:
        frequency: [Hz], shape (m,), rising.
        channels: names, k of them.
        response: acceleration over plate displacement [m/s2 per m], shape (k, m); NaN where undefined.
        coherence: gamma^2 [-], shape (k, m); NaN where undefined.
        random_error: standard error of |H| [m/s2 per m], shape (k, m); NaN where the file does not tell it.
    """

    frequency: Vector
    channels: tuple[str, ...]
    response: npt.NDArray[np.complex128]
    coherence: Vector
    random_error: Vector

    def select(self, channels: Sequence[str], *, band: tuple[float, float], spacing: float = 0.0) -> FrfData:
        """Some channels over a band, with frequencies at least a distance apart.

        Args:
            channels: names.
            band: lowest and highest frequency [Hz].
            spacing: least distance of the frequencies [Hz]. Neighbouring lines of an estimate share data; lines that
                are its resolution apart do not.

        Returns:
            The selection.

        Raises:
            DataError: a channel is missing, or too few frequencies are left.
        """
        missing = next((name for name in channels if name not in self.channels), None)
        if missing is not None:
            raise DataError(f"FRF: no channel {missing}; there are {', '.join(self.channels)}")
        kept: list[int] = []
        for index in np.flatnonzero((self.frequency >= band[0]) & (self.frequency <= band[1])):
            if not kept or self.frequency[index] - self.frequency[kept[-1]] >= 0.999 * spacing:
                kept.append(int(index))
        if len(kept) < LEAST_LINES:
            raise DataError(
                f"FRF: {len(kept)} frequencies between {band[0]:g} and {band[1]:g} Hz that are {spacing:g} Hz apart; "
                f"at least {LEAST_LINES} are needed; widen the band or lower the spacing"
            )
        rows = [self.channels.index(name) for name in channels]
        return FrfData(
            frequency=self.frequency[kept],
            channels=tuple(channels),
            response=self.response[np.ix_(rows, kept)],
            coherence=self.coherence[np.ix_(rows, kept)],
            random_error=self.random_error[np.ix_(rows, kept)],
        )


def read_frf(path: Path) -> FrfData:
    """Read a file with the columns of `frf.csv`.

    `#` comments, one header line `frequency [Hz]`, then `<channel>_magnitude` [m/s2 per m], `<channel>_phase [deg]`
    and `<channel>_coherence` of each channel, `<channel>_random_error` [m/s2 per m] where it is known; an empty cell
    where a value is undefined.

    Args:
        path: the file.

    Returns:
        All its channels.

    Raises:
        ConfigurationError: no such file.
        DataError: the header, a cell, or the order of the frequencies is wrong.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: no such file; give the frf.csv of a run or of a measurement")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: byte {error.start} is not UTF-8; save the file as UTF-8 text") from None
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check the file and its permissions") from None
    rows = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    rows = [(number, line) for number, line in rows if not line.lstrip().startswith("#")]
    if len(rows) < 1 + LEAST_LINES:
        raise DataError(f"{path}: {max(len(rows) - 1, 0)} rows of numbers; needed are a header and {LEAST_LINES} rows")
    header_line, header = rows[0]
    names = [cell.strip().strip('"') for cell in header.split(",")]
    channels = _channels(f"{path}:{header_line}", names)
    table = np.array([_numbers(path, number, line, names) for number, line in rows[1:]])
    frequency = table[:, names.index(FREQUENCY)]
    _check_frequency(path, frequency, [number for number, _ in rows[1:]])
    parts = [
        np.array([table[:, names.index(channel + suffix)] for channel in channels]).reshape(len(channels), -1)
        for suffix in SUFFIXES
    ]
    magnitude, phase, coherence = parts
    unknown = np.full(len(table), np.nan)
    errors = [channel + RANDOM_ERROR for channel in channels]
    random_error = np.array([table[:, names.index(name)] if name in names else unknown for name in errors])
    _check_range(path, rows[1:], channels, SUFFIXES[0], magnitude, 0.0, math.inf)
    _check_range(path, rows[1:], channels, SUFFIXES[2], coherence, 0.0, 1.0)
    _check_range(path, rows[1:], channels, RANDOM_ERROR, random_error, 0.0, math.inf)
    return FrfData(
        frequency=frequency,
        channels=channels,
        response=magnitude * np.exp(1j * np.radians(phase)),
        coherence=coherence,
        random_error=random_error,
    )


def _channels(where: str, names: Sequence[str]) -> tuple[str, ...]:
    """Channels of a header in their order."""
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise DataError(f"{where}: column {twice!r} appears twice; each may appear once")
    if FREQUENCY not in names:
        raise DataError(f"{where}: no column {FREQUENCY!r}; found {', '.join(map(repr, names[:6]))}")
    channels: list[str] = []
    for name in names:
        suffix = next((end for end in (*SUFFIXES, RANDOM_ERROR) if name.endswith(end)), None)
        if suffix is None and name != FREQUENCY:
            raise DataError(
                f"{where}: unknown column {name!r}; allowed are {FREQUENCY!r} and, for each channel, "
                f"{', '.join(f'<channel>{end}' for end in (*SUFFIXES, RANDOM_ERROR))}"
            )
        if suffix is not None and (channel := name.removesuffix(suffix)) not in channels:
            channels.append(channel)
    if not channels:
        raise DataError(f"{where}: no channel; needed are {', '.join(f'<channel>{end}' for end in SUFFIXES)}")
    for channel in channels:
        missing = next((channel + suffix for suffix in SUFFIXES if channel + suffix not in names), None)
        if missing is not None:
            raise DataError(f"{where}: no column {missing!r}; a channel needs magnitude, phase and coherence")
    return tuple(channels)


def _numbers(path: Path, number: int, line: str, names: Sequence[str]) -> list[float]:
    cells = [cell.strip() for cell in line.split(",")]
    if len(cells) != len(names):
        raise DataError(f"{path}:{number}: {len(cells)} cells, the header has {len(names)}; one cell for each column")
    values = []
    for name, cell in zip(names, cells, strict=True):
        try:
            value = float(cell) if cell else math.nan
        except ValueError:
            value = math.inf
        if math.isinf(value) or (cell and math.isnan(value)) or (not cell and name == FREQUENCY):
            raise DataError(
                f"{path}:{number}: column {name!r} holds {cell!r}; allowed are finite numbers with a decimal point"
                f"{'' if name == FREQUENCY else ', or an empty cell where the FRF is undefined'}"
            )
        values.append(value)
    return values


def _check_frequency(path: Path, frequency: Vector, numbers: Sequence[int]) -> None:
    if frequency[0] <= 0.0:
        raise DataError(f"{path}:{numbers[0]}: column {FREQUENCY!r} holds {frequency[0]:g}; allowed is above 0")
    falling = np.flatnonzero(np.diff(frequency) <= 0.0)
    if falling.size:
        index = int(falling[0]) + 1
        raise DataError(
            f"{path}:{numbers[index]}: column {FREQUENCY!r} holds {frequency[index]:g} after {frequency[index - 1]:g}; "
            "the frequencies must rise"
        )


def _check_range(
    path: Path,
    rows: Sequence[tuple[int, str]],
    channels: Sequence[str],
    suffix: str,
    values: Vector,
    lowest: float,
    highest: float,
) -> None:
    bad = np.argwhere((values < lowest) | (values > highest))
    if bad.size:
        channel, row = (int(index) for index in bad[0])
        allowed = f"{lowest:g} to {highest:g}" if math.isfinite(highest) else f"{lowest:g} and above"
        raise DataError(
            f"{path}:{rows[row][0]}: column {channels[channel] + suffix!r} holds {values[channel, row]:g}; "
            f"allowed is {allowed}"
        )
