"""Tables of spectra as CSV text, the pictures that belong to them, and the densities of a run on a road."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.mapped_table import release
from vehicle.names import point_words
from vehicle.runs.car import Run
from vehicle.signals.analysis.spectra import power_spectral_density
from vehicle.signals.formats.csv_table import table_text, write_table
from vehicle.signals.records.record_spectra import RecordSpectra

PSD_WINDOW, PSD_HIGHEST = 4.0, 100.0
"""Length of a window [s] and highest frequency [Hz] of the densities of a run on a road."""


def picture_columns(runs: Sequence[RecordSpectra]) -> dict[str, tuple[str, dict[str, str]]]:
    """Return the file of each picture to its title and its columns (channel to heading), for channels in all runs.

    A picture contains the axes of one point, or the vertical motion of all knuckles.
    """
    shared = [
        name
        for name in dict.fromkeys(spectrum.name for spectrum in runs[0].channels)
        if all(name in {spectrum.name for spectrum in run.channels} for run in runs)
    ]
    if not shared:
        raise ConfigurationError("spectra: the runs have no channel in common; choose channels that all record")
    pictures: dict[str, tuple[str, dict[str, str]]] = {}
    for name in shared:
        point, _, axis = name.rpartition("_acc_")
        if point.startswith("knuckle_"):
            file, title, heading = "knuckles", f"Acceleration of the knuckles, {axis}", point_words(point)
        else:
            file, title, heading = point or name, f"Acceleration of the {point_words(point or name)}", axis
        pictures.setdefault(f"spectra_{file}.png", (title, {}))[1][name] = heading
    return pictures


def spectra_text(runs: Mapping[str, RecordSpectra], caption: str) -> str:
    """Return the table of densities and cumulative RMS as CSV text, a row for each line of each channel."""
    heads = ("run", "channel", "weighting", "frequency [Hz]", "density [(m/s2)^2/Hz]", "cumulative RMS [m/s2]")
    rows = [
        (name, spectrum.name, spectrum.weighting, *numbers)
        for name, run in runs.items()
        for spectrum in run.channels
        for numbers in zip(spectrum.frequency, spectrum.density, spectrum.cumulative_rms, strict=True)
    ]
    note = "densities: Welch's method, Hann windows; cumulative RMS from the lowest frequency upwards"
    return table_text([heads, *rows], [f"{caption}; {note}"])


def third_octaves_text(runs: Mapping[str, RecordSpectra], caption: str) -> str:
    """Return the table of third octaves as CSV text, a row for each band of each channel."""
    heads = ("run", "channel", "weighting", "midband [Hz]", "from [Hz]", "to [Hz]", "RMS [m/s2]", "standard error [-]")
    rows = [
        (name, spectrum.name, spectrum.weighting, *numbers)
        for name, run in runs.items()
        for spectrum in run.channels
        for bands in [spectrum.third_octaves]
        for numbers in zip(
            bands.nominal, bands.edges[:-1], bands.edges[1:], bands.rms, bands.standard_error, strict=True
        )
    ]
    note = "third octaves of IEC 61260-1 (base ten), rectangular; empty where the record is shorter than 1/bandwidth"
    return table_text([heads, *rows], [f"{caption}; {note}"])


def write_densities(path: Path, run: Run, frame: str) -> None:
    """Write one-sided power spectral densities of all channels up to `PSD_HIGHEST`, by Welch's method."""
    window, recording = min(PSD_WINDOW, run.signal.duration - run.skip), run.recording
    each = []
    for values in recording.channels.values():
        each.append(power_spectral_density(recording.timestep, values[run.evaluated], window_s=window))
        release(values)
    first = each[0]
    inside = first.frequency <= PSD_HIGHEST
    cells = ["frequency [Hz]", *(f"{name} [({recording.units[name]})^2/Hz]" for name in recording.channels)]
    method = f"one-sided power spectral density: Hann windows of {window:g} s, {first.averages:.3g} averages"
    method += f"; from {run.skip:g} s on"
    write_table(
        path,
        cells,
        [first.frequency[inside], *(values.density[0, inside] for values in each)],
        [method, frame],
    )
