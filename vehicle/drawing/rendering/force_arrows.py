"""Arrows of forces on the car in a film: tyre forces without their static part, and damper forces.

An arrow is the force on the car, F / F_top * LENGTH long, with one scale for all arrows of a film. A frame shows the
mean over its time, as for the motion. The tyre pushes the wheel up; a damper in extension pulls the body down.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from vehicle.drawing.rendering.added_geom import add_geom
from vehicle.drawing.rendering.motion import Motion, State
from vehicle.drawing.rendering.recorded_run import hub_of
from vehicle.drawing.rendering.rounding import round_up
from vehicle.engines.simulation.recording import Recording
from vehicle.model.parameters.composition import Composition
from vehicle.signals.analysis.samples import Vector

LENGTH = 0.4
"""Length of an arrow of the largest force [m]."""

SHORTEST, WIDTH = 0.01, 0.018
"""Length below which an arrow is left out, and half width of an arrow [m]."""

SMALLEST_FORCE = 1.0
"""Largest force [N] of a film without arrows, for example with a car at rest."""

DRAWN = 0.5
"""Length of an arrow as MuJoCo draws it, over the distance of the points that `mjv_connector` connects."""

BESIDE_WHEEL, BESIDE_DAMPER = 0.16, 0.14
"""Distance of an arrow outwards from the centre of the wheel and the axis of the damper [m], so that it is seen."""

TYRE, DAMPER = (np.array(colour, dtype=np.float32) for colour in ((0.84, 0.37, 0.0, 1.0), (0.52, 0.20, 0.60, 1.0)))
"""Orange and purple: the colour-blind distinguish them, and the film has them only here."""

WORDS = "arrows: force on the car; orange: tyre, change from rest; purple: damper; {length:g} cm is {force:g} N"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Arrow:
    """Force at a point of a body.

    Attributes:
        body: index of the body that carries the point.
        point: position in the design position [m], (1, 3).
        direction: unit vector of a positive force, (3,).
        force: force over time [N].
        colour: red, green, blue, opacity.
    """

    body: int
    point: Vector
    direction: Vector
    force: Vector
    colour: np.ndarray


class ForceArrows:
    """Arrows of the recorded forces of tyres and dampers.

    Args:
        start, end: shown times [s]; the largest force between them has the length `LENGTH`.
    """

    def __init__(
        self, motion: Motion, composition: Composition, recording: Recording, start: float, end: float
    ) -> None:
        self.motion, self.time, model = motion, recording.time, motion.model
        self.arrows: list[Arrow] = []
        for wheel in composition.wheels:
            if (force := recording.channels.get(f"tyre_{wheel.name}_force_z")) is not None:
                point = np.add(wheel.center, (0.0, wheel.side * BESIDE_WHEEL, 0.0))
                body = int(model.body(hub_of(composition, wheel.name)).id)
                self._add(body, point, np.array([0.0, 0.0, 1.0]), force - force[0], TYRE)
        joints = {joint.name: (part, joint) for part in composition.parts for joint in part.joints}
        for damper in composition.dampers:
            if (force := recording.channels.get(f"{damper.name}_force")) is not None:
                part, joint = joints[damper.joint]
                # The axis of a strut may point down in a vehicle file; the arrow begins beside it, outside the car.
                upwards = np.multiply(joint.axis, np.copysign(1.0, joint.axis[2]) / np.linalg.norm(joint.axis))
                point = np.add(joint.at, (0.0, np.copysign(BESIDE_DAMPER, joint.at[1]), 0.0))
                self._add(int(model.body(part.name).id), point, upwards, -force, DAMPER)
        shown = slice(*np.searchsorted(self.time, [start, end]))
        peaks = [float(np.max(np.abs(arrow.force[shown]), initial=0.0)) for arrow in self.arrows]
        top = max(peaks, default=0.0)
        self.top = round_up(top) if top > SMALLEST_FORCE else 0.0

    def _add(self, body: int, point: Vector, direction: Vector, force: Vector, colour: np.ndarray) -> None:
        self.arrows.append(
            Arrow(body=body, point=point[None], direction=np.asarray(direction), force=force, colour=colour)
        )

    @property
    def words(self) -> str:
        """Return the line of the heading; empty for a film without arrows."""
        return WORDS.format(length=100.0 * LENGTH, force=self.top) if self.top else ""

    def vectors(self, time: float, exposure: float) -> list[Vector]:
        """Return the vector of each arrow [m] at a time [s], from the mean force over an exposure [s] about it."""
        first, last = np.searchsorted(self.time, [time - 0.5 * exposure, time + 0.5 * exposure])
        # At least one sample, also for a frame between two samples or after the last.
        part = slice(min(int(first), self.time.size - 1), max(int(last), int(first) + 1))
        return [LENGTH / self.top * float(np.mean(arrow.force[part])) * arrow.direction for arrow in self.arrows]

    def draw(self, scene: mujoco.MjvScene, state: State, factor: float, time: float, exposure: float) -> None:
        """Append the arrows to a scene.

        Args:
            time, exposure: time and exposure time of the frame [s].
        """
        if not self.top:
            return
        for arrow, vector in zip(self.arrows, self.vectors(time, exposure), strict=True):
            if np.linalg.norm(vector) < SHORTEST:
                continue
            (begin,) = self.motion.moved(state, factor, arrow.body, arrow.point)
            geom = add_geom(scene, mujoco.mjtGeom.mjGEOM_ARROW, np.zeros(3), begin, arrow.colour)
            mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_ARROW, WIDTH, begin, begin + vector / DRAWN)
            geom.emission = 0.3
