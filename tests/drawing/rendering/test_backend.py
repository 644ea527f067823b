"""Choice of the OpenGL library and of ffmpeg, and what is said where one is missing."""

import os
import subprocess
import sys

import pytest

from vehicle.drawing.rendering import backend
from vehicle.errors import MissingPartError


@pytest.fixture(autouse=True)
def environment(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "")
    monkeypatch.setenv("PYOPENGL_PLATFORM", "")
    monkeypatch.delitem(sys.modules, "OpenGL", raising=False)


class Machine:
    """A probe of a machine on which some backends work; notes what it was asked."""

    def __init__(self, *working):
        self.working = working
        self.asked: list[str] = []

    def __call__(self, name):
        self.asked.append(name)
        return None if name in self.working else f"no {name} here"


@pytest.mark.parametrize(
    ("working", "wanted", "found", "asked"),
    [
        (("osmesa", "egl"), "", "osmesa", ["osmesa"]),
        (("egl",), "", "egl", ["osmesa", "egl"]),
        (("glfw",), "", "glfw", ["osmesa", "egl", "glfw"]),
        (("osmesa", "egl"), "EGL", "egl", ["egl"]),
        (("osmesa",), "egl", "osmesa", ["egl", "osmesa"]),
        (("osmesa",), "nonsense", "osmesa", ["osmesa"]),
    ],
)
def test_the_first_working_backend_is_chosen(monkeypatch, working, wanted, found, asked):
    monkeypatch.setenv("MUJOCO_GL", wanted)
    probe = Machine(*working)
    assert backend.choose_backend(probe) == os.environ["MUJOCO_GL"] == found and probe.asked == asked
    # PyOpenGL knows no platform glfw, and MuJoCo uses GLFW without it.
    assert os.environ["PYOPENGL_PLATFORM"] == ("" if found == "glfw" else found)


def test_every_backend_is_one_of_mujoco():
    """The message of a machine without it is of the library, not of an unknown name."""
    for name in backend.BACKENDS:
        assert "invalid value for environment variable" not in (backend.probe(name) or "")


def test_a_loaded_opengl_decides(monkeypatch):
    monkeypatch.setitem(sys.modules, "OpenGL", sys)
    monkeypatch.setenv("PYOPENGL_PLATFORM", "egl")
    probe = Machine("osmesa", "egl")
    assert backend.choose_backend(probe) == "egl"
    assert probe.asked == ["egl"]


def test_nothing_works_names_the_package():
    with pytest.raises(MissingPartError, match=r"no osmesa here.*no egl here.*no glfw here.*libosmesa6") as caught:
        backend.choose_backend(Machine())
    assert caught.value.exit_code == 5
    assert os.environ["MUJOCO_GL"] == ""  # nothing is set where nothing works


def test_a_backend_that_mujoco_refuses_gives_its_reason():
    assert "MUJOCO_GL" in (backend.probe("nonsense") or "")


def test_a_probe_leaves_nothing_in_the_folder_of_the_user(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # MuJoCo writes its log of warnings into the working folder.
    monkeypatch.setattr(backend, "PROBE", "open('MUJOCO_LOG.TXT', 'w').close(); raise RuntimeError('no context')")
    assert backend.probe("a log") == "RuntimeError: no context"
    assert list(tmp_path.iterdir()) == []


def program(path, answer):
    path.write_text(f"#!/bin/sh\necho '{answer}'\n", encoding="ascii")
    path.chmod(0o755)
    return str(path)


def test_the_ffmpeg_on_the_path_comes_first(tmp_path, monkeypatch):
    own = program(tmp_path / "ffmpeg", " V....D libx264  H.264")
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    assert backend.find_ffmpeg() == own


def test_an_ffmpeg_without_the_encoder_is_passed_over(tmp_path, monkeypatch):
    program(tmp_path / "ffmpeg", " V....D mpeg4")
    bundled = program(tmp_path / "bundled", " V....D libx264  H.264")
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr(backend, "_bundled_ffmpeg", lambda: bundled)
    assert backend.find_ffmpeg() == bundled


@pytest.mark.parametrize("present", [False, True])
def test_no_ffmpeg_names_both_remedies(tmp_path, monkeypatch, present):
    path = program(tmp_path / "ffmpeg", "no encoders") if present else None
    monkeypatch.setattr("shutil.which", lambda name: path)
    monkeypatch.setattr(backend, "_bundled_ffmpeg", lambda: None)
    found = f"{path}.*libx264" if present else "ffmpeg.*not found"
    with pytest.raises(MissingPartError, match=f"{found}.*apt-get install ffmpeg.*imageio-ffmpeg"):
        backend.find_ffmpeg()


def test_reason_why_no_film_can_be_made(monkeypatch):
    def missing():
        raise MissingPartError("no library")

    monkeypatch.setattr(backend, "find_ffmpeg", lambda: "ffmpeg")
    monkeypatch.setattr(backend, "choose_backend", lambda: "osmesa")
    assert backend.film_available() is None
    monkeypatch.setattr(backend, "choose_backend", missing)
    assert backend.film_available() == "no library"


def test_checking_imports_neither_mujoco_nor_opengl():
    code = (
        "import sys; from vehicle.drawing.rendering import backend; backend.choose_backend(lambda name: None); "
        "assert not {'mujoco', 'OpenGL', 'mediapy'} & set(sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
