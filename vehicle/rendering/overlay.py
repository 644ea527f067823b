"""Where things are in a frame, and what is written on it: input, time, lamps, colour bar with its scale, traces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from vehicle.errors import ConfigurationError
from vehicle.rendering.figure import COLOURS

Picture = npt.NDArray[np.uint8]
Vector = npt.NDArray[np.float64]

INK = (28, 37, 48)
PAPER = (245, 246, 248)
STICK_COLOUR, SLIP_COLOUR = (tuple(bytes.fromhex(COLOURS[place][1:])) for place in (0, 1))
GRID = (208, 212, 218)
TRACE_COLOURS = tuple(tuple(bytes.fromhex(COLOURS[place][1:])) for place in (4, 0, 1))
BAND = (221, 233, 246)
FINE = 2
"""Traces are drawn this many times larger and reduced, which smooths their lines."""

SCALE = "viridis"
"""Colour map of the displacement: equal steps look equally large, in print without colours and to colour-blind eyes too
(Smith and van der Walt, 2015). Violet is at rest, yellow the top of the scale."""

AXIS, TICKS = 15, 5
"""Height of the time axis in a picture of 720 lines [pixel], and about how many times it names."""

SHADES = 256
"""Of its table."""

SMALLEST = (320, 180)
"""Width and height of a frame that can still be read [pixel]."""


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trace:
    """A channel that runs along under the picture."""

    label: str
    """quantity and unit"""
    values: Vector
    """in that unit, (n,)"""
    top: float
    """value at the upper edge; the lower edge is its negative"""
    band: float | None = None
    """half height of a shaded band"""


@dataclass(frozen=True, kw_only=True, eq=False)
class Caption:
    """Writes a heading and the scale of the colours onto pictures of one size."""

    layout: Layout
    """where things are"""
    heading: Sequence[str]
    """lines at the upper left; the first is bold"""
    scale_top: float
    """displacement at the top of the colour bar [mm]"""
    scale_words: str = "true displacement of the body [mm]"
    """quantity and unit of the colour bar"""

    def write(self, picture: Picture) -> Picture:
        """Put them onto a view of the car, (height, width, 3)."""
        image = Image.fromarray(np.ascontiguousarray(picture))
        self._head(image)
        self._scale(image)
        return np.asarray(image)

    def _px(self, length: float) -> int:
        """A length of the 720 line picture in this picture [pixel]."""
        return max(round(length * self.layout.height / 720.0), 1)

    def _font(self, size: float, bold: bool = False) -> ImageFont.FreeTypeFont:
        return font(max(round(size * self.layout.height / 720.0), 6), bold)

    def _head(self, image: Image.Image, last: str = "") -> None:
        """Heading, and a bold last line."""
        x, y, step = self._px(16), self._px(12), self._px(24)
        image.paste(INK, (x, y), self.head)
        below = y + self._px(28) + step * (len(self.heading) - 1)
        ImageDraw.Draw(image).text((x, below), last, fill=INK, font=self._font(17, True))

    @cached_property
    def head(self) -> Image.Image:
        """The heading as a mask of its ink."""
        lines = [(line, self._font(21 if number == 0 else 17, number == 0)) for number, line in enumerate(self.heading)]
        width = max(letters.getbbox(line)[2] for line, letters in lines)
        mask = Image.new("L", (round(width) + 1, self._px(28) + self._px(24) * len(lines)))
        pen, y = ImageDraw.Draw(mask), 0
        for number, (line, letters) in enumerate(lines):
            pen.text((0, y), line, fill=255, font=letters)
            y += self._px(28 if number == 0 else 24)
        return mask

    def _scale(self, image: Image.Image) -> None:
        """The colour bar at the lower left of the car."""
        place = self.layout.view_height - self.colour_bar.height - self._px(10)
        image.paste(self.colour_bar, (self._px(16), place))

    @cached_property
    def colour_bar(self) -> Image.Image:
        """Scale of the wireframe's colours on a white plate."""
        width, height = self._px(384), self._px(56)
        image = Image.new("RGB", (width, height), PAPER)
        pen = ImageDraw.Draw(image)
        words = f"{self.scale_words}; grey: at rest"
        pen.text((self._px(8), self._px(4)), words, fill=INK, font=self._font(14))
        left, right, top, bottom = self._px(10), width - self._px(10), self._px(23), self._px(35)
        shades = (255.0 * colours(np.linspace(0.0, 1.0, right - left), 1.0)[:, :3]).astype(np.uint8)
        image.paste(Image.fromarray(np.repeat(shades[None], bottom - top, axis=0)), (left, top))
        for share, anchor in ((0.0, "la"), (0.5, "ma"), (1.0, "ra")):
            place = (left + share * (right - left), bottom + self._px(3))
            pen.text(place, f"{share * self.scale_top:.3g}", fill=INK, font=self._font(13), anchor=anchor)
        return image


