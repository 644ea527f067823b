"""Text on a frame of a run: input, time, lamps, colour bar, traces."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from vehicle.drawing.rendering.caption import Caption
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.drawing.rendering.layout import INK, PAPER, Layout, Picture
from vehicle.drawing.rendering.mode_inset import LAMP, ModeInset
from vehicle.drawing.rendering.trace_strip import TraceStrip

STICK_COLOUR, SLIP_COLOUR = (tuple(bytes.fromhex(COLOURS[place][1:])) for place in (0, 1))


@dataclass(frozen=True, kw_only=True, eq=False)
class Overlay(Caption):
    """Writer of text and traces on frames of a run."""

    strip: TraceStrip
    """traces below the views"""
    inset: ModeInset | None = None
    """mode in place of the close-up"""

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
        if self.inset is not None:
            self.inset.write(image)
        self._head(image, f"t = {time:.3f} s")
        draw_lamps(pen, layout, lamps, (layout.width - layout.px(12), layout.px(12)))
        self._scale(image)
        pen.line([(layout.main_width, 0), (layout.main_width, layout.view_height)], fill=PAPER, width=self.layout.px(3))
        self.strip.draw(image, time)
        return np.asarray(image)


def draw_lamps(
    pen: ImageDraw.ImageDraw, layout: Layout, lamps: Mapping[str, bool], corner: tuple[int, int], columns: int = 1
) -> None:
    """Draw a lamp for each damper on a white background.

    Args:
        pen: pen on the frame.
        layout: layout of the frame.
        lamps: see `Overlay.draw`.
        corner: right and upper edge [pixel].
        columns: number of columns.
    """
    px, font, (right, top) = layout.px, layout.font, corner
    radius, row = px(9), px(LAMP)
    longest = max((font(16).getlength(label) for label in lamps), default=0.0)
    # A label, with the lamp on the left and the text on the right.
    width = max(px(236), round(longest) + px(112))
    rows = -(-len(lamps) // columns)
    if not rows:
        return
    left = right - min(columns, len(lamps)) * width
    pen.rounded_rectangle([left, top, right, top + row * rows + px(6)], px(8), fill=PAPER)
    for number, (label, slipping) in enumerate(lamps.items()):
        colour, word = (SLIP_COLOUR, "SLIP") if slipping else (STICK_COLOUR, "STICK")
        begin = left + width * (number % columns)
        y = top + px(3) + row * (number // columns) + row // 2
        x = begin + px(20)
        pen.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour, outline=INK)
        pen.text((x + px(20), y), label, fill=INK, font=font(16), anchor="lm")
        pen.text((begin + width - px(12), y), word, fill=colour, font=font(16, True), anchor="rm")
