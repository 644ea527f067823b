"""Film of a mode: a few cycles that repeat without a jump."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Protocol

import mujoco
import numpy as np

from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.body_wireframe import Wireframe
from vehicle.drawing.rendering.cameras import whole_car
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.caption import Caption
from vehicle.drawing.rendering.drawing import Drawing
from vehicle.drawing.rendering.excerpt import FPS
from vehicle.drawing.rendering.film import write_film
from vehicle.drawing.rendering.layout import OneView, Picture
from vehicle.drawing.rendering.motion import Motion, State
from vehicle.drawing.rendering.rounding import round_up
from vehicle.drawing.rendering.stage import stage_model
from vehicle.drawing.rendering.wireframe import car_wireframe, unit_factor
from vehicle.engines.simulation.car_model import CarModel
from vehicle.signals.analysis.samples import Complex

PERIOD, CYCLES = 40, 3
"""Frames of a cycle, and cycles of the film: 4 s."""

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


class ModeShot:
    """One cycle of a mode for drawing frame by frame.

    Args:
        car: compiled car.
        mode: mode of the car.
        layout: layout of the frame.
    """

    def __init__(self, car: CarModel, mode: MovingMode, layout: OneView) -> None:
        self.vehicle, self.layout = car.vehicle, layout
        self.model = stage_model(car, (layout.width, layout.height))
        factor = FARTHEST * unit_factor(car_wireframe(car).displacement(mode.shape))
        self.motion = ModeMotion(self.model, factor * mode.shape)
        self.wireframe = Wireframe(car, self.motion)
        self.states = [self.motion.at(2.0 * np.pi * frame / PERIOD) for frame in range(PERIOD)]
        largest = max(float(self.wireframe.displacement(state).max()) for state in self.states)
        self.scale_top = 1e-3 * round_up(1e3 * largest)
        slow = mode.frequency * PERIOD / FPS
        self.caption = Caption(
            layout=layout,
            heading=[
                f"{mode.frequency:.2f} Hz, damping ratio {100.0 * mode.damping_ratio:.2f} %",
                mode.description,
                f"the farthest point of the car moves {1e3 * FARTHEST:g} mm, exaggerated {EXAGGERATION:g} times",
                f"slow motion 1 : {slow:.3g}, without the decay",
            ],
            scale_top=1e3 * self.scale_top,
            scale_words="displacement of the body [mm]",
        )

    def frames(self, backend: str) -> Iterator[Picture]:
        """Draw the frames of a cycle, (height, width, 3) each."""
        size = (self.layout.width, self.layout.height)
        camera, opacity = whole_car(self.vehicle), self.model.mat_rgba[:, 3].copy()
        with closing(Canvas(self.model, size, backend)) as canvas:
            drawing = Drawing(canvas, self.motion, self.wireframe, self.vehicle.composition, self.scale_top)
            for state in self.states:
                drawing.pose(state, EXAGGERATION)
                drawing.see(camera, opacity)
                canvas.render((0, 0, *size))
                yield self.caption.write(canvas.read())


def mode_film(
    car: CarModel,
    mode: MovingMode,
    path: Path,
    *,
    size: tuple[int, int] = (1280, 720),
    progress: Callable[[float], None] | None = None,
) -> None:
    """Write the film of a mode as H.264 in MP4.

    Args:
        car: compiled car.
        mode: mode of the car.
        path, size, progress: see `film`.

    Raises:
        ConfigurationError: the size cannot be encoded or read.
        MissingPartError, OutputError: see `film`.
    """
    backend = choose_backend()
    shot = ModeShot(car, mode, OneView(width=size[0], height=size[1]))

    def repeated() -> Iterator[Picture]:
        cycle = []
        for frame in shot.frames(backend):
            cycle.append(frame)
            yield frame
            if progress is not None:
                progress(len(cycle) / PERIOD)
        for _ in range(CYCLES - 1):
            yield from cycle

    write_film(path, repeated(), (size[1], size[0]))
