"""The FRFs of a run with the names of their channels: what they look like in a notebook."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.analysis.frf import FrequencyResponse
from vehicle.notebook.frames import response_frame
from vehicle.notebook.picture import Picture, card, line_drawing, picture


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class RunResponse(FrequencyResponse):
    """FRFs of a run.

    Attributes:
        names: channels of the rows.
        plate: what the responses are to, in words.
    """

    names: tuple[str, ...]
    plate: str

    def __repr__(self) -> str:
        """One line."""
        shown = ", ".join(self.names[:3]) + (f" and {len(self.names) - 3} more" if len(self.names) > 3 else "")
        return (
            f"FRFs of {shown} to {self.plate}: {self.frequency.size} lines, {self.frequency[0]:g} to "
            f"{self.frequency[-1]:.3g} Hz, {self.estimator}"
        )

    def _repr_html_(self) -> str:
        rows = {"to": self.plate, "estimator": self.estimator, "lines": f"{self.frequency.size}"}
        for row, name in enumerate(self.names[:5]):
            size = np.abs(self.response[row])
            if np.isfinite(size).any():
                top = int(np.nanargmax(size))
                rows[name] = f"largest {size[top]:.3g} m/s² per m at {self.frequency[top]:.2f} Hz"
        with np.errstate(divide="ignore"):
            level = np.log10(np.abs(self.response[0]))
        label = f"{self.names[0]}, log magnitude over log frequency"
        return card("Frequency responses", rows, line_drawing(np.log10(self.frequency), level, label))

    def plot(self) -> Picture:
        """Magnitude, phase and coherence of all rows."""
        from vehicle.rendering.response_plot import plot_response

        def draw(path: Path) -> None:
            plot_response(path, self, self.names, f"Frequency responses to {self.plate}", self.estimator)

        return picture(draw)

    def to_dataframe(self) -> Any:
        """A pandas table, as of `response_frame`."""
        return response_frame(self, self.names)


def named(response: FrequencyResponse, names: tuple[str, ...], plate: str) -> RunResponse:
    """FRFs with their names."""
    values = {one.name: getattr(response, one.name) for one in fields(FrequencyResponse)}
    return RunResponse(**values, names=names, plate=plate)
