"""Motion of a car in a mode, over one cycle that repeats without a jump."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import mujoco
import numpy as np

from vehicle.drawing.rendering.body_wireframe import Wireframe
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.drawing import Drawing
from vehicle.drawing.rendering.excerpt import FPS
from vehicle.drawing.rendering.motion import Motion, State
from vehicle.drawing.rendering.rounding import round_up
from vehicle.model.parameters.composition import Composition
from vehicle.signals.analysis.samples import Complex

if TYPE_CHECKING:  # processes that draw a film need no compiler of models
    from vehicle.engines.simulation.car_model import CarModel

PERIOD = 40
"""Frames of a cycle."""

FARTHEST = 1e-3
"""Amplitude of the point of the car with the largest displacement [m]; the amplitude of a mode is arbitrary."""

EXAGGERATION = 100.0
"""Exaggeration of all motion: the largest displacement is drawn as 10 cm."""


class MovingMode(Protocol):
    """Damped mode u(t) = Re(shape exp(s t))."""

    @property
    def frequency(self) -> float:
        """Return the natural frequency |s| / 2 pi [Hz]."""

    @property
    def damping_ratio(self) -> float:
        """Return the damping ratio -Re(s) / |s| [-]."""

    @property
    def shape(self) -> Complex:
        """Return the displacement of the velocity coordinates, (nv,)."""

    @property
    def description(self) -> str:
        """Return the name of the motion."""


class ModeMotion(Motion):
    """Motion of every body in a mode without its decay: u = Re(J shape exp(i phase)), J in the design position.

    Args:
        model: the model, or a model with the same joints.
        shape: displacement of the velocity coordinates, (nv,).
    """

    def __init__(self, model: mujoco.MjModel, shape: Complex) -> None:
        super().__init__(model)
        data, rows = mujoco.MjData(model), np.zeros((model.nbody, 2, 3, model.nv))
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        for body in range(model.nbody):
            mujoco.mj_jacBody(model, data, rows[body, 0], rows[body, 1], body)
        self.amplitude = rows @ shape  # (bodies, 2, 3), translation and rotation
        self.modal_amplitude = shape[model.jnt_dofadr[self.modal]]

    def at(self, phase: float) -> State:
        """Return the state at a phase [rad] of the cycle."""
        phasor = np.exp(1j * phase)
        displacement = (self.amplitude * phasor).real
        return State(
            translation=displacement[:, 0], rotation=displacement[:, 1], modal=(self.modal_amplitude * phasor).real
        )


class ModeCycle:
    """Cycle of a mode without decay.

    Args:
        model: visible model, with the joints of the car.
        car: compiled car.
        mode: mode of the car.

    Attributes:
        states: state of each frame of the cycle.
        scale_top: displacement at the top of the colour scale [m].
        slow_words: slow motion in words.
    """

    def __init__(self, model: mujoco.MjModel, car: CarModel, mode: MovingMode) -> None:
        from vehicle.drawing.rendering.wireframe import car_wireframe, unit_factor

        factor = FARTHEST * unit_factor(car_wireframe(car).displacement(mode.shape))
        self.motion = ModeMotion(model, factor * mode.shape)
        self.wireframe = Wireframe(car, self.motion)
        self.states = [self.motion.at(2.0 * np.pi * frame / PERIOD) for frame in range(PERIOD)]
        largest = max(float(self.wireframe.displacement(state).max()) for state in self.states)
        self.scale_top = 1e-3 * round_up(1e3 * largest)
        self.slow_words = f"slow motion 1 : {mode.frequency * PERIOD / FPS:.3g}"

    def drawing(self, canvas: Canvas, composition: Composition) -> Drawing:
        """Return the drawing of the car on a canvas, to be posed in one of `states` times `EXAGGERATION`."""
        return Drawing(canvas, self.motion, self.wireframe, composition, self.scale_top)


def mode_title(mode: MovingMode) -> str:
    """Return natural frequency and damping ratio of a mode."""
    return f"{mode.frequency:.2f} Hz, damping ratio {100.0 * mode.damping_ratio:.2f} %"
