"""A measurement beside the run, where the run was compared with one."""

from __future__ import annotations

import base64

from vehicle.report.finished_run import FinishedRun
from vehicle.report.markup import Markup, joined, number, shortened, tag


def measured(run: FinishedRun) -> Markup | None:
    """The table of differences, worst first, and the pictures; None where nothing was measured."""
    about = run.summary.get("measured")
    if not about:
        return None
    heads = list(dict.fromkeys(key for row in about["table"] for key in row))
    rows = [[_cell(row.get(key)) for key in heads] for row in about["table"]]
    parts = [
        tag("p", f"Measured: {about['file']}. Worst first; see the documentation of the comparison for each column."),
        shortened(f"{len(rows)} rows", [head.replace("_", " ") for head in heads], rows),
    ]
    for kind, name in run.summary["files"].items():
        path = run.folder / name
        if kind.startswith("compare_") and path.suffix == ".png" and path.is_file():
            source = "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
            parts.append(tag("figure", tag("img", src=source, alt=kind.replace("_", " "))))
    return joined(parts)


def _cell(value: object) -> str:
    if isinstance(value, list | tuple):
        return " to ".join(_cell(one) for one in value)
    return number(value) if isinstance(value, float) or value is None else str(value)
