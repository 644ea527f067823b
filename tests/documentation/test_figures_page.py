"""The list of ride figures in the documentation is the catalogue; `python -m tests.documentation.test_figures_page`."""

from pathlib import Path

from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.figures.chosen_figure import form_of

PAGE = Path(__file__).resolve().parents[2] / "docs" / "howto" / "figures.md"
HEADS = "| name | is | better |"
BAR = r"\|"
"""A bar in a cell of a table."""

BETTER = {"less": "less", "more": "more", "": "-"}


def rows():
    """Return the rows of the table, in the order of the catalogue."""
    return [
        f"| `{form_of(name)}` | {figure.meaning.replace('|', BAR)} | {BETTER[figure.better]} |"
        for name, figure in FIGURES.items()
        if not name.startswith("order_")
    ]


def table_of(text):
    """Return the rows of the table in the text of the page."""
    lines = text.splitlines()
    first = lines.index(HEADS) + 2
    return lines[first : first + lines[first:].index("")]


def test_the_page_lists_the_catalogue():
    assert table_of(PAGE.read_text(encoding="utf-8")) == rows(), "run python -m tests.documentation.test_figures_page"


if __name__ == "__main__":
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(text.replace("\n".join(table_of(text)), "\n".join(rows())), encoding="utf-8")
