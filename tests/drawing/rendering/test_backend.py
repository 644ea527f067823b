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


def test_osmesa_is_preferred():
    probe = Machine("osmesa", "egl")
    assert backend.choose_backend(probe) == "osmesa"
    assert probe.asked == ["osmesa"]
    assert os.environ["MUJOCO_GL"] == os.environ["PYOPENGL_PLATFORM"] == "osmesa"


def test_egl_where_osmesa_is_missing():
    assert backend.choose_backend(Machine("egl")) == "egl"
    assert os.environ["MUJOCO_GL"] == "egl"


def test_glfw_where_the_other_two_are_missing():
    probe = Machine("glfw")
    assert backend.choose_backend(probe) == "glfw" and probe.asked == ["osmesa", "egl", "glfw"]
    assert os.environ["MUJOCO_GL"] == "glfw"
    assert os.environ["PYOPENGL_PLATFORM"] == "", "PyOpenGL knows no such platform, and MuJoCo uses GLFW without it"


def test_every_backend_is_one_of_mujoco():
    """The message of a machine without it is of the library, not of an unknown name."""
    for name in backend.BACKENDS:
        assert "invalid value for environment variable" not in (backend.probe(name) or "")


def test_a_working_choice_of_the_user_is_kept(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "EGL")
    assert backend.choose_backend(Machine("osmesa", "egl")) == "egl"


def test_a_choice_that_does_not_work_is_replaced(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "egl")
    assert backend.choose_backend(Machine("osmesa")) == "osmesa"


def test_an_invalid_choice_is_replaced(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "nonsense")
    assert backend.choose_backend(Machine("osmesa")) == "osmesa"


def test_a_loaded_opengl_decides(monkeypatch):
    monkeypatch.setitem(sys.modules, "OpenGL", sys)
    monkeypatch.setenv("PYOPENGL_PLATFORM", "egl")
    probe = Machine("osmesa", "egl")
    assert backend.choose_backend(probe) == "egl"
    assert probe.asked == ["egl"]


def test_nothing_works_names_the_package():
    with pytest.raises(MissingPartError) as caught:
        backend.choose_backend(Machine())
    assert str(caught.value) == (
        "video: no off-screen OpenGL library works on this machine (osmesa: no osmesa here; egl: no egl here; "
        "glfw: no glfw here). "
        "Install OSMesa, on Debian: apt-get install libosmesa6; or run without --video"
    )
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
    found = f"{path} has no encoder libx264" if present else "the program ffmpeg was not found"
    with pytest.raises(MissingPartError) as caught:
        backend.find_ffmpeg()
    assert str(caught.value) == (
        f"video: {found}. Install ffmpeg, on Debian: apt-get install ffmpeg, or the Python package imageio-ffmpeg; "
        "or run without --video"
    )


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
