"""Drawing of the car in a state of motion on a canvas, for several cameras."""

import mujoco

from vehicle.drawing.rendering.body_wireframe import Wireframe
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.motion import Coil, Motion, State
from vehicle.model.parameters.composition import Composition
from vehicle.signals.analysis.samples import Vector


class Drawing:
    """Shapes, coils and coloured wireframe of a car.

    Args:
        scale_top: displacement at the top of the colour scale [m].
    """

    def __init__(
        self, canvas: Canvas, motion: Motion, wireframe: Wireframe, composition: Composition, scale_top: float
    ) -> None:
        self.canvas, self.motion, self.wireframe, self.scale_top = canvas, motion, wireframe, scale_top
        self.data = mujoco.MjData(canvas.model)
        # Lights and cameras are positioned once; the geoms are positioned in every frame.
        for update in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_camlight):
            update(canvas.model, self.data)
        self.coils = [Coil(motion, composition, spring) for spring in composition.springs]

    def pose(self, state: State, factor: float) -> None:
        """Set the exaggerated poses and colours of all shapes.

        Args:
            factor: factor on displacements and rotations from the static equilibrium [-].
        """
        self.data.geom_xpos[:], self.data.geom_xmat[:] = self.motion.geoms(state, factor)
        for coil in self.coils:
            coil.write(self.data, coil.positions(state, factor))
            self.canvas.upload(coil.mesh)
        self.positions = self.wireframe.positions(state, factor)
        self.shades = colours(self.wireframe.displacement(state), self.scale_top)

    def see(self, camera: mujoco.MjvCamera, opacity: Vector) -> None:
        """Fill the scene of the canvas for a camera; geoms may be appended before it is rendered."""
        self.canvas.model.mat_rgba[:, 3] = opacity
        self.canvas.update(self.data, camera)
        self.wireframe.draw(self.canvas.scene, self.positions, self.shades)
