"""Pictures of a comparison: responses and time histories of an output point, signatures, MAC."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import (
    COLOURS,
    FRF_BAND,
    FRF_TICKS,
    fading,
    frequency_ticks,
    frf_axes,
    saved_figure,
    wrapped_phase,
)
from vehicle.runs.comparison.frf_comparison import FrfComparison, Signatures
from vehicle.runs.comparison.record_comparison import RecordComparison

MEASURED, SIMULATED = "#222222", COLOURS[1]
"""Black and full, red and dashed: distinguishable without colours."""
LOOKS = {
    "measured": {"color": MEASURED, "linewidth": 1.3},
    "simulated": {"color": SIMULATED, "linestyle": "--", "linewidth": 1.3},
}
DETAIL = 1.0
"""Length of the magnified excerpt [s]."""


def draw_responses(axes: npt.NDArray[Any], responses: Sequence[FrfComparison]) -> None:
    """Draw magnitude, phase and both coherences of the responses of an output point on axes, (3, responses)."""
    for response, (magnitude, phase, coherence) in zip(responses, axes.T, strict=True):
        pairs = {
            "measured": (response.measured, response.measured_coherence),
            "simulated": (response.simulated, response.simulated_coherence),
        }
        for label, (values, beside) in pairs.items():
            fading(magnitude, response.frequency, np.abs(values), beside, label, **LOOKS[label])
            phase.plot(response.frequency, wrapped_phase(values.copy()), **LOOKS[label])
            if np.isfinite(beside).any():
                coherence.plot(response.frequency, beside, label=label, **LOOKS[label])
        to_plate = f" to {response.plate}" if response.plate else ""
        scaled = f"{response.scaled_frac:.3f} with frequencies times {response.scale:.3f}"
        magnitude.set_title(f"{response.channel}{to_plate}\nFRAC {response.frac:.3f}; {scaled}")
        magnitude.legend(loc="best")
    frf_axes(axes[0, 0].figure, axes, (0, 0.25, 0.5, 0.75, 1))
    lines = np.concatenate([response.frequency for response in responses])
    low, high = max(float(lines.min()), 0.9 * FRF_BAND[0]), float(lines.max())
    if low > 2.0 * FRF_BAND[0] or high < 0.5 * FRF_BAND[1]:
        axes[0, 0].set_xlim(low, high)


def draw_histories(axes: npt.NDArray[Any], histories: Sequence[RecordComparison]) -> None:
    """Draw time histories of an output point on axes, (histories, 2): whole record and excerpt."""
    for history, (whole, detail) in zip(histories, axes, strict=True):
        inside = _highest_level(history)
        for label in LOOKS:
            values = getattr(history, label)
            whole.plot(history.time, values, **(LOOKS[label] | {"linewidth": 0.6}), label=label)
            detail.plot(history.time[inside], values[inside], **LOOKS[label], label=label)
        whole.set_ylabel(f"{history.channel}\n[{history.unit.replace('2', '²')}]")
        whole.set_xlim(history.time[0], history.time[-1])
        detail.set_xlim(history.time[inside][0], history.time[inside][-1])
    axes[0, 0].set_title("whole record")
    axes[0, 1].set_title("part with the highest measured level")
    axes[0, 1].legend(loc="upper right", ncols=2)
    for axis in axes[-1]:
        axis.set_xlabel("time of the run [s]")


def _highest_level(record: RecordComparison) -> slice:
    """Return the excerpt of length `DETAIL` with the highest measured level."""
    count = min(max(int(DETAIL / (record.time[1] - record.time[0])), 2), record.time.size)
    total = np.concatenate([[0.0], np.cumsum(record.measured**2)])
    first = int(np.argmax(total[count:] - total[:-count]))
    return slice(first, first + count)


def draw_signatures(axes: npt.NDArray[Any], signatures: Signatures) -> None:
    """Draw CSAC and CSF over frequency on one axes."""
    axis, frequency = axes.item(), signatures.frequency
    axis.plot(frequency, signatures.csac, color=COLOURS[0], label="CSAC: agreement of the shape over the points")
    axis.plot(frequency, signatures.csf, color=COLOURS[3], linestyle="--", label="CSF: shape and amplitude")
    axis.set(xscale="log", ylim=(0.0, 1.03), xlim=(frequency[0], frequency[-1]), xlabel="frequency [Hz]",
             ylabel="1 is equal [-]")  # fmt: skip
    frequency_ticks(axis, FRF_TICKS)
    axis.set_xlim(frequency[0], frequency[-1])
    axis.legend(loc="lower left")


def plot_mac(
    path: Path,
    tables: Sequence[tuple[str, Vector, Sequence[float], Sequence[float]]],
    caption: str,
) -> None:
    """Write a picture of several MAC matrices.

    Args:
        tables: title, matrix, and the frequencies of its rows and columns [Hz].
    """
    with saved_figure(path, (4.9 * len(tables) + 1.0, 5.4), "Modal assurance criterion", caption) as figure:
        axes = figure.subplots(1, len(tables), squeeze=False)[0]
        for axis, (title, table, rows, columns) in zip(axes, tables, strict=True):
            picture = axis.imshow(table, cmap="viridis", vmin=0.0, vmax=1.0, aspect="auto")
            axis.grid(False)
            axis.set_title(title)
            axis.set_yticks(range(len(rows)), [f"{value:.1f}" for value in rows], fontsize=7)
            axis.set_xticks(range(len(columns)), [f"{value:.1f}" for value in columns], rotation=90, fontsize=7)
            axis.set(xlabel="frequency [Hz]", ylabel="frequency [Hz]")
        figure.colorbar(picture, ax=axes.tolist(), label="MAC [-]", shrink=0.8)
