"""Film in a report: as it is if it is small, encoded again if it is large, and left out with a sentence otherwise."""

import base64
import dataclasses
import re

import numpy as np
import pytest

from tests.drawing.frames import frames
from vehicle.drawing.rendering.backend import film_available
from vehicle.runs.report import film_section
from vehicle.runs.report.film_section import BUDGET, QUALITIES, embedded, film
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.pair_film import film_of_two

pytest.importorskip("mediapy", reason="mediapy is missing: pip install 'vehicle-on-shaker[video]'")


@pytest.fixture(scope="module")
def large_film(tmp_path_factory):
    """A film of two seconds in which a square moves over noise, and noise is hard to compress."""
    from vehicle.drawing.rendering.film import write_film

    path, generator = tmp_path_factory.mktemp("film") / "run.mp4", np.random.default_rng(1)
    noise = generator.integers(0, 255, (60, 120, 160, 3)).astype(np.uint8)
    for number, frame in enumerate(noise):
        frame[40:80, 2 * number : 2 * number + 40] = 255
    write_film(path, iter(noise), (120, 160))
    return path


def test_a_small_film_is_embedded_as_it_is(large_film, tmp_path):
    assert embedded(large_film, large_film.stat().st_size, tmp_path) == large_film.read_bytes()


def test_a_large_film_is_encoded_again_with_all_frames_and_the_same_bytes(large_film, tmp_path):
    budget = 0.7 * large_film.stat().st_size
    folders = [tmp_path / name for name in ("first", "second")]
    for folder in folders:
        folder.mkdir()
    first, second = (embedded(large_film, budget, folder) for folder in folders)
    assert first is not None and first == second and len(first) <= budget
    (tmp_path / "again.mp4").write_bytes(first)
    pictures = frames(tmp_path / "again.mp4", (160, 120), "gray")
    assert len(pictures) == 60
    assert pictures[30][50:70, 65:95].mean() > 200 > pictures[30][50:70, 5:30].mean(), "the square has moved"


def test_the_report_has_the_film_a_picture_for_paper_or_a_sentence(reported, large_film, monkeypatch):
    run = read_run(reported.folder)
    summary = dataclasses.replace(run.summary, files={**run.summary.files, "video": str(large_film)})
    run = dataclasses.replace(run, summary=summary)
    section = film(run)
    assert section is not None
    content = re.search(r'src="data:video/mp4;base64,([^"]+)"', section)
    assert content is not None and len(base64.b64decode(content[1])) <= BUDGET
    assert 'class="only-paper"' in section
    monkeypatch.setattr(film_section, "QUALITIES", QUALITIES[-1:])
    left_out = film(run, share=1e-5)
    assert left_out is not None and "is too large for this page" in left_out and "base64" not in left_out
    assert film(read_run(reported.folder)) is None


@pytest.mark.render
def test_two_saved_runs_make_a_film(reported, tmp_path):
    """A run beside itself: both halves are one picture, and the new simulation has the curves of the saved run."""
    if (reason := film_available()) is not None:
        pytest.skip(reason)
    path = tmp_path / "both.mp4"
    said = film_of_two([reported.folder] * 2, path, {"start": 0.5, "duration": 0.1, "slow": 1.0}, size=(320, 180))
    assert said.startswith("0.50 to 0.57 s, both runs simulated again by the engine mujoco; its curves differ by ")
    share = re.search(r"differ by ([\d.]+) %", said)
    assert share is not None and float(share[1]) < 5.0, "the saved run is of the reduced engine, for small rotations"
    video = frames(path, (320, 180))
    assert len(video) == 3
    car = video[:, 70:140]
    assert np.abs(car[:, :, 4:156] - car[:, :, 164:316]).mean() < 3.0 < car[0].std()
