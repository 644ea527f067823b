"""Plots of `rendering` as compact SVG elements of a page."""

import re
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from markupsafe import Markup, escape

FONTS = "'DejaVu Sans', Verdana, sans-serif"
"""Fonts of the figures: the layout uses the first, and the second has equal widths; the page contains no fonts."""


READABLE = 9.0 / 8.0
"""Pixels a point of a figure on a phone: letters of 8 points have 9 pixels."""


def drawing(plot: Callable[[Path], object], label: str) -> Markup:
    """Return a figure as an HTML element."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "figure.svg"
        plot(path)
        text = path.read_text(encoding="utf-8")
    return Markup(f"<figure>{small(text, label)}</figure>")


def small(svg: str, label: str) -> str:
    """Return an SVG file as a compact element: coordinates rounded to 0.01 points, no unused names."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'<g id="[^"]*"', "<g", svg)
    svg = re.sub(r"<!--.*?-->", "", svg, flags=re.S)
    svg = re.sub(r"""font: ([^;"']*)'DejaVu Sans'[^;"]*""", lambda match: f"font: {match[1]}{FONTS}", svg)
    svg = re.sub(r'(?<= d=")[^"]*(?=")', lambda match: _short(match[0]), svg)
    svg = re.sub(r'(?<= [xy]=")-?\d+\.\d+(?=")', lambda match: _rounded(match[0]), svg)
    svg = re.sub(r">\s+<", ">\n<", svg)
    head, content = svg.split(">", 1)
    view = re.search(r'viewBox="\S+ \S+ (\S+) [^"]*"', head)
    assert view is not None
    return f'<svg {view[0]} width="{READABLE * float(view[1]):.0f}" role="img" xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"><title>{escape(label)}</title>{content.strip()}'


def _short(path: str) -> str:
    return " ".join(re.sub(r"-?\d+\.\d+", lambda match: _rounded(match[0]), path).split())


def _rounded(text: str) -> str:
    return f"{float(text):.2f}".rstrip("0").rstrip(".")
