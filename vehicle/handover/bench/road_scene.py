"""Road on a viser server: a strip for each track with the heights of the road itself, which moves below the car.

The foremost wheel of a track, at x0, is at the time t over the point of the road that it reaches then. In the frame of
the road, which moves by V t to the rear, the road is at rest,

    x = x0 - V tau,    z = z0 + h(tau),

with the height h below the wheel at the time tau of the record, as in `vehicle.drawing.rendering.road_strip`.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.road_strip import COLOURS, HALF_WIDTH, REACH
from vehicle.model.parameters.composition import PlacedWheel
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.signal import Signal

STRIPE = 0.5
"""Length of a stripe [m]."""

THICKNESS = 0.01
"""Thickness of the strip at the lowest point of the road [m], exaggerated like the heights."""


class RoadScene:
    """Nodes of a road in the scene of a viser server.

    Args:
        server: viser server.
        wheels: wheels of the car.
        record: input of the run with the profile of the road.
        speed: speed of the car [m/s].
        span: begin and end of the shown times [s].
    """

    def __init__(
        self, server: Any, wheels: tuple[PlacedWheel, ...], record: Signal, speed: float, span: tuple[float, float]
    ) -> None:
        self.speed = speed
        self._frame = server.scene.add_frame("/road", show_axes=False)
        self._meshes: list[Any] = []
        self._factor = 1.0
        length = max(wheel.patch[0] for wheel in wheels) - min(wheel.patch[0] for wheel in wheels)
        begin, end = span[0] - (length + REACH) / speed, span[1] + REACH / speed
        profiles = record.profile or record.displacement
        for side in sorted({wheel.side for wheel in wheels}):
            leader = min((wheel for wheel in wheels if wheel.side == side), key=lambda wheel: wheel.patch[0])
            # Level before and after the record.
            times = np.unique(np.concatenate([[begin], np.clip(record.time, begin, end), [end]]))
            h = np.interp(times, record.time, profiles[leader.name])
            for shade, colour in enumerate(COLOURS):
                vertices, faces = strip(speed * times, h, shade)
                vertices[:, 0] = leader.patch[0] - vertices[:, 0]
                vertices[:, 1] += leader.patch[1]
                mesh = server.scene.add_mesh_simple(
                    f"/road/{leader.name}_{shade}",
                    vertices.astype(np.float32),
                    faces,
                    color=tuple(int(255 * part) for part in colour[:3]),
                    side="double",
                    flat_shading=True,
                    cast_shadow=False,
                    receive_shadow=False,
                    position=(0.0, 0.0, leader.patch[2]),
                )
                self._meshes.append(mesh)

    def show(self, visible: bool) -> None:
        """Show or hide the road."""
        self._frame.visible = visible

    def move(self, time: float, factor: float) -> None:
        """Move the road to a time [s] of the record; heights are exaggerated like all motion."""
        self._frame.position = (self.speed * time, 0.0, 0.0)
        if factor != self._factor:
            for mesh in self._meshes:
                mesh.scale = (1.0, 1.0, factor)
            self._factor = factor


def strip(distance: Vector, height: Vector, shade: int) -> tuple[Vector, npt.NDArray[np.uint32]]:
    """Return every second stripe of a strip with sides, as vertices (x, y, z) [m] and triangles.

    Args:
        distance: distances of the points of the road [m], increasing; (n,).
        height: their heights [m]; (n,).
        shade: 0 or 1: the stripes with an even or an odd number.
    """
    edges = np.arange(np.floor(distance[0] / STRIPE), np.ceil(distance[-1] / STRIPE) + 1.0) * STRIPE
    x = np.union1d(distance, np.clip(edges, distance[0], distance[-1]))
    z = np.interp(x, distance, height)
    low = np.full_like(z, z.min() - THICKNESS)
    sections = [(-HALF_WIDTH, low), (-HALF_WIDTH, z), (HALF_WIDTH, z), (HALF_WIDTH, low)]
    vertices = np.stack([np.column_stack([x, np.full_like(x, y), level]) for y, level in sections], axis=1)
    odd = np.floor(0.5 * (x[1:] + x[:-1]) / STRIPE).astype(int) % 2
    first = 4 * np.flatnonzero(odd == shade)[:, None] + np.arange(3)
    corners = np.stack([first, first + 1, first + 4, first + 4, first + 1, first + 5], axis=-1)
    used, faces = np.unique(corners.reshape(-1, 3), return_inverse=True)
    return vertices.reshape(-1, 3)[used], faces.reshape(-1, 3).astype(np.uint32)
