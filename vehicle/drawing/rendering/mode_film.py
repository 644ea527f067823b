"""Film of a mode: a few cycles that repeat without a jump."""

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.cameras import whole_car
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.caption import Caption
from vehicle.drawing.rendering.film import write_film
from vehicle.drawing.rendering.layout import OneView, Picture
from vehicle.drawing.rendering.mode_motion import (
    EXAGGERATION,
    FARTHEST,
    PERIOD,
    ModeCycle,
    MovingMode,
    mode_title,
)
from vehicle.drawing.rendering.stage import stage_model
from vehicle.engines.simulation.car_model import CarModel

CYCLES = 3
"""Cycles of the film: 4 s."""


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
        self.cycle = ModeCycle(self.model, car, mode)
        self.caption = Caption(
            layout=layout,
            heading=[
                mode_title(mode),
                mode.description,
                f"the farthest point of the car moves {1e3 * FARTHEST:g} mm, exaggerated {EXAGGERATION:g} times",
                f"{self.cycle.slow_words}, without the decay",
            ],
            scale_top=1e3 * self.cycle.scale_top,
            scale_words="displacement of the body [mm]",
        )

    def frames(self, backend: str) -> Iterator[Picture]:
        """Draw the frames of a cycle, (height, width, 3) each."""
        size = (self.layout.width, self.layout.height)
        camera, opacity = whole_car(self.vehicle), self.model.mat_rgba[:, 3].copy()
        with closing(Canvas(self.model, size, backend)) as canvas:
            drawing = self.cycle.drawing(canvas, self.vehicle.composition)
            for state in self.cycle.states:
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
