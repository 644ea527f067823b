"""Write FRFs as the table `frf.csv`, and read it; errors name line and column."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.analysis.response_name import ResponseName, parsed_name
from vehicle.signals.analysis.samples import Complex
from vehicle.signals.formats.csv_table import write_table
from vehicle.signals.formats.table import Header, Table, Wanted, key_column
from vehicle.signals.formats.table_file import read_table

SUFFIXES = ("_magnitude", "_phase [deg]", "_coherence")
RANDOM_ERROR = "_random_error"
FREQUENCY = "frequency [Hz]"
NEEDED = f"{FREQUENCY!r} and, for each channel, {', '.join(f'<channel>{end}' for end in SUFFIXES)}"
LIMITS = {"_phase [deg]": (-math.inf, math.inf), "_coherence": (0.0, 1.0)}
"""Minimum and maximum values of columns that are not limited to 0 and above."""

LEAST_LINES = 8
"""Minimum number of frequencies in a file: the fit of a resonance needs about 8."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfData:
    """Measured FRFs at a level.

    Attributes:
        frequency: increasing frequencies [Hz], shape (m,).
        names: output and input of the k FRFs.
        response: acceleration per plate displacement [m/s2 per m], shape (k, m); NaN where undefined.
        coherence: gamma^2 [-], shape (k, m); NaN where undefined.
        random_error: standard error of |H| [m/s2 per m], shape (k, m); NaN if unknown.
    """

    frequency: Vector
    names: tuple[ResponseName, ...]
    response: Complex
    coherence: Vector
    random_error: Vector

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the output of each FRF, (k,)."""
        return tuple(name.output for name in self.names)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Return the distinct known inputs, for example "plate_fr"."""
        return tuple(dict.fromkeys(name.input for name in self.names if name.motion))

    @property
    def labels(self) -> tuple[str, ...]:
        """Return the names of the FRFs in tables and figures, (k,): the output, with its plate for several inputs."""
        return tuple(str(name) if len(self.inputs) > 1 else name.output for name in self.names)

    def renamed(self, names: Sequence[ResponseName]) -> FrfData:
        """Return the same FRFs under other names, (k,)."""
        return replace(self, names=tuple(names))

    def select(self, channels: Sequence[str], *, band: tuple[float, float], spacing: float = 0.0) -> FrfData:
        """Return the FRFs of channels in a frequency band, with a minimum spacing of the frequencies.

        Args:
            channels: names of outputs, or of output and plate ("knuckle_fr_acc_z/plate_fr").
            band: minimum and maximum frequency [Hz].
            spacing: minimum spacing of the frequencies [Hz]. Adjacent lines of an estimate are correlated; lines
                separated by its resolution are not.

        Raises:
            DataError: a channel is missing, or too few frequencies remain.
        """
        accepted = [(name.output, str(name)) for name in self.names]
        missing = next((name for name in channels if not any(name in pair for pair in accepted)), None)
        if missing is not None:
            raise DataError(f"FRF: no channel {missing}; the file has {', '.join(str(name) for name in self.names)}")
        selected: list[int] = []
        for index in np.flatnonzero((self.frequency >= band[0]) & (self.frequency <= band[1])):
            if not selected or self.frequency[index] - self.frequency[selected[-1]] >= 0.999 * spacing:
                selected.append(int(index))
        if len(selected) < LEAST_LINES:
            raise DataError(
                f"FRF: {len(selected)} frequencies between {band[0]:g} and {band[1]:g} Hz with a spacing of "
                f"{spacing:g} Hz, must be at least {LEAST_LINES}; widen the band or reduce the spacing"
            )
        rows = list(dict.fromkeys(row for name in channels for row, pair in enumerate(accepted) if name in pair))
        return FrfData(
            frequency=self.frequency[selected],
            names=tuple(self.names[row] for row in rows),
            response=self.response[np.ix_(rows, selected)],
            coherence=self.coherence[np.ix_(rows, selected)],
            random_error=self.random_error[np.ix_(rows, selected)],
        )


def frf_data(motions: Sequence[MotionResponse], channels: Sequence[str]) -> FrfData:
    """Return the FRFs of channels to each motion of the plates, output by output.

    Args:
        motions: FRFs to each motion, with a row for each channel.
    """
    pairs = [(row, motion) for row in range(len(channels)) for motion in motions]
    rows = {
        name: np.array([getattr(motion.response, name)[row] for row, motion in pairs])
        for name in ("response", "coherence", "random_error")
    }
    names = tuple(motion.named(channels[row]) for row, motion in pairs)
    return FrfData(frequency=motions[0].response.frequency, names=names, **rows)


