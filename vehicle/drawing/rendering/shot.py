"""Excerpt of a run, drawn frame by frame: the car, a close-up, and text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from vehicle.drawing.rendering.body_wireframe import Wireframe
from vehicle.drawing.rendering.cameras import close_up, whole_car
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.drawing import Drawing
from vehicle.drawing.rendering.excerpt import FPS, choose_excerpt
from vehicle.drawing.rendering.force_arrows import ForceArrows
from vehicle.drawing.rendering.layout import Layout, Picture
from vehicle.drawing.rendering.motion import Motion, RecordedMotion
from vehicle.drawing.rendering.overlay import Overlay
from vehicle.drawing.rendering.recorded_run import (
    RecordedRun,
    dampers_of,
    hub_channel,
    hub_of,
    level_words,
    wheels_of,
)
from vehicle.drawing.rendering.road_strip import RoadStrip
from vehicle.drawing.rendering.rolling import RollingWheel
from vehicle.drawing.rendering.rounding import round_factor, round_up
from vehicle.drawing.rendering.trace_strip import Trace, TraceStrip
from vehicle.errors import ConfigurationError
from vehicle.names import side_of
from vehicle.signals.analysis.samples import Vector

VISIBLE_TRAVEL = 0.08
"""Travel [m] to which the largest displacement of the excerpt is exaggerated."""

LARGEST_FACTOR = 1000.0
"""Maximum automatic exaggeration."""

AT_REST = 1e-6
"""Maximum displacement of a car at rest [m], which is not exaggerated; static equilibrium is exact to 1e-9 m, rounding
is below that."""

FASTEST_MOTION = 40.0
"""Maximum frequency [Hz] of visible motion; the heading of a film with fewer than two frames per period states it."""

VISIBLE_TIME = 2.0
"""Visible time of the traces in real time [s]; divided by the square root of the slow-motion factor otherwise."""

LEAST_ACCELERATION = 1e-3
"""Minimum end of the scale of an acceleration [m/s2]: a hundredth of what a person feels, so rounding stays a line."""

GHOST_OPACITY = 0.22
"""Opacity of the wheel in the close-up, where it would hide the strut."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Take:
    """Settings of a film.

    Raises:
        ConfigurationError: a number is out of range.
    """

    start: float | None = None
    """first time of the record [s]; by default, a single event or the window with the largest motion"""
    duration: float | None = None
    """length of the film [s], which shows duration / slow of the record at most; 10 s or a single event by default"""
    slow: float | None = None
    """slow-motion factor, at least 1; by default, real time for motion below 15 Hz (see `choose_excerpt`)"""
    exaggeration: float | None = None
    """factor of all motion; by default, the largest displacement becomes 5 to 8 cm"""
    speed: float | None = None
    """speed on the road [m/s], to draw the moving road; None on a rig"""
    profile: tuple[Vector, Mapping[str, Vector]] | None = None
    """times [s], and heights of the road itself by wheel [m]; by default, the road is drawn as the plates move"""

    def __post_init__(self) -> None:
        if self.duration is not None and not 0.0 < self.duration < np.inf:
            raise ConfigurationError(f"film, duration: found {self.duration:g} s, must be above 0 and finite")
        if self.slow is not None and not 1.0 <= self.slow < np.inf:
            raise ConfigurationError(f"film, slow motion: found {self.slow:g}, must be at least 1")
        if self.exaggeration is not None and not 0.0 < self.exaggeration < np.inf:
            raise ConfigurationError(f"film, exaggeration: found {self.exaggeration:g}, must be above 0 and finite")


@dataclass(frozen=True, kw_only=True, slots=True)
class Cut:
    """Excerpt of a record in a film."""

    start: float
    """first time [s]"""
    frames: int
    """number of frames"""
    interval: float
    """time of the record between two frames [s]"""
    exaggeration: float
    """factor of all motion"""
    reason: str
    """reason for the start"""

    @property
    def end(self) -> float:
        """Return the time of the last frame [s]."""
        return self.start + (self.frames - 1) * self.interval


