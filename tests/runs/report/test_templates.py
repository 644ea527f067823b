"""Templates of the pages: values are escaped, a forgotten value is an error, every template is used."""

import re
from pathlib import Path

import pytest
from jinja2 import UndefinedError

import vehicle
from vehicle.runs.report import page
from vehicle.runs.report.markup import MANY, templates

PACKAGE = Path(vehicle.__file__).parent


def test_values_are_escaped():
    text = templates(page.__file__)("answer", texts=["a <b> & c"], figure="<svg>")
    assert text == '<p class="answer">a &lt;b&gt; &amp; c</p>&lt;svg&gt;\n'


def test_a_forgotten_value_is_an_error():
    with pytest.raises(UndefinedError, match="'figure' is undefined"):
        templates(page.__file__)("answer", texts=[])


@pytest.mark.parametrize("rows, is_folded", [(MANY, False), (MANY + 1, True)])
def test_a_long_table_is_folded(rows, is_folded):
    text = templates(page.__file__)("run", tables={}, default="focus", changed=[("path", "N", "1", "2")] * rows)
    assert ("<details>" in text, "table whole" in text) == (is_folded, not is_folded)
    assert text.count('<td class="number">') == 2 * rows


def test_every_template_is_filled_by_a_module_beside_it():
    files = sorted(PACKAGE.rglob("templates/*.html"))
    assert len(files) > 20, "the templates were not found"
    for file in files:
        code = "".join(path.read_text("utf-8") for path in file.parents[1].glob("*.py"))
        used = rf'fill\(\s*"{file.stem}"|"{file.name}"|Part\("[^"]*", "[^"]*", "{file.stem}"'
        assert re.search(used, code), f"{file} is not used"
