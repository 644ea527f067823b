"""Car of a run in an excerpt of its record: the motion in each frame, forces, road and states of the dampers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager

import mujoco
import numpy as np

from vehicle.drawing.rendering.body_wireframe import Wireframe
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.drawing import Drawing
from vehicle.drawing.rendering.excerpt import FPS, Excerpt
from vehicle.drawing.rendering.force_arrows import ForceArrows
from vehicle.drawing.rendering.motion import Motion, RecordedMotion
from vehicle.drawing.rendering.recorded_run import RecordedRun, dampers_of, hub_of, wheels_of
from vehicle.drawing.rendering.road_strip import RoadStrip
from vehicle.drawing.rendering.rolling import RollingWheel
from vehicle.drawing.rendering.rounding import round_factor
from vehicle.names import side_of, slip_words
from vehicle.signals.analysis.samples import Vector

View = tuple[mujoco.MjvCamera, tuple[int, int, int, int], Vector]
"""Camera, viewport (see `Canvas.render`) and opacity of all materials."""

VISIBLE_TRAVEL = 0.08
"""Travel [m] to which the largest displacement of the excerpt is exaggerated."""

LARGEST_FACTOR = 1000.0
"""Maximum automatic exaggeration."""

AT_REST = 1e-6
"""Maximum displacement of a car at rest [m], which is not exaggerated; static equilibrium is exact to 1e-9 m, rounding
is below that."""


def frames_of(excerpt: Excerpt) -> tuple[int, float]:
    """Return the number of frames of an excerpt, and the time of the record between two frames [s]."""
    return max(int(excerpt.length * excerpt.slow * FPS + 1e-9), 1), 1.0 / (FPS * excerpt.slow)


class Scene:
    """Car of a run in an excerpt of its record.

    Args:
        run: the run.
        size: width and height of its picture [pixel].
        excerpt: the excerpt.
        speed, profile: speed on the road and the road itself, see `Take`; None on a rig.

    Attributes:
        states: motion in each frame.
        slip: wheel of each damper to its slip velocity [m/s].
        largest: largest displacement of a wheel, a plate or a node of the body [m].
        node: 97 % quantile of the displacements of the nodes [m].
    """

    def __init__(
        self,
        run: RecordedRun,
        size: tuple[int, int],
        excerpt: Excerpt,
        speed: float | None = None,
        profile: tuple[Vector, Mapping[str, Vector]] | None = None,
    ) -> None:
        # Attributes must be picklable for other processes, so they contain no model specification; there, drawing
        # imports no shapes.
        from vehicle.drawing.rendering.stage import stage_model, unveiled

        self.recording, self.vehicle, self.wheel, self.size = run.recording, run.car.model.vehicle, run.wheel, size
        self.composition = self.vehicle.composition
        self.wheels, dampers = wheels_of(self.recording), dampers_of(self.recording)
        limits = self.vehicle.slip_velocities
        self.slip = {wheel: limits[wheel] for wheel in dampers}
        # A damper without friction neither sticks nor slips.
        rubbing = {damper.name for damper in self.composition.dampers if damper.law.static_friction > 0.0}
        self.dampers = [wheel for wheel in dampers if f"damper_{wheel}" in rubbing]
        self.model = stage_model(run.car.model, size, road=speed is not None)
        self.opacity = self.model.mat_rgba[:, 3].copy()  # drawing changes the values of the model
        self.unveiled = unveiled(self.model)
        self.motion = Motion(self.model)
        self.wireframe = Wireframe(run.car.model, self.motion)
        start, end = excerpt.start, excerpt.start + excerpt.length
        frames, self.interval = frames_of(excerpt)
        recorded = RecordedMotion(self.model, self.recording, start, end)
        self.times = [start + number * self.interval for number in range(frames)]
        self.states = [recorded.at(time, self.interval) for time in self.times]
        self.largest, self.node = self._largest()
        self.arrows = ForceArrows(self.motion, self.composition, self.recording, start, end)
        self.road = None
        if speed is not None:
            self.road = RoadStrip(self.composition.wheels, self.recording, speed, self.interval, profile)

    def _largest(self) -> tuple[float, float]:
        """Return the attributes `largest` and `node`."""
        part_displacements, node_displacements = [], []
        bodies = [(hub_of(self.composition, wheel.name), wheel.plate) for wheel in self.composition.wheels]
        moving = [int(self.model.body(name).id) for pair in bodies for name in pair]
        for state in self.states:
            part_displacements.append(np.linalg.norm(state.translation[moving], axis=1))
            node_displacements.append(self.wireframe.displacement(state))
        largest = max(float(np.max(part_displacements)), float(np.max(node_displacements)))
        return largest, float(np.quantile(node_displacements, 0.97))

    def lamps(self, time: float) -> dict[str, bool]:
        """Label of each damper, and whether it slipped at any sample of the time between two frames."""
        recording = self.recording
        half = max(0.5 * self.interval, 0.5 * recording.timestep)
        first, last = np.searchsorted(recording.time, [time - half, time + half])
        part = slice(int(first), max(int(last), int(first) + 1))
        speeds = {wheel: recording[f"damper_{wheel}_velocity"][part] for wheel in self.dampers}
        return {
            f"damper {side_of(wheel, self.wheels)}": bool(np.any(np.abs(speed) > self.slip[wheel]))
            for wheel, speed in speeds.items()
        }

    @property
    def slip_text(self) -> str:
        """Return the slip velocities of the dampers with a lamp [mm/s], see `slip_words`; empty without a lamp."""
        return slip_words({wheel: self.slip[wheel] for wheel in self.dampers}, self.wheels)

    @contextmanager
    def opened(self, backend: str, factor: float, scale_top: float) -> Iterator[OpenScene]:
        """Open a canvas and yield the scene on it.

        Args:
            backend: OpenGL backend, one of `BACKENDS`.
            factor: exaggeration of all motion.
            scale_top: displacement at the top of the colour scale [m].
        """
        with closing(Canvas(self.model, self.size, backend)) as canvas:
            yield OpenScene(self, canvas, factor, scale_top)


class OpenScene:
    """Scene on a canvas; made by `Scene.opened`."""

    def __init__(self, scene: Scene, canvas: Canvas, factor: float, scale_top: float) -> None:
        self.scene, self.canvas, self.factor = scene, canvas, factor
        composition, motion = scene.composition, scene.motion
        self.drawing = Drawing(canvas, motion, scene.wireframe, composition, scale_top)
        self.wheels = [
            RollingWheel(motion, wheel, hub_of(composition, wheel.name), scene.vehicle.driving.speed)
            for wheel in composition.wheels
        ]

    def draw(self, number: int, views: Sequence[View]) -> None:
        """Draw the views of a frame on the canvas."""
        scene, canvas = self.scene, self.canvas
        state, time = scene.states[number], scene.times[number]
        canvas.gl.make_current()  # another scene has another context
        self.drawing.pose(state, self.factor)
        for wheel in self.wheels:
            wheel.turn(self.drawing.data, state, self.factor, time)
        for camera, viewport, opacity in views:
            self.drawing.see(camera, opacity)
            if scene.road is not None:
                scene.road.draw(canvas.scene, time, scene.interval, self.factor)
            scene.arrows.draw(canvas.scene, state, self.factor, time, scene.interval)
            canvas.render(viewport)


def exaggeration_of(largest: float, asked: float | None) -> float:
    """Return the factor of all motion: as asked, or so that the largest displacement [m] is visible."""
    if asked is not None:
        return asked
    return 1.0 if largest < AT_REST else round_factor(min(VISIBLE_TRAVEL / largest, LARGEST_FACTOR))
