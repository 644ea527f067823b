"""Film of a run in its report: encoded again if it is too large for a page that is sent by mail."""

import base64
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

from markupsafe import Markup

from vehicle.drawing.rendering.backend import find_ffmpeg
from vehicle.errors import MissingPartError
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates

fill = templates(__file__)

BUDGET = 2.2e6
"""Maximum size of the films of a page [bytes]: 2.9 MB as text, so that a page with two runs is below 6 MB."""

QUALITIES = ((1280, 28), (960, 28), (960, 32), (640, 32), (480, 36))
"""Width [pixels] and quality number of H.264 (smaller is better), tried in this order until the film fits."""

STILL_S = 1.0
"""Time of the picture that is printed [s]."""

TIMEOUT = 300.0
"""Maximum duration of an encoding [s]."""


def film(run: FinishedRun, share: float = 1.0) -> Markup | None:
    """Return the film of a run, and a picture of it for paper; None if there is no film.

    Args:
        share: share of `BUDGET` for this film.
    """
    name = run.summary.files.get("video")
    candidates = [] if name is None else [run.folder / name, Path(name)]
    path = next((candidate for candidate in candidates if candidate.is_file()), None)
    return None if path is None else film_part(path, share)


def film_part(path: Path, share: float = 1.0) -> Markup:
    """Return a film, and a picture of it for paper; see `film`."""
    with TemporaryDirectory() as folder:
        content, still = embedded(path, share * BUDGET, Path(folder)), _still(path, Path(folder))
    return fill(
        "film",
        name=path.name,
        megabytes=path.stat().st_size / 1e6,
        film=content and base64.b64encode(content).decode("ascii"),
        picture=still and base64.b64encode(still).decode("ascii"),
    )


def embedded(path: Path, budget: float, folder: Path) -> bytes | None:
    """Return the film with at most `budget` bytes; None if it cannot be made that small.

    Args:
        budget: maximum size [bytes].
    """
    if path.stat().st_size <= budget:
        return path.read_bytes()
    for width, quality in QUALITIES:
        smaller = folder / f"{width}_{quality}.mp4"
        options = ["-vf", f"scale='min({width},iw)':-2", "-c:v", "libx264", "-preset", "medium", "-crf", str(quality)]
        if _encoded(path, smaller, options) and smaller.stat().st_size <= budget:
            return smaller.read_bytes()
    return None


def _still(path: Path, folder: Path) -> bytes | None:
    """Return a picture of the film as JPEG; None if there is none at this time."""
    picture = folder / "still.jpg"
    options = ["-ss", f"{STILL_S:g}", "-frames:v", "1", "-vf", "scale='min(960,iw)':-2", "-q:v", "5"]
    return picture.read_bytes() if _encoded(path, picture, options) and picture.is_file() else None


def _encoded(path: Path, output: Path, options: list[str]) -> bool:
    """Encode a file, with the same bytes each time; return True if it worked."""
    try:
        program = find_ffmpeg()
    except MissingPartError:
        return False
    exact = ["-threads", "1", "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-an"]
    command = [program, "-nostdin", "-loglevel", "error", "-i", str(path), *options, *exact, str(output)]
    try:
        result = subprocess.run(command, capture_output=True, timeout=TIMEOUT, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return result.returncode == 0
