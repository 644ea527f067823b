"""Where things are in a frame of a film, and how large what is written on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import ImageFont

from vehicle.errors import ConfigurationError

Picture = npt.NDArray[np.uint8]
"""Red, green and blue, (height, width, 3), first row on top."""

SMALLEST = (320, 180)
"""Width and height of a frame that can still be read [pixel]."""


INK = (28, 37, 48)
PAPER = (245, 246, 248)


@dataclass(frozen=True, kw_only=True, slots=True)
class Layout:
    """Frame of a film: the car at the left, a close-up at the right, traces along the bottom.

    Raises:
        ConfigurationError: a side is odd (H.264 with yuv420p halves both) or too small to read.
    """

    width: int
    """[pixel]"""
    height: int
    """[pixel]"""

    def __post_init__(self) -> None:
        if self.width % 2 or self.height % 2:
            raise ConfigurationError(
                f"film size: found {self.width} x {self.height}, both must be even; "
                f"give {self.width + self.width % 2} x {self.height + self.height % 2}"
            )
        if self.width < SMALLEST[0] or self.height < SMALLEST[1]:
            raise ConfigurationError(
                f"film size: found {self.width} x {self.height}, at least {SMALLEST[0]} x {SMALLEST[1]} can be read"
            )

    @property
    def view_height(self) -> int:
        """Height of the views of the car [pixel]."""
        return round(0.79 * self.height)

    @property
    def main_width(self) -> int:
        """Width of the view of the whole car [pixel]."""
        return round(0.70 * self.width)

    @property
    def trace_left(self) -> int:
        """Left edge of the traces [pixel]."""
        return round(0.19 * self.width)

    def px(self, length: float) -> int:
        """A length of the 720 line picture in this picture [pixel]."""
        return max(round(length * self.height / 720.0), 1)

    def font(self, size: float, bold: bool = False) -> ImageFont.FreeTypeFont:
        """Letters of a size in the 720 line picture, never too small to read."""
        return font(max(round(size * self.height / 720.0), 6), bold)


class OneView(Layout):
    """Frame that the whole car fills: nothing beside or below it."""

    @property
    def view_height(self) -> int:
        """Height of the view of the car [pixel]."""
        return self.height

    @property
    def main_width(self) -> int:
        """Its width [pixel]."""
        return self.width


@cache
def font(size: int, bold: bool) -> ImageFont.FreeTypeFont:
    """DejaVu Sans of a size [pixel], which comes with matplotlib."""
    import matplotlib

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)
