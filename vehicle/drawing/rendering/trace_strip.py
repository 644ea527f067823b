"""Scrolling traces below the picture of a film, with the current time in the middle."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from PIL import Image, ImageDraw

from vehicle.drawing.rendering.figure import COLOURS
from vehicle.drawing.rendering.layout import INK, PAPER, Layout
from vehicle.drawing.rendering.rounding import round_up
from vehicle.signals.analysis.samples import Vector

GRID = (208, 212, 218)
TRACE_COLOURS = tuple(tuple(bytes.fromhex(COLOURS[place][1:])) for place in (4, 0, 1, 1))
PAIR_COLOURS = (INK, tuple(bytes.fromhex(COLOURS[2][1:])))
"""Colours of two runs: dark and green, which differ in brightness; lamps and arrows have other colours."""

BAND = (221, 233, 246)
FINE = 2
"""Factor by which traces are drawn larger and then reduced, to smooth their lines."""

AXIS, TICKS = 15, 5
"""Height of the time axis in a picture of 720 lines [pixel], and approximate number of its labels."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trace:
    """Channel drawn as a scrolling trace."""

    label: str
    """quantity and unit"""
    values: tuple[Vector, ...]
    """samples in that unit of a run, or of two that are compared, (n,) each"""
    top: float
    """value at the upper edge; the lower edge is its negative"""
    band: float | None = None
    """half height of a shaded band"""


@dataclass(frozen=True, kw_only=True, eq=False)
class TraceStrip:
    """Strip with the traces of a run.

    Attributes:
        layout: layout of the frame.
        time: sample times of the traces [s], (n,).
        traces: traces to draw.
        visible: length of the traces on the screen [s].
    """

    layout: Layout
    time: Vector
    traces: Sequence[Trace]
    visible: float

    @cached_property
    def backdrop(self) -> Image.Image:
        """Return the static parts of the strip."""
        px, font = self.layout.px, self.layout.font
        layout = self.layout
        image = Image.new("RGB", (layout.width, layout.height), PAPER)
        pen = ImageDraw.Draw(image)
        for (top, bottom), trace, colour in zip(self._rows, self.traces, TRACE_COLOURS, strict=False):
            middle = (top + bottom) / 2
            ink = colour if len(trace.values) == 1 else INK
            pen.text((px(12), middle), trace.label, fill=ink, font=font(13, True), anchor="lm")
            x = layout.trace_left - px(6)
            pen.text((x, top), f"{trace.top:g}", fill=INK, font=font(11), anchor="rt")
            pen.text((x, bottom), f"{-trace.top:g}", fill=INK, font=font(11), anchor="rb")
        return image

    @cached_property
    def _rows(self) -> list[tuple[int, int]]:
        """Return the upper and lower edge of each trace in the frame [pixel]."""
        layout, gap = self.layout, self.layout.px(6)
        height = (layout.height - layout.trace_top - gap - self.layout.px(AXIS)) // max(len(self.traces), 1)
        first = layout.trace_top + gap
        return [(first + height * row, first + height * (row + 1) - gap) for row in range(len(self.traces))]

    def _time_axis(self, image: Image.Image, begin: float, width: int) -> None:
        """Draw the scrolling time labels under the traces."""
        px, font = self.layout.px, self.layout.font
        layout, pen = self.layout, ImageDraw.Draw(image)
        top = self._rows[-1][1] if self._rows else layout.trace_top
        pen.text((px(12), top + px(1)), "time [s]", fill=INK, font=font(12))
        step = round_up(self.visible / TICKS)
        for number in range(int(np.ceil(begin / step)), int((begin + self.visible) / step) + 1):
            x = layout.trace_left + (number * step - begin) / self.visible * width
            inside = number >= 0 and number * step <= self.time[-1] and x < layout.width - px(24)
            if inside:
                pen.line([(x, top), (x, top + px(3))], fill=INK)
                pen.text(
                    (x, top + px(2)),
                    f"{number * step:.6g}",
                    fill=INK,
                    font=font(12),
                    anchor="ma",
                )

    def draw(self, image: Image.Image, now: float) -> None:
        """Draw the traces with the current time in the middle."""
        layout = self.layout
        width = layout.width - layout.trace_left - self.layout.px(10)
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
            for values, shade in zip(trace.values, (colour,) if len(trace.values) == 1 else PAIR_COLOURS, strict=True):
                up = height / 2 * (1.0 - values[part] / trace.top)
                pen.line(list(zip(across.tolist(), up.tolist(), strict=True)), fill=shade, width=FINE + 1)
            pen.line([(width * FINE / 2, 0), (width * FINE / 2, height)], fill=INK, width=FINE)
            image.paste(panel.reduce(FINE), (layout.trace_left, top))
