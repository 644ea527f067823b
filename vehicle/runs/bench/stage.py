"""The moving car in the browser: shapes of its parts, and the wireframe of its body in colours of the displacement."""

from __future__ import annotations

import threading
import time as clock
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.stage import HIDDEN, OPACITY
from vehicle.drawing.rendering.wireframe import GROUPS, car_wireframe
from vehicle.model.assembly.visuals import visible_shapes
from vehicle.runs.bench.motion import RATE, CarMotion
from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]

FRAMES = 25.0
"""Frames a second."""

SLOWER, LARGER = 20.0, 60.0
"""Default slow motion and exaggeration."""


class Stage:
    """Scene of a car on a viser server.

    Args:
        server: viser server.
        car: the car; the shapes of its variants are the same.

    Attributes:
        slower: the motion is shown this many times slower.
        larger: the motion is shown this many times larger.
        playing: False for a still picture.
        frames: number of frames sent.
    """

    def __init__(self, server: Any, car: Car) -> None:
        self.server = server
        self.slower, self.larger, self.playing = SLOWER, LARGER, True
        self.frames = 0
        self._motion: CarMotion | None = None
        self._top = 1.0
        self._ended = threading.Event()
        matrices, wire = car.matrices, car_wireframe(car.model)
        used = np.unique(wire.lines[wire.groups == GROUPS.index("body")])
        self._segments = np.searchsorted(used, wire.lines[wire.groups == GROUPS.index("body")])
        self._nodes = wire.points[used]
        self.bodies = tuple(matrices.body_rows)
        self.centres = np.array([matrices.body_centres[name] for name in self.bodies])
        self._rows = np.vstack([*matrices.body_rows.values(), wire.motion[used].reshape(-1, wire.motion.shape[2])])
        self._build(car)
        self._thread = threading.Thread(target=self._play, name="bench stage", daemon=True)
        self._thread.start()

    def _build(self, car: Car) -> None:
        """Add the shapes, each in the frame of its part, and the wireframe."""
        scene = self.server.scene
        scene.set_up_direction("+z")
        low, high = self._nodes.min(axis=0), self._nodes.max(axis=0)
        middle, length = 0.5 * (low + high), float(high[0] - low[0])
        camera = self.server.initial_camera
        camera.position = tuple(float(x) for x in middle + length * np.array([-0.55, 0.85, 0.45]))
        camera.look_at = tuple(float(x) for x in middle - [0.0, 0.0, 0.1 * length])
        self._frames = {
            name: scene.add_frame(f"/{name}", show_axes=False, position=centre)
            for name, centre in zip(self.bodies, self.centres, strict=True)
        }
        self._plates = {wheel: scene.add_frame(f"/plate_{wheel}", show_axes=False) for wheel in car.vehicle.wheels}
        centres = dict(zip(self.bodies, self.centres, strict=True))
        for name, shape in visible_shapes(car.vehicle).items():
            if name in HIDDEN:
                continue
            opacity = OPACITY.get(name, 1.0) * shape.rgba[3]
            moving = shape.part in centres or shape.part.removeprefix("plate_") in self._plates
            scene.add_mesh_simple(
                f"/{shape.part}/{name}" if moving else f"/still/{name}",
                np.asarray(shape.mesh.vertices - centres.get(shape.part, 0.0), dtype=np.float32),
                np.asarray(shape.mesh.faces, dtype=np.uint32),
                color=tuple(int(255 * part) for part in shape.rgba[:3]),
                opacity=None if opacity >= 1.0 else opacity,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            )
        if len(self._segments):
            self._lines = scene.add_line_segments(
                "/wireframe",
                self._nodes[self._segments].astype(np.float32),
                np.zeros((*self._segments.shape, 3), dtype=np.uint8),
                thickness=3.0,
                thickness_units="screen",
            )

    def show(self, motion: CarMotion) -> None:
        """Show another motion from now on; the top of the colours is the largest displacement of the body in it."""
        nodes = (self._rows[6 * len(self.bodies) :] @ motion.coordinates).reshape(-1, 3, motion.coordinates.shape[1])
        self._top = max(float(np.linalg.norm(nodes, axis=1).max(initial=0.0)), 1e-9)
        self._motion = motion

    def frame(self, motion: CarMotion, time: float) -> None:
        """Send the picture of an instant.

        Args:
            motion: the motion.
            time: time in the motion [s]; it repeats.
        """
        samples = motion.coordinates.shape[1] - 1
        index, share = divmod((time * RATE) % samples, 1.0)
        first, factor = int(index), self.larger

        def at(values: Vector) -> Vector:
            return np.asarray((1.0 - share) * values[..., first] + share * values[..., first + 1])

        moved = factor * (self._rows @ at(motion.coordinates))
        parts = moved[: 6 * len(self.bodies)].reshape(-1, 2, 3)
        nodes = moved[6 * len(self.bodies) :].reshape(-1, 3)
        turns = scipy.spatial.transform.Rotation.from_rotvec(parts[:, 1]).as_quat(scalar_first=True)
        with self.server.atomic():
            for name, position, turn in zip(self.bodies, self.centres + parts[:, 0], turns, strict=True):
                self._frames[name].position = position
                self._frames[name].wxyz = turn
            for wheel, frame in self._plates.items():
                frame.position = (0.0, 0.0, factor * float(at(motion.plates[wheel])))
            if len(self._segments):
                shades = (255.0 * colours(np.linalg.norm(nodes, axis=1), factor * self._top)[:, :3]).astype(np.uint8)
                self._lines.points = (self._nodes + nodes)[self._segments].astype(np.float32)
                self._lines.colors = shades[self._segments]
        self.frames += 1

    def stop(self) -> None:
        """End the thread that sends frames."""
        self._ended.set()
        self._thread.join()

    def _play(self) -> None:
        time, last = 0.0, clock.monotonic()
        while not self._ended.wait(max(0.0, 1.0 / FRAMES - (clock.monotonic() - last))):
            now = clock.monotonic()
            time, last = time + (now - last) / self.slower, now
            motion = self._motion
            if motion is not None and self.playing and self.server.get_clients():
                self.frame(motion, time)
