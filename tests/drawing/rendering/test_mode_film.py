"""A mode as a film: its motion against MuJoCo's own kinematics, its cycles, and what the command refuses."""

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.drawing.frames import frames
from vehicle.commands import modes as command
from vehicle.drawing.rendering import backend, mode_film, mode_motion
from vehicle.drawing.rendering.layout import OneView
from vehicle.drawing.rendering.mode_film import ModeShot
from vehicle.drawing.rendering.mode_motion import ModeMotion
from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.runs.car import Car
from vehicle.runs.car.main_mode import nearest

SMALL = 1e-5
"""Amplitude [m, rad] of the mode that is compared; the second order is SMALL of it."""


@pytest.fixture(scope="module")
def modes(car):
    own = Car.load()
    own.model = car  # built once for all tests of films
    return own.modes()


@pytest.fixture
def few_frames(monkeypatch):
    for module in (mode_film, mode_motion):
        monkeypatch.setattr(module, "PERIOD", 4)


@pytest.mark.parametrize("phase", [0.0, 0.7, 2.5])
def test_a_mode_moves_the_bodies_as_mujoco_does(stage, modes, phase):
    for mode in (modes[4], modes[14]):
        shape = SMALL * mode.shape / np.abs(mode.shape).max()
        motion = ModeMotion(stage, shape)
        data = mujoco.MjData(stage)
        mujoco.mj_integratePos(stage, data.qpos, np.real(shape * np.exp(1j * phase)), 1.0)
        mujoco.mj_kinematics(stage, data)
        state = motion.at(phase)
        turned = data.xmat.reshape(-1, 3, 3) @ motion.orientation.transpose(0, 2, 1)
        np.testing.assert_allclose(state.translation, data.xpos - motion.position, atol=50 * SMALL**2)
        np.testing.assert_allclose(state.rotation, Rotation.from_matrix(turned).as_rotvec(), atol=50 * SMALL**2)
        assert np.abs(state.translation).max() > 0.01 * SMALL
        columns = stage.jnt_qposadr[motion.modal]
        np.testing.assert_allclose(state.modal, data.qpos[columns], atol=1e-15)


@pytest.mark.parametrize("number", [4, 14])
def test_the_farthest_point_moves_as_the_heading_says(car, modes, few_frames, number):
    shot = ModeShot(car, modes[number], OneView(width=320, height=180))
    wire = car_wireframe(car)
    nodes = len(shot.cycle.wireframe.rest)
    moved = wire.displacement(modes[number].shape)
    share = np.linalg.norm(moved, axis=1) / np.linalg.norm(moved, axis=1).max()
    # Of a node at its two quadratures: |Re|^2 + |Im|^2 is the square of its amplitude.
    drawn = [shot.cycle.wireframe.displacement(shot.cycle.states[frame]) for frame in (0, 1)]
    np.testing.assert_allclose(np.hypot(*drawn), 1e-3 * share[:nodes], rtol=1e-3, atol=1e-6)
    assert shot.caption.heading[0].startswith(f"{modes[number].frequency:.2f} Hz, damping ratio ")
    assert "moves 1 mm, exaggerated 100 times" in shot.caption.heading[2]


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_the_cycles_of_the_film_join(car, modes, few_frames, tmp_path):
    path = tmp_path / "mode.mp4"
    fractions: list[float] = []
    mode_film.mode_film(car, modes[4], path, size=(320, 180), progress=fractions.append)
    video = frames(path, (320, 180))
    assert len(video) == 12 and fractions == [0.25, 0.5, 0.75, 1.0]
    again, half = (np.abs(video[frame] - video[0]) for frame in (8, 2))
    assert again.mean() < 0.2 * half.mean() and half.max() > 50  # the code is not without loss


def test_the_nearest_mode_is_taken(modes):
    own = [mode.frequency for mode in modes]
    assert nearest(modes, own[3] + 0.4 * (own[4] - own[3])) is modes[3]
    assert nearest(modes, 500.0) is modes[-1]
    growing: Any = SimpleNamespace(frequency=28.0, grows=True)
    assert nearest([*modes, growing], 28.0) is not growing
    with pytest.raises(ConfigurationError, match="has no mode up to 60 Hz"):
        nearest([growing], 28.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--video"], "--video: the mode is missing; give its frequency, for example --animate 28"),
        (["--animate", "28"], "--animate 28: makes a video only with --video; add --video [FILE.mp4]"),
        (["--animate", "0", "--video"], "--animate 0: must be above 0"),
        (["--animate=-3", "--video"], "--animate -3: must be above 0"),
        (["--animate", "nan", "--video"], "--animate nan: must be above 0"),
        (["--animate", "28", "--video", "mode.avi"], "--video mode.avi: must end in .mp4; set FILE.mp4"),
    ],
)
def test_what_cannot_be_filmed_is_refused(capsys, options, message):
    assert command.main(options) == 2
    assert message in capsys.readouterr().err


def test_a_film_that_is_there_stays_without_force(tmp_path, capsys):
    path = tmp_path / "mode.mp4"
    path.write_bytes(b"mine")
    assert command.main(["--animate", "28", "--video", str(path)]) == 2
    assert "exists; give --force to replace it" in capsys.readouterr().err
    assert path.read_bytes() == b"mine"


def test_a_machine_without_films_is_told_before_anything_is_computed(monkeypatch, capsys):
    def missing():
        raise MissingPartError("video: no off-screen OpenGL library works on this machine")

    monkeypatch.setattr(backend, "require_film", missing)
    monkeypatch.setattr(Car, "load", None)
    assert command.main(["--animate", "28", "--video"]) == 5
    assert "no off-screen OpenGL library" in capsys.readouterr().err


@pytest.mark.usefixtures("film_machine")
def test_the_command_names_the_film_and_its_mode(tmp_path, monkeypatch, capsys, car):
    shown = []

    def written(car, mode, path, progress):
        shown.append(mode)
        path.touch()

    monkeypatch.setattr(mode_film, "mode_film", written)
    monkeypatch.setattr(Car, "model", car)
    monkeypatch.chdir(tmp_path)
    assert command.main(["--animate", "400", "--video"]) == 0
    assert f"mode at {shown[0].frequency:.3f} Hz, the nearest to 400 Hz" in capsys.readouterr().out
    assert [path.name for path in (tmp_path / "runs").glob("*.mp4")] == [f"mode_{shown[0].frequency:.2f}_hz.mp4"]
