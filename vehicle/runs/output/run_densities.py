"""Table `psd.csv` of a run on a road: power spectral densities of all channels."""

from __future__ import annotations

from pathlib import Path

from vehicle.runs.car import Run
from vehicle.signals.analysis.spectra import power_spectral_density
from vehicle.signals.formats.text_format import write_table

PSD_WINDOW, PSD_HIGHEST = 4.0, 100.0
"""Length of a window [s] and highest frequency [Hz] of the densities of a run on a road."""


def write_densities(path: Path, run: Run, frame: str) -> None:
    """Write one-sided power spectral densities of all channels up to `PSD_HIGHEST`, by Welch's method."""
    window, recording = min(PSD_WINDOW, run.signal.duration - run.skip), run.recording
    each = [
        power_spectral_density(recording.timestep, values[run.evaluated], window_s=window)
        for values in recording.channels.values()
    ]
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
