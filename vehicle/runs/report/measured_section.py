"""Section of the report with the comparison of the run and a measurement."""

from __future__ import annotations

import base64

from markupsafe import Markup

from vehicle.digits import number
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates

fill = templates(__file__)

UNITS = {
    "low_hz": "from [Hz]",
    "high_hz": "to [Hz]",
    "magnitude_db": "magnitude, mean [dB]",
    "magnitude_rms_db": "magnitude, RMS [dB]",
    "phase_deg": "phase, RMS [deg]",
    "iso18571": "ISO 18571",
    "lag_s": "lag [s]",
    "drift_ppm": "drift [ppm]",
    "window_s": "window of ISO 18571 [s]",
}
"""Heads of columns with units."""


def measured(run: FinishedRun) -> Markup | None:
    """Return the table of differences, largest first, and the pictures; None without a measurement."""
    comparison = run.summary.get("measured")
    if not comparison:
        return None
    heads = list(dict.fromkeys(key for row in comparison["table"] for key in row))
    rows = [[_cell(row.get(key)) for key in heads] for row in comparison["table"]]
    titles = [UNITS.get(head, head.replace("_", " ")) for head in heads]
    pictures = [
        (base64.b64encode(path.read_bytes()).decode("ascii"), purpose.replace("_", " "))
        for purpose, name in run.summary["files"].items()
        if purpose.startswith("compare_") and (path := run.folder / name).suffix == ".png" and path.is_file()
    ]
    return fill("measured", file=comparison["file"], heads=titles, rows=rows, pictures=pictures)


def _cell(value: object) -> str:
    if isinstance(value, list | tuple):
        return " to ".join(_cell(item) for item in value)
    return number(value) if isinstance(value, float) or value is None else str(value)
