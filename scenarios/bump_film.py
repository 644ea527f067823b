"""Film of two bumps side by side, in step: the same time in both halves of every frame."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle.car import Run
from vehicle.errors import OutputError
from vehicle.output_folder import write_whole
from vehicle.rendering.backend import choose_backend, find_ffmpeg
from vehicle.rendering.film import QUALITY
from vehicle.rendering.layout import Layout
from vehicle.rendering.shot import Shot

Picture = npt.NDArray[np.uint8]

HALF = (960, 600)
"""Width and height of one half [pixel]: wide enough for the captions that its height gives."""

BANNER = 48
"""Height of the captions above the halves [pixel]."""

SLOW, FPS = 3.0, 30.0

SHOWN_BUMP = 0.06
"""Height [m] to which every bump is exaggerated: a linear car would look alike in both halves."""


def side_by_side(path: Path, runs: Sequence[Run], sizes: Sequence[float], *, start: float, duration: float) -> None:
    """Write the film as H.264 in MP4.

    Args:
        path: MP4 file.
        runs: with poses, in the order from left to right.
        sizes: A of the bumps [m].
        start: first time shown [s].
        duration: length of the film [s].

    Raises:
        MissingPartError: no off-screen OpenGL library or no ffmpeg.
        OutputError: the file cannot be written.
    """
    ffmpeg, backend = find_ffmpeg(), choose_backend()
    shots = [
        Shot(
            run,
            Layout(width=HALF[0], height=HALF[1]),
            start=start,
            duration=duration,
            slow=SLOW,
            exaggeration=SHOWN_BUMP / size,
            fps=FPS,
        )
        for run, size in zip(runs, sizes, strict=True)
    ]
    captions = [f"bump of {1e3 * size:g} mm, motion {SHOWN_BUMP / size:g} times" for size in sizes]
    banner = np.concatenate([_caption(text) for text in captions], axis=1)

    import mediapy

    mediapy.set_ffmpeg(ffmpeg)

    def write(file: Path) -> None:
        shape = (banner.shape[0] + HALF[1], banner.shape[1])
        with mediapy.VideoWriter(
            file, shape=shape, fps=FPS, codec="h264", crf=QUALITY, encoded_format="yuv420p"
        ) as writer:
            for halves in zip(*(shot.frames(backend) for shot in shots), strict=True):
                writer.add_image(np.concatenate([banner, np.concatenate(halves, axis=1)], axis=0))

    try:
        write_whole(path, write)
    except RuntimeError as error:
        # What ffmpeg complains about comes as a RuntimeError with these words.
        if str(error).startswith("Error writing"):
            raise OutputError(f"{path}: the film cannot be written: {' '.join(str(error).split())}") from None
        raise


def _caption(text: str) -> Picture:
    """A strip with a text in its middle, (height, width, 3)."""
    import matplotlib
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans-Bold.ttf"), 24)
    image = Image.new("RGB", (HALF[0], BANNER), (28, 37, 48))
    ImageDraw.Draw(image).text((HALF[0] / 2, BANNER / 2), text, fill=(255, 255, 255), font=font, anchor="mm")
    return np.asarray(image)
