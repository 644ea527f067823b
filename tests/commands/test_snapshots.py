"""What a command prints is what its snapshot shows: help, refusals, short results."""

import pytest

from tests.snapshots import changed, names
from vehicle.commands import COMMANDS


@pytest.mark.parametrize("name", names())
def test_texts_of_a_command(name, tmp_path):
    assert changed(name, tmp_path) == [], f"if the new text is right: python -m tests.snapshots {name}"
    assert list(tmp_path.iterdir()) == []  # nothing that is refused writes a file


def test_every_command_has_a_snapshot():
    assert names() == sorted(COMMANDS)
