"""FRFs as a table, `frf.csv`: written, and read back with every fault refused by line and column."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle.errors import DataError
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.records.reader import read_table
from vehicle.signals.records.table import Header, Table, Vector, Wanted, key_column
from vehicle.signals.records.text_format import write_table

SUFFIXES = ("_magnitude", "_phase [deg]", "_coherence")
RANDOM_ERROR = "_random_error"
FREQUENCY = "frequency [Hz]"
NEEDED = f"{FREQUENCY!r} and {', '.join(f'<channel>{end}' for end in SUFFIXES)}"
LIMITS = {"_phase [deg]": (-math.inf, math.inf), "_coherence": (0.0, 1.0)}
"""Where other numbers are allowed than those from 0 on."""
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
    table = read_table(path, Wanted(needed=NEEDED, key=_frequency, missing="empty"))
    if len(table.values) < LEAST_LINES:
        raise DataError(f"{path}: {len(table.values)} rows of numbers; needed are a header and {LEAST_LINES} rows")
    frequency = table.values[:, table.key]
    _check_frequency(table, frequency)
    channels = _channels(table.header)
    found = {suffix: _columns(table, channels, suffix) for suffix in (*SUFFIXES, RANDOM_ERROR)}
    magnitude, phase, coherence, random_error = found.values()
    return FrfData(
        frequency=frequency,
        channels=channels,
        response=np.asarray(magnitude * np.exp(1j * np.radians(phase)), dtype=np.complex128),
        coherence=coherence,
        random_error=random_error,
    )


def _frequency(header: Header) -> int:
    """Index of the frequency in a header that holds what each channel needs."""
    key = key_column(FREQUENCY, NEEDED)(header)
    _channels(header)
    return key


def _channels(header: Header) -> tuple[str, ...]:
    """Channels of a header in their order."""
    names, ends = header.cells, (*SUFFIXES, RANDOM_ERROR)
    ended = {name: next((end for end in ends if name.endswith(end)), None) for name in names if name != FREQUENCY}
    unknown = next((name for name, end in ended.items() if end is None), None)
    if unknown is not None:
        raise DataError(
            f"{header.where}: unknown column {unknown!r}; allowed are {FREQUENCY!r} and, for each channel, "
            f"{', '.join(f'<channel>{end}' for end in ends)}"
        )
    channels = tuple(dict.fromkeys(name.removesuffix(end or "") for name, end in ended.items()))
    if not channels:
        raise DataError(f"{header.where}: no channel; needed are {NEEDED}")
    missing = next((one + end for one in channels for end in SUFFIXES if one + end not in names), None)
    if missing is not None:
        raise DataError(f"{header.where}: no column {missing!r}; a channel needs magnitude, phase and coherence")
    return channels


def _columns(table: Table, channels: Sequence[str], suffix: str) -> Vector:
    """Numbers of all channels, (channels, rows), NaN where the file does not tell them; refused out of their range."""
    heads, unknown = table.header.cells, np.full(len(table.values), np.nan)
    columns = [channel + suffix for channel in channels]
    values = np.array([table.values[:, heads.index(head)] if head in heads else unknown for head in columns])
    lowest, highest = LIMITS.get(suffix, (0.0, math.inf))
    bad = np.argwhere((values < lowest) | (values > highest))
    if bad.size:
        channel, row = (int(index) for index in bad[0])
        allowed = f"{lowest:g} to {highest:g}" if math.isfinite(highest) else f"{lowest:g} and above"
        raise DataError(
            f"{table.place(row)}: column {columns[channel]!r} holds {values[channel, row]:g}; allowed is {allowed}"
        )
    return values


def _check_frequency(table: Table, frequency: Vector) -> None:
    for index in np.flatnonzero(np.diff(frequency, prepend=0.0) <= 0.0)[:1].tolist():
        after = f" after {frequency[index - 1]:g}; the frequencies must rise" if index else "; allowed is above 0"
        raise DataError(f"{table.place(index)}: column {FREQUENCY!r} holds {frequency[index]:g}{after}")


def write_frf(
    path: Path,
    response: FrequencyResponse,
    channels: Sequence[str],
    frame: str,
    *,
    further: Mapping[str, FrequencyResponse] | None = None,
    words: str = "",
) -> None:
    """Write magnitude [m/s2 per m], phase [deg], coherence and random error of every channel; empty where undefined.

    Args:
        path: the file.
        response: rows of the channels.
        channels: their names.
        frame: axes of the vectors, in words.
        further: FRFs to further plates, wheel to rows of the same channels: columns `<channel>_to_<wheel>_magnitude`.
        words: what the FRFs are to, where that is more than one plate.
    """
    heads, columns = [FREQUENCY], [response.frequency]
    for end, one in (("", response), *((f"_to_{wheel}", other) for wheel, other in (further or {}).items())):
        for row, channel in enumerate(channels):
            heads += [channel + end + suffix for suffix in (*SUFFIXES, RANDOM_ERROR)]
            values = one.response[row]
            columns += [np.abs(values), np.degrees(np.angle(values)), one.coherence[row], one.random_error[row]]
    about = (
        "acceleration over plate displacement, magnitude and its random error (one standard error) in m/s2 per m, "
        f"coherence without unit; {response.estimator}; frame: {frame}"
    )
    write_table(path, heads, columns, [about, words] if words else [about])
