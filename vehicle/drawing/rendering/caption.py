"""Text on a picture of the car: a heading and a colour bar."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from PIL import Image, ImageDraw

from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.layout import INK, PAPER, Layout, Picture


@dataclass(frozen=True, kw_only=True, eq=False)
class Caption:
    """Writer of a heading and a colour bar on pictures of one size."""

    layout: Layout
    """layout of the picture"""
    heading: Sequence[str]
    """lines at the upper left; the first is bold"""
    scale_top: float
    """displacement at the top of the colour bar [mm]"""
    scale_words: str = "true displacement of the body [mm]"
    """quantity and unit of the colour bar"""

    def write(self, picture: Picture) -> Picture:
        """Write heading and colour bar on a view of the car, (height, width, 3)."""
        image = Image.fromarray(np.ascontiguousarray(picture))
        self._head(image)
        self._scale(image)
        return np.asarray(image)

    def _head(self, image: Image.Image, last: str = "") -> None:
        """Draw the heading and a bold last line."""
        px, font = self.layout.px, self.layout.font
        x, y, step = px(16), px(12), px(24)
        image.paste(INK, (x, y), self.head)
        below = y + px(28) + step * (len(self.heading) - 1)
        ImageDraw.Draw(image).text((x, below), last, fill=INK, font=font(17, True))

    @cached_property
    def head(self) -> Image.Image:
        """Return the heading as a mask."""
        px, font = self.layout.px, self.layout.font
        lines = [(line, font(21 if number == 0 else 17, number == 0)) for number, line in enumerate(self.heading)]
        width = max(letters.getbbox(line)[2] for line, letters in lines)
        mask = Image.new("L", (round(width) + 1, px(28) + px(24) * len(lines)))
        pen, y = ImageDraw.Draw(mask), 0
        for number, (line, letters) in enumerate(lines):
            pen.text((0, y), line, fill=255, font=letters)
            y += px(28 if number == 0 else 24)
        return mask

    def _scale(self, image: Image.Image) -> None:
        """Draw the colour bar at the lower left of the view."""
        top = self.layout.view_height - self.colour_bar.height - self.layout.px(10)
        image.paste(self.colour_bar, (self.layout.px(16), top))

    @cached_property
    def colour_bar(self) -> Image.Image:
        """Return the colour bar of the wireframe on a white background."""
        px, font = self.layout.px, self.layout.font
        width, height = px(384), px(56)
        image = Image.new("RGB", (width, height), PAPER)
        pen = ImageDraw.Draw(image)
        label = f"{self.scale_words}; grey: at rest"
        pen.text((px(8), px(4)), label, fill=INK, font=font(14))
        left, right, top, bottom = px(10), width - px(10), px(23), px(35)
        shades = (255.0 * colours(np.linspace(0.0, 1.0, right - left), 1.0)[:, :3]).astype(np.uint8)
        image.paste(Image.fromarray(np.repeat(shades[None], bottom - top, axis=0)), (left, top))
        for share, anchor in ((0.0, "la"), (0.5, "ma"), (1.0, "ra")):
            position = (left + share * (right - left), bottom + px(3))
            pen.text(position, f"{share * self.scale_top:.3g}", fill=INK, font=font(13), anchor=anchor)
        return image