class Shot:
    """Excerpt of a run for drawing frame by frame.

    Args:
        run: the run.
        layout: layout of the frame.
        take: settings of the film.

    Raises:
        ConfigurationError: the start is outside the record.
    """

    def __init__(self, run: RecordedRun, layout: Layout, take: Take) -> None:
        # Attributes must be picklable for other processes, so they contain no model specification; there, drawing
        # imports no shapes.
        from vehicle.drawing.rendering.stage import stage_model, unveiled

        recording, vehicle = run.recording, run.car.model.vehicle
        self.recording, self.vehicle, self.wheel = recording, vehicle, run.wheel
        self.layout, self.composition = layout, vehicle.composition
        self.wheels, self.dampers, self.hub = (
            wheels_of(recording),
            dampers_of(recording),
            hub_channel(vehicle.composition, run.wheel),
        )
        record = float(recording.time[-1])
        self.slip = vehicle.damper.slip_velocity if self.dampers else 0.0
        if take.start is not None and not 0.0 <= take.start < record:
            raise ConfigurationError(
                f"film, start: found {take.start:g} s, must be 0 to {record:g} s, within the record"
            )
        excerpt = choose_excerpt(
            recording, run.wheel, self.hub, self.slip, start=take.start, duration=take.duration, slow=take.slow
        )
        start, slow, interval = excerpt.start, excerpt.slow, 1.0 / (FPS * excerpt.slow)
        frames = max(int(excerpt.length * slow * FPS + 1e-9), 1)
        self.model = stage_model(run.car.model, (layout.width, layout.view_height), road=take.speed is not None)
        self.opacity = self.model.mat_rgba[:, 3].copy()  # drawing changes the values of the model
        self.unveiled = unveiled(self.model)
        self.motion = Motion(self.model)
        self.wireframe = Wireframe(run.car.model, self.motion)
        recorded = RecordedMotion(self.model, recording, start, start + excerpt.length)
        self.states = [recorded.at(start + number * interval, interval) for number in range(frames)]
        largest, node = self._largest()
        self.rests = largest < AT_REST
        chosen = 1.0 if self.rests else round_factor(min(VISIBLE_TRAVEL / largest, LARGEST_FACTOR))
        factor = chosen if take.exaggeration is None else take.exaggeration
        self.cut = Cut(start=start, frames=frames, interval=interval, exaggeration=factor, reason=excerpt.reason)
        self.arrows = ForceArrows(self.motion, self.composition, recording, start, start + excerpt.length)
        self.road = None
        if take.speed is not None:
            self.road = RoadStrip(self.composition.wheels, recording, take.speed, interval, take.profile)
        self.visible = VISIBLE_TIME / np.sqrt(slow)
        self.scale_top = 1e-3 * round_up(1e3 * max(node, AT_REST))
        self.overlay = Overlay(
            layout=layout,
            heading=self._heading(run, slow),
            scale_top=1e3 * self.scale_top,
            strip=TraceStrip(layout=layout, time=recording.time, traces=self._traces(), visible=self.visible),
        )

    def frames(self, backend: str, first: int = 0, every: int = 1) -> Iterator[Picture]:
        """Draw frames, (height, width, 3) each.

        Args:
            backend: OpenGL backend, one of `BACKENDS`.
            first, every: the first frame and the distance to the next; all by default.
        """
        layout, factor = self.layout, self.cut.exaggeration
        wheels = [
            RollingWheel(self.motion, wheel, hub_of(self.composition, wheel.name), self.vehicle.driving.speed)
            for wheel in self.composition.wheels
        ]
        views = self._views()
        with closing(Canvas(self.model, (layout.width, layout.view_height), backend)) as canvas:
            drawing = Drawing(canvas, self.motion, self.wireframe, self.composition, self.scale_top)
            for number in range(first, self.cut.frames, every):
                time = self.cut.start + number * self.cut.interval
                state = self.states[number]
                drawing.pose(state, factor)
                for wheel in wheels:
                    wheel.turn(drawing.data, state, factor, time)
                for camera, viewport, opacity in views:
                    drawing.see(camera, opacity)
                    if self.road is not None:
                        self.road.draw(canvas.scene, time, self.cut.interval, factor)
                    self.arrows.draw(canvas.scene, state, factor, time, self.cut.interval)
                    canvas.render(viewport)
                yield self.overlay.draw(canvas.read(), time, self._lamps(time))

    def _views(self) -> list[tuple[mujoco.MjvCamera, tuple[int, int, int, int], Vector]]:
        """Return camera, viewport and opacity of all materials of each view."""
        layout, wheel, model = self.layout, self.wheel, self.model
        cleared = self.unveiled.copy()
        rolling = next(placed.part for placed in self.composition.wheels if placed.name == wheel)
        cleared[model.geom_matid[model.geom_bodyid == model.body(rolling).id]] = GHOST_OPACITY
        right = (layout.main_width, 0, layout.width - layout.main_width, layout.view_height)
        return [
            (whole_car(self.vehicle), (0, 0, layout.main_width, layout.view_height), self.opacity),
            (close_up(self.motion, self.vehicle, wheel), right, cleared),
        ]

    def _largest(self) -> tuple[float, float]:
        """Return the largest displacement of a part or node, and the 97 % quantile of the node displacements [m]."""
        part_displacements, node_displacements = [], []
        bodies = [(hub_of(self.composition, wheel.name), wheel.plate) for wheel in self.composition.wheels]
        moving = [int(self.model.body(name).id) for pair in bodies for name in pair]
        for state in self.states:
            part_displacements.append(np.linalg.norm(state.translation[moving], axis=1))
            node_displacements.append(self.wireframe.displacement(state))
        largest = max(float(np.max(part_displacements)), float(np.max(node_displacements)))
        return largest, float(np.quantile(node_displacements, 0.97))

    def _heading(self, run: RecordedRun, slow: float) -> list[str]:
        """Return the heading: input and level, factors and excerpt."""
        cut = self.cut
        level = level_words(run.recording, run.wheel, run.signal.rms(run.wheel))
        wheel = run.car.model.vehicle.wheel_text(run.wheel, source=False)
        speed = "real time" if slow == 1.0 else f"slow motion 1 : {slow:g}"
        highest = 0.5 / cut.interval
        if highest < FASTEST_MOTION:
            speed += f" (faster than {highest:g} Hz averages out)"
        scale = f"exaggerated {cut.exaggeration:g} times" if cut.exaggeration != 1.0 else "true to scale"
        if self.rests:
            scale += " (at rest)"
        road, exaggerated = [], "motion"
        if self.road is not None:
            road = [
                f"road passes at {3.6 * self.road.speed:.4g} km/h, a stripe is {self.road.stripe:g} m long; "
                "heights in numbers: after averaging by the tyre"
            ]
            exaggerated = "motion and road"
        return [
            f"{Path(run.signal.source).name}: {level} under the {wheel}",
            f"{exaggerated} {scale}, {speed}",
            *road,
            f"excerpt from {cut.start:.2f} s ({cut.reason}); "
            f"{f'SLIP: above {1e3 * self.slip:g} mm/s; ' if self.dampers else ''}tyres {self.vehicle.driving.words}",
            *filter(None, [self.arrows.words]),
        ]

    def _traces(self) -> list[Trace]:
        """Return the curves below the picture (plate, seat rail, damper), scaled to their maxima in the shown time."""
        recording, wheel = self.recording, self.wheel
        ahead = 0.5 * self.visible
        inside = (recording.time >= self.cut.start - ahead) & (recording.time <= self.cut.end + ahead)
        traces = []
        input_label = "plate [mm]" if self.road is None else "effective road [mm]"
        for label, channel, scale, band, minimum in (
            (input_label, f"plate_{wheel}_displacement", 1e3, None, 1e3 * AT_REST),
            ("seat rail, vertical [m/s²]", "seat_rail_acc_z", 1.0, None, LEAST_ACCELERATION),
            (f"damper {side_of(wheel, self.wheels)} [mm/s]", f"damper_{wheel}_velocity", 1e3, 1e3 * self.slip, 0.0),
        ):
            if channel not in recording.channels:
                continue
            values = scale * recording[channel]
            top = round_up(max(float(np.max(np.abs(values[inside]))), 1.2 * (band or 0.0), minimum))
            traces.append(Trace(label=label, values=values, top=top, band=band))
        return traces

    def _lamps(self, time: float) -> dict[str, bool]:
        """Label of each damper, and whether it slipped at any sample of the time between two frames."""
        recording = self.recording
        half = max(0.5 * self.cut.interval, 0.5 * recording.timestep)
        first, last = np.searchsorted(recording.time, [time - half, time + half])
        part = slice(int(first), max(int(last), int(first) + 1))
        speeds = {wheel: recording[f"damper_{wheel}_velocity"][part] for wheel in self.dampers}
        return {
            f"damper {side_of(wheel, self.wheels)}": bool(np.any(np.abs(speed) > self.slip))
            for wheel, speed in speeds.items()
        }
