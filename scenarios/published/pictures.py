"""Small copies of the studies' figures for the page."""

import io
from pathlib import Path

from PIL import Image

from vehicle.runs.output.folder import write_whole

LARGEST = 120_000
"""Maximum size of a picture under version control [byte]."""

WIDTHS = (1000, 850, 700, 600, 500, 400)
"""Widths that are tried [pixel]; 1000 are the width of a page on a common screen."""

COLOURS = 256
"""Number of colours of a copy, quantised by an octree: the median cut of Pillow turns a thin red line blue."""


def write_copy(figure: Path, copy: Path) -> None:
    """Write a figure as a PNG of at most `LARGEST` bytes: the widest of `WIDTHS` that fits, else the last of them.

    Raises:
        OSError: the figure cannot be read.
        OutputError: the copy cannot be written.
    """
    with Image.open(figure) as opened:
        image = opened.convert("RGB")
    for width in WIDTHS:
        content = _png(image, width)
        if len(content) <= LARGEST:
            break
    write_whole(copy, lambda path: path.write_bytes(content))


def _png(image: Image.Image, width: int) -> bytes:
    size = (min(width, image.width), round(image.height * min(width, image.width) / image.width))
    small = image.resize(size, Image.Resampling.LANCZOS) if size != image.size else image
    buffer = io.BytesIO()
    small.quantize(COLOURS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(
        buffer, format="PNG", optimize=True
    )
    return buffer.getvalue()