def read_frf(path: Path) -> FrfData:
    """Read FRFs from a table with the columns of `frf.csv`.

    `#` comments, one header line `frequency [Hz]`, then `<channel>_magnitude` [m/s2 per m], `<channel>_phase [deg]`
    and `<channel>_coherence` of each channel, optionally `<channel>_random_error` [m/s2 per m]; an empty cell for an
    undefined value. With several plates a channel is `<channel>/<plate>`.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: invalid header, cell, or order of the frequencies.
    """
    table = read_table(path, Wanted(needed=NEEDED, key=_frequency, missing="empty"))
    if len(table.values) < LEAST_LINES:
        raise DataError(f"{path}: has {len(table.values)} rows, but at least {LEAST_LINES} are needed")
    frequency = table.values[:, table.key]
    for index in np.flatnonzero(np.diff(frequency, prepend=0.0) <= 0.0)[:1].tolist():
        after = f" after {frequency[index - 1]:g}; frequencies must increase" if index else ", must be above 0"
        raise DataError(f"{table.place(index)}: column {FREQUENCY!r} has the value {frequency[index]:g}{after}")
    channels = _channels(table.header)
    magnitude, phase, coherence, random_error = (
        _columns(table, channels, suffix) for suffix in (*SUFFIXES, RANDOM_ERROR)
    )
    return FrfData(
        frequency=frequency,
        names=tuple(parsed_name(channel) for channel in channels),
        response=np.asarray(magnitude * np.exp(1j * np.radians(phase)), dtype=np.complex128),
        coherence=coherence,
        random_error=random_error,
    )


def _frequency(header: Header) -> int:
    """Return the index of the frequency column; check that the columns of each channel are complete."""
    key = key_column(FREQUENCY, NEEDED)(header)
    _channels(header)
    return key


def _channels(header: Header) -> tuple[str, ...]:
    """Return the channel names of a header, in order; check that their columns are complete."""
    names, ends = header.cells, (*SUFFIXES, RANDOM_ERROR)
    suffix_of = {name: next((end for end in ends if name.endswith(end)), None) for name in names if name != FREQUENCY}
    unknown = next((name for name, end in suffix_of.items() if end is None), None)
    if unknown is not None:
        raise DataError(
            f"{header.where}: unknown column {unknown!r}; must be {FREQUENCY!r} or, for each channel, "
            f"{', '.join(f'<channel>{end}' for end in ends)}"
        )
    channels = tuple(dict.fromkeys(name.removesuffix(end or "") for name, end in suffix_of.items()))
    if not channels:
        raise DataError(f"{header.where}: contains no channel; the columns must be {NEEDED}")
    missing = next((channel + end for channel in channels for end in SUFFIXES if channel + end not in names), None)
    if missing is not None:
        raise DataError(f"{header.where}: no column {missing!r}; a channel needs magnitude, phase and coherence")
    return channels


def _columns(table: Table, channels: Sequence[str], suffix: str) -> Vector:
    """Return the columns of one suffix, (channels, rows), NaN if missing; reject values out of range."""
    heads, unknown = table.header.cells, np.full(len(table.values), np.nan)
    columns = [channel + suffix for channel in channels]
    values = np.array([table.values[:, heads.index(head)] if head in heads else unknown for head in columns])
    lowest, highest = LIMITS.get(suffix, (0.0, math.inf))
    bad = np.argwhere((values < lowest) | (values > highest))
    if bad.size:
        channel, row = (int(index) for index in bad[0])
        allowed = f"{lowest:g} to {highest:g}" if math.isfinite(highest) else f"{lowest:g} and above"
        raise DataError(
            f"{table.place(row)}: column {columns[channel]!r} has the value {values[channel, row]:g} but must be "
            f"{allowed}"
        )
    return values


def write_frf(
    path: Path, responses: Mapping[str, FrequencyResponse], channels: Sequence[str], frame: str, inputs: str = ""
) -> None:
    """Write magnitude [m/s2 per m], phase [deg], coherence and random error of each channel; undefined values empty.

    Args:
        responses: input ("plate_fr") to the FRFs of the channels, in columns `<channel>_magnitude` for one input,
            `<channel>/<input>_magnitude` for several.
        frame: description of the vector axes.
        inputs: description of the inputs if there is more than one plate.
    """
    first = next(iter(responses.values()))
    heads, columns = [FREQUENCY], [first.frequency]
    for plate, response_to in responses.items():
        end = f"/{plate}" if len(responses) > 1 else ""
        for row, channel in enumerate(channels):
            heads += [channel + end + suffix for suffix in (*SUFFIXES, RANDOM_ERROR)]
            values = response_to.response[row]
            columns += [
                np.abs(values),
                np.degrees(np.angle(values)),
                response_to.coherence[row],
                response_to.random_error[row],
            ]
    description = (
        "acceleration per plate displacement, magnitude and its random error (one standard error) in m/s2 per m, "
        f"coherence without unit; {first.estimator}; frame: {frame}"
    )
    write_table(path, heads, columns, [description, inputs] if inputs else [description])
