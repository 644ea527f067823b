"""A car that is quick to build, for the studies on roads."""

from pathlib import Path

import pytest

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
