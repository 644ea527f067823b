"""Mode of the car in the film of a run, which replaces the close-up: slow motion with another exaggeration."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw

from vehicle.drawing.rendering.cameras import farther, whole_car
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.drawing import Drawing
from vehicle.drawing.rendering.layout import INK, PAPER, Layout
from vehicle.drawing.rendering.mode_motion import PERIOD, ModeCycle, MovingMode
from vehicle.drawing.rendering.scene import Scene

if TYPE_CHECKING:  # processes that draw a film need no compiler of models
    from vehicle.engines.simulation.car_model import CarModel

EXAGGERATION = 250.0
"""Exaggeration of the mode: its largest displacement is 1 mm, which becomes 25 cm; the picture is small."""

LAMP = 30
"""Height of the lamp of a damper in a picture of 720 lines [pixel]."""

NEARER = 0.93
"""Factor on the distance of the camera: this picture has no words above the car."""

LETTERS = 47
"""Letters in a line of the words of a mode."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BesideMode:
    """Mode in the film of a run, and text on it."""

    mode: MovingMode
    """the mode"""
    words: Sequence[str] = ()
    """lines about it, as its share in the motion"""


class ModeInset:
    """Picture of a mode in the right part of a frame.

    Args:
        scene: scene of the run.
        car: compiled car of the run.
        shown: the mode.
        layout: layout of the frame.
    """

    def __init__(self, scene: Scene, car: CarModel, shown: BesideMode, layout: Layout) -> None:
        self.scene, self.layout = scene, layout
        self.cycle = ModeCycle(scene.model, car, shown.mode)
        mode = shown.mode
        self.lines = [
            f"mode: {mode.frequency:.2f} Hz, damping ratio {100.0 * mode.damping_ratio:.2f} %",
            *textwrap.wrap(mode.description, LETTERS),
            *shown.words,
            f"exaggerated {EXAGGERATION:g} times, {self.cycle.slow_words}",
        ]

    @property
    def top(self) -> int:
        """Return the upper edge of the words, below the lamps of the dampers [pixel]."""
        return self.layout.px(26) + self.layout.px(LAMP) * len(self.scene.dampers)

    @property
    def viewport(self) -> tuple[int, int, int, int]:
        """Return the part of the picture with the car, below the words; see `Canvas.render`."""
        left = self.layout.main_width
        return left, 0, self.layout.width - left, self.layout.view_height - self.top - self.legend.height

    def drawing(self, canvas: Canvas) -> Drawing:
        """Return the drawing of the mode on the canvas of the run."""
        return self.cycle.drawing(canvas, self.scene.composition)

    def draw(self, drawing: Drawing, number: int) -> None:
        """Draw the mode in a frame on the canvas.

        Args:
            drawing: see `drawing`.
            number: number of the frame.
        """
        _, _, width, height = self.viewport
        drawing.pose(self.cycle.states[number % PERIOD], EXAGGERATION)
        camera = farther(whole_car(self.scene.vehicle), width / height)
        camera.distance *= NEARER
        drawing.see(camera, self.scene.opacity)
        drawing.canvas.render(self.viewport)

    def write(self, image: Image.Image) -> None:
        """Write the words on a frame, on white from its upper edge."""
        image.paste(PAPER, (self.layout.main_width, 0, self.layout.width, self.top))
        image.paste(self.legend, (self.layout.main_width, self.top))

    @cached_property
    def legend(self) -> Image.Image:
        """Return the words on a strip above the picture of the mode."""
        px, font, step = self.layout.px, self.layout.font, self.layout.px(18)
        image = Image.new("RGB", (self.layout.width - self.layout.main_width, step * len(self.lines) + px(14)), PAPER)
        pen = ImageDraw.Draw(image)
        for number, line in enumerate(self.lines):
            pen.text((px(10), px(6) + step * number), line, fill=INK, font=font(14, number == 0))
        return image
