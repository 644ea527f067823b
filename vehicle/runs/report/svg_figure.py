"""The figures of a run as SVG for a page: the plots of `rendering`, made small."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from vehicle.runs.report.markup import Markup, tag

FONTS = "'DejaVu Sans', Verdana, sans-serif"
"""The figures are laid out with the first, which has the widths of the second; no font travels with the page."""


def drawing(plot: Callable[[Path], object], words: str) -> Markup:
    """Draw a figure for a page.

    Args:
        plot: writes the figure at the path it is given.
        words: what it shows, for those who cannot see it.

    Returns:
        A `figure` element with the SVG in it.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / "figure.svg"
        plot(path)
        text = path.read_text(encoding="utf-8")
    return tag("figure", Markup(small(text, words)))


def small(svg: str, words: str) -> str:
    """An SVG file as an element: coordinates to a hundredth of a point, no names that nothing refers to.

    Args:
        svg: as matplotlib writes it.
        words: its label.
    """
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'<g id="[^"]*"', "<g", svg)
    svg = re.sub(r"<!--.*?-->", "", svg, flags=re.S)
    svg = re.sub(r"""font: ([^;"']*)'DejaVu Sans'[^;"]*""", lambda match: f"font: {match[1]}{FONTS}", svg)
    svg = re.sub(r'(?<= d=")[^"]*(?=")', lambda match: _short(match[0]), svg)
    svg = re.sub(r'(?<= [xy]=")-?\d+\.\d+(?=")', lambda match: _rounded(match[0]), svg)
    svg = re.sub(r">\s+<", ">\n<", svg)
    head, rest = svg.split(">", 1)
    view = re.search(r'viewBox="[^"]*"', head)
    assert view is not None
    label = tag("title", words)
    return f'<svg {view[0]} role="img" xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">{label}{rest.strip()}'


def _short(path: str) -> str:
    return " ".join(re.sub(r"-?\d+\.\d+", lambda match: _rounded(match[0]), path).split())


def _rounded(text: str) -> str:
    return f"{float(text):.2f}".rstrip("0").rstrip(".")
