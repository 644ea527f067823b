"""Car on a viser server: shapes of its parts, springs between their seats, and the wireframe of its body."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.motion import coil_seats
from vehicle.drawing.rendering.recorded_run import hub_of
from vehicle.drawing.rendering.stage import OPACITY, shapes_of
from vehicle.drawing.rendering.wireframe import GROUPS, CarWireframe, car_wireframe
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.handover.bench.motion import CarMotion, CarPose
from vehicle.model.parameters.composition import Composition, PlacedSpring, PlacedWheel
from vehicle.model.shapes.shape import Shape
from vehicle.runs.car import Car
from vehicle.signals.analysis.samples import Vector


class CarScene:
    """Nodes of a car in the scene of a viser server; each part has a frame at its centre of gravity.

    With rolling tyres the tyre moves with its hub, and the rim rotates in it: exaggerated spin would turn the flat of
    the tyre (`vehicle.drawing.rendering.rolling`).

    Args:
        server: viser server.
        rig: draw plates, shakers and stands.
    """

    wire: CarWireframe  # points and lines of the car

    def __init__(self, server: Any, car: Car, *, rig: bool) -> None:
        self.server, self.rig = server, rig
        self._car: Car | None = None
        self._known: dict[str, Any] = {}
        self._meshes: dict[str, tuple[Any, npt.NDArray[np.float32]]] = {}
        self.update(car)

    def update(self, car: Car) -> bool:
        """Show another car with the same parts; only shapes that differ are sent.

        Returns:
            True if its geometry differs from the last car.
        """
        if car.geometry is self._car:
            return False
        self._car = car.geometry
        composition, driving = self._car.vehicle.composition, self._car.vehicle.driving
        wheels = composition.wheels if driving.rolling else ()
        shapes = shapes_of(self._car.model, rig=self.rig)
        self.wire = car_wireframe(self._car.model)
        self._place(self._car.matrices, composition, wheels)
        self._spin = {wheel.part: -driving.speed / (wheel.center[2] - wheel.patch[2]) for wheel in wheels}
        springs = {spring.name: spring for spring in composition.springs if spring.name in shapes}
        with self.server.atomic():
            drawn = {shape.part for shape in shapes.values()}
            self._frames = {name: self._frame(name) for name in self._index if name in drawn}
            self._plates = {wheel: self._frame(f"plate_{wheel}") for wheel in self._car.vehicle.wheels if self.rig}
            self._rims = {part: self._frame(f"{part}/rim") for part in self._spin}
            for name, shape in shapes.items():
                self._mesh(name, shape)
            self._coils = {name: self._coil(composition, spring) for name, spring in springs.items()}
            self._wireframe()
        return True

    def _place(self, matrices: CarMatrices, composition: Composition, wheels: Sequence[PlacedWheel]) -> None:
        """Set the rows of translation and rotation of each part, and of the translation of each node of the body."""
        rows, centres = dict(matrices.body_rows), dict(matrices.body_centres)
        for wheel in wheels:
            hub = hub_of(composition, wheel.name)
            arm = np.array(wheel.center) - centres[hub]
            # u = u_hub + theta x arm
            rows[wheel.part] = np.vstack([rows[hub][:3] - np.cross(arm, rows[hub][3:], axis=0), rows[hub][3:]])
            centres[wheel.part] = np.array(wheel.center)
        self._index = {name: index for index, name in enumerate(rows)}
        self._centres = np.array([centres[name] for name in rows])
        lines = self.wire.lines[self.wire.groups == GROUPS.index("body")]
        used = np.unique(lines)
        self._segments, self._nodes = np.searchsorted(used, lines), self.wire.points[used]
        self._rows = np.vstack([*rows.values(), self.wire.motion[used].reshape(-1, self.wire.motion.shape[2])])

    def _frame(self, name: str) -> Any:
        """Return the frame of a part, added at its first use."""
        if name not in self._known:
            self._known[name] = self.server.scene.add_frame(f"/{name}", show_axes=False)
        return self._known[name]

    def _mesh(self, name: str, shape: Shape) -> None:
        """Add or replace a mesh, in the frame of its part, if it differs from the mesh of this name."""
        centre, parent = np.zeros(3), "still"
        if shape.part in self._index:
            centre, parent = self._centres[self._index[shape.part]], shape.part
            parent += "/rim" if shape.part in self._spin and name != shape.part else ""
        elif shape.part.removeprefix("plate_") in self._plates:
            parent = shape.part
        vertices = np.asarray(shape.mesh.vertices - centre, dtype=np.float32)
        if name in self._meshes and np.array_equal(self._meshes[name][1], vertices):
            return
        opacity = OPACITY.get(name, 1.0) * shape.rgba[3]
        handle = self.server.scene.add_mesh_simple(
            f"/{parent}/{name}",
            vertices,
            np.asarray(shape.mesh.faces, dtype=np.uint32),
            color=tuple(int(255 * part) for part in shape.rgba[:3]),
            opacity=None if opacity >= 1.0 else opacity,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )
        self._meshes[name] = handle, vertices

    def _coil(self, composition: Composition, spring: PlacedSpring) -> tuple[Vector, Vector, list[int]]:
        """Return the vertices of a spring in the design position, their share of its height, and its seats."""
        vertices = self._meshes[spring.name][1].astype(float)
        axis = np.subtract(spring.at[1], spring.at[0])
        height = vertices @ (axis / np.linalg.norm(axis))
        seats = [self._index[part] for part in coil_seats(composition, spring)]
        return vertices, ((height - height.min()) / np.ptp(height))[:, None], seats

    def _wireframe(self) -> None:
        """Add or replace the wireframe of the body."""
        self._lines = self.server.scene.add_line_segments(
            "/wireframe",
            self._nodes[self._segments].astype(np.float32).reshape(-1, 2, 3),
            np.zeros((len(self._segments), 2, 3), dtype=np.uint8),
            thickness=3.0,
            thickness_units="screen",
        )

    @property
    def extent(self) -> tuple[Vector, Vector]:
        """Return the lowest and highest coordinates of the wireframe of the body [m]; of the whole car without one."""
        nodes = self._nodes if len(self._nodes) else self.wire.points
        return nodes.min(axis=0), nodes.max(axis=0)

    def largest(self, motion: CarMotion) -> tuple[float, float]:
        """Return the largest displacement in a motion [m]: of the body, and of the body and all parts."""
        moved = (self._rows @ motion.coordinates).reshape(-1, 3, motion.coordinates.shape[1])
        size = np.linalg.norm(moved, axis=1).max(axis=1)
        parts, nodes = size[: 2 * len(self._centres) : 2], size[2 * len(self._centres) :]
        body = float(nodes.max(initial=0.0)) or float(parts[0])
        return max(body, 1e-9), max(float(parts.max()), body, 1e-9)

    def pose(self, pose: CarPose, factor: float, top: float) -> None:
        """Send the picture of an instant.

        Args:
            factor: exaggeration of the motion.
            top: displacement of the body at the end of the colours [m].
        """
        moved = factor * (self._rows @ pose.coordinates)
        parts, nodes = moved[: 6 * len(self._centres)].reshape(-1, 2, 3), moved[6 * len(self._centres) :].reshape(-1, 3)
        positions, rotations = self._centres + parts[:, 0], Rotation.from_rotvec(parts[:, 1])
        turns, frames = rotations.as_quat(scalar_first=True), rotations.as_matrix()
        for name, frame in self._frames.items():
            frame.position, frame.wxyz = positions[self._index[name]], turns[self._index[name]]
        for wheel, frame in self._plates.items():
            frame.position = (0.0, 0.0, factor * pose.plates.get(wheel, 0.0))
        for part, rate in self._spin.items():
            half = 0.5 * rate * pose.time
            self._rims[part].wxyz = (np.cos(half), 0.0, np.sin(half), 0.0)
        for name, (vertices, share, seats) in self._coils.items():
            low, high = (positions[seat] + (vertices - self._centres[seat]) @ frames[seat].T for seat in seats)
            self._meshes[name][0].vertices = ((1.0 - share) * low + share * high).astype(np.float32)
        if len(self._segments):
            shades = (255.0 * colours(np.linalg.norm(nodes, axis=1), factor * top)[:, :3]).astype(np.uint8)
            self._lines.points = (self._nodes + nodes)[self._segments].astype(np.float32)
            self._lines.colors = shades[self._segments]
