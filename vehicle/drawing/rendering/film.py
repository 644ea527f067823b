"""Film of a run: replay of the recording with exaggerated motion, without simulation."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

from vehicle.drawing.rendering.backend import choose_backend, find_ffmpeg
from vehicle.drawing.rendering.crew import Drawable, drawn_by
from vehicle.drawing.rendering.excerpt import FPS
from vehicle.drawing.rendering.layout import Layout, Picture, TwoCars
from vehicle.drawing.rendering.pair_shot import PairShot
from vehicle.drawing.rendering.recorded_run import RecordedRun
from vehicle.drawing.rendering.shot import Cut, Shot, Take
from vehicle.errors import OutputError

QUALITY = 20
"""Constant rate factor of the encoder; about 18 is visually lossless, 23 is the default."""

PRESET = "veryfast"
"""Preset of the encoder: for cars on rigs as small files as the default at the same quality, in 0.4 of the time."""


def film(
    run: RecordedRun,
    path: Path,
    take: Take | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    jobs: int = 1,
    progress: Callable[[float], None] | None = None,
) -> Cut:
    """Write a film of a run as H.264 in MP4.

    Args:
        run: the run.
        path: MP4 file.
        take: settings of the film; by default, ten seconds with the largest motion, or a single event, in slow motion
            where a wheel moves fast.
        size: width and height [pixel], even.
        jobs: number of drawing processes, which does not change the film. A script with several processes needs an
            `if __name__ == "__main__":` block.
        progress: called with the finished fraction.

    Returns:
        The excerpt in the film.

    Raises:
        ConfigurationError: an option is out of range.
        MissingPartError: an off-screen OpenGL library or ffmpeg is missing.
        OutputError: the file cannot be written.
    """
    return _written(Shot(run, Layout(width=size[0], height=size[1]), take or Take()), path, jobs, progress)


def pair_film(
    runs: Mapping[str, RecordedRun],
    difference: str,
    path: Path,
    take: Take | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    jobs: int = 1,
    progress: Callable[[float], None] | None = None,
) -> Cut:
    """Write a film of two runs of one input, side by side.

    Args:
        runs: name to run, two; the first is the reference.
        difference: what differs, in a line.
        path, take, size, jobs, progress: see `film`.

    Returns:
        The excerpt in the film.

    Raises:
        ConfigurationError: the inputs or lengths of the runs differ, or an option is out of range.
        MissingPartError, OutputError: see `film`.
    """
    shot = PairShot(runs, difference, TwoCars(width=size[0], height=size[1]), take or Take())
    return _written(shot, path, jobs, progress)


def _written(shot: Drawable, path: Path, jobs: int, progress: Callable[[float], None] | None) -> Cut:
    """Write the film of a shot, and return its excerpt."""
    backend = choose_backend()

    def counted() -> Iterator[Picture]:
        for number, frame in enumerate(drawn_by(jobs, shot, backend), start=1):
            yield frame
            if progress is not None:
                progress(number / shot.cut.frames)

    write_film(path, counted(), (shot.layout.height, shot.layout.width))
    return shot.cut


def write_film(path: Path, frames: Iterable[Picture], shape: tuple[int, int]) -> None:
    """Write frames as H.264 in MP4, whole or not at all.

    Args:
        path: MP4 file.
        frames: pictures, (height, width, 3) each.
        shape: height and width [pixel], even.

    Raises:
        MissingPartError, OutputError: see `film`.
    """
    import mediapy

    mediapy.set_ffmpeg(find_ffmpeg())
    try:
        path.open("wb").close()
        with mediapy.VideoWriter(
            path,
            shape=shape,
            fps=FPS,
            codec="h264",
            crf=QUALITY,
            encoded_format="yuv420p",
            ffmpeg_args=f"-preset {PRESET}",
        ) as writer:
            for frame in frames:
                writer.add_image(frame)
    except BaseException as error:
        path.unlink(missing_ok=True)
        # imageio raises errors of ffmpeg as a RuntimeError with this text.
        if isinstance(error, OSError) or str(error).startswith("Error writing"):
            raise OutputError(f"{path}: the video cannot be written: {' '.join(str(error).split())}") from None
        raise
