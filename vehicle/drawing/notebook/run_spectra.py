"""Spectra of a run with their display in a notebook."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from vehicle.drawing.notebook.frames import spectra_frame
from vehicle.drawing.notebook.picture import Picture, card, line_drawing, picture
from vehicle.signals.records.record_spectra import RecordSpectra


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class RunSpectra(RecordSpectra):
    """Spectra of a run; `channels` contains the numbers."""

    def __repr__(self) -> str:
        """Return a summary in one line."""
        first = self.channels[0]
        names = ", ".join(spectrum.label for spectrum in self.channels[:3])
        more = f" and {len(self.channels) - 3} more" if len(self.channels) > 3 else ""
        return f"Spectra of {names}{more}: {first.frequency[0]:g} to {first.frequency[-1]:g} Hz, {self.caption}"

    def _repr_html_(self) -> str:
        rows = {spectrum.label: f"RMS {spectrum.rms:.3g} m/s²" for spectrum in self.channels[:8]}
        shown = self.channels[0]
        label = f"{shown.label}: cumulative RMS over frequency"
        return card("Spectra", rows, line_drawing(shown.frequency, shown.cumulative_rms, label))

    def plot(self) -> Picture:
        """Plot density, third octaves and cumulative RMS of up to four channels."""
        from vehicle.drawing.rendering.spectra_plot import plot_spectra

        names = list(dict.fromkeys(spectrum.name for spectrum in self.channels))[:4]
        runs, columns = {self.name: self.channels}, {name: name for name in names}
        return picture(lambda path: plot_spectra(path, runs, columns, "", self.caption))

    def to_dataframe(self) -> Any:
        """Return a pandas table of density and cumulative RMS of each channel; see `spectra_frame`."""
        return spectra_frame(self.channels)


def with_display(spectra: RecordSpectra) -> RunSpectra:
    """Return spectra with the display of a notebook."""
    return RunSpectra(**{field.name: getattr(spectra, field.name) for field in fields(RecordSpectra)})
