"""Verdicts of a quick study against those of the full study in the kept table."""

import json
from pathlib import Path

from scenarios.published.__main__ import HOME

TABLE = Path(__file__).parents[2] / HOME / "results.json"


def contradictions(study, folder):
    """Return the rows of a quick study that decide otherwise than the full study; an undecided quick row does not.

    Args:
        study: name of the study.
        folder: its results with --quick.
    """
    full = {row["name"]: row["within"] for row in json.loads(TABLE.read_text(encoding="utf-8"))["rows"]}
    quick = json.loads((folder / "results.json").read_text(encoding="utf-8"))["rows"]
    assert {f"{study}: {row['name']}" for row in quick} <= set(full)
    pairs = {row["name"]: (row["within"], full[f"{study}: {row['name']}"]) for row in quick}
    return [name for name, verdicts in pairs.items() if verdicts[0] not in (None, verdicts[1])]
