"""A full disk is one error of each writer, also where the library reports it as late as it closes the file."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.full_disk import largest_file
from vehicle.drawing.rendering.backend import require_film
from vehicle.drawing.rendering.figure import saved_figure
from vehicle.drawing.rendering.film import write_film
from vehicle.errors import MissingPartError, OutputError
from vehicle.runs.output.folder import write_whole
from vehicle.runs.output.written_files import MARKER
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.formats import BY_NAME, WRITTEN, write_record
from vehicle.signals.formats.table import Record

SAMPLES = 20_000


def writer(name: str) -> Callable[[Path], object]:
    values = np.random.default_rng(1).normal(size=SAMPLES)
    entry = BY_NAME[name]
    if entry.table:
        record = Record(time=np.linspace(0.0, 0.01 * (SAMPLES - 1), SAMPLES), channels={"a": values}, units={"a": "m"})
        return lambda path: write_record(path, name, record, "frame")
    channel = Channel(name="a", values=values, unit="m", axis=uniform_axis(SAMPLES, 0.01, 0.0))
    write = entry.function("writer", "write")
    return lambda path: write(path, (channel,), "a record")


def draw(path: Path) -> None:
    with saved_figure(path, (6.0, 4.0), "", "") as figure:
        figure.subplots().plot(np.random.default_rng(1).normal(size=200))


def film(path: Path) -> None:
    frames = np.random.default_rng(1).integers(0, 255, (6, 120, 160, 3), dtype=np.uint8)
    write_film(path, frames, (120, 160))


WRITERS = {**{name: writer(name) for name in WRITTEN}, "png": draw, "svg": draw, "mp4": film}


@pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning"
)  # mediapy leaves the pipe of a dead ffmpeg
@pytest.mark.parametrize("ending", WRITERS)
def test_a_full_disk_is_one_error_and_the_old_file_stays(ending, tmp_path):
    if ending == "mp4":
        try:
            require_film()
        except MissingPartError as error:
            pytest.skip(str(error))
    path = tmp_path / f"time.{ending}"
    write_whole(path, WRITERS[ending])
    before = path.read_bytes()
    assert len(before) > 5000
    for size in (0, 100, 1000, len(before) // 2, len(before) - 1):
        with largest_file(size), pytest.raises(OutputError, match="cannot be written"):
            write_whole(path, WRITERS[ending])
        assert path.read_bytes() == before
        assert sorted(file.name for file in tmp_path.iterdir()) == [MARKER, path.name]
    write_whole(path, WRITERS[ending])
