"""Results of the quick study of a module, and a car that is quick to build, for the studies on roads."""

from importlib import import_module
from pathlib import Path

import pytest

STUDIES = Path(__file__).resolve().parents[2] / "scenarios"

RIGID = """
base = "focus_road_seated"
name = "rigid"
[body]
flexible = false
attachment_flexibility = false
"""


@pytest.fixture(scope="module")
def rigid_car(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Vehicle file of a car with an occupant on a rigid body."""
    path = tmp_path_factory.mktemp("car") / "rigid.toml"
    path.write_text(RIGID, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def results(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of the quick study that the name of the module says."""
    study = request.path.stem.removeprefix("test_")
    module = f"scenarios.{study}.__main__" if (STUDIES / study).is_dir() else f"scenarios.{study}"
    folder = tmp_path_factory.mktemp("study") / study
    assert import_module(module).main(["--output", str(folder), "--quick"]) == 0
    return folder
