"""Section of the report with the comparison of the run and a measurement."""

from __future__ import annotations

import base64

from vehicle.digits import number
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import MANY, Markup, joined, shortened, table, tag

WORST = 10
"""Number of rows shown above a folded table."""

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

ERROR = (
    "error of a band: RMS of |ln(simulated / measured)|, weighted by both coherences; magnitude is positive if the "
    "simulation is larger, lag if it is late; drift is the change of the lag."
)


def measured(run: FinishedRun) -> Markup | None:
    """Return the table of differences, largest first, and the pictures; None without a measurement."""
    comparison = run.summary.get("measured")
    if not comparison:
        return None
    heads = list(dict.fromkeys(key for row in comparison["table"] for key in row))
    rows = [[_cell(row.get(key)) for key in heads] for row in comparison["table"]]
    titles = [UNITS.get(head, head.replace("_", " ")) for head in heads]
    parts = [
        tag("p", f"Measured: {comparison['file']}. The table is sorted by type of data, largest error first; {ERROR}"),
        *([table(titles, rows[:WORST], text_columns=2)] if len(rows) > MANY else []),
        shortened(f"All {len(rows)} rows", titles, rows, text_columns=2),
    ]
    for purpose, name in run.summary["files"].items():
        path = run.folder / name
        if purpose.startswith("compare_") and path.suffix == ".png" and path.is_file():
            source = "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
            parts.append(tag("figure", tag("img", src=source, alt=purpose.replace("_", " "))))
    return joined(parts)


def _cell(value: object) -> str:
    if isinstance(value, list | tuple):
        return " to ".join(_cell(item) for item in value)
    return number(value) if isinstance(value, float) or value is None else str(value)
