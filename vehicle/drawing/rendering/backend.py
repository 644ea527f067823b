"""Requirements of a film: an off-screen OpenGL library and an ffmpeg with H.264, checked before a run.

Call `choose_backend` before `import mujoco`: MuJoCo reads MUJOCO_GL when it is imported, and PyOpenGL uses one platform
until the process ends. `python -m vehicle.drawing.rendering.backend` exits with 0 if films can be made, else it prints
the reason.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import cache

from vehicle.errors import MissingPartError

BACKENDS, REMEDY = (
    (("osmesa", "egl", "glfw"), "Install OSMesa (on Debian: apt-get install libosmesa6)")
    if sys.platform.startswith("linux")
    else (("glfw",), "Install the graphics driver")
)
"""OpenGL backends of MuJoCo, preferred ones first: OSMesa renders on the processor, the same picture on every machine;
EGL needs a driver, GLFW also a display; Windows and macOS have only this one. The second text is the remedy in the
message if no backend works."""

ENCODER = "libx264"
PATIENCE = 120.0
"""Maximum time of a probe [s]; importing MuJoCo and opening a context takes about one second."""

PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with mujoco.Renderer(model, 16, 16) as renderer:
    renderer.update_scene(data)
    assert renderer.render().any()
"""


def variables(backend: str) -> dict[str, str]:
    """Return the environment variables that select a backend; MuJoCo uses GLFW without PyOpenGL."""
    return {"MUJOCO_GL": backend} | ({} if backend == "glfw" else {"PYOPENGL_PLATFORM": backend})


@cache
def probe(backend: str) -> str | None:
    """Render a picture of 16 x 16 pixels in a new process, since a missing library may end the process.

    Returns:
        None if the backend works, else the last line of the error output.
    """
    environment = {**os.environ, **variables(backend)}
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
    """Choose the OpenGL backend, set MUJOCO_GL and PYOPENGL_PLATFORM, and return it.

    A working choice of the user comes first, then OSMesa, EGL, GLFW. If PyOpenGL is loaded already, only its platform
    can be used.

    Args:
        probe: function that returns None for a backend that works, else the reason.

    Raises:
        MissingPartError: no backend works; the message names the package to install.
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
            os.environ.update(variables(name))
            return name
        reasons[name] = reason
    failures = "; ".join(f"{name}: {reason}" for name, reason in reasons.items())
    raise MissingPartError(
        f"video: no off-screen OpenGL library works on this machine ({failures}). {REMEDY}; or run without --video"
    )


def find_ffmpeg() -> str:
    """Return the path of an ffmpeg program that encodes H.264: first on PATH, then in the imageio-ffmpeg package.

    Raises:
        MissingPartError: there is no ffmpeg, or no ffmpeg with the encoder.
    """
    programs = [path for path in (shutil.which("ffmpeg"), _bundled_ffmpeg()) if path is not None]
    for path in programs:
        if _encodes(path):
            return path
    fault = f"{', '.join(programs)} has no encoder {ENCODER}" if programs else "the program ffmpeg was not found"
    raise MissingPartError(
        f"video: {fault}. Install ffmpeg (on Debian: apt-get install ffmpeg) or the Python package imageio-ffmpeg, or "
        "run without --video"
    )


def _bundled_ffmpeg() -> str | None:
    try:
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return None


def _encodes(path: str) -> bool:
    """True if an ffmpeg program lists the encoder."""
    command = [path, "-hide_banner", "-encoders"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0 and ENCODER in done.stdout


def require_film() -> str:
    """Check ffmpeg and OpenGL before the simulation, and return the chosen OpenGL backend.

    Raises:
        MissingPartError: one of them is missing; the message says how to install it.
    """
    find_ffmpeg()
    return choose_backend()


def film_available() -> str | None:
    """Return the reason why this machine cannot make films; None if it can."""
    try:
        require_film()
    except MissingPartError as error:
        return str(error)
    return None


if __name__ == "__main__":
    raise SystemExit(film_available())
