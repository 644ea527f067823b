"""The committed MJCF files are those of the committed parameters, open anywhere and stand still."""

from __future__ import annotations

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

from vehicle.model.assembly.mjcf_files import mjcf_files
from vehicle.runs.car import Car
from vehicle.runs.output.model_files import write_mjcf
from vehicle.runs.output.written_files import MARKER

NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")
FOLDER = Path(__file__).resolve().parents[3] / "mjcf"


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    car = Car.load()
    return mjcf_files(car.vehicle, car.trimmed_body)


def same_file(committed: bytes, generated: bytes) -> bool:
    """Return whether two files are equal, but for the last of the six digits that MuJoCo writes.

    That digit depends on the processor: linear algebra libraries choose the order of their sums by its instruction set.
    """
    if committed == generated:
        return True
    try:
        texts = committed.decode(), generated.decode()
    except UnicodeDecodeError:
        return False
    numbers = [np.array(NUMBER.findall(text), dtype=float) for text in texts]
    words = [NUMBER.sub("", text) for text in texts]
    return words[0] == words[1] and np.allclose(numbers[0], numbers[1], rtol=2e-5, atol=1e-15)


def test_same_file_allows_the_last_digit_only():
    assert same_file(b'<a pos="-6.32979e-06 1"/>', b'<a pos="-6.32978e-06 1"/>')
    for other in (b'<a pos="-6.33e-06 1"/>', b'<a pos="-6.32979e-06 2"/>', b'<b pos="-6.32979e-06 1"/>', b"\xff"):
        assert not same_file(b'<a pos="-6.32979e-06 1"/>', other)


def test_committed_files_are_the_generated_ones(files):
    committed = {
        path.relative_to(FOLDER).as_posix(): path.read_bytes()
        for path in FOLDER.rglob("*")
        if path.is_file() and path.name not in ("README.md", MARKER)
    }
    assert len(files) > 50
    assert sorted(committed) == sorted(files), "run: python -m vehicle.mjcf --force"
    changed = [name for name, content in files.items() if not same_file(committed[name], content)]
    assert not changed, f"run: python -m vehicle.mjcf --force ({changed[:3]} differ)"


def test_scene_opens_and_stands_still_without_callbacks(files, tmp_path):
    write_mjcf(tmp_path, files)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start = data.xpos.copy()
    while data.time < 2.0:
        mujoco.mj_step(model, data)
    # MuJoCo's soft rows give way by some mm under the weight; then nothing moves any more.
    assert np.max(np.abs(data.xpos - start)) < 5e-3
    assert np.max(np.abs(data.qvel)) < 1e-6
    assert not any(warning.number for warning in data.warning)
    assert model.ngeom > 75, "every part is visible"


def test_the_file_alone_holds_the_element_constants(files, tmp_path):
    from vehicle.engines.simulation.law_arrays import law_names
    from vehicle.engines.simulation.row_layout import read_layout

    write_mjcf(tmp_path, files)
    own, built_model = mujoco.MjModel.from_xml_path(str(tmp_path / "car.xml")), Car.load().model.model
    loaded, built = read_layout(own), read_layout(built_model)
    assert law_names(own) == law_names(built_model) and loaded.row_count == built.row_count
    # MuJoCo writes six digits.
    np.testing.assert_allclose(loaded.bushings.stiffness, built.bushings.stiffness, rtol=1e-5)
    np.testing.assert_allclose(loaded.modes.node_shapes, built.modes.node_shapes, rtol=1e-5, atol=1e-9)
