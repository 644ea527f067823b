"""Report of a sweep: its evaluation, and the command that repeats it."""

from collections.abc import Sequence

from markupsafe import Markup

from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing
from vehicle.studies.sweeps.evaluation import Evaluation
from vehicle.studies.sweeps.sweep_ranking import SweptCases

fill = templates(__file__)


def sweep_page(
    table: SweptCases,
    evaluation: Evaluation,
    name: str,
    *,
    caption: str,
    command: str = "",
    notes: Sequence[str] = (),
    author: str = "",
    project: str = "",
) -> str:
    """Return the report of a sweep as one HTML document.

    Args:
        table: table of the sweep.
        evaluation: evaluation of the table.
        name: name of the car.
        caption: tyres and evaluated span.
        command: command line that made the sweep; empty for a sweep in Python.
        notes: messages on side effects of the varied parameters and on the engine.
        author, project: names in the head of the page; may be empty.
    """
    facts = {"command": command, "engines": ", ".join(table.made.get("engines_asked", ()))}
    facts["program"] = table.made.get("program", "")
    parts: list[tuple[str, str, Markup]] = []
    for part in evaluation.parts(notes):
        figure = Markup() if part.draw is None else drawing(part.draw, part.label)
        parts.append((part.title, part.anchor, fill(part.template, figure=figure, **facts, **part.values)))
    inputs = ", ".join(str(source) for source in table.made.get("inputs", {}))
    counts = f"{len(table.cases)} runs, {len(table.failed)} failed"
    head = f"{name} on {inputs}; {counts}; {caption}"
    return document(f"Sweep of {name}", (head, head_line(author, project)), parts)