@dataclass(frozen=True, kw_only=True, eq=False)
class Overlay(Caption):
    """Draws onto frames of a run."""

    time: Vector
    """sample times of the traces [s], (n,)"""
    traces: Sequence[Trace]
    """what runs along"""
    visible: float
    """length of the traces on the screen [s]"""

    def draw(self, picture: Picture, time: float, lamps: Mapping[str, bool]) -> Picture:
        """Finish a frame.

        Args:
            picture: views of the car, (height above the traces, width, 3).
            time: [s].
            lamps: label of each damper, and whether it slips: is faster than `damper.slip_velocity`, as in all tables.

        Returns:
            The whole frame, (height, width, 3).
        """
        layout, image = self.layout, self.backdrop.copy()
        image.paste(Image.fromarray(np.ascontiguousarray(picture)), (0, 0))
        pen = ImageDraw.Draw(image)
        self._head(image, f"t = {time:.3f} s")
        self._lamps(pen, lamps)
        self._scale(image)
        pen.line([(layout.main_width, 0), (layout.main_width, layout.view_height)], fill=PAPER, width=self._px(3))
        self._run(image, time)
        return np.asarray(image)

    def _lamps(self, pen: ImageDraw.ImageDraw, lamps: Mapping[str, bool]) -> None:
        """One lamp for each damper on a white plate above the close-up."""
        right, radius, row = self.layout.width - self._px(12), self._px(9), self._px(30)
        longest = max((self._font(16).getlength(label) for label in lamps), default=0.0)
        # A label, its lamp on the left and the word on the right.
        left, top = right - max(self._px(236), round(longest) + self._px(112)), self._px(12)
        pen.rounded_rectangle([left, top, right, top + row * len(lamps) + self._px(6)], self._px(8), fill=PAPER)
        for number, (label, slipping) in enumerate(lamps.items()):
            colour, word = (SLIP_COLOUR, "SLIP") if slipping else (STICK_COLOUR, "STICK")
            y = top + self._px(3) + row * number + row // 2
            x = left + self._px(20)
            pen.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour, outline=INK)
            pen.text((x + self._px(20), y), label, fill=INK, font=self._font(16), anchor="lm")
            pen.text((right - self._px(12), y), word, fill=colour, font=self._font(16, True), anchor="rm")

    @cached_property
    def backdrop(self) -> Image.Image:
        """Everything in the strip of the traces that stands still."""
        layout = self.layout
        image = Image.new("RGB", (layout.width, layout.height), PAPER)
        pen = ImageDraw.Draw(image)
        for (top, bottom), trace, colour in zip(self._rows, self.traces, TRACE_COLOURS, strict=False):
            middle = (top + bottom) / 2
            pen.text((self._px(12), middle), trace.label, fill=colour, font=self._font(14, True), anchor="lm")
            x = layout.trace_left - self._px(6)
            pen.text((x, top), f"{trace.top:g}", fill=INK, font=self._font(11), anchor="rt")
            pen.text((x, bottom), f"{-trace.top:g}", fill=INK, font=self._font(11), anchor="rb")
        return image

    @cached_property
    def _rows(self) -> list[tuple[int, int]]:
        """Upper and lower edge of each trace in the frame [pixel]."""
        layout, gap = self.layout, self._px(6)
        height = (layout.height - layout.view_height - gap - self._px(AXIS)) // max(len(self.traces), 1)
        first = layout.view_height + gap
        return [(first + height * row, first + height * (row + 1) - gap) for row in range(len(self.traces))]

    def _time_axis(self, image: Image.Image, begin: float, width: int) -> None:
        """Times of the record under the traces, which run along with them."""
        layout, pen = self.layout, ImageDraw.Draw(image)
        top = self._rows[-1][1] if self._rows else layout.view_height
        pen.text((self._px(12), top + self._px(1)), "time [s]", fill=INK, font=self._font(12))
        step = round_up(self.visible / TICKS)
        for number in range(int(np.ceil(begin / step)), int((begin + self.visible) / step) + 1):
            x = layout.trace_left + (number * step - begin) / self.visible * width
            inside = number >= 0 and number * step <= self.time[-1] and x < layout.width - self._px(24)
            if inside:
                pen.line([(x, top), (x, top + self._px(3))], fill=INK)
                pen.text((x, top + self._px(2)), f"{number * step:.6g}", fill=INK, font=self._font(12), anchor="ma")

    def _run(self, image: Image.Image, now: float) -> None:
        """Traces with the present in the middle."""
        layout = self.layout
        width = layout.width - layout.trace_left - self._px(10)
        begin = now - self.visible / 2
        first, last = np.searchsorted(self.time, [begin, begin + self.visible])
        part = slice(max(first - 1, 0), last + 1)
        across = (self.time[part] - begin) / self.visible * width * FINE
        self._time_axis(image, begin, width)
        for (top, bottom), trace, colour in zip(self._rows, self.traces, TRACE_COLOURS, strict=False):
            height = (bottom - top) * FINE
            panel = Image.new("RGB", (width * FINE, height), (255, 255, 255))
            pen = ImageDraw.Draw(panel)
            if trace.band is not None:
                half = height / 2 * min(trace.band / trace.top, 1.0)
                pen.rectangle([0, height / 2 - half, width * FINE, height / 2 + half], fill=BAND)
            pen.line([(0, height / 2), (width * FINE, height / 2)], fill=GRID, width=FINE)
            up = height / 2 * (1.0 - trace.values[part] / trace.top)
            pen.line(list(zip(across.tolist(), up.tolist(), strict=True)), fill=colour, width=FINE + 1)
            pen.line([(width * FINE / 2, 0), (width * FINE / 2, height)], fill=INK, width=FINE)
            image.paste(panel.resize((width, bottom - top), Image.Resampling.BOX), (layout.trace_left, top))


