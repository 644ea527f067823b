"""A film of a fabricated recording, and the frame around it."""

import subprocess
from typing import Any

import mujoco
import numpy as np
import pytest
from matplotlib.figure import Figure

from tests.drawing.rendering.conftest import FakeCar, FakeRun, fabricated
from vehicle.drawing.rendering.backend import choose_backend, find_ffmpeg
from vehicle.drawing.rendering.crew import drawn_by
from vehicle.drawing.rendering.film import film
from vehicle.drawing.rendering.layout import Layout
from vehicle.drawing.rendering.overlay import SLIP_COLOUR, STICK_COLOUR
from vehicle.drawing.rendering.plots import plot_time
from vehicle.drawing.rendering.shot import Shot, Take, traces
from vehicle.errors import ConfigurationError, OutputError
from vehicle.runs.car import Car


def shot(run, **options):
    return Shot(run, Layout(width=320, height=180), Take(**{"duration": 0.2, "slow": 1.0, **options}))


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_film_is_playable(run, tmp_path):
    path = tmp_path / "film.mp4"
    fractions: list[float] = []
    cut = film(run, path, Take(duration=0.2, slow=1.0), size=(320, 180), progress=fractions.append)
    done = subprocess.run(
        [find_ffmpeg(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True
    )
    stream = next(line for line in done.stderr.decode().splitlines() if "Stream #0:0" in line)
    for word in ("h264", "yuv420p", "320x180", "30 fps"):
        assert word in stream
    video = np.frombuffer(done.stdout, dtype=np.uint8).reshape(-1, 180, 320, 3)
    assert len(video) == 6
    assert fractions == pytest.approx([1 / 6, 2 / 6, 3 / 6, 4 / 6, 5 / 6, 1.0])
    assert cut.frames == 6
    # Away from what is written on them the pictures show a car that moves, sky above and dark bed plate below.
    car, sky, bed = video[:, 40:100, 60:200], video[:, 30:38, 198:220], video[:, 106:120, 75:110]
    assert car[0].std() > 15.0
    assert np.abs(car[0].astype(int) - car[3].astype(int)).max() > 30
    assert sky.mean() > 180.0 > 110.0 > bed.mean()
    for get in (mujoco.get_mjcb_control, mujoco.get_mjcb_act_bias, mujoco.get_mjcb_passive):
        assert get() is None


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_a_frame_depends_on_the_recording_alone(run):
    first, second = (next(iter(shot(run, start=0.1).frames(choose_backend()))) for _ in range(2))
    np.testing.assert_array_equal(first, second)


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_an_unwritable_film_is_an_output_error(run, tmp_path):
    path = tmp_path / "missing" / "film.mp4"
    with pytest.raises(OutputError, match=r"film\.mp4: "):
        film(run, path, Take(duration=0.1, slow=1.0), size=(320, 180))
    assert not path.exists()


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_an_interrupted_film_leaves_nothing_behind(run, tmp_path):
    def interrupt(fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        film(run, tmp_path / "film.mp4", Take(duration=0.1, slow=1.0), size=(320, 180), progress=interrupt)
    assert list(tmp_path.iterdir()) == []


def test_slow_motion_shows_less_of_the_record_in_as_many_frames(run):
    usual, slow = shot(run, start=0.05).cut, shot(run, start=0.05, slow=4.0).cut
    assert (usual.frames, slow.frames) == (6, 6)
    assert slow.end - slow.start == pytest.approx((usual.end - usual.start) / 4.0)


def test_a_short_record_gives_a_short_film(run):
    assert shot(run, start=0.2, duration=10.0).cut.frames == 3  # 0.1 s at 30 Hz


def test_the_excerpt_lies_where_the_damper_works(run):
    cut = shot(run, duration=0.1).cut
    assert cut.start >= 0.15 and cut.reason == "most damper motion"


def test_the_chosen_exaggeration_makes_motion_visible(run):
    automatic = shot(run).cut.exaggeration
    assert 2.0 < automatic <= 1000.0
    assert shot(run, exaggeration=12.5).cut.exaggeration == 12.5


@pytest.mark.parametrize(
    ("options", "found"),
    [
        ({"start": 0.3}, r"start: .*0\.3 s, .*0 to 0\.3 s"),
        ({"start": -1.0}, "start: .*-1 s"),
        ({"duration": 0.0}, "duration: .*0 s"),
        ({"duration": np.nan}, "duration: .*nan s"),
        ({"slow": 0.5}, r"slow motion: .*0\.5.*1"),
        ({"exaggeration": -3.0}, "exaggeration: .*-3"),
        ({"size": (1281, 720)}, "1281 x 720.*1282 x 720"),
        ({"size": (160, 90)}, "160 x 90.*320 x 180"),
    ],
)
def test_options_out_of_range_are_refused(run, options, found):
    with pytest.raises(ConfigurationError, match=f"video.*{found}"):
        Layout(width=options["size"][0], height=options["size"][1]) if "size" in options else shot(run, **options)


def test_lamps_show_the_slip_of_each_damper(run):
    prepared = shot(run, start=0.0, duration=0.3)
    blank = np.full((prepared.layout.view_height, 320, 3), 200, dtype=np.uint8)
    before, after = prepared.scene.lamps(0.10), prepared.scene.lamps(0.20)
    assert before == {"damper right": False, "damper left": False}
    assert after == {"damper right": True, "damper left": False}
    for lamps, colours in ((before, {STICK_COLOUR}), (after, {STICK_COLOUR, SLIP_COLOUR})):
        frame = prepared.overlay.draw(blank, 0.1, lamps)
        assert frame.shape == (180, 320, 3)
        plate = {tuple(pixel) for pixel in frame[:22, 255:].reshape(-1, 3).tolist()}
        assert {STICK_COLOUR, SLIP_COLOUR} & plate == colours


def test_lamps_traces_plots_and_heading_take_the_limit_of_each_damper(tmp_path, monkeypatch):
    saved: list[Any] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: saved.append(figure))
    lamps, bands = [], []
    for rear in (0.006, 0.03):
        model = Car.load("sedan", {"rear.damper.slip_velocity": rear}).model
        recording = fabricated(model, 0.3)
        for wheel in ("fl", "rr", "rl"):
            recording[f"damper_{wheel}_velocity"][:] = recording["damper_fr_velocity"]
        run = FakeRun(car=FakeCar(model=model), recording=recording)
        prepared = shot(run, start=0.0, duration=0.3)
        lamps.append(prepared.scene.lamps(0.20))
        bands.append([trace.band for trace in traces([prepared.scene], prepared.cut, 0.1, ("fr", "rr"))][-2:])
        limits = "6" if rear == 0.006 else "6 (front) and 30 (rear)"
        assert f"SLIP: above {limits} mm/s" in " ".join(prepared.overlay.heading)
        plot_time(tmp_path / "time.png", run)
        assert f"±{limits} mm/s" in " ".join(saved[-1].get_supxlabel().split())
        dashed = {
            axis.get_title(): {line.get_xdata()[0] for line in axis.get_lines() if line.get_linestyle() == "--"}
            for part in (saved[-1], *saved[-1].subfigs)
            for axis in part.axes
            if axis.get_title().endswith("damper") and "liveliest" not in axis.get_title()
        }
        assert dashed["front right damper"] == {-6.0, 6.0}
        assert dashed["rear right damper"] == {-1e3 * rear, 1e3 * rear}
    slips = {f"damper {corner}": True for corner in ("front right", "front left", "rear right", "rear left")}
    assert lamps == [slips, {name: "front" in name for name in slips}]
    assert bands == [[6.0, 6.0], [6.0, 30.0]]


def test_a_short_slip_between_two_frames_lights_the_lamp(run):
    prepared = shot(run, start=0.0, duration=0.3)
    # Slip begins at 0.15 s; the frame at 0.14 s stands for 0.123 to 0.157 s.
    assert prepared.scene.lamps(0.14)["damper right"]
    assert not prepared.scene.lamps(0.13)["damper right"]


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_the_film_does_not_depend_on_the_number_of_processes(run, monkeypatch):
    monkeypatch.setattr("vehicle.drawing.rendering.crew.WORTH_A_PROCESS", 2)
    alone, both = (list(drawn_by(jobs, shot(run), choose_backend())) for jobs in (1, 2))
    np.testing.assert_array_equal(alone, both)
