"""Road under the wheels: a strip for each track, whose height is the profile of the road, or the plate displacement.

A wheel at x0 over the height z(t) of the road reaches at the time t the point of the road that is at x at the time
t + (x0 - x) / V, so

    h(x, t) = z(t + (x0 - x) / V),    x to the rear,

and every following wheel has the same road. Outside the record the road is level.
"""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from vehicle.drawing.rendering.added_geom import add_geom
from vehicle.engines.simulation.recording import Recording
from vehicle.model.parameters.composition import PlacedWheel
from vehicle.signals.analysis.samples import Vector

PIECE, PARTS = 0.05, 4
"""Length of a straight segment of the strip [m], and number of parts of a segment whose road is not straight."""

STRAIGHT = 2e-4
"""Maximum deviation of the road from a straight segment [m]."""

REACH = 1.3
"""Length of the strip in front of the first and after the last wheel [m]."""

HALF_WIDTH, THICKNESS = 0.15, 0.03
"""Half width and thickness of the strip [m]."""

COLOURS = np.array([(0.20, 0.21, 0.22, 1.0), (0.47, 0.48, 0.49, 1.0)], dtype=np.float32)
"""Alternating colours of the stripes across the strip, which show its motion."""

SHORTEST_STRIPE = 0.25
"""Minimum length of a stripe [m]."""


class RoadStrip:
    """Road strips under the tracks of a car.

    Args:
        recording: recording with the displacement of every plate.
        speed: speed of the car [m/s].
        interval: time between two frames [s], which determines the length of a stripe.
        profile: times [s], and heights of the road itself by wheel [m], in place of the plates.
    """

    def __init__(
        self,
        wheels: Sequence[PlacedWheel],
        recording: Recording,
        speed: float,
        interval: float,
        profile: tuple[Vector, Mapping[str, Vector]] | None = None,
    ) -> None:
        self.time, self.speed = recording.time, speed
        self.stripe = max(SHORTEST_STRIPE, np.ceil(8.0 * speed * interval) / 4.0)
        positions = [wheel.patch[0] for wheel in wheels]
        self.ends = min(positions) - REACH, max(positions) + REACH
        self.leaders = [
            min((wheel for wheel in wheels if wheel.side == side), key=lambda wheel: wheel.patch[0])
            for side in sorted({wheel.side for wheel in wheels})
        ]
        step = recording.timestep
        self.integrals: list[tuple[Vector, Vector]] = []
        for wheel in self.leaders:
            if profile is None:
                height = recording[f"plate_{wheel.name}_displacement"]
            else:
                height = np.interp(recording.time, profile[0], profile[1][wheel.name])
            # Integral of the height over time, by trapezia: a mean over an exposure is a difference of two values.
            means = 0.5 * step * (height[1:] + height[:-1])
            self.integrals.append((height, np.concatenate([[0.0], np.cumsum(means)])))

    def height(self, track: int, x: Vector, time: float, exposure: float) -> Vector:
        """Return the true height of the road [m] at positions x [m], averaged over an exposure [s] about a time [s]."""
        height, integral = self.integrals[track]
        away = self.leaders[track].patch[0] - x
        at = time + (away / self.speed if self.speed else np.zeros_like(away))  # at rest all see the same height

        def total(when: Vector) -> Vector:
            inside = np.clip(when, self.time[0], self.time[-1])
            # Beyond the record the height stays, so its integral is a line.
            level = np.where(when > self.time[-1], height[-1], height[0])
            return np.asarray(np.interp(inside, self.time, integral) + level * (when - inside))

        exposure = max(exposure, self.time[1] - self.time[0])
        return (total(at + 0.5 * exposure) - total(at - 0.5 * exposure)) / exposure

    def draw(self, scene: mujoco.MjvScene, time: float, exposure: float, factor: float) -> None:
        """Append the strips to a scene, with heights exaggerated like all motion.

        Args:
            time: time [s].
            exposure: exposure time of the frame [s].
            factor: exaggeration.
        """
        for track, wheel in enumerate(self.leaders):
            # Segment ends move with the road to the rear.
            moved = self.speed * time
            first, last = (int(np.floor((end - moved) / PIECE)) for end in self.ends)
            numbers = np.arange(first, last + 1.0 / PARTS, 1.0 / PARTS)
            height = self.height(track, np.asarray(numbers * PIECE + moved, dtype=np.float64), time, exposure)
            # A segment keeps its inner points only if one of them is off its chord.
            straight = np.interp(numbers, numbers[::PARTS], height[::PARTS])
            bent = np.abs(height - straight)[:-1].reshape(-1, PARTS).max(axis=1) > STRAIGHT
            kept = np.append(np.repeat(bent, PARTS), True)
            kept[::PARTS] = True
            numbers, height = numbers[kept], height[kept]
            x, z = np.asarray(numbers * PIECE + moved, dtype=np.float64), wheel.patch[2] + factor * height
            shades = COLOURS[np.floor(numbers[:-1] * PIECE / self.stripe + 1e-9).astype(int) % 2]
            for number, shade in enumerate(shades):
                rise = np.array([x[number + 1] - x[number], 0.0, z[number + 1] - z[number]])
                length = np.linalg.norm(rise)
                along = rise / length
                across, up = np.array([0.0, 1.0, 0.0]), np.array([-along[2], 0.0, along[0]])
                middle = np.array([x[number], wheel.patch[1], z[number]]) + 0.5 * rise - 0.5 * THICKNESS * up
                size = np.array([0.5 * length, HALF_WIDTH, 0.5 * THICKNESS])
                frame = np.column_stack([along, across, up]).ravel()
                add_geom(scene, mujoco.mjtGeom.mjGEOM_BOX, size, middle, shade, frame)
