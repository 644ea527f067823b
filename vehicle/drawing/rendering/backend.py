"""Check of the requirements of a film before a run: an off-screen OpenGL library and an ffmpeg with H.264.

`choose_backend` must be called before `import mujoco`: MuJoCo reads MUJOCO_GL when it is imported, and PyOpenGL
selects one platform. `python -m vehicle.drawing.rendering.backend` prints the reason why films cannot be made.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import cache

from vehicle.errors import MissingPartError

BACKENDS = ("osmesa", "egl")
"""Backends in order of preference: OSMesa renders on the processor and gives the same picture on every machine."""

ENCODER = "libx264"
PATIENCE = 120.0
"""Maximum time [s] of a probe; importing MuJoCo and opening a context takes about one second."""

PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with mujoco.Renderer(model, 16, 16) as renderer:
    renderer.update_scene(data)
    assert renderer.render().any()
"""


@cache
def probe(backend: str) -> str | None:
    """Render a tiny picture in a separate process, since a missing library may end the process.

    Args:
        backend: value of MUJOCO_GL.

    Returns:
        None if it works, else the last error line of the process.
    """
    environment = {**os.environ, "MUJOCO_GL": backend, "PYOPENGL_PLATFORM": backend}
    command = [sys.executable, "-c", PROBE]
    with tempfile.TemporaryDirectory() as folder:  # MuJoCo writes its log into the working folder
        try:
            done = subprocess.run(
                command, env=environment, cwd=folder, capture_output=True, text=True, timeout=PATIENCE, check=False
            )
        except subprocess.TimeoutExpired:
            return f"no answer within {PATIENCE:g} s"
    if done.returncode == 0:
        return None
    lines = [line for line in done.stderr.splitlines() if line.strip() and not line.startswith("Exception ignored")]
    return lines[-1].strip() if lines else f"ended with code {done.returncode}"


def choose_backend(probe: Callable[[str], str | None] = probe) -> str:
    """Choose the OpenGL backend and write it into MUJOCO_GL and PYOPENGL_PLATFORM.

    A working choice of the user comes first, then OSMesa, then EGL. If PyOpenGL is already loaded, only its platform
    can be used.

    Args:
        probe: function that returns None for a backend that works, otherwise the reason of its failure.

    Returns:
        "osmesa" or "egl".

    Raises:
        MissingPartError: neither works; names the package to install.
    """
    chosen = os.environ.get("MUJOCO_GL", "").strip().lower()
    candidates = [chosen] if chosen in BACKENDS else []
    candidates += [name for name in BACKENDS if name not in candidates]
    loaded = os.environ.get("PYOPENGL_PLATFORM", "")
    if "OpenGL" in sys.modules and loaded in BACKENDS:
        candidates = [loaded]
    reasons = {}
    for name in candidates:
        reason = probe(name)
        if reason is None:
            os.environ["MUJOCO_GL"] = os.environ["PYOPENGL_PLATFORM"] = name
            return name
        reasons[name] = reason
    failures = "; ".join(f"{name}: {reason}" for name, reason in reasons.items())
    raise MissingPartError(
        f"video: no off-screen OpenGL library works on this machine ({failures}). "
        "Install OSMesa, on Debian: apt-get install libosmesa6; or run without --video"
    )


def find_ffmpeg() -> str:
    """Find an ffmpeg program that encodes H.264: on PATH, else in the imageio-ffmpeg package.

    Returns:
        Path of the program.

    Raises:
        MissingPartError: no ffmpeg program with the encoder is installed.
    """
    programs = [path for path in (shutil.which("ffmpeg"), _bundled_ffmpeg()) if path is not None]
    for path in programs:
        if _encodes(path):
            return path
    problem = (
        f"found {', '.join(programs)} without the encoder {ENCODER}" if programs else "no ffmpeg program was found"
    )
    raise MissingPartError(
        f"video: {problem}. Install ffmpeg, on Debian: apt-get install ffmpeg, or the Python package imageio-ffmpeg; "
        "or run without --video"
    )


def _bundled_ffmpeg() -> str | None:
    try:
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return None


def _encodes(path: str) -> bool:
    """Return True if a program lists the encoder."""
    command = [path, "-hide_banner", "-encoders"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0 and ENCODER in done.stdout


def require_film() -> str:
    """Check everything that a film needs, before anything is simulated.

    Returns:
        The chosen OpenGL backend.

    Raises:
        MissingPartError: a part is missing; the message names the part and its installation.
    """
    find_ffmpeg()
    return choose_backend()


def film_available() -> str | None:
    """Return the reason why this machine cannot make films, or None if it can."""
    try:
        require_film()
    except MissingPartError as error:
        return str(error)
    return None


if __name__ == "__main__":
    raise SystemExit(film_available())
