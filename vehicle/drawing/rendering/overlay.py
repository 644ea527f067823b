"""Text on a frame of a run: input, time, lamps, colour bar, traces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from vehicle.drawing.rendering.caption import Caption
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.drawing.rendering.layout import INK, PAPER, Picture
from vehicle.drawing.rendering.trace_strip import TraceStrip

STICK_COLOUR, SLIP_COLOUR = (tuple(bytes.fromhex(COLOURS[place][1:])) for place in (0, 1))


@dataclass(frozen=True, kw_only=True, eq=False)
class Overlay(Caption):
    """Writer of text and traces on frames of a run."""

    strip: TraceStrip
    """traces below the views"""

    def draw(self, picture: Picture, time: float, lamps: Mapping[str, bool]) -> Picture:
        """Compose a frame.

        Args:
            picture: views of the car, (height above the traces, width, 3).
            time: time [s].
            lamps: label of each damper to True if it slips, that is, moves faster than `damper.slip_velocity`.

        Returns:
            The whole frame, (height, width, 3).
        """
        layout, image = self.layout, self.strip.backdrop.copy()
        image.paste(Image.fromarray(np.ascontiguousarray(picture)), (0, 0))
        pen = ImageDraw.Draw(image)
        self._head(image, f"t = {time:.3f} s")
        self._lamps(pen, lamps)
        self._scale(image)
        pen.line([(layout.main_width, 0), (layout.main_width, layout.view_height)], fill=PAPER, width=self.layout.px(3))
        self.strip.draw(image, time)
        return np.asarray(image)

    def _lamps(self, pen: ImageDraw.ImageDraw, lamps: Mapping[str, bool]) -> None:
        """Draw a lamp for each damper on a white background above the close-up."""
        px, font = self.layout.px, self.layout.font
        right, radius, row = self.layout.width - px(12), px(9), px(30)
        longest = max((font(16).getlength(label) for label in lamps), default=0.0)
        # A label, with the lamp on the left and the text on the right.
        left, top = right - max(px(236), round(longest) + px(112)), px(12)
        pen.rounded_rectangle([left, top, right, top + row * len(lamps) + px(6)], px(8), fill=PAPER)
        for number, (label, slipping) in enumerate(lamps.items()):
            colour, word = (SLIP_COLOUR, "SLIP") if slipping else (STICK_COLOUR, "STICK")
            y = top + px(3) + row * number + row // 2
            x = left + px(20)
            pen.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour, outline=INK)
            pen.text((x + px(20), y), label, fill=INK, font=font(16), anchor="lm")
            pen.text((right - px(12), y), word, fill=colour, font=font(16, True), anchor="rm")
