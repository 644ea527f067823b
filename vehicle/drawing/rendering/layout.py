"""Positions and font sizes in a frame of a film."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import ImageFont

from vehicle.errors import ConfigurationError

Picture = npt.NDArray[np.uint8]
"""Picture: red, green and blue, (height, width, 3), first row on top."""

SMALLEST = (320, 180)
"""Minimum width and height of a readable frame [pixel]."""


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
                f"video size: found {self.width} x {self.height}, both numbers must be even; give "
                f"{self.width + self.width % 2} x {self.height + self.height % 2}"
            )
        if self.width < SMALLEST[0] or self.height < SMALLEST[1]:
            raise ConfigurationError(
                f"video size: found {self.width} x {self.height}, must be at least {SMALLEST[0]} x "
                f"{SMALLEST[1]} to be readable"
            )

    @property
    def view_height(self) -> int:
        """Return the height of the views of the car [pixel]."""
        return round(0.79 * self.height)

    @property
    def trace_top(self) -> int:
        """Return the upper edge of the traces [pixel]."""
        return self.view_height

    @property
    def main_width(self) -> int:
        """Return the width of the view of the whole car [pixel]."""
        return round(0.70 * self.width)

    @property
    def trace_left(self) -> int:
        """Return the left edge of the traces [pixel]."""
        return round(0.19 * self.width)

    def px(self, length: float) -> int:
        """Scale a length in a picture of 720 lines to this picture [pixel]."""
        return max(round(length * self.height / 720.0), 1)

    def font(self, size: float, bold: bool = False) -> ImageFont.FreeTypeFont:
        """Return the font for a size in a picture of 720 lines, with a readable minimum."""
        return font(max(round(size * self.height / 720.0), 6), bold)


class TwoCars(Layout):
    """Frame with two cars side by side, a caption above them and traces along the bottom."""

    @property
    def caption_height(self) -> int:
        """Return the height of the caption [pixel]."""
        return round(0.16 * self.height)

    @property
    def view_height(self) -> int:
        """Return the height of the views [pixel]."""
        return round(0.79 * self.height) - self.caption_height

    @property
    def trace_top(self) -> int:
        """Return the upper edge of the traces [pixel]."""
        return self.caption_height + self.view_height

    @property
    def main_width(self) -> int:
        """Return the width of the view of a car [pixel]."""
        return self.width // 2


class OneView(Layout):
    """Frame with a single view of the whole car."""

    @property
    def view_height(self) -> int:
        """Return the height of the view of the car [pixel]."""
        return self.height

    @property
    def main_width(self) -> int:
        """Return the width of the view of the car [pixel]."""
        return self.width


@cache
def font(size: int, bold: bool) -> ImageFont.FreeTypeFont:
    """Return DejaVu Sans of a size [pixel], which is a part of matplotlib."""
    import matplotlib

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)
