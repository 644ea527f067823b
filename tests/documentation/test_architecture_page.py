"""The page of the architecture: its drawing is that of the script, and both name every package."""

import re

from tests.test_architecture import ROOT, WINGS
from tools.flow_drawing import BOXES, TARGET, drawing

PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_drawing_is_that_of_the_script():
    assert TARGET.read_text(encoding="utf-8") == drawing(), "run: python tools/flow_drawing.py"


def test_drawing_and_table_have_every_package():
    assert set(BOXES) == set(WINGS)
    rows = {
        row.split("|")[1].strip(" `/"): row.split("|")[2] for row in re.findall(r"^\| `\w+/` .*", PAGE, re.MULTILINE)
    }
    assert set(rows) == set(WINGS)
    for wing, rooms in WINGS.items():
        if rooms:
            assert sorted(re.findall(r"\w+", " ".join(BOXES[wing][4]))) == sorted(rooms)
            assert re.findall(r"\w+", rows[wing]) == list(rooms)
