"""The committed MJCF files are those of the committed parameters; plain MuJoCo shows the car and does not move it."""

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


def test_committed_files_are_the_generated_ones(files):
    committed = {
        path.relative_to(FOLDER).as_posix(): path.read_bytes()
        for path in FOLDER.rglob("*")
        if path.is_file() and path.name not in ("README.md", MARKER)
    }
    assert len(files) > 50
    assert sorted(committed) == sorted(files), "run: python -m vehicle mjcf --force"
    changed = [name for name, content in files.items() if not same_file(committed[name], content)]
    assert not changed, f"run: python -m vehicle mjcf --force ({changed[:3]} differ)"


def test_plain_mujoco_refuses_the_model_and_names_the_reason(files, tmp_path):
    """Driven without the callbacks, its knuckle moved by 0.100 for 0.594 m/s2 and had its peak at 49.5 for 27.1 Hz."""
    write_mjcf(tmp_path, files)
    for read in (mujoco.MjModel.from_xml_path, mujoco.MjSpec.from_file):
        with pytest.raises(
            ValueError, match=r"plugin vehicle\.force_laws not found\nElement 'plugin', line (\d+)"
        ) as refused:
            read(str(tmp_path / "car.xml"))
    line = int(str(refused.value).split("line ")[1].split()[0])
    lines = files["car.xml"].decode().splitlines()
    assert "force_laws" in lines[line - 1]
    before = " ".join(" ".join(lines[:line]).split())
    assert (
        "MuJoCo alone cannot simulate this car, because its force laws are in the program that wrote the "
        "file; without them"
    ) in before


def test_nothing_moves_in_the_scene(files, tmp_path):
    """It shows every part at its place in the model, and has no coordinate, mass, force or plate to drive."""
    write_mjcf(tmp_path, files)
    scene = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    model = mujoco.MjModel.from_xml_path(str(without_extension(tmp_path)))
    assert (scene.nq, scene.nv, scene.nu, scene.neq, scene.nmocap, scene.nsensor, scene.ntendon) == 7 * (0,)
    assert model.nv > 50 and scene.nbody == model.nbody and scene.ngeom == model.ngeom + 1 > 75
    assert scene.body_mass.sum() == 0.0
    states = []
    for each in (scene, model):
        data = mujoco.MjData(each)
        mujoco.mj_kinematics(each, data)
        names = [model.geom(index).name for index in range(model.ngeom)]
        states.append([np.r_[data.geom(name).xpos, data.geom(name).xmat] for name in names])
    np.testing.assert_allclose(states[0], states[1], atol=1e-12)


def without_extension(folder: Path) -> Path:
    """Write the model of a folder of generated files so that plain MuJoCo reads it."""
    text = (folder / "car.xml").read_text(encoding="utf-8")
    path = folder / "plain.xml"
    path.write_text(re.sub(r"<extension>.*</extension>", "", text, flags=re.DOTALL), encoding="utf-8")
    return path


def test_the_file_alone_holds_the_element_constants(files, tmp_path):
    from vehicle.engines.simulation.law_arrays import law_names
    from vehicle.engines.simulation.row_layout import read_layout

    write_mjcf(tmp_path, files)
    own, built_model = mujoco.MjModel.from_xml_path(str(without_extension(tmp_path))), Car.load().model.model
    loaded, built = read_layout(own), read_layout(built_model)
    assert law_names(own) == law_names(built_model) and loaded.row_count == built.row_count
    # MuJoCo writes six digits.
    np.testing.assert_allclose(loaded.bushings.stiffness, built.bushings.stiffness, rtol=1e-5)
    np.testing.assert_allclose(loaded.modes.node_shapes, built.modes.node_shapes, rtol=1e-5, atol=1e-9)
