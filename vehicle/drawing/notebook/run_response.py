"""FRFs of a run with the names of their channels, and their display in a notebook."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from vehicle.drawing.notebook.frames import response_frame
from vehicle.drawing.notebook.picture import card, line_drawing
from vehicle.engines.simulation.recording import Recording
from vehicle.errors import DataError
from vehicle.signals.analysis.dependence import what_moves
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.input_floor import rounding_step
from vehicle.signals.analysis.motion_response import MotionResponse, motion_responses


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class RunResponse(FrequencyResponse):
    """FRFs of a run with channel names.

    Attributes:
        names: channels of the rows.
        plate: description of the input.
        car: car of the run, for the legend.
    """

    names: tuple[str, ...]
    plate: str
    car: str

    def __repr__(self) -> str:
        """Return a summary in one line."""
        shown = ", ".join(self.names[:3]) + (f" and {len(self.names) - 3} more" if len(self.names) > 3 else "")
        return (
            f"FRFs of {shown} from {self.plate}: {self.frequency.size} lines, {self.frequency[0]:g} to "
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
        label = f"{self.names[0]}, log magnitude against log frequency"
        return card("Frequency responses", rows, line_drawing(np.log10(self.frequency), level, label))

    def plot(self, ax: Any = None) -> Any:
        """Plot magnitude, phase and coherence of all rows.

        Args:
            ax: axes of the magnitude alone, or three axes of magnitude, phase and coherence; a new figure by default.

        Returns:
            The axes: one, or an array of three.
        """
        from vehicle.drawing.rendering.curves import draw_response
        from vehicle.drawing.rendering.open_axes import open_axes, plain

        rows = 3 if ax is None else len(np.ravel(np.array(ax, dtype=object)))
        look: dict[str, Any] = {"sharex": True, "height_ratios": (2.2, 1.0, 0.9)}
        title = f"Frequency responses from {self.plate}"
        axes = open_axes(ax, (8.0, 7.2), 3 if rows > 1 else 1, title=title, **look)
        draw_response(axes, self, [f"{self.car}: {name}" for name in self.names])
        return plain(axes)

    def to_dataframe(self) -> Any:
        """Return a pandas table; see `response_frame`. `attrs["input"]` contains the input."""
        frame = response_frame(self, self.names)
        frame.attrs["input"] = self.plate
        return frame


def require_moving(recording: Recording, wheel: str | None) -> None:
    """Raise a DataError if the plate of a wheel does not move."""
    moving = recording.excited
    if moving and wheel is not None and wheel not in moving:
        raise DataError(f"wheel {wheel}: its plate is at rest, so there is no FRF; choose from {', '.join(moving)}")


def of_wheel(
    all_responses: Sequence[MotionResponse], wheel: str | None, names: tuple[str, ...], car: str
) -> RunResponse:
    """Return the response to a wheel, by default to the first motion."""
    asked = all_responses[0].first if wheel is None else wheel
    chosen = next(number for number, group in enumerate(all_responses) if asked in group.motion)
    note = what_moves([group.motion for group in all_responses], chosen)
    response = all_responses[chosen].response
    moved = tuple(all_responses[chosen].motion)
    plate = f"plate_{moved[0]}_displacement" if len(moved) == 1 else f"the plates {', '.join(moved)} together"
    reasons = (*([note] if note else []), *response.reasons)
    values = {field.name: getattr(response, field.name) for field in fields(FrequencyResponse)}
    return RunResponse(**values | {"reasons": reasons}, names=names, plate=plate, car=car)


def responses(
    recording: Recording, signal: Any, names: tuple[str, ...], band: tuple[float, float], window: float | None
) -> tuple[MotionResponse, ...]:
    """Return the FRFs of a run to each independently moving plate.

    Args:
        recording, signal: recording and signal of the run.
        band: lowest and highest frequency [Hz].
        window: see `vehicle.runs.car.Run.frf`.

    Raises:
        DataError: no plate moves, or the record is too short.
        DependentInputsError: a plate repeats the motion of another plate with a delay.
    """
    moving = recording.excited
    if not moving:
        raise DataError(f"{signal.source}: no plate moves, so there is no FRF; give a signal that moves a plate")
    return motion_responses(
        recording.timestep,
        {wheel_name: recording[f"plate_{wheel_name}_displacement"] for wheel_name in moving},
        [recording[name] for name in names],
        names=names,
        band=band,
        rounding={wheel_name: rounding_step(signal.displacement[wheel_name]) for wheel_name in moving},
        window=window,
    )