@cache
def font(size: int, bold: bool) -> ImageFont.FreeTypeFont:
    """DejaVu Sans of a size [pixel], which comes with matplotlib."""
    import matplotlib

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)


def colours(values: npt.ArrayLike, top: float) -> npt.NDArray[np.float32]:
    """Colours of values between 0 and the top of the scale; what lies above is drawn as the top.

    Args:
        values: (n,), same unit as `top`.
        top: largest value of the scale, above 0.

    Returns:
        Red, green, blue and opacity 1, (n, 4).
    """
    from matplotlib import colormaps

    table = np.array(colormaps[SCALE](np.linspace(0.0, 1.0, SHADES)))[:, :3]
    place = np.clip(np.atleast_1d(np.asarray(values, dtype=float)) / top, 0.0, 1.0) * (SHADES - 1)
    rgb = [np.interp(place, np.arange(SHADES), column) for column in table.T]
    return np.column_stack([*rgb, np.ones(len(place))]).astype(np.float32)


def round_up(value: float) -> float:
    """The next 1, 1.5, 2, 3, 4, 5, 6, 8 or 10 times a power of ten; 1 for zero."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    steps = np.array([1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0])
    return float(steps[steps >= value / power * (1.0 - 1e-12)][0] * power)


def round_factor(factor: float) -> float:
    """Round an exaggeration down to 1, 1.5, 2, 3, 5 or 7 times a power of ten; never below 1."""
    power = 10.0 ** np.floor(np.log10(max(factor, 1.0)))
    steps = np.array([1.0, 1.5, 2.0, 3.0, 5.0, 7.0])
    return float(steps[steps <= max(factor, 1.0) / power * (1.0 + 1e-12)][-1] * power)
