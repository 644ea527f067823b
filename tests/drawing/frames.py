"""Frames of a film as arrays."""

import subprocess
from pathlib import Path

import numpy as np

from tests.patience import HANG
from vehicle.drawing.rendering.backend import find_ffmpeg


def frames(path: Path, size: tuple[int, int], pixel: str = "rgb24") -> np.ndarray:
    """Return the frames of a film, (n, height, width, 3); (n, height, width) for pixels "gray"."""
    command = [find_ffmpeg(), "-loglevel", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", pixel, "-"]
    raw = subprocess.run(command, capture_output=True, check=True, timeout=HANG).stdout
    return np.frombuffer(raw, dtype=np.uint8).reshape(-1, *size[::-1], *((3,) if pixel == "rgb24" else ())).astype(int)
