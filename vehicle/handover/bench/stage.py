"""Moving picture of the bench: a car on its rig or its road in a run, or in a mode."""

import threading
import time as clock
from typing import Any

import numpy as np

from vehicle.drawing.rendering.excerpt import FPS
from vehicle.drawing.rendering.mode_motion import EXAGGERATION, PERIOD
from vehicle.drawing.rendering.rounding import round_factor
from vehicle.drawing.rendering.scene import LARGEST_FACTOR, VISIBLE_TRAVEL
from vehicle.handover.bench.car_scene import CarScene
from vehicle.handover.bench.drive import BenchDrive
from vehicle.handover.bench.motion import SECONDS, CarMotion
from vehicle.handover.bench.road_scene import RoadScene
from vehicle.runs.car import Car

FRAMES = 25.0
"""Frames a second."""

SLOWER = 20.0
"""Default slow motion of a run."""

CYCLE = PERIOD / FPS
"""Shown time of a cycle of a mode [s], as in a film of a mode."""

LARGER = EXAGGERATION
"""Default exaggeration of a mode, whose farthest point moves 1 mm."""


class Stage:
    """Scene of a car on a viser server.

    Attributes:
        car_scene: nodes of the car.
        slower: the motion is shown this many times slower.
        larger: the motion is shown this many times larger.
        playing: False for a still picture.
        frames: number of frames sent.
    """

    def __init__(self, server: Any, car: Car, drive: BenchDrive) -> None:
        self.server = server
        self.slower, self.larger, self.playing = SLOWER, 1.0, True
        self.frames = 0
        server.scene.set_up_direction("+z")
        self.car_scene = CarScene(server, car, rig=drive.road is None)
        self.road_scene: RoadScene | None = None
        self._drive = drive
        self._place_road(car, drive)
        self._place_camera()
        self._shown: tuple[CarMotion, float] | None = None
        self._lock, self._ended = threading.Lock(), threading.Event()
        self._thread = threading.Thread(target=self._play, name="bench stage", daemon=True)
        self._thread.start()

    def _place_road(self, car: Car, drive: BenchDrive) -> None:
        """Draw the road of a drive below the wheels of a car."""
        if drive.speed is not None:
            span = drive.shown, min(drive.shown + SECONDS, drive.record.duration)
            self.road_scene = RoadScene(self.server, car.vehicle.composition.wheels, drive.record, drive.speed, span)

    def _place_camera(self) -> None:
        """Place the camera of a new window on the front right of the car."""
        low, high = self.car_scene.extent
        middle, length = 0.5 * (low + high), float(high[0] - low[0])
        camera = self.server.initial_camera
        camera.position = tuple(float(x) for x in middle + length * np.array([-0.55, 0.85, 0.45]))
        camera.look_at = tuple(float(x) for x in middle - [0.0, 0.0, 0.1 * length])

    def show(self, car: Car, motion: CarMotion, *, slower: float, larger: float | None = None) -> float:
        """Show a motion from now on; the colours end at the largest displacement of the body in it.

        Args:
            car: the car; other parts are drawn again where their shape differs.
            slower: slow motion.
            larger: exaggeration; by default the largest displacement is drawn as 5 to 8 cm.

        Returns:
            The exaggeration.
        """
        with self._lock:
            if self.car_scene.update(car) and (drive := self._drive.under(car)) is not self._drive:
                self._drive = drive
                self._place_road(car, drive)
            body, largest = self.car_scene.largest(motion)
            if larger is None:
                larger = round_factor(min(VISIBLE_TRAVEL / largest, LARGEST_FACTOR))
            self.slower, self.larger = slower, larger
            self._shown = motion, body
            if self.road_scene is not None:
                self.road_scene.show(motion.on_road)
        return larger

    def frame(self, time: float) -> None:
        """Send the picture of an instant of the motion.

        Args:
            time: time after the begin of the motion [s]; it repeats.
        """
        with self._lock:
            if self._shown is None:
                return
            (motion, top), factor = self._shown, self.larger
            pose = motion.pose(time)
            with self.server.atomic():
                self.car_scene.pose(pose, factor, top)
                if self.road_scene is not None and motion.on_road:
                    self.road_scene.move(pose.time, factor)
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
            if self.playing and self.server.get_clients():
                self.frame(time)
