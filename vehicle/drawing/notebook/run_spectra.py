"""Spectra of a run with their display in a notebook."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from vehicle.drawing.notebook.frames import spectra_frame
from vehicle.drawing.notebook.picture import card, line_drawing
from vehicle.signals.records.record_spectra import RecordSpectra


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class RunSpectra(RecordSpectra):
    """Spectra of a run; `channels` contains the numbers.

    Attributes:
        car: car of the run, for the legend.
    """

    car: str

    def __repr__(self) -> str:
        """Return a summary in one line."""
        first = self.channels[0]
        names = ", ".join(spectrum.label for spectrum in self.channels[:3])
        more = f" and {len(self.channels) - 3} more" if len(self.channels) > 3 else ""
        return f"Spectra of {names}{more}: {first.frequency[0]:g} to {first.frequency[-1]:g} Hz, {self.caption}"

    def _repr_html_(self) -> str:
        rows = {each.label: f"RMS {each.rms:.3g} {each.unit.replace('s2', 's²')}" for each in self.channels[:8]}
        shown = self.channels[0]
        label = f"{shown.label}: cumulative RMS against frequency"
        return card("Spectra", rows, line_drawing(shown.frequency, shown.cumulative_rms, label))

    def plot(self, ax: Any = None) -> Any:
        """Plot density, third octaves and cumulative RMS of up to four channels, those of seat and seat rail first.

        Channels of one unit share a scale.

        Args:
            ax: axes of the densities of all channels, which then have one unit, or an array of three axes for each
                channel; default: a new figure.

        Returns:
            The axes: one; three of a channel; or an array of three rows with a column for each channel.

        Raises:
            ConfigurationError: densities of several units on one axis.
        """
        from vehicle.drawing.rendering.open_axes import open_axes, plain
        from vehicle.drawing.rendering.spectra_plot import draw_densities, draw_spectra

        units = {spectrum.name: spectrum.unit for spectrum in self.channels}
        first = sorted(units, key=lambda name: not name.startswith("seat"))[:4]
        names = [name for unit in dict.fromkeys(units[name] for name in first) for name in first if units[name] == unit]
        if ax is not None and np.array(ax, dtype=object).size == 1:
            axes = open_axes(ax, (8.0, 5.0))
            draw_densities(axes[0, 0], self.channels, self.car)
            return plain(axes)
        look: dict[str, Any] = {"sharex": True, "height_ratios": (2.0, 1.3, 1.3)}
        axes = open_axes(ax, (max(7.0, 1.6 + 3.8 * len(names)), 8.6), 3, len(names), **look)
        draw_spectra(axes, {self.car: self.channels}, {name: name for name in names})
        return plain(axes)

    def to_dataframe(self) -> Any:
        """Return a pandas table of density and cumulative RMS of each channel; see `spectra_frame`."""
        return spectra_frame(self.channels)


def with_display(spectra: RecordSpectra, car: str) -> RunSpectra:
    """Return spectra with the display of a notebook."""
    return RunSpectra(**{field.name: getattr(spectra, field.name) for field in fields(RecordSpectra)}, car=car)
